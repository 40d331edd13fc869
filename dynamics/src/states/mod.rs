//! Contact states that were visited, kept for every run that comes to them again.
//!
//! Modes know masses, springs, dashpots and places; gap, amplitude and time do not enter, the forcing point only in a load
//! ([`crate::contact_state`]). So the thread that has run one point of a sweep, of a map or of an ensemble has at hand what
//! the next one visits. A state is built when it is visited, and the same numbers come out whether it was known or not. Where the
//! floor and the ceiling of an enclosure are alike and move as one, the structure cannot tell at which of them a particle is: the
//! contact states of both are one.

pub(crate) mod ground;

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

use crate::budget;
use crate::contact_state::conservative::Conservative;
use crate::contact_state::{Modes, dampings, feels_half_cycles};
use crate::error::EngineError;
use crate::flow::{Flow, Room};
use crate::system::{Contact, HybridSystem, Particle};
use ground::Ground;

/// Numbers that a thread keeps, about: 128 MB.
const MOST_NUMBERS: usize = 1 << 24;
/// Dampings of one contact state that are kept; half cycles give it another one each time, and hardly ever the same again.
const MOST_DAMPINGS: usize = 4;

thread_local! {
    static KNOWN: RefCell<Known> = const { RefCell::new(Known { driven: Vec::new(), numbers: 0 }) };
}

/// What a thread knows.
struct Known {
    /// The last one that was asked for comes last; it alone may have grown since it was counted.
    driven: Vec<Rc<Driven>>,
    /// Numbers of all that were counted.
    numbers: usize,
}

type ByContact<T> = RefCell<BTreeMap<Vec<Contact>, Vec<Rc<T>>>>;

/// The contact states of a system: what its gap and the size and timing of its drive do not touch.
pub(crate) struct States(Rc<Driven>);

/// What all systems of one drive share.
struct Driven {
    undriven: Rc<Undriven>,
    force_row: Vec<f64>,
    observed_rows: Vec<Vec<f64>>,
    /// φ of the base where half cycles follow it.
    base: Option<Vec<f64>>,
    frequency: Option<f64>,
    ground: Ground,
    flows: ByContact<Flow>,
    /// What it kept when it was counted, and whether contact states have come since.
    counted: Cell<usize>,
    grown: Cell<bool>,
    /// Numbers of flows when they were built, and of the ways between them, since it last forgot: about what it keeps.
    built: Cell<usize>,
    /// Some of them, each where its code leads.
    at_hand: RefCell<Vec<Option<AtHand>>>,
}

/// A contact state by its code.
#[derive(Clone)]
struct AtHand {
    code: u64,
    /// The damping that half cycles have put in the place of the stated, where one of its faces feels it.
    equivalent: Option<f64>,
    flow: Rc<Flow>,
}

/// Contact states that are at hand, at most.
const AT_HAND: usize = 256;

/// Which contact state of a system it is, four bits a particle; `None` where a number does not hold so many.
#[inline]
fn code(contacts: &[Contact]) -> Option<u64> {
    let digits = contacts.iter().rev().fold(0, |code, contact| code << 4 | *contact as u64);
    (contacts.len() <= 16).then_some(digits)
}

/// Where it is at hand.
#[inline]
fn place(code: u64) -> usize {
    (code.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 56) as usize
}

/// What systems share that differ in their drive.
struct Undriven {
    /// The first of them; nobody looks at its gaps and its drive.
    system: HybridSystem,
    /// Without dashpots.
    bare: ByContact<Conservative>,
    modes: ByContact<Modes>,
}

impl States {
    /// The states of a system: those of one that was run before, if it differs in nothing that they know.
    pub(crate) fn of(system: &HybridSystem) -> Self {
        KNOWN.with_borrow_mut(|Known { driven: known, numbers }| {
            // The next system is mostly one of the last.
            let place = known.iter().rposition(|driven| driven.fits(system));
            if let Some(last) = known.last().filter(|last| place != Some(known.len() - 1) && last.grown.take()) {
                let counted = last.counted.replace(last.size());
                *numbers = *numbers - counted + last.counted.get();
            }
            if let Some(place) = place {
                let driven = known.remove(place);
                known.push(Rc::clone(&driven));
                return Self(driven);
            }
            let same = known.iter().rev().find(|driven| driven.undriven.fits(system));
            let undriven = same.map_or_else(|| Rc::new(Undriven::new(system)), |driven| Rc::clone(&driven.undriven));
            while *numbers > MOST_NUMBERS {
                *numbers -= known.remove(0).counted.get();
            }
            let driven = Rc::new(Driven::new(system, undriven));
            known.push(Rc::clone(&driven));
            Self(driven)
        })
    }

