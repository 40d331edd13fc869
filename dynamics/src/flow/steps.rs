//! Transfers of shares over whole steps of time, from a table that grows as it is asked.
//!
//! A root is found about the whole step that is nearest to it, and where a window of the search begins is seen in no event, so that it
//! may begin at one: e^(B iδ) is the product of three entries, e^(B n²hδ) e^(B nmδ) e^(B lδ) with i = n²h + nm + l, where each instant by
//! itself would take an exponential, a sine and a cosine. With three of them the table of a contact state is small, and those of a run
//! stay in the processor's cache.

use std::cell::RefCell;

use crate::contact_state::bank::{Bank, Blocks, Kernels, Transfer};
use crate::contact_state::block::Block;

/// ρδ, ρ the largest radius of a block.
pub(crate) const STEP: f64 = 0.024;
/// n; and as many entries for multiples of n²δ: later instants are left to whoever asks for them.
const MANY: usize = 32;

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
    places: u128,
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
        (steps < MANY.pow(3) as f64).then(|| {
            // By rounding a whole step may come after an instant at which it is.
            let whole = steps as u32;
            let whole = whole - u32::from(self.time(whole) > t);
            (Whole(whole), self.time(whole))
        })
    }

    #[inline(always)]
    fn time(&self, steps: u32) -> f64 {
        f64::from(steps) * self.length
    }

    /// The step at an instant that is a whole one, as its time divided by `length` tells.
    #[inline(always)]
    pub(crate) fn at(&self, t: f64) -> Option<Whole> {
        let steps = t * self.inverse + 0.5;
        (steps < MANY.pow(3) as f64).then_some(Whole(steps as u32))
    }

    /// The transfers of all blocks until then.
    #[inline(always)]
    pub(crate) fn transfers(&self, bank: &Bank, each: &[Block], whole: Whole, transfers: &mut [Transfer]) {
        self.each(bank, each, whole, transfers, |transfer, _| transfer);
    }

    /// Their kernels.
    #[inline(always)]
    pub(crate) fn kernels(&self, bank: &Bank, each: &[Block], whole: Whole, kernels: &mut [Kernels]) {
        self.each(bank, each, whole, kernels, |transfer, blocks| blocks.kernels_of(transfer));
    }

    #[inline(always)]
    fn each<T>(
        &self,
        bank: &Bank,
        each: &[Block],
        Whole(steps): Whole,
        to: &mut [T],
        of: impl Fn(Transfer, &Blocks) -> T,
    ) {
        let mut known = self.known.borrow_mut();
        let width = bank.blocks.len();
        let steps = steps as usize;
        let (near, middle, far) = (steps % MANY, steps / MANY % MANY, steps / (MANY * MANY));
        let places = [near, MANY + middle, 2 * MANY + far];
        let wanted = places.iter().fold(0, |wanted, place| wanted | 1_u128 << place);
        if known.places & wanted != wanted {
            self.add(bank, each, places, &mut known);
        }
        let [near, by_middle, by_far] = places.map(|place| &known.entries[place * width..][..width]);
        let places = to.iter_mut().zip(&bank.blocks).zip(near).zip(by_middle.iter().zip(by_far));
        for (((to, blocks), near), (by_middle, by_far)) in places {
            let mut transfer = *near;
            if middle > 0 {
                transfer = blocks.chained(by_middle, &transfer);
            }
            if far > 0 {
                transfer = blocks.chained(by_far, &transfer);
            }
            *to = of(transfer, blocks);
        }
    }

    #[cold]
    fn add(&self, bank: &Bank, each: &[Block], places: [usize; 3], known: &mut Known) {
        let width = bank.blocks.len();
        for place in places {
            if known.places & 1_u128 << place != 0 {
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
            known.places |= 1_u128 << place;
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
        for t in [0.0, 0.02, 0.4, 3.0, 19.0] {
            let (whole, before) = steps.before(t).expect("the table reaches as far");
            assert!(before <= t && t - before <= steps.length * (1.0 + 1e-12));
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
        assert!(steps.before(20.0).is_none());
    }
}
