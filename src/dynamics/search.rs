//! The first event of a flow, certified.
//!
//! A guard g(t) is positive while a contact state holds. Between events it is a parabola plus the shares of the blocks, so
//! that its Taylor polynomial about any instant is known to every order, and so is a bound on what the polynomial leaves
//! out. In a window of Δ seconds, with σ = t/Δ,
//!
//! g(σ) = Σ aⱼ σʲ + R,   |R| ≤ Σₖ ampₖ (radiusₖ Δ)¹³/13!,
//!
//! the Bernstein coefficients of the polynomial enclose it. They prove that g keeps its sign, or that g, g′ or g″ does and
//! hence that g has one root and no more; else the window is halved. Where the parabola alone is further from zero than
//! all blocks together can reach, the search jumps there without looking. No window is sampled, no crossing stepped over.

use super::block::{Block, Kernel, Phase};
use super::flow::Parabola;

/// Degree of the window polynomials.
const DEGREE: usize = 12;
/// radius·Δ of a first window: the remainder is then 3.2¹³/13! of the amplitude, half a thousandth.
const REACH: f64 = 3.2;
/// radius·t below which a window polynomial leaves out less than rounding.
const SHORT_HOP: f64 = 0.02;
/// radius·δ below which the local expansion of a guard, to the seventh, is exact to rounding.
const NEAR: f64 = 0.03;
/// 1/13!.
const LEFT_OUT: f64 = 1.0 / 6_227_020_800.0;

/// A guard at the start of a segment, its sign folded in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Guard {
    /// Which crossing it is; the driver's business.
    pub(crate) label: usize,
    /// Polynomial part.
    pub(crate) parabola: Parabola,
    /// How the guard starts.
    pub(crate) start: Start,
    /// Whether the guard is a distance, so that its clearance counts as a margin.
    pub(crate) distance: bool,
}

/// How a guard starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Start {
    /// Positive.
    Apart,
    /// At zero: it was just left. The first derivative that is not zero, of this order, is positive.
    Touching {
        /// 1 to 3.
        order: usize,
        /// The first derivative where it is known to the bit, else NaN.
        slope: f64,
    },
}

/// What the search found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Found {
    /// No guard reaches zero before the limit.
    Nothing,
    /// Guard `guard` is the first, `time` seconds after the start.
    Event { guard: usize, time: f64 },
}

/// Running record of how clearly events were decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Clarity {
    /// Smallest distance by which a guard would have to be moved for the sequence to change.
    pub(crate) margin: f64,
    /// Decisions within rounding.
    pub(crate) ties: u64,
}

/// Work space of a search; kept between searches so that nothing is allocated.
#[derive(Debug)]
pub(crate) struct Search {
    /// Shares of each guard at the start, guard by guard.
    pub(crate) initial: Vec<Phase>,
    /// The guards.
    pub(crate) guards: Vec<Guard>,
    /// Shares at the window's start.
    current: Vec<Phase>,
    /// Until when each guard is known to stay positive.
    clear: Vec<f64>,
    /// Kernels from the segment's start to the result.
    pub(crate) kernels: Vec<Kernel>,
    /// First windows are shortened by this factor, to have a second accuracy to compare with.
    window_factor: f64,
}

enum Verdict {
    Clear,
    /// Exactly one root, at σ up to this.
    Root {
        high: f64,
    },
    Unsure,
}

/// The one root of a guard in a window.
#[derive(Clone, Copy)]
struct Root {
    guard: usize,
    /// First guess of its σ, and an upper bound.
    guess: f64,
    high: f64,
    /// The guard starts at zero, so that the root may be a short hop away.
    short: bool,
}

/// A guard over one window.
struct Window {
    /// Taylor coefficients in σ, of the guard divided by σ^order where it starts at zero.
    a: [f64; DEGREE + 1],
    /// Their Bernstein coefficients.
    b: [f64; DEGREE + 1],
    /// What the polynomial leaves out, with the rounding.
    remainder: f64,
    /// A bound on the second derivative in σ.
    bend: f64,
}

impl Search {
    pub(crate) fn new(window_factor: f64) -> Self {
        Self {
            initial: Vec::new(),
            guards: Vec::new(),
            current: Vec::new(),
            clear: Vec::new(),
            kernels: Vec::new(),
            window_factor,
        }
    }

