//! Several dampers on one structure: chains and beams whose faces move with rows of their own.
//!
//! The references are a Runge-Kutta integration of the absolute coordinates, which knows no contact state, runs that are
//! turned back in time, symmetry, and what must not depend on how a scene is written down.

use std::f64::consts::PI;

use shotdamp::dynamics::{
    Contact, Drive, Event, EventKind, Face, HybridSystem, Law, Matrix, Options, Particle, Placed, Response, StartState,
    Stop, Tick, TraceRequest, event_driven,
};

use super::bench::{GRAVITY, note, within};

/// Random numbers, the same in every run.
pub(super) struct Dice(pub(super) u64);

impl Dice {
    /// In [low, high].
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }

    pub(super) fn ratio(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    pub(super) fn chance(&mut self, p: f64) -> bool {
        self.between(0.0, 1.0) < p
    }
}

/// Masses in a row between two walls, each tied to the next.
pub(super) fn chain(masses: &[f64], stiffness: f64, damping: f64) -> HybridSystem {
    let n = masses.len();
    let mut springs = Matrix::diagonal(&vec![2.0; n]);
    for i in 1..n {
        springs.entries[i * n + i - 1] = -1.0;
        springs.entries[(i - 1) * n + i] = -1.0;
    }
    let scaled = |factor: f64| Matrix { order: n, entries: springs.entries.iter().map(|x| factor * x).collect() };
    HybridSystem {
        mass: Matrix::diagonal(masses),
        damping: scaled(damping),
        stiffness: scaled(stiffness),
        gravity: GRAVITY,
        particles: Vec::new(),
        force_row: unit(n, n - 1),
        drive: quiet(0.2),
        observed_rows: vec![unit(n, 0)],
        momentum_rows: vec![vec![1.0; n]],
    }
}

/// A supported beam of unit length and `n` modes, with damping that ties them to each other.
pub(super) fn beam(n: usize, first: f64, damping: f64) -> HybridSystem {
    let square: Vec<f64> = (1..=n).map(|i| (first * (i * i) as f64).powi(2)).collect();
    let dashpot = shape(n, 0.37);
    let mut damped = Matrix::diagonal(&square.iter().map(|square| damping * square / first).collect::<Vec<_>>());
    for i in 0..n {
        for j in 0..n {
            damped.entries[i * n + j] += damping * first * dashpot[i] * dashpot[j];
        }
    }
    HybridSystem {
        mass: Matrix::diagonal(&vec![1.0; n]),
        damping: damped,
        stiffness: Matrix::diagonal(&square),
        gravity: GRAVITY,
        particles: Vec::new(),
        force_row: shape(n, 0.41),
        drive: quiet(0.2),
        observed_rows: vec![shape(n, 0.5)],
        momentum_rows: (0..n).map(|i| unit(n, i)).collect(),
    }
}

pub(super) fn shape(n: usize, place: f64) -> Vec<f64> {
    (1..=n).map(|i| 2.0_f64.sqrt() * (i as f64 * PI * place).sin()).collect()
}

pub(super) fn unit(n: usize, i: usize) -> Vec<f64> {
    (0..n).map(|k| if k == i { 1.0 } else { 0.0 }).collect()
}

pub(super) fn quiet(period: f64) -> Drive {
    let ticks = vec![Tick { time: 0.0, impulse: 0.0, level: 0.0 }];
    Drive { period, ticks, repeats: true, harmonic: None, half_cycles: None }
}

pub(super) fn blows(period: f64, impulse: f64) -> Drive {
    Drive { ticks: vec![Tick { time: 0.0, impulse, level: 0.0 }], ..quiet(period) }
}

pub(super) fn particle(mass: f64, gap: f64, row: Vec<f64>, laws: [Law; 2]) -> Particle {
    let [floor, ceiling] = laws.map(|law| Face { row: row.clone(), law });
    Particle { mass, floor, ceiling: Some(ceiling), gap }
}

pub(super) fn spring(stiffness: f64, damping: f64) -> Law {
    Law::Resilient { stiffness, damping, no_tension: false, stop: None }
}

pub(super) fn rigid(restitution: f64) -> Law {
    Law::Rigid { restitution }
}

