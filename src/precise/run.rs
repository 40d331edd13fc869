//! From event to event with many digits.

use std::time::{Duration, Instant};

use super::double::Double;
use super::matrix::{Square, dot};
use super::root::{both, extremes, first_negative, value};
use super::series::{Phase, Series, State, TERMS, Touch, along, away, doubles};
use crate::dynamics::{
    Contact, CycleRates, Event, EventKind, Face, HybridSystem, Law, Observed, Options, Response, StartState, Tick,
};

/// Events at one instant before the run is given up.
const MOST_AT_AN_INSTANT: u32 = 64;

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
        for face in [Some(&particle.floor), particle.ceiling.as_ref()].into_iter().flatten() {
            match face.law {
                Law::Rigid { restitution } if restitution > 0.0 => {
                    return Err(PreciseError::Unknown("rigid faces that give something back"));
                }
                Law::Rigid { .. } | Law::Resilient { stop: Some(_), .. } => rigid += 1,
                Law::Resilient { no_tension: true, .. } => {
                    return Err(PreciseError::Unknown("faces that cannot pull"));
                }
                Law::Resilient { .. } => {}
            }
        }
    }
    if rigid > 0 && system.particles.len() > 1 {
        return Err(PreciseError::Unknown("rigid faces of several dampers"));
    }
    Run::new(system, options, patience)?.go()
}

/// What ends a phase.
#[derive(Debug, Clone, Copy, PartialEq)]
enum End {
    Meets(bool),
    Leaves,
    HitsStop,
    LetGo,
    Squeezed,
}

struct Run<'a> {
    system: &'a HybridSystem,
    options: &'a Options,
    begun: Instant,
    patience: Duration,
    cycle: u64,
    time: Double,
    state: State,
    touches: Vec<Touch>,
    /// Gap coordinates that are zero by construction, with the order up to which they are: (at the ceiling, measured from
    /// the stop, order).
    fresh: Vec<Option<(bool, bool, usize)>>,
    /// Who has just struck what it may not be held by.
    struck: Option<usize>,
    phase: Option<Phase>,
    sums: Vec<[[Double; 3]; 2]>,
    response: Response,
}

impl<'a> Run<'a> {
    fn new(system: &'a HybridSystem, options: &'a Options, patience: Duration) -> Result<Self, PreciseError> {
        let (n, count) = (system.mass.order, system.particles.len());
        let zeros = |n: usize| vec![Double::ZERO; n];
        let rows = system.observed_rows.len();
        let phase = [Double::ZERO, Double::from(1.0)];
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
                for (j, (contact, gap, speed)) in particles.iter().enumerate() {
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
            self.state.phase = [Double::ZERO, Double::from(1.0)];
            let single = [Tick { time: 0.0, impulse: 0.0, level: 0.0 }];
            let ticks: &[Tick] = if cycle == 0 || drive.repeats { &drive.ticks } else { &single };
            for (i, tick) in ticks.iter().enumerate() {
                self.propagate_to(tick.time)?;
                self.state.level = tick.level;
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
            for (half, sums) in of.halves.iter_mut().zip(sums) {
                [half.displacement, half.displacement_square, half.velocity_square] = sums.map(Double::near);
            }
            of.halves[0].duration = (cycles - second) * self.system.drive.period;
            of.halves[1].duration = second * self.system.drive.period;
        }
        if let Some(row) = self.system.observed_rows.first() {
            self.response.final_displacement = dot(row, &self.state.q).near();
            self.response.final_velocity = dot(row, &self.state.v).near();
        }
        let (y, w) = (&self.state.y, &self.state.w);
        self.response.final_particles = y.iter().zip(w).map(|(y, w)| [y.near(), w.near()]).collect();
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
            self.fresh.fill(None);
            self.struck = None;
        }
        match first {
            Some((_, j, end)) => self.cross(j, end),
            None => Ok(()),
        }
    }

    /// u = y − φ·q − offset.
    fn gap(&self, series: &Series, j: usize, face: &Face, offset: f64) -> Vec<Double> {
        let face = along(&face.row, &series.q);
        let mut u: Vec<Double> = series.y[j].iter().zip(face).map(|(y, x)| *y - x).collect();
        u[0] = u[0] - Double::from(offset);
        u
    }

