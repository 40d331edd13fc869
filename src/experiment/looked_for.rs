//! The point of a curve that is looked for: `maximise`, `onset`.

use super::maximise::{Maximise, SearchPoint};
use super::range::numbers;
use super::recipe::Parameter;
use crate::measure::Measure;
use crate::yaml::reader::no_such;
use crate::yaml::word::{from_word, words};
use crate::yaml::{At, Value, schema};

const OVER: &str = "A parameter";
const IN: &str = "Increasing points";

/// `maximise: {velocity_ratio: {over: gap_ratio, in: …}}`.
pub(super) fn read_maximise(at: At<'_>) -> Option<Maximise> {
    let form = "maximise: {velocity_ratio: {over: …, in: …}}";
    let what = "a maximisation";
    let (measure, how) = of_one_measure(
        at,
        form,
        what,
        |_| true,
        |at| {
            let keys = at.keys(what)?;
            let over = keys.required("over", OVER, |at| at.word::<Parameter>("parameter"));
            let grid = keys.required("in", IN, |at| grid(at, over));
            let refine = keys.optional("refine", "Rounds of refinement around the best", |at| at.count("rounds", 20));
            keys.close()?;
            Some((over?, grid?, refine?.unwrap_or(0)))
        },
    )?;
    let ((over, grid, refine), wanted) = (how?, SearchPoint::Maximum);
    Some(Maximise { measure: measure?, over, grid, refine, wanted })
}

/// `onset: {ceiling_impacts: {over: force_ratio, in: …}}`.
pub(super) fn read_onset(at: At<'_>) -> Option<Maximise> {
    let form = "onset: {ceiling_impacts: {over: …, in: …}}";
    let what = "an onset";
    let (measure, how) = of_one_measure(at, form, what, Measure::is_count, |at| {
        let keys = at.keys(what)?;
        let over = keys.required("over", OVER, |at| at.word::<Parameter>("parameter"));
        let grid = keys.required("in", IN, |at| grid(at, over));
        keys.close()?;
        Some((over?, grid?))
    })?;
    let (measure, (over, grid)) = (measure?, how?);
    if !measure.is_count() {
        let message = format!("`{}` has no onset: it is no number of events", crate::yaml::word::word_of(measure));
        let help = "events are counted by separations, floor_impacts, ceiling_impacts, stop_impacts".to_owned();
        return at.report(message, Some(help));
    }
    if grid.len() < 2 || !over.varies_smoothly() {
        return at.wrong("an onset lies between two values of a parameter that varies smoothly");
    }
    Some(Maximise { measure, over, grid, refine: 0, wanted: SearchPoint::Onset })
}

/// The measure of which a point is looked for, one that `fits`, and how.
fn of_one_measure<T>(
    at: At<'_>,
    form: &str,
    what: &'static str,
    fits: impl Fn(Measure) -> bool,
    how: impl Fn(At<'_>) -> Option<T>,
) -> Option<(Option<Measure>, Option<T>)> {
    at.form(
        |node, findings| {
            let Value::Mapping(entries) = &node.value else {
                return findings.wrong(node.span, format!("write `{form}`"));
            };
            let [entry] = entries.as_slice() else {
                return findings.wrong(node.span, format!("{what} is of one measure"));
            };
            let measure = from_word::<Measure>(&entry.key)
                .or_else(|| no_such(findings, entry.key_span, "measure", &entry.key, words::<Measure>()));
            Some((measure, how(At::Node(&entry.node, findings))))
        },
        |it| {
            let name = what.replace(' ', "_");
            let how = it.shared(&name, "Over which parameter, and where it is looked for", &how);
            let measures = words::<Measure>().iter().filter(|word| from_word(word).is_some_and(&fits));
            schema::one_of_keys(it.about(), measures.map(|measure| (*measure, how.clone())))
        },
    )
}

/// Values of the parameter that increase.
fn grid(at: At<'_>, over: Option<Parameter>) -> Option<Vec<f64>> {
    if let At::Node(..) = at {
        over?;
    }
    let grid = numbers(at, over)?;
    if !grid.is_sorted_by(|a, b| a < b) {
        return at.wrong("the points to look at increase");
    }
    Some(grid)
}