/// Floor and ceiling of any kind, each with its own numbers.
pub(super) fn any_law(dice: &mut Dice) -> Law {
    if dice.chance(0.5) {
        let restitution = dice.between(0.0, 0.95);
        return rigid(if dice.chance(0.3) { 0.0 } else { restitution });
    }
    let stop = dice.chance(0.3).then(|| Stop { length: dice.ratio(1e-3, 1e-1), restitution: dice.between(0.0, 0.9) });
    let no_tension = dice.chance(0.4);
    Law::Resilient { stiffness: dice.ratio(1e2, 1e6), damping: dice.between(0.0, 6.0), no_tension, stop }
}

pub(super) fn any_structure(dice: &mut Dice) -> HybridSystem {
    let n = 1 + dice.between(0.0, 4.99) as usize;
    if dice.chance(0.5) {
        let masses: Vec<f64> = (0..n).map(|_| dice.between(0.3, 2.0)).collect();
        chain(&masses, dice.ratio(300.0, 3000.0), dice.between(0.0, 3.0))
    } else {
        beam(n, dice.between(10.0, 60.0), dice.between(0.0, 0.05))
    }
}

/// A random scene with dampers of any kind.
pub(super) fn any_scene(seed: u64) -> HybridSystem {
    let mut dice = Dice(seed);
    let mut system = any_structure(&mut dice);
    let n = system.mass.order;
    let is_chain = system.momentum_rows.len() == 1 && n > 1;
    for _ in 0..1 + dice.between(0.0, 5.99) as usize {
        let row = if is_chain {
            unit(n, dice.between(0.0, n as f64 - 1e-9) as usize)
        } else {
            shape(n, dice.between(0.05, 0.95))
        };
        let gap = if dice.chance(0.1) { 0.0 } else { dice.ratio(1e-4, 0.5) };
        let laws = [any_law(&mut dice), any_law(&mut dice)];
        system.particles.push(particle(dice.ratio(1e-3, 0.5), gap, row, laws));
    }
    system.drive = blows(dice.between(0.05, 0.4), dice.ratio(0.03, 3.0));
    system
}

pub(super) fn go(system: &HybridSystem, options: &Options) -> Response {
    let response = event_driven(system, options).unwrap_or_else(|error| panic!("{error}: {system:?}"));
    if options.audit {
        assert!(response.events.iter().all(|event| event.time.is_finite()));
        note("momentum residual", response.proof.momentum_residual, 1e-11);
        note("energy residual", response.proof.energy_residual, 1e-10);
        // Thousands of impacts pass at a millionth of the speed that the energy came with.
        assert!(response.proof.momentum_residual < 1e-11, "momentum residual {:e}", response.proof.momentum_residual);
        assert!(response.proof.energy_residual < 1e-10, "energy residual {:e}", response.proof.energy_residual);
    }
    response
}

pub(super) fn cycles(count: u32) -> Options {
    Options { skip: 0, average: count, audit: true, record_events: usize::MAX, ..Options::default() }
}

/// q and q′ at the end of a run; a system shows one displacement at a time.
pub(super) fn structure_after(system: &HybridSystem, options: &Options) -> [Vec<f64>; 2] {
    let n = system.mass.order;
    let seen = |i: usize| go(&HybridSystem { observed_rows: vec![unit(n, i)], ..system.clone() }, options);
    let ends: Vec<Response> = (0..n).map(seen).collect();
    [ends.iter().map(|end| end.final_displacement).collect(), ends.iter().map(|end| end.final_velocity).collect()]
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The largest deviation of two ends: of the observed motion and of every particle.
pub(super) fn apart(a: &Response, b: &Response) -> f64 {
    let ends = |end: &Response| {
        let particles = end.final_particles.iter().flatten().copied();
        [end.final_displacement, end.final_velocity].into_iter().chain(particles).collect::<Vec<_>>()
    };
    ends(a).iter().zip(ends(b)).fold(0.0, |most, (x, y)| most.max((x - y).abs()))
}

/// Absolute coordinates (q, y) and their rates under springs and dashpots of the faces: no contact state, no event.
pub(super) struct Plain<'a> {
    system: &'a HybridSystem,
    inverse: Vec<f64>,
}

