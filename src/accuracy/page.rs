//! What accuracy costs: the page of one experiment, and the summary of all.

use crate::measure::column_words;
use crate::study::Machine;

use super::measured::{CaseAccuracy, Contender, Origin, Point};
use crate::text::number::{compact, significant};
use crate::text::words::{self, counted};

use super::over_cases::{DIVERGED, cheapest, fixed_steps, name, next_digit, over, seconds};
use super::representative::TWIN;
use super::scatter;
use super::verdict_price::{self};
use super::view::AccuracyView;
use crate::reference::symbol;
use crate::report::markdown::{Align, MarkdownTable, one_line};

/// Errors that somebody may want to reach.
const GOALS: [(f64, &str); 3] = [(1e-2, "1 %"), (1e-4, "1e-4"), (1e-8, "1e-8")];
/// The page of one experiment, `picture` beside it.
#[must_use]
pub fn accuracy_page(view: &AccuracyView, picture: &str) -> String {
    let mut text = format!(
        "# What accuracy costs: {}\n\n{}. [All experiments, and how to read](../accuracy.md#how-to-read)\n\n",
        one_line(&view.title),
        result(view)
    );
    text += &format!("![Error against wall time]({picture})\n\n");
    text += &verdict_price::section(&view.entries, &view.accuracy);
    for (number, case) in view.accuracy.cases.iter().enumerate() {
        text += &section(number + 1, case);
    }
    text
}

/// `Event-driven: 363 µs a run, error 4e-15; fixed step: 401 µs for 1 %, 27.4 ms for 1e-4`.
fn result(view: &AccuracyView) -> String {
    let regular = view.accuracy.regular();
    let count = regular.len() as f64;
    let Some(own) = over(&regular, Contender::EXACT) else {
        return "Every case is chaotic: neighbouring starts part, and no error has a meaning".into();
    };
    let steps = fixed_steps(&regular);
    let reached = |&(goal, name): &(f64, &str)| match cheapest(&steps, goal) {
        Some((_, of)) => format!("{} for {name}", seconds(of.time / count)),
        None => format!("no step tried reaches {name}"),
    };
    let goals: Vec<String> = GOALS[..2].iter().map(reached).collect();
    format!(
        "Event-driven: {} a run, error {}; fixed step: {}",
        seconds(own.time / count),
        error(own.error),
        goals.join(", ")
    )
}

fn describe(machine: &Machine) -> String {
    format!("{}, {} threads, {}; {}.\n\n", machine.processor, machine.threads, machine.system, machine.build)
}

/// A case by what sets it apart; by its number where nothing does.
pub(super) fn case_name(case: &CaseAccuracy, number: usize) -> String {
    if case.description.is_empty() {
        return format!("case {}", number + 1);
    }
    let part = |part: &str| {
        let Some((name, value)) = part.split_once(" = ") else { return part.to_owned() };
        let value = value.parse::<f64>().map_or_else(|_| value.to_owned(), |value| compact(value, 3));
        format!("{} = {value}", symbol(name))
    };
    case.description.split(", ").map(part).collect::<Vec<_>>().join(", ")
}

fn section(number: usize, case: &CaseAccuracy) -> String {
    let mut text = format!("## Case {number}");
    if !case.description.is_empty() {
        text += &format!(": {}", one_line(&case_name(case, number)));
    }
    text += "\n\n";
    if let Origin::StandIn(reason) = &case.origin {
        text += &format!(
            "Errors are against the event-driven run in other search windows, since {reason}: what they say of the event-driven \
             solver is only how well it agrees with itself.\n"
        );
    }
    if case.closed_form {
        text += "No particle leaves its floor: the event-driven solver answers in closed form.\n";
    }
    if let Some(floor) = case.floor {
        text += &format!("The motion is chaotic: perturbed starts spread by {}.\n", significant(floor, 2));
    }
    text += &chaotic_on_the_way(case);
    if !text.ends_with("\n\n") {
        text.push('\n');
    }
    let mut rows = MarkdownTable::new(&[
        ("Solver", Align::Left),
        ("Error of the measures", Align::Right),
        ("Worst", Align::Left),
        ("Events in the right order", Align::Right),
        ("Error of their times / T", Align::Right),
        ("Time", Align::Right),
    ]);
    let (shown, windows): (Vec<&Point>, Vec<&Point>) =
        case.points.iter().partition(|point| !is_repeated(point.contender));
    for point in shown {
        let of = point.events;
        let unsettled = if point.times.settled { "" } else { "*" };
        rows.row([
            name(point.contender),
            error(point.error),
            column_words(&words::of_key(&point.worst)),
            format!("{} of {}", of.right, of.of),
            of.error.map_or_else(String::new, error),
            format!("{}{unsettled}", seconds(point.times.median)),
        ]);
    }
    text += &rows.finish();
    if let Some(worst) = windows.iter().map(|point| point.error).reduce(f64::max) {
        text += &format!("Event-driven in shorter search windows: error at most {}.\n", error(worst));
    }
    for skipped in &case.skipped {
        text += &format!("Left out: {}; {}.\n", name(skipped.contender), skipped.reason);
    }
    text.push('\n');
    text
}

