//! What the study says, drawn: values, places, instants, searches.

use shotdamp::experiment::{AnimationSpec, AxisScale, Band, Drawing, FigureSpec, Panel};
use shotdamp::figure::{Beside, Known, Picture, Quoted, QuotedAt, draw};
use shotdamp::table::{Column, Data, Table};

use crate::made_up::{figure, hump, limit_stop, log_range, numbers, panel, texts};

fn curve() -> Table {
    let force = log_range(0.1, 100.0, 61);
    let ratio = force.iter().map(|f| 1.0 + hump(*f, 2.5, 0.6)).collect();
    Table::default()
        .with(numbers("force_ratio", "f′", "", force))
        .with(texts("variant", ["baseline"; 61]))
        .with(numbers("velocity_ratio", "ψ", "", ratio))
}

fn quoted(at: QuotedAt) -> Quoted {
    let over = (!matches!(at, QuotedAt::Level(_))).then(|| "force_ratio".into());
    let label = "study: quoted".into();
    Quoted { column: "velocity_ratio".into(), over, at, label, u_data: 0.05, tolerance: Some(0.2) }
}

fn drawn(name: &str, spec: Panel, table: &Table, quoted: &[Quoted], impulses: Option<f64>) -> Picture {
    let picture =
        draw(&limit_stop(), &figure(vec![spec]), table, Beside { quoted, impulses, ..Beside::default() }).unwrap();
    std::fs::write(format!("{}/{name}.png", env!("CARGO_TARGET_TMPDIR")), &picture.png).unwrap();
    picture
}

#[test]
fn a_place_without_a_value_is_a_labelled_line_and_no_point() {
    let over_force = || panel("force_ratio", AxisScale::Log, &["velocity_ratio"]);
    let bare = |at| Quoted { tolerance: None, ..quoted(at) };
    let place = drawn("study-place", over_force(), &curve(), &[bare(QuotedAt::Place(2.5))], None);
    assert!(place.svg.contains("study: quoted"), "the number stands at its line");
    // A diamond would claim a value: it is the only thing filled with paper that has four corners.
    let diamonds = |picture: &Picture| picture.svg.matches("z\"/>").count();
    let at = QuotedAt::Point { x: 2.5, y: 1.6, known: Known::Y };
    let point = drawn("study-point", over_force(), &curve(), &[bare(at)], None);
    assert!(diamonds(&point) > diamonds(&place), "a value at a place is a diamond");
    let elsewhere = Quoted { over: Some("gap_ratio".into()), ..quoted(QuotedAt::Place(2.5)) };
    assert!(!drawn("study-elsewhere", over_force(), &curve(), &[elsewhere], None).svg.contains("study"), "other axes");
}

#[test]
fn a_value_far_from_the_curves_does_not_press_them_flat() {
    let over_force = || panel("force_ratio", AxisScale::Log, &["velocity_ratio"]);
    let near = drawn("study-level", over_force(), &curve(), &[quoted(QuotedAt::Level(2.2))], None);
    assert!(near.svg.contains("study: quoted"));
    let far = drawn("study-far", over_force(), &curve(), &[quoted(QuotedAt::Level(50.0))], None);
    assert!(!far.svg.contains("study: quoted"));
}

/// A bar that goes on beyond the frame ends in an arrow; one that needs little room is shown whole.
#[test]
fn no_bar_of_a_tolerance_is_cut_off_unsaid() {
    let over_force = || panel("force_ratio", AxisScale::Log, &["velocity_ratio"]);
    let arrows = |name: &str, tolerance: f64| {
        let level = Quoted { tolerance: Some(tolerance), ..quoted(QuotedAt::Level(1.05)) };
        drawn(name, over_force(), &curve(), &[level], None).svg.matches("fill=\"#1a1a1a\" d=").count()
    };
    assert_eq!((arrows("study-whole", 0.1), arrows("study-beyond", 0.5)), (0, 1));
}

/// Two lines side by side: the label of neither crosses the other one.
#[test]
fn labels_of_neighbouring_lines_stand_clear_of_both() {
    let at_end =
        |x: f64| Quoted { tolerance: None, label: format!("study: {x} of the force"), ..quoted(QuotedAt::Place(x)) };
    let picture = drawn(
        "study-neighbours",
        panel("force_ratio", AxisScale::Log, &["velocity_ratio"]),
        &curve(),
        &[at_end(60.0), at_end(80.0)],
        None,
    );
    let upright = |words: &str| {
        let text = picture.svg.split("<text").find(|text| text.contains(words)).unwrap();
        text.contains("rotate(-90")
    };
    assert!(!upright("study: 60 of") && upright("study: 80 of"), "there is room for one of them on the left");
}

#[test]
fn a_dashed_line_is_one_path() {
    let quoted = [Quoted { tolerance: None, ..quoted(QuotedAt::Place(2.5)) }];
    let over_force = || panel("force_ratio", AxisScale::Log, &["velocity_ratio"]);
    let paths =
        |quoted: &[Quoted]| drawn("study-dash", over_force(), &curve(), quoted, None).svg.matches("<path").count();
    assert_eq!(paths(&quoted), paths(&[]) + 1);
}

