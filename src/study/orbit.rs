//! Branches of periodic motions: from the end of each first run to both ends of the range, and from each of their period doublings the
//! next, as many times over as asked for; likewise from where they lose their symmetry.
//!
//! A branch ends where it ends, and says why in its last row: that is a result. Without a first motion there is one row, which says
//! why it has no numbers. Every branch is followed by one thread; its points are measured side by side.

use std::collections::VecDeque;

use rayon::prelude::*;

use super::evaluate::guarded;
use super::event::{Event, EventHandler};
use super::finished::Finished;
use super::row_failure::RowFailure;
use super::spent::Meter;
use super::tabulate_branches::{BranchRow, failures, table};
use super::task::Task;
use super::variant::Variant;
use crate::dynamics::{
    Allowance, Along, Branch, BranchEnd, BranchError, BranchPoint, EngineError, HybridSystem, Options, Orbit,
    OrbitError, Special, is_interrupted,
};
use crate::experiment::{Continuation, Experiment, ParameterValue, Recipe, RowSource};
use crate::measure::{EvaluateError, Evaluated, Needs, Rigour, SolverChoice, measured_orbit, rounded};
use crate::scene::{Scene, compile};
use crate::text::number::quantity;
use crate::text::words;

/// The longest step, as a share of the range and of the motion.
const STEP: f64 = 0.01;
/// A branch that ends next to a special point, by this share of the range, joins the one that has it.
const JOINS: f64 = 1e-3;

/// Points of all branches at most, as far as that is known before: of the first ones.
pub(super) fn points(continuation: &Continuation, variants: &[Variant]) -> usize {
    2 * continuation.points as usize * continuation.starts.len() * variants.len()
}

/// Runs it.
pub(super) fn run_branches(task: Task<'_>, meter: &Meter, handler: &dyn EventHandler) -> Finished {
    let Task { experiment, variants, metadata, .. } = task;
    let RowSource::Branches(continuation) = experiment.row_source() else { return Finished::default() };
    let all = points(continuation, variants) as u64;
    if let Some(finished) = task.known_whole() {
        handler.on_event(&Event::Simulated { experiment: &experiment.id, count: all });
        return finished;
    }
    let within = |it: &(dyn Fn() -> Vec<BranchRow> + Sync)| {
        let simulate = || Allowance::new(task.limit).simulate(it);
        meter.time(SolverChoice::EventDriven, Rigour::Result, simulate)
    };
    let rows = variants.par_iter().enumerate().flat_map_iter(|(variant, assumed)| {
        let following = Following { experiment, continuation, variant: assumed, number: variant };
        within(&|| following.branches())
    });
    let mut rows: Vec<BranchRow> = rows.collect();
    rows.par_iter_mut().for_each(|row| {
        let following = Following { experiment, continuation, variant: &variants[row.variant], number: row.variant };
        let measured = || Allowance::new(task.limit).simulate(|| guarded(|| following.measured(row)));
        row.measured = meter.time(SolverChoice::EventDriven, Rigour::Result, measured);
        handler.on_event(&Event::Simulated { experiment: &experiment.id, count: 1 });
    });
    let left = all.saturating_sub(rows.len() as u64);
    handler.on_event(&Event::Simulated { experiment: &experiment.id, count: left });
    let table = table(experiment, continuation, variants, &rows, metadata.clone());
    Finished { table, failures: failures(&rows), interrupted: is_interrupted(), ..Finished::default() }
}

/// Branches under one set of assumptions.
struct Following<'a> {
    experiment: &'a Experiment,
    continuation: &'a Continuation,
    variant: &'a Variant,
    number: usize,
}

/// What a branch begins with.
enum Begin {
    /// A run, at this share of the range.
    Run(f64),
    /// A special point of another branch.
    Switch(Box<Switch>),
}

/// A special point at which other motions begin.
struct Switch {
    special: Special,
    point: BranchPoint,
    /// Doublings of the period on the way, with this one.
    doublings: u32,
}

impl Switch {
    /// Forcing periods of the motions that begin.
    fn periods(&self) -> u32 {
        let cycles = self.point.orbit.cycles;
        if self.special == Special::PeriodDoubling { 2 * cycles } else { cycles }
    }
}

/// What is still to be done.
enum Open {
    Follow(Begin),
    /// A special point from which no other motion was found: unless a branch joins it, that is the result.
    Lone(Special, Traced),
}

/// Points of a branch in their order, and why it goes no further at either end; no reason at an end that another branch begins at, nor at
/// the first point of a closed branch.
struct Traced {
    points: Vec<BranchPoint>,
    ends: [Option<BranchEnd<RowFailure>>; 2],
}

impl Traced {
    /// The special point of another branch that this one ends at.
    fn joins(&self) -> Option<Special> {
        match self.ends[1] {
            Some(BranchEnd::HalfPeriod) => Some(Special::PeriodDoubling),
            Some(BranchEnd::Symmetry) => Some(Special::SymmetryBreaking),
            _ => None,
        }
    }
}

