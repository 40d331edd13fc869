//! Names of motions and the multipliers that prove them, against closed forms, differences of whole runs, and a map iterated
//! by itself.

use std::f64::consts::{PI, TAU};

use shotdamp::dynamics::{
    Contact, EngineError, EventKind, Exponent, HybridSystem, Law, Motion, MotionKind, Multiplier, Options, Placed,
    StartState, Stop, event_driven, fundamental_matrix,
};
use shotdamp::scene::{Damper, Excitation, LimitStop, Scene};

use super::arrays::{Dice, any_scene, structure_after};
use super::bench::{
    GRAVITY, base, close, damper, in_flight, note, nothing, resilient, rigid, run, scene, system, within,
};
use super::closed_forms::{expected, masri_and_caughey, open, table};

/// The motion that a run ends in.
fn motion(scene: &Scene, start: StartState, skip: u32, average: u32) -> Motion {
    let options = Options { skip, average, start, motion: true, ..Options::default() };
    let response = run(scene, &options);
    let motion = response.motion.expect("it was asked for");
    if !motion.multipliers.is_empty() {
        // The product of the multipliers is what dashpots and impacts make of it, whatever the scene; the fastest motion turns
        // the rounding of a place into one of a speed.
        let turns = 1.0 + response.highest_frequency * scene.excitation.period();
        within("product of the multipliers", motion.residual, 0.0, 64.0 * f64::EPSILON * turns);
    }
    motion
}

/// Real parts, summed, and moduli, multiplied.
pub(super) fn trace_and_product(multipliers: &[Multiplier]) -> [f64; 2] {
    let trace = multipliers.iter().map(|it| it.modulus * it.angle.cos()).sum();
    [trace, multipliers.iter().map(|it| it.modulus).product()]
}

#[test]
fn the_orbit_of_masri_and_caughey_has_its_multipliers_to_nine_digits() {
    let value = expected("floquet-masri-b");
    let steady = masri_and_caughey("masri-caughey-two-impacts-b", 0.246_499_927_843_622_73);
    let [y, w] = steady.response.final_particles[0];
    let (x, v) = (steady.response.final_displacement, steady.response.final_velocity);
    let motion = motion(&steady.scene, in_flight([x, v], [y - x, w - v]), 10, 10);
    assert_eq!(motion.kind.to_string(), "periodic 1:2");
    for (i, multiplier) in motion.multipliers.iter().enumerate() {
        close(&format!("modulus {i}"), multiplier.modulus, value[i], 1e-9);
    }
    close("product", trace_and_product(&motion.multipliers)[1], value[4], 1e-9);
}

#[test]
fn a_ball_on_a_table_has_the_trace_and_determinant_of_the_impact_map() {
    let (given, value) = open("table-period1-multipliers");
    let omega = given.number("angular_frequency");
    let (table, amplitude) = table(&given, given.number("dimensionless_acceleration"));
    let start = in_flight(
        [0.0, amplitude * omega],
        [0.005_609_621_849_637_127_4, -0.430_238_648_865_100_86 - amplitude * omega],
    );
    let motion = motion(&table, start, 100, 100);
    assert_eq!(motion.kind.to_string(), "periodic 1:1");
    // The table itself rings on, undamped: e^(±iω₀T).
    let (table, ball): (Vec<Multiplier>, Vec<_>) = motion.multipliers.iter().partition(|it| it.modulus > 0.9);
    let ringing = given.number("stiffness").sqrt() * TAU / omega;
    for multiplier in &table {
        close("modulus of the table", multiplier.modulus, 1.0, 1e-12);
        close("its angle", multiplier.angle.cos(), ringing.cos(), 1e-11);
    }
    let [trace, product] = trace_and_product(&ball);
    within("trace", trace, value[0], 1e-10);
    within("determinant", product, value[1], 1e-12);
}

/// A table so heavy that a ball does not move it, damped to half of its critical damping, on its forced orbit.
pub(super) struct Table {
    pub(super) omega: f64,
    /// Of its motion A sin(ω t − δ).
    amplitude: f64,
    pub(super) lag: f64,
    restitution: f64,
    damping: f64,
}

