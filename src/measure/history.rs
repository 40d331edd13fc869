//! What is read off a time history: peaks, compressions, lags between impulses and impacts.

use std::ops::Range;

use super::Measure;
use crate::dynamics::{Drive, Event, EventKind, Response, Sample, SampledParticle};
use crate::scene::{Scene, SingleMass, Structure, drive};

/// A response with a trace, and the scene it is of.
pub(super) struct History<'a> {
    pub(super) response: &'a Response,
    pub(super) scene: &'a Scene,
    /// The cycles that it holds.
    pub(super) cycles: Range<u64>,
}

/// A crest of the base displacement.
#[derive(Debug, Clone, Copy)]
struct Peak {
    time: f64,
    height: f64,
}

impl History<'_> {
    /// Crests, from the cubic through displacement and velocity at the two samples around each.
    fn peaks(&self) -> Vec<Peak> {
        let rises_then_falls = |pair: &[Sample]| pair[0].velocity > 0.0 && pair[1].velocity <= 0.0;
        self.response
            .trace
            .windows(2)
            .filter(|pair| rises_then_falls(pair))
            .map(|pair| crest(&pair[0], &pair[1]))
            .collect()
    }

    pub(super) fn last_peak(&self) -> f64 {
        self.peaks().last().map_or(f64::NAN, |peak| peak.height)
    }

    fn positive_peaks(&self) -> Vec<Peak> {
        let mut peaks = self.peaks();
        peaks.retain(|peak| peak.height > 0.0);
        peaks
    }

    pub(super) fn peak_variation(&self) -> f64 {
        let peaks = self.positive_peaks();
        let (low, high, sum) = peaks.iter().fold((f64::INFINITY, f64::NEG_INFINITY, 0.0), |(low, high, sum), peak| {
            (low.min(peak.height), high.max(peak.height), sum + peak.height)
        });
        if peaks.is_empty() { f64::NAN } else { (high - low) / (sum / peaks.len() as f64) }
    }

    pub(super) fn peak_decay_error(&self) -> f64 {
        let peaks = self.positive_peaks();
        let Some(first) = peaks.first() else { return f64::NAN };
        let rate = decay(self.scene);
        if rate.is_nan() {
            return f64::NAN;
        }
        peaks.iter().fold(0.0, |worst: f64, peak| {
            let expected = first.height * libm::exp(-rate * (peak.time - first.time));
            worst.max((peak.height / expected - 1.0).abs())
        })
    }

    pub(super) fn floor_compression(&self) -> f64 {
        deepest(&self.response.trace, 1, FLOOR)
    }

    pub(super) fn ceiling_compression(&self) -> f64 {
        deepest(&self.response.trace, 1, CEILING)
    }

    /// Shortest time between an impulse and an event of this kind, whichever comes first, s; infinite if there is no such event,
    /// NaN if there is no impulse. A scheme with steps ends its cycles up to one step late: what happens there happens with the
    /// start of the next.
    pub(super) fn lag(&self, kind: EventKind) -> f64 {
        let Drive { period, ticks, repeats, .. } = drive(&self.scene.excitation);
        let struck = || ticks.iter().filter(|tick| tick.impulse != 0.0).map(|tick| tick.time);
        let in_history = repeats || self.cycles.start == 0;
        let Some(first) = struck().next().filter(|_| in_history) else { return f64::NAN };
        let lag = |event: &Event| {
            if !repeats {
                // The first cycle alone is struck.
                let now = event.cycle as f64 * period + event.time;
                return struck().map(|time| (now - time).abs()).fold(f64::INFINITY, f64::min);
            }
            let next = (period + first - event.time).max(0.0);
            struck().map(|time| (event.time - time).abs()).fold(next, f64::min)
        };
        let here = |event: &&Event| event.kind == kind && self.cycles.contains(&event.cycle);
        self.response.events.iter().filter(here).map(lag).fold(f64::INFINITY, f64::min)
    }
}

type Depth = fn(&SampledParticle) -> f64;
const FLOOR: Depth = |it| it.rigid_floor - it.floor;
const CEILING: Depth = |it| it.ceiling - it.rigid_ceiling;

/// The largest of every so many samples, of all particles; a face that is not there is no number.
fn deepest(trace: &[Sample], every: usize, depth: Depth) -> f64 {
    let depths = trace.iter().step_by(every).flat_map(|sample| sample.particles.iter().map(depth));
    depths.fold(0.0, f64::max)
}

