//! The first event of a flow, certified.
//!
//! A guard g(t) is positive while a contact state holds. Between events it is a parabola plus the shares of the blocks, so
//! that its Taylor polynomial about any instant is known to every order, and so is a bound on what the polynomial leaves
//! out. In a window of Δ seconds, with σ = t/Δ,
//!
//! g(σ) = Σ aⱼ σʲ + R,   |R| ≤ Σₖ ampₖ (radiusₖ Δ)⁹/9!,
//!
//! the Bernstein coefficients of the polynomial enclose it. They prove that g keeps its sign, or that g, g′ or g″ does and
//! hence that g has one root and no more; else the window is halved. Where the parabola alone is further from zero than
//! all blocks together can reach, the search jumps there without looking. No window is sampled, no crossing stepped over.

use super::block::{Block, Kernel, Phase};
use super::flow::Parabola;

/// Degree of the window polynomials.
const DEGREE: usize = 8;
/// radius·Δ of a first window: the remainder is then 2⁹/9! of the amplitude.
const REACH: f64 = 2.0;
/// radius·t below which a window polynomial leaves out less than rounding.
const SHORT_HOP: f64 = 0.02;
/// 1/9!.
const NINTH: f64 = 1.0 / 362_880.0;

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
    /// Kernels from the segment's start to the result.
    pub(crate) kernels: Vec<Kernel>,
    /// First windows are shortened by this factor, to have a second accuracy to compare with.
    window_factor: f64,
}

enum Verdict {
    Clear,
    /// Exactly one root, between these σ.
    Root(f64, f64),
    Unsure,
}

/// A guard over one window.
struct Window {
    /// Taylor coefficients in σ.
    a: [f64; DEGREE + 1],
    /// Bernstein coefficients (of the polynomial divided by σ^order where it starts at zero).
    b: [f64; DEGREE + 1],
    /// What the polynomial leaves out, with the rounding.
    remainder: f64,
}

impl Search {
    pub(crate) fn new(window_factor: f64) -> Self {
        Self { initial: Vec::new(), guards: Vec::new(), current: Vec::new(), kernels: Vec::new(), window_factor }
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
        let mut t = 0.0;
        let mut trial = f64::INFINITY;
        loop {
            let remaining = limit - t;
            // Below the rounding of the clock nothing can be told apart: what happens at the limit comes first.
            if remaining <= 4.0 * f64::EPSILON * limit {
                return Found::Nothing;
            }
            let mut skip = remaining;
            let mut speed = 0.0_f64;
            for (guard, shares) in self.guards.iter().zip(self.current.chunks_exact(width)) {
                let (mut reach, mut bend, mut snap) = (0.0, 0.0, 0.0);
                for (block, share) in blocks.iter().zip(shares) {
                    let amplitude = block.amplitude(*share, 0.0, remaining);
                    let square = block.radius * block.radius;
                    reach += amplitude;
                    bend += amplitude * square;
                    snap += amplitude * square * square;
                }
                skip = skip.min(clear_until(guard.parabola, t, reach));
                if bend > 0.0 {
                    speed = speed.max(snap / bend);
                }
            }
            if skip >= remaining {
                return Found::Nothing;
            }
            // A jump is worth its kernels only if it saves a good part of a window.
            if skip * skip * speed > 0.25 {
                t += skip;
                self.move_to(blocks, t);
                trial = f64::INFINITY;
                continue;
            }
            let mut window = remaining.min(trial).min(REACH * self.window_factor / speed.sqrt());
            match self.search_window(blocks, t, &mut window, clarity) {
                Some((guard, low, high)) => {
                    if let Some(time) = self.polish(blocks, guard, t, low * window, high * window, clarity) {
                        return Found::Event { guard, time };
                    }
                    return Found::Nothing;
                }
                None => {
                    t += window;
                    if limit - t <= 4.0 * f64::EPSILON * limit {
                        return Found::Nothing;
                    }
                    self.move_to(blocks, t);
                    trial = f64::INFINITY;
                }
            }
        }
    }

