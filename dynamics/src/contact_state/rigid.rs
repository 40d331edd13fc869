//! Rigid-body motions along no single coordinate: of structures that springs, or dashpots, hold to themselves alone.
//!
//! Where K z = 0, z takes the place of one coordinate: p = T x, with T the unit matrix but for its columns z. In x no spring feels that
//! coordinate, to the bit. To rounding would not do: an eigenvalue of 10⁻¹⁷ in the place of zero has a place of rest, at 10¹⁷. Among the
//! coordinates that no spring feels the same is done with C, so that what no dashpot feels either is a coordinate, too.
//!
//! The z come from Cholesky's factors of the matrix with its diagonal scaled to ones and taken out largest first: where what is left is
//! rounding, the rest of the coordinates are free, and A_hh z_h = −A_hf gives what those held do when a free one moves by 1.

use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::matrix::Matrix;

/// What is left of a unit diagonal is none below this: a spring so weak moves less in a thousand cycles than its eigenvalues are known to.
const NOTHING: f64 = 1e-13;
/// Share of the terms of a sum below which it is their rounding, by their number.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// T: first that of the springs, then that of the dashpots.
pub(crate) struct RigidMotions(Vec<Turn>);

impl RigidMotions {
    /// `None` if each is along a coordinate already.
    pub(crate) fn of(stiffness: &Matrix, damping: &Matrix) -> Option<Self> {
        let mut by_springs = Turn::of_springs(stiffness);
        let turned = by_springs.as_ref().map(|turn| [turn.felt_by(stiffness), turn.form(damping)]);
        let [stiffness, damping] = turned.as_ref().map_or([stiffness, damping], |[k, c]| [k, c]);
        if let Some(turn) = &mut by_springs {
            turn.damped.retain(|&f| is_felt(damping, f));
        }
        let unsprung: Vec<usize> = (0..stiffness.order).filter(|&i| !is_felt(stiffness, i)).collect();
        let turns: Vec<Turn> = by_springs.into_iter().chain(Turn::of(damping, &unsprung)).collect();
        (!turns.is_empty()).then_some(Self(turns))
    }

    /// Some motion along several coordinates is felt by no spring.
    pub(crate) fn are_left_by(stiffness: &Matrix) -> bool {
        Turn::of_springs(stiffness).is_some()
    }

    /// Tᵀ M T.
    pub(crate) fn mass(&self, matrix: &Matrix) -> Matrix {
        self.0.iter().fold(matrix.clone(), |matrix, turn| turn.form(&matrix))
    }

    /// Tᵀ K T.
    pub(crate) fn stiffness(&self, matrix: &Matrix) -> Matrix {
        self.0.iter().fold(matrix.clone(), |matrix, turn| turn.felt_by(&matrix))
    }

    /// Accelerations of x by (x, x′) from those of p by (p, p′).
    pub(crate) fn accelerations(&self, of: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.0.iter().fold(of.to_vec(), |accelerations, turn| turn.accelerations(accelerations))
    }

    /// Block coordinates of (x, x′), V row by row and W column by column, as those of (p, p′).
    pub(crate) fn back(&self, from_blocks: &mut [f64], to_blocks: &mut [f64]) {
        self.0.iter().rev().for_each(|turn| turn.back(from_blocks, to_blocks));
    }
}

/// A unit matrix with some columns z.
struct Turn {
    order: usize,
    /// The coordinates that become those of motions z.
    free: Vec<usize>,
    /// Those that take part in them.
    held: Vec<usize>,
    /// Of each motion what the held ones do.
    with: Vec<Vec<f64>>,
    /// Those of the free that dashpots feel.
    damped: Vec<usize>,
}

impl Turn {
    /// Of all motions that no spring feels.
    fn of_springs(stiffness: &Matrix) -> Option<Self> {
        let turn = Self::of(stiffness, &(0..stiffness.order).collect::<Vec<_>>())?;
        Some(Self { damped: turn.free.clone(), ..turn })
    }

    /// Of the motions of coordinates `among` others that a matrix does not feel; `None` if there is none but of those that it does not feel
    /// by themselves, and where it gives energy.
    fn of(matrix: &Matrix, among: &[usize]) -> Option<Self> {
        let felt: Vec<usize> = among.iter().copied().filter(|&i| matrix.at(i, i) > 0.0).collect();
        let unit = |i: usize| matrix.at(i, i).sqrt();
        let scaled = |of: &[usize]| Matrix {
            order: of.len(),
            entries: of.iter().flat_map(|&i| of.iter().map(move |&j| matrix.at(i, j) / (unit(i) * unit(j)))).collect(),
        };
        let is_held = held(scaled(&felt))?;
        let chosen = |wanted| felt.iter().zip(&is_held).filter(|(_, held)| **held == wanted).map(|(&i, _)| i).collect();
        let [held, free]: [Vec<usize>; 2] = [chosen(true), chosen(false)];
        if free.is_empty() {
            return None;
        }
        let factors = Cholesky::new(&scaled(&held)).ok()?;
        let motion = |&f: &usize| {
            let push: Vec<f64> = held.iter().map(|&i| -matrix.at(i, f) / (unit(i) * unit(f))).collect();
            factors.solve(&push).iter().zip(&held).map(|(z, &i)| z * unit(f) / unit(i)).collect()
        };
        let with: Vec<Vec<f64>> = free.iter().map(motion).collect();
        let turn = Self { order: matrix.order, with, free, held, damped: Vec::new() };
        // Of a matrix that gives no energy no row feels what its diagonal does not.
        let most = |&f: &usize, with: &Vec<f64>| {
            turn.held.iter().zip(with).fold(unit(f), |sum, (&i, z)| sum + unit(i) * z.abs())
        };
        let most: Vec<f64> = turn.free.iter().zip(&turn.with).map(|(f, with)| most(f, with)).collect();
        let largest = felt.iter().map(|&i| unit(i)).fold(0.0, f64::max);
        let feels_none = |(i, row): (usize, &[f64])| {
            let bound = if matrix.at(i, i) > 0.0 { NOTHING.sqrt() * unit(i) } else { NOTHING * largest };
            turn.products(row).zip(&most).all(|((_, [sum, _]), most)| sum.abs() <= bound * most)
        };
        matrix.entries.chunks_exact(matrix.order).enumerate().all(feels_none).then_some(turn)
    }

