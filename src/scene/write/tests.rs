use super::*;
use crate::chance::Chance;
use crate::choices::{Beyond, LengthUnit, LightBy, LightShape, Mix, Normalize, Sources};
use crate::choices::{Border, Projection};
use crate::psf::{Name, Parameters};
use crate::scene::{AccuracySection, OpticsSection, Recover, Version, read_scene};
use crate::series::{Disc, SineGaussian, VonMises};

const PERIOD: DVec2 = DVec2::new(4.1, 3.3);

/// Any number of either sign, of 60 orders of magnitude.
fn number(chance: &mut Chance) -> f64 {
    let sign = if chance.between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
    sign * chance.between(1.0, 10.0) * 10f64.powf(chance.between(-30.0, 30.0))
}

fn positive(chance: &mut Chance) -> f64 {
    number(chance).abs()
}

fn maybe<T>(chance: &mut Chance, value: impl FnOnce(&mut Chance) -> T) -> Option<T> {
    (chance.between(0.0, 1.0) < 0.5).then(|| value(chance))
}

fn one_of<T: Clone>(chance: &mut Chance, all: &[T]) -> T {
    all[(chance.between(0.0, 1.0) * all.len() as f64) as usize].clone()
}

fn point(chance: &mut Chance) -> DVec2 {
    DVec2::new(number(chance), number(chance))
}

fn rgb(chance: &mut Chance) -> [f64; 3] {
    [(); 3].map(|()| positive(chance))
}

/// Every bell that a file may name.
fn bells(chance: &mut Chance) -> Vec<Bell> {
    let profile = |last: f64| Bell::Profile(Arc::new(Profile::new(&[[0.25, 3.0], [0.7, 1.0], [last, 0.0]]).unwrap()));
    let mean = chance.between(-1.0, 1.0);
    let periodic = [
        Bell::VonMises(VonMises { period: PERIOD }),
        Bell::SineGaussian(SineGaussian { period: PERIOD, mean }),
        profile(chance.between(0.8, 2.0)),
        profile(3.0),
    ];
    let (rim, rotation) = (chance.between(1e-6, 2.0), number(chance));
    let blades = one_of(chance, &[3, 5, 6, 9, 16]);
    let discs = [(rim, 0, 0.0), (0.0, blades, 0.0), (rim, blades, rotation)];
    let discs = discs.map(|(rim, blades, rotation)| Bell::Disc(Disc::new(rim, blades, rotation).unwrap()));
    let parameterless = Bell::examples().into_iter().take(4);
    parameterless.chain(periodic).chain(discs).collect()
}

fn size(chance: &mut Chance) -> DVec2 {
    let (x, y) = (chance.between(0.1, 2.0), chance.between(0.1, 2.0));
    one_of(chance, &[DVec2::splat(x), DVec2::new(x, y)])
}

