//! Scenes: structure, dampers, excitation, what is observed.

use serde_json::{Value, json};

use super::assumptions::{assumed, curve};
use super::parts::{
    Object, any_of, between, boolean, count, form, list, one_of_words, one_or_more, quantity, ratio, reference, word,
};
use crate::experiment::assumption_sheet::{Quantity, Takes};
use crate::experiment::quantity::Dimension;
use crate::experiment::recipe::Slot;
use crate::experiment::scene::MOST_DAMPERS;
use crate::experiment::structure::MOST_MODES;
use crate::scene::{Form, KINDS, Kind};

/// The definitions that scenes share.
pub(in crate::experiment) fn definitions() -> Vec<(String, Value)> {
    vec![("surface".into(), surface()), ("place".into(), place()), ("damper".into(), damper())]
}

/// A value, or that it is swept.
fn swept_or(value: Value) -> Value {
    let about = value["description"].clone();
    json!({"description": about, "anyOf": [value, word("swept")]})
}

/// A value, or `{assumed: NAME}`.
fn given(takes: Takes<'_>, value: Value) -> Value {
    let about = value["description"].clone();
    json!({"description": about, "anyOf": [value, assumed(takes)]})
}

fn given_quantity(about: &str, dimension: Dimension) -> Value {
    given(Takes::quantity(dimension), quantity(about, dimension))
}

fn given_ratio(about: &str) -> Value {
    given(Takes::ratio(), ratio(about))
}

/// The value of a slot, an assumption, or plain `assumed` where the study declares which assumption that is.
fn slot(slot: Slot, value: Value) -> Value {
    let about = value["description"].clone();
    json!({"description": about, "anyOf": [value, word("assumed"), assumed(slot.takes())]})
}

/// A reading of a slot.
fn reading(of: Slot) -> Value {
    slot(of, one_of_words(of.about(), of.takes().readings))
}

pub(in crate::experiment) fn scene() -> Value {
    let dampers = json!({
        "description": "The dampers",
        "type": "array",
        "items": reference("damper"),
        "maxItems": MOST_DAMPERS,
    });
    let on_one_mass: Vec<Value> = KINDS
        .iter()
        .filter(|kind| kind.sides.is_empty())
        .map(|kind| json!({"properties": {"structure": {"required": [kind.name]}}}))
        .collect();
    Object::new("What is simulated")
        .required("structure", structure())
        .optional("gravity", slot(Slot::Gravity, quantity("Gravity", Dimension::Acceleration)))
        .optional("undamped_mass", reading(Slot::UndampedMass))
        .optional("mass_measure", reading(Slot::MassMeasure))
        .optional("dampers", dampers)
        .required("excitation", excitation())
        .optional("start", start())
        .optional("observe", observe())
        // Where there are no sides there are no places; elsewhere there have to be.
        .rule(json!({
            "if": {"required": ["structure"], "anyOf": on_one_mass},
            "then": {"properties": {"dampers": {"items": {
                "not": {"anyOf": [
                    {"required": ["at"]},
                    {"required": ["array"]},
                    {"required": ["mass_reading"]},
                    {"required": ["gap_frequency"]},
                ]},
            }}}},
            "else": {"not": {"required": ["undamped_mass"]}, "properties": {"dampers": {"items": {
                "required": ["at", "particle_share"],
                "not": {"required": ["massless_ratio"]},
            }}}},
        }))
        .schema()
}

fn structure() -> Value {
    let kinds = KINDS.iter().map(|kind| (kind.name, of_kind(kind))).collect();
    Object::new("The vibrating structure").exactly_one(kinds).schema()
}

fn of_kind(kind: &Kind) -> Value {
    kind.fields
        .iter()
        .fold(Object::new(kind.what), |object, field| {
            let about = field.key.replace('_', " ");
            let value = match field.form {
                Form::Length => given_quantity(&about, Dimension::Length),
                Form::Mass => given_quantity(&about, Dimension::Mass),
                Form::Stiffness => given_quantity(&about, Dimension::Stiffness),
                Form::Stress => given_quantity(&about, Dimension::Stress),
                Form::Density => given_quantity(&about, Dimension::Density),
                Form::Ratio => given_ratio(&about),
                Form::Modes => slot(
                    Slot::Modes,
                    one_or_more(
                        "Number of modes, or one number a side",
                        count("Number of modes", "modes", 0, MOST_MODES),
                    ),
                ),
                Form::Word(words) => given(Takes { quantity: None, readings: words }, one_of_words(&about, words)),
            };
            let value = if field.swept { swept_or(value) } else { value };
            match field.form {
                Form::Word(_) => object.optional(field.key, value),
                _ => object.required(field.key, value),
            }
        })
        .schema()
}

