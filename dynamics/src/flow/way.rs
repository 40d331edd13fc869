//! Ways between contact states: from the block coordinates in which one flow ends to those in which the next one begins.
//!
//! An event changes the contact of one particle. All others, and the structure, are where they were; so with p = V c + the answers to the
//! loads in the flow that ends, and W to the blocks of the next one,
//!
//! c₂ = W₂ P V₁ c₁ + W₂ (P (answers)₁ − (answers)₂) + gap · w + rate · w′,
//!
//! where P drops the coordinate of that particle and, if the next flow has one for it, w and w′ are its columns of W₂. All of this is one
//! matrix, made at the first visit; nothing has to come out of the blocks on the way.

use std::cell::RefCell;
use std::rc::{Rc, Weak};

use crate::arithmetic::superposition::Superposition;
use crate::contact::Relative;
use crate::contact_state::load::Steady;
use crate::flow::Flow;

/// Blocks beyond which a matrix from each neighbour takes more room than it saves time.
pub(super) const MOST_BLOCKS: usize = 24;

/// Numbers of a [`Way`]'s x behind the coordinates of the flow that it comes from.
pub(crate) const BESIDE: usize = 4;

/// The way from one flow to another.
pub(crate) struct Way {
    /// Where it comes from: as long as this is held no other flow stands there.
    from: Weak<Flow>,
    /// The particle whose contact changes.
    particle: usize,
    /// Its rows belong to the coordinates of the first flow; to 1 and the constant force; to gap and rate of the particle.
    matrix: Superposition,
}

/// A flow that was left at an event, with the state in its block coordinates.
pub(crate) struct Left {
    pub(crate) flow: Rc<Flow>,
    /// The particle whose event it is.
    pub(crate) particle: usize,
}

/// The ways that lead to a flow.
pub(crate) type Ways = RefCell<Vec<Way>>;

impl Flow {
    /// Numbers that the ways to it keep.
    pub(super) fn size_of_ways(&self) -> usize {
        self.ways.borrow().iter().map(|way| way.matrix.size()).sum()
    }

    /// Block coordinates at the start of a segment, from those `c` in which another flow ends, with [`BESIDE`] places behind them; `here` is
    /// where the particle is by now whose event it was. Gives the numbers that it keeps from now on.
    #[inline(always)]
    pub(crate) fn enter_from(&self, left: &Left, c: &mut [f64], force: f64, here: Relative, to: &mut [f64]) -> usize {
        let Left { flow, particle } = left;
        let mut ways = self.ways.borrow_mut();
        let known = ways.iter().position(|way| way.from.as_ptr() == Rc::as_ptr(flow) && way.particle == *particle);
        let (place, new) = known.map_or_else(|| self.add_way(&mut ways, left), |place| (place, 0));
        let driven = 2 * flow.blocks.len();
        c[driven..driven + BESIDE].copy_from_slice(&[1.0, force, here.gap, here.rate]);
        ways[place].matrix.sum_by_registers(&c[..driven + BESIDE], to);
        new
    }

    /// Where a new way stands, and how many numbers it keeps.
    #[cold]
    fn add_way(&self, ways: &mut Vec<Way>, Left { flow, particle }: &Left) -> (usize, usize) {
        let way = Way { from: Rc::downgrade(flow), particle: *particle, matrix: self.way_from(flow, *particle) };
        let size = way.matrix.size();
        ways.retain(|way| way.from.strong_count() > 0);
        ways.push(way);
        (ways.len() - 1, size)
    }

    /// The matrix of the way from `first`, where `particle` has an event.
    fn way_from(&self, first: &Self, particle: usize) -> Superposition {
        let structure = self.order - self.modes.attached.len();
        // Where a coordinate of this flow stands in the first one; nowhere, if it is that of the particle.
        let place = |i: usize| match i.checked_sub(structure) {
            None => Some(i),
            Some(slot) => {
                let goes_on = Some(self.modes.attached[slot]).filter(|&attached| attached != particle);
                goes_on.and_then(|attached| first.modes.slot(attached)).map(|slot| structure + slot)
            }
        };
        let places: Vec<Option<usize>> = (0..self.order).map(place).collect();
        let (width, size) = (self.modes.spectral.width(), first.modes.spectral.width());
        let (length, driven) = (self.width(), 2 * first.blocks.len());
        let mut rows = vec![0.0; (driven + BESIDE) * length];
        // Adds `factor` times the p or p′ of a coordinate to the row of an entry of x.
        let mut add = |x: usize, coordinate: usize, factor: f64| {
            let column = &self.modes.spectral.to_blocks[coordinate * width..][..width];
            rows[x * length..][..width].iter_mut().zip(column).for_each(|(sum, entry)| *sum += factor * entry);
        };
        for (i, from) in places.into_iter().enumerate() {
            for (coordinate, half) in [i, self.order + i].into_iter().zip([Half::Places, Half::Rates]) {
                let mut beside = self.beside(half, i).map(|own| -own);
                if let Some(from) = from {
                    let row = &first.modes.spectral.from_blocks[(half as usize * first.order + from) * size..][..size];
                    row.iter().enumerate().for_each(|(x, factor)| add(x, coordinate, *factor));
                    beside.iter_mut().zip(first.beside(half, from)).for_each(|(sum, part)| *sum += part);
                } else {
                    add(driven + 2 + half as usize, coordinate, 1.0);
                }
                let [gravity, force, cosine, sine] = beside;
                add(driven, coordinate, gravity);
                add(driven + 1, coordinate, force);
                if self.harmonic.is_some() {
                    add(driven - 2, coordinate, cosine);
                    add(driven - 1, coordinate, sine);
                }
            }
        }
        if self.harmonic.is_some() {
            // The phase of the drive goes on.
            for k in [0, 1] {
                rows[(driven - 2 + k) * length + width + k] = 1.0;
            }
        }
        Superposition::default().of_rows(length, &rows)
    }

