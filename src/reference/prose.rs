//! Placeholders in explanations: a number in prose is the one that the table gives, so that it cannot go stale.
//!
//! | written | shown |
//! |---|---|
//! | `{here}` | the first number of what came out for this entry, with its unit: `628 mm/s` |
//! | `{here 2}` | the second one; conditions in brackets do not count |
//! | `{off}` | how far a number is from the published one: `21 % less`, `13 % more` |
//! | `{here: uniform}`, `{off: uniform}` | of another entry of the same experiment |
//! | `{here: ch6-plate-c1-light/uniform}` | of an entry of another experiment; the reasons of assumptions name all entries so |
//! | `{here: crossing, mass_on_plates=total}` | with one assumption moved |

use super::judged::Judged;
use super::printed::symbols;
use crate::text::braces::{Part, Unclosed, parts};

/// A text in pieces.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Prose {
    pieces: Vec<Piece>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Piece {
    Text(String),
    Placeholder(Placeholder),
}

/// A number that is filled in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Placeholder {
    what: Wanted,
    /// The entry, `ch3-gap/order` or `order`; `None` for the one that is explained.
    pub entry: Option<String>,
    /// The assumption that is moved, as its variant is named.
    pub moved: Option<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wanted {
    /// The n-th number of what came out, from 1.
    Here(usize),
    /// Its distance from the published one.
    Off,
}

/// What came out for an entry, as far as prose quotes it.
#[derive(Debug, Clone, PartialEq)]
pub struct CameOut<'a> {
    /// In words.
    pub found: &'a str,
    /// The same with one assumption moved, by the name of its variant.
    pub moved: Vec<(&'a str, &'a str)>,
    /// The error of a number, and the published number.
    pub error: Option<[f64; 2]>,
}

impl<'a> From<&'a Judged> for CameOut<'a> {
    fn from(judged: &'a Judged) -> Self {
        Self {
            found: &judged.found,
            moved: judged.moved.iter().map(|moved| (moved.variant.as_str(), moved.found.as_str())).collect(),
            error: judged.comparison.as_ref().map(|comparison| [comparison.error(), comparison.published]),
        }
    }
}

/// Why a text is no prose.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ProseError {
    /// No `}`.
    #[error("{0}")]
    Unclosed(#[from] Unclosed),
    /// None of the known forms.
    #[error(
        "the unknown placeholder `{{{0}}}`: write `{{here}}`, `{{here 2}}`, `{{here: ENTRY}}`, `{{here: ENTRY, assumption=value}}` or `{{off}}`"
    )]
    Unknown(String),
}

impl Prose {
    /// Reads a text with its placeholders.
    ///
    /// # Errors
    /// The first placeholder that is none.
    pub fn parse(text: &str) -> Result<Self, ProseError> {
        let piece = |part| match part {
            Part::Text(text) => Ok(Piece::Text(text.into())),
            Part::Placeholder(inner) => Placeholder::parse(inner).map(Piece::Placeholder),
        };
        Ok(Self { pieces: parts(text)?.into_iter().map(piece).collect::<Result<_, _>>()? })
    }

    /// Its placeholders.
    pub fn placeholders(&self) -> impl Iterator<Item = &Placeholder> {
        self.pieces.iter().filter_map(|piece| match piece {
            Piece::Placeholder(placeholder) => Some(placeholder),
            Piece::Text(_) => None,
        })
    }

    /// The text with the numbers of the entries that `entry` finds; what has no number yet is `n/a`.
    #[must_use]
    pub fn filled<'a>(&self, entry: impl Fn(Option<&str>) -> Option<&'a Judged>) -> String {
        self.filled_or("n/a", |name| entry(name).map(CameOut::from))
    }

    /// The same from whatever holds what came out; `unknown` stands for what has no number.
    #[must_use]
    pub fn filled_or<'a>(&self, unknown: &str, entry: impl Fn(Option<&str>) -> Option<CameOut<'a>>) -> String {
        let piece = |piece: &Piece| match piece {
            Piece::Text(text) => text.clone(),
            Piece::Placeholder(placeholder) => entry(placeholder.entry.as_deref())
                .and_then(|entry| placeholder.of(&entry))
                .unwrap_or_else(|| unknown.into()),
        };
        self.pieces.iter().map(piece).collect()
    }
}

