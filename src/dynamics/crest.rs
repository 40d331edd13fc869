//! Crests of a smooth motion between two instants at which it is known: whether one may be the highest so far, by the cubic through
//! values and slopes, and the motion there, by Newton's method on the exact flow.

/// A cubic between instants a quarter of a radian apart is off by 1e-5 of the motion, two fifths apart by 7e-5. Crests that are lower by
/// more than this share of the range are not the highest.
const DOUBT: f64 = 1e-3;

/// Displacement, velocity, acceleration and its rate.
pub(crate) type Motion = [f64; 4];

/// An instant, with displacement, velocity and acceleration.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub(crate) time: f64,
    pub(crate) motion: [f64; 3],
}

/// The motion at the crest of the derivative of `order` between two nodes, if there is one that may exceed the range that is known.
pub(crate) fn crest(
    order: usize,
    low: Node,
    high: Node,
    known: impl FnOnce() -> [f64; 2],
    at: impl FnMut(f64) -> Motion,
) -> Option<Motion> {
    let turns = low.motion[order + 1] * high.motion[order + 1] < 0.0;
    (turns && may_exceed(order, low, high, known())).then(|| turning_point(order, low, high, at))
}

/// Whether the crest may exceed what is known. A range that is not known, NaN, is exceeded.
fn may_exceed(order: usize, low: Node, high: Node, known: [f64; 2]) -> bool {
    let h = high.time - low.time;
    let [[v0, s0], [v1, s1]] = [low, high].map(|node| [node.motion[order], h * node.motion[order + 1]]);
    // The slope of the cubic, a parabola in s from 0 to 1; its root within.
    let (a, b, c) = (3.0 * (s0 + s1) + 6.0 * (v0 - v1), -4.0 * s0 - 2.0 * s1 - 6.0 * (v0 - v1), s0);
    let discriminant = (b * b - 4.0 * a * c).max(0.0).sqrt();
    let q = -0.5 * (b + if b < 0.0 { -discriminant } else { discriminant });
    let within = |s: f64| (0.0..=1.0).contains(&s);
    let s = if within(c / q) { c / q } else { q / a };
    if !within(s) {
        return true;
    }
    let crest = v0 + s * (c + s * (0.5 * b + s * a / 3.0));
    let doubt = DOUBT * (known[1] - known[0]) + 0.1 * (crest - v0).abs().min((crest - v1).abs());
    !(crest < known[1] - doubt && crest > known[0] + doubt)
}

/// The motion where the derivative of `order` vanishes between two nodes at which its signs differ: Newton, kept within by bisection.
fn turning_point(order: usize, low: Node, high: Node, mut at: impl FnMut(f64) -> Motion) -> Motion {
    let sign = low.motion[order + 1];
    // From the straight line between the slopes at both ends.
    let share = sign / (sign - high.motion[order + 1]);
    let (mut low, mut high) = (low.time, high.time);
    let mut t = low + share * (high - low);
    let mut motion = at(t);
    for _ in 0..60 {
        if motion[order + 1] * sign > 0.0 {
            low = t
        } else {
            high = t
        }
        let newton = t - motion[order + 1] / motion[order + 2];
        let next = if newton > low && newton < high { newton } else { f64::midpoint(low, high) };
        // The value is quadratic in the instant's error.
        let settled = (next - t).abs() <= 1e-9 * t.abs();
        t = next;
        motion = at(t);
        if settled {
            break;
        }
    }
    motion
}
