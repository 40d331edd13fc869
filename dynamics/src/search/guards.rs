//! The guards of a contact state, as signals of its flow.
//!
//! | contact | guards (positive while it holds) |
//! |---|---|
//! | flight | u, −w |
//! | pressed | compression (or the push, if the face cannot pull), distance to the stop |
//! | held | push per mass: ±(φ·q″ + g) − kδ/mp |
//! | released, still compressed | compression, minus the push that would come back |
//!
//! Where floor and ceiling do not move as one, the face across has guards too: the way to it, or those of a face that touches.

use crate::arithmetic::matrix::dot;
use crate::contact::{Change, Crossing, Hold, Relative, Side, spring_on_stop};
use crate::contact_state::constant_across;
use crate::flow::Flow;
use crate::flow::parabola::Parabola;
use crate::flow::signals::{AcrossRows, Signals, Watched};
use crate::search::window::Start;
use crate::search::{Guard, Search};
use crate::system::{Contact, HybridSystem, Law, Particle};

/// State of the particles, as the guards need it.
#[derive(Clone, Copy)]
pub(crate) struct Contacts<'a> {
    pub(crate) system: &'a HybridSystem,
    pub(crate) flow: &'a Flow,
    pub(crate) signals: &'a Signals,
    pub(crate) contacts: &'a [Contact],
    pub(crate) particles: &'a [Relative],
    /// Let go smoothly: the first derivative that is not zero is of higher order.
    pub(crate) smooth: &'a [bool],
    /// What has just happened at the face across from that of a particle.
    pub(crate) slipped: Option<Slipped>,
    pub(crate) q: &'a [f64],
    pub(crate) rate: &'a [f64],
    /// Some floor and ceiling do not move as one.
    pub(crate) has_walls: bool,
    /// All faces can pull, and none has a stop.
    pub(crate) plain: bool,
}

impl<'a> Contacts<'a> {
    /// q and q′, where the ceiling of a particle moves by itself.
    fn structure(&self, particle: &Particle) -> Option<[&'a [f64]; 2]> {
        (self.has_walls && particle.has_walls()).then_some([self.q, self.rate])
    }
}

/// The face across has just let a particle go, or pushes it again, where its force or their relative speed is zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Slipped {
    pub(crate) particle: usize,
    /// The first derivative of their distance that is not zero, where that is zero itself.
    pub(crate) order: usize,
}

/// Sets the guards of every particle; remembers the path of those in flight.
#[inline(always)]
pub(crate) fn set(state: Contacts<'_>, search: &mut Search, paths: &mut [Parabola]) {
    search.guards.clear();
    for (j, particle) in state.system.particles.iter().enumerate() {
        let contact = state.contacts[j];
        let guards = &mut search.guards;
        match contact {
            Contact::Flight => paths[j] = in_flight(state, j, guards),
            Contact::FloorReleased | Contact::CeilingReleased | Contact::BothReleased => {
                paths[j] = released(state, j, guards);
            }
            _ if contact.presses(particle) => pressed(state, j, guards),
            _ => held(state, j, guards),
        }
        if state.has_walls
            && let Some(rows) = state.flow.rows.guards[j].across
        {
            across(state, j, rows, &mut search.guards);
        }
    }
}

impl Guard {
    /// Of a distance, whose clearance counts as a margin.
    #[inline(always)]
    fn distance(
        particle: usize,
        crossing: Crossing,
        signal: usize,
        sign: f64,
        parabola: Parabola,
        start: Start,
    ) -> Self {
        Self { particle, crossing, signal, sign, parabola, start, distance: true }
    }

    /// Of a force or an acceleration.
    #[inline(always)]
    fn force(particle: usize, crossing: Crossing, signal: usize, sign: f64, parabola: Parabola, start: Start) -> Self {
        Self { distance: false, ..Self::distance(particle, crossing, signal, sign, parabola, start) }
    }

    /// Of the whole system: positive while the base acceleration keeps its sign.
    pub(crate) fn half_cycle(signal: usize, sign: f64, touching: bool) -> Self {
        Self::force(usize::MAX, Crossing::HalfCycle, signal, sign, Parabola::default(), touching_once(touching))
    }
}

/// The parabola of a gap in flight. The particle falls by itself and the blocks of the face are taken off it, so that the
/// start is kept to the bit; a face that drifts with its structure takes the frame along, and no digit is lost to distance.
#[inline]
fn flight_path(face: Watched<'_>, here: Relative, gravity: f64) -> Parabola {
    Parabola { p0: here.gap + face.sum.value, p1: here.rate + face.sum.rate, p2: -0.5 * gravity - face.rest.p2 }
}

/// radius·t below which the fifth derivative of a gap moves nothing: a gap is followed by its derivatives, as the sum of its parts would
/// be all rounding.
pub(crate) const SHORT: f64 = 1e-3;

