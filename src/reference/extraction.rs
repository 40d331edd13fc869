//! The words in which an entry says how a number is taken out of a table: one for each way in which a study quotes a number
//! of its curves. `{argmax: {of: velocity_ratio, over: force_ratio}}` is the force ratio of the largest velocity ratio.

use serde::{Deserialize, Serialize};

use super::average::{Interpolated, Stretch};
use super::line::Pair;
use super::resonance::Peak;
use super::selection::Selection;
use super::view::Source;
use crate::measure::Measure;
use crate::text::words::of_key;

/// How a number is taken out of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Extraction {
    /// A fixed number, to hold others against.
    Number(f64),
    /// The measure in the one row that is meant.
    Cell(Cells),
    /// Mean of a measure over the rows.
    Mean(Cells),
    /// Largest value along a parameter.
    Maximum(Along),
    /// Smallest value along a parameter.
    Minimum(Along),
    /// The parameter of the largest value.
    Argmax(Along),
    /// The parameter of the smallest value.
    Argmin(Along),
    /// Another measure where this one is largest.
    AtMaximum(AtMaximum),
    /// The measure at the first or last point of a line.
    End(End),
    /// The parameter at which a measure first crosses a level.
    Crossing(Crossing),
    /// The first parameter value at which a measure exceeds a level.
    FirstAbove(FirstAbove),
    /// The first parameter value at which two lines differ by more than a fraction of their mean, and by more than chance, and at
    /// the next one, too: a single point may be a run that has not settled.
    Parting(Parting),
    /// The first parameter value at which two lines change places.
    Meeting(Meeting),
    /// The largest fall of a rising line, or rise of a falling one: how much it deviates from monotone.
    LargestStepBack(StepBack),
    /// By how much one line is ahead of another at most.
    LargestLead(Lead),
    /// The parameter where it is.
    ArgmaxLead(Lead),
    /// Of the instants at which one path of a time history passes another, the one nearest to a given time.
    NearestPassage(NearestPassage),
    /// Largest value of all rows, whatever they are over.
    Largest(Cells),
    /// Smallest value of all rows.
    Smallest(Cells),
    /// Largest number of a time history.
    PathMaximum(Cells),
    /// Smallest number of a time history.
    PathMinimum(Cells),
    /// A measure between two points of a line.
    Interpolated(Interpolated),
    /// Mean along a parameter, ∫ y dx over its length.
    MeanOver(Stretch),
    /// Standard deviation along a parameter.
    StandardDeviationOver(Stretch),
    /// Place, height or half-power width of a resonance.
    Peak(Peak),
    /// One number over another.
    Ratio(Box<Quotient>),
    /// One number less another.
    Difference(Box<Difference>),
    /// A number times a factor.
    Times(Box<Times>),
}

macro_rules! word {
    ($(#[$about:meta])* $name:ident { $($(#[$field_about:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            /// The measure.
            pub of: String,
            $($(#[$field_about])* pub $field: $type,)*
            /// Conditions beyond the entry's own.
            #[serde(rename = "where", default)]
            pub rows: Selection,
            /// Another experiment's table; the entry's conditions do not hold there.
            #[serde(default)]
            pub table: Option<String>,
        }

        impl $name {
            pub(crate) fn source(&self) -> Source<'_> {
                Source { table: self.table.as_deref(), rows: &self.rows }
            }
        }
    };
}

word! {
    /// A measure in some rows.
    Cells {}
}
word! {
    /// A measure along a parameter.
    Along {
        /// The parameter.
        over: String,
    }
}
word! {
    /// Another measure at the top.
    AtMaximum {
        /// The parameter.
        over: String,
        /// The other measure.
        read: String,
    }
}
word! {
    /// One end of a line.
    End {
        /// The parameter.
        over: String,
        /// Which end.
        end: Side,
    }
}
word! {
    /// Crossing of a level.
    Crossing {
        /// The parameter.
        over: String,
        /// The level.
        level: f64,
        /// Upwards (`increasing`) or downwards.
        direction: Direction,
    }
}
word! {
    /// Onset.
    FirstAbove {
        /// The parameter.
        over: String,
        /// The level to be exceeded.
        level: f64,
    }
}
word! {
    /// Parting of two lines.
    Parting {
        /// The parameter.
        over: String,
        /// The column that tells the two lines apart.
        by: String,
        /// Of their mean.
        fraction: f64,
    }
}
word! {
    /// Two lines that change places.
    Meeting {
        /// The parameter.
        over: String,
        /// The column that tells the two lines apart.
        by: String,
    }
}
word! {
    /// Deviation from monotone.
    StepBack {
        /// The parameter.
        over: String,
        /// Which way the line should go.
        direction: Direction,
    }
}
word! {
    /// One line ahead of another.
    Lead {
        /// The parameter.
        over: String,
        /// The column that tells the lines apart.
        by: String,
        /// Its level on the line that is ahead.
        above: String,
        /// Its level on the other.
        below: String,
    }
}

impl Lead {
    pub(crate) fn pair(&self) -> Pair<'_> {
        Pair { of: &self.of, over: &self.over, by: &self.by, above: &self.above, below: &self.below }
    }
}

