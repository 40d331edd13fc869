//! Single impacts: measures read off the events of the averaged window, of the first particle on its floor.
//!
//! Restitution is −u′(after)/u′(before): under a rigid face of one event, under a resilient one of the contact and the release
//! that follows it.

use std::f64::consts::TAU;
use std::ops::Range;

use super::Measure;
use crate::dynamics::{Event, EventKind, Response};
use crate::scene::Scene;

/// The events of the averaged window, with their time since the start of the run.
pub(super) struct Impacts<'a> {
    events: Vec<&'a Event>,
    period: f64,
}

/// A contact with the floor from begin to end.
struct Contact<'a> {
    begin: &'a Event,
    end: &'a Event,
}

impl<'a> Impacts<'a> {
    /// In these cycles of a run.
    pub(super) fn of(response: &'a Response, scene: &Scene, cycles: &Range<u64>) -> Self {
        let kept = |event: &&Event| cycles.contains(&event.cycle) && event.particle == 0;
        Self { events: response.events.iter().filter(kept).collect(), period: scene.excitation.period() }
    }

    /// NaN where there is no such event.
    pub(super) fn read(&self, measure: Measure) -> f64 {
        let first = |kind| self.only(kind).next().map(|event| self.instant(event));
        let last = self.only(EventKind::FloorContact).last();
        // A face that cannot pull may push again while the particle leaves it.
        let approached = self.only(EventKind::FloorContact).rfind(|event| event.approach <= 0.0);
        let number = match measure {
            Measure::FloorImpactTime => first(EventKind::FloorContact),
            Measure::FloorReleaseTime => first(EventKind::FloorRelease),
            Measure::ChatterEndTime => first(EventKind::ChatterEnd),
            Measure::FloorImpactInterval => self.intervals().last().copied(),
            Measure::FloorIntervalChange => {
                self.intervals().last_chunk().map(|[before, after]: &[f64; 2]| (after - before).abs())
            }
            Measure::FloorImpactSpeed => approached.map(|event| -event.approach),
            Measure::FloorImpactPhase => last.map(|event| TAU / self.period * event.time),
            Measure::FloorReboundSpeed => self.last_contact().map(|contact| contact.end.departure),
            Measure::FloorRestitution => self
                .last_contact()
                .filter(|contact| contact.begin.approach != 0.0)
                .map(|contact| -contact.end.departure / contact.begin.approach),
            Measure::FloorContactTime => self.last_contact().map(|contact| self.between(contact.begin, contact.end)),
            _ => None,
        };
        number.unwrap_or(f64::NAN)
    }

    fn only(&self, kind: EventKind) -> impl DoubleEndedIterator<Item = &'a Event> {
        self.events.iter().copied().filter(move |event| event.kind == kind)
    }

    /// Seconds since the start of the run.
    fn instant(&self, event: &Event) -> f64 {
        event.cycle as f64 * self.period + event.time
    }

    /// The time between two events; whole cycles first, so that a late event is as exact as an early one.
    fn between(&self, begin: &Event, end: &Event) -> f64 {
        (end.cycle - begin.cycle) as f64 * self.period + (end.time - begin.time)
    }

    /// The times between one floor contact and the next.
    fn intervals(&self) -> Vec<f64> {
        let contacts: Vec<&Event> = self.only(EventKind::FloorContact).collect();
        contacts.windows(2).map(|pair| self.between(pair[0], pair[1])).collect()
    }

    /// The last contact with the floor that has ended.
    fn last_contact(&self) -> Option<Contact<'a>> {
        let begins = |event: &Event| event.kind == EventKind::FloorContact;
        let (mut end, mut found) = (None, None);
        for event in self.events.iter().rev() {
            match event.kind {
                EventKind::FloorRelease => end = Some(*event),
                _ if !begins(event) => {}
                // A rigid face lets go at once.
                _ if !event.lasts => found = Some(Contact { begin: event, end: event }),
                _ => found = end.map(|end| Contact { begin: event, end }),
            }
            if found.is_some() {
                break;
            }
        }
        found
    }
}
