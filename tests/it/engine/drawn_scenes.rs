//! Scenes drawn by lot over all that a scene can be: structures, faces, stops, walls, equivalent damping, excitations and starts.
//! Sizes are drawn in the units of the structure, so that most scenes have something to do.

use std::collections::BTreeMap;

use shotdamp::dynamics::Spline;
use shotdamp::scene::{
    ContactDamping, ContactEnd, Curve, Damper, Excitation, FieldValue, KINDS, LimitStop, Observation, ParticleStart,
    Point, PulseShape, Scene, SingleMass, Start, Structure, Surface, Take, Values, Walls,
};

use super::arrays::Dice;

/// What the sizes of a scene are measured by.
struct Units {
    /// Of the structure, kg.
    mass: f64,
    /// Its slowest angular frequency, rad/s; of a free mass that of its drive.
    omega: f64,
    gravity: f64,
}

impl Units {
    /// How far a mass sinks into a spring of that frequency, m.
    fn length(&self) -> f64 {
        9.81 / (self.omega * self.omega)
    }

    fn speed(&self) -> f64 {
        9.81 / self.omega
    }
}

/// A scene of any kind.
pub(super) fn any_drawn_scene(seed: u64) -> Scene {
    let mut dice = Dice(seed);
    // The first draws of neighbouring seeds are alike.
    for _ in 0..3 {
        dice.between(0.0, 1.0);
    }
    let structure = structure(&mut dice);
    let model = structure.model();
    let natural = model.natural_frequencies()[0];
    let omega = if natural > 0.0 { natural } else { dice.ratio(3.0, 100.0) };
    let gravity = if dice.chance(0.05) { 0.0 } else { 9.81 };
    let units = Units { mass: model.total_mass(), omega, gravity };
    let sides = model.sides();
    let place = |dice: &mut Dice| {
        let along = |side: Option<&f64>, share: f64| side.map_or(0.0, |length| share * length);
        Point { x: along(sides.first(), dice.between(0.05, 1.0)), y: along(sides.get(1), dice.between(0.05, 0.95)) }
    };
    let single = matches!(structure, Structure::SingleMass(_));
    let count = if dice.chance(0.45) { 1 } else { 1 + dice.between(0.0, 4.99) as usize };
    let curve = dice.chance(0.15).then(|| curve(&mut dice, &units));
    let mut dampers: Vec<Damper> = (0..count).map(|_| damper(&mut dice, &units, curve.as_ref())).collect();
    dampers.iter_mut().for_each(|damper| damper.at = place(&mut dice));
    if dice.chance(0.15) {
        // An array of equal ones.
        let first = dampers[0].clone();
        dampers.iter_mut().for_each(|damper| *damper = Damper { at: damper.at, ..first.clone() });
    }
    if single && count == 1 && dice.chance(0.4) {
        let ceiling_mass = units.mass * dice.ratio(1e-3, 0.5);
        let wall = dice.ratio(0.3, 1e3) * omega;
        let damping = if dice.chance(0.3) { 0.0 } else { dice.ratio(1e-3, 1.0) };
        let [stiffness, damping] = [ceiling_mass * wall * wall, 2.0 * damping * ceiling_mass * wall];
        dampers[0].walls = Some(Walls { stiffness, damping, ceiling_mass });
    }
    let start = dice.chance(0.3).then(|| start(&mut dice, &units, single, &dampers));
    let excitation = excitation(&mut dice, &units);
    let observed = (0..1 + dice.between(0.0, 1.99) as usize).map(|_| place(&mut dice)).collect();
    let force_at = place(&mut dice);
    let observed = Observation { points: observed, take: Take::Largest };
    Scene { structure, gravity, dampers, excitation, force_at, observed, start }
}

fn structure(dice: &mut Dice) -> Structure {
    if dice.chance(0.45) {
        let (mass, omega) = (dice.ratio(0.1, 10.0), dice.ratio(3.0, 300.0));
        let damping_ratio = if dice.chance(0.3) { 0.0 } else { dice.ratio(1e-4, 2.0) };
        let omega = if dice.chance(0.03) { 0.0 } else { omega };
        return SingleMass { mass, stiffness: mass * omega * omega, damping: 2.0 * damping_ratio * mass * omega }
            .into();
    }
    let kind = *[&KINDS[1], &KINDS[2], &KINDS[3]][dice.between(0.0, 2.99) as usize];
    let rayleigh = if dice.chance(0.2) { 0.0 } else { dice.ratio(1e-6, 1e-3) };
    let plate = kind.sides.len() == 2;
    let (length, width) = (dice.between(0.4, 1.5), if plate { dice.between(0.4, 1.5) } else { 0.03 });
    let numbers = [
        ("length", length),
        ("width", width),
        ("thickness", dice.between(0.002, 0.01)),
        ("youngs_modulus", if plate { 68.9e9 } else { 200e9 }),
        ("poisson_ratio", 0.33),
        ("density", if plate { 2700.0 } else { 7800.0 }),
        ("rayleigh", rayleigh),
    ];
    let mut values: BTreeMap<String, FieldValue> =
        numbers.into_iter().map(|(key, value)| (key.into(), FieldValue::Number(value))).collect();
    let most = if plate { 2.99 } else { 5.99 };
    let modes = (0..kind.sides.len()).map(|_| 1 + dice.between(0.0, most) as u32).collect();
    values.insert("modes".into(), FieldValue::Counts(modes));
    let basis = if dice.chance(0.5) { "polynomial" } else { "exact" };
    values.insert("basis".into(), FieldValue::Word(basis.into()));
    (kind.build)(&Values { kind, values: &values }).expect("the values above make a structure")
}

