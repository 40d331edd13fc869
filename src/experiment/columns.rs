//! The columns that an experiment's table will have, known before anything runs.

use serde_json::json;

use super::recipe::{GapWord, Parameter};
use crate::yaml::{Findings, Span};

use super::case::Case;
use super::continuation::{BranchColumn, Continuation};
use super::definition::Experiment;
use super::figure_spec::Joined;
use super::maximise::Maximise;
use super::optimise::Optimise;
use super::starts::{BasinColumn, START_LISTS, Starts};
use crate::measure::{
    CycleSpec, CycleValue, EnergySpec, Measure, PROOF, ShapeSpec, TraceSpec, energy_columns, of_another_damper,
    shape_columns, trace_columns, unit_of_list,
};
use crate::text::name;
use crate::yaml::reader::unknown;
use crate::yaml::schema::any_of;
use crate::yaml::word::{from_word, word_of, words};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// A number a row.
    Number,
    /// A word a row: splits lines, is no axis.
    Label,
    /// A time history a row.
    History,
    /// Values of each cycle: points above a number a row.
    Cloud,
    /// A coordinate of each start: points over another one.
    Scatter,
}

impl Role {
    /// Its axis runs over lists.
    pub fn is_drawn_as_a_list(self) -> bool {
        matches!(self, Self::History | Self::Scatter)
    }
}

/// Lists that rows keep, and what they hold.
pub(crate) struct Lists {
    pub names: Vec<&'static str>,
    pub role: Role,
}

/// Columns of words of tables of all kinds.
const LABELS: [&str; 6] = [name::SWEEP, name::DIRECTION, name::SOLVER, name::VARIANT, "candidate", "stopped"];

impl Lists {
    /// Of what is kept, one at most.
    pub fn kept(
        trace: Option<&TraceSpec>,
        energies: Option<&EnergySpec>,
        shape: Option<&ShapeSpec>,
        each_cycle: Option<&CycleSpec>,
    ) -> Self {
        let (names, role) = match (trace, energies, shape, each_cycle) {
            (Some(_), ..) => (trace_columns(), Role::History),
            (_, Some(_), ..) => (energy_columns(), Role::History),
            (_, _, Some(shape), _) => (shape_columns(shape), Role::History),
            (.., Some(each)) => (vec![words::<CycleValue>()[each.of as usize]], Role::Cloud),
            _ => (Vec::new(), Role::History),
        };
        Self { names, role }
    }
}

/// The parts of an experiment that decide which columns its table has.
pub(super) struct TableParts<'t> {
    pub orbit: Option<&'t Continuation>,
    pub optimise: Option<&'t Optimise>,
    pub starts: Option<&'t Starts>,
    pub swept: &'t [Parameter],
    pub cases: &'t [Case],
    pub measures: &'t [Measure],
    pub maximise: Option<&'t Maximise>,
    pub lists: Lists,
}

impl TableParts<'_> {
    pub fn columns(&self) -> Columns {
        if let Some(orbit) = self.orbit {
            return Columns::of_branches(orbit.along, self.measures);
        }
        if let Some(optimise) = self.optimise {
            return Columns::of_candidates(optimise.bounds.len(), optimise.gaps, self.measures);
        }
        let columns = Columns::of_cases(self);
        match self.starts {
            Some(starts) => columns.with_basins(starts),
            None => columns,
        }
    }
}

impl Experiment {
    /// The columns that its table will have.
    pub(crate) fn columns(&self) -> Columns {
        let (trace, energies) = (self.trace.as_ref(), self.energies.as_ref());
        let parts = TableParts {
            orbit: self.orbit.as_ref(),
            optimise: self.optimise.as_ref(),
            starts: self.starts.as_ref(),
            swept: &self.swept,
            cases: &self.cases,
            measures: &self.measures,
            maximise: self.maximise.as_ref(),
            lists: Lists::kept(trace, energies, self.shape.as_ref(), self.each_cycle.as_ref()),
        };
        parts.columns()
    }
}

/// Columns that tell parts of a sweep apart.
fn labels(cases: &[Case]) -> Vec<&'static str> {
    let named = cases.iter().any(|case| !case.sweep.is_empty()).then_some(name::SWEEP);
    let directed = cases.iter().any(|case| case.direction.is_some()).then_some(name::DIRECTION);
    named.into_iter().chain(directed).collect()
}

/// Names of what became of a candidate.
const OUTCOME: [&str; 4] = ["fitness_in_search", "improvement", "improvement_num", "evaluations"];

/// Names of the lists of an optimisation: the best fitness after so many evaluations, and the fitness along one gap.
const SEARCHES: [&str; 5] = ["evaluation", "best_so_far", "along_gap", "fitness_along", "fitness_along_spread"];

/// Columns with what they hold, in the order of the table.
pub(crate) struct Columns {
    list: Vec<(String, Role)>,
    /// How the points of a line are joined.
    pub joined: Joined,
}

impl Columns {
    /// JSON Schema of the name of one. Those that some table has are offered; which there are depends on the rest of the file.
    pub fn offered() -> serde_json::Value {
        let parts: [&[&str]; 6] = [
            words::<Parameter>(),
            words::<Measure>(),
            &trace_columns(),
            &energy_columns(),
            words::<CycleValue>(),
            &LABELS,
        ];
        let known = parts.concat().into_iter().chain(BranchColumn::ALL.map(BranchColumn::name));
        let known = known.chain(BasinColumn::ALL.map(BasinColumn::name)).chain(START_LISTS.map(|(name, _)| name));
        let mut offered: Vec<&str> = Vec::new();
        for name in known {
            if !offered.contains(&name) {
                offered.push(name);
            }
        }
        let any = json!({"type": "string", "pattern": "^[a-z][a-z0-9_]*$"});
        any_of("A column of the table", vec![json!({"enum": offered}), any])
    }

