//! Texts with placeholders in braces.

/// A part of such a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part<'t> {
    /// As it is.
    Text(&'t str),
    /// What stands between two braces.
    Placeholder(&'t str),
}

/// A text that cannot be taken apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("an opening `{{` without its `}}`")]
pub struct Unclosed;

/// The text in its parts.
///
/// # Errors
/// [`Unclosed`] if a brace is opened and not closed.
pub fn parts(text: &str) -> Result<Vec<Part<'_>>, Unclosed> {
    let mut parts = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        let (inner, behind) = after.split_once('}').ok_or(Unclosed)?;
        parts.extend([Part::Text(before), Part::Placeholder(inner)]);
        rest = behind;
    }
    parts.push(Part::Text(rest));
    Ok(parts)
}
