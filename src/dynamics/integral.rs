//! Integrals of a signal over a segment, by Gauss-Legendre panels so short that they are exact to rounding: for motion
//! without damping and for brief stretches, where the closed forms of [`super::gains`] lose their digits.

use super::Sums;
use super::bank::Bank;
use super::block::{Block, Kernel, Phase};
use super::budget;
use super::parabola::Parabola;

/// Times the slowest turn of a contact state: stretches shorter than this leave next to nothing of the differences of end values
/// that the closed forms are made of.
pub(crate) const BRIEF: f64 = 0.05;

/// The measures of a signal with its parabola, by panels that are exact to rounding.
pub(crate) fn quadrature(blocks: &[Block], bank: &Bank, start: &[Phase], rest: Parabola, duration: f64) -> Sums {
    // About a place on the way: the mean would do as well.
    let place = start.iter().fold(rest.p0, |sum, phase| sum + phase.value);
    sums(place, duration, integrals(blocks, bank, start, rest, duration, place))
}

/// The measures of a signal from its integrals about a place.
pub(crate) fn sums(place: f64, duration: f64, [moved, square, velocity_square]: [f64; 3]) -> Sums {
    Sums {
        duration,
        displacement: place * duration + moved,
        deviation_square: (square - moved * moved / duration).max(0.0),
        velocity_square,
    }
}

/// A signal to be integrated.
pub(crate) struct Integrand {
    /// Its shares, at the start.
    pub(crate) shares: Vec<Phase>,
    pub(crate) rest: Parabola,
    pub(crate) place: f64,
}

/// The integrals of several signals over a few panels, which share the kernels of their nodes: shares move on from panel to panel.
pub(crate) fn together(blocks: &[Block], bank: &Bank, signals: &mut [Integrand], duration: f64) -> Vec<[f64; 3]> {
    let (count, places) = (panels(blocks, duration), blocks.len());
    let h = duration / count as f64;
    let mut kernels = vec![Kernel::NONE; (GAUSS.len() + 1) * places];
    let nodes = GAUSS.iter().map(|[x, _]| *x).chain([1.0]);
    kernels.chunks_exact_mut(places).zip(nodes).for_each(|(kernels, x)| bank.list(blocks, x * h, kernels));
    let (within, end) = kernels.split_at(GAUSS.len() * places);
    let mut sums = vec![[0.0; 3]; signals.len()];
    for (signal, sum) in signals.iter_mut().zip(&mut sums) {
        for panel in 0..count {
            if budget::spend(1) {
                break;
            }
            for ([x, weight], kernels) in GAUSS.iter().zip(within.chunks_exact(places)) {
                let t = (panel as f64 + x) * h;
                add_node(sum, weight * h, blocks, kernels, &signal.shares, about(signal.rest, signal.place, t));
            }
            let moved = blocks.iter().zip(&mut signal.shares).zip(end);
            moved.for_each(|((block, phase), kernel)| *phase = block.advance(*phase, *kernel));
        }
    }
    sums
}

/// ∫ (s − place), ∫ (s − place)² and ∫ s′² of a signal.
pub(crate) fn integrals(
    blocks: &[Block],
    bank: &Bank,
    start: &[Phase],
    rest: Parabola,
    duration: f64,
    place: f64,
) -> [f64; 3] {
    let count = panels(blocks, duration);
    let mut kernels = vec![Kernel::NONE; blocks.len()];
    let h = duration / count as f64;
    let mut sum = [0.0; 3];
    for panel in 0..count {
        if budget::spend(1) {
            break;
        }
        for [x, weight] in GAUSS {
            let t = (panel as f64 + x) * h;
            bank.list(blocks, t, &mut kernels);
            add_node(&mut sum, weight * h, blocks, &kernels, start, about(rest, place, t));
        }
    }
    sum
}

/// What is left of a signal beside its shares, about a place.
fn about(rest: Parabola, place: f64, t: f64) -> Phase {
    Phase { value: rest.at(t) - place, rate: rest.rate(t) }
}

/// What a node adds to the integrals: the `shares` moved on by its kernels, upon the `rest` there.
#[inline]
fn add_node(sum: &mut [f64; 3], weight: f64, blocks: &[Block], kernels: &[Kernel], shares: &[Phase], rest: Phase) {
    let Phase { mut value, mut rate } = rest;
    for ((block, phase), kernel) in blocks.iter().zip(shares).zip(kernels) {
        let now = block.advance(*phase, *kernel);
        value += now.value;
        rate += now.rate;
    }
    sum[0] += weight * value;
    sum[1] += weight * value * value;
    sum[2] += weight * rate * rate;
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

/// How many panels make the ten-point rule exact to rounding over `duration`: radius·panel ≤ 1.5.
pub(crate) fn panels(blocks: &[Block], duration: f64) -> usize {
    let radius = blocks.iter().fold(0.0_f64, |largest, block| largest.max(block.radius));
    // A squared signal turns twice as fast; a cap, since far beyond it the fast blocks have died away.
    ((2.0 * radius * duration / 3.0).ceil()).clamp(1.0, 20_000.0) as usize
}
