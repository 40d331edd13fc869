//! Runs without events: the closed form held against the simulation of the same run, and against textbook formulas.

use std::f64::consts::TAU;

use shotdamp::dynamics::{
    Drive, Face, Harmonic, HybridSystem, Law, Matrix, Method, Options, Particle, Response, Stop, Tick, TraceRequest,
    event_driven, lift_off, steady_state,
};

use super::bench::{GRAVITY, close, within};

/// Numbers between 0 and 1, the same on every machine.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.roll()
    }

    fn row(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.between(-2.0, 2.0)).collect()
    }
}

/// A beam in modal coordinates: frequencies that grow with the square of their number, damping by stiffness and mass, an
/// enclosure that couples them, particles on soft floors.
fn beam(dice: &mut Dice, modes: usize, particles: usize, drive: Drive) -> HybridSystem {
    let first = dice.between(15.0, 40.0);
    let rayleigh = dice.between(2e-5, 2e-3);
    let mut mass = Matrix::diagonal(&vec![1.0; modes]);
    let squares: Vec<f64> = (1..=modes).map(|i| (first * (i * i) as f64).powi(2)).collect();
    let stiffness = Matrix::diagonal(&squares);
    let damping = Matrix::diagonal(&squares.iter().map(|square| rayleigh * (1.0 + square)).collect::<Vec<_>>());
    let mut on_board = Vec::new();
    for _ in 0..particles {
        let row = dice.row(modes);
        for i in 0..modes {
            for j in 0..modes {
                mass.entries[i * modes + j] += 0.03 * row[i] * row[j];
            }
        }
        let particle = dice.between(0.02, 0.1);
        let tuned = particle * (first * dice.between(0.7, 4.0)).powi(2);
        let law = Law::Resilient {
            stiffness: tuned,
            damping: 2.0 * dice.between(0.005, 1.4) * (tuned * particle).sqrt(),
            no_tension: dice.roll() < 0.3,
            stop: (dice.roll() < 0.3).then_some(Stop { length: 2.0 * particle * GRAVITY / tuned, restitution: 0.0 }),
        };
        let face = Face { row, law };
        on_board.push(Particle { mass: particle, floor: face.clone(), ceiling: Some(face), gap: 0.05 });
    }
    let momentum = dice.row(modes);
    HybridSystem {
        mass,
        damping,
        stiffness,
        gravity: GRAVITY,
        particles: on_board,
        force_row: dice.row(modes),
        drive,
        observed_rows: vec![dice.row(modes), dice.row(modes), dice.row(modes)],
        momentum_rows: vec![momentum],
    }
}

fn drive(period: f64, ticks: Vec<Tick>) -> Drive {
    Drive { period, ticks, repeats: true, harmonic: None, half_cycles: None }
}

fn impulses(period: f64, impulse: f64) -> Drive {
    drive(period, vec![Tick { time: 0.0, impulse, level: 0.0 }])
}

fn pulses(period: f64, force: f64) -> Drive {
    let on = Tick { time: 0.0, impulse: 0.0, level: force };
    drive(period, vec![on, Tick { time: 0.3 * period, impulse: 0.0, level: 0.0 }])
}

fn harmonic(angular_frequency: f64, force: f64) -> Drive {
    let ticks = vec![Tick { time: 0.0, impulse: 0.0, level: 0.0 }];
    Drive { harmonic: Some(Harmonic { force, angular_frequency, phase: 0.0 }), ..drive(TAU / angular_frequency, ticks) }
}

fn everything() -> Options {
    Options { audit: true, extremes: true, cycle_rates: true, ..Options::default() }
}

/// A time history is kept by the simulation alone, and a motion is named with all surfaces in sight: else the smallest margin is no larger
/// than that by which a bound keeps some of them out of reach.
fn simulated(system: &HybridSystem, options: &Options) -> Response {
    let trace = Some(TraceRequest { from_cycle: 0, to_cycle: 1, samples: 1 });
    let response =
        event_driven(system, &Options { trace, motion: true, ..options.clone() }).expect("it can be simulated");
    assert_eq!(response.method, Method::Simulated);
    response
}

