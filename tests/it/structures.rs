//! Beams and plates: that their modes are those of the textbooks, that a scene says what an engineer means by it, and that
//! what no structure can be is refused where it stands.

use std::f64::consts::PI;

use shotdamp::dynamics::{Options, Response, Tick, event_driven, steady_state};
use shotdamp::experiment::{Assumptions, Experiment, load_assumptions, parse_experiment};
use shotdamp::measure::SolverChoice;
use shotdamp::measure::{Evaluated, Request, Rigour, evaluate};
use shotdamp::scene::{Point, Scene, Structure, compile};
use shotdamp::yaml::Problems;

use crate::engine::expected;

const BEAM: &str = "cantilever_beam: {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 200 GPa, density: 7800 kg/m^3, rayleigh: 5e-5, MODES}";
const PLATE: &str = "supported_plate: {length: 1.3333333333333333 m, width: 1 m, thickness: 7.91 mm, youngs_modulus: 68.9 GPa, poisson_ratio: 0.33, density: 2700 kg/m^3, rayleigh: 5e-5, MODES}";
const CLAMPED: &str = "clamped_beam: {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 200 GPa, density: 7800 kg/m^3, rayleigh: 5e-5, MODES}";

fn assumptions() -> Assumptions {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/assumptions.yaml");
    load_assumptions(&file).unwrap_or_else(|problems| panic!("{problems}")).assumptions()
}

/// An experiment of a structure with `modes`, the rest of its scene, and what follows the scene.
fn text(structure: &str, modes: &str, scene: &str, rest: &str) -> String {
    let structure = structure.replace("MODES", modes);
    format!(
        "title: Test\nsource: {{chapter: 4, section: '4.3'}}\nabout: A test.\nscene:\n  structure: {{{structure}}}\n{scene}\n{rest}\n\
         figure: {{x: momentum_residual, y: energy_residual, caption: None.}}\n"
    )
}

fn parse(text: &str) -> Result<Experiment, Problems> {
    parse_experiment(&"ch4-test".parse().unwrap(), "ch4-test.yaml", text, &assumptions())
}

fn experiment(structure: &str, modes: &str, scene: &str, rest: &str) -> Experiment {
    parse(&text(structure, modes, scene, rest)).unwrap_or_else(|problems| panic!("{problems}"))
}

fn scene(structure: &str, modes: &str, scene: &str) -> Scene {
    experiment(structure, modes, scene, "measure: [rms_velocity]").recipe.resolve(&assumptions()).unwrap()
}

fn structure(of: &str, modes: &str) -> Structure {
    scene(of, modes, "  excitation: none").structure
}

/// Evaluates every case of an experiment.
fn measured(experiment: &Experiment) -> Vec<Evaluated> {
    let one = |case| {
        let recipe = experiment.recipe_of(case).unwrap();
        let request = Request {
            measures: &experiment.measures,
            trace: experiment.trace.as_ref(),
            energies: experiment.energies.as_ref(),
            shape: experiment.shape.as_ref(),
            rigour: Rigour::Result,
            ..Request::default()
        };
        let subject = recipe.subject(&assumptions(), request.needs()).unwrap();
        evaluate(subject, SolverChoice::EventDriven, &experiment.settings, &request).unwrap()
    };
    experiment.cases.iter().map(one).collect()
}

fn values(evaluated: &Evaluated) -> Vec<f64> {
    evaluated.measured.iter().map(|measured| measured.value).collect()
}

#[track_caller]
fn close(got: f64, want: f64, tolerance: f64) {
    crate::engine::note("relative", (got / want - 1.0).abs(), tolerance);
    assert!((got - want).abs() <= tolerance * want.abs(), "{got:e} instead of {want:e}, off by {:e}", got / want - 1.0);
}

