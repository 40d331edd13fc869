//! Peaks, curves, mode shapes and maps: what engineers compare, judged as carefully as a single value.

use std::collections::BTreeSet;

use shotdamp::reference::{
    FitMeasure, Judged, ReferenceFile, TableState, Tables, Verdict, judge, parse_reference, self_test,
};
use shotdamp::table::{Column, Data, Table};
use shotdamp::yaml::Problems;

use crate::made_up::{numbers, texts};

/// What the text is called in messages.
const FILE: &str = "it.yaml";
const EXPERIMENT: &str = "ch4-example";

fn entry(body: &str) -> Result<ReferenceFile, Problems> {
    let indented: String = body.trim().lines().map(|line| format!("    {}\n", line.trim())).collect();
    parse_reference(
        EXPERIMENT,
        FILE,
        &format!("entries:\n  - id: it\n    place: s. 1\n    says: Something.\n{indented}"),
    )
}

fn judged(body: &str, table: &Table) -> Judged {
    let file = entry(body).unwrap_or_else(|problems| panic!("{problems}\n{body}"));
    let tables = Tables::from([(EXPERIMENT.to_string(), TableState::Present(table))]);
    judge(&file, &tables, &BTreeSet::new()).remove(0)
}

fn verdict(body: &str, table: &Table) -> Verdict {
    let judged = judged(body, table);
    println!("{:?}: {}", judged.verdict, judged.found);
    judged.verdict
}

/// What the self-test finds against it.
fn cannot_fail(body: &str, table: &Table) -> Vec<String> {
    let file = entry(body).unwrap_or_else(|problems| panic!("{problems}"));
    let tables = Tables::from([(EXPERIMENT.to_string(), TableState::Present(table))]);
    self_test(&file, &tables).into_iter().map(|failure| failure.reason.to_string()).collect()
}

fn refused(body: &str) -> String {
    entry(body).expect_err(body).to_string()
}

/// The columns that every table has, with the errors of the measures.
fn complete(table: Table, measures: &[&str], run: f64) -> Table {
    let rows = table.rows();
    let flat = |name: &str, suffix: &str, value: f64| numbers(&format!("{name}{suffix}"), "", "", vec![value; rows]);
    let mut table = table
        .with(texts("solver", vec!["event_driven"; rows]))
        .with(texts("variant", vec!["baseline"; rows]))
        .with(texts("failure", vec![""; rows]))
        .with(Column::new("members", Data::Int(vec![1; rows])));
    for measure in measures {
        table = table.with(flat(measure, "_num", run)).with(flat(measure, "_spread", 0.0));
    }
    table
}

const RESPONSE: &str = "of: displacement_per_force, over: angular_frequency";
/// Resonances at these frequencies with these loss factors.
const RESONANCES: [(f64, f64); 2] = [(26.12, 0.02), (163.7, 0.01)];

fn amplitude(w: f64) -> f64 {
    let one = |(w0, loss): (f64, f64), stiffness: f64| {
        1.0 / (stiffness * ((1.0 - (w / w0).powi(2)).powi(2) + (loss * w / w0).powi(2)).sqrt())
    };
    one(RESONANCES[0], 200.0) + one(RESONANCES[1], 8000.0)
}

/// A response on a grid that is finer near the resonances, as a sweep refines it.
fn response(frequencies: &[f64], run: f64) -> Table {
    let table = Table::default().with(numbers("angular_frequency", "ω", "rad/s", frequencies.to_vec())).with(numbers(
        "displacement_per_force",
        "",
        "m/N",
        frequencies.iter().map(|w| amplitude(*w)).collect(),
    ));
    complete(table, &["displacement_per_force"], run)
}

fn refined() -> Vec<f64> {
    let mut grid: Vec<f64> = (0..120).map(|i| 5.0 + 1.5 * f64::from(i)).collect();
    for (w0, loss) in RESONANCES {
        grid.extend((-30..=30).map(|i| w0 * (1.0 + 0.17 * loss * f64::from(i)) + 0.003));
    }
    grid.sort_by(f64::total_cmp);
    grid
}

