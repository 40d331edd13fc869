//! Splitting a linear system into independent 2 × 2 blocks.
//!
//! A = V diag(B₁, B₂, …) V⁻¹ with real 2 × 2 blocks: real Schur form, then Sylvester equations that remove what is left
//! above the diagonal (Bavely & Stewart, SIAM J. Numer. Anal. 16, 1979). A block keeps a complex pair or two real
//! eigenvalues *together*, so a critically damped contact needs no eigenvectors and costs no digits.

use nalgebra::{DMatrix, Schur};

use super::EngineError;
use super::block::Block;

/// A = V diag(Bₖ) W with W = V⁻¹.
#[derive(Default)]
pub(crate) struct Spectral {
    /// V, row by row, order × order.
    pub(crate) from_blocks: Vec<f64>,
    /// W.
    pub(crate) to_blocks: Vec<f64>,
    /// Entries of each block, [[p, q], [r, s]] flattened.
    pub(crate) matrices: Vec<[f64; 4]>,
    /// Their invariants.
    pub(crate) blocks: Vec<Block>,
}

/// Above this the blocks are too nearly dependent to be worth their digits.
const WORST_CONDITION: f64 = 1e7;

impl Spectral {
    /// Splits `matrix` (row by row, of even `order`).
    pub(crate) fn split(order: usize, matrix: &[f64]) -> Result<Self, EngineError> {
        if order == 2 {
            return Ok(Self::single(matrix));
        }
        let a = DMatrix::from_row_slice(order, order, matrix);
        let norm = a.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let schur = Schur::try_new(a, f64::EPSILON, 200 * order).ok_or(EngineError::NoSchurForm { order })?;
        let (q, t) = schur.unpack();
        let atoms = atoms(&t, norm);
        let (x, y) = decouple(&t, &atoms);
        let v = product(&q, &x);
        let w = product(&y, &q.transpose());
        let condition = largest(&x) * largest(&y);
        if !(condition < WORST_CONDITION) {
            return Err(EngineError::NearlyDefective { condition });
        }
        let pairs = pair(&t, &atoms);
        let mut spectral = Self {
            from_blocks: vec![0.0; order * order],
            to_blocks: vec![0.0; order * order],
            matrices: Vec::with_capacity(order / 2),
            blocks: Vec::with_capacity(order / 2),
        };
        for (k, [i, j]) in pairs.iter().enumerate() {
            let coupled = j == &(i + 1) && atoms.iter().any(|atom| atom.first == *i && atom.size == 2);
            let entries = if coupled {
                [t[(*i, *i)], t[(*i, *j)], t[(*j, *i)], t[(*j, *j)]]
            } else {
                [t[(*i, *i)], 0.0, 0.0, t[(*j, *j)]]
            };
            let entries = settle(entries, norm);
            spectral.matrices.push(entries);
            spectral.blocks.push(Block::new(entries));
            for row in 0..order {
                spectral.from_blocks[row * order + 2 * k] = v[(row, *i)];
                spectral.from_blocks[row * order + 2 * k + 1] = v[(row, *j)];
                spectral.to_blocks[2 * k * order + row] = w[(*i, row)];
                spectral.to_blocks[(2 * k + 1) * order + row] = w[(*j, row)];
            }
        }
        Ok(spectral)
    }

    fn single(matrix: &[f64]) -> Self {
        let entries = [matrix[0], matrix[1], matrix[2], matrix[3]];
        Self {
            from_blocks: vec![1.0, 0.0, 0.0, 1.0],
            to_blocks: vec![1.0, 0.0, 0.0, 1.0],
            matrices: vec![entries],
            blocks: vec![Block::new(entries)],
        }
    }
}

/// A diagonal piece of the Schur form: one real eigenvalue, or two eigenvalues that stay together.
struct Atom {
    first: usize,
    size: usize,
}

fn atoms(t: &DMatrix<f64>, norm: f64) -> Vec<Atom> {
    let order = t.nrows();
    let coupled = |i: usize| i + 1 < order && t[(i + 1, i)] != 0.0;
    let mut atoms = Vec::new();
    let mut i = 0;
    while i < order {
        if coupled(i) {
            atoms.push(Atom { first: i, size: 2 });
            i += 2;
        } else if i + 1 < order && !coupled(i + 1) && close(t[(i, i)], t[(i + 1, i + 1)], norm) {
            // Two real eigenvalues near each other: splitting them would be ill-conditioned, and is not needed.
            atoms.push(Atom { first: i, size: 2 });
            i += 2;
        } else {
            atoms.push(Atom { first: i, size: 1 });
            i += 1;
        }
    }
    atoms
}

fn close(a: f64, b: f64, norm: f64) -> bool {
    (a - b).abs() <= 0.1 * (a.abs() + b.abs()) + 1e-7 * norm
}

