//! The whole experiment.

use serde_json::{Map, Value, json};

use super::parts::{
    NUMBER, Object, PREFIX, any_of, count, list, one_or_more, quantity, reference, text, word, words_of,
};
use super::{assumptions, continuation, figure, optimise, scene, starts, sweep};
use crate::dynamics::Until;
use crate::experiment::about_study::MOST_CHAPTERS;
use crate::experiment::assumption_reader::MOST_CYCLES;
use crate::experiment::assumption_sheet::AssumptionSheet;
use crate::experiment::quantity::Dimension;
use crate::experiment::recipe::Parameter;
use crate::experiment::validate::LISTS;
use crate::experiment::word::{from_word, words};
use crate::measure::{CycleValue, Measure, ShapeOf};

/// JSON Schema of an experiment; of the study's assumptions it offers those that fit a place.
#[must_use]
pub fn experiment_schema(sheet: &AssumptionSheet) -> Value {
    let mut definitions = Map::new();
    let parts = [sweep::definitions(), scene::definitions(), figure::definitions(), assumptions::definitions(sheet)];
    definitions.extend(parts.into_iter().flatten());
    definitions.insert("maximisation".into(), maximisation());
    // Rows of an optimisation are candidates, those of an orbit its branches' motions, those of starts the motions they end in.
    let of_a_row = LISTS.map(|key| json!({"required": [key]}));
    let mut schema = Object::new("An experiment")
        .required("title", text("A few words"))
        .optional("source", source())
        .required("about", text("One or two sentences"))
        .optional("stated", stated())
        .required("scene", scene::scene())
        .optional("sweep", reference("sweep"))
        .optional("mean_over", reference("sweep"))
        .optional("maximise", maximise())
        .optional("onset", onset())
        .optional("optimise", optimise::optimise())
        .optional("orbit", continuation::continuation())
        .optional("starts", starts::starts())
        .required("measure", one_or_more("What is measured", reference("measure")))
        .optional("run", run(sheet))
        .optional("trace", trace())
        .optional("energies", energies())
        .optional("shape", shape())
        .optional("each_cycle", each_cycle())
        .optional("figure", reference("figure"))
        .optional("figures", list("Several figures", reference("figure")))
        .exclusive(&["figure", "figures"])
        .exclusive(&LISTS)
        .exclusive(&["optimise", "sweep"])
        .exclusive(&["maximise", "onset", "optimise"])
        .exclusive(&["orbit", "sweep"])
        .exclusive(&["orbit", "mean_over"])
        .exclusive(&["orbit", "maximise"])
        .exclusive(&["orbit", "onset"])
        .exclusive(&["orbit", "optimise"])
        .exclusive(&["starts", "mean_over"])
        .exclusive(&["starts", "maximise"])
        .exclusive(&["starts", "onset"])
        .exclusive(&["starts", "optimise"])
        .exclusive(&["starts", "orbit"])
        .rule(json!({
            "if": {"anyOf": [{"required": ["optimise"]}, {"required": ["orbit"]}, {"required": ["starts"]}]},
            "then": {"not": {"anyOf": of_a_row}},
        }))
        .schema();
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!("Experiment");
    schema["definitions"] = Value::Object(definitions);
    schema
}

fn source() -> Value {
    Object::new("Where a publication shows it")
        .optional("chapter", count("Chapter", "", 0, MOST_CHAPTERS))
        .optional("section", text("Section, for example \"3.6.3\""))
        .optional("shown_in", one_or_more("Figures, or a citation", text("For example Fig. 18")))
        .schema()
}

/// What a text states of the inputs: the place, and the keys with their values.
pub(super) fn stated() -> Value {
    let number = || json!({"type": ["number", "string"]});
    let mut inputs = Object::new("What this table, figure or section states, by key").schema();
    inputs["additionalProperties"] = any_of("A number, or a list", vec![number(), list("Numbers", number())]);
    let mut places = Object::new("Inputs that the text states, by table, figure or section").schema();
    places["additionalProperties"] = inputs;
    places
}

