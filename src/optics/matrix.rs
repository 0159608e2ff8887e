//! Ray transfer matrices of paraxial optics (Born & Wolf, Principles of Optics, §4.4; Hecht, Optics, §6.2).

use std::ops::Mul;

/// What a part of a lens does to a paraxial ray: height y in mm and reduced angle n u behind it, of those in front of it.
///
/// u = dy/d|z|, along the way of the light: where a mirror turns it, the way is unfolded. The determinant is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayMatrix {
    /// y of y.
    pub a: f64,
    /// y of n u, in mm.
    pub b: f64,
    /// n u of y, in 1/mm: the negative power.
    pub c: f64,
    /// n u of n u.
    pub d: f64,
}

impl RayMatrix {
    /// Nothing at all.
    pub const IDENTITY: Self = Self { a: 1.0, b: 0.0, c: 0.0, d: 1.0 };

    /// A way of `distance` mm through a medium.
    pub fn translation(distance: f64, index: f64) -> Self {
        Self { b: distance / index, ..Self::IDENTITY }
    }

    /// A refracting surface: `curvature` in 1/mm is positive where the centre lies the way the light goes.
    pub fn refraction(curvature: f64, before: f64, behind: f64) -> Self {
        Self { c: (before - behind) * curvature, ..Self::IDENTITY }
    }

    /// A reflecting surface in a medium; the sign of the curvature as for refraction, by the way before the mirror.
    pub fn reflection(curvature: f64, index: f64) -> Self {
        Self { c: 2.0 * index * curvature, ..Self::IDENTITY }
    }

    /// a d − b c, which is 1 but for rounding.
    pub fn determinant(&self) -> f64 {
        self.a * self.d - self.b * self.c
    }

    /// What takes light back to where it came from.
    pub fn inverse(&self) -> Self {
        Self { a: self.d, b: -self.b, c: -self.c, d: self.a }
    }
}

/// The right one is met first.
impl Mul for RayMatrix {
    type Output = Self;

    fn mul(self, first: Self) -> Self {
        Self {
            a: self.a * first.a + self.b * first.c,
            b: self.a * first.b + self.b * first.d,
            c: self.c * first.a + self.d * first.c,
            d: self.c * first.b + self.d * first.d,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirror_focuses_at_half_its_radius() {
        // Concave to the light: its centre is where the light comes from.
        let mirror = RayMatrix::reflection(-1.0 / 80.0, 1.0);
        let at_focus = RayMatrix::translation(40.0, 1.0) * mirror;
        assert!(at_focus.a.abs() < 1e-15);
        // In water as well, since the law of reflection has no index.
        let in_water = RayMatrix::translation(40.0, 1.33) * RayMatrix::reflection(-1.0 / 80.0, 1.33);
        assert!(in_water.a.abs() < 1e-15);
    }

    #[test]
    fn a_surface_focuses_where_its_closed_form_says() {
        // n2 R/(n2 − n1)
        let matrix = RayMatrix::translation(1.5 * 20.0 / 0.5, 1.5) * RayMatrix::refraction(1.0 / 20.0, 1.0, 1.5);
        assert!(matrix.a.abs() < 1e-15);
    }

    #[test]
    fn a_matrix_and_its_inverse_do_nothing() {
        let matrix = RayMatrix::translation(7.0, 1.6) * RayMatrix::refraction(0.03, 1.0, 1.6);
        assert!((matrix.determinant() - 1.0).abs() < 1e-15);
        let nothing = matrix * matrix.inverse();
        assert!((nothing.a - 1.0).abs() < 1e-15 && nothing.b.abs() < 1e-15 && nothing.c.abs() < 1e-15);
    }
}
