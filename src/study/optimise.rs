//! An optimisation while it runs: fitness evaluated batch by batch, the searches one after the other, and in the end every
//! candidate evaluated once more as a result.
//!
//! A search sees one run for each setting, not an ensemble: ten times as many evaluations are worth more to it than the
//! mean of an ensemble. Where the motion is chaotic a search may pick a lucky run; the ensemble of the result shows whether it did. What
//! goes on from the best candidate, a descent or a landscape, therefore begins at the one that is best as a result.

use cpu_time::ThreadTime;
use rayon::prelude::*;

use super::candidate_results::{Results, evaluate_all};
use super::evaluate::Evaluate;
use super::event::{Event, EventHandler};
use super::finished::Finished;
use super::fitness::{Fitness, Step};
use super::journal::{Journal, Known};
use super::mean::measures_of_each;
use super::row_failure::{RowFailure, SearchError};
use super::tabulate_candidates::{AlongGap, Candidate, failures, table};
use super::task::Task;
use super::variant::Variant;
use crate::dynamics::is_interrupted;
use crate::experiment::{Experiment, Goal, Optimise, Search, SearchKind, SearchSpacing};
use crate::measure::{Measured, Rigour};
use crate::optimise::{
    Batch, Bounds, CmaEs, Dense, Found, Genetic, GeneticSettings, Optimiser, Score, Slope, Spacing, Stalled, Stopping,
    Wanted, dense, minimise, polish, sections, two_opt,
};
use crate::text::words;

/// Points between two looks at the least score, where only that is wanted.
const AT_ONCE: usize = 32;

/// Rows of an optimisation's table.
pub(super) fn rows(optimise: &Optimise, variants: &[Variant]) -> usize {
    let landscape = if optimise.landscape.is_some() { optimise.bounds.len() } else { 0 };
    candidates(optimise) * variants.len() + landscape
}

fn candidates(optimise: &Optimise) -> usize {
    let seeds = optimise.seeds.len();
    let of = |search: &Search| match search {
        Search::Genetic { .. } => seeds * if optimise.two_opt { 2 } else { 1 },
        Search::CmaEs { .. } => seeds,
        Search::Dense { .. } | Search::Polish { .. } => 1,
    };
    optimise.candidates.len() + optimise.two_opt_of.len() + optimise.searches.iter().map(of).sum::<usize>()
}

/// Fitness evaluations that it takes at most.
pub(super) fn evaluations(optimise: &Optimise, variants: &[Variant]) -> u64 {
    optimise.most_evaluations().saturating_add((candidates(optimise) * variants.len()) as u64)
}

/// The searches of one optimisation.
struct Searches<'a> {
    experiment: &'a Experiment,
    optimise: &'a Optimise,
    handler: &'a dyn EventHandler,
    bounds: Bounds,
    fitness: Fitness<'a>,
    /// Index of the fitness among the measures.
    measure: usize,
    journal: Journal,
    /// Evaluations so far.
    evaluations: u64,
    /// The search that was reported last, and its best value so far.
    last: (String, f64),
    /// Candidates that were evaluated as results already.
    results: Results,
}

/// Runs it.
pub(super) fn run_optimisation(task: Task<'_>, evaluate: &impl Evaluate, handler: &dyn EventHandler) -> Finished {
    let Task { experiment, variants, metadata, .. } = task;
    if let Some(finished) = task.known_whole() {
        let count = experiment.optimise.as_ref().map_or(0, |optimise| evaluations(optimise, variants));
        handler.on_event(&Event::Simulated { experiment: &experiment.id, count });
        return finished;
    }
    let Searched { candidates, results, spent } = found(task, evaluate, handler).unwrap_or_else(|reason| Searched {
        candidates: vec![Candidate::failed(reason)],
        results: Vec::new(),
        spent: 0,
    });
    let evaluated = evaluate_all(task, evaluate, candidates, &results);
    if let Some(optimise) = &experiment.optimise {
        let left = evaluations(optimise, variants).saturating_sub(spent);
        handler.on_event(&Event::Simulated { experiment: &experiment.id, count: left });
    }
    let table = table(experiment, variants, &evaluated, metadata.clone());
    let failures = failures(&evaluated);
    let interrupted = failures.rows > 0 && is_interrupted();
    Finished { table, failures, interrupted, ..Finished::default() }
}

