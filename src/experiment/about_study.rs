//! `study.yaml`, what a study says of itself: words that the program cannot know and that its pages need.
//!
//! ```yaml
//! title: Dampers on a beam
//! about: Simulations of a published study, compared with its numbers.     # opens the index
//! source: {type: Thesis, name: A dissertation on dampers}                  # what it reproduces
//! chapters: {3: one mass, 4: beam}                                         # of what it reproduces, by number
//! colours: {light: blue, heavy: vermilion}                                 # of lines of that name, in every figure
//! findings:                                                                # its conclusions, and the entries that decide them
//!   - {says: One damper beats several., entries: [beam-count/one-best]}
//! ```

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::yaml::reader::{no_such, word};
use crate::yaml::schema::words_of;
use crate::yaml::word::words;
use crate::yaml::{At, Problems, Span, Value, described, parsed};

/// What a study says of itself; every part may be absent.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct AboutStudy {
    /// Its title.
    pub title: Option<String>,
    /// The sentence that opens its index. Markdown.
    pub about: Option<String>,
    /// The publication that it reproduces.
    pub source: Option<Publication>,
    /// Subjects of the chapters of that publication, by number.
    pub chapters: BTreeMap<u32, String>,
    /// Colours of lines by name, so that they are the same in every figure.
    pub colours: BTreeMap<String, LineColour>,
    /// What it concludes.
    pub findings: Vec<Finding>,
    /// Who made it.
    pub authors: Vec<Author>,
    /// How it may be used; each by itself, where there are several.
    pub licences: Vec<Licence>,
}

/// Who made a study.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Author {
    /// By name.
    Person(String),
    /// By name.
    Organisation(String),
}

/// A licence: its SPDX identifier, `CC-BY-4.0`, or where its text stands.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Licence(pub String);

impl Licence {
    /// Where its text stands.
    #[must_use]
    pub fn address(&self) -> String {
        if self.0.contains("://") { self.0.clone() } else { format!("https://spdx.org/licenses/{}", self.0) }
    }
}

/// A conclusion of the publication.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Finding {
    /// In a sentence. Markdown.
    pub says: String,
    /// Ids of the entries whose verdicts decide it.
    pub entries: Vec<String>,
}

/// A publication.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Publication {
    /// What it is, in the words of schema.org.
    #[serde(rename = "type")]
    pub kind: PublicationKind,
    /// Its title, or what describes it.
    pub name: String,
}

/// Kinds of publication, in the words of schema.org.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum PublicationKind {
    /// A dissertation.
    Thesis,
    /// An article.
    ScholarlyArticle,
    /// A book.
    Book,
    /// A report.
    Report,
    /// Anything else.
    CreativeWork,
}

/// A colour of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the names say all")]
pub enum LineColour {
    Blue,
    Vermilion,
    Green,
    Purple,
    Orange,
    SkyBlue,
    Black,
}

impl AboutStudy {
    /// The heading of what belongs to a chapter, or to none.
    #[must_use]
    pub fn heading(&self, chapter: Option<u32>) -> String {
        match chapter.map(|number| (number, self.chapters.get(&number))) {
            Some((number, Some(subject))) => format!("Chapter {number}, {subject}"),
            Some((number, None)) => format!("Chapter {number}"),
            None => "Experiments".into(),
        }
    }
}

/// Most chapters of a publication.
pub(super) const MOST_CHAPTERS: u32 = 99;

/// Reads `study.yaml` from its text; `file` only names it in messages.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn parse_study(file: &str, text: &str) -> Result<AboutStudy, Problems> {
    parsed(file, text, read_about)
}

/// JSON Schema of `study.yaml`.
#[must_use]
pub fn study_schema() -> serde_json::Value {
    described("Study", "What the study is", read_about)
}

