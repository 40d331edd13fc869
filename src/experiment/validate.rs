//! A node tree to a validated [`Experiment`]: each part read by its own file, then checked against one another.
//!
//! A check runs as soon as the parts it talks about are sound, so a mistake in a figure is reported beside one in the
//! scene. The last check resolves every case into its scene: what physics refuses is found before anything runs.

use std::iter;

use super::about_study::MOST_CHAPTERS;
use super::assumption_sheet::AssumptionSheet;
use super::at::At;
use super::check::Checks;
use super::columns::{Columns, Lists, labels};
use super::continuation_reader::{ReadContinuation, read_continuation};
use super::definition::{Case, Experiment, ExperimentId, Maximise, Source};
use super::diagnostic::{Findings, Problems, Span};
use super::exclusions::{check_lists, check_mean, check_rows};
use super::figure::FigureReader;
use super::lists::{read_each_cycle, read_energies, read_shape, read_tolerances, read_trace};
use super::looked_for::{read_maximise, read_onset};
use super::optimise::Optimise;
use super::optimise_reader::{ReadOptimise, read_optimise};
use super::recipe::{Assumptions, Parameter, ParameterValue, Recipe};
use super::refusal::Places;
use super::run::read_run;
use super::scene::{ReadScene, read_scene};
use super::schema;
use super::starts_reader::read_starts;
use super::stated::{STATED, read_statements, without_source};
use super::sweep::{ReadSweep, read_sweep};
use super::word::word_of;
use super::yaml::read_tree;
use crate::measure::{Measure, NamedRows, Settings, ShapeOf, SolverChoice};

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
    parse_with(id, file, text, assumptions, Cases::ToTry(&|_| {}))
}

/// Whether the scenes of an experiment's cases are known to resolve.
#[derive(Clone, Copy)]
pub(crate) enum Cases<'t> {
    /// They are not. To try them may take longest: this hears of the experiment before.
    ToTry(&'t dyn Fn(&Experiment)),
    /// This very text was read before, with these assumptions.
    Tried,
}

/// The same of a text whose cases may have been tried.
pub(crate) fn parse_with(
    id: &ExperimentId,
    file: &str,
    text: &str,
    assumptions: &Assumptions,
    cases: Cases<'_>,
) -> Result<Experiment, Problems> {
    let findings = Findings::default();
    let experiment = read_tree(text, &findings).and_then(|root| {
        let reader = ExperimentReader { findings: &findings, assumptions, cases };
        reader.experiment(id, At::Node(&root, &findings))
    });
    findings.finish(file, text, experiment)
}

/// JSON Schema of an experiment; of the study's assumptions it offers those that fit a place.
#[must_use]
pub fn experiment_schema(sheet: &AssumptionSheet) -> serde_json::Value {
    let (findings, assumptions) = (Findings::default(), sheet.assumptions());
    let reader = ExperimentReader { findings: &findings, assumptions: &assumptions, cases: Cases::Tried };
    let any = ExperimentId(String::new());
    schema::described("Experiment", "An experiment", |at| reader.experiment(&any, at))
}

struct ExperimentReader<'t> {
    findings: &'t Findings,
    assumptions: &'t Assumptions,
    cases: Cases<'t>,
}

