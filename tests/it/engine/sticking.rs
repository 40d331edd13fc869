//! Where a particle that lands without a bounce begins to leave at once, instead of staying until its face falls away, in closed form.

use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix2, Vector2};
use shotdamp::dynamics::{Along, Branch, BranchEnd, EventKind, HybridSystem, Options, Orbit, Special, StartState};
use shotdamp::scene::Excitation;

use super::bench::{GRAVITY, base, close, damper, in_flight, rigid, scene, system, within};
use super::motion::Table;
use super::orbits::{STIFFNESS, Stopped, oscillator};

fn follow(
    systems: impl Fn(f64) -> HybridSystem,
    orbit: &Orbit,
    begin: f64,
    [from, to]: [f64; 2],
) -> Branch<Infallible> {
    let along = Along { from, to, step: 0.02, points: 500 };
    Branch::follow(|parameter| Ok(systems(parameter)), orbit, begin, along).expect("it has a first orbit")
}

fn places(branch: &Branch<Infallible>, kind: Special) -> Vec<f64> {
    branch.points.iter().filter(|point| point.special == Some(kind)).map(|point| point.parameter).collect()
}

fn time(orbit: &Orbit, kind: EventKind) -> Option<f64> {
    orbit.response.events.iter().find(|event| event.kind == kind).map(|event| event.time)
}

/// Phase of a flight from the phase sin φ = 1/Γ: in units of g and ω it has the height 1 − cos t + s (t − sin t) − t²/2, s² = Γ² − 1.
fn flight(acceleration: f64) -> f64 {
    let speed = (acceleration * acceleration - 1.0).sqrt();
    let above = |t: f64| 1.0 - t.cos() + speed * (t - t.sin()) - 0.5 * t * t > 0.0;
    let [mut low, mut high] = [0.1, 2.5 * TAU];
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if above(middle) { low = middle } else { high = middle }
    }
    low
}

/// A plastic ball lands after a cycle with the phase of its take-off at s = π (Mehta & Luck 1990). Above that it lands at cos φ = π/Γ,
/// where the table falls faster than it would, until that motion doubles its period at Γ² = π² + 4.
#[test]
fn a_plastic_ball_stops_to_stay_where_its_flight_takes_a_cycle() {
    let comes_back = PI.hypot(1.0);
    let systems = |acceleration: f64| system(&Table::new(0.0, acceleration).scene());
    let begin = 2.0;
    let run = Options { skip: 0, average: 40, start: Table::new(0.0, begin).start(0.001), ..Options::default() };
    let orbit = Orbit::after(&systems(begin), &run).expect("it settles");
    assert_eq!((orbit.cycles, orbit.contacts), (1, 1));
    let branch = follow(systems, &orbit, begin, [begin, 3.9]);
    assert_eq!(branch.end, BranchEnd::Range);
    let specials: Vec<Special> = branch.points.iter().filter_map(|point| point.special).collect();
    assert_eq!(specials, [Special::Sticking, Special::PeriodDoubling]);
    close("sticking", places(&branch, Special::Sticking)[0], comes_back, 1e-10);
    close("period doubling", places(&branch, Special::PeriodDoubling)[0], PI.hypot(2.0), 1e-10);
    for point in branch.points.iter().filter(|point| point.special.is_none()) {
        let table = Table::new(0.0, point.parameter);
        let phase = |time: f64| (table.omega * time - table.lag).rem_euclid(TAU);
        let lands = phase(time(&point.orbit, EventKind::FloorContact).expect("it lands"));
        let leaves = time(&point.orbit, EventKind::FloorRelease).map(phase);
        if point.parameter < comes_back {
            let phase = (1.0 / point.parameter).asin();
            within("take-off", leaves.expect("it stays"), phase, 1e-10);
            within("landing", lands, (phase + flight(point.parameter)).rem_euclid(TAU), 1e-10);
        } else {
            assert_eq!(leaves, None);
            within("landing", lands, (PI / point.parameter).acos(), 1e-10);
        }
    }
    // The same from the other side.
    let last = branch.points.last().expect("it has points");
    let down = follow(systems, &last.orbit, last.parameter, [last.parameter, begin]);
    close("sticking, downwards", places(&down, Special::Sticking)[0], comes_back, 1e-10);
}

