//! Watched signals as they are where windows begin, and what bounds them from then on.

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::contact_state::bank::{Bank, Blocks, Kernels, Phases, Transfer};
use crate::contact_state::block::{Block, Phase};
use crate::flow::series::{Series, Shares};
use crate::flow::signals::Signals;
use crate::flow::steps::Steps;

/// What a search knows of a flow.
#[derive(Clone, Copy)]
pub(crate) struct Motion<'a> {
    /// Its blocks, several together, and one by one.
    pub(crate) blocks: &'a [Blocks],
    pub(crate) each: &'a [Block],
    pub(crate) bank: &'a Bank,
    pub(crate) series: &'a Series,
    pub(crate) steps: Option<&'a Steps>,
}

impl Motion<'_> {
    #[inline(always)]
    pub(crate) fn kernels(self, t: f64, kernels: &mut [Kernels]) {
        self.bank.kernels(self.each, t, kernels);
    }
}

/// A signal at an instant, and what bounds it from then on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Survey {
    /// NaN until it is looked at.
    at: f64,
    pub(crate) value: f64,
    pub(crate) rate: f64,
    /// Σ amplitude, Σ amplitude·radius², Σ amplitude·radius⁴.
    pub(crate) reach: f64,
    pub(crate) bend: f64,
    pub(crate) snap: f64,
}

impl Survey {
    const NONE: Self = Self { at: f64::NAN, value: 0.0, rate: 0.0, reach: 0.0, bend: 0.0, snap: 0.0 };
}

/// The signals, as far as they have been looked at since windows began at `now`.
#[derive(Debug, Default)]
pub(crate) struct Surveys {
    /// Where windows begin, seconds from the segment's start, and the transfers up to there.
    pub(crate) now: f64,
    here: Vec<Transfer>,
    /// Work space.
    kernels: Vec<Kernels>,
    each: Vec<Survey>,
    /// Shares of several blocks each, signal by signal.
    shares: Vec<Shares>,
    width: usize,
}

impl Surveys {
    /// Of no signal yet, at the start of a segment.
    #[inline(always)]
    pub(crate) fn begin(&mut self, motion: Motion<'_>, signals: &Signals) {
        self.width = motion.blocks.len();
        self.here.resize(self.width, Transfer::NONE);
        self.each.resize(signals.len(), Survey::NONE);
        self.each.iter_mut().for_each(|survey| survey.at = f64::NAN);
        let size = self.width * signals.len();
        if self.shares.len() < size {
            self.shares.resize(size, Shares::NONE);
        }
        self.now = 0.0;
    }

    /// Windows begin at `t` from now on, or at the whole step before it if that is later than now.
    #[inline(always)]
    pub(crate) fn move_to(&mut self, motion: Motion<'_>, t: f64) {
        if let Some(steps) = motion.steps
            && let Some((whole, before)) = steps.before(t)
            && before > self.now
        {
            self.now = before;
            steps.transfers(motion.bank, motion.each, whole, &mut self.here);
        } else {
            self.now = t;
            self.kernels.resize(self.width, Kernels::NONE);
            motion.kernels(t, &mut self.kernels);
            self.here.iter_mut().zip(&self.kernels).for_each(|(here, kernels)| *here = kernels.transfer());
        }
    }

    /// The shares of a signal that has been looked at.
    pub(crate) fn shares(&self, signal: usize) -> &[Shares] {
        &self.shares[signal * self.width..][..self.width]
    }

    /// A signal as it is now, with its shares.
    #[inline(always)]
    pub(crate) fn of(
        &mut self,
        motion: Motion<'_>,
        signals: &Signals,
        signal: usize,
        limit: f64,
    ) -> (&Survey, &mut [Shares]) {
        let now = self.now;
        let shares = &mut self.shares[signal * self.width..][..self.width];
        let survey = &mut self.each[signal];
        if survey.at == now {
            return (survey, shares);
        }
        let watched = signals.of(signal);
        let mut turns = Turns::ZERO;
        let Phase { value, rate } = if now > 0.0 {
            let mut total = Phases::ZERO;
            let starts = motion.blocks.iter().zip(watched.phases).zip(&self.here);
            for (((blocks, start), here), share) in starts.zip(&mut *shares) {
                let now = blocks.advance(*start, here);
                total = Phases { value: total.value + now.value, rate: total.rate + now.rate };
                *share = Shares { now, amplitude: blocks.amplitudes(now) };
                turns.add(blocks, share.amplitude);
            }
            Phase { value: total.value.sum(), rate: total.rate.sum() }
        } else {
            for ((blocks, now), share) in motion.blocks.iter().zip(watched.phases).zip(&mut *shares) {
                *share = Shares { now: *now, amplitude: blocks.amplitudes(*now) };
                turns.add(blocks, share.amplitude);
            }
            watched.sum
        };
        if !motion.bank.near_critical.is_empty() {
            // Good for the second derivative too.
            bound(motion, shares, 2.0, limit - now);
            turns = Turns::of(motion.blocks, shares);
        }
        let Turns { reach, bend, snap } = turns;
        *survey = Survey { at: now, value, rate, reach: reach.sum(), bend: bend.sum(), snap: snap.sum() };
        (survey, shares)
    }
}

/// Σ amplitude, Σ amplitude·radius² and Σ amplitude·radius⁴, place by place of several blocks.
#[derive(Clone, Copy)]
pub(crate) struct Turns {
    reach: Four,
    pub(crate) bend: Four,
    pub(crate) snap: Four,
}

impl Turns {
    const ZERO: Self = Self { reach: Four::ZERO, bend: Four::ZERO, snap: Four::ZERO };

    #[inline(always)]
    pub(crate) fn of(blocks: &[Blocks], shares: &[Shares]) -> Self {
        let mut turns = Self::ZERO;
        for (blocks, share) in blocks.iter().zip(shares) {
            turns.add(blocks, share.amplitude);
        }
        turns
    }

    #[inline(always)]
    fn add(&mut self, blocks: &Blocks, amplitude: Four) {
        let bend = amplitude * blocks.square;
        self.reach = self.reach + amplitude;
        self.bend = self.bend + bend;
        self.snap = self.snap + bend * blocks.square;
    }
}

/// Bounds anew the shares of blocks near critical damping, for a derivative of this order over so long a time.
#[cold]
pub(crate) fn bound(motion: Motion<'_>, shares: &mut [Shares], order: f64, window: f64) {
    for &k in &motion.bank.near_critical {
        let share = &mut shares[k / WIDTH];
        share.amplitude.set(k % WIDTH, motion.each[k].amplitude(share.now.at(k % WIDTH), order, window));
    }
}
