//! A packet of XMP: what it says of orientation and thumbnails is set right, by place, and all else stays as it stands.

use roxmltree::{Document, Node, ParsingOptions};

const TIFF: &str = "http://ns.adobe.com/tiff/1.0/";
const EXIF: &str = "http://ns.adobe.com/exif/1.0/";
const XAP: &str = "http://ns.adobe.com/xap/1.0/";
/// What names the XMP of a JPEG's other segments.
const NOTE: &str = "http://ns.adobe.com/xmp/note/";
/// What speaks of other parts of its file, which are not kept.
const OF_PARTS: [(&str, &str); 4] = [
    ("http://ns.google.com/photos/1.0/container/", "a list of pictures and films within the file"),
    ("http://ns.google.com/photos/1.0/camera/", "a film within the file"),
    ("http://ns.adobe.com/hdr-gain-map/1.0/", "a gain map"),
    ("http://ns.apple.com/HDRGainMap/1.0/", "a gain map"),
];

const EXTENDED: &str = "HasExtendedXMP";

/// A node or attribute, its place, and what stands there instead.
type Change = (std::ops::Range<usize>, String);

/// The packet of a picture that lies upright; `turned` says that what was its width is its height.
///
/// # Errors
/// Why it cannot be kept; the reason goes on after "its XMP".
pub(super) fn settled(packet: &str, turned: bool) -> Result<String, String> {
    // Entities are not allowed, so that it cannot grow; the limit is far beyond what is written.
    let options = ParsingOptions { nodes_limit: 1 << 18, ..ParsingOptions::default() };
    let document = Document::parse_with_options(packet, options).map_err(|_| "cannot be read".to_owned())?;
    if let Some((_, what)) = OF_PARTS.iter().find(|(namespace, _)| uses(&document, namespace)) {
        return Err(format!("speaks of {what}"));
    }
    let mut changes: Vec<Change> = Vec::new();
    for node in document.descendants().filter(Node::is_element) {
        if node.has_tag_name((XAP, "Thumbnails")) || node.has_tag_name((NOTE, EXTENDED)) {
            changes.push((node.range(), String::new()));
        }
        if let Some(attribute) = node.attribute_node((NOTE, EXTENDED)) {
            changes.push((attribute.range(), String::new()));
        }
    }
    if let Some((range, _)) = found(&document, TIFF, "Orientation") {
        changes.push((range, "1".into()));
    }
    let pairs = [(TIFF, "ImageWidth", "ImageLength"), (EXIF, "PixelXDimension", "PixelYDimension")];
    for (namespace, across, down) in pairs.into_iter().filter(|_| turned) {
        if let (Some(across), Some(down)) = (found(&document, namespace, across), found(&document, namespace, down)) {
            changes.push((across.0, down.1));
            changes.push((down.0, across.1));
        }
    }
    let mut settled = packet.to_owned();
    changes.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
    changes.into_iter().for_each(|(range, text)| settled.replace_range(range, &text));
    Ok(settled)
}

/// Whether anything stands in a namespace; to name it alone is no use of it.
fn uses(document: &Document, namespace: &str) -> bool {
    document.descendants().filter(Node::is_element).any(|node| {
        node.tag_name().namespace() == Some(namespace)
            || node.attributes().any(|attribute| attribute.namespace() == Some(namespace))
    })
}

/// A simple property, as an attribute or as an element: where its value stands, and the value.
fn found(document: &Document, namespace: &str, name: &str) -> Option<Change> {
    document.descendants().filter(Node::is_element).find_map(|node| {
        if let Some(attribute) = node.attribute_node((namespace, name)) {
            return Some((attribute.range_value(), attribute.value().to_owned()));
        }
        let text = node.has_tag_name((namespace, name)).then(|| node.first_child())??;
        text.is_text().then(|| (text.range(), text.text().unwrap_or_default().to_owned()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn packet(attributes: &str, elements: &str) -> String {
        format!(
            "<?xpacket begin='\u{feff}' id='W5M0MpCehiHzreSzNTczkc9d'?><x:xmpmeta xmlns:x='adobe:ns:meta/'>\
             <rdf:RDF xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'><rdf:Description rdf:about='' \
             xmlns:tiff='{TIFF}' xmlns:xmp='{XAP}' xmlns:g='{}' {attributes}>{elements}</rdf:Description></rdf:RDF>\
             </x:xmpmeta><?xpacket end='w'?>",
            OF_PARTS[1].0
        )
    }

    #[test]
    fn orientation_and_thumbnails_are_set_right_wherever_they_stand() {
        let before = packet("tiff:Orientation='6' tiff:ImageWidth='30' tiff:ImageLength='20' tiff:Make='Ö'", "<a/>");
        let after = packet("tiff:Orientation='1' tiff:ImageWidth='20' tiff:ImageLength='30' tiff:Make='Ö'", "<a/>");
        assert_eq!(settled(&before, true).unwrap(), after);
        let thumbnails = "<xmp:Thumbnails><rdf:Alt><rdf:li>/9j/</rdf:li></rdf:Alt></xmp:Thumbnails>";
        let before = packet("", &format!("<tiff:Orientation>8</tiff:Orientation>{thumbnails}<a/>"));
        let after = packet("", "<tiff:Orientation>1</tiff:Orientation><a/>");
        assert_eq!(settled(&before, true).unwrap(), after);
        assert_eq!(settled(&after, false).unwrap(), after);
        let before = packet("xmlns:n='http://ns.adobe.com/xmp/note/' n:HasExtendedXMP='0123'", "<a/>");
        assert!(!settled(&before, false).unwrap().contains("HasExtendedXMP"));
    }

    #[test]
    fn what_would_lie_is_left_out() {
        assert!(settled(&packet("g:MotionPhoto='1'", ""), false).unwrap_err().contains("a film"));
        assert!(settled("<x:xmpmeta", false).unwrap_err().contains("cannot be read"));
        let entity = "<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>";
        assert!(settled(entity, false).is_err());
    }
}
