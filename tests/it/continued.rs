//! Sweeps whose rows start where the row before ended: what a person writes, what is carried on, and what happens when it breaks off.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;

use shotdamp::dynamics::{Contact, HybridSystem, Options, Placed, Proof, StartState, event_driven};
use shotdamp::experiment::{
    Assumptions, Experiment, ExperimentId, Given, StrengthRecipe, load_assumptions, parse_experiment,
};
use shotdamp::figure::{Beside, draw};
use shotdamp::measure::{
    CycleSpec, CycleValue, Evaluated, Link, Measured, Request, SolverChoice, TraceColumn, evaluate,
};
use shotdamp::scene::{ContactDamping, ContactEnd, Damper, Excitation, LimitStop, Scene, SingleMass, Surface, compile};
use shotdamp::study::{Evaluate, IgnoreEvents, RowFailure, Shard, Simulation};
use shotdamp::table::Table;

use crate::desk::{Desk, refuses};

const RELAY: &str = "title: Up and down
source: {chapter: 3, section: 3.6.3}
about: One scene, followed both ways.
scene:
  structure: {single_mass: {mass: 1 kg, stiffness: 1000 N/m, damping_ratio: 0.05}}
  dampers: [{mass_ratio: 0.05, gap_ratio: 50, floor: {resilient: {stiffness_ratio: 1, damping_ratio: assumed}}}]
  excitation: {impulse_train: {force_ratio: swept, frequency_ratio: 1}}
sweep:
  force_ratio: [3, 1, 2, 4, 5]
  direction: [up, down]
  from: last
run: {solver: event_driven, skip: 25 cycles, average: 100 cycles}
measure: [velocity_ratio]
each_cycle: impact_speed
figure: {x: force_ratio, y: impact_speed, by: direction, caption: Up and down.}
";

/// A relay: it closes where the force ratio exceeds `closes`, opens where it is below `opens`, and stays as it was in between.
#[derive(Default)]
struct Relay {
    closes: f64,
    opens: f64,
    fails_at: Option<f64>,
    asked: Mutex<Vec<f64>>,
}

impl Evaluate for Relay {
    fn evaluate(&self, it: &Simulation<'_>) -> Result<Evaluated, RowFailure> {
        let StrengthRecipe::ForceRatio(Given::Stated(force)) = it.recipe.excitation.strength else {
            return Err(RowFailure::NoGrid);
        };
        self.asked.lock().unwrap().push(force);
        if self.fails_at.is_some_and(|at| at == force) {
            return Err(RowFailure::NoValue("velocity_ratio".into()));
        }
        let before = match it.request.link {
            Link::None | Link::First => 0.0,
            Link::After(StartState::Given { q, .. }) => q[0],
            Link::After(StartState::StaticEquilibrium) => f64::NAN,
        };
        let state = if force > self.closes {
            1.0
        } else if force < self.opens {
            0.0
        } else {
            before
        };
        Ok(Evaluated {
            measured: it
                .request
                .measures
                .iter()
                .map(|_| Measured { value: state, numerical: 0.0, spread: 0.0 })
                .collect(),
            proof: Proof::default(),
            chaotic: false,
            unknown: None,
            members: 1,
            motion: None,
            trace: it
                .request
                .each_cycle
                .map(|_| vec![TraceColumn::new("impact_speed", "m/s", vec![force, state])])
                .unwrap_or_default(),
            end: (!matches!(it.request.link, Link::None)).then(|| StartState::Given {
                q: vec![state],
                rate: vec![0.0],
                particles: vec![Placed::ON_FLOOR],
            }),
        })
    }
}

fn relay() -> Relay {
    Relay { closes: 3.5, opens: 1.5, ..Relay::default() }
}

/// A study of this experiment alone.
fn desk(text: &str) -> Desk {
    let desk = Desk::new();
    for other in [
        "experiments/ch3/ch3-stop.yaml",
        "experiments/ch3/ch3-gap.yaml",
        "reference/ch3/ch3-stop.yaml",
        "reference/ch3/ch3-gap.yaml",
    ] {
        std::fs::remove_file(desk.layout.path(other)).unwrap();
    }
    desk.put("experiments/ch3/ch3-relay.yaml", text);
    desk
}

