//! Integrals of a signal over a segment, by Gauss-Legendre panels so short that they are exact to rounding: for motion
//! without damping and for brief stretches, where the closed forms of [`crate::flow::gains`] lose their digits.
//!
//! Nodes lie in pairs about the middle m of a panel, so that one exponential, sine and cosine of each pair are enough:
//!
//! e^(B(m ± x)) = e^(Bm) e^(±Bx).

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::quadrature;
use crate::arithmetic::wide::widened;
use crate::budget;
use crate::contact_state::bank::{Bank, Kernels};
use crate::contact_state::block::{Block, Kernel, Phase};
use crate::flow::parabola::Parabola;
use crate::flow::sums::{About, Sums};

/// Times the slowest turn of a contact state: stretches shorter than this leave next to nothing of the differences of end values
/// that the closed forms are made of.
pub(crate) const BRIEF: f64 = 0.05;

/// Panels after each other by the kernels of one; their rounding adds up to some 1e-14 of the motion.
const PANELS_IN_A_ROW: usize = 32;

/// What a squared signal, which turns twice as fast as its fastest block, turns by in a panel for which the rule of sixteen points is
/// exact to rounding: of the 32nd derivative of the square it leaves (16!)⁴/(33 (32!)³) 14.8³², which is 10⁻¹⁷.
const TURN_OF_A_PANEL: f64 = 14.8;
/// The same for that of eight points: of the 16th derivative it leaves (8!)⁴/(17 (16!)³) 2.3¹⁶.
const TURN_OF_A_SHORT_PANEL: f64 = 2.3;
/// What has died away turns by no more than this, so that it gets no more panels.
const MOST_OF_WHAT_IS_GONE: f64 = 1e5;
/// decay·t at which a block has died away to rounding.
const DIED_AWAY: f64 = 40.0;

/// The node and the weight of each pair, in whole registers.
const RULE: [[Four; 2]; REGISTERS] = rule(&quadrature::half::<{ REGISTERS * WIDTH }>());
const SHORT_RULE: [[Four; 2]; 1] = rule(&quadrature::half::<WIDTH>());
const REGISTERS: usize = 2;

const fn rule<const REGISTERS: usize>(half: &[[f64; 2]]) -> [[Four; 2]; REGISTERS] {
    let (mut rule, mut i) = ([[Four::ZERO; 2]; REGISTERS], 0);
    while i < REGISTERS {
        let [a, b, c, d] = [half[4 * i], half[4 * i + 1], half[4 * i + 2], half[4 * i + 3]];
        rule[i] = [Four::new([a[0], b[0], c[0], d[0]]), Four::new([a[1], b[1], c[1], d[1]])];
        i += 1;
    }
    rule
}

/// The panels of a stretch, over which any number of signals is integrated by the same kernels.
#[derive(Debug, Default)]
pub(crate) struct Panels {
    count: usize,
    /// The rule of eight points is exact.
    is_short: bool,
    /// Of a panel, s.
    length: f64,
    /// Block by block: c and s after each node beyond the middle, and after the one before it.
    nodes: Vec<[[Four; 4]; REGISTERS]>,
    /// Kernels of half a panel.
    middle: Vec<Kernels>,
    /// Shares at the start of the stretch, and at that of a panel.
    start: Vec<Phase>,
    now: Vec<Phase>,
    /// Kernels of a panel, where there are several.
    ends: Vec<Kernel>,
}

/// What a squared signal turns by over `duration`.
fn turn(blocks: &[Block], duration: f64) -> f64 {
    let turn = |block: &Block| {
        let turn = 2.0 * block.radius * duration;
        if block.decay * duration > DIED_AWAY { turn.min(MOST_OF_WHAT_IS_GONE) } else { turn }
    };
    blocks.iter().map(turn).fold(1.0, f64::max)
}

impl Panels {
    widened! {
        /// Those of a stretch of `duration` seconds; `bank` has the same blocks side by side.
        pub(crate) fn divide | divide_wide (&mut self, blocks: &[Block], bank: &Bank, duration: f64) = divide_by_registers
    }

