//! What a picture's file says of the look that it was made by.

use super::Look;
use crate::photo::Made;
use crate::scene::to_toml;

impl Look {
    /// How a picture is made by this look, for its file: the look as a scene file has it, and a number that tells it from others. What a look is
    /// described as does not count.
    pub fn made(&self) -> Made {
        Made::new(&to_toml(&Self { description: String::new(), ..self.clone() }.to_scene()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_look_has_the_same_number_and_another_has_another() {
        let look = Look::default();
        let made = look.made();
        let described = Look { description: "warm".into(), ..look.clone() };
        assert_eq!(described.made(), made);
        let stronger = Look { strength: 1.5, ..look };
        assert_ne!(stronger.made().look, made.look);
        assert!(stronger.made().settings.contains("strength = 1.5"), "{}", stronger.made().settings);
    }
}
