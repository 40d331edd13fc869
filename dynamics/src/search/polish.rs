//! The instant of an event, to the last digit, whatever search has found it.
//!
//! With δ = 0.024/ρ, ρ the largest radius of a block, a root t of a guard comes from its Taylor polynomial about the whole step kδ that
//! is nearest to it,
//!
//! g(kδ + x) = Σ gⱼ xʲ/j!,   |x| ≤ δ/2,
//!
//! which leaves out less than rounding. So the bits of t depend on the guard alone: not on the windows that have isolated the root,
//! nor on the first guess. Beside a graze the step may see another root than the one that was isolated; then Newton's method comes first,
//! within the bracket of the window.

use super::{Clarity, Guard, Root, Search, Start};
use crate::contact_state::bank::Kernels;
use crate::flow::series::Span;
use crate::flow::signals::{Signals, Watched};
use crate::flow::steps::STEP;
use crate::search::polynomial::nearest_root;
use crate::search::survey::Motion;
use crate::search::window::Window;

/// radius·t below which a window polynomial leaves out less than rounding.
const SHORT_HOP: f64 = 0.02;
/// radius·δ below which the local expansion of a guard, to the seventh, is exact to rounding.
const NEAR: f64 = 0.03;
/// Whole steps that are asked which of them is nearest to the root; two may take turns.
const DISPUTES: u32 = 4;
/// Steps of [`STEP`] beyond which a time is not rounded to one.
const MANY_STEPS: f64 = 1e9;

/// Where the one root of a guard is, s from the segment's start.
#[derive(Clone, Copy)]
struct Bracket<'a> {
    /// The guard, and its signal at the segment's start.
    guard: Guard,
    initial: Watched<'a>,
    from: f64,
    to: f64,
}

impl Bracket<'_> {
    /// But for rounding at its ends.
    #[inline(always)]
    fn holds(&self, time: f64) -> bool {
        let slack = 1e-3 * (self.to - self.from);
        time >= self.from - slack && time <= self.to + slack
    }
}

/// What the expansion about a whole step says of a root.
enum AboutStep {
    Found(f64),
    /// Another step is nearer to it.
    Nearer(f64),
    /// It has a root of its own.
    Another,
}

impl Search {
    /// The time of an isolated root, to the last digit; leaves its kernels on trial. It comes from the expansion about the whole
    /// step that is nearest to it, so that neither the windows nor the first guess that led there are seen in its bits.
    #[inline(always)]
    pub(super) fn polish(&mut self, motion: Motion<'_>, signals: &Signals, root: Root, clarity: &mut Clarity) -> f64 {
        let guard = self.guards[root.guard];
        let (t, window) = (self.surveys.now, root.window);
        if root.high == 0.0 {
            motion.kernels(t, &mut self.trial);
            return t;
        }
        if t == 0.0 && guard.start != Start::Apart && root.guess * window * motion.series.pace < SHORT_HOP {
            return self.polish_short_hop(motion, root);
        }
        let bracket = Bracket { initial: signals.of(guard.signal), guard, from: t, to: t + root.high * window };
        let mut guess = t + window * root.guess;
        for _ in 0..DISPUTES {
            match self.about_step(motion, &bracket, guess, clarity) {
                AboutStep::Found(time) => return time,
                AboutStep::Nearer(next) => guess = next,
                AboutStep::Another => break,
            }
        }
        self.polish_within(motion, &bracket, guess, clarity)
    }

    /// The root as the whole step nearest to `guess` has it, if that is nearest to the root, too.
    #[inline(always)]
    fn about_step(
        &mut self,
        motion: Motion<'_>,
        bracket: &Bracket<'_>,
        guess: f64,
        clarity: &mut Clarity,
    ) -> AboutStep {
        let step = STEP * self.window_factor * motion.series.unit;
        let time = nearest_step(guess, step);
        let steps = motion.steps.filter(|_| self.window_factor == 1.0);
        if let Some((steps, whole)) = steps.and_then(|steps| Some((steps, steps.at(time)?))) {
            steps.kernels(motion.bank, motion.each, whole, &mut self.trial);
        } else {
            motion.kernels(time, &mut self.trial);
        }
        let local = self.local(motion, bracket, time);
        let scaled = nearest_root(&local);
        let delta = scaled * motion.series.unit;
        let next = time + delta;
        // Beside the one root of the window there may be another that is nearer, where the guard comes back.
        if !(bracket.holds(next) && slope(&local, scaled) < 0.0) {
            return AboutStep::Another;
        }
        let next = next.max(bracket.from);
        let is_lost = time >= MANY_STEPS * step;
        if (is_lost || nearest_step(next, step) == time) && scaled.abs() < NEAR {
            // What the clock rounds off is a visible part of a turn there.
            let delta = if is_lost { delta } else { next - time };
            self.follow_on(motion, bracket, &local, delta, clarity);
            return AboutStep::Found(next);
        }
        AboutStep::Nearer(next)
    }

    /// From a guess that no whole step can tell from another root: by Newton's method within the bracket, and what is nearest then.
    #[cold]
    fn polish_within(&mut self, motion: Motion<'_>, bracket: &Bracket<'_>, guess: f64, clarity: &mut Clarity) -> f64 {
        let time = self.newton_within(motion, bracket, guess, clarity);
        if let AboutStep::Found(time) = self.about_step(motion, bracket, time, clarity) {
            return time;
        }
        motion.kernels(time, &mut self.trial);
        let local = self.local(motion, bracket, time);
        self.follow_on(motion, bracket, &local, 0.0, clarity);
        time
    }

