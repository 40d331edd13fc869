//! The engine against references that no code of this repository made: 128-bit arithmetic, closed forms, conserved
//! quantities, changes of units.

mod any_instant;
mod arrays;
mod averages;
mod bench;
mod branching;
mod closed_forms;
mod closed_loops;
mod critical_damping;
mod drawn_scenes;
mod elasticities;
mod equal_modes;
mod event_cases;
mod extremes;
mod floating;
mod half_cycles;
mod hard_cases;
mod linear;
mod long_runs;
mod motion;
mod one_impact_a_face;
mod orbits;
mod precise;
mod properties;
mod pulses;
mod random_scenes;
mod reach;
mod reference_cases;
mod repeated;
mod resonance;
mod search;
mod settled;
mod small_steps;
mod sticking;
mod time_in_contact;
mod upside_down;
mod walls;

pub use bench::note;
pub(crate) use closed_forms::expected;
