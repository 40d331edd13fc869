//! The published numbers and claims, and what became of each.

mod verdict;

pub use verdict::{Comparison, Judged, Verdict};
