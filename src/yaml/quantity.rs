//! Quantities: a number with its unit (`5 mm`, `4.24 N s/m`), parsed into SI by the kind that is wanted.
//!
//! All units are powers of ten of SI ones, so the unit only moves the decimal exponent of the text before it is read:
//! `5 mm` and `0.005 m` are the same bits.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

/// What kind of quantity a key wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dimension {
    /// m.
    Length,
    /// kg.
    Mass,
    /// s.
    Time,
    /// N.
    Force,
    /// N s.
    Impulse,
    /// N/m.
    Stiffness,
    /// N s/m.
    Damping,
    /// m/s.
    Velocity,
    /// m/s².
    Acceleration,
    /// rad/s; `Hz` is 2π rad/s.
    AngularFrequency,
    /// Pa.
    Stress,
    /// kg/m³.
    Density,
}

/// What is said of a comma in a number.
pub(crate) const NO_COMMA: &str = "write a decimal point, `30.5`, and thousands without a separator, `30000`";

/// Why a text is not the quantity that is wanted. The message says what is wrong, [`QuantityError::help`] what would be
/// right.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum QuantityError {
    /// No number in front.
    #[error("`{0}` is not a number")]
    NotANumber(String),
    /// `30,5`, or `100,000`.
    #[error("`{0}` has a comma in its number")]
    Comma(String),
    /// NaN, infinite, or beyond the range of floating-point numbers.
    #[error("`{0}` is not a finite number")]
    NotFinite(String),
    /// A number alone where a unit is needed.
    #[error("`{0}` has no unit, but {name} is wanted", name = .1.name())]
    NoUnit(String, Dimension),
    /// A unit where a dimensionless number is wanted.
    #[error("`{0}` has a unit, but a dimensionless number is wanted")]
    NotDimensionless(String),
    /// A symbol that is no unit.
    #[error("`{unit}` is not a unit that is known here")]
    UnknownUnit {
        /// The symbol.
        unit: String,
        /// What is wanted.
        wanted: Option<Dimension>,
    },
    /// A frequency for a column that is not known.
    #[error("`{0}` may stand in a column in rad/s or in one in Hz")]
    WhichFrequency(String),
    /// A unit of another kind than a column's.
    #[error("`{text}` is not in {unit}")]
    NotIn {
        /// As written.
        text: String,
        /// The column's.
        unit: String,
    },
    /// A unit of the wrong kind.
    #[error("`{text}` is not {name}", name = .wanted.name())]
    WrongKind {
        /// As written.
        text: String,
        /// What is wanted.
        wanted: Dimension,
    },
}

impl QuantityError {
    /// What would be right.
    #[must_use]
    pub fn help(&self) -> Option<String> {
        match self {
            Self::NoUnit(_, wanted)
            | Self::WrongKind { wanted, .. }
            | Self::UnknownUnit { wanted: Some(wanted), .. } => Some(format!("write for example {}", wanted.example())),
            Self::NotDimensionless(_) | Self::UnknownUnit { wanted: None, .. } => Some("write the number alone".into()),
            Self::NotIn { unit, .. } => Some(format!("write the number alone, in {unit}, or with a unit of that kind")),
            Self::WhichFrequency(_) => Some("write the number alone, in the unit of its column".into()),
            Self::NotANumber(text) => Some(format!("write the fraction: {}", parse_percent(text)?)),
            Self::Comma(_) => Some(NO_COMMA.into()),
            Self::NotFinite(_) => None,
        }
    }
}