#[test]
fn the_flight_of_a_plastic_ball_is_born_where_the_table_falls_with_gravity() {
    let begin = 1.3;
    let systems = |acceleration: f64| system(&Table::new(0.0, acceleration).scene());
    let run = Options { skip: 0, average: 40, start: Table::new(0.0, begin).start(0.001), ..Options::default() };
    let orbit = Orbit::after(&systems(begin), &run).expect("it settles");
    let branch = follow(systems, &orbit, begin, [begin, 0.9]);
    let BranchEnd::Graze { parameter } = branch.end else { panic!("{:?}", branch.end) };
    close("birth of the flight", parameter, 1.0, 1e-10);
}

/// A particle with mass that flies for a cycle: it leaves with g T/2, comes back with −g T/2, and gives the structure the jump −μ g T.
/// With x = a and v = b of the answer to a train of such jumps, the structure has v = (1 + 2 μ) g T/2 before the landing, and −g after it
/// where the particle begins to stay.
struct Carried {
    ratio: f64,
    particle: f64,
}

impl Carried {
    fn omega(&self) -> f64 {
        self.ratio * STIFFNESS.sqrt()
    }

    fn system(&self, force: f64) -> HybridSystem {
        let drive = Excitation::Harmonic { force, angular_frequency: self.omega() };
        let loose = damper(self.particle, f64::INFINITY, rigid(0.0));
        system(&scene(base(1.0, STIFFNESS, Stopped::damping()), GRAVITY, loose, drive))
    }

    /// The force at which it begins to stay, and the state at the start of a cycle there.
    fn sticking(&self) -> (f64, StartState) {
        let omega = self.omega();
        let period = TAU / omega;
        let leaves = 0.5 * GRAVITY * period;
        let jump = Vector2::new(0.0, -2.0 * self.particle * leaves);
        let flow = oscillator(period);
        let train = (Matrix2::identity() - flow).try_inverse().expect("it is damped") * flow * jump;
        let after = train + jump;
        let bend = -STIFFNESS * after[0] - Stopped::damping() * after[1];
        let harmonic = Vector2::new((GRAVITY + bend) / (omega * omega), (leaves - after[1]) / omega);
        let (amplitude, theta) = (harmonic.norm(), harmonic[0].atan2(harmonic[1]));
        let stiffness = (STIFFNESS - omega * omega).hypot(Stopped::damping() * omega);
        let lag = (Stopped::damping() * omega).atan2(STIFFNESS - omega * omega);
        let since = period - (theta + lag).rem_euclid(TAU) / omega;
        let free = oscillator(since) * after;
        let (x, v) = (free[0] - amplitude * lag.sin(), free[1] + amplitude * omega * lag.cos());
        let place = harmonic[0] + train[0] + leaves * since - 0.5 * GRAVITY * since * since;
        (amplitude * stiffness, in_flight([x, v], [place - x, leaves - GRAVITY * since - v]))
    }
}

#[test]
fn a_particle_with_mass_begins_to_stay_where_the_structure_falls_with_gravity_after_the_impact() {
    for (ratio, particle) in [(0.8, 0.1), (1.3, 0.05), (1.6, 0.1), (2.2, 0.3)] {
        let carried = Carried { ratio, particle };
        let (expected, start) = carried.sticking();
        for off in [-0.01, 0.01] {
            let begin = (1.0 + off) * expected;
            let orbit = Orbit::near(&carried.system(begin), &start, 1).expect("it is near");
            let range = [begin, (1.0 - off) * expected];
            let branch = follow(|force| carried.system(force), &orbit, begin, range);
            let [place] = places(&branch, Special::Sticking)[..] else { panic!("one point between both motions") };
            close(&format!("ω′ = {ratio}, μ = {particle}, sticking"), place, expected, 1e-10);
            let [first, last] = [&orbit, &branch.points.last().expect("it has points").orbit];
            let stays = |orbit: &Orbit| time(orbit, EventKind::FloorRelease).is_some();
            assert_ne!(stays(first), stays(last));
        }
    }
}
