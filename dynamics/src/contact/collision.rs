//! Impacts at one instant: which of the closed contacts push, and how hard.
//!
//! Particles that strike the same structure at the same instant, or rest on it while another one strikes, act on each other
//! through it. With v the speeds along the normals, positive apart, Newton's restitution for each contact, and impulses that
//! push and never pull (Moreau, in: Nonsmooth Mechanics and Applications, 1988):
//!
//! v⁺ = v⁻ + (1 + S m) p,   p ≥ 0,   v⁺ ≥ r,   p·(v⁺ − r) = 0,
//!
//! p the impulses per particle mass, Sᵢₖ the structure's answer at face i to a unit impulse at face k, and r = −ε v⁻ where v⁻ is
//! an approach, 0 elsewhere. All principal minors of 1 + S m are positive, so that there is exactly one solution, whatever
//! the order of the contacts; Murty's least-index pivoting finds it (Oper. Res. 22, 1974).

use crate::arithmetic::few::Few;
use crate::arithmetic::gauss::eliminate;

/// A rigid contact that is closed at the instant of the collision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Closed {
    /// mp, kg.
    pub(crate) mass: f64,
    /// v⁻, m/s.
    pub(crate) speed: f64,
    /// ε.
    pub(crate) restitution: f64,
    /// A particle without a gap between its faces, which push it both ways.
    pub(crate) both_ways: bool,
}

/// What the collision does to one contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Outcome {
    /// Impulse on the particle, away from the face, N s.
    pub(crate) impulse: f64,
    /// v⁺, m/s.
    pub(crate) speed: f64,
    /// The face has pushed.
    pub(crate) pushed: bool,
}

impl Closed {
    /// The particle moves into the face.
    pub(crate) fn is_struck(&self) -> bool {
        self.speed < 0.0 || (self.both_ways && self.speed != 0.0)
    }

    /// r.
    fn least(&self) -> f64 {
        if self.speed < 0.0 { -self.restitution * self.speed } else { 0.0 }
    }
}

/// Solves the collision; `answers` is S, row by row.
pub(crate) fn collide(closed: &[Closed], answers: &[f64]) -> Few<Outcome> {
    let count = closed.len();
    let least: Few<f64> = closed.iter().map(Closed::least).collect();
    let fastest = closed.iter().fold(0.0_f64, |fastest, contact| fastest.max(contact.speed.abs()));
    let doubt = 1e-15 * fastest;
    let mut pushes = Few::from_elem(true, count);
    let mut impulses = push(closed, answers, &pushes, &least);
    // Finite by its nature; the bound is for speeds that are no numbers.
    for _ in 0..1_usize << count.min(16) {
        let speeds = speeds(closed, answers, &impulses);
        let wrong = |i: usize| {
            if pushes[i] { !closed[i].both_ways && impulses[i] < -doubt } else { speeds[i] < least[i] - doubt }
        };
        let Some(i) = (0..count).find(|&i| wrong(i)) else { break };
        pushes[i] = !pushes[i];
        impulses = push(closed, answers, &pushes, &least);
    }
    let speeds = speeds(closed, answers, &impulses);
    (0..count)
        .map(|i| Outcome {
            impulse: impulses[i] * closed[i].mass,
            speed: if pushes[i] { least[i] } else { speeds[i] },
            pushed: pushes[i],
        })
        .collect()
}

/// p where the contacts in `pushes` reach the speeds `wanted` and the others do nothing.
pub(crate) fn push(closed: &[Closed], answers: &[f64], pushes: &[bool], wanted: &[f64]) -> Few<f64> {
    let count = closed.len();
    let active: Few<usize> = (0..count).filter(|&i| pushes[i]).collect();
    let mut rows: Few<Few<f64>> = active
        .iter()
        .map(|&i| {
            let own = |k: usize| if i == k { 1.0 } else { 0.0 };
            let row = active.iter().map(|&k| own(k) + answers[i * count + k] * closed[k].mass);
            row.chain([wanted[i] - closed[i].speed]).collect()
        })
        .collect();
    let mut impulses = Few::from_elem(0.0, count);
    eliminate(&mut rows);
    for (i, row) in active.iter().zip(&rows) {
        impulses[*i] = row[active.len()];
    }
    impulses
}

/// v⁺.
fn speeds(closed: &[Closed], answers: &[f64], impulses: &[f64]) -> Few<f64> {
    let count = closed.len();
    let after = |i: usize| {
        (0..count)
            .fold(closed[i].speed + impulses[i], |sum, k| sum + answers[i * count + k] * closed[k].mass * impulses[k])
    };
    (0..count).map(after).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(mass: f64, speed: f64, restitution: f64) -> Closed {
        Closed { mass, speed, restitution, both_ways: false }
    }

    #[test]
    fn two_balls_that_strike_a_free_plate_at_once_are_one_ball_of_both_masses() {
        // Plate of 2 kg; both contacts at its centre.
        let answers = [0.5; 4];
        let outcome = collide(&[ball(0.3, -1.0, 0.6), ball(0.5, -1.0, 0.6)], &answers);
        let one = collide(&[ball(0.8, -1.0, 0.6)], &[0.5]);
        assert!((outcome[0].impulse + outcome[1].impulse - one[0].impulse).abs() < 1e-15);
        assert_eq!(outcome[0].speed, 0.6);
    }

    #[test]
    fn a_ball_at_rest_is_left_where_the_blow_of_another_takes_its_floor_away() {
        // The second lies where the structure answers along with the first: its floor is driven down.
        let along = collide(&[ball(0.3, -1.0, 0.0), ball(0.5, 0.0, 0.0)], &[1.0, 0.5, 0.5, 1.0]);
        assert!(!along[1].pushed && along[1].speed > 0.0 && along[1].impulse == 0.0);
        // And where it answers the other way round: its floor comes up and carries it.
        let against = collide(&[ball(0.3, -1.0, 0.0), ball(0.5, 0.0, 0.0)], &[1.0, -0.5, -0.5, 1.0]);
        assert!(against[1].pushed && against[1].speed == 0.0 && against[1].impulse > 0.0);
    }
}
