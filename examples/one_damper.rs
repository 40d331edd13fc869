//! One mass with one particle impact damper under an impulse every natural period, straight from the library: no YAML, no
//! files. The velocity ratio tells how much slower the mass moves with the damper.
//!
//! `cargo run --example one_damper`

use shotdamp::dynamics::{Options, Response, event_driven};
use shotdamp::scene::{ContactDamping, ContactEnd, Damper, Excitation, Scene, SingleMass, Surface, compile};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    println!("{}", describe()?);
    Ok(())
}

/// What comes out, in words.
pub fn describe() -> Result<String, Failure> {
    let frequency = 1000_f64.sqrt(); // √(k/m) of 1 kg on 1000 N/m, rad/s
    let mass = SingleMass { mass: 1.0, stiffness: 1000.0, damping: 2.0 * 0.05 * frequency };
    // 2 N s, once in the time of a free oscillation.
    let impulses = Excitation::ImpulseTrain { impulse: 2.0, period: std::f64::consts::TAU / frequency };
    let face = Surface::Resilient {
        stiffness: 1000.0,
        damping: ContactDamping::Constant(4.2), // N s/m
        ends: ContactEnd::ZeroGap,
    };
    let damper = Damper::between(face, 0.05, 0.49); // 50 g with 0.49 m to move in
    let with = run(&Scene::on_one_mass(mass, 9.81, vec![damper], impulses.clone()))?;
    let without = run(&Scene::on_one_mass(mass, 9.81, Vec::new(), impulses))?;
    let [slow, fast] = [&with, &without].map(|response| response.window().rms_velocity());
    let contacts = with.counts.floor_contacts + with.counts.ceiling_contacts;
    Ok(format!(
        "{slow:.4} m/s with the damper, {fast:.4} m/s without: velocity ratio {:.3}\n\
         {contacts} contacts; the order of events is certain by {:.1e} m",
        fast / slow,
        with.proof.smallest_margin
    ))
}

/// From static equilibrium, 25 cycles skipped and 100 averaged.
fn run(scene: &Scene) -> Result<Response, Failure> {
    Ok(event_driven(&compile(scene)?, &Options::default())?)
}
