//! Where a photo goes: nothing is overwritten unasked, nothing is left behind.

use std::fs;
use std::path::Path;

use vglare::Error;
use vglare::photo::{self, Depth, ToneMap, WriteOptions};

use super::{Folder, asymmetric, with_depth};

fn refusal(path: &Path, options: WriteOptions) -> String {
    let photo = asymmetric(3, 2);
    let early = photo::check_target(path, &photo, &options).unwrap_err().to_string();
    let late = photo::write(path, &photo, &options).unwrap_err().to_string();
    assert_eq!(early, late);
    assert!(late.contains(&path.display().to_string()), "{late}");
    late
}

#[test]
fn a_photo_that_is_called_off_leaves_nothing() {
    let folder = Folder::new();
    let photo = asymmetric(300, 200);
    for name in ["a.exr", "a.hdr", "a.pfm", "a.tif", "a.png", "a.jpg"] {
        // At once, and after the first part of the file.
        for parts in [0, 1] {
            let asked = std::cell::Cell::new(0);
            let cancelled = || asked.replace(asked.get() + 1) >= parts;
            let result = photo::write_unless(&folder.path(name), &photo, &WriteOptions::default(), cancelled);
            assert!(matches!(result, Err(Error::Cancelled)), "{name}: {result:?}");
        }
    }
    assert_eq!(fs::read_dir(folder.path(".")).unwrap().count(), 0, "nothing is left behind");
}

#[test]
fn what_a_format_cannot_hold_is_refused() {
    let folder = Folder::new();
    let cases = [
        ("a.bmp", WriteOptions::default(), ".exr, .hdr"),
        ("a", WriteOptions::default(), "no extension"),
        ("a.exr", with_depth(Depth::Eight), "half float, float"),
        ("a.png", with_depth(Depth::Float), "16 bit, 8 bit"),
        ("a.jpg", with_depth(Depth::Sixteen), "JPEG holds 8 bit"),
        ("a.exr", WriteOptions { exposure: 1.0, ..Default::default() }, "scene-linear"),
        ("a.tif", WriteOptions { tone_map: Some(ToneMap::Aces), ..Default::default() }, "scene-linear"),
        ("a.png", WriteOptions { exposure: f64::NAN, ..Default::default() }, "exposure"),
        ("none/a.png", WriteOptions::default(), "no folder"),
    ];
    for (name, options, why) in cases {
        let text = refusal(&folder.path(name), options);
        assert!(text.contains(why), "{name}: {text}");
    }
    let none = WriteOptions { tone_map: Some(ToneMap::None), ..Default::default() };
    photo::check_target(&folder.path("a.exr"), &asymmetric(3, 2), &none).unwrap();
    fs::create_dir(folder.path("folder.exr")).unwrap();
    assert!(refusal(&folder.path("folder.exr"), WriteOptions::default()).contains("folder"));
    assert_eq!(fs::read_dir(folder.path(".")).unwrap().count(), 1, "nothing is left behind");
}

#[test]
fn an_existing_file_is_replaced_only_when_asked() {
    let folder = Folder::new();
    let path = folder.put("a.exr", b"precious");
    let photo = asymmetric(3, 2);
    for result in [
        photo::check_target(&path, &photo, &WriteOptions::default()),
        photo::write(&path, &photo, &WriteOptions::default()),
    ] {
        assert!(matches!(result, Err(Error::Exists { path: p }) if p == path));
    }
    assert_eq!(fs::read(&path).unwrap(), b"precious");
    let overwrite = WriteOptions { overwrite: true, ..Default::default() };
    photo::check_target(&path, &photo, &overwrite).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"precious", "a check changes nothing");
    photo::write(&path, &photo, &overwrite).unwrap();
    assert_eq!(photo::read(&path).unwrap().pixels, photo.pixels);
    assert_eq!(fs::read_dir(folder.path(".")).unwrap().count(), 1);
}

#[test]
fn a_photo_too_large_for_jpeg_is_refused() {
    let folder = Folder::new();
    let wide = asymmetric(65536, 1);
    let text = photo::check_target(&folder.path("a.jpg"), &wide, &WriteOptions::default()).unwrap_err().to_string();
    assert!(text.contains("65535"), "{text}");
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{PermissionsExt, symlink};

    use super::*;

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn permissions_are_those_of_any_new_file_or_of_the_old_one() {
        let folder = Folder::new();
        let usual = mode(&folder.put("usual", b""));
        let path = folder.path("a.exr");
        photo::write(&path, &asymmetric(3, 2), &WriteOptions::default()).unwrap();
        assert_eq!(mode(&path), usual);
        fs::set_permissions(&path, PermissionsExt::from_mode(0o604)).unwrap();
        let overwrite = WriteOptions { overwrite: true, ..Default::default() };
        photo::write(&path, &asymmetric(3, 2), &overwrite).unwrap();
        assert_eq!(mode(&path), 0o604);
    }

    #[test]
    fn a_link_stays_a_link() {
        let folder = Folder::new();
        let real = folder.put("real.exr", b"");
        symlink(&real, folder.path("link.exr")).unwrap();
        let overwrite = WriteOptions { overwrite: true, ..Default::default() };
        photo::write(&folder.path("link.exr"), &asymmetric(3, 2), &overwrite).unwrap();
        assert!(fs::symlink_metadata(folder.path("link.exr")).unwrap().is_symlink());
        assert_eq!(photo::read(&real).unwrap().width(), 3);
    }

    #[test]
    fn a_full_device_is_an_error_in_every_format() {
        if !Path::new("/dev/full").exists() {
            return;
        }
        let folder = Folder::new();
        for extension in ["exr", "hdr", "pfm", "tif", "png", "jpg"] {
            let path = folder.path(&format!("full.{extension}"));
            symlink("/dev/full", &path).unwrap();
            let error = photo::write(&path, &asymmetric(3, 2), &WriteOptions::default()).unwrap_err();
            assert!(matches!(&error, Error::Write { .. }), "{error}");
            assert!(error.to_string().contains("full."), "{error}");
        }
    }

    #[test]
    fn a_folder_that_refuses_is_an_error_before_the_work() {
        // /proc takes no files, not even root's.
        let path = Path::new("/proc/vglare.exr");
        if Path::new("/proc/self").exists() {
            let error = photo::check_target(path, &asymmetric(3, 2), &WriteOptions::default()).unwrap_err();
            assert!(matches!(error, Error::Write { .. }), "{error}");
        }
    }
}