/// Gauss-Legendre panels: enough for the fastest mode here.
fn integral(of: impl Fn(f64) -> f64) -> f64 {
    const NODES: [[f64; 2]; 3] = [
        [0.112_701_665_379_258_3, 0.277_777_777_777_777_8],
        [0.5, 0.444_444_444_444_444_4],
        [0.887_298_334_620_741_7, 0.277_777_777_777_777_8],
    ];
    let panels = 4000;
    let h = 1.0 / f64::from(panels);
    (0..panels).map(|panel| NODES.iter().map(|[x, w]| w * h * of((f64::from(panel) + x) * h)).sum::<f64>()).sum()
}

#[test]
pub(crate) fn a_cantilever_has_the_exact_frequencies_and_stays_right_to_sixty_modes() {
    let beam = structure(BEAM, "basis: exact, modes: 60");
    let model = beam.model();
    let frequencies = model.natural_frequencies();
    let value = expected("cantilever-beta");
    let unit = frequencies[0] / value[0].powi(2);
    for (i, n) in [1, 2, 3, 10, 60].into_iter().enumerate() {
        close((frequencies[n - 1] / unit).sqrt(), value[i], 1e-15);
    }
    close(frequencies[0], 25.697_9, 1e-5);
    let tip = model.shape(Point { x: 1.0, y: 0.0 });
    for (i, tip) in tip.iter().enumerate() {
        let sign = if i % 2 == 0 { 2.0 } else { -2.0 };
        crate::engine::note("tip value", (tip - sign).abs(), 1e-12);
        assert!((tip - sign).abs() < 1e-12, "mode {}: {tip}", i + 1);
    }
    for (i, j) in [(0, 0), (0, 59), (58, 59), (59, 59), (29, 31)] {
        let product = integral(|x| {
            let shape = model.shape(Point { x, y: 0.0 });
            shape[i] * shape[j]
        });
        let want = if i == j { 1.0 } else { 0.0 };
        crate::engine::note("orthogonality", (product - want).abs(), 1e-9);
        assert!((product - want).abs() < 1e-9, "modes {} and {}: {product}", i + 1, j + 1);
    }
}

#[test]
pub(crate) fn the_studys_polynomials_give_its_frequencies_and_converge_from_above_however_many() {
    let frequencies = |count: usize| structure(BEAM, &format!("modes: {count}")).model().natural_frequencies();
    let (three, four) = (frequencies(3), frequencies(4));
    for (got, printed) in [(three[0], 25.706), (four[0], 25.698)] {
        assert!((got - printed).abs() < 6e-4, "{got}");
    }
    for (got, printed) in [(three[1], 162.50), (four[1], 161.95)] {
        assert!((got - printed).abs() < 6e-3, "{got}");
    }
    let exact = structure(BEAM, "basis: exact, modes: 20").model().natural_frequencies();
    let mut last = frequencies(2);
    for count in [4, 8, 11, 16, 24, 40, 60] {
        let now = frequencies(count);
        for (mode, (now, before)) in now.iter().zip(&last).enumerate() {
            assert!(*now <= before * (1.0 + 1e-13), "mode {} of {count}: {now} after {before}", mode + 1);
        }
        for mode in 0..(count / 3).min(20) {
            assert!(now[mode] >= exact[mode] * (1.0 - 1e-12), "mode {} of {count}", mode + 1);
        }
        last = now;
    }
    for mode in 0..20 {
        close(last[mode], exact[mode], 1e-12);
    }
}

#[test]
pub(crate) fn both_bases_have_the_same_low_modes_with_the_same_signs() {
    let (polynomial, exact) = (structure(BEAM, "modes: 30"), structure(BEAM, "basis: exact, modes: 30"));
    for x in [0.01, 0.3, 0.5, 0.96, 1.0] {
        let at = Point { x, y: 0.0 };
        let (p, e) = (polynomial.model().shape(at), exact.model().shape(at));
        for mode in 0..8 {
            assert!((p[mode] - e[mode]).abs() < 1e-10, "mode {} at {x}: {} and {}", mode + 1, p[mode], e[mode]);
        }
    }
}

