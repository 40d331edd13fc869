//! A stretch: steps of one contact state, until a guard says that it no longer holds. Here the time goes.

use super::ahead::{AHEAD, Ahead, Forces, Foresight};
use super::propagator::Propagator;
use super::schedule::Oscillator;
use super::vector::Vector;
use super::watch::Watch;
use crate::response::audit::Passed;
use crate::response::extremes::Extremes;

/// A contact state that was visited.
pub(super) struct Visited<V: Vector> {
    pub(super) propagator: Propagator<V>,
    /// None where half cycles ask after each step.
    pub(super) ahead: Option<Ahead<V>>,
}

/// What moves.
#[derive(Clone)]
pub(super) struct Motion<V> {
    pub(super) state: V,
    spare: V,
    /// Constant force, N.
    pub(super) level: f64,
    pub(super) oscillator: Option<Oscillator>,
    pub(super) half: Option<HalfCycle>,
}

/// The half cycle of the base acceleration that is under way, from its samples at the end of each step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct HalfCycle {
    /// Its sign; 0 before the first sample.
    pub(super) sign: f64,
    /// A sample under the damping of its own has had that sign: until then the renewal may have thrown the acceleration back.
    begun: bool,
    square: f64,
    count: f64,
    /// RMS of the last complete one, m/s².
    pub(super) last: f64,
}

/// Sums over the states at the ends of steps.
pub(super) struct Tally<V> {
    pub(super) steps: u64,
    pub(super) state: V,
    pub(super) displacement_square: f64,
    pub(super) velocity_square: f64,
    /// Squares of displacement and velocity of all further observed points.
    pub(super) more: Vec<[f64; 2]>,
    /// Ranges of all observed points; empty unless asked for.
    pub(super) extremes: Vec<Extremes>,
    /// Audit only: powers and forces in the place of their integrals, no times and no positions.
    pub(super) passed: Passed,
}

impl<V: Vector> Tally<V> {
    pub(super) fn new(size: usize, more: usize, extremes: bool) -> Self {
        Self {
            steps: 0,
            state: V::of(&vec![0.0; size]),
            displacement_square: 0.0,
            velocity_square: 0.0,
            more: vec![[0.0; 2]; more],
            extremes: if extremes { vec![Extremes::default(); 1 + more] } else { Vec::new() },
            passed: Passed::default(),
        }
    }
}

impl HalfCycle {
    /// A contact makes the acceleration jump: a half cycle that has not begun is of the sign that this leaves.
    pub(super) fn jumps(&mut self) {
        if !self.begun {
            self.sign = 0.0;
        }
    }

    /// Takes a sample; true when it is the first of a new half cycle.
    #[inline(always)]
    fn take(&mut self, acceleration: f64) -> bool {
        let against = acceleration * self.sign < 0.0;
        let turned = against && self.begun;
        if turned {
            self.last = (self.square / self.count).sqrt();
            (self.square, self.count) = (0.0, 0.0);
        }
        if turned || self.sign == 0.0 {
            self.sign = if acceleration < 0.0 { -1.0 } else { 1.0 };
        }
        self.begun = !against;
        self.square += acceleration * acceleration;
        self.count += 1.0;
        turned
    }
}

impl<V: Vector> Motion<V> {
    pub(super) fn new(state: &[f64], oscillator: Option<Oscillator>, half: Option<HalfCycle>) -> Self {
        Self { state: V::of(state), spare: V::of(state), level: 0.0, oscillator, half }
    }

    /// Force in force from now on, N.
    pub(super) fn force(&self) -> f64 {
        self.level + self.oscillator.map_or(0.0, |oscillator| oscillator.value())
    }

    #[inline(always)]
    pub(super) fn forces(&self) -> Forces {
        let [sine, cosine] = self.oscillator.map_or([0.0; 2], |oscillator| oscillator.forces());
        [self.level, sine, cosine]
    }

    /// Up to `steps` steps: how many were made, and whether the last one ended where the contact state does not hold, or a
    /// half cycle turned.
    #[inline(always)]
    pub(super) fn stretch<const AUDIT: bool>(
        &mut self,
        Visited { propagator, ahead }: &Visited<V>,
        watch: &Watch<V>,
        steps: u64,
        tally: &mut Tally<V>,
    ) -> Stretch {
        let Some(ahead) = ahead else { return self.one_by_one::<AUDIT>(propagator, watch, steps, tally) };
        let mut made = 0;
        while made < steps {
            let next = (steps - made).min(AHEAD);
            if next == AHEAD && self.leap::<AUDIT>(ahead, watch, tally) {
                made += next;
                continue;
            }
            let end = self.one_by_one::<AUDIT>(propagator, watch, next, tally);
            made += end.steps;
            if end.broken {
                return Stretch { steps: made, ..end };
            }
        }
        Stretch { steps, broken: false, turned: false }
    }

