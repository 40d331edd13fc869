//! Claims about maps: where a measure is best, and that it grows towards a place.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::absence::Absence;
use super::mapping::{Reads, Seen, claim};
use super::name::Column;
use super::selection::{Allowed, is_number, same};
use super::tally::{Decision, Outcome, Shown, Tally, strict};
use super::text::{percent, significant, with_unit};
use super::view::{Cell, Source, View};
use super::words;
use crate::yaml::At;

/// A place in a map: a number for each coordinate, or the column that holds it (`damper_x: force_x`).
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Place(pub BTreeMap<Column, Coordinate>);

/// A coordinate of a place.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Coordinate {
    /// In the column's unit.
    Number(f64),
    /// The column that holds it, the same in all rows of a map.
    Column(Column),
}

impl Place {
    fn read(at: At<'_>) -> Option<Self> {
        let form = "a place is written as `column: number` or `column: other column`";
        let one = |key: &str, span, at: At<'_>| {
            let column = Column::at(key, span);
            let unit = column.unit();
            let number = |at: At<'_>| at.number_in(unit).map(Coordinate::Number);
            let other = |at: At<'_>| Column::read(at).map(Coordinate::Column);
            let coordinate = at.either(is_number, number, other)?;
            Some((column, coordinate))
        };
        let place = at.by_name(json!({"minProperties": 1}), form, one)?;
        if place.is_empty() { at.wrong(form) } else { Some(Self(place.into_iter().collect())) }
    }
}

impl Reads for Place {
    fn note<'a>(&'a self, seen: &mut Seen<'a>) {
        for (column, coordinate) in &self.0 {
            column.note(seen);
            if let Coordinate::Column(other) = coordinate {
                other.note(seen);
            }
        }
    }
}

claim! {
    "a best place of a map" BestPlace {
        of: Column = required("The measure", Column::read),
        at: Place = required("The place", Place::read),
        position: Position = or("At that very place, or by it", |at| at.word("position"), Position::At),
        among: usize = or("The place is among so many of the best", some, 1),
        slack: f64 =
            or("How far short of the best the place may fall, as a fraction of the map's range", |at| at.fraction(), 0.0),
        each: Option<Column> =
            optional("A column whose levels are maps of their own, of which each has to satisfy the claim", Column::read),
    }
}

fn some(at: At<'_>) -> Option<usize> {
    usize::try_from(at.count_from(1, "", u32::MAX, "a place is among one of the best or more")?).ok()
}

/// Where, seen from a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Position {
    /// At it.
    At,
    /// At it or at one of its neighbours on the grid.
    Near,
    /// At one of its neighbours, not at it.
    Beside,
}

impl Reads for Position {}

claim! {
    "a map that grows towards a place" GrowsTowards {
        of: Column = required("The measure", Column::read),
        to: Place = required("The place", Place::read),
        slack: f64 = or("Step back allowed, as a fraction of the map's range", |at| at.fraction(), 0.0),
        each: Option<Column> =
            optional("A column whose levels are maps of their own, of which each has to satisfy the claim", Column::read),
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (column, coordinate)) in self.0.iter().enumerate() {
            let join = if i == 0 { "" } else { ", " };
            match coordinate {
                Coordinate::Number(x) => write!(f, "{join}{column} = {}", significant(*x, 4))?,
                Coordinate::Column(other) => write!(f, "{join}{column} = {other}")?,
            }
        }
        Ok(())
    }
}

pub(crate) fn best_place(claim: &BestPlace, view: &View<'_>) -> Result<Decision, Absence> {
    let mut tally = Tally::new("");
    let mut found = Vec::new();
    for (level, map) in maps(view, claim.source(), claim.each.as_deref(), &claim.of, &claim.at)? {
        let target = map.index_of_target(&claim.at)?;
        let wanted = |distance: usize| match claim.position {
            Position::At => distance == 0,
            Position::Near => distance <= 1,
            Position::Beside => distance == 1,
        };
        let (meant, others): (Vec<&Spot>, Vec<&Spot>) =
            map.spots.iter().partition(|spot| wanted(spot.steps_from(&target)));
        let highest = |spots: &[&Spot]| {
            spots.iter().copied().cloned().reduce(|a, b| if b.cell.value > a.cell.value { b } else { a })
        };
        let (Some(place), Some(best)) = (highest(&meant), highest(&map.spots.iter().collect::<Vec<_>>())) else {
            return Err(Absence::NoRow(format!("{level}the map has no row at {}", claim.at)));
        };
        if others.len() < claim.among {
            return Err(Absence::NoRow(format!("{level}a map of {} places has no worse ones", map.spots.len())));
        }
        let allowed = claim.slack * map.range();
        // Places that mirror each other differ by rounding alone.
        let short = |spot: &Spot| {
            if same(spot.cell.value, place.cell.value) { 0.0 } else { spot.cell.value - place.cell.value }
        };
        let mut rivals = others.clone();
        rivals.sort_by(|a, b| short(b).total_cmp(&short(a)));
        let rank = 1 + rivals.iter().filter(|spot| short(spot) > 0.0).count();
        let rival = rivals[claim.among - 1];
        let u = if short(rival) == 0.0 { 0.0 } else { libm::hypot(rival.cell.run, place.cell.run) };
        tally.require_in(1.0, Shown::Unit(map.unit.clone()), allowed - short(rival), u, || {
            format!(
                "{level}{} at {}, number {rank} of {}; best {} at {}",
                with_unit(place.cell.value, 4, &map.unit),
                place.words(),
                map.spots.len(),
                with_unit(best.cell.value, 4, &map.unit),
                best.words()
            )
        });
        found.push(Best { level, place: best.words(), value: best.cell.value, unit: map.unit.clone() });
    }
    let decision = tally.decision()?;
    if decision.outcome == Outcome::Holds {
        return Ok(Decision { found: best_in_words(&found), ..decision });
    }
    Ok(decision)
}

