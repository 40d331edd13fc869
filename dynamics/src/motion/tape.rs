//! What a run leaves behind for its tangent: each flow and its length, each event with both sides of it, each exchange of
//! momentum as the linear map that it is.

use std::collections::VecDeque;
use std::rc::Rc;

use crate::arithmetic::few::Few;
use crate::contact::Side;
use crate::flow::Flow;
use crate::system::{Contact, EventKind};

/// Cycles whose events are kept where a run is named, counted from its end.
pub(crate) const NAMING: usize = 4096;

/// The record of a run.
#[derive(Default)]
pub(crate) struct Tape {
    /// How many cycles are kept, counted from the end of the run.
    kept: usize,
    /// Those.
    cycles: VecDeque<Cycle>,
    /// States at the ends of all cycles.
    pub(crate) ends: Vec<End>,
    /// What they reach.
    pub(crate) reach: Reach,
    /// Exchanges of momentum in the event under way.
    jumps: Vec<Jump>,
}

/// One cycle of the drive.
#[derive(Default)]
pub(crate) struct Cycle {
    pub(super) steps: Vec<Step>,
    /// Numbers of its instants, one after the other: a list of its own for each would cost more than the run.
    numbers: Vec<f64>,
    /// Contacts made, stops hit among them.
    pub(crate) contacts: u64,
    /// Infinitely many impacts came to their end.
    pub(crate) chatter: bool,
    /// Particles struck at one instant: a moved start would put their impacts into one order or the other, and no single
    /// matrix says what comes of both.
    pub(crate) blurred: bool,
}

/// What happens to a tangent vector.
pub(super) enum Step {
    /// The flow of a contact state, for so many seconds.
    Flow(Rc<Flow>, f64),
    /// At an instant that the drive sets.
    Timed(Vec<Jump>),
    /// At an instant that the motion sets.
    Event(Crossing),
}

/// An event.
pub(super) struct Crossing {
    /// The gap that has closed or opened; none where a force has come to zero.
    pub(super) gap: Option<(usize, Side)>,
    pub(super) before: Instant,
    pub(super) jumps: Vec<Jump>,
    pub(super) after: Instant,
    /// Force of the drive, N.
    pub(super) force: f64,
}

/// A state with the flow in force; its numbers stand in the cycle.
pub(crate) struct Instant {
    flow: Rc<Flow>,
    /// Where they begin.
    from: usize,
}

/// An instant with its numbers.
#[derive(Clone, Copy)]
pub(super) struct At<'a> {
    pub(super) flow: &'a Rc<Flow>,
    /// Coordinates of the flow.
    pub(super) p: &'a [f64],
    /// Their rates.
    pub(super) rate: &'a [f64],
    /// y′ of each particle.
    pub(super) particles: &'a [f64],
}

/// An exchange of momentum: impulses that are linear in the speeds before it.
pub(crate) struct Jump {
    pub(crate) kicks: Vec<Kick>,
    /// Impulses per particle mass, by the speeds along the normals, row by row.
    pub(crate) impulses: Few<f64>,
    /// The faces hold their particles from now on.
    pub(crate) holds: bool,
}

/// A contact that takes part in it.
pub(crate) struct Kick {
    pub(crate) particle: usize,
    pub(crate) side: Side,
    /// M⁻¹φ.
    pub(crate) answer: Rc<[f64]>,
    /// Restitution of a contact that is struck.
    pub(crate) restitution: Option<f64>,
}

/// The state at the end of a cycle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct End {
    /// q, y, q′, y′.
    pub(crate) state: Few<f64>,
    pub(crate) contacts: Few<Contact>,
}

impl End {
    /// Of a structure at q, q′ with its particles at y, y′.
    pub(crate) fn new([q, rate]: [&[f64]; 2], particles: &[[f64; 2]], contacts: &[Contact]) -> Self {
        let of = |which: usize| particles.iter().map(move |at| at[which]);
        // No more room than it takes: a run keeps those of all its cycles.
        let mut state = Few::with_capacity(2 * (q.len() + particles.len()));
        state.extend(q.iter().copied().chain(of(0)).chain(rate.iter().copied()).chain(of(1)));
        Self { state, contacts: Few::from_slice(contacts) }
    }
}

/// The least and the largest of each number of the states so far.
#[derive(Default)]
pub(crate) struct Reach(Vec<[f64; 2]>);

impl Reach {
    pub(crate) fn take(&mut self, state: &[f64]) {
        self.0.resize(state.len(), [f64::INFINITY, f64::NEG_INFINITY]);
        for ([low, high], x) in self.0.iter_mut().zip(state) {
            (*low, *high) = (low.min(*x), high.max(*x));
        }
    }

