//! Verdicts: what a reader may rely on when the report says `reproduced`, `differs` or `missing`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use shotdamp::reference::{
    Judged, Price, Printed, ReferenceFile, TableState, Tables, Verdict, judge, load_reference, parse_reference,
    self_test,
};
use shotdamp::table::{Column, DEPENDS_ON, Data, Table};

/// What the text is called in messages.
const FILE: &str = "it.yaml";
const EXPERIMENT: &str = "ch3-example";

fn column(name: &str, unit: &str, data: Data) -> Column {
    Column { name: name.into(), unit: unit.into(), symbol: String::new(), data }
}

fn float(name: &str, cells: &[f64]) -> Column {
    column(name, "", Data::Float(cells.to_vec()))
}

fn text(name: &str, cells: &[&str]) -> Column {
    column(name, "", Data::Text(cells.iter().map(ToString::to_string).collect()))
}

/// A table with these columns, and what every table has besides: one run a row, none failed.
fn complete(columns: Vec<Column>) -> Table {
    let rows = columns[0].data.len();
    let mut table = Table { columns, ..Table::default() };
    for (name, label) in [("solver", "event_driven"), ("variant", "baseline"), ("failure", "")] {
        if table.column(name).is_none() {
            table.columns.push(text(name, &vec![label; rows]));
        }
    }
    if table.column("members").is_none() {
        table.columns.push(column("members", "", Data::Int(vec![1; rows])));
    }
    table
}

/// A velocity ratio with one peak over 21 force ratios from 1.5 to 3.5, highest at 2.5; nothing is uncertain.
fn peak() -> Table {
    let x: Vec<f64> = (0..21).map(|i| 1.5 + 0.1 * f64::from(i)).collect();
    let y: Vec<f64> = x.iter().map(|x| 3.0 - (x - 2.5) * (x - 2.5)).collect();
    let zero = vec![0.0; x.len()];
    complete(vec![
        float("force_ratio", &x),
        float("velocity_ratio", &y),
        float("velocity_ratio_num", &zero),
        float("velocity_ratio_spread", &zero),
    ])
}

/// One row a variant, each with a velocity ratio.
fn variants(rows: &[(&str, f64)], num: f64, spread: f64, members: i64) -> Table {
    complete(vec![
        text("variant", &rows.iter().map(|row| row.0).collect::<Vec<_>>()),
        float("velocity_ratio", &rows.iter().map(|row| row.1).collect::<Vec<_>>()),
        float("velocity_ratio_num", &vec![num; rows.len()]),
        float("velocity_ratio_spread", &vec![spread; rows.len()]),
        column("members", "", Data::Int(vec![members; rows.len()])),
        text("failure", &vec![""; rows.len()]),
    ])
}

fn lines(solvers: &[(&str, [f64; 5])]) -> Table {
    let mut x = Vec::new();
    let mut solver = Vec::new();
    let mut y = Vec::new();
    for (name, values) in solvers {
        for (i, value) in (0..5u32).zip(values) {
            x.push(f64::from(i));
            solver.push(*name);
            y.push(*value);
        }
    }
    complete(vec![float("force_ratio", &x), text("solver", &solver), float("velocity_ratio", &y)])
}

fn entry(body: &str) -> ReferenceFile {
    let indented: String = body.trim().lines().map(|line| format!("    {}\n", line.trim())).collect();
    let text = format!("entries:\n  - id: it\n    place: s. 1\n    says: Something.\n{indented}");
    parse_reference(EXPERIMENT, FILE, &text).unwrap_or_else(|problems| panic!("{problems}\n{text}"))
}

fn judged_as(file: &ReferenceFile, state: TableState<'_>, fitted: &[&str]) -> Judged {
    let tables = Tables::from([(EXPERIMENT.to_string(), state)]);
    let fitted: BTreeSet<String> = fitted.iter().map(ToString::to_string).collect();
    judge(file, &tables, &fitted).remove(0)
}

fn judged(body: &str, table: &Table) -> Judged {
    judged_as(&entry(body), TableState::Present(table), &[])
}

fn verdict(body: &str, table: &Table) -> Verdict {
    judged(body, table).verdict
}

fn broken(body: &str, table: &Table) -> Vec<String> {
    let tables = Tables::from([(EXPERIMENT.to_string(), TableState::Present(table))]);
    self_test(&entry(body), &tables).into_iter().map(|failure| failure.reason.to_string()).collect()
}

const CELL: &str = "value: \"1.52\"\nfrom: {cell: {of: velocity_ratio}}";
const OPTIMUM: &str = "value: \"2.5\"\nfrom: {argmax: {of: velocity_ratio, over: force_ratio}}";

#[test]
fn half_a_unit_of_the_last_printed_digit_is_the_uncertainty_of_a_datum() {
    for (printed, value, half_unit) in [
        ("2.5", 2.5, 0.05),
        ("2.50", 2.5, 0.005),
        ("1.99e-1", 0.199, 5e-4),
        ("149", 149.0, 0.5),
        ("0.8681", 0.8681, 5e-5),
        ("5.03 Hz", 5.03, 5e-3),
        ("427.3 mm/s", 427.3, 0.05),
    ] {
        let parsed = Printed::parse(printed).expect(printed);
        assert_eq!((parsed.value(), parsed.half_unit()), (value, half_unit), "{printed}");
    }
    let (value, half_unit) = Printed::parse("427.3 mm/s").unwrap().converted_to("m/s").unwrap();
    assert!((value - 0.4273).abs() < 1e-15 && (half_unit - 5e-5).abs() < 1e-18);
    assert_eq!(Printed::parse("427.3 mm/s").unwrap().converted_to("m"), None);
    for nonsense in ["", "about 2", "NaN", "inf", "1e999", "2,5", "5 parsec", "0x10", "1e-400"] {
        assert!(Printed::parse(nonsense).is_err(), "{nonsense}");
    }
}

