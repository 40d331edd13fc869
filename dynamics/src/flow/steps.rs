//! Transfers of shares over whole steps of time, from a table that grows as it is asked.
//!
//! Where a window of the search begins is seen in no event, so that it may begin at a whole step: e^(B iδ) is the product of three
//! entries, e^(B n²hδ) e^(B nmδ) e^(B lδ) with i = n²h + nm + l, where each instant by itself would take an exponential, a sine and a
//! cosine. With three of them the table of a contact state is small, and those of a run stay in the processor's cache.

use std::cell::RefCell;

use crate::contact_state::bank::{Bank, Kernels, Transfer};
use crate::contact_state::block::Block;

/// ρδ, ρ the largest radius of a block: a small part of the shortest window.
const STEP: f64 = 0.5;
/// n.
const MANY: usize = 8;
/// Entries for multiples of n²δ; later instants are left to whoever asks for them.
const FAR: usize = 32;

/// The table of a flow.
#[derive(Debug)]
pub(crate) struct Steps {
    /// δ, s, and its inverse.
    length: f64,
    inverse: f64,
    known: RefCell<Known>,
}

/// At 0 to (n − 1)δ, then at 0, nδ, 2nδ and so on, then at 0, n²δ, 2n²δ and so on.
#[derive(Debug, Default)]
struct Known {
    /// Which of them: one bit each.
    places: u64,
    /// Of all blocks, one place after the other.
    entries: Vec<Transfer>,
}

/// So many steps.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Whole(u32);

impl Steps {
    /// Of a flow whose fastest block has this radius.
    pub(crate) fn new(pace: f64) -> Self {
        Self { length: STEP / pace, inverse: pace / STEP, known: RefCell::default() }
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        self.known.borrow().entries.len() * size_of::<Transfer>() / size_of::<f64>()
    }

    /// The last whole step up to an instant, and when it is, s; `None` beyond the table.
    #[inline(always)]
    pub(crate) fn before(&self, t: f64) -> Option<(Whole, f64)> {
        let steps = t * self.inverse;
        (steps < (MANY * MANY * FAR) as f64).then(|| {
            let whole = steps as u32;
            (Whole(whole), f64::from(whole) * self.length)
        })
    }

    /// The transfers of all blocks until then.
    #[inline(always)]
    pub(crate) fn transfers(&self, bank: &Bank, each: &[Block], Whole(steps): Whole, transfers: &mut [Transfer]) {
        let mut known = self.known.borrow_mut();
        let width = bank.blocks.len();
        let steps = steps as usize;
        let (near, middle, far) = (steps % MANY, steps / MANY % MANY, steps / (MANY * MANY));
        let places = [near, MANY + middle, 2 * MANY + far];
        let wanted = places.iter().fold(0, |wanted, place| wanted | 1 << place);
        if known.places & wanted != wanted {
            self.add(bank, each, places, &mut known);
        }
        let [near, by_middle, by_far] = places.map(|place| &known.entries[place * width..][..width]);
        let places = transfers.iter_mut().zip(&bank.blocks).zip(near).zip(by_middle.iter().zip(by_far));
        for (((to, blocks), near), (by_middle, by_far)) in places {
            let mut transfer = *near;
            if middle > 0 {
                transfer = blocks.chained(by_middle, &transfer);
            }
            if far > 0 {
                transfer = blocks.chained(by_far, &transfer);
            }
            *to = transfer;
        }
    }

    #[cold]
    fn add(&self, bank: &Bank, each: &[Block], places: [usize; 3], known: &mut Known) {
        let width = bank.blocks.len();
        for place in places {
            if known.places & 1 << place != 0 {
                continue;
            }
            let level = (place / MANY).min(2);
            let steps = (place - level * MANY) * MANY.pow(level as u32);
            let mut kernels = vec![Kernels::NONE; width];
            bank.kernels(each, steps as f64 * self.length, &mut kernels);
            let entries = place * width..(place + 1) * width;
            if known.entries.len() < entries.end {
                known.entries.resize(entries.end, Transfer::NONE);
            }
            known.entries[entries].iter_mut().zip(&kernels).for_each(|(entry, kernels)| *entry = kernels.transfer());
            known.places |= 1 << place;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::four::Four;
    use crate::contact_state::bank::Phases;

    #[test]
    fn three_entries_make_the_kernels_of_any_whole_step() {
        let each = [[0.0, 1.0, -1000.0, -3.0], [0.0, 1.0, -9.0, -40.0], [0.0, 1.0, 0.0, 0.0]].map(Block::new);
        let bank = Bank::default().of(&each);
        let steps = Steps::new(40.0);
        for t in [0.0, 0.02, 0.4, 3.0, 20.0] {
            let (whole, before) = steps.before(t).expect("the table reaches as far");
            assert!(before <= t && t < before + steps.length);
            let (mut chained, mut direct) = ([Transfer::NONE], [Kernels::NONE]);
            steps.transfers(&bank, &each, whole, &mut chained);
            bank.kernels(&each, before, &mut direct);
            let start = Phases { value: Four::all(1.0), rate: Four::all(-2.0) };
            let [chained, direct] =
                [chained[0], direct[0].transfer()].map(|transfer| bank.blocks[0].advance(start, &transfer));
            for (lane, block) in each.iter().enumerate() {
                let (chained, direct) = (chained.at(lane), direct.at(lane));
                let tolerance = 1e-12 * (1.0 + before);
                assert!((chained.value - direct.value).abs() < tolerance);
                assert!((chained.rate - direct.rate).abs() < tolerance * (1.0 + block.radius));
            }
        }
        assert!(steps.before(26.0).is_none());
    }
}
