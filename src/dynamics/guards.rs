//! The guards of a contact state, as signals of its flow.
//!
//! | contact | guards (positive while it holds) |
//! |---|---|
//! | flight | u, −w |
//! | pressed | compression (or the push, if the face cannot pull), distance to the stop |
//! | held | push per mass: ±(φ·q″ + g) − kδ/mp |
//! | released, still compressed | compression, minus the push that would come back |

use super::block::{Block, Phase};
use super::contact::{Crossing, Relative, Side};
use super::flow::{Flow, Parabola, Signals};
use super::search::{Guard, Search};
use super::system::{Contact, HybridSystem, Law, Particle, dot};
use super::window::Start;

/// What the guards of one segment lead to, by their labels: particle and crossing.
pub(crate) type Crossings = Vec<(usize, Crossing)>;

/// State of the particles, as the guards need it.
#[derive(Clone, Copy)]
pub(crate) struct Contacts<'a> {
    pub(crate) system: &'a HybridSystem,
    pub(crate) contacts: &'a [Contact],
    pub(crate) particles: &'a [Relative],
    pub(crate) damping: &'a [f64],
    /// Let go smoothly: the first derivative that is not zero is of higher order.
    pub(crate) smooth: &'a [bool],
    pub(crate) q: &'a [f64],
    pub(crate) rate: &'a [f64],
}

/// A guard under construction: sign × (parabola + phases).
struct Draft<'a> {
    sign: f64,
    parabola: Parabola,
    phases: &'a [Phase],
    start: Start,
    distance: bool,
}

/// Sets the guards of every particle; remembers the path of those in flight.
pub(crate) fn set(
    state: Contacts<'_>,
    flow: &Flow,
    signals: &Signals,
    search: &mut Search,
    crossings: &mut Crossings,
    paths: &mut [Parabola],
) {
    search.clear();
    crossings.clear();
    for (j, particle) in state.system.particles.iter().enumerate() {
        let contact = state.contacts[j];
        let mut push = |crossing: Crossing, draft: Draft<'_>| add(search, crossings, (j, crossing), &draft);
        match contact {
            Contact::Flight => paths[j] = in_flight(state, j, particle, flow, signals, &mut push),
            Contact::FloorReleased | Contact::CeilingReleased => {
                paths[j] = released(state, j, particle, flow, signals, &mut push);
            }
            _ if contact.presses(particle) => pressed(state, j, particle, flow, signals, &mut push),
            _ => held(state, j, particle, flow, signals, &mut push),
        }
    }
}

/// Adds one guard of the whole system: positive while the observed acceleration keeps its sign.
pub(crate) fn half_cycle(
    flow: &Flow,
    signals: &Signals,
    sign: f64,
    touching: bool,
    search: &mut Search,
    crossings: &mut Crossings,
) {
    let bends = accelerations(&flow.blocks, signals.of(flow.observed).0);
    let start = if touching { Start::Touching { order: 1, slope: f64::NAN } } else { Start::Apart };
    let draft = Draft { sign, parabola: Parabola::default(), phases: &bends, start, distance: false };
    add(search, crossings, (usize::MAX, Crossing::HalfCycle), &draft);
}

#[inline]
fn add(search: &mut Search, crossings: &mut Crossings, place: (usize, Crossing), draft: &Draft<'_>) {
    let Draft { sign, parabola, phases, start, distance } = *draft;
    search.initial.extend(phases.iter().map(|phase| Phase { value: sign * phase.value, rate: sign * phase.rate }));
    let parabola = Parabola { p0: sign * parabola.p0, p1: sign * parabola.p1, p2: sign * parabola.p2 };
    search.guards.push(Guard { label: crossings.len(), parabola, start, distance });
    crossings.push(place);
}

