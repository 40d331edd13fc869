//! Periodic motions found by Newton's method, and branches of them, against closed forms: stable and unstable ones, folds, doublings
//! and grazes.

use std::collections::BTreeSet;
use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix2, Matrix4, Vector2, Vector4};
use shotdamp::dynamics::{
    Along, Branch, BranchEnd, Contact, EventKind, HybridSystem, Multiplier, Options, Orbit, OrbitError, Special,
    StartState, Until, event_driven,
};
use shotdamp::scene::{ContactDamping, ContactEnd, Excitation, Scene, Surface};

use super::bench::{GRAVITY, base, close, damper, in_flight, nothing, resilient, rigid, scene, system, within};
use super::closed_forms::{Steady, expected, fixed_stop, masri_and_caughey, one_floor_impact, open, table};
use super::motion::{Table, trace_and_product};

/// The orbit next to the last state of a run of one mass and one particle in flight, `off` beside it.
fn beside(steady: &Steady, off: f64, cycles: u32) -> Orbit {
    let [y, w] = steady.response.final_particles[0];
    let (x, v) = (steady.response.final_displacement + off, steady.response.final_velocity);
    let orbit = Orbit::near(&system(&steady.scene), &in_flight([x, v], [y - x, w - v]), cycles).expect("it is near");
    assert!(orbit.distance <= 1e-12, "{:e}", orbit.distance);
    within("product of the multipliers", orbit.residual, 0.0, 1e-12);
    orbit
}

/// ω t and relative speed of the first floor contact of an orbit.
pub(super) fn floor_contact(orbit: &Orbit, omega: f64) -> [f64; 2] {
    let events = &orbit.response.events;
    let contact = events.iter().find(|event| event.kind == EventKind::FloorContact).expect("it meets the floor");
    [omega * contact.time, contact.approach]
}

fn angular_frequency(scene: &Scene) -> f64 {
    TAU / scene.excitation.period()
}

#[test]
fn orbits_with_a_closed_form_are_met_to_twelve_digits() {
    for (id, velocity) in [
        ("masri-caughey-two-impacts-a", 1.030_216_589_546_725_5),
        ("masri-caughey-two-impacts-b", 0.246_499_927_843_622_73),
    ] {
        let value = expected(id);
        let steady = masri_and_caughey(id, velocity);
        let orbit = beside(&steady, 1e-4, 1);
        assert_eq!((orbit.cycles, orbit.contacts, orbit.is_stable()), (1, 2, true));
        let [phase, speed] = floor_contact(&orbit, angular_frequency(&steady.scene));
        close(&format!("{id}, phase"), phase, value[0], 1e-12);
        close(&format!("{id}, speed"), speed, value[3], 1e-12);
        close(&format!("{id}, RMS velocity"), orbit.response.window().rms_velocity(), value[4], 1e-12);
        if id.ends_with('b') {
            let value = expected("floquet-masri-b");
            for (i, multiplier) in orbit.multipliers.iter().enumerate() {
                close(&format!("modulus {i}"), multiplier.modulus, value[i], 1e-9);
            }
        }
    }

    let value = expected("one-floor-impact-per-2-period-b");
    let steady = one_floor_impact();
    let orbit = beside(&steady, 1e-5, 2);
    assert_eq!((orbit.cycles, orbit.contacts), (2, 1));
    let [phase, speed] = floor_contact(&orbit, angular_frequency(&steady.scene));
    close("one landing in two cycles, phase", phase, value[0], 1e-12);
    close("one landing in two cycles, speed", speed, value[1], 1e-12);
    close("one landing in two cycles, RMS velocity", orbit.response.window().rms_velocity(), value[4], 1e-12);

    // A stop that nothing moves would do as well anywhere else: of its orbits the one beside the start is taken.
    for (id, place) in [("fixed-stop-one-impact-b", 0.01), ("fixed-stop-one-impact-d", 0.0)] {
        let (given, value) = open(id);
        let steady = fixed_stop(&given, &value, place);
        let orbit = beside(&steady, 0.0, 1);
        let [phase, speed] = floor_contact(&orbit, angular_frequency(&steady.scene));
        // As far as the case itself is stated: the stop is a mass of 10¹⁸ kg, and it has moved.
        close(&format!("{id}, phase"), phase, value[1], 1e-11);
        close(&format!("{id}, speed"), -speed, value[0], 1e-11);
    }
}