#[test]
fn an_optimum_at_the_end_of_the_range_is_said_to_lie_there() {
    let end = "; the optimum is at the end of the range, f′ = 2.4, and may lie beyond";
    let until =
        |to: &str| OPTIMUM.replace("force_ratio}", &format!("force_ratio, where: {{force_ratio: {{to: {to}}}}}}}"));
    let found = |body: &str| judged(body, &peak()).found;
    assert!(!found(&until("2.6")).contains("end of the range"), "{}", found(&until("2.6")));
    assert!(found(&until("2.45")).ends_with(end), "{}", found(&until("2.45")));
    let claim = "claim: {between: {value: {argmax: {of: velocity_ratio, over: force_ratio, where: {force_ratio: {to: 2.45}}}}, from: 2}}";
    let one = judged(&format!("{claim}\nthreshold_reason: none"), &peak());
    assert!(one.verdict == Verdict::Reproduced && one.found.ends_with(end), "{}", one.found);
    // There is nothing beyond the edge of a plate, or below zero.
    let edge = |at: &[f64], of: &str| {
        let table = complete(vec![float(of, at), float("velocity_ratio", &[1.0, 2.0, 3.0])]);
        judged(&OPTIMUM.replace("force_ratio", of), &table).found
    };
    assert!(!edge(&[0.0, 0.5, 1.0], "damper_x").contains("end of the range"));
    assert!(edge(&[0.0, 0.5, 0.9], "damper_x").contains("x/Lx = 0.9"), "{}", edge(&[0.0, 0.5, 0.9], "damper_x"));
}

#[test]
fn a_verdict_tells_what_was_simulated_for_it() {
    let mut table = variants(&[("baseline", 1.52), ("stop_length=0.05", 1.53)], 0.0, 0.1, 9);
    table.columns.push(column("events", "", Data::Int(vec![490, 500])));
    assert_eq!(judged(CELL, &table).price, Price { rows: 2, runs: 18, events: 990 });
    // Rows that a condition leaves out are not paid for.
    let mut table = peak();
    table.columns.push(column("events", "", Data::Int(vec![10; 21])));
    let below = format!("where: {{force_ratio: {{to: 2.5}}}}\n{OPTIMUM}");
    assert_eq!(judged(&below, &table).price, Price { rows: 11, runs: 11, events: 110 });
    assert_eq!(judged_as(&entry(CELL), TableState::NotRun, &[]).price, Price::default());
    let still = variants(&[("baseline", 1.52)], 0.0, 0.0, 0);
    assert_eq!(judged(CELL, &still).price, Price { rows: 1, runs: 0, events: 0 });
}

#[test]
fn a_maximum_tells_what_motion_it_is_of() {
    let mut table = peak();
    let rows = table.rows();
    let top = table.floats("force_ratio").unwrap().iter().position(|x| (x - 2.5).abs() < 0.01).unwrap();
    let motion = |row: usize| if row == top { "periodic 1:2" } else { "chaotic" };
    table.columns.push(column("motion", "", Data::Text((0..rows).map(|row| motion(row).into()).collect())));
    table.columns.push(column("largest_multiplier", "", Data::Float(vec![0.72; rows])));
    let found = judged(OPTIMUM, &table).motion.unwrap();
    assert_eq!(found.kinds, [("chaotic".to_owned(), 20), ("periodic".to_owned(), 1)].into());
    assert_eq!(found.at, ["f′ = 2.5: periodic 1:2, largest multiplier 0.72"]);
    assert_eq!(judged(OPTIMUM, &peak()).motion, None, "where no motion was measured");
}

#[test]
fn a_value_is_reproduced_within_twice_the_validation_uncertainty_and_differs_beyond() {
    assert_eq!(verdict(CELL, &variants(&[("baseline", 1.5299)], 0.0, 0.0, 1)), Verdict::Reproduced);
    assert_eq!(verdict(CELL, &variants(&[("baseline", 1.5301)], 0.0, 0.0, 1)), Verdict::Differs);
    // An error of the run of its own widens the tolerance.
    assert_eq!(verdict(CELL, &variants(&[("baseline", 1.5301)], 0.003, 0.0, 1)), Verdict::Reproduced);
    let comparison = judged(CELL, &variants(&[("baseline", 1.5301)], 0.0, 0.0, 1)).comparison.unwrap();
    assert!((comparison.error() - 0.0101).abs() < 1e-12 && (comparison.u_val() - 0.005).abs() < 1e-12);
    assert!((comparison.digits() - 2.177).abs() < 1e-3);
}

/// 3.378 ± 0.1 and 3.365 ± 0.1: the difference, 0.013, is known to ± √2 · 0.1.
#[test]
fn a_claim_that_chance_may_decide_shows_the_uncertainty_of_its_difference() {
    let found = |values: [f64; 2], num: f64| {
        let mut table = variants(&[("baseline", values[0]), ("baseline", values[1])], num, 0.0, 1);
        table.columns.push(float("gap_ratio", &[50.0, 90.0]));
        let cell = |gap: u32| format!("{{cell: {{of: velocity_ratio, where: {{gap_ratio: {gap}}}}}}}");
        let judged = judged(&format!("claim: {{greatest_first: [{}, {}]}}", cell(50), cell(90)), &table);
        (judged.verdict, judged.found)
    };
    let (verdict, text) = found([3.378, 3.365], 0.05);
    assert!(verdict == Verdict::Undecidable && text.ends_with("3.378 ≈ 3.365; margin 0.013 ± 0.14"), "{text}");
    let (verdict, text) = found([3.378, 3.165], 0.05);
    assert!(verdict == Verdict::Reproduced && text.ends_with("3.378 > 3.165; margin 0.21 ± 0.14"), "{text}");
    let (verdict, text) = found([3.355, 3.355], 0.05);
    assert!(verdict == Verdict::Undecidable && text.ends_with("3.355 ≈ 3.355; margin 0 ± 0.14"), "{text}");
    // To nine digits, and known so well: neither is greater. One digit less, and it is anyone's guess.
    let (verdict, text) = found([3.355, 3.355 * (1.0 + 2e-10)], 3e-10);
    assert!(verdict == Verdict::Differs && text.ends_with("3.355 = 3.355"), "{text}");
    let (verdict, text) = found([3.355, 3.355 * (1.0 + 2e-9)], 3e-9);
    assert!(verdict == Verdict::Undecidable && text.contains("3.355 ≈ 3.355"), "{text}");
    // Beyond doubt, the numbers say enough.
    let (verdict, text) = found([3.378, 2.027], 0.05);
    assert!(verdict == Verdict::Reproduced && text.ends_with("3.378 > 2.027"), "{text}");
    // A limit in per cent has a margin in per cent.
    let mut table = variants(&[("baseline", 3.378), ("baseline", 3.258)], 0.05, 0.0, 1);
    table.columns.push(float("gap_ratio", &[50.0, 90.0]));
    let cell = |gap: u32| format!("{{cell: {{of: velocity_ratio, where: {{gap_ratio: {gap}}}}}}}");
    let equal = format!(
        "claim: {{equal: {{values: [{}, {}], within: {{relative: 0.05}}}}}}\nthreshold_reason: for the test",
        cell(50),
        cell(90)
    );
    let text = judged(&equal, &table).found;
    assert!(text.ends_with("3.6 % apart (5 % allowed); margin 1.4 ± 4.2 %"), "{text}");
}

