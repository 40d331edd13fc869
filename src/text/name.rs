//! What columns are called, where more than one part of the program has to know it.
//!
//! A number `x` stands with its errors: `x_num` is what is uncertain of the number itself, `x_spread` how far an ensemble scatters.

/// Which of several sweeps of a union a row belongs to.
pub const SWEEP: &str = "sweep";
/// Which way a continued sweep goes.
pub const DIRECTION: &str = "direction";
/// The solver.
pub const SOLVER: &str = "solver";
/// Which assumption is moved, and how; `baseline` where none is.
pub const VARIANT: &str = "variant";
/// How many runs a row is the mean of.
pub const MEMBERS: &str = "members";
/// Why a row has no numbers; empty if it has.
pub const FAILURE: &str = "failure";

const NUMERICAL: &str = "_num";
const SPREAD: &str = "_spread";

/// The column of the numerical uncertainty of a number.
#[must_use]
pub fn numerical(of: &str) -> String {
    format!("{of}{NUMERICAL}")
}

/// The column of the spread of a number.
#[must_use]
pub fn spread(of: &str) -> String {
    format!("{of}{SPREAD}")
}

/// The columns of a number with its errors.
#[must_use]
pub fn with_errors(of: &str) -> [String; 3] {
    [of.to_owned(), numerical(of), spread(of)]
}

/// The number whose error a column is by its name, or the name itself.
#[must_use]
pub fn without_error(name: &str) -> &str {
    [NUMERICAL, SPREAD].iter().find_map(|suffix| name.strip_suffix(suffix)).unwrap_or(name)
}
