//! Splitting a linear system whose eigenvalues coalesce.
//!
//! Where modes of one frequency and damping meet (a tuned damper at its exceptional point) the matrix has no eigenbasis, and
//! near there one that costs digits. So eigenvalues that lie close together stay together: on their subspace, with T
//! upper triangular,
//!
//! e^(Tt) = Σⱼ Lⱼ(T) e^(zⱼt) + R,   |R| ≤ 2 (r t/2)ᴺ/N!,
//!
//! the interpolation polynomial of e^(zt) in z through N Chebyshev points zⱼ of a segment of half length r about them, along
//! the imaginary axis so that none grows. Lⱼ(T) is a product of factors (T − zₖ)/(zⱼ − zₖ): no inverse, no eigenvector. The
//! rest of the engine sees ordinary blocks, more of them than coordinates, which hold for a limited time.

use nalgebra::{Complex, DMatrix};

use crate::arithmetic::dense::{inverse_of_unit_upper, piece, product};
use crate::contact_state::spectral::Spectral;

type C = Complex<f64>;

/// Eigenvalues nearer to each other than this share of their modulus stay together; those further apart cost two digits at most.
const NEAR: f64 = 0.02;
/// r over the modulus of the eigenvalues, at least.
const REACH: f64 = 0.03;
/// N.
const NODES: usize = 12;
/// r t up to which the interpolation is exact to rounding: 2·0.3¹²/12! is 2.2e-15 of what turns; and less, as all nodes share it.
pub(crate) const TURN: f64 = 0.6;
/// Moduli below this share of the largest entry are rounding.
const NOTHING: f64 = 64.0 * f64::EPSILON;

/// A triangular form A = Q T Qᴴ.
struct Triangular {
    q: DMatrix<C>,
    t: DMatrix<C>,
}

/// Splits A = Q T Qᵀ, T its real Schur form.
pub(crate) fn split(q: &DMatrix<f64>, t: &DMatrix<f64>) -> Spectral {
    let order = t.nrows();
    let norm = t.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let mut form = Triangular::new(q, t);
    let clusters = form.gather();
    let (x, y) = form.decouple(&clusters);
    let (v, w) = (product(&form.q, &x), product(&y, &form.q.adjoint()));
    let mut parts = Parts { order, pieces: Pieces::default(), real: Vec::new(), lasts: f64::INFINITY };
    for cluster in clusters {
        let eigenvalues: Vec<C> = cluster.clone().map(|i| form.t[(i, i)]).collect();
        if let [only] = eigenvalues[..] {
            parts.single(settled(only, norm), &v, &w, cluster.start);
        } else {
            parts.several(&form.t, &eigenvalues, &v, &w, cluster);
        }
    }
    parts.finish()
}

/// Real where its imaginary part is rounding, zero where all of it is.
fn settled(eigenvalue: C, norm: f64) -> C {
    let kept = |part: f64| if part.abs() <= NOTHING * norm { 0.0 } else { part };
    if kept(eigenvalue.im) == 0.0 { C::new(kept(eigenvalue.re), 0.0) } else { eigenvalue }
}

impl Triangular {
    /// Turns the 2 × 2 pieces of a real Schur form upper triangular.
    fn new(q: &DMatrix<f64>, t: &DMatrix<f64>) -> Self {
        let complex = |m: &DMatrix<f64>| m.map(|x| C::new(x, 0.0));
        let mut form = Self { q: complex(q), t: complex(t) };
        for i in 0..t.nrows().saturating_sub(1) {
            if t[(i + 1, i)] != 0.0 {
                let [a, b, c, d] = piece(t, i);
                let half = 0.5 * (a - d);
                let discriminant = half * half + b * c;
                let root = discriminant.abs().sqrt();
                let root = if discriminant < 0.0 { C::new(0.0, root) } else { C::new(root.copysign(half), 0.0) };
                // (A − λ)(x, 1) = 0 in the second row: x = (λ − d)/c.
                form.turn(i, [(root + half) / c, C::new(1.0, 0.0)]);
                form.t[(i + 1, i)] = C::default();
            }
        }
        form
    }