    /// What they are set on: masses, springs and the forcing point.
    pub(crate) fn ground(&self) -> &Ground {
        &self.0.ground
    }

    /// The flow of a contact state, if it is at hand.
    #[inline]
    pub(crate) fn at_hand(&self, contacts: &[Contact], equivalent: Option<f64>) -> Option<Rc<Flow>> {
        let code = code(contacts)?;
        let at_hand = self.0.at_hand.borrow();
        let fits =
            |known: &&AtHand| known.code == code && (known.equivalent.is_none() || known.equivalent == equivalent);
        at_hand[place(code)].as_ref().filter(fits).map(|known| Rc::clone(&known.flow))
    }

    /// The flow of a contact state, built at the first visit, with the damping that half cycles have put in the place of the stated.
    pub(crate) fn flow(
        &self,
        system: &HybridSystem,
        contacts: &[Contact],
        equivalent: Option<f64>,
    ) -> Result<Rc<Flow>, EngineError> {
        let alike = contacts.iter().zip(&system.particles).map(|(contact, particle)| contact.at_floor_alike(particle));
        let alike: Vec<Contact> = alike.collect();
        let damping = dampings(system, &alike, equivalent);
        let fits = |flow: &Flow| flow.modes.damping == damping;
        let flow = visit(&self.0.flows, &alike, fits, |old| self.build(system, &alike, &damping, old))?;
        // The gap, too, enters where a particle is at both faces.
        if let Some(code) = code(contacts).filter(|_| !contacts.iter().any(|contact| contact.is_between())) {
            let equivalent = equivalent.filter(|_| feels_half_cycles(system, contacts));
            self.0.at_hand.borrow_mut()[place(code)] = Some(AtHand { code, equivalent, flow: Rc::clone(&flow) });
        }
        Ok(flow)
    }

    /// Takes note of so many numbers that a contact state keeps from now on.
    #[cold]
    pub(crate) fn keep(&self, numbers: usize) {
        self.0.grown.set(true);
        self.0.built.set(self.0.built.get() + numbers);
    }

    #[cold]
    fn build(
        &self,
        system: &HybridSystem,
        contacts: &[Contact],
        damping: &[f64],
        old: Option<Flow>,
    ) -> Result<Flow, EngineError> {
        let order = system.mass.order + contacts.len();
        // About what the Schur form of a matrix of twice the order takes.
        if budget::spend_ahead(u32::try_from(order.saturating_pow(3) / 8).unwrap_or(u32::MAX)) {
            return Err(budget::overrun().into());
        }
        self.0.grown.set(true);
        let is_one_more = old.is_none();
        // The old flow is gone, and with it its hold on its modes: the next look may take their room, too.
        let room = old.map_or_else(Room::default, Room::from);
        let modes = visit(
            &self.0.undriven.modes,
            contacts,
            |modes| modes.damping == damping,
            |old| {
                let build = |_| Conservative::new(system, contacts);
                let bare = || visit(&self.0.undriven.bare, contacts, |_| true, build);
                let bare = old.as_ref().map_or_else(bare, |old: &Modes| Ok(Rc::clone(&old.bare)))?;
                Modes::new(system, bare, contacts, damping, old)
            },
        )?;
        let like = self.0.flows.borrow().get(contacts).and_then(|known| known.last().cloned());
        let flow = Flow::driven(system, modes, like.as_deref(), room)?;
        if is_one_more {
            self.0.make_room(flow.size());
        }
        Ok(flow)
    }
}

/// One that is known, or a new one; the oldest of many that nobody holds gives its room to that, and if all are held the oldest is forgotten.
#[inline]
fn visit<T>(
    known: &ByContact<T>,
    contacts: &[Contact],
    fits: impl Fn(&T) -> bool,
    build: impl FnOnce(Option<T>) -> Result<T, EngineError>,
) -> Result<Rc<T>, EngineError> {
    let mut oldest = None;
    if let Some(states) = known.borrow_mut().get_mut(contacts) {
        if let Some(place) = states.iter().position(|state| fits(state)) {
            // Beyond the ends of its curve half cycles come to the same damping again and again.
            states[place..].rotate_left(1);
            return Ok(Rc::clone(&states[states.len() - 1]));
        }
        if states.len() >= MOST_DAMPINGS {
            let free = states.iter().position(|state| Rc::strong_count(state) == 1);
            oldest = Rc::into_inner(states.remove(free.unwrap_or(0)));
        }
    }
    let new = Rc::new(build(oldest)?);
    let mut known = known.borrow_mut();
    match known.get_mut(contacts) {
        Some(states) => states.push(Rc::clone(&new)),
        None => drop(known.insert(contacts.to_vec(), vec![Rc::clone(&new)])),
    }
    Ok(new)
}

