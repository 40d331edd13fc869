//! Places in a scene: where dampers sit, where the force acts, where the motion is observed; and arrays of dampers.

use serde_json::json;

use super::damper::MOST_DAMPERS;
use super::recipe::{
    ArrayRecipe, AssumptionName, AssumptionValue, Coordinate, Given, ObserveRecipe, Parameter, PlaceRecipe,
    PointsRecipe, Quantity, Slot, Takes,
};
use super::scene_reader::{AT, SceneReader};
use crate::scene::{Kind, Take};
use crate::yaml::reader::number;
use crate::yaml::schema::between;
use crate::yaml::{At, Dimension, Keys, Node, Value};

impl SceneReader<'_> {
    /// One coordinate a side; `along` are the parameters that may stand for them.
    pub(super) fn place(&self, at: At<'_>, kind: &Kind, along: [Parameter; 2]) -> Option<PlaceRecipe> {
        let about = "A place: one coordinate on a beam, [x, y] on a plate, or those of an assumption";
        at.named("place", about, |at| {
            let takes = Takes { quantity: Some(Quantity::Places), readings: &[] };
            if let Some(name) = self.assumption(at, takes, || "`at`".into()) {
                return self.listed(at, &name?, kind);
            }
            let coordinate = |at: At<'_>, parameter: Parameter| {
                if self.is_swept(at, parameter) { Some(Coordinate::Share(0.5)) } else { coordinate(at) }
            };
            let one = |at: At<'_>| Some(PlaceRecipe(vec![coordinate(at, along[0])?]));
            at.either(
                |_| kind.sides.len() < 2,
                one,
                |at| {
                    at.form(
                        |node, findings| match &node.value {
                            Value::Sequence(items) if items.len() == 2 => {
                                let [x, y] = [0, 1].map(|i| coordinate(At::Node(&items[i], findings), along[i]));
                                Some(PlaceRecipe(vec![x?, y?]))
                            }
                            _ => findings.report(
                                node.span,
                                format!("a place on {} is two coordinates", kind.what),
                                Some("write [0.25, 0.5], or lengths with units".into()),
                            ),
                        },
                        |it| {
                            let item = it.part(it.about(), |at| coordinate(at, along[0]));
                            json!({"type": "array", "items": item, "minItems": 2, "maxItems": 2})
                        },
                    )
                },
            )
        })
    }

    /// The place that the assumption names, or one of those that it lists.
    fn listed(&self, at: At<'_>, name: &AssumptionName, kind: &Kind) -> Option<PlaceRecipe> {
        let Some(AssumptionValue::Places(places)) = self.assumptions.values.get(name) else { return None };
        let (sides, given) = (kind.sides.len(), places.first().map_or(0, Vec::len));
        if given != sides {
            let message =
                format!("a place on {} has {sides} coordinates, and those of `{name}` have {given}", kind.what);
            return at.wrong(message);
        }
        if places.len() > 1 {
            self.swept.borrow_mut().push((Parameter::Place, at.span()));
        }
        Some(PlaceRecipe::listed(name, sides))
    }

    /// The place under `at`: there must be one, except on a single mass, where there must be none.
    pub(super) fn at(&self, keys: &Keys<'_>, kind: &Kind, along: [Parameter; 2]) -> Option<PlaceRecipe> {
        let place = |at: At<'_>| self.place(at, kind, along);
        keys.required_where(
            !kind.sides.is_empty(),
            AT,
            "Where on the structure; on a plate x along its width and y along its length",
            place,
        )
        .map(Option::unwrap_or_default)
    }

    /// Where the motion is observed unless the file says so.
    pub(super) fn usual_observation(&self, kind: &'static Kind) -> ObserveRecipe {
        ObserveRecipe { points: PointsRecipe::Usual, take: self.left_out(Slot::Take, kind, Take::Largest) }
    }

    pub(super) fn observe(&self, at: At<'_>, kind: &'static Kind) -> Option<ObserveRecipe> {
        // Observed points are not swept.
        let point = |at: At<'_>| match at {
            At::Node(node, _) if says_swept(node) => at.wrong("observed points cannot be swept"),
            _ => self.place(at, kind, [Parameter::DamperX, Parameter::DamperY]),
        };
        let one = |at: At<'_>| {
            let points = PointsRecipe::Points(vec![point(at)?]);
            Some(ObserveRecipe { points, take: Given::Stated(Take::Largest) })
        };
        let take = |at: At<'_>| self.reading::<Take>(at, Slot::Take, kind);
        let usual = || self.left_out(Slot::Take, kind, Take::Largest);
        let several = |at: At<'_>| {
            let keys = at.keys("what is observed")?;
            let points = keys.required("points", "The points", |at| at.list(point));
            let take = keys.optional("take", Slot::Take.about(), take);
            keys.close()?;
            Some(ObserveRecipe { points: PointsRecipe::Points(points?), take: take?.unwrap_or_else(usual) })
        };
        let grid = |at: At<'_>| {
            at.choose("what is observed", &[("nine_point_grid", Slot::Take.about())], |choice| {
                let take = choice.content().map_or_else(|| Some(usual()), take)?;
                Some(ObserveRecipe { points: PointsRecipe::NinePointGrid, take })
            })
        };
        let names_points = |value: &Value| matches!(value, Value::Mapping(entries) if entries.iter().any(|entry| entry.key == "points"));
        at.either(|value| !matches!(value, Value::Mapping(_)), one, |at| at.either(names_points, several, grid))
    }

    pub(super) fn array(&self, at: At<'_>, kind: &'static Kind) -> Option<ArrayRecipe> {
        let keys = at.keys("an array of dampers")?;
        let count = keys.required("count", "Number of dampers, or one number a side", |at| {
            if self.is_swept(at, Parameter::DamperCount) {
                return Some(vec![1]);
            }
            let most = MOST_DAMPERS as u32;
            at.one_or_more(|at| at.count_from(1, "dampers", most, "an array has one damper at least"))
        });
        let spacing =
            keys.required("spacing", "From one to the next", |at| at.one_or_more(|at| at.quantity(Dimension::Length)));
        let centred = keys.optional("centred", "Around the place, rather than from there on", |at| at.boolean());
        let margin = keys.optional("margin", "Kept free at the edge", |at| {
            self.slot(at, Slot::Margin, kind, |at| at.quantity(Dimension::Length))
        });
        let order = keys.optional("order", Slot::Order.about(), |at| self.reading(at, Slot::Order, kind));
        keys.close()?;
        // A plate's array lies around its place, a beam's begins there.
        let usual = kind.sides.len() > 1;
        Some(ArrayRecipe {
            count: count?,
            spacing: spacing?,
            centred: centred?.unwrap_or(usual),
            margin: margin?,
            order: order?,
        })
    }
}

/// A coordinate of this place says `swept`.
fn says_swept(place: &Node) -> bool {
    match &place.value {
        Value::Sequence(items) => items.iter().any(says_swept),
        value => value.is_swept(),
    }
}

/// `0.25`, a share of the side, or `20 cm`.
fn coordinate(at: At<'_>) -> Option<Coordinate> {
    let has_unit =
        |value: &Value| matches!(value, Value::Scalar(text) if text.trim_end().ends_with(|c: char| c.is_alphabetic()));
    let length = |at: At<'_>| at.quantity(Dimension::Length).map(Coordinate::Length);
    at.called("A share of the side, 0 to 1, or a length", |at| {
        at.either(has_unit, length, |at| {
            at.form(
                |node, findings| {
                    let share = number(node, findings)?;
                    if (0.0..=1.0).contains(&share) {
                        return Some(Coordinate::Share(share));
                    }
                    let message = format!(
                        "{share} is a place outside the structure: a number without unit is a share of the side, 0 to 1"
                    );
                    findings.report(node.span, message, Some("write for example 0.5, or 20 cm".into()))
                },
                |_| between("A share of the side", 0.0, 1.0),
            )
        })
    })
}
