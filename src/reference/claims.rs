//! What stands in each kind of claim.

use serde::{Deserialize, Serialize};

use super::extraction::{Direction, Extraction, Side, direction, extraction, side, two_or_more};
use super::line::Pair;
use super::mapping::{Reads, claim, mapping};
use super::name::{Column, in_unit, in_unit_of};
use super::selection::is_number;
use super::tally::Shown;
use super::text::{in_scale_of, percent};
use crate::yaml::At;

claim! {
    "a rise or fall" Monotone {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        direction: Direction = required("Which way", direction),
        slack: f64 = or("Step back allowed, as a fraction of the line's range", |at| at.fraction(), 0.0),
        part: Part = or("Which part of the line", |at| at.word("part of a line"), Part::Whole),
    }
}

/// Part of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// All of it.
    Whole,
    /// Up to its highest point.
    BeforeMaximum,
    /// From its highest point on.
    AfterMaximum,
}

mapping! {
    "a trend" Trend {
        of: Extraction = required("The number at each level", extraction),
        along: Column = required("The column whose levels are stepped through, ∞ last", Column::read),
        direction: Direction = required("Which way", direction),
        slack: f64 =
            or("Step back allowed, as a fraction of the numbers' range; 0 asks for a strict rise or fall", |at| at.fraction(), 0.0),
    }
}
mapping! {
    "an equality" Equal {
        values: Vec<Extraction> = required("The numbers", |at| two_or_more(at, extraction, "equality needs two numbers or more")),
        within: Within = required("How near", within(unit_of(values.as_ref()))),
    }
}
mapping! {
    "an inequality" Apart {
        values: Vec<Extraction> = required("The numbers", |at| two_or_more(at, extraction, "inequality needs two numbers or more")),
        by: Within = required("How far, at least, any two of them", within(unit_of(values.as_ref()))),
    }
}

/// A distance between numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Within {
    /// A fraction of the larger magnitude.
    Relative(f64),
    /// In the numbers' unit.
    Absolute(f64),
}

impl Reads for Within {}

/// A distance between numbers of this unit; a bare number does not say of which kind.
pub(super) fn within(unit: Option<&'static str>) -> impl Fn(At<'_>) -> Option<Within> {
    move |at| {
        if at.holds(is_number) {
            return at.report(
                "a distance is relative to the larger number, or absolute",
                Some("write {relative: 0.01} or {absolute: 0.01}".into()),
            );
        }
        let forms = [("relative", "A fraction of the larger magnitude"), ("absolute", "In the numbers' unit")];
        let distance = |at: At<'_>| {
            at.choose("a distance", &forms, |choice| match choice.name() {
                "relative" => choice.value()?.fraction().map(Within::Relative),
                _ => not_negative(choice.value()?, unit, "a distance").map(Within::Absolute),
            })
        };
        at.named("within", "A distance between two numbers", distance)
    }
}

fn not_negative(at: At<'_>, unit: Option<&str>, what: &str) -> Option<f64> {
    at.number_in(unit).and_then(|x| if x < 0.0 { at.wrong(format!("{what} cannot be negative")) } else { Some(x) })
}

/// The unit of numbers that are held against each other: of the first whose columns are known.
fn unit_of(values: Option<&Vec<Extraction>>) -> Option<&'static str> {
    values?.iter().find_map(Extraction::unit)
}

mapping! {
    "an interval" Between, in_order {
        value: Extraction = required("The number", extraction),
        from: Option<f64> = optional("Lower end; open if absent", in_unit(value.as_ref().and_then(Extraction::unit))),
        to: Option<f64> = optional("Upper end; open if absent", in_unit(value.as_ref().and_then(Extraction::unit))),
    }
}

impl Between {
    fn in_order(&self, at: At<'_>) -> Option<()> {
        match (self.from, self.to) {
            (None, None) => at.wrong("an interval lacks an end: give `from`, `to` or both"),
            (Some(from), Some(to)) if from > to => at.under("to").wrong("no number lies between: `from` is above `to`"),
            _ => Some(()),
        }
    }
}

claim! {
    "a level of all rows" Level {
        of: Column = required("The measure", Column::read),
        level: f64 = required("The level", in_unit_of(of.as_ref())),
        slack: f64 =
            or("Trespass allowed, in the measure's unit", |at| not_negative(at, of.as_ref().and_then(Column::unit), "a slack"), 0.0),
    }
}

claim! {
    "an agreement of columns" ColumnsAgree {
        columns: Vec<Column> = required("The measures", |at| two_or_more(at, Column::read, "agreement needs two columns or more")),
        within: Within = required("How near", within(columns.as_ref().and_then(|columns| columns[0].unit()))),
    }
}

