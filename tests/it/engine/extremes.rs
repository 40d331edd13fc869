//! Parameters at the ends of what they can be: limits known in closed form, and everything between by the solver of many
//! digits.

use std::f64::consts::TAU;

use shotdamp::dynamics::{HybridSystem, Method, Options, Response, Tick, event_driven};
use shotdamp::scene::{Excitation, Scene, Walls};

use super::arrays::{Dice, chain, particle, quiet, spring};
use super::bench::{GRAVITY, agree, base, close, damper, resilient, rigid, scene, system, within};

const STIFFNESS: f64 = 1000.0;

fn damping() -> f64 {
    0.1 * STIFFNESS.sqrt()
}

fn train(impulse: f64, period: f64) -> Excitation {
    Excitation::ImpulseTrain { impulse, period }
}

fn short(cycles: u32) -> Options {
    Options { skip: 0, average: cycles, ..Options::default() }
}

fn run(scene: &Scene, options: &Options) -> Response {
    event_driven(&system(scene), options).expect("the scene runs")
}

#[test]
pub(super) fn a_floor_swept_through_critical_damping_has_no_seam() {
    // Pressed down it is critical where cf² = 4 kf μ with the particle's mass alone: on a base that does not move.
    let mass = 0.05;
    let critical = 2.0 * (STIFFNESS * mass).sqrt();
    let ends: Vec<[f64; 2]> = [-1e-3, -1e-6, -1e-9, -1e-12, -1e-15, 0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3]
        .into_iter()
        .map(|off| {
            let surface = resilient(STIFFNESS, critical * (1.0 + off));
            let heavy = base(1e9, 1e12, 0.0);
            let struck = scene(heavy, GRAVITY, damper(mass, 0.05, surface), train(1e9, 0.2));
            let end = agree(&format!("cf {off:e} off critical"), &system(&struck), &short(3), 1e-10);
            end.final_particles[0]
        })
        .collect();
    // Smooth: the halves of the sweep meet.
    for i in 1..5 {
        for ((below, above), at) in ends[i].iter().zip(&ends[10 - i]).zip(&ends[5]) {
            within("the middle of both sides", 0.5 * (below + above), *at, 1e-9);
        }
    }
    // The same for two degrees of freedom, whose floor becomes critical somewhere on the way.
    for step in 0..40 {
        let zeta = 0.9 + 0.005 * f64::from(step);
        let surface = resilient(STIFFNESS, zeta * critical);
        let struck = scene(base(1.0, STIFFNESS, damping()), GRAVITY, damper(mass, 0.05, surface), train(1.0, 0.2));
        agree(&format!("ζf = {zeta}"), &system(&struck), &short(3), 1e-10);
    }
}

#[test]
pub(super) fn modes_that_coalesce_are_no_special_case() {
    // On a base without damping, with kf = mp (ω/(1 + μ))² and ζf² = μ/(1 + μ), the two pairs of eigenvalues of the pressed
    // state are one (Krenk, J. Appl. Mech. 72, 2005): it has no eigenbasis.
    let mass = 0.05_f64;
    let omega = STIFFNESS.sqrt() / (1.0 + mass);
    let (stiffness, damping) = (mass * omega * omega, 2.0 * (mass / (1.0 + mass)).sqrt() * mass * omega);
    let ends: Vec<[f64; 2]> = [-1e-2, -1e-4, -1e-8, -1e-12, 0.0, 1e-12, 1e-8, 1e-4, 1e-2]
        .into_iter()
        .map(|off| {
            let surface = resilient(stiffness, damping * (1.0 + off));
            let struck = scene(base(1.0, STIFFNESS, 0.0), GRAVITY, damper(mass, 0.05, surface), train(0.3, 0.21));
            let end = agree(&format!("cf {off:e} off coalescence"), &system(&struck), &short(6), 1e-10);
            end.final_particles[0]
        })
        .collect();
    for i in 1..4 {
        for ((below, above), at) in ends[i].iter().zip(&ends[8 - i]).zip(&ends[4]) {
            within("the middle of both sides", 0.5 * (below + above), *at, 1e-6);
        }
    }
}

