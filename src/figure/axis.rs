//! Axes: from numbers to the share of the axis they lie at, with ticks and their labels.

use crate::experiment::{AxisScale, AxisUnit};
use crate::text::number::Prefix;

use super::shortest::shortest;

/// Digits of the ends of an axis for programs: a thousandth of a pixel.
const END_DIGITS: usize = 7;

/// Least and largest number that an axis has to show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub least: f64,
    pub largest: f64,
}

impl Extent {
    /// Of the finite numbers; on a logarithmic axis of the positive ones. `None` if there are none.
    pub(super) fn of(numbers: impl Iterator<Item = f64>, scale: AxisScale) -> Option<Self> {
        numbers.filter(|x| x.is_finite() && (scale == AxisScale::Linear || *x > 0.0)).fold(None, |extent, x| {
            let (least, largest) = extent.map_or((x, x), |Self { least, largest }| (least.min(x), largest.max(x)));
            Some(Self { least, largest })
        })
    }
}

impl Extent {
    /// With a guide, and room for its label on the side away from the data.
    pub(super) fn with_guide(self, at: f64, scale: AxisScale) -> Self {
        const ROOM: f64 = 0.12;
        let Self { least, largest } = self;
        let (low, high) = (least.min(at), largest.max(at));
        let (below, above) = match scale {
            // What cannot be negative has no room below zero.
            AxisScale::Linear if low >= 0.0 => ((at - ROOM * (high - low)).max(0.0), at + ROOM * (high - low)),
            AxisScale::Linear => (at - ROOM * (high - low), at + ROOM * (high - low)),
            AxisScale::Log if at > 0.0 => {
                let room = libm::pow(high / low, ROOM);
                (at / room, at * room)
            }
            AxisScale::Log => return self,
        };
        let (to_least, to_largest) = (at - low, high - at);
        if to_least <= to_largest {
            Self { least: low.min(below), largest: high }
        } else {
            Self { least: low, largest: high.max(above) }
        }
    }
}

impl Extent {
    /// Its length along the axis; on a logarithmic one in decades.
    pub(super) fn span(self, scale: AxisScale) -> f64 {
        match scale {
            AxisScale::Linear => self.largest - self.least,
            AxisScale::Log => libm::log10(self.largest / self.least),
        }
    }

    /// The smallest that holds both.
    pub(super) fn union(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), largest: self.largest.max(other.largest) }
    }

    /// With one more number.
    pub(super) fn with(self, at: f64, scale: AxisScale) -> Self {
        Self::of(std::iter::once(at), scale).map_or(self, |other| self.union(other))
    }
}

impl Extent {
    /// With room above the data, as a share of what the data take.
    pub(super) fn with_headroom(self, room: f64, scale: AxisScale) -> Self {
        let Self { least, largest } = self;
        let largest = match scale {
            AxisScale::Linear => largest + room * (largest - least),
            AxisScale::Log => largest * libm::pow(largest / least, room),
        };
        Self { least, largest }
    }
}

/// How much room an axis leaves beyond the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Room {
    /// None: curves run from edge to edge.
    Tight,
    /// A little, so that markers and flat lines stay clear of the frame.
    Airy,
}

/// A mark on an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    /// Share of the axis, 0 to 1.
    pub at: f64,
    /// Its number; empty for a minor tick.
    pub label: String,
}

/// An axis that knows its range.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    scale: AxisScale,
    /// Ends in the table's unit, as logarithms on a logarithmic axis.
    from: f64,
    to: f64,
    /// The displayed number is the table's over this: a prefix of the unit or a power of ten.
    factor: f64,
    /// The unit as displayed: `mm`, `10⁻⁶`; empty if none.
    pub unit: String,
}

impl Axis {
    pub(super) fn new(scale: AxisScale, extent: Extent, room: Room, unit: &str) -> Self {
        match scale {
            AxisScale::Linear => Self::linear(extent, room, unit),
            AxisScale::Log => Self::log(extent, room, unit),
        }
    }

    fn linear(Extent { least, largest }: Extent, room: Room, unit: &str) -> Self {
        let span = largest - least;
        let size = least.abs().max(largest.abs());
        // A flat line gets an axis of its own size around it.
        let flat = span <= 1e-9 * size || span == 0.0;
        let margin = match room {
            _ if flat => {
                if size > 0.0 {
                    0.5 * size
                } else {
                    1.0
                }
            }
            Room::Tight => 0.0,
            Room::Airy => 0.06 * span,
        };
        let near_zero = least >= 0.0 && least < 0.15 * largest && room == Room::Airy && !flat;
        let from = if near_zero { 0.0 } else { least - margin };
        let to = largest + margin;
        let Displayed { factor, unit } = Displayed::choose(from.abs().max(to.abs()), unit);
        Self { scale: AxisScale::Linear, from, to, factor, unit }
    }

