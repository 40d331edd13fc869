//! How weak a drive still carries a particle from face to face, with one impact on the floor and one on the ceiling a period.
//!
//! Such a motion is linear piece by piece. Let the ceiling be met τ after the floor, by a particle that leaves the floor with v₁ and the
//! ceiling with v₂. Both flights are parabolas, so that v₂ follows from v₁ and τ, and with it both impulses, m (v₁ − v₁⁻) and
//! m (v₂⁻ − v₂). The structure answers them by the steady response to a train of unit impulses. What is left of the motion of the faces
//! is the harmonic share H = C cos ωt + S sin ωt, t since the floor was met:
//!
//!   S from the impact on the floor, v₁ − w⁺ = −ε (v₁⁻ − w⁻),
//!   C from the flight, H(τ) − H(0) + h = the height that the particle gains less the part of the impulses,
//!   v₁ from the impact on the ceiling.
//!
//! All three are linear for a given τ. The strength is √(C² + S²) over the amplitude of the present drive, and the least of all τ is
//! looked for: below it there is no such motion. Motions that are seen to pass a face between their impacts are left out.
//! Without weight and with equal restitution, τ = T/2 leaves v₁ free: Masri and Caughey's symmetric motion, whose strength is the
//! distance of a straight line from the origin.

use super::struck::{At, Struck, harmonic_velocity, least, restitution};
use crate::arithmetic::elementary::sin_cos;
use crate::arithmetic::matrix::dot;
use crate::budget;

/// Times between the impacts that are looked at, evenly spaced.
const TIMES: u32 = 256;
/// Beside a time at which v₁ grows without limit: shares of the period by halving, from the first power to the last.
const HALVINGS: std::ops::Range<i32> = 8..48;
/// Places of a flight at which it is held against the faces, and how far beyond one rounding may take it.
const PLACES: u32 = 12;
const ROUNDING: f64 = 1e-9;
/// Halvings that find such a time.
const STEPS: u32 = 80;

/// The share of the drive's present strength; `None` where a face is resilient, or where no strength makes such a motion.
pub(super) fn share(struck: &Struck<'_>) -> Option<f64> {
    let restitution = [restitution(&struck.particle.floor)?, restitution(struck.ceiling)?];
    TwoImpacts { struck, restitution }.least()
}

/// Motions with two impacts a period.
struct TwoImpacts<'a> {
    struck: &'a Struck<'a>,
    /// ε of floor and ceiling.
    restitution: [f64; 2],
}

/// Up and down again by the same height.
struct Flights {
    /// m.
    height: f64,
    /// With which the particle leaves the ceiling, m/s.
    v2: f64,
}

/// What the impulses and the flights leave to the harmonic share for one v₁.
#[derive(Clone, Copy)]
struct Wanted {
    /// C and S, m.
    share: [f64; 2],
    /// By how much the impact on the ceiling is missed, m/s.
    missed: f64,
    /// Impulses on floor and ceiling, N s.
    impulses: [f64; 2],
}

impl Wanted {
    /// Between that of v₁ = 0 and that of v₁ = 1.
    fn at(from: &Self, to: &Self, v: f64) -> Self {
        let between = |a: f64, b: f64| a + (b - a) * v;
        let pair = |a: [f64; 2], b: [f64; 2]| [between(a[0], b[0]), between(a[1], b[1])];
        Self {
            share: pair(from.share, to.share),
            missed: between(from.missed, to.missed),
            impulses: pair(from.impulses, to.impulses),
        }
    }

    /// Amplitude of the harmonic share, m; infinite where a face would have to pull.
    fn amplitude(&self) -> f64 {
        let strikes = self.impulses.iter().all(|impulse| *impulse > 0.0);
        if strikes { libm::hypot(self.share[0], self.share[1]) } else { f64::INFINITY }
    }
}

