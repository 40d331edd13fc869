//! From an experiment's table to the finished picture.

use crate::experiment::{self, Drawing, Experiment, FigureSpec};
use crate::table::Table;

use super::canvas::{ZOOM, svg};
use super::error::FigureError;
use super::layout::{Needs, Place, figure_height, places};
use super::line::Source;
use super::map::Map;
use super::map_layout::MapLayout;
use super::map_paint;
use super::paint::{self, LegendPlace};
use super::panel::Panel;
use super::raster;
use super::style::WIDTH;

/// A number that the study's text quotes, drawn as an open diamond. The curves of its lost figures are not quoted.
#[derive(Debug, Clone, PartialEq)]
pub struct QuotedPoint {
    /// The y column that it belongs to; it appears in the panels that draw this column.
    pub column: String,
    /// In the table's unit; NaN if the study quotes only y: a line then stands for it.
    pub x: f64,
    /// In the table's unit; NaN if the study quotes only x.
    pub y: f64,
    /// In the legend: `study`.
    pub label: String,
}

/// Draws a figure of an experiment from the rows under the assumptions in force. The same input gives the same bytes.
///
/// # Errors
/// [`FigureError`] if the table lacks what the figure names, or has no number to draw.
pub fn draw(
    experiment: &Experiment,
    figure: &FigureSpec,
    table: &Table,
    quoted: &[QuotedPoint],
) -> Result<Vec<u8>, FigureError> {
    let name =
        if figure.name.is_empty() { experiment.id.to_string() } else { format!("{}-{}", experiment.id, figure.name) };
    let baseline = table.baseline();
    let source = Source { experiment, table: &baseline, figure: &name };
    let svg = match &figure.drawing {
        Drawing::Lines(panels) => lines(source, panels, quoted)?,
        Drawing::Map(spec) => {
            let map = Map::new(source, spec)?;
            let layout = MapLayout::new(&map);
            svg(WIDTH, layout.height, |sheet| map_paint::map(sheet, &map, &layout))
        }
    };
    svg.and_then(|svg| raster::png(&svg, ZOOM)).map_err(|reason| FigureError::Drawing { figure: name.clone(), reason })
}

/// The panels one above the other, as SVG; the inner error is the drawing's.
fn lines(
    source: Source<'_>,
    panels: &[experiment::Panel],
    quoted: &[QuotedPoint],
) -> Result<Result<String, String>, FigureError> {
    let panels = panels.iter().map(|spec| Panel::new(source, spec, quoted)).collect::<Result<Vec<_>, _>>()?;
    if panels.is_empty() {
        return Err(FigureError::Nothing { figure: source.figure.to_owned() });
    }
    let arranged = arranged(&panels);
    let paint = |sheet: &super::canvas::Sheet<'_>| {
        let letters = ('a'..='z').map(Some).chain(std::iter::repeat(None));
        for (arranged, (panel, letter)) in arranged.iter().zip(panels.iter().zip(letters)) {
            let letter = letter.filter(|_| panels.len() > 1);
            paint::panel(sheet, panel, &arranged.place, arranged.legend, letter, arranged.x_labels)?;
        }
        Ok(())
    };
    Ok(svg(WIDTH, figure_height(panels.len()), paint))
}

/// What surrounds a panel.
struct Arranged {
    place: Place,
    legend: LegendPlace,
    x_labels: bool,
}

/// Legends go inside where the data leave room; those that find none go above, and the frames make way for them.
fn arranged(panels: &[Panel<'_>]) -> Vec<Arranged> {
    let x_labels: Vec<bool> = (0..panels.len())
        .map(|index| panels.get(index + 1).is_none_or(|below| below.x_label != panels[index].x_label))
        .collect();
    let mut above = vec![0.0; panels.len()];
    // A legend put above makes the other frames lower, so that another one may lose its place. Each round but the last
    // moves one up at least.
    loop {
        let needs: Vec<Needs> =
            panels.iter().zip(&above).zip(&x_labels).map(|((panel, &above), &x)| panel.needs(above, x)).collect();
        let mut moved = false;
        let mut arranged = Vec::with_capacity(panels.len());
        for (index, (panel, place)) in panels.iter().zip(places(&needs)).enumerate() {
            let frame = place.frame;
            let legend = if panel.legend.is_empty() {
                LegendPlace::None
            } else if above[index] > 0.0 {
                LegendPlace::Above
            } else if let Some(within) = panel.legend.place_within(&frame, &panel.obstacles(&frame)) {
                LegendPlace::Within(within)
            } else {
                above[index] = panel.legend.height_above(frame.width());
                moved = true;
                LegendPlace::Above
            };
            arranged.push(Arranged { place, legend, x_labels: x_labels[index] });
        }
        if !moved {
            return arranged;
        }
    }
}
