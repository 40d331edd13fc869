//! The search: asking an optimiser for points, having them evaluated, telling it the scores, until it is enough.

/// What a point is worth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// The value; smaller is better.
    pub value: f64,
}

impl Score {
    /// For comparisons: what is no number is worse than anything.
    pub(crate) fn order(self) -> f64 {
        if self.value.is_nan() { f64::INFINITY } else { self.value }
    }
}

/// A batch that has been evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// Of each point.
    pub scores: Vec<Score>,
    /// How long it took, s; for stopping by time.
    pub seconds: f64,
}

/// Which scores of a batch have to be known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wanted {
    /// All of them.
    Each,
    /// The least one, if it is below this. Of a score above this, or above another one of the batch, a bound will do that is above
    /// it, too.
    Least {
        /// The least score known before.
        below: f64,
    },
}

/// Evaluates a batch of points, in whatever order and on however many threads.
pub type Function<'f, E> = dyn FnMut(&[Vec<f64>], Wanted) -> Result<Batch, E> + 'f;

/// Something that looks for the smallest value, batch by batch.
pub trait Optimiser {
    /// The points that it wants to know next; none if it has nothing more to ask.
    fn ask(&mut self) -> Vec<Vec<f64>>;

    /// Their scores, in the order in which they were asked for.
    fn tell(&mut self, scores: &[Score]);

    /// Which of them it will look at.
    fn wanted(&self) -> Wanted {
        Wanted::Each
    }
}

/// When to stop; the first condition that is met counts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stopping {
    /// Batches at most.
    pub generations: Option<u64>,
    /// Evaluations at most; the last batch is cut to it.
    pub evaluations: Option<u64>,
    /// Seconds at most; looked at after each batch.
    pub seconds: Option<f64>,
    /// The function tolerance.
    pub stalled: Option<Stalled>,
}

/// Function tolerance: the search stops when the mean relative change of the best value a generation, over so many
/// generations, is no more than this.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stalled {
    /// Mean relative change.
    pub tolerance: f64,
    /// Over how many generations.
    pub generations: u64,
}

/// Which condition it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    /// The number of generations.
    Generations,
    /// The number of evaluations.
    Evaluations,
    /// The time.
    Time,
    /// The function tolerance.
    Tolerance,
    /// The optimiser had nothing more to ask.
    Exhausted,
    /// No step goes down any more.
    Converged,
    /// It would go down only beyond an end of a side.
    Bound,
    /// A step down leads to where the function has no derivative.
    Edge,
    /// The function has no derivative where the descent should begin.
    NotSmooth,
}

impl Stopped {
    /// In one word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Generations => "generations",
            Self::Evaluations => "evaluations",
            Self::Time => "time",
            Self::Tolerance => "tolerance",
            Self::Exhausted => "exhausted",
            Self::Converged => "converged",
            Self::Bound => "bound",
            Self::Edge => "edge",
            Self::NotSmooth => "not smooth",
        }
    }
}

/// Where a search stood after a batch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Evaluations so far.
    pub evaluations: u64,
    /// Best value so far.
    pub best: f64,
}

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The best point.
    pub point: Vec<f64>,
    /// Its score.
    pub score: Score,
    /// Evaluations made.
    pub evaluations: u64,
    /// After each batch.
    pub trail: Vec<Step>,
    /// Why it ended.
    pub stopped: Stopped,
}

/// Runs a search. `None` if it never asked for a point.
///
/// # Errors
/// What `evaluate` fails with.
pub fn minimise<E>(
    optimiser: &mut dyn Optimiser,
    stopping: &Stopping,
    evaluate: &mut Function<'_, E>,
) -> Result<Option<Found>, E> {
    let mut found: Option<Found> = None;
    let mut seconds = 0.0;
    let mut generation = 0;
    loop {
        let done = found.as_ref().map_or(0, |found| found.evaluations);
        let mut points = optimiser.ask();
        let asked = points.len();
        let room = stopping.evaluations.map_or(u64::MAX, |most| most.saturating_sub(done));
        points.truncate(usize::try_from(room).unwrap_or(usize::MAX));
        if points.is_empty() {
            let stopped = if asked > 0 { Stopped::Evaluations } else { Stopped::Exhausted };
            return Ok(found.map(|found| Found { stopped, ..found }));
        }
        generation += 1;
        let cut = points.len() < asked;
        // What comes after the last batch asks for the best point alone.
        let last = cut || stopping.counted(done + points.len() as u64, generation).is_some();
        let below = found.as_ref().map_or(f64::INFINITY, |found| found.score.order());
        let batch = evaluate(&points, if last { Wanted::Least { below } } else { optimiser.wanted() })?;
        seconds += batch.seconds;
        take(&mut found, &points, &batch.scores);
        let Some(so_far) = &mut found else { return Ok(None) };
        if !last {
            optimiser.tell(&batch.scores);
        }
        if let Some(stopped) = cut.then_some(Stopped::Evaluations).or_else(|| stopping.met(so_far, generation, seconds))
        {
            so_far.stopped = stopped;
            return Ok(found);
        }
    }
}

/// Adds a batch to what was found; of equal values the first counts.
fn take(found: &mut Option<Found>, points: &[Vec<f64>], scores: &[Score]) {
    let mut best = found.take().map(|found| (found.point, found.score, found.evaluations, found.trail));
    for (point, score) in points.iter().zip(scores) {
        match &mut best {
            Some((known, known_score, ..)) if score.order() < known_score.order() => {
                known.clone_from(point);
                *known_score = *score;
            }
            Some(_) => {}
            None => best = Some((point.clone(), *score, 0, Vec::new())),
        }
    }
    *found = best.map(|(point, score, before, mut trail)| {
        let evaluations = before + points.len() as u64;
        trail.push(Step { evaluations, best: score.value });
        Found { point, score, evaluations, trail, stopped: Stopped::Exhausted }
    });
}

impl Stopping {
    /// The conditions that are known before a batch is evaluated.
    fn counted(&self, evaluations: u64, generation: u64) -> Option<Stopped> {
        if self.generations.is_some_and(|most| generation >= most) {
            return Some(Stopped::Generations);
        }
        self.evaluations.is_some_and(|most| evaluations >= most).then_some(Stopped::Evaluations)
    }

    fn met(&self, found: &Found, generation: u64, seconds: f64) -> Option<Stopped> {
        if let Some(stopped) = self.counted(found.evaluations, generation) {
            return Some(stopped);
        }
        if self.stalled.is_some_and(|stalled| stalled.met(&found.trail)) {
            return Some(Stopped::Tolerance);
        }
        self.seconds.is_some_and(|most| seconds >= most).then_some(Stopped::Time)
    }
}

impl Stalled {
    fn met(&self, trail: &[Step]) -> bool {
        let Some(before) = usize::try_from(self.generations).ok().and_then(|back| trail.len().checked_sub(back + 1))
        else {
            return false;
        };
        let (old, new) = (trail[before].best, trail[trail.len() - 1].best);
        let change = (old - new).abs() / self.generations.max(1) as f64;
        change <= self.tolerance * new.abs().max(f64::MIN_POSITIVE)
    }
}
