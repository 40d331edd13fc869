//! Closed forms and published results, by their own tolerances: chatter, grazing, balls on tables, impact dampers in
//! steady motion, restitution of springs and dashpots, limit stops, free bases, linear limits.
//!
//! What a case states as a velocity "after" or a phase is read from the events, never from samples.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};
use std::ops::Index;

use nalgebra::{Matrix2, Matrix4, Vector4};
use shotdamp::dynamics::{Contact, Event, EventKind, Options, Placed, Response, StartState};
use shotdamp::scene::{Damper, Excitation, LimitStop, PulseShape, Scene, Walls};

use crate::structures;

use super::bench::{
    Case, GRAVITY, base, cases, close, damper, in_flight, instant, nothing, once, only, resilient,
    resilient_without_tension, rigid, run, scene, within,
};
use super::elasticities;

fn all() -> Vec<Case> {
    cases(include_str!("../data/closed-form-cases.json"))
}

fn case(id: &str) -> Case {
    all().into_iter().find(|case| case.text("id") == id).unwrap_or_else(|| panic!("no case `{id}`"))
}

thread_local! {
    /// Values that tests have asked for: case and place in it.
    static MET: RefCell<BTreeSet<(String, usize)>> = RefCell::default();
}

/// The values that a case is to be met by; who reads one is held to compare with it.
pub(crate) struct Expected {
    id: String,
    values: Vec<f64>,
}

impl Index<usize> for Expected {
    type Output = f64;

    fn index(&self, i: usize) -> &f64 {
        MET.with_borrow_mut(|met| met.insert((self.id.clone(), i)));
        &self.values[i]
    }
}

/// The values of a case.
pub(crate) fn expected(id: &str) -> Expected {
    Expected { id: id.into(), values: case(id).numbers("value") }
}

/// The scene's numbers and the values to be met.
pub(super) fn open(id: &str) -> (Case, Expected) {
    (case(id).part("scene"), expected(id))
}

/// A free base without dashpot, and no force for `span` seconds.
fn floating(given: &Case, gravity: f64, damper: Damper, span: f64) -> Scene {
    let stiffness = given.optional("stiffness").unwrap_or(0.0);
    scene(base(given.number("base_mass"), stiffness, 0.0), gravity, damper, nothing(span))
}

#[test]
pub(super) fn chatter_ends_where_the_geometric_series_does() {
    let (given, value) = open("chatter-free-base-e0.5");
    let [end, velocity, place] = [value[0], value[1], value[2]];
    let ball = |restitution| damper(given.number("particle_mass"), f64::INFINITY, rigid(restitution));
    let start = in_flight([0.0, 0.0], [0.0, 1.0]);
    let fall = floating(&given, GRAVITY, ball(given.number("restitution")), 1.0);
    let response = run(&fall, &once(start.clone()));
    let ends = only(&response, EventKind::ChatterEnd);
    assert_eq!(ends.len(), 1);
    assert_eq!(response.events.last().map(|event| event.kind), Some(EventKind::ChatterEnd));
    close("last impact", ends[0].time, end, 1e-12);
    let until_then = run(&floating(&given, GRAVITY, ball(given.number("restitution")), end), &once(start.clone()));
    close("common velocity", until_then.final_velocity, velocity, 1e-12);
    close("place", until_then.final_displacement, place, 1e-12);

    // The same for a ball that takes twenty thousand bounces to rest: t* = 2 u′/(g (1 − ε)).
    let lively = floating(&given, GRAVITY, ball(0.999), 250.0);
    let response = run(&lively, &once(start));
    let ends = only(&response, EventKind::ChatterEnd);
    close("last impact, ε = 0.999", ends[0].time, 2.0 / (GRAVITY * (1.0 - 0.999)), 1e-12);
}

#[test]
pub(super) fn a_particle_that_grazes_the_ceiling_is_met_on_both_sides() {
    let (given, value) = open("graze-ceiling-plus-1e-12");
    let particle = damper(given.number("particle_mass"), given.number("gap"), rigid(given.number("restitution")));
    let toss = floating(&given, GRAVITY, particle, 0.45);
    let launch = |over: f64| in_flight([0.0, 0.0], [0.0, (2.0 * GRAVITY * given.number("gap") + over).sqrt()]);

    let touching = run(&toss, &once(launch(1e-12)));
    let kinds: Vec<_> = touching.events.iter().map(|event| event.kind).collect();
    assert_eq!(kinds[..2], [EventKind::CeilingContact, EventKind::FloorContact]);
    close("relative velocity at the ceiling", touching.events[0].approach, value[0], 2e-3);
    close("time", touching.events[0].time, value[1], 1e-9);
    close("relative velocity at the floor", touching.events[1].approach, value[2], 1e-9);
    assert!(touching.proof.smallest_margin < 1e-12, "the margin must tell how close it was");

    let (_, value) = open("graze-ceiling-minus-1e-12");
    let missing = run(&toss, &once(launch(-1e-12)));
    assert_eq!(only(&missing, EventKind::CeilingContact).len(), value[0] as usize);
    close("first floor impact", missing.events[0].time, value[1], 1e-12);
    assert!(missing.proof.smallest_margin < 1e-12, "the margin must tell how close it was");
}

