//! Whether the coded data are whole: every code is read, and nothing made of it.
//!
//! Decoders stop where libjpeg would go on with grey, but like it they let pass what no encoder writes: coefficients
//! behind the last of a block, and data that are left over, as they are where some in the middle are missing. A photo
//! that is garbage from there on would have no word about it. ITU-T T.81, annexes F.2.2 and G.2.

use super::super::Reason;
use super::codes::{Bits, Codes};
use super::walk::{DHT, DRI, Frame, Process, Scan, Walk};

/// Reads all codes of a Huffman-coded picture, and notes data that are left over.
///
/// # Errors
/// Where the data end early or no encoder can have written them, with the row where that is.
pub(super) fn check(walk: &Walk, notes: &mut Vec<String>) -> Result<(), Reason> {
    if walk.frame.process == Process::Lossless {
        return Ok(());
    }
    let mut tables = Tables::default();
    let mut bits = Bits::new();
    let mut known = Known::new(&walk.frame);
    let mut segments = walk.segments.iter().peekable();
    let mut left = 0;
    for (number, scan) in walk.scans.iter().enumerate() {
        while let Some(segment) = segments.next_if(|segment| segment.scans_before <= number) {
            tables.take(segment.marker, segment.payload)?;
        }
        let job = Job { frame: &walk.frame, scan, tables: &tables };
        match job.run(&mut bits, &mut known) {
            Ok(bytes) => left += bytes,
            // A picture without tables uses those that the standard gives as an example, as films do.
            Err(Fault::NoTable) => {}
            Err(Fault::Short) if !walk.ended && number + 1 == walk.scans.len() => {
                return Err("the file is cut short".into());
            }
            Err(Fault::Short) => return Err("the file is damaged: its data end before the picture does".into()),
            Err(Fault::Senseless { row }) => {
                return Err(format!("the file is damaged: its data make no sense from row {row} on").into());
            }
        }
    }
    if left > 0 {
        notes.push(format!("the file may be damaged: {left} bytes of its data are left over when the picture is full"));
    }
    Ok(())
}

/// What is wrong with a scan.
enum Fault {
    /// Its codes are not in the file.
    NoTable,
    /// It ends before the picture does.
    Short,
    /// There is no such code, or it leads out of its block.
    Senseless { row: usize },
}

/// What is in force where a scan begins.
#[derive(Default)]
struct Tables {
    /// DC, then AC, by their numbers.
    codes: [[Option<Codes>; 4]; 2],
    /// MCUs between restart markers, or 0.
    restart: usize,
}

impl Tables {
    fn take(&mut self, marker: u8, payload: &[u8]) -> Result<(), Reason> {
        match (marker, payload) {
            (DHT, _) => {
                for (class, number, codes) in Codes::of_segment(payload)? {
                    self.codes[class][number] = Some(codes);
                }
            }
            (DRI, &[high, low, ..]) => self.restart = u16::from_be_bytes([high, low]).into(),
            _ => {}
        }
        Ok(())
    }

    fn get(&self, class: usize, number: u8) -> Result<&Codes, Fault> {
        self.codes[class].get(usize::from(number)).and_then(Option::as_ref).ok_or(Fault::NoTable)
    }
}

/// Which coefficients of a progressive picture's blocks are not 0 so far, by component; bit k is the one at k in zigzag
/// order. The length of the codes of later scans depends on it.
struct Known(Vec<Vec<u64>>);

impl Known {
    fn new(frame: &Frame) -> Self {
        Self(vec![Vec::new(); frame.components.len()])
    }
}

/// One scan.
struct Job<'a> {
    frame: &'a Frame,
    scan: &'a Scan<'a>,
    tables: &'a Tables,
}

/// The codes of one component in a scan, and how many of its blocks an MCU holds.
struct Part<'a> {
    blocks: usize,
    dc: Option<&'a Codes>,
    ac: Option<&'a Codes>,
}