impl<'a> Plain<'a> {
    /// For a diagonal mass matrix.
    pub(super) fn new(system: &'a HybridSystem) -> Self {
        Self { system, inverse: (0..system.mass.order).map(|i| 1.0 / system.mass.at(i, i)).collect() }
    }

    fn slope(&self, z: &[f64]) -> Vec<f64> {
        let (n, p) = (self.system.mass.order, self.system.particles.len());
        let (q, y, v, w) = (&z[..n], &z[n..n + p], &z[n + p..2 * n + p], &z[2 * n + p..]);
        let (held, damped) = (self.system.stiffness.times(q), self.system.damping.times(v));
        let mut force: Vec<f64> = held.iter().zip(&damped).map(|(k, c)| -k - c).collect();
        let mut falls = vec![-self.system.gravity; p];
        for (j, particle) in self.system.particles.iter().enumerate() {
            let ceiling = particle.ceiling.as_ref().expect("a ceiling");
            for (face, offset, away) in [(&particle.floor, 0.0, 1.0), (ceiling, particle.gap, -1.0)] {
                let u = y[j] - dot(&face.row, q) - offset;
                if let Law::Resilient { stiffness, damping, no_tension, .. } = face.law
                    && away * u < 0.0
                {
                    let push = -stiffness * u - damping * (w[j] - dot(&face.row, v));
                    if no_tension && away * push < 0.0 {
                        continue;
                    }
                    falls[j] += push / particle.mass;
                    force.iter_mut().zip(&face.row).for_each(|(force, phi)| *force -= phi * push);
                }
            }
        }
        let accelerations = force.iter().zip(&self.inverse).map(|(force, inverse)| force * inverse);
        v.iter().chain(w).copied().chain(accelerations).chain(falls).collect()
    }

    /// Which faces push: where this changes within a step, the step is halved until it is negligible.
    fn touched(&self, z: &[f64]) -> Vec<bool> {
        let (n, p) = (self.system.mass.order, self.system.particles.len());
        let push = |(j, particle): (usize, &Particle)| {
            let ceiling = particle.ceiling.as_ref().expect("a ceiling");
            [(&particle.floor, 0.0, 1.0), (ceiling, particle.gap, -1.0)].map(|(face, offset, away)| {
                let u = away * (z[n + j] - dot(&face.row, &z[..n]) - offset);
                let rate = away * (z[2 * n + p + j] - dot(&face.row, &z[n + p..2 * n + p]));
                match face.law {
                    Law::Resilient { stiffness, damping, no_tension: true, .. } => {
                        u < 0.0 && stiffness * u + damping * rate < 0.0
                    }
                    _ => u < 0.0,
                }
            })
        };
        self.system.particles.iter().enumerate().flat_map(push).collect()
    }

    fn step(&self, z: &[f64], h: f64) -> Vec<f64> {
        let moved = |k: &[f64], h: f64| z.iter().zip(k).map(|(z, k)| z + h * k).collect::<Vec<_>>();
        let k1 = self.slope(z);
        let k2 = self.slope(&moved(&k1, 0.5 * h));
        let k3 = self.slope(&moved(&k2, 0.5 * h));
        let k4 = self.slope(&moved(&k3, h));
        (0..z.len()).map(|i| z[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])).collect()
    }

    pub(super) fn advance(&self, z: &[f64], h: f64) -> Vec<f64> {
        let next = self.step(z, h);
        if h > 1e-12 && self.touched(z) != self.touched(&next) {
            return self.advance(&self.advance(z, 0.5 * h), 0.5 * h);
        }
        next
    }
}

