//! The first event of a flow of few blocks, by cells: most segments of one mass with its damper are decided by two or three products.
//!
//! Over a cell of D seconds a guard g, divided by σ to the power that it starts with, is a polynomial p of the seventh degree, and R bounds
//! what that leaves out ([`crate::flow::cells`]). Bernstein coefficients that all exceed R prove it positive. Positive ones, then doubtful
//! ones, then negative ones, of the cell or of its part up to just behind the first root, prove that p ± R have one root each there, by
//! Descartes' rule; and that of g is the only one if p falls so steeply that neither its bend over Newton's last step nor what is left out can
//! turn it. Whatever else is seen is left to windows: near misses, roots at the same time, long ways. `polish` finds a root to the last
//! digit from the guard alone, so that both give the same bits.

use crate::arithmetic::four::Four;
use crate::contact_state::bank::{Kernels, Phases, Transfer};
use crate::flow::cells::{Cell, Cells, KEPT, REACH, Tables};
use crate::flow::parabola::Parabola;
use crate::flow::signals::Signals;
use crate::search::polynomial::{Signs, THREE_DIGITS, cut, evaluate, may_turn, rises_then_falls, root};
use crate::search::survey::Motion;
use crate::search::window::Start;
use crate::search::{AFTER, Clarity, Found, Guard, Root, Search, is_never_reached};

/// The root lies within so many of Newton's last steps from where the slope was taken.
const DOUBTFUL_STEP: f64 = 2.0;
/// radius·t of a hop that is left to windows: where it begins it has another root that is as near.
const SHORT: f64 = 0.12;
/// Times the first guess of a root: up to there its guard is looked at, where it comes back in the same cell.
const BEHIND: f64 = 1.1;
/// Guards beyond which windows are cheaper: they follow the nearest, while cells look at all.
const MANY: usize = 4;
/// Roundings of a coefficient of a part of a cell, relative to the largest of the cell.
const CUT: f64 = 16.0 * f64::EPSILON;
/// Roundings of a guard's value.
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// A guard over a cell, divided by σ to the power that it starts with.
struct Piece<'a> {
    tables: &'a Tables,
    shares: Phases,
    /// Coefficients of 1, σ and σ² beside those of the tables.
    base: [f64; 3],
    /// Bernstein coefficients of the polynomial.
    b: Cell,
    left_out: f64,
    /// That power.
    order: usize,
}

/// The first root of a guard in a cell.
struct Fall {
    guard: usize,
    /// First guess of its σ, and up to where it is the only one.
    guess: f64,
    high: f64,
    /// By powers of σ.
    powers: [f64; KEPT],
    left_out: f64,
}

impl Search {
    /// The first event before `limit`, where cells tell; leaves the kernels of that time, or of the limit.
    #[inline(always)]
    pub(super) fn by_cells(
        &mut self,
        motion: Motion<'_>,
        cells: &Cells,
        signals: &Signals,
        limit: f64,
        clarity: &mut Clarity,
    ) -> Option<Found> {
        let far = self.out_of_reach(motion, signals, clarity)?;
        for (i, transfer) in cells.transfers.iter().enumerate() {
            let now = i as f64 * cells.length;
            let ends_later = now + cells.length >= limit;
            let [mut first, mut later]: [Option<Fall>; 2] = [None, None];
            for (index, guard) in self.guards.iter().enumerate().filter(|(index, _)| far & 1 << index == 0) {
                let piece = Piece::of(motion, cells, guard, signals, (now, transfer));
                if piece.least() > piece.left_out {
                    if guard.distance && piece.may_come_near(clarity.margin) {
                        return None;
                    }
                    continue;
                }
                let fall = piece.fall(cells, index, guard.distance)?;
                if guard.distance && now > 0.0 && piece.rises() {
                    return None;
                }
                if ends_later && fall.comes_after((limit - now) / cells.length) {
                    continue;
                }
                if later.is_some() || now == 0.0 && fall.guess * REACH < SHORT {
                    return None;
                }
                let precedes = first.as_ref().is_some_and(|first| first.guess <= fall.guess);
                (first, later) = if precedes { (first, Some(fall)) } else { (Some(fall), first) };
            }
            if let Some(Fall { guard, guess, high, .. }) = first {
                let window = cells.length;
                self.trial.resize(1, Kernels::NONE);
                self.surveys.now = now;
                let before = *clarity;
                let time = self.polish(motion, signals, Root { guard, guess, high, window }, clarity);
                if later.is_some_and(|later| !later.comes_after((time.min(limit) * AFTER - now) / window)) {
                    *clarity = before;
                    return None;
                }
                if time <= limit {
                    std::mem::swap(&mut self.kernels, &mut self.trial);
                    return Some(Found::Event { guard, time });
                }
                // It comes after the limit, if at all.
                *clarity = before;
            }
            if ends_later {
                self.kernels.resize(1, Kernels::NONE);
                motion.kernels(limit, &mut self.kernels);
                return Some(Found::Nothing);
            }
        }
        None
    }

