//! Flows: the exact motion of one contact state.
//!
//! The blocks of its modes ([`crate::contact_state`]) move each by itself; a harmonic drive is one more of them. Gap, amplitude
//! and time do not enter, so one flow serves a whole sweep.

pub(crate) mod cells;
mod dissipation;
pub(crate) mod ends;
pub(crate) mod gains;
pub(crate) mod integral;
mod lyapunov;
pub(crate) mod pair_integral;
pub(crate) mod parabola;
pub(crate) mod series;
pub(crate) mod signals;
pub(crate) mod steps;
pub(crate) mod sums;
pub(crate) mod way;

mod doubled;

use std::cell::{Cell, OnceCell};
use std::rc::Rc;

use crate::arithmetic::elementary::sin_cos;
use crate::arithmetic::exact;
use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::matrix::dot;
use crate::arithmetic::wide::widened;
use crate::contact::Side;
use crate::contact_state::Modes;
use crate::contact_state::bank::{Bank, Kernels, Propagator};
use crate::contact_state::block::Block;
use crate::contact_state::conservative::Conservative;
use crate::contact_state::load::{self, Load, Steady};
use crate::error::EngineError;
use crate::flow::cells::Cells;
use crate::flow::dissipation::Dissipation;
use crate::flow::ends::Ends;
use crate::flow::gains::{Closed, VelocitySquare};
use crate::flow::parabola::Parabola;
use crate::flow::series::Series;
use crate::flow::signals::{Row, Rows};
use crate::flow::steps::Steps;
use crate::flow::way::{MOST_BLOCKS, Ways};
use crate::system::{Contact, DrivePhase, HybridSystem};

/// Distance of a block's eigenvalue from the drive's, as a share of that, below which the steady answer is above ten times F/(m ω²).
const NEAR_RESONANCE: f64 = 0.05;

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
    /// Transfers over whole steps, where a contact state is visited often enough.
    pub(crate) steps: Option<Steps>,
    /// Its motion by cells, where it has few blocks.
    pub(crate) cells: Option<Box<Cells>>,
    /// Those of its own, with their matrices.
    propagators: Vec<Propagator>,
    /// Blocks without the drive.
    pub(crate) own: usize,
    /// The highest natural frequency of the contact state, rad/s (modulus of a complex pair's eigenvalue).
    pub(crate) highest_frequency: f64,
    /// The smallest radius of its own blocks, 1/s.
    slowest: f64,
    /// Some block has an eigenvalue zero, so that a constant load sets it moving.
    drifts: bool,
    /// Some blocks take in the harmonic drive, whose phase they start with.
    is_resonant: bool,
    /// The drive is so near to the frequency of a block that its steady answer may be far above the motion, which is the difference of that
    /// answer and of free motion: squares of the two have no digits to spare.
    pub(crate) is_near_resonance: bool,
    /// Coordinates: those of the structure, then one per resilient contact.
    pub(crate) order: usize,
    /// Answer to a unit force at the forcing point.
    force: Rc<Load>,
    /// Answer to sin ω t at the forcing point: p = cosine·cos ω t + sine·sin ω t.
    harmonic: Option<Steady>,
    /// Signals that are watched or measured.
    pub(crate) rows: Rows,
    /// Those of the faces on both sides of each enclosure; worked out when they are asked for.
    faces: OnceCell<Vec<[OnceCell<Row>; 2]>>,
    /// Closed forms of its integrals, where they keep their digits; worked out when they are asked for.
    closed: OnceCell<Option<Closed>>,
    velocity_squares: OnceCell<Vec<VelocitySquare>>,
    /// Whether short segments leave their integrals digits.
    ends: OnceCell<Ends>,
    dissipation: OnceCell<Dissipation>,
    /// It may be left for the next flow in block coordinates: these are as many as ask for them, and only the drive moves beside them.
    pub(crate) has_ways: bool,
    ways: Ways,
    /// Its place among the states that a run visits.
    pub(crate) place: Cell<usize>,
}

