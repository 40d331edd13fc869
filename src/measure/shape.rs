//! Shapes over a structure: normal modes, and the deflection under the excitation.
//!
//! A deflection shape is what of the motion goes with the first observed point: ⟨w(x) w₀⟩/√⟨w₀²⟩ about the mean, averaged over the
//! window. It comes from the integrals of q_i and of q_i + q_j, so that no point of the shape is simulated on its own.

use super::TraceColumn;
use super::kept::{DEFLECTION, MODE, SIDES};
use crate::dynamics::{HybridSystem, Observed, Response, dot};
use crate::measure::ShapeSpec;
use crate::scene::{CompileError, Model, Point, Scene};

/// A shape with its columns.
pub(super) struct Shape {
    pub(super) columns: Vec<TraceColumn>,
    /// Against the shape that it is compared with.
    pub(super) mac: f64,
}

/// The points of a shape: shares of the sides, and places.
struct Grid {
    shares: Vec<Vec<f64>>,
    points: Vec<Point>,
}

impl Grid {
    fn of(model: &dyn Model, spec: &ShapeSpec) -> Self {
        let sides = model.sides();
        let counts: Vec<u32> =
            (0..sides.len()).map(|i| spec.points.get(i).or(spec.points.first()).copied().unwrap_or(2)).collect();
        let share = |i: u32, count: u32| f64::from(i) / f64::from(count.max(2) - 1);
        let along = |side: usize| counts.get(side).copied().unwrap_or(1);
        let mut grid = Self { shares: vec![Vec::new(); sides.len()], points: Vec::new() };
        for j in 0..along(1) {
            for i in 0..along(0) {
                let shares = [share(i, along(0)), share(j, along(1))];
                for (list, share) in grid.shares.iter_mut().zip(shares) {
                    list.push(share);
                }
                let length = |side: usize| sides.get(side).map_or(0.0, |length| length * shares[side]);
                grid.points.push(Point { x: length(0), y: length(1) });
            }
        }
        grid
    }

    fn columns(&self) -> Vec<TraceColumn> {
        SIDES.into_iter().zip(&self.shares).map(|(name, shares)| TraceColumn::new(name, "", shares.clone())).collect()
    }
}

fn named<const N: usize>(names: [(&'static str, &'static str); N], lists: [Vec<f64>; N]) -> [TraceColumn; N] {
    let mut lists = lists.into_iter();
    names.map(|(name, unit)| TraceColumn::new(name, unit, lists.next().unwrap_or_default()))
}

/// The shape of a normal mode of the scene, beside that of the continuous structure.
pub(super) fn of_mode(scene: &Scene, spec: &ShapeSpec, number: usize) -> Result<Shape, CompileError> {
    let model = scene.structure.model();
    let grid = Grid::of(model, spec);
    let modes = scene.normal_modes()?;
    let mut shape = match modes.get(number.wrapping_sub(1)) {
        // Coordinates of particles stand behind those of the structure.
        Some(mode) => grid.points.iter().map(|point| dot(&model.shape(*point), &mode.shape)).collect(),
        None => vec![f64::NAN; grid.points.len()],
    };
    scale(&mut shape, 0.0);
    let exact = |point: &Point| model.exact_shape(number, *point).unwrap_or(f64::NAN);
    let mut exact: Vec<f64> = grid.points.iter().map(exact).collect();
    scale(&mut exact, 0.0);
    align(&mut exact, &shape);
    let mac = mac(&shape, &exact);
    let mut columns = grid.columns();
    columns.extend(named(MODE, [shape, exact]));
    Ok(Shape { columns, mac })
}

/// Lets the products of the coordinates be observed behind the points of the scene.
pub(super) fn watch_products(system: &mut HybridSystem) {
    let order = system.mass.order;
    for i in 0..order {
        for j in i..order {
            let row = (0..order).map(|k| f64::from(u8::from(k == i || k == j))).collect();
            system.observed_rows.push(row);
        }
    }
}

/// The deflection shape of a response in which [`watch_products`] has been observed.
pub(super) fn of_deflection(scene: &Scene, response: &Response, spec: &ShapeSpec, number: usize) -> Shape {
    let model = scene.structure.model();
    let grid = Grid::of(model, spec);
    let covariance = Covariance::of(&response.observed[scene.observed.points.len()..]);
    let rows: Vec<Vec<f64>> = grid.points.iter().map(|point| model.shape(*point)).collect();
    let reference = model.shape(scene.observed.points[0]);
    let towards = covariance.times(&reference);
    let mut shape: Vec<f64> = rows.iter().map(|row| dot(row, &towards)).collect();
    scale(&mut shape, dot(&reference, &towards));
    let rms = rows.iter().map(|row| dot(row, &covariance.times(row)).max(0.0).sqrt()).collect();
    let coordinates = model.mode(number);
    let mut mode: Vec<f64> = rows.iter().map(|row| dot(row, &coordinates)).collect();
    scale(&mut mode, 0.0);
    align(&mut mode, &shape);
    let mac = mac(&shape, &mode);
    let mut columns = grid.columns();
    columns.extend(named(DEFLECTION, [shape, rms, mode]));
    Shape { columns, mac }
}

/// Covariances of the coordinates over the averaged window.
struct Covariance {
    order: usize,
    entries: Vec<f64>,
}

impl Covariance {
    /// From the variances of q_i and of q_i + q_j, in the order of [`watch_products`].
    fn of(products: &[Observed]) -> Self {
        let variance: Vec<f64> = products
            .iter()
            .map(|observed| {
                let deviation = observed.window().std_displacement();
                deviation * deviation
            })
            .collect();
        let order = (0..).take_while(|n| n * (n + 1) / 2 <= variance.len()).last().unwrap_or(0);
        let place = |i: usize, j: usize| i * order - i * (i + 1) / 2 + j;
        let mut entries = vec![0.0; order * order];
        for i in 0..order {
            for j in i..order {
                let entry = if i == j {
                    variance[place(i, i)]
                } else {
                    0.5 * (variance[place(i, j)] - variance[place(i, i)] - variance[place(j, j)])
                };
                entries[i * order + j] = entry;
                entries[j * order + i] = entry;
            }
        }
        Self { order, entries }
    }

    fn times(&self, x: &[f64]) -> Vec<f64> {
        self.entries.chunks_exact(self.order.max(1)).map(|row| dot(row, x)).collect()
    }
}

/// Largest modulus 1; the sign is that of `leading`, or else such that the largest is positive.
fn scale(shape: &mut [f64], leading: f64) {
    let largest =
        shape.iter().fold(0.0_f64, |largest, x| if x.abs() > largest.abs() * (1.0 + 1e-9) { *x } else { largest });
    let factor = if leading > 0.0 { 1.0 / largest.abs() } else { 1.0 / largest };
    if factor.is_finite() {
        shape.iter_mut().for_each(|x| *x *= factor);
    }
}

/// Turns a shape so that it points the way of another.
fn align(shape: &mut [f64], other: &[f64]) {
    if dot(shape, other) < 0.0 {
        shape.iter_mut().for_each(|x| *x = -*x);
    }
}

/// Modal assurance criterion.
fn mac(a: &[f64], b: &[f64]) -> f64 {
    let cross = dot(a, b);
    cross * cross / (dot(a, a) * dot(b, b))
}
