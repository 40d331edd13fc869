//! The first event of a flow, certified.
//!
//! A guard g(t) is positive while a contact state holds. Between events it is a parabola plus the shares of the blocks, so
//! that its Taylor polynomial about any instant is known to every order, and so is a bound on what the polynomial leaves
//! out. In a window of Δ seconds, with σ = t/Δ,
//!
//! g(σ) = Σ aⱼ σʲ + R,   |R| ≤ Σₖ ampₖ (radiusₖ Δ)¹²/12!,
//!
//! the Bernstein coefficients of the polynomial enclose it. They prove that g keeps its sign, or that g, g′ or g″ does and
//! hence that g has one root and no more; else the window is halved. Where the parabola alone is further from zero than
//! all blocks together can reach, the search jumps there without looking. No window is sampled, no crossing stepped over.

use super::block::{Block, Kernel, Phase};
use super::flow::Parabola;
use super::polynomial::nearest_root;
use super::series::Series;
use super::window::{Span, Start, Verdict, Window};

/// radius·Δ of a first window: half a turn and a little, since that is how long a face holds a particle. The remainder is
/// then 3.7¹²/12! of the amplitude, about a hundredth.
const REACH: f64 = 3.7;
/// radius·t below which a window polynomial leaves out less than rounding.
const SHORT_HOP: f64 = 0.02;
/// radius·δ below which the local expansion of a guard, to the seventh, is exact to rounding.
const NEAR: f64 = 0.03;

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
    /// Bounds on them from then on.
    amplitudes: Vec<f64>,
    /// Their sums: how far the blocks of each guard can reach.
    reach: Vec<f64>,
    /// Until when each guard is known to stay positive; empty unless there was doubt at the segment's start.
    proven: Vec<f64>,
    /// Kernels from the segment's start to the result.
    pub(crate) kernels: Vec<Kernel>,
    /// First windows are shortened by this factor, to have a second accuracy to compare with.
    window_factor: f64,
    /// Windows below this are not divided any more, s. It grows from doubt to doubt: a guard that stays within rounding of
    /// zero must not hold up the search.
    shortest: f64,
}

/// How fast the fastest guard moves: its speed squared is snap/bend.
struct Pace {
    bend: f64,
    snap: f64,
    /// The parabola of every guard is further from zero than its blocks can reach.
    all_apart: bool,
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

impl Search {
    pub(crate) fn new(window_factor: f64) -> Self {
        Self {
            initial: Vec::new(),
            guards: Vec::new(),
            current: Vec::new(),
            amplitudes: Vec::new(),
            reach: Vec::new(),
            proven: Vec::new(),
            kernels: Vec::new(),
            window_factor,
            shortest: 0.0,
        }
    }

    pub(crate) fn clear(&mut self) {
        self.guards.clear();
        self.initial.clear();
    }

    /// Finds the first event before `limit` seconds; leaves the kernels of that time, or of the limit.
    pub(crate) fn run(&mut self, blocks: &[Block], series: &Series, limit: f64, clarity: &mut Clarity) -> Found {
        let found = self.first(blocks, series, limit, clarity);
        if found == Found::Nothing {
            self.kernels_at(blocks, limit);
        }
        found
    }

    fn first(&mut self, blocks: &[Block], series: &Series, limit: f64, clarity: &mut Clarity) -> Found {
        if self.guards.is_empty() {
            return Found::Nothing;
        }
        self.current.clear();
        self.current.extend_from_slice(&self.initial);
        self.amplitudes.resize(self.initial.len(), 0.0);
        self.reach.resize(self.guards.len(), 0.0);
        self.proven.clear();
        let mut t = 0.0;
        let clock = f64::EPSILON * limit;
        self.shortest = clock;
        loop {
            let remaining = limit - t;
            // Below the rounding of the clock nothing can be told apart: what happens at the limit comes first.
            if remaining <= 4.0 * f64::EPSILON * limit {
                return Found::Nothing;
            }
            let pace = self.survey(blocks, t, remaining);
            if pace.all_apart {
                let skip = self.until_one_is_near(t, remaining, clarity.margin);
                if skip >= remaining {
                    return Found::Nothing;
                }
                // A jump is worth its kernels only if it saves a good part of a window.
                if skip * skip * pace.snap > 0.25 * pace.bend {
                    t += skip;
                    self.move_to(blocks, t);
                    continue;
                }
            }
            let mut window = remaining.min(REACH * self.window_factor * (pace.bend / pace.snap).sqrt());
            let ties = clarity.ties;
            if let Some(root) = self.search_window(blocks, series, t, &mut window, clarity) {
                if root.high == 0.0 {
                    self.kernels_at(blocks, t);
                    return Found::Event { guard: root.guard, time: t };
                }
                return Found::Event { guard: root.guard, time: self.polish(blocks, series, root, t, window, clarity) };
            }
            self.shortest = if clarity.ties > ties { 4.0 * self.shortest } else { clock };
            t += window;
            if limit - t <= 4.0 * f64::EPSILON * limit {
                return Found::Nothing;
            }
            self.move_to(blocks, t);
        }
    }

