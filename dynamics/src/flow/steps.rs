//! Kernels at whole steps of time, from a table that grows as it is asked.
//!
//! Where a window of the search begins is seen in no event, so that it may begin at a whole step: e^(B iδ) is the product of two
//! entries, e^(B nhδ) e^(B lδ) with i = nh + l, where each instant by itself would take an exponential, a sine and a cosine.

use std::cell::RefCell;

use crate::contact_state::bank::{Bank, Kernels};
use crate::contact_state::block::Block;

/// ρδ, ρ the largest radius of a block: a small part of the shortest window.
const STEP: f64 = 0.5;
/// n.
const NEAR: usize = 32;
/// Entries for multiples of nδ; later instants are left to whoever asks for them.
const FAR: usize = 64;

/// The table of a flow.
#[derive(Debug)]
pub(crate) struct Steps {
    /// δ, s, and its inverse.
    length: f64,
    inverse: f64,
    /// At 0 to (n − 1)δ, then at 0, nδ, 2nδ and so on; empty until it is asked for.
    known: RefCell<Vec<Box<[Kernels]>>>,
}

/// So many steps.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Whole(usize);

impl Steps {
    /// Of a flow whose fastest block has this radius.
    pub(crate) fn new(pace: f64) -> Self {
        Self { length: STEP / pace, inverse: pace / STEP, known: RefCell::default() }
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        self.known.borrow().iter().map(|entry| entry.len() * size_of::<Kernels>() / size_of::<f64>()).sum()
    }

    /// The last whole step up to an instant, and when it is, s; `None` beyond the table.
    #[inline(always)]
    pub(crate) fn before(&self, t: f64) -> Option<(Whole, f64)> {
        let steps = t * self.inverse;
        (steps < (NEAR * FAR) as f64).then(|| {
            let whole = steps as usize;
            (Whole(whole), whole as f64 * self.length)
        })
    }

    /// The kernels of all blocks then.
    #[inline(always)]
    pub(crate) fn kernels(&self, bank: &Bank, each: &[Block], Whole(steps): Whole, kernels: &mut [Kernels]) {
        let mut known = self.known.borrow_mut();
        let (far, near) = (NEAR + steps / NEAR, steps % NEAR);
        if known.get(far).is_none_or(|entry| entry.is_empty()) || known[near].is_empty() {
            self.add(bank, each, [far, near], &mut known);
        }
        let factors = known[far].iter().zip(&known[near]);
        for ((kernels, blocks), (far, near)) in kernels.iter_mut().zip(&bank.blocks).zip(factors) {
            *kernels = blocks.joined(far, near);
        }
    }

    #[cold]
    fn add(&self, bank: &Bank, each: &[Block], places: [usize; 2], known: &mut Vec<Box<[Kernels]>>) {
        if known.is_empty() {
            known.resize(NEAR + FAR, Box::default());
        }
        for place in places {
            if known[place].is_empty() {
                let steps = if place < NEAR { place } else { (place - NEAR) * NEAR };
                let mut entry = vec![Kernels::NONE; bank.blocks.len()];
                bank.kernels(each, steps as f64 * self.length, &mut entry);
                known[place] = entry.into_boxed_slice();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_entries_make_the_kernels_of_any_whole_step() {
        let each = [[0.0, 1.0, -1000.0, -3.0], [0.0, 1.0, -9.0, -40.0], [0.0, 1.0, 0.0, 0.0]].map(Block::new);
        let bank = Bank::new(&each);
        let steps = Steps::new(40.0);
        for t in [0.0, 0.02, 0.4, 3.0, 20.0] {
            let (whole, before) = steps.before(t).expect("the table reaches as far");
            assert!(before <= t && t < before + steps.length);
            let (mut joined, mut direct) = ([Kernels::NONE], [Kernels::NONE]);
            steps.kernels(&bank, &each, whole, &mut joined);
            bank.kernels(&each, before, &mut direct);
            for lane in 0..each.len() {
                let (joined, direct) = (joined[0].at(lane), direct[0].at(lane));
                assert!((joined.c - direct.c).abs() < 1e-13 && (joined.s - direct.s).abs() < 1e-13 * (1.0 + before));
            }
        }
        assert!(steps.before(26.0).is_none());
    }
}
