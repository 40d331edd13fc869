//! A particle impact damper: a particle between two surfaces.

use super::Point;

/// A curve through measured points (abscissa, ordinate), abscissae increasing; end values outside.
pub type Curve = Vec<[f64; 2]>;

/// One particle in its enclosure.
#[derive(Debug, Clone, PartialEq)]
pub struct Damper {
    /// Where it sits.
    pub at: Point,
    /// mp, kg.
    pub particle_mass: f64,
    /// ms, kg: fixed to the structure there.
    pub enclosure_mass: f64,
    /// Gap clearance h, m; infinite when no ceiling can be met.
    pub gap: f64,
    /// The floor, at gap coordinate u = 0.
    pub floor: Surface,
    /// The ceiling, at u = h.
    pub ceiling: Surface,
    /// Limit stop of both surfaces.
    pub stop: Option<LimitStop>,
    /// Soft lateral walls (Model 3).
    pub walls: Option<Walls>,
}

impl Damper {
    /// A particle alone between two faces of one kind, with neither enclosure mass, stop nor walls.
    #[must_use]
    pub fn between(surface: Surface, particle_mass: f64, gap: f64) -> Self {
        Self {
            at: Point::default(),
            particle_mass,
            enclosure_mass: 0.0,
            gap,
            floor: surface.clone(),
            ceiling: surface,
            stop: None,
            walls: None,
        }
    }
}

/// How a surface pushes back.
#[derive(Debug, Clone, PartialEq)]
pub enum Surface {
    /// Impulse-momentum contact (Model 1).
    Rigid {
        /// Coefficient of restitution ε, 0 to 1.
        restitution: f64,
    },
    /// Spring and dashpot (Models 2 and 3).
    Resilient {
        /// kf or kc, N/m.
        stiffness: f64,
        /// cf or cc.
        damping: ContactDamping,
        /// Where a contact ends.
        ends: ContactEnd,
    },
}

/// The dashpot of a resilient surface.
#[derive(Debug, Clone, PartialEq)]
pub enum ContactDamping {
    /// A constant, N s/m.
    Constant(f64),
    /// Equivalent viscous damping: renewed at every half cycle of the base acceleration from its RMS over the
    /// half cycle before, in units of g, by a spline through the curve (g, N s/m).
    EquivalentViscous(Curve),
}

/// Where a resilient contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactEnd {
    /// At zero gap: the contact pulls before it parts.
    ZeroGap,
    /// Where the contact force would turn to tension.
    ZeroForce,
}

/// Inelastic stop that limits the compression of a resilient surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitStop {
    /// δ, m: the largest compression.
    pub length: f64,
    /// Restitution of the impact on the stop.
    pub restitution: f64,
}

/// Soft lateral walls: the ceiling side of the enclosure is a third body tied to the base (Model 3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walls {
    /// kw, N/m.
    pub stiffness: f64,
    /// cw, N s/m.
    pub damping: f64,
    /// mt, kg, the body that carries the ceiling; taken off the base mass.
    pub ceiling_mass: f64,
}