    /// Proves the window clear of roots (`None`) or isolates the first one; shrinks the window until it can.
    fn search_window(
        &self,
        blocks: &[Block],
        t: f64,
        window: &mut f64,
        clarity: &mut Clarity,
    ) -> Option<(usize, f64, f64)> {
        let width = blocks.len();
        'shrink: loop {
            let mut first: Option<(usize, f64, f64)> = None;
            for (index, guard) in self.guards.iter().enumerate() {
                let shares = &self.current[index * width..(index + 1) * width];
                let start = if t == 0.0 { guard.start } else { Start::Apart };
                let piece = Window::expand(blocks, shares, guard.parabola, t, *window, start);
                let (verdict, clearance) = piece.judge(start);
                if guard.distance {
                    clarity.margin = clarity.margin.min(clearance);
                }
                match verdict {
                    Verdict::Clear => {}
                    Verdict::Root(low, high) => {
                        let earlier = first.is_none_or(|(_, _, other)| high < other);
                        if let Some((_, other_low, other_high)) = first
                            && low <= other_high
                            && other_low <= high
                        {
                            // Two guards in one window: narrow until their roots part, or are one to the rounding.
                            if *window > 64.0 * f64::EPSILON * (t + *window) {
                                *window *= 0.5;
                                continue 'shrink;
                            }
                            clarity.ties += 1;
                        }
                        if earlier {
                            first = Some((index, low, high));
                        }
                    }
                    Verdict::Unsure => {
                        if *window <= 64.0 * f64::EPSILON * (t + *window) || *window < 1e-300 {
                            clarity.ties += 1;
                            clarity.margin = 0.0;
                            if piece.end() < 0.0 {
                                return Some((index, 0.0, 1.0));
                            }
                            continue;
                        }
                        *window *= 0.5;
                        continue 'shrink;
                    }
                }
            }
            return first;
        }
    }

    /// The root of one guard between two instants, to the last digit; `None` if rounding leaves none.
    fn polish(
        &mut self,
        blocks: &[Block],
        guard: usize,
        t: f64,
        low: f64,
        high: f64,
        clarity: &mut Clarity,
    ) -> Option<f64> {
        let width = blocks.len();
        let parabola = self.guards[guard].parabola;
        let radius = blocks.iter().fold(0.0_f64, |largest, block| largest.max(block.radius));
        let window = high;
        let start = if t == 0.0 { self.guards[guard].start } else { Start::Apart };
        let shares = &self.current[guard * width..(guard + 1) * width];
        let piece = Window::expand(blocks, shares, parabola, t, window, start);
        let (mut lower, mut upper) = (t + low, t + high);
        let guess = piece.root(start, low / window, 1.0);
        if start != Start::Apart && guess * window * radius < SHORT_HOP {
            // A hop so short that the polynomial is exact, while the difference of parabola and blocks would be rounding.
            let time = window * piece.refine(start, guess);
            self.kernels.clear();
            self.kernels.extend(blocks.iter().map(|block| block.kernel_near_zero(time)));
            return Some(time);
        }
        let mut time = t + window * guess;
        for round in 0..60 {
            self.kernels_at(blocks, time);
            let local = self.local(blocks, guard, parabola, time);
            if local[0] >= 0.0 {
                lower = lower.max(time)
            } else {
                upper = upper.min(time)
            }
            let delta = root_of_quintic(&local);
            let inside =
                time + delta >= lower - 1e-3 * (upper - lower) && time + delta <= upper + 1e-3 * (upper - lower);
            if delta.is_finite() && (inside || delta.abs() <= 8.0 * f64::EPSILON * time) {
                if delta.abs() * radius < 4e-3 {
                    for (kernel, block) in self.kernels.iter_mut().zip(blocks) {
                        *kernel = block.compose(*kernel, block.kernel_near_zero(delta));
                    }
                    // The guard would have to be moved by about g′²/(2|g″|) for this crossing to vanish.
                    let bend = 2.0 * local[2].abs();
                    let depth = local[1] * local[1] / (2.0 * bend.max(f64::MIN_POSITIVE));
                    if self.guards[guard].distance {
                        clarity.margin = clarity.margin.min(depth);
                    }
                    return Some(time + delta);
                }
                time += delta;
            } else {
                time = 0.5 * (lower + upper);
            }
            if upper - lower <= 4.0 * f64::EPSILON * upper || round == 59 {
                self.kernels_at(blocks, time);
                clarity.ties += 1;
                return Some(time);
            }
        }
        None
    }

    /// Taylor coefficients of a guard about `time`, to the fifth.
    fn local(&self, blocks: &[Block], guard: usize, parabola: Parabola, time: f64) -> [f64; 6] {
        let width = blocks.len();
        let mut a = [parabola.at(time), parabola.rate(time), parabola.p2, 0.0, 0.0, 0.0];
        let initial = &self.initial[guard * width..(guard + 1) * width];
        for ((block, kernel), phase) in blocks.iter().zip(&self.kernels).zip(initial) {
            let now = block.advance(*phase, *kernel);
            let (trace, b) = (-2.0 * block.decay, block.determinant);
            let s2 = trace * now.rate - b * now.value;
            let s3 = trace * s2 - b * now.rate;
            let s4 = trace * s3 - b * s2;
            let s5 = trace * s4 - b * s3;
            a[0] += now.value;
            a[1] += now.rate;
            a[2] += 0.5 * s2;
            a[3] += s3 * (1.0 / 6.0);
            a[4] += s4 * (1.0 / 24.0);
            a[5] += s5 * (1.0 / 120.0);
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

/// How long the parabola alone keeps further from zero than `reach`; 0 if it is not so now.
#[inline]
fn clear_until(parabola: Parabola, t: f64, reach: f64) -> f64 {
    let c = parabola.at(t) - reach;
    if !(c > 0.0) {
        return 0.0;
    }
    let (b, a) = (parabola.rate(t), parabola.p2);
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 || (a >= 0.0 && b >= 0.0) {
        return f64::INFINITY;
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
        let mut left_out = 0.0;
        for (block, share) in blocks.iter().zip(shares) {
            let p = -2.0 * block.decay * window;
            let q = -block.determinant * window * window;
            let mut s = [0.0; DEGREE + 1];
            s[0] = share.value;
            s[1] = share.rate * window;
            for j in 0..DEGREE - 1 {
                s[j + 2] = p * s[j + 1] * RECIPROCAL[j + 2] + q * s[j] * (RECIPROCAL[j + 1] * RECIPROCAL[j + 2]);
            }
            for (sum, term) in a.iter_mut().zip(s) {
                *sum += term;
            }
            let amplitude = block.amplitude(*share, 9.0, window);
            let x = block.radius * window;
            let (x2, x4) = (x * x, (x * x) * (x * x));
            left_out += amplitude * (x4 * x4 * x) * NINTH;
            magnitude += amplitude * if x2 < 1.0 { 1.0 } else { x };
        }
        let rounding = 4.0 * f64::EPSILON * magnitude;
        let mut shifted = a;
        let mut order = 0;
        if let Start::Touching { order: touch, slope } = start {
            // The start is known exactly: what rounding left in the coefficients below the first is not there.
            order = touch;
            a[..touch].fill(0.0);
            if touch == 1 && !slope.is_nan() {
                a[1] = slope * window;
            }
            shifted = [0.0; DEGREE + 1];
            shifted[..=DEGREE - touch].copy_from_slice(&a[touch..]);
        }
        let rounding = if order == 0 { rounding } else { 0.0 };
        Self { a, b: bernstein(&shifted, DEGREE - order), remainder: left_out + rounding }
    }

    fn end(&self) -> f64 {
        self.a.iter().sum()
    }

    #[inline]
    fn judge(&self, start: Start) -> (Verdict, f64) {
        let degree = match start {
            Start::Apart => DEGREE,
            Start::Touching { order, .. } => DEGREE - order,
        };
        let b = &self.b[..=degree];
        let doubt = self.remainder;
        let lowest = b.iter().fold(f64::INFINITY, |low, x| low.min(*x));
        if lowest > doubt {
            let near_miss = degree == DEGREE && b[1] < b[0] && b[degree] > b[degree - 1];
            return (Verdict::Clear, if near_miss { lowest - doubt } else { f64::INFINITY });
        }
        self.judge_shape(b, start)
    }

    fn judge_shape(&self, b: &[f64], start: Start) -> (Verdict, f64) {
        let degree = b.len() - 1;
        let doubt = self.remainder;
        let end = b[degree];
        // |R⁽ʲ⁾| ≤ 9!/(9−j)! of R's bound; divided by up to σ³ the first derivative is below 12 R, the second below 140 R.
        let slope_doubt = 12.0 * doubt / degree as f64;
        let bend_doubt = 140.0 * doubt / (degree * (degree - 1)) as f64;
        let (mut falls, mut concave, mut convex) = (true, true, true);
        for i in 0..degree {
            falls &= b[i + 1] - b[i] < -slope_doubt;
            if i + 2 <= degree {
                let second = b[i + 2] - 2.0 * b[i + 1] + b[i];
                concave &= second < -bend_doubt;
                convex &= second > bend_doubt;
            }
        }
        if (falls || concave) && end < -doubt {
            return (Verdict::Root(0.0, 1.0), f64::INFINITY);
        }
        if concave && end > doubt && (b[0] > doubt || start == Start::Apart) {
            return (Verdict::Clear, f64::INFINITY);
        }
        if convex && start == Start::Apart {
            if b[1] - b[0] > slope_doubt {
                return (Verdict::Clear, f64::INFINITY);
            }
            if end < -doubt && b[0] > doubt {
                // Convex, positive, then negative: one root.
                return (Verdict::Root(0.0, 1.0), f64::INFINITY);
            }
            let bottom = self.bottom();
            let value = self.value(bottom);
            if value > doubt {
                return (Verdict::Clear, value - doubt);
            }
            if value < -doubt && b[0] > doubt {
                return (Verdict::Root(0.0, bottom), f64::INFINITY);
            }
        }
        (Verdict::Unsure, f64::INFINITY)
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

    /// The root of the polynomial between `low` and `high`, as a first guess.
    #[inline]
    fn root(&self, start: Start, low: f64, high: f64) -> f64 {
        let order = match start {
            Start::Apart => 0,
            Start::Touching { order, .. } => order,
        };
        let (mut lower, mut upper) = (low, high);
        let mut x = high;
        for _ in 0..60 {
            let (mut value, mut slope) = (0.0, 0.0);
            for a in self.a[order..].iter().rev() {
                slope = slope * x + value;
                value = value * x + a;
            }
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
            if step < 2e-3 * x {
                break;
            }
        }
        x
    }
}

impl Window {
    /// A root of the polynomial divided by σ^order, from a guess that is near.
    fn refine(&self, start: Start, guess: f64) -> f64 {
        let order = match start {
            Start::Apart => 0,
            Start::Touching { order, .. } => order,
        };
        let mut x = guess;
        for _ in 0..30 {
            let (mut value, mut slope) = (0.0, 0.0);
            for a in self.a[order..].iter().rev() {
                slope = slope * x + value;
                value = value * x + a;
            }
            let step = value / slope;
            x -= step;
            if !(step.abs() > 2.0 * f64::EPSILON * x.abs()) {
                break;
            }
        }
        x
    }
}

const RECIPROCAL: [f64; DEGREE + 1] =
    [0.0, 1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0, 1.0 / 6.0, 1.0 / 7.0, 1.0 / 8.0];

/// Bernstein coefficients on [0, 1] of Σ aⱼ xʲ up to `degree`: bᵢ = Σ_{j≤i} C(i, j)/C(n, j) aⱼ, by repeated sums.
#[inline]
fn bernstein(a: &[f64; DEGREE + 1], degree: usize) -> [f64; DEGREE + 1] {
    let mut b = [0.0; DEGREE + 1];
    let scale = &INVERSE_BINOMIAL[DEGREE - degree];
    for j in 0..=DEGREE {
        b[j] = a[j] * scale[j];
    }
    for round in 0..degree {
        for i in (round + 1..=degree).rev() {
            b[i] += b[i - 1];
        }
    }
    b
}

/// 1/C(n, j) for n = 8, 7, 6, 5.
const INVERSE_BINOMIAL: [[f64; DEGREE + 1]; 4] = {
    let mut table = [[0.0; DEGREE + 1]; 4];
    let mut row = 0;
    while row < 4 {
        let n = DEGREE - row;
        let mut binomial = 1.0;
        let mut j = 0;
        while j <= n {
            table[row][j] = 1.0 / binomial;
            binomial = binomial * (n - j) as f64 / (j + 1) as f64;
            j += 1;
        }
        row += 1;
    }
    table
};

/// The root of smallest modulus of a quintic whose constant is small: Newton from zero; NaN if that does not settle.
#[inline]
fn root_of_quintic(a: &[f64; 6]) -> f64 {
    let mut x = -a[0] / a[1];
    for _ in 0..20 {
        let value = a[0] + x * (a[1] + x * (a[2] + x * (a[3] + x * (a[4] + x * a[5]))));
        let slope = a[1] + x * (2.0 * a[2] + x * (3.0 * a[3] + x * (4.0 * a[4] + x * 5.0 * a[5])));
        let step = value / slope;
        x -= step;
        // Quadratic convergence: what is left is the square of this.
        if step.abs() <= 1e-8 * x.abs() {
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
        let a = [0.3, -1.2, 0.7, 0.25, -0.1, 0.05, 0.02, -0.01, 0.004];
        let b = bernstein(&a, DEGREE);
        assert!((b[0] - a[0]).abs() < 1e-16 && (b[8] - a.iter().sum::<f64>()).abs() < 1e-15);
        for i in 0..=20 {
            let x = f64::from(i) / 20.0;
            let y = a.iter().rev().fold(0.0, |sum, a| sum * x + a);
            assert!(y >= b.iter().copied().fold(f64::INFINITY, f64::min) - 1e-15);
            assert!(y <= b.iter().copied().fold(f64::NEG_INFINITY, f64::max) + 1e-15);
        }
    }
}
