//! Experiments: YAML to validated types, with every mistake reported at once, with line and column.
//!
//! text → a tree of nodes that know where they stand → [`Experiment`] (units resolved, defaults filled, no places).
//! Every reader goes on after a mistake, so a file's problems come together: see [`Problems`].

mod about_study;
mod assumption_reader;
mod assumption_sheet;
mod at;
mod calibration;
mod check;
mod choice;
mod columns;
mod continuation;
mod continuation_reader;
mod continued;
mod definition;
mod diagnostic;
mod edit;
mod excitation;
mod exclusions;
mod figure;
mod figure_spec;
mod finding;
mod in_words;
mod keys;
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
mod quantity;
mod range;
mod reader;
mod recipe;
mod refined;
mod refusal;
mod run;
mod scaffold;
mod scene;
mod schema;
mod solver;
mod start;
mod starts;
mod starts_reader;
mod stated;
mod structure;
mod sweep;
mod validate;
mod word;
mod yaml;

pub use about_study::{
    AboutStudy, Author, Finding, Licence, LineColour, Publication, PublicationKind, parse_study, study_schema,
};
pub use assumption_reader::parse_assumptions;
pub(crate) use assumption_sheet::assumption_of;
pub use assumption_sheet::{
    ASSUMPTIONS, AssumptionEntry, AssumptionKind, AssumptionSheet, Cycles, Moved, Quantity, Takes,
};
pub(crate) use at::At;
pub use calibration::{
    Calibration, CalibrationInput, CalibrationSearch, Residual, Tried, calibration_schema, parse_calibration,
};
pub(crate) use columns::Columns;
pub use continuation::{BranchColumn, Continuation, RowSource, Stability};
pub use continued::{ContinuedSweep, Direction};
pub(crate) use definition::MOST_PEAKS;
pub use definition::{Case, Experiment, ExperimentId, IdError, Maximise, SearchPoint, Source, Transient};
pub(crate) use diagnostic::{Findings, Span, place};
pub use diagnostic::{Place, Problem, Problems, Severity};
pub(crate) use edit::{Written, set_keys};
pub(crate) use figure::SCENE_DRAWING;
pub use figure_spec::{
    AnimationSpec, Axis, AxisScale, AxisUnit, Band, Best, Drawing, FigureSpec, Joined, Level, MapSpec, Mark, Only,
    Panel, PeakMarks, Strip,
};
pub use finding::{FindingError, FindingNumber, FindingText, InputSet};
pub use in_words::value_in_words;
pub(crate) use keys::Keys;
pub use limit::{NoLimit, RowLimit};
pub use line::line_of;
pub use load::{load_assumptions, load_experiment};
pub(crate) use load::{parsed, read};
pub use optimise::{Candidate, Goal, Landscape, Optimise, Search, SearchKind, SearchSpacing};
pub use quantity::{Dimension, QuantityError, parse_number, parse_quantity};
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
pub use schema::assumptions_schema;
pub(crate) use schema::{described, words_of};
pub use starts::{BasinColumn, HeightBox, Interval, ParticleBox, Rank, START_LISTS, Starts};
pub use stated::Unsourced;
pub(crate) use validate::{Cases, parse_with};
pub use validate::{experiment_schema, parse_experiment};
pub(crate) use word::did_you_mean;
pub(crate) use yaml::Value;