fn solved(system: &HybridSystem, options: &Options) -> Response {
    event_driven(system, options).expect("it can be solved")
}

/// Largest of the differences, relative to what is compared.
fn difference(a: &Response, b: &Response) -> f64 {
    let mut worst = 0.0_f64;
    let mut take = |a: f64, b: f64, scale: f64| worst = worst.max((a - b).abs() / scale);
    for (a, b) in a.observed.iter().zip(&b.observed) {
        for (a, b) in a.halves.iter().zip(&b.halves) {
            take(a.duration, b.duration, b.duration);
            take(a.velocity_square, b.velocity_square, b.velocity_square);
            // Beside the whole motion, the place it is about included.
            let square = b.deviation_square + b.displacement * b.displacement / b.duration;
            take(a.deviation_square, b.deviation_square, square);
            take(a.displacement, b.displacement, (square * b.duration).sqrt());
        }
        for (a, b) in [(a.extremes.displacement, b.extremes.displacement), (a.extremes.velocity, b.extremes.velocity)] {
            // Beside the rest under gravity, which may be many times the motion.
            let scale = (b[1] - b[0]).max(b[0].abs()).max(b[1].abs());
            take(a[0], b[0], scale);
            take(a[1], b[1], scale);
        }
    }
    let rates = b.cycle_rates.iter().flat_map(|cycle| cycle.after.iter().chain(&cycle.before));
    let size = rates.fold(0.0_f64, |largest, x| largest.max(x.abs()));
    for (a, b) in a.cycle_rates.iter().zip(&b.cycle_rates) {
        for (a, b) in [(&a.after, &b.after), (&a.before, &b.before)] {
            a.iter().zip(b).for_each(|(a, b)| take(*a, *b, size));
        }
    }
    assert_eq!(a.cycle_rates.len(), b.cycle_rates.len());
    worst
}

#[test]
pub(super) fn a_clean_structure_is_what_its_simulation_says() {
    let mut dice = Dice(9);
    for trial in 0..40 {
        let period = dice.between(0.05, 0.4);
        let force = match trial % 3 {
            0 => impulses(period, 0.3),
            1 => pulses(period, 2.0),
            _ => harmonic(TAU / period, 3.0),
        };
        let modes = 1 + trial % 5;
        let system = beam(&mut dice, modes, 0, force);
        let closed = solved(&system, &everything());
        assert_eq!(closed.method, Method::ClosedForm);
        let error = difference(&closed, &simulated(&system, &everything()));
        assert!(error < 1e-12, "trial {trial}: {error:.1e} of {modes} modes");
        let proof = closed.proof;
        assert!(proof.momentum_residual < 1e-12 && proof.energy_residual < 1e-12, "trial {trial}: {proof:?}");
    }
}

#[test]
pub(super) fn particles_that_never_leave_need_no_simulation() {
    let mut dice = Dice(4);
    let (mut linear, mut worst) = (0, 0.0_f64);
    for trial in 0..60 {
        let period = dice.between(0.05, 0.4);
        // Motions far below the rest under gravity lose digits to it in the simulation.
        let size = 10.0_f64.powf(dice.between(-2.0, 0.0));
        let force = match trial % 3 {
            0 => impulses(period, 0.3 * size),
            1 => pulses(period, 2.0 * size),
            _ => harmonic(TAU / period, 3.0 * size),
        };
        let system = beam(&mut dice, 1 + trial % 4, 1 + trial % 3, force);
        let closed = solved(&system, &everything());
        let simulated = simulated(&system, &everything());
        if closed.method == Method::ClosedForm {
            linear += 1;
            assert_eq!(simulated.proof.events, 0, "trial {trial}: a particle left after all");
            let (bound, margin) = (closed.proof.smallest_margin, simulated.proof.smallest_margin);
            assert!(bound <= margin * (1.0 + 1e-9), "trial {trial}: {bound} is no bound on {margin}");
            let error = difference(&closed, &simulated);
            worst = worst.max(error);
            assert!(error < 1e-12, "trial {trial}: {error:.1e}");
            let proof = closed.proof;
            assert!(proof.momentum_residual < 1e-12 && proof.energy_residual < 1e-12, "trial {trial}: {proof:?}");
        } else if simulated.proof.events == 0 {
            println!("trial {trial}: quiet, but not proved to be, margin {}", simulated.proof.smallest_margin);
        }
    }
    println!("{linear} of 60 linear, worst difference {worst:.1e}");
    assert!(linear >= 25, "only {linear} of 60 were proved");
}

