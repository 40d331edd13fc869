//! The steady response of a contact state: an equilibrium, or a drift, under a constant load, an amplitude under a harmonic one.

use nalgebra::DMatrix;

use crate::contact_state::spectral::Spectral;
use crate::system::DrivePhase;

/// Answer of a contact state to a constant load: p = rest, p′ = rest_rate, and beside them slope·t + bend·t² in
/// the coordinates of the blocks that drift.
#[derive(Clone, Default)]
pub(crate) struct Load {
    pub(crate) rest: Vec<f64>,
    pub(crate) rest_rate: Vec<f64>,
    pub(crate) slope: Vec<[f64; 2]>,
    pub(crate) bend: Vec<[f64; 2]>,
}

impl Load {
    /// A place to rest, for so many blocks.
    pub(crate) fn still(rest: Vec<f64>, blocks: usize) -> Self {
        Self { rest_rate: vec![0.0; rest.len()], rest, slope: vec![[0.0; 2]; blocks], bend: vec![[0.0; 2]; blocks] }
    }

    /// `load` and `accelerations` are those of p, `spectral` its blocks.
    pub(crate) fn new(load: &[f64], spectral: &Spectral, accelerations: &[Vec<f64>]) -> Self {
        let order = load.len();
        let size = spectral.width();
        let count = spectral.blocks.len();
        if !spectral.drifts() {
            // Static answer: the stiffness part of the accelerations against the load.
            let k = DMatrix::from_fn(order, order, |i, j| -accelerations[i][j]);
            if let Some(rest) = k.lu().solve(&nalgebra::DVector::from_column_slice(load)) {
                return Self::still(rest.iter().copied().collect(), count);
            }
        }
        // Block by block.
        let mut answer = Self::still(vec![0.0; order], count);
        for (k, (block, matrix)) in spectral.blocks.iter().zip(&spectral.matrices).enumerate() {
            let in_block = |row: usize| {
                (0..order).fold(0.0, |sum, i| sum + spectral.to_blocks[(order + i) * size + row] * load[i])
            };
            let (offset, slope, bend) = block.answer(*matrix, [in_block(2 * k), in_block(2 * k + 1)]);
            (answer.slope[k], answer.bend[k]) = (slope, bend);
            for i in 0..order {
                let by = |row: usize| {
                    spectral.from_blocks[row * size + 2 * k] * offset[0]
                        + spectral.from_blocks[row * size + 2 * k + 1] * offset[1]
                };
                answer.rest[i] += by(i);
                answer.rest_rate[i] += by(order + i);
            }
        }
        answer
    }
}

/// Steady answer to a harmonic force.
pub(crate) struct Steady {
    pub(crate) omega: f64,
    pub(crate) cosine: Vec<f64>,
    pub(crate) sine: Vec<f64>,
}

/// Steady amplitudes above this, in units of F/(m ω²), would cost more digits than they may: those of resonance, and others.
pub(crate) const RESONANCE: f64 = 1e4;
pub(crate) const LARGEST: f64 = 1e8;

impl Steady {
    /// (−ω² + stiffness) cosine + ω damping sine = 0, … : the complex amplitude as a real system of twice the order. `None` above
    /// `largest` times what the force does in a cycle: free motion would take that off again, with its digits.
    pub(crate) fn new(omega: f64, push: &[f64], accelerations: &[Vec<f64>], largest: f64) -> Option<Self> {
        let order = push.len();
        let mut system = DMatrix::zeros(2 * order, 2 * order);
        let mut load = nalgebra::DVector::zeros(2 * order);
        for i in 0..order {
            // p″ = S p + D p′ + push·sin ω t, with p = c cos + s sin.
            for j in 0..order {
                let (stiff, damped) = (accelerations[i][j], accelerations[i][order + j]);
                system[(i, j)] = -stiff;
                system[(i, order + j)] = -omega * damped;
                system[(order + i, order + j)] = -stiff;
                system[(order + i, j)] = omega * damped;
            }
            system[(i, i)] -= omega * omega;
            system[(order + i, order + i)] -= omega * omega;
            load[order + i] = push[i];
        }
        let solution = system.lu().solve(&load).filter(|x| x.iter().all(|v| v.is_finite()));
        let most = push.iter().fold(0.0_f64, |most, a| most.max(a.abs())) / (omega * omega) * largest;
        let solution = solution.filter(|x| x.iter().all(|v| v.abs() <= most))?;
        let (cosine, sine) = solution.as_slice().split_at(order);
        Some(Self { omega, cosine: cosine.to_vec(), sine: sine.to_vec() })
    }

    /// Place and rate of a coordinate at a phase of the drive.
    #[inline(always)]
    pub(crate) fn at(&self, i: usize, drive: DrivePhase) -> [f64; 2] {
        let (cosine, sine) = (self.cosine[i], self.sine[i]);
        let rate = self.omega * (sine * drive.cosine - cosine * drive.sine);
        [cosine * drive.cosine + sine * drive.sine, rate]
    }
}
