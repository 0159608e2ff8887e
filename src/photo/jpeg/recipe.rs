//! The numbers that say how a gain map is to be applied, from XMP or from ISO 21496-1's binary form.

use roxmltree::{Document, ParsingOptions};

use super::tags;
use super::walk::Walk;

/// The name of ISO 21496-1's segments.
pub(super) const ISO: &[u8] = b"urn:iso:std:iso:ts:21496:-1\0";
/// The namespace of Adobe's and Ultra HDR's XMP.
const HDRGM: &str = "http://ns.adobe.com/hdr-gain-map/1.0/";
/// Gains beyond 2 ^ 20 have no meaning, and might overflow.
const MOST_STOPS: f32 = 20.0;

/// What is done with a gain map's codes, for each of red, green and blue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Recipe {
    /// Stops at code 0.
    min: [f32; 3],
    /// Stops at full code.
    max: [f32; 3],
    /// The exponent by which the map was encoded.
    gamma: [f32; 3],
    /// Added to the plain picture's light before the gain.
    before: [f32; 3],
    /// Taken off after it.
    after: [f32; 3],
}

impl Recipe {
    /// The recipe that a gain map's file holds; none if it is no gain map, and the reason where it cannot be applied.
    pub fn of(walk: &Walk) -> Option<Result<Self, &'static str>> {
        let text = tags::xmp(walk).filter(|xmp| is_named(xmp));
        let recipe = match text {
            Some(text) => Self::from_xmp(text),
            None => Self::from_iso(tags::app2(walk, ISO)?),
        };
        Some(recipe.and_then(Self::sound))
    }

    fn from_xmp(text: &str) -> Result<Self, &'static str> {
        let options = ParsingOptions { nodes_limit: 10_000, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options).map_err(|_| "has XMP that cannot be read")?;
        let numbers = |name, default: f32| three(&document, name, default).ok_or("has numbers that are none");
        let is_hdr = words(&document, "BaseRenditionIsHDR").is_some_and(|words| words[0].eq_ignore_ascii_case("true"));
        if is_hdr {
            return Err("leads from HDR to SDR, which vglare does not apply");
        }
        Ok(Self {
            min: numbers("GainMapMin", 0.0)?,
            max: numbers("GainMapMax", f32::NAN)?,
            gamma: numbers("Gamma", 1.0)?,
            before: numbers("OffsetSDR", 1.0 / 64.0)?,
            after: numbers("OffsetHDR", 1.0 / 64.0)?,
        })
    }

    /// Two versions of 16 bits, flags, then fractions: the two headrooms, and five numbers for one channel or three.
    fn from_iso(data: &[u8]) -> Result<Self, &'static str> {
        const THREE_CHANNELS: u8 = 0x80;
        const BACKWARD: u8 = 0x04;
        const ONE_DENOMINATOR: u8 = 0x08;
        let short = "has metadata that are cut short";
        let [v1, v0, _, _, flags, rest @ ..] = data else { return Err(short) };
        if [*v1, *v0] != [0, 0] {
            return Err("is of a newer version of ISO 21496-1 than vglare reads");
        }
        if flags & BACKWARD != 0 {
            return Err("leads from HDR to SDR, which vglare does not apply");
        }
        let mut words = rest.chunks_exact(4).map(|w| u32::from_be_bytes([w[0], w[1], w[2], w[3]]));
        let mut word = || words.next().ok_or(short);
        let common = if flags & ONE_DENOMINATOR == 0 { None } else { Some(word()?) };
        // Minimum, maximum and offsets are signed; no other number reaches half the range.
        let mut number = || -> Result<f32, &'static str> {
            let (above, below) = (word()? as i32, common.map_or_else(&mut word, Ok)?);
            Ok((f64::from(above) / f64::from(below)) as f32)
        };
        // The headrooms say for which displays the map is meant in part; here it is applied in full.
        number()?;
        number()?;
        let mut channels = [[0.0; 5]; 3];
        let count = if flags & THREE_CHANNELS == 0 { 1 } else { 3 };
        for channel in channels.iter_mut().take(count) {
            for value in channel {
                *value = number()?;
            }
        }
        if count == 1 {
            channels = [channels[0]; 3];
        }
        let of = |index: usize| channels.map(|channel| channel[index]);
        Ok(Self { min: of(0), max: of(1), gamma: of(2), before: of(3), after: of(4) })
    }

    fn sound(self) -> Result<Self, &'static str> {
        let within = |values: [f32; 3], most: f32| values.iter().all(|v| v.abs() <= most);
        let sound = within(self.min, MOST_STOPS)
            && within(self.max, MOST_STOPS)
            && within(self.before, 1.0)
            && within(self.after, 1.0)
            && self.gamma.iter().all(|g| (1e-3..=1e3).contains(g))
            && (0..3).all(|i| self.min[i] <= self.max[i]);
        if sound { Ok(self) } else { Err("has numbers that make no sense") }
    }

    /// The light of a channel of the plain picture where the map's code is `code`, 0..=1.
    pub fn light(&self, plain: f32, code: f32, channel: usize) -> f32 {
        let part = code.powf(1.0 / self.gamma[channel]);
        let stops = self.min[channel] * (1.0 - part) + self.max[channel] * part;
        (plain + self.before[channel]) * stops.exp2() - self.after[channel]
    }

    /// The most that white can become.
    pub fn most(&self) -> f32 {
        (0..3).map(|channel| self.light(1.0, 1.0, channel)).fold(0.0, f32::max)
    }

    /// Whether the three channels are treated alike.
    pub fn is_grey(&self) -> bool {
        [self.min, self.max, self.gamma, self.before, self.after].iter().all(|v| v[0] == v[1] && v[0] == v[2])
    }
}

/// Whether XMP speaks of a gain map of this kind.
pub(super) fn is_named(xmp: &str) -> bool {
    xmp.contains(HDRGM)
}

/// The values of a property: an attribute, an element, or an element with a list.
fn words<'a>(document: &'a Document, name: &str) -> Option<Vec<&'a str>> {
    document.descendants().find_map(|node| {
        if let Some(value) = node.attribute((HDRGM, name)) {
            return Some(vec![value.trim()]);
        }
        let here = node.is_element() && node.has_tag_name((HDRGM, name));
        let text = |node: roxmltree::Node<'a, '_>| node.text().map(str::trim).filter(|text| !text.is_empty());
        let listed = || node.descendants().filter(|node| node.is_text()).filter_map(text).collect::<Vec<_>>();
        here.then(listed).filter(|words| !words.is_empty())
    })
}

/// One number for all channels or one for each; none where they are no numbers.
fn three(document: &Document, name: &str, default: f32) -> Option<[f32; 3]> {
    let Some(words) = words(document, name) else { return Some([default; 3]) };
    let numbers = words.iter().map(|word| word.parse()).collect::<Result<Vec<f32>, _>>().ok()?;
    match numbers[..] {
        [all] => Some([all; 3]),
        [red, green, blue] => Some([red, green, blue]),
        _ => None,
    }
}
