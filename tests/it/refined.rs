//! Refined sweeps: points where a curve bends, and none where it is straight, rough or broken.

use std::sync::atomic::{AtomicU64, Ordering};

use shotdamp::dynamics::Proof;
use shotdamp::measure::{Evaluated, Measured, Rigour};
use shotdamp::scene::Excitation;
use shotdamp::study::{Evaluate, Event, EventHandler, IgnoreEvents, RowFailure, Simulation};
use shotdamp::table::Table;

use crate::desk::Desk;

const RESPONSE: &str = "
title: Frequency response
source: {chapter: 4, section: '4.3.1', shown_in: [Fig. 33]}
about: Two curves.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers: [{mass_ratio: 0.05, gap_ratio: swept, floor: {rigid: {restitution: 0}}}]
  excitation: {harmonic: {base_amplitude_ratio: 1, frequency_ratio: swept}}
sweep: {gap_ratio: [10, 50], frequency_ratio: {refined: {from: 0.2, to: 7, start: 60 points, tolerance: 1 %}}}
run: {solver: event_driven}
measure: [rms_velocity]
figure: {x: frequency_ratio, y: rms_velocity, by: gap_ratio, caption: Two curves.}
";

/// An engine whose numbers are a function of ω/ωn and h: value, spread, and whether that is chaotic.
struct Curve(fn(f64, f64) -> (f64, f64, bool));

impl Evaluate for Curve {
    fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        let scene = it.recipe.resolve(it.assumptions)?;
        let Excitation::Harmonic { angular_frequency, .. } = scene.excitation else {
            return Err(RowFailure::NoValue("velocity_ratio".into()));
        };
        let (value, spread, chaotic) = (self.0)(angular_frequency / 1000_f64.sqrt(), scene.dampers[0].gap);
        Ok(Evaluated {
            measured: vec![Measured { value, numerical: 0.0, spread }],
            proof: Proof::default(),
            chaotic,
            unknown: None,
            members: 1,
            motion: None,
            trace: Vec::new(),
            end: None,
        })
    }
}

/// Two modes of a beam, lightly damped; the gap moves the first.
fn beam(ratio: f64, gap: f64) -> f64 {
    let mode = |at: f64, damping: f64| {
        let x = ratio / at;
        1.0 / (1.0 - x * x).hypot(2.0 * damping * x) / (at * at)
    };
    mode(1.0 + 0.01 * gap, 6e-4) + mode(6.3, 4e-3)
}

fn run(evaluate: &impl Evaluate, threads: usize, text: &str, handler: &dyn EventHandler) -> (Desk, Table) {
    let desk = Desk::new();
    desk.put("experiments/ch4/ch4-response.yaml", text);
    for other in ["experiments/ch3/ch3-stop.yaml", "experiments/ch3/ch3-gap.yaml"] {
        std::fs::remove_file(desk.layout.path(other)).unwrap();
    }
    for other in ["reference/ch3/ch3-stop.yaml", "reference/ch3/ch3-gap.yaml"] {
        std::fs::remove_file(desk.layout.path(other)).unwrap();
    }
    desk.run(threads, evaluate, handler);
    let table = desk.table("ch4-response");
    (desk, table)
}

/// Frequency ratios and values of the rows with this gap ratio.
fn curve(table: &Table, gap_ratio: f64) -> Vec<(f64, f64)> {
    let (x, y) = (table.floats("frequency_ratio").unwrap(), table.floats("rms_velocity").unwrap());
    let gap = table.floats("gap_ratio").unwrap();
    (0..table.rows()).filter(|&row| gap[row] == gap_ratio).map(|row| (x[row], y[row])).collect()
}

/// How many points lie between two frequency ratios.
fn within(curve: &[(f64, f64)], low: f64, high: f64) -> usize {
    curve.iter().filter(|(x, _)| (low..high).contains(x)).count()
}

