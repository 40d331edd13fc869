//! Columns beside the measures: the lists that a row may keep, and what proves it. One row below is all that a column is; what
//! makes it, what checks a figure's columns and the JSON Schema follow.

use super::energy::Energies;
use super::{EnergySpec, Evaluated, ShapeOf, ShapeSpec, TraceColumn};
use crate::dynamics::{Sample, SampledParticle};
use crate::text::name;

/// A column: its name, its unit, and its number.
pub(super) struct Kept<F> {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    of: F,
}

const fn kept<F>(name: &'static str, unit: &'static str, of: F) -> Kept<F> {
    Kept { name, unit, of }
}

/// Of a sample of the time history, with g, m/s².
type OfSample = fn(&Sample, f64) -> f64;

const STRUCTURE: [Kept<OfSample>; 4] = [
    kept("time", "s", |s, _| s.time),
    kept("base_displacement", "m", |s, _| s.displacement),
    kept("base_velocity", "m/s", |s, _| s.velocity),
    kept("base_acceleration", "m/s²", |s, _| s.acceleration),
];

/// Of a particle and its faces; those of the second damper and any further one carry its number, `particle_displacement_2`.
type OfParticle = fn(&SampledParticle) -> f64;

const PARTICLE: [Kept<OfParticle>; 5] = [
    kept("particle_displacement", "m", |p| p.height),
    kept("floor_displacement", "m", |p| p.floor),
    kept("ceiling_displacement", "m", |p| p.ceiling),
    kept("rigid_floor", "m", |p| p.rigid_floor),
    kept("rigid_ceiling", "m", |p| p.rigid_ceiling),
];

const CONTACT: [Kept<OfSample>; 2] =
    [kept("contact_damping", "N s/m", |s, _| s.damping), kept("rms_acceleration", "g", |s, g| s.half_cycle_rms / g)];

/// Of a cycle.
type OfCycle = fn(&Energies, usize) -> f64;

const ENERGIES: [Kept<OfCycle>; 7] = [
    kept("cycle", "", |_, cycle| cycle as f64),
    kept("kinetic_energy_after", "J", |energies, cycle| energies.with[cycle].after),
    kept("kinetic_energy_before", "J", |energies, cycle| energies.with[cycle].before),
    kept("undamped_kinetic_energy_after", "J", |energies, cycle| energies.without[cycle].after),
    kept("undamped_kinetic_energy_before", "J", |energies, cycle| energies.without[cycle].before),
    kept("damping_measure_of_cycle", "", Energies::damping_of),
    kept("mass_measure_of_cycle", "", Energies::mass_of),
];

/// Places of a shape, one list a side.
pub(super) const SIDES: [&str; 2] = ["x", "y"];
/// A mode, and that of the continuous structure.
pub(super) const MODE: [(&str, &str); 2] = [("shape", ""), ("exact_shape", "")];
/// A deflection, the RMS displacement of its points, and the mode that it is compared with.
pub(super) const DEFLECTION: [(&str, &str); 3] = [("shape", ""), ("rms_displacement", "m"), ("mode_shape", "")];

/// Names of the lists of a time history.
#[must_use]
pub fn trace_columns() -> Vec<&'static str> {
    let of_samples = |columns: &'static [Kept<OfSample>]| columns.iter().map(|column| column.name);
    of_samples(&STRUCTURE).chain(PARTICLE.iter().map(|column| column.name)).chain(of_samples(&CONTACT)).collect()
}

/// The list of a time history that holds `column` of the damper at `index`, counted from 0: `particle_displacement_2`.
#[must_use]
pub fn column_of_damper(column: &str, index: usize) -> String {
    if index == 0 { column.to_owned() } else { format!("{column}_{}", index + 1) }
}

/// The list of the first damper that this one is of another damper; `None` for any other name.
#[must_use]
pub fn of_another_damper(name: &str) -> Option<&'static str> {
    let (column, number) = name.rsplit_once('_')?;
    let number: usize = number.parse().ok().filter(|number| *number > 1)?;
    let known = PARTICLE.iter().find(|known| known.name == column)?;
    (column_of_damper(column, number - 1) == name).then_some(known.name)
}

/// The unit of a list of a time history or of cycles.
#[must_use]
pub fn unit_of_list(name: &str) -> Option<&'static str> {
    let samples = STRUCTURE.iter().chain(&CONTACT).map(|column| (column.name, column.unit));
    let particles = PARTICLE.iter().map(|column| (column.name, column.unit));
    let cycles = ENERGIES.iter().map(|column| (column.name, column.unit));
    let name = of_another_damper(name).unwrap_or(name);
    samples.chain(particles).chain(cycles).find(|(known, _)| *known == name).map(|(_, unit)| unit)
}

