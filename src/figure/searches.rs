//! Several searches as one line: the median of the best that each had found after so many evaluations, in steps, and a band from
//! the least to the largest of them.

use super::sample::Sample;

/// Of searches that give evaluations and the best value so far; one that has ended keeps its last value.
pub(super) fn median(searches: &[(&[f64], &[f64])]) -> Vec<Sample> {
    let mut places: Vec<f64> = searches.iter().flat_map(|(steps, _)| steps.iter().copied()).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    let mut samples: Vec<Sample> = Vec::new();
    for x in places {
        let best = |(steps, values): &(&[f64], &[f64])| {
            let after = steps.partition_point(|step| *step <= x);
            after.checked_sub(1).and_then(|last| values.get(last).copied())
        };
        let mut values: Vec<f64> = searches.iter().filter_map(best).collect();
        values.sort_by(f64::total_cmp);
        let (Some(&least), Some(&largest)) = (values.first(), values.last()) else { continue };
        let here = Sample { x, y: values[values.len() / 2], band: [least, largest] };
        // A step: the value before holds up to here.
        if let Some(before) = samples.last().copied() {
            samples.push(Sample { x, ..before });
        }
        samples.push(here);
    }
    samples
}
