//! Blocks: the smallest pieces of a linear flow, two real coordinates each.
//!
//! A 2 × 2 matrix B with half trace −a and determinant b has (B + aI)² = dI with d = a² − b, so that
//!
//! e^(Bt) = e^(−at) [C(t) I + S(t) (B + aI)],   C = cos √(−d) t or cosh √d t,   S = sin √(−d) t/√(−d) or sinh √d t/√d.
//!
//! C and S are entire functions of d: nothing happens at critical damping (d = 0), where an eigenbasis would fail. Of two real
//! eigenvalues that are far apart each may have a block of its own, B = −aI, whose second coordinate stays zero.

use std::ops::{Add, Mul};

use crate::arithmetic::elementary::{exp, exp_lanes, sin_cos, sin_cos_lanes};
use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::{Lanes, WIDTH};

/// decay·t up to which e^(decay·t) is a number.
const MUCH_DECAY: f64 = 600.0;

/// A block's invariants: all that a scalar signal of the flow needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Block {
    /// a: minus half the trace, 1/s.
    pub(crate) decay: f64,
    /// b: determinant, 1/s².
    pub(crate) determinant: f64,
    /// d = a² − b, 1/s².
    pub(crate) discriminant: f64,
    /// √|d|.
    pub(crate) root: f64,
    /// 1/√|d|; infinite at critical damping, 0 of a block that is one exponential alone.
    pub(crate) inverse_root: f64,
    /// Largest modulus of an eigenvalue.
    pub(crate) radius: f64,
}

/// e^(−at) C(t) and e^(−at) S(t).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Kernel {
    pub(crate) c: f64,
    pub(crate) s: f64,
    /// e^(−at) sin √(−d) t of a block that turns: √(−d) S, but for the rounding of 1/√(−d), which is the same each time.
    pub(crate) turn: f64,
}

/// The pairs k ≤ l of so many blocks, row by row: the order of every form over them.
pub(crate) fn pairs(blocks: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..blocks).flat_map(move |k| (k..blocks).map(move |l| (k, l)))
}

/// zᵀ F z, F by [`pairs`] of blocks; those off the diagonal count for both orders.
pub(crate) fn form(parts: &[[f64; 4]], z: &[f64]) -> f64 {
    forms(parts, z.as_chunks().0, 0.0)
}

/// The same of one z or of several side by side, beginning with `zero`.
#[inline(always)]
pub(crate) fn forms<T>(parts: &[[f64; 4]], z: &[[T; 2]], zero: T) -> T
where
    T: Copy + Add<Output = T> + Mul<Output = T> + Mul<f64, Output = T>,
{
    let mut parts = parts.iter();
    let mut sum = zero;
    for (k, [x, y]) in z.iter().enumerate() {
        let (mut by_x, mut by_y) = (zero, zero);
        for ([u, v], [xu, xv, yu, yv]) in z[k..].iter().zip(parts.by_ref()) {
            by_x = by_x + (*u * *xu + *v * *xv);
            by_y = by_y + (*u * *yu + *v * *yv);
        }
        sum = sum + (*x * by_x + *y * by_y);
    }
    sum
}

/// The transpose of a 2 × 2 matrix, row by row.
pub(crate) fn transposed([p, q, r, s]: [f64; 4]) -> [f64; 4] {
    [p, r, q, s]
}

/// Value and first derivative of a block's share in a signal.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Phase {
    pub(crate) value: f64,
    pub(crate) rate: f64,
}

impl Block {
    /// The block of the matrix [[p, q], [r, s]].
    pub(crate) fn new([p, q, r, s]: [f64; 4]) -> Self {
        if q == 0.0 && r == 0.0 && p == s && p != 0.0 {
            return Self { inverse_root: 0.0, ..Self::from_invariants(-p, p * p, 0.0) };
        }
        let half = 0.5 * (p - s);
        // d from differences, not from a² − b: near critical damping that would cancel.
        Self::from_invariants(-0.5 * (p + s), p * s - q * r, half * half + q * r)
    }

    /// x″ + ω² x = 0.
    pub(crate) fn harmonic(omega: f64) -> Self {
        Self::from_invariants(0.0, omega * omega, -omega * omega)
    }

