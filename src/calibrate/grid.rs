//! All combinations of the values of the free inputs, as variants of the assumptions.

use crate::scene::Assumptions;
use crate::spec::Calibration;
use crate::study::Variant;
use crate::table::BASELINE;

/// The index of the value that each input has in combination `index`; the last input runs fastest.
pub(super) fn places(calibration: &Calibration, mut index: usize) -> Vec<usize> {
    let mut places = vec![0; calibration.inputs.len()];
    for (place, input) in places.iter_mut().zip(&calibration.inputs).rev() {
        *place = index % input.values.len();
        index /= input.values.len();
    }
    places
}

/// The name of a combination in the column `variant`.
pub(super) fn label(index: usize) -> String {
    format!("combination_{}", index + 1)
}

/// The assumptions in force first, then every combination.
pub(super) fn variants(calibration: &Calibration, in_force: &Assumptions) -> Vec<Variant> {
    let of = |index: usize| {
        let mut assumptions = in_force.clone();
        for (input, place) in calibration.inputs.iter().zip(places(calibration, index)) {
            for name in &input.moves {
                assumptions.values.insert(*name, input.values[place].clone());
            }
        }
        Variant { label: label(index), moved: None, assumptions }
    };
    let baseline = Variant { label: BASELINE.into(), moved: None, assumptions: in_force.clone() };
    [baseline].into_iter().chain((0..calibration.combinations()).map(of)).collect()
}
