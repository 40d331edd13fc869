//! The words in which an entry says how a number is taken out of a table: one for each way in which a study quotes a number
//! of its curves. `{argmax: {of: velocity_ratio, over: force_ratio}}` is the force ratio of the largest velocity ratio.

use serde::{Deserialize, Serialize};

use super::average::{Interpolated, Stretch};
use super::line::Pair;
use super::mapping::{Reads, Seen, claim, forms, mapping, word};
use super::name::{Column, in_unit_of};
use super::resonance::Peak;
use super::view::Source;
use crate::measure::Measure;
use crate::text::words::of_key;
use crate::yaml::At;

forms! {
    "a way to take a number" Extraction {
        Number(f64) = form("number", "A fixed number, to hold others against", in_unit_of(None)),
        Cell(Cells) = form("cell", "The measure in the one row that is meant", Cells::read),
        Mean(Cells) = form("mean", "Mean of a measure over the rows", Cells::read),
        Maximum(Along) = form("maximum", "Largest value along a parameter", Along::read),
        Minimum(Along) = form("minimum", "Smallest value along a parameter", Along::read),
        Argmax(Along) = form("argmax", "The parameter of the largest value", Along::read),
        Argmin(Along) = form("argmin", "The parameter of the smallest value", Along::read),
        AtMaximum(AtMaximum) = form("at_maximum", "Another measure where this one is largest", AtMaximum::read),
        End(End) = form("end", "The measure at the first or last point of a line", End::read),
        Crossing(Crossing) = form("crossing", "The parameter at which a measure first crosses a level", Crossing::read),
        FirstAbove(FirstAbove) =
            form("first_above", "The first parameter value at which a measure exceeds a level", FirstAbove::read),
        Parting(Parting) =
            form("parting", "The first of two parameter values in a row at which two lines differ by more than a fraction of their mean and than chance", Parting::read),
        Meeting(Meeting) = form("meeting", "The first parameter value at which two lines change places", Meeting::read),
        LargestStepBack(StepBack) =
            form("largest_step_back", "The largest fall of a rising line, or rise of a falling one: how much it deviates from monotone", StepBack::read),
        LargestLead(Lead) = form("largest_lead", "By how much one line is ahead of another at most", Lead::read),
        ArgmaxLead(Lead) = form("argmax_lead", "The parameter where it is", Lead::read),
        NearestPassage(NearestPassage) =
            form("nearest_passage", "Of the instants at which one path of a time history passes another, the one nearest to a given time", NearestPassage::read),
        Largest(Cells) = form("largest", "Largest value of all rows, whatever they are over", Cells::read),
        Smallest(Cells) = form("smallest", "Smallest value of all rows", Cells::read),
        PathMaximum(Cells) = form("path_maximum", "Largest number of a time history", Cells::read),
        PathMinimum(Cells) = form("path_minimum", "Smallest number of a time history", Cells::read),
        Interpolated(Interpolated) = form("interpolated", "A measure between two points of a line", Interpolated::read),
        MeanOver(Stretch) = form("mean_over", "Mean along a parameter, ∫ y dx over its length", Stretch::read),
        StandardDeviationOver(Stretch) =
            form("standard_deviation_over", "Standard deviation along a parameter", Stretch::read),
        Peak(Peak) = form("peak", "Place, height or half-power width of a resonance", Peak::read),
        Ratio(Box<Quotient>) = form("ratio", "One number over another", boxed(Quotient::read)),
        Difference(Box<Difference>) = form("difference", "One number less another", boxed(Difference::read)),
        Times(Box<Times>) = form("times", "A number times a factor", boxed(Times::read)),
    }
}

/// The reader of what is described once.
pub(crate) fn extraction(at: At<'_>) -> Option<Extraction> {
    at.named("extraction", "How a number is taken out of a table", Extraction::read)
}

/// A list of two or more; `otherwise` says what wants them.
pub(super) fn two_or_more<'t, T>(at: At<'t>, read: impl Fn(At<'_>) -> Option<T>, otherwise: &str) -> Option<Vec<T>> {
    let values = at.list(read)?;
    if values.len() < 2 { at.wrong(otherwise) } else { Some(values) }
}

