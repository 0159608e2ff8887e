//! Huffman codes and the bits that they are read from: ITU-T T.81, annexes C and F.2.2.

use super::super::Reason;

/// Zeros behind the last byte, so that a block of the longest codes can be read before its end is checked: 64
/// coefficients of 16 + 16 bits, rounded up.
const PADDING: usize = 512;

/// Coded data up to a restart marker or their end, without stuffed bytes.
pub(super) struct Bits {
    data: Vec<u8>,
    /// The next bit.
    at: usize,
    /// The number of bits there are.
    count: usize,
}

impl Bits {
    pub fn new() -> Self {
        Self { data: Vec::new(), at: 0, count: 0 }
    }

    /// Starts again with these data, in which 0xFF is followed by a stuffed zero: T.81 F.1.2.3.
    pub fn fill(&mut self, coded: &[u8]) {
        self.data.clear();
        let mut rest = coded;
        while let Some(at) = rest.iter().position(|&byte| byte == 0xff) {
            // Fill bytes before a marker are no data.
            let stuffed = rest.get(at + 1) == Some(&0);
            self.data.extend_from_slice(&rest[..at + usize::from(stuffed)]);
            rest = &rest[(at + 1 + usize::from(stuffed)).min(rest.len())..];
        }
        self.data.extend_from_slice(rest);
        self.count = self.data.len() * 8;
        self.at = 0;
        self.data.resize(self.data.len() + PADDING, 0);
    }

    /// The next 32 bits, zeros behind the end.
    #[inline]
    fn peek(&self) -> u32 {
        let from = self.at / 8;
        let Some(&bytes) = self.data.get(from..).and_then(<[u8]>::first_chunk::<8>) else { return 0 };
        (u64::from_be_bytes(bytes) << (self.at % 8) >> 32) as u32
    }

    /// Takes `count` bits, at most 16.
    #[inline]
    pub fn take(&mut self, count: u32) -> u32 {
        let bits = (u64::from(self.peek()) >> (32 - count)) as u32;
        self.skip(count);
        bits
    }

    #[inline]
    pub fn skip(&mut self, count: u32) {
        self.at += count as usize;
    }

    /// Takes the symbol of the next code; none if there is no such code.
    #[inline]
    pub fn symbol(&mut self, codes: &Codes) -> Option<u8> {
        let (symbol, length) = codes.find(self.peek())?;
        self.skip(length);
        Some(symbol)
    }

    /// Whether more was taken than there is.
    #[inline]
    pub fn ran_out(&self) -> bool {
        self.at > self.count
    }

    /// Whole bytes that nothing was taken from.
    pub fn bytes_left(&self) -> usize {
        self.count.saturating_sub(self.at) / 8
    }
}

/// One Huffman table.
#[derive(Clone)]
pub(super) struct Codes {
    /// Symbol and length by the next bits; length 0 where the code is longer.
    short: Vec<(u8, u8)>,
    /// For each length from 1 the first 32 bits behind its last code, or 0, and what makes its code an index.
    long: [(u64, i64); 16],
    symbols: Vec<u8>,
}

const SHORT: u32 = 10;

impl Codes {
    /// The tables of a DHT segment: (1 for AC, number, table).
    ///
    /// # Errors
    /// Where the segment is no set of Huffman tables.
    pub fn of_segment(mut payload: &[u8]) -> Result<Vec<(usize, usize, Self)>, Reason> {
        let damaged = || Reason::from("the file is damaged: its Huffman tables make no sense");
        let mut tables = Vec::new();
        while let [place, rest @ ..] = payload {
            let (counts, rest) = rest.split_at_checked(16).ok_or_else(damaged)?;
            let total: usize = counts.iter().map(|&count| usize::from(count)).sum();
            let (symbols, rest) = rest.split_at_checked(total).ok_or_else(damaged)?;
            let (class, number) = (usize::from(place >> 4), usize::from(place & 15));
            if class > 1 || number > 3 || total > 256 {
                return Err(damaged());
            }
            tables.push((class, number, Self::new(counts, symbols).ok_or_else(damaged)?));
            payload = rest;
        }
        Ok(tables)
    }

    /// T.81 C.2: codes of one length are consecutive, and begin behind those of the lengths before.
    fn new(counts: &[u8], symbols: &[u8]) -> Option<Self> {
        let mut short = vec![(0, 0); 1 << SHORT];
        let mut long = [(0, 0); 16];
        let (mut code, mut index) = (0_u32, 0_usize);
        for (place, &count) in counts.iter().enumerate() {
            let length = place as u32 + 1;
            long[place].1 = index as i64 - i64::from(code);
            for _ in 0..count {
                if code >= 1 << length {
                    return None;
                }
                if length <= SHORT {
                    let first = (code << (SHORT - length)) as usize;
                    short[first..first + (1 << (SHORT - length))].fill((symbols[index], length as u8));
                }
                (code, index) = (code + 1, index + 1);
            }
            if count > 0 {
                long[place].0 = u64::from(code) << (32 - length);
            }
            code <<= 1;
        }
        Some(Self { short, long, symbols: symbols.to_vec() })
    }

    #[inline]
    fn find(&self, bits: u32) -> Option<(u8, u32)> {
        let (symbol, length) = self.short[(bits >> (32 - SHORT)) as usize];
        if length > 0 {
            return Some((symbol, length.into()));
        }
        let place = (SHORT as usize..16).find(|&place| u64::from(bits) < self.long[place].0)?;
        let length = place as u32 + 1;
        let index = i64::from(bits >> (32 - length)) + self.long[place].1;
        Some((*self.symbols.get(usize::try_from(index).ok()?)?, length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Codes of 1, 2, 3 … bits: 0, 10, 110 …; the last of 16 bits is all ones but the last.
    fn ladder() -> Codes {
        let payload = [vec![0x00], vec![1; 16], (0..16).collect()].concat();
        Codes::of_segment(&payload).unwrap().pop().unwrap().2
    }

    #[test]
    fn every_length_of_code_is_found() {
        let codes = ladder();
        for length in 1..=16_u32 {
            let bits = !(u32::MAX >> (length - 1));
            assert_eq!(codes.find(bits), Some((length as u8 - 1, length)), "{length}");
            assert_eq!(codes.find(bits | u32::MAX >> length), Some((length as u8 - 1, length)), "{length}");
        }
        assert_eq!(codes.find(u32::MAX), None);
    }

    #[test]
    fn stuffed_zeros_are_no_data_and_fill_bytes_neither() {
        let mut bits = Bits::new();
        bits.fill(&[0xff, 0x00, 0x12, 0xff]);
        assert_eq!((bits.take(16), bits.bytes_left(), bits.ran_out()), (0xff12, 0, false));
        bits.skip(1);
        assert!(bits.ran_out());
    }

    #[test]
    fn more_codes_than_there_is_room_for_are_refused() {
        let payload = [vec![0x00, 3], vec![0; 15], vec![0; 3]].concat();
        assert!(Codes::of_segment(&payload).is_err());
    }
}