fn maximisation() -> Value {
    Object::new("Over which parameter, and where it is looked for")
        .required("over", words_of::<Parameter>("A parameter"))
        .required("in", sweep::any_range())
        .optional("refine", count("Rounds of refinement around the best", "rounds", 0, 20))
        .schema()
}

fn maximise() -> Value {
    of_one_measure("The measure whose maximum is looked for", |_| true, &reference("maximisation"))
}

fn onset() -> Value {
    let onset = Object::new("Over which parameter, and where it is looked for")
        .required("over", words_of::<Parameter>("A parameter"))
        .required("in", sweep::any_range());
    of_one_measure(
        "The number of events of which it is looked for where it ceases to be zero",
        Measure::is_count,
        &onset.schema(),
    )
}

fn of_one_measure(about: &str, takes: impl Fn(Measure) -> bool, how: &Value) -> Value {
    let measures = words::<Measure>().iter().filter(|word| from_word(word).is_some_and(&takes));
    let mut schema =
        measures.fold(Object::new(about), |object, measure| object.optional(measure, how.clone())).schema();
    schema["minProperties"] = json!(1);
    schema["maxProperties"] = json!(1);
    schema
}

fn run(sheet: &AssumptionSheet) -> Value {
    let sensitivity = one_or_more("Assumptions that are moved", assumptions::any(sheet));
    Object::new("How it is run")
        .optional("solver", one_or_more("Solvers", reference("solver")))
        .optional("skip", skip())
        .optional("average", average())
        .optional("until", words_of::<Until>("When it ends: after these cycles, or where it has settled before"))
        .optional("round_period_to", quantity("The period is rounded to this", Dimension::Time))
        .optional(
            "ensemble",
            any_of(
                "Perturbed starts where the motion is chaotic; 32 members unless stated",
                vec![count("Members", "members", 0, 10_000), word("none")],
            ),
        )
        .optional("limit", limit())
        .optional("sensitivity", any_of("Assumptions that are moved, or none", vec![sensitivity, word("none")]))
        .schema()
}

/// Cycles that are left out.
pub(super) fn skip() -> Value {
    count("Cycles before the averaging; by default those of the study", "cycles", 0, MOST_CYCLES)
}

/// Cycles that are averaged over.
pub(super) fn average() -> Value {
    count("Cycles that are averaged; by default those of the study", "cycles", 1, MOST_CYCLES)
}

fn limit() -> Value {
    let events = json!({"description": "Events of a simulation; 1e8 unless stated", "type": "number", "minimum": 1, "maximum": 1e15});
    let time = json!({
        "description": "Processor time of a row; 10 min unless stated",
        "type": "string",
        "pattern": format!(r"^\s*{NUMBER}\s*(h|min|{PREFIX}s)\s*$"),
        "examples": ["10 min"],
    });
    Object::new("The most that a row may take; one that reaches it has failed, with the reason, and the others go on")
        .optional("events", events)
        .optional("time", time)
        .schema()
}

fn span(about: &str) -> Object {
    let cycle = |about| count(about, "cycles", 0, MOST_CYCLES);
    Object::new(about).required("from", cycle("First cycle")).required("to", cycle("Last cycle"))
}

fn trace() -> Value {
    span("A time history that is kept")
        .required("samples_per_cycle", count("Samples a cycle", "samples", 0, 1_000_000))
        .schema()
}

fn energies() -> Value {
    span("Kinetic energies that are kept").schema()
}

fn each_cycle() -> Value {
    let value = || words_of::<CycleValue>("A value of a cycle, or of each contact in it");
    let some = Object::new("The value, of the last cycles")
        .required("of", value())
        .optional("last", count("Cycles; all that are averaged unless stated", "cycles", 1, MOST_CYCLES));
    any_of("A value of each averaged cycle that is kept", vec![value(), some.schema()])
}

fn shape() -> Value {
    let points = count("Points along a side", "points", 2, 100_000);
    Object::new("A shape that is kept")
        .required("of", words_of::<ShapeOf>("What it is of"))
        .required("points", one_or_more("Points, or points a side", points))
        .schema()
}
