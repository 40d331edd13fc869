//! Modes of a contact state: rigid-body motions apart, exactly; the rest scaled and split into blocks.
//!
//! A coordinate r that no spring and no dashpot feels (its columns of the matrix are zero) makes a rigid-body motion. By
//! the momentum along it, ρ = r + M_rr⁻¹ M_re e with the other coordinates e obeys ρ″ = load alone, and e never asks for
//! r. So ρ is split off by the masses, its block is [[0, 1], [0, 0]] to the bit, and the eigenvalue iteration never sees
//! the defective zeros that it could not tell apart.

use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::matrix::Matrix;
use crate::contact_state::spectral::Spectral;
use crate::contact_state::undamped::NormalModes;
use crate::error::EngineError;

/// Splits (p, p′) with p″ = (`accelerations`) (p, p′) and the mass matrix `mass` of p into blocks: V, row by row, and
/// W = V⁻¹, column by column.
///
/// `stiffness` is that of p where no dashpot acts.
pub(crate) fn split(
    accelerations: &[Vec<f64>],
    mass: &Matrix,
    stiffness: Option<&Matrix>,
) -> Result<Spectral, EngineError> {
    let order = accelerations.len();
    let size = 2 * order;
    let free = |i: usize| accelerations.iter().all(|row| row[i] == 0.0 && row[order + i] == 0.0);
    let (rigid, elastic): (Vec<usize>, Vec<usize>) = (0..order).partition(|&i| free(i));
    let count = elastic.len();

    // shift = M_rr⁻¹ M_re, column by column.
    let own = Matrix {
        order: rigid.len(),
        entries: rigid.iter().flat_map(|&i| rigid.iter().map(move |&j| mass.at(i, j))).collect(),
    };
    let solve = Cholesky::new(&own)?;
    let shift: Vec<Vec<f64>> =
        elastic.iter().map(|&j| solve.solve(&rigid.iter().map(|&i| mass.at(i, j)).collect::<Vec<_>>())).collect();

    let undamped = stiffness.filter(|_| count > 0).and_then(|stiffness| {
        let chosen = |entry: &dyn Fn(usize, usize) -> f64| Matrix {
            order: count,
            entries: (0..count * count).map(|at| entry(at / count, at % count)).collect(),
        };
        // What rigid bodies leave of the masses: M_ee − M_er M_rr⁻¹ M_re.
        let left = |i: usize, j: usize| {
            let own = rigid.iter().zip(&shift[j]);
            own.fold(mass.at(elastic[i], elastic[j]), |sum, (&r, shift)| sum - mass.at(elastic[i], r) * shift)
        };
        let stiffness = chosen(&|i, j| stiffness.at(elastic[i], elastic[j]));
        NormalModes::new(&stiffness, &chosen(&left)).map(|modes| modes.undamped())
    });

    // Lengths are scaled by frequencies, so that the matrix is of one magnitude: (Ω e, e′).
    let unit = |&i: &usize| if undamped.is_some() { 1.0 } else { scale(accelerations[i][i]) };
    let frequency: Vec<f64> = elastic.iter().map(unit).collect();
    let mut matrix = vec![0.0; 4 * count * count];
    for (i, &row) in elastic.iter().enumerate() {
        matrix[i * 2 * count + count + i] = frequency[i];
        for (j, &column) in elastic.iter().enumerate() {
            matrix[(count + i) * 2 * count + j] = accelerations[row][column] / frequency[j];
            matrix[(count + i) * 2 * count + count + j] = accelerations[row][order + column];
        }
    }
    let inner = match undamped {
        Some(undamped) => undamped,
        None if count > 0 => Spectral::split(2 * count, &matrix)?,
        None => Spectral::default(),
    };

    let (within, width) = (inner.width(), inner.width() + 2 * rigid.len());
    let [mut from_blocks, mut to_blocks] = [vec![0.0; size * width], vec![0.0; size * width]];
    let mut matrices = inner.matrices;
    for (i, &row) in elastic.iter().enumerate() {
        for (half, unit) in [(0, frequency[i]), (1, 1.0)] {
            for k in 0..within {
                let (inside, outside) = (half * count + i, half * order + row);
                from_blocks[outside * width + k] = inner.from_blocks[inside * within + k] / unit;
                to_blocks[outside * width + k] = inner.to_blocks[k * 2 * count + inside] * unit;
            }
        }
    }
    for (r, &row) in rigid.iter().enumerate() {
        for half in 0..2 {
            let column = within + 2 * r + half;
            let outside = half * order + row;
            from_blocks[outside * width + column] = 1.0;
            to_blocks[outside * width + column] = 1.0;
            for (e, &other) in elastic.iter().enumerate() {
                let inside = half * order + other;
                to_blocks[inside * width + column] = shift[e][r];
                for k in 0..within {
                    from_blocks[outside * width + k] -= shift[e][r] * from_blocks[inside * width + k];
                }
            }
        }
        matrices.push([0.0, 1.0, 0.0, 0.0]);
    }
    Ok(Spectral::new(from_blocks, to_blocks, matrices, inner.lasts).fastest_first())
}

/// The frequency that a coordinate has alone, 1 if it has none: the unit of its rate.
pub(crate) fn scale(acceleration: f64) -> f64 {
    let omega = acceleration.abs().sqrt();
    if omega > 0.0 && omega.is_finite() { omega } else { 1.0 }
}