impl<'a> Job<'a> {
    /// Reads the scan; returns the bytes that are left over.
    fn run(&self, bits: &mut Bits, known: &mut Known) -> Result<usize, Fault> {
        let parts = self.parts()?;
        let (across, down) = self.mcus();
        let (single, all) = (self.scan.components[0], across * down);
        let masks = &mut known.0[single];
        let progressive = self.frame.process == Process::Progressive;
        if progressive && self.scan.band.0 > 0 && masks.len() != all {
            *masks = vec![0; all];
        }
        let every = if self.tables.restart == 0 { all } else { self.tables.restart };
        let (mut done, mut left) = (0, 0);
        for (number, piece) in Pieces::of(self.scan.coded).enumerate() {
            let (marker, data) = piece;
            if number > 0 && marker != (number - 1) % 8 {
                return Err(self.fault(done / across));
            }
            // What stands behind the last restart interval.
            if done == all {
                left += data.len();
                continue;
            }
            bits.fill(data);
            let mut run = 0;
            for _ in 0..every.min(all - done) {
                let whole = match (progressive, self.scan.band.0) {
                    (false, _) => parts.iter().all(|part| (0..part.blocks).all(|_| sequential(bits, part).is_some())),
                    (true, 0) => parts.iter().all(|part| (0..part.blocks).all(|_| self.dc(bits, part).is_some())),
                    (true, _) => self.ac(bits, &parts[0], &mut masks[done], &mut run).is_some(),
                };
                if bits.ran_out() {
                    return Err(Fault::Short);
                }
                if !whole {
                    return Err(self.fault(done / across));
                }
                done += 1;
            }
            left += bits.bytes_left();
        }
        if done < all { Err(Fault::Short) } else { Ok(left) }
    }

    fn fault(&self, mcu_row: usize) -> Fault {
        let (_, most_v) = self.frame.most();
        let high = match self.scan.components[..] {
            [single] => 8 * most_v / self.frame.components[single].v,
            _ => 8 * most_v,
        };
        Fault::Senseless { row: mcu_row * high }
    }

    fn parts(&self) -> Result<Vec<Part<'a>>, Fault> {
        let progressive = self.frame.process == Process::Progressive;
        let (dc, ac) = match (progressive, self.scan.band.0, self.scan.high_bit) {
            (false, ..) => (true, true),
            // A bit more of each DC coefficient has no code.
            (true, 0, high) => (high == 0, false),
            (true, ..) => (false, true),
        };
        let alone = self.scan.components.len() == 1;
        let part = |(&index, &(dc_table, ac_table)): (&usize, &(u8, u8))| {
            let component = self.frame.components[index];
            Ok(Part {
                blocks: if alone { 1 } else { component.h * component.v },
                dc: if dc { Some(self.tables.get(0, dc_table)?) } else { None },
                ac: if ac { Some(self.tables.get(1, ac_table)?) } else { None },
            })
        };
        self.scan.components.iter().zip(&self.scan.tables).map(part).collect()
    }

    /// MCUs across and down: T.81 A.2.
    fn mcus(&self) -> (usize, usize) {
        let (most_h, most_v) = self.frame.most();
        match self.scan.components[..] {
            [single] => {
                let (width, height) = self.frame.size_of(self.frame.components[single]);
                (width.div_ceil(8), height.div_ceil(8))
            }
            _ => {
                let (width, height) = (self.frame.width as usize, self.frame.height as usize);
                (width.div_ceil(8 * most_h), height.div_ceil(8 * most_v))
            }
        }
    }

    /// T.81 G.1.2.1: a progressive picture's DC coefficient, or one more bit of it.
    fn dc(&self, bits: &mut Bits, part: &Part) -> Option<()> {
        match part.dc {
            Some(codes) => difference(bits, codes),
            None => {
                bits.skip(1);
                Some(())
            }
        }
    }

    /// T.81 G.1.2.2 and G.1.2.3: the AC coefficients of a band, or one more bit of them; `run` blocks have no more.
    fn ac(&self, bits: &mut Bits, part: &Part, mask: &mut u64, run: &mut u32) -> Option<()> {
        let (first, last) = (u32::from(self.scan.band.0), u32::from(self.scan.band.1));
        if last > 63 || first > last {
            return None;
        }
        match self.scan.high_bit {
            0 => first_bits(bits, part.ac?, (first, last), mask, run),
            _ => next_bit(bits, part.ac?, (first, last), mask, run),
        }
    }
}

