//! What in a file may be the picture.

use std::borrow::Cow;

use exr::meta::header::Header;
use rustc_hash::FxHashMap;

use super::layer::{Colours, Layer, Member, Role};
use super::names::{Names, list, split, text};

/// Layers and parts of these names are the finished picture, where a file has many.
pub(super) const FINISHED: [&str; 11] =
    ["combined", "beauty", "composite", "rgba", "rgb", "main", "image", "color", "colour", "final", "ci"];

/// Channels of one layer in one part.
pub(super) struct Group {
    pub part: usize,
    pub names: Names,
    /// Indices of its channels.
    channels: Vec<usize>,
    /// Indices of the channels that mean something, by [`Slot`].
    slots: [Option<usize>; Slot::ALL],
}

/// What a channel's own name says that it is.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum Slot {
    Red,
    Green,
    Blue,
    Alpha,
    Y,
    Ry,
    By,
    X,
    Z,
}

impl Slot {
    const ALL: usize = 9;
    pub const RGB: [Self; 3] = [Self::Red, Self::Green, Self::Blue];

    /// What a channel's own name means, and whether it is the short name.
    fn of(name: &str) -> Option<(Self, bool)> {
        Some(match name {
            "Y" => (Self::Y, true),
            "RY" => (Self::Ry, true),
            "BY" => (Self::By, true),
            "X" | "x" => (Self::X, true),
            "Z" => (Self::Z, true),
            _ => match name.to_ascii_lowercase().as_str() {
                "r" => (Self::Red, true),
                "g" => (Self::Green, true),
                "b" => (Self::Blue, true),
                "a" => (Self::Alpha, true),
                "red" => (Self::Red, false),
                "green" => (Self::Green, false),
                "blue" => (Self::Blue, false),
                "alpha" => (Self::Alpha, false),
                _ => return None,
            },
        })
    }
}

/// Something that may be the picture. The least rank is.
pub(super) struct Candidate<'g> {
    pub rank: u8,
    colours: Colours,
    /// The groups of the channels, and which of their channels are taken.
    pub from: Vec<(&'g Group, Vec<(usize, Role)>)>,
}

/// Ranks from here on are no picture by their names.
pub(super) const NO_PICTURE: u8 = 9;

/// The channels of a part by their layers, in the file's order.
pub(super) fn groups(headers: &[Header], part: usize) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut known: FxHashMap<String, usize> = FxHashMap::default();
    for (index, channel) in headers[part].channels.list.iter().enumerate() {
        let name = text(&channel.name);
        let (prefix, own) = split(&name);
        let at = *known.entry(prefix.to_owned()).or_insert_with(|| {
            let names = Names::new(headers, part, prefix);
            groups.push(Group { part, names, channels: Vec::new(), slots: Default::default() });
            groups.len() - 1
        });
        groups[at].channels.push(index);
        if let Some((slot, short)) = Slot::of(own) {
            let slot = &mut groups[at].slots[slot as usize];
            if short || slot.is_none() {
                *slot = Some(index);
            }
        }
    }
    groups
}

impl Group {
    fn get(&self, slot: Slot) -> Option<usize> {
        self.slots[slot as usize]
    }

    pub fn has(&self, slots: &[Slot]) -> bool {
        slots.iter().all(|&slot| self.get(slot).is_some())
    }

    fn has_any(&self, slots: &[Slot]) -> bool {
        slots.iter().any(|&slot| self.get(slot).is_some())
    }

    /// What its channels are called.
    pub fn channel_names<'h>(&self, headers: &'h [Header]) -> Vec<Cow<'h, str>> {
        self.channels.iter().map(|&index| text(&headers[self.part].channels.list[index].name)).collect()
    }

    /// Channels as roles, with the alpha beside them.
    fn take(&self, roles: &[(Slot, Role)]) -> Vec<(usize, Role)> {
        let alpha = [(Slot::Alpha, Role::Component(3))];
        roles.iter().chain(&alpha).filter_map(|&(slot, role)| Some((self.get(slot)?, role))).collect()
    }
}

