//! Places in a scene: where dampers sit, where the force acts, where the motion is observed; and arrays of dampers.

use super::assumption_sheet::{Quantity, Takes};
use super::quantity::Dimension;
use super::reader::{Choice, Fields, boolean, count, list, number, one_or_more, quantity};
use super::recipe::{
    ArrayRecipe, AssumptionValue, Coordinate, Given, ObserveRecipe, Parameter, PlaceRecipe, PointsRecipe, Slot,
};
use super::scene::{MOST_DAMPERS, SceneReader, is_word, names_assumption};
use super::yaml::{Node, Value};
use crate::scene::{Kind, Take};

impl<'t> SceneReader<'t> {
    /// One coordinate a side; `along` are the parameters that may stand for them.
    pub(super) fn place(&self, node: &'t Node, kind: &Kind, along: [Parameter; 2]) -> Option<PlaceRecipe> {
        if names_assumption(node) {
            return self.listed(node, kind);
        }
        let coordinate = |node: &'t Node, parameter: Parameter| {
            if is_word(node, "swept") {
                self.swept.borrow_mut().push((parameter, node.span));
                return Some(Coordinate::Share(0.5));
            }
            self.coordinate(node)
        };
        if kind.sides.len() < 2 {
            return Some(PlaceRecipe(vec![coordinate(node, along[0])?]));
        }
        match &node.value {
            Value::Sequence(items) if items.len() == 2 => {
                let (x, y) = (coordinate(&items[0], along[0]), coordinate(&items[1], along[1]));
                Some(PlaceRecipe(vec![x?, y?]))
            }
            _ => self.findings.report(
                node.span,
                format!("a place on {} is two coordinates", kind.what),
                Some("write [0.25, 0.5], or lengths with units".into()),
            ),
        }
    }

    /// `{assumed: NAME}`: the place that the assumption names, or one of those that it lists.
    fn listed(&self, node: &'t Node, kind: &Kind) -> Option<PlaceRecipe> {
        let takes = Takes { quantity: Some(Quantity::Places), readings: &[] };
        let name = self.named(node, takes, "`at`")?;
        let Some(AssumptionValue::Places(places)) = self.assumptions.values.get(&name) else { return None };
        let (sides, given) = (kind.sides.len(), places.first().map_or(0, Vec::len));
        if given != sides {
            let message =
                format!("a place on {} has {sides} coordinates, and those of `{name}` have {given}", kind.what);
            return self.findings.wrong(node.span, message);
        }
        if places.len() > 1 {
            self.swept.borrow_mut().push((Parameter::Place, node.span));
        }
        Some(PlaceRecipe::listed(&name, sides))
    }

    /// `0.25`, a share of the side, or `20 cm`.
    fn coordinate(&self, node: &'t Node) -> Option<Coordinate> {
        let with_unit =
            matches!(&node.value, Value::Scalar(text) if text.trim_end().ends_with(|c: char| c.is_alphabetic()));
        if with_unit {
            return quantity(node, Dimension::Length, self.findings).map(Coordinate::Length);
        }
        let share = number(node, self.findings)?;
        if (0.0..=1.0).contains(&share) {
            return Some(Coordinate::Share(share));
        }
        self.findings.report(
            node.span,
            format!("{share} is a place outside the structure: a number without unit is a share of the side, 0 to 1"),
            Some("write for example 0.5, or 20 cm".into()),
        )
    }

    /// The place under `at`: there must be one, except on a single mass, where there must be none.
    pub(super) fn at(&self, fields: &Fields<'t>, kind: &Kind, along: [Parameter; 2]) -> Option<PlaceRecipe> {
        if kind.sides.is_empty() {
            return Some(PlaceRecipe::default());
        }
        fields.required("at", |node| self.place(node, kind, along))
    }

    /// Where the motion is observed unless the file says so.
    pub(super) fn usual_observation(&self, kind: &'static Kind) -> ObserveRecipe {
        ObserveRecipe { points: PointsRecipe::Usual, take: self.left_out(Slot::Take, kind, Take::Largest) }
    }

    pub(super) fn observe(&self, node: &'t Node, kind: &'static Kind) -> Option<ObserveRecipe> {
        // Observed points are not swept.
        let point = |node: &'t Node| match node.value {
            _ if is_word(node, "swept") => self.findings.wrong(node.span, "observed points cannot be swept"),
            _ => self.place(node, kind, [Parameter::DamperX, Parameter::DamperY]),
        };
        let Value::Mapping(entries) = &node.value else {
            let points = PointsRecipe::Points(vec![point(node)?]);
            return Some(ObserveRecipe { points, take: Given::Stated(Take::Largest) });
        };
        let take = |node: &'t Node| self.reading::<Take>(node, Slot::Take, kind);
        let usual = || self.left_out(Slot::Take, kind, Take::Largest);
        if entries.iter().any(|entry| entry.key == "points") {
            let fields = Fields::open(node, "what is observed", self.findings)?;
            let points = fields.required("points", |node| list(node, self.findings, point));
            let take = fields.optional("take", take);
            fields.close()?;
            return Some(ObserveRecipe { points: PointsRecipe::Points(points?), take: take?.unwrap_or_else(usual) });
        }
        let choice = Choice::read(node, "what is observed", &["nine_point_grid"], self.findings)?;
        let take = match choice.content {
            Some(node) => take(node)?,
            None => usual(),
        };
        Some(ObserveRecipe { points: PointsRecipe::NinePointGrid, take })
    }

    pub(super) fn array(&self, node: &'t Node, kind: &'static Kind) -> Option<ArrayRecipe> {
        let fields = Fields::open(node, "an array of dampers", self.findings)?;
        let most = MOST_DAMPERS as u32;
        let count = fields.required("count", |node| {
            if is_word(node, "swept") {
                self.swept.borrow_mut().push((Parameter::DamperCount, node.span));
                return Some(vec![1]);
            }
            one_or_more(node, self.findings, |node| match count(node, "dampers", most, self.findings)? {
                0 => self.findings.wrong(node.span, "an array has one damper at least"),
                count => Some(count),
            })
        });
        let spacing = fields.required("spacing", |node| {
            one_or_more(node, self.findings, |node| quantity(node, Dimension::Length, self.findings))
        });
        let centred = fields.optional("centred", |node| boolean(node, self.findings));
        let margin = fields.optional("margin", |node| {
            self.slot(node, Slot::Margin, kind, |node| quantity(node, Dimension::Length, self.findings))
        });
        let order = fields.optional("order", |node| self.reading(node, Slot::Order, kind));
        fields.close()?;
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
