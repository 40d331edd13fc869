//! Curves: the rows of a table split into lines.
//!
//! Every combination of the levels of the `by` columns and of the y columns is one line. The first thing that varies
//! among them shows as colour, the rest as dashes; where only one thing varies it shows as both.

use crate::experiment::{Band, Panel, START_LISTS, Stability};
use crate::table::{Column, Data};

use super::branch::Branches;
use super::error::FigureError;
use super::group::{Group, is_outcome};
use super::sample::Sample;
use super::source::Source;
use super::style::Look;
use super::{label, searches};
use crate::text::name;

/// The value that a curve takes at infinite x, or without an x.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AtInfinity {
    pub y: f64,
    pub label: String,
}

/// What a curve is called in the legend.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Name {
    /// What its colour stands for, or all there is to say where colour and dash stand for the same.
    pub hue: String,
    /// What its dash stands for, where that is something else.
    pub dash: Option<String>,
}

impl Name {
    /// Of what there is to say of a branch, and its stability.
    fn with_stability(words: &[String], stability: Stability) -> Self {
        let stability = stability.word().to_owned();
        match words {
            [] => Self { hue: stability, dash: None },
            words => Self { hue: words.join(", "), dash: Some(stability) },
        }
    }

    /// In full.
    pub(super) fn full(&self) -> String {
        match &self.dash {
            Some(dash) => format!("{}, {dash}", self.hue),
            None => self.hue.clone(),
        }
    }
}

/// How the samples of a curve are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Join {
    /// Joined by a line.
    Line,
    /// Each as a dot: values of each cycle, of which a row has many.
    Dots,
}

/// One line of a panel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Curve {
    /// Which of the groups that the rows fall into by `by`.
    pub group: usize,
    pub name: Name,
    pub look: Look,
    pub join: Join,
    /// Sorted by x unless it is a time history or runs along a branch.
    pub samples: Vec<Sample>,
    /// How many searches the band spans; 0 where it is none of theirs.
    pub seeds: usize,
    /// It is alone and named by what came out, which a legend says.
    pub is_outcome: bool,
    pub at_infinity: Option<AtInfinity>,
}

impl Curve {
    /// Breaks its line between samples that one of these places lies between.
    fn part_at(&mut self, mut places: Vec<f64>) {
        places.sort_by(f64::total_cmp);
        let lies_between = |a: f64, b: f64| {
            let beyond = places.partition_point(|place| *place <= a);
            places.get(beyond).is_some_and(|place| *place < b)
        };
        let mut last = f64::NAN;
        let parted = self.samples.drain(..).flat_map(|sample| {
            let gap = lies_between(last, sample.x).then(Sample::gap);
            last = sample.x;
            gap.into_iter().chain([sample])
        });
        self.samples = parted.collect();
    }

    /// True if no two of its points are joined.
    pub(super) fn is_of_single_points(&self) -> bool {
        let seen = |sample: &Sample| sample.x.is_finite() && sample.y.is_finite();
        self.at_infinity.is_none() && !self.samples.windows(2).any(|pair| pair.iter().all(seen))
    }

    /// Only what lies between two places, up to where the line crosses them.
    pub(super) fn cut_to(&mut self, [from, to]: [f64; 2]) {
        let holds = |x: f64| x >= from && x <= to;
        let mut kept: Vec<Sample> = Vec::new();
        let mut before: Option<Sample> = None;
        for &here in &self.samples {
            if let Some(before) = before.filter(|_| self.join == Join::Line) {
                let bounds = if before.x < here.x { [from, to] } else { [to, from] };
                kept.extend(bounds.into_iter().filter_map(|bound| before.towards(here, bound)));
                if !holds(here.x) {
                    kept.push(Sample::gap());
                }
            }
            if holds(here.x) || here.x.is_nan() {
                kept.push(here);
            }
            before = Some(here);
        }
        self.samples = kept;
    }

    /// True if there is anything to see.
    pub(super) fn shows(&self) -> bool {
        self.at_infinity.is_some() || self.samples.iter().any(|sample| sample.y.is_finite())
    }
}

