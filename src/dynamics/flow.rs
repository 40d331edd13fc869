//! Flows: the exact motion of one contact state.
//!
//! With the particles in flight taken out (they fall by themselves) and those held by a rigid face counted as mass, a
//! contact state is linear: p = (q, w) with w the compression of every resilient face in contact,
//!
//! q″ = M⁻¹(−K q − C q′ + b F − Σ φ N),   w″ = N/mp − g − φ·q″,   N = −k w − c w′.
//!
//! Its matrix is split into 2 × 2 blocks ([`super::modes`]) and never built again: gap, amplitude and time do
//! not enter, so one flow serves a whole sweep.

use nalgebra::DMatrix;

use super::EngineError;
use super::block::Block;
use super::series::Series;
use super::signals::{Row, Rows, Signals};
use super::spectral::Spectral;
use super::system::{Contact, Face, HybridSystem, Law, Matrix, dot};

/// One contact state, ready to be propagated.
pub(crate) struct Flow {
    /// Contact of each particle.
    pub(crate) contacts: Vec<Contact>,
    /// Contact damping in force, per particle, N s/m.
    pub(crate) damping: Vec<f64>,
    /// Blocks of the free motion; the last one is the drive if it is harmonic.
    pub(crate) blocks: Vec<Block>,
    /// Their Taylor series.
    pub(crate) series: Series,
    /// Blocks without the drive.
    pub(crate) own: usize,
    /// Some block has an eigenvalue zero, so that a constant load sets it moving.
    drifts: bool,
    /// Coordinates: those of the structure, then one per resilient contact.
    pub(crate) order: usize,
    /// Which particle the coordinate `structure + i` belongs to.
    pub(crate) attached: Vec<usize>,
    /// Block coordinates from (p, p′), column by column, 2·order square.
    to_blocks: Vec<f64>,
    /// (p, p′) from block coordinates.
    from_blocks: Vec<f64>,
    /// Each block's matrix.
    matrices: Vec<[f64; 4]>,
    /// Answer to gravity.
    gravity: Load,
    /// The same for a unit force at the forcing point.
    force: Load,
    /// Answer to sin ω t at the forcing point: p = cosine·cos ω t + sine·sin ω t.
    harmonic: Option<Steady>,
    /// Signals that are watched or measured.
    pub(crate) rows: Rows,
    /// Closed forms of its integrals, where they keep their digits.
    pub(crate) forms: Option<super::integral::Forms>,
}

/// Answer of a contact state to a constant load: p = rest + rest_rate·t, p′ = rest_rate, and slope·t + bend·t² in the
/// coordinates of the blocks that drift.
struct Load {
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
        let n = system.mass.order;
        let attached: Vec<usize> = (0..contacts.len()).filter(|&j| contacts[j].presses(&system.particles[j])).collect();
        let order = n + attached.len();
        let mass = carried_mass(system, contacts);
        let solve = Cholesky::new(&mass)?;
        let face_of = |j: usize| contacts[j].face(&system.particles[j]).expect("a pressing particle has a face");
        let accelerations = accelerations(system, &solve, &attached, &face_of, damping);

        let modes = super::modes::split(&accelerations, &mass_of(system, mass, &attached, &face_of))?;

