//! A node tree to a validated [`Experiment`]: each part read by its own file, then checked against one another.
//!
//! A check runs as soon as the parts it talks about are sound, so a mistake in a figure is reported beside one in the
//! scene. The last check resolves every case into its scene: what physics refuses is found before anything runs.

use std::collections::BTreeSet;

use super::recipe::{AssumptionName, Assumptions, Parameter, ParameterValue, Part, Recipe};
use crate::dynamics::{Limit, Until};

use super::about_study::MOST_CHAPTERS;
use super::assumption_reader::{MOST_CYCLES, read_average, read_skip};
use super::assumption_sheet::Cycles;
use super::check::Checks;
use super::columns::{Columns, Lists, Role};
use super::continuation_reader::{ReadContinuation, read_continuation};
use super::definition::{Case, Experiment, ExperimentId, Maximise, SearchPoint, Source};
use super::diagnostic::{Findings, Problems, Span};
use super::figure::FigureReader;
use super::limit::read_limit;
use super::optimise::Optimise;
use super::optimise_reader::{OptimiseReader, ReadOptimise};
use super::quantity::Dimension;
use super::range::numbers;
use super::reader::{Fields, above_zero, count, no_such, one_or_more, text, word};
use super::scene::{ReadScene, read_scene};
use super::solver::read_solver;
use super::starts_reader::{ReadStarts, read_starts};
use super::stated::{STATED, read_statements, without_source};
use super::sweep::{ReadSweep, read_sweep};
use super::word::{from_word, word_of, words};
use super::yaml::{Node, Value, read_tree};
use crate::measure::{
    CycleSpec, CycleValue, EnergySpec, Measure, Settings, ShapeOf, ShapeSpec, SolverChoice, TraceSpec, energy_columns,
    shape_columns, trace_columns,
};

/// The lists that a row may keep; at most one of them.
pub(super) const LISTS: [&str; 4] = ["trace", "energies", "shape", "each_cycle"];

/// Most samples of a time history.
const MOST_SAMPLES: u64 = 1_000_000;

/// Reads an experiment from its text; `file` only names it in messages.
///
/// # Errors
/// Every mistake of the file, with its place.
pub fn parse_experiment(
    id: &ExperimentId,
    file: &str,
    text: &str,
    assumptions: &Assumptions,
) -> Result<Experiment, Problems> {
    parse_with(id, file, text, assumptions, Cases::ToTry)
}

/// Whether the scenes of an experiment's cases are known to resolve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cases {
    /// They are not.
    ToTry,
    /// This very text was read before, with these assumptions.
    Tried,
}

/// The same of a text whose cases may have been tried.
pub(crate) fn parse_with(
    id: &ExperimentId,
    file: &str,
    text: &str,
    assumptions: &Assumptions,
    cases: Cases,
) -> Result<Experiment, Problems> {
    let findings = Findings::default();
    let experiment = read_tree(text, &findings).and_then(|root| {
        let reader = ExperimentReader { findings: &findings, assumptions, cases };
        reader.experiment(id, &root)
    });
    findings.finish(file, text, experiment)
}

struct ExperimentReader<'t> {
    findings: &'t Findings,
    assumptions: &'t Assumptions,
    cases: Cases,
}

struct Run {
    solvers: Vec<SolverChoice>,
    settings: Settings,
    /// Where it says that runs are to settle.
    settled_at: Option<Span>,
    limit: Limit,
    moved: Option<BTreeSet<AssumptionName>>,
}

/// A run as an experiment states it.
#[derive(Default)]
struct GivenRun {
    span: Span,
    solvers: Option<Vec<SolverChoice>>,
    skip: Option<u32>,
    average: Option<u32>,
    until: Option<(Until, Span)>,
    round_period_to: Option<f64>,
    ensemble: Option<u32>,
    limit: Option<Limit>,
    moved: Option<BTreeSet<AssumptionName>>,
}

/// Perturbed starts of a chaotic point, unless an experiment says.
const USUAL_ENSEMBLE: u32 = 32;

