//! Reading a reference file, and its JSON Schema, which is what the same reader says of a sketch.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::Path;

use serde_json::{Value as Schema, json};

use super::entry::{Check, Entry, NotJudged, ReferenceFile, Tolerance, ToleranceSize};
use super::extraction::extraction;
use super::mode_shape::ModeShape;
use super::predicate::Predicate;
use super::printed::{Printed, units_beside};
use super::prose::Prose;
use super::resonance::PrintedPeak;
use super::selection::Selection;
use super::tube::Curve;
use super::verdict::Verdict;
use crate::atomic::from_here;
use crate::experiment::read;
use crate::yaml::{At, Keys, Problems, Span, Value, described, parsed, place, words_of};

/// Reads a reference file; its name is the id of its experiment.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn load_reference(path: &Path) -> Result<ReferenceFile, Problems> {
    let file = from_here(path);
    let experiment = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    parse_reference(experiment, &file, &read(path, &file)?)
}

/// Reads the reference of an experiment from its text; `file` only names it in messages.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn parse_reference(experiment: &str, file: &str, text: &str) -> Result<ReferenceFile, Problems> {
    parsed(file, text, |at| Reader::new(experiment, text).file(at))
}

/// JSON Schema of a reference file.
#[must_use]
pub fn reference_schema() -> Schema {
    described("Reference", "What the study says of one experiment", |at| Reader::new("", "").file(at))
}

/// The ways to check an entry; each has one.
const KINDS: [&str; 5] = ["value", "claim", "peak", "curve", "mode_shape"];

struct Reader<'t> {
    experiment: &'t str,
    text: &'t str,
    /// The ids so far, as written.
    ids: RefCell<BTreeSet<String>>,
    /// Entries that placeholders name, with the places of the explanations.
    named: RefCell<Vec<(String, Span)>>,
}

impl<'t> Reader<'t> {
    fn new(experiment: &'t str, text: &'t str) -> Self {
        Self { experiment, text, ids: RefCell::default(), named: RefCell::default() }
    }

    fn file(&self, at: At<'_>) -> Option<ReferenceFile> {
        let keys = at.keys("a reference file")?;
        let entries = keys.required("entries", "Published numbers and claims", |at| at.list(|at| self.entry(at)));
        let beside = "What the study says beside these and nothing here can judge";
        let not_judged = keys.optional("not_judged", beside, |at| at.list(NotJudged::read));
        keys.close()?;
        let ids = self.ids.borrow();
        for (name, span) in self.named.borrow().iter().filter(|(name, _)| !name.contains('/') && !ids.contains(name)) {
            at.wrong_at::<()>(*span, format!("a placeholder of `{name}`, which is no entry here"));
        }
        Some(ReferenceFile {
            experiment: self.experiment.into(),
            entries: entries?,
            not_judged: not_judged?.unwrap_or_default(),
        })
    }

    fn entry(&self, at: At<'_>) -> Option<Entry> {
        let keys = at.keys("an entry")?;
        let id = keys.required("id", "Unique in the file, of small letters, digits and hyphens", |at| self.id(at));
        let place = keys.required("place", "Where it stands: s. 3.6.3, Fig. 18", |at| at.text());
        let says = keys.required("says", "What the study says, in one line", |at| at.text());
        let check = self.check(&keys);
        let rows = keys.or("where", "The rows that are meant, by column", Selection::read, Selection::default());
        let of_verdict = "The verdict that is expected; reproduced unless stated";
        let expected = keys.or("expected", of_verdict, expected, Verdict::Reproduced);
        let why = "Why it is expected to differ, to be blocked or undecidable; or a note";
        let explanation = keys.or("explanation", why, |at| self.explanation(at), String::new());
        let inputs = "Inputs that the study does not give and a claim waits for";
        let blocked_by = keys.or("blocked_by", inputs, |at| at.list(|at| at.text()), Vec::new());
        if expected.is_some_and(|expected| expected != Verdict::Reproduced) {
            keys.wants::<()>(&["explanation"], "why another verdict than `reproduced` is expected");
        }
        let is_number = keys.get("value").or(keys.get("peak")).is_some();
        if expected == Some(Verdict::Blocked) && !is_number {
            keys.wants::<()>(&["blocked_by"], "which input the study does not give");
        }
        if let (true, Some(at)) = (is_number, keys.get("blocked_by")) {
            let help = "what a number waits for is read off its moved assumptions; an input without one needs an assumption with a `range`";
            at.report::<()>("`blocked_by` belongs to claims", Some(help.into()));
        }
        keys.rule(|| {
            json!({
                "if": {"required": ["expected"], "properties": {"expected": {"not": {"const": "reproduced"}}}},
                "then": {"required": ["explanation"]},
            })
        });
        keys.close()?;
        Some(Entry {
            id: format!("{}/{}", self.experiment, id?),
            place: place?,
            says: says?,
            check: check?,
            rows: rows?,
            expected: expected?,
            explanation: explanation?,
            blocked_by: blocked_by?,
            line: self::place(self.text, at.span()).line as u64,
        })
    }