impl TwoImpacts<'_> {
    fn flights(&self, tau: f64, v1: f64) -> Flights {
        let (g, rest) = (self.struck.gravity, self.struck.period() - tau);
        let height = v1 * tau - 0.5 * g * tau * tau;
        Flights { height, v2: 0.5 * g * rest - height / rest }
    }

    /// What a motion wants that meets the ceiling τ after the floor, and leaves the floor with v₁.
    fn wanted(&self, tau: f64, v1: f64, answers: &Answers) -> Wanted {
        let Struck { particle, gravity: g, omega, .. } = *self.struck;
        let (rest, mass) = (self.struck.period() - tau, particle.mass);
        let Flights { height, v2 } = self.flights(tau, v1);
        let before = [v2 - g * rest, v1 - g * tau];
        let impulses = [mass * (v1 - before[0]), mass * (before[1] - v2)];
        let [floor, ceiling] = self.restitution;
        let Answers { just_before, just_after, of_floor, of_ceiling } = *answers;
        let train = |of_own: f64, of_other: f64, [own, other]: [f64; 2]| of_own * own + of_other * other;
        // Impulses push the structure down at the floor, up at the ceiling.
        let at_floor = [-impulses[0], impulses[1]];
        let at_ceiling = [impulses[1], -impulses[0]];
        let w = |other: At, strikes: [f64; 2]| [just_before.v, just_after.v].map(|own| train(own, other.v, strikes));
        let rate = harmonic_velocity(floor, [before[0], v1], w(of_ceiling, at_floor));
        let s = rate / omega;
        let risen = train(just_after.x, of_floor.x, at_ceiling) - train(just_after.x, of_ceiling.x, at_floor);
        let (sine, cosine) = sin_cos(omega * tau);
        let c = (height - particle.gap - risen - s * sine) / (cosine - 1.0);
        let later = omega * (s * cosine - c * sine);
        let missed = later - harmonic_velocity(ceiling, [before[1], v2], w(of_floor, at_ceiling));
        Wanted { share: [c, s], missed, impulses }
    }

    /// For any v₁, as a straight line.
    fn line(&self, tau: f64) -> [Wanted; 2] {
        let answers = Answers {
            just_before: self.struck.answer(self.struck.period()),
            just_after: self.struck.answer(0.0),
            of_floor: self.struck.answer(tau),
            of_ceiling: self.struck.answer(self.struck.period() - tau),
        };
        [0.0, 1.0].map(|v1| self.wanted(tau, v1, &answers))
    }

    /// How fast the miss at the ceiling grows with v₁: where that is nothing, v₁ grows without limit.
    fn bend(&self, tau: f64) -> f64 {
        let [from, to] = self.line(tau);
        to.missed - from.missed
    }

    /// The amplitude of the harmonic share of the motion with this τ; infinite where there is none.
    fn at(&self, tau: f64) -> f64 {
        if budget::spend(1) {
            return f64::INFINITY;
        }
        let [from, to] = self.line(tau);
        let v1 = -from.missed / (to.missed - from.missed);
        let wanted = Wanted::at(&from, &to, v1);
        let amplitude = if v1.is_finite() { wanted.amplitude() } else { f64::INFINITY };
        if amplitude.is_finite() && self.passes_a_face(tau, v1, &wanted) { f64::INFINITY } else { amplitude }
    }

    /// Somewhere on its flights the particle is beyond a face: no such motion is there. That it is not proves nothing, as few places are
    /// looked at.
    fn passes_a_face(&self, tau: f64, v1: f64, wanted: &Wanted) -> bool {
        let Struck { particle, gravity: g, omega, .. } = *self.struck;
        let period = self.struck.period();
        let ([c, s], [of_floor, of_ceiling]) = (wanted.share, wanted.impulses);
        let face = |t: f64| {
            let (sine, cosine) = sin_cos(omega * t);
            let since = if t < tau { t + period - tau } else { t - tau };
            c * cosine + s * sine - of_floor * self.struck.answer(t).x + of_ceiling * self.struck.answer(since).x
        };
        let start = face(0.0);
        let Flights { height, v2 } = self.flights(tau, v1);
        let flights = [(0.0, tau, start, v1), (tau, period - tau, start + height, v2)];
        flights.into_iter().any(|(from, length, place, velocity)| {
            (1..PLACES).any(|i| {
                let t = length * f64::from(i) / f64::from(PLACES);
                let gap = place + velocity * t - 0.5 * g * t * t - face(from + t);
                gap < -ROUNDING * particle.gap || gap > (1.0 + ROUNDING) * particle.gap
            })
        })
    }

    /// The smallest amplitude of the symmetric motion, whose v₁ is free.
    fn symmetric(&self) -> f64 {
        let [floor, ceiling] = self.restitution;
        if self.struck.gravity != 0.0 || floor != ceiling {
            return f64::INFINITY;
        }
        let [from, to] = self.line(0.5 * self.struck.period());
        let along = [to.share[0] - from.share[0], to.share[1] - from.share[1]];
        let foot = -dot(&from.share, &along) / dot(&along, &along);
        // At rest at the start of the line, a face is grazed.
        if foot > 0.0 { Wanted::at(&from, &to, foot).amplitude() } else { libm::hypot(from.share[0], from.share[1]) }
    }

    fn least(&self) -> Option<f64> {
        let amplitude = least(&self.times(), |tau| self.at(tau)).min(self.symmetric());
        amplitude.is_finite().then_some(amplitude / self.struck.amplitude)
    }

    /// The times that are looked at: evenly, and ever closer to those at which v₁ grows without limit.
    fn times(&self) -> Vec<f64> {
        let period = self.struck.period();
        let even: Vec<f64> = (1..TIMES).map(|i| period * f64::from(i) / f64::from(TIMES)).collect();
        let bends: Vec<f64> = even.iter().map(|tau| self.bend(*tau)).collect();
        let mut times = even.clone();
        for i in 1..even.len() {
            if bends[i - 1] * bends[i] > 0.0 {
                continue;
            }
            let at = self.no_bend([even[i - 1], even[i]], bends[i - 1]);
            let beside = HALVINGS.flat_map(|power| [-1.0, 1.0].map(|side| at + side * libm::ldexp(period, -power)));
            times.extend(beside.filter(|tau| *tau > 0.0 && *tau < period));
        }
        times.sort_by(f64::total_cmp);
        times
    }

    /// By halving.
    fn no_bend(&self, [mut low, mut high]: [f64; 2], sign: f64) -> f64 {
        for _ in 0..STEPS {
            let middle = 0.5 * (low + high);
            if self.bend(middle) * sign > 0.0 { low = middle } else { high = middle }
        }
        low
    }
}

/// The faces under a train of unit impulses.
#[derive(Clone, Copy)]
struct Answers {
    /// As one comes.
    just_before: At,
    /// Once it has come.
    just_after: At,
    /// At the impact on the ceiling, of the train on the floor.
    of_floor: At,
    /// At the impact on the floor, of the train on the ceiling.
    of_ceiling: At,
}