#[test]
fn a_ball_on_a_table_is_found_at_its_phase() {
    for (id, cycles, start) in [
        ("table-period1-phase-e0.5-G1.2", 1, [0.005_609_621_849_637_127_4, -0.430_238_648_865_100_86]),
        ("table-period2-phase-e0.5-G2.3", 2, [0.009_637_520_453_925_995, -0.957_642_126_053_008_6]),
        ("table-period1-phase-e0.9-G0.5", 1, [0.009_773_903_994_374_47, -0.311_931_045_752_505_9]),
    ] {
        let (given, value) = open(id);
        let omega = given.number("angular_frequency");
        let (table, amplitude) = table(&given, given.number("dimensionless_acceleration"));
        let start = in_flight([0.0, amplitude * omega], [start[0] + 1e-6, start[1] - amplitude * omega]);
        let orbit = Orbit::near(&system(&table), &start, cycles).expect("it is near");
        assert_eq!((orbit.cycles, orbit.contacts), (cycles, 1), "{id}");
        let [phase, speed] = floor_contact(&orbit, omega);
        close(&format!("{id}, phase"), phase, value[0], 1e-12);
        close(&format!("{id}, speed"), -speed, value[1], 1e-12);
        if id.contains("G1.2") {
            let value = expected("table-period1-multipliers");
            let ball: Vec<Multiplier> = orbit.multipliers.into_iter().filter(|it| it.modulus < 0.9).collect();
            let [trace, product] = trace_and_product(&ball);
            within("trace", trace, value[0], 1e-10);
            close("determinant", product, value[1], 1e-9);
        }
    }
}

#[test]
fn an_orbit_that_does_not_attract_is_found_with_its_multipliers() {
    let e: f64 = 0.5;
    for acceleration in [1.1, 1.8, 2.4] {
        let table = Table::new(e, acceleration);
        let orbit = Orbit::near(&system(&table.scene()), &table.on_orbit(1e-6), 1).expect("it is near");
        assert_eq!((orbit.cycles, orbit.contacts), (1, 1));
        // The velocity of the table at the impact gives back what the impact takes: A ω cos φ = (1 − ε)/(1 + ε) gT/2.
        let phase = (PI * (1.0 - e) / ((1.0 + e) * acceleration)).acos();
        let [met, _] = floor_contact(&orbit, table.omega);
        close("phase", met, (phase + table.lag).rem_euclid(TAU), 1e-12);
        // Trace 1 + ε² + (1 + ε)² X″/g and determinant ε² of its map; the table's own disturbance dies out by itself.
        let own = table.own_multiplier();
        let (ball, of_table): (Vec<Multiplier>, Vec<_>) =
            orbit.multipliers.iter().partition(|it| (it.modulus - own).abs() > 1e-9);
        assert_eq!(of_table.len(), 2);
        let [trace, product] = trace_and_product(&ball);
        close("trace", trace, 1.0 + e * e - (1.0 + e) * (1.0 + e) * acceleration * phase.sin(), 1e-9);
        close("determinant", product, e * e, 1e-9);
        assert_eq!(orbit.is_stable(), acceleration < doubling(e), "Γ = {acceleration}");
    }
}

/// Γ from which a ball has a motion of one flight a cycle.
fn first_flight(e: f64) -> f64 {
    PI * (1.0 - e) / (1.0 + e)
}

/// Γ at which its period doubles: the trace of its map is −(1 + ε²).
fn doubling(e: f64) -> f64 {
    first_flight(e).hypot(2.0 * (1.0 + e * e) / ((1.0 + e) * (1.0 + e)))
}

#[test]
fn an_orbit_is_found_from_the_end_of_a_run_and_in_its_shortest_period() {
    let table = Table::new(0.5, 1.03 * doubling(0.5));
    let scene = system(&table.scene());
    let run = Options { skip: 0, average: 80, start: table.on_orbit(1e-4), ..Options::default() };
    let double = Orbit::after(&scene, &run).expect("it settles");
    assert_eq!((double.cycles, double.contacts, double.kind.to_string().as_str()), (2, 2, "periodic 2:2"));
    let again = Orbit::near(&scene, &double.start, 6).expect("it is on it");
    assert_eq!(again.cycles, 2);
    // A run from it settles at once, with its averages.
    let settles = Options { until: Until::Settled, start: double.start.clone(), skip: 0, ..Options::default() };
    let settled = event_driven(&scene, &settles).expect("it runs");
    assert!(settled.settled.expect("it attracts").first <= 3);
    close("RMS", settled.window().rms_velocity(), double.response.window().rms_velocity(), 1e-12);
}

