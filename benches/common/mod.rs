//! What the benchmarks share: scenes as they are written in YAML.

use std::path::Path;

use shotdamp::dynamics::HybridSystem;
use shotdamp::experiment::Assumptions;
use shotdamp::experiment::{Experiment, load_assumptions, parse_experiment};
use shotdamp::scene::compile;

/// The scene of reference: 490 events, not chaotic; after its period.
pub const SINGLE: &str = "structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers: [{mass_ratio: 0.05, gap_ratio: 50, floor: {resilient: {stiffness_ratio: 1, damping_ratio: 0.3}}}]
  excitation: {impulse_train: {impulse: 2.171536069237626 N s, PERIOD}}";

/// Four dampers at the free end of a beam, after its modes and the damping of the floors, with its key.
pub const BEAM: &str = "structure: {cantilever_beam: {length: 1 m, width: 30 mm, thickness: 5 mm, youngs_modulus: 200 GPa, density: 7800 kg/m^3, rayleigh: 5e-5, basis: exact, modes: MODES}}
  dampers:
    - at: 0.96
      mass_ratio: 0.1
      particle_share: 0.5
      gap: 42 mm
      floor: {resilient: {stiffness: assumed, DAMPING}}
      array: {count: 4, spacing: -4 cm}
  excitation: {impulse_train: {at: 1, impulse: 0.244 N s, frequency_ratio: 1}}";

/// The assumptions in force.
pub fn assumptions() -> Assumptions {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/assumptions.yaml");
    load_assumptions(&file).unwrap_or_else(|problems| panic!("{problems}")).assumptions()
}

/// An experiment of this scene alone.
pub fn experiment(scene: &str) -> Experiment {
    let text = format!(
        "title: Benchmark\nsource: {{chapter: 3, section: '3.1'}}\nabout: Cost.\nscene:\n  {scene}\nmeasure: [rms_velocity]\n\
         figure: {{x: momentum_residual, y: energy_residual, caption: Cost.}}\n"
    );
    let id = "benchmark".parse().expect("an id");
    parse_experiment(&id, "benchmark.yaml", &text, &assumptions()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// What the scene compiles to.
pub fn system(scene: &str) -> HybridSystem {
    let scene = experiment(scene).recipe.resolve(&assumptions()).expect("the benchmarks' scenes resolve");
    compile(&scene).expect("the benchmarks' scenes compile")
}
