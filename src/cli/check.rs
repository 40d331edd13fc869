//! `shotdamp check`.

use super::args::CheckArgs;
use super::error::CliError;
use super::exit::Exit;
use super::output::{complain, complain_of, print};
use super::select::{choose, open};
use crate::publish::{judge_all, self_test_all, summary};
use crate::study::Layout;

/// The verdicts, from the tables on disk.
pub(super) fn check(layout: &Layout, args: &CheckArgs) -> Result<Exit, CliError> {
    let opened = open(layout)?;
    let chosen = choose(&opened, &args.choice)?;
    complain_of(chosen.unread.iter().copied());
    let judgement = judge_all(&opened);
    let mut exit = chosen.exit(&judgement);
    let mut text = summary(&judgement, &chosen.ids);
    if args.self_test {
        let ids: Vec<&str> = chosen.ids.iter().copied().collect();
        let failures = self_test_all(&opened, &ids);
        for failure in &failures {
            exit = exit.max(Exit::Unexpected);
            complain(&format!("error: {} cannot fail: {}\n", failure.id, failure.reason));
        }
        let entries: usize =
            ids.iter().filter_map(|id| opened.references.get(*id)).map(|file| file.entries.len()).sum();
        text += &format!("self-test: {} of {entries} entries can fail\n", entries - failures.len());
    }
    print(&text)?;
    Ok(exit)
}
