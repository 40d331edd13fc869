//! Modes of a contact state with dashpots, found from its normal modes.
//!
//! In normal coordinates of modal mass 1, (λ² + λ C + Ω²) x = 0 with C symmetric. Beside each normal mode k there is a damped one with
//! x_k = 1. Elimination of the other coordinates leaves one equation for λ,
//!
//! r(λ) = xᵀ (λ² + λ C + Ω²) x = 0,   r′ = xᵀ (2 λ + C) x = (σ + r)/λ,   σ = λ² xᵀx − xᵀΩ²x,
//!
//! which Newton's method solves in two steps or three, several modes side by side. It starts from the mode's own share of the damping,
//! so that nothing depends on what was solved before, and from what couples other modes with that one alone, which costs next to nothing;
//! a mode that its own share overdamps has two starts, both real. The matrix of (Ω q, q′) is
//! symmetric but for signs, so that each column is its own row:
//!
//! v = (Ω x, λ x),   w = (−Ω x, λ x)/σ.
//!
//! What does not converge, comes near critical damping, or leaves the modes dependent on each other, is none of this: a Schur form
//! splits it.

use std::cell::RefCell;

use nalgebra::DMatrix;

use crate::arithmetic::complexes::Complexes;
use crate::arithmetic::dense::invert_again;
use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::wide::widened;
use crate::contact_state::block::Block;
use crate::contact_state::spectral::Spectral;
use crate::contact_state::undamped::NormalModes;

/// Newton's steps; three are usual.
const MOST_STEPS: usize = 12;
/// A step below this share of λ leaves an error of its square; the next one shows it.
const LAST_STEP: f64 = 1e-8;
const CONVERGED: f64 = 1e-13;
/// And below this it is rounding, whatever was before.
const NOTHING: f64 = 1e-15;
/// σ below this share of its terms is that of two eigenvalues about to meet: a mode near critical damping. By a block for each, integrals
/// of squares would be differences of terms that grow as 1/σ².
const CRITICAL: f64 = 1e-2;
/// w v of two modes above this is corrected, and above `DEPENDENT` they are no basis.
const ROUNDING: f64 = 2e-15;
const DEPENDENT: f64 = 1e-8;
/// What w v of two modes may be, times the distance of their eigenvalues: A V = V B misses as much.
const MISSED: f64 = 2e-14;

/// Splits (e, e′) under the dashpots `damping`, row by row in normal coordinates of modal mass 1: V and W as
/// [`crate::contact_state::modes::split`] has them, in the `room` of others; fastest blocks first, as far as starts can tell.
pub(crate) fn split(modes: &NormalModes, damping: &[f64], room: Spectral) -> Option<Spectral> {
    let problem = Problem::new(modes, damping);
    WORK.with_borrow_mut(|work| {
        work.make_room(modes.omega.len());
        for first in (0..problem.starts.len()).step_by(WIDTH) {
            let found = problem.solve(first, work)?;
            work.found.push(found);
        }
        let independence = problem.independence(&work.found, &work.shapes);
        if matches!(independence, Independence::None) {
            return None;
        }
        let mut spectral = problem.assemble(&work.found, &work.shapes, room);
        if matches!(independence, Independence::Near) {
            correct(&mut spectral);
        }
        Some(spectral)
    })
}

thread_local! {
    static WORK: RefCell<Work> = RefCell::default();
}

/// The equation of all modes.
struct Problem<'a> {
    modes: &'a NormalModes,
    damping: &'a [f64],
    starts: Vec<Start>,
}

/// Where the search for an eigenvalue begins; the fastest ones come first, as blocks do.
#[derive(Clone, Copy)]
struct Start {
    /// The normal mode beside which it lies.
    mode: usize,
    re: f64,
    /// 0 of an overdamped mode.
    im: f64,
}

impl Start {
    fn is_real(self) -> bool {
        self.im == 0.0
    }

    fn square(self) -> f64 {
        self.re * self.re + self.im * self.im
    }
}

/// Several modes; their shapes stand in [`Work`].
struct Found {
    lambda: Complexes,
    /// σ.
    size: Complexes,
}

/// How nearly W V is 1.
enum Independence {
    /// To rounding.
    Exact,
    /// Up to a small correction.
    Near,
    /// Not at all.
    None,
}

