//! Taylor series of a flow's signals, from tables that are built with the flow.
//!
//! A block's share is value·A(t) + rate·B(t), where A and B belong to the block alone. With their coefficients tabulated,
//! in units of the fastest block's time 1/ρ, a signal's series is a product of rows: no recurrence, one pass, any window.

use std::borrow::Borrow;

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::{Lanes, WIDTH};
use crate::contact_state::bank::Phases;
use crate::contact_state::block::{Block, Phase};

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
    /// The largest radius of several blocks and all behind them, 1/s.
    pub(crate) fastest: Vec<f64>,
    terms: Vec<Terms>,
    radii: Vec<Radii>,
}

/// One block's.
#[derive(Debug)]
struct Terms {
    /// Coefficients of (ρt)ʲ in A and in B.
    value: [f64; PADDED],
    rate: [f64; PADDED],
}

/// Those of several blocks.
#[derive(Debug)]
struct Radii {
    /// radius/ρ.
    radius: Four,
    /// (radius/ρ)¹²/12!.
    left_out: Four,
}

/// Shares of several blocks in a signal from now on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shares {
    pub(crate) now: Phases,
    /// Bounds as in [`Block::amplitude`].
    pub(crate) amplitude: Four,
}

impl Shares {
    pub(crate) const NONE: Self = Self { now: Phases::ZERO, amplitude: Four::ZERO };
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
    /// Of these blocks, in the room of this one.
    pub(crate) fn of(self, blocks: &[Block]) -> Self {
        let Self { mut fastest, mut terms, mut radii, .. } = self;
        let most = |blocks: &[Block]| blocks.iter().fold(0.0_f64, |most, block| most.max(block.radius));
        fastest.clear();
        fastest.extend(blocks.chunks(WIDTH).map(most));
        for k in (1..fastest.len()).rev() {
            fastest[k - 1] = fastest[k - 1].max(fastest[k]);
        }
        let pace = fastest.first().copied().filter(|fastest| *fastest > 0.0).unwrap_or(1.0);
        radii.clear();
        radii.extend(blocks.chunks(WIDTH).map(|blocks| Radii::new(blocks, pace)));
        terms.clear();
        terms.extend(blocks.iter().map(|block| Terms::new(block, pace)));
        Self { pace, unit: 1.0 / pace, fastest, terms, radii }
    }

    /// Coefficients `FROM` to `FROM` + 4 `MANY` of Σ shares, in powers of ρt.
    #[inline(always)]
    pub(crate) fn expand<const FROM: usize, const MANY: usize>(
        &self,
        shares: impl Iterator<Item: Borrow<Phases>>,
    ) -> [[f64; WIDTH]; MANY] {
        let mut sums = [Four::ZERO; MANY];
        for (terms, share) in self.terms.chunks(WIDTH).zip(shares) {
            for (lane, terms) in terms.iter().enumerate() {
                terms.add::<FROM, MANY>(share.borrow().at(lane), &mut sums);
            }
        }
        sums.map(Four::array)
    }

    /// All of them over a window of ρΔ with `twelfth` = (ρΔ)¹², leaving out the blocks too fast for it.
    #[inline(always)]
    pub(crate) fn expand_slow(&self, shares: &[Shares], twelfth: f64) -> [[f64; WIDTH]; TERMS / WIDTH] {
        let mut sums = [Four::ZERO; TERMS / WIDTH];
        for ((terms, radii), share) in self.terms.chunks(WIDTH).zip(&self.radii).zip(shares) {
            for (lane, terms) in terms.iter().enumerate() {
                if radii.left_out.at(lane) * twelfth > TOO_FAST {
                    continue;
                }
                terms.add::<0, { TERMS / WIDTH }>(share.now.at(lane), &mut sums);
            }
        }
        sums.map(Four::array)
    }

    /// Over a window: what is left out of Σ shares beyond degree eleven, and with `leave_fast` the blocks too fast for it;
    /// bounds on what is expanded.
    #[inline(always)]
    pub(crate) fn bounds(&self, shares: &[Shares], span: &Span, leave_fast: bool) -> Bounds {
        let (length, twelfth) = (span.powers[1], span.powers[TERMS]);
        let limit = if leave_fast { TOO_FAST } else { f64::INFINITY };
        let (mut left_out, mut moving, mut largest) = (Four::ZERO, Four::ZERO, Four::ZERO);
        for (radii, Shares { amplitude, .. }) in self.radii.iter().zip(shares) {
            let share = radii.left_out * twelfth;
            largest = largest.zip(share, |a, b| if b > a { b } else { a });
            left_out = left_out + *amplitude * share.map(|share| if share > limit { 1.0 } else { share });
            let moves = *amplitude * (1.0 + radii.radius * length);
            moving = moving + moves.zip(share, |moves, share| if share > limit { 0.0 } else { moves });
        }
        Bounds { left_out: left_out.sum(), moving: moving.sum(), leaves_blocks: largest.largest() > limit }
    }

    /// A bound on the second derivative in σ = t/Δ of Σ shares/σ^`order`, given ρΔ: that of p/σʲ is below 2/(j + 2)! of p's
    /// derivative of order j + 2.
    #[inline(always)]
    pub(crate) fn bend(&self, shares: &[Shares], length: f64, order: usize) -> f64 {
        let each = self.radii.iter().zip(shares).map(|(radii, Shares { amplitude, .. })| {
            let x = radii.radius * length;
            let square = *amplitude * (x * x);
            match order {
                0 => square,
                1 => square * x * (1.0 / 3.0),
                2 => square * (x * x) * (1.0 / 12.0),
                _ => square * (x * x * x) * (1.0 / 60.0),
            }
        });
        each.fold(Four::ZERO, |sum, bend| sum + bend).sum()
    }
}

impl Radii {
    fn new(blocks: &[Block], pace: f64) -> Self {
        let radius = Four::padded(blocks.iter().map(|block| block.radius / pace));
        let r4 = (radius * radius) * (radius * radius);
        Self { radius, left_out: r4 * r4 * r4 * LEFT_OUT }
    }
}

impl Terms {
    fn new(block: &Block, pace: f64) -> Self {
        let unit = 1.0 / pace;
        let [value, rate] = taylor::<TERMS>(block, unit)
            .map(|known| std::array::from_fn(|j| known.get(j).copied().unwrap_or_default()));
        Self { value, rate: rate.map(|s: f64| s * unit) }
    }

    #[inline(always)]
    fn add<const FROM: usize, const MANY: usize>(&self, share: Phase, sums: &mut [Four; MANY]) {
        for i in 0..MANY {
            let four = |terms: &[f64; PADDED]| Four::new([0, 1, 2, 3].map(|lane| terms[FROM + WIDTH * i + lane]));
            sums[i] = sums[i] + (four(&self.value) * share.value + four(&self.rate) * share.rate);
        }
    }
}

/// Coefficients of (t/unit)ʲ in A and in B/unit: A′ = −b B and B′ = A − 2a B.
pub(crate) fn taylor<const N: usize>(block: &Block, unit: f64) -> [[f64; N]; 2] {
    let (p, q) = (-2.0 * block.decay * unit, -block.determinant * (unit * unit));
    let (mut value, mut rate) = ([0.0; N], [0.0; N]);
    (value[0], rate[1]) = (1.0, 1.0);
    for j in 1..N - 1 {
        let inverse = 1.0 / (j + 1) as f64;
        value[j + 1] = q * rate[j] * inverse;
        rate[j + 1] = (p * rate[j] + value[j]) * inverse;
    }
    [value, rate]
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
