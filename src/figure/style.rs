//! How figures look: sizes in pixels of the finished picture, colours, dashes, markers. Nothing else holds a literal
//! size.
//!
//! The picture is 1440 pixels wide. At a journal's column of 88 mm that is 415 dots per inch, and the labels are 7 to 8
//! points high.

use std::collections::BTreeMap;

use crate::dynamics::Special;
use crate::experiment::{LineColour, Stability};

/// Width of a figure.
pub(super) const WIDTH: f64 = 1440.0;
pub(super) const TICK_TEXT: f64 = 38.0;
pub(super) const LABEL_TEXT: f64 = 42.0;
pub(super) const LEGEND_TEXT: f64 = 36.0;
pub(super) const NOTE_TEXT: f64 = 32.0;

pub(super) const FRAME: f64 = 2.5;
pub(super) const GRID: f64 = 1.5;
pub(super) const GUIDE: f64 = 2.5;
/// Dash of guides.
pub(super) const GUIDE_DASH: &[f64] = &[10.0, 8.0];
pub(super) const CURVE: f64 = 5.0;
pub(super) const THIN_CURVE: f64 = 3.0;
pub(super) const TICK: f64 = 13.0;
pub(super) const MINOR_TICK: f64 = 7.0;
pub(super) const MARKER: f64 = 10.0;
/// Width of a dot of a cloud.
const DOT: f64 = 3.5;
/// By how much those of the cloud beneath are wider: where two agree, both are seen.
const DOT_BENEATH: f64 = 3.0;
/// Rows below which dots have room to be twice as wide.
const SPARSE: usize = 100;
pub(super) const QUOTED: f64 = 17.0;
/// Space between neighbours: a tick and its label, a label and the edge.
pub(super) const SPACE: f64 = 14.0;
/// Width of a panel's letter, with space beside it.
pub(super) const LETTER: f64 = 90.0;
/// Length of the line drawn in a legend.
pub(super) const LEGEND_LINE: f64 = 84.0;
/// Height of a legend's row.
pub(super) const LEGEND_ROW: f64 = 50.0;
/// Width of a colour bar.
pub(super) const BAR: f64 = 48.0;
/// Half the size of the signs in a map.
pub(super) const MAP_SIGN: f64 = 19.0;
/// A contour between two bands of colour.
pub(super) const CONTOUR: f64 = 2.0;
/// Height that a map does not exceed.
pub(super) const TALLEST_MAP: f64 = 1500.0;
pub(super) const BAND_OPACITY: f64 = 0.22;
/// Of lines that stand on each other.
pub(super) const STACK_OPACITY: f64 = 0.55;
/// Of the part of an axis that another panel shows closer.
pub(super) const CLOSER_OPACITY: f64 = 0.07;

/// Height of a figure with so many panels.
pub(super) fn height(panels: usize) -> f64 {
    match u32::try_from(panels) {
        Ok(0 | 1) => 960.0,
        Ok(more) => 720.0 + 240.0 * f64::from(more),
        Err(_) => 960.0,
    }
}

/// Width of a sketch.
pub(super) const SKETCH_WIDTH: f64 = 1100.0;
/// Where the particle of a sketch stands.
pub(super) const PLACE: f64 = 340.0;

/// Red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Color(pub u8, pub u8, pub u8);

