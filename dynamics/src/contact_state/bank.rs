//! The blocks of a flow, side by side: what is done to one of them is done to several at once.
//!
//! Most blocks turn: they need e^(−at), sin and cos of √(−d) t, which are computed together; one exponential alone is a turn by nothing.
//! The few others are computed by themselves afterwards.

use crate::arithmetic::complexes::Complexes;
use crate::arithmetic::elementary::{exp_lanes, sin_cos_lanes};
use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::{Lanes, WIDTH};
use crate::contact_state::block::{Block, Kernel, Phase};

/// The blocks of a flow.
#[derive(Debug, Default)]
pub(crate) struct Bank {
    /// How many there are.
    pub(crate) count: usize,
    pub(crate) blocks: Vec<Blocks>,
    /// Blocks that neither turn nor are one exponential alone.
    others: Vec<usize>,
    /// Blocks near critical damping, whose bounds depend on the time that they are to hold.
    pub(crate) near_critical: Vec<usize>,
}

/// Several blocks; places without one hold zeros.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Blocks {
    pub(crate) decay: Four,
    /// The decay of those that turn, or are one exponential alone.
    fades: Four,
    determinant: Four,
    discriminant: Four,
    /// √|d| of those that turn, and its inverse.
    pub(crate) root: Four,
    inverse_root: Four,
    /// −1 of those that turn.
    turns: Four,
    /// d of those that do not.
    grows: Four,
    /// 1 where there is no block.
    pub(crate) spare: Four,
    /// 1/√|d|, but of blocks near critical damping.
    spread: Four,
    pub(crate) radius: Four,
    /// Its square.
    pub(crate) square: Four,
}

/// Shares of several blocks in a signal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Phases {
    pub(crate) value: Four,
    pub(crate) rate: Four,
}

impl Phases {
    pub(crate) const ZERO: Self = Self { value: Four::ZERO, rate: Four::ZERO };

    /// That of one block.
    #[inline(always)]
    pub(crate) fn at(&self, lane: usize) -> Phase {
        Phase { value: self.value.at(lane), rate: self.rate.at(lane) }
    }
}

/// Kernels of several blocks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kernels {
    c: Four,
    s: Four,
    turn: Four,
}

/// What of them moves shares: the turn of a block is but its S in another unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Transfer {
    c: Four,
    s: Four,
}

impl Transfer {
    /// After no time.
    pub(crate) const NONE: Self = Kernels::NONE.transfer();
}

impl Kernels {
    /// After no time.
    pub(crate) const NONE: Self = Self { c: Four::new([1.0; WIDTH]), s: Four::ZERO, turn: Four::ZERO };

    /// That of one block.
    #[inline(always)]
    pub(crate) fn at(&self, lane: usize) -> Kernel {
        Kernel { c: self.c.at(lane), s: self.s.at(lane), turn: self.turn.at(lane) }
    }

    #[inline(always)]
    pub(crate) const fn transfer(&self) -> Transfer {
        Transfer { c: self.c, s: self.s }
    }

    /// e^(λt) of blocks that turn, λ the eigenvalue with a positive imaginary part.
    #[inline(always)]
    pub(crate) fn turned(&self) -> Complexes {
        Complexes { re: self.c, im: self.turn }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, kernel: Kernel) {
        self.c.set(lane, kernel.c);
        self.s.set(lane, kernel.s);
        self.turn.set(lane, kernel.turn);
    }
}

/// (x, y) of several blocks, one after the other; zero where there is no block.
pub(crate) type Coordinates = [f64; 2 * WIDTH];

/// x of several blocks, and y.
#[inline(always)]
pub(crate) fn apart(&[a, b, c, d, e, f, g, h]: &Coordinates) -> [Four; 2] {
    [Four::new([a, c, e, g]), Four::new([b, d, f, h])]
}

/// Several blocks with their matrices, which propagate coordinates (x, y): x′ = c x + k (px + qy), y′ = c y + k (rx + sy), with k the S
/// of their kernels, and with p + a and s + a for p and s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Propagator {
    matrix: [Four; 4],
    /// 1 where k is the turn.
    alone: Four,
    /// 1 where it is S.
    damped: Four,
}

/// Without damping a turn is a turn, and no length comes or goes.
pub(crate) fn turns_alone([_, q, r, _]: [f64; 4], decay: f64) -> bool {
    decay == 0.0 && q > 0.0 && q == -r
}