/// The vectors of a flow that is not needed any more: half cycles put one flow in the place of another all the time.
#[derive(Default)]
pub(crate) struct Room {
    blocks: Vec<Block>,
    bank: Bank,
    series: Series,
    propagators: Vec<Propagator>,
    rows: Rows,
}

impl From<Flow> for Room {
    fn from(Flow { blocks, bank, series, propagators, rows, .. }: Flow) -> Self {
        Self { blocks, bank, series, propagators, rows }
    }
}

/// Room for so many numbers, whatever stands there.
#[inline(always)]
fn room(work: &mut Vec<f64>, count: usize) -> &mut [f64] {
    if work.len() < count {
        work.resize(count, 0.0);
    }
    &mut work[..count]
}

impl Flow {
    /// Builds the flow of a contact state with the contact damping now in force.
    pub(crate) fn build(system: &HybridSystem, contacts: &[Contact], damping: &[f64]) -> Result<Self, EngineError> {
        let bare = Rc::new(Conservative::new(system, contacts)?);
        Self::driven(system, Rc::new(Modes::new(system, bare, contacts, damping, None)?), None, Room::default())
    }

    /// The flow of a contact state whose modes are known, under the drive of `system`; `like` is one under other dampings.
    pub(crate) fn driven(
        system: &HybridSystem,
        modes: Rc<Modes>,
        like: Option<&Self>,
        room: Room,
    ) -> Result<Self, EngineError> {
        // No dashpot holds anything at rest.
        let is_known = |like: &&Self| system.drive.harmonic.is_none() && modes.is_normal && like.modes.is_normal;
        let (modes, harmonic, force) = if let Some(like) = like.filter(is_known) {
            (modes, None, Rc::clone(&like.force))
        } else {
            let push = modes.answer(system, &system.force_row);
            let (modes, harmonic) = match system.drive.harmonic {
                None => (modes, None),
                Some(drive) => {
                    let (modes, steady) = answered(system, modes, &push, drive.angular_frequency)?;
                    (modes, Some(steady))
                }
            };
            let force = Rc::new(modes.load(system, &push));
            (modes, harmonic, force)
        };
        let Room { mut blocks, bank, series, propagators, rows } = room;
        blocks.clone_from(&modes.spectral.blocks);
        let own = blocks.len();
        let turning = blocks.iter().filter(|block| block.oscillates());
        let highest_frequency = turning.map(|block| block.determinant.sqrt()).fold(0.0, f64::max);
        blocks.extend(harmonic.as_ref().map(|steady| Block::harmonic(steady.omega)));
        let is_resonant = modes.spectral.to_blocks.len() > 2 * modes.order * modes.spectral.width();
        let is_driven_near = |block: &Block| {
            let omega = harmonic.as_ref().map_or(0.0, |steady: &Steady| steady.omega);
            block.oscillates() && libm::hypot(block.decay, block.root - omega) <= NEAR_RESONANCE * omega
        };
        let is_near_resonance = !is_resonant && blocks[..own].iter().any(is_driven_near);
        if !(system.drive.period.is_finite() && blocks.iter().all(Block::is_finite)) {
            return Err(EngineError::RateNotFinite);
        }
        let slowest = blocks[..own].iter().fold(f64::INFINITY, |least, block| block.radius.min(least));
        let series = series.of(&blocks);
        let bank = bank.of(&blocks);
        // Half cycles leave a contact state before its tables pay.
        let is_visited_often = system.drive.half_cycles.is_none();
        let (drifts, lasts) = (modes.spectral.drifts(), modes.spectral.lasts);
        let is_split = is_visited_often && !drifts && !is_resonant && lasts.is_infinite();
        let has_ways = is_split && blocks.len() <= MOST_BLOCKS;
        let few = is_visited_often && bank.blocks.len() == 1;
        let mut flow = Self {
            slowest,
            cells: few.then(|| Box::new(Cells::new(&bank, &blocks, series.pace))),
            bank,
            steps: is_visited_often.then(|| Steps::new(series.pace)),
            series,
            propagators: Propagator::of(propagators, &modes.spectral.matrices, &blocks),
            drifts,
            is_resonant,
            is_near_resonance,
            blocks,
            own,
            highest_frequency,
            order: modes.order,
            modes,
            force,
            harmonic,
            rows: Rows::default(),
            faces: OnceCell::new(),
            closed: OnceCell::new(),
            velocity_squares: OnceCell::new(),
            ends: OnceCell::new(),
            dissipation: OnceCell::new(),
            has_ways,
            ways: Ways::default(),
            place: Cell::new(0),
        };
        flow.rows = rows.of(system, &flow.modes, &flow.blocks, |row, room| flow.row(row, room));
        Ok(flow)
    }

