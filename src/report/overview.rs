//! All numbers in one picture: S/D on a logarithmic axis with bars of 2 u_val, by chapter, and |E|/u_val beside it.

use super::chapter::{by_chapter, label};
use super::svg::{Svg, colour};
use super::view::ExperimentView;
use crate::reference::{Comparison, Verdict};
use crate::text::number::significant;

const WIDTH: f64 = 900.0;
const ROW: f64 = 13.0;
/// Ends of the axis in the picture.
const LEFT: f64 = 300.0;
const RIGHT: f64 = 800.0;
/// Marks of the axis, of which those within the data are drawn.
const TICKS: [f64; 13] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];

struct Row<'a> {
    name: String,
    verdict: Verdict,
    comparison: &'a Comparison,
}

impl Row<'_> {
    fn ratio(&self) -> f64 {
        self.comparison.simulated / self.comparison.published
    }
}

/// The picture; numbers without a positive ratio have a row and no mark.
#[must_use]
pub fn overview_svg(experiments: &[ExperimentView<'_>]) -> String {
    let chapters: Vec<(Option<u32>, Vec<Row<'_>>)> = by_chapter(experiments)
        .into_iter()
        .map(|(chapter, views)| {
            let entries = views.into_iter().flat_map(|view| view.judged);
            let rows = entries.flat_map(|one| {
                one.comparisons().map(|(part, comparison)| Row {
                    name: if part.is_empty() { one.id.clone() } else { format!("{}, {part}", one.id) },
                    verdict: one.verdict,
                    comparison,
                })
            });
            (chapter, rows.collect())
        })
        .filter(|(_, rows): &(Option<u32>, Vec<Row<'_>>)| !rows.is_empty())
        .collect();
    let axis = Axis::of(chapters.iter().flat_map(|(_, rows)| rows).map(Row::ratio));
    let mut svg = Svg::new(WIDTH);
    let top = 34.0;
    let height: f64 =
        chapters.iter().map(|(_, rows)| ROW * (2.0 + f64::from(u32::try_from(rows.len()).unwrap_or(0)))).sum();
    for tick in axis.ticks() {
        let (x, strong) = (axis.x(tick), tick == 1.0);
        svg.line([x, top], [x, top + height], if strong { "#444" } else { "#ddd" }, if strong { 1.5 } else { 1.0 });
        svg.text(x, top - 6.0, "middle", &format!("{tick}"));
    }
    svg.text(
        (LEFT + RIGHT) / 2.0,
        13.0,
        "middle",
        "S/D: here over published, bars ± tolerance/D (2 u_val, or set by hand)",
    );
    svg.text(WIDTH - 12.0, top - 6.0, "end", "|E|/u_val");
    let mut y = top;
    for (chapter, rows) in &chapters {
        y += ROW;
        svg.raw(&format!("<text x=\"8\" y=\"{:.1}\" font-weight=\"bold\">{}</text>\n", y + 4.0, label(*chapter)));
        for row in rows {
            y += ROW;
            draw(&mut svg, &axis, row, y);
        }
        y += ROW;
    }
    y += 20.0;
    let mut x = 20.0;
    for verdict in [Verdict::Reproduced, Verdict::Fitted, Verdict::Differs, Verdict::Undecidable, Verdict::Blocked] {
        svg.verdict(x, y - 4.0, verdict);
        svg.text(x + 10.0, y, "start", verdict.word());
        x += 110.0;
    }
    svg.finish(y + 12.0)
}

fn draw(svg: &mut Svg, axis: &Axis, row: &Row<'_>, y: f64) {
    svg.text(LEFT - 10.0, y + 4.0, "end", &row.name);
    svg.text(WIDTH - 12.0, y + 4.0, "end", &significant(row.comparison.deviation(), 2));
    let ratio = row.ratio();
    if !(ratio.is_finite() && ratio > 0.0) {
        return;
    }
    let reach = (row.comparison.tolerance() / row.comparison.published).abs();
    let (from, to) = (axis.x(ratio - reach), axis.x(ratio + reach));
    svg.line([from, y], [to, y], colour(row.verdict), 1.4);
    svg.verdict(axis.x(ratio), y, row.verdict);
}

/// A logarithmic axis that holds all ratios; what reaches beyond it ends at its end.
struct Axis {
    low: f64,
    high: f64,
}

impl Axis {
    fn of(ratios: impl Iterator<Item = f64>) -> Self {
        let (low, high) = ratios
            .filter(|ratio| ratio.is_finite() && *ratio > 0.0)
            .fold((0.5_f64, 2.0_f64), |(low, high), ratio| (low.min(ratio), high.max(ratio)));
        let below = TICKS.into_iter().rfind(|tick| *tick < low).unwrap_or(TICKS[0]);
        let above = TICKS.into_iter().find(|tick| *tick > high).unwrap_or(TICKS[TICKS.len() - 1]);
        Self { low: below, high: above }
    }

    fn ticks(&self) -> impl Iterator<Item = f64> {
        TICKS.into_iter().filter(|tick| (self.low..=self.high).contains(tick))
    }

    fn x(&self, ratio: f64) -> f64 {
        let along = libm::log(ratio.clamp(self.low, self.high) / self.low) / libm::log(self.high / self.low);
        LEFT + along * (RIGHT - LEFT)
    }
}