/// The column of seeds. They have no order, so that no line joins them; what needs none is a level across.
const SEED: &str = "seed";

/// The curves of a panel in the order of its y columns and of the table's rows; none without a number.
pub(super) fn curves(source: Source<'_>, panel: &Panel) -> Result<Vec<Curve>, FigureError> {
    let by = panel.by.iter().map(|name| source.column(name)).collect::<Result<Vec<_>, _>>()?;
    let groups = Group::split(source.table.rows(), &by);
    let x = source.column(&panel.x.column)?;
    let branches = Branches::of(source, panel)?;
    let alike = source.panels.iter().filter(|other| other.by == panel.by);
    let drawn: Vec<&Column> = alike.flat_map(|other| &other.y).filter_map(|y| source.table.column(&y.column)).collect();
    // Only what shows takes a colour.
    let shows = |group: &&Group| drawn.iter().any(|y| group.rows.iter().any(|&row| holds(y, row)));
    let shown: Vec<&Group> = groups.iter().filter(shows).collect();
    let is_outcome = groups.len() == 1 && by.iter().any(|column| is_outcome(column));
    let mut curves = Vec::new();
    for (index, axis) in panel.y.iter().enumerate() {
        let y = source.column(&axis.column)?;
        let spread = source.table.column(&name::spread(&y.name)).filter(|_| panel.band == Band::Spread);
        for (number, group) in groups.iter().enumerate() {
            let traits = Traits::new(source, index, panel.y.len(), &shown, group);
            let mut words = if panel.y.len() > 1 { vec![source.label(axis)?] } else { Vec::new() };
            // What came out is worth a name, even if nothing else did.
            words.extend(if groups.len() == 1 { group.outcome(&by) } else { group.varying_words(&groups) });
            let join = join(x, y);
            let look = match join {
                Join::Dots => Look::of_dots(number, groups.len(), group.rows.len()),
                Join::Line => Look::of_path(&y.name).filter(|_| groups.len() == 1).unwrap_or_else(|| traits.look()),
            };
            if let Some(branches) = &branches {
                for stability in Stability::ALL {
                    let look = look.with_stability(stability);
                    let samples = branches.samples(x, y, &group.rows, stability);
                    let name = Name::with_stability(&words, stability);
                    let curve =
                        Curve { group: number, name, look, join, samples, seeds: 0, is_outcome, at_infinity: None };
                    curves.extend(Some(curve).filter(Curve::shows));
                }
                continue;
            }
            let name = match words.split_first() {
                // Dots have no dash.
                Some(_) if join == Join::Dots => Name { hue: words.join(", "), dash: None },
                None => Name { hue: source.label(axis)?, dash: None },
                Some((hue, rest)) => Name { hue: hue.clone(), dash: (!rest.is_empty()).then(|| rest.join(", ")) },
            };
            let mut curve =
                Curve { group: number, name, look, join, samples: Vec::new(), seeds: 0, is_outcome, at_infinity: None };
            match (panel.band, &x.data, &y.data) {
                (Band::Seeds, Data::FloatList(steps), Data::FloatList(values)) => {
                    let search = |&row: &usize| Some((steps.get(row)?.as_slice(), values.get(row)?.as_slice()));
                    let searches: Vec<_> =
                        group.rows.iter().filter_map(search).filter(|one| !one.0.is_empty()).collect();
                    curve.samples = searches::median(&searches);
                    curve.seeds = searches.len();
                }
                _ => fill(&mut curve, source.figure, x, y, spread, &group.rows)?,
            }
            curve.part_at(group.others_between(x, &by, &groups));
            if curve.shows() {
                curves.push(curve);
            }
        }
    }
    if panel.over_first {
        over_first(&mut curves);
    }
    if panel.band == Band::Stacked {
        stack(&mut curves);
    }
    if curves.is_empty() {
        return Err(FigureError::Nothing { figure: source.figure.to_owned() });
    }
    Ok(curves)
}

