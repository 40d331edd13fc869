//! One guard over one window: its polynomial with a bound on what that leaves out, and what the two prove.

use crate::arithmetic::four::Four;
use crate::flow::parabola::Parabola;
use crate::flow::series::{Bounds, Series, Shares, Span};
use crate::search::polynomial::{
    Coefficients, DEGREE, Signs, THREE_DIGITS, bernstein, come_first, cut, evaluate, may_turn, rises_then_falls, root,
};

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

/// Halvings of a window that a smallest value is looked for in.
const HALVINGS: u32 = 24;

/// What an enclosure proves.
pub(crate) enum Verdict {
    /// No root.
    Clear,
    /// Exactly one root: first guess of its σ, and an upper bound.
    Root { guess: f64, high: f64 },
    /// No root before this σ: there the blocks that were left out might make one.
    Until { sigma: f64 },
    /// Nothing.
    Unsure,
}

/// A place at which a guard turns back on its way to zero.
pub(crate) struct NearMiss {
    /// A lower bound on how far it is from zero there.
    pub(crate) clearance: f64,
    /// That is known to two hundredths, or as nearly as rounding lets it be.
    pub(crate) is_sharp: bool,
}

/// A guard over one window.
pub(crate) struct Window {
    /// Taylor coefficients in σ, of the guard divided by σ^order where it starts at zero.
    a: Coefficients,
    /// Their Bernstein coefficients.
    b: Coefficients,
    /// What the polynomial leaves out.
    left_out: f64,
    /// The same with the rounding.
    remainder: f64,
    /// Whole blocks are part of that: it may turn as fast as they do.
    leaves_blocks: bool,
    /// Where it begins, s into the segment.
    from: f64,
    start: Start,
}

impl Window {
    /// Expands a guard over a window: its shares and their bounds at the window's start, its parabola from the segment's.
    #[inline(always)]
    pub(crate) fn expand(
        series: &Series,
        shares: &[Shares],
        bounds: &Bounds,
        sign: f64,
        parabola: Parabola,
        span: &Span,
        start: Start,
    ) -> Self {
        let bent = parabola.p2 * span.length;
        let base = [parabola.at(span.from), parabola.rate(span.from) * span.length, bent * span.length];
        let mut remainder = bounds.left_out;
        let a = match start {
            Start::Apart => {
                remainder += 8.0 * f64::EPSILON * (base[0].abs() + base[1].abs() + bounds.moving);
                scaled::<0>(series.expand_slow(shares, span.powers[DEGREE + 1]), sign, &base, span)
            }
            // The start is known exactly: what rounding left in the coefficients below the first is not there.
            Start::Touching { order: 1, slope } => {
                let mut a = divided::<1>(series, shares, sign, &base, span);
                if !slope.is_nan() {
                    a[0] = slope * span.length;
                }
                a
            }
            Start::Touching { order: 2, .. } => divided::<2>(series, shares, sign, &base, span),
            Start::Touching { .. } => divided::<3>(series, shares, sign, &base, span),
        };
        let (left_out, leaves_blocks) = (bounds.left_out, bounds.leaves_blocks);
        Self { b: bernstein(&a), a, left_out, remainder, leaves_blocks, from: span.from, start }
    }

    pub(crate) fn end(&self) -> f64 {
        self.a.iter().sum()
    }

    /// What the enclosure proves, of a part of it with the guard above `margin`; `bend` is to bound the second derivative in σ of the
    /// guard over σ to a power, if that is asked for.
    #[inline(always)]
    pub(crate) fn judge(&self, margin: f64, bend: impl FnOnce(usize) -> f64) -> Verdict {
        let b = &self.b;
        let signs = Signs::of(b, self.remainder);
        if signs.are_all_positive() {
            return Verdict::Clear;
        }
        if self.leaves_blocks {
            return self.clear_prefix(margin);
        }
        match self.single_crossing(signs, bend) {
            Some(guess) => Verdict::Root { guess, high: 1.0 },
            None => self.judge_shape(),
        }
    }

    /// Where the guard turns back on its way to zero, nearer than `known` and before `until`; it grows up to `grown`.
    #[inline(always)]
    pub(crate) fn near_miss(&self, verdict: &Verdict, [grown, until]: [f64; 2], known: f64) -> Option<NearMiss> {
        let end = match verdict {
            Verdict::Clear => 1.0,
            Verdict::Root { guess, .. } => *guess,
            // What is proven then keeps further away.
            Verdict::Until { .. } | Verdict::Unsure => return None,
        };
        if let Start::Touching { order, .. } = self.start {
            return self.turns_after_contact(order, grown, known);
        }
        let may_be = if end < 1.0 { may_turn(&self.b) } else { self.comes_below(known + self.remainder) };
        if may_be { self.turns_back(end.min(until), known) } else { None }
    }

