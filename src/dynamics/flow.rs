//! Flows: the exact motion of one contact state.
//!
//! The blocks of its modes ([`super::contact_state`]) move each by itself; a harmonic drive is one more of them. Gap, amplitude
//! and time do not enter, so one flow serves a whole sweep.

use std::cell::OnceCell;
use std::rc::Rc;

use nalgebra::DMatrix;

use super::EngineError;
use super::bank::Bank;
use super::block::Block;
use super::contact_state::Modes;
use super::dissipation::Dissipation;
use super::gains::Closed;
use super::series::Series;
use super::signals::{Row, Rows, Signals};
use super::system::{Contact, Face, HybridSystem, Law, dot};

/// One contact state, ready to be propagated.
pub(crate) struct Flow {
    /// What it shares with the flows of other drives.
    pub(crate) modes: Rc<Modes>,
    /// Blocks of the free motion; the last one is the drive if it is harmonic.
    pub(crate) blocks: Vec<Block>,
    /// The same, side by side for their kernels.
    pub(crate) bank: Bank,
    /// Their Taylor series.
    pub(crate) series: Series,
    /// Blocks without the drive.
    pub(crate) own: usize,
    /// Some block has an eigenvalue zero, so that a constant load sets it moving.
    drifts: bool,
    /// Coordinates: those of the structure, then one per resilient contact.
    pub(crate) order: usize,
    /// Answer to a unit force at the forcing point.
    force: Load,
    /// Answer to sin ω t at the forcing point: p = cosine·cos ω t + sine·sin ω t.
    harmonic: Option<Steady>,
    /// Signals that are watched or measured.
    pub(crate) rows: Rows,
    /// Closed forms of its integrals, where they keep their digits.
    pub(crate) closed: Option<Closed>,
    dissipation: OnceCell<Dissipation>,
}

/// Answer of a contact state to a constant load: p = rest + rest_rate·t, p′ = rest_rate, and slope·t + bend·t² in the
/// coordinates of the blocks that drift.
#[derive(Default)]
pub(crate) struct Load {
    rest: Vec<f64>,
    rest_rate: Vec<f64>,
    slope: Vec<[f64; 2]>,
    bend: Vec<[f64; 2]>,
}

/// Steady answer to a harmonic force.
struct Steady {
    omega: f64,
    cosine: Vec<f64>,
    sine: Vec<f64>,
}

/// A polynomial part of a signal: p₀ + p₁ t + p₂ t².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Parabola {
    pub(crate) p0: f64,
    pub(crate) p1: f64,
    pub(crate) p2: f64,
}

impl Parabola {
    pub(crate) fn at(self, t: f64) -> f64 {
        self.p0 + t * (self.p1 + t * self.p2)
    }

    pub(crate) fn rate(self, t: f64) -> f64 {
        self.p1 + 2.0 * self.p2 * t
    }

    pub(crate) fn times(self, factor: f64) -> Self {
        Self { p0: factor * self.p0, p1: factor * self.p1, p2: factor * self.p2 }
    }

    pub(crate) fn negative(self) -> Self {
        self.times(-1.0)
    }
}

impl Contact {
    /// The face in contact, if any, and whether it holds the particle rigidly.
    pub(crate) fn face(self, particle: &super::system::Particle) -> Option<&Face> {
        match self {
            Self::Floor | Self::FloorStop => Some(&particle.floor),
            Self::Ceiling | Self::CeilingStop => particle.ceiling.as_ref(),
            Self::Flight | Self::FloorReleased | Self::CeilingReleased => None,
        }
    }

    /// Pressed into a resilient face.
    pub(crate) fn presses(self, particle: &super::system::Particle) -> bool {
        matches!(self, Self::Floor | Self::Ceiling)
            && matches!(self.face(particle).map(|face| face.law), Some(Law::Resilient { .. }))
    }

    /// Held: moves as one with the face.
    pub(crate) fn holds(self, particle: &super::system::Particle) -> bool {
        self.face(particle).is_some() && !self.presses(particle)
    }
}

impl Flow {
    /// Builds the flow of a contact state with the contact damping now in force.
    pub(crate) fn build(system: &HybridSystem, contacts: &[Contact], damping: &[f64]) -> Result<Self, EngineError> {
        Self::driven(system, Rc::new(Modes::new(system, contacts, damping)?))
    }

