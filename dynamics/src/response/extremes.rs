//! The range of an observed motion: its largest and smallest displacement and velocity, on the exact flow.
//!
//! A segment is walked in steps short against everything that still moves. Where a derivative changes its sign within a step, and the
//! crest may be the highest so far, it is closed in on. A pair of extrema within one step, which escapes that, differs by far less than
//! the range. Most of a segment is passed over: while
//!
//! s + s′τ ± ½ max|s″| τ²
//!
//! keeps within the range that is known, for s the displacement and the velocity, nothing new can come. Steps and jumps are 2ⁿ of the
//! shortest step, so that a few kernels a block are enough.

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::wide::widened;
use crate::contact_state::bank::{Bank, Kernels, Phases};
use crate::contact_state::block::Block;
use crate::flow::parabola::Parabola;
use crate::response::crest::{Motion, Node, crest};

/// Steps a radian of the fastest block that moves visibly.
const STEPS_A_RADIAN: f64 = 4.0;
/// Share of the whole below which a block does not move visibly.
const INVISIBLE: f64 = 1e-13;
/// Strides after each other by kernels; their rounding adds up to some 1e-14 of the motion.
const STRIDES_IN_A_ROW: u64 = 32;
/// Derivatives of a share up to this one are bounded.
const THIRD: f64 = 3.0;
/// Most steps of a segment.
const MOST_STEPS: f64 = 1e6;

/// The range of an observed motion; lowest and highest value, NaN where nobody looked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// m.
    pub displacement: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
}

impl Default for Extremes {
    fn default() -> Self {
        Self { displacement: [f64::NAN; 2], velocity: [f64::NAN; 2] }
    }
}

impl Extremes {
    /// Of the displacement, order 0, or of the velocity.
    pub(crate) fn of(&self, order: usize) -> [f64; 2] {
        if order == 0 { self.displacement } else { self.velocity }
    }

    /// Takes an instant into the range.
    pub fn take(&mut self, displacement: f64, velocity: f64) {
        // The smaller of NaN and a number is the number.
        for (range, value) in [(&mut self.displacement, displacement), (&mut self.velocity, velocity)] {
            *range = [range[0].min(value), range[1].max(value)];
        }
    }
}

/// Room to look along segments.
#[derive(Debug, Default)]
pub(crate) struct Lookout {
    /// Shares at the start, and where the look is.
    start: Vec<Phases>,
    now: Vec<Phases>,
    /// Bounds on the velocities of the blocks' shares from there on, m/s.
    speeds: Vec<Four>,
    /// Kernels of 1, 2, 4, … steps.
    strides: Vec<Vec<Kernels>>,
    /// How many of them are of this segment.
    known: usize,
    /// Kernels of a time.
    kernels: Vec<Kernels>,
}

/// A segment: its blocks, one by one and several together, the parabola of its loads, and its length in s.
#[derive(Clone, Copy)]
pub(crate) struct Stretch<'a> {
    pub(crate) blocks: &'a [Block],
    pub(crate) bank: &'a Bank,
    pub(crate) rest: Parabola,
    pub(crate) length: f64,
}

impl Lookout {
    /// Takes a segment that starts with these shares into the range.
    pub(crate) fn take(&mut self, extremes: &mut Extremes, stretch: Stretch<'_>, shares: impl Iterator<Item = Phases>) {
        self.start.clear();
        self.start.extend(shares);
        self.look(extremes, stretch);
    }

