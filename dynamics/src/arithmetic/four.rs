//! Four numbers in one register of new processors, two of older ones.
//!
//! The compiler sees a vector, and keeps it one: of an array of four it makes four numbers, and joins them again in pairs that
//! suit no register. Each number is computed as it would be alone, so that the registers change no bit.

use crate::arithmetic::lanes::{WIDTH, operators};

#[cfg(target_arch = "x86_64")]
type Register = std::arch::x86_64::__m256d;
#[cfg(not(target_arch = "x86_64"))]
type Register = [f64; WIDTH];

/// Four numbers.
#[derive(Debug, Clone, Copy)]
#[repr(transparent)]
pub(crate) struct Four(Register);

impl Four {
    /// Of nothing.
    pub(crate) const ZERO: Self = Self::new([0.0; WIDTH]);

    #[inline(always)]
    pub(crate) const fn new(numbers: [f64; WIDTH]) -> Self {
        // SAFETY: a register is four numbers, and any bits are.
        Self(unsafe { std::mem::transmute::<[f64; WIDTH], Register>(numbers) })
    }

    /// The numbers.
    #[inline(always)]
    pub(crate) const fn array(self) -> [f64; WIDTH] {
        // SAFETY: as above.
        unsafe { std::mem::transmute::<Register, [f64; WIDTH]>(self.0) }
    }

    /// The same number in all places.
    #[inline(always)]
    pub(crate) fn all(number: f64) -> Self {
        Self::new([number; WIDTH])
    }

    /// As many as there are, and zeros.
    pub(crate) fn padded(numbers: impl Iterator<Item = f64>) -> Self {
        let mut four = [0.0; WIDTH];
        four.iter_mut().zip(numbers).for_each(|(place, number)| *place = number);
        Self::new(four)
    }

    /// One of them.
    #[inline(always)]
    pub(crate) fn at(&self, place: usize) -> f64 {
        // SAFETY: a register is four numbers side by side, and aligned to more than one of them is.
        let numbers = unsafe { &*std::ptr::from_ref(&self.0).cast::<[f64; WIDTH]>() };
        numbers[place]
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, place: usize, number: f64) {
        // SAFETY: as above, and nothing else refers to them.
        let numbers = unsafe { &mut *std::ptr::from_mut(&mut self.0).cast::<[f64; WIDTH]>() };
        numbers[place] = number;
    }

    /// Each with that in the same place of the other.
    #[inline(always)]
    pub(crate) fn zip(self, other: Self, each: impl Fn(f64, f64) -> f64) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.array(), other.array());
        Self::new([each(a, e), each(b, f), each(c, g), each(d, h)])
    }

    /// The same done to each.
    #[inline(always)]
    pub(crate) fn map(self, each: impl Fn(f64) -> f64) -> Self {
        let [a, b, c, d] = self.array();
        Self::new([each(a), each(b), each(c), each(d)])
    }

    /// Without sign.
    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        self.map(f64::abs)
    }

    /// All of them together.
    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        let [a, b, c, d] = self.array();
        (a + c) + (b + d)
    }

    /// The largest of them.
    #[inline(always)]
    pub(crate) fn largest(self) -> f64 {
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        let [a, b, c, d] = self.array();
        larger(larger(a, c), larger(b, d))
    }

    /// The least of them.
    #[inline(always)]
    pub(crate) fn least(self) -> f64 {
        let less = |a: f64, b: f64| if a < b { a } else { b };
        let [a, b, c, d] = self.array();
        less(less(a, c), less(b, d))
    }
}

impl Default for Four {
    fn default() -> Self {
        Self::ZERO
    }
}

operators!([] Four);
