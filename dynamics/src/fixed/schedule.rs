//! The clock of the fixed step: which step a forcing cycle, a jump of the force or a sample falls on.
//!
//! An impulse has to fall on a step, so the period of a train is rounded to whole steps (199 steps of 1 ms for a natural period of 0.1987 s). A
//! harmonic force has no such instant: it is read off sin ω t at the start of each step, and its period stays what it is.

use crate::arithmetic::elementary::sin_cos;
use crate::error::EngineError;
use crate::system::{Drive, Harmonic, Tick};

/// Shortest step, as a share of the period: below it a run would not end in a lifetime.
const SHORTEST: f64 = 1e-9;

/// A drive in steps.
#[derive(Debug, Clone)]
pub(super) struct Schedule {
    /// Steps in a cycle: whole for a train, any number for a harmonic force.
    steps: f64,
    /// Jumps of the force within a cycle.
    pub(super) ticks: Vec<StepTick>,
}

/// A jump of the force, by steps into the cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StepTick {
    pub(super) step: u64,
    /// N s.
    pub(super) impulse: f64,
    /// Force from then on, N.
    pub(super) level: f64,
}

impl Schedule {
    pub(super) fn of(drive: &Drive, time_step: f64) -> Result<Self, EngineError> {
        let period = drive.period;
        if !(time_step > SHORTEST * period && time_step <= period) {
            return Err(EngineError::TimeStep { time_step, period });
        }
        let free = drive.harmonic_alone().is_some();
        let steps = if free { period / time_step } else { (period / time_step).round().max(1.0) };
        let ticks = if free { Vec::new() } else { ticks(&drive.ticks, period, steps, time_step) };
        Ok(Self { steps, ticks })
    }

    /// First step of a cycle.
    pub(super) fn cycle(&self, cycle: u64) -> u64 {
        self.nearest(cycle, 0.0)
    }

    /// The step nearest to an instant, given in cycles.
    pub(super) fn nearest(&self, cycle: u64, share: f64) -> u64 {
        ((cycle as f64 + share) * self.steps).round() as u64
    }

    /// Angle that a harmonic force turns in a step, rad: where the period is rounded, the frequency goes with it.
    pub(super) fn angle(&self, harmonic: Harmonic, period: f64) -> f64 {
        harmonic.angular_frequency * period / self.steps
    }
}

/// Jumps at the nearest steps. A level that its rounded duration would weaken or strengthen is adapted, so that a pulse
/// keeps its impulse; one shorter than half a step becomes an impulse.
fn ticks(ticks: &[Tick], period: f64, steps: f64, time_step: f64) -> Vec<StepTick> {
    let end = steps as u64;
    let step = |time: f64| (time / time_step).round().min(steps) as u64;
    let mut rounded: Vec<StepTick> = Vec::with_capacity(ticks.len());
    for (i, tick) in ticks.iter().enumerate() {
        let next = ticks.get(i + 1);
        let (first, last) = (step(tick.time), next.map_or(end, |next| step(next.time)));
        let given = tick.level * (next.map_or(period, |next| next.time) - tick.time);
        let (impulse, level) = match last.saturating_sub(first) {
            0 => (tick.impulse + given, 0.0),
            length => (tick.impulse, given / (length as f64 * time_step)),
        };
        let before = rounded.last_mut();
        if first < end {
            match before {
                Some(before) if before.step == first => {
                    (before.impulse, before.level) = (before.impulse + impulse, level)
                }
                _ => rounded.push(StepTick { step: first, impulse, level }),
            }
        } else if impulse != 0.0 {
            // Rounded to the end of the cycle: given at its last step, and what lasts until the end goes on.
            let level = before.as_ref().map_or(0.0, |before| before.level);
            match before {
                Some(before) if before.step == end - 1 => before.impulse += impulse,
                _ => rounded.push(StepTick { step: end - 1, impulse, level }),
            }
        }
    }
    rounded
}

/// F sin(ω k Δt + φ), step by step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Oscillator {
    force: f64,
    phase: f64,
    angle: f64,
    rotation: (f64, f64),
    now: (f64, f64),
    step: u64,
}

/// Steps by rotation between two exact values.
const EXACT_EVERY: u64 = 64;

