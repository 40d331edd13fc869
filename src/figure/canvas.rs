//! A sheet to draw on, in pixels of the finished picture, which writes SVG.
//!
//! Coordinates are whole tenths of a pixel, and paths are relative: a point of a curve takes about six bytes. Points that
//! would not move a line by a tenth of a pixel are left out.

use std::cell::RefCell;
use std::fmt::Write as _;
use std::sync::LazyLock;

use ttf_parser::Face;

use super::geometry::{Point, Rect, simplified};
use super::raster::{FAMILY, FONT};
use super::style::{Color, PAPER};

/// Units of the SVG in a pixel of the picture.
const UNITS: f64 = 10.0;
/// How far a line may be from the points that it stands for, in pixels.
const DEVIATION: f64 = 0.1;
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
    text: RefCell<String>,
}

/// Paints on a white sheet of this size; returns the SVG.
pub(super) fn svg(width: f64, height: f64, paint: impl FnOnce(&Sheet)) -> String {
    let [wide, high] = [width, height].map(whole);
    let sheet = Sheet {
        text: RefCell::new(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {wide} {high}\" font-family=\"{FAMILY}, {FALLBACK}\" stroke-linejoin=\"round\">\n"
        )),
    };
    sheet.cell(&Rect { left: 0.0, top: 0.0, right: width, bottom: height }, PAPER);
    paint(&sheet);
    sheet.text.into_inner() + "</svg>\n"
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
    /// A polyline.
    pub(super) fn line(&self, points: &[Point], pen: Pen) {
        let points = simplified(points, DEVIATION);
        if points.len() < 2 {
            return;
        }
        let dash = match pen.dash {
            [] => String::new(),
            lengths => {
                let lengths: Vec<String> = lengths.iter().map(|length| whole(*length).to_string()).collect();
                format!(" stroke-dasharray=\"{}\"", lengths.join(" "))
            }
        };
        self.put(format_args!(
            "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{dash} d=\"{}\"/>\n",
            pen.color,
            whole(pen.width),
            path(&points)
        ));
    }

    /// A filled polygon.
    pub(super) fn fill(&self, corners: &[Point], color: Color, opacity: f64) {
        let opacity = if opacity < 1.0 { format!(" fill-opacity=\"{opacity:.2}\"") } else { String::new() };
        let outline = path(&simplified(corners, DEVIATION));
        self.put(format_args!("<path fill=\"{color}\"{opacity} d=\"{outline}z\"/>\n"));
    }

    /// A filled rectangle whose edges meet its neighbours' without a seam.
    pub(super) fn cell(&self, place: &Rect, color: Color) {
        self.cells(std::slice::from_ref(place), color);
    }

    /// As [`Sheet::cell`], of one colour.
    pub(super) fn cells(&self, places: &[Rect], color: Color) {
        let mut d = String::new();
        let (mut x, mut y) = (0, 0);
        for place in places {
            let [left, top] = [place.left, place.top].map(whole);
            let (across, down) = (whole(place.right) - left, whole(place.bottom) - top);
            _ = write!(d, "m{} {}h{across}v{down}h{}z", left - x, top - y, -across);
            (x, y) = (left, top);
        }
        self.put(format_args!("<path fill=\"{color}\" shape-rendering=\"crispEdges\" d=\"{d}\"/>\n"));
    }

    /// A filled disc.
    pub(super) fn disc(&self, centre: Point, radius: f64, color: Color) {
        let [x, y, r] = [centre.x, centre.y, radius].map(whole);
        self.put(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"{color}\"/>\n"));
    }

    /// A circle.
    pub(super) fn ring(&self, centre: Point, radius: f64, pen: Pen) {
        let [x, y, r, width] = [centre.x, centre.y, radius, pen.width].map(whole);
        let color = pen.color;
        self.put(format_args!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\"/>\n"
        ));
    }

    /// A text.
    pub(super) fn text(&self, at: Point, lettering: &Lettering<'_>) {
        let Lettering { text, size, anchor, upright, color } = *lettering;
        let down = CENTRE * size;
        let (at, turn) =
            if upright { (Point { x: at.x + down, ..at }, true) } else { (Point { y: at.y + down, ..at }, false) };
        let [x, y, size] = [at.x, at.y, size].map(whole);
        let anchor = match anchor {
            Anchor::Left => "",
            Anchor::Centre => " text-anchor=\"middle\"",
            Anchor::Right => " text-anchor=\"end\"",
        };
        let turn = if turn { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
        let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        self.put(format_args!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{color}\"{anchor}{turn}>{text}</text>\n"
        ));
    }

    fn put(&self, element: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        _ = self.text.borrow_mut().write_fmt(element);
    }
}

/// The `d` of a polyline.
fn path(points: &[Point]) -> String {
    let mut d = String::new();
    let mut before: Option<(i32, i32)> = None;
    for point in points {
        let (x, y) = (whole(point.x), whole(point.y));
        _ = match before {
            None => write!(d, "M{x} {y}l"),
            // A minus sign parts two numbers as well as a space.
            Some((a, b)) => {
                let (dx, dy) = (x - a, y - b);
                let (first, second) =
                    (if dx < 0 || d.ends_with('l') { "" } else { " " }, if dy < 0 { "" } else { " " });
                write!(d, "{first}{dx}{second}{dy}")
            }
        };
        before = Some((x, y));
    }
    d
}

/// Pixels of the picture to units of the SVG.
#[expect(clippy::cast_possible_truncation, reason = "a cast saturates, and a sheet is some 10 000 units wide")]
fn whole(length: f64) -> i32 {
    (length * UNITS).round() as i32
}
