//! What legends and labels must not cover, and where there is room beside it.

use super::geometry::{Point, Rect};

/// What a legend or a label must not cover.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Obstacles {
    pub lines: Vec<Vec<Point>>,
    pub boxes: Vec<Rect>,
}

impl Obstacles {
    /// True if nothing lies in this place.
    pub(super) fn leave_free(&self, place: &Rect) -> bool {
        self.leave_boxes_free(place)
            && !self.lines.iter().any(|line| {
                line.windows(2).any(|pair| place.meets(pair[0], pair[1]))
                    || matches!(line.as_slice(), [one] if place.meets(*one, *one))
            })
    }

    /// True if no box lies in this place; lines may.
    fn leave_boxes_free(&self, place: &Rect) -> bool {
        !self.boxes.iter().any(|taken| taken.overlaps(place))
    }

    /// Of these places the first with nothing in it, `room` around it being left; else the one that covers least of lines, over which a
    /// label can be read as it cannot over another one.
    pub(super) fn clearest<'p>(&self, places: impl Iterator<Item = &'p Rect>, room: f64) -> Option<&'p Rect> {
        let mut clearest: Option<(f64, &Rect)> = None;
        for place in places {
            let roomy = place.grown(room);
            if self.leave_free(&roomy) {
                return Some(place);
            }
            if !self.leave_boxes_free(&roomy) {
                continue;
            }
            let covered = self.covered(place);
            if clearest.is_none_or(|(least, _)| covered < least) {
                clearest = Some((covered, place));
            }
        }
        clearest.map(|(_, place)| place)
    }

    /// The length of lines in this place, in pixels.
    fn covered(&self, place: &Rect) -> f64 {
        let stretches = self.lines.iter().flat_map(|line| line.windows(2));
        let within = |pair: &[Point]| {
            let length = libm::hypot(pair[1].x - pair[0].x, pair[1].y - pair[0].y);
            place.share_within(pair[0], pair[1]).unwrap_or(0.0) * length
        };
        stretches.map(within).sum()
    }
}
