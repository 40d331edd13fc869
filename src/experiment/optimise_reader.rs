//! The `optimise` of an experiment: nodes to [`Optimise`].

use serde_json::json;

use super::measures::read_measure;
use super::optimise::{Candidate, Goal, Landscape, Optimise, Search, SearchKind, SearchSpacing};
use super::recipe::GapWord;
use super::sweep::{NAME, is_name};
use crate::measure::Measure;
use crate::yaml::reader::count;
use crate::yaml::word::word_of;
use crate::yaml::{At, Dimension, Findings, Keys, Span, Value, schema};

/// Most individuals of a population.
const MOST_INDIVIDUALS: u32 = 100_000;
/// Most generations, and evaluations.
const MOST: u32 = 1_000_000_000;

/// An optimisation as read: what belongs to each damper still is one value for all, or a list.
pub(super) struct ReadOptimise {
    pub optimise: Optimise,
    /// Bounds as written: one for all gaps, or one a gap.
    pub bounds: Vec<[f64; 2]>,
    pub bounds_at: Span,
    /// Where each candidate stands.
    pub candidates_at: Vec<Span>,
    pub span: Span,
}

/// Reads what stands under `optimise`.
pub(super) fn read_optimise(at: At<'_>) -> Option<ReadOptimise> {
    let keys = at.keys("an optimisation")?;
    let goals = [("minimise", "The measure that is minimised"), ("maximise", "The measure that is maximised")];
    let goal = keys.exactly_one(&goals, |key, at| {
        let goal = if key == "minimise" { Goal::Minimise } else { Goal::Maximise };
        Some((goal, read_measure(at)?))
    });
    let of_gaps = [("gaps", "Bounds of all gaps, or of each"), ("gap_ratios", "Bounds of all h′, or of each")];
    let gaps = keys.exactly_one(&of_gaps, |key, at| {
        let word = if key == "gaps" { GapWord::Gap } else { GapWord::GapRatio };
        let bounds = at.one_or_more(|at| read_bounds(at, word))?;
        Some((word, bounds, at.span()))
    });
    let word = gaps.as_ref().map(|(word, ..)| *word);
    let candidates =
        keys.required("candidates", "Gaps that are evaluated as they are, by name", |at| read_candidates(at, word));
    let compare_with = keys.optional("compare_with", "The candidate that improvements are measured from", |at| {
        Some((at.text()?, at.span()))
    });
    let genetic = keys.optional("genetic", "The genetic algorithm", read_genetic);
    let cma_es = keys.optional("cma_es", "CMA-ES, the peer", read_cma_es);
    let dense = keys.optional("dense", "Every point of a grid", read_dense);
    let polish = keys.optional("polish", "Down the gradient of settled motion from the best candidate", read_polish);
    let improved = "Improve by 2-opt what the genetic algorithm found, or these candidates";
    let two_opt = keys.optional("two_opt", improved, read_two_opt);
    let seeds = keys.optional("seeds", "Seeds, each a search of its own", read_seeds);
    let stop = keys.optional("stop", "What ends a search", read_stop);
    let landscape = keys.optional("landscape", "Fitness along each gap", read_landscape);
    keys.close()?;
    let ((goal, measure), (gaps, bounds, bounds_at)) = (goal?, gaps?);
    let mut candidates = candidates?;
    // Keys of a mapping have no order.
    candidates.sort_by(|(a, _), (b, _)| a.name.cmp(&b.name));
    if let Some((name, span)) = compare_with? {
        let Some(first) = candidates.iter().position(|(candidate, _)| candidate.name == name) else {
            return at.wrong_at(span, format!("`{name}` is none of the candidates"));
        };
        candidates[..=first].rotate_right(1);
    }
    let (names, candidates_at): (Vec<Candidate>, Vec<Span>) = candidates.into_iter().unzip();
    let (searches, stop) = ([genetic?, cma_es?, dense?], stop?.unwrap_or_default());
    let (polish, polish_at) = polish?.unzip();
    let (two_opt, two_opt_of) = two_opt?.unwrap_or_default();
    let has_landscape = landscape != Some(None);
    let optimise = Optimise {
        goal,
        measure,
        gaps,
        bounds: Vec::new(),
        candidates: names,
        searches: searches.into_iter().flatten().chain(polish).collect(),
        seeds: seeds?.unwrap_or_else(|| vec![1]),
        two_opt,
        two_opt_of,
        generations: stop.generations,
        evaluations: stop.evaluations,
        time: stop.time,
        tolerance: stop.tolerance,
        stalled: stop.stalled,
        landscape: landscape?,
    };
    check(at, &optimise, has_landscape, polish_at)?;
    Some(ReadOptimise { optimise, bounds, bounds_at, candidates_at, span: at.span() })
}

