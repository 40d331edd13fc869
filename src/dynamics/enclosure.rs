//! What the Bernstein coefficients of a guard over a cell prove.
//!
//! g(σ) = Σ bᵢ Bᵢ⁸(σ) + R with |R| ≤ doubt: where all bᵢ are above the doubt there is no root; where they fall from above to below it
//! once, Descartes' rule gives one root each to p ± doubt, and one to g if it falls all through the band between. What neither
//! holds for is halved by averages (de Casteljau), the left half first.

/// Degree of a guard in a cell.
pub(crate) const DEGREE: usize = 8;

/// Bernstein coefficients.
pub(crate) type Coefficients = [f64; DEGREE + 1];

/// Shares of a cell below this are not halved any more.
const NARROWEST: f64 = 1.0 / 100.0;
/// How sharp a lowest place has to be known, relative to itself.
pub(crate) const SHARP: f64 = 1e-3;

/// A guard over a cell.
pub(crate) struct Enclosure<S: Fn() -> f64> {
    pub(crate) b: Coefficients,
    /// Bound on R, and on its slope in σ.
    pub(crate) doubt: f64,
    pub(crate) steep: S,
    /// σ beyond which nothing is asked.
    pub(crate) end: f64,
}

/// What is proven, in σ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Proven {
    /// No root before the end.
    Clear,
    /// No root before this.
    Until(f64),
    /// One root in a bracket, none before it.
    Root(Bracket),
}

/// The place of a root.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bracket {
    /// It is not before this.
    pub(crate) earliest: f64,
    pub(crate) guess: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl<S: Fn() -> f64> Enclosure<S> {
    #[inline(always)]
    pub(crate) fn prove(&self) -> Proven {
        self.prove_part(&self.b, 0.0, 1.0)
    }

    /// Of the part from σ = `from`, so wide.
    fn prove_part(&self, b: &Coefficients, from: f64, width: f64) -> Proven {
        if from >= self.end {
            return Proven::Clear;
        }
        let (positive, negative) = signs(b, self.doubt);
        if positive == ALL {
            return Proven::Clear;
        }
        if positive & 1 == 0 {
            return Proven::Until(from);
        }
        if let Some(first) = single_change(positive, negative) {
            return match self.crossing(b, first, from, width) {
                Proven::Root(root) if root.earliest > self.end => Proven::Clear,
                proven => proven,
            };
        }
        if width < NARROWEST {
            return Proven::Until(from);
        }
        let (left, right) = halves(b);
        match self.prove_part(&left, from, 0.5 * width) {
            Proven::Clear => self.prove_part(&right, from + 0.5 * width, 0.5 * width),
            other => other,
        }
    }

    /// The one root of a part whose coefficients are positive before the one numbered `first`, then doubtful, then negative; if the
    /// guard falls all through the band where polynomial and remainder cannot be told apart.
    #[inline]
    fn crossing(&self, b: &Coefficients, first: usize, from: f64, width: f64) -> Proven {
        // Where the control polygon crosses zero.
        let (before, after) = (b[first - 1], b[first]);
        let mut x = ((first - 1) as f64 + before / (before - after)).min(first as f64) * (1.0 / DEGREE as f64);
        let (mut low, mut high) = (0.0, 1.0);
        let (mut slope, mut step) = (0.0, f64::INFINITY);
        for _ in 0..20 {
            let value;
            (value, slope) = evaluate(b, x);
            if value > 0.0 {
                low = x
            } else {
                high = x
            }
            let mut next = x - value / slope;
            if !(next > low && next < high) {
                next = 0.5 * (low + high);
            }
            step = (next - x).abs();
            x = next;
            if step < 4e-3 {
                break;
            }
        }
        let bend = bend(b);
        // At the root the slope is less by what Newton's last step can turn; and it loses as much again on the way through the band.
        let falls = -slope - bend * step;
        let steep = (self.steep)() * width;
        let at = |x: f64| from + width * x;
        if !(falls > 0.0 && falls * falls > 4.0 * self.doubt * bend + 2.0 * steep * falls) {
            // No root at least where the polynomial is above the doubt; it falls to that once.
            let before = x - 1.5 * self.doubt / slope.abs() - step;
            let above = before > 0.0 && evaluate(b, before).0 > self.doubt;
            return Proven::Until(if above { at(before) } else { from });
        }
        let earliest = x - (2.0 * self.doubt + bend * step * step) / falls;
        Proven::Root(Bracket { earliest: at(earliest.max(0.0)), guess: at(x), low: from, high: from + width })
    }
}

/// A place where a guard turns from falling to rising.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turn {
    pub(crate) at: f64,
    pub(crate) value: f64,
}

