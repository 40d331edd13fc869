//! From event to event with many digits.

use std::time::{Duration, Instant};

use super::double::Double;
use super::matrix::{Square, dot};
use super::power::{scaled, sin_cos, square};
use super::root::{both, extremes, first_negative, value};
use super::series::{Phase, Series, State, TERMS, Touch, along, doubles};
use crate::dynamics::{Contact, CycleRates, HybridSystem, Law, Observed, Options, Placed, Response, StartState, Tick};

/// Events at one instant before the run is given up.
const MOST_AT_AN_INSTANT: u32 = 64;

/// What ends a phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End {
    Meets(bool),
    Leaves,
    HitsStop,
    LetGo,
    Squeezed,
}

/// Why there is no reference of this kind.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PreciseError {
    /// An effect that this solver does not know.
    #[error("the solver of many digits does not know {0}")]
    Unknown(&'static str),
    /// M, or K in a static equilibrium, has no inverse.
    #[error("a matrix is singular")]
    Singular,
    /// Floor and ceiling at once.
    #[error("particle {particle} is met by floor and ceiling at once in cycle {cycle}")]
    Squeezed {
        /// Which.
        particle: usize,
        /// Cycle.
        cycle: u64,
    },
    /// Too many events at one instant.
    #[error("the contact does not settle in cycle {cycle}")]
    NoProgress {
        /// Cycle.
        cycle: u64,
    },
    /// It took too long.
    #[error("the solver of many digits did not end within {} s", .0.as_secs())]
    TooLong(Duration),
}

/// Runs a system as [`crate::dynamics::event_driven`] does, to some 25 digits, which are rounded to doubles at the end;
/// gives up after `patience`.
///
/// The response holds measures, events, extremes, rates at the ends of cycles and the final state; the balances and the
/// certificate are NaN, as this run has none.
///
/// # Errors
/// [`PreciseError`] with the reason.
pub fn precise(system: &HybridSystem, options: &Options, patience: Duration) -> Result<Response, PreciseError> {
    if system.drive.half_cycles.is_some() {
        return Err(PreciseError::Unknown("equivalent viscous damping"));
    }
    let mut rigid = 0;
    for particle in &system.particles {
        if particle.is_enclosed() {
            return Err(PreciseError::Unknown("rigid faces without a gap between them"));
        }
        for face in [Some(&particle.floor), particle.ceiling.as_ref()].into_iter().flatten() {
            match face.law {
                Law::Rigid { restitution } if restitution > 0.0 => {
                    return Err(PreciseError::Unknown("rigid faces that give something back"));
                }
                Law::Resilient { no_tension: true, .. } => {
                    return Err(PreciseError::Unknown("faces that cannot pull"));
                }
                Law::Rigid { .. } | Law::Resilient { stop: Some(_), .. } => rigid += 1,
                Law::Resilient { .. } => {}
            }
        }
    }
    if rigid > 0 && system.particles.len() > 1 {
        return Err(PreciseError::Unknown("rigid faces of several dampers"));
    }
    Run::new(system, options, patience)?.go()
}

/// A run under way.
pub(super) struct Run<'a> {
    pub(super) system: &'a HybridSystem,
    pub(super) options: &'a Options,
    begun: Instant,
    patience: Duration,
    pub(super) cycle: u64,
    pub(super) time: Double,
    pub(super) state: State,
    pub(super) touches: Vec<Touch>,
    /// Gap coordinates that are zero by construction, with the order up to which they are: (at the ceiling, measured from
    /// the stop, order).
    pub(super) fresh: Vec<Option<(bool, bool, usize)>>,
    /// Who has just struck what it may not be held by.
    pub(super) struck: Option<usize>,
    /// No acceleration has jumped at this instant.
    pub(super) goes_on: bool,
    pub(super) phase: Option<Phase>,
    sums: Vec<[[Double; 3]; 2]>,
    pub(super) response: Response,
}

/// sin and cos of the harmonic force's phase as a cycle begins.
fn begun_at(system: &HybridSystem) -> [Double; 2] {
    sin_cos(Double::from(system.drive.harmonic.map_or(0.0, |drive| drive.phase)))
}

impl<'a> Run<'a> {
    fn new(system: &'a HybridSystem, options: &'a Options, patience: Duration) -> Result<Self, PreciseError> {
        let (n, count) = (system.mass.order, system.particles.len());
        let zeros = |n: usize| vec![Double::ZERO; n];
        let rows = system.observed_rows.len();
        let phase = begun_at(system);
        let mut run = Self {
            system,
            options,
            begun: Instant::now(),
            patience,
            cycle: 0,
            time: Double::ZERO,
            state: State { q: zeros(n), v: zeros(n), y: zeros(count), w: zeros(count), phase, level: 0.0 },
            touches: vec![Touch::Flight; count],
            fresh: vec![None; count],
            struck: None,
            goes_on: false,
            phase: None,
            sums: vec![[[Double::ZERO; 3]; 2]; rows],
            response: Response { observed: vec![Observed::default(); rows], ..Response::default() },
        };
        run.response.highest_frequency = f64::NAN;
        run.start()?;
        Ok(run)
    }

