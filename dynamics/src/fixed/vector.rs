//! State vectors: of a length known to the compiler for the small systems, so that a step is a few dozen instructions
//! without a loop or an allocation; of any length for the others. All sums run in one fixed order.

/// A state vector, its matrix, and the operations of a step.
pub(super) trait Vector: Clone + AsRef<[f64]> + AsMut<[f64]> {
    /// A square matrix of the same order, by columns.
    type Matrix;
    fn of(values: &[f64]) -> Self;
    fn matrix(columns: &[Vec<f64>]) -> Self::Matrix;
    /// Moves the vector out, to work on it outside of its owner; what stays behind is to be overwritten.
    fn take(&mut self) -> Self;
    /// into = matrix·from + offset + input·u.
    fn advance(matrix: &Self::Matrix, offset: &Self, input: &Self, u: f64, from: &Self, into: &mut Self);
    fn dot(&self, other: &Self) -> f64;
    fn add(&mut self, other: &Self);
    fn add_times(&mut self, factor: f64, other: &Self);
}

impl<const D: usize> Vector for [f64; D] {
    type Matrix = [[f64; D]; D];

    fn of(values: &[f64]) -> Self {
        std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0))
    }

    fn matrix(columns: &[Vec<f64>]) -> Self::Matrix {
        std::array::from_fn(|j| columns.get(j).map_or([0.0; D], |column| Self::of(column)))
    }

    #[inline(always)]
    fn take(&mut self) -> Self {
        *self
    }

    #[inline(always)]
    fn advance(matrix: &Self::Matrix, offset: &Self, input: &Self, u: f64, from: &Self, into: &mut Self) {
        // Two chains of additions instead of one: a step has to wait for the step before it.
        let (mut even, mut odd) = ([0.0; D], [0.0; D]);
        for i in 0..D {
            even[i] = offset[i] + input[i] * u;
        }
        for j in 0..D {
            let chain = if j % 2 == 0 { &mut even } else { &mut odd };
            for i in 0..D {
                chain[i] += matrix[j][i] * from[j];
            }
        }
        for i in 0..D {
            into[i] = even[i] + odd[i];
        }
    }

    #[inline(always)]
    fn dot(&self, other: &Self) -> f64 {
        let mut sum = 0.0;
        for i in 0..D {
            sum += self[i] * other[i];
        }
        sum
    }

    #[inline(always)]
    fn add(&mut self, other: &Self) {
        for i in 0..D {
            self[i] += other[i];
        }
    }

    #[inline(always)]
    fn add_times(&mut self, factor: f64, other: &Self) {
        for i in 0..D {
            self[i] += factor * other[i];
        }
    }
}

impl Vector for Vec<f64> {
    type Matrix = Vec<Vec<f64>>;

    fn of(values: &[f64]) -> Self {
        values.to_vec()
    }

    fn matrix(columns: &[Vec<f64>]) -> Self::Matrix {
        columns.to_vec()
    }

    fn take(&mut self) -> Self {
        std::mem::take(self)
    }

    fn advance(matrix: &Self::Matrix, offset: &Self, input: &Self, u: f64, from: &Self, into: &mut Self) {
        for ((into, offset), input) in into.iter_mut().zip(offset).zip(input) {
            *into = offset + input * u;
        }
        for (column, x) in matrix.iter().zip(from) {
            into.iter_mut().zip(column).for_each(|(into, a)| *into += a * x);
        }
    }

    fn dot(&self, other: &Self) -> f64 {
        crate::arithmetic::matrix::dot(self, other)
    }

    fn add(&mut self, other: &Self) {
        self.iter_mut().zip(other).for_each(|(sum, x)| *sum += x);
    }

    fn add_times(&mut self, factor: f64, other: &Self) {
        self.iter_mut().zip(other).for_each(|(sum, x)| *sum += factor * x);
    }
}