/// What the searches left.
struct Searched {
    candidates: Vec<Candidate>,
    results: Results,
    /// Evaluations made.
    spent: u64,
}

/// The candidates of the file, and what the searches find.
fn found(task: Task<'_>, evaluate: &impl Evaluate, handler: &dyn EventHandler) -> Result<Searched, RowFailure> {
    let experiment = task.experiment;
    let optimise = experiment.optimise.as_ref().ok_or(SearchError::NothingToOptimise)?;
    let baseline = task.variants.first().ok_or(SearchError::NoAssumptions)?;
    let recipes = experiment.recipes_in(&experiment.recipe)?;
    let measures = measures_of_each(&experiment.measures);
    let fitness = Fitness::new(evaluate, experiment, optimise, baseline, &recipes, &measures)?;
    let measure = experiment.measures.iter().position(|measure| *measure == optimise.measure);
    let fingerprint = task.metadata.get("fingerprint").map_or("", String::as_str);
    let mut searches = Searches {
        experiment,
        optimise,
        handler,
        bounds: Bounds::new(optimise.bounds.clone()).map_err(SearchError::from)?,
        fitness,
        measure: measure.ok_or(SearchError::FitnessNotMeasured)?,
        journal: Journal::open(task.journal, fingerprint),
        evaluations: 0,
        last: (String::new(), f64::INFINITY),
        results: Vec::new(),
    };
    let candidates = searches.all()?;
    Ok(Searched { candidates, results: searches.results, spent: searches.evaluations })
}

