//! One case, simulated and measured.
//!
//! A result under events is run three times: as it is, with search windows half as long (the difference is its numerical
//! uncertainty), and with a kicked start, only as far as that is still beside the run where the run draws near an orbit. If the
//! kick of a billionth has grown beyond a millionth, the motion is chaotic and no single run is a result: an ensemble of kicked
//! starts, and the one without a kick, gives mean and spread. Under another value of an unstated input, and in a landscape, it is as
//! large as its means need. A search makes one run a step, and what it finds is evaluated as a result afterwards. The fixed step is
//! run once: what its step does to the numbers is the result that it is there for.
//!
//! Runs may form a chain: each starts where the one before it ended, with its companions beside it; the run without dampers
//! starts as the scene says.
//!
//! Where runs are to settle, all of a case are made so; if one of them does not, the case is evaluated as if it had not been asked.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::each_cycle;
use super::energy::Energies;
use super::history::{History, sampling_error};
use super::kept;
use super::later::{Later, settled_later};
use super::neighbour::{neighbour, repeated};
use super::reading::Reading;
use super::references::References;
use super::shape::{self, Shape};
use super::undefined::in_range;
use super::{
    ENSEMBLE_OF_A_VARIANT, EarlyEnd, EnsembleSize, EvaluateError, Evaluated, Measure, Measured, Needs, Rigour, Subject,
    TraceColumn,
};
use crate::dynamics::{
    Averaged, EngineError, HybridSystem, Method, MotionKind, Options, Proof, Response, StartState, TraceRequest, Until,
    event_driven,
};
use crate::measure::{
    CycleSpec, EnergySpec, NamedRows, Settings, ShapeOf, ShapeSpec, SolverChoice, Tolerance, TraceSpec,
};
use crate::scene::{Excitation, Scene, SingleMass, Structure, compile};

/// Kick that tells chaos from order, relative to the drive.
const TWIN_KICK: f64 = 1e-9;
/// How far the twin may end, relative to the RMS velocity, before the motion counts as chaotic.
const CHAOS: f64 = 1e-6;
/// What rounding leaves of a number in closed form, relative to it.
const CLOSED_FORM: f64 = 1e-12;
/// Ensemble of a look.
const MEMBERS_OF_A_LOOK: u32 = 8;
/// Largest kick of an ensemble member.
const ENSEMBLE_KICK: f64 = 1e-6;

/// Whether a run is one of a chain.
#[derive(Debug, Clone, Copy, Default)]
pub enum Link<'a> {
    /// It is not: it starts as the scene says, and nobody asks where it ends.
    #[default]
    None,
    /// The first of a chain: it starts as the scene says.
    First,
    /// It starts where another ended.
    After(&'a StartState),
}

/// What is asked of a case.
#[derive(Debug, Clone, Copy, Default)]
pub struct Request<'a> {
    /// What to measure.
    pub measures: &'a [Measure],
    /// Time history to keep.
    pub trace: Option<&'a TraceSpec>,
    /// Kinetic energies to keep.
    pub energies: Option<&'a EnergySpec>,
    /// Shape to keep.
    pub shape: Option<&'a ShapeSpec>,
    /// Value to keep of each cycle.
    pub each_cycle: Option<&'a CycleSpec>,
    /// How uncertain design parameters are.
    pub tolerances: &'a [Tolerance],
    /// What the numbers have to be worth.
    pub rigour: Rigour,
    /// The place of the run in a chain.
    pub link: Link<'a>,
}

