//! Modes of a contact state: rigid-body motions apart, exactly; the rest scaled and split into blocks.
//!
//! A coordinate r that no spring and no dashpot feels (its columns of the matrix are zero) makes a rigid-body motion; one along several
//! coordinates is made one of them first ([`RigidMotions`]). By
//! the momentum along it, ρ = r + M_rr⁻¹ M_re e with the other coordinates e obeys ρ″ = load alone, and e never asks for
//! r. So ρ is split off by the masses, its block is [[0, 1], [0, 0]] to the bit, and the eigenvalue iteration never sees
//! the defective zeros that it could not tell apart. Nor does it see the equal eigenvalues of particles that are alike ([`Alike`]).

use nalgebra::DMatrix;

use crate::arithmetic::cholesky::Cholesky;
use crate::arithmetic::dense::{by_rows, product};
use crate::arithmetic::matrix::Matrix;
use crate::contact_state::alike::Alike;
use crate::contact_state::rigid::RigidMotions;
use crate::contact_state::schur_split;
use crate::contact_state::spectral::Spectral;
use crate::contact_state::undamped::NormalModes;
use crate::error::EngineError;

/// Splits (p, p′) with p″ = (`accelerations`) (p, p′) and the mass, damping and stiffness matrices of p into blocks: V, row by row, and
/// W = V⁻¹, column by column. `alike` gives the particles that are, where normal modes do not split them.
pub(crate) fn split(
    accelerations: &[Vec<f64>],
    [mass, damping, stiffness]: [&Matrix; 3],
    alike: impl FnOnce() -> Vec<Alike>,
) -> Result<Spectral, EngineError> {
    let Some(rigid) = RigidMotions::of(stiffness, damping) else {
        return by_coordinates(accelerations, mass, stiffness, alike);
    };
    let [mass, stiffness] = [rigid.mass(mass), rigid.stiffness(stiffness)];
    let mut split = by_coordinates(&rigid.accelerations(accelerations), &mass, &stiffness, alike)?;
    rigid.back(&mut split.from_blocks, &mut split.to_blocks);
    Ok(split)
}

/// The same where rigid-body motions are coordinates.
fn by_coordinates(
    accelerations: &[Vec<f64>],
    mass: &Matrix,
    stiffness: &Matrix,
    alike: impl FnOnce() -> Vec<Alike>,
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

    let no_dashpot = || accelerations.iter().all(|row| row[order..].iter().all(|entry| *entry == 0.0));
    let undamped = (count > 0 && no_dashpot()).then(|| {
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
    let undamped = undamped.flatten();

    let inner = match undamped {
        Some(undamped) => undamped,
        None if count > 0 => {
            let half = |half: usize| {
                DMatrix::from_fn(count, count, |i, j| accelerations[elastic[i]][half * order + elastic[j]])
            };
            damped([half(0), half(1)], &elastic, &alike())?
        }
        None => Spectral::default(),
    };

    let (within, width) = (inner.width(), inner.width() + 2 * rigid.len());
    let [mut from_blocks, mut to_blocks] = [vec![0.0; size * width], vec![0.0; size * width]];
    let mut matrices = inner.matrices;
    for (i, &row) in elastic.iter().enumerate() {
        for half in 0..2 {
            for k in 0..within {
                let (inside, outside) = (half * count + i, half * order + row);
                from_blocks[outside * width + k] = inner.from_blocks[inside * within + k];
                to_blocks[outside * width + k] = inner.to_blocks[k * 2 * count + inside];
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

/// Splits (e, e′) with e″ = A e + B e′ (`halves`): places of p in the order of `elastic`.
fn damped(halves: [DMatrix<f64>; 2], elastic: &[usize], alike: &[Alike]) -> Result<Spectral, EngineError> {
    let count = elastic.len();
    if alike.is_empty() {
        return coupled(&halves, &(0..count).collect::<Vec<_>>());
    }
    // x = S e has what alike particles do against each other in coordinates of its own, whose k/m and c/m stand in `apart`.
    let [mut turn, mut back] = [(); 2].map(|()| DMatrix::identity(count, count));
    let mut apart = vec![None; count];
    for one in alike {
        one.turn(elastic, &mut turn, &mut back, &mut apart);
    }
    let halves = halves.map(|half| product(&turn, &product(&half, &back)));
    let together: Vec<usize> = (0..count).filter(|&i| apart[i].is_none()).collect();
    let inner = if together.is_empty() { Spectral::default() } else { coupled(&halves, &together)? };

    let (few, within) = (together.len(), inner.width());
    let width = within + 2 * (count - few);
    let (mut v, mut w) = (DMatrix::zeros(2 * count, width), DMatrix::zeros(width, 2 * count));
    for half in 0..2 {
        for (i, &row) in together.iter().enumerate() {
            for k in 0..within {
                v[(half * count + row, k)] = inner.from_blocks[(half * few + i) * within + k];
                w[(k, half * count + row)] = inner.to_blocks[k * 2 * few + half * few + i];
            }
        }
    }
    let mut matrices = inner.matrices;
    for (i, ratios) in apart.iter().enumerate() {
        if let Some([stiffness, damping]) = *ratios {
            let frequency = scale(stiffness);
            for (half, unit) in [(0, frequency), (1, 1.0)] {
                let k = 2 * matrices.len() + half;
                v[(half * count + i, k)] = 1.0 / unit;
                w[(k, half * count + i)] = unit;
            }
            matrices.push([0.0, frequency, -stiffness / frequency, -damping]);
        }
    }
    for half in 0..2 {
        let rows = product(&back, &v.rows(half * count, count).into_owned());
        v.rows_mut(half * count, count).copy_from(&rows);
        let columns = product(&w.columns(half * count, count).into_owned(), &turn);
        w.columns_mut(half * count, count).copy_from(&columns);
    }
    Ok(Spectral::new(by_rows(&v), by_rows(&w), matrices, inner.lasts))
}

/// Splits what the coordinates `chosen` of x″ = A x + B x′ do by themselves.
fn coupled(halves: &[DMatrix<f64>; 2], chosen: &[usize]) -> Result<Spectral, EngineError> {
    // Lengths are scaled by frequencies, so that the matrix is of one magnitude: (Ω x, x′).
    let count = chosen.len();
    let frequencies: Vec<f64> = chosen.iter().map(|&i| scale(halves[0][(i, i)])).collect();
    let mut matrix = vec![0.0; 4 * count * count];
    for (i, &row) in chosen.iter().enumerate() {
        matrix[i * 2 * count + count + i] = frequencies[i];
        for (j, &column) in chosen.iter().enumerate() {
            matrix[(count + i) * 2 * count + j] = halves[0][(row, column)] / frequencies[j];
            matrix[(count + i) * 2 * count + count + j] = halves[1][(row, column)];
        }
    }
    let mut split = schur_split::split(2 * count, &matrix)?;
    let width = split.width();
    for (row, frequency) in split.from_blocks.chunks_exact_mut(width).zip(&frequencies) {
        row.iter_mut().for_each(|entry| *entry /= frequency);
    }
    for row in split.to_blocks.chunks_exact_mut(2 * count) {
        row.iter_mut().zip(&frequencies).for_each(|(entry, frequency)| *entry *= frequency);
    }
    Ok(split)
}

/// The frequency that a coordinate has alone, 1 if it has none: the unit of its rate.
pub(crate) fn scale(acceleration: f64) -> f64 {
    let omega = acceleration.abs().sqrt();
    if omega > 0.0 && omega.is_finite() { omega } else { 1.0 }
}
