//! One test binary: a module per subject.

#![expect(
    clippy::disallowed_methods,
    reason = "references may use the platform's functions: no bound is near the last bit"
)]
#![expect(clippy::excessive_precision, reason = "published numbers stand as published")]

mod accuracy;
mod architecture;
mod basins;
mod branches;
mod calibrate;
mod check;
mod classics;
mod clean;
mod cli;
mod continued;
mod daily;
mod desk;
mod destinations;
mod diff;
mod earlier;
mod edge_scenes;
mod engine;
mod explanations;
mod export;
mod faults;
mod figure;
mod figure_map;
mod figure_study;
mod fixed;
mod guide;
mod html;
mod left_to_sweep;
mod limits;
mod made_up;
mod measures;
mod mutations;
mod one_mistake;
mod optimise;
mod optimised;
mod reference;
mod reference_kinds;
mod reference_mistakes;
mod refined;
mod report;
mod schema;
mod shard;
mod shown;
mod solver_version;
mod spec;
mod spec_map;
mod stated;
mod structures;
mod study;
mod supports;
mod table;
mod thresholds;
mod undrawn;
mod what_stands;
