//! The fundamental matrix over a period, and its eigenvalues: how much of a disturbance is left after one round.

use nalgebra::{DMatrix, DVector};

use super::recurrence::Scale;
use super::tangent::Tangent;
use super::tape::{Cycle, Step, Tape};
use crate::arithmetic::dense::piece;
use crate::arithmetic::schur::schur;
use crate::contact_state::block::Block;
use crate::error::EngineError;
use crate::system::HybridSystem;

/// Products of lengths that are as exact as their factors.
const SAFE: std::ops::Range<f64> = 1e-200..1e200;

/// A Floquet multiplier; both of a complex pair are given as the one above the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Multiplier {
    /// |μ|.
    pub modulus: f64,
    /// arg μ in [0, π], rad.
    pub angle: f64,
}

/// How a change of the state at the begin of some cycles goes on to their end.
#[derive(Debug, Clone, PartialEq)]
pub struct Fundamental {
    /// ∂(q, y, q′, y′) at the end by the same at the begin, row by row; y the absolute places of the particles.
    pub matrix: Vec<Vec<f64>>,
    /// Its eigenvalues, largest first.
    pub multipliers: Vec<Multiplier>,
    /// Its determinant against the contraction of dashpots and impacts, relative to what it could be at most.
    pub residual: f64,
    /// False where particles were struck at one instant: a change may then put them into another order.
    pub is_unique: bool,
}

impl Fundamental {
    /// Of the last cycles of a run.
    pub(crate) fn of(system: &HybridSystem, tape: &Tape, cycles: usize) -> Result<Self, EngineError> {
        let scale = Scale::new(system, &tape.reach);
        let map = Period::new(system, &scale, tape.last(cycles));
        let size = map.matrix.nrows();
        let entry = |i: usize, k: usize| map.matrix[(i, k)] * scale.unit(i) / scale.unit(k);
        Ok(Self {
            matrix: (0..size).map(|i| (0..size).map(|k| entry(i, k)).collect()).collect(),
            multipliers: map.multipliers()?,
            residual: map.residual(),
            is_unique: !tape.last(cycles).any(|cycle| cycle.blurred),
        })
    }
}

/// The map of a period about the run, in units of the motion.
pub(crate) struct Period {
    pub(crate) matrix: DMatrix<f64>,
    /// What its determinant has to be, and the logarithm of that.
    contraction: f64,
    log_contraction: f64,
}

impl Period {
    pub(crate) fn new<'t>(system: &HybridSystem, scale: &Scale, cycles: impl Iterator<Item = &'t Cycle>) -> Self {
        let mut tangent = Tangent::new(system);
        let size = tangent.size();
        let units: Vec<f64> = (0..size).map(|i| scale.unit(i)).collect();
        let mut columns: Vec<Vec<f64>> =
            (0..size).map(|i| (0..size).map(|k| if i == k { units[i] } else { 0.0 }).collect()).collect();
        let (mut contraction, mut log_contraction) = (1.0, 0.0);
        for (cycle, step) in cycles.flat_map(|cycle| cycle.steps.iter().map(move |step| (cycle, step))) {
            tangent.carry(cycle, step, &mut columns);
            let [factor, log] = expected(system, step);
            contraction *= factor;
            log_contraction += log;
        }
        let matrix = DMatrix::from_fn(size, size, |i, k| columns[k][i] / units[i]);
        Self { matrix, contraction, log_contraction }
    }

    /// All multipliers, largest first.
    pub(crate) fn multipliers(&self) -> Result<Vec<Multiplier>, EngineError> {
        let size = self.matrix.nrows();
        let [_, t] = schur(self.matrix.clone())?;
        let mut multipliers = Vec::with_capacity(size);
        let mut i = 0;
        while i < size {
            if i + 1 < size && t[(i + 1, i)] != 0.0 {
                let pair = Block::new(piece(&t, i)).eigenvalues();
                multipliers.extend(pair.map(|[re, im]| Multiplier::new(re, im.abs())));
                i += 2;
            } else {
                multipliers.push(Multiplier::new(t[(i, i)], 0.0));
                i += 1;
            }
        }
        multipliers.sort_by(|a, b| b.modulus.total_cmp(&a.modulus));
        Ok(multipliers)
    }

    /// |det M − e^(∫ tr) Π ε²|, over the product of the columns' lengths: the most that the determinant could be.
    pub(crate) fn residual(&self) -> f64 {
        let lengths: f64 = self.matrix.column_iter().map(|column| column.norm()).product();
        let determinant = self.matrix.determinant();
        let most = lengths.max(self.contraction);
        let off = (determinant - self.contraction).abs();
        match off {
            0.0 if most > 0.0 => 0.0,
            _ if SAFE.contains(&most) && determinant.is_finite() => off / most,
            _ => self.residual_by_logarithms(),
        }
    }

    /// The same where one of the products leaves the range of numbers.
    fn residual_by_logarithms(&self) -> f64 {
        // A column that has died out is known to no more than the smallest number.
        let length = |column: &[f64]| {
            let most = column.iter().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
            let squares = column.iter().fold(0.0, |sum, x| sum + (x / most) * (x / most));
            libm::log(most) + 0.5 * libm::log(squares.max(1.0))
        };
        let size = self.matrix.nrows();
        let lengths: f64 = self.matrix.as_slice().chunks_exact(size.max(1)).map(length).sum();
        let most = lengths.max(self.log_contraction);
        let lu = self.matrix.clone().lu();
        let (mut sign, mut log) = (lu.p().determinant::<f64>(), 0.0);
        for i in 0..size {
            let pivot = lu.u()[(i, i)];
            log += libm::log(pivot.abs());
            sign = sign.copysign(sign * pivot);
        }
        (sign * libm::exp(log - most) - libm::exp(self.log_contraction - most)).abs()
    }

    /// The orbit that closes, as seen from a state that misses itself by `miss` after the period: Newton's step.
    pub(super) fn orbit(&self, miss: impl Iterator<Item = f64>) -> Result<NearOrbit, EngineError> {
        let size = self.matrix.nrows();
        let step = (DMatrix::identity(size, size) - &self.matrix).lu().solve(&DVector::from_iterator(size, miss));
        let distance = step.map_or(f64::INFINITY, |step| step.iter().fold(0.0_f64, |most, x| most.max(x.abs())));
        Ok(NearOrbit { multipliers: self.multipliers()?, distance })
    }
}

