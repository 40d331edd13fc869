//! YAML straight into a type that derives `Deserialize`, for files that need no units and no tree of nodes.

use serde::de::DeserializeOwned;

/// A value and the line on which it starts.
pub(crate) type Spanned<T> = serde_yaml::Spanned<T>;

/// A mistake in a YAML text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct Located {
    /// Counted from 1; 0 if the text as a whole is meant.
    pub line: u64,
    /// Counted from 1.
    pub column: u64,
    /// What is wrong, and what would be right.
    pub message: String,
}

/// The line and column at which a spanned value starts.
pub(crate) fn position<T>(spanned: &Spanned<T>) -> (u64, u64) {
    (spanned.referenced.line(), spanned.referenced.column())
}

/// Reads one document. Unknown keys are mistakes where the type denies them; doubled keys, merge keys, alias bombs and
/// deep nesting always are.
///
/// # Errors
/// The first mistake, with its place.
pub fn from_yaml<T: DeserializeOwned>(text: &str) -> Result<T, Located> {
    let mut options = serde_yaml::Options::default();
    options.strict_booleans = true;
    options.with_snippet = false;
    options.merge_keys = serde_yaml::options::MergeKeyPolicy::Error;
    serde_yaml::from_str_with_options(text, options).map_err(|error| {
        let (line, column) = error.location().map_or((0, 0), |place| (place.line(), place.column()));
        let message = error.without_snippet().to_string();
        // The crate ends its messages with the place, which the caller shows in front.
        let message = match message.rfind(" at line ").or_else(|| message.rfind(" (line ")) {
            Some(end) => message[..end].to_string(),
            None => message,
        };
        Located { line, column, message }
    })
}
