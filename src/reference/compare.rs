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

use serde::{Deserialize, Serialize};

use super::printed::Printed;
use super::text::{MOST_DIGITS, percent, significant, with_unit};
use super::verdict::Verdict;
use crate::text::number;

/// Coverage factor: about 95 % where errors are normal.
pub(crate) const COVERAGE: f64 = 2.0;
/// Widest agreement that says something, as a fraction of the published value or its scale.
const TELLING: f64 = 0.1;

/// W: the widest agreement that says something.
pub(super) fn telling(u_data: f64, scale: f64) -> f64 {
    (COVERAGE * u_data).max(TELLING * scale)
}

/// A value held against the published one, after ASME V&V 20.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// S, what came out.
    pub simulated: f64,
    /// D, what is published.
    pub published: f64,
    /// u_num: the run's own error, the grid's, and the spread of the ensemble, of which the published run is one member.
    pub u_num: f64,
    /// u_input: from the sensitivity to the unstated inputs.
    pub u_input: f64,
    /// u_D: half a unit of the last printed digit; 0 of a number of events.
    pub u_data: f64,
    /// Spread of the ensemble at that point (standard deviation).
    pub spread: f64,
    /// The tolerance in force, if it was set by hand.
    pub tolerance_by_hand: Option<f64>,
    /// What agreement is measured against where zero is no natural origin: the time between two events of the kind.
    #[serde(skip)]
    pub scale: Option<f64>,
}

impl Comparison {
    /// E = S − D.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.simulated - self.published
    }

    /// u_val = √(u_num² + u_input² + u_D²).
    #[must_use]
    pub fn u_val(&self) -> f64 {
        (self.u_num * self.u_num + self.u_input * self.u_input + self.u_data * self.u_data).sqrt()
    }

    /// 2 u_val: the tolerance that follows from the uncertainties (coverage factor 2).
    #[must_use]
    pub fn derived_tolerance(&self) -> f64 {
        COVERAGE * self.u_val()
    }

    /// The tolerance in force, in the unit of the comparison.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.tolerance_by_hand.unwrap_or(self.derived_tolerance())
    }

    /// The verdict that another number would have in the place of this one, with the same uncertainties.
    #[must_use]
    pub fn verdict_of(&self, simulated: f64, fitted: bool) -> Verdict {
        verdict(&Self { simulated, ..*self }, fitted).0
    }

    /// What the table's unit is in the unit of the publication; a number of events has none.
    pub(crate) fn in_unit_of(&self, published: &Printed) -> f64 {
        if self.u_data > 0.0 { published.half_unit() / self.u_data } else { 1.0 }
    }

    /// Another number in the place of this one, in the unit of the publication: `6937 mm/s`.
    #[must_use]
    pub fn in_words(&self, simulated: f64, published: &Printed) -> String {
        let number = significant(simulated * self.in_unit_of(published), 4);
        format!("{number} {}", published.unit()).trim_end().to_owned()
    }

    /// |E|/u_val: how far it is off in units of its uncertainty.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        self.error().abs() / self.u_val()
    }

    /// Digits that agree, −log10(|S − D|/|D|), as NIST StRD tells it.
    #[must_use]
    pub fn digits(&self) -> f64 {
        -libm::log10(self.error().abs() / self.published.abs())
    }

    /// What came out beside what is published, in the unit of the publication: `628 ± 65 mm/s, 21 % below 794.8 mm/s`. An instant,
    /// with the time `scale` between two of its kind, is told by the time between: `52.327 ± 0.010 s, 17 ms after 52.31 s: 3.4 u_val,
    /// 4.6 % of the time between two such events`.
    pub(crate) fn measured(&self, published: &Printed) -> String {
        let factor = self.in_unit_of(published);
        let (here, wide) = (self.simulated * factor, COVERAGE * self.u_val() * factor);
        let unit = if published.unit().is_empty() { String::new() } else { format!(" {}", published.unit()) };
        // Of a count that all runs agree on, rounding is all there is.
        let here = if self.u_data == 0.0 && wide < 1e-9 * here.abs() {
            significant(here, MOST_DIGITS)
        } else {
            let (value, uncertainty) = number::with_uncertainty(here, wide);
            format!("{value} ± {uncertainty}{unit}")
        };
        let (error, datum) = (self.error(), published.text());
        let side = |above: &'static str, below: &'static str| if error < 0.0 { below } else { above };
        if let Some(scale) = self.scale {
            let (late, units) = (with_unit(error.abs(), 2, "s"), significant(self.deviation(), 2));
            let share = percent(error.abs() / scale);
            return format!(
                "{here}, {late} {} {datum}: {units} u_val, {share} of the time between two such events",
                side("after", "before")
            );
        }
        match error.abs() / self.published.abs() {
            off if off.is_finite() && off > 0.0 => {
                format!("{here}, {} {} {datum}", percent(off), side("above", "below"))
            }
            0.0 => format!("{here}, equal to {datum}"),
            _ => format!("{here}; the study: {datum}"),
        }
    }
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
        let width = percent(simulated / scale);
        return (verdict, Some(format!("cannot be tested: {cause} ±{width}")));
    }
    (if fitted { Verdict::Fitted } else { Verdict::Reproduced }, None)
}