    #[inline(always)]
    fn divide_by_registers(&mut self, blocks: &[Block], bank: &Bank, duration: f64) {
        let turn = turn(blocks, duration);
        self.count = (turn / TURN_OF_A_PANEL).ceil() as usize;
        self.is_short = turn < TURN_OF_A_SHORT_PANEL;
        let rule = if self.is_short { &SHORT_RULE[..] } else { &RULE };
        self.length = duration / self.count as f64;
        let half = 0.5 * self.length;
        self.middle.resize(bank.blocks.len(), Kernels::NONE);
        bank.kernels(blocks, half, &mut self.middle);
        self.nodes.clear();
        for (k, block) in blocks.iter().enumerate() {
            let middle = self.middle[k / WIDTH].at(k % WIDTH);
            let mut nodes = [[Four::ZERO; 4]; REGISTERS];
            for (nodes, [x, _]) in nodes.iter_mut().zip(rule) {
                *nodes = block.kernels_about(half, middle, *x * half);
            }
            self.nodes.push(nodes);
        }
    }

    /// Starts with these shares.
    fn start(&mut self, shares: impl Iterator<Item = Phase>) {
        self.start.clear();
        self.start.extend(shares);
    }

    /// ∫ s² dt of a signal that starts with these shares.
    pub(crate) fn square(&mut self, blocks: &[Block], shares: impl Iterator<Item = Phase>) -> f64 {
        self.start(shares);
        let [[_, square]] = self.integrate(blocks, [Parabola::default()]);
        square
    }

    /// The measures of a motion that starts with these shares, beside what constant loads add.
    pub(crate) fn sums(&mut self, blocks: &[Block], shares: impl Iterator<Item = Phase>, rest: Parabola) -> Sums {
        self.start(shares);
        let place = self.start.iter().fold(rest.p0, |sum, share| sum + share.value);
        let loads = [Parabola { p0: rest.p0 - place, ..rest }, rest.derivative()];
        let [[moved, square], [_, velocity_square]] = self.integrate_with_rate(blocks, loads);
        let duration = self.length * self.count as f64;
        Sums::of(&[About { duration, place, moved, square, velocity_square }])
    }

    widened! {
        fn integrate | integrate_wide (&mut self, blocks: &[Block], loads: [Parabola; 1]) -> [[f64; 2]; 1] = by_registers
    }
    widened! {
        fn integrate_with_rate | integrate_with_rate_wide
            (&mut self, blocks: &[Block], loads: [Parabola; 2]) -> [[f64; 2]; 2] = by_registers
    }

    /// ∫ s and ∫ s² of the signal and, of two, of its rate, with what loads add to each.
    #[inline(always)]
    fn by_registers<const Q: usize>(&mut self, blocks: &[Block], loads: [Parabola; Q]) -> [[f64; 2]; Q] {
        if self.is_short { self.by(&SHORT_RULE, blocks, loads) } else { self.by(&RULE, blocks, loads) }
    }

    #[inline(always)]
    fn by<const Q: usize, const R: usize>(
        &mut self,
        rule: &[[Four; 2]; R],
        blocks: &[Block],
        loads: [Parabola; Q],
    ) -> [[f64; 2]; Q] {
        let half = 0.5 * self.length;
        let mut sums = [[Four::ZERO; 2]; Q];
        for panel in 0..self.count {
            if budget::spend(1) {
                break;
            }
            if panel > 0 {
                self.move_on(blocks, panel);
            }
            let now = if panel > 0 { &self.now } else { &self.start };
            let middle = Four::all((2 * panel + 1) as f64 * half);
            let sides = rule.map(|[x, _]| [middle + x * half, middle - x * half]);
            let mut values = loads.map(|Parabola { p0, p1, p2 }| {
                sides.map(|sides| sides.map(|t| Four::all(p0) + t * (Four::all(p1) + t * p2)))
            });
            for ((block, share), nodes) in blocks.iter().zip(now).zip(&self.nodes) {
                let Phase { value, rate } = *share;
                let answers =
                    [[value, rate + block.decay * value], [rate, -(block.decay * rate + block.determinant * value)]];
                for (values, [x, y]) in values.iter_mut().zip(answers) {
                    for ([after, before], [c, s, c_before, s_before]) in values.iter_mut().zip(nodes) {
                        *after = *after + (*c * x + *s * y);
                        *before = *before + (*c_before * x + *s_before * y);
                    }
                }
            }
            for ([sum, square], values) in sums.iter_mut().zip(values) {
                for ([after, before], [_, weight]) in values.into_iter().zip(*rule) {
                    *sum = *sum + (after + before) * weight;
                    *square = *square + (after * after + before * before) * weight;
                }
            }
        }
        sums.map(|sums| sums.map(|sum| sum.sum() * half))
    }

