//! Figures: a stored table to an SVG and a PNG that a journal would print at column width.
//!
//! table → curves (rows split into lines, gaps kept) or fields (rows split into maps) → axes, legend and colour bar laid out
//! in pixels → SVG → PNG. The font is built in, so that the same table gives the
//! same picture on any machine.

mod animation;
mod attributes;
mod axis;
mod backend;
mod bars;
mod beside;
mod branch;
mod canvas;
mod colormap;
mod contact;
mod contour;
mod error;
mod field;
mod geometry;
mod glyph;
mod group;
mod label;
mod layout;
mod legend;
mod line;
mod map;
mod map_layout;
mod map_paint;
mod marker;
mod obstacles;
mod paint;
mod panel;
mod peak;
mod quoted;
mod quoted_sign;
mod raster;
mod render;
mod sample;
mod searches;
mod shortest;
mod sketch;
mod source;
mod strip;
mod style;
mod work_precision;

pub use beside::Beside;
pub use error::FigureError;
pub use quoted::{Known, Quoted, QuotedAt};
pub use render::{Picture, draw, draw_svg, draw_table, figure_stem};
pub use sketch::{is_sketched, sketch};
pub use work_precision::work_precision;
