//! `shotdamp explain ENTRY`.

use std::collections::BTreeMap;

use super::args::{Args, LimitArgs};
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_progress, print_unread};
use super::select::{matches, no_entry, open};
use crate::calibrate::{CalibrationError, Read, moved_alone};
use crate::dynamics::is_interrupted;
use crate::experiment::{AssumptionName, AssumptionValue, Experiment};
use crate::reference::{Found, Judged, Moved, Verdict};
use crate::report::{Trial, entry, explanations, judge_all, untried};
use crate::study::{Engine, EventHandler, IgnoreEvents, Layout, Progress, RunError, Study};
use crate::text::number::significant;
use crate::text::words::counted;

/// How sensitive entries are to each assumption: from the tables on disk, and with a limit for them from simulations made for
/// it.
pub(super) fn explain(
    layout: &Layout,
    pattern: &str,
    simulated: Option<&LimitArgs>,
    common: &Args,
) -> Result<Exit, CliError> {
    let mut study = open(layout)?;
    print_unread(&study.unread);
    let judgement = judge_all(&study);
    let wanted = |id: &str| matches(pattern, id);
    let mut trials = BTreeMap::new();
    if let Some(limit) = simulated {
        limit.apply(&mut study);
        for judged in judgement.verdicts.values().flatten().filter(|judged| wanted(&judged.id)) {
            trials.insert(judged.id.clone(), tried(&study, judged, common)?);
            if is_interrupted() {
                break;
            }
        }
    }
    let reached = |id: &str| !is_interrupted() || trials.contains_key(id);
    let texts = explanations(&study, &judgement, &trials, |id| wanted(id) && reached(id));
    if texts.is_empty() {
        return Err(no_entry(pattern, &judgement));
    }
    print(&texts.join("\n"))?;
    Ok(if study.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}

/// The entry with each assumption moved that the tables on disk have not; after an interrupt those that were done by then.
fn tried(study: &Study, judged: &Judged, common: &Args) -> Result<Vec<Trial>, CliError> {
    let Some(entry) = entry(study, judged) else { return Ok(Vec::new()) };
    let moves = untried(study, judged);
    let experiments: Vec<&Experiment> = study.items.iter().map(|item| &item.source.experiment).collect();
    let asked = (judged.experiment.as_str(), entry);
    let in_force = study.sheet.assumptions();
    let fitted = study.sheet.fitted().contains(&judged.id);
    let mut trials = Vec::new();
    // As many at once as there are threads: each portion ends with a line, and outlasts an interrupt of the next.
    for portion in moves.chunks(common.workers()) {
        let progress = Progress::new();
        let handler: &dyn EventHandler = if common.quiet { &IgnoreEvents } else { &progress };
        let reads = moved_alone(asked, portion, &experiments, &in_force, common.threads(), &Engine, handler);
        let reads = match reads {
            Err(RunError::Interrupted) => break,
            reads => reads.map_err(CalibrationError::from)?,
        };
        let trial = |((name, to), read): (&(AssumptionName, AssumptionValue), Read)| Trial {
            name: name.clone(),
            to: to.clone(),
            moved: moved(judged, read, fitted),
        };
        trials.extend(portion.iter().zip(reads).map(trial));
        print_progress(&format!(
            "{}: {} of {} simulated\n",
            judged.id,
            trials.len(),
            counted(moves.len(), "changed assumption", "changed assumptions")
        ));
    }
    Ok(trials)
}

/// As the page would judge it: a number keeps the uncertainties that it has in force, and an entry its part in fits and what it is blocked by.
fn moved(judged: &Judged, read: Read, fitted: bool) -> Moved {
    let (found, value, verdict) = match read.found {
        Found::Number { simulated, .. } => {
            let verdict = judged.comparison.as_ref().map_or(read.verdict, |known| known.verdict_of(simulated, fitted));
            (significant(simulated, 4), Some(simulated), verdict)
        }
        Found::Claim { holds } => {
            let found = match read.verdict {
                Verdict::Undecidable => "too close to call",
                _ if holds => "holds",
                _ => "does not hold",
            };
            let verdict = match read.verdict {
                Verdict::Missing => Verdict::Missing,
                _ if !judged.blocked_by.is_empty() => Verdict::Blocked,
                Verdict::Reproduced if fitted => Verdict::Fitted,
                other => other,
            };
            (found.into(), None, verdict)
        }
        Found::Nothing(reason) => (reason, None, read.verdict),
    };
    Moved { variant: String::new(), found, value, kept: verdict == judged.verdict, verdict }
}
