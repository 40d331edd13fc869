//! Complex numbers side by side.

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;

/// Complex numbers side by side.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Complexes {
    pub(crate) re: Four,
    pub(crate) im: Four,
}

impl Complexes {
    pub(crate) const ZERO: Self = Self { re: Four::ZERO, im: Four::ZERO };

    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }

    #[inline(always)]
    pub(crate) fn minus(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }

    #[inline(always)]
    pub(crate) fn times(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }

    #[inline(always)]
    pub(crate) fn scaled(self, factor: Four) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }

    #[inline(always)]
    pub(crate) fn conjugate(self) -> Self {
        Self { re: self.re, im: self.im * -1.0 }
    }

    #[inline(always)]
    pub(crate) fn square(self) -> Four {
        self.re * self.re + self.im * self.im
    }

    #[inline(always)]
    pub(crate) fn inverse(self) -> Self {
        self.conjugate().scaled(self.square().map(|square| 1.0 / square))
    }

    /// One after the other, each with its parts side by side.
    #[inline(always)]
    pub(crate) fn pairs(self) -> [f64; 2 * WIDTH] {
        let ([a, c, e, g], [b, d, f, h]) = (self.re.array(), self.im.array());
        [a, b, c, d, e, f, g, h]
    }

    /// One of them, in all places.
    #[inline(always)]
    pub(crate) fn all(self, lane: usize) -> Self {
        Self { re: Four::all(self.re.at(lane)), im: Four::all(self.im.at(lane)) }
    }
}
