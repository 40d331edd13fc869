//! A simulated value against a published one, after ASME V&V 20.
//!
//! E = S − D and u_val² = u_num² + u_input² + u_D². |E| ≤ 2 u_val (coverage factor 2) is agreement; more is `differs`.
//!
//! - u_num: the run's own error and the grid's, and the whole spread of the ensemble: a published number is one run, not
//!   a mean.
//! - u_input: each unstated input moved to the ends of its range; half the range of S, root-sum-square over the inputs;
//!   what the `tolerances` of design parameters leave of a settled motion, by its elasticities, joins them.
//! - u_D: half a unit of the last printed digit.
//!
//! Agreement must say something. S itself may be uncertain by no more than the publication is loose, or a tenth of the
//! published value (of the time between two of its kind, if it is an instant): 2 √(u_num² + u_input²) ≤ W with
//! W = max(2 u_D, |D|/10). A tenth still tells the velocity ratios 0.87
//! and 1.52 from the 1 of a damper that does nothing. Agreement through a wider u_val is not `reproduced`: it is `blocked`
//! where the unstated inputs make most of the width, `undecidable` where the chaotic spread or the grid does.
//!
//! An entry that an assumption was fitted to is `fitted` where it agrees and |E| ≤ W: the range of a fitted input says
//! nothing about how well the fit went. A tolerance set by hand takes the place of 2 u_val; of the condition it leaves
//! 2 · spread ≤ the larger of it and W: who sets it answers for u_input.

use super::verdict::{Comparison, Verdict};

/// Coverage factor: about 95 % where errors are normal.
pub(crate) const COVERAGE: f64 = 2.0;
/// Widest agreement that says something, as a fraction of the published value or its scale.
const TELLING: f64 = 0.1;

/// W: the widest agreement that says something.
pub(super) fn telling(u_data: f64, scale: f64) -> f64 {
    (COVERAGE * u_data).max(TELLING * scale)
}

/// The verdict on a value, and what there is to say beyond the numbers.
pub(crate) fn verdict(comparison: &Comparison, fitted: bool) -> (Verdict, Option<String>) {
    let error = comparison.error().abs();
    if error > comparison.tolerance() {
        return (Verdict::Differs, None);
    }
    let scale = comparison.scale.unwrap_or(comparison.published.abs());
    let telling = telling(comparison.u_data, scale);
    let simulated = COVERAGE * libm::hypot(comparison.u_num, comparison.u_input);
    let says_something = comparison.tolerance_by_hand.is_some()
        && COVERAGE * comparison.spread <= comparison.tolerance().max(telling)
        || simulated <= telling
        || fitted && error <= telling;
    if !says_something {
        let (verdict, cause) = if comparison.u_input > comparison.u_num {
            (Verdict::Blocked, "the unstated inputs alone move it by")
        } else if comparison.spread * comparison.spread > comparison.u_num * comparison.u_num / 2.0 {
            (Verdict::Undecidable, "the chaotic spread alone is")
        } else {
            (Verdict::Undecidable, "the run's own error, the sweep's grid and the digits of a printed place alone are")
        };
        let width = super::text::percent(simulated / scale);
        return (verdict, Some(format!("cannot be tested: {cause} ±{width}")));
    }
    (if fitted { Verdict::Fitted } else { Verdict::Reproduced }, None)
}