/// The colours that a group holds, if it is whole.
pub(super) fn candidate<'g>(headers: &[Header], group: &'g Group) -> Option<Candidate<'g>> {
    use Slot::{Blue, By, Green, Red, Ry, X, Y, Z};
    let names = &group.names;
    let (colours, roles): (_, &[(Slot, Role)]) = if group.has(&Slot::RGB) {
        (Colours::Rgb, &[(Red, Role::Component(0)), (Green, Role::Component(1)), (Blue, Role::Component(2))])
    } else if group.has_any(&Slot::RGB) {
        return None;
    } else if group.has(&[Y, Ry, By]) {
        (Colours::LumaChroma, &[(Y, Role::Luminance), (Ry, Role::Chroma(0)), (By, Role::Chroma(2))])
    } else if group.has(&[Y]) && !group.has_any(&[X, Ry, By]) {
        (Colours::Grey, &[(Y, Role::Luminance)])
    } else if group.has(&[X, Y, Z]) && names.prefix.is_empty() {
        // Positions and normals have a layer's name.
        (Colours::Xyz, &[(X, Role::Component(0)), (Y, Role::Component(1)), (Z, Role::Component(2))])
    } else {
        return None;
    };
    let unnamed = names.layer.is_empty() || names.prefix.is_empty() && headers.len() == 1;
    let finished = FINISHED.contains(&names.layer.as_str());
    let rank = match (colours, unnamed, finished) {
        (Colours::Xyz, ..) => 8,
        (Colours::Rgb, true, _) => 0,
        (_, true, _) => 1,
        (Colours::Rgb, _, true) => 2,
        (_, _, true) => 3,
        (Colours::Rgb, ..) if names.prefix.is_empty() => 4,
        (Colours::Rgb, ..) => 5,
        _ => 7,
    };
    Some(Candidate { rank, colours, from: vec![(group, group.take(roles))] })
}

/// Groups of one layer and view that hold R, G and B between them, in parts of one window.
pub(super) fn scattered<'g>(headers: &[Header], groups: &'g [Group]) -> Option<Candidate<'g>> {
    let mut found: FxHashMap<(&str, Option<&str>), [Option<&Group>; 4]> = FxHashMap::default();
    let incomplete = groups.iter().filter(|group| !group.has(&Slot::RGB));
    for group in incomplete {
        let place = found.entry((&group.names.prefix, group.names.view.as_deref())).or_default();
        for (place, slot) in place.iter_mut().zip([Slot::Red, Slot::Green, Slot::Blue, Slot::Alpha]) {
            if place.is_none() && group.has(&[slot]) {
                *place = Some(group);
            }
        }
    }
    let window = |group: &Group| headers[group.part].data_window();
    let whole = |places: &[Option<&'g Group>; 4]| match *places {
        [Some(r), Some(g), Some(b), a] if window(r) == window(g) && window(r) == window(b) => {
            Some([Some(r), Some(g), Some(b), a.filter(|a| window(a) == window(r))])
        }
        _ => None,
    };
    let places = found.values().filter_map(whole).min_by_key(|places| places[0].map(|group| group.part))?;
    let mut from: Vec<(&Group, Vec<(usize, Role)>)> = Vec::new();
    for (component, (group, slot)) in
        places.into_iter().zip([Slot::Red, Slot::Green, Slot::Blue, Slot::Alpha]).enumerate()
    {
        let Some((group, channel)) = group.and_then(|group| Some((group, group.get(slot)?))) else { continue };
        let role = (channel, Role::Component(component));
        match from.iter_mut().find(|(known, _)| known.part == group.part) {
            Some((_, roles)) => roles.push(role),
            None => from.push((group, vec![role])),
        }
    }
    Some(Candidate { rank: 6, colours: Colours::Rgb, from })
}

