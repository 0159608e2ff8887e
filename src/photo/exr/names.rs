//! What the names of channels, layers, parts and views say.

use std::borrow::Cow;

use exr::meta::attribute::Text;
use exr::meta::header::Header;

/// The eyes' views, as everyone calls them.
const STEREO: [&str; 2] = ["left", "right"];

/// What the channels of one layer in one part are called.
pub(super) struct Names {
    /// What the channels' names begin with: nothing, or a layer's name and a dot.
    pub prefix: String,
    /// The layer's own name or else the part's, the last word of it, without a view's, in lower case; may be empty.
    pub layer: String,
    /// The view that the channels are of.
    pub view: Option<String>,
    /// The part's name, as it stands.
    pub part: Option<String>,
}

impl Names {
    /// Those of the channels of `part` that begin with `prefix`.
    pub fn new(headers: &[Header], part: usize, prefix: &str) -> Self {
        let own = &headers[part].own_attributes;
        let views: Vec<_> = own.multi_view_names.iter().flatten().map(text).collect();
        let mut words: Vec<&str> = prefix.split('.').filter(|word| !word.is_empty()).collect();
        // OpenEXR's multi-view convention: layer.view.channel, where the first view need not be named.
        let of_prefix = words.last().and_then(|last| views.iter().position(|view| view == last));
        if of_prefix.is_some() {
            words.pop();
        }
        let of_root = if prefix.is_empty() { views.first() } else { None };
        let of_part = own.view_name.as_ref().map(text);
        let view = of_prefix.map(|index| &views[index]).or(of_part.as_ref()).or(of_root).map(|view| view.to_string());
        let part_name = own.layer_name.as_ref().map(text).unwrap_or_default();
        let own_words: Vec<&str> = without_view(&part_name, view.as_deref()).split('.').collect();
        let mut words = if words.is_empty() { own_words } else { words };
        // Writers that do not say which views there are still name them.
        let unsaid = words.last().filter(|last| view.is_none() && STEREO.contains(last)).map(|last| (*last).to_owned());
        if unsaid.is_some() {
            words.pop();
        }
        let view = view.or(unsaid);
        let layer = words.last().copied().unwrap_or_default().to_lowercase();
        let part = own.layer_name.as_ref().map(|name| text(name).into_owned());
        Self { prefix: prefix.to_owned(), layer, view, part }
    }

    /// What the channels' names begin with, without the dot.
    pub fn layer_name(&self) -> &str {
        self.prefix.strip_suffix('.').unwrap_or(&self.prefix)
    }

    /// The part's name where there are several, and the layer's; none where there is neither.
    pub fn title(&self, headers: &[Header]) -> Option<String> {
        let part = self.part.as_deref().filter(|_| headers.len() > 1);
        let layer = self.prefix.trim_end_matches('.');
        match (part, layer) {
            // Some writers repeat the part's name in its channels'.
            (Some(part), layer) if layer.is_empty() || layer == part => Some(format!("part {part}")),
            (Some(part), layer) => Some(format!("part {part}, {layer}")),
            (None, "") => self.view.as_ref().map(|view| format!("view {view}")),
            (None, layer) => Some(layer.to_owned()),
        }
    }
}

/// The view that is meant where none is named: the first.
pub(super) fn hero(headers: &[Header]) -> Option<String> {
    let own = headers.iter().map(|header| &header.own_attributes);
    let mut views = own.filter_map(|own| own.multi_view_names.iter().flatten().next().or(own.view_name.as_ref()));
    views.next().map(|view| text(view).into_owned())
}

/// A part's name without its view's at either end: `rgba.left`, `rgba_left`, `left`.
fn without_view<'n>(name: &'n str, view: Option<&str>) -> &'n str {
    let Some(view) = view.filter(|view| !view.is_empty()) else { return name };
    let separators = ['.', '_', '-', ' '];
    let cut = |rest: Option<&'n str>, ends: fn(&str, [char; 4]) -> bool| {
        rest.filter(|rest| rest.is_empty() || ends(rest, separators)).map(|rest| rest.trim_matches(separators))
    };
    cut(name.strip_suffix(view), |rest, separators| rest.ends_with(separators))
        .or_else(|| cut(name.strip_prefix(view), |rest, separators| rest.starts_with(separators)))
        .unwrap_or(name)
}

/// A channel's layer, with its dot, and its own name.
pub(super) fn split(name: &str) -> (&str, &str) {
    name.split_at(name.rfind('.').map_or(0, |dot| dot + 1))
}

/// A name as text: UTF-8, as OpenEXR has it.
pub(super) fn text(name: &Text) -> Cow<'_, str> {
    String::from_utf8_lossy(name.bytes())
}

/// The first names, and how many more there are.
pub(super) fn list<'n>(names: impl ExactSizeIterator<Item = &'n str>, most: usize) -> String {
    let more = names.len().saturating_sub(most);
    let first: Vec<&str> = names.take(most).collect();
    let first = first.join(", ");
    if more == 0 { first } else { format!("{first} and {more} more") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_counted() {
        let names: Vec<String> = (0..12).map(|n| n.to_string()).collect();
        let names = || names.iter().map(String::as_str);
        assert_eq!(list(names(), 12), "0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11");
        assert_eq!(list(names(), 2), "0, 1 and 10 more");
    }

    #[test]
    fn views_are_taken_off_names_of_parts() {
        for name in ["rgba.left", "rgba_left", "left.rgba", "rgba"] {
            assert_eq!(without_view(name, Some("left")), "rgba", "{name}");
        }
        assert_eq!(without_view("left", Some("left")), "");
        assert_eq!(without_view("cleft", Some("left")), "cleft");
        assert_eq!(without_view("rgba.left", None), "rgba.left");
    }
}