/// The polynomial comes below `record` and may turn from falling to rising.
#[inline(always)]
pub(crate) fn may_turn(b: &Coefficients, record: f64) -> bool {
    let mut falls = 0_u64;
    for i in 0..DEGREE {
        falls |= if b[i + 1] < b[i] { 1 << i } else { 0 };
    }
    // Steps that rise behind the first that falls.
    let behind = (ALL >> 1) & !falls & !(falls & falls.wrapping_neg()).wrapping_sub(1);
    falls != 0 && behind != 0 && b.iter().copied().fold(b[0], f64::min) < record
}

/// Adds the turns of the part of a polynomial from σ = `from`, so wide: those before `until` and below `record`, to [`SHARP`].
#[cold]
pub(crate) fn turns(b: &Coefficients, from: f64, width: f64, until: f64, record: f64, found: &mut Vec<Turn>) {
    if from >= until || !may_turn(b, record) {
        return;
    }
    let convex = (0..DEGREE - 1).all(|i| b[i + 2] - 2.0 * b[i + 1] + b[i] >= 0.0);
    if convex || width < 1e-9 {
        let lowest = lowest_of_convex(b, record);
        let at = from + width * lowest.at;
        if lowest.value < record && at < until {
            found.push(Turn { at, ..lowest });
        }
        return;
    }
    let (left, right) = halves(b);
    let half = 0.5 * width;
    turns(&left, from, half, until, record, found);
    turns(&right, from + half, half, until, record, found);
    // Just where it was halved.
    if left[DEGREE] <= left[DEGREE - 1] && right[1] >= right[0] && right[0] < record && from + half < until {
        found.push(Turn { at: from + half, value: right[0] });
    }
}

/// A bound from below, which is sharp unless it is above the record.
fn lowest_of_convex(b: &Coefficients, record: f64) -> Turn {
    let (mut low, mut high) = (0.0, 1.0);
    let (mut falling, mut rising) = (b[1] - b[0], b[DEGREE] - b[DEGREE - 1]);
    let mut turn = Turn { at: 0.0, value: b[0] };
    for round in 0..60 {
        // By turns the secant of the slopes and the middle.
        let secant = low + (high - low) * falling / (falling - rising);
        let x = if round % 3 < 2 && secant > low && secant < high { secant } else { 0.5 * (low + high) };
        let (value, slope) = evaluate(b, x);
        // It is above its tangent.
        let below = if slope < 0.0 { -slope * (high - x) } else { slope * (x - low) };
        turn = Turn { at: x, value: value - below };
        if turn.value >= record || below <= SHARP * value.abs() {
            break;
        }
        if slope < 0.0 { (low, falling) = (x, slope) } else { (high, rising) = (x, slope) }
    }
    turn
}

/// One bit a coefficient, the first the lowest.
const ALL: u64 = (1 << (DEGREE + 1)) - 1;

/// Which coefficients are surely positive, and which surely negative.
#[inline(always)]
fn signs(b: &Coefficients, doubt: f64) -> (u64, u64) {
    let (mut positive, mut negative) = (0, 0);
    for (i, b) in b.iter().enumerate() {
        // Masks as wide as the numbers, so that two fit a register.
        positive |= if *b > doubt { 1 << i } else { 0 };
        negative |= if *b < -doubt { 1 << i } else { 0 };
    }
    (positive, negative)
}

/// Positive, then doubtful, then negative: where the first that is not positive stands.
#[inline(always)]
fn single_change(positive: u64, negative: u64) -> Option<usize> {
    let falling = |bits: u64| bits & (bits + 1) == 0;
    let once = positive != 0 && negative != 0 && falling(positive) && falling(ALL & !negative);
    once.then(|| positive.trailing_ones() as usize)
}

/// Both halves of a polynomial.
#[inline(always)]
fn halves(b: &Coefficients) -> (Coefficients, Coefficients) {
    let (mut left, mut right) = (*b, *b);
    // Eight rounds of known length each, so that the compiler keeps them in registers.
    averages::<1>(&mut left, &mut right);
    averages::<2>(&mut left, &mut right);
    averages::<3>(&mut left, &mut right);
    averages::<4>(&mut left, &mut right);
    averages::<5>(&mut left, &mut right);
    averages::<6>(&mut left, &mut right);
    averages::<7>(&mut left, &mut right);
    averages::<8>(&mut left, &mut right);
    (left, right)
}

#[inline(always)]
fn averages<const ROUND: usize>(left: &mut Coefficients, right: &mut Coefficients) {
    let mut i = 0;
    while i <= DEGREE - ROUND {
        right[i] = 0.5 * (right[i] + right[i + 1]);
        i += 1;
    }
    left[ROUND] = right[0];
}

