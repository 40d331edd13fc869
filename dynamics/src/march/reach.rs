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

use crate::arithmetic::matrix::dot;
use crate::options::{Options, StartState, Until};
use crate::states::ground::{Ground, Sag};
use crate::system::{Drive, Face, HybridSystem, Law, Particle};

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

impl OutOfReach {
    /// How far the particle stays away from it at least, m.
    pub(crate) fn room(&self) -> f64 {
        self.distance - self.reach
    }
}

/// A system without these surfaces.
pub(crate) fn without(system: &HybridSystem, far: &[OutOfReach]) -> HybridSystem {
    let mut less = system.clone();
    let stopless = |face: &mut Face| {
        if let Law::Resilient { stop, .. } = &mut face.law {
            *stop = None;
        }
    };
    for OutOfReach { particle, surface, .. } in far {
        let particle = &mut less.particles[*particle];
        match surface {
            FarSurface::Ceiling => particle.ceiling = None,
            FarSurface::FloorStop => stopless(&mut particle.floor),
            FarSurface::CeilingStop => particle.ceiling.iter_mut().for_each(stopless),
        }
    }
    less
}

/// The ceilings and limit stops that a run from event to event cannot reach; it does without their guards.
#[must_use]
pub fn out_of_reach(system: &HybridSystem, options: &Options) -> Vec<OutOfReach> {
    far(system, options, &Ground::default())
}

/// The same of a system of which something may be known.
pub(crate) fn far(system: &HybridSystem, options: &Options, ground: &Ground) -> Vec<OutOfReach> {
    let bounded =
        system.particles.iter().any(|particle| particle.ceiling.is_some() || particle.floor.law.stop().is_some());
    // How many cycles a run takes that settles is not known before.
    if !bounded || options.until == Until::Settled {
        return Vec::new();
    }
    prove(system, options, ground).unwrap_or_default()
}

fn prove(system: &HybridSystem, options: &Options, ground: &Ground) -> Option<Vec<OutOfReach>> {
    let answer = ground.answer(system).ok()?;
    let driven = dot(&system.force_row, answer).sqrt() * passed(&system.drive, options);
    // From rest nearly all are within reach, and most runs need no more than that.
    let mut far = beyond(system, ground, driven)?;
    if far.is_empty() {
        return None;
    }
    if let (StartState::Given { q, rate, .. }, Some(particles)) = (&options.start, options.start.absolute(system)) {
        far = beyond(system, ground, driven + (2.0 * above_rest(system, ground, q, rate, &particles)?).sqrt())?;
    }
    takes_energy(system, ground, &far).then_some(far)
}

/// Σ|J| + ∫|F| dt of a whole run.
fn passed(drive: &Drive, options: &Options) -> f64 {
    let cycles = options.cycles() as f64;
    let repeated = if drive.repeats { cycles } else { 1.0 };
    // The mean of |sin| is 2/π.
    let harmonic =
        drive.harmonic.map_or(0.0, |harmonic| std::f64::consts::FRAC_2_PI * harmonic.force.abs() * drive.period);
    repeated * drive.impulse_of_ticks() + cycles * harmonic + (options.kick * drive.scale()).abs()
}

/// H of a state, of whose particles y and y′ are given.
fn above_rest(system: &HybridSystem, ground: &Ground, q: &[f64], rate: &[f64], particles: &[[f64; 2]]) -> Option<f64> {
    let squeezed = |face: &Face, depth: f64| match face.law {
        Law::Resilient { stiffness, .. } if depth > 0.0 => 0.5 * stiffness * depth * depth,
        _ => 0.0,
    };
    let mut energy = 0.5 * system.mass.form(rate, rate) + 0.5 * system.stiffness.form(q, q);
    let mut size = energy;
    for (particle, &[y, speed]) in system.particles.iter().zip(particles) {
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
    let Sag { weights, places } = ground.sag(system)?;
    energy += 0.5 * dot(weights, places);
    Some((energy + ROUNDING * size).max(0.0))
}

/// mg/k: how far a particle sinks into its floor.
fn sunk(particle: &Particle, gravity: f64) -> f64 {
    particle.floor.law.stiffness().map_or(0.0, |stiffness| particle.mass * gravity / stiffness)
}

/// What is beyond the reach of motions with √(2H) ≤ `most`.
fn beyond(system: &HybridSystem, ground: &Ground, most: f64) -> Option<Vec<OutOfReach>> {
    let mut far = Vec::new();
    for (j, particle) in system.particles.iter().enumerate() {
        let mut look = |surface: FarSurface, distance: f64, reach: f64| {
            let reach = (1.0 + ROUNDING) * reach;
            if reach < distance {
                far.push(OutOfReach { particle: j, surface, distance, reach });
            }
        };
        let compression = |face: &Face| face.law.stiffness().map_or(0.0, |stiffness| most / stiffness.sqrt());
        if let Some(stop) = particle.floor.law.stop() {
            look(FarSurface::FloorStop, stop.length, sunk(particle, system.gravity) + compression(&particle.floor));
        }
        let Some(ceiling) = &particle.ceiling else { continue };
        let weight = particle.mass * system.gravity;
        // Without weight, be it written −0, nothing ends its way.
        let height = if weight > 0.0 { 0.5 * most * most / weight } else { f64::INFINITY };
        if height < particle.gap {
            look(FarSurface::Ceiling, particle.gap, height + approach(system, ground, particle, ceiling, most)?);
        }
        if let Some(stop) = ceiling.law.stop() {
            look(FarSurface::CeilingStop, stop.length, compression(ceiling));
        }
    }
    Some(far)
}

/// How far a ceiling comes down to its floor.
fn approach(system: &HybridSystem, ground: &Ground, particle: &Particle, ceiling: &Face, most: f64) -> Option<f64> {
    if ceiling.row == particle.floor.row {
        return Some(0.0);
    }
    let between: Vec<f64> = ceiling.row.iter().zip(&particle.floor.row).map(|(above, below)| above - below).collect();
    let yielding = ground.stiffness(system)?.solve(&between);
    Some(most * dot(&between, &yielding).sqrt() + dot(&between, &ground.sag(system)?.places).abs())
}

/// Nothing but the drive gives energy, as long as what is `far` is not met. Of several impacts at one instant, by Newton's
/// restitution, that holds where they are plastic.
fn takes_energy(system: &HybridSystem, ground: &Ground, far: &[OutOfReach]) -> bool {
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
    renewed && (strikers < 2 || !bounces) && ground.takes(system)
}
