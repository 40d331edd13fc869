//! What is no mistake and yet hardly meant: assumptions that no experiment uses.

use super::layout::ASSUMPTIONS;
use super::open::Study;
use super::snapshot::Snapshot;
use super::texts::Texts;
use crate::experiment::{AssumptionName, AssumptionSheet, parse_assumptions};
use crate::text::utf8::decode;
use crate::yaml::Problems;

impl Study {
    /// Warnings, with their places. A file that cannot be read may use what no other does: then there are none.
    #[must_use]
    pub fn warnings(&self) -> Option<Problems> {
        let is_used = |name: &AssumptionName| {
            self.items.iter().any(|item| item.used.contains(name))
                || self.known.values().any(|known| known.used.contains(name))
        };
        let all_read = self.unread.iter().all(|one| !one.file().starts_with("experiments/"));
        if all_read { unused(&self.texts, &self.sheet, is_used) } else { None }
    }
}

impl Snapshot {
    /// The same of a study that is up to date.
    #[must_use]
    pub fn warnings(&self, texts: &Texts) -> Option<Problems> {
        if self.unused.is_empty() {
            return None;
        }
        let text = decode(texts.bytes(ASSUMPTIONS)?).ok()?;
        let sheet = parse_assumptions(ASSUMPTIONS, text).ok()?;
        unused(texts, &sheet, |name| !self.unused.contains(name))
    }
}

fn unused(texts: &Texts, sheet: &AssumptionSheet, is_used: impl Fn(&AssumptionName) -> bool) -> Option<Problems> {
    let text = texts.bytes(ASSUMPTIONS).map(|bytes| String::from_utf8_lossy(bytes)).unwrap_or_default();
    sheet.unused(ASSUMPTIONS, &text, is_used)
}
