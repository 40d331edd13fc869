//! Claims in words, as predicates that a program decides over a table.
//!
//! A predicate is a set of requirements, each a margin (how far the numbers are on the right side) with its uncertainty.
//! A claim holds if every margin is on the right side by twice its uncertainty, fails if one is on the wrong side by as
//! much, and is undecidable in between. Thresholds (`slack`, `within`, …) are set by hand and need the entry's reason.

use super::claims::{
    Apart, Between, ColumnsAgree, Equal, GreatestAtEnd, GreatestPoint, Level, LevelsOff, LineAbove, Linear, LinesAgree,
    Monotone, Onsets, PathMonotone, PathsCross, Peaks, Trend,
};
use super::extraction::{Extraction, extraction, two_or_more};
use super::fit::Fit;
use super::mapping::forms;
use super::mode_shape::ModeShape;
use super::place::{BestPlace, GrowsTowards};
use super::tube::Curve;
use super::view::View;

forms! {
    "a claim" Predicate {
        Monotone(Monotone) = form("monotone", "A measure rises (or falls) along a parameter", Monotone::read),
        Trend(Trend) =
            form("trend", "A number rises (or falls) from level to level of a column: the best force ratio with the gap", Trend::read),
        GreatestFirst(Vec<Extraction>) =
            form("greatest_first", "Each number is greater than the next", |at| two_or_more(at, extraction, "an order needs two numbers or more")),
        Equal(Equal) = form("equal", "Numbers are equal", Equal::read),
        Apart(Apart) = form("apart", "Numbers are not equal", Apart::read),
        Between(Between) = form("between", "A number lies in an interval", Between::read),
        Above(Level) = form("above", "A measure stays above a level in every row", Level::read),
        Below(Level) = form("below", "A measure stays below a level in every row", Level::read),
        ColumnsAgree(ColumnsAgree) = form("columns_agree", "Measures agree in every row", ColumnsAgree::read),
        LinesAgree(LinesAgree) =
            form("lines_agree", "The lines of a measure agree at every parameter value that they share", LinesAgree::read),
        LineAbove(LineAbove) =
            form("line_above", "One line lies above another at every point that they share, or at most of them", LineAbove::read),
        Linear(Linear) = form("linear", "A measure is a straight line along a parameter", Linear::read),
        LevelsOff(LevelsOff) =
            form("levels_off", "From some parameter value on, a measure changes no more", LevelsOff::read),
        GreatestAtEnd(GreatestAtEnd) =
            form("greatest_at_end", "A measure is largest at the end of the sweep: its optimum is not within", GreatestAtEnd::read),
        Peaks(Peaks) = form("peaks", "A measure has so many peaks", Peaks::read),
        Onsets(Onsets) = form("onsets", "One thing begins before the next as a parameter grows", Onsets::read),
        PathsCross(PathsCross) =
            form("paths_cross", "In a time history, one path lies now above, now below another", PathsCross::read),
        PathMonotone(PathMonotone) = form("path_monotone", "A time history never rises (or falls)", PathMonotone::read),
        GreatestPoint(GreatestPoint) =
            form("greatest_point", "A shape or time history is largest at one of its points", GreatestPoint::read),
        BestPlace(BestPlace) = form("best_place", "A map has its largest value at a place", BestPlace::read),
        GrowsTowards(GrowsTowards) = form("grows_towards", "A map grows towards a place", GrowsTowards::read),
        Curve(Curve) =
            elsewhere("curve", "A line lies in a tube around a published curve; in a file, an entry's `curve`"),
        ModeShape(ModeShape) =
            elsewhere("mode_shape", "A shape is an analytic one; in a file, an entry's `mode_shape`"),
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

    /// How well a whole curve or shape agrees; none for other claims, and where there is nothing to compare.
    pub(crate) fn fit(&self, view: &View<'_>) -> Option<Fit> {
        match self {
            Self::Curve(claim) => claim.fit(view),
            Self::ModeShape(claim) => claim.fit(view),
            _ => None,
        }
    }
}
