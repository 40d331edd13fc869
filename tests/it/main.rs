//! One test binary: a module per subject.

mod cli;
mod desk;
mod figure;
mod made_up;
mod reference;
mod report;
mod engine;
mod spec;
mod study;
mod table;
