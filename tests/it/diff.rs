//! `diff`: what moved between two runs, and whether by more than it is uncertain.

use std::fs;

use shotdamp::report::{Number, Standing, between_verdicts};
use shotdamp::table::{Data, Table, parquet};

use crate::desk::{Desk, GAP, shotdamp, simulated};

/// A study with its results copied to `before/`.
fn with_a_run_before() -> Desk {
    let desk = simulated();
    fs::create_dir(desk.layout.path("before")).unwrap();
    for id in ["ch3-gap", "ch3-stop"] {
        let name = format!("{id}.parquet");
        fs::copy(desk.layout.results().join(&name), desk.layout.path("before").join(&name)).unwrap();
    }
    desk
}

fn change(desk: &Desk, id: &str, change: impl FnOnce(&mut Table)) {
    let mut table = desk.table(id);
    change(&mut table);
    parquet::write(&table, &desk.layout.path(&format!("results/{id}.parquet"))).unwrap();
}

fn floats<'t>(table: &'t mut Table, name: &str) -> &'t mut Vec<f64> {
    let column = table.columns.iter_mut().find(|column| column.name == name).unwrap();
    let Data::Float(cells) = &mut column.data else { panic!("{name} is no column of numbers") };
    cells
}

fn diff(desk: &Desk) -> crate::desk::Said {
    let path = |name: &str| desk.layout.path(name).display().to_string();
    shotdamp(desk, &["diff", &path("before"), &path("results")])
}

#[test]
fn the_same_run_twice_differs_in_nothing() {
    let description = diff(&with_a_run_before());
    assert_eq!(description.code, 0, "{}", description.err);
    assert_eq!(
        description.out,
        "39 numbers: 39 the same to the bit, 0 moved within their uncertainty, 0 beyond it; 0 differences otherwise.\n"
    );
}

#[test]
fn a_number_that_moved_is_held_against_its_uncertainty() {
    let desk = with_a_run_before();
    change(&desk, "ch3-gap", |table| {
        floats(table, "velocity_ratio_num")[1] = 0.1;
        floats(table, "velocity_ratio")[1] += 0.05;
    });
    let within = diff(&desk);
    assert_eq!(within.code, 0, "{}", within.out);
    assert!(within.out.contains("within their uncertainty: 1\n    velocity_ratio at gap_ratio 50, "), "{}", within.out);

    change(&desk, "ch3-gap", |table| floats(table, "displacement_ratio")[2] += 0.05);
    let beyond = diff(&desk);
    assert_eq!(beyond.code, 1);
    assert!(
        beyond.out.contains("beyond their uncertainty: 1\n    displacement_ratio at gap_ratio ∞"),
        "{}",
        beyond.out
    );

    // A number that became none has moved, however uncertain it was.
    change(&desk, "ch3-gap", |table| floats(table, "velocity_ratio")[1] = f64::NAN);
    assert!(diff(&desk).out.contains("-> nothing"));
}

#[test]
fn tables_of_other_inputs_are_named() {
    let desk = with_a_run_before();
    desk.put("experiments/ch3/ch3-gap.yaml", &GAP.replace("mass_ratio: 0.05", "mass_ratio: 0.06"));
    let said = diff(&desk);
    assert_eq!(said.code, 1, "{}", said.err);
    assert!(said.out.contains("ch3-gap: its table is stale; shotdamp run ch3-gap\n"), "{}", said.out);
    assert!(!said.out.contains("ch3-stop: its table"));
}

#[test]
fn rows_and_experiments_that_only_one_has_are_named() {
    let desk = with_a_run_before();
    fs::remove_file(desk.layout.path("results/ch3-stop.parquet")).unwrap();
    change(&desk, "ch3-gap", |table| floats(table, "gap_ratio")[0] = 12.0);
    let description = diff(&desk);
    assert_eq!(description.code, 1);
    assert!(
        description.out.contains("only in the first: 1\n    gap_ratio 10, solver event_driven, variant baseline\n")
    );
    assert!(description.out.contains("only in the second: 1\n    gap_ratio 12"), "{}", description.out);
    assert!(description.out.contains("\nch3-stop: only in the first\n"), "{}", description.out);
    let nothing = shotdamp(&desk, &["diff", &desk.layout.path("experiments").display().to_string()]);
    assert_eq!(nothing.code, 2);
    assert!(nothing.err.contains("neither tables"), "{}", nothing.err);
}