fn curve(dice: &mut Dice, units: &Units) -> Curve {
    let scale = units.mass * units.omega * dice.ratio(1e-3, 0.3);
    let points = 2 + dice.between(0.0, 3.99) as usize;
    loop {
        let curve: Curve = (0..points).map(|i| [0.2 + 2.0 * i as f64, scale * dice.ratio(0.3, 3.0)]).collect();
        // Between its points a spline may fall below zero: no dashpot, and refused where it is read.
        if Spline::through(&curve).is_some_and(|spline| spline.lowest()[1] >= 0.0) {
            return curve;
        }
    }
}

fn damper(dice: &mut Dice, units: &Units, curve: Option<&Curve>) -> Damper {
    let particle_mass = units.mass * dice.ratio(1e-4, 0.5);
    let tuned = dice.chance(0.2);
    let surface = |dice: &mut Dice| {
        if curve.is_none() && dice.chance(0.4) {
            let restitution = dice.between(0.0, 1.0);
            return Surface::Rigid { restitution: if dice.chance(0.3) { 0.0 } else { restitution } };
        }
        let omega = units.omega * if tuned { 1.0 } else { dice.ratio(0.1, 300.0) };
        let damping_ratio = if dice.chance(0.1) { 0.0 } else { dice.ratio(1e-3, 3.0) };
        let constant = ContactDamping::Constant(2.0 * damping_ratio * particle_mass * omega);
        Surface::Resilient {
            stiffness: particle_mass * omega * omega,
            damping: curve.map_or(constant, |curve| ContactDamping::EquivalentViscous(curve.clone())),
            ends: if dice.chance(0.4) { ContactEnd::ZeroForce } else { ContactEnd::ZeroGap },
        }
    };
    let floor = surface(dice);
    let ceiling = if dice.chance(0.5) { floor.clone() } else { surface(dice) };
    let restitution = if dice.chance(0.5) { 0.0 } else { dice.between(0.0, 1.0) };
    let stop = dice.chance(0.35).then(|| LimitStop { length: units.length() * dice.ratio(1e-4, 100.0), restitution });
    let gap = match dice.between(0.0, 1.0) {
        ..0.06 => 0.0,
        ..0.14 => f64::INFINITY,
        _ => units.length() * dice.ratio(1e-3, 100.0),
    };
    let enclosure_mass = if dice.chance(0.3) { units.mass * dice.ratio(1e-3, 0.3) } else { 0.0 };
    Damper { particle_mass, enclosure_mass, gap, ceiling, stop, ..Damper::between(floor, particle_mass, gap) }
}

fn start(dice: &mut Dice, units: &Units, single: bool, dampers: &[Damper]) -> Start {
    let motion = |size: f64, dice: &mut Dice| if single { size * dice.between(-3.0, 3.0) } else { 0.0 };
    let (displacement, velocity) = (motion(units.length(), dice), motion(units.speed(), dice));
    let mut place = |damper: &Damper| {
        if dice.chance(0.3) {
            return ParticleStart::OnFloor;
        }
        let height = if damper.gap.is_finite() { damper.gap } else { units.length() } * dice.between(0.0, 1.0);
        let velocity = if dice.chance(0.3) { 0.0 } else { units.speed() * dice.between(-1.0, 1.0) };
        ParticleStart::InFlight { height, velocity }
    };
    Start { displacement, velocity, particles: dampers.iter().map(&mut place).collect() }
}

fn excitation(dice: &mut Dice, units: &Units) -> Excitation {
    let period = std::f64::consts::TAU / units.omega * dice.ratio(0.05, 5.0);
    let impulse = units.mass * units.speed() * dice.ratio(1e-3, 30.0);
    match dice.between(0.0, 5.99) as u32 {
        0 | 1 => Excitation::ImpulseTrain { impulse, period },
        2 => Excitation::SingleImpulse { impulse: if dice.chance(0.2) { 0.0 } else { impulse }, cycle: period },
        3 => {
            let duration = period * if dice.chance(0.1) { 1.0 } else { dice.ratio(1e-3, 1.0) };
            let impulses = 1 + dice.between(0.0, 20.0) as u32;
            let shape = if dice.chance(0.5) { PulseShape::Rectangular } else { PulseShape::Binomial { impulses } };
            Excitation::PulseTrain { impulse, period, duration, shape }
        }
        _ => {
            let gravity = if units.gravity > 0.0 { units.gravity } else { 9.81 };
            let force = units.mass * gravity * dice.ratio(1e-3, 10.0);
            // A clean structure may be driven at its own frequency, up to rounding.
            let ratio = if dice.chance(0.1) { 1.0 } else { dice.ratio(0.1, 10.0) };
            Excitation::Harmonic { force, angular_frequency: units.omega * ratio }
        }
    }
}