fn scene(chance: &mut Chance) -> SceneFile {
    let bells = bells(chance);
    let light = |chance: &mut Chance| Light {
        position: point(chance),
        flux: rgb(chance),
        size: one_of(chance, &[0.0, 0.3]),
        muted: one_of(chance, &[true, false]),
    };
    let ghost = |chance: &mut Chance, bell: &Bell| {
        let (center, size, radiance) = (point(chance), size(chance), [(); 3].map(|()| number(chance)));
        Ghost { bell: bell.clone(), center, size, radiance }
    };
    let lens_ghost = |chance: &mut Chance, bell: &Bell| {
        let (along, size, tint, share) = (number(chance), size(chance), rgb(chance), positive(chance));
        LensGhost { bell: bell.clone(), along, size, tint, share }
    };
    // What either version calls so.
    let optics = maybe(chance, |chance| OpticsSection {
        lens: Some("tessar".into()),
        fstop: maybe(chance, |chance| chance.between(4.0, 22.0)),
        focus: maybe(chance, |chance| chance.between(0.5, 10.0)),
        sensor: one_of(chance, &[None, Some([23.5, 15.6])]),
        blades: one_of(chance, &[None, Some(0), Some(7)]),
        coating: one_of(chance, &[None, Some("none".into()), Some("multi".into())]),
        ..OpticsSection::default()
    });
    let preset = maybe(chance, |_| "v1/zoom".to_owned()).filter(|_| optics.is_none());
    let own = if preset.is_none() && optics.is_none() { bells.clone() } else { Vec::new() };
    let goals = [None, Some(Goal::Tolerance(chance.between(1e-9, 0.9))), Some(Goal::Budget(positive(chance)))];
    let some = (chance.between(0.0, 4.0)) as usize;
    let veil = maybe(chance, |chance| VeilSection {
        parameters: Parameters { age: Some(60.5), scatter: Some(0.1), ..Parameters::new(Name::Cie) },
        fov: Some(50.5),
        projection: one_of(chance, &[None, Some(Projection::Fisheye)]),
        border: one_of(chance, &[None, Some(Border::None)]),
        tolerance: maybe(chance, |chance| chance.between(1e-4, 0.5)),
    });
    SceneFile {
        version: one_of(chance, &[Version::One, Version::Two]),
        description: one_of(chance, &["", "two \"lamps\"\n\\ and é", "[look]"]).to_owned(),
        preset,
        optics,
        axis: maybe(chance, point),
        period: Some(PERIOD),
        degree: one_of(chance, &[None, Some([0, 4096])]),
        look: LookSection {
            strength: maybe(chance, positive),
            size: maybe(chance, positive),
            tint: maybe(chance, rgb),
            mix: one_of(chance, &[None, Some(Mix::Add), Some(Mix::Energy)]),
            normalize: one_of(chance, &[None, Some(Normalize::None), Some(Normalize::Clamp), Some(Normalize::Minmax)]),
            unit: one_of(
                chance,
                &[None, Some(LengthUnit::Height), Some(LengthUnit::ShortSide), Some(LengthUnit::Degrees)],
            ),
            fov: maybe(chance, |chance| chance.between(0.1, 179.0)),
            sources: one_of(chance, &[None, Some(Sources::Photo), Some(Sources::Lights)]),
            recover: one_of(chance, &[None, Some(Recover::Auto), Some(Recover::None), Some(Recover::Stops(2.5))]),
        },
        find: FindSection {
            by: one_of(chance, &[None, Some(LightBy::Luminance), Some(LightBy::Brightest)]),
            shape: one_of(chance, &[None, Some(LightShape::Kept), Some(LightShape::Ball)]),
            beyond: one_of(chance, &[None, Some(Beyond::Join), Some(Beyond::Drop)]),
            threshold: maybe(chance, positive),
            merge: maybe(chance, positive),
            max_lights: one_of(chance, &[None, Some(0), Some(7)]),
            firefly_limit: one_of(chance, &[None, Some(0.0), Some(1.0), Some(5e3)]),
            knee: maybe(chance, positive),
            add: one_of(chance, &[true, false]),
        },
        accuracy: AccuracySection {
            goal: one_of(chance, &goals),
            allow_floor: one_of(chance, &[true, false]),
            each_pixel: false,
            evaluator: maybe(chance, |chance| one_of(chance, &Evaluator::ALL)),
        },
        no_veil: veil.is_none() && one_of(chance, &[true, false]),
        veil,
        lights: maybe(chance, |chance| (0..some).map(|_| light(chance)).collect()),
        ghosts: bells.iter().map(|bell| ghost(chance, bell)).collect(),
        lens_ghosts: own.iter().map(|bell| lens_ghost(chance, bell)).collect(),
    }
}

#[test]
fn what_is_written_is_read_as_the_same_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("look.toml");
    let mut chance = Chance::new(20);
    for _ in 0..200 {
        let scene = scene(&mut chance);
        write_scene(&path, &scene, true).unwrap();
        let read = read_scene(&path).unwrap();
        assert_eq!(read, scene);
        assert_eq!(to_toml(&read), std::fs::read_to_string(&path).unwrap());
    }
    write_scene(&path, &SceneFile::default(), true).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "version = 2\n");
}