/// An orbit that closes, next to a state.
pub(super) struct NearOrbit {
    /// Its multipliers, largest first.
    pub multipliers: Vec<Multiplier>,
    /// How far it is, in units of the motion; infinite where there is none.
    distance: f64,
}

impl NearOrbit {
    /// Its largest multiplier is one of a complex pair: what is beside it goes round it.
    pub fn turns(&self) -> bool {
        self.multipliers.first().is_some_and(|largest| largest.angle > 0.0 && largest.angle < std::f64::consts::PI)
    }

    /// No multiplier is above `most`, and it is within `near`.
    pub fn attracts(&self, most: f64, near: f64) -> bool {
        self.multipliers.first().is_none_or(|largest| largest.modulus <= most) && self.distance <= near
    }
}

impl Multiplier {
    fn new(real: f64, imaginary: f64) -> Self {
        Self { modulus: libm::hypot(real, imaginary), angle: libm::atan2(imaginary, real) }
    }
}

/// The determinant of a step and its logarithm: e^(tr t) of a flow, ε² of an impact, 0 where a face holds a particle.
fn expected(system: &HybridSystem, step: &Step) -> [f64; 2] {
    match step {
        Step::Flow(flow, length) => {
            let modes = &flow.modes;
            let holds = modes.contacts.iter().zip(&system.particles).any(|(contact, it)| contact.holds(it));
            let accelerations = modes.accelerations(system);
            let trace: f64 = (0..modes.order).map(|i| accelerations[i][modes.order + i]).sum();
            if holds { [0.0, f64::NEG_INFINITY] } else { [libm::exp(trace * length), trace * length] }
        }
        Step::Timed(_) => [1.0, 0.0],
        Step::Event(crossing) => {
            let kicks = crossing.jumps.iter().flat_map(|jump| &jump.kicks);
            let factor: f64 =
                kicks.filter_map(|kick| kick.restitution).map(|restitution| restitution * restitution).product();
            [factor, libm::log(factor)]
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::Period;

    fn residual(matrix: DMatrix<f64>, log_contraction: f64) -> f64 {
        Period { matrix, contraction: libm::exp(log_contraction), log_contraction }.residual()
    }

    #[test]
    fn a_determinant_beyond_the_range_of_numbers_is_compared_by_its_logarithm() {
        let turned = |by: f64, scale: f64| {
            let (sin, cos) = libm::sincos(by);
            DMatrix::from_row_slice(2, 2, &[cos, -sin, sin, cos]) * scale
        };
        for scale in [1e-150, 1e-100, 1e-3, 1.0, 1e100, 1e170] {
            let log = 2.0 * libm::log(scale);
            // ln of 1e-300 is known to 1e-13.
            assert!(residual(turned(0.7, scale), log) < 1e-12, "{scale:e}");
            // A mirror has the opposite determinant, and half of it is missed by a half.
            let mirror = turned(0.7, scale) * DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, -1.0]);
            assert!((residual(mirror, log) - 2.0).abs() < 1e-12, "{scale:e}");
            assert!((residual(turned(0.7, scale), log - libm::log(2.0)) - 0.5).abs() < 1e-12, "{scale:e}");
        }
        // Died out, and held by a face.
        assert!(residual(turned(0.0, 0.0), -2000.0) < 1e-200);
        assert_eq!(residual(turned(0.0, 0.0), f64::NEG_INFINITY), 0.0);
        assert_eq!(residual(turned(0.0, 0.0), libm::log(0.5)), 1.0);
    }
}