#[test]
pub(crate) fn a_clamped_beam_is_one_file_and_has_the_textbooks_frequencies() {
    let beam = structure(CLAMPED, "modes: 60");
    let model = beam.model();
    let frequencies = model.natural_frequencies();
    let cantilever = structure(BEAM, "basis: exact, modes: 1").model().natural_frequencies()[0];
    for (n, beta) in [(1, 4.730_040_744_862_704_f64), (2, 7.853_204_624_095_838), (3, 10.995_607_838_001_671)] {
        close(frequencies[n - 1], cantilever * (beta / 1.875_104_068_711_961_2).powi(2), 1e-14);
    }
    for end in [0.0, 1.0] {
        for (i, w) in model.shape(Point { x: end, y: 0.0 }).iter().enumerate() {
            assert!(w.abs() < 1e-12, "mode {} moves by {w} at its clamp {end}", i + 1);
        }
    }
    let product = integral(|x| model.shape(Point { x, y: 0.0 })[59].powi(2));
    assert!((product - 1.0).abs() < 1e-9);
    close(model.modal_mass() / model.total_mass(), 0.396_5, 2e-4);
}

#[test]
pub(crate) fn a_plate_has_the_frequencies_of_leissa() {
    let plate = structure(PLATE, "modes: 4");
    let model = plate.model();
    let value = expected("plate-1-frequencies");
    for number in 0..5 {
        close(model.natural_frequencies()[number], value[number], 1e-13);
        close(model.exact_frequency(number + 1).unwrap(), value[number], 1e-13);
    }
    // (2, 3) is one of the next.
    assert!((6..12).any(|number| (model.exact_frequency(number).unwrap() / value[5] - 1.0).abs() < 1e-13));
    let (a, b) = (Point { x: 0.25, y: 0.5 }, Point { x: 0.7, y: 0.2 });
    close(model.shape(a)[0], 2.0 * (0.25 * PI).sin() * (0.375 * PI).sin(), 1e-15);
    close(model.exact_shape(2, b).unwrap(), 2.0 * (0.7 * PI).sin() * (0.3 * PI).sin(), 1e-14);
}

/// A rigid damper of this share of the whole mass, half of it particle, that rests on its floor.
fn carried(at: &str, share: f64) -> String {
    format!(
        "  dampers: [{{at: {at}, mass_ratio: {share}, mass_reading: total, particle_share: 0.5, gap: infinite, floor: {{rigid: {{restitution: 0}}}}}}]\n  excitation: none"
    )
}

#[test]
pub(crate) fn a_mass_on_a_beam_and_on_a_plate_lowers_their_frequencies_as_in_closed_form() {
    let beam = scene(BEAM, "basis: exact, modes: 60", &carried("1", 0.1));
    let frequencies =
        |scene: &Scene| -> Vec<f64> { scene.normal_modes().unwrap().iter().map(|mode| mode.frequency).collect() };
    // The exact values of a beam with a tip mass; sixty modes come near from above, by the cube of their number.
    let value = expected("cantilever-tip-mass-whole-damper");
    let exact = [value[0], value[1], value[2]];
    for (got, want) in frequencies(&beam).into_iter().zip(exact) {
        assert!(got >= want, "{got} below {want}");
        close(got, want, 2e-3);
    }
    // With as many polynomials the series is complete.
    let beam = scene(BEAM, "modes: 40", &carried("1", 0.1));
    for (got, want) in frequencies(&beam).into_iter().zip(exact) {
        close(got, want, 1e-12);
    }
    let plate = scene(PLATE, "modes: 5", &carried("[0.5, 0.5]", 0.05));
    let moving = frequencies(&plate);
    let value = expected("plate-1-centre-mass");
    close(moving[0], value[0], 1e-12);
    assert!(moving.iter().any(|omega| (omega / value[1] - 1.0).abs() < 1e-12));
}

