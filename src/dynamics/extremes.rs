//! The range of an observed motion: its largest and smallest displacement and velocity, on the exact flow.
//!
//! A segment is walked in steps short against everything that still moves; where a derivative changes its sign within a step, the
//! instant is closed in on. A pair of extrema within one step, which escapes that, differs by far less than the range.

use super::block::{Block, Phase};
use super::parabola::Parabola;

/// Steps a radian of the fastest block that moves visibly.
const STEPS_A_RADIAN: f64 = 4.0;
/// Share of the whole below which a block does not move visibly.
const INVISIBLE: f64 = 1e-13;
/// Most steps of a segment.
const MOST_STEPS: f64 = 1e6;

/// Displacement, velocity, acceleration and its rate.
type Motion = [f64; 4];

/// The range of an observed motion; lowest and highest value, NaN where nobody looked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// m.
    pub displacement: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
}

impl Default for Extremes {
    fn default() -> Self {
        Self { displacement: [f64::NAN; 2], velocity: [f64::NAN; 2] }
    }
}

impl Extremes {
    /// Takes an instant into the range.
    pub(crate) fn take(&mut self, displacement: f64, velocity: f64) {
        // The smaller of NaN and a number is the number.
        for (range, value) in [(&mut self.displacement, displacement), (&mut self.velocity, velocity)] {
            *range = [range[0].min(value), range[1].max(value)];
        }
    }
}

/// Takes the segment of `length` seconds that starts with these phases into the range.
pub(crate) fn take(extremes: &mut Extremes, blocks: &[Block], start: &[Phase], rest: Parabola, length: f64) {
    let at = |t: f64| -> Motion {
        let mut motion = [rest.at(t), rest.rate(t), 2.0 * rest.p2, 0.0];
        for (block, phase) in blocks.iter().zip(start) {
            let now = block.advance(*phase, block.kernel(t));
            let bend = block.acceleration(now);
            motion[0] += now.value;
            motion[1] += now.rate;
            motion[2] += bend.value;
            motion[3] += bend.rate;
        }
        motion
    };
    let speed = |(block, phase): (&Block, &Phase)| (phase.value * block.radius).abs().max(phase.rate.abs());
    let whole: f64 = blocks.iter().zip(start).map(speed).sum();
    let fastest = blocks
        .iter()
        .zip(start)
        .filter(|pair| speed(*pair) > INVISIBLE * whole)
        .fold(0.0_f64, |fastest, (block, _)| fastest.max(block.radius));
    let steps = (STEPS_A_RADIAN * fastest * length).ceil().clamp(1.0, MOST_STEPS);
    let mut here = (0.0, at(0.0));
    extremes.take(here.1[0], here.1[1]);
    for step in 1..=steps as u64 {
        let t = if step as f64 == steps { length } else { length * (step as f64 / steps) };
        let next = (t, at(t));
        extremes.take(next.1[0], next.1[1]);
        for order in [0, 1] {
            if here.1[order + 1] * next.1[order + 1] < 0.0 {
                let turn = at(turning_point(&at, order, here, next));
                extremes.take(turn[0], turn[1]);
            }
        }
        here = next;
    }
}

/// Where the derivative of `order` vanishes between two instants at which its signs differ: Newton, kept within by
/// bisection. Quadratic in the instant's error, the value there is exact long before the instant is.
fn turning_point(at: &impl Fn(f64) -> Motion, order: usize, low: (f64, Motion), high: (f64, Motion)) -> f64 {
    let (mut low, mut high, sign) = (low.0, high.0, low.1[order + 1]);
    let mut t = 0.5 * (low + high);
    for _ in 0..60 {
        let motion = at(t);
        if motion[order + 1] * sign > 0.0 {
            low = t
        } else {
            high = t
        }
        let newton = t - motion[order + 1] / motion[order + 2];
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= 1e-9 * (high - low).max(t.abs() * 1e-6) || next == t {
            return next;
        }
        t = next;
    }
    t
}
