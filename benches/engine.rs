//! How fast the engine is: a run of 25 + 100 cycles of one mass with one damper, under each kind of contact and drive.

use divan::Bencher;
use shotdamp::dynamics::{HybridSystem, Options, event_driven};
use shotdamp::scene::{ContactDamping, ContactEnd, Damper, Excitation, Scene, SingleMass, Surface, compile};

fn main() {
    divan::main();
}

/// 1 kg on 1 kN/m; one particle of a twentieth of that in an enclosure of 0.49 m.
fn scene(surface: &Surface, damping_ratio: f64, excitation: Excitation) -> Scene {
    let damping = 2.0 * damping_ratio * angular_frequency();
    Scene::on_one_mass(
        SingleMass { mass: 1.0, stiffness: 1000.0, damping },
        9.81,
        vec![Damper::between(surface.clone(), 0.05, 0.4905)],
        excitation,
    )
}

fn angular_frequency() -> f64 {
    1000.0_f64.sqrt()
}

/// Impulses once a natural period on resilient faces: 490 events.
fn resilient() -> Scene {
    let surface = Surface::Resilient {
        stiffness: 1000.0,
        damping: ContactDamping::Constant(0.6 * 50.0_f64.sqrt()),
        ends: ContactEnd::ZeroGap,
    };
    let (impulse, period) = (7.0 * 9.81 / angular_frequency(), std::f64::consts::TAU / angular_frequency());
    scene(&surface, 0.05, Excitation::ImpulseTrain { impulse, period })
}

/// Bounces on rigid faces, driven in resonance.
fn rigid() -> Scene {
    let drive = Excitation::Harmonic { force: -29.43, angular_frequency: angular_frequency() };
    scene(&Surface::Rigid { restitution: 0.0 }, 0.05, drive)
}

/// Resilient faces under a harmonic force.
fn harmonic() -> Scene {
    let drive = Excitation::Harmonic { force: -29.43, angular_frequency: angular_frequency() };
    Scene { excitation: drive, ..resilient() }
}

fn compiled(scene: &Scene) -> HybridSystem {
    compile(scene).expect("the scenes above compile")
}

/// Velocities alone, as most figures need them.
fn velocities() -> Options {
    Options { displacement: false, ..Options::default() }
}

fn march(bencher: Bencher<'_, '_>, scene: &Scene) {
    let (system, options) = (compiled(scene), velocities());
    bencher.bench(|| event_driven(divan::black_box(&system), divan::black_box(&options)));
}

#[divan::bench]
fn resilient_impulses(bencher: Bencher<'_, '_>) {
    march(bencher, &resilient());
}

#[divan::bench]
fn resilient_impulses_from_the_scene(bencher: Bencher<'_, '_>) {
    let scene = resilient();
    bencher.bench(|| event_driven(&compiled(divan::black_box(&scene)), &velocities()));
}

#[divan::bench]
fn rigid_faces(bencher: Bencher<'_, '_>) {
    march(bencher, &rigid());
}

#[divan::bench]
fn resilient_harmonic(bencher: Bencher<'_, '_>) {
    march(bencher, &harmonic());
}
