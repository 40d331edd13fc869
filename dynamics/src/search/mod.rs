//! The first event of a flow, certified.
//!
//! A guard g(t) is positive while a contact state holds. Between events it is a parabola plus the shares of the blocks, so
//! that its Taylor polynomial about any instant is known to every order, and so is a bound on what the polynomial leaves
//! out. In a window of Δ seconds, with σ = t/Δ,
//!
//! g(σ) = Σ aⱼ σʲ + R,   |R| ≤ Σₖ ampₖ min(1, (radiusₖ Δ)¹²/12!),
//!
//! the Bernstein coefficients of the polynomial enclose it. They prove that g keeps its sign, or that g, g′ or g″ does and
//! hence that g has one root and no more; else the window is halved. Blocks too fast for the window are left to the bound:
//! far from zero, a slow window proves more than many fast ones.
//!
//! Each guard has its own proof of how long it is clear; the search works on the one whose proof ends first, and no
//! further than the first root that is known. Most guards are cleared by two bounds that cost no window: their parabola is
//! further from zero than all blocks together can reach, or value and slope are larger than their curvature can undo. Where
//! guards are many, a bound on that curvature by the coordinates alone comes first, and for most of them it is enough. No
//! window is sampled, no crossing stepped over. Where a straight line foresees a root within a short window, that window follows at
//! once, with all blocks: small proofs would creep up to the root, and a window without the fast blocks cannot show it.
//!
//! A flow of few blocks with few guards is asked by cells first ([`cells`]), whose tables need no expansion; what they leave open goes to windows.
//!
//! What a root is to the last digit, [`polish`] tells; since no window is seen in it, windows may begin where kernels are cheap, at
//! [`crate::flow::steps::Steps`].

mod cells;
pub(crate) mod guards;
mod polynomial;
mod survey;
pub(crate) mod window;

mod polish;

use crate::arithmetic::wide::widened;
use crate::budget;
use crate::contact::Crossing;
use crate::contact_state::bank::Kernels;
use crate::flow::Flow;
use crate::flow::parabola::Parabola;
use crate::flow::series::{Shares, Span};
use crate::flow::signals::{Signals, Watched};
use crate::search::survey::{Motion, Survey, Surveys, Turns, bound};
use crate::search::window::{Start, Verdict, Window};

/// radius·Δ of a first window: half a turn and a little, since that is how long a face holds a particle. The remainder is
/// then 3.7¹²/12! of the amplitude, about a hundredth.
const REACH: f64 = 3.7;
/// Share of a window that a proof has to be ahead of it before the next one begins there.
const WORTH_A_MOVE: f64 = 0.4;
/// radius·t of the fastest block that has to be proven for the next window to begin there.
const WORTH_A_STEP: f64 = 0.5;
/// Share of a first window below which none is halved for a near miss.
const NEAREST: f64 = 1.0 / 64.0;
/// Share of a guard's value that blocks too fast for its window may reach together.
const NOISE: f64 = 0.25;
/// Share of what can bend in a window that begins at zero, of which no more may be left out: beyond that it would prove nothing.
const DOUBT: f64 = 0.1;
/// radius·Δ of the fastest block that a window must not leave out.
const FASTEST: f64 = 4.8;
/// Guards, times registers of blocks, beyond which they are first looked at by the bends of their signals alone, which most of them pass.
const MANY: usize = 7;
/// What is later than a known root by this factor does not come at the same time.
const AFTER: f64 = 1.0 + 1e-12;
/// Share of what a guard is the sum of that its rounding stays below.
const ROUNDING: f64 = 1e-12;
/// radius·t beyond which no window is taken for a rounding of the time to go.
const MANY_TURNS: f64 = 1e6;

/// A guard at the start of a segment: parabola + sign × signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Guard {
    /// Whose it is.
    pub(crate) particle: usize,
    /// Where it leads.
    pub(crate) crossing: Crossing,
    /// The watched signal that moves it.
    pub(crate) signal: usize,
    pub(crate) sign: f64,
    /// Polynomial part, the sign folded in.
    pub(crate) parabola: Parabola,
    /// How the guard starts.
    pub(crate) start: Start,
    /// Whether the guard is a distance, so that its clearance counts as a margin.
    pub(crate) distance: bool,
}

impl Guard {
    /// Its value `time` seconds after the start, where its signal is `signal`.
    #[inline(always)]
    fn value(&self, time: f64, signal: f64) -> f64 {
        self.parabola.at(time) + self.sign * signal
    }

    /// The smallest margin so far, where it is one that may lower it.
    #[inline(always)]
    fn margin(&self, clarity: &Clarity) -> f64 {
        if self.distance { clarity.margin } else { 0.0 }
    }