impl<'a> Problem<'a> {
    fn new(modes: &'a NormalModes, damping: &'a [f64]) -> Self {
        let n = modes.omega.len();
        let mut starts = Vec::with_capacity(n);
        for (mode, omega) in modes.omega.iter().enumerate() {
            let half = 0.5 * damping[mode * n + mode];
            let square = omega * omega - half * half;
            if square > 0.0 {
                starts.push(Start { mode, re: -half, im: square.sqrt() });
            } else {
                let fast = half + (-square).sqrt();
                starts.extend([-fast, -omega * omega / fast].map(|re| Start { mode, re, im: 0.0 }));
            }
        }
        starts.sort_by(|one, other| other.square().total_cmp(&one.square()));
        Self { modes, damping, starts }
    }

    /// Which starts stand side by side, beginning with `first`; the last one fills up.
    fn side_by_side(&self, first: usize) -> [usize; WIDTH] {
        std::array::from_fn(|lane| (first + lane).min(self.starts.len() - 1))
    }

    widened! {
        /// Modes from `first` on.
        fn solve | solve_wide (&self, first: usize, work: &mut Work) -> Option<Found> = solve_by_registers
    }

    #[inline(always)]
    fn solve_by_registers(&self, first: usize, work: &mut Work) -> Option<Found> {
        let (n, omega) = (self.modes.omega.len(), &self.modes.omega);
        let starts = self.side_by_side(first).map(|start| self.starts[start]);
        work.own = starts.map(|start| start.mode);
        for (i, (row, entries)) in work.damping.chunks_exact_mut(n).zip(self.damping.chunks_exact(n)).enumerate() {
            row[..=i].iter_mut().zip(entries).for_each(|(to, entry)| *to = Four::all(*entry));
            work.squares[i] = Four::all(omega[i] * omega[i]);
        }
        // Each mode's own coordinate is the last of its equation, and the last one stands in its place.
        let last = n - 1;
        for (lane, own) in work.own.into_iter().enumerate() {
            let (of_last, of_own) = (&self.damping[last * n..], &self.damping[own * n..]);
            for (to, from) in work.damping[own * n..][..own].iter_mut().zip(of_last) {
                to.set(lane, *from);
            }
            for i in own + 1..last {
                work.damping[i * n + own].set(lane, of_last[i]);
            }
            for (to, from) in work.damping[last * n..].iter_mut().zip(of_own) {
                to.set(lane, *from);
            }
            work.damping[last * n + own].set(lane, of_own[last]);
            work.damping[own * n + own].set(lane, of_last[last]);
            work.damping[last * n + last].set(lane, of_own[own]);
            work.squares[own].set(lane, omega[last] * omega[last]);
            work.squares[last].set(lane, omega[own] * omega[own]);
        }
        work.lambda =
            Complexes { re: Four::new(starts.map(|start| start.re)), im: Four::new(starts.map(|start| start.im)) };
        nearer(work);
        work.lambda = work.lambda.minus(work.step);
        let mut is_last = false;
        for _ in 0..MOST_STEPS {
            // With a few modes the compiler unrolls loops over them.
            match n {
                5 => newton::<5>(work),
                6 => newton::<6>(work),
                7 => newton::<7>(work),
                8 => newton::<8>(work),
                _ => newton::<0>(work),
            }
            let [step, size] = [&work.step, &work.lambda].map(|z| z.square().array());
            let below = |share: f64| (0..WIDTH).all(|lane| step[lane] <= share * share * size[lane]);
            if is_last || below(NOTHING) {
                return if below(CONVERGED) { found(work) } else { None };
            }
            is_last = below(LAST_STEP);
            work.lambda = work.lambda.minus(work.step);
        }
        None
    }

    widened! {
        /// How nearly each mode's row passes over all other modes.
        fn independence | independence_wide (&self, found: &[Found], shapes: &[Complexes]) -> Independence = independence_by_registers
    }