    fn id(&self, at: At<'_>) -> Option<String> {
        let read = |at: At<'_>| {
            let id = at.text()?;
            let new = self.ids.borrow_mut().insert(id.clone());
            if !id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-') {
                return at.wrong(format!("`{id}` is no id: write small letters, digits and hyphens"));
            }
            if new { Some(id) } else { at.wrong(format!("an entry above has the id `{id}`")) }
        };
        at.form(
            |node, findings| read(At::Node(node, findings)),
            |it| json!({"description": it.about(), "type": "string", "pattern": "^[a-z0-9-]+$"}),
        )
    }

    fn explanation(&self, at: At<'_>) -> Option<String> {
        let text = at.text()?;
        match Prose::parse(&text) {
            Ok(prose) => {
                let names = prose.placeholders().filter_map(|one| one.entry.clone());
                self.named.borrow_mut().extend(names.map(|name| (name, at.span())));
                Some(text)
            }
            Err(error) => at.wrong(format!("the explanation has {error}")),
        }
    }

    /// The one of [`KINDS`] that is given, with what belongs to it.
    fn check(&self, keys: &Keys<'_>) -> Option<Check> {
        let value = keys.optional("value", "The number as printed: its digits count", Printed::read);
        let claim = keys.optional("claim", "A claim in words", Predicate::read);
        let peak = keys.optional("peak", "The numbers of a resonance", PrintedPeak::read);
        let curve = keys.optional("curve", "A published curve", Curve::read);
        let mode_shape = keys.optional("mode_shape", "A published or analytic shape", ModeShape::read);
        let from = keys.optional("from", "The counterpart of the `value` in the table", extraction);
        let tolerance = keys.optional("tolerance", "A tolerance of a number, set by hand", read_tolerance);
        let of_thresholds = "Why the thresholds of a claim are what they are";
        let threshold_reason = keys.optional("threshold_reason", of_thresholds, |at| at.text());
        rules(keys);
        let mut given: Vec<_> = KINDS.into_iter().filter_map(|kind| Some((kind, keys.get(kind)?))).collect();
        given.sort_by_key(|(_, at)| at.span().start);
        let kind = match given.as_slice() {
            [] => return keys.wants(&KINDS, "how it is checked"),
            [(kind, _)] => *kind,
            [(first, _), (second, at), ..] => {
                let help = "keep one of the two, or make two entries of them";
                return at.report(
                    format!("an entry is checked in one way, not by both `{first}` and `{second}`"),
                    Some(help.into()),
                );
            }
        };
        let is_number = ["value", "peak"].contains(&kind);
        let belongs = |key: &'static str, here: bool, whose: &str| match keys.get(key) {
            Some(at) if !here => at.wrong(format!("`{key}` belongs to {whose}")),
            _ => Some(()),
        };
        let alone = [
            belongs("from", kind == "value", "a `value`"),
            belongs("tolerance", is_number, "numbers: a claim has its own thresholds"),
            belongs("threshold_reason", !is_number, "claims: a `tolerance` has its own `reason`"),
        ];
        let check = match kind {
            "value" => {
                if keys.get("from").is_none() {
                    return keys.wants(&["from"], "where the counterpart of its `value` stands in the table");
                }
                let (published, from) = (value??, from??);
                if let Some(unit) = from.unit().filter(|unit| published.converted_to(unit).is_none()) {
                    let help = match unit {
                        "" => "print it without a unit, or read another column".into(),
                        unit => format!("print it in {}, or read another column", units_beside(unit).join(", ")),
                    };
                    return keys.get("value")?.report(published.unlike(unit), Some(help));
                }
                Check::Value { published, from, tolerance: tolerance? }
            }
            "peak" => {
                let tolerance = tolerance?;
                if let Some(Tolerance { size: ToleranceSize::Absolute(_), .. }) = tolerance {
                    let message = "a peak has numbers of several units: make the tolerance relative";
                    return keys.get("tolerance")?.under("absolute").wrong(message);
                }
                Check::Peak { peak: peak??, tolerance }
            }
            _ => {
                let claim = [claim?, curve?.map(Predicate::Curve), mode_shape?.map(Predicate::ModeShape)];
                let predicate = claim.into_iter().flatten().next()?;
                if predicate.has_threshold() && keys.get("threshold_reason").is_none() {
                    return keys.wants(&["threshold_reason"], "why the thresholds of its claim are what they are");
                }
                Check::Claim { predicate, threshold_reason: threshold_reason?.unwrap_or_default() }
            }
        };
        alone.into_iter().all(|fine| fine.is_some()).then_some(check)
    }
}

