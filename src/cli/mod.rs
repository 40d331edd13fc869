//! The command: one file a subcommand, and what they share: finding a study, choosing experiments, printing.

mod accuracy;
mod args;
mod calibrate;
mod check;
mod clean;
mod destination;
mod diff;
mod dry_run;
mod effects;
mod error;
mod exit;
mod explain;
mod export;
mod gather;
mod interrupt;
mod list;
mod new;
mod output;
mod report;
mod schema;
mod select;
mod shard;
mod show;
mod simulate;
mod status;
mod thresholds;
mod update;

use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser};

use args::{Args, Command};
use error::CliError;
use exit::Exit;
use interrupt::Kept;

use crate::dynamics::is_interrupted;

/// Reads the arguments, does what they say, and returns the exit code: 0 all as expected, 1 some verdict is not, 2 something
/// could not run, is missing, or was asked for wrongly; 130 interrupted.
#[must_use]
pub fn main() -> ExitCode {
    let mut args = Args::try_parse().unwrap_or_else(|error| with_tip(error).exit());
    output::set_style(args.quiet, args.color);
    let outcome = dispatch(&mut args);
    if is_interrupted() {
        interrupt::end();
    }
    match outcome {
        Ok(exit) => exit.into(),
        Err(error) => {
            output::print_failure(&error);
            Exit::CouldNot.into()
        }
    }
}

/// Who names an experiment where a command belongs is told what to write. No command has a `-` or a digit in its name.
fn with_tip(mut error: clap::Error) -> clap::Error {
    let is_near_command = error.get(ContextKind::SuggestedSubcommand).is_some();
    if let (ErrorKind::InvalidSubcommand, Some(ContextValue::String(word))) =
        (error.kind(), error.get(ContextKind::InvalidSubcommand))
        && !word.contains('/')
        && (!is_near_command || word.contains(|one: char| one == '-' || one.is_ascii_digit()))
    {
        let tip = format!("to simulate an experiment, write `shotdamp run {word}`");
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    error
}

fn dispatch(args: &mut Args) -> Result<Exit, CliError> {
    match &args.command {
        // What needs no study.
        Some(Command::Completions { shell }) => return completions(*shell),
        Some(Command::Schema(args::SchemaArgs { of: Some(of) })) => {
            let layout = match select::layout(args.root.as_deref()) {
                // Asked for outside of every study, which is no mistake.
                Err(CliError::NoStudy(_)) => None,
                found => Some(found?),
            };
            return schema::print_one(layout.as_ref(), *of);
        }
        _ => {}
    }
    let layout = select::layout(args.root.as_deref())?;
    if let Some(command) = &mut args.command {
        select::name_files(&layout, command);
    }
    let args = &*args;
    if let Some(kept) = Kept::by(args.command.as_ref()) {
        interrupt::listen(kept);
    }
    match &args.command {
        None => update::update(&layout, &args::RunArgs::default(), args),
        Some(Command::Run(run)) => match run.shard {
            Some(shard) => shard::run_shard(&layout, run, shard, args),
            None => update::update(&layout, run, args),
        },
        Some(Command::Report(report)) => {
            start_threads(args);
            report::report(&layout, report)
        }
        Some(Command::Export(export)) => export::export(&layout, export),
        Some(Command::Gather(gather)) => {
            start_threads(args);
            gather::gather_all(&layout, gather)
        }
        Some(Command::List) => list::list(&layout),
        Some(Command::Show { id }) => show::show(&layout, id),
        Some(Command::Effects { id, limit }) => effects::effects(&layout, id, limit),
        Some(Command::Status(status)) => status::status(&layout, status),
        Some(Command::Check(check)) => {
            start_threads(args);
            check::check(&layout, check)
        }
        Some(Command::Diff(diff)) => diff::diff(&layout, diff),
        Some(Command::Clean(clean)) => clean::clean(&layout, clean),
        Some(Command::New(new)) => new::new(&layout, new),
        Some(Command::Schema(_)) => schema::write(&layout),
        Some(Command::Completions { shell }) => completions(*shell),
        Some(Command::Accuracy(accuracy)) => {
            start_threads(args);
            accuracy::measure(&layout, accuracy)
        }
        Some(Command::Calibrate(calibrate)) => calibrate::calibrate(&layout, calibrate, args),
        Some(Command::Explain { entry, run: false, .. }) => explain::explain(&layout, entry, None, args),
        Some(Command::Explain { entry, run: true, limit }) => explain::explain(&layout, entry, Some(limit), args),
    }
}

/// Sets the number of threads of the shared pool; one that is running stays as it is.
fn start_threads(args: &Args) {
    let _ = rayon::ThreadPoolBuilder::new().num_threads(args.threads()).build_global();
}

fn completions(shell: clap_complete::Shell) -> Result<Exit, CliError> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Args::command(), "shotdamp", &mut text);
    output::print_document(&String::from_utf8_lossy(&text))?;
    Ok(Exit::AsExpected)
}