/// Values by force ratio in a direction.
fn values(table: &Table, direction: &str) -> BTreeMap<u64, f64> {
    let (x, y) = (table.floats("force_ratio").unwrap(), table.floats("velocity_ratio").unwrap());
    let rows = table.baseline().rows_where("direction", direction);
    rows.into_iter().map(|row| (x[row] as u64, y[row])).collect()
}

#[test]
fn what_holds_until_it_is_left_shows_as_hysteresis() {
    let desk = desk(RELAY);
    desk.run(3, &relay(), &IgnoreEvents);
    let table = desk.table("ch3-relay");
    assert_eq!(values(&table, "up").into_values().collect::<Vec<_>>(), [0.0, 0.0, 0.0, 1.0, 1.0]);
    assert_eq!(values(&table, "down").into_values().collect::<Vec<_>>(), [0.0, 1.0, 1.0, 1.0, 1.0]);
    // The table keeps the order of the file.
    assert_eq!(table.floats("force_ratio").unwrap()[..5], [3.0, 1.0, 2.0, 4.0, 5.0]);
}

#[test]
fn a_chain_is_the_same_for_any_number_of_threads_and_of_shards() {
    let text = RELAY
        .replace("gap_ratio: 50", "gap_ratio: swept")
        .replace("  force_ratio: [", "  gap_ratio: [10, 20, 50]\n  along: force_ratio\n  force_ratio: [");
    let bytes = [1, 2, 7].map(|threads| {
        let desk = desk(&text);
        desk.run(threads, &relay(), &IgnoreEvents);
        desk.bytes("results/ch3-relay.parquet")
    });
    assert!(bytes[0] == bytes[1] && bytes[0] == bytes[2]);

    let desk = desk(&text);
    let item = &desk.plan()["ch3-relay"];
    let metadata = item.provenance();
    let journal = desk.layout.path("journal");
    for shard in Shard::all(4) {
        let task = shotdamp::study::Task { shard: Some(shard), ..item.task(&metadata, &journal) };
        let save = |_: usize, finished: shotdamp::study::Finished| shard.save(&desk.layout, item, &finished).unwrap();
        shotdamp::study::run(&[task], 2, &relay(), &IgnoreEvents, save).unwrap();
    }
    let gathered = shotdamp::study::gather(&desk.layout, item, 4).unwrap();
    shotdamp::study::save(&desk.layout, item, &gathered).unwrap();
    assert!(desk.bytes("results/ch3-relay.parquet") == bytes[0]);
}

#[test]
fn rows_after_one_that_fails_are_not_run_and_say_so() {
    let desk = desk(RELAY);
    desk.run(2, &Relay { fails_at: Some(3.0), ..relay() }, &IgnoreEvents);
    let table = desk.table("ch3-relay");
    let (x, failures) = (table.floats("force_ratio").unwrap(), table.texts("failure").unwrap());
    for (direction, after) in [("up", [4.0, 5.0]), ("down", [1.0, 2.0])] {
        for row in table.baseline().rows_where("direction", direction) {
            let expected = match x[row] {
                3.0 => "velocity_ratio has no value",
                x if after.contains(&x) => "break off at force_ratio = 3, direction = ",
                _ => "",
            };
            assert!(
                failures[row].contains(expected) && failures[row].is_empty() == expected.is_empty(),
                "{}",
                failures[row]
            );
        }
    }
    // What has failed is tried again, from the first row of its chain on.
    let second = relay();
    desk.run(2, &second, &IgnoreEvents);
    let table = desk.table("ch3-relay");
    assert!(table.texts("failure").unwrap().iter().all(String::is_empty));
    assert!(second.asked.lock().unwrap().len() >= 10);
}

#[test]
fn a_chain_is_restored_as_a_whole_or_computed_as_a_whole() {
    let desk = desk(RELAY);
    desk.run(2, &relay(), &IgnoreEvents);
    let first = desk.table("ch3-relay");
    let longer = RELAY.replace("4, 5]", "4, 5, 6]");
    desk.put("experiments/ch3/ch3-relay.yaml", &longer);
    let added = relay();
    desk.run(2, &added, &IgnoreEvents);
    let baseline = |force: f64| added.asked.lock().unwrap().iter().filter(|one| **one == force).count();
    assert!(baseline(1.0) > 0 && baseline(6.0) > 0, "a row more makes another chain");
    desk.put("experiments/ch3/ch3-relay.yaml", RELAY);
    let none = relay();
    desk.run(2, &none, &IgnoreEvents);
    assert_eq!(none.asked.lock().unwrap().len(), 0, "the earlier chain is known");
    assert_eq!(desk.table("ch3-relay"), first);
}