/// The best place of one of the maps.
struct Best {
    level: String,
    place: String,
    value: f64,
    unit: String,
}

/// `best: point 1, 3.77 at (0.5, 0.5); point 2, …`; `best 3.77 at (0.5, 0.5)` of a single map; a place that all of them share is
/// named once.
fn best_in_words(found: &[Best]) -> String {
    let value = |value: f64, unit: &str| with_unit(value, 4, unit);
    if let [first, .., _] = found
        && found.iter().all(|one| one.place == first.place)
    {
        let extreme = |pick: fn(f64, f64) -> f64| found.iter().map(|one| one.value).reduce(pick).unwrap_or(first.value);
        let [low, high] = [extreme(f64::min), extreme(f64::max)].map(|x| value(x, &first.unit));
        return format!("best at {} in all {}, {low} to {high}", first.place, found.len());
    }
    let one = |one: &Best| format!("{}{} at {}", one.level, value(one.value, &one.unit), one.place);
    let each = found.iter().map(one).collect::<Vec<_>>().join("; ");
    if found.iter().all(|one| one.level.is_empty()) { format!("best {each}") } else { format!("best: {each}") }
}

pub(crate) fn grows_towards(claim: &GrowsTowards, view: &View<'_>) -> Result<Decision, Absence> {
    let mut tally = Tally::new("");
    let (mut steps, mut up) = (0_usize, 0_usize);
    let mut largest = (0.0_f64, String::new());
    for (level, map) in maps(view, claim.source(), claim.each.as_deref(), &claim.of, &claim.to)? {
        let range = map.range();
        for (from, to) in map.steps_towards_target() {
            let rise = to.cell.value - from.cell.value;
            let way = || format!(", {level}from {} to {}", from.words(), to.words());
            steps += 1;
            up += usize::from(rise > 0.0);
            if -rise / range > largest.0 {
                largest = (-rise / range, way());
            }
            let u = if same(from.cell.value, to.cell.value) { 0.0 } else { libm::hypot(from.cell.run, to.cell.run) };
            tally.require_in(1.0, Shown::PercentOf(range), claim.slack * range + rise, u, || {
                format!(
                    "falls back by {} of the range{} ({} allowed)",
                    percent(-rise / range),
                    way(),
                    percent(claim.slack)
                )
            });
        }
        let by_distance = |spot: &&Spot| map.distance_to_target(spot);
        let nearest = map.spots.iter().min_by(|a, b| by_distance(a).total_cmp(&by_distance(b)));
        let farthest = map.spots.iter().max_by(|a, b| by_distance(a).total_cmp(&by_distance(b)));
        if let (Some(nearest), Some(farthest)) = (nearest, farthest) {
            let rise = nearest.cell.value - farthest.cell.value;
            let u = libm::hypot(nearest.cell.run, farthest.cell.run);
            tally.require_in(1.0, Shown::Unit(map.unit.clone()), strict(rise), u, || {
                format!(
                    "{level}{} at {}, {} at {}",
                    with_unit(nearest.cell.value, 4, &map.unit),
                    nearest.words(),
                    with_unit(farthest.cell.value, 4, &map.unit),
                    farthest.words()
                )
            });
        }
    }
    let decision = tally.decision()?;
    if decision.outcome == Outcome::Holds {
        let (back, way) = largest;
        let back = if back > 0.0 {
            format!("; falls back by at most {} of the range{way}", percent(back))
        } else {
            String::new()
        };
        let found = format!("grows on {up} of {steps} steps{back} ({} allowed)", percent(claim.slack));
        return Ok(Decision { found, ..decision });
    }
    Ok(decision)
}

/// A measure over a grid of places.
struct Map {
    spots: Vec<Spot>,
    /// Of each coordinate: its values on the grid, increasing.
    grid: Vec<Vec<f64>>,
    /// The place that the claim speaks of.
    target: Vec<f64>,
    unit: String,
}

/// A place with its value.
#[derive(Debug, Clone)]
struct Spot {
    at: Vec<f64>,
    /// On the grid.
    index: Vec<usize>,
    cell: Cell,
}