/// A gap after a short time, from where it is: its acceleration is `constant` plus `sign` times that of the shares.
#[cold]
pub(crate) fn creep(flow: &Flow, constant: f64, sign: f64, signal: Watched<'_>, here: Relative, time: f64) -> Relative {
    let mut derivatives = [constant, 0.0, 0.0, 0.0];
    for (block, phase) in flow.blocks.iter().zip(signal.each()) {
        if !block.is_drift() {
            let bend = block.acceleration(phase);
            let snap = block.acceleration(bend);
            for (sum, term) in derivatives.iter_mut().zip([bend.value, bend.rate, snap.value, snap.rate]) {
                *sum += sign * term;
            }
        }
    }
    let [d2, d3, d4, d5] = derivatives;
    Relative {
        gap: here.gap
            + time * (here.rate + time * (d2 / 2.0 + time * (d3 / 6.0 + time * (d4 / 24.0 + time * (d5 / 120.0))))),
        rate: here.rate + time * (d2 + time * (d3 / 2.0 + time * (d4 / 6.0 + time * (d5 / 24.0)))),
    }
}

/// The gap coordinate of particle j's flight after a time, when the blocks are at `c`: the same numbers that the structure is at, so
/// that nothing but chance is in their difference.
#[inline(always)]
pub(crate) fn fly(
    flow: &Flow,
    j: usize,
    path: Parabola,
    signals: &Signals,
    here: Relative,
    c: &[f64],
    time: f64,
) -> Relative {
    let row = flow.rows.guards[j].first;
    if flow.turns_below(SHORT, time) {
        return creep(flow, 2.0 * path.p2, -1.0, signals.of(row), here, time);
    }
    let face = flow.rows.row(row).shares(c);
    Relative { gap: path.at(time) - face.value, rate: path.rate(time) - face.rate }
}

/// Σ |φ x|.
fn magnitude(row: &[f64], x: &[f64]) -> f64 {
    row.iter().zip(x).fold(0.0, |sum, (phi, x)| sum + (phi * x).abs())
}

/// How the guard of a distance starts, which grows with `rate`: at zero if it is zero, or if it grows and is no more than rounding. `size`
/// is that of the lengths whose difference it is.
#[inline]
fn start(distance: f64, rate: f64, smooth: bool, signal: Watched<'_>, size: f64) -> Start {
    if distance != 0.0 {
        if rate > 0.0 && distance.abs() < signal.noise() + 4.0 * f64::EPSILON * size {
            return Start::Touching { order: 1, slope: rate };
        }
        return Start::Apart;
    }
    if smooth {
        Start::Touching { order: 3, slope: 0.0 }
    } else if rate < 0.0 {
        // It is due at this instant, like another that came first.
        Start::Apart
    } else if rate == 0.0 {
        Start::Touching { order: 2, slope: 0.0 }
    } else {
        Start::Touching { order: 1, slope: rate }
    }
}

/// A particle in flight relative to its ceiling; what rounding has left of rest there is rest. `structure` is q and q′ where the
/// ceiling moves by itself.
#[inline]
pub(crate) fn above(particle: &Particle, here: Relative, structure: Option<[&[f64]; 2]>) -> Option<Relative> {
    let ceiling = particle.ceiling.as_ref()?;
    let Some([q, q_rate]) = structure else {
        return Some(Relative { gap: here.gap - particle.gap, rate: here.rate });
    };
    let shift = |x: &[f64]| dot(&ceiling.row, x) - dot(&particle.floor.row, x);
    let size = |x: &[f64]| [&ceiling.row, &particle.floor.row].map(|row| magnitude(row, x)).iter().sum::<f64>();
    let known = |value: f64, size: f64| if value.abs() <= 4.0 * f64::EPSILON * size { 0.0 } else { value };
    Some(Relative {
        gap: known(here.gap - particle.gap - shift(q), particle.gap + size(q)),
        rate: known(here.rate - shift(q_rate), size(q_rate)),
    })
}

#[inline(always)]
fn in_flight(state: Contacts<'_>, j: usize, guards: &mut Vec<Guard>) -> Parabola {
    let Contacts { system, flow, signals, .. } = state;
    let particle = &system.particles[j];
    let here = state.particles[j];
    let gravity = state.system.gravity;
    let rows = flow.rows.guards[j];
    let face = signals.of(rows.first);
    let path = flight_path(face, here, gravity);
    // u = path − blocks.
    let begin = start(here.gap, here.rate, state.smooth[j], face, 0.0);
    guards.push(Guard::distance(j, Crossing::To(Side::Floor), rows.first, -1.0, path, begin));
    let structure = state.structure(particle);
    let Some(relative) = above(particle, here, structure) else { return path };
    let (above, face) = if structure.is_some() {
        let face = signals.of(rows.second);
        (flight_path(face, relative, gravity), face)
    } else {
        (Parabola { p0: path.p0 - particle.gap, ..path }, face)
    };
    let begin = start(-relative.gap, -relative.rate, state.smooth[j], face, particle.gap);
    guards.push(Guard::distance(j, Crossing::To(Side::Ceiling), rows.second, 1.0, above.times(-1.0), begin));
    path
}