    /// The same behind a contact, where the guard is σ^order p. How far it is from zero there, a shorter window tells, for which it
    /// lies behind.
    #[inline(always)]
    fn turns_after_contact(&self, order: usize, grown: f64, known: f64) -> Option<NearMiss> {
        let nearest: f64 = (0..order).map(|_| grown.clamp(0.0, 1.0)).product();
        if known < f64::INFINITY && !self.comes_below(self.remainder + known / nearest) {
            return None;
        }
        (!rises_then_falls(&self.b, order)).then_some(NearMiss { clearance: f64::INFINITY, is_sharp: false })
    }

    #[inline(always)]
    fn comes_below(&self, level: f64) -> bool {
        let all = self.b.as_chunks().0.iter().map(|b| Four::new(*b));
        let below = |sum: Four, b: Four| sum + b.zip(Four::all(level), |b, level| if b < level { 1.0 } else { 0.0 });
        all.fold(Four::ZERO, below).sum() > 0.0
    }

    #[cold]
    fn turns_back(&self, end: f64, known: f64) -> Option<NearMiss> {
        let part = if end < 1.0 { &cut(&self.b, end)[0] } else { &self.b };
        let below = known + self.remainder;
        // An end that may be level may be the place, unless the slope beside it says that it is the highest; where a segment begins,
        // nothing has come near, and a root is none.
        let doubt = self.step_doubt();
        let [b0, b1, b2, .., b9, b10, b11] = *part;
        let first = if self.from > 0.0 && (b1 - b0).abs() <= doubt && b2 - b1 >= -doubt { b0 } else { below };
        let last = if end >= 1.0 && (b11 - b10).abs() <= doubt && b10 - b9 <= doubt { b11 } else { below };
        let ends = first.min(last).min(below);
        let lowest = dip(part, ends, HALVINGS);
        // A shorter window rounds as this one does, and leaves less out.
        let share = if ends < below { 0.0 } else { 0.01 };
        let is_sharp = self.left_out <= (self.remainder - self.left_out).max(share * lowest);
        (lowest < below).then_some(NearMiss { clearance: (lowest - self.remainder).max(0.0), is_sharp })
    }

    /// What the polynomial leaves out, of a step from one of its coefficients to the next: |R′| is below 16 R.
    fn step_doubt(&self) -> f64 {
        16.0 * self.remainder / DEGREE as f64
    }

    /// How far the polynomial keeps above its remainder and `margin`: where it falls to that once, by Descartes' rule, and no more.
    #[cold]
    fn clear_prefix(&self, margin: f64) -> Verdict {
        // Divided by a power of σ the guard is larger than it is.
        let level = self.remainder + if self.start == Start::Apart { margin } else { 0.0 };
        let signs = Signs::of(&self.b, level);
        if signs.positive == 0 || !come_first(signs.positive) {
            return Verdict::Unsure;
        }
        let mut above = self.a;
        above[0] -= level;
        // Newton has the root to three digits or so; a little before it the polynomial is still above.
        let sigma = 0.98 * root(|x| evaluate(&above, x), signs.crossing(&self.b, level), 1.0, THREE_DIGITS).0;
        if evaluate(&above, sigma).0 > 0.0 { Verdict::Until { sigma } } else { Verdict::Unsure }
    }

    /// Descartes' rule in Bernstein form: coefficients positive, then doubtful, then negative. The guard is positive before
    /// the band where polynomial and remainder cannot be told apart, negative behind it, and falls all through it, since
    /// its slope there is more than its second derivative can turn. Gives a first guess of the root.
    #[inline(always)]
    fn single_crossing(&self, signs: Signs<{ DEGREE + 1 }>, bend: impl FnOnce(usize) -> f64) -> Option<f64> {
        let doubt = self.remainder;
        if !signs.change_once() {
            return None;
        }
        let (guess, slope, step) = root(|x| evaluate(&self.a, x), signs.crossing(&self.b, 0.0), 1.0, THREE_DIGITS);
        let order = match self.start {
            Start::Apart => 0,
            Start::Touching { order, .. } => order,
        };
        let bend = bend(order);
        // With slope −s at the root the polynomial passes the band within 2·doubt/s and turns by less than 2·bend·doubt/s on
        // the way; the remainder's slope is below 12·doubt. Twice that is asked for.
        let falls = |slope: f64| slope < 0.0 && slope * slope > 4.0 * doubt * (bend - 6.0 * slope);
        // The slope is known one Newton step away from the guess; only if that is too far is it taken at the guess.
        (falls(slope + 1.5 * bend * step) || falls(self.slope_near(guess, bend * step))).then_some(guess)
    }

    /// The slope at the root next to `guess`, made shallower by what Newton's next step can change.
    #[cold]
    fn slope_near(&self, guess: f64, turn: f64) -> f64 {
        let slope = evaluate(&self.a, guess).1;
        slope + turn * turn / slope.abs()
    }