/// Why the error of a motion that is not chaotic is far above rounding, where neighbouring runs part before it has settled.
fn chaotic_on_the_way(case: &CaseAccuracy) -> String {
    let [kick, moved] = TWIN;
    let exact = case.points.iter().find(|point| point.contender == Contender::EXACT);
    let parts = |point: &&Point| point.events.right < point.events.of && point.error > moved;
    match exact.filter(|_| case.floor.is_none()).filter(parts) {
        Some(Point { events, .. }) => format!(
            "A start kicked by {kick:.0e} ends with the same measures to {moved:.0e}: the motion does not count as chaotic. The way \
             there is: after {} the event-driven run and the reference meet them in another order, and what of the way falls \
             into the averages differs from run to run.\n",
            counted(events.right, "event", "events")
        ),
        None => String::new(),
    }
}

/// The same solver in windows that change nothing but its time.
fn is_repeated(contender: Contender) -> bool {
    matches!(contender, Contender::EventDriven { .. }) && contender != Contender::EXACT
}

fn error(value: f64) -> String {
    match value {
        exact if exact < f64::EPSILON => "< 2e-16".into(),
        far if far > DIVERGED => "diverged".into(),
        value => format!("{value:.0e}"),
    }
}

/// The summary of all experiments that were measured.
#[must_use]
pub fn accuracy_summary(views: &[AccuracyView]) -> String {
    let mut text = format!(
        "# What accuracy costs\n\n{}![Error against time of every experiment](accuracy.png)\n\n",
        scatter::in_words(&scatter::points(views))
    );
    text += "Each experiment that has statements and a case that is not chaotic is a point for the event-driven solver and one for \
             the cheapest fixed step that would do; times are of one run in the mean over its cases that are not chaotic. Each grey line is the u_val of a number, relative: a run \
             with an error below it is accurate enough for that verdict.\n\n";
    let mut machines: Vec<&Machine> = views.iter().map(|view| &view.machine).collect();
    machines.sort();
    machines.dedup();
    text += "## How to read\n\nErrors are against the same model in arithmetic of 32 digits, by another method, unless a page says \
             otherwise. Times are on one thread, the median of as many runs as it takes for it to settle (* where it did not). \
             A time for a verdict is that of all runs that the entry depends on, at the mean time of a run. Where motion is chaotic, \
             no error below the spread of perturbed starts has a meaning.\n\n";
    text += "Written by `shotdamp accuracy --all`; with `--pages` again from the record of what was measured, with the verdicts as \
             they are. Measured on: ";
    machines.into_iter().for_each(|machine| text += &describe(machine));
    text += "## Experiments\n\nThe cheapest setting of each solver that reaches an error in every case of an experiment that is not \
             chaotic, with its time over these cases. The event-driven solver has no setting that is less exact: its time is \
             the price of all digits. Next digit: factor by which the fixed step's time grows for a tenth of the error; empty \
             where no step tried gains a digit. ✗: no step tried reaches that error.\n\n";
    let mut header = vec![("Experiment".to_owned(), Align::Left), ("Event-driven: error".into(), Align::Right)];
    header.push(("time".into(), Align::Right));
    header.extend(GOALS.iter().map(|(_, goal)| (format!("Fixed step: {goal}"), Align::Right)));
    header.push(("next digit".into(), Align::Right));
    header.push(("Chaotic cases".into(), Align::Right));
    let header: Vec<(&str, Align)> = header.iter().map(|(name, align)| (name.as_str(), *align)).collect();
    let mut rows = MarkdownTable::new(&header);
    for view in views {
        rows.row(row(view));
    }
    text += &rows.finish();
    text += "Not in the table: experiments without dampers, those in which nothing moves the structure, and optimisations.\n\n";
    text += "[All reports](README.md)\n\n";
    let stand_ins: Vec<&AccuracyView> = views
        .iter()
        .filter(|view| view.accuracy.cases.iter().any(|case| matches!(case.origin, Origin::StandIn(_))))
        .collect();
    if !stand_ins.is_empty() {
        let names: Vec<String> = stand_ins.iter().map(|view| format!("`{}`", view.id)).collect();
        text += &format!(
            "{} without an independent reference in some case, where the event-driven solver is held against itself: {}.\n",
            counted(names.len(), "experiment", "experiments"),
            names.join(", ")
        );
    }
    text
}

fn row(view: &AccuracyView) -> Vec<String> {
    let cases = &view.accuracy.cases;
    let regular = view.accuracy.regular();
    let mut cells = vec![format!("[`{0}`](accuracy/{0}.md)", view.id)];
    let exact = over(&regular, Contender::EXACT);
    cells.push(exact.map_or_else(String::new, |of| error(of.error)));
    cells.push(exact.map_or_else(String::new, |of| seconds(of.time)));
    let steps = fixed_steps(&regular);
    for (goal, _) in GOALS {
        cells.push(match cheapest(&steps, goal) {
            Some((step, of)) => format!("{} ({})", seconds(of.time), seconds(step)),
            None if regular.is_empty() => String::new(),
            None => "✗".into(),
        });
    }
    let next = next_digit(&steps.iter().map(|(_, of)| *of).collect::<Vec<_>>());
    cells.push(next.map_or_else(String::new, |factor| format!("× {}", significant(factor, 2))));
    cells.push(format!("{} of {}", cases.len() - regular.len(), cases.len()));
    cells
}
