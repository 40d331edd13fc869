//! A sheet to draw on, in pixels of the finished picture. The only file that names plotters.
//!
//! plotters rounds to whole pixels, so it draws an SVG [`ZOOM`] times larger than the picture, which
//! [`super::raster`] scales down.

use std::sync::LazyLock;

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{Circle, Drawable, PathElement, PointCollection, Polygon, Rectangle, Text};
use plotters::prelude::SVGBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color as _, FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, ShapeStyle, register_font,
};

use super::geometry::{Point, Rect, dashed};
use super::raster::{FAMILY, FONT};
use super::style::{Color, PAPER};

/// How much larger the SVG is than the picture.
pub(super) const ZOOM: u32 = 6;

/// plotters writes font sizes into the SVG divided by this.
const SVG_FONT_SIZE: f64 = 1.24;
/// Height of DejaVu Sans from descender to ascender in em, the unit in which plotters measures it.
const FONT_HEIGHT: f64 = 1.164;
/// Where plotters puts the baseline of centred text below its anchor, in em.
const SVG_CENTRE: f64 = 0.25;
/// Where the baseline has to lie for digits and capitals to be centred on the anchor, in em.
const TRUE_CENTRE: f64 = 0.365;

static FONT_REGISTERED: LazyLock<bool> = LazyLock::new(|| register_font(FAMILY, FontStyle::Normal, FONT).is_ok());

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

/// What a drawing step leaves behind: nothing, or plotters' complaint.
pub(super) type Drawn = Result<(), String>;

/// A sheet of paper.
pub(super) struct Sheet<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

/// Paints on a white sheet of this size; returns the SVG.
///
/// # Errors
/// plotters' complaint, in words.
pub(super) fn svg(width: f64, height: f64, paint: impl FnOnce(&Sheet<'_>) -> Drawn) -> Result<String, String> {
    if !*FONT_REGISTERED {
        return Err("the built-in font cannot be read".into());
    }
    let mut text = String::new();
    let side = |length: f64| whole(length).unsigned_abs();
    let sheet = Sheet { area: SVGBackend::with_string(&mut text, (side(width), side(height))).into_drawing_area() };
    sheet.area.fill(&rgb(PAPER)).map_err(words)?;
    paint(&sheet)?;
    sheet.area.present().map_err(words)?;
    drop(sheet);
    // Sharp bends of a curve are rounded, not spiked, and neighbouring cells show no seam; plotters has no words for it.
    Ok(text
        .replacen("<svg ", "<svg stroke-linejoin=\"round\" ", 1)
        .replace("<rect ", "<rect shape-rendering=\"crispEdges\" "))
}

/// Width of a text in pixels of the picture.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    if !*FONT_REGISTERED {
        return 0.0;
    }
    let width = font(size).box_size(text).map_or(0, |(width, _)| width);
    f64::from(width) * FONT_HEIGHT / SVG_FONT_SIZE / f64::from(ZOOM)
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

impl<'a> Sheet<'a> {
    /// A polyline.
    pub(super) fn line(&self, points: &[Point], pen: Pen) -> Drawn {
        let style = ShapeStyle {
            color: rgb(pen.color).to_rgba(),
            filled: false,
            stroke_width: whole(pen.width).unsigned_abs(),
        };
        for stretch in dashed(points, pen.dash) {
            self.put(&PathElement::new(pixels(&stretch), style))?;
        }
        Ok(())
    }

    /// A filled polygon.
    pub(super) fn fill(&self, corners: &[Point], color: Color, opacity: f64) -> Drawn {
        self.put(&Polygon::new(pixels(corners), rgb(color).mix(opacity).filled()))
    }

    /// A filled rectangle whose edges meet its neighbours' without a seam.
    pub(super) fn cell(&self, place: &Rect, color: Color) -> Drawn {
        let corners = [pixel(place.at(0.0, 1.0)), pixel(place.at(1.0, 0.0))];
        self.put(&Rectangle::new(corners, rgb(color).filled()))
    }

    /// A filled disc.
    pub(super) fn disc(&self, centre: Point, radius: f64, color: Color) -> Drawn {
        self.put(&Circle::new(pixel(centre), whole(radius), rgb(color).filled()))
    }

    /// A text.
    pub(super) fn text(&self, at: Point, lettering: &Lettering<'_>) -> Drawn {
        let turn = if lettering.upright { FontTransform::Rotate270 } else { FontTransform::None };
        let h_pos = match lettering.anchor {
            Anchor::Left => HPos::Left,
            Anchor::Centre => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        let mut style = font(lettering.size).transform(turn).color(&rgb(lettering.color));
        style.pos = Pos::new(h_pos, VPos::Center);
        let down = (TRUE_CENTRE - SVG_CENTRE) * lettering.size;
        let at = if lettering.upright { Point { x: at.x + down, ..at } } else { Point { y: at.y + down, ..at } };
        self.put(&Text::new(lettering.text, pixel(at), style))
    }

    fn put<'b, E>(&self, element: &'b E) -> Drawn
    where
        &'b E: PointCollection<'b, (i32, i32)>,
        E: Drawable<SVGBackend<'a>>,
    {
        self.area.draw(element).map_err(words)
    }
}

fn font(size: f64) -> FontDesc<'static> {
    FontDesc::new(FontFamily::Name(FAMILY), size * SVG_FONT_SIZE * f64::from(ZOOM), FontStyle::Normal)
}

fn rgb(color: Color) -> RGBColor {
    RGBColor(color.0, color.1, color.2)
}

fn words<E: std::error::Error + Send + Sync>(error: DrawingAreaErrorKind<E>) -> String {
    error.to_string()
}

fn pixels(points: &[Point]) -> Vec<(i32, i32)> {
    points.iter().copied().map(pixel).collect()
}

fn pixel(point: Point) -> (i32, i32) {
    (whole(point.x), whole(point.y))
}

/// Pixels of the picture to whole pixels of the SVG.
#[expect(clippy::cast_possible_truncation, reason = "a cast saturates, and a sheet is some 10 000 pixels wide")]
fn whole(length: f64) -> i32 {
    (length * f64::from(ZOOM)).round() as i32
}
