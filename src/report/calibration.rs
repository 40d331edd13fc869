//! The page of a calibration.

use crate::calibrate::{Calibrated, Compared, Profile};
use crate::reference::Found;
use crate::spec::Calibration;
use crate::text::number;

use super::assumption::value_in_words;
use super::markdown::{Align, MarkdownTable, counted};

/// Agreement that still tells something, as among the verdicts.
const NEAR: f64 = 0.1;
/// A value whose least residual exceeds the best by less than this share of it is as good as the best.
const AS_GOOD: f64 = 0.1;

/// The page.
#[must_use]
pub fn calibration(calibration: &Calibration, result: &Calibrated) -> String {
    let share = |residual: Option<f64>| residual.map_or_else(|| "none".into(), percent);
    let mut text = format!("# {}\n\n[All experiments](../README.md)\n\n{}\n\n", calibration.title, calibration.about);
    text += &format!(
        "{} of values, every one of them run; {} fitted, {} held out. Residual: root mean square of the fitted entries’ \
         relative errors. Best: **{}**; with the assumptions in force: {}.\n\n",
        counted(calibration.combinations(), "combination", "combinations"),
        counted(result.fitted.len(), "entry", "entries"),
        result.held_out.len(),
        share(result.best),
        share(result.in_force),
    );
    text += "## Inputs\n\nFor each value the least residual with all other inputs free; bold the best. An input is \
             determined if no other value comes as near.\n\n";
    let mut table = MarkdownTable::new(&[
        ("Input", Align::Left),
        ("Value: least residual", Align::Left),
        ("Determined", Align::Left),
    ]);
    for (profile, place) in result.profiles.iter().zip(&result.places) {
        table.row([format!("`{}`", profile.name), points(profile, *place), determined(profile, *place).into()]);
    }
    text += &table.finish();
    text += &entries("Fitted entries", &result.fitted);
    text += &entries("Held-out entries", &result.held_out);
    let near = |list: &[Compared], of: fn(&Compared) -> &Found| list.iter().filter(|one| is_near(of(one))).count();
    text += &format!(
        "Within a tenth, or holding: {} of {} fitted and {} of {} held-out entries with the best inputs; {} and {} with \
         those in force.\n",
        near(&result.fitted, |one| &one.best),
        result.fitted.len(),
        near(&result.held_out, |one| &one.best),
        result.held_out.len(),
        near(&result.fitted, |one| &one.in_force),
        near(&result.held_out, |one| &one.in_force),
    );
    text
}

fn percent(residual: f64) -> String {
    format!("{} %", number::significant(100.0 * residual, 2))
}

fn points(profile: &Profile, best: usize) -> String {
    let told = profile.points.iter().enumerate().map(|(place, (value, residual))| {
        let residual = residual.map_or_else(|| "no number".into(), percent);
        let told = format!("{}: {residual}", value_in_words(profile.moves, value));
        if place == best { format!("**{told}**") } else { told }
    });
    told.collect::<Vec<_>>().join("; ")
}

fn determined(profile: &Profile, best: usize) -> &'static str {
    let Some((_, Some(least))) = profile.points.get(best) else { return "no" };
    let rivals = profile.points.iter().enumerate().filter(|(place, (_, residual))| {
        *place != best && residual.is_some_and(|residual| residual <= (1.0 + AS_GOOD) * least)
    });
    match (rivals.count(), profile.points.len()) {
        (_, 1) => "held",
        (0, _) => "yes",
        (rivals, all) if rivals + 1 == all => "no",
        _ => "in part",
    }
}

fn is_near(found: &Found) -> bool {
    match found {
        Found::Number { simulated, published } => (simulated - published).abs() <= NEAR * published.abs(),
        Found::Claim { holds } => *holds,
        Found::Nothing(_) => false,
    }
}

fn entries(title: &str, list: &[Compared]) -> String {
    let mut table = MarkdownTable::new(&[
        ("Entry", Align::Left),
        ("Study", Align::Right),
        ("In force", Align::Right),
        ("Best inputs", Align::Right),
        ("Within a tenth, or holds", Align::Left),
    ]);
    for one in list {
        let study = match &one.best {
            Found::Number { published, .. } => number::compact(*published, 5),
            _ => String::new(),
        };
        let near = if is_near(&one.best) { "yes" } else { "no" };
        table.row([format!("`{}`", one.id), study, told(&one.in_force), told(&one.best), near.into()]);
    }
    let table = table.finish();
    if table.is_empty() { table } else { format!("## {title}\n\n{table}") }
}

fn told(found: &Found) -> String {
    match found {
        Found::Number { simulated, published } => {
            let off = 100.0 * (simulated - published) / published.abs();
            format!("{} ({} %)", number::significant(*simulated, 4), number::signed(off, 2))
        }
        Found::Claim { holds: true } => "holds".into(),
        Found::Claim { holds: false } => "does not hold".into(),
        Found::Nothing(reason) => reason.clone(),
    }
}
