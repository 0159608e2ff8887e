//! What a photographer sets at a lens, and the sensor behind it.

use super::error::{OpticsError, Result};
use super::glass::LINE_D;

/// Wavelengths, in nm, at which a lens can be set up or traced: those of a camera, and a little beyond.
pub(super) const WAVELENGTHS: [f64; 2] = [300.0, 1200.0];

/// How a lens is used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// The f-number to which the stop is closed; none for wide open, for which one up to 1 % wider is taken as well.
    pub fstop: Option<f64>,
    /// The distance from the sensor to what is in focus, in m; none for infinity.
    pub focus: Option<f64>,
    /// Width and height of the sensor, in mm.
    pub sensor: [f64; 2],
    /// The wavelength at which focus, f-number and pupils are meant, in nm.
    pub wavelength: f64,
}

impl Default for Setup {
    /// Wide open and at infinity, before a sensor of 36 × 24 mm, at the d line.
    fn default() -> Self {
        Self { fstop: None, focus: None, sensor: [36.0, 24.0], wavelength: LINE_D }
    }
}

impl Setup {
    pub(super) fn check(&self) -> Result<()> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let fault = |reason: String| Err(OpticsError::Setup(reason));
        if let Some(fstop) = self.fstop.filter(|&fstop| !positive(fstop)) {
            return fault(format!("an f-number of {fstop} is not above 0"));
        }
        if let Some(focus) = self.focus.filter(|&focus| !positive(focus)) {
            return fault(format!("a focus at {focus} m is not before the sensor"));
        }
        let [width, height] = self.sensor;
        if !(positive(width) && positive(height) && width.max(height) <= 1e4) {
            return fault(format!("a sensor of {width} × {height} mm is none"));
        }
        check_wavelength(self.wavelength)
    }
}

/// Refuses a wavelength, in nm, that glass catalogues do not reach.
pub(super) fn check_wavelength(wavelength: f64) -> Result<()> {
    let [least, most] = WAVELENGTHS;
    if (least..=most).contains(&wavelength) {
        return Ok(());
    }
    Err(OpticsError::Setup(format!("a wavelength of {wavelength} nm is not from {least} to {most} nm")))
}
