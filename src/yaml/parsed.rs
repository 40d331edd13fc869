//! A text, read by whatever reader it is for.

use super::at::At;
use super::diagnostic::{Findings, Problems};
use super::node::read_tree;

/// What `reader` makes of a text; `file` only names it in messages.
///
/// # Errors
/// Every mistake of the text, with its place.
pub(crate) fn parsed<T>(file: &str, text: &str, reader: impl FnOnce(At<'_>) -> Option<T>) -> Result<T, Problems> {
    let findings = Findings::default();
    let value = read_tree(text, &findings).and_then(|root| reader(At::Node(&root, &findings)));
    findings.finish(file, text, value)
}
