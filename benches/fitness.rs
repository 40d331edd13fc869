//! How fast a fitness is: the mean RMS velocity of a cantilever beam with four dampers over six force points, 125 cycles each,
//! as a search of chapter 6 evaluates it some thousand times.

use std::path::Path;

use divan::Bencher;
use shotdamp::experiment::{Experiment, load_assumptions, parse_experiment};
use shotdamp::measure::Rigour;
use shotdamp::study::{Array, Engine, Evaluate, Simulation};

fn main() {
    divan::main();
}

fn experiment(id: &str) -> (Experiment, shotdamp::experiment::Assumptions) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments");
    let sheet = load_assumptions(&root.join("assumptions.yaml")).unwrap_or_else(|problems| panic!("{problems}"));
    let path = root.join(format!("ch6/{id}.yaml"));
    let text = std::fs::read_to_string(&path).expect("the experiment is there");
    let assumptions = sheet.assumptions();
    let experiment = parse_experiment(&id.parse().expect("an id"), id, &text, &assumptions);
    (experiment.unwrap_or_else(|problems| panic!("{problems}")), assumptions)
}

/// One evaluation of candidate `which` of an optimisation, everything prepared that a search prepares.
fn evaluation(bencher: Bencher<'_, '_>, id: &str, which: usize) {
    let (experiment, assumptions) = experiment(id);
    let optimise = experiment.optimise.as_ref().expect("it optimises");
    let recipes = experiment.recipes_in(&experiment.recipe).expect("its scenes");
    let arrays: Vec<Box<dyn Array + '_>> = recipes
        .iter()
        .map(|recipe| {
            let simulation = Simulation::step(&experiment, recipe, &assumptions, &experiment.measures);
            Engine.array(simulation, optimise.gaps).expect("its scenes compile")
        })
        .collect();
    let gaps = &optimise.candidates[which].gaps;
    bencher.bench(|| {
        let fitness = |array: &(dyn Array + '_)| {
            array.evaluate(divan::black_box(gaps), Rigour::Step).expect("it runs").measured[0].value
        };
        arrays.iter().map(|array| fitness(array.as_ref())).sum::<f64>()
    });
}

#[divan::bench(args = ["ch6-beam-b1-light", "ch6-beam-b2-heavy"])]
fn uniform_gaps_on_a_beam(bencher: Bencher<'_, '_>, id: &str) {
    evaluation(bencher, id, 0);
}

#[divan::bench(args = ["ch6-beam-b1-light", "ch6-beam-b2-heavy"])]
fn optimum_of_the_study_on_a_beam(bencher: Bencher<'_, '_>, id: &str) {
    evaluation(bencher, id, 1);
}

#[divan::bench(args = ["ch6-plate-c1-light", "ch6-plate-c3-heavy"])]
fn uniform_gaps_on_a_plate(bencher: Bencher<'_, '_>, id: &str) {
    evaluation(bencher, id, 0);
}