#[test]
fn unstated_inputs_widen_the_tolerance_by_half_their_range_each_in_quadrature() {
    let table = variants(
        &[("baseline", 1.56), ("delta=1", 1.50), ("delta=2", 1.58), ("gravity=9.80", 1.56), ("gravity=9.82", 1.62)],
        0.0,
        0.0,
        1,
    );
    let judged = judged(CELL, &table);
    let u_input = judged.comparison.unwrap().u_input;
    assert!((u_input - 0.04f64.hypot(0.03)).abs() < 1e-12, "{u_input}");
    assert_eq!(judged.verdict, Verdict::Reproduced);
    assert_eq!(judged.robust, Some((4, 4)));
}

#[test]
fn agreement_that_says_nothing_is_no_reproduction() {
    // The inputs that the study does not state move the value by a third: any value near would agree.
    let wide = variants(&[("baseline", 1.4), ("delta=1", 1.1), ("delta=2", 2.1)], 0.0, 0.0, 1);
    assert_eq!(verdict(CELL, &wide), Verdict::Blocked);
    // The published run is one member of an ensemble that spreads over a fifth.
    assert_eq!(verdict(CELL, &variants(&[("baseline", 1.4)], 0.0, 0.3, 32)), Verdict::Undecidable);
    // A spread below a tenth is an uncertainty like any other.
    assert_eq!(verdict(CELL, &variants(&[("baseline", 1.55)], 0.0, 0.03, 32)), Verdict::Reproduced);
    // Outside the spread it differs, chaotic or not.
    assert_eq!(verdict(CELL, &variants(&[("baseline", 2.3)], 0.0, 0.3, 32)), Verdict::Differs);
}

#[test]
fn an_entry_that_chose_an_assumption_is_fitted_and_proves_nothing() {
    let file = entry(CELL);
    let near = variants(&[("baseline", 1.525), ("delta=1", 1.1), ("delta=2", 2.1)], 0.0, 0.0, 1);
    let fitted = ["ch3-example/it"];
    assert_eq!(judged_as(&file, TableState::Present(&near), &fitted).verdict, Verdict::Fitted);
    let far = variants(&[("baseline", 3.0)], 0.0, 0.0, 1);
    assert_eq!(judged_as(&file, TableState::Present(&far), &fitted).verdict, Verdict::Differs);
}

#[test]
fn a_tolerance_set_by_hand_holds_and_is_shown_with_its_reason() {
    let body = format!("{CELL}\ntolerance: {{relative: 0.03, reason: read off a plot}}");
    let judged = judged(&body, &variants(&[("baseline", 1.56)], 0.0, 0.0, 1));
    assert_eq!(judged.verdict, Verdict::Reproduced);
    assert_eq!(judged.tolerance_reason.as_deref(), Some("read off a plot"));
    assert!((judged.comparison.unwrap().tolerance_by_hand.unwrap() - 0.0456).abs() < 1e-12);
    assert_eq!(verdict(&body, &variants(&[("baseline", 1.57)], 0.0, 0.0, 1)), Verdict::Differs);
}

#[test]
fn a_number_is_blocked_by_the_inputs_that_move_it_most_and_a_claim_by_those_that_it_names() {
    let moves = [("baseline", 1.52), ("stop_length=0.1", 2.5), ("gravity=9.8", 1.53)];
    let number =
        judged(&format!("{CELL}\nexpected: blocked\nexplanation: Not stated."), &variants(&moves, 0.0, 0.0, 1));
    assert_eq!((number.verdict, number.blocked_by), (Verdict::Blocked, vec!["stop_length".to_owned()]));
    assert!(number.found.contains("stop_length") && number.found.contains("1.52"), "{}", number.found);
    // Beyond all that the moves explain a number differs, whatever it waits for.
    let far = judged(CELL, &variants(&[("baseline", 9.0), ("stop_length=0.1", 10.0)], 0.0, 0.0, 1));
    assert_eq!(far.verdict, Verdict::Differs);

    let claim = "claim: {between: {value: {cell: {of: velocity_ratio}}, to: 1.6}}\nthreshold_reason: for the test\n\
                 expected: blocked\nblocked_by: [stop length]\nexplanation: Not stated.";
    let claim = judged(claim, &variants(&moves, 0.0, 0.0, 1));
    assert_eq!((claim.verdict, claim.robust), (Verdict::Blocked, Some((1, 2))));
    assert!(claim.found.contains("stop length") && claim.moved.iter().all(|moved| moved.verdict == Verdict::Blocked));
}

#[test]
fn nothing_that_could_not_be_compared_reads_as_a_pass() {
    let good = variants(&[("baseline", 1.52), ("delta=1", 1.52)], 0.0, 0.0, 1);
    let file = entry(CELL);
    assert_eq!(judged_as(&file, TableState::Present(&good), &[]).verdict, Verdict::Reproduced);
    let with = |change: &dyn Fn(&mut Table)| {
        let mut table = good.clone();
        change(&mut table);
        table
    };
    let damaged = [
        with(&|table| table.columns.retain(|column| column.name != "velocity_ratio")),
        with(&|table| table.columns[0] = text("variant", &["delta=2", "delta=1"])),
        with(&|table| table.columns[1] = float("velocity_ratio", &[f64::NAN, 1.52])),
        with(&|table| table.columns[1] = float("velocity_ratio", &[1.52, f64::NAN])),
        with(&|table| table.columns[1] = text("velocity_ratio", &["1.52", "1.52"])),
        with(&|table| table.columns[2] = float("velocity_ratio_num", &[f64::NAN, 0.0])),
        with(&|table| table.columns[5] = text("failure", &["too many events", ""])),
        with(&|table| table.columns[1].unit = "m/s".into()),
        Table::default(),
    ];
    for table in &damaged {
        let judged = judged_as(&file, TableState::Present(table), &["ch3-example/it"]);
        assert_eq!(judged.verdict, Verdict::Missing, "{table:?}");
        assert!(!judged.as_expected() && !judged.found.is_empty());
    }
    // The unit of a column that is known by its name is held against when the file is read.
    let lengths = entry("value: \"3.4 mm\"\nfrom: {cell: {of: counted}}");
    let counted = with(&|table| {
        table.columns.push(float("counted", &[1.52, 1.52]));
        table.columns.push(float("counted_num", &[0.0, 0.0]));
        table.columns.push(float("counted_spread", &[0.0, 0.0]));
    });
    let judged = judged_as(&lengths, TableState::Present(&counted), &[]);
    assert_eq!(judged.verdict, Verdict::Missing);
    assert!(judged.found.contains("`3.4 mm` cannot be held against a column without unit"), "{}", judged.found);
    for state in [TableState::Stale, TableState::NotRun, TableState::Failed("no disk".into())] {
        assert_eq!(judged_as(&file, state, &[]).verdict, Verdict::Missing);
    }
    assert_eq!(judge(&file, &Tables::new(), &BTreeSet::new())[0].verdict, Verdict::Missing);
}

