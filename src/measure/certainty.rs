//! How far the numbers of a run are to be trusted.
//!
//! A result under events is run three times: as it is, with search windows half as long (the difference is its numerical
//! uncertainty), and with a kicked start, only as far as that is still beside the run where the run draws near an orbit. If the
//! kick of a billionth has grown beyond a millionth, the motion is chaotic and no single run is a result: an ensemble of kicked
//! starts, and the one without a kick, gives mean and spread. Under another value of an unstated input, and in a landscape, it is as
//! large as its means need. A search makes one run a step, and what it finds is evaluated as a result afterwards. The fixed step is
//! run once: what its step does to the numbers is the result that it is there for.
//!
//! Where runs are to settle, all of a case are made so; if one of them does not, the case is evaluated as if it had not been asked.

use super::case::{Case, Read};
use super::history::sampling_error;
use super::neighbour::{neighbour, repeated};
use super::reading::rounding;
use super::references::References;
use super::{ENSEMBLE_OF_A_VARIANT, EnsembleSize, EvaluateError, Evaluated, Measure, Measured, Rigour};
use crate::dynamics::{HybridSystem, Method, Options, Response, StartState, TraceRequest, Until};
use crate::measure::{Link, SolverChoice};

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

impl Case<'_> {
    /// Runs the system as often as it takes.
    pub(super) fn run(
        &self,
        system: &HybridSystem,
        references: &References,
        solver: SolverChoice,
    ) -> Result<Evaluated, EvaluateError> {
        // A run without an audit and without a history.
        let mut plain = self.request.options(self.scene, self.settings);
        if let Link::After(state) = self.request.link {
            plain.start = state.carried_to(system).ok_or(EvaluateError::NotCarried)?;
        }
        if references.may_settle {
            let settles = Options { until: Until::Settled, ..plain.clone() };
            if let Some(evaluated) = self.run_under(system, references, solver, &settles)? {
                return Ok(evaluated);
            }
        }
        let evaluated = self.run_under(system, references, solver, &plain)?;
        Ok(evaluated.unwrap_or_else(|| unreachable!("only a run that is to settle can fail to")))
    }

    /// The same under `plain` options. `None` where runs are to settle and one does not.
    fn run_under(
        &self,
        system: &HybridSystem,
        references: &References,
        solver: SolverChoice,
        plain: &Options,
    ) -> Result<Option<Evaluated>, EvaluateError> {
        match OwnRun::of(self, system, references, solver, plain)? {
            Some(run) => run.evaluated(),
            None => Ok(None),
        }
    }
}

/// The run of a case itself, with what was read off it.
struct OwnRun<'a> {
    case: &'a Case<'a>,
    system: &'a HybridSystem,
    solver: SolverChoice,
    /// Options of the runs beside it: without an audit and without a history.
    plain: &'a Options,
    /// Options of its own.
    main: Options,
    /// The run without dampers that it is compared with.
    undamped: Option<&'a Response>,
    response: Response,
    end: Option<StartState>,
    read: Read,
    /// Numbers read off the motion that it goes on to, with their uncertainty; `None` in the place of any other measure.
    elasticities: Vec<Option<Measured>>,
    /// Place of [`Measure::SettledVelocityRatio`], whose uncertainty no run beside this one tells.
    settled_ratio: Option<usize>,
}

impl<'a> OwnRun<'a> {
    /// Makes it. `None` where it is to settle and does not.
    fn of(
        case: &'a Case<'a>,
        system: &'a HybridSystem,
        references: &'a References,
        solver: SolverChoice,
        plain: &'a Options,
    ) -> Result<Option<Self>, EvaluateError> {
        let request = case.request;
        let undamped = match plain.until {
            Until::Cycles => references.of_cycles.as_ref(),
            Until::Settled => references.settled.as_ref(),
        };
        let main = Options {
            audit: request.rigour == Rigour::Result,
            motion: case.is_named(),
            settling: request.rigour != Rigour::Step,
            final_state: !matches!(request.link, Link::None),
            trace: request.trace.map(|trace| TraceRequest {
                from_cycle: u64::from(trace.from_cycle),
                to_cycle: u64::from(trace.to_cycle),
                samples: u64::from(trace.samples),
            }),
            ..plain.clone()
        };
        let mut response = solver.solve(system, &main)?;
        let end = response.final_state.take();
        if is_unsettled(plain, &response) {
            return Ok(None);
        }
        let mut read = case.read(&response, undamped, &plain.start, true)?;
        let later = case.later(system, references, plain, &response)?;
        let elasticities = later.elasticities(request.measures, request.tolerances)?;
        let settled_ratio = request.measures.iter().position(|measure| *measure == Measure::SettledVelocityRatio);
        if let Some(place) = settled_ratio {
            read.values[place] = later.velocity_ratio();
        }
        Ok(Some(Self { case, system, solver, plain, main, undamped, response, end, read, elasticities, settled_ratio }))
    }

