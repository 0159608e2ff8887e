//! A point-spread function by the square of the chord, with its slopes.

/// Places in each octave of the square.
const PLACES: u32 = 6;
const REST: u32 = f64::MANTISSA_DIGITS - 1 - PLACES;

/// The least square that is tabled, of a chord of a hundred thousandth; nearer than that no light is.
const LEAST: f64 = 1e-10;

/// k by q = |u − v|², by a cubic between even places in each octave of q.
#[derive(Debug)]
pub(crate) struct Tabled {
    first: u64,
    /// The middle of each interval, and the coefficients of the cubic about it.
    pieces: Vec<[f64; 5]>,
}

/// k, its second slope by q, and the size of the third.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slopes {
    pub value: f64,
    pub second: f64,
    pub third: f64,
}

impl Tabled {
    /// Of a function of the angle in degrees.
    pub fn new(k: impl Fn(f64) -> f64) -> Self {
        let of = |square: f64| k((0.5 * square.min(4.0).sqrt()).min(1.0).asin().to_degrees() * 2.0);
        let (first, last) = (LEAST.to_bits() >> REST, 4f64.to_bits() >> REST);
        let piece = |place: u64| {
            let [low, high] = [place, place + 1].map(|place| f64::from_bits(place << REST));
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            // Through the four nodes of Chebyshev, which come close to the best cubic.
            let nodes = [0.923_879_532_511_286_7, 0.382_683_432_365_089_8];
            let [a, b] = nodes;
            let [outer, inner] = nodes.map(|node| [of(middle - half * node), of(middle + half * node)]);
            let (even, odd) = (|[l, h]: [f64; 2]| 0.5 * (h + l), |[l, h]: [f64; 2]| 0.5 * (h - l));
            let second = (even(outer) - even(inner)) / (a * a - b * b);
            let constant = even(inner) - second * b * b;
            let third = (odd(outer) / a - odd(inner) / b) / (a * a - b * b);
            let slope = odd(inner) / b - third * b * b;
            [middle, constant, slope / half, second / half.powi(2), third / half.powi(3)]
        };
        Self { first, pieces: (first..=last).map(piece).collect() }
    }

    /// k at the square of a chord.
    #[inline]
    pub fn value(&self, square: f64) -> f64 {
        let ([middle, a, b, c, d], square) = self.piece(square);
        let x = square - middle;
        a + x * (b + x * (c + x * d))
    }

    /// k and its slopes at the square of a chord.
    #[inline]
    pub fn at(&self, square: f64) -> Slopes {
        let ([middle, a, b, c, d], square) = self.piece(square);
        let x = square - middle;
        Slopes { value: a + x * (b + x * (c + x * d)), second: 2.0 * c + 6.0 * x * d, third: 6.0 * d.abs() }
    }

    /// The coefficients of a cubic about the square of a chord, from the constant on, which is k on the interval in which that lies.
    pub fn cubic(&self, square: f64) -> [f64; 4] {
        let ([middle, a, b, c, d], square) = self.piece(square);
        let x = square - middle;
        [a + x * (b + x * (c + x * d)), b + x * (2.0 * c + 3.0 * x * d), c + 3.0 * x * d, d]
    }

    #[inline]
    fn piece(&self, square: f64) -> ([f64; 5], f64) {
        let square = square.max(LEAST);
        let place = ((square.to_bits() >> REST) - self.first) as usize;
        (self.pieces[place.min(self.pieces.len() - 1)], square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::psf::{Observer, Psf};

    #[test]
    fn a_tabled_function_is_the_function_and_its_slopes() {
        let psf = Psf::cie(Observer::new(25.0, 0.5).unwrap());
        let tabled = Tabled::new(|angle| psf.value(angle));
        for step in 0..2000 {
            let angle = 0.15 * 1000f64.powf(f64::from(step) / 2000.0);
            let square = |angle: f64| 4.0 * (0.5 * angle.to_radians()).sin().powi(2);
            let (at, known) = (tabled.at(square(angle)), psf.value(angle));
            assert!((at.value / known - 1.0).abs() < 1e-6, "{angle}: {} for {known}", at.value);
            // A hundredth further, by the slopes.
            let way = 0.01 * square(angle);
            let by = at.value + way * (tabled.cubic(square(angle))[1] + 0.5 * way * at.second);
            let further = tabled.at(square(angle) + way).value;
            assert!((by / further - 1.0).abs() < 2e-5, "{angle}: {by} for {further}");
        }
    }
}
