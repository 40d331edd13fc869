//! What can be wrong with an entry, each as the rest of a sentence that begins with its id.

use super::printed::PrintedError;
use super::prose::ProseError;

/// One mistake.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the words say all")]
pub enum EntryMistake {
    #[error("has the id of an entry above")]
    SameId,
    #[error("needs an id of small letters, digits and hyphens")]
    BadId,
    #[error("needs a `place` in the source and what it `says`")]
    NoPlace,
    #[error("expects `missing`, which is never an expected verdict")]
    ExpectsMissing,
    #[error("expects another verdict than `reproduced` and needs an `explanation`")]
    NoExplanation,
    #[error("has in its `explanation` {0}")]
    Explanation(ProseError),
    #[error("has a placeholder of `{0}`, which is no entry here")]
    Placeholder(String),
    #[error("expects `blocked` and needs `blocked_by`: which input the study does not give")]
    NotBlockedBy,
    #[error(
        "has `blocked_by`, which belongs to claims: what a number waits for is read off its moved assumptions; an input without one needs an assumption with a `range`"
    )]
    NumberBlockedBy,
    #[error("needs exactly one of `value` with `from`, `claim`, `peak`, `curve` or `mode_shape`")]
    NotOneKind,
    #[error("has a `value` that cannot be read: {0}")]
    Value(PrintedError),
    #[error("has a `value` and needs `from`: where its counterpart stands in the table")]
    NoFrom,
    #[error("has `from`, which belongs to a `value`")]
    FromWithoutValue,
    #[error("has a number in `from` that is not finite, or zero where it cannot be")]
    UnsoundFrom,
    #[error("has an unsound claim: {0}")]
    Claim(&'static str),
    #[error("has a threshold set by hand and needs a `threshold_reason`")]
    NoThresholdReason,
    #[error("has a `threshold_reason`, which belongs to claims; a `tolerance` has its own")]
    ThresholdReasonOfValue,
    #[error("has a `peak` without a printed number: give `at`, `height` or `half_power_width`")]
    PeakWithoutNumber,
    #[error("has a `peak` that needs `which`: {{nearest: 26 rad/s}}, {{number: 1}} or highest")]
    PeakWithoutWhich,
    #[error("counts peaks from 1")]
    PeakZero,
    #[error("has a `prominence` of {given}, which is no fraction of the peak's height")]
    Prominence { given: String },
    #[error("has a `tolerance`, which belongs to values; a claim has its own thresholds")]
    ToleranceOfClaim,
    #[error("has an absolute `tolerance`, and a peak has numbers of several units: make it relative")]
    AbsoluteToleranceOfPeak,
    #[error("has a `tolerance` that is neither `relative` nor `absolute`")]
    ToleranceWithoutSize,
    #[error("has a `tolerance` that is not a number above zero")]
    ToleranceNotAboveZero,
    #[error("has a `tolerance` set by hand and needs its `reason`")]
    NoToleranceReason,
}
