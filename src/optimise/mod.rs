//! Optimisers: they look for the smallest value of a function over a box, and know nothing of what it stands for.
//!
//! Each one asks for a batch of points and is told their scores ([`Optimiser`]); [`minimise`] goes between it and the
//! function until a [`Stopping`] condition is met. The caller may evaluate a batch on as many threads as it likes: random
//! numbers depend on seed, generation and individual alone (`random`), so the same seed gives the same result.
//!
//! - [`Genetic`]: the genetic algorithm; [`CmaEs`]: the peer that it is judged against;
//! - [`two_opt`]: swaps of pairs, after a search; [`dense`]: every point of a grid, where there are few coordinates;
//! - [`polish`]: down the gradient from a point that one of them has found, where there is a gradient;
//! - [`sections`]: the function along each coordinate through a point; [`overshoot`]: how far a curve may rise between its points.

mod bounds;
mod cma_es;
mod dense;
mod eigen;
mod genetic;
mod parabola;
mod polish;
mod random;
mod search;
mod section;
mod two_opt;

pub use bounds::{Bounds, BoundsError, Spacing};
pub use cma_es::CmaEs;
pub use dense::{Dense, dense};
pub use genetic::{Genetic, GeneticSettings};
pub use parabola::{Parabola, Point, overshoot};
pub use polish::{Slope, Smooth, polish};
pub use random::Stream;
pub use search::{Batch, Found, Function, Optimiser, Score, Stalled, Step, Stopped, Stopping, Wanted, minimise};
pub use section::{Section, sections};
pub use two_opt::two_opt;
