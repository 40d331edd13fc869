//! Steps ahead: some steps of one contact state at once.
//!
//! With the constant 1 and the forces (level, F sin, F cos) as coordinates behind the state, a step is linear, z(k+1) = Z z(k), and so
//! is every signal some steps later: ρ·z(k+i) = (ρ Zⁱ)·z(k). The rows ρ Zⁱ are worked out once for each contact state; where no guard is
//! negative at any of these steps, none of them has to wait for the one before it.

use super::propagator::Propagator;
use super::schedule::Oscillator;
use super::vector::Vector;
use super::watch::Watch;
use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;

/// Steps at once.
pub(super) const AHEAD: u64 = COUNT as u64;
const COUNT: usize = 2 * WIDTH;

/// The forces at an instant: the constant one, F sin and F cos of the harmonic one, N.
pub(super) type Forces = [f64; 3];

/// A number for each of these steps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steps([Four; 2]);

impl Steps {
    fn new(at: impl Fn(usize) -> f64) -> Self {
        Self([0, WIDTH].map(|first| Four::new(std::array::from_fn(|lane| at(first + lane)))))
    }

    #[inline(always)]
    pub(super) fn each(self) -> impl Iterator<Item = f64> {
        self.0.into_iter().flat_map(Four::array)
    }

    #[inline(always)]
    pub(super) fn sum_of_squares(self) -> f64 {
        let [early, late] = self.0;
        (early * early + late * late).sum()
    }

    #[inline(always)]
    pub(super) fn is_ever_negative(self) -> bool {
        let [early, late] = self.0;
        early.zip(late, |early, late| if early < 0.0 || late < 0.0 { 1.0 } else { 0.0 }).sum() > 0.0
    }
}

/// What each step will show, by the coordinates: those of the state, the constant, the forces.
pub(super) struct Foresight(Vec<Steps>);

impl Foresight {
    #[inline(always)]
    pub(super) fn at<V: Vector>(&self, state: &V, forces: &Forces) -> Steps {
        let (by_state, others) = self.0.split_at(state.as_ref().len());
        let [constant, by_forces @ ..] = others else { return Steps([Four::ZERO; 2]) };
        let mut sum = *constant;
        for (Steps([early, late]), x) in by_state.iter().zip(state.as_ref()).chain(by_forces.iter().zip(forces)) {
            sum = Steps([sum.0[0] + *early * *x, sum.0[1] + *late * *x]);
        }
        sum
    }
}

/// A later state, or a sum of states, by the coordinates.
pub(super) struct Affine<V: Vector> {
    matrix: V::Matrix,
    offset: V,
    by_forces: Vec<V>,
}

impl<V: Vector> Affine<V> {
    fn new(size: usize, columns: &[Vec<f64>]) -> Self {
        Self {
            matrix: V::matrix(&columns[..size]),
            offset: V::of(&columns[size]),
            by_forces: columns[size + 1..].iter().map(|column| V::of(column)).collect(),
        }
    }

    #[inline(always)]
    pub(super) fn apply(&self, state: &V, forces: &Forces, into: &mut V) {
        let [by_level, by_turns @ ..] = &self.by_forces[..] else { return };
        V::advance(&self.matrix, &self.offset, by_level, forces[0], state, into);
        by_turns.iter().zip(&forces[1..]).for_each(|(column, force)| into.add_times(*force, column));
    }
}

/// One contact state, some steps ahead.
pub(super) struct Ahead<V: Vector> {
    /// The state at the end of the last step, and the sum of those at the end of each.
    pub(super) end: Affine<V>,
    pub(super) sum: Affine<V>,
    pub(super) guards: Vec<Foresight>,
    /// Displacement and velocity of each observed point.
    pub(super) observed: Vec<[Foresight; 2]>,
    pub(super) dissipation: Vec<Foresight>,
    /// The displacement under the force; the force at the start of each step.
    pub(super) forced: Foresight,
    pub(super) force: Foresight,
    /// Sine and cosine of the angle that the harmonic force turns by.
    pub(super) turn: Option<(f64, f64)>,
}

/// What one coordinate alone comes to.
struct Course<V> {
    /// At the end of each step.
    states: Vec<V>,
    /// From the start of the first step on.
    forces: Vec<f64>,
    constant: f64,
}

