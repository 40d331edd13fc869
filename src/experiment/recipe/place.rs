//! Places on a structure: shares of its sides or lengths along them, and arrays of places.

use serde::{Deserialize, Serialize};

use super::assumption::AssumptionName;
use super::error::RecipeError;
use super::given::{Given, Inputs, PlaceList};
use super::part::Part;
use crate::scene::{Kind, Model, Point};

/// A place, one coordinate a side; none on a single mass.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PlaceRecipe(pub Vec<Coordinate>);

/// One coordinate of a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coordinate {
    /// Share of the side, 0 to 1.
    Share(f64),
    /// m from the side's start.
    Length(f64),
    /// That of one of the places that an assumption lists, as a share of the side.
    Listed {
        /// The assumption.
        of: AssumptionName,
        /// Which place, from 1.
        number: u32,
        /// Which side, from 0.
        side: usize,
    },
}

/// An array of equal dampers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ArrayRecipe {
    /// How many along each side, or one number for all of them.
    pub count: Vec<u32>,
    /// Distance along each side, or the same along all, m.
    pub spacing: Vec<f64>,
    /// Centred on its place; else it begins there.
    pub centred: bool,
    /// Distance that it keeps from the ends of the structure, m: one that would come nearer is moved inwards as a whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub margin: Option<Given>,
    /// In which order gaps are given to its dampers; by columns unless it is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<Given<ArrayOrder>>,
}

/// In which order the dampers of an array are counted, from the corner where both sides start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ArrayOrder {
    /// Along the second side first.
    Columns,
    /// Along the first side first.
    Rows,
}

impl PlaceRecipe {
    /// At these shares of the sides.
    #[must_use]
    pub fn at_shares(shares: &[f64]) -> Self {
        Self(shares.iter().map(|share| Coordinate::Share(*share)).collect())
    }

    /// The first of the places that an assumption lists, on a structure of so many sides.
    #[must_use]
    pub fn listed(of: &AssumptionName, sides: usize) -> Self {
        Self((0..sides).map(|side| Coordinate::Listed { of: of.clone(), number: 1, side }).collect())
    }

    /// Chooses another place of the list; false if this is not a place of one.
    pub(super) fn choose(&mut self, chosen: u32) -> bool {
        let mut listed = false;
        for coordinate in &mut self.0 {
            if let Coordinate::Listed { number, .. } = coordinate {
                (*number, listed) = (chosen, true);
            }
        }
        listed
    }

    /// Moves one coordinate; false if there is none.
    pub(super) fn set_share(&mut self, side: usize, share: f64) -> bool {
        let coordinate = self.0.get_mut(side);
        coordinate.map(|coordinate| *coordinate = Coordinate::Share(share)).is_some()
    }
}

/// Turns places into points of one structure.
pub(super) struct Places<'a> {
    kind: &'static Kind,
    sides: Vec<f64>,
    model: &'a dyn Model,
    inputs: &'a Inputs<'a>,
}

impl<'a> Places<'a> {
    pub(super) fn on(kind: &'static Kind, model: &'a dyn Model, inputs: &'a Inputs<'a>) -> Self {
        Self { kind, sides: model.sides(), model, inputs }
    }

    /// The point of a place.
    pub(super) fn point(&self, place: &PlaceRecipe, part: Part) -> Result<Point, RecipeError> {
        self.checked(self.coordinates(place, part)?, part)
    }

    /// As [`Model::moves`].
    pub(super) fn moves(&self, at: Point) -> bool {
        self.model.moves(at)
    }

    /// Displacement at a point by the coordinates of the structure.
    pub(super) fn shape(&self, at: Point) -> Vec<f64> {
        self.model.shape(at)
    }

