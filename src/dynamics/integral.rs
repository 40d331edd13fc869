//! Integrals of a signal over a segment, by Gauss-Legendre panels so short that they are exact to rounding: for motion
//! without damping and for brief stretches, where the closed forms of [`super::gains`] lose their digits.

use super::block::{Block, Phase};
use super::budget;
use super::four::Four;
use super::lanes::{Lanes, WIDTH};
use super::parabola::Parabola;
use super::sums::{About, Sums};
use super::wide::widened;

/// Times the slowest turn of a contact state: stretches shorter than this leave next to nothing of the differences of end values
/// that the closed forms are made of.
pub(crate) const BRIEF: f64 = 0.05;

/// Panels after each other by the kernels of one; their rounding adds up to some 1e-14 of the motion.
const PANELS_IN_A_ROW: usize = 32;

/// Several signals over the panels of a stretch, which share the kernels of their nodes: the nodes of a panel lie side by side,
/// and shares move on from panel to panel.
#[derive(Debug, Default)]
pub(crate) struct Panels {
    signals: Vec<Integrand>,
    /// Their shares at the start, signal by signal.
    shares: Vec<Phase>,
    /// Those of one of them at the start of a panel.
    now: Vec<Phase>,
    /// c and s of each block at the places of a panel.
    kernels: Vec<[Places; 2]>,
}

/// A signal, and what of it is integrated.
#[derive(Debug)]
pub(crate) struct Integrand {
    rest: Parabola,
    /// About which the displacement is taken.
    place: f64,
    /// ∫ (s − place), ∫ (s − place)² and ∫ s′².
    integrals: [f64; 3],
    /// ∫ s″², without what constant loads add.
    pub(crate) acceleration_square: f64,
}

impl Integrand {
    /// The measures of its signal, of a stretch of `duration` seconds.
    pub(crate) fn sums(&self, duration: f64) -> Sums {
        let [moved, square, velocity_square] = self.integrals;
        Sums::of(&[About { duration, place: self.place, moved, square, velocity_square }])
    }
}

impl Panels {
    /// No signals.
    pub(crate) fn clear(&mut self) {
        self.signals.clear();
        self.shares.clear();
    }

    /// Adds a signal by its shares at the start.
    pub(crate) fn add(&mut self, shares: impl Iterator<Item = Phase>, rest: Parabola) {
        let first = self.shares.len();
        self.shares.extend(shares);
        let place = self.shares[first..].iter().fold(rest.p0, |sum, share| sum + share.value);
        self.signals.push(Integrand { rest, place, integrals: [0.0; 3], acceleration_square: 0.0 });
    }

    widened! {
        /// Integrates them over `duration` seconds, once.
        pub(crate) fn integrate | integrate_wide (&mut self, blocks: &[Block], duration: f64) -> &[Integrand] = by_registers
    }

    #[inline(always)]
    fn by_registers(&mut self, blocks: &[Block], duration: f64) -> &[Integrand] {
        let count = panels(blocks, duration);
        let h = duration / count as f64;
        self.kernels.resize(blocks.len(), [Places::ZERO; 2]);
        for (kernels, block) in self.kernels.iter_mut().zip(blocks) {
            *kernels = block.kernels(h * PLACES);
        }
        for (signal, start) in self.signals.iter_mut().zip(self.shares.chunks_exact(blocks.len().max(1))) {
            self.now.clear();
            self.now.extend_from_slice(start);
            for panel in 0..count {
                if budget::spend(1) {
                    break;
                }
                if panel > 0 && panel.is_multiple_of(PANELS_IN_A_ROW) {
                    let from = blocks.iter().zip(start);
                    let moved = from.map(|(block, share)| block.advance(*share, block.kernel(panel as f64 * h)));
                    self.now.iter_mut().zip(moved).for_each(|(now, moved)| *now = moved);
                }
                let t = registers(PLACES).map(|places| (Four::all(panel as f64) + places) * h);
                let Parabola { p0, p1, p2 } = signal.rest;
                let mut value = t.map(|t| Four::all(p0 - signal.place) + t * (Four::all(p1) + t * p2));
                let mut rate = t.map(|t| Four::all(p1) + t * (2.0 * p2));
                let mut bend = [Four::ZERO; REGISTERS];
                for ((block, share), kernels) in blocks.iter().zip(&mut self.now).zip(&self.kernels) {
                    let slope = share.rate + block.decay * share.value;
                    let fall = block.decay * share.rate + block.determinant * share.value;
                    let [c, s] = kernels.map(registers);
                    let mut now = *share;
                    for i in 0..REGISTERS {
                        let (v, r) = (c[i] * share.value + s[i] * slope, c[i] * share.rate - s[i] * fall);
                        (value[i], rate[i]) = (value[i] + v, rate[i] + r);
                        bend[i] = bend[i] + (r * (2.0 * block.decay) + v * block.determinant);
                        if i == END / WIDTH {
                            now = Phase { value: v.array()[END % WIDTH], rate: r.array()[END % WIDTH] };
                        }
                    }
                    *share = now;
                }
                let square = |x: [Four; REGISTERS]| x.map(|x| x * x);
                signal.integrals[0] += weighted(value) * h;
                signal.integrals[1] += weighted(square(value)) * h;
                signal.integrals[2] += weighted(square(rate)) * h;
                signal.acceleration_square += weighted(square(bend)) * h;
            }
        }
        &self.signals
    }
}

