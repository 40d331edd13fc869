//! Measures say what they are called: of the particle that they name, at the points that count, and undefined where they have no meaning.

use shotdamp::experiment::{Assumptions, Experiment, load_assumptions, parse_experiment};
use shotdamp::measure::{ENSEMBLE_OF_A_VARIANT, Evaluated, Particles, Request, Rigour, SolverChoice, evaluate};
use shotdamp::yaml::Problems;

const BEAM: &str = "cantilever_beam: {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 200 GPa, density: 7800 kg/m^3, rayleigh: 5e-5, modes: 3}";
const MASS: &str = "single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}";
const FLOOR: &str = "{resilient: {stiffness_ratio: 1, damping_ratio: 0.1}}";
const IMPULSES: &str = "{impulse_train: {force_ratio: 4, frequency_ratio: 1}}";
const STEPS: SolverChoice = SolverChoice::FixedStep { time_step: 1e-5 };

fn assumptions() -> Assumptions {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/assumptions.yaml");
    load_assumptions(&file).unwrap_or_else(|problems| panic!("{problems}")).assumptions()
}

/// An experiment of a structure, the rest of its scene, and what follows the scene.
fn parse(structure: &str, scene: &str, rest: &str) -> Result<Experiment, Problems> {
    let text = format!(
        "title: Test\nsource: {{chapter: 4, section: '4.3'}}\nabout: A test.\nscene:\n  structure: {{{structure}}}\n{scene}\n{rest}\n\
         figure: {{x: momentum_residual, y: energy_residual, caption: None.}}\n"
    );
    parse_experiment(&"ch4-test".parse().unwrap(), "ch4-test.yaml", &text, &assumptions())
}

