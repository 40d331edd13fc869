//! Axes: from numbers to the share of the axis they lie at, with ticks and their labels.

use crate::experiment::AxisScale;
use crate::text::number::Prefix;

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
    /// Ends, as logarithms on a logarithmic axis.
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
        let unit = unit.to_owned();
        Self { scale: AxisScale::Log, from: low - margin, to: high + margin, factor: 1.0, unit }
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
        format!("{scale} {} {}", self.displayed(self.number(0.0)), self.displayed(self.number(1.0)))
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
        let Step { size, decimals } = Step::at_least((to - from) / f64::from(most));
        let slack = 1e-9 * (to - from);
        let mut ticks = Vec::new();
        let mut index = ((from - slack) / size).ceil();
        while index * size <= to + slack {
            // Negative zero has no place on an axis.
            let value = index * size + 0.0;
            let label = format!("{value:.decimals$}").replace('-', "−");
            ticks.push(Tick { at: (value - from) / (to - from), label });
            index += 1.0;
        }
        ticks
    }

    fn log_ticks(&self, most: u32) -> Vec<Tick> {
        const SLACK: f64 = 1e-9;
        let decades = self.decades();
        let within = decades.clone().filter(|n| self.holds(f64::from(*n), SLACK)).count();
        let every = within.div_ceil(usize::try_from(most).unwrap_or(1)).max(1);
        // Short axes carry plain numbers: 1, 2, 5 of each decade, or all digits where that would be too few.
        let short = within < 2;
        let sparse = decades
            .clone()
            .flat_map(|n| [1_u8, 2, 5].map(|digit| f64::from(n) + libm::log10(f64::from(digit))))
            .filter(|along| self.holds(*along, SLACK))
            .count()
            < 3;
        let mut ticks = Vec::new();
        for exponent in decades {
            for digit in 1..=9_u8 {
                let along = f64::from(exponent) + libm::log10(f64::from(digit));
                if !self.holds(along, SLACK) {
                    continue;
                }
                let label = if short && (sparse || matches!(digit, 1 | 2 | 5)) {
                    plain(digit, exponent)
                } else if !short && digit == 1 && usize::try_from(exponent.unsigned_abs()).unwrap_or(0) % every == 0 {
                    power_of_ten(exponent)
                } else {
                    String::new()
                };
                ticks.push(Tick { at: (along - self.from) / (self.to - self.from), label });
            }
        }
        ticks
    }

    fn holds(&self, along: f64, slack: f64) -> bool {
        along >= self.from - slack && along <= self.to + slack
    }

    #[expect(clippy::cast_possible_truncation, reason = "decimal exponents of doubles lie within ±324")]
    fn decades(&self) -> std::ops::RangeInclusive<i32> {
        (self.from.floor() as i32)..=(self.to.ceil() as i32)
    }
}

/// The unit that suits the numbers of an axis.
struct Displayed {
    factor: f64,
    unit: String,
}

impl Displayed {
    fn choose(size: f64, unit: &str) -> Self {
        // Velocities below 1 m/s are quoted in mm/s.
        let Prefix { symbol, factor } = if unit == "m/s" && (1e-3..1.0).contains(&size) {
            Prefix { symbol: "m", factor: 1e-3 }
        } else {
            Prefix::of(size, unit)
        };
        if factor != 1.0 || (1e-2..1e5).contains(&size) || size == 0.0 {
            return Self { factor, unit: format!("{symbol}{unit}") };
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
