//! The part and the layer that a person asks for.

use exr::meta::header::Header;

use super::super::{ReadOptions, Reason};
use super::candidates::Group;
use super::names::{list, text};

/// How many names an error lists.
const MOST_NAMES: usize = 20;

/// The groups of channels in which the picture is to be looked for: of the part and the layer that are asked for; else of all parts but
/// those that say of themselves that they are no picture.
///
/// # Errors
/// Where there is no such part or layer, with those that there are.
pub(super) fn pick(headers: &[Header], mut groups: Vec<Group>, options: &ReadOptions) -> Result<Vec<Group>, Reason> {
    if let Some(asked) = &options.part {
        let part = part(headers, asked)?;
        if headers[part].deep {
            return Err(format!("its part {asked} holds deep data, which vglare does not read").into());
        }
        groups.retain(|group| group.part == part);
    }
    if let Some(asked) = &options.layer {
        let has_prefix = groups.iter().any(|group| group.names.layer_name() == asked);
        let is_asked = |group: &Group| match has_prefix {
            true => group.names.layer_name() == asked,
            false => group.names.prefix.is_empty() && group.names.part.as_deref() == Some(asked),
        };
        if !groups.iter().any(is_asked) {
            return Err(no_layer(asked, &groups));
        }
        groups.retain(is_asked);
    }
    if options.part.is_none() && options.layer.is_none() {
        groups.retain(|group| !super::colour::is_data(&headers[group.part]));
    }
    Ok(groups)
}

/// The index of a part by its name, or else by its number.
fn part(headers: &[Header], asked: &str) -> Result<usize, Reason> {
    let name = |header: &Header| header.own_attributes.layer_name.as_ref().map(|name| text(name).into_owned());
    let named = headers.iter().position(|header| name(header).as_deref() == Some(asked));
    let numbered = || asked.parse().ok().filter(|&number: &usize| number < headers.len());
    named.or_else(numbered).ok_or_else(|| {
        let parts: Vec<String> = headers
            .iter()
            .enumerate()
            .map(|(number, header)| name(header).map_or(format!("{number}"), |name| format!("{number} ({name})")))
            .collect();
        format!("it has no part {asked}; its parts are {}", list(parts.iter().map(String::as_str), MOST_NAMES)).into()
    })
}

fn no_layer(asked: &str, groups: &[Group]) -> Reason {
    let mut names: Vec<String> = Vec::new();
    for group in groups {
        let own = group.names.layer_name();
        let name = match (own, &group.names.part) {
            ("", Some(part)) => part.clone(),
            ("", None) => "'' (without a name)".to_owned(),
            (own, _) => own.to_owned(),
        };
        if !names.contains(&name) {
            names.push(name);
        }
    }
    format!("it has no layer {asked}; its layers are {}", list(names.iter().map(String::as_str), MOST_NAMES)).into()
}

#[cfg(test)]
mod tests {
    use exr::meta::attribute::{ChannelDescription, SampleType, Text};

    use super::super::layer::choose;
    use super::*;

    fn header(name: Option<&str>, channels: &[&str]) -> Header {
        let list = channels.iter().map(|&c| ChannelDescription::named(c, SampleType::F16)).collect();
        let mut header = Header::new(Text::from("x"), (1, 1), list);
        header.own_attributes.layer_name = name.map(Text::from);
        header
    }

    fn picked(headers: &[Header], part: Option<&str>, layer: Option<&str>) -> Result<(usize, String), String> {
        let [part, layer] = [part, layer].map(|name| name.map(str::to_owned));
        let choice = choose(headers, &ReadOptions { part, layer, ..ReadOptions::default() });
        let layer = choice.map_err(|reason| reason.to_string())?.layer;
        Ok((layer.part(), layer.members[0].prefix.clone()))
    }

    #[test]
    fn a_part_is_known_by_its_name_before_its_number() {
        const RGB: &[&str] = &["B", "G", "R"];
        let headers = [header(Some("rgba"), RGB), header(Some("2"), RGB), header(None, RGB)];
        for (asked, part) in [("rgba", 0), ("2", 1), ("1", 1), ("0", 0)] {
            assert_eq!(picked(&headers, Some(asked), None), Ok((part, String::new())), "{asked}");
        }
        let said = picked(&headers, Some("3"), None).unwrap_err();
        assert_eq!(said, "it has no part 3; its parts are 0 (rgba), 1 (2), 2");
        assert!(picked(&headers, Some("-1"), None).is_err());
    }

    #[test]
    fn deep_parts_are_no_picture() {
        let mut headers = [header(Some("fog"), &["B", "G", "R"]), header(Some("rgba"), &["B", "G", "R"])];
        headers[0].deep = true;
        assert_eq!(picked(&headers, None, None), Ok((1, String::new())));
        let said = picked(&headers, Some("fog"), None).unwrap_err();
        assert_eq!(said, "its part fog holds deep data, which vglare does not read");
        let said = picked(&headers[..1], None, None).unwrap_err();
        assert_eq!(said, "it holds deep data, which vglare does not read");
    }

    #[test]
    fn a_layer_is_known_by_what_its_channels_begin_with() {
        let layers = [
            "B", "G", "R", "Z", "a.spec.B", "a.spec.G", "a.spec.R", "key.B", "key.G", "key.R", "mask.Y", "N.X", "N.Y",
            "N.Z",
        ];
        let one = [header(None, &layers)];
        for (asked, prefix) in [("", ""), ("key", "key."), ("a.spec", "a.spec."), ("mask", "mask.")] {
            assert_eq!(picked(&one, None, Some(asked)), Ok((0, prefix.to_owned())), "{asked}");
        }
        let said = picked(&one, None, Some("fill")).unwrap_err();
        assert_eq!(said, "it has no layer fill; its layers are '' (without a name), a.spec, key, mask, N");
        let said = picked(&one, None, Some("N")).unwrap_err();
        assert!(said.contains("N.X, N.Y, N.Z") && !said.contains("key"), "{said}");
    }

    #[test]
    fn a_layer_may_be_a_part() {
        let key = ["key.B", "key.G", "key.R"];
        let parts = [
            header(Some("rgba"), &["B", "G", "R"]),
            header(Some("fill"), &["B", "G", "R"]),
            header(Some("lights"), &key),
        ];
        assert_eq!(picked(&parts, None, Some("fill")), Ok((1, String::new())));
        assert_eq!(picked(&parts, None, Some("key")), Ok((2, "key.".to_owned())));
        assert_eq!(picked(&parts, Some("lights"), Some("key")), Ok((2, "key.".to_owned())));
        let said = picked(&parts, Some("rgba"), Some("key")).unwrap_err();
        assert_eq!(said, "it has no layer key; its layers are rgba");
    }
}
