//! The window itself, on an X server of its own, with a pointer and keys by xdotool.

use std::path::Path;
use std::process::Command;

use vglare::photo::{self, Photo, WriteOptions};

#[test]
fn a_window_is_used_by_pointer_and_keys() {
    let folder = tempfile::tempdir().unwrap();
    let good = folder.path().join("lamp.exr");
    let lamp =
        |i: i32, j: i32| if (i - 80).pow(2) + (j - 40).pow(2) < 36 { [400.0; 4] } else { [0.02, 0.02, 0.02, 1.0] };
    let pixels = (0..160).flat_map(|j| (0..240).map(move |i| lamp(i, j))).collect();
    photo::write(&good, &Photo::new(240, 160, pixels), &WriteOptions::default()).unwrap();
    std::fs::write(folder.path().join("bad.exr"), "no photo").unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/window.sh");
    let done = Command::new("sh").arg(script).arg(env!("CARGO_BIN_EXE_vglare")).arg(folder.path()).output().unwrap();
    let [out, told] = [&done.stdout, &done.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(done.status.success(), "{}\n{out}\n{told}", done.status);
}
