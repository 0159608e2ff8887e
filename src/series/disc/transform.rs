//! The round disc's transform. A smoothstep is a mixture of steps, so the disc is one of hard discs, and with what it falls by
//! at the radius R = 1 + ws/2, 3/4 (1 − s²) for each unit of −1 ≤ s ≤ 1, where w is the rim's width,
//!
//! ```text
//! ĝ(z) = 2π/z ∫ 3/4 (1 − s²) R J1(zR) ds
//! ```

use std::f64::consts::{PI, TAU};

use super::{Disc, HAIR};
use crate::series::bell::{Bounded, Radial, Shape as _};
use crate::series::nodes::between_nodes;
use crate::series::special::bessel_j;

/// Gauss's rule of 16 nodes, those above 0 and their weights (DLMF 3.5, Table 3.5.4 has those of 20 and fewer).
const GAUSS: [[f64; 2]; 8] = [
    [0.095_012_509_837_637_44, 0.189_450_610_455_068_5],
    [0.281_603_550_779_258_9, 0.182_603_415_044_923_6],
    [0.458_016_777_657_227_4, 0.169_156_519_395_002_54],
    [0.617_876_244_402_643_7, 0.149_595_988_816_576_73],
    [0.755_404_408_355_003, 0.124_628_971_255_533_87],
    [0.865_631_202_387_831_7, 0.095_158_511_682_492_78],
    [0.944_575_023_073_232_6, 0.062_253_523_938_647_89],
    [0.989_400_934_991_649_9, 0.027_152_459_411_754_095],
];

/// Radians that a wave may turn from the middle of a panel to its end: with 16 nodes it is then integrated to some 1e-14.
const PANEL: f64 = 8.0;

/// The largest of √x |J_n(x)|, n = 1, 2, 3, rounded up.
const LARGEST: [f64; 3] = [0.826, 0.869, 0.903];

impl Disc {
    /// R J1(zR)/z in the mean over the rim.
    fn mean_kernel(&self, z: f64) -> f64 {
        let kernel = |radius: f64| {
            let x = z * radius;
            radius * radius * if x < 1e-4 { 0.5 } else { bessel_j(1, x) / x }
        };
        if self.rim == 0.0 {
            return kernel(1.0);
        }
        let panels = (0.5 * self.rim * z / PANEL).ceil().max(1.0);
        let half = 1.0 / panels;
        let panel = |k: u32| {
            let middle = half * (2.0 * f64::from(k) + 1.0) - 1.0;
            let at = |s: f64| (1.0 - s * s) * kernel(1.0 + 0.5 * self.rim * s);
            GAUSS.iter().map(|[x, weight]| weight * (at(middle - half * x) + at(middle + half * x))).sum::<f64>()
        };
        0.75 * half * (0..panels as u32).map(panel).sum::<f64>()
    }

    /// How far a series is off at most beside the rim if it has all modes below z, and at the centre, which the whole rim
    /// sends its waves to.
    ///
    /// Along a line across the rim, waves faster than z are 2/π ∫ 3/a³ da with a = wz/2, of which the second derivative's
    /// two jumps have a half each.
    fn cut_off(&self, z: f64) -> f64 {
        // A hard rim's, which overshoots by a tenth.
        let hard = 0.6 + 1.0 / z.sqrt();
        let soft = 6.0 / PI / (self.rim * z).powi(2) * (1.6 + 6.0 / z.sqrt());
        hard.min(soft)
    }
}

impl Radial for Disc {
    fn transform(&self, z: f64) -> f64 {
        TAU * self.mean_kernel(z)
    }

    fn transforms(&self, at: &[f64]) -> Vec<f64> {
        between_nodes(at, self.ends(), |z| self.transform(z))
    }
}

impl Bounded for Disc {
    fn beyond(&self, z: f64, _cell: f64) -> f64 {
        self.cut_off(z)
    }

