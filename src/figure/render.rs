//! From an experiment's table to the finished picture.

use crate::experiment::{Drawing, Experiment, FigureSpec};
use crate::table::Table;

use super::animation::{animation, still};
use super::bars::bars;
use super::beside::Beside;
use super::canvas::svg;
use super::error::FigureError;
use super::layout::{Needs, Place, figure_height, places};
use super::legend::Legend;
use super::map::Map;
use super::map_layout::MapLayout;
use super::paint::{self, LegendPlace};
use super::panel::{Panel, Reach};
use super::source::Source;
use super::style::{LETTER, WIDTH};
use super::{map_paint, raster};

/// Pixels of the PNG to a pixel of the SVG: enough for a screen of two dots to a pixel, on which a figure is about 900 wide.
const DENSITY: f32 = 1.25;

/// A figure in both its forms.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Sharp at any size.
    pub svg: String,
    /// The same, for what shows no SVG.
    pub png: Vec<u8>,
}

impl Picture {
    /// From an SVG.
    ///
    /// # Errors
    /// [`FigureError::Drawing`] if it cannot be made a PNG.
    pub(super) fn of(svg: String, figure: &str) -> Result<Self, FigureError> {
        match raster::png(&still(&svg), DENSITY) {
            Ok(png) => Ok(Self { svg, png }),
            Err(source) => Err(FigureError::Drawing { figure: figure.to_owned(), source }),
        }
    }
}

/// Draws a figure of an experiment from the rows under the assumptions in force. The same input gives the same bytes.
///
/// # Errors
/// [`FigureError`] if the table lacks what the figure names, or has no number to draw.
pub fn draw(
    experiment: &Experiment,
    figure: &FigureSpec,
    table: &Table,
    beside: Beside<'_>,
) -> Result<Picture, FigureError> {
    Picture::of(draw_svg(experiment, figure, table, beside)?, &figure_stem(experiment, figure))
}

/// As [`draw`], for what shows SVG: the pixels take most of the time.
///
/// # Errors
/// As [`draw`].
pub fn draw_svg(
    experiment: &Experiment,
    figure: &FigureSpec,
    table: &Table,
    beside: Beside<'_>,
) -> Result<String, FigureError> {
    drawn(Some(experiment), &figure_stem(experiment, figure), figure, table, beside)
}

/// What a figure is called, as a file without its ending and in messages: the experiment's id, and the figure's own name if it
/// is not the first.
#[must_use]
pub fn figure_stem(experiment: &Experiment, figure: &FigureSpec) -> String {
    if figure.name.is_empty() { experiment.id.to_string() } else { format!("{}-{}", experiment.id, figure.name) }
}

/// Draws a table that is no experiment's; `name` is for messages.
///
/// # Errors
/// As [`draw`].
pub fn draw_table(name: &str, figure: &FigureSpec, table: &Table) -> Result<Picture, FigureError> {
    Picture::of(drawn(None, name, figure, table, Beside::default())?, name)
}

fn drawn(
    experiment: Option<&Experiment>,
    name: &str,
    figure: &FigureSpec,
    table: &Table,
    beside: Beside<'_>,
) -> Result<String, FigureError> {
    let table = chosen(figure, &table.baseline());
    let panels = if let Drawing::Lines(panels) = &figure.drawing { panels.as_slice() } else { &[] };
    let source = Source { experiment, table: &table, figure: name, colours: beside.colours, panels };
    Ok(match &figure.drawing {
        Drawing::Lines(_) => lines(source, beside)?,
        Drawing::Gaps => match experiment.and_then(|experiment| experiment.optimise.as_ref()) {
            Some(optimise) => bars(source, optimise)?,
            None => return Err(FigureError::Nothing { figure: name.to_owned() }),
        },
        Drawing::Animation(spec) => animation(source, spec, beside.impulses)?,
        Drawing::Map(spec) => {
            let map = Map::new(source, spec)?;
            let layout = MapLayout::new(&map);
            svg(WIDTH, layout.height, |sheet| map_paint::map(sheet, &map, &layout))
        }
    })
}

