//! Figures: a stored table to a PNG that a journal would print at column width.
//!
//! table → curves (rows split into lines, gaps kept) → axes and legend laid out in pixels → SVG on a
//! canvas far larger than the picture → PNG. The font is built in, so that the same table gives the same picture on
//! any machine.

mod axis;
mod canvas;
mod error;
mod geometry;
mod label;
mod layout;
mod legend;
mod line;
mod paint;
mod panel;
mod raster;
mod render;
mod style;

pub use error::FigureError;
pub use render::{QuotedPoint, draw};
