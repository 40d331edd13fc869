//! What a segment adds to the measures and to the audit.

use super::March;
use super::effects::Effects;
use crate::dynamics::audit::{self, Force};
use crate::dynamics::extremes::Stretch;
use crate::dynamics::flow::DrivePhase;
use crate::dynamics::integral;

/// Panels that an integral may take before closed forms are cheaper, where a contact state is hardly ever visited twice.
const FEW_PANELS: usize = 10;

/// How the observed signals are integrated over a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Integration {
    /// From the ends of the visits of a contact state.
    ByEnds,
    /// Each by panels.
    ByPanels,
    /// By the few panels that half cycles integrate the acceleration by.
    Together,
}

impl<E: Effects> March<'_, E> {
    /// Adds the segment to the measures, and to the audit if there is one.
    #[inline(always)]
    pub(super) fn sum_up(&mut self, length: f64, drive: DrivePhase) {
        if self.averaged.holds(self.cycle) {
            let half = self.averaged.half(self.cycle);
            if self.visits.half != half || self.visits.is_full() {
                self.pay_out();
                self.visits.half = half;
            }
            let integration = self.integration(length);
            if integration == Integration::ByEnds {
                self.visits.of(&self.flow).visit(&self.c, &self.c_end, self.level, length);
            }
            if integration == Integration::ByPanels || self.options.extremes {
                self.look_along(length);
            }
        }
        let flow = &self.flow;
        if let Some(audit) = &mut self.audit {
            audit.segment(self.system, flow, [&self.c, &self.c_end], Force { level: self.level, drive }, length);
        }
        if E::ALL && flow.rows.bend.is_some() {
            self.sum_up_half_cycle(length);
        }
    }

    /// The integrals are differences of end values: not of motion without damping, nor between jumps of the force that follow
    /// each other within a small part of the slowest turn; nor over the few turns for which half cycles leave a contact state as
    /// it is, where panels are cheaper than the equations of its blocks.
    pub(super) fn integration(&self, length: f64) -> Integration {
        if E::ALL && self.equivalent.is_some() && integral::panels(&self.flow.blocks, length) <= FEW_PANELS {
            Integration::Together
        } else if !self.is_brief && self.flow.closed().is_some() {
            Integration::ByEnds
        } else {
            Integration::ByPanels
        }
    }

    /// What has to be taken from the observed signals themselves.
    fn look_along(&mut self, length: f64) {
        let sampled = length > 0.0 && self.integration(length) == Integration::ByPanels;
        let flow = &self.flow;
        self.panels.clear();
        for (of, &row) in self.response.observed.iter_mut().zip(&flow.rows.observed) {
            let (shares, rest) = flow.rows.evaluate(row, &self.c, self.level);
            if self.options.extremes {
                let stretch = Stretch { blocks: &flow.blocks, bank: &flow.bank, rest, length };
                self.lookout.take(&mut of.extremes, stretch, &shares);
            }
            if sampled {
                self.panels.add(shares.into_iter(), rest);
            }
        }
        if sampled {
            let signals = self.panels.integrate(&flow.blocks, length);
            for (of, signal) in self.response.observed.iter_mut().zip(signals) {
                of.halves[self.visits.half].add(signal.sums(length));
            }
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
