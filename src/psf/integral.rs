//! Integrals by an adaptive rule, in f64.

/// How often an interval is halved at most.
const DEEPEST: i32 = 40;
/// Into how many pieces an interval is cut at most.
const MOST_PIECES: usize = 4000;
/// The error that is aimed at, relative to the integral of the whole.
const RELATIVE: f64 = 1e-11;
/// A difference below this part of the integrand's size is rounding.
const ROUNDING: f64 = 1e-14;

/// Kronrod's rule of 15 points on −1..1, and Gauss's of 7 at every second of them (QUADPACK, Piessens et al. 1983): the
/// nodes that are not negative, from outside inwards, and the weights of both.
const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_83,
];
const GAUSS: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_64, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

/// ∫ f from `from` to `to`, halved where the two rules differ: until they agree within 1e-11 of the integral, or to
/// rounding.
pub(super) fn integral(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let whole = Piece::new(f, from, to, 0);
    let allowed = RELATIVE * whole.value.abs();
    let (mut sum, mut left) = (0.0, vec![whole]);
    let mut pieces = 1;
    while let Some(piece) = left.pop() {
        // What is no number is none in its halves either.
        let exact = !piece.error.is_finite() || piece.error <= allowed * 0.5_f64.powi(piece.depth);
        if exact || piece.depth == DEEPEST || pieces >= MOST_PIECES {
            sum += piece.value;
            continue;
        }
        let middle = 0.5 * (piece.from + piece.to);
        left.push(Piece::new(f, middle, piece.to, piece.depth + 1));
        left.push(Piece::new(f, piece.from, middle, piece.depth + 1));
        pieces += 1;
    }
    sum
}

/// ∫ f over `0..to` of something that changes little within `scale` and is smooth in the logarithm beyond.
pub(super) fn integral_from_zero(f: &impl Fn(f64) -> f64, scale: f64, to: f64) -> f64 {
    let near = scale.min(to);
    let inner = integral(f, 0.0, near);
    if to <= scale {
        return inner;
    }
    let logarithmic = |x: f64| {
        let at = x.exp();
        f(at) * at
    };
    inner + integral(&logarithmic, near.ln(), to.ln())
}

/// A part of the interval.
struct Piece {
    from: f64,
    to: f64,
    depth: i32,
    /// Kronrod's.
    value: f64,
    /// How far Gauss's is from it; 0 where that is rounding.
    error: f64,
}

impl Piece {
    fn new(f: &impl Fn(f64) -> f64, from: f64, to: f64, depth: i32) -> Self {
        let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
        let middle = f(centre);
        let (mut kronrod, mut gauss) = (KRONROD[7] * middle, GAUSS[3] * middle);
        let mut size = kronrod.abs();
        for (i, node) in NODES[..7].iter().enumerate() {
            let [low, high] = [f(centre - half * node), f(centre + half * node)];
            kronrod += KRONROD[i] * (low + high);
            size += KRONROD[i] * (low.abs() + high.abs());
            if i % 2 == 1 {
                gauss += GAUSS[i / 2] * (low + high);
            }
        }
        let error = (kronrod - gauss).abs();
        Self {
            from,
            to,
            depth,
            value: kronrod * half,
            error: if error <= ROUNDING * size { 0.0 } else { error * half.abs() },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polynomials up to degree 22 by one rule, and what is known in closed form by halving.
    #[test]
    fn integrals_are_those_that_are_known() {
        for degree in 0..=22 {
            let value = Piece::new(&|x: f64| x.powi(degree), 0.0, 1.0, 0).value;
            assert!((value * f64::from(degree + 1) - 1.0).abs() < 1e-14, "x^{degree}: {value}");
        }
        let peak = integral(&|x: f64| 1e-4 / (x * x + 1e-8), -1.0, 2.0);
        assert!((peak / (2e4_f64.atan() + 1e4_f64.atan()) - 1.0).abs() < 1e-10, "{peak}");
        let wide = integral_from_zero(&|x: f64| x / (1.0 + x * x).powf(1.5), 1.0, 1e6);
        assert!((wide - (1.0 - 1e-6)).abs() < 1e-11, "{wide}");
    }
}
