//! One test binary: a module per subject.

mod cli;
mod desk;
mod engine;
mod figure;
mod fixed;
mod made_up;
mod reference;
mod report;
mod spec;
mod study;
mod table;
