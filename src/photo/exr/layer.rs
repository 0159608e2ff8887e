//! Which channels of a file are the picture.
//!
//! A channel's name is its layer's, a dot, and its own (`diffuse.R`); a part may have a name, too, which counts like a
//! layer's where the channel has none. What is left when the name of a view is taken off (`beauty.right.R`, a part
//! `rgba.left`) is the layer's name. The picture is the first of these that is there:
//!
//! 1. R, G, B (or red, green, blue, in any case) without a name;
//! 2. Y, or Y with RY and BY (luminance and chroma), without a name;
//! 3. R, G, B, then Y, of a layer or part whose name says that it is finished ([`FINISHED`](super::candidates::FINISHED));
//! 4. R, G, B of any part, then of any layer, then R, G and B from three parts of one window;
//! 5. Y of any layer or part; X, Y, Z without a layer's name, which are taken for CIE XYZ;
//! 6. the one of R, G, B that a layer has, or the file's only channel, as grey.
//!
//! Of a stereo file the first view comes before the others. Alpha is the A or alpha beside the colours. Parts that are data by their
//! `colorInteropID` are no picture. Where a part or a layer is asked for, only its channels count ([`pick`]).

use exr::meta::attribute::{ChannelDescription, SampleType};
use exr::meta::header::Header;

use super::super::{ReadOptions, Reason};
use super::candidates::{Candidate, Group, NO_PICTURE, Slot, candidate, groups, lone, scattered};
use super::names::{self, list};
use super::pick::pick;

/// The parts and the channels that the photo's pixels are made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Layer {
    /// The parts that the channels stand in: one, unless R, G and B have parts of their own. Not empty; the first is
    /// the one whose header describes the picture.
    pub members: Vec<Member>,
    /// What the channels are.
    pub colours: Colours,
}

/// A part that holds channels of the picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Member {
    /// Index of the part.
    pub part: usize,
    /// What the channels' names begin with: nothing, or a layer's name and a dot.
    pub prefix: String,
    /// For each channel of the part, what it is.
    pub roles: Vec<Role>,
}

/// What the channels of a picture are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Colours {
    /// Red, green, blue.
    Rgb,
    /// One channel for all three colours.
    Grey,
    /// Y with RY = (R − Y) / Y and BY = (B − Y) / Y.
    LumaChroma,
    /// CIE XYZ.
    Xyz,
}

/// What a channel is to the photo.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Red, green, blue or alpha: 0 to 3.
    Component(usize),
    /// Luminance, which is all three colours.
    Luminance,
    /// RY or BY: the component, 0 or 2, that it makes of the luminance.
    Chroma(usize),
    /// Something else, to be carried along.
    Other,
}

/// The picture, and what there is to say of the choice.
#[derive(Debug)]
pub(super) struct Choice {
    pub layer: Layer,
    /// What the picture is called, where the file holds others.
    pub name: Option<String>,
    pub notes: Vec<String>,
}

/// Finds the picture, in the part and the layer that are asked for.
///
/// # Errors
/// Where nothing can be it, or there is no such part or layer.
pub(super) fn choose(headers: &[Header], options: &ReadOptions) -> Result<Choice, Reason> {
    let flat = (0..headers.len()).filter(|&part| !headers[part].deep);
    let all: Vec<Group> = flat.flat_map(|part| groups(headers, part)).collect();
    if all.is_empty() && headers.iter().any(|header| header.deep) {
        return Err("it holds deep data, which vglare does not read".into());
    }
    let pictures = all.iter().filter(|group| candidate(headers, group).is_some()).count();
    let groups = pick(headers, all, options)?;
    let candidates = candidates(headers, &groups);
    let hero = names::hero(headers).or_else(|| groups.iter().find_map(|group| group.names.view.clone()));
    let key = |c: &Candidate| {
        let view = &c.from[0].0.names.view;
        (c.rank >= NO_PICTURE, view.is_some() && *view != hero, c.rank)
    };
    let Some(best) = candidates.iter().min_by_key(|candidate| key(candidate)) else {
        return Err(nothing(headers, &groups));
    };
    let mut notes = Vec::new();
    let equals: Vec<String> = candidates.iter().filter(|c| key(c) == key(best)).map(|c| c.name(headers)).collect();
    if let [first, others @ ..] = &equals[..]
        && !others.is_empty()
    {
        let others = list(others.iter().map(String::as_str), 3);
        notes.push(format!("more than one layer may be the picture: {first} was taken, and not {others}"));
    }
    notes.extend(best.other_views(&candidates));
    notes.extend(best.doubts(headers));
    let name = (pictures.max(candidates.len()) > 1).then(|| best.name(headers));
    Ok(Choice { layer: best.layer(headers), name, notes })
}

