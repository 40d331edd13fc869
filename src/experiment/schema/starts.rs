//! Random starts.

use serde_json::{Value, json};

use super::parts::{Object, any_of, count, list, quantity, word};
use crate::experiment::quantity::Dimension;
use crate::experiment::starts_reader::MOST_STARTS;

pub(super) fn starts() -> Value {
    let height = || interval("Height over its floor", quantity("A height", Dimension::Length));
    let share = json!({"description": "A share", "type": "number", "minimum": 0, "maximum": 1});
    let share = interval("Height over its floor as a share of the gap clearance", share);
    let velocity = |about| interval(about, quantity("A velocity", Dimension::Velocity));
    let particle = Object::new("A particle in flight")
        .exactly_one(vec![("height", height()), ("height_share", share)])
        .required("velocity", velocity("Velocity relative to its floor"))
        .schema();
    let particle = any_of("Where a particle may start", vec![particle, word("on_floor")]);
    let displacement = interval("Displacement of the mass", quantity("A displacement", Dimension::Length));
    Object::new("A box of random starts: the motions that each case may end in, with the share of the box of each")
        .required("count", count("Starts of every case", "starts", 1, MOST_STARTS))
        .optional("seed", count("Seed of the random numbers; 1 unless stated", "", 0, u32::MAX))
        .optional("displacement", displacement)
        .optional("velocity", velocity("Velocity of the mass"))
        .optional("particles", list("One a damper", particle))
        .schema()
}

/// A value, or two ends of a range.
fn interval(about: &str, value: Value) -> Value {
    let range = json!({"type": "array", "items": value, "minItems": 2, "maxItems": 2});
    any_of(about, vec![range, value])
}