/// A list a row above a number a row is a cloud, and so are coordinates of starts, which have no order.
fn join(x: &Column, y: &Column) -> Join {
    let of_starts = |column: &Column| START_LISTS.iter().any(|(name, _)| column.name.starts_with(name));
    match (&x.data, &y.data) {
        (Data::Float(_) | Data::Int(_), Data::FloatList(_)) => Join::Dots,
        (Data::FloatList(_), Data::FloatList(_)) if of_starts(x) && of_starts(y) => Join::Dots,
        _ => Join::Line,
    }
}

/// Puts each curve on top of those before it, at all places that some curve has; one that is not there has no height.
fn stack(curves: &mut [Curve]) {
    let mut places: Vec<f64> = curves.iter().flat_map(|curve| &curve.samples).map(|sample| sample.x).collect();
    places.retain(|x| x.is_finite());
    places.sort_by(f64::total_cmp);
    places.dedup();
    let mut below = vec![0.0; places.len()];
    for curve in curves {
        let height = |x: f64| -> f64 {
            curve.samples.iter().filter(|sample| sample.x == x && sample.y.is_finite()).map(|one| one.y).sum()
        };
        let heights: Vec<f64> = places.iter().map(|&x| height(x)).collect();
        let near = |i: usize| heights[i.saturating_sub(1)..heights.len().min(i + 2)].iter().any(|height| *height > 0.0);
        let samples = places.iter().enumerate().map(|(i, &x)| {
            let foot = below[i];
            below[i] += heights[i];
            // Away from where it is there is nothing to draw.
            if near(i) { Sample { x, y: below[i], band: [foot, below[i]] } } else { Sample::gap() }
        });
        curve.samples = samples.collect();
        curve.look = curve.look.solid();
    }
}

/// Every curve over the first one, at the places that both have.
fn over_first(curves: &mut [Curve]) {
    let Some(first) = curves.first().map(|first| first.samples.clone()) else { return };
    for curve in curves {
        let over = |sample: Sample| {
            let below = first.iter().find(|one| one.x.total_cmp(&sample.x).is_eq())?;
            Some(sample.divided_by(below.y))
        };
        curve.samples = curve.samples.iter().copied().filter_map(over).collect();
        curve.at_infinity = None;
    }
}

/// Whether a cell has something to draw.
fn holds(column: &Column, row: usize) -> bool {
    match &column.data {
        Data::FloatList(cells) => cells.get(row).is_some_and(|cell| !cell.is_empty()),
        _ => column.data.number(row).is_some_and(f64::is_finite),
    }
}

fn fill(
    curve: &mut Curve,
    figure: &str,
    x: &Column,
    y: &Column,
    spread: Option<&Column>,
    rows: &[usize],
) -> Result<(), FigureError> {
    match (&x.data, &y.data) {
        (Data::Text(_), _) | (_, Data::Text(_)) => {
            let column = if matches!(x.data, Data::Text(_)) { x } else { y };
            Err(FigureError::Text { figure: figure.to_owned(), column: column.name.clone() })
        }
        (Data::FloatList(times), Data::FloatList(values)) => {
            for (&row, last) in rows.iter().zip((0..rows.len()).rev()) {
                let history = times.get(row).into_iter().flatten().zip(values.get(row).into_iter().flatten());
                let spreads = match spread.map(|spread| &spread.data) {
                    Some(Data::FloatList(cells)) => cells.get(row).map_or(&[][..], Vec::as_slice),
                    _ => &[],
                };
                let sample = |(at, (&x, &y)): (usize, (&f64, &f64))| Sample::within(x, y, spreads.get(at).copied());
                curve.samples.extend(history.enumerate().map(sample));
                if last > 0 {
                    curve.samples.push(Sample::gap());
                }
            }
            Ok(())
        }
        (Data::Float(_) | Data::Int(_), Data::FloatList(values)) => {
            for &row in rows {
                let Some(at) = x.data.number(row).filter(|at| at.is_finite()) else { continue };
                curve.samples.extend(values.get(row).into_iter().flatten().map(|&y| Sample::bare(at, y)));
            }
            Ok(())
        }
        (Data::FloatList(_), _) => {
            Err(FigureError::Mixed { figure: figure.to_owned(), x: x.name.clone(), y: y.name.clone() })
        }
        _ => {
            for &row in rows {
                let (Some(at), Some(y)) = (x.data.number(row), y.data.number(row)) else { continue };
                if at.is_finite() {
                    curve.samples.push(Sample::within(at, y, spread.and_then(|spread| spread.data.number(row))));
                } else if x.name == SEED && y.is_finite() {
                    curve.at_infinity = Some(AtInfinity { y, label: curve.name.full() });
                } else if at == f64::INFINITY && y.is_finite() {
                    let label = label::of_cell(x, row).unwrap_or_default();
                    curve.at_infinity = Some(AtInfinity { y, label });
                }
            }
            curve.samples.sort_by(|a, b| a.x.total_cmp(&b.x));
            if x.name == SEED {
                curve.samples = curve.samples.iter().flat_map(|sample| [*sample, Sample::gap()]).collect();
            }
            Ok(())
        }
    }
}

