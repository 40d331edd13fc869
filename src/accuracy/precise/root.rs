//! The first root of a polynomial on [0, 1], found by looking closely.
//!
//! Signs are taken in doubles of the scaled polynomial at many points and at the minima between them; the root is then
//! sharpened in all digits. No certificate: that is the engine's way, and this one is to be another.

use super::double::Double;

/// Points looked at.
const POINTS: u32 = 48;

/// The first instant in [0, 1] from which the polynomial is negative; `None` where it stays positive.
pub(super) fn first_negative(scaled: &[Double]) -> Option<Double> {
    let near: Vec<f64> = scaled.iter().map(|a| a.near()).collect();
    let mut before = 0.0;
    if value(&near, 0.0) < 0.0 {
        return Some(Double::ZERO);
    }
    for point in 1..=POINTS {
        let now = f64::from(point) / f64::from(POINTS);
        let end = if value(&near, now) < 0.0 {
            Some(now)
        } else if slope(&near, before) < 0.0 && slope(&near, now) > 0.0 {
            let bottom = bisect(before, now, |t| slope(&near, t) < 0.0);
            (value(&near, bottom) < 0.0).then_some(bottom)
        } else {
            None
        };
        if let Some(end) = end {
            let about = bisect(before, end, |t| value(&near, t) >= 0.0);
            return Some(sharpen(scaled, about, before, end));
        }
        before = now;
    }
    None
}

/// Newton's steps from a root known to a double.
fn sharpen(scaled: &[Double], about: f64, low: f64, high: f64) -> Double {
    let mut root = Double::from(about);
    for _ in 0..4 {
        let (value, slope) = both(scaled, root);
        if slope.near() == 0.0 {
            break;
        }
        let next = root - value / slope;
        if !(next.near() >= low && next.near() <= high) {
            break;
        }
        root = next;
    }
    root
}

/// The last point at which `holds`, to a double.
fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Instants of [0, 1] at which a double polynomial has an extreme value inside.
pub(super) fn extremes(near: &[f64]) -> Vec<f64> {
    let at = |point: u32| f64::from(point) / f64::from(POINTS);
    let turns = (1..=POINTS).map(|point| (at(point - 1), at(point))).filter(|(a, b)| {
        let (before, now) = (slope(near, *a), slope(near, *b));
        before * now < 0.0
    });
    turns
        .map(|(a, b)| {
            let falling = slope(near, a) < 0.0;
            bisect(a, b, |t| (slope(near, t) < 0.0) == falling)
        })
        .collect()
}

/// Horner's scheme.
pub(super) fn value(a: &[f64], t: f64) -> f64 {
    a.iter().rev().fold(0.0, |sum, a| sum * t + a)
}

fn slope(a: &[f64], t: f64) -> f64 {
    a.iter().enumerate().skip(1).rev().fold(0.0, |sum, (k, a)| sum * t + k as f64 * a)
}

/// Value and slope.
pub(super) fn both(a: &[Double], t: Double) -> (Double, Double) {
    a.iter().rev().fold((Double::ZERO, Double::ZERO), |(value, slope), a| (value * t + *a, slope * t + value))
}
