//! Claims in words, as predicates that a program decides over a table.
//!
//! A predicate is a set of requirements, each a margin (how far the numbers are on the right side) with its uncertainty.
//! A claim holds if every margin is on the right side by twice its uncertainty, fails if one is on the wrong side by as
//! much, and is undecidable in between. Thresholds (`slack`, `within`, …) are set by hand and need the entry's reason.

use serde::{Deserialize, Serialize};

use super::extraction::{Direction, Extraction, Side};
use super::fit::Fit;
use super::line::Pair;
use super::mode_shape::ModeShape;
use super::place::{BestPlace, GrowsTowards};
use super::selection::Selection;
use super::text::{percent, significant};
use super::tube::Curve;
use super::view::{Source, View};

/// What a claim says of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Predicate {
    /// A measure rises (or falls) along a parameter.
    Monotone(Monotone),
    /// A number rises (or falls) from level to level of a column: the best force ratio with the gap.
    Trend(Trend),
    /// Each number is greater than the next.
    GreatestFirst(Vec<Extraction>),
    /// Numbers are equal.
    Equal(Equal),
    /// Numbers are not equal.
    Apart(Apart),
    /// A number lies in an interval.
    Between(Between),
    /// A measure stays above a level in every row.
    Above(Level),
    /// A measure stays below a level in every row.
    Below(Level),
    /// Measures agree in every row.
    ColumnsAgree(ColumnsAgree),
    /// The lines of a measure agree at every parameter value that they share.
    LinesAgree(LinesAgree),
    /// One line lies above another at every point that they share, or at most of them.
    LineAbove(LineAbove),
    /// A measure is a straight line along a parameter.
    Linear(Linear),
    /// From some parameter value on, a measure changes no more.
    LevelsOff(LevelsOff),
    /// A measure is largest at the end of the sweep: its optimum is not within.
    GreatestAtEnd(GreatestAtEnd),
    /// A measure has so many peaks.
    Peaks(Peaks),
    /// One thing begins before the next as a parameter grows.
    Onsets(Onsets),
    /// In a time history, one path lies now above, now below another.
    PathsCross(PathsCross),
    /// A time history never rises (or falls).
    PathMonotone(PathMonotone),
    /// A shape or time history is largest at one of its points.
    GreatestPoint(GreatestPoint),
    /// A map has its largest value at a place.
    BestPlace(BestPlace),
    /// A map grows towards a place.
    GrowsTowards(GrowsTowards),
    /// A line lies in a tube around a published curve; in a file, an entry's `curve`.
    #[serde(skip_deserializing)]
    Curve(Curve),
    /// A shape is an analytic one; in a file, an entry's `mode_shape`.
    #[serde(skip_deserializing)]
    ModeShape(ModeShape),
}

macro_rules! claim {
    ($(#[$about:meta])* $name:ident { $($(#[$field_about:meta])* $field:ident: $type:ty,)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            $($(#[$field_about])* pub $field: $type,)*
            /// Conditions beyond the entry's own.
            #[serde(rename = "where", default)]
            pub rows: Selection,
        }

        impl $name {
            pub(crate) fn source(&self) -> Source<'_> {
                Source { table: None, rows: &self.rows }
            }
        }
    };
}

claim! {
    /// Rise or fall along a parameter.
    Monotone {
        /// The measure.
        of: String,
        /// The parameter.
        over: String,
        /// Which way.
        direction: Direction,
        /// Step back allowed, as a fraction of the line's range.
        #[serde(default)]
        slack: f64,
        /// Which part of the line.
        #[serde(default)]
        part: Part,
    }
}

/// Part of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// All of it.
    #[default]
    Whole,
    /// Up to its highest point.
    BeforeMaximum,
    /// From its highest point on.
    AfterMaximum,
}

