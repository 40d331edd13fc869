//! The fundamental matrix over a period, and its eigenvalues: how much of a disturbance is left after one round.

use nalgebra::{DMatrix, DVector};

use super::recurrence::Scale;
use super::tangent::Tangent;
use super::tape::{Cycle, Step, Tape};
use crate::arithmetic::schur::schur;
use crate::contact_state::block::Block;
use crate::contact_state::spectral::piece;
use crate::error::EngineError;
use crate::system::HybridSystem;

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
    /// What its determinant has to be.
    contraction: f64,
}

impl Period {
    pub(crate) fn new<'t>(system: &HybridSystem, scale: &Scale, cycles: impl Iterator<Item = &'t Cycle>) -> Self {
        let mut tangent = Tangent::new(system);
        let size = tangent.size();
        let units: Vec<f64> = (0..size).map(|i| scale.unit(i)).collect();
        let mut columns: Vec<Vec<f64>> =
            (0..size).map(|i| (0..size).map(|k| if i == k { units[i] } else { 0.0 }).collect()).collect();
        let mut contraction = 1.0;
        for (cycle, step) in cycles.flat_map(|cycle| cycle.steps.iter().map(move |step| (cycle, step))) {
            tangent.carry(cycle, step, &mut columns);
            contraction *= expected(system, step);
        }
        let matrix = DMatrix::from_fn(size, size, |i, k| columns[k][i] / units[i]);
        Self { matrix, contraction }
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
        let off = (self.matrix.determinant() - self.contraction).abs();
        if off == 0.0 { 0.0 } else { off / lengths.max(self.contraction) }
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

/// The determinant of a step: e^(tr t) of a flow, ε² of an impact, 0 where a face holds a particle.
fn expected(system: &HybridSystem, step: &Step) -> f64 {
    match step {
        Step::Flow(flow, length) => {
            let modes = &flow.modes;
            let holds = modes.contacts.iter().zip(&system.particles).any(|(contact, it)| contact.holds(it));
            let accelerations = modes.accelerations(system);
            let trace: f64 = (0..modes.order).map(|i| accelerations[i][modes.order + i]).sum();
            if holds { 0.0 } else { libm::exp(trace * length) }
        }
        Step::Timed(_) => 1.0,
        Step::Event(crossing) => {
            let kicks = crossing.jumps.iter().flat_map(|jump| &jump.kicks);
            kicks.filter_map(|kick| kick.restitution).map(|restitution| restitution * restitution).product()
        }
    }
}
