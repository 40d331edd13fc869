//! What a command says, and where.

use std::io::{self, IsTerminal, Write};

use crate::publish::Unread;
use crate::study::Refused;

/// Prints the answer.
pub(super) fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Tells of something wrong. Nobody is left to tell if that fails.
pub(super) fn complain(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Tells of files that could not be used, with their places; framed for a person at a terminal.
pub(super) fn complain_of<'a>(unread: impl IntoIterator<Item = &'a Unread>) {
    for one in unread {
        match one {
            Unread::Experiment(Refused::Text(problems)) if io::stderr().is_terminal() => {
                complain(&problems.fancy(true));
            }
            Unread::Experiment(Refused::Text(problems)) => complain(&problems.to_string()),
            other => complain(&format!("error: {other}\n")),
        }
    }
}

/// A table of text without lines: columns as wide as they need to be.
pub(super) fn columns(rows: &[Vec<String>]) -> String {
    let width = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, cell) in row.iter().enumerate() {
            let pad = width(column).unwrap_or(0) - cell.chars().count();
            line += &format!("{cell}{}  ", " ".repeat(pad));
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}