/// The lift-off force of a particle on a rigid floor is where the loaded base reaches g.
#[test]
pub(super) fn a_particle_on_a_rigid_floor_rests_while_the_base_stays_below_g() {
    let (mass, stiffness, particle) = (1.0, 1000.0, 0.05);
    let damping = 2.0 * 0.05 * f64::sqrt(stiffness * mass);
    let omega = f64::sqrt(stiffness / mass);
    let lift_off =
        GRAVITY / (omega * omega) * f64::hypot(stiffness - (mass + particle) * omega * omega, damping * omega);
    let system = |share: f64| {
        let law = Law::Rigid { restitution: 0.0 };
        let floor = Face { row: vec![1.0], law };
        HybridSystem {
            mass: Matrix::diagonal(&[mass]),
            damping: Matrix::diagonal(&[damping]),
            stiffness: Matrix::diagonal(&[stiffness]),
            gravity: GRAVITY,
            particles: vec![Particle { mass: particle, floor, ceiling: None, gap: 0.0 }],
            force_row: vec![1.0],
            drive: harmonic(omega, share * lift_off),
            observed_rows: vec![vec![1.0]],
            momentum_rows: vec![vec![1.0]],
        }
    };
    let run = |share: f64| solved(&system(share), &Options { skip: 200, ..everything() });
    let half = run(0.5);
    // The start from rest beats against the force: together they stay below the bound up to about half of it.
    assert_eq!(run(0.45).method, Method::ClosedForm);
    assert_eq!(half.proof.events, 0);
    // On the steady orbit it is decided to the sixth digit.
    assert!(steady_state(&system(0.999_999)).expect("it has one").is_some());
    assert!(steady_state(&system(1.000_001)).expect("it has one").is_none());
    close("RMS velocity at half of it", half.window().rms_velocity(), 0.109_679_134_296_364_684_608_87, 1e-12);
    close("standard deviation", half.window().std_displacement(), 0.003_468_358_761_720_015_607, 1e-12);
    close("mean", half.window().mean_displacement(), -0.000_490_5, 1e-12);
}

