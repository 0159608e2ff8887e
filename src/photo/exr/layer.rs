//! Which channels of a file are the picture.

use exr::meta::attribute::{ChannelDescription, SampleType};
use exr::meta::header::Header;

use super::super::Reason;

/// The part and the channels that the photo's pixels are made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Layer {
    /// Index of the part.
    pub part: usize,
    /// What the channels' names begin with: nothing, or a layer's name and a dot.
    pub prefix: String,
    /// For each channel of the part, what it is.
    pub roles: Vec<Role>,
}

/// What a channel is to the photo.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Red, green, blue or alpha: 0 to 3.
    Component(usize),
    /// Luminance, which is all three colours.
    Luminance,
    /// Something else, to be carried along.
    Other,
}

/// Layers of these names are the finished picture, where a file has many.
const FINISHED: [&str; 8] = ["combined", "beauty", "composite", "rgba", "rgb", "main", "image", "color"];

struct Candidate {
    layer: Layer,
    rank: u8,
}

/// Finds the picture: R, G, B without a layer's name (first in a part without a name), then Y likewise, then a layer
/// whose name says that it is finished, then the first with R, G, B, then the first with Y.
pub(super) fn choose(headers: &[Header]) -> Result<Layer, Reason> {
    let candidates = headers.iter().enumerate().flat_map(|(part, header)| candidates(part, header));
    match candidates.min_by_key(|candidate| candidate.rank) {
        Some(best) => Ok(best.layer),
        None => {
            let names = headers.iter().flat_map(|h| &h.channels.list).map(|c| c.name.to_string());
            let names: Vec<String> = names.collect();
            if names.iter().any(|name| matches!(split(name).1, "RY" | "BY")) {
                return Err("it holds luminance and chroma (Y, RY, BY), which vglare does not read".into());
            }
            Err(format!("no layer has R, G, B or Y; there are {}", names.join(", ")).into())
        }
    }
}

fn candidates(part: usize, header: &Header) -> Vec<Candidate> {
    let names: Vec<String> = header.channels.list.iter().map(|c| c.name.to_string()).collect();
    let mut prefixes: Vec<&str> = names.iter().map(|name| split(name).0).collect();
    prefixes.dedup();
    let unnamed = header.own_attributes.layer_name.is_none();
    prefixes.iter().filter_map(|prefix| candidate(part, &names, prefix, unnamed)).collect()
}

fn candidate(part: usize, names: &[String], prefix: &str, unnamed: bool) -> Option<Candidate> {
    let has = |wanted: &str| names.iter().any(|n| split(n) == (prefix, wanted));
    let is_rgb = |names: [&str; 3]| names.iter().all(|name| has(name));
    let rgb = is_rgb(["R", "G", "B"]) || is_rgb(["r", "g", "b"]);
    // Y beside X is a position or a normal; Y beside RY and BY is luminance and chroma, which no one could tell apart
    // from grey later.
    let grey = has("Y") && !["X", "x", "RY", "BY"].iter().any(|other| has(other));
    if !rgb && !grey {
        return None;
    }
    let role = |name: &String| match split(name) {
        (p, _) if p != prefix => Role::Other,
        (_, "R" | "r") if rgb => Role::Component(0),
        (_, "G" | "g") if rgb => Role::Component(1),
        (_, "B" | "b") if rgb => Role::Component(2),
        (_, "Y") if !rgb => Role::Luminance,
        (_, "A" | "a") => Role::Component(3),
        _ => Role::Other,
    };
    let finished = prefix.trim_end_matches('.').rsplit('.').next().unwrap_or_default().to_lowercase();
    let rank = match (prefix.is_empty(), rgb) {
        (true, true) => u8::from(!unnamed),
        (true, false) => 2 + u8::from(!unnamed),
        (false, true) if FINISHED.contains(&finished.as_str()) => 4,
        (false, true) => 5,
        (false, false) => 6,
    };
    let roles: Vec<Role> = names.iter().map(role).collect();
    Some(Candidate { layer: Layer { part, prefix: prefix.to_owned(), roles }, rank })
}

/// A channel's layer, with its dot, and its own name.
fn split(name: &str) -> (&str, &str) {
    name.split_at(name.rfind('.').map_or(0, |dot| dot + 1))
}

impl Layer {
    /// Whether the picture has an alpha channel.
    pub fn has_alpha(&self) -> bool {
        self.roles.contains(&Role::Component(3))
    }

    /// Whether the picture is luminance alone.
    pub fn is_grey(&self) -> bool {
        self.roles.contains(&Role::Luminance)
    }

    /// The channels of the picture's colours.
    pub fn colours<'h>(&self, header: &'h Header) -> impl Iterator<Item = &'h ChannelDescription> {
        let colour = |role: &Role| matches!(role, Role::Component(0..=2) | Role::Luminance);
        let chosen: Vec<bool> = self.roles.iter().map(colour).collect();
        header.channels.list.iter().zip(chosen).filter_map(|(channel, chosen)| chosen.then_some(channel))
    }

    /// Whether a channel's samples must be kept as bytes: all that is no picture, and integers, which an f32 rounds.
    pub fn carries(&self, index: usize, channel: &ChannelDescription) -> bool {
        self.roles[index] == Role::Other || channel.sample_type == SampleType::U32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::meta::attribute::Text;

    fn part(name: Option<&str>, channels: &[&str]) -> Header {
        let list = channels.iter().map(|&c| ChannelDescription::named(c, SampleType::F16)).collect();
        let mut header = Header::new(Text::from("x"), (1, 1), list);
        header.own_attributes.layer_name = name.map(Text::from);
        header
    }

    fn chosen(headers: &[Header]) -> (usize, String) {
        let layer = choose(headers).unwrap();
        (layer.part, layer.prefix)
    }

    #[test]
    fn the_picture_is_found_among_layers() {
        let plain = part(None, &["A", "B", "G", "R", "Z", "diffuse.B", "diffuse.G", "diffuse.R"]);
        assert_eq!(chosen(&[plain]), (0, String::new()));
        let depth_first = [part(Some("depth"), &["Z"]), part(Some("rgb"), &["B", "G", "R"])];
        assert_eq!(chosen(&depth_first), (1, String::new()));
        let blender = part(None, &["V.AO.B", "V.AO.G", "V.AO.R", "V.Combined.B", "V.Combined.G", "V.Combined.R"]);
        assert_eq!(chosen(&[blender]), (0, "V.Combined.".into()));
        let beauty = part(None, &["beauty.B", "beauty.G", "beauty.R", "N.X", "N.Y", "N.Z"]);
        assert_eq!(chosen(&[beauty]), (0, "beauty.".into()));
        let lower = part(None, &["C.b", "C.g", "C.r"]);
        assert_eq!(chosen(&[lower]), (0, "C.".into()));
        let grey = choose(&[part(None, &["A", "Y"])]).unwrap();
        assert_eq!(grey.roles, [Role::Component(3), Role::Luminance]);
    }

    #[test]
    fn positions_and_chroma_are_no_picture() {
        for channels in [&["P.X", "P.Y", "P.Z"][..], &["BY", "RY", "Y"], &["Z"], &["R", "G"]] {
            assert!(choose(&[part(None, channels)]).is_err(), "{channels:?}");
        }
    }
}
