//! `shotdamp explain ENTRY`.

use super::error::CliError;
use super::exit::Exit;
use super::output::{complain_of, print};
use super::select::{matches, open};
use crate::publish::{explanations, judge_all};
use crate::study::Layout;

/// How sensitive entries are to each assumption, from the tables on disk.
pub(super) fn explain(layout: &Layout, pattern: &str) -> Result<Exit, CliError> {
    let opened = open(layout)?;
    complain_of(&opened.unread);
    let texts = explanations(&opened, &judge_all(&opened), |id| matches(pattern, id));
    if texts.is_empty() {
        return Err(CliError::NoEntry(pattern.into()));
    }
    print(&texts.join("\n"))?;
    Ok(if opened.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}
