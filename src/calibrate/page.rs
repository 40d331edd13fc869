//! The page of a calibration.

use std::collections::BTreeSet;

use super::finding::{filled, reproduced, share};
use super::left_out::AS_GOOD;
use super::{Calibrated, Compared, LeftOut, Profile, Read};
use crate::experiment::{Calibration, CalibrationInput, CalibrationSearch, Residual};
use crate::reference::Found;
use crate::text::number;

use crate::report::markdown::{Align, MarkdownTable};
use crate::text::words::counted;

/// The page.
#[must_use]
pub fn calibration(calibration: &Calibration, result: &Calibrated) -> String {
    let mut text = format!("# {}\n\n", calibration.title);
    if !calibration.finding.is_empty() {
        text += &format!("**What it shows** (our interpretation): {}\n\n", filled(&calibration.finding, result));
    }
    text += &format!("{}\n\n[All experiments](../README.md)\n\n", calibration.about);
    text += &format!(
        "{} fitted, {} held out. {}\n\n{}\n\n",
        counted(result.fitted.len(), "entry", "entries"),
        result.held_out.len(),
        searched(calibration, result),
        residuals(calibration, result)
    );
    if result.best.is_none() {
        text += "**No set gives every fitted entry a number**; “best inputs” stands for those in force.\n\n";
    }
    text += "## Inputs\n\nFor each value the least residual that was found with it, all other inputs free; bold the best, and of \
             equal ones the one in force. \
             An input is determined if no other value comes within a tenth of the best residual.";
    if calibration.leave_one_out {
        text += " Left out: with this value the root mean square of the errors that entries have where the others alone choose \
                 the rest, which tells readings apart by numbers that had no say.";
    }
    text += "\n\n";
    let mut columns = vec![("Input", Align::Left), ("Value: least residual", Align::Left), ("Determined", Align::Left)];
    columns.extend(calibration.leave_one_out.then_some(("Left out", Align::Left)));
    let mut table = MarkdownTable::new(&columns);
    for ((input, profile), place) in calibration.inputs.iter().zip(&result.profiles).zip(&result.places) {
        let cells = [
            format!("`{}`", input.name),
            points(input, &profile.residuals, *place),
            determined(profile, *place, calibration.search).into(),
        ];
        let least = || least(&profile.left_out, *place).unwrap_or(usize::MAX);
        let left_out = calibration.leave_one_out.then(|| points(input, &profile.left_out, least()));
        table.row(cells.into_iter().chain(left_out));
    }
    text += &table.finish();
    text += &left_out(calibration, result);
    text += "## Entries\n\nRun as results, with an ensemble where the motion is chaotic, and judged by the entry’s own \
             tolerance; nothing is allowed for inputs that the study does not state, as they are what is chosen here. Only the rows that \
             entries read are run, so that a curve with refined points may have others here than on the page of its experiment. \
             Numbers are in SI units.\n\n";
    text += &entries("Fitted", &result.fitted);
    text += &entries("Held out", &result.held_out);
    text += &format!(
        "Reproduced with the best inputs: {} fitted; {} held out. With those in force: {} fitted; {} held out.\n",
        reproduced(&result.fitted, |one| &one.best),
        reproduced(&result.held_out, |one| &one.best),
        reproduced(&result.fitted, |one| &one.in_force),
        reproduced(&result.held_out, |one| &one.in_force),
    );
    text
}

