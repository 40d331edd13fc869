//! How an experiment was run, and which effects its scene has.

use crate::dynamics::Until;
use crate::experiment::{
    Continuation, Experiment, GapWord, HeightBox, Interval, Optimise, ParticleBox, RowSource, Search, SearchPoint,
    Starts,
};
use crate::measure::{SolverChoice, column_words};
use crate::scene::EffectUse;
use crate::text::number::{compact, quantity};
use crate::text::words::{self, counted};

/// The section on how it was run.
pub(super) fn section(experiment: &Experiment) -> String {
    let settings = &experiment.settings;
    let mut text = String::new();
    text += &match experiment.row_source() {
        RowSource::Search(optimise) => searches(optimise),
        RowSource::Branches(continuation) => return text + &branches(experiment, continuation),
        RowSource::Cases => format!("- {}.\n", cases(experiment)),
        RowSource::Basins(starts) => format!("- {}.\n{}", cases(experiment), of_starts(starts)),
    };
    if !experiment.mean_over.is_empty() {
        text += &format!("- {}\n", averaged(experiment));
    }
    for solver in &experiment.solvers {
        text += &format!("- {}\n", solver_in_words(*solver));
    }
    let cycles = counted(settings.average as usize, "forcing cycle", "forcing cycles");
    text += &match settings.until {
        Until::Cycles => format!("- Averages run over {cycles} after {} left out as transient.\n", settings.skip),
        Until::Settled => format!(
            "- A run ends with the first period that comes again and attracts, and its averages are of that period; where there is \
             none after {} + {} cycles, averages run over {cycles} after {} left out as transient.\n",
            settings.skip, settings.average, settings.skip
        ),
    };
    if let Some(step) = settings.round_period_to {
        text += &format!("- The forcing period is rounded to whole steps of {}.\n", quantity(step, "s", 4));
    }
    if settings.ensemble > 0 {
        text += &format!(
            "- Where neighbouring starts part: the mean of {} from slightly perturbed starts.\n",
            counted(settings.ensemble as usize, "run", "runs")
        );
    }
    if let Some(moved) = &experiment.moved {
        text += &match moved.iter().map(|name| format!("`{}`", words::of_key(name))).collect::<Vec<_>>() {
            names if names.is_empty() => "- No assumption is moved.\n".to_owned(),
            names => {
                let are = if names.len() == 1 { "is moved" } else { "are moved, one at a time" };
                format!("- For the sensitivity only {} {are}.\n", names.join(", "))
            }
        };
    }
    if let Some(trace) = &experiment.trace {
        text += &format!(
            "- The time history is kept from cycle {} to {}, {} samples a cycle.\n",
            trace.from_cycle, trace.to_cycle, trace.samples
        );
    }
    if let Some(energies) = &experiment.energies {
        text += &format!(
            "- Kinetic energies of the structure are kept from cycle {} to {}.\n",
            energies.from_cycle, energies.to_cycle
        );
    }
    if let Some(shape) = &experiment.shape {
        let points: Vec<String> = shape.points.iter().map(u32::to_string).collect();
        text += &format!("- The shape is kept at {} points.\n", points.join(" by "));
    }
    text + "\n"
}

/// The box that starts are drawn from.
fn of_starts(starts: &Starts) -> String {
    let within = |interval: Interval, unit: &str| {
        let value = |x| quantity(x, unit, 4);
        if interval.varies() {
            format!("{} to {}", value(interval.from), value(interval.to))
        } else {
            value(interval.from)
        }
    };
    let mut parts: Vec<String> = Vec::new();
    parts.extend(starts.displacement.map(|it| format!("displacement {}", within(it, "m"))));
    parts.extend(starts.velocity.map(|it| format!("velocity {}", within(it, "m/s"))));
    for particle in &starts.particles {
        parts.push(match *particle {
            ParticleBox::OnFloor => "particle on its floor".into(),
            ParticleBox::InFlight { height, velocity } => {
                let height = match height {
                    HeightBox::Of(interval) => within(interval, "m"),
                    HeightBox::OfGap(interval) => format!("{} of the gap", within(interval, "")),
                };
                format!("particle {height} above its floor with {} relative to it", within(velocity, "m/s"))
            }
        });
    }
    format!(
        "- Each case runs from {}, evenly distributed over {} (seed {}); starts are the same in every case.\n",
        counted(starts.count as usize, "random start", "random starts"),
        parts.join("; "),
        starts.seed,
    )
}

