//! A genetic algorithm over a box.
//!
//! It has the parts of the usual library functions: a random first population; parents drawn by rank with weights 1/√rank, so that better points are likelier and no point is
//! out; scattered crossover (each coordinate from either parent); mutation; and elites, which live on unchanged. Steps of a
//! mutation are drawn from all magnitudes at once, range·2^(−16u), as in the breeder genetic algorithm of Mühlenbein and
//! Schlierkamp-Voosen (1993): it needs no schedule, goes on to leave local optima, and still polishes.

use super::bounds::Bounds;
use super::random::Stream;
use super::search::{Optimiser, Score};

/// Smallest step of a mutation is 2^-16 of the range.
const OCTAVES: f64 = 16.0;

/// Settings of a [`Genetic`] algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeneticSettings {
    /// Individuals of a generation, elites among them.
    pub population: usize,
    /// Individuals that live on; fewer than the population.
    pub elites: usize,
    /// Share of the children that are made by crossover, the others by mutation.
    pub crossover: f64,
}

/// The algorithm, between two generations.
#[derive(Debug, Clone)]
pub struct Genetic {
    bounds: Bounds,
    settings: GeneticSettings,
    seed: u64,
    generation: u64,
    /// Points that the first population begins with.
    start: Vec<Vec<f64>>,
    /// The generation that was told, best first; points as shares of the sides.
    parents: Vec<(Vec<f64>, f64)>,
    asked: Vec<Vec<f64>>,
}

impl Genetic {
    /// At its beginning; `start` are points that the first population shall hold, before the random ones.
    #[must_use]
    pub fn new(bounds: Bounds, settings: GeneticSettings, seed: u64, start: &[Vec<f64>]) -> Self {
        let population = settings.population.max(2);
        let settings = GeneticSettings { population, elites: settings.elites.min(population - 1), ..settings };
        let start = start.iter().take(population).map(|point| bounds.shares(point)).collect();
        Self { bounds, settings, seed, generation: 0, start, parents: Vec::new(), asked: Vec::new() }
    }

    fn first(&self, individual: usize) -> Vec<f64> {
        let mut stream = Stream::of(self.seed, &[0, individual as u64]);
        let random = (0..self.bounds.size()).map(|_| stream.uniform()).collect();
        self.start.get(individual).cloned().unwrap_or(random)
    }

    fn child(&self, individual: usize) -> Vec<f64> {
        let mut stream = Stream::of(self.seed, &[self.generation, individual as u64]);
        let children = self.settings.population - self.settings.elites;
        let crossed = (self.settings.crossover * children as f64).round() as usize;
        let one = self.parent(&mut stream);
        if individual >= crossed {
            return mutant(one, &mut stream);
        }
        let other = self.parent(&mut stream);
        let child: Vec<f64> = one.iter().zip(other).map(|(a, b)| if stream.coin() { *a } else { *b }).collect();
        // A copy of a parent would be an evaluation that tells nothing.
        if child == *one || child == *other { mutant(&child, &mut stream) } else { child }
    }

    /// Drawn by rank.
    fn parent(&self, stream: &mut Stream) -> &[f64] {
        let weight = |rank: usize| 1.0 / ((rank + 1) as f64).sqrt();
        let whole: f64 = (0..self.parents.len()).map(weight).sum();
        let mut left = stream.uniform() * whole;
        for (rank, (point, _)) in self.parents.iter().enumerate() {
            left -= weight(rank);
            if left < 0.0 || rank + 1 == self.parents.len() {
                return point;
            }
        }
        &[]
    }
}

/// Each coordinate moves with a chance of one in their number, one at least; a step beyond a bound ends there.
fn mutant(parent: &[f64], stream: &mut Stream) -> Vec<f64> {
    let mut child = parent.to_vec();
    let certain = stream.below(child.len());
    let chance = 1.0 / child.len() as f64;
    for (coordinate, x) in child.iter_mut().enumerate() {
        let moves = stream.uniform() < chance || coordinate == certain;
        let step = libm::exp2(-OCTAVES * stream.uniform());
        let upwards = stream.coin();
        if moves {
            *x = (*x + if upwards { step } else { -step }).clamp(0.0, 1.0);
        }
    }
    child
}

impl Optimiser for Genetic {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        self.asked = if self.generation == 0 {
            (0..self.settings.population).map(|individual| self.first(individual)).collect()
        } else {
            (0..self.settings.population - self.settings.elites).map(|individual| self.child(individual)).collect()
        };
        self.asked.iter().map(|shares| self.bounds.at(shares)).collect()
    }

    fn tell(&mut self, scores: &[Score]) {
        self.parents.truncate(self.settings.elites);
        self.parents.extend(self.asked.drain(..).zip(scores.iter().map(|score| score.order())));
        // Stable: of equal values the elder stays in front.
        self.parents.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        self.generation += 1;
    }
}
