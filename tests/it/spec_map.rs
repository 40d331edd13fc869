//! The `map` of a figure, its axes and the marks on peaks: what a file may say, and where a mistake in it is told.

use shotdamp::experiment::{AxisScale, Best, Drawing, Experiment, ExperimentId, load_assumptions, parse_experiment};
use shotdamp::yaml::Problems;

const EXPERIMENT: &str = "title: Gap and force
source: {chapter: 3, section: 3.6.7}
about: A map.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers: [{mass_ratio: 0.05, gap_ratio: swept, floor: {rigid: {restitution: 0.5}}}]
  excitation: {harmonic: {base_amplitude_ratio: swept, frequency_ratio: 1}}
sweep: {base_amplitude_ratio: [1, 2], gap_ratio: [10, 50]}
measure: velocity_ratio
FIGURE
";

fn read(figure: &str) -> Result<Experiment, Problems> {
    let id = ExperimentId("ch3-example".into());
    let sheet = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/assumptions.yaml");
    let assumptions = load_assumptions(&sheet).unwrap_or_else(|problems| panic!("{problems}"));
    parse_experiment(&id, "it.yaml", &EXPERIMENT.replace("FIGURE", figure), &assumptions.assumptions())
}

#[test]
fn a_map_is_read_with_what_is_usual_filled_in() {
    let figure = "figure:
  caption: A map.
  map:
    x: {column: base_amplitude_ratio, scale: log, reach: [0.1, 10]}
    y: gap_ratio
    value: velocity_ratio
    by: solver
    mark: {x: base_amplitude_ratio, y: gap_ratio, label: here}";
    let experiment = read(figure).unwrap_or_else(|problems| panic!("{problems}"));
    let Drawing::Map(map) = &experiment.figures[0].drawing else { panic!("a map") };
    assert_eq!((map.x.scale, map.x.reach), (AxisScale::Log, Some([0.1, 10.0])));
    assert_eq!((map.best, map.centre, map.aspect, map.columns), (Best::Highest, None, None, None));
    assert_eq!(
        (map.by.as_slice(), map.mark.as_ref().map(|mark| mark.label.as_str())),
        (&["solver".into()][..], Some("here"))
    );
}

#[test]
fn an_axis_in_a_unit_of_its_own_is_read_in_that_unit() {
    let figure = "trace: {from: 0 cycles, to: 1 cycles, samples_per_cycle: 10}
figure:
  caption: A history.
  x: {column: time, unit: ms, range: [10, 20]}
  y: {column: base_velocity, unit: cm/s, reach: [-1, 1]}
  guides: [{at: 2}]";
    let experiment = read(figure).unwrap_or_else(|problems| panic!("{problems}"));
    let Drawing::Lines(panels) = &experiment.figures[0].drawing else { panic!("lines") };
    let (x, y) = (&panels[0].x, &panels[0].y[0]);
    assert_eq!((x.range, y.reach, panels[0].guides[0].at), (Some([0.01, 0.02]), Some([-0.01, 0.01]), 0.02));
    assert_eq!(x.unit.as_ref().map(|unit| unit.symbol.as_str()), Some("ms"));
    for (wrong, says) in [("mm", "numbers in s cannot be shown in mm"), ("ell", "`ell` is not a unit")] {
        let problems = read(&figure.replace("unit: ms", &format!("unit: {wrong}"))).expect_err(wrong);
        assert!(problems.to_string().contains(says), "{problems}");
    }
}

#[test]
fn mistakes_in_a_map_are_told_where_they_stand() {
    let map = "x: base_amplitude_ratio, y: gap_ratio, value: velocity_ratio";
    // The part of the figure that the mistake is told at stands between ‹ and ›.
    for (figure, says) in [
        (format!("figure: {{caption: It., map: {{{map}, ‹valu›: 1}}}}"), "a map has no key `valu`"),
        ("figure: {caption: It., ‹map›: {x: gap_ratio, y: gap_ratio}}".into(), "a map lacks `value`"),
        (
            "figure: {caption: It., map: {x: gap_ratio, y: ‹gap_ration›, value: velocity_ratio}}".into(),
            "no column `gap_ration`",
        ),
        (format!("figure: {{caption: It., map: {{{map}, best: ‹most›}}}}"), "`most` is not a place to mark"),
        (format!("figure: {{caption: It., map: {{{map}, by: ‹time›}}}}"), "`time` is a time history"),
        (
            format!("figure: {{caption: It., map: {{{map}, mark: {{x: ‹solver›, y: gap_ratio, label: it}}}}}}"),
            "`solver` holds words",
        ),
        (format!("figure: {{caption: It., map: {{{map}, aspect: ‹0›}}}}"), "an aspect is"),
        (format!("figure: {{caption: It., x: ‹gap_ratio›, map: {{{map}}}}}"), "beside `map`"),
        (
            "figure: {caption: It., x: {column: gap_ratio, ‹reach›: [2, 1]}, y: velocity_ratio}".into(),
            "from one number to a larger one",
        ),
        (
            "figure: {caption: It., ‹x›: {column: gap_ratio, scale: log, reach: [0, 1]}, y: velocity_ratio}".into(),
            "above zero",
        ),
        (
            "figure: {caption: It., x: {column: gap_ratio, unit: ‹mm›}, y: velocity_ratio}".into(),
            "have no unit that can be chosen",
        ),
        (
            "figure: {caption: It., x: gap_ratio, y: {column: velocity_ratio, ‹range›: [1, 2]}}".into(),
            "an axis has no key `range`",
        ),
        ("figure: {caption: It., x: gap_ratio, y: velocity_ratio, peaks: {prominence: ‹2›}}".into(), "between 0 and 1"),
        ("figure: {caption: It., x: gap_ratio, y: velocity_ratio, strip: ‹chaos›}".into(), "is not a strip"),
        ("figure: {caption: It., x: gap_ratio, y: velocity_ratio, strip: ‹motion›}".into(), "is not measured"),
    ] {
        let column = figure.chars().position(|c| c == '‹').unwrap() + 1;
        let problems = read(&figure.replace(['‹', '›'], "")).expect_err(&figure);
        let named = |problem: &shotdamp::yaml::Problem| {
            let place = problem.place.map_or((0, 0), |place| (place.line, place.column));
            place == (10, column) && problem.message.contains(says)
        };
        assert!(problems.list.iter().any(named), "{figure}: {problems}");
    }
}
