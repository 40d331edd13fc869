//! The index of all reports: the study in one page.

use crate::experiment::AboutStudy;
use crate::study::Machine;
use crate::text::number::quantity;

use super::markdown::one_line;
use super::view::ExperimentView;
use super::{chapter, headline, reading, strip};

/// The index, by name within the study.
pub const INDEX: &str = "reports/README.md";

/// The pictures of the index, by name below `reports/`.
pub(super) const STRIP: &str = "verdicts.svg";
pub(super) const OVERVIEW: &str = "overview.svg";

/// What the study and the index are.
pub(super) fn head(about: &AboutStudy) -> String {
    let mut text = String::from("# The study in one page\n\n");
    if let Some(opening) = &about.about {
        text += &format!("{}\n\n", one_line(opening));
    }
    text
}

/// `reports/README.md`. `about` is what the study says of itself; `experiments` in the order in which the index lists them;
/// `others` are further pages: title and link; `machine` is where times were taken, if they were.
#[must_use]
pub fn index(
    about: &AboutStudy,
    experiments: &[ExperimentView<'_>],
    others: &[(&str, &str)],
    machine: Option<&Machine>,
) -> String {
    let mut text = head(about);
    text += &headline::section(about, experiments);
    text += &reading::section();
    if experiments.iter().any(|view| !view.judged.is_empty()) {
        text += &every_verdict(about, experiments);
    }
    text += &chapter::tables(about, experiments);
    let total: f64 = experiments.iter().filter_map(|view| view.seconds).sum();
    if let Some(Machine { processor, threads, system, build }) = machine {
        text += &format!(
            "Time is processor time of one run from nothing, {} in all ({processor}, {threads} threads, {system}, {build}); divide \
             by the number of threads.\n\n",
            quantity(total, "s", 2)
        );
    }
    text += "## More\n\n[Kinds of motion](what-moves-how.md) · [Assumptions](assumptions.md) · [Tolerances set by hand](tolerances.md)";
    for (title, link) in others {
        text += &format!(" · [{title}]({link})");
    }
    text + "\n"
}

/// Cells of all verdicts, and bars of all numbers.
fn every_verdict(about: &AboutStudy, experiments: &[ExperimentView<'_>]) -> String {
    let mut text = String::from(
        "## Every verdict\n\nOne cell for each number or claim; below, each that does not agree is linked, bold where it is held out.\n\n",
    );
    text += &format!("![Verdicts by chapter]({STRIP})\n\n");
    text += &strip::links(about, experiments);
    text += &format!(
        "<details open><summary>All numbers: S/D with bars of ± tolerance/D, and |E|/u_val</summary>\n\n![Numbers of the study]({OVERVIEW})\n\n</details>\n\n"
    );
    text
}
