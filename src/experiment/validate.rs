//! A node tree to a validated [`Experiment`]: each part read by its own file, then checked against one another.
//!
//! A check runs as soon as the parts it talks about are sound, so a mistake in a figure is reported beside one in the
//! scene. The last check resolves every case into its scene: what physics refuses is found before anything runs.

use super::check::Checks;
use super::definition::Experiment;
use super::figure::FigureReader;
use super::id::ExperimentId;
use super::parts::{Head, Parts, Sound};
use super::recipe::{AssumptionSheet, Assumptions, Parameter, ParameterValue};
use super::refusal::Places;
use super::scene::ReadScene;
use super::stated::without_source;
use super::sweep::ReadSweep;
use crate::measure::{Measure, NamedRows, Settings};
use crate::yaml::word::words;
use crate::yaml::{At, Findings, Keys, Problems, Span, described, read_tree};

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
    let findings = Findings::beside_sweep(words::<Parameter>());
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
    described("Experiment", "An experiment", |at| reader.experiment(&any, at))
}

struct ExperimentReader<'t> {
    findings: &'t Findings,
    assumptions: &'t Assumptions,
    cases: Cases<'t>,
}

impl ExperimentReader<'_> {
    fn experiment(&self, id: &ExperimentId, at: At<'_>) -> Option<Experiment> {
        let keys = at.keys("an experiment")?;
        let head = Head::read(&keys);
        let parts = Parts::read(&keys, self.assumptions, self.findings);
        let (columns, places) = (parts.columns(), KeyPlaces::of(&keys));
        let reader = FigureReader { findings: self.findings, columns: columns.as_ref(), cases: parts.swept_cases() };
        let figures = reader.figures(&keys);
        keys.close();

        self.check_measured(&parts, &places)?;
        let mut sound = parts.sound()?;
        self.check_simulated(&sound, &places);
        fill_placeholders(&mut sound);
        let figures = figures?;
        self.checks().lines(&figures, &sound.sweep.cases, places.figures);
        let At::Node(root, _) = at else { return None };
        let source = head.source?;
        let of_chapter = self.assumptions.sheet.stated(source.chapter);
        let without_source = without_source(root, of_chapter, &head.stated?, self.findings);
        let experiment = Experiment {
            id: id.clone(),
            title: head.title?,
            source,
            about: head.about?,
            solvers: sound.solvers(),
            settings: Settings { named: named_rows(&sound), mean_of: sound.inner().len() as u32, ..sound.run.settings },
            transient: sound.run.transient.as_ref().map(|(transient, _)| transient.clone()),
            limit: sound.run.limit,
            moved: sound.run.moved.as_ref().map(|moved| moved.keys().cloned().collect()),
            mean_over: sound.inner().to_vec(),
            measures: sound.words_of_measures(),
            recipe: sound.scene.recipe,
            cases: sound.sweep.cases,
            swept: sound.sweep.swept,
            maximise: sound.maximise,
            refined: sound.sweep.refined.into_iter().map(|(refinement, _)| refinement).collect(),
            continued: sound.sweep.continued.into_iter().map(|(continuation, _)| continuation).collect(),
            optimise: sound.optimise,
            orbit: sound.orbit.map(|orbit| orbit.continuation),
            starts: sound.starts.as_ref().map(|read| read.starts.clone()),
            trace: sound.trace,
            energies: sound.energies,
            shape: sound.shape,
            each_cycle: sound.each_cycle,
            tolerances: sound.tolerances,
            figures,
            without_source,
        };
        match self.cases {
            Cases::Tried => return Some(experiment),
            // What is shown of an experiment with mistakes is the mistakes.
            Cases::ToTry(_) if self.findings.any() => {}
            Cases::ToTry(on_untried) => on_untried(&experiment),
        }
        let mut parameters = sound.sweep.places;
        parameters.extend(sound.mean_over.places);
        if let Some(maximise) = &experiment.maximise {
            parameters.entry(maximise.over).or_insert(places.looked_for);
        }
        if let (At::Node(whole, _), At::Node(scene, _)) = (at, at.under("scene")) {
            let starts = sound.starts.as_ref().map(|read| read.particles_at);
            let left_to_sweep = &sound.scene.swept;
            self.checks().scenes(&experiment, &Places { whole, scene, left_to_sweep, parameters, starts });
        }
        self.checks().sensitivity(sound.run.moved.as_ref(), &experiment, &self.assumptions.sheet);
        Some(experiment)
    }

    fn checks(&self) -> Checks<'_> {
        Checks { findings: self.findings, assumptions: self.assumptions }
    }

    /// Looks at what is measured and kept, which may be sound where the scene is not.
    fn check_measured(&self, parts: &Parts, places: &KeyPlaces) -> Option<()> {
        let checks = self.checks();
        parts.rows_fit.and(parts.lists_fit)?;
        parts.mean_over.as_ref().and(parts.optimise.as_ref())?;
        let (measures, run) = (parts.measures.as_ref()?, parts.run.as_ref()?);
        let (maximise, trace) = (parts.maximise.as_ref()?.as_ref(), parts.trace.as_ref()?.as_ref());
        let (energies, shape) = (parts.energies.as_ref()?.as_ref(), parts.shape.as_ref()?.as_ref());
        let (each_cycle, tolerances) = (parts.each_cycle.as_ref()?.as_ref(), parts.tolerances.as_ref()?.as_ref());
        checks.measures(measures, maximise, trace, shape);
        checks.tolerances(measures, tolerances.map_or(&[], |(tolerances, _)| tolerances));
        checks.energies(energies, &run.settings, places.energies);
        checks.each_cycle(each_cycle, &run.settings, places.each_cycle);
        let has_motions = matches!(parts.orbit, Some(Some(_))) || matches!(parts.starts, Some(Some(_)));
        if let Some((_, at)) = run.transient.as_ref().filter(|_| has_motions) {
            self.findings.wrong::<()>(*at, "cycles that an assumption leaves out are for sweeps: state them here");
        }
        if let Some(at) = run.settled_at {
            checks.settled(measures, energies.is_some(), &run.solvers, at);
        }
        Some(())
    }

    /// Looks at what is simulated.
    fn check_simulated(&self, sound: &Sound, places: &KeyPlaces) {
        let checks = self.checks();
        let Sound { scene, orbit, starts, sweep, mean_over, maximise, optimise, measures, run, .. } = sound;
        let (excitation, maximise) = (&scene.recipe.excitation.kind, maximise.as_ref());
        if let Some(orbit) = orbit {
            checks.orbit(measures, &run.solvers, &run.settings, orbit.span);
            checks.repeats(excitation, orbit.span);
        }
        if let Some(starts) = starts {
            checks.starts(starts, run.settled_at.is_some(), sweep);
            checks.repeats(excitation, starts.span);
        }
        if let Some(optimise) = optimise {
            checks.optimise(optimise, measures, &run.solvers, places.optimise);
        }
        checks.excitation(measures, excitation);
        let of_settled = measures.iter().find(|(measure, _)| measure.needs_settled()).map(|(_, at)| *at);
        if let Some(at) = run.settled_at.or(of_settled) {
            checks.repeats(excitation, at);
        }
        checks.mean_over(mean_over, &sweep.places, maximise);
        checks.motion(measures, maximise, !sound.inner().is_empty(), &sound.solvers());
        checks.refined(&sweep.refined, measures);
        checks.continued(&sweep.continued, &sweep.cases, places.unordered);
        if let (true, Some((_, at))) = (sound.is_of_model, sweep.continued.first()) {
            self.findings
                .wrong::<()>(*at, "what is measured here is read off the model: there is no run to go on from");
        }
        checks.coverage(scene, sweep, mean_over, maximise);
        checks.marked(scene, sweep, mean_over, maximise.map(|maximise| (maximise, places.looked_for)));
        checks.amount(sweep, maximise, sound.inner().len(), places.scene);
    }
}

