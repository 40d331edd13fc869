//! Contacts in a time history of paths: where the particle's path lies on that of a face. They are bars at the frame, below for the
//! floor and above for the ceiling, and impulses are vertical lines: claims about an instant are read off there.

use super::axis::Axis;
use super::canvas::{Pen, Sheet};
use super::error::FigureError;
use super::geometry::{Point, Rect};
use super::source::Source;
use super::style::{GREY, Look, THIN_CURVE};
use crate::experiment;
use crate::table::Data;

/// Height of a bar.
pub(super) const BAR: f64 = 12.0;
/// Dash of an impulse's line.
const IMPULSE: &[f64] = &[3.0, 7.0];
/// Paths closer than this share of their range are one.
const TOUCH: f64 = 1e-9;

/// A face that a particle can lie on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Face {
    Floor,
    Ceiling,
}

impl Face {
    fn column(self) -> &'static str {
        match self {
            Self::Floor => "floor_displacement",
            Self::Ceiling => "ceiling_displacement",
        }
    }
}

/// A contact, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Contact {
    pub face: Face,
    pub from: f64,
    pub to: f64,
}

/// The contacts of a panel that draws a particle's path and a face's over time.
pub(super) fn contacts(source: Source<'_>, panel: &experiment::Panel) -> Result<Vec<Contact>, FigureError> {
    let draws = |column: &str| panel.y.iter().any(|axis| axis.column == column);
    let mut found = Vec::new();
    if panel.x.column != "time" || !panel.by.is_empty() || !draws("particle_displacement") {
        return Ok(found);
    }
    let list = |name: &str| {
        let cells = match &source.column(name)?.data {
            Data::FloatList(cells) => cells.first().map_or(&[][..], Vec::as_slice),
            _ => &[],
        };
        Ok::<_, FigureError>(cells)
    };
    let (time, particle) = (list("time")?, list("particle_displacement")?);
    let range = particle.iter().fold(0.0_f64, |range, at| range.max(at.abs()));
    for face in [Face::Floor, Face::Ceiling].into_iter().filter(|face| draws(face.column())) {
        let path = list(face.column())?;
        let mut began: Option<f64> = None;
        for ((&time, &particle), &path) in time.iter().zip(particle).zip(path) {
            let touches = (particle - path).abs() <= TOUCH * range;
            match (began, touches) {
                (None, true) => began = Some(time),
                (Some(from), false) => {
                    found.push(Contact { face, from, to: time });
                    began = None;
                }
                _ => {}
            }
        }
        if let (Some(from), Some(&to)) = (began, time.last()) {
            found.push(Contact { face, from, to });
        }
    }
    Ok(found)
}

/// Bars of contacts, and a line at each impulse of this period, s, over the axis `x`.
pub(super) fn draw(sheet: &Sheet, x: &Axis, impulses: Option<f64>, contacts: &[Contact], frame: &Rect) {
    if let Some(period) = impulses {
        let (from, to) = (x.number(0.0), x.number(1.0));
        let mut cycle = (from / period).ceil();
        while cycle * period <= to {
            let at = frame.at(x.share_clamped(cycle * period), 0.0);
            let ends = [at, Point { y: frame.top, ..at }];
            sheet.line(&ends, Pen { color: GREY, width: THIN_CURVE, dash: IMPULSE });
            cycle += 1.0;
        }
    }
    for contact in contacts {
        let Some(look) = Look::of_path(contact.face.column()) else { continue };
        let [left, right] = [contact.from, contact.to].map(|at| frame.at(x.share_clamped(at), 0.0).x);
        let top = match contact.face {
            Face::Floor => frame.bottom - BAR,
            Face::Ceiling => frame.top,
        };
        sheet.cell(&Rect { left, top, right: right.max(left + 2.0), bottom: top + BAR }, look.color);
    }
}
