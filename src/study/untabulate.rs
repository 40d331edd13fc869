//! A table back to rows: what `tabulate` wrote, read to the same bits.

use super::doubt::RESIDUAL_BOUND;
use super::maximise::Place;
use super::tabulate::Row;
use crate::dynamics::Proof;
use crate::experiment::Experiment;
use crate::measure::{Evaluated, Measured, TraceColumn};
use crate::table::{Column, Data, Table, UNKNOWN};
use crate::text::name;
use crate::text::words;

/// The columns of a table that the numbers of an experiment's rows stand in.
pub(super) struct Cells<'a> {
    /// Value, numerical error and spread of each measure that is a number.
    measured: Vec<Option<[&'a [f64]; 3]>>,
    /// The name of the motion, where it is measured.
    motion: Option<&'a [String]>,
    /// The place of the maximum, and how far off it may be.
    place: Option<[&'a [f64]; 2]>,
    momentum_residual: &'a [f64],
    energy_residual: &'a [f64],
    /// There where some row does not balance.
    residual_bound: Option<&'a [f64]>,
    smallest_margin: &'a [f64],
    events: &'a [i64],
    ties: &'a [i64],
    chaotic: &'a [i64],
    members: &'a [i64],
    failure: &'a [String],
    /// There where something is unknown of some row.
    unknown: Option<&'a [String]>,
    lists: Vec<(&'a Column, &'a [Vec<f64>])>,
}

impl<'a> Cells<'a> {
    /// `None` if the table lacks one of them.
    pub(super) fn of(experiment: &Experiment, table: &'a Table) -> Option<Self> {
        let floats = |name: &str| match &table.column(name)?.data {
            Data::Float(cells) => Some(cells.as_slice()),
            _ => None,
        };
        let counts = |name: &str| match &table.column(name)?.data {
            Data::Int(cells) => Some(cells.as_slice()),
            _ => None,
        };
        let measured = experiment.measures.iter().map(|measure| {
            let name = words::of_key(measure);
            if measure.is_name() {
                return Some(None);
            }
            let [value, numerical, spread] = name::with_errors(&name);
            Some(Some([floats(&value)?, floats(&numerical)?, floats(&spread)?]))
        });
        let named = experiment.measures.iter().find(|measure| measure.is_name());
        let motion = named.map(|measure| table.texts(&words::of_key(measure)));
        let place = experiment.maximise.as_ref().map(|maximise| {
            let place = maximise.column();
            Some([floats(&place)?, floats(&name::numerical(&place))?])
        });
        let lists = table.columns.iter().filter_map(|column| match &column.data {
            Data::FloatList(cells) => Some((column, cells.as_slice())),
            _ => None,
        });
        Some(Self {
            measured: measured.collect::<Option<_>>()?,
            // Wanted and absent is not the same as not wanted.
            place: match place {
                Some(place) => Some(place?),
                None => None,
            },
            motion: match motion {
                Some(motion) => Some(motion?),
                None => None,
            },
            momentum_residual: floats("momentum_residual")?,
            energy_residual: floats("energy_residual")?,
            residual_bound: floats(RESIDUAL_BOUND),
            smallest_margin: floats("smallest_margin")?,
            events: counts("events")?,
            ties: counts("ties")?,
            chaotic: counts("chaotic")?,
            members: counts(name::MEMBERS)?,
            failure: table.texts(name::FAILURE)?,
            unknown: table.texts(UNKNOWN),
            lists: lists.collect(),
        })
    }

    /// The row, unless it has no numbers.
    pub(super) fn row(&self, row: usize) -> Option<Row> {
        if !self.failure.get(row)?.is_empty() {
            return None;
        }
        let measured = self.measured.iter().map(|columns| match columns {
            Some([value, numerical, spread]) => {
                Measured { value: value[row], numerical: numerical[row], spread: spread[row] }
            }
            None => Measured { value: f64::NAN, numerical: f64::NAN, spread: 0.0 },
        });
        let proof = Proof {
            momentum_residual: self.momentum_residual[row],
            energy_residual: self.energy_residual[row],
            residual_bound: self.residual_bound.map_or(f64::NAN, |cells| cells[row]).min(f64::INFINITY),
            events: u64::try_from(self.events[row]).ok()?,
            smallest_margin: self.smallest_margin[row],
            ties: u64::try_from(self.ties[row]).ok()?,
        };
        let kept = self.lists.iter().filter(|(_, cells)| !cells[row].is_empty());
        let evaluated = Evaluated {
            measured: measured.collect(),
            proof,
            chaotic: self.chaotic[row] != 0,
            unknown: self.unknown.map(|cells| cells[row].clone()).filter(|cell| !cell.is_empty()),
            members: u32::try_from(self.members[row]).ok()?,
            // A row of a fixed step has no name.
            motion: match self.motion.map(|cells| &cells[row]).filter(|cell| !cell.is_empty()) {
                Some(cell) => Some(cell.parse().ok()?),
                None => None,
            },
            trace: kept
                .map(|(column, cells)| TraceColumn::new(column.name.clone(), column.unit.clone(), cells[row].clone()))
                .collect(),
            end: None,
        };
        Some(Row { evaluated, place: self.place.map(|[at, within]| Place { at: at[row], within: within[row] }) })
    }
}
