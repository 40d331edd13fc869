//! Output: standard output for answers, standard error for errors, colours on a terminal.

use std::io::{self, IsTerminal, Write};
use std::sync::OnceLock;

use super::error::CliError;
use crate::study::Refused;
use crate::yaml::Problems;

/// When to use colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Colour {
    Auto,
    Always,
    Never,
}

/// How this process prints; set once, from its arguments.
#[derive(Debug, Clone, Copy)]
struct Style {
    quiet: bool,
    /// On standard error.
    colour: bool,
}

static STYLE: OnceLock<Style> = OnceLock::new();

/// Sets how this process prints.
pub(super) fn set_style(quiet: bool, colour: Colour) {
    let _ = STYLE.set(Style { quiet, colour: wants_colour(colour) });
}

fn style() -> Style {
    *STYLE.get_or_init(|| Style { quiet: false, colour: wants_colour(Colour::Auto) })
}

/// True if errors are to be coloured: as asked for, or on a terminal that can, unless `NO_COLOR` is set.
fn wants_colour(colour: Colour) -> bool {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    match colour {
        Colour::Always => true,
        Colour::Never => false,
        Colour::Auto => {
            io::stderr().is_terminal() && set("NO_COLOR").is_none() && set("TERM").is_none_or(|term| term != "dumb")
        }
    }
}

/// Prints the answer, unless nothing but errors is wanted.
pub(super) fn print(text: &str) -> io::Result<()> {
    if style().quiet { Ok(()) } else { print_document(text) }
}

/// Prints a document that was asked for by name, which is never left out. A reader who closes the pipe has read enough: the command goes
/// on to its exit code, which is no less true for that.
pub(super) fn print_document(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// Prints an error. A failure to print it is ignored.
pub(super) fn print_error(text: &str) {
    let text = match text.strip_prefix("error:") {
        Some(rest) if style().colour => format!("\u{1b}[1;31merror:\u{1b}[0m{rest}"),
        _ => text.to_owned(),
    };
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Prints how far a command is, unless nothing but errors is wanted.
pub(super) fn print_progress(text: &str) {
    if !style().quiet {
        print_error(text);
    }
}

/// Prints the errors of files that could not be used, with their places; framed on a terminal.
pub(super) fn print_unread<'a>(unread: impl IntoIterator<Item = &'a Refused>) {
    for one in unread {
        match one.problems() {
            Some(problems) => print_problems(problems),
            None => print_error(&format!("error: {one}\n")),
        }
    }
}

/// Prints why a command could not do its work.
pub(super) fn print_failure(error: &CliError) {
    match error {
        // They bring their own head.
        CliError::Text(problems) => print_problems(problems),
        other => print_error(&format!("error: {other}\n")),
    }
}

fn print_problems(problems: &Problems) {
    let colour = style().colour;
    let framed = colour || io::stderr().is_terminal();
    print_error(&if framed { problems.fancy(colour) } else { problems.to_string() });
}

/// Prints warnings, unless nothing but errors is wanted; framed on a terminal.
pub(super) fn print_warnings(warnings: Option<&Problems>) {
    if let Some(warnings) = warnings.filter(|_| !style().quiet) {
        print_problems(warnings);
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