    /// The flow of a contact state whose modes are known, under the drive of `system`.
    pub(crate) fn driven(system: &HybridSystem, modes: Rc<Modes>) -> Result<Self, EngineError> {
        let push = modes.answer(system, &system.force_row);
        let force = Load::new(&push, &modes);
        let mut blocks = modes.spectral.blocks.clone();
        let own = blocks.len();
        let harmonic = match system.drive.harmonic {
            None => None,
            Some(drive) => {
                blocks.push(Block::harmonic(drive.angular_frequency));
                Some(Steady::new(drive.angular_frequency, &push, &modes.accelerations, modes.order)?)
            }
        };
        let mut flow = Self {
            bank: Bank::new(&blocks),
            series: Series::new(&blocks),
            drifts: blocks[..own].iter().any(|block| block.determinant == 0.0),
            blocks,
            own,
            order: modes.order,
            modes,
            force,
            harmonic,
            rows: Rows::default(),
            closed: None,
            dissipation: OnceCell::new(),
        };
        flow.rows = Rows::new(system, &flow);
        let omega = flow.harmonic.as_ref().map(|steady| steady.omega);
        flow.closed = Closed::new(&flow.blocks, &flow.modes.spectral.matrices, omega);
        Ok(flow)
    }

    /// Numbers that it keeps, those of its modes among them.
    pub(crate) fn size(&self) -> usize {
        self.modes.size()
            + self.rows.size()
            + self.closed.as_ref().map_or(0, Closed::size)
            + self.dissipation.get().map_or(0, Dissipation::size)
    }

    /// The signal r·p.
    pub(crate) fn row(&self, row: &[f64]) -> Row {
        let size = self.modes.spectral.width();
        // By values and by rates: r·V, column by column of V.
        let mut by = [vec![0.0; size], vec![0.0; size]];
        for (half, by) in by.iter_mut().enumerate() {
            for (i, r) in row.iter().enumerate().filter(|(_, r)| **r != 0.0) {
                let place = (half * self.order + i) * size;
                let entries = &self.modes.spectral.from_blocks[place..place + size];
                by.iter_mut().zip(entries).for_each(|(sum, entry)| *sum += r * entry);
            }
        }
        let mut weights = Vec::with_capacity(self.blocks.len());
        let mut drift = [[0.0; 2]; 2];
        for k in 0..self.own {
            let weight = [by[0][2 * k], by[0][2 * k + 1], by[1][2 * k], by[1][2 * k + 1]];
            for (load, drift) in [&self.modes.gravity, &self.force].into_iter().zip(&mut drift) {
                for (coefficient, part) in drift.iter_mut().zip([load.slope[k], load.bend[k]]) {
                    *coefficient += weight[0] * part[0] + weight[1] * part[1];
                }
            }
            weights.push(weight);
        }
        if let Some(Steady { omega, cosine, sine }) = &self.harmonic {
            let (cosine, sine) = (dot(row, cosine), dot(row, sine));
            weights.push([cosine, sine, omega * sine, -omega * cosine]);
        }
        let load = |load: &Load, [p1, p2]: [f64; 2]| Parabola { p0: dot(row, &load.rest), p1, p2 };
        Row { weights, gravity: load(&self.modes.gravity, drift[0]), force: load(&self.force, drift[1]) }
    }

    /// Block coordinates of (p, p′) at the start of a segment; `force` is the constant force in force, `drive` the phase
    /// of the harmonic one: F cos ω t and F sin ω t, which are the coordinates of its block.
    #[inline]
    pub(crate) fn enter(&self, p: &[f64], rate: &[f64], force: f64, drive: DrivePhase, c: &mut [f64]) {
        let order = self.order;
        let size = self.modes.spectral.width();
        c[..size].fill(0.0);
        for i in 0..order {
            let mut position = p[i] - self.modes.gravity.rest[i] - force * self.force.rest[i];
            let mut velocity = rate[i];
            if let Some(steady) = &self.harmonic {
                position -= steady.cosine[i] * drive.cosine + steady.sine[i] * drive.sine;
                velocity -= steady.omega * (steady.sine[i] * drive.cosine - steady.cosine[i] * drive.sine);
            }
            if self.drifts {
                velocity -= self.modes.gravity.rest_rate[i] + force * self.force.rest_rate[i];
            }
            let (by_position, by_rate) = (
                &self.modes.spectral.to_blocks[i * size..][..size],
                &self.modes.spectral.to_blocks[(order + i) * size..][..size],
            );
            for ((c, x), y) in c[..size].iter_mut().zip(by_position).zip(by_rate) {
                *c += x * position + y * velocity;
            }
        }
        if self.harmonic.is_some() {
            c[size..size + 2].copy_from_slice(&[drive.cosine, drive.sine]);
        }
    }