    /// What ends the phase of a particle, positive as long as it does not.
    fn guards(&self, series: &Series, j: usize) -> Vec<(End, Vec<Double>)> {
        let particle = &self.system.particles[j];
        // A coordinate that has just been zero is positive or negative by its first derivative that is not.
        let guard = |ceiling: bool, stop: bool, sign: f64, mut terms: Vec<Double>| {
            let order = match self.fresh[j] {
                Some((side, from_stop, order)) if side == ceiling && from_stop == stop => order,
                _ => 0,
            };
            terms.drain(..order);
            terms.iter_mut().for_each(|term| *term = *term * sign);
            terms
        };
        let touch = self.touches[j];
        let mut guards = Vec::new();
        match touch {
            Touch::Flight => {
                guards.push((End::Meets(false), guard(false, false, 1.0, self.gap(series, j, &particle.floor, 0.0))));
                if let Some(ceiling) = &particle.ceiling {
                    let w = self.gap(series, j, ceiling, particle.gap);
                    guards.push((End::Meets(true), guard(true, false, -1.0, w)));
                }
            }
            Touch::Pressed(side) => {
                let Some((face, offset)) = touch.face(self.system, j) else { return guards };
                let u = self.gap(series, j, face, offset);
                guards.push((End::Leaves, guard(side, false, -away(side), u.clone())));
                if let Some(stop) = face.law.stop() {
                    let mut deep = u;
                    deep[0] += Double::from(away(side) * stop.length);
                    guards.push((End::HitsStop, guard(side, true, away(side), deep)));
                }
            }
            Touch::Held(side) | Touch::Stopped(side) => {
                let mut push: Vec<Double> = (0..TERMS - 2)
                    .map(|k| series.y[j][k + 2] * ((k + 1) as f64) * ((k + 2) as f64) * (particle.mass * away(side)))
                    .collect();
                push[0] += Double::from(particle.mass) * self.system.gravity * away(side);
                if let (
                    Touch::Stopped(_),
                    Some((Face { law: Law::Resilient { stiffness, stop: Some(stop), .. }, .. }, _)),
                ) = (touch, touch.face(self.system, j))
                {
                    push[0] = push[0] - Double::from(*stiffness) * stop.length;
                }
                guards.push((End::LetGo, push));
            }
        }
        // Faces that do not move as one may close on the particle.
        if let (Touch::Pressed(side) | Touch::Held(side) | Touch::Stopped(side), Some(ceiling)) =
            (touch, &particle.ceiling)
            && ceiling.row != particle.floor.row
        {
            let across = if side {
                self.gap(series, j, &particle.floor, 0.0)
            } else {
                self.gap(series, j, ceiling, particle.gap).iter().map(|w| -*w).collect()
            };
            guards.push((End::Squeezed, across));
        }
        guards
    }