    pub(crate) fn clear(&mut self) {
        self.guards.clear();
        self.initial.clear();
    }

    /// Finds the first event before `limit` seconds; leaves the kernels of that time, or of the limit.
    pub(crate) fn run(&mut self, blocks: &[Block], limit: f64, clarity: &mut Clarity) -> Found {
        let found = self.first(blocks, limit, clarity);
        if found == Found::Nothing {
            self.kernels_at(blocks, limit);
        }
        found
    }

    fn first(&mut self, blocks: &[Block], limit: f64, clarity: &mut Clarity) -> Found {
        if self.guards.is_empty() {
            return Found::Nothing;
        }
        let width = blocks.len();
        self.current.clear();
        self.current.extend_from_slice(&self.initial);
        self.clear.clear();
        self.clear.resize(self.guards.len(), 0.0);
        let mut t = 0.0;
        // Windows shorter than this are not divided. It grows from doubt to doubt: a guard that stays within rounding of zero
        // must not hold up the search.
        let clock = f64::EPSILON * limit;
        let mut shortest = clock;
        loop {
            let remaining = limit - t;
            // Below the rounding of the clock nothing can be told apart: what happens at the limit comes first.
            if remaining <= 4.0 * f64::EPSILON * limit {
                return Found::Nothing;
            }
            let mut skip = remaining;
            let mut speed = 0.0_f64;
            for (index, (guard, shares)) in self.guards.iter().zip(self.current.chunks_exact(width)).enumerate() {
                let (mut reach, mut bend, mut snap) = (0.0, 0.0, 0.0);
                for (block, share) in blocks.iter().zip(shares) {
                    let amplitude = block.amplitude(*share, 0.0, remaining);
                    let square = block.radius * block.radius;
                    reach += amplitude;
                    bend += amplitude * square;
                    snap += amplitude * square * square;
                }
                let margin = if guard.distance { clarity.margin } else { 0.0 };
                let clear = t + clear_until(guard.parabola, t, reach, margin);
                if clear > self.clear[index] {
                    self.clear[index] = clear;
                }
                let clear = self.clear[index] - t;
                if clear < skip {
                    skip = clear;
                }
                // snap/bend is the square of the guard's speed: compared without dividing.
                if snap > speed * bend {
                    speed = snap / bend;
                }
            }
            if skip >= remaining {
                return Found::Nothing;
            }
            // A jump is worth its kernels only if it saves a good part of a window.
            if skip * skip * speed > 0.25 {
                t += skip;
                self.move_to(blocks, t);
                continue;
            }
            let mut window = remaining.min(REACH * self.window_factor / speed.sqrt());
            let ties = clarity.ties;
            if let Some(root) = self.search_window(blocks, t, &mut window, shortest, clarity) {
                if root.high == 0.0 {
                    self.kernels_at(blocks, t);
                    return Found::Event { guard: root.guard, time: t };
                }
                return Found::Event { guard: root.guard, time: self.polish(blocks, root, t, window, clarity) };
            }
            shortest = if clarity.ties > ties { 4.0 * shortest } else { clock };
            t += window;
            if limit - t <= 4.0 * f64::EPSILON * limit {
                return Found::Nothing;
            }
            self.move_to(blocks, t);
        }
    }