impl<'t> ExperimentReader<'t> {
    fn experiment(&self, id: &ExperimentId, root: &'t Node) -> Option<Experiment> {
        let fields = Fields::open(root, "an experiment", self.findings)?;
        let title = fields.required("title", |node| text(node, self.findings));
        let source = fields.optional("source", |node| self.source(node));
        let about = fields.required("about", |node| text(node, self.findings));
        let scene = fields.required("scene", |node| read_scene(node, self.assumptions, self.findings));
        let orbit = fields.optional("orbit", |node| read_continuation(node, self.findings));
        let starts = fields.optional("starts", |node| read_starts(node, self.findings));
        let sweep = match &orbit {
            Some(Some(orbit)) => Some(Some(orbit.sweep())),
            Some(None) => fields.optional("sweep", |node| read_sweep(node, self.findings)),
            None => None,
        };
        let stated = fields.optional(STATED, |node| read_statements(node, self.findings));
        let mean_over = fields.optional("mean_over", |node| self.mean_over(node));
        let measures = fields.required("measure", |node| self.measures(node));
        let maximise = fields.at_most_one(&["maximise", "onset"]).and_then(|given| match given {
            Some(("onset", node)) => self.onset(node).map(Some),
            Some((_, node)) => self.maximise(node).map(Some),
            None => Some(None),
        });
        let optimise = fields.optional("optimise", |node| OptimiseReader { findings: self.findings }.read(node));
        let trace = fields.optional("trace", |node| self.trace(node));
        let energies = fields.optional("energies", |node| self.energies(node));
        let shape = fields.optional("shape", |node| self.shape(node));
        let each_cycle = fields.optional("each_cycle", |node| self.each_cycle(node));
        let lists =
            matches!(trace, Some(Some(_))) || matches!(energies, Some(Some(_))) || matches!(each_cycle, Some(Some(_)));
        let deflection = matches!(&shape, Some(Some(shape)) if shape.of == ShapeOf::Deflection);
        let of_model = measures.as_ref().is_some_and(|measures| measures.iter().all(|(measure, _)| measure.is_modal()));
        let no_run = of_model && !lists && !deflection;
        let run = self.run(&fields, no_run);
        let measures = match (measures, &run) {
            (Some(measures), Some(Run { settled_at: Some(at), .. })) => Some(with_the_end(measures, *at)),
            (measures, _) => measures,
        };
        let measures = match (measures, &starts) {
            (Some(measures), Some(Some(starts))) => Some(with_the_motion(measures, starts.span)),
            (measures, _) => measures,
        };
        let one_list = self.one_list(&fields);
        let alone = self.whole_table_alone(&fields);
        let whole = self.averaged_alone(&fields);
        let energies_at = fields.get("energies").map_or(fields.span(), |node| node.span);
        let place = |key| fields.get(key).map_or(fields.span(), |node| node.span);
        let each_cycle_at = place("each_cycle");
        let unordered = [("maximise", "a maximum"), ("onset", "an onset"), ("mean_over", "a mean over several scenes")];
        let unordered = unordered.iter().find_map(|(key, what)| fields.get(key).map(|node| (*what, node.span)));
        let (scene_at, optimise_at) = (place("scene"), place("optimise"));
        let figures_at = if fields.get("figure").is_some() { place("figure") } else { place("figures") };

        let kept = match (&trace, &energies, &shape, &each_cycle) {
            (Some(trace), Some(energies), Some(shape), Some(each_cycle)) => {
                Some(match (trace, energies, shape, each_cycle) {
                    (Some(_), ..) => Lists { names: trace_columns(), role: Role::History },
                    (_, Some(_), ..) => Lists { names: energy_columns(), role: Role::History },
                    (_, _, Some(shape), _) => Lists { names: shape_columns(shape), role: Role::History },
                    (.., Some(each)) => {
                        Lists { names: vec![words::<CycleValue>()[each.of as usize]], role: Role::Cloud }
                    }
                    _ => Lists { names: Vec::new(), role: Role::History },
                })
            }
            _ => None,
        };
        let optimise = match (optimise, &scene, &mean_over) {
            (Some(optimise), Some(scene), Some(inner)) => self.optimise(optimise, scene, inner.as_ref()),
            _ => None,
        };
        let columns = match (&sweep, &measures, &maximise, &kept) {
            _ if alone.is_none() || optimise.is_none() => None,
            (_, Some(measures), ..) if matches!(orbit, Some(Some(_))) => {
                let of = |it: &ReadContinuation| Columns::of_branches(it.continuation.along, &words_only(measures));
                orbit.as_ref().and_then(Option::as_ref).map(of)
            }
            (Some(_), Some(measures), ..) if matches!(optimise, Some(Some(_))) => {
                let of = |it: &Optimise| Columns::of_candidates(it.bounds.len(), it.gaps, &words_only(measures));
                optimise.as_ref().and_then(Option::as_ref).map(of)
            }
            (Some(sweep), Some(measures), Some(maximise), Some(kept)) => {
                let swept = sweep.as_ref().map_or(&[][..], |sweep| &sweep.swept);
                let some = |test: fn(&Case) -> bool| sweep.as_ref().is_some_and(|sweep| sweep.cases.iter().any(test));
                let mut labels = Vec::new();
                labels.extend(some(|case| !case.sweep.is_empty()).then_some("sweep"));
                labels.extend(some(|case| case.direction.is_some()).then_some("direction"));
                let columns = Columns::of(swept, &labels, &words_only(measures), maximise.as_ref(), kept);
                match &starts {
                    Some(Some(read)) => Some(columns.with_basins(&read.starts)),
                    Some(None) => Some(columns),
                    None => None,
                }
            }
            _ => None,
        };
        let figures = FigureReader { findings: self.findings, columns: columns.as_ref() }.figures(&fields);
        fields.close();

        let checks = Checks { findings: self.findings, assumptions: self.assumptions };
        one_list?;
        alone?;
        whole?;
        let (mean_over, optimise) = (mean_over?.unwrap_or_else(ReadSweep::none), optimise?);
        let (measures, maximise, trace, run) = (measures?, maximise?, trace?, run?);
        let (energies, shape, each_cycle) = (energies?, shape?, each_cycle?);
        checks.measures(&measures, maximise.as_ref(), trace.as_ref(), shape.as_ref());
        checks.motion(
            &measures,
            maximise.as_ref(),
            mean_over.cases.iter().any(|case| !case.values.is_empty()),
            &run.solvers,
        );
        checks.energies(energies.as_ref(), &run.settings, energies_at);
        checks.each_cycle(each_cycle.as_ref(), &run.settings, each_cycle_at);
        if let Some(at) = run.settled_at {
            checks.settled(&measures, energies.is_some(), &run.solvers, at);
        }
        let (mut scene, sweep) = (scene?, sweep?.unwrap_or_else(ReadSweep::none));
        let orbit = orbit?;
        if let Some(orbit) = &orbit {
            checks.orbit(&measures, &run.solvers, &run.settings, orbit.span);
            checks.repeats(&scene.recipe.excitation.kind, orbit.span);
        }
        let starts = starts?;
        if let Some(starts) = &starts {
            checks.starts(starts, run.settled_at.is_some(), &sweep);
            checks.repeats(&scene.recipe.excitation.kind, starts.span);
        }
        if let Some(optimise) = &optimise {
            checks.optimise(optimise, &measures, &run.solvers, optimise_at);
        }
        checks.excitation(&measures, &scene.recipe.excitation.kind);
        let of_settled = measures.iter().find(|(measure, _)| measure.needs_settled()).map(|(_, at)| *at);
        if let Some(at) = run.settled_at.or(of_settled) {
            checks.repeats(&scene.recipe.excitation.kind, at);
        }
        let mut places = sweep.places;
        checks.mean_over(&mean_over, &places, maximise.as_ref());
        let inner = mean_over.cases.first().filter(|case| !case.values.is_empty()).map(|_| mean_over.cases.clone());
        let inner = inner.unwrap_or_default();
        let cases = with_solvers(sweep.cases, &run.solvers);
        checks.refined(&sweep.refined, &measures);
        checks.continued(&sweep.continued, &cases, unordered);
        if let (true, Some((_, at))) = (no_run, sweep.continued.first()) {
            self.findings
                .wrong::<()>(*at, "what is measured here is read off the model: there is no run to go on from");
        }
        checks.coverage(&scene, &cases, &places, &mean_over, maximise.as_ref());
        checks.amount(&cases, &sweep.refined, maximise.as_ref(), inner.len(), scene_at);
        fill_placeholders(&mut scene.recipe, &cases, &sweep.swept, maximise.as_ref());
        fill_placeholders(&mut scene.recipe, &inner, &mean_over.swept, None);
        if let Some(optimise) = &optimise {
            let low: Vec<f64> = optimise.bounds.iter().map(|[low, _]| *low).collect();
            // As many as there are dampers: that was looked at when they were read.
            let _ = scene.recipe.set_gaps(optimise.gaps, &low);
        }
        places.extend(mean_over.places);
        let figures = figures?;
        let source = source?.unwrap_or_default();
        let chapter = source.chapter;
        checks.lines(&figures, &cases, figures_at);
        let experiment = Experiment {
            id: id.clone(),
            title: title?,
            source,
            about: about?,
            recipe: scene.recipe,
            solvers: all_solvers(&cases),
            cases,
            swept: sweep.swept,
            settings: run.settings,
            limit: run.limit,
            moved: run.moved,
            maximise,
            refined: sweep.refined.into_iter().map(|(refinement, _)| refinement).collect(),
            continued: sweep.continued.into_iter().map(|(continuation, _)| continuation).collect(),
            mean_over: inner,
            optimise,
            orbit: orbit.map(|orbit| orbit.continuation),
            starts: starts.as_ref().map(|read| read.starts.clone()),
            measures: words_only(&measures),
            trace,
            energies,
            shape,
            each_cycle,
            figures,
            without_source: without_source(
                root,
                self.assumptions.sheet.stated(chapter),
                &stated?.unwrap_or_default(),
                self.findings,
            ),
        };
        if self.cases == Cases::Tried {
            return Some(experiment);
        }
        let parts = scene.parts;
        checks.scenes(&experiment, |parameter, part| {
            let swept = parameter.and_then(|parameter| places.get(&parameter).copied());
            let of_starts = starts.as_ref().filter(|_| part == Some(Part::Start));
            if let Some(ReadStarts { particles_at, .. }) = of_starts {
                return *particles_at;
            }
            let at_part = || parts.iter().find(|(known, _)| Some(*known) == part).map(|(_, span)| *span);
            swept.or_else(at_part).unwrap_or(scene_at)
        });
        Some(experiment)
    }

