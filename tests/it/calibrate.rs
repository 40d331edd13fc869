//! Calibrations: which values of unstated inputs bring chosen entries nearest, and what becomes of the others.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::atomic::Ordering;

use shotdamp::calibrate::{Calibrated, CalibrationError, Running, calibrate};
use shotdamp::experiment::{AssumptionSheet, Calibration, Experiment, parse_assumptions, parse_calibration};
use shotdamp::reference::{Found, Role, Verdict};
use shotdamp::report::judge_all;
use shotdamp::study::Study;
use shotdamp::study::{IgnoreEvents, Layout, Texts};

use crate::desk::{ASSUMPTIONS, Desk, MadeUp, STOP as STOP_TEXT, STOP_REFERENCE, shotdamp, simulated};

const STOP: &str = "
title: How long the stop is
about: One number chooses it.
calibrate:
  stop_length: [10 mm, 55 mm, 110 mm]
  plastic: {moves: [stop_restitution], values: [0, 0.5]}
fit: [ch3-stop/at-two]
hold_out: [ch3-gap/*]
";

fn sheet() -> AssumptionSheet {
    parse_assumptions("assumptions.yaml", ASSUMPTIONS).unwrap_or_else(|problems| panic!("{problems}"))
}

fn read(text: &str) -> Calibration {
    parse_calibration("it.yaml", text, &sheet()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The result on this desk, and how many simulations it took.
fn on(desk: &Desk, calibration: &Calibration, threads: usize) -> Result<(Calibrated, usize), CalibrationError> {
    with_journal(desk, calibration, threads, None)
}

/// The same, with what was evaluated kept there.
fn with_journal(
    desk: &Desk,
    calibration: &Calibration,
    threads: usize,
    journal: Option<&Path>,
) -> Result<(Calibrated, usize), CalibrationError> {
    let study = Study::new(desk.layout.clone(), desk.texts());
    let experiments: Vec<&Experiment> = study.items.iter().map(|item| &item.source.experiment).collect();
    let (in_force, engine) = (study.sheet.assumptions(), MadeUp::default());
    let running = Running { threads, journal };
    let result = calibrate(calibration, &experiments, &study.references, &in_force, running, &engine, &IgnoreEvents)?;
    Ok((result, engine.simulations.load(Ordering::Relaxed)))
}

fn run(text: &str) -> Calibrated {
    on(&Desk::new(), &read(text), 2).unwrap().0
}

#[test]
fn the_numbers_of_a_finding_are_those_of_the_page() {
    let finding = "From {in force} to {best}; without bounce {plastic: 0}, {stop_length: 110 mm} with the longest; {held out} held out.";
    let calibration = read(&format!("{STOP}finding: '{finding}'\n"));
    let page = shotdamp::calibrate::calibration(&calibration, &on(&Desk::new(), &calibration, 2).unwrap().0);
    let line = page.lines().find(|line| line.contains("our interpretation")).unwrap();
    let shares: Vec<&str> = line.split(' ').filter(|word| word.parse::<f64>().is_ok()).collect();
    let residuals = page.lines().find(|line| line.starts_with("Residual:")).unwrap();
    assert!(residuals.contains(&format!("Best: **{} %**; with the inputs in force: {} %", shares[1], shares[0])));
    for (input, share) in [("`plastic` | ", shares[2]), ("110 mm: ", shares[3])] {
        let row = page.lines().find(|row| row.starts_with('|') && row.contains(input)).unwrap();
        assert!(row.contains(&format!("{share} %")), "{row}: {share}");
    }
    let held_out = line.split("longest; ").nth(1).unwrap().split(" held out").next().unwrap();
    assert!(page.contains(&format!("fitted; {held_out} held out. With")), "{line}");
}

#[test]
fn a_finding_quotes_only_what_its_calibration_has() {
    let refused = |finding: &str| {
        let desk = Desk::new();
        desk.put("calibrations/it.yaml", &format!("{STOP}finding: '{finding}'\n"));
        let study = Study::new(desk.layout.clone(), desk.texts());
        study.unread.iter().map(ToString::to_string).collect::<String>()
    };
    assert_eq!(refused("From {in force} to {best}."), "");
    for (finding, words) in [
        ("It fell to {bset}.", "the unknown placeholder `{bset}`: write one of `{best}`, `{in force}`, `{fitted}`"),
        ("It fell to {bset}.", "`{stop_length: 110 mm}`, `{plastic: 0}`"),
        ("With {stop_length: 5 mm}.", "`{stop_length: 5 mm}`: write one of `{stop_length: "),
        ("It fell to {best.", "an opening `{` without its `}`"),
    ] {
        assert!(refused(finding).contains(words), "{finding}: {}", refused(finding));
    }
}

#[test]
fn the_best_of_all_combinations_is_found_and_each_input_has_its_profile() {
    let result = run(STOP);
    // The made-up number is 1.69 and the stop's length; 1.75 is published.
    assert_eq!(result.places[0], 1, "55 mm");
    assert!(result.best.unwrap() < 0.004 && result.in_force.unwrap() < result.best.unwrap(), "60 mm are better still");
    let [short, middle, long] = result.profiles[0].residuals[..] else { panic!("three values") };
    assert!(short > middle && long > middle && middle == result.best);
    let [plastic, elastic] = result.profiles[1].residuals[..] else { panic!("two values") };
    assert_eq!(plastic, elastic, "nothing tells one restitution from the other");
    assert!(matches!(result.fitted[0].best.found, Found::Number { published, .. } if published == 1.75));
    // Half a unit of the last digit of 1.75 is 0.005; 1.745 is as far off, 1.75 is not.
    assert_eq!(result.fitted[0].in_force.verdict, Verdict::Reproduced);
    assert_eq!(result.held_out[0].id, "ch3-gap/grows");
    assert_eq!(result.held_out[0].best.found, Found::Claim { holds: true });
    assert_eq!(result.held_out[0].best.verdict, Verdict::Reproduced);
    let page = shotdamp::calibrate::calibration(&read(STOP), &result);
    assert!(
        page.contains("**55 mm: 0.2") && page.contains("| yes |") && page.contains("| no: no residual depends on it |"),
        "{page}"
    );
    assert!(page.contains("All 6 combinations of values were tried, each as a single run."), "{page}");
    assert_eq!(on(&Desk::new(), &read(STOP), 1).unwrap().0, result, "on any number of threads");
}

/// Three numbers that the inputs 90 mm and 1.9 give.
fn with_a_known_answer() -> Desk {
    let desk = Desk::new();
    let entries = |values: [&str; 3]| {
        let entry = |(force, value): (&str, &str)| {
            format!(
                "  - id: at-{force}\n    place: s. 3.6.3\n    says: A number.\n    value: \"{value}\"\n    \
                 from: {{cell: {{of: velocity_ratio, where: {{stop: with, force_ratio: {force}}}}}}}\n"
            )
        };
        format!("entries:\n{}", ["1", "2", "4"].into_iter().zip(values).map(entry).collect::<String>())
    };
    desk.put("reference/ch3/ch3-stop.yaml", &entries(["1.00", "1.00", "1.00"]));
    let there = "title: a\nabout: b\ncalibrate: {stop_length: [90 mm], impulse_factor: [1.9]}\nfit: [ch3-stop/*]\n";
    let (result, _) = on(&desk, &read(there), 1).unwrap();
    let values: Vec<String> = result
        .fitted
        .iter()
        .map(|one| match one.best.found {
            Found::Number { simulated, .. } => format!("{simulated:.6}"),
            _ => panic!("a number"),
        })
        .collect();
    desk.put("reference/ch3/ch3-stop.yaml", &entries([&values[0], &values[1], &values[2]]));
    desk
}

const SEARCHED: &str = "
title: A search
about: Two inputs and one that does nothing.
search: {coordinate: {starts: 3, budget: 200 sets}}
calibrate:
  stop_length: [10 mm, 30 mm, 50 mm, 60 mm, 70 mm, 80 mm, 90 mm, 100 mm, 110 mm, 130 mm]
  impulse_factor: [1, 1.5, 1.7, 1.8, 1.9, 2, 2.1, 2.2, 2.5, 3]
  harmonic_reference: [base, loaded]
fit: [ch3-stop/*]
";

#[test]
fn a_search_along_one_input_after_the_other_finds_the_answer_with_a_part_of_the_sets() {
    let desk = with_a_known_answer();
    let (searched, simulations) = on(&desk, &read(SEARCHED), 2).unwrap();
    assert_eq!(searched.places[..2], [6, 4], "90 mm and 1.9");
    assert!(searched.best.unwrap() < 1e-6 && searched.in_force.unwrap() > 0.01);
    assert!(!searched.cut_short && searched.ends.len() == 3);
    assert!(searched.tried < 150, "{} of 200", searched.tried);
    // Only the three rows that are read, and not again for an input that they do not lean on.
    assert!(simulations < 3 * searched.tried, "{simulations} simulations of {} sets", searched.tried);
    let (all, _) =
        on(&desk, &read(&SEARCHED.replace("search: {coordinate: {starts: 3, budget: 200 sets}}", "")), 2).unwrap();
    assert_eq!((all.tried, all.best), (200, searched.best), "as a full grid");
    for (found, exact) in searched.profiles.iter().zip(&all.profiles) {
        for (found, exact) in found.residuals.iter().zip(&exact.residuals) {
            assert!(found >= exact, "a least residual that was found is never below the least one");
        }
    }
    assert_eq!(on(&desk, &read(SEARCHED), 1).unwrap().0, searched, "on any number of threads");
}

#[test]
fn what_was_evaluated_is_kept_and_used_again_at_the_next_start() {
    let desk = with_a_known_answer();
    let path = desk.folder.path().join("results/calibrations/searched.journal");
    let (fresh, simulations) = on(&desk, &read(SEARCHED), 1).unwrap();
    // The inputs in force and the best ones as results, three rows each.
    let results = 2 * 3;

    let few = read(&SEARCHED.replace("200 sets", "15 sets"));
    let (_, begun) = with_journal(&desk, &few, 1, Some(&path)).unwrap();
    let (resumed, rest) = with_journal(&desk, &read(SEARCHED), 2, Some(&path)).unwrap();
    assert_eq!(resumed, fresh, "as if it had never been interrupted");
    assert_eq!(begun + rest, simulations + results, "and nothing of the search is run twice");
    assert_eq!(with_journal(&desk, &read(SEARCHED), 1, Some(&path)).unwrap(), (fresh.clone(), results));

    // A line that was cut off does not count, nor does an entry that has changed.
    let whole = std::fs::read(&path).unwrap();
    std::fs::write(&path, &whole[..whole.len() - 5]).unwrap();
    let (repaired, again) = with_journal(&desk, &read(SEARCHED), 1, Some(&path)).unwrap();
    assert!(repaired == fresh && again > results && again <= results + 3, "{again} simulations");
    assert_eq!(std::fs::read(&path).unwrap().len(), whole.len());
    let reference = String::from_utf8(desk.bytes("reference/ch3/ch3-stop.yaml")).unwrap();
    desk.put("reference/ch3/ch3-stop.yaml", &reference.replace("force_ratio: 2", "force_ratio: 4"));
    let (changed, _) = with_journal(&desk, &read(SEARCHED), 1, Some(&path)).unwrap();
    assert_eq!(changed, on(&desk, &read(SEARCHED), 1).unwrap().0);
    assert_ne!(changed, fresh);
}

#[test]
fn a_calibration_says_how_far_it_is_where_no_terminal_is_and_resumes() {
    let desk = Desk::new();
    desk.put("calibrations/stop.yaml", STOP);
    let first = shotdamp(&desk, &["calibrate", "stop", "--jobs", "1"]);
    assert_eq!(first.code, 0, "{}", first.err);
    // The inputs in force, which are not among the six sets of the grid, come first.
    assert!(first.err.starts_with("1 set tried; least residual "), "{}", first.err);
    assert!(first.err.contains("\n7 sets tried"), "{}", first.err);
    let kept = desk.bytes("results/calibrations/stop.journal");
    let second = shotdamp(&desk, &["calibrate", "stop"]);
    assert_eq!((second.code, &second.out), (0, &first.out));
    assert!(desk.bytes("results/calibrations/stop.journal") == kept, "nothing is evaluated that was kept");
    assert!(shotdamp(&desk, &["calibrate", "stop", "--quiet"]).err.is_empty());
}

#[test]
fn a_search_ends_at_its_budget_and_says_so() {
    let text = SEARCHED.replace("200 sets", "5 sets");
    let (result, _) = on(&with_a_known_answer(), &read(&text), 1).unwrap();
    assert!(result.cut_short && result.tried == 5);
    let page = shotdamp::calibrate::calibration(&read(&text), &result);
    assert!(page.contains("5 sets of inputs of 200 possible ones") && page.contains("by the budget"), "{page}");
}

#[test]
fn an_input_may_be_a_factor_a_solver_or_a_reading_of_several_assumptions() {
    let tried = |inputs: &str| {
        let (_, rest) = STOP.split_once("fit:").unwrap();
        run(&format!("title: a\nabout: b\ncalibrate:\n  {inputs}\nfit:{rest}"))
    };
    // As 60 mm do: within 0.2 %, where 50 mm are 0.6 % off.
    let exactly = |result: &Calibrated| result.best.is_some_and(|best| best < 0.002);
    let scaled = tried("stop_length: [20 mm, 40 mm]\n  factor: {scales: stop_length, by: [1, 1.5]}");
    assert!(scaled.places == [1, 1] && exactly(&scaled), "1.5 × 40 mm");
    // The made-up fixed step is 0.01 too high.
    let stepped = tried("stop_length: [50 mm]\n  solver: [event_driven, {fixed_step: {time_step: 1 ms}}]");
    assert!(stepped.places == [0, 1] && exactly(&stepped), "{stepped:?}");
    let read = tried("both: {moves: [stop_length, undamped_mass], values: [[30 mm, base], [60 mm, loaded]]}");
    assert!(read.places == [1] && exactly(&read), "{read:?}");
}

#[test]
fn an_entry_that_is_none_and_an_input_that_is_none_are_told() {
    let unknown = on(&Desk::new(), &read(&STOP.replace("at-two", "at-three")), 1).unwrap_err();
    assert_eq!(unknown.to_string(), "`ch3-stop/at-three` is no entry of an experiment of this study");
    let wrong =
        |from: &str, to: &str| parse_calibration("it.yaml", &STOP.replace(from, to), &sheet()).unwrap_err().to_string();
    assert!(wrong("stop_length:", "stop_lenght:").contains("did you mean `stop_length`"));
    assert!(wrong("[10 mm, 55 mm, 110 mm]", "[10 kg]").contains("length"));
    assert!(wrong("[stop_restitution], values: [0, 0.5]", "[stop_length], values: [1 mm]").contains("two inputs"));
    assert!(wrong("values: [0, 0.5]", "values: [[0, 0.5]]").contains("2 values for 1 assumptions"));
    assert!(wrong("fit:", "search: {coordinate: {starts: 0, budget: 9}}\nfit:").contains("no starts at all"));
}

#[test]
fn every_entry_has_a_role_in_the_choice_of_inputs() {
    let desk = simulated();
    let role = |entry: &str| Study::new(desk.layout.clone(), desk.texts()).role(entry);
    assert_eq!(role("ch3-stop/at-two"), Role::Neither);
    desk.put("calibrations/stop.yaml", STOP);
    assert_eq!(role("ch3-stop/at-two"), Role::Fitted, "a calibration fits it");
    assert_eq!(role("ch3-gap/grows"), Role::HeldOut, "by `ch3-gap/*`");
    desk.put(
        "calibrations/stop.yaml",
        &STOP.replace("ch3-stop/at-two", "ch3-gap/grows").replace("ch3-gap/*", "ch3-stop/*"),
    );
    desk.put("reference/ch3/ch3-stop.yaml", &STOP_REFERENCE.replace("at-two", "at-2"));
    assert_eq!(role("ch3-stop/at-2"), Role::HeldOut);
    let study = Study::new(desk.layout.clone(), desk.texts());
    let judged = judge_all(&study);
    assert_eq!(judged.verdicts["ch3-stop"][0].role, Role::HeldOut, "and pages tell it");
    desk.put("calibrations/stop.yaml", "title: nothing else");
    let study = Study::new(desk.layout.clone(), desk.texts());
    assert!(study.unread[0].to_string().contains("calibrations/stop.yaml"), "{:?}", study.unread);
}

#[test]
fn of_two_calibrations_or_references_of_one_name_neither_is_chosen() {
    let desk = simulated();
    desk.put("calibrations/stop.yaml", STOP);
    desk.put("calibrations/other/stop.yaml", STOP);
    desk.put("reference/other/ch3-stop.yaml", STOP_REFERENCE);
    let study = Study::new(desk.layout.clone(), desk.texts());
    let refused: Vec<String> = study.unread.iter().map(ToString::to_string).collect();
    let twice =
        |file: &str, other: &str| refused.contains(&format!("{file}: {other} has the same id; rename one of them"));
    for (folder, file) in [("calibrations", "stop.yaml"), ("reference", "ch3-stop.yaml")] {
        let above = if folder == "reference" { "reference/ch3" } else { folder };
        let pair = [format!("{above}/{file}"), format!("{folder}/other/{file}")];
        assert!(twice(&pair[0], &pair[1]) && twice(&pair[1], &pair[0]), "{refused:#?}");
    }
    assert!(study.calibrations.is_empty() && !study.references.contains_key("ch3-stop"));
    desk.put("calibrations/late.yml", STOP);
    let study = Study::new(desk.layout.clone(), desk.texts());
    assert!(study.unread.iter().any(|one| one.to_string().contains("late.yml: rename it")), "{:?}", study.unread);
}

#[test]
fn the_calibrations_of_the_study_are_sound() {
    let layout = Layout::new(env!("CARGO_MANIFEST_DIR"));
    let study = Study::new(layout.clone(), Texts::read(&layout).unwrap());
    assert_eq!(study.unread, []);
    let known: Vec<_> = study.references.values().flat_map(|file| &file.entries).collect();
    let fitted_to = study.sheet.fitted();
    for (name, calibration) in &study.calibrations {
        let fit: BTreeSet<&String> = calibration.fit.iter().collect();
        assert!(calibration.hold_out.iter().all(|id| !fit.contains(id)), "{name}: what is fitted is not held out");
        for id in calibration.fit.iter().chain(&calibration.hold_out).filter(|id| !id.ends_with("/*")) {
            let entry =
                known.iter().find(|entry| entry.id == *id).unwrap_or_else(|| panic!("{name}: {id} is no entry"));
            // Whatever chose inputs may not count as evidence for them.
            let counts = entry.expected == Verdict::Reproduced && !fitted_to.contains(id);
            assert!(!(fit.contains(id) && counts), "{name} fits {id}, which is counted as reproduced");
        }
    }
}

const LEFT_OUT: &str = "
title: Left out one at a time
about: Three numbers of two inputs, and the first of them once more.
leave_one_out: true
calibrate:
  stop_length: [50 mm, 70 mm, 90 mm, 110 mm]
  impulse_factor: [1.5, 1.9, 2.2]
fit: [ch3-stop/*]
";

#[test]
fn a_number_that_the_others_give_comes_out_when_it_is_left_out() {
    let desk = with_a_known_answer();
    let (result, _) = on(&desk, &read(LEFT_OUT), 2).unwrap();
    assert_eq!(result.left_out.len(), 3);
    for one in &result.left_out {
        assert_eq!(one.as_good, [[2, 1]], "any two of the three numbers choose 90 mm and 1.9");
        assert!(one.errors.is_some_and(|[least, largest]| least.abs() < 1e-5 && largest.abs() < 1e-5), "{one:?}");
        assert!(one.by_chance > 0.0, "the chosen set is one of them: {one:?}");
    }
    assert_eq!(on(&desk, &read(LEFT_OUT), 1).unwrap().0, result, "on any number of threads");

    let alone = read(&LEFT_OUT.replace("ch3-stop/*", "ch3-stop/at-1"));
    assert_eq!(on(&desk, &alone, 2).unwrap().0.left_out, [], "nothing is left to choose by");
}

#[test]
fn a_number_that_is_printed_once_is_left_out_wherever_it_is_read() {
    let desk = with_a_known_answer();
    let text = String::from_utf8(desk.bytes("reference/ch3/ch3-stop.yaml")).unwrap();
    let first = &text[text.find("  - id").unwrap()..text[20..].find("  - id").map(|at| at + 20).unwrap()];
    desk.put("reference/ch3/ch3-stop.yaml", &(text.clone() + &first.replace("at-1", "at-1-again")));
    let (result, _) =
        on(&desk, &read(&LEFT_OUT.replace("ch3-stop/*", "ch3-stop/at-1, ch3-stop/at-1-again")), 2).unwrap();
    assert_eq!(result.left_out, [], "the one would tell the other");
}

#[test]
fn leaving_out_wants_every_combination() {
    let text = LEFT_OUT.replace("leave_one_out", "search: {coordinate: {starts: 2, budget: 9 sets}}\nleave_one_out");
    let problems = parse_calibration("it.yaml", &text, &sheet()).unwrap_err().to_string();
    assert!(problems.contains("it.yaml:5") && problems.contains("wants every combination"), "{problems}");
}

#[test]
fn a_value_that_leaves_no_cycle_to_average_is_refused() {
    let desk = Desk::new();
    let assumptions = format!("before: {{value: 25, reason: plain, quantity: count}}\n{}", ASSUMPTIONS.trim_start());
    desk.put("experiments/assumptions.yaml", &assumptions);
    desk.put(
        "experiments/ch3/ch3-stop.yaml",
        &STOP_TEXT.replace("skip: 25 cycles, average: 100 cycles", "skip: {assumed: before}, to: 125 cycles"),
    );
    let sheet = parse_assumptions("assumptions.yaml", &assumptions).unwrap_or_else(|problems| panic!("{problems}"));
    let text = "title: a\nabout: b\ncalibrate: {stop_length: [50 mm], before: [125, 25]}\nfit: [ch3-stop/at-two]\n";
    let calibration = parse_calibration("it.yaml", text, &sheet).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(
        on(&desk, &calibration, 1).unwrap_err().to_string(),
        "`before` has a value with which `ch3-stop` averages no whole number of cycles up to cycle 125: give it whole numbers below 125"
    );
}

#[test]
fn an_entry_counts_once_and_has_one_part() {
    let twice = STOP.replace("fit: [ch3-stop/at-two]", "fit: [ch3-stop/at-two, ch3-stop/at-two]");
    assert_eq!(run(&twice).fitted, run(STOP).fitted);
    let both = STOP.replace("hold_out: [ch3-gap/*]", "hold_out: [ch3-stop/at-two]");
    let refused = on(&Desk::new(), &read(&both), 1).unwrap_err();
    assert!(matches!(&refused, CalibrationError::FittedAndHeldOut(id) if id == "ch3-stop/at-two"), "{refused}");
}

#[test]
fn a_calibration_whose_page_cannot_be_written_is_refused_before_it_begins() {
    let desk = Desk::new();
    desk.put("calibrations/it.yaml", STOP);
    // In the place of the folder, which nobody can write into.
    desk.put("reports/calibrations", "");
    let said = shotdamp(&desk, &["calibrate", "it"]);
    assert!(said.code == 2 && said.err.contains("cannot write "), "{}", said.err);
    assert!(!said.err.contains("tried") && !desk.layout.path("results/calibrations").exists(), "{}", said.err);
}

#[test]
fn an_input_that_no_fitted_entry_depends_on_keeps_its_value_in_force() {
    // Plastic is in force, and stands second here.
    let text = STOP.replace("values: [0, 0.5]", "values: [0.5, 0]");
    let result = run(&text);
    assert_eq!((result.places[1], result.profiles[1].is_unread, result.profiles[0].is_unread), (1, true, false));
    let page = shotdamp::calibrate::calibration(&read(&text), &result);
    let row = page.lines().find(|line| line.starts_with("| `plastic`")).unwrap();
    assert!(row.contains("; **0: ") && row.ends_with("| no: no residual depends on it |"), "{row}");
}
