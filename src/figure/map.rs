//! A map: the rows of a table split into fields, with the places to mark, before their places on the sheet are known.

use crate::experiment::{AxisScale, Best, MapSpec};
use crate::table::{Column, Data};
use crate::text::number::{compact, quantity};

use super::axis::{Axis, Extent, Room};
use super::colormap::{Shades, Steps};
use super::error::FigureError;
use super::field::{Field, Spot, cell_edges};
use super::group::Group;
use super::label;
use super::source::Source;
use crate::text::name;

/// A place on the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub x: f64,
    pub y: f64,
}

/// One panel.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MapPanel {
    /// What tells it from the others, in parts that are not broken; empty if it is alone.
    pub title: Vec<String>,
    pub field: Field,
    pub marks: Vec<Place>,
    /// The places of the best value; several where they share it.
    pub best: Vec<Spot>,
}

/// All panels, with the axes and the colours that they share.
pub(super) struct Map<'a> {
    pub spec: &'a MapSpec,
    pub panels: Vec<MapPanel>,
    pub x: Axis,
    pub y: Axis,
    pub shades: Shades,
    pub x_label: String,
    pub y_label: String,
    pub value_label: String,
    /// What stands for the best place: `highest velocity ratio ψ`.
    pub best_label: String,
    /// Names of the axes within a sentence.
    x_name: String,
    y_name: String,
    value_unit: String,
}

/// The largest standard deviation of an ensemble over its mean, where some motion is chaotic.
fn largest_spread(source: Source<'_>, value: &Column) -> Option<f64> {
    let spread = source.table.column(&name::spread(&value.name))?;
    let share = |row: usize| Some((spread.data.number(row)? / value.data.number(row)?).abs());
    let shares = (0..source.table.rows()).filter_map(share);
    shares.filter(|share| share.is_finite() && *share > 0.0).reduce(f64::max)
}

impl<'a> Map<'a> {
    pub(super) fn new(source: Source<'_>, spec: &'a MapSpec) -> Result<Self, FigureError> {
        let columns = Columns {
            x: source.column(&spec.x.column)?,
            y: source.column(&spec.y.column)?,
            value: source.column(&spec.value.column)?,
        };
        let by = spec.by.iter().map(|name| source.column(name)).collect::<Result<Vec<_>, _>>()?;
        let mark = spec.mark.as_ref().map(|mark| Ok((source.column(&mark.x)?, source.column(&mark.y)?))).transpose()?;
        let groups = Group::split(source.table.rows(), &by);
        let mut panels = Vec::new();
        for group in &groups {
            let spots = columns.spots(source.figure, &group.rows)?;
            let field = Field::of(&spots).map_err(|spot| FigureError::Twice {
                figure: source.figure.to_owned(),
                column: spec.value.column.clone(),
                x: compact(spot.x, 4),
                y: compact(spot.y, 4),
            })?;
            if field.spots().next().is_none() {
                continue;
            }
            let best = best(&field, spec.best);
            let marks = mark.map(|(x, y)| marks(x, y, &group.rows)).unwrap_or_default();
            let title = group.varying_words(&groups);
            panels.push(MapPanel { title, field, marks, best });
        }
        let nothing = || FigureError::Nothing { figure: source.figure.to_owned() };
        let smooth = columns.are_lists();
        let along =
            |axis: &crate::experiment::Axis, nodes: fn(&Field) -> &[f64], marks: fn(&Place) -> f64, unit: &str| {
                let ends = panels.iter().flat_map(|panel| {
                    let nodes = nodes(&panel.field);
                    let ends = if smooth { nodes.to_vec() } else { cell_edges(nodes, axis.scale) };
                    ends.into_iter().chain(panel.marks.iter().map(marks)).collect::<Vec<_>>()
                });
                let extent = Extent::of(ends.chain(axis.reach.into_iter().flatten()), axis.scale)?;
                Some(Axis::new(axis.scale, extent, Room::Tight, unit).in_unit(axis.unit.as_ref()))
            };
        let x = along(&spec.x, |field| &field.x, |at| at.x, &columns.x.unit).ok_or_else(nothing)?;
        let y = along(&spec.y, |field| &field.y, |at| at.y, &columns.y.unit).ok_or_else(nothing)?;
        let values = panels.iter().flat_map(|panel| panel.field.spots().map(|spot| spot.value));
        let values = values.chain(spec.value.reach.into_iter().flatten());
        let extent = Extent::of(values, spec.value.scale).ok_or_else(nothing)?;
        let steps = if smooth { Steps::Bands } else { Steps::Smooth };
        let axis = Axis::new(spec.value.scale, extent, Room::Tight, &columns.value.unit);
        let shades = Shades::new(axis.in_unit(spec.value.unit.as_ref()), spec.centre, steps);
        let value_name = source.label(&spec.value)?;
        let spread = largest_spread(source, columns.value)
            .map_or_else(String::new, |spread| format!(", s.d. at most {} %", compact(100.0 * spread, 2)));
        let best_word = if spec.best == Best::Lowest { "lowest" } else { "highest" };
        let (x_name, y_name) = (source.label(&spec.x)?, source.label(&spec.y)?);
        Ok(Self {
            spec,
            x_label: label::with_unit(&x_name, &x.unit),
            y_label: label::with_unit(&y_name, &y.unit),
            x_name,
            y_name,
            value_label: label::with_unit(&value_name, &shades.axis.unit) + &spread,
            best_label: format!("{best_word} {value_name}"),
            panels,
            x,
            y,
            shades,
            value_unit: columns.value.unit.clone(),
        })
    }