#[test]
pub(super) fn springs_of_floors_and_ceilings_push_as_a_runge_kutta_integration_says() {
    let mut events = 0;
    for seed in 0..12 {
        let mut dice = Dice(seed);
        let mut system = any_structure(&mut dice);
        let n = system.mass.order;
        for _ in 0..1 + seed % 4 {
            let row: Vec<f64> = (0..n).map(|_| dice.between(-1.0, 1.0)).collect();
            let mut law = || spring(dice.ratio(300.0, 1e4), dice.between(0.0, 3.0));
            let laws = [law(), law()];
            system.particles.push(particle(dice.between(0.05, 0.3), dice.between(0.01, 0.1), row, laws));
        }
        system.drive = quiet(0.3);
        let q: Vec<f64> = (0..n).map(|_| dice.between(-0.02, 0.02)).collect();
        let rate: Vec<f64> = (0..n).map(|_| dice.between(-2.0, 2.0)).collect();
        let gaps: Vec<f64> = system.particles.iter().map(|particle| particle.gap * dice.between(0.1, 0.9)).collect();
        let particles = gaps.iter().map(|gap| Placed::new(Contact::Flight, *gap, 0.0)).collect();
        let start = StartState::Given { q: q.clone(), rate: rate.clone(), particles };
        let options = Options { start, ..cycles(1) };
        let response = go(&system, &options);
        events += response.proof.events;

        let plain = Plain::new(&system);
        let floor = |row: &[f64], x: &[f64]| dot(row, x);
        let y = system.particles.iter().zip(&gaps).map(|(particle, gap)| floor(&particle.floor.row, &q) + gap);
        let w = system.particles.iter().map(|particle| floor(&particle.floor.row, &rate));
        let mut z: Vec<f64> = q.iter().copied().chain(y).chain(rate.iter().copied()).chain(w).collect();
        let steps = 6000;
        for _ in 0..steps {
            z = plain.advance(&z, 0.3 / f64::from(steps));
        }
        let p = system.particles.len();
        for (j, [y, w]) in response.final_particles.iter().enumerate() {
            within(&format!("seed {seed}, y of {j}"), *y, z[n + j], 1e-8);
            within(&format!("seed {seed}, y′ of {j}"), *w, z[2 * n + p + j], 1e-6);
        }
        within(&format!("seed {seed}, x"), response.final_displacement, dot(&system.observed_rows[0], &z[..n]), 1e-8);
    }
    assert!(events > 60, "{events} events");
}

#[test]
pub(super) fn an_array_without_loss_runs_back_to_its_start() {
    for seed in 0..20 {
        let mut dice = Dice(100 + seed);
        let mut system = any_structure(&mut dice);
        let n = system.mass.order;
        system.damping = Matrix::diagonal(&vec![0.0; n]);
        let count = 1 + (seed % 4) as usize;
        for _ in 0..count {
            let row: Vec<f64> = (0..n).map(|_| dice.between(-1.0, 1.0)).collect();
            let mut law = || if dice.chance(0.5) { rigid(1.0) } else { spring(dice.ratio(1e3, 1e5), 0.0) };
            let laws = [law(), law()];
            system.particles.push(particle(dice.between(0.01, 0.2), dice.between(0.005, 0.1), row, laws));
        }
        system.drive = quiet(0.15);
        let q: Vec<f64> = (0..n).map(|_| dice.between(-0.02, 0.02)).collect();
        let rate: Vec<f64> = (0..n).map(|_| dice.between(-1.0, 1.0)).collect();
        let begin: Vec<_> =
            system.particles.iter().map(|particle| Placed::new(Contact::Flight, 0.5 * particle.gap, 0.3)).collect();
        let start = StartState::Given { q: q.clone(), rate: rate.clone(), particles: begin.clone() };
        let forwards = Options { start, ..cycles(1) };
        let there = go(&system, &forwards);
        let [q_end, rate_end] = structure_after(&system, &forwards);
        let turned: Vec<f64> = rate_end.iter().map(|rate| -rate).collect();
        let particles = system
            .particles
            .iter()
            .zip(&there.final_particles)
            .map(|(particle, [y, w])| {
                let (u, du) = (y - dot(&particle.floor.row, &q_end), w - dot(&particle.floor.row, &rate_end));
                match (particle.floor.law, u) {
                    (Law::Resilient { .. }, ..0.0) => Placed::new(Contact::Floor, u, -du),
                    _ if u > particle.gap => Placed::new(Contact::Ceiling, u - particle.gap, -du),
                    _ => Placed::new(Contact::Flight, u, -du),
                }
            })
            .collect();
        let backwards = Options { start: StartState::Given { q: q_end, rate: turned, particles }, ..cycles(1) };
        let back = go(&system, &backwards);
        let [q_back, rate_back] = structure_after(&system, &backwards);
        // Each impact passes the error on, enlarged; so does the way back.
        let bound = 1e-13 * 3_f64.powi(there.proof.events.min(15) as i32);
        for i in 0..n {
            within(&format!("seed {seed}, q {i}"), q_back[i], q[i], bound);
            within(&format!("seed {seed}, rate {i}"), rate_back[i], -rate[i], 100.0 * bound);
        }
        assert_eq!(back.proof.events, there.proof.events);
    }
}

