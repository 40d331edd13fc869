//! Equivalent viscous damping by half cycles of the base acceleration: bases with and without damping, motion that dies
//! away, arrays of light dampers whose contact states have nearly equal eigenvalues.

use shotdamp::dynamics::{
    Drive, HalfCycles, HybridSystem, Matrix, Options, Response, Spline, TraceRequest, event_driven, fixed_step,
};
use shotdamp::scene::{CompileError, ContactDamping, ContactEnd, Damper, Excitation, Scene, Surface, compile};

use super::arrays::{Dice, beam, blows, chain, cycles, particle, shape, spring};
use super::bench::{base, within};

/// One mass of 1 kg on 1000 N/m with dampers of any size, and a curve that falls or grows.
pub(super) fn on_one_mass(dice: &mut Dice, damping_ratio: f64, dampers: usize) -> HybridSystem {
    let mut system = chain(&[1.0], 500.0, damping_ratio * 1000.0_f64.sqrt());
    for _ in 0..dampers {
        let law = spring(dice.ratio(1e2, 1e5), 0.0);
        system.particles.push(particle(dice.ratio(0.005, 0.3), dice.ratio(1e-3, 0.5), vec![1.0], [law, law]));
    }
    let curve = [[0.0, dice.ratio(0.2, 20.0)], [dice.ratio(0.3, 10.0), dice.ratio(0.2, 20.0)]];
    renewed(&mut system, &curve);
    system
}

/// By a curve over accelerations in g.
fn renewed(system: &mut HybridSystem, curve: &[[f64; 2]]) {
    let curve: Vec<[f64; 2]> = curve.iter().map(|[x, damping]| [x * system.gravity, *damping]).collect();
    let base =
        system.particles.first().map_or_else(|| system.observed_rows[0].clone(), |first| first.floor.row.clone());
    system.drive.half_cycles = Some(HalfCycles { curve: Spline::through(&curve).expect("a curve"), base });
}

/// Under impulses, with the curve that it has.
fn strike(system: &mut HybridSystem, period: f64, impulse: f64) {
    system.drive = Drive { half_cycles: system.drive.half_cycles.take(), ..blows(period, impulse) };
}

fn settled(what: &str, system: &HybridSystem, options: &Options) -> Response {
    let response = event_driven(system, options).unwrap_or_else(|error| panic!("{what}: {error}"));
    let proof = response.proof;
    assert!(proof.momentum_residual < 1e-11 && proof.energy_residual < 1e-11, "{what}: {proof:?}");
    response
}

#[test]
pub(super) fn a_base_without_damping_counts_its_half_cycles() {
    let mut system = chain(&[1.0], 500.0, 0.0);
    let law = spring(1000.0, 0.0);
    system.particles.push(particle(0.05, 0.49, vec![1.0], [law, law]));
    system.drive = blows(0.2, 0.1);
    renewed(&mut system, &[[0.0, 2.0], [10.0, 0.5]]);
    settled("the plain one", &system, &cycles(125));
    for seed in 0..60 {
        let mut dice = Dice(seed);
        let mut system = on_one_mass(&mut dice, 0.0, 1 + seed as usize % 3);
        strike(&mut system, dice.between(0.05, 0.5), dice.ratio(0.02, 3.0));
        settled(&format!("seed {seed}"), &system, &cycles(30));
    }
}

/// Where a structure is looked at changes nothing of what it does.
#[test]
fn the_damping_does_not_depend_on_the_point_that_is_observed() {
    let mut system = beam(3, 20.0, 0.02);
    let law = spring(2000.0, 0.0);
    system.particles.push(particle(0.05, 0.02, shape(3, 0.9), [law, law]));
    system.drive = blows(0.3, 0.5);
    renewed(&mut system, &[[0.1, 1.0], [5.0, 8.0]]);
    for solver in [
        |system: &HybridSystem| event_driven(system, &cycles(20)),
        |system: &HybridSystem| fixed_step(system, &cycles(20), 1e-4),
    ] {
        let ends = [0.3, 0.9].map(|x| {
            system.observed_rows = vec![shape(3, x)];
            solver(&system).expect("the scene has an answer").final_particles
        });
        assert_eq!(ends[0], ends[1]);
    }
}

#[test]
pub(super) fn half_cycles_end_where_motion_has_died_away() {
    for seed in 0..40 {
        let mut dice = Dice(seed);
        let damping_ratio = dice.ratio(0.03, 3.0);
        let mut system = on_one_mass(&mut dice, damping_ratio, 1 + seed as usize % 3);
        let spline = system.drive.half_cycles.as_ref().expect("it has a curve").curve.clone();
        let lowest = spline.lower_end()[1];
        // Once, or again after a pause.
        let period = if seed % 2 == 0 { 100.0 } else { dice.between(40.0, 100.0) };
        strike(&mut system, period, dice.ratio(0.02, 3.0));
        system.drive.repeats = seed % 2 == 1;
        let trace = Some(TraceRequest { from_cycle: 1, to_cycle: 2, samples: 20 });
        let end = settled(&format!("seed {seed}"), &system, &Options { trace, ..cycles(2) });
        let last = end.trace.last().expect("it was sampled");
        // The last half cycle that was counted still moved a little, and the curve may rise from its lower end at once. Beyond critical
        // damping the last one has no end.
        let expected = if damping_ratio < 1.0 { lowest } else { spline.at(last.half_cycle_rms) };
        let off = (last.damping / lowest - 1.0).abs().min((last.damping / expected - 1.0).abs());
        assert!(off < 1e-6, "seed {seed}: {} for no motion, {lowest}", last.damping);
        assert!(last.velocity.abs() < 1e-13 && last.acceleration.abs() < 1e-12, "seed {seed}: {last:?}");
    }
}