impl Searches<'_> {
    fn all(&mut self) -> Result<Vec<Candidate>, RowFailure> {
        let mut found: Vec<Candidate> =
            self.optimise.candidates.iter().map(|known| Candidate::named(&known.name, known.gaps.clone())).collect();
        for name in &self.optimise.two_opt_of {
            let improved = self.two_opt_of(name)?;
            found.push(improved);
        }
        // What the genetic algorithm spends, the peer may spend.
        let mut spent: Vec<Option<u64>> = vec![self.optimise.evaluations.map(u64::from); self.optimise.seeds.len()];
        for search in &self.optimise.searches {
            match search {
                Search::Genetic { .. } => {
                    for (spent, seed) in spent.iter_mut().zip(&self.optimise.seeds) {
                        let genetic = self.genetic(search, *seed)?;
                        let mut total = genetic.evaluations;
                        found.push(self.candidate(SearchKind::Genetic, Some(*seed), &genetic, 0));
                        if self.optimise.two_opt {
                            let name = describe(SearchKind::TwoOpt, Some(*seed));
                            let bounds = self.bounds.clone();
                            let swapped = two_opt(&genetic.point, genetic.score, &bounds, &mut |points, wanted| {
                                self.batch(points, wanted, &name, total)
                            })?;
                            total += swapped.evaluations;
                            found.push(self.candidate(SearchKind::TwoOpt, Some(*seed), &swapped, genetic.evaluations));
                        }
                        *spent = Some(total);
                    }
                }
                Search::CmaEs { population } => {
                    for (spent, seed) in spent.iter().zip(&self.optimise.seeds) {
                        let population = population.map(|count| count as usize);
                        let mut peer = CmaEs::new(self.bounds.clone(), population, u64::from(*seed));
                        let stopping =
                            Stopping { evaluations: *spent, seconds: self.optimise.time, ..Stopping::default() };
                        let best = self.run(&mut peer, &stopping, SearchKind::CmaEs, *seed)?;
                        found.push(self.candidate(SearchKind::CmaEs, Some(*seed), &best, 0));
                    }
                }
                Search::Dense { points, spacing, refine } => {
                    let settings = Dense { points: *points as usize, spacing: spaced(*spacing), refine: *refine };
                    let name = describe(SearchKind::Dense, None);
                    let (bounds, mut done) = (self.bounds.clone(), 0);
                    let best = dense(&bounds, settings, &mut |points, wanted| {
                        done += points.len() as u64;
                        self.batch(points, wanted, &name, done - points.len() as u64)
                    })?;
                    let best = best.ok_or(SearchError::EmptyGrid)?;
                    found.push(self.candidate(SearchKind::Dense, None, &best, 0));
                }
                Search::Polish { evaluations } => {
                    let polished = self.polished(&found, u64::from(*evaluations))?;
                    found.push(polished);
                }
            }
        }
        self.landscape(&mut found)?;
        Ok(found)
    }

    /// A candidate of the file, improved by swaps.
    fn two_opt_of(&mut self, name: &str) -> Result<Candidate, RowFailure> {
        let known = self.optimise.candidates.iter().find(|candidate| candidate.name == *name);
        let gaps = known.ok_or_else(|| SearchError::NoCandidate(name.to_owned()))?.gaps.clone();
        let improved = format!("{name}_two_opt");
        let description = words::of_level("candidate", &improved);
        let score = self.batch(std::slice::from_ref(&gaps), Wanted::Each, &description, 0)?.scores[0];
        let bounds = self.bounds.clone();
        let swapped =
            two_opt(&gaps, score, &bounds, &mut |points, wanted| self.batch(points, wanted, &description, 1))?;
        Ok(Candidate { name: improved, ..self.candidate(SearchKind::TwoOpt, None, &swapped, 1) })
    }

    fn genetic(&mut self, search: &Search, seed: u32) -> Result<Found, RowFailure> {
        let Search::Genetic { population, elites, crossover, start } = search else {
            return Err(SearchError::NotGenetic.into());
        };
        let optimise = self.optimise;
        let settings =
            GeneticSettings { population: *population as usize, elites: *elites as usize, crossover: *crossover };
        let named = |name: &String| optimise.candidates.iter().find(|candidate| candidate.name == *name);
        let start: Vec<Vec<f64>> = start.iter().filter_map(named).map(|candidate| candidate.gaps.clone()).collect();
        let mut genetic = Genetic::new(self.bounds.clone(), settings, u64::from(seed), &start);
        let stopping = Stopping {
            generations: optimise.generations.map(u64::from),
            evaluations: optimise.evaluations.map(u64::from),
            seconds: optimise.time,
            stalled: optimise
                .tolerance
                .map(|tolerance| Stalled { tolerance, generations: u64::from(optimise.stalled) }),
        };
        self.run(&mut genetic, &stopping, SearchKind::Genetic, seed)
    }

    fn run(
        &mut self,
        optimiser: &mut dyn Optimiser,
        stopping: &Stopping,
        kind: SearchKind,
        seed: u32,
    ) -> Result<Found, RowFailure> {
        let name = describe(kind, Some(seed));
        let mut done = 0;
        let found = minimise(optimiser, stopping, &mut |points, wanted| {
            done += points.len() as u64;
            self.batch(points, wanted, &name, done - points.len() as u64)
        })?;
        Ok(found.ok_or(SearchError::NothingEvaluated(name))?)
    }

    /// Scores of a batch: points that are not in the journal are evaluated in parallel; where only the least is wanted, each as far as
    /// it takes to prove that an earlier one is less.
    fn batch(&mut self, points: &[Vec<f64>], wanted: Wanted, search: &str, before: u64) -> Result<Batch, RowFailure> {
        let mut new: Vec<&Vec<f64>> = Vec::new();
        for point in points {
            if self.journal.get(point).is_none() && !new.contains(&point) {
                new.push(point);
            }
        }
        let evaluate = |point: &&Vec<f64>, limit: f64| {
            let begun = ThreadTime::now();
            // What has no number is the worst.
            let step = self.fitness.step(point, self.measure, limit).unwrap_or(Step::At(f64::NAN));
            ((*point).clone(), step, begun.elapsed().as_secs_f64())
        };
        let (at_once, mut limit) = match wanted {
            Wanted::Least { below } if self.is_bounded_by_parts() => (AT_ONCE, below),
            Wanted::Least { .. } | Wanted::Each => (new.len().max(1), f64::INFINITY),
        };
        let mut steps: Vec<(Vec<f64>, Step, f64)> = Vec::with_capacity(new.len());
        for some in new.chunks(at_once) {
            // One limit for all of them: how much is evaluated does not depend on threads.
            steps.par_extend(some.par_iter().map(|point| evaluate(point, limit)));
            let known = steps[steps.len() - some.len()..].iter();
            limit = known
                .fold(limit, |limit, (_, step, _)| if let Step::At(value) = step { limit.min(*value) } else { limit });
        }
        let interrupted = is_interrupted();
        let (mut evaluated, mut bounds) = (Vec::new(), Vec::new());
        for (point, step, seconds) in steps {
            match step {
                // Without a number is then also what was cut short.
                Step::At(value) if interrupted && value.is_nan() => {}
                // Smaller is better to the optimisers.
                Step::At(value) => {
                    evaluated.push((point, Known { score: Score { value: self.signed(value) }, seconds }))
                }
                // Not for the journal: another search may want the number.
                Step::Above(value) => bounds.push((point, Known { score: Score { value }, seconds })),
            }
        }
        self.journal.add(&evaluated);
        if interrupted {
            return Err(RowFailure::Interrupted);
        }
        let bound = |point: &Vec<f64>| bounds.iter().find(|(other, _)| other == point).map(|(_, known)| *known);
        let known: Vec<Known> =
            points.iter().filter_map(|point| self.journal.get(point).or_else(|| bound(point))).collect();
        let scores: Vec<Score> = known.iter().map(|known| known.score).collect();
        if scores.len() < points.len() {
            return Err(SearchError::NotKept.into());
        }
        if self.last.0 != search {
            self.last = (search.to_owned(), f64::INFINITY);
        }
        // The smaller of NaN and a number is the number.
        self.last.1 = scores.iter().map(|score| score.value).fold(self.last.1, f64::min);
        let best = self.last.1;
        self.count(points);
        let experiment = &self.experiment.id;
        let (evaluations, best) = (before + points.len() as u64, self.signed(best));
        let unit = self.optimise.measure.unit();
        self.handler.on_event(&Event::Searched { experiment, search, evaluations, best, unit });
        let seconds = known.iter().map(|known| known.seconds).sum::<f64>() / rayon::current_num_threads() as f64;
        Ok(Batch { scores, seconds })
    }

    /// Evaluations that are over.
    fn count(&mut self, points: &[Vec<f64>]) {
        let count = points.len() as u64;
        self.handler.on_event(&Event::Simulated { experiment: &self.experiment.id, count });
        self.evaluations += count;
    }

    /// Part of the sum that fitness is the mean of proves that a point cannot be the best.
    fn is_bounded_by_parts(&self) -> bool {
        self.optimise.goal == Goal::Minimise && self.optimise.measure.is_never_negative()
    }

    /// Fitness as a landscape shows it; `None` where it cannot be computed.
    fn look(&self, point: &[f64]) -> Option<Measured> {
        self.fitness.evaluate(point, Rigour::Variant).ok()?.measured.get(self.measure).copied()
    }

    /// The best of what was found, improved down the gradient of settled motion; as it is where that motion has none.
    fn polished(&mut self, found: &[Candidate], most: u64) -> Result<Candidate, RowFailure> {
        let name = describe(SearchKind::Polish, None);
        let start = self.best(found)?;
        let (fitness, goal, measure) = (&self.fitness, self.optimise.goal, self.optimise.measure);
        let polished = polish(&self.bounds, &start, most, &mut |gaps| -> Result<_, RowFailure> {
            if is_interrupted() {
                return Err(RowFailure::Interrupted);
            }
            let slope = fitness.slope(gaps, measure)?;
            Ok(match goal {
                Goal::Minimise => slope,
                Goal::Maximise => slope.map(|Slope { value, gradient }| Slope {
                    value: -value,
                    gradient: gradient.into_iter().map(|by| -by).collect(),
                }),
            })
        })?;
        // As the searches before it saw their best.
        let score =
            self.batch(std::slice::from_ref(&polished.point), Wanted::Each, &name, polished.evaluations)?.scores[0];
        Ok(self.candidate(SearchKind::Polish, None, &Found { score, ..polished }, 0))
    }

    /// The gaps of the candidate that is best as a result; of equal ones the first.
    fn best(&mut self, found: &[Candidate]) -> Result<Vec<f64>, RowFailure> {
        let mut new: Vec<Vec<f64>> = Vec::new();
        for Candidate { gaps, .. } in found {
            if !new.contains(gaps) && self.results.iter().all(|(known, _)| known != gaps) {
                new.push(gaps.clone());
            }
        }
        let fitness = &self.fitness;
        let outcomes: Vec<_> = new.par_iter().map(|gaps| fitness.evaluate(gaps, Rigour::Result)).collect();
        if is_interrupted() {
            return Err(RowFailure::Interrupted);
        }
        self.count(&new);
        self.results.extend(new.into_iter().zip(outcomes));
        let score = |candidate: &Candidate| {
            let (_, outcome) = self.results.iter().find(|(gaps, _)| *gaps == candidate.gaps)?;
            let value = outcome.as_ref().ok()?.measured.get(self.measure)?.value;
            Some(Score { value: self.signed(value) })
        };
        let order = |candidate: &&Candidate| score(candidate).map_or(f64::INFINITY, Score::order);
        let best = found.iter().min_by(|a, b| order(a).total_cmp(&order(b)));
        Ok(best.map(|best| best.gaps.clone()).ok_or(SearchError::NoCandidates)?)
    }

    fn signed(&self, value: f64) -> f64 {
        match self.optimise.goal {
            Goal::Minimise => value,
            Goal::Maximise => -value,
        }
    }

    fn candidate(&self, kind: SearchKind, seed: Option<u32>, found: &Found, before: u64) -> Candidate {
        let trail = found.trail.iter();
        Candidate {
            seed,
            fitness_in_search: self.signed(found.score.value),
            evaluations: before + found.evaluations,
            stopped: found.stopped.word().into(),
            trail: trail.map(|step| [(before + step.evaluations) as f64, self.signed(step.best)]).collect(),
            ..Candidate::named(&words::of_key(&kind), found.point.clone())
        }
    }

    /// Fitness with its spread: unlike a search, which sees one run, a landscape shows what chaotic motion makes of it.
    fn looks(&mut self, points: &[Vec<f64>]) -> Result<Vec<Measured>, RowFailure> {
        let none = Measured { value: f64::NAN, numerical: f64::NAN, spread: f64::NAN };
        let looks = points.par_iter().map(|point| self.look(point).unwrap_or(none)).collect();
        if is_interrupted() {
            return Err(RowFailure::Interrupted);
        }
        self.count(points);
        Ok(looks)
    }

    /// Sections through the best candidate.
    fn landscape(&mut self, found: &mut Vec<Candidate>) -> Result<(), RowFailure> {
        let Some(landscape) = self.optimise.landscape else { return Ok(()) };
        let centre = self.best(found)?;
        let bounds = self.bounds.clone();
        let count = landscape.points as usize;
        let cut = sections(&bounds, &centre, count, spaced(landscape.spacing), |points| self.looks(points))?;
        for (varied, section) in cut.into_iter().enumerate() {
            let points = section.along.into_iter().zip(section.values);
            found.push(Candidate {
                varied: Some(varied + 1),
                section: points
                    .map(|(gap, fitness)| AlongGap { gap, fitness: fitness.value, spread: fitness.spread })
                    .collect(),
                ..Candidate::named(&words::of_key(&SearchKind::Landscape), centre.clone())
            });
        }
        Ok(())
    }
}

fn spaced(spacing: SearchSpacing) -> Spacing {
    match spacing {
        SearchSpacing::Linear => Spacing::Linear,
        SearchSpacing::Log => Spacing::Log,
    }
}

/// A search for a person who waits for it.
fn describe(kind: SearchKind, seed: Option<u32>) -> String {
    let name = words::of_level("candidate", &words::of_key(&kind));
    seed.map_or(name.clone(), |seed| format!("{name}, seed {seed}"))
}
