//! A sheet to draw on, in pixels of the finished picture: plotters on [`super::backend`].
//!
//! Coordinates are whole tenths of a pixel, and paths are relative: a point of a curve takes about six bytes. Points that
//! would not move a line by a tenth of a pixel are left out.

use std::cell::RefCell;
use std::fmt::{self, Write as _};
use std::rc::Rc;
use std::sync::LazyLock;

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, Drawable, PointCollection, Polygon, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, ShapeStyle};
use ttf_parser::Face;

use super::backend::{Writer, relative};
use super::geometry::{Point, Rect, dashed, simplified};
use super::raster::{FAMILY, FONT};
use super::style::{Color, PAPER};

/// Units of the SVG in a pixel of the picture.
pub(super) const UNITS: f64 = 10.0;
/// How far a line may be from the points that it stands for, in pixels.
const DEVIATION: f64 = 0.1;
/// Width of the edge of letters over lines, half of it outside them, in pixels.
const EDGE: f64 = 8.0;
/// Where the baseline has to lie for digits and capitals to be centred on their place, in em.
const CENTRE: f64 = 0.365;
/// Families with glyphs about as wide, for where the first is not installed.
const FALLBACK: &str = "Verdana, sans-serif";

static FACE: LazyLock<Option<Face<'static>>> = LazyLock::new(|| Face::parse(FONT, 0).ok());

/// A line's pen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pen {
    pub color: Color,
    pub width: f64,
    pub dash: &'static [f64],
}

impl Pen {
    pub(super) fn solid(color: Color, width: f64) -> Self {
        Self { color, width, dash: &[] }
    }
}

/// Which side of a text its place is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Left,
    Centre,
    Right,
}

/// A text, vertically centred on its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lettering<'a> {
    pub text: &'a str,
    pub size: f64,
    pub anchor: Anchor,
    /// Reads from bottom to top.
    pub upright: bool,
    pub color: Color,
}

/// A sheet of paper.
pub(super) struct Sheet {
    area: DrawingArea<Writer, Shift>,
    /// The SVG so far.
    text: Rc<RefCell<String>>,
}

/// Paints on a white sheet of this size; returns the SVG.
pub(super) fn svg(width: f64, height: f64, paint: impl FnOnce(&Sheet)) -> String {
    let [wide, high] = [width, height].map(|length| whole(length).unsigned_abs());
    let text = Rc::new(RefCell::new(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {wide} {high}\" font-family=\"{FAMILY}, {FALLBACK}\" stroke-linejoin=\"round\">\n"
    )));
    let area = Writer { size: (wide, high), text: Rc::clone(&text) }.into_drawing_area();
    let sheet = Sheet { area, text: Rc::clone(&text) };
    sheet.cell(&Rect { left: 0.0, top: 0.0, right: width, bottom: height }, PAPER);
    paint(&sheet);
    drop(sheet);
    text.take() + "</svg>\n"
}

/// Width of a text in pixels of the picture.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let Some(face) = FACE.as_ref() else { return 0.0 };
    let advance = |letter: char| face.glyph_index(letter).and_then(|glyph| face.glyph_hor_advance(glyph)).unwrap_or(0);
    let units: u32 = text.chars().map(|letter| u32::from(advance(letter))).sum();
    f64::from(units) / f64::from(face.units_per_em()) * size
}

