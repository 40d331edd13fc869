//! Stops and ceilings that a bound on the energy keeps out of a run: the run is the same without them, and what acts is never
//! among them.

use shotdamp::dynamics::{
    Contact, EventKind, Face, FarSurface, HybridSystem, Law, Matrix, Method, Options, Particle, Placed, Response,
    StartState, Stop, TraceRequest, event_driven, out_of_reach,
};
use shotdamp::scene::compile;

use super::arrays::{blows, chain, cycles, particle, quiet, spring, unit};
use super::bench::GRAVITY;
use super::drawn_scenes::any_drawn_scene;

/// A run whose time history keeps every surface and all events.
fn with_all(options: &Options) -> Options {
    let to_cycle = u64::from(options.skip) + u64::from(options.average);
    Options { trace: Some(TraceRequest { from_cycle: 0, to_cycle, samples: 1 }), ..options.clone() }
}

fn acts(response: &Response, particle: usize, surface: FarSurface) -> bool {
    let kind = match surface {
        FarSurface::Ceiling => EventKind::CeilingContact,
        FarSurface::FloorStop => EventKind::FloorStop,
        FarSurface::CeilingStop => EventKind::CeilingStop,
    };
    response.events.iter().any(|event| event.particle == particle && event.kind == kind)
}

#[test]
pub(super) fn drawn_scenes_are_the_same_without_what_is_out_of_reach() {
    let (mut idle, mut acting) = ([0; 3], [0; 3]);
    for seed in 0..300 {
        for farther in [1.0, 30.0, 1e3] {
            let mut scene = any_drawn_scene(seed);
            for damper in &mut scene.dampers {
                damper.gap *= farther;
                damper.stop.iter_mut().for_each(|stop| stop.length *= farther);
            }
            let system = compile(&scene).expect("it compiles");
            let options = Options { start: scene.start_state(), record_events: 0, average: 2, ..cycles(2) };
            let far = out_of_reach(&system, &options);
            let Ok(kept) = event_driven(&system, &with_all(&options)) else { continue };
            for (j, particle) in system.particles.iter().enumerate() {
                let stop = |law: Law| matches!(law, Law::Resilient { stop: Some(_), .. });
                let ceiling = particle.ceiling.as_ref();
                for (surface, there) in [
                    (FarSurface::Ceiling, ceiling.is_some()),
                    (FarSurface::FloorStop, stop(particle.floor.law)),
                    (FarSurface::CeilingStop, ceiling.is_some_and(|face| stop(face.law))),
                ] {
                    let is_far = far.iter().any(|far| far.particle == j && far.surface == surface);
                    let at_work = there && acts(&kept, j, surface);
                    assert!(!(is_far && at_work), "seed {seed} × {farther}: {far:?}");
                    idle[surface as usize] += u32::from(is_far);
                    acting[surface as usize] += u32::from(at_work);
                }
            }
            if far.is_empty() {
                continue;
            }
            let less = event_driven(&system, &options).expect("it runs as with all");
            if less.method == Method::ClosedForm {
                continue;
            }
            assert_eq!(less.counts, kept.counts, "seed {seed} × {farther}");
            let sums = |of: &Response| of.observed.iter().map(|observed| observed.halves).collect::<Vec<_>>();
            assert_eq!(sums(&less), sums(&kept), "seed {seed} × {farther}");
            assert_eq!(less.final_particles, kept.final_particles, "seed {seed} × {farther}");
            assert_eq!([less.proof.events, less.proof.ties], [kept.proof.events, kept.proof.ties], "seed {seed}");
            let [sharp, margin] = [kept.proof.smallest_margin, less.proof.smallest_margin];
            let off = if margin == sharp { 0.0 } else { (margin / sharp - 1.0).abs() };
            assert!(off < 0.01, "seed {seed} × {farther}: margin {margin} instead of {sharp}");
        }
    }
    assert!(idle.iter().chain(&acting).all(|count| *count > 20), "out of reach {idle:?}, acting {acting:?}");
}

