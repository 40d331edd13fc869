//! 2-opt: the values of two coordinates change places wherever that is better, until no swap within the bounds helps.

use super::bounds::Bounds;
use super::search::{Found, Function, Score, Step, Stopped, Wanted};

/// Improves `start`, whose score is known. Each pass tries every pair and takes the best swap.
///
/// # Errors
/// What `evaluate` fails with.
pub fn two_opt<E>(start: &[f64], score: Score, bounds: &Bounds, evaluate: &mut Function<'_, E>) -> Result<Found, E> {
    let mut found = Found {
        point: start.to_vec(),
        score,
        evaluations: 0,
        trail: vec![Step { evaluations: 0, best: score.value }],
        stopped: Stopped::Exhausted,
    };
    loop {
        let swaps: Vec<Vec<f64>> = swaps(&found.point, bounds);
        if swaps.is_empty() {
            return Ok(found);
        }
        let scores = evaluate(&swaps, Wanted::Least { below: found.score.order() })?.scores;
        found.evaluations += swaps.len() as u64;
        let best = (0..swaps.len()).min_by(|a, b| scores[*a].order().total_cmp(&scores[*b].order()));
        let better = best.filter(|best| scores[*best].order() < found.score.order());
        if let Some(best) = better {
            found.point.clone_from(&swaps[best]);
            found.score = scores[best];
        }
        found.trail.push(Step { evaluations: found.evaluations, best: found.score.value });
        if better.is_none() {
            return Ok(found);
        }
    }
}

/// Every point within the bounds that differs by one swap.
fn swaps(point: &[f64], bounds: &Bounds) -> Vec<Vec<f64>> {
    let pairs = (0..point.len()).flat_map(|i| (i + 1..point.len()).map(move |j| (i, j)));
    pairs
        .filter(|&(i, j)| point[i] != point[j])
        .map(|(i, j)| {
            let mut swapped = point.to_vec();
            swapped.swap(i, j);
            swapped
        })
        .filter(|swapped| bounds.hold(swapped))
        .collect()
}
