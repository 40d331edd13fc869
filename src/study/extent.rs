//! How much of an experiment is to be simulated: the rows that no earlier table has, and how long they will take.

use std::borrow::Cow;

use super::asked::rigours_of_others;
use super::job::{self, Job, evaluations, jobs, units};
use super::known_rows::KnownRows;
use super::layout::Layout;
use super::plan::Item;
use super::refine;
use super::row_failure::RowFailure;
use super::row_fingerprint::RowFingerprints;
use super::spent::Spent;
use crate::experiment::{Case, Experiment, RowSource};
use crate::measure::Rigour;

/// What is to be simulated of an experiment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// Rows to be simulated, of random starts cases. A row that shares another's numbers is not.
    pub to_do: usize,
    /// All rows.
    pub rows: usize,
    /// More rows may follow, where curves bend.
    pub open: bool,
    /// Simulations that it takes at most.
    pub simulations: u64,
    /// Processor time that it will take, s, by what earlier runs took; `None` where there was none.
    pub seconds: Option<f64>,
}

impl Item {
    /// What there is to do beside what is known.
    #[must_use]
    pub fn extent(&self, layout: &Layout, known: &KnownRows) -> Extent {
        let experiment = &self.source.experiment;
        let spent = Spent::read(layout, &experiment.id);
        let (rows, simulations) = self.size();
        if let RowSource::Basins(starts) = experiment.row_source() {
            let jobs = jobs(experiment, &self.variants);
            let fingerprints = RowFingerprints::new(experiment).all(&self.variants, &jobs);
            let own = |row: &usize| jobs[*row].same_as.is_none();
            let to_do = (0..rows).filter(own).filter(|&row| known.group(fingerprints[row]).is_none()).count();
            let simulations = to_do as u64 * u64::from(starts.count);
            let seconds = if to_do == 0 { Some(0.0) } else { spent.each().map(|each| each * simulations as f64) };
            return Extent { to_do, rows, open: false, simulations, seconds };
        }
        if experiment.is_whole() {
            let done = Extent { to_do: 0, rows, open: false, simulations: 0, seconds: Some(0.0) };
            return match known.whole() {
                Some(_) => done,
                // How soon its searches or branches end is not known before.
                None => Extent { to_do: rows, simulations, seconds: spent.total(), ..done },
            };
        }
        let experiment = &self.with_known_points(known);
        let jobs = jobs(experiment, &self.variants);
        let fingerprints = RowFingerprints::new(experiment).all(&self.variants, &jobs);
        let is_known = |unit: &Vec<usize>| unit.iter().all(|&row| known.has(fingerprints[row]));
        let units = units(experiment, &jobs).into_iter().filter(|unit| !is_known(unit));
        let to_do: Vec<&Job> = units.flatten().map(|row| &jobs[row]).collect();
        let all = Extent { to_do: to_do.len(), rows: jobs.len(), open: false, simulations, seconds: None };
        let seconds: Option<f64> = to_do.iter().map(|job| ahead(experiment, job, &spent)).sum();
        if experiment.refined.is_empty() {
            let simulations = to_do.iter().map(|job| evaluations(experiment, job)).sum();
            return Extent { simulations, seconds, ..all };
        }
        if to_do.is_empty() {
            return Extent { simulations: 0, seconds: Some(0.0), ..all };
        }
        // A missing row brings others with it; how many is estimated in proportion, if an earlier run went so far.
        let share = to_do.len() as f64 / jobs.len() as f64;
        let in_proportion = spent.total().map(|total| total * share);
        Extent { open: true, seconds: in_proportion.map(|most| most.max(seconds.unwrap_or(0.0))), ..all }
    }

    /// The experiment with the points that its curves get, as far as they follow from what is known.
    fn with_known_points(&self, known: &KnownRows) -> Cow<'_, Experiment> {
        let experiment = &self.source.experiment;
        if experiment.refined.is_empty() || known.is_empty() {
            return Cow::Borrowed(experiment);
        }
        let fingerprints = RowFingerprints::new(experiment);
        let look = |case: &Case| {
            let job = job::first_of(case);
            let row = known.row(experiment, fingerprints.of(&self.variants[0], case, &job));
            row.ok_or(RowFailure::NotComputed)
        };
        let cases = refine::points(experiment, &self.variants[0].assumptions, &look)
            .into_iter()
            .map(|point| point.case)
            .collect();
        Cow::Owned(Experiment { cases, ..experiment.clone() })
    }
}

/// What a row will take, s.
fn ahead(experiment: &Experiment, job: &Job, spent: &Spent) -> Option<f64> {
    let Job { solver, .. } = *job;
    // A mean is one simulation for each of its settings.
    let each = experiment.mean_over.len().max(1) as u64;
    let all = evaluations(experiment, job);
    let results = u64::from(job.variant == 0).min(all);
    let of = |rigours: &[Rigour], count| spent.ahead(solver, rigours, each * count);
    Some(of(&[Rigour::Result], results)? + of(rigours_of_others(experiment), all - results)?)
}
