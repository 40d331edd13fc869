//! BᵀP + PC = Q for two blocks: zᵀQw integrated over motions z′ = Bz and w′ = Cw is [zᵀPw], a difference of end values.

use nalgebra::{LU, Matrix4, U4, Vector4};

/// The equation of two blocks, factorised.
pub(crate) struct Lyapunov(LU<f64, U4, U4>);

impl Lyapunov {
    /// `one` and `other` are B and C, row by row.
    pub(crate) fn new([a, b, c, d]: [f64; 4], [e, f, g, h]: [f64; 4]) -> Self {
        // Unknowns p00, p01, p10, p11.
        #[rustfmt::skip]
        let system = Matrix4::new(
            a + e, g, c, 0.0,
            f, a + h, 0.0, c,
            b, 0.0, d + e, g,
            0.0, b, f, d + h,
        );
        Self(system.lu())
    }

    /// P for this Q; none where two eigenvalues cancel.
    pub(crate) fn solve(&self, q: [f64; 4]) -> Option<[f64; 4]> {
        self.0.solve(&Vector4::from(q)).map(|p| [p[0], p[1], p[2], p[3]])
    }
}