    /// Guards that are further from zero than their signals can move them, one bit each; `None` where one starts downwards, or where
    /// there are many.
    #[inline(always)]
    fn out_of_reach(&self, motion: Motion<'_>, signals: &Signals, clarity: &Clarity) -> Option<u8> {
        let is_bounded = motion.bank.near_critical.is_empty();
        let mut far = 0_u8;
        if self.guards.len() > MANY {
            return None;
        }
        for (index, guard) in self.guards.iter().enumerate() {
            match guard.start {
                Start::Apart => {
                    let reach = motion.blocks[0].amplitudes(signals.of(guard.signal).phases[0]).sum();
                    let least = guard.kept_clear(clarity, reach);
                    let is_far = is_bounded && is_never_reached(guard.parabola, reach + least, guard.margin(clarity));
                    far |= u8::from(is_far) << index;
                }
                Start::Touching { order: 1, slope } if slope <= 0.0 => return None,
                Start::Touching { .. } => {}
            }
        }
        Some(far)
    }
}

impl<'a> Piece<'a> {
    /// A guard over the cell that begins at an instant, with the transfer up to there.
    #[inline(always)]
    fn of(
        motion: Motion<'_>,
        cells: &'a Cells,
        guard: &Guard,
        signals: &Signals,
        (now, transfer): (f64, &Transfer),
    ) -> Self {
        let (watched, length, sign) = (signals.of(guard.signal), cells.length, guard.sign);
        let bent = guard.parabola.p2 * (length * length);
        let mut shares = watched.phases[0];
        let Parabola { mut p0, mut p1, p2 } = guard.parabola;
        let (order, base, size) = match guard.start {
            Start::Touching { order, slope } if now == 0.0 => match order {
                1 if slope.is_nan() => {
                    let size = length * (p1.abs() + shares.rate.abs().sum());
                    (1, [length * (p1 + sign * watched.sum.rate), bent, 0.0], size)
                }
                1 => (1, [slope * length, bent, 0.0], 0.0),
                2 => (2, [bent, 0.0, 0.0], 0.0),
                _ => (3, [0.0; 3], 0.0),
            },
            _ => {
                let (mut sum, mut size) = (watched.sum, p0.abs() + watched.size);
                if now > 0.0 {
                    size += (p1 * now).abs() + (p2 * (now * now)).abs();
                    (p0, p1) = (guard.parabola.at(now), guard.parabola.rate(now));
                    shares = motion.blocks[0].advance(shares, transfer);
                    (sum.value, sum.rate) = (shares.value.sum(), shares.rate.sum());
                }
                (0, [p0 + sign * sum.value, (p1 + sign * sum.rate) * length, bent], size)
            }
        };
        let shares = Phases { value: shares.value * sign, rate: shares.rate * sign };
        let tables = cells.tables(motion.each, order);
        let moved = cells.bernstein(tables, shares);
        let b = std::array::from_fn(|i| moved[i] + base[0] + (FIRST[i] * base[1] + SECOND[i] * base[2]));
        let size = size + base[0].abs() + base[1].abs() + base[2].abs();
        Self { tables, shares, base, b, left_out: tables.left_out(shares) + ROUNDINGS * size, order }
    }