/// A particle of 10 g on a body that nothing moves, thrown from its floor at `speed`.
fn thrown(speed: f64, gap: f64, stop: Option<Stop>) -> (HybridSystem, Options) {
    let mut system = chain(&[1e12], 1e12, 0.0);
    let law = Law::Resilient { stiffness: 100.0, damping: 0.0, no_tension: false, stop };
    system.particles.push(particle(0.01, gap, vec![1.0], [law, law]));
    system.drive = quiet(1.0);
    let sag = 0.01 * system.gravity / system.stiffness.at(0, 0);
    let start =
        StartState::Given { q: vec![-sag], rate: vec![0.0], particles: vec![Placed::new(Contact::Flight, 0.0, speed)] };
    (system, Options { start, ..cycles(2) })
}

#[test]
pub(super) fn a_lone_particle_comes_as_far_as_the_bound() {
    // u₀ = 0 and v: c = mg/k + √((mg/k)² + m v²/k) into the floor, and v²/2g above it, where the bound adds mg/2k.
    let (weight, stiffness, speed) = (0.01 * 9.81, 100.0, 2.0_f64);
    let sunk: f64 = weight / stiffness;
    let deepest = sunk + sunk.hypot(speed * (0.01_f64 / stiffness).sqrt());
    let highest = speed * speed / (2.0 * 9.81) + 0.5 * sunk;
    for (share, reached) in [(0.99, true), (1.001, false)] {
        let stop = Some(Stop { length: share * deepest, restitution: 0.5 });
        let (system, options) = thrown(-speed, 10.0, stop);
        let surfaces: Vec<FarSurface> = out_of_reach(&system, &options).iter().map(|far| far.surface).collect();
        assert_eq!(surfaces.contains(&FarSurface::FloorStop), !reached, "{surfaces:?}");
        let stops = event_driven(&system, &options).expect("it runs").counts.stops;
        assert_eq!(stops > 0, reached, "a stop at {share} of the way");

        let gap = share * highest;
        let (system, options) = thrown(speed, gap, None);
        let surfaces: Vec<FarSurface> = out_of_reach(&system, &options).iter().map(|far| far.surface).collect();
        assert_eq!(surfaces.contains(&FarSurface::Ceiling), !reached, "{surfaces:?}");
        let contacts = event_driven(&system, &options).expect("it runs").counts.ceiling_contacts;
        assert_eq!(contacts > 0, reached, "a ceiling at {share} of the way");
    }
}

#[test]
pub(super) fn without_weight_no_height_is_out_of_reach() {
    // Also where a sign is left of nothing: −0.
    let (mut system, options) = thrown(1.0, 10.0, None);
    for gravity in [0.0, -0.0] {
        system.gravity = gravity;
        assert!(out_of_reach(&system, &options).is_empty(), "{gravity:?}");
    }
}

#[test]
fn a_run_that_cannot_reach_a_ceiling_leaves_nothing_behind_for_one_that_does() {
    // Two dampers on a base, each below a ceiling that moves by itself; the second one's is out of reach of the weak blows.
    let system = |impulse: f64| {
        let face = |i: usize| Face { row: unit(3, i), law: spring(1000.0, 1.0) };
        let below = |(wall, gap)| Particle { mass: 0.5, floor: face(0), ceiling: Some(face(wall)), gap };
        HybridSystem {
            mass: Matrix::diagonal(&[1.0, 0.2, 0.2]),
            damping: Matrix::diagonal(&[3.0, 0.5, 0.5]),
            stiffness: Matrix::diagonal(&[1000.0, 300.0, 400.0]),
            particles: [(1, 0.002), (2, 2.0)].map(below).to_vec(),
            force_row: unit(3, 0),
            drive: blows(0.2, impulse),
            observed_rows: vec![unit(3, 0)],
            momentum_rows: vec![vec![1.0; 3]],
            gravity: GRAVITY,
        }
    };
    let (weak, strong, options) = (system(0.5), system(20.0), cycles(8));
    assert_eq!(out_of_reach(&weak, &options).len(), 1);
    let run = |system: &HybridSystem| event_driven(system, &options).expect("it runs");
    let alone = std::thread::scope(|scope| scope.spawn(|| run(&strong)).join().expect("it runs"));
    assert!(acts(&alone, 1, FarSurface::Ceiling));
    run(&weak);
    // Compared as text: what was not looked for is NaN.
    assert_eq!(format!("{:?}", run(&strong)), format!("{alone:?}"));
}
