//! The verdict strip: one cell for each entry, by chapter, in the order of the pages. Once as a picture and once as links, which a
//! picture in Markdown cannot hold.

use super::chapter::{by_chapter, label};
use super::markdown::html;
use super::svg::{Svg, colour};
use super::tally::{VERDICTS, agrees, mark};
use super::view::ExperimentView;
use crate::experiment::AboutStudy;
use crate::reference::{Judged, Role};

const CELL: f64 = 13.0;
const LEFT: f64 = 96.0;
const WIDTH: f64 = 1240.0;
/// Space between two experiments.
const APART: f64 = 3.0;

/// A row of linked symbols for each chapter; bold where the entry is held out.
pub(super) fn links(about: &AboutStudy, experiments: &[ExperimentView<'_>]) -> String {
    let mut text = String::new();
    for (chapter, views) in by_chapter(experiments) {
        let cells = views.iter().filter(|view| !view.judged.is_empty()).map(|view| cells(view));
        text += &format!("{}: {}\n\n", about.heading(chapter), cells.collect::<Vec<_>>().join(" "));
    }
    text
}

/// The symbols of a page: what agrees is linked to it as a whole, everything else to its entry.
fn cells(view: &ExperimentView<'_>) -> String {
    let together = |a: &Judged, b: &Judged| agrees(a.verdict) && agrees(b.verdict);
    let link = |entries: &[Judged]| {
        let marks: String = entries.iter().map(symbol).collect();
        match entries {
            [one] if !agrees(one.verdict) => format!("[{marks}]({})", view.place_of(one)),
            _ => format!("[{marks}]({})", view.page),
        }
    };
    view.judged.chunk_by(together).map(link).collect()
}

fn symbol(one: &Judged) -> String {
    let mark = mark(one.verdict);
    if one.role == Role::HeldOut { format!("<b>{mark}</b>") } else { mark.to_owned() }
}

/// The same as a picture: colour and symbol of the verdict, a dark outline where the entry is held out.
#[must_use]
pub fn strip_svg(experiments: &[ExperimentView<'_>]) -> String {
    let mut svg = Svg::new(WIDTH);
    let mut y = 8.0;
    for (chapter, views) in by_chapter(experiments) {
        svg.text(LEFT - 8.0, y + 10.0, "end", &label(chapter));
        let mut x = LEFT;
        for view in views {
            for one in view.judged {
                if x + CELL > WIDTH {
                    (x, y) = (LEFT, y + CELL + 3.0);
                }
                let outline = if one.role == Role::HeldOut { " stroke=\"#111\" stroke-width=\"2\"" } else { "" };
                svg.raw(&format!(
                    "<g><title>{}: {}</title><rect x=\"{x:.0}\" y=\"{y:.0}\" width=\"11\" height=\"11\" fill=\"{}\"{outline}/>\
                     <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" font-size=\"9\" fill=\"#fff\">{}</text></g>\n",
                    html(&one.id),
                    one.verdict.word(),
                    colour(one.verdict),
                    x + 5.5,
                    y + 9.0,
                    mark(one.verdict)
                ));
                x += CELL;
            }
            x += APART;
        }
        y += CELL + 10.0;
    }
    let mut x = LEFT;
    for verdict in VERDICTS {
        svg.raw(&format!(
            "<rect x=\"{x:.0}\" y=\"{y:.0}\" width=\"11\" height=\"11\" fill=\"{}\"/>\n",
            colour(verdict)
        ));
        svg.text(x + 16.0, y + 10.0, "start", &format!("{} {}", mark(verdict), verdict.word()));
        x += 118.0;
    }
    svg.raw(&format!(
        "<rect x=\"{x:.0}\" y=\"{y:.0}\" width=\"11\" height=\"11\" fill=\"none\" stroke=\"#111\" stroke-width=\"2\"/>\n"
    ));
    svg.text(x + 16.0, y + 10.0, "start", "held out");
    svg.finish(y + 22.0)
}