    /// Halving the bracket where Newton's method leaves it.
    fn newton_within(&mut self, motion: Motion<'_>, bracket: &Bracket<'_>, guess: f64, clarity: &mut Clarity) -> f64 {
        let (mut within, mut time) = (*bracket, guess);
        for _ in 0..60 {
            motion.kernels(time, &mut self.trial);
            let local = self.local(motion, bracket, time);
            if local[0] >= 0.0 {
                within.from = within.from.max(time)
            } else {
                within.to = within.to.min(time)
            }
            let scaled = nearest_root(&local);
            let delta = scaled * motion.series.unit;
            let next = time + delta;
            if within.holds(next) || delta.abs() <= 8.0 * f64::EPSILON * time {
                time = next.max(bracket.from);
                if scaled.abs() < NEAR {
                    return time;
                }
            } else {
                // A graze.
                time = 0.5 * (within.from + within.to);
            }
            if within.to - within.from <= 4.0 * f64::EPSILON * within.to {
                break;
            }
        }
        clarity.ties += 1;
        time
    }

    /// From the kernels of a time to those of a root `delta` later; how clear it is.
    #[inline(always)]
    fn follow_on(
        &mut self,
        motion: Motion<'_>,
        bracket: &Bracket<'_>,
        local: &[f64; 8],
        delta: f64,
        clarity: &mut Clarity,
    ) {
        for (kernels, blocks) in self.trial.iter_mut().zip(motion.blocks) {
            *kernels = blocks.follow_on(kernels, delta);
        }
        if bracket.guard.distance {
            // So far it goes on beyond zero at least before it turns back: up to where |g″| τ + |g‴| τ²/2 has taken up its slope.
            let root = delta * motion.series.pace;
            let (slope, bend, third) = (slope(local, root), bend(local, root), third(local, root));
            let turn = bend.abs() + (bend * bend + 2.0 * (slope * third).abs()).sqrt();
            let beyond = if slope == 0.0 { 0.0 } else { slope * slope / turn };
            clarity.margin = clarity.margin.min(beyond);
        }
    }

    /// A hop so short that the window's polynomial is exact, while the difference of parabola and blocks is all rounding.
    #[cold]
    fn polish_short_hop(&mut self, motion: Motion<'_>, root: Root) -> f64 {
        let guard = self.guards[root.guard];
        let window = 2.0 * SHORT_HOP * motion.series.unit;
        let span = Span::new(motion.series, 0.0, window);
        let shares = self.surveys.shares(guard.signal);
        let bounds = motion.series.bounds(shares, &span, false);
        let piece = Window::expand(motion.series, shares, &bounds, guard.sign, guard.parabola, &span, guard.start);
        let scale = root.window / window;
        let time = window * piece.refine(scale * root.guess, (scale * root.high).min(1.0));
        for (kernels, blocks) in self.trial.iter_mut().zip(motion.blocks) {
            *kernels = blocks.follow_on(&Kernels::NONE, time);
        }
        time
    }

    /// Taylor coefficients of a guard about `time`, to the seventh, in powers of ρδ.
    #[inline(always)]
    fn local(&self, motion: Motion<'_>, Bracket { initial, guard, .. }: &Bracket<'_>, time: f64) -> [f64; 8] {
        let moved = motion.blocks.iter().zip(&self.trial).zip(initial.phases);
        let moved = moved.map(|((blocks, kernels), phases)| blocks.advance(*phases, &kernels.transfer()));
        let mut a = [0.0; 8];
        a.as_chunks_mut().0.copy_from_slice(&motion.series.expand::<0, 2>(moved));
        let unit = motion.series.unit;
        let parabola = guard.parabola;
        let rest = [parabola.at(time), parabola.rate(time) * unit, parabola.p2 * (unit * unit)];
        a.iter_mut().for_each(|a| *a *= guard.sign);
        for (a, rest) in a.iter_mut().zip(rest) {
            *a += rest;
        }
        a
    }
}

/// The slope of an expansion at a root that is near.
#[inline(always)]
fn slope(local: &[f64; 8], root: f64) -> f64 {
    local[1] + root * (2.0 * local[2] + 3.0 * root * local[3])
}

/// The bend there.
#[inline(always)]
fn bend(local: &[f64; 8], root: f64) -> f64 {
    2.0 * local[2] + root * (6.0 * local[3] + root * (12.0 * local[4] + 20.0 * root * local[5]))
}

/// How the bend changes there.
#[inline(always)]
fn third(local: &[f64; 8], root: f64) -> f64 {
    6.0 * local[3] + root * (24.0 * local[4] + 60.0 * root * local[5])
}

/// The whole step nearest to a time; the time itself where steps are lost in its rounding.
#[inline(always)]
fn nearest_step(time: f64, step: f64) -> f64 {
    /// A number and this have no digits behind the point.
    const WHOLE: f64 = 1.5 * (1_u64 << 52) as f64;
    let steps = time / step;
    if steps < MANY_STEPS { ((steps + WHOLE) - WHOLE) * step } else { time }
}
