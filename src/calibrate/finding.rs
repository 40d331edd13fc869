//! A finding with the numbers of its result.

use super::{Calibrated, Compared, Read};
use crate::experiment::{FindingNumber, FindingText, InputSet};
use crate::reference::Verdict;
use crate::text::number;

/// The finding as the page has it.
pub(super) fn filled(finding: &FindingText, result: &Calibrated) -> String {
    finding.filled(|number| match number {
        FindingNumber::Residual(InputSet::Best) => share(result.best),
        FindingNumber::Residual(InputSet::InForce) => share(result.in_force),
        FindingNumber::Fitted(set) => count(&result.fitted, set),
        FindingNumber::HeldOut(set) => count(&result.held_out, set),
        FindingNumber::With { input, value } => {
            share(result.profiles.get(input).and_then(|profile| profile.residuals.get(value).copied().flatten()))
        }
    })
}

fn count(entries: &[Compared], set: InputSet) -> String {
    match set {
        InputSet::Best => reproduced(entries, |one| &one.best),
        InputSet::InForce => reproduced(entries, |one| &one.in_force),
    }
}

pub(super) fn share(residual: Option<f64>) -> String {
    residual.map_or_else(|| "none".into(), |residual| format!("{} %", number::significant(100.0 * residual, 2)))
}

/// How many of them: `8 of 23`.
pub(super) fn reproduced(list: &[Compared], of: fn(&Compared) -> &Read) -> String {
    let count = list.iter().filter(|one| of(one).verdict == Verdict::Reproduced).count();
    format!("{count} of {}", list.len())
}