    /// Numbers that it keeps, those of its modes among them.
    pub(crate) fn size(&self) -> usize {
        self.modes.size()
            + self.rows.size()
            + 4 * self.blocks.len()
                * self.faces.get().into_iter().flatten().flatten().filter(|face| face.get().is_some()).count()
            + self.steps.as_ref().map_or(0, Steps::size)
            + self.cells.as_ref().map_or(0, |_| Cells::size())
            + self.closed.get().and_then(Option::as_ref).map_or(0, Closed::size)
            + self.velocity_squares.get().map_or(0, |rows| rows.iter().map(VelocitySquare::size).sum())
            + self.ends.get().map_or(0, Ends::size)
            + self.dissipation.get().map_or(0, Dissipation::size)
            + self.size_of_ways()
    }

    /// Numbers that its coordinates take in whole registers.
    pub(crate) fn width(&self) -> usize {
        2 * WIDTH * self.bank.blocks.len()
    }

    /// Closed forms of its integrals, where they keep their digits.
    #[inline]
    pub(crate) fn closed(&self) -> Option<&Closed> {
        let omega = || self.harmonic.as_ref().map(|steady| steady.omega);
        let solved = || Closed::new(&self.blocks, &self.modes.spectral.matrices, omega());
        let loses = self.is_resonant || self.is_near_resonance;
        self.closed.get_or_init(|| if loses { None } else { solved() }).as_ref()
    }

    /// The squares of the observed velocities, integrated in closed form.
    pub(crate) fn velocity_squares(&self, closed: &Closed) -> &[VelocitySquare] {
        self.velocity_squares.get_or_init(|| closed.velocity_squares(&self.observed()))
    }

    /// Whether short segments leave their integrals digits.
    #[inline(always)]
    pub(crate) fn ends(&self) -> &Ends {
        self.ends.get_or_init(|| Ends::new(&self.observed(), &self.blocks))
    }

    fn observed(&self) -> Vec<&Row> {
        self.rows.observed.iter().map(|&row| self.rows.row(row)).collect()
    }

    /// Row of the face on one side of particle j's enclosure.
    pub(crate) fn face(&self, system: &HybridSystem, j: usize, side: Side) -> &Row {
        let [floor, ceiling] = &self.faces.get_or_init(|| vec![Default::default(); system.particles.len()])[j];
        side.of(floor, ceiling).get_or_init(|| self.row(&side.face(&system.particles[j]).row, Vec::new()))
    }

    widened! {
        /// The signal r·p, in the room of some weights; a row may end where only zeros follow.
        pub(crate) fn row | row_wide (&self, row: &[f64], room: Vec<[f64; 4]>) -> Row = row_by_registers
    }

