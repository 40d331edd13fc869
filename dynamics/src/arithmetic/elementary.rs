//! Elementary functions: exp, sin and cos in plain arithmetic, the same bits on every processor.
//!
//! The flows call them more than anything else, so they are written for pipelines: no branch on the argument, polynomials
//! by Estrin's scheme, both of sin and cos at once. Arguments are reduced by Cody and Waite's method (three-part π/2,
//! two-part ln 2); the polynomials of sin and cos are fdlibm's. Error below 1.5 units in the last place against the `libm`
//! crate, which takes over for arguments beyond the reduction's range.

use crate::arithmetic::lanes::Lanes;

/// 1.5·2⁵²: adding and subtracting it rounds to the nearest integer.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// eˣ.
#[inline]
pub(crate) fn exp(x: f64) -> f64 {
    exp_lanes(Lanes([x])).0[0]
}

/// sin x and cos x.
#[inline]
pub(crate) fn sin_cos(x: f64) -> (f64, f64) {
    let (sine, cosine) = sin_cos_lanes(Lanes([x]));
    (sine.0[0], cosine.0[0])
}

/// eˣ of each.
#[inline(always)]
pub(crate) fn exp_lanes<const N: usize>(x: Lanes<N>) -> Lanes<N> {
    const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
    const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    if !x.all_below(700.0) {
        return x.map(exp_beyond);
    }
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let k = shifted - ROUND;
    let r = (x - k * LN2_HIGH) - k * LN2_LOW;
    // Taylor to the thirteenth on |r| ≤ 0.35: what is left out is below 5e-18.
    let r2 = r * r;
    let r4 = r2 * r2;
    let low = (0.5 + r * (1.0 / 6.0)) + r2 * (1.0 / 24.0 + r * (1.0 / 120.0));
    let middle = (1.0 / 720.0 + r * (1.0 / 5040.0)) + r2 * (1.0 / 40_320.0 + r * (1.0 / 362_880.0));
    let high =
        (1.0 / 3_628_800.0 + r * (1.0 / 39_916_800.0)) + r2 * (1.0 / 479_001_600.0 + r * (1.0 / 6_227_020_800.0));
    let tail = r + r2 * (low + r4 * (middle + r4 * high));
    // 2ᵏ from the integer that sits in the low bits of the shifted sum.
    let power = shifted.map(|s| f64::from_bits((s.to_bits() << 52).wrapping_add(1023 << 52)));
    power + power * tail
}

/// sin and cos of each.
#[inline(always)]
pub(crate) fn sin_cos_lanes<const N: usize>(x: Lanes<N>) -> (Lanes<N>, Lanes<N>) {
    const PIO2_1: f64 = 1.570_796_326_734_125_6;
    const PIO2_2: f64 = 6.077_100_506_303_966e-11;
    const PIO2_3: f64 = 2.022_266_248_711_166_5e-21;
    if !x.all_below(1e5) {
        return (x.map(|x| sin_cos_beyond(x).0), x.map(|x| sin_cos_beyond(x).1));
    }
    let shifted = x * std::f64::consts::FRAC_2_PI + ROUND;
    let k = shifted - ROUND;
    // Products with the first two parts are exact; the sum is carried in two numbers, r + tail.
    let first = x - k * PIO2_1;
    let second = k * PIO2_2;
    let r0 = first - second;
    let tail = ((first - r0) - second) - k * PIO2_3;
    let r = r0 + tail;
    let tail = (r0 - r) + tail;
    let z = r * r;
    let z2 = z * z;
    let s = (8.333_333_333_322_49e-3 + z * -1.984_126_982_985_795e-4)
        + z2 * ((2.755_731_370_707_006_8e-6 + z * -2.505_076_025_340_686_3e-8) + z2 * 1.589_690_995_211_55e-10);
    let v = z * r;
    let sine = r - ((z * (0.5 * tail - v * s) - tail) - v * -1.666_666_666_666_663_2e-1);
    let c = (4.166_666_666_666_66e-2 + z * -1.388_888_888_887_411e-3)
        + z2 * ((2.480_158_728_947_673e-5 + z * -2.755_731_435_139_066_3e-7)
            + z2 * (2.087_572_321_298_175e-9 + z * -1.135_964_755_778_819_5e-11));
    let half = 0.5 * z;
    let w = 1.0 - half;
    let cosine = w + (((1.0 - w) - half) + (z2 * c - r * tail));
    let (mut sines, mut cosines) = (sine, cosine);
    for lane in 0..N {
        // By the quadrant, in the low bits: exchanged if it is odd, and negated.
        let quadrant = shifted.0[lane].to_bits();
        let (sine, cosine) = (sine.0[lane].to_bits(), cosine.0[lane].to_bits());
        let other = (sine ^ cosine) & (quadrant & 1).wrapping_neg();
        sines.0[lane] = f64::from_bits((sine ^ other) ^ ((quadrant & 2) << 62));
        cosines.0[lane] = f64::from_bits((cosine ^ other) ^ ((quadrant.wrapping_add(1) & 2) << 62));
    }
    (sines, cosines)
}

/// Where some lane is out of range, each by itself; out of the way of the registers that all others need.
#[cold]
#[inline(never)]
fn exp_beyond(x: f64) -> f64 {
    if x.abs() < 700.0 { exp(x) } else { libm::exp(x) }
}

#[cold]
#[inline(never)]
fn sin_cos_beyond(x: f64) -> (f64, f64) {
    if x.abs() < 1e5 { sin_cos(x) } else { libm::sincos(x) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ulps(a: f64, b: f64) -> f64 {
        (a - b).abs() / (f64::EPSILON * b.abs().max(f64::MIN_POSITIVE))
    }

    #[test]
    fn agree_with_libm_to_the_last_place_over_the_whole_range() {
        let mut x = 1.0e-8_f64;
        for step in 0..400_000_u64 {
            // A deterministic walk over magnitudes and signs.
            x = (x * 1.000_07 + 1e-9) % 9.0e4;
            let x = if step % 2 == 0 { x } else { -x };
            let (sine, cosine) = sin_cos(x);
            // Near a zero of sin or cos the last place of the reduction counts, not that of the value.
            assert!((sine - libm::sin(x)).abs() <= 1.6e-16 * (1.0 + 1e-16 * x.abs()), "sin {x}");
            assert!((cosine - libm::cos(x)).abs() <= 1.6e-16, "cos {x}");
            let y = x % 690.0;
            assert!(ulps(exp(y), libm::exp(y)) <= 1.5, "exp {y}");
        }
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert!(exp(-800.0) == 0.0 && exp(f64::NAN).is_nan());
    }
}
