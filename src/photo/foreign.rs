//! Formats that are known by their first bytes and not read: what they are called, and what makes pictures of them that are.

/// A format, and what to do about it.
struct Foreign {
    name: &'static str,
    convert: &'static str,
}

const HEIF: &str = "convert it, as by heif-convert IN.heic OUT.png of libheif";
const AVIF: &str = "convert it, as by avifdec --depth 16 IN.avif OUT.png of libavif";
const JPEG_2000: &str = "convert it, as by opj_decompress -i IN.jp2 -o OUT.tif of OpenJPEG";
const WEBP: &str = "convert it, as by dwebp IN.webp -o OUT.png of libwebp";
const FILM: &str = "write its frames as OpenEXR or PNG first, as by oiiotool IN.dpx -o OUT.exr of OpenImageIO";
const ANY: &str = "convert it, as by magick IN OUT.png of ImageMagick";
const VIDEO: &str = "write its frames as PNG first, as by ffmpeg -i IN -pix_fmt rgb48 OUT.%04d.png";
const TEXT: &str = "render it as PNG first, as by inkscape, resvg or pdftoppm";
/// Of raw data of cameras.
pub(super) const RAW: &str =
    "develop it first, as by darktable-cli IN OUT.tif, rawtherapee-cli -t -b16 -c IN, or dcraw_emu -T -4 IN of LibRaw";

/// Says of a file that begins so what it is; none where that is not known.
pub(super) fn refusal(head: &[u8]) -> Option<String> {
    let Foreign { name, convert } = of(head)?;
    Some(format!("it is {name}, which vglare does not read: {convert}"))
}

fn of(head: &[u8]) -> Option<Foreign> {
    let (name, convert) = match head {
        [0, 0, 0, 12, b'j', b'P', b' ', b' ', ..] | [0xff, 0x4f, 0xff, 0x51, ..] => ("JPEG 2000", JPEG_2000),
        [_, _, _, _, b'f', b't', b'y', b'p', brands @ ..] => iso(brands),
        [b'I', b'I', b'R', b'O' | b'S', ..] | [b'M', b'M', b'O', b'R', ..] => {
            ("a camera's raw data (Olympus ORF)", RAW)
        }
        [b'I', b'I', b'U', 0, ..] => ("a camera's raw data (Panasonic RW2)", RAW),
        [b'I', b'I', 0xbc, ..] => ("JPEG XR", "convert it, as by JxrDecApp -i IN.jxr -o OUT.tif of jxrlib"),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => ("WebP", WEBP),
        [b'S', b'D', b'P', b'X', ..] | [b'X', b'P', b'D', b'S', ..] => ("DPX", FILM),
        [0x80, 0x2a, 0x5f, 0xd7, ..] => ("Cineon", FILM),
        [0, b'M', b'R', b'M', ..] => ("a camera's raw data (Minolta MRW)", RAW),
        [b'P', b'1'..=b'7', b'\n' | b'\r' | b' ' | b'\t' | b'#', ..] => ("PNM", ANY),
        [b'B', b'M', _, _, _, _, 0, 0, 0, 0, ..] => ("BMP", ANY),
        _ => {
            let known: [(&[u8], &str, &str); 16] = [
                (b"FUJIFILMCCD-RAW", "a camera's raw data (Fujifilm RAF)", RAW),
                (b"FOVb", "a camera's raw data (Sigma X3F)", RAW),
                (b"GIF8", "GIF", ANY),
                (
                    b"8BPS",
                    "Photoshop",
                    "save it as TIFF there, or convert it, as by magick IN.psd[0] OUT.tif of ImageMagick",
                ),
                (b"qoif", "QOI", ANY),
                (b"DDS ", "DDS", ANY),
                (b"farbfeld", "farbfeld", ANY),
                (b"gimp xcf", "GIMP", "export it as OpenEXR or TIFF there"),
                (b"SIMPLE  =", "FITS", ANY),
                (b"BPG\xfb", "BPG", "convert it, as by bpgdec -o OUT.png IN.bpg of libbpg"),
                (b"\0\0\x01\0", "ICO", ANY),
                (b"%PDF", "PDF", TEXT),
                (b"%!PS", "PostScript", TEXT),
                (b"<svg", "SVG", TEXT),
                (b"\x1aE\xdf\xa3", "Matroska", VIDEO),
                (b"AT&TFORM", "DjVu", ANY),
            ];
            let (_, name, convert) = known.into_iter().find(|(magic, ..)| head.starts_with(magic))?;
            (name, convert)
        }
    };
    Some(Foreign { name, convert })
}