#[test]
fn a_file_is_for_people_too() {
    let light = Light { position: DVec2::new(0.3, -2.0), flux: [12.5, 10.0, 0.1], size: 0.0, muted: true };
    let bell = Bell::Profile(Arc::new(Profile::new(&[[0.0, 1.0], [1.0, 0.0]]).unwrap()));
    let scene = SceneFile {
        preset: Some("zoom".into()),
        axis: Some(DVec2::new(0.0, -0.1)),
        look: LookSection { strength: Some(1.5), mix: Some(Mix::Energy), ..LookSection::default() },
        accuracy: AccuracySection { goal: Some(Goal::Tolerance(1e-4)), ..AccuracySection::default() },
        lights: Some(vec![light]),
        ghosts: vec![Ghost { bell, center: DVec2::ZERO, size: DVec2::splat(0.4), radiance: [1.0, 0.5, 0.25] }],
        ..SceneFile::default()
    };
    let expected = r#"version = 2
preset = "zoom"
axis = [0.0, -0.1]

[look]
strength = 1.5
mix = "energy"

[accuracy]
tolerance = 0.0001

[[light]]
position = [0.3, -2.0]
flux = [12.5, 10.0, 0.1]
size = 0.0
muted = true

[[ghost]]
bell = "profile"
profile = "profile-1"
center = [0.0, 0.0]
size = 0.4
radiance = [1.0, 0.5, 0.25]

[[profile]]
name = "profile-1"
rows = [[0.0, 1.0], [1.0, 0.0]]
"#;
    assert_eq!(to_toml(&scene), expected);
}

#[test]
fn a_list_of_no_lights_is_not_the_same_as_no_list() {
    let none = SceneFile {
        lights: Some(Vec::new()),
        look: LookSection { size: Some(2.0), ..Default::default() },
        ..SceneFile::default()
    };
    assert_eq!(to_toml(&none), "version = 2\nlight = []\n\n[look]\nsize = 2.0\n");
}

#[test]
fn what_no_file_can_say_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("look.toml");
    let good = SceneFile::default();
    write_scene(&path, &good, false).unwrap();
    assert!(matches!(write_scene(&path, &good, false), Err(Error::Exists { .. })));
    let bell = Bell::VonMises(VonMises { period: PERIOD });
    let periodic = Ghost { bell, center: DVec2::ZERO, size: DVec2::ONE, radiance: [1.0; 3] };
    let strength = |strength| LookSection { strength: Some(strength), ..LookSection::default() };
    let both = SceneFile { preset: Some("zoom".into()), ..scene(&mut Chance::new(1)) };
    let bad = [
        (SceneFile { look: strength(f64::NAN), ..good.clone() }, "line 4, column 12"),
        (SceneFile { look: strength(-1.0), ..good.clone() }, "not negative, found -1"),
        (SceneFile { preset: Some("fish-eye".into()), ..good.clone() }, "no lens preset is called \"fish-eye\""),
        (SceneFile { lens_ghosts: Vec::new(), ghosts: vec![periodic.clone()], ..good.clone() }, "`period`"),
        (SceneFile { period: Some(DVec2::ONE), ghosts: vec![periodic], ..good }, "the scene's period"),
        (
            SceneFile { lens_ghosts: vec![crate::scene::presets::named("zoom").unwrap().ghosts[0].clone()], ..both },
            "found both",
        ),
    ];
    for (scene, reason) in bad {
        let error = write_scene(&path, &scene, true).unwrap_err().to_string();
        assert!(error.contains(reason) && error.contains("look.toml"), "{reason:?} is not in {error}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "version = 2\n");
    }
}

#[test]
#[cfg(unix)]
fn a_scene_goes_through_a_link_and_keeps_the_permissions() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("look.toml"), "").unwrap();
    std::fs::set_permissions(path("look.toml"), std::fs::Permissions::from_mode(0o640)).unwrap();
    symlink("look.toml", path("link.toml")).unwrap();
    let scene = SceneFile { description: "a veil".into(), ..SceneFile::default() };
    write_scene(&path("link.toml"), &scene, true).unwrap();
    assert!(path("link.toml").is_symlink(), "the link stays a link");
    let kept = std::fs::metadata(path("look.toml")).unwrap();
    assert!(kept.len() > 0 && kept.permissions().mode() & 0o777 == 0o640, "{kept:?}");
}