impl Table {
    pub(super) fn new(restitution: f64, acceleration: f64) -> Self {
        let (omega, stiffness): (f64, f64) = (60.0, 1000.0);
        let damping = stiffness.sqrt();
        let lag = (damping * omega).atan2(stiffness - omega * omega);
        Self { omega, amplitude: acceleration * GRAVITY / (omega * omega), lag, restitution, damping }
    }

    pub(super) fn period(&self) -> f64 {
        TAU / self.omega
    }

    /// The table's place, velocity and acceleration.
    pub(super) fn at(&self, t: f64) -> [f64; 3] {
        let phase = self.omega * t - self.lag;
        let (a, w) = (self.amplitude, self.omega);
        [a * phase.sin(), a * w * phase.cos(), -a * w * w * phase.sin()]
    }

    pub(super) fn scene(&self) -> Scene {
        let force = self.amplitude * (1000.0 - self.omega * self.omega).hypot(self.damping * self.omega);
        let drive = Excitation::Harmonic { force, angular_frequency: self.omega };
        scene(base(1.0, 1000.0, self.damping), GRAVITY, damper(0.0, f64::INFINITY, rigid(self.restitution)), drive)
    }

    /// The ball so high above it, at rest relative to it.
    pub(super) fn start(&self, height: f64) -> StartState {
        let [x, v, _] = self.at(0.0);
        in_flight([x, v], [height, 0.0])
    }

    /// On its way to the impact of the orbit with one flight a period, `off` beside it: X″ falls there, and A cos φ ω =
    /// (1 − ε)/(1 + ε) gT/2.
    pub(super) fn on_orbit(&self, off: f64) -> StartState {
        let e = self.restitution;
        let half = 0.5 * GRAVITY * self.period();
        let phase = ((1.0 - e) / (1.0 + e) * half / (self.amplitude * self.omega)).acos();
        let impact = (phase + self.lag).rem_euclid(TAU) / self.omega;
        let place = self.at(impact)[0] + half * impact - 0.5 * GRAVITY * impact * impact;
        let [x, v, _] = self.at(0.0);
        in_flight([x, v], [place - x + off, GRAVITY * impact - half - v])
    }

    /// What the table's own damping leaves of a disturbance in a period.
    pub(super) fn own_multiplier(&self) -> f64 {
        (-0.5 * self.damping * self.period()).exp()
    }

    /// Growth of a tangent vector in a cycle, by the impact map: time and velocity after an impact to those after the next.
    fn exponent(&self, height: f64, impacts: u32) -> f64 {
        let [x, v, _] = self.at(0.0);
        let (mut t, mut velocity) = (0.0, v);
        let mut rise = height;
        let (mut dt, mut dv) = (0.3, 1.0);
        let mut grown = 0.0;
        let mut begun = 0.0;
        let mut origin = x;
        for i in 0..impacts {
            let above = |time: f64| {
                let tau = time - t;
                origin + rise + velocity * tau - 0.5 * GRAVITY * tau * tau - self.at(time)[0]
            };
            let step = self.period() / 2000.0;
            let mut high = t + step;
            while above(high) > 0.0 {
                high += step;
            }
            let mut low = high - step;
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if above(middle) > 0.0 { low = middle } else { high = middle }
            }
            let [place, speed, bend] = self.at(high);
            let arrival = velocity - GRAVITY * (high - t);
            let tau = high - t;
            let shift = -((self.at(t)[1] - velocity + GRAVITY * tau) * dt + tau * dv) / (arrival - speed);
            let late = dv - GRAVITY * (shift - dt);
            let e = self.restitution;
            (dt, dv) = (shift, (1.0 + e) * bend * shift - e * late);
            (t, velocity, rise, origin) = (high, (1.0 + e) * speed - e * arrival, 0.0, place);
            let length = (dt * self.omega).hypot(dv / (self.amplitude * self.omega));
            (dt, dv) = (dt / length, dv / length);
            if i > impacts / 20 {
                grown += length.ln();
            } else {
                begun = t;
            }
        }
        grown / ((t - begun) / self.period())
    }
}

