//! Candidates to a table: a row for each, and one for each gap of the landscape.

use std::collections::BTreeMap;

use super::failures::Failures;
use super::row_failure::RowFailure;
use super::tabulate;
use super::variant::Variant;
use crate::experiment::{Experiment, GapWord, Goal, Optimise};
use crate::measure::{Evaluated, Measured, SolverChoice};
use crate::table::{Column, Data, Table};
use crate::text::name;
use crate::text::words;

/// A candidate, or a section of the landscape through one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Candidate {
    pub name: String,
    pub seed: Option<u32>,
    /// Of a section: which gap is varied, from 1.
    pub varied: Option<usize>,
    pub gaps: Vec<f64>,
    /// What the search thought of it.
    pub fitness_in_search: f64,
    pub evaluations: u64,
    /// Why the search ended.
    pub stopped: String,
    /// Evaluations and best fitness after each batch.
    pub trail: Vec<[f64; 2]>,
    /// Fitness along a section.
    pub section: Vec<AlongGap>,
    /// Index of the variant.
    pub variant: usize,
    /// What came of it; not computed: not evaluated yet, or a section.
    pub outcome: Result<Evaluated, RowFailure>,
}

/// A point of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AlongGap {
    pub gap: f64,
    /// The mean of an ensemble where the motion is chaotic, and its standard deviation.
    pub fitness: f64,
    pub spread: f64,
}

impl Candidate {
    pub(super) fn named(name: &str, gaps: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            seed: None,
            varied: None,
            gaps,
            fitness_in_search: f64::NAN,
            evaluations: 0,
            stopped: String::new(),
            trail: Vec::new(),
            section: Vec::new(),
            variant: 0,
            outcome: Err(RowFailure::NotComputed),
        }
    }

    /// In the place of all that could not be searched for.
    pub(super) fn failed(reason: RowFailure) -> Self {
        Self { outcome: Err(reason), ..Self::named("", Vec::new()) }
    }

    fn measured(&self, index: usize) -> Measured {
        let none = Measured { value: f64::NAN, numerical: f64::NAN, spread: f64::NAN };
        self.outcome.as_ref().ok().and_then(|evaluated| evaluated.measured.get(index).copied()).unwrap_or(none)
    }

    /// Why it has no numbers; empty if it has, or needs none.
    fn failure(&self) -> String {
        match &self.outcome {
            Ok(_) | Err(RowFailure::NotComputed) => String::new(),
            Err(reason) => reason.to_string(),
        }
    }
}

/// Rows without numbers that should have some.
pub(super) fn failures(candidates: &[Candidate]) -> Failures {
    Failures::of(candidates.iter().map(Candidate::failure).filter(|reason| !reason.is_empty()))
}

/// The table.
pub(super) fn table(
    experiment: &Experiment,
    variants: &[Variant],
    candidates: &[Candidate],
    metadata: BTreeMap<String, String>,
) -> Table {
    let Some(optimise) = &experiment.optimise else { return Table::default() };
    let texts = |name: &str, cell: &dyn Fn(&Candidate) -> String| {
        Column::new(name, Data::Text(candidates.iter().map(cell).collect()))
    };
    let floats = |name: &str, cell: &dyn Fn(&Candidate) -> f64| {
        Column::new(name, Data::Float(candidates.iter().map(cell).collect()))
    };
    let solver = experiment.solvers.first().copied().unwrap_or(SolverChoice::EventDriven);
    let mut columns = vec![
        texts("candidate", &|it| it.name.clone()),
        floats("seed", &|it| it.seed.map_or(f64::NAN, f64::from)),
        floats("varied", &|it| it.varied.map_or(f64::NAN, |varied| varied as f64)),
    ];
    columns.extend((0..optimise.bounds.len()).map(|gap| {
        let name = format!("{}_{}", words::of_key(&optimise.gaps), gap + 1);
        floats(&name, &|it| it.gaps.get(gap).copied().unwrap_or(f64::NAN)).with_unit(unit(optimise.gaps))
    }));
    columns.push(texts(name::SOLVER, &|_| solver.label()));
    columns
        .push(texts(name::VARIANT, &|it| variants.get(it.variant).map_or_else(String::new, |one| one.label.clone())));
    for (index, measure) in experiment.measures.iter().enumerate() {
        let of =
            |part: fn(&Measured) -> f64| Data::Float(candidates.iter().map(|it| part(&it.measured(index))).collect());
        columns.extend(tabulate::measured(*measure, of));
    }
    columns.extend(outcome(experiment, optimise, candidates));
    columns.push(texts("stopped", &|it| it.stopped.clone()));
    let evaluated: Vec<Option<&Evaluated>> = candidates.iter().map(|it| it.outcome.as_ref().ok()).collect();
    let failures = Data::Text(candidates.iter().map(Candidate::failure).collect());
    columns.extend(tabulate::trust(experiment, &evaluated, |row| candidates[row].variant == 0, failures));
    columns.extend(lists(optimise, candidates));
    Table { columns, metadata, ..Table::default() }
}

