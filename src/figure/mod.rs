//! Figures: a stored table to a PNG that a journal would print at column width.
//!
//! table → curves (rows split into lines, gaps kept) or fields (rows split into maps) → axes, legend and colour bar laid out
//! in pixels → SVG on a canvas far larger than the picture → PNG. The font is built in, so that the same table gives the
//! same picture on any machine.

mod axis;
mod canvas;
mod colormap;
mod contour;
mod error;
mod field;
mod geometry;
mod group;
mod label;
mod layout;
mod legend;
mod line;
mod map;
mod map_layout;
mod map_paint;
mod paint;
mod panel;
mod peak;
mod raster;
mod render;
mod style;
mod work_precision;

pub use error::FigureError;
pub use render::{QuotedPoint, draw};
pub use work_precision::work_precision;