    #[inline(always)]
    fn independence_by_registers(&self, found: &[Found], shapes: &[Complexes]) -> Independence {
        let n = self.modes.omega.len();
        let (mut most, mut worst) = (Four::ZERO, Four::ZERO);
        let larger = |a: f64, b: f64| if a < b || b.is_nan() { b } else { a };
        let [dependent, missed, rounding] = [DEPENDENT, MISSED, ROUNDING].map(|x| (x * x) * (x * x));
        for (group, (Found { lambda, size }, shape)) in found.iter().zip(shapes.chunks_exact(n)).enumerate() {
            let own = self.side_by_side(group * WIDTH);
            let inverse = size.square().map(|square| 1.0 / square);
            // w v of one mode and another is v w of the other and the one.
            for other in group * WIDTH..self.starts.len() {
                let (of_other, lane) = (other / WIDTH, other % WIDTH);
                let (others, of_others) = (&found[of_other], &shapes[of_other * n..]);
                // Σ x y and Σ Ω² x y, with y and with its conjugate.
                let (mut sums, mut stiff) = ([Four::ZERO; 4], [Four::ZERO; 4]);
                for ((x, y), omega) in shape.iter().zip(of_others).zip(&self.modes.omega) {
                    let (y, square) = (y.all(lane), omega * omega);
                    let terms = [x.re * y.re, x.im * y.im, x.re * y.im, x.im * y.re];
                    for i in 0..4 {
                        sums[i] = sums[i] + terms[i];
                        stiff[i] = stiff[i] + terms[i] * square;
                    }
                }
                let plain = |[a, b, c, d]: [Four; 4]| Complexes { re: a - b, im: c + d };
                let conjugate = |[a, b, c, d]: [Four; 4]| Complexes { re: a + b, im: d - c };
                let next = others.lambda.all(lane);
                let mirrored = next.conjugate();
                let not_itself = Four::new(own.map(|own| if own == other { 0.0 } else { 1.0 }));
                // A real mode is its own mirror image.
                let not_mirrored = if self.starts[other].is_real() { not_itself } else { Four::all(1.0) };
                let scale = inverse * (1.0 / others.size.all(lane).square().at(0));
                let pairs = [
                    (next, plain(sums), plain(stiff), not_itself),
                    (mirrored, conjugate(sums), conjugate(stiff), not_mirrored),
                ];
                for (next, sum, stiff, counts) in pairs {
                    // |w v|⁴, and what it makes A V = V B miss, to the same power.
                    let shared = lambda.times(next).times(sum).minus(stiff).square() * counts;
                    let fourth = shared * shared * scale;
                    most = most.zip(fourth, larger);
                    // What it is multiplied by is below four: nothing is missed.
                    if (fourth * 4.0).array().iter().all(|fourth| *fourth < missed) {
                        continue;
                    }
                    let apart = lambda.minus(next).square() * (lambda.square() + next.square()).map(|size| 1.0 / size);
                    worst = worst.zip(fourth * apart * apart, larger);
                }
            }
        }
        let [most, worst] = [most, worst].map(|fourth| fourth.largest());
        if !(most < dependent && worst < missed) {
            Independence::None
        } else if most < rounding {
            Independence::Exact
        } else {
            Independence::Near
        }
    }

    widened! {
        /// Their blocks, with V and W.
        fn assemble | assemble_wide (&self, found: &[Found], shapes: &[Complexes], room: Spectral) -> Spectral = assemble_by_registers
    }

    #[inline(always)]
    fn assemble_by_registers(&self, found: &[Found], shapes: &[Complexes], room: Spectral) -> Spectral {
        let (n, count) = (self.modes.omega.len(), self.starts.len());
        let width = 2 * count;
        let Spectral { mut from_blocks, mut to_blocks, mut matrices, mut blocks, .. } = room;
        matrices.clear();
        blocks.clear();
        for numbers in [&mut from_blocks, &mut to_blocks] {
            numbers.resize(2 * n * width, 0.0);
        }
        for (group, (Found { lambda, size }, shape)) in found.iter().zip(shapes.chunks_exact(n)).enumerate() {
            let first = group * WIDTH;
            let lanes = WIDTH.min(count - first);
            matrices.extend((0..lanes).map(|lane| {
                let (a, b) = (lambda.re.at(lane), lambda.im.at(lane));
                [a, -b, b, a]
            }));
            // A real mode has no conjugate, and leaves the second coordinate of its block alone.
            let is_real = self.side_by_side(first).map(|start| self.starts[start].is_real());
            let twice = Four::new(is_real.map(|is_real| if is_real { 1.0 } else { 2.0 }));
            let inverse = size.inverse();
            for (i, factors) in self.modes.factors.chunks_exact(n).enumerate() {
                let mut by_modes = [Complexes::ZERO; 3];
                for (x, factors) in shape.iter().zip(factors) {
                    for (sum, factor) in by_modes.iter_mut().zip(factors) {
                        *sum = sum.plus(x.scaled(Four::all(*factor)));
                    }
                }
                let [place, stiff, moving] = by_modes;
                let columns = [place, lambda.times(place)];
                let rows = [stiff.times(inverse).scaled(Four::all(-1.0)), moving.times(inverse.times(*lambda))];
                for (half, (v, w)) in columns.into_iter().zip(rows).enumerate() {
                    let at = (half * n + i) * width + 2 * first;
                    let v = Complexes { re: v.re * twice, im: v.im * -2.0 };
                    for (to, z) in [(&mut from_blocks, v), (&mut to_blocks, w)] {
                        // What is of a known length is copied without a call.
                        match to[at..][..2 * lanes].as_chunks_mut() {
                            ([all], _) => *all = z.pairs(),
                            (_, few) => few.iter_mut().zip(z.pairs()).for_each(|(to, from)| *to = from),
                        }
                    }
                }
            }
        }
        blocks.extend(matrices.iter().map(|matrix| Block::new(*matrix)));
        Spectral { from_blocks, to_blocks, matrices, blocks, lasts: f64::INFINITY }
    }
}