    /// (p, p′) from block coordinates after `t` seconds of the segment, with the drive's phase then.
    #[inline]
    pub(crate) fn leave(&self, c: &[f64], t: f64, force: f64, drive: DrivePhase, p: &mut [f64], rate: &mut [f64]) {
        let order = self.order;
        let (size, width) = (2 * order, self.modes.spectral.width());
        let (p, rate) = (&mut p[..order], &mut rate[..order]);
        for ((p, by_gravity), by_force) in p.iter_mut().zip(&self.modes.gravity.rest).zip(&self.force.rest) {
            *p = by_gravity + force * by_force;
        }
        rate.fill(0.0);
        // There may be more blocks than coordinates; those that `c` has none for are at rest.
        for (c, column) in c.iter().zip(self.modes.columns.chunks_exact(size)) {
            let (positions, rates) = column.split_at(order);
            p.iter_mut().zip(positions).for_each(|(p, entry)| *p += entry * c);
            rate.iter_mut().zip(rates).for_each(|(rate, entry)| *rate += entry * c);
        }
        if let Some(steady) = &self.harmonic {
            for i in 0..order {
                p[i] += steady.cosine[i] * drive.cosine + steady.sine[i] * drive.sine;
                rate[i] += steady.omega * (steady.sine[i] * drive.cosine - steady.cosine[i] * drive.sine);
            }
        }
        if !self.drifts {
            return;
        }
        for (load, size_of_load) in [(&self.modes.gravity, 1.0), (&self.force, force)] {
            for i in 0..order {
                rate[i] += size_of_load * load.rest_rate[i];
            }
            for k in 0..self.own {
                let at = |j: usize| size_of_load * t * (load.slope[k][j] + t * load.bend[k][j]);
                let (d0, d1) = (at(0), at(1));
                for i in 0..order {
                    p[i] += self.modes.spectral.from_blocks[i * width + 2 * k] * d0
                        + self.modes.spectral.from_blocks[i * width + 2 * k + 1] * d1;
                    rate[i] += self.modes.spectral.from_blocks[(order + i) * width + 2 * k] * d0
                        + self.modes.spectral.from_blocks[(order + i) * width + 2 * k + 1] * d1;
                }
            }
        }
    }

    /// Propagates block coordinates by the kernels of a time, with the drive's phase after it.
    #[inline]
    pub(crate) fn advance(&self, kernels: &[super::block::Kernel], start: &[f64], drive: DrivePhase, end: &mut [f64]) {
        self.move_blocks(kernels, start, end);
        if self.harmonic.is_some() {
            end[2 * self.own..2 * self.own + 2].copy_from_slice(&[drive.cosine, drive.sine]);
        }
    }

    /// Propagates the coordinates of its own blocks by the kernels of a time.
    #[inline]
    pub(crate) fn move_blocks(&self, kernels: &[super::block::Kernel], start: &[f64], end: &mut [f64]) {
        for k in 0..self.own {
            let [p, q, r, s] = self.modes.spectral.matrices[k];
            let kernel = kernels[k];
            let a = self.blocks[k].decay;
            let (x, y) = (start[2 * k], start[2 * k + 1]);
            end[2 * k] = kernel.c * x + kernel.s * ((p + a) * x + q * y);
            end[2 * k + 1] = kernel.c * y + kernel.s * (r * x + (s + a) * y);
        }
    }

    /// The signals that are watched, at the start of a segment.
    #[inline]
    pub(crate) fn watch(&self, c: &[f64], force: f64, signals: &mut Signals) {
        self.rows.watch(c, force, self.blocks.len(), signals);
    }

    /// So short a time that the cube of what turns in it is below rounding.
    pub(crate) fn is_short(&self, time: f64) -> bool {
        self.blocks.iter().all(|block| block.radius * time < 5e-6)
    }

