//! Dense matrices, vectors and means; their sums run in order, since their bits reach the results.

/// A dense matrix, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    /// Order.
    pub order: usize,
    /// Entries, `order` × `order`, row by row.
    pub entries: Vec<f64>,
}

impl Matrix {
    /// The matrix with the given diagonal.
    #[must_use]
    pub fn diagonal(diagonal: &[f64]) -> Self {
        let order = diagonal.len();
        let mut entries = vec![0.0; order * order];
        for (i, value) in diagonal.iter().enumerate() {
            entries[i * order + i] = *value;
        }
        Self { order, entries }
    }

    /// Entry in row i, column j.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.entries[i * self.order + j]
    }

    /// y = A x.
    #[must_use]
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        self.entries.chunks_exact(self.order).map(|row| dot(row, x)).collect()
    }

    /// The same with zeros behind it, up to this order.
    pub(crate) fn padded(&self, order: usize) -> Self {
        let mut entries = vec![0.0; order * order];
        for (row, own) in entries.chunks_exact_mut(order.max(1)).zip(self.entries.chunks_exact(self.order.max(1))) {
            row[..self.order].copy_from_slice(own);
        }
        Self { order, entries }
    }

    /// Adds `factor` x xᵀ; x has as many numbers as the matrix has rows.
    pub fn add_square(&mut self, factor: f64, x: &[f64]) {
        for (entries, a) in self.entries.chunks_exact_mut(self.order.max(1)).zip(x) {
            entries.iter_mut().zip(x).for_each(|(entry, b)| *entry += factor * a * b);
        }
    }

    /// xᵀ A y.
    #[must_use]
    pub fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        dot(x, &self.times(y))
    }
}

/// Σ aᵢ bᵢ, in order.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (x, y)| sum + x * y)
}

/// √(Σ xᵢ²).
pub(crate) fn length(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// Σ xᵢ/n, in order.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
