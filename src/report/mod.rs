//! Reports: plain functions from data to text, one file per output.
//!
//! Tables and verdicts go in, text comes out; nothing here simulates, draws or touches the disk. No output holds a time,
//! a host or a path beyond the links that the caller passes in.

mod assumption;
mod branch;
mod candidate;
mod chapter;
mod committed;
pub(crate) mod comparison;
mod console;
mod diff;
mod doubts;
mod explain;
mod explanations;
mod figures;
mod finding;
mod findings;
mod github;
mod headline;
mod html;
mod in_pieces;
mod index;
mod json;
mod junit;
pub(crate) mod markdown;
mod motions;
mod movement;
mod other_pages;
mod overview;
mod page;
mod pages;
mod proof;
mod prose;
mod publication;
mod pull_request;
mod quoted;
mod reading;
mod ro_crate;
mod run;
mod strip;
mod svg;
pub(crate) mod tally;
mod tolerances;
mod verdicts;
mod view;
mod views;
mod what_stands;

pub use assumption::{assumptions, value_in_words};
pub use committed::{Departure, How, departures};
pub use console::summary;

pub use diff::{Detail, diff};
pub use doubts::doubts;
pub use explain::{EntryView, MoveView, explain};
pub use explanations::{Trial, entry, explanations, untried};
pub use figures::figure_name;
pub use finding::{CheckView, CheckedEntry, Trouble};
pub use github::{SUMMARY_LIMIT, annotations, step_summary};
pub use html::{Html, html};
pub use index::index;
pub use json::{Number, Standing, VerdictsError, json, read_json};
pub use junit::junit;
pub use motions::what_moves;
pub use movement::{Moved, Movement, between_tables, between_verdicts, standing};
pub use overview::overview_svg;
pub use page::page;
pub use pages::{NotDrawn, Published, VERDICTS, publish};
pub use publication::publication_reasons;
pub use pull_request::{PULL_REQUEST_LIMIT, pull_request};
pub use ro_crate::{CrateError, RELEASED, export_crate};
pub use strip::strip_svg;
pub use tolerances::tolerances;
pub use verdicts::{Judgement, judge_all, judge_tables, self_test_all};
pub use view::{AccuracyLinks, AssumptionView, ExperimentView, FigureView, PageView};
pub use views::{check_view, scenes, summary_of};
pub use what_stands::what_stands;