    fn source(&self, node: &'t Node) -> Option<Source> {
        let fields = Fields::open(node, "a source", self.findings)?;
        let chapter = fields.optional("chapter", |node| count(node, "", MOST_CHAPTERS, self.findings));
        let section = fields.optional("section", |node| text(node, self.findings));
        let shown_in =
            fields.optional("shown_in", |node| one_or_more(node, self.findings, |node| text(node, self.findings)));
        fields.close()?;
        Some(Source { chapter: chapter?, section: section?, shown_in: shown_in?.unwrap_or_default() })
    }

    fn measures(&self, node: &'t Node) -> Option<Vec<(Measure, Span)>> {
        let measures = one_or_more(node, self.findings, |node| {
            Some((word::<Measure>(node, "measure", self.findings)?, node.span))
        })?;
        for (index, (measure, span)) in measures.iter().enumerate() {
            if measures[..index].iter().any(|(other, _)| other == measure) {
                return self.findings.wrong(*span, format!("`{}` is measured twice", super::word::word_of(*measure)));
            }
        }
        let mut all = Vec::with_capacity(measures.len());
        for (measure, span) in &measures {
            all.push((*measure, *span));
            let named = |companion: &Measure| measures.iter().any(|(other, _)| other == companion);
            all.extend(measure.companions().filter(|companion| !named(companion)).map(|companion| (companion, *span)));
        }
        Some(all)
    }

