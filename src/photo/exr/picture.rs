//! Blocks into pixels and kept channels.

use exr::math::Vec2;
use exr::meta::attribute::IntegerBounds;
use exr::meta::header::Header;

use super::super::read::check_size;
use super::super::{Reason, zeroed};
use super::chroma::{self, Plane};
use super::layer::{Colours, Layer, Role};
use super::lines::Scratch;
use super::unpack::{self, lines};

/// For each channel of a part, its samples in the machine's byte order, row by row, if they are carried.
pub(super) type Planes = Vec<Option<Vec<u8>>>;

/// The samples of the picture's parts, as far as they are read.
pub(super) struct Picture<'h> {
    headers: &'h [Header],
    layer: &'h Layer,
    pixels: Vec<[f32; 4]>,
    planes: Vec<Planes>,
    /// For each member and channel, a colour's samples where they are fewer than the pixels.
    small: Vec<Vec<Option<Plane>>>,
    scratch: Scratch,
}

impl<'h> Picture<'h> {
    /// An empty one.
    ///
    /// # Errors
    /// Where it is too large to be true, or to be held.
    pub fn new(layer: &'h Layer, headers: &'h [Header]) -> Result<Self, Reason> {
        let Vec2(width, height) = headers[layer.part()].layer_size;
        let count = check_size(u32::try_from(width)?, u32::try_from(height)?)?;
        let (mut planes, mut small) = (Vec::new(), Vec::new());
        for member in &layer.members {
            let (mut kept, mut fewer) = (Planes::new(), Vec::new());
            for (index, channel) in headers[member.part].channels.list.iter().enumerate() {
                let (columns, rows) = unpack::plane(channel, headers[member.part].layer_size);
                let is_small = channel.sampling != Vec2(1, 1);
                let is_colour = member.roles[index] != Role::Other;
                let carried = member.carries(index, channel) && !(is_small && is_colour);
                let bytes = columns * rows * channel.sample_type.bytes_per_sample();
                kept.push(carried.then(|| zeroed(bytes)).transpose()?);
                let sampling = (channel.sampling.x(), channel.sampling.y());
                let plane = || Ok::<_, Reason>(Plane { samples: zeroed(columns * rows)?, width: columns, sampling });
                fewer.push((is_small && is_colour).then(plane).transpose()?);
            }
            planes.push(kept);
            small.push(fewer);
        }
        Ok(Self { headers, layer, pixels: zeroed(count)?, planes, small, scratch: Scratch::default() })
    }

    /// Takes a decompressed block that covers `area` of a member's part.
    pub fn insert(&mut self, member: usize, area: IntegerBounds, bytes: &[u8]) {
        let header = &self.headers[self.layer.members[member].part];
        let width = header.layer_size.width();
        let opaque = !self.layer.has_alpha();
        for line in lines(&header.channels, area) {
            let channel = &header.channels.list[line.channel];
            let (kind, columns) = (channel.sample_type, unpack::plane(channel, header.layer_size).0);
            let (start, value) = (line.at.1 * columns + line.at.0, &bytes[line.bytes]);
            if let Some(plane) = &mut self.planes[member][line.channel] {
                plane[start * kind.bytes_per_sample()..][..value.len()].copy_from_slice(value);
            }
            let role = self.layer.members[member].roles[line.channel];
            if role == Role::Other {
                continue;
            }
            self.scratch.load(value, kind);
            let float = &self.scratch.float;
            if let Some(plane) = &mut self.small[member][line.channel] {
                plane.samples[start..][..line.count].copy_from_slice(float);
                continue;
            }
            let pixels = &mut self.pixels[line.at.1 * width + line.at.0..][..line.count];
            match role {
                Role::Component(component) | Role::Chroma(component) => {
                    pixels.iter_mut().zip(float).for_each(|(pixel, &v)| pixel[component] = v);
                }
                // Chroma, whose rows come before, takes two of the three.
                Role::Luminance if self.layer.colours == Colours::LumaChroma => {
                    pixels.iter_mut().zip(float).for_each(|(pixel, &v)| pixel[1] = v);
                }
                _ => pixels.iter_mut().zip(float).for_each(|(pixel, &v)| pixel[..3].fill(v)),
            }
            if opaque {
                pixels.iter_mut().for_each(|pixel| pixel[3] = 1.0);
            }
        }
    }

    /// The pixels, and for each member the channels that are carried. `weights` are the shares of red, green and blue
    /// in luminance.
    pub fn finish(self, weights: [f64; 3], has_gaps: bool) -> (Vec<[f32; 4]>, Vec<Planes>) {
        let Self { headers, layer, mut pixels, planes, small, .. } = self;
        let width = headers[layer.part()].layer_size.width();
        for (member, small) in layer.members.iter().zip(small) {
            for (role, plane) in member.roles.iter().zip(small) {
                match (role, plane) {
                    (Role::Component(component) | Role::Chroma(component), Some(plane)) => {
                        chroma::enlarge(&mut pixels, width, *component, &plane);
                    }
                    (Role::Luminance, Some(plane)) => {
                        let all = if layer.colours == Colours::LumaChroma { 1..2 } else { 0..3 };
                        all.for_each(|component| chroma::enlarge(&mut pixels, width, component, &plane));
                    }
                    _ => {}
                }
            }
        }
        if layer.colours == Colours::LumaChroma {
            chroma::to_rgb(&mut pixels, weights);
        }
        if !layer.has_alpha()
            && (has_gaps || layer.members.iter().any(|m| !unpack::is_plain(&headers[m.part].channels)))
        {
            pixels.iter_mut().for_each(|pixel| pixel[3] = 1.0);
        }
        (pixels, planes)
    }
}