    /// The points of an array; of nothing but its place if there is none.
    pub(super) fn array(
        &self,
        place: &PlaceRecipe,
        array: Option<&ArrayRecipe>,
        margin: f64,
        part: Part,
    ) -> Result<Vec<Point>, RecipeError> {
        let Some(array) = array else { return Ok(vec![self.point(place, part)?]) };
        let refuse =
            |message: String| Err(RecipeError::out_of_range(message).within(part).at_keys(&["damper_count", "array"]));
        let sides = self.sides.len();
        if sides == 0 {
            return refuse(format!("an array needs a side to stand along, and {} has none", self.kind.what));
        }
        let count = match array.count.as_slice() {
            [all] if sides == 2 => near_square(*all),
            counts if counts.len() == sides => counts.to_vec(),
            counts => {
                return refuse(format!("an array on {} has {sides} counts, not {}", self.kind.what, counts.len()));
            }
        };
        let spacing = match array.spacing.as_slice() {
            [one] => vec![*one; sides],
            each if each.len() == sides => each.to_vec(),
            each => return refuse(format!("an array on {} has {sides} spacings, not {}", self.kind.what, each.len())),
        };
        let mut start = self.coordinates(place, part)?;
        for (side, start) in start.iter_mut().enumerate() {
            let reach = f64::from(count[side] - 1) * spacing[side];
            *start -= if array.centred { 0.5 * reach } else { 0.0 };
            if array.margin.is_some() {
                let (low, high) = (start.min(*start + reach), start.max(*start + reach));
                *start += (margin - low).max(0.0) - (high + margin - self.sides[side]).max(0.0);
            }
        }
        let offset = |side: usize, i: u32| start[side] + f64::from(i) * spacing[side];
        let (columns, rows) = (count[0], count.get(1).copied().unwrap_or(1));
        let order = array.order.as_ref().map_or(Ok(ArrayOrder::Columns), |order| self.inputs.get(order))?;
        let steps: Vec<[u32; 2]> = match order {
            ArrayOrder::Columns => (0..columns).flat_map(|i| (0..rows).map(move |j| [i, j])).collect(),
            ArrayOrder::Rows => (0..rows).flat_map(|j| (0..columns).map(move |i| [i, j])).collect(),
        };
        let point = |step: &[u32; 2]| self.checked((0..sides).map(|side| offset(side, step[side])).collect(), part);
        steps.iter().map(point).collect()
    }

    fn coordinates(&self, place: &PlaceRecipe, part: Part) -> Result<Vec<f64>, RecipeError> {
        if place.0.len() != self.sides.len() {
            let message = match self.sides.len() {
                0 => format!("{} has no places: leave `at` out", self.kind.what),
                1 => format!("a place on {} is one number: `at: 0.5`, or `at: 20 cm`", self.kind.what),
                _ => format!("a place on {} is two numbers: `at: [0.25, 0.5]`", self.kind.what),
            };
            return Err(refused_place(part, message));
        }
        let coordinate = |(coordinate, side): (&Coordinate, &f64)| match coordinate {
            Coordinate::Share(share) => Ok(share * side),
            Coordinate::Length(length) => Ok(*length),
            Coordinate::Listed { of, number, side: along } => Ok(self.listed(of, *number, *along, part)? * side),
        };
        place.0.iter().zip(&self.sides).map(coordinate).collect()
    }

    /// One coordinate of a place that an assumption lists.
    fn listed(&self, of: &AssumptionName, number: u32, side: usize, part: Part) -> Result<f64, RecipeError> {
        let PlaceList(places) = self.inputs.get(&Given::Assumed(of.clone()))?;
        // A list of one place is that place, whichever is chosen of longer ones.
        let index = if places.len() == 1 { Some(0) } else { number.checked_sub(1) };
        let share = index.and_then(|index| places.get(index as usize)?.get(side));
        share.copied().ok_or_else(|| {
            let message = format!(
                "`{of}` lists {} places of {} coordinates, and none is number {number} of {}",
                places.len(),
                places.first().map_or(0, Vec::len),
                self.kind.what
            );
            refused_place(part, message)
        })
    }

    fn checked(&self, coordinates: Vec<f64>, part: Part) -> Result<Point, RecipeError> {
        for ((coordinate, side), word) in coordinates.iter().zip(&self.sides).zip(self.kind.sides) {
            // What a share or a spacing has rounded beyond the end is at the end.
            if !(*coordinate >= -1e-12 * side && *coordinate <= side * (1.0 + 1e-12)) {
                let what = match part {
                    Part::Damper(_) => "a damper",
                    Part::Observe => "an observed point",
                    _ => "a force",
                };
                let message =
                    format!("{what} at {coordinate} m lies outside {}: its {word} is {side} m", self.kind.what);
                return Err(refused_place(part, message));
            }
        }
        let at = |i: usize| coordinates.get(i).map_or(0.0, |x| x.clamp(0.0, self.sides[i]));
        Ok(Point { x: at(0), y: at(1) })
    }
}

fn refused_place(part: Part, message: String) -> RecipeError {
    RecipeError::out_of_range(message).within(part).at_keys(part.place_keys())
}

/// Rows and columns of `all` places as near to a square as they go: 1 × 1, 2 × 2, 2 × 3, 3 × 3.
fn near_square(all: u32) -> Vec<u32> {
    let narrow = (1..=all).take_while(|n| u64::from(*n) * u64::from(*n) <= u64::from(all));
    let narrow = narrow.filter(|n| all.is_multiple_of(*n)).last().unwrap_or(1);
    vec![narrow, all / narrow]
}