/// Where the first motion comes from, and how it was followed.
fn branches(experiment: &Experiment, continuation: &Continuation) -> String {
    let along = column_words(&words::of_key(&continuation.along));
    let value = |x: f64| quantity(x, continuation.along.unit(), 6);
    let Continuation { from, to, ref starts, doublings, asymmetric, points, .. } = *continuation;
    let starts: Vec<String> = starts.iter().map(|start| value(*start)).collect();
    let settings = &experiment.settings;
    let periods = continuation.periods.map_or_else(String::new, |periods| {
        format!(", with {}", counted(periods as usize, "forcing period", "forcing periods"))
    });
    let mut text = format!(
        "- The first motions are those next to the ends of runs of {} + {} cycles at {}{periods}.\n- They are followed along the {along} \
         from {} to {}, each {points} points to either side at most, by pseudo-arclength on the exact flow.\n",
        settings.skip,
        settings.average,
        joined(&starts),
        value(from),
        value(to),
    );
    if doublings > 0 {
        let times = counted(doublings as usize, "time", "times");
        text += &format!("- At period doublings the motion of twice the period is followed as well, {times} over.\n");
    }
    if asymmetric {
        text += "- Where a motion loses its symmetry the two asymmetric motions are followed as well.\n";
    }
    if let Some(step) = settings.round_period_to {
        text += &format!("- The forcing period is rounded to whole steps of {}.\n", quantity(step, "s", 4));
    }
    text + "- Measures are of one period of each motion.\n\n"
}

/// What was varied, and by what.
fn searches(optimise: &Optimise) -> String {
    let unit = if optimise.gaps == GapWord::Gap { "m" } else { "" };
    let mut bounds: Vec<String> = Vec::new();
    for [low, high] in &optimise.bounds {
        let description = format!("{} to {}", quantity(*low, unit, 3), quantity(*high, unit, 3));
        if !bounds.contains(&description) {
            bounds.push(description);
        }
    }
    let count = counted(optimise.bounds.len(), "gap", "gaps");
    let mut text = format!("- {count} varied from {}.\n", joined(&bounds));
    let seeds: Vec<String> = optimise.seeds.iter().map(u32::to_string).collect();
    let seeds = format!("{} {}", if seeds.len() == 1 { "seed" } else { "seeds" }, joined(&seeds));
    let is_beside = optimise.searches.iter().any(|search| matches!(search, Search::Genetic { .. }));
    for search in &optimise.searches {
        text += &match search {
            Search::Genetic { population, elites, crossover, .. } => format!(
                "- Genetic algorithm: {population} individuals, {elites} of which survive unchanged, {} % of the children by crossover; \
                 {seeds}. It ends {}.{}\n",
                compact(100.0 * crossover, 3),
                ends(optimise),
                if optimise.two_opt { " 2-opt then swaps pairs of its gaps." } else { "" }
            ),
            Search::CmaEs { .. } if is_beside => format!("- CMA-ES, on as many evaluations; {seeds}.\n"),
            Search::CmaEs { .. } => format!("- CMA-ES; {seeds}. It ends {}.\n", ends(optimise)),
            Search::Dense { points, refine, .. } => format!(
                "- Dense search: every combination of {points} values a gap, then {} around the best.\n",
                counted(*refine as usize, "finer grid", "finer grids")
            ),
            Search::Polish { evaluations } => format!(
                "- Polishing: from the best candidate down the gradient of settled motion, {} at most.\n",
                counted(*evaluations as usize, "orbit", "orbits")
            ),
        };
    }
    text
}

