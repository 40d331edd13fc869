//! The bench on which the engine's tests put a scene: reading a case, building the scene, running it, comparing.

use std::cell::RefCell;
use std::time::Duration;

use serde_json::Value;
use shotdamp::accuracy::precise::precise;
use shotdamp::dynamics::{
    Contact, Event, EventKind, HybridSystem, Options, Placed, Response, StartState, event_driven,
};
use shotdamp::scene::{ContactDamping, ContactEnd, Damper, Excitation, Scene, SingleMass, Surface, compile};

/// m/s².
pub const GRAVITY: f64 = 9.81;

/// One case of a data file.
#[derive(Debug, Clone)]
pub struct Case(Value);

/// The cases of a data file.
pub fn cases(text: &str) -> Vec<Case> {
    let data: Value = serde_json::from_str(text).expect("the data file is JSON");
    data["cases"].as_array().expect("it has cases").iter().cloned().map(Case).collect()
}

impl Case {
    pub fn text(&self, key: &str) -> &str {
        self.0[key].as_str().unwrap_or_else(|| panic!("no text `{key}` in {self:?}"))
    }

    /// A part of the case, a case itself.
    pub fn part(&self, key: &str) -> Self {
        Self(self.0[key].clone())
    }

    pub fn list(&self, key: &str) -> Vec<Self> {
        self.0[key]
            .as_array()
            .unwrap_or_else(|| panic!("no list `{key}` in {self:?}"))
            .iter()
            .cloned()
            .map(Self)
            .collect()
    }

    /// A number, or an exact decimal written as text.
    pub fn number(&self, key: &str) -> f64 {
        number(&self.0[key]).unwrap_or_else(|| panic!("no number `{key}` in {self:?}"))
    }

    pub fn optional(&self, key: &str) -> Option<f64> {
        number(&self.0[key])
    }

    /// All numbers under a key: one of them, or a list.
    pub fn numbers(&self, key: &str) -> Vec<f64> {
        match &self.0[key] {
            Value::Array(items) => items.iter().filter_map(number).collect(),
            other => number(other).into_iter().collect(),
        }
    }

    /// Entry `i` of a case that is a list.
    pub fn at(&self, i: usize) -> Self {
        Self(self.0[i].clone())
    }

    pub fn value(&self) -> f64 {
        number(&self.0).expect("a number")
    }