impl Dimension {
    /// With its article, for messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Length => "a length",
            Self::Mass => "a mass",
            Self::Time => "a time",
            Self::Force => "a force",
            Self::Impulse => "an impulse",
            Self::Stiffness => "a stiffness",
            Self::Damping => "a damping constant",
            Self::Velocity => "a velocity",
            Self::Acceleration => "an acceleration",
            Self::AngularFrequency => "an angular frequency",
            Self::Stress => "a modulus",
            Self::Density => "a density",
        }
    }

    /// Symbol of its SI unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Length => "m",
            Self::Mass => "kg",
            Self::Time => "s",
            Self::Force => "N",
            Self::Impulse => "N s",
            Self::Stiffness => "N/m",
            Self::Damping => "N s/m",
            Self::Velocity => "m/s",
            Self::Acceleration => "m/s²",
            Self::AngularFrequency => "rad/s",
            Self::Stress => "Pa",
            Self::Density => "kg/m³",
        }
    }

    /// One that would be accepted.
    #[must_use]
    pub fn example(self) -> &'static str {
        match self {
            Self::Length => "5 mm",
            Self::Mass => "50 g",
            Self::Time => "1 ms",
            Self::Force => "5 N",
            Self::Impulse => "2 N s",
            Self::Stiffness => "1000 N/m",
            Self::Damping => "4.24 N s/m",
            Self::Velocity => "10 mm/s",
            Self::Acceleration => "9.81 m/s^2",
            Self::AngularFrequency => "31.6 rad/s or 5.03 Hz",
            Self::Stress => "200 GPa",
            Self::Density => "7800 kg/m^3",
        }
    }

    fn powers(self) -> Powers {
        let [kilogram, metre, second, angle, cycle] = match self {
            Self::Length => [0, 1, 0, 0, 0],
            Self::Mass => [1, 0, 0, 0, 0],
            Self::Time => [0, 0, 1, 0, 0],
            Self::Force => [1, 1, -2, 0, 0],
            Self::Impulse => [1, 1, -1, 0, 0],
            Self::Stiffness => [1, 0, -2, 0, 0],
            Self::Damping => [1, 0, -1, 0, 0],
            Self::Velocity => [0, 1, -1, 0, 0],
            Self::Acceleration => [0, 1, -2, 0, 0],
            Self::AngularFrequency => [0, 0, -1, 1, 0],
            Self::Stress => [1, -1, -2, 0, 0],
            Self::Density => [1, -3, 0, 0, 0],
        };
        Powers { kilogram, metre, second, angle, cycle }
    }
}

/// Powers of the base units. Radians and cycles count, so that `1/s` is no frequency of either kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Powers {
    kilogram: i32,
    metre: i32,
    second: i32,
    angle: i32,
    cycle: i32,
}

/// Those of cycles a second.
const HERTZ: Powers = Powers { kilogram: 0, metre: 0, second: -1, angle: 0, cycle: 1 };

/// A unit: powers of the base units, and the power of ten that turns it into SI.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Unit {
    powers: Powers,
    ten: i32,
}

/// Reads a number with a unit into SI.
///
/// # Errors
/// [`QuantityError`] in words.
pub fn parse_quantity(text: &str, wanted: Dimension) -> Result<f64, QuantityError> {
    let text = text.trim();
    let (number, unit_text) = split_number(text)?;
    if unit_text.is_empty() {
        number.value(0, text)?;
        return Err(QuantityError::NoUnit(text.into(), wanted));
    }
    let unit = parse_unit(unit_text)
        .map_err(|symbol| QuantityError::UnknownUnit { unit: symbol.into(), wanted: Some(wanted) })?;
    let value = number.value(unit.ten, text)?;
    if unit.powers == wanted.powers() {
        return Ok(value);
    }
    if wanted == Dimension::AngularFrequency && unit.powers == HERTZ {
        return Ok(value * TAU);
    }
    Err(QuantityError::WrongKind { text: text.into(), wanted })
}

/// Why numbers of one unit cannot be shown in another.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum ConversionError {
    /// A symbol that is no unit.
    #[error("`{0}` is not a unit that is known here")]
    Unknown(String),
    /// Of another kind.
    #[error("numbers in {of} cannot be shown in {unit}")]
    OtherKind {
        /// Wanted.
        unit: String,
        /// What there is.
        of: String,
    },
}

/// What one `unit` is in `of`: 0.001 for mm in m, 2π for Hz in rad/s.
pub(crate) fn worth(unit: &str, of: &str) -> Result<f64, ConversionError> {
    let other_kind = || ConversionError::OtherKind { unit: unit.into(), of: of.into() };
    let wanted = parse_unit(unit).map_err(|_| ConversionError::Unknown(unit.into()))?;
    let Unit { powers, ten } = parse_unit(of).map_err(|_| other_kind())?;
    let cycles = powers == Dimension::AngularFrequency.powers() && wanted.powers == HERTZ;
    if wanted.powers != powers && !cycles {
        return Err(other_kind());
    }
    let power_of_ten =
        Decimal { mantissa: "1", exponent: 0 }.value(wanted.ten - ten, unit).map_err(|_| other_kind())?;
    Ok(if cycles { power_of_ten * TAU } else { power_of_ten })
}