/// Where keys of an experiment stand, or the experiment itself where they do not.
struct KeyPlaces {
    scene: Span,
    optimise: Span,
    energies: Span,
    each_cycle: Span,
    figures: Span,
    /// `maximise` or `onset`.
    looked_for: Span,
    /// The first key whose rows have no order, and what it asks for.
    unordered: Option<(&'static str, Span)>,
}

impl KeyPlaces {
    fn of(keys: &Keys<'_>) -> Self {
        let place = |key| keys.span_of(key).unwrap_or(keys.span());
        let one_of = |[first, second]: [&'static str; 2]| keys.span_of(first).unwrap_or_else(|| place(second));
        let unordered = [("maximise", "a maximum"), ("onset", "an onset"), ("mean_over", "a mean over several scenes")];
        Self {
            scene: place("scene"),
            optimise: place("optimise"),
            energies: place("energies"),
            each_cycle: place("each_cycle"),
            figures: one_of(["figure", "figures"]),
            looked_for: one_of(["maximise", "onset"]),
            unordered: unordered.into_iter().find_map(|(key, what)| Some((what, keys.span_of(key)?))),
        }
    }
}

/// Numbers that come with the name of a motion stand where `motion` does. One that has a place of its own, or whose maximum is
/// looked for, is wanted in every row.
fn named_rows(Sound { measures, maximise, .. }: &Sound) -> NamedRows {
    let name_at = measures.iter().find(|(measure, _)| measure.is_name()).map(|(_, at)| *at);
    let is_own = |(measure, at): &(Measure, Span)| measure.needs_motion() && Some(*at) != name_at;
    let is_looked_for = maximise.as_ref().is_some_and(|maximise| maximise.measure.needs_motion());
    if is_looked_for || measures.iter().any(is_own) { NamedRows::All } else { NamedRows::Results }
}

/// Parameters that every case sets get the first case's value, and gaps that are optimised the least, so that what the scene says of them
/// has no meaning left.
fn fill_placeholders(sound: &mut Sound) {
    let Sound { scene: ReadScene { recipe, .. }, sweep, mean_over, maximise, optimise, .. } = sound;
    let mut set = |parameter, value| {
        // A parameter that the scene lacks is reported when its cases are resolved.
        let _ = recipe.set(parameter, value);
    };
    for ReadSweep { cases, swept, .. } in [&*sweep, &*mean_over] {
        for parameter in swept.iter().filter(|parameter| parameter.words().is_empty()) {
            let is_always_set = cases.iter().all(|case| case.get(*parameter).is_some());
            if let (Some(first), true) = (cases.first().and_then(|case| case.get(*parameter)), is_always_set) {
                set(*parameter, first);
            }
        }
    }
    if let Some((over, first)) = maximise.as_ref().and_then(|maximise| Some((maximise.over, *maximise.grid.first()?))) {
        set(over, ParameterValue::Number(first));
    }
    if let Some(optimise) = optimise {
        let low: Vec<f64> = optimise.bounds.iter().map(|[low, _]| *low).collect();
        // As many as there are dampers: that was looked at when they were read.
        let _ = recipe.set_gaps(optimise.gaps, &low);
    }
}
