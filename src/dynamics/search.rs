//! The first event of a flow, certified.
//!
//! A guard g(t) is positive while a contact state holds. Between events it is a parabola plus the shares of the blocks. Time is
//! cut into cells, as long as the blocks that matter allow; over a cell a guard is a product of tables ([`super::economised`]) with
//! value and slope at the cell's start, in Bernstein form and with a bound on what is left out. That proves that the guard
//! keeps its sign, or that it has one root and no more ([`super::enclosure`]): multiply-adds, no power, no exponential.
//!
//! Each guard has its own proof of how long it is clear; the search works on the one whose proof ends first. A root is known by
//! a bracket until no other guard can come before it; then it is polished. Where cells prove nothing (guards that start at rest,
//! grazes within 1e-10 of the amplitude) windows of Taylor series take over ([`super::window`]). No cell is sampled, no
//! crossing stepped over, and nothing is kept from one search to the next.

use super::bank::Bank;
use super::block::{Block, Kernel, Phase};
use super::contact::Crossing;
use super::economised::{Economised, KEPT, Level, Product};
use super::enclosure::{Coefficients, DEGREE, Enclosure, Proven, SHARP, Turn, may_turn, turns};
use super::flow::{Flow, Parabola};
use super::polynomial::nearest_root;
use super::series::Series;
use super::signals::Signals;
use super::window::{Span, Start, Verdict, Window};

/// radius·Δ of the fastest block in a first window.
const REACH: f64 = 3.7;
/// Share of a guard's value that blocks too fast for its cells may reach together.
const NOISE: f64 = 0.25;
/// Share of a cell that a proof has to be ahead of it before the next one begins there.
const WORTH_A_MOVE: f64 = 0.9;
/// Share of a cell that has to be proven for the next one to begin there; else it is shortened.
const WORTH_A_STEP: f64 = 0.25;
/// radius·t below which a window polynomial leaves out less than rounding.
const SHORT_HOP: f64 = 0.02;
/// radius·δ below which the local expansion of a guard, to the seventh, is exact to rounding.
const NEAR: f64 = 0.03;

/// What a search knows of a flow.
#[derive(Clone, Copy)]
struct Motion<'a> {
    blocks: &'a [Block],
    bank: &'a Bank,
    series: &'a Series,
    cells: &'a Economised,
}

impl Motion<'_> {
    #[inline]
    fn kernels(self, t: f64, kernels: &mut [Kernel]) {
        self.bank.kernels(self.blocks, t, kernels);
    }
}

/// A guard at the start of a segment: parabola + sign × signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Guard {
    /// Whose it is.
    pub(crate) particle: usize,
    /// Where it leads.
    pub(crate) crossing: Crossing,
    /// The watched signal that moves it.
    pub(crate) signal: usize,
    pub(crate) sign: f64,
    /// Polynomial part, the sign folded in.
    pub(crate) parabola: Parabola,
    /// How the guard starts.
    pub(crate) start: Start,
    /// Whether the guard is a distance, so that its clearance counts as a margin.
    pub(crate) distance: bool,
}

/// What the search found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Found {
    /// No guard reaches zero before the limit.
    Nothing,
    /// Guard `guard` is the first, `time` seconds after the start.
    Event { guard: usize, time: f64 },
}

/// Running record of how clearly events were decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Clarity {
    /// Smallest distance by which a guard would have to be moved for the sequence to change.
    pub(crate) margin: f64,
    /// Decisions within rounding.
    pub(crate) ties: u64,
}