#[test]
fn a_peak_is_found_between_the_points_with_place_height_and_width() {
    let table = response(&refined(), 0.0);
    // The damped peak lies at w0 √(1 − loss²/2), is 1/(k loss) high and w0 loss wide, but for the other resonance.
    let body = format!("peak: {{{RESPONSE}, at: 26.1 rad/s, height: \"0.2501\", half_power_width: 0.522 rad/s}}");
    let it = judged(&body.replace("height: \"0.2501\", ", ""), &table);
    assert_eq!(it.verdict, Verdict::Reproduced, "{}", it.found);
    let comparison = |name: &str| it.comparisons().find(|(part, _)| *part == name).unwrap().1;
    let (place, width) = (comparison("place"), comparison("half-power width"));
    assert!((place.simulated - 26.12 * (1.0_f64 - 0.0002).sqrt()).abs() < 1e-3, "{}", place.simulated);
    assert!((width.simulated - 26.12 * 0.02).abs() < 1e-3 && width.u_num < 5e-3, "{width:?}");
    assert!(it.comparison.is_none() && it.parts.len() == 2);

    let second = format!("peak: {{{RESPONSE}, which: {{number: 2}}, at: 164 rad/s, half_power_width: 1.6 rad/s}}");
    assert_eq!(verdict(&second, &table), Verdict::Reproduced);
    assert_eq!(verdict(&second.replace("number: 2", "nearest: 150 rad/s"), &table), Verdict::Reproduced);
    assert_eq!(verdict(&second.replace("{number: 2}", "highest"), &table), Verdict::Differs);
    assert_eq!(verdict(&second.replace("number: 2", "number: 3"), &table), Verdict::Differs);
    assert_eq!(verdict(&second.replace("164", "170"), &table), Verdict::Differs);
    assert_eq!(verdict(&second.replace("164 rad/s", "26.05 Hz"), &table), Verdict::Reproduced);
    for body in [second, body.replace("height: \"0.2501\", ", "")] {
        assert_eq!(cannot_fail(&body, &table), Vec::<String>::new(), "{body}");
    }
}

#[test]
fn a_coarse_grid_says_how_badly_it_knows_a_peak() {
    let coarse: Vec<f64> = (0..36).map(|i| 5.2 + 5.0 * f64::from(i)).collect();
    let place = format!("value: 26 rad/s\nfrom: {{peak: {{{RESPONSE}, which: {{number: 1}}, read: place}}}}");
    let (fine, rough) = (judged(&place, &response(&refined(), 0.0)), judged(&place, &response(&coarse, 0.0)));
    let u = |judged: &Judged| judged.comparison.unwrap().u_num;
    assert!(u(&fine) < 1e-3 && u(&rough) > 100.0 * u(&fine), "{} {}", fine.found, rough.found);
    let noisy = judged(&place, &response(&refined(), 0.01));
    assert!(u(&noisy) > 10.0 * u(&fine), "{}", noisy.found);
    let width = place.replace("26 rad/s", "0.52 rad/s").replace("read: place", "read: half_power_width");
    assert_eq!(verdict(&width, &response(&[5.0, 26.1, 60.0], 0.0)), Verdict::Undecidable);
    // A peak of which the sweep shows one side alone has no width.
    assert_eq!(verdict(&width, &response(&[26.0, 26.1, 26.2, 26.3, 60.0], 0.0)), Verdict::Differs);
}