#[test]
pub(crate) fn the_two_readings_of_a_mass_ratio_differ_by_the_quarter() {
    let sweep = "sweep: {mass_reading: [total, modal]}\nmeasure: [natural_frequency]";
    let floor = "{rigid: {restitution: 0}}";
    let dampers = format!(
        "  dampers: [{{at: [0.5, 0.5], mass_ratio: 0.1, mass_reading: swept, particle_share: 0.5, gap: infinite, floor: {floor}}}]\n  excitation: none"
    );
    let both = measured(&experiment(PLATE, "modes: 9", &dampers, sweep));
    let (total, modal) = (values(&both[0])[0], values(&both[1])[0]);
    // One mode: ω² = ω₁²/(1 + 4 m′) and ω₁²/(1 + m′).
    close(total, 188.44 / 1.4_f64.sqrt(), 2e-2);
    close(modal, 188.44 / 1.1_f64.sqrt(), 2e-2);
}

#[test]
pub(crate) fn impulses_on_the_clean_cantilever_are_the_sum_of_their_modes() {
    let train = "  excitation: {impulse_train: {at: 1, impulse: 0.02 N s, period: 0.29 s}}";
    let scene = scene(BEAM, "basis: exact, modes: 3", train);
    let system = compile(&scene).unwrap();
    let options = Options { skip: 30_000, average: 10, audit: true, cycle_rates: true, ..Options::default() };
    let response = event_driven(&system, &options).unwrap();
    let value = expected("cantilever-impulse-train-3-modes");
    close(response.window().rms_velocity(), value[0], 1e-11);
    let tip = scene.structure.model().shape(Point { x: 1.0, y: 0.0 });
    let after: f64 = response.cycle_rates.last().unwrap().after.iter().zip(&tip).map(|(q, phi)| q * phi).sum();
    close(after, value[1], 1e-11);
    assert!(response.proof.energy_residual < 1e-12, "{:?}", response.proof);
}

#[test]
pub(crate) fn a_harmonic_force_at_the_tip_gives_the_receptance_of_the_damped_beam() {
    let rest = "run: {skip: 30000 cycles, average: 4 cycles}\nmeasure: [displacement_per_force, displacement_amplitude, rms_velocity]";
    let force = "  excitation: {harmonic: {at: 1, force: 1 N, angular_frequency: 25.7 rad/s}}";
    let values = values(&measured(&experiment(BEAM, "basis: exact, modes: 5", force, rest))[0]);
    let value = expected("cantilever-harmonic-tip-w25.7");
    close(values[0], value[3], 1e-10);
    close(values[1], value[3], 1e-10);
    close(values[2], values[0] * 25.7 / 2.0_f64.sqrt(), 1e-10);
}

#[test]
pub(crate) fn a_harmonic_force_at_the_tip_moves_it_as_the_damped_partial_differential_equation_says() {
    for (id, omega) in [("cantilever-harmonic-tip-w25.7", 25.7), ("cantilever-harmonic-tip-w100.0", 100.0)] {
        let value = expected(id);
        let force = format!("  excitation: {{harmonic: {{at: 1, force: 1 N, angular_frequency: {omega} rad/s}}}}");
        let steady = |modes: &str| {
            let mut system = compile(&scene(BEAM, modes, &force)).unwrap();
            system.observed_rows.truncate(1);
            let options = Options { skip: 400_000, average: 4, extremes: true, ..Options::default() };
            event_driven(&system, &options).unwrap()
        };
        let amplitude = |response: &Response| response.observed[0].extremes.displacement[1];
        close(amplitude(&steady("basis: exact, modes: 5")), value[3], 1e-12);
        // The sum over all modes is reached by the cube of their number.
        let many = steady("basis: exact, modes: 40");
        close(amplitude(&many), value[0], 1e-4);
        // x = A sin(ω t − φ), at the start of a cycle.
        let lag = (-many.final_displacement).atan2(many.final_velocity / omega);
        close(lag, value[1], 1e-4);
        close(many.window().rms_velocity(), value[2], 1e-4);
    }
}