/// Work space of a search; kept between searches so that nothing is allocated.
#[derive(Debug)]
pub(crate) struct Search {
    /// The guards.
    pub(crate) guards: Vec<Guard>,
    /// Until when each of them is known to stay positive.
    clear: Vec<f64>,
    /// Where the last cell of each of them began.
    looked: Vec<f64>,
    /// Where each of them has its first root, once that is isolated.
    roots: Vec<Option<Root>>,
    /// Where guards have come closer to zero than ever before, without reaching it.
    turns: Vec<Turn>,
    found_turns: Vec<Turn>,
    /// The signals as they are at `now`, as far as they have been looked at.
    views: Vec<View>,
    /// Their shares, signal by signal, and bounds on them from then on.
    current: Vec<Phase>,
    amplitudes: Vec<f64>,
    /// Where cells begin, seconds from the segment's start, and the kernels up to there.
    now: f64,
    here: Vec<Kernel>,
    /// Kernels from the segment's start to the result.
    pub(crate) kernels: Vec<Kernel>,
    trial: Vec<Kernel>,
    /// Cells and windows are shorter by this factor, to have a second accuracy to compare with: cells by levels.
    window_factor: f64,
    shorter: usize,
    /// Windows below this are not divided any more, s. It grows from doubt to doubt: a guard that stays within rounding of
    /// zero must not hold up the search.
    shortest: f64,
}

/// A signal at an instant, and a bound on it from then on.
#[derive(Debug, Clone, Copy)]
struct View {
    /// NaN until it is looked at.
    at: f64,
    value: f64,
    rate: f64,
    /// Σ amplitude, Σ amplitude·radius².
    reach: f64,
    bend: f64,
    /// Its product over cells of this level, once one is asked for.
    level: usize,
    product: Product,
}

impl View {
    const NONE: Self =
        Self { at: f64::NAN, value: 0.0, rate: 0.0, reach: 0.0, bend: 0.0, level: usize::MAX, product: Product::NONE };
}

/// The one root of a guard in a bracket, seconds from the segment's start.
#[derive(Debug, Clone, Copy)]
struct Root {
    guess: f64,
    low: f64,
    high: f64,
}

/// A polished root.
struct Polished {
    time: f64,
    /// By how much the guard would have to be moved for this crossing to vanish.
    margin: f64,
}

/// What a cell brings.
enum Cell {
    /// Proven up to this time, or its root is known from then on.
    Clear(f64),
    /// A shorter one might prove more.
    Shorter,
}

impl Search {
    pub(crate) fn new(window_factor: f64) -> Self {
        let mut shorter = 0;
        while shorter < 8 && window_factor * f64::from(1 << shorter) < 1.0 {
            shorter += 1;
        }
        Self {
            guards: Vec::new(),
            clear: Vec::new(),
            looked: Vec::new(),
            roots: Vec::new(),
            turns: Vec::new(),
            found_turns: Vec::new(),
            views: Vec::new(),
            current: Vec::new(),
            amplitudes: Vec::new(),
            now: 0.0,
            here: Vec::new(),
            kernels: Vec::new(),
            trial: Vec::new(),
            window_factor,
            shorter,
            shortest: 0.0,
        }
    }

    /// Finds the first event before `limit` seconds; leaves the kernels of that time, or of the limit.
    pub(crate) fn run(&mut self, flow: &Flow, signals: &Signals, limit: f64, clarity: &mut Clarity) -> Found {
        // The same search three times: with one or two blocks the compiler unrolls every loop over them.
        let motion = |blocks| Motion { blocks, bank: &flow.bank, series: &flow.series, cells: &flow.cells };
        match &flow.blocks[..] {
            one @ [_] => self.first(motion(one), signals, limit, clarity),
            two @ [_, _] => self.first(motion(two), signals, limit, clarity),
            many => self.first(motion(many), signals, limit, clarity),
        }
    }

    #[inline(always)]
    fn first(&mut self, motion: Motion<'_>, signals: &Signals, limit: f64, clarity: &mut Clarity) -> Found {
        self.start(motion, signals, limit, clarity);
        // Below the rounding of the clock nothing can be told apart: what happens at the limit comes first.
        let instant = 4.0 * f64::EPSILON * limit;
        let mut found = Found::Nothing;
        let (mut horizon, mut margin) = (limit, f64::INFINITY);
        loop {
            let (guard, clear) = self.least_clear();
            if !(clear < horizon - instant) {
                break;
            }
            let Some(root) = self.roots[guard] else {
                self.look(motion, signals, guard, horizon, limit, clarity);
                continue;
            };
            let polished = self.polish(motion, signals, guard, root, clarity);
            let time = polished.time;
            self.clear[guard] = f64::INFINITY;
            let earlier = match found {
                // Cells do not end at the limit.
                Found::Nothing => time <= limit,
                Found::Event { guard: other, time: known } => {
                    // Two roots that rounding cannot tell apart: the order of the guards decides.
                    let tie = (time - known).abs() <= 4.0 * f64::EPSILON * known;
                    clarity.ties += u64::from(tie);
                    if tie { guard < other } else { time < known }
                }
            };
            if earlier {
                found = Found::Event { guard, time };
                (horizon, margin) = (time, polished.margin);
                std::mem::swap(&mut self.kernels, &mut self.trial);
            }
        }
        let before = self.turns.iter().filter(|turn| turn.at <= horizon);
        clarity.margin = before.fold(clarity.margin.min(margin), |least, turn| least.min(turn.value));
        if found == Found::Nothing {
            motion.kernels(limit, &mut self.kernels);
        }
        found
    }

