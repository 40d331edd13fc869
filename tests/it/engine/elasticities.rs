//! Derivatives of periodic motions against closed forms, identities of scale and long runs, and where there are none.

use std::convert::Infallible;
use std::f64::consts::PI;

use shotdamp::dynamics::{
    Elasticity, ElasticityError, EventKind, HybridSystem, Options, Orbit, Response, StartState, Until, event_driven,
};
use shotdamp::measure::{
    Evaluated, Measure, NamedRows, Particles, Request, Rigour, Settings, SolverChoice, Subject, evaluate,
};
use shotdamp::scene::{Design, Excitation, Scene, SingleMass, Structure};

use super::bench::{GRAVITY, base, close, damper, in_flight, resilient, rigid, scene, system, within};
use super::closed_forms::{Steady, expected, masri_and_caughey, open};
use super::motion::Table;

fn rms(run: &Response) -> f64 {
    run.window().rms_velocity()
}

/// The elasticity of the RMS velocity.
fn of_rms(scene: &Scene, orbit: &Orbit, design: Design) -> Elasticity {
    let scaled = |factor| system(&scene.scaled(design, factor).expect("the scene has it"));
    orbit.elasticity(|factor| Ok::<_, Infallible>(scaled(factor)), rms).unwrap_or_else(|error| panic!("{error}"))
}

fn beside(steady: &Steady) -> StartState {
    let [y, w] = steady.response.final_particles[0];
    let (x, v) = (steady.response.final_displacement, steady.response.final_velocity);
    in_flight([x, v], [y - x, w - v])
}

const MASRI: [(&str, f64); 2] = [("a", 1.030_216_589_546_725_5), ("b", 0.246_499_927_843_622_73)];
const DESIGNS: [Design; 4] = [Design::Gap, Design::ParticleMass, Design::Damping, Design::Force];

#[test]
pub(super) fn the_impact_damper_of_masri_and_caughey_has_the_derivatives_of_its_closed_form() {
    for (case, velocity) in MASRI {
        let steady = masri_and_caughey(&format!("masri-caughey-two-impacts-{case}"), velocity);
        let orbit = Orbit::near(&system(&steady.scene), &beside(&steady), 1).expect("it is near");
        let value = expected(&format!("masri-caughey-elasticities-{case}"));
        for (i, design) in DESIGNS.into_iter().enumerate() {
            let own = of_rms(&steady.scene, &orbit, design);
            close(&format!("{case}, {design:?}"), own.value, value[i], 1e-9);
            within(&format!("{case}, {design:?}, by its own error"), own.value, value[i], 2.0 * own.error);
            assert!(own.error < 2e-10, "{:e}", own.error);
        }
    }
}

/// Impact speed 2π g/((1 + ε) ω), whatever the acceleration Γ; phase from cos φ = π (1 − ε)/((1 + ε) Γ), with dφ/dΓ = cot φ/Γ.
#[test]
fn a_ball_on_a_table_has_the_derivatives_of_its_impact_by_hand() {
    for (e, acceleration) in [(0.5_f64, 1.2), (0.3, 2.0), (0.5, 1.8)] {
        let table = Table::new(e, acceleration);
        let orbit = Orbit::near(&system(&table.scene()), &table.on_orbit(0.0), 1).expect("it is near");
        let contact = |run: &Response| {
            *run.events.iter().find(|event| event.kind == EventKind::FloorContact).expect("it meets the floor")
        };
        let speed = |run: &Response| -contact(run).approach;
        let at = |design| move |factor| Ok::<_, Infallible>(system(&table_scene(e, acceleration, design, factor)));
        let by_force = orbit.elasticity(at(Design::Force), speed).expect("it is smooth");
        within("speed by Γ", by_force.value, 0.0, 1e-10);
        let by_restitution = orbit.elasticity(at(Design::Damping), speed).expect("it is smooth");
        close("speed by ε", by_restitution.value, -e / (1.0 + e), 1e-10);
        let phase = |run: &Response| table.omega * contact(run).time;
        let by_force = orbit.elasticity(at(Design::Force), phase).expect("it is smooth");
        let own = (PI * (1.0 - e) / ((1.0 + e) * acceleration)).acos();
        let met = (own + table.lag).rem_euclid(std::f64::consts::TAU);
        close("phase by Γ", by_force.value, 1.0 / own.tan() / met, 1e-9);
    }
}

fn table_scene(e: f64, acceleration: f64, design: Design, factor: f64) -> Scene {
    Table::new(e, acceleration).scene().scaled(design, factor).expect("it has both")
}

