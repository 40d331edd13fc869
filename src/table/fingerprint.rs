//! What a row was computed from, as a hash: the numbers of rows of one fingerprint are the same to the last bit.

use std::fmt;

/// Digits of one in text.
const DIGITS: usize = 32;

/// 128 bits of a blake3 hash; what goes into it is for those to say who compute rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct RowFingerprint([u8; DIGITS / 2]);

impl RowFingerprint {
    /// The first half of a hash.
    #[must_use]
    pub fn of(hash: blake3::Hash) -> Self {
        let mut half = [0; DIGITS / 2];
        half.copy_from_slice(&hash.as_bytes()[..DIGITS / 2]);
        Self(half)
    }
}

impl fmt::Display for RowFingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// All of them in hexadecimal, nothing in between.
pub(super) fn to_text(fingerprints: &[RowFingerprint]) -> String {
    fingerprints.iter().map(ToString::to_string).collect()
}

/// What [`to_text`] wrote; `None` for any other text.
pub(super) fn from_text(text: &str) -> Option<Vec<RowFingerprint>> {
    let one = |digits: &[u8]| {
        let mut bytes = [0; DIGITS / 2];
        for (byte, pair) in bytes.iter_mut().zip(digits.chunks(2)) {
            *byte = u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()?;
        }
        Some(RowFingerprint(bytes))
    };
    let whole = text.len().is_multiple_of(DIGITS);
    whole.then(|| text.as_bytes().chunks(DIGITS).map(one).collect()).flatten()
}
