//! Bytes as text: UTF-8, UTF-16 of either order, with a mark or without, and Latin-1 where it is none of them.

/// The text of a file. Whatever the bytes are, there is one.
pub(super) fn decode(bytes: &[u8]) -> String {
    let utf16 = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.as_chunks().0.iter().map(|&pair| unit(pair)).collect();
        String::from_utf16_lossy(&units)
    };
    match bytes {
        [0xff, 0xfe, text @ ..] => utf16(text, u16::from_le_bytes),
        [0xfe, 0xff, text @ ..] => utf16(text, u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, text @ ..] => eight_bits(text),
        // Lens files are mostly ASCII, of which one byte of each pair is 0.
        [low, 0, ..] if *low != 0 => utf16(bytes, u16::from_le_bytes),
        [0, low, ..] if *low != 0 => utf16(bytes, u16::from_be_bytes),
        text => eight_bits(text),
    }
}

fn eight_bits(bytes: &[u8]) -> String {
    // Latin-1 is the first 256 characters of Unicode.
    std::str::from_utf8(bytes).map_or_else(|_| bytes.iter().copied().map(char::from).collect(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_gives_the_same_text() {
        let text = "NAME Biotar é\n";
        let pairs = |order: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(order).collect::<Vec<u8>>();
        let (little, big) = (pairs(u16::to_le_bytes), pairs(u16::to_be_bytes));
        let marked = |mark: &[u8], bytes: &[u8]| decode(&[mark, bytes].concat());
        for decoded in [
            decode(text.as_bytes()),
            marked(&[0xef, 0xbb, 0xbf], text.as_bytes()),
            decode(&little),
            decode(&big),
            marked(&[0xff, 0xfe], &little),
            marked(&[0xfe, 0xff], &big),
            decode(b"NAME Biotar \xe9\n"),
        ] {
            assert_eq!(decoded, text);
        }
        assert_eq!(decode(&[0xff, 0xfe, 0x41]), "", "half a character");
    }
}
