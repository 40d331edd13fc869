//! How far a run is, on standard error: a bar on a terminal, elsewhere a line for each experiment that ends.

use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;

use indicatif::{ProgressBar, ProgressStyle};

use super::event::{Event, EventHandler, Left};
use crate::text::number::{quantity, significant};
use crate::text::words::counted;

/// Shows the progress of a run.
#[derive(Debug)]
pub enum Progress {
    /// As a bar.
    Bar(ProgressBar),
    /// In lines.
    Lines(Mutex<Ahead>),
}

/// What is left of a run.
#[derive(Debug, Default)]
pub struct Ahead {
    experiments: usize,
    simulations: u64,
}

impl Progress {
    /// A bar if standard error is a terminal, otherwise lines.
    #[must_use]
    pub fn new() -> Self {
        if !io::stderr().is_terminal() {
            return Self::Lines(Mutex::default());
        }
        let bar = ProgressBar::new(0);
        let template = "{bar:32} {human_pos}/{human_len} simulations, {eta} left  {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self::Bar(bar)
    }
}

impl Default for Progress {
    fn default() -> Self {
        Self::new()
    }
}

impl EventHandler for Progress {
    fn on_event(&self, event: &Event<'_>) {
        match self {
            Self::Bar(bar) => show(bar, event),
            Self::Lines(left) => {
                if let Ok(mut left) = left.lock()
                    && let Some(line) = left.line(event)
                {
                    // A progress line that cannot be written is no reason to end the run.
                    let _ = io::stderr().lock().write_all(line.as_bytes());
                }
            }
        }
    }
}

fn show(bar: &ProgressBar, event: &Event<'_>) {
    match event {
        Event::Begun { simulations, .. } => {
            bar.set_length(*simulations);
            bar.enable_steady_tick(std::time::Duration::from_millis(200));
        }
        Event::Simulated { count, .. } => bar.inc(*count),
        Event::Searched { experiment, search, evaluations, best, unit } => {
            let best = quantity(*best, unit, 5);
            bar.set_message(format!("{experiment}, {search}: best {best} after {evaluations} evaluations"));
        }
        Event::Tried { sets, given_up, best } => bar.set_message(tried(*sets, *given_up, *best)),
        Event::Finished { experiment, failures, .. } => {
            let state = if failures.rows == 0 { "done" } else { "done, with failed rows" };
            bar.set_message(format!("{experiment} {state}"));
        }
        Event::Interrupted { experiment, left } => bar.set_message(format!("{experiment}: {}", left_in_words(*left))),
        Event::Ended => bar.finish_and_clear(),
    }
}

/// `24 sets tried, 7 of them stopped early; least residual 15 %`.
fn tried(sets: usize, given_up: usize, best: Option<f64>) -> String {
    let stopped = if given_up == 0 { String::new() } else { format!(", {given_up} of them stopped early") };
    let least = |best: f64| format!("least residual {} %", significant(100.0 * best, 2));
    let best = best.map_or_else(|| "no residual yet".into(), least);
    format!("{} tried{stopped}; {best}", counted(sets, "set", "sets"))
}

fn left_in_words(left: Left) -> String {
    match left {
        Left::NotBegun => "not begun".into(),
        Left::Rows { done, rows } => {
            format!("interrupted: {done} of {} done, kept; the next run goes on there", counted(rows, "row", "rows"))
        }
        Left::Journal => "interrupted: what it evaluated is kept; the next run goes on there".into(),
        Left::Nothing => "interrupted before there was anything to keep; the next run begins it again".into(),
    }
}

/// `1 simulation`, `12 simulations`.
pub(crate) fn simulations(count: u64) -> String {
    counted(usize::try_from(count).unwrap_or(usize::MAX), "simulation", "simulations")
}

impl Ahead {
    /// The line about an event, if there is something to say: `ch3-gap: 3 rows in 1.2 s; 4 experiments left`.
    pub fn line(&mut self, event: &Event<'_>) -> Option<String> {
        match event {
            Event::Begun { experiments, simulations } => {
                *self = Self { experiments: *experiments, simulations: *simulations };
                None
            }
            Event::Simulated { count, .. } => {
                self.simulations = self.simulations.saturating_sub(*count);
                None
            }
            Event::Finished { experiment, rows, failures, seconds } => {
                self.experiments = self.experiments.saturating_sub(1);
                let failed = if failures.rows == 0 { String::new() } else { format!(" ({} failed)", failures.rows) };
                let took = match seconds {
                    Some(seconds) => format!("{} of processor time", quantity(*seconds, "s", 2)),
                    None => "restored from earlier tables".into(),
                };
                let left = match self.experiments {
                    0 => "none left".into(),
                    many => format!(
                        "{} left, {} at most",
                        counted(many, "experiment", "experiments"),
                        simulations(self.simulations)
                    ),
                };
                let rows = counted(*rows, "row", "rows");
                Some(format!("{experiment}: {rows}{failed}, {took}; {left}\n"))
            }
            Event::Interrupted { experiment, left } => Some(format!("{experiment}: {}\n", left_in_words(*left))),
            Event::Tried { sets, given_up, best } => Some(tried(*sets, *given_up, *best) + "\n"),
            Event::Searched { .. } | Event::Ended => None,
        }
    }
}
