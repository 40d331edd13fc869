//! Verdicts in words and in numbers.

use crate::reference::{Judged, Role, Verdict};

/// All verdicts, the best first.
pub(super) const VERDICTS: [Verdict; 6] =
    [Verdict::Reproduced, Verdict::Fitted, Verdict::Differs, Verdict::Undecidable, Verdict::Blocked, Verdict::Missing];

/// The verdict's symbol.
pub(super) fn mark(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Reproduced => "●",
        Verdict::Fitted => "◐",
        Verdict::Differs => "✕",
        Verdict::Undecidable => "≈",
        Verdict::Blocked => "□",
        Verdict::Missing => "?",
    }
}

/// True if the entry agrees with the study, whatever that proves.
pub(super) fn agrees(verdict: Verdict) -> bool {
    matches!(verdict, Verdict::Reproduced | Verdict::Fitted)
}

/// What the word means, for a reader who meets it for the first time.
pub(super) fn meaning(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Reproduced => "agrees with the study within the stated tolerance",
        Verdict::Fitted => "agrees, but was used to choose an unstated input: it proves nothing",
        Verdict::Differs => "differs by more than all uncertainties together",
        Verdict::Undecidable => {
            "the chaotic spread or the grid is wider than the question: no run can confirm or refute it"
        }
        Verdict::Blocked => "depends on an input that the study does not state",
        Verdict::Missing => "no result to compare: not run, failed, out of date or not a number",
    }
}

/// The verdict as a page shows it, with what was expected of it if that is something else.
pub(super) fn shown(judged: &Judged) -> String {
    let verdict = format!("{} {}", mark(judged.verdict), judged.verdict.word());
    if judged.as_expected() { verdict } else { format!("**{verdict}** (expected: {})", judged.expected.word()) }
}

/// Whether the entry was used in fits; empty where it was not, and no fit kept it aside.
pub(super) fn role(judged: &Judged) -> &'static str {
    match judged.role {
        Role::Fitted => "yes",
        Role::CrossValidated => "yes; still predicted when left out",
        Role::HeldOut => "held out",
        Role::Neither => "",
    }
}

/// How many entries have each verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Tally {
    counts: [usize; VERDICTS.len()],
    used_in_fits: usize,
}

impl Tally {
    pub(super) fn of<'a>(judged: impl IntoIterator<Item = &'a Judged>) -> Self {
        let mut tally = Self::default();
        for one in judged {
            for (count, verdict) in tally.counts.iter_mut().zip(VERDICTS) {
                *count += usize::from(one.verdict == verdict);
            }
            tally.used_in_fits += usize::from(one.role.is_used_in_fits());
        }
        tally
    }

    pub(super) fn total(&self) -> usize {
        self.counts.iter().sum()
    }

    /// How many have this verdict.
    pub(super) fn count(&self, verdict: Verdict) -> usize {
        self.each().filter(|(one, _)| *one == verdict).map(|(_, count)| count).sum()
    }

    /// How many agree with the study.
    pub(super) fn agreeing(&self) -> usize {
        self.each().filter(|(verdict, _)| agrees(*verdict)).map(|(_, count)| count).sum()
    }

    /// How many were used to choose an unstated input, whatever their verdict: *fitted* are those of them that agree.
    pub(super) fn used_in_fits(&self) -> usize {
        self.used_in_fits
    }

    /// How many do not agree by a fit, which would be no evidence; a fitted entry that differs all the same is some.
    pub(super) fn evidence(&self) -> usize {
        self.total() - self.count(Verdict::Fitted)
    }

    /// All but those with this verdict.
    pub(super) fn without(mut self, verdict: Verdict) -> Self {
        self.counts.iter_mut().zip(VERDICTS).filter(|(_, one)| *one == verdict).for_each(|(count, _)| *count = 0);
        self
    }

    /// True if some entry has this verdict.
    pub(super) fn has(&self, verdict: Verdict) -> bool {
        self.count(verdict) > 0
    }

    /// Each verdict with its count.
    pub(super) fn each(&self) -> impl Iterator<Item = (Verdict, usize)> {
        VERDICTS.into_iter().zip(self.counts)
    }

    /// `3 reproduced, 1 differs`; `no entries`.
    pub(super) fn describe(&self) -> String {
        let parts: Vec<_> = self
            .each()
            .filter(|(_, count)| *count > 0)
            .map(|(verdict, count)| match verdict {
                Verdict::Differs if count > 1 => format!("{count} differ"),
                _ => format!("{count} {}", verdict.word()),
            })
            .collect();
        if parts.is_empty() { "no entries".to_owned() } else { parts.join(", ") }
    }
}
