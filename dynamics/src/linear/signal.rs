//! Signals of a flow over many cycles at once, and their integrals.

use super::cycle::{Affine, Cycle, Segment, product, sum, times};
use super::moments::{Moments, outer};
use crate::arithmetic::quadrature;
use crate::budget;
use crate::contact_state::block::{Block, Phase, pairs, transposed};
use crate::flow::Flow;
use crate::flow::gains::{Closed, Gains};
use crate::flow::signals::Row;
use crate::flow::sums::{About, Sums};
use crate::system::{DrivePhase, HybridSystem};

impl Row {
    /// Its share of the harmonic force, if there is one, and its rest under a constant force.
    pub(super) fn outside(&self, flow: &Flow, level: f64, drive: DrivePhase) -> (Option<Phase>, f64) {
        let share = self.weights.get(flow.own).map(|weights| {
            let [value, rate] = times(*weights, [drive.cosine, drive.sine]);
            Phase { value, rate }
        });
        (share, self.gravity.p0 + level * self.force.p0)
    }

    /// Mean of value and rate beside `outside` over the states of several cycles, and Σ of their squares about it.
    fn moments(&self, of: &Moments, outside: Option<Phase>) -> [[f64; 2]; 2] {
        let outside = outside.unwrap_or_default();
        let mean = self
            .weights
            .iter()
            .zip(&of.mean)
            .fold([outside.value, outside.rate], |all, (weights, mean)| sum(all, times(*weights, *mean)));
        let mut spread = [0.0; 2];
        for ((k, l), own) in pairs(of.mean.len()).zip(&of.spread) {
            // Every pair of two blocks counts in both orders.
            let twice = if k == l { 1.0 } else { 2.0 };
            let [value, .., rate] = product(product(self.weights[k], *own), transposed(self.weights[l]));
            spread = sum(spread, [twice * value, twice * rate]);
        }
        [mean, spread]
    }

    /// Root of Σ of the squares of each block's value and rate.
    fn sizes<'a>(&'a self, of: &'a Moments) -> impl Iterator<Item = [f64; 2]> + 'a {
        let own = pairs(of.mean.len()).zip(&of.spread).filter(|((k, l), _)| k == l).map(|(_, spread)| spread);
        self.weights.iter().zip(&of.mean).zip(own).map(|((weights, mean), spread)| {
            let [value, .., rate] = product(product(*weights, *spread), transposed(*weights));
            let mean = times(*weights, *mean);
            [(value, mean[0]), (rate, mean[1])].map(|(spread, mean)| (spread + of.count * mean * mean).max(0.0).sqrt())
        })
    }
}

/// The measures of each row over the cycles that `at` are the states of at the beginning.
pub(super) fn integrals(
    system: &HybridSystem,
    flow: &Flow,
    rows: &[&Row],
    cycle: &Cycle,
    at: &Moments,
    displacement: bool,
) -> Vec<Sums> {
    let mut sums = vec![Sums::default(); rows.len()];
    let mut now = at.clone();
    for segment in &cycle.segments {
        let start = now.moved(&segment.jump);
        let end = start.moved(&segment.flow);
        now = end.clone();
        if segment.length == 0.0 {
            continue;
        }
        let end_drive = DrivePhase::of(&system.drive, segment.begin + segment.length);
        let ends = [At { moments: &start, drive: segment.drive }, At { moments: &end, drive: end_drive }];
        let gained = |closed: &Closed| closed.solve(&gains(flow, ends, segment.level, segment.length));
        let integrated = flow.closed().filter(|_| !flow.is_brief(segment.length)).map(gained);
        let parts: Vec<Sums> = match integrated {
            Some(integrated) => integrated.of(rows, displacement).into_iter().map(|part| Sums::of(&[part])).collect(),
            None => rows.iter().map(|row| quadrature(flow, row, &start, segment)).collect(),
        };
        sums.iter_mut().zip(parts).for_each(|(sum, part)| sum.add(part));
    }
    sums
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
    let mean = |at: &At<'_>, k: usize| at.moments.mean.get(k).copied().unwrap_or_else(|| phase(at));
    let first = |at: &At<'_>, k: usize| mean(at, k).map(|part| count * part);
    let second = |at: &At<'_>, k: usize, l: usize, own: usize| -> [f64; 4] {
        let square = outer(first(at, k), mean(at, l));
        match at.moments.spread.get(own) {
            Some(spread) if l < flow.own => std::array::from_fn(|i| spread[i] + square[i]),
            _ => square,
        }
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

/// The same by panels that are exact to rounding, where there is no closed form that keeps its digits.
fn quadrature(flow: &Flow, row: &Row, start: &Moments, segment: &Segment) -> Sums {
    let (drive, rest) = row.outside(flow, segment.level, segment.drive);
    let count = start.count;
    let [[place, _], _] = row.moments(start, drive);
    let (mut moved, mut square, mut velocity_square) = (0.0, 0.0, 0.0);
    let mut t0 = 0.0;
    while t0 < segment.length && !budget::spend(4) {
        let h = panel(flow, row, &start.moved(&Affine::flow(flow, t0)), drive).min(segment.length - t0);
        for [x, weight] in quadrature::TEN {
            let t = t0 + x * h;
            let after = drive.map(|phase| {
                let block = &flow.blocks[flow.own];
                block.advance(phase, block.kernel(t))
            });
            let [[value, rate], [values, rates]] = row.moments(&start.moved(&Affine::flow(flow, t)), after);
            let w = weight * h;
            moved += w * count * (value - place);
            square += w * (values + count * (value - place) * (value - place));
            velocity_square += w * (rates + count * rate * rate);
        }
        t0 += h;
    }
    let duration = count * segment.length;
    Sums::of(&[About { duration, place: rest + place, moved, square, velocity_square }])
}

/// Length of a panel: short against every block that still moves the signal visibly.
fn panel(flow: &Flow, row: &Row, now: &Moments, drive: Option<Phase>) -> f64 {
    let share = |([value, rate], block): ([f64; 2], &Block)| rate + block.radius * value;
    let shares: Vec<f64> = row.sizes(now).zip(&flow.blocks).map(share).collect();
    let total: f64 = shares.iter().sum::<f64>() + drive.map_or(0.0, |phase| phase.rate.abs());
    let slowest = drive.map_or(0.0, |_| flow.blocks[flow.own].radius);
    let moving = shares.iter().zip(&flow.blocks).filter(|(share, _)| **share > 1e-15 * total);
    let fastest = moving.fold(slowest, |fastest, (_, block)| fastest.max(block.radius));
    if fastest > 0.0 { 1.5 / fastest } else { f64::INFINITY }
}
