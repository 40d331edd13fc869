//! Checks across the parts of an experiment, before anything runs.

use std::collections::BTreeMap;

use super::recipe::{AssumptionName, AssumptionSheet, Assumptions, ExcitationKind, Parameter, ParameterValue, Part};
use crate::dynamics::Until;
use crate::measure::{CycleSpec, EnergySpec, Measure, Settings, ShapeSpec, SolverChoice, Tolerance, TraceSpec, Under};
use crate::yaml::{Findings, Span};

use super::case::Case;
use super::continued::ContinuedSweep;
use super::definition::Experiment;
use super::figure_spec::{Drawing, FigureSpec, Panel};
use super::maximise::{Maximise, SearchPoint};
use super::optimise::Optimise;
use super::refined::{Refinement, curves};
use super::scene::ReadScene;
use super::starts_reader::ReadStarts;
use super::sweep::ReadSweep;
use crate::text::name;
use crate::yaml::word::word_of;

/// Most runs of a whole experiment, ensembles not counted.
const MOST_RUNS: usize = 1_000_000;
/// Most fitness evaluations of an optimisation.
const MOST_EVALUATIONS: u64 = 10_000_000;

/// Looks at parts that were read without a mistake of their own.
pub(super) struct Checks<'t> {
    pub findings: &'t Findings,
    pub assumptions: &'t Assumptions,
}