#[test]
fn a_curve_is_drawn_to_its_tolerance_over_sharp_resonances() {
    let (_, table) = run(&Curve(|ratio, gap| (beam(ratio, gap), 0.0, false)), 2, RESPONSE, &IgnoreEvents);
    for (gap_ratio, gap) in [(10.0, 0.0981), (50.0, 0.4905)] {
        let curve = curve(&table, gap_ratio);
        assert!(curve.is_sorted_by(|a, b| a.0 < b.0), "rows stand in the order of the parameter");
        let mut worst = 0.0_f64;
        for pair in curve.windows(2) {
            for part in 1..8 {
                let share = f64::from(part) / 8.0;
                let x = pair[0].0 + share * (pair[1].0 - pair[0].0);
                let straight = pair[0].1 + share * (pair[1].1 - pair[0].1);
                worst = worst.max((straight / beam(x, gap) - 1.0).abs());
            }
        }
        println!("h′ = {gap_ratio}: {} points, off by {worst:.4} at most", curve.len());
        assert!(worst < 0.015, "straight lines miss by {worst}");
        assert!(curve.len() < 300, "{} points", curve.len());
        // The peak of 833 stands on a hundredth of a thousandth of the range.
        let peak = curve.iter().fold(0.0_f64, |peak, (_, y)| peak.max(*y));
        let exact = 1.0 / (2.0 * 6e-4) / (1.0 + 0.01 * gap).powi(2);
        assert!((peak / exact - 1.0).abs() < 0.01, "{peak} for {exact}");
    }
}

#[test]
fn points_are_the_same_for_any_number_of_threads() {
    let bytes = [1, 3, 8].map(|threads| {
        let engine = Curve(|ratio, gap| (beam(ratio, gap), 0.0, false));
        run(&engine, threads, RESPONSE, &IgnoreEvents).0.bytes("results/ch4-response.parquet")
    });
    assert!(bytes[0] == bytes[1] && bytes[0] == bytes[2]);
}

#[test]
fn what_is_rough_or_broken_attracts_few_points() {
    let engine = Curve(|ratio, _| match ratio {
        // An ensemble whose mean wanders within its spread.
        r if r > 5.0 => (10.0 + libm::sin(1e4 * r), 1.0, true),
        // Chaos in which the spread is small, but the mean has no curve.
        r if r > 3.0 => (10.0 + libm::sin(1e4 * r), 0.01, true),
        // Another motion from here on.
        r if r > 1.5 => (10.0, 0.0, false),
        _ => (5.0, 0.0, false),
    });
    let (_, table) = run(&engine, 2, RESPONSE, &IgnoreEvents);
    let curve = curve(&table, 10.0);
    let counts = [(0.2, 1.3), (1.3, 1.7), (1.7, 2.9), (3.1, 4.9), (5.1, 7.0)].map(|(a, b)| within(&curve, a, b));
    println!("{counts:?}");
    let [flat, step, flat_too, chaos, noise] = counts;
    assert!(flat <= 10 && flat_too <= 11, "nothing bends there");
    assert!((8..60).contains(&step), "the step is closed in on once, fourteen halvings deep");
    assert!(chaos <= 16 * 8 + 1, "three halvings at most");
    assert!(noise <= 17, "within the spread");
}

#[test]
fn progress_ends_where_it_was_said_to_end() {
    #[derive(Default)]
    struct Ear(AtomicU64, AtomicU64);
    impl EventHandler for Ear {
        fn on_event(&self, event: &Event<'_>) {
            match event {
                Event::Begun { simulations, .. } => self.0.store(*simulations, Ordering::Relaxed),
                Event::Simulated { count, .. } => drop(self.1.fetch_add(*count, Ordering::Relaxed)),
                Event::Finished { rows, .. } => assert!(*rows > 120),
                Event::Searched { .. } | Event::Tried { .. } | Event::Interrupted { .. } | Event::Ended => {}
            }
        }
    }
    let ear = Ear::default();
    run(&Curve(|ratio, gap| (beam(ratio, gap), 0.0, false)), 2, RESPONSE, &ear);
    assert_eq!(ear.0.into_inner(), 1200, "600 points a curve at most");
    assert_eq!(ear.1.into_inner(), 1200);
}