#[test]
pub(super) fn arrays_of_equal_light_dampers_have_contact_states_of_any_order() {
    // The last ones came to contact states of order 14 to 24 that an ordinary iteration for the Schur form does not end on.
    for seed in (0..20).chain([80, 86, 187, 243, 282, 465, 573, 703, 840, 977, 1181, 1436]) {
        let mut dice = Dice(seed);
        dice.between(0.0, 1.0);
        let modes = 1 + dice.between(0.0, 7.99) as usize;
        let damping = if dice.chance(0.3) { 0.0 } else { dice.between(0.0, 0.05) };
        let mut system = beam(modes, dice.between(10.0, 60.0), damping);
        if dice.chance(0.5) {
            let own: Vec<f64> = (0..modes).map(|i| 2.0 * damping * system.stiffness.at(i, i).sqrt()).collect();
            system.damping = Matrix::diagonal(&own);
        }
        let count = 1 + dice.between(0.0, 5.99) as usize;
        let alike = dice.chance(0.5);
        let any = |dice: &mut Dice| [dice.ratio(1e-4, 0.1), dice.ratio(1e2, 1e6), dice.ratio(1e-4, 0.5)];
        let all = any(&mut dice);
        for i in 0..count {
            let even = dice.chance(0.5);
            let place = if even { (i + 1) as f64 / (count + 1) as f64 } else { dice.between(0.05, 0.95) };
            let [mass, stiffness, gap] = if alike { all } else { any(&mut dice) };
            let law = spring(stiffness, 0.0);
            system.particles.push(particle(mass, gap, shape(modes, place), [law, law]));
        }
        let [first, last] = [dice.ratio(0.1, 50.0), dice.ratio(0.1, 50.0)];
        let curve = [[0.0, first], [dice.ratio(1.0, 30.0), last]];
        system.drive = blows(dice.between(0.05, 0.4), dice.ratio(0.01, 1.0) * (modes as f64).sqrt());
        renewed(&mut system, &curve);
        settled(&format!("seed {seed}"), &system, &cycles(3));
    }
}

#[test]
pub(super) fn no_array_is_refused_and_all_balance_whatever_their_order() {
    // Contact states of order 8 to 40; curves through four and five points of 4 to 12 N s/m.
    for seed in 0..400 {
        let mut dice = Dice(1_000_000 + seed);
        let (modes, count) = (2 + dice.between(0.0, 8.99) as usize, 2 + dice.between(0.0, 8.99) as usize);
        let mut system = beam(modes, dice.ratio(10.0, 200.0), dice.between(0.0, 0.05));
        let alike = dice.chance(0.5);
        let any = |dice: &mut Dice| [dice.ratio(1e-3, 0.1), dice.ratio(3e2, 1e5), dice.ratio(1e-4, 0.1)];
        let all = any(&mut dice);
        for i in 0..count {
            let place = if alike { (i + 1) as f64 / (count + 1) as f64 } else { dice.between(0.05, 0.95) };
            let [mass, stiffness, gap] = if alike { all } else { any(&mut dice) };
            let law = spring(stiffness, 0.0);
            system.particles.push(particle(mass, gap, shape(modes, place), [law, law]));
        }
        let points = if dice.chance(0.5) { 4 } else { 5 };
        let curve: Vec<[f64; 2]> = (0..points).map(|i| [0.2 + 2.0 * f64::from(i), dice.ratio(4.0, 12.0)]).collect();
        system.drive = blows(dice.between(0.03, 0.1), dice.ratio(0.03, 1.0) * (modes as f64).sqrt());
        renewed(&mut system, &curve);
        let what = format!("seed {seed}, {modes} modes, {count} dampers");
        let end = event_driven(&system, &cycles(2)).unwrap_or_else(|error| panic!("{what}: {error}"));
        let balance = end.proof.momentum_residual.max(end.proof.energy_residual);
        assert!(balance < 1e-9, "{what}: {:?}", end.proof);
    }
}

#[test]
fn a_curve_through_three_points_is_their_parabola() {
    let parabola = |x: f64| (x - 1.0) * (x - 1.0);
    let curve = Spline::through(&[0.0, 1.0, 3.0].map(|x| [x, parabola(x)])).expect("a curve");
    for x in [0.2, 0.9, 1.7, 2.5] {
        assert!((curve.at(x) - parabola(x)).abs() < 1e-14, "{x}");
    }
    assert_eq!(Spline::through(&[[1.0, 0.0], [1.0, 2.0]]), None);
}

