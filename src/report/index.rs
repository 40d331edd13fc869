//! The index of all reports: the whole study at a glance.

use std::collections::BTreeMap;

use crate::reference::{Judged, Verdict};
use crate::study::Machine;

use super::markdown::{counted, first_sentence, one_line};
use super::tally::{Tally, VERDICTS, meaning, shown, word};
use super::view::{AssumptionView, ExperimentView};
use super::{assumption, chapter, comparison, glance};

/// What the words mean, once for all pages.
const SYMBOLS: &str = "\
| Symbol | Meaning |
| --- | --- |
| ψ | velocity ratio: RMS velocity of the structure without damper over the one with it; above 1 the damper helps |
| η | displacement ratio: the same with the standard deviation of the displacement |
| f′ = F/(m g) | dimensionless forcing amplitude: the force F over the weight of the base mass m |
| ω′ = ω/ωn | frequency ratio: forcing frequency over the natural frequency ωn = √(ks/m) |
| m′ = mp/m | mass ratio: particle mass over base mass |
| c′ = c/(2 √(ks m)) | structural damping ratio |
| cf/(2 √(kf mp)) | damping ratio of the resilient floor (and ceiling) under the particle |
| kf/ks, kw/ks | stiffness of floor and ceiling, and of the soft walls, over that of the structure |
| h′ = h ωn²/g | dimensionless gap clearance: free height h of the particle between floor and ceiling; ∞ without a ceiling |
| a ω²/g | dimensionless base amplitude of a harmonic force F = m a ω² |
";

const READING: &str = "\
Each page shows the figure that the study shows, drawn from new simulations, and holds every number and every claim of \
the study’s text against it. The study’s own curves are not available; an open diamond in a figure is a number that its \
text quotes.

A *number* is compared after ASME V&V 20: E = S − D is the difference between what came out, S, and what is published, \
D. It is held against the validation uncertainty u_val = √(u_num² + u_input² + u_D²): u_num is what the run itself \
may be off (its discretisation, the grid of its sweep, the spread of its ensemble), u_input the shift that the inputs left open by the study may cause, and u_D half a unit of the last printed \
digit. |E| below u_val means that the two agree as well as can be known. A *claim* in words (\"increases\", \"the same \
maximum\") is decided over the whole table. A verdict *rests on* the rows that were looked at for it, with every \
assumption moved: so many runs, and so many events in these rows. What that takes in time is measured on a page of its own.

An entry is *fitted* if an input that the study does not state was chosen by it, or is searched by it in a calibration; \
it is *held out* if a calibration keeps it aside to be tested by it. The columns \"fitted to\" and \"held out\" tell how \
many of those agree. Only what is held out, or neither, is evidence.

*Event-driven* runs follow the exact motion from one contact to the next; *fixed step* runs repeat the study’s scheme, \
which looks for contacts once a step, so that the difference between the two is what its step did to its curve. Impact \
dampers are chaotic in wide ranges: there the mean of an *ensemble* of minutely perturbed starts is shown, and the band \
is its standard deviation.

Every run is *proved* by its balances: what the excitation gave in momentum and energy is found again in motion, springs \
and losses, up to the residual shown, in chaotic runs too. The *smallest margin* is the distance by which a surface would \
have to be moved for the order of contacts to change; *ties* are events at the same instant, which were put into an \
order.
";

/// `reports/README.md`: everything at a glance. `experiments` in the order in which the index lists them; `measured` are
/// the pages that other commands have written: title and link; `machine` is where times were taken, if they were.
#[must_use]
pub fn index(
    experiments: &[ExperimentView<'_>],
    assumptions: &[AssumptionView],
    measured: &[(&str, &str)],
    machine: Option<&Machine>,
) -> String {
    let judged = || experiments.iter().flat_map(|view| view.judged);
    let tally = Tally::of(judged());
    let unexpected = judged().filter(|one| !one.as_expected()).count();
    let mut text = String::from(
        "# The study at a glance\n\nNew simulations of a published study of particle impact dampers, held against the numbers and claims of its \
         text.\n\n",
    );
    text += &format!(
        "{}; {}: {}. {}\n\n",
        counted(experiments.len(), "experiment", "experiments"),
        counted(tally.total(), "published number or claim", "published numbers and claims"),
        tally.describe(),
        match unexpected {
            0 => "Every verdict is the expected one.".to_owned(),
            1 => "**One verdict is not the expected one.**".to_owned(),
            more => format!("**{more} verdicts are not the expected ones.**"),
        }
    );
    let mut chapters: BTreeMap<u32, Vec<&ExperimentView<'_>>> = BTreeMap::new();
    for view in experiments {
        chapters.entry(view.experiment.source.chapter).or_default().push(view);
    }
    text += &glance::table(&chapters);
    if let Some(Machine { processor, threads, system, build }) = machine {
        text += &format!(
            "Processor time of one run from nothing ({processor}, {threads} threads, {system}, {build}); a run on n \
             threads takes about the n-th part of it.\n\n"
        );
    }
    text += "[How to read a page](#how-to-read-a-page) · [Not reproduced](#not-reproduced) · \
             [Assumptions](#assumptions) · [Tolerances set by hand](#tolerances-set-by-hand)";
    for (title, link) in measured {
        text += &format!(" · [{title}]({link})");
    }
    text += "\n\n";
    for (number, views) in &chapters {
        text += &chapter::section(*number, views);
    }
    text += "## Not reproduced\n\n";
    text += &not_reproduced(experiments);
    text += "## Assumptions\n\nInputs that the study uses and does not state.\n\n";
    text += &assumption::table_with_entries(assumptions);
    text += "## Tolerances set by hand\n\n";
    text += &tolerances(experiments);
    text += "## How to read a page\n\n";
    text += READING;
    text += "\n| Verdict | Meaning |\n| --- | --- |\n";
    for verdict in VERDICTS {
        text += &format!("| {} | {} |\n", word(verdict), meaning(verdict));
    }
    text += "\n";
    text += SYMBOLS;
    text
}

fn not_reproduced(experiments: &[ExperimentView<'_>]) -> String {
    let line = |view: &ExperimentView<'_>, one: &Judged| {
        let why = first_sentence(&comparison::explanation(one));
        format!("- [`{}`]({}): {}. {} {why}\n", one.id, view.page, shown(one), closed(&one.statement))
    };
    listed(experiments, |view, one| (one.verdict != Verdict::Reproduced).then(|| line(view, one)))
        .unwrap_or_else(|| "Everything is reproduced.\n\n".to_owned())
}

fn tolerances(experiments: &[ExperimentView<'_>]) -> String {
    listed(experiments, |view, one| Some(format!("- [`{}`]({}): {}\n", one.id, view.page, comparison::tolerance(one)?)))
        .unwrap_or_else(|| "None: every tolerance follows from u_val or from the claim itself.\n\n".to_owned())
}

/// A line for each entry that has one; `None` without any.
fn listed(
    experiments: &[ExperimentView<'_>],
    line: impl Fn(&ExperimentView<'_>, &Judged) -> Option<String>,
) -> Option<String> {
    let lines: String =
        experiments.iter().flat_map(|view| view.judged.iter().filter_map(|one| line(view, one))).collect();
    (!lines.is_empty()).then(|| lines + "\n")
}

/// A statement as a sentence.
fn closed(statement: &str) -> String {
    let statement = one_line(statement);
    if statement.ends_with(['.', '!', '?']) { statement } else { format!("{statement}.") }
}
