//! False colours: numbers from 0 to 1 → colours, for charts and for maps in the window.

/// How numbers become colours. All maps are perceptually uniform: equal steps look equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Map {
    /// Dark violet to yellow; for what begins somewhere and grows.
    #[default]
    Viridis,
    /// Black over violet and orange to pale yellow; for light.
    Inferno,
    /// Blue over white to red; for errors, whose middle is 0.
    RedBlue,
    /// Black to white.
    Grey,
}

impl Map {
    /// The colour at 0 to 1; beyond these, that of the nearer end.
    pub fn colour(self, place: f64) -> [u8; 3] {
        let place = place.clamp(0.0, 1.0);
        let colour = match self {
            Self::Viridis => colorous::VIRIDIS.eval_continuous(place),
            Self::Inferno => colorous::INFERNO.eval_continuous(place),
            Self::RedBlue => colorous::RED_BLUE.eval_continuous(1.0 - place),
            Self::Grey => return [(255.0 * place).round() as u8; 3],
        };
        [colour.r, colour.g, colour.b]
    }
}