#[test]
pub(super) fn an_accelerated_base_is_a_stronger_gravity() {
    let (given, value) = open("chatter-accelerated-base");
    let particle = damper(given.number("particle_mass"), given.number("gap"), rigid(given.number("restitution")));
    let push = Excitation::PulseTrain { impulse: 30.0, period: 1.0, duration: 1.0, shape: PulseShape::Rectangular };
    let lift = scene(base(given.number("base_mass"), 0.0, 0.0), GRAVITY, particle, push);
    let response = run(&lift, &once(in_flight([0.0, 0.0], [0.0, 0.4])));
    close("last impact", only(&response, EventKind::ChatterEnd)[0].time, value[0], 1e-12);
    // From then on both move as one.
    close("velocity at 1 s", response.final_velocity, (30.0 - 0.05 * GRAVITY + 0.05 * 0.4) / 1.05, 1e-12);
}

/// The table x = A sin ωt, A = Γg/ω²: an undamped base on its forced orbit, with a particle without mass.
pub(super) fn table(given: &Case, acceleration: f64) -> (Scene, f64) {
    let omega = given.number("angular_frequency");
    let amplitude = acceleration * GRAVITY / (omega * omega);
    let (mass, stiffness) = (given.number("base_mass"), given.number("stiffness"));
    let force = (stiffness - mass * omega * omega) * amplitude;
    let ball = damper(0.0, f64::INFINITY, rigid(given.number("restitution")));
    let drive = Excitation::Harmonic { force, angular_frequency: omega };
    (scene(base(mass, stiffness, 0.0), GRAVITY, ball, drive), amplitude)
}

/// A run on the table until `impacts` have happened, every one of them kept.
fn bounce(table: &Scene, start: [f64; 2], amplitude: f64, omega: f64, cycles: u32) -> Vec<Event> {
    let start = in_flight([0.0, amplitude * omega], [start[0], start[1] - amplitude * omega]);
    let options = Options { skip: 0, average: cycles, start, record_events: usize::MAX, ..Options::default() };
    only(&run(table, &options), EventKind::FloorContact)
}

#[test]
pub(super) fn a_ball_on_a_vibrating_table_keeps_its_phase() {
    let ids = [
        ("table-period1-phase-e0.5-G1.2", 1, [0.005_609_621_849_637_127_4, -0.430_238_648_865_100_86]),
        ("table-period2-phase-e0.5-G2.3", 2, [0.009_637_520_453_925_995, -0.957_642_126_053_008_6]),
        ("table-period1-phase-e0.9-G0.5", 1, [0.009_773_903_994_374_47, -0.311_931_045_752_505_9]),
    ];
    for (id, cycles_a_flight, start) in ids {
        let (given, value) = open(id);
        let omega = given.number("angular_frequency");
        let (table, amplitude) = table(&given, given.number("dimensionless_acceleration"));
        let impacts = bounce(&table, start, amplitude, omega, 400 * cycles_a_flight + 1);
        assert!(impacts.len() >= 400, "{id}: {} impacts", impacts.len());
        let [before, last] = [impacts[398], impacts[399]];
        close(&format!("{id}, phase"), omega * last.time, value[0], 1e-10);
        close(&format!("{id}, speed"), -last.approach, value[1], 1e-10);
        close(&format!("{id}, flight"), instant(&table, &last) - instant(&table, &before), value[2], 1e-10);
    }
}

#[test]
pub(super) fn the_impact_map_of_a_ball_on_a_table_has_its_multipliers() {
    let (given, value) = open("table-period1-multipliers");
    let omega = given.number("angular_frequency");
    let (table, amplitude) = table(&given, given.number("dimensionless_acceleration"));
    // Phase and speed of two impacts, from starts to both sides of the orbit.
    let impacts = |off: [f64; 2]| {
        let start = [0.005_609_621_849_637_127_4 + off[0], -0.430_238_648_865_100_86 + off[1]];
        let events = bounce(&table, start, amplitude, omega, 4);
        [1, 2].map(|i| [omega * instant(&table, &events[i]), events[i].approach])
    };
    let moved = |off: [f64; 2]| {
        let [above, below] = [impacts(off), impacts(off.map(|x| -x))];
        [0, 1].map(|i| [above[i][0] - below[i][0], above[i][1] - below[i][1]])
    };
    let [one, other] = [moved([1e-6, 0.0]), moved([0.0, 1e-4])];
    let matrix = |i: usize| Matrix2::from_columns(&[one[i].into(), other[i].into()]);
    let map = matrix(1) * matrix(0).try_inverse().expect("two directions");
    within("trace", map.trace(), value[0], 1e-8);
    within("determinant", map.determinant(), value[1], 1e-8);
}