    /// Proves the window clear of roots (`None`) or isolates the first one; shrinks the window until it can.
    fn search_window(
        &mut self,
        blocks: &[Block],
        t: f64,
        window: &mut f64,
        shortest: f64,
        clarity: &mut Clarity,
    ) -> Option<Root> {
        let width = blocks.len();
        let asked = *window;
        'shrink: loop {
            let mut first: Option<Root> = None;
            let indivisible = *window <= shortest.max(64.0 * f64::EPSILON * t);
            for index in 0..self.guards.len() {
                let guard = self.guards[index];
                if self.clear[index] >= t + *window {
                    continue;
                }
                let shares = &self.current[index * width..(index + 1) * width];
                let start = if t == 0.0 { guard.start } else { Start::Apart };
                let piece = Window::expand(blocks, shares, guard.parabola, t, *window, start);
                let (verdict, clearance) = piece.judge(start);
                if guard.distance {
                    clarity.margin = clarity.margin.min(clearance);
                }
                match verdict {
                    Verdict::Clear => self.clear[index] = t + *window,
                    Verdict::Root { high } => {
                        let root = Root { guard: index, guess: piece.root(high), high, short: piece.short(start) };
                        if high == 0.0 {
                            return Some(root);
                        }
                        match first {
                            None => first = Some(root),
                            // Two guards in one window: narrow until one of them is clear, or they are one to the rounding.
                            Some(_) if !indivisible => {
                                *window *= 0.5;
                                continue 'shrink;
                            }
                            Some(_) => clarity.ties += 1,
                        }
                    }
                    Verdict::Unsure if indivisible => {
                        if t == 0.0 {
                            self.prove_hops(blocks, asked);
                        }
                        clarity.ties += 1;
                        clarity.margin = 0.0;
                        if piece.end() < 0.0 && first.is_none() {
                            first = Some(Root { guard: index, guess: 1.0, high: 1.0, short: false });
                        }
                    }
                    Verdict::Unsure => {
                        *window *= 0.5;
                        continue 'shrink;
                    }
                }
            }
            return first;
        }
    }

    /// Proves each guard that starts at zero clear for as long as its own start tells, before the doubt about another one
    /// makes the search move on to where that is forgotten.
    #[cold]
    fn prove_hops(&mut self, blocks: &[Block], mut window: f64) {
        let width = blocks.len();
        for (index, guard) in self.guards.iter().enumerate() {
            if guard.start == Start::Apart {
                continue;
            }
            let shares = &self.current[index * width..(index + 1) * width];
            while window > self.clear[index] {
                let piece = Window::expand(blocks, shares, guard.parabola, 0.0, window, guard.start);
                if let (Verdict::Clear, _) = piece.judge(guard.start) {
                    self.clear[index] = window;
                } else {
                    window *= 0.5;
                }
            }
        }
    }

    /// The time of an isolated root, to the last digit; leaves its kernels.
    fn polish(&mut self, blocks: &[Block], root: Root, t: f64, window: f64, clarity: &mut Clarity) -> f64 {
        let parabola = self.guards[root.guard].parabola;
        let radius = blocks.iter().fold(0.0_f64, |largest, block| largest.max(block.radius));
        if root.short && root.guess * window * radius < SHORT_HOP {
            return self.polish_short_hop(blocks, root, window);
        }
        let (mut lower, mut upper) = (t, t + root.high * window);
        let slack = 1e-3 * (upper - lower);
        let mut time = t + window * root.guess;
        for _ in 0..60 {
            self.kernels_at(blocks, time);
            let local = self.local(blocks, root.guard, parabola, time);
            if local[0] >= 0.0 {
                lower = lower.max(time)
            } else {
                upper = upper.min(time)
            }
            // Rounding may put the root of a guard that starts near zero before the window; time never runs backwards.
            let delta = nearest_root(&local).max(t - time);
            let next = time + delta;
            if (next >= lower - slack && next <= upper + slack) || delta.abs() <= 8.0 * f64::EPSILON * time {
                if delta.abs() * radius < NEAR {
                    for (kernel, block) in self.kernels.iter_mut().zip(blocks) {
                        *kernel = block.compose(*kernel, block.kernel_near_zero(delta));
                    }
                    if self.guards[root.guard].distance {
                        // The guard would have to be moved by about g′²/(2|g″|) for this crossing to vanish.
                        let bend = (4.0 * local[2].abs()).max(f64::MIN_POSITIVE);
                        let slope = local[1] + delta * (2.0 * local[2] + 3.0 * delta * local[3]);
                        clarity.margin = clarity.margin.min(slope * slope / bend);
                    }
                    return next;
                }
                time = next;
            } else {
                // Newton left the bracket (a graze): halve it.
                time = 0.5 * (lower + upper);
            }
            if upper - lower <= 4.0 * f64::EPSILON * upper {
                break;
            }
        }
        self.kernels_at(blocks, time);
        clarity.ties += 1;
        time
    }

    /// A hop so short that the window's polynomial is exact, while the difference of parabola and blocks is all rounding.
    #[cold]
    fn polish_short_hop(&mut self, blocks: &[Block], root: Root, window: f64) -> f64 {
        let width = blocks.len();
        let guard = self.guards[root.guard];
        let shares = &self.current[root.guard * width..(root.guard + 1) * width];
        let piece = Window::expand(blocks, shares, guard.parabola, 0.0, window, guard.start);
        let time = window * piece.refine(root.guess, root.high);
        self.kernels.clear();
        self.kernels.extend(blocks.iter().map(|block| block.kernel_near_zero(time)));
        time
    }

    /// Taylor coefficients of a guard about `time`, to the seventh.
    #[inline]
    fn local(&self, blocks: &[Block], guard: usize, parabola: Parabola, time: f64) -> [f64; 8] {
        let width = blocks.len();
        let mut a = [parabola.at(time), parabola.rate(time), parabola.p2, 0.0, 0.0, 0.0, 0.0, 0.0];
        let initial = &self.initial[guard * width..(guard + 1) * width];
        for ((block, kernel), phase) in blocks.iter().zip(&self.kernels).zip(initial) {
            let now = block.advance(*phase, *kernel);
            let (p, q) = (-2.0 * block.decay, -block.determinant);
            let (mut before, mut last) = (now.value, now.rate);
            a[0] += before;
            a[1] += last;
            for j in 0..6 {
                let next = (p * FACTORS[j][0]) * last + (q * FACTORS[j][1]) * before;
                a[j + 2] += next;
                before = last;
                last = next;
            }
        }
        a
    }

    fn kernels_at(&mut self, blocks: &[Block], t: f64) {
        self.kernels.clear();
        self.kernels.extend(blocks.iter().map(|block| block.kernel(t)));
    }

    fn move_to(&mut self, blocks: &[Block], t: f64) {
        self.kernels_at(blocks, t);
        let width = blocks.len();
        for (current, initial) in self.current.chunks_exact_mut(width).zip(self.initial.chunks_exact(width)) {
            for k in 0..width {
                current[k] = blocks[k].advance(initial[k], self.kernels[k]);
            }
        }
    }
}

