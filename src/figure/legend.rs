//! Legends: what each line means, at a place where no data lies.

use crate::dynamics::Special;
use crate::experiment::{Band, Joined, Level, Panel};

use super::branch::SpecialPoint;
use super::canvas::{Anchor, Lettering, Pen, Sheet, text_width};
use super::geometry::{Point, Rect};
use super::line::{Curve, Join};
use super::marker;
use super::obstacles::Obstacles;
use super::quoted::Quoted;
use super::strip;
use super::style::{
    BAND_OPACITY, CURVE, Color, GREY, GUIDE, GUIDE_DASH, INK, KindOfMotion, LEGEND_LINE, LEGEND_ROW, LEGEND_TEXT, Look,
    Marker, PAPER, QUOTED, SPACE,
};

/// Width of a kind of motion.
const SWATCH: f64 = 42.0;

/// What is drawn before a legend's text.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Sign {
    Line {
        look: Look,
        marker: bool,
    },
    Marker(Look),
    Dot(Look),
    Band(Color),
    Quoted,
    Tolerance,
    Guide,
    Bar,
    Impulse,
    Motion(KindOfMotion),
    Special(Special),
    /// None: the text is a heading of what follows.
    Heading,
}

/// One row of a legend.
#[derive(Debug, Clone, PartialEq)]
struct Entry {
    sign: Sign,
    text: String,
}

/// A legend.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Legend {
    entries: Vec<Entry>,
    /// Room before the rows of a legend above a frame, for a panel's letter.
    pub indent: f64,
}

impl Legend {
    /// Of these curves; empty where there is nothing to tell apart.
    pub(super) fn new(curves: &[Curve], panel: &Panel, band: bool, quoted: &[&Quoted]) -> Self {
        let mut entries = Vec::new();
        let markers = panel.markers || panel.band == Band::Seeds;
        let points = quoted.iter().any(|one| one.is_point());
        if curves.len() > 1 || band || points || curves.iter().any(|curve| curve.is_outcome) {
            entries.extend(by_trait(curves, markers, panel.joined).unwrap_or_else(|| {
                let line = |curve: &Curve| Entry {
                    sign: match curve.join {
                        Join::Line if markers && curve.is_of_single_points() => Sign::Marker(curve.look),
                        Join::Line => Sign::Line { look: curve.look, marker: markers },
                        Join::Dots => Sign::Dot(curve.look),
                    },
                    text: curve.name.full(),
                };
                // A level alone has its name on it.
                curves.iter().filter(|curve| !curve.samples.is_empty()).map(line).collect()
            }));
        }
        if band && panel.band != Band::Stacked {
            let color = match curves {
                [one] => one.look.color,
                _ => GREY,
            };
            let seeds = curves.iter().map(|curve| curve.seeds).max().unwrap_or(0);
            let text = match panel.band {
                Band::Seeds => format!("median and range of {seeds} seeds"),
                Band::None | Band::Spread | Band::Stacked => "± 1 s.d. of the ensemble".into(),
            };
            entries.push(Entry { sign: Sign::Band(color), text });
        }
        if points {
            entries.push(Entry { sign: Sign::Quoted, text: "study ± tolerance".into() });
        }
        if quoted.iter().any(|one| !one.is_point() && one.tolerance.is_some()) {
            let text = if points { "place or level ± tolerance" } else { "study ± tolerance" };
            entries.push(Entry { sign: Sign::Tolerance, text: text.into() });
        }
        Self { entries, indent: 0.0 }
    }

    /// Names the signs of contacts and impulses.
    pub(super) fn name_instants(&mut self, contacts: bool, impulses: bool) {
        let signs = [(contacts, Sign::Bar, "contact"), (impulses, Sign::Impulse, "impulse")];
        let shown = signs.into_iter().filter(|(shown, ..)| *shown);
        self.entries.extend(shown.map(|(_, sign, text)| Entry { sign, text: text.into() }));
    }

    /// Names the colours of strips, under a heading: they are none of the lines'.
    pub(super) fn name_motions(&mut self, classes: &[KindOfMotion]) {
        let heading = Entry { sign: Sign::Heading, text: "motion:".into() };
        self.entries.extend(Some(heading).filter(|_| !classes.is_empty()));
        let named = classes.iter().map(|class| Entry { sign: Sign::Motion(*class), text: class.words().into() });
        self.entries.extend(named);
    }