/// What an entry reads beside its measure: what chooses the rows, what they stand along, how uncertain they are, when.
#[test]
fn a_gap_in_anything_that_an_entry_reads_is_no_smaller_table() {
    let chosen = format!("{OPTIMUM}\nwhere: {{force_ratio: {{from: 2}}}}");
    for name in ["variant", "solver", "failure", "members", "velocity_ratio_num", "velocity_ratio_spread"] {
        let mut table = peak();
        table.columns.retain(|column| column.name != name);
        assert_eq!(verdict(&chosen, &table), Verdict::Missing, "without {name}");
    }
    let mut table = peak();
    let Data::Float(cells) = &mut table.columns[0].data else { panic!("force ratios are numbers") };
    cells[3] = f64::NAN;
    assert_eq!(verdict(OPTIMUM, &table), Verdict::Missing, "a point without a place");
    assert_eq!(verdict(&chosen, &table), Verdict::Missing, "a point that may or may not be meant");
    // A part of a union that sweeps something else has none of these places, which is no gap.
    let Data::Float(cells) = &mut table.columns[0].data else { panic!("force ratios are numbers") };
    cells[4..7].fill(f64::NAN);
    let part = |row| if (3..7).contains(&row) { "other" } else { "this" };
    table.columns.push(text("sweep", &(0..21).map(part).collect::<Vec<_>>()));
    assert_eq!(verdict(OPTIMUM, &table), Verdict::Reproduced);
}

#[test]
fn a_maximum_is_known_no_better_than_the_grid_that_found_it() {
    let comparison = judged(OPTIMUM, &peak()).comparison.unwrap();
    assert!((comparison.simulated - 2.5).abs() < 1e-12 && (comparison.u_num - 0.05).abs() < 1e-12);
    // Half of the points: twice the uncertainty, still good; a tenth of them would say nothing.
    let coarse = |step: usize| {
        let mut table = peak();
        for column in &mut table.columns {
            match &mut column.data {
                Data::Float(cells) => *cells = cells.iter().copied().step_by(step).collect(),
                Data::Int(cells) => *cells = cells.iter().copied().step_by(step).collect(),
                Data::Text(cells) => *cells = cells.iter().cloned().step_by(step).collect(),
                Data::FloatList(_) => {}
            }
        }
        table
    };
    assert_eq!(verdict(OPTIMUM, &coarse(2)), Verdict::Reproduced);
    assert_eq!(verdict(OPTIMUM, &coarse(5)), Verdict::Undecidable);
}

#[test]
fn the_baseline_and_the_event_driven_solver_are_meant_unless_an_entry_says_otherwise() {
    let table = lines(&[("event_driven", [1.0, 1.1, 1.5, 1.1, 1.0]), ("fixed_step_1e-2s", [1.0, 1.1, 1.9, 1.1, 1.0])]);
    let maximum = "value: \"1.5\"\nfrom: {maximum: {of: velocity_ratio, over: force_ratio}}";
    assert_eq!(verdict(maximum, &table), Verdict::Reproduced);
    assert_eq!(verdict(&format!("{maximum}\nwhere: {{solver: fixed_step_1e-2s}}"), &table), Verdict::Differs);
    let ambiguous = format!("{maximum}\nwhere: {{solver: [event_driven, fixed_step_1e-2s]}}");
    assert_eq!(verdict(&ambiguous, &table), Verdict::Missing);
}

#[test]
fn four_impacts_are_not_five() {
    let table = |count: f64| {
        let mut table = variants(&[("baseline", count)], 0.0, 0.0, 1);
        for column in &mut table.columns {
            column.name = column.name.replace("velocity_ratio", "floor_impacts");
        }
        table
    };
    let five = "value: \"5\"\nfrom: {cell: {of: floor_impacts}}";
    assert_eq!(verdict(five, &table(5.0)), Verdict::Reproduced);
    assert_eq!(verdict(five, &table(4.0)), Verdict::Differs);
}

#[test]
fn one_point_alone_is_no_parting_of_two_lines() {
    let table = lines(&[("event_driven", [0.0, 1.0, 2.0, 1.0, 0.5]), ("fixed_step_1e-2s", [0.0, 1.5, 2.0, 1.5, 2.0])]);
    let parting = "value: \"3\"\nfrom: {parting: {of: velocity_ratio, over: force_ratio, by: solver, fraction: 0.1}}";
    let comparison = judged(parting, &table).comparison.unwrap();
    assert!((comparison.simulated - 3.0).abs() < 1e-12, "{comparison:?}");
}

#[test]
fn lines_may_be_told_apart_by_numbers() {
    let mut table = lines(&[("light", [1.0, 1.2, 1.4, 1.6, 1.8]), ("heavy", [1.1, 1.3, 1.5, 1.7, 1.9])]);
    table.columns.retain(|column| column.name != "solver");
    table.columns.push(text("solver", &["event_driven"; 10]));
    table.columns.push(float("mass_ratio", &[[0.05; 5], [0.1; 5]].concat()));
    let above = |one: &str, other: &str| {
        format!(
            "claim: {{line_above: {{of: velocity_ratio, over: force_ratio, by: mass_ratio, above: {one}, below: {other}}}}}"
        )
    };
    assert_eq!(verdict(&above("0.1", "0.05"), &table), Verdict::Reproduced);
    assert_eq!(verdict(&above("0.05", "0.1"), &table), Verdict::Differs);
}

