//! Why a case of an experiment cannot run, and where in the file the value stands that is refused.

use std::collections::BTreeMap;

use super::definition::{Case, Experiment};
use super::diagnostic::Span;
use super::line::place_in;
use super::recipe::{Parameter, Part, RecipeError};
use super::word::word_of;
use super::yaml::Node;

/// Where the values of an experiment's cases are written.
pub(super) struct Places<'t> {
    /// What stands under `scene`.
    pub scene: &'t Node,
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
        let in_scene = |part: Option<Part>, keys: &[&str]| place_in(self.scene, part, keys);
        let found = match meant {
            Meant::Parameter(parameter) => swept(&|one| one == *parameter),
            Meant::Part(Part::Start, _) if self.starts.is_some() => self.starts,
            Meant::Part(part, keys) => {
                let of_part = |parameter: Parameter| parameter.part().is_none_or(|of| of == part.kind());
                let by_key = |parameter: Parameter| keys.contains(&word_of(parameter).as_str());
                let any = |parameter: Parameter| parameter.part() == Some(part.kind()) && parameter.words().is_empty();
                swept(&|one| of_part(one) && if keys.is_empty() { any(one) } else { by_key(one) })
                    .or_else(|| in_scene(Some(*part), keys))
            }
            Meant::Keys(keys) => swept(&|one| keys.contains(&word_of(one).as_str())).or_else(|| in_scene(None, keys)),
            Meant::Case => swept(&|one| case.get(one).is_some()),
        };
        found.unwrap_or(self.scene.span)
    }
}

/// What of a case is refused.
#[derive(Default)]
pub(super) enum Meant {
    #[default]
    Case,
    Parameter(Parameter),
    /// A part of the scene; of its values the one by one of these words, if there are any.
    Part(Part, Vec<&'static str>),
    /// The value by one of these words.
    Keys(Vec<&'static str>),
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
            RecipeError::OutOfRange { message, part: Some(part), keys } => {
                Self { message, place: Meant::Part(part, keys), ..Self::default() }
            }
            RecipeError::OutOfRange { message, part: None, keys } if keys.is_empty() => message.into(),
            RecipeError::OutOfRange { message, part: None, keys } => {
                Self { message, place: Meant::Keys(keys), ..Self::default() }
            }
            error @ RecipeError::Still { part, .. } => {
                Self { message: error.to_string(), place: Meant::Part(part, part.place_keys().into()), still: true }
            }
        }
    }
}
