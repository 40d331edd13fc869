//! BᵀP + PC = Q for two blocks: zᵀQw integrated over motions z′ = Bz and w′ = Cw is [zᵀPw], a difference of end values.
//!
//! Where both turn at one rate about a circle, B = [[a, −b], [b, a]] for λ = a + ib and C for μ alike, P and Q are sums of a
//! complex factor and one that conjugates first, and each has an equation of its own: (λ̄ + μ) π = κ and (λ̄ + μ̄) ϖ = ς.

use nalgebra::{Matrix4, Vector4};

use crate::arithmetic::complexes::Complexes;
use crate::arithmetic::four::Four;
use crate::arithmetic::lanes::WIDTH;
use crate::arithmetic::wide::widened;

/// Where |λₖ + λₗ| is below this share of the faster one, a solution would lose more than three digits.
pub(crate) const NEARLY_NEUTRAL: f64 = 4e-4;

/// The equation of two blocks.
pub(crate) enum Lyapunov {
    /// ½/(λ̄ + μ) and ½/(λ̄ + μ̄), real and imaginary parts.
    Circles([f64; 4]),
    /// P for each entry of Q alone.
    Any([Four; 4]),
}

impl Lyapunov {
    /// Of a Q that is zero, whatever the blocks.
    pub(crate) const NOTHING: Self = Self::Circles([0.0; 4]);

    /// Of B and C, row by row; none where two of their eigenvalues cancel.
    pub(crate) fn new(one: [f64; 4], other: [f64; 4]) -> Option<Self> {
        if let (Some([a, b]), Some([c, d])) = (on_circle(one), on_circle(other)) {
            // Where squares leave the range of numbers, the system of four is as good.
            let half = |re: f64, im: f64| {
                let twice = 2.0 * (re * re + im * im);
                twice.is_normal().then(|| [re / twice, -im / twice])
            };
            if let (Some([p, q]), Some([r, s])) = (half(a + c, d - b), half(a + c, -b - d)) {
                return Some(Self::Circles([p, q, r, s]));
            }
        }
        let ([a, b, c, d], [e, f, g, h]) = (one, other);
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
        Some(Self::Any([alone(0)?, alone(1)?, alone(2)?, alone(3)?]))
    }

    /// For so many times Q.
    #[must_use]
    pub(crate) fn times(self, factor: f64) -> Self {
        match self {
            Self::Circles(circles) => Self::Circles(circles.map(|entry| factor * entry)),
            Self::Any(alone) => Self::Any(alone.map(|alone| alone * factor)),
        }
    }
}

/// a and b of [[a, −b], [b, a]].
fn on_circle([p, q, r, s]: [f64; 4]) -> Option<[f64; 2]> {
    (p == s && q == -r).then_some([p, r])
}

/// The equations of many pairs of blocks, which are solved far more often than set up.
pub(crate) struct Equations {
    /// Those on circles, several side by side; zero in the places of others.
    circles: Vec<[Complexes; 2]>,
    /// The others, with their places.
    any: Vec<(usize, [Four; 4])>,
}

impl FromIterator<Lyapunov> for Equations {
    fn from_iter<T: IntoIterator<Item = Lyapunov>>(all: T) -> Self {
        let mut any = Vec::new();
        let circles: Vec<[f64; 4]> = all
            .into_iter()
            .enumerate()
            .map(|(place, equation)| match equation {
                Lyapunov::Circles(circles) => circles,
                Lyapunov::Any(alone) => {
                    any.push((place, alone));
                    [0.0; 4]
                }
            })
            .collect();
        let several = |circles: &[[f64; 4]]| {
            let [p, q, r, s] = across(circles);
            [Complexes { re: p, im: q }, Complexes { re: r, im: s }]
        };
        Self { circles: circles.chunks(WIDTH).map(several).collect(), any }
    }
}

impl Equations {
    /// Numbers that they keep.
    pub(crate) fn size(&self) -> usize {
        4 * WIDTH * (self.circles.len() + self.any.len())
    }

    /// Those whose solutions are to any Q what these are to any P: ⟨W, Q⟩ = ⟨V, P⟩ if W solves them for V.
    pub(crate) fn transposed(&self) -> Self {
        let conjugate = |z: &Complexes| Complexes { re: z.re, im: z.im * -1.0 };
        Self {
            circles: self.circles.iter().map(|pair| pair.each_ref().map(conjugate)).collect(),
            any: self.any.iter().map(|(place, columns)| (*place, across(&columns.map(Four::array)))).collect(),
        }
    }

    widened! {
        /// P for each Q.
        pub(crate) fn solve | solve_wide (&self, entries: &[[f64; 4]]) -> Vec<[f64; 4]> = solve_by_registers
    }

    #[inline(always)]
    fn solve_by_registers(&self, entries: &[[f64; 4]]) -> Vec<[f64; 4]> {
        let mut solved = Vec::with_capacity(entries.len());
        for ([plain, mirrored], entries) in self.circles.iter().zip(entries.chunks(WIDTH)) {
            let [xu, xv, yu, yv] = across(entries);
            let a = plain.times(Complexes { re: xu + yv, im: yu - xv });
            let b = mirrored.times(Complexes { re: xu - yv, im: xv + yu });
            let back = across(&[a.re + b.re, b.im - a.im, a.im + b.im, a.re - b.re].map(Four::array));
            solved.extend(back.iter().take(entries.len()).map(|solved| solved.array()));
        }
        for (place, [a, b, c, d]) in &self.any {
            let [e, f, g, h] = entries[*place];
            solved[*place] = (*a * e + *b * f + (*c * g + *d * h)).array();
        }
        solved
    }
}

/// Columns of up to so many rows, filled up with zeros.
#[inline(always)]
fn across(rows: &[[f64; 4]]) -> [Four; 4] {
    let row = |i: usize| rows.get(i).copied().unwrap_or_default();
    let [a, b, c, d] = [row(0), row(1), row(2), row(3)];
    [0, 1, 2, 3].map(|column| Four::new([a[column], b[column], c[column], d[column]]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_turns_have_the_solution_of_any_two_blocks() {
        let circle = |a: f64, b: f64| [a, -b, b, a];
        let (b, c, q) = (circle(-0.3, 7.0), circle(-1.1, -4.0), [0.3, -1.7, 0.9, 2.1]);
        let found = Lyapunov::new(b, c).unwrap();
        assert!(matches!(found, Lyapunov::Circles(_)));
        let [p00, p01, p10, p11] = Equations::from_iter([found]).solve(&[q])[0];
        let back = [
            b[0] * p00 + b[2] * p10 + p00 * c[0] + p01 * c[2],
            b[0] * p01 + b[2] * p11 + p00 * c[1] + p01 * c[3],
            b[1] * p00 + b[3] * p10 + p10 * c[0] + p11 * c[2],
            b[1] * p01 + b[3] * p11 + p10 * c[1] + p11 * c[3],
        ];
        assert!(back.iter().zip(q).all(|(back, q)| (back - q).abs() < 1e-14), "{back:?}");
    }
}