    pub fn word(&self) -> &str {
        self.0.as_str().expect("a text")
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_f64().or_else(|| value.as_str().and_then(|text| text.parse().ok()))
}

/// m x″ + c x′ + k x = F.
pub fn base(mass: f64, stiffness: f64, damping: f64) -> SingleMass {
    SingleMass { mass, stiffness, damping }
}

pub fn rigid(restitution: f64) -> Surface {
    Surface::Rigid { restitution }
}

/// A spring and a dashpot that let go at zero gap.
pub fn resilient(stiffness: f64, damping: f64) -> Surface {
    Surface::Resilient { stiffness, damping: ContactDamping::Constant(damping), ends: ContactEnd::ZeroGap }
}

/// The same, but unable to pull.
pub fn resilient_without_tension(stiffness: f64, damping: f64) -> Surface {
    Surface::Resilient { stiffness, damping: ContactDamping::Constant(damping), ends: ContactEnd::ZeroForce }
}

/// A particle between two faces of one kind.
pub fn damper(particle_mass: f64, gap: f64, surface: Surface) -> Damper {
    Damper::between(surface, particle_mass, gap)
}

/// No force, for one cycle of `span` seconds.
pub fn nothing(span: f64) -> Excitation {
    Excitation::SingleImpulse { impulse: 0.0, cycle: span }
}

/// One damper on one mass.
pub fn scene(mass: SingleMass, gravity: f64, damper: Damper, excitation: Excitation) -> Scene {
    Scene::on_one_mass(mass, gravity, vec![damper], excitation)
}

/// A base at x, x′, with the particle in flight at u, u′.
pub fn in_flight(base: [f64; 2], gap: [f64; 2]) -> StartState {
    StartState::Given {
        q: vec![base[0]],
        rate: vec![base[1]],
        particles: vec![Placed::new(Contact::Flight, gap[0], gap[1])],
    }
}

/// One cycle from a start, every event kept.
pub fn once(start: StartState) -> Options {
    Options { skip: 0, average: 1, start, record_events: usize::MAX, audit: true, ..Options::default() }
}

pub fn system(scene: &Scene) -> HybridSystem {
    compile(scene).expect("the scene compiles")
}

/// Runs a scene; whatever it is, its balances must close.
pub fn run(scene: &Scene, options: &Options) -> Response {
    let response = event_driven(&system(scene), options).expect("the engine runs the scene");
    if options.audit {
        balanced(&response);
    }
    response
}

thread_local! {
    /// Comparisons of a test while somebody listens.
    static LEDGER: RefCell<Ledger> = RefCell::default();
}

/// What the comparisons of a test came to.
#[derive(Debug, Clone, Default)]
pub struct Ledger {
    /// How many there were.
    pub comparisons: usize,
    /// Error and bound of the one that came closest to its bound.
    pub worst: [f64; 2],
    /// What it compared.
    pub what: String,
}

/// Enters a comparison.
pub fn note(what: &str, error: f64, bound: f64) {
    LEDGER.with_borrow_mut(|ledger| {
        let share = |[error, bound]: [f64; 2]| if error == 0.0 { 0.0 } else { error / bound };
        if ledger.comparisons == 0 || share([error, bound]) > share(ledger.worst) {
            ledger.worst = [error, bound];
            ledger.what = what.into();
        }
        ledger.comparisons += 1;
    });
}

/// What the comparisons of some tests come to.
pub fn listened(tests: &[fn()]) -> Ledger {
    LEDGER.take();
    tests.iter().for_each(|test| test());
    LEDGER.take()
}

/// Momentum and energy close to rounding.
pub fn balanced(response: &Response) {
    let proof = response.proof;
    note("momentum residual", proof.momentum_residual, 1e-12);
    note("energy residual", proof.energy_residual, 1e-12);
    assert!(proof.momentum_residual < 1e-12, "momentum residual {:e}", proof.momentum_residual);
    assert!(proof.energy_residual < 1e-12, "energy residual {:e}", proof.energy_residual);
}

/// The events of one kind.
pub fn only(response: &Response, kind: EventKind) -> Vec<Event> {
    response.events.iter().copied().filter(|event| event.kind == kind).collect()
}

/// Seconds since the start.
pub fn instant(scene: &Scene, event: &Event) -> f64 {
    event.cycle as f64 * scene.excitation.period() + event.time
}

/// |got/want − 1| ≤ tolerance.
#[track_caller]
pub fn close(what: &str, got: f64, want: f64, tolerance: f64) {
    within(what, got, want, tolerance * want.abs());
}

/// |got − want| ≤ bound.
#[track_caller]
pub fn within(what: &str, got: f64, want: f64, bound: f64) {
    let error = (got - want).abs();
    // Read with `cargo test -- --nocapture`.
    println!("{what}: {got} for {want}, error {:.1e} of {:.1e} allowed", error, bound);
    note(what, error, bound);
    assert!(error <= bound, "{what}: {got} instead of {want}, off by {error:.2e}, allowed {bound:.2e}");
}

/// How long the solver of many digits may take.
const PATIENCE: Duration = Duration::from_secs(100);

/// The engine and the solver of many digits end at the same state, as far as `tolerance` (relative to the places and speeds of
/// the run) and a drive known to twelve digits let them.
pub fn agree(what: &str, system: &HybridSystem, options: &Options, tolerance: f64) -> Response {
    let response = event_driven(system, options).unwrap_or_else(|error| panic!("{what}: {error}"));
    let many = precise(system, options, PATIENCE).unwrap_or_else(|error| panic!("{what}: {error}"));
    let kicked = event_driven(system, &Options { kick: 1e-12, ..options.clone() }).expect("it runs kicked");
    let ends = |end: &Response| {
        let places = [end.final_displacement].into_iter().chain(end.final_particles.iter().map(|[y, _]| *y));
        let speeds = [end.final_velocity].into_iter().chain(end.final_particles.iter().map(|[_, w]| *w));
        [places.collect::<Vec<_>>(), speeds.collect()]
    };
    let rms = many.window().rms_velocity();
    let window = many.window();
    let places = window.mean_displacement().hypot(window.std_displacement());
    // Places round where they are, however little they move; a mode turns that into speeds.
    let rounding = 8.0 * f64::EPSILON * places;
    let rounding = [rounding, rounding * response.highest_frequency];
    for (i, scale) in [places, rms].into_iter().enumerate() {
        let [got, want, moved] = [&response, &many, &kicked].map(|end| ends(end)[i].clone());
        for ((got, want), moved) in got.iter().zip(&want).zip(&moved) {
            let bound = tolerance * scale.max(want.abs()) + rounding[i] + 3.0 * (moved - got).abs();
            within(&format!("{what}, end"), *got, *want, bound);
        }
    }
    assert_eq!(response.proof.events, many.proof.events, "{what}");
    response
}