/// All that may be the picture.
fn candidates<'g>(headers: &[Header], groups: &'g [Group]) -> Vec<Candidate<'g>> {
    let mut candidates: Vec<_> = groups.iter().filter_map(|group| candidate(headers, group)).collect();
    candidates.extend(scattered(headers, groups));
    if candidates.is_empty() { lone(groups) } else { candidates }
}

/// Why nothing is the picture.
fn nothing(headers: &[Header], groups: &[Group]) -> Reason {
    let names: Vec<_> = groups.iter().flat_map(|group| group.channel_names(headers)).collect();
    if names.is_empty() {
        return "its parts are data and no picture, by their colorInteropID".into();
    }
    let listed = list(names.iter().map(|name| &**name), 10);
    if Slot::RGB.iter().all(|&slot| groups.iter().any(|group| group.has(&[slot]))) {
        return format!(
            "R, G and B are not of one layer, or of parts with different windows; its channels are {listed}"
        )
        .into();
    }
    format!("no layer has R, G and B, or Y; its channels are {listed}").into()
}

impl Layer {
    /// The part whose header describes the picture.
    pub fn part(&self) -> usize {
        self.members[0].part
    }

    /// What a part holds of the picture.
    pub fn member(&self, part: usize) -> Option<usize> {
        self.members.iter().position(|member| member.part == part)
    }

    /// Whether the picture has an alpha channel.
    pub fn has_alpha(&self) -> bool {
        self.members.iter().any(|member| member.roles.contains(&Role::Component(3)))
    }

    /// The channels of the picture's colours.
    pub fn colour_channels<'h>(&self, headers: &'h [Header]) -> Vec<&'h ChannelDescription> {
        let colour = |role: &Role| matches!(role, Role::Component(0..=2) | Role::Luminance | Role::Chroma(_));
        let of = |member: &Member| {
            let channels = headers[member.part].channels.list.iter().zip(member.roles.clone());
            channels.filter(move |(_, role)| colour(role)).map(|(channel, _)| channel)
        };
        self.members.iter().flat_map(of).collect()
    }
}