    /// Settings to take the mean over: a sweep without names and without refinement.
    fn mean_over(&self, node: &'t Node) -> Option<ReadSweep> {
        let sweep = read_sweep(node, self.findings)?;
        if sweep.cases.iter().any(|case| !case.sweep.is_empty()) || !sweep.refined.is_empty() {
            return self.findings.wrong(node.span, "a mean is taken over fixed points: neither `union` nor `refined`");
        }
        if let Some((_, at)) = sweep.continued.first() {
            return self
                .findings
                .wrong(*at, "what a mean is taken over has no order: `from: last` stands under `sweep`");
        }
        Some(sweep)
    }

    /// A mean has no time history.
    fn averaged_alone(&self, fields: &Fields<'t>) -> Option<()> {
        let lists = LISTS.into_iter().filter_map(|key| fields.get(key)).next();
        match (fields.get("mean_over"), lists) {
            (Some(_), Some(list)) => self.findings.report(
                list.span,
                "a mean over several scenes has no list of one of them",
                Some("give one of the scenes an experiment of its own".into()),
            ),
            _ => Some(()),
        }
    }

    /// An optimisation has rows of its own, and so have an orbit and random starts.
    fn whole_table_alone(&self, fields: &Fields<'t>) -> Option<()> {
        let mut fine = Some(());
        let given = |keys: &[&'static str]| -> Vec<_> { keys.iter().filter_map(|key| fields.get(key)).collect() };
        if fields.get("optimise").is_some() {
            for other in given(&[&["sweep", "maximise", "onset"], LISTS.as_slice()].concat()) {
                fine = self.findings.report(
                    other.span,
                    "an optimisation has candidates for rows: neither a sweep nor a list of another kind goes with it",
                    Some("what fitness is a mean over stands under `mean_over`".into()),
                );
            }
        }
        if fields.get("orbit").is_some() {
            for other in given(&[&["sweep", "mean_over", "maximise", "onset", "optimise"], LISTS.as_slice()].concat()) {
                fine = self.findings.report(
                    other.span,
                    "an orbit has the motions of its branches for rows: no sweep, mean, maximum or list goes with it",
                    Some("give one of the two an experiment of its own".into()),
                );
            }
        }
        if fields.get("starts").is_some() {
            for other in given(&[&["mean_over", "maximise", "onset", "optimise", "orbit"], LISTS.as_slice()].concat()) {
                fine = self.findings.report(
                    other.span,
                    "random starts have the motions that they end in for rows: no mean, maximum, orbit or list goes with them",
                    Some("give one of the two an experiment of its own".into()),
                );
            }
        }
        fine
    }

    /// The optimisation, with as many gaps as there are dampers. `Some(None)`: there is none.
    #[expect(clippy::option_option, reason = "absent and wrong are two things")]
    fn optimise(
        &self,
        optimise: Option<ReadOptimise>,
        scene: &ReadScene,
        inner: Option<&ReadSweep>,
    ) -> Option<Option<Optimise>> {
        let Some(optimise) = optimise else {
            for at in &scene.optimised {
                let help = "add `optimise`, or give the gap a value".to_owned();
                self.findings.report::<()>(*at, "nothing optimises this gap", Some(help));
            }
            return scene.optimised.is_empty().then_some(None);
        };
        if scene.optimised.len() != scene.recipe.dampers.len() || scene.optimised.is_empty() {
            let help = "write `gap: optimised` in every damper of the scene".to_owned();
            return self.findings.report(optimise.span, "a gap that is not optimised is not varied", Some(help));
        }
        let none = ReadSweep::none();
        let cases = &inner.unwrap_or(&none).cases;
        let mut counts = Vec::new();
        for case in cases {
            let mut recipe = scene.recipe.clone();
            let set = case.values.iter().try_for_each(|(parameter, value)| recipe.set(*parameter, *value));
            // What physics refuses is told where all scenes are tried.
            counts.extend(set.and_then(|()| recipe.resolve(self.assumptions)).map(|scene| scene.dampers.len()));
        }
        match counts.as_slice() {
            [] => optimise.spread(scene.recipe.dampers.len(), self.findings).map(Some),
            [first, rest @ ..] if rest.iter().all(|other| other == first) => {
                optimise.spread(*first, self.findings).map(Some)
            }
            _ => {
                self.findings.wrong(optimise.span, "the number of dampers, and with it of gaps, is not always the same")
            }
        }
    }

    fn maximise(&self, node: &'t Node) -> Option<Maximise> {
        let (measure, fields) =
            self.looked_for(node, "maximise: {velocity_ratio: {over: …, in: …}}", "a maximisation")?;
        let over = fields.required("over", |node| word::<Parameter>(node, "parameter", self.findings));
        let grid = fields.required("in", |node| self.grid(node, over?));
        let refine = fields.optional("refine", |node| count(node, "rounds", 20, self.findings));
        fields.close()?;
        let wanted = SearchPoint::Maximum;
        Some(Maximise { measure: measure?, over: over?, grid: grid?, refine: refine?.unwrap_or(0), wanted })
    }

    /// `onset: {ceiling_impacts: {over: force_ratio, in: …}}`.
    fn onset(&self, node: &'t Node) -> Option<Maximise> {
        let (measure, fields) = self.looked_for(node, "onset: {ceiling_impacts: {over: …, in: …}}", "an onset")?;
        let over = fields.required("over", |node| word::<Parameter>(node, "parameter", self.findings));
        let grid = fields.required("in", |node| self.grid(node, over?));
        fields.close()?;
        let (measure, over, grid) = (measure?, over?, grid?);
        if !measure.is_count() {
            let message = format!("`{}` has no onset: it is no number of events", word_of(measure));
            let help = "events are counted by separations, floor_impacts, ceiling_impacts, stop_impacts".to_owned();
            return self.findings.report(node.span, message, Some(help));
        }
        if grid.len() < 2 || !over.varies_smoothly() {
            return self
                .findings
                .wrong(node.span, "an onset lies between two values of a parameter that varies smoothly");
        }
        Some(Maximise { measure, over, grid, refine: 0, wanted: SearchPoint::Onset })
    }

    /// The measure of which a point is looked for, and how.
    fn looked_for(&self, node: &'t Node, form: &str, what: &'static str) -> Option<(Option<Measure>, Fields<'t>)> {
        let Value::Mapping(entries) = &node.value else {
            return self.findings.wrong(node.span, format!("write `{form}`"));
        };
        let [entry] = entries.as_slice() else {
            return self.findings.wrong(node.span, format!("{what} is of one measure"));
        };
        let measure = from_word::<Measure>(&entry.key)
            .or_else(|| no_such(self.findings, entry.key_span, "measure", &entry.key, words::<Measure>()));
        Some((measure, Fields::open(&entry.node, what, self.findings)?))
    }

    /// Values of a parameter that increase.
    fn grid(&self, node: &'t Node, over: Parameter) -> Option<Vec<f64>> {
        let grid = numbers(node, over, self.findings)?;
        if !grid.is_sorted_by(|a, b| a < b) {
            return self.findings.wrong(node.span, "the points to look at increase");
        }
        Some(grid)
    }

    /// What stands under `run`; what it leaves out is the study's, or the same for every study. What is read off the model alone
    /// needs no cycles.
    fn run(&self, experiment: &Fields<'t>, of_model: bool) -> Option<Run> {
        let given = match experiment.get("run") {
            Some(node) => self.given_run(node)?,
            None => GivenRun { span: experiment.span(), ..GivenRun::default() },
        };
        let no_run = of_model.then_some(Cycles { skip: 0, average: 1 });
        let (span, usual) = (given.span, self.assumptions.sheet.cycles().or(no_run));
        let cycles = |key: &str, given: Option<u32>, usual: Option<u32>| {
            let help = "write `run: {skip: 25 cycles, average: 100 cycles}`, here or, for all experiments, under \
                        `defaults` in the assumptions file";
            let message = || format!("a run lacks `{key}`, and the study has no default for it");
            given.or(usual).or_else(|| self.findings.report(span, message(), Some(help.into())))
        };
        let skip = cycles("skip", given.skip, usual.map(|usual| usual.skip));
        let average = cycles("average", given.average, usual.map(|usual| usual.average));
        Some(Run {
            solvers: given.solvers.unwrap_or_else(|| vec![SolverChoice::EventDriven]),
            settings: Settings {
                skip: skip?,
                average: average?,
                until: given.until.map_or(Until::Cycles, |(until, _)| until),
                round_period_to: given.round_period_to,
                ensemble: given.ensemble.unwrap_or(USUAL_ENSEMBLE),
            },
            settled_at: given.until.filter(|(until, _)| *until == Until::Settled).map(|(_, at)| at),
            limit: given.limit.unwrap_or_default(),
            moved: given.moved,
        })
    }

    fn given_run(&self, node: &'t Node) -> Option<GivenRun> {
        let fields = Fields::open(node, "a run", self.findings)?;
        let solvers =
            fields.optional("solver", |node| one_or_more(node, self.findings, |node| read_solver(node, self.findings)));
        let skip = fields.optional("skip", |node| read_skip(node, self.findings));
        let average = fields.optional("average", |node| read_average(node, self.findings));
        let until =
            fields.optional("until", |node| word::<Until>(node, "end", self.findings).map(|until| (until, node.span)));
        let round_period_to =
            fields.optional("round_period_to", |node| above_zero(node, Dimension::Time, self.findings));
        let ensemble = fields.optional("ensemble", |node| match &node.value {
            Value::Scalar(word) if word == "none" => Some(0),
            _ => count(node, "members", 10_000, self.findings),
        });
        let moved = fields.optional("sensitivity", |node| match &node.value {
            Value::Scalar(word) if word == "none" => Some(BTreeSet::new()),
            _ => one_or_more(node, self.findings, |node| self.assumptions.sheet.named(node, self.findings))
                .map(|names| names.into_iter().collect()),
        });
        let limit = fields.optional("limit", |node| read_limit(node, self.findings));
        fields.close()?;
        Some(GivenRun {
            span: node.span,
            solvers: solvers?,
            skip: skip?,
            average: average?,
            until: until?,
            round_period_to: round_period_to?,
            ensemble: ensemble?,
            limit: limit?,
            moved: moved?,
        })
    }

    fn trace(&self, node: &'t Node) -> Option<TraceSpec> {
        let fields = Fields::open(node, "a trace", self.findings)?;
        let cycles = |node: &'t Node| count(node, "cycles", MOST_CYCLES, self.findings);
        let from = fields.required("from", cycles);
        let to = fields.required("to", cycles);
        let samples = fields.required("samples_per_cycle", |node| count(node, "samples", 1_000_000, self.findings));
        fields.close()?;
        let (from_cycle, to_cycle, samples) = (from?, to?, samples?);
        if from_cycle >= to_cycle {
            return self.findings.wrong(node.span, "a trace ends after the cycle it begins with");
        }
        let all = u64::from(to_cycle - from_cycle) * u64::from(samples);
        if all == 0 || all > MOST_SAMPLES {
            return self.findings.wrong(node.span, format!("a trace has 1 to {MOST_SAMPLES} samples, not {all}"));
        }
        Some(TraceSpec { from_cycle, to_cycle, samples })
    }
}

/// Most points of a shape.
const MOST_POINTS: u64 = 100_000;

impl<'t> ExperimentReader<'t> {
    /// All lists of a row are of one length.
    fn one_list(&self, fields: &Fields<'t>) -> Option<()> {
        let given: Vec<_> = LISTS.into_iter().filter_map(|key| fields.get(key)).collect();
        match given.as_slice() {
            [_, second, ..] => self.findings.report(
                second.span,
                "a row keeps lists of one length: one of `trace`, `energies`, `shape` and `each_cycle`",
                Some("give the other an experiment of its own".into()),
            ),
            _ => Some(()),
        }
    }