impl Group {
    /// Where rows lie that differ from these in what came out alone, as their kind of motion: no line leads past them.
    fn others_between(&self, x: &Column, by: &[&Column], groups: &[Self]) -> Vec<f64> {
        let beside = |other: &&Self| {
            let differ = || by.iter().enumerate().filter(|(index, _)| other.words[*index] != self.words[*index]);
            differ().next().is_some() && differ().all(|(_, column)| is_outcome(column))
        };
        groups.iter().filter(beside).flat_map(|other| &other.rows).filter_map(|&row| x.data.number(row)).collect()
    }

    /// For each `by` column that varies: which of how many levels this group has.
    fn levels(&self, source: Source<'_>, groups: &[&Self]) -> Vec<Level> {
        let level = |index: usize| {
            let mut seen: Vec<&Option<String>> = Vec::new();
            for group in groups {
                if !seen.contains(&&group.words[index]) {
                    seen.push(&group.words[index]);
                }
            }
            let named = |word: &&Option<String>| Look::hue_of_word(word.as_deref()?, source.colours);
            let fixed: Vec<Option<usize>> = seen.iter().map(named).collect();
            let at = seen.iter().position(|word| **word == self.words[index]).unwrap_or(0);
            Level { index: at, count: seen.len(), hue: hue(&fixed, at) }
        };
        (0..self.words.len()).map(level).filter(|level| level.count > 1).collect()
    }
}

/// One of so many levels.
struct Level {
    index: usize,
    count: usize,
    /// Which of the named colours.
    hue: usize,
}

/// The colour of level `at`: its own where its word has one, else the next that no word has.
fn hue(fixed: &[Option<usize>], at: usize) -> usize {
    if let Some(hue) = fixed.get(at).copied().flatten() {
        return hue;
    }
    let before = fixed[..at.min(fixed.len())].iter().filter(|hue| hue.is_none()).count();
    (0..).filter(|hue| !fixed.contains(&Some(*hue))).nth(before).unwrap_or(at)
}

/// How a line differs from the others of its panel.
#[derive(Clone, Copy)]
struct Traits {
    hue: usize,
    hues: usize,
    dash: usize,
    /// Two measures may agree to the width of a line: the one below is drawn wide enough to be seen.
    beneath: bool,
}

impl Traits {
    fn new(source: Source<'_>, y: usize, ys: usize, groups: &[&Group], group: &Group) -> Self {
        let mut levels = group.levels(source, groups);
        if ys > 1 {
            levels.insert(0, Level { index: y, count: ys, hue: y });
        }
        match levels.as_slice() {
            [] => Self { hue: 0, hues: 1, dash: 0, beneath: false },
            [only] => Self { hue: only.hue, hues: only.count, dash: only.index, beneath: false },
            [first, rest @ ..] => {
                let dash = rest.iter().fold(0, |dash, level| dash * level.count + level.index);
                Self { hue: first.hue, hues: first.count, dash, beneath: y + 1 < ys }
            }
        }
    }

    fn look(self) -> Look {
        let look = Look::new(self.hue, self.hues, self.dash);
        if self.beneath { Look { width: 2.0 * look.width, ..look } } else { look }
    }
}