/// The modes that Newton's method has come to, unless one of them is near critical damping; their shapes go behind those before, by
/// normal coordinates.
#[inline(always)]
fn found(work: &mut Work) -> Option<Found> {
    let Work { own, lambda, x, shapes, sum, stiff, .. } = work;
    let first = shapes.len();
    shapes.extend_from_slice(x);
    let (last, shape) = (x.len() - 1, &mut shapes[first..]);
    for (lane, own) in own.iter().enumerate() {
        for (to, from) in [(last, *own), (*own, last)] {
            shape[to].re.set(lane, x[from].re.at(lane));
            shape[to].im.set(lane, x[from].im.at(lane));
        }
    }
    let moving = lambda.times(*lambda).times(*sum);
    let size = moving.minus(*stiff);
    let [of_size, of_terms] = [size.square(), moving.square() + stiff.square()].map(Four::array);
    let is_apart = (0..WIDTH).all(|lane| of_size[lane] > CRITICAL * CRITICAL * of_terms[lane]);
    is_apart.then_some(Found { lambda: *lambda, size })
}

const ONE: Complexes = Complexes { re: Four::new([1.0; WIDTH]), im: Four::ZERO };

/// Room to work in, of one split after another. Numbers of a step are kept in memory on purpose: as locals, the compiler splits their four
/// lanes into scalars.
#[derive(Default)]
struct Work {
    /// Modes whose equations are at hand.
    own: [usize; WIDTH],
    /// Ω², in the order of their equations.
    squares: Vec<Four>,
    /// C, row by row up to the diagonal.
    damping: Vec<Four>,
    /// L, row by row, without its diagonal of ones.
    lower: Vec<Complexes>,
    /// The row at hand before it is divided by the pivots.
    row: Vec<Complexes>,
    /// 1/D.
    inverse: Vec<Complexes>,
    /// L⁻ᵀ e_n.
    x: Vec<Complexes>,
    lambda: Complexes,
    r: Complexes,
    /// xᵀx and xᵀΩ²x.
    sum: Complexes,
    stiff: Complexes,
    /// λ/(σ + r).
    slope: Complexes,
    /// Newton's step.
    step: Complexes,
    /// x of all modes that are found, by normal coordinates.
    shapes: Vec<Complexes>,
    found: Vec<Found>,
}

impl Work {
    /// For so many modes; whatever stands there is written before it is read.
    fn make_room(&mut self, count: usize) {
        self.shapes.clear();
        self.found.clear();
        self.squares.resize(count, Four::ZERO);
        self.damping.resize(count * count, Four::ZERO);
        self.lower.resize(count * count, Complexes::ZERO);
        for numbers in [&mut self.row, &mut self.inverse, &mut self.x] {
            numbers.resize(count, Complexes::ZERO);
        }
    }
}

