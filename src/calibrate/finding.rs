//! The numbers of a finding: a calibration that is run again may come to others, and its sentences are to say those.
//!
//! | in the text | on the page |
//! |---|---|
//! | `{best}`, `{in force}` | the least residual, and that of the inputs in force |
//! | `{fitted}`, `{fitted in force}` | how many of the fitted entries are reproduced with these: `1 of 8` |
//! | `{held out}`, `{held out in force}` | how many of those held out |
//! | `{INPUT: VALUE}` | the least residual with this value, as the table of inputs has them |
//!
//! What names none of these stays as it is written.

use super::Calibrated;
use super::page::{reproduced, share, value};
use crate::experiment::Calibration;

/// The finding with its numbers.
pub(super) fn filled(calibration: &Calibration, result: &Calibrated) -> String {
    let mut text = String::new();
    let mut rest = calibration.finding.as_str();
    while let Some((before, after)) = rest.split_once('{') {
        let Some((name, behind)) = after.split_once('}') else { break };
        text += before;
        text += &number(name, calibration, result).unwrap_or_else(|| format!("{{{name}}}"));
        rest = behind;
    }
    text + rest
}

fn number(name: &str, calibration: &Calibration, result: &Calibrated) -> Option<String> {
    Some(match name {
        "best" => share(result.best),
        "in force" => share(result.in_force),
        "fitted" => reproduced(&result.fitted, |one| &one.best),
        "fitted in force" => reproduced(&result.fitted, |one| &one.in_force),
        "held out" => reproduced(&result.held_out, |one| &one.best),
        "held out in force" => reproduced(&result.held_out, |one| &one.in_force),
        _ => {
            let (input, wanted) = name.split_once(": ")?;
            let which = calibration.inputs.iter().position(|known| known.name == input)?;
            let tried = &calibration.inputs[which].tried;
            let residuals = &result.profiles.get(which)?.residuals;
            // Groups of digits are parted by spaces of their own.
            let letters = |text: &str| text.split_whitespace().collect::<String>();
            let place = (0..residuals.len()).find(|&place| letters(&value(tried, place)) == letters(wanted))?;
            share(residuals[place])
        }
    })
}