#[test]
fn a_ball_on_a_table_goes_from_rest_through_doublings_to_chaos() {
    let name = |restitution: f64, acceleration: f64, bounces: bool| {
        let table = Table::new(restitution, acceleration);
        let start = if bounces { table.on_orbit(1e-5) } else { table.start(1e-3) };
        let found = motion(&table.scene(), start, 400, 400);
        println!("ε = {restitution}, Γ = {acceleration}: {} {:?}", found.kind, found.exponent);
        (table, found)
    };
    let rests = Table::new(0.5, 0.9);
    let resting = motion(&rests.scene(), StartState::StaticEquilibrium, 25, 100);
    assert_eq!(resting.kind, MotionKind::AtRest);
    close("what is left of the table's disturbance", resting.multipliers[0].modulus, rests.own_multiplier(), 1e-12);

    // One flight a period exists from Γ = π(1 − ε)/(1 + ε), and doubles where its trace is −(1 + ε²).
    let e: f64 = 0.5;
    let begin = PI * (1.0 - e) / (1.0 + e);
    let doubling = begin.hypot(2.0 * (1.0 + e * e) / ((1.0 + e) * (1.0 + e)));
    let (_, single) = name(e, 0.97 * doubling, true);
    assert_eq!(single.kind.to_string(), "periodic 1:1");
    let (_, double) = name(e, 1.03 * doubling, true);
    assert_eq!(double.kind.to_string(), "periodic 2:2");

    // A ball that does not bounce remembers nothing: what is left is the table's.
    let (table, plastic) = name(0.0, 1.5, false);
    assert_eq!(plastic.kind.to_string(), "sticking 1:1");
    close("table under a plastic ball", plastic.multipliers[0].modulus, table.own_multiplier(), 1e-12);
    assert!(plastic.multipliers[2..].iter().all(|it| it.modulus < 1e-12), "{:?}", plastic.multipliers);
    let (table, chatter) = name(0.3, 1.05, false);
    assert_eq!(chatter.kind.to_string(), "completed chatter 1:∞");
    close("table under a chattering ball", chatter.multipliers[0].modulus, table.own_multiplier(), 1e-12);
    assert!(chatter.multipliers[2..].iter().all(|it| it.modulus < 1e-12), "{:?}", chatter.multipliers);
}

#[test]
fn a_ball_that_chatters_beside_one_that_flies_has_infinitely_many_impacts() {
    let [chatters, flies] = [0.3, 0.6].map(|restitution| Table::new(restitution, 1.05));
    let mut both = flies.scene();
    both.dampers.push(damper(0.0, f64::INFINITY, rigid(0.3)));
    let (StartState::Given { q, rate, mut particles }, StartState::Given { particles: more, .. }) =
        (flies.on_orbit(1e-5), chatters.start(1e-3))
    else {
        panic!("both are given")
    };
    particles.extend(more);
    let alone = motion(&flies.scene(), flies.on_orbit(1e-5), 400, 400);
    assert_eq!(alone.kind.to_string(), "periodic 1:1");
    let found = motion(&both, StartState::Given { q, rate, particles }, 400, 400);
    assert_eq!(found.kind.to_string(), "completed chatter 1:∞");
    close("multiplier of the ball that flies", found.multipliers[0].modulus, alone.multipliers[0].modulus, 1e-9);
}

#[test]
fn the_exponent_of_a_chaotic_ball_is_that_of_the_impact_map() {
    let table = Table::new(0.9, 8.0);
    let found = motion(&table.scene(), table.start(0.01), 100, 4000);
    assert_eq!(found.kind, MotionKind::Chaotic);
    let exponent = found.exponent.expect("it is chaotic");
    let map = [1, 2, 3, 4].map(|i| table.exponent(0.01 * f64::from(i), 5_000));
    let mean = map.iter().sum::<f64>() / 4.0;
    let scatter = (map.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 12.0).sqrt();
    println!("{map:?}");
    assert!(exponent.error < 0.2 * exponent.value && found.settled_after.is_none());
    within("exponent", exponent.value, mean, 4.0 * exponent.error.hypot(scatter));
}