/// How long the parabola alone keeps further from zero than `reach`; 0 if it is not so now, nor where it may come closer
/// than `margin`, so that no jump passes over the narrowest place of a run.
#[inline]
fn clear_until(parabola: Parabola, t: f64, reach: f64, margin: f64) -> f64 {
    let c = parabola.at(t) - reach - margin.min(reach);
    if !(c > 0.0) {
        return 0.0;
    }
    let (b, a) = (parabola.rate(t), parabola.p2);
    if a >= 0.0 && b >= 0.0 {
        return f64::INFINITY;
    }
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        // Its lowest point is c − b²/4a.
        return if -discriminant < 4.0 * a * margin { 0.0 } else { f64::INFINITY };
    }
    // The first positive root of c + b τ + a τ², written without cancellation.
    let root = discriminant.sqrt();
    if b <= 0.0 { 2.0 * c / (root - b) } else { (b + root) / (-2.0 * a) }
}

impl Window {
    #[inline]
    fn expand(blocks: &[Block], shares: &[Phase], parabola: Parabola, t: f64, window: f64, start: Start) -> Self {
        let mut a = [0.0; DEGREE + 1];
        a[0] = parabola.at(t);
        a[1] = parabola.rate(t) * window;
        a[2] = parabola.p2 * window * window;
        let mut magnitude = a[0].abs() + a[1].abs();
        let mut bend = 2.0 * a[2].abs();
        let mut left_out = 0.0;
        for (blocks, shares) in blocks.chunks(2).zip(shares.chunks(2)) {
            // sⱼ₊₂ = (−2aΔ sⱼ₊₁ − bΔ² sⱼ/(j + 1))/(j + 2) for the coefficients sⱼ of a share; two blocks side by side.
            let (mut p, mut q, mut before, mut last) = ([0.0; 2], [0.0; 2], [0.0; 2], [0.0; 2]);
            for (lane, (block, share)) in blocks.iter().zip(shares).enumerate() {
                p[lane] = -2.0 * block.decay * window;
                q[lane] = -block.determinant * window * window;
                before[lane] = share.value;
                last[lane] = share.rate * window;
                let amplitude = block.amplitude(*share, 13.0, window);
                let x = block.radius * window;
                let x2 = x * x;
                let x4 = x2 * x2;
                left_out += amplitude * (x4 * x4 * x4 * x) * LEFT_OUT;
                magnitude += amplitude * (1.0 + x);
                // Of p/σ, p/σ², p/σ³ the second derivative is below a 3rd, 12th, 60th of p's third, fourth, fifth.
                bend += amplitude * x2 * (1.0 + x * (1.0 / 3.0) + x2 * (1.0 / 12.0 + x * (1.0 / 60.0)));
            }
            a[0] += before[0] + before[1];
            a[1] += last[0] + last[1];
            for j in 0..DEGREE - 1 {
                let [f, g] = FACTORS[j];
                let next =
                    [(p[0] * f) * last[0] + (q[0] * g) * before[0], (p[1] * f) * last[1] + (q[1] * g) * before[1]];
                a[j + 2] += next[0] + next[1];
                before = last;
                last = next;
            }
        }
        let mut remainder = left_out;
        let b = match start {
            Start::Apart => {
                remainder += 4.0 * f64::EPSILON * magnitude;
                bernstein(&a)
            }
            Start::Touching { order, slope } => {
                // The start is known exactly: what rounding left in the coefficients below the first is not there.
                if order == 1 && !slope.is_nan() {
                    a[1] = slope * window;
                }
                match order {
                    1 => divide::<1>(&mut a),
                    2 => divide::<2>(&mut a),
                    _ => divide::<3>(&mut a),
                }
                bernstein(&a)
            }
        };
        Self { a, b, remainder, bend }
    }