    /// Bounds every guard from `t` on, and finds out how fast the fastest of them moves.
    #[inline(always)]
    fn survey(&mut self, blocks: &[Block], t: f64, remaining: f64) -> Pace {
        let mut pace = Pace { bend: 1.0, snap: 0.0, all_apart: true };
        for (index, guard) in self.guards.iter().enumerate() {
            let shares = index * blocks.len()..(index + 1) * blocks.len();
            let (mut reach, mut bend, mut snap) = (0.0, 0.0, 0.0);
            let shares = self.current[shares.clone()].iter().zip(&mut self.amplitudes[shares]);
            for (block, (share, bound)) in blocks.iter().zip(shares) {
                let amplitude = block.amplitude(*share, 0.0, remaining);
                *bound = amplitude;
                let square = block.radius * block.radius;
                reach += amplitude;
                bend += amplitude * square;
                snap += amplitude * square * square;
            }
            self.reach[index] = reach;
            pace.all_apart &= guard.parabola.at(t) > reach;
            if snap * pace.bend > pace.snap * bend {
                (pace.bend, pace.snap) = (bend, snap);
            }
        }
        pace
    }

    /// How long the parabolas alone keep every guard further from zero than its blocks can reach.
    fn until_one_is_near(&self, t: f64, remaining: f64, margin: f64) -> f64 {
        let clear = |(guard, reach): (&Guard, &f64)| {
            clear_until(guard.parabola, t, *reach, if guard.distance { margin } else { 0.0 })
        };
        self.guards.iter().zip(&self.reach).map(clear).fold(remaining, f64::min)
    }

