//! Splitting a linear system into independent 2 × 2 blocks.
//!
//! A = V diag(B₁, B₂, …) V⁻¹ with real 2 × 2 blocks: real Schur form, then Sylvester equations that remove what is left
//! above the diagonal (Bavely & Stewart, SIAM J. Numer. Anal. 16, 1979). A block keeps a complex pair or two real
//! eigenvalues *together*, so a critically damped contact needs no eigenvectors and costs no digits.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::arithmetic::dense::{by_rows, column, inverse_of_unit_upper, invert_again, largest, piece, product};
use crate::arithmetic::gauss::eliminate;
use crate::arithmetic::schur::schur;
use crate::contact_state::block::Block;
use crate::contact_state::cluster;
use crate::contact_state::spectral::Spectral;
use crate::error::EngineError;

/// Above this the blocks are too nearly dependent to be split from each other: four digits.
const WORST_CONDITION: f64 = 1e4;
/// Rates this far apart cost the slow blocks two digits.
const WIDE: f64 = 100.0;
/// A Newton step larger than this is no correction.
const LARGEST_STEP: f64 = 1e-6;

/// Splits `matrix` (row by row, of even `order`).
pub(crate) fn split(order: usize, matrix: &[f64]) -> Result<Spectral, EngineError> {
    if order == 2 {
        let unit = vec![1.0, 0.0, 0.0, 1.0];
        return Ok(Spectral::new(unit.clone(), unit, matrix.as_chunks().0.to_vec(), f64::INFINITY));
    }
    let a = DMatrix::from_row_slice(order, order, matrix);
    let creeps = a.as_slice().chunks_exact(order).any(|column| column.iter().all(|entry| *entry == 0.0));
    let norm = a.as_slice().iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let [mut q, mut t] = schur(a)?;
    let firsts = gather(&mut q, &mut t);
    let (x, y) = decouple(&t, &firsts);
    if !(largest(&x) * largest(&y) < WORST_CONDITION) {
        return Ok(cluster::split(&q, &t));
    }
    let mut v = product(&q, &x);
    let mut w = product(&y, &q.transpose());
    let slowest = firsts.iter().map(|&i| Block::new(piece(&t, i)).radius).fold(f64::INFINITY, f64::min);
    if norm > WIDE * slowest {
        let a = DMatrix::from_row_slice(order, order, matrix);
        refine(&a, &mut v, &mut w, &mut t, &firsts);
    }
    let matrices = firsts.iter().map(|&i| settle(piece(&t, i), norm, creeps)).collect();
    Ok(Spectral::new(by_rows(&v), by_rows(&w), matrices, f64::INFINITY))
}

/// Order of the piece that begins at `i`: two for a complex pair, one for a real eigenvalue.
fn size_at(t: &DMatrix<f64>, i: usize) -> usize {
    if i + 1 < t.nrows() && t[(i + 1, i)] != 0.0 { 2 } else { 1 }
}

/// Moves every second real eigenvalue up behind the one nearest to it, so that they make a block; splitting them would be
/// ill-conditioned where they are close, and is not needed anywhere. Tells where the blocks begin.
fn gather(q: &mut DMatrix<f64>, t: &mut DMatrix<f64>) -> Vec<usize> {
    let order = t.nrows();
    let firsts: Vec<usize> = (0..order).step_by(2).collect();
    for &first in &firsts {
        if size_at(t, first) == 2 {
            continue;
        }
        let mut pieces = Vec::new();
        let mut i = first + 1;
        while i < order {
            pieces.push(i);
            i += size_at(t, i);
        }
        let distance = |&k: &usize| {
            let (a, b) = (t[(first, first)], t[(pieces[k], pieces[k])]);
            (a - b).abs() / (a.abs() + b.abs()).max(f64::MIN_POSITIVE)
        };
        // The eigenvalues are even in number, and complex ones come in pairs: there is a partner.
        let partner = (0..pieces.len())
            .filter(|&k| size_at(t, pieces[k]) == 1)
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap_or(0);
        for k in (1..=partner).rev() {
            exchange(q, t, pieces[k - 1], pieces[k] - pieces[k - 1]);
            pieces[k] = pieces[k - 1] + 1;
        }
    }
    firsts
}

/// Exchanges the piece of order `size` at `first` with the real eigenvalue behind it (Bai & Demmel, Linear Algebra Appl. 186,
/// 1993), by an orthogonal transformation that turns the eigenvector of the latter to the front.
fn exchange(q: &mut DMatrix<f64>, t: &mut DMatrix<f64>, first: usize, size: usize) {
    let last = first + size;
    let pieces = [first..last, last..last + 1];
    let mut load = [[0.0; 2]; 2];
    for (a, row) in load.iter_mut().enumerate().take(size) {
        row[0] = -t[(first + a, last)];
    }
    let x = sylvester(t, &pieces, &load);
    // The eigenvector is (x, 1); a Householder reflection maps it to the first axis.
    let mut v: Vec<f64> = x.iter().take(size).map(|row| row[0]).chain([1.0]).collect();
    let length = v.iter().fold(0.0, |sum, x| sum + x * x).sqrt();
    v[0] += if v[0] < 0.0 { -length } else { length };
    let square = v.iter().fold(0.0, |sum, x| sum + x * x);
    if !(square.is_finite() && square > 0.0) {
        return;
    }
    let order = t.nrows();
    for column in 0..order {
        let share = (0..=size).fold(0.0, |sum, k| sum + v[k] * t[(first + k, column)]) * 2.0 / square;
        (0..=size).for_each(|k| t[(first + k, column)] -= share * v[k]);
    }
    for row in 0..order {
        for matrix in [&mut *t, &mut *q] {
            let share = (0..=size).fold(0.0, |sum, k| sum + v[k] * matrix[(row, first + k)]) * 2.0 / square;
            (0..=size).for_each(|k| matrix[(row, first + k)] -= share * v[k]);
        }
    }
    (1..=size).for_each(|k| t[(first + k, first)] = 0.0);
}