/// What goes with what, for the schema.
fn rules(keys: &Keys<'_>) {
    let given =
        |names: &[&str]| json!({"anyOf": names.iter().map(|name| json!({"required": [name]})).collect::<Vec<_>>()});
    keys.rule(|| json!({"oneOf": KINDS.map(|kind| json!({"required": [kind]}))}));
    keys.rule(|| json!({"if": given(&["value"]), "then": given(&["from"]), "else": {"not": given(&["from"])}}));
    let number = given(&["value", "peak"]);
    let (of_claims, of_numbers) = (given(&["blocked_by", "threshold_reason"]), given(&["tolerance"]));
    keys.rule(|| json!({"if": number, "then": {"not": of_claims}, "else": {"not": of_numbers}}));
}

fn read_tolerance(at: At<'_>) -> Option<Tolerance> {
    if matches!(at, At::Node(node, _) if matches!(node.value, Value::Scalar(_))) {
        let help = "write for example {relative: 0.05, reason: read off a figure}";
        return at.report("a tolerance is a size, `relative` or `absolute`, and its `reason`", Some(help.into()));
    }
    let keys = at.keys("a tolerance")?;
    let forms =
        [("relative", "Fraction of the published value"), ("absolute", "In the unit in which the value is printed")];
    let size = keys.exactly_one(&forms, |key, at| {
        let amount = at.number_above_zero()?;
        if key == "relative" && amount >= 1.0 {
            return at.wrong("a tolerance as wide as the published value would pass any number near zero; 5 % is 0.05");
        }
        Some(if key == "relative" { ToleranceSize::Relative(amount) } else { ToleranceSize::Absolute(amount) })
    });
    let reason = keys.required("reason", "Why", |at| at.text());
    keys.close()?;
    Some(Tolerance { size: size?, reason: reason? })
}

/// Never `missing`.
fn expected(at: At<'_>) -> Option<Verdict> {
    at.form(
        |node, findings| match At::Node(node, findings).word("verdict")? {
            Verdict::Missing => findings.wrong(node.span, "`missing` is never an expected verdict"),
            verdict => Some(verdict),
        },
        |it| {
            let mut words = words_of::<Verdict>(it.about());
            if let Some(words) = words["enum"].as_array_mut() {
                words.retain(|word| word != "missing");
            }
            words
        },
    )
}
