//! Numbers as text. `{}` of an `f64` never uses an exponent and knows no significant digits, so this file does:
//! 1.2e-14, 0.0123, 1 234.

/// Between digit groups: a narrow no-break space.
const GROUP: char = '\u{202f}';
const MINUS: char = '−';

/// `value` rounded to `digits` significant digits, trailing zeros kept: 0.5 to three digits is `0.500`.
///
/// Plain notation from 0.0001 up to a million, digit groups from 1000 on; an exponent outside. NaN is `n/a`.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    match Decimal::round(value, digits) {
        Ok(decimal) => decimal.render(),
        Err(word) => word.to_owned(),
    }
}

/// As [`significant`], without trailing zeros: 0.5 is `0.5`, 50 is `50`.
#[must_use]
pub fn compact(value: f64, digits: usize) -> String {
    match Decimal::round(value, digits) {
        Ok(decimal) => decimal.trimmed().render(),
        Err(word) => word.to_owned(),
    }
}

/// A count with all its digits, in groups.
#[must_use]
pub fn count(number: u64) -> String {
    let mut text = String::new();
    push_grouped(&mut text, &number.to_string());
    text
}

/// As [`significant`], with the sign written in front of positive numbers too.
#[must_use]
pub fn signed(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    if value > 0.0 { format!("+{text}") } else { text }
}

/// A value and its uncertainty: two digits of the uncertainty, and the value stops where they stop, but keeps two of its own:
/// `628` and `65`, `3.6` and `10`.
#[must_use]
pub fn with_uncertainty(value: f64, uncertainty: f64) -> (String, String) {
    let size = |x: f64| libm::floor(libm::log10(x.abs()));
    let digits = size(value) - (size(uncertainty) - 1.0) + 1.0;
    // Zero, NaN and infinity have no place of a last digit; an exact value needs no more digits than any other.
    let digits = if digits.is_finite() { digits.clamp(2.0, 7.0) } else { 2.0 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 2 to 7")]
    let digits = digits as usize;
    (significant(value, digits), significant(uncertainty, 2))
}

/// A number with its unit, the prefix chosen so that one to three digits stand before the point: `10 µs`, `60 mm`.
/// Units that take no prefix (`N s/m`) are written as they are; an empty unit gives the bare number.
#[must_use]
pub fn quantity(value: f64, unit: &str, digits: usize) -> String {
    let prefix = Prefix::of(value, unit);
    let number = compact(value / prefix.factor, digits);
    if unit.is_empty() { number } else { format!("{number} {}{unit}", prefix.symbol) }
}

/// An SI prefix with its factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prefix {
    /// `m`, `µ`; empty for the unit itself.
    pub symbol: &'static str,
    /// What the prefixed unit is worth in the unit itself.
    pub factor: f64,
}

impl Prefix {
    const NONE: Self = Self { symbol: "", factor: 1.0 };

    /// The prefix that suits numbers of the size of `value` in `unit`; only lengths and times take one.
    #[must_use]
    pub fn of(value: f64, unit: &str) -> Self {
        const SMALL: [Prefix; 3] = [
            Prefix { symbol: "m", factor: 1e-3 },
            Prefix { symbol: "µ", factor: 1e-6 },
            Prefix { symbol: "n", factor: 1e-9 },
        ];
        let size = value.abs();
        if !matches!(unit, "m" | "s") || !(1e-12..1.0).contains(&size) {
            return Self::NONE;
        }
        // A hair below the factor still counts, so that 1e-3 s written in binary is 1 ms and not 1000 µs.
        SMALL.into_iter().find(|prefix| size >= prefix.factor * (1.0 - 1e-12)).unwrap_or(SMALL[2])
    }
}

/// ±d.ddd × 10^exponent, rounded.
struct Decimal {
    negative: bool,
    digits: String,
    exponent: i32,
}

impl Decimal {
    /// The rounded number, or the word for one that has no digits.
    fn round(value: f64, digits: usize) -> Result<Self, &'static str> {
        if value.is_nan() {
            return Err("n/a");
        }
        if value.is_infinite() {
            return Err(if value > 0.0 { "∞" } else { "−∞" });
        }
        if value == 0.0 {
            return Err("0");
        }
        // `{:e}` rounds correctly and always has the form d.ddde[-]x.
        let text = format!("{:.*e}", digits.max(1) - 1, value.abs());
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        Ok(Self {
            negative: value < 0.0,
            digits: mantissa.chars().filter(char::is_ascii_digit).collect(),
            exponent: exponent.parse().unwrap_or(0),
        })
    }

    fn trimmed(mut self) -> Self {
        let kept = self.digits.trim_end_matches('0').len().max(1);
        self.digits.truncate(kept);
        self
    }

    fn render(&self) -> String {
        let mut text = String::new();
        if self.negative {
            text.push(MINUS);
        }
        match self.exponent {
            0..6 => {
                let whole = usize::try_from(self.exponent).unwrap_or(0) + 1;
                let padded = format!("{:0<whole$}", self.digits);
                let (before, after) = padded.split_at(whole);
                push_grouped(&mut text, before);
                push_fraction(&mut text, after);
            }
            -4..0 => {
                let zeros = usize::try_from(-self.exponent - 1).unwrap_or(0);
                text.push('0');
                push_fraction(&mut text, &format!("{}{}", "0".repeat(zeros), self.digits));
            }
            _ => {
                let (before, after) = self.digits.split_at(1);
                text.push_str(before);
                push_fraction(&mut text, after);
                text.push_str(&format!("e{}", self.exponent));
            }
        }
        text
    }
}

fn push_fraction(text: &mut String, digits: &str) {
    if !digits.is_empty() {
        text.push('.');
        text.push_str(digits);
    }
}

fn push_grouped(text: &mut String, digits: &str) {
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(GROUP);
        }
        text.push(digit);
    }
}
