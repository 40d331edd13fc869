//! Small dense systems by Gaussian elimination with partial pivoting; own loops, since their bits reach the results.

/// Solves A x = b; each row of A has its entry of b behind it, and x is left there.
#[inline(always)]
pub(crate) fn eliminate<Row: AsRef<[f64]> + AsMut<[f64]>>(rows: &mut [Row]) {
    let order = rows.len();
    for column in 0..order {
        let size = |i: &usize| rows[*i].as_ref()[column].abs();
        let pivot = (column..order).max_by(|i, k| size(i).total_cmp(&size(k)));
        rows.swap(column, pivot.unwrap_or(column));
        for i in column + 1..order {
            let (above, below) = rows.split_at_mut(i);
            let (from, to) = (above[column].as_ref(), below[0].as_mut());
            let factor = to[column] / from[column];
            for k in column..=order {
                to[k] -= factor * from[k];
            }
        }
    }
    for i in (0..order).rev() {
        let (own, known) = rows[i..].split_first_mut().expect("there is one");
        let own = own.as_mut();
        let terms = own[i + 1..order].iter().zip(known);
        own[order] = terms.fold(own[order], |sum, (entry, x)| sum - entry * x.as_ref()[order]) / own[i];
    }
}