/// An instant in the time history of the one row that is meant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NearestPassage {
    /// The path that passes.
    pub of: String,
    /// The path that is passed.
    pub through: String,
    /// From below (`increasing`) or from above.
    pub direction: Direction,
    /// The time to be near to, s.
    pub to: f64,
    /// A path to be read at that instant, in the place of the instant itself.
    #[serde(default)]
    pub read: Option<String>,
    /// Conditions beyond the entry's own.
    #[serde(rename = "where", default)]
    pub rows: Selection,
}

/// A ratio.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quotient {
    /// Above the line.
    pub of: Extraction,
    /// Below it.
    pub to: Extraction,
}

/// A difference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Difference {
    /// From this,
    pub of: Extraction,
    /// this is taken.
    pub less: Extraction,
}

/// A multiple.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Times {
    /// The factor.
    pub factor: f64,
    /// Of what.
    pub of: Extraction,
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

impl Direction {
    /// 1 upwards, −1 downwards.
    pub(crate) fn sign(self) -> f64 {
        if self == Self::Increasing { 1.0 } else { -1.0 }
    }
}

impl Extraction {
    /// Whether it takes a number of events, which has no digits to come.
    pub(crate) fn is_count(&self) -> bool {
        let of = match self {
            Self::Cell(cells) | Self::Largest(cells) | Self::Smallest(cells) => &cells.of,
            Self::Maximum(along) | Self::Minimum(along) => &along.of,
            _ => return false,
        };
        Measure::ALL.iter().any(|measure| measure.is_count() && of_key(measure) == *of)
    }

    /// True if every number written into it is finite.
    pub(crate) fn is_sound(&self) -> bool {
        match self {
            Self::Number(x) => x.is_finite(),
            Self::Crossing(word) => word.level.is_finite(),
            Self::FirstAbove(word) => word.level.is_finite(),
            Self::Parting(word) => word.fraction.is_finite() && word.fraction > 0.0,
            Self::NearestPassage(word) => word.to.is_finite(),
            Self::MeanOver(word) | Self::StandardDeviationOver(word) => word.is_sound(),
            Self::Peak(peak) => peak.is_sound(),
            Self::Ratio(quotient) => quotient.of.is_sound() && quotient.to.is_sound(),
            Self::Difference(difference) => difference.of.is_sound() && difference.less.is_sound(),
            Self::LargestLead(word) | Self::ArgmaxLead(word) => word.above != word.below,
            Self::Times(times) => times.factor.is_finite() && times.factor != 0.0 && times.of.is_sound(),
            _ => true,
        }
    }

    /// Where it reads.
    pub(crate) fn sources(&self) -> Vec<Source<'_>> {
        let source = match self {
            Self::Number(_) => return Vec::new(),
            Self::NearestPassage(word) => Source { table: None, rows: &word.rows },
            Self::Cell(word) | Self::Mean(word) | Self::Largest(word) | Self::Smallest(word) => word.source(),
            Self::PathMaximum(word) | Self::PathMinimum(word) => word.source(),
            Self::Interpolated(word) => word.source(),
            Self::MeanOver(word) | Self::StandardDeviationOver(word) => word.source(),
            Self::Peak(peak) => peak.source(),
            Self::Maximum(word) | Self::Minimum(word) | Self::Argmax(word) | Self::Argmin(word) => word.source(),
            Self::AtMaximum(word) => word.source(),
            Self::End(word) => word.source(),
            Self::Crossing(word) => word.source(),
            Self::FirstAbove(word) => word.source(),
            Self::Parting(word) => word.source(),
            Self::Meeting(word) => word.source(),
            Self::LargestStepBack(word) => word.source(),
            Self::LargestLead(word) | Self::ArgmaxLead(word) => word.source(),
            Self::Difference(difference) => return [difference.of.sources(), difference.less.sources()].concat(),
            Self::Ratio(quotient) => return [quotient.of.sources(), quotient.to.sources()].concat(),
            Self::Times(times) => return times.of.sources(),
        };
        vec![source]
    }
}