#[test]
fn an_orbit_is_the_same_wherever_in_its_period_a_cycle_begins() {
    let cannot_pull =
        Surface::Resilient { stiffness: 300.0, damping: ContactDamping::Constant(6.0), ends: ContactEnd::ZeroForce };
    let shaken = Excitation::Harmonic { force: 60.0, angular_frequency: 28.0 };
    let beaten = system(&scene(base(1.0, 1000.0, 10.0), 0.0, damper(0.05, 0.05, cannot_pull), shaken));
    let begins = (0..12).map(|place| {
        let mut begun = beaten.clone();
        begun.drive.harmonic.as_mut().expect("it is shaken").phase += TAU * f64::from(place) / 12.0 + 0.25;
        let run = Options { skip: 0, average: 400, ..Options::default() };
        let orbit = Orbit::after(&begun, &run).expect("it settles");
        let StartState::Given { particles, .. } = &orbit.start else { panic!("an orbit starts somewhere") };
        (particles[0].contact, [orbit.response.window().rms_velocity(), orbit.multipliers[0].modulus])
    });
    let begins: Vec<(Contact, [f64; 2])> = begins.collect();
    // With the particle in flight, at either face, and let go by either.
    let contacts: BTreeSet<Contact> = begins.iter().map(|(contact, _)| *contact).collect();
    assert!(contacts.len() == 5, "{contacts:?}");
    let (_, [same_rms, same_multiplier]) = begins[0];
    for (contact, [rms, multiplier]) in &begins {
        close(&format!("RMS from {contact:?}"), *rms, same_rms, 1e-11);
        close(&format!("multiplier from {contact:?}"), *multiplier, same_multiplier, 1e-8);
    }
}

#[test]
fn where_there_is_no_orbit_the_reason_is_given() {
    let chaotic = Table::new(0.9, 8.0);
    let run = Options { skip: 0, average: 300, start: chaotic.start(0.01), ..Options::default() };
    let error = Orbit::after(&system(&chaotic.scene()), &run).expect_err("it is chaotic");
    assert!(matches!(error, OrbitError::Chaotic { .. }), "{error}");

    let drop = scene(base(1.0, 1000.0, 1.0), GRAVITY, damper(0.1, f64::INFINITY, rigid(0.5)), nothing(0.1));
    let error = Orbit::after(&system(&drop), &Options::default()).expect_err("nothing drives it");
    assert_eq!(error, OrbitError::NoPeriod);

    // Below the first flight of a cycle there is none.
    let resting = Table::new(0.5, 0.9 * first_flight(0.5));
    let start = Table::new(0.5, first_flight(0.5)).on_orbit(0.0);
    let found = Orbit::near(&system(&resting.scene()), &start, 1);
    assert!(found.as_ref().map_or(true, |orbit| orbit.contacts != 1), "{found:?}");
}

fn follow(
    systems: impl Fn(f64) -> HybridSystem,
    orbit: &Orbit,
    [from, to]: [f64; 2],
    points: usize,
) -> Branch<Infallible> {
    let along = Along { from, to, step: 0.02, points };
    let branch = Branch::follow(|parameter| Ok(systems(parameter)), orbit, from, along).expect("it has a first orbit");
    println!(
        "{} points to {}, end {:?}",
        branch.points.len(),
        branch.points.last().expect("one").parameter,
        branch.end
    );
    for point in &branch.points {
        assert!(point.orbit.distance <= 1e-12);
        if let Some(special) = point.special {
            println!("{} at {}", special.word(), point.parameter);
        }
    }
    branch
}

/// Where the branch has its special points of a kind.
fn places(branch: &Branch<Infallible>, kind: Special) -> Vec<f64> {
    branch.points.iter().filter(|point| point.special == Some(kind)).map(|point| point.parameter).collect()
}

#[test]
fn a_branch_of_bounces_doubles_and_folds_where_the_closed_forms_say() {
    for e in [0.3, 0.5, 0.8] {
        let begin = 1.1 * first_flight(e);
        let systems = |acceleration: f64| system(&Table::new(e, acceleration).scene());
        let orbit = Orbit::near(&systems(begin), &Table::new(e, begin).on_orbit(0.0), 1).expect("it is near");
        let up = follow(systems, &orbit, [begin, 1.3 * doubling(e)], 500);
        let [place] = places(&up, Special::PeriodDoubling)[..] else { panic!("one doubling") };
        close(&format!("ε = {e}, doubling"), place, doubling(e), 1e-10);
        assert_eq!(up.end, BranchEnd::Range);
        for point in up.points.iter().filter(|point| point.special.is_none()) {
            assert_eq!(point.orbit.is_stable(), point.parameter < place);
        }
        // Downwards it turns at the first flight, and comes back with the impact in the table's downward half.
        let down = follow(systems, &orbit, [begin, 0.9 * first_flight(e)], 500);
        let [place] = places(&down, Special::Fold)[..] else { panic!("one fold") };
        close(&format!("ε = {e}, fold"), place, first_flight(e), 1e-10);
        assert_eq!(down.end, BranchEnd::Range);
        let last = down.points.last().expect("it has points");
        assert!((last.parameter - begin).abs() < 1e-12 && !last.orbit.is_stable());
    }
}

