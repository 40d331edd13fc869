//! Rows of a run under a fixed step.

/// What is measured: rows over the state.
pub(super) struct Watch<V> {
    /// Observed displacement, m, and velocity, m/s.
    pub(super) displacement: V,
    pub(super) velocity: V,
    /// The same of all further observed points.
    pub(super) more: Vec<[V; 2]>,
    /// Displacement under the force, and its rate.
    pub(super) forced: V,
    pub(super) with_displacement: bool,
}
