//! The few forms that the pictures of the index are made of.

use super::markdown::html;
use crate::reference::Verdict;

/// A picture under construction.
pub(super) struct Svg {
    width: f64,
    body: String,
}

impl Svg {
    pub(super) fn new(width: f64) -> Self {
        Self { width, body: String::new() }
    }

    pub(super) fn raw(&mut self, element: &str) {
        self.body += element;
    }

    pub(super) fn text(&mut self, x: f64, y: f64, anchor: &str, text: &str) {
        self.body += &format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>\n", html(text));
    }

    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: &str, width: f64) {
        let ([x1, y1], [x2, y2]) = (from, to);
        self.body += &format!(
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>\n"
        );
    }

    /// A verdict by colour and shape.
    pub(super) fn verdict(&mut self, x: f64, y: f64, verdict: Verdict) {
        let colour = colour(verdict);
        let shape = match verdict {
            Verdict::Reproduced => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{colour}\"/>"),
            Verdict::Fitted => {
                format!(
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.5\" fill=\"#fff\" stroke=\"{colour}\" stroke-width=\"2\"/>"
                )
            }
            Verdict::Differs => format!(
                "<path d=\"M{:.1} {:.1}l7 7m0 -7l-7 7\" stroke=\"{colour}\" stroke-width=\"2.2\"/>",
                x - 3.5,
                y - 3.5
            ),
            Verdict::Blocked => format!(
                "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"7\" height=\"7\" fill=\"#fff\" stroke=\"{colour}\" stroke-width=\"2\"/>",
                x - 3.5,
                y - 3.5
            ),
            Verdict::Undecidable | Verdict::Missing => {
                format!("<path d=\"M{:.1} {:.1}l4 7h-8z\" fill=\"{colour}\"/>", x, y - 4.0)
            }
        };
        self.body += &format!("{shape}\n");
    }

    pub(super) fn finish(self, height: f64) -> String {
        let Self { width, body } = self;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
             height=\"{height:.0}\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" \
             fill=\"#fff\"/>\n{body}</svg>\n"
        )
    }
}

/// Colours that also differ in lightness, so that they can be told apart without hue.
pub(super) fn colour(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Reproduced => "#1b7837",
        Verdict::Fitted => "#5b9bd5",
        Verdict::Differs => "#b2182b",
        Verdict::Undecidable => "#8073ac",
        Verdict::Blocked => "#b8860b",
        Verdict::Missing => "#555555",
    }
}