/// One mass with a resilient damper under impulses: the scene of `settled`, where its motion is periodic.
fn under_impulses(force_ratio: f64, gravity: f64) -> Scene {
    let natural = 1000.0_f64.sqrt();
    let surface = resilient(1000.0, 0.3 * 50.0_f64.sqrt());
    let train = Excitation::ImpulseTrain { impulse: force_ratio * 2.1 * GRAVITY / natural, period: 0.199 };
    scene(base(1.0, 1000.0, 0.1 * natural), gravity, damper(0.05, 0.4905, surface), train)
}

fn settled(scene: &Scene) -> (Response, Orbit) {
    let options = Options { skip: 0, average: 5000, until: Until::Settled, final_state: true, ..Options::default() };
    let run = event_driven(&system(scene), &options).expect("it runs");
    let cycles = run.settled.expect("it settles").cycles;
    let state = run.final_state.clone().expect("it was asked for");
    let orbit = Orbit::near(&system(scene), &state, u32::try_from(cycles).expect("few")).expect("it is near");
    (run, orbit)
}

/// Twice the lengths are twice the speeds; twice the masses, springs, dashpots and forces are the same motion (Euler's theorem).
#[test]
fn elasticities_add_up_as_scales_of_length_and_force_say() {
    for force_ratio in [3.5, 10.0, 25.0] {
        let scene = under_impulses(force_ratio, GRAVITY);
        let (_, orbit) = settled(&scene);
        let of = |design| of_rms(&scene, &orbit, design).value;
        let with = |change: &dyn Fn(&mut HybridSystem, f64)| {
            let at = |factor| {
                let mut system = system(&scene);
                change(&mut system, factor);
                Ok::<_, Infallible>(system)
            };
            orbit.elasticity(at, rms).expect("it is smooth").value
        };
        let by_gravity = with(&|system, factor| system.gravity *= factor);
        within("lengths", of(Design::Gap) + of(Design::Force) + by_gravity, 1.0, 1e-9);
        let by_structure = with(&|system, factor| {
            for matrix in [&mut system.mass, &mut system.damping, &mut system.stiffness] {
                matrix.entries.iter_mut().for_each(|entry| *entry *= factor);
            }
        });
        let parts = [Design::ParticleMass, Design::Stiffness, Design::Damping, Design::Force].map(of);
        println!("f′ = {force_ratio}, {}: {parts:?}, gap {}", orbit.kind, of(Design::Gap));
        assert!(parts.iter().any(|part| part.abs() > 0.1));
        within("forces", parts.iter().sum::<f64>() + by_structure, 0.0, 1e-9);
    }
}

/// Without gravity twice the force with twice the gap is twice the motion, also next to the force at which the symmetric motion
/// becomes unstable: on both sides of its orbit the two motions into which it forks are not taken for it.
#[test]
fn elasticities_are_of_the_branch_of_their_orbit() {
    let steady = masri_and_caughey("masri-caughey-two-impacts-a", MASRI[0].1);
    let mut found = 0;
    for tenths in 80..=160 {
        let mut scene = steady.scene.clone();
        let Excitation::Harmonic { force, .. } = &mut scene.excitation else { panic!("a harmonic force") };
        *force = 0.1 * f64::from(tenths);
        let settles = Options {
            skip: 0,
            average: 3000,
            until: Until::Settled,
            start: beside(&steady),
            final_state: true,
            ..Options::default()
        };
        let run = event_driven(&system(&scene), &settles).expect("it runs");
        let (Some(settled), Some(state)) = (run.settled, run.final_state) else { continue };
        let orbit = Orbit::near(&system(&scene), &state, settled.cycles as u32).expect("it is near");
        let of = |design| {
            let scaled = |factor| Ok::<_, Infallible>(system(&scene.scaled(design, factor).expect("the scene has it")));
            orbit.elasticity(scaled, rms)
        };
        if let (Ok(gap), Ok(force)) = (of(Design::Gap), of(Design::Force)) {
            found += 1;
            let bound = 1e-9 + 2.0 * (gap.error + force.error);
            within(&format!("{:.1} N, {}", 0.1 * f64::from(tenths), orbit.kind), gap.value + force.value, 1.0, bound);
        }
    }
    assert!(found > 60, "{found} of 81");
}