#[test]
pub(crate) fn a_constant_force_bends_the_cantilever_by_the_textbooks_cubic() {
    let value = expected("cantilever-static-tip");
    // The cubic is in the space of two polynomials and more.
    for modes in [2, 3, 5, 8] {
        let train = "  excitation: {impulse_train: {at: 1, impulse: 1 N s, period: 0.3 s}}";
        let scene = scene(BEAM, &format!("modes: {modes}"), train);
        let mut system = compile(&scene).unwrap();
        let shape = |x: f64| scene.structure.model().shape(Point { x, y: 0.0 });
        system.observed_rows = vec![shape(1.0), shape(0.5)];
        system.drive.ticks = vec![Tick { time: 0.0, impulse: 0.0, level: 10.0 }];
        let steady = steady_state(&system).unwrap().unwrap();
        close(steady.observed[0].cycle.mean_displacement(), value[0], 1e-11);
        close(steady.observed[1].cycle.mean_displacement(), value[1], 1e-11);
    }
}

/// A resilient damper that is there, but so light that the beam cannot tell.
const DAMPER: &str = "floor: {resilient: {stiffness: tuned, damping_ratio: 0.1}}";

#[test]
pub(crate) fn an_array_shares_its_mass_and_stands_where_its_spacing_says() {
    let array = |count: &str, at: &str, spacing: &str| {
        format!(
            "  dampers: [{{at: {at}, mass_ratio: 0.1, mass_reading: total, particle_share: 0.25, gap_ratio: 2, array: {{count: {count}, spacing: {spacing}}}, {DAMPER}}}]\n  excitation: none"
        )
    };
    let beam = scene(BEAM, "modes: 4", &array("4", "1", "-4 cm"));
    let places: Vec<f64> = beam.dampers.iter().map(|damper| damper.at.x).collect();
    for (got, want) in places.iter().zip([1.0, 0.96, 0.92, 0.88]) {
        close(*got, want, 1e-14);
    }
    let total = beam.structure.model().total_mass();
    let mass: f64 = beam.dampers.iter().map(|damper| damper.particle_mass + damper.enclosure_mass).sum();
    close(mass, 0.1 * total, 1e-14);
    close(beam.dampers[0].particle_mass, 0.1 * total * 0.25 / 4.0, 1e-14);
    let plate = scene(PLATE, "modes: 4", &array("[2, 3]", "[0.5, 0.5]", "2 cm"));
    let places: Vec<Point> = plate.dampers.iter().map(|damper| damper.at).collect();
    assert_eq!(places.len(), 6);
    close(places[0].x, 0.49, 1e-14);
    close(places[0].y, 2.0 / 3.0 - 0.02, 1e-14);
    close(places[5].x, 0.51, 1e-14);
}

#[test]
pub(crate) fn two_dampers_at_one_place_are_two_dampers() {
    let at = "{at: 1, mass_ratio: 0.05, mass_reading: total, particle_share: 0.5, gap_ratio: 2, floor: {resilient: {stiffness: tuned, damping_ratio: 0.1}}}";
    let beam = scene(
        BEAM,
        "modes: 4",
        &format!(
            "  dampers: [{at}, {at}]\n  excitation: {{impulse_train: {{at: 1, impulse: 0.3 N s, frequency_ratio: 1}}}}"
        ),
    );
    let response = event_driven(&compile(&beam).unwrap(), &Options { audit: true, ..Options::default() }).unwrap();
    assert!(response.proof.events > 0);
    assert!(response.proof.momentum_residual < 1e-9 && response.proof.energy_residual < 1e-9, "{:?}", response.proof);
    // By symmetry both particles end at the same height.
    let [one, other] = [response.final_particles[0], response.final_particles[1]];
    assert!((one[0] - other[0]).abs() < 1e-9, "{one:?} and {other:?}");
}

