//! What stands at axes and in legends: units and the field's symbols, words instead of column names.

use crate::experiment::{Experiment, SearchPoint};
use crate::measure::column_words;
use crate::table::{Column, Data};
use crate::text::{number, words};

/// A column as an axis or a legend names it, without unit: `velocity ratio ψ`, `maximum velocity ratio ψ`.
pub(super) fn of_column(experiment: Option<&Experiment>, column: &Column) -> String {
    let name = column_words(&column.name);
    let named = if column.symbol.is_empty() { name } else { format!("{name} {}", column.symbol) };
    let maximised = experiment
        .and_then(|experiment| experiment.maximise.as_ref())
        .filter(|maximise| maximise.wanted == SearchPoint::Maximum)
        .is_some_and(|maximise| words::of_key(&maximise.measure) == column.name);
    if maximised { format!("maximum {named}") } else { named }
}

/// The cell of a column that splits rows into lines, in words: `h′ = 50`, `without stop`. `None` where the sweep leaves
/// the column out of this row.
pub(super) fn of_cell(column: &Column, row: usize) -> Option<String> {
    let value = match &column.data {
        Data::Text(cells) => {
            let level = cells.get(row)?;
            return (!level.is_empty()).then(|| words::of_level(&column.name, level));
        }
        Data::Float(cells) => number::quantity(*cells.get(row).filter(|x| !x.is_nan())?, &column.unit, 4),
        Data::Int(cells) => cells.get(row)?.to_string(),
        Data::FloatList(_) => return None,
    };
    Some(match (column.name.as_str(), column.symbol.as_str()) {
        ("damper_count", _) if value == "1" => "1 damper".into(),
        ("damper_count", _) => format!("{value} dampers"),
        ("modes", _) => format!("{value} modes"),
        ("pulse_duration", _) => format!("{value} pulse"),
        (name, "") => format!("{} {value}", column_words(name)),
        (_, symbol) => format!("{symbol} = {value}"),
    })
}

/// One label for an axis that several columns share, by their labels, the names of the columns and their unit.
pub(super) fn shared(labels: &[String], columns: &[&str], unit: &str) -> String {
    match labels {
        [one] => one.clone(),
        [first, rest @ ..] if rest.iter().all(|label| label == first) => first.clone(),
        // Different things of one unit share its word, those without a unit the words that their names end with; a legend tells
        // them apart.
        _ if unit.is_empty() => common_ending(columns).unwrap_or_else(|| {
            let (joined, ending) = without_common_words(labels);
            let joined = joined
                .iter()
                .skip(1)
                .fold(joined[0].clone(), |joined, label| format!("{joined}, {}", within_sentence(label)));
            joined + &ending
        }),
        _ => words::of_unit(unit).to_owned(),
    }
}

/// The words that the names of all these columns end with, if there are some: of `gap_elasticity` and `mass_elasticity` the last one.
fn common_ending(columns: &[&str]) -> Option<String> {
    let (first, rest) = columns.split_first()?;
    let words: Vec<&str> = first.split('_').collect();
    let ends_all =
        |from: &usize| rest.iter().all(|name| name.split('_').collect::<Vec<_>>().ends_with(&words[*from..]));
    (0..words.len()).find(ends_all).map(|from| words[from..].join(" "))
}

/// Labels without the words that all of them end with, as `per 100 cycles`, and these words.
fn without_common_words(labels: &[String]) -> (Vec<String>, String) {
    let words: Vec<Vec<&str>> = labels.iter().map(|label| label.split(' ').collect()).collect();
    let shortest = words.iter().map(Vec::len).min().unwrap_or(0);
    let alike = |back: &usize| words.iter().all(|label| label[label.len() - back] == words[0][words[0].len() - back]);
    // Of each label a word is left.
    let count = (1..shortest).take_while(alike).count();
    let ending: String = words[0][words[0].len() - count..].iter().map(|word| format!(" {word}")).collect();
    (words.iter().map(|label| label[..label.len() - count].join(" ")).collect(), ending)
}

/// First letter in lower case, unless the word is an abbreviation.
fn within_sentence(label: &str) -> String {
    let mut letters = label.chars();
    match (letters.next(), letters.next()) {
        (Some(first), Some(second)) if second.is_lowercase() => {
            first.to_lowercase().chain([second]).chain(letters).collect()
        }
        _ => label.to_owned(),
    }
}

/// In cycles a second an angular frequency ω is the frequency ω/2π.
fn in_cycles(label: &str) -> String {
    let words = label.strip_prefix("angular ").unwrap_or(label);
    match words.rsplit_once(' ') {
        Some((words, symbol)) if symbol.starts_with('ω') && !symbol.contains('/') => format!("{words} {symbol}/2π"),
        _ => words.to_owned(),
    }
}

/// The label with its unit, first letter in upper case: `Displacement (mm)`.
pub(super) fn with_unit(label: &str, unit: &str) -> String {
    let label = if unit == "Hz" { &in_cycles(label) } else { label };
    // A symbol keeps its case: x/L.
    let is_word = label.chars().nth(1).is_some_and(char::is_alphabetic);
    let label = if is_word { words::capitalised(label) } else { label.to_owned() };
    let named = label.ends_with(&format!("({unit})"));
    if unit.is_empty() || named { label } else { format!("{label} ({})", unit.replace("^2", "²")) }
}