/// Channels that stand alone.
pub(super) fn lone(groups: &[Group]) -> Vec<Candidate<'_>> {
    let grey = |rank, group, taken| Candidate { rank, colours: Colours::Grey, from: vec![(group, taken)] };
    let mut colours = FxHashMap::default();
    for slot in Slot::RGB {
        let named = groups.iter().filter(|group| group.has(&[slot]));
        named.for_each(|group| *colours.entry(&*group.names.prefix).or_insert(0) += 1);
    }
    // Two or three of R, G, B are a picture that is not whole.
    let one = |group: &&Group| colours.get(&*group.names.prefix) == Some(&1) && group.has_any(&Slot::RGB);
    let red = |group| grey(NO_PICTURE, group, group.take(&Slot::RGB.map(|slot| (slot, Role::Luminance))));
    let found: Vec<Candidate> = groups.iter().filter(one).map(red).collect();
    if !found.is_empty() {
        return found;
    }
    let count: usize = groups.iter().map(|group| group.channels.len()).sum();
    let alphas: Vec<&Group> = groups.iter().filter(|group| group.has(&[Slot::Alpha])).collect();
    let only = match (count, groups, &alphas[..]) {
        (1, [group], _) => Some((group, group.channels[0], None)),
        (2, [group], [_]) => {
            let alpha = group.get(Slot::Alpha);
            let other = group.channels.iter().find(|&&index| Some(index) != alpha);
            other.map(|&index| (group, index, alpha))
        }
        _ => None,
    };
    let only = only.map(|(group, index, alpha)| {
        let alpha = alpha.map(|alpha| (alpha, Role::Component(3)));
        grey(NO_PICTURE + 1, group, [(index, Role::Luminance)].into_iter().chain(alpha).collect())
    });
    only.into_iter().collect()
}

impl Candidate<'_> {
    pub fn layer(&self, headers: &[Header]) -> Layer {
        let member = |(group, taken): &(&Group, Vec<(usize, Role)>)| {
            let mut roles = vec![Role::Other; headers[group.part].channels.list.len()];
            taken.iter().for_each(|&(index, role)| roles[index] = role);
            Member { part: group.part, prefix: group.names.prefix.clone(), roles }
        };
        Layer { members: self.from.iter().map(member).collect(), colours: self.colours }
    }

    pub fn name(&self, headers: &[Header]) -> String {
        let (group, taken) = &self.from[0];
        let channels = taken.iter().filter(|(_, role)| *role != Role::Component(3));
        let channels = channels.map(|&(index, _)| text(&headers[group.part].channels.list[index].name));
        if self.from.len() > 1 {
            return "parts of R, G and B".to_owned();
        }
        group.names.title(headers).unwrap_or_else(|| channels.collect::<Vec<_>>().join(", "))
    }

    /// That the picture is one of several views.
    pub fn other_views(&self, candidates: &[Candidate]) -> Option<String> {
        let view = |candidate: &Candidate| candidate.from[0].0.names.view.clone();
        let own = view(self)?;
        let mut others: Vec<String> = candidates.iter().filter_map(view).filter(|view| *view != own).collect();
        others.sort();
        others.dedup();
        let others = list(others.iter().map(String::as_str), 3);
        (!others.is_empty()).then(|| format!("it is stereo: the view {own} is the picture, and {others} gets no glare"))
    }

    /// What a person might have meant otherwise.
    pub fn doubts(&self, headers: &[Header]) -> Option<String> {
        let (group, taken) = &self.from[0];
        let name = || text(&headers[group.part].channels.list[taken[0].0].name).into_owned();
        match self.colours {
            Colours::Xyz => Some("its channels X, Y and Z are taken for colours in CIE XYZ".to_owned()),
            Colours::Grey if self.rank >= NO_PICTURE => {
                Some(format!("its one channel {} is taken for a grey picture", name()))
            }
            _ => None,
        }
    }
}