    fn from_invariants(decay: f64, determinant: f64, discriminant: f64) -> Self {
        let root = discriminant.abs().sqrt();
        let radius = if discriminant < 0.0 { determinant.abs().sqrt() } else { decay.abs() + root };
        Self { decay, determinant, discriminant, root, inverse_root: 1.0 / root, radius }
    }

    /// The rate at which the slower of its solutions dies away, 1/s.
    pub(crate) fn slowest(&self) -> f64 {
        if self.discriminant < 0.0 { self.decay } else { self.decay - self.root }
    }

    /// Its numbers are numbers.
    pub(crate) fn is_finite(&self) -> bool {
        [self.decay, self.determinant, self.discriminant, self.radius].iter().all(|x| x.is_finite())
    }

    /// Both eigenvalues are zero: a constant load makes it fall.
    pub(crate) fn is_drift(&self) -> bool {
        self.radius == 0.0
    }

    /// Answer to a constant load r, offset + slope·t + bend·t²: at rest where the block has an inverse, creeping against a
    /// dashpot where one eigenvalue is zero, falling where both are.
    pub(crate) fn answer(&self, [p, q, r, s]: [f64; 4], load: [f64; 2]) -> ([f64; 2], [f64; 2], [f64; 2]) {
        let [x, y] = load;
        let times = [p * x + q * y, r * x + s * y];
        if self.is_drift() {
            return ([0.0; 2], load, [0.5 * times[0], 0.5 * times[1]]);
        }
        if self.determinant == 0.0 {
            // B² = −2a B: with o = r/2a and n = r + B o, B n = 0 and n = B o + r.
            let twice = 2.0 * self.decay;
            return ([x / twice, y / twice], [x + times[0] / twice, y + times[1] / twice], [0.0; 2]);
        }
        let inverse = |a: f64, b: f64| -(a - b) / self.determinant;
        ([inverse(s * x, q * y), inverse(p * y, r * x)], [0.0; 2], [0.0; 2])
    }

    /// One real eigenvalue, e^(−at) alone: rate = −a·value in every signal.
    pub(crate) fn is_single(&self) -> bool {
        self.inverse_root == 0.0
    }

    /// True for a pair of complex eigenvalues.
    pub(crate) fn oscillates(&self) -> bool {
        self.discriminant < 0.0
    }

    /// Eigenvalues as (real, imaginary) pairs, for conditioning checks and natural frequencies.
    pub(crate) fn eigenvalues(&self) -> [[f64; 2]; 2] {
        if self.oscillates() {
            [[-self.decay, self.root], [-self.decay, -self.root]]
        } else {
            [[-self.decay + self.root, 0.0], [-self.decay - self.root, 0.0]]
        }
    }

    /// No eigenvalue of this block and one of the other sum to less than this share of the larger.
    pub(crate) fn keeps_apart(&self, other: &Self, share: f64) -> bool {
        let square = |[x, y]: [f64; 2]| x * x + y * y;
        self.eigenvalues().iter().all(|a| {
            other.eigenvalues().iter().all(|b| {
                let larger = square(*a).max(square(*b));
                square([a[0] + b[0], a[1] + b[1]]) > share * share * larger
            })
        })
    }

    /// Adds this block's share of displacement, velocity, acceleration and its rate, when it is at `now`.
    #[inline]
    pub(crate) fn add_motion(&self, motion: &mut [f64; 4], now: Phase) {
        let bend = self.acceleration(now);
        let parts = [now.value, now.rate, bend.value, bend.rate];
        motion.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
    }

    /// The kernel after `t` seconds.
    #[inline]
    pub(crate) fn kernel(&self, t: f64) -> Kernel {
        if self.discriminant < 0.0 {
            let e = if self.decay == 0.0 { 1.0 } else { exp(-self.decay * t) };
            let (sine, cosine) = sin_cos(self.root * t);
            Kernel { c: e * cosine, s: e * sine * self.inverse_root, turn: e * sine }
        } else if self.discriminant == 0.0 {
            let e = exp(-self.decay * t);
            Kernel { c: e, s: e * t, turn: 0.0 }
        } else {
            // e^(−at) sinh(rt)/r = e^(−(a+r)t) (e^(2rt) − 1)/(2r): no overflow, no cancellation.
            let fast = exp(-(self.decay + self.root) * t);
            let slow = exp(-(self.decay - self.root) * t);
            let two_rt = 2.0 * self.root * t;
            let s = if two_rt < 0.5 { fast * libm::expm1(two_rt) } else { slow - fast } / (2.0 * self.root);
            Kernel { c: 0.5 * (slow + fast), s, turn: 0.0 }
        }
    }