    /// The integral; then, by parts once, twice and three times over, with q = −(dg/dr)/r = 6/w³ (2 − r − oi/r) between the
    /// ends i and o of the rim,
    ///
    /// ```text
    /// |ĝ| ≤ 2π/z E[R |J1(zR)|],   2π/z² ∫ |q'| r² |J2| dr,   2π/z³ (6/w² (i |J3(zi)| + o |J3(zo)|) + 6/w³ ∫ (r + 3oi/r) |J3| dr)
    /// ```
    ///
    /// where √x |J_n(x)| is bounded.
    fn envelope(&self, z: f64) -> f64 {
        let [once, twice, thrice] = LARGEST;
        let bound = self.transform(0.0).min(TAU * once * z.powf(-1.5));
        if self.rim == 0.0 {
            return bound;
        }
        let (inner, outer) = (1.0 - 0.5 * self.rim, 1.0 + 0.5 * self.rim);
        let product = inner * outer;
        let steep = 6.0 / self.rim.powi(2);
        // ∫ |oi − r²| r^(−1/2) dr, which changes its sign between the ends.
        let part = |r: f64| (2.0 * product - 0.4 * r * r) * r.sqrt();
        let bent = (2.0 * part(product.sqrt()) - part(inner) - part(outer)).max(0.0) / self.rim;
        let ends = inner.sqrt() + outer.sqrt();
        let rest =
            2.0 / 3.0 * (outer.powf(1.5) - inner.powf(1.5)) + 6.0 * (outer * inner.sqrt() - inner * outer.sqrt());
        let twice = TAU * twice * steep * bent * z.powf(-2.5);
        let thrice = TAU * thrice * steep * (ends + rest / self.rim) * z.powf(-3.5);
        // Rims that are narrow cancel to a few digits.
        bound.min(1.01 * twice).min(HAIR * thrice)
    }

    fn end(&self) -> f64 {
        self.ends()
    }

    fn work(&self) -> f64 {
        100.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIMS: [f64; 9] = [0.0, 1e-6, 1e-3, 0.05, 0.3, 1.0, 1.7, 1.97, 2.0];

    fn disc(rim: f64) -> Disc {
        Disc::new(rim, 0, 0.0).unwrap()
    }

    /// By mpmath with 40 digits, from ∫ 2πr g(r) J0(zr) dr.
    #[test]
    fn transforms_are_those_of_forty_digits() {
        const TRUTH: [[f64; 3]; 10] = [
            [0.0, 3.7, 0.091_418_627_251_127_41],
            [0.05, 0.01, 3.141_946_053_473_507_3],
            [0.05, 12.5, -0.082_314_482_141_421_36],
            [0.05, 400.0, -3.588_148_551_121_487_5e-6],
            [0.3, 60.0, 1.748_578_265_003_608_4e-4],
            [1.0, 1.0, 2.815_087_021_361_229],
            [1.0, 25.0, 5.649_911_780_300_335e-4],
            [2.0, 0.5, 3.550_892_139_645_52],
            [2.0, 17.0, -4.885_794_992_638_897e-4],
            [2.0, 150.0, 1.801_330_085_019_777_7e-7],
        ];
        for [rim, z, expected] in TRUTH {
            let found = disc(rim).transform(z);
            assert!((found - expected).abs() < 3e-14, "{rim} at {z}: {found} {expected}");
        }
    }

    #[test]
    fn no_transform_is_beyond_its_envelope_which_never_grows() {
        for rim in RIMS {
            let disc = disc(rim);
            let mut last = f64::INFINITY;
            for k in 0..1500 {
                let z = 0.05 * 1.006f64.powi(k);
                let (transform, envelope) = (disc.transform(z).abs(), disc.envelope(z));
                assert!(transform <= envelope + 1e-13 && envelope <= last, "{rim} at {z}: {transform} {envelope}");
                last = envelope;
            }
        }
    }

    #[test]
    fn modes_beyond_are_no_more_than_their_bound() {
        // The series in the plane, of which all waves faster than z are left out: what is left is summed by midpoints.
        const STEP: f64 = 0.02;
        for rim in [0.2, 0.7, 1.0, 1.7, 1.95, 2.0] {
            let disc = disc(rim);
            let radii: Vec<f64> =
                (0..24).map(|i| if i < 8 { 0.02 * f64::from(i) } else { 0.06 * f64::from(i) }).collect();
            let mut sums = vec![0.0; radii.len()];
            let mut closest = 0.0f64;
            for k in 0..2000 {
                let z = STEP * (f64::from(k) + 0.5);
                let wave = STEP * z * disc.transform(z) / TAU;
                radii.iter().zip(&mut sums).for_each(|(r, sum)| *sum += wave * libm::j0(z * r));
                let bound = disc.beyond(z + 0.5 * STEP, 0.0);
                let off = radii.iter().zip(&sums).map(|(&r, sum)| (sum - disc.at(r)).abs()).fold(0.0, f64::max);
                assert!(z < 1.0 || off <= bound + 1e-4, "{rim} at {z}: {off} {bound}");
                closest = closest.max(if z < 1.0 { 0.0 } else { off / bound });
            }
            assert!(closest > 0.25, "{rim}: {closest}");
        }
    }
}