    fn end(&self) -> f64 {
        self.a.iter().sum()
    }

    /// Whether a root may be a short hop from a start at zero.
    fn short(&self, start: Start) -> bool {
        start != Start::Apart
    }

    /// What the enclosure proves, and how near the guard comes to zero where it turns back.
    #[inline]
    fn judge(&self, start: Start) -> (Verdict, f64) {
        let b = &self.b;
        let doubt = self.remainder;
        let lowest = b.iter().fold(f64::INFINITY, |low, x| if *x < low { *x } else { low });
        if lowest > doubt {
            let near_miss = start == Start::Apart && b[1] < b[0] && b[DEGREE] > b[DEGREE - 1];
            return (Verdict::Clear, if near_miss { lowest - doubt } else { f64::INFINITY });
        }
        if self.changes_sign_once() {
            return (Verdict::Root { high: 1.0 }, f64::INFINITY);
        }
        self.judge_shape(start)
    }

    /// Descartes' rule in Bernstein form: coefficients positive, then doubtful, then negative. The guard is positive before
    /// the band where polynomial and remainder cannot be told apart, negative behind it, and falls all through it, since
    /// its slope there is more than its second derivative can turn.
    #[inline]
    fn changes_sign_once(&self) -> bool {
        let doubt = self.remainder;
        let mut i = 0;
        while i <= DEGREE && self.b[i] > doubt {
            i += 1;
        }
        let positive = i;
        while i <= DEGREE && self.b[i] >= -doubt {
            i += 1;
        }
        if positive == 0 || i > DEGREE || self.b[i..].iter().any(|b| *b >= -doubt) {
            return false;
        }
        let slope = evaluate(&self.a, self.root(1.0)).1;
        slope < 0.0 && slope * slope > 8.0 * doubt * (self.bend + 16.0 * slope.abs())
    }

