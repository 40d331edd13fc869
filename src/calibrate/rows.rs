//! Of an experiment the rows and measures that entries read, so that no others are simulated.

use crate::experiment::{Case, Experiment, ParameterValue, curves};
use crate::measure::{Measure, SolverChoice};
use crate::reference::{Entry, Reading, Selection};
use crate::table::Data;
use crate::text::json;
use crate::text::name;
use crate::text::words;

/// Points of a line to either side of a value between two of them: what an interpolation, and the refinement of the line
/// there, look at.
const BESIDE: usize = 3;

/// What entries ask of one experiment.
#[derive(Debug, Default)]
pub(super) struct Wanted {
    readings: Vec<Reading>,
    every_solver: bool,
    /// What the entries read and how, as JSON: the column of a measure that no word there names is not read.
    words: String,
}

impl Wanted {
    /// Adds what an entry of the experiment `home` reads of the experiment `id`.
    pub(super) fn add(&mut self, entry: &Entry, home: &str, id: &str) {
        self.readings.extend(entry.readings(home).into_iter().filter(|reading| reading.experiment == id));
        self.every_solver |= entry.names_solver();
        self.words += &(json::line(&entry.check) + &json::line(&entry.rows));
    }

    /// The experiment with these rows and measures only, and without the searches of an optimisation: gaps that the file names are
    /// evaluated, none are looked for.
    pub(super) fn of(&self, experiment: &Experiment) -> Experiment {
        let mut part = experiment.clone();
        let near: Vec<Option<Vec<f64>>> =
            self.readings.iter().map(|reading| points_around(reading, experiment)).collect();
        let asked = |case: &Case, solver: Option<SolverChoice>| {
            self.readings.iter().zip(&near).any(|(reading, near)| {
                admits(&reading.rows, case, solver)
                    && near.as_ref().is_none_or(|points| at(reading, case).is_none_or(|x| points.contains(&x)))
            })
        };
        let mut kept: Vec<bool> = experiment.cases.iter().map(|case| asked(case, None)).collect();
        // A curve that is refined has no holes: its widest interval decides how fine it may become.
        for curve in curves(&experiment.cases, &experiment.refined) {
            let first = curve.cases.iter().position(|&case| kept[case]);
            let last = curve.cases.iter().rposition(|&case| kept[case]);
            if let (Some(first), Some(last)) = (first, last) {
                curve.cases[first..=last].iter().for_each(|&case| kept[case] = true);
            }
        }
        // A row that starts where another ended takes all rows before it along.
        for chain in experiment.chains() {
            let last = chain.iter().rposition(|&case| kept[case]);
            chain[..last.map_or(0, |last| last + 1)].iter().for_each(|&case| kept[case] = true);
        }
        let narrowed = |case: &Case| {
            let event_driven = case.solvers.contains(&SolverChoice::EventDriven);
            let filled_in = !asked(case, None);
            let wanted = |solver: &&SolverChoice| {
                (filled_in || asked(case, Some(**solver)))
                    && (self.every_solver || !event_driven || **solver == SolverChoice::EventDriven)
            };
            Case { solvers: case.solvers.iter().filter(wanted).copied().collect(), ..case.clone() }
        };
        let cases = experiment.cases.iter().zip(kept).filter(|(_, kept)| *kept).map(|(case, _)| narrowed(case));
        part.cases = cases.filter(|case| !case.solvers.is_empty()).collect();
        if let Some(optimise) = &mut part.optimise {
            optimise.searches.clear();
            optimise.two_opt_of.clear();
            optimise.landscape = None;
            let named = |name: &str| {
                let name = Data::Text(vec![name.to_owned()]);
                let admits =
                    |reading: &Reading| reading.rows.0.get("candidate").is_none_or(|allowed| allowed.admits(&name, 0));
                self.readings.iter().any(admits)
            };
            optimise.candidates.retain(|candidate| named(&candidate.name));
        }
        // Branches, and motions of random starts, are told apart by more than what is read of them.
        if part.orbit.is_none() && part.starts.is_none() {
            let read: Vec<Measure> = part.measures.iter().copied().filter(|it| self.reads(*it, experiment)).collect();
            if !read.is_empty() {
                part.measures = read;
            }
        }
        part
    }

    /// True of a measure that an entry reads, or by which the experiment finds its points.
    fn reads(&self, measure: Measure, experiment: &Experiment) -> bool {
        let column = words::of_key(&measure);
        let named = |column: &str| self.words.contains(&format!("\"{column}\""));
        let leads = experiment.refined.iter().any(|rule| match rule.measures.as_slice() {
            [] => !measure.jumps(),
            leading => leading.contains(&measure),
        });
        named(&column)
            // What tolerances leave of a measure stands beside it.
            || column.strip_suffix("_input").is_some_and(named)
            || leads
            || experiment.maximise.as_ref().is_some_and(|maximise| maximise.measure == measure)
            || experiment.optimise.as_ref().is_some_and(|optimise| optimise.measure == measure)
            || Measure::of_settled_runs().any(|other| other == measure)
    }
}

/// Whether the rows of a case may be meant. A condition on a column that is no parameter of the sweep excludes nothing.
fn admits(rows: &Selection, case: &Case, solver: Option<SolverChoice>) -> bool {
    rows.0.iter().all(|(column, allowed)| {
        let cell = match column.as_str() {
            name::SWEEP => Some(Data::Text(vec![case.sweep.clone()])),
            name::DIRECTION => Some(Data::Text(vec![case.direction.as_ref().map(words::of_key).unwrap_or_default()])),
            name::SOLVER => solver.map(|solver| Data::Text(vec![solver.label()])),
            name => cell(case, name),
        };
        cell.is_none_or(|cell| allowed.admits(&cell, 0))
    })
}

/// The cell of a case as its table has it; none for a parameter that the case does not set.
fn cell(case: &Case, column: &str) -> Option<Data> {
    let (_, value) = case.values.iter().find(|(parameter, _)| words::of_key(parameter) == column)?;
    Some(match value {
        ParameterValue::Number(x) => Data::Float(vec![*x]),
        ParameterValue::Infinite => Data::Float(vec![f64::INFINITY]),
        word => Data::Text(vec![words::of_key(word)]),
    })
}

/// The case's value of the parameter between whose points the reading interpolates.
fn at(reading: &Reading, case: &Case) -> Option<f64> {
    let (over, _) = reading.around.as_ref()?;
    case.values.iter().find_map(|(parameter, value)| match value {
        ParameterValue::Number(x) if words::of_key(parameter) == *over => Some(*x),
        _ => None,
    })
}

/// The points of the lines around the value that is read.
fn points_around(reading: &Reading, experiment: &Experiment) -> Option<Vec<f64>> {
    let (over, printed) = reading.around.as_ref()?;
    let parameter = experiment.swept.iter().find(|parameter| words::of_key(*parameter) == *over)?;
    let (value, _) = printed.converted_to(parameter.unit())?;
    let mut points: Vec<f64> = experiment
        .cases
        .iter()
        .filter(|case| admits(&reading.rows, case, None))
        .filter_map(|c| at(reading, c))
        .collect();
    points.sort_by(f64::total_cmp);
    points.dedup();
    let above = points.partition_point(|x| *x <= value);
    let last = (above + BESIDE).min(points.len());
    Some(points[above.saturating_sub(BESIDE)..last].to_vec())
}