/// When the genetic algorithm ends.
fn ends(optimise: &Optimise) -> String {
    let mut ends: Vec<String> = Vec::new();
    ends.extend(
        optimise.generations.map(|count| format!("after {}", counted(count as usize, "generation", "generations"))),
    );
    ends.extend(
        optimise.evaluations.map(|count| format!("after {}", counted(count as usize, "evaluation", "evaluations"))),
    );
    ends.extend(optimise.time.map(|seconds| format!("after {}", quantity(seconds, "s", 3))));
    ends.extend(optimise.tolerance.map(|tolerance| {
        let share = compact(tolerance, 3);
        format!("when the best fitness changes by less than {share} a generation over {} of them", optimise.stalled)
    }));
    ends.join(", or ")
}

/// What the numbers are means over.
fn averaged(experiment: &Experiment) -> String {
    let mut names: Vec<String> = Vec::new();
    for (parameter, _) in experiment.mean_over.iter().flat_map(|case| &case.values) {
        let name = column_words(&words::of_key(parameter));
        if !names.contains(&name) {
            names.push(name);
        }
    }
    format!(
        "Every number is the mean over {} of {}; a velocity ratio is that of the mean RMS velocities.",
        counted(experiment.mean_over.len(), "setting", "settings"),
        joined(&names)
    )
}

fn cases(experiment: &Experiment) -> String {
    let names: Vec<String> = experiment.swept.iter().map(|parameter| column_words(&words::of_key(parameter))).collect();
    let over = if names.is_empty() { String::new() } else { format!(" over {}", joined(&names)) };
    let cases = counted(experiment.cases.len(), "case", "cases");
    let over = match experiment.continued.first() {
        Some(continued) => {
            let along = column_words(&words::of_key(&continued.along));
            let mut directions: Vec<_> = experiment.cases.iter().filter_map(|case| case.direction).collect();
            directions.sort_unstable();
            directions.dedup();
            let directions: Vec<String> = directions.iter().map(words::of_key).collect();
            format!("{over}; {} the {along}, each starts from the last state of the one before it", joined(&directions))
        }
        None => over,
    };
    match &experiment.maximise {
        None if !experiment.refined.is_empty() => {
            format!("{cases}{over} to begin with; each case that is added where a line bends has a row, too")
        }
        None => format!("{cases}{over}"),
        Some(maximise) => {
            let ends = match (maximise.grid.first(), maximise.grid.last()) {
                (Some(first), Some(last)) => {
                    let [first, last] = [first, last].map(|end| quantity(*end, maximise.over.unit(), 4));
                    format!(" between {first} and {last}")
                }
                _ => String::new(),
            };
            let [measure, along] =
                [words::of_key(&maximise.measure), words::of_key(&maximise.over)].map(|key| column_words(&key));
            match maximise.wanted {
                SearchPoint::Maximum => {
                    format!("{cases}{over}; in each the {measure} is maximised over the {along}{ends}")
                }
                SearchPoint::Onset => {
                    format!("{cases}{over}; in each the onset of {measure} is looked for over the {along}{ends}")
                }
            }
        }
    }
}

fn solver_in_words(solver: SolverChoice) -> String {
    match solver {
        SolverChoice::EventDriven => "Solver: event-driven.".to_owned(),
        SolverChoice::FixedStep { time_step } => format!("Solver: fixed step of {}.", quantity(time_step, "s", 3)),
    }
}

/// `a, b and c`.
pub(super) fn joined(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

/// The section on effects.
pub(super) fn effects(effects: &[EffectUse]) -> String {
    if effects.is_empty() {
        return String::new();
    }
    let in_force: Vec<String> = effects.iter().filter(|effect| effect.in_force > 0).map(in_force).collect();
    let names = if in_force.is_empty() { "none".to_owned() } else { in_force.join(", ") };
    format!("Effects in force: {names}.\n\n")
}

fn in_force(effect: &EffectUse) -> String {
    if effect.in_force == effect.cases {
        effect.name.to_owned()
    } else {
        format!("{} (in {} of {} cases)", effect.name, effect.in_force, effect.cases)
    }
}