/// What a compression, the largest of samples, loses with every second of them.
pub(super) fn sampling_error(measure: Measure, trace: &[Sample]) -> f64 {
    let depth = match measure {
        Measure::FloorCompression => FLOOR,
        Measure::CeilingCompression => CEILING,
        _ => return 0.0,
    };
    deepest(trace, 1, depth) - deepest(trace, 2, depth)
}

fn crest(a: &Sample, b: &Sample) -> Peak {
    let h = b.time - a.time;
    let hermite = |s: f64| {
        let (p, q) = (1.0 - s, s);
        (1.0 + 2.0 * s) * p * p * a.displacement + s * p * p * h * a.velocity + q * q * (3.0 - 2.0 * s) * b.displacement
            - q * q * p * h * b.velocity
    };
    let slope = |s: f64| {
        let rise = (b.displacement - a.displacement) * 6.0 * s * (1.0 - s);
        rise + h * (a.velocity * (1.0 - 4.0 * s + 3.0 * s * s) + b.velocity * (3.0 * s * s - 2.0 * s))
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..52 {
        let middle = 0.5 * (low + high);
        if slope(middle) > 0.0 { low = middle } else { high = middle }
    }
    Peak { time: a.time + low * h, height: hermite(low) }
}

/// Damping of one mass: the exponent of its free decay, c/(2m), 1/s; NaN of more than one.
fn decay(scene: &Scene) -> f64 {
    match scene.structure {
        Structure::SingleMass(SingleMass { mass, damping, .. }) => damping / (2.0 * mass),
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Excitation, PulseShape};

    #[test]
    fn what_a_step_has_put_behind_the_end_of_its_cycle_comes_with_the_next_impulse() {
        let mass = SingleMass { mass: 1.0, stiffness: 1000.0, damping: 3.0 };
        let scene =
            Scene::on_one_mass(mass, 9.81, Vec::new(), Excitation::ImpulseTrain { impulse: 1.0, period: 0.198_69 });
        // 199 steps of 1 ms.
        assert_eq!(lag(&scene, 3, &[0.05, 0.198_999]), 0.0);
        assert_eq!(lag(&scene, 3, &[0.05, 0.17]), 0.198_69 - 0.17);
        assert_eq!(lag(&scene, 3, &[]), f64::INFINITY);
    }

    #[test]
    fn a_lag_is_counted_from_impulses_and_not_from_cycles_without_one() {
        let mass = SingleMass { mass: 1.0, stiffness: 1000.0, damping: 3.0 };
        let of = |excitation, cycle, time| lag(&Scene::on_one_mass(mass, 9.81, Vec::new(), excitation), cycle, &[time]);
        let once = Excitation::SingleImpulse { impulse: 1.0, cycle: 0.2 };
        assert_eq!(of(once.clone(), 0, 0.177), 0.177);
        assert!(of(once, 3, 0.177).is_nan());
        let pulse = |shape| Excitation::PulseTrain { impulse: 1.0, period: 0.2, duration: 0.01, shape };
        // The last of ten stands at 9 ms.
        let binomial = of(pulse(PulseShape::Binomial { impulses: 10 }), 3, 0.01);
        assert!((binomial - 0.001).abs() < 1e-15, "{binomial}");
        let harmonic = Excitation::Harmonic { force: 1.0, angular_frequency: 30.0 };
        let silence = Excitation::SingleImpulse { impulse: 0.0, cycle: 0.2 };
        for without in [pulse(PulseShape::Rectangular), harmonic, silence] {
            assert!(of(without.clone(), 0, 0.01).is_nan(), "{without:?}");
        }
    }

    /// Of floor contacts at these times in one cycle, which is the time history.
    fn lag(scene: &Scene, cycle: u64, times: &[f64]) -> f64 {
        let at = |&time| Event {
            cycle,
            time,
            particle: 0,
            kind: EventKind::FloorContact,
            approach: -1.0,
            departure: -1.0,
            lasts: true,
        };
        let response = Response { events: times.iter().map(at).collect(), ..Response::default() };
        History { response: &response, scene, cycles: cycle..cycle + 1 }.lag(EventKind::FloorContact)
    }
}