/// What the fit of the others says of each entry.
fn left_out(calibration: &Calibration, result: &Calibrated) -> String {
    if !calibration.leave_one_out {
        return String::new();
    }
    let mut table = MarkdownTable::new(&[
        ("Entry", Align::Left),
        ("By the others", Align::Right),
        ("Their residual", Align::Right),
        ("Sets as good", Align::Right),
        ("Other values", Align::Left),
        ("By chance", Align::Right),
    ]);
    for one in &result.left_out {
        let is_claim =
            result.fitted.iter().any(|fit| fit.id == one.id && matches!(fit.best.found, Found::Claim { .. }));
        table.row([
            format!("`{}`", one.id),
            predicted(one, is_claim),
            share(Some(one.residual)),
            one.as_good.len().to_string(),
            moved(calibration, result, one),
            format!("{:.0} %", 100.0 * one.by_chance),
        ]);
    }
    format!(
        "## Left out one at a time\n\nEach fitted entry is left out in turn, and the others alone choose the inputs: every set whose \
         residual without it comes within a tenth of the least one. Given are the entry’s errors under these sets, and the values \
         that the best set of all entries does not have. By chance: the share of all sets that bring it within a tenth of its \
         number, or as its tolerance says. An entry *comes out* if both ends of its errors would still get the verdict `fitted`, \
         with its uncertainties, and if not every set brings it there; the index counts them.\n\n{}",
        table.finish(),
    )
}

/// The values that sets which fit the others have, and the best set of all entries has not.
fn moved(calibration: &Calibration, result: &Calibrated, one: &LeftOut) -> String {
    let values = |(which, input): (usize, &CalibrationInput)| {
        let places: BTreeSet<usize> = one.as_good.iter().map(|places| places[which]).collect();
        let others = places.into_iter().filter(|place| result.places.get(which) != Some(place));
        let others: Vec<String> = others.map(|place| input.tried.in_words(place)).collect();
        (!others.is_empty()).then(|| format!("`{}`: {}", input.name, others.join(" or ")))
    };
    calibration.inputs.iter().enumerate().filter_map(values).collect::<Vec<_>>().join("; ")
}

/// The errors that the sets which fit the others leave an entry.
fn predicted(one: &LeftOut, is_claim: bool) -> String {
    let off = |error: f64| number::signed(100.0 * error, 2);
    match one.errors {
        None => "no number".into(),
        Some([_, largest]) if is_claim && largest == 0.0 => "holds".into(),
        Some([least, _]) if is_claim && least > 0.0 => "does not hold".into(),
        Some(_) if is_claim => "open".into(),
        Some([least, largest]) if off(least) == off(largest) => format!("{} %", off(least)),
        Some([least, largest]) => format!("{} to {} %", off(least), off(largest)),
    }
}

/// The index of the least of them; of equal ones the `preferred`, if it is one of them.
fn least(residuals: &[Option<f64>], preferred: usize) -> Option<usize> {
    let known = residuals.iter().enumerate().filter_map(|(value, residual)| Some((value, (*residual)?)));
    known.min_by(|a, b| a.1.total_cmp(&b.1).then((a.0 != preferred).cmp(&(b.0 != preferred)))).map(|(value, _)| value)
}

/// How the sets were chosen, and how the search ended.
fn searched(calibration: &Calibration, result: &Calibrated) -> String {
    let runs = match calibration.ensemble {
        0 => "each as a single run".to_owned(),
        members => format!("chaotic points as the mean of {members} runs"),
    };
    let sets = format!(
        "{} of {} possible ones",
        counted(result.tried, "set of inputs", "sets of inputs"),
        number::count(calibration.combinations() as u64)
    );
    let tried = match calibration.search {
        CalibrationSearch::Grid => {
            let sets = counted(result.tried, "combination of values was", "combinations of values were");
            return format!("All {sets} tried, {runs}.");
        }
        CalibrationSearch::Coordinate { .. } => {
            let ends: Vec<String> = result.ends.iter().map(|residual| share(*residual)).collect();
            format!(
                "Coordinate search, {runs}: {sets}, from {}, which ended at {}{}.",
                counted(ends.len(), "start", "starts"),
                ends.join(", "),
                if result.cut_short { ", the last one by the budget" } else { "" }
            )
        }
        CalibrationSearch::Global { .. } => {
            let held: Vec<String> =
                result.screened.iter().map(|&input| format!("`{}`", calibration.inputs[input].name)).collect();
            format!(
                "Global search, {runs}: {sets}, by CMA-ES over {} and then along one input after the other{}.",
                if held.is_empty() {
                    "all inputs".into()
                } else {
                    format!("all inputs but {}, which moved alone hardly change the residual,", held.join(", "))
                },
                if result.cut_short { ", up to the budget" } else { "" }
            )
        }
    };
    tried + " What lies between the sets that were tried is not known: a least residual is one that was found."
}

