//! The bits of a fax through the `fax` crate: 1 is black, the highest bit of a byte comes first.

use std::convert::Infallible;

use fax::decoder::{DecodeStatus, Group3Decoder, Group4Decoder};

use super::super::Reason;

/// ITU-T T.6: rows until there are `wanted` bytes.
pub(super) fn group4(packed: &[u8], width: usize, wanted: usize) -> Result<Vec<u8>, Reason> {
    let mut decoder = Group4Decoder::new(packed.iter().map(|&byte| Ok::<_, Infallible>(byte)), columns(width)?)?;
    let mut bytes = Vec::new();
    while bytes.len() < wanted {
        match decoder.advance() {
            Ok(DecodeStatus::Incomplete) => add_row(&mut bytes, decoder.transition(), width),
            Ok(DecodeStatus::End) => break,
            Err(_) => return Err("its fax codes are damaged".into()),
        }
    }
    Ok(bytes)
}

/// ITU-T T.4 in one dimension.
pub(super) fn group3(packed: &[u8], width: usize, wanted: usize, aligned: bool) -> Result<Vec<u8>, Reason> {
    let columns = columns(width)?;
    if aligned {
        return Err("it is compressed by CCITT runs without marks, which vglare does not read".into());
    }
    let damaged = |_| Reason::from("its fax codes are damaged");
    // The decoder wants a mark behind the last row, which libtiff does not write; zeros before a mark are filling.
    let end_of_page = [0x00, 0x10, 0x01].repeat(3);
    let bytes = packed.iter().chain(&end_of_page).map(|&byte| Ok::<_, Infallible>(byte));
    let mut decoder = Group3Decoder::new(bytes).map_err(damaged)?;
    let mut bytes = Vec::new();
    while bytes.len() < wanted {
        let status = decoder.advance().map_err(damaged)?;
        if decoder.transitions().last() != Some(&columns) {
            return Err("its fax rows are of another width".into());
        }
        add_row(&mut bytes, decoder.transitions(), width);
        if status == DecodeStatus::End {
            break;
        }
    }
    Ok(bytes)
}

fn columns(width: usize) -> Result<u16, Reason> {
    u16::try_from(width).map_err(|_| "its fax rows are wider than 65535 pixels".into())
}

/// A row from the columns at which its colour changes, white first.
fn add_row(bytes: &mut Vec<u8>, changes: &[u16], width: usize) {
    let start = bytes.len();
    bytes.resize(start + width.div_ceil(8), 0);
    let row = &mut bytes[start..];
    for run in changes.chunks(2) {
        let end = run.get(1).map_or(width, |&end| usize::from(end).min(width));
        for column in usize::from(run[0])..end {
            row[column / 8] |= 0x80 >> (column % 8);
        }
    }
}
