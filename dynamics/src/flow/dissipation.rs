//! What the dashpots of a contact state take, q′·C q′ + Σ c w′², as a form zᵀQz of its block coordinates.
//!
//! Between two instants they take [zᵀPz] with BᵀP + PB = Q, block by block. Where two eigenvalues nearly cancel (next to no
//! damping) that P loses digits, and the motion itself is integrated, by Gauss-Legendre panels.

use crate::arithmetic::matrix::dot;
use crate::contact_state::Modes;
use crate::contact_state::block::{Block, form, pairs};
use crate::flow::lyapunov::{Equations, Lyapunov, NEARLY_NEUTRAL};
use crate::system::HybridSystem;

/// radius·h of a panel of the ten-point Gauss-Legendre rule: a squared signal turns twice as fast, and what the rule leaves
/// out of it is below 5²¹ (10!)⁴/(21 (20!)³) = 3e-16.
const TURN: f64 = 2.5;
/// Share of all motion below which a block is not seen.
const UNSEEN: f64 = 1e-15;

/// The form, and the rates that it is made of.
pub(crate) struct Dissipation {
    /// p′ of each unit of the block coordinates, and its largest entry.
    columns: Vec<Vec<f64>>,
    largest: Vec<f64>,
    /// Q, by [`pairs`] of blocks; those off the diagonal count for both.
    power: Vec<[f64; 4]>,
    /// P, where it keeps its digits.
    taken: Option<Vec<[f64; 4]>>,
}

impl Dissipation {
    /// `free` where nothing moves but the blocks.
    pub(crate) fn new(system: &HybridSystem, modes: &Modes, free: bool) -> Self {
        let Modes { order, spectral, .. } = modes;
        let columns: Vec<Vec<f64>> = (0..spectral.width()).map(|k| spectral.column(k).skip(*order).collect()).collect();
        let damped: Vec<Vec<f64>> = columns.iter().map(|rate| against(system, modes, rate)).collect();
        let largest = columns.iter().map(|rate| rate.iter().fold(0.0_f64, |most, x| most.max(x.abs()))).collect();
        let form = |(k, l): (usize, usize)| {
            let twice = if k == l { 1.0 } else { 2.0 };
            [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(a, b)| twice * dot(&columns[2 * k + a], &damped[2 * l + b]))
        };
        let power: Vec<[f64; 4]> = pairs(modes.spectral.blocks.len()).map(form).collect();
        let equation = |((k, l), q): ((usize, usize), &[f64; 4])| equation(modes, k, l, *q);
        let equations = || pairs(modes.spectral.blocks.len()).zip(&power).map(equation).collect::<Option<Equations>>();
        let taken = free.then(equations).flatten().map(|equations| equations.solve(&power));
        Self { columns, largest, power, taken }
    }

    /// Numbers that it keeps.
    pub(crate) fn size(&self) -> usize {
        self.columns.iter().map(Vec::len).sum::<usize>() + 8 * self.power.len()
    }

    /// What is taken between two states of free motion, if there is a closed form.
    pub(crate) fn between(&self, start: &[f64], end: &[f64]) -> Option<f64> {
        let taken = self.taken.as_ref()?;
        Some(form(taken, end) - form(taken, start))
    }

    /// The power in a state, W.
    pub(crate) fn power(&self, c: &[f64]) -> f64 {
        form(&self.power, c)
    }

    /// The same of sums over several states, Σ zₖ zₗᵀ for the pairs of blocks.
    pub(crate) fn of_moments(&self, second: &[[f64; 4]]) -> f64 {
        let each =
            |(form, moment): (&[f64; 4], &[f64; 4])| form.iter().zip(moment).fold(0.0, |sum, (a, b)| sum + a * b);
        self.power.iter().zip(second).map(each).sum()
    }

    /// Length of a quadrature panel: short against the drive, and against every block that still moves visibly; `size` is
    /// the modulus of a coordinate.
    pub(crate) fn panel(&self, system: &HybridSystem, modes: &Modes, size: impl Fn(usize) -> f64) -> f64 {
        // With what turns into it: a block at rest away from its place has no rate yet.
        let of = |k: usize| {
            let ([p, q, r, s], radius) = (modes.spectral.matrices[k], modes.spectral.blocks[k].radius);
            let (x, y) = (size(2 * k), size(2 * k + 1));
            let turned = |a: f64, b: f64| if radius > 0.0 { (a.abs() * x + b.abs() * y) / radius } else { 0.0 };
            self.largest[2 * k] * (x + turned(p, q)) + self.largest[2 * k + 1] * (y + turned(r, s))
        };
        let total: f64 = (0..modes.spectral.blocks.len()).map(of).sum();
        let driven = system.drive.harmonic.map_or(0.0, |drive| Block::harmonic(drive.angular_frequency).radius);
        let fastest = (0..modes.spectral.blocks.len())
            .filter(|&k| of(k) > UNSEEN * total)
            .fold(driven, |fastest, k| fastest.max(modes.spectral.blocks[k].radius));
        if fastest > 0.0 { TURN / fastest } else { f64::INFINITY }
    }

    /// What rates beside those of the blocks, in all of `count` states, add to such a sum; `first` is the sum of the states.
    pub(crate) fn beside(
        &self,
        system: &HybridSystem,
        modes: &Modes,
        rate: &[f64],
        first: &[[f64; 2]],
        count: f64,
    ) -> f64 {
        let damped = against(system, modes, rate);
        let each = |(column, first): (&Vec<f64>, &f64)| first * dot(column, &damped);
        count * dot(rate, &damped) + 2.0 * self.columns.iter().zip(first.as_flattened()).map(each).sum::<f64>()
    }
}

/// BₖᵀP + P Bₗ = Q.
fn equation(modes: &Modes, k: usize, l: usize, q: [f64; 4]) -> Option<Lyapunov> {
    if q == [0.0; 4] {
        return Some(Lyapunov::NOTHING);
    }
    let spectral = &modes.spectral;
    let apart = spectral.blocks[k].keeps_apart(&spectral.blocks[l], NEARLY_NEUTRAL);
    apart.then(|| Lyapunov::new(spectral.matrices[k], spectral.matrices[l])).flatten()
}

/// What the dashpots push against rates p′.
fn against(system: &HybridSystem, modes: &Modes, rate: &[f64]) -> Vec<f64> {
    let n = system.mass.order;
    let mut force = system.damping.times(&rate[..n]);
    force.extend(modes.attached.iter().zip(&rate[n..]).map(|(&j, rate)| modes.damping[j] * rate));
    for across in modes.across.iter().filter(|across| across.presses) {
        let push = across.damping * dot(&across.row, rate);
        force.iter_mut().zip(&across.row).for_each(|(force, by)| *force += push * by);
    }
    force
}
