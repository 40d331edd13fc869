//! What a simulation may take, and the one question by which every loop that might never end learns that it is used up.
//!
//! A simulation keeps to its thread. Its loops count their work with [`spend`], about a microsecond a unit: a decrement, and every
//! few thousand units a look at the thread's processor clock. Once the allowance is used up, `spend` says so until the
//! simulation is over: loops break off wherever they are, and [`within`] replaces what they leave by the error. No number
//! depends on the allowance, and the limit of events falls on the same event on any machine.

use std::cell::{Cell, RefCell};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use cpu_time::ThreadTime;
use serde::{Deserialize, Serialize};

/// Units between two looks at the clock: some milliseconds, and a look takes a third of a microsecond.
const UNITS_A_LOOK: u32 = 4096;
/// Units that the simplest run counts as: it is over in less than a thousand of them.
const UNITS_A_RUN: u32 = 64;

/// The most that a row may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Limit {
    /// Events of one simulation: of a row, or of each point that a row takes a mean over or looks for a maximum among.
    pub events: u64,
    /// Processor time of a row.
    pub time: Duration,
}

impl Default for Limit {
    /// Far beyond any row of the study, of which the longest has some 10⁶ events and takes seconds.
    fn default() -> Self {
        Self { events: 100_000_000, time: Duration::from_secs(600) }
    }
}

/// The process is to end.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Ends every simulation of this process, those to come included, within milliseconds: what Ctrl-C asks for.
pub fn interrupt() {
    INTERRUPTED.store(true, Ordering::Relaxed);
}

/// Whether [`interrupt`] was called.
#[must_use]
pub fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// What a row has spent of its limit; the threads that work on it share the time.
#[derive(Debug)]
pub struct Allowance {
    limit: Limit,
    nanoseconds: AtomicU64,
}

/// What an allowance ended with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exhausted {
    /// The limit of events.
    Events(u64),
    /// The limit of processor time.
    Time(Duration),
    /// It was asked to stop, alone or with all others of the process.
    Cancelled,
}

/// How far a simulation had come when its allowance ran out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overrun {
    /// By what it ended.
    pub exhausted: Exhausted,
    /// Cycle of the run that was under way, from 0.
    pub cycle: u64,
    /// Cycles of that run.
    pub cycles: u64,
    /// Events of the simulation: of all its runs.
    pub events: u64,
    /// Those of the run that was under way.
    pub of_this_run: u64,
    /// Runs of the simulation that were complete.
    pub runs: u64,
    /// Processor time of the simulation.
    pub time: Duration,
}

impl std::error::Error for Overrun {}

impl std::fmt::Display for Overrun {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { cycle, cycles, events, of_this_run, runs, time, .. } = *self;
        match self.exhausted {
            Exhausted::Events(limit) => write!(f, "stopped at the limit of {} events", plain(limit as f64))?,
            Exhausted::Time(limit) => write!(f, "stopped at the limit of {} of processor time", in_words(limit))?,
            Exhausted::Cancelled => write!(f, "stopped on request")?,
        }
        if cycles == 0 {
            write!(f, " before the first cycle")?;
        } else {
            write!(f, " in cycle {cycle} of {cycles}")?;
        }
        if runs > 0 {
            write!(f, ", run {}", runs + 1)?;
        }
        match self.exhausted {
            // No clock enters: the same words on any machine.
            Exhausted::Events(_) => {
                write!(f, ", at about {} events a cycle", plain(of_this_run as f64 / (cycle + 1) as f64))?;
            }
            Exhausted::Time(_) | Exhausted::Cancelled => {
                let rate = events as f64 / time.as_secs_f64().max(f64::MIN_POSITIVE);
                write!(f, ", after {} events, {} a second", plain(events as f64), plain(rate))?;
            }
        }
        match self.exhausted {
            Exhausted::Cancelled => Ok(()),
            _ => write!(f, "; `run: {{limit: …}}` or `--row-limit` allows more"),
        }
    }
}

/// Two digits, with an exponent where there are many.
fn plain(number: f64) -> String {
    if (0.01..1e4).contains(&number) || number == 0.0 {
        let digits = usize::from(number < 10.0 && number.fract() != 0.0);
        format!("{number:.digits$}")
    } else {
        let text = format!("{number:.1e}");
        text.replace(".0e", "e")
    }
}

