//! What a run cannot reach: limit stops and ceilings that a bound on the energy keeps out of its search.
//!
//! With E the kinetic, elastic and gravitational energy and H = E − min E, impacts and dashpots only take energy, and what the
//! drive gives is bounded by
//!
//! √(2H) ≤ R = √(2H₀) + √(bᵀM⁻¹b) (Σ|J| + ∫|F| dt).
//!
//! H is a sum of terms none of which is negative: ½k(c − mg/k)² of a floor pressed in by c, ½kc² of a ceiling, mg u of a particle
//! at the height u above its floor, ½(q − q₀)ᵀK(q − q₀) with q₀ the static sag. Each of them is at most R²/2, hence
//!
//! c ≤ mg/k + R/√k,   c ≤ R/√k,   u ≤ R²/(2mg),   |ρ(q − q₀)| ≤ R √(ρK⁻¹ρᵀ),
//!
//! the last with ρ = φ_c − φ_f where the ceiling does not move as the floor does. R grows with every cycle that is driven: the
//! bound serves far surfaces, short runs and single impulses.

use std::borrow::Cow;

use super::cholesky::Cholesky;
use super::contact::Side;
use super::options::{Options, StartState, Until};
use super::system::{Drive, Face, HybridSystem, Law, Matrix, Particle, dot};

/// What rounding may add to a bound, relative to it.
const ROUNDING: f64 = 1e-9;

/// A surface that nothing but a particle far from its floor meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FarSurface {
    /// The ceiling.
    Ceiling,
    /// Limit stop of the floor.
    FloorStop,
    /// Limit stop of the ceiling.
    CeilingStop,
}

/// A surface that is proved to be out of reach of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutOfReach {
    /// Whose.
    pub particle: usize,
    /// Which.
    pub surface: FarSurface,
    /// How far away it is, m: gap clearance, or length of the stop.
    pub distance: f64,
    /// How far the particle comes at most, m.
    pub reach: f64,
}

/// A system as a run needs it.
pub(crate) struct Watched<'a> {
    /// Without what is out of reach.
    pub(crate) system: Cow<'a, HybridSystem>,
    /// By how much that is out of reach, m; the smallest margin of the run is no larger.
    pub(crate) clearance: f64,
}

impl<'a> Watched<'a> {
    /// A time history shows ceilings, whether anything meets them or not.
    pub(crate) fn of(system: &'a HybridSystem, options: &Options) -> Self {
        let mut watched = Self { system: Cow::Borrowed(system), clearance: f64::INFINITY };
        for OutOfReach { particle, surface, distance, reach } in out_of_reach(system, options) {
            watched.clearance = watched.clearance.min(distance - reach);
            if options.trace.is_none() {
                drop_surface(&mut watched.system.to_mut().particles[particle], surface);
            }
        }
        watched
    }
}

fn drop_surface(particle: &mut Particle, surface: FarSurface) {
    let stopless = |face: &mut Face| {
        if let Law::Resilient { stop, .. } = &mut face.law {
            *stop = None;
        }
    };
    match surface {
        FarSurface::Ceiling => particle.ceiling = None,
        FarSurface::FloorStop => stopless(&mut particle.floor),
        FarSurface::CeilingStop => particle.ceiling.iter_mut().for_each(stopless),
    }
}

/// The ceilings and limit stops that a run from event to event cannot reach; it does without their guards.
#[must_use]
pub fn out_of_reach(system: &HybridSystem, options: &Options) -> Vec<OutOfReach> {
    let bounded =
        system.particles.iter().any(|particle| particle.ceiling.is_some() || particle.floor.law.stop().is_some());
    // How many cycles a run takes that settles is not known before.
    if !bounded || options.until == Until::Settled {
        return Vec::new();
    }
    prove(system, options).unwrap_or_default()
}