    /// Its numbers, and how far each is to be trusted. `None` where runs are to settle and one beside it does not.
    fn evaluated(mut self) -> Result<Option<Evaluated>, EvaluateError> {
        if matches!(self.solver, SolverChoice::FixedStep { .. }) || self.system.particles.is_empty() {
            return Ok(Some(self.certain(vec![0.0; self.read.values.len()], false)));
        }
        if self.response.method == Method::ClosedForm {
            // Linear: neighbouring starts stay neighbours, and there is no window to be halved.
            let errors = self.read.values.iter().zip(self.own_errors());
            let errors = errors.map(|(value, own)| (CLOSED_FORM * value.abs()).max(own)).collect();
            return Ok(Some(self.certain(errors, false)));
        }
        let rigour = self.case.request.rigour;
        if rigour == Rigour::Step {
            return Ok(Some(self.certain(self.roundings(), false)));
        }
        // Of a twin that is no member of an ensemble nothing is read that has to be looked for along its motion.
        let beside = self.response.settling.take();
        let mut alike = Options { beside, ..self.kicked(TWIN_KICK) };
        if self.members() < 2 {
            alike = Options { extremes: false, record_events: 0, cycle_rates: false, ..alike };
        }
        let twin = match neighbour(self.system, &alike, &self.response)? {
            Ok(twin) => twin,
            Err(why) => return self.alone(false, &why),
        };
        if !twin.stays_beside && is_unsettled(self.plain, &twin) {
            return Ok(None);
        }
        let rms = self.case.rms_velocity(&self.response);
        let chaotic = !twin.stays_beside && (self.case.rms_velocity(&twin) - rms).abs() > CHAOS * rms;
        match (chaotic, rigour) {
            (true, _) if self.members() >= 2 => self.ensemble(&twin),
            (true, _) | (false, Rigour::Result) => self.by_second_accuracy(chaotic),
            (false, _) => Ok(Some(self.certain(self.roundings(), false))),
        }
    }

    /// Options of a run that starts beside it. One of which the last instant is read goes on as long.
    fn kicked(&self, kick: f64) -> Options {
        let trace = self.main.trace.filter(|_| self.case.request.any(Measure::is_of_the_end));
        Options { kick, trace, ..self.plain.clone() }
    }

    /// Runs of an ensemble, at most.
    fn members(&self) -> u32 {
        let asked = self.case.settings.ensemble;
        match self.case.request.rigour {
            Rigour::Result => asked,
            Rigour::Variant => asked.min(ENSEMBLE_OF_A_VARIANT.most),
            Rigour::Look | Rigour::Step => asked.min(MEMBERS_OF_A_LOOK),
        }
    }

    /// The rounding errors of its numbers.
    fn roundings(&self) -> Vec<f64> {
        self.read.values.iter().copied().map(rounding).collect()
    }

    /// The errors that measures state of themselves.
    fn own_errors(&self) -> impl Iterator<Item = f64> {
        self.case.request.measures.iter().map(|measure| own_error(*measure, &self.response))
    }

    /// Its own numbers, with these uncertainties.
    fn certain(&self, numerical: Vec<f64>, chaotic: bool) -> Evaluated {
        let numbers = self.read.values.iter().zip(numerical).zip(&self.elasticities);
        let measured = numbers
            .map(|((value, numerical), known)| known.unwrap_or(Measured { value: *value, numerical, spread: 0.0 }))
            .collect();
        self.of_members(1, measured, chaotic)
    }

    /// The result: these numbers, of so many runs.
    fn of_members(&self, members: u32, measured: Vec<Measured>, chaotic: bool) -> Evaluated {
        Evaluated {
            measured,
            proof: self.response.proof,
            chaotic,
            unknown: None,
            members,
            motion: self.response.motion.as_ref().map(|motion| motion.kind),
            trace: self.read.lists.clone(),
            end: self.end.clone(),
        }
    }

    /// Its own numbers, with what they differ by where the same events are decided in other windows; measures of the history are as exact
    /// as its samples.
    fn by_second_accuracy(&self, chaotic: bool) -> Result<Option<Evaluated>, EvaluateError> {
        let other = Options { window_factor: 0.5, audit: false, settling: false, ..self.main.clone() };
        let second = repeated(self.system, &other)?;
        if second.as_ref().is_ok_and(|second| is_unsettled(self.plain, second)) {
            return Ok(None);
        }
        let values = &self.read.values;
        let again = match &second {
            Ok(second) => self.case.read(second, self.undamped, &self.plain.start, true)?.values,
            Err(_) => vec![f64::NAN; values.len()],
        };
        let pairs = values.iter().zip(again).zip(self.own_errors());
        // A number of other runs is read once, as exact as those settle.
        let numerical = pairs.enumerate().map(|(place, ((a, b), own))| {
            let differs = if self.settled_ratio == Some(place) { CLOSED_FORM * a.abs() } else { (a - b).abs() };
            let least = rounding(*a).max(own);
            // A number that is none differs by none.
            if second.is_err() && differs.is_nan() { f64::NAN } else { differs.max(least) }
        });
        let mut evaluated = self.certain(numerical.collect(), chaotic);
        if let Err(why) = &second {
            evaluated.note_unknown("numerical uncertainty", why);
        }
        Ok(Some(evaluated))
    }

