//! The covariance matrix adaptation evolution strategy (CMA-ES), after Hansen's tutorial (arXiv 1604.00772), with its
//! default settings and positive weights.
//!
//! It works in shares of the sides. Points beyond a bound are evaluated at the bound and pay for their distance, scaled by
//! the spread of the values. When it has converged it begins again elsewhere with twice as many individuals (Auger and
//! Hansen, 2005), so that it makes use of any budget.

use super::bounds::Bounds;
use super::eigen;
use super::random::Stream;
use super::search::{Optimiser, Score};

/// First standard deviation, as a share of the sides.
const FIRST_STEP: f64 = 0.3;
/// A largest deviation below this, as a share of the sides, is convergence.
const CONVERGED: f64 = 1e-9;
/// As is a spread of values below this, relative to them.
const FLAT: f64 = 1e-13;
/// Conditions of the covariance beyond this end a start.
const WORST_CONDITION: f64 = 1e14;
/// A step beyond this, in sides of the box, has lost its way.
const WIDEST: f64 = 1e3;
/// Most doublings of the population.
const DOUBLINGS: u32 = 9;

/// The strategy, between two generations.
#[derive(Debug, Clone)]
pub struct CmaEs {
    bounds: Bounds,
    seed: u64,
    first: Option<usize>,
    restarts: u32,
    run: Run,
}

/// One start of it.
#[derive(Debug, Clone)]
struct Run {
    population: usize,
    constants: Constants,
    generation: u64,
    mean: Vec<f64>,
    step: f64,
    covariance: Vec<f64>,
    /// Square roots of the eigenvalues, and the eigenvectors.
    axes: Vec<f64>,
    vectors: Vec<f64>,
    path_step: Vec<f64>,
    path_covariance: Vec<f64>,
    asked: Vec<Vec<f64>>,
    /// Interquartile ranges of the values of late generations.
    spreads: Vec<f64>,
    /// Best values of late generations.
    bests: Vec<f64>,
}

#[derive(Debug, Clone)]
struct Constants {
    weights: Vec<f64>,
    effective: f64,
    c_step: f64,
    d_step: f64,
    c_path: f64,
    c_one: f64,
    c_mu: f64,
    /// Expected length of a normal vector.
    length: f64,
}

impl Constants {
    fn new(n: usize, population: usize) -> Self {
        let size = n as f64;
        let half = population as f64 / 2.0;
        let raw: Vec<f64> = (1..=population / 2).map(|i| libm::log(half + 0.5) - libm::log(i as f64)).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
        let effective = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let c_step = (effective + 2.0) / (size + effective + 5.0);
        let d_step = 1.0 + 2.0 * (((effective - 1.0) / (size + 1.0)).sqrt() - 1.0).max(0.0) + c_step;
        let c_path = (4.0 + effective / size) / (size + 4.0 + 2.0 * effective / size);
        let c_one = 2.0 / ((size + 1.3) * (size + 1.3) + effective);
        let c_mu = 2.0 * (effective - 2.0 + 1.0 / effective) / ((size + 2.0) * (size + 2.0) + effective);
        let length = size.sqrt() * (1.0 - 1.0 / (4.0 * size) + 1.0 / (21.0 * size * size));
        Self { weights, effective, c_step, d_step, c_path, c_one, c_mu: c_mu.clamp(0.0, 1.0 - c_one), length }
    }
}

impl CmaEs {
    /// At its beginning, in the middle of the box; `population` of its first start, 4 + 3 ln n if absent.
    #[must_use]
    pub fn new(bounds: Bounds, population: Option<usize>, seed: u64) -> Self {
        let n = bounds.size();
        let run = Run::new(n, population.unwrap_or_else(|| usual(n)), vec![0.5; n]);
        Self { bounds, seed, first: population, restarts: 0, run }
    }

    fn restart(&mut self) {
        self.restarts += 1;
        let n = self.bounds.size();
        let population = self.first.unwrap_or_else(|| usual(n)) << self.restarts.min(DOUBLINGS);
        // A place that no individual has.
        let mut stream = Stream::of(self.seed, &[u64::from(self.restarts), u64::MAX, u64::MAX]);
        self.run = Run::new(n, population, (0..n).map(|_| stream.uniform()).collect());
    }
}

/// 4 + 3 ln n.
fn usual(n: usize) -> usize {
    4 + (3.0 * libm::log(n as f64)) as usize
}

impl Optimiser for CmaEs {
    fn ask(&mut self) -> Vec<Vec<f64>> {
        let (run, n) = (&mut self.run, self.bounds.size());
        let place = |k: usize| [u64::from(self.restarts), run.generation, k as u64];
        run.asked = (0..run.population)
            .map(|k| {
                let mut stream = Stream::of(self.seed, &place(k));
                let z: Vec<f64> = (0..n).map(|i| run.axes[i] * stream.normal()).collect();
                (0..n)
                    .map(|i| {
                        let turned: f64 = (0..n).map(|j| run.vectors[i * n + j] * z[j]).sum();
                        run.mean[i] + run.step * turned
                    })
                    .collect()
            })
            .collect();
        run.asked.iter().map(|shares| self.bounds.at(shares)).collect()
    }

    fn tell(&mut self, scores: &[Score]) {
        self.run.learn(scores);
        if self.run.is_over() {
            self.restart();
        }
    }
}

