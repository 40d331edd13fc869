//! The motion of a contact state in twice the digits, for runs without loss.
//!
//! 10⁵ cycles round the state some 10⁶ times. Roundings to the nearest number are chance: what they do to the energy grows with the root
//! of their number. Errors that have the same sign each time grow with the number itself: V⁻¹ V is not 1 to the last digit, nor is
//! c² + s² in a turn. So block coordinates are two numbers each, V⁻¹ is corrected by V until V c is the state, and turns keep lengths.

use super::Flow;
use crate::arithmetic::exact::{Twice, turned};
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::matrix::dot;
use crate::contact_state::bank::{Kernels, turns_alone};
use crate::contact_state::load::Load;
use crate::system::DrivePhase;

impl Flow {
    /// Corrects block coordinates c of (p, p′), and finds their low parts: V (c + low) is what of (p, p′) is free motion.
    pub(crate) fn enter_doubled(
        &self,
        [p, rate]: [&[f64]; 2],
        force: f64,
        drive: DrivePhase,
        c: &mut [f64],
        low: &mut Vec<f64>,
    ) {
        let (order, size) = (self.order, self.modes.spectral.width());
        let c = &mut c[..size];
        low.clear();
        low.resize(size, 0.0);
        let rows = self.modes.spectral.from_blocks.chunks_exact(size);
        let columns = self.modes.spectral.to_blocks.chunks_exact(size);
        for (row, (entries, column)) in rows.zip(columns).take(2 * order).enumerate() {
            let (i, half) = (row % order, row / order);
            let mut missing = Twice::of(if half == 0 { p[i] } else { rate[i] });
            self.add_loads(-1.0, half, i, force, drive, &mut missing);
            entries.iter().zip(&*c).for_each(|(entry, c)| missing.add_product(-entry, *c));
            let missing = missing.rounded();
            low.iter_mut().zip(column).for_each(|(low, entry)| *low += entry * missing);
        }
        for (c, low) in c.iter_mut().zip(low) {
            let whole = Twice { high: *c, low: *low }.settled();
            (*c, *low) = (whole.high, whole.low);
        }
    }

    /// Adds what is steady of a coordinate (half 0) or of its rate (half 1), times 1 or −1.
    fn add_loads(&self, sign: f64, half: usize, i: usize, force: f64, drive: DrivePhase, sum: &mut Twice) {
        let part = |load: &Load| if half == 0 { load.rest[i] } else { load.rest_rate[i] };
        sum.add(sign * part(&self.modes.gravity));
        sum.add_product(sign * part(&self.force), force);
        if let Some(steady) = &self.harmonic {
            sum.add(sign * steady.at(i, drive)[half]);
        }
    }

    /// Block coordinates by the kernels of a time, and their low parts; those of blocks that do not turn alone stay as `end` has them.
    pub(crate) fn turn_doubled(
        &self,
        kernels: &[Kernels],
        [start, start_low]: [&[f64]; 2],
        end: &mut [f64],
        end_low: &mut Vec<f64>,
    ) {
        end_low.clear();
        end_low.resize(self.modes.spectral.width(), 0.0);
        let blocks = self.modes.spectral.matrices.iter().zip(&self.blocks);
        let starts = start.as_chunks::<2>().0.iter().zip(start_low.as_chunks::<2>().0);
        let ends = end.as_chunks_mut::<2>().0.iter_mut().zip(end_low.as_chunks_mut::<2>().0);
        for (k, (((matrix, block), ([x, y], [x_low, y_low])), (end, low))) in blocks.zip(starts).zip(ends).enumerate() {
            if turns_alone(*matrix, block.decay) {
                let kernel = kernels[k / WIDTH].at(k % WIDTH);
                let start = [Twice { high: *x, low: *x_low }, Twice { high: *y, low: *y_low }];
                let [x, y] = turned([kernel.c, kernel.turn], start);
                (*end, *low) = ([x.high, y.high], [x.low, y.low]);
            }
        }
    }

    /// (p, p′) from block coordinates and their low parts, after `t` seconds of the segment.
    pub(crate) fn leave_doubled(
        &self,
        [c, low]: [&[f64]; 2],
        t: f64,
        force: f64,
        drive: DrivePhase,
        state: &mut Vec<Twice>,
    ) {
        let (order, size) = (self.order, self.modes.spectral.width());
        state.clear();
        for (row, entries) in self.modes.spectral.from_blocks.chunks_exact(size).take(2 * order).enumerate() {
            let mut sum = Twice::default();
            self.add_loads(1.0, row / order, row % order, force, drive, &mut sum);
            for ((entry, c), low) in entries.iter().zip(c).zip(low) {
                sum.add_times(*entry, Twice { high: *c, low: *low });
            }
            if self.drifts {
                for (load, size) in [(&self.modes.gravity, 1.0), (&self.force, force)] {
                    for (k, entries) in entries.as_chunks::<2>().0.iter().enumerate() {
                        for j in 0..2 {
                            sum.add_product(entries[j], size * t * (load.slope[k][j] + t * load.bend[k][j]));
                        }
                    }
                }
            }
            state.push(sum.settled());
        }
    }

    /// Moves (p, p′) on from `t`, where the blocks are at `c`, by a time so short that its square is nothing.
    pub(crate) fn move_on(&self, short: f64, c: &[f64], t: f64, force: f64, state: &mut [Twice]) {
        let size = self.modes.spectral.width();
        let mut rates = Vec::with_capacity(size);
        for (k, ([p, q, r, s], [x, y])) in self.modes.spectral.matrices.iter().zip(c.as_chunks::<2>().0).enumerate() {
            let loads = |j: usize| {
                let of = |load: &Load| load.slope[k][j] + 2.0 * t * load.bend[k][j];
                of(&self.modes.gravity) + force * of(&self.force)
            };
            rates.extend([p * x + q * y + loads(0), r * x + s * y + loads(1)]);
        }
        for (place, entries) in state.iter_mut().zip(self.modes.spectral.from_blocks.chunks_exact(size)) {
            place.low += short * dot(entries, &rates);
        }
    }
}