    /// A unitary similarity in the plane of `i` and `i + 1` that turns `axis` to the first direction.
    fn turn(&mut self, i: usize, [x, y]: [C; 2]) {
        let length = (x.norm_sqr() + y.norm_sqr()).sqrt();
        if !(length > 0.0) {
            return;
        }
        let (x, y) = (x / length, y / length);
        for k in 0..self.t.ncols() {
            let (a, b) = (self.t[(i, k)], self.t[(i + 1, k)]);
            self.t[(i, k)] = x.conj() * a + y.conj() * b;
            self.t[(i + 1, k)] = x * b - y * a;
        }
        for k in 0..self.t.nrows() {
            for matrix in [&mut self.t, &mut self.q] {
                let (a, b) = (matrix[(k, i)], matrix[(k, i + 1)]);
                matrix[(k, i)] = a * x + b * y;
                matrix[(k, i + 1)] = b * x.conj() - a * y.conj();
            }
        }
    }

    /// Brings eigenvalues that are near each other together; gives where the clusters stand.
    fn gather(&mut self) -> Vec<std::ops::Range<usize>> {
        let order = self.t.nrows();
        let mut clusters = Vec::new();
        let mut first = 0;
        while first < order {
            let mut end = first + 1;
            // The next one that is near any of the cluster, until there is none.
            while let Some(found) = (end..order).find(|&k| (first..end).any(|i| near(self.t[(i, i)], self.t[(k, k)]))) {
                for k in (end..found).rev() {
                    // The eigenvector of the second: (t₁₂, t₂₂ − t₁₁).
                    let (own, next) = (self.t[(k, k)], self.t[(k + 1, k + 1)]);
                    self.turn(k, [self.t[(k, k + 1)], next - own]);
                    self.t[(k + 1, k)] = C::default();
                }
                end += 1;
            }
            clusters.push(first..end);
            first = end;
        }
        clusters
    }

    /// X with T X = X diag(clusters), unit upper triangular, and its inverse.
    fn decouple(&self, clusters: &[std::ops::Range<usize>]) -> (DMatrix<C>, DMatrix<C>) {
        let (order, t) = (self.t.nrows(), &self.t);
        let mut x = DMatrix::<C>::identity(order, order);
        for cluster in clusters {
            for j in cluster.clone() {
                for i in (0..cluster.start).rev() {
                    let own = (cluster.start..j).fold(C::default(), |sum, k| sum + x[(i, k)] * t[(k, j)]);
                    let all = (i + 1..=j).fold(own, |sum, k| sum - t[(i, k)] * x[(k, j)]);
                    x[(i, j)] = all / (t[(i, i)] - t[(j, j)]);
                }
            }
        }
        let y = inverse_of_unit_upper(&x);
        (x, y)
    }
}

fn near(a: C, b: C) -> bool {
    (a - b).norm_sqr() <= NEAR * NEAR * a.norm_sqr().max(b.norm_sqr())
}

/// The Chebyshev points of a segment.
pub(crate) fn nodes(centre: C, direction: C) -> Vec<C> {
    let node =
        |j: usize| centre + direction * libm::cos(std::f64::consts::PI * (2 * j + 1) as f64 / (2 * NODES) as f64);
    (0..NODES).map(node).collect()
}

/// Lⱼ(T) times a matrix.
pub(crate) fn lagrange(t: &DMatrix<C>, nodes: &[C], j: usize, mut rows: DMatrix<C>) -> DMatrix<C> {
    for k in (0..nodes.len()).filter(|&k| k != j) {
        let mut factor = t.clone();
        (0..t.nrows()).for_each(|i| factor[(i, i)] -= nodes[k]);
        rows = product(&factor, &rows) / (nodes[j] - nodes[k]);
    }
    rows
}