impl<V: Vector> Ahead<V> {
    pub(super) fn new(propagator: &Propagator<V>, watch: &Watch<V>, oscillator: Option<&Oscillator>) -> Self {
        let size = propagator.offset.as_ref().len();
        let nothing = || V::of(&vec![0.0; size]);
        let course = |start: V, constant: f64, force: &dyn Fn(usize) -> f64| {
            let forces: Vec<f64> = (0..=COUNT).map(force).collect();
            let mut offset = nothing();
            offset.add_times(constant, &propagator.offset);
            let mut states: Vec<V> = Vec::with_capacity(COUNT);
            for force in &forces[..COUNT] {
                let mut next = nothing();
                let from = states.last().unwrap_or(&start);
                V::advance(&propagator.matrix, &offset, &propagator.input, *force, from, &mut next);
                states.push(next);
            }
            Course { states, forces, constant }
        };
        let unit = |i: usize| {
            let mut unit = nothing();
            unit.as_mut()[i] = 1.0;
            unit
        };
        let mut courses: Vec<Course<V>> = (0..size).map(|i| course(unit(i), 0.0, &|_| 0.0)).collect();
        courses.push(course(nothing(), 1.0, &|_| 0.0));
        courses.push(course(nothing(), 0.0, &|_| 1.0));
        if let Some(oscillator) = oscillator {
            // F sin(φ + iα) = F sin φ cos iα + F cos φ sin iα.
            courses.push(course(nothing(), 0.0, &|i| oscillator.turned(i).1));
            courses.push(course(nothing(), 0.0, &|i| oscillator.turned(i).0));
        }

        let signal = |at: &dyn Fn(&Course<V>, usize) -> f64| {
            Foresight(courses.iter().map(|course| Steps::new(|i| at(course, i))).collect())
        };
        let row = |row: &V| signal(&|course, i| row.dot(&course.states[i]));
        let affine = |state: &dyn Fn(&Course<V>) -> V| {
            let columns: Vec<Vec<f64>> = courses.iter().map(|course| state(course).as_ref().to_vec()).collect();
            Affine::new(size, &columns)
        };
        let sum = |course: &Course<V>| {
            let mut sum = nothing();
            course.states.iter().for_each(|state| sum.add(state));
            sum
        };
        let first = [[&watch.displacement, &watch.velocity]];
        let more = watch.more.iter().map(|rows| rows.each_ref());
        Self {
            end: affine(&|course| course.states[COUNT - 1].clone()),
            sum: affine(&sum),
            guards: propagator
                .guards
                .iter()
                .map(|guard| signal(&|course, i| guard.of(&course.states[i], course.forces[i + 1], course.constant)))
                .collect(),
            observed: first.into_iter().chain(more).map(|rows| rows.map(row)).collect(),
            dissipation: propagator.dissipation.iter().map(row).collect(),
            forced: row(&watch.forced),
            force: signal(&|course, i| course.forces[i]),
            turn: oscillator.map(|oscillator| oscillator.turned(COUNT)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Run;
    use super::{AHEAD, COUNT};
    use crate::arithmetic::matrix::Matrix;
    use crate::options::Options;
    use crate::system::{Drive, Face, Harmonic, HybridSystem, Law, Particle};

    #[test]
    fn steps_at_once_are_the_steps_one_after_the_other() {
        let resilient = Law::Resilient { stiffness: 800.0, damping: 0.3, no_tension: false, stop: None };
        for law in [resilient, Law::Rigid { restitution: 0.5 }] {
            let system = HybridSystem {
                mass: Matrix::diagonal(&[1.0]),
                damping: Matrix::diagonal(&[0.4]),
                stiffness: Matrix::diagonal(&[1000.0]),
                gravity: 9.81,
                particles: vec![Particle { mass: 0.1, floor: Face { row: vec![1.0], law }, ceiling: None, gap: 0.0 }],
                force_row: vec![1.0],
                drive: Drive {
                    period: 0.2,
                    ticks: Vec::new(),
                    repeats: true,
                    harmonic: Some(Harmonic { force: 0.2, angular_frequency: 31.0, phase: 0.3 }),
                    half_cycles: None,
                },
                observed_rows: vec![vec![1.0], vec![2.0]],
                momentum_rows: vec![vec![1.0]],
            };
            let options = Options { extremes: true, ..Options::default() };
            let run = || Run::<[f64; 4]>::new(&system, &options, 1e-3).expect("it is sound");
            let [mut once, mut each] = [run(), run()];
            for run in [&mut once, &mut each] {
                run.motion.level = -0.1;
                run.motion.state[2] = 1e-3;
            }
            let near = |once: f64, each: f64| {
                assert!((once - each).abs() < 1e-13 * (1.0 + each.abs()), "{once} for {each} under {law:?}");
            };
            for _ in 0..25 {
                let Run { motion, known, watch, tally, .. } = &mut once;
                let ahead = known[0].ahead.as_ref().expect("no half cycle asks after each step");
                let guards =
                    ahead.guards.iter().map(|guard| guard.at(&motion.state, &motion.forces()).each().collect());
                let foreseen: Vec<Vec<f64>> = guards.collect();
                assert!(motion.leap::<true>(ahead, watch, tally), "the particle stays on its floor");
                let Run { motion, known, watch, tally, .. } = &mut each;
                let propagator = &known[0].propagator;
                for step in 0..COUNT {
                    motion.one_by_one::<true>(propagator, watch, 1, tally);
                    for (foreseen, guard) in foreseen.iter().zip(&propagator.guards) {
                        near(foreseen[step], guard.at(&motion.state, motion.force()));
                    }
                }
            }
            let sums = |Run { tally, motion, .. }: &Run<'_, [f64; 4]>| {
                let passed = &tally.passed;
                let mut all = vec![tally.velocity_square, passed.dissipated, passed.work, passed.force_modulus];
                all.extend(tally.more.iter().flatten().chain(&motion.state).chain(&tally.state));
                all.extend(
                    tally.extremes.iter().flat_map(|range| range.displacement.into_iter().chain(range.velocity)),
                );
                all.extend(motion.oscillator.map(|oscillator| oscillator.value()));
                all
            };
            assert_eq!(once.tally.steps, 25 * AHEAD);
            sums(&once).into_iter().zip(sums(&each)).for_each(|(once, each)| near(once, each));
        }
    }
}
