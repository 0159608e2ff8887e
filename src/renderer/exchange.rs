//! The photo's way to the device and the picture's way back: straight, or through pixel buffers, so that the CPU does
//! not wait while a tile is under way.

use super::{Picture, offset};
use crate::frame::{Frame, Window};
use crate::gpu::pixels::PixelBuffer;
use crate::{Error, Result};

/// How pixels travel.
pub(super) struct Exchange {
    buffered: bool,
    up: Option<PixelBuffer>,
    /// Buffers for the way back that nothing is in.
    spare: Vec<PixelBuffer>,
}

impl Exchange {
    pub fn new(buffered: bool) -> Self {
        Self { buffered, up: None, spare: Vec::new() }
    }
}

/// A tile that is on its way back, if there is one.
#[derive(Default)]
#[must_use = "the pixels are not all there until they are collected"]
pub struct Pending(Option<UnderWay>);

struct UnderWay {
    buffer: PixelBuffer,
    window: Window,
    tile: Window,
}

impl Picture {
    /// Whether pictures go through pixel buffers from now on. By default they do unless the renderer is software.
    pub fn set_pixel_buffers(&mut self, buffered: bool) {
        self.exchange = Exchange::new(buffered);
    }

    /// Puts the photo of a frame that is small enough for one tile on the device, for [`Picture::draw`].
    ///
    /// # Errors
    /// [`Error::Gl`] where the frame is too large for one tile, or the driver refuses.
    pub fn load(&mut self, frame: Frame, pixels: &[[f32; 4]]) -> Result<()> {
        assert_eq!(pixels.len(), frame.window.pixels(), "as many pixels as the window has");
        let tile = self.only_tile(frame)?;
        self.upload(frame, tile, pixels)
    }

    /// Brings back what [`Picture::draw`] left on the device, of a frame that is small enough for one tile.
    ///
    /// # Errors
    /// [`Error::Gl`] where the frame is too large for one tile, nothing was drawn, or the driver refuses.
    pub fn fetch(&mut self, frame: Frame, pixels: &mut [[f32; 4]]) -> Result<()> {
        assert_eq!(pixels.len(), frame.window.pixels(), "as many pixels as the window has");
        let tile = self.only_tile(frame)?;
        let pending = self.read_back(frame, tile, pixels)?;
        self.collect(pending, pixels)
    }

    /// Waits for what [`Picture::submit`] left under way, and puts it among the same pixels.
    ///
    /// # Errors
    /// [`Error::Gl`] where the device failed meanwhile.
    pub fn collect(&mut self, pending: Pending, pixels: &mut [[f32; 4]]) -> Result<()> {
        let Pending(Some(UnderWay { mut buffer, window, tile })) = pending else { return Ok(()) };
        assert_eq!(pixels.len(), window.pixels(), "the pixels that were submitted");
        let (at, stride) = (offset(window, tile), window.width as usize);
        self.field.runner.run("readback", || buffer.drain(&mut pixels[at..], stride, tile.width, tile.height))?;
        self.exchange.spare.push(buffer);
        Ok(())
    }

    fn only_tile(&self, frame: Frame) -> Result<Window> {
        match self.field.photo_tiles(frame.window)[..] {
            [tile] => Ok(tile),
            _ => Err(Error::Gl("the picture does not fit one tile".into())),
        }
    }

    /// Puts a tile of the photo on the device.
    pub(super) fn upload(&mut self, frame: Frame, tile: Window, pixels: &[[f32; 4]]) -> Result<()> {
        let (at, stride) = (offset(frame.window, tile), frame.window.width as usize);
        let (pixels, width, height) = (&pixels[at..], tile.width, tile.height);
        let photo = self.composite.photo(&self.field.runner, width, height)?;
        if !self.exchange.buffered {
            self.field.runner.run("upload", || photo.write(pixels, stride, width, height));
            return Ok(());
        }
        let up = match &mut self.exchange.up {
            Some(up) => up,
            none => none.insert(PixelBuffer::new(self.field.runner.device())?),
        };
        self.field.runner.run("upload", || {
            up.fill(pixels, stride, width, height)?;
            photo.write_from(up, width, height);
            Ok(())
        })
    }

    /// Reads the tile that was drawn last, or begins to.
    pub(super) fn read_back(&mut self, frame: Frame, tile: Window, pixels: &mut [[f32; 4]]) -> Result<Pending> {
        let (window, width, height) = (frame.window, tile.width, tile.height);
        let picture = self.composite.drawn()?;
        if !self.exchange.buffered {
            let (at, stride) = (offset(window, tile), window.width as usize);
            self.field.runner.run("readback", || picture.read(&mut pixels[at..], stride, width, height));
            return Ok(Pending::default());
        }
        let mut buffer = match self.exchange.spare.pop() {
            Some(buffer) => buffer,
            None => PixelBuffer::new(self.field.runner.device())?,
        };
        self.field.runner.run("readback", || picture.read_to(&mut buffer, width, height))?;
        Ok(Pending(Some(UnderWay { buffer, window, tile })))
    }
}