    fn start(&mut self) -> Result<(), PreciseError> {
        match &self.options.start {
            StartState::StaticEquilibrium => {
                let mut weight = vec![Double::ZERO; self.state.q.len()];
                for particle in &self.system.particles {
                    let mg = Double::from(particle.mass) * self.system.gravity;
                    weight.iter_mut().zip(&particle.floor.row).for_each(|(sum, phi)| *sum = *sum - mg * *phi);
                }
                let solved = Square::of(&self.system.stiffness).solve(&[weight]).ok_or(PreciseError::Singular)?;
                self.state.q.copy_from_slice(&solved[0]);
                for (j, particle) in self.system.particles.iter().enumerate() {
                    let floor = dot(&particle.floor.row, &self.state.q);
                    let (touch, u) = match particle.floor.law {
                        Law::Rigid { .. } => (Touch::Held(false), Double::ZERO),
                        Law::Resilient { stiffness, .. } => {
                            let mg = Double::from(particle.mass) * self.system.gravity;
                            (Touch::Pressed(false), -(mg / Double::from(stiffness)))
                        }
                    };
                    if particle.floor.law.stop().is_some_and(|stop| -u.near() > stop.length) {
                        return Err(PreciseError::Unknown("a particle that its weight presses to the stop"));
                    }
                    self.touches[j] = touch;
                    self.state.y[j] = floor + u;
                }
            }
            StartState::Given { q, rate, particles } => {
                self.state.q = doubles(q);
                self.state.v = doubles(rate);
                for (j, Placed { contact, gap, rate: speed }) in particles.iter().enumerate() {
                    let ceiling = matches!(contact, Contact::Ceiling);
                    let particle = &self.system.particles[j];
                    let side =
                        if ceiling { particle.ceiling.as_ref().unwrap_or(&particle.floor) } else { &particle.floor };
                    let rigid = matches!(side.law, Law::Rigid { .. });
                    self.touches[j] = match contact {
                        Contact::Flight => Touch::Flight,
                        Contact::Floor | Contact::Ceiling if rigid => Touch::Held(ceiling),
                        Contact::Floor | Contact::Ceiling => Touch::Pressed(ceiling),
                        _ => return Err(PreciseError::Unknown("a start at a stop")),
                    };
                    let offset = if ceiling { particle.gap } else { 0.0 };
                    self.state.y[j] = dot(&side.row, &self.state.q) + Double::from(offset) + Double::from(*gap);
                    self.state.w[j] = dot(&side.row, &self.state.v) + Double::from(*speed);
                }
            }
        }
        Ok(())
    }

    fn go(mut self) -> Result<Response, PreciseError> {
        let drive = &self.system.drive;
        for cycle in 0..self.options.cycles() {
            self.cycle = cycle;
            self.time = Double::ZERO;
            self.state.phase = begun_at(self.system);
            let single = [Tick { time: 0.0, impulse: 0.0, level: 0.0 }];
            let ticks: &[Tick] = if cycle == 0 || drive.repeats { &drive.ticks } else { &single };
            for (i, tick) in ticks.iter().enumerate() {
                self.propagate_to(tick.time)?;
                self.state.level = tick.level;
                self.goes_on = false;
                let kick = if cycle == 0 && i == 0 { self.options.kick * drive.scale() } else { 0.0 };
                if tick.impulse + kick != 0.0 {
                    self.strike(tick.impulse + kick)?;
                }
                if i == 0 && self.options.cycle_rates {
                    self.response.cycle_rates.push(CycleRates { after: self.rates(), before: Vec::new() });
                }
            }
            self.propagate_to(drive.period)?;
            let rates = self.rates();
            if let Some(cycle) = self.response.cycle_rates.last_mut() {
                cycle.before = rates;
            }
        }
        Ok(self.finish())
    }

    fn rates(&self) -> Vec<f64> {
        self.state.v.iter().map(|v| v.near()).collect()
    }

