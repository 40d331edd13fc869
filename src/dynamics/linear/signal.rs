//! Signals of a flow as rows over its block coordinates, and their integrals over many cycles at once.

use super::cycle::{Affine, Cycle, drive_at, product, times};
use super::moments::{Moments, outer};
use crate::dynamics::block::{Phase, pairs, transposed};
use crate::dynamics::budget;
use crate::dynamics::flow::{DrivePhase, Flow};
use crate::dynamics::gains::{Closed, Gains};
use crate::dynamics::integral::{GAUSS, Integrals};
use crate::dynamics::system::HybridSystem;

/// A row of the flow: value and rate of each block's share by its two coordinates.
pub(super) struct Row {
    /// Which row of the flow.
    pub(super) index: usize,
    /// [[value by x, by y], [rate by x, by y]].
    pub(super) weights: Vec<[f64; 4]>,
}

impl Row {
    pub(super) fn new(flow: &Flow, index: usize) -> Self {
        Self { index, weights: flow.rows.row(index).weights[..flow.own].to_vec() }
    }

    /// Its share of the harmonic force, if there is one, and its rest under a constant force.
    pub(super) fn outside(&self, flow: &Flow, level: f64, drive: DrivePhase) -> (Option<Phase>, f64) {
        let row = flow.rows.row(self.index);
        let share = row.weights.get(flow.own).map(|weights| {
            let [value, rate] = times(*weights, [drive.cosine, drive.sine]);
            Phase { value, rate }
        });
        (share, row.gravity.p0 + level * row.force.p0)
    }

    /// Shares of its own blocks in a state.
    pub(super) fn shares(&self, c: &[f64]) -> Vec<Phase> {
        let share = |(weights, pair): (&[f64; 4], &[f64])| {
            let [value, rate] = times(*weights, [pair[0], pair[1]]);
            Phase { value, rate }
        };
        self.weights.iter().zip(c.chunks_exact(2)).map(share).collect()
    }

    /// The moments of its shares; the harmonic force's own are the same in every cycle.
    fn moments(&self, of: &Moments, drive: Option<Phase>) -> PhaseMoments {
        let mut first: Vec<[f64; 2]> = self.weights.iter().zip(&of.first).map(|(w, sum)| times(*w, *sum)).collect();
        let own = first.len();
        let drive = drive.map(|phase| [phase.value, phase.rate]);
        let mut second = Vec::with_capacity((own + 1) * (own + 2) / 2);
        let mut sums = pairs(own).zip(&of.second);
        for k in 0..own {
            for ((_, l), sum) in sums.by_ref().take(own - k) {
                second.push(product(product(self.weights[k], *sum), transposed(self.weights[l])));
            }
            second.extend(drive.map(|drive| outer(first[k], drive)));
        }
        if let Some(drive) = drive {
            second.push(outer(drive, drive).map(|part| of.count * part));
            first.push(drive.map(|part| of.count * part));
        }
        PhaseMoments { first, second }
    }
}

/// The integrals of each row over the cycles that `at` are the states of at the beginning; s, and the sums of each row.
pub(super) fn integrals(
    system: &HybridSystem,
    flow: &Flow,
    rows: &[Row],
    cycle: &Cycle,
    at: &Moments,
    displacement: bool,
) -> (f64, Vec<Integrals>) {
    let mut sums = vec![Integrals::default(); rows.len()];
    let mut duration = 0.0;
    let mut now = at.clone();
    for segment in &cycle.segments {
        let start = now.moved(&segment.jump);
        let end = start.moved(&segment.flow);
        duration += at.count * segment.length;
        let end_drive = drive_at(system, segment.begin + segment.length);
        let ends = [At { moments: &start, drive: segment.drive }, At { moments: &end, drive: end_drive }];
        let gained = |closed: &Closed| closed.solve(&gains(flow, ends, segment.level, segment.length));
        let integrated = flow.closed.as_ref().map(gained);
        for (row, sum) in rows.iter().zip(&mut sums) {
            let part = match &integrated {
                Some(integrated) => integrated.of(flow.rows.row(row.index), displacement),
                None => {
                    let (drive, rest) = row.outside(flow, segment.level, segment.drive);
                    quadrature(flow, row, &start, drive, segment.length).offset(rest, at.count * segment.length)
                }
            };
            sum.value += part.value;
            sum.square += part.square;
            sum.rate_square += part.rate_square;
        }
        now = end;
    }
    (duration, sums)
}