    /// How far from zero a proof without a window keeps it: by that margin, or, as long as there is none, by the reach of its signal.
    #[inline(always)]
    fn kept_clear(&self, clarity: &Clarity, reach: f64) -> f64 {
        let margin = self.margin(clarity);
        if margin < f64::INFINITY { margin } else { reach }
    }
}

/// What the search found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Found {
    /// No guard reaches zero before the limit.
    Nothing,
    /// Guard `guard` is the first, `time` seconds after the start.
    Event { guard: usize, time: f64 },
}

/// Running record of how clearly events were decided. Two things change their sequence: a guard that turns back on its way to zero is
/// to reach it, or one that crosses it is to turn back before, about g′²/(2|g″|) beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Clarity {
    /// Smallest distance by which a guard would have to be moved for the sequence to change.
    pub(crate) margin: f64,
    /// Decisions within rounding.
    pub(crate) ties: u64,
}

/// Work space of a search; kept between searches so that nothing is allocated.
#[derive(Debug, Default)]
pub(crate) struct Search {
    /// The guards.
    pub(crate) guards: Vec<Guard>,
    /// Until when each of them is known to stay positive.
    clear: Vec<f64>,
    plans: Vec<Plan>,
    /// Bounds on the second derivatives of the signals, if there are many guards.
    bends: Vec<f64>,
    surveys: Surveys,
    /// Kernels from the segment's start to the result.
    pub(crate) kernels: Vec<Kernels>,
    trial: Vec<Kernels>,
    /// Windows are shorter by this factor, to have a second accuracy to compare with.
    window_factor: f64,
    /// Windows below this are not divided any more, s. It grows from doubt to doubt: a guard that stays within rounding of
    /// zero must not hold up the search.
    shortest: f64,
}

/// The one root of a guard in a window that begins now.
#[derive(Clone, Copy)]
struct Root {
    guard: usize,
    /// First guess of its σ, and an upper bound.
    guess: f64,
    high: f64,
    window: f64,
}

/// How to go on with a guard.
#[derive(Debug, Clone, Copy)]
struct Plan {
    /// When it was made.
    at: f64,
    /// How the guard may turn.
    turning: Turning,
    /// How long it is clear without a window, s.
    quick: f64,
    /// A straight line on from there reaches zero so soon that a window with all blocks may show the root.
    is_near: bool,
    /// A window has begun there.
    begun: bool,
}

/// Bounds on the second and fourth derivatives of what a window has to follow, and the longest window, s.
#[derive(Debug, Clone, Copy)]
struct Turning {
    bend: f64,
    snap: f64,
    longest: f64,
}

impl Turning {
    /// The window that suits it, s; most plans never ask.
    #[inline(always)]
    fn window(self, factor: f64) -> f64 {
        let turn = if self.snap > 0.0 { (self.bend / self.snap).sqrt() } else { f64::INFINITY };
        factor * (REACH * turn).min(self.longest)
    }

    /// Whether so large a share of that window is shorter than `ahead`; it takes no root.
    #[inline(always)]
    fn is_shorter(self, ahead: f64, share: f64) -> bool {
        let turns = share * REACH;
        ahead > share * self.longest || ahead * ahead * self.snap > turns * turns * self.bend
    }
}

impl Plan {
    /// Of a guard that no plan was made for: a proof is worth a move if it reaches [`WORTH_A_MOVE`] of `unit`.
    const fn none(unit: f64) -> Self {
        Self::new(f64::NAN, Turning { bend: 0.0, snap: 0.0, longest: unit }, 0.0)
    }

    const fn new(at: f64, turning: Turning, quick: f64) -> Self {
        Self { at, turning, quick, is_near: false, begun: false }
    }

    /// Windows had better begin where its proof, `ahead` of them, ends; a plan of an earlier instant can tell, too.
    #[inline(always)]
    fn is_overtaken(&self, now: f64, ahead: f64, factor: f64) -> bool {
        ahead > 0.0
            && (self.begun
                || self.turning.is_shorter(ahead, WORTH_A_MOVE * factor) && !(self.is_near && self.at == now))
    }
}

impl Search {
    pub(crate) fn new(window_factor: f64) -> Self {
        Self { window_factor, ..Self::default() }
    }

    widened! {
        /// Finds the first event before `limit` seconds; leaves the kernels of that time, or of the limit.
        pub(crate) fn run | run_wide (&mut self, flow: &Flow, signals: &Signals, limit: f64, clarity: &mut Clarity) -> Found = run_by_width
    }