/// An oscillator that meets a fixed stop at `place` once a cycle: the harmonic response and the answer to a train of impulses of
/// −(1 + ε) v, with x = stop and x′ = v at the impact (Peterka 1974; Shaw & Holmes 1983):
/// A² = (d + (1 + ε) α v)² + (v (1 + (1 + ε) β)/ω)², (α, β) the state before the impact of a train of unit jumps.
pub(super) struct Stopped {
    ratio: f64,
    place: f64,
    restitution: f64,
}

pub(super) const STIFFNESS: f64 = 1000.0;
const DAMPING_RATIO: f64 = 0.02;

impl Stopped {
    fn omega(&self) -> f64 {
        self.ratio * STIFFNESS.sqrt()
    }

    pub(super) fn damping() -> f64 {
        2.0 * DAMPING_RATIO * STIFFNESS.sqrt()
    }

    /// Force of a unit amplitude.
    fn stiffness(&self) -> f64 {
        (STIFFNESS - self.omega().powi(2)).hypot(Self::damping() * self.omega())
    }

    /// The force at which the harmonic response reaches the stop.
    fn graze(&self) -> f64 {
        self.place * self.stiffness()
    }

    /// α and β.
    fn train(&self) -> Vector2<f64> {
        let flow = oscillator(TAU / self.omega());
        (Matrix2::identity() - flow).try_inverse().expect("it is damped") * flow * Vector2::new(0.0, 1.0)
    }

    /// The coefficients of v and v² in A² − d².
    fn square(&self) -> [f64; 2] {
        let [alpha, beta] = self.train().into();
        let e = 1.0 + self.restitution;
        [2.0 * self.place * e * alpha, (e * alpha).powi(2) + ((1.0 + e * beta) / self.omega()).powi(2)]
    }

    /// The smallest force of an orbit with one impact, if that is below the graze.
    fn fold(&self) -> Option<f64> {
        let [linear, square] = self.square();
        let least = self.place * self.place - linear * linear / (4.0 * square);
        (linear < 0.0).then(|| least.sqrt() * self.stiffness())
    }

    /// The force under which it meets the stop with a speed.
    fn force(&self, speed: f64) -> f64 {
        let [linear, square] = self.square();
        (self.place * self.place + speed * (linear + square * speed)).sqrt() * self.stiffness()
    }

    fn system(&self, force: f64) -> HybridSystem {
        let stop = damper(1e18, f64::INFINITY, rigid(self.restitution));
        let drive = Excitation::Harmonic { force, angular_frequency: self.omega() };
        system(&scene(base(1.0, STIFFNESS, Self::damping()), 0.0, stop, drive))
    }

    /// The state at phase 0 of the orbit that meets the stop with a speed.
    fn start(&self, speed: f64) -> StartState {
        let e = 1.0 + self.restitution;
        let omega = self.omega();
        let amplitude = self.force(speed) / self.stiffness();
        let lag = (Self::damping() * omega).atan2(STIFFNESS - omega * omega);
        let train = self.train();
        // At the impact, at the phase θ of the harmonic part A sin θ.
        let theta =
            ((self.place + e * speed * train[0]) / amplitude).atan2(speed * (1.0 + e * train[1]) / (amplitude * omega));
        // Backwards to phase 0 by the damped oscillator from the state after the impact before.
        let time = (theta + lag).rem_euclid(TAU) / omega;
        let period = TAU / omega;
        let since = period - time;
        let free = oscillator(since) * (-e * speed * (train + Vector2::new(0.0, 1.0)));
        let x = free[0] + amplitude * (-lag).sin();
        let v = free[1] + amplitude * omega * (-lag).cos();
        in_flight([x, v], [self.place - x, -v])
    }
}

