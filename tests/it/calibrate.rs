//! Calibrations: which values of unstated inputs bring chosen entries nearest, and what becomes of the others.

use shotdamp::calibrate::{Calibrated, CalibrationError, calibrated, simulate};
use shotdamp::publish::Opened;
use shotdamp::reference::Found;
use shotdamp::report;
use shotdamp::spec::{Calibration, Experiment, parse_calibration};
use shotdamp::study::Silence;

use crate::desk::{Desk, MadeUp};

const STOP: &str = "
title: How long the stop is
about: One number chooses it.
calibrate:
  stop_length: [10 mm, 55 mm, 110 mm]
  plastic: {moves: [stop_restitution], values: [0, 0.5]}
fit: [ch3-stop/at-two]
hold_out: [ch3-gap/*]
";

fn read(text: &str) -> Calibration {
    parse_calibration("it.yaml", text).unwrap_or_else(|problems| panic!("{problems}"))
}

fn run(calibration: &Calibration, threads: usize) -> Result<Calibrated, CalibrationError> {
    let desk = Desk::new();
    let opened = Opened::new(desk.layout.clone(), desk.texts());
    let experiments: Vec<&Experiment> = opened.items.iter().map(|item| &item.source.experiment).collect();
    let in_force = opened.sheet.assumptions();
    let tables = simulate(calibration, &experiments, &in_force, threads, &MadeUp::default(), &Silence)?;
    calibrated(calibration, &opened.references, &tables)
}

#[test]
fn the_best_of_all_combinations_is_found_and_each_input_has_its_profile() {
    let result = run(&read(STOP), 2).unwrap();
    // The made-up number is 1.69 and the stop's length; 1.75 is published.
    assert_eq!(result.places[0], 1, "55 mm");
    assert!(result.best.unwrap() < 0.004 && result.in_force.unwrap() < result.best.unwrap(), "60 mm are better still");
    let of =
        |which: usize| result.profiles[which].points.iter().map(|(_, residual)| residual.unwrap()).collect::<Vec<_>>();
    let [short, middle, long] = of(0)[..] else { panic!("three values") };
    assert!(short > middle && long > middle && Some(middle) == result.best);
    assert_eq!(of(1)[0], of(1)[1], "nothing tells one restitution from the other");
    assert!(matches!(result.fitted[0].best, Found::Number { published, .. } if published == 1.75));
    assert_eq!(result.held_out[0].id, "ch3-gap/grows");
    assert_eq!(result.held_out[0].best, Found::Claim { holds: true });
    let page = report::calibration(&read(STOP), &result);
    assert!(page.contains("**55 mm: 0.2") && page.contains("| yes |") && page.contains("| no |"), "{page}");
    assert_eq!(run(&read(STOP), 1).unwrap(), result, "on any number of threads");
}

#[test]
fn an_entry_that_is_none_and_an_input_that_is_none_are_told() {
    let unknown = run(&read(&STOP.replace("at-two", "at-three")), 1).unwrap_err();
    assert_eq!(unknown.to_string(), "`ch3-stop/at-three` is no entry of an experiment of this study");
    let wrong = |from: &str, to: &str| parse_calibration("it.yaml", &STOP.replace(from, to)).unwrap_err().to_string();
    assert!(wrong("stop_length:", "stop_lenght:").contains("did you mean `stop_length`"));
    assert!(wrong("[10 mm, 55 mm, 110 mm]", "[10 kg]").contains("length"));
    assert!(wrong("[stop_restitution], values: [0, 0.5]", "[stop_length], values: [1 mm]").contains("two inputs"));
}
