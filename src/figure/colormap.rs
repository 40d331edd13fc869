//! Numbers to colours that readers with any colour vision, and grey prints, tell apart in the right order.
//!
//! viridis (van der Walt and Smith, 2015) from small to large; Brewer's RdBu reversed, which runs from blue over white to
//! red, where a number in the middle has a meaning of its own.

use super::axis::{Axis, Tick};
use super::style::Color;

/// Every 17th of viridis' 256 colours.
const VIRIDIS: [Color; 16] = [
    Color(68, 1, 84),
    Color(72, 26, 108),
    Color(71, 47, 125),
    Color(65, 68, 135),
    Color(57, 86, 140),
    Color(49, 104, 142),
    Color(42, 120, 142),
    Color(35, 136, 142),
    Color(31, 152, 139),
    Color(34, 168, 132),
    Color(53, 183, 121),
    Color(84, 197, 104),
    Color(122, 209, 81),
    Color(165, 219, 54),
    Color(210, 226, 27),
    Color(253, 231, 37),
];

/// RdBu with eleven colours, the blue end first.
const BLUE_RED: [Color; 11] = [
    Color(5, 48, 97),
    Color(33, 102, 172),
    Color(67, 147, 195),
    Color(146, 197, 222),
    Color(209, 229, 240),
    Color(247, 247, 247),
    Color(253, 219, 199),
    Color(244, 165, 130),
    Color(214, 96, 77),
    Color(178, 24, 43),
    Color(103, 0, 31),
];

/// How many levels a scale of bands has at most.
const MOST_LEVELS: u32 = 12;
/// How many numbers a colour bar carries at most.
const MOST_NUMBERS: u32 = 8;

/// A scale of colours that knows its range.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shades {
    pub axis: Axis,
    /// Where colours run apart, as a share of the axis.
    centre: Option<f64>,
    /// Bounds of bands of one colour each, as shares of the axis from 0 to 1; empty if the colours run smoothly.
    bounds: Vec<f64>,
}

/// Whether colours run smoothly or in bands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Steps {
    Smooth,
    Bands,
}

impl Shades {
    pub(super) fn new(axis: Axis, centre: Option<f64>, steps: Steps) -> Self {
        let bounds = match steps {
            Steps::Smooth => Vec::new(),
            Steps::Bands => {
                let ticks = axis.ticks(MOST_LEVELS).into_iter().filter(|tick| !tick.label.is_empty());
                let inner = ticks.map(|tick| tick.at).filter(|at| *at > 1e-6 && *at < 1.0 - 1e-6);
                std::iter::once(0.0).chain(inner).chain([1.0]).collect()
            }
        };
        Self { centre: centre.and_then(|centre| axis.share(centre)), axis, bounds }
    }

    /// The numbers at a colour bar.
    pub(super) fn ticks(&self) -> Vec<Tick> {
        self.axis.ticks(MOST_NUMBERS)
    }

    /// The shares of the axis that contours stand for: the bounds between bands.
    pub(super) fn levels(&self) -> &[f64] {
        match self.bounds.as_slice() {
            [_, inner @ .., _] => inner,
            _ => &[],
        }
    }

    /// Where colours run apart, as a share of the axis, if that lies within it.
    pub(super) fn centre(&self) -> Option<f64> {
        self.centre.filter(|centre| (0.0..=1.0).contains(centre))
    }

    /// The stretches of the axis that have one colour; `slices` of them where colours run smoothly.
    pub(super) fn slices(&self, slices: u32) -> Vec<[f64; 2]> {
        if self.bounds.is_empty() {
            let at = |i: u32| f64::from(i) / f64::from(slices.max(1));
            (0..slices).map(|i| [at(i), at(i + 1)]).collect()
        } else {
            self.bounds.windows(2).map(|pair| [pair[0], pair[1]]).collect()
        }
    }

    /// Which band a share of the axis lies in.
    pub(super) fn band(&self, share: f64) -> usize {
        self.bounds.partition_point(|bound| *bound <= share).clamp(1, self.bounds.len().saturating_sub(1).max(1)) - 1
    }

    /// The colour of a share of the axis.
    pub(super) fn color(&self, share: f64) -> Color {
        let share = match self.bounds.get(self.band(share)..) {
            Some([from, to, ..]) => (from + to) / 2.0,
            _ => share,
        };
        match self.centre {
            None => mixed(&VIRIDIS, share),
            Some(centre) => {
                // One scale to both sides: equal distances from the centre are equally strong.
                let reach = centre.abs().max((1.0 - centre).abs());
                mixed(&BLUE_RED, 0.5 + 0.5 * (share - centre) / reach)
            }
        }
    }
}

/// The colour at a share of a ramp.
fn mixed(ramp: &[Color], share: f64) -> Color {
    let last = ramp.len() - 1;
    let along = share.clamp(0.0, 1.0) * f64::from(u32::try_from(last).unwrap_or(1));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and the ramp's length")]
    let at = (along.floor() as usize).min(last - 1);
    let rest = along - f64::from(u32::try_from(at).unwrap_or(0));
    let (a, b) = (ramp[at], ramp[at + 1]);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two numbers of 0 to 255")]
    let channel = |a: u8, b: u8| (f64::from(a) + rest * (f64::from(b) - f64::from(a))).round() as u8;
    Color(channel(a.0, b.0), channel(a.1, b.1), channel(a.2, b.2))
}
