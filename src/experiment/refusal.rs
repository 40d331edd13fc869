//! Why a case of an experiment cannot run, and where in the file the value stands that is refused.

use std::collections::BTreeMap;

use super::case::Case;
use super::definition::Experiment;
use super::line::{exactly, part_of};
use super::recipe::{Parameter, Part, RecipeError};
use crate::yaml::word::word_of;
use crate::yaml::{Node, Span, Value};

/// Where the values of an experiment's cases are written.
pub(super) struct Places<'t> {
    /// What stands under `scene`.
    pub scene: &'t Node,
    /// The experiment.
    pub whole: &'t Node,
    /// What it leaves to the sweep.
    pub left_to_sweep: &'t [(Parameter, Span)],
    /// Where a parameter is swept, or where its maximum is looked for.
    pub parameters: BTreeMap<Parameter, Span>,
    /// Where the particles of random starts stand.
    pub starts: Option<Span>,
}

impl Places<'_> {
    pub fn of(&self, meant: &Meant, experiment: &Experiment, case: &Case) -> Span {
        // Of a union only the case's own sweep counts.
        let sets = |parameter: Parameter| case.get(parameter).is_some() || !experiment.swept.contains(&parameter);
        let swept = |is_meant: &dyn Fn(Parameter) -> bool| {
            let mut all = self.parameters.iter();
            all.find(|(parameter, _)| sets(**parameter) && is_meant(**parameter)).map(|(_, at)| *at)
        };
        let written = |within: &Node, keys: &[&str], of_part: &dyn Fn(Parameter) -> bool| {
            let value = keys.iter().find_map(|key| exactly(within, key));
            let is_one = |parameter: Parameter| of_part(parameter) && keys.contains(&word_of(parameter).as_str());
            // Where no value of the scene is left to the sweep, it replaces what is stated.
            let is_left = |parameter: Parameter| self.left_to_sweep.iter().any(|(left, _)| *left == parameter);
            let replaces = |parameter: Parameter| case.get(parameter).is_some() && !is_left(parameter);
            let is_replaced = experiment.swept.iter().any(|&one| replaces(one) && is_one(one));
            let stated = value.filter(|value| !is_replaced && !is_left_open(value)).map(|value| value.span);
            stated.or_else(|| swept(&is_one)).unwrap_or(value.unwrap_or(within).span)
        };
        let found = match meant {
            Meant::Parameter(parameter) => swept(&|one| one == *parameter),
            Meant::Part { part: Part::Start, .. } if self.starts.is_some() => self.starts,
            Meant::Part { part, under, keys } => {
                let whole = part_of(self.scene, *part);
                let within = whole.map(|whole| under.and_then(|key| exactly(whole, key)).unwrap_or(whole));
                let any = |parameter: Parameter| parameter.part() == Some(part.kind()) && parameter.words().is_empty();
                match within {
                    Some(within) if keys.is_empty() && under.is_some() => Some(within.span),
                    _ if keys.is_empty() => swept(&any).or(within.map(|within| within.span)),
                    _ => Some(written(within.unwrap_or(self.scene), keys, &|parameter| {
                        parameter.part().is_none_or(|of| of == part.kind())
                    })),
                }
            }
            Meant::Keys(keys) => Some(written(self.scene, keys, &|_| true)),
            Meant::Run(key) => {
                // A sweep of a union may have solvers of its own.
                let of_run = exactly(self.whole, "run").and_then(|run| exactly(run, key));
                of_run.or_else(|| exactly(self.whole, key)).map(|node| node.span)
            }
            Meant::Case => swept(&|one| case.get(one).is_some()),
        };
        found.unwrap_or(self.scene.span)
    }
}

/// The scene leaves the value, or a part of it, to the sweep or to an assumption.
fn is_left_open(node: &Node) -> bool {
    match &node.value {
        Value::Nothing => false,
        Value::Scalar(word) => node.value.is_swept() || word == "assumed",
        Value::Sequence(items) => items.iter().any(is_left_open),
        Value::Mapping(entries) => entries.iter().any(|entry| entry.key == "assumed" || is_left_open(&entry.node)),
    }
}

/// What of a case is refused.
#[derive(Default)]
pub(super) enum Meant {
    #[default]
    Case,
    Parameter(Parameter),
    /// A part of the scene; of the values under a key of it the one by one of these words, if there are any.
    Part {
        part: Part,
        under: Option<&'static str>,
        keys: Vec<&'static str>,
    },
    /// The value under this key of `run`.
    Run(&'static str),
    /// The value by one of these words.
    Keys(Vec<&'static str>),
}

impl Meant {
    /// All of a part.
    pub fn whole(part: Part) -> Self {
        Self::Part { part, under: None, keys: Vec::new() }
    }
}

/// Why a case cannot run.
#[derive(Default)]
pub(super) struct Refusal {
    pub message: String,
    pub place: Meant,
    /// It stands where nothing moves.
    pub still: bool,
}

impl From<String> for Refusal {
    fn from(message: String) -> Self {
        Self { message, ..Self::default() }
    }
}

impl From<RecipeError> for Refusal {
    fn from(error: RecipeError) -> Self {
        match error {
            RecipeError::NothingToVary { parameter, what } => Self {
                message: format!("`{}` is swept, but the scene has {what}", word_of(parameter)),
                place: Meant::Parameter(parameter),
                ..Self::default()
            },
            error @ RecipeError::Assumption(_) => error.to_string().into(),
            RecipeError::OutOfRange { message, part, under, keys } => Self {
                message,
                place: match part {
                    Some(part) => Meant::Part { part, under, keys },
                    None if keys.is_empty() => Meant::Case,
                    None => Meant::Keys(keys),
                },
                ..Self::default()
            },
            error @ RecipeError::Still { part, .. } => Self {
                message: error.to_string(),
                place: Meant::Part { part, under: None, keys: part.place_keys().into() },
                still: true,
            },
        }
    }
}
