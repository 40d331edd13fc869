//! Signals: what is watched or measured of a flow, as rows over its blocks.
//!
//! A row r·p of the coordinates is a share of every block, and so are its second derivative and the force of a spring and a
//! dashpot along it. What a contact state needs is known when its flow is built, so that a segment evaluates just that.

use std::cell::RefCell;

use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::wide::widened;
use crate::contact_state::bank::{Bank, Blocks, Phases, apart};
use crate::contact_state::block::{Block, Kernel, Phase};
use crate::contact_state::{Modes, way_across};
use crate::flow::parabola::Parabola;
use crate::system::{Contact, Face, HybridSystem, Law, Particle};

/// One signal: two weights of each block's coordinates for its value, two for its rate; then what constant loads add.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub(crate) weights: Vec<[f64; 4]>,
    /// Under gravity.
    pub(crate) gravity: Parabola,
    /// Under a unit force at the forcing point.
    pub(crate) force: Parabola,
}

/// Rows that a particle's guards look at.
///
/// | contact | first | second |
/// |---|---|---|
/// | flight | floor, as far as it does not drift | ceiling, the same |
/// | pressed | compression | its force, if the face cannot pull |
/// | held | acceleration of the face | |
/// | released | the face, as far as it does not drift | its force |
///
/// Faces that do not move as one are watched both.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GuardRows {
    pub(crate) first: usize,
    pub(crate) second: usize,
    /// Row of the particle's own coordinate w while it presses into a face.
    pub(crate) compression: Option<usize>,
    /// How much further away the face across is, where it moves by itself and the particle is at the other one; of a released
    /// particle that face itself, as far as it does not drift. And the force of its spring and dashpot, where it touches.
    pub(crate) across: Option<AcrossRows>,
}

/// Rows of the face across.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AcrossRows {
    pub(crate) way: usize,
    pub(crate) force: usize,
}

/// The rows of a flow. Those in front are watched: evaluated in every segment.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    rows: Vec<Row>,
    watched: usize,
    /// Weights of the watched rows, several blocks together.
    weights: Vec<[Four; 4]>,
    /// Bounds of the second derivatives of their shares, by |x| + |y|; worked out where many guards ask for them.
    bends: RefCell<Vec<Four>>,
    /// Observed displacements.
    pub(crate) observed: Vec<usize>,
    /// The base, watched where half cycles follow its acceleration.
    pub(crate) base: usize,
    /// That acceleration.
    pub(crate) bend: Option<usize>,
    /// How it depends on each coordinate, in absolute values: coordinates that weights have deflected carry rounding even at rest.
    pub(crate) bend_of_places: Vec<f64>,
    pub(crate) guards: Vec<GuardRows>,
}

/// Watched rows at the start of a segment.
#[derive(Debug, Clone, Default)]
pub(crate) struct Signals {
    blocks: usize,
    registers: usize,
    phases: Vec<Phases>,
    totals: Vec<Total>,
    /// Coordinates of several blocks.
    coordinates: Vec<[Four; 2]>,
}

/// Of a watched row at the start of a segment.
#[derive(Debug, Clone, Copy, Default)]
struct Total {
    /// Of its shares, and of the moduli of their values.
    sum: Phase,
    size: f64,
    rest: Parabola,
}

/// A watched row at the start of a segment: its shares in the blocks, their sum, and the parabola that constant loads add.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Watched<'a> {
    blocks: usize,
    pub(crate) phases: &'a [Phases],
    pub(crate) sum: Phase,
    /// Of the moduli of their values.
    pub(crate) size: f64,
    pub(crate) rest: Parabola,
}

impl Row {
    /// Without the blocks that drift: a frame that moves with them sees the rest.
    fn fixed(&self, blocks: &[Block]) -> Self {
        let weights = blocks.iter().zip(&self.weights);
        Self {
            weights: weights.map(|(block, row)| if block.is_drift() { [0.0; 4] } else { *row }).collect(),
            gravity: self.gravity,
            force: self.force,
        }
    }

