//! The picture on the device, looked at without bringing it back.

use std::rc::Rc;

use glam::{DMat3, DVec2};

use super::{Renderer, Settings, convert};
use crate::Result;
use crate::frame::Frame;
use crate::gpu::field::Source;
use crate::gpu::shrink::Place;
use crate::gpu::view::{Layers, View as Uniforms};
use crate::gpu::{Device, Region, Screen};
use crate::photo::ToneMap;

/// What is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The photo with its glare.
    Picture,
    /// The glare alone.
    Glare,
}

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
            let bands = self.tiles(frame.window).len() as u32;
            self.field.draw_in_bands(&self.runner, source, [frame.window.width, frame.window.height], bands)?;
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
        let [photo_stamp, picture_stamp] = self.composite.stamps();
        let photo = (self.composite.loaded()?, photo_stamp);
        let picture = self.composite.drawn().ok().map(|picture| (picture, picture_stamp));
        // One of the two alone costs half the fetches.
        let (photo, picture) = match (picture, view.wiped(region)) {
            (None, _) | (_, Wiped::All) => (Some(photo), None),
            (picture, Wiped::Nothing) => (None, picture),
            (picture, Wiped::Part) => (Some(photo), picture),
        };
        let layers = Layers { size: self.composite.size()?, photo, picture, field: None };
        let defines = view.defines(&layers, region);
        let (uniforms, place) = (view.uniforms(region), view.place(region));
        self.view.draw(&self.runner, &layers, &defines, &uniforms, &place, (screen, region))
    }

    /// Shows a part of the picture that [`Renderer::draw`] or [`Renderer::draw_glare`] would draw with settings that are
    /// [affine](Settings::is_affine), from the photo and the field that is held, without drawing it: within rounding the
    /// same, and a change of settings costs the pixels of the screen and none of the photo. A frame of fewer pixels than the
    /// photo's gives a field that is as coarse.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where there is no scene or no photo is loaded, or the driver refuses.
    ///
    /// # Panics
    /// If the settings are not affine.
    pub fn view_mixed(
        &mut self,
        frame: Frame,
        settings: &Settings,
        part: Part,
        view: &View,
        screen: &Screen,
        region: Region,
    ) -> Result<()> {
        assert!(settings.is_affine(), "the mean of these pixels is none of means");
        self.hold_field(frame)?;
        let composite = self.start(frame, settings)?;
        let wiped = view.wiped(region);
        let photo = Some((self.composite.loaded()?, self.composite.stamps()[0]));
        let field = self.field.drawn().filter(|_| wiped != Wiped::All);
        let photo = photo.filter(|_| part == Part::Picture || wiped != Wiped::Nothing);
        let layers = Layers { size: self.composite.size()?, photo, picture: None, field };
        let mut defines = view.defines(&layers, region);
        if field.is_some() {
            defines.extend([("MIXED", "1"), ("NORMALIZE", convert::normalize(settings))]);
            defines.extend((part == Part::Glare).then_some(("GLARE_ALONE", "1")));
        }
        let rgb = |[red, green, blue, _]: [f32; 4]| [red, green, blue];
        let uniforms = Uniforms {
            scale: rgb(composite.scale),
            constant: rgb(composite.constant),
            strength: composite.strength,
            flat: composite.flat,
            ..view.uniforms(region)
        };
        self.view.draw(&self.runner, &layers, &defines, &uniforms, &view.place(region), (screen, region))
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

    /// The constant term of the field's series, RGB: its mean over a period. None where the plan has no series.
    pub fn constant_term(&self) -> Option<[f64; 3]> {
        let plan = self.scene.as_ref().filter(|plan| plan.series().is_some())?;
        let terms = self.spectrum.read();
        Some([0, 1, 2].map(|colour| f64::from(terms[colour][0]) * plan.scale[colour]))
    }

    /// The device that it renders on.
    pub fn device(&self) -> &Rc<Device> {
        self.runner.device()
    }

    /// Forgets the photo and the picture on the device.
    pub fn unload(&mut self) {
        self.composite.unload();
        self.view.unload();
    }
}

/// What part of a region shows the photo as it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wiped {
    Nothing,
    Part,
    All,
}

impl View {
    fn wiped(&self, region: Region) -> Wiped {
        match self.wipe {
            wipe if wipe <= 0.0 => Wiped::Nothing,
            wipe if wipe >= f64::from(region.width) => Wiped::All,
            _ => Wiped::Part,
        }
    }

    fn place(&self, region: Region) -> Place {
        Place { origin: self.origin, pitch: self.pitch, size: [region.width, region.height] }
    }

    /// What the shader is specialised with for this view of these layers.
    fn defines(&self, layers: &Layers<'_>, region: Region) -> Vec<(&'static str, &'static str)> {
        let tone_map = match self.tone_map {
            ToneMap::None => "0",
            ToneMap::Reinhard => "1",
            ToneMap::Aces => "2",
            ToneMap::Agx => "3",
        };
        let mut defines = vec![("TONE_MAP", tone_map)];
        if layers.picture.is_none() && layers.field.is_none() {
            defines.push(("BEFORE", "1"));
        } else if self.wiped(region) == Wiped::Part {
            defines.push(("WIPE", "1"));
        }
        if self.gamut.is_some() {
            // Not by the identity, which would spread what is not finite from one colour to all.
            defines.push(("GAMUT", "1"));
        }
        defines
    }

    /// The uniforms, without those that a field needs.
    fn uniforms(&self, region: Region) -> Uniforms {
        // The shader counts from the screen's corner.
        let corner = DVec2::new(f64::from(region.x), f64::from(region.y));
        let gamut = self.gamut.unwrap_or(DMat3::IDENTITY).to_cols_array_2d();
        Uniforms {
            gamut: gamut.map(|[r, g, b]| [r as f32, g as f32, b as f32, 0.0]),
            origin: (self.origin - self.pitch * corner).as_vec2().to_array(),
            pitch: self.pitch as f32,
            surround: self.surround,
            gain: self.exposure.exp2() as f32,
            wipe: (self.wipe + corner.x) as f32,
            ..bytemuck::Zeroable::zeroed()
        }
    }
}