/// Newton's step for λ, and x in passing: L D Lᵀ = λ² + λ C + Ω², row by row, whose last pivot is r.
#[inline(always)]
fn newton<const N: usize>(work: &mut Work) {
    let n = if N > 0 { N } else { work.squares.len() };
    let (squares, damping, lower) = (&work.squares[..n], &work.damping[..n * n], &mut work.lower[..n * n]);
    let (row, inverse, x) = (&mut work.row[..n], &mut work.inverse[..n], &mut work.x[..n]);
    let (lambda, square) = (work.lambda, work.lambda.times(work.lambda));
    for (i, entries) in damping.chunks_exact(n).enumerate() {
        let (above, own) = lower.split_at_mut(i * n);
        for (j, before) in above.chunks_exact(n).enumerate() {
            row[j] = lambda.scaled(entries[j]);
            for k in 0..j {
                row[j] = row[j].minus(row[k].times(before[k]));
            }
        }
        row[i] = square.plus(lambda.scaled(entries[i]));
        row[i].re = row[i].re + squares[i];
        for ((j, inverse), l) in (0..i).zip(&*inverse).zip(own) {
            *l = row[j].times(*inverse);
            row[i] = row[i].minus(row[j].times(*l));
        }
        if i < n - 1 {
            inverse[i] = row[i].inverse();
        }
    }
    work.r = row[n - 1];
    x[n - 1] = ONE;
    for (x, l) in x.iter_mut().zip(&lower[(n - 1) * n..n * n - 1]) {
        *x = l.scaled(Four::all(-1.0));
    }
    for (i, row) in lower.chunks_exact(n).take(n - 1).enumerate().rev() {
        let (before, own) = x.split_at_mut(i);
        before.iter_mut().zip(row).for_each(|(x, l)| *x = x.minus(l.times(own[0])));
    }
    step(work);
}

/// The same step where only the last row of C has anything beside its diagonal: as if no two other modes damped each other, which with
/// a few dashpots leaves an error of 1e-5 of λ or less, and no smaller one when it is repeated. x is left with the opposite sign,
/// which its squares do not show.
#[inline(always)]
fn nearer(work: &mut Work) {
    let (lambda, square) = (work.lambda, work.lambda.times(work.lambda));
    let Work { squares, damping, x, r, .. } = &mut *work;
    let n = squares.len();
    for (i, x) in x.iter_mut().enumerate() {
        *x = square.plus(lambda.scaled(damping[i * n + i]));
        x.re = x.re + squares[i];
    }
    *r = x[n - 1];
    x[n - 1] = ONE;
    for (x, entry) in x.iter_mut().zip(&damping[(n - 1) * n..n * n - 1]) {
        let beside = lambda.scaled(*entry);
        *x = x.inverse();
        *x = beside.times(*x);
        *r = r.minus(beside.times(*x));
    }
    step(work);
}

/// Newton's step where λ gives r and x.
#[inline(always)]
fn step(work: &mut Work) {
    let Work { squares, x, lambda, r, sum, stiff, slope, step, .. } = work;
    (*sum, *stiff) = (Complexes::ZERO, Complexes::ZERO);
    for (x, square) in x.iter().zip(&*squares) {
        let own = x.times(*x);
        *sum = sum.plus(own);
        *stiff = stiff.plus(own.scaled(*square));
    }
    // r = λ² xᵀx + λ xᵀC x + xᵀΩ²x leaves no need of C in r′ = (σ + r)/λ.
    *slope = lambda.times(*lambda).times(*sum).minus(*stiff).plus(*r);
    *slope = slope.inverse();
    *slope = slope.times(*lambda);
    *step = r.times(*slope);
    *slope = sum.times(*slope);
    // λ² bends r; what x does beside is of the same order, and small where modes are apart.
    *step = step.plus(step.times(*step).times(*slope));
}