#[test]
fn what_neither_repeats_nor_parts_is_quasi_periodic_and_what_is_too_short_is_not_settled() {
    let two_frequencies = Excitation::Harmonic { force: 10.0, angular_frequency: 20.0 };
    let undamped = Scene::on_one_mass(base(1.0, 1000.0, 0.0), GRAVITY, Vec::new(), two_frequencies);
    let rings = motion(&undamped, StartState::StaticEquilibrium, 25, 200);
    assert_eq!(rings.kind, MotionKind::QuasiPeriodic);
    let steady = masri_and_caughey("masri-caughey-two-impacts-b", 0.246_499_927_843_622_73);
    let short = motion(&steady.scene, StartState::StaticEquilibrium, 2, 6);
    assert_eq!(short.kind, MotionKind::NotSettled);
    // And after as many cycles as it takes, it has: 0.846 of the disturbance is left each time.
    let [y, w] = steady.response.final_particles[0];
    let (x, v) = (steady.response.final_displacement + 1e-3, steady.response.final_velocity);
    let long = motion(&steady.scene, in_flight([x, v], [y - x, w - v]), 200, 200);
    let settled = long.settled_after.expect("it settles") as f64;
    assert_eq!(long.kind.to_string(), "periodic 1:2");
    assert!((30.0..120.0).contains(&settled), "{settled}");
}

#[test]
fn ever_stiffer_contacts_tend_to_the_multipliers_of_rigid_ones() {
    let value = expected("floquet-masri-b");
    let steady = masri_and_caughey("masri-caughey-two-impacts-b", 0.246_499_927_843_622_73);
    let [y, w] = steady.response.final_particles[0];
    let (x, v) = (steady.response.final_displacement, steady.response.final_velocity);
    let (mass, particle, e): (f64, f64, f64) = (1.0, 0.1, 0.6);
    let zeta = -e.ln() / PI.hypot(e.ln());
    let off = |stiffness: f64| {
        let dashpot = 2.0 * zeta * (stiffness * mass * particle / (mass + particle)).sqrt();
        let mut soft = steady.scene.clone();
        soft.dampers = vec![damper(particle, 0.1, resilient(stiffness, dashpot))];
        let motion = motion(&soft, in_flight([x, v], [y - x, w - v]), 200, 200);
        assert_eq!(motion.kind.to_string(), "periodic 1:2");
        (0..4).map(|i| (motion.multipliers[i].modulus / value[i] - 1.0).abs()).fold(0.0, f64::max)
    };
    let [soft, hard] = [off(1e8), off(1e12)];
    println!("off by {soft:e} at 1e8 N/m, {hard:e} at 1e12 N/m");
    // The time in contact, and with it the difference, falls as the root of the stiffness.
    assert!(hard < 1e-4 && (30.0..300.0).contains(&(soft / hard)), "{soft:e} {hard:e}");
}

/// q, y, q′, y′ at the end of two cycles from a state that is given in the same way; every particle starts in flight.
fn after(system: &HybridSystem, state: &[f64]) -> Vec<f64> {
    let options = start(system, state);
    let end = event_driven(system, &options).expect("it runs");
    let [q, rate] = structure_after(system, &options);
    let particles = |i: usize| end.final_particles.iter().map(move |particle| particle[i]);
    q.into_iter().chain(particles(0)).chain(rate).chain(particles(1)).collect()
}

fn start(system: &HybridSystem, state: &[f64]) -> Options {
    let (n, half) = (system.mass.order, state.len() / 2);
    let (places, rates) = state.split_at(half);
    let on = |row: &[f64], x: &[f64]| row.iter().zip(x).map(|(a, b)| a * b).sum::<f64>();
    let particles = system.particles.iter().enumerate().map(|(j, particle)| {
        let row = &particle.floor.row;
        Placed::new(Contact::Flight, places[n + j] - on(row, &places[..n]), rates[n + j] - on(row, &rates[..n]))
    });
    let given =
        StartState::Given { q: places[..n].to_vec(), rate: rates[..n].to_vec(), particles: particles.collect() };
    Options { skip: 0, average: 2, start: given, ..Options::default() }
}

/// What was compared: entries, scenes, and how often events of some kinds happened.
#[derive(Default)]
struct Compared {
    entries: usize,
    scenes: usize,
    strikes: usize,
    releases: usize,
    stops: usize,
}