    /// Makes [`AHEAD`] steps at once, unless the contact state does not hold after some of them.
    #[inline(always)]
    pub(super) fn leap<const AUDIT: bool>(&mut self, ahead: &Ahead<V>, watch: &Watch<V>, tally: &mut Tally<V>) -> bool {
        let forces = self.forces();
        let state = &self.state;
        let at = |signal: &Foresight| signal.at(state, &forces);
        if ahead.guards.iter().any(|guard| at(guard).is_ever_negative()) {
            return false;
        }
        let [first, more @ ..] = &ahead.observed[..] else { return false };
        let [displacement, velocity] = first;
        tally.velocity_square += at(velocity).sum_of_squares();
        if watch.with_displacement {
            tally.displacement_square += at(displacement).sum_of_squares();
        }
        for (squares, signals) in tally.more.iter_mut().zip(more) {
            squares.iter_mut().zip(signals).for_each(|(square, signal)| *square += at(signal).sum_of_squares());
        }
        for (extremes, [displacement, velocity]) in tally.extremes.iter_mut().zip(&ahead.observed) {
            at(displacement).each().zip(at(velocity).each()).for_each(|(place, rate)| extremes.take(place, rate));
        }
        if AUDIT {
            tally.passed.dissipated += ahead.dissipation.iter().fold(0.0, |sum, row| sum + at(row).sum_of_squares());
            if forces != [0.0; 3] {
                let mut place = watch.forced.dot(state);
                for (force, here) in at(&ahead.force).each().zip(at(&ahead.forced).each()) {
                    tally.passed.drive(1.0, force, force * (here - place));
                    place = here;
                }
            }
        }
        ahead.sum.apply(state, &forces, &mut self.spare);
        tally.state.add(&self.spare);
        ahead.end.apply(state, &forces, &mut self.spare);
        std::mem::swap(&mut self.state, &mut self.spare);
        if let (Some(oscillator), Some(turn)) = (&mut self.oscillator, ahead.turn) {
            oscillator.advance_by(AHEAD, turn);
        }
        tally.steps += AHEAD;
        true
    }

    /// The same as a stretch, each step after the one before it.
    #[inline(always)]
    pub(super) fn one_by_one<const AUDIT: bool>(
        &mut self,
        propagator: &Propagator<V>,
        watch: &Watch<V>,
        steps: u64,
        tally: &mut Tally<V>,
    ) -> Stretch {
        // Worked on in locals: the compiler keeps them in registers.
        let (mut state, mut next) = (self.state.take(), self.spare.take());
        let mut oscillator = self.oscillator;
        let mut force = self.force();
        let forced = oscillator.is_some() || force != 0.0;
        let (mut displacement_square, mut velocity_square) = (tally.displacement_square, tally.velocity_square);
        let mut place = watch.forced.dot(&state);
        let mut end = Stretch { steps, broken: false, turned: false };
        for step in 1..=steps {
            V::advance(&propagator.matrix, &propagator.offset, &propagator.input, force, &state, &mut next);
            std::mem::swap(&mut state, &mut next);
            tally.state.add(&state);
            let velocity = watch.velocity.dot(&state);
            velocity_square += velocity * velocity;
            if watch.with_displacement {
                let displacement = watch.displacement.dot(&state);
                displacement_square += displacement * displacement;
            }
            for (squares, rows) in tally.more.iter_mut().zip(&watch.more) {
                for (square, row) in squares.iter_mut().zip(rows) {
                    let value = row.dot(&state);
                    *square += value * value;
                }
            }
            if let Some((first, more)) = tally.extremes.split_first_mut() {
                first.take(watch.displacement.dot(&state), velocity);
                for (extremes, [displacement, velocity]) in more.iter_mut().zip(&watch.more) {
                    extremes.take(displacement.dot(&state), velocity.dot(&state));
                }
            }
            if AUDIT {
                for row in &propagator.dissipation {
                    let rate = row.dot(&state);
                    tally.passed.dissipated += rate * rate;
                }
                if forced {
                    let here = watch.forced.dot(&state);
                    let work = force * (here - place);
                    place = here;
                    tally.passed.drive(1.0, force, work);
                }
            }
            if let Some(oscillator) = &mut oscillator {
                oscillator.advance();
                force = self.level + oscillator.value();
            }
            let mut broken = false;
            for guard in &propagator.guards {
                broken |= guard.at(&state, force) < 0.0;
            }
            let turned = match &mut self.half {
                None => false,
                Some(half) => half.take(propagator.base_acceleration.at(&state, force)),
            };
            if broken || turned {
                end = Stretch { steps: step, broken, turned };
                break;
            }
        }
        (self.state, self.spare) = (state, next);
        self.oscillator = oscillator;
        (tally.displacement_square, tally.velocity_square) = (displacement_square, velocity_square);
        tally.steps += end.steps;
        end
    }
}

/// How a stretch ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    pub(super) steps: u64,
    /// The contact state no longer holds.
    pub(super) broken: bool,
    /// A half cycle of the acceleration is over.
    pub(super) turned: bool,
}