impl Propagator {
    /// Of the blocks that have a matrix, in the `room` of others.
    pub(crate) fn of(mut room: Vec<Self>, matrices: &[[f64; 4]], blocks: &[Block]) -> Vec<Self> {
        room.clear();
        room.extend(matrices.chunks(WIDTH).zip(blocks.chunks(WIDTH)).map(|(own, blocks)| Self::new(own, blocks)));
        room
    }

    fn new(matrices: &[[f64; 4]], blocks: &[Block]) -> Self {
        let mut lanes = [[0.0; WIDTH]; 6];
        for (lane, (&matrix, &Block { decay, .. })) in matrices.iter().zip(blocks).enumerate() {
            let [p, q, r, s] = matrix;
            let entries = if turns_alone(matrix, decay) {
                [0.0, 1.0, -1.0, 0.0, 1.0, 0.0]
            } else {
                [p + decay, q, r, s + decay, 0.0, 1.0]
            };
            lanes.iter_mut().zip(entries).for_each(|(lanes, entry)| lanes[lane] = entry);
        }
        let [p, q, r, s, alone, damped] = lanes.map(Four::new);
        Self { matrix: [p, q, r, s], alone, damped }
    }

    /// Coordinates, two a block, after the time of `kernels`.
    #[inline(always)]
    pub(crate) fn advance(&self, kernels: &Kernels, coordinates: &Coordinates) -> Coordinates {
        let [x, y] = apart(coordinates);
        let [p, q, r, s] = self.matrix;
        let k = kernels.turn * self.alone + kernels.s * self.damped;
        let x_end = (kernels.c * x + k * (p * x + q * y)).array();
        let y_end = (kernels.c * y + k * (r * x + s * y)).array();
        let ([a, c, e, g], [b, d, f, h]) = (x_end, y_end);
        [a, b, c, d, e, f, g, h]
    }
}

impl Blocks {
    fn new(blocks: &[Block]) -> Self {
        let each = |part: fn(&Block) -> f64| Four::padded(blocks.iter().map(part));
        Self {
            decay: each(|block| block.decay),
            fades: each(|block| if block.oscillates() || block.is_single() { block.decay } else { 0.0 }),
            determinant: each(|block| block.determinant),
            discriminant: each(|block| block.discriminant),
            root: each(|block| if block.oscillates() { block.root } else { 0.0 }),
            inverse_root: each(|block| if block.oscillates() { block.inverse_root } else { 0.0 }),
            turns: each(|block| if block.oscillates() { -1.0 } else { 0.0 }),
            grows: each(|block| if block.oscillates() { 0.0 } else { block.discriminant }),
            spare: Four::new(std::array::from_fn(|lane| if lane < blocks.len() { 0.0 } else { 1.0 })),
            spread: each(|block| if block.is_near_critical() { 0.0 } else { block.inverse_root }),
            radius: each(|block| block.radius),
            square: each(|block| block.radius * block.radius),
        }
    }

    /// Their shares after the time of a transfer.
    #[inline(always)]
    pub(crate) fn advance(&self, phases: Phases, transfer: &Transfer) -> Phases {
        let Phases { value, rate } = phases;
        Phases {
            value: transfer.c * value + transfer.s * (rate + self.decay * value),
            rate: transfer.c * rate - transfer.s * (self.decay * rate + self.determinant * value),
        }
    }

    /// One transfer after another.
    #[inline(always)]
    pub(crate) fn chained(&self, first: &Transfer, next: &Transfer) -> Transfer {
        Transfer {
            c: first.c * next.c + self.discriminant * (first.s * next.s),
            s: first.c * next.s + first.s * next.c,
        }
    }

    /// The kernels of a transfer.
    #[inline(always)]
    pub(crate) fn kernels_of(&self, Transfer { c, s }: Transfer) -> Kernels {
        Kernels { c, s, turn: self.root * s }
    }

    /// The first derivatives of shares, as shares.
    #[inline(always)]
    pub(crate) fn derivative(&self, Phases { value, rate }: Phases) -> Phases {
        Phases { value: rate, rate: -2.0 * self.decay * rate - self.determinant * value }
    }

    /// The second derivatives of shares, as shares.
    #[inline(always)]
    pub(crate) fn acceleration(&self, phases: Phases) -> Phases {
        self.derivative(self.derivative(phases))
    }

