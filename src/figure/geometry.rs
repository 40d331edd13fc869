//! Points and rectangles in pixels of the finished picture; y grows downwards.

/// A place on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
}

/// An upright rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Rect {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// The place at these fractions of the width (from the left) and height (from the bottom).
    pub(super) fn at(&self, across: f64, up: f64) -> Point {
        Point { x: self.left + across * self.width(), y: self.bottom - up * self.height() }
    }

    /// Grown by `margin` on every side.
    pub(super) fn grown(&self, margin: f64) -> Self {
        Self {
            left: self.left - margin,
            top: self.top - margin,
            right: self.right + margin,
            bottom: self.bottom + margin,
        }
    }

    /// True if the two overlap.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    /// True if some of the straight stretch from `a` to `b` lies inside (Liang and Barsky's clipping).
    pub(super) fn meets(&self, a: Point, b: Point) -> bool {
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let sides = [(-dx, a.x - self.left), (dx, self.right - a.x), (-dy, a.y - self.top), (dy, self.bottom - a.y)];
        for (towards, room) in sides {
            if towards == 0.0 {
                if room < 0.0 {
                    return false;
                }
            } else if towards < 0.0 {
                enter = enter.max(room / towards);
            } else {
                leave = leave.min(room / towards);
            }
        }
        enter <= leave
    }
}

/// A polyline cut into the drawn stretches of a dash pattern (lengths drawn and left out, by turns); empty is solid.
pub(super) fn dashed(points: &[Point], pattern: &[f64]) -> Vec<Vec<Point>> {
    let Some(&first) = pattern.first() else { return vec![points.to_vec()] };
    let mut stretches = Vec::new();
    let mut current: Vec<Point> = points.first().copied().into_iter().collect();
    let (mut phase, mut left) = (0, first);
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = libm::hypot(b.x - a.x, b.y - a.y);
        let mut gone = 0.0;
        while length - gone > left {
            gone += left;
            let share = gone / length;
            let here = Point { x: a.x + share * (b.x - a.x), y: a.y + share * (b.y - a.y) };
            if phase % 2 == 0 {
                current.push(here);
                stretches.push(std::mem::take(&mut current));
            } else {
                current = vec![here];
            }
            phase = (phase + 1) % pattern.len();
            left = pattern[phase];
        }
        left -= length - gone;
        if phase % 2 == 0 {
            current.push(b);
        }
    }
    if current.len() > 1 {
        stretches.push(current);
    }
    stretches
}
