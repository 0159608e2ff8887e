//! `vglare lens`.

use serde_json::Value;
use vglare::photo;
use vglare::scene::lenses;

use super::Workplace;

#[test]
fn lenses_are_listed_and_each_is_told() {
    let place = Workplace::new();
    let listed = place.vglare(&["lens"]).succeeded().stdout();
    let list: Vec<Value> = serde_json::from_str(&place.vglare(&["lens", "--json"]).succeeded().stdout()).unwrap();
    assert_eq!(list.len(), lenses::all().len());
    for (lens, entry) in lenses::all().iter().zip(&list) {
        assert!(listed.contains(lens.name) && entry["name"] == lens.name, "{entry}");
        let told: Value =
            serde_json::from_str(&place.vglare(&["lens", lens.name, "--json"]).succeeded().stdout()).unwrap();
        for key in ["focal_length_mm", "f_number"] {
            assert_eq!(told[key], entry[key], "{}", lens.name);
        }
        assert_eq!(told["ghosts"].as_array().unwrap().len() as u64, entry["pairs"].as_u64().unwrap());
    }
}

#[test]
fn drawings_are_pictures_and_replace_nothing() {
    let place = Workplace::new();
    let line =
        ["lens", "double-gauss", "--section", "s.svg", "--ghost", "3,8", "--lamp", "l.png", "--coatings", "c.png"];
    place.vglare(&line).succeeded();
    for name in ["l.png", "c.png"] {
        let picture = photo::read(&place.path(name)).unwrap();
        assert!(picture.width() > 1000 && picture.pixels.iter().any(|pixel| pixel[0] > 0.5));
    }
    let section = std::fs::read_to_string(place.path("s.svg")).unwrap();
    assert_eq!(section.matches("<polygon").count(), 6, "six elements");
    place.vglare(&line).failed(1, &["s.svg", "--force"]);
}

#[test]
fn mistakes_are_told_and_leave_no_file() {
    let place = Workplace::new();
    for (line, code, words) in [
        (&["tessar", "--section", "s.svg", "--ghost", "3,9"][..], 2, ["no ghost 9,3", "surfaces that reflect"]),
        (&["zoom", "--section", "s.pdf"], 1, ["s.pdf", ".svg or .png"]),
        (&["classic-prime", "--lamp", "s.png"], 2, ["classic-prime", "no surfaces"]),
        (&["tessar", "--lamp", "s.png", "--fstop", "1.2"], 1, ["opens to f/3.5", "f/1.2"]),
        (&["tessar", "--lamp", "s.png", "--exact", "9"], 1, ["9 rays", "64"]),
        (&["--section", "s.svg"], 2, ["NAME|FILE", "required"]),
        (&["--fstop", "4"], 2, ["name the lens", "vglare lens"]),
    ] {
        place.vglare(&[&["lens"], line].concat()).failed(code, &words);
        assert_eq!(std::fs::read_dir(place.path(".")).unwrap().count(), 0, "{line:?}");
    }
}
