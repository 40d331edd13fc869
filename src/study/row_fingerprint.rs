//! What the numbers of one row depend on, as a hash: a row whose fingerprint an earlier table has need not be simulated.
//!
//! Hashed is what the engine is asked, and not where in a sweep the row stands or what it is called: a sweep may be cut,
//! extended, renamed or written otherwise. Only the assumptions that the row's own scene depends on count.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::Serialize;

use super::asked::asked;
use super::job::{Job, units};
use super::variant::Variant;
use crate::dynamics::SOLVER_VERSION;
use crate::experiment::{Assumptions, Case, Experiment, ParameterValue, Recipe};
use crate::measure::{ENSEMBLE_OF_A_VARIANT, Rigour};
use crate::table::RowFingerprint;
use crate::text::json;

/// The fingerprints of an experiment's rows.
pub(super) struct RowFingerprints<'a> {
    experiment: &'a Experiment,
    /// Fed with what all rows share.
    shared: blake3::Hasher,
}

impl<'a> RowFingerprints<'a> {
    pub(super) fn new(experiment: &'a Experiment) -> Self {
        // Every field is named: a new one is hashed here, or with each row, or has no say.
        let Experiment {
            settings,
            measures,
            maximise,
            mean_over,
            starts,
            // With each row: its scene, and what is asked of it.
            recipe: _,
            cases: _,
            transient: _,
            trace: _,
            energies: _,
            shape: _,
            each_cycle: _,
            tolerances: _,
            // Which rows there are, and in what order.
            swept: _,
            solvers: _,
            refined: _,
            continued: _,
            moved: _,
            optimise: _,
            orbit: _,
            // What it is called, what is drawn of it, and how far it may go.
            id: _,
            title: _,
            source: _,
            about: _,
            limit: _,
            figures: _,
            without_source: _,
        } = experiment;
        let mut shared = blake3::Hasher::new();
        feed(&mut shared, &(SOLVER_VERSION, settings, measures, maximise, mean_over));
        if let Some(starts) = starts {
            feed(&mut shared, &("starts", starts));
        }
        Self { experiment, shared }
    }

    /// Of all rows.
    pub(super) fn all(&self, variants: &[Variant], jobs: &[Job]) -> Vec<RowFingerprint> {
        let own = |job: &Job| self.own(variants, job.same_as.map_or(job, |row| &jobs[row]));
        let mut all: Vec<RowFingerprint> = jobs.par_iter().map(own).collect();
        for unit in units(self.experiment, jobs) {
            link(&mut all, &unit);
        }
        for (row, job) in jobs.iter().enumerate() {
            if let Some(same) = job.same_as {
                all[row] = all[same];
            }
        }
        all
    }

    /// Of the rows of a chain.
    pub(super) fn chain(&self, variants: &[Variant], jobs: &[Job], rows: &[usize]) -> Vec<RowFingerprint> {
        let mut chain: Vec<_> = rows.iter().map(|&row| self.own(variants, &jobs[row])).collect();
        link(&mut chain, &(0..rows.len()).collect::<Vec<_>>());
        chain
    }

    fn own(&self, variants: &[Variant], job: &Job) -> RowFingerprint {
        self.of(&variants[job.variant], &self.experiment.cases[job.case], job)
    }

    /// Of a row, whose case need not be among the experiment's.
    pub(super) fn of(&self, variant: &Variant, case: &Case, job: &Job) -> RowFingerprint {
        let mut hasher = self.shared.clone();
        match self.experiment.recipe_of(case) {
            Ok(recipe) => {
                let asked = asked(self.experiment, &recipe, variant, job);
                let request = asked.request;
                let is_result = request.rigour == Rigour::Result;
                feed(&mut hasher, &(&recipe, asked.solver, is_result, request.trace, request.energies, request.shape));
                if request.rigour == Rigour::Variant {
                    feed(&mut hasher, &("ensemble", ENSEMBLE_OF_A_VARIANT));
                }
                if let Some(each_cycle) = request.each_cycle {
                    feed(&mut hasher, &("each_cycle", each_cycle));
                }
                if !request.tolerances.is_empty() {
                    feed(&mut hasher, &("tolerances", request.tolerances));
                }
                feed(&mut hasher, &self.read(&recipe, &variant.assumptions));
            }
            // It has no numbers, and no table gives it any.
            Err(_) => feed(&mut hasher, case),
        }
        RowFingerprint::of(hasher.finalize())
    }

    /// The values that the row's scene depends on, at any point of a maximisation.
    fn read<'b>(&self, recipe: &Recipe, in_force: &'b Assumptions) -> BTreeMap<String, &'b impl Serialize> {
        let mut scenes = vec![recipe.clone()];
        if let Some(maximise) = &self.experiment.maximise {
            scenes.extend(maximise.grid.iter().filter_map(|at| {
                let mut scene = recipe.clone();
                scene.set(maximise.over, ParameterValue::Number(*at)).ok().map(|()| scene)
            }));
        }
        let names = self.experiment.assumptions_of(scenes, in_force).into_iter();
        names.filter_map(|name| Some((name.to_string(), in_force.values.get(&name)?))).collect()
    }
}

/// The numbers of a row that starts where another ended depend on all that those of the other do.
fn link(fingerprints: &mut [RowFingerprint], rows: &[usize]) {
    for pair in rows.windows(2) {
        let mut hasher = blake3::Hasher::new();
        let [before, own] = [fingerprints[pair[0]], fingerprints[pair[1]]].map(|one| one.to_string());
        feed(&mut hasher, &(before, own));
        fingerprints[pair[1]] = RowFingerprint::of(hasher.finalize());
    }
}

/// Feeds a hash with the JSON of a part.
fn feed(hasher: &mut blake3::Hasher, part: &impl Serialize) {
    hasher.update(json::line(part).as_bytes()).update(b"\n");
}