fn numbers<'a>(of: impl Iterator<Item = &'a C>) -> Vec<C> {
    of.copied().collect()
}

/// Blocks as they are found, with their columns of V and rows of W.
#[derive(Default)]
pub(crate) struct Pieces {
    pub(crate) matrices: Vec<[f64; 4]>,
    pub(crate) columns: Vec<Vec<f64>>,
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Pieces {
    /// Re(`factor`·v e^(zt) (w·x)): the coordinates are the real and the imaginary part of w·x.
    pub(crate) fn turning(&mut self, z: C, factor: f64, column: &[C], row: &[C]) {
        self.matrices.push([z.re, -z.im, z.im, z.re]);
        self.columns.push(column.iter().map(|v| factor * v.re).collect());
        self.columns.push(column.iter().map(|v| -factor * v.im).collect());
        self.rows.push(row.iter().map(|w| w.re).collect());
        self.rows.push(row.iter().map(|w| w.im).collect());
    }
}

/// What the split is made of.
struct Parts {
    order: usize,
    pieces: Pieces,
    /// Single real eigenvalues, which make blocks two by two.
    real: Vec<(f64, Vec<f64>, Vec<f64>)>,
    lasts: f64,
}

impl Parts {
    /// An eigenvalue that stands alone; of a complex pair the upper one speaks for both.
    fn single(&mut self, eigenvalue: C, v: &DMatrix<C>, w: &DMatrix<C>, i: usize) {
        let (column, row) = (numbers(v.column(i).iter()), numbers(w.row(i).iter()));
        if eigenvalue.im == 0.0 {
            let real = |numbers: Vec<C>| numbers.iter().map(|z| z.re).collect();
            self.real.push((eigenvalue.re, real(column), real(row)));
        } else if eigenvalue.im > 0.0 {
            self.pieces.turning(eigenvalue, 2.0, &column, &row);
        }
    }

    /// Eigenvalues that stay together, by interpolation.
    fn several(
        &mut self,
        t: &DMatrix<C>,
        eigenvalues: &[C],
        v: &DMatrix<C>,
        w: &DMatrix<C>,
        at: std::ops::Range<usize>,
    ) {
        let count = eigenvalues.len();
        let mut centre = eigenvalues.iter().sum::<C>() / count as f64;
        let spread = |centre: C| eigenvalues.iter().fold(0.0_f64, |most, z| most.max((z - centre).norm_sqr())).sqrt();
        let both_halves = eigenvalues.iter().any(|z| z.im > 0.0) && eigenvalues.iter().any(|z| z.im < 0.0);
        let on_axis = both_halves || centre.im.abs() <= spread(centre);
        if on_axis {
            centre.im = 0.0;
        } else if centre.im < 0.0 {
            return;
        }
        let radius = (REACH * centre.norm_sqr().sqrt()).max(1.25 * spread(centre));
        self.lasts = self.lasts.min(TURN / radius);
        // Along the axis that keeps the nodes of a pair from growing, or real.
        let direction = if on_axis { C::new(radius, 0.0) } else { C::new(0.0, radius) };
        let nodes = nodes(centre, direction);
        let own = t.view((at.start, at.start), (count, count)).into_owned();
        let (columns, rows) = (v.columns(at.start, count), w.rows(at.start, count));
        for j in 0..NODES {
            let rows = lagrange(&own, &nodes, j, rows.into_owned());
            for i in 0..count {
                let (column, row) = (numbers(columns.column(i).iter()), numbers(rows.row(i).iter()));
                self.pieces.turning(nodes[j], if on_axis { 1.0 } else { 2.0 }, &column, &row);
            }
        }
    }