    #[inline(always)]
    fn row_by_registers(&self, row: &[f64], room: Vec<[f64; 4]>) -> Row {
        let size = self.modes.spectral.width();
        // By values and by rates: r·V, column by column of V.
        let mut weights = room;
        weights.clear();
        weights.reserve(self.blocks.len());
        weights.resize(self.own, [0.0; 4]);
        let (values, rates) = self.modes.spectral.from_blocks.split_at(self.order * size);
        for (i, r) in row.iter().enumerate().filter(|(_, r)| **r != 0.0) {
            let [values, rates] = [values, rates].map(|entries| entries[i * size..][..size].as_chunks::<2>().0);
            for ((weight, &[v0, v1]), &[r0, r1]) in weights.iter_mut().zip(values).zip(rates) {
                *weight = (Four::new(*weight) + *r * Four::new([v0, v1, r0, r1])).array();
            }
        }
        let mut drift = [[0.0; 2]; 2];
        let drifting = if self.drifts { &weights[..] } else { &[] };
        for (k, weight) in drifting.iter().enumerate() {
            for (load, drift) in [&self.modes.gravity, &self.force].into_iter().zip(&mut drift) {
                for (coefficient, part) in drift.iter_mut().zip([load.slope[k], load.bend[k]]) {
                    *coefficient += weight[0] * part[0] + weight[1] * part[1];
                }
            }
        }
        if let Some(Steady { omega, cosine, sine }) = &self.harmonic {
            let (cosine, sine) = (dot(row, cosine), dot(row, sine));
            weights.push([cosine, sine, omega * sine, -omega * cosine]);
        }
        let load = |load: &Load, [p1, p2]: [f64; 2]| Parabola { p0: dot(row, &load.rest), p1, p2 };
        Row { weights, gravity: load(&self.modes.gravity, drift[0]), force: load(&self.force, drift[1]) }
    }

    /// Block coordinates of (p, p′) at the start of a segment; `force` is the constant force in force, `drive` the phase
    /// of the harmonic one: F cos ω t and F sin ω t, which are the coordinates of its block. `work` is room to work in.
    #[inline(always)]
    pub(crate) fn enter(
        &self,
        p: &[f64],
        rate: &[f64],
        force: f64,
        drive: DrivePhase,
        work: &mut Vec<f64>,
        c: &mut [f64],
    ) {
        let size = self.modes.spectral.width();
        let work = room(work, 2 * self.order);
        self.free([p, rate], force, drive, work);
        self.modes.to_blocks.sum_by_registers(work, c);
        if self.harmonic.is_some() {
            c[size..size + 2].copy_from_slice(&[drive.cosine, drive.sine]);
            if self.is_resonant {
                self.enter_drive(drive, c);
            }
        }
    }

    /// What of (p, p′) is free motion, beside the answers to the loads.
    #[inline(always)]
    fn free(&self, [p, rate]: [&[f64]; 2], force: f64, drive: DrivePhase, free: &mut [f64]) {
        let (positions, velocities) = free.split_at_mut(self.order);
        let (by_gravity, by_force) = (&self.modes.gravity, &self.force);
        let rests = by_gravity.rest.iter().zip(&by_force.rest);
        for ((free, p), (by_gravity, by_force)) in positions.iter_mut().zip(p).zip(rests) {
            *free = p - by_gravity - force * by_force;
        }
        velocities.copy_from_slice(&rate[..self.order]);
        if let Some(steady) = &self.harmonic {
            for (i, (position, velocity)) in positions.iter_mut().zip(&mut *velocities).enumerate() {
                let [place, rate] = steady.at(i, drive);
                (*position, *velocity) = (*position - place, *velocity - rate);
            }
        }
        if self.drifts {
            let rates = by_gravity.rest_rate.iter().zip(&by_force.rest_rate);
            for (velocity, (by_gravity, by_force)) in velocities.iter_mut().zip(rates) {
                *velocity -= by_gravity + force * by_force;
            }
        }
    }

    /// Takes off the block coordinates of (p, p′) what rounding has put in: c + V⁻¹(s − V c). V(V⁻¹ s) is off from s by the same
    /// share at each entry, and over 10⁵ of them that adds up. `work` holds s, as [`Self::enter`] leaves it, and what is missing
    /// afterwards.
    #[cold]
    pub(crate) fn correct(&self, work: &mut [f64], c: &mut [f64]) {
        let size = self.modes.spectral.width();
        let c = &mut c[..size];
        let missing = &mut work[..2 * self.order];
        for (missing, row) in missing.iter_mut().zip(self.modes.spectral.from_blocks.chunks_exact(size)) {
            *missing = exact::rest(*missing, row, c);
        }
        for (missing, entries) in missing.iter().zip(self.modes.spectral.to_blocks.chunks_exact(size)) {
            c.iter_mut().zip(entries).for_each(|(c, entry)| *c += entry * missing);
        }
    }