#[test]
fn contacts_and_impulses_are_marked_in_a_time_history() {
    let time: Vec<f64> = (0..=400).map(|i| 5e-3 * f64::from(i)).collect();
    let base: Vec<f64> = time.iter().map(|t| 0.02 * (6.3 * t).sin()).collect();
    let flight: Vec<f64> = time.iter().map(|t| 0.15 * (3.0 * t).sin() + 0.05).collect();
    // On the floor the two paths are one.
    let particle: Vec<f64> = flight.iter().zip(&base).map(|(p, b)| p.max(*b)).collect();
    let list = |name: &str, cells: &[f64], unit: &str| {
        Column::new(name, Data::FloatList(vec![cells.to_vec()])).with_unit(unit)
    };
    let table = Table::default()
        .with(texts("variant", ["baseline"]))
        .with(list("time", &time, "s"))
        .with(list("floor_displacement", &base, "m"))
        .with(list("particle_displacement", &particle, "m"));
    let paths = panel("time", AxisScale::Linear, &["floor_displacement", "particle_displacement"]);
    let picture = drawn("study-instants", paths, &table, &[], Some(0.371));
    assert!(picture.svg.contains(">contact<") && picture.svg.contains(">impulse<"));
}

#[test]
fn every_damper_of_an_array_moves_in_its_animation() {
    let time: Vec<f64> = (0..=40).map(|i| 0.01 * f64::from(i)).collect();
    let list = |name: &str, of: &dyn Fn(f64) -> f64| {
        Column::new(name, Data::FloatList(vec![time.iter().map(|t| of(*t)).collect()])).with_unit("m")
    };
    let floor = |t: f64| 1e-3 * (20.0 * t).sin();
    let mut table = Table::default().with(texts("variant", ["baseline"])).with(list("time", &|t| t));
    for (number, gap) in [("", 4e-3), ("_2", 2e-3)] {
        for (name, height) in
            [("floor_displacement", 0.0), ("rigid_floor", 0.0), ("ceiling_displacement", gap), ("rigid_ceiling", gap)]
        {
            table = table.with(list(&format!("{name}{number}"), &|t| floor(t) + height));
        }
        table = table.with(list(&format!("particle_displacement{number}"), &|t| gap * (0.5 + 0.4 * (30.0 * t).cos())));
    }
    let animation = Drawing::Animation(AnimationSpec { by: Vec::new() });
    let picture = draw(&limit_stop(), &FigureSpec { drawing: animation, ..figure(vec![]) }, &table, Beside::default());
    let svg = picture.unwrap().svg;
    for part in ["base-1", "particle-1", "base-2", "particle-2"] {
        assert!(svg.contains(&format!("-0-{part}\"")) && svg.contains(&format!("-0-{part}{{")), "{part} moves");
    }
    assert!(svg.contains("data-name=\"particle 2\"") && !svg.contains("-0-base-3"));
}

#[test]
fn a_landscape_shows_the_spread_of_the_ensemble() {
    let list = |name: &str, cells: [f64; 3]| Column::new(name, Data::FloatList(vec![cells.to_vec()]));
    let table = Table::default()
        .with(texts("variant", ["baseline"]))
        .with(list("along_gap", [1.0, 2.0, 3.0]))
        .with(list("fitness_along", [5.0, 4.0, 6.0]))
        .with(list("fitness_along_spread", [0.0, 0.5, 1.0]));
    let along = panel("along_gap", AxisScale::Linear, &["fitness_along"]);
    let spread = drawn("study-landscape", Panel { band: Band::Spread, ..along.clone() }, &table, &[], None);
    assert!(spread.svg.contains("± 1 s.d. of the ensemble"));
    assert!(!drawn("study-section", along, &table, &[], None).svg.contains("s.d."));
}

#[test]
fn searches_that_differ_in_their_seed_are_one_line_with_a_band() {
    let lists = |cells: Vec<Vec<f64>>| Data::FloatList(cells);
    let table = Table::default()
        .with(texts("variant", ["baseline"; 4]))
        .with(texts("candidate", ["genetic", "genetic", "genetic", "dense"]))
        .with(Column::new(
            "evaluation",
            lists(vec![vec![1.0, 10.0], vec![1.0, 20.0], vec![1.0, 30.0], vec![5.0, 25.0]]),
        ))
        .with(Column::new("best_so_far", lists(vec![vec![4.0, 2.0], vec![5.0, 2.5], vec![6.0, 2.2], vec![5.0, 3.0]])));
    let by = vec!["candidate".into()];
    let searches = Panel { by, band: Band::Seeds, ..panel("evaluation", AxisScale::Log, &["best_so_far"]) };
    let picture = drawn("study-searches", searches, &table, &[], None);
    assert!(picture.svg.contains("median and range of 3 seeds"));
    assert_eq!(picture.svg.matches(">genetic algorithm<").count(), 1, "not a line a seed");
}