    /// Makes room, and looks how long cheap bounds keep every guard clear.
    #[inline(always)]
    fn start(&mut self, motion: Motion<'_>, signals: &Signals, limit: f64, clarity: &Clarity) {
        let count = self.guards.len();
        self.clear.clear();
        self.clear.resize(count, 0.0);
        self.turns.clear();
        self.looked.clear();
        self.looked.resize(count, f64::NAN);
        self.roots.clear();
        self.roots.resize(count, None);
        self.views.clear();
        self.views.resize(signals.len(), View::NONE);
        let size = motion.blocks.len() * signals.len();
        if self.current.len() < size {
            self.current.resize(size, Phase::default());
            self.amplitudes.resize(size, 0.0);
        }
        for kernels in [&mut self.here, &mut self.kernels, &mut self.trial] {
            kernels.resize(motion.bank.places(), Kernel::NONE);
        }
        self.now = 0.0;
        self.shortest = f64::EPSILON * limit;
        for index in 0..count {
            let guard = self.guards[index];
            self.view(motion, signals, guard.signal, limit);
            self.clear[index] = self.quick(&guard, guard.start, guard.parabola, clarity);
        }
    }

    /// How long two cheap bounds keep a guard clear, by more than the smallest margin so far: its parabola is further from
    /// zero than all blocks together can reach, or value and slope are larger than their curvature can undo.
    #[inline(always)]
    fn quick(&self, guard: &Guard, start: Start, here: Parabola, clarity: &Clarity) -> f64 {
        let view = &self.views[guard.signal];
        let bend = here.p2 - 0.5 * view.bend;
        match start {
            Start::Apart => {
                let margin = if guard.distance { clarity.margin } else { 0.0 };
                let least = margin.min(view.reach);
                let (value, rate) = (here.p0 + guard.sign * view.value, here.p1 + guard.sign * view.rate);
                let noise = 1e-12 * (here.p0.abs() + view.reach);
                clear_until(here, view.reach + least, margin).max(clear_until(
                    Parabola { p0: value, p1: rate, p2: bend },
                    noise + least,
                    margin,
                ))
            }
            // It grows as long as its slope cannot have been turned.
            Start::Touching { order: 1, slope } if slope > 0.0 => {
                if bend < 0.0 {
                    -0.5 * slope / bend
                } else {
                    f64::INFINITY
                }
            }
            Start::Touching { .. } => 0.0,
        }
    }

    #[inline(always)]
    fn least_clear(&self) -> (usize, f64) {
        let mut least = (0, f64::INFINITY);
        for (guard, clear) in self.clear.iter().enumerate() {
            if *clear < least.1 {
                least = (guard, *clear);
            }
        }
        least
    }

