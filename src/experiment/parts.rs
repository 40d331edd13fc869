//! The parts of an experiment: each read by its own file, then all of them where none has a mistake.

use std::iter;

use super::about_study::MOST_CHAPTERS;
use super::case::Case;
use super::columns::{Columns, Lists, TableParts};
use super::continuation_reader::{ReadContinuation, read_continuation};
use super::definition::Source;
use super::exclusions::{check_lists, check_mean, check_rows};
use super::lists::{read_each_cycle, read_energies, read_shape, read_tolerances, read_trace};
use super::looked_for::{read_maximise, read_onset};
use super::maximise::Maximise;
use super::measures::{bring, read_measures};
use super::optimise::Optimise;
use super::optimise_reader::{ReadOptimise, read_optimise};
use super::recipe::Assumptions;
use super::run::{Run, read_run};
use super::scene::{ReadScene, read_scene};
use super::starts_reader::{ReadStarts, read_starts};
use super::stated::{STATED, Statement, read_statements};
use super::sweep::{ReadSweep, read_sweep};
use crate::measure::{CycleSpec, EnergySpec, Measure, ShapeOf, ShapeSpec, SolverChoice, Tolerance, TraceSpec};
use crate::yaml::{At, Findings, Keys, Span};

/// What an experiment is about; `None` is a part with a mistake.
pub(super) struct Head {
    pub title: Option<String>,
    pub source: Option<Source>,
    pub about: Option<String>,
    pub stated: Option<Vec<Statement>>,
}

impl Head {
    pub fn read(keys: &Keys<'_>) -> Self {
        let title = keys.required("title", "A few words", |at| at.text());
        let source = keys.optional("source", "Where a publication shows it", read_source);
        let about = keys.required("about", "One or two sentences", |at| at.text());
        let stated = keys.optional(STATED, "Inputs that the text states, by table, figure or section", read_statements);
        Self {
            title,
            source: source.map(Option::unwrap_or_default),
            about,
            stated: stated.map(Option::unwrap_or_default),
        }
    }
}

/// What is simulated and measured, as far as it is sound: `None` is one with a mistake, which is reported; `Some(None)` one that is not there.
#[expect(clippy::option_option, reason = "absent and wrong are two things")]
pub(super) struct Parts {
    pub scene: Option<ReadScene>,
    pub orbit: Option<Option<ReadContinuation>>,
    pub starts: Option<Option<ReadStarts>>,
    pub sweep: Option<Option<ReadSweep>>,
    pub mean_over: Option<Option<ReadSweep>>,
    pub maximise: Option<Option<Maximise>>,
    pub optimise: Option<Option<Optimise>>,
    pub measures: Option<Vec<(Measure, Span)>>,
    pub trace: Option<Option<TraceSpec>>,
    pub energies: Option<Option<EnergySpec>>,
    pub shape: Option<Option<ShapeSpec>>,
    pub each_cycle: Option<Option<CycleSpec>>,
    pub tolerances: Option<Option<(Vec<Tolerance>, Span)>>,
    pub run: Option<Run>,
    /// What is measured is read off the model: there is no run.
    pub is_of_model: bool,
    /// Nothing stands beside what makes the rows that does not go with it.
    pub rows_fit: Option<()>,
    /// Nothing beside the lists that rows keep, either.
    pub lists_fit: Option<()>,
}

impl Parts {
    pub fn read(keys: &Keys<'_>, assumptions: &Assumptions, findings: &Findings) -> Self {
        let scene = keys.required("scene", "What is simulated", |at| read_scene(at, assumptions));
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
        let each_cycle = keys.optional("each_cycle", "A value of each averaged cycle that is kept", read_each_cycle);
        let uncertain = "Relative standard uncertainties of design parameters";
        let tolerances = keys.optional("tolerances", uncertain, |at| Some((read_tolerances(at)?, at.span())));
        let lists =
            matches!(trace, Some(Some(_))) || matches!(energies, Some(Some(_))) || matches!(each_cycle, Some(Some(_)));
        let deflection = matches!(&shape, Some(Some(shape)) if shape.of == ShapeOf::Deflection);
        let of_model = measures.as_ref().is_some_and(|measures| measures.iter().all(|(measure, _)| measure.is_modal()));
        let is_of_model = of_model && !lists && !deflection;
        let run = read_run(keys, &assumptions.sheet, is_of_model, findings);
        let measures = measures.map(|mut measures| {
            let settled_at = run.as_ref().and_then(|run| run.settled_at);
            bring(&mut measures, settled_at, Measure::of_settled_runs());
            let starts_at = starts.iter().flatten().next().map(|starts| starts.span);
            bring(&mut measures, starts_at, iter::once(Measure::Motion).chain(Measure::Motion.companions()));
            let tolerances_at = tolerances.iter().flatten().next().map(|(_, at)| *at);
            bring(&mut measures, tolerances_at, iter::once(Measure::VelocityRatioInput));
            measures
        });
        let optimise = match (optimise, &scene, &mean_over) {
            (Some(optimise), Some(scene), Some(inner)) => {
                optimised(optimise, scene, inner.as_ref(), assumptions, findings)
            }
            _ => None,
        };
        let one_list = check_lists(keys, findings);
        let rows_fit = check_rows(keys, findings);
        let lists_fit = check_mean(keys, findings).and(one_list);
        Self {
            scene,
            orbit,
            starts,
            sweep,
            mean_over,
            maximise,
            optimise,
            measures,
            trace,
            energies,
            shape,
            each_cycle,
            tolerances,
            run,
            is_of_model,
            rows_fit,
            lists_fit,
        }
    }