/// W ← W + (1 − W V) W.
fn correct(spectral: &mut Spectral) {
    let width = spectral.width();
    let size = spectral.from_blocks.len() / width;
    let v = DMatrix::from_row_slice(size, width, &spectral.from_blocks);
    // By coordinates, as the engine keeps it, W is column by column.
    let mut w = DMatrix::from_column_slice(width, size, &spectral.to_blocks);
    invert_again(&v, &mut w);
    spectral.to_blocks.copy_from_slice(w.as_slice());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::matrix::Matrix;
    use crate::arithmetic::schur::tests::numbers;

    /// Masses that carry particles on springs and dashpots, in coordinates of the masses and compressions.
    struct Drawn {
        mass: Matrix,
        stiffness: Matrix,
        damping: Matrix,
    }

    impl Drawn {
        /// Of so many modes and particles; dashpots of `ratio` times what is critical for a particle alone.
        fn new(number: &mut impl FnMut(f64, f64) -> f64, structure: usize, particles: usize, ratio: f64) -> Self {
            let order = structure + particles;
            let (mut mass, mut stiffness) = (vec![0.0; order], vec![0.0; order]);
            let mut damping = vec![0.0; order];
            for i in 0..structure {
                let omega = 25.0 * ((i + 1) * (i + 1)) as f64 * number(0.8, 1.2);
                (mass[i], stiffness[i], damping[i]) = (1.0, omega * omega, 5e-5 * omega * omega);
            }
            let [one, spring] = [number(5e-3, 5e-2), number(3e2, 3e3)];
            let dashpot = 2.0 * ratio * (one * spring).sqrt();
            let mut all = Matrix::diagonal(&mass);
            for slot in structure..order {
                (stiffness[slot], damping[slot]) = (spring, dashpot);
                let row: Vec<f64> = (0..structure).map(|_| number(-2.0, 2.0)).collect();
                let row: Vec<f64> =
                    row.into_iter().chain((structure..order).map(|i| f64::from(u8::from(i == slot)))).collect();
                all.add_square(one, &row);
            }
            Self { mass: all, stiffness: Matrix::diagonal(&stiffness), damping: Matrix::diagonal(&damping) }
        }

        /// Accelerations by places and rates.
        fn accelerations(&self) -> Vec<Vec<f64>> {
            let order = self.mass.order;
            let factors = crate::arithmetic::cholesky::Cholesky::new(&self.mass).expect("masses are positive");
            let column =
                |matrix: &Matrix, j: usize| factors.solve(&(0..order).map(|i| -matrix.at(i, j)).collect::<Vec<_>>());
            let columns: Vec<Vec<f64>> = [&self.stiffness, &self.damping]
                .into_iter()
                .flat_map(|matrix| (0..order).map(move |j| (matrix, j)))
                .map(|(matrix, j)| column(matrix, j))
                .collect();
            (0..order).map(|i| columns.iter().map(|column| column[i]).collect()).collect()
        }

        fn in_normal_coordinates(&self, modes: &NormalModes) -> Vec<f64> {
            let order = self.mass.order;
            let entry = |i: usize, j: usize| {
                modes.omega[i] * modes.omega[j] * self.damping.form(&modes.shapes[i], &modes.shapes[j])
            };
            (0..order * order).map(|at| entry(at / order, at % order)).collect()
        }

        /// By normal modes.
        fn split(&self) -> Option<Spectral> {
            let modes = NormalModes::new(&self.stiffness, &self.mass).expect("springs are positive");
            split(&modes, &self.in_normal_coordinates(&modes), Spectral::default())
        }

        /// What W V misses of 1, and V B W of A, with places in units of their scale: (Ω p, p′).
        fn residuals(&self, spectral: &Spectral) -> [f64; 2] {
            let (order, size, width) = (self.mass.order, 2 * self.mass.order, spectral.width());
            let rows = self.accelerations();
            let unit: Vec<f64> = (0..order).map(|i| rows[i][i].abs().sqrt()).chain(vec![1.0; order]).collect();
            let v = DMatrix::from_fn(size, width, |i, k| spectral.from_blocks[i * width + k] * unit[i]);
            let w = DMatrix::from_fn(width, size, |k, i| spectral.to_blocks[i * width + k] / unit[i]);
            let mut b = DMatrix::zeros(width, width);
            for (k, matrix) in spectral.matrices.iter().enumerate() {
                (0..4).for_each(|i| b[(2 * k + i / 2, 2 * k + i % 2)] = matrix[i]);
            }
            let a = DMatrix::from_fn(size, size, |i, j| {
                let entry = if i < order { f64::from(u8::from(j == order + i)) } else { rows[i - order][j] };
                entry * unit[i] / unit[j]
            });
            let scale = a.amax();
            [(&v * &w - DMatrix::identity(size, size)).amax(), (&v * b * &w - &a).amax() / scale]
        }
    }

    /// Moduli of all eigenvalues.
    fn rates(spectral: &Spectral) -> Vec<f64> {
        let moduli = spectral.blocks.iter().flat_map(|block| {
            let count = if block.is_single() { 1 } else { 2 };
            block.eigenvalues().into_iter().take(count).map(|[re, im]| libm::hypot(re, im))
        });
        let mut moduli: Vec<f64> = moduli.collect();
        moduli.sort_by(f64::total_cmp);
        moduli
    }

    #[test]
    fn modes_under_dashpots_are_as_exact_as_those_of_a_schur_form() {
        let mut number = numbers(1);
        // Dashpots by what is critical for a particle alone; which share of the systems must come from their normal modes, and by which
        // factor those may be further off in the mean.
        for (least, most, share, factor) in [
            (0.01, 0.1, 0.95, 1.2),
            (0.1, 0.3, 0.95, 1.2),
            (0.3, 0.6, 0.8, 1.2),
            (0.6, 2.0, 0.25, 1.2),
            (2.0, 20.0, 0.1, 2.0),
        ] {
            let (mut drawn, mut split, mut means) = (0, 0, [[0.0; 2]; 2]);
            for _ in 0..300 {
                let structure = number(3.0, 12.99) as usize;
                let particles = number(1.0, 8.99_f64.min(structure as f64 + 0.99)) as usize;
                let ratio = number(least, most);
                let system = Drawn::new(&mut number, structure, particles, ratio);
                drawn += 1;
                let Some(own) = system.split() else { continue };
                split += 1;
                let [unit, matrix] = system.residuals(&own);
                assert!(unit < 1e-13 && matrix < 5e-14, "{structure}, {particles}, {ratio}: {unit:e}, {matrix:e}");
                let rows = system.accelerations();
                let schur = crate::contact_state::modes::split(
                    &rows,
                    [&system.mass, &system.damping, &system.stiffness],
                    Vec::new,
                )
                .expect("it ends");
                if schur.lasts.is_infinite() {
                    for (sums, spectral) in means.iter_mut().zip([&own, &schur]) {
                        let residuals = system.residuals(spectral);
                        sums.iter_mut().zip(residuals).for_each(|(sum, x)| *sum += libm::log(x.max(1e-17)));
                    }
                }
                for (own, schur) in rates(&own).into_iter().zip(rates(&schur)).filter(|_| schur.lasts.is_infinite()) {
                    assert!((own / schur - 1.0).abs() < 1e-10, "{own} for {schur}");
                }
            }
            assert!(f64::from(split) >= share * f64::from(drawn), "{split} of {drawn} up to {most}");
            let [own, schur] = means.map(|sums| sums.map(|sum| sum / f64::from(split.max(1))));
            assert!((0..2).all(|i| own[i] < schur[i] + libm::log(factor)), "up to {most}: {own:?} for {schur:?}");
        }
    }

    #[test]
    fn modes_that_are_twice_the_same_are_split_well_or_not_at_all() {
        let mut number = numbers(1);
        // More particles of one kind than modes: some of theirs are one, and any of their shapes will do.
        for seed in 0..200 {
            let ratio = number(0.01, 0.6);
            let system = Drawn::new(&mut number, 1 + seed % 3, 4 + seed % 4, ratio);
            if let Some(spectral) = system.split() {
                let [unit, matrix] = system.residuals(&spectral);
                assert!(unit < 1e-13 && matrix < 5e-14, "{seed}: {unit:e}, {matrix:e}");
            }
        }
    }

    #[test]
    fn every_processor_finds_the_same_bits() {
        let mut number = numbers(1);
        for _ in 0..50 {
            let system = Drawn::new(&mut number, 5, 3, 0.3);
            let modes = NormalModes::new(&system.stiffness, &system.mass).expect("springs are positive");
            let damping = system.in_normal_coordinates(&modes);
            let problem = Problem::new(&modes, &damping);
            let mut work = Work::default();
            let mut bits = |solve: fn(&Problem, usize, &mut Work) -> Option<Found>| {
                work.make_room(modes.omega.len());
                let found = [0, 4].map(|first| solve(&problem, first, &mut work).expect("it is lightly damped"));
                let each = work.shapes.iter().chain(found.iter().flat_map(|found| [&found.lambda, &found.size]));
                each.flat_map(|z| [z.re.array(), z.im.array()]).flatten().map(f64::to_bits).collect::<Vec<_>>()
            };
            let here = bits(|problem, first, work| problem.solve(first, work));
            let everywhere = bits(|problem, first, work| problem.solve_by_registers(first, work));
            assert_eq!(here, everywhere);
        }
    }
}