/// Value and slope at x, by Horner's scheme in x and 1 − x.
#[inline]
fn evaluate(b: &Coefficients, x: f64) -> (f64, f64) {
    let y = 1.0 - x;
    let (x2, y2) = (x * x, y * y);
    let (x4, y4) = (x2 * x2, y2 * y2);
    // The polynomial of degree seven is y·(left) + x·(right) of its control points; so the value needs those of both ends.
    let seventh = |b: &[f64]| {
        let cubic = |i: usize, [p, q, r, s]: [f64; 4]| {
            (p * b[i] * y + q * b[i + 1] * x) * y2 + (r * b[i + 2] * y + s * b[i + 3] * x) * x2
        };
        cubic(0, [1.0, 7.0, 21.0, 35.0]) * y4 + cubic(4, [35.0, 21.0, 7.0, 1.0]) * x4
    };
    let (before, after) = (seventh(&b[..DEGREE]), seventh(&b[1..]));
    (y * before + x * after, DEGREE as f64 * (after - before))
}

/// A bound on the second derivative.
#[inline]
fn bend(b: &Coefficients) -> f64 {
    let mut most = 0.0_f64;
    for i in 0..DEGREE - 1 {
        most = most.max((b[i + 2] - 2.0 * b[i + 1] + b[i]).abs());
    }
    (DEGREE * (DEGREE - 1)) as f64 * most
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers between −1 and 1 that always come the same.
    fn numbers() -> impl Iterator<Item = f64> {
        let mut state = 7_u64;
        std::iter::repeat_with(move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
    }

    #[test]
    fn what_is_proven_holds_for_every_function_within_the_doubt() {
        let mut numbers = numbers();
        let [mut clear, mut roots] = [0, 0];
        for trial in 0..4000 {
            let mut b: Coefficients = std::array::from_fn(|_| numbers.next().unwrap());
            b[0] = b[0].abs() + 0.05;
            let (doubt, phase) = (1e-3 * numbers.next().unwrap().abs(), 7.0 * numbers.next().unwrap());
            // R = doubt·sin(8σ + phase).
            let enclosure = Enclosure { b, doubt, steep: || 8.0 * doubt, end: 1.0 };
            let proven = enclosure.prove();
            let at = |x: f64| evaluate(&b, x).0 + doubt * libm::sin(8.0 * x + phase);
            let positive_to = |until: f64| (0..=500).all(|i| at(until * f64::from(i) / 500.0) > 0.0);
            match proven {
                Proven::Clear => {
                    clear += 1;
                    assert!(positive_to(1.0), "{trial}: {b:?}");
                }
                Proven::Until(until) => assert!(until == 0.0 || positive_to(until), "{trial}: {b:?} {until}"),
                Proven::Root(root) => {
                    roots += 1;
                    assert!(positive_to(root.earliest), "{trial}: {b:?} {root:?}");
                    assert!(at(root.high) < 0.0 && at(root.low) > 0.0, "{trial}: {b:?} {root:?}");
                    let place = |i: i32| root.low + (root.high - root.low) * f64::from(i) / 500.0;
                    let changes = (0..500).filter(|&i| (at(place(i)) > 0.0) != (at(place(i + 1)) > 0.0)).count();
                    assert_eq!(changes, 1, "{trial}: {b:?} {root:?}");
                }
            }
        }
        assert!(clear > 100 && roots > 1000, "{clear} {roots}");
    }

    #[test]
    fn turns_are_bounds_from_below_and_sharp() {
        let mut numbers = numbers();
        for trial in 0..2000 {
            let b: Coefficients =
                std::array::from_fn(|i| 2.0 + numbers.next().unwrap() + if i == 4 { -3.0 } else { 0.0 });
            let mut found = Vec::new();
            turns(&b, 0.0, 1.0, 1.0, f64::INFINITY, &mut found);
            let sampled: Vec<f64> = (0..=4000).map(|i| evaluate(&b, f64::from(i) / 4000.0).0).collect();
            let lowest = sampled.windows(3).filter(|at| at[1] < at[0] && at[1] <= at[2]).map(|at| at[1]);
            let lowest = lowest.fold(f64::INFINITY, f64::min);
            if lowest.is_infinite() {
                continue;
            }
            let least = found.iter().fold(f64::INFINITY, |least, turn| least.min(turn.value));
            assert!(
                least <= lowest && least >= lowest - 3.0 * SHARP * lowest.abs() - 1e-5,
                "{trial}: {least} {lowest}"
            );
        }
    }
}
