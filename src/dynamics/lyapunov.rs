//! BᵀP + PC = Q for two blocks: zᵀQw integrated over motions z′ = Bz and w′ = Cw is [zᵀPw], a difference of end values.

use nalgebra::{Matrix4, Vector4};

use super::four::Four;

/// Where |λₖ + λₗ| is below this share of the faster one, a solution would lose more than three digits.
pub(crate) const NEARLY_NEUTRAL: f64 = 4e-4;

/// The equation of two blocks: P for each entry of Q alone. It is solved far more often than set up.
pub(crate) struct Lyapunov([Four; 4]);

impl Lyapunov {
    /// Of B and C, row by row; none where two of their eigenvalues cancel.
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
        let alone = |entry: usize| lu.solve(&Vector4::ith(entry, 1.0)).map(|p| Four::new(p.into()));
        Some(Self([alone(0)?, alone(1)?, alone(2)?, alone(3)?]))
    }

    /// P for this Q.
    pub(crate) fn solve(&self, q: [f64; 4]) -> [f64; 4] {
        let [a, b, c, d] = &self.0;
        (*a * q[0] + *b * q[1] + (*c * q[2] + *d * q[3])).array()
    }

    /// What each entry of Q counts for in Σ wP, P being its solution.
    pub(crate) fn adjoint(&self, w: [f64; 4]) -> Four {
        let w = Four::new(w);
        Four::new(self.0.each_ref().map(|alone| (*alone * w).sum()))
    }
}
