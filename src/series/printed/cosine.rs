//! cos²x cos²y of 000: the printed integral without its limits, and the C++ with its slips.

use std::f64::consts::PI;

use super::even_table;

/// Which slips of 000's C++ are made; each can be looked at by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slips {
    /// `n*n*n*w*w*w*w`: ω has one power too many, [`cosine_factor`].
    pub fourth_power: bool,
    /// The loop that is meant to set κ always sets 4, [`cosine_kappas`].
    pub kappa: bool,
    /// `n < N` and `m < M`: the last harmonic of the printed sums is left out.
    pub short_loops: bool,
}

impl Slips {
    /// The program as it is printed.
    pub const ALL: Self = Self { fourth_power: true, kappa: true, short_loops: true };
    /// The program as it is meant; the arithmetic is still the C++'s, with a float for ω.
    pub const NONE: Self = Self { fourth_power: false, kappa: false, short_loops: false };
}

/// What becomes of the 0-th terms, which 000 leaves out against "spreading" without saying which they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Zeroth {
    /// They stay.
    Kept,
    /// The mean, mode (0, 0), is left out: "DC".
    MeanDropped,
    /// All modes with an index 0 are left out: with κ = 4 for all, the field is then (u − α_0)(v − α_0).
    EdgesDropped,
}

/// 4 sin(πq/2) / (4q − q³) for ∫ cos²x cos qx dx over |x| ≤ π/2, as 000 prints it for n > 0; q = nω.
///
/// Right, but at q = 2 (T = nπ) it divides what is left of sin π by 0, where the limit is π/4; and it is NaN at q = 0, for which
/// the note gives π/2.
pub fn cosine_integral(q: f64) -> f64 {
    4.0 * (0.5 * PI * q).sin() / (4.0 * q - q * q * q)
}

/// `coef_n` of 000's C++ for the float `omega`: the integral that [`cosine_integral`] is, with ω⁴ for ω³ in the
/// denominator where `fourth_power`.
///
/// The types are the program's: n³ is an `int` and wraps from n = 1291 on, and its product with ω a float. Nothing guards
/// the division by 0 at nω = 2. At T = 6 the fourth power is off by +1.8 %, −35 %, −7.4 %, −5.8 % for n = 1 … 4.
pub fn cosine_factor(omega: f32, n: u32, fourth_power: bool) -> f64 {
    if n == 0 {
        return 0.5 * PI;
    }
    let n = n as i32;
    let cube = n.wrapping_mul(n).wrapping_mul(n) as f32 * omega * omega * omega;
    let power = if fourth_power { cube * omega } else { cube };
    let (n, w) = (f64::from(n), f64::from(omega));
    4.0 * (PI * n * w / 2.0).sin() / (4.0 * n * w - f64::from(power))
}

/// `ka` of 000's C++ for m = 0 .. `rows` and n = 0 .. `columns`, loop by loop: \[m\]\[n\].
///
/// `n_ka` and `m_ka` begin with 1 and become 2 where they, instead of n and m, are not 0: at once. κ is 4 everywhere, so
/// that the field of a bell u(x) v(y) becomes (u + α_0)(v + α_0): a cross and a haze that never end.
pub fn cosine_kappas(columns: usize, rows: usize) -> Vec<Vec<f32>> {
    let (mut n_ka, mut m_ka) = (1.0_f32, 1.0_f32);
    let mut kappas = vec![vec![0.0; columns]; rows];
    for row in &mut kappas {
        if n_ka != 0.0 {
            n_ka = 2.0;
        }
        for ka in row {
            if m_ka != 0.0 {
                m_ka = 2.0;
            }
            *ka = n_ka * m_ka;
        }
    }
    kappas
}

/// The table (a, b, p, r) of cos²x cos²y, |x|, |y| ≤ π/2, by 000's C++ with the slips that are asked for.
pub fn cosine_table(slips: Slips, zeroth: Zeroth, period: f64, degree: [u32; 2]) -> Vec<[f64; 4]> {
    let period = period as f32;
    let omega = 2.0 * std::f32::consts::PI / period;
    let printed = cosine_kappas(degree[0] as usize + 1, degree[1] as usize + 1);
    even_table(degree, |n, m| {
        let left_out = match zeroth {
            Zeroth::Kept => false,
            Zeroth::MeanDropped => n == 0 && m == 0,
            Zeroth::EdgesDropped => n == 0 || m == 0,
        };
        if left_out || slips.short_loops && (n == degree[0] || m == degree[1]) {
            return 0.0;
        }
        let kappa = if slips.kappa { f64::from(printed[m as usize][n as usize]) } else { crate::series::kappa(n, m) };
        let factor = |n| cosine_factor(omega, n, slips.fourth_power);
        factor(n) * factor(m) * kappa / f64::from(period * period)
    })
}