    /// w of shares Re w e^(λt) of blocks that turn.
    #[inline(always)]
    pub(crate) fn amplitude(&self, Phases { value, rate }: Phases) -> Complexes {
        Complexes { re: value, im: (rate + self.decay * value) * self.inverse_root * -1.0 }
    }

    /// [`Block::amplitude`] of those that are not near critical damping.
    #[inline(always)]
    pub(crate) fn amplitudes(&self, phases: Phases) -> Four {
        phases.value.abs() + (phases.rate + self.decay * phases.value).abs() * self.spread
    }

    /// e^(B t₁) e^(B t₂) for a t₂ so short that radius·t₂ < 0.03, by power series.
    #[inline(always)]
    pub(crate) fn follow_on(&self, first: &Kernels, t: f64) -> Kernels {
        let x = -1.0 * self.decay * t;
        let x2 = x * x;
        let e = (1.0 + x)
            + x2 * ((0.5 + x * (1.0 / 6.0))
                + x2 * ((1.0 / 24.0 + x * (1.0 / 120.0)) + x2 * (1.0 / 720.0 + x * (1.0 / 5040.0))));
        let y = self.discriminant * t * t;
        let c = (1.0 + y * 0.5) + y * y * ((1.0 / 24.0 + y * (1.0 / 720.0)) + y * y * (1.0 / 40_320.0));
        let s =
            t * ((1.0 + y * (1.0 / 6.0)) + y * y * ((1.0 / 120.0 + y * (1.0 / 5040.0)) + y * y * (1.0 / 362_880.0)));
        self.joined(first, &self.kernels_of(Transfer { c: e * c, s: e * s }))
    }

    /// e^(B t₁) e^(B t₂).
    #[inline(always)]
    fn joined(&self, first: &Kernels, next: &Kernels) -> Kernels {
        let product = self.turns * (first.turn * next.turn) + self.grows * (first.s * next.s);
        Kernels {
            c: first.c * next.c + product,
            s: first.c * next.s + first.s * next.c,
            turn: first.c * next.turn + first.turn * next.c,
        }
    }

    #[inline(always)]
    fn kernels(&self, t: f64) -> Kernels {
        let e = Four::new(exp_lanes(Lanes((-1.0 * self.fades * t).array())).0);
        let (sine, cosine) = sin_cos_lanes(Lanes((self.root * t).array()));
        let (sine, cosine) = (Four::new(sine.0), Four::new(cosine.0));
        let turn = e * sine;
        Kernels { c: e * cosine, s: turn * self.inverse_root, turn }
    }
}

impl Bank {
    /// Of these blocks, in the room of this one.
    pub(crate) fn of(self, blocks: &[Block]) -> Self {
        let chosen = |which: fn(&Block) -> bool| (0..blocks.len()).filter(|&k| which(&blocks[k])).collect();
        let mut all = self.blocks;
        all.clear();
        all.extend(blocks.chunks(WIDTH).map(Blocks::new));
        Self {
            count: blocks.len(),
            blocks: all,
            others: chosen(|block| !(block.oscillates() || block.is_single())),
            near_critical: chosen(Block::is_near_critical),
        }
    }

    /// The kernels of all blocks after `t` seconds; `each` has the same blocks one by one.
    #[inline(always)]
    pub(crate) fn kernels(&self, each: &[Block], t: f64, kernels: &mut [Kernels]) {
        for (blocks, kernels) in self.blocks.iter().zip(&mut *kernels) {
            *kernels = blocks.kernels(t);
        }
        for &k in &self.others {
            kernels[k / WIDTH].set(k % WIDTH, each[k].kernel(t));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_short_flows_make_one_long_flow() {
        let matrices =
            [[0.0, 1.0, -1000.0, -3.0], [0.0, 1.0, -25.0, -10.0], [0.0, 1.0, -9.0, -40.0], [0.0, 1.0, 0.0, 0.0]];
        let each = matrices.map(Block::new);
        let bank = Bank::default().of(&each);
        let mut first = [Kernels::NONE];
        bank.kernels(&each, 0.037, &mut first);
        let joined = bank.blocks[0].follow_on(&first[0], 1e-4);
        for (lane, block) in each.iter().enumerate() {
            let (joined, whole) = (joined.at(lane), block.kernel(0.0371));
            assert!((joined.c - whole.c).abs() < 1e-14 && (joined.s - whole.s).abs() < 1e-14);
        }
    }
}