/// A text broken between words into lines of at most this width; a single word may be wider.
pub(super) fn wrapped(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

impl Sheet {
    /// What is painted as one group with these attributes.
    pub(super) fn group(&self, attributes: &impl fmt::Display, paint: impl FnOnce()) {
        self.text.borrow_mut().push_str(&format!("<g{attributes}>\n"));
        paint();
        self.text.borrow_mut().push_str("</g>\n");
    }

    /// A polyline.
    pub(super) fn line(&self, points: &[Point], pen: Pen) {
        let points = simplified(points, DEVIATION);
        if points.len() < 2 {
            return;
        }
        // One path for all dashes: a path each would take most of the file.
        let d: String = dashed(&points, pen.dash).iter().map(|stretch| relative(places(stretch))).collect();
        self.path(&d, pen, "");
    }

    /// A filled polygon.
    pub(super) fn fill(&self, corners: &[Point], color: Color, opacity: f64) {
        self.put(&Polygon::new(places(&simplified(corners, DEVIATION)), rgb(color).mix(opacity).filled()));
    }

    /// A filled rectangle whose edges meet its neighbours' without a seam.
    pub(super) fn cell(&self, place: &Rect, color: Color) {
        let corners = [(whole(place.left), whole(place.top)), (whole(place.right), whole(place.bottom))];
        self.put(&Rectangle::new(corners, rgb(color).filled()));
    }

    /// As [`Sheet::cell`], of one colour.
    pub(super) fn cells(&self, places: &[Rect], color: Color) {
        places.iter().for_each(|place| self.cell(place, color));
    }

    /// A filled disc.
    pub(super) fn disc(&self, centre: Point, radius: f64, color: Color) {
        self.put(&Circle::new(place(centre), whole(radius), rgb(color).filled()));
    }

    /// Dots as wide as the pen, thousands of them as one path.
    pub(super) fn dots(&self, centres: &[Point], pen: Pen) {
        let mut d = String::new();
        for (x, y) in places(centres) {
            // A line of a tenth of a pixel with round ends.
            _ = write!(d, "M{x} {y}h1");
        }
        self.path(&d, pen, " stroke-linecap=\"round\"");
    }

    /// Straight strokes, hundreds of them as one path.
    pub(super) fn strokes(&self, strokes: &[[Point; 2]], pen: Pen) {
        let mut d = String::new();
        for [(x, y), (to_x, to_y)] in strokes.iter().map(|ends| ends.map(place)) {
            _ = write!(d, "M{x} {y}l{} {}", to_x - x, to_y - y);
        }
        self.path(&d, pen, "");
    }

    fn path(&self, d: &str, pen: Pen, more: &str) {
        let (color, width) = (pen.color, whole(pen.width));
        _ = writeln!(
            self.text.borrow_mut(),
            "<path fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\"{more} d=\"{d}\"/>"
        );
    }

    /// A circle.
    pub(super) fn ring(&self, centre: Point, radius: f64, pen: Pen) {
        self.put(&Circle::new(place(centre), whole(radius), pen.style()));
    }

    /// A text.
    pub(super) fn text(&self, at: Point, lettering: &Lettering<'_>) {
        let Lettering { text, size, anchor, upright, color } = *lettering;
        let down = CENTRE * size;
        let (at, turn) = if upright {
            (Point { x: at.x + down, ..at }, FontTransform::Rotate270)
        } else {
            (Point { y: at.y + down, ..at }, FontTransform::None)
        };
        let h_pos = match anchor {
            Anchor::Left => HPos::Left,
            Anchor::Centre => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        let font = FontDesc::new(FontFamily::Name(FAMILY), f64::from(whole(size)), FontStyle::Normal).transform(turn);
        let mut style = font.color(&rgb(color));
        style.pos = Pos::new(h_pos, VPos::Bottom);
        self.put(&Text::new(text, place(at), style));
    }

    /// A text whose letters are edged with paper, so that it can be read over curves, and they beside it.
    pub(super) fn text_over_lines(&self, at: Point, lettering: &Lettering<'_>) {
        let edge = whole(EDGE);
        let edged = format_args!(" stroke=\"{PAPER}\" stroke-width=\"{edge}\" paint-order=\"stroke\"");
        self.group(&edged, || self.text(at, lettering));
    }

    fn put<'b, E>(&self, element: &'b E)
    where
        &'b E: PointCollection<'b, (i32, i32)>,
        E: Drawable<Writer>,
    {
        let drawn = self.area.draw(element);
        debug_assert!(drawn.is_ok(), "writing into memory cannot fail");
    }
}

impl Pen {
    fn style(self) -> ShapeStyle {
        let stroke_width = whole(self.width).unsigned_abs();
        ShapeStyle { color: rgb(self.color).to_rgba(), filled: false, stroke_width }
    }
}

fn rgb(color: Color) -> RGBColor {
    RGBColor(color.0, color.1, color.2)
}

fn places(points: &[Point]) -> Vec<(i32, i32)> {
    points.iter().copied().map(place).collect()
}

fn place(point: Point) -> (i32, i32) {
    (whole(point.x), whole(point.y))
}

/// Pixels of the picture to units of the SVG.
#[expect(clippy::cast_possible_truncation, reason = "a cast saturates, and a sheet is some 10 000 units wide")]
fn whole(length: f64) -> i32 {
    (length * UNITS).round() as i32
}
