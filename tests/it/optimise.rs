//! Optimisers find the known optima of published test functions, whatever the order in which points are evaluated.

use std::convert::Infallible;
use std::f64::consts::{E, TAU};

use shotdamp::optimise::{
    Batch, Bounds, CmaEs, Dense, Found, Genetic, GeneticSettings, Optimiser, Score, Slope, Spacing, Stalled, Stopped,
    Stopping, Stream, Wanted, dense, minimise, polish, sections, two_opt,
};

type Function = fn(&[f64]) -> f64;

fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

/// Minimum 0 at (1, …, 1), at the end of a bent valley.
fn rosenbrock(x: &[f64]) -> f64 {
    x.windows(2).map(|w| 100.0 * (w[1] - w[0] * w[0]).powi(2) + (1.0 - w[0]).powi(2)).sum()
}

/// Some ten local minima a coordinate.
fn rastrigin(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x - 10.0 * (TAU * x).cos() + 10.0).sum()
}

fn ackley(x: &[f64]) -> f64 {
    let n = x.len() as f64;
    let cosines = x.iter().map(|x| (TAU * x).cos()).sum::<f64>();
    -20.0 * (-0.2 * (sphere(x) / n).sqrt()).exp() - (cosines / n).exp() + 20.0 + E
}

fn griewank(x: &[f64]) -> f64 {
    let product: f64 = x.iter().enumerate().map(|(i, x)| (x / ((i + 1) as f64).sqrt()).cos()).product();
    1.0 + sphere(x) / 4000.0 - product
}

/// The functions with the boxes that they are published with, moved so that the optimum is in no special place.
const FUNCTIONS: [(&str, Function, [f64; 2]); 5] = [
    ("sphere", sphere, [-5.12, 4.0]),
    ("Rosenbrock", rosenbrock, [-2.048, 2.6]),
    ("Rastrigin", rastrigin, [-5.12, 4.0]),
    ("Ackley", ackley, [-32.768, 28.0]),
    ("Griewank", griewank, [-600.0, 500.0]),
];

fn cube([low, high]: [f64; 2], size: usize) -> Bounds {
    Bounds::new(vec![[low, high]; size]).unwrap()
}

/// Evaluates one after the other, without noise.
fn exact(function: Function) -> impl FnMut(&[Vec<f64>], Wanted) -> Result<Batch, Infallible> {
    move |points, _| {
        let score = |point: &Vec<f64>| Score { value: function(point) };
        Ok(Batch { scores: points.iter().map(score).collect(), seconds: 0.25 })
    }
}

fn search(optimiser: &mut dyn Optimiser, function: Function, evaluations: u64) -> Found {
    let stopping = Stopping { evaluations: Some(evaluations), ..Stopping::default() };
    minimise(optimiser, &stopping, &mut exact(function)).unwrap().unwrap()
}

fn genetic(bounds: Bounds, seed: u64) -> Genetic {
    Genetic::new(bounds, GeneticSettings { population: 50, elites: 3, crossover: 0.8 }, seed, &[])
}

#[test]
fn the_genetic_algorithm_finds_published_optima_of_four_variables() {
    // The study's size is 50 individuals; 400 generations of it. A genetic algorithm is slow in a bent valley.
    let reached = [1e-6, 1.0, 1e-4, 1e-2, 0.1];
    for ((name, function, side), reached) in FUNCTIONS.into_iter().zip(reached) {
        let values: Vec<f64> =
            (1..=5).map(|seed| search(&mut genetic(cube(side, 4), seed), function, 20_000).score.value).collect();
        assert!(values.iter().all(|value| *value < reached), "{name}: {values:?}");
    }
}

#[test]
fn the_peer_finds_published_optima_of_four_variables() {
    let reached = [1e-12, 1e-12, 1e-6, 1e-6, 0.05];
    for ((name, function, side), reached) in FUNCTIONS.into_iter().zip(reached) {
        let values: Vec<f64> = (1..=5)
            .map(|seed| search(&mut CmaEs::new(cube(side, 4), None, seed), function, 30_000).score.value)
            .collect();
        assert!(values.iter().all(|value| *value < reached), "{name}: {values:?}");
    }
    // One start converges at the rate that the tutorial reports for the sphere: some 250 evaluations a decade and ten variables.
    let quick = search(&mut CmaEs::new(cube([-5.0, 4.0], 10), None, 1), sphere, 3000);
    assert!(quick.score.value < 1e-9, "{}", quick.score.value);
}

