//! Photos for tests.

/// Numbers that look random, the same in every run: splitmix64.
pub(super) struct Dice(pub u64);

impl Dice {
    pub fn integer(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 to 1.
    pub fn share(&mut self) -> f64 {
        (self.integer() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn below(&mut self, end: usize) -> usize {
        (self.integer() % end as u64) as usize
    }

    pub fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.share()
    }
}

/// Dim noise with black parts, and `lights` that are up to 10^`decades` times as bright; RGB.
pub(super) fn photo(dice: &mut Dice, size: [usize; 2], lights: usize, decades: f64) -> Vec<f32> {
    let pixels = size[0] * size[1];
    let black = dice.share() < 0.5;
    let noise = |dice: &mut Dice| if black { 0.0 } else { dice.between(0.0, 1.0).powi(6) as f32 };
    let mut values: Vec<f32> = (0..3 * pixels).map(|_| noise(dice)).collect();
    for _ in 0..lights {
        let at = 3 * dice.below(pixels);
        for channel in 0..3 {
            values[at + channel] = 10f64.powf(dice.between(0.0, decades)) as f32;
        }
    }
    values
}