impl Following<'_> {
    fn recipe(&self, parameter: f64) -> Result<Recipe, RowFailure> {
        let mut recipe = self.experiment.recipe.clone();
        recipe.set(self.continuation.along, ParameterValue::Number(parameter))?;
        Ok(recipe)
    }

    fn scene(&self, share: f64) -> Result<Scene, RowFailure> {
        let recipe = self.recipe(self.continuation.at(share))?;
        Ok(rounded(recipe.resolve(&self.variant.assumptions)?, &self.experiment.settings))
    }

    fn system(&self, share: f64) -> Result<HybridSystem, RowFailure> {
        Ok(compile(&self.scene(share)?).map_err(EvaluateError::from)?)
    }

    /// All branches, a row for each of their points.
    fn branches(&self) -> Vec<BranchRow> {
        let mut rows = Vec::new();
        // Special points at which branches have joined others, and forcing periods of the joined motion.
        let mut joined: Vec<(Special, f64, u32)> = Vec::new();
        let starts = self.continuation.starts.iter();
        let run = |start: &f64| Open::Follow(Begin::Run(self.continuation.share(*start)));
        let mut open: VecDeque<Open> = starts.map(run).collect();
        let mut number = 0;
        while let Some(next) = open.pop_front() {
            // The branch of another special point has ended here.
            let is_joined = |special: Special, parameter: f64, periods: u32| {
                let is_here = |other: f64| (other - parameter).abs() <= JOINS;
                joined.iter().any(|(kind, other, cycles)| *kind == special && *cycles == periods && is_here(*other))
            };
            let begin = match next {
                Open::Follow(begin) => begin,
                Open::Lone(special, traced) => {
                    if traced.points.iter().any(|it| !is_joined(special, it.parameter, it.orbit.cycles)) {
                        number += 1;
                        self.enter(number, traced, &mut rows);
                    }
                    continue;
                }
            };
            let (parameter, switch) = match &begin {
                Begin::Run(share) => (*share, None),
                Begin::Switch(switch) => (switch.point.parameter, Some(switch)),
            };
            if switch.is_some_and(|it| is_joined(it.special, parameter, it.periods())) {
                continue;
            }
            let doublings = switch.map_or(0, |it| it.doublings);
            match guarded(|| self.traced(&begin)) {
                Ok(branches) => {
                    for traced in branches {
                        if let (Some(switch), [_]) = (switch, &traced.points[..]) {
                            open.push_back(Open::Lone(switch.special, traced));
                            continue;
                        }
                        number += 1;
                        if let (Some(special), Some(last)) = (traced.joins(), traced.points.last()) {
                            joined.push((special, last.parameter, last.orbit.cycles));
                        }
                        let next = traced.points.iter().filter_map(|point| self.switch(point, doublings));
                        open.extend(next.map(Open::Follow));
                        self.enter(number, traced, &mut rows);
                    }
                }
                Err(reason) => {
                    number += 1;
                    rows.push(self.failed(number, parameter, reason));
                }
            }
        }
        rows
    }

    /// What is followed from a point of a branch with so many doublings on the way to it.
    fn switch(&self, point: &BranchPoint, doublings: u32) -> Option<Begin> {
        let special = point.special?;
        let doublings = match special {
            Special::PeriodDoubling if doublings < self.continuation.doublings => doublings + 1,
            Special::SymmetryBreaking if self.continuation.asymmetric => doublings,
            _ => return None,
        };
        Some(Begin::Switch(Box::new(Switch { special, point: point.clone(), doublings })))
    }

    /// The branch that begins so, or both.
    fn traced(&self, begin: &Begin) -> Result<Vec<Traced>, RowFailure> {
        let system = |share| self.system(share);
        let points = self.continuation.points as usize;
        let up = Along { from: 0.0, to: 1.0, step: STEP, points };
        let down = Along { from: 1.0, to: 0.0, ..up };
        let unfollowed = |error| match error {
            BranchError::Orbit(error) => error.into(),
            BranchError::System(error) => error,
        };
        let (orbit, start) = match begin {
            Begin::Run(share) => (self.first(*share)?, *share),
            Begin::Switch(switch) => {
                let Switch { special, point, .. } = &**switch;
                let begun = |Branch { points, end }| Traced { points, ends: [None, Some(end)] };
                return Ok(if *special == Special::PeriodDoubling {
                    vec![begun(Branch::doubled(system, point, up).map_err(unfollowed)?)]
                } else {
                    Branch::asymmetric(system, point, up).map_err(unfollowed)?.map(begun).into()
                });
            }
        };
        let follow = |along: Along| Branch::follow(system, &orbit, start, along).map_err(unfollowed);
        Ok(vec![match start {
            0.0 => {
                let Branch { points, end } = follow(up)?;
                Traced { points, ends: [Some(BranchEnd::Range), Some(end)] }
            }
            1.0 => {
                let Branch { mut points, end } = follow(down)?;
                points.reverse();
                Traced { points, ends: [Some(end), Some(BranchEnd::Range)] }
            }
            _ => {
                let upwards = follow(up)?;
                if let BranchEnd::Closed = upwards.end {
                    return Ok(vec![Traced { points: upwards.points, ends: [None, Some(upwards.end)] }]);
                }
                let downwards = follow(down)?;
                // Both have the first point.
                let back = downwards.points.into_iter().skip(1).rev();
                let points = back.chain(upwards.points).collect();
                Traced { points, ends: [Some(downwards.end), Some(upwards.end)] }
            }
        }])
    }

    /// The orbit that a run ends next to.
    fn first(&self, share: f64) -> Result<Orbit, RowFailure> {
        let scene = self.scene(share)?;
        let system = compile(&scene).map_err(EvaluateError::from)?;
        let settings = &self.experiment.settings;
        let options = Options {
            start: scene.start_state(),
            skip: settings.skip,
            average: settings.average,
            ..Options::default()
        };
        Ok(match self.continuation.periods {
            Some(periods) => Orbit::beside(&system, &options, periods)?,
            None => Orbit::after(&system, &options)?,
        })
    }

    /// A row for each point; the reasons of its ends in the first and the last.
    fn enter(&self, branch: usize, traced: Traced, rows: &mut Vec<BranchRow>) {
        let Traced { points, ends } = traced;
        let first = rows.len();
        rows.extend(points.into_iter().map(|point| BranchRow {
            variant: self.number,
            branch,
            parameter: self.continuation.at(point.parameter),
            special: point.special,
            ends: Vec::new(),
            orbit: Ok(point.orbit),
            measured: Err(RowFailure::NotComputed),
        }));
        let last = rows.len().saturating_sub(1);
        for (row, end) in [first, last].into_iter().zip(ends) {
            match end {
                // To be tried again with more time.
                Some(BranchEnd::Orbit(OrbitError::Engine(EngineError::Overrun(overrun)))) => {
                    let share = self.continuation.share(rows[row].parameter);
                    let reason = OrbitError::Engine(EngineError::Overrun(overrun)).into();
                    rows.push(self.failed(branch, share, reason));
                }
                Some(end) => {
                    let reason = self.describe(end);
                    rows[row].ends.push(reason);
                }
                None => {}
            }
        }
    }

    fn describe(&self, end: BranchEnd<RowFailure>) -> String {
        let name = words::of_key(&self.continuation.along);
        match end {
            BranchEnd::Range => "end of the range".into(),
            BranchEnd::Closed => "closed: it comes back to its first motion".into(),
            BranchEnd::HalfPeriod => {
                "next to it the motion has half the period: it joins the branch that doubles there".into()
            }
            BranchEnd::Symmetry => {
                "next to it the motion comes again upside down after half a period: it joins the branch that loses its symmetry there".into()
            }
            BranchEnd::Graze { parameter } => {
                let at = quantity(self.continuation.at(parameter), self.continuation.along.unit(), 12);
                format!("next to it, at {name} = {at}, a contact begins or ends without speed")
            }
            BranchEnd::CycleStart => "a contact comes to the instant at which the forcing cycle begins".into(),
            BranchEnd::Points => format!("{} points, as many as were asked for", self.continuation.points),
            BranchEnd::Sensitive => "the motion is too sensitive to be followed: steps along the branch get nowhere".into(),
            BranchEnd::Orbit(error) => error.to_string(),
            BranchEnd::System(error) => error.to_string(),
        }
    }

    fn failed(&self, branch: usize, share: f64, reason: RowFailure) -> BranchRow {
        let parameter = self.continuation.at(share);
        let reason = if is_interrupted() {
            RowFailure::Interrupted
        } else {
            let name = words::of_key(&self.continuation.along);
            RowFailure::At { parameter: name, at: parameter, reason: Box::new(reason) }
        };
        BranchRow {
            variant: self.number,
            branch,
            parameter,
            special: None,
            ends: Vec::new(),
            orbit: Err(reason),
            measured: Err(RowFailure::NotComputed),
        }
    }

    /// What the experiment measures, of one period.
    fn measured(&self, row: &BranchRow) -> Result<Evaluated, RowFailure> {
        let Ok(orbit) = &row.orbit else { return Err(RowFailure::NotComputed) };
        let measures = &self.experiment.measures;
        let subject = self.recipe(row.parameter)?.subject(&self.variant.assumptions, Needs::of(measures, false))?;
        let measured = measured_orbit(orbit, subject, &self.experiment.settings, measures);
        if measured.is_err() && is_interrupted() { Err(RowFailure::Interrupted) } else { Ok(measured?) }
    }
}
