//! The kernels of all blocks of a flow, side by side.
//!
//! Most blocks turn: they need e^(−at), sin and cos of √(−d) t, which are computed for several blocks at once. The few that do
//! not turn are computed by themselves afterwards.

use super::block::{Block, Kernel};
use super::elementary::{exp_lanes, sin_cos_lanes};
use super::lanes::Lanes;

/// Blocks side by side: two registers of two numbers keep a pipeline busier than one.
const WIDTH: usize = 2;

/// The blocks of a flow, as their kernels need them.
#[derive(Debug, Default)]
pub(crate) struct Bank {
    turns: Vec<Turns>,
    /// Blocks that do not turn.
    others: Vec<usize>,
}

/// Blocks that turn; in the place of one that does not stands nothing.
#[derive(Debug, Clone, Copy)]
struct Turns {
    decay: Lanes<WIDTH>,
    root: Lanes<WIDTH>,
    inverse_root: Lanes<WIDTH>,
}

impl Bank {
    pub(crate) fn new(blocks: &[Block]) -> Self {
        let turns = blocks.chunks(WIDTH).map(|chunk| {
            let each = |part: fn(&Block) -> f64| {
                let mut lanes = Lanes([0.0; WIDTH]);
                for (lane, block) in lanes.0.iter_mut().zip(chunk).filter(|(_, block)| block.oscillates()) {
                    *lane = part(block);
                }
                lanes
            };
            Turns { decay: each(|b| b.decay), root: each(|b| b.root), inverse_root: each(|b| b.inverse_root) }
        });
        Self { turns: turns.collect(), others: (0..blocks.len()).filter(|&k| !blocks[k].oscillates()).collect() }
    }

    /// Places for kernels; those behind the blocks hold nothing.
    pub(crate) fn places(&self) -> usize {
        WIDTH * self.turns.len()
    }

    /// The kernels of all `blocks` after `t` seconds.
    #[inline]
    pub(crate) fn kernels(&self, blocks: &[Block], t: f64, kernels: &mut [Kernel]) {
        for (turns, kernels) in self.turns.iter().zip(kernels.as_chunks_mut::<WIDTH>().0) {
            let e = exp_lanes(-1.0 * turns.decay * t);
            let (sine, cosine) = sin_cos_lanes(turns.root * t);
            let (c, turn) = (e * cosine, e * sine);
            let s = turn * turns.inverse_root;
            for (lane, kernel) in kernels.iter_mut().enumerate() {
                *kernel = Kernel { c: c.0[lane], s: s.0[lane], turn: turn.0[lane] };
            }
        }
        for &k in &self.others {
            kernels[k] = blocks[k].kernel(t);
        }
    }
}