/// Reads a number without a unit.
///
/// # Errors
/// [`QuantityError`] in words.
pub fn parse_number(text: &str) -> Result<f64, QuantityError> {
    let text = text.trim();
    let (number, unit) = split_number(text)?;
    let value = number.value(0, text)?;
    match unit {
        "" => Ok(value),
        _ if parse_unit(unit).is_ok() => Err(QuantityError::NotDimensionless(text.into())),
        _ => Err(QuantityError::NotANumber(text.into())),
    }
}

/// Reads a number alone, or with a unit: in `own` where that is known, which may be none, and in SI otherwise.
pub(crate) fn parse_in(text: &str, own: Option<&str>) -> Result<f64, QuantityError> {
    let text = text.trim();
    let (number, unit) = split_number(text)?;
    if unit.is_empty() || own == Some(unit) {
        return number.value(0, text);
    }
    let unknown = |symbol: &str| QuantityError::UnknownUnit { unit: symbol.into(), wanted: None };
    let Unit { powers, ten } = parse_unit(unit).map_err(unknown)?;
    let radians = Dimension::AngularFrequency.powers();
    let not_in = |own: &str| QuantityError::NotIn { text: text.into(), unit: own.into() };
    let wanted = match own {
        Some("") => return Err(QuantityError::NotDimensionless(text.into())),
        Some(own) => parse_unit(own).map_err(|_| not_in(own))?,
        None if [HERTZ, radians].contains(&powers) => return Err(QuantityError::WhichFrequency(text.into())),
        None => Unit { powers, ten: 0 },
    };
    let value = number.value(ten - wanted.ten, text)?;
    match (powers, wanted.powers) {
        (given, wanted) if given == wanted => Ok(value),
        (HERTZ, wanted) if wanted == radians => Ok(value * TAU),
        (given, HERTZ) if given == radians => Ok(value / TAU),
        _ => Err(not_in(own.unwrap_or_default())),
    }
}

/// A number with whatever unit it has, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Amount {
    value: f64,
    powers: Powers,
}

impl Amount {
    /// The same but for what the last digits of a written number round away.
    pub(crate) fn is(&self, other: &Self) -> bool {
        let scale = self.value.abs().max(other.value.abs());
        self.powers == other.powers && (self.value - other.value).abs() <= 1e-9 * scale
    }
}

/// Reads a number with any unit; a noun behind a count (`25 cycles`) is none. Nothing if the text is no number.
pub(crate) fn parse_amount(text: &str) -> Option<Amount> {
    let (number, unit) = split_number(text.trim()).ok()?;
    let Unit { powers, ten } = parse_unit(unit).ok().filter(|_| !unit.is_empty()).unwrap_or_default();
    let value = number.value(ten, text).ok()?;
    Some(match powers {
        Powers { cycle: 1, .. } => Amount { value: value * TAU, powers: Dimension::AngularFrequency.powers() },
        _ => Amount { value, powers },
    })
}

/// A decimal number in parts, so that a unit can move its exponent.
struct Decimal<'t> {
    mantissa: &'t str,
    exponent: i32,
}

impl Decimal<'_> {
    fn value(&self, ten: i32, text: &str) -> Result<f64, QuantityError> {
        let not_finite = || QuantityError::NotFinite(text.into());
        let exponent = self.exponent.checked_add(ten).ok_or_else(not_finite)?;
        let value: f64 = format!("{}e{exponent}", self.mantissa).parse().map_err(|_| not_finite())?;
        let underflow = value == 0.0 && self.mantissa.contains(|c| matches!(c, '1'..='9'));
        // −0 is 0: nobody who writes it means another side.
        if value.is_finite() && !underflow { Ok(value + 0.0) } else { Err(not_finite()) }
    }
}

/// `0.7 %` as a fraction, with the bits of 0.007.
pub(crate) fn parse_percent(text: &str) -> Option<f64> {
    let text = text.trim();
    let (number, unit) = split_number(text).ok()?;
    (unit.trim() == "%").then(|| number.value(-2, text).ok()).flatten()
}