impl Request<'_> {
    pub(super) fn any(&self, test: impl Fn(Measure) -> bool) -> bool {
        self.measures.iter().any(|measure| test(*measure))
    }

    fn deflection(&self) -> Option<&ShapeSpec> {
        self.shape.filter(|shape| shape.of == ShapeOf::Deflection)
    }

    /// Something is asked for that only a run can tell.
    fn needs_run(&self) -> bool {
        self.any(|measure| !measure.is_modal())
            || self.trace.is_some()
            || self.energies.is_some()
            || self.deflection().is_some()
            || self.each_cycle.is_some()
            || !matches!(self.link, Link::None)
    }

    /// A run of a scene without an audit and without a history.
    pub(super) fn options(&self, scene: &Scene, settings: &Settings) -> Options {
        let of_cycle = |ends: bool| self.each_cycle.is_some_and(|each| each.of.is_of_ends() == ends);
        Options {
            start: scene.start_state(),
            skip: settings.skip,
            average: settings.average,
            displacement: self.any(Measure::needs_displacement) || self.deflection().is_some(),
            extremes: self.any(Measure::needs_extremes),
            record_events: if self.any(Measure::needs_events) || of_cycle(false) { usize::MAX } else { 0 },
            cycle_rates: self.energies.is_some() || self.any(Measure::needs_energies) || of_cycle(true),
            ..Options::default()
        }
    }

    /// What it takes of a subject.
    #[must_use]
    pub fn needs(&self) -> Needs {
        Needs::of(self.measures, self.energies.is_some())
    }
}

/// A scene that is ready to be run with other gaps: resolved, compiled and compared with the clean structure once.
#[derive(Debug)]
pub struct Prepared<'a> {
    subject: Subject,
    pub(super) settings: Settings,
    pub(super) measures: &'a [Measure],
    solver: SolverChoice,
    system: HybridSystem,
    reference: Arc<References>,
    /// The gap of each damper, m, that is one in the word by which gaps are given.
    units: Vec<f64>,
}

impl<'a> Prepared<'a> {
    /// Gets a scene ready whose gaps are one each, in the word by which gaps will be given.
    ///
    /// # Errors
    /// [`EvaluateError`] with the reason.
    pub fn new(
        subject: Subject,
        solver: SolverChoice,
        settings: Settings,
        measures: &'a [Measure],
    ) -> Result<Self, EvaluateError> {
        let subject = rounded_subject(subject, &settings);
        let system = compile(&subject.scene)?;
        let request = Request { measures, rigour: Rigour::Look, ..Request::default() };
        let reference = References::of(&subject, &request, &settings, solver)?;
        let units = subject.scene.dampers.iter().map(|damper| damper.gap).collect();
        Ok(Self { subject, settings, measures, solver, system, reference, units })
    }

    /// Runs it with these gaps; sequential and deterministic as [`evaluate`].
    ///
    /// # Errors
    /// [`EvaluateError`] with the reason.
    pub fn evaluate(&self, gaps: &[f64], rigour: Rigour) -> Result<Evaluated, EvaluateError> {
        let (scene, system) = self.with_gaps(gaps);
        let request = Request { measures: self.measures, rigour, ..Request::default() };
        let Self { subject, settings, .. } = self;
        let case = Case { subject, settings, request: &request, scene: &scene };
        in_range(&scene, settings.average, self.measures, case.run(&system, &self.reference, self.solver)?)
    }

    pub(super) fn with_gaps(&self, gaps: &[f64]) -> (Scene, HybridSystem) {
        let (mut scene, mut system) = (self.subject.scene.clone(), self.system.clone());
        for (i, (gap, unit)) in gaps.iter().zip(&self.units).enumerate() {
            scene.dampers[i].gap = gap * unit;
            system.particles[i].gap = gap * unit;
        }
        (scene, system)
    }

    /// RMS velocity of the structure without dampers, where something is compared with it.
    pub(super) fn undamped_rms_velocity(&self) -> Option<f64> {
        let run = self.reference.of_cycles.as_ref()?;
        Some(Reading::of_run(&self.subject.scene, run).rms_velocity(run))
    }
}

