//! What a segment adds to the measures and to the audit.

use super::March;
use super::effects::Effects;
use crate::flow::Flow;
use crate::flow::ends::cancel;
use crate::response::audit::{self, Force};
use crate::response::extremes::Stretch;
use crate::system::DrivePhase;

/// How the observed signals are integrated over a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Integration {
    /// From the ends of the visits of a contact state.
    Visits,
    /// From the ends of the segment.
    Pairs,
    Panels,
}

impl<E: Effects> March<'_, E> {
    /// Adds the segment to the measures, and to the audit if there is one.
    #[inline(always)]
    pub(super) fn sum_up(&mut self, length: f64, drive: DrivePhase) {
        let moves = length > 0.0;
        let observed = (moves && self.averaged.holds(self.cycle)).then(|| self.integration(length));
        let half_cycle = if E::ALL && moves { self.half_cycle_integration(length) } else { None };
        // What both have in common is worked out once.
        let asked = |integration| observed == Some(integration) || half_cycle == Some(integration);
        if asked(Integration::Pairs) {
            self.pairs.set(&self.flow.bank, &self.search.kernels, length);
        }
        if asked(Integration::Panels) {
            self.panels.divide(&self.flow.blocks, &self.flow.bank, length);
        }
        if let Some(integration) = observed {
            self.sum_up_observed(integration, length);
        }
        if let Some(integration) = half_cycle {
            self.sum_up_half_cycle(integration, length);
        }
        let flow = &self.flow;
        if let Some(audit) = &mut self.audit {
            audit.segment(self.system, flow, [&self.c, &self.c_end], Force { level: self.level, drive }, length);
        }
    }

    #[inline(always)]
    fn sum_up_observed(&mut self, integration: Integration, length: f64) {
        if self.visits.is_full() {
            self.pay_out();
        }
        self.visits.half = self.averaged.half(self.cycle);
        if integration == Integration::Visits {
            self.visits.of(&self.flow).visit(&self.c, &self.c_end, self.level, length);
        }
        if integration != Integration::Visits || self.options.extremes {
            self.look_along(integration, length);
        }
    }

    /// The integrals are differences of end values: not of motion without damping, nor between jumps of the force that follow
    /// each other within a small part of the slowest turn. Half cycles leave a contact state before the equations of its blocks pay,
    /// and which of many dampings are still known hangs on the runs before: what is summed up together must not.
    #[inline(always)]
    fn integration(&self, length: f64) -> Integration {
        if self.is_brief || self.flow.is_brief(length) && !self.ends_keep_digits(length) {
            Integration::Panels
        } else if !self.is_passing && self.flow.closed().is_some() {
            Integration::Visits
        } else {
            self.integration_of_one()
        }
    }

    /// Of a short segment. A flow that is left at once is not worth its bounds.
    #[inline(always)]
    fn ends_keep_digits(&self, length: f64) -> bool {
        let turn = self.flow.turned_by_the_slowest(length);
        !self.is_passing && self.flow.ends().keep_digits([&self.c, &self.c_end], turn)
            || self.amplitudes_keep_digits(turn)
    }

    #[cold]
    fn amplitudes_keep_digits(&self, turn: f64) -> bool {
        let Flow { bank, rows, .. } = &*self.flow;
        !rows.observed.iter().any(|&row| cancel(rows.row(row), bank, [&self.c, &self.c_end], turn))
    }

    /// The same of one segment by itself.
    pub(super) fn integration_of_one(&self) -> Integration {
        let keeps_digits = self.flow.bank.near_critical.is_empty() && !self.flow.is_near_resonance;
        if keeps_digits { Integration::Pairs } else { Integration::Panels }
    }

    /// What has to be taken from the observed signals themselves.
    fn look_along(&mut self, integration: Integration, length: f64) {
        let Flow { blocks, bank, rows, .. } = &*self.flow;
        for (of, &row) in self.response.observed.iter_mut().zip(&rows.observed) {
            let row = rows.row(row);
            let rest = row.rest(self.level);
            if self.options.extremes {
                self.lookout.take(&mut of.extremes, Stretch { blocks, bank, rest, length }, row.together(&self.c));
            }
            let sums = match integration {
                Integration::Visits => continue,
                Integration::Pairs => self.pairs.sums(bank, row.together(&self.c), rest.p0, self.options.displacement),
                Integration::Panels => self.panels.sums(blocks, row.phases(&self.c), rest),
            };
            of.halves[self.visits.half].add(sums);
        }
    }

    pub(super) fn pay_out(&mut self) {
        self.visits.pay_out(self.options.displacement, &mut self.response.observed);
    }

    pub(super) fn audit_state(&self) -> audit::State {
        let structure = [&self.q, &self.rate].map(|x| &x[..self.system.mass.order]);
        let particles = (0..self.particles.len()).map(|j| self.absolute(j)).collect();
        audit::State::new(self.system, &self.contacts, structure, particles, |j, side| self.relative_to(j, side).gap)
    }
}

#[cfg(test)]
mod tests {
    use crate::arithmetic::matrix::Matrix;
    use crate::options::Options;
    use crate::run::event_driven;
    use crate::system::{Drive, Face, HybridSystem, Law, Particle, Tick};

    /// A base of 1 kg on 1000 N/m, struck once a natural period, with a particle that chatters on its rigid floor.
    fn loaded(particle: f64) -> HybridSystem {
        let natural = 1000.0_f64.sqrt();
        HybridSystem {
            mass: Matrix::diagonal(&[1.0]),
            damping: Matrix::diagonal(&[0.1 * natural]),
            stiffness: Matrix::diagonal(&[1000.0]),
            gravity: 9.81,
            particles: vec![Particle {
                mass: particle,
                floor: Face { row: vec![1.0], law: Law::Rigid { restitution: 0.5 } },
                ceiling: None,
                gap: 0.05,
            }],
            force_row: vec![1.0],
            drive: Drive {
                period: std::f64::consts::TAU / natural,
                ticks: vec![Tick { time: 0.0, impulse: 0.5, level: 0.0 }],
                repeats: true,
                harmonic: None,
                half_cycles: None,
            },
            observed_rows: vec![vec![1.0]],
            momentum_rows: vec![vec![1.0]],
        }
    }

    #[test]
    fn the_velocity_of_a_base_that_its_particle_presses_far_down_keeps_its_digits() {
        // RMS velocities from arithmetic of 32 digits, impact by impact; the base rests up to a kilometre below where it flies to.
        for (particle, expected, digits) in
            [(1e3, 2.772_629_914e-3, 1e-8), (1e4, 7.931_117_998e-4, 1e-7), (1e5, 2.475_105_781e-4, 1e-5)]
        {
            let options = Options { skip: 0, average: 4, ..Options::default() };
            let response = event_driven(&loaded(particle), &options).expect("the particle comes to rest");
            let velocity = response.window().rms_velocity();
            assert!((velocity / expected - 1.0).abs() < digits, "{particle} kg: {velocity} for {expected}");
        }
    }
}
