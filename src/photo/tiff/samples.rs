//! From the bytes of a strip or tile to its samples: order of bits and bytes, predictors, subsampling.

use super::layout::Layout;

/// A sample as it is stored, in the smallest type that holds it.
pub(super) trait Code: bytemuck::Pod + Send + Sync {
    /// The lowest bits of a number.
    fn cut(number: u64) -> Self;
    /// The sum, without what overflows.
    fn plus(self, other: Self) -> Self;
    /// Only the lowest `bits`.
    fn keep(self, bits: u32) -> Self;
    /// From bytes in the file's order.
    fn from_bytes(bytes: Vec<u8>, big_endian: bool) -> Vec<Self>;
}

macro_rules! code {
    ($($type:ty),*) => {$(
        impl Code for $type {
            fn cut(number: u64) -> Self {
                number as Self
            }

            fn plus(self, other: Self) -> Self {
                self.wrapping_add(other)
            }

            fn keep(self, bits: u32) -> Self {
                self & (Self::MAX >> (Self::BITS - bits))
            }

            fn from_bytes(bytes: Vec<u8>, big_endian: bool) -> Vec<Self> {
                let words = bytes.chunks_exact(size_of::<Self>()).map(|word| word.try_into().expect("a whole word"));
                if big_endian { words.map(Self::from_be_bytes).collect() } else { words.map(Self::from_le_bytes).collect() }
            }
        }
    )*};
}

code!(u16, u32, u64);

impl Code for u8 {
    fn cut(number: u64) -> Self {
        number as Self
    }

    fn plus(self, other: Self) -> Self {
        self.wrapping_add(other)
    }

    fn keep(self, bits: u32) -> Self {
        self & (Self::MAX >> (Self::BITS - bits))
    }

    fn from_bytes(bytes: Vec<u8>, _: bool) -> Vec<Self> {
        bytes
    }
}

/// Bytes of `rows` rows of `width` pixels as they are stored; none where that is beyond counting.
pub(super) fn stored_bytes(layout: &Layout, width: u32, rows: u32) -> Option<u64> {
    let (h, v) = layout.subsampling;
    if (h, v) != (1, 1) {
        let blocks = u64::from(width.div_ceil(h)) * u64::from(rows.div_ceil(v));
        return blocks.checked_mul(u64::from(h * v + 2));
    }
    let row = u64::from(width).checked_mul(layout.together() as u64)?.checked_mul(u64::from(layout.bits))?;
    row.div_ceil(8).checked_mul(u64::from(rows))
}

/// The samples of `rows` rows of `width` pixels, `layout.together()` for each pixel.
pub(super) fn unpack<C: Code>(layout: &Layout, mut bytes: Vec<u8>, width: usize, rows: usize) -> Vec<C> {
    if layout.subsampling != (1, 1) {
        return subsampled(layout.subsampling, &bytes, width, rows);
    }
    let (bits, row) = (layout.bits, width * layout.together());
    if layout.predictor == 3 {
        let row_bytes = row * bits as usize / 8;
        bytes.chunks_exact_mut(row_bytes).for_each(|row| undo_float_predictor(row, layout));
    }
    let mut samples: Vec<C> = if bits as usize == 8 * size_of::<C>() {
        // The predictor of floats leaves the highest byte first.
        C::from_bytes(bytes, layout.big_endian || layout.predictor == 3)
    } else if bits == 24 {
        let big_endian = layout.big_endian || layout.predictor == 3;
        let add = |number: u64, &byte: &u8| number << 8 | u64::from(byte);
        let number = |b: &[u8]| if big_endian { b.iter().fold(0, add) } else { b.iter().rev().fold(0, add) };
        bytes.chunks_exact(3).map(|b| C::cut(number(b))).collect()
    } else {
        let row_bytes = (row * bits as usize).div_ceil(8);
        bytes.chunks_exact(row_bytes).flat_map(|bytes| packed(bytes, bits).take(row)).collect()
    };
    if layout.predictor == 2 {
        let step = layout.together();
        for row in samples.chunks_exact_mut(row) {
            for i in step..row.len() {
                row[i] = row[i].plus(row[i - step]).keep(bits);
            }
        }
    }
    samples
}

/// Numbers of `bits` bits, the highest bit first whatever the order of the file's bytes: TIFF 6.0, page 37.
fn packed<C: Code>(bytes: &[u8], bits: u32) -> impl Iterator<Item = C> + '_ {
    let (mut held, mut count, mut next) = (0_u64, 0, bytes.iter());
    std::iter::from_fn(move || {
        while count < bits {
            held = held << 8 | u64::from(*next.next()?);
            count += 8;
        }
        count -= bits;
        Some(C::cut(held >> count & (u64::MAX >> (64 - bits))))
    })
}

/// TIFF technical note 3: a row holds the highest bytes of all its samples, then the next lower ones, and so on, as
/// differences over the whole row. What comes out are samples with their highest byte first.
fn undo_float_predictor(row: &mut [u8], layout: &Layout) {
    let (step, size) = (layout.together(), layout.bits as usize / 8);
    for i in step..row.len() {
        row[i] = row[i].wrapping_add(row[i - step]);
    }
    let planes = row.to_vec();
    let count = row.len() / size;
    for (i, sample) in row.chunks_exact_mut(size).enumerate() {
        for (byte, out) in sample.iter_mut().enumerate() {
            *out = planes[byte * count + i];
        }
    }
}

/// TIFF 6.0, section 21: blocks of h × v pixels, Y of each, then Cb and Cr of all.
fn subsampled<C: Code>((h, v): (u32, u32), bytes: &[u8], width: usize, rows: usize) -> Vec<C> {
    let (h, v) = (h as usize, v as usize);
    let blocks = width.div_ceil(h);
    let size = h * v + 2;
    let mut samples = Vec::with_capacity(width * rows * 3);
    for y in 0..rows {
        for x in 0..width {
            let block = &bytes[(y / v * blocks + x / h) * size..][..size];
            let ycc = [block[y % v * h + x % h], block[h * v], block[h * v + 1]];
            samples.extend(ycc.map(|code| C::cut(u64::from(code))));
        }
    }
    samples
}