/// Simulates one case and measures it. Sequential and deterministic: the same input gives the same bits on any machine.
///
/// # Errors
/// [`EvaluateError`] with the reason.
pub fn evaluate(
    subject: Subject,
    solver: SolverChoice,
    settings: &Settings,
    request: &Request<'_>,
) -> Result<Evaluated, EvaluateError> {
    let subject = rounded_subject(subject, settings);
    let case = Case { subject: &subject, settings, request, scene: &subject.scene };
    if !request.needs_run() {
        return case.without_run();
    }
    let mut system = compile(&subject.scene)?;
    if request.deflection().is_some() {
        shape::watch_products(&mut system);
    }
    let reference = References::of(&subject, request, settings, solver)?;
    in_range(&subject.scene, settings.average, request.measures, case.run(&system, &reference, solver)?)
}

impl Case<'_> {
    /// Runs the system as often as it takes.
    fn run(
        &self,
        system: &HybridSystem,
        reference: &References,
        solver: SolverChoice,
    ) -> Result<Evaluated, EvaluateError> {
        // A run without an audit and without a history.
        let mut plain = self.request.options(self.scene, self.settings);
        if let Link::After(state) = self.request.link {
            plain.start = state.carried_to(system).ok_or(EvaluateError::NotCarried)?;
        }
        if reference.may_settle {
            let settles = Options { until: Until::Settled, ..plain.clone() };
            if let Some(evaluated) = self.run_until(system, reference, solver, &settles)? {
                return Ok(evaluated);
            }
        }
        let evaluated = self.run_until(system, reference, solver, &plain)?;
        Ok(evaluated.unwrap_or_else(|| unreachable!("only a run that is to settle can fail to")))
    }

    /// The same under `plain` options. `None` where runs are to settle and one does not.
    fn run_until(
        &self,
        system: &HybridSystem,
        references: &References,
        solver: SolverChoice,
        plain: &Options,
    ) -> Result<Option<Evaluated>, EvaluateError> {
        let Self { settings, request, .. } = *self;
        let case = self;
        let reference = match plain.until {
            Until::Cycles => references.of_cycles.as_ref(),
            Until::Settled => references.settled.as_ref(),
        };
        let main = Options {
            audit: request.rigour == Rigour::Result,
            motion: self.is_named(),
            settling: request.rigour != Rigour::Step,
            final_state: !matches!(request.link, Link::None),
            trace: request.trace.map(|trace| TraceRequest {
                from_cycle: u64::from(trace.from_cycle),
                to_cycle: u64::from(trace.to_cycle),
                samples: u64::from(trace.samples),
            }),
            ..plain.clone()
        };
        let unsettled = |run: &Response| plain.until == Until::Settled && run.settled.is_none();
        let mut response = solve(system, &main, solver)?;
        let end = response.final_state.take();
        if unsettled(&response) {
            return Ok(None);
        }
        let Read { mut values, lists } = case.read(&response, reference, &plain.start, true)?;
        let later = case.later(system, references, plain, &response)?;
        let elasticities = later.elasticities(request.measures, request.tolerances)?;
        let settled = request.measures.iter().position(|measure| *measure == Measure::SettledVelocityRatio);
        if let Some(place) = settled {
            values[place] = later.velocity_ratio();
        }
        let motion = response.motion.as_ref().map(|motion| motion.kind);
        let certain = |numerical: Vec<f64>, chaotic: bool| Evaluated {
            measured: values
                .iter()
                .zip(numerical)
                .zip(&elasticities)
                .map(|((value, numerical), known)| known.unwrap_or(Measured { value: *value, numerical, spread: 0.0 }))
                .collect(),
            proof: response.proof,
            chaotic,
            unknown: None,
            members: 1,
            motion,
            trace: lists.clone(),
            end: end.clone(),
        };
        if matches!(solver, SolverChoice::FixedStep { .. }) || system.particles.is_empty() {
            return Ok(Some(certain(vec![0.0; values.len()], false)));
        }

        if response.method == Method::ClosedForm {
            // Linear: neighbouring starts stay neighbours, and there is no window to be halved.
            let own = request.measures.iter().map(|measure| own_error(*measure, &response));
            let errors = values.iter().zip(own).map(|(value, own)| (CLOSED_FORM * value.abs()).max(own));
            return Ok(Some(certain(errors.collect(), false)));
        }
        let exact = || values.iter().map(|value| 4.0 * f64::EPSILON * value.abs()).collect();
        if request.rigour == Rigour::Step {
            return Ok(Some(certain(exact(), false)));
        }
        let rms = case.rms_velocity(&response);
        let members = match request.rigour {
            Rigour::Result => settings.ensemble,
            Rigour::Variant => settings.ensemble.min(ENSEMBLE_OF_A_VARIANT.most),
            Rigour::Look | Rigour::Step => settings.ensemble.min(MEMBERS_OF_A_LOOK),
        };
        // Of a twin that is no member of an ensemble nothing is read that has to be looked for along its motion.
        let mut alike = Options { kick: TWIN_KICK, beside: response.settling.take(), ..plain.clone() };
        if members < 2 {
            alike = Options { extremes: false, record_events: 0, cycle_rates: false, ..alike };
        }
        // The same events decided in other windows; measures of the history are as exact as its samples.
        let by_second_accuracy = |chaotic: bool| {
            let other = Options { window_factor: 0.5, audit: false, settling: false, ..main.clone() };
            let second = repeated(system, &other)?;
            if second.as_ref().is_ok_and(unsettled) {
                return Ok(None);
            }
            let again = match &second {
                Ok(second) => case.read(second, reference, &plain.start, true)?.values,
                Err(_) => vec![f64::NAN; values.len()],
            };
            let own = request.measures.iter().map(|measure| own_error(*measure, &response));
            let pairs = values.iter().zip(again).zip(own);
            // A number of other runs is read once, as exact as those settle.
            let numerical = pairs.enumerate().map(|(place, ((a, b), own))| {
                let differs = if settled == Some(place) { CLOSED_FORM * a.abs() } else { (a - b).abs() };
                let least = (4.0 * f64::EPSILON * a.abs()).max(own);
                // A number that is none differs by none.
                if second.is_err() && differs.is_nan() { f64::NAN } else { differs.max(least) }
            });
            let mut evaluated = certain(numerical.collect(), chaotic);
            if let Err(why) = &second {
                evaluated.note_unknown("numerical uncertainty", why);
            }
            Ok::<_, EvaluateError>(Some(evaluated))
        };
        // The run alone, where one beside it has no result.
        let alone = |chaotic: bool, why: &str| {
            let evaluated = match request.rigour {
                Rigour::Result => by_second_accuracy(chaotic)?,
                Rigour::Variant | Rigour::Look | Rigour::Step => Some(certain(exact(), chaotic)),
            };
            Ok::<_, EvaluateError>(evaluated.map(|mut evaluated| {
                let with_spread = request.measures.iter().zip(&elasticities);
                for (one, (measure, known)) in evaluated.measured.iter_mut().zip(with_spread) {
                    if members >= 2 && known.is_none() && !measure.is_of_own_run() {
                        one.spread = f64::NAN;
                    }
                }
                evaluated.note_unknown(if chaotic { "spread" } else { "sensitivity to initial conditions" }, why);
                evaluated
            }))
        };
        let twin = match neighbour(system, &alike, &response)? {
            Ok(twin) => twin,
            Err(why) => return alone(false, &why),
        };
        if !twin.stays_beside && unsettled(&twin) {
            return Ok(None);
        }
        let chaotic = !twin.stays_beside && (case.rms_velocity(&twin) - rms).abs() > CHAOS * rms;
        if !chaotic && request.rigour != Rigour::Result {
            return Ok(Some(certain(exact(), false)));
        }
        if !chaotic || members < 2 {
            return by_second_accuracy(chaotic);
        }

        let mut sums = vec![Welford::default(); request.measures.len()];
        // The run itself and its twin, and as many that were kicked farther, both ways. Time histories, shapes and their measures
        // stay those of the run itself.
        let add =
            |sums: &mut [Welford], values: &[f64]| sums.iter_mut().zip(values).for_each(|(sum, value)| sum.add(*value));
        let read =
            |member: &Response| Ok::<_, EvaluateError>(case.read(member, reference, &plain.start, false)?.values);
        add(&mut sums, &values);
        add(&mut sums, &read(&twin)?);
        let EnsembleSize { early, half_width, .. } = ENSEMBLE_OF_A_VARIANT;
        let is_enough = |sums: &[Welford], made: u32| {
            let sharp = |early: &EarlyEnd| {
                // What is no number becomes none by more runs.
                let is_wide = |sum: &Welford| early.student * sum.standard_error() > half_width * sum.mean.abs();
                let averaged = sums.iter().zip(request.measures).filter(|(_, measure)| !measure.is_of_own_run());
                !averaged.map(|(sum, _)| sum).any(is_wide)
            };
            request.rigour == Rigour::Variant && early.iter().find(|early| early.members == made).is_some_and(sharp)
        };
        let mut made = 2;
        for member in 2..members {
            if is_enough(&sums, made) {
                break;
            }
            made += 1;
            let step = f64::from(member / 2) * 2.0 / f64::from(members);
            let kick = ENSEMBLE_KICK * if member % 2 == 0 { step } else { -step };
            let kicked = match neighbour(system, &Options { kick, ..plain.clone() }, &response)? {
                Ok(kicked) => kicked,
                Err(why) => return alone(true, &why),
            };
            if unsettled(&kicked) {
                return Ok(None);
            }
            add(&mut sums, &read(&kicked)?);
        }
        let measured = sums.iter().zip(request.measures).zip(values.iter().zip(&elasticities)).map(
            |((sum, measure), (own, known))| {
                if let Some(known) = known {
                    return *known;
                }
                if measure.is_of_own_run() {
                    let numerical = (4.0 * f64::EPSILON * own.abs()).max(own_error(*measure, &response));
                    return Measured { value: *own, numerical, spread: 0.0 };
                }
                let spread = sum.deviation();
                Measured { value: sum.mean, numerical: sum.standard_error(), spread }
            },
        );
        let measured = measured.collect();
        let proof = response.proof;
        Ok(Some(Evaluated { measured, proof, chaotic, unknown: None, members: made, motion, trace: lists, end }))
    }
}