    /// Extends the proof of one guard from where it ends, or isolates its root.
    #[inline(always)]
    fn look(
        &mut self,
        motion: Motion<'_>,
        signals: &Signals,
        index: usize,
        horizon: f64,
        limit: f64,
        clarity: &mut Clarity,
    ) {
        let guard = self.guards[index];
        let clear = self.clear[index];
        if self.looked[index] == self.now {
            self.move_to(motion, clear);
        }
        let cells = motion.cells;
        let (mut now, mut start, mut parabola, mut value, mut quotient, mut level);
        loop {
            now = self.now;
            self.view(motion, signals, guard.signal, limit);
            start = if now == 0.0 { guard.start } else { Start::Apart };
            let view = &self.views[guard.signal];
            parabola = Parabola { p0: guard.parabola.at(now), p1: guard.parabola.rate(now), p2: guard.parabola.p2 };
            (value, quotient) = match start {
                Start::Apart => (parabola.p0 + guard.sign * view.value, false),
                Start::Touching { order: 1, slope } if slope.is_nan() => (parabola.p1 + guard.sign * view.rate, true),
                Start::Touching { order: 1, slope } => (slope, true),
                Start::Touching { .. } => (0.0, true),
            };
            level = if value > 0.0 { self.suitable(motion, guard.signal, value, quotient) } else { 0 };
            while level > 0 && now + cells.length(level - 1) > horizon {
                level -= 1;
            }
            if clear - now > WORTH_A_MOVE * cells.length(level) {
                self.move_to(motion, clear);
            } else {
                break;
            }
        }
        self.looked[index] = now;
        if value > 0.0 {
            if now > 0.0 {
                // So far from zero that nothing can bring it there for longer than a cell.
                let until = now + self.quick(&guard, start, parabola, clarity);
                if until > clear.max(now + cells.length(level)) {
                    self.clear[index] = until;
                    return;
                }
            }
            loop {
                let cell = cells.level(motion.blocks, level);
                match self.cell(motion, (cell, level), index, parabola, value, quotient, horizon, clarity) {
                    Cell::Clear(until) => {
                        self.clear[index] = until.max(clear);
                        return;
                    }
                    Cell::Shorter if level > 0 && now + cells.length(level - 1) > clear => level -= 1,
                    Cell::Shorter => break,
                }
            }
        }
        self.look_closer(motion, index, start, horizon, limit, clarity);
    }

    /// The signal as it is now, with its bounds.
    #[inline(always)]
    fn view(&mut self, motion: Motion<'_>, signals: &Signals, signal: usize, limit: f64) {
        if self.views[signal].at == self.now {
            return;
        }
        let own = self.own(motion.blocks.len(), signal);
        let (initial, _) = signals.of(signal);
        let moved = self.now > 0.0;
        let (remaining, critical) = (limit - self.now, motion.series.near_critical);
        let mut view = View { at: self.now, ..View::NONE };
        let places = self.current[own.clone()].iter_mut().zip(&mut self.amplitudes[own]);
        for (((block, start), kernel), (share, bound)) in motion.blocks.iter().zip(initial).zip(&self.here).zip(places)
        {
            let now = if moved { block.advance(*start, *kernel) } else { *start };
            // Good for the second derivative too.
            let amplitude = if critical { block.amplitude(now, 2.0, remaining) } else { block.swing(now) };
            (*share, *bound) = (now, amplitude);
            view.value += now.value;
            view.rate += now.rate;
            view.reach += amplitude;
            view.bend += amplitude * (block.radius * block.radius);
        }
        self.views[signal] = view;
    }

    /// Cells begin at `t` from now on.
    #[inline(always)]
    fn move_to(&mut self, motion: Motion<'_>, t: f64) {
        self.now = t;
        motion.kernels(t, &mut self.here);
    }

    /// The cells that suit the fastest block that can bring the guard near zero; `quotient`: its slope.
    #[inline(always)]
    fn suitable(&self, motion: Motion<'_>, signal: usize, value: f64, quotient: bool) -> usize {
        let amplitudes = &self.amplitudes[self.own(motion.blocks.len(), signal)];
        let mut most = NOISE * value;
        for &(block, level) in &motion.cells.fastest {
            most -= if quotient { 2.0 * motion.blocks[block].radius * amplitudes[block] } else { amplitudes[block] };
            if most < 0.0 {
                return level.saturating_sub(self.shorter);
            }
        }
        motion.cells.top().saturating_sub(self.shorter)
    }