fn coordinate() -> Value {
    any_of(
        "A share of the side, 0 to 1, or a length",
        vec![between("A share of the side", 0.0, 1.0), quantity("A length", Dimension::Length), word("swept")],
    )
}

fn place() -> Value {
    let both = json!({"type": "array", "items": coordinate(), "minItems": 2, "maxItems": 2});
    let listed = assumed(Takes { quantity: Some(Quantity::Places), readings: &[] });
    any_of(
        "A place: one coordinate on a beam, [x, y] on a plate, or those of an assumption",
        vec![coordinate(), both, listed],
    )
}

fn damper() -> Value {
    let length = |about| quantity(about, Dimension::Length);
    let gap_words = [word("infinite"), word("optimised")];
    let mut ratios = vec![given_ratio("h′ = h ωn²/g"), word("swept"), list("One a damper of the array", ratio("h′"))];
    ratios.extend(gap_words.clone());
    let filled = Object::new("An array filled in one of two ways, which a sweep chooses")
        .required("uniform", given_quantity("The gap of all", Dimension::Length))
        .required("optimised", list("One a damper", length("A gap")));
    let mut gaps = vec![
        given_quantity("Gap clearance", Dimension::Length),
        list("One a damper of the array", length("A gap")),
        filled.schema(),
    ];
    gaps.extend(gap_words);
    let share = swept_or(given_ratio("Particle over the whole damper, mass"));
    Object::new("A particle impact damper")
        .optional("at", reference("place"))
        .optional("array", array())
        .exactly_one(vec![
            ("mass_ratio", swept_or(given_ratio("m′: mass of the damper over that of the structure"))),
            ("mass", given_quantity("Mass of the damper", Dimension::Mass)),
        ])
        .optional("mass_reading", swept_or(slot(Slot::MassReading, mass_reading())))
        .optional("massless_ratio", slot(Slot::MasslessRatio, ratio(Slot::MasslessRatio.about())))
        .optional("gap_frequency", reading(Slot::GapFrequency))
        .optional("particle_share", share)
        .exactly_one(vec![
            ("gap_ratio", any_of("h′: dimensionless gap clearance", ratios)),
            ("gap", any_of("Gap clearance between floor and ceiling", gaps)),
        ])
        .required("floor", reference("surface"))
        .optional("ceiling", reference("surface"))
        .optional("stop", stop())
        .optional("walls", walls())
        .schema()
}

fn mass_reading() -> Value {
    let about = Slot::MassReading.about();
    any_of(
        about,
        vec![one_of_words(about, Slot::MassReading.takes().readings), ratio("A share of the structure's mass")],
    )
}

fn array() -> Value {
    let dampers = count("Number of dampers", "dampers", 1, MOST_DAMPERS as u32);
    Object::new("Dampers side by side")
        .required("count", swept_or(one_or_more("Number of dampers, or one number a side", dampers)))
        .required("spacing", one_or_more("From one to the next", quantity("Spacing", Dimension::Length)))
        .optional("centred", boolean("Around the place, rather than from there on"))
        .optional("margin", slot(Slot::Margin, quantity("Kept free at the edge", Dimension::Length)))
        .optional("order", reading(Slot::Order))
        .schema()
}

fn restitution() -> Value {
    between("Coefficient of restitution, 0 to 1", 0.0, 1.0)
}

fn surface() -> Value {
    let rigid = Object::new("A rigid surface").required("restitution", given(Takes::ratio(), restitution())).schema();
    let stiffness = vec![
        quantity("Stiffness", Dimension::Stiffness),
        one_of_words("Tuned to the structure or not", &["tuned", "clean", "loaded", "untuned", "swept"]),
    ];
    let damping = vec![given_quantity("Damping", Dimension::Damping), word("equivalent_viscous")];
    let resilient = Object::new("A resilient surface")
        .exactly_one(vec![
            (
                "stiffness_ratio",
                slot(Slot::StiffnessRatio, swept_or(ratio("kf/ks: stiffness over that of the structure"))),
            ),
            ("stiffness", slot(Slot::Stiffness, any_of("Stiffness", stiffness))),
        ])
        .exactly_one(vec![
            ("damping_ratio", slot(Slot::DampingRatio, swept_or(ratio("Damping ratio under the particle")))),
            ("damping", any_of("Damping", damping)),
        ])
        .optional(
            "untuned_frequency_ratio",
            slot(Slot::UntunedFrequencyRatio, ratio(Slot::UntunedFrequencyRatio.about())),
        )
        .optional("damping_curve", slot(Slot::DampingCurve, curve()))
        .optional("no_tension", boolean("The surface does not pull at a particle that leaves it"))
        .schema();
    Object::new("A surface that the particle lands on")
        .exactly_one(vec![("rigid", rigid), ("resilient", resilient)])
        .schema()
}