/// A case while it is evaluated.
struct Case<'a> {
    subject: &'a Subject,
    settings: &'a Settings,
    request: &'a Request<'a>,
    scene: &'a Scene,
}

/// What was read off a run.
struct Read {
    values: Vec<f64>,
    lists: Vec<TraceColumn>,
}

impl Case<'_> {
    /// The motion is to be named. A number of the motion that a run settles to needs to know whether there is one.
    fn is_named(&self) -> bool {
        let Request { rigour, .. } = *self.request;
        let of_row = rigour == Rigour::Result || self.settings.named == NamedRows::All;
        self.request.any(Measure::needs_motion) && (of_row || self.request.any(Measure::needs_settled))
    }

    /// Natural frequencies and mode shapes.
    fn without_run(&self) -> Result<Evaluated, EvaluateError> {
        let shape = self.mode_shape()?;
        let reading = self.reading(None, None, shape.as_ref().map(|shape| shape.mac));
        let exact = |value: f64| Measured { value, numerical: 4.0 * f64::EPSILON * value.abs(), spread: 0.0 };
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

    fn reading<'r>(
        &'r self,
        response: Option<&'r Response>,
        undamped: Option<&'r Response>,
        mac: Option<f64>,
    ) -> Reading<'r> {
        Reading {
            scene: self.scene,
            mode: self.subject.mode,
            response,
            undamped,
            history: None,
            energies: None,
            skip: self.settings.skip,
            average: self.settings.average,
            mac,
        }
    }

    /// The motion that the run goes on to, where a measure is read off it.
    fn later<'c>(
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
    fn read(
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
        let mac = shape.as_ref().map(|shape| shape.mac);
        let mut reading = self.reading(Some(response), undamped, mac);
        reading.history = history;
        reading.energies = energies.as_ref();
        let value = |measure: &Measure| {
            if !whole && measure.is_of_own_run() { Ok(f64::NAN) } else { reading.read(*measure) }
        };
        let values = request.measures.iter().map(value).collect::<Result<Vec<_>, _>>()?;
        let mut lists = Vec::new();
        if whole {
            let trace = |it: &History<'_>| kept::of_trace(&it.response.trace, it.scene.g());
            lists.extend(reading.history.iter().flat_map(trace));
            if let (Some(energies), Some(spec)) = (&energies, request.energies) {
                lists.extend(energies.columns(spec));
            }
            lists.extend(shape.into_iter().flat_map(|shape| shape.columns));
            if let Some(each) = request.each_cycle {
                let given = Averaged { first: u64::from(self.settings.skip), cycles: u64::from(self.settings.average) };
                let averaged = response.settled.unwrap_or(given);
                lists.push(each_cycle::column(*each, self.scene, response, averaged.first..averaged.end()));
            }
        }
        Ok(Read { values, lists })
    }

    fn rms_velocity(&self, response: &Response) -> f64 {
        self.reading(None, None, None).rms_velocity(response)
    }
}