    /// Proves the window clear of roots (`None`) or isolates the first one; shrinks the window until it can.
    fn search_window(
        &mut self,
        blocks: &[Block],
        series: &Series,
        t: f64,
        window: &mut f64,
        clarity: &mut Clarity,
    ) -> Option<Root> {
        let mut piece = Window::new();
        let asked = *window;
        'shrink: loop {
            let mut first: Option<Root> = None;
            let indivisible = *window <= self.shortest.max(64.0 * f64::EPSILON * t);
            let span = Span::new(series, t, *window);
            for index in 0..self.guards.len() {
                let guard = self.guards[index];
                let reach = self.reach[index];
                let margin = if guard.distance { clarity.margin.min(reach) } else { 0.0 };
                let proven = self.proven.get(index).is_some_and(|until| *until >= t + *window);
                if proven || stays_apart(guard.parabola, t, *window, reach + margin) {
                    continue;
                }
                if series.near_critical {
                    self.bound(blocks, index, *window);
                }
                match self.judge(series, index, &span, &mut piece) {
                    Verdict::Clear { clearance } => {
                        if let Some(until) = self.proven.get_mut(index) {
                            *until = t + *window;
                        }
                        if guard.distance {
                            clarity.margin = clarity.margin.min(clearance);
                        }
                    }
                    Verdict::Root { guess, high } => {
                        let short = t == 0.0 && guard.start != Start::Apart;
                        if high == 0.0 {
                            return Some(Root { guard: index, guess, high, short });
                        }
                        match first {
                            None => first = Some(Root { guard: index, guess, high, short }),
                            // Two guards in one window: narrow until one of them is clear, or they are one to the rounding.
                            Some(_) if !indivisible => {
                                *window *= 0.5;
                                continue 'shrink;
                            }
                            Some(_) => clarity.ties += 1,
                        }
                    }
                    Verdict::Unsure if indivisible => {
                        if t == 0.0 && self.proven.is_empty() {
                            self.prove_hops(blocks, series, asked);
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
    fn prove_hops(&mut self, blocks: &[Block], series: &Series, asked: f64) {
        self.proven.resize(self.guards.len(), 0.0);
        let mut piece = Window::new();
        for index in 0..self.guards.len() {
            let mut window = asked;
            while self.guards[index].start != Start::Apart && window > self.proven[index] {
                self.bound(blocks, index, window);
                match self.judge(series, index, &Span::new(series, 0.0, window), &mut piece) {
                    Verdict::Clear { .. } => self.proven[index] = window,
                    _ => window *= 0.5,
                }
            }
        }
    }

    /// What the enclosure of a guard over a window proves.
    #[inline(always)]
    fn judge(&self, series: &Series, index: usize, span: &Span, piece: &mut Window) -> Verdict {
        self.expand(series, index, span, piece);
        piece.judge(|order| {
            let amplitudes = &self.amplitudes[self.shares(series.len(), index)];
            let bent = self.guards[index].parabola.p2.abs() * (span.length * span.length);
            let parabola = if order == 0 { 2.0 * bent } else { 0.0 };
            parabola + series.bend(amplitudes, span.length * series.pace, order)
        })
    }

    /// A guard over a window that begins with the current shares.
    #[inline(always)]
    fn expand(&self, series: &Series, index: usize, span: &Span, piece: &mut Window) {
        let guard = &self.guards[index];
        let start = if span.from == 0.0 { guard.start } else { Start::Apart };
        let shares = self.shares(series.len(), index);
        piece.expand(series, &self.current[shares.clone()], &self.amplitudes[shares], guard.parabola, span, start);
    }

    /// Places of a guard's shares.
    #[inline]
    fn shares(&self, width: usize, index: usize) -> std::ops::Range<usize> {
        index * width..(index + 1) * width
    }

    /// Bounds anew the shares of blocks near critical damping, for the twelfth derivative over one window.
    #[cold]
    fn bound(&mut self, blocks: &[Block], index: usize, window: f64) {
        let shares = self.shares(blocks.len(), index);
        for ((amplitude, share), block) in
            self.amplitudes[shares.clone()].iter_mut().zip(&self.current[shares]).zip(blocks)
        {
            *amplitude = block.amplitude(*share, 12.0, window);
        }
    }

    /// The time of an isolated root, to the last digit; leaves its kernels.
    fn polish(
        &mut self,
        blocks: &[Block],
        series: &Series,
        root: Root,
        t: f64,
        window: f64,
        clarity: &mut Clarity,
    ) -> f64 {
        let parabola = self.guards[root.guard].parabola;
        if root.short && root.guess * window * series.pace < SHORT_HOP {
            return self.polish_short_hop(blocks, series, root, window);
        }
        let (mut lower, mut upper) = (t, t + root.high * window);
        let slack = 1e-3 * (upper - lower);
        let mut time = t + window * root.guess;
        for _ in 0..60 {
            self.kernels_at(blocks, time);
            let local = self.local(blocks, series, root.guard, parabola, time);
            if local[0] >= 0.0 {
                lower = lower.max(time)
            } else {
                upper = upper.min(time)
            }
            let mut scaled = nearest_root(&local);
            let mut delta = scaled * series.unit;
            let mut next = time + delta;
            if (next >= lower - slack && next <= upper + slack) || delta.abs() <= 8.0 * f64::EPSILON * time {
                if next < t {
                    // Rounding has put the root of a guard that starts near zero before the window; time never runs backwards.
                    (next, delta) = (t, t - time);
                    scaled = delta / series.unit;
                }
                if scaled.abs() < NEAR {
                    for (kernel, block) in self.kernels.iter_mut().zip(blocks) {
                        *kernel = block.compose(*kernel, block.kernel_near_zero(delta));
                    }
                    if self.guards[root.guard].distance {
                        // The guard would have to be moved by about g′²/(2|g″|) for this crossing to vanish.
                        let bend = (4.0 * local[2].abs()).max(f64::MIN_POSITIVE);
                        let slope = local[1] + scaled * (2.0 * local[2] + 3.0 * scaled * local[3]);
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
    fn polish_short_hop(&mut self, blocks: &[Block], series: &Series, root: Root, window: f64) -> f64 {
        let mut piece = Window::new();
        self.expand(series, root.guard, &Span::new(series, 0.0, window), &mut piece);
        let time = window * piece.refine(root.guess, root.high);
        self.kernels.clear();
        self.kernels.extend(blocks.iter().map(|block| block.kernel_near_zero(time)));
        time
    }

    /// Taylor coefficients of a guard about `time`, to the seventh, in powers of ρδ.
    #[inline]
    fn local(&self, blocks: &[Block], series: &Series, guard: usize, parabola: Parabola, time: f64) -> [f64; 8] {
        let initial = &self.initial[self.shares(blocks.len(), guard)];
        let moved = blocks.iter().zip(&self.kernels).zip(initial);
        let mut a = series.expand::<0, 8>(moved.map(|((block, kernel), phase)| block.advance(*phase, *kernel)));
        let unit = series.unit;
        let rest = [parabola.at(time), parabola.rate(time) * unit, parabola.p2 * (unit * unit)];
        for (a, rest) in a.iter_mut().zip(rest) {
            *a += rest;
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

/// Whether the parabola alone keeps further from zero than `reach` for a window; a quick test, sure if it says so.
#[inline]
fn stays_apart(parabola: Parabola, t: f64, window: f64, reach: f64) -> bool {
    let fall = (parabola.rate(t) * window).min(0.0) + (parabola.p2 * (window * window)).min(0.0);
    parabola.at(t) + fall > reach
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