#[test]
fn a_curve_is_read_in_g_also_where_nothing_has_weight() {
    let points = vec![[0.5, 1.0], [5.0, 2.0]];
    let floor = Surface::Resilient {
        stiffness: 1000.0,
        damping: ContactDamping::EquivalentViscous(points),
        ends: ContactEnd::ZeroGap,
    };
    let curve = |gravity: f64| {
        let dampers = vec![Damper::between(floor.clone(), 0.05, 0.1)];
        let excitation = Excitation::ImpulseTrain { impulse: 0.1, period: 0.2 };
        let system = compile(&Scene::on_one_mass(base(1.0, 500.0, 0.1), gravity, dampers, excitation));
        system.expect("it compiles").drive.half_cycles.expect("it has a curve").curve
    };
    assert_eq!(curve(9.81).lower_end(), [0.5 * 9.81, 1.0]);
    assert_eq!(curve(0.0).lower_end(), [0.5 * 9.80665, 1.0]);
}

#[test]
fn all_dampers_go_by_one_damping_curve_or_the_scene_is_refused() {
    let surface = |damping| Surface::Resilient { stiffness: 1000.0, damping, ends: ContactEnd::ZeroGap };
    let curve = |low: f64| surface(ContactDamping::EquivalentViscous(vec![[0.5, low], [5.0, 2.0]]));
    let (constant, rigid) = (surface(ContactDamping::Constant(1.0)), Surface::Rigid { restitution: 0.5 });
    let scene = |dampers: Vec<Damper>| {
        let excitation = Excitation::ImpulseTrain { impulse: 0.1, period: 0.2 };
        compile(&Scene::on_one_mass(base(1.0, 500.0, 0.1), 9.81, dampers, excitation))
    };
    let of = |floors: [&Surface; 2]| scene(floors.map(|floor| Damper::between(floor.clone(), 0.05, 0.1)).to_vec());
    let (low, high) = (curve(1.0), curve(1.5));
    for accepted in [[&low, &low], [&rigid, &low], [&low, &rigid]] {
        assert!(of(accepted).is_ok_and(|system| system.drive.half_cycles.is_some()), "{accepted:?}");
    }
    for several in [[&low, &high], [&high, &low]] {
        assert_eq!(of(several).err(), Some(CompileError::SeveralCurves));
    }
    for mixed in [[&low, &constant], [&constant, &low]] {
        assert_eq!(of(mixed).err(), Some(CompileError::MixedDamping));
    }
    let two = Damper { ceiling: high, ..Damper::between(low, 0.05, 0.1) };
    assert_eq!(scene(vec![two]).err(), Some(CompileError::SeveralCurves));
}

/// RMS velocity by steps in which no block turns further than `turn`, over that of the exact motion.
fn stepped_over(own: &Response, system: &HybridSystem, count: u32, turn: f64) -> f64 {
    let steps = (system.drive.period * own.highest_frequency / turn).ceil();
    let options = Options { audit: false, ..cycles(count) };
    let stepped = fixed_step(system, &options, system.drive.period / steps).expect("it runs");
    stepped.window().rms_velocity() / own.window().rms_velocity()
}

#[test]
fn a_dashpot_that_throws_the_acceleration_back_begins_no_half_cycle_but_its_own() {
    // Taken for one, such a moment set the dashpots to the curve's lower end; small steps pass over most of them, and agree only if
    // none counts.
    let mut compared = 0;
    for seed in 0..60 {
        let mut dice = Dice(seed);
        let mut system = on_one_mass(&mut dice, 0.01, 1);
        strike(&mut system, dice.between(0.05, 0.5), dice.ratio(0.02, 3.0));
        let own = settled(&format!("seed {seed}"), &system, &cycles(4));
        if own.proof.events > 50 {
            // Steps that small do not follow it so far.
            continue;
        }
        compared += 1;
        within(&format!("seed {seed}, RMS velocity"), stepped_over(&own, &system, 4, 0.002), 1.0, 0.003);
    }
    assert!(compared > 40, "{compared}");
}

#[test]
fn a_landing_that_turns_the_acceleration_ends_one_half_cycle_if_the_new_dashpot_throws_it_back() {
    // Two of them, the second of next to no RMS, make the RMS velocity 0.9e-3 smaller.
    let mut system = chain(&[0.401], 900.0, 0.02 * (0.401_f64 * 900.0).sqrt());
    system.particles.push(particle(0.0564, 0.026_69, vec![1.0], [spring(618.0, 0.0); 2]));
    renewed(&mut system, &[[0.7, 1.0], [2.0, 3.0], [3.5, 4.2], [5.0, 3.5], [7.6, 2.0]]);
    strike(&mut system, 0.856_58, 0.1896);
    let own = settled("a landing", &system, &cycles(2));
    within("RMS velocity", stepped_over(&own, &system, 2, 2e-4), 1.0, 3e-4);
}
