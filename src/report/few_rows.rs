//! An experiment without a statement to judge: its page leads with what it measured first where its rows are few, and with the
//! places that were looked for.

use crate::experiment::{Experiment, Maximise, SearchPoint};
use crate::reference::symbol;
use crate::study::row_in_words;
use crate::table::Table;
use crate::text::number::quantity;
use crate::text::words::{capitalised, of_key};

use crate::measure::column_words;

/// As many values as a sentence carries.
const MOST_ROWS: usize = 4;

/// `Onset of ceiling impacts at f′ = 0.141 (h′ = 1) to 11.2 (h′ = 200).`; `None` where no point is looked for.
pub(super) fn searched(experiment: &Experiment, table: &Table) -> Option<String> {
    let maximise = experiment.maximise.as_ref()?;
    let table = table.baseline();
    let places = table.floats(&maximise.column())?;
    let mut known: Vec<(usize, f64)> = places.iter().copied().enumerate().filter(|(_, at)| at.is_finite()).collect();
    known.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (least, most) = (known.first()?, known.last()?);
    let place = |(row, at): (usize, f64)| match row_in_words(experiment, &table, row) {
        name if name.is_empty() => quantity(at, maximise.over.unit(), 4),
        name => format!("{} ({name})", quantity(at, maximise.over.unit(), 4)),
    };
    let what = match maximise.wanted {
        SearchPoint::Maximum => "Largest",
        SearchPoint::Onset => "Onset of",
    };
    let of = column_words(&of_key(&maximise.measure));
    let to = if known.len() > 1 { format!(" to {}", place(*most)) } else { String::new() };
    let beyond = beyond(maximise, &known);
    Some(format!(
        "**In short.** {what} {of} at {} = {}{to}.{beyond}\n\n",
        symbol(&of_key(&maximise.over)),
        place(*least)
    ))
}

/// That some of the largest values lie at an end of the range, so that there may be larger ones behind it.
fn beyond(maximise: &Maximise, known: &[(usize, f64)]) -> String {
    let ends = [maximise.grid.first(), maximise.grid.last()];
    let is_end = |at: f64| ends.contains(&Some(&at)) && !maximise.over.ends_at(at);
    let count = known.iter().filter(|(_, at)| is_end(*at)).count();
    match (maximise.wanted, count) {
        (SearchPoint::Onset, _) | (SearchPoint::Maximum, 0) => String::new(),
        (SearchPoint::Maximum, _) if count == known.len() => {
            " That is an end of the range searched: larger values may lie beyond.".to_owned()
        }
        (SearchPoint::Maximum, _) => {
            format!(
                " In {count} of {} rows that is an end of the range searched: larger values may lie beyond.",
                known.len()
            )
        }
    }
}

/// `Velocity ratio 3.353 (h′ = 50), 2.802 (h′ = 90).`; `None` for more rows, and where a row has no value.
pub(super) fn in_short(experiment: &Experiment, table: &Table) -> Option<String> {
    let table = table.baseline();
    let measure = of_key(experiment.measures.first()?);
    let column = table.column(&measure)?;
    let values = table.floats(&measure)?;
    if !(1..=MOST_ROWS).contains(&values.len()) || values.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let row = |(row, value): (usize, &f64)| {
        let value = quantity(*value, &column.unit, 4);
        match row_in_words(experiment, &table, row) {
            name if name.is_empty() => value,
            name => format!("{value} ({name})"),
        }
    };
    let rows: Vec<String> = values.iter().enumerate().map(row).collect();
    Some(format!("**In short.** {} {}.\n\n", capitalised(&column_words(&measure)), rows.join(", ")))
}