    fn sum_up(&mut self, series: &Series, span: Double) {
        if !self.options.averages(self.cycle) || span.near() <= 0.0 {
            return;
        }
        let half = usize::from(2 * (self.cycle - u64::from(self.options.skip)) >= u64::from(self.options.average));
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

    fn cross(&mut self, j: usize, end: End) -> Result<(), PreciseError> {
        self.phase = None;
        match (end, self.touches[j]) {
            (End::Squeezed, _) => return Err(PreciseError::Squeezed { particle: j, cycle: self.cycle }),
            (End::Meets(ceiling), _) => {
                let particle = &self.system.particles[j];
                let face = if ceiling { particle.ceiling.as_ref().unwrap_or(&particle.floor) } else { &particle.floor };
                let approach = self.relative(j, face);
                self.fresh[j] = Some((ceiling, false, 1));
                self.touches[j] = match face.law {
                    Law::Resilient { .. } => Touch::Pressed(ceiling),
                    Law::Rigid { .. } => {
                        self.collide(j, face, 0.0)?;
                        self.struck = Some(j);
                        Touch::Held(ceiling)
                    }
                };
                let departure = self.relative(j, face);
                self.record(j, met(ceiling, false), approach, departure);
            }
            (End::Leaves, Touch::Pressed(ceiling)) => self.leave(j, ceiling, 1),
            (End::HitsStop, touch @ Touch::Pressed(ceiling)) => {
                let Some((face, _)) = touch.face(self.system, j) else { return Ok(()) };
                let restitution = face.law.stop().map_or(0.0, |stop| stop.restitution);
                let approach = self.relative(j, face);
                self.collide(j, face, restitution)?;
                if restitution == 0.0 {
                    self.struck = Some(j);
                    self.touches[j] = Touch::Stopped(ceiling);
                } else {
                    self.fresh[j] = Some((ceiling, true, 1));
                }
                let departure = self.relative(j, face);
                self.record(j, met(ceiling, true), approach, departure);
            }
            // A face that cannot hold what strikes it has been struck and no more.
            (End::LetGo, Touch::Held(ceiling)) if self.struck == Some(j) => {
                self.touches[j] = Touch::Flight;
                self.fresh[j] = Some((ceiling, false, 2));
            }
            (End::LetGo, Touch::Stopped(ceiling)) if self.struck == Some(j) => {
                self.touches[j] = Touch::Pressed(ceiling);
                self.fresh[j] = Some((ceiling, true, 2));
            }
            (End::LetGo, Touch::Held(ceiling)) => self.leave(j, ceiling, 3),
            (End::LetGo, Touch::Stopped(ceiling)) => {
                self.touches[j] = Touch::Pressed(ceiling);
                self.fresh[j] = Some((ceiling, true, 3));
                self.record(j, EventKind::StopRelease, 0.0, 0.0);
            }
            _ => {}
        }
        Ok(())
    }

    /// A face lets go; the gap coordinate is zero up to that order.
    fn leave(&mut self, j: usize, ceiling: bool, order: usize) {
        let speed = self.touches[j].face(self.system, j).map_or(0.0, |(face, _)| self.relative(j, face));
        self.touches[j] = Touch::Flight;
        self.fresh[j] = Some((ceiling, false, order));
        self.record(j, if ceiling { EventKind::CeilingRelease } else { EventKind::FloorRelease }, speed, speed);
    }

    fn relative(&self, j: usize, face: &Face) -> f64 {
        (self.state.w[j] - dot(&face.row, &self.state.v)).near()
    }

    /// An impact with the structure.
    fn collide(&mut self, j: usize, face: &Face, restitution: f64) -> Result<(), PreciseError> {
        let answer =
            Square::of(&self.system.mass).solve(&[doubles(&face.row)]).ok_or(PreciseError::Singular)?.remove(0);
        let particle = Double::from(1.0) / Double::from(self.system.particles[j].mass);
        let speed = self.state.w[j] - dot(&face.row, &self.state.v);
        let impulse = -(speed * (1.0 + restitution)) / (particle + dot(&face.row, &answer));
        self.state.w[j] += impulse * particle;
        self.state.v.iter_mut().zip(&answer).for_each(|(v, by)| *v = *v - *by * impulse);
        Ok(())
    }

    /// An impulse on the structure: what rests on a rigid face is struck by it, or left behind.
    fn strike(&mut self, impulse: f64) -> Result<(), PreciseError> {
        let row = doubles(&self.system.force_row);
        let answer = Square::of(&self.system.mass).solve(&[row]).ok_or(PreciseError::Singular)?.remove(0);
        self.state.v.iter_mut().zip(&answer).for_each(|(v, by)| *v += *by * impulse);
        let Some(j) = self.touches.iter().position(|touch| touch.holds()) else { return Ok(()) };
        let touch = self.touches[j];
        let (Touch::Held(ceiling) | Touch::Stopped(ceiling), Some((face, _))) = (touch, touch.face(self.system, j))
        else {
            return Ok(());
        };
        let stopped = touch == Touch::Stopped(ceiling);
        let speed = self.relative(j, face);
        if away(ceiling) * speed < 0.0 {
            self.collide(j, face, 0.0)?;
            self.struck = Some(j);
            self.record(j, met(ceiling, stopped), speed, 0.0);
        } else if speed != 0.0 {
            self.phase = None;
            if stopped {
                self.touches[j] = Touch::Pressed(ceiling);
                self.fresh[j] = Some((ceiling, true, 1));
                self.record(j, EventKind::StopRelease, speed, speed);
            } else {
                self.leave(j, ceiling, 1);
            }
        }
        Ok(())
    }

    fn record(&mut self, particle: usize, kind: EventKind, approach: f64, departure: f64) {
        self.response.proof.events += 1;
        if self.options.averages(self.cycle) {
            let counts = &mut self.response.counts;
            match kind {
                EventKind::FloorContact => counts.floor_contacts += 1,
                EventKind::FloorRelease => counts.floor_releases += 1,
                EventKind::CeilingContact => counts.ceiling_contacts += 1,
                EventKind::FloorStop | EventKind::CeilingStop => counts.stops += 1,
                _ => {}
            }
        }
        if self.response.events.len() < self.options.record_events {
            let (cycle, time) = (self.cycle, self.time.near());
            self.response.events.push(Event { cycle, time, particle, kind, approach, departure });
        }
    }
}

fn met(ceiling: bool, stop: bool) -> EventKind {
    match (ceiling, stop) {
        (false, false) => EventKind::FloorContact,
        (true, false) => EventKind::CeilingContact,
        (false, true) => EventKind::FloorStop,
        (true, true) => EventKind::CeilingStop,
    }
}

/// Terms in the place of t/span.
fn scaled(terms: &[Double], span: f64) -> Vec<Double> {
    let mut power = Double::from(1.0);
    terms
        .iter()
        .map(|term| {
            let scaled = *term * power;
            power = power * span;
            scaled
        })
        .collect()
}

/// ∫₀¹ of the square.
fn square(a: &[Double]) -> Double {
    let mut sum = Double::ZERO;
    for i in 0..a.len() {
        for j in i..a.len() {
            let product = a[i] * a[j];
            // What is below the last digit of the sum is left out.
            if product.near().abs() < 1e-34 * sum.near().abs() {
                continue;
            }
            let twice = if i == j { 1.0 } else { 2.0 };
            sum += product * twice / Double::from((i + j + 1) as f64);
        }
    }
    sum
}

/// By their series, at half angles of a few steps back.
fn sin_cos(angle: Double) -> [Double; 2] {
    const HALVINGS: i32 = 6;
    let small = angle * libm::ldexp(1.0, -HALVINGS);
    let (mut sine, mut cosine) = (Double::ZERO, Double::ZERO);
    let mut term = Double::from(1.0);
    for k in 0..24_i32 {
        match k % 4 {
            0 => cosine += term,
            1 => sine += term,
            2 => cosine = cosine - term,
            _ => sine = sine - term,
        }
        term = term * small / Double::from(f64::from(k + 1));
    }
    for _ in 0..HALVINGS {
        (sine, cosine) = (sine * cosine * 2.0, cosine * cosine - sine * sine);
    }
    [sine, cosine]
}
