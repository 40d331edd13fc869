//! One scene, run so many times, for `benches/instructions.py` to count its instructions: effects that a scene does not name must
//! not cost any.
//!
//! `instructions SCENE RUNS`; scenes are those of `SCENES`.

use shotdamp::dynamics::{Options, event_driven};
use shotdamp::scene::{
    ContactDamping, ContactEnd, Damper, Excitation, LimitStop, Scene, SingleMass, Surface, Walls, compile,
};

/// Nothing but a resilient damper under impulses; the same with one effect named that cannot do anything; the same with it
/// at work. The same with its motion named; and chaotic, without and with its name.
const SCENES: [&str; 9] = [
    "plain",
    "idle_stop",
    "stop",
    "no_tension",
    "stiff_walls",
    "equivalent_damping",
    "motion",
    "chaotic",
    "chaotic_motion",
];

fn scene(name: &str) -> Scene {
    let damping = 0.6 * 50.0_f64.sqrt();
    let surface =
        Surface::Resilient { stiffness: 1000.0, damping: ContactDamping::Constant(damping), ends: ContactEnd::ZeroGap };
    let mut damper = Damper::between(surface, 0.05, 0.4905);
    let with = |damper: &mut Damper, change: &dyn Fn(&mut Surface)| {
        change(&mut damper.floor);
        change(&mut damper.ceiling);
    };
    match name {
        "idle_stop" => damper.stop = Some(LimitStop { length: 10.0, restitution: 0.0 }),
        "stop" => damper.stop = Some(LimitStop { length: 0.02, restitution: 0.0 }),
        "no_tension" => with(&mut damper, &|surface| {
            if let Surface::Resilient { ends, .. } = surface {
                *ends = ContactEnd::ZeroForce;
            }
        }),
        "stiff_walls" => damper.walls = Some(Walls { stiffness: 1e6, damping: 50.0, ceiling_mass: 0.05 }),
        "equivalent_damping" => with(&mut damper, &|surface| {
            if let Surface::Resilient { damping: law, .. } = surface {
                *law = ContactDamping::EquivalentViscous(vec![[0.5, damping], [5.0, damping]]);
            }
        }),
        _ => {}
    }
    let natural = 1000.0_f64.sqrt();
    let force_ratio = if name.starts_with("chaotic") { 1.0 } else { 7.0 };
    let (impulse, period) = (force_ratio * 9.81 / natural, 0.199);
    let base = SingleMass { mass: 1.0, stiffness: 1000.0, damping: 0.1 * natural };
    Scene::on_one_mass(base, 9.81, vec![damper], Excitation::ImpulseTrain { impulse, period })
}

fn main() {
    let arguments: Vec<String> = std::env::args().filter(|argument| argument != "--bench").collect();
    let (Some(name), Some(runs)) = (arguments.get(1), arguments.get(2).and_then(|runs| runs.parse::<u32>().ok()))
    else {
        println!("{}", SCENES.join("\n"));
        return;
    };
    assert!(SCENES.contains(&name.as_str()), "no scene `{name}`");
    let system = compile(&scene(name)).expect("the scenes above compile");
    let options = Options { displacement: false, motion: name.ends_with("motion"), ..Options::default() };
    let mut events = 0;
    for _ in 0..runs {
        events = event_driven(std::hint::black_box(&system), &options).expect("the scenes above run").proof.events;
    }
    println!("{events}");
}