    /// Its second derivative.
    fn acceleration(&self, blocks: &[Block]) -> Self {
        let weights = blocks.iter().zip(&self.weights).map(|(block, &[v0, v1, r0, r1])| {
            let of = |value, rate| block.acceleration(Phase { value, rate });
            let (x, y) = (of(v0, r0), of(v1, r1));
            [x.value, y.value, x.rate, y.rate]
        });
        let bend = |load: Parabola| Parabola { p0: 2.0 * load.p2, p1: 0.0, p2: 0.0 };
        Self { weights: weights.collect(), gravity: bend(self.gravity), force: bend(self.force) }
    }

    /// k times it, plus c times its rate.
    fn mixed(&self, blocks: &[Block], stiffness: f64, damping: f64) -> Self {
        let weights = blocks.iter().zip(&self.weights).map(|(block, &[v0, v1, r0, r1])| {
            let of = |value, rate| {
                let bend = block.acceleration(Phase { value, rate }).value;
                (stiffness * value + damping * rate, stiffness * rate + damping * bend)
            };
            let (x, y) = (of(v0, r0), of(v1, r1));
            [x.0, y.0, x.1, y.1]
        });
        let mix = |load: Parabola| load.spring_and_dashpot(stiffness, damping);
        Self { weights: weights.collect(), gravity: mix(self.gravity), force: mix(self.force) }
    }

    /// Plus `factor` times another.
    fn plus(&self, other: &Self, factor: f64) -> Self {
        let weights = self.weights.iter().zip(&other.weights);
        let sum = |one: Parabola, other: Parabola| one.plus(other.times(factor));
        Self {
            weights: weights.map(|(a, b)| [0, 1, 2, 3].map(|i| a[i] + factor * b[i])).collect(),
            gravity: sum(self.gravity, other.gravity),
            force: sum(self.force, other.force),
        }
    }

    /// The sum of all shares.
    #[inline(always)]
    pub(crate) fn shares(&self, c: &[f64]) -> Phase {
        let mut sum = Four::ZERO;
        for (weights, &[x, y]) in self.weights.iter().zip(c.as_chunks::<2>().0) {
            sum = sum + Four::new(*weights) * Four::new([x, y, x, y]);
        }
        let [v0, v1, r0, r1] = sum.array();
        Phase { value: v0 + v1, rate: r0 + r1 }
    }

    /// Its shares in the blocks that `c` holds the coordinates of.
    pub(crate) fn phases(&self, c: &[f64]) -> impl Iterator<Item = Phase> {
        let share = |(&[v0, v1, r0, r1], &[x, y]): (&[f64; 4], &[f64; 2])| Phase {
            value: v0 * x + v1 * y,
            rate: r0 * x + r1 * y,
        };
        self.weights.iter().zip(c.as_chunks().0).map(share)
    }

    /// The same, several together.
    pub(crate) fn together<'a>(&'a self, c: &'a [f64]) -> impl Iterator<Item = Phases> + Clone + 'a {
        let several = self.weights.chunks(WIDTH).zip(c.as_chunks::<{ 2 * WIDTH }>().0);
        several.map(|(weights, c)| {
            let ([v0, v1, r0, r1], [x, y]) = (together(weights), apart(c));
            Phases { value: v0 * x + v1 * y, rate: r0 * x + r1 * y }
        })
    }

    /// What constant loads add, under this force.
    #[inline(always)]
    pub(crate) fn rest(&self, force: f64) -> Parabola {
        self.gravity.plus(self.force.times(force))
    }
}

/// Rows of the face across from the one that particle j is at, which moves by itself: the way to it, and its force.
fn across(
    modes: &Modes,
    blocks: &[Block],
    j: usize,
    particle: &Particle,
    signal: &impl Fn(&[f64]) -> Row,
) -> Option<[Row; 2]> {
    let contact = modes.contacts[j];
    let way = match (contact, contact.face(particle)) {
        (Contact::Flight, _) => return None,
        (_, None) => signal(&contact.side().opposite().face(particle).row).fixed(blocks),
        (_, Some(_)) => signal(&way_across(particle, contact, modes.slot(j), modes.attached.len())),
    };
    let force = match modes.across(j) {
        Some(across) => way.mixed(blocks, across.stiffness, across.damping),
        None => way.clone(),
    };
    Some([way, force])
}

