//! From the tables of all combinations to the best of them.

use std::collections::{BTreeMap, BTreeSet};

use super::grid::{label, places};
use super::simulate::CalibrationError;
use crate::reference::{Entry, Found, ReferenceFile, TableState, Tables};
use crate::scene::AssumptionValue;
use crate::spec::Calibration;
use crate::table::{BASELINE, Table};

/// What a calibration found.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibrated {
    /// Root mean square of the fitted entries' relative errors under the assumptions in force; none if one has no number.
    pub in_force: Option<f64>,
    /// The same of the best combination; none if no combination gives all of them a number.
    pub best: Option<f64>,
    /// Of each input the index of its best value.
    pub places: Vec<usize>,
    /// How well each input is determined.
    pub profiles: Vec<Profile>,
    /// The entries that were fitted.
    pub fitted: Vec<Compared>,
    /// The entries that were held out.
    pub held_out: Vec<Compared>,
}

/// The least residual for each value of an input, all others free.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The input.
    pub name: String,
    /// The first of the assumptions that it moves, which tells its unit.
    pub moves: crate::scene::Assumption,
    /// Value and residual; none where no combination with it gives every fitted entry a number.
    pub points: Vec<(AssumptionValue, Option<f64>)>,
}

/// An entry under the assumptions in force and under the best combination.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// `ch6-beam-b1-light/uniform`.
    pub id: String,
    /// In force.
    pub in_force: Found,
    /// Under the best combination.
    pub best: Found,
}

/// Reads the entries under every combination, and takes the best.
///
/// # Errors
/// [`CalibrationError::NoEntry`] for an entry that the reference lacks.
pub fn calibrated(
    calibration: &Calibration,
    references: &BTreeMap<String, ReferenceFile>,
    tables: &BTreeMap<String, Table>,
) -> Result<Calibrated, CalibrationError> {
    let states: Tables<'_> = tables.iter().map(|(id, table)| (id.clone(), TableState::Present(table))).collect();
    let fit = chosen(&calibration.fit, references, &BTreeSet::new())?;
    let taken: BTreeSet<&str> = fit.iter().map(|(_, entry)| entry.id.as_str()).collect();
    let held = chosen(&calibration.hold_out, references, &taken)?;
    let residual = |variant: &str| residual(fit.iter().map(|(home, entry)| entry.found(home, &states, variant)));
    let residuals: Vec<Option<f64>> = (0..calibration.combinations()).map(|index| residual(&label(index))).collect();
    let least = |indices: &mut dyn Iterator<Item = usize>| {
        let known = indices.filter_map(|index| Some((index, residuals[index]?)));
        known.min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let best = least(&mut (0..residuals.len()));
    let profile = |(which, input): (usize, &crate::spec::CalibrationInput)| {
        let point = |(place, value): (usize, &AssumptionValue)| {
            let mut with = (0..residuals.len()).filter(|index| places(calibration, *index)[which] == place);
            (value.clone(), least(&mut with).map(|(_, residual)| residual))
        };
        Some(Profile {
            name: input.name.clone(),
            moves: *input.moves.first()?,
            points: input.values.iter().enumerate().map(point).collect(),
        })
    };
    let best_label = best.map_or_else(|| BASELINE.to_owned(), |(index, _)| label(index));
    let compared = |(home, entry): &(&str, &Entry)| Compared {
        id: entry.id.clone(),
        in_force: entry.found(home, &states, BASELINE),
        best: entry.found(home, &states, &best_label),
    };
    Ok(Calibrated {
        in_force: residual(BASELINE),
        best: best.map(|(_, residual)| residual),
        places: best.map(|(index, _)| places(calibration, index)).unwrap_or_default(),
        profiles: calibration.inputs.iter().enumerate().filter_map(profile).collect(),
        fitted: fit.iter().map(compared).collect(),
        held_out: held.iter().map(compared).collect(),
    })
}

/// Entries by their ids; `EXPERIMENT/*` stands for all of an experiment that are not `taken`.
fn chosen<'a>(
    ids: &[String],
    references: &'a BTreeMap<String, ReferenceFile>,
    taken: &BTreeSet<&str>,
) -> Result<Vec<(&'a str, &'a Entry)>, CalibrationError> {
    let mut chosen = Vec::new();
    for id in ids {
        let none = || CalibrationError::NoEntry(id.clone());
        let (experiment, name) = id.split_once('/').ok_or_else(none)?;
        let file = references.get(experiment).ok_or_else(none)?;
        let wanted = |entry: &&Entry| if name == "*" { !taken.contains(entry.id.as_str()) } else { entry.id == *id };
        let before = chosen.len();
        chosen.extend(file.entries.iter().filter(wanted).map(|entry| (file.experiment.as_str(), entry)));
        if chosen.len() == before {
            return Err(none());
        }
    }
    Ok(chosen)
}

/// Root mean square of relative errors; a claim that fails counts as an error of the whole, none may lack its number.
fn residual(found: impl Iterator<Item = Found>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for one in found {
        let error = match one {
            Found::Number { simulated, published } => (simulated - published) / published,
            Found::Claim { holds } => f64::from(u8::from(!holds)),
            Found::Nothing(_) => return None,
        };
        sum += error * error;
        count += 1.0;
    }
    (count > 0.0).then(|| (sum / count).sqrt()).filter(|residual| residual.is_finite())
}
