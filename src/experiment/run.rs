//! The `run` of an experiment: solvers, cycles, and what is done besides.

use std::collections::BTreeMap;

use serde_json::json;

use super::assumed_schema;
use super::assumption_reader::{AVERAGE, SKIP, read_average, read_skip};
use super::definition::Transient;
use super::limit::read_limit;
use super::recipe::{AssumptionName, AssumptionSheet, AssumptionValue, Cycles, Takes};
use super::scene_reader::assumption;
use super::solver::read_solver;
use crate::dynamics::{Limit, Until};
use crate::measure::{NamedRows, Settings, SolverChoice};
use crate::yaml::{At, Dimension, Findings, Keys, Span};

/// Perturbed starts of a chaotic point, unless an experiment says.
const USUAL_ENSEMBLE: u32 = 32;

/// How an experiment is run.
pub(super) struct Run {
    pub solvers: Vec<SolverChoice>,
    pub settings: Settings,
    /// The cycles that an assumption leaves out, and where that stands.
    pub transient: Option<(Transient, Span)>,
    /// Where it says that runs are to settle.
    pub settled_at: Option<Span>,
    pub limit: Limit,
    /// The assumptions that are moved, and where each stands.
    pub moved: Option<BTreeMap<AssumptionName, Span>>,
}

/// A run as an experiment states it.
#[derive(Default)]
struct GivenRun {
    span: Span,
    solvers: Option<Vec<SolverChoice>>,
    skip: Option<Skip>,
    average: Option<u32>,
    to: Option<(u32, Span)>,
    until: Option<(Until, Span)>,
    round_period_to: Option<f64>,
    ensemble: Option<u32>,
    limit: Option<Limit>,
    moved: Option<BTreeMap<AssumptionName, Span>>,
}

/// Cycles that are left out.
enum Skip {
    Stated(u32),
    Assumed(AssumptionName, Span),
}

/// What stands under `run`; what it leaves out is the study's, or the same for every study. What is read off the model alone
/// needs no cycles.
pub(super) fn read_run(
    experiment: &Keys<'_>,
    sheet: &AssumptionSheet,
    of_model: bool,
    findings: &Findings,
) -> Option<Run> {
    let given = experiment.optional("run", "How it is run", |at| given_run(at, sheet))?;
    let given = given.unwrap_or_else(|| GivenRun { span: experiment.span(), ..GivenRun::default() });
    let no_run = of_model.then_some(Cycles { skip: 0, average: 1 });
    let (span, usual) = (given.span, sheet.cycles().or(no_run));
    let cycles = |key: &str, given: Option<u32>, usual: Option<u32>| {
        let help = "write `run: {skip: 25 cycles, average: 100 cycles}`, here or, for all experiments, under \
                    `defaults` in the assumptions file";
        let message = || format!("a run lacks `{key}`, and the study has no default for it");
        given.or(usual).or_else(|| findings.report(span, message(), Some(help.into())))
    };
    let (skip, transient) = match given.skip {
        Some(Skip::Assumed(left_out, at)) => {
            let (to, _) = given.to.or_else(|| {
                let help = "write `run: {skip: {assumed: NAME}, to: 125 cycles}`";
                findings.report(at, "cycles that an assumption leaves out need `to`, the last one", Some(help.into()))
            })?;
            let transient = Transient { left_out, to };
            (left_out_of(&transient, sheet, at, findings), Some((transient, at)))
        }
        Some(Skip::Stated(skip)) => (Some(skip), None),
        None => (cycles("skip", None, usual.map(|usual| usual.skip)), None),
    };
    let average = match given.to {
        None => cycles("average", given.average, usual.map(|usual| usual.average)),
        Some((to, at)) => skip.and_then(|skip| {
            to.checked_sub(skip)
                .filter(|cycles| *cycles > 0)
                .or_else(|| findings.wrong(at, format!("{skip} cycles are left out: none is left up to cycle {to}")))
        }),
    };
    Some(Run {
        solvers: given.solvers.unwrap_or_else(|| vec![SolverChoice::EventDriven]),
        settings: Settings {
            skip: skip?,
            average: average?,
            until: given.until.map_or(Until::Cycles, |(until, _)| until),
            round_period_to: given.round_period_to,
            ensemble: given.ensemble.unwrap_or(USUAL_ENSEMBLE),
            named: NamedRows::default(),
            mean_of: 0,
        },
        transient,
        settled_at: given.until.filter(|(until, _)| *until == Until::Settled).map(|(_, at)| at),
        limit: given.limit.unwrap_or_default(),
        moved: given.moved,
    })
}

