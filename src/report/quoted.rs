//! What the study's text quotes of what a figure draws: values, places, or both.
//!
//! How an entry reads its number out of a table says where that number stands on the axes: the place of a maximum is a place, the
//! cell of a row a value at the row's place, a mean a value without one. Ratios of two numbers, slopes and deviations stand
//! nowhere.

use std::collections::BTreeMap;

use crate::experiment::{Drawing, Experiment, FigureSpec, LineColour};
use crate::figure::{Beside, Known, Quoted, QuotedAt};
use crate::reference::{
    Allowed, Check, Comparison, Entry, Extraction, Feature, Judged, Printed, PrintedPeak, ReferenceFile, Selection,
};
use crate::table::Table;
use crate::text::words;

/// What the study says of an experiment, and what became of it.
#[derive(Clone, Copy, Default)]
pub(super) struct Said<'a> {
    pub reference: Option<&'a ReferenceFile>,
    pub judged: &'a [Judged],
    /// Period of the impulses, s.
    pub impulses: Option<f64>,
    /// Colours of lines by name, as the study has them.
    pub colours: Option<&'a BTreeMap<String, LineColour>>,
}

impl<'a> Said<'a> {
    /// What a figure shows beside its table.
    pub fn beside(self, quoted: &'a [Quoted]) -> Beside<'a> {
        Beside { quoted, impulses: self.impulses, colours: self.colours }
    }
}

/// The numbers that the study quotes of what a figure draws; each once.
pub(super) fn quoted(experiment: &Experiment, figure: &FigureSpec, table: &Table, said: Said<'_>) -> Vec<Quoted> {
    // A number has no place among colours.
    let Drawing::Lines(panels) = &figure.drawing else { return Vec::new() };
    let entries = said.reference.map_or(&[][..], |reference| &reference.entries);
    let mut found: Vec<Quoted> = Vec::new();
    for entry in entries {
        let judged = said.judged.iter().find(|judged| judged.id == entry.id);
        for panel in panels {
            let axes = Axes {
                experiment,
                table,
                x: &panel.x.column,
                y: panel.y.iter().map(|axis| axis.column.as_str()).collect(),
                by: &panel.by,
            };
            for one in axes.of_entry(entry, judged) {
                let known = |other: &Quoted| (&other.column, other.at) == (&one.column, one.at);
                if !found.iter().any(known) {
                    found.push(one);
                }
            }
        }
    }
    found
}

/// The column that names candidates.
const CANDIDATE: &str = "candidate";

/// The axes of a panel.
struct Axes<'a> {
    experiment: &'a Experiment,
    table: &'a Table,
    x: &'a str,
    y: Vec<&'a str>,
    by: &'a [String],
}

/// Where on the axes an extraction's number stands.
enum Where {
    /// At this place.
    Value {
        x: f64,
    },
    /// It is itself a place, at which the curve has this value.
    PlaceOf {
        y: f64,
    },
    Place,
    /// What it is of the whole curve: `mean`.
    Level(&'static str),
}

impl Axes<'_> {
    fn of_entry(&self, entry: &Entry, judged: Option<&Judged>) -> Vec<Quoted> {
        match &entry.check {
            Check::Value { published, from, .. } => {
                let comparison = judged.and_then(|judged| judged.comparison.as_ref());
                self.of_value(entry, published, from, comparison).into_iter().collect()
            }
            Check::Peak { peak, .. } => self.of_peak(entry, peak, judged).into_iter().collect(),
            Check::Claim { .. } => Vec::new(),
        }
    }

    /// A printed peak with a height is a point, one without a place.
    fn of_peak(&self, entry: &Entry, peak: &PrintedPeak, judged: Option<&Judged>) -> Option<Quoted> {
        let at = peak.at.as_ref()?;
        let (x, half_unit) = at.converted_to(self.unit(self.x)?)?;
        let y = peak.height.as_ref().and_then(|height| height.converted_to(self.unit(&peak.of)?));
        let place = QuotedAt::Place(x);
        let (at_axes, u_data, text, feature) = match (y, &peak.height) {
            (Some((y, half_unit)), Some(height)) => {
                (QuotedAt::Point { x, y, known: Known::Y }, half_unit, height.text(), Feature::Height)
            }
            _ => (place, half_unit, at.text(), Feature::Place),
        };
        let part = judged?.parts.iter().find(|part| part.name == feature.words());
        let comparison = part.and_then(|part| part.comparison.as_ref()).or(judged?.comparison.as_ref());
        self.quoted(&peak.of, &peak.over, at_axes, u_data, comparison, self.label(text, "", &entry.rows))
    }

    fn of_value(
        &self,
        entry: &Entry,
        published: &Printed,
        from: &Extraction,
        comparison: Option<&Comparison>,
    ) -> Option<Quoted> {
        let (of, over, rows, standing) = self.standing(entry, from)?;
        let column = self.drawn(of)?;
        let unit = |column: &str| published.converted_to(self.unit(column)?);
        let (at, u_data, note) = match standing {
            Where::Value { x } => {
                let (y, u) = unit(column)?;
                (QuotedAt::Point { x, y, known: Known::Y }, u, "")
            }
            Where::PlaceOf { y } => {
                let (x, u) = unit(over)?;
                (QuotedAt::Point { x, y, known: Known::X }, u, "")
            }
            Where::Place => {
                let (x, u) = unit(over)?;
                (QuotedAt::Place(x), u, "")
            }
            Where::Level(note) => {
                let (y, u) = unit(column)?;
                (QuotedAt::Level(y), u, note)
            }
        };
        self.quoted(column, over, at, u_data, comparison, self.label(published.text(), note, &rows))
    }

