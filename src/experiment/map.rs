//! The `map` of a figure: two columns for the place, one for the colour.

use super::columns::Role;
use super::figure::{FigureReader, column_name};
use super::figure_spec::{Best, MapSpec, Mark};
use crate::yaml::At;

impl FigureReader<'_> {
    /// `{x: damper_x, y: damper_y, value: velocity_ratio, by: sweep, mark: {x: force_x, y: force_y, label: force}}`.
    pub(super) fn map(&self, at: At<'_>) -> Option<Box<MapSpec>> {
        let keys = at.keys("a map")?;
        let x = keys.required("x", "What runs along the x axis", |at| self.axis(at));
        let y = keys.required("y", "What runs along the y axis", |at| self.axis(at));
        let value = keys.required("value", "What the colours show", |at| self.axis(at));
        let by = keys.optional("by", "A panel for each", |at| at.one_or_more(|at| self.split(at)));
        let mark = keys.optional("mark", "A place that is marked", |at| self.mark(at));
        let best = "The place to mark and to name";
        let best = keys.optional("best", best, |at| at.word::<Best>("place to mark"));
        let centre = keys.optional("centre", "The value of the middle of the colours", |at| at.number());
        let aspect = keys.optional("aspect", "Height of a panel over its width", |at| {
            at.within([0.1, 10.0], "an aspect is the height of a panel over its width, 0.1 to 10")
        });
        let columns = keys.optional("columns", "Panels side by side", |at| {
            at.count_from(1, "panels", 6, "a map has one column of panels at least")
        });
        keys.close()?;
        let ((x, x_role), (y, y_role), (value, value_role)) = (x?, y?, value?);
        let lists = |role: Option<Role>| role.map(|role| matches!(role, Role::History | Role::Cloud));
        for (axis, role) in [(&y, y_role), (&value, value_role)] {
            if let (Some(one), Some(other)) = (lists(x_role), lists(role))
                && one != other
            {
                let (a, b) = (&x.column, &axis.column);
                return at.wrong(format!("`{a}` and `{b}` make no map: one holds a number a row, the other a list"));
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

    fn mark(&self, at: At<'_>) -> Option<Mark> {
        let keys = at.keys("a mark")?;
        let column = |at: At<'_>| {
            let (name, span) = column_name(at)?;
            self.column(&name, span, |role| role == Role::Number)?;
            Some(name)
        };
        let x = keys.required("x", "Its place along the x axis", column);
        let y = keys.required("y", "Its place along the y axis", column);
        let label = keys.required("label", "What is there", |at| at.text());
        keys.close()?;
        Some(Mark { x: x?, y: y?, label: label? })
    }
}
