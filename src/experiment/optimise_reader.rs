//! The `optimise` of an experiment: nodes to [`Optimise`].

use super::recipe::GapWord;
use crate::measure::Measure;

use super::diagnostic::{Findings, Span};
use super::optimise::{Candidate, Goal, Landscape, Optimise, Search, SearchKind, SearchSpacing};
use super::quantity::Dimension;
use super::reader::{Fields, above_zero, boolean, count, list, one_or_more, quantity, ratio, text, word};
use super::sweep::is_name;
use super::word::word_of;
use super::yaml::{Node, Value};

/// Most individuals of a population.
pub(super) const MOST_INDIVIDUALS: u32 = 100_000;
/// Most generations, and evaluations.
pub(super) const MOST: u32 = 1_000_000_000;

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

pub(super) struct OptimiseReader<'t> {
    pub findings: &'t Findings,
}

impl<'t> OptimiseReader<'t> {
    pub fn read(&self, node: &'t Node) -> Option<ReadOptimise> {
        let findings = self.findings;
        let fields = Fields::open(node, "an optimisation", findings)?;
        let goal = fields.exactly_one(&["minimise", "maximise"]).and_then(|(key, node)| {
            let goal = if key == "minimise" { Goal::Minimise } else { Goal::Maximise };
            Some((goal, word::<Measure>(node, "measure", findings)?))
        });
        let gaps = fields.exactly_one(&["gaps", "gap_ratios"]).and_then(|(key, node)| {
            let word = if key == "gaps" { GapWord::Gap } else { GapWord::GapRatio };
            let bounds = one_or_more(node, findings, |node| self.bounds(node, word))?;
            Some((word, bounds, node.span))
        });
        let words = gaps.as_ref().map(|(word, ..)| *word);
        let candidates = fields.required("candidates", |node| self.candidates(node, words?));
        let compare_with = fields.optional("compare_with", |node| Some((text(node, findings)?, node.span)));
        let genetic = fields.optional("genetic", |node| self.genetic(node));
        let cma_es = fields.optional("cma_es", |node| self.cma_es(node));
        let dense = fields.optional("dense", |node| self.dense(node));
        let two_opt = fields.optional("two_opt", |node| self.two_opt(node));
        let seeds = fields.optional("seeds", |node| self.seeds(node));
        let stop = fields.optional("stop", |node| self.stop(node));
        let landscape = fields.optional("landscape", |node| self.landscape(node));
        fields.close()?;
        let ((goal, measure), (gaps, bounds, bounds_at)) = (goal?, gaps?);
        let mut candidates = candidates?;
        // Keys of a mapping have no order.
        candidates.sort_by(|(a, _), (b, _)| a.name.cmp(&b.name));
        if let Some((name, at)) = compare_with? {
            let Some(first) = candidates.iter().position(|(candidate, _)| candidate.name == name) else {
                return findings.wrong(at, format!("`{name}` is none of the candidates"));
            };
            candidates[..=first].rotate_right(1);
        }
        let (names, candidates_at): (Vec<Candidate>, Vec<Span>) = candidates.into_iter().unzip();
        let (genetic, cma_es, dense, stop) = (genetic?, cma_es?, dense?, stop?.unwrap_or_default());
        let (two_opt, two_opt_of) = two_opt?.unwrap_or_default();
        if let Some(Search::Genetic { start, .. }) = &genetic
            && let Some(name) = start.iter().find(|name| names.iter().all(|candidate| candidate.name != **name))
        {
            return findings.wrong(node.span, format!("`start` names `{name}`, which is none of the candidates"));
        }
        if let Some(name) = two_opt_of.iter().find(|name| names.iter().all(|candidate| candidate.name != **name)) {
            return findings.wrong(node.span, format!("`two_opt` names `{name}`, which is none of the candidates"));
        }
        if let Some(name) = two_opt_of
            .iter()
            .map(|name| format!("{name}_two_opt"))
            .find(|improved| names.iter().any(|candidate| candidate.name == *improved))
        {
            return findings.wrong(node.span, format!("`{name}` is what 2-opt finds: call the candidate otherwise"));
        }
        if genetic.is_none() && two_opt {
            return findings.wrong(node.span, "2-opt improves what the genetic algorithm has found: add `genetic`");
        }
        if (genetic.is_some() && stop.generations.is_none() || cma_es.is_some() && genetic.is_none())
            && stop.evaluations.is_none()
        {
            let help = "add `stop: {generations: …}` or `stop: {evaluations: …}`".to_owned();
            return findings.report(node.span, "nothing bounds this search", Some(help));
        }
        if genetic.is_none() && cma_es.is_none() && dense.is_none() && landscape == Some(None) && names.is_empty() {
            return findings.wrong(node.span, "there is nothing to evaluate: name candidates or a search");
        }
        let optimise = Optimise {
            goal,
            measure,
            gaps,
            bounds: Vec::new(),
            candidates: names,
            searches: [genetic, cma_es, dense].into_iter().flatten().collect(),
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
        Some(ReadOptimise { optimise, bounds, bounds_at, candidates_at, span: node.span })
    }

    fn gap(&self, node: &'t Node, word: GapWord) -> Option<f64> {
        match word {
            GapWord::Gap => match quantity(node, Dimension::Length, self.findings)? {
                gap if gap >= 0.0 => Some(gap),
                _ => self.findings.wrong(node.span, "a gap clearance cannot be negative"),
            },
            GapWord::GapRatio => ratio(node, self.findings),
        }
    }

    fn bounds(&self, node: &'t Node, word: GapWord) -> Option<[f64; 2]> {
        let fields = Fields::open(node, "a pair of bounds", self.findings)?;
        let from = fields.required("from", |node| self.gap(node, word));
        let to = fields.required("to", |node| Some((self.gap(node, word)?, node.span)));
        fields.close()?;
        let (from, (to, to_at)) = (from?, to?);
        if from < to { Some([from, to]) } else { self.findings.wrong(to_at, "a range ends above its start") }
    }

    fn candidates(&self, node: &'t Node, word: GapWord) -> Option<Vec<(Candidate, Span)>> {
        let Value::Mapping(entries) = &node.value else {
            return self.findings.wrong(node.span, "candidates are written as `name: [gap, gap, …]` lines");
        };
        let mut candidates = Vec::new();
        let mut fine = true;
        for entry in entries {
            let taken = SearchKind::ALL.iter().any(|kind| word_of(*kind) == entry.key);
            if taken || !is_name(&entry.key) {
                let why = if taken { "it names a search" } else { "use letters, digits, `-` and `_`" };
                let message = format!("`{}` cannot name a candidate: {why}", entry.key);
                fine = self.findings.wrong::<()>(entry.key_span, message).is_some();
            }
            match one_or_more(&entry.node, self.findings, |node| self.gap(node, word)) {
                Some(gaps) => candidates.push((Candidate { name: entry.key.clone(), gaps }, entry.node.span)),
                None => fine = false,
            }
        }
        fine.then_some(candidates)
    }

    fn genetic(&self, node: &'t Node) -> Option<Search> {
        let fields = Fields::open(node, "a genetic algorithm", self.findings)?;
        let individuals = |node| Some((count(node, "individuals", MOST_INDIVIDUALS, self.findings)?, node.span));
        let population = fields.required("population", individuals);
        let elites = fields.optional("elites", individuals);
        let crossover = fields.optional("crossover", |node| match ratio(node, self.findings)? {
            share if share <= 1.0 => Some(share),
            _ => self.findings.wrong(node.span, "the share of children by crossover lies between 0 and 1"),
        });
        let start = fields.optional("start", |node| one_or_more(node, self.findings, |node| text(node, self.findings)));
        fields.close()?;
        let ((population, at), elites) = (population?, elites?);
        if population < 4 {
            return self.findings.wrong(at, "a population has four individuals at least");
        }
        // A twentieth, as library functions have it.
        let (elites, elites_at) = elites.unwrap_or((population.div_ceil(20), at));
        if elites >= population {
            return self.findings.wrong(elites_at, "fewer individuals live on than there are");
        }
        Some(Search::Genetic {
            population,
            elites,
            crossover: crossover?.unwrap_or(0.8),
            start: start?.unwrap_or_default(),
        })
    }

    /// `true`, or a list of what is improved: `genetic`, and candidates by name.
    fn two_opt(&self, node: &'t Node) -> Option<(bool, Vec<String>)> {
        if let Value::Scalar(_) = node.value {
            return boolean(node, self.findings).map(|genetic| (genetic, Vec::new()));
        }
        let names = list(node, self.findings, |node| text(node, self.findings))?;
        let genetic = word_of(SearchKind::Genetic);
        let (found, named): (Vec<String>, Vec<String>) = names.into_iter().partition(|name| *name == genetic);
        Some((!found.is_empty(), named))
    }

    fn cma_es(&self, node: &'t Node) -> Option<Search> {
        let fields = Fields::open(node, "the peer", self.findings)?;
        let population =
            fields.optional("population", |node| match count(node, "individuals", MOST_INDIVIDUALS, self.findings)? {
                0..4 => self.findings.wrong(node.span, "a population has four individuals at least"),
                population => Some(population),
            });
        fields.close()?;
        Some(Search::CmaEs { population: population? })
    }

    fn points(&self, node: &'t Node) -> Option<u32> {
        match count(node, "points", 10_000, self.findings)? {
            0 | 1 => self.findings.wrong(node.span, "a range has two points at least"),
            points => Some(points),
        }
    }

    fn spacing(&self, fields: &Fields<'t>) -> Option<SearchSpacing> {
        let spacing = fields.optional("spacing", |node| word::<SearchSpacing>(node, "spacing", self.findings));
        spacing.map(Option::unwrap_or_default)
    }

    fn dense(&self, node: &'t Node) -> Option<Search> {
        let fields = Fields::open(node, "a dense search", self.findings)?;
        let points = fields.required("points", |node| self.points(node));
        let spacing = self.spacing(&fields);
        let refine = fields.optional("refine", |node| count(node, "rounds", 50, self.findings));
        fields.close()?;
        Some(Search::Dense { points: points?, spacing: spacing?, refine: refine?.unwrap_or(0) })
    }

    fn landscape(&self, node: &'t Node) -> Option<Landscape> {
        let fields = Fields::open(node, "a landscape", self.findings)?;
        let points = fields.required("points", |node| self.points(node));
        let spacing = self.spacing(&fields);
        fields.close()?;
        Some(Landscape { points: points?, spacing: spacing? })
    }

    fn seeds(&self, node: &'t Node) -> Option<Vec<u32>> {
        let seeds = list(node, self.findings, |node| Some((count(node, "", u32::MAX, self.findings)?, node.span)))?;
        for (index, (seed, span)) in seeds.iter().enumerate() {
            if seeds[..index].iter().any(|(other, _)| other == seed) {
                return self.findings.wrong(*span, format!("seed {seed} is here twice: it would find the same"));
            }
        }
        Some(seeds.into_iter().map(|(seed, _)| seed).collect())
    }

    fn stop(&self, node: &'t Node) -> Option<Stop> {
        let fields = Fields::open(node, "a stopping condition", self.findings)?;
        let some = |noun: &'static str| {
            move |node: &'t Node| match count(node, noun, MOST, self.findings)? {
                0 => self.findings.wrong(node.span, "one at least is wanted here"),
                count => Some(count),
            }
        };
        let generations = fields.optional("generations", some("generations"));
        let evaluations = fields.optional("evaluations", some("evaluations"));
        let time = fields.optional("time", |node| above_zero(node, Dimension::Time, self.findings));
        let tolerance = fields.optional("tolerance", |node| ratio(node, self.findings));
        let stalled = fields.optional("stalled", some("generations"));
        let misplaced = match (&tolerance, &stalled, fields.get("stalled")) {
            (Some(None), Some(Some(_)), Some(node)) => Some(node.span),
            _ => None,
        };
        fields.close()?;
        if let Some(at) = misplaced {
            return self.findings.wrong(at, "`stalled` says over how many generations `tolerance` is taken: add that");
        }
        Some(Stop {
            generations: generations?,
            evaluations: evaluations?,
            time: time?,
            tolerance: tolerance?,
            stalled: stalled?.unwrap_or(USUAL_STALLED),
        })
    }
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
