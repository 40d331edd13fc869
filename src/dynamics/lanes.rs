//! Numbers side by side: what is done to one is done to all, so that a processor may do several at once.
//!
//! Each lane is computed as it would be alone. So a value does not depend on its neighbours, on the number of lanes or on
//! the registers that the compiler finds.

use std::ops::{Add, Mul, Sub};

/// Numbers that are worked on together: one register of new processors, two of older ones.
pub(crate) const WIDTH: usize = 4;

/// `N` numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(transparent)]
pub(crate) struct Lanes<const N: usize>(pub(crate) [f64; N]);

impl<const N: usize> Lanes<N> {
    /// Of nothing.
    pub(crate) const ZERO: Self = Self([0.0; N]);

    /// Each with that in the same place of the other.
    #[inline(always)]
    pub(crate) fn zip(self, other: Self, each: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = self;
        for (a, b) in result.0.iter_mut().zip(other.0) {
            *a = each(*a, b);
        }
        result
    }

    /// The same done to each.
    #[inline(always)]
    pub(crate) fn map(self, each: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(each))
    }

    /// Whether all are of a smaller modulus; never so with NaN among them.
    #[inline(always)]
    pub(crate) fn all_below(self, bound: f64) -> bool {
        self.0.iter().all(|x| x.abs() < bound)
    }
}

macro_rules! operator {
    ($trait:ident, $function:ident, $symbol:tt) => {
        impl<const N: usize> $trait for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.zip(other, |a, b| a $symbol b)
            }
        }

        impl<const N: usize> $trait<f64> for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: f64) -> Self {
                self.map(|a| a $symbol other)
            }
        }

        impl<const N: usize> $trait<Lanes<N>> for f64 {
            type Output = Lanes<N>;
            #[inline(always)]
            fn $function(self, other: Lanes<N>) -> Lanes<N> {
                other.map(|b| self $symbol b)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
