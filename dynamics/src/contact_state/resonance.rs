//! A mode with next to no damping that is driven next to its own frequency.
//!
//! Its steady answer is far above the motion, which is the small difference of that answer and of the free motion, and exactly at
//! resonance there is none: the motion grows with time. So mode and drive stay together. With z the mode's complex coordinate
//! and D = F e^(iωt), z = κ D̄ + ζ, where the part that turns against the mode is steady, and
//!
//! (ζ, D)′ = T (ζ, D),   T = [[λ, β/2i], [0, iω]],   ζ(t) = Σⱼ e₁ᵀLⱼ(T) (ζ, D) e^(zⱼt),
//!
//! the interpolation of [`super::cluster`] through points about λ and iω: nothing is divided by λ − iω, so that the motion is smooth
//! through resonance. What comes of it are ordinary blocks that hold for about a cycle and enter with the phase of the drive.

use nalgebra::{Complex, DMatrix};

use crate::arithmetic::matrix::dot;
use crate::contact_state::block::Block;
use crate::contact_state::cluster::{self, Pieces};
use crate::contact_state::load::Steady;
use crate::contact_state::spectral::Spectral;

type C = Complex<f64>;

/// A mode is driven next to its own frequency if its eigenvalue is this near to iω, as a share of ω.
const NEAR: f64 = 0.01;
/// Half length of the segment of the points, as a share of ω: they hold for a little more than a cycle.
const REACH: f64 = 0.09;

/// The blocks of an undriven contact state with those taken apart that the drive is in resonance with, and the steady answer of
/// all the rest; `None` if there is no such block. `push` is p″ under a unit force.
pub(crate) fn split(spectral: &Spectral, order: usize, push: &[f64], omega: f64) -> Option<(Spectral, Steady)> {
    let width = spectral.width();
    let is_near = |block: &Block| block.oscillates() && libm::hypot(block.decay, block.root - omega) <= NEAR * omega;
    if !spectral.blocks.iter().any(is_near) {
        return None;
    }
    let mut parts = Parts::new(order, omega, spectral.lasts);
    for (k, (block, matrix)) in spectral.blocks.iter().zip(&spectral.matrices).enumerate() {
        let columns = [0, 1].map(|i| spectral.column(2 * k + i).collect());
        let rows = [0, 1].map(|i| (0..2 * order).map(|row| spectral.to_blocks[row * width + 2 * k + i]).collect());
        let own = Own { matrix: *matrix, columns, rows };
        let load = own.rows.each_ref().map(|row| (0..order).map(|i| row[order + i] * push[i]).sum::<f64>());
        if is_near(block) && load != [0.0; 2] {
            parts.resonant(block, &own, load);
        } else {
            parts.steady(own, load);
        }
    }
    Some(parts.finish())
}

/// A block with its columns of V and rows of W.
struct Own {
    matrix: [f64; 4],
    columns: [Vec<f64>; 2],
    rows: [Vec<f64>; 2],
}

/// What the split is made of.
struct Parts {
    order: usize,
    omega: f64,
    /// Their rows by coordinates, rates, and cosine and sine of the drive.
    pieces: Pieces,
    cosine: Vec<f64>,
    sine: Vec<f64>,
    /// Rates of ζ that come from D, by cosine and sine: part of ζ′ and not of the rates λζ that block coordinates go with.
    pushed: [Vec<f64>; 2],
    lasts: f64,
}

impl Parts {
    fn new(order: usize, omega: f64, lasts: f64) -> Self {
        let still = vec![0.0; order];
        let pushed = [still.clone(), still.clone()];
        Self { order, omega, pieces: Pieces::default(), cosine: still.clone(), sine: still, pushed, lasts }
    }