impl Placeholder {
    fn parse(inner: &str) -> Result<Self, ProseError> {
        let unknown = || ProseError::Unknown(inner.into());
        let (what, of) = inner.split_once(':').map_or((inner, None), |(what, of)| (what, Some(of.trim())));
        let what = match what.trim().split_once(' ').map_or((what.trim(), ""), |(word, n)| (word, n.trim())) {
            ("here", "") => Wanted::Here(1),
            ("here", n) => Wanted::Here(n.parse().ok().filter(|n| *n > 0).ok_or_else(unknown)?),
            ("off", "") => Wanted::Off,
            _ => return Err(unknown()),
        };
        let (entry, moved) = match of.map(|of| of.split_once(',').map_or((of, None), |(of, moved)| (of, Some(moved)))) {
            None => (None, None),
            Some((entry, moved)) => (Some(entry.trim().to_owned()), moved.map(|moved| moved.trim().to_owned())),
        };
        // Under a move one number comes out.
        if moved.is_some() && what != Wanted::Here(1)
            || entry.as_ref().is_some_and(String::is_empty)
            || moved.as_ref().is_some_and(|moved| !moved.contains('='))
        {
            return Err(unknown());
        }
        Ok(Self { what, entry, moved })
    }

    fn of(&self, entry: &CameOut<'_>) -> Option<String> {
        if let Some(wanted) = &self.moved {
            return entry.moved.iter().find(|(variant, _)| variant == wanted).map(|(_, found)| (*found).to_owned());
        }
        match self.what {
            Wanted::Here(n) => numbers(entry.found).into_iter().nth(n - 1),
            Wanted::Off => {
                let [error, published] = entry.error?;
                let side = if error < 0.0 { "less" } else { "more" };
                Some(format!("{} {side}", super::text::percent(error.abs() / published.abs())))
            }
        }
    }
}

/// The numbers of what came out, each with its unit; uncertainties and what stands in brackets do not count.
#[must_use]
pub fn numbers(found: &str) -> Vec<String> {
    let mut text = String::new();
    let mut depth = 0_u32;
    for letter in found.chars() {
        match letter {
            '(' if !text.ends_with("m/") => depth += 1,
            ')' if depth > 0 => depth -= 1,
            _ if depth == 0 => text.push(letter),
            _ => {}
        }
    }
    let is_digit = |letter: char| letter.is_ascii_digit() || matches!(letter, '.' | '\u{202f}');
    let units: Vec<&str> = symbols().into_iter().chain(["%"]).collect();
    let mut numbers = Vec::new();
    let mut rest = text.as_str();
    let mut before = ' ';
    while let Some(letter) = rest.chars().next() {
        let sign = if matches!(letter, '−' | '+') { letter.len_utf8() } else { 0 };
        let starts = rest[sign..].starts_with(|letter: char| letter.is_ascii_digit());
        if !starts || before.is_alphanumeric() || matches!(before, '-' | '_') {
            before = letter;
            rest = &rest[letter.len_utf8()..];
            continue;
        }
        let mut end = sign + rest[sign..].find(|letter| !is_digit(letter)).unwrap_or(rest.len() - sign);
        if let Some(exponent) = rest[end..].strip_prefix('e') {
            let digits = exponent.trim_start_matches(['-', '−']);
            let length = digits.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(digits.len());
            end = if length > 0 { rest.len() - digits.len() + length } else { end };
        }
        let number = rest[..end].trim_end_matches('.');
        rest = &rest[number.len()..];
        if let Some(uncertainty) = rest.strip_prefix(" ± ") {
            let end = uncertainty.find(|letter| !is_digit(letter)).unwrap_or(uncertainty.len());
            rest = &uncertainty[end..];
        }
        let unit = rest.strip_prefix(' ').and_then(|behind| {
            let goes_on = |letter: char| letter.is_alphanumeric() || letter == '/';
            let stands = |unit: &&&str| behind.strip_prefix(**unit).is_some_and(|after| !after.starts_with(goes_on));
            units.iter().filter(stands).max_by_key(|unit| unit.len())
        });
        rest = &rest[unit.map_or(0, |unit| unit.len() + 1)..];
        numbers.push(unit.map_or_else(|| number.to_owned(), |unit| format!("{number} {unit}")));
        before = ' ';
    }
    numbers
}