/// In the largest unit that leaves a whole number, as it is written in a limit.
#[must_use]
pub fn in_words(time: Duration) -> String {
    match (time.as_secs(), time.subsec_nanos()) {
        (seconds, 0) if seconds > 0 && seconds.is_multiple_of(3600) => format!("{} h", seconds / 3600),
        (seconds, 0) if seconds > 0 && seconds.is_multiple_of(60) => format!("{} min", seconds / 60),
        _ => format!("{} s", time.as_secs_f64()),
    }
}

/// A simulation under an allowance.
#[derive(Debug)]
struct Account {
    allowance: Arc<Allowance>,
    begun: ThreadTime,
}

thread_local! {
    /// Units until the next look.
    static UNITS: Cell<u32> = const { Cell::new(UNITS_A_LOOK) };
    /// Events of the simulation, and how many it may have.
    static EVENTS: Cell<u64> = const { Cell::new(0) };
    static MOST_EVENTS: Cell<u64> = const { Cell::new(u64::MAX) };
    /// Events before the run that is under way.
    static EVENTS_BEFORE: Cell<u64> = const { Cell::new(0) };
    /// The cycle that a run has reached, and how many it has; complete runs.
    static CYCLE: Cell<(u64, u64)> = const { Cell::new((0, 0)) };
    static RUNS: Cell<u64> = const { Cell::new(0) };
    static EXHAUSTED: Cell<Option<Exhausted>> = const { Cell::new(None) };
    static ACCOUNT: RefCell<Option<Account>> = const { RefCell::new(None) };
}

impl Allowance {
    /// Nothing of it spent.
    #[must_use]
    pub fn new(limit: Limit) -> Arc<Self> {
        Arc::new(Self { limit, nanoseconds: AtomicU64::new(0) })
    }

    /// Makes one simulation under it, on this thread.
    pub fn simulate<T>(self: &Arc<Self>, simulation: impl FnOnce() -> T) -> T {
        /// Puts back what was in force, also after a panic.
        struct Restore(Option<Account>);
        impl Drop for Restore {
            fn drop(&mut self) {
                let ended = ACCOUNT.replace(self.0.take());
                if let Some(ended) = ended {
                    let nanoseconds = u64::try_from(ended.begun.elapsed().as_nanos()).unwrap_or(u64::MAX);
                    ended.allowance.nanoseconds.fetch_add(nanoseconds, Ordering::Relaxed);
                }
                begin(ACCOUNT.with_borrow(|outer| outer.as_ref().map(|outer| outer.allowance.limit.events)));
            }
        }
        let own = Account { allowance: Arc::clone(self), begun: ThreadTime::now() };
        let _restore = Restore(ACCOUNT.replace(Some(own)));
        begin(Some(self.limit.events));
        simulation()
    }

    fn exhausted(&self, now: Duration) -> Option<Exhausted> {
        let before = Duration::from_nanos(self.nanoseconds.load(Ordering::Relaxed));
        (before + now > self.limit.time).then_some(Exhausted::Time(self.limit.time))
    }
}

fn begin(events: Option<u64>) {
    EVENTS.set(0);
    MOST_EVENTS.set(events.unwrap_or(u64::MAX));
    RUNS.set(0);
    CYCLE.set((0, 0));
    EXHAUSTED.set(None);
    UNITS.set(UNITS_A_LOOK);
}

/// Counts work, about a microsecond a unit; true once nothing is left, and the loop that asks is to break off.
#[inline]
pub(crate) fn spend(units: u32) -> bool {
    match UNITS.get().checked_sub(units) {
        Some(left) => {
            UNITS.set(left);
            false
        }
        None => look(),
    }
}

#[cold]
#[inline(never)]
fn look() -> bool {
    if EXHAUSTED.get().is_none() {
        let of = |account: &Account| account.allowance.exhausted(account.begun.elapsed());
        let of_all = is_interrupted().then_some(Exhausted::Cancelled);
        EXHAUSTED.set(of_all.or_else(|| ACCOUNT.with_borrow(|account| account.as_ref().and_then(of))));
    }
    let exhausted = EXHAUSTED.get().is_some();
    UNITS.set(if exhausted { 0 } else { UNITS_A_LOOK });
    exhausted
}