#[test]
fn optima_on_the_bounds_are_found_there() {
    let tilted: Function = |x| x[0] - 2.0 * x[1] + (x[2] - 0.3).powi(2) + x[3];
    for optimiser in
        [&mut genetic(cube([0.0, 1.0], 4), 7) as &mut dyn Optimiser, &mut CmaEs::new(cube([0.0, 1.0], 4), None, 7)]
    {
        let found = search(optimiser, tilted, 4000);
        assert!((found.score.value + 2.0).abs() < 1e-4, "{found:?}");
        assert!(found.point.iter().all(|x| (0.0..=1.0).contains(x)));
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_another_way() {
    let run = |seed| {
        let one = search(&mut genetic(cube([-5.12, 4.0], 4), seed), rastrigin, 2000);
        (one, search(&mut CmaEs::new(cube([-5.12, 4.0], 4), None, seed), rastrigin, 2000))
    };
    assert!(run(3) == run(3));
    assert!(run(3).0.point != run(4).0.point && run(3).1.point != run(4).1.point);
    // A stream belongs to its place, however many numbers others have drawn.
    let draws = |place: &[u64]| {
        let mut stream = Stream::of(1, place);
        [stream.uniform(), stream.uniform(), stream.normal()]
    };
    assert_eq!(draws(&[2, 3]), draws(&[2, 3]));
    assert!(draws(&[2, 3]) != draws(&[3, 2]) && draws(&[2]) != draws(&[2, 0]));
}

#[test]
fn random_numbers_have_the_moments_of_their_distributions() {
    let count = 200_000;
    let mut stream = Stream::of(11, &[]);
    let mean = |draw: &mut dyn FnMut() -> f64| (0..count).map(|_| draw()).sum::<f64>() / f64::from(count);
    assert!((mean(&mut || stream.uniform()) - 0.5).abs() < 0.003);
    assert!(mean(&mut || stream.normal()).abs() < 0.01);
    assert!((mean(&mut || stream.normal().powi(2)) - 1.0).abs() < 0.02);
    // First numbers of neighbouring streams are as independent as those of one stream.
    let mut place = 0;
    let neighbours = mean(&mut || {
        place += 1;
        (Stream::of(5, &[1, place]).uniform() - 0.5) * (Stream::of(5, &[1, place + 1]).uniform() - 0.5)
    });
    assert!(neighbours.abs() < 0.001, "{neighbours}");
}

#[test]
fn each_stopping_condition_stops() {
    let stopped = |stopping: Stopping| {
        let found = minimise(&mut genetic(cube([-5.0, 4.0], 4), 1), &stopping, &mut exact(sphere)).unwrap().unwrap();
        (found.stopped, found.evaluations, found.trail.len())
    };
    let usual = Stopping { generations: Some(2000), ..Stopping::default() };
    assert_eq!(stopped(Stopping { generations: Some(3), ..usual }), (Stopped::Generations, 50 + 2 * 47, 3));
    // The last generation is cut to the budget.
    assert_eq!(stopped(Stopping { evaluations: Some(120), ..usual }), (Stopped::Evaluations, 120, 3));
    // A batch takes a quarter of a second here.
    assert_eq!(stopped(Stopping { seconds: Some(1.0), ..usual }), (Stopped::Time, 50 + 3 * 47, 4));
    let stalled = Stalled { tolerance: 0.01, generations: 10 };
    let (why, evaluations, _) = stopped(Stopping { stalled: Some(stalled), ..usual });
    assert!(why == Stopped::Tolerance && evaluations < 20_000, "{why:?} {evaluations}");
}

#[test]
fn a_first_population_begins_where_it_is_told_to_and_failures_are_the_worst() {
    let settings = GeneticSettings { population: 10, elites: 1, crossover: 0.8 };
    let mut begun = Genetic::new(cube([0.0, 1.0], 2), settings, 1, &[vec![0.25, 0.75]]);
    assert_eq!(begun.ask()[0], [0.25, 0.75]);
    let holes: Function = |x| if x[0] < 0.5 { f64::NAN } else { x[0] };
    let found = search(&mut genetic(cube([0.0, 1.0], 2), 1), holes, 2000);
    assert!((found.score.value - 0.5).abs() < 1e-3);
    let found = search(&mut CmaEs::new(cube([0.0, 1.0], 2), None, 1), holes, 2000);
    assert!((found.score.value - 0.5).abs() < 1e-3);
}

#[test]
fn two_opt_sorts_by_swaps_and_stops_where_none_helps() {
    // The sum of i x_i is smallest where the values decrease.
    let weighted: Function = |x| x.iter().enumerate().map(|(i, x)| i as f64 * x).sum();
    let start = [1.0, 4.0, 2.0, 3.0];
    let score = Score { value: weighted(&start) };
    let found = two_opt(&start, score, &cube([0.0, 4.0], 4), &mut exact(weighted)).unwrap();
    assert_eq!(found.point, [4.0, 3.0, 2.0, 1.0]);
    let again = two_opt(&found.point, found.score, &cube([0.0, 4.0], 4), &mut exact(weighted)).unwrap();
    assert_eq!((again.point, again.evaluations), (found.point, 6));
    let uniform = two_opt(&[2.0; 4], Score { value: 1.0 }, &cube([0.0, 4.0], 4), &mut exact(weighted)).unwrap();
    assert_eq!(uniform.evaluations, 0, "equal values have nothing to swap");

    // Only the first two have room for the value of the other.
    let sides = Bounds::new(vec![[0.0, 5.0], [0.0, 5.0], [1.5, 2.5], [2.5, 3.5]]).unwrap();
    let held = two_opt(&start, score, &sides, &mut exact(weighted)).unwrap();
    assert_eq!(held.point, [4.0, 1.0, 2.0, 3.0]);
    assert!(sides.hold(&held.point));
}

#[test]
fn a_dense_search_sees_every_point_of_its_grid_and_closes_in() {
    let bounds = cube([-5.12, 4.0], 3);
    let settings = Dense { points: 11, spacing: Spacing::Linear, refine: 0 };
    let coarse = dense(&bounds, settings, &mut exact(sphere)).unwrap().unwrap();
    assert_eq!(coarse.evaluations, 11 * 11 * 11);
    let axis = bounds.along(0, 11, Spacing::Linear);
    let nearest = axis.into_iter().min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap();
    assert_eq!(coarse.point, [nearest; 3]);
    let fine = dense(&bounds, Dense { refine: 12, ..settings }, &mut exact(sphere)).unwrap().unwrap();
    assert!(fine.score.value < 1e-6, "{}", fine.score.value);
}

/// Sums of non-negative terms, drawn by lot: bowls, ripples and steps about centres of their own.
fn terms(landscape: u64, x: &[f64]) -> impl Iterator<Item = f64> {
    (0..6).map(move |term| {
        let mut stream = Stream::of(landscape, &[term]);
        let far = x.iter().map(|x| (x - stream.uniform()).powi(2)).sum::<f64>();
        let ripple = 1.0 + stream.uniform() * (30.0 * far).cos();
        // Steps make equal values.
        if stream.coin() { far * ripple } else { (8.0 * far).floor() / 8.0 }
    })
}

/// Evaluates as many terms as it takes to know that an earlier point is less, where only the least is wanted; counts them.
fn frugal(landscape: u64, counted: &mut u64) -> impl FnMut(&[Vec<f64>], Wanted) -> Result<Batch, Infallible> {
    move |points, wanted| {
        let mut least = if let Wanted::Least { below } = wanted { below } else { f64::INFINITY };
        let mut scores = Vec::new();
        for point in points {
            let mut value = 0.0;
            for term in terms(landscape, point) {
                value += term;
                *counted += 1;
                if value > least && wanted != Wanted::Each {
                    break;
                }
            }
            least = least.min(value);
            scores.push(Score { value });
        }
        Ok(Batch { scores, seconds: 0.0 })
    }
}

fn whole(landscape: u64, counted: &mut u64) -> impl FnMut(&[Vec<f64>], Wanted) -> Result<Batch, Infallible> {
    let mut inner = frugal(landscape, counted);
    move |points, _| inner(points, Wanted::Each)
}

#[test]
fn searches_end_at_the_same_point_when_evaluations_that_cannot_win_are_stopped() {
    let bounds = cube([0.0, 1.0], 3);
    let settings = Dense { points: 7, spacing: Spacing::Linear, refine: 4 };
    let [mut in_full, mut stopped] = [0, 0];
    for landscape in 0..60 {
        let searches = |evaluate: &mut shotdamp::optimise::Function<'_, Infallible>| {
            let generations = Stopping { generations: Some(4), ..Stopping::default() };
            let genetic = minimise(&mut genetic(bounds.clone(), landscape), &generations, evaluate).unwrap().unwrap();
            let swapped = two_opt(&genetic.point, genetic.score, &bounds, evaluate).unwrap();
            let budget = Stopping { evaluations: Some(100), ..Stopping::default() };
            let mut peer = CmaEs::new(bounds.clone(), None, landscape);
            let peer = minimise(&mut peer, &budget, evaluate).unwrap().unwrap();
            [genetic, swapped, peer, dense(&bounds, settings, evaluate).unwrap().unwrap()]
        };
        assert_eq!(
            searches(&mut whole(landscape, &mut in_full)),
            searches(&mut frugal(landscape, &mut stopped)),
            "landscape {landscape}"
        );
    }
    assert!(stopped * 5 < in_full * 4, "{stopped} of {in_full} terms");
}

#[test]
fn sections_go_through_the_point_on_every_side() {
    let bounds = Bounds::new(vec![[0.1, 10.0], [1.0, 2.0]]).unwrap();
    let evaluate = |points: &[Vec<f64>]| {
        assert_eq!(points.len(), 6 + 6 - 1, "the centre once");
        Ok::<_, Infallible>(points.iter().map(|point| sphere(point)).collect())
    };
    let cut = sections(&bounds, &[3.0, 1.5], 5, Spacing::Log, evaluate).unwrap();
    assert_eq!(cut.len(), 2);
    let at = cut[0].along.iter().position(|x| *x == 3.0).unwrap();
    assert_eq!(cut[0].values[at], sphere(&[3.0, 1.5]));
    assert!((cut[0].along[2] - 1.0).abs() < 1e-12 && cut[0].along.len() == 6, "{:?}", cut[0].along);
}

#[test]
fn bounds_that_enclose_nothing_are_refused() {
    assert!(Bounds::new(vec![]).is_err());
    let description = Bounds::new(vec![[0.0, 1.0], [2.0, 2.0]]).unwrap_err().to_string();
    assert_eq!(description, "coordinate 2 lies between 2 and 2, which is no range");
}

/// Rosenbrock's function with its gradient.
fn valley(x: &[f64]) -> Slope {
    let mut gradient = vec![0.0; x.len()];
    for i in 0..x.len() - 1 {
        let rise = x[i + 1] - x[i] * x[i];
        gradient[i] += -400.0 * x[i] * rise - 2.0 * (1.0 - x[i]);
        gradient[i + 1] += 200.0 * rise;
    }
    Slope { value: rosenbrock(x), gradient }
}

fn polished(bounds: &Bounds, start: &[f64], mut slope: impl FnMut(&[f64]) -> Option<Slope>) -> Found {
    polish(bounds, start, 200, &mut |x: &[f64]| Ok::<_, Infallible>(slope(x))).unwrap()
}

#[test]
fn polishing_follows_a_bent_valley_to_its_end() {
    for size in [2, 4, 8] {
        let found = polished(&cube([-2.048, 2.6], size), &vec![-0.5; size], |x| Some(valley(x)));
        assert_eq!(found.stopped, Stopped::Converged, "{found:?}");
        assert!(found.point.iter().all(|x| (x - 1.0).abs() < 1e-7), "{found:?}");
        assert!(found.trail.windows(2).all(|pair| pair[1].best <= pair[0].best));
    }
}

#[test]
fn polishing_ends_at_a_bound_at_an_edge_or_where_it_begins() {
    // The valley crosses x₁ = 0.8 at x₂ = 0.64.
    let narrow = Bounds::new(vec![[-1.0, 0.8], [-1.0, 2.0]]).unwrap();
    let found = polished(&narrow, &[-0.5, 0.5], |x| Some(valley(x)));
    assert_eq!(found.stopped, Stopped::Bound);
    assert!((found.point[0] - 0.8).abs() < 1e-12 && (found.point[1] - 0.64).abs() < 1e-8, "{found:?}");
    // Beyond 0.7 the function has no derivative.
    let found = polished(&cube([-2.0, 2.0], 1), &[0.0], |x| {
        (x[0] < 0.7).then(|| Slope { value: (x[0] - 1.0).powi(2), gradient: vec![2.0 * (x[0] - 1.0)] })
    });
    assert_eq!(found.stopped, Stopped::Edge);
    assert!(found.point[0] < 0.7 && found.point[0] > 0.7 - 1e-9, "{found:?}");
    let found = polished(&cube([-2.0, 2.0], 1), &[0.5], |_| None);
    assert_eq!((found.stopped, found.point), (Stopped::NotSmooth, vec![0.5]));
    let found = polish(&cube([-2.0, 2.0], 2), &[-1.0, 1.5], 5, &mut |x: &[f64]| Ok::<_, Infallible>(Some(valley(x))));
    assert_eq!(found.unwrap().stopped, Stopped::Evaluations);
}