/// A DC coefficient's difference: a category, then as many bits.
#[inline]
fn difference(bits: &mut Bits, codes: &Codes) -> Option<()> {
    let category = bits.symbol(codes)?;
    (category <= 15).then(|| bits.skip(category.into()))
}

/// T.81 F.2.2: one block.
#[inline]
fn sequential(bits: &mut Bits, part: &Part) -> Option<()> {
    difference(bits, part.dc?)?;
    let codes = part.ac?;
    let mut at = 1;
    while at < 64 {
        let symbol = bits.symbol(codes)?;
        match (u32::from(symbol >> 4), u32::from(symbol & 15)) {
            (0, 0) => return Some(()),
            (15, 0) => at += 16,
            (_, 0) => return None,
            (zeros, size) => {
                at += zeros + 1;
                bits.skip(size);
            }
        }
    }
    (at == 64).then_some(())
}

/// T.81 G.1.2.2
fn first_bits(bits: &mut Bits, codes: &Codes, (first, last): (u32, u32), mask: &mut u64, run: &mut u32) -> Option<()> {
    if *run > 0 {
        *run -= 1;
        return Some(());
    }
    let mut at = first;
    while at <= last {
        let symbol = bits.symbol(codes)?;
        match (u32::from(symbol >> 4), u32::from(symbol & 15)) {
            (15, 0) => at += 16,
            (more, 0) => {
                *run = (1 << more) - 1 + bits.take(more);
                return Some(());
            }
            (zeros, size) => {
                at += zeros;
                if at > last {
                    return None;
                }
                *mask |= 1 << at;
                bits.skip(size);
                at += 1;
            }
        }
    }
    (at == last + 1).then_some(())
}

/// T.81 G.1.2.3: a bit for each coefficient that is not 0 so far, among the codes for those that become so.
fn next_bit(bits: &mut Bits, codes: &Codes, (first, last): (u32, u32), mask: &mut u64, run: &mut u32) -> Option<()> {
    let mut at = first;
    while *run == 0 && at <= last {
        let symbol = bits.symbol(codes)?;
        let (mut zeros, size) = (u32::from(symbol >> 4), u32::from(symbol & 15));
        match (zeros, size) {
            (15, 0) => {}
            (more, 0) => {
                *run = (1 << more) + bits.take(more);
                break;
            }
            (_, 1) => bits.skip(1),
            _ => return None,
        }
        while at <= last {
            if *mask >> at & 1 == 1 {
                bits.skip(1);
            } else if zeros == 0 {
                break;
            } else {
                zeros -= 1;
            }
            at += 1;
        }
        if size == 1 {
            if at > last {
                return None;
            }
            *mask |= 1 << at;
        }
        at += 1;
    }
    if *run > 0 {
        *run -= 1;
        if at <= last {
            let band = u64::MAX << at & u64::MAX >> (63 - last);
            bits.skip((*mask & band).count_ones());
        }
    }
    Some(())
}

/// The restart intervals of coded data, each with the number of the marker before it.
struct Pieces<'a> {
    rest: Option<&'a [u8]>,
    marker: usize,
}

impl<'a> Pieces<'a> {
    fn of(coded: &'a [u8]) -> Self {
        Self { rest: Some(coded), marker: 0 }
    }
}

impl<'a> Iterator for Pieces<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let coded = self.rest.take()?;
        let before = self.marker;
        let end = coded.windows(2).position(|pair| pair[0] == 0xff && (0xd0..=0xd7).contains(&pair[1]));
        let Some(end) = end else { return Some((before, coded)) };
        self.marker = usize::from(coded[end + 1] & 7);
        self.rest = Some(&coded[end + 2..]);
        Some((before, &coded[..end]))
    }
}