#[test]
fn numbers_of_a_curve_are_read_as_a_study_quotes_them() {
    let table = lines(&[("event_driven", [0.0, 1.0, 2.0, 1.0, 0.5]), ("fixed_step_1e-2s", [0.0, 1.0, 2.0, 1.5, 2.0])]);
    for (value, from) in [
        ("0.5", "end: {of: velocity_ratio, over: force_ratio, end: high}"),
        ("1", "cell: {of: velocity_ratio, where: {force_ratio: 3}}"),
        ("0.90", "mean: {of: velocity_ratio}"),
        ("0", "minimum: {of: velocity_ratio, over: force_ratio}"),
        ("2", "argmax: {of: velocity_ratio, over: force_ratio}"),
        ("1.0", "crossing: {of: velocity_ratio, over: force_ratio, level: 1, direction: increasing}"),
        ("2", "first_above: {of: velocity_ratio, over: force_ratio, level: 1}"),
        ("3", "parting: {of: velocity_ratio, over: force_ratio, by: solver, fraction: 0.1}"),
        ("1.5", "largest_step_back: {of: velocity_ratio, over: force_ratio, direction: increasing}"),
        ("2", "at_maximum: {of: velocity_ratio, over: force_ratio, read: force_ratio}"),
        ("4.0", "ratio: {of: {number: 2}, to: {end: {of: velocity_ratio, over: force_ratio, end: high}}}"),
        ("0.02", "times: {factor: 0.01, of: {maximum: {of: velocity_ratio, over: force_ratio}}}"),
    ] {
        let judged = judged(&format!("value: \"{value}\"\nfrom: {{{from}}}"), &table);
        let comparison = judged.comparison.unwrap_or_else(|| panic!("{from}: {}", judged.found));
        assert!(comparison.error().abs() < 1e-12, "{from}: {}", judged.found);
    }
    // What does not happen is a difference, not a gap in the data.
    let never = "value: \"2\"\nfrom: {first_above: {of: velocity_ratio, over: force_ratio, level: 7}}";
    assert_eq!(verdict(never, &table), Verdict::Differs);
}

#[test]
fn what_a_claim_found_says_what_its_numbers_are() {
    let table = lines(&[("event_driven", [1.0, 1.5, 2.0, 1.5, 1.0])]);
    let line = "of: velocity_ratio, over: force_ratio";
    for (claim, found) in [
        ("claim: {above: {of: velocity_ratio, level: 0.99}}".to_owned(), "true: velocity ratio 1, the lowest"),
        (
            format!(
                "claim: {{between: {{value: {{maximum: {{{line}}}}}, from: 1, to: 3}}}}\nthreshold_reason: for the test"
            ),
            "true: largest velocity ratio 2 (required: 1 to 3)",
        ),
        (
            format!("claim: {{greatest_first: [{{maximum: {{{line}}}}}, {{end: {{{line}, end: high}}}}]}}"),
            "true: largest velocity ratio 2 > velocity ratio 1",
        ),
        (
            format!("claim: {{greatest_first: [{{maximum: {{{line}}}}}, {{number: 1.5}}]}}"),
            "true: largest velocity ratio 2 > 1.5",
        ),
    ] {
        assert!(judged(&claim, &table).found.starts_with(found), "{claim}: {}", judged(&claim, &table).found);
    }
    // Two numbers that no sensible number of digits tells apart are equal.
    let close = lines(&[("event_driven", [1.0, 1.0, 1.0 + 4e-13, 1.0, 1.0])]);
    let claim = format!("claim: {{greatest_first: [{{maximum: {{{line}}}}}, {{end: {{{line}, end: high}}}}]}}");
    assert!(
        judged(&claim, &close).found.contains("velocity ratio 1 = velocity ratio 1"),
        "{}",
        judged(&claim, &close).found
    );
    // A figure in the name of a column is no number of the claim: explanations count the numbers that they cite.
    let gaps = complete(vec![float("gap_1", &[0.002]), float("gap_3", &[0.005])]);
    let found = judged("claim: {greatest_first: [{cell: {of: gap_1}}, {cell: {of: gap_3}}]}", &gaps).found;
    assert_eq!(found, "false: 0.002 < 0.005");
}