/// Rise or fall of a number from level to level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trend {
    /// The number at each level.
    pub of: Extraction,
    /// The column whose levels are stepped through, ∞ last.
    pub along: String,
    /// Which way.
    pub direction: Direction,
    /// Step back allowed, as a fraction of the numbers' range; 0 asks for a strict rise or fall.
    #[serde(default)]
    pub slack: f64,
}

/// Equality of numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Equal {
    /// The numbers.
    pub values: Vec<Extraction>,
    /// How near.
    pub within: Within,
}

/// Inequality of numbers, whichever is the greater.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Apart {
    /// The numbers.
    pub values: Vec<Extraction>,
    /// How far, at least, any two of them.
    pub by: Within,
}

/// A distance between two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Within {
    /// A fraction of the larger magnitude.
    Relative(f64),
    /// In the numbers' unit.
    Absolute(f64),
}

/// An interval for a number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Between {
    /// The number.
    pub value: Extraction,
    /// Lower end; open if absent.
    #[serde(default)]
    pub from: Option<f64>,
    /// Upper end; open if absent.
    #[serde(default)]
    pub to: Option<f64>,
}

claim! {
    /// A level that no row passes.
    Level {
        /// The measure.
        of: String,
        /// The level.
        level: f64,
        /// Trespass allowed, in the measure's unit.
        #[serde(default)]
        slack: f64,
    }
}
claim! {
    /// Agreement of measures row by row.
    ColumnsAgree {
        /// The measures.
        columns: Vec<String>,
        /// How near.
        within: Within,
    }
}
claim! {
    /// Agreement of lines point by point.
    LinesAgree {
        /// The measure.
        of: String,
        /// The parameter.
        over: String,
        /// The column that tells the lines apart.
        by: String,
        /// How near.
        within: Within,
    }
}
claim! {
    /// A line above another.
    LineAbove {
        /// The measure.
        of: String,
        /// The parameter.
        over: String,
        /// The column that tells the lines apart.
        by: String,
        /// Its level on the upper line.
        above: String,
        /// Its level on the lower line.
        below: String,
        /// At how many of the points.
        #[serde(default)]
        points: Points,
    }
}

/// At how many points of two lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Points {
    /// At each.
    #[default]
    Every,
    /// At more than half of them.
    Most,
}

impl LineAbove {
    pub(crate) fn pair(&self) -> Pair<'_> {
        Pair { of: &self.of, over: &self.over, by: &self.by, above: &self.above, below: &self.below }
    }
}

claim! {
    /// A straight line.
    Linear {
        /// The measure.
        of: String,
        /// The parameter.
        over: String,
        /// Largest departure from the least-squares line, as a fraction of the measure's range.
        within: f64,
    }
}
claim! {
    /// A plateau.
    LevelsOff {
        /// The measure.
        of: String,
        /// The parameter.
        over: String,
        /// Where the plateau begins.
        from: f64,
        /// Largest departure from the last value, as a fraction of the whole line's range.
        within: f64,
    }
}
claim! {
    /// The top at an end.
    GreatestAtEnd {
        /// The measure.
        of: String,
        /// The parameter.
        over: String,
        /// Which end.
        end: Side,
    }
}
claim! {
    /// A number of peaks.
    Peaks {
        /// The measure.
        of: String,
        /// The parameter.
        over: String,
        /// What counts as a peak: its prominence as a fraction of the line's range.
        prominence: f64,
        /// No fewer.
        #[serde(default)]
        at_least: Option<usize>,
        /// No more.
        #[serde(default)]
        at_most: Option<usize>,
    }
}
claim! {
    /// An order of onsets.
    Onsets {
        /// The parameter.
        over: String,
        /// What begins, in this order.
        order: Vec<Onset>,
    }
}

/// Something begins where a measure first exceeds a level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Onset {
    /// The measure.
    pub of: String,
    /// The level.
    pub above: f64,
}

