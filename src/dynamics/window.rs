//! One guard over one window: its polynomial with a bound on what that leaves out, and what the two prove.

use super::block::Phase;
use super::flow::Parabola;
use super::polynomial::{Coefficients, DEGREE, bernstein, divide, evaluate};
use super::series::{Series, powers};

/// How a guard starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Start {
    /// Positive.
    Apart,
    /// At zero: it was just left. The first derivative that is not zero, of this order, is positive.
    Touching {
        /// 1 to 3.
        order: usize,
        /// The first derivative where it is known to the bit, else NaN.
        slope: f64,
    },
}

/// What an enclosure proves.
pub(crate) enum Verdict {
    /// No root; the guard turns back at this distance from zero, or does not turn.
    Clear { clearance: f64 },
    /// Exactly one root: first guess of its σ, and an upper bound.
    Root { guess: f64, high: f64 },
    /// Nothing.
    Unsure,
}

/// The stretch of time of a window.
pub(crate) struct Span {
    /// Seconds from the segment's start.
    pub(crate) from: f64,
    /// Δ, s.
    pub(crate) length: f64,
    /// Powers of ρΔ.
    powers: Coefficients,
}

impl Span {
    #[inline]
    pub(crate) fn new(series: &Series, from: f64, length: f64) -> Self {
        Self { from, length, powers: powers(series.pace * length) }
    }
}

/// A guard over one window.
pub(crate) struct Window {
    /// Taylor coefficients in σ, of the guard divided by σ^order where it starts at zero.
    a: Coefficients,
    /// Their Bernstein coefficients.
    b: Coefficients,
    /// What the polynomial leaves out, with the rounding.
    remainder: f64,
    start: Start,
}

impl Window {
    #[inline]
    pub(crate) fn expand(
        series: &Series,
        shares: &[Phase],
        amplitudes: &[f64],
        parabola: Parabola,
        span: &Span,
        start: Start,
    ) -> Self {
        let mut a: Coefficients = series.expand(shares.iter().copied());
        for (a, power) in a.iter_mut().zip(&span.powers) {
            *a *= power;
        }
        let bent = parabola.p2 * span.length;
        let base = [parabola.at(span.from), parabola.rate(span.from) * span.length, bent * span.length];
        for (a, base) in a.iter_mut().zip(base) {
            *a += base;
        }
        let [_, x, ..] = span.powers;
        let (left_out, moving) = series.bounds(amplitudes, x);
        let mut remainder = left_out * (span.powers[DEGREE] * x);
        match start {
            Start::Apart => remainder += 8.0 * f64::EPSILON * (base[0].abs() + base[1].abs() + moving),
            Start::Touching { order, slope } => {
                // The start is known exactly: what rounding left in the coefficients below the first is not there.
                if order == 1 && !slope.is_nan() {
                    a[1] = slope * span.length;
                }
                match order {
                    1 => divide::<1>(&mut a),
                    2 => divide::<2>(&mut a),
                    _ => divide::<3>(&mut a),
                }
            }
        }
        let b = bernstein(&a);
        Self { a, b, remainder, start }
    }

    pub(crate) fn end(&self) -> f64 {
        self.a.iter().sum()
    }

    /// What the enclosure proves; `bend` is to bound the second derivative in σ, if that is asked for.
    #[inline]
    pub(crate) fn judge(&self, bend: impl FnOnce() -> f64) -> Verdict {
        let b = &self.b;
        let doubt = self.remainder;
        let lowest = lowest(b);
        if lowest > doubt {
            let near_miss = self.start == Start::Apart && b[1] < b[0] && b[DEGREE] > b[DEGREE - 1];
            return Verdict::Clear { clearance: if near_miss { lowest - doubt } else { f64::INFINITY } };
        }
        match self.single_crossing(bend) {
            Some(guess) => Verdict::Root { guess, high: 1.0 },
            None => self.judge_shape(),
        }
    }

    /// Descartes' rule in Bernstein form: coefficients positive, then doubtful, then negative. The guard is positive before
    /// the band where polynomial and remainder cannot be told apart, negative behind it, and falls all through it, since
    /// its slope there is more than its second derivative can turn. Gives a first guess of the root.
    #[inline]
    fn single_crossing(&self, bend: impl FnOnce() -> f64) -> Option<f64> {
        let doubt = self.remainder;
        let positive = self.b.iter().take_while(|b| **b > doubt).count();
        let doubtful = self.b[positive..].iter().take_while(|b| **b >= -doubt).count();
        let negative = &self.b[positive + doubtful..];
        if positive == 0 || negative.is_empty() || !negative.iter().all(|b| *b < -doubt) {
            return None;
        }
        let (guess, slope, step) = self.root(1.0);
        let bend = bend();
        let falls = |slope: f64| slope < 0.0 && slope * slope > 8.0 * doubt * (bend - 16.0 * slope);
        // The slope is known one Newton step away from the guess; only if that is too far is it taken at the guess.
        (falls(slope + bend * step) || falls(evaluate(&self.a, guess).1)).then_some(guess)
    }

