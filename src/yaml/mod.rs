//! YAML as a person writes it: a tree of nodes that know where they stand, and what readers of it share.
//!
//! text → `Node` → keys, words, quantities. A reader goes on after a mistake, so that those of a file come together ([`Problems`]), and
//! the same reader describes all that it would take, as JSON Schema (`At`).

mod at;
mod choice;
mod described;
mod diagnostic;
mod edit;
mod keys;
mod node;
mod parsed;
mod quantity;
pub(crate) mod reader;
pub(crate) mod schema;
pub(crate) mod word;

pub(crate) use at::{At, Definitions, Sketch};
pub(crate) use choice::Choice;
pub(crate) use described::{described, of_file};
pub(crate) use diagnostic::{Findings, Span, place};
pub use diagnostic::{Place, Problem, Problems, Severity};
pub(crate) use edit::{Written, set_keys};
pub(crate) use keys::{Key, Keys};
pub(crate) use node::{Entry, LONGEST, Node, Value, read_tree, too_long};
pub(crate) use parsed::parsed;
pub(crate) use quantity::{Amount, parse_amount, parse_percent, worth};
pub use quantity::{Dimension, QuantityError, parse_number, parse_quantity};
pub(crate) use schema::words_of;
pub(crate) use word::did_you_mean;