/// One Newton step for A V = V diag(blocks), W V = 1. The Schur form is exact to the rounding of the largest entry of A; what a
/// soft structure feels of a floor a million times stiffer is far below that, and is found here from the matrix itself.
fn refine(a: &DMatrix<f64>, v: &mut DMatrix<f64>, w: &mut DMatrix<f64>, t: &mut DMatrix<f64>, firsts: &[usize]) {
    let order = a.nrows();
    invert_again(v, w);
    let inner = product(w, &product(a, v));
    let mut x = DMatrix::identity(order, order);
    for &left in firsts {
        t.view_mut((left, left), (2, 2)).copy_from(&inner.view((left, left), (2, 2)));
    }
    for &left in firsts {
        for &right in firsts.iter().filter(|&&right| right != left) {
            let load = [0, 1].map(|a| [0, 1].map(|b| -inner[(left + a, right + b)]));
            let pieces = [left, right].map(|first| first..first + 2);
            let step = sylvester(t, &pieces, &load);
            if step.iter().flatten().all(|x| x.abs() < LARGEST_STEP) {
                put(&mut x, [left, right], step);
            }
        }
    }
    *v = product(v, &x);
    *w = product(&DMatrix::from_fn(order, order, |i, j| if i == j { 1.0 } else { -x[(i, j)] }), w);
    invert_again(v, w);
}

/// Puts the piece of two rows and two columns there that begins at `i`, `j`.
fn put(matrix: &mut DMatrix<f64>, [i, j]: [usize; 2], piece: [[f64; 2]; 2]) {
    for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        matrix[(i + a, j + b)] = piece[a][b];
    }
}

/// X with T X = X diag(blocks), unit upper triangular by blocks, and its inverse.
fn decouple(t: &DMatrix<f64>, firsts: &[usize]) -> (DMatrix<f64>, DMatrix<f64>) {
    let order = t.nrows();
    let mut x = DMatrix::identity(order, order);
    let rows = t.transpose();
    for (j, &right) in firsts.iter().enumerate() {
        for &left in firsts[..j].iter().rev() {
            // T_ll X_lr − X_lr T_rr = −Σ T_lk X_kr over the blocks k between, and the right one itself.
            let mut load = [[0.0; 2]; 2];
            for (a, row) in load.iter_mut().enumerate() {
                let between = &column(&rows, left + a)[left + 2..right + 2];
                for (b, cell) in row.iter_mut().enumerate() {
                    let known = &column(&x, right + b)[left + 2..right + 2];
                    *cell = between.iter().zip(known).fold(0.0, |sum, (t, x)| sum - t * x);
                }
            }
            let pieces = [left, right].map(|first| first..first + 2);
            put(&mut x, [left, right], sylvester(t, &pieces, &load));
        }
    }
    let y = inverse_of_unit_upper(&x);
    (x, y)
}

/// Solves L X − X R = load for diagonal pieces of order one or two, as a linear system of up to four unknowns.
fn sylvester(t: &DMatrix<f64>, [left, right]: &[Range<usize>; 2], load: &[[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let (rows, columns) = (left.len(), right.len());
    let order = rows * columns;
    let mut system = [[0.0; 5]; 4];
    for a in 0..rows {
        for b in 0..columns {
            let equation = a * columns + b;
            for k in 0..rows {
                system[equation][k * columns + b] += t[(left.start + a, left.start + k)];
            }
            for k in 0..columns {
                system[equation][a * columns + k] -= t[(right.start + k, right.start + b)];
            }
            system[equation][order] = load[a][b];
        }
    }
    // A singular system gives infinities, which the condition check refuses.
    match order {
        4 => eliminate(&mut system[..4]),
        2 => eliminate(&mut system[..2]),
        _ => eliminate(&mut system[..1]),
    }
    let mut x = [[0.0; 2]; 2];
    for a in 0..rows {
        for b in 0..columns {
            x[a][b] = system[a * columns + b][order];
        }
    }
    x
}

/// Zero eigenvalues arrive as large as the rounding. A coordinate that only a dashpot holds (`creeps`) has one: it is set to
/// zero. A rigid-body mode has two and one large entry: its exact form is [[0, b], [0, 0]].
fn settle([p, q, r, s]: [f64; 4], norm: f64, creeps: bool) -> [f64; 4] {
    let rounding = 64.0 * f64::EPSILON * norm;
    let [no_p, no_q, no_r, no_s] = [p, q, r, s].map(|entry| entry.abs() <= rounding);
    if creeps && (no_r || no_q) && (no_p || no_s) {
        let kept = |none: bool, entry: f64| if none { 0.0 } else { entry };
        return [kept(no_p, p), kept(no_q, q), kept(no_r, r), kept(no_s, s)];
    }
    if (p + s).abs() > rounding || (p * s - q * r).abs() > rounding * norm {
        return [p, q, r, s];
    }
    if q.abs() >= r.abs() { [0.0, q, 0.0, 0.0] } else { [0.0, 0.0, r, 0.0] }
}
