//! Eigenvalues and eigenvectors of a small symmetric matrix, by Jacobi's rotations: square roots alone, the same bits anywhere.

/// Sweeps over all pairs, at most; six are plenty.
const SWEEPS: usize = 60;

/// Eigenvalues, and the eigenvectors as columns of a row-major matrix.
pub(super) fn symmetric(matrix: &[f64], size: usize) -> (Vec<f64>, Vec<f64>) {
    let mut a = matrix.to_vec();
    let mut v = vec![0.0; size * size];
    (0..size).for_each(|i| v[i * size + i] = 1.0);
    for _ in 0..SWEEPS {
        let off: f64 = (0..size).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i * size + j].abs()).sum();
        if off == 0.0 {
            break;
        }
        for p in 0..size {
            for q in p + 1..size {
                rotate(&mut a, &mut v, size, p, q);
            }
        }
    }
    ((0..size).map(|i| a[i * size + i]).collect(), v)
}

/// Makes a[p][q] vanish.
fn rotate(a: &mut [f64], v: &mut [f64], size: usize, p: usize, q: usize) {
    let off = a[p * size + q];
    let [low, high] = [a[p * size + p], a[q * size + q]];
    if off.abs() <= f64::EPSILON * 1e-3 * (low.abs() + high.abs()) {
        a[p * size + q] = 0.0;
        a[q * size + p] = 0.0;
        return;
    }
    let theta = (high - low) / (2.0 * off);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for k in 0..size {
        let [x, y] = [a[k * size + p], a[k * size + q]];
        a[k * size + p] = c * x - s * y;
        a[k * size + q] = s * x + c * y;
    }
    for k in 0..size {
        let [x, y] = [a[p * size + k], a[q * size + k]];
        a[p * size + k] = c * x - s * y;
        a[q * size + k] = s * x + c * y;
        let [x, y] = [v[k * size + p], v[k * size + q]];
        v[k * size + p] = c * x - s * y;
        v[k * size + q] = s * x + c * y;
    }
}

#[cfg(test)]
mod tests {
    use super::symmetric;

    #[test]
    fn eigenvectors_diagonalise_the_matrix() {
        let a = [4.0, 1.0, -2.0, 1.0, 3.0, 0.5, -2.0, 0.5, 6.0];
        let (values, vectors) = symmetric(&a, 3);
        for k in 0..3 {
            for i in 0..3 {
                let image: f64 = (0..3).map(|j| a[3 * i + j] * vectors[3 * j + k]).sum();
                assert!((image - values[k] * vectors[3 * i + k]).abs() < 1e-14);
            }
        }
    }
}
