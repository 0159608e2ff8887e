//! Turns of any degree, by Euler angles: R = Rz(α) Ry(β) Rz(γ).

use std::f64::consts::{FRAC_1_SQRT_2, LN_10};

use glam::{DMat3, DQuat};
use rayon::prelude::*;

use super::{Coefficients, index};

impl Coefficients {
    /// [`Coefficients::rotated`] without rotation matrices of whole bands, stable up to [`super::HIGHEST_DEGREE`].
    ///
    /// Turns about z mix c_lm with c_l,−m only. The turn about y goes by Wigner's d, for each pair of orders by its
    /// three-term recurrence in l (Varshalovich, Moskalev and Khersonskii, "Quantum Theory of Angular Momentum", 1988,
    /// section 4.8), which is that of the Legendre functions in a wider form. O(degree³) time, O(degree²) memory.
    pub fn rotated_by_angles(&self, rotation: DQuat) -> Self {
        let turn = DMat3::from_quat(rotation.normalize());
        let pole = turn.z_axis;
        let (alpha, beta) = (pole.y.atan2(pole.x), pole.truncate().length().atan2(pole.z));
        // What is left after α; defined for every β, unlike what stands in the last row.
        let rest = DMat3::from_rotation_z(-alpha) * turn;
        let gamma = rest.x_axis.y.atan2(rest.y_axis.y);
        self.clone().about_z(gamma).about_y(beta).about_z(alpha)
    }

    fn about_z(mut self, angle: f64) -> Self {
        for m in 1..=self.degree {
            let (sin, cos) = (m as f64 * angle).sin_cos();
            for l in m..=self.degree {
                let [plus, minus] = [m as isize, -(m as isize)].map(|m| index(l, m));
                for colour in 0..3 {
                    let (c, s) = (self.values[plus][colour], self.values[minus][colour]);
                    self.values[plus][colour] = c * cos - s * sin;
                    self.values[minus][colour] = c * sin + s * cos;
                }
            }
        }
        self
    }

    fn about_y(&self, beta: f64) -> Self {
        let tables = Tables::new(self.degree, beta);
        let orders: Vec<Vec<[[f64; 3]; 2]>> =
            (0..=self.degree).into_par_iter().map(|m| self.order_about_y(m, &tables)).collect();
        let mut result = Self::zero(self.degree);
        for (m, order) in orders.iter().enumerate() {
            for (l, &[cosine, sine]) in (m..).zip(order) {
                if m > 0 {
                    result.values[index(l, -(m as isize))] = sine;
                }
                result.values[index(l, m as isize)] = cosine;
            }
        }
        result
    }

    /// The new c_lm and c_l,−m of one m, for l = m ..= degree: cosines and sines do not mix.
    fn order_about_y(&self, m: usize, tables: &Tables) -> Vec<[[f64; 3]; 2]> {
        let mut result = vec![[[0.0; 3]; 2]; self.degree - m + 1];
        for k in 0..=self.degree {
            let mut same = Wigner::start(m, k as isize, tables);
            let mut opposite = Wigner::start(m, -(k as isize), tables);
            let zeros = i32::from(m == 0) + i32::from(k == 0);
            let norm = FRAC_1_SQRT_2.powi(zeros);
            let [same_sign, opposite_sign] = [m + k, m].map(|n| if n % 2 == 0 { norm } else { -norm });
            for l in m.max(k)..=self.degree {
                let (a, b) = (same_sign * same.value(), opposite_sign * opposite.value());
                let [cosine, sine] = [k as isize, -(k as isize)].map(|k| self.values[index(l, k)]);
                let [cosines, sines] = &mut result[l - m];
                for colour in 0..3 {
                    cosines[colour] += (a + b) * cosine[colour];
                    sines[colour] += (a - b) * sine[colour];
                }
                same.step(l, tables.cos);
                opposite.step(l, tables.cos);
            }
        }
        result
    }
}

/// What seeds need: logarithms of n!, cos β/2 and sin β/2.
struct Tables {
    factorials: Vec<f64>,
    log_cos: f64,
    log_sin: f64,
    cos: f64,
}

impl Tables {
    fn new(degree: usize, beta: f64) -> Self {
        let mut factorials = vec![0.0];
        for n in 1..=2 * degree {
            factorials.push(factorials[n - 1] + (n as f64).ln());
        }
        let (sin, cos) = (0.5 * beta).sin_cos();
        Self { factorials, log_cos: cos.ln(), log_sin: sin.ln(), cos: beta.cos() }
    }
}

/// d^l_mk(β) as l rises: `mantissa` times e to the `scale`, which no underflow of the first one can lose.
struct Wigner {
    m: f64,
    k: f64,
    before: f64,
    /// √((l²−m²)(l²−k²)).
    root: f64,
    mantissa: f64,
    scale: f64,
    /// e to the `scale`.
    size: f64,
}

impl Wigner {
    /// At l = max(m, |k|): ± √((2l)! / ((l+j)! (l−j)!)) times powers of cos β/2 and sin β/2, where j is the smaller one.
    fn start(m: usize, k: isize, tables: &Tables) -> Self {
        let size = k.unsigned_abs();
        let l = m.max(size);
        // The power of cos is |m + k|, that of sin |m − k|.
        let (even, odd) = ((m as isize + k).unsigned_abs(), (m as isize - k).unsigned_abs());
        let negative = if m >= size || k < 0 { odd % 2 == 1 } else { false };
        let smaller = m.min(size);
        let logs = &tables.factorials;
        let power = |n: usize, log: f64| if n == 0 { 0.0 } else { n as f64 * log };
        let scale = 0.5 * (logs[2 * l] - logs[l + smaller] - logs[l - smaller])
            + power(even, tables.log_cos)
            + power(odd, tables.log_sin);
        let mantissa = if negative { -1.0 } else { 1.0 };
        Self { m: m as f64, k: k as f64, before: 0.0, root: 0.0, mantissa, scale, size: scale.exp() }
    }

    fn value(&self) -> f64 {
        self.mantissa * self.size
    }

    /// From l to l + 1.
    fn step(&mut self, l: usize, cos: f64) {
        let (l, m, k) = (l as f64, self.m, self.k);
        let above = l + 1.0;
        let root = ((above - m) * (above + m) * (above - k) * (above + k)).sqrt();
        // Both fractions are 0 / 0 at l = 0, where m and k are 0 and neither counts.
        let (shift, lower) = if l == 0.0 { (0.0, 0.0) } else { (m * k / (l * above), self.root / (l * (l + above))) };
        let next = above * (l + above) / root * ((cos - shift) * self.mantissa - lower * self.before);
        self.root = root;
        (self.before, self.mantissa) = (self.mantissa, next);
        if next.abs() > 1e100 {
            self.before *= 1e-100;
            self.mantissa *= 1e-100;
            self.scale += 100.0 * LN_10;
            self.size = self.scale.exp();
        }
    }
}
