//! How long particles are in contact: the share of the averaged time between contacts made and lost, from all events since the start.

use std::ops::Range;

use crate::dynamics::{Contact, Event, EventKind, Response};
use crate::scene::Scene;

/// Share of these cycles that a particle spends on its floor or its ceiling, mean over the particles; 0 without any.
pub(super) fn contact_share(response: &Response, scene: &Scene, cycles: Range<u64>) -> f64 {
    let shares = (0..scene.dampers.len()).map(|index| of_particle(response, scene, index, &cycles));
    // A sum of nothing is −0.
    shares.fold(0.0, |sum, share| sum + share) / scene.dampers.len().max(1) as f64
}

fn of_particle(response: &Response, scene: &Scene, index: usize, cycles: &Range<u64>) -> f64 {
    let period = scene.excitation.period();
    let length = (cycles.end - cycles.start) as f64 * period;
    let since_begin = |event: &Event| (event.cycle as f64 - cycles.start as f64) * period + event.time;
    let events = || response.events.iter().filter(|event| event.particle == index);
    let first = response.initial_contacts.get(index).copied().unwrap_or(Contact::Floor);
    let (mut on_floor, mut on_ceiling) = (first.touches_floor(), first.touches_ceiling());
    let (mut since, mut sum) = (0.0, 0.0);
    for event in events() {
        let now = since_begin(event).clamp(0.0, length);
        if on_floor || on_ceiling {
            sum += now - since;
        }
        since = now;
        match event.kind {
            EventKind::FloorContact => on_floor = event.lasts,
            EventKind::CeilingContact => on_ceiling = event.lasts,
            EventKind::FloorRelease => on_floor = false,
            EventKind::CeilingRelease => on_ceiling = false,
            EventKind::ChatterEnd if event.approach > 0.0 => on_floor = true,
            EventKind::ChatterEnd => on_ceiling = true,
            EventKind::FloorStop | EventKind::CeilingStop | EventKind::StopRelease => {}
        }
    }
    if on_floor || on_ceiling {
        sum += length - since;
    }
    sum / length
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Damper, Excitation, SingleMass, Surface};

    #[test]
    fn time_in_contact_counts_from_landing_to_release_within_the_averaged_cycles() {
        let mass = SingleMass { mass: 1.0, stiffness: 1000.0, damping: 3.0 };
        let excitation = Excitation::ImpulseTrain { impulse: 1.0, period: 0.5 };
        let damper = Damper::between(Surface::Rigid { restitution: 0.0 }, 0.05, 0.1);
        let scene = Scene::on_one_mass(mass, 9.81, vec![damper], excitation);
        let at = |cycle, time, kind: EventKind, departure| Event {
            cycle,
            time,
            particle: 0,
            kind,
            approach: departure,
            departure,
            lasts: departure <= 0.0 || kind == EventKind::CeilingContact,
        };
        let share = |events: &[Event]| {
            let initial_contacts = vec![Contact::Floor];
            let response = Response { events: events.to_vec(), initial_contacts, ..Response::default() };
            contact_share(&response, &scene, 2..4)
        };
        let release = at(0, 0.1, EventKind::FloorRelease, 0.2);
        assert_eq!(share(&[]), 1.0);
        assert_eq!(share(&[release]), 0.0);
        // On the floor for 0.25 s of the second, on the ceiling for 0.125 s.
        let lands = [
            release,
            at(2, 0.25, EventKind::FloorContact, -0.2),
            at(3, 0.0, EventKind::FloorRelease, 0.2),
            at(3, 0.125, EventKind::CeilingContact, 0.2),
            at(3, 0.25, EventKind::CeilingRelease, -0.2),
        ];
        assert_eq!(share(&lands), 0.375);
        // A rigid floor lets go at once.
        assert_eq!(share(&[release, at(2, 0.25, EventKind::FloorContact, 0.1)]), 0.0);
    }
}
