//! `--dry-run`: what would be simulated, and how long that would take, estimated from earlier runs.

use super::args::{Args, RunArgs};
use super::error::CliError;
use super::exit::Exit;
use super::output::{print, print_error, print_unread};
use super::select::{Found, choose};
use super::thresholds;
use crate::study::{Extent, KnownRows, Layout, forecast, simulations};
use crate::text::number::{self, compact};
use crate::text::words::{capitalised, counted};

/// Prints it, and writes nothing.
pub(super) fn dry_run(layout: &Layout, found: Found, args: &RunArgs, common: &Args) -> Result<Exit, CliError> {
    let study = found.open(layout, &args.choice, args.reads_all());
    let chosen = choose(&study, &args.choice)?;
    print_unread(chosen.unread.iter().copied());
    let threads = common.workers();
    let (mut text, mut total) = (String::new(), Total::default());
    for item in chosen.todo(args.force) {
        let known = if args.force { KnownRows::nothing() } else { KnownRows::of(layout, item) };
        let extent = item.extent(layout, &known);
        text += &format!("{}: {}", item.source.experiment.id, rows(&extent));
        if extent.to_do > 0 {
            let ahead = wall(&extent, threads).map_or_else(|| "time not known".into(), about);
            text += &format!(", {} at most, {ahead}", simulations(extent.simulations));
        }
        text += "\n";
        if extent.to_do > 0 {
            for warning in forecast(&item.source.experiment, &study.sheet.assumptions()) {
                text += &format!("  warning: {warning}\n");
            }
            text += &thresholds::with_cases_in_words(&study, &item.source.experiment);
        }
        total.add(&extent, threads);
    }
    if chosen.count() > 0 {
        text += &format!(
            "{} of {} would be simulated{}\n",
            total.simulated,
            counted(chosen.count(), "experiment", "experiments"),
            total.rest()
        );
    }
    if let Some(ahead) = total.time(threads) {
        text += &format!("{ahead} on {}\n", counted(threads, "thread", "threads"));
    }
    print(&text)?;
    print_error(&chosen.left_out());
    Ok(if chosen.unread.is_empty() { Exit::AsExpected } else { Exit::CouldNot })
}

/// How many of the rows would be simulated.
pub(super) fn rows(extent: &Extent) -> String {
    let Extent { to_do, rows, open, .. } = *extent;
    let [to_do_shown, rows_shown] = [to_do, rows].map(|rows| number::count(rows as u64));
    match (to_do, open) {
        (0, _) => format!("none of {rows_shown} rows to simulate: earlier tables have them"),
        (_, true) => format!("{to_do_shown} of {rows_shown} rows to simulate, and those that follow where curves bend"),
        (_, false) => format!("{to_do_shown} of {rows_shown} rows to simulate"),
    }
}

/// Wall time, s.
fn wall(extent: &Extent, threads: usize) -> Option<f64> {
    let at_once = u64::try_from(threads).unwrap_or(u64::MAX).min(extent.simulations).max(1);
    extent.seconds.map(|seconds| seconds / at_once as f64)
}

fn about(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => "less than 0.1 s".into(),
        s if s < 100.0 => format!("about {} s", compact(s, 2)),
        s if s < 6000.0 => format!("about {} min", compact(s / 60.0, 2)),
        s => format!("about {} h", compact(s / 3600.0, 2)),
    }
}

/// All experiments together.
#[derive(Default)]
struct Total {
    simulated: usize,
    restored: usize,
    /// Experiments of which no time is known.
    unknown: usize,
    /// Processor time of the others, s.
    seconds: f64,
    /// The longest of them, s.
    longest: f64,
}

impl Total {
    fn add(&mut self, extent: &Extent, threads: usize) {
        if extent.to_do == 0 {
            self.restored += 1;
            return;
        }
        self.simulated += 1;
        self.unknown += usize::from(extent.seconds.is_none());
        self.seconds += extent.seconds.unwrap_or(0.0);
        self.longest = self.longest.max(wall(extent, threads).unwrap_or(0.0));
    }

    fn rest(&self) -> String {
        if self.restored == 0 { String::new() } else { format!(", {} restored", self.restored) }
    }

    /// `None` if there is nothing to simulate, or nothing known of it.
    fn time(&self, threads: usize) -> Option<String> {
        if self.unknown == self.simulated {
            return None;
        }
        let all = capitalised(&about((self.seconds / threads as f64).max(self.longest)));
        Some(match self.unknown {
            0 => all,
            unknown => {
                let others = counted(unknown, "experiment", "experiments");
                format!("{all}, and {others} of which no time is known,")
            }
        })
    }
}