    widened! {
        /// Takes the segment at hand into the range.
        fn look | look_wide (&mut self, extremes: &mut Extremes, stretch: Stretch<'_>) = by_registers
    }

    #[inline(always)]
    fn by_registers(&mut self, extremes: &mut Extremes, stretch: Stretch<'_>) {
        let length = stretch.length;
        self.now.clone_from(&self.start);
        self.kernels.resize(self.start.len(), Kernels::NONE);
        self.known = 0;
        let mut here = Node { time: 0.0, motion: motion(stretch, self.now.iter().copied(), 0.0) };
        extremes.take(here.motion[0], here.motion[1]);
        let mut bounds = self.bounds(stretch, length);
        let steps = (STEPS_A_RADIAN * bounds.fastest * length).ceil().clamp(1.0, MOST_STEPS);
        let (last, step) = (steps as u64, length / steps);
        let (mut place, mut taken, mut short) = (0_u64, 0_u64, 1_u64);
        while place < last {
            let left = last - place;
            // Surely within the range for so many steps; else as far as a crest does not escape.
            let within = (bounds.within(&here, extremes) / step) as u64;
            if within >= left {
                break;
            }
            let jumps = within > short;
            let doublings = (if jumps { within } else { short.min(left) }).ilog2();
            place += 1 << doublings;
            taken += 1;
            let t = if place == last { length } else { length * (place as f64 / steps) };
            if taken.is_multiple_of(STRIDES_IN_A_ROW) || place == last {
                let moved = moved(stretch, &self.start, t, &mut self.kernels);
                self.now.iter_mut().zip(moved).for_each(|(now, moved)| *now = moved);
            } else {
                self.know(stretch, step, doublings as usize);
                let by = stretch.bank.blocks.iter().zip(&self.strides[doublings as usize]);
                self.now.iter_mut().zip(by).for_each(|(now, (blocks, by))| *now = blocks.advance(*now, &by.transfer()));
            }
            let next = Node { time: t, motion: motion(stretch, self.now.iter().copied(), t) };
            extremes.take(next.motion[0], next.motion[1]);
            for order in if jumps { 0..0 } else { 0..2 } {
                let (start, kernels) = (&self.start, &mut self.kernels);
                let at = |t: f64| motion(stretch, moved(stretch, start, t, kernels), t);
                if let Some(turn) = crest(order, here, next, || extremes.of(order), at) {
                    extremes.take(turn[0], turn[1]);
                }
            }
            here = next;
            bounds = self.bounds(stretch, length - t);
            short = (1.0 / (STEPS_A_RADIAN * bounds.fastest * step)).clamp(1.0, MOST_STEPS) as u64;
        }
    }

    /// Knows the kernels of up to 2^`doublings` steps.
    #[inline(always)]
    fn know(&mut self, stretch: Stretch<'_>, step: f64, doublings: usize) {
        self.strides.resize_with(self.strides.len().max(doublings + 1), Vec::new);
        for (i, kernels) in self.strides.iter_mut().enumerate().take(doublings + 1).skip(self.known) {
            kernels.resize(self.start.len(), Kernels::NONE);
            stretch.bank.kernels(stretch.blocks, step * (1_u64 << i) as f64, kernels);
        }
        self.known = self.known.max(doublings + 1);
    }

    /// The bounds from now on, for `left` seconds.
    #[inline(always)]
    fn bounds(&mut self, Stretch { blocks, bank, rest, .. }: Stretch<'_>, left: f64) -> Bounds {
        let amplitudes = bank.blocks.iter().zip(&self.now).map(|(blocks, now)| blocks.amplitudes(*now));
        self.speeds.clear();
        self.speeds.extend(amplitudes);
        for &k in &bank.near_critical {
            let share = self.now[k / WIDTH].at(k % WIDTH);
            self.speeds[k / WIDTH].set(k % WIDTH, blocks[k].amplitude(share, THIRD, left));
        }
        let (mut whole, mut bend, mut snap) = (Four::ZERO, Four::ZERO, Four::ZERO);
        for (speed, blocks) in self.speeds.iter_mut().zip(&bank.blocks) {
            *speed = *speed * blocks.radius;
            whole = whole + *speed;
            bend = bend + *speed * blocks.radius;
            snap = snap + *speed * blocks.square;
        }
        let visible = INVISIBLE * whole.sum();
        let fastest = self.speeds.iter().zip(&bank.blocks).fold(Four::ZERO, |fastest, (speed, blocks)| {
            let moving = speed.zip(blocks.radius, |speed, radius| if speed > visible { radius } else { 0.0 });
            fastest.zip(moving, |a, b| if b > a { b } else { a })
        });
        Bounds { bend: 2.0 * rest.p2.abs() + bend.sum(), snap: snap.sum(), fastest: fastest.largest() }
    }
}

/// Shares after `t` seconds, by the kernels of that time.
#[inline(always)]
fn moved<'a>(
    stretch: Stretch<'a>,
    start: &'a [Phases],
    t: f64,
    kernels: &'a mut [Kernels],
) -> impl Iterator<Item = Phases> + 'a {
    stretch.bank.kernels(stretch.blocks, t, kernels);
    let each = start.iter().zip(&stretch.bank.blocks).zip(&*kernels);
    each.map(|((from, blocks), kernels)| blocks.advance(*from, &kernels.transfer()))
}

/// The motion whose blocks have these shares.
#[inline(always)]
fn motion(stretch: Stretch<'_>, shares: impl Iterator<Item = Phases>, t: f64) -> Motion {
    let mut sums = [Four::ZERO; 4];
    for (now, blocks) in shares.zip(&stretch.bank.blocks) {
        let bend = blocks.acceleration(now);
        for (sum, part) in sums.iter_mut().zip([now.value, now.rate, bend.value, bend.rate]) {
            *sum = *sum + part;
        }
    }
    let [value, rate, bend, snap] = sums.map(Four::sum);
    let rest = stretch.rest;
    [rest.at(t) + value, rest.rate(t) + rate, 2.0 * rest.p2 + bend, snap]
}

/// What bounds a motion from an instant to the end of its segment.
struct Bounds {
    /// The acceleration, m/s².
    bend: f64,
    /// The rate of that, m/s³.
    snap: f64,
    /// Radius of the fastest block that moves visibly, 1/s.
    fastest: f64,
}

impl Bounds {
    /// For how long displacement and velocity keep within what is known of them.
    fn within(&self, here: &Node, known: &Extremes) -> f64 {
        let [displacement, velocity, acceleration, _] = here.motion;
        let of = |order: usize, value: f64, slope: f64, curvature: f64| {
            let [low, high] = known.of(order);
            until(high - value, slope, curvature).min(until(value - low, -slope, curvature))
        };
        of(0, displacement, velocity, self.bend).min(of(1, velocity, acceleration, self.snap))
    }
}

/// When bτ + ½cτ², c ≥ 0, comes to `room`; 0 where there is none.
fn until(room: f64, slope: f64, curvature: f64) -> f64 {
    if !(room > 0.0) {
        return 0.0;
    }
    let root = (slope * slope + 2.0 * curvature * room).sqrt();
    if slope > 0.0 { 2.0 * room / (slope + root) } else { (root - slope) / curvature }
}