    fn finish(mut self) -> Response {
        let cycles = f64::from(self.options.average);
        let second = (cycles / 2.0).floor();
        for (of, sums) in self.response.observed.iter_mut().zip(&self.sums) {
            let cycles = [cycles - second, second];
            for ((half, [displacement, square, velocity_square]), cycles) in of.halves.iter_mut().zip(sums).zip(cycles)
            {
                half.duration = cycles * self.system.drive.period;
                half.displacement = displacement.near();
                half.velocity_square = velocity_square.near();
                if half.duration > 0.0 {
                    half.deviation_square =
                        (*square - *displacement * *displacement / Double::from(half.duration)).near();
                }
            }
        }
        if let Some(row) = self.system.observed_rows.first() {
            self.response.final_displacement = dot(row, &self.state.q).near();
            self.response.final_velocity = dot(row, &self.state.v).near();
        }
        let (y, w) = (&self.state.y, &self.state.w);
        self.response.final_particles = y.iter().zip(w).map(|(y, w)| [y.near(), w.near()]).collect();
        let floors = self.system.particles.iter().map(|particle| dot(&particle.floor.row, &self.state.q));
        self.response.final_heights = y.iter().zip(floors).map(|(y, floor)| (*y - floor).near()).collect();
        let proof = &mut self.response.proof;
        (proof.momentum_residual, proof.energy_residual, proof.smallest_margin) = (f64::NAN, f64::NAN, f64::NAN);
        self.response
    }

    fn propagate_to(&mut self, until: f64) -> Result<(), PreciseError> {
        let mut at_an_instant = 0;
        while self.time.near() < until {
            if self.begun.elapsed() > self.patience {
                return Err(PreciseError::TooLong(self.patience));
            }
            let before = self.time.near();
            self.step(until)?;
            at_an_instant = if self.time.near() > before { 0 } else { at_an_instant + 1 };
            if at_an_instant > MOST_AT_AN_INSTANT {
                return Err(PreciseError::NoProgress { cycle: self.cycle });
            }
        }
        Ok(())
    }

    fn step(&mut self, until: f64) -> Result<(), PreciseError> {
        let phase = match self.phase.take() {
            Some(phase) => phase,
            None => Phase::new(self.system, &self.touches).ok_or(PreciseError::Singular)?,
        };
        let series = phase.series(self.system, &self.touches, &self.state);
        self.phase = Some(phase);
        let rest = Double::from(until) - self.time;
        let reach = series.reach();
        let whole = reach >= rest.near();
        let length = if whole { rest } else { Double::from(reach) };
        let mut first: Option<(Double, usize, End)> = None;
        for j in 0..self.touches.len() {
            for (end, terms) in self.guards(&series, j) {
                let scaled = scaled(&terms, length.near());
                if let Some(root) = first_negative(&scaled)
                    && first.is_none_or(|(earliest, ..)| (root - earliest).is_negative())
                {
                    first = Some((root, j, end));
                }
            }
        }
        let span = first.map_or(length, |(root, ..)| root * length.near());
        self.sum_up(&series, span);
        self.arrive(&series, span);
        self.time = if first.is_none() && whole { Double::from(until) } else { self.time + span };
        if span.near() > 0.0 {
            self.goes_on = true;
            self.fresh.fill(None);
            self.struck = None;
        }
        match first {
            Some((_, j, end)) => self.cross(j, end),
            None => Ok(()),
        }
    }

    fn sum_up(&mut self, series: &Series, span: Double) {
        if !self.options.averaged().holds(self.cycle) || span.near() <= 0.0 {
            return;
        }
        let half = self.options.averaged().half(self.cycle);
        for (i, row) in self.system.observed_rows.iter().enumerate() {
            let x = scaled(&along(row, &series.q), span.near());
            let v: Vec<Double> = (1..TERMS).map(|k| x[k] * (k as f64) / span).collect();
            let sums = &mut self.sums[i][half];
            let mean = x.iter().enumerate().fold(Double::ZERO, |sum, (k, a)| sum + *a / Double::from((k + 1) as f64));
            sums[0] += mean * span;
            sums[1] += square(&x) * span;
            sums[2] += square(&v) * span;
            if self.options.extremes {
                let [x, v] = [x, v].map(|terms| terms.iter().map(|term| term.near()).collect::<Vec<_>>());
                let mut at = vec![0.0, 1.0];
                at.extend(extremes(&x).into_iter().chain(extremes(&v)));
                let observed = &mut self.response.observed[i].extremes;
                at.into_iter().for_each(|t| observed.take(value(&x, t), value(&v, t)));
            }
        }
    }

    fn arrive(&mut self, series: &Series, span: Double) {
        let end = |terms: &Vec<Double>| both(terms, span);
        for (i, terms) in series.q.iter().enumerate() {
            (self.state.q[i], self.state.v[i]) = end(terms);
        }
        for (j, terms) in series.y.iter().enumerate() {
            (self.state.y[j], self.state.w[j]) = end(terms);
        }
        if let Some(drive) = self.system.drive.harmonic {
            // Turned by ω·span, by the series of both.
            let angle = span * drive.angular_frequency;
            let [sine, cosine] = sin_cos(angle);
            let [s, c] = self.state.phase;
            self.state.phase = [s * cosine + c * sine, c * cosine - s * sine];
        }
    }
}
