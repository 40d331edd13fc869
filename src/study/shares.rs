//! What random starts end in, read off the table: for each case its motions with their shares, and for each damper the best motion
//! that attracts.

use serde::{Deserialize, Serialize};

use super::row_in_words::{described, row_in_words};
use crate::dynamics::MotionKind;
use crate::experiment::{BasinColumn, Experiment, Parameter, Rank, RowSource};
use crate::measure::Measure;
use crate::table::Table;
use crate::text::name;
use crate::text::words::of_key;

/// A motion that some of the starts end in.
#[derive(Debug, Clone, PartialEq)]
pub struct Attracting {
    /// Its row in the table given.
    pub row: usize,
    /// Its name.
    pub motion: String,
    /// No other motion of the case has a smaller RMS velocity.
    pub rank: Rank,
    /// Share of the starts.
    pub share: f64,
    /// The share's 95 % interval.
    pub interval: [f64; 2],
    /// Velocity ratio; NaN where it is not measured.
    pub velocity_ratio: f64,
}

/// A case and what its starts end in.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseShares {
    /// By what is swept: `f′ = 7.33`.
    pub case: String,
    /// The motion of the most starts first; what has not settled is among them.
    pub motions: Vec<Attracting>,
}

/// The cases of an experiment with random starts, by how many motions its starts settle in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct StartShares {
    /// Starts of each case.
    pub each: u32,
    /// Cases in which one motion attracts.
    pub one: usize,
    /// Those in which several do.
    pub several: usize,
    /// Those in which no start has settled.
    pub unsettled: usize,
}

/// The best motion that attracts, for one damper.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BestMotion {
    /// Which damper: `h′ = 50`.
    pub damper: String,
    /// Where else in the sweep: `f′ = 2.5`; empty where nothing else is swept.
    pub at: String,
    /// Its name.
    pub motion: String,
    /// Its velocity ratio.
    pub velocity_ratio: f64,
    /// Share of the starts that it attracts.
    pub share: f64,
    /// The share's 95 % interval.
    pub interval: [f64; 2],
}

impl Attracting {
    /// The starts have settled.
    #[must_use]
    pub fn has_settled(&self) -> bool {
        self.motion.parse() != Ok(MotionKind::NotSettled)
    }
}

impl CaseShares {
    /// Of all cases of a table, at the baseline; none where its rows are no motions that random starts end in, or a case has failed.
    #[must_use]
    pub fn of(experiment: &Experiment, table: &Table) -> Vec<Self> {
        Self::read(experiment, table).unwrap_or_default()
    }

    fn read(experiment: &Experiment, table: &Table) -> Option<Vec<Self>> {
        let RowSource::Basins(_) = experiment.row_source() else { return None };
        let names = table.texts(BasinColumn::Basin.name())?;
        let ranks = table.texts(BasinColumn::Rank.name())?;
        let number = |column: BasinColumn| table.floats(column.name());
        let (shares, low, high) =
            (number(BasinColumn::Share)?, number(BasinColumn::ShareLow)?, number(BasinColumn::ShareHigh)?);
        let ratios = table.floats(&of_key(&Measure::VelocityRatio)).unwrap_or_else(|| vec![f64::NAN; table.rows()]);
        let mut cases: Vec<Self> = Vec::new();
        for row in table.rows_where(name::VARIANT, crate::table::BASELINE) {
            if names[row].is_empty() {
                return None;
            }
            let case = row_in_words(experiment, table, row);
            let motion = Attracting {
                row,
                motion: names[row].clone(),
                rank: Rank::of_word(&ranks[row])?,
                share: shares[row],
                interval: [low[row], high[row]],
                velocity_ratio: ratios[row],
            };
            match cases.last_mut().filter(|last| last.case == case) {
                Some(last) => last.motions.push(motion),
                None => cases.push(Self { case, motions: vec![motion] }),
            }
        }
        Some(cases)
    }

    /// The motions that its starts have settled in.
    pub fn settled(&self) -> impl Iterator<Item = &Attracting> {
        self.motions.iter().filter(|motion| motion.has_settled())
    }
}

impl StartShares {
    /// `None` where the rows are no motions that random starts end in, or a case has failed.
    pub(super) fn of(experiment: &Experiment, table: &Table) -> Option<Self> {
        let RowSource::Basins(starts) = experiment.row_source() else { return None };
        let cases = CaseShares::read(experiment, table)?;
        let with = |wanted: fn(usize) -> bool| cases.iter().filter(|case| wanted(case.settled().count())).count();
        Some(Self {
            each: starts.count,
            one: with(|settled| settled == 1),
            several: with(|settled| settled > 1),
            unsettled: with(|settled| settled == 0),
        })
    }

    /// All cases.
    #[must_use]
    pub fn cases(&self) -> usize {
        self.one + self.several + self.unsettled
    }
}

impl BestMotion {
    /// Of each damper that is swept, in the order of the table: the motion of the largest velocity ratio among all that attract.
    pub(super) fn of(experiment: &Experiment, table: &Table) -> Vec<Self> {
        if !experiment.swept.iter().any(|parameter| parameter.is_of_dampers()) {
            return Vec::new();
        }
        let mut best: Vec<Self> = Vec::new();
        for motion in CaseShares::of(experiment, table).iter().flat_map(CaseShares::settled) {
            let part = |of_dampers: bool| {
                described(experiment, table, motion.row, move |parameter: Parameter| {
                    parameter.is_of_dampers() == of_dampers
                })
            };
            let new = Self {
                damper: part(true),
                at: part(false),
                motion: motion.motion.clone(),
                velocity_ratio: motion.velocity_ratio,
                share: motion.share,
                interval: motion.interval,
            };
            match best.iter_mut().find(|one| one.damper == new.damper) {
                Some(known) if new.velocity_ratio > known.velocity_ratio => *known = new,
                Some(_) => {}
                None if new.velocity_ratio.is_nan() => {}
                None => best.push(new),
            }
        }
        best
    }
}
