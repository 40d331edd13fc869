//! Verdicts as JUnit XML, for any CI: an entry is a test case, an experiment a suite.
//!
//! A failure is a verdict that is not the expected one, an error a result that is missing or a file that cannot be used. An entry that is expected
//! to be blocked or undecidable is skipped: nothing was decided there. All text stands in the content of the elements,
//! where every reader shows it.

use std::fmt::Write;

use crate::reference::{Judged, Verdict};

use super::finding::{self, CheckView, Trouble};
use super::markdown::one_line;

/// The suite of files that could not be used.
const FILES: &str = "files";

/// One `testsuites` document.
#[must_use]
pub fn junit(view: &CheckView<'_>) -> String {
    let mut suites: Vec<Suite> = Vec::new();
    if !view.troubles.is_empty() {
        suites.push(Suite { name: FILES.into(), cases: troubles(&view.troubles) });
    }
    for entry in &view.entries {
        let case = Case { name: entry.judged.id.clone(), outcome: outcome(entry.judged) };
        match suites.last_mut() {
            Some(last) if last.name == entry.judged.experiment => last.cases.push(case),
            _ => suites.push(Suite { name: entry.judged.experiment.clone(), cases: vec![case] }),
        }
    }
    let all = Counts::of(suites.iter().flat_map(|suite| &suite.cases));
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    xml += &format!("<testsuites name=\"shotdamp\"{all}>\n");
    for suite in &suites {
        xml += &suite.xml();
    }
    xml + "</testsuites>\n"
}

struct Suite {
    name: String,
    cases: Vec<Case>,
}

struct Case {
    name: String,
    outcome: Outcome,
}

enum Outcome {
    /// With what is known of it, if it is not simply reproduced.
    Passed(String),
    Skipped(Told),
    Failure(Told),
    Error(Told),
}

/// A line and the whole text.
struct Told {
    message: String,
    text: String,
}

fn outcome(one: &Judged) -> Outcome {
    let known = || format!("{}: {}", one.verdict.word(), one_line(&one.found));
    if one.as_expected() {
        return match one.verdict {
            Verdict::Blocked | Verdict::Undecidable => {
                Outcome::Skipped(Told { message: known(), text: one_line(&one.explanation) })
            }
            Verdict::Reproduced => Outcome::Passed(String::new()),
            _ => Outcome::Passed(format!("{}\n{}", known(), one_line(&one.explanation))),
        };
    }
    let message = format!("expected {}, came {}", one.expected.word(), one.verdict.word());
    let mut text = format!("{message}\n");
    for (label, line) in finding::lines(one) {
        text += &format!("{label}: {line}\n");
    }
    let description = Told { message, text };
    if one.verdict == Verdict::Missing { Outcome::Error(description) } else { Outcome::Failure(description) }
}

fn troubles(troubles: &[Trouble]) -> Vec<Case> {
    let case = |(index, trouble): (usize, &Trouble)| {
        // A file may be in trouble for several reasons, and names are unique.
        let before = troubles[..index].iter().filter(|other| other.file == trouble.file).count();
        let name = if before == 0 { trouble.file.clone() } else { format!("{}#{}", trouble.file, before + 1) };
        let description = Told { message: "this file cannot be used".into(), text: trouble.message.clone() };
        Case { name, outcome: Outcome::Error(description) }
    };
    troubles.iter().enumerate().map(case).collect()
}

impl Suite {
    fn xml(&self) -> String {
        let mut xml = format!("  <testsuite name=\"{}\"{}>\n", escaped(&self.name), Counts::of(&self.cases));
        for case in &self.cases {
            let (name, suite) = (escaped(&case.name), escaped(&self.name));
            xml += &format!("    <testcase classname=\"{suite}\" name=\"{name}\"");
            xml += &match &case.outcome {
                Outcome::Passed(description) if description.is_empty() => "/>\n".to_owned(),
                Outcome::Passed(description) => {
                    format!(">\n      <system-out>{}</system-out>\n    </testcase>\n", escaped(description))
                }
                Outcome::Skipped(description) => description.xml("skipped", ""),
                Outcome::Failure(description) => description.xml("failure", " type=\"unexpected\""),
                Outcome::Error(description) => description.xml("error", " type=\"missing\""),
            };
        }
        xml + "  </testsuite>\n"
    }
}

impl Told {
    fn xml(&self, element: &str, attributes: &str) -> String {
        format!(
            ">\n      <{element} message=\"{}\"{attributes}>{}</{element}>\n    </testcase>\n",
            escaped(&one_line(&self.message)),
            escaped(&self.text)
        )
    }
}

#[derive(Default)]
struct Counts {
    tests: usize,
    failures: usize,
    errors: usize,
    skipped: usize,
}

impl Counts {
    fn of<'c>(cases: impl IntoIterator<Item = &'c Case>) -> Self {
        let mut counts = Self::default();
        for case in cases {
            counts.tests += 1;
            match case.outcome {
                Outcome::Passed(_) => {}
                Outcome::Skipped(_) => counts.skipped += 1,
                Outcome::Failure(_) => counts.failures += 1,
                Outcome::Error(_) => counts.errors += 1,
            }
        }
        counts
    }
}

impl std::fmt::Display for Counts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { tests, failures, errors, skipped } = self;
        write!(f, " tests=\"{tests}\" failures=\"{failures}\" errors=\"{errors}\" skipped=\"{skipped}\"")
    }
}

/// Safe in content and in attributes; characters that XML 1.0 cannot hold become question marks.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\n' | '\t' => safe.push(letter),
            '\u{FFFE}' | '\u{FFFF}' => safe.push('?'),
            // As a reference, so that no reader takes it for the end of a line.
            '\r' => {
                let _ = write!(safe, "&#{};", u32::from(letter));
            }
            _ if letter < ' ' => safe.push('?'),
            _ => safe.push(letter),
        }
    }
    safe
}