fn released(state: Contacts<'_>, j: usize, guards: &mut Vec<Guard>) -> Parabola {
    let Contacts { system, flow, signals, .. } = state;
    let particle = &system.particles[j];
    let side = state.contacts[j].side();
    let away = side.away();
    let rows = flow.rows.guards[j];
    let path = flight_path(signals.of(rows.first), state.particles[j], state.system.gravity);
    // Compression, −u at the floor; u = path − blocks.
    let recovers = Crossing::Own(Change::Recovers);
    guards.push(Guard::distance(j, recovers, rows.first, away, path.times(-away), Start::Apart));
    if let Law::Resilient { stiffness, .. } = side.face(particle).law {
        let damping = flow.modes.damping[j];
        let force = path.spring_and_dashpot(stiffness, damping).times(away);
        let begin = force_start(state.particles[j], stiffness, damping, state.smooth[j], signals.of(rows.second));
        guards.push(Guard::force(j, Crossing::Own(Change::PushesAgain), rows.second, -away, force, begin));
    }
    path
}

#[inline(always)]
fn pressed(state: Contacts<'_>, j: usize, guards: &mut Vec<Guard>) {
    let Contacts { system, flow, signals, .. } = state;
    let particle = &system.particles[j];
    let here = state.particles[j];
    let side = state.contacts[j].side();
    let away = side.away();
    let rows = flow.rows.guards[j];
    let own = signals.of(rows.first);
    let mut rest = own.rest;
    let law = &side.face(particle).law;
    // The start is known to the bit; what the blocks make of it would hide a contact that lasts a nanosecond.
    rest.p0 = here.gap - own.sum.value;
    if here.gap == 0.0 {
        rest.p1 = here.rate - own.sum.rate;
    }
    let releases = Crossing::Own(Change::Releases);
    guards.push(match law {
        Law::Resilient { no_tension: true, stiffness, .. } if !state.plain => {
            let (damping, push) = (flow.modes.damping[j], signals.of(rows.second));
            let force = Parabola { p0: stiffness * here.gap + damping * here.rate - push.sum.value, ..push.rest };
            let begin = force_start(here, *stiffness, damping, state.smooth[j], push);
            Guard::force(j, releases, rows.second, -away, force.times(-away), begin)
        }
        _ => {
            let begin = start(-away * here.gap, -away * here.rate, state.smooth[j], own, 0.0);
            Guard::distance(j, releases, rows.first, -away, rest.times(-away), begin)
        }
    });
    if !state.plain
        && let Some(stop) = law.stop()
    {
        // Positive until the compression is δ.
        let left = Parabola { p0: away * rest.p0 + stop.length, ..rest.times(away) };
        let begin = start(away * here.gap + stop.length, away * here.rate, state.smooth[j], own, stop.length);
        guards.push(Guard::distance(j, Crossing::Own(Change::Stops), rows.first, away, left, begin));
    }
}