/// Its parts fit together.
fn check(at: At<'_>, optimise: &Optimise, has_landscape: bool, polish_at: Option<Span>) -> Option<()> {
    let Optimise { measure, candidates, searches, two_opt, two_opt_of, generations, evaluations, .. } = optimise;
    let is_candidate = |name: &str| candidates.iter().any(|candidate| candidate.name == name);
    let lacks = |names: &[String]| names.iter().find(|name| !is_candidate(name)).cloned();
    let has = |wanted: fn(&Search) -> bool| searches.iter().any(wanted);
    let genetic = has(|search| matches!(search, Search::Genetic { .. }));
    let cma_es = has(|search| matches!(search, Search::CmaEs { .. }));
    for search in searches {
        if let Search::Genetic { start, .. } = search
            && let Some(name) = lacks(start)
        {
            return at.wrong(format!("`start` names `{name}`, which is none of the candidates"));
        }
    }
    if let Some(name) = lacks(two_opt_of) {
        return at.wrong(format!("`two_opt` names `{name}`, which is none of the candidates"));
    }
    if let Some(name) = two_opt_of.iter().map(|name| format!("{name}_two_opt")).find(|name| is_candidate(name)) {
        return at.wrong(format!("`{name}` is what 2-opt finds: call the candidate otherwise"));
    }
    if !genetic && *two_opt {
        return at.wrong("2-opt improves what the genetic algorithm has found: add `genetic`");
    }
    if (genetic && generations.is_none() || cma_es && !genetic) && evaluations.is_none() {
        let help = if genetic {
            "add `stop: {generations: …}` or `stop: {evaluations: …}`"
        } else {
            "CMA-ES alone is bounded by evaluations: add `stop: {evaluations: …}`"
        };
        return at.report("nothing bounds this search", Some(help.into()));
    }
    if let (Some(polish_at), false) = (polish_at, matches!(measure, Measure::RmsVelocity | Measure::VelocityRatio)) {
        let help = "optimise `rms_velocity` or `velocity_ratio`, or leave `polish` out".to_owned();
        return at.report_at(polish_at, "polishing follows the derivatives of the RMS velocity", Some(help));
    }
    let searches_anew = has(|search| !matches!(search, Search::Polish { .. }));
    if !searches_anew && !has_landscape && candidates.is_empty() {
        return at.wrong("there is nothing to evaluate: name candidates or a search");
    }
    Some(())
}

/// A length or a ratio, as the bounds are; in a description either.
fn read_gap(at: At<'_>, word: Option<GapWord>) -> Option<f64> {
    if word != Some(GapWord::GapRatio)
        && let Some(gap) = at.quantity(Dimension::Length)
    {
        return if gap >= 0.0 { Some(gap) } else { at.wrong("a gap clearance cannot be negative") };
    }
    if word == Some(GapWord::Gap) { None } else { at.ratio() }
}

fn read_bounds(at: At<'_>, word: GapWord) -> Option<[f64; 2]> {
    let keys = at.keys("a pair of bounds")?;
    let from = keys.required("from", "A gap", |at| read_gap(at, Some(word)));
    let to = keys.required("to", "A larger gap", |at| Some((read_gap(at, Some(word))?, at.span())));
    keys.close()?;
    let (from, (to, to_at)) = (from?, to?);
    if from < to { Some([from, to]) } else { at.wrong_at(to_at, "a range ends above its start") }
}