impl std::fmt::Display for Color {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

pub(super) const INK: Color = Color(0x1A, 0x1A, 0x1A);
pub(super) const GREY: Color = Color(0x70, 0x70, 0x70);
pub(super) const PALE: Color = Color(0xE4, 0xE4, 0xE4);
pub(super) const PAPER: Color = Color(0xFF, 0xFF, 0xFF);

pub(super) const VERMILION: Color = OKABE_ITO[1];
pub(super) const BLUE_INK: Color = OKABE_ITO[0];

/// Okabe and Ito's colours, told apart by readers with any colour vision; without the yellow, which paper swallows.
const OKABE_ITO: [Color; 7] = [
    Color(0x00, 0x72, 0xB2),
    Color(0xD5, 0x5E, 0x00),
    Color(0x00, 0x9E, 0x73),
    Color(0xCC, 0x79, 0xA7),
    Color(0xE6, 0x9F, 0x00),
    Color(0x56, 0xB4, 0xE9),
    Color(0x00, 0x00, 0x00),
];

/// Kinds of motion as a strip tells them apart: rest in one hue and the others in another, the less orderly the darker; no line and
/// no band has either.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum KindOfMotion {
    AtRest,
    OneToOne,
    OtherPeriodic,
    QuasiPeriodic,
    Chaotic,
    NotSettled,
}

impl KindOfMotion {
    pub(super) const ALL: [Self; 6] =
        [Self::AtRest, Self::OneToOne, Self::OtherPeriodic, Self::QuasiPeriodic, Self::Chaotic, Self::NotSettled];

    pub(super) fn color(self) -> Color {
        match self {
            Self::AtRest => Color(0xF0, 0xE2, 0x9A),
            Self::OneToOne => Color(0xC9, 0xB8, 0xE8),
            Self::OtherPeriodic => Color(0x96, 0x78, 0xCE),
            Self::QuasiPeriodic => Color(0x63, 0x3A, 0xA3),
            Self::Chaotic => Color(0x2A, 0x0A, 0x4F),
            Self::NotSettled => PAPER,
        }
    }

    /// In a legend.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::AtRest => "at rest",
            Self::OneToOne => "periodic 1:1",
            Self::OtherPeriodic => "other periodic",
            Self::QuasiPeriodic => "quasi-periodic",
            Self::Chaotic => "chaotic",
            Self::NotSettled => "not settled",
        }
    }
}

/// The place of a colour among Okabe and Ito's.
fn index(colour: LineColour) -> usize {
    match colour {
        LineColour::Blue => 0,
        LineColour::Vermilion => 1,
        LineColour::Green => 2,
        LineColour::Purple => 3,
        LineColour::Orange => 4,
        LineColour::SkyBlue => 5,
        LineColour::Black => 6,
    }
}

/// Viridis from its dark end to where paper begins to swallow it.
const VIRIDIS: [Color; 6] = [
    Color(0x44, 0x01, 0x54),
    Color(0x41, 0x44, 0x87),
    Color(0x2A, 0x78, 0x8E),
    Color(0x22, 0xA8, 0x84),
    Color(0x7A, 0xD1, 0x51),
    Color(0xBB, 0xCC, 0x20),
];

/// Drawn and left out, by turns; told apart in print without colour.
const DASHES: [&[f64]; 6] =
    [&[], &[26.0, 11.0], &[6.0, 9.0], &[30.0, 9.0, 6.0, 9.0], &[14.0, 8.0], &[36.0, 9.0, 6.0, 9.0, 6.0, 9.0]];

/// The shape of a marker; the open diamond belongs to the numbers quoted by the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Marker {
    Circle,
    Square,
    Up,
    Down,
    Diamond,
    Cross,
    Saltire,
}

impl Marker {
    /// Of a special point of a branch.
    pub(super) fn of_special(kind: Special) -> Self {
        match kind {
            Special::Fold => Self::Circle,
            Special::PeriodDoubling => Self::Square,
            Special::Torus => Self::Up,
            Special::Graze => Self::Down,
            Special::Sticking => Self::Diamond,
            Special::SymmetryBreaking => Self::Cross,
            Special::BranchPoint => Self::Saltire,
        }
    }
}

const MARKERS: [Marker; 4] = [Marker::Circle, Marker::Square, Marker::Up, Marker::Down];

/// How one curve is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Look {
    pub color: Color,
    pub width: f64,
    pub dash: &'static [f64],
    pub marker: Marker,
}