    fn log(Extent { least, largest }: Extent, room: Room, unit: &str) -> Self {
        let (low, high) = (libm::log10(least), libm::log10(largest));
        let margin = match room {
            _ if high - low < 1e-9 => 0.15,
            Room::Tight => 0.0,
            Room::Airy => 0.05 * (high - low),
        };
        // Powers of ten are read off such an axis itself: it needs none in its unit.
        let Displayed { factor, unit } = Displayed::prefixed(largest, unit);
        Self { scale: AxisScale::Log, from: low - margin, to: high + margin, factor, unit }
    }

    /// The same with its numbers in the unit that was chosen, if one was.
    pub(super) fn in_unit(self, chosen: Option<&AxisUnit>) -> Self {
        match chosen {
            Some(AxisUnit { symbol, worth }) => Self { factor: *worth, unit: symbol.clone(), ..self },
            None => self,
        }
    }

    /// The share of the axis at which a number lies; `None` for one that cannot be shown.
    pub(super) fn share(&self, number: f64) -> Option<f64> {
        let along = match self.scale {
            AxisScale::Linear => number,
            AxisScale::Log if number > 0.0 => libm::log10(number),
            AxisScale::Log => return None,
        };
        let share = (along - self.from) / (self.to - self.from);
        share.is_finite().then_some(share)
    }

    /// The number at a share of the axis.
    pub(super) fn number(&self, share: f64) -> f64 {
        let along = self.from + share * (self.to - self.from);
        match self.scale {
            AxisScale::Linear => along,
            AxisScale::Log => libm::exp10(along),
        }
    }

    /// A number of the table as this axis displays it.
    pub(super) fn displayed(&self, number: f64) -> f64 {
        number / self.factor
    }

    /// Its scale and its ends as displayed, for programs: `log 0.1 100`.
    pub(super) fn in_words(&self) -> String {
        let scale = if self.scale == AxisScale::Log { "log" } else { "linear" };
        let end = |share: f64| shortest(self.displayed(self.number(share)), END_DIGITS);
        format!("{scale} {} {}", end(0.0), end(1.0))
    }

    /// As [`Axis::share`], with what lies outside moved to the nearer end.
    pub(super) fn share_clamped(&self, number: f64) -> f64 {
        self.share(number).unwrap_or(0.0).clamp(0.0, 1.0)
    }

    /// Ticks from the low end to the high end; at most about `most` of them labelled.
    pub(super) fn ticks(&self, most: u32) -> Vec<Tick> {
        match self.scale {
            AxisScale::Linear => self.linear_ticks(most),
            AxisScale::Log => self.log_ticks(most),
        }
    }

    fn linear_ticks(&self, most: u32) -> Vec<Tick> {
        let (from, to) = (self.from / self.factor, self.to / self.factor);
        let at = |value: f64| (value - from) / (to - from);
        even([from, to], most).into_iter().map(|(value, label)| Tick { at: at(value), label }).collect()
    }

    fn log_ticks(&self, most: u32) -> Vec<Tick> {
        let shown = libm::log10(self.factor);
        let range = Decades { from: self.from - shown, to: self.to - shown };
        let most = usize::try_from(most).unwrap_or(1);
        let labels = range.labels(most);
        if labels == Labels::Even {
            let ends = [range.from, range.to].map(libm::exp10);
            let at = |value: f64| range.share(libm::log10(value));
            let most = u32::try_from(most).unwrap_or(1);
            return even(ends, most).into_iter().map(|(value, label)| Tick { at: at(value), label }).collect();
        }
        let label = |digit: u8, exponent: i32| match labels {
            Labels::Powers { every } if digit == 1 && exponent.unsigned_abs().is_multiple_of(every) => {
                power_of_ten(exponent)
            }
            Labels::Digits(digits) if !digits.contains(&digit) => String::new(),
            Labels::Digits(_) if range.is_plain() => plain(digit, exponent),
            Labels::Digits(_) if digit == 1 => power_of_ten(exponent),
            Labels::Digits(_) => format!("{digit}·{}", power_of_ten(exponent)),
            _ => String::new(),
        };
        let tick = |(digit, exponent)| Tick { at: range.share(along(digit, exponent)), label: label(digit, exponent) };
        range.places(&EVERY_DIGIT).map(tick).collect()
    }
}

const EVERY_DIGIT: [u8; 9] = [1, 2, 3, 4, 5, 6, 7, 8, 9];

/// The displayed ends of a logarithmic axis, as logarithms.
#[derive(Clone, Copy)]
struct Decades {
    from: f64,
    to: f64,
}

/// Which ticks of a logarithmic axis carry a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Labels {
    /// Every so many powers of ten.
    Powers { every: u32 },
    /// These digits of each decade, in plain notation.
    Digits(&'static [u8]),
    /// Those of a linear axis: the range is too short for digits.
    Even,
}

