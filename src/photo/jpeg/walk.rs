//! What a JPEG file holds, by its markers alone: ITU-T T.81 annex B. Nothing is decoded.

use super::super::{MAX_PIXELS, Reason, read::check_size};

const SOI: u8 = 0xd8;
const EOI: u8 = 0xd9;
const SOS: u8 = 0xda;
const DNL: u8 = 0xdc;
const DHP: u8 = 0xde;
/// The frame marker of ITU-T T.87.
const SOF55: u8 = 0xf7;
pub(super) const DQT: u8 = 0xdb;
pub(super) const DHT: u8 = 0xc4;
const DAC: u8 = 0xcc;
pub(super) const DRI: u8 = 0xdd;

/// Files of up to so many scans are decoded whatever their size; encoders write about ten.
const FEW_SCANS: usize = 20;
/// The most scans times pixels of a file with more scans: 40 scans of 26 megapixels. A decoder does each scan's work
/// for all pixels, even where the scan holds next to nothing.
const MOST_WORK: usize = 1 << 30;

/// One marker segment.
pub(super) struct Segment<'a> {
    /// The second byte of the marker.
    pub marker: u8,
    /// What follows the two bytes of length.
    pub payload: &'a [u8],
    /// The segment with its marker.
    pub whole: &'a [u8],
    /// How many scans stand before it.
    pub scans_before: usize,
}

/// How the samples are coded, by the frame's marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Process {
    /// DCT, all of a block at once.
    Sequential,
    /// DCT, by parts of the coefficients.
    Progressive,
    /// Prediction from neighbours.
    Lossless,
}

/// One colour component of the frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Component {
    pub id: u8,
    /// Samples across for each MCU's width, 1..=4.
    pub h: usize,
    /// Samples down for each MCU's height, 1..=4.
    pub v: usize,
    /// The number of its quantisation table.
    pub table: u8,
}

/// The frame header.
pub(super) struct Frame {
    /// The second byte of its marker.
    pub marker: u8,
    pub process: Process,
    /// Bits of a sample, 2..=16.
    pub precision: u8,
    pub width: u32,
    pub height: u32,
    pub components: Vec<Component>,
}

/// One scan: its header, and the coded data behind it.
pub(super) struct Scan<'a> {
    /// Which of the frame's components it holds.
    pub components: Vec<usize>,
    /// First and last coefficient in zigzag order.
    pub band: (u8, u8),
    /// The lowest bit of the coefficients that it brings them to.
    pub low_bit: u8,
    /// The coefficients' next bit if some were there before, 0 in a first scan.
    pub high_bit: u8,
    /// The numbers of the DC and the AC table of each component.
    pub tables: Vec<(u8, u8)>,
    /// From the header's marker to the end of the coded data.
    pub whole: &'a [u8],
    /// The coded data alone, restart markers included.
    pub coded: &'a [u8],
}

/// The markers of one picture, from SOI to EOI.
pub(super) struct Walk<'a> {
    pub frame: Frame,
    pub segments: Vec<Segment<'a>>,
    pub scans: Vec<Scan<'a>>,
    /// The picture alone, with its end marker if it has one: what stands behind belongs to something else.
    pub picture: &'a [u8],
    /// What stands behind the picture's end marker.
    pub behind: &'a [u8],
    /// Whether there is an end marker.
    pub ended: bool,
}