claim! {
    "an agreement of lines" LinesAgree {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        by: Column = required("The column that tells the lines apart", Column::read),
        within: Within = required("How near", within(of.as_ref().and_then(Column::unit))),
    }
}
claim! {
    "a line above another" LineAbove, of_two_lines {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        by: Column = required("The column that tells the lines apart", Column::read),
        above: String = required("Its level on the upper line", |at| at.text()),
        below: String = required("Its level on the lower line", |at| at.text()),
        points: Points = or("At how many of the points", |at| at.word("share of the points"), Points::Every),
    }
}

/// At how many points of two lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Points {
    /// At each.
    Every,
    /// At more than half of them.
    Most,
}

impl Reads for Part {}
impl Reads for Points {}

impl LineAbove {
    pub(crate) fn pair(&self) -> Pair<'_> {
        Pair { of: &self.of, over: &self.over, by: &self.by, above: &self.above, below: &self.below }
    }

    fn of_two_lines(&self, at: At<'_>) -> Option<()> {
        self.pair().of_two_lines(at)
    }
}

claim! {
    "a straight line" Linear {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        within: f64 =
            required("Largest departure from the least-squares line, as a fraction of the measure's range", |at| at.fraction()),
    }
}
claim! {
    "a plateau" LevelsOff {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        from: f64 = required("Where the plateau begins", in_unit_of(over.as_ref())),
        within: f64 =
            required("Largest departure from the last value, as a fraction of the whole line's range", |at| at.fraction()),
    }
}
claim! {
    "a top at an end" GreatestAtEnd {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        end: Side = required("Which end", side),
    }
}
claim! {
    "a number of peaks" Peaks, in_order {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        prominence: f64 =
            required("What counts as a peak: its prominence as a fraction of the line's range", |at| at.fraction()),
        at_least: Option<usize> = optional("No fewer", peaks),
        at_most: Option<usize> = optional("No more", peaks),
    }
}

fn peaks(at: At<'_>) -> Option<usize> {
    usize::try_from(at.count("peaks", u32::MAX)?).ok()
}

impl Peaks {
    fn in_order(&self, at: At<'_>) -> Option<()> {
        match (self.at_least, self.at_most) {
            (None, None) => at.wrong("how many peaks? give `at_least`, `at_most` or both"),
            (Some(least), Some(most)) if least > most => {
                at.under("at_most").wrong("no number of peaks is both: `at_least` is above `at_most`")
            }
            _ => Some(()),
        }
    }
}

claim! {
    "an order of onsets" Onsets {
        over: Column = required("The parameter", Column::read),
        order: Vec<Onset> = required("What begins, in this order", |at| two_or_more(at, Onset::read, "an order needs two onsets or more")),
    }
}
mapping! {
    "an onset" Onset {
        of: Column = required("The measure", Column::read),
        above: f64 = required("The level", in_unit_of(of.as_ref())),
    }
}

claim! {
    "a crossing of paths" PathsCross {
        of: Column = required("One", Column::read),
        other: Column = required("The other", Column::read),
    }
}
claim! {
    "a path that goes one way" PathMonotone {
        of: Column = required("The path", Column::read),
        direction: Direction = required("Which way", direction),
        slack: f64 = or("Step back allowed, as a fraction of its range", |at| at.fraction(), 0.0),
        after: Option<f64> =
            optional("Looked at from this time on, s; from the first sample if absent", |at| at.number_in(Some("s"))),
    }
}
claim! {
    "a largest point" GreatestPoint {
        of: Column = required("The list: a shape, a time history", Column::read),
        over: Column = required("The list of its points: `x`, `time`", Column::read),
        at: f64 =
            required("The point that is largest: of the list's points the nearest to here", in_unit_of(over.as_ref())),
    }
}

impl Within {
    /// The distance that it is for these two numbers.
    pub(crate) fn allows(&self, a: f64, b: f64) -> f64 {
        match self {
            Self::Relative(fraction) => fraction * a.abs().max(b.abs()),
            Self::Absolute(distance) => *distance,
        }
    }

    /// In what a distance of two numbers of this unit is shown.
    pub(crate) fn shown(&self, a: f64, b: f64, unit: &str) -> Shown {
        match self {
            Self::Relative(_) => Shown::PercentOf(a.abs().max(b.abs())),
            Self::Absolute(_) => Shown::Unit(unit.into()),
        }
    }

    /// For a reader, beside numbers of this unit of which the largest is `largest`.
    pub(crate) fn words(&self, largest: f64, unit: &str) -> String {
        match self {
            Self::Relative(fraction) => percent(*fraction),
            Self::Absolute(distance) => in_scale_of(largest, *distance, 3, unit),
        }
    }
}