    /// Reports a name that is none of them; `table` says whose they are.
    pub fn unknown<T>(&self, table: &str, name: &str, span: Span, findings: &Findings) -> Option<T> {
        unknown(findings, span, table, "column", name, &self.names())
    }

    /// Those of a table with a row a case.
    fn of_cases(parts: &TableParts<'_>) -> Self {
        let TableParts { swept, cases, measures, maximise, lists, .. } = parts;
        let mut list: Vec<(String, Role)> = Vec::new();
        for parameter in *swept {
            let role = if parameter.words().is_empty() { Role::Number } else { Role::Label };
            list.push((word_of(*parameter), role));
        }
        let labels = labels(cases).into_iter().chain([name::SOLVER, name::VARIANT]);
        list.extend(labels.map(|name| (name.into(), Role::Label)));
        for measure in *measures {
            let name = word_of(*measure);
            if measure.is_name() {
                list.push((name, Role::Label));
                continue;
            }
            list.extend(name::with_errors(&name).map(|name| (name, Role::Number)));
            if let Some(maximise) = maximise.filter(|maximise| maximise.measure == *measure) {
                let place = maximise.column();
                list.extend([place.clone(), name::numerical(&place)].map(|name| (name, Role::Number)));
            }
        }
        list.extend(PROOF.map(|column| (column.name.into(), Role::Number)));
        list.extend(lists.names.iter().map(|name| ((*name).into(), lists.role)));
        Self { list, joined: Joined::ByX }
    }

    /// The same with what is said of the motions that random starts end in.
    fn with_basins(mut self, starts: &Starts) -> Self {
        let role = |column: BasinColumn| if column.is_word() { Role::Label } else { Role::Number };
        self.list.extend(BasinColumn::ALL.map(|column| (column.name().into(), role(column))));
        self.list.extend(starts.lists().into_iter().map(|(name, _)| (name, Role::Scatter)));
        self
    }

    /// The columns of an optimisation of so many gaps.
    fn of_candidates(gaps: usize, word: GapWord, measures: &[Measure]) -> Self {
        let mut list: Vec<(String, Role)> = vec![("candidate".into(), Role::Label)];
        list.extend(["seed", "varied"].map(|name| (name.into(), Role::Number)));
        list.extend((1..=gaps).map(|gap| (format!("{}_{gap}", word_of(word)), Role::Number)));
        list.extend([name::SOLVER, name::VARIANT].map(|name| (name.into(), Role::Label)));
        for measure in measures {
            list.extend(name::with_errors(&word_of(*measure)).map(|name| (name, Role::Number)));
        }
        list.extend(OUTCOME.map(|name| (name.into(), Role::Number)));
        list.push(("stopped".into(), Role::Label));
        list.extend(PROOF.map(|column| (column.name.into(), Role::Number)));
        list.extend(SEARCHES.map(|name| (name.into(), Role::History)));
        Self { list, joined: Joined::ByX }
    }

    /// The columns of branches of periodic motions along a parameter.
    fn of_branches(along: Parameter, measures: &[Measure]) -> Self {
        let mut list: Vec<(String, Role)> = vec![(word_of(along), Role::Number)];
        list.extend(
            BranchColumn::ALL
                .map(|column| (column.name().into(), if column.is_word() { Role::Label } else { Role::Number })),
        );
        list.extend(
            Measure::OF_AN_ORBIT
                .map(|measure| (word_of(measure), if measure.is_name() { Role::Label } else { Role::Number })),
        );
        list.extend([name::SOLVER, name::VARIANT].map(|name| (name.into(), Role::Label)));
        for measure in measures {
            list.extend(name::with_errors(&word_of(*measure)).map(|name| (name, Role::Number)));
        }
        list.extend(PROOF.map(|column| (column.name.into(), Role::Number)));
        Self { list, joined: Joined::AlongBranches }
    }

    /// What the column `name` holds, if there is one.
    pub fn role(&self, name: &str) -> Option<Role> {
        let role = |name: &str| self.list.iter().find(|(column, _)| column == name).map(|(_, role)| *role);
        // How many dampers a row has is known when it is drawn.
        role(name).or_else(|| role(of_another_damper(name)?))
    }

    /// The unit of a column of this name; `None` for one that is neither a parameter nor measured nor kept.
    pub fn unit(name: &str) -> Option<&'static str> {
        let measured = name::without_error(name);
        let parameter = from_word(name).map(Parameter::unit);
        parameter.or_else(|| from_word(measured).map(Measure::unit)).or_else(|| unit_of_list(name))
    }

    /// True if a column of this name holds words.
    pub fn holds_words(name: &str) -> bool {
        let of_parameter = |parameter: Parameter| !parameter.words().is_empty();
        let branch = || BranchColumn::ALL.into_iter().find(|column| column.name() == name).map(BranchColumn::is_word);
        let basin = || BasinColumn::ALL.into_iter().find(|column| column.name() == name).map(BasinColumn::is_word);
        let known = from_word(name).map(of_parameter).or_else(|| from_word(name).map(Measure::is_name));
        LABELS.contains(&name) || known.or_else(branch).or_else(basin).unwrap_or(false)
    }

    /// All names.
    pub fn names(&self) -> Vec<&str> {
        self.list.iter().map(|(name, _)| name.as_str()).collect()
    }

    /// True for a name that a kept time history would have.
    pub fn is_history(name: &str) -> bool {
        trace_columns().contains(&of_another_damper(name).unwrap_or(name))
    }
}
