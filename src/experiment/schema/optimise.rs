//! Optimisations.

use serde_json::{Value, json};

use super::parts::{Object, any_of, boolean, count, list, one_or_more, quantity, ratio, reference, text, words_of};
use super::sweep::NAME;
use crate::experiment::optimise::SearchSpacing;
use crate::experiment::optimise_reader::{MOST, MOST_INDIVIDUALS};
use crate::experiment::quantity::Dimension;

pub(super) fn optimise() -> Value {
    let bounds = |gap: Value| {
        let pair = Object::new("From a gap to a larger one").required("from", gap.clone()).required("to", gap);
        one_or_more("Bounds of all gaps, or of each", pair.schema())
    };
    // A length or a ratio, as the bounds are.
    let gap = any_of(
        "A gap: a length beside `gaps`, a ratio beside `gap_ratios`",
        vec![quantity("Gap clearance", Dimension::Length), ratio("h′")],
    );
    let candidates = json!({
        "description": "Gaps that are evaluated as they are, by name",
        "type": "object",
        "propertyNames": {"pattern": NAME},
        "additionalProperties": one_or_more("One gap for all, or one a damper", gap),
    });
    let individuals = |about, least| count(about, "individuals", least, MOST_INDIVIDUALS);
    let genetic = Object::new("The genetic algorithm")
        .required("population", individuals("Individuals", 4))
        .optional("elites", individuals("Individuals that live on", 0))
        .optional(
            "crossover",
            json!({"description": "Share of children by crossover", "type": "number", "minimum": 0, "maximum": 1}),
        )
        .optional("start", one_or_more("Candidates to start from", text("Name of a candidate")));
    let cma_es = Object::new("CMA-ES, the peer").optional("population", individuals("Individuals", 4));
    let points = || count("Points along each gap", "points", 2, 10_000);
    let spacing = || words_of::<SearchSpacing>("How points are spaced");
    let dense = Object::new("Every point of a grid")
        .required("points", points())
        .optional("spacing", spacing())
        .optional("refine", count("Finer grids around the best", "rounds", 0, 50));
    let landscape = Object::new("Fitness along each gap").required("points", points()).optional("spacing", spacing());
    let two_opt = any_of(
        "Improve by 2-opt what the genetic algorithm found, or these candidates",
        vec![boolean("What the genetic algorithm found"), list("Names", text("genetic, or a candidate"))],
    );
    let some = |about, noun| count(about, noun, 1, MOST);
    let stop = Object::new("What ends a search")
        .optional("generations", some("Generations", "generations"))
        .optional("evaluations", some("Evaluations", "evaluations"))
        .optional("time", quantity("Time", Dimension::Time))
        .optional("tolerance", ratio("Gain below which a generation has stalled"))
        .optional("stalled", some("Generations over which the tolerance is taken", "generations"))
        .rule(json!({"if": {"required": ["stalled"]}, "then": {"required": ["tolerance"]}}));
    Object::new("A search for the best gaps")
        .exactly_one(vec![("minimise", reference("measure")), ("maximise", reference("measure"))])
        .exactly_one(vec![("gaps", bounds(quantity("A gap", Dimension::Length))), ("gap_ratios", bounds(ratio("h′")))])
        .required("candidates", candidates)
        .optional("compare_with", text("The candidate that improvements are measured from"))
        .optional("genetic", genetic.schema())
        .optional("cma_es", cma_es.schema())
        .optional("dense", dense.schema())
        .optional("two_opt", two_opt)
        .optional("seeds", list("Seeds, each a search of its own", count("A seed", "", 0, u32::MAX)))
        .optional("stop", stop.schema())
        .optional("landscape", landscape.schema())
        .schema()
}
