//! One test binary: a module per subject.

#![expect(
    clippy::disallowed_methods,
    reason = "references may use the platform's functions: no bound is near the last bit"
)]
#![expect(clippy::excessive_precision, reason = "published numbers stand as published")]

mod cli;
mod desk;
mod engine;
mod figure;
mod fixed;
mod made_up;
mod reference;
mod refined;
mod report;
mod spec;
mod structures;
mod study;
mod table;