    /// Of which column an extraction reads, over which other one, in which rows, and where its number stands.
    fn standing<'e>(&'e self, entry: &'e Entry, from: &'e Extraction) -> Option<(&'e str, &'e str, Selection, Where)> {
        let sources = from.sources();
        let [source] = sources.as_slice() else { return None };
        if source.table.is_some_and(|table| table != self.experiment.id.0) {
            return None;
        }
        let rows = entry.rows.and(source.rows);
        let (of, over, standing) = match from {
            Extraction::Cell(word) => match rows.0.get(self.x) {
                Some(Allowed::Number(x)) => (&word.of, self.x, Where::Value { x: *x }),
                Some(_) => return None,
                None => (&word.of, self.x, Where::Level("")),
            },
            Extraction::Interpolated(word) => {
                let (x, _) = word.at.converted_to(self.unit(&word.over)?)?;
                (&word.of, word.over.as_str(), Where::Value { x })
            }
            Extraction::Mean(word) => (&word.of, self.x, Where::Level("mean ")),
            Extraction::MeanOver(word) => (&word.of, word.over.as_str(), Where::Level("mean ")),
            Extraction::Largest(word) => (&word.of, self.x, Where::Level("largest ")),
            Extraction::Smallest(word) => (&word.of, self.x, Where::Level("smallest ")),
            Extraction::Maximum(word) => (&word.of, word.over.as_str(), Where::Level("maximum ")),
            Extraction::Minimum(word) => (&word.of, word.over.as_str(), Where::Level("minimum ")),
            Extraction::Argmax(word) | Extraction::Argmin(word) => (&word.of, word.over.as_str(), Where::Place),
            Extraction::Crossing(word) => (&word.of, word.over.as_str(), Where::PlaceOf { y: word.level }),
            Extraction::FirstAbove(word) => (&word.of, word.over.as_str(), Where::Place),
            Extraction::Parting(word) => (&word.of, word.over.as_str(), Where::Place),
            Extraction::Meeting(word) => (&word.of, word.over.as_str(), Where::Place),
            Extraction::ArgmaxLead(word) => (&word.of, word.over.as_str(), Where::Place),
            Extraction::NearestPassage(word) if word.read.is_none() => (&word.of, "time", Where::Place),
            Extraction::Peak(peak) => match peak.read {
                Feature::Place => (&peak.of, peak.over.as_str(), Where::Place),
                Feature::Height => (&peak.of, peak.over.as_str(), Where::Level("peak ")),
                Feature::HalfPowerWidth => return None,
            },
            Extraction::AtMaximum(word) if *word.read == *self.x => (&word.of, self.x, Where::Place),
            Extraction::Number(_)
            | Extraction::AtMaximum(_)
            | Extraction::End(_)
            | Extraction::LargestStepBack(_)
            | Extraction::StandardDeviationOver(_)
            | Extraction::PathMaximum(_)
            | Extraction::PathMinimum(_)
            | Extraction::NearestPassage(_)
            | Extraction::LargestLead(_)
            | Extraction::Ratio(_)
            | Extraction::Difference(_)
            | Extraction::Times(_) => return None,
        };
        Some((of, over, rows, standing))
    }

    /// The drawn column that shows a measure: itself, or the fitness of the searches for it.
    fn drawn<'e>(&'e self, of: &'e str) -> Option<&'e str> {
        let is_fitness = self.experiment.optimise.as_ref().is_some_and(|search| words::of_key(&search.measure) == of);
        let shows =
            |column: &&&str| **column == of || (is_fitness && ["best_so_far", "fitness_along"].contains(*column));
        self.y.iter().find(shows).copied()
    }

    fn quoted(
        &self,
        column: &str,
        over: &str,
        at: QuotedAt,
        u_data: f64,
        comparison: Option<&Comparison>,
        label: String,
    ) -> Option<Quoted> {
        // A value of the whole curve stands wherever its column does.
        let anywhere = matches!(at, QuotedAt::Level(_));
        (self.y.contains(&column) && (anywhere || over == self.x)).then(|| Quoted {
            column: column.into(),
            over: (!anywhere).then(|| over.into()),
            at,
            label,
            u_data,
            tolerance: comparison.map(Comparison::tolerance),
        })
    }

    /// `study: mean 1.24, untuned`: the number as printed, and which of the lines it belongs to.
    fn label(&self, text: &str, note: &str, rows: &Selection) -> String {
        let word = |column: &str| match rows.0.get(column) {
            Some(Allowed::Text(level)) => Some(words::of_level(column, level)),
            _ => None,
        };
        // A landscape has no line for each candidate, and yet the number belongs to one.
        let of_a_candidate = (self.experiment.optimise.is_some() && !self.by.iter().any(|column| column == CANDIDATE))
            .then_some(CANDIDATE);
        let levels = self.by.iter().map(String::as_str).chain(of_a_candidate).filter_map(word);
        let line: String = levels.map(|level| format!(", {}", level.trim_start_matches("study "))).collect();
        format!("study: {note}{}{line}", text.replace('-', "−"))
    }

    fn unit(&self, column: &str) -> Option<&str> {
        Some(self.table.column(column)?.unit.as_str())
    }
}
