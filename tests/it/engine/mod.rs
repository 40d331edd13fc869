//! The engine against references that no code of this package made: 128-bit arithmetic, closed forms, conserved
//! quantities, changes of units. `tests/it/data/README.md` says where the data come from.

mod arrays;
mod bench;
mod closed_forms;
mod equal_modes;
mod event_cases;
mod floating;
mod linear;
mod precise;
mod reference_cases;
mod walls;