#[test]
fn a_linear_oscillator_below_a_stop_grazes_where_its_amplitude_is_the_distance() {
    for ratio in [0.6, 0.9, 1.7] {
        let stopped = Stopped { ratio, place: 0.01, restitution: 0.6 };
        let begin = 0.5 * stopped.graze();
        let (omega, amplitude) = (stopped.omega(), begin / stopped.stiffness());
        let lag = (Stopped::damping() * omega).atan2(STIFFNESS - omega * omega);
        let (x, v) = (-amplitude * lag.sin(), amplitude * omega * lag.cos());
        let start = in_flight([x, v], [stopped.place - x, -v]);
        let orbit = Orbit::near(&stopped.system(begin), &start, 1).expect("it is linear");
        assert_eq!(orbit.contacts, 0);
        let branch = follow(|force| stopped.system(force), &orbit, [begin, 2.0 * begin * 1.2], 500);
        let BranchEnd::Graze { parameter } = branch.end else {
            let grazes = places(&branch, Special::Graze);
            close(&format!("ω′ = {ratio}, graze on the way"), grazes[0], stopped.graze(), 1e-10);
            continue;
        };
        close(&format!("ω′ = {ratio}, graze"), parameter, stopped.graze(), 1e-10);
    }
}

#[test]
fn an_orbit_with_one_impact_ends_in_its_graze_and_folds_before_where_the_closed_form_does() {
    let (mut folded, mut grazed) = (0, 0);
    for ratio in [0.6, 0.9, 1.7, 2.2] {
        let stopped = Stopped { ratio, place: 0.01, restitution: 0.6 };
        let speed = 0.3;
        let begin = stopped.force(speed);
        let Ok(orbit) = Orbit::near(&stopped.system(begin), &stopped.start(speed), 1) else { continue };
        if orbit.contacts != 1 {
            continue;
        }
        close("speed", -floor_contact(&orbit, stopped.omega())[1], speed, 1e-11);
        let branch = follow(|force| stopped.system(force), &orbit, [begin, 0.2 * stopped.graze()], 500);
        if let Some(fold) = stopped.fold() {
            close(&format!("ω′ = {ratio}, fold"), places(&branch, Special::Fold)[0], fold, 1e-10);
            folded += 1;
        }
        if let BranchEnd::Graze { parameter } = branch.end {
            close(&format!("ω′ = {ratio}, graze"), parameter, stopped.graze(), 1e-10);
            grazed += 1;
        }
    }
    assert!(folded > 1 && grazed > 1, "{folded} {grazed}");
}

/// The impact damper of Masri and Caughey (1966) with two impacts a cycle, half a cycle apart, by the particle's speed V: the base is a
/// forced oscillator that answers impulses of ∓2 mp V, and meets the floor at x = (h − V T/2)/2 with v = V (1 + 2μ − ε)/(1 + ε).
pub(super) struct Masri {
    pub(super) ratio: f64,
    pub(super) gap: f64,
    pub(super) restitution: f64,
    pub(super) particle: f64,
}

impl Masri {
    pub(super) fn omega(&self) -> f64 {
        self.ratio * STIFFNESS.sqrt()
    }

    pub(super) fn system(&self, force: f64) -> HybridSystem {
        let drive = Excitation::Harmonic { force, angular_frequency: self.omega() };
        let between = damper(self.particle, self.gap, rigid(self.restitution));
        system(&scene(base(1.0, STIFFNESS, Stopped::damping()), 0.0, between, drive))
    }

    /// Place and velocity of the base before the impact, and the part of them that answers the impulses.
    pub(super) fn impact(&self, speed: f64) -> [Vector2<f64>; 2] {
        let half = PI / self.omega();
        let before = Vector2::new(
            0.5 * (self.gap - speed * half),
            speed * (1.0 + 2.0 * self.particle - self.restitution) / (1.0 + self.restitution),
        );
        let flow = oscillator(half);
        let jump = Vector2::new(0.0, -2.0 * self.particle * speed);
        let train = -(Matrix2::identity() + flow).try_inverse().expect("it is damped") * flow * jump;
        [before, train]
    }

