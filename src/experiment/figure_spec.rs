//! What a figure shows, as an experiment asks for it.

use serde::{Deserialize, Serialize};

/// One figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FigureSpec {
    /// File stem after the experiment's id; empty for the first.
    pub name: String,
    /// One line under the picture.
    pub caption: String,
    /// Rows to draw: a column of words, and those of its words that count; all rows if absent.
    pub only: Option<Only>,
    /// What is drawn.
    pub drawing: Drawing,
}

/// Rows of a table by the words of a column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Only {
    /// Which column.
    pub column: String,
    /// The words.
    pub words: Vec<String>,
}

/// What a figure draws.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Drawing {
    /// Curves in panels, top to bottom, sharing the x axis.
    Lines(Vec<Panel>),
    /// A quantity over two others, as colours, in panels of one colour scale.
    Map(Box<MapSpec>),
    /// The gaps of an optimised array as bars: those that the file names beside the best found.
    Gaps,
    /// The motion of damper and particle, row by row of the table, slowed down.
    Animation(AnimationSpec),
}

/// An animation of time histories.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AnimationSpec {
    /// Columns that tell the rows apart.
    pub by: Vec<String>,
}

/// A map. Its three columns hold a number a row (a cell a row, drawn as such) or a list a row (a field a row, drawn with
/// contours).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapSpec {
    /// x.
    pub x: Axis,
    /// y.
    pub y: Axis,
    /// What the colour stands for.
    pub value: Axis,
    /// Columns whose levels get a panel each.
    pub by: Vec<String>,
    /// A place to mark in each panel: where the force acts.
    pub mark: Option<Mark>,
    /// Which place to mark and to name.
    pub best: Best,
    /// The number from which colours run apart (0 for a deflection, 1 for a ratio); its contour is drawn.
    pub centre: Option<f64>,
    /// Height of a panel over its width; equal units are drawn to scale if absent.
    pub aspect: Option<f64>,
    /// Panels side by side; as many as suit their number if absent.
    pub columns: Option<u32>,
}

/// A place to mark in a map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    /// Column of its x.
    pub x: String,
    /// Column of its y.
    pub y: String,
    /// What it is, for the legend.
    pub label: String,
}

/// The place of a map to mark and to name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Best {
    /// That of the largest value.
    Highest,
    /// That of the smallest value.
    Lowest,
    /// None.
    None,
}

/// One pair of axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// x.
    pub x: Axis,
    /// y: one or more columns drawn against x.
    pub y: Vec<Axis>,
    /// Columns that split the rows into lines, one colour or dash each (`gap_ratio`, `solver`, `stop`).
    pub by: Vec<String>,
    /// What is drawn as a band about the lines.
    pub band: Band,
    /// Draw each line over the first one, point by point: what differs by little is told apart.
    pub over_first: bool,
    /// Levels to draw as thin guides, with their labels.
    pub guides: Vec<Level>,
    /// Markers on the points (few points) instead of a line alone.
    pub markers: bool,
    /// Which peaks of the curves to mark with their place on the x axis.
    pub peaks: Option<PeakMarks>,
    /// What a strip below the frame shows along the x axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strip: Option<Strip>,
    /// How the points of a line are joined.
    #[serde(default, skip_serializing_if = "is_by_x")]
    pub joined: Joined,
}

/// How the points of a line are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Joined {
    /// In ascending order of x.
    #[default]
    ByX,
    /// In the order of the rows, branch by branch: solid where the column of stability says stable, dashed elsewhere, with a
    /// marker where the column of special points has a word.
    AlongBranches,
}

fn is_by_x(joined: &Joined) -> bool {
    *joined == Joined::ByX
}

/// What a strip shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Strip {
    /// The kind of motion that each point belongs to.
    Motion,
}

/// A band about a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Band {
    /// None.
    #[default]
    None,
    /// One standard deviation of the ensemble to either side.
    Spread,
    /// From the least to the largest of the searches that differ in their seed; the line is their median, in steps.
    Seeds,
    /// From the line before to this one, whose values stand on it: shares of a whole.
    Stacked,
}

/// Which peaks of a curve to mark.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PeakMarks {
    /// How far one has to descend from a peak before the curve rises above it, as a share of the y axis as drawn.
    pub prominence: f64,
    /// At most so many of a curve, the most prominent ones.
    pub most: u32,
}

/// A labelled horizontal guide.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// y value.
    pub at: f64,
    /// Label.
    pub label: String,
}

/// A column as an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Name of the table's column.
    pub column: String,
    /// Axis label without unit, if the column's own name and symbol do not serve.
    pub label: Option<String>,
    /// Linear or logarithmic.
    pub scale: AxisScale,
    /// The axis reaches at least from the one to the other, whatever the data; in the column's unit.
    pub reach: Option<[f64; 2]>,
    /// Of an x axis: only what lies between the two is drawn; in the column's unit.
    pub range: Option<[f64; 2]>,
    /// The unit of its numbers, where it is not left to the size of the data.
    pub unit: Option<AxisUnit>,
}

impl Axis {
    /// All of a column, linear, with its own words and a unit by the size of the data.
    #[must_use]
    pub fn of(column: &str) -> Self {
        Self { column: column.into(), label: None, scale: AxisScale::Linear, reach: None, range: None, unit: None }
    }

    /// Whether this place is drawn.
    #[must_use]
    pub fn shows(&self, x: f64) -> bool {
        self.range.is_none_or(|[from, to]| x >= from && x <= to)
    }
}

/// A unit that an axis is labelled in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AxisUnit {
    /// As a reader sees it: `mm`, `Hz`.
    pub symbol: String,
    /// What one of it is in the column's unit: 0.001 for mm, 2π for Hz.
    pub worth: f64,
}

impl AxisUnit {
    /// The column's own, whatever the size of the data.
    #[must_use]
    pub fn own(symbol: &str) -> Self {
        Self { symbol: symbol.into(), worth: 1.0 }
    }
}

/// Scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AxisScale {
    /// Linear.
    #[default]
    Linear,
    /// Base 10.
    Log,
}
