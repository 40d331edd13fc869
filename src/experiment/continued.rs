//! Continued sweeps: `along: force_ratio, direction: [up, down], from: last`. Each row starts where the row before it ended, so that
//! a motion is followed up or down a parameter for as long as it attracts; where it is left for another one depends on the
//! direction (hysteresis).

use serde::{Deserialize, Serialize};

use super::definition::{Case, differing_in};
use super::diagnostic::{Findings, Span};
use super::reader::{Fields, one_or_more, word};
use super::recipe::Parameter;
use super::word::word_of;

/// The way that rows follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// From the smallest value of the parameter to the largest.
    Up,
    /// From the largest to the smallest.
    Down,
}

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
    pub fn read(fields: &Fields<'_>, findings: &Findings) -> Option<Option<Self>> {
        let [along, direction, from] = KEYS;
        let along_at = fields.get(along).map(|node| node.span);
        let direction_at = fields.get(direction).map(|node| node.span);
        let along = fields
            .optional(along, |node| word::<Parameter>(node, "parameter", findings).map(|along| (along, node.span)));
        let directions = fields.optional(direction, |node| {
            let one = |node| word::<Direction>(node, "direction", findings);
            let directions = one_or_more(node, findings, one)?;
            let twice = (1..directions.len()).find(|&i| directions[..i].contains(&directions[i]));
            match twice {
                Some(i) => findings.wrong(node.span, format!("`{}` is said twice", word_of(directions[i]))),
                None => Some(directions),
            }
        });
        let from =
            fields.optional(from, |node| word::<RowStart>(node, "start", findings).map(|RowStart::Last| node.span));
        let (along, directions, from) = (along?, directions?, from?);
        match (from, along_at.or(direction_at)) {
            (Some(at), _) => {
                Some(Some(Self { along, directions: directions.unwrap_or_else(|| vec![Direction::Up]), at }))
            }
            (None, None) => Some(None),
            (None, Some(at)) => findings.report(
                at,
                "rows have an order only where each starts where the one before ended",
                Some("add `from: last`, or leave this out".into()),
            ),
        }
    }

    /// The parameter that runs, among those that these points set.
    pub fn along(&self, set: &[Parameter], findings: &Findings) -> Option<Parameter> {
        let known = || set.iter().map(|one| format!("`{}`", word_of(*one))).collect::<Vec<_>>().join(" or ");
        let (along, at) = match (self.along, set) {
            (Some(given), _) => given,
            (None, [only]) => (*only, self.at),
            (None, _) => {
                let help = format!("add `along: …` with {}", known());
                return findings.report(self.at, "several parameters are swept: along which one?", Some(help));
            }
        };
        let name = word_of(along);
        if !set.contains(&along) {
            return findings.report(at, format!("`{name}` is not swept here"), Some(format!("swept are {}", known())));
        }
        let other_coordinates =
            matches!(along, Parameter::Modes | Parameter::DamperCount | Parameter::Mode | Parameter::Place);
        if !along.words().is_empty() || other_coordinates {
            return findings.report(
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
