//! A progress bar on standard error; silent where that is not a terminal.

use indicatif::{ProgressBar, ProgressStyle};

use super::event::{Event, EventHandler};
use crate::text::number::quantity;

/// Listens to a run and shows how far it is.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar that appears with the first event.
    #[must_use]
    pub fn new() -> Self {
        // indicatif hides a bar whose terminal is none.
        let bar = ProgressBar::new(0);
        let template = "{bar:32} {human_pos}/{human_len} simulations, {eta} left  {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self { bar }
    }
}

impl Default for Progress {
    fn default() -> Self {
        Self::new()
    }
}

impl EventHandler for Progress {
    fn on_event(&self, event: &Event<'_>) {
        match event {
            Event::Begun { simulations, .. } => {
                self.bar.set_length(*simulations);
                self.bar.enable_steady_tick(std::time::Duration::from_millis(200));
            }
            Event::Simulated { count, .. } => self.bar.inc(*count),
            Event::Searched { experiment, search, evaluations, best, unit } => {
                let best = quantity(*best, unit, 5);
                self.bar.set_message(format!("{experiment}, {search}: best {best} after {evaluations} evaluations"));
            }
            Event::Finished { experiment, failures, .. } => {
                let description = if failures.rows == 0 { "done" } else { "done, with failed rows" };
                self.bar.set_message(format!("{experiment} {description}"));
            }
            Event::Ended => self.bar.finish_and_clear(),
        }
    }
}