impl Member {
    /// Whether a channel's samples must be kept as bytes: all that is no picture, and integers, which an f32 rounds.
    pub fn carries(&self, index: usize, channel: &ChannelDescription) -> bool {
        self.roles[index] == Role::Other || channel.sample_type == SampleType::U32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::math::Vec2;
    use exr::meta::attribute::Text;

    fn part(name: Option<&str>, channels: &[&str]) -> Header {
        let list = channels.iter().map(|&c| ChannelDescription::named(c, SampleType::F16)).collect();
        let mut header = Header::new(Text::from("x"), (1, 1), list);
        header.own_attributes.layer_name = name.map(Text::from);
        header
    }

    fn choose(headers: &[Header]) -> Result<Choice, Reason> {
        super::choose(headers, &ReadOptions::default())
    }

    fn chosen(headers: &[Header]) -> (usize, String) {
        let layer = choose(headers).unwrap().layer;
        (layer.part(), layer.members[0].prefix.clone())
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
        let grey = choose(&[part(None, &["A", "Y"])]).unwrap().layer;
        assert_eq!(grey.members[0].roles, [Role::Component(3), Role::Luminance]);
    }

    #[test]
    fn names_of_parts_count_like_names_of_layers() {
        const RGB: &[&str] = &["B", "G", "R"];
        for (first, second, want) in [
            ("albedo", "rgba", "part rgba"),
            ("ViewLayer.Albedo", "ViewLayer.Combined", "part ViewLayer.Combined"),
            ("diffuse", "Beauty", "part Beauty"),
        ] {
            let choice = choose(&[part(Some(first), RGB), part(Some(second), RGB)]).unwrap();
            assert_eq!((choice.layer.part(), choice.name.as_deref()), (1, Some(want)));
            assert_eq!(choice.notes, [""; 0]);
        }
        let twice = ["V.AO", "V.Combined"].map(|name| {
            let channels = ["B", "G", "R"].map(|channel| format!("{name}.{channel}"));
            part(Some(name), &channels.each_ref().map(String::as_str))
        });
        assert_eq!(choose(&twice).unwrap().name.as_deref(), Some("part V.Combined"));
        let unnamed = choose(&[part(Some("rgba"), RGB), part(None, RGB)]).unwrap();
        assert_eq!(unnamed.layer.part(), 1);
        let tie = choose(&[part(Some("a"), RGB), part(Some("b"), RGB)]).unwrap();
        assert_eq!((tie.layer.part(), tie.notes.len()), (0, 1));
        assert!(tie.notes[0].contains("part a was taken, and not part b"), "{}", tie.notes[0]);
        let alone = choose(&[part(Some("albedo"), RGB)]).unwrap();
        assert_eq!((alone.name, alone.notes.len()), (None, 0));
    }

    #[test]
    fn long_names_xyz_chroma_and_lone_channels_are_pictures() {
        let roles = |channels: &[&str]| {
            let choice = choose(&[part(None, channels)]).unwrap();
            (choice.layer.colours, choice.layer.members[0].roles.clone(), choice.notes.len())
        };
        let [r, g, b, a] = [0, 1, 2, 3].map(Role::Component);
        assert_eq!(roles(&["alpha", "blue", "green", "red"]), (Colours::Rgb, vec![a, b, g, r], 0));
        assert_eq!(roles(&["Blue", "GREEN", "Red"]), (Colours::Rgb, vec![b, g, r], 0));
        assert_eq!(roles(&["B", "G", "R", "red"]), (Colours::Rgb, vec![b, g, r, Role::Other], 0));
        assert_eq!(roles(&["X", "Y", "Z"]), (Colours::Xyz, vec![r, g, b], 1));
        let chroma = vec![Role::Chroma(2), Role::Chroma(0), Role::Luminance];
        assert_eq!(roles(&["BY", "RY", "Y"]), (Colours::LumaChroma, chroma, 0));
        assert_eq!(roles(&["R"]), (Colours::Grey, vec![Role::Luminance], 1));
        assert_eq!(roles(&["A", "R", "Z"]), (Colours::Grey, vec![a, Role::Luminance, Role::Other], 1));
        assert_eq!(roles(&["A", "depth"]), (Colours::Grey, vec![a, Role::Luminance], 1));
        assert_eq!(roles(&["A"]), (Colours::Grey, vec![Role::Luminance], 1));
    }

    #[test]
    fn positions_and_halves_of_pictures_are_none() {
        for channels in [&["P.X", "P.Y", "P.Z"][..], &["BY", "Y"], &["Z", "id"], &["R", "G"]] {
            let error = choose(&[part(None, channels)]).unwrap_err().to_string();
            assert!(error.contains("R, G and B") && error.ends_with(&channels.join(", ")), "{error}");
        }
        let many: Vec<String> = (0..40_000).map(|n| format!("{n}")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        assert!(choose(&[part(None, &many)]).unwrap_err().to_string().ends_with("9 and 39990 more"));
    }

    #[test]
    fn colours_in_parts_are_put_together_where_their_windows_are_one() {
        let mut parts = [part(Some("r"), &["R"]), part(Some("g"), &["G"]), part(Some("b"), &["B", "Z"])];
        let choice = choose(&parts).unwrap();
        let members: Vec<_> = choice.layer.members.iter().map(|member| (member.part, member.roles.clone())).collect();
        let [r, g, b] = [0, 1, 2].map(Role::Component);
        assert_eq!(members, [(0, vec![r]), (1, vec![g]), (2, vec![b, Role::Other])]);
        parts[1].layer_size = Vec2(2, 1);
        assert!(choose(&parts).unwrap_err().to_string().contains("different windows"));
    }

    #[test]
    fn the_first_view_is_the_picture_and_the_others_are_named() {
        let mut one = part(None, &["B", "G", "R", "right.B", "right.G", "right.R"]);
        one.own_attributes.multi_view_names = Some(vec![Text::from("left"), Text::from("right")]);
        let choice = choose(&[one]).unwrap();
        assert_eq!((choice.layer.members[0].prefix.as_str(), choice.name.as_deref()), ("", Some("view left")));
        assert!(choice.notes[0].contains("left is the picture, and right"), "{:?}", choice.notes);
        let parts = ["right", "left"].map(|view| {
            let mut header = part(Some(&format!("rgba_{view}")), &["B", "G", "R"]);
            header.own_attributes.view_name = Some(Text::from(view));
            header
        });
        let choice = choose(&parts).unwrap();
        assert_eq!((choice.layer.part(), choice.name.as_deref()), (0, Some("part rgba_right")));
        assert_eq!(choice.notes.len(), 1, "{:?}", choice.notes);
        let unsaid = ["diffuse.left", "rgba.left", "rgba.right"].map(|name| part(Some(name), &["B", "G", "R"]));
        let choice = choose(&unsaid).unwrap();
        assert_eq!((choice.layer.part(), choice.notes.len()), (1, 1), "{:?}", choice.notes);
        assert!(choice.notes[0].contains("the view left is the picture, and right"), "{:?}", choice.notes);
    }
}
