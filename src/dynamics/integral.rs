//! Integrals over a segment, in closed form.
//!
//! A signal is Σₖ sₖ with zₖ = (sₖ, sₖ′) obeying zₖ′ = Cₖ zₖ. For two blocks the integral of a product is a difference of
//! end values, ∫ sₖ sₗ dt = [zₖᵀ P zₗ] with CₖᵀP + P Cₗ = e₁e₁ᵀ: no sampling. Where two eigenvalues nearly cancel
//! (undamped motion) that P is large and the difference loses digits; then the flow itself is integrated, by Gauss-Legendre
//! panels so short that they are exact to rounding.

use super::block::{Block, Phase, pairs};
use super::flow::Parabola;
use super::lyapunov::Lyapunov;

/// Closed forms for the integrals of one signal and of its rate.
pub(crate) struct Forms {
    pairs: Vec<Pair>,
    /// ∫ s dt = −([s′] + 2a [s])/b, block by block: 2a/b and 1/b.
    linear: Vec<[f64; 2]>,
}

/// P for the product of the values, and of the rates, of two blocks (both orders of the pair counted).
struct Pair {
    first: usize,
    second: usize,
    kind: PairKind,
}

enum PairKind {
    Damped {
        value: [f64; 4],
        rate: [f64; 4],
    },
    /// One undamped block with itself: ω².
    Neutral {
        square: f64,
    },
}

/// ∫ s, ∫ s², ∫ s′² of a signal without its constant.
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

/// Where |λₖ + λₗ| is below this share of the faster one, the closed form would lose more than three digits.
pub(crate) const NEARLY_NEUTRAL: f64 = 4e-4;

impl Forms {
    /// The closed forms, or `None` where one of them would lose its digits.
    pub(crate) fn new(blocks: &[Block], driven: bool) -> Option<Self> {
        let of = |(first, second): (usize, usize)| {
            let kind = if first == second && driven && first + 1 == blocks.len() {
                PairKind::Neutral { square: blocks[first].determinant }
            } else {
                pair(&blocks[first], &blocks[second])?.counted(first != second)
            };
            Some(Pair { first, second, kind })
        };
        let pairs = pairs(blocks.len()).map(of).collect::<Option<Vec<_>>>()?;
        let linear =
            blocks.iter().map(|block| [2.0 * block.decay / block.determinant, 1.0 / block.determinant]).collect();
        Some(Self { pairs, linear })
    }

    /// The integrals of a signal between two sets of phases, `duration` apart.
    #[inline]
    pub(crate) fn between(&self, start: &[Phase], end: &[Phase], duration: f64, displacement: bool) -> Integrals {
        let mut sum = Integrals::default();
        for Pair { first, second, kind } in &self.pairs {
            let (x0, y0, x1, y1) = (start[*first], start[*second], end[*first], end[*second]);
            match kind {
                PairKind::Damped { value, rate } => {
                    sum.rate_square += form(rate, x1, y1) - form(rate, x0, y0);
                    if displacement {
                        sum.square += form(value, x1, y1) - form(value, x0, y0);
                    }
                }
                PairKind::Neutral { square } => {
                    let energy = (square * x0.value * x0.value + x0.rate * x0.rate) * duration;
                    let swing = x1.value * x1.rate - x0.value * x0.rate;
                    sum.rate_square += 0.5 * (energy + swing);
                    sum.square += 0.5 * (energy - swing) / square;
                }
            }
        }
        if displacement {
            for ((x0, x1), [twice, inverse]) in start.iter().zip(end).zip(&self.linear) {
                sum.value -= (x1.rate - x0.rate) * inverse + (x1.value - x0.value) * twice;
            }
        }
        sum
    }
}

/// Σ z and Σ zₖ zₗᵀ of a signal's phases over several runs of equal length, for every pair of blocks k ≤ l.
#[derive(Debug, Clone, Default)]
pub(crate) struct PhaseMoments {
    /// Blocks in order: value, rate.
    pub(crate) first: Vec<[f64; 2]>,
    /// By [`pairs`] of blocks.
    pub(crate) second: Vec<[f64; 4]>,
}

