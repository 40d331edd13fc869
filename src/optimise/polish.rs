//! Polishing: from a point down the gradient of a function that is smooth about it, to where the gradient vanishes or points out of
//! the box (BFGS; Nocedal and Wright, Numerical Optimization, 2006, sections 6.1 and 16.7).
//!
//! With the coordinates as shares of their sides, g the gradient and B the matrix of curvature that earlier steps have told,
//!
//! B p = −g,   s = t p,   B ← B − (B s)(B s)ᵀ/(sᵀ B s) + y yᵀ/(yᵀ s),   y the change of g over s.
//!
//! Coordinates that lie at an end of their side and would go beyond it stay, and are left out of the first equation. The share t is
//! halved until the function falls by some part of what its gradient promises.

use nalgebra::{DMatrix, DVector};

use super::bounds::Bounds;
use super::search::{Found, Score, Step, Stopped};

/// Part of the promised fall that is enough.
const ENOUGH: f64 = 1e-4;
/// A fall below this, relative to the value, is lost in the rounding of a run.
const FLAT: f64 = 1e-12;
/// Length of the first step, as a share of a side.
const FIRST: f64 = 0.02;
/// The smallest share of a side that is a step.
const SMALLEST: f64 = 1e-11;

/// A function at a point, and how it changes there.
#[derive(Debug, Clone, PartialEq)]
pub struct Slope {
    /// Its value; smaller is better.
    pub value: f64,
    /// Its derivative by each coordinate.
    pub gradient: Vec<f64>,
}

/// A function that is smooth in parts: `None` where it has no derivative.
pub type Smooth<'f, E> = dyn FnMut(&[f64]) -> Result<Option<Slope>, E> + 'f;

/// A point on the way.
struct Here {
    shares: DVector<f64>,
    value: f64,
    /// By the shares.
    gradient: DVector<f64>,
}

/// Descends from `start`, asking for `most` slopes at most. A start without a derivative is what is found.
///
/// # Errors
/// What `slope` fails with.
pub fn polish<E>(bounds: &Bounds, start: &[f64], most: u64, slope: &mut Smooth<'_, E>) -> Result<Found, E> {
    let lengths = DVector::from_iterator(bounds.size(), bounds.sides().iter().map(|[low, high]| high - low));
    let mut asked = 0;
    let mut look = |shares: &DVector<f64>| {
        asked += 1;
        let here = slope(&bounds.at(shares.as_slice()))?.map(|slope| Here {
            shares: shares.clone(),
            value: slope.value,
            gradient: DVector::from_vec(slope.gradient).component_mul(&lengths),
        });
        Ok((here.filter(|here| here.value.is_finite() && here.gradient.iter().all(|it| it.is_finite())), asked))
    };
    let ahead = |here: &Here, step: &DVector<f64>| (&here.shares + step).map(|share| share.clamp(0.0, 1.0));
    let found = |here: &Here, trail: Vec<Step>, evaluations, stopped| Found {
        point: bounds.at(here.shares.as_slice()),
        score: Score { value: here.value },
        evaluations,
        trail,
        stopped,
    };
    let settled =
        |here: &Here| if (0..here.shares.len()).any(|i| leaves(here, i)) { Stopped::Bound } else { Stopped::Converged };
    let shares = DVector::from_vec(bounds.shares(start));
    let (Some(mut here), mut evaluations) = look(&shares)? else {
        let nowhere = Here { gradient: DVector::zeros(shares.len()), shares, value: f64::NAN };
        return Ok(found(&nowhere, Vec::new(), 1, Stopped::NotSmooth));
    };
    let mut trail = vec![Step { evaluations, best: here.value }];
    // A step that meets an edge tells how far away it is at most.
    let mut longest = f64::INFINITY;
    let mut curvature = DMatrix::identity(here.shares.len(), here.shares.len()) * (here.gradient.norm() / FIRST);
    loop {
        let Some(direction) = direction(&here, &curvature) else {
            return Ok(found(&here, trail, evaluations, settled(&here)));
        };
        let promised = here.gradient.dot(&direction);
        if -promised <= FLAT * here.value.abs() {
            // Values are equal to rounding: whole steps, as long as they bring the gradient down by half.
            if evaluations >= most {
                return Ok(found(&here, trail, evaluations, Stopped::Evaluations));
            }
            let (there, so_far) = look(&ahead(&here, &direction))?;
            evaluations = so_far;
            let Some(there) = there.filter(|there| is_lower(there, &here)) else {
                return Ok(found(&here, trail, evaluations, settled(&here)));
            };
            let goes_on = there.gradient.norm() < 0.5 * here.gradient.norm();
            learn(&mut curvature, &(&there.shares - &here.shares), &(&there.gradient - &here.gradient));
            here = there;
            if !goes_on {
                return Ok(found(&here, trail, evaluations, settled(&here)));
            }
            continue;
        }
        let mut share = 1.0_f64.min(longest.min(1.0) / direction.amax());
        let mut met_an_edge = false;
        let next = loop {
            if evaluations >= most {
                return Ok(found(&here, trail, evaluations, Stopped::Evaluations));
            }
            if share * direction.amax() < SMALLEST {
                let stopped = if met_an_edge { Stopped::Edge } else { settled(&here) };
                return Ok(found(&here, trail, evaluations, stopped));
            }
            let (there, so_far) = look(&ahead(&here, &(share * &direction)))?;
            evaluations = so_far;
            match there {
                Some(there) if is_lower(&there, &here) => break there,
                Some(_) => {}
                None => met_an_edge = true,
            }
            share *= 0.5;
        };
        longest = if met_an_edge { (&next.shares - &here.shares).amax() } else { 2.0 * longest };
        learn(&mut curvature, &(&next.shares - &here.shares), &(&next.gradient - &here.gradient));
        here = next;
        trail.push(Step { evaluations, best: here.value });
    }
}