/// Counts work that cannot be broken off, before it is begun; true if what is left does not suffice for it.
pub(crate) fn spend_ahead(units: u32) -> bool {
    let too_much = |account: &Account| {
        let after = account.begun.elapsed() + Duration::from_micros(units.into());
        account.allowance.exhausted(after)
    };
    if let Some(by) = ACCOUNT.with_borrow(|account| account.as_ref().and_then(too_much)) {
        exhaust(by);
    }
    spend(units)
}

/// Counts an event.
#[inline]
pub(crate) fn count_event() {
    let events = EVENTS.get() + 1;
    EVENTS.set(events);
    if events > MOST_EVENTS.get() {
        exhaust(Exhausted::Events(MOST_EVENTS.get()));
    }
}

/// Counts the events of a run whose outcome is known.
pub(crate) fn count_events(events: u64) {
    EVENTS.set(EVENTS.get() + events);
}

/// So many more events are within the limit.
pub(crate) fn has_room_for(events: u64) -> bool {
    EVENTS.get().saturating_add(events) <= MOST_EVENTS.get()
}

/// Events of the simulation so far.
pub(crate) fn events() -> u64 {
    EVENTS.get()
}

/// Takes back the events since then: a run that is made again has no more of them.
pub(crate) fn go_back_to(events: u64) {
    EVENTS.set(events);
}

/// Makes a run that may have so many events, as far as the simulation has room for them. One that has more is broken off, and its events
/// are taken back: the simulation goes on as if it had not been made.
///
/// # Errors
/// How far the run had come, if it had more.
pub(crate) fn share<T>(events: u64, run: impl FnOnce() -> T) -> Result<T, Overrun> {
    let (before, most) = (EVENTS.get(), MOST_EVENTS.get());
    let share = before.saturating_add(events);
    if share >= most {
        return Ok(run());
    }
    MOST_EVENTS.set(share);
    let outcome = run();
    MOST_EVENTS.set(most);
    if EXHAUSTED.get() != Some(Exhausted::Events(share)) {
        return Ok(outcome);
    }
    let overrun = Overrun { exhausted: Exhausted::Events(events), ..overrun() };
    EVENTS.set(before);
    EXHAUSTED.set(None);
    UNITS.set(UNITS_A_LOOK);
    Err(overrun)
}

#[cold]
fn exhaust(by: Exhausted) {
    EXHAUSTED.set(Some(EXHAUSTED.get().unwrap_or(by)));
    UNITS.set(0);
}

/// Makes runs that others may have made before, and whose outcome is then at hand. They have the limit of events for themselves and leave
/// the counts of the simulation as they were, so that nothing it says hangs on who made them; their time is the simulation's.
pub fn aside<T>(runs: impl FnOnce() -> T) -> T {
    let counts = (EVENTS.replace(0), RUNS.replace(0));
    let outcome = runs();
    EVENTS.set(counts.0);
    RUNS.set(counts.1);
    outcome
}

/// Notes how far a run has come.
#[inline]
pub(crate) fn reach(cycle: u64, cycles: u64) {
    CYCLE.set((cycle, cycles));
}

/// Makes a run; if the allowance ends meanwhile, that is what comes of it.
pub(crate) fn within<T, E: From<Overrun>>(run: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    CYCLE.set((0, 0));
    EVENTS_BEFORE.set(EVENTS.get());
    if !spend(UNITS_A_RUN) {
        let outcome = run();
        if EXHAUSTED.get().is_none() {
            RUNS.set(RUNS.get() + 1);
            return outcome;
        }
    }
    Err(overrun().into())
}

