//! What is written becomes a function, and what is wrong is told by its key.

use super::*;
use crate::psf::Unit;

/// A function of TOML text, without files.
fn function(text: &str) -> Result<Psf, Fault> {
    let parameters: Parameters = toml::from_str(text).unwrap();
    let again: Parameters = toml::from_str(&toml::to_string(&parameters).unwrap()).unwrap();
    // By their text, in which what is no number is equal to itself.
    assert_eq!(format!("{parameters:?}"), format!("{again:?}"));
    let table = |path: &std::path::Path| Ok(format!("radius,value\n0.1,1\n0.2,{}\n", path.display()));
    let kernel = |_: &std::path::Path| Kernel::new(1, 1, vec![[1.0; 3]]);
    parameters.function(table, kernel)
}

#[test]
fn every_name_has_a_function() {
    let texts = [
        "psf = 'cie'\nage = 60\npigment = 0.5",
        "psf = 'cie135'",
        "psf = 'spencer'\nluminance = 'scotopic'",
        "psf = 'stiles-holladay'\nage = 30",
        "psf = 'gaussian'\nwidth = 0.05",
        "psf = 'mixture'\nwidths = [0.01, 0.1]\nweights = [1, 2]\ntints = [[1, 1, 1], [1, 0.5, 0.25]]",
        "psf = 'abg'\na = 0.001\nb = 0.0001\ng = 1.8\nend = 2",
        "psf = 'table'\ntable = '0.3'",
        "psf = 'camera'",
        "psf = 'kernel'\nkernel = 'star.exr'",
        "psf = 'starburst'\nfstop = 16\nblades = 7\nrotation = -10\nroundness = 0.2\nsensor = 23.5",
    ];
    for (text, name) in texts.into_iter().zip(Name::ALL) {
        let psf = function(text).unwrap();
        assert_eq!((psf.name(), name.to_string().parse().unwrap()), (name, name));
        let scattered = function(&format!("{text}\nscatter = 0.25")).unwrap();
        if name == Name::Starburst {
            // What the lens scatters besides is none of its own light.
            assert!((scattered.value(20.0) / psf.value(20.0) - 0.75).abs() < 1e-12);
            assert_eq!((psf.unit(), psf.energy(), scattered.energy()), (Unit::Micrometres, 1.0, 1.0));
            continue;
        }
        assert!((scattered.energy() - 0.25).abs() < 1e-15);
        assert!((scattered.value(0.15) / psf.value(0.15) * psf.energy() / 0.25 - 1.0).abs() < 1e-12, "{text}");
        let degrees = matches!(name, Name::Cie | Name::Cie135 | Name::Spencer | Name::StilesHolladay);
        assert_eq!(psf.unit() == Unit::Degrees, degrees);
    }
    assert_eq!(function("psf = 'cie'").unwrap(), function("psf = 'cie'\nage = 25\npigment = 0.5").unwrap());
}

#[test]
fn what_is_wrong_is_told_by_its_key() {
    let cases = [
        ("psf = 'cie'\nage = 121", "age"),
        ("psf = 'cie135'\nage = -1", "age"),
        ("psf = 'cie'\nage = nan", "age"),
        ("psf = 'cie'\npigment = 1.3", "pigment"),
        ("psf = 'cie'\nwidth = 1", "width"),
        ("psf = 'stiles-holladay'\npigment = 0.5", "pigment"),
        ("psf = 'spencer'\nage = 20", "age"),
        ("psf = 'gaussian'", "width"),
        ("psf = 'gaussian'\nwidth = 0", "width"),
        ("psf = 'gaussian'\nwidth = inf", "width"),
        ("psf = 'mixture'\nwidths = []", "widths"),
        ("psf = 'mixture'\nwidths = [1, -1]", "widths"),
        ("psf = 'mixture'\nwidths = [1, 2]\nweights = [1]", "weights"),
        ("psf = 'mixture'\nwidths = [1, 2]\nweights = [0, 0]", "weights"),
        ("psf = 'mixture'\nwidths = [1]\ntints = [[0, 0, 0]]", "tints"),
        ("psf = 'mixture'\nwidths = [1]\ntints = [[1, -1, 0]]", "tints"),
        ("psf = 'abg'\na = 1\nb = 1\ng = 2", "end"),
        ("psf = 'abg'\na = 1\nb = 1", "g"),
        ("psf = 'abg'\na = 1\nb = 0\ng = 3", "b"),
        ("psf = 'table'", "table"),
        ("psf = 'table'\ntable = '-1'", "table"),
        ("psf = 'kernel'", "kernel"),
        ("psf = 'starburst'", "fstop"),
        ("psf = 'starburst'\nfstop = 0.4", "fstop"),
        ("psf = 'starburst'\nfstop = nan", "fstop"),
        ("psf = 'starburst'\nfstop = 8\nblades = 2", "blades"),
        ("psf = 'starburst'\nfstop = 8\nblades = 17", "blades"),
        ("psf = 'starburst'\nfstop = 8\nrotation = inf", "rotation"),
        ("psf = 'starburst'\nfstop = 8\nblades = 0\nrotation = 5", "rotation"),
        ("psf = 'starburst'\nfstop = 8\nroundness = 1.1", "roundness"),
        ("psf = 'starburst'\nfstop = 8\nblades = 0\nroundness = 0.5", "roundness"),
        ("psf = 'starburst'\nfstop = 8\nsensor = 0", "sensor"),
        ("psf = 'starburst'\nfstop = 8\nscatter = 1.1", "scatter"),
        ("psf = 'starburst'\nfstop = 8\nage = 3", "age"),
        ("psf = 'camera'\nfstop = 8", "fstop"),
        ("psf = 'camera'\nscatter = 0", "scatter"),
        ("psf = 'camera'\nscatter = 1.5", "scatter"),
        ("psf = 'camera'\nscatter = nan", "scatter"),
    ];
    for (text, key) in cases {
        let fault = function(text).unwrap_err();
        assert!(fault.key == key && fault.to_string().starts_with(&format!("`{key}`: ")), "{text}: {fault}");
    }
    assert_eq!("moffat".parse::<Name>().unwrap_err().key, "psf");
    assert!(toml::from_str::<Parameters>("psf = 'cie'\nyears = 3").is_err());
}
