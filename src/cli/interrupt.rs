//! Ctrl-C, or SIGTERM from a scheduler, or SIGHUP from a terminal that closes: simulations end at their next look at the clock,
//! what they have is kept, and the last line says so.
//!
//! A computation that looks at no clock, such as the decomposition of a large matrix, is not waited for: the process ends
//! within a second of the signal whatever its threads are at. What is waited for is the writing of finished rows. Files are written
//! whole or not at all.

use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGINT, SIGTERM};

use super::args::Command;
use super::output::print_error;
use crate::dynamics::interrupt;
use crate::study::is_keeping_rows;

/// How often the signal is looked for.
const LOOK: Duration = Duration::from_millis(20);
/// How long the threads have to end and to write what they have.
const GRACE: Duration = Duration::from_millis(700);
/// How long finished rows may take to be written; a disk that hangs is not waited for any longer.
const LONGEST_WRITE: Duration = Duration::from_secs(60);
/// 128 + SIGINT, as a shell reports a program that was interrupted; of the other signals, too: what is left is the same.
const EXIT_CODE: i32 = 130;

/// What is left of a command that was interrupted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kept {
    /// Rows of tables.
    Rows,
    /// The same, of a command that computes all of them anew.
    ForcedRows,
    /// Pages of the experiments that were done.
    Pages,
    /// What a calibration evaluated.
    Evaluations,
    /// What was printed.
    Printed,
}

impl Kept {
    /// By a command that simulates; the others are ended by the system.
    pub(super) fn by(command: Option<&Command>) -> Option<Self> {
        match command {
            Some(Command::Run(run)) if run.force => Some(Self::ForcedRows),
            None | Some(Command::Run(_)) => Some(Self::Rows),
            Some(Command::Accuracy(_)) => Some(Self::Pages),
            Some(Command::Calibrate(_)) => Some(Self::Evaluations),
            Some(Command::Effects { .. } | Command::Explain { run: true, .. }) => Some(Self::Printed),
            _ => None,
        }
    }

    fn line(self) -> &'static str {
        match self {
            Self::Rows => "interrupted: finished rows are kept, and the same command continues from them\n",
            Self::ForcedRows => {
                "interrupted: finished tables are written, finished rows are kept for a run without --force; the same command begins anew\n"
            }
            Self::Pages => "interrupted: the pages of finished experiments are written, all others are as before\n",
            Self::Evaluations => {
                "interrupted: no page was written; what was evaluated is kept, and the same command continues from there\n"
            }
            Self::Printed => "interrupted: what is printed is all that was finished; nothing was written\n",
        }
    }
}

static KEPT: OnceLock<Kept> = OnceLock::new();

/// The signals that ask a command to end.
fn signals() -> Vec<i32> {
    let mut signals = vec![SIGINT, SIGTERM];
    #[cfg(unix)]
    if !outlives_terminal() {
        signals.push(signal_hook::consts::SIGHUP);
    }
    signals
}

/// True under `nohup`, which sets SIGHUP to be ignored, and where that cannot be known: hearing the signal would undo it.
#[cfg(unix)]
fn outlives_terminal() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_none_or(|mask| mask >> (signal_hook::consts::SIGHUP - 1) & 1 == 1)
}

/// Listens for these signals from now on.
pub(super) fn listen(kept: Kept) {
    let _ = KEPT.set(kept);
    let asked = Arc::new(AtomicBool::new(false));
    let registered =
        signals().into_iter().filter(|signal| signal_hook::flag::register(*signal, Arc::clone(&asked)).is_ok());
    if registered.count() == 0 {
        // The system goes on ending the process by itself.
        return;
    }
    std::thread::spawn(move || {
        while !asked.load(Ordering::Relaxed) {
            std::thread::sleep(LOOK);
        }
        interrupt();
        std::thread::sleep(GRACE);
        let patience = Instant::now() + LONGEST_WRITE;
        while is_keeping_rows() && Instant::now() < patience {
            std::thread::sleep(LOOK);
        }
        if io::stderr().is_terminal() {
            // A progress bar may stand there.
            print_error("\n");
        }
        end();
    });
}

/// Ends the process with its last line. Whoever comes second, of the main thread and the one that waits, says nothing more.
pub(super) fn end() -> ! {
    static LINE: std::sync::Once = std::sync::Once::new();
    LINE.call_once(|| {
        print_error(KEPT.get().copied().unwrap_or(Kept::Printed).line());
        std::process::exit(EXIT_CODE);
    });
    std::process::exit(EXIT_CODE);
}