/// Nodes and weights of the ten-point Gauss-Legendre rule on [0, 1].
pub(crate) const GAUSS: [[f64; 2]; 10] = {
    const X: [f64; 5] = [
        0.148_874_338_981_631_21,
        0.433_395_394_129_247_2,
        0.679_409_568_299_024_4,
        0.865_063_366_688_984_5,
        0.973_906_528_517_171_7,
    ];
    const W: [f64; 5] = [
        0.295_524_224_714_752_87,
        0.269_266_719_309_996_35,
        0.219_086_362_515_982_04,
        0.149_451_349_150_580_6,
        0.066_671_344_308_688_14,
    ];
    let mut rule = [[0.0; 2]; 10];
    let mut i = 0;
    while i < 5 {
        rule[2 * i] = [0.5 * (1.0 - X[i]), 0.5 * W[i]];
        rule[2 * i + 1] = [0.5 * (1.0 + X[i]), 0.5 * W[i]];
        i += 1;
    }
    rule
};

/// The nodes of a panel, its end, and one more to fill the registers.
type Places = Lanes<{ REGISTERS * WIDTH }>;
const REGISTERS: usize = 3;
const END: usize = GAUSS.len();
const PLACES: Places = places(0, 1.0);
const WEIGHTS: Places = places(1, 0.0);

/// A column of the rule, and what stands at the end of a panel.
const fn places(column: usize, end: f64) -> Places {
    let mut places = Places::ZERO;
    let mut i = 0;
    while i < GAUSS.len() {
        places.0[i] = GAUSS[i][column];
        i += 1;
    }
    places.0[END] = end;
    places
}

/// In whole registers.
#[inline(always)]
fn registers(places: Places) -> [Four; REGISTERS] {
    let [a, b, c, d, e, f, g, h, i, j, k, l] = places.0;
    [Four::new([a, b, c, d]), Four::new([e, f, g, h]), Four::new([i, j, k, l])]
}

/// The mean over a panel.
#[inline(always)]
fn weighted(values: [Four; REGISTERS]) -> f64 {
    let mut sum = Four::ZERO;
    for (values, weights) in values.into_iter().zip(registers(WEIGHTS)) {
        sum = sum + values * weights;
    }
    sum.sum()
}

/// What a squared signal, which turns twice as fast as its fastest block, turns by in a panel for which the ten-point rule is exact to
/// rounding: of the 20th derivative of the square it leaves (10!)⁴/(21 (20!)³) 4.6²⁰, which is 10⁻¹⁷.
const TURN_OF_A_PANEL: f64 = 4.6;

/// Panels beyond which what has died away gets no more of them.
const MANY_PANELS: f64 = 20_000.0;
/// decay·t at which a block has died away to rounding.
const DIED_AWAY: f64 = 40.0;

/// How many panels make the rule exact to rounding over `duration`.
pub(crate) fn panels(blocks: &[Block], duration: f64) -> usize {
    let wanted = |block: &Block| {
        let panels = 2.0 * block.radius * duration / TURN_OF_A_PANEL;
        if block.decay * duration > DIED_AWAY { panels.min(MANY_PANELS) } else { panels }
    };
    blocks.iter().map(wanted).fold(1.0, f64::max).ceil() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integrals of a signal about a place, node by node, each from the start.
    fn integrals(blocks: &[Block], start: &[Phase], rest: Parabola, duration: f64, place: f64) -> [f64; 3] {
        let count = 2 * panels(blocks, duration);
        let h = duration / count as f64;
        let mut sum = [0.0; 3];
        for (panel, [x, weight]) in (0..count).flat_map(|panel| GAUSS.map(|node| (panel, node))) {
            let t = (panel as f64 + x) * h;
            let [value, rate, ..] = super::super::signals::motion(blocks, start, rest, |k| blocks[k].kernel(t), t);
            let value = value - place;
            let parts = [value, value * value, rate * rate];
            sum.iter_mut().zip(parts).for_each(|(sum, part)| *sum += weight * h * part);
        }
        sum
    }

    #[test]
    fn signals_side_by_side_have_the_integrals_that_each_has_alone() {
        let matrices =
            [[0.0, 1.0, -9e4, -3.0], [0.0, 1.0, -25.0, -10.0], [0.0, 1.0, -9.0, -40.0], [0.0, 1.0, 0.0, 0.0]];
        let blocks = matrices.map(Block::new);
        let shares = [0.3, -1.2, 0.7, 0.1].map(|x| Phase { value: x, rate: 40.0 * x * x });
        let rest = Parabola { p0: 0.2, p1: -1.0, p2: -4.9 };
        let mut panels = Panels::default();
        for duration in [1e-6, 3e-3, 0.02, 0.7] {
            panels.clear();
            panels.add(shares.iter().copied(), Parabola::default());
            panels.add(shares.iter().copied(), rest);
            let of = panels.integrate(&blocks, duration);
            for (signal, rest) in of.iter().zip([Parabola::default(), rest]) {
                let alone = integrals(&blocks, &shares, rest, duration, signal.place);
                for ((one, other), size) in signal.integrals.iter().zip(alone).zip([duration, duration, alone[2]]) {
                    assert!((one - other).abs() <= 1e-13 * size, "{duration}: {one} for {other}");
                }
            }
            // The rate of s′ is s″.
            let mut rates = shares;
            rates.iter_mut().zip(&blocks).for_each(|(share, block)| {
                *share = Phase { value: share.rate, rate: block.acceleration(*share).value };
            });
            let [.., square] = integrals(&blocks, &rates, Parabola::default(), duration, 0.0);
            assert!((of[0].acceleration_square / square - 1.0).abs() < 1e-12);
        }
    }
}