fn prove(system: &HybridSystem, options: &Options) -> Option<Vec<OutOfReach>> {
    let answer = Cholesky::new(&system.mass).ok()?.solve(&system.force_row);
    let driven = dot(&system.force_row, &answer).sqrt() * passed(&system.drive, options);
    // From rest nearly all are within reach, and most runs need no more than that.
    let mut far = beyond(system, driven)?;
    if far.is_empty() {
        return None;
    }
    if let StartState::Given { q, rate, particles } = &options.start {
        let above = system.particles.iter().zip(particles).map(|(particle, (contact, gap, speed))| {
            let face = contact.side().face(particle);
            let offset = if contact.side() == Side::Ceiling { particle.gap } else { 0.0 };
            [dot(&face.row, q) + offset + gap, dot(&face.row, rate) + speed]
        });
        far = beyond(system, driven + (2.0 * above_rest(system, q, rate, above)?).sqrt())?;
    }
    takes_energy(system, &far).then_some(far)
}

/// Σ|J| + ∫|F| dt of a whole run.
fn passed(drive: &Drive, options: &Options) -> f64 {
    let ends = drive.ticks.iter().skip(1).map(|tick| tick.time).chain([drive.period]);
    let ticks =
        drive.ticks.iter().zip(ends).map(|(tick, end)| tick.impulse.abs() + tick.level.abs() * (end - tick.time));
    let cycles = options.cycles() as f64;
    let repeated = if drive.repeats { cycles } else { 1.0 };
    // The mean of |sin| is 2/π.
    let harmonic =
        drive.harmonic.map_or(0.0, |harmonic| std::f64::consts::FRAC_2_PI * harmonic.force.abs() * drive.period);
    repeated * ticks.sum::<f64>() + cycles * harmonic + (options.kick * drive.scale()).abs()
}

/// H of a state, of whose particles y and y′ are given.
fn above_rest(
    system: &HybridSystem,
    q: &[f64],
    rate: &[f64],
    particles: impl Iterator<Item = [f64; 2]>,
) -> Option<f64> {
    let squeezed = |face: &Face, depth: f64| match face.law {
        Law::Resilient { stiffness, .. } if depth > 0.0 => 0.5 * stiffness * depth * depth,
        _ => 0.0,
    };
    let mut energy = 0.5 * system.mass.form(rate, rate) + 0.5 * system.stiffness.form(q, q);
    let mut size = energy;
    for (particle, [y, speed]) in system.particles.iter().zip(particles) {
        let weight = particle.mass * system.gravity;
        energy += 0.5 * particle.mass * speed * speed
            + weight * y
            + squeezed(&particle.floor, dot(&particle.floor.row, q) - y);
        size += weight * y.abs();
        if let Some(ceiling) = &particle.ceiling {
            energy += squeezed(ceiling, y - dot(&ceiling.row, q) - particle.gap);
        }
        energy += 0.5 * weight * sunk(particle, system.gravity);
    }
    let (weights, sag) = sag(system)?;
    energy += 0.5 * dot(&weights, &sag);
    Some((energy + ROUNDING * size).max(0.0))
}

/// Σ mg φ_f, and how far the structure sinks under it.
fn sag(system: &HybridSystem) -> Option<(Vec<f64>, Vec<f64>)> {
    let mut weights = vec![0.0; system.mass.order];
    for particle in &system.particles {
        let weight = particle.mass * system.gravity;
        weights.iter_mut().zip(&particle.floor.row).for_each(|(sum, phi)| *sum += weight * phi);
    }
    let sag = Cholesky::new(&system.stiffness).ok()?.solve(&weights);
    Some((weights, sag))
}

/// mg/k: how far a particle sinks into its floor.
fn sunk(particle: &Particle, gravity: f64) -> f64 {
    match particle.floor.law {
        Law::Resilient { stiffness, .. } => particle.mass * gravity / stiffness,
        Law::Rigid { .. } => 0.0,
    }
}