impl<'a> Walk<'a> {
    /// Walks the markers of the picture that begins at the file's first byte.
    ///
    /// # Errors
    /// Where the file is cut short before its first scan, or its headers are damaged or hold a kind that is not read.
    pub fn new(file: &'a [u8]) -> Result<Self, Reason> {
        let (mut frame, mut segments, mut scans) = (None, Vec::new(), Vec::new());
        let mut at = 2;
        let mut ended = false;
        while let Some((marker, begin)) = next_marker(file, at) {
            at = begin + 2;
            match marker {
                EOI => {
                    ended = true;
                    break;
                }
                // A restart marker behind the last block, or a mark without a segment.
                0xd0..=0xd7 | 0x01 => continue,
                SOI => return Err("the file is damaged: a second picture begins within the first".into()),
                DNL => return Err("its height stands behind its first scan (DNL), which vglare does not read".into()),
                SOF55 => return Err("it is a JPEG-LS picture, which vglare does not read".into()),
                DHP => return Err("it is a hierarchical JPEG, which vglare does not read".into()),
                _ => {}
            }
            let Some(payload) = payload(file, at) else { break };
            let end = at + 2 + payload.len();
            match marker {
                SOS => {
                    let frame = frame.as_ref().ok_or("the file is damaged: a scan stands before the frame's header")?;
                    at = end + coded_length(&file[end..]);
                    scans.push(Scan { whole: &file[begin..at], coded: &file[end..at], ..scan(payload, frame)? });
                    continue;
                }
                0xc0..=0xcf if ![DHT, DAC, 0xc8].contains(&marker) => {
                    if frame.is_some() {
                        return Err("it is a hierarchical JPEG, which vglare does not read".into());
                    }
                    frame = Some(Frame::new(marker, payload)?);
                }
                _ => {
                    let whole = &file[begin..end];
                    segments.push(Segment { marker, payload, whole, scans_before: scans.len() });
                }
            }
            at = end;
        }
        match frame {
            Some(frame) if !scans.is_empty() => {
                let (picture, behind) = file.split_at(at.min(file.len()));
                Ok(Self { frame, segments, scans, picture, behind, ended })
            }
            _ if ended => Err("the file is damaged: it holds no picture".into()),
            _ => Err("the file is cut short".into()),
        }
    }

    /// The payloads of the segments of a kind that begin with `name`, without it.
    pub fn named(&self, marker: u8, name: &'static [u8]) -> impl Iterator<Item = &'a [u8]> + '_ {
        let of_kind = self.segments.iter().filter(move |segment| segment.marker == marker);
        of_kind.filter_map(move |segment| segment.payload.strip_prefix(name))
    }

    /// Refuses what no decoder should be given: absurd sizes, sizes that so little data cannot fill, endless work.
    pub fn check(&self) -> Result<(), Reason> {
        let pixels = check_size(self.frame.width, self.frame.height)?;
        let scans = self.scans.len();
        if scans > FEW_SCANS && scans * pixels > MOST_WORK {
            let megapixels = pixels as f64 / 1e6;
            return Err(format!("it sends its {megapixels:.0} megapixels in {scans} scans: too much work").into());
        }
        let coded: usize = self.scans.iter().map(|scan| scan.coded.len()).sum();
        if self.frame.least_bytes() > coded {
            return Err("the file is cut short".into());
        }
        match self.missing() {
            Missing::Nothing | Missing::Detail if self.ended => Ok(()),
            Missing::Nothing => Ok(()),
            _ if !self.ended => Err("the file is cut short".into()),
            _ => Err("the file is damaged: some of its colours have no data".into()),
        }
    }

    /// What the scans do not bring, if each holds what its header says.
    pub fn missing(&self) -> Missing {
        let mut missing = Missing::Nothing;
        for component in 0..self.frame.components.len() {
            let scans = || self.scans.iter().filter(|scan| scan.components.contains(&component));
            let first = scans().any(|scan| self.frame.process != Process::Progressive || scan.band.0 == 0);
            if !first {
                return Missing::Component;
            }
            let whole = |k| scans().any(|scan| scan.low_bit == 0 && (scan.band.0..=scan.band.1).contains(&k));
            if self.frame.process == Process::Progressive && !(0..64).all(whole) {
                missing = Missing::Detail;
            }
        }
        missing
    }
}

/// What is not there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Missing {
    Nothing,
    /// Some scans of a progressive picture: it is softer than it was meant to be.
    Detail,
    /// All of a component.
    Component,
}

