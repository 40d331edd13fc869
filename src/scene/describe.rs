//! A scene in words and SI units, for a person who asks what is simulated.

use std::f64::consts::TAU;

use super::{
    ContactDamping, ContactEnd, Damper, Excitation, Observation, Point, PulseShape, Scene, Start, Structure, Surface,
    Take,
};
use crate::text::number::{compact, quantity};

/// Significant digits.
const DIGITS: usize = 5;

impl Scene {
    /// One line a part: structure, gravity, each damper, excitation, initial conditions.
    #[must_use]
    pub fn describe(&self) -> Vec<String> {
        let model = self.structure.model();
        let sides = model.sides();
        let mut lines = vec![model.describe()];
        lines.extend(natural_frequency(&self.structure));
        if self.dampers.is_empty() {
            lines.push("no damper".into());
        } else {
            lines.push(format!("gravity: {}", value(self.gravity, "m/s²")));
        }
        lines.extend(self.dampers.iter().map(|damper| damper.describe(&sides)));
        let at = if self.excitation.is_silent() { String::new() } else { place(self.force_at, &sides) };
        lines.push(self.excitation.describe() + &at);
        if !sides.is_empty() {
            lines.push(self.observed.describe(&sides));
        }
        lines.extend(self.start.as_ref().map(Start::describe));
        lines
    }
}

/// The first natural frequency, and how far off it is where a model of few coordinates has another than the continuous structure;
/// nothing of a structure without a spring.
fn natural_frequency(structure: &Structure) -> Option<String> {
    let model = structure.model();
    let own = model.natural_frequencies().first().copied().filter(|own| *own > 0.0)?;
    let first = if model.sides().is_empty() { "" } else { "first " };
    let line = format!("{first}natural frequency {} ({})", value(own, "rad/s"), value(own / TAU, "Hz"));
    let off = model.exact_frequency(1).map_or(0.0, |exact| own / exact - 1.0);
    if off.abs() <= 0.01 {
        return Some(line);
    }
    let side = if off > 0.0 { "above" } else { "below" };
    let percent = compact(100.0 * off.abs(), 2);
    Some(format!("{line}, {percent} % {side} the continuous structure's: more modes bring it nearer"))
}

impl Damper {
    fn describe(&self, sides: &[f64]) -> String {
        let gap =
            if self.gap.is_finite() { format!("gap {}", value(self.gap, "m")) } else { "no ceiling in reach".into() };
        let enclosure = if self.enclosure_mass > 0.0 {
            format!(", enclosure {}", value(self.enclosure_mass, "kg"))
        } else {
            String::new()
        };
        let particle = value(self.particle_mass, "kg");
        let mut parts = vec![format!("damper{}: particle {particle}{enclosure}", place(self.at, sides)), gap];
        if self.floor == self.ceiling {
            parts.push(format!("floor and ceiling {}", self.floor.describe()));
        } else {
            parts.push(format!("floor {}", self.floor.describe()));
            parts.push(format!("ceiling {}", self.ceiling.describe()));
        }
        if let Some(stop) = self.stop {
            let restitution = compact(stop.restitution, DIGITS);
            parts.push(format!("limit stop at {} with restitution {restitution}", value(stop.length, "m")));
        }
        if let Some(walls) = self.walls {
            parts.push(format!(
                "soft walls {}, {}, ceiling side {}",
                value(walls.stiffness, "N/m"),
                value(walls.damping, "N s/m"),
                value(walls.ceiling_mass, "kg")
            ));
        }
        parts.join("; ")
    }
}

impl Surface {
    fn describe(&self) -> String {
        match self {
            Self::Rigid { restitution } => format!("rigid with restitution {}", compact(*restitution, DIGITS)),
            Self::Resilient { stiffness, damping, ends } => {
                let damping = match damping {
                    ContactDamping::Constant(constant) => value(*constant, "N s/m"),
                    ContactDamping::EquivalentViscous(_) => "equivalent viscous damping by half cycles".into(),
                };
                let ends = match ends {
                    ContactEnd::ZeroGap => "",
                    ContactEnd::ZeroForce => ", without tension",
                };
                format!("resilient {}, {damping}{ends}", value(*stiffness, "N/m"))
            }
        }
    }
}

impl Observation {
    fn describe(&self, sides: &[f64]) -> String {
        match (self.points.as_slice(), self.take) {
            ([point], _) => format!("observed{}", place(*point, sides)),
            (points, Take::Largest) => format!("observed at {} points, the largest counts", points.len()),
            (points, Take::Mean) => format!("observed at {} points, their mean counts", points.len()),
        }
    }
}

/// ` at 0.96 m`, ` at (0.25, 0.5) m`; nothing where there are no sides.
fn place(at: Point, sides: &[f64]) -> String {
    let short = |x: f64| compact(x, DIGITS);
    match sides.len() {
        0 => String::new(),
        1 => format!(" at {}", value(at.x, "m")),
        _ => format!(" at ({}, {}) m", short(at.x), short(at.y)),
    }
}

impl Excitation {
    fn describe(&self) -> String {
        match self {
            Self::SingleImpulse { impulse: 0.0, .. } => "no force".into(),
            Self::SingleImpulse { impulse, .. } => format!("one impulse of {} at t = 0", value(*impulse, "N s")),
            Self::ImpulseTrain { impulse, period } => {
                format!("impulses of {} every {}", value(*impulse, "N s"), value(*period, "s"))
            }
            Self::Harmonic { force, angular_frequency } => {
                format!("harmonic force of {} at {}", value(*force, "N"), value(*angular_frequency, "rad/s"))
            }
            Self::PulseTrain { impulse, period, duration, shape } => {
                let shape = match shape {
                    PulseShape::Rectangular => "rectangular",
                    PulseShape::Binomial { .. } => "binomial",
                };
                format!(
                    "{shape} pulses of {} and {} every {}",
                    value(*impulse, "N s"),
                    value(*duration, "s"),
                    value(*period, "s")
                )
            }
        }
    }
}

fn value(number: f64, unit: &str) -> String {
    quantity(number, unit, DIGITS)
}