/// The parabola of a gap in flight. The particle falls by itself and the blocks of the face are taken off it, so that the
/// start is kept to the bit; a face that drifts with its structure takes the frame along, and no digit is lost to distance.
#[inline]
fn flight_path(flow: &Flow, rest: Parabola, phases: &[Phase], here: Relative, gravity: f64) -> Parabola {
    let mut path = Parabola { p0: here.gap, p1: here.rate, p2: -0.5 * gravity - rest.p2 };
    for (block, phase) in flow.blocks.iter().zip(phases) {
        if !block.is_drift() {
            path.p0 += phase.value;
            path.p1 += phase.rate;
        }
    }
    path
}

/// radius·t below which a flight's fifth derivative moves nothing.
const SHORT_FLIGHT: f64 = 1e-3;

/// A flight so short that the difference of parabola and blocks would be all rounding: by its derivatives.
#[cold]
fn fly_shortly(flow: &Flow, path: Parabola, phases: &[Phase], here: Relative, time: f64) -> Relative {
    let mut derivatives = [2.0 * path.p2, 0.0, 0.0, 0.0];
    for (block, phase) in flow.blocks.iter().zip(phases) {
        if !block.is_drift() {
            let bend = block.acceleration(*phase);
            let snap = block.acceleration(bend);
            for (sum, term) in derivatives.iter_mut().zip([bend.value, bend.rate, snap.value, snap.rate]) {
                *sum -= term;
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

/// The gap coordinate of a flight after the time of `kernels`.
#[inline]
pub(crate) fn fly(
    flow: &Flow,
    path: Parabola,
    phases: &[Phase],
    here: Relative,
    kernels: &[super::block::Kernel],
    time: f64,
) -> Relative {
    if flow.blocks.iter().all(|block| block.radius * time < SHORT_FLIGHT) {
        return fly_shortly(flow, path, phases, here, time);
    }
    let mut now = Relative { gap: path.at(time), rate: path.rate(time) };
    for ((block, phase), kernel) in flow.blocks.iter().zip(phases).zip(kernels) {
        if !block.is_drift() {
            let share = block.advance(*phase, *kernel);
            now.gap -= share.value;
            now.rate -= share.rate;
        }
    }
    now
}

/// How a distance starts that grows with `rate`: at zero where it is, or where it is nothing but rounding and grows.
#[inline]
fn start(distance: f64, rate: f64, smooth: bool, phases: &[Phase]) -> Start {
    if distance != 0.0 {
        let noise = 4.0 * f64::EPSILON * phases.iter().fold(0.0, |sum, phase| sum + phase.value.abs());
        if rate > 0.0 && distance.abs() < noise {
            return Start::Touching { order: 1, slope: rate };
        }
        return Start::Apart;
    }
    if smooth {
        Start::Touching { order: 3, slope: 0.0 }
    } else if rate == 0.0 {
        Start::Touching { order: 2, slope: 0.0 }
    } else {
        Start::Touching { order: 1, slope: rate.abs() }
    }
}

#[inline]
fn in_flight(
    state: Contacts<'_>,
    j: usize,
    particle: &Particle,
    flow: &Flow,
    signals: &Signals,
    push: &mut impl FnMut(Crossing, Draft<'_>),
) -> Parabola {
    let here = state.particles[j];
    let gravity = state.system.gravity;
    let (phases, rest) = signals.of(flow.face_rows[j].floor);
    let path = flight_path(flow, rest, phases, here, gravity);
    let fixed = flow.without_drift(phases);
    let phases = fixed.as_deref().unwrap_or(phases);
    let begin = start(here.gap, here.rate, state.smooth[j], phases);
    // u = path − blocks.
    let negative = Parabola { p0: -path.p0, p1: -path.p1, p2: -path.p2 };
    push(Crossing::ToFloor, Draft { sign: -1.0, parabola: negative, phases, start: begin, distance: true });
    let Some(ceiling) = &particle.ceiling else { return path };
    if ceiling.row == particle.floor.row {
        let relative = Relative { gap: here.gap - particle.gap, rate: here.rate };
        let below = Parabola { p0: particle.gap - path.p0, p1: -path.p1, p2: -path.p2 };
        let begin = start(-relative.gap, -relative.rate, state.smooth[j], phases);
        push(Crossing::ToCeiling, Draft { sign: 1.0, parabola: below, phases, start: begin, distance: true });
    } else {
        let shift = |x: &[f64]| dot(&ceiling.row, x) - dot(&particle.floor.row, x);
        let relative = Relative { gap: here.gap - particle.gap - shift(state.q), rate: here.rate - shift(state.rate) };
        let (phases, rest) = signals.of(flow.face_rows[j].ceiling);
        let above = flight_path(flow, rest, phases, relative, gravity);
        let fixed = flow.without_drift(phases);
        let phases = fixed.as_deref().unwrap_or(phases);
        let below = Parabola { p0: -above.p0, p1: -above.p1, p2: -above.p2 };
        let begin = start(-relative.gap, -relative.rate, state.smooth[j], phases);
        push(Crossing::ToCeiling, Draft { sign: 1.0, parabola: below, phases, start: begin, distance: true });
    }
    path
}

fn released(
    state: Contacts<'_>,
    j: usize,
    particle: &Particle,
    flow: &Flow,
    signals: &Signals,
    push: &mut impl FnMut(Crossing, Draft<'_>),
) -> Parabola {
    let side = state.contacts[j].side();
    let away = side.away();
    let (phases, rest) = signals.of(face_row(flow, j, side));
    let path = flight_path(flow, rest, phases, state.particles[j], state.system.gravity);
    let fixed = flow.without_drift(phases);
    let phases = fixed.as_deref().unwrap_or(phases);
    // Compression, −u at the floor; u = path − blocks.
    let negative = Parabola { p0: -path.p0, p1: -path.p1, p2: -path.p2 };
    push(Crossing::Recovered, Draft { sign: away, parabola: negative, phases, start: Start::Apart, distance: true });
    if let Law::Resilient { stiffness, .. } = side.face(particle).law {
        let damping = state.damping[j];
        let force = spring_and_dashpot(negative, stiffness, damping);
        let mix = mixed(&flow.blocks, phases, stiffness, damping);
        let begin = force_start(state.particles[j], stiffness, damping, state.smooth[j]);
        push(Crossing::Again, Draft { sign: -away, parabola: force, phases: &mix, start: begin, distance: false });
    }
    path
}

#[inline]
fn pressed(
    state: Contacts<'_>,
    j: usize,
    particle: &Particle,
    flow: &Flow,
    signals: &Signals,
    push: &mut impl FnMut(Crossing, Draft<'_>),
) {
    let here = state.particles[j];
    let side = state.contacts[j].side();
    let away = side.away();
    let Some(row) = flow.face_rows[j].compression else { return };
    let (phases, rest) = signals.of(row);
    let Law::Resilient { stiffness, no_tension, stop, .. } = side.face(particle).law else { return };
    if no_tension {
        let damping = state.damping[j];
        let force = spring_and_dashpot(rest, stiffness, damping);
        let mix = mixed(&flow.blocks, phases, stiffness, damping);
        let begin = force_start(here, stiffness, damping, state.smooth[j]);
        push(Crossing::Release, Draft { sign: -away, parabola: force, phases: &mix, start: begin, distance: false });
    } else {
        let begin = start(-away * here.gap, -away * here.rate, state.smooth[j], phases);
        push(Crossing::Release, Draft { sign: -away, parabola: rest, phases, start: begin, distance: true });
    }
    if let Some(stop) = stop {
        // Positive until the compression is δ.
        let parabola = Parabola { p0: rest.p0 + away * stop.length, ..rest };
        let begin = start(away * here.gap + stop.length, away * here.rate, state.smooth[j], phases);
        push(Crossing::ToStop, Draft { sign: away, parabola, phases, start: begin, distance: true });
    }
}

fn held(
    state: Contacts<'_>,
    j: usize,
    particle: &Particle,
    flow: &Flow,
    signals: &Signals,
    push: &mut impl FnMut(Crossing, Draft<'_>),
) {
    if particle.is_enclosed() {
        return;
    }
    let side = state.contacts[j].side();
    let (phases, rest) = signals.of(face_row(flow, j, side));
    let bends = accelerations(&flow.blocks, phases);
    let offset = 2.0 * rest.p2 + state.system.gravity - side.away() * spring_on_stop(particle, side);
    let parabola = Parabola { p0: offset, p1: 0.0, p2: 0.0 };
    let begin = touching_once(state.smooth[j]);
    push(Crossing::Release, Draft { sign: side.away(), parabola, phases: &bends, start: begin, distance: false });
}

/// How the force of spring and dashpot starts: at zero where the contact has just begun or ended smoothly, and where it
/// begins without dashpot or at rest; then with the first derivative that the motion has.
fn force_start(here: Relative, stiffness: f64, damping: f64, smooth: bool) -> Start {
    let (spring, dashpot) = (stiffness * here.gap, damping * here.rate);
    let force = spring + dashpot;
    if force != 0.0 && !(smooth && force.abs() < 1e-9 * (spring.abs() + dashpot.abs())) {
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

fn face_row(flow: &Flow, j: usize, side: Side) -> usize {
    match side {
        Side::Floor => flow.face_rows[j].floor,
        Side::Ceiling => flow.face_rows[j].ceiling,
    }
}

/// kδ/mp: what the spring of a face held on its stop pushes by itself, per mass.
pub(crate) fn spring_on_stop(particle: &Particle, side: Side) -> f64 {
    match side.face(particle).law {
        Law::Resilient { stiffness, stop: Some(stop), .. } => stiffness * stop.length / particle.mass,
        _ => 0.0,
    }
}

/// How a face holds a particle that does not move against it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grip {
    /// What it can push per mass, as an acceleration: it holds while this is positive.
    pub(crate) push: f64,
    /// How fast that grows.
    growth: f64,
    /// What of it is rounding.
    noise: f64,
}

impl Grip {
    /// The grip of a face on particle j; with the particle in flight, what brings it back to the face.
    pub(crate) fn of(system: &HybridSystem, flow: &Flow, signals: &Signals, j: usize, side: Side) -> Self {
        let (phases, rest) = signals.of(face_row(flow, j, side));
        let on_stop = flow.contacts[j] == side.stopped();
        let spring = if on_stop { spring_on_stop(&system.particles[j], side) } else { 0.0 };
        let (mut bend, mut growth) = (2.0 * rest.p2, 0.0);
        let mut size = system.gravity + bend.abs() + spring;
        for (block, phase) in flow.blocks.iter().zip(phases) {
            let now = block.acceleration(*phase);
            bend += now.value;
            growth += now.rate;
            size += (2.0 * block.decay * phase.rate).abs() + (block.determinant * phase.value).abs();
        }
        Self {
            push: side.away() * (bend + system.gravity) - spring,
            growth: side.away() * growth,
            noise: 64.0 * f64::EPSILON * size,
        }
    }

    /// Whether it holds: where the push is nothing but rounding, by what it becomes.
    pub(crate) fn holds(self) -> bool {
        self.push > self.noise || (self.is_nothing() && self.growth >= 0.0)
    }

    pub(crate) fn is_nothing(self) -> bool {
        self.push.abs() <= self.noise
    }
}

/// k·p + c·p′.
fn spring_and_dashpot(p: Parabola, stiffness: f64, damping: f64) -> Parabola {
    Parabola {
        p0: stiffness * p.p0 + damping * p.p1,
        p1: stiffness * p.p1 + 2.0 * damping * p.p2,
        p2: stiffness * p.p2,
    }
}

/// k·s + c·s′ of every share.
pub(crate) fn mixed(blocks: &[Block], phases: &[Phase], stiffness: f64, damping: f64) -> Vec<Phase> {
    blocks
        .iter()
        .zip(phases)
        .map(|(block, phase)| Phase {
            value: stiffness * phase.value + damping * phase.rate,
            rate: stiffness * phase.rate + damping * block.acceleration(*phase).value,
        })
        .collect()
}

/// Second derivatives of the shares, as shares.
pub(crate) fn accelerations(blocks: &[Block], phases: &[Phase]) -> Vec<Phase> {
    blocks.iter().zip(phases).map(|(block, phase)| block.acceleration(*phase)).collect()
}