fn read_candidates(at: At<'_>, word: Option<GapWord>) -> Option<Vec<(Candidate, Span)>> {
    if let At::Node(..) = at {
        word?;
    }
    let form = "candidates are written as `name: [gap, gap, …]` lines";
    at.by_name(json!({"propertyNames": {"pattern": NAME}}), form, |key, key_span, at| {
        let taken = SearchKind::ALL.iter().any(|kind| word_of(*kind) == key);
        let named = if taken || !is_name(key) {
            let why = if taken { "it names a search" } else { "use letters, digits, `-` and `_`" };
            at.wrong_at(key_span, format!("`{key}` cannot name a candidate: {why}"))
        } else {
            Some(())
        };
        let gaps = at.called("One gap for all, or one a damper", |at| at.one_or_more(|at| read_gap(at, word)));
        named?;
        Some((Candidate { name: key.to_owned(), gaps: gaps? }, at.span()))
    })
}

/// Fewer have no parents to choose among.
const FEWEST_INDIVIDUALS: u32 = 4;
const TOO_FEW: &str = "a population has four individuals at least";

fn read_genetic(at: At<'_>) -> Option<Search> {
    let keys = at.keys("a genetic algorithm")?;
    let population = keys.required("population", "Individuals", |at| {
        // Found too small only if nothing else is wrong here.
        at.form(
            |node, findings| Some((count(node, "individuals", MOST_INDIVIDUALS, findings)?, node.span)),
            |it| schema::count(it.about(), "individuals", FEWEST_INDIVIDUALS, MOST_INDIVIDUALS),
        )
    });
    let elites = keys.optional("elites", "Individuals that live on", |at| {
        Some((at.count("individuals", MOST_INDIVIDUALS)?, at.span()))
    });
    let crossover = keys.optional("crossover", "Share of children by crossover", |at| {
        at.share("the share of children by crossover lies between 0 and 1")
    });
    let start = keys.optional("start", "Candidates to start from, by name", |at| at.one_or_more(|at| at.text()));
    keys.close()?;
    let ((population, population_at), elites) = (population?, elites?);
    if population < FEWEST_INDIVIDUALS {
        return at.wrong_at(population_at, TOO_FEW);
    }
    // A twentieth, as library functions have it.
    let (elites, elites_at) = elites.unwrap_or((population.div_ceil(20), population_at));
    if elites >= population {
        return at.wrong_at(elites_at, "fewer individuals live on than there are");
    }
    Some(Search::Genetic {
        population,
        elites,
        crossover: crossover?.unwrap_or(0.8),
        start: start?.unwrap_or_default(),
    })
}

/// `true`, or a list of what is improved: `genetic`, and candidates by name.
fn read_two_opt(at: At<'_>) -> Option<(bool, Vec<String>)> {
    let found = |at: At<'_>| at.boolean().map(|genetic| (genetic, Vec::new()));
    at.either(
        |value| matches!(value, Value::Scalar(_)),
        found,
        |at| {
            let names = at.list(|at| at.text())?;
            let genetic = word_of(SearchKind::Genetic);
            let (found, named): (Vec<String>, Vec<String>) = names.into_iter().partition(|name| *name == genetic);
            Some((!found.is_empty(), named))
        },
    )
}

fn read_cma_es(at: At<'_>) -> Option<Search> {
    let keys = at.keys("the peer")?;
    let population = keys.optional("population", "Individuals", |at| {
        at.count_from(FEWEST_INDIVIDUALS, "individuals", MOST_INDIVIDUALS, TOO_FEW)
    });
    keys.close()?;
    Some(Search::CmaEs { population: population? })
}

/// How the points along each gap lie.
fn points(keys: &Keys<'_>) -> (Option<u32>, Option<SearchSpacing>) {
    let points = keys.required("points", "Points along each gap", |at| {
        at.count_from(2, "points", 10_000, "a range has two points at least")
    });
    let spacing = keys.optional("spacing", "How points are spaced", |at| at.word::<SearchSpacing>("spacing"));
    (points, spacing.map(Option::unwrap_or_default))
}

fn read_dense(at: At<'_>) -> Option<Search> {
    let keys = at.keys("a dense search")?;
    let (points, spacing) = points(&keys);
    let refine = keys.optional("refine", "Finer grids around the best", |at| at.count("rounds", 50));
    keys.close()?;
    Some(Search::Dense { points: points?, spacing: spacing?, refine: refine?.unwrap_or(0) })
}

/// Orbits with their derivatives, unless the file says otherwise.
const USUAL_POLISH: u32 = 100;

