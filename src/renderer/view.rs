//! The picture on the device, looked at without bringing it back.

use std::rc::Rc;

use glam::{DMat3, DVec2};

use super::{Renderer, Settings, convert};
use crate::Result;
use crate::frame::Frame;
use crate::gpu::field::Source;
use crate::gpu::view::View as Uniforms;
use crate::gpu::{Device, Region, Screen};
use crate::photo::ToneMap;

/// How a picture is looked at; the picture itself does not depend on it.
///
/// Magnified, a pixel of the photo is a square of the screen. Made smaller, a pixel of the screen shows the mean light
/// of all that fall on it, weighted by area; of more than 12 a side, rows and columns are left out evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Where the region's top left corner lies on the photo, in its pixels from its top left corner.
    pub origin: DVec2,
    /// The photo's pixels from one of the screen to the next; less than 1 magnifies.
    pub pitch: f64,
    /// Stops by which the light is raised first.
    pub exposure: f64,
    /// How light comes into the display's range next.
    pub tone_map: ToneMap,
    /// From the photo's primaries to Rec.709's, where they differ.
    pub gamut: Option<DMat3>,
    /// Columns of the region from this one on show what was drawn, those before it the photo as it was.
    pub wipe: f64,
    /// What surrounds the photo, RGB as it is shown, 0 to 1.
    pub surround: [f32; 3],
}

impl Renderer {
    /// Draws the field once and holds it: until the scene changes, [`Renderer::draw`] and [`Renderer::draw_glare`] of
    /// this frame look it up, and a change of settings costs no evaluation.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn hold_field(&mut self, frame: Frame) -> Result<()> {
        if self.held != Some(frame) {
            let source = self.evaluate(frame, frame.window)?;
            self.field.draw(&self.runner, source, frame.window.width, frame.window.height)?;
            self.held = Some(frame);
        }
        Ok(())
    }

    /// Readies the field of a whole frame: the one that is held, or the evaluator.
    pub(super) fn whole(&mut self, frame: Frame) -> Result<Source> {
        if self.held != Some(frame) {
            return self.evaluate(frame, frame.window);
        }
        self.field.bind();
        Ok(Source::HELD)
    }

    /// Draws the glare alone and leaves it on the device in the picture's place. Does not wait for it.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where the driver refuses, or where there is no scene.
    pub fn draw_glare(&mut self, frame: Frame, settings: &Settings) -> Result<()> {
        let uniforms = self.start(frame, settings)?;
        let source = self.whole(frame)?;
        let size = [frame.window.width, frame.window.height];
        self.composite.draw_glare(&self.runner, convert::variant(source, settings), &uniforms, size)?;
        Ok(())
    }

    /// Shows what was drawn last in a region of the screen; the photo alone where nothing was drawn.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where no photo is loaded, or the driver refuses.
    pub fn view(&mut self, view: &View, screen: &Screen, region: Region) -> Result<()> {
        let photo = self.composite.loaded()?;
        let picture = self.composite.drawn().unwrap_or(photo);
        let tone_map = match view.tone_map {
            ToneMap::None => "0",
            ToneMap::Reinhard => "1",
            ToneMap::Aces => "2",
            ToneMap::Agx => "3",
        };
        let (taps, stride) = taps(view.pitch);
        let text = taps.to_string();
        // The shader counts from the screen's corner.
        let corner = DVec2::new(f64::from(region.x), f64::from(region.y));
        let uniforms = Uniforms {
            gamut: view
                .gamut
                .unwrap_or(DMat3::IDENTITY)
                .to_cols_array_2d()
                .map(|[r, g, b]| [r as f32, g as f32, b as f32, 0.0]),
            origin: (view.origin - view.pitch * corner).as_vec2().to_array(),
            pitch: view.pitch as f32,
            rows: 0.0,
            surround: view.surround,
            gain: view.exposure.exp2() as f32,
            wipe: (view.wipe + corner.x) as f32,
            stride,
            pad: [0; 2],
        };
        let mut defines = vec![("TONE_MAP", tone_map)];
        if taps > 1 {
            defines.push(("TAPS", &text));
        }
        // One of the two alone costs half the fetches.
        let (left, right) = (view.wipe <= 0.0, view.wipe >= f64::from(region.width));
        if !left && !right {
            defines.push(("WIPE", "1"));
        }
        let picture = if right { photo } else { picture };
        if view.gamut.is_some() {
            // Not by the identity, which would spread what is not finite from one colour to all.
            defines.push(("GAMUT", "1"));
        }
        self.view.draw(&self.runner, [photo, picture], &defines, &uniforms, screen, region)
    }

    /// A pixel of the photo and of what was drawn last, linear; none where it is not on the device.
    pub fn pixel(&self, column: u32, row: u32) -> Option<[[f32; 4]; 2]> {
        let (photo, picture) = (self.composite.loaded().ok()?, self.composite.drawn().ok()?);
        let there = |width: u32, height: u32| column < width && row < height;
        let both = [photo, picture].iter().all(|texture| there(texture.level_width(0), texture.level_height(0)));
        both.then(|| [photo, picture].map(|texture| texture.read_texel([column, row])))
    }

    /// The spectrum: for each mode that the plan keeps, harmonic by harmonic of x, A, B, C and D of red, green and blue.
    /// Of a plan without a series it means nothing.
    pub(crate) fn spectrum_terms(&self) -> Vec<[f32; 4]> {
        self.spectrum.read()
    }

    /// The device that it renders on.
    pub fn device(&self) -> &Rc<Device> {
        self.runner.device()
    }

    /// Forgets the photo and the picture on the device.
    pub fn unload(&mut self) {
        self.composite.unload();
    }
}

/// Rows that a pixel of the screen looks at, and from one of them to the next; as many columns.
fn taps(pitch: f64) -> (u32, u32) {
    const MOST: u32 = 12;
    if pitch <= 1.0 {
        return (1, 1);
    }
    // Beginning anywhere in a row, it reaches into one more than it is wide.
    let touched = pitch.ceil() as u32 + 1;
    let stride = touched.div_ceil(MOST);
    (touched.div_ceil(stride), stride)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_that_is_touched_is_looked_at_up_to_twelve() {
        for (pitch, wanted) in
            [(0.3, (1, 1)), (1.0, (1, 1)), (1.2, (3, 1)), (11.0, (12, 1)), (11.5, (7, 2)), (64.0, (11, 6))]
        {
            assert_eq!(taps(pitch), wanted, "{pitch}");
        }
    }
}
