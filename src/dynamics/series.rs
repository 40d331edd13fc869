//! Taylor series of a flow's signals, from tables that are built with the flow.
//!
//! A block's share is value·A(t) + rate·B(t), where A and B belong to the block alone. With their coefficients tabulated,
//! in units of the fastest block's time 1/ρ, a signal's series is a product of rows: no recurrence, one pass, any window.

use super::block::{Block, Phase};
use super::lanes::Lanes;

/// Coefficients kept: degree eleven.
const TERMS: usize = 12;
/// Length of a table: zeros behind, so that a shifted one can be read.
const PADDED: usize = 16;
/// 1/12!.
const LEFT_OUT: f64 = 1.0 / 479_001_600.0;

/// The series of all blocks of a flow.
#[derive(Debug, Default)]
pub(crate) struct Series {
    /// ρ, 1/s: largest radius of a block; 1 where nothing moves.
    pub(crate) pace: f64,
    /// 1/ρ.
    pub(crate) unit: f64,
    /// Some block is near critical damping: its amplitude depends on the window.
    pub(crate) near_critical: bool,
    /// The blocks, fastest first, with the squares of their radii, 1/s².
    pub(crate) by_radius: Vec<(usize, f64)>,
    terms: Vec<Terms>,
}

/// One block's.
#[derive(Debug)]
struct Terms {
    /// Coefficients of (ρt)ʲ in A and in B.
    value: [f64; PADDED],
    rate: [f64; PADDED],
    /// radius/ρ.
    radius: f64,
    /// (radius/ρ)¹²/12!.
    left_out: f64,
}

/// A block whose Taylor polynomial may leave out this share of its amplitude is left out itself.
const TOO_FAST: f64 = 0.5;

/// What an expansion leaves out.
pub(crate) struct Bounds {
    pub(crate) left_out: f64,
    /// On values and slopes of what is expanded.
    pub(crate) moving: f64,
    /// Whole blocks are left out.
    pub(crate) leaves_blocks: bool,
}

impl Series {
    pub(crate) fn new(blocks: &[Block]) -> Self {
        let fastest = blocks.iter().fold(0.0_f64, |fastest, block| fastest.max(block.radius));
        let pace = if fastest > 0.0 { fastest } else { 1.0 };
        let unit = 1.0 / pace;
        let terms = blocks.iter().map(|block| Terms::new(block, pace)).collect();
        let mut by_radius: Vec<(usize, f64)> =
            blocks.iter().map(|block| block.radius * block.radius).enumerate().collect();
        by_radius.sort_by(|a, b| b.1.total_cmp(&a.1));
        Self { pace, unit, near_critical: blocks.iter().any(Block::is_near_critical), by_radius, terms }
    }

    /// Coefficients `FROM` to `FROM` + N of Σ shares, in powers of ρt.
    #[inline(always)]
    pub(crate) fn expand<const FROM: usize, const N: usize>(&self, shares: impl Iterator<Item = Phase>) -> [f64; N] {
        let mut sum = [0.0; N];
        for (terms, share) in self.terms.iter().zip(shares) {
            for j in 0..N {
                sum[j] += share.value * terms.value[j + FROM] + share.rate * terms.rate[j + FROM];
            }
        }
        sum
    }

    /// The same over a window of ρΔ with `twelfth` = (ρΔ)¹², leaving out the blocks too fast for it.
    #[inline(always)]
    pub(crate) fn expand_slow(&self, shares: &[Phase], twelfth: f64) -> [f64; TERMS] {
        let mut sum = [0.0; TERMS];
        for (terms, share) in self.terms.iter().zip(shares) {
            if terms.left_out * twelfth > TOO_FAST {
                continue;
            }
            for j in 0..TERMS {
                sum[j] += share.value * terms.value[j] + share.rate * terms.rate[j];
            }
        }
        sum
    }

    /// Over a window, with `amplitudes` as in [`Block::amplitude`]: what is left out of Σ shares beyond degree eleven, and with
    /// `leave_fast` the blocks too fast for it; bounds on what is expanded.
    #[inline(always)]
    pub(crate) fn bounds(&self, amplitudes: &[f64], span: &Span, leave_fast: bool) -> Bounds {
        let (length, twelfth) = (span.powers[1], span.powers[TERMS]);
        let mut bounds = Bounds { left_out: 0.0, moving: 0.0, leaves_blocks: false };
        for (terms, amplitude) in self.terms.iter().zip(amplitudes) {
            let share = terms.left_out * twelfth;
            if leave_fast && share > TOO_FAST {
                bounds.left_out += amplitude;
                bounds.leaves_blocks = true;
            } else {
                bounds.left_out += amplitude * share;
                bounds.moving += amplitude * (1.0 + terms.radius * length);
            }
        }
        bounds
    }

    /// A bound on the second derivative in σ = t/Δ of Σ shares/σ^`order`, given ρΔ: that of p/σʲ is below 2/(j + 2)! of p's
    /// derivative of order j + 2.
    pub(crate) fn bend(&self, amplitudes: &[f64], length: f64, order: usize) -> f64 {
        self.terms.iter().zip(amplitudes).fold(0.0, |sum, (terms, amplitude)| {
            let x = terms.radius * length;
            let higher = match order {
                0 => 1.0,
                1 => x * (1.0 / 3.0),
                2 => x * x * (1.0 / 12.0),
                _ => x * x * x * (1.0 / 60.0),
            };
            sum + amplitude * (x * x) * higher
        })
    }
}

impl Terms {
    /// sⱼ₊₂ = (−2a sⱼ₊₁ − b sⱼ/(j + 1))/(j + 2) for the coefficients of a share.
    fn new(block: &Block, pace: f64) -> Self {
        let (p, q) = (-2.0 * block.decay / pace, -block.determinant / (pace * pace));
        let series = |value: f64, rate: f64| {
            let mut s = [0.0; PADDED];
            (s[0], s[1]) = (value, rate);
            for j in 0..TERMS - 2 {
                s[j + 2] = (p * s[j + 1] + q * s[j] / (j + 1) as f64) / (j + 2) as f64;
            }
            s
        };
        let radius = block.radius / pace;
        let r4 = (radius * radius) * (radius * radius);
        let rate = series(0.0, 1.0).map(|s| s / pace);
        Self { value: series(1.0, 0.0), rate, radius, left_out: r4 * r4 * r4 * LEFT_OUT }
    }
}

/// The stretch of time of a window.
pub(crate) struct Span {
    /// Seconds from the segment's start.
    pub(crate) from: f64,
    /// Δ, s.
    pub(crate) length: f64,
    /// Powers of ρΔ.
    pub(crate) powers: [f64; 16],
}

impl Span {
    #[inline(always)]
    pub(crate) fn new(series: &Series, from: f64, length: f64) -> Self {
        Self { from, length, powers: powers(series.pace * length) }
    }
}

/// x⁰ … x¹³, and zeros: in pairs, as they are read, so that no pair is put together from two stores.
#[inline(always)]
fn powers(x: f64) -> [f64; PADDED] {
    let mut powers = [0.0; PADDED];
    let pair = Lanes([1.0, x]);
    let (x2, x4) = (x * x, (x * x) * (x * x));
    let steps = [1.0, x2, x4, x4 * x2, x4 * x4, (x4 * x4) * x2, (x4 * x4) * x4];
    for (place, step) in powers.as_chunks_mut::<2>().0.iter_mut().zip(steps) {
        *place = (step * pair).0;
    }
    powers
}
