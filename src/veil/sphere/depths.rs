//! How a kernel of the chord becomes a few of the distance on the stereographic image.
//!
//! The chord is c = 2 |a − b| exp(y/2), y = y_a + y_b the sum of two points' depths −ln(1 + |a|²). For an inverse square the depth is a
//! factor exp(−y_a) of the source times one of the target, and nothing else. What another kernel has besides is a slow function of y,
//! interpolated between a few values of it; a power of y is Σ of products of powers of y_a and of y_b. So the veil is a few
//! convolutions on the image, of sources times powers of their depth, times powers of the target's.

/// Values of the depth between which is interpolated.
#[derive(Debug, Clone)]
pub(in crate::veil) struct Depths {
    /// Depths of pairs, y.
    pub nodes: Vec<f64>,
    /// In the middle of them.
    pub middle: f64,
    /// For each node, the polynomial in y − `middle` that is 1 there and 0 at the others: coefficients from the constant on.
    pub polynomials: Vec<Vec<f64>>,
}

impl Depths {
    /// `count` nodes, as Chebyshev's between `least` and 0.
    pub fn new(least: f64, count: usize) -> Self {
        let middle = 0.5 * least;
        let node = |index: usize| middle * (1.0 - (std::f64::consts::PI * (index as f64 + 0.5) / count as f64).cos());
        let nodes: Vec<f64> = (0..count).map(node).collect();
        let polynomial = |index: usize| {
            let mut polynomial = vec![1.0];
            for (_, other) in nodes.iter().enumerate().filter(|(other, _)| *other != index) {
                let factor = 1.0 / (nodes[index] - other);
                let mut next = vec![0.0; polynomial.len() + 1];
                for (power, value) in polynomial.iter().enumerate() {
                    next[power] -= factor * (other - middle) * value;
                    next[power + 1] += factor * value;
                }
                polynomial = next;
            }
            polynomial
        };
        Self { polynomials: (0..count).map(polynomial).collect(), middle, nodes }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    /// Each node's share at a depth.
    pub fn shares(&self, depth: f64) -> impl Iterator<Item = f64> {
        let t = depth - self.middle;
        self.polynomials.iter().map(move |polynomial| polynomial.iter().rev().fold(0.0, |sum, value| sum * t + value))
    }

    /// What a power of the source's depth counts for a target at `depth` above half the middle, by a node's convolution.
    pub fn target(&self, node: usize, source: usize, depth: f64) -> f64 {
        let polynomial = &self.polynomials[node];
        let each = (source..polynomial.len()).rev();
        each.fold(0.0, |sum, power| sum * depth + binomial(power, source) * polynomial[power])
    }

    /// What the source plane of each power of the depth counts for a node's convolution, as it enters the target's power `target`.
    pub fn sources(&self, node: usize, target: usize) -> Vec<f64> {
        let polynomial = &self.polynomials[node];
        (target..polynomial.len()).map(|power| binomial(power, target) * polynomial[power]).collect()
    }
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).map(|index| (n - index) as f64 / (index + 1) as f64).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Products of powers sum to what is interpolated.
    #[test]
    fn sources_and_targets_share_the_polynomial() {
        let depths = Depths::new(-0.7, 3);
        let (a, b) = (-0.11, -0.29);
        let [source, target] = [a, b].map(|depth| depth - 0.5 * depths.middle);
        for (node, share) in depths.shares(a + b).enumerate() {
            let sum: f64 = (0..3)
                .map(|power| {
                    let sources = depths.sources(node, power);
                    target.powi(power as i32)
                        * sources.iter().enumerate().map(|(q, value)| value * source.powi(q as i32)).sum::<f64>()
                })
                .sum();
            assert!((sum - share).abs() < 1e-14);
        }
        assert!((depths.shares(-0.4).sum::<f64>() - 1.0).abs() < 1e-14);
    }
}