/// The number in front and the rest.
fn split_number(text: &str) -> Result<(Decimal<'_>, &str), QuantityError> {
    let not_a_number = || {
        let bare = text.trim_start_matches(['+', '-']).trim_start_matches('.').to_ascii_lowercase();
        if matches!(bare.as_str(), "nan" | "inf" | "infinity" | "infinite") {
            QuantityError::NotFinite(text.into())
        } else {
            QuantityError::NotANumber(text.into())
        }
    };
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut end = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(end);
    end += whole;
    let mut fraction = 0;
    if bytes.get(end) == Some(&b'.') {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return Err(not_a_number());
    }
    let mantissa = &text[..end];
    let mut exponent = 0;
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let length = digits(end + 1 + sign);
        if length > 0 {
            let written = &text[end + 1..end + 1 + sign + length];
            exponent = written.parse().map_err(|_| QuantityError::NotFinite(text.into()))?;
            end += 1 + sign + length;
        }
    }
    let rest = text[end..].trim_start();
    if rest.strip_prefix(',').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) {
        return Err(QuantityError::Comma(text.into()));
    }
    Ok((Decimal { mantissa, exponent }, rest))
}

/// `N s/m`, `m/s^2`, `kg*m/s`: factors, at most one slash. The error is the symbol that is not known.
fn parse_unit(text: &str) -> Result<Unit, &str> {
    let (above, below) = match text.split_once('/') {
        Some((above, below)) => (above, Some(below)),
        None => (text, None),
    };
    let mut unit = Unit::default();
    multiply(&mut unit, above, 1).map_err(|()| text)?;
    if let Some(below) = below {
        multiply(&mut unit, below, -1).map_err(|()| text)?;
    }
    Ok(unit)
}

fn multiply(unit: &mut Unit, factors: &str, sign: i32) -> Result<(), ()> {
    let mut any = false;
    for factor in factors.split([' ', '*', '·']).filter(|factor| !factor.is_empty()) {
        let (symbol, power) = match factor.split_once('^') {
            Some((symbol, power)) => (symbol, power.parse::<i32>().ok().filter(|p| p.abs() <= 4).ok_or(())?),
            None if factor.ends_with('²') => (factor.trim_end_matches('²'), 2),
            None if factor.ends_with('³') => (factor.trim_end_matches('³'), 3),
            None => (factor, 1),
        };
        let base = symbol_unit(symbol).ok_or(())?;
        let power = power * sign;
        unit.ten += base.ten * power;
        unit.powers.kilogram += base.powers.kilogram * power;
        unit.powers.metre += base.powers.metre * power;
        unit.powers.second += base.powers.second * power;
        unit.powers.angle += base.powers.angle * power;
        unit.powers.cycle += base.powers.cycle * power;
        any = true;
    }
    if any { Ok(()) } else { Err(()) }
}

fn symbol_unit(symbol: &str) -> Option<Unit> {
    let base = |symbol: &str| {
        let powers = Powers::default();
        Some(match symbol {
            "m" => Unit { powers: Powers { metre: 1, ..powers }, ten: 0 },
            "g" => Unit { powers: Powers { kilogram: 1, ..powers }, ten: -3 },
            "s" => Unit { powers: Powers { second: 1, ..powers }, ten: 0 },
            "N" => Unit { powers: Dimension::Force.powers(), ten: 0 },
            "Pa" => Unit { powers: Dimension::Stress.powers(), ten: 0 },
            "Hz" => Unit { powers: HERTZ, ten: 0 },
            "rad" => Unit { powers: Powers { angle: 1, ..powers }, ten: 0 },
            _ => return None,
        })
    };
    if let Some(unit) = base(symbol) {
        return Some(unit);
    }
    let prefix = symbol.chars().next()?;
    let ten = match prefix {
        'n' => -9,
        'u' | 'µ' | 'μ' => -6,
        'm' => -3,
        'c' => -2,
        'k' => 3,
        'M' => 6,
        'G' => 9,
        _ => return None,
    };
    base(&symbol[prefix.len_utf8()..]).map(|unit| Unit { ten: unit.ten + ten, ..unit })
}