    /// What a cell that begins now proves of a guard with `value` now, or with that slope if it starts at zero.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a guard comes in pieces, so that nothing is copied")]
    fn cell(
        &mut self,
        motion: Motion<'_>,
        (level, number): (&Level, usize),
        index: usize,
        parabola: Parabola,
        value: f64,
        quotient: bool,
        horizon: f64,
        clarity: &Clarity,
    ) -> Cell {
        let guard = &self.guards[index];
        let shares = &self.current[self.own(motion.blocks.len(), guard.signal)];
        let length = level.length;
        let bent = parabola.p2 * (length * length);
        let (doubt, start) = if quotient {
            (level.left_out_of_quotient(shares), value * length)
        } else {
            let rounding = 8.0 * f64::EPSILON * (parabola.p0.abs() + (parabola.p1 * length).abs() + bent.abs());
            (level.left_out(shares) + rounding, value)
        };
        if !(2.0 * doubt < start) {
            return Cell::Shorter;
        }
        let view = &mut self.views[guard.signal];
        if view.level != number {
            // The other face of an enclosure has it too.
            (view.level, view.product) = (number, level.product(shares));
        }
        let product = &view.product;
        let sloped = if quotient { start } else { (parabola.p1 + guard.sign * product.rate) * length };
        let mut h = [0.0; KEPT];
        for i in 0..KEPT {
            h[i] = sloped + (bent * SEVENTHS[i] + guard.sign * product.h[i]);
        }
        let mut b: Coefficients = [0.0; DEGREE + 1];
        if quotient {
            // One degree more, so that all cells have the same.
            (b[0], b[DEGREE]) = (h[0], h[KEPT - 1]);
            for i in 1..KEPT {
                b[i] = EIGHTHS[i] * h[i - 1] + EIGHTHS[DEGREE - i] * h[i];
            }
        } else {
            b[0] = parabola.p0 + guard.sign * product.value;
            for i in 0..KEPT {
                b[i + 1] = b[0] + EIGHTHS[i + 1] * h[i];
            }
        }
        let end = (horizon - self.now) / length;
        // A little beyond the first root that is known, to see one that comes at the same time.
        let steep = || level.slope_left_out(shares, quotient);
        let enclosure = Enclosure { b, doubt, steep, end: 1.001 * end };
        let proven = enclosure.prove();
        let until = match proven {
            Proven::Clear => 1.0,
            Proven::Until(sigma) if sigma < WORTH_A_STEP => return Cell::Shorter,
            Proven::Until(sigma) => sigma,
            Proven::Root(bracket) => bracket.earliest,
        };
        if guard.distance {
            let mut distance = enclosure.b;
            if quotient {
                distance[0] = 0.0;
                for i in 0..KEPT {
                    distance[i + 1] = EIGHTHS[i + 1] * h[i];
                }
            }
            // A turn that is as low as the record, but for what sharpness allows, is none: motion that comes again and again.
            let record = (1.0 - 2.0 * SHARP) * clarity.margin + doubt;
            if may_turn(&distance, record) {
                self.found_turns.clear();
                turns(&distance, 0.0, 1.0, until.min(end), record, &mut self.found_turns);
                if self.found_turns.iter().any(|turn| doubt > SHARP * turn.value) {
                    return Cell::Shorter;
                }
                let now = self.now;
                let timed = |turn: &Turn| Turn { at: now + length * turn.at, value: turn.value - doubt };
                self.turns.extend(self.found_turns.iter().map(timed));
            }
        }
        let at = |sigma: f64| self.now + length * sigma;
        match proven {
            Proven::Clear => Cell::Clear(at(1.0)),
            Proven::Until(sigma) => Cell::Clear(at(sigma)),
            Proven::Root(bracket) => {
                let [guess, low, high] = [bracket.guess, bracket.low, bracket.high].map(at);
                self.roots[index] = Some(Root { guess, low, high });
                // Rounding of its time must not put it behind another that comes at the same instant.
                Cell::Clear((at(bracket.earliest) - 64.0 * f64::EPSILON * guess).max(self.now))
            }
        }
    }