claim! {
    /// Two paths.
    PathsCross {
        /// One.
        of: String,
        /// The other.
        other: String,
    }
}
claim! {
    /// A time history that goes one way.
    PathMonotone {
        /// The path.
        of: String,
        /// Which way.
        direction: Direction,
        /// Step back allowed, as a fraction of its range.
        #[serde(default)]
        slack: f64,
        /// Looked at from this time on, s; from the first sample if absent.
        #[serde(default)]
        after: Option<f64>,
    }
}

claim! {
    /// The largest value of a list of numbers, and where it lies.
    GreatestPoint {
        /// The list: a shape, a time history.
        of: String,
        /// The list of its points: `x`, `time`.
        over: String,
        /// The point that is largest: of the list's points the nearest to here.
        at: f64,
    }
}

impl Within {
    /// The distance that it is for these two numbers.
    pub(crate) fn allows(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Relative(fraction) => fraction * a.abs().max(b.abs()),
            Self::Absolute(distance) => distance,
        }
    }

    /// For a reader.
    pub(crate) fn words(self) -> String {
        match self {
            Self::Relative(fraction) => percent(fraction),
            Self::Absolute(distance) => significant(distance, 3),
        }
    }
}

impl Predicate {
    /// True if a threshold was chosen by hand.
    pub(crate) fn has_threshold(&self) -> bool {
        match self {
            Self::Monotone(claim) => claim.slack > 0.0,
            Self::Trend(claim) => claim.slack > 0.0,
            Self::Above(claim) | Self::Below(claim) => claim.slack > 0.0,
            Self::PathMonotone(claim) => claim.slack > 0.0,
            Self::BestPlace(claim) => claim.slack > 0.0 || claim.among > 1,
            Self::GrowsTowards(claim) => claim.slack > 0.0,
            Self::Equal(_)
            | Self::Apart(_)
            | Self::Between(_)
            | Self::ColumnsAgree(_)
            | Self::LinesAgree(_)
            | Self::Linear(_)
            | Self::LevelsOff(_)
            | Self::Peaks(_)
            | Self::Curve(_)
            | Self::ModeShape(_) => true,
            Self::GreatestFirst(_)
            | Self::GreatestAtEnd(_)
            | Self::Onsets(_)
            | Self::PathsCross(_)
            | Self::GreatestPoint(_)
            | Self::LineAbove(_) => false,
        }
    }

