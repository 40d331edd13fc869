//! Problems of a file: every one of them at once, each with its place, what is wrong and what would be right.
//!
//! [`Problems`] prints plainly (one block a problem, stable to the byte, for logs and tests); [`Problems::fancy`] is the
//! same for a terminal.

use std::cell::RefCell;
use std::fmt;

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceSpan};

/// A range of bytes in a file's text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Span {
    pub start: usize,
    pub end: usize,
}

/// Whether something is wrong, or only hardly meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// The file cannot be used as it is.
    Error,
    /// It can.
    Warning,
}

/// One mistake.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, in words.
    pub message: String,
    /// What would be right.
    pub help: Option<String>,
    /// Where; `None` if the file as a whole is meant (not found, too large).
    pub place: Option<Place>,
}

/// A place in a text file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Place {
    /// Line, counted from 1.
    pub line: usize,
    /// Column in characters, counted from 1.
    pub column: usize,
    offset: usize,
    bytes: usize,
}

/// All that is wrong with one file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problems {
    /// The file, as it was named by the caller.
    pub file: String,
    /// The problems in the order of the file.
    pub list: Vec<Problem>,
    text: String,
}

impl Problems {
    /// A file that could not be read at all.
    pub(crate) fn unreadable(file: &str, message: String, help: Option<String>) -> Self {
        Self {
            file: file.into(),
            list: vec![Problem { severity: Severity::Error, message, help, place: None }],
            text: String::new(),
        }
    }

    /// One mistake at a line and column, counted from 1, or of the file as a whole.
    #[must_use]
    pub fn at(file: &str, text: &str, at: Option<(u64, u64)>, message: String) -> Self {
        let place = at.map(|(line, column)| place(text, span_at(text, line, column)));
        let problem = Problem { severity: Severity::Error, message: harmless(&message), help: None, place };
        Self { file: file.into(), list: vec![problem], text: harmless(text) }
    }

    /// What is hardly meant in a file that can be used.
    pub(crate) fn warnings(
        file: &str,
        text: &str,
        list: impl Iterator<Item = (Place, String, String)>,
    ) -> Option<Self> {
        let warning = |(place, message, help): (Place, String, String)| Problem {
            severity: Severity::Warning,
            message,
            help: Some(help),
            place: Some(place),
        };
        let list: Vec<Problem> = list.map(warning).collect();
        (!list.is_empty()).then(|| Self { file: file.into(), list, text: harmless(text) })
    }

    /// Each problem as it is shown, with its line, if it has one.
    #[must_use]
    pub fn one_by_one(&self) -> Vec<(Option<u64>, String)> {
        let one = |problem: &Problem| {
            let alone = Self { list: vec![problem.clone()], ..self.clone() };
            (problem.place.and_then(|place| u64::try_from(place.line).ok()), alone.to_string())
        };
        self.list.iter().map(one).collect()
    }

    /// The same for a person at a terminal: framed source snippets, in colour if asked for.
    #[must_use]
    pub fn fancy(&self, colour: bool) -> String {
        let theme = if colour { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
        let handler = GraphicalReportHandler::new_themed(theme).with_width(120);
        let mut out = String::new();
        for problem in &self.list {
            let shown = Shown { problem, source: NamedSource::new(&self.file, self.text.clone()) };
            // Writing into a String cannot fail; a handler that gives up leaves the plain words.
            if handler.render_report(&mut out, &shown).is_err() {
                self.write_plain(problem, &mut out).ok();
            }
        }
        out
    }

    fn write_plain(&self, problem: &Problem, out: &mut impl fmt::Write) -> fmt::Result {
        let severity = match problem.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        writeln!(out, "{severity}: {}", problem.message)?;
        if let Some(place) = problem.place {
            writeln!(out, "  --> {}:{}:{}", self.file, place.line, place.column)?;
            let line = self.text.lines().nth(place.line - 1).unwrap_or_default();
            let number = place.line.to_string();
            let margin = " ".repeat(number.len());
            let rest = line.chars().count().saturating_sub(place.column - 1);
            let marked = self.text.get(place.offset..place.offset + place.bytes).unwrap_or_default();
            let width = marked.chars().count().min(rest).max(1);
            writeln!(out, "{margin} |")?;
            writeln!(out, "{number} | {line}")?;
            writeln!(out, "{margin} | {}{}", " ".repeat(place.column - 1), "^".repeat(width))?;
        } else {
            writeln!(out, "  --> {}", self.file)?;
        }
        if let Some(help) = &problem.help {
            writeln!(out, "  = {help}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.list.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            self.write_plain(problem, f)?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}

/// One problem beside its source, in miette's terms.
#[derive(Debug)]
struct Shown<'a> {
    problem: &'a Problem,
    source: NamedSource<String>,
}

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.problem.place.is_none() {
            write!(f, "{}: ", self.source.name())?;
        }
        f.write_str(&self.problem.message)
    }
}

impl std::error::Error for Shown<'_> {}

impl miette::Diagnostic for Shown<'_> {
    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.problem.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.problem.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        self.problem.place.map(|_| &self.source as &dyn miette::SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let place = self.problem.place?;
        let span = SourceSpan::new(place.offset.into(), place.bytes);
        Some(Box::new(std::iter::once(LabeledSpan::new_primary_with_span(None, span))))
    }
}

/// Most problems of a file that are told: who has more of them has the wrong file.
const MOST_TOLD: usize = 100;

/// Where readers put what they find, so that one mistake does not hide the next.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    list: RefCell<Vec<(Span, String, Option<String>)>>,
    /// What a sweep may vary, for whom marks another key; empty in files without a sweep.
    pub varied: &'static [&'static str],
}

