//! The index of all reports: the study in one page.

use crate::study::Machine;
use crate::text::number::quantity;

use super::view::ExperimentView;
use super::{chapter, headline, reading, strip};

/// The pictures of the index, by name below `reports/`.
pub(super) const STRIP: &str = "verdicts.svg";
pub(super) const OVERVIEW: &str = "overview.svg";

/// What the study and the index are.
pub(super) const HEAD: &str = "\
# The study in one page

New simulations of a published study of particle impact dampers, compared with the numbers and claims of its text.

";

/// `reports/README.md`. `experiments` in the order in which the index lists them; `others` are further pages: title and link;
/// `machine` is where times were taken, if they were.
#[must_use]
pub fn index(experiments: &[ExperimentView<'_>], others: &[(&str, &str)], machine: Option<&Machine>) -> String {
    let mut text = HEAD.to_owned();
    text += &headline::section(experiments);
    text += &reading::section();
    text += "## Every verdict\n\nOne cell for each number or claim; below, each that does not agree is linked, bold where it is held out.\n\n";
    text += &format!("![Verdicts by chapter]({STRIP})\n\n");
    text += &strip::links(experiments);
    text += &format!(
        "<details open><summary>All numbers: S/D with bars of ± tolerance/D, and |E|/u_val</summary>\n\n![Numbers of the study]({OVERVIEW})\n\n</details>\n\n"
    );
    text += &chapter::tables(experiments);
    let total: f64 = experiments.iter().filter_map(|view| view.seconds).sum();
    if let Some(Machine { processor, threads, system, build }) = machine {
        text += &format!(
            "Time is processor time of one run from nothing, {} in all ({processor}, {threads} threads, {system}, {build}); divide \
             by the number of threads.\n\n",
            quantity(total, "s", 2)
        );
    }
    text += "## More\n\n[Assumptions](assumptions.md) · [Tolerances set by hand](tolerances.md)";
    for (title, link) in others {
        text += &format!(" · [{title}]({link})");
    }
    text + "\n"
}