    fn energies(&self, node: &'t Node) -> Option<EnergySpec> {
        let fields = Fields::open(node, "a span of cycles", self.findings)?;
        let cycles = |node: &'t Node| count(node, "cycles", MOST_CYCLES, self.findings);
        let (from, to) = (fields.required("from", cycles), fields.required("to", cycles));
        fields.close()?;
        let (from_cycle, to_cycle) = (from?, to?);
        if from_cycle >= to_cycle {
            return self.findings.wrong(node.span, "a span ends after the cycle it begins with");
        }
        Some(EnergySpec { from_cycle, to_cycle })
    }

    /// `impact_phase`, or `{of: impact_phase, last: 20 cycles}`.
    fn each_cycle(&self, node: &'t Node) -> Option<CycleSpec> {
        let value = |node| word::<CycleValue>(node, "value of a cycle", self.findings);
        let Value::Mapping(_) = node.value else { return Some(CycleSpec { of: value(node)?, last: None }) };
        let fields = Fields::open(node, "a value of each cycle", self.findings)?;
        let of = fields.required("of", value);
        let last = fields.optional("last", |node| match count(node, "cycles", MOST_CYCLES, self.findings)? {
            0 => self.findings.wrong(node.span, "one cycle at least is kept"),
            cycles => Some(cycles),
        });
        fields.close()?;
        Some(CycleSpec { of: of?, last: last? })
    }