impl Findings {
    /// Those of a file whose sweep may vary these.
    pub fn beside_sweep(varied: &'static [&'static str]) -> Self {
        Self { varied, ..Self::default() }
    }

    /// Reports a problem; returns `None` so that a reader can end with it.
    pub fn report<T>(&self, at: Span, message: impl Into<String>, help: Option<String>) -> Option<T> {
        if !self.is_full() {
            let (message, help) = (message.into(), help.as_deref().map(harmless));
            self.list.borrow_mut().push((at, harmless(&message), help));
        }
        None
    }

    /// True if there is a problem.
    pub fn any(&self) -> bool {
        !self.list.borrow().is_empty()
    }

    /// True when no more will be told.
    pub fn is_full(&self) -> bool {
        self.list.borrow().len() >= MOST_TOLD
    }

    /// A problem whose message says all.
    pub fn wrong<T>(&self, at: Span, message: impl Into<String>) -> Option<T> {
        self.report(at, message, None)
    }

    /// The value, or all problems of the file.
    pub fn finish<T>(self, file: &str, text: &str, value: Option<T>) -> Result<T, Problems> {
        let mut list = self.list.into_inner();
        match value {
            Some(value) if list.is_empty() => return Ok(value),
            None if list.is_empty() => {
                // A reader that gave up without saying why would be a mistake of this program: say that much.
                list.push((Span::default(), "the file could not be understood".into(), None));
            }
            _ => {}
        }
        list.sort_by_key(|(span, ..)| span.start);
        list.dedup();
        let list = list
            .into_iter()
            .map(|(span, message, help)| Problem {
                severity: Severity::Error,
                message,
                help,
                place: Some(place(text, span)),
            })
            .collect();
        Err(Problems { file: file.into(), list, text: harmless(text) })
    }
}

/// Without characters that would command a terminal; no byte moves.
fn harmless(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() && !matches!(c, '\n' | '\t') {
            out.extend(std::iter::repeat_n('?', c.len_utf8()));
        } else {
            out.push(c);
        }
    }
    out
}

/// The word at a line and column, counted from 1.
fn span_at(text: &str, line: u64, column: u64) -> Span {
    let before = |count: u64| usize::try_from(count.saturating_sub(1)).unwrap_or(usize::MAX);
    let lines = text.split_inclusive('\n').scan(0, |start, line| {
        *start += line.len();
        Some((*start - line.len(), line))
    });
    let (start, line) = lines.take(before(line).saturating_add(1)).last().unwrap_or_default();
    let offset = line.char_indices().nth(before(column)).map_or(0, |(offset, _)| offset);
    let word = line[offset..].split(|c: char| c.is_whitespace() || ":,{}[]".contains(c)).next().unwrap_or_default();
    Span { start: start + offset, end: start + offset + word.len().max(1) }
}

pub(crate) fn place(text: &str, span: Span) -> Place {
    let mut offset = span.start.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    let before = &text[..offset];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line_end = text[offset..].find('\n').map_or(text.len(), |newline| offset + newline);
    Place {
        line: before.matches('\n').count() + 1,
        column: text[line_start..offset].chars().count() + 1,
        offset,
        bytes: span.end.clamp(offset, line_end) - offset,
    }
}
