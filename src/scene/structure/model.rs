//! What every structure supplies: M, C, K, and the shapes of its coordinates at a point.

use crate::dynamics::Matrix;

/// Steps along a side in which the largest value of a shape is looked for.
const STEPS: u32 = 20;
/// Of its largest value, a shape has less than this at a support, where the sums of its terms cancel to their last digits. Where it is
/// more, its own digits are left: a millionth of the length from a clamp.
const ROUNDING: f64 = 1e-11;

/// A point of a structure, m along its sides; what a structure has no side for is not looked at.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// m.
    pub x: f64,
    /// m.
    pub y: f64,
}

/// M q″ + C q′ + K q = Σ F φ(x).
#[derive(Debug, Clone, PartialEq)]
pub struct Matrices {
    /// M, kg.
    pub mass: Matrix,
    /// C, N s/m.
    pub damping: Matrix,
    /// K, N/m.
    pub stiffness: Matrix,
}

impl Matrices {
    /// Of a structure in its own modes, all of modal mass m: M = m I, K = m ω², C = λ (M + K).
    pub(super) fn modal(mass: f64, natural_frequencies: &[f64], rayleigh: f64) -> Self {
        let stiffness: Vec<f64> = natural_frequencies.iter().map(|omega| mass * omega * omega).collect();
        let damping: Vec<f64> = stiffness.iter().map(|k| rayleigh * (mass + k)).collect();
        Self {
            mass: Matrix::diagonal(&vec![mass; stiffness.len()]),
            damping: Matrix::diagonal(&damping),
            stiffness: Matrix::diagonal(&stiffness),
        }
    }
}

/// A structure in SI units.
pub trait Model {
    /// Mass of the whole, kg.
    fn total_mass(&self) -> f64;

    /// Modal mass of the first mode where its largest amplitude is one, kg.
    fn modal_mass(&self) -> f64;

    /// M, C and K without anything attached.
    fn matrices(&self) -> Matrices;

    /// w(x) = shape·q: the displacement at a point by the coordinates.
    fn shape(&self, at: Point) -> Vec<f64>;

    /// Lengths of the sides, m; none for a single mass.
    fn sides(&self) -> Vec<f64>;

    /// The structure moves there, in one of its modes at least, by more than rounding makes of nothing.
    fn moves(&self, at: Point) -> bool {
        let sides = self.sides();
        let largest = |at: Point| self.shape(at).iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let here = largest(at);
        // All shapes are of order one somewhere: only what is far below that is looked at.
        sides.is_empty() || here > 1e-6 || {
            let steps = |side: usize| if side < sides.len() { STEPS } else { 0 };
            let point = |i: u32, j: u32| {
                let along = |side: usize, i: u32| {
                    sides.get(side).map_or(0.0, |length| length * f64::from(i) / f64::from(STEPS))
                };
                Point { x: along(0, i), y: along(1, j) }
            };
            let anywhere = (0..=steps(0)).flat_map(|i| (0..=steps(1)).map(move |j| point(i, j)));
            here > ROUNDING * anywhere.map(largest).fold(0.0, f64::max)
        }
    }

    /// Natural frequencies of this model, undamped, rad/s, rising.
    fn natural_frequencies(&self) -> Vec<f64>;

    /// Shape of the coordinates of a mode of this model, from 1: with the model in its own modes, a unit vector.
    fn mode(&self, number: usize) -> Vec<f64>;

    /// Natural frequency of a mode of the continuous structure, from 1, rad/s, where it has a closed form.
    fn exact_frequency(&self, number: usize) -> Option<f64>;

    /// Displacement at a point in a mode of the continuous structure, to any scale.
    fn exact_shape(&self, number: usize, at: Point) -> Option<f64>;

    /// In words.
    fn describe(&self) -> String;
}

/// The unit vector of a mode of a model in its own modes; nothing for a mode that it lacks.
pub(super) fn unit(order: usize, number: usize) -> Vec<f64> {
    (1..=order).map(|i| f64::from(u8::from(i == number))).collect()
}