    #[cold]
    fn judge_shape(&self) -> Verdict {
        let start = self.start;
        let b = &self.b;
        let doubt = self.remainder;
        let end = b[DEGREE];
        // |R⁽ʲ⁾| ≤ 12!/(12−j)! of R's bound; divided by up to σ³ the first derivative is below 16 R, the second below 250 R.
        let slope_doubt = self.step_doubt();
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
        if doubt == 0.0 && b.iter().all(|b| *b == 0.0) {
            // Nothing pushes and nothing pulls, for ever.
            return Verdict::Clear;
        }
        if start == Start::Apart && b[0] < -doubt {
            // A jump has left the contact untenable: it ends at once.
            return Verdict::Root { guess: 0.0, high: 0.0 };
        }
        let root =
            |high: f64| Verdict::Root { guess: root(|x| evaluate(&self.a, x), high, high, THREE_DIGITS).0, high };
        if (falls || concave) && end < -doubt {
            return root(1.0);
        }
        if concave && end > doubt && (b[0] > doubt || start == Start::Apart) {
            return Verdict::Clear;
        }
        if convex && start == Start::Apart {
            if b[1] - b[0] > slope_doubt {
                return Verdict::Clear;
            }
            if end < -doubt && b[0] > doubt {
                // Convex, positive, then negative: one root.
                return root(1.0);
            }
            let bottom = self.bottom();
            let value = evaluate(&self.a, bottom).0;
            if value > doubt {
                return Verdict::Clear;
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

    /// The guard is surely positive there.
    #[cold]
    pub(crate) fn is_positive(&self, x: f64) -> bool {
        evaluate(&self.a, x).0 > self.remainder
    }

    /// The root below `high` of the polynomial divided by σ^order, from a guess that is near.
    pub(crate) fn refine(&self, guess: f64, high: f64) -> f64 {
        root(|x| evaluate(&self.a, x), guess, high, 2.0 * f64::EPSILON).0
    }
}

/// The lowest place below `known` at which a polynomial turns from falling to rising, to a hundredth and from below; `known` if there
/// is none.
fn dip(b: &Coefficients, known: f64, halvings: u32) -> f64 {
    let [least, most] =
        b.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], b| [least.min(*b), most.max(*b)]);
    if !(least < known && may_turn(b)) {
        return known;
    }
    if least >= 0.99 * most || halvings == 0 {
        return least;
    }
    let [left, right] = cut(b, 0.5);
    let known = dip(&left, known, halvings - 1);
    dip(&right, known, halvings - 1)
}

/// The coefficients in σ of a guard divided by σ^`ORDER`.
#[inline(always)]
fn divided<const ORDER: usize>(
    series: &Series,
    shares: &[Shares],
    sign: f64,
    base: &[f64; 3],
    span: &Span,
) -> Coefficients {
    scaled::<ORDER>(series.expand::<ORDER, 3>(shares.iter().map(|share| &share.now)), sign, base, span)
}

/// From powers of ρt to powers of σ, with the parabola.
#[inline(always)]
fn scaled<const ORDER: usize>(series: [[f64; 4]; 3], sign: f64, base: &[f64; 3], span: &Span) -> Coefficients {
    let mut a = [0.0; DEGREE + 1];
    for j in 0..DEGREE + 1 {
        a[j] = series.as_flattened()[j] * (sign * span.powers[j + ORDER]);
    }
    for j in ORDER..3 {
        a[j - ORDER] += base[j];
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_place_at_which_a_polynomial_turns_is_found_to_a_hundredth_and_from_below() {
        for place in [0.1, 0.37, 0.5, 0.9] {
            for depth in [1e-2, 1e-5, 1e-9] {
                // (x − place)² (2 + x) + depth, from powers to Bernstein coefficients.
                let square = [place * place, -2.0 * place, 1.0];
                let mut a = [0.0; DEGREE + 1];
                for (i, c) in square.into_iter().enumerate() {
                    a[i] += 2.0 * c;
                    a[i + 1] += c;
                }
                a[0] += depth;
                let found = dip(&bernstein(&a), 1.0, HALVINGS);
                assert!(found > 0.99 * depth - 1e-15 && found <= depth + 1e-15, "{found} for {depth} at {place}");
                // Also where it falls far below that behind it, and hardly before.
                a[DEGREE] -= 9.0;
                let found = dip(&bernstein(&a), 1.0, HALVINGS);
                let shift = 9.0 * libm::pow(place, 11.0);
                assert!(
                    shift > 1e-3 * depth || found > 0.98 * depth && found <= depth,
                    "{found} for {depth} at {place}"
                );
            }
        }
        // A slope alone, upwards or downwards, and a hill turn nowhere.
        for coefficients in [[1.0, 1.0, 0.0], [1.0, -0.9, 0.0], [0.1, 1.0, -1.0]] {
            let a = std::array::from_fn(|i| coefficients.get(i).copied().unwrap_or(0.0));
            assert_eq!(dip(&bernstein(&a), 2.0, HALVINGS), 2.0);
        }
    }
}