/// The face across, which moves by itself: the way to it, or what it does to a particle that is at both.
#[cold]
fn across(state: Contacts<'_>, j: usize, rows: AcrossRows, guards: &mut Vec<Guard>) {
    let Contacts { system, flow, signals, .. } = state;
    let particle = &system.particles[j];
    let contact = state.contacts[j];
    let side = contact.side().opposite();
    let signal = signals.of(rows.way);
    // The distance v to the face, as parabola + sign × signal.
    let (way, sign, now) = if contact.face(particle).is_some() {
        let way = Parabola { p0: signal.rest.p0 + constant_across(particle, contact), ..signal.rest };
        (way, 1.0, Relative { gap: way.p0 + signal.sum.value, rate: way.p1 + signal.sum.rate })
    } else {
        let here = seen_from(side, particle, state.particles[j], state.q, state.rate);
        let away = side.away();
        let path = flight_path(signal, here, state.system.gravity);
        (path.times(away), -away, Relative { gap: away * here.gap, rate: away * here.rate })
    };
    // What it is the difference of, and the way in the rounding of an instant.
    let places = magnitude(&particle.floor.row, state.q) + magnitude(&side.face(particle).row, state.q);
    let size = 4.0 * (particle.gap + places + now.rate.abs() * state.system.drive.period);
    let slipped = state.slipped.filter(|slipped| slipped.particle == j);
    let apart = || match slipped {
        Some(Slipped { order, .. }) => Start::Touching { order, slope: 0.0 },
        None => start(now.gap, now.rate, false, signal, size),
    };
    let guard =
        |change, parabola, sign, start| Guard::distance(j, Crossing::Across(change), rows.way, sign, parabola, start);
    let Law::Resilient { stiffness, no_tension, stop, .. } = side.face(particle).law else {
        guards.push(guard(Change::Meets, way, sign, apart()));
        return;
    };
    let damping = flow.modes.across(j).map_or(0.0, |across| across.damping);
    // k v + c v′, zero where the push is: its sign folded in by `pushes`.
    let force = |change, pushes: f64| {
        let begin = match force_start(now, stiffness, damping, slipped.is_some(), signals.of(rows.force)) {
            Start::Apart
                if (stiffness * now.gap + damping * now.rate).abs() < 4.0 * f64::EPSILON * stiffness * size =>
            {
                touching_once(true)
            }
            start => start,
        };
        let parabola = way.spring_and_dashpot(stiffness, damping).times(-pushes);
        Guard::force(j, Crossing::Across(change), rows.force, -pushes * sign, parabola, begin)
    };
    match contact.across() {
        Hold::Away | Hold::Held => {
            guards.push(guard(Change::Meets, way, sign, apart()));
        }
        Hold::Pressed => {
            if no_tension {
                guards.push(force(Change::Releases, 1.0));
            } else {
                let begin = start(-now.gap, -now.rate, false, signal, size);
                guards.push(guard(Change::Releases, way.times(-1.0), -sign, begin));
            }
            if let Some(stop) = stop {
                let left = Parabola { p0: way.p0 + stop.length, ..way };
                let begin = start(now.gap + stop.length, now.rate, false, signal, size + stop.length);
                guards.push(guard(Change::Stops, left, sign, begin));
            }
        }
        Hold::Released => {
            guards.push(guard(Change::Recovers, way.times(-1.0), -sign, Start::Apart));
            guards.push(force(Change::PushesAgain, -1.0));
        }
    }
}

/// The state of a particle that refers to the other face, referred to the one on this side.
pub(crate) fn seen_from(side: Side, particle: &Particle, here: Relative, q: &[f64], q_rate: &[f64]) -> Relative {
    let [Some(lift), Some(rate)] = [q, q_rate].map(|x| particle.lift(x)) else { return here };
    let away = side.away();
    Relative { gap: here.gap + away * (particle.gap + lift), rate: here.rate + away * rate }
}

fn held(state: Contacts<'_>, j: usize, guards: &mut Vec<Guard>) {
    let Contacts { system, flow, signals, .. } = state;
    let particle = &system.particles[j];
    if particle.is_enclosed() {
        return;
    }
    let side = state.contacts[j].side();
    let signal = flow.rows.guards[j].first;
    let rest = signals.of(signal).rest;
    let offset = rest.p0 + state.system.gravity - side.away() * spring_on_stop(particle, side);
    let mut parabola = Parabola { p0: side.away() * offset, p1: 0.0, p2: 0.0 };
    if let Some(across) = flow.modes.across(j).filter(|across| across.presses) {
        // What the face across pushes.
        let push = Parabola { p0: across.constant * across.stiffness, ..Parabola::default() };
        let moving = Parabola { p0: 0.0, ..rest };
        parabola = parabola.plus(moving.times(side.away())).plus(push.times(-1.0 / particle.mass));
    }
    let (releases, begin) = (Crossing::Own(Change::Releases), touching_once(state.smooth[j]));
    guards.push(Guard::force(j, releases, signal, side.away(), parabola, begin));
}

/// How the force of spring and dashpot starts: at zero where the contact has just begun or ended smoothly, and where it
/// begins without dashpot or at rest; then with the first derivative that the motion has. A force that is nothing but rounding
/// of its shares is zero too: what it does next, its derivative says.
fn force_start(here: Relative, stiffness: f64, damping: f64, smooth: bool, signal: Watched<'_>) -> Start {
    let (spring, dashpot) = (stiffness * here.gap, damping * here.rate);
    let force = spring + dashpot;
    if force != 0.0 && force.abs() < signal.noise() {
        return touching_once(true);
    }
    // Where it began or ended smoothly the two cancel, as well as the instant of a contact of nanoseconds is known.
    if force != 0.0 && !(smooth && force.abs() < 1e-3 * (spring.abs() + dashpot.abs())) {
        return Start::Apart;
    }
    // At the face itself u grows with t, t² or t³ (at rest, smoothly), and the force of the dashpot with one less.
    let motion = match (here == Relative::default(), smooth) {
        (false, _) => return touching_once(true),
        (true, false) => 2,
        (true, true) => 3,
    };
    Start::Touching { order: if damping > 0.0 { motion - 1 } else { motion }, slope: f64::NAN }
}

fn touching_once(touching: bool) -> Start {
    if touching { Start::Touching { order: 1, slope: f64::NAN } } else { Start::Apart }
}
