//! One test binary: a module per subject.

mod figure;
mod made_up;
mod report;
mod study;
mod table;
