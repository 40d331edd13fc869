//! BᵀP + PC = Q for two blocks: zᵀQw integrated over motions z′ = Bz and w′ = Cw is [zᵀPw], a difference of end values.

use nalgebra::{LU, Matrix4, U4, Vector4};

/// Where |λₖ + λₗ| is below this share of the faster one, a solution would lose more than three digits.
pub(crate) const NEARLY_NEUTRAL: f64 = 4e-4;

/// The equation of two blocks, factorised.
pub(crate) struct Lyapunov(LU<f64, U4, U4>);

impl Lyapunov {
    /// `one` and `other` are B and C, row by row; none where two of their eigenvalues cancel.
    pub(crate) fn new([a, b, c, d]: [f64; 4], [e, f, g, h]: [f64; 4]) -> Option<Self> {
        // Unknowns p00, p01, p10, p11.
        #[rustfmt::skip]
        let system = Matrix4::new(
            a + e, g, c, 0.0,
            f, a + h, 0.0, c,
            b, 0.0, d + e, g,
            0.0, b, f, d + h,
        );
        let lu = system.lu();
        lu.is_invertible().then_some(Self(lu))
    }

    /// P for this Q.
    pub(crate) fn solve(&self, q: [f64; 4]) -> [f64; 4] {
        let p = self.0.solve(&Vector4::from(q)).expect("only what can be solved is kept");
        [p[0], p[1], p[2], p[3]]
    }
}