    #[inline(always)]
    fn run_by_width(&mut self, flow: &Flow, signals: &Signals, limit: f64, clarity: &mut Clarity) -> Found {
        self.bends.clear();
        if self.guards.len() * flow.bank.blocks.len() > MANY && flow.bank.near_critical.is_empty() {
            flow.rows.bound(&flow.bank, signals, &mut self.bends);
        }
        // The same search twice: with a few blocks the compiler unrolls every loop over them.
        let Flow { blocks: each, bank, series, steps, .. } = flow;
        let motion = |blocks| Motion { blocks, each, bank, series, steps: steps.as_ref() };
        match &flow.bank.blocks[..] {
            few @ [_] => {
                if let Some(cells) = &flow.cells
                    && self.window_factor == 1.0
                    && let Some(found) = self.by_cells(motion(few), cells, signals, limit, clarity)
                {
                    return found;
                }
                self.first(motion(few), signals, limit, clarity)
            }
            many => self.first(motion(many), signals, limit, clarity),
        }
    }

    #[inline(always)]
    fn first(&mut self, motion: Motion<'_>, signals: &Signals, limit: f64, clarity: &mut Clarity) -> Found {
        self.start(motion, signals, limit, clarity);
        let mut found = Found::Nothing;
        let mut horizon = limit;
        loop {
            let (guard, clear) = self.least_clear();
            // Below the rounding of the clock nothing can be told apart: what is known comes first.
            if !(clear < horizon - 4.0 * f64::EPSILON * horizon) || budget::spend(1) {
                break;
            }
            let Some(root) = self.look(motion, signals, guard, horizon, limit, clarity) else { continue };
            let time = self.polish(motion, signals, root, clarity);
            self.clear[guard] = f64::INFINITY;
            let earlier = match found {
                Found::Nothing => true,
                Found::Event { guard: other, time: known } => {
                    // Two roots that rounding cannot tell apart: the order of the guards decides.
                    let tie = (time - known).abs() <= 4.0 * f64::EPSILON * known;
                    clarity.ties += u64::from(tie);
                    if tie { guard < other } else { time < known }
                }
            };
            if earlier {
                found = Found::Event { guard, time };
                horizon = time;
                std::mem::swap(&mut self.kernels, &mut self.trial);
            }
        }
        if found == Found::Nothing {
            motion.kernels(limit, &mut self.kernels);
        }
        found
    }

    /// Makes room, and looks at every guard for the first time.
    #[inline(always)]
    fn start(&mut self, motion: Motion<'_>, signals: &Signals, limit: f64, clarity: &Clarity) {
        let count = self.guards.len();
        self.clear.resize(count, 0.0);
        let none = Plan::none(motion.series.unit);
        self.plans.resize(count, none);
        for kernels in [&mut self.kernels, &mut self.trial] {
            kernels.resize(motion.blocks.len(), Kernels::NONE);
        }
        self.surveys.begin(motion, signals);
        self.shortest = shortest(motion, limit);
        for (guard, (plan, clear)) in self.guards.iter().zip(self.plans.iter_mut().zip(&mut self.clear)) {
            if let (Some(bend), Start::Apart) = (self.bends.get(guard.signal), guard.start) {
                (*plan, *clear) = (none, clear_by_bend(signals.of(guard.signal), *bend, guard, clarity));
            } else {
                *plan = plan_of(motion, signals, &mut self.surveys, guard, limit, clarity);
                *clear = plan.quick;
            }
        }
    }

    /// One after the other: a register of several would wait for the one that was written last, by itself.
    #[inline(always)]
    fn least_clear(&self) -> (usize, f64) {
        let mut least = (0, f64::INFINITY);
        for (guard, clear) in self.clear.iter().enumerate() {
            if *clear < least.1 {
                least = (guard, *clear);
            }
        }
        least
    }