/// Which two diagonal places of T make each block: the atoms of size two, and the single ones in the order they stand.
fn pair(t: &DMatrix<f64>, atoms: &[Atom]) -> Vec<[usize; 2]> {
    let mut pairs = Vec::with_capacity(t.nrows() / 2);
    let mut waiting = None;
    for atom in atoms {
        match (atom.size, waiting) {
            (2, _) => pairs.push([atom.first, atom.first + 1]),
            (_, None) => waiting = Some(atom.first),
            (_, Some(first)) => {
                pairs.push([first, atom.first]);
                waiting = None;
            }
        }
    }
    pairs
}

/// X with T X = X diag(atoms), unit upper triangular by atoms, and its inverse.
fn decouple(t: &DMatrix<f64>, atoms: &[Atom]) -> (DMatrix<f64>, DMatrix<f64>) {
    let order = t.nrows();
    let mut x = DMatrix::identity(order, order);
    for (j, right) in atoms.iter().enumerate() {
        for left in atoms[..j].iter().rev() {
            // T_ll X_lr − X_lr T_rr = −Σ T_lk X_kr over the atoms k between.
            let from = left.first + left.size;
            let to = right.first + right.size;
            let mut load = [[0.0; 2]; 2];
            for (a, row) in load.iter_mut().enumerate().take(left.size) {
                for (b, cell) in row.iter_mut().enumerate().take(right.size) {
                    let mut sum = 0.0;
                    for k in from..to {
                        sum -= t[(left.first + a, k)] * x[(k, right.first + b)];
                    }
                    *cell = sum;
                }
            }
            let solution = sylvester(t, left, right, &load);
            for (a, row) in solution.iter().enumerate().take(left.size) {
                for (b, cell) in row.iter().enumerate().take(right.size) {
                    x[(left.first + a, right.first + b)] = *cell;
                }
            }
        }
    }
    // The inverse of a unit upper triangular matrix, column by column.
    let mut y = DMatrix::identity(order, order);
    for j in 0..order {
        for i in (0..j).rev() {
            let mut sum = 0.0;
            for k in i + 1..=j {
                sum -= x[(i, k)] * y[(k, j)];
            }
            y[(i, j)] = sum;
        }
    }
    (x, y)
}

/// Solves L X − X R = load for blocks of order one or two, as a linear system of up to four unknowns.
fn sylvester(t: &DMatrix<f64>, left: &Atom, right: &Atom, load: &[[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let (rows, columns) = (left.size, right.size);
    let order = rows * columns;
    let mut system = [[0.0; 5]; 4];
    for a in 0..rows {
        for b in 0..columns {
            let equation = a * columns + b;
            for k in 0..rows {
                system[equation][k * columns + b] += t[(left.first + a, left.first + k)];
            }
            for k in 0..columns {
                system[equation][a * columns + k] -= t[(right.first + k, right.first + b)];
            }
            system[equation][4] = load[a][b];
        }
    }
    let solution = solve_small(order, &mut system);
    let mut x = [[0.0; 2]; 2];
    for a in 0..rows {
        for b in 0..columns {
            x[a][b] = solution[a * columns + b];
        }
    }
    x
}

/// Gaussian elimination with partial pivoting; a singular system gives infinities, which the condition check refuses.
fn solve_small(order: usize, system: &mut [[f64; 5]; 4]) -> [f64; 4] {
    for column in 0..order {
        let pivot = (column..order)
            .max_by(|&i, &j| system[i][column].abs().total_cmp(&system[j][column].abs()))
            .unwrap_or(column);
        system.swap(column, pivot);
        for row in column + 1..order {
            let factor = system[row][column] / system[column][column];
            for k in column..order {
                system[row][k] -= factor * system[column][k];
            }
            system[row][4] -= factor * system[column][4];
        }
    }
    let mut solution = [0.0; 4];
    for row in (0..order).rev() {
        let mut sum = system[row][4];
        for k in row + 1..order {
            sum -= system[row][k] * solution[k];
        }
        solution[row] = sum / system[row][row];
    }
    solution
}

/// A rigid-body mode arrives as a block of the size of the rounding, with one large entry: its exact form is [[0, b], [0, 0]].
fn settle([p, q, r, s]: [f64; 4], norm: f64) -> [f64; 4] {
    let rounding = 64.0 * f64::EPSILON * norm;
    if (p + s).abs() > rounding || (p * s - q * r).abs() > rounding * norm {
        return [p, q, r, s];
    }
    if q.abs() >= r.abs() { [0.0, q, 0.0, 0.0] } else { [0.0, 0.0, r, 0.0] }
}

/// Own loops: the library's product picks its kernel, and with it the last bit, by processor.
fn product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(a.nrows(), b.ncols(), |i, j| (0..a.ncols()).fold(0.0, |sum, k| sum + a[(i, k)] * b[(k, j)]))
}

fn largest(m: &DMatrix<f64>) -> f64 {
    m.iter().fold(0.0_f64, |largest, x| if x.is_nan() { f64::INFINITY } else { largest.max(x.abs()) })
}