/// Claims over lines of five points, with the verdict on each line.
#[test]
fn claims_hold_fail_and_stay_open_as_their_margins_say() {
    let rising = [1.0, 1.2, 1.4, 1.6, 1.8];
    let dented = [1.0, 1.2, 1.19, 1.6, 1.8];
    let peaked = [1.0, 1.5, 2.0, 1.5, 1.0];
    let comb = [1.0, 2.0, 1.0, 2.0, 1.0];
    let saturating = [1.0, 1.9, 1.99, 2.0, 2.0];
    let line = "of: velocity_ratio, over: force_ratio";
    let by_hand = "threshold_reason: for the test";
    for (claim, holds, fails) in [
        (format!("claim: {{monotone: {{{line}, direction: increasing}}}}"), rising, dented),
        (format!("claim: {{monotone: {{{line}, direction: increasing, slack: 0.05}}}}\n{by_hand}"), dented, peaked),
        (format!("claim: {{monotone: {{{line}, direction: decreasing, part: after_maximum}}}}"), peaked, rising),
        (format!("claim: {{between: {{value: {{argmax: {{{line}}}}}, from: 1, to: 3}}}}\n{by_hand}"), peaked, rising),
        (
            format!("claim: {{greatest_first: [{{maximum: {{{line}}}}}, {{end: {{{line}, end: high}}}}]}}"),
            peaked,
            rising,
        ),
        (
            format!(
                "claim: {{equal: {{values: [{{end: {{{line}, end: low}}}}, {{end: {{{line}, end: high}}}}], within: {{relative: 0.01}}}}}}\n{by_hand}"
            ),
            peaked,
            rising,
        ),
        (
            format!(
                "claim: {{apart: {{values: [{{end: {{{line}, end: low}}}}, {{end: {{{line}, end: high}}}}], by: {{relative: 0.01}}}}}}\n{by_hand}"
            ),
            rising,
            peaked,
        ),
        ("claim: {above: {of: velocity_ratio, level: 0.99}}".to_string(), rising, [1.0, 0.98, 1.0, 1.0, 1.0]),
        ("claim: {below: {of: velocity_ratio, level: 1.9}}".to_string(), rising, peaked),
        (format!("claim: {{linear: {{{line}, within: 0.05}}}}\n{by_hand}"), rising, saturating),
        (format!("claim: {{levels_off: {{{line}, from: 2, within: 0.05}}}}\n{by_hand}"), saturating, rising),
        (format!("claim: {{greatest_at_end: {{{line}, end: high}}}}"), rising, peaked),
        (format!("claim: {{peaks: {{{line}, prominence: 0.3, at_least: 2}}}}\n{by_hand}"), comb, peaked),
        (format!("claim: {{peaks: {{{line}, prominence: 0.3, at_most: 1}}}}\n{by_hand}"), peaked, comb),
        (
            "claim: {onsets: {over: force_ratio, order: [{of: velocity_ratio, above: 1}, {of: velocity_ratio, above: 1.7}]}}".to_string(),
            rising,
            comb,
        ),
    ] {
        let (good, bad) = (lines(&[("event_driven", holds)]), lines(&[("event_driven", fails)]));
        assert_eq!(verdict(&claim, &good), Verdict::Reproduced, "{claim}: {}", judged(&claim, &good).found);
        assert_eq!(verdict(&claim, &bad), Verdict::Differs, "{claim}: {}", judged(&claim, &bad).found);
        assert_eq!(broken(&claim, &good), Vec::<String>::new(), "{claim}");
    }
    // One point neither rises nor falls.
    let one = complete(vec![
        float("force_ratio", &[1.0]),
        text("solver", &["event_driven"]),
        float("velocity_ratio", &[1.0]),
    ]);
    assert_eq!(verdict(&format!("claim: {{monotone: {{{line}, direction: increasing}}}}"), &one), Verdict::Missing);
    // A step back that the points' own errors cover cannot be told from none.
    let mut table = lines(&[("event_driven", dented)]);
    table.columns.push(float("velocity_ratio_num", &[0.01; 5]));
    table.columns.push(float("velocity_ratio_spread", &[0.0; 5]));
    assert_eq!(
        verdict(&format!("claim: {{monotone: {{{line}, direction: increasing}}}}"), &table),
        Verdict::Undecidable
    );
}

#[test]
fn lines_and_columns_are_compared_with_each_other() {
    let alike = lines(&[("event_driven", [1.0, 1.2, 1.4, 1.6, 1.8]), ("fixed_step_1e-2s", [1.0, 1.21, 1.4, 1.6, 1.8])]);
    let apart = lines(&[("event_driven", [1.0, 1.2, 1.4, 1.6, 1.8]), ("fixed_step_1e-2s", [1.0, 1.2, 1.4, 1.6, 2.8])]);
    let agree = "claim: {lines_agree: {of: velocity_ratio, over: force_ratio, by: solver, within: {relative: 0.02}}}\nthreshold_reason: for the test";
    assert_eq!(verdict(agree, &alike), Verdict::Reproduced);
    assert_eq!(verdict(agree, &apart), Verdict::Differs);
    let trend = "claim: {trend: {of: {maximum: {of: velocity_ratio, over: force_ratio}}, along: solver, direction: increasing}}";
    assert_eq!(verdict(trend, &alike), Verdict::Differs);
    assert_eq!(verdict(trend, &apart), Verdict::Reproduced);

    let mut both = lines(&[("event_driven", [1.0, 1.2, 1.4, 1.6, 1.8])]);
    both.columns.push(float("displacement_ratio", &[1.0, 1.2, 1.4, 1.61, 1.8]));
    let columns = |within: f64| {
        format!(
            "claim: {{columns_agree: {{columns: [velocity_ratio, displacement_ratio], within: {{relative: {within}}}}}}}\nthreshold_reason: for the test"
        )
    };
    assert_eq!(verdict(&columns(0.01), &both), Verdict::Reproduced);
    assert_eq!(verdict(&columns(0.001), &both), Verdict::Differs);
}

#[test]
fn time_histories_are_judged_along_their_samples() {
    let mut table = variants(&[("baseline", 1.5)], 0.0, 0.0, 1);
    let mut history = |name: &str, unit: &str, samples: &[f64]| {
        table.columns.push(column(name, unit, Data::FloatList(vec![samples.to_vec()])));
    };
    history("time", "s", &[52.302, 52.312, 52.500, 52.510]);
    history("particle_displacement", "m", &[0.1, -0.1, -0.1, 0.2]);
    history("rigid_floor", "m", &[0.0, 0.0, 0.0, 0.0]);
    history("rms_acceleration", "g", &[3.0, 2.0, 1.0, 1.0]);
    history("floor_displacement", "m", &[3.0, 2.0, 1.0, 1.0]);
    assert_eq!(
        verdict("claim: {paths_cross: {of: particle_displacement, other: rigid_floor}}", &table),
        Verdict::Reproduced
    );
    let crosses = |of: &str| verdict(&format!("claim: {{paths_cross: {{of: {of}, other: rigid_floor}}}}"), &table);
    assert_eq!(crosses("floor_displacement"), Verdict::Differs);
    assert_eq!(crosses("rms_acceleration"), Verdict::Missing, "of another unit");
    let falls = "claim: {path_monotone: {of: rms_acceleration, direction: decreasing}}";
    assert_eq!(verdict(falls, &table), Verdict::Reproduced);
    let late =
        falls.replace("rms_acceleration", "particle_displacement").replace("decreasing", "increasing, after: 52.31");
    assert_eq!(verdict(&late, &table), Verdict::Reproduced);
    let impact = "value: 52.31 s
        from: {nearest_passage: {of: particle_displacement, through: rigid_floor, direction: decreasing, to: 52.31}}";
    assert_eq!(verdict(impact, &table), Verdict::Reproduced);
    assert_eq!(verdict(&impact.replace("decreasing", "increasing"), &table), Verdict::Differs);
    // Halfway between the two samples where it passes the floor: 2.5 g.
    let read = impact.replace("52.31 s", "2.5 g").replace("to: 52.31}", "to: 52.31, read: rms_acceleration}");
    let at_impact = judged(&read, &table).comparison.unwrap();
    assert!(at_impact.error().abs() < 1e-12 && (at_impact.u_num - 0.5).abs() < 1e-12);
    let lowest = "value: \"1.0 g\"\nfrom: {path_minimum: {of: rms_acceleration}}";
    let highest = "value: \"3.0 g\"\nfrom: {path_maximum: {of: rms_acceleration}}";
    assert_eq!([lowest, highest].map(|body| verdict(body, &table)), [Verdict::Reproduced; 2]);
    for body in [
        falls,
        &late,
        impact,
        &read,
        lowest,
        highest,
        "claim: {paths_cross: {of: particle_displacement, other: rigid_floor}}",
    ] {
        assert_eq!(broken(body, &table), Vec::<String>::new(), "{body}");
    }
    for body in [late.as_str(), impact] {
        let mut table = table.clone();
        let time = table.columns.iter_mut().find(|column| column.name == "time").unwrap();
        time.data = Data::FloatList(vec![vec![52.302, f64::NAN, 52.500, 52.510]]);
        assert_eq!(verdict(body, &table), Verdict::Missing, "{body}");
    }
}