/// Names of the lists of kinetic energies.
#[must_use]
pub fn energy_columns() -> Vec<&'static str> {
    ENERGIES.iter().map(|column| column.name).collect()
}

/// Names of the lists of a shape.
#[must_use]
pub fn shape_columns(shape: &ShapeSpec) -> Vec<&'static str> {
    let sides = SIDES.iter().take(if shape.points.len() > 1 { 2 } else { 1 }).copied();
    let values = match shape.of {
        ShapeOf::Mode => &MODE[..],
        ShapeOf::Deflection => &DEFLECTION[..],
    };
    sides.chain(values.iter().map(|(name, _)| *name)).collect()
}

/// The lists of a time history.
pub(super) fn of_trace(samples: &[Sample], g: f64) -> Vec<TraceColumn> {
    let list = |column: &Kept<OfSample>| {
        let numbers = samples.iter().map(|sample| (column.of)(sample, g)).collect();
        TraceColumn::new(column.name, column.unit, numbers)
    };
    let dampers = samples.first().map_or(0, |sample| sample.particles.len());
    let of_damper = |index: usize| {
        PARTICLE.iter().map(move |column| {
            let number = |sample: &Sample| (column.of)(&sample.particles.get(index).copied().unwrap_or_default());
            TraceColumn::new(column_of_damper(column.name, index), column.unit, samples.iter().map(number).collect())
        })
    };
    let mut lists: Vec<TraceColumn> = STRUCTURE.iter().map(list).collect();
    lists.extend(of_damper(0));
    lists.extend(CONTACT.iter().map(list));
    lists.extend((1..dampers).flat_map(of_damper));
    lists
}

/// The lists of kinetic energies.
pub(super) fn of_cycles(energies: &Energies, spec: &EnergySpec) -> Vec<TraceColumn> {
    let cycles = spec.from_cycle as usize..(spec.to_cycle as usize).min(energies.with.len());
    let list = |column: &Kept<OfCycle>| cycles.clone().map(|cycle| (column.of)(energies, cycle)).collect();
    ENERGIES.iter().map(|column| TraceColumn::new(column.name, column.unit, list(column))).collect()
}

/// The number of a proof column in a row.
#[derive(Debug, Clone, Copy)]
pub enum ProofOf {
    /// A number.
    Number(fn(&Evaluated) -> f64),
    /// A residual, which audited runs alone have.
    Residual(fn(&Evaluated) -> f64),
    /// A count.
    Count(fn(&Evaluated) -> u64),
}

/// A column of what proves a row.
#[derive(Debug, Clone, Copy)]
pub struct ProofColumn {
    /// Its name.
    pub name: &'static str,
    /// Unit symbol, empty when dimensionless.
    pub unit: &'static str,
    /// What it holds.
    pub of: ProofOf,
}

const fn proof(name: &'static str, unit: &'static str, of: ProofOf) -> ProofColumn {
    ProofColumn { name, unit, of }
}

/// What proves a row, in the order of the table.
pub const PROOF: [ProofColumn; 7] = [
    proof("momentum_residual", "", ProofOf::Residual(|row| row.proof.momentum_residual)),
    proof("energy_residual", "", ProofOf::Residual(|row| row.proof.energy_residual)),
    proof("events", "", ProofOf::Count(|row| row.proof.events)),
    proof("smallest_margin", "m", ProofOf::Number(|row| row.proof.smallest_margin)),
    proof("ties", "", ProofOf::Count(|row| row.proof.ties)),
    proof("chaotic", "", ProofOf::Count(|row| row.chaotic as u64)),
    proof(name::MEMBERS, "", ProofOf::Count(|row| row.members as u64)),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_further_dampers_carry_their_number_and_those_of_one_damper_none() {
        let names = |dampers: usize| -> Vec<String> {
            let sample = Sample { particles: vec![SampledParticle::default(); dampers], ..Sample::default() };
            of_trace(&[sample], 9.81).into_iter().map(|column| column.name.into_owned()).collect()
        };
        // Undamped structures have the lists, too.
        assert_eq!(names(1), trace_columns());
        assert_eq!(names(0), trace_columns());
        assert_eq!(names(3)[trace_columns().len()..][..2], ["particle_displacement_2", "floor_displacement_2"]);
        assert_eq!(names(3).len(), trace_columns().len() + 2 * PARTICLE.len());
        for name in &names(3)[trace_columns().len()..] {
            assert!(of_another_damper(name).is_some_and(|first| trace_columns().contains(&first)), "{name}");
        }
        assert_eq!(of_another_damper("particle_displacement_1"), None);
        assert_eq!(of_another_damper("rigid_floor"), None);
    }
}