#[test]
fn a_curve_lies_in_a_tube_of_widths_on_both_axes() {
    let grid = refined();
    let table = response(&grid, 0.0);
    let published = |shift: f64, factor: f64| {
        let points: Vec<String> = (0..600)
            .map(|i| 10.0 + 0.1 * f64::from(i))
            .map(|w| format!("[{w}, {}]", factor * amplitude(w - shift)))
            .collect();
        format!(
            "curve:\n  of: displacement_per_force\n  over: angular_frequency\n  points: [{}]\n  \
             tube: {{x: {{absolute: 1}}, y: {{relative: 0.1}}}}\nthreshold_reason: for the test",
            points.join(", ")
        )
        .replace("\n  ", "\n      ")
    };
    let read = |shift: f64, factor: f64| {
        let text = format!("entries:\n  - id: it\n    place: s. 1\n    says: It.\n    {}", published(shift, factor));
        let file = parse_reference(EXPERIMENT, FILE, &text.replace("\nthreshold", "\n    threshold")).unwrap();
        let tables = Tables::from([(EXPERIMENT.to_string(), TableState::Present(&table))]);
        (judge(&file, &tables, &BTreeSet::new()).remove(0), self_test(&file, &tables))
    };
    // Half a unit aside is far off in y beside a resonance, and within the tube.
    for (shift, factor, wanted) in [
        (0.0, 1.05, Verdict::Reproduced),
        (0.5, 1.0, Verdict::Reproduced),
        (0.0, 1.3, Verdict::Differs),
        (4.0, 1.0, Verdict::Differs),
    ] {
        let (judged, failures) = read(shift, factor);
        let fit = judged.fit.clone().unwrap();
        assert_eq!((fit.measure, fit.limit), (FitMeasure::TubeWidths, 1.0));
        println!("{shift} {factor}: {} ({})", judged.found, fit.remark);
        assert_eq!(judged.verdict, wanted, "{shift} {factor}: {}", judged.found);
        assert_eq!(failures, []);
    }
}

/// A cantilever's mode from its differential equation's four conditions, on uneven points.
fn shapes() -> Table {
    let x: Vec<f64> = (0..=40).map(|i| (f64::from(i) / 40.0).powf(1.2)).collect();
    let roots = [1.875_104_068_711_961, 4.694_091_132_974_175];
    let mode = |beta: f64| {
        let sigma = (beta.cosh() + beta.cos()) / (beta.sinh() + beta.sin());
        let at = |x: &f64| {
            let z = beta * x;
            z.cosh() - z.cos() - sigma * (z.sinh() - z.sin())
        };
        x.iter().map(at).collect::<Vec<f64>>()
    };
    let lists = |name: &str, cells: Vec<Vec<f64>>| Column::new(name, Data::FloatList(cells));
    let table = Table::default()
        .with(numbers("mode", "", "", vec![1.0, 2.0]))
        .with(lists("x", vec![x.clone(); 2]))
        .with(lists("shape", roots.map(mode).into()))
        .with(lists("exact_shape", vec![mode(roots[1]), mode(roots[0])]));
    complete(table, &[], 0.0)
}

#[test]
fn a_mode_shape_is_held_against_an_analytic_one() {
    let table = shapes();
    let body = |mode: u32, like: &str, mac: &str| {
        format!(
            "where: {{mode: {mode}}}\nmode_shape: {{of: shape, over: x, like: {{{like}}}, mac: {{{mac}}}}}\n\
             threshold_reason: for the test"
        )
    };
    let second = body(2, "cantilever: 2", "at_least: 0.999");
    let it = judged(&second, &table);
    assert_eq!(it.verdict, Verdict::Reproduced, "{}", it.found);
    let fit = it.fit.unwrap();
    assert!(fit.value > 1.0 - 1e-12 && fit.points == 41 && fit.remark.contains("the nearest of the others"), "{fit:?}");
    assert_eq!(verdict(&body(1, "cantilever: 2", "at_least: 0.999"), &table), Verdict::Differs);
    let other = body(1, "column: exact_shape", "at_most: 0.5");
    assert_eq!(verdict(&other, &table), Verdict::Reproduced);
    assert_eq!(verdict(&body(1, "cantilever: 1", "at_most: 0.9"), &table), Verdict::Differs);
    let points =
        body(1, "points: [[0, 0], [0.2, 0.064], [0.4, 0.23], [0.6, 0.461], [0.8, 0.725], [1, 1]]", "at_least: 0.99");
    assert_eq!(verdict(&points, &table), Verdict::Reproduced);
    for body in [&second, &other, &points] {
        assert_eq!(cannot_fail(body, &table), Vec::<String>::new(), "{body}");
    }
}