    /// The columns that the table will have; `None` where a part that decides on them has a mistake.
    pub fn columns(&self) -> Option<Columns> {
        self.rows_fit?;
        let (trace, energies) = (self.trace.as_ref()?.as_ref(), self.energies.as_ref()?.as_ref());
        let (shape, each_cycle) = (self.shape.as_ref()?.as_ref(), self.each_cycle.as_ref()?.as_ref());
        let sweep = self.sweep.as_ref()?.as_ref();
        let parts = TableParts {
            orbit: self.orbit.as_ref()?.as_ref().map(|read| &read.continuation),
            optimise: self.optimise.as_ref()?.as_ref(),
            starts: self.starts.as_ref()?.as_ref().map(|read| &read.starts),
            swept: sweep.map_or(&[], |sweep| &sweep.swept),
            cases: sweep.map_or(&[], |sweep| &sweep.cases),
            measures: &words_only(self.measures.as_ref()?),
            maximise: self.maximise.as_ref()?.as_ref(),
            lists: Lists::kept(trace, energies, shape, each_cycle),
        };
        Some(parts.columns())
    }

    /// The cases of a sweep as far as they are known: those of branches are not.
    pub fn swept_cases(&self) -> &[Case] {
        match (&self.orbit, &self.sweep) {
            (Some(None), Some(Some(sweep))) => &sweep.cases,
            _ => &[],
        }
    }
}

/// The optimisation, with as many gaps as there are dampers. `Some(None)`: there is none.
#[expect(clippy::option_option, reason = "absent and wrong are two things")]
fn optimised(
    optimise: Option<ReadOptimise>,
    scene: &ReadScene,
    inner: Option<&ReadSweep>,
    assumptions: &Assumptions,
    findings: &Findings,
) -> Option<Option<Optimise>> {
    let Some(optimise) = optimise else {
        for at in &scene.optimised {
            let help = "add `optimise`, or give the gap a value".to_owned();
            findings.report::<()>(*at, "nothing optimises this gap", Some(help));
        }
        return scene.optimised.is_empty().then_some(None);
    };
    if scene.optimised.len() != scene.recipe.dampers.len() || scene.optimised.is_empty() {
        let help = "write `gap: optimised` in every damper of the scene".to_owned();
        return findings.report(optimise.span, "a gap that is not optimised is not varied", Some(help));
    }
    let none = ReadSweep::none();
    let cases = &inner.unwrap_or(&none).cases;
    let mut counts = Vec::new();
    for case in cases {
        let mut recipe = scene.recipe.clone();
        let set = case.values.iter().try_for_each(|(parameter, value)| recipe.set(*parameter, *value));
        // What physics refuses is told where all scenes are tried.
        counts.extend(set.and_then(|()| recipe.resolve(assumptions)).map(|scene| scene.dampers.len()));
    }
    match counts.as_slice() {
        [] => optimise.spread(scene.recipe.dampers.len(), findings).map(Some),
        [first, rest @ ..] if rest.iter().all(|other| other == first) => optimise.spread(*first, findings).map(Some),
        _ => findings.wrong(optimise.span, "the number of dampers, and with it of gaps, is not always the same"),
    }
}

/// What is simulated and measured, all of it sound.
pub(super) struct Sound {
    pub scene: ReadScene,
    pub orbit: Option<ReadContinuation>,
    pub starts: Option<ReadStarts>,
    /// Each case with the solvers that it runs under.
    pub sweep: ReadSweep,
    pub mean_over: ReadSweep,
    pub maximise: Option<Maximise>,
    pub optimise: Option<Optimise>,
    pub measures: Vec<(Measure, Span)>,
    pub trace: Option<TraceSpec>,
    pub energies: Option<EnergySpec>,
    pub shape: Option<ShapeSpec>,
    pub each_cycle: Option<CycleSpec>,
    pub tolerances: Vec<Tolerance>,
    pub run: Run,
    /// What is measured is read off the model: there is no run.
    pub is_of_model: bool,
}

impl Parts {
    pub fn sound(self) -> Option<Sound> {
        let run = self.run?;
        let mut sweep = self.sweep?.unwrap_or_else(ReadSweep::none);
        // Cases run under the experiment's solvers unless their named sweep has its own.
        for case in sweep.cases.iter_mut().filter(|case| case.solvers.is_empty()) {
            case.solvers.clone_from(&run.solvers);
        }
        Some(Sound {
            scene: self.scene?,
            orbit: self.orbit?,
            starts: self.starts?,
            sweep,
            mean_over: self.mean_over?.unwrap_or_else(ReadSweep::none),
            maximise: self.maximise?,
            optimise: self.optimise?,
            measures: self.measures?,
            trace: self.trace?,
            energies: self.energies?,
            shape: self.shape?,
            each_cycle: self.each_cycle?,
            tolerances: self.tolerances?.map_or_else(Vec::new, |(tolerances, _)| tolerances),
            run,
            is_of_model: self.is_of_model,
        })
    }
}

impl Sound {
    /// What every number is a mean over; empty where it is that of one scene.
    pub fn inner(&self) -> &[Case] {
        match self.mean_over.cases.as_slice() {
            [first, ..] if first.values.is_empty() => &[],
            cases => cases,
        }
    }

    /// All solvers that some case runs under.
    pub fn solvers(&self) -> Vec<SolverChoice> {
        let mut solvers: Vec<SolverChoice> = Vec::new();
        for solver in self.sweep.cases.iter().flat_map(|case| &case.solvers) {
            if !solvers.contains(solver) {
                solvers.push(*solver);
            }
        }
        solvers
    }

    pub fn words_of_measures(&self) -> Vec<Measure> {
        words_only(&self.measures)
    }
}

fn words_only(measures: &[(Measure, Span)]) -> Vec<Measure> {
    measures.iter().map(|(measure, _)| *measure).collect()
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