    /// c = P cos ωt + Q sin ωt with (B² + ω²) P = −ω g and ω Q = B P.
    fn steady(&mut self, own: Own, [gx, gy]: [f64; 2]) {
        let ([p, q, r, s], omega) = (own.matrix, self.omega);
        let square = [p * p + q * r + omega * omega, q * (p + s), r * (p + s), s * s + q * r + omega * omega];
        let determinant = square[0] * square[3] - square[1] * square[2];
        let (lx, ly) = (-omega * gx, -omega * gy);
        let (x, y) = ((square[3] * lx - square[1] * ly) / determinant, (square[0] * ly - square[2] * lx) / determinant);
        let turned = [(p * x + q * y) / omega, (r * x + s * y) / omega];
        for i in 0..self.order {
            self.cosine[i] += own.columns[0][i] * x + own.columns[1][i] * y;
            self.sine[i] += own.columns[0][i] * turned[0] + own.columns[1][i] * turned[1];
        }
        self.pieces.matrices.push(own.matrix);
        self.pieces.columns.extend(own.columns);
        self.pieces.rows.extend(own.rows.map(|mut row| {
            row.extend([0.0; 2]);
            row
        }));
    }

    /// A block beside the drive.
    fn resonant(&mut self, block: &Block, own: &Own, [gx, gy]: [f64; 2]) {
        let ([p, q, r, _], omega) = (own.matrix, C::new(0.0, self.omega));
        let lambda = C::new(-block.decay, block.root);
        // B v = λ v, w B = λ w, w v = 1: c = 2 Re(v z), z = w c.
        let v = [C::new(q, 0.0), lambda - p];
        let size = v[1] * v[1] + q * r;
        let w = [C::new(r, 0.0) / size, v[1] / size];
        let beta = w[0] * gx + w[1] * gy;
        let kappa = beta / (C::new(0.0, 2.0) * (lambda + omega));
        let shape: Vec<C> = (0..self.order).map(|i| v[0] * own.columns[0][i] + v[1] * own.columns[1][i]).collect();
        for i in 0..self.order {
            let answer = shape[i] * kappa;
            self.cosine[i] += 2.0 * answer.re;
            self.sine[i] += 2.0 * answer.im;
            let pushed = shape[i] * beta / C::new(0.0, 2.0);
            self.pushed[0][i] += 2.0 * pushed.re;
            self.pushed[1][i] -= 2.0 * pushed.im;
        }
        let seen: Vec<C> = (0..2 * self.order).map(|i| w[0] * own.rows[0][i] + w[1] * own.rows[1][i]).collect();
        let centre = (lambda + omega) * 0.5;
        let radius = (REACH * self.omega).max(1.25 * (lambda - omega).norm_sqr().sqrt());
        self.lasts = self.lasts.min(cluster::TURN / radius);
        let nodes = cluster::nodes(centre, C::new(0.0, radius));
        let t = DMatrix::from_row_slice(2, 2, &[lambda, beta / C::new(0.0, 2.0), C::default(), omega]);
        for (j, node) in nodes.iter().enumerate() {
            let first = cluster::lagrange(&t, &nodes, j, DMatrix::identity(2, 2));
            let (by_mode, by_drive) = (first[(0, 0)], first[(0, 1)]);
            let row: Vec<C> =
                seen.iter().map(|entry| by_mode * entry).chain([by_drive, by_drive * C::new(0.0, 1.0)]).collect();
            // Its rates are those of its places, so that each of the blocks moves by itself.
            let column: Vec<C> = shape.iter().copied().chain(shape.iter().map(|v| v * node)).collect();
            self.pieces.turning(*node, 2.0, &column, &row);
        }
    }

    fn finish(self) -> (Spectral, Steady) {
        let Self { order, omega, pieces, cosine, sine, pushed, lasts } = self;
        let Pieces { matrices, columns, mut rows } = pieces;
        for row in &mut rows {
            for (phase, pushed) in pushed.iter().enumerate() {
                let seen = dot(&row[order..2 * order], pushed);
                row[2 * order + phase] -= seen;
            }
        }
        let from_blocks = (0..2 * order).flat_map(|i| columns.iter().map(move |column| column[i])).collect();
        let to_blocks = (0..2 * order + 2).flat_map(|i| rows.iter().map(move |row| row[i])).collect();
        let spectral = Spectral::new(from_blocks, to_blocks, matrices, lasts);
        (spectral.fastest_first(), Steady { omega, cosine, sine })
    }
}
