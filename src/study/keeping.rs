//! Tables on their way: of a large sweep, rows take longer to be made into a table and written than threads take to notice an interrupt.

use std::sync::atomic::{AtomicUsize, Ordering};

/// How many there are.
static UNDER_WAY: AtomicUsize = AtomicUsize::new(0);

/// One of them, until it is dropped.
pub(super) struct Keeping(());

impl Keeping {
    pub(super) fn begin() -> Self {
        UNDER_WAY.fetch_add(1, Ordering::AcqRel);
        Self(())
    }
}

impl Drop for Keeping {
    fn drop(&mut self) {
        UNDER_WAY.fetch_sub(1, Ordering::AcqRel);
    }
}

/// Whether finished rows are being written; who ends the process waits for them.
pub fn is_keeping_rows() -> bool {
    UNDER_WAY.load(Ordering::Acquire) > 0
}
