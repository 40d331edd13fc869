//! Continued sweeps: `along: force_ratio, direction: [up, down], from: last`. Each row starts where the row before it ended, so that
//! a motion is followed up or down a parameter for as long as it attracts; where it is left for another one depends on the
//! direction (hysteresis).

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::case::{Case, Direction, differing_in};
use super::recipe::Parameter;
use crate::yaml::word::word_of;
use crate::yaml::{At, Keys, Span};

/// Where rows start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::experiment) enum RowStart {
    /// Where the row before ended.
    Last,
}

/// A sweep whose rows follow each other.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ContinuedSweep {
    /// The sweep within a union; empty otherwise.
    pub sweep: String,
    /// The parameter that runs from row to row.
    pub along: Parameter,
}

/// The keys of a continued sweep.
pub(super) const KEYS: [&str; 3] = ["along", "direction", "from"];

/// What a sweep says of it.
pub(super) struct Continued {
    along: Option<(Parameter, Span)>,
    pub directions: Vec<Direction>,
    /// Where it says `from: last`.
    pub at: Span,
}

impl Continued {
    /// `Some(None)`: every row starts as the scene says.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    pub fn read(keys: &Keys<'_>, at: At<'_>) -> Option<Option<Self>> {
        let [along, direction, from] = KEYS;
        let (along_at, direction_at) = (keys.span_of(along), keys.span_of(direction));
        keys.rule(|| {
            json!({
                "if": {"anyOf": [{"required": [along]}, {"required": [direction]}]},
                "then": {"required": [from]},
            })
        });
        let along = keys.optional(along, "The parameter that runs from row to row", |at| {
            at.word::<Parameter>("parameter").map(|along| (along, at.span()))
        });
        let directions = keys.optional(direction, "Upwards, downwards, or both", |at| {
            let directions = at.one_or_more(|at| at.word::<Direction>("direction"))?;
            let twice = (1..directions.len()).find(|&i| directions[..i].contains(&directions[i]));
            match twice {
                Some(i) => at.wrong(format!("`{}` is said twice", word_of(directions[i]))),
                None => Some(directions),
            }
        });
        let from = keys.optional(from, "Each row starts where the row before ended", |at| {
            at.word::<RowStart>("start").map(|RowStart::Last| at.span())
        });
        let (along, directions, from) = (along?, directions?, from?);
        match (from, along_at.or(direction_at)) {
            (Some(at), _) => {
                Some(Some(Self { along, directions: directions.unwrap_or_else(|| vec![Direction::Up]), at }))
            }
            (None, None) => Some(None),
            (None, Some(given)) => at.report_at(
                given,
                "rows have an order only where each starts where the one before ended",
                Some("add `from: last`, or leave this out".into()),
            ),
        }
    }

    /// The parameter that runs, among those that these points set.
    pub fn along(&self, set: &[Parameter], within: At<'_>) -> Option<Parameter> {
        let known = || set.iter().map(|one| format!("`{}`", word_of(*one))).collect::<Vec<_>>().join(" or ");
        let (along, at) = match (self.along, set) {
            (Some(given), _) => given,
            (None, [only]) => (*only, self.at),
            (None, _) => {
                let help = format!("add `along: …` with {}", known());
                return within.report_at(self.at, "several parameters are swept: along which one?", Some(help));
            }
        };
        let name = word_of(along);
        if !set.contains(&along) {
            return within.report_at(at, format!("`{name}` is not swept here"), Some(format!("swept are {}", known())));
        }
        let other_coordinates =
            matches!(along, Parameter::Modes | Parameter::DamperCount | Parameter::Mode | Parameter::Place);
        if !along.words().is_empty() || other_coordinates {
            return within.report_at(
                at,
                format!("no state is carried along `{name}`"),
                Some("rows follow each other along a number that leaves the coordinates as they are".into()),
            );
        }
        Some(along)
    }
}

/// The cases of continued sweeps in the order in which they follow each other, chain by chain, by their index.
pub(crate) fn chains(cases: &[Case], continued: &[ContinuedSweep]) -> Vec<Vec<usize>> {
    let of_sweep = |ContinuedSweep { sweep, along }: &ContinuedSweep| {
        let place = |index: &usize| cases[*index].number(*along).unwrap_or(f64::INFINITY);
        let mut chains = differing_in(cases, sweep, *along);
        for chain in &mut chains {
            match cases[chain[0]].direction {
                Some(Direction::Down) => chain.sort_by(|a, b| place(b).total_cmp(&place(a))),
                _ => chain.sort_by(|a, b| place(a).total_cmp(&place(b))),
            }
        }
        chains
    };
    continued.iter().flat_map(of_sweep).collect()
}
