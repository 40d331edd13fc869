//! Experiments: YAML to validated types, with every mistake reported at once, with line and column.
//!
//! A tree of nodes that know where they stand ([`crate::yaml`]) → [`Experiment`] (units resolved, defaults filled, no places).

mod about_study;
mod assumed_schema;
mod assumption_reader;
mod assumptions_schema;
mod by_strength;
mod calibration;
mod calibration_input;
mod case;
mod check;
mod columns;
mod continuation;
mod continuation_reader;
mod continued;
mod damper;
mod definition;
mod excitation;
mod exclusions;
mod figure;
mod figure_spec;
mod finding;
mod id;
mod in_words;
mod limit;
mod line;
mod lists;
mod load;
mod looked_for;
mod map;
mod maximise;
mod measures;
mod optimise;
mod optimise_reader;
mod parts;
mod place;
mod range;
mod recipe;
mod refined;
mod refusal;
mod row_source;
mod run;
mod scaffold;
mod scene;
mod scene_reader;
mod solver;
mod start;
mod starts;
mod starts_reader;
mod stated;
mod structure;
mod surface;
mod sweep;
mod tried_case;
mod validate;

pub use about_study::{
    AboutStudy, Author, Finding, Licence, LineColour, Publication, PublicationKind, parse_study, study_schema,
};
pub use assumption_reader::parse_assumptions;
pub use assumptions_schema::assumptions_schema;
pub(crate) use by_strength::by_strength;
pub use calibration::{Calibration, CalibrationSearch, Residual, calibration_schema, parse_calibration};
pub use calibration_input::{CalibrationInput, Tried};
pub use case::{Case, Direction};
pub(crate) use columns::Columns;
pub use continuation::{BranchColumn, Continuation, Stability};
pub use continued::ContinuedSweep;
pub use definition::{Experiment, Source, Transient};
pub(crate) use figure::SCENE_DRAWING;
pub use figure_spec::{
    AnimationSpec, Axis, AxisScale, AxisUnit, Band, Best, Drawing, FigureSpec, Joined, Level, MapSpec, Mark, Only,
    Panel, PeakMarks, Strip,
};
pub use finding::{FindingError, FindingNumber, FindingText, InputSet};
pub use id::{ExperimentId, IdError};
pub use in_words::value_in_words;
pub use limit::{NoLimit, RowLimit};
pub use line::line_of;
pub(crate) use load::read;
pub use load::{load_assumptions, load_experiment};
pub(crate) use maximise::MOST_PEAKS;
pub use maximise::{Maximise, SearchPoint};
pub use optimise::{Candidate, Goal, Landscape, Optimise, Search, SearchKind, SearchSpacing};
pub(crate) use recipe::assumption_of;
pub use recipe::{
    ASSUMPTIONS, ArrayOrder, ArrayRecipe, Assumable, AssumptionEntry, AssumptionKind, AssumptionName, AssumptionSheet,
    AssumptionValue, Assumptions, Carried, ContactDampingConstant, ContactDampingRatio, ContactDampingRecipe,
    Coordinate, Cycles, DamperRecipe, ExcitationKind, ExcitationRecipe, Filling, FloorStiffness, ForcingOrNatural,
    GapRecipe, GapWord, Given, ImpulseTime, ImpulseTimeRecipe, MassReading, MassRecipe, MeanRatio, Moved,
    ObserveRecipe, Parameter, ParameterValue, Part, PlaceRecipe, PointsRecipe, Quantity, Recipe, RecipeError,
    Reference, Slot, StiffnessRecipe, StopRecipe, StrengthRecipe, StructureRecipe, SurfaceRecipe, SweptSlots, Takes,
    TimingRecipe, WallRecipe,
};
pub(crate) use refined::{Curve, curves};
pub use refined::{Refinement, Threshold};
pub use row_source::RowSource;
pub use scaffold::{scaffold, structures};
pub use starts::{BasinColumn, HeightBox, Interval, ParticleBox, Rank, START_LISTS, Starts};
pub use stated::Unsourced;
pub(crate) use validate::{Cases, parse_with};
pub use validate::{experiment_schema, parse_experiment};