#[test]
fn a_plate_mode_is_told_from_its_neighbours() {
    let grid: Vec<f64> = (0..=12).map(|i| f64::from(i) / 12.0).collect();
    let spots: Vec<(f64, f64)> = grid.iter().flat_map(|y| grid.iter().map(|x| (*x, *y))).collect();
    let pi = std::f64::consts::PI;
    let list = |name: &str, part: &dyn Fn(&(f64, f64)) -> f64| {
        Column::new(name, Data::FloatList(vec![spots.iter().map(part).collect()]))
    };
    let table = Table::default()
        .with(list("x", &|spot| spot.0))
        .with(list("y", &|spot| spot.1))
        .with(list("shape", &|(x, y)| -3.0 * (pi * x).sin() * (2.0 * pi * y).sin()));
    let table = complete(table, &[], 0.0);
    let body = |orders: &str| {
        format!(
            "mode_shape: {{of: shape, over: [x, y], like: {{sine_product: {orders}}}, mac: {{at_least: 0.99}}}}\n\
             threshold_reason: for the test"
        )
    };
    assert_eq!(verdict(&body("[1, 2]"), &table), Verdict::Reproduced);
    assert_eq!(verdict(&body("[2, 1]"), &table), Verdict::Differs);
    assert_eq!(cannot_fail(&body("[1, 2]"), &table), Vec::<String>::new());
}

/// Three places of the force on a 5 x 5 grid of places of the damper: the best at the force, beside it, in the middle.
fn map(run: f64) -> Table {
    let places = [0.1, 0.3, 0.5, 0.7, 0.9];
    let forces = [(0.3, 0.3, 0.3, 0.3), (0.1, 0.3, 0.3, 0.3), (0.7, 0.5, 0.5, 0.5)];
    let (mut sweep, mut columns) = (Vec::new(), [const { Vec::new() }; 5]);
    for ((fx, fy, bx, by), name) in forces.into_iter().zip(["point_1", "point_2", "point_3"]) {
        for y in places {
            for x in places {
                let value = 2.0 - (x - bx) * (x - bx) - 0.9 * (y - by) * (y - by);
                sweep.push(name);
                for (column, number) in columns.iter_mut().zip([x, y, fx, fy, value]) {
                    column.push(number);
                }
            }
        }
    }
    let [x, y, fx, fy, value] = columns;
    let table = Table::default()
        .with(texts("sweep", sweep))
        .with(numbers("damper_x", "", "", x))
        .with(numbers("damper_y", "", "", y))
        .with(numbers("force_x", "", "", fx))
        .with(numbers("force_y", "", "", fy))
        .with(numbers("velocity_ratio", "ψ", "", value));
    complete(table, &["velocity_ratio"], run)
}

#[test]
fn the_best_place_of_a_map_is_where_it_is_said_to_be() {
    let table = map(0.0);
    let force = "at: {damper_x: force_x, damper_y: force_y}";
    let best = |rest: &str| format!("claim: {{best_place: {{of: velocity_ratio, {rest}}}}}\n");
    let only = |point: &str| format!("where: {{sweep: {point}}}\n");
    let by_hand = "threshold_reason: for the test";
    for (body, wanted) in [
        (only("point_1") + &best(force), Verdict::Reproduced),
        (only("point_2") + &best(force), Verdict::Differs),
        (only("point_2") + &best(&format!("{force}, position: beside")), Verdict::Reproduced),
        (only("point_1") + &best(&format!("{force}, position: beside")), Verdict::Differs),
        (best(&format!("{force}, position: near, each: sweep")), Verdict::Reproduced),
        (best(&format!("{force}, each: sweep")), Verdict::Differs),
        (only("point_3") + &best("at: {damper_x: 0.5, damper_y: 0.5}"), Verdict::Reproduced),
        (only("point_2") + &best(&format!("{force}, among: 4")) + by_hand, Verdict::Reproduced),
        (only("point_2") + &best(&format!("{force}, among: 3")) + by_hand, Verdict::Differs),
        (only("point_2") + &best(&format!("{force}, slack: 0.07")) + by_hand, Verdict::Reproduced),
    ] {
        assert_eq!(verdict(&body, &table), wanted, "{body}");
        assert_eq!(cannot_fail(&body, &table), Vec::<String>::new(), "{body}");
    }
    // Two neighbours nearer than their errors leave the place open.
    let open = only("point_1") + &best(force);
    assert_eq!(verdict(&open, &map(0.02)), Verdict::Undecidable);
    // A place that is not on the grid, or one that is not the same in all rows, is no answer.
    assert_eq!(verdict(&(only("point_1") + &best("at: {damper_x: 0.4, damper_y: 0.5}")), &table), Verdict::Missing);
    assert_eq!(verdict(&best(force), &table), Verdict::Missing);
}