    /// The speed of the particle at which the motion loses its symmetry, whatever the restitution. Beside it is a motion whose impacts
    /// are late by τ on the floor and early by τ on the ceiling. Both flights are of one length, so that the particle has the velocity
    /// w = 4 V τ/T more in both. It still gives 2 mp V to the base, whose answer to the shifts is that to a train of doublets 2 μ V τ δ′
    /// with half the period. Impacts keep their restitution if the base has w more there, too: x″ τ + 2 μ V τ g″ = 4 V τ/T, g the answer
    /// to a train of unit impulses in every half period. All of x″ but −ω² h/2 is proportional to V.
    pub(super) fn symmetry_breaking(&self) -> f64 {
        let (omega, damping) = (self.omega(), Stopped::damping());
        let flow = oscillator(PI / omega);
        let unit = Vector2::new(0.0, 1.0);
        let train = (Matrix2::identity() + flow).try_inverse().expect("it is damped") * flow * unit;
        let answer = (Matrix2::identity() - flow).try_inverse().expect("it is damped") * flow * unit;
        let bend = |state: Vector2<f64>| -STIFFNESS * state[0] - damping * state[1];
        let doublets = 2.0 * self.particle * bend(answer);
        let answers = 2.0 * self.particle * (omega * omega * train[0] + bend(train));
        0.5 * omega * omega * self.gap / (0.5 * PI * omega + answers + doublets - 2.0 * omega / PI)
    }

    /// The force under which the particle has this speed.
    pub(super) fn force(&self, speed: f64) -> f64 {
        let [before, train] = self.impact(speed);
        let forced = before - train;
        let stiffness = (STIFFNESS - self.omega().powi(2)).hypot(Stopped::damping() * self.omega());
        forced[0].hypot(forced[1] / self.omega()) * stiffness
    }

    /// Multipliers: the squares of those of half a cycle, after which the motion comes again upside down.
    pub(super) fn multipliers(&self, speed: f64) -> Vec<[f64; 2]> {
        let (mu, e, omega) = (self.particle, self.restitution, self.omega());
        let [before, train] = self.impact(speed);
        let damping = Stopped::damping();
        let after = before[1] - 2.0 * mu * speed;
        let bend = -omega * omega * (before[0] - train[0]) - STIFFNESS * train[0] - damping * train[1];
        // (x, y, v, w) and its rates before and after the impact on the floor.
        let rates = [
            Vector4::new(before[1], -speed, bend, 0.0),
            Vector4::new(after, speed, bend - damping * (after - before[1]), 0.0),
        ];
        let share = (1.0 + e) / (1.0 + mu);
        let mut jump = Matrix4::identity();
        jump[(2, 2)] = 1.0 - share * mu;
        jump[(2, 3)] = share * mu;
        jump[(3, 2)] = share;
        jump[(3, 3)] = 1.0 - share;
        let late = nalgebra::RowVector4::new(1.0, -1.0, 0.0, 0.0) / (-speed - before[1]);
        let saltation = jump + (jump * rates[0] - rates[1]) * late;
        let half = PI / omega;
        let own = oscillator(half);
        let mut flow = Matrix4::identity();
        for (i, k) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            flow[(2 * i, 2 * k)] = own[(i, k)];
        }
        flow[(1, 3)] = half;
        let eigenvalues = (flow * saltation).complex_eigenvalues();
        let mut moduli: Vec<[f64; 2]> = eigenvalues.iter().map(|z| [z.re * z.re + z.im * z.im, z.im.abs()]).collect();
        moduli.sort_by(|a, b| b[0].total_cmp(&a[0]));
        moduli
    }
}

/// The damped oscillator's flow.
pub(super) fn oscillator(time: f64) -> Matrix2<f64> {
    let natural = STIFFNESS.sqrt();
    let (decay, omega) = (DAMPING_RATIO * natural, natural * (1.0 - DAMPING_RATIO * DAMPING_RATIO).sqrt());
    let (s, c) = (omega * time).sin_cos();
    (-decay * time).exp()
        * Matrix2::new(c + decay / omega * s, s / omega, -natural * natural / omega * s, c - decay / omega * s)
}