impl Spot {
    /// How many steps of the grid, diagonal ones too, it is away.
    fn steps_from(&self, index: &[usize]) -> usize {
        self.index.iter().zip(index).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
    }

    fn words(&self) -> String {
        let numbers: Vec<String> = self.at.iter().map(|x| significant(*x, 4)).collect();
        format!("({})", numbers.join(", "))
    }
}

/// The maps that a claim speaks of, each with a prefix that names it.
fn maps(
    view: &View<'_>,
    source: Source<'_>,
    each: Option<&str>,
    of: &str,
    place: &Place,
) -> Result<Vec<(String, Map)>, Absence> {
    let Some(each) = each else { return Ok(vec![(String::new(), Map::new(view, source, of, place)?)]) };
    let levels = view.levels(&view.rows(source, Some(each))?, each)?;
    let map = |level: &Allowed| {
        let map = Map::new(&view.narrowed(each, level), source, of, place)?;
        Ok((format!("{}, ", words::of_level(each, level, "")), map))
    };
    levels.iter().map(map).collect()
}

impl Map {
    fn new(view: &View<'_>, source: Source<'_>, of: &str, place: &Place) -> Result<Self, Absence> {
        let rows = view.rows(source, None)?;
        let columns = place.0.keys().map(|name| view.coordinates(&rows, name)).collect::<Result<Vec<_>, _>>()?;
        let target = place
            .0
            .values()
            .map(|coordinate| match coordinate {
                Coordinate::Number(x) => Ok(*x),
                Coordinate::Column(name) => {
                    let cells = view.coordinates(&rows, name)?;
                    let first = cells[0];
                    if cells.iter().all(|cell| same(*cell, first)) {
                        Ok(first)
                    } else {
                        Err(Absence::Broken(format!("`{name}` changes within the map: split it with `each`")))
                    }
                }
            })
            .collect::<Result<Vec<_>, _>>()?;
        let cells = view.cells(&rows, of)?;
        let grid: Vec<Vec<f64>> = columns
            .iter()
            .map(|column| {
                let mut levels = column.clone();
                levels.sort_by(f64::total_cmp);
                levels.dedup_by(|a, b| same(*a, *b));
                levels
            })
            .collect();
        let mut spots: Vec<Spot> = Vec::with_capacity(cells.len());
        for (row, cell) in cells.into_iter().enumerate() {
            let at: Vec<f64> = columns.iter().map(|column| column[row]).collect();
            let index: Vec<usize> = at.iter().zip(&grid).map(|(x, levels)| level_of(levels, *x)).collect();
            if let Some(other) = spots.iter().find(|spot| spot.index == index) {
                if other.cell == cell {
                    continue;
                }
                return Err(Absence::Broken(format!(
                    "two rows at {} differ: `where` or `each` must part them",
                    other.words()
                )));
            }
            spots.push(Spot { at, index, cell });
        }
        let unit = view.unit(&rows, of)?.to_owned();
        Ok(Self { spots, grid, target, unit })
    }

    fn range(&self) -> f64 {
        let values = || self.spots.iter().map(|spot| spot.cell.value);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    }

    fn index_of_target(&self, place: &Place) -> Result<Vec<usize>, Absence> {
        let index = |(x, levels): (&f64, &Vec<f64>)| {
            let at = level_of(levels, *x);
            same(levels[at], *x).then_some(at)
        };
        let found: Option<Vec<usize>> = self.target.iter().zip(&self.grid).map(index).collect();
        found.ok_or_else(|| Absence::NoRow(format!("the grid of the map does not hold {place}")))
    }

    fn distance_to_target(&self, spot: &Spot) -> f64 {
        spot.at.iter().zip(&self.target).zip(&self.grid).fold(0.0, |sum, ((x, target), levels)| {
            let size = (levels[levels.len() - 1] - levels[0]).max(f64::MIN_POSITIVE);
            sum + (x - target).abs() / size
        })
    }

    /// All pairs of neighbours that differ in one coordinate, the farther first.
    fn steps_towards_target(&self) -> Vec<(&Spot, &Spot)> {
        let by_index: BTreeMap<&[usize], &Spot> = self.spots.iter().map(|spot| (spot.index.as_slice(), spot)).collect();
        let mut steps = Vec::new();
        for spot in &self.spots {
            for (axis, target) in self.target.iter().enumerate() {
                let mut next = spot.index.clone();
                next[axis] += 1;
                let Some(other) = by_index.get(next.as_slice()) else { continue };
                let away = |spot: &Spot| spot.at[axis] - target;
                let (here, there) = (away(spot), away(other));
                // From one side of the place to the other is no step towards it.
                if here < 0.0 && there > 0.0 {
                    continue;
                }
                if here.abs() > there.abs() { steps.push((spot, *other)) } else { steps.push((*other, spot)) }
            }
        }
        steps
    }
}

/// The level that a number is, to nine digits, or the nearest one.
fn level_of(levels: &[f64], x: f64) -> usize {
    let distance = |i: &usize| (levels[*i] - x).abs();
    (0..levels.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}