#[test]
pub(super) fn stiff_walls_make_model_3_model_2() {
    // Under a smooth force: an impulse would leave the ceiling ringing however stiff its walls.
    let omega = 25.0;
    let drive = Excitation::Harmonic { force: 60.0, angular_frequency: omega };
    let shaker = damper(0.05, 0.02, resilient(STIFFNESS, 4.0));
    let both = scene(base(1.0, STIFFNESS, damping()), GRAVITY, shaker.clone(), drive.clone());
    let limit = run(&both, &short(6));
    let off: Vec<f64> = [1e5, 1e6, 1e7, 1e8, 1e9]
        .into_iter()
        .map(|stiffness| {
            let mut walled = shaker.clone();
            // A tenth of critical.
            let ceiling_mass = 0.05;
            let damping = 0.2 * f64::sqrt(stiffness * ceiling_mass);
            walled.walls = Some(Walls { stiffness, damping, ceiling_mass });
            let third = scene(base(1.0, STIFFNESS, self::damping()), GRAVITY, walled, drive.clone());
            let end = run(&third, &short(6));
            (end.window().rms_velocity() / limit.window().rms_velocity() - 1.0).abs()
        })
        .collect();
    // Ten times stiffer, ten times closer, down to the rounding of forces of 1e9 N/m.
    for pair in off[..4].windows(2) {
        close("ten times stiffer walls", pair[0] / pair[1], 10.0, 0.1);
    }
    within("kw = 1e9 N/m", off[4], 0.0, 1e-7);
}

#[test]
pub(super) fn impulses_without_pause_are_a_constant_force() {
    // J = F T with T to zero, for half a second, until when the particle has flown and landed.
    let (force, time) = (40.0, 0.5);
    let shaker = || damper(0.05, 0.05, resilient(STIFFNESS, 4.0));
    let mut pushed = system(&scene(base(1.0, STIFFNESS, damping()), GRAVITY, shaker(), train(0.0, time)));
    pushed.drive =
        shotdamp::dynamics::Drive { ticks: vec![Tick { time: 0.0, impulse: 0.0, level: force }], ..quiet(time) };
    let limit = agree("constant force", &pushed, &short(1), 1e-12);
    assert!(limit.proof.events > 3, "{} events", limit.proof.events);
    let off: Vec<f64> = [1000_u32, 10_000, 100_000]
        .into_iter()
        .map(|count| {
            let period = time / f64::from(count);
            let mut beaten =
                system(&scene(base(1.0, STIFFNESS, damping()), GRAVITY, shaker(), train(force * period, period)));
            beaten.drive.period = period;
            let end = event_driven(&beaten, &short(count)).expect("it runs");
            end.final_particles[0][0] - limit.final_particles[0][0]
        })
        .collect();
    close("ten times as many", off[1] / off[2], 10.0, 0.1);
    // Without the term of first order, two orders go at a time.
    let rest = [0, 1].map(|i| (10.0 * off[i + 1] - off[i]) / 9.0);
    close("ten times as many, extrapolated", rest[0] / rest[1], 100.0, 0.2);
    within("a million impulses, extrapolated", rest[1], 0.0, 1e-8);
}

#[test]
pub(super) fn long_pauses_leave_one_free_decay_each() {
    // Between impulses everything dies down to denormals and to zero; each decay spends what its impulse brought.
    let impulse = 2.0;
    for period in [1e2, 1e3, 1e5] {
        let (mass, damping) = (1.0, damping());
        let clean = Scene {
            dampers: Vec::new(),
            ..scene(base(mass, STIFFNESS, damping), GRAVITY, damper(0.05, 0.4905, rigid(0.0)), train(impulse, period))
        };
        let window = run(&clean, &short(4)).window();
        // ∫ c v² dt = J²/2m.
        close("clean, ∫ v² dt", window.velocity_square, 4.0 * impulse * impulse / (2.0 * mass * damping), 1e-12);
        for surface in [rigid(0.0), resilient(STIFFNESS, 4.0)] {
            let damped =
                scene(base(mass, STIFFNESS, damping), GRAVITY, damper(0.05, 0.4905, surface), train(impulse, period));
            let options = Options { audit: true, ..short(4) };
            let first = run(&damped, &Options { average: 1, ..options.clone() });
            let all = run(&damped, &options);
            within("momentum", all.proof.momentum_residual, 0.0, 1e-11);
            within("energy", all.proof.energy_residual, 0.0, 1e-11);
            close(
                "the fourth decay is the first",
                all.window().velocity_square,
                4.0 * first.window().velocity_square,
                1e-11,
            );
            // What is left of the last one.
            let left = (-damping / (2.0 * mass) * period * 0.5).exp();
            within("at rest", all.final_velocity, 0.0, 10.0 * left);
        }
    }
}