    /// Tᵀ A T.
    fn form(&self, matrix: &Matrix) -> Matrix {
        let n = self.order;
        let mut rows: Vec<Vec<f64>> = matrix.entries.chunks_exact(n).map(<[f64]>::to_vec).collect();
        rows.iter_mut().for_each(|row| self.times(row));
        let mut columns: Vec<Vec<f64>> = (0..n).map(|j| rows.iter().map(|row| row[j]).collect()).collect();
        columns.iter_mut().for_each(|column| self.times(column));
        Matrix { order: n, entries: (0..n * n).map(|at| columns[at % n][at / n]).collect() }
    }

    /// The same of the springs, which do not feel the motions, to the bit.
    fn felt_by(&self, stiffness: &Matrix) -> Matrix {
        let n = self.order;
        let mut form = self.form(stiffness);
        self.free
            .iter()
            .flat_map(|&f| (0..n).flat_map(move |i| [f * n + i, i * n + f]))
            .for_each(|at| form.entries[at] = 0.0);
        form
    }

    /// T⁻¹ S T and T⁻¹ D T.
    fn accelerations(&self, mut of: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        for row in &mut of {
            let (stiffness, damping) = row.split_at_mut(self.order);
            let felt: Vec<f64> =
                self.products(damping).map(|(f, [sum, _])| if self.damped.contains(&f) { sum } else { 0.0 }).collect();
            for (&f, felt) in self.free.iter().zip(felt) {
                [stiffness[f], damping[f]] = [0.0, felt];
            }
        }
        for (&f, with) in self.free.iter().zip(&self.with) {
            let of_free = of[f].clone();
            for (&i, share) in self.held.iter().zip(with) {
                of[i].iter_mut().zip(&of_free).for_each(|(entry, of_free)| *entry -= share * of_free);
            }
        }
        of
    }

    /// V ← T V and W ← W T⁻¹.
    fn back(&self, from_blocks: &mut [f64], to_blocks: &mut [f64]) {
        let width = from_blocks.len() / (2 * self.order);
        for half in [0, self.order] {
            for (&f, with) in self.free.iter().zip(&self.with) {
                for (&i, share) in self.held.iter().zip(with) {
                    let [f, i] = [f, i].map(|place| (half + place) * width);
                    for k in 0..width {
                        from_blocks[i + k] += share * from_blocks[f + k];
                        to_blocks[f + k] -= share * to_blocks[i + k];
                    }
                }
            }
        }
    }

    /// A row of a matrix times T. Where no more than rounding is left of a sum it is zero, to the bit.
    fn times(&self, row: &mut [f64]) {
        let rounding = ROUNDING * self.order as f64;
        let products: Vec<_> = self.products(row).collect();
        for (f, [sum, size]) in products {
            row[f] = if sum.abs() <= rounding * size { 0.0 } else { sum };
        }
    }

    /// A row of a matrix times each motion, which is that of its free coordinate: the sum, and that of its terms' sizes.
    fn products(&self, row: &[f64]) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.free.iter().zip(&self.with).map(|(&f, with)| {
            let terms = self.held.iter().zip(with).map(|(&i, share)| share * row[i]).chain([row[f]]);
            (f, terms.fold([0.0, 0.0], |[sum, size], term: f64| [sum + term, size + term.abs()]))
        })
    }
}

/// A column of a matrix, not all of it zero.
fn is_felt(matrix: &Matrix, column: usize) -> bool {
    (0..matrix.order).any(|i| matrix.at(i, column) != 0.0)
}

/// Which coordinates of a matrix with a unit diagonal are held, taken largest first; `None` where it is not positive semidefinite.
fn held(mut matrix: Matrix) -> Option<Vec<bool>> {
    let n = matrix.order;
    let mut held = vec![false; n];
    loop {
        let left: Vec<usize> = (0..n).filter(|&i| !held[i]).collect();
        let next = left.iter().copied().max_by(|&i, &j| matrix.at(i, i).total_cmp(&matrix.at(j, j)));
        let Some(next) = next.filter(|&i| matrix.at(i, i) > NOTHING) else {
            let is_nothing = |&i: &usize| left.iter().all(|&j| matrix.at(i, j).abs() <= NOTHING.sqrt());
            let is_semidefinite = left.iter().all(|&i| matrix.at(i, i) >= -NOTHING && is_nothing(&i));
            return is_semidefinite.then_some(held);
        };
        let row: Vec<f64> = (0..n).map(|j| matrix.at(next, j)).collect();
        for (entries, share) in matrix.entries.chunks_exact_mut(n).zip(row.iter().map(|entry| entry / row[next])) {
            entries.iter_mut().zip(&row).for_each(|(entry, of_next)| *entry -= share * of_next);
        }
        held[next] = true;
    }
}