    /// Of number `i` of a state.
    pub(super) fn of(&self, i: usize) -> [f64; 2] {
        self.0.get(i).copied().unwrap_or_default()
    }
}

impl Cycle {
    /// An instant of this cycle, in a system of so many particles.
    pub(super) fn at<'a>(&'a self, instant: &'a Instant, particles: usize) -> At<'a> {
        let order = instant.flow.order;
        let (p, others) = self.numbers[instant.from..].split_at(order);
        let (rate, others) = others.split_at(order);
        At { flow: &instant.flow, p, rate, particles: &others[..particles] }
    }
}

impl Tape {
    /// Keeps the events of so many last cycles.
    pub(crate) fn keeping(kept: usize) -> Self {
        Self { kept, ..Self::default() }
    }

    /// A cycle begins.
    pub(crate) fn begin_cycle(&mut self) {
        // In the room of the one that is forgotten, or about as long as the last one.
        let is_full = self.cycles.len() >= self.kept.max(1);
        let forgotten = if is_full { self.cycles.pop_front() } else { None };
        let as_long = |last: &Cycle| (Vec::with_capacity(last.steps.len()), Vec::with_capacity(last.numbers.len()));
        let room = forgotten.map(|Cycle { steps, numbers, .. }| (steps, numbers));
        let (mut steps, mut numbers) = room.or_else(|| self.cycles.back().map(as_long)).unwrap_or_default();
        steps.clear();
        numbers.clear();
        self.cycles.push_back(Cycle { steps, numbers, ..Cycle::default() });
        // Jumps that put the start right belong to no cycle.
        self.jumps.clear();
    }

    /// A cycle has ended.
    pub(crate) fn end_cycle(&mut self, end: End) {
        self.reach.take(&end.state);
        self.ends.push(end);
    }

    pub(crate) fn flow(&mut self, flow: &Rc<Flow>, length: f64) {
        self.enter(Step::Flow(Rc::clone(flow), length));
    }

    pub(crate) fn count(&mut self, kind: EventKind) {
        let Some(cycle) = self.cycles.back_mut() else { return };
        cycle.contacts += u64::from(kind.is_contact());
        cycle.chatter |= kind == EventKind::ChatterEnd;
    }

    /// Within an event, or at an impulse of the drive; so many particles have just arrived.
    pub(crate) fn jump(&mut self, jump: Jump, arrived: usize) {
        if let Some(cycle) = self.cycles.back_mut() {
            cycle.blurred |= arrived > 1;
        }
        self.jumps.push(jump);
    }

    /// What was at an instant of the drive.
    pub(crate) fn timed(&mut self) {
        let jumps = std::mem::take(&mut self.jumps);
        if !jumps.is_empty() {
            self.enter(Step::Timed(jumps));
        }
    }

    /// An instant by its numbers: coordinates of the flow, their rates, and y′ of each particle.
    pub(crate) fn instant(&mut self, flow: &Rc<Flow>, numbers: impl Iterator<Item = f64>) -> Instant {
        let mut from = 0;
        if let Some(cycle) = self.cycles.back_mut() {
            from = cycle.numbers.len();
            cycle.numbers.extend(numbers);
        }
        Instant { flow: Rc::clone(flow), from }
    }

    pub(crate) fn event(&mut self, gap: Option<(usize, Side)>, before: Instant, after: Instant, force: f64) {
        let jumps = std::mem::take(&mut self.jumps);
        self.enter(Step::Event(Crossing { gap, before, jumps, after, force }));
    }

    /// What the states at the ends of cycles and at their events reach, as far as those are known.
    pub(crate) fn reach_with_events(&self, order: usize, particles: usize) -> Reach {
        let mut reach = Reach::default();
        self.ends.iter().for_each(|end| reach.take(&end.state));
        for cycle in &self.cycles {
            let events = cycle.steps.iter().filter_map(|step| match step {
                Step::Event(crossing) => Some([&crossing.before, &crossing.after]),
                Step::Flow(..) | Step::Timed(_) => None,
            });
            for at in events.flatten().map(|instant| cycle.at(instant, particles)) {
                let mut state = vec![f64::NAN; 2 * (order + particles)];
                state[..order].copy_from_slice(&at.p[..order]);
                state[order + particles..2 * order + particles].copy_from_slice(&at.rate[..order]);
                state[2 * order + particles..].copy_from_slice(at.particles);
                reach.take(&state);
            }
        }
        reach
    }

    fn enter(&mut self, step: Step) {
        if let Some(cycle) = self.cycles.back_mut() {
            cycle.steps.push(step);
        }
    }

    /// The last `count` cycles that are kept.
    pub(crate) fn last(&self, count: usize) -> impl Iterator<Item = &Cycle> {
        self.cycles.range(self.cycles.len() - count.min(self.cycles.len())..)
    }
}
