//! A linear system as independent 2 × 2 blocks, and the way there and back.

use crate::contact_state::block::Block;

/// e^(At) = V diag(e^(Bₖt)) W, with W = V⁻¹ where there are as many blocks as coordinates ask for.
#[derive(Clone)]
pub(crate) struct Spectral {
    /// V, row by row, order × 2·blocks.
    pub(crate) from_blocks: Vec<f64>,
    /// W, 2·blocks × order: row by row as it is split, column by column from [`crate::contact_state::modes::split`] on.
    pub(crate) to_blocks: Vec<f64>,
    /// Entries of each block, [[p, q], [r, s]] flattened.
    pub(crate) matrices: Vec<[f64; 4]>,
    /// Their invariants.
    pub(crate) blocks: Vec<Block>,
    /// Seconds for which it holds; infinite unless some eigenvalues nearly coalesce.
    pub(crate) lasts: f64,
}

impl Default for Spectral {
    /// Of no coordinates.
    fn default() -> Self {
        Self::new(Vec::new(), Vec::new(), Vec::new(), f64::INFINITY)
    }
}

impl Spectral {
    /// Of blocks with these entries.
    pub(crate) fn new(from_blocks: Vec<f64>, to_blocks: Vec<f64>, matrices: Vec<[f64; 4]>, lasts: f64) -> Self {
        let blocks = matrices.iter().map(|matrix| Block::new(*matrix)).collect();
        Self { from_blocks, to_blocks, matrices, blocks, lasts }
    }

    /// The same with its fastest blocks first, as a search for events leaves them out.
    pub(crate) fn fastest_first(self) -> Self {
        let mut order: Vec<usize> = (0..self.blocks.len()).collect();
        order.sort_by(|&k, &l| self.blocks[l].radius.total_cmp(&self.blocks[k].radius));
        let sorted = |entries: &[f64]| {
            let pairs = entries.as_chunks::<2>().0;
            let mut sorted = Vec::with_capacity(pairs.len());
            for row in pairs.chunks_exact(order.len().max(1)) {
                sorted.extend(order.iter().map(|&k| row[k]));
            }
            sorted.into_flattened()
        };
        let matrices = order.iter().map(|&k| self.matrices[k]).collect();
        Self::new(sorted(&self.from_blocks), sorted(&self.to_blocks), matrices, self.lasts)
    }

    /// A column of V.
    pub(crate) fn column(&self, k: usize) -> impl Iterator<Item = f64> {
        self.from_blocks.iter().skip(k).step_by(self.width()).copied()
    }

    /// Block coordinates: two a block.
    pub(crate) fn width(&self) -> usize {
        2 * self.blocks.len()
    }

    /// Some block has an eigenvalue zero, so that a constant load sets it moving.
    pub(crate) fn drifts(&self) -> bool {
        self.blocks.iter().any(|block| block.determinant == 0.0)
    }
}