#[test]
pub(super) fn no_damper_comes_before_another() {
    for seed in 0..60 {
        let mut system = any_scene(seed);
        let options = cycles(2);
        let response = go(&system, &options);
        let kicked = go(&system, &Options { kick: 1e-12, ..options.clone() });
        system.particles.reverse();
        let mut turned = go(&system, &options);
        turned.final_particles.reverse();
        // As much as an impulse known to twelve digits would move it.
        let moved = apart(&response, &kicked);
        within(&format!("seed {seed}"), apart(&response, &turned), 0.0, 1e-12 + 3.0 * moved);
    }
}

const KINDS: [EventKind; 6] = [
    EventKind::FloorContact,
    EventKind::FloorRelease,
    EventKind::CeilingContact,
    EventKind::CeilingRelease,
    EventKind::FloorStop,
    EventKind::CeilingStop,
];

#[test]
pub(super) fn a_run_is_the_same_in_one_cycle_or_in_many() {
    for seed in 0..60 {
        let mut system = any_scene(1000 + seed);
        let period = system.drive.period;
        system.drive = Drive { repeats: false, ..system.drive };
        let whole = go(&system, &cycles(1));
        let kicked = go(&system, &Options { kick: 1e-12, ..cycles(1) });
        system.drive.period = period / 64.0;
        let parts = go(&system, &cycles(64));
        for j in 0..system.particles.len() {
            // Slower bounces, of several particles on one structure, are chaotic among themselves: a thousandth of them is
            // known before they end.
            let met = |run: &Response, kind: EventKind| {
                let fast = |event: &&Event| event.particle == j && event.kind == kind && event.approach.abs() > 1e-6;
                run.events.iter().filter(fast).count()
            };
            for kind in KINDS {
                assert_eq!(met(&whole, kind), met(&parts, kind), "seed {seed}, particle {j}, {kind:?}");
            }
        }
        within(&format!("seed {seed}"), apart(&whole, &parts), 0.0, 1e-12 + 3.0 * apart(&whole, &kicked));
    }
}

#[test]
pub(super) fn momentum_and_energy_close_and_no_particle_is_beyond_its_face() {
    let mut kinds = [0_usize; 4];
    for seed in 0..120 {
        let system = any_scene(5000 + seed);
        let trace = TraceRequest { from_cycle: 0, to_cycle: 3, samples: 100 };
        let response = go(&system, &Options { trace: Some(trace), ..cycles(3) });
        for sample in &response.trace {
            assert_eq!(sample.particles.len(), system.particles.len());
            for (particle, at) in system.particles.iter().zip(&sample.particles) {
                let Particle { floor, ceiling: Some(ceiling), .. } = particle else { panic!("no ceiling") };
                let rigid = [floor, ceiling].map(|face| matches!(face.law, Law::Rigid { .. }));
                let depth = [at.rigid_floor - at.height, at.height - at.rigid_ceiling];
                let size = 1e-12 * (1.0 + at.height.abs());
                for (rigid, depth) in rigid.into_iter().zip(depth) {
                    assert!(!rigid || depth < size, "seed {seed}, {} s: {depth:e}", sample.time);
                }
            }
        }
        for (count, kind) in kinds.iter_mut().zip([
            EventKind::FloorContact,
            EventKind::CeilingContact,
            EventKind::ChatterEnd,
            EventKind::FloorStop,
        ]) {
            *count += response.events.iter().filter(|event| event.kind == kind).count();
        }
    }
    assert!(kinds.iter().all(|count| *count > 50), "{kinds:?}");
}