    /// True if fields are drawn with contours, not as cells.
    pub(super) fn is_smooth(&self) -> bool {
        self.panels.iter().any(|_| !self.shades.levels().is_empty())
    }

    /// True if some cell of some panel has no value.
    pub(super) fn has_gaps(&self) -> bool {
        self.panels.iter().any(|panel| panel.field.spots().count() < panel.field.x.len() * panel.field.y.len())
    }

    /// Height of a panel over its width.
    pub(super) fn aspect(&self) -> f64 {
        let span = |nodes: &dyn Fn(&Field) -> &[f64]| {
            let all = || self.panels.iter().flat_map(|panel| nodes(&panel.field).iter().copied());
            all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
        };
        let to_scale = !self.x.unit.is_empty()
            && self.x.unit == self.y.unit
            && [self.spec.x.scale, self.spec.y.scale] == [AxisScale::Linear; 2];
        let scaled = span(&|field| &field.y) / span(&|field| &field.x);
        match self.spec.aspect {
            Some(aspect) => aspect,
            None if to_scale && (0.3..3.0).contains(&scaled) => scaled,
            None => 1.0,
        }
    }

    /// What is said of a panel's best place, the longest form first; none if no place is to be named.
    pub(super) fn best_in_words(&self, panel: &MapPanel) -> Vec<String> {
        let Some(first) = panel.best.first() else { return Vec::new() };
        let value = quantity(first.value, &self.value_unit, 3);
        let place = |spot: &Spot| format!("({}, {})", compact(spot.x, 3), compact(spot.y, 3));
        let places = match panel.best.as_slice() {
            [one] => place(one),
            [one, other] => format!("{} and {}", place(one), place(other)),
            [one, rest @ ..] => format!("{} and {} more", place(one), rest.len()),
            [] => String::new(),
        };
        let named = |at: f64, label: &str| format!("{label} = {}", compact(at, 3));
        let mut forms = vec![format!("{value} at {places}"), format!("at {places}"), format!("at {}", place(first))];
        if let [one] = panel.best.as_slice() {
            let (x, y) = (named(one.x, &self.x_name), named(one.y, &self.y_name));
            forms.insert(0, format!("{value} at {x}, {y}"));
        }
        forms
    }
}

/// The three columns of a map.
struct Columns<'t> {
    x: &'t Column,
    y: &'t Column,
    value: &'t Column,
}

impl Columns<'_> {
    fn are_lists(&self) -> bool {
        matches!(self.value.data, Data::FloatList(_))
    }

    /// The places and values that these rows hold.
    fn spots(&self, figure: &str, rows: &[usize]) -> Result<Vec<Spot>, FigureError> {
        for column in [self.x, self.y, self.value] {
            match column.data {
                Data::Text(_) => {
                    return Err(FigureError::Text { figure: figure.to_owned(), column: column.name.clone() });
                }
                Data::FloatList(_) if self.are_lists() => {}
                Data::Float(_) | Data::Int(_) if !self.are_lists() => {}
                _ => {
                    let (x, y) = (column.name.clone(), self.value.name.clone());
                    return Err(FigureError::Mixed { figure: figure.to_owned(), x, y });
                }
            }
        }
        if let (Data::FloatList(x), Data::FloatList(y), Data::FloatList(value)) =
            (&self.x.data, &self.y.data, &self.value.data)
        {
            let filled: Vec<usize> =
                rows.iter().copied().filter(|row| value.get(*row).is_some_and(|v| !v.is_empty())).collect();
            if filled.len() > 1 {
                let column = self.value.name.clone();
                return Err(FigureError::ManyFields { figure: figure.to_owned(), column, rows: filled.len() });
            }
            let of_row = |row: usize| {
                let places = x.get(row).into_iter().flatten().zip(y.get(row).into_iter().flatten());
                places.zip(value.get(row).into_iter().flatten()).map(|((&x, &y), &value)| Spot { x, y, value })
            };
            return Ok(filled.into_iter().flat_map(of_row).collect());
        }
        let spot = |&row: &usize| {
            Some(Spot { x: self.x.data.number(row)?, y: self.y.data.number(row)?, value: self.value.data.number(row)? })
        };
        Ok(rows.iter().filter_map(spot).collect())
    }
}

/// The different places that two columns name in these rows.
fn marks(x: &Column, y: &Column, rows: &[usize]) -> Vec<Place> {
    let mut marks: Vec<Place> = Vec::new();
    for &row in rows {
        let (Some(x), Some(y)) = (x.data.number(row), y.data.number(row)) else { continue };
        let mark = Place { x, y };
        if x.is_finite() && y.is_finite() && !marks.contains(&mark) {
            marks.push(mark);
        }
    }
    marks
}

/// Where the best value is; values that differ by rounding (places that mirror each other) share it.
fn best(field: &Field, wanted: Best) -> Vec<Spot> {
    let sign = match wanted {
        Best::None => return Vec::new(),
        Best::Highest => 1.0,
        Best::Lowest => -1.0,
    };
    let Some(top) = field.spots().map(|spot| sign * spot.value).reduce(f64::max) else { return Vec::new() };
    field.spots().filter(|spot| top - sign * spot.value <= 1e-9 * top.abs()).collect()
}