#[test]
pub(super) fn a_train_of_impulses_is_a_geometric_series() {
    let one = |period: f64, impulse: f64| HybridSystem {
        mass: Matrix::diagonal(&[1.0]),
        damping: Matrix::diagonal(&[2.0 * 0.05 * f64::sqrt(1000.0)]),
        stiffness: Matrix::diagonal(&[1000.0]),
        gravity: GRAVITY,
        particles: Vec::new(),
        force_row: vec![1.0],
        drive: impulses(period, impulse),
        observed_rows: vec![vec![1.0]],
        momentum_rows: vec![vec![1.0]],
    };
    // A million cycles cost no more than a hundred, and no digit.
    for average in [100, 1_000_000] {
        let steady = solved(&one(0.05, 0.2), &Options { skip: 600, average, audit: true, ..Options::default() });
        let window = steady.window();
        close("RMS velocity", window.rms_velocity(), 0.060_302_393_085_166_268_144, 1e-12);
        close("standard deviation", window.std_displacement(), 0.000_396_242_397_234_536_084, 1e-11);
        close("mean", window.mean_displacement(), 0.004, 1e-12);
        close("before an impulse", steady.final_displacement, 0.003_130_157_356_392_065_834, 1e-12);
        close("its velocity", steady.final_velocity, -0.097_125_190_287_999_342_588, 1e-12);
    }
    let steady = steady_state(&one(0.05, 0.2)).expect("it has one").expect("it is linear");
    close("steady RMS velocity", steady.observed[0].cycle.rms_velocity(), 0.060_302_393_085_166_268_144, 1e-13);
    close("steady deviation", steady.observed[0].cycle.std_displacement(), 0.000_396_242_397_234_536_084, 1e-11);
    let jump = 0.2;
    let highest = -0.097_125_190_287_999_342_588 + jump;
    close("highest velocity", steady.observed[0].extremes.velocity[1], highest, 1e-12);
    let rare = solved(&one(100.0, 1.0), &Options { skip: 1, average: 5, ..Options::default() });
    close("one free decay", rare.window().rms_velocity(), 0.039_763_536_438_352_533_259, 1e-12);
}

#[test]
pub(super) fn an_undamped_structure_at_its_own_frequency_swings_up_without_bound() {
    let omega = 20.0;
    let system = HybridSystem {
        mass: Matrix::diagonal(&[1.0]),
        damping: Matrix::diagonal(&[0.0]),
        stiffness: Matrix::diagonal(&[omega * omega]),
        gravity: GRAVITY,
        particles: Vec::new(),
        force_row: vec![1.0],
        drive: impulses(TAU / omega, 0.1),
        observed_rows: vec![vec![1.0]],
        momentum_rows: vec![vec![1.0]],
    };
    let response = solved(&system, &Options { extremes: true, audit: true, ..Options::default() });
    // v = n J after the n-th impulse, for one period each: Σ n²/2 over the window.
    let mean: f64 = (26..=125).map(|n| 0.5 * f64::from(n * n) * 0.01).sum::<f64>() / 100.0;
    close("RMS velocity", response.window().rms_velocity(), mean.sqrt(), 1e-12);
    close("highest velocity", response.observed[0].extremes.velocity[1], 12.5, 1e-12);
    within("balance", response.proof.energy_residual, 0.0, 1e-12);
}

#[test]
pub(super) fn a_harmonic_response_is_the_inverse_of_the_dynamic_stiffness() {
    let mut dice = Dice(31);
    for _ in 0..20 {
        let omega = dice.between(10.0, 300.0);
        let system = beam(&mut dice, 3, 0, harmonic(omega, 2.0));
        // (K − ω²M + iωC) a = b F, by elimination on complex numbers; the beam without particles is diagonal.
        let mut answer = [0.0; 2];
        for i in 0..3 {
            let (re, im) =
                (system.stiffness.at(i, i) - omega * omega * system.mass.at(i, i), omega * system.damping.at(i, i));
            let force = 2.0 * system.force_row[i] * system.observed_rows[0][i] / (re * re + im * im);
            answer = [answer[0] + force * re, answer[1] - force * im];
        }
        let amplitude = answer[0].hypot(answer[1]);
        let steady = steady_state(&system).expect("it has one").expect("it is linear");
        let [low, high] = steady.observed[0].extremes.displacement;
        close("amplitude", 0.5 * (high - low), amplitude, 1e-12);
        let rms = omega * amplitude / f64::sqrt(2.0);
        close("RMS velocity", steady.observed[0].cycle.rms_velocity(), rms, 1e-12);
        // Once its transients are gone, the run is there too.
        let cycles = (40.0 / (0.5 * 2e-5 * 225.0) * omega / TAU) as u32;
        let response = solved(&system, &Options { skip: cycles, average: 1, ..Options::default() });
        close("RMS velocity of a run", response.window().rms_velocity(), rms, 1e-11);
    }
}

