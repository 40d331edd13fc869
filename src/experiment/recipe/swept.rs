//! Where a damper says `swept`: what it states beside is kept.

use std::collections::BTreeSet;

use super::parameter::Parameter;

/// The slots of a damper that are left to a sweep.
///
/// They are no part of what a simulation depends on: the values that a sweep gives are.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SweptSlots {
    /// All of them.
    pub all: BTreeSet<Parameter>,
    /// Of its floor.
    pub floor: BTreeSet<Parameter>,
    /// Of its ceiling.
    pub ceiling: BTreeSet<Parameter>,
}

impl SweptSlots {
    /// Some slot is left to a sweep of this parameter.
    pub(super) fn hold(&self, parameter: Parameter) -> bool {
        self.all.contains(&parameter)
    }

    /// Whether a sweep sets floor and ceiling: those that leave it to the sweep, or both where neither does.
    pub(super) fn surfaces(&self, parameter: Parameter) -> [bool; 2] {
        let marked = [&self.floor, &self.ceiling].map(|slots| slots.contains(&parameter));
        if marked == [false, false] { [true, true] } else { marked }
    }
}