fn residuals(calibration: &Calibration, result: &Calibrated) -> String {
    let [in_force, best] = result.as_results.map(share);
    let errors = match calibration.residual {
        Residual::Relative => "relative errors",
        Residual::Logarithmic => "logarithmic errors, ln(here/study)",
    };
    let weighed = "an error e of a number with a chaotic spread σ adds W² e²/(W² + σ²) + W² ln(1 + σ²/W²) in the place of e², W a tenth of it";
    // Without an ensemble in the search there is a spread in the results alone.
    let [in_search, in_results] = match calibration.ensemble {
        0 => [String::new(), format!(", where {weighed}")],
        _ => [format!(" and {weighed}"), String::new()],
    };
    format!(
        "Residual: root mean square of the fitted entries’ {errors}, where a claim that fails counts as 100 %{in_search}. Best: \
         **{}**; with the inputs in force: {}. As results, with ensembles{in_results}: {best} and {in_force}.",
        share(result.best),
        share(result.in_force),
    )
}

fn points(input: &CalibrationInput, residuals: &[Option<f64>], best: usize) -> String {
    let description = residuals.iter().enumerate().map(|(place, residual)| {
        let description =
            format!("{}: {}", input.tried.in_words(place), residual.map_or("none".into(), |one| share(Some(one))));
        if place == best { format!("**{description}**") } else { description }
    });
    description.collect::<Vec<_>>().join("; ")
}

fn determined(profile: &Profile, best: usize, search: CalibrationSearch) -> &'static str {
    if profile.is_unread {
        return "no: no residual depends on it";
    }
    let Some(Some(least)) = profile.residuals.get(best) else { return "no" };
    let rivals = profile.residuals.iter().enumerate().filter(|(place, residual)| {
        *place != best && residual.is_some_and(|residual| residual <= (1.0 + AS_GOOD) * least)
    });
    match (rivals.count(), profile.residuals.len()) {
        (_, 1) => "held",
        (0, _) if search != CalibrationSearch::Grid => "as far as tried",
        (0, _) => "yes",
        (rivals, all) if rivals + 1 == all => "no",
        _ => "in part",
    }
}

fn entries(title: &str, list: &[Compared]) -> String {
    let mut table = MarkdownTable::new(&[
        ("Entry", Align::Left),
        ("Study", Align::Right),
        ("In force", Align::Right),
        ("Verdict", Align::Left),
        ("Best inputs", Align::Right),
        ("Verdict", Align::Left),
    ]);
    for one in list {
        let study = match &one.best.found {
            Found::Number { published, .. } => number::compact(*published, 5),
            _ => String::new(),
        };
        let verdict = |read: &Read| read.verdict.word().to_owned();
        table.row([
            format!("`{}`", one.id),
            study,
            describe(&one.in_force.found),
            verdict(&one.in_force),
            describe(&one.best.found),
            verdict(&one.best),
        ]);
    }
    let table = table.finish();
    if table.is_empty() { table } else { format!("### {title}\n\n{table}") }
}

fn describe(found: &Found) -> String {
    match found {
        Found::Number { simulated, published, .. } => {
            let off = 100.0 * (simulated - published) / published.abs();
            format!("{} ({} %)", number::significant(*simulated, 4), number::signed(off, 2))
        }
        Found::Claim { holds: true } => "holds".into(),
        Found::Claim { holds: false } => "does not hold".into(),
        Found::Nothing(reason) => reason.clone(),
    }
}