    fn shape(&self, node: &'t Node) -> Option<ShapeSpec> {
        let fields = Fields::open(node, "a shape", self.findings)?;
        let of = fields.required("of", |node| word::<ShapeOf>(node, "shape", self.findings));
        let points = fields.required("points", |node| {
            one_or_more(node, self.findings, |node| match count(node, "points", 100_000, self.findings)? {
                0 | 1 => self.findings.wrong(node.span, "a shape has two points along a side at least"),
                points => Some(points),
            })
        });
        fields.close()?;
        let (of, points) = (of?, points?);
        let all: u64 = points.iter().map(|count| u64::from(*count)).product();
        if all > MOST_POINTS || points.len() > 2 {
            return self
                .findings
                .wrong(node.span, format!("a shape has {MOST_POINTS} points at most, along two sides"));
        }
        Some(ShapeSpec { of, points })
    }
}

/// With what tells how a run that is to settle ended.
fn with_the_end(mut measures: Vec<(Measure, Span)>, settled_at: Span) -> Vec<(Measure, Span)> {
    for measure in Measure::of_settled_runs() {
        if measures.iter().all(|(other, _)| *other != measure) {
            measures.push((measure, settled_at));
        }
    }
    measures
}

/// With the motion that a run ends in.
fn with_the_motion(mut measures: Vec<(Measure, Span)>, at: Span) -> Vec<(Measure, Span)> {
    for measure in std::iter::once(Measure::Motion).chain(Measure::Motion.companions()) {
        if measures.iter().all(|(other, _)| *other != measure) {
            measures.push((measure, at));
        }
    }
    measures
}

fn words_only(measures: &[(Measure, Span)]) -> Vec<Measure> {
    measures.iter().map(|(measure, _)| *measure).collect()
}

/// Cases run under the experiment's solvers unless their named sweep has its own.
fn with_solvers(mut cases: Vec<Case>, usual: &[SolverChoice]) -> Vec<Case> {
    for case in cases.iter_mut().filter(|case| case.solvers.is_empty()) {
        case.solvers = usual.to_vec();
    }
    cases
}

fn all_solvers(cases: &[Case]) -> Vec<SolverChoice> {
    let mut solvers: Vec<SolverChoice> = Vec::new();
    for solver in cases.iter().flat_map(|case| &case.solvers) {
        if !solvers.contains(solver) {
            solvers.push(*solver);
        }
    }
    solvers
}

/// Parameters that every case sets get the first case's value, so that what the scene says of them has no meaning left.
fn fill_placeholders(recipe: &mut Recipe, cases: &[Case], swept: &[Parameter], maximise: Option<&Maximise>) {
    let set = |recipe: &mut Recipe, parameter, value| {
        // A parameter that the scene lacks is reported when its cases are resolved.
        let _ = recipe.set(parameter, value);
    };
    for parameter in swept.iter().filter(|parameter| parameter.words().is_empty()) {
        if let (Some(first), true) =
            (cases.first().and_then(|case| case.get(*parameter)), cases.iter().all(|c| c.get(*parameter).is_some()))
        {
            set(recipe, *parameter, first);
        }
    }
    if let Some((over, first)) = maximise.and_then(|maximise| Some((maximise.over, *maximise.grid.first()?))) {
        set(recipe, over, ParameterValue::Number(first));
    }
}
