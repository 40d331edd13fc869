//! The range of an observed motion over many cycles: largest and smallest displacement and velocity.
//!
//! Every cycle is the same flow from another state, so value, rate and acceleration at the nodes of a grid are rows over that
//! state, set up once. Between nodes a cubic tells how high a crest may be; only one that may be the highest so far is
//! closed in on, by Newton on the exact flow.

use super::cycle::{Cycle, Segment, drive_at};
use super::signal::Row;
use crate::dynamics::Extremes;
use crate::dynamics::block::{Block, Phase};
use crate::dynamics::budget;
use crate::dynamics::flow::Flow;
use crate::dynamics::system::HybridSystem;

/// Nodes a radian of whatever oscillates: the cubic between two of them is then off by less than [`DOUBT`].
const NODES_A_RADIAN: f64 = 2.5;
/// Crests that are lower by more than this share of the range are not the highest.
const DOUBT: f64 = 1e-3;
/// Most nodes of a segment by its oscillations.
const MOST_NODES: f64 = 4000.0;
/// A state that changes by less than this share in a cycle is steady.
const STEADY: f64 = 1e-16;

/// Displacement, velocity, acceleration and its rate.
type Motion = [f64; 4];

/// Grid of a segment.
struct Grid {
    nodes: Vec<Node>,
    /// Share of the harmonic force at the segment's beginning.
    drive: Option<Phase>,
    /// Beside the shares, m.
    rest: f64,
}

/// An instant of a segment.
struct Node {
    time: f64,
    /// Displacement, velocity and acceleration by the block coordinates at the segment's beginning.
    rows: [Vec<f64>; 3],
    /// What they are beside those.
    constant: [f64; 3],
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
    let mut state = start.to_vec();
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
                grid.take(flow, row, &from, range);
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
        let nodes = times(flow, segment.length)
            .into_iter()
            .map(|time| {
                let mut rows = [Vec::new(), Vec::new(), Vec::new()];
                for (block, [a, b, c, d]) in flow.blocks.iter().zip(&row.weights) {
                    let kernel = block.kernel(time);
                    for phase in [Phase { value: *a, rate: *c }, Phase { value: *b, rate: *d }] {
                        let now = block.advance(phase, kernel);
                        let parts = [now.value, now.rate, block.acceleration(now).value];
                        rows.iter_mut().zip(parts).for_each(|(row, part)| row.push(part));
                    }
                }
                let (driven, _) = row.outside(flow, segment.level, drive_at(system, segment.begin + time));
                let mut constant = [rest, 0.0, 0.0];
                if let (Some(phase), Some(block)) = (driven, flow.blocks.last()) {
                    let parts = [phase.value, phase.rate, block.acceleration(phase).value];
                    constant.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
                }
                Node { time, rows, constant }
            })
            .collect();
        Self { nodes, drive, rest }
    }

    fn take(&self, flow: &Flow, row: &Row, c: &[f64], range: &mut Extremes) {
        let shares = std::cell::OnceCell::new();
        let mut before: Option<(f64, [f64; 3])> = None;
        for node in &self.nodes {
            let mut now = node.constant;
            for (sum, weights) in now.iter_mut().zip(&node.rows) {
                *sum += weights.iter().zip(c).fold(0.0, |sum, (weight, c)| sum + weight * c);
            }
            range.take(now[0], now[1]);
            if let Some((time, last)) = before {
                for order in [0, 1] {
                    let known = if order == 0 { range.displacement } else { range.velocity };
                    let [low, high] = [(time, last), (node.time, now)];
                    if last[order + 1] * now[order + 1] < 0.0 && may_exceed(order, low, high, known) {
                        let shares: &Vec<Phase> =
                            shares.get_or_init(|| row.shares(c).into_iter().chain(self.drive).collect());
                        let turn = turning_point(&flow.blocks, shares, self.rest, order, low, high);
                        range.take(turn[0], turn[1]);
                    }
                }
            }
            before = Some((node.time, now));
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

/// Whether the crest between two nodes may exceed what is known, by the cubic through values and slopes.
fn may_exceed(order: usize, low: (f64, [f64; 3]), high: (f64, [f64; 3]), known: [f64; 2]) -> bool {
    let h = high.0 - low.0;
    let ([v0, s0], [v1, s1]) = ([low.1[order], h * low.1[order + 1]], [high.1[order], h * high.1[order + 1]]);
    // The slope of the cubic, a parabola in s from 0 to 1; its root within.
    let (a, b, c) = (3.0 * (s0 + s1) + 6.0 * (v0 - v1), -4.0 * s0 - 2.0 * s1 - 6.0 * (v0 - v1), s0);
    let discriminant = (b * b - 4.0 * a * c).max(0.0).sqrt();
    let q = -0.5 * (b + if b < 0.0 { -discriminant } else { discriminant });
    let within = |s: f64| (0.0..=1.0).contains(&s);
    let s = if within(c / q) { c / q } else { q / a };
    if !within(s) {
        return true;
    }
    let crest = v0 + s * (c + s * (0.5 * b + s * a / 3.0));
    let doubt = DOUBT * (known[1] - known[0]) + 0.1 * (crest - v0).abs().min((crest - v1).abs());
    !(crest < known[1] - doubt && crest > known[0] + doubt)
}

/// The motion where the derivative of `order` vanishes between two nodes at which its signs differ: Newton, kept within by
/// bisection.
fn turning_point(
    blocks: &[Block],
    shares: &[Phase],
    rest: f64,
    order: usize,
    low: (f64, [f64; 3]),
    high: (f64, [f64; 3]),
) -> Motion {
    let at = |t: f64| -> Motion {
        let mut motion = [rest, 0.0, 0.0, 0.0];
        for (block, share) in blocks.iter().zip(shares) {
            let now = block.advance(*share, block.kernel(t));
            let bend = block.acceleration(now);
            let parts = [now.value, now.rate, bend.value, bend.rate];
            motion.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
        }
        motion
    };
    let sign = low.1[order + 1];
    // From the straight line between the slopes at both ends.
    let share = sign / (sign - high.1[order + 1]);
    let (mut low, mut high) = (low.0, high.0);
    let mut t = low + share * (high - low);
    let mut motion = at(t);
    for _ in 0..60 {
        if motion[order + 1] * sign > 0.0 {
            low = t
        } else {
            high = t
        }
        let newton = t - motion[order + 1] / motion[order + 2];
        let next = if newton > low && newton < high { newton } else { f64::midpoint(low, high) };
        // The value is quadratic in the instant's error.
        let settled = (next - t).abs() <= 1e-9 * t.abs();
        t = next;
        motion = at(t);
        if settled {
            break;
        }
    }
    motion
}
