//! What the visits of contact states have gained, until the measures ask for it.
//!
//! A run comes to the same few contact states again and again. Each keeps one sum ([`crate::flow::gains`]) for each half of the averaged
//! window, and the integrals are worked out for both when the run is over, or sooner where there are many states.

use std::rc::Rc;

use crate::flow::Flow;
use crate::flow::gains::Gains;
use crate::flow::signals::Row;
use crate::flow::sums::Sums;
use crate::response::Observed;

/// Contact states that are kept before they are paid out.
const MOST_STATES: usize = 1024;

/// The sums of all contact states that were visited.
#[derive(Default)]
pub(crate) struct Visits {
    /// In the order of the first visits, in which they are paid out.
    states: Vec<(Rc<Flow>, [Gains; 2])>,
    /// Of those that were paid out, to be used again.
    spare: Vec<[Gains; 2]>,
    /// Half of the averaged window that the next visit belongs to.
    pub(crate) half: usize,
}

impl Visits {
    /// The gains of a contact state in the half under way.
    #[inline]
    pub(crate) fn of(&mut self, flow: &Rc<Flow>) -> &mut Gains {
        // Where it stood in another run's list, or one that was paid out, another one stands now, or none.
        let known = self.states.get(flow.place.get()).is_some_and(|(known, _)| Rc::ptr_eq(known, flow));
        if !known {
            flow.place.set(self.states.len());
            let mut gains = self.spare.pop().unwrap_or_default();
            gains.iter_mut().for_each(|gains| gains.clear(flow.blocks.len()));
            self.states.push((Rc::clone(flow), gains));
        }
        &mut self.states[flow.place.get()].1[self.half]
    }

    /// So many that they should be paid out before another one comes.
    pub(crate) fn is_full(&self) -> bool {
        self.states.len() >= MOST_STATES
    }

    /// Adds the integrals of all visits to the measures, and forgets them.
    pub(crate) fn pay_out(&mut self, displacement: bool, observed: &mut [Observed]) {
        let mut parts: [_; 2] = std::array::from_fn(|_| vec![Vec::new(); observed.len()]);
        for (flow, gains) in self.states.drain(..) {
            let Some(closed) = flow.closed() else { continue };
            if displacement {
                let rows: Vec<&Row> = flow.rows.observed.iter().map(|&row| flow.rows.row(row)).collect();
                for (gains, parts) in gains.iter().zip(&mut parts).filter(|(gains, _)| gains.time[0] > 0.0) {
                    let integrated = closed.solve(gains).of(&rows, displacement);
                    parts.iter_mut().zip(integrated).for_each(|(parts, part)| parts.push(part));
                }
            } else {
                for (of, square) in observed.iter_mut().zip(flow.velocity_squares(closed)) {
                    let squares = square.over(gains.each_ref());
                    for (sums, (gains, square)) in of.halves.iter_mut().zip(gains.iter().zip(squares)) {
                        sums.duration += gains.time[0];
                        sums.velocity_square += square;
                    }
                }
            }
            self.spare.push(gains);
        }
        for (half, parts) in parts.iter().enumerate() {
            for (of, parts) in observed.iter_mut().zip(parts) {
                of.halves[half].add(Sums::of(parts));
            }
        }
    }
}