#[test]
fn lift_off_is_where_the_loaded_mass_falls_with_gravity_and_where_a_soft_floor_is_no_longer_compressed() {
    let one = |ratio: f64, particle: f64, law: Law| HybridSystem {
        mass: Matrix::diagonal(&[1.0]),
        damping: Matrix::diagonal(&[0.1 * f64::sqrt(1000.0)]),
        stiffness: Matrix::diagonal(&[1000.0]),
        gravity: GRAVITY,
        particles: vec![Particle { mass: particle, floor: Face { row: vec![1.0], law }, ceiling: None, gap: 0.0 }],
        force_row: vec![1.0],
        drive: harmonic(ratio * f64::sqrt(1000.0), 0.7),
        observed_rows: vec![vec![1.0]],
        momentum_rows: vec![vec![1.0]],
    };
    let force = |system: &HybridSystem| 0.7 * lift_off(system).expect("it is linear").expect("it lifts off");
    for (ratio, particle) in [(0.7, 0.3), (1.0, 0.05), (1.8, 0.0)] {
        let omega = ratio * f64::sqrt(1000.0);
        let stiffness = f64::hypot(1000.0 - (1.0 + particle) * omega * omega, 0.1 * f64::sqrt(1000.0) * omega);
        let rigid = one(ratio, particle, Law::Rigid { restitution: 0.4 });
        close("rigid floor", force(&rigid), GRAVITY / (omega * omega) * stiffness, 1e-12);
    }
    // A particle on a spring and a dashpot, as an absorber: its stretch r = ω² x/(κ² − ω² + iγω), the force on the mass mp (κ² + iγω) r.
    for (ratio, kappa, gamma) in [(0.8, 60.0, 3.0), (1.1, 25.0, 10.0)] {
        let (particle, omega) = (0.1, ratio * f64::sqrt(1000.0));
        let law = Law::Resilient {
            stiffness: particle * kappa * kappa,
            damping: particle * gamma,
            no_tension: false,
            stop: None,
        };
        // F/r, from F = (k − ω² + icω) x − mp (κ² + iγω) r.
        let own = [1000.0 - omega * omega, 0.1 * f64::sqrt(1000.0) * omega];
        let relative = [(kappa * kappa - omega * omega) / (omega * omega), gamma / omega];
        let re = own[0] * relative[0] - own[1] * relative[1] - particle * kappa * kappa;
        let im = own[0] * relative[1] + own[1] * relative[0] - particle * gamma * omega;
        close("soft floor", force(&one(ratio, particle, law)), GRAVITY / (kappa * kappa) * re.hypot(im), 1e-12);
    }
}

#[test]
fn below_lift_off_no_particle_of_an_array_leaves_and_above_it_one_does() {
    let mut dice = Dice(77);
    for i in 0..12 {
        let omega = dice.between(20.0, 90.0);
        let drive = |strength: f64| match i % 2 {
            0 => harmonic(omega, strength),
            _ => impulses(TAU / omega, strength),
        };
        let mut system = beam(&mut dice, 3, 1 + i % 3, drive(0.01));
        let threshold = 0.01 * lift_off(&system).expect("it is linear").expect("it lifts off");
        for (share, rests) in [(1.0 - 1e-6, true), (1.0 + 1e-6, false)] {
            system.drive = drive(share * threshold);
            assert_eq!(steady_state(&system).expect("it has one").is_some(), rests, "{i}: {share}");
        }
    }
    // Rigid floors throw their particles off under any impulse.
    let floor = Face { row: vec![1.0, 0.5], law: Law::Rigid { restitution: 0.4 } };
    let mut system = beam(&mut dice, 2, 1, impulses(0.1, 0.01));
    system.particles[0].floor = floor;
    assert_eq!(lift_off(&system).expect("it is refused"), None);
}