impl Compared {
    /// The fundamental matrix of two cycles from `state` against differences of runs from states beside it.
    fn add(&mut self, seed: u64, system: &HybridSystem, state: &[f64]) {
        let half = state.len() / 2;
        let options = start(system, state);
        let map = fundamental_matrix(system, &options).expect("it runs");
        note("product of the multipliers", map.residual, 1e-10);
        assert!(map.residual < 1e-10, "seed {seed}: {:e}", map.residual);
        if !map.is_unique {
            return;
        }
        self.scenes += 1;
        let unit = |i: usize| if i < half { 1e-3 } else { 3e-2 };
        for k in 0..2 * half {
            let difference = |step: f64| -> Vec<f64> {
                let moved = |by: f64| {
                    let mut moved = state.to_vec();
                    moved[k] += by * unit(k);
                    after(system, &moved)
                };
                moved(step).iter().zip(moved(-step)).map(|(a, b)| (a - b) / (2.0 * step)).collect()
            };
            let [fine, coarse] = [difference(1e-6), difference(2e-6)];
            for i in 0..2 * half {
                let most = (0..2 * half).fold(0.0_f64, |most, k| most.max((map.matrix[i][k] * unit(k)).abs()));
                let doubt = (fine[i] - coarse[i]).abs();
                // Where the differences do not know themselves, by a graze or a capture within the step, they prove nothing.
                if doubt > 1e-3 * most {
                    continue;
                }
                self.entries += 1;
                let got = map.matrix[i][k] * unit(k);
                let error = (got - fine[i]).abs();
                assert!(
                    error <= 3.0 * doubt + 1e-5 * most,
                    "seed {seed}, entry {i}, {k}: {got} for {}, doubt {doubt:e}, row {most}",
                    fine[i]
                );
            }
        }
        let events = event_driven(system, &Options { record_events: usize::MAX, ..options }).expect("it runs").events;
        let kinds = |wanted: &[EventKind]| events.iter().filter(|event| wanted.contains(&event.kind)).count();
        self.strikes += kinds(&[EventKind::FloorContact, EventKind::CeilingContact]);
        self.releases += kinds(&[EventKind::FloorRelease, EventKind::CeilingRelease]);
        self.stops += kinds(&[EventKind::FloorStop, EventKind::CeilingStop]);
    }

    fn print(&self) {
        let Self { entries, scenes, strikes, releases, stops } = self;
        println!("{entries} entries of {scenes} scenes; {strikes} strikes, {releases} releases, {stops} stops");
    }
}

/// Any state with every particle in flight.
fn any_flight(seed: u64, system: &HybridSystem) -> Vec<f64> {
    let mut dice = Dice(seed ^ 0x1234);
    let n = system.mass.order;
    let half = n + system.particles.len();
    let mut state: Vec<f64> =
        (0..2 * half).map(|i| dice.between(-1.0, 1.0) * if i < half { 1e-3 } else { 0.1 }).collect();
    for (j, particle) in system.particles.iter().enumerate() {
        let floor: f64 = particle.floor.row.iter().zip(&state).map(|(a, b)| a * b).sum();
        state[n + j] = floor + particle.gap * dice.between(0.2, 0.8);
    }
    state
}

#[test]
fn a_moved_start_ends_where_the_fundamental_matrix_says() {
    let mut compared = Compared::default();
    for seed in 0..60 {
        let system = any_scene(seed);
        if system.particles.iter().all(|particle| particle.gap >= 1e-3) {
            compared.add(seed, &system, &any_flight(seed, &system));
        }
    }
    compared.print();
    assert!(compared.entries > 1000 && compared.strikes > 20 && compared.releases > 20);
}