#[test]
pub(crate) fn a_beam_in_one_mode_is_a_single_mass() {
    // A one-mode cantilever forced and observed at its tip is a mass of a quarter on a spring: the same motion to rounding.
    let beam = scene(
        BEAM,
        "basis: exact, modes: 1",
        &format!(
            "  dampers: [{{at: 1, mass_ratio: 0.02, mass_reading: total, particle_share: 1, gap: 20 mm, {DAMPER}}}]\n  excitation: {{impulse_train: {{at: 1, impulse: 0.05 N s, frequency_ratio: 1}}}}"
        ),
    );
    let matrices = beam.structure.model().matrices();
    let [mass, damping, stiffness] = [matrices.mass, matrices.damping, matrices.stiffness].map(|m| 0.25 * m.at(0, 0));
    let base = shotdamp::scene::SingleMass { mass, stiffness, damping };
    let mut dampers = beam.dampers.clone();
    dampers[0].at = Point::default();
    let single = Scene::on_one_mass(base, beam.gravity, dampers, beam.excitation.clone());
    let run = |scene: &Scene, cycles| {
        let options = Options { skip: 0, average: cycles, record_events: 40, ..Options::default() };
        event_driven(&compile(scene).unwrap(), &options).unwrap()
    };
    let (a, b) = (run(&beam, 8), run(&single, 8));
    assert!(a.events.len() >= 8);
    for (a, b) in a.events.iter().zip(&b.events).take(16) {
        assert_eq!((a.kind, a.cycle), (b.kind, b.cycle));
        assert!((a.time - b.time).abs() < 1e-9, "{a:?} and {b:?}");
    }
}

#[test]
pub(crate) fn modes_and_deflections_come_as_shapes() {
    let modes = "sweep: {mode: [1, 2, 3, 4]}\nmeasure: [natural_frequency, exact_natural_frequency, mac]\nshape: {of: mode, points: 51}";
    let rows = measured(&experiment(BEAM, "basis: exact, modes: 8", "  excitation: none", modes));
    for row in &rows {
        let [frequency, exact, mac] = values(row)[..] else { panic!("three measures") };
        close(frequency, exact, 1e-12);
        close(mac, 1.0, 1e-12);
        assert_eq!(row.trace.iter().map(|column| &*column.name).collect::<Vec<_>>(), ["x", "shape", "exact_shape"]);
        let largest = row.trace[1].samples.iter().fold(0.0_f64, |largest, w| largest.max(w.abs()));
        close(largest, 1.0, 1e-14);
    }
    let deflection =
        "run: {skip: 2000 cycles, average: 50 cycles}\nmeasure: [mac]\nshape: {of: deflection, points: 51}";
    let near_mode = "  excitation: {harmonic: {at: 1, force: 1 N, forced_mode: 2}}";
    let row = &measured(&experiment(BEAM, "basis: exact, modes: 6", near_mode, deflection))[0];
    assert!(values(row)[0] > 0.999, "in resonance a beam moves in its mode: {}", values(row)[0]);
    let impulses = "  excitation: {impulse_train: {at: 1, force_ratio: 11, angular_frequency: 50 rad/s}}";
    let row = &measured(&experiment(BEAM, "basis: exact, modes: 6", impulses, deflection))[0];
    assert!(values(row)[0] < 0.999, "impulses excite all modes: {}", values(row)[0]);
    let plate = "sweep: {mode: [2]}\nmeasure: [mac]\nshape: {of: mode, points: [5, 9]}";
    let row = &measured(&experiment(PLATE, "modes: 4", "  excitation: none", plate))[0];
    assert_eq!(row.trace[0].samples.len(), 45);
    // The nodal line of the second mode lies along y = Ly/2, where x varies fastest.
    assert!(row.trace[2].samples[20..25].iter().all(|w| w.abs() < 1e-15));
}