#[test]
fn a_branch_of_two_impacts_has_the_forces_and_multipliers_of_the_closed_form_stable_or_not() {
    let steady = masri_and_caughey("masri-caughey-two-impacts-b", 0.246_499_927_843_622_73);
    let orbit = beside(&steady, 0.0, 1);
    let masri = Masri { ratio: 1.1, gap: 0.1, restitution: 0.6, particle: 0.1 };
    let (mut unstable, mut tori) = (0, 0);
    for to in [60.0, 2.0] {
        let branch = follow(|force| masri.system(force), &orbit, [10.0, to], 600);
        for point in &branch.points {
            let [_, approach] = floor_contact(&point.orbit, masri.omega());
            let speed = -approach * (1.0 + masri.restitution) / (2.0 * (1.0 + masri.particle));
            let moduli = masri.multipliers(speed);
            if let Some(Special::Torus) = point.special {
                // The force at which the pair of the closed form passes the unit circle.
                let outside = |speed: f64| masri.multipliers(speed)[0][0] - 1.0;
                let (mut low, mut high) = (0.999 * speed, 1.001 * speed);
                assert!(outside(low) * outside(high) < 0.0 && moduli[0][1] > 0.0);
                while high - low > 1e-15 * speed && (low + high) / 2.0 > low && (low + high) / 2.0 < high {
                    let middle = 0.5 * (low + high);
                    if outside(low) * outside(middle) <= 0.0 { high = middle } else { low = middle }
                }
                close("torus", point.parameter, masri.force(low), 1e-10);
                tori += 1;
            }
            if point.orbit.contacts != 2 || point.special == Some(Special::Graze) {
                continue;
            }
            close("force", masri.force(speed), point.parameter, 1e-10);
            for (multiplier, [modulus, _]) in point.orbit.multipliers.iter().zip(&moduli) {
                within("modulus", multiplier.modulus, *modulus, 1e-9 * moduli[0][0].max(1.0));
            }
            unstable += u32::from(!point.orbit.is_stable());
        }
    }
    println!("{unstable} unstable points, {tori} tori");
    assert!(unstable > 0);
}

/// One mass with a particle between springs with dashpots, under impulses.
fn under_impulses(impulse: f64) -> HybridSystem {
    let natural = 1000.0_f64.sqrt();
    let train = Excitation::ImpulseTrain { impulse, period: TAU / natural };
    let between = damper(0.05, 0.4905, resilient(1000.0, 0.6 * 50.0_f64.sqrt()));
    system(&scene(base(1.0, 1000.0, 0.1 * natural), GRAVITY, between, train))
}

#[test]
fn a_branch_of_resilient_contacts_changes_its_stability_at_its_special_points_and_nowhere_else() {
    let begin = 2.2;
    let orbit = Orbit::after(&under_impulses(begin), &Options::default()).expect("it settles");
    let mut found = Vec::new();
    for to in [0.8 * begin, 1.6 * begin] {
        let branch = follow(under_impulses, &orbit, [begin, to], 400);
        let mut stable = true;
        for point in &branch.points {
            let multipliers = &point.orbit.multipliers;
            within("product of the multipliers", point.orbit.residual, 0.0, 1e-12);
            match point.special {
                Some(Special::PeriodDoubling) => {
                    let flips = multipliers.iter().filter(|it| it.angle == PI);
                    let off = flips.map(|it| (it.modulus - 1.0).abs()).fold(f64::INFINITY, f64::min);
                    within("multiplier", off, 0.0, 1e-9);
                    stable = !stable;
                }
                Some(Special::Torus) => {
                    within("modulus", multipliers[0].modulus, 1.0, 1e-9);
                    stable = false;
                }
                Some(
                    Special::Fold
                    | Special::Graze
                    | Special::Sticking
                    | Special::SymmetryBreaking
                    | Special::BranchPoint,
                ) => break,
                None => assert_eq!(point.orbit.is_stable(), stable, "at {}", point.parameter),
            }
            found.extend(point.special.map(Special::word));
        }
    }
    println!("{found:?}");
    assert!(found.contains(&"period doubling") && found.contains(&"torus"));
}

#[test]
fn the_motion_of_twice_the_period_is_followed_from_its_doubling() {
    let e = 0.5;
    let begin = 0.97 * doubling(e);
    let end = 1.03 * doubling(e);
    let systems = |acceleration: f64| Ok::<_, Infallible>(system(&Table::new(e, acceleration).scene()));
    let orbit = Orbit::near(&systems(begin).expect("it compiles"), &Table::new(e, begin).on_orbit(0.0), 1);
    let along = Along { from: begin, to: end, step: 0.02, points: 500 };
    let single = Branch::follow(systems, &orbit.expect("it is near"), begin, along).expect("it has a first orbit");
    let at = single.points.iter().find(|point| point.special == Some(Special::PeriodDoubling)).expect("it doubles");
    let double = Branch::doubled(systems, at, along).expect("it begins there");
    assert_eq!(double.end, BranchEnd::Range);
    // What a run settles to there.
    let last = double.points.last().expect("it has points");
    let table = Table::new(e, end);
    let run = Options { skip: 0, average: 80, start: table.on_orbit(1e-4), ..Options::default() };
    let settled = Orbit::after(&system(&table.scene()), &run).expect("it settles");
    assert_eq!((last.parameter, last.orbit.cycles, last.orbit.contacts), (end, 2, 2));
    close("largest multiplier", last.orbit.multipliers[0].modulus, settled.multipliers[0].modulus, 1e-9);
    let speeds = |orbit: &Orbit| {
        let mut speeds: Vec<f64> = orbit.response.events.iter().map(|event| -event.approach).collect();
        speeds.sort_by(f64::total_cmp);
        speeds
    };
    for (speed, same) in speeds(&last.orbit).into_iter().zip(speeds(&settled)) {
        close("impact speed", speed, same, 1e-10);
    }
}

