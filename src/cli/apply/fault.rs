//! Faults on purpose, so that tests of the whole program can have a mistake that the program does not make.

use std::str::FromStr;

/// A panic in one step of one photo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    step: String,
    photo: usize,
}

impl FromStr for Fault {
    type Err = String;

    /// A step and the number of a photo, counted from 1, as `compute:2`.
    fn from_str(text: &str) -> Result<Self, String> {
        let (step, photo) = text.split_once(':').ok_or("expected STEP:PHOTO")?;
        Ok(Self { step: step.to_owned(), photo: photo.parse().map_err(|_| "expected a number after the colon")? })
    }
}

impl Fault {
    /// Panics where it is meant; `index` counts from 0.
    ///
    /// # Panics
    /// There.
    pub fn strike(fault: Option<&Self>, step: &str, index: usize) {
        let meant = fault.is_some_and(|fault| fault.step == step && fault.photo == index + 1);
        assert!(!meant, "a fault on purpose, in step {step}");
    }
}