    /// Extends the proof of one guard by windows, where cells prove nothing.
    #[cold]
    #[inline(never)]
    fn look_closer(
        &mut self,
        motion: Motion<'_>,
        index: usize,
        start: Start,
        horizon: f64,
        limit: f64,
        clarity: &mut Clarity,
    ) {
        let guard = self.guards[index];
        let now = self.now;
        let mut window = (self.window_factor * REACH * motion.series.unit).min(1.25 * (horizon - now)).min(limit - now);
        let own = self.own(motion.blocks.len(), guard.signal);
        let mut piece = Window::new();
        loop {
            let indivisible = window <= self.shortest.max(64.0 * f64::EPSILON * now);
            if motion.series.near_critical {
                self.bound(motion.blocks, own.clone(), window);
            }
            let span = Span::new(motion.series, now, window);
            let (shares, amplitudes) = (&self.current[own.clone()], &self.amplitudes[own.clone()]);
            let bounds = motion.series.bounds(amplitudes, &span);
            piece.expand(motion.series, shares, &bounds, guard.sign, guard.parabola, &span, start);
            let verdict = piece.judge(|order| {
                let bent = guard.parabola.p2.abs() * (span.length * span.length);
                let parabola = if order == 0 { 2.0 * bent } else { 0.0 };
                parabola + motion.series.bend(amplitudes, span.length * motion.series.pace, order)
            });
            let mut root = |guess: f64, high: f64| {
                self.roots[index] = Some(Root { guess: now + guess * window, low: now, high: now + high * window });
            };
            match verdict {
                Verdict::Clear { clearance } => {
                    self.clear[index] = self.clear[index].max(now + window);
                    self.shortest = f64::EPSILON * limit;
                    if guard.distance {
                        clarity.margin = clarity.margin.min(clearance);
                    }
                }
                Verdict::Root { guess, high } => root(guess, high),
                Verdict::Unsure if indivisible => {
                    clarity.ties += 1;
                    clarity.margin = 0.0;
                    if piece.end() < 0.0 {
                        root(1.0, 1.0);
                    } else {
                        self.clear[index] = self.clear[index].max(now + window);
                        self.shortest *= 4.0;
                    }
                }
                // Shorter than what is proven already: the next one begins where that ends.
                Verdict::Unsure if 0.5 * window < self.clear[index] - now => {}
                Verdict::Unsure => {
                    window *= 0.5;
                    continue;
                }
            }
            return;
        }
    }

    /// Places of a signal's shares.
    #[inline(always)]
    fn own(&self, width: usize, signal: usize) -> std::ops::Range<usize> {
        signal * width..(signal + 1) * width
    }

    /// Bounds anew the shares of blocks near critical damping, for the twelfth derivative over one window.
    #[cold]
    fn bound(&mut self, blocks: &[Block], own: std::ops::Range<usize>, window: f64) {
        for ((amplitude, share), block) in self.amplitudes[own.clone()].iter_mut().zip(&self.current[own]).zip(blocks) {
            *amplitude = block.amplitude(*share, 12.0, window);
        }
    }

    /// The time of an isolated root, to the last digit; leaves its kernels on trial.
    #[inline(always)]
    fn polish(
        &mut self,
        motion: Motion<'_>,
        signals: &Signals,
        index: usize,
        root: Root,
        clarity: &mut Clarity,
    ) -> Polished {
        let guard = self.guards[index];
        let from = root.low;
        if root.high == from {
            motion.kernels(from, &mut self.trial);
            return Polished { time: from, margin: f64::INFINITY };
        }
        if from == 0.0 && guard.start != Start::Apart && root.guess * motion.series.pace < SHORT_HOP {
            return Polished { time: self.polish_short_hop(motion, index, root), margin: f64::INFINITY };
        }
        let (initial, _) = signals.of(guard.signal);
        let (mut lower, mut upper) = (from, root.high);
        let slack = 1e-3 * (upper - lower);
        let mut time = root.guess;
        for _ in 0..60 {
            motion.kernels(time, &mut self.trial);
            let local = self.local(motion, initial, &guard, time);
            if local[0] >= 0.0 {
                lower = lower.max(time)
            } else {
                upper = upper.min(time)
            }
            let mut scaled = nearest_root(&local);
            let mut delta = scaled * motion.series.unit;
            let mut next = time + delta;
            if (next >= lower - slack && next <= upper + slack) || delta.abs() <= 8.0 * f64::EPSILON * time {
                if next < from {
                    // Rounding has put the root of a guard that starts near zero before the window; time never runs backwards.
                    (next, delta) = (from, from - time);
                    scaled = delta / motion.series.unit;
                }
                if scaled.abs() < NEAR {
                    for (kernel, block) in self.trial.iter_mut().zip(motion.blocks) {
                        *kernel = block.compose(*kernel, block.kernel_near_zero(delta));
                    }
                    // About g′²/(2|g″|) at the root.
                    let bend = local[2] + scaled * (3.0 * local[3] + 6.0 * scaled * local[4]);
                    let bend = (4.0 * bend.abs()).max(f64::MIN_POSITIVE);
                    let slope = local[1] + scaled * (2.0 * local[2] + 3.0 * scaled * local[3]);
                    let margin = if guard.distance { slope * slope / bend } else { f64::INFINITY };
                    return Polished { time: next, margin };
                }
                time = next;
            } else {
                // Newton left the bracket (a graze): halve it.
                time = 0.5 * (lower + upper);
            }
            if upper - lower <= 4.0 * f64::EPSILON * upper {
                break;
            }
        }
        motion.kernels(time, &mut self.trial);
        clarity.ties += 1;
        Polished { time, margin: f64::INFINITY }
    }

