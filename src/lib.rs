//! Exact simulation of particle impact dampers, and the reproduction of published studies of them.
//!
//! A particle impact damper is a loose mass in an enclosure on a vibrating structure. Between two contacts the motion is
//! linear, so it is known exactly; all that has to be found is the next contact. This crate finds it by bounds that
//! exclude any earlier one, and so steps over none.
//!
//! ```
//! use shotdamp::dynamics::{Options, event_driven};
//! use shotdamp::scene::{ContactDamping, ContactEnd, Damper, Excitation, Scene, SingleMass, Surface, compile};
//!
//! // 1 kg on 1000 N/m with 5 % of critical damping, an impulse of 2 N s in every natural period.
//! let frequency = 1000_f64.sqrt();
//! let mass = SingleMass { mass: 1.0, stiffness: 1000.0, damping: 2.0 * 0.05 * frequency };
//! let impulses = Excitation::ImpulseTrain { impulse: 2.0, period: std::f64::consts::TAU / frequency };
//!
//! // A particle of 50 g between two springs with dashpots, 0.49 m apart.
//! let damping = ContactDamping::Constant(4.2);
//! let face = Surface::Resilient { stiffness: 1000.0, damping, ends: ContactEnd::ZeroGap };
//! let damper = Damper::between(face, 0.05, 0.49);
//!
//! let rms_velocity = |dampers| -> Result<f64, Box<dyn std::error::Error>> {
//!     let scene = Scene::on_one_mass(mass, 9.81, dampers, impulses.clone());
//!     let response = event_driven(&compile(&scene)?, &Options::default())?;
//!     Ok(response.window().rms_velocity())
//! };
//! let velocity_ratio = rms_velocity(Vec::new())? / rms_velocity(vec![damper])?;
//! assert!(velocity_ratio > 2.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! In the order of use:
//!
//! 1. [`scene`]: structures, dampers and excitations in SI units; [`scene::compile`] makes a [`dynamics::HybridSystem`] that
//!    carries only the effects that the scene names.
//! 2. [`dynamics`]: the engine, exactly from certified event to certified event, or with a fixed step.
//! 3. [`measure`]: the numbers that studies plot, from responses.
//! 4. [`optimise`]: searches for the best of any function over a box.
//!
//! A periodic motion, stable or not, is an [`dynamics::Orbit`], and is followed in a parameter:
//!
//! ```
//! use shotdamp::dynamics::{Along, Branch, Options, Orbit, Special};
//! use shotdamp::scene::{ContactDamping, ContactEnd, Damper, Excitation, Scene, SingleMass, Surface, compile};
//!
//! // A particle of 50 g between two springs with dashpots, under an impulse in every natural period of the mass.
//! let frequency = 1000_f64.sqrt();
//! let damped = |impulse: f64| {
//!     let mass = SingleMass { mass: 1.0, stiffness: 1000.0, damping: 0.1 * frequency };
//!     let damping = ContactDamping::Constant(4.2);
//!     let face = Surface::Resilient { stiffness: 1000.0, damping, ends: ContactEnd::ZeroGap };
//!     let impulses = Excitation::ImpulseTrain { impulse, period: std::f64::consts::TAU / frequency };
//!     compile(&Scene::on_one_mass(mass, 9.81, vec![Damper::between(face, 0.05, 0.49)], impulses))
//! };
//! let orbit = Orbit::after(&damped(2.0)?, &Options::default())?;
//! assert_eq!((orbit.cycles, orbit.contacts, orbit.is_stable()), (1, 2, true));
//!
//! // Under stronger impulses its period doubles; the motion with two contacts a cycle goes on, but no longer attracts.
//! let along = Along { from: 2.0, to: 3.0, step: 0.02, points: 500 };
//! let branch = Branch::follow(damped, &orbit, 2.0, along)?;
//! let doubles = branch.points.iter().position(|point| point.special == Some(Special::PeriodDoubling));
//! assert!(doubles.is_some_and(|at| !branch.points[at + 1].orbit.is_stable()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! With the default feature `pipeline` also what the command is made of, which reproduces a whole study from YAML. A table on
//! disk is all that verdicts, figures and reports read.
//!
#![cfg_attr(
    feature = "pipeline",
    doc = "
5. [`experiment`] reads YAML into validated experiments: units resolved, every mistake reported with line and column ([`yaml`]).
6. [`study`] plans, runs in parallel and stores one [`table::Table`] per experiment.
7. [`mod@reference`] holds each published number and claim and gives its verdict; [`figure`] draws; [`report`] writes.
8. [`accuracy`] measures error against time; [`calibrate`] searches sets of assumptions.
"
)]
//!
//! `ARCHITECTURE.md` in the repository shows the rooms and which may use which.

#![deny(missing_docs)]

pub use dynamics;
pub mod measure;
pub mod optimise;
pub mod scene;
pub mod text;

#[cfg(feature = "pipeline")]
pub mod accuracy;
#[cfg(feature = "pipeline")]
pub mod atomic;
#[cfg(feature = "pipeline")]
pub mod calibrate;
#[cfg(feature = "pipeline")]
pub mod cli;
#[cfg(feature = "pipeline")]
pub mod experiment;
#[cfg(feature = "pipeline")]
pub mod figure;
#[cfg(feature = "pipeline")]
pub mod reference;
#[cfg(feature = "pipeline")]
pub mod report;
#[cfg(feature = "pipeline")]
pub mod study;
#[cfg(feature = "pipeline")]
pub mod table;
#[cfg(feature = "pipeline")]
pub mod yaml;
