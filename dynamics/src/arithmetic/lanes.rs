//! Numbers side by side: what is done to one is done to all, so that a processor may do several at once.
//!
//! Each lane is computed as it would be alone. So a value does not depend on its neighbours, on the number of lanes or on
//! the registers that the compiler finds.

/// Numbers that are worked on together: one register of new processors, two of older ones.
pub(crate) const WIDTH: usize = 4;

/// `N` numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(transparent)]
pub(crate) struct Lanes<const N: usize>(pub(crate) [f64; N]);

impl<const N: usize> Lanes<N> {
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

/// Sums, differences and products of several numbers, of them and one number, and of one number and them.
macro_rules! operators {
    ([$($generic:tt)*] $type:ty) => {
        operators!([$($generic)*] $type: Add, add, +);
        operators!([$($generic)*] $type: Sub, sub, -);
        operators!([$($generic)*] $type: Mul, mul, *);
    };
    ([$($generic:tt)*] $type:ty: $trait:ident, $function:ident, $symbol:tt) => {
        impl<$($generic)*> std::ops::$trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.zip(other, |a, b| a $symbol b)
            }
        }

        impl<$($generic)*> std::ops::$trait<f64> for $type {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: f64) -> Self {
                self.map(|a| a $symbol other)
            }
        }

        impl<$($generic)*> std::ops::$trait<$type> for f64 {
            type Output = $type;
            #[inline(always)]
            fn $function(self, other: $type) -> $type {
                other.map(|b| self $symbol b)
            }
        }
    };
}

operators!([const N: usize] Lanes<N>);

pub(crate) use operators;