impl Rows {
    /// What a contact state needs, in the room of these; `blocks` are its own and the drive's, `signal` gives r·p of a row r, in the room of
    /// weights.
    pub(crate) fn of(
        self,
        system: &HybridSystem,
        modes: &Modes,
        blocks: &[Block],
        signal: impl Fn(&[f64], Vec<[f64; 4]>) -> Row,
    ) -> Self {
        let Self { rows: spare, mut weights, mut bends, mut guards, .. } = self;
        let spare = RefCell::new(spare);
        let signal = |row: &[f64]| {
            let room = spare.borrow_mut().pop().map_or_else(Vec::new, |row| row.weights);
            signal(row, room)
        };
        weights.clear();
        guards.clear();
        bends.get_mut().clear();
        let mut all = Self { weights, bends, guards, ..Self::default() };
        all.rows.reserve(2 + 3 * system.particles.len() + system.observed_rows.len());
        if let Some(row) = system.base_row() {
            all.base = all.place(signal(row));
            let bend = all.rows[all.base].acceleration(blocks);
            let answer = |entries: &[f64]| {
                let each = bend.weights.iter().zip(entries.as_chunks::<2>().0);
                each.fold(0.0, |sum, ([v0, v1, ..], [x, y])| sum + (v0 * x).abs() + (v1 * y).abs())
            };
            let places = modes.spectral.to_blocks.chunks_exact(modes.spectral.width()).take(modes.order);
            all.bend_of_places = places.map(answer).collect();
            all.bend = Some(all.place(bend));
        }
        let drifts = blocks.iter().any(Block::is_drift);
        let fixed = |row: Row| if drifts { row.fixed(blocks) } else { row };
        let mut unit = vec![0.0; modes.order];
        for (j, particle) in system.particles.iter().enumerate() {
            let contact = modes.contacts[j];
            let side = contact.side();
            let force = |row: &Row| match side.face(particle).law {
                Law::Resilient { stiffness, .. } => row.mixed(blocks, stiffness, modes.damping[j]),
                Law::Rigid { .. } => row.clone(),
            };
            let (first, second) = match contact {
                Contact::Flight => all.place_faces(particle, |face| fixed(signal(&face.row))),
                Contact::FloorReleased | Contact::CeilingReleased | Contact::BothReleased => {
                    let fixed = fixed(signal(&side.face(particle).row));
                    let force = force(&fixed);
                    (all.place(fixed), all.place(force))
                }
                _ => match modes.slot(j) {
                    Some(slot) => {
                        unit[system.mass.order + slot] = 1.0;
                        let own = signal(&unit);
                        unit[system.mass.order + slot] = 0.0;
                        let pulls = !matches!(side.face(particle).law, Law::Resilient { no_tension: true, .. });
                        let second = (!pulls).then(|| force(&own));
                        let first = all.place(own);
                        (first, second.map_or(first, |second| all.place(second)))
                    }
                    None => {
                        let mut bend = signal(&side.face(particle).row).acceleration(blocks);
                        // What the face across pushes, the face that holds the particle pushes back.
                        if let Some(across) = modes.across(j).filter(|across| across.presses) {
                            let pull = signal(&across.row).mixed(blocks, across.stiffness, across.damping);
                            bend = bend.plus(&pull, -side.away() / particle.mass);
                        }
                        let bend = all.place(bend);
                        (bend, bend)
                    }
                },
            };
            let across = particle.has_walls().then(|| across(modes, blocks, j, particle, &signal)).flatten();
            let across = across.map(|[way, force]| AcrossRows { way: all.place(way), force: all.place(force) });
            let compression = modes.slot(j).map(|_| first);
            all.guards.push(GuardRows { first, second, compression, across });
        }
        all.watched = all.rows.len();
        all.weights.reserve_exact(all.watched * blocks.len().div_ceil(WIDTH));
        for row in &all.rows {
            all.weights.extend(row.weights.chunks(WIDTH).map(together));
        }
        all.observed = system.observed_rows.iter().map(|row| all.place(signal(row))).collect();
        all
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        4 * self.rows.len() * self.rows.first().map_or(0, |row| row.weights.len())
            + WIDTH * (4 * self.weights.len() + self.bends.borrow().len())
    }

