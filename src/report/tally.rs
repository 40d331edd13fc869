//! Verdicts in words and in numbers.

use crate::reference::{Judged, Role, Verdict};

/// All verdicts, the best first.
pub(super) const VERDICTS: [Verdict; 6] =
    [Verdict::Reproduced, Verdict::Fitted, Verdict::Differs, Verdict::Undecidable, Verdict::Blocked, Verdict::Missing];

/// The verdict's word.
pub(crate) fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Reproduced => "reproduced",
        Verdict::Fitted => "fitted",
        Verdict::Differs => "differs",
        Verdict::Undecidable => "undecidable",
        Verdict::Blocked => "blocked",
        Verdict::Missing => "missing",
    }
}

/// What the word means, for a reader who meets it for the first time.
pub(super) fn meaning(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Reproduced => "what came out agrees with the study, within the stated tolerance",
        Verdict::Fitted => {
            "it agrees, but an input that the study leaves open was chosen to make it agree: it proves nothing"
        }
        Verdict::Differs => "it does not agree, by more than all uncertainties together",
        Verdict::Undecidable => {
            "the motion is chaotic there and the published value lies within its spread: no run can confirm or refute it"
        }
        Verdict::Blocked => "it hangs on an input that the study does not give",
        Verdict::Missing => {
            "there is no result to hold against the study: not run, failed, out of date or not a number"
        }
    }
}

/// The verdict as a page shows it, with what was expected of it if that is something else.
pub(super) fn shown(judged: &Judged) -> String {
    let verdict = word(judged.verdict);
    if !judged.as_expected() {
        format!("**{verdict}** (expected: {})", word(judged.expected))
    } else if judged.verdict == Verdict::Reproduced {
        verdict.to_owned()
    } else {
        format!("{verdict}, as expected")
    }
}

/// The heads of the columns of [`agreeing`].
pub(super) const ROLES: [&str; 2] = ["fitted to", "held out"];

/// How many of the entries that inputs were fitted to agree, and how many of those held out: `3 of 4`, or nothing.
pub(super) fn agreeing<'a>(judged: impl IntoIterator<Item = &'a Judged> + Clone) -> [String; 2] {
    [Role::Fitted, Role::HeldOut].map(|role| {
        let of_role = || judged.clone().into_iter().filter(|one| one.role == role);
        let agree = of_role().filter(|one| matches!(one.verdict, Verdict::Reproduced | Verdict::Fitted)).count();
        match of_role().count() {
            0 => String::new(),
            all => format!("{agree} of {all}"),
        }
    })
}

/// The role of an entry as a page tells it.
pub(super) fn role(judged: &Judged) -> &'static str {
    match judged.role {
        Role::Fitted => "fitted",
        Role::HeldOut => "held out",
        Role::Neither => "neither",
    }
}

/// How many entries have each verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Tally {
    counts: [usize; VERDICTS.len()],
}

impl Tally {
    pub(super) fn of<'a>(judged: impl IntoIterator<Item = &'a Judged>) -> Self {
        let mut tally = Self::default();
        for one in judged {
            for (count, verdict) in tally.counts.iter_mut().zip(VERDICTS) {
                *count += usize::from(one.verdict == verdict);
            }
        }
        tally
    }

    pub(super) fn total(&self) -> usize {
        self.counts.iter().sum()
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
            .map(|(verdict, count)| format!("{count} {}", word(verdict)))
            .collect();
        if parts.is_empty() { "no entries".to_owned() } else { parts.join(", ") }
    }
}
