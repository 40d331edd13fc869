//! Calibration: which values of the unstated inputs bring the entries of the reference nearest, how well each is determined,
//! and what becomes of entries that were held out.
//!
//! A set of inputs is one value of each. The experiments whose tables the fitted entries read are run under every set that
//! the search asks for, of each experiment only the rows that are read (`rows`), each as a single run unless an ensemble is asked for;
//! experiments that do not depend on the inputs that differ are not re-run (`trials`). The search is a full grid, or goes along one
//! input after the other from several starts (`search`). All sets stay in the count: the profile of an input is the least
//! residual that was found with each of its values, exact on a full grid and an upper bound otherwise. A set is run no further
//! than it may still change the answer (`residuals`), and what was evaluated is kept for the next start (`journal`). Where it is
//! asked for, each fitted entry is left out in turn, and the sets that fit the others best predict it (`left_out`).
//!
//! In the end the inputs in force and the best ones are run once more as results, with ensembles where the motion is chaotic,
//! and all entries, those held out too, are judged by their own tolerances (`fit`).

mod finding;
mod fit;
mod journal;
mod left_out;
mod moved;
mod page;
mod residuals;
mod rows;
mod search;
mod set;
mod trials;

pub use fit::{Calibrated, CalibrationError, Compared, Profile, Read, Running, calibrate};
pub use left_out::LeftOut;
pub use moved::moved_alone;
pub use page::calibration;
pub use trials::Asked;