    fn judge_shape(&self, start: Start) -> (Verdict, f64) {
        let b = &self.b;
        let doubt = self.remainder;
        let end = b[DEGREE];
        // |R⁽ʲ⁾| ≤ 13!/(13−j)! of R's bound; divided by up to σ³ the first derivative is below 16 R, the second below 250 R.
        let slope_doubt = 16.0 * doubt / DEGREE as f64;
        let bend_doubt = 250.0 * doubt / (DEGREE * (DEGREE - 1)) as f64;
        let (mut falls, mut concave, mut convex) = (true, true, true);
        for i in 0..DEGREE {
            falls &= b[i + 1] - b[i] < -slope_doubt;
        }
        for i in 0..DEGREE - 1 {
            let second = b[i + 2] - 2.0 * b[i + 1] + b[i];
            concave &= second < -bend_doubt;
            convex &= second > bend_doubt;
        }
        let sure = |verdict| (verdict, f64::INFINITY);
        if start == Start::Apart && b[0] < -doubt {
            // A jump has left the contact untenable: it ends at once.
            return sure(Verdict::Root { high: 0.0 });
        }
        if doubt == 0.0 && b.iter().all(|x| *x == 0.0) {
            // Nothing pushes and nothing pulls, for ever.
            return sure(Verdict::Clear);
        }
        if (falls || concave) && end < -doubt {
            return sure(Verdict::Root { high: 1.0 });
        }
        if concave && end > doubt && (b[0] > doubt || start == Start::Apart) {
            return sure(Verdict::Clear);
        }
        if convex && start == Start::Apart {
            if b[1] - b[0] > slope_doubt {
                return sure(Verdict::Clear);
            }
            if end < -doubt && b[0] > doubt {
                // Convex, positive, then negative: one root.
                return sure(Verdict::Root { high: 1.0 });
            }
            let bottom = self.bottom();
            let value = self.value(bottom);
            if value > doubt {
                return (Verdict::Clear, value - doubt);
            }
            if value < -doubt && b[0] > doubt {
                return sure(Verdict::Root { high: bottom });
            }
        }
        sure(Verdict::Unsure)
    }

