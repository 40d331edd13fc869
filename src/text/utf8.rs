//! Bytes to text, or the place of the first byte that is none.

/// Bytes that are not UTF-8.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("not UTF-8 text: line {line}, column {column} holds the byte 0x{byte:02x}; save the file as UTF-8")]
pub struct NotUtf8 {
    /// Line of the first bad byte, from 1.
    pub line: usize,
    /// Its column in characters, from 1.
    pub column: usize,
    /// The byte.
    pub byte: u8,
}

/// The text of these bytes.
///
/// # Errors
/// [`NotUtf8`] with the place of the first byte that belongs to no character.
pub fn decode(bytes: &[u8]) -> Result<&str, NotUtf8> {
    std::str::from_utf8(bytes).map_err(|error| {
        let (sound, rest) = bytes.split_at(error.valid_up_to());
        let sound = std::str::from_utf8(sound).unwrap_or_default();
        let last = sound.rsplit('\n').next().unwrap_or_default();
        NotUtf8 {
            line: sound.matches('\n').count() + 1,
            column: last.chars().count() + 1,
            byte: rest.first().copied().unwrap_or_default(),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_bad_byte_is_named() {
        assert_eq!(decode("a: µ\n".as_bytes()), Ok("a: µ\n"));
        assert_eq!(decode(b"a: 1\nb: \xc2\xb5\xff"), Err(NotUtf8 { line: 2, column: 5, byte: 0xff }));
        // Half of a character at the end.
        assert_eq!(decode(b"\xe2\x82"), Err(NotUtf8 { line: 1, column: 1, byte: 0xe2 }));
    }
}