/// The function falls by some part of what its gradient promises; or its values are equal to rounding, where gradients still tell
/// which place is the better one (the approximate condition of Hager and Zhang, SIAM J. Optim. 16, 2005).
fn is_lower(there: &Here, here: &Here) -> bool {
    let promised = here.gradient.dot(&(&there.shares - &here.shares));
    let is_level = there.value <= here.value + FLAT * here.value.abs();
    there.value <= here.value + ENOUGH * promised || is_level && there.gradient.norm() < here.gradient.norm()
}

/// A coordinate at an end of its side would go beyond it.
fn leaves(here: &Here, i: usize) -> bool {
    let (share, slope) = (here.shares[i], here.gradient[i]);
    share <= 0.0 && slope > 0.0 || share >= 1.0 && slope < 0.0
}

/// The step that the curvature suggests for the coordinates that are free; `None` if none is.
fn direction(here: &Here, curvature: &DMatrix<f64>) -> Option<DVector<f64>> {
    let gradient = &here.gradient;
    let free: Vec<usize> = (0..gradient.len()).filter(|&i| !leaves(here, i) && gradient[i] != 0.0).collect();
    if free.is_empty() {
        return None;
    }
    let part = DMatrix::from_fn(free.len(), free.len(), |i, j| curvature[(free[i], free[j])]);
    let down = DVector::from_iterator(free.len(), free.iter().map(|&i| -gradient[i]));
    // Updates keep the matrix positive definite but for rounding.
    let step = part.cholesky().map_or_else(|| &down * (FIRST / down.norm()), |factors| factors.solve(&down));
    let mut direction = DVector::zeros(gradient.len());
    for (place, &i) in free.iter().enumerate() {
        direction[i] = step[place];
    }
    Some(direction)
}

/// What a step s with the change y of the gradient tells of the curvature.
fn learn(curvature: &mut DMatrix<f64>, s: &DVector<f64>, y: &DVector<f64>) {
    let (image, along) = (&*curvature * s, s.dot(y));
    let own = s.dot(&image);
    if along > 1e-10 * s.norm() * y.norm() && own > 0.0 {
        *curvature += y * y.transpose() / along - &image * image.transpose() / own;
    }
}