#[test]
pub(crate) fn kinetic_energies_are_kept_cycle_by_cycle() {
    let rest = "sweep: {union: {clean: {dampers: without}, light: {mass_ratio: 0.1}}}\nmeasure: [damping_measure, mass_measure, mode_count]\n\
                energies: {from: 0 cycles, to: 30 cycles}\nrun: {skip: 10 cycles, average: 20 cycles, ensemble: none}";
    let dampers = format!(
        "  dampers: [{{at: [0.5, 0.5], mass_ratio: swept, mass_reading: total, particle_share: 0.5, gap_ratio: 72.4, {DAMPER}}}]\n  excitation: {{impulse_train: {{at: [0.25, 0.375], impulse: 0.1 N s, frequency_ratio: 1}}}}"
    );
    let rows = measured(&experiment(PLATE, "modes: 3", &dampers, rest));
    let (clean, light) = (&rows[0], &rows[1]);
    let column =
        |row: &Evaluated, name: &str| row.trace.iter().find(|column| column.name == name).unwrap().samples.clone();
    close(values(clean)[1], 1.0, 1e-12);
    assert_eq!(values(clean)[2], 9.0);
    let (after, before) = (column(clean, "kinetic_energy_after"), column(clean, "kinetic_energy_before"));
    let of_cycle = column(clean, "damping_measure_of_cycle");
    for cycle in 0..30 {
        close(of_cycle[cycle], 1.0 - before[cycle] / after[cycle], 1e-12);
    }
    // At rest before the first impulse: T = J² Σ φ²/(2 m).
    let plate = structure(PLATE, "modes: 3");
    let squares: f64 = plate.model().shape(Point { x: 0.25, y: 0.5 }).iter().map(|phi| phi * phi).sum();
    close(after[0], 0.01 * squares / (2.0 * plate.model().total_mass()), 1e-12);
    assert!(values(light)[1] < 1.0);
    // Forced at the middle of a plate, most modes are not driven at all: the balance is taken along the force.
    for row in &rows {
        assert!(row.proof.momentum_residual < 1e-10 && row.proof.energy_residual < 1e-10, "{:?}", row.proof);
    }
}

#[test]
pub(crate) fn a_grid_of_points_is_taken_by_its_largest_or_by_its_mean() {
    let at = |observe: &str| {
        let scene = format!(
            "  observe: {observe}\n  excitation: {{impulse_train: {{at: [0.25, 0.375], impulse: 0.1 N s, frequency_ratio: 1}}}}"
        );
        values(&measured(&experiment(PLATE, "modes: 3", &scene, "measure: [rms_velocity]"))[0])[0]
    };
    let (largest, mean) = (at("{nine_point_grid: largest}"), at("{nine_point_grid: mean}"));
    let quarters = [0.25, 0.5, 0.75];
    let points: Vec<f64> = quarters.iter().flat_map(|x| quarters.map(|y| at(&format!("[{x}, {y}]")))).collect();
    close(largest, points.iter().copied().fold(0.0, f64::max), 1e-14);
    close(mean, points.iter().sum::<f64>() / 9.0, 1e-14);
    let both = at("{points: [[0.25, 0.25], [0.5, 0.5]], take: mean}");
    close(both, 0.5 * (points[0] + points[4]), 1e-14);
}