    /// Shares at the start of a panel that is not the first.
    #[cold]
    fn move_on(&mut self, blocks: &[Block], panel: usize) {
        let is_afresh = panel.is_multiple_of(PANELS_IN_A_ROW);
        if panel == 1 {
            self.now.clone_from(&self.start);
            self.ends.clear();
            self.ends.extend(blocks.iter().map(|block| block.kernel(self.length)));
        }
        for (k, block) in blocks.iter().enumerate() {
            self.now[k] = if is_afresh {
                block.advance(self.start[k], block.kernel(panel as f64 * self.length))
            } else {
                block.advance(self.now[k], self.ends[k])
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integrals of a signal about a place, node by node, each from the start.
    fn integrals(blocks: &[Block], start: &[Phase], rest: Parabola, duration: f64, place: f64) -> [f64; 3] {
        let turn = blocks.iter().map(|block| block.radius * duration).fold(1.0, f64::max);
        let count = turn.ceil() as usize;
        let h = duration / count as f64;
        let mut sum = [0.0; 3];
        for (panel, [x, weight]) in (0..count).flat_map(|panel| quadrature::TEN.map(|node| (panel, node))) {
            let t = (panel as f64 + x) * h;
            let [value, rate, ..] =
                crate::flow::signals::motion(blocks, start.iter().copied(), rest, |k| blocks[k].kernel(t), t);
            let value = value - place;
            let parts = [value, value * value, rate * rate];
            sum.iter_mut().zip(parts).for_each(|(sum, part)| *sum += weight * h * part);
        }
        sum
    }

    #[test]
    fn panels_have_the_integrals_of_shorter_ones_with_fewer_points() {
        let matrices =
            [[0.0, 1.0, -9e4, -3.0], [0.0, 1.0, -25.0, -10.0], [0.0, 1.0, -9.0, -40.0], [0.0, 1.0, 0.0, 0.0]];
        let blocks = matrices.map(Block::new);
        let bank = Bank::default().of(&blocks);
        let shares = [0.3, -1.2, 0.7, 0.1].map(|x| Phase { value: x, rate: 40.0 * x * x });
        let loads = Parabola { p0: 0.2, p1: -1.0, p2: -4.9 };
        let mut panels = Panels::default();
        for duration in [1e-6, 3e-3, 0.02, 0.05, 0.7, 9.0] {
            panels.divide(&blocks, &bank, duration);
            for rest in [Parabola::default(), loads] {
                let sums = panels.sums(&blocks, shares.iter().copied(), rest);
                let place = sums.mean_displacement();
                let [moved, square, velocity_square] = integrals(&blocks, &shares, rest, duration, place);
                assert!(moved.abs() <= 1e-13 * duration * (1.0 + place.abs()), "{duration}: {moved}");
                for (one, other, size) in [
                    (sums.deviation_square, square, square + duration),
                    (sums.velocity_square, velocity_square, velocity_square),
                ] {
                    assert!((one - other).abs() <= 1e-13 * size, "{duration}: {one} for {other}");
                }
            }
            let value = panels.square(&blocks, shares.iter().copied());
            let [_, square, _] = integrals(&blocks, &shares, Parabola::default(), duration, 0.0);
            assert!((value / square - 1.0).abs() <= 1e-12, "{duration}: {value} for {square}");
        }
    }
}
