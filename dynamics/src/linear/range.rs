//! The range of an observed motion over many cycles: largest and smallest displacement and velocity.
//!
//! Every cycle is the same flow from another state, so value, rate and acceleration at the nodes of a grid are rows over that
//! state, set up once. Between nodes a cubic tells how high a crest may be; only one that may be the highest so far is
//! closed in on, by Newton on the exact flow.

use super::cycle::{Cycle, Segment};
use crate::arithmetic::superposition::Superposition;
use crate::budget;
use crate::contact_state::block::Phase;
use crate::flow::Flow;
use crate::flow::parabola::Parabola;
use crate::flow::signals::{Row, motion};
use crate::response::crest::{self, Motion, crest};
use crate::response::extremes::Extremes;
use crate::system::{DrivePhase, HybridSystem};

/// Nodes a radian of whatever oscillates: the cubic between two of them is then close enough to judge a crest ([`crest`]).
const NODES_A_RADIAN: f64 = 2.5;
/// Most nodes of a segment by its oscillations.
const MOST_NODES: f64 = 4000.0;
/// A state that changes by less than this share in a cycle is steady.
const STEADY: f64 = 1e-16;

/// Grid of a segment.
struct Grid {
    /// Its instants.
    times: Vec<f64>,
    /// The motion at all of them, one after the other, by each block coordinate at the segment's beginning.
    free: Superposition,
    /// What it is beside that.
    constant: Vec<Motion>,
    /// Share of the harmonic force at the segment's beginning.
    drive: Option<Phase>,
    /// Beside the shares, m.
    rest: Parabola,
}

/// Takes `cycles` cycles, the first of them from the state `start`, into the range.
pub(super) fn take(
    system: &HybridSystem,
    flow: &Flow,
    row: &Row,
    cycle: &Cycle,
    start: &[f64],
    cycles: u64,
    range: &mut Extremes,
) {
    let grids: Vec<Grid> =
        cycle.segments.iter().filter(|segment| segment.length > 0.0).map(|s| Grid::new(system, flow, row, s)).collect();
    let (mut state, mut motions) = (start.to_vec(), Vec::new());
    for _ in 0..cycles {
        if budget::spend(1) {
            return;
        }
        let begin = state.clone();
        let mut next_grid = grids.iter();
        for segment in &cycle.segments {
            let from = segment.jump.apply(&state);
            if segment.length > 0.0
                && let Some(grid) = next_grid.next()
            {
                grid.take(flow, row, &from, &mut motions, range);
            }
            state = segment.flow.apply(&from);
        }
        let size = state.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        if state.iter().zip(&begin).all(|(now, before)| (now - before).abs() <= STEADY * size) {
            return;
        }
    }
}

impl Grid {
    fn new(system: &HybridSystem, flow: &Flow, row: &Row, segment: &Segment) -> Self {
        let (drive, rest) = row.outside(flow, segment.level, segment.drive);
        let times = times(flow, segment.length);
        let mut entries = vec![Motion::default(); 2 * flow.own * times.len()];
        let mut constant = Vec::with_capacity(times.len());
        for (node, &time) in times.iter().enumerate() {
            let mut columns = entries.iter_mut().skip(node).step_by(times.len());
            for (block, [a, b, c, d]) in flow.blocks[..flow.own].iter().zip(&row.weights) {
                let kernel = block.kernel(time);
                let phases = [Phase { value: *a, rate: *c }, Phase { value: *b, rate: *d }];
                for (phase, motion) in phases.into_iter().zip(&mut columns) {
                    block.add_motion(motion, block.advance(phase, kernel));
                }
            }
            let (driven, _) = row.outside(flow, segment.level, DrivePhase::of(&system.drive, segment.begin + time));
            let mut motion = [rest, 0.0, 0.0, 0.0];
            if let (Some(phase), Some(block)) = (driven, flow.blocks.last()) {
                block.add_motion(&mut motion, phase);
            }
            constant.push(motion);
        }
        let free = Superposition::default().of_rows(constant.as_flattened().len(), entries.as_flattened());
        Self { times, free, constant, drive, rest: Parabola { p0: rest, ..Parabola::default() } }
    }

    /// Takes the segment that begins with these block coordinates into the range; `motions` is room to work in.
    fn take(&self, flow: &Flow, row: &Row, c: &[f64], motions: &mut Vec<Motion>, range: &mut Extremes) {
        let shares = std::cell::OnceCell::new();
        let shares = || -> &Vec<Phase> { shares.get_or_init(|| row.phases(c).chain(self.drive).collect()) };
        let mut before: Option<crest::Node> = None;
        motions.resize(self.times.len(), Motion::default());
        self.free.sum(c, motions.as_flattened_mut());
        for ((&time, constant), free) in self.times.iter().zip(&self.constant).zip(&*motions) {
            let now = crest::Node { time, motion: std::array::from_fn(|order| constant[order] + free[order]) };
            range.take(now.motion[0], now.motion[1]);
            if let Some(last) = before {
                for order in [0, 1] {
                    let at = |t: f64| motion(&flow.blocks, shares(), self.rest, |k| flow.blocks[k].kernel(t), t);
                    if let Some(turn) = crest(order, last, now, || range.of(order), at) {
                        range.take(turn[0], turn[1]);
                    }
                }
            }
            before = Some(now);
        }
    }
}

/// The nodes: even where something oscillates, and each half as far from the beginning as the next one where it decays.
fn times(flow: &Flow, length: f64) -> Vec<f64> {
    let (mut turning, mut fastest) = (0.0_f64, 0.0_f64);
    for block in &flow.blocks {
        fastest = fastest.max(block.radius);
        // What decays within a radian is found by the halvings.
        if block.oscillates() && block.decay < 0.5 * block.radius {
            turning = turning.max(block.radius);
        }
    }
    let even = (NODES_A_RADIAN * turning * length).ceil().clamp(8.0, MOST_NODES);
    let mut times: Vec<f64> = (0..=even as u64).map(|i| length * (i as f64 / even)).collect();
    // This ends, as a flow whose rates are not finite is refused.
    let mut early = 0.7 * length / even;
    while early * fastest > 0.1 {
        times.push(early);
        early *= 0.7;
    }
    times.sort_by(f64::total_cmp);
    times
}