/// The rows that a figure draws.
fn chosen(figure: &FigureSpec, table: &Table) -> Table {
    let Some(only) = &figure.only else { return table.clone() };
    let rows: Vec<usize> = only.words.iter().flat_map(|word| table.rows_where(&only.column, word)).collect();
    table.select(&rows)
}

/// The panels one above the other, as SVG.
fn lines(source: Source<'_>, beside: Beside<'_>) -> Result<String, FigureError> {
    let specs = source.panels;
    let mut panels = specs.iter().map(|spec| Panel::new(source, spec, beside)).collect::<Result<Vec<_>, _>>()?;
    if panels.is_empty() {
        return Err(FigureError::Nothing { figure: source.figure.to_owned() });
    }
    for spec in specs {
        let reaches = panels.iter().filter_map(|panel| panel.x_reach(&spec.x.column));
        if let Some(reach) = reaches.reduce(Reach::union) {
            let over = |panel: &&mut Panel<'_>| panel.x_reach(&spec.x.column).is_some();
            panels.iter_mut().filter(over).for_each(|panel| panel.reach_in_x(reach));
        }
    }
    for index in 1..panels.len() {
        let (above, here) = panels.split_at_mut(index);
        if above.iter().any(|panel| panel.legend.says_all_of(&here[0].legend)) {
            here[0].legend = Legend::default();
        }
    }
    if panels.len() > 1 {
        panels.iter_mut().for_each(|panel| panel.legend.indent = LETTER);
    }
    let (arranged, height) = arranged(&panels);
    let paint = |sheet: &super::canvas::Sheet| {
        let letters = ('a'..='z').map(Some).chain(std::iter::repeat(None));
        for (arranged, (panel, letter)) in arranged.iter().zip(panels.iter().zip(letters)) {
            let letter = letter.filter(|_| panels.len() > 1);
            paint::panel(sheet, panel, &arranged.place, arranged.legend, letter, arranged.x_labels);
        }
    };
    Ok(svg(WIDTH, height, paint))
}

/// What surrounds a panel.
struct Arranged {
    place: Place,
    legend: LegendPlace,
    x_labels: bool,
}

/// Legends go inside where the data leave room; those that find none go above, and make the figure higher. With its height.
fn arranged(panels: &[Panel<'_>]) -> (Vec<Arranged>, f64) {
    let x_labels: Vec<bool> = (0..panels.len())
        .map(|index| {
            panels
                .get(index + 1)
                .is_none_or(|below| (&below.x_label, &below.x) != (&panels[index].x_label, &panels[index].x))
        })
        .collect();
    let mut above = vec![0.0; panels.len()];
    // A legend put above may take more rows where frames are narrower. Each round but the last moves or raises one legend at least.
    loop {
        let needs: Vec<Needs> =
            panels.iter().zip(&above).zip(&x_labels).map(|((panel, &above), &x)| panel.needs(above, x)).collect();
        let mut moved = false;
        let mut arranged = Vec::with_capacity(panels.len());
        for (index, (panel, place)) in panels.iter().zip(places(&needs)).enumerate() {
            let frame = place.frame;
            let obstacles = || paint::obstacles(panel, &frame);
            let within = if above[index] > 0.0 { None } else { panel.legend.place_within(&frame, &obstacles()) };
            let legend = match within {
                _ if panel.legend.is_empty() => LegendPlace::None,
                Some(within) => LegendPlace::Within(within),
                None => {
                    let wanted = panel.legend.height_above(frame.width());
                    moved |= wanted > above[index];
                    above[index] = wanted.max(above[index]);
                    LegendPlace::Above
                }
            };
            arranged.push(Arranged { place, legend, x_labels: x_labels[index] });
        }
        if !moved {
            return (arranged, figure_height(&needs));
        }
    }
}
