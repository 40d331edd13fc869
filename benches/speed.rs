//! What a run costs, as a page of the report: `cargo bench --bench speed` writes `reports/speed.md` and its figure.
//!
//! Each number is the least of many runs in one process, since other programs only add to it; the median stands beside it.
//! A run that has visited its contact states before finds them built, so a first run in a new thread is timed apart.

mod common;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use common::{BEAM, SINGLE, experiment, system};
use shotdamp::dynamics::{
    Along, Branch, Contact, EventKind, HybridSystem, Options, Orbit, Placed, Response, StartState, event_driven,
};
use shotdamp::experiment::{Axis, AxisScale, Band, Drawing, FigureSpec, Joined, Panel};
use shotdamp::figure::{Beside, draw};
use shotdamp::study::Machine;
use shotdamp::table::{BASELINE, Column, Data, Table};

/// The RMS velocity of the scene of reference, m/s, in the digits that a run of it in arithmetic of 128 bits left: by a program outside
/// this package, so that the page says how far the engine is off and nothing is asserted.
const REFERENCE_RMS: f64 = 2.044_410_542_971_8;

/// Nine dampers about the centre of a plate of sixteen modes.
const PLATE: &str = "structure: {supported_plate: {length: 1.3333333333333333 m, width: 1 m, thickness: 7.91 mm, youngs_modulus: 68.9 GPa, poisson_ratio: 0.33, density: 2700 kg/m^3, rayleigh: 5e-5, modes: [4, 4]}}
  dampers:
    - at: [0.5, 0.5]
      mass_ratio: 0.1
      particle_share: 0.5
      gap: 20 mm
      floor: {resilient: {stiffness: assumed, damping_ratio: 0.1}}
      array: {count: 9, spacing: 2 cm}
  excitation: {impulse_train: {at: [0.25, 0.375], impulse: 13.2 N s, frequency_ratio: 1}}";

/// Modes of the beam in the curves of cost; with them four compressions, at most.
const MODES: [u32; 6] = [4, 8, 16, 32, 64, 124];

fn main() {
    let mut page = String::from(
        "# Speed\n\n[All experiments](README.md)\n\nWritten by `cargo bench --bench speed`; every time is that of one \
         run of 125 forcing cycles on one thread, the least and the median of many. On a machine with other work the least is \
         the one to compare.\n\n",
    );
    let _ = writeln!(
        page,
        "Processor: {} ({}); one program for all processors, which uses registers of four numbers where there are some.\n",
        Machine::here().processor,
        std::env::consts::ARCH
    );
    page += "| Scene | Degrees of freedom | Events | Least | Median | An event | A contact state's first visit |\n";
    page += "| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n";
    let single = SINGLE.replace("PERIOD", "frequency_ratio: 1");
    let reference = Cost::of(&system(&single));
    page += &reference.row("One mass, one damper");
    let damped = |modes: u32, damping: &str| BEAM.replace("MODES", &modes.to_string()).replace("DAMPING", damping);
    let beam = |modes: u32| damped(modes, "damping_ratio: 0.1");
    let curve: Vec<(u32, Cost)> = MODES.into_iter().map(|modes| (modes, Cost::of(&system(&beam(modes))))).collect();
    for (modes, cost) in &curve {
        page += &cost.row(&format!("Beam, {modes} modes, 4 dampers"));
    }
    page += &Cost::of(&system(PLATE)).row("Plate, 16 modes, 9 dampers");
    page += "\nThese times, and that of an event, are of runs that find their contact states made. A first run takes as much longer as the last column \
             says.\n";
    page += &periodic(&system(&single));
    page += &half_cycles(|damping| system(&damped(4, damping)));
    let error = (reference.response.window().rms_velocity() / REFERENCE_RMS - 1.0).abs();
    let _ = writeln!(
        page,
        "\nThe RMS velocity of the first scene is within {error:.0e} of that from arithmetic of 128 bits.\n\n\
         ![Cost against modes](speed.png)\n\nCost on the beam against the number of modes, with four dampers."
    );
    let reports = Path::new(env!("CARGO_MANIFEST_DIR")).join("reports");
    let picture = draw(&experiment(&single), &figure(), &table(&curve), Beside::default())
        .expect("the table has what the figure names");
    std::fs::write(reports.join("speed.svg"), picture.svg).expect("the folder of reports can be written");
    std::fs::write(reports.join("speed.png"), picture.png).expect("the folder of reports can be written");
    std::fs::write(reports.join("speed.md"), &page).expect("the folder of reports can be written");
    print!("{page}");
}

