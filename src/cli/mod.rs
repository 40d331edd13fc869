//! The command. One thin file a subcommand; what they share is how a study is found, chosen from and reported on.

mod args;
mod calibrate;
mod check;
mod error;
mod exit;
mod explain;
mod list;
mod output;
mod select;
mod show;
mod status;
mod update;

use std::process::ExitCode;

use clap::Parser;

use args::{Args, Command};
use error::CliError;
use exit::Exit;

/// Reads the arguments, does what they say, and returns the exit code: 0 all as expected, 1 some verdict is not, 2 something
/// could not run, is missing, or was asked for wrongly.
#[must_use]
pub fn main() -> ExitCode {
    match dispatch(&Args::parse()) {
        Ok(exit) => exit.into(),
        // Whoever closed the pipe has read enough.
        Err(error) if error.is_broken_pipe() => ExitCode::SUCCESS,
        Err(error) => {
            output::complain(&format!("error: {error}\n"));
            Exit::CouldNot.into()
        }
    }
}

fn dispatch(args: &Args) -> Result<Exit, CliError> {
    let layout = select::layout(args.root.as_deref())?;
    match &args.command {
        None => update::update(&layout, &args::RunArgs::default()),
        Some(Command::Run(run)) => update::update(&layout, run),
        Some(Command::List) => list::list(&layout),
        Some(Command::Show { id }) => show::show(&layout, id),
        Some(Command::Status(status)) => status::status(&layout, status),
        Some(Command::Check(check)) => check::check(&layout, check),
        Some(Command::Calibrate(args)) => calibrate::calibrate(&layout, args),
        Some(Command::Explain { entry }) => explain::explain(&layout, entry),
    }
}