impl Oscillator {
    /// At step 0, turning by `angle` radians a step.
    pub(super) fn new(Harmonic { force, phase, .. }: Harmonic, angle: f64) -> Self {
        Self { force, phase, angle, rotation: sin_cos(angle), now: sin_cos(phase), step: 0 }
    }

    #[inline(always)]
    pub(super) fn value(&self) -> f64 {
        self.force * self.now.0
    }

    /// F sin and F cos.
    #[inline(always)]
    pub(super) fn forces(&self) -> [f64; 2] {
        let (sine, cosine) = self.now;
        [self.force * sine, self.force * cosine]
    }

    /// Sine and cosine of the angle of so many steps.
    pub(super) fn turned(&self, steps: usize) -> (f64, f64) {
        sin_cos(self.angle * steps as f64)
    }

    #[inline(always)]
    pub(super) fn advance(&mut self) {
        self.advance_by(1, self.rotation);
    }

    /// Some steps on, fewer than [`EXACT_EVERY`], which turn it by an angle of this sine and cosine.
    #[inline(always)]
    pub(super) fn advance_by(&mut self, steps: u64, (sine, cosine): (f64, f64)) {
        let ((s, c), before) = (self.now, self.step);
        self.step += steps;
        self.now = if self.step / EXACT_EVERY > before / EXACT_EVERY {
            sin_cos(self.angle * self.step as f64 + self.phase)
        } else {
            (s * cosine + c * sine, c * cosine - s * sine)
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn train(period: f64, ticks: Vec<Tick>) -> Drive {
        Drive { period, ticks, repeats: true, harmonic: None, half_cycles: None }
    }

    #[test]
    fn impulses_fall_on_whole_steps() {
        let once = || vec![Tick { time: 0.0, impulse: 1.0, level: 0.0 }];
        let natural = 1000_f64.sqrt();
        for (ratio, steps, cycle, named) in [(1.0, 199, 1, 0.199), (0.5351, 371, 141, 52.31), (0.4314, 461, 114, 52.55)]
        {
            let drive = train(std::f64::consts::TAU / (ratio * natural), once());
            let schedule = Schedule::of(&drive, 1e-3).unwrap();
            assert_eq!(schedule.cycle(1), steps);
            assert!((schedule.cycle(cycle) as f64 * 1e-3 - named).abs() < 0.005);
        }
    }

    #[test]
    fn a_pulse_keeps_its_impulse_on_any_step() {
        let pulse = vec![Tick { time: 0.0, impulse: 0.0, level: 100.0 }, Tick { time: 0.01, impulse: 0.0, level: 0.0 }];
        for time_step in [1e-4, 1e-3, 3e-3, 0.0101, 0.05] {
            let schedule = Schedule::of(&train(0.199, pulse.clone()), time_step).unwrap();
            let steps = schedule.cycle(1);
            let mut impulse = 0.0;
            for (i, tick) in schedule.ticks.iter().enumerate() {
                let until = schedule.ticks.get(i + 1).map_or(steps, |next| next.step);
                impulse += tick.impulse + tick.level * (until - tick.step) as f64 * time_step;
            }
            assert!((impulse - 1.0).abs() < 1e-12, "{time_step}: {impulse}");
        }
    }

    #[test]
    fn a_harmonic_force_keeps_its_period_and_its_phase() {
        let harmonic = Some(crate::system::Harmonic { force: 3.0, angular_frequency: 30.861, phase: 0.0 });
        let period = std::f64::consts::TAU / 30.861;
        let schedule = Schedule::of(&Drive { harmonic, ..train(period, Vec::new()) }, 1e-2).unwrap();
        assert_eq!(schedule.cycle(125), (125.0 * period / 1e-2).round() as u64);
        let force = Harmonic { force: 3.0, angular_frequency: 30.861, phase: 0.5 };
        let mut oscillator = Oscillator::new(force, 30.861e-2);
        for _ in 0..1000 {
            oscillator.advance();
        }
        assert!((oscillator.value() - 3.0 * libm::sin(309.11)).abs() < 1e-12);
    }

    #[test]
    fn a_step_that_does_not_fit_is_refused() {
        for time_step in [0.0, -1e-3, f64::NAN, f64::INFINITY, 0.3, 1e-12] {
            assert!(matches!(Schedule::of(&train(0.2, Vec::new()), time_step), Err(EngineError::TimeStep { .. })));
        }
    }
}