/// What [`spend`] has said, as an error.
#[cold]
pub(crate) fn overrun() -> Overrun {
    let ((cycle, cycles), events, runs) = (CYCLE.get(), EVENTS.get(), RUNS.get());
    let time =
        ACCOUNT.with_borrow(|account| account.as_ref().map_or(Duration::ZERO, |account| account.begun.elapsed()));
    let exhausted = EXHAUSTED.get().unwrap_or(Exhausted::Cancelled);
    // A run that is made again begins before them.
    let of_this_run = events.saturating_sub(EVENTS_BEFORE.get());
    Overrun { exhausted, cycle, cycles, events, of_this_run, runs, time }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn endless() -> Result<(), Overrun> {
        within(|| {
            reach(3, 125);
            while !spend(1) {}
            Ok(())
        })
    }

    #[test]
    fn an_endless_loop_ends_with_its_time_and_says_where() {
        let allowance = Allowance::new(Limit { time: Duration::from_millis(20), ..Limit::default() });
        let said = allowance.simulate(endless).unwrap_err().to_string();
        assert!(
            said.starts_with("stopped at the limit of 0.02 s of processor time in cycle 3 of 125, after 0"),
            "{said}"
        );
        // The time is the row's, and used up; the next row has its own.
        assert!(allowance.simulate(endless).is_err());
        assert_eq!(Allowance::new(Limit::default()).simulate(|| within(|| Ok::<_, Overrun>(1))), Ok(1));
    }

    #[test]
    fn events_are_counted_to_the_last_one() {
        let allowance = Allowance::new(Limit { events: 1000, ..Limit::default() });
        for (events, fine) in [(1000, true), (1001, false)] {
            let run = || {
                within(|| {
                    reach(1, 4);
                    (0..events).for_each(|_| count_event());
                    Ok::<_, Overrun>(())
                })
            };
            assert_eq!(allowance.simulate(run).is_ok(), fine, "{events}");
        }
    }

    #[test]
    fn events_a_cycle_are_those_of_the_run_that_was_under_way() {
        let allowance = Allowance::new(Limit { events: 100, ..Limit::default() });
        let run = |each: u64, cycles: u64| {
            within(|| {
                for cycle in 0..cycles {
                    reach(cycle, 50);
                    (0..each).for_each(|_| count_event());
                }
                Ok::<_, Overrun>(())
            })
        };
        let stopped = allowance.simulate(|| run(0, 50).and_then(|()| run(40, 50))).unwrap_err().to_string();
        assert!(stopped.contains("run 2, at about 40 events a cycle"), "{stopped}");
    }

    #[test]
    fn a_run_beyond_its_share_of_the_events_costs_the_simulation_nothing() {
        let run = |events: u64| {
            within(|| {
                (0..events).for_each(|_| count_event());
                Ok::<_, Overrun>(events)
            })
        };
        Allowance::new(Limit { events: 100, ..Limit::default() }).simulate(|| {
            assert_eq!(run(60), Ok(60));
            let broken_off = share(30, || run(31)).unwrap_err();
            assert_eq!((broken_off.exhausted, broken_off.of_this_run), (Exhausted::Events(30), 31));
            assert_eq!(share(30, || run(30)), Ok(Ok(30)));
            // Ten are left, less than the share: the limit is that of the simulation.
            let overrun = share(30, || run(11)).unwrap().unwrap_err();
            assert_eq!(overrun.exhausted, Exhausted::Events(100));
            assert!(run(0).is_err());
        });
    }

    #[test]
    fn what_a_simulation_says_does_not_hang_on_who_has_made_the_runs_aside() {
        let run = |events: u64| {
            within(|| {
                (0..events).for_each(|_| count_event());
                Ok::<_, Overrun>(())
            })
        };
        let said = |made: bool| {
            Allowance::new(Limit { events: 100, ..Limit::default() }).simulate(|| {
                run(10).unwrap();
                if !made {
                    aside(|| run(95).and_then(|()| run(5))).unwrap();
                }
                run(91).unwrap_err().to_string()
            })
        };
        assert_eq!(said(true), said(false));
    }

    #[test]
    fn limits_are_told_as_they_are_written() {
        let words = [(600_000, "10 min"), (7_200_000, "2 h"), (30_000, "30 s"), (200, "0.2 s"), (90_000, "90 s")];
        assert!(words.iter().all(|(milliseconds, word)| in_words(Duration::from_millis(*milliseconds)) == *word));
        let numbers = [(0.0, "0"), (2.25, "2.2"), (490.0, "490"), (52_341.0, "5.2e4"), (1e8, "1e8")];
        numbers.iter().for_each(|(number, text)| assert_eq!(plain(*number), *text));
    }
}