#[test]
fn a_branch_says_what_is_in_its_way_and_keeps_what_it_has() {
    #[derive(Debug, PartialEq)]
    struct TooStrong;
    let begin = 1.1 * first_flight(0.5);
    let systems = |acceleration: f64| {
        let far = acceleration > 1.3;
        if far { Err(TooStrong) } else { Ok(system(&Table::new(0.5, acceleration).scene())) }
    };
    let first = systems(begin).expect("it is near");
    let orbit = Orbit::near(&first, &Table::new(0.5, begin).on_orbit(0.0), 1).expect("it is near");
    let along = Along { from: begin, to: 2.0, step: 0.02, points: 500 };
    let branch = Branch::follow(systems, &orbit, begin, along).expect("it has a first orbit");
    assert_eq!(branch.end, BranchEnd::System(TooStrong));
    let last = branch.points.last().expect("it has points");
    assert!(last.parameter <= 1.3 && last.parameter > 1.3 - 1e-5, "{}", last.parameter);
    let few = Branch::follow(systems, &orbit, begin, Along { points: 4, ..along }).expect("it has a first orbit");
    assert_eq!((few.points.len(), few.end), (4, BranchEnd::Points));
}

#[test]
fn where_a_contact_comes_to_the_impulse_no_multiplier_passes_minus_one() {
    // The map jumps there, and with it the determinants that are zero at special points.
    let orbit = Orbit::after(&under_impulses(2.2), &Options::default()).expect("it settles");
    let branch = follow(under_impulses, &orbit, [2.2, 8.0], 200);
    assert_eq!(branch.end, BranchEnd::CycleStart);
    for point in &branch.points {
        let at = |real: f64| {
            let off = point.orbit.multipliers.iter().map(|it| {
                let (sin, cos) = it.angle.sin_cos();
                (it.modulus * cos - real).hypot(it.modulus * sin)
            });
            off.fold(f64::INFINITY, f64::min)
        };
        match point.special {
            Some(Special::PeriodDoubling) => within("multiplier", at(-1.0), 0.0, 1e-6),
            Some(Special::Fold) => within("multiplier", at(1.0), 0.0, 1e-6),
            _ => {}
        }
    }
}

#[test]
fn a_motion_amid_chaos_that_multiplies_rounding_beyond_its_own_closure_is_called_too_sensitive() {
    let system = under_impulses(0.679);
    let run = Options { skip: 300, average: 100, ..Options::default() };
    let orbit = Orbit::beside(&system, &run, 32).expect("it closes");
    assert_eq!(orbit.cycles, 32);
    let grown = f64::EPSILON * orbit.multipliers[0].modulus;
    assert!(grown > 1e-12 && orbit.distance <= 1e-12, "{grown:e} {:e}", orbit.distance);
    let branch = follow(under_impulses, &orbit, [0.679, 0.8], 50);
    assert_eq!((branch.end, branch.points[0].parameter), (BranchEnd::Sensitive, 0.679));
    // One cycle of the same drive is nothing of the kind.
    let single = Orbit::after(&under_impulses(2.2), &run).expect("it settles");
    assert!(single.is_stable());
}

#[test]
fn a_branch_of_completed_chatter_does_not_end_because_its_motion_fails_to_come_again() {
    let natural = 1000.0_f64.sqrt();
    let systems = |force: f64| {
        let drive = Excitation::Harmonic { force, angular_frequency: 0.7 * natural };
        let mass = base(1.0, 1000.0, 0.04 * natural);
        system(&scene(mass, 0.0, damper(0.05, 0.02, rigid(0.5)), drive))
    };
    let run = Options { skip: 400, average: 100, ..Options::default() };
    let orbit = Orbit::after(&systems(29.1), &run).expect("it settles");
    assert_eq!(orbit.kind.to_string(), "completed chatter 1:∞");
    let branch = follow(systems, &orbit, [29.1, 28.0], 60);
    // Its impacts grow in number without bound as the last of them cease to be held.
    assert_eq!(branch.end, BranchEnd::Orbit(OrbitError::NoNeighbour { cycles: 1 }));
    assert!(branch.points.iter().all(|point| point.orbit.is_stable() && point.special.is_none()));
}
