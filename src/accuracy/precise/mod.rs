//! The same model, solved by other means and to twice as many digits: a reference for what accuracy costs.
//!
//! Arithmetic of some 32 digits (pairs of doubles), a Taylor series of the absolute coordinates in the place of the engine's
//! modes, events by sampling that series in the place of certificates. It shares nothing with the engine but the system that
//! it solves, so that an agreement of both is no accident; it is slow, and made for that alone.
//!
//! It knows resilient faces with constant dashpots, plastic rigid faces, limit stops, walls, pulses and harmonic forces. The
//! rest it refuses by name.

mod contact;
mod double;
mod matrix;
mod power;
mod root;
mod run;
mod series;

pub use run::{PreciseError, precise};