    /// A hop so short that the window's polynomial is exact, while the difference of parabola and blocks is all rounding.
    #[cold]
    fn polish_short_hop(&mut self, motion: Motion<'_>, index: usize, root: Root) -> f64 {
        let guard = self.guards[index];
        let window = root.high.min(2.0 * root.guess);
        let own = self.own(motion.blocks.len(), guard.signal);
        let mut piece = Window::new();
        let span = Span::new(motion.series, 0.0, window);
        let (shares, amplitudes) = (&self.current[own.clone()], &self.amplitudes[own]);
        let bounds = motion.series.bounds(amplitudes, &span);
        piece.expand(motion.series, shares, &bounds, guard.sign, guard.parabola, &span, guard.start);
        let time = window * piece.refine(root.guess / window, 1.0);
        for (kernel, block) in self.trial.iter_mut().zip(motion.blocks) {
            *kernel = block.kernel_near_zero(time);
        }
        time
    }

    /// Taylor coefficients of a guard about `time`, to the seventh, in powers of ρδ.
    #[inline(always)]
    fn local(&self, motion: Motion<'_>, initial: &[Phase], guard: &Guard, time: f64) -> [f64; 8] {
        let moved = motion.blocks.iter().zip(&self.trial).zip(initial);
        let mut a = motion.series.expand::<0, 8>(moved.map(|((block, kernel), phase)| block.advance(*phase, *kernel)));
        let unit = motion.series.unit;
        let parabola = guard.parabola;
        let rest = [parabola.at(time), parabola.rate(time) * unit, parabola.p2 * (unit * unit)];
        a.iter_mut().for_each(|a| *a *= guard.sign);
        for (a, rest) in a.iter_mut().zip(rest) {
            *a += rest;
        }
        a
    }
}

/// How long a parabola keeps further from zero than `reach`; 0 if it is not so now, nor where it may come closer to that
/// than `margin`, so that no jump passes over the narrowest place of a run.
#[inline(always)]
fn clear_until(parabola: Parabola, reach: f64, margin: f64) -> f64 {
    let Parabola { p0, p1: b, p2: a } = parabola;
    let c = p0 - reach;
    if !(c > 0.0) {
        return 0.0;
    }
    if a >= 0.0 && b >= 0.0 {
        return f64::INFINITY;
    }
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        // Its lowest point is c − b²/4a.
        return if -discriminant < 4.0 * a * margin { 0.0 } else { f64::INFINITY };
    }
    // The first positive root of c + b τ + a τ², written without cancellation.
    let root = discriminant.sqrt();
    if b <= 0.0 { 2.0 * c / (root - b) } else { (b + root) / (-2.0 * a) }
}

/// i/7 and i/8.
const SEVENTHS: [f64; KEPT] = [0.0, 1.0 / 7.0, 2.0 / 7.0, 3.0 / 7.0, 4.0 / 7.0, 5.0 / 7.0, 6.0 / 7.0, 1.0];
const EIGHTHS: [f64; DEGREE + 1] = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0];
