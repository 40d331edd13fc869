//! One test binary: a module per subject.

mod fixed;
mod spec;
