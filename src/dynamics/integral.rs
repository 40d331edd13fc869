//! Integrals of a signal over a segment, by Gauss-Legendre panels so short that they are exact to rounding: for motion
//! without damping, where the closed forms of [`super::gains`] lose their digits.

use super::block::{Block, Phase};
use super::budget;
use super::flow::Parabola;

/// ∫ s, ∫ s², ∫ s′² of a signal.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Integrals {
    pub(crate) value: f64,
    pub(crate) square: f64,
    pub(crate) rate_square: f64,
}

impl Integrals {
    /// The same of the signal plus a constant.
    pub(crate) fn offset(self, constant: f64, duration: f64) -> Self {
        Self {
            value: self.value + constant * duration,
            square: self.square + constant * (2.0 * self.value + constant * duration),
            rate_square: self.rate_square,
        }
    }
}

/// Integrals of a signal with its parabola, by panels that are exact to rounding.
pub(crate) fn quadrature(blocks: &[Block], start: &[Phase], rest: Parabola, duration: f64) -> Integrals {
    let radius = blocks.iter().fold(0.0_f64, |largest, block| largest.max(block.radius));
    let count = panels(radius, duration);
    let h = duration / count as f64;
    let mut sum = Integrals::default();
    for panel in 0..count {
        if budget::spend(1) {
            break;
        }
        for [x, weight] in GAUSS {
            let t = (panel as f64 + x) * h;
            let (mut value, mut rate) = (rest.at(t), rest.rate(t));
            for (block, phase) in blocks.iter().zip(start) {
                let now = block.advance(*phase, block.kernel(t));
                value += now.value;
                rate += now.rate;
            }
            sum.value += weight * h * value;
            sum.square += weight * h * value * value;
            sum.rate_square += weight * h * rate * rate;
        }
    }
    sum
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
fn panels(radius: f64, duration: f64) -> usize {
    // A squared signal turns twice as fast; a cap, since far beyond it the fast blocks have died away.
    ((2.0 * radius * duration / 3.0).ceil()).clamp(1.0, 20_000.0) as usize
}
