//! The range of an observed motion over many cycles, segment by segment as that of a march.

use super::cycle::Cycle;
use crate::budget;
use crate::flow::Flow;
use crate::flow::signals::Row;
use crate::response::extremes::{Extremes, Lookout, Stretch};

/// A state that changes by less than this share in a cycle is steady.
const STEADY: f64 = 1e-16;

/// Takes `cycles` cycles, the first of them from the state `start`, into the range.
pub(super) fn take(flow: &Flow, row: &Row, cycle: &Cycle, start: &[f64], cycles: u64, range: &mut Extremes) {
    let mut lookout = Lookout::default();
    let (mut state, mut c) = (start.to_vec(), vec![0.0; flow.width()]);
    let (blocks, bank) = (&flow.blocks[..], &flow.bank);
    for _ in 0..cycles {
        if budget::spend(1) {
            return;
        }
        let begin = state.clone();
        for segment in &cycle.segments {
            let from = segment.jump.apply(&state);
            if segment.length > 0.0 {
                c[..from.len()].copy_from_slice(&from);
                if let Some(drive) = c.get_mut(from.len()..2 * blocks.len()) {
                    let phase = [segment.drive.cosine, segment.drive.sine];
                    drive.iter_mut().zip(phase).for_each(|(place, phase)| *place = phase);
                }
                let stretch = Stretch { blocks, bank, rest: row.rest(segment.level), length: segment.length };
                lookout.take(range, stretch, row.together(&c));
            }
            state = segment.flow.apply(&from);
        }
        let size = state.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        if state.iter().zip(&begin).all(|(now, before)| (now - before).abs() <= STEADY * size) {
            return;
        }
    }
}