fn boxed<T>(read: impl Fn(At<'_>) -> Option<T>) -> impl Fn(At<'_>) -> Option<Box<T>> {
    move |at| read(at).map(Box::new)
}

word! {
    "a number of rows" Cells {
        of: Column = required("The measure", Column::read),
    }
}
word! {
    "a number of a line" Along {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
    }
}
word! {
    "a number at a maximum" AtMaximum {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        read: Column = required("The other measure", Column::read),
    }
}
word! {
    "an end" End {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        end: Side = required("Which end", side),
    }
}
word! {
    "a crossing" Crossing {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        level: f64 = required("The level", in_unit_of(of.as_ref())),
        direction: Direction = required("Upwards (`increasing`) or downwards", direction),
    }
}
word! {
    "an onset" FirstAbove {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        level: f64 = required("The level to be exceeded", in_unit_of(of.as_ref())),
    }
}
word! {
    "a parting" Parting {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        by: Column = required("The column that tells the two lines apart", Column::read),
        fraction: f64 = required("Of their mean", |at| at.number_above_zero()),
    }
}
word! {
    "a meeting" Meeting {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        by: Column = required("The column that tells the two lines apart", Column::read),
    }
}
word! {
    "a step back" StepBack {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        direction: Direction = required("Which way the line should go", direction),
    }
}
word! {
    "a lead" Lead, of_two_lines {
        of: Column = required("The measure", Column::read),
        over: Column = required("The parameter", Column::read),
        by: Column = required("The column that tells the lines apart", Column::read),
        above: String = required("Its level on the line that is ahead", |at| at.text()),
        below: String = required("Its level on the other", |at| at.text()),
    }
}

impl Lead {
    pub(crate) fn pair(&self) -> Pair<'_> {
        Pair { of: &self.of, over: &self.over, by: &self.by, above: &self.above, below: &self.below }
    }

    fn of_two_lines(&self, at: At<'_>) -> Option<()> {
        self.pair().of_two_lines(at)
    }
}

claim! {
    "a passage" NearestPassage {
        of: Column = required("The path that passes", Column::read),
        through: Column = required("The path that is passed", Column::read),
        direction: Direction = required("From below (`increasing`) or from above", direction),
        to: f64 = required("The time to be near to, s", |at| at.number_in(Some("s"))),
        read: Option<Column> =
            optional("A path to be read at that instant, in the place of the instant itself", Column::read),
    }
}
mapping! {
    "a ratio" Quotient {
        of: Extraction = required("Above the line", extraction),
        to: Extraction = required("Below it", extraction),
    }
}
mapping! {
    "a difference" Difference {
        of: Extraction = required("From this,", extraction),
        less: Extraction = required("this is taken", extraction),
    }
}
mapping! {
    "a multiple" Times {
        factor: f64 = required("The factor", factor),
        of: Extraction = required("Of what", extraction),
    }
}

fn factor(at: At<'_>) -> Option<f64> {
    at.number().and_then(|x| if x == 0.0 { at.wrong("a factor of zero leaves no number") } else { Some(x) })
}

/// End of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The smallest parameter.
    Low,
    /// The largest parameter.
    High,
}

/// Which way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// Upwards.
    Increasing,
    /// Downwards.
    Decreasing,
}

impl Reads for Side {}
impl Reads for Direction {}

pub(super) fn side(at: At<'_>) -> Option<Side> {
    at.word("end of a line")
}

pub(super) fn direction(at: At<'_>) -> Option<Direction> {
    at.word("direction")
}

impl Direction {
    /// 1 upwards, −1 downwards.
    pub(crate) fn sign(self) -> f64 {
        if self == Self::Increasing { 1.0 } else { -1.0 }
    }
}

impl Extraction {
    /// Where it reads.
    pub(crate) fn sources(&self) -> Vec<Source<'_>> {
        Seen::of(self).sources()
    }

    /// The unit of the number, if its columns are known by their names.
    pub(crate) fn unit(&self) -> Option<&'static str> {
        match self {
            Self::Number(_) => None,
            Self::Cell(word)
            | Self::Mean(word)
            | Self::Largest(word)
            | Self::Smallest(word)
            | Self::PathMaximum(word)
            | Self::PathMinimum(word) => word.of.unit(),
            Self::Maximum(word) | Self::Minimum(word) => word.of.unit(),
            Self::Argmax(word) | Self::Argmin(word) => word.over.unit(),
            Self::AtMaximum(word) => word.read.unit(),
            Self::End(word) => word.of.unit(),
            Self::Crossing(word) => word.over.unit(),
            Self::FirstAbove(word) => word.over.unit(),
            Self::Parting(word) => word.over.unit(),
            Self::Meeting(word) => word.over.unit(),
            Self::LargestStepBack(word) => word.of.unit(),
            Self::LargestLead(word) => word.of.unit(),
            Self::ArgmaxLead(word) => word.over.unit(),
            Self::NearestPassage(word) => word.read.as_ref().map_or(Some("s"), Column::unit),
            Self::Interpolated(word) => word.of.unit(),
            Self::MeanOver(word) | Self::StandardDeviationOver(word) => word.of.unit(),
            Self::Peak(word) => word.column().unit(),
            Self::Ratio(_) => Some(""),
            Self::Difference(word) => word.of.unit().or(word.less.unit()),
            Self::Times(word) => word.of.unit(),
        }
    }

    /// Whether it takes a number of events, which has no digits to come.
    pub(crate) fn is_count(&self) -> bool {
        let of = match self {
            Self::Cell(cells) | Self::Largest(cells) | Self::Smallest(cells) => &cells.of,
            Self::Maximum(along) | Self::Minimum(along) => &along.of,
            _ => return false,
        };
        Measure::ALL.iter().any(|measure| measure.is_count() && *of_key(measure) == **of)
    }
}
