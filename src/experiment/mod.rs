//! Experiments: YAML to validated types, with every mistake reported at once, with line and column.
//!
//! A tree of nodes that know where they stand ([`crate::yaml`]) → [`Experiment`] (units resolved, defaults filled, no places).

mod about_study;
mod assumption_reader;
mod assumption_sheet;
mod assumptions_schema;
mod calibration;
mod check;
mod columns;
mod continuation;
mod continuation_reader;
mod continued;
mod definition;
mod excitation;
mod exclusions;
mod figure;
mod figure_spec;
mod finding;
mod in_words;
mod limit;
mod line;
mod lists;
mod load;
mod looked_for;
mod map;
mod measures;
mod optimise;
mod optimise_reader;
mod parts;
mod place;
mod range;
mod recipe;
mod refined;
mod refusal;
mod run;
mod scaffold;
mod scene;
mod solver;
mod start;
mod starts;
mod starts_reader;
mod stated;
mod structure;
mod sweep;
mod validate;

pub use about_study::{
    AboutStudy, Author, Finding, Licence, LineColour, Publication, PublicationKind, parse_study, study_schema,
};
pub use assumption_reader::parse_assumptions;
pub(crate) use assumption_sheet::assumption_of;
pub use assumption_sheet::{
    ASSUMPTIONS, AssumptionEntry, AssumptionKind, AssumptionSheet, Cycles, Moved, Quantity, Takes,
};
pub use assumptions_schema::assumptions_schema;
pub use calibration::{
    Calibration, CalibrationInput, CalibrationSearch, Residual, Tried, calibration_schema, parse_calibration,
};
pub(crate) use columns::Columns;
pub use continuation::{BranchColumn, Continuation, RowSource, Stability};
pub use continued::{ContinuedSweep, Direction};
pub(crate) use definition::MOST_PEAKS;
pub use definition::{Case, Experiment, ExperimentId, IdError, Maximise, SearchPoint, Source, Transient};
pub(crate) use figure::SCENE_DRAWING;
pub use figure_spec::{
    AnimationSpec, Axis, AxisScale, AxisUnit, Band, Best, Drawing, FigureSpec, Joined, Level, MapSpec, Mark, Only,
    Panel, PeakMarks, Strip,
};
pub use finding::{FindingError, FindingNumber, FindingText, InputSet};
pub use in_words::value_in_words;
pub use limit::{NoLimit, RowLimit};
pub use line::line_of;
pub use load::{load_assumptions, load_experiment};
pub(crate) use load::{parsed, read};
pub use optimise::{Candidate, Goal, Landscape, Optimise, Search, SearchKind, SearchSpacing};
pub use recipe::{
    ArrayOrder, ArrayRecipe, Assumable, AssumptionName, AssumptionValue, Assumptions, Carried, ContactDampingConstant,
    ContactDampingRatio, ContactDampingRecipe, Coordinate, DamperRecipe, ExcitationKind, ExcitationRecipe, Filling,
    FloorStiffness, ForcingOrNatural, GapRecipe, GapWord, Given, ImpulseTime, ImpulseTimeRecipe, MassReading,
    MassRecipe, MeanRatio, ObserveRecipe, Parameter, ParameterValue, Part, PlaceRecipe, PointsRecipe, Recipe,
    RecipeError, Reference, Slot, StiffnessRecipe, StopRecipe, StrengthRecipe, StructureRecipe, SurfaceRecipe,
    SweptSlots, TimingRecipe, WallRecipe,
};
pub(crate) use refined::{Curve, by_strength, curves};
pub use refined::{Refinement, Threshold};
pub use scaffold::{scaffold, structures};
pub use starts::{BasinColumn, HeightBox, Interval, ParticleBox, Rank, START_LISTS, Starts};
pub use stated::Unsourced;
pub(crate) use validate::{Cases, parse_with};
pub use validate::{experiment_schema, parse_experiment};