    /// Where a row stands.
    fn place(&mut self, row: Row) -> usize {
        self.rows.iter().position(|known| *known == row).unwrap_or_else(|| {
            self.rows.push(row);
            self.rows.len() - 1
        })
    }

    /// Where the rows of both faces stand: one row, if they move as one.
    fn place_faces(&mut self, particle: &Particle, row: impl Fn(&Face) -> Row) -> (usize, usize) {
        let floor = self.place(row(&particle.floor));
        let ceiling = particle.ceiling.as_ref().filter(|_| particle.has_walls());
        (floor, ceiling.map_or(floor, |ceiling| self.place(row(ceiling))))
    }

    /// A row, watched or not.
    pub(crate) fn row(&self, index: usize) -> &Row {
        &self.rows[index]
    }

    widened! {
        /// Evaluates the watched rows; `c` holds two coordinates a block, in whole registers, `force` is the constant force in force.
        pub(crate) fn watch | watch_wide (&self, c: &[f64], force: f64, blocks: usize, signals: &mut Signals) = watch_by_registers
    }

    #[inline(always)]
    pub(crate) fn watch_by_registers(&self, c: &[f64], force: f64, blocks: usize, signals: &mut Signals) {
        let registers = blocks.div_ceil(WIDTH);
        (signals.blocks, signals.registers) = (blocks, registers);
        signals.phases.resize(self.watched * registers, Phases::ZERO);
        signals.totals.resize(self.watched, Total::default());
        signals.coordinates.resize(registers, [Four::ZERO; 2]);
        for (to, from) in signals.coordinates.iter_mut().zip(c.as_chunks().0) {
            *to = apart(from);
        }
        let registers = registers.max(1);
        let rows = self.rows.iter().zip(self.weights.chunks_exact(registers));
        let places = signals.phases.chunks_exact_mut(registers).zip(&mut signals.totals);
        for ((row, weights), (phases, total)) in rows.zip(places) {
            // By reference: registers that are taken out of an array by value come apart.
            let (mut sum, mut sizes) = (Phases::ZERO, Four::ZERO);
            for (([v0, v1, r0, r1], [x, y]), phase) in weights.iter().zip(&signals.coordinates).zip(phases) {
                let (value, rate) = (*v0 * *x + *v1 * *y, *r0 * *x + *r1 * *y);
                *phase = Phases { value, rate };
                sum = Phases { value: sum.value + value, rate: sum.rate + rate };
                sizes = sizes + value.abs();
            }
            let sum = Phase { value: sum.value.sum(), rate: sum.rate.sum() };
            *total = Total { sum, size: sizes.sum(), rest: row.rest(force) };
        }
    }

    /// Adds bounds on the second derivatives of the watched rows, without what constant loads add; not of blocks near critical damping.
    #[inline(always)]
    pub(crate) fn bound(&self, bank: &Bank, signals: &Signals, bends: &mut Vec<f64>) {
        let mut all = self.bends.borrow_mut();
        if all.is_empty() {
            self.most_bends(bank, &mut all);
        }
        for most in all.chunks_exact(signals.registers.max(1)) {
            let mut bend = Four::ZERO;
            for (most, [x, y]) in most.iter().zip(&signals.coordinates) {
                bend = bend + *most * (x.abs() + y.abs());
            }
            bends.push(bend.sum());
        }
    }