#[test]
pub(super) fn the_orbit_of_masri_and_caughey_has_its_floquet_multipliers() {
    let value = expected("floquet-masri-b");
    let steady = masri_and_caughey("masri-caughey-two-impacts-b", 0.246_499_927_843_622_73);
    let [y, w] = steady.response.final_particles[0];
    let orbit = [steady.response.final_displacement, steady.response.final_velocity, y, w];
    let after = |[x, v, y, w]: [f64; 4]| {
        let start = in_flight([x, v], [y - x, w - v]);
        let end = run(&steady.scene, &Options { skip: 0, average: 1, start, ..Options::default() });
        let [y, w] = end.final_particles[0];
        Vector4::new(end.final_displacement, end.final_velocity, y, w)
    };
    let column = |i: usize| {
        let [above, below] = [1e-6, -1e-6].map(|step| {
            let mut start = orbit;
            start[i] += step;
            after(start)
        });
        (above - below) / 2e-6
    };
    let map = Matrix4::from_columns(&[0, 1, 2, 3].map(column));
    let mut moduli: Vec<f64> = map.complex_eigenvalues().iter().map(|z| z.re.hypot(z.im)).collect();
    moduli.sort_by(|a, b| b.total_cmp(a));
    for (i, modulus) in moduli.iter().enumerate() {
        close(&format!("modulus {i}"), *modulus, value[i], 1e-5);
    }
    close("product", map.determinant(), value[4], 1e-5);
}

#[test]
pub(super) fn just_below_period_doubling_every_flight_is_alike() {
    let (given, value) = open("table-below-doubling");
    let e = given.number("restitution");
    // Doubling where the trace of the impact map is −(1 + ε²).
    let phase_term = PI * (1.0 - e) / (1.0 + e);
    let slope_term = 2.0 * (1.0 + e * e) / ((1.0 + e) * (1.0 + e));
    let acceleration = 0.99 * phase_term.hypot(slope_term);
    let omega = given.number("angular_frequency");
    let (table, amplitude) = table(&given, acceleration);
    // The orbit's phase; the ball is put a millimetre off it.
    let phase = (phase_term / acceleration).acos();
    let until_impact = phase / omega;
    let rate = -GRAVITY * PI / omega + GRAVITY * until_impact;
    let height = amplitude * phase.sin() + (GRAVITY * PI / omega - 0.5 * GRAVITY * until_impact) * until_impact;
    let impacts = bounce(&table, [height + 1e-3, rate], amplitude, omega, 3001);
    let times: Vec<f64> = impacts.iter().map(|event| instant(&table, event)).collect();
    let [a, b, c] = [times[times.len() - 3], times[times.len() - 2], times[times.len() - 1]];
    within("difference of the last two flights", (c - b) - (b - a), value[0], 1e-10);
}

#[test]
pub(super) fn an_inelastic_ball_leaves_and_lands_at_the_phases_of_theory() {
    let (given, value) = open("inelastic-ball-first-flight-G3");
    let omega = given.number("angular_frequency");
    let (table, amplitude) = table(&given, given.number("dimensionless_acceleration"));
    let start = StartState::Given { q: vec![0.0], rate: vec![amplitude * omega], particles: vec![Placed::ON_FLOOR] };
    let options = Options { skip: 0, average: 2, start, record_events: 2, ..Options::default() };
    let response = run(&table, &options);
    assert_eq!(response.events[0].kind, EventKind::FloorRelease);
    assert_eq!(response.events[1].kind, EventKind::FloorContact);
    for (what, event, want) in [("leaves", response.events[0], value[0]), ("lands", response.events[1], value[1])] {
        within(what, omega * event.time + TAU * event.cycle as f64, want, 1e-13);
    }
}

