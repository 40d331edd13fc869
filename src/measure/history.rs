//! What is read off a time history: peaks, compressions, lags between impulses and impacts.

use std::ops::Range;

use super::evaluate::decay;
use crate::dynamics::{Event, EventKind, Response, Sample, SampledParticle};
use crate::scene::Scene;

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

    pub(super) fn peak_variation(&self) -> f64 {
        let peaks = self.peaks();
        let (low, high, sum) = peaks.iter().fold((f64::INFINITY, f64::NEG_INFINITY, 0.0), |(low, high, sum), peak| {
            (low.min(peak.height), high.max(peak.height), sum + peak.height)
        });
        if peaks.is_empty() { f64::NAN } else { (high - low) / (sum / peaks.len() as f64) }
    }

    pub(super) fn peak_decay_error(&self) -> f64 {
        let peaks = self.peaks();
        let Some(first) = peaks.first() else { return f64::NAN };
        let rate = decay(self.scene);
        peaks.iter().fold(0.0, |worst: f64, peak| {
            let expected = first.height * libm::exp(-rate * (peak.time - first.time));
            worst.max((peak.height / expected - 1.0).abs())
        })
    }

    pub(super) fn floor_compression(&self) -> f64 {
        self.deepest(|it| it.rigid_floor - it.floor)
    }

    pub(super) fn ceiling_compression(&self) -> f64 {
        self.deepest(|it| it.ceiling - it.rigid_ceiling)
    }

    /// Of the first particle.
    fn deepest(&self, depth: fn(SampledParticle) -> f64) -> f64 {
        self.response.trace.iter().fold(0.0, |deepest, sample| f64::max(deepest, depth(sample.first())))
    }

    /// Shortest time between the start of a forcing cycle and an event of this kind, s; infinite if there is none. A scheme with
    /// steps ends its cycles up to one step late: what happens there happens with the start of the next.
    pub(super) fn lag(&self, kind: EventKind) -> f64 {
        let period = self.scene.excitation.period();
        let here = |event: &&Event| event.kind == kind && self.cycles.contains(&event.cycle);
        let lags = self.response.events.iter().filter(here);
        lags.map(|event| event.time.min(period - event.time).max(0.0)).fold(f64::INFINITY, f64::min)
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Excitation, SingleMass};

    #[test]
    fn what_a_step_has_put_behind_the_end_of_its_cycle_comes_with_the_next_impulse() {
        let mass = SingleMass { mass: 1.0, stiffness: 1000.0, damping: 3.0 };
        let scene =
            Scene::on_one_mass(mass, 9.81, Vec::new(), Excitation::ImpulseTrain { impulse: 1.0, period: 0.198_69 });
        let at = |time| Event {
            cycle: 3,
            time,
            particle: 0,
            kind: EventKind::FloorContact,
            approach: -1.0,
            departure: -1.0,
        };
        let lag = |times: &[f64]| {
            let response = Response { events: times.iter().map(|&time| at(time)).collect(), ..Response::default() };
            History { response: &response, scene: &scene, cycles: 3..4 }.lag(EventKind::FloorContact)
        };
        // 199 steps of 1 ms.
        assert_eq!(lag(&[0.05, 0.198_999]), 0.0);
        assert_eq!(lag(&[0.05, 0.17]), 0.198_69 - 0.17);
        assert_eq!(lag(&[]), f64::INFINITY);
    }
}
