//! What moves how in an experiment: the kinds of motion that its rows end in, and how far the averages of its runs are from those
//! of the motion that each goes on to.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::row_in_words::row_in_words;
use super::shares::{BestMotion, StartShares};
use crate::dynamics::{MotionKind, Until};
use crate::experiment::{Experiment, RowSource};
use crate::measure::{Measure, Settings};
use crate::table::{BASELINE, Table};
use crate::text::name;
use crate::text::words::of_key;

/// What a thousandth changes is read off a figure by nobody, and printed by the study with three digits.
const OFF: f64 = 1e-3;

/// The motions of an experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Motions {
    /// Rows by kind of motion, in its word.
    pub kinds: BTreeMap<String, usize>,
    /// Cycles left out of the averages.
    pub skip: u32,
    /// Cycles after which each row that comes again does so to within a millionth, in ascending order; none where runs end when they
    /// have settled.
    pub settled_after: Vec<f64>,
    /// How the averages compare with the settled motion, where that was measured.
    pub settling: Option<Settling>,
    /// Of random starts: in how many cases they end in one motion, and in how many in several.
    pub starts: Option<StartShares>,
    /// Of random starts of several dampers: the best motion that each has.
    pub best: Vec<BestMotion>,
}

/// Averages of runs over the cycles given against those of the motion that each run goes on to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settling {
    /// Cycles averaged.
    pub average: u32,
    /// Rows that settle.
    pub rows: usize,
    /// Those whose velocity ratio is off by more than [`Settling::limit`].
    pub off: usize,
    /// The middle one of all relative deviations.
    pub median: f64,
    /// The rows that are off most, the worst first.
    pub worst: Vec<Deviation>,
}

/// A row that is not what it settles to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// Which row, by what is swept: `f′ = 2.5, h′ = 50`.
    pub row: String,
    /// Velocity ratio of the cycles given.
    pub velocity_ratio: f64,
    /// Of the settled motion.
    pub settled: f64,
}

impl Deviation {
    /// How far the run is off, relative to the settled motion.
    #[must_use]
    pub fn relative(&self) -> f64 {
        self.velocity_ratio / self.settled - 1.0
    }
}

impl Settling {
    /// The relative deviation that counts as one.
    #[must_use]
    pub fn limit() -> f64 {
        OFF
    }

    fn of(experiment: &Experiment, table: &Table, rows: &[usize]) -> Option<Self> {
        let column = |measure: Measure| table.floats(&of_key(&measure));
        let settled = column(Measure::SettledVelocityRatio)?;
        let here = column(Measure::VelocityRatio)?;
        let off_by = |row: usize| (here[row] / settled[row] - 1.0).abs();
        let mut all: Vec<usize> = rows.iter().copied().filter(|&row| !settled[row].is_nan()).collect();
        all.sort_by(|&a, &b| off_by(b).total_cmp(&off_by(a)));
        let median = off_by(*all.get(all.len() / 2)?);
        let off = all.iter().filter(|&&row| off_by(row) > OFF).count();
        let deviation = |&row: &usize| Deviation {
            row: row_in_words(experiment, table, row),
            velocity_ratio: here[row],
            settled: settled[row],
        };
        let worst = all.iter().take(off.min(10)).map(deviation).collect();
        Some(Self { average: experiment.settings.average, rows: all.len(), off, median, worst })
    }
}

impl Motions {
    /// Of the rows without a moved assumption; `None` where the motion is not measured.
    #[must_use]
    pub fn of(experiment: &Experiment, table: &Table) -> Option<Self> {
        if let RowSource::Basins(_) = experiment.row_source() {
            // A motion that few starts end in is a row like one that all do.
            let Settings { skip, .. } = experiment.settings;
            let (kinds, best) = (BTreeMap::new(), BestMotion::of(experiment, table));
            let starts = StartShares::of(experiment, table);
            return Some(Self { kinds, skip, settled_after: Vec::new(), settling: None, starts, best });
        }
        // Orbits of a branch are no runs, and most of them nobody would see.
        if experiment.is_whole() {
            return None;
        }
        let names = table.texts(&of_key(&Measure::Motion))?;
        let rows = table.rows_where(name::VARIANT, BASELINE);
        let mut kinds = BTreeMap::new();
        for kind in rows.iter().filter_map(|&row| names[row].parse::<MotionKind>().ok()) {
            *kinds.entry(kind.word().to_owned()).or_default() += 1;
        }
        let runs_on = experiment.settings.until == Until::Cycles;
        let cells = table.floats(&of_key(&Measure::SettledAfter)).filter(|_| runs_on);
        let of_rows = |cells: Vec<f64>| rows.iter().map(|&row| cells[row]).filter(|cycles| !cycles.is_nan()).collect();
        let mut settled_after: Vec<f64> = cells.map_or_else(Vec::new, of_rows);
        settled_after.sort_by(f64::total_cmp);
        let settling = runs_on.then(|| Settling::of(experiment, table, &rows)).flatten();
        Some(Self { kinds, skip: experiment.settings.skip, settled_after, settling, starts: None, best: Vec::new() })
    }

    /// Rows that come again, but only after the cycles left out.
    #[must_use]
    pub fn late(&self) -> usize {
        self.settled_after.iter().filter(|cycles| **cycles > f64::from(self.skip)).count()
    }

    /// All rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.kinds.values().sum()
    }
}