fn given_run(at: At<'_>, sheet: &AssumptionSheet) -> Option<GivenRun> {
    let keys = at.keys("a run")?;
    let solvers = keys.optional("solver", "Solvers", |at| at.one_or_more(read_solver));
    let skip = keys.optional("skip", SKIP, |at| match assumption(sheet, at, Takes::count(), || "`skip`".into()) {
        Some(name) => name.map(|name| Skip::Assumed(name, at.span())),
        None => read_skip(at).map(Skip::Stated),
    });
    let average = keys.optional("average", AVERAGE, read_average);
    let to = "The last cycle that is averaged, in the place of `average`";
    let to = keys.optional("to", to, |at| read_average(at).map(|to| (to, at.span())));
    let until = keys.optional("until", "When it ends: after these cycles, or where it has settled before", |at| {
        at.word::<Until>("end").map(|until| (until, at.span()))
    });
    let round_period_to =
        keys.optional("round_period_to", "The period is rounded to this", |at| at.above_zero(Dimension::Time));
    let perturbed = "Perturbed starts where the motion is chaotic; 32 members unless stated";
    let ensemble = keys.optional("ensemble", perturbed, |at| {
        let single = "an ensemble has two members or more: write `ensemble: none` for a single run";
        if at.is_word("none") { Some(0) } else { at.count_from(2, "members", 10_000, single) }
    });
    let moved = keys.optional("sensitivity", "Assumptions that are moved, or none", |at| {
        if at.is_word("none") {
            return Some(BTreeMap::new());
        }
        let name = |at: At<'_>| at.form(|node, findings| sheet.named(node, findings), |_| assumed_schema::any(sheet));
        at.one_or_more(|at| Some((name(at)?, at.span()))).map(|names| names.into_iter().collect())
    });
    let most = "The most that a row may take; one that reaches it has failed, with the reason, and the others go on";
    let limit = keys.optional("limit", most, read_limit);
    keys.rule(|| json!({"not": {"required": ["average", "to"]}}));
    keys.close()?;
    let (average, to) = (average?, to?);
    if let (Some(_), Some((_, at_to))) = (average, to) {
        return at.wrong_at(at_to, "`average` and `to` say the same thing: leave one of them out");
    }
    Some(GivenRun {
        span: at.span(),
        solvers: solvers?,
        skip: skip?,
        average,
        to,
        until: until?,
        round_period_to: round_period_to?,
        ensemble: ensemble?,
        limit: limit?,
        moved: moved?,
    })
}

/// The cycles that are left out with the value in force; every value of the range has to leave one to average.
fn left_out_of(transient: &Transient, sheet: &AssumptionSheet, at: Span, findings: &Findings) -> Option<u32> {
    let entry = sheet.get(&transient.left_out)?;
    let wrong = std::iter::once(&entry.value).chain(&entry.range).find(|value| transient.cycles(value).is_none());
    if let Some(AssumptionValue::Number(cycles)) = wrong {
        let (name, to) = (&transient.left_out, transient.to);
        return findings
            .wrong(at, format!("`{name}` may be {cycles}: of {to} cycles no whole number is left to average"));
    }
    transient.cycles(&entry.value)
}