/// Runs that settle at two values on both sides: their difference has an error of h² D‴/6, a hundredth at a tenth of h.
#[test]
fn elasticities_are_what_differences_of_long_runs_tend_to() {
    let scene = under_impulses(3.5, GRAVITY);
    let (_, orbit) = settled(&scene);
    for design in [Design::Gap, Design::ParticleMass, Design::Stiffness, Design::Damping, Design::Force] {
        let own = of_rms(&scene, &orbit, design).value;
        let by_runs = |by: f64| {
            let rms = [by, -by].map(|by| {
                let late = Options { skip: 3000, average: 4, ..Options::default() };
                rms(&event_driven(&system(&scene.scaled(design, by.exp()).expect("it has it")), &late)
                    .expect("it runs"))
            });
            (rms[0] / rms[1]).ln() / (2.0 * by)
        };
        let [coarse, fine] = [1e-2, 1e-3].map(by_runs);
        let error = (coarse - fine).abs() / 99.0;
        within(&format!("{design:?}"), fine, own, 1.5 * error + 1e-9);
    }
}

/// Half a cycle of a spring and a dashpot returns ε = e^(−πζ/√(1−ζ²)) in a time of √(m/k): what is left of it falls with √k. So ε
/// depends on the dashpot by d ln ε/d ln c = −πζ/(1−ζ²)^(3/2), and on the spring by −½ of that.
#[test]
fn elasticities_of_stiff_faces_tend_to_those_of_rigid_ones() {
    let steady = masri_and_caughey("masri-caughey-two-impacts-a", MASRI[0].1);
    let (given, _) = open("masri-caughey-two-impacts-a");
    let e: f64 = given.number("restitution");
    let log = e.ln();
    let ratio = -log / PI.hypot(log);
    let effective = 0.1 / 1.1;
    let value = expected("masri-caughey-elasticities-a");
    let by_dashpot = -value[2] * PI * ratio / (1.0 - ratio * ratio).powf(1.5);
    let wanted = [value[0], value[1] - 0.5 / 1.1 * by_dashpot, by_dashpot, -0.5 * by_dashpot];
    let errors = [1e7_f64, 1e9].map(|stiffness| {
        let mut stiff = steady.scene.clone();
        let surface = resilient(stiffness, 2.0 * ratio * (stiffness * effective).sqrt());
        (stiff.dampers[0].floor, stiff.dampers[0].ceiling) = (surface.clone(), surface);
        let orbit = Orbit::near(&system(&stiff), &beside(&steady), 1).expect("it is near");
        let designs = [Design::Gap, Design::ParticleMass, Design::Damping, Design::Stiffness];
        let own = designs.map(|design| of_rms(&stiff, &orbit, design).value);
        println!("{stiffness:e}: {own:?} for {wanted:?}");
        [0, 1, 2, 3].map(|i| own[i] - wanted[i])
    });
    for (soft, hard) in errors[0].into_iter().zip(errors[1]) {
        within("at 1e9 N/m", hard, 0.0, 2e-3);
        close("a hundredth of the stiffness, ten times the difference", soft / hard, 10.0, 0.1);
    }
}

#[test]
fn where_contacts_change_or_the_motion_turns_back_there_is_none() {
    // Γ next to its least value, where the branch of bounces folds.
    let e = 0.5;
    let least = PI * (1.0 - e) / (1.0 + e);
    for (above, exists) in [(1e-2, true), (1e-3, true), (1e-10, false)] {
        let table = Table::new(e, least * (1.0 + above));
        let scene = table.scene();
        let Ok(orbit) = Orbit::near(&system(&scene), &table.on_orbit(0.0), 1) else {
            assert!(!exists);
            continue;
        };
        let phase = |run: &Response| {
            run.events.iter().find(|event| event.kind == EventKind::FloorContact).expect("it meets it").time
        };
        let at = |factor| Ok::<_, Infallible>(system(&scene.scaled(Design::Force, factor).expect("a force")));
        let found = orbit.elasticity(at, phase);
        println!("{above:e}: {found:?}");
        assert_eq!(found.is_ok(), exists, "{found:?}");
        assert!(exists || matches!(found, Err(ElasticityError::Fold { .. })), "{found:?}");
    }

    // A particle on its floor, whose largest acceleration is next to gravity.
    let (mass, particle, stiffness, damping, omega): (f64, f64, f64, f64, f64) = (1.0, 0.1, 1000.0, 2.0, 25.0);
    let impedance = (stiffness - (mass + particle) * omega * omega).hypot(damping * omega);
    for (below, exists) in [(0.1, true), (1e-4, true), (1e-11, false)] {
        let force = (1.0 - below) * GRAVITY * impedance / (omega * omega);
        let drive = Excitation::Harmonic { force, angular_frequency: omega };
        let resting =
            scene(base(mass, stiffness, damping), GRAVITY, damper(particle, f64::INFINITY, rigid(0.5)), drive);
        let orbit = Orbit::near(&system(&resting), &StartState::StaticEquilibrium, 1).expect("it is linear");
        assert_eq!(orbit.contacts, 0);
        let at = |factor| Ok::<_, Infallible>(system(&resting.scaled(Design::Force, factor).expect("a force")));
        let found = orbit.elasticity(at, rms);
        println!("{below:e}: {found:?}");
        match found {
            Ok(linear) => within("of a linear motion", linear.value, 1.0, 1e-9),
            Err(ref error) => assert!(matches!(error, ElasticityError::Graze { .. }), "{error}"),
        }
        assert_eq!(found.is_ok(), exists);
    }
}

