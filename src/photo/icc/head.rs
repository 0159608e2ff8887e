//! A profile's header and its table of tags: what it is, what it is called, and whether it can be read at all.

use moxcms::{ColorProfile, ParsingOptions};

use super::super::Reason;

/// A profile larger than this is none: the largest in use, of printers, have a few MiB.
pub(in super::super) const LARGEST: usize = 16 << 20;

/// \[ICC\] 7.2: the header; after it the number of tags, and for each its signature, offset and size.
const HEADER: usize = 128;
const TAG: usize = 12;

/// A name longer than this is cut.
const LONGEST_NAME: usize = 60;

/// The tags that tell light. The others, good or bad, are none of our business.
const NEEDED: [&[u8; 4]; 11] =
    [b"rXYZ", b"gXYZ", b"bXYZ", b"rTRC", b"gTRC", b"bTRC", b"kTRC", b"A2B0", b"A2B1", b"A2B2", b"cicp"];

/// The signature of the colour space that a profile is for.
///
/// # Errors
/// Where it is no profile that can be read.
pub fn check(icc: &[u8]) -> Result<[u8; 4], Reason> {
    if icc.len() > LARGEST {
        return Err(format!("has {} bytes, more than {LARGEST}", icc.len()).into());
    }
    let header = icc.get(..HEADER + 4).ok_or("is cut short")?;
    if header[36..40] != *b"acsp" {
        return Err("lacks the signature of one".into());
    }
    if !matches!(header[8], 2..=4) {
        return Err(format!("is of version {}, and vglare reads 2 to 4", header[8]).into());
    }
    let past_the_end =
        |tag: &[u8]| NEEDED.contains(&&word(tag, 0)) && range(tag).is_none_or(|range| range.end > icc.len());
    if tags(icc).count() < number(header, HEADER) || tags(icc).any(past_the_end) {
        return Err("is cut short".into());
    }
    Ok(word(header, 16))
}

/// The profile through moxcms.
///
/// # Errors
/// Where moxcms refuses it.
pub fn parse(icc: &[u8]) -> Result<ColorProfile, Reason> {
    // What is not needed loses its name, so that it is passed over.
    let mut needed = icc.to_vec();
    for tag in needed[HEADER + 4..].chunks_exact_mut(TAG).take(number(icc, HEADER)) {
        if !NEEDED.contains(&&word(tag, 0)) {
            tag[..4].fill(0);
        }
    }
    // Profiles of the wild have dates of 0, and intents that do not exist.
    needed[24..36].copy_from_slice(&[7, 208, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0]);
    needed[64..68].fill(0);
    tell_lab(&mut needed);
    let options =
        ParsingOptions { max_profile_size: LARGEST + 1, max_allowed_trc_size: 1 << 16, ..ParsingOptions::default() };
    ColorProfile::new_from_slice_with_options(&needed, options)
        .map_err(|error| format!("cannot be read: {error}").into())
}

/// Gives a profile the version that moxcms tells the encoding of a table's Lab by.
///
/// It is the table's type that tells: \[ICC\] 10.10 has lut16Type keep the encoding of version 2 in profiles of version
/// 4, and 10.11 gives lut8Type one that, as a fraction, is that of version 4.
pub(in super::super) fn tell_lab(icc: &mut [u8]) {
    // In the order in which they are looked for.
    let table = [b"A2B1", b"A2B0", b"A2B2"].into_iter().find_map(|name| tags(icc).find(|tag| tag[..4] == *name));
    let kind = table.and_then(range).and_then(|range| icc.get(range.start..)?.first_chunk::<4>());
    match kind {
        Some(b"mft2") => icc[8..12].copy_from_slice(&[2, 0x40, 0, 0]),
        Some(b"mft1") => icc[8..12].copy_from_slice(&[4, 0x40, 0, 0]),
        _ => {}
    }
}

/// Whether a profile is for grey.
pub(in super::super) fn is_grey(icc: &[u8]) -> bool {
    icc.get(16..20) == Some(b"GRAY")
}

/// The colour space that a profile is for, in words.
pub fn space(icc: &[u8]) -> String {
    match icc.get(16..20).map_or("", |name| std::str::from_utf8(name).unwrap_or("")).trim() {
        "GRAY" => "grey".into(),
        "" => "an unknown colour space".into(),
        name => plain(name),
    }
}

/// What a profile calls itself, if that can be read: \[ICC\] 9.2.41, as text of version 2 or 4.
pub fn name(icc: &[u8]) -> Option<String> {
    let range = tags(icc).find(|tag| tag[..4] == *b"desc").and_then(range)?;
    let tag = icc.get(range.start..range.end.min(icc.len()))?;
    let text = match tag.get(..4)? {
        b"desc" => {
            let text = tag.get(12..)?;
            String::from_utf8_lossy(&text[..number_at(tag, 8)?.min(text.len())]).into_owned()
        }
        // [ICC] 10.15: records of a language, and the length and offset of its text in UTF-16.
        b"mluc" => {
            let (length, start) = (number_at(tag, 20)?, number_at(tag, 24)?);
            let units = tag.get(start..start.checked_add(length)?)?.as_chunks::<2>().0;
            char::decode_utf16(units.iter().map(|&unit| u16::from_be_bytes(unit))).flatten().collect()
        }
        _ => return None,
    };
    Some(plain(&text)).filter(|name| !name.is_empty())
}

/// Text of a file without what would trouble a terminal.
fn plain(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(LONGEST_NAME).collect::<String>().trim().to_owned()
}

/// The entries of the table that are there.
fn tags(icc: &[u8]) -> impl Iterator<Item = &[u8]> {
    let count = number_at(icc, HEADER).unwrap_or(0);
    icc.get(HEADER + 4..).unwrap_or_default().chunks_exact(TAG).take(count)
}

fn range(tag: &[u8]) -> Option<std::ops::Range<usize>> {
    let start = number(tag, 4);
    Some(start..start.checked_add(number(tag, 8))?)
}

fn word(bytes: &[u8], at: usize) -> [u8; 4] {
    [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]
}

fn number(bytes: &[u8], at: usize) -> usize {
    u32::from_be_bytes(word(bytes, at)) as usize
}

fn number_at(bytes: &[u8], at: usize) -> Option<usize> {
    bytes.get(at..at + 4).map(|bytes| number(bytes, 0))
}
