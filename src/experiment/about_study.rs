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

use super::diagnostic::{Findings, Problems};
use super::reader::{Fields, list, no_such, text, word};
use super::word::words;
use super::yaml::{Entry, Node, Value, read_tree};

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
    let findings = Findings::default();
    let about = read_tree(text, &findings).and_then(|root| read_about(&root, &findings));
    findings.finish(file, text, about)
}

fn read_about(node: &Node, findings: &Findings) -> Option<AboutStudy> {
    let fields = Fields::open(node, "a study", findings)?;
    let title = fields.optional("title", |node| text(node, findings));
    let about = fields.optional("about", |node| text(node, findings));
    let source = fields.optional("source", |node| read_publication(node, findings));
    let chapters = fields.optional("chapters", |node| read_chapters(node, findings));
    let colours = fields.optional("colours", |node| read_colours(node, findings));
    let concluded = fields.optional("findings", |node| list(node, findings, |node| read_finding(node, findings)));
    fields.close()?;
    Some(AboutStudy {
        title: title?,
        about: about?,
        source: source?,
        chapters: chapters?.unwrap_or_default(),
        colours: colours?.unwrap_or_default(),
        findings: concluded?.unwrap_or_default(),
    })
}

fn read_finding(node: &Node, findings: &Findings) -> Option<Finding> {
    let fields = Fields::open(node, "a finding", findings)?;
    let says = fields.required("says", |node| text(node, findings));
    let entries = fields.required("entries", |node| list(node, findings, |node| text(node, findings)));
    fields.close()?;
    Some(Finding { says: says?, entries: entries? })
}

fn read_publication(node: &Node, findings: &Findings) -> Option<Publication> {
    let fields = Fields::open(node, "a publication", findings)?;
    let kind = fields.required("type", |node| word::<PublicationKind>(node, "kind of publication", findings));
    let name = fields.required("name", |node| text(node, findings));
    fields.close()?;
    Some(Publication { kind: kind?, name: name? })
}

fn read_chapters(node: &Node, findings: &Findings) -> Option<BTreeMap<u32, String>> {
    let Value::Mapping(entries) = &node.value else {
        return findings.wrong(node.span, "chapters are written as `number: subject`");
    };
    let chapter = |Entry { key, key_span, node }: &Entry| match key.parse::<u32>() {
        Ok(number) if number <= MOST_CHAPTERS => Some((number, text(node, findings)?)),
        _ => findings
            .wrong(*key_span, format!("`{key}` is not the number of a chapter: write one up to {MOST_CHAPTERS}")),
    };
    super::reader::all(entries.iter().map(chapter)).map(|chapters| chapters.into_iter().collect())
}

fn read_colours(node: &Node, findings: &Findings) -> Option<BTreeMap<String, LineColour>> {
    let Value::Mapping(entries) = &node.value else {
        let known = words::<LineColour>().join(", ");
        return findings
            .wrong(node.span, format!("colours are written as `name of a line: colour`; known are {known}"));
    };
    let colour = |entry: &Entry| match &entry.node.value {
        Value::Scalar(_) => Some((entry.key.clone(), word::<LineColour>(&entry.node, "colour", findings)?)),
        _ => no_such(findings, entry.node.span, "colour", &entry.key, words::<LineColour>()),
    };
    super::reader::all(entries.iter().map(colour)).map(|colours| colours.into_iter().collect())
}