impl Driven {
    fn new(system: &HybridSystem, undriven: Rc<Undriven>) -> Self {
        Self {
            undriven,
            force_row: system.force_row.clone(),
            observed_rows: system.observed_rows.clone(),
            base: system.base_row().map(<[f64]>::to_vec),
            frequency: system.drive.harmonic.map(|drive| drive.angular_frequency),
            ground: Ground::default(),
            flows: ByContact::default(),
            counted: Cell::new(0),
            grown: Cell::new(false),
            built: Cell::new(0),
            at_hand: RefCell::new(vec![None; AT_HAND]),
        }
    }

    fn fits(&self, system: &HybridSystem) -> bool {
        self.frequency == system.drive.harmonic.map(|drive| drive.angular_frequency)
            && self.base.as_deref() == system.base_row()
            && self.force_row == system.force_row
            && self.observed_rows == system.observed_rows
            && self.undriven.fits(system)
    }

    /// Forgets what it keeps once that has become too much: a run may go through ever new contact states.
    fn make_room(&self, numbers: usize) {
        let built = self.built.get() + numbers;
        if built > MOST_NUMBERS {
            self.flows.borrow_mut().clear();
            self.at_hand.borrow_mut().fill(None);
            self.undriven.bare.borrow_mut().clear();
            self.undriven.modes.borrow_mut().clear();
        }
        self.built.set(if built > MOST_NUMBERS { numbers } else { built });
    }

    /// Numbers that it keeps, those of the modes among them.
    fn size(&self) -> usize {
        self.flows.borrow().values().flatten().map(|flow| flow.size()).sum()
    }
}

impl Undriven {
    fn new(system: &HybridSystem) -> Self {
        Self { system: system.clone(), bare: ByContact::default(), modes: ByContact::default() }
    }

    fn fits(&self, system: &HybridSystem) -> bool {
        let same = |(a, b): (&Particle, &Particle)| a.mass == b.mass && a.floor == b.floor && a.ceiling == b.ceiling;
        let own = &self.system;
        own.gravity == system.gravity
            && own.particles.len() == system.particles.len()
            && own.particles.iter().zip(&system.particles).all(same)
            && own.mass == system.mass
            && own.damping == system.damping
            && own.stiffness == system.stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::matrix::Matrix;
    use crate::system::{Drive, Face, Law};

    /// Two masses with a particle in an enclosure on the second one.
    fn enclosure(ceiling: Face) -> HybridSystem {
        HybridSystem {
            mass: Matrix::diagonal(&[1.0, 0.5]),
            damping: Matrix::diagonal(&[0.3, 0.2]),
            stiffness: Matrix { order: 2, entries: vec![1500.0, -500.0, -500.0, 500.0] },
            gravity: 9.81,
            particles: vec![Particle { mass: 0.05, floor: face(&[0.0, 1.0], 4.0), ceiling: Some(ceiling), gap: 0.01 }],
            force_row: vec![0.0, 1.0],
            drive: Drive { period: 0.2, ticks: Vec::new(), repeats: true, harmonic: None, half_cycles: None },
            observed_rows: vec![vec![0.0, 1.0]],
            momentum_rows: vec![vec![1.0, 1.0]],
        }
    }

    fn face(row: &[f64], damping: f64) -> Face {
        Face { row: row.to_vec(), law: Law::Resilient { stiffness: 1000.0, damping, no_tension: false, stop: None } }
    }

    #[test]
    fn a_contact_has_the_same_flow_at_the_floor_and_at_a_ceiling_that_is_like_it_and_moves_with_it() {
        let alike = |ceiling: Face| {
            let system = enclosure(ceiling);
            let states = States::of(&system);
            let flow = |contact| states.flow(&system, &[contact], None).expect("masses and springs are positive");
            Rc::ptr_eq(&flow(Contact::Floor), &flow(Contact::Ceiling))
        };
        assert!(alike(face(&[0.0, 1.0], 4.0)));
        assert!(!alike(face(&[0.0, 1.0], 5.0)), "another dashpot");
        assert!(!alike(face(&[1.0, 0.0], 4.0)), "a wall that moves by itself");
    }
}