#[test]
fn another_experiments_table_can_be_part_of_a_claim() {
    let here = lines(&[("event_driven", [1.0, 1.2, 1.4, 1.6, 1.8])]);
    let there = lines(&[("event_driven", [1.0, 1.2, 1.4, 1.6, 2.8])]);
    let file = entry(
        "claim: {greatest_first: [{maximum: {of: velocity_ratio, over: force_ratio, table: ch3-other}}, {maximum: {of: velocity_ratio, over: force_ratio}}]}",
    );
    assert_eq!(file.other_tables(), BTreeSet::from(["ch3-other".to_string()]));
    let mut tables = Tables::from([(EXPERIMENT.to_string(), TableState::Present(&here))]);
    assert_eq!(judge(&file, &tables, &BTreeSet::new())[0].verdict, Verdict::Missing);
    tables.insert("ch3-other".into(), TableState::Present(&there));
    assert_eq!(judge(&file, &tables, &BTreeSet::new())[0].verdict, Verdict::Reproduced);
    assert_eq!(self_test(&file, &tables), []);
}

#[test]
fn a_move_counts_if_every_table_that_is_read_was_run_with_it_or_does_not_depend_on_it() {
    let table = |rows: &[(&str, f64)], depends_on: &str| Table {
        metadata: [(DEPENDS_ON.to_string(), depends_on.to_string())].into(),
        ..variants(rows, 0.0, 0.0, 1)
    };
    let here = table(&[("baseline", 2.0), ("gap=1", 2.5), ("stop=1", 1.0)], "gap, stop");
    let there =
        table(&[("baseline", 1.5), ("stop=1", 1.2), ("mass=1", 2.2), ("force=1", 1.0)], "force, gap, mass, stop");
    let file = entry(
        "claim: {greatest_first: [{cell: {of: velocity_ratio}}, {cell: {of: velocity_ratio, table: ch3-other}}]}",
    );
    let tables = Tables::from([
        (EXPERIMENT.to_string(), TableState::Present(&here)),
        ("ch3-other".to_string(), TableState::Present(&there)),
    ]);
    let judged = judge(&file, &tables, &BTreeSet::new()).remove(0);
    let moves: Vec<_> = judged.moved.iter().map(|moved| (moved.variant.as_str(), moved.found.as_str())).collect();
    // The other table was not run with the gap moved, though it depends on it; this one knows neither mass nor force.
    assert_eq!(moves, [("stop=1", "false"), ("mass=1", "false"), ("force=1", "true")]);
    assert_eq!(judged.robust, Some((1, 3)));
}

#[test]
fn the_self_test_finds_an_entry_that_cannot_fail() {
    assert_eq!(broken(OPTIMUM, &peak()), Vec::<String>::new());
    assert_eq!(broken(CELL, &variants(&[("baseline", 1.55), ("delta=1", 1.5)], 0.01, 0.0, 1)), Vec::<String>::new());
    let idle = "claim: {greatest_first: [{number: 2}, {number: 1}]}";
    assert!(broken(idle, &peak())[0].contains("reads no measure"));
    let always =
        "claim: {peaks: {of: velocity_ratio, over: force_ratio, prominence: 0.1, at_least: 0}}\nthreshold_reason: none";
    assert!(broken(always, &peak())[0].contains("nothing that was done"));
    let absent = "claim: {above: {of: displacement_ratio, level: 1}}";
    assert!(broken(absent, &peak())[0].contains("missing already"));
    // Margins of any size are reached, also by numbers that are all zero or far from it.
    let rows = |values: &[f64]| complete(vec![float("separations", values)]);
    let few = "claim: {below: {of: separations, level: 0.5}}";
    assert_eq!(broken(few, &rows(&[0.0, 0.0])), Vec::<String>::new());
    let small = "claim: {between: {value: {mean: {of: separations}}, to: 0.01}}\nthreshold_reason: for the test";
    assert_eq!(broken(small, &rows(&[1e-12, 1e-13])), Vec::<String>::new());
    // Places on a coarse grid: that they lie apart can be upheld or left open, but not refuted.
    let (here, there) = ([1.0, 2.0, 1.0, 1.0, 1.0], [1.0, 1.0, 1.0, 1.0, 2.0]);
    let both = lines(&[("event_driven", here), ("fixed_step_1e-2s", there)]);
    let top = "argmax: {of: velocity_ratio, over: force_ratio";
    let other = format!("{{{top}, where: {{solver: fixed_step_1e-2s}}}}}}");
    let apart =
        format!("claim: {{apart: {{values: [{{{top}}}}}, {other}], by: {{relative: 0.05}}}}}}\nthreshold_reason: none");
    assert_eq!(broken(&apart, &both), Vec::<String>::new());
    // A hand-set tolerance of a mile does turn, outside the mile; what cannot be moved there is found.
    let loose = "value: \"2\"\nfrom: {number: 2}";
    assert!(!broken(loose, &peak()).is_empty());
}

