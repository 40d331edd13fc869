//! A backend for plotters that writes SVG in few bytes: whole units, relative paths, no attribute that a default gives.

use std::cell::RefCell;
use std::convert::Infallible;
use std::fmt::Write as _;
use std::rc::Rc;

use plotters_backend::text_anchor::HPos;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontTransform,
};

use super::attributes::escaped;

/// What a drawing step leaves behind; writing into memory cannot fail.
type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// An SVG as it grows.
pub(super) struct Writer {
    pub size: (u32, u32),
    pub text: Rc<RefCell<String>>,
}

impl Writer {
    fn put(&self, element: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        _ = self.text.borrow_mut().write_fmt(element);
    }
}

impl DrawingBackend for Writer {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        self.put(format_args!("<path fill=\"{}\" d=\"M{x} {y}h1v1h-1z\"/>\n", hex(color)));
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn {
        let (color, width) = (hex(style.color()), style.stroke_width());
        let d = relative(path);
        self.put(format_args!("<path fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" d=\"{d}\"/>\n"));
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, corners: I, style: &S) -> Drawn {
        let color = style.color();
        let opacity = if color.alpha < 1.0 { format!(" fill-opacity=\"{:.2}\"", color.alpha) } else { String::new() };
        self.put(format_args!("<path fill=\"{}\"{opacity} d=\"{}z\"/>\n", hex(color), relative(corners)));
        Ok(())
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        _fill: bool,
    ) -> Drawn {
        let (across, down) = (right - left, bottom - top);
        let rect = format!("M{left} {top}h{across}v{down}h{}z", -across);
        let open = format!("<path fill=\"{}\" shape-rendering=\"crispEdges\" d=\"", hex(style.color()));
        let mut text = self.text.borrow_mut();
        // Neighbouring cells of one colour are one path: a map has thousands.
        let last = text.trim_end().rfind('\n').map_or(0, |end| end + 1);
        if text[last..].starts_with(&open) {
            let end = text.len() - "\"/>\n".len();
            text.insert_str(end, &rect);
        } else {
            _ = writeln!(text, "{open}{rect}\"/>");
        }
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(&mut self, (x, y): BackendCoord, radius: u32, style: &S, fill: bool) -> Drawn {
        let color = hex(style.color());
        let paint = if fill {
            format!("fill=\"{color}\"")
        } else {
            format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"{}\"", style.stroke_width())
        };
        self.put(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {paint}/>\n"));
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> Drawn {
        let anchor = match style.anchor().h_pos {
            HPos::Left => "",
            HPos::Center => " text-anchor=\"middle\"",
            HPos::Right => " text-anchor=\"end\"",
        };
        let turn = match style.transform() {
            FontTransform::Rotate270 => format!(" transform=\"rotate(-90 {x} {y})\""),
            _ => String::new(),
        };
        let text = escaped(text);
        let (size, color) = (style.size(), hex(style.color()));
        self.put(format_args!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{color}\"{anchor}{turn}>{text}</text>\n"
        ));
        Ok(())
    }
}

fn hex(color: BackendColor) -> String {
    let (r, g, b) = color.rgb;
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The `d` of a polyline.
pub(super) fn relative(points: impl IntoIterator<Item = BackendCoord>) -> String {
    let mut d = String::new();
    let mut before: Option<BackendCoord> = None;
    for (x, y) in points {
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
