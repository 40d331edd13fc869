//! All tolerances that were set by hand, on a page of their own.

use super::comparison::tolerance;
use super::view::ExperimentView;

/// `reports/tolerances.md`.
#[must_use]
pub fn tolerances(experiments: &[ExperimentView<'_>]) -> String {
    let mut text = String::from(
        "# Tolerances set by hand\n\nA tolerance set by hand replaces the derived one, 2 u_val; a claim has one where it needs a \
         threshold. [The study in one page](README.md)\n\n",
    );
    let entries = experiments.iter().flat_map(|view| view.judged.iter().map(move |one| (view, one)));
    let lines: String = entries
        .filter_map(|(view, one)| Some(format!("- [`{}`]({}): {}\n", one.id, view.place_of(one), tolerance(one)?)))
        .collect();
    text += if lines.is_empty() { "There are none.\n" } else { &lines };
    text
}