/// What a scene costs.
struct Cost {
    response: Response,
    freedom: usize,
    states: usize,
    /// s.
    least: f64,
    median: f64,
    first: f64,
}

impl Cost {
    fn of(system: &HybridSystem) -> Self {
        let options = Options { displacement: false, ..Options::default() };
        let run = || event_driven(std::hint::black_box(system), &options).expect("the scenes above run");
        let timed = || {
            let begin = Instant::now();
            std::hint::black_box(run());
            begin.elapsed().as_secs_f64()
        };
        let new_thread = || std::thread::scope(|scope| scope.spawn(timed).join()).expect("the run does not panic");
        let first = sorted(new_thread, 2)[0];
        let times = sorted(timed, 5);
        let recorded = Options { record_events: usize::MAX, ..options.clone() };
        let response = event_driven(system, &recorded).expect("the scenes above run");
        Self {
            states: visited(system, &response),
            freedom: system.mass.order + system.particles.len(),
            least: times[0],
            median: times[times.len() / 2],
            first,
            response,
        }
    }

    fn an_event(&self) -> f64 {
        self.least / self.response.proof.events as f64
    }

    fn a_state(&self) -> f64 {
        (self.first - self.least).max(0.0) / self.states as f64
    }

    fn row(&self, scene: &str) -> String {
        format!(
            "| {scene} | {} | {} | {:.3} ms | {:.3} ms | {:.2} µs | {:.0} µs × {} |\n",
            self.freedom,
            self.response.proof.events,
            1e3 * self.least,
            1e3 * self.median,
            1e6 * self.an_event(),
            1e6 * self.a_state(),
            self.states,
        )
    }
}

/// What a damping that depends on the acceleration costs, beside a constant one.
fn half_cycles(system: impl Fn(&str) -> HybridSystem) -> String {
    let mut text = String::from(
        "\nEquivalent viscous damping ends a half cycle wherever the acceleration at the free end of the beam crosses zero, and \
         each one that differs from those before gives every compressed face a new contact state. In a sweep each run has a little \
         more impulse than the one before; the median of forty.\n\n\
         | Dashpots of the four dampers | First run | In a sweep | Times a constant one |\n| --- | ---: | ---: | ---: |\n",
    );
    let cost = |damping: &str| {
        let system = system(damping);
        (Cost::of(&system).first, in_a_sweep(system))
    };
    let (first_constant, constant) = cost("damping: 3 N s/m");
    let flat =
        "damping: equivalent_viscous, damping_curve: {acceleration_ratio: [0.7, 7.6], damping: [3 N s/m, 3 N s/m]}";
    let curves = [
        ("Constant, 3 N s/m", "damping: 3 N s/m"),
        ("By half cycles, the curve constant at 3 N s/m", flat),
        ("By half cycles, the assumed curve", "damping: equivalent_viscous"),
    ];
    for (name, damping) in curves {
        let (first, swept) = cost(damping);
        let (once, each) = (first / first_constant, swept / constant);
        let _ = writeln!(text, "| {name} | {:.1} ms | {:.1} ms | {once:.1}, {each:.1} |", 1e3 * first, 1e3 * swept);
    }
    text
}