    /// So short a time that its slowest block has hardly turned.
    pub(crate) fn is_brief(&self, time: f64) -> bool {
        self.blocks[..self.own].iter().any(|block| block.radius * time < super::integral::BRIEF)
    }

    /// Seconds for which it may be followed without a new start.
    pub(crate) fn lasts(&self) -> f64 {
        self.modes.spectral.lasts
    }

    /// Natural frequencies of the contact state, rad/s (moduli of the complex pairs' eigenvalues).
    pub(crate) fn natural_frequencies(&self) -> impl Iterator<Item = f64> {
        self.blocks[..self.own].iter().filter(|block| block.oscillates()).map(|block| block.determinant.sqrt())
    }
}

/// Phase of the harmonic drive: F cos ω t and F sin ω t.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct DrivePhase {
    pub(crate) cosine: f64,
    pub(crate) sine: f64,
}

impl Load {
    pub(crate) fn new(load: &[f64], modes: &Modes) -> Self {
        let order = load.len();
        let spectral = &modes.spectral;
        let size = spectral.width();
        let count = spectral.blocks.len();
        let still = |rest: Vec<f64>| Self {
            rest,
            rest_rate: vec![0.0; order],
            slope: vec![[0.0; 2]; count],
            bend: vec![[0.0; 2]; count],
        };
        if spectral.blocks.iter().all(|block| block.determinant != 0.0) {
            // Static answer: the stiffness part of the accelerations against the load.
            let k = DMatrix::from_fn(order, order, |i, j| -modes.accelerations[i][j]);
            if let Some(rest) = k.lu().solve(&nalgebra::DVector::from_column_slice(load)) {
                return still(rest.iter().copied().collect());
            }
        }
        // Block by block.
        let mut answer = still(vec![0.0; order]);
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

/// Steady amplitudes above this, in units of F/(m ω²), would cost more digits than they may.
const LARGEST_RESONANCE: f64 = 1e8;

impl Steady {
    /// (−ω² + stiffness) cosine + ω damping sine = 0, … : the complex amplitude as a real system of twice the order.
    fn new(omega: f64, push: &[f64], accelerations: &[Vec<f64>], order: usize) -> Result<Self, EngineError> {
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
        // A steady answer far above what the force does in a cycle is taken off again by the free motion, with its digits.
        let most = push.iter().fold(0.0_f64, |most, a| most.max(a.abs())) / (omega * omega) * LARGEST_RESONANCE;
        let solution =
            solution.filter(|x| x.iter().all(|v| v.abs() <= most)).ok_or(EngineError::UndampedResonance { omega })?;
        Ok(Self {
            omega,
            cosine: solution.iter().take(order).copied().collect(),
            sine: solution.iter().skip(order).copied().collect(),
        })
    }
}

impl Flow {
    /// The harmonic drive's phase `t` seconds later.
    pub(crate) fn drive_after(&self, drive: DrivePhase, t: f64) -> DrivePhase {
        let Some(steady) = &self.harmonic else { return drive };
        let (sine, cosine) = super::elementary::sin_cos(steady.omega * t);
        DrivePhase {
            cosine: drive.cosine * cosine - drive.sine * sine,
            sine: drive.sine * cosine + drive.cosine * sine,
        }
    }

    /// ∫ c dt between two states of free motion, from c′ = B c; every block has a place to rest.
    pub(crate) fn integrated(&self, start: &[f64], end: &[f64]) -> Vec<f64> {
        let mut integral = Vec::with_capacity(end.len());
        for ((block, [p, q, r, s]), i) in self.blocks.iter().zip(&self.modes.spectral.matrices).zip((0..).step_by(2)) {
            let (x, y) = (end[i] - start[i], end[i + 1] - start[i + 1]);
            integral.extend([(s * x - q * y) / block.determinant, (p * y - r * x) / block.determinant]);
        }
        integral
    }

    /// Nothing moves but its blocks: no drive, and every load has a place to rest.
    pub(crate) fn is_free(&self) -> bool {
        self.harmonic.is_none() && !self.drifts
    }

    /// What its dashpots take; worked out at the first audit.
    pub(crate) fn dissipation(&self, system: &HybridSystem) -> &Dissipation {
        self.dissipation.get_or_init(|| Dissipation::new(system, self))
    }
}
