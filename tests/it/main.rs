//! One test binary: a module per subject.

mod figure;
mod made_up;
mod study;
mod table;