    /// The run alone, where one beside it has no result.
    fn alone(&self, chaotic: bool, why: &str) -> Result<Option<Evaluated>, EvaluateError> {
        let evaluated = match self.case.request.rigour {
            Rigour::Result => self.by_second_accuracy(chaotic)?,
            Rigour::Variant | Rigour::Look | Rigour::Step => Some(self.certain(self.roundings(), chaotic)),
        };
        Ok(evaluated.map(|mut evaluated| {
            let with_spread = self.case.request.measures.iter().zip(&self.elasticities);
            for (one, (measure, known)) in evaluated.measured.iter_mut().zip(with_spread) {
                if self.members() >= 2 && known.is_none() && !measure.is_of_own_run() {
                    one.spread = f64::NAN;
                }
            }
            evaluated.note_unknown(if chaotic { "spread" } else { "sensitivity to initial conditions" }, why);
            evaluated
        }))
    }

    /// Means and spreads over the run itself, its twin, and others with larger kicks, as many one way as the other. Time histories,
    /// shapes and their measures stay those of the run itself.
    fn ensemble(&self, twin: &Response) -> Result<Option<Evaluated>, EvaluateError> {
        let read = |member: &Response| {
            Ok::<_, EvaluateError>(self.case.read(member, self.undamped, &self.plain.start, false)?.values)
        };
        let mut all = Ensemble::of(self.case.request.measures);
        all.add(&self.read.values);
        all.add(&read(twin)?);
        let (members, mut count) = (self.members(), 2);
        for member in 2..members {
            if self.case.request.rigour == Rigour::Variant && all.is_sharp(count, self.case.settings.mean_of) {
                break;
            }
            count += 1;
            let step = f64::from(member / 2) * 2.0 / f64::from(members);
            let kick = ENSEMBLE_KICK * if member % 2 == 0 { step } else { -step };
            let kicked = match neighbour(self.system, &self.kicked(kick), &self.response)? {
                Ok(kicked) => kicked,
                Err(why) => return self.alone(true, &why),
            };
            if is_unsettled(self.plain, &kicked) {
                return Ok(None);
            }
            all.add(&read(&kicked)?);
        }
        let own = self.read.values.iter().zip(self.own_errors()).zip(&self.elasticities);
        let measured = all.each().zip(own).map(|((measure, sum), ((own, error), known))| match known {
            Some(known) => *known,
            None if measure.is_of_own_run() => {
                Measured { value: *own, numerical: rounding(*own).max(error), spread: 0.0 }
            }
            None => Measured { value: sum.mean, numerical: sum.standard_error(), spread: sum.deviation() },
        });
        Ok(Some(self.of_members(count, measured.collect(), true)))
    }
}

/// A run was to settle under these options and has not.
fn is_unsettled(plain: &Options, run: &Response) -> bool {
    plain.until == Until::Settled && run.settled.is_none()
}

/// An error that a measure states of itself: the standard error of an exponent, and what samples leave out.
fn own_error(measure: Measure, response: &Response) -> f64 {
    let exponent = response.motion.as_ref().and_then(|motion| motion.exponent);
    let of_exponent = exponent.filter(|_| measure == Measure::LyapunovExponent).map_or(0.0, |exponent| exponent.error);
    of_exponent + sampling_error(measure, &response.trace)
}

/// Running means and deviations over the members of an ensemble, one for each measure.
struct Ensemble<'a> {
    measures: &'a [Measure],
    statistics: Vec<Welford>,
}

impl<'a> Ensemble<'a> {
    /// Of no member yet.
    fn of(measures: &'a [Measure]) -> Self {
        Self { measures, statistics: vec![Welford::default(); measures.len()] }
    }

    fn add(&mut self, values: &[f64]) {
        self.statistics.iter_mut().zip(values).for_each(|(sum, value)| sum.add(*value));
    }

    fn each(&self) -> impl Iterator<Item = (&Measure, &Welford)> {
        self.measures.iter().zip(&self.statistics)
    }

    /// Whether the means of so many members are sharp enough, for a number that is the mean over so many cases. Their errors are
    /// independent, so that the mean of n alike is √n times as sharp as each.
    fn is_sharp(&self, members: u32, cases: u32) -> bool {
        let EnsembleSize { early, half_width, .. } = ENSEMBLE_OF_A_VARIANT;
        let half_width = half_width * f64::from(cases.max(1)).sqrt();
        early.iter().find(|early| early.members == members).is_some_and(|early| {
            // What is no number becomes none by more runs.
            let is_wide = |sum: &Welford| early.student * sum.standard_error() > half_width * sum.mean.abs();
            !self.each().any(|(measure, sum)| !measure.is_of_own_run() && is_wide(sum))
        })
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