#[test]
pub(crate) fn what_no_structure_can_be_is_refused_where_it_stands() {
    let damper = |at: &str| {
        format!("  dampers:\n    - {{at: {at}, mass_ratio: 0.1, particle_share: 0.5, gap_ratio: 2, {DAMPER}}}")
    };
    let train = |at: &str| format!("  excitation: {{impulse_train: {{at: {at}, force_ratio: 1, frequency_ratio: 1}}}}");
    let measure = "measure: [rms_velocity]";
    let cases = [
        (
            text(BEAM, "modes: 4", &format!("{}\n{}", damper("1.2 m"), train("1")), measure),
            "7:12 a damper at 1.2 m lies outside a cantilever beam: its length is 1 m",
        ),
        (
            text(BEAM, "modes: 4", &train("-1 cm"), measure),
            "6:36 a force at -0.01 m lies outside a cantilever beam: its length is 1 m",
        ),
        (
            text(BEAM, "modes: 4", &train("1.2"), measure),
            "6:36 1.2 is a place outside the structure: a number without unit is a share of the side, 0 to 1 | write for example 0.5, or 20 cm",
        ),
        (
            text(BEAM, "modes: 0", &train("1"), measure),
            "5:147 a structure without modes does not move: give it one at least",
        ),
        (text(BEAM, "modes: 61", &train("1"), measure), "5:147 61 modes are more than 60: "),
        (text(BEAM, "basis: exact, modes: 257", &train("1"), measure), "5:161 257 modes are more than 256: "),
        (text(PLATE, "modes: [30, 40]", &train("[0.5, 0.5]"), measure), "5:180 1200 modes are more than 400: "),
        (
            text(PLATE, "modes: 4", &train("0.5"), measure),
            "6:36 a place on a simply supported plate is two coordinates | write [0.25, 0.5], or lengths with units",
        ),
        (
            text(BEAM, "modes: 4", "  observe: 2 m\n  excitation: none", measure),
            "6:12 an observed point at 2 m lies outside a cantilever beam: its length is 1 m",
        ),
        (
            text(
                BEAM,
                "modes: 4",
                &format!(
                    "  dampers:\n    - {{at: swept, mass_ratio: 0.1, particle_share: 0.5, gap_ratio: 2, {DAMPER}}}\n{}",
                    train("1")
                ),
                "sweep: {damper_x: [0.5, 1.5]}\nmeasure: [rms_velocity]",
            ),
            "9:9 a damper at 1.5 m lies outside a cantilever beam: its length is 1 m (at damper_x = 1.5)",
        ),
        (
            text(
                BEAM,
                "modes: 4",
                &train("1"),
                "measure: [rms_velocity]\ntrace: {from: 0 cycles, to: 1 cycles, samples_per_cycle: 10}\nshape: {of: mode, points: 9}",
            ),
            "9:1 a row keeps lists of one length: one of `trace`, `energies`, `shape` and `each_cycle` | give the other an experiment of its own",
        ),
    ];
    for (text, expected) in cases {
        let problems = parse(&text).expect_err("a mistake was expected");
        assert_eq!(problems.list.len(), 1, "{problems}\n{text}");
        let problem = &problems.list[0];
        let place = problem.place.expect("it has a place");
        let help = problem.help.as_ref().map_or_else(String::new, |help| format!(" | {help}"));
        let description = format!("{}:{} {}{help}", place.line, place.column, problem.message);
        let fits = if expected.ends_with(": ") { description.starts_with(expected) } else { description == expected };
        assert!(fits, "{description}\n{expected}\n{text}");
    }
}

#[test]
pub(crate) fn what_a_thread_has_run_before_changes_no_bit() {
    let dampers = |gap: &str, force: &str, extra: &str| {
        let scene = scene(
            BEAM,
            "modes: 4",
            &format!(
                "  dampers:\n  - {{at: 1, mass_ratio: 0.05, particle_share: 0.5, gap: {gap}, floor: {{resilient: {{stiffness: 200 N/m, damping_ratio: 0.2}}}}}}\n\
                 {extra}  excitation: {{impulse_train: {{at: {force}, force_ratio: 11, frequency_ratio: 1}}}}"
            ),
        );
        compile(&scene).unwrap()
    };
    let second = "  - {at: 0.5, mass_ratio: 0.05, particle_share: 0.5, gap: 3 mm, floor: {resilient: {stiffness: 200 N/m, damping_ratio: 0.2}}}\n";
    let systems = [
        dampers("5 mm", "1", ""),
        dampers("9 mm", "1", ""),
        dampers("5 mm", "0.5", ""),
        dampers("5 mm", "1", second),
        dampers("5 mm", "1", ""),
    ];
    let options = Options { skip: 0, average: 20, ..Options::default() };
    let run = |system| event_driven(system, &options).unwrap();
    let one_after_another: Vec<_> = systems.iter().map(run).collect();
    for (system, known) in systems.iter().zip(&one_after_another) {
        let new = std::thread::scope(|scope| scope.spawn(|| run(system)).join().unwrap());
        assert!(known.proof.events > 20);
        assert_eq!(format!("{known:?}"), format!("{new:?}"));
    }
}