#[test]
fn a_moved_start_ends_there_through_impacts_on_stops_too() {
    let mut compared = Compared::default();
    for seed in 100..160 {
        let mut system = any_scene(seed);
        let mut dice = Dice(seed ^ 0x5678);
        for particle in &mut system.particles {
            for face in std::iter::once(&mut particle.floor).chain(&mut particle.ceiling) {
                let stop = Some(Stop { length: dice.ratio(3e-5, 1e-3), restitution: dice.between(0.1, 0.9) });
                face.law = Law::Resilient {
                    stiffness: dice.ratio(1e2, 1e4),
                    damping: dice.between(0.0, 2.0),
                    no_tension: dice.chance(0.4),
                    stop,
                };
            }
        }
        if system.particles.iter().all(|particle| particle.gap >= 1e-3) {
            compared.add(seed, &system, &any_flight(seed, &system));
        }
    }
    // A mass on a stop that does not move: a particle that no impact moves.
    for seed in 0..10 {
        let mut dice = Dice(seed);
        let stiffness = dice.ratio(300.0, 3000.0);
        let stands = Damper::between(rigid(dice.between(0.2, 0.9)), 1e18, f64::INFINITY);
        let force = Excitation::Harmonic { force: 20.0, angular_frequency: 0.9 * stiffness.sqrt() };
        let fixed = scene(base(1.0, stiffness, dice.between(0.0, 3.0)), 0.0, stands, force);
        let place = [dice.between(-1e-3, 1e-3), dice.between(1e-3, 5e-3)];
        compared.add(seed, &system(&fixed), &[place[0], place[1], dice.between(0.0, 1.0), 0.0]);
    }
    compared.print();
    assert!(compared.entries > 1000 && compared.stops > 50);
}

#[test]
fn a_name_never_contradicts_its_exponent() {
    // Through doublings and chaos into windows and back, in runs as short as a study's.
    let mut seen = Vec::new();
    for i in 0..120 {
        let table = Table::new(0.1 + 0.2 * f64::from(i % 4), 1.0 + 0.06 * f64::from(i));
        let found = motion(&table.scene(), table.start(0.01), 25, 100);
        let Some(Exponent { value, error }) = found.exponent else { continue };
        let at = format!("Γ = {}: {} at {value} ± {error}", 1.0 + 0.06 * f64::from(i), found.kind);
        match found.kind {
            MotionKind::Chaotic => assert!(value > 3.0 * error, "{at}"),
            MotionKind::QuasiPeriodic => assert!(value.abs() <= error, "{at}"),
            kind if kind.repeats() => assert!(value <= 1e-9, "{at}"),
            _ => {}
        }
        seen.push(std::mem::discriminant(&found.kind));
    }
    seen.dedup();
    assert!(seen.len() > 10, "the motion changes its kind along the way: {}", seen.len());
}

#[test]
fn a_drop_on_a_resilient_floor_with_a_stop_has_its_product() {
    let mut stopped: Damper = damper(0.05, f64::INFINITY, resilient(1000.0, 0.5));
    stopped.stop = Some(LimitStop { length: 0.004, restitution: 0.4 });
    let drop = scene(base(1.0, 0.0, 0.0), 0.0, stopped, nothing(0.05));
    let options = Options { skip: 0, average: 1, start: in_flight([0.0, 0.0], [0.01, -1.0]), ..Options::default() };
    let map = fundamental_matrix(&system(&drop), &options).expect("it runs");
    let events = run(&drop, &Options { record_events: usize::MAX, ..options }).events;
    let at = |kind: EventKind| events.iter().find(|event| event.kind == kind).expect("it happens").time;
    let pressed = at(EventKind::FloorRelease) - at(EventKind::FloorContact);
    // ε² of the stop, and the dashpot's c/m of the relative motion while it is pressed.
    let product = 0.4 * 0.4 * (-0.5 * (1.0 / 0.05 + 1.0) * pressed).exp();
    close("product", trace_and_product(&map.multipliers)[1], product, 1e-12);
}

#[test]
fn a_contact_whose_damping_remembers_has_no_name() {
    let remembers = super::half_cycles::on_one_mass(&mut Dice(1), 0.05, 1);
    let error = event_driven(&remembers, &Options { motion: true, ..Options::default() });
    assert_eq!(error, Err(EngineError::DampingWithMemory));
}

#[test]
fn every_name_of_a_motion_reads_back() {
    for kind in [
        MotionKind::AtRest,
        MotionKind::Periodic { periods: 3, contacts: 7 },
        MotionKind::Sticking { periods: 1, contacts: 2 },
        MotionKind::CompletedChatter { periods: 2 },
        MotionKind::QuasiPeriodic,
        MotionKind::Chaotic,
        MotionKind::NotSettled,
    ] {
        assert_eq!(kind.to_string().parse(), Ok(kind));
    }
    for text in ["", "periodic", "periodic 1", "periodic x:1", "sticking 1:x", "completed chatter 2:3", "resting 1:1"] {
        assert!(text.parse::<MotionKind>().is_err(), "{text}");
    }
}