fn read_polish(at: At<'_>) -> Option<(Search, Span)> {
    let keys = at.keys("a descent")?;
    let evaluations = keys.optional("evaluations", "Orbits with their derivatives, at most", |at| {
        at.count_from(1, "evaluations", 10_000, "one at least is wanted here")
    });
    keys.close()?;
    Some((Search::Polish { evaluations: evaluations?.unwrap_or(USUAL_POLISH) }, at.span()))
}

fn read_landscape(at: At<'_>) -> Option<Landscape> {
    let keys = at.keys("a landscape")?;
    let (points, spacing) = points(&keys);
    keys.close()?;
    Some(Landscape { points: points?, spacing: spacing? })
}

fn read_seeds(at: At<'_>) -> Option<Vec<u32>> {
    let seeds = at.list(|at| Some((at.count("", u32::MAX)?, at.span())))?;
    for (index, (seed, span)) in seeds.iter().enumerate() {
        if seeds[..index].iter().any(|(other, _)| other == seed) {
            return at.wrong_at(*span, format!("seed {seed} is here twice: it would find the same"));
        }
    }
    Some(seeds.into_iter().map(|(seed, _)| seed).collect())
}

fn read_stop(at: At<'_>) -> Option<Stop> {
    let keys = at.keys("a stopping condition")?;
    let some = |at: At<'_>, noun| at.count_from(1, noun, MOST, "one at least is wanted here");
    let generations = keys.optional("generations", "Generations", |at| some(at, "generations"));
    let evaluations = keys.optional("evaluations", "Evaluations", |at| some(at, "evaluations"));
    let time = keys.optional("time", "Time", |at| at.above_zero(Dimension::Time));
    let tolerance = keys.optional("tolerance", "Gain below which a generation has stalled", |at| at.ratio());
    let stalled = "Generations over which the tolerance is taken";
    let stalled = keys.optional("stalled", stalled, |at| Some((some(at, "generations")?, at.span())));
    keys.rule(|| json!({"if": {"required": ["stalled"]}, "then": {"required": ["tolerance"]}}));
    keys.close()?;
    if let (Some(None), Some(Some((_, span)))) = (&tolerance, &stalled) {
        return at.wrong_at(*span, "`stalled` says over how many generations `tolerance` is taken: add that");
    }
    Some(Stop {
        generations: generations?,
        evaluations: evaluations?,
        time: time?,
        tolerance: tolerance?,
        stalled: stalled?.map_or(USUAL_STALLED, |(stalled, _)| stalled),
    })
}

/// Generations over which a function tolerance is taken, as library functions have it.
const USUAL_STALLED: u32 = 50;

struct Stop {
    generations: Option<u32>,
    evaluations: Option<u32>,
    time: Option<f64>,
    tolerance: Option<f64>,
    stalled: u32,
}

impl Default for Stop {
    fn default() -> Self {
        Self { generations: None, evaluations: None, time: None, tolerance: None, stalled: USUAL_STALLED }
    }
}

impl ReadOptimise {
    /// One value for all gaps becomes one a gap; all that is not one a damper is reported.
    pub fn spread(mut self, dampers: usize, findings: &Findings) -> Option<Optimise> {
        let mut fine = true;
        let mut each = |values: usize, at: Span| {
            if values != 1 && values != dampers {
                fine = false;
                findings.wrong::<()>(at, format!("{values} gaps for {dampers} dampers: give one, or one a damper"));
            }
        };
        each(self.bounds.len(), self.bounds_at);
        for (candidate, at) in self.optimise.candidates.iter().zip(&self.candidates_at) {
            each(candidate.gaps.len(), *at);
        }
        if !fine {
            return None;
        }
        self.optimise.bounds = filled(&self.bounds, dampers);
        for (candidate, at) in self.optimise.candidates.iter_mut().zip(&self.candidates_at) {
            candidate.gaps = filled(&candidate.gaps, dampers);
            let outside = candidate.gaps.iter().zip(&self.optimise.bounds).any(|(gap, [low, high])| {
                let slack = 1e-9 * (high - low);
                *gap < low - slack || *gap > high + slack
            });
            if outside {
                fine = false;
                findings.wrong::<()>(*at, "this candidate lies outside of the bounds");
            }
        }
        fine.then_some(self.optimise)
    }
}

fn filled<T: Copy>(values: &[T], count: usize) -> Vec<T> {
    match values {
        [one] => vec![*one; count],
        each => each.to_vec(),
    }
}
