//! Linear equations by elimination with complete pivoting. Unknowns that singular equations leave undetermined are zero, so that a stop
//! that nothing moves stays where it is.

use std::ops::Range;

use nalgebra::DMatrix;

/// Pivots below this share of the largest are none.
const SINGULAR: f64 = 1e-11;

/// Weight of the columns that come `late` in the search for a pivot: one of them is a pivot only where all others are as small.
const LATE: f64 = 1e-4;

/// x of A x = b, and det A.
pub(crate) struct Solved {
    pub(crate) x: Vec<f64>,
    /// Zero of a singular one.
    pub(crate) determinant: f64,
}

/// A with one more row and one more column, which ends with the last of the row's numbers.
pub(crate) fn bordered(a: &DMatrix<f64>, row: &[f64], column: impl Fn(usize) -> f64) -> DMatrix<f64> {
    let count = a.nrows();
    DMatrix::from_fn(count + 1, count + 1, |i, k| match (i == count, k == count) {
        (true, _) => row[k],
        (false, true) => column(i),
        (false, false) => a[(i, k)],
    })
}

/// x of A x = b; `None` where a number is not finite. Where unknowns are undetermined, those
/// that come `late` are zero, if they can be.
pub(crate) fn solve(a: DMatrix<f64>, b: Vec<f64>, late: &Range<usize>) -> Option<Vec<f64>> {
    solved(a, b, late).map(|solved| solved.x)
}

/// The same with the determinant.
pub(crate) fn solved(mut a: DMatrix<f64>, mut b: Vec<f64>, late: &Range<usize>) -> Option<Solved> {
    let size = b.len();
    let mut determinant = 1.0;
    let mut order: Vec<usize> = (0..size).collect();
    let mut rank = 0;
    let mut largest: f64 = 0.0;
    while rank < size {
        let (mut most, mut place) = (0.0, (rank, rank));
        for column in rank..size {
            let weight = if late.contains(&order[column]) { LATE } else { 1.0 };
            for row in rank..size {
                let entry = a[(row, column)].abs();
                if !entry.is_finite() {
                    return None;
                }
                if rank == 0 {
                    largest = entry.max(largest);
                }
                if entry > SINGULAR * largest && weight * entry > most {
                    (most, place) = (weight * entry, (row, column));
                }
            }
        }
        if most == 0.0 {
            break;
        }
        a.swap_rows(rank, place.0);
        b.swap(rank, place.0);
        a.swap_columns(rank, place.1);
        order.swap(rank, place.1);
        let is_even = (place.0 == rank) == (place.1 == rank);
        determinant *= if is_even { a[(rank, rank)] } else { -a[(rank, rank)] };
        for row in rank + 1..size {
            let factor = a[(row, rank)] / a[(rank, rank)];
            if factor != 0.0 {
                (rank..size).for_each(|column| a[(row, column)] -= factor * a[(rank, column)]);
                b[row] -= factor * b[rank];
            }
        }
        rank += 1;
    }
    let mut x = vec![0.0; size];
    for row in (0..rank).rev() {
        let rest = (row + 1..rank).fold(b[row], |rest, column| rest - a[(row, column)] * x[order[column]]);
        x[order[row]] = rest / a[(row, row)];
    }
    let determinant = if rank < size { 0.0 } else { determinant };
    x.iter().all(|x| x.is_finite()).then_some(Solved { x, determinant })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_equations_leave_open_is_zero() {
        let free = DMatrix::from_row_slice(3, 3, &[2.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 3.0]);
        assert_eq!(solve(free, vec![5.0, 0.0, 5.0], &(0..0)), Some(vec![2.0, 0.0, 1.0]));
        let either = DMatrix::from_row_slice(2, 2, &[2.0, 4.0, 2.0, 4.0]);
        assert_eq!(solve(either.clone(), vec![8.0, 8.0], &(0..1)), Some(vec![0.0, 2.0]));
        assert_eq!(solve(either, vec![8.0, 8.0], &(1..2)), Some(vec![4.0, 0.0]));
        assert_eq!(solve(DMatrix::from_element(1, 1, f64::NAN), vec![1.0], &(0..0)), None);
    }

    #[test]
    fn the_determinant_has_the_sign_of_the_order() {
        let determinant = |entries: &[f64]| {
            let a = DMatrix::from_row_slice(3, 3, entries);
            solved(a, vec![0.0; 3], &(0..0)).map(|solved| solved.determinant)
        };
        assert_eq!(determinant(&[0.0, 2.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 4.0]), Some(-24.0));
        assert_eq!(determinant(&[0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 4.0, 0.0, 0.0]), Some(24.0));
        assert_eq!(determinant(&[1.0, 2.0, 0.0, 2.0, 4.0, 0.0, 0.0, 0.0, 1.0]), Some(0.0));
    }
}
