//! Branches of periodic motions.

use serde_json::{Value, json};

use super::parts::{Object, count, one_or_more};
use super::sweep;
use crate::experiment::continuation_reader::{MOST_DOUBLINGS, MOST_PERIODS, MOST_POINTS};

pub(in crate::experiment) fn continuation() -> Value {
    let start = one_or_more(
        "Where motions are taken from the ends of runs; `from` unless stated",
        json!({"description": "A value within the range", "type": ["number", "string"]}),
    );
    Object::new("Branches of periodic motions along a parameter, stable or not")
        .required("along", sweep::followed())
        .optional("start", start)
        .optional("periods", count("Forcing periods of these motions", "periods", 1, MOST_PERIODS))
        .optional(
            "doublings",
            count("How many times over doubled periods are followed", "doublings", 0, MOST_DOUBLINGS),
        )
        .optional("points", count("Points of a branch to either side of its first", "points", 1, MOST_POINTS))
        .schema()
}