    #[cold]
    fn judge_shape(&self) -> Verdict {
        let start = self.start;
        let b = &self.b;
        let doubt = self.remainder;
        let end = b[DEGREE];
        // |R⁽ʲ⁾| ≤ 13!/(13−j)! of R's bound; divided by up to σ³ the first derivative is below 16 R, the second below 250 R.
        let slope_doubt = 16.0 * doubt / DEGREE as f64;
        let bend_doubt = 250.0 * doubt / (DEGREE * (DEGREE - 1)) as f64;
        let (mut falls, mut concave, mut convex) = (true, true, true);
        for i in 0..DEGREE {
            falls &= b[i + 1] - b[i] < -slope_doubt;
        }
        for i in 0..DEGREE - 1 {
            let second = b[i + 2] - 2.0 * b[i + 1] + b[i];
            concave &= second < -bend_doubt;
            convex &= second > bend_doubt;
        }
        let clear = Verdict::Clear { clearance: f64::INFINITY };
        let root = |high: f64| Verdict::Root { guess: self.root(high).0, high };
        if (falls || concave) && end < -doubt {
            return root(1.0);
        }
        if concave && end > doubt && (b[0] > doubt || start == Start::Apart) {
            return clear;
        }
        if convex && start == Start::Apart {
            if b[1] - b[0] > slope_doubt {
                return clear;
            }
            if end < -doubt && b[0] > doubt {
                // Convex, positive, then negative: one root.
                return root(1.0);
            }
            let bottom = self.bottom();
            let value = self.value(bottom);
            if value > doubt {
                return Verdict::Clear { clearance: value - doubt };
            }
            if value < -doubt && b[0] > doubt {
                return root(bottom);
            }
        }
        Verdict::Unsure
    }

    /// Where a convex polynomial has its lowest point in [0, 1].
    fn bottom(&self) -> f64 {
        let slope = |x: f64| (1..=DEGREE).rev().fold(0.0, |sum, j| sum * x + j as f64 * self.a[j]);
        let (mut low, mut high) = (0.0, 1.0);
        if slope(1.0) <= 0.0 {
            return 1.0;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    fn value(&self, x: f64) -> f64 {
        self.a.iter().rev().fold(0.0, |sum, a| sum * x + a)
    }

    /// A first guess of the root below `high`: where the control polygon crosses zero, and Newton steps from there. Gives with
    /// it the slope before the last step, and that step.
    #[inline]
    fn root(&self, high: f64) -> (f64, f64, f64) {
        let (mut lower, mut upper) = (0.0, high);
        let mut x = high;
        if high == 1.0
            && let Some(i) = (0..DEGREE).find(|&i| self.b[i] > 0.0 && self.b[i + 1] <= 0.0)
        {
            x = (i as f64 + self.b[i] / (self.b[i] - self.b[i + 1])) * (1.0 / DEGREE as f64);
        }
        let mut last = (x, f64::NAN, f64::INFINITY);
        for _ in 0..60 {
            let (value, slope) = evaluate(&self.a, x);
            if value > 0.0 {
                lower = x
            } else {
                upper = x
            }
            let mut next = x - value / slope;
            if !(next > lower && next < upper) {
                next = 0.5 * (lower + upper);
            }
            let step = (next - x).abs();
            x = next;
            last = (x, slope, step);
            // Quadratic convergence: the next step would be the square of this.
            if step < 0.03 * x {
                break;
            }
        }
        last
    }

    /// A root of the polynomial divided by σ^order, from a guess that is near.
    pub(crate) fn refine(&self, guess: f64) -> f64 {
        let mut x = guess;
        for _ in 0..30 {
            let (value, slope) = evaluate(&self.a, x);
            let step = value / slope;
            x -= step;
            if !(step.abs() > 2.0 * f64::EPSILON * x.abs()) {
                break;
            }
        }
        x
    }
}

#[inline]
fn lowest(b: &Coefficients) -> f64 {
    b.iter().fold(f64::INFINITY, |low, x| if *x < low { *x } else { low })
}
