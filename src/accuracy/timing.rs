//! Times of repeated runs.

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

/// Fewest runs; three where two do not agree.
const FEWEST: usize = 2;
/// Runs between two looks at the median.
const BETWEEN: usize = 8;
/// Most runs.
const MOST: usize = 512;
/// How little the median may move before it counts as settled.
const SETTLED: f64 = 0.01;

/// Wall time of repeated runs, s.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// The shortest: other programs only add to it.
    pub least: f64,
    /// The median.
    pub median: f64,
    /// How many runs.
    pub runs: usize,
    /// The median moved by less than one per cent when the last quarter of the runs was added, or all of a few runs lie
    /// within one per cent of it; otherwise time was up.
    pub settled: bool,
}

impl Times {
    /// Repeats a run until its median settles, or for `patience` but until two runs agree, or three times, at least.
    pub fn of(mut run: impl FnMut(), patience: Duration) -> Self {
        let begun = Instant::now();
        let mut times: Vec<f64> = Vec::new();
        let mut settled = false;
        while times.len() < FEWEST
            || (times.len() == FEWEST && !are_alike(&times))
            || (!settled && times.len() < MOST && begun.elapsed() < patience)
        {
            let begin = Instant::now();
            run();
            times.push(begin.elapsed().as_secs_f64());
            if times.len().is_multiple_of(BETWEEN) {
                let before = median(&times[..times.len() * 3 / 4]);
                settled = (median(&times) / before - 1.0).abs() < SETTLED;
            }
        }
        let least = times.iter().copied().fold(f64::INFINITY, f64::min);
        // Runs so long that there are few of them differ little.
        settled |= times.len() < BETWEEN && are_alike(&times);
        Self { least, median: median(&times), runs: times.len(), settled }
    }

    /// Of a single run: a guess.
    pub(super) fn once(took: Duration) -> Self {
        let took = took.as_secs_f64();
        Self { least: took, median: took, runs: 1, settled: false }
    }
}

/// All within one per cent of their median.
fn are_alike(times: &[f64]) -> bool {
    let median = median(times);
    times.iter().all(|time| (time / median - 1.0).abs() < SETTLED)
}

fn median(times: &[f64]) -> f64 {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        count => f64::midpoint(sorted[(count - 1) / 2], sorted[count / 2]),
    }
}