impl Frame {
    fn new(marker: u8, payload: &[u8]) -> Result<Self, Reason> {
        let process = match marker & 0x3 {
            0 | 1 => Process::Sequential,
            2 => Process::Progressive,
            _ => Process::Lossless,
        };
        // Differential frames belong to hierarchical files.
        if marker & 0x4 != 0 {
            return Err("it is a hierarchical JPEG, which vglare does not read".into());
        }
        let damaged = || Reason::from("the file is damaged: its frame's header makes no sense");
        let [precision, h1, h0, w1, w0, count, rest @ ..] = payload else { return Err(damaged()) };
        let of = |c: &[u8]| Component { id: c[0], h: usize::from(c[1] >> 4), v: usize::from(c[1] & 15), table: c[2] };
        let components: Vec<_> = rest.chunks_exact(3).take(usize::from(*count)).map(of).collect();
        let sound = |c: &Component| (1..=4).contains(&c.h) && (1..=4).contains(&c.v);
        if components.len() != usize::from(*count) || !components.iter().all(sound) || !(2..=16).contains(precision) {
            return Err(damaged());
        }
        if ![1, 3, 4].contains(count) {
            return Err(format!("it has {count} colour components; vglare reads JPEG of 1, 3 or 4").into());
        }
        if marker & 0x8 != 0 {
            // Its decoder makes something of any data, so that nothing would tell that some are missing.
            return Err("it is a JPEG of arithmetic coding, which vglare does not read".into());
        }
        let (width, height) = (u16::from_be_bytes([*w1, *w0]).into(), u16::from_be_bytes([*h1, *h0]).into());
        if height == 0 && width > 0 {
            return Err("its header gives no height (DNL), which vglare does not read".into());
        }
        Ok(Self { marker, process, precision: *precision, width, height, components })
    }

    /// The largest sampling factors, across and down.
    pub fn most(&self) -> (usize, usize) {
        let most = |of: fn(&Component) -> usize| self.components.iter().map(of).max().unwrap_or(1);
        (most(|c| c.h), most(|c| c.v))
    }

    /// Columns and rows of a component: T.81 A.1.1.
    pub fn size_of(&self, component: Component) -> (usize, usize) {
        let (h, v) = self.most();
        ((self.width as usize * component.h).div_ceil(h), (self.height as usize * component.v).div_ceil(v))
    }

    /// The least coded data that can fill the frame: a Huffman code has a bit at least, and a block two codes, or one
    /// in a progressive picture's first scan.
    fn least_bytes(&self) -> usize {
        let blocks = |&c: &Component| {
            let (width, height) = self.size_of(c);
            width.div_ceil(8) * height.div_ceil(8)
        };
        let blocks: usize = self.components.iter().map(blocks).sum();
        match self.process {
            Process::Sequential => blocks / 4,
            Process::Progressive => blocks / 8,
            Process::Lossless => (self.width as usize * self.height as usize).min(MAX_PIXELS) / 8,
        }
    }
}

/// The next marker at or behind `at`, and where its 0xFF stands; fill bytes and stray bytes are passed over.
fn next_marker(file: &[u8], at: usize) -> Option<(u8, usize)> {
    let found = file.get(at..)?.windows(2).position(|pair| pair[0] == 0xff && !matches!(pair[1], 0 | 0xff))?;
    Some((file[at + found + 1], at + found))
}

/// A segment's content, if all of it is there; `at` is where its length stands.
fn payload(file: &[u8], at: usize) -> Option<&[u8]> {
    let length = usize::from(u16::from_be_bytes(file.get(at..at + 2)?.try_into().ok()?));
    file.get(at + 2..at + length.max(2))
}

/// The length of the coded data at the start of `rest`: up to a marker that is no restart. T.81 B.1.1.5.
fn coded_length(rest: &[u8]) -> usize {
    let ends = |pair: &[u8]| pair[0] == 0xff && !matches!(pair[1], 0 | 0xff | 0xd0..=0xd7);
    rest.windows(2).position(ends).unwrap_or(rest.len())
}

fn scan<'a>(payload: &[u8], frame: &Frame) -> Result<Scan<'a>, Reason> {
    let damaged = || Reason::from("the file is damaged: a scan's header makes no sense");
    let count = usize::from(*payload.first().ok_or_else(damaged)?);
    let Some(&[start, end, bits]) = payload.get(1 + 2 * count..4 + 2 * count) else { return Err(damaged()) };
    let number = |c: &[u8]| frame.components.iter().position(|known| known.id == c[0]).ok_or_else(damaged);
    let components = payload[1..1 + 2 * count].chunks_exact(2).map(number).collect::<Result<Vec<_>, _>>()?;
    if components.is_empty() || components.len() > 4 {
        return Err(damaged());
    }
    let tables = payload[1..1 + 2 * count].chunks_exact(2).map(|c| (c[1] >> 4, c[1] & 15)).collect();
    let (high_bit, low_bit) = (bits >> 4, bits & 15);
    Ok(Scan { components, band: (start, end), high_bit, low_bit, tables, whole: &[], coded: &[] })
}