impl Decades {
    /// The fewest labels that leave three to be read, as it takes three to see that the axis is logarithmic.
    fn labels(self, most: usize) -> Labels {
        const FEW: usize = 3;
        const OF_A_DECADE: [&[u8]; 2] = [&[1, 2, 5], &[1, 3]];
        let count = |digits: &[u8]| self.places(digits).count();
        let powers = count(&[1]);
        let every = u32::try_from(powers.div_ceil(most.max(1))).unwrap_or(1).max(1);
        if powers >= FEW && every == 1 && self.from > -2.5 && self.to < 3.5 {
            return Labels::Digits(&[1]);
        }
        if powers >= FEW {
            return Labels::Powers { every };
        }
        let fits = |digits: &&&[u8]| (FEW..=most.max(FEW)).contains(&count(digits));
        match OF_A_DECADE.iter().find(fits) {
            Some(digits) => Labels::Digits(digits),
            None if powers == 2 => Labels::Powers { every },
            None if count(&EVERY_DIGIT) >= FEW => Labels::Digits(&EVERY_DIGIT),
            None => Labels::Even,
        }
    }

    /// Whether a plain number takes no more room than its power of ten.
    fn is_plain(self) -> bool {
        self.from > -5.0 && self.to < 5.0
    }

    /// Digits and exponents that lie on the axis, in ascending order.
    #[expect(clippy::cast_possible_truncation, reason = "decimal exponents of doubles lie within ±324")]
    fn places(self, digits: &[u8]) -> impl Iterator<Item = (u8, i32)> {
        const SLACK: f64 = 1e-9;
        let all = (self.from.floor() as i32..=self.to.ceil() as i32)
            .flat_map(move |exponent| digits.iter().map(move |digit| (*digit, exponent)));
        all.filter(move |(digit, exponent)| (self.from - SLACK..=self.to + SLACK).contains(&along(*digit, *exponent)))
    }

    fn share(self, along: f64) -> f64 {
        (along - self.from) / (self.to - self.from)
    }
}

/// The logarithm of `digit`·10^`exponent`.
fn along(digit: u8, exponent: i32) -> f64 {
    f64::from(exponent) + libm::log10(f64::from(digit))
}

/// Even numbers between two others, about `most` of them, each with its label.
fn even([from, to]: [f64; 2], most: u32) -> Vec<(f64, String)> {
    let Step { size, decimals } = Step::at_least((to - from) / f64::from(most));
    let slack = 1e-9 * (to - from);
    let mut found = Vec::new();
    let mut index = ((from - slack) / size).ceil();
    while index * size <= to + slack {
        // Negative zero has no place on an axis.
        let value = index * size + 0.0;
        found.push((value, format!("{value:.decimals$}").replace('-', "−")));
        index += 1.0;
    }
    found
}

/// The unit that suits the numbers of an axis.
struct Displayed {
    factor: f64,
    unit: String,
}

impl Displayed {
    /// By a prefix, where the unit takes one.
    fn prefixed(size: f64, unit: &str) -> Self {
        // Velocities below 1 m/s are quoted in mm/s.
        let Prefix { symbol, factor } = if unit == "m/s" && (1e-3..1.0).contains(&size) {
            Prefix { symbol: "m", factor: 1e-3 }
        } else {
            Prefix::of(size, unit)
        };
        Self { factor, unit: format!("{symbol}{unit}") }
    }

    /// By a prefix, or else by a power of ten.
    fn choose(size: f64, unit: &str) -> Self {
        let prefixed = Self::prefixed(size, unit);
        if prefixed.factor != 1.0 || (1e-2..1e5).contains(&size) || size == 0.0 {
            return prefixed;
        }
        #[expect(clippy::cast_possible_truncation, reason = "decimal exponents of doubles lie within ±324")]
        let exponent = libm::log10(size).floor() as i32;
        let power = power_of_ten(exponent);
        let unit = if unit.is_empty() { power } else { format!("{power} {unit}") };
        Self { factor: libm::exp10(f64::from(exponent)), unit }
    }
}

/// The distance of linear ticks, 1, 2 or 5 times a power of ten, with the decimals that its multiples need.
struct Step {
    size: f64,
    decimals: usize,
}

impl Step {
    fn at_least(wanted: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "decimal exponents of doubles lie within ±324")]
        let exponent = libm::log10(wanted).floor() as i32;
        let power = libm::exp10(f64::from(exponent));
        let (digit, carried) = match wanted / power {
            x if x <= 1.0 => (1.0, 0),
            x if x <= 2.0 => (2.0, 0),
            x if x <= 5.0 => (5.0, 0),
            _ => (10.0, 1),
        };
        Self { size: digit * power, decimals: usize::try_from(-(exponent + carried)).unwrap_or(0) }
    }
}

/// `digit`·10^`exponent` in plain notation: 50, 0.2.
fn plain(digit: u8, exponent: i32) -> String {
    match usize::try_from(exponent) {
        Ok(zeros) => format!("{digit}{}", "0".repeat(zeros)),
        Err(_) => {
            let decimals = usize::try_from(-exponent).unwrap_or(0);
            format!("{:.decimals$}", f64::from(digit) * libm::exp10(f64::from(exponent)))
        }
    }
}

/// 10 with a superscript.
fn power_of_ten(exponent: i32) -> String {
    let superscript = |letter: char| match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        _ => '⁰',
    };
    format!("10{}", exponent.to_string().chars().map(superscript).collect::<String>())
}