    /// What makes it a predicate that nothing can satisfy or nothing can fail; `None` if it is sound.
    pub(crate) fn flaw(&self) -> Option<&'static str> {
        let fraction = |x: f64| x.is_finite() && (0.0..1.0).contains(&x);
        let near = |within: Within| match within {
            Within::Relative(x) => fraction(x),
            Within::Absolute(x) => x.is_finite() && x >= 0.0,
        };
        let sound = match self {
            Self::Monotone(claim) => fraction(claim.slack),
            Self::Trend(claim) => fraction(claim.slack) && claim.of.is_sound(),
            Self::GreatestFirst(list) if list.len() < 2 => return Some("an order needs two numbers or more"),
            Self::GreatestFirst(list) => list.iter().all(Extraction::is_sound),
            Self::Equal(claim) if claim.values.len() < 2 => return Some("equality needs two numbers or more"),
            Self::Equal(claim) => near(claim.within) && claim.values.iter().all(Extraction::is_sound),
            Self::Apart(claim) if claim.values.len() < 2 => return Some("inequality needs two numbers or more"),
            Self::Apart(claim) => near(claim.by) && claim.values.iter().all(Extraction::is_sound),
            Self::Between(Between { from: None, to: None, .. }) => return Some("give `from`, `to` or both"),
            Self::Between(Between { from: Some(from), to: Some(to), .. }) if from > to => {
                return Some("no number lies between: `from` is above `to`");
            }
            Self::Between(claim) => {
                claim.value.is_sound() && [claim.from, claim.to].iter().flatten().all(|end| end.is_finite())
            }
            Self::Above(claim) | Self::Below(claim) => {
                claim.level.is_finite() && claim.slack.is_finite() && claim.slack >= 0.0
            }
            Self::ColumnsAgree(claim) if claim.columns.len() < 2 => return Some("agreement needs two columns or more"),
            Self::ColumnsAgree(claim) => near(claim.within),
            Self::LinesAgree(claim) => near(claim.within),
            Self::LineAbove(claim) if claim.above == claim.below => return Some("a line is not above itself"),
            Self::LineAbove(_) => true,
            Self::Linear(claim) => fraction(claim.within),
            Self::LevelsOff(claim) => fraction(claim.within) && claim.from.is_finite(),
            Self::Peaks(Peaks { at_least: None, at_most: None, .. }) => {
                return Some("give `at_least`, `at_most` or both");
            }
            Self::Peaks(Peaks { at_least: Some(least), at_most: Some(most), .. }) if least > most => {
                return Some("no number of peaks is both: `at_least` is above `at_most`");
            }
            Self::Peaks(claim) => fraction(claim.prominence),
            Self::Onsets(claim) if claim.order.len() < 2 => return Some("an order needs two onsets or more"),
            Self::Onsets(claim) => claim.order.iter().all(|onset| onset.above.is_finite()),
            Self::PathMonotone(claim) => fraction(claim.slack) && claim.after.is_none_or(f64::is_finite),
            Self::GreatestPoint(claim) => claim.at.is_finite(),
            Self::BestPlace(BestPlace { among: 0, .. }) => return Some("a place is among one of the best or more"),
            Self::BestPlace(claim) => fraction(claim.slack) && claim.at.is_sound(),
            Self::GrowsTowards(claim) => fraction(claim.slack) && claim.to.is_sound(),
            Self::Curve(claim) => return claim.flaw(),
            Self::ModeShape(claim) => return claim.flaw(),
            Self::GreatestAtEnd(_) | Self::PathsCross(_) => true,
        };
        (!sound).then_some("thresholds are finite; fractions lie between 0 and 1")
    }

    /// How well a whole curve or shape agrees; none for other claims, and where there is nothing to compare.
    pub(crate) fn fit(&self, view: &View<'_>) -> Option<Fit> {
        match self {
            Self::Curve(claim) => claim.fit(view),
            Self::ModeShape(claim) => claim.fit(view),
            _ => None,
        }
    }

    /// Where it reads.
    pub(crate) fn sources(&self) -> Vec<Source<'_>> {
        let at_home = |rows| vec![Source { table: None, rows }];
        match self {
            Self::Trend(claim) => claim.of.sources(),
            Self::GreatestFirst(values) | Self::Equal(Equal { values, .. }) | Self::Apart(Apart { values, .. }) => {
                values.iter().flat_map(Extraction::sources).collect()
            }
            Self::Between(claim) => claim.value.sources(),
            Self::Monotone(claim) => vec![claim.source()],
            Self::Above(claim) | Self::Below(claim) => vec![claim.source()],
            Self::ColumnsAgree(claim) => vec![claim.source()],
            Self::LinesAgree(claim) => vec![claim.source()],
            Self::LineAbove(claim) => vec![claim.source()],
            Self::Linear(claim) => vec![claim.source()],
            Self::LevelsOff(claim) => vec![claim.source()],
            Self::GreatestAtEnd(claim) => vec![claim.source()],
            Self::Peaks(claim) => vec![claim.source()],
            Self::Onsets(claim) => vec![claim.source()],
            Self::PathsCross(claim) => vec![claim.source()],
            Self::PathMonotone(claim) => vec![claim.source()],
            Self::GreatestPoint(claim) => vec![claim.source()],
            Self::BestPlace(claim) => at_home(&claim.rows),
            Self::GrowsTowards(claim) => at_home(&claim.rows),
            Self::Curve(claim) => at_home(&claim.rows),
            Self::ModeShape(claim) => at_home(&claim.rows),
        }
    }
}
