//! Attributes of a group in an SVG: the axes, names and numbers of what it shows, from which a page reads the value under the
//! pointer. A picture alone ignores them.

use std::fmt;

use super::axis::Axis;
use super::geometry::Rect;
use super::shortest::shortest;

/// Attributes of a group.
#[derive(Debug, Clone, Default)]
pub(super) struct Attributes(String);

/// An axis with its label.
#[derive(Clone, Copy)]
pub(super) struct Labelled<'a> {
    pub axis: &'a Axis,
    pub label: &'a str,
}

impl Attributes {
    /// What a curve is called.
    pub(super) fn name(name: &str) -> Self {
        Self::default().with("name", name)
    }

    /// All there is to say of something.
    pub(super) fn note(text: &str) -> Self {
        Self::default().with("note", text)
    }

    /// A frame with its axes; `units` of the SVG are a pixel.
    pub(super) fn frame(frame: &Rect, units: f64, x: Labelled<'_>, y: Labelled<'_>) -> Self {
        let edges = [frame.left, frame.top, frame.right, frame.bottom].map(|edge| format!("{:.0}", edge * units));
        Self::default()
            .with("frame", &edges.join(" "))
            .with("x", &x.axis.in_words())
            .with("x-label", x.label)
            .with("y", &y.axis.in_words())
            .with("y-label", y.label)
    }

    /// With a list of numbers to four digits.
    pub(super) fn with_numbers(self, name: &str, numbers: impl IntoIterator<Item = f64>) -> Self {
        self.with(name, &numbers.into_iter().map(|number| shortest(number, 4)).collect::<Vec<_>>().join(" "))
    }

    pub(super) fn with(mut self, name: &str, value: &str) -> Self {
        self.0 += &format!(" data-{name}=\"{}\"", escaped(value).replace('"', "&quot;"));
        self
    }
}

impl fmt::Display for Attributes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Text within an element.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