#[test]
fn a_map_grows_towards_a_place_on_every_step() {
    let table = map(0.0);
    let grows = |to: &str| format!("claim: {{grows_towards: {{of: velocity_ratio, to: {to}, each: sweep}}}}\n");
    let centre = "where: {sweep: point_3}\n".to_string() + &grows("{damper_x: 0.5, damper_y: 0.5}");
    assert_eq!(verdict(&centre, &table), Verdict::Reproduced);
    assert_eq!(cannot_fail(&centre, &table), Vec::<String>::new());
    assert_eq!(verdict(&grows("{damper_x: 0.5, damper_y: 0.5}"), &table), Verdict::Differs);
    let lenient = "where: {sweep: [point_1, point_3]}\n".to_string()
        + "claim: {grows_towards: {of: velocity_ratio, to: {damper_x: 0.5, damper_y: 0.5}, each: sweep, slack: 0.3}}\n"
        + "threshold_reason: for the test";
    assert_eq!(verdict(&lenient, &table), Verdict::Reproduced);
    let trend = "claim: {trend: {of: {largest: {of: force_x}}, along: sweep, direction: increasing}}";
    assert_eq!(verdict(trend, &table), Verdict::Differs);
}

#[test]
fn means_and_deviations_count_every_stretch_by_its_length() {
    // sin²x + 1 over whole periods, on points that crowd where the curve is high.
    let mut x: Vec<f64> = (0..=400).map(|i| std::f64::consts::PI * f64::from(i) / 100.0).collect();
    x.extend((1..200).map(|i| 1.4 + 0.0017 * f64::from(i)));
    x.sort_by(f64::total_cmp);
    let y: Vec<f64> = x.iter().map(|x| 1.0 + x.sin().powi(2)).collect();
    let table = Table::default().with(numbers("angular_frequency", "", "rad/s", x)).with(numbers(
        "velocity_amplitude_ratio",
        "",
        "",
        y,
    ));
    let table = complete(table, &["velocity_amplitude_ratio"], 0.0);
    let over = "of: velocity_amplitude_ratio, over: angular_frequency";
    for (value, from) in [
        ("1.500", format!("mean_over: {{{over}}}")),
        ("0.3536", format!("standard_deviation_over: {{{over}}}")),
        ("1.500", format!("mean_over: {{{over}, from: 1, to: 7.2831853}}")),
        ("1.708", format!("interpolated: {{{over}, at: 1.00 rad/s}}")),
        ("2.00", "largest: {of: velocity_amplitude_ratio}".to_owned()),
        ("1.00", "smallest: {of: velocity_amplitude_ratio}".to_owned()),
    ] {
        let body = format!("value: \"{value}\"\nfrom: {{{from}}}");
        assert_eq!(verdict(&body, &table), Verdict::Reproduced, "{body}: {}", judged(&body, &table).found);
        assert_eq!(cannot_fail(&body, &table), Vec::<String>::new(), "{body}");
    }
    // What the rounding of the place leaves open belongs to the number's error; a range that the table does not reach is none.
    let at = |place: &str| judged(&format!("value: \"1.7\"\nfrom: {{interpolated: {{{over}, at: {place}}}}}"), &table);
    let u = |place: &str| at(place).comparison.unwrap().u_num;
    assert!((u("1.0 rad/s") - 0.05 * 2_f64.sin()).abs() < 1e-3 && u("1.000 rad/s") < 1e-3);
    assert_eq!(verdict(&format!("value: \"1.5\"\nfrom: {{mean_over: {{{over}, to: 14}}}}"), &table), Verdict::Missing);
}

