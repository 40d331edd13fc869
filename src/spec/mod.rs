//! Experiments: YAML to validated types, with every mistake reported at once, with line and column.
//!
//! text → raw types (as written, spans kept) → [`Experiment`] (units resolved, defaults filled, no spans).

mod experiment;
mod typed;

pub use experiment::{
    Axis, AxisScale, Case, Experiment, ExperimentId, FigureSpec, Level, Maximise, Panel, Settings, SolverChoice,
    Source, TraceSpec,
};
pub use typed::{Located, from_yaml};
pub(crate) use typed::{Spanned, position};