fn experiment(structure: &str, scene: &str, rest: &str) -> Experiment {
    parse(structure, scene, rest).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A mass with one damper, the faces of which are such, and what drives it.
fn on_mass(floor: &str, excitation: &str) -> String {
    format!("  dampers: [{{mass_ratio: 0.05, gap_ratio: 50, floor: {floor}}}]\n  excitation: {excitation}")
}

/// Evaluates the first case of an experiment.
fn evaluated(experiment: &Experiment, solver: SolverChoice) -> Evaluated {
    evaluated_as(Rigour::Result, experiment, solver)
}

fn evaluated_as(rigour: Rigour, experiment: &Experiment, solver: SolverChoice) -> Evaluated {
    let recipe = experiment.recipe_of(&experiment.cases[0]).unwrap();
    let Experiment { measures, trace, .. } = experiment;
    let request = Request { measures, trace: trace.as_ref(), rigour, ..Request::default() };
    let subject = recipe.subject(&assumptions(), request.needs()).unwrap();
    evaluate(subject, solver, &experiment.settings, &request).unwrap()
}

fn values(evaluated: &Evaluated) -> Vec<f64> {
    evaluated.measured.iter().map(|measured| measured.value).collect()
}

#[test]
fn the_height_of_a_particle_is_over_its_own_floor_whatever_point_is_observed() {
    let height = |observe: &str, gap: &str, impulse: &str, solver: SolverChoice| {
        let scene = format!(
            "  observe: {{points: [{observe}], take: largest}}\n  dampers: [{{at: 0.4, mass_ratio: 0.05, mass_reading: total, \
             particle_share: 0.5, gap: {gap}, floor: {{rigid: {{restitution: 0}}}}}}]\n  excitation: {{impulse_train: {{at: 1, \
             impulse: {impulse}, frequency_ratio: 1}}}}"
        );
        let rest = "run: {skip: 1 cycles, average: 2 cycles}\nmeasure: [final_height, final_displacement]";
        values(&evaluated(&experiment(BEAM, &scene, rest), solver))
    };
    for solver in [SolverChoice::EventDriven, STEPS] {
        // Thrown up and about, and never below its floor.
        let [own, tip] = ["0.4", "1"].map(|point| height(point, "5 mm", "0.2 N s", solver));
        assert_eq!(own[0], tip[0], "{solver:?}");
        assert_ne!(own[1], tip[1], "{solver:?}");
        assert!((0.0..=5e-3).contains(&own[0]), "{solver:?}: {own:?}");
        // Too weak to lift it.
        let [rests, moves] = height("1", "5 mm", "1e-4 N s", solver)[..] else { panic!() };
        assert!(rests.abs() < 1e-15 && moves.abs() > 1e-6, "{solver:?}: {rests} over the floor, tip at {moves}");
    }
}

#[test]
fn a_mean_displacement_of_several_points_is_taken_as_their_other_numbers_are() {
    // Particles that rest on it bend a beam downwards: by more at the tip, which stands last.
    let mean = |observe: &str| {
        let scene = format!(
            "  observe: {observe}\n  dampers: [{{at: 1, mass_ratio: 0.1, mass_reading: total, particle_share: 0.5, gap: infinite, \
             floor: {{rigid: {{restitution: 0}}}}}}]\n  excitation: {{impulse_train: {{at: 1, impulse: 1e-6 N s, frequency_ratio: 1}}}}"
        );
        values(&evaluated(&experiment(BEAM, &scene, "measure: [mean_displacement]"), SolverChoice::EventDriven))[0]
    };
    let own = [0.5, 0.8, 1.0].map(|point| mean(&format!("{{points: [{point}], take: largest}}")));
    assert!(own[2] < own[1] && own[1] < own[0] && own[0] < 0.0, "{own:?}");
    assert_eq!(mean("{points: [0.5, 0.8, 1], take: largest}"), own[2]);
    let taken = mean("{points: [0.5, 0.8, 1], take: mean}");
    assert!((taken - own.iter().sum::<f64>() / 3.0).abs() < 1e-14, "{taken} of {own:?}");
}

#[test]
fn the_drift_of_a_single_cycle_is_undefined_and_nothing_else_is() {
    let of_cycles = |cycles: u32| {
        let rest = format!("run: {{skip: 0 cycles, average: {cycles} cycles}}\nmeasure: [drift, rms_velocity]");
        let experiment = experiment(MASS, &on_mass(FLOOR, IMPULSES), &rest);
        let evaluated = evaluated(&experiment, SolverChoice::EventDriven);
        (values(&evaluated), evaluated.undefined(&experiment.measures, Particles::One))
    };
    let (one, why) = of_cycles(1);
    assert!(one[0].is_nan() && one[1] > 0.0, "{one:?}");
    assert_eq!(why, "drift undefined: nothing moves, or a single cycle is averaged, which has no halves");
    // From rest the second half is the faster one: a drift is a modulus.
    let (three, why) = of_cycles(3);
    assert!(three[0] > 0.0 && why.is_empty(), "{three:?}, {why}");
    let rms = |skip: u32, cycles: u32| {
        let rest = format!("run: {{skip: {skip} cycles, average: {cycles} cycles}}\nmeasure: [rms_velocity]");
        values(&evaluated(&experiment(MASS, &on_mass(FLOOR, IMPULSES), &rest), SolverChoice::EventDriven))[0]
    };
    // Two cycles against the last one.
    let want = (rms(0, 2) / rms(2, 1) - 1.0).abs();
    assert!((three[0] - want).abs() < 1e-9, "{} instead of {want}", three[0]);
}

#[test]
fn lags_are_undefined_with_a_reason_where_no_impulse_stands() {
    let lags = |excitation: &str, from: u32| {
        let rest = format!(
            "run: {{skip: 0 cycles, average: 6 cycles}}\ntrace: {{from: {from} cycles, to: 6 cycles, samples_per_cycle: 50}}\n\
             measure: [floor_impact_lag, ceiling_impact_lag, rms_velocity]"
        );
        let experiment = experiment(MASS, &on_mass(FLOOR, excitation), &rest);
        let evaluated = evaluated(&experiment, SolverChoice::EventDriven);
        (values(&evaluated), evaluated.undefined(&experiment.measures, Particles::One))
    };
    let reason = "floor_impact_lag, ceiling_impact_lag undefined: no impulse stands in the time history";
    let once = "{single_impulse: {force_ratio: 8, frequency_ratio: 1}}";
    for (excitation, from) in [("{harmonic: {force_ratio: 8, frequency_ratio: 1}}", 0), ("none", 0), (once, 1)] {
        let (lags, why) = lags(excitation, from);
        assert!(lags[0].is_nan() && lags[1].is_nan(), "{excitation}: {lags:?}");
        assert!(why.contains(reason), "{excitation}: {why}");
    }
    // What one impulse throws up is on its way for a good part of a cycle.
    let (thrown, why) = lags(once, 0);
    assert!(thrown[0] > 0.05 && why.is_empty(), "{thrown:?}, {why}");
    let (train, why) = lags(IMPULSES, 0);
    assert!(train[0] >= 0.0 && train[0] < 0.1 && why.is_empty(), "{train:?}, {why}");
}

#[test]
fn the_largest_compression_is_that_of_all_dampers() {
    let of = |dampers: &[&str]| {
        let dampers: Vec<String> = dampers
            .iter()
            .map(|gap| {
                format!(
                    "{{at: 1, mass_ratio: 0.02, mass_reading: total, particle_share: 0.5, gap: {gap}, floor: {{resilient: \
                     {{stiffness: 20 kN/m, damping_ratio: 0.1}}}}}}"
                )
            })
            .collect();
        let scene = format!(
            "  dampers: [{}]\n  excitation: {{impulse_train: {{at: 1, impulse: 0.2 N s, frequency_ratio: 1}}}}",
            dampers.join(", ")
        );
        let rest = "run: {skip: 0 cycles, average: 4 cycles}\ntrace: {from: 0 cycles, to: 4 cycles, samples_per_cycle: 200}\n\
                    measure: [floor_compression, ceiling_compression]";
        values(&evaluated(&experiment(BEAM, &scene, rest), SolverChoice::EventDriven))
    };
    let (near, far) = (of(&["1 mm", "80 mm"]), of(&["80 mm", "1 mm"]));
    assert!(near.iter().all(|depth| *depth > 1e-5), "{near:?}");
    for (a, b) in near.iter().zip(&far) {
        // A hundred impacts let rounding grow.
        assert!((a / b - 1.0).abs() < 1e-5, "{near:?} and {far:?}");
    }
}

#[test]
fn the_first_impulse_finds_the_energy_that_the_run_started_with() {
    let mass = "single_mass: {mass: 1 kg, stiffness: 700 N/m, damping_ratio: 0.04}";
    let scene = |comparison: &str| {
        format!(
            "  undamped_mass: base\n  mass_measure: {comparison}\n  dampers: [{{mass: 0.5 kg, gap: infinite, floor: {{rigid: {{restitution: 0}}}}}}]\n  \
             excitation: {{impulse_train: {{impulse: 1 N s, angular_frequency: 17 rad/s}}}}\n  \
             start: {{displacement: 0 mm, velocity: 2 m/s, particles: [on_floor]}}"
        )
    };
    let rest = "run: {skip: 0 cycles, average: 1 cycles}\nmeasure: [mass_measure]";
    let of = |comparison: &str| {
        values(&evaluated(&experiment(mass, &scene(comparison), rest), SolverChoice::EventDriven))[0]
    };
    // T from 2 m/s to 2 + 1/1.5 m/s, and to 3 m/s without the particle that the floor takes along.
    let (before, after, clean) = (2.0, 0.5 * (2.0_f64 + 1.0 / 1.5).powi(2), 4.5);
    for (comparison, right) in
        [("jump", (after - before) / (clean - before)), ("after", after / clean), ("level", (after - before) / before)]
    {
        assert!((of(comparison) - right).abs() < 1e-12, "{comparison}: {} is not {right}", of(comparison));
    }
}

#[test]
fn events_of_a_time_history_beyond_the_averaged_cycles_are_not_measured() {
    let floor = "{rigid: {restitution: 0.6}}";
    let measured = |trace: &str| {
        let rest = format!(
            "run: {{skip: 2 cycles, average: 4 cycles}}\n{trace}measure: [floor_impact_time, floor_impact_speed, \
             floor_impact_phase, floor_impact_interval, contact_share, floor_impacts]"
        );
        values(&evaluated(&experiment(MASS, &on_mass(floor, IMPULSES), &rest), SolverChoice::EventDriven))
    };
    let within = measured("");
    assert!(within.iter().all(|value| value.is_finite()), "{within:?}");
    assert_eq!(measured("trace: {from: 0 cycles, to: 40 cycles, samples_per_cycle: 10}\n"), within);
}

#[test]
fn a_compression_is_uncertain_by_what_lies_between_its_samples() {
    let of = |samples: u32| {
        let rest = format!(
            "trace: {{from: 0 cycles, to: 2 cycles, samples_per_cycle: {samples}}}\nrun: {{skip: 0 cycles, average: 2 cycles, \
             ensemble: none}}\nmeasure: [floor_compression]"
        );
        evaluated(&experiment(MASS, &on_mass(FLOOR, IMPULSES), &rest), SolverChoice::EventDriven).measured[0]
    };
    let (coarse, fine) = (of(25), of(20_000));
    assert!(fine.numerical < 1e-3 * coarse.numerical, "{fine:?} {coarse:?}");
    assert!((coarse.value - fine.value).abs() <= coarse.numerical, "{coarse:?} {fine:?}");
}

/// Under another value of an input an ensemble ends where its means are sharp, and they are those of the whole one.
#[test]
fn a_moved_input_is_worth_as_many_runs_as_its_means_need() {
    let mut counts = Vec::new();
    for force_ratio in [0.3, 0.4, 0.5, 1.0, 1.5, 2.0] {
        let scene = on_mass(FLOOR, &format!("{{impulse_train: {{force_ratio: {force_ratio}, frequency_ratio: 1}}}}"));
        let rest = "run: {skip: 25 cycles, average: 400 cycles, ensemble: 8 members}\nmeasure: [rms_velocity]";
        let experiment = experiment(MASS, &scene, rest);
        let [variant, whole] =
            [Rigour::Variant, Rigour::Look].map(|rigour| evaluated_as(rigour, &experiment, SolverChoice::EventDriven));
        let [sharp, all] = [&variant, &whole].map(|evaluated| evaluated.measured[0]);
        assert_eq!(variant.chaotic, whole.chaotic);
        if !variant.chaotic || variant.members == whole.members {
            assert_eq!(variant.measured, whole.measured);
        } else {
            assert!(2.0 * sharp.numerical <= ENSEMBLE_OF_A_VARIANT.half_width * sharp.value);
            let apart = (sharp.value - all.value).abs();
            assert!(apart <= 3.0 * sharp.numerical.hypot(all.numerical), "f′ = {force_ratio}: {apart}");
        }
        counts.push(variant.members);
    }
    println!("members: {counts:?}");
    assert!(counts.iter().any(|count| (4..8).contains(count)), "{counts:?}");
}
