//! Dense matrices of a library, in loops of our own where its own pick a kernel, and with it the last bit, by processor.

use nalgebra::{ComplexField, DMatrix};

/// A B, column by column.
pub(crate) fn product<T: ComplexField + Copy>(a: &DMatrix<T>, b: &DMatrix<T>) -> DMatrix<T> {
    let rows = a.nrows();
    let mut product = DMatrix::from_element(rows, b.ncols(), T::zero());
    let columns = product.as_mut_slice().chunks_exact_mut(rows.max(1));
    for (sums, factors) in columns.zip(b.as_slice().chunks_exact(b.nrows().max(1))) {
        let (fours, rest) = factors.as_chunks::<4>();
        let (many, few) = a.as_slice().split_at(4 * fours.len() * rows);
        // Four terms of a sum while it is at hand; in the order of all terms.
        for (columns, &[e, f, g, h]) in many.chunks_exact(4 * rows.max(1)).zip(fours) {
            let (front, back) = columns.split_at(2 * rows);
            let ((p, q), (r, s)) = (front.split_at(rows), back.split_at(rows));
            for ((((sum, &p), &q), &r), &s) in sums.iter_mut().zip(p).zip(q).zip(r).zip(s) {
                *sum = *sum + p * e + q * f + r * g + s * h;
            }
        }
        for (column, &factor) in few.chunks_exact(rows.max(1)).zip(rest) {
            sums.iter_mut().zip(column).for_each(|(sum, &entry)| *sum += entry * factor);
        }
    }
    product
}

/// The inverse of a unit upper triangular matrix, column by column.
pub(crate) fn inverse_of_unit_upper<T: ComplexField + Copy>(x: &DMatrix<T>) -> DMatrix<T> {
    let order = x.nrows();
    let mut y = DMatrix::identity(order, order);
    let rows = x.transpose();
    for j in 0..order {
        for i in (0..j).rev() {
            let terms = column(&rows, i)[i + 1..=j].iter().zip(&column(&y, j)[i + 1..=j]);
            y[(i, j)] = terms.fold(T::zero(), |sum, (x, y)| sum - *x * *y);
        }
    }
    y
}

/// W ← W + (1 − W V) W.
pub(crate) fn invert_again(v: &DMatrix<f64>, w: &mut DMatrix<f64>) {
    let mut rest = -product(w, v);
    (0..rest.nrows()).for_each(|i| rest[(i, i)] += 1.0);
    *w += product(&rest, w);
}

/// Entries row by row.
pub(crate) fn by_rows(matrix: &DMatrix<f64>) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}

/// The entries of the piece of order two that begins at `i`.
pub(crate) fn piece(t: &DMatrix<f64>, i: usize) -> [f64; 4] {
    [t[(i, i)], t[(i, i + 1)], t[(i + 1, i)], t[(i + 1, i + 1)]]
}

/// The largest modulus of its entries; infinite if one of them is NaN.
pub(crate) fn largest(m: &DMatrix<f64>) -> f64 {
    m.as_slice().iter().fold(0.0_f64, |largest, x| if x.is_nan() { f64::INFINITY } else { largest.max(x.abs()) })
}

/// A column, as numbers that follow each other.
pub(crate) fn column<T>(matrix: &DMatrix<T>, j: usize) -> &[T] {
    let rows = matrix.nrows();
    &matrix.as_slice()[j * rows..][..rows]
}