fn unit(word: GapWord) -> &'static str {
    match word {
        GapWord::Gap => "m",
        GapWord::GapRatio => "",
    }
}

/// What became of each: as its search saw it, and against the first candidate under the same assumptions.
fn outcome(experiment: &Experiment, optimise: &Optimise, candidates: &[Candidate]) -> Vec<Column> {
    let index = experiment.measures.iter().position(|measure| *measure == optimise.measure).unwrap_or(0);
    let improvement = |it: &Candidate| {
        let first = candidates.iter().find(|other| other.variant == it.variant)?;
        let (from, to) = (first.measured(index), it.measured(index));
        let better = match optimise.goal {
            Goal::Minimise => from.value - to.value,
            Goal::Maximise => to.value - from.value,
        };
        // A candidate is no better than itself, whatever it is worth.
        let same = first.gaps == it.gaps;
        Some(if same {
            [0.0, 0.0]
        } else {
            [better, (from.numerical * from.numerical + to.numerical * to.numerical).sqrt()]
        })
    };
    let part = |part: usize| {
        Data::Float(candidates.iter().map(|it| improvement(it).map_or(f64::NAN, |both| both[part])).collect())
    };
    let unit = optimise.measure.unit();
    let in_search = Data::Float(candidates.iter().map(|it| it.fitness_in_search).collect());
    let evaluations = candidates.iter().map(|it| i64::try_from(it.evaluations).unwrap_or(i64::MAX)).collect();
    vec![
        Column::new("fitness_in_search", in_search).with_unit(unit),
        Column::new("improvement", part(0)).with_unit(unit),
        Column::new("improvement_num", part(1)).with_unit(unit),
        Column::new("evaluations", Data::Int(evaluations)),
    ]
}

/// Convergence and landscape; of the baseline alone.
fn lists(optimise: &Optimise, candidates: &[Candidate]) -> Vec<Column> {
    let lists = |cell: &dyn Fn(&Candidate) -> Vec<f64>| {
        let of = |it: &Candidate| if it.variant == 0 { cell(it) } else { Vec::new() };
        Data::FloatList(candidates.iter().map(of).collect())
    };
    let trail = |part: usize| lists(&|it| it.trail.iter().map(|step| step[part]).collect());
    let section = |part: fn(&AlongGap) -> f64| lists(&|it| it.section.iter().map(part).collect());
    let fitness = optimise.measure.unit();
    vec![
        Column::new("evaluation", trail(0)),
        Column::new("best_so_far", trail(1)).with_unit(fitness),
        Column::new("along_gap", section(|point| point.gap)).with_unit(unit(optimise.gaps)),
        Column::new("fitness_along", section(|point| point.fitness)).with_unit(fitness),
        Column::new("fitness_along_spread", section(|point| point.spread)).with_unit(fitness),
    ]
}