    /// c and s of its kernel after the times t + `apart`, and after t − `apart`, from the kernel after t.
    #[inline(always)]
    pub(crate) fn kernels_about(&self, t: f64, middle: Kernel, apart: Four) -> [Four; 4] {
        if self.discriminant < 0.0 && self.decay * t < MUCH_DECAY {
            let e = Four::new(exp_lanes(Lanes((apart * -self.decay).array())).0);
            let (sine, cosine) = sin_cos_lanes(Lanes((apart * self.root).array()));
            let (c, s) = (Four::new(cosine.0), Four::new(sine.0) * self.inverse_root);
            let [cc, ss, cs, sc] = [c * middle.c, s * (self.discriminant * middle.s), s * middle.c, c * middle.s];
            let inverse = e.map(|e| 1.0 / e);
            [e * (cc + ss), e * (sc + cs), inverse * (cc - ss), inverse * (sc - cs)]
        } else {
            // Back in time what decays fast grows, and takes the digits of what decays slowly.
            let [after, before] = [1.0, -1.0].map(|side| apart.array().map(|apart| self.kernel(t + side * apart)));
            let parts = |kernels: [Kernel; WIDTH]| {
                [Four::new(kernels.map(|kernel| kernel.c)), Four::new(kernels.map(|kernel| kernel.s))]
            };
            let ([c, s], [c_before, s_before]) = (parts(after), parts(before));
            [c, s, c_before, s_before]
        }
    }

    /// A signal's share after the time of `kernel`.
    #[inline]
    pub(crate) fn advance(&self, phase: Phase, kernel: Kernel) -> Phase {
        let Phase { value, rate } = phase;
        Phase {
            value: kernel.c * value + kernel.s * (rate + self.decay * value),
            rate: kernel.c * rate - kernel.s * (self.decay * rate + self.determinant * value),
        }
    }

    /// The second derivative of a share, as a share.
    #[inline]
    pub(crate) fn acceleration(&self, phase: Phase) -> Phase {
        let value = -2.0 * self.decay * phase.rate - self.determinant * phase.value;
        Phase { value, rate: -2.0 * self.decay * value - self.determinant * phase.rate }
    }

    /// Where the bound on a share depends on how long it is to hold.
    #[inline]
    pub(crate) fn is_near_critical(&self) -> bool {
        !(self.is_single() || self.discriminant < 0.0 && self.root > 0.2 * self.radius)
    }

    /// A bound on |share| from now on, and with radius^j on its derivatives, while time stays within `window` of now.
    ///
    /// The share is e^(−at)(value·C + (rate + a·value) S); C's derivatives are bounded by radius^j, those of S by
    /// radius^j/√|d| or, where that blows up near critical damping, by (j + radius·window) radius^(j−1).
    #[inline]
    pub(crate) fn amplitude(&self, phase: Phase, order: f64, window: f64) -> f64 {
        if !self.is_near_critical() {
            phase.value.abs() + (phase.rate + self.decay * phase.value).abs() * self.inverse_root
        } else {
            self.amplitude_near_critical(phase, order, window)
        }
    }

    #[cold]
    fn amplitude_near_critical(&self, phase: Phase, order: f64, window: f64) -> f64 {
        let slope = phase.rate + self.decay * phase.value;
        if self.is_drift() {
            return phase.value.abs() + slope.abs() * window;
        }
        let divided = (order + self.radius * window) / self.radius;
        let share = divided.min(self.inverse_root);
        // Of cosh and sinh as well: both exponentials decay while decay ≥ root.
        phase.value.abs() + slope.abs() * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_flow_of_a_block_is_smooth_through_critical_damping() {
        let at = |a: f64| Block::new([0.0, 1.0, -100.0, -2.0 * a]).kernel(0.3);
        let critical = at(10.0);
        for shift in [1e-5, 1e-9, 1e-13] {
            for near in [at(10.0 - shift), at(10.0 + shift)] {
                assert!((near.c - critical.c).abs() < 4.0 * shift + 1e-15);
                assert!((near.s - critical.s).abs() < 4.0 * shift + 1e-15);
            }
        }
    }
}