impl Forms {
    /// The integrals of a signal summed over several runs, each `duration` long.
    pub(crate) fn summed(
        &self,
        start: &PhaseMoments,
        end: &PhaseMoments,
        duration: f64,
        displacement: bool,
    ) -> Integrals {
        let mut sum = Integrals::default();
        for ((Pair { kind, .. }, m0), m1) in self.pairs.iter().zip(&start.second).zip(&end.second) {
            match kind {
                PairKind::Damped { value, rate } => {
                    sum.rate_square += contract(rate, m1) - contract(rate, m0);
                    if displacement {
                        sum.square += contract(value, m1) - contract(value, m0);
                    }
                }
                PairKind::Neutral { square } => {
                    let energy = (square * m0[0] + m0[3]) * duration;
                    let swing = m1[1] - m0[1];
                    sum.rate_square += 0.5 * (energy + swing);
                    sum.square += 0.5 * (energy - swing) / square;
                }
            }
        }
        if displacement {
            for ((x0, x1), [twice, inverse]) in start.first.iter().zip(&end.first).zip(&self.linear) {
                sum.value -= (x1[1] - x0[1]) * inverse + (x1[0] - x0[0]) * twice;
            }
        }
        sum
    }
}

fn contract(p: &[f64; 4], moment: &[f64; 4]) -> f64 {
    p[0] * moment[0] + p[1] * moment[1] + p[2] * moment[2] + p[3] * moment[3]
}

impl PairKind {
    fn counted(self, twice: bool) -> Self {
        match self {
            Self::Damped { value, rate } if twice => {
                Self::Damped { value: value.map(|p| 2.0 * p), rate: rate.map(|p| 2.0 * p) }
            }
            other => other,
        }
    }
}

#[inline]
fn form(p: &[f64; 4], x: Phase, y: Phase) -> f64 {
    x.value * (p[0] * y.value + p[1] * y.rate) + x.rate * (p[2] * y.value + p[3] * y.rate)
}

/// Solves CₖᵀP + P Cₗ = e₁e₁ᵀ (values) and = e₂e₂ᵀ (rates).
fn pair(k: &Block, l: &Block) -> Option<PairKind> {
    if !k.keeps_apart(l, NEARLY_NEUTRAL) {
        return None;
    }
    let companion = |block: &Block| [0.0, 1.0, -block.determinant, -2.0 * block.decay];
    let equation = Lyapunov::new(companion(k), companion(l));
    Some(PairKind::Damped { value: equation.solve([1.0, 0.0, 0.0, 0.0])?, rate: equation.solve([0.0, 0.0, 0.0, 1.0])? })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms_agree_with_quadrature() {
        let blocks =
            [Block::new([0.0, 1.0, -1000.0, -3.2]), Block::new([0.0, 1.0, -21000.0, -45.0]), Block::harmonic(17.0)];
        let start =
            [Phase { value: 0.03, rate: -0.4 }, Phase { value: -0.002, rate: 0.7 }, Phase { value: 0.01, rate: 0.05 }];
        let duration = 0.13;
        let forms = Forms::new(&blocks, true).unwrap();
        let at = |t: f64| -> Vec<Phase> { blocks.iter().zip(start).map(|(b, s)| b.advance(s, b.kernel(t))).collect() };
        let closed = forms.between(&start, &at(duration), duration, true);
        let mut sum = Integrals::default();
        let count = panels(150.0, duration);
        for panel in 0..count {
            for [x, w] in GAUSS {
                let h = duration / count as f64;
                let phases = at((panel as f64 + x) * h);
                let value: f64 = phases.iter().map(|p| p.value).sum();
                let rate: f64 = phases.iter().map(|p| p.rate).sum();
                sum.value += w * h * value;
                sum.square += w * h * value * value;
                sum.rate_square += w * h * rate * rate;
            }
        }
        assert!((closed.value - sum.value).abs() < 1e-15);
        assert!((closed.square / sum.square - 1.0).abs() < 1e-12);
        assert!((closed.rate_square / sum.rate_square - 1.0).abs() < 1e-12);
    }
}
