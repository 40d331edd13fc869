//! The `map` of a figure: two columns for the place, one for the colour.

use super::columns::Role;
use super::definition::{Best, MapSpec, Mark};
use super::figure::FigureReader;
use super::reader::{Fields, count, number, one_or_more, scalar, text, word};
use super::yaml::Node;

impl<'t> FigureReader<'t> {
    /// `{x: damper_x, y: damper_y, value: velocity_ratio, by: sweep, mark: {x: force_x, y: force_y, label: force}}`.
    pub(super) fn map(&self, node: &'t Node) -> Option<Box<MapSpec>> {
        let fields = Fields::open(node, "a map", self.findings)?;
        let x = fields.required("x", |node| self.axis(node));
        let y = fields.required("y", |node| self.axis(node));
        let value = fields.required("value", |node| self.axis(node));
        let by = fields.optional("by", |node| one_or_more(node, self.findings, |node| self.split(node)));
        let mark = fields.optional("mark", |node| self.mark(node));
        let best = fields.optional("best", |node| word::<Best>(node, "place to mark", self.findings));
        let centre = fields.optional("centre", |node| number(node, self.findings));
        let aspect = fields.optional("aspect", |node| {
            let aspect = number(node, self.findings)?;
            if (0.1..=10.0).contains(&aspect) {
                Some(aspect)
            } else {
                self.findings.wrong(node.span, "an aspect is the height of a panel over its width, 0.1 to 10")
            }
        });
        let columns = fields.optional("columns", |node| match count(node, "panels", 6, self.findings)? {
            0 => self.findings.wrong(node.span, "a map has one column of panels at least"),
            columns => Some(columns),
        });
        fields.close()?;
        let ((x, x_role), (y, y_role), (value, value_role)) = (x?, y?, value?);
        let lists = |role: Option<Role>| role.map(|role| matches!(role, Role::History | Role::Cloud));
        for (axis, role) in [(&y, y_role), (&value, value_role)] {
            if let (Some(one), Some(other)) = (lists(x_role), lists(role))
                && one != other
            {
                let (a, b) = (&x.column, &axis.column);
                return self.findings.wrong(
                    node.span,
                    format!("`{a}` and `{b}` make no map: one holds a number a row, the other a list"),
                );
            }
        }
        // A field of lists is a shape: its top is no choice of a place.
        let usual = if lists(x_role) == Some(true) { Best::None } else { Best::Highest };
        Some(Box::new(MapSpec {
            x,
            y,
            value,
            by: by?.unwrap_or_default(),
            mark: mark?,
            best: best?.unwrap_or(usual),
            centre: centre?,
            aspect: aspect?,
            columns: columns?,
        }))
    }

    fn mark(&self, node: &'t Node) -> Option<Mark> {
        let fields = Fields::open(node, "a mark", self.findings)?;
        let column = |node: &'t Node| {
            let name = scalar(node, self.findings)?;
            self.column(name, node.span, |role| role == Role::Number)?;
            Some(name.to_owned())
        };
        let x = fields.required("x", column);
        let y = fields.required("y", column);
        let label = fields.required("label", |node| text(node, self.findings));
        fields.close()?;
        Some(Mark { x: x?, y: y?, label: label? })
    }
}