#[test]
pub(super) fn what_is_symmetric_stays_so() {
    // Two dampers of one kind at the ends of a chain that is struck in the middle: all their events come in pairs.
    let laws: [(&str, Law); 6] = [
        ("plastic", rigid(0.0)),
        ("bouncing", rigid(0.6)),
        ("elastic", rigid(1.0)),
        ("spring", spring(4000.0, 1.0)),
        ("pushing only", Law::Resilient { stiffness: 4000.0, damping: 5.0, no_tension: true, stop: None }),
        (
            "stop",
            Law::Resilient {
                stiffness: 500.0,
                damping: 1.0,
                no_tension: false,
                stop: Some(Stop { length: 0.005, restitution: 0.3 }),
            },
        ),
    ];
    for (name, law) in laws {
        let mut system = chain(&[1.0, 1.3, 1.0], 1000.0, 1.0);
        for i in [0, 2] {
            system.particles.push(particle(0.2, 0.03, unit(3, i), [law, law]));
        }
        system.force_row = unit(3, 1);
        system.drive = blows(0.21, 1.9);
        let response = go(&system, &cycles(10));
        assert!(response.proof.events > 20, "{name}");
        let [left, right] = [response.final_particles[0], response.final_particles[1]];
        for (a, b) in left.iter().zip(right) {
            within(name, *a, b, 1e-9);
        }
        let [q, _] = structure_after(&system, &cycles(10));
        within(name, q[0], q[2], 1e-9);
        for kind in [EventKind::FloorContact, EventKind::CeilingContact, EventKind::FloorRelease] {
            let of = |j: usize| response.events.iter().filter(|e| e.kind == kind && e.particle == j).count();
            assert_eq!(of(0), of(1), "{name}, {kind:?}");
        }
    }
}

#[test]
pub(super) fn two_particles_that_land_at_once_land_as_one_of_both_masses() {
    // On one mass, from the same height: a single particle of twice the mass does the same.
    for restitution in [0.0, 0.4, 1.0] {
        let mut system = chain(&[1.0], 500.0, 0.5);
        let law = rigid(restitution);
        let start = |count: usize| StartState::Given {
            q: vec![0.0],
            rate: vec![0.0],
            particles: vec![Placed::new(Contact::Flight, 0.02, 0.0); count],
        };
        system.particles = vec![particle(0.1, 0.05, vec![1.0], [law, law]); 2];
        let two = go(&system, &Options { start: start(2), ..cycles(3) });
        system.particles = vec![particle(0.2, 0.05, vec![1.0], [law, law])];
        let one = go(&system, &Options { start: start(1), ..cycles(3) });
        within("x", two.final_displacement, one.final_displacement, 1e-12);
        within("x′", two.final_velocity, one.final_velocity, 1e-11);
        let stuck = |end: &Response| end.events.iter().filter(|e| e.kind == EventKind::ChatterEnd).count();
        assert_eq!(stuck(&two), 2 * stuck(&one), "ε = {restitution}");
    }
}

/// A moment later, the second would meet a floor that the first has struck: another motion, however small that moment.
#[test]
pub(super) fn particles_that_land_at_once_on_a_rigid_floor_leave_no_margin() {
    let mut system = chain(&[1.0], 0.5, 0.0);
    (system.gravity, system.drive) = (1.0, quiet(1.2));
    system.particles = [1.0; 2].map(|mass| particle(mass, 100.0, unit(1, 0), [rigid(0.5); 2])).to_vec();
    let margin = |apart: f64| {
        let particles = [0.0, apart].map(|more| Placed::new(Contact::Flight, 0.5 + more, 0.0)).to_vec();
        let start = StartState::Given { q: vec![0.0], rate: vec![0.0], particles };
        event_driven(&system, &Options { start, ..cycles(1) }).unwrap().proof.smallest_margin
    };
    assert_eq!(margin(0.0), 0.0);
    assert!(margin(0.1) > 0.0);
}