    #[inline(always)]
    fn least(&self) -> f64 {
        let [low, high] = self.b;
        low.zip(high, |a, b| if b < a { b } else { a }).least()
    }

    /// Whether it may turn back on its way to zero nearer to that than anything before, where it is positive all through.
    #[inline(always)]
    fn may_come_near(&self, known: f64) -> bool {
        if self.order > 0 { !rises_then_falls(&flat(self.b), self.order) } else { self.least() < known + self.left_out }
    }

    /// Whether it begins with a slope that is not negative: where the cell before it ends, it may have come near.
    #[inline(always)]
    fn rises(&self) -> bool {
        let [low, _] = self.b;
        low.at(1) >= low.at(0)
    }

    /// Its first root, if it does not turn before where it is a distance.
    #[inline(always)]
    fn fall(&self, cells: &Cells, guard: usize, is_distance: bool) -> Option<Fall> {
        let (b, left_out) = (flat(self.b), self.left_out);
        let signs = Signs::of(&b, left_out);
        if !signs.begin_positive() {
            return None;
        }
        let mut powers = flat(cells.powers(self.tables, self.shares));
        powers.iter_mut().zip(self.base).for_each(|(power, base)| *power += base);
        let (guess, slope, step) = root(|x| evaluate(&powers, x), signs.crossing(&b, 0.0), 1.0, THREE_DIGITS);
        let high = if self.falls_once(&b, signs, is_distance) {
            1.0
        } else {
            // What it does behind the root is no matter.
            let high = BEHIND * guess;
            let part = if high < 1.0 { cut(&b, high)[0] } else { return None };
            let rounding = CUT * b.iter().fold(0.0_f64, |most, b| most.max(b.abs()));
            self.falls_once(&part, Signs::of(&part, left_out + rounding), is_distance).then_some(high)?
        };
        let [rest_turns, bend] = self.tables.turning(self.shares);
        let bend = bend + 2.0 * self.base[2].abs();
        let steep = -slope - DOUBTFUL_STEP * bend * step;
        // With slope −s at the root p passes the band within 2R/s, and turns by less than 2R bend/s on the way. Twice that is asked for.
        let falls = steep > 0.0 && steep * steep > 4.0 * left_out * bend + 2.0 * rest_turns * steep;
        falls.then_some(Fall { guard, guess, high, powers, left_out })
    }

    /// Whether it has one root and no more where these are its coefficients, and does not turn before if it is a distance.
    #[inline(always)]
    fn falls_once(&self, b: &[f64; KEPT], signs: Signs<KEPT>, is_distance: bool) -> bool {
        let turns = || if self.order > 0 { !rises_then_falls(b, self.order) } else { may_turn(b) };
        signs.change_once() && !(is_distance && turns())
    }
}

impl Fall {
    /// Whether the guard is surely positive up to this σ.
    #[inline(always)]
    fn comes_after(&self, sigma: f64) -> bool {
        sigma < self.high && evaluate(&self.powers, sigma).0 > self.left_out
    }
}

#[inline(always)]
fn flat([low, high]: Cell) -> [f64; KEPT] {
    let ([a, b, c, d], [e, f, g, h]) = (low.array(), high.array());
    [a, b, c, d, e, f, g, h]
}

/// Bernstein coefficients of σ.
const FIRST: Cell =
    [Four::new([0.0, 1.0 / 7.0, 2.0 / 7.0, 3.0 / 7.0]), Four::new([4.0 / 7.0, 5.0 / 7.0, 6.0 / 7.0, 1.0])];
/// Those of σ².
const SECOND: Cell =
    [Four::new([0.0, 0.0, 1.0 / 21.0, 3.0 / 21.0]), Four::new([6.0 / 21.0, 10.0 / 21.0, 15.0 / 21.0, 1.0])];
