//! ICC profiles: from a profile's encoding to linear light of Rec.709 primaries.
//!
//! \[ICC\] ICC.1:2022, Image technology colour management, profile version 4.4.
//!
//! Profiles are parsed by moxcms. Those of three curves and a matrix, or of one curve for grey, are evaluated here in
//! f64: black is exactly black. Those of tables (A2B0, A2B1, A2B2) go through moxcms, relative colorimetric.

mod head;
mod shape;
mod tables;
mod written;

use super::decode::{Encoding, Shaper};
use super::transfer::Curve;
use super::{ReadOptions, Reason};
use tables::Tables;

pub(super) use head::{LARGEST, is_grey, tell_lab};
pub(super) use written::{profile_of, srgb_profile};

/// The way from an ICC profile to linear light.
pub(super) struct Profile {
    way: Way,
    /// What the profile calls itself.
    name: Option<String>,
    /// As it stands in the file.
    bytes: Vec<u8>,
}

pub(super) enum Way {
    /// Three curves and a matrix; for grey, the same curve three times.
    Shaper(Box<Shaper>),
    /// Tables: 0..=1 in.
    Tables(Tables),
}

/// What an embedded profile says of samples that are `grey` or RGB: sRGB with a note where it says nothing of use.
///
/// Where `options` name primaries, only the profile's curves count.
pub(super) fn encoding(
    icc: &[u8],
    grey: bool,
    fallback: Curve,
    options: &ReadOptions,
    notes: &mut Vec<String>,
) -> Encoding {
    let named = || head::name(icc).map(|name| format!(", {name},")).unwrap_or_default();
    let instead = match (&fallback, options.primaries) {
        (_, Some(_)) => "sRGB's curve is taken",
        (Curve::Linear, _) => "its numbers are taken as linear light of Rec. 709",
        _ => "its colours are taken as sRGB",
    };
    match (Profile::new(icc, grey), options.primaries) {
        (Ok(Some(Profile { way: Way::Shaper(shaper), .. })), Some(primaries)) => {
            return Encoding::Curves(Box::new(Shaper::new(shaper.curves, Some(primaries))));
        }
        (Ok(Some(profile)), None) => return Encoding::Icc(profile),
        (Ok(Some(_)), Some(_)) => {
            notes.push(format!(
                "its ICC profile{} holds tables, which do not go with other primaries; {instead}",
                named()
            ));
        }
        (Ok(None), _) => {
            let space = head::space(icc);
            let samples = if grey { "grey" } else { "RGB" };
            notes.push(format!("its ICC profile{} is for {space}, not for {samples}; {instead}", named()));
        }
        (Err(reason), _) => notes.push(format!("its ICC profile{} {reason}; {instead}", named())),
    }
    Encoding::new(fallback, options.primaries)
}

impl Profile {
    /// The way of an embedded profile; none if it is for other than RGB or grey samples (a decoder has converted them).
    ///
    /// # Errors
    /// Where the profile is damaged or of a kind that moxcms cannot read; the reason goes on after "its ICC profile".
    fn new(icc: &[u8], grey_samples: bool) -> Result<Option<Self>, Reason> {
        let space = head::check(icc)?;
        if space != *b"RGB " && !(space == *b"GRAY" && grey_samples) {
            return Ok(None);
        }
        let name = head::name(icc);
        let profile = head::parse(icc)?;
        let way = match tables::of(&profile) {
            Some(tables) => Way::Tables(tables?),
            None => Way::Shaper(Box::new(shape::shaper(&profile, name.as_deref())?)),
        };
        Ok(Some(Self { way, name, bytes: icc.to_vec() }))
    }

    pub fn way(&self) -> &Way {
        &self.way
    }

    /// The profile itself.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The colour space, where its primaries are not Rec.709's.
    pub fn space(&self) -> Option<&String> {
        match &self.way {
            Way::Shaper(shaper) => shaper.space.as_ref(),
            Way::Tables(_) => self.name.as_ref(),
        }
    }

    /// The light of a row of encoded colours.
    pub fn to_light(&self, colours: &[[f32; 3]]) -> Result<Vec<[f32; 3]>, Reason> {
        match &self.way {
            Way::Shaper(shaper) => Ok(colours.iter().map(|&colour| shape::light(shaper, colour)).collect()),
            Way::Tables(tables) => tables.light(colours),
        }
    }
}

#[cfg(test)]
mod tests;
