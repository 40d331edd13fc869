//! Lists that are short as a rule: the contacts of one instant, blocks and state of one mass with its damper.

use smallvec::SmallVec;

/// Up to four entries stand in place and cost no allocation.
pub(crate) type Few<T> = SmallVec<[T; 4]>;