        let weight: Vec<f64> = {
            let mut q = vec![0.0; n];
            for (j, particle) in system.particles.iter().enumerate() {
                if let (true, Some(face)) = (contacts[j].holds(particle), contacts[j].face(particle)) {
                    q.iter_mut().zip(&face.row).for_each(|(sum, phi)| *sum -= particle.mass * system.gravity * phi);
                }
            }
            let mut a = solve.solve(&q);
            for &j in &attached {
                a.push(-system.gravity - dot(&face_of(j).row, &a[..n]));
            }
            a
        };
        let push = {
            let mut a = solve.solve(&system.force_row);
            for &j in &attached {
                a.push(-dot(&face_of(j).row, &a[..n]));
            }
            a
        };
        let gravity = Load::new(&weight, &accelerations, &modes);
        let force = Load::new(&push, &accelerations, &modes);
        let Spectral { from_blocks, to_blocks, matrices, blocks } = modes;
        let own = blocks.len();
        let drifts = blocks.iter().any(|block| block.determinant == 0.0);
        let mut blocks = blocks;
        let harmonic = match system.drive.harmonic {
            None => None,
            Some(drive) => {
                blocks.push(Block::harmonic(drive.angular_frequency));
                Some(Steady::new(drive.angular_frequency, &push, &accelerations, order)?)
            }
        };
        let mut flow = Self {
            series: Series::new(&blocks),
            contacts: contacts.to_vec(),
            damping: damping.to_vec(),
            blocks,
            own,
            drifts,
            order,
            attached,
            to_blocks,
            from_blocks,
            matrices,
            gravity,
            force,
            harmonic,
            rows: Rows::default(),
            forms: None,
        };
        flow.rows = Rows::new(system, &flow);
        flow.forms = super::integral::Forms::new(&flow.blocks, flow.harmonic.is_some());
        Ok(flow)
    }

    /// The signal r·p.
    pub(crate) fn row(&self, row: &[f64]) -> Row {
        let size = 2 * self.order;
        let mut weights = Vec::with_capacity(self.own);
        let mut drift = [[0.0; 2]; 2];
        for k in 0..self.own {
            let column = |offset: usize, column: usize| {
                (0..self.order).fold(0.0, |sum, i| sum + row[i] * self.from_blocks[(offset + i) * size + column])
            };
            let weight =
                [column(0, 2 * k), column(0, 2 * k + 1), column(self.order, 2 * k), column(self.order, 2 * k + 1)];
            for (load, drift) in [&self.gravity, &self.force].into_iter().zip(&mut drift) {
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
        Row { weights, gravity: load(&self.gravity, drift[0]), force: load(&self.force, drift[1]) }
    }

    /// Block coordinates of (p, p′) at the start of a segment; `force` is the constant force in force, `drive` the phase
    /// of the harmonic one: F cos ω t and F sin ω t, which are the coordinates of its block.
    #[inline]
    pub(crate) fn enter(&self, p: &[f64], rate: &[f64], force: f64, drive: DrivePhase, c: &mut [f64]) {
        let order = self.order;
        let size = 2 * order;
        c[..size].fill(0.0);
        for i in 0..order {
            let mut position = p[i] - self.gravity.rest[i] - force * self.force.rest[i];
            let mut velocity = rate[i];
            if let Some(steady) = &self.harmonic {
                position -= steady.cosine[i] * drive.cosine + steady.sine[i] * drive.sine;
                velocity -= steady.omega * (steady.sine[i] * drive.cosine - steady.cosine[i] * drive.sine);
            }
            if self.drifts {
                velocity -= self.gravity.rest_rate[i] + force * self.force.rest_rate[i];
            }
            let (by_position, by_rate) =
                (&self.to_blocks[i * size..][..size], &self.to_blocks[(order + i) * size..][..size]);
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
        let size = 2 * order;
        for i in 0..order {
            let mut position = self.gravity.rest[i] + force * self.force.rest[i];
            let mut velocity = 0.0;
            for (k, c) in c[..size].iter().enumerate() {
                position += self.from_blocks[i * size + k] * c;
                velocity += self.from_blocks[(order + i) * size + k] * c;
            }
            if let Some(steady) = &self.harmonic {
                position += steady.cosine[i] * drive.cosine + steady.sine[i] * drive.sine;
                velocity += steady.omega * (steady.sine[i] * drive.cosine - steady.cosine[i] * drive.sine);
            }
            p[i] = position;
            rate[i] = velocity;
        }
        if !self.drifts {
            return;
        }
        for (load, size_of_load) in [(&self.gravity, 1.0), (&self.force, force)] {
            for i in 0..order {
                rate[i] += size_of_load * load.rest_rate[i];
            }
            for k in 0..self.own {
                let at = |j: usize| size_of_load * t * (load.slope[k][j] + t * load.bend[k][j]);
                let (d0, d1) = (at(0), at(1));
                for i in 0..order {
                    p[i] += self.from_blocks[i * size + 2 * k] * d0 + self.from_blocks[i * size + 2 * k + 1] * d1;
                    rate[i] += self.from_blocks[(order + i) * size + 2 * k] * d0
                        + self.from_blocks[(order + i) * size + 2 * k + 1] * d1;
                }
            }
        }
    }

    /// Propagates block coordinates by the kernels of a time.
    #[inline]
    pub(crate) fn advance(&self, kernels: &[super::block::Kernel], start: &[f64], end: &mut [f64]) {
        for k in 0..self.own {
            let [p, q, r, s] = self.matrices[k];
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
    fn new(load: &[f64], accelerations: &[Vec<f64>], modes: &Spectral) -> Self {
        let order = load.len();
        let size = 2 * order;
        let count = modes.blocks.len();
        let still = |rest: Vec<f64>| Self {
            rest,
            rest_rate: vec![0.0; order],
            slope: vec![[0.0; 2]; count],
            bend: vec![[0.0; 2]; count],
        };
        if modes.blocks.iter().all(|block| block.determinant != 0.0) {
            // Static answer: the stiffness part of the accelerations against the load.
            let k = DMatrix::from_fn(order, order, |i, j| -accelerations[i][j]);
            if let Some(rest) = k.lu().solve(&nalgebra::DVector::from_column_slice(load)) {
                return still(rest.iter().copied().collect());
            }
        }
        // Block by block.
        let mut answer = still(vec![0.0; order]);
        for (k, (block, matrix)) in modes.blocks.iter().zip(&modes.matrices).enumerate() {
            let in_block =
                |row: usize| (0..order).fold(0.0, |sum, i| sum + modes.to_blocks[(order + i) * size + row] * load[i]);
            let (offset, slope, bend) = block.answer(*matrix, [in_block(2 * k), in_block(2 * k + 1)]);
            (answer.slope[k], answer.bend[k]) = (slope, bend);
            for i in 0..order {
                let by = |row: usize| {
                    modes.from_blocks[row * size + 2 * k] * offset[0]
                        + modes.from_blocks[row * size + 2 * k + 1] * offset[1]
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

/// Accelerations of p by (p, p′): order rows of 2·order numbers.
fn accelerations<'a>(
    system: &HybridSystem,
    solve: &Cholesky,
    attached: &[usize],
    face_of: &dyn Fn(usize) -> &'a Face,
    damping: &[f64],
) -> Vec<Vec<f64>> {
    let n = system.mass.order;
    let order = n + attached.len();
    let mut a = vec![vec![0.0; 2 * order]; order];
    for j in 0..n {
        let column = |matrix: &super::system::Matrix| (0..n).map(|i| -matrix.at(i, j)).collect::<Vec<_>>();
        let (stiff, damped) = (solve.solve(&column(&system.stiffness)), solve.solve(&column(&system.damping)));
        for i in 0..n {
            a[i][j] = stiff[i];
            a[i][order + j] = damped[i];
        }
    }
    for (slot, &particle) in attached.iter().enumerate() {
        let face = face_of(particle);
        let Law::Resilient { stiffness, .. } = face.law else { continue };
        let i = n + slot;
        // N = −k w − c w′ pushes the structure along −φ.
        let push = solve.solve(&face.row);
        for row in 0..n {
            a[row][i] += stiffness * push[row];
            a[row][order + i] += damping[particle] * push[row];
        }
    }
    for (slot, &particle) in attached.iter().enumerate() {
        let face = face_of(particle);
        let Law::Resilient { stiffness, .. } = face.law else { continue };
        let i = n + slot;
        for column in 0..2 * order {
            let base = (0..n).fold(0.0, |sum, row| sum + face.row[row] * a[row][column]);
            a[i][column] = -base;
        }
        a[i][i] -= stiffness / system.particles[particle].mass;
        a[i][order + i] -= damping[particle] / system.particles[particle].mass;
    }
    a
}

/// M + Σ mp φ φᵀ over the particles that a face holds.
pub(crate) fn carried_mass(system: &HybridSystem, contacts: &[Contact]) -> super::system::Matrix {
    let mut mass = system.mass.clone();
    let n = mass.order;
    for (particle, contact) in system.particles.iter().zip(contacts) {
        if let (true, Some(face)) = (contact.holds(particle), contact.face(particle)) {
            for i in 0..n {
                for j in 0..n {
                    mass.entries[i * n + j] += particle.mass * face.row[i] * face.row[j];
                }
            }
        }
    }
    mass
}

/// Mass matrix of p = (q, w): each particle in contact moves with φ·q + w.
fn mass_of<'a>(
    system: &HybridSystem,
    carried: Matrix,
    attached: &[usize],
    face_of: &dyn Fn(usize) -> &'a Face,
) -> Matrix {
    let n = carried.order;
    let mut mass = Matrix::diagonal(&vec![0.0; n + attached.len()]);
    let order = mass.order;
    for i in 0..n {
        mass.entries[i * order..][..n].copy_from_slice(&carried.entries[i * n..][..n]);
    }
    for (slot, &j) in attached.iter().enumerate() {
        let particle = system.particles[j].mass;
        let mut row = face_of(j).row.clone();
        row.resize(order, 0.0);
        row[n + slot] = 1.0;
        for (i, x) in row.iter().enumerate() {
            for (k, y) in row.iter().enumerate() {
                mass.entries[i * order + k] += particle * x * y;
            }
        }
    }
    mass
}

/// Cholesky factor of a mass matrix; own loops, since its bits reach the results.
pub(crate) struct Cholesky {
    order: usize,
    lower: Vec<f64>,
}

impl Cholesky {
    pub(crate) fn new(mass: &super::system::Matrix) -> Result<Self, EngineError> {
        let n = mass.order;
        let mut lower = vec![0.0; n * n];
        for j in 0..n {
            let pivot = (0..j).fold(mass.at(j, j), |sum, k| sum - lower[j * n + k] * lower[j * n + k]);
            if !(pivot > 0.0) {
                return Err(EngineError::MassNotPositive { row: j });
            }
            lower[j * n + j] = pivot.sqrt();
            for i in j + 1..n {
                let sum = (0..j).fold(mass.at(i, j), |sum, k| sum - lower[i * n + k] * lower[j * n + k]);
                lower[i * n + j] = sum / lower[j * n + j];
            }
        }
        Ok(Self { order: n, lower })
    }

    pub(crate) fn solve(&self, b: &[f64]) -> Vec<f64> {
        let n = self.order;
        let mut x = b.to_vec();
        for i in 0..n {
            x[i] = (0..i).fold(x[i], |sum, k| sum - self.lower[i * n + k] * x[k]) / self.lower[i * n + i];
        }
        for i in (0..n).rev() {
            x[i] = (i + 1..n).fold(x[i], |sum, k| sum - self.lower[k * n + i] * x[k]) / self.lower[i * n + i];
        }
        x
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

    /// Length of a quadrature panel from `t` on: short against every block that still moves the velocities visibly.
    pub(crate) fn panel(&self, start: &[f64], t: f64, scratch: &mut [f64]) -> f64 {
        let kernels: Vec<_> = self.blocks.iter().map(|block| block.kernel(t)).collect();
        self.advance(&kernels, start, scratch);
        let size = 2 * self.order;
        let share = |k: usize| {
            (self.order..size).fold(0.0, |sum, i| {
                sum + (self.from_blocks[i * size + 2 * k] * scratch[2 * k]).abs()
                    + (self.from_blocks[i * size + 2 * k + 1] * scratch[2 * k + 1]).abs()
            })
        };
        let shares: Vec<f64> = (0..self.own).map(share).collect();
        let total: f64 = shares.iter().sum();
        let drive = self.harmonic.as_ref().map_or(0.0, |steady| steady.omega);
        let fastest = (0..self.own)
            .filter(|&k| shares[k] > 1e-15 * total)
            .fold(drive, |fastest, k| fastest.max(self.blocks[k].radius));
        if fastest > 0.0 { 1.5 / fastest } else { f64::INFINITY }
    }
}