#[test]
pub(super) fn a_blow_from_above_leaves_the_neighbour_that_loses_its_floor() {
    // A seesaw: two masses on a bar that turns about its middle. What lands on one side throws the other one up, or, where
    // both hang on one mass, leaves it behind.
    let seesaw = |rows: [f64; 2]| {
        let mut system = chain(&[1.0], 0.0, 0.0);
        system.stiffness = Matrix::diagonal(&[1000.0]);
        let law = rigid(0.0);
        system.particles = rows.map(|row| particle(0.1, 10.0, vec![row], [law, law])).to_vec();
        system.momentum_rows.clear();
        system.drive = quiet(0.01);
        // One lies at rest, carried by the spring; the other one is a nanosecond from landing.
        let start = StartState::Given {
            q: vec![-0.1 * GRAVITY * rows[0] / 1000.0],
            rate: vec![0.0],
            particles: vec![Placed::ON_FLOOR, Placed::new(Contact::Flight, 1e-9, -1.0)],
        };
        go(&system, &Options { start, ..cycles(1) })
    };
    let same_side = seesaw([1.0, 1.0]);
    let left = same_side.events.iter().find(|event| event.particle == 0).expect("it is left behind");
    assert_eq!(left.kind, EventKind::FloorRelease);
    // The floor gets away at 0.1 kg·1 m/s over 1.1 kg.
    within("how fast", left.departure, 0.1 / 1.1, 1e-6);
    let other_side = seesaw([1.0, -1.0]);
    assert!(!other_side.events.iter().any(|event| event.particle == 0), "it is carried along");
    within("how fast", other_side.final_velocity, 0.1 / 1.2, 2e-2);
}

#[test]
pub(super) fn particles_that_a_ceiling_lets_go_together_leave_together() {
    // Both lie at their ceilings, which push them by the same acceleration and let go at one instant.
    let scene = |masses: &[f64], gap: f64, impulse: f64, period: f64, damping: f64| {
        let mut system = chain(&[1.0], 500.0, 0.5 * damping);
        for mass in masses {
            system.particles.push(particle(*mass, gap, vec![1.0], [rigid(0.0); 2]));
        }
        system.drive = blows(period, impulse);
        system
    };
    let alike = |what: &str, system: &HybridSystem| {
        let options = cycles(60);
        let [one, other] = [1.0, 0.5].map(|window_factor| go(system, &Options { window_factor, ..options.clone() }));
        assert_eq!(one.proof.events, other.proof.events, "{what}: shorter windows find the same events");
        let creeps = |event: &&Event| event.approach != 0.0 && event.approach.abs() < 1e-20;
        assert!(!one.events.iter().any(|event| creeps(&event)), "{what}: a contact made of rounding");
    };
    alike("0.2 and 0.02 kg", &scene(&[0.2, 0.02], 5e-4, 0.5, 0.2, 3.0));
    for seed in 0..60 {
        let mut dice = Dice(seed);
        let masses: Vec<f64> = (0..2 + seed % 3).map(|_| dice.ratio(0.005, 0.3)).collect();
        let [gap, impulse, period] = [dice.ratio(3e-5, 3e-3), dice.ratio(0.1, 2.0), dice.between(0.05, 0.5)];
        alike(&format!("seed {seed}"), &scene(&masses, gap, impulse, period, dice.between(0.0, 6.0)));
    }
}

#[test]
fn what_a_blow_sets_off_does_not_depend_on_when_the_next_one_comes() {
    let mut dice = Dice(41);
    let mut closest = f64::INFINITY;
    for _ in 0..40 {
        let mut system = beam(1 + dice.between(0.0, 3.99) as usize, dice.between(20.0, 40.0), 0.02);
        let n = system.mass.order;
        for _ in 0..3 {
            let (mass, floor) = (dice.between(0.04, 0.06), spring(1000.0, dice.between(1.0, 4.0)));
            system.particles.push(particle(mass, 0.1, shape(n, dice.between(0.4, 0.6)), [floor, floor]));
        }
        let events = |period: f64| {
            let drive = blows(period, 0.5);
            let options = Options { record_events: 10_000, ..cycles(1) };
            let mut events = event_driven(&HybridSystem { drive, ..system.clone() }, &options).unwrap().events;
            events.retain(|event| event.time < 0.5);
            events
        };
        let [soon, late] = [1.0, 1e12].map(events);
        assert_eq!(soon.len(), late.len());
        for (soon, late) in soon.iter().zip(&late) {
            assert_eq!((soon.particle, soon.kind), (late.particle, late.kind), "at {} s", soon.time);
            assert!((soon.time - late.time).abs() < 1e-12);
        }
        closest = soon.windows(2).map(|pair| pair[1].time - pair[0].time).fold(closest, f64::min);
    }
    // In a cycle of 10¹² s a rounding is more than that.
    assert!(closest < 1e12 * f64::EPSILON, "{closest:e}");
}
