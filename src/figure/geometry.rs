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

    /// The corners, around.
    pub(super) fn corners(&self) -> [Point; 4] {
        [self.at(0.0, 0.0), self.at(0.0, 1.0), self.at(1.0, 1.0), self.at(1.0, 0.0)]
    }

    /// True if all of it lies inside `frame`.
    pub(super) fn lies_within(&self, frame: &Self) -> bool {
        self.left >= frame.left && self.right <= frame.right && self.top >= frame.top && self.bottom <= frame.bottom
    }

    /// True if the two overlap.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    /// True if some of the straight stretch from `a` to `b` lies inside.
    pub(super) fn meets(&self, a: Point, b: Point) -> bool {
        self.share_within(a, b).is_some()
    }

    /// How much of the straight stretch from `a` to `b` lies inside, if any does (Liang and Barsky's clipping).
    pub(super) fn share_within(&self, a: Point, b: Point) -> Option<f64> {
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let sides = [(-dx, a.x - self.left), (dx, self.right - a.x), (-dy, a.y - self.top), (dy, self.bottom - a.y)];
        for (towards, room) in sides {
            if towards == 0.0 {
                if room < 0.0 {
                    return None;
                }
            } else if towards < 0.0 {
                enter = enter.max(room / towards);
            } else {
                leave = leave.min(room / towards);
            }
        }
        (enter <= leave).then_some(leave - enter)
    }
}

/// The fewest of these points whose polyline stays within `deviation` of all of them (Ramer, Douglas and Peucker).
pub(super) fn simplified(points: &[Point], deviation: f64) -> Vec<Point> {
    let [first, _, ..] = points else { return points.to_vec() };
    let mut kept = vec![*first];
    // What lies between the last point kept and this one is settled when it leaves the stack.
    let mut stretches = vec![(0, points.len() - 1)];
    while let Some((from, to)) = stretches.pop() {
        let (a, b) = (points[from], points[to]);
        let off = |at: usize| distance(points[at], a, b);
        let farthest = (from + 1..to).max_by(|&i, &j| off(i).total_cmp(&off(j)));
        match farthest {
            Some(at) if off(at) > deviation => stretches.extend([(at, to), (from, at)]),
            _ => kept.push(b),
        }
    }
    kept
}

/// How far a point is from the straight stretch between two others.
fn distance(point: Point, a: Point, b: Point) -> f64 {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let length = dx * dx + dy * dy;
    let along =
        if length > 0.0 { (((point.x - a.x) * dx + (point.y - a.y) * dy) / length).clamp(0.0, 1.0) } else { 0.0 };
    libm::hypot(point.x - a.x - along * dx, point.y - a.y - along * dy)
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