#[test]
fn a_run_is_held_against_the_committed_report() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    let same = shotdamp(&desk, &["diff"]);
    assert_eq!(same.code, 0, "{}{}", same.out, same.err);
    change(&desk, "ch3-stop", |table| floats(table, "velocity_ratio").iter_mut().for_each(|value| *value += 1.0));
    change(&desk, "ch3-gap", |table| floats(table, "velocity_ratio").reverse());
    let description = shotdamp(&desk, &["diff"]);
    assert_eq!(description.code, 1);
    assert!(
        description.out.contains("judged differently: 2\n    ch3-gap/grows: reproduced -> differs\n"),
        "{}",
        description.out
    );
    assert!(description.out.contains("beyond their uncertainty: 1\n    ch3-stop/at-two: "), "{}", description.out);
}

/// Words of a claim, or a number that there was none of, say something that no old number shows.
#[test]
fn an_entry_that_reads_otherwise_under_the_same_verdict_is_a_difference() {
    let standing = |found: &str, numbers: &[(&str, f64)]| Standing {
        id: "ch3-gap/grows".into(),
        verdict: "differs".into(),
        found: found.into(),
        no_table: None,
        numbers: numbers.iter().map(|(name, value)| ((*name).to_owned(), Number { value: *value, u: 0.1 })).collect(),
    };
    let between = |a: Standing, b: Standing| between_verdicts(&[a], &[b]);
    let words = between(standing("it falls at 2", &[]), standing("it falls at 3", &[]));
    assert_eq!(words.read_differently.len(), 1);
    let came = between(standing("no peak", &[]), standing("2.5", &[("", 2.5)]));
    assert_eq!((came.moved.len(), came.same), (1, 0));
    let went = between(standing("2.5", &[("at", 2.5)]), standing("no peak", &[]));
    assert_eq!((went.moved.len(), went.same), (1, 0));
}

#[test]
fn a_table_by_itself_is_sent_back_for_its_folder() {
    let desk = crate::desk::simulated();
    let table = desk.layout.path("results/ch3-gap.parquet");
    let said =
        crate::desk::shotdamp(&desk, &["diff", table.to_str().unwrap(), desk.layout.results().to_str().unwrap()]);
    assert!(said.code == 2 && said.err.contains("is a single table: name the folder"), "{}", said.err);
}

#[test]
fn after_running_one_experiment_the_others_are_no_differences() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    fs::remove_file(desk.layout.path("results/ch3-stop.parquet")).unwrap();
    let said = shotdamp(&desk, &["diff"]);
    assert_eq!(said.code, 0, "{}{}", said.out, said.err);
    let end = "0 differences otherwise; not compared: 1 entry without a table that it reads.\n";
    assert!(said.out.ends_with(end) && !said.out.contains("nothing"), "{}", said.out);
    let one = shotdamp(&desk, &["diff", "--only", "ch3-gap"]);
    assert!(one.code == 0 && one.out.ends_with("0 differences otherwise.\n"), "{}{}", one.out, one.err);
    let typo = shotdamp(&desk, &["diff", "--only", "ch3-gab"]);
    assert!(typo.code == 2 && typo.err.contains("no experiment matches `ch3-gab`"), "{}", typo.err);
}

/// The entry of an experiment that the study does not have any more is no comparison that is still to be made.
#[test]
fn the_entry_of_an_experiment_that_was_renamed_or_dropped_is_only_in_the_run_that_had_it() {
    let desk = simulated();
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    let path = |name: &str| desk.layout.path(name);
    fs::rename(path("reports"), path("before")).unwrap();
    // Its reference is still there.
    fs::remove_file(path("experiments/ch3/ch3-stop.yaml")).unwrap();
    fs::remove_file(path("results/ch3-stop.parquet")).unwrap();
    let before = path("before").display().to_string();
    let dropped = shotdamp(&desk, &["diff", &before]);
    assert_eq!(dropped.code, 1, "{}{}", dropped.out, dropped.err);
    assert!(dropped.out.contains("only in the first: 1\n    ch3-stop/at-two\n"), "{}", dropped.out);
    assert!(!dropped.out.contains("not compared"), "{}", dropped.out);
}

/// A folder of tables that is not the study's own has no plan: what is not there is not still to be run.
#[test]
fn an_entry_whose_table_another_folder_lacks_is_only_in_the_reports() {
    let desk = with_a_run_before();
    assert_eq!(shotdamp(&desk, &[]).code, 0);
    let path = |name: &str| desk.layout.path(name).display().to_string();
    fs::rename(desk.layout.path("before/ch3-stop.parquet"), desk.layout.path("before/ch3-halt.parquet")).unwrap();
    let said = shotdamp(&desk, &["diff", &path("before"), &path("reports")]);
    assert_eq!(said.code, 1, "{}{}", said.out, said.err);
    assert!(said.out.contains("only in the second: 1\n    ch3-stop/at-two\n"), "{}", said.out);
    assert!(!said.out.contains("not compared"), "{}", said.out);
}