/// The forced base followed backwards from the instant of an impact to the start of the cycle, by Runge-Kutta steps: a
/// start near the orbit, which then attracts.
fn backwards(mass: f64, stiffness: f64, damping: f64, force: f64, omega: f64, phase: f64, at: [f64; 2]) -> [f64; 2] {
    let steps = 20_000;
    let h = -phase / omega / f64::from(steps);
    let rate = |t: f64, z: [f64; 2]| [z[1], (force * (omega * t).sin() - stiffness * z[0] - damping * z[1]) / mass];
    let step = |z: [f64; 2], k: [f64; 2], h: f64| [z[0] + h * k[0], z[1] + h * k[1]];
    (0..steps).fold(at, |z, i| {
        let t = phase / omega + f64::from(i) * h;
        let k1 = rate(t, z);
        let k2 = rate(t + 0.5 * h, step(z, k1, 0.5 * h));
        let k3 = rate(t + 0.5 * h, step(z, k2, 0.5 * h));
        let k4 = rate(t + h, step(z, k3, h));
        [0, 1].map(|i| z[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    })
}

/// A steady motion that is known at its floor impact.
pub(super) struct Steady {
    pub(super) scene: Scene,
    pub(super) response: Response,
    /// Floor impacts.
    impacts: Vec<Event>,
    omega: f64,
}

/// Runs a harmonic scene from just before a floor impact at `phase` with the base at `x`, `v` and the particle at rate `y`.
fn settle(given: &Case, force: [f64; 2], damper: Damper, phase: f64, impact: [f64; 3], skip: u32) -> Steady {
    let [force, gravity] = force;
    let (mass, stiffness) = (given.number("base_mass"), given.number("stiffness"));
    let damping = 2.0 * given.number("damping_ratio") * (stiffness * mass).sqrt();
    let ratio: f64 = given.text("frequency_ratio").split(' ').next().and_then(|r| r.parse().ok()).expect("a ratio");
    let omega = ratio * (stiffness / mass).sqrt();
    let [x, v, y_rate] = impact;
    let [x0, v0] = backwards(mass, stiffness, damping, force, omega, phase, [x, v]);
    // The particle falls freely before it meets the floor at y = x.
    let t = phase / omega;
    let (y0, y0_rate) = (x - y_rate * t - 0.5 * gravity * t * t, y_rate + gravity * t);
    let drive = Excitation::Harmonic { force, angular_frequency: omega };
    let scene = scene(base(mass, stiffness, damping), gravity, damper, drive);
    let start = in_flight([x0, v0], [y0 - x0, y0_rate - v0]);
    let options = Options {
        skip,
        average: 100,
        start,
        record_events: usize::MAX,
        // What a stop of 1e18 kg takes up is beyond rounding.
        audit: scene.dampers[0].particle_mass < 1e9,
        ..Options::default()
    };
    let response = run(&scene, &options);
    let impacts = only(&response, EventKind::FloorContact);
    Steady { scene, response, impacts, omega }
}

impl Steady {
    fn last(&self) -> Event {
        *self.impacts.last().expect("it met the floor")
    }

    /// Seconds between the last two floor impacts.
    fn flight(&self) -> f64 {
        let [a, b] = [self.impacts[self.impacts.len() - 2], self.last()];
        instant(&self.scene, &b) - instant(&self.scene, &a)
    }
}

/// A particle that lands every other cycle, in steady motion.
pub(super) fn one_floor_impact() -> Steady {
    let (given, value) = open("one-floor-impact-per-2-period-b");
    let (mass, particle, e) = (given.number("base_mass"), given.number("particle_mass"), given.number("restitution"));
    let ball = damper(particle, f64::INFINITY, rigid(e));
    // Stated after the impact; before it the impulse is still in the particle.
    let impulse = value[2];
    let before = [value[3], 0.360_350_057_062_876_4 + impulse / mass, 1.146_568_363_381_879_4 - impulse / particle];
    settle(&given, [30.0, GRAVITY], ball, value[0], before, 500)
}

#[test]
pub(super) fn a_particle_that_lands_every_other_cycle_moves_as_the_closed_form_says() {
    let (given, value) = open("one-floor-impact-per-2-period-b");
    let (mass, particle) = (given.number("base_mass"), given.number("particle_mass"));
    let steady = one_floor_impact();
    let last = steady.last();
    close("phase", steady.omega * last.time, value[0], 1e-11);
    close("relative velocity before", last.approach, value[1], 1e-11);
    let effective = mass * particle / (mass + particle);
    close("impulse", effective * (last.departure - last.approach), value[2], 1e-11);
    close("RMS velocity", steady.response.window().rms_velocity(), value[4], 1e-11);
    close("two cycles a flight", steady.flight(), 2.0 * TAU / steady.omega, 1e-11);
}

/// Their impact damper in steady motion, from just before a floor impact after which the base has this velocity.
pub(super) fn masri_and_caughey(id: &str, velocity: f64) -> Steady {
    let (given, value) = open(id);
    let (mass, particle) = (given.number("base_mass"), given.number("particle_mass"));
    let damper = damper(particle, given.number("gap"), rigid(given.number("restitution")));
    // Symmetric motion: the particle arrives with −V, and the impact hands the base −2 mp V/m.
    let before = [value[2], velocity + 2.0 * particle * value[1] / mass, -value[1]];
    settle(&given, [10.0, 0.0], damper, value[0], before, 500)
}

#[test]
pub(super) fn the_impact_damper_of_masri_and_caughey_moves_as_they_say() {
    for (id, velocity) in [
        ("masri-caughey-two-impacts-a", 1.030_216_589_546_725_5),
        ("masri-caughey-two-impacts-b", 0.246_499_927_843_622_73),
    ] {
        let value = expected(id);
        let steady = masri_and_caughey(id, velocity);
        let last = steady.last();
        close(&format!("{id}, phase"), steady.omega * last.time, value[0], 1e-11);
        close(&format!("{id}, relative velocity before"), last.approach, value[3], 1e-11);
        let rms = steady.response.window().rms_velocity();
        close(&format!("{id}, RMS velocity"), rms, value[4], 1e-11);
        let mut bare = steady.scene.clone();
        bare.dampers.clear();
        let alone = run(&bare, &Options { skip: 500, ..Options::default() }).window().rms_velocity();
        close(&format!("{id}, velocity ratio"), alone / rms, value[5], 1e-11);
        assert_eq!(steady.response.counts.floor_contacts, 100);
        assert_eq!(steady.response.counts.ceiling_contacts, 100);
    }
}

/// An oscillator that hits a fixed stop once a cycle, in steady motion.
pub(super) fn fixed_stop(given: &Case, value: &Expected, place: f64) -> Steady {
    // A particle too heavy to be moved is the stop; 1e15 kg would recede by 2e-12 m in these hundred impacts.
    let stop = damper(1e18, f64::INFINITY, rigid(given.number("restitution")));
    settle(given, [20.0, 0.0], stop, value[1], [place, value[0], 0.0], 0)
}

#[test]
pub(super) fn an_oscillator_that_hits_a_fixed_stop_moves_as_the_closed_form_says() {
    for (id, place) in [("fixed-stop-one-impact-b", 0.01), ("fixed-stop-one-impact-d", 0.0)] {
        let (given, value) = open(id);
        let steady = fixed_stop(&given, &value, place);
        let last = steady.last();
        close(&format!("{id}, speed before"), -last.approach, value[0], 1e-11);
        close(&format!("{id}, phase"), steady.omega * last.time, value[1], 1e-11);
        assert_eq!(steady.response.counts.floor_contacts, 100);
    }
}

#[test]
pub(super) fn a_spring_with_a_dashpot_has_its_restitution() {
    let (given, value) = open("restitution-spring-dashpot-zeta0.5");
    let floor = resilient(given.number("floor_stiffness"), given.number("floor_damping"));
    let particle = damper(given.number("particle_mass"), f64::INFINITY, floor);
    let start = in_flight([0.0, 0.0], [0.01, -1.0]);
    let response = run(&floating(&given, 0.0, particle.clone(), 0.1), &once(start.clone()));
    let [contact, release] = response.events[..] else { panic!("two events, not {:?}", response.events) };
    close("contact time", release.time - contact.time, value[0], 1e-12);
    close("restitution", release.departure / -contact.approach, value[1], 1e-12);

    // Deepest where ω_d t = arccos ζ: run until then.
    let effective = 0.05 / 1.05;
    let (zeta, w0) = (0.5, (1000.0_f64 / effective).sqrt());
    let deepest = contact.time + f64::acos(zeta) / (w0 * (1.0_f64 - zeta * zeta).sqrt());
    let response = run(&floating(&given, 0.0, particle, deepest), &once(start));
    let [y, _] = response.final_particles[0];
    close("deepest point", y - response.final_displacement, value[2], 1e-12);
}

#[test]
pub(super) fn a_floor_that_cannot_pull_has_its_own_restitution() {
    for id in ["restitution-no-tension-zeta0.5", "restitution-no-tension-zeta0.7071", "restitution-no-tension-zeta0.9"]
    {
        let (given, value) = open(id);
        let floor = resilient_without_tension(given.number("floor_stiffness"), given.number("floor_damping"));
        let particle = damper(given.number("particle_mass"), f64::INFINITY, floor);
        let response = run(&floating(&given, 0.0, particle, 0.1), &once(in_flight([0.0, 0.0], [0.0, -1.0])));
        let release = only(&response, EventKind::FloorRelease)[0];
        close(&format!("{id}, contact time"), release.time, value[0], 1e-12);
        close(&format!("{id}, restitution"), release.departure, value[1], 1e-12);
    }
    // At critical damping it is e⁻², beyond it ((b + Ω)/(b − Ω))^(−b/Ω); the floor that can pull never lets go there.
    let effective: f64 = 0.05 / 1.05;
    let critical = 2.0 * (1000.0 * effective).sqrt();
    for (zeta, restitution) in [(1.0, (-2.0_f64).exp()), (1.5, beyond_critical(1.5))] {
        let given = case("restitution-no-tension-zeta0.5").part("scene");
        let particle = damper(0.05, f64::INFINITY, resilient_without_tension(1000.0, zeta * critical));
        let response = run(&floating(&given, 0.0, particle, 0.1), &once(in_flight([0.0, 0.0], [0.0, -1.0])));
        let release = only(&response, EventKind::FloorRelease)[0];
        close(&format!("ζ = {zeta}, restitution"), release.departure, restitution, 1e-12);
        let glued = damper(0.05, f64::INFINITY, resilient(1000.0, zeta * critical));
        let response = run(&floating(&given, 0.0, glued, 0.1), &once(in_flight([0.0, 0.0], [0.0, -1.0])));
        assert!(only(&response, EventKind::FloorRelease).is_empty());
    }
}

fn beyond_critical(zeta: f64) -> f64 {
    let root = (zeta * zeta - 1.0).sqrt();
    ((zeta + root) / (zeta - root)).powf(-zeta / root)
}

#[test]
pub(super) fn elastic_bounces_keep_their_period() {
    let (given, value) = open("elastic-bounce-period");
    let particle =
        damper(given.number("particle_mass"), f64::INFINITY, resilient(given.number("floor_stiffness"), 0.0));
    let start = in_flight([0.0, 0.0], [0.0, 0.3]);
    let response = run(&floating(&given, GRAVITY, particle.clone(), 2.0), &once(start.clone()));
    let twentieth = only(&response, EventKind::FloorRelease)[19];
    close("20th lift-off", twentieth.time, value[0], 1e-12);
    close("its velocity", twentieth.departure, value[1], 1e-12);
    // Base and particle fall together for a thousand bounces; what they do to each other must not fade with the distance.
    let long = floating(&given, GRAVITY, particle, 1.0001 * 50.0 * value[0]);
    let response = run(&long, &once(start));
    let thousandth = only(&response, EventKind::FloorRelease)[999];
    close("1000th lift-off", thousandth.time, 50.0 * value[0], 1e-12);
    close("its velocity", thousandth.departure, value[1], 1e-12);
}

#[test]
pub(super) fn a_gap_of_nothing_makes_a_bilinear_oscillator() {
    let (given, value) = open("bilinear-oscillator-frequency");
    let mut particle = damper(given.number("particle_mass"), 0.0, resilient(given.number("floor_stiffness"), 0.0));
    particle.ceiling = resilient(given.number("ceiling_stiffness"), 0.0);
    let swing = floating(&given, 0.0, particle, 0.34);
    let response = run(&swing, &once(in_flight([0.0, 0.0], [0.0, -0.5])));
    let landings = only(&response, EventKind::FloorContact);
    close("frequency", TAU / (landings[1].time - landings[0].time), value[0], 1e-12);
    // The first landing is the start itself.
    close("10th return", landings[10].time, value[1], 1e-12);
    close("its velocity", landings[10].approach, value[2], 1e-12);
}

#[test]
pub(super) fn a_limit_stop_takes_what_its_restitution_leaves() {
    let (given, value) = open("limit-stop-eps0");
    let mut particle =
        damper(given.number("particle_mass"), f64::INFINITY, resilient(given.number("floor_stiffness"), 0.0));
    particle.stop = Some(LimitStop { length: given.number("limit_stop"), restitution: given.number("eps_stop") });
    let response = run(&floating(&given, 0.0, particle.clone(), 0.1), &once(in_flight([0.0, 0.0], [0.0, -1.0])));
    let [stop, release] = [EventKind::FloorStop, EventKind::FloorRelease].map(|kind| only(&response, kind)[0]);
    close("speed at the stop", -stop.approach, value[0], 1e-12);
    close("time of the stop", stop.time, value[1], 1e-12);
    close("time of release", release.time, value[2], 1e-12);
    close("speed there", release.departure, value[3], 1e-12);

    // With ε = 0.5 it comes off the stop with half the speed: t = atan(ω₀ δ/(ε v))/ω₀ later.
    particle.stop = Some(LimitStop { length: given.number("limit_stop"), restitution: 0.5 });
    let response = run(&floating(&given, 0.0, particle, 0.1), &once(in_flight([0.0, 0.0], [0.0, -1.0])));
    let release = only(&response, EventKind::FloorRelease)[0];
    let w0 = (1000.0_f64 * 1.05 / 0.05).sqrt();
    let (depth, speed) = (w0 * 0.004, 0.5 * value[0]);
    close("time of release, ε = 0.5", release.time, value[1] + (depth / speed).atan() / w0, 1e-12);
    close("speed there, ε = 0.5", release.departure, speed.hypot(depth), 1e-12);
}

#[test]
pub(super) fn a_ceiling_that_floats_is_a_third_body() {
    let (given, value) = open("model3-free-ceiling-zeta0.3");
    let (ceiling, particle) = (given.number("ceiling_mass"), given.number("particle_mass"));
    let surface = resilient(given.number("ceiling_stiffness"), given.number("ceiling_damping"));
    let mut damper = damper(particle, given.number("gap"), surface);
    damper.walls = Some(Walls { stiffness: 0.0, damping: 0.0, ceiling_mass: ceiling });
    let collide = scene(base(given.number("base_mass") + ceiling, 0.0, 0.0), 0.0, damper, nothing(0.1));
    let start = StartState::Given {
        q: vec![0.0; 2],
        rate: vec![0.0; 2],
        particles: vec![Placed::new(Contact::Flight, 0.0, 1.0)],
    };
    let response = run(&collide, &once(start));
    let [contact, release] = [EventKind::CeilingContact, EventKind::CeilingRelease].map(|k| only(&response, k)[0]);
    close("contact time", release.time - contact.time, value[0], 1e-12);
    close("particle after", response.final_particles[0][1], value[1], 1e-12);
    close("ceiling after", response.final_particles[0][1] - release.departure, value[2], 1e-12);
    within("base after", response.final_velocity, value[3], 1e-14);
}

#[test]
pub(super) fn a_particle_rests_until_the_base_falls_faster_than_it() {
    let (given, value) = open("harmonic-resting-particle-w1");
    let (mass, stiffness, particle) =
        (given.number("base_mass"), given.number("stiffness"), given.number("particle_mass"));
    let (damping, omega) = (0.1 * (stiffness * mass).sqrt(), (stiffness / mass).sqrt());
    let rest = |force: f64| {
        let ball = damper(particle, f64::INFINITY, rigid(0.0));
        scene(base(mass, stiffness, damping), GRAVITY, ball, Excitation::Harmonic { force, angular_frequency: omega })
    };
    let half = run(&rest(0.5 * value[0]), &Options { skip: 200, audit: true, ..Options::default() });
    close("RMS velocity", half.window().rms_velocity(), value[1], 1e-13);
    close("deviation", half.window().std_displacement(), value[2], 1e-13);
    close("mean", half.window().mean_displacement(), value[3], 1e-13);
    assert_eq!(half.proof.events, 0);
    // On the steady orbit of the loaded base, a millionth below and above the force at which it lifts off.
    for (factor, leaves) in [(0.999_999, value[4] != 0.0), (1.000_001, value[5] != 0.0)] {
        let force = factor * value[0];
        let (stiff, lag) = (stiffness - (mass + particle) * omega * omega, damping * omega);
        let scale = force / (stiff * stiff + lag * lag);
        let start = StartState::Given {
            q: vec![-lag * scale - particle * GRAVITY / stiffness],
            rate: vec![omega * stiff * scale],
            particles: vec![Placed::ON_FLOOR],
        };
        let response = run(&rest(force), &Options { skip: 0, average: 3, start, ..Options::default() });
        assert_eq!(response.proof.events > 0, leaves, "at {factor} of the lift-off force");
    }
}

#[test]
pub(super) fn impulses_without_a_damper_are_a_geometric_series() {
    let (given, value) = open("impulse-train-bare-T0.05");
    let (mass, stiffness) = (given.number("base_mass"), given.number("stiffness"));
    let damping = 0.1 * (stiffness * mass).sqrt();
    let train = |impulse, period| {
        Scene::on_one_mass(
            base(mass, stiffness, damping),
            GRAVITY,
            Vec::new(),
            Excitation::ImpulseTrain { impulse, period },
        )
    };
    let options = Options { skip: 500, audit: true, ..Options::default() };
    let response = run(&train(given.number("impulse_n_s"), given.number("period_s")), &options);
    close("x at the impulse", response.final_displacement, value[0], 1e-12);
    close("v before it", response.final_velocity, value[1], 1e-12);
    close("RMS velocity", response.window().rms_velocity(), value[2], 1e-12);
    close("deviation", response.window().std_displacement(), value[3], 1e-12);
    close("mean", response.window().mean_displacement(), value[4], 1e-12);

    let (given, value) = open("impulse-train-long-period-limit");
    let rare = train(given.number("impulse_n_s"), given.number("period_s"));
    let response = run(&rare, &Options { skip: 1, average: 3, audit: true, ..Options::default() });
    close("one free decay", response.window().rms_velocity(), value[0], 1e-13);
}

#[test]
pub(super) fn an_impulse_downwards_leaves_the_particle_behind() {
    let (given, value) = open("impulse-downwards-leaves-at-once");
    let ball = damper(given.number("particle_mass"), f64::INFINITY, rigid(given.number("restitution")));
    let pull = scene(
        base(given.number("base_mass"), given.number("stiffness"), 0.0),
        GRAVITY,
        ball,
        Excitation::SingleImpulse { impulse: -0.5, cycle: 0.1 },
    );
    let response = run(&pull, &once(StartState::StaticEquilibrium));
    let [left, landed] = [response.events[0], response.events[1]];
    assert_eq!((left.kind, left.time), (EventKind::FloorRelease, 0.0));
    assert_eq!(landed.kind, EventKind::FloorContact);
    close("landing", landed.time, value[0], 1e-12);
    close("its velocity", landed.approach, value[1], 1e-12);
}

#[test]
pub(super) fn a_resting_particle_and_its_floor_have_their_two_frequencies() {
    let (given, value) = open("model2-resting-frequencies");
    let (mass, stiffness, particle, floor) = (
        given.number("base_mass"),
        given.number("stiffness"),
        given.number("particle_mass"),
        given.number("floor_stiffness"),
    );
    for omega in [value[0], value[1]] {
        // Started in its shape, a mode is back after one period.
        let rest = scene(
            base(mass, stiffness, 0.0),
            GRAVITY,
            damper(particle, f64::INFINITY, resilient(floor, 0.0)),
            nothing(TAU / omega),
        );
        let amplitude = 1e-5;
        let ratio = floor / (floor - particle * omega * omega);
        let sunk = [-particle * GRAVITY / stiffness, -particle * GRAVITY / floor];
        let start = StartState::Given {
            q: vec![sunk[0] + amplitude],
            rate: vec![0.0],
            particles: vec![Placed::new(Contact::Floor, sunk[1] + amplitude * (ratio - 1.0), 0.0)],
        };
        let response = run(&rest, &once(start));
        assert_eq!(response.proof.events, 0);
        within("x after a period", response.final_displacement, sunk[0] + amplitude, 1e-12 * amplitude);
        within("v after a period", response.final_velocity, 0.0, 1e-12 * amplitude * omega);
        if omega == value[1] {
            close("highest frequency", response.highest_frequency, omega, 1e-13);
        }
    }
}

#[test]
pub(super) fn the_mean_displacement_is_what_momentum_asks_for() {
    let (given, value) = open("momentum-balance-model1-restitution");
    let (mass, particle, stiffness) =
        (given.number("base_mass"), given.number("particle_mass"), given.number("stiffness"));
    let (impulse, period) = (given.number("impulse_n_s"), given.number("period_s"));
    let damping = 2.0 * given.number("damping_ratio") * (stiffness * mass).sqrt();
    let rattle = scene(
        base(mass, stiffness, damping),
        GRAVITY,
        damper(particle, given.number("gap"), rigid(given.number("restitution"))),
        Excitation::ImpulseTrain { impulse, period },
    );
    let at = |skip, average| run(&rattle, &Options { skip, average, ..Options::default() });
    // One run ends where the window of the other begins.
    let (begin, response) = (at(0, 25), at(25, 100));
    let time = 100.0 * period;
    let [moved, gained] =
        [response.final_displacement - begin.final_displacement, response.final_velocity - begin.final_velocity];
    let carried = response.final_particles[0][1] - begin.final_particles[0][1];
    let force = 100.0 * impulse - particle * GRAVITY * time - damping * moved - mass * gained - particle * carried;
    let left = stiffness * response.window().mean_displacement() * time - force;
    within("momentum", left, value[0], 100.0 * 1e-12);
}

#[test]
pub(super) fn a_stiff_floor_tends_to_the_restitution_of_half_a_cycle() {
    let (given, value) = open("stiff-floor-restitution-kf1e9");
    let error = |softer: f64| {
        let floor = resilient(given.number("floor_stiffness") / softer, given.number("floor_damping") / softer.sqrt());
        let drop = scene(
            base(given.number("base_mass"), given.number("stiffness"), 0.0),
            GRAVITY,
            damper(given.number("particle_mass"), f64::INFINITY, floor),
            nothing(0.01),
        );
        let response = run(&drop, &once(in_flight([0.0, 0.0], [0.0, -1.0])));
        only(&response, EventKind::FloorRelease)[0].departure / value[0] - 1.0
    };
    within("kf = 1e9", error(1.0), 0.0, 1e-3);
    close("100 times softer, 10 times further off", error(100.0) / error(1.0), 10.0, 0.05);
}

#[test]
pub(super) fn the_ball_of_the_sensitivity_suites_is_met_to_all_printed_digits() {
    let (given, value) = open("sciml-bouncing-ball");
    let gravity = given.number("gravity");
    let ball = damper(0.05, f64::INFINITY, rigid(given.number("restitution")));
    let drop = floating(&given, gravity, ball, 5.0);
    let response = run(&drop, &once(in_flight([0.0, 0.0], [50.0, 0.0])));
    let impact = response.events[0];
    close("first impact", impact.time, value[0], 1e-14);
    close("velocity before", impact.approach, value[1], 1e-14);
    close("velocity after", impact.departure, value[2], 1e-14);
    let (_, value) = open("bouncing-ball-sensitivity");
    let height = |restitution: f64, gravity: f64, from: f64| {
        let ball = damper(0.05, f64::INFINITY, rigid(restitution));
        let end = run(&floating(&given, gravity, ball, 5.0), &once(in_flight([0.0, 0.0], [from, 0.0])));
        end.final_particles[0][0] - end.final_displacement
    };
    let restitution = given.number("restitution");
    close("height after 5 s", height(restitution, gravity, 50.0), value[0], 1e-12);
    let by = |step: f64, at: &dyn Fn(f64) -> f64| (at(step) - at(-step)) / (2.0 * step);
    let slopes = [
        by(1e-4, &|step| height(restitution, gravity, 50.0 + step)),
        by(1e-4, &|step| height(restitution, gravity + step, 50.0)),
        by(1e-5, &|step| height(restitution + step, gravity, 50.0)),
    ];
    for (i, (what, slope)) in ["start height", "gravity", "restitution"].into_iter().zip(slopes).enumerate() {
        close(&format!("slope by {what}"), slope, value[i + 1], 1e-6);
    }
}

/// Everything that meets a case, here and in the room of structures.
const TESTS: &[fn()] = &[
    chatter_ends_where_the_geometric_series_does,
    a_particle_that_grazes_the_ceiling_is_met_on_both_sides,
    an_accelerated_base_is_a_stronger_gravity,
    a_ball_on_a_vibrating_table_keeps_its_phase,
    elasticities::the_impact_damper_of_masri_and_caughey_has_the_derivatives_of_its_closed_form,
    the_impact_map_of_a_ball_on_a_table_has_its_multipliers,
    the_orbit_of_masri_and_caughey_has_its_floquet_multipliers,
    just_below_period_doubling_every_flight_is_alike,
    an_inelastic_ball_leaves_and_lands_at_the_phases_of_theory,
    a_particle_that_lands_every_other_cycle_moves_as_the_closed_form_says,
    the_impact_damper_of_masri_and_caughey_moves_as_they_say,
    an_oscillator_that_hits_a_fixed_stop_moves_as_the_closed_form_says,
    a_spring_with_a_dashpot_has_its_restitution,
    a_floor_that_cannot_pull_has_its_own_restitution,
    elastic_bounces_keep_their_period,
    a_gap_of_nothing_makes_a_bilinear_oscillator,
    a_limit_stop_takes_what_its_restitution_leaves,
    a_ceiling_that_floats_is_a_third_body,
    a_particle_rests_until_the_base_falls_faster_than_it,
    impulses_without_a_damper_are_a_geometric_series,
    an_impulse_downwards_leaves_the_particle_behind,
    a_resting_particle_and_its_floor_have_their_two_frequencies,
    the_mean_displacement_is_what_momentum_asks_for,
    a_stiff_floor_tends_to_the_restitution_of_half_a_cycle,
    the_ball_of_the_sensitivity_suites_is_met_to_all_printed_digits,
    structures::a_cantilever_has_the_exact_frequencies_and_stays_right_to_sixty_modes,
    structures::a_plate_has_the_frequencies_of_leissa,
    structures::a_mass_on_a_beam_and_on_a_plate_lowers_their_frequencies_as_in_closed_form,
    structures::impulses_on_the_clean_cantilever_are_the_sum_of_their_modes,
    structures::a_harmonic_force_at_the_tip_moves_it_as_the_damped_partial_differential_equation_says,
    structures::a_constant_force_bends_the_cantilever_by_the_textbooks_cubic,
];

#[test]
pub(super) fn no_case_is_forgotten() {
    MET.take();
    TESTS.iter().for_each(|test| test());
    let met = MET.take();
    for case in all() {
        let id = case.text("id");
        for i in 0..case.numbers("value").len() {
            assert!(met.contains(&(id.into(), i)), "no test reads value {i} of `{id}`");
        }
    }
}
