//! A finding with the numbers of its result.

use super::page::{reproduced, share};
use super::{Calibrated, Compared};
use crate::experiment::{FindingNumber, FindingText, InputSet};

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