impl Checks<'_> {
    /// Measures that need a time history, or the maximisation, have it.
    pub fn measures(
        &self,
        measures: &[(Measure, Span)],
        maximise: Option<&Maximise>,
        trace: Option<&TraceSpec>,
        shape: Option<&ShapeSpec>,
    ) {
        for (measure, span) in measures {
            if shape.is_none() && measure.needs_shape() {
                self.findings.report::<()>(
                    *span,
                    format!("`{}` is read off a shape, and this experiment keeps none", word_of(*measure)),
                    Some("add `shape: {of: mode, points: …}`".into()),
                );
            }
            if trace.is_none() && measure.needs_trace() {
                self.findings.report::<()>(
                    *span,
                    format!("`{}` is read off a time history, and this experiment keeps none", word_of(*measure)),
                    Some("add `trace: {from: … cycles, to: … cycles, samples_per_cycle: …}`".into()),
                );
            }
        }
        if let Some(maximise) = maximise
            && !measures.iter().any(|(measure, _)| *measure == maximise.measure)
            && let Some((_, span)) = measures.first()
        {
            let name = word_of(maximise.measure);
            let help = format!("add `{name}` to `measure`");
            let role = match maximise.wanted {
                SearchPoint::Maximum => "is maximised",
                SearchPoint::Onset => "has its onset looked for",
            };
            self.findings.report::<()>(*span, format!("`{name}` {role}, but is not measured"), Some(help));
        }
    }

    /// `motion` and what comes with it need a single event-driven run: a mean over several runs has no name, and neither has a maximum.
    pub fn motion(
        &self,
        measures: &[(Measure, Span)],
        maximise: Option<&Maximise>,
        averages: bool,
        solvers: &[SolverChoice],
    ) {
        let exact = |solver: &SolverChoice| *solver == SolverChoice::EventDriven;
        // Beside exact rows those of a fixed step have an empty name.
        let is_named = measures.iter().any(|(measure, _)| measure.is_name());
        let unproved = |measure: Measure| match is_named && measure.needs_motion() {
            true => !solvers.iter().any(exact),
            false => !solvers.iter().all(exact),
        };
        let of_motions = || measures.iter().filter(|(measure, _)| measure.needs_multipliers());
        let (at, reason) = if let Some(at) = of_motions().find(|(measure, _)| unproved(*measure)) {
            (Some(at), "the event-driven solver alone")
        } else if averages {
            (of_motions().next(), "a single run, not of the mean over several")
        } else if maximise.is_some_and(|maximise| maximise.measure.is_name()) {
            (of_motions().next(), "a run as it is: a name has no maximum")
        } else {
            return;
        };
        if let Some((measure, span)) = at {
            self.findings.wrong::<()>(*span, format!("`{}` is measured of {reason}", word_of(*measure)));
        }
    }

    /// Runs that are to settle: what proves it, and what is read off one period.
    pub fn settled(&self, measures: &[(Measure, Span)], energies: bool, solvers: &[SolverChoice], at: Span) {
        if solvers.iter().any(|solver| matches!(solver, SolverChoice::FixedStep { .. })) {
            self.findings.report::<()>(
                at,
                "a fixed step has no multipliers that could prove that a run has settled",
                Some("`until: settled` goes with `solver: event_driven`".into()),
            );
        }
        if let Some((measure, span)) = measures.iter().find(|(measure, _)| measure.compares_cycles()) {
            let message =
                format!("`{}` compares cycles, and a settled run is averaged over one period", word_of(*measure));
            self.findings.report::<()>(*span, message, Some("leave it or `until: settled` out".into()));
        } else if energies {
            let message = "kinetic energies are kept of cycles given, and a run until settled ends by itself";
            self.findings.report::<()>(at, message, Some("leave `energies` or `until: settled` out".into()));
        }
    }

    /// Orbits are found and measured over one period of the exact motion.
    pub fn orbit(&self, measures: &[(Measure, Span)], solvers: &[SolverChoice], settings: &Settings, at: Span) {
        if solvers.iter().any(|solver| *solver != SolverChoice::EventDriven) {
            let help = Some("leave `solver` out, or write `solver: event_driven`".to_owned());
            self.findings.report::<()>(at, "a fixed step finds no orbits", help);
        }
        if settings.until == Until::Settled {
            let help = Some("leave `until: settled` out: Newton's method goes on from the end of the run".to_owned());
            self.findings.report::<()>(at, "an orbit is taken from the last period of a run of the cycles given", help);
        }
        for (measure, span) in measures.iter().filter(|(measure, _)| !measure.is_of_one_period()) {
            let help = if measure.needs_multipliers() {
                "leave it out: every orbit has its `motion`, `stability` and `largest_multiplier` anyway"
            } else {
                "leave it out"
            };
            let message = format!("`{}` is not read off one period of an orbit", word_of(*measure));
            self.findings.report::<()>(*span, message, Some(help.into()));
        }
    }

    /// Random starts run until they settle, each by itself.
    pub fn starts(&self, read: &ReadStarts, settles: bool, sweep: &ReadSweep) {
        if !settles {
            let help = Some("add `run: {until: settled}`".to_owned());
            self.findings.report::<()>(read.span, "what a start ends in is known once its run has settled", help);
        }
        if let Some((_, at)) = sweep.continued.first() {
            let help = Some("leave `from: last` or `starts` out".to_owned());
            self.findings.report::<()>(*at, "rows start at random here, not where the row before ended", help);
        }
        if let Some((_, at)) = sweep.refined.first() {
            let message = "the motions of random starts are no curve that could be refined";
            self.findings.report::<()>(*at, message, Some("write `linear`, `log` or `step`".into()));
        }
        let runs = sweep.cases.len().saturating_mul(read.starts.count as usize);
        if runs > MOST_RUNS {
            self.findings.wrong::<()>(read.span, format!("{runs} runs are too many: {MOST_RUNS} at most"));
        }
    }

    /// What settles is driven again and again.
    pub fn repeats(&self, excitation: &ExcitationKind, at: Span) {
        if matches!(excitation, ExcitationKind::None | ExcitationKind::SingleImpulse) {
            self.findings.wrong::<()>(at, "no period comes again without an excitation that repeats");
        }
    }

    /// Amplitudes are compared with what drives the scene.
    pub fn excitation(&self, measures: &[(Measure, Span)], excitation: &ExcitationKind) {
        for (measure, span) in measures {
            let under = measure.facts().under;
            let admitted = match under {
                Under::Any => true,
                Under::Harmonic => *excitation == ExcitationKind::Harmonic,
                Under::Impulses => !matches!(excitation, ExcitationKind::Harmonic | ExcitationKind::None),
            };
            if !admitted {
                let message =
                    format!("`{}` is measured under {}, not under this excitation", word_of(*measure), under.words());
                self.findings.wrong::<()>(*span, message);
            }
        }
    }

    /// Energies are kept of cycles that are run.
    pub fn energies(&self, energies: Option<&EnergySpec>, settings: &Settings, at: Span) {
        let cycles = settings.averaged().end();
        if energies.is_some_and(|energies| u64::from(energies.to_cycle) > cycles) {
            self.findings.wrong::<()>(at, format!("energies are kept of the {cycles} cycles that are run"));
        }
    }

    /// `swept` in the scene needs a value from every case; a maximised parameter cannot be swept as well.
    pub fn coverage(
        &self,
        scene: &ReadScene,
        ReadSweep { cases, places, .. }: &ReadSweep,
        mean_over: &ReadSweep,
        maximise: Option<&Maximise>,
    ) {
        for (parameter, span) in &scene.swept {
            let averaged = mean_over.places.contains_key(parameter)
                && mean_over.cases.iter().all(|case| case.get(*parameter).is_some());
            if averaged || maximise.is_some_and(|maximise| maximise.over == *parameter) {
                continue;
            }
            let name = word_of(*parameter);
            if !places.contains_key(parameter) {
                let help = format!("add `{name}` to `sweep`, or give it a value here");
                self.findings.report::<()>(*span, format!("nothing sweeps `{name}`"), Some(help));
            } else if let Some(case) = cases.iter().find(|case| !sets_or_leaves_out(case, *parameter)) {
                let help = "give the value here that those cases shall have".to_owned();
                let message = format!("the sweep `{}` leaves `{name}` out", case.sweep);
                self.findings.report::<()>(*span, message, Some(help));
            }
        }
        if let Some(over) = maximise.map(|maximise| maximise.over)
            && let Some(place) = places.get(&over)
        {
            let looked = maximise.map_or("", |maximise| match maximise.wanted {
                SearchPoint::Maximum => "maximised over",
                SearchPoint::Onset => "searched for an onset",
            });
            let message = format!("`{}` is swept and {looked} at once", word_of(over));
            self.findings.report::<()>(*place, message, Some("take it out of `sweep`".into()));
        }
    }

    /// What a sweep sets is left to it in the scene: a value that the scene states is not replaced without a word.
    pub fn marked(
        &self,
        scene: &ReadScene,
        sweep: &ReadSweep,
        mean_over: &ReadSweep,
        looked_for: Option<(&Maximise, Span)>,
    ) {
        let swept =
            [sweep, mean_over].into_iter().flat_map(|sweep| sweep.places.iter().map(move |place| (sweep, place)));
        for (ReadSweep { cases, .. }, (&parameter, &at)) in swept {
            // A case that leaves it out has the value that the scene states; of several dampers it is not known which the others mean.
            let several = parameter.is_of_dampers() && scene.recipe.dampers.len() > 1;
            if several || cases.iter().all(|case| sets_or_leaves_out(case, parameter)) {
                let first = cases.iter().find_map(|case| case.get(parameter));
                self.marked_for(scene, parameter, first, "swept", at);
            }
        }
        if let Some((maximise, at)) = looked_for {
            let first = maximise.grid.first().copied().map(ParameterValue::Number);
            self.marked_for(scene, maximise.over, first, "varied", at);
        }
    }

    fn marked_for(
        &self,
        scene: &ReadScene,
        parameter: Parameter,
        first: Option<ParameterValue>,
        varied: &str,
        at: Span,
    ) {
        let places = scene.recipe.dampers.iter().map(|damper| &damper.at).chain([&scene.recipe.excitation.at]);
        let is_plate = places.map(|place| place.0.len()).max() == Some(2);
        let mark = match parameter {
            Parameter::DamperX | Parameter::ForceX if is_plate => "at: [swept, 0.5]",
            _ => parameter.mark(),
        };
        let is_marked = || scene.swept.iter().any(|(marked, _)| *marked == parameter);
        // A scene without such a place is refused where its cases are tried.
        let has_place = || first.is_some_and(|first| scene.recipe.clone().set(parameter, first).is_ok());
        if mark.is_empty() || is_marked() || !has_place() {
            return;
        }
        let part = match parameter.part() {
            Some(Part::Structure) => "the structure",
            Some(Part::Excitation) => "the excitation",
            _ => "every damper that shall have it",
        };
        let message = format!("`{}` is {varied}, but nothing in the scene is left to it", word_of(parameter));
        let help = format!("write `{mark}` in {part}; what a scene states beside is kept");
        self.findings.report::<()>(at, message, Some(help));
    }

    /// To move what no number depends on would look like a result.
    pub fn sensitivity(
        &self,
        moved: Option<&BTreeMap<AssumptionName, Span>>,
        experiment: &Experiment,
        sheet: &AssumptionSheet,
    ) {
        let Some(moved) = moved.filter(|moved| !moved.is_empty() && !self.findings.any()) else { return };
        let used = experiment.assumptions_used(sheet);
        for (name, at) in moved.iter().filter(|(name, _)| !used.contains(*name)) {
            let used: Vec<String> = used.iter().map(|name| format!("`{name}`")).collect();
            let help = match used.as_slice() {
                [] => "write `sensitivity: none`: it depends on no assumption".into(),
                used => format!("take it out; it depends on {}", used.join(", ")),
            };
            self.findings.report::<()>(*at, format!("this experiment does not depend on `{name}`"), Some(help));
        }
    }

    /// What is averaged over is not swept or maximised over as well.
    pub fn mean_over(&self, mean_over: &ReadSweep, places: &BTreeMap<Parameter, Span>, maximise: Option<&Maximise>) {
        for (parameter, span) in &mean_over.places {
            if places.contains_key(parameter) || maximise.is_some_and(|maximise| maximise.over == *parameter) {
                let message = format!("`{}` is averaged over and varied at once", word_of(*parameter));
                self.findings.wrong::<()>(*span, message);
            }
        }
    }

    /// A line runs through points of one solver.
    pub fn lines(&self, figures: &[FigureSpec], cases: &[Case], at: Span) {
        let joined = |panel: &Panel| !panel.by.iter().any(|column| column == name::SOLVER);
        let drawn =
            |figure: &FigureSpec| matches!(&figure.drawing, Drawing::Lines(panels) if panels.iter().any(joined));
        if cases.iter().any(|case| case.solvers.len() > 1) && figures.iter().any(drawn) {
            let message = "a line would run through the points of several solvers";
            self.findings.report::<()>(at, String::from(message), Some("add `solver` to `by`".into()));
        }
    }

    /// The fitness is measured by a run, and the number of runs is bounded.
    pub fn optimise(&self, optimise: &Optimise, measures: &[(Measure, Span)], solvers: &[SolverChoice], at: Span) {
        if solvers.len() > 1 {
            self.findings.wrong::<()>(at, "an optimisation runs under one solver");
        }
        let name = word_of(optimise.measure);
        if !measures.iter().any(|(measure, _)| *measure == optimise.measure)
            && let Some((_, span)) = measures.first()
        {
            let help = format!("add `{name}` to `measure`");
            self.findings.report::<()>(*span, format!("`{name}` is optimised, but not measured"), Some(help));
        }
        let mut refused: Option<Span> = None;
        for (measure, span) in measures {
            let needs_more = measure.needs_trace()
                || measure.needs_shape()
                || measure.needs_energies()
                || measure.needs_multipliers();
            // One word may stand for several measures.
            let is_first = refused != Some(*span);
            if needs_more && is_first {
                let message = format!("`{}` is not measured in an optimisation", word_of(*measure));
                let help = "leave it out here; an experiment with the best gaps can measure it".to_owned();
                self.findings.report::<()>(*span, message, Some(help));
                refused = Some(*span);
            }
        }
        let evaluations = optimise.most_evaluations();
        if evaluations > MOST_EVALUATIONS {
            let message = format!("{evaluations} evaluations are too many: {MOST_EVALUATIONS} at most");
            self.findings.wrong::<()>(at, message);
        }
    }

    /// The measures that a refined range follows are measured, and have curves to be followed.
    pub fn refined(&self, refined: &[(Refinement, Span)], measures: &[(Measure, Span)]) {
        for (refinement, span) in refined {
            for wanted in &refinement.measures {
                if !measures.iter().any(|(measure, _)| measure == wanted) {
                    let name = word_of(*wanted);
                    let help = format!("add `{name}` to `measure`");
                    self.findings.report::<()>(*span, format!("`{name}` is refined, but not measured"), Some(help));
                }
            }
            if refinement.measures.iter().any(|measure| measure.is_name()) {
                self.findings.wrong::<()>(*span, "a name has no curve to be followed");
            }
            if refinement.over == Parameter::Stop {
                self.findings.wrong::<()>(*span, "only numbers can be refined");
            }
        }
    }

    /// Rows that start where others ended: single event-driven runs, one after the other.
    pub fn continued(&self, continued: &[(ContinuedSweep, Span)], cases: &[Case], unordered: Option<(&str, Span)>) {
        let Some((_, at)) = continued.first() else { return };
        if let Some((what, at)) = unordered {
            let message = format!("{what} has no state that the next row could start from");
            self.findings.report::<()>(at, message, Some("leave it or `from: last` out".into()));
        }
        let ordered = |case: &Case| case.direction.is_some();
        let stepped = |solver: &SolverChoice| matches!(solver, SolverChoice::FixedStep { .. });
        if cases.iter().any(|case| ordered(case) && case.solvers.iter().any(stepped)) {
            self.findings.report::<()>(
                *at,
                "under a fixed step a cycle ends up to a step late, and its state is not that of the next cycle's start",
                Some("`from: last` goes with `solver: event_driven`".into()),
            );
        }
    }

    /// An uncertainty is that of something.
    pub fn tolerances(&self, measures: &[(Measure, Span)], tolerances: &[Tolerance]) {
        if let (Some((measure, span)), true) =
            (measures.iter().find(|(measure, _)| *measure == Measure::VelocityRatioInput), tolerances.is_empty())
        {
            let message = format!("`{}` is what tolerances leave, and there are none", word_of(*measure));
            self.findings.report::<()>(*span, message, Some("add `tolerances: {gap: 1 %}`".into()));
        }
    }

    /// Values are kept of cycles that are averaged.
    pub fn each_cycle(&self, each_cycle: Option<&CycleSpec>, settings: &Settings, at: Span) {
        let averaged = settings.average;
        if each_cycle.is_some_and(|each| each.last.is_some_and(|last| last > averaged)) {
            self.findings.wrong::<()>(at, format!("values are kept of the {averaged} cycles that are averaged"));
        }
    }

    /// The number of runs is bounded.
    pub fn amount(
        &self,
        ReadSweep { cases, refined, .. }: &ReadSweep,
        maximise: Option<&Maximise>,
        averaged: usize,
        at: Span,
    ) {
        let of = |case: &Case| case.solvers.len();
        let plain: usize = cases.iter().map(of).sum();
        let added = curves(cases, refined.iter().map(|(rule, _)| rule)).into_iter().map(|curve| {
            let solvers = curve.cases.first().map_or(0, |first| of(&cases[*first]));
            (curve.rule.most as usize).saturating_sub(curve.cases.len()) * solvers
        });
        let runs = plain + added.sum::<usize>();
        let each = maximise.map_or(1, |maximise| maximise.grid.len()) * averaged.max(1);
        if runs.saturating_mul(each) > MOST_RUNS {
            self.findings.wrong::<()>(at, format!("{runs} runs of {each} points are too many: {MOST_RUNS} at most"));
        }
    }
}

/// The case gives the parameter a value, or has no damper that could use one.
fn sets_or_leaves_out(case: &Case, parameter: Parameter) -> bool {
    let clean = case.get(Parameter::Dampers) == Some(ParameterValue::Without);
    case.get(parameter).is_some() || (clean && parameter.is_of_dampers())
}