#[test]
fn an_unsound_entry_says_what_is_wrong_with_it() {
    for (body, says) in [
        ("peak: {of: a, over: b, at: 26 rad/s}\nvalue: \"1\"", "checked in one way"),
        ("peak: {of: a, over: b}", "without a printed number"),
        ("peak: {of: a, over: b, height: \"2\"}", "needs `which`"),
        ("peak: {of: a, over: b, which: {number: 0}, height: \"2\"}", "peaks are counted from 1"),
        ("peak: {of: a, over: b, at: 26 parsec}", "not a unit"),
        ("peak: {of: a, over: b, att: 26 rad/s}", "has no key `att`"),
        ("peak: {of: a, over: b, at: 26 rad/s}\ntolerance: {absolute: 1, reason: no}", "make the tolerance relative"),
        (
            "curve: {of: a, over: b, points: [[1, 2], [3, 4]], tube: {x: {absolute: 1}, y: {relative: 0.1}}}",
            "`threshold_reason`",
        ),
        (
            "curve: {of: a, over: b, points: [[1, 2], [0, 4]], tube: {x: {absolute: 1}, y: {relative: 0.1}}}\nthreshold_reason: r",
            "x increases from each to the next",
        ),
        (
            "curve: {of: a, over: b, points: [[1, 2], [3, 4]], tube: {x: {absolute: 0}, y: {relative: 0.1}}}\nthreshold_reason: r",
            "above zero",
        ),
        (
            "mode_shape: {of: a, over: x, like: {cantilever: 0}, mac: {at_least: 0.9}}\nthreshold_reason: r",
            "counted from 1",
        ),
        (
            "mode_shape: {of: a, over: x, like: {sine_product: [1, 2]}, mac: {at_least: 0.9}}\nthreshold_reason: r",
            "over: [x, y]",
        ),
        (
            "mode_shape: {of: a, over: x, like: {cantilever: 1}, mac: {at_least: 1}}\nthreshold_reason: r",
            "between 0 and 1",
        ),
        ("claim: {best_place: {of: a, at: {}}}", "a place is written as"),
        ("claim: {best_place: {of: a, at: {x: 1}, among: 3}}", "threshold_reason"),
        ("claim: {curve: {of: a, over: b}}", "a claim has no form `curve`"),
    ] {
        let problems = refused(body);
        assert!(problems.contains(says) && problems.contains("--> it.yaml:"), "{body}: {problems}");
    }
}

#[test]
fn two_lines_meet_between_the_points_where_they_change_places() {
    // At the centre 1 + x, at the force 2 x: they meet at x = 1, halfway between two points of the grid.
    let grid = [0.25, 0.75, 1.25, 1.75];
    let rows = |of: fn(f64) -> f64| grid.iter().map(move |x| of(*x));
    let table = |second: fn(f64) -> f64| {
        let places = [["centre"; 4], ["force"; 4]].concat();
        let table = Table::default()
            .with(texts("sweep", places))
            .with(numbers("mass_ratio", "", "", [grid, grid].concat()))
            .with(numbers("velocity_ratio", "", "", rows(|x| 1.0 + x).chain(rows(second)).collect()));
        complete(table, &["velocity_ratio"], 0.0)
    };
    let meeting = |value: &str| {
        format!("value: \"{value}\"\nfrom: {{meeting: {{of: velocity_ratio, over: mass_ratio, by: sweep}}}}")
    };
    let it = judged(&meeting("1.00"), &table(|x| 2.0 * x));
    let comparison = it.comparison.unwrap_or_else(|| panic!("{}", it.found));
    assert!(comparison.error().abs() < 1e-12 && (comparison.u_num - 0.25).abs() < 1e-12, "{}", it.found);
    assert_eq!(verdict(&meeting("3.00"), &table(|x| 2.0 * x)), Verdict::Differs);
    // Lines that never change places contradict a study that says where they do.
    assert_eq!(verdict(&meeting("1.00"), &table(|x| 0.5 * x)), Verdict::Differs);
    assert_eq!(cannot_fail(&meeting("1.00"), &table(|x| 2.0 * x)), Vec::<String>::new());
}

