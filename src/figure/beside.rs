//! What figures draw beside the table.

use std::collections::BTreeMap;

use super::quoted::Quoted;
use crate::experiment::LineColour;

/// What is drawn beside the table.
#[derive(Debug, Clone, Copy, Default)]
pub struct Beside<'a> {
    /// What the study's text quotes.
    pub quoted: &'a [Quoted],
    /// Period of the impulses, s: a time history with contacts shows their moments.
    pub impulses: Option<f64>,
    /// Colours of lines by name, as the study has them.
    pub colours: Option<&'a BTreeMap<String, LineColour>>,
}