    /// Where a convex polynomial has its lowest point in [0, 1].
    fn bottom(&self) -> f64 {
        let slope = |x: f64| (1..=DEGREE).rev().fold(0.0, |sum, j| sum * x + j as f64 * self.a[j]);
        let (mut low, mut high) = (0.0, 1.0);
        if slope(1.0) <= 0.0 {
            return 1.0;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    fn value(&self, x: f64) -> f64 {
        self.a.iter().rev().fold(0.0, |sum, a| sum * x + a)
    }

    /// A first guess of the root below `high`: where the control polygon crosses zero, and Newton steps from there.
    #[inline]
    fn root(&self, high: f64) -> f64 {
        let (mut lower, mut upper) = (0.0, high);
        let mut x = high;
        if high == 1.0
            && let Some(i) = (0..DEGREE).find(|&i| self.b[i] > 0.0 && self.b[i + 1] <= 0.0)
        {
            x = (i as f64 + self.b[i] / (self.b[i] - self.b[i + 1])) * (1.0 / DEGREE as f64);
        }
        for _ in 0..60 {
            let (value, slope) = evaluate(&self.a, x);
            if value > 0.0 {
                lower = x
            } else {
                upper = x
            }
            let mut next = x - value / slope;
            if !(next > lower && next < upper) {
                next = 0.5 * (lower + upper);
            }
            let step = (next - x).abs();
            x = next;
            // Quadratic convergence: the next step would be the square of this.
            if step < 0.03 * x {
                break;
            }
        }
        x
    }

    /// The root below `high` of the polynomial divided by σ^order, from a guess that is near.
    fn refine(&self, guess: f64, high: f64) -> f64 {
        let (mut lower, mut upper) = (0.0, high);
        let mut x = guess;
        for _ in 0..60 {
            let (value, slope) = evaluate(&self.a, x);
            if value > 0.0 {
                lower = x
            } else {
                upper = x
            }
            let mut next = x - value / slope;
            if !(next >= lower && next <= upper) {
                next = 0.5 * (lower + upper);
            }
            let step = (next - x).abs();
            x = next;
            if !(step > 2.0 * f64::EPSILON * x) {
                break;
            }
        }
        x
    }
}

/// Divides a polynomial by σ^ORDER.
#[inline(always)]
fn divide<const ORDER: usize>(a: &mut [f64; DEGREE + 1]) {
    for j in 0..=DEGREE - ORDER {
        a[j] = a[j + ORDER];
    }
    for j in DEGREE - ORDER + 1..=DEGREE {
        a[j] = 0.0;
    }
}

/// Value and slope at x of Σ aⱼ xʲ, by Estrin's scheme.
#[inline]
fn evaluate(a: &[f64; DEGREE + 1], x: f64) -> (f64, f64) {
    let (x2, x4) = (x * x, (x * x) * (x * x));
    let four = |i: usize| (a[i] + a[i + 1] * x) + (a[i + 2] + a[i + 3] * x) * x2;
    let rate = |i: usize| {
        let k = i as f64;
        ((k + 1.0) * a[i + 1] + (k + 2.0) * a[i + 2] * x) + ((k + 3.0) * a[i + 3] + (k + 4.0) * a[i + 4] * x) * x2
    };
    let value = four(0) + x4 * (four(4) + x4 * (four(8) + x4 * a[12]));
    let slope = rate(0) + x4 * (rate(4) + x4 * rate(8));
    (value, slope)
}

/// 1/(j + 2) and 1/((j + 1)(j + 2)).
const FACTORS: [[f64; 2]; DEGREE - 1] = {
    let mut table = [[0.0; 2]; DEGREE - 1];
    let mut j = 0;
    while j < DEGREE - 1 {
        table[j] = [1.0 / (j + 2) as f64, 1.0 / ((j + 1) * (j + 2)) as f64];
        j += 1;
    }
    table
};

/// Bernstein coefficients on [0, 1] of Σ aⱼ xʲ: bᵢ = Σ_{j≤i} C(i, j)/C(n, j) aⱼ, by repeated sums.
#[inline]
fn bernstein(a: &[f64; DEGREE + 1]) -> [f64; DEGREE + 1] {
    let mut b = [0.0; DEGREE + 1];
    for j in 0..=DEGREE {
        b[j] = a[j] * INVERSE_BINOMIAL[j];
    }
    // Twelve rounds of known length each, so that the compiler keeps them in registers.
    sums::<0>(&mut b);
    sums::<1>(&mut b);
    sums::<2>(&mut b);
    sums::<3>(&mut b);
    sums::<4>(&mut b);
    sums::<5>(&mut b);
    sums::<6>(&mut b);
    sums::<7>(&mut b);
    sums::<8>(&mut b);
    sums::<9>(&mut b);
    sums::<10>(&mut b);
    sums::<11>(&mut b);
    b
}

#[inline(always)]
fn sums<const ROUND: usize>(b: &mut [f64; DEGREE + 1]) {
    let mut i = DEGREE;
    while i > ROUND {
        b[i] += b[i - 1];
        i -= 1;
    }
}

/// 1/C(n, j).
const INVERSE_BINOMIAL: [f64; DEGREE + 1] = {
    let mut table = [0.0; DEGREE + 1];
    let mut binomial = 1.0;
    let mut j = 0;
    while j <= DEGREE {
        table[j] = 1.0 / binomial;
        binomial = binomial * (DEGREE - j) as f64 / (j + 1) as f64;
        j += 1;
    }
    table
};

/// The root of smallest modulus of a polynomial whose constant is small: Newton from zero; NaN if that does not settle.
#[inline]
fn nearest_root(a: &[f64; 8]) -> f64 {
    let mut x = -a[0] / a[1];
    for _ in 0..20 {
        let x2 = x * x;
        let value = (a[0] + a[1] * x) + x2 * ((a[2] + a[3] * x) + x2 * ((a[4] + a[5] * x) + x2 * (a[6] + a[7] * x)));
        let slope = (a[1] + 2.0 * a[2] * x)
            + x2 * ((3.0 * a[3] + 4.0 * a[4] * x) + x2 * ((5.0 * a[5] + 6.0 * a[6] * x) + x2 * (7.0 * a[7])));
        let step = value / slope;
        x -= step;
        // Quadratic convergence: what is left is the square of this.
        if step.abs() <= 1e-6 * x.abs() {
            return x;
        }
    }
    f64::NAN
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bernstein_coefficients_enclose_the_polynomial() {
        let a = [0.3, -1.2, 0.7, 0.25, -0.1, 0.05, 0.02, -0.01, 0.004, 0.3, -0.2, 0.1, -0.05];
        let b = bernstein(&a);
        assert!((b[0] - a[0]).abs() < 1e-16 && (b[DEGREE] - a.iter().sum::<f64>()).abs() < 1e-15);
        for i in 0..=20 {
            let x = f64::from(i) / 20.0;
            let y = a.iter().rev().fold(0.0, |sum, a| sum * x + a);
            assert!(y >= b.iter().copied().fold(f64::INFINITY, f64::min) - 1e-15);
            assert!(y <= b.iter().copied().fold(f64::NEG_INFINITY, f64::max) + 1e-15);
        }
    }
}
