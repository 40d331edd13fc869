//! JSON Schemas (draft 7) of the files that a person writes, so that an editor completes and checks them while they are
//! written.
//!
//! Words, parameters, structures and their keys, dimensions and limits come from the types that read the files. What a
//! schema cannot say (ranges in order, columns that exist, a scene that physics accepts) the reader says, which is the judge in
//! everything: a file that it accepts passes the schema, as long as its units are written as people write them.

mod assumptions;
mod continuation;
mod experiment;
mod figure;
mod optimise;
mod parts;
mod scene;
mod starts;
mod study;
mod sweep;

pub use assumptions::assumptions_schema;
pub use experiment::experiment_schema;
pub(crate) use parts::{Object, list, text, words_of};
pub use study::study_schema;
