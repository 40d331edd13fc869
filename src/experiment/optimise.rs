//! The validated optimisation: what is varied, what it is judged by, how long each optimiser looks.

use serde::{Deserialize, Serialize};

use super::recipe::GapWord;
use crate::measure::Measure;

/// An optimisation of the gaps of an array. Its rows are candidates: those that the file names, and what each search found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Optimise {
    /// Whether the fitness shall be small or large.
    pub goal: Goal,
    /// The fitness; a mean over [`super::Experiment::mean_over`], and of an ensemble where the motion is chaotic.
    pub measure: Measure,
    /// In which words gaps are told.
    pub gaps: GapWord,
    /// Bounds of each gap, m or h′; one a damper.
    pub bounds: Vec<[f64; 2]>,
    /// Gaps that are evaluated beside those that are found; the first is what improvements are measured from.
    pub candidates: Vec<Candidate>,
    /// The searches, in the order of the rows.
    pub searches: Vec<Search>,
    /// The seeds under which random searches run, each by itself.
    pub seeds: Vec<u32>,
    /// The genetic algorithm's result is improved by swaps of pairs.
    pub two_opt: bool,
    /// As are these candidates, by name; the results are called `NAME_two_opt`.
    pub two_opt_of: Vec<String>,
    /// Most generations of the genetic algorithm.
    pub generations: Option<u32>,
    /// Most evaluations of it; its peers get as many as it made, 2-opt included.
    pub evaluations: Option<u32>,
    /// Longest time of it, s. Where this ends a search, the result depends on the machine.
    pub time: Option<f64>,
    /// Function tolerance: mean relative change of the best fitness a generation.
    pub tolerance: Option<f64>,
    /// Generations over which that is taken.
    pub stalled: u32,
    /// Sections of the fitness through the best point.
    pub landscape: Option<Landscape>,
}

/// What is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// Small.
    Minimise,
    /// Large.
    Maximise,
}

/// Gaps with a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// As the table's column `candidate` holds it.
    pub name: String,
    /// One a damper, m or h′.
    pub gaps: Vec<f64>,
}

/// One optimiser with its settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Search {
    /// Genetic algorithm.
    Genetic {
        /// Individuals.
        population: u32,
        /// Individuals that live on.
        elites: u32,
        /// Share of the children that are made by crossover.
        crossover: f64,
        /// Candidates that the first population holds, by name.
        start: Vec<String>,
    },
    /// The peer, on the budget of the genetic algorithm.
    CmaEs {
        /// Individuals; 4 + 3 ln n if absent.
        population: Option<u32>,
    },
    /// Every point of a grid.
    Dense {
        /// Points along each gap.
        points: u32,
        /// How they are spaced.
        spacing: SearchSpacing,
        /// Rounds of finer grids around the best point.
        refine: u32,
    },
    /// After the others: down the gradient of settled motion from the best of all candidates.
    Polish {
        /// Most orbits with their derivatives.
        evaluations: u32,
    },
}

/// Which optimiser, as the table's column `candidate` names what it found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SearchKind {
    /// Genetic algorithm.
    Genetic,
    /// After it, swaps of pairs.
    TwoOpt,
    /// The peer.
    CmaEs,
    /// Dense search.
    Dense,
    /// Along the gradient from the best of all.
    Polish,
    /// Not a search: sections through the best point.
    Landscape,
}

impl SearchKind {
    /// All of them: names that no candidate may have.
    pub const ALL: [Self; 6] = [Self::Genetic, Self::TwoOpt, Self::CmaEs, Self::Dense, Self::Polish, Self::Landscape];
}

/// Sections of the fitness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Landscape {
    /// Points along each gap.
    pub points: u32,
    /// How they are spaced.
    pub spacing: SearchSpacing,
}

/// How points are spaced along a gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SearchSpacing {
    /// Evenly.
    #[default]
    Linear,
    /// Evenly in the logarithm.
    Log,
}

/// Most evaluations of a dense search's finer grid: three a gap.
const FINER: u64 = 3;

impl Optimise {
    /// The settings of the genetic algorithm's search, if there is one: evaluations at most.
    fn genetic_evaluations(&self) -> Option<u64> {
        let (population, elites) = self.searches.iter().find_map(|search| match search {
            Search::Genetic { population, elites, .. } => Some((u64::from(*population), u64::from(*elites))),
            _ => None,
        })?;
        let generations =
            self.generations.map(|count| population + u64::from(count.max(1) - 1) * (population - elites));
        let most = self.evaluations.map(u64::from);
        Some(generations.unwrap_or(u64::MAX).min(most.unwrap_or(u64::MAX)))
    }

    /// Fitness evaluations that all of it takes at most, the candidates and their variants apart.
    #[must_use]
    pub fn most_evaluations(&self) -> u64 {
        let gaps = self.bounds.len() as u64;
        let swaps_each = gaps * (gaps.saturating_sub(1)) / 2 * (gaps + 1);
        let swaps = if self.two_opt { swaps_each } else { 0 };
        let genetic = self.genetic_evaluations();
        let own = self.evaluations.map_or(u64::MAX, u64::from);
        let seeds = self.seeds.len() as u64;
        let searches = self.searches.iter().map(|search| match search {
            Search::Genetic { .. } => seeds.saturating_mul(genetic.unwrap_or(own).saturating_add(swaps)),
            Search::CmaEs { .. } => seeds.saturating_mul(genetic.map_or(own, |most| most.saturating_add(swaps))),
            Search::Dense { points, refine, .. } => {
                let power = |base: u64| base.saturating_pow(u32::try_from(gaps).unwrap_or(u32::MAX));
                power(u64::from(*points)).saturating_add(u64::from(*refine).saturating_mul(power(FINER)))
            }
            // Where it ends is looked at as the other searches look.
            Search::Polish { evaluations } => u64::from(*evaluations) + 1,
        });
        let landscape = self.landscape.map_or(0, |landscape| gaps * (u64::from(landscape.points) + 1));
        let own = (swaps_each + 1) * self.two_opt_of.len() as u64;
        searches.fold(landscape + own, u64::saturating_add)
    }
}