    /// What the phase of the drive is to the blocks that are in resonance with it.
    #[cold]
    fn enter_drive(&self, drive: DrivePhase, c: &mut [f64]) {
        let size = self.modes.spectral.width();
        let rows = self.modes.spectral.to_blocks[2 * self.order * size..].chunks_exact(size);
        for (row, phase) in rows.zip([drive.cosine, drive.sine]) {
            c.iter_mut().zip(row).for_each(|(c, entry)| *c += entry * phase);
        }
    }

    /// (p, p′) from block coordinates after `t` seconds of the segment, with the drive's phase then; `work` is room to work in.
    #[inline(always)]
    pub(crate) fn leave(
        &self,
        c: &[f64],
        t: f64,
        force: f64,
        drive: DrivePhase,
        work: &mut Vec<f64>,
        [p, rate]: [&mut [f64]; 2],
    ) {
        let (order, width) = (self.order, self.modes.spectral.width());
        let (p, rate) = (&mut p[..order], &mut rate[..order]);
        let work = room(work, 2 * order);
        // There may be more blocks than coordinates; those that `c` has none for are at rest.
        self.modes.columns.sum_by_registers(c, work);
        let (positions, rates) = work.split_at(order);
        let rests = self.modes.gravity.rest.iter().zip(&self.force.rest);
        let moving = positions.iter().zip(rates).zip(rests);
        for ((p, rate), ((position, velocity), (by_gravity, by_force))) in p.iter_mut().zip(rate.iter_mut()).zip(moving)
        {
            *p = (by_gravity + force * by_force) + position;
            *rate = *velocity;
        }
        if let Some(steady) = &self.harmonic {
            for i in 0..order {
                let [place, velocity] = steady.at(i, drive);
                p[i] += place;
                rate[i] += velocity;
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

    /// Propagates block coordinates, filled up to [`Flow::width`], by the kernels of a time, with the drive's phase after it.
    #[inline(always)]
    pub(crate) fn advance_all(&self, kernels: &[Kernels], start: &[f64], drive: DrivePhase, end: &mut [f64]) {
        let states = start.as_chunks().0.iter().zip(end.as_chunks_mut().0);
        for ((propagator, kernels), (from, to)) in self.propagators.iter().zip(kernels).zip(states) {
            *to = propagator.advance(kernels, from);
        }
        if self.harmonic.is_some() {
            end[2 * self.own..2 * self.own + 2].copy_from_slice(&[drive.cosine, drive.sine]);
        }
    }

    /// The matrix that a time moves the coordinates of each block of its own by, row by row.
    pub(crate) fn matrices_after(&self, time: f64) -> impl Iterator<Item = [f64; 4]> {
        let unit = |place| std::array::from_fn(|i| if i % 2 == place { 1.0 } else { 0.0 });
        let matrices = move |(propagator, kernels): (&Propagator, Kernels)| {
            let [x, y] = [0, 1].map(|place| propagator.advance(&kernels, &unit(place)));
            std::array::from_fn::<_, WIDTH, _>(|k| [x[2 * k], y[2 * k], x[2 * k + 1], y[2 * k + 1]])
        };
        self.propagators.iter().zip(self.kernels(time)).flat_map(matrices).take(self.own)
    }

    /// So short a time that radius·t of every block, and so of the fastest, is below `turn`.
    #[inline]
    pub(crate) fn turns_below(&self, turn: f64, time: f64) -> bool {
        self.series.fastest.first().copied().unwrap_or_default() * time < turn
    }

    /// So short a time that its slowest block has hardly turned.
    #[inline]
    pub(crate) fn is_brief(&self, time: f64) -> bool {
        self.turned_by_the_slowest(time) < crate::flow::integral::BRIEF
    }

    /// radius·t of its slowest block.
    #[inline]
    pub(crate) fn turned_by_the_slowest(&self, time: f64) -> f64 {
        self.slowest * time
    }

    /// Kernels of a time.
    pub(crate) fn kernels(&self, time: f64) -> Vec<Kernels> {
        let mut kernels = vec![Kernels::NONE; self.bank.blocks.len()];
        self.bank.kernels(&self.blocks, time, &mut kernels);
        kernels
    }

    /// The harmonic drive's phase `t` seconds later.
    pub(crate) fn drive_after(&self, drive: DrivePhase, t: f64) -> DrivePhase {
        let Some(steady) = &self.harmonic else { return drive };
        let (sine, cosine) = sin_cos(steady.omega * t);
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
        self.dissipation.get_or_init(|| Dissipation::new(system, &self.modes, self.is_free()))
    }

    /// (p, p′) as the loads alone have them: nothing moves freely.
    pub(crate) fn at_rest(&self, force: f64, drive: DrivePhase) -> [Vec<f64>; 2] {
        self.left(&vec![0.0; 2 * self.order], 0.0, force, drive)
    }

    /// (p, p′) as [`Flow::leave`] has them, without a place to put them.
    pub(crate) fn left(&self, c: &[f64], t: f64, force: f64, drive: DrivePhase) -> [Vec<f64>; 2] {
        let mut left = Coordinates::default();
        self.leave_to(c, t, force, drive, &mut left);
        [left.p, left.rate]
    }

    widened! {
        /// The same in a place that is used again.
        pub(crate) fn leave_to | leave_to_wide (&self, c: &[f64], t: f64, force: f64, drive: DrivePhase, to: &mut Coordinates) = leave_to_by_registers
    }

    #[inline(always)]
    fn leave_to_by_registers(&self, c: &[f64], t: f64, force: f64, drive: DrivePhase, to: &mut Coordinates) {
        let Coordinates { p, rate, work } = to;
        p.resize(self.order, 0.0);
        rate.resize(self.order, 0.0);
        self.leave(c, t, force, drive, work, [p, rate]);
    }
}

/// (p, p′), and room to work in.
#[derive(Debug, Default)]
pub(crate) struct Coordinates {
    pub(crate) p: Vec<f64>,
    pub(crate) rate: Vec<f64>,
    work: Vec<f64>,
}

/// Static equilibrium, every particle on its floor or, where its weight alone presses it there, on the floor's stop.
pub(crate) struct Rest {
    pub(crate) contacts: Vec<Contact>,
    pub(crate) q: Vec<f64>,
    /// Where the particles are relative to their floors, m.
    pub(crate) gaps: Vec<f64>,
}

impl Rest {
    /// Of a system whose contact states have these flows.
    pub(crate) fn of(
        system: &HybridSystem,
        mut flow: impl FnMut(&[Contact]) -> Result<Rc<Flow>, EngineError>,
    ) -> Result<Self, EngineError> {
        let count = system.particles.len();
        let (mut contacts, mut gaps) = (vec![Contact::Floor; count], vec![0.0; count]);
        loop {
            let flow = flow(&contacts)?;
            let [mut q, _] = flow.at_rest(0.0, DrivePhase::default());
            let compressions = q.split_off(system.mass.order);
            let mut fits = true;
            for (&j, gap) in flow.modes.attached.iter().zip(compressions) {
                gaps[j] = gap;
                if let Some(stop) = system.particles[j].floor.law.stop()
                    && gap < -stop.length
                {
                    (gaps[j], contacts[j], fits) = (-stop.length, Contact::FloorStop, false);
                }
            }
            if fits {
                return Ok(Self { contacts, q, gaps });
            }
        }
    }
}

/// The modes and the steady answer of a contact state under a harmonic force of this ω, by which p″ = `push` sin ωt.
fn answered(
    system: &HybridSystem,
    modes: Rc<Modes>,
    push: &[f64],
    omega: f64,
) -> Result<(Rc<Modes>, Steady), EngineError> {
    let steady = |largest: f64| Steady::new(omega, push, modes.accelerations(system), largest);
    if let Some(steady) = steady(load::RESONANCE) {
        return Ok((modes, steady));
    }
    if let Some((modes, steady)) = modes.resonant(system, push, omega) {
        return Ok((Rc::new(modes), steady));
    }
    let steady = steady(load::LARGEST).ok_or(EngineError::UndampedResonance { omega })?;
    Ok((modes, steady))
}