/// An instant of every cycle.
#[derive(Clone, Copy)]
struct At<'a> {
    moments: &'a Moments,
    drive: DrivePhase,
}

/// What the blocks gain between two instants; the harmonic force is the same in every cycle.
fn gains(flow: &Flow, [start, end]: [At<'_>; 2], level: f64, length: f64) -> Gains {
    let blocks = flow.blocks.len();
    let (mut gains, count) = (Gains::none(blocks), start.moments.count);
    let phase = |at: &At<'_>| [at.drive.cosine, at.drive.sine];
    let first = |at: &At<'_>, k: usize| match at.moments.first.get(k) {
        Some(own) => *own,
        None => phase(at).map(|part| count * part),
    };
    let second = |at: &At<'_>, k: usize, l: usize, own: usize| match at.moments.second.get(own) {
        Some(moment) if l < flow.own => *moment,
        _ => outer(first(at, k), phase(at)),
    };
    for (k, gain) in gains.first.iter_mut().enumerate() {
        *gain = difference(first(&start, k), first(&end, k));
    }
    let mut own = 0;
    for ((k, l), gain) in pairs(blocks).zip(&mut gains.second) {
        *gain = difference(second(&start, k, l, own), second(&end, k, l, own));
        own += usize::from(l < flow.own);
    }
    gains.forced = gains.first.iter().map(|gain| gain.map(|part| level * part)).collect();
    let [cosine, sine] = phase(&start);
    gains.swing = count * (cosine * cosine + sine * sine) * length;
    gains.add_time(level, count * length);
    gains
}

fn difference<const N: usize>(start: [f64; N], end: [f64; N]) -> [f64; N] {
    std::array::from_fn(|i| end[i] - start[i])
}

/// Σ z and Σ zₖ zₗᵀ of a signal's phases over several runs of equal length.
struct PhaseMoments {
    /// Blocks in order: value, rate.
    first: Vec<[f64; 2]>,
    /// By [`pairs`] of blocks.
    second: Vec<[f64; 4]>,
}

/// The same by panels that are exact to rounding, where undamped blocks leave no closed form.
fn quadrature(flow: &Flow, row: &Row, start: &Moments, drive: Option<Phase>, length: f64) -> Integrals {
    let mut sum = Integrals::default();
    let mut t0 = 0.0;
    while t0 < length && !budget::spend(4) {
        let now = row.moments(&start.moved(&Affine::flow(flow, t0)), None);
        let h = panel(flow, &now, drive).min(length - t0);
        for [x, weight] in GAUSS {
            let t = t0 + x * h;
            let after = drive.map(|phase| {
                let block = &flow.blocks[flow.own];
                block.advance(phase, block.kernel(t))
            });
            let m = row.moments(&start.moved(&Affine::flow(flow, t)), after);
            let w = weight * h;
            sum.value += w * m.first.iter().fold(0.0, |sum, first| sum + first[0]);
            // Every pair of two blocks counts in both orders.
            for ((k, l), moment) in pairs(m.first.len()).zip(&m.second) {
                let times = if k == l { w } else { 2.0 * w };
                sum.square += times * moment[0];
                sum.rate_square += times * moment[3];
            }
        }
        t0 += h;
    }
    sum
}

/// Length of a panel: short against every block that still moves the signal visibly.
fn panel(flow: &Flow, now: &PhaseMoments, drive: Option<Phase>) -> f64 {
    let own = now.first.len();
    let mut shares = vec![0.0; own];
    for ((k, l), moment) in pairs(own).zip(&now.second) {
        if k == l {
            shares[k] = moment[3].max(0.0).sqrt() + flow.blocks[k].radius * moment[0].max(0.0).sqrt();
        }
    }
    let total: f64 = shares.iter().sum::<f64>() + drive.map_or(0.0, |phase| phase.rate.abs());
    let slowest = drive.map_or(0.0, |_| flow.blocks[flow.own].radius);
    let fastest =
        (0..own).filter(|&k| shares[k] > 1e-15 * total).fold(slowest, |fastest, k| fastest.max(flow.blocks[k].radius));
    if fastest > 0.0 { 1.5 / fastest } else { f64::INFINITY }
}