    /// Extends the proof of one guard as far as it is written down then, or finds its root.
    #[inline(always)]
    fn look(
        &mut self,
        motion: Motion<'_>,
        signals: &Signals,
        index: usize,
        horizon: f64,
        limit: f64,
        clarity: &mut Clarity,
    ) -> Option<Root> {
        let Self { guards, plans, clear, surveys, shortest: least, window_factor: factor, .. } = self;
        let factor = *factor;
        let (guard, plan, known) = (&guards[index], &mut plans[index], clear[index]);
        let ahead = known - surveys.now;
        let is_overtaken = plan.is_overtaken(surveys.now, ahead, factor);
        if is_overtaken {
            surveys.move_to(motion, known);
        }
        // It is none yet, or windows have moved on since, for this guard or another.
        if is_overtaken || plan.at != surveys.now {
            *plan = plan_of(motion, signals, surveys, guard, limit, clarity);
        }
        let now = surveys.now;
        // Before a root that is foreseen, a window proves more than many such steps.
        if now + plan.quick > known && !(plan.is_near && now + plan.quick < horizon) {
            clear[index] = now + plan.quick;
            return None;
        }
        // A little beyond the first root that is known, to see one that comes at the same time.
        let mut window = plan.turning.window(factor).min(1.25 * (horizon - now)).min(limit - now);
        plan.begun = true;
        let first = window;
        let (survey, shares) = surveys.of(motion, signals, guard.signal, limit);
        let value = || guard.value(now, survey.value);
        if !guard.distance
            && now == 0.0
            && guard.start == Start::Apart
            && value() < -ROUNDING * (guard.parabola.p0.abs() + survey.reach)
        {
            // A force that has jumped, be it by less than the end of a window is known to: the contact state ends as it begins.
            return Some(Root { guard: index, guess: 0.0, high: 0.0, window });
        }
        loop {
            let start = if now == 0.0 { guard.start } else { Start::Apart };
            let indivisible = window <= least.max(64.0 * f64::EPSILON * now);
            if !motion.bank.near_critical.is_empty() {
                bound(motion, shares, 12.0, window);
            }
            let span = Span::new(motion.series, now, window);
            let bounds = motion.series.bounds(shares, &span, start == Start::Apart);
            let hopeless = match start {
                Start::Apart => bounds.leaves_blocks && value() < 2.0 * bounds.left_out,
                Start::Touching { .. } => bounds.left_out > DOUBT * survey.bend * (window * window),
            };
            let (mut ends_below, mut comes_later) = (false, false);
            let verdict = if hopeless && !indivisible {
                Verdict::Unsure
            } else {
                let piece = Window::expand(motion.series, shares, &bounds, guard.sign, guard.parabola, &span, start);
                ends_below = indivisible && piece.end() < 0.0;
                let margin = guard.kept_clear(clarity, survey.reach);
                let mut verdict = piece.judge(margin, |order| {
                    let bent = guard.parabola.p2.abs() * (span.length * span.length);
                    let parabola = if order == 0 { 2.0 * bent } else { 0.0 };
                    parabola + motion.series.bend(shares, span.length * motion.series.pace, order)
                });
                if guard.distance
                    && let Some(miss) =
                        piece.near_miss(&verdict, [known - now, horizon - now].map(|t| t / window), clarity.margin)
                {
                    if miss.is_sharp || window <= NEAREST * first {
                        clarity.margin = clarity.margin.min(miss.clearance);
                    } else {
                        verdict = Verdict::Unsure;
                    }
                }
                comes_later = now + window > horizon && piece.is_positive((horizon * AFTER - now) / window);
                verdict
            };
            match verdict {
                Verdict::Clear => {
                    clear[index] = known.max(now + window);
                    *least = shortest(motion, limit);
                    return None;
                }
                // The one root of the window comes after one that is known.
                Verdict::Root { high: 1.0, .. } if comes_later => {
                    clear[index] = f64::INFINITY;
                    return None;
                }
                Verdict::Root { guess, high } => return Some(Root { guard: index, guess, high, window }),
                // So far the slow blocks alone prove it; from there on with more of them.
                Verdict::Until { sigma } if sigma * window > WORTH_A_STEP * motion.series.unit => {
                    clear[index] = known.max(now + sigma * window);
                    return None;
                }
                Verdict::Unsure | Verdict::Until { .. } if indivisible => {
                    clarity.ties += 1;
                    clarity.margin = 0.0;
                    if ends_below {
                        return Some(Root { guard: index, guess: 1.0, high: 1.0, window });
                    }
                    clear[index] = now + window;
                    *least *= 4.0;
                    return None;
                }
                Verdict::Unsure | Verdict::Until { .. } => {
                    window *= match verdict {
                        Verdict::Until { sigma } => (2.0 * sigma).clamp(0.05, 0.5),
                        _ => 0.5,
                    };
                    let proven = known - now;
                    if window < proven {
                        // Shorter than what is proven already: begin where that ends.
                        surveys.move_to(motion, now + proven);
                        return None;
                    }
                }
            }
        }
    }
}

/// The shortest window, s: a rounding of the time to go, or of a million turns of the fastest block.
#[inline(always)]
fn shortest(motion: Motion<'_>, limit: f64) -> f64 {
    f64::EPSILON * limit.min(MANY_TURNS * motion.series.unit)
}