#[test]
fn other_solvers_run_at_the_same_points_and_the_range_is_what_makes_stale() {
    let both = RESPONSE
        .replace("event_driven}", "[event_driven, {fixed_step: {time_step: 0.1 ms}}]}")
        .replace("by: gap_ratio", "by: [gap_ratio, solver]");
    let engine = Curve(|ratio, gap| (beam(ratio, gap), 0.0, false));
    let (desk, table) = run(&engine, 2, &both, &IgnoreEvents);
    let of = |solver: &str| {
        let x = table.floats("frequency_ratio").unwrap();
        table.rows_where("solver", solver).into_iter().map(|row| x[row]).collect::<Vec<_>>()
    };
    assert_eq!(of("event_driven"), of("fixed_step_1e-4s"));
    assert_eq!(desk.why("ch4-response"), [""; 0]);
    desk.put("experiments/ch4/ch4-response.yaml", &both.replace("tolerance: 1 %", "tolerance: 0.01, most: 600"));
    assert_eq!(desk.why("ch4-response"), [""; 0], "the same in other words");
    desk.put("experiments/ch4/ch4-response.yaml", &both.replace("1 %", "2 %"));
    assert_eq!(desk.why("ch4-response"), ["experiments/ch4/ch4-response.yaml: refined.0.tolerance: 0.01 -> 0.02"]);
}

#[test]
fn a_low_peak_of_a_grid_that_hides_the_highest_is_found() {
    // By the points of the grid the peaks are 2.1 at 3, 1.6 at 5 and 1.1 at 7; beside the last one the curve rises to 4 at 7.4.
    fn curve(x: f64) -> f64 {
        hill(x, 3.0, 2.0, 0.3) + hill(x, 5.0, 1.5, 0.3) + hill(x, 7.4, 4.0, 0.25)
    }
    let [found, at] = largest(&Curve(|x, _| (curve(x), 0.0, false)), "[1, 2, 3, 4, 5, 6, 7, 8, 9], refine: 12");
    assert!((at - 7.4).abs() < 0.01, "it is found at {at}");
    assert!((found - curve(7.4)).abs() < 0.01, "it is {found}");
}

#[test]
fn no_luck_of_a_single_run_is_the_maximum_and_far_below_it_no_ensemble_is_asked_for() {
    /// A smooth mean with single runs some per cent beside it.
    #[derive(Default)]
    struct Lucky(AtomicU64);
    impl Evaluate for Lucky {
        fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
            let mean = Curve(|x, _| (1.0 + hill(x, 4.0, 2.0, 0.7), 0.05, true)).evaluate(it)?;
            if it.request.rigour != Rigour::Step {
                self.0.fetch_add(1, Ordering::Relaxed);
                return Ok(mean);
            }
            let Measured { value, .. } = mean.measured[0];
            let luck = 0.1 * libm::sin(1e4 * value);
            Ok(Evaluated { measured: vec![Measured { value: value + luck, numerical: 0.0, spread: 0.0 }], ..mean })
        }
    }
    let engine = Lucky::default();
    let [found, at] = largest(&engine, "{step: {from: 1, to: 9, step: 0.1}}, refine: 6");
    assert!((at - 4.0).abs() < 0.1 && (found - 3.0).abs() < 0.02, "{found} at {at}");
    let looks = engine.0.into_inner();
    // Twice 81 points in the grid, and refined ones.
    assert!(looks < 2 * 81, "{looks} looks");
}

fn hill(x: f64, at: f64, height: f64, width: f64) -> f64 {
    height / (1.0 + (x - at) * (x - at) / (width * width))
}

/// The maximum over ω/ωn within a grid, and where it is.
fn largest(engine: &impl Evaluate, grid: &str) -> [f64; 2] {
    let refined = "frequency_ratio: {refined: {from: 0.2, to: 7, start: 60 points, tolerance: 1 %}}";
    let text = RESPONSE
        .replace(&format!(", {refined}"), "")
        .replace("run:", &format!("maximise: {{rms_velocity: {{over: frequency_ratio, in: {grid}}}}}\nrun:"))
        .replace("x: frequency_ratio, y: rms_velocity, by: gap_ratio", "x: gap_ratio, y: rms_velocity");
    let (_, table) = run(engine, 2, &text, &IgnoreEvents);
    ["rms_velocity", "frequency_ratio_at_maximum"].map(|column| table.floats(column).unwrap()[0])
}