impl Look {
    /// The look of the line that is number `hue` of `hues` by its colour and number `dash` by its dash.
    ///
    /// More lines than named colours take a ramp: they are levels of one quantity then.
    pub(super) fn new(hue: usize, hues: usize, dash: usize) -> Self {
        let color = if hues <= OKABE_ITO.len() { OKABE_ITO[hue % OKABE_ITO.len()] } else { ramp(hue, hues) };
        Self { color, width: CURVE, dash: DASHES[dash % DASHES.len()], marker: MARKERS[dash % MARKERS.len()] }
    }

    /// The look of the cloud of so many `rows` that is number `index` of `count` from below.
    pub(super) fn of_dots(index: usize, count: usize, rows: usize) -> Self {
        let above = u32::try_from(count - index - 1).map_or(0.0, f64::from).min(3.0);
        let dot = if rows < SPARSE { 2.0 * DOT } else { DOT };
        Self { width: dot + DOT_BENEATH * above, ..Self::new(index, count, 0) }
    }

    /// The same line without gaps.
    pub(super) fn solid(self) -> Self {
        Self { dash: DASHES[0], ..self }
    }

    /// The same line, solid where a motion is stable and dashed where it is not.
    pub(super) fn with_stability(self, stability: Stability) -> Self {
        let dash = match stability {
            Stability::Stable => DASHES[0],
            Stability::Unstable => DASHES[1],
        };
        Self { dash, marker: Marker::Circle, ..self }
    }

    /// A special point of a branch.
    pub(super) fn of_special(kind: Special) -> Self {
        Self { color: INK, width: CURVE, dash: DASHES[0], marker: Marker::of_special(kind) }
    }

    /// The named colour of what has the same one in every figure, whichever others are drawn: by the study, or what has one in
    /// every study.
    pub(super) fn hue_of_word(word: &str, of_the_study: Option<&BTreeMap<String, LineColour>>) -> Option<usize> {
        let colour = of_the_study.and_then(|colours| colours.get(word)).copied();
        colour
            .or(match word {
                "event-driven" | "genetic algorithm" | "optimised gaps" | "with stop" => Some(LineColour::Blue),
                "2-opt" | "uniform gaps" | "without stop" => Some(LineColour::Vermilion),
                "CMA-ES" => Some(LineColour::Green),
                "chaotic" => Some(LineColour::Vermilion),
                "not settled" => Some(LineColour::Orange),
                "at rest" => Some(LineColour::Black),
                "dense search" => Some(LineColour::Purple),
                _ => None,
            })
            .map(index)
    }

    /// The fixed look of a path in a time history: the same in every figure, whichever other paths are drawn.
    pub(super) fn of_path(column: &str) -> Option<Self> {
        let thin = |color, dash| Self { color, width: THIN_CURVE, dash, marker: Marker::Circle };
        let thick = |color| Self { color, width: CURVE, dash: &[], marker: Marker::Circle };
        Some(match column {
            "base_displacement" => thick(OKABE_ITO[6]),
            "particle_displacement" => thick(OKABE_ITO[1]),
            "floor_displacement" => thick(OKABE_ITO[0]),
            "ceiling_displacement" => thick(OKABE_ITO[2]),
            "rigid_floor" => thin(OKABE_ITO[0], DASHES[4]),
            "rigid_ceiling" => thin(OKABE_ITO[2], DASHES[4]),
            _ => return None,
        })
    }
}

fn ramp(index: usize, count: usize) -> Color {
    let stops = VIRIDIS.len() - 1;
    let share = index * stops;
    let last = (count - 1).max(1);
    let (stop, rest) = ((share / last).min(stops - 1), share - (share / last).min(stops - 1) * last);
    let (from, to) = (VIRIDIS[stop], VIRIDIS[stop + 1]);
    let mix = |a: u8, b: u8| {
        let mixed = (usize::from(a) * (last - rest) + usize::from(b) * rest) / last;
        u8::try_from(mixed).unwrap_or(u8::MAX)
    };
    Color(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}