const MEASURES: [Measure; 8] = [
    Measure::VelocityRatio,
    Measure::Motion,
    Measure::GapElasticity,
    Measure::MassElasticity,
    Measure::StiffnessElasticity,
    Measure::DampingElasticity,
    Measure::ForceElasticity,
    Measure::SettledVelocityRatio,
];

fn measured(scene: &Scene, carried: f64) -> Evaluated {
    let mut bare = Scene { dampers: Vec::new(), start: None, ..scene.clone() };
    let Structure::SingleMass(SingleMass { mass, .. }) = &mut bare.structure else { panic!("one mass") };
    *mass += carried;
    let subject = Subject { scene: scene.clone(), undamped: Some(bare), comparison: None, mode: 1 };
    let settings = Settings {
        skip: 25,
        average: 100,
        until: Until::Cycles,
        round_period_to: None,
        ensemble: 8,
        named: NamedRows::Results,
        mean_of: 0,
    };
    let request = Request { measures: &MEASURES, rigour: Rigour::Result, ..Request::default() };
    evaluate(subject, SolverChoice::EventDriven, &settings, &request).expect("it runs")
}

#[test]
fn the_velocity_ratio_changes_with_its_reference() {
    let scene = under_impulses(3.5, GRAVITY);
    let (_, orbit) = settled(&scene);
    let value = |evaluated: &Evaluated, i: usize| evaluated.measured[i].value;
    let own = |design| of_rms(&scene, &orbit, design).value;
    let base = measured(&scene, 0.0);
    let designs = [Design::Gap, Design::ParticleMass, Design::Stiffness, Design::Damping];
    for (i, design) in designs.into_iter().enumerate() {
        within(&format!("{design:?}"), value(&base, 2 + i), -own(design), 1e-9);
    }
    within("force", value(&base, 6), 1.0 - own(Design::Force), 1e-9);
    assert_eq!(base.undefined(&MEASURES, Particles::One), "");

    // The particle is carried: of two such references the mean slope between them.
    let loaded = measured(&scene, 0.05);
    let psi = |mass: f64| {
        let mut scene = scene.clone();
        scene.dampers[0].particle_mass = mass;
        value(&measured(&scene, mass), 7).ln()
    };
    let by = 1e-4_f64;
    let slope = (psi(0.05 * by.exp()) - psi(0.05 * (-by).exp())) / (2.0 * by);
    within("carried mass", value(&loaded, 3), slope, 1e-6);
    assert!((value(&loaded, 3) - value(&base, 3)).abs() > 1e-3);
    assert_eq!(value(&loaded, 2), value(&base, 2));
}

#[test]
fn a_row_without_elasticities_says_why() {
    let chaotic = measured(&under_impulses(0.5, GRAVITY), 0.0);
    assert!(chaotic.measured[2..=6].iter().all(|it| it.value.is_nan()));
    assert_eq!(chaotic.motion.map(|kind| kind.to_string()).as_deref(), Some("chaotic"));
    let without: Vec<Measure> = MEASURES.into_iter().filter(|measure| *measure != Measure::Motion).collect();
    let mut unnamed = chaotic.clone();
    unnamed.measured.remove(1);
    unnamed.motion = None;
    let said = unnamed.undefined(&without, Particles::One);
    assert!(said.contains("gap_elasticity, mass_elasticity"), "{said}");
    assert!(said.contains("force_elasticity undefined: the motion does not settle"), "{said}");
    // A single particle is struck with no other.
    assert!(!said.contains("at one instant"), "{said}");
    assert!(unnamed.undefined(&without, Particles::Several).contains("or particles are struck at one instant"));

    // Rigid faces have no stiffness; without a ceiling there is no gap.
    let drive = Excitation::Harmonic { force: 3.0, angular_frequency: 25.0 };
    let open = scene(base(1.0, 1000.0, 2.0), GRAVITY, damper(0.1, f64::INFINITY, rigid(0.5)), drive);
    let evaluated = measured(&open, 0.0);
    let said = evaluated.undefined(&MEASURES, Particles::One);
    assert_eq!(said, "gap_elasticity, stiffness_elasticity undefined: the scene has no such parameter, or one of zero");
    assert!(evaluated.measured[6].value.is_finite());
}
