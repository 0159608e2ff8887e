//! The picture on the device, looked at without bringing it back.

use std::rc::Rc;

use super::view::Wiped;
use super::{Part, Picture, Settings, View, convert};
use crate::Result;
use crate::frame::Frame;
use crate::gpu::mask::MaskPass;
use crate::gpu::overlay;
use crate::gpu::view::{Layers, View as Uniforms, ViewPass};
use crate::gpu::{Device, Region, Screen};

/// Shows pictures on a screen, again and again.
pub struct Live {
    /// What is shown.
    pub picture: Picture,
    view: ViewPass,
    pub(super) mask: MaskPass,
}

impl Live {
    /// Nothing to show yet.
    ///
    /// # Errors
    /// [`Error::Gl`](crate::Error::Gl) where the driver refuses an object.
    pub fn new(device: &Rc<Device>) -> Result<Self> {
        let picture = Picture::new(device)?;
        let runner = &picture.field.runner;
        let (view, mask) = (ViewPass::new(runner)?, MaskPass::new(runner)?);
        Ok(Self { picture, view, mask })
    }

    /// Shows what was drawn last in a region of the screen; the photo alone where nothing was drawn.
    ///
    /// # Errors
    /// [`crate::Error::Gl`] where no photo is loaded, or the driver refuses.
    pub fn view(&mut self, view: &View, screen: &Screen, region: Region) -> Result<()> {
        let [photo_stamp, picture_stamp] = self.picture.composite.stamps();
        let photo = (self.picture.composite.loaded()?, photo_stamp);
        let picture = self.picture.composite.drawn().ok().map(|picture| (picture, picture_stamp));
        // One of the two alone costs half the fetches.
        let (photo, picture) = match (picture, view.wiped(region)) {
            (None, _) | (_, Wiped::All) => (Some(photo), None),
            (picture, Wiped::Nothing) => (None, picture),
            (picture, Wiped::Part) => (Some(photo), picture),
        };
        let layers = Layers { size: self.picture.composite.size()?, photo, picture, field: None, overlay: Vec::new() };
        let defines = view.defines(&layers, region);
        let (uniforms, place) = (view.uniforms(region), view.place(region));
        self.view.draw(&self.picture.field.runner, &layers, &defines, &uniforms, &place, (screen, region))
    }

    /// Shows a part of the picture that [`Picture::draw`] or [`Picture::draw_glare`] would draw with settings that are
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
        self.picture.field.hold(frame)?;
        let composite = self.picture.start(frame, settings)?;
        let wiped = view.wiped(region);
        let photo = Some((self.picture.composite.loaded()?, self.picture.composite.stamps()[0]));
        let field = self.picture.field.values.drawn().filter(|_| wiped != Wiped::All);
        let photo = photo.filter(|_| part == Part::Picture || wiped != Wiped::Nothing);
        let count = if field.is_some() { self.picture.layers(settings) } else { 0 };
        let overlay = self.picture.composite.overlay.layers().take(count).collect();
        let layers = Layers { size: self.picture.composite.size()?, photo, picture: None, field, overlay };
        let mut defines = view.defines(&layers, region);
        if field.is_some() {
            defines.extend([("MIXED", "1"), ("NORMALIZE", convert::normalize(settings).0)]);
            defines.extend(overlay::defines(count));
            defines.extend((part == Part::Glare).then_some(("GLARE_ALONE", "1")));
        }
        let rgb = |[red, green, blue, _]: [f32; 4]| [red, green, blue];
        let uniforms = Uniforms {
            scale: rgb(composite.scale),
            constant: rgb(composite.constant),
            strength: composite.strength,
            flat: composite.flat,
            overlay: composite.overlay,
            ..view.uniforms(region)
        };
        self.view.draw(&self.picture.field.runner, &layers, &defines, &uniforms, &view.place(region), (screen, region))
    }

    /// Forgets the photo and the picture on the device.
    pub fn unload(&mut self) {
        self.picture.unload();
        self.view.unload();
    }
}
