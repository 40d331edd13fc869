//! Crests of a smooth motion between two instants at which it is known: whether one may be the highest so far, by the cubic through
//! values and slopes, and the motion there, by Newton's method on the exact flow.

/// How much more a cubic may be off between two instants than its curvature at them says.
const DOUBT: f64 = 8.0;

/// Displacement, velocity, acceleration and its rate.
pub(crate) type Motion = [f64; 4];

/// An instant, and the motion there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub(crate) time: f64,
    pub(crate) motion: Motion,
}

/// The motion at the crest of the derivative of `order` between two nodes, if there is one that may exceed the range that is known.
pub(crate) fn crest(
    order: usize,
    low: Node,
    high: Node,
    known: impl FnOnce() -> [f64; 2],
    at: impl FnMut(f64) -> Motion,
) -> Option<Motion> {
    // What starts at rest goes where the next derivative sends it.
    let onwards = low.motion[order + 1..].iter().copied().find(|slope| *slope != 0.0).unwrap_or(0.0);
    let turns = onwards * high.motion[order + 1] < 0.0;
    (turns && may_exceed(order, low, high, known())).then(|| turning_point(order, onwards, low, high, at))
}

/// Whether the crest may exceed what is known. A range that is not known, NaN, is exceeded.
///
/// Where the fourth derivative is f, the cubic is off by f h⁴/384 at most, and its second derivative by f h²/12 at both ends, where
/// that of the motion is known.
fn may_exceed(order: usize, low: Node, high: Node, known: [f64; 2]) -> bool {
    let h = high.time - low.time;
    let of = |node: Node| [node.motion[order], h * node.motion[order + 1], h * h * node.motion[order + 2]];
    let [[v0, s0, b0], [v1, s1, b1]] = [low, high].map(of);
    // The slope of the cubic, a parabola in s from 0 to 1; its root within.
    let (a, b, c) = (3.0 * (s0 + s1) + 6.0 * (v0 - v1), -4.0 * s0 - 2.0 * s1 - 6.0 * (v0 - v1), s0);
    let off = (b - b0).abs().max((2.0 * a + b - b1).abs()) * (12.0 / 384.0);
    let discriminant = (b * b - 4.0 * a * c).max(0.0).sqrt();
    let q = -0.5 * (b + if b < 0.0 { -discriminant } else { discriminant });
    let within = |s: f64| (0.0..=1.0).contains(&s);
    let s = if within(c / q) { c / q } else { q / a };
    if !within(s) {
        return true;
    }
    let crest = v0 + s * (c + s * (0.5 * b + s * a / 3.0));
    let doubt = DOUBT * off + 0.1 * (crest - v0).abs().min((crest - v1).abs());
    !(crest < known[1] - doubt && crest > known[0] + doubt)
}

/// The motion where the derivative of `order` has a crest between two nodes, behind the first of which it goes `onwards` and before
/// the second the other way: Newton, kept within by bisection.
fn turning_point(order: usize, onwards: f64, low: Node, high: Node, mut at: impl FnMut(f64) -> Motion) -> Motion {
    // From the straight line between the slopes at both ends; of what starts at rest, from the middle.
    let slope = low.motion[order + 1];
    let share = if slope == 0.0 { 0.5 } else { slope / (slope - high.motion[order + 1]) };
    let (mut low, mut high) = (low.time, high.time);
    let mut t = low + share * (high - low);
    let mut motion = at(t);
    for _ in 0..60 {
        if motion[order + 1] * onwards > 0.0 {
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