fn read(text: &str) -> Result<Experiment, String> {
    let sheet = load_assumptions(&Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/assumptions.yaml"));
    let assumptions = sheet.unwrap_or_else(|problems| panic!("{problems}")).assumptions();
    let id = ExperimentId("ch3-relay".into());
    parse_experiment(&id, "mine.yaml", text, &assumptions).map_err(|problems| problems.to_string())
}

#[test]
fn what_cannot_be_followed_is_refused_where_it_stands() {
    let mistakes = [
        ("  from: last\n", "", "10:", "add `from: last`"),
        ("from: last", "from: lst", "11:", "did you mean `last`?"),
        ("[up, down]", "[up, dwon]", "10:", "did you mean `down`?"),
        ("[up, down]", "[up, up]", "10:", "`up` is said twice"),
        ("direction: [up, down]", "along: gap_ratio", "10:", "`gap_ratio` is not swept here"),
        ("direction: [up, down]", "gap_ratio: [10, 50]", "11:", "along which one?"),
        ("force_ratio: [3, 1, 2, 4, 5]", "force_ratio: 3", "11:", "no row follows another"),
        (
            "force_ratio: [3, 1, 2, 4, 5]",
            "paired: {force_ratio: [1, 2], gap_ratio: [10, 20]}\n  along: force_ratio",
            "12:",
            "no row follows another",
        ),
        ("force_ratio: [3, 1, 2, 4, 5]", "force_ratio: {refined: {from: 1, to: 5}}", "9:", "fixed points"),
        (
            "force_ratio: [3, 1, 2, 4, 5]",
            "dampers: [with, without]\n  force_ratio: [1, 2]\n  along: dampers",
            "11:",
            "no state is carried along `dampers`",
        ),
        (
            "solver: event_driven",
            "solver: {fixed_step: {time_step: 0.1 ms}}",
            "11:",
            "goes with `solver: event_driven`",
        ),
        (
            "each_cycle: impact_speed\n",
            "maximise: {velocity_ratio: {over: gap_ratio, in: [10, 20]}}\n",
            "14:",
            "leave it or `from: last` out",
        ),
        ("each_cycle: impact_speed\n", "mean_over: {gap_ratio: [10, 20]}\n", "14:", "leave it or `from: last` out"),
        ("damping_ratio: assumed", "damping: equivalent_viscous", "9:", "equivalent viscous damping"),
        ("each_cycle: impact_speed", "each_cycle: impact_sped", "14:", "did you mean `impact_speed`?"),
        (
            "each_cycle: impact_speed",
            "each_cycle: {of: impact_speed, last: 101 cycles}",
            "14:",
            "100 cycles that are averaged",
        ),
        (
            "each_cycle: impact_speed",
            "each_cycle: impact_speed\ntrace: {from: 0 cycles, to: 1 cycles, samples_per_cycle: 9}",
            "14:",
            "one of `trace`",
        ),
        ("y: impact_speed", "y: [impact_speed, velocity_ratio]", "15:", "a panel of their own"),
        ("y: impact_speed", "y: impact_phase", "15:", "no column `impact_phase`"),
        ("y: impact_speed, ", "y: impact_speed, peaks: {}, ", "15:", "which no line joins"),
    ];
    refuses(RELAY, read, &mistakes);
    // What says nothing of it means what it meant before.
    let plain = RELAY
        .replace("  direction: [up, down]\n  from: last\n", "")
        .replace("each_cycle: impact_speed\n", "")
        .replace("y: impact_speed, by: direction", "y: velocity_ratio");
    let text = read(&plain).unwrap().simulation_json().to_string();
    assert!(!text.contains("direction") && !text.contains("continued") && !text.contains("each_cycle"));
}

/// The scene of an experiment of the verification study.
fn classic(id: &str, exchanged: &[(&str, &str)]) -> Experiment {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/classics/experiments/{id}.yaml"));
    let mut text = std::fs::read_to_string(path).unwrap();
    for (from, to) in exchanged {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    parse_experiment(&id.parse().unwrap(), "mine.yaml", &text, &Assumptions::default())
        .unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn phases_and_speeds_of_a_bouncing_ball_obey_the_closed_form_of_its_flight() {
    // Γ = 3: chaos; every flight follows from the impact before it.
    let (strength, restitution, frequency, gravity) = (3.0, 0.5, 60.0, 9.81);
    let experiment = classic(
        "bouncing-ball",
        &[("base_amplitude_ratio: 1.2", "base_amplitude_ratio: 3"), ("skip: 300", "skip: 20")],
    );
    let recipe = experiment.recipe_of(&experiment.cases[0]).unwrap();
    let list = |of: CycleValue| {
        let each = CycleSpec { of, last: None };
        let request = Request { each_cycle: Some(&each), ..Request::default() };
        let subject = recipe.subject(&Assumptions::default(), request.needs()).unwrap();
        let evaluated = evaluate(subject, SolverChoice::EventDriven, &experiment.settings, &request).unwrap();
        evaluated.trace.into_iter().next().unwrap().samples
    };
    let (phases, speeds) = (list(CycleValue::ImpactPhase), list(CycleValue::ImpactSpeed));
    assert!(phases.len() == speeds.len() && phases.len() > 30, "{}", phases.len());
    let amplitude = strength * gravity / (frequency * frequency);
    let mut checked = 0;
    for (phase, speed) in phases.windows(2).zip(speeds.windows(2)) {
        if speed[0] < 1e-3 {
            continue;
        }
        // The table moves as a sin ωt, the ball on a parabola; phases do not say how many whole cycles lie between.
        let (begin, leaves) = (phase[0], restitution * speed[0]);
        let relative = |cycles: f64| {
            let angle = phase[1] - begin + std::f64::consts::TAU * cycles;
            let time = angle / frequency;
            let table = amplitude * (libm::sin(begin + angle) - libm::sin(begin))
                - amplitude * frequency * libm::cos(begin) * time;
            let table_rate = amplitude * frequency * (libm::cos(begin + angle) - libm::cos(begin));
            (leaves * time - 0.5 * gravity * time * time - table, leaves - gravity * time - table_rate)
        };
        let lands = |cycles: &f64| {
            let (height, rate) = relative(*cycles);
            height.abs() < 1e-11 && (rate + speed[1]).abs() < 1e-9
        };
        assert!((0..9).map(f64::from).any(|cycles| lands(&cycles)), "{phase:?} {speed:?} {:?}", relative(0.0));
        checked += 1;
    }
    assert!(checked > 20, "{checked} flights");
}

#[test]
fn a_run_that_is_cut_ends_where_the_whole_one_ends() {
    for (id, cycles) in
        [("two-impacts-at-resonance", 40), ("impact-pair", 30), ("resting-particle", 20), ("fixed-stop", 30)]
    {
        let experiment = classic(id, &[]);
        let recipe = experiment.recipe_of(&experiment.cases[0]).unwrap();
        let scene = recipe.resolve(&Assumptions::default()).unwrap();
        let system = compile(&scene).unwrap();
        let run = |start: StartState, cycles: u32| {
            let options = Options { skip: 0, average: cycles, start, final_state: true, ..Options::default() };
            event_driven(&system, &options).unwrap().final_state.unwrap()
        };
        let whole = run(scene.start_state(), 2 * cycles);
        let half = run(scene.start_state(), cycles);
        assert_eq!(half.carried_to(&system), Some(half.clone()), "{id}");
        let joined = run(half, cycles);
        let (StartState::Given { q, rate, particles }, StartState::Given { q: q2, rate: rate2, particles: particles2 }) =
            (&whole, &joined)
        else {
            panic!("a state")
        };
        let size = |x: &[f64]| x.iter().fold(1e-300_f64, |most, x| most.max(x.abs()));
        let close = |a: f64, b: f64, size: f64| (a - b).abs() <= 1e-9 * size;
        assert!(q.iter().zip(q2).all(|(a, b)| close(*a, *b, size(q).max(1e-3))), "{id}: {whole:?} {joined:?}");
        assert!(rate.iter().zip(rate2).all(|(a, b)| close(*a, *b, size(rate).max(1e-2))), "{id}: {whole:?} {joined:?}");
        for (a, b) in particles.iter().zip(particles2) {
            assert!(
                a.contact == b.contact && close(a.gap, b.gap, 1e-3) && close(a.rate, b.rate, 1e-2),
                "{id}: {whole:?} {joined:?}"
            );
        }
    }
}

#[test]
fn values_of_each_cycle_are_drawn_as_points_that_no_line_joins() {
    let desk = desk(RELAY);
    desk.run(2, &relay(), &IgnoreEvents);
    let item = &desk.plan()["ch3-relay"];
    let experiment = &item.source.experiment;
    let svg = draw(experiment, &experiment.figures[0], &desk.table("ch3-relay"), Beside::default()).unwrap().svg;
    let dots: Vec<&str> = svg.lines().filter(|line| line.contains("stroke-linecap=\"round\"")).collect();
    assert_eq!(dots.len(), 2, "a cloud each for up and down");
    // Five rows of two values each.
    assert!(dots.iter().all(|dots| dots.matches("h1").count() == 10), "{dots:?}");
}

#[test]
fn what_a_state_is_carried_to_lies_no_deeper_than_its_stops_and_no_higher_than_its_ceiling() {
    let system = |stop: Option<f64>, gap: f64| -> HybridSystem {
        let mass = SingleMass { mass: 1.0, stiffness: 1000.0, damping: 3.0 };
        let damping = ContactDamping::Constant(4.2);
        let face = Surface::Resilient { stiffness: 1000.0, damping, ends: ContactEnd::ZeroGap };
        let stop = stop.map(|length| LimitStop { length, restitution: 0.5 });
        let dampers = vec![Damper { stop, ..Damper::between(face, 0.05, gap) }];
        let impulses = Excitation::ImpulseTrain { impulse: 1.0, period: 0.2 };
        compile(&Scene::on_one_mass(mass, 9.81, dampers, impulses)).unwrap()
    };
    let at = |contact, gap, rate| StartState::Given {
        q: vec![0.01],
        rate: vec![0.2],
        particles: vec![Placed { contact, gap, rate }],
    };
    let shallow = system(Some(0.02), 0.3);
    for (from, to) in [
        (at(Contact::FloorStop, -0.05, 0.0), at(Contact::FloorStop, -0.02, 0.0)),
        (at(Contact::CeilingStop, 0.05, 0.0), at(Contact::CeilingStop, 0.02, 0.0)),
        (at(Contact::Floor, -0.05, 0.1), at(Contact::Floor, -0.02, 0.1)),
        (at(Contact::Ceiling, 0.05, 0.1), at(Contact::Ceiling, 0.02, 0.1)),
        (at(Contact::Floor, -0.01, 0.1), at(Contact::Floor, -0.01, 0.1)),
        (at(Contact::Flight, 0.4, 0.1), at(Contact::Flight, 0.3, 0.1)),
        (StartState::StaticEquilibrium, StartState::StaticEquilibrium),
    ] {
        assert_eq!(from.carried_to(&shallow), Some(to));
    }
    // On walls that bend the ceiling is where the structure has it: with q = 0.01 m and the row 0, that much nearer.
    let mut bent = shallow.clone();
    bent.particles[0].ceiling.as_mut().expect("it has one").row = vec![0.0];
    assert_eq!(at(Contact::Flight, 0.4, 0.1).carried_to(&bent), Some(at(Contact::Flight, 0.29, 0.1)));
    assert_eq!(at(Contact::Flight, 0.28, 0.1).carried_to(&bent), Some(at(Contact::Flight, 0.28, 0.1)));
    // Without the stop, the ceiling or the particle there is no such state.
    assert_eq!(at(Contact::FloorStop, -0.05, 0.0).carried_to(&system(None, 0.3)), None);
    let mut open = system(None, 0.3);
    open.particles[0].ceiling = None;
    assert_eq!(at(Contact::Ceiling, 0.01, 0.0).carried_to(&open), None);
    open.particles.clear();
    assert_eq!(at(Contact::Flight, 0.01, 0.0).carried_to(&open), None);
}