fn stop() -> Value {
    let stop = Object::new("A limit stop")
        .required("length", slot(Slot::StopLength, swept_or(quantity("Length of the limit stop", Dimension::Length))))
        .optional("restitution", slot(Slot::StopRestitution, restitution()))
        .schema();
    any_of("A limit stop", vec![stop, word("assumed")])
}

fn walls() -> Value {
    Object::new("Soft walls")
        .required("stiffness_ratio", swept_or(given_ratio("kw/ks: stiffness over that of the structure")))
        .required("damping", given_quantity("Damping of the walls", Dimension::Damping))
        .optional(
            "ceiling_mass_ratio",
            slot(Slot::CeilingMassRatio, ratio("Mass of the ceiling over that of the base")),
        )
        .schema()
}

fn excitation() -> Value {
    let impulses = |about: &str| {
        Object::new(about)
            .optional("at", reference("place"))
            .exactly_one(vec![
                ("force_ratio", swept_or(given_ratio("f′ = F/(m g)"))),
                ("impulse", slot(Slot::Impulse, swept_or(quantity("Impulse", Dimension::Impulse)))),
            ])
            .optional("impulse_time", impulse_time())
            .optional("frequency_reference", reading(Slot::FrequencyReference))
    };
    let harmonic = Object::new("A harmonic force")
        .optional("at", reference("place"))
        .exactly_one(vec![
            ("force_ratio", swept_or(given_ratio("f′ = F/(m g)"))),
            ("base_amplitude_ratio", swept_or(given_ratio("a ω²/g"))),
            ("force", slot(Slot::Force, swept_or(quantity("Force", Dimension::Force)))),
        ])
        .optional("frequency_reference", reading(Slot::HarmonicReference))
        .exactly_one(timing());
    let single =
        timing().into_iter().fold(impulses("One impulse"), |object, (key, schema)| object.optional(key, schema));
    let pulses = impulses("Pulses of finite duration")
        .exactly_one(timing())
        .required("duration", swept_or(given_quantity("Duration of a pulse", Dimension::Time)))
        .required("shape", one_of_words("Shape of a pulse", &["rectangular", "binomial"]));
    let forms = Object::new("What drives the structure").exactly_one(vec![
        (
            "single_impulse",
            single.exclusive(&["frequency_ratio", "period", "angular_frequency", "forced_mode"]).schema(),
        ),
        ("impulse_train", impulses("Impulses one period apart").exactly_one(timing()).schema()),
        ("harmonic", harmonic.schema()),
        ("pulse_train", pulses.schema()),
    ]);
    let cycle = Object::new("Nothing, and the cycle that time is counted in")
        .required("period", quantity("Period", Dimension::Time))
        .schema();
    let nothing = form("none", "Nothing drives it", cycle);
    any_of("What drives the structure", vec![forms.schema(), word("none"), nothing])
}

fn timing() -> Vec<(&'static str, Value)> {
    vec![
        ("frequency_ratio", swept_or(given_ratio("ω′ = ω/ωn"))),
        ("period", given_quantity("Period", Dimension::Time)),
        ("angular_frequency", swept_or(given_quantity("Angular frequency", Dimension::AngularFrequency))),
        ("forced_mode", swept_or(count("Number of the natural frequency that is forced", "", 0, 100_000))),
    ]
}

fn impulse_time() -> Value {
    let about = Slot::ImpulseTime.about();
    let factor = Object::new("A factor over an angular frequency")
        .required("factor", slot(Slot::ImpulseFactor, ratio(Slot::ImpulseFactor.about())))
        .optional("frequency", reading(Slot::ImpulseFrequency));
    let readings = one_of_words(about, Slot::ImpulseTime.takes().readings);
    slot(Slot::ImpulseTime, any_of(about, vec![readings, quantity("A time", Dimension::Time), factor.schema()]))
}

fn start() -> Value {
    let velocity = |about| quantity(about, Dimension::Velocity);
    let particle = Object::new("A particle in flight")
        .required("height", quantity("Height over its floor", Dimension::Length))
        .required("velocity", velocity("Velocity relative to its floor"))
        .schema();
    let particle = any_of("A particle", vec![particle, word("on_floor")]);
    Object::new("Initial conditions; static equilibrium without them")
        .optional("displacement", quantity("Displacement of the mass", Dimension::Length))
        .optional("velocity", velocity("Velocity of the mass"))
        .optional("particles", list("One a damper", particle))
        .schema()
}

fn observe() -> Value {
    let take = reading(Slot::Take);
    let points = Object::new("Several points")
        .required("points", list("The points", reference("place")))
        .optional("take", take.clone());
    let grid = form("nine_point_grid", "Nine points spread over a plate", take);
    any_of("Where the motion is observed", vec![reference("place"), word("nine_point_grid"), grid, points.schema()])
}