#[test]
pub(super) fn nothing_is_too_light_too_heavy_too_wide_or_too_strong() {
    let natural = STIFFNESS.sqrt();
    let gaps = [0.0, 1e-9, 0.4905, f64::INFINITY];
    for mass_ratio in [1e-9, 1e-3, 1.0, 1e3] {
        for gap in gaps {
            for force_ratio in [1e-6, 1e-1, 1e2, 1e6] {
                let impulse = force_ratio * GRAVITY / natural;
                // Tuned to the structure, so that its own time does not shrink with its mass.
                let floor = resilient(STIFFNESS * mass_ratio, 0.6 * mass_ratio * STIFFNESS.sqrt());
                let surfaces = [("resilient", floor), ("plastic", rigid(0.0))];
                for (name, surface) in surfaces.into_iter().filter(|(name, _)| gap > 0.0 || *name == "resilient") {
                    let shaken = scene(
                        base(1.0, STIFFNESS, damping()),
                        GRAVITY,
                        damper(mass_ratio, gap, surface),
                        train(impulse, TAU / natural),
                    );
                    let what = format!("{name}, mp/m = {mass_ratio:e}, h = {gap:e} m, f′ = {force_ratio:e}");
                    agree(&what, &system(&shaken), &short(4), 1e-11);
                }
            }
        }
    }
    // Closed forms at the ends: no mass does nothing, and what never lets go is a heavier structure.
    let clean = Scene {
        dampers: Vec::new(),
        ..scene(base(1.0, STIFFNESS, damping()), GRAVITY, damper(1.0, 1.0, rigid(0.0)), train(3.0, 0.2))
    };
    let bare = run(&clean, &Options::default()).window().rms_velocity();
    let light = scene(
        base(1.0, STIFFNESS, damping()),
        GRAVITY,
        damper(1e-9, f64::INFINITY, resilient(1e-6, 1e-9)),
        train(3.0, 0.2),
    );
    close("mp/m = 1e-9", run(&light, &Options::default()).window().rms_velocity(), bare, 1e-7);
}

#[test]
pub(super) fn a_floor_is_no_dearer_for_being_stiffer() {
    // Events, not seconds: what a contact costs does not depend on how short it is.
    let natural = STIFFNESS.sqrt();
    let events = |ratio: f64| {
        let stiffness = ratio * STIFFNESS;
        let floor = resilient(stiffness, 0.6 * (stiffness * 0.05).sqrt());
        let shaken = scene(
            base(1.0, STIFFNESS, damping()),
            GRAVITY,
            damper(0.05, 0.4905, floor),
            train(10.0 * GRAVITY / natural, 0.199),
        );
        agree(&format!("kf/ks = {ratio:e}"), &system(&shaken), &short(3), 1e-10).proof.events
    };
    let (stiff, stiffest) = (events(1e3), events(1e6));
    for ratio in [1e-3, 1e-1, 1.0, 10.0] {
        events(ratio);
    }
    assert!(stiffest <= 2 * stiff, "{stiff} events at 1e3, {stiffest} at 1e6");
}

#[test]
pub(super) fn dashpots_that_tie_all_modes_together_are_no_harder() {
    for seed in 0..10 {
        let mut dice = Dice(900 + seed);
        let n = 2 + (seed % 4) as usize;
        let masses: Vec<f64> = (0..n).map(|_| dice.between(0.5, 2.0)).collect();
        let mut shaken: HybridSystem = chain(&masses, 1000.0, 0.0);
        // As strong as the springs: some modes creep, some swing, none is a mode of the undamped structure.
        for _ in 0..2 {
            let row: Vec<f64> = (0..n).map(|_| dice.between(-1.0, 1.0)).collect();
            let strength = dice.ratio(3.0, 300.0);
            for i in 0..n {
                for j in 0..n {
                    shaken.damping.entries[i * n + j] += strength * row[i] * row[j];
                }
            }
        }
        for _ in 0..2 {
            let row: Vec<f64> = (0..n).map(|_| dice.between(-1.0, 1.0)).collect();
            let laws = [spring(dice.ratio(300.0, 1e4), dice.between(0.0, 10.0)), spring(1000.0, 1.0)];
            shaken.particles.push(particle(dice.between(0.02, 0.3), dice.between(0.005, 0.05), row, laws));
        }
        shaken.drive = super::arrays::blows(0.15, dice.between(0.5, 4.0));
        let end = agree(&format!("seed {seed}"), &shaken, &short(8), 1e-10);
        assert!(end.proof.events > 0 || end.method == Method::ClosedForm);
    }
}
