//! Dense search: every point of a grid, then finer grids around the best one.

use super::bounds::{Bounds, Spacing};
use super::search::{Found, Function, Optimiser, Score, Stopping, Wanted, minimise};

/// Points evaluated at once.
const BATCH: usize = 256;

/// How dense a search is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dense {
    /// Points along each side.
    pub points: usize,
    /// How they are spaced.
    pub spacing: Spacing,
    /// Rounds of three points a side around the best one, at half the distance each time.
    pub refine: u32,
}

/// Searches the grid.
///
/// # Errors
/// What `evaluate` fails with.
pub fn dense<E>(bounds: &Bounds, settings: Dense, evaluate: &mut Function<'_, E>) -> Result<Option<Found>, E> {
    let sides: Vec<Vec<f64>> =
        (0..bounds.size()).map(|side| bounds.along(side, settings.points, settings.spacing)).collect();
    let mut grid = Grid { sides, next: 0, asked: 0, rounds: settings.refine, best: None, whole: Vec::new() };
    grid.whole.clone_from(&grid.sides);
    minimise(&mut grid, &Stopping::default(), evaluate)
}

/// The points of a product of sides, in order, and of finer ones after it.
struct Grid {
    sides: Vec<Vec<f64>>,
    next: usize,
    asked: usize,
    rounds: u32,
    best: Option<(Vec<f64>, f64)>,
    /// All values met along each side, so that a finer grid lies between neighbours.
    whole: Vec<Vec<f64>>,
}

impl Grid {
    fn size(&self) -> usize {
        self.sides.iter().map(Vec::len).product()
    }

    fn point(&self, mut index: usize) -> Vec<f64> {
        let mut point = vec![0.0; self.sides.len()];
        for (x, side) in point.iter_mut().zip(&self.sides).rev() {
            *x = side[index % side.len()];
            index /= side.len();
        }
        point
    }

    /// The middles towards both neighbours, and the best itself.
    fn refine(&mut self) {
        let Some((best, _)) = &self.best else { return };
        self.sides = self
            .whole
            .iter_mut()
            .zip(best)
            .map(|(known, x)| {
                let below = known.iter().copied().filter(|y| y < x).fold(f64::NEG_INFINITY, f64::max);
                let above = known.iter().copied().filter(|y| y > x).fold(f64::INFINITY, f64::min);
                let middles = [below, above].into_iter().filter(|y| y.is_finite()).map(|y| f64::midpoint(*x, y));
                let side: Vec<f64> = middles.chain([*x]).collect();
                known.extend(&side);
                side
            })
            .collect();
        self.next = 0;
    }
}

impl Optimiser for Grid {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        if self.next >= self.size() && self.rounds > 0 {
            self.rounds -= 1;
            self.refine();
        }
        let from = self.next;
        self.next = (from + BATCH).min(self.size());
        self.asked = from;
        (from..self.next).map(|index| self.point(index)).collect()
    }

    fn wanted(&self) -> Wanted {
        Wanted::Least { below: self.best.as_ref().map_or(f64::INFINITY, |(_, value)| *value) }
    }

    fn tell(&mut self, scores: &[Score]) {
        for (offset, score) in scores.iter().enumerate() {
            if self.best.as_ref().is_none_or(|(_, value)| score.order() < *value) {
                self.best = Some((self.point(self.asked + offset), score.order()));
            }
        }
    }
}
