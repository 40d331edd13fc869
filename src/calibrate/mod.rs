//! Calibration: which values of the unstated inputs bring the entries of the reference nearest, how well each is determined,
//! and what becomes of entries that had no say.
//!
//! Every combination of the values that the file names is a variant of the assumptions, and the experiments concerned are
//! run under all of them: a full grid. So the best of it is the best there is on the grid, and the profile of an input, the
//! least residual for each of its values with all others free, is exact there. Searches of an optimisation are left out:
//! gaps that the study names are evaluated, none are looked for.

mod fit;
mod grid;
mod simulate;

pub use fit::{Calibrated, Compared, Profile, calibrated};
pub use simulate::{CalibrationError, simulate};
