//! `shotdamp` reproduces a published study of particle impact dampers.
//!
//! The way of the data, in the order of use:
//!
//! 1. [`spec`] reads an experiment (YAML) into a validated [`spec::Experiment`]: units resolved, defaults filled,
//!    every mistake of the file reported at once with line and column.
//!    Its [`experiment::Recipe`], in dimensionless parameters, resolves with the [`experiment::Assumptions`] for all that the
//!    study leaves open, and records which of them it read.
//! 2. [`scene`] holds what is simulated: a [`scene::Scene`] in SI units, which compiles into a [`dynamics::HybridSystem`] that
//!    carries only the effects the scene names.
//! 3. [`dynamics`] propagates it: exactly from certified event to certified event, or with the study's fixed step; [`precise`] does
//!    it again with 32 digits, for those who want to know how exact that is.
//! 4. [`measure`] turns responses into the numbers that the study plots.
//! 5. [`optimise`] looks for the best of a function over a box, and knows nothing of what it stands for.
//! 6. [`study`] plans, runs in parallel and stores one [`table::Table`] per experiment.
//! 7. [`reference`] holds each published number and claim and gives its verdict; [`figure`] draws; [`report`] writes.
//!
//! [`calibrate`] runs experiments under many combinations of the assumptions and looks for the best of them.
//!
//! A table on disk is all that verdicts, figures and reports read.

pub mod accuracy;
pub mod atomic;
pub mod calibrate;
pub mod dynamics;
pub mod experiment;
pub mod figure;
pub mod measure;
pub mod optimise;
pub mod reference;
pub mod report;
pub mod scene;
pub mod study;
pub mod table;
pub mod text;

pub mod cli;