impl<'t> ExperimentReader<'t> {
    fn experiment(&self, id: &ExperimentId, at: At<'_>) -> Option<Experiment> {
        let keys = at.keys("an experiment")?;
        let title = keys.required("title", "A few words", |at| at.text());
        let source = keys.optional("source", "Where a publication shows it", read_source);
        let about = keys.required("about", "One or two sentences", |at| at.text());
        let scene = keys.required("scene", "What is simulated", |at| read_scene(at, self.assumptions));
        let branches = "Branches of periodic motions along a parameter, stable or not";
        let orbit = keys.optional("orbit", branches, read_continuation);
        let box_of_starts =
            "A box of random starts: the motions that each case may end in, with the share of the box of each";
        let starts = keys.optional("starts", box_of_starts, read_starts);
        let sweep = match &orbit {
            Some(Some(orbit)) => Some(Some(orbit.sweep())),
            Some(None) => keys.optional("sweep", "What varies from row to row", read_sweep),
            None => None,
        };
        let stated = "Inputs that the text states, by table, figure or section";
        let stated = keys.optional(STATED, stated, read_statements);
        let mean_over =
            keys.optional("mean_over", "Settings that a mean is taken over", |at| mean_over(at, read_sweep(at)?));
        let measures = keys.required("measure", "What is measured", read_measures);
        let looked_for = [
            ("maximise", "The measure whose maximum is looked for"),
            ("onset", "The number of events of which it is looked for where it ceases to be zero"),
        ];
        let maximise = keys.at_most_one(&looked_for, |key, at| match key {
            "onset" => read_onset(at),
            _ => read_maximise(at),
        });
        let optimise = keys.optional("optimise", "A search for the best gaps", read_optimise);
        let trace = keys.optional("trace", "A time history that is kept", read_trace);
        let energies = keys.optional("energies", "Kinetic energies that are kept", read_energies);
        let shape = keys.optional("shape", "A shape that is kept", read_shape);
        let each_cycle = "A value of each averaged cycle that is kept";
        let each_cycle = keys.optional("each_cycle", each_cycle, read_each_cycle);
        let uncertain = "Relative standard uncertainties of design parameters";
        let tolerances = keys.optional("tolerances", uncertain, |at| Some((read_tolerances(at)?, at.span())));
        let lists =
            matches!(trace, Some(Some(_))) || matches!(energies, Some(Some(_))) || matches!(each_cycle, Some(Some(_)));
        let deflection = matches!(&shape, Some(Some(shape)) if shape.of == ShapeOf::Deflection);
        let of_model = measures.as_ref().is_some_and(|measures| measures.iter().all(|(measure, _)| measure.is_modal()));
        let no_run = of_model && !lists && !deflection;
        let run = read_run(&keys, &self.assumptions.sheet, no_run, self.findings);
        let measures = measures.map(|mut measures| {
            let settled_at = run.as_ref().and_then(|run| run.settled_at);
            bring(&mut measures, settled_at, Measure::of_settled_runs());
            let starts_at = starts.iter().flatten().next().map(|starts| starts.span);
            bring(&mut measures, starts_at, iter::once(Measure::Motion).chain(Measure::Motion.companions()));
            let tolerances_at = tolerances.iter().flatten().next().map(|(_, at)| *at);
            bring(&mut measures, tolerances_at, iter::once(Measure::VelocityRatioInput));
            measures
        });
        let one_list = check_lists(&keys, self.findings);
        let alone = check_rows(&keys, self.findings);
        let whole = check_mean(&keys, self.findings);
        let place = |key| keys.span_of(key).unwrap_or(keys.span());
        let (energies_at, each_cycle_at) = (place("energies"), place("each_cycle"));
        let unordered = [("maximise", "a maximum"), ("onset", "an onset"), ("mean_over", "a mean over several scenes")];
        let unordered = unordered.iter().find_map(|(key, what)| Some((*what, keys.span_of(key)?)));
        let (scene_at, optimise_at) = (place("scene"), place("optimise"));
        let figures_at = place(if keys.span_of("figure").is_some() { "figure" } else { "figures" });
        let looked_for_at = place(if keys.span_of("maximise").is_some() { "maximise" } else { "onset" });

        let kept = match (&trace, &energies, &shape, &each_cycle) {
            (Some(trace), Some(energies), Some(shape), Some(each_cycle)) => {
                Some(Lists::kept(trace.as_ref(), energies.as_ref(), shape.as_ref(), each_cycle.as_ref()))
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
                let labels = labels(sweep.as_ref().map_or(&[], |sweep| &sweep.cases));
                let columns = Columns::of(swept, &labels, &words_only(measures), maximise.as_ref(), kept);
                match &starts {
                    Some(Some(read)) => Some(columns.with_basins(&read.starts)),
                    Some(None) => Some(columns),
                    None => None,
                }
            }
            _ => None,
        };
        let cases = match (&orbit, &sweep) {
            (Some(None), Some(Some(sweep))) => sweep.cases.as_slice(),
            _ => &[],
        };
        let figures = FigureReader { findings: self.findings, columns: columns.as_ref(), cases }.figures(&keys);
        keys.close();

        let checks = Checks { findings: self.findings, assumptions: self.assumptions };
        one_list?;
        alone?;
        whole?;
        let (mean_over, optimise) = (mean_over?.unwrap_or_else(ReadSweep::none), optimise?);
        let (measures, maximise, trace, run) = (measures?, maximise?, trace?, run?);
        let (energies, shape, each_cycle) = (energies?, shape?, each_cycle?);
        let tolerances = tolerances?.map_or_else(Vec::new, |(tolerances, _)| tolerances);
        checks.measures(&measures, maximise.as_ref(), trace.as_ref(), shape.as_ref());
        checks.tolerances(&measures, &tolerances);
        checks.energies(energies.as_ref(), &run.settings, energies_at);
        checks.each_cycle(each_cycle.as_ref(), &run.settings, each_cycle_at);
        if let Some((_, at)) =
            run.transient.as_ref().filter(|_| matches!(orbit, Some(Some(_))) || matches!(starts, Some(Some(_))))
        {
            self.findings.wrong::<()>(*at, "cycles that an assumption leaves out are for sweeps: state them here");
        }
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
        checks.motion(&measures, maximise.as_ref(), !inner.is_empty(), &all_solvers(&cases));
        checks.refined(&sweep.refined, &measures);
        checks.continued(&sweep.continued, &cases, unordered);
        if let (true, Some((_, at))) = (no_run, sweep.continued.first()) {
            self.findings
                .wrong::<()>(*at, "what is measured here is read off the model: there is no run to go on from");
        }
        checks.coverage(&scene, &cases, &places, &mean_over, maximise.as_ref());
        let looked_for = maximise.as_ref().map(|maximise| (maximise, looked_for_at));
        checks.marked(&scene, &cases, &places, &mean_over, looked_for);
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
        let At::Node(root, _) = at else { return None };
        let experiment = Experiment {
            id: id.clone(),
            title: title?,
            source,
            about: about?,
            recipe: scene.recipe,
            solvers: all_solvers(&cases),
            cases,
            swept: sweep.swept,
            settings: Settings {
                named: named_rows(&measures, maximise.as_ref()),
                mean_of: inner.len() as u32,
                ..run.settings
            },
            transient: run.transient.map(|(transient, _)| transient),
            limit: run.limit,
            moved: run.moved.as_ref().map(|moved| moved.keys().cloned().collect()),
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
            tolerances,
            figures,
            without_source: without_source(
                root,
                self.assumptions.sheet.stated(chapter),
                &stated?.unwrap_or_default(),
                self.findings,
            ),
        };
        match self.cases {
            Cases::Tried => return Some(experiment),
            // What is shown of an experiment with mistakes is the mistakes.
            Cases::ToTry(_) if self.findings.any() => {}
            Cases::ToTry(on_untried) => on_untried(&experiment),
        }
        if let Some(maximise) = &experiment.maximise {
            places.entry(maximise.over).or_insert(looked_for_at);
        }
        if let At::Node(node, _) = at.under("scene") {
            let starts = starts.as_ref().map(|read| read.particles_at);
            let left_to_sweep = &scene.swept;
            checks.scenes(&experiment, &Places { scene: node, left_to_sweep, parameters: places, starts });
        }
        checks.sensitivity(run.moved.as_ref(), &experiment, &self.assumptions.sheet);
        Some(experiment)
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
}

fn read_source(at: At<'_>) -> Option<Source> {
    let keys = at.keys("a source")?;
    let chapter = keys.optional("chapter", "Chapter", |at| at.count("", MOST_CHAPTERS));
    let section = keys.optional("section", "Section, for example \"3.6.3\"", |at| at.text());
    let shown_in =
        keys.optional("shown_in", "Figures, or a citation, for example Fig. 18", |at| at.one_or_more(|at| at.text()));
    keys.close()?;
    Some(Source { chapter: chapter?, section: section?, shown_in: shown_in?.unwrap_or_default() })
}

fn read_measures(at: At<'_>) -> Option<Vec<(Measure, Span)>> {
    let measures = at.one_or_more(|at| Some((read_measure(at)?, at.span())))?;
    for (index, (measure, span)) in measures.iter().enumerate() {
        if measures[..index].iter().any(|(other, _)| other == measure) {
            return at.wrong_at(*span, format!("`{}` is measured twice", word_of(*measure)));
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

/// The word of a measure.
pub(super) fn read_measure(at: At<'_>) -> Option<Measure> {
    at.named("measure", "A number that is measured", |at| at.word::<Measure>("measure"))
}

/// Settings to take the mean over: a sweep without names and without refinement.
fn mean_over(at: At<'_>, sweep: ReadSweep) -> Option<ReadSweep> {
    if sweep.cases.iter().any(|case| !case.sweep.is_empty()) || !sweep.refined.is_empty() {
        return at.wrong("a mean is taken over fixed points: neither `union` nor `refined`");
    }
    if let Some((_, from_last)) = sweep.continued.first() {
        return at.wrong_at(*from_last, "what a mean is taken over has no order: `from: last` stands under `sweep`");
    }
    Some(sweep)
}

/// Adds the measures that come with something, where it stands, unless they are asked for already.
fn bring(measures: &mut Vec<(Measure, Span)>, at: Option<Span>, others: impl Iterator<Item = Measure>) {
    let Some(at) = at else { return };
    for measure in others {
        if measures.iter().all(|(known, _)| *known != measure) {
            measures.push((measure, at));
        }
    }
}

/// Numbers that come with the name of a motion stand where `motion` does. One that has a place of its own, or whose maximum is
/// looked for, is wanted in every row.
fn named_rows(measures: &[(Measure, Span)], maximise: Option<&Maximise>) -> NamedRows {
    let name_at = measures.iter().find(|(measure, _)| measure.is_name()).map(|(_, at)| *at);
    let is_own = |(measure, at): &(Measure, Span)| measure.needs_motion() && Some(*at) != name_at;
    let is_looked_for = maximise.is_some_and(|maximise| maximise.measure.needs_motion());
    if is_looked_for || measures.iter().any(is_own) { NamedRows::All } else { NamedRows::Results }
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