/// What is beyond the reach of motions with √(2H) ≤ `most`.
fn beyond(system: &HybridSystem, most: f64) -> Option<Vec<OutOfReach>> {
    let mut far = Vec::new();
    for (j, particle) in system.particles.iter().enumerate() {
        let mut look = |surface: FarSurface, distance: f64, reach: f64| {
            let reach = (1.0 + ROUNDING) * reach;
            if reach < distance {
                far.push(OutOfReach { particle: j, surface, distance, reach });
            }
        };
        let compression = |face: &Face| match face.law {
            Law::Resilient { stiffness, .. } => most / stiffness.sqrt(),
            Law::Rigid { .. } => 0.0,
        };
        if let Some(stop) = particle.floor.law.stop() {
            look(FarSurface::FloorStop, stop.length, sunk(particle, system.gravity) + compression(&particle.floor));
        }
        let Some(ceiling) = &particle.ceiling else { continue };
        let height = 0.5 * most * most / (particle.mass * system.gravity);
        if height < particle.gap {
            look(FarSurface::Ceiling, particle.gap, height + approach(system, particle, ceiling, most)?);
        }
        if let Some(stop) = ceiling.law.stop() {
            look(FarSurface::CeilingStop, stop.length, compression(ceiling));
        }
    }
    Some(far)
}

/// How far a ceiling comes down to its floor.
fn approach(system: &HybridSystem, particle: &Particle, ceiling: &Face, most: f64) -> Option<f64> {
    if ceiling.row == particle.floor.row {
        return Some(0.0);
    }
    let between: Vec<f64> = ceiling.row.iter().zip(&particle.floor.row).map(|(above, below)| above - below).collect();
    let yielding = Cholesky::new(&system.stiffness).ok()?.solve(&between);
    let (_, sag) = sag(system)?;
    Some(most * dot(&between, &yielding).sqrt() + dot(&between, &sag).abs())
}

/// Nothing but the drive gives energy, as long as what is `far` is not met. Of several impacts at one instant, by Newton's
/// restitution, that holds where they are plastic.
fn takes_energy(system: &HybridSystem, far: &[OutOfReach]) -> bool {
    let is_far = |j: usize, surface: FarSurface| far.iter().any(|of| of.particle == j && of.surface == surface);
    let (mut strikers, mut bounces) = (0, false);
    for (j, particle) in system.particles.iter().enumerate() {
        let faces =
            [(Some(&particle.floor), FarSurface::FloorStop), (particle.ceiling.as_ref(), FarSurface::CeilingStop)];
        let mut strikes = false;
        for (face, stop) in faces.into_iter().filter_map(|(face, stop)| Some((face?, stop))) {
            let (damping, hard) = match face.law {
                Law::Rigid { .. } => (0.0, true),
                Law::Resilient { damping, stop: stops, .. } => (damping, stops.is_some() && !is_far(j, stop)),
            };
            let restitution = face.law.restitution();
            if damping < 0.0 || (hard && !(0.0..=1.0).contains(&restitution)) {
                return false;
            }
            strikes |= hard;
            bounces |= hard && restitution > 0.0;
        }
        strikers += u32::from(strikes);
    }
    let renewed = system.drive.half_cycles.as_ref().is_none_or(|half| half.curve.lowest()[1] >= 0.0);
    // Nothing holds up a structure without springs that carries weights.
    let springs = if system.gravity > 0.0 {
        Cholesky::new(&system.stiffness).is_ok()
    } else {
        system.gravity == 0.0 && takes(&system.stiffness, &system.mass)
    };
    renewed && springs && (strikers < 2 || !bounces) && takes(&system.damping, &system.mass)
}

/// No motion gains energy from such springs or dashpots: with a rounding of themselves as a share of M they are positive.
fn takes(matrix: &Matrix, mass: &Matrix) -> bool {
    let trace = |matrix: &Matrix| (0..matrix.order).map(|i| matrix.at(i, i)).sum::<f64>();
    let rounding = ROUNDING * trace(matrix) / trace(mass);
    if rounding == 0.0 {
        return matrix.entries.iter().all(|entry| *entry == 0.0);
    }
    let entries = matrix.entries.iter().zip(&mass.entries).map(|(own, mass)| own + rounding * mass).collect();
    Cholesky::new(&Matrix { order: matrix.order, entries }).is_ok()
}
