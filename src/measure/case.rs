//! One case, and all that is read off a run of it.

use super::each_cycle;
use super::energy::Energies;
use super::history::History;
use super::kept;
use super::later::{Later, settled_later};
use super::reading::{Reading, rounding};
use super::references::References;
use super::shape::{self, Shape};
use super::{EvaluateError, Evaluated, Measure, Measured, Rigour, Subject, TraceColumn};
use crate::dynamics::{EngineError, HybridSystem, MotionKind, Options, Proof, Response, StartState};
use crate::measure::{NamedRows, Request, Settings, ShapeOf};
use crate::scene::Scene;

/// A case while it is evaluated.
pub(super) struct Case<'a> {
    pub(super) subject: &'a Subject,
    pub(super) settings: &'a Settings,
    pub(super) request: &'a Request<'a>,
    pub(super) scene: &'a Scene,
}

/// What was read off a run.
pub(super) struct Read {
    pub(super) values: Vec<f64>,
    pub(super) lists: Vec<TraceColumn>,
}

impl Case<'_> {
    /// The motion is to be named. A number of the motion that a run settles to needs to know whether there is one.
    pub(super) fn is_named(&self) -> bool {
        let Request { rigour, .. } = *self.request;
        let of_row = rigour == Rigour::Result || self.settings.named == NamedRows::All;
        self.request.any(Measure::needs_motion) && (of_row || self.request.any(Measure::needs_settled))
    }

    /// Natural frequencies and mode shapes.
    pub(super) fn without_run(&self) -> Result<Evaluated, EvaluateError> {
        let shape = self.mode_shape()?;
        let mac = shape.as_ref().map(|shape| shape.mac);
        let reading = Reading { mode: self.subject.mode, mac, ..Reading::of_scene(self.scene) };
        let exact = |value: f64| Measured { value, numerical: rounding(value), spread: 0.0 };
        let measured = self.request.measures.iter().map(|measure| reading.read(*measure).map(exact));
        Ok(Evaluated {
            measured: measured.collect::<Result<_, _>>()?,
            proof: Proof::linear(),
            chaotic: false,
            unknown: None,
            members: 0,
            motion: None,
            trace: shape.map(|shape| shape.columns).unwrap_or_default(),
            end: None,
        })
    }

    fn mode_shape(&self) -> Result<Option<Shape>, EvaluateError> {
        let wanted = self.request.shape.filter(|shape| shape.of == ShapeOf::Mode);
        let number = self.subject.mode as usize;
        Ok(wanted.map(|spec| shape::of_mode(self.scene, spec, number)).transpose()?)
    }

    /// The motion that the run goes on to, where a measure is read off it.
    pub(super) fn later<'c>(
        &'c self,
        system: &'c HybridSystem,
        references: &'c References,
        plain: &Options,
        run: &Response,
    ) -> Result<Later<'c>, EngineError> {
        let kind = run.motion.as_ref().map(|motion| motion.kind);
        let never_settles = matches!(kind, Some(MotionKind::QuasiPeriodic | MotionKind::Chaotic));
        let undamped = references.settled_later.as_ref();
        let is_read = undamped.is_some() || self.request.any(Measure::needs_neighbours);
        let own = if is_read && !never_settles { settled_later(system, plain)? } else { None };
        Ok(Later { subject: self.subject, system, own, undamped })
    }

    /// All measures, and the lists, of a run from `start`; of a run of an ensemble (not `whole`) only what is averaged.
    pub(super) fn read(
        &self,
        response: &Response,
        undamped: Option<&Response>,
        start: &StartState,
        whole: bool,
    ) -> Result<Read, EvaluateError> {
        let request = self.request;
        let wants_energies = request.energies.is_some() || request.any(Measure::needs_energies);
        let energies = match undamped {
            Some(clean) if wants_energies => {
                let bare = self.subject.undamped.as_ref().map_or(StartState::StaticEquilibrium, Scene::start_state);
                let starts = [start, &bare];
                Some(Energies::of(self.scene, [response, clean], starts, self.subject.comparison, self.settings))
            }
            _ => None,
        };
        let shape = match request.deflection() {
            _ if !whole => None,
            Some(spec) => Some(shape::of_deflection(self.scene, response, spec, self.subject.mode as usize)),
            None => self.mode_shape()?,
        };
        let history = request.trace.filter(|_| whole).map(|trace| {
            let cycles = u64::from(trace.from_cycle)..u64::from(trace.to_cycle);
            History { response, scene: self.scene, cycles }
        });
        let reading = Reading {
            mode: self.subject.mode,
            undamped,
            history,
            energies: energies.as_ref(),
            given: self.settings.averaged(),
            mac: shape.as_ref().map(|shape| shape.mac),
            ..Reading::of_run(self.scene, response)
        };
        let value = |measure: &Measure| {
            if !whole && measure.is_of_own_run() { Ok(f64::NAN) } else { reading.read(*measure) }
        };
        let values = request.measures.iter().map(value).collect::<Result<Vec<_>, _>>()?;
        let mut lists = Vec::new();
        if whole {
            let trace = |it: &History<'_>| kept::of_trace(&it.response.trace, it.scene.g());
            lists.extend(reading.history.iter().flat_map(trace));
            if let (Some(energies), Some(spec)) = (&energies, request.energies) {
                lists.extend(kept::of_cycles(energies, spec));
            }
            lists.extend(shape.into_iter().flat_map(|shape| shape.columns));
            if let Some(each) = request.each_cycle {
                lists.push(each_cycle::column(*each, self.scene, response, reading.averaged(response)));
            }
        }
        Ok(Read { values, lists })
    }

    pub(super) fn rms_velocity(&self, response: &Response) -> f64 {
        Reading::of_run(self.scene, response).rms_velocity(response)
    }
}