    fn finish(mut self) -> Spectral {
        if self.real.len() % 2 == 1 {
            // Alone: beside it a coordinate that nothing moves and that moves nothing.
            let rate = self.real[self.real.len() - 1].0;
            self.real.push((rate, vec![0.0; self.order], vec![0.0; self.order]));
        }
        let Self { order, pieces: Pieces { mut matrices, mut columns, mut rows }, real, lasts } = self;
        for pair in real.chunks_exact(2) {
            matrices.push([pair[0].0, 0.0, 0.0, pair[1].0]);
            for (_, column, row) in pair {
                columns.push(column.clone());
                rows.push(row.clone());
            }
        }
        let from_blocks = (0..order).flat_map(|i| columns.iter().map(move |column| column[i])).collect();
        Spectral::new(from_blocks, rows.concat(), matrices, lasts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mass on a spring and a tuned damper on it. At (1 + μ) ω = 1 and ζ² = μ/(1 + μ) its two pairs of eigenvalues are one
    /// (Krenk, J. Appl. Mech. 72, 2005); `apart` moves the damping away from there.
    fn tuned_damper(apart: f64) -> [f64; 16] {
        let mass_ratio = 0.05_f64;
        let omega = 1.0 / (1.0 + mass_ratio);
        let zeta = (mass_ratio / (1.0 + mass_ratio)).sqrt() * (1.0 + apart);
        let (k, c) = (omega * omega, 2.0 * zeta * omega);
        // Coordinates (u, w, u′, w′) with w relative to the mass.
        #[rustfmt::skip]
        let matrix = [
            0.0, 0.0, 1.0, 0.0,
            0.0, 0.0, 0.0, 1.0,
            -1.0, mass_ratio * k, 0.0, mass_ratio * c,
            1.0, -(1.0 + mass_ratio) * k, 0.0, -(1.0 + mass_ratio) * c,
        ];
        matrix
    }

    /// e^(At) by Taylor's series of a short time, squared again and again.
    fn exponential(a: &DMatrix<f64>, t: f64) -> DMatrix<f64> {
        let short = a * (t / 1024.0);
        let mut sum = DMatrix::identity(4, 4);
        let mut term = DMatrix::identity(4, 4);
        for j in 1..12 {
            term = &term * &short / j as f64;
            sum += &term;
        }
        (0..10).for_each(|_| sum = &sum * &sum);
        sum
    }

    #[test]
    fn the_flow_does_not_depend_on_how_nearly_modes_coalesce() {
        let mut held_together = 0;
        for apart in (-200..=200).map(|step| f64::from(step) * 1e-4).chain([-1e-7, 1e-9, 1e-13]) {
            let entries = tuned_damper(apart);
            let split = crate::contact_state::schur_split::split(4, &entries).unwrap();
            held_together += i32::from(split.lasts.is_finite());
            let a = DMatrix::from_row_slice(4, 4, &entries);
            let t = split.lasts.min(7.0);
            let exact = exponential(&a, t);
            let width = 2 * split.blocks.len();
            let moved = |column: usize| {
                let mut c = vec![0.0; width];
                for (k, (block, [p, q, r, s])) in split.blocks.iter().zip(&split.matrices).enumerate() {
                    let (x, y) = (split.to_blocks[2 * k * 4 + column], split.to_blocks[(2 * k + 1) * 4 + column]);
                    let (kernel, a) = (block.kernel(t), block.decay);
                    c[2 * k] = kernel.c * x + kernel.s * ((p + a) * x + q * y);
                    c[2 * k + 1] = kernel.c * y + kernel.s * (r * x + (s + a) * y);
                }
                c
            };
            for column in 0..4 {
                let c = moved(column);
                for row in 0..4 {
                    let value: f64 = (0..width).map(|k| split.from_blocks[row * width + k] * c[k]).sum();
                    let error = (value - exact[(row, column)]).abs();
                    assert!(error < 1e-11, "{apart}: {error:e} in {row}, {column}");
                }
            }
        }
        assert!(held_together > 3, "{held_together} of them were held together");
    }
}