/// An error that a measure states of itself: the standard error of an exponent, and what samples leave out.
fn own_error(measure: Measure, response: &Response) -> f64 {
    let exponent = response.motion.as_ref().and_then(|motion| motion.exponent);
    let of_exponent = exponent.filter(|_| measure == Measure::LyapunovExponent).map_or(0.0, |exponent| exponent.error);
    of_exponent + sampling_error(measure, &response.trace)
}

pub(super) fn solve(system: &HybridSystem, options: &Options, solver: SolverChoice) -> Result<Response, EngineError> {
    match solver {
        SolverChoice::EventDriven => event_driven(system, options),
        SolverChoice::FixedStep { time_step } => crate::dynamics::fixed_step(system, options, time_step),
    }
}

pub(super) fn rounded_subject(subject: Subject, settings: &Settings) -> Subject {
    let undamped = subject.undamped.map(|scene| rounded(scene, settings));
    Subject { scene: rounded(subject.scene, settings), undamped, ..subject }
}

/// The forcing period rounded to whole steps, if the experiment asks for it.
pub fn rounded(mut scene: Scene, settings: &Settings) -> Scene {
    let Some(step) = settings.round_period_to else { return scene };
    let round = |period: f64| (period / step).round().max(1.0) * step;
    match &mut scene.excitation {
        Excitation::SingleImpulse { cycle: period, .. }
        | Excitation::ImpulseTrain { period, .. }
        | Excitation::PulseTrain { period, .. } => *period = round(*period),
        Excitation::Harmonic { angular_frequency, .. } => *angular_frequency = TAU / round(TAU / *angular_frequency),
    }
    scene
}

/// Damping of one mass: the exponent of its free decay, c/(2m), 1/s; NaN of more than one.
pub(super) fn decay(scene: &Scene) -> f64 {
    match scene.structure {
        Structure::SingleMass(SingleMass { mass, damping, .. }) => damping / (2.0 * mass),
        _ => f64::NAN,
    }
}

/// Running mean and deviation (Welford).
#[derive(Debug, Clone, Copy, Default)]
struct Welford {
    count: f64,
    mean: f64,
    square: f64,
}

impl Welford {
    fn add(&mut self, value: f64) {
        self.count += 1.0;
        let before = value - self.mean;
        self.mean += before / self.count;
        self.square += before * (value - self.mean);
    }

    /// Standard deviation of the population that the members are a sample of.
    fn deviation(&self) -> f64 {
        (self.square / (self.count - 1.0)).sqrt()
    }

    /// Of the mean.
    fn standard_error(&self) -> f64 {
        self.deviation() / self.count.sqrt()
    }
}