impl Run {
    fn new(n: usize, population: usize, mean: Vec<f64>) -> Self {
        let population = population.max(4);
        let unit = |i: usize| if i / n == i % n { 1.0 } else { 0.0 };
        let identity: Vec<f64> = (0..n * n).map(unit).collect();
        Self {
            population,
            constants: Constants::new(n, population),
            generation: 0,
            mean,
            step: FIRST_STEP,
            covariance: identity.clone(),
            axes: vec![1.0; n],
            vectors: identity,
            path_step: vec![0.0; n],
            path_covariance: vec![0.0; n],
            asked: Vec::new(),
            spreads: Vec::new(),
            bests: Vec::new(),
        }
    }

    /// The individuals in the order of their worth, what they pay for lying outside included.
    fn ranked(&mut self, scores: &[Score]) -> Vec<Vec<f64>> {
        let mut values: Vec<f64> = scores.iter().map(|score| score.order()).collect();
        values.sort_by(f64::total_cmp);
        let spread = values[3 * values.len() / 4] - values[values.len() / 4];
        if spread.is_finite() && spread > 0.0 {
            self.spreads.push(spread);
        }
        let late = 20 + 3 * self.mean.len();
        self.spreads.drain(..self.spreads.len().saturating_sub(late));
        let mut sorted = self.spreads.clone();
        sorted.sort_by(f64::total_cmp);
        let typical = sorted.get(sorted.len() / 2).copied().unwrap_or(1.0);
        let n = self.mean.len();
        let variance = (0..n).map(|i| self.covariance[i * n + i]).sum::<f64>() / n as f64 * self.step * self.step;
        let price = 2.0 * typical / variance.max(f64::MIN_POSITIVE);
        let mut ranked: Vec<(f64, Vec<f64>)> = self
            .asked
            .drain(..)
            .zip(scores)
            .map(|(x, score)| {
                let outside: f64 = x.iter().map(|x| (x - x.clamp(0.0, 1.0)) * (x - x.clamp(0.0, 1.0))).sum();
                (score.order() + price * outside, x)
            })
            .collect();
        ranked.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        self.bests.push(values[0]);
        ranked.into_iter().map(|(_, x)| x).collect()
    }

    fn learn(&mut self, scores: &[Score]) {
        let ranked = self.ranked(scores);
        let Constants { weights, effective, c_step, d_step, c_path, c_one, c_mu, length } = self.constants.clone();
        let n = self.mean.len();
        self.generation += 1;
        let steps: Vec<Vec<f64>> = ranked[..weights.len()]
            .iter()
            .map(|x| x.iter().zip(&self.mean).map(|(x, mean)| (x - mean) / self.step).collect())
            .collect();
        let mean_step: Vec<f64> =
            (0..n).map(|i| weights.iter().zip(&steps).map(|(weight, step)| weight * step[i]).sum()).collect();
        self.mean.iter_mut().zip(&mean_step).for_each(|(mean, step)| *mean += self.step * step);

        // C^(-1/2) of the mean step, by the eigenvectors.
        let along: Vec<f64> = (0..n)
            .map(|k| (0..n).map(|i| self.vectors[i * n + k] * mean_step[i]).sum::<f64>() / self.axes[k])
            .collect();
        let gain = (c_step * (2.0 - c_step) * effective).sqrt();
        for i in 0..n {
            let whitened: f64 = (0..n).map(|k| self.vectors[i * n + k] * along[k]).sum();
            self.path_step[i] = (1.0 - c_step) * self.path_step[i] + gain * whitened;
        }
        let norm = self.path_step.iter().map(|x| x * x).sum::<f64>().sqrt();
        let faded = libm::pow(1.0 - c_step, 2.0 * self.generation as f64);
        let calm = norm / (1.0 - faded).sqrt() < (1.4 + 2.0 / (n as f64 + 1.0)) * length;
        let gain = (c_path * (2.0 - c_path) * effective).sqrt();
        for (path, step) in self.path_covariance.iter_mut().zip(&mean_step) {
            *path = (1.0 - c_path) * *path + if calm { gain * step } else { 0.0 };
        }
        let lost = if calm { 0.0 } else { c_path * (2.0 - c_path) };
        for i in 0..n {
            for j in 0..n {
                let rank_mu: f64 = weights.iter().zip(&steps).map(|(w, step)| w * step[i] * step[j]).sum();
                let rank_one = self.path_covariance[i] * self.path_covariance[j];
                let old = self.covariance[i * n + j];
                self.covariance[i * n + j] =
                    (1.0 - c_one - c_mu + c_one * lost) * old + c_one * rank_one + c_mu * rank_mu;
            }
        }
        self.step *= libm::exp((c_step / d_step) * (norm / length - 1.0));
        let (values, vectors) = eigen::symmetric(&self.covariance, n);
        self.axes = values.iter().map(|value| value.max(f64::MIN_POSITIVE).sqrt()).collect();
        self.vectors = vectors;
    }

    /// Converged, flat or degenerate.
    fn is_over(&self) -> bool {
        let widest = self.axes.iter().copied().fold(0.0, f64::max);
        let narrowest = self.axes.iter().copied().fold(f64::INFINITY, f64::min);
        let late = 10 + 30 * self.mean.len() / self.population;
        let last = &self.bests[self.bests.len().saturating_sub(late)..];
        let (low, high) = last.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
        let flat = last.len() == late && high - low <= FLAT * low.abs().max(f64::MIN_POSITIVE);
        let condition = (widest / narrowest) * (widest / narrowest);
        flat || self.step * widest < CONVERGED
            || condition.is_nan()
            || condition > WORST_CONDITION
            || self.step > WIDEST
    }
}