fn read_about(at: At<'_>) -> Option<AboutStudy> {
    let keys = at.keys("a study")?;
    let title = keys.optional("title", "A few words", |at| at.text());
    let about = keys.optional("about", "The sentence that opens the index of its reports", |at| at.text());
    let source = keys.optional("source", "The publication that is reproduced", read_publication);
    let subjects = "Subjects of the publication's chapters, by number";
    let chapters = keys.optional("chapters", subjects, read_chapters);
    let colours = keys.optional("colours", "Colours of lines of these names, in every figure", read_colours);
    let concluded = keys.optional("findings", "What the publication concludes", |at| at.list(read_finding));
    let who = "Who made the study, for those it is handed on to: names, or {organisation: …}";
    let authors = keys.optional("author", who, |at| at.one_or_more(read_author));
    let terms = "How it may be used: an SPDX identifier such as CC-BY-4.0, or the address of a licence; each by itself, if several";
    let licences = keys.optional("licence", terms, |at| at.one_or_more(read_licence));
    keys.close()?;
    Some(AboutStudy {
        title: title?,
        about: about?,
        source: source?,
        chapters: chapters?.unwrap_or_default(),
        colours: colours?.unwrap_or_default(),
        findings: concluded?.unwrap_or_default(),
        authors: authors?.unwrap_or_default(),
        licences: licences?.unwrap_or_default(),
    })
}

fn read_author(at: At<'_>) -> Option<Author> {
    let organisation = |at: At<'_>| {
        let keys = at.keys("an author")?;
        let name = keys.required("organisation", "Its name", |at| at.text());
        keys.close()?;
        name.map(Author::Organisation)
    };
    at.either(|value| matches!(value, Value::Mapping(_)), organisation, |at| at.text().map(Author::Person))
}

fn read_licence(at: At<'_>) -> Option<Licence> {
    let text = at.text()?;
    let is_identifier = text.chars().all(|c| c.is_ascii_alphanumeric() || "-.+".contains(c));
    if is_identifier || text.starts_with("https://") || text.starts_with("http://") {
        return Some(Licence(text));
    }
    let help = "write an SPDX identifier, `CC-BY-4.0`, or an address; of several licences a list, `[MIT, Apache-2.0]`";
    at.report(format!("`{text}` is not one licence"), Some(help.into()))
}

fn read_finding(at: At<'_>) -> Option<Finding> {
    let keys = at.keys("a finding")?;
    let says = keys.required("says", "In a sentence", |at| at.text());
    let decided_by = "The entries whose verdicts decide it, experiment/entry";
    let entries = keys.required("entries", decided_by, |at| at.list(|at| at.text()));
    keys.close()?;
    Some(Finding { says: says?, entries: entries? })
}

fn read_publication(at: At<'_>) -> Option<Publication> {
    let keys = at.keys("a publication")?;
    let kind = keys.required("type", "What it is", |at| at.word::<PublicationKind>("kind of publication"));
    let name = keys.required("name", "Its title, or a description", |at| at.text());
    keys.close()?;
    Some(Publication { kind: kind?, name: name? })
}

fn read_chapters(at: At<'_>) -> Option<BTreeMap<u32, String>> {
    let form = "chapters are written as `number: subject`";
    let chapters = at.by_name(json!({"propertyNames": {"pattern": "^[0-9]{1,2}$"}}), form, |key, key_span, at| {
        Some((chapter_number(key, key_span, at)?, at.text()?))
    });
    chapters.map(|chapters| chapters.into_iter().collect())
}

/// The number of a chapter that is a key.
pub(super) fn chapter_number(key: &str, key_span: Span, at: At<'_>) -> Option<u32> {
    let number = key.parse::<u32>().ok().filter(|number| *number <= MOST_CHAPTERS);
    number.or_else(|| {
        at.wrong_at(key_span, format!("`{key}` is not the number of a chapter: write one up to {MOST_CHAPTERS}"))
    })
}

fn read_colours(at: At<'_>) -> Option<BTreeMap<String, LineColour>> {
    let known = words::<LineColour>().join(", ");
    let form = format!("colours are written as `name of a line: colour`; known are {known}");
    let colours = at.by_name(json!({}), &form, |key, _, at| {
        let colour = at.form(
            |node, findings| match &node.value {
                Value::Scalar(_) => word::<LineColour>(node, "colour", findings),
                _ => no_such(findings, node.span, "colour", key, words::<LineColour>()),
            },
            |it| words_of::<LineColour>(it.about()),
        );
        Some((key.to_owned(), colour?))
    });
    colours.map(|colours| colours.into_iter().collect())
}