#[test]
fn one_line_lies_above_another_at_every_point_or_it_does_not() {
    let fillings = |lead: f64, run: f64| {
        let frequency = [20.0, 20.0, 30.0, 30.0, 40.0, 40.0].to_vec();
        let ratio = [1.0, 1.2, 2.0, 2.4, 1.5, 1.5 + lead].to_vec();
        let table = Table::default()
            .with(numbers("angular_frequency", "ω", "rad/s", frequency))
            .with(texts("filling", ["uniform", "optimised"].repeat(3)))
            .with(numbers("velocity_ratio", "ψ", "", ratio));
        complete(table, &["velocity_ratio"], run)
    };
    let claim = "claim: {line_above: {of: velocity_ratio, over: angular_frequency, by: filling, above: optimised, below: uniform}}";
    assert_eq!(verdict(claim, &fillings(0.1, 1e-6)), Verdict::Reproduced);
    assert_eq!(verdict(claim, &fillings(-0.1, 1e-6)), Verdict::Differs);
    assert_eq!(verdict(claim, &fillings(0.1, 0.2)), Verdict::Undecidable);
    assert_eq!(verdict(claim, &fillings(0.0, 1e-6)), Verdict::Undecidable);
    assert_eq!(cannot_fail(claim, &fillings(0.1, 1e-6)), [""; 0]);
    let found = judged(claim, &fillings(0.1, 1e-6)).found;
    assert!(found.contains("smallest lead 0.1 at ω = 40 rad/s"), "{found}");
    // Behind at one point of three, it is still ahead at most of them.
    let most = claim.replace("below: uniform", "below: uniform, points: most");
    assert_eq!(verdict(&most, &fillings(-0.1, 1e-6)), Verdict::Reproduced);
    assert!(judged(&most, &fillings(-0.1, 1e-6)).found.contains("ahead at 2 of 3 points, median lead 0.2"));
    let other_way = most.replace("above: optimised, below: uniform", "above: uniform, below: optimised");
    assert_eq!(verdict(&other_way, &fillings(-0.1, 1e-6)), Verdict::Differs);
    assert_eq!(verdict(&most, &fillings(0.1, 0.2)), Verdict::Undecidable);
    assert_eq!(cannot_fail(&most, &fillings(-0.1, 1e-6)), [""; 0]);
    let nobody = claim.replace("above: optimised", "above: uniform");
    assert!(refused(&nobody).contains("not above itself"));
}

#[test]
fn a_shape_is_largest_at_a_point_or_elsewhere() {
    let lists = |name: &str, list: &[f64]| Column::new(name, Data::FloatList(vec![list.to_vec()]));
    let shape = |values: &[f64]| {
        complete(Table::default().with(lists("x", &[0.0, 0.5, 1.0])).with(lists("rms_displacement", values)), &[], 0.0)
    };
    let free_end = "claim: {greatest_point: {of: rms_displacement, over: x, at: 0.98}}";
    assert_eq!(verdict(free_end, &shape(&[0.0, 0.3, 0.8])), Verdict::Reproduced);
    assert_eq!(verdict(free_end, &shape(&[0.0, 0.9, 0.8])), Verdict::Differs);
    assert_eq!(verdict(&free_end.replace("0.98", "0.4"), &shape(&[0.0, 0.9, 0.8])), Verdict::Reproduced);
    assert_eq!(verdict(free_end, &shape(&[0.0, f64::NAN, 0.8])), Verdict::Missing);
    assert_eq!(cannot_fail(free_end, &shape(&[0.0, 0.3, 0.8])), Vec::<String>::new());
}