    #[cold]
    fn most_bends(&self, bank: &Bank, bends: &mut Vec<Four>) {
        bends.reserve_exact(self.weights.len());
        for row in self.weights.chunks_exact(bank.blocks.len().max(1)) {
            bends.extend(bank.blocks.iter().zip(row).map(|(blocks, weights)| bend(blocks, weights)));
        }
    }
}

impl Signals {
    /// A watched row.
    #[inline(always)]
    pub(crate) fn of(&self, row: usize) -> Watched<'_> {
        let Total { sum, size, rest } = self.totals[row];
        let phases = &self.phases[row * self.registers..][..self.registers];
        Watched { blocks: self.blocks, phases, sum, size, rest }
    }

    /// How many are watched.
    pub(crate) fn len(&self) -> usize {
        self.totals.len()
    }
}

impl<'a> Watched<'a> {
    /// Its shares, block by block.
    #[inline]
    pub(crate) fn each(self) -> impl Iterator<Item = Phase> + 'a {
        let lanes = self.phases.iter().flat_map(|phases| (0..WIDTH).map(|lane| phases.at(lane)));
        lanes.take(self.blocks)
    }

    /// What rounding makes of the sum of its shares.
    #[inline]
    pub(crate) fn noise(self) -> f64 {
        4.0 * f64::EPSILON * self.size
    }
}

/// The largest second derivatives of shares of these weights where |x| + |y| = 1.
fn bend(blocks: &Blocks, &[v0, v1, r0, r1]: &[Four; 4]) -> Four {
    let most = |value, rate| blocks.amplitudes(Phases { value, rate });
    most(v0, r0).zip(most(v1, r1), f64::max) * blocks.square
}

/// Weights of several blocks.
fn together(weights: &[[f64; 4]]) -> [Four; 4] {
    let mut all = [[0.0; 4]; WIDTH];
    all.iter_mut().zip(weights).for_each(|(to, from)| *to = *from);
    let [a, b, c, d] = &all;
    [0, 1, 2, 3].map(|i| Four::new([a[i], b[i], c[i], d[i]]))
}

/// A signal, its rate, its acceleration and the rate of that after a time, by the kernels of its blocks.
pub(crate) fn motion(
    blocks: &[Block],
    phases: impl Iterator<Item = Phase>,
    rest: Parabola,
    kernel: impl Fn(usize) -> Kernel,
    time: f64,
) -> [f64; 4] {
    let mut motion = [rest.at(time), rest.rate(time), 2.0 * rest.p2, 0.0];
    for (k, (block, phase)) in blocks.iter().zip(phases).enumerate() {
        block.add_motion(&mut motion, block.advance(phase, kernel(k)));
    }
    motion
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_share_bends_more_than_its_bound() {
        let matrices =
            [[0.0, 1.0, -9e4, -3.0], [0.0, 1.0, -25.0, -4.0], [-5.0, 140.0, -150.0, -40.0], [0.0, 1.0, -9.0, -40.0]];
        let weights = [[1.0, 0.0, 0.0, 1.0], [0.3, -0.2, -31.5, 34.0], [0.01, 0.02, 0.34, -0.17]];
        let blocks = matrices.map(Block::new);
        let bank = Bank::default().of(&blocks);
        for (lane, block) in blocks.into_iter().enumerate() {
            for weights in weights {
                let most = bend(&bank.blocks[0], &weights.map(Four::all)).at(lane);
                for [x, y] in [[1.0, 0.0], [0.0, 1.0], [0.5, -0.5], [0.3, 0.7]] {
                    let [v0, v1, r0, r1] = weights;
                    let start = Phase { value: v0 * x + v1 * y, rate: r0 * x + r1 * y };
                    // One near critical damping has a bound of its own.
                    let near_critical = bank.near_critical.contains(&lane);
                    let own = || block.amplitude(start, 2.0, 0.0) * block.radius * block.radius;
                    let most = if near_critical { own() } else { most };
                    for i in 0..200 {
                        let now = block.advance(start, block.kernel(0.1 * f64::from(i) / block.radius));
                        assert!(block.acceleration(now).value.abs() <= most * (1.0 + 1e-12));
                    }
                }
            }
        }
    }
}