    /// What the loads do to a coordinate, or to its rate, beside the free motion: by gravity, a unit of constant force, and the cosine and
    /// the sine of the harmonic one.
    fn beside(&self, half: Half, i: usize) -> [f64; 4] {
        let steady = self.harmonic.as_ref();
        match half {
            Half::Places => {
                let [cosine, sine] = steady.map_or([0.0; 2], |steady| [steady.cosine[i], steady.sine[i]]);
                [self.modes.gravity.rest[i], self.force.rest[i], cosine, sine]
            }
            Half::Rates => {
                let turn = |steady: &Steady| [steady.omega * steady.sine[i], -steady.omega * steady.cosine[i]];
                let [cosine, sine] = steady.map_or([0.0; 2], turn);
                [0.0, 0.0, cosine, sine]
            }
        }
    }
}

/// Halves of (p, p′).
#[derive(Clone, Copy)]
enum Half {
    Places = 0,
    Rates = 1,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::matrix::Matrix;
    use crate::contact_state::dampings;
    use crate::system::{Contact, Drive, DrivePhase, Face, Harmonic, HybridSystem, Law, Particle};

    /// Two masses, two particles on the second one, and a harmonic force.
    fn system() -> HybridSystem {
        let face = |damping| Face {
            row: vec![0.2, 1.0],
            law: Law::Resilient { stiffness: 1000.0, damping, no_tension: false, stop: None },
        };
        let particle = |mass, damping| Particle { mass, floor: face(damping), ceiling: Some(face(damping)), gap: 0.01 };
        HybridSystem {
            mass: Matrix::diagonal(&[1.0, 0.5]),
            damping: Matrix::diagonal(&[0.3, 0.2]),
            stiffness: Matrix { order: 2, entries: vec![1500.0, -500.0, -500.0, 500.0] },
            gravity: 9.81,
            particles: vec![particle(0.05, 4.0), particle(0.02, 40.0)],
            force_row: vec![0.0, 1.0],
            drive: Drive {
                period: 0.2,
                ticks: Vec::new(),
                repeats: true,
                harmonic: Some(Harmonic { force: 3.0, angular_frequency: 30.0, phase: 0.4 }),
                half_cycles: None,
            },
            observed_rows: vec![vec![0.0, 1.0]],
            momentum_rows: vec![vec![1.0, 1.0]],
        }
    }

    #[test]
    fn every_way_leads_to_where_the_state_would_come_out_of_one_flow_and_enter_the_other() {
        use Contact::{Ceiling, Flight, Floor};
        let system = system();
        let flow = |contacts: [Contact; 2]| {
            let flow = Flow::build(&system, &contacts, &dampings(&system, &contacts, None));
            Rc::new(flow.expect("masses and springs are positive"))
        };
        let (force, drive) = (2.0, DrivePhase { cosine: 1.7, sine: -2.2 });
        let here = Relative { gap: 2e-3, rate: 0.4 };
        for (before, after, particle) in [
            ([Flight, Floor], [Floor, Floor], 0),
            ([Flight, Floor], [Flight, Flight], 1),
            ([Floor, Floor], [Floor, Flight], 1),
            ([Floor, Floor], [Flight, Floor], 0),
            ([Floor, Flight], [Ceiling, Flight], 0),
            ([Floor, Ceiling], [Floor, Ceiling], 1),
        ] {
            let (from, to) = (flow(before), flow(after));
            assert!(from.has_ways && to.has_ways);
            let mut c: Vec<f64> = (0..from.width()).map(|i| libm::cos(0.7 * i as f64)).collect();
            c[2 * from.own..2 * from.own + 2].copy_from_slice(&[drive.cosine, drive.sine]);
            c.resize(from.width() + BESIDE, 0.0);
            let [mut p, mut rate] = from.left(&c[..2 * from.own], 0.0, force, drive);
            let attached = |flow: &Flow, j: usize| flow.modes.slot(j).map(|slot| 2 + slot);
            let place = |j: usize| attached(&from, j).map(|i| Relative { gap: p[i], rate: rate[i] });
            let places = [0, 1].map(|j| if j == particle { Some(here) } else { place(j) });
            let (mut gaps, mut rates) = (p[..2].to_vec(), rate[..2].to_vec());
            for &j in &to.modes.attached {
                let Relative { gap, rate } = places[j].expect("only the particle whose event it is comes to a face");
                gaps.push(gap);
                rates.push(rate);
            }
            (p, rate) = (gaps, rates);
            let mut expected = vec![0.0; to.width()];
            to.enter(&p, &rate, force, drive, &mut Vec::new(), &mut expected);
            let mut straight = vec![f64::NAN; to.width()];
            // The second time by the same matrix.
            for _ in 0..2 {
                to.enter_from(&Left { flow: Rc::clone(&from), particle }, &mut c, force, here, &mut straight);
            }
            assert_eq!(to.ways.borrow().len(), 1);
            for (straight, expected) in straight.iter().zip(&expected) {
                assert!((straight - expected).abs() < 1e-13 * (1.0 + expected.abs()), "{before:?} to {after:?}");
            }
        }
    }
}
