//! What accuracy costs: the page of one experiment, and the summary of all.

use crate::measure::{SolverChoice, column_words};
use crate::study::Machine;

use super::measured::{Accuracy, CaseAccuracy, Contender, Origin, Point};
use crate::text::number::{compact, quantity, significant};
use crate::text::words::{self, counted};

use super::representative::TWIN;
use super::scatter;
use super::verdict_price::{self, VerdictPrice};
use crate::reference::symbol;
use crate::report::markdown::{Align, MarkdownTable, one_line};

/// Errors that somebody may want to reach.
const GOALS: [(f64, &str); 3] = [(1e-2, "1 %"), (1e-4, "1e-4"), (1e-8, "1e-8")];
/// Errors as large as the number itself are in no line with smaller ones.
const SENSELESS: f64 = 0.3;
/// A run that is off by ten times the number has diverged; by how much says nothing and would only stretch an axis.
pub(super) const DIVERGED: f64 = 10.0;
/// Smallest error that a logarithmic axis shows: what is exact to the last digit stands here.
pub(super) const LEAST: f64 = 1e-16;

/// One experiment, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct AccuracyView {
    /// Its id.
    pub id: String,
    /// Its title.
    pub title: String,
    /// Where times were taken.
    pub machine: Machine,
    /// What was measured.
    pub accuracy: Accuracy,
    /// The verdicts on it.
    pub entries: Vec<VerdictPrice>,
}

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

/// The fixed step that takes the least time of those within this error.
pub(super) fn cheapest(steps: &[(f64, Over)], error: f64) -> Option<(f64, Over)> {
    let within = steps.iter().filter(|(_, of)| of.error <= error);
    within.min_by(|a, b| a.1.time.total_cmp(&b.1.time)).copied()
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

/// `event-driven, windows × 0.5`; `fixed step 10 µs`.
pub(super) fn name(contender: Contender) -> String {
    match contender {
        Contender::EventDriven { window_factor: 1.0 } => "event-driven".into(),
        Contender::EventDriven { window_factor } => format!("event-driven, windows × {window_factor}"),
        Contender::FixedStep { time_step } => words::of_solver(&SolverChoice::FixedStep { time_step }.label()),
    }
}

fn error(value: f64) -> String {
    match value {
        exact if exact < f64::EPSILON => "< 2e-16".into(),
        far if far > DIVERGED => "diverged".into(),
        value => format!("{value:.0e}"),
    }
}

pub(super) fn seconds(value: f64) -> String {
    quantity(value, "s", 3)
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

/// Every fixed step that all of these cases were run with, s.
pub(super) fn fixed_steps(cases: &[&CaseAccuracy]) -> Vec<(f64, Over)> {
    let mut steps: Vec<(f64, Over)> = Vec::new();
    for point in cases.iter().flat_map(|case| &case.points) {
        if let Contender::FixedStep { time_step } = point.contender
            && steps.iter().all(|(known, _)| *known != time_step)
            && let Some(of) = over(cases, point.contender)
        {
            steps.push((time_step, of));
        }
    }
    steps
}

/// The worst error of a contender over cases, and its time over all of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Over {
    pub error: f64,
    pub time: f64,
}

pub(super) fn over(cases: &[&CaseAccuracy], contender: Contender) -> Option<Over> {
    let points: Vec<&Point> =
        cases.iter().filter_map(|case| case.points.iter().find(|point| point.contender == contender)).collect();
    (points.len() == cases.len() && !points.is_empty()).then(|| Over {
        error: points.iter().map(|point| point.error).fold(0.0, f64::max),
        time: points.iter().map(|point| point.times.median).sum(),
    })
}

/// By how much the time grows when the error falls to a tenth: the slope of the straight line through log time over log error.
fn next_digit(points: &[Over]) -> Option<f64> {
    let points: Vec<[f64; 2]> = points
        .iter()
        .filter(|of| of.error > 0.0 && of.error < SENSELESS)
        .map(|of| [libm::log10(of.error), libm::log10(of.time)])
        .collect();
    let count = points.len() as f64;
    let mean = |i: usize| points.iter().map(|point| point[i]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let square: f64 = points.iter().map(|point| (point[0] - x) * (point[0] - x)).sum();
    let product: f64 = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum();
    let span =
        points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [x, _]| [low.min(*x), high.max(*x)]);
    // A slope over less than one digit says nothing.
    (points.len() > 2 && span[1] - span[0] >= 1.0).then(|| libm::exp10(-product / square))
}