    /// Names the kinds of special points.
    pub(super) fn name_special_points(&mut self, points: &[SpecialPoint]) {
        let shown = |kind: &Special| points.iter().any(|point| point.kind == *kind);
        let named = Special::ALL.into_iter().filter(shown);
        self.entries.extend(named.map(|kind| Entry { sign: Sign::Special(kind), text: kind.word().into() }));
    }

    /// Names guides beside the lines.
    pub(super) fn name_guides(&mut self, guides: &[Level]) {
        let named = guides.iter().filter(|guide| !guide.label.is_empty());
        self.entries.extend(named.map(|guide| Entry { sign: Sign::Guide, text: guide.label.clone() }));
    }

    pub(super) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// True if another one would say nothing new beside this one.
    pub(super) fn says_all_of(&self, other: &Self) -> bool {
        other.entries.iter().all(|entry| self.entries.contains(entry))
    }

    /// A place inside `frame` that the obstacles leave free: corners first, then along the edges.
    pub(super) fn place_within(&self, frame: &Rect, obstacles: &Obstacles) -> Option<Rect> {
        let width = self.entries.iter().map(Entry::width).fold(0.0, f64::max) + 2.0 * SPACE;
        let height = rows_high(self.entries.len());
        let inner = frame.grown(-SPACE);
        let (free_across, free_down) = (inner.width() - width, inner.height() - height);
        if free_across < 0.0 || free_down < 0.0 {
            return None;
        }
        const PLACES: [(f64, f64); 20] = [
            (1.0, 0.0),
            (0.0, 0.0),
            (1.0, 1.0),
            (0.0, 1.0),
            (0.5, 0.0),
            (0.5, 1.0),
            (0.25, 0.0),
            (0.75, 0.0),
            (0.25, 1.0),
            (0.75, 1.0),
            (0.12, 0.0),
            (0.88, 0.0),
            (0.12, 1.0),
            (0.88, 1.0),
            (1.0, 0.25),
            (0.0, 0.25),
            (1.0, 0.5),
            (0.0, 0.5),
            (1.0, 0.75),
            (0.0, 0.75),
        ];
        PLACES
            .into_iter()
            .map(|(across, down)| {
                let (left, top) = (inner.left + across * free_across, inner.top + down * free_down);
                Rect { left, top, right: left + width, bottom: top + height }
            })
            .find(|place| obstacles.leave_free(&place.grown(SPACE / 2.0)))
    }

    /// Height above a frame of this width, where no place within is free.
    pub(super) fn height_above(&self, width: f64) -> f64 {
        rows_high(self.rows(width - self.indent).len()) + SPACE
    }

    /// Draws the entries one below the other.
    pub(super) fn draw_column(&self, sheet: &Sheet, place: &Rect) {
        let corners = [place.at(0.0, 0.0), place.at(0.0, 1.0), place.at(1.0, 1.0), place.at(1.0, 0.0)];
        sheet.fill(&corners, PAPER, 0.85);
        let mut middle = Point { x: place.left + SPACE, y: place.top + SPACE / 2.0 + LEGEND_ROW / 2.0 };
        for entry in &self.entries {
            entry.draw(sheet, middle);
            middle.y += LEGEND_ROW;
        }
    }

    /// Draws the entries in rows above a frame.
    pub(super) fn draw_above(&self, sheet: &Sheet, frame: &Rect) {
        let top = frame.top - self.height_above(frame.width()) + SPACE;
        for (index, row) in (0_u32..).zip(self.rows(frame.width() - self.indent)) {
            let mut at = Point { x: frame.left + self.indent, y: top + LEGEND_ROW * (f64::from(index) + 0.5) };
            for entry in row {
                entry.draw(sheet, at);
                at.x += entry.width() + entry.apart();
            }
        }
    }

    fn rows(&self, width: f64) -> Vec<&[Entry]> {
        let mut rows = Vec::new();
        let (mut start, mut used) = (0, 0.0);
        for (index, entry) in self.entries.iter().enumerate() {
            // What a heading stands before begins a row.
            let is_heading = entry.sign == Sign::Heading;
            if index > start && (is_heading || used + entry.width() > width) {
                rows.push(&self.entries[start..index]);
                (start, used) = (index, 0.0);
            }
            used += entry.width() + entry.apart();
        }
        rows.push(&self.entries[start..]);
        rows
    }
}

