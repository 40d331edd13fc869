//! Which keys of an experiment do not stand beside each other. The reader says why, the JSON Schema follows.

use crate::yaml::{Findings, Keys, Span};

/// The lists that a row may keep; at most one of them, as all lists of a row are of one length.
const LISTS: [&str; 4] = ["trace", "energies", "shape", "each_cycle"];

/// A key, and what does not stand beside it.
struct Alone {
    key: &'static str,
    /// Others than lists, which none of them has.
    others: &'static [&'static str],
    why: &'static str,
    help: &'static str,
}

const APART: &str = "give one of the two an experiment of its own";

/// The keys that make the rows of the table.
const ROWS: [Alone; 3] = [
    Alone {
        key: "optimise",
        others: &["sweep", "maximise", "onset"],
        why: "an optimisation has candidates for rows: neither a sweep nor a list of another kind goes with it",
        help: "what fitness is a mean over stands under `mean_over`",
    },
    Alone {
        key: "orbit",
        others: &["sweep", "mean_over", "maximise", "onset", "optimise"],
        why: "an orbit has the motions of its branches for rows: no sweep, mean, maximum or list goes with it",
        help: APART,
    },
    Alone {
        key: "starts",
        others: &["mean_over", "maximise", "onset", "optimise", "orbit"],
        why: "random starts have the motions that they end in for rows: no mean, maximum, orbit or list goes with them",
        help: APART,
    },
];

/// A mean has no time history.
const MEAN: Alone = Alone {
    key: "mean_over",
    others: &[],
    why: "a mean over several scenes has no list of one of them",
    help: "give one of the scenes an experiment of its own",
};

/// Reports what stands beside a key that makes the rows, and should not.
pub(super) fn check_rows(keys: &Keys<'_>, findings: &Findings) -> Option<()> {
    let mut fine = Some(());
    for alone in &ROWS {
        for span in alone.beside(keys) {
            fine = alone.report(span, findings);
        }
    }
    fine
}

/// Reports a list beside a mean; a second list is reported as such.
pub(super) fn check_mean(keys: &Keys<'_>, findings: &Findings) -> Option<()> {
    match MEAN.beside(keys).first() {
        Some(list) => MEAN.report(*list, findings),
        None => Some(()),
    }
}

/// Reports a second list.
pub(super) fn check_lists(keys: &Keys<'_>, findings: &Findings) -> Option<()> {
    match keys.of_which_one(&LISTS).as_slice() {
        [_, second, ..] => findings.report(
            *second,
            "a row keeps lists of one length: one of `trace`, `energies`, `shape` and `each_cycle`",
            Some("give the other an experiment of its own".into()),
        ),
        _ => Some(()),
    }
}

impl Alone {
    fn beside(&self, keys: &Keys<'_>) -> Vec<Span> {
        keys.beside(self.key, &[self.others, &LISTS].concat())
    }

    fn report(&self, at: Span, findings: &Findings) -> Option<()> {
        findings.report(at, self.why, Some(self.help.into()))
    }
}
