//! Contours of a field by marching squares: on each side of a cell that the level crosses lies one point, by linear
//! interpolation, and the points of a cell are joined in pairs. A side belongs to two cells, so pairs chain into lines.

use std::collections::BTreeMap;

use super::field::Field;

/// A place in the field, as fractional numbers of its columns and rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    pub column: f64,
    pub row: f64,
}

/// The side of a cell that starts at a node and runs along x or y.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    column: usize,
    row: usize,
    along_x: bool,
}

/// The lines on which the field, mapped by `share`, takes the value `level`.
pub(super) fn contours(field: &Field, share: impl Fn(f64) -> Option<f64>, level: f64) -> Vec<Vec<Node>> {
    let nodes = Nodes::new(field, &share, level);
    let above = |column: usize, row: usize| Some(nodes.at(column, row)?.above);
    let mut joined: BTreeMap<Side, Vec<Side>> = BTreeMap::new();
    for row in 0..field.y.len().saturating_sub(1) {
        for column in 0..field.x.len().saturating_sub(1) {
            let corners = [(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)];
            let Some(up) = corners.iter().map(|&(c, r)| above(c, r)).collect::<Option<Vec<bool>>>() else { continue };
            let sides = [
                Side { column, row, along_x: true },
                Side { column: column + 1, row, along_x: false },
                Side { column, row: row + 1, along_x: true },
                Side { column, row, along_x: false },
            ];
            let crossed: Vec<usize> = (0..4).filter(|&i| up[i] != up[(i + 1) % 4]).collect();
            let pairs: &[[usize; 2]] = match crossed.as_slice() {
                [a, b] => &[[*a, *b]],
                // A saddle: the mean of the corners says which of them are joined through the middle.
                [_, _, _, _] => {
                    let sum: f64 = corners.iter().filter_map(|&(c, r)| share(field.at(c, r))).sum();
                    if (sum / 4.0 >= level) == up[0] { &[[0, 1], [2, 3]] } else { &[[3, 0], [1, 2]] }
                }
                _ => &[],
            };
            for &[a, b] in pairs {
                joined.entry(sides[a]).or_default().push(sides[b]);
                joined.entry(sides[b]).or_default().push(sides[a]);
            }
        }
    }
    let place = |side: &Side| {
        let Side { column, row, along_x } = *side;
        let (next_column, next_row) = if along_x { (column + 1, row) } else { (column, row + 1) };
        let part = match (nodes.at(column, row), nodes.at(next_column, next_row)) {
            (Some(from), Some(to)) if from.above != to.above => from.part_to(to),
            _ => 0.5,
        };
        let number = |n: usize| f64::from(u32::try_from(n).unwrap_or(u32::MAX));
        let (column, row) = (number(column), number(row));
        if along_x { Node { column: column + part, row } } else { Node { column, row: row + part } }
    };
    chains(joined).iter().map(|chain| chain.iter().map(place).collect()).collect()
}

/// A node of the grid against the level.
#[derive(Debug, Clone, Copy)]
struct Sign {
    above: bool,
    /// How far above.
    height: f64,
}

impl Sign {
    /// The share of the way to a node of the other sign at which the line passes.
    fn part_to(&self, to: Self) -> f64 {
        let part = self.height / (self.height - to.height);
        if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.5 }
    }
}

/// The grid's nodes against a level. A node on the level leans a hair to the side of its neighbours, so that a plate's
/// supported edge, which does not move, is no nodal line, and a nodal line runs straight into it.
struct Nodes {
    columns: usize,
    signs: Vec<Option<Sign>>,
}

impl Nodes {
    fn new(field: &Field, share: impl Fn(f64) -> Option<f64>, level: f64) -> Self {
        const ON: f64 = 1e-9;
        const HAIR: f64 = 1e-6;
        let (columns, rows) = (field.x.len(), field.y.len());
        let height = |column: usize, row: usize| {
            let height = share(field.at(column, row))? - level;
            Some(if height.abs() < ON { 0.0 } else { height })
        };
        let sign = |column: usize, row: usize| {
            let mut height_here = height(column, row)?;
            if height_here == 0.0 {
                let around = (column.saturating_sub(1)..=(column + 1).min(columns - 1))
                    .flat_map(|c| (row.saturating_sub(1)..=(row + 1).min(rows - 1)).map(move |r| (c, r)));
                let lean: f64 = around.filter_map(|(c, r)| height(c, r)).sum();
                height_here = if lean.abs() < ON { 0.0 } else { HAIR * lean };
            }
            Some(Sign { above: height_here >= 0.0, height: height_here })
        };
        let signs = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        Self { columns, signs: signs.map(|(column, row)| sign(column, row)).collect() }
    }

    fn at(&self, column: usize, row: usize) -> Option<Sign> {
        self.signs[row * self.columns + column]
    }
}

/// Sides in the order in which a line passes them: lines that end first, then closed ones.
fn chains(mut joined: BTreeMap<Side, Vec<Side>>) -> Vec<Vec<Side>> {
    let mut lines = Vec::new();
    loop {
        let end = joined.iter().find(|(_, others)| others.len() == 1).or_else(|| joined.iter().next());
        let Some((&start, _)) = end else { return lines };
        let mut line = vec![start];
        let mut here = start;
        while let Some(next) = joined.get_mut(&here).and_then(Vec::pop) {
            if let Some(back) = joined.get_mut(&next)
                && let Some(at) = back.iter().position(|side| *side == here)
            {
                back.remove(at);
            }
            line.push(next);
            here = next;
        }
        joined.retain(|_, others| !others.is_empty());
        if line.len() > 1 {
            lines.push(line);
        }
    }
}