/// Median time of runs each of which has a little more impulse than the one before, s.
fn in_a_sweep(mut system: HybridSystem) -> f64 {
    let options = Options { displacement: false, ..Options::default() };
    let mut times: Vec<f64> = (0..40)
        .map(|_| {
            system.drive.ticks.iter_mut().for_each(|tick| tick.impulse *= 1.001);
            let begin = Instant::now();
            std::hint::black_box(event_driven(std::hint::black_box(&system), &options).expect("the scenes above run"));
            begin.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Points of the branch that is timed.
const POINTS: usize = 200;

/// What periodic motions of the scene of reference cost.
fn periodic(system: &HybridSystem) -> String {
    let run = event_driven(system, &Options::default()).expect("the scenes above run");
    let [y, w] = run.final_particles[0];
    let (x, v) = (run.final_displacement, run.final_velocity);
    let last =
        StartState::Given { q: vec![x], rate: vec![v], particles: vec![Placed::new(Contact::Flight, y - x, w - v)] };
    let orbit = || Orbit::near(std::hint::black_box(system), &last, 1).expect("the run has settled");
    let first = orbit();
    let stronger = |times: f64| {
        let mut system = system.clone();
        system.drive.ticks.iter_mut().for_each(|tick| tick.impulse *= times);
        Ok::<_, std::convert::Infallible>(system)
    };
    let along = Along { from: 1.0, to: 1e3, step: 0.004, points: POINTS };
    let branch = || Branch::follow(stronger, &first, 1.0, along).expect("it has a first orbit");
    let timed = |work: &dyn Fn()| {
        let times = sorted(
            || {
                let begin = Instant::now();
                work();
                begin.elapsed().as_secs_f64()
            },
            5,
        );
        (times[0], times[times.len() / 2])
    };
    let ((orbit_least, orbit_median), (least, median)) =
        (timed(&|| drop(std::hint::black_box(orbit()))), timed(&|| drop(std::hint::black_box(branch()))));
    let elastic = || first.elasticity(stronger, |run| run.window().rms_velocity()).expect("it is smooth");
    let (elastic_least, elastic_median) = timed(&|| {
        std::hint::black_box(elastic());
    });
    let followed = branch();
    format!(
        "\n| Periodic motion of the first scene | Least | Median |\n| --- | ---: | ---: |\n\
         | One orbit by Newton's method from the last cycle of a run | {:.0} µs | {:.0} µs |\n\
         | The elasticity of its RMS velocity in the impulse | {:.0} µs | {:.0} µs |\n\
         | A branch of {} points in the impulse, with its special points | {:.1} ms | {:.1} ms |\n",
        1e6 * orbit_least,
        1e6 * orbit_median,
        1e6 * elastic_least,
        1e6 * elastic_median,
        followed.points.len(),
        1e3 * least,
        1e3 * median,
    )
}

/// Times in ascending order: for a second or so, but no fewer than `least`.
fn sorted(timed: impl Fn() -> f64, least: usize) -> Vec<f64> {
    let mut times = Vec::new();
    let begin = Instant::now();
    while times.len() < least || (begin.elapsed().as_secs_f64() < 1.0 && times.len() < 2000) {
        times.push(timed());
    }
    times.sort_by(f64::total_cmp);
    times
}

/// How many contact states a run has visited.
fn visited(system: &HybridSystem, response: &Response) -> usize {
    let mut now = vec![Contact::Floor; system.particles.len()];
    let mut states = BTreeSet::from([now.clone()]);
    for event in &response.events {
        now[event.particle] = match event.kind {
            EventKind::FloorContact => Contact::Floor,
            EventKind::CeilingContact => Contact::Ceiling,
            EventKind::FloorRelease | EventKind::CeilingRelease => Contact::Flight,
            _ => continue,
        };
        states.insert(now.clone());
    }
    states.len()
}

fn figure() -> FigureSpec {
    let axis =
        |column: &str, label: &str| Axis { label: Some(label.into()), scale: AxisScale::Log, ..Axis::of(column) };
    FigureSpec {
        name: String::new(),
        only: None,
        caption: "Cost on the beam against the number of modes.".into(),
        drawing: Drawing::Lines(vec![Panel {
            x: axis("modes", "Modes"),
            y: vec![axis("event", "An event"), axis("state", "A contact state's first visit")],
            by: Vec::new(),
            band: Band::None,
            over_first: false,
            guides: Vec::new(),
            markers: true,
            peaks: None,
            strip: None,
            joined: Joined::ByX,
        }]),
    }
}

fn table(curve: &[(u32, Cost)]) -> Table {
    let column = |name: &str, unit: &str, of: &dyn Fn(&(u32, Cost)) -> f64| Column {
        name: name.into(),
        unit: unit.into(),
        symbol: String::new(),
        data: Data::Float(curve.iter().map(of).collect()),
    };
    let variant = Column {
        name: "variant".into(),
        unit: String::new(),
        symbol: String::new(),
        data: Data::Text(vec![BASELINE.into(); curve.len()]),
    };
    Table {
        columns: vec![
            variant,
            column("modes", "", &|(modes, _)| f64::from(*modes)),
            column("event", "µs", &|(_, cost)| 1e6 * cost.an_event()),
            column("state", "µs", &|(_, cost)| 1e6 * cost.a_state()),
        ],
        ..Table::default()
    }
}