/// ISO base media, by its brands, of which the first is the major one: ISO/IEC 23008-12, annex B; AV1 Image File Format, 9.
fn iso(brands: &[u8]) -> (&'static str, &'static str) {
    // Behind the major brand stands its version; what is compatible goes on until the box ends, be that known or not.
    let major = brands.get(..4);
    let compatible = || brands.get(8..).unwrap_or_default().chunks_exact(4).take(16);
    let is = |names: &[&[u8]]| major.is_some_and(|major| names.contains(&major));
    let holds = |names: &[&[u8]]| compatible().any(|brand| names.contains(&brand));
    let heif: [&[u8]; 6] = [b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx"];
    let avif: [&[u8]; 2] = [b"avif", b"avis"];
    match () {
        () if is(&[b"crx "]) => ("a camera's raw data (Canon CR3)", RAW),
        () if is(&avif) || is(&[b"mif1", b"msf1", b"miaf"]) && holds(&avif) => ("AVIF", AVIF),
        () if is(&heif) || is(&[b"mif1", b"msf1", b"miaf"]) && holds(&heif) => ("HEIC", HEIF),
        () if is(&[b"mif1", b"msf1", b"miaf"]) => ("HEIF", HEIF),
        () if is(&[b"jp2 ", b"jpx ", b"jph "]) => ("JPEG 2000", JPEG_2000),
        () => ("a film", VIDEO),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_is_called_by_its_name_and_with_a_way_out() {
        let files: [(&[u8], &str, &str); 20] = [
            (b"\0\0\0\x0cjP  \r\n\x87\n", "JPEG 2000", "opj_decompress"),
            (b"\0\0\0\x18ftypheic\0\0\0\0mif1heic", "HEIC", "heif-convert"),
            (b"\0\0\0\x18ftypmif1\0\0\0\0mif1miaf", "HEIF", "heif-convert"),
            (b"\0\0\0\x1cftypmif1\0\0\0\0mif1avifmiaf", "AVIF", "avifdec"),
            (b"\0\0\0\x20ftypavif\0\0\0\0avifmif1miaf", "AVIF", "avifdec"),
            (b"\0\0\0\x18ftypcrx \0\0\0\x01crx isom", "Canon CR3", "darktable-cli"),
            (b"\0\0\0\x18ftypisom\0\0\0\x01isomavc1", "film", "ffmpeg"),
            (b"IIRO\x08\0\0\0", "Olympus ORF", "dcraw_emu"),
            (b"IIU\0\x18\0\0\0", "Panasonic RW2", "dcraw_emu"),
            (b"FUJIFILMCCD-RAW 0201", "Fujifilm RAF", "rawtherapee-cli"),
            (b"II\xbc\x01\x20\0\0\0", "JPEG XR", "JxrDecApp"),
            (b"RIFF\x24\0\0\0WEBPVP8 ", "WebP", "dwebp"),
            (b"GIF89a", "GIF", "magick"),
            (b"BM\x36\0\0\0\0\0\0\0\x36", "BMP", "magick"),
            (b"8BPS\0\x01", "Photoshop", "TIFF"),
            (b"P6\n2 2\n255\n", "PNM", "magick"),
            (b"SDPX\0\0\x08\0", "DPX", "oiiotool"),
            (b"qoif\0\0", "QOI", "magick"),
            (b"<svg xmlns=", "SVG", "resvg"),
            (b"%PDF-1.7", "PDF", "pdftoppm"),
        ];
        for (head, name, tool) in files {
            let said = refusal(head).unwrap_or_default();
            assert!(said.contains(name) && said.contains(tool), "{name}: {said:?}");
        }
        assert_eq!(refusal(b"Plain text"), None);
        for head in [&b"\0\0\0\x18ftyp"[..], b"RIFF", b"", b"\0"] {
            // Cut anywhere.
            let _ = refusal(head);
        }
    }
}
