//! One test binary: a module per subject.

mod figure;
mod made_up;
mod reference;
mod study;
mod table;