#[test]
fn an_unsound_reference_file_is_refused_with_every_mistake_and_its_line() {
    let mistakes = |text: &str| -> Vec<(usize, String)> {
        let list = parse_reference(EXPERIMENT, FILE, text).unwrap_err().list;
        list.into_iter().map(|one| (one.place.unwrap().line, one.message + &one.help.unwrap_or_default())).collect()
    };
    let unknown = mistakes("entries:\n  - id: a\n    plase: s. 1\n");
    assert!(unknown.iter().any(|(line, said)| *line == 3 && said.contains("did you mean `place`")), "{unknown:?}");

    let several = mistakes(
        "entries:
  - {id: a, place: s. 1, says: x, value: about 2, from: {number: 1}}
  - {id: a, place: s. 1, says: x, claim: {above: {of: y, level: 1}}, expected: differs}
  - {id: b, place: s. 1, says: x, claim: {linear: {of: y, over: x, within: 0.1}}}
  - {id: c, place: s. 1, says: x, claim: {above: {of: y, level: 1}}, expected: missing, explanation: no}
  - {id: d, place: s. 1, says: x, value: \"2\"}
  - {id: e, place: s. 1, says: x, value: \"2\", from: {number: 1}, tolerance: {relative: 0.1, reason: \"\"}}
  - {id: f, place: s. 1, says: x, claim: {above: {of: y, level: .nan}}}
not_judged:
  - {place: s. 1, says: x, reason: ''}
",
    );
    for (line, part) in [
        (2, "not a printed number"),
        (3, "an entry above has the id `a`"),
        (3, "lacks `explanation`: why another verdict than `reproduced` is expected"),
        (4, "lacks `threshold_reason`"),
        (5, "never an expected verdict"),
        (6, "lacks `from`: where the counterpart of its `value` stands"),
        (7, "a text is wanted here"),
        (8, "not a finite number"),
        (10, "a text is wanted here"),
    ] {
        let told = several.iter().any(|(other, said)| *other == line && said.contains(part));
        assert!(told, "line {line}: {part}\n{several:?}");
    }
    assert_eq!(several.len(), 9, "{several:?}");
}

#[test]
fn comments_and_the_order_of_keys_mean_nothing() {
    let meaning = |text: &str| serde_json::to_string(&parse_reference(EXPERIMENT, FILE, text).unwrap()).unwrap();
    let one = "entries:
  - id: a
    place: s. 1
    says: x
    where: {stop: with, gap_ratio: [10, infinite], force_ratio: {from: 1}}
    claim: {above: {of: y, level: 1}}
";
    let other = "# a comment
entries:
  - {claim: {above: {level: 1.0, of: y}}, says: x, id: a, place: s. 1,
     where: {force_ratio: {from: 1.0}, gap_ratio: [10.0, infinite], stop: with}}
";
    assert_eq!(meaning(one), meaning(other));
    assert_ne!(meaning(one), meaning(&one.replace("level: 1", "level: 2")));
}

#[test]
fn the_same_thing_is_judged_once() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference");
    let folders = std::fs::read_dir(root).unwrap().map(|folder| folder.unwrap().path()).filter(|path| path.is_dir());
    for path in folders.flat_map(|folder| std::fs::read_dir(folder).unwrap()).map(|file| file.unwrap().path()) {
        let mut seen = BTreeMap::new();
        for entry in load_reference(&path).unwrap_or_else(|error| panic!("{error}")).entries {
            let question = serde_json::to_string(&(&entry.check, &entry.rows)).unwrap();
            if let Some(other) = seen.insert(question, entry.id.clone()) {
                panic!("{} and {other} ask the same", entry.id);
            }
        }
    }
}

/// A reader who multiplies what is shown finds what stands beside it.
#[test]
fn numbers_that_are_identical_say_how_far() {
    let f = [10.0, 12.8428, 15.0, 20.0, 25.6856, 30.0];
    let table = complete(vec![
        float("f", &f),
        float("y", &[1.0, 2.0, 1.0, 1.0, 2.0, 1.0]),
        float("y_num", &[0.0; 6]),
        float("y_spread", &[0.0; 6]),
    ]);
    let place =
        |low: f64, high: f64| format!("{{argmax: {{of: y, over: f, where: {{f: {{from: {low}, to: {high}}}}}}}}}");
    let found = |values: &str| {
        let claim = format!("claim: {{equal: {{values: [{values}], within: {{relative: 0.02}}}}}}");
        judged(&format!("{claim}\nthreshold_reason: for the test"), &table).found
    };
    let (half, whole) = (place(9.0, 16.0), place(19.0, 31.0));
    let found_half = found(&format!("{{times: {{factor: 2, of: {half}}}}}, {whole}"));
    assert!(found_half.contains("2 × 12.843 and 25.69, identical to the last digit"), "{found_half}");
    let found_same = found(&format!("{whole}, {whole}"));
    assert!(found_same.contains("25.69, identical to the last digit"), "{found_same}");
}

#[test]
fn a_claim_shows_its_number_and_its_bounds_in_one_unit_and_names_the_unit_of_a_place() {
    let in_metres = |name: &str, cells: &[f64]| column(name, "m", Data::Float(cells.to_vec()));
    let amplitude = |value: f64, u: f64| {
        let [value, u, spread] = [("", value), ("_num", u), ("_spread", 0.0)]
            .map(|(part, cell)| in_metres(&format!("displacement_amplitude{part}"), &[cell]));
        complete(vec![value, u, spread])
    };
    let within = "claim: {between: {value: {cell: {of: displacement_amplitude}}, from: 0.5 mm, to: 2 mm}}\nthreshold_reason: for the test";
    let found = |table: &Table| judged(within, table).found;
    assert_eq!(
        found(&amplitude(1.1e-3, 2.05e-4)),
        "true: displacement amplitude 1.10 ± 0.41 mm (required: 0.5 mm to 2 mm)"
    );
    assert_eq!(found(&amplitude(1.1e-3, 0.0)), "true: displacement amplitude 1.1 mm (required: 0.5 mm to 2 mm)");

    let mut lines =
        lines(&[("event_driven", [1.0, 1.2, 1.4, 1.6, 1.8]), ("fixed_step_1e-2s", [0.9, 1.0, 1.3, 1.5, 1.7])]);
    lines.columns[0] = column("angular_frequency", "rad/s", Data::Float([[1.0, 2.0, 3.0, 4.0, 5.0]; 2].concat()));
    let above = "claim: {line_above: {of: velocity_ratio, over: angular_frequency, by: solver, above: event_driven, below: fixed_step_1e-2s}}";
    assert_eq!(judged(above, &lines).found, "true: smallest lead 0.1 at ω = 3 rad/s");
}
