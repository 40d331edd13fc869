//! Runs that are asked for again: rows of one case often differ in what they are compared with, and not in the runs.
//!
//! A run depends on its system and its options alone, so that a thread may keep what came of it. It does so only where it is asked
//! to: whoever measures how long a run takes does not want to be handed an old one.

use std::cell::RefCell;
use std::collections::BTreeMap;

use crate::budget;
use crate::error::EngineError;
use crate::options::{Options, StartState, Until};
use crate::response::Response;
use crate::response::proof::Proof;
use crate::system::{HybridSystem, Particle};

/// Runs that are kept at most.
const MOST: usize = 4096;

/// A run that was made.
struct Made {
    system: HybridSystem,
    options: Options,
    response: Response,
    /// Events on the way, as the limit of a row counts them.
    events: u64,
}

impl Made {
    /// Whether a run under these options is part of it: an audit, and a look at how it settles, read a run and change nothing in it.
    fn has(&self, options: &Options) -> bool {
        let Options { audit, settling, .. } = self.options;
        let reads_all = audit >= options.audit && settling >= options.settling;
        reads_all && self.options == Options { audit, settling, ..options.clone() }
    }

    /// What such a run leaves.
    fn read(&self, options: &Options) -> Response {
        let mut response = self.response.clone();
        if !options.settling {
            response.settling = None;
        }
        if !options.audit {
            let Proof { momentum_residual, energy_residual, residual_bound, .. } = Proof::default();
            response.proof = Proof { momentum_residual, energy_residual, residual_bound, ..response.proof };
        }
        response
    }
}

/// Runs by a part of what they depend on.
type Runs = BTreeMap<Vec<u64>, Vec<Made>>;

thread_local! {
    static KEPT: RefCell<Option<Runs>> = const { RefCell::new(None) };
}

/// Does the work; runs that it makes more than once on this thread are made once.
pub fn keeping_runs<T>(work: impl FnOnce() -> T) -> T {
    /// Puts back what was kept around it, also after a panic.
    struct Restore(Option<Runs>);
    impl Drop for Restore {
        fn drop(&mut self) {
            KEPT.set(self.0.take());
        }
    }
    let _restore = Restore(KEPT.replace(Some(Runs::new())));
    work()
}

/// What came of this run, or comes of it now. One that is kept says how it settles, too: a step of a search is asked for again, as a look
/// that compares a neighbour with it.
pub(crate) fn once(
    system: &HybridSystem,
    options: &Options,
    run: impl FnOnce(&Options) -> Result<Response, EngineError>,
) -> Result<Response, EngineError> {
    if !is_light(options) || KEPT.with_borrow(Option::is_none) {
        return run(options);
    }
    let key = key(system, options);
    let known = KEPT.with_borrow(|kept| {
        let mut of_key = kept.as_ref()?.get(&key)?.iter();
        let made = of_key.find(|made| made.system == *system && made.has(options))?;
        // A run that its row has no room for ends where it would have ended.
        budget::has_room_for(made.events).then(|| (made.read(options), made.events))
    });
    if let Some((response, events)) = known {
        return budget::within(|| {
            budget::count_events(events);
            Ok(response)
        });
    }
    let before = budget::events();
    // A kicked run is a neighbour itself.
    let whole = Options { settling: options.settling || options.kick == 0.0, ..options.clone() };
    let response = run(&whole)?;
    let events = budget::events().saturating_sub(before);
    let made = Made { system: system.clone(), options: whole, response, events };
    let response = made.read(options);
    KEPT.with_borrow_mut(|kept| {
        if let Some(kept) = kept {
            if kept.len() >= MOST {
                kept.clear();
            }
            kept.entry(key).or_default().push(made);
        }
    });
    Ok(response)
}

/// It leaves some numbers, and no lists.
fn is_light(options: &Options) -> bool {
    let Options { until, start, cycle_rates, final_state, record_events, trace, .. } = options;
    let plain = *until == Until::Cycles && *start == StartState::StaticEquilibrium;
    plain && !cycle_rates && !final_state && *record_events == 0 && trace.is_none()
}

/// The bits of what differs from one run of a row to the next. Zero and minus zero, which are equal, have different ones.
fn key(system: &HybridSystem, options: &Options) -> Vec<u64> {
    let drive = &system.drive;
    let of_ticks = drive.ticks.iter().flat_map(|tick| [tick.time, tick.impulse, tick.level]);
    let gaps = system.particles.iter().map(|Particle { gap, .. }| *gap);
    let own = [drive.period, options.kick, options.window_factor];
    own.into_iter().chain(of_ticks).chain(gaps).map(f64::to_bits).collect()
}