/// Looks at a guard from now on: the window that suits it, and how long two cheap bounds keep it clear, by more than the
/// smallest margin so far. The fastest blocks are left out of both while all of them together cannot bring it near zero.
#[inline(always)]
fn plan_of(
    motion: Motion<'_>,
    signals: &Signals,
    surveys: &mut Surveys,
    guard: &Guard,
    limit: f64,
    clarity: &Clarity,
) -> Plan {
    let (now, parabola) = (surveys.now, guard.parabola);
    let (survey, shares) = surveys.of(motion, signals, guard.signal, limit);
    let width = motion.blocks.len();
    let here = Parabola { p0: parabola.at(now), p1: parabola.rate(now), p2: parabola.p2 };
    let margin = guard.margin(clarity);
    let Survey { reach, mut bend, mut snap, .. } = *survey;
    let least = guard.kept_clear(clarity, reach);
    if now == 0.0
        && let Start::Touching { order, slope } = guard.start
    {
        // It grows as long as its slope cannot have been turned.
        let turned = here.p2 - 0.5 * bend;
        let until = if turned < 0.0 { -0.5 * slope / turned } else { f64::INFINITY };
        let quick = if order == 1 && until > 0.0 { until } else { 0.0 };
        return Plan::new(now, Turning { bend, snap, longest: f64::INFINITY }, quick);
    }
    if is_never_reached(here, reach + least, margin) {
        return Plan::new(now, Turning { bend, snap, longest: limit }, f64::INFINITY);
    }
    let (mut value, mut rate) = (guard.sign * survey.value, guard.sign * survey.rate);
    let all = FASTEST * motion.series.unit;
    let is_near = here.p0 + value < -all * (here.p1 + rate);
    let mut longest = if is_near { all } else { f64::INFINITY };
    let mut noise = ROUNDING * (here.p0.abs() + reach);
    if width > 1 {
        let most = NOISE * (here.p0 + value - least);
        let mut slow = 0;
        while slow + 1 < width {
            let Shares { now, amplitude } = &shares[slow];
            let more = noise + amplitude.sum();
            if !(more < most) {
                break;
            }
            noise = more;
            value -= guard.sign * now.value.sum();
            rate -= guard.sign * now.rate.sum();
            slow += 1;
        }
        longest = longest.min(FASTEST / motion.series.fastest[slow]);
        if slow > 0 {
            let turns = Turns::of(&motion.blocks[slow..], &shares[slow..]);
            (bend, snap) = (turns.bend.sum(), turns.snap.sum());
        }
    }
    let curve = Parabola { p0: here.p0 + value, p1: here.p1 + rate, p2: here.p2 - 0.5 * bend };
    Plan { is_near, ..Plan::new(now, Turning { bend, snap, longest }, clear_until(curve, noise + least, margin)) }
}

/// Whether a parabola stays further from zero than `reach`, and does not come closer to that than `margin`; it takes no root.
#[inline(always)]
fn is_never_reached(parabola: Parabola, reach: f64, margin: f64) -> bool {
    let Parabola { p0, p1, p2 } = parabola;
    let above = p0 - reach;
    above > 0.0 && p2 >= 0.0 && (p1 >= 0.0 || p1 * p1 <= 4.0 * p2 * (above - margin))
}

/// How long the bounds on the bends of signals alone keep a guard clear: most guards are looked at no more than so.
#[inline(always)]
fn clear_by_bend(signal: Watched<'_>, bend: f64, guard: &Guard, clarity: &Clarity) -> f64 {
    let Parabola { p0, p1, p2 } = guard.parabola;
    let curve =
        Parabola { p0: p0 + guard.sign * signal.sum.value, p1: p1 + guard.sign * signal.sum.rate, p2: p2 - 0.5 * bend };
    let margin = guard.margin(clarity);
    clear_until(curve, ROUNDING * (p0.abs() + signal.size) + margin, margin)
}

/// How long a parabola keeps further from zero than `reach`; 0 if it is not so now, nor where it may come closer to that
/// than `margin`, so that no jump passes over the narrowest place of a run.
#[inline(always)]
fn clear_until(parabola: Parabola, reach: f64, margin: f64) -> f64 {
    if is_never_reached(parabola, reach, margin) {
        return f64::INFINITY;
    }
    let Parabola { p0, p1: b, p2: a } = parabola;
    let c = p0 - reach;
    let discriminant = b * b - 4.0 * a * c;
    if !(c > 0.0 && discriminant >= 0.0) {
        return 0.0;
    }
    // The first positive root of c + b τ + a τ², written without cancellation.
    let root = discriminant.sqrt();
    if b <= 0.0 { 2.0 * c / (root - b) } else { (b + root) / (-2.0 * a) }
}
