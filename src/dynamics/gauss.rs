//! Small dense systems by Gaussian elimination with partial pivoting; own loops, since their bits reach the results.

/// x of A x = b; each row of A has its entry of b behind it.
pub(crate) fn eliminate(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let order = rows.len();
    for column in 0..order {
        let pivot = (column..order).max_by(|&i, &k| rows[i][column].abs().total_cmp(&rows[k][column].abs()));
        rows.swap(column, pivot.unwrap_or(column));
        for i in column + 1..order {
            let factor = rows[i][column] / rows[column][column];
            for k in column..=order {
                rows[i][k] -= factor * rows[column][k];
            }
        }
    }
    let mut x = vec![0.0; order];
    for i in (0..order).rev() {
        x[i] = (i + 1..order).fold(rows[i][order], |sum, k| sum - rows[i][k] * x[k]) / rows[i][i];
    }
    x
}