/// One entry a colour and one a dash, where every curve is a pair of the two and that says it in fewer words.
fn by_trait(curves: &[Curve], markers: bool, joined: Joined) -> Option<Vec<Entry>> {
    let mut hues: Vec<Entry> = Vec::new();
    let mut dashes: Vec<Entry> = Vec::new();
    for curve in curves {
        let dash = curve.name.dash.as_ref()?;
        let color = Look { dash: &[], marker: Marker::Circle, ..curve.look };
        let stroke = Look { color: INK, width: CURVE, ..curve.look };
        for (entries, text, look, marker) in
            [(&mut hues, &curve.name.hue, color, false), (&mut dashes, dash, stroke, markers)]
        {
            let entry = Entry { sign: Sign::Line { look, marker }, text: text.clone() };
            if !entries.contains(&entry) {
                entries.push(entry);
            }
        }
    }
    // Fewer curves than pairs: some pair is missing, and only full names tell which; a branch need not have both.
    let all_pairs = joined == Joined::AlongBranches || hues.len() * dashes.len() == curves.len();
    let complete = all_pairs && hues.len() > 1 && dashes.len() > 1;
    hues.extend(dashes);
    complete.then_some(hues)
}

fn rows_high(rows: usize) -> f64 {
    LEGEND_ROW * u32::try_from(rows).map_or(0.0, f64::from) + SPACE
}

impl Entry {
    fn width(&self) -> f64 {
        self.sign_width() + text_width(&self.text, LEGEND_TEXT)
    }

    /// With the space before the text.
    fn sign_width(&self) -> f64 {
        match self.sign {
            Sign::Heading => 0.0,
            Sign::Motion(_) => SWATCH + SPACE,
            _ => LEGEND_LINE + SPACE,
        }
    }

    /// From the next one in its row.
    fn apart(&self) -> f64 {
        match self.sign {
            Sign::Heading | Sign::Motion(_) => 2.0 * SPACE,
            _ => 3.0 * SPACE,
        }
    }

    fn draw(&self, sheet: &Sheet, at: Point) {
        let text_at = Point { x: at.x + self.sign_width(), ..at };
        let end = Point { x: at.x + LEGEND_LINE, ..at };
        let middle = Point { x: at.x + LEGEND_LINE / 2.0, ..at };
        match self.sign {
            Sign::Line { look, marker } => {
                sheet.line(&[at, end], Pen { color: look.color, width: look.width, dash: look.dash });
                if marker {
                    marker::draw(sheet, middle, look);
                }
            }
            Sign::Marker(look) => marker::draw(sheet, middle, look),
            Sign::Dot(look) => sheet.disc(middle, look.width, look.color),
            Sign::Band(color) => {
                let half = LEGEND_ROW * 0.3;
                let place = Rect { left: at.x, top: at.y - half, right: end.x, bottom: at.y + half };
                let corners = [place.at(0.0, 0.0), place.at(0.0, 1.0), place.at(1.0, 1.0), place.at(1.0, 0.0)];
                sheet.fill(&corners, color, BAND_OPACITY);
            }
            Sign::Quoted => {
                let bar = [-0.45, 0.45].map(|down| Point { y: at.y + down * LEGEND_ROW, ..middle });
                sheet.line(&bar, Pen::solid(INK, GUIDE));
                marker::diamond(sheet, middle, 0.8 * QUOTED);
            }
            Sign::Tolerance => {
                sheet.line(&[at, end], Pen { color: INK, width: GUIDE, dash: marker::DASH });
                marker::bar(sheet, [-0.35, 0.35].map(|down| Point { y: at.y + down * LEGEND_ROW, ..middle }));
            }
            Sign::Motion(class) => {
                let place = Rect { left: at.x, top: at.y - 12.0, right: at.x + SWATCH, bottom: at.y + 12.0 };
                strip::cell(sheet, &place, class);
            }
            Sign::Heading => {}
            Sign::Special(kind) => marker::draw(sheet, middle, Look::of_special(kind)),
            Sign::Bar => {
                let place = Rect { left: at.x, top: at.y - 6.0, right: end.x, bottom: at.y + 6.0 };
                sheet.cell(&place, GREY);
            }
            Sign::Impulse => {
                let ends = [-0.4, 0.4].map(|down| Point { y: at.y + down * LEGEND_ROW, ..middle });
                sheet.line(&ends, Pen { color: GREY, width: CURVE, dash: &[3.0, 7.0] });
            }
            Sign::Guide => sheet.line(&[at, end], Pen { color: GREY, width: GUIDE, dash: GUIDE_DASH }),
        }
        let lettering =
            Lettering { text: &self.text, size: LEGEND_TEXT, anchor: Anchor::Left, upright: false, color: INK };
        sheet.text(text_at, &lettering)
    }
}
