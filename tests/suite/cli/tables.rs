//! Tables for notebooks: every CSV has one header of names that differ, rows of as many fields, and numbers in columns of
//! numbers.

use std::path::Path;

use super::Workplace;

/// All CSV files in a folder and in those within it.
fn tables(folder: &Path) -> Vec<std::path::PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut found = Vec::new();
    for path in entries.map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            found.extend(tables(&path));
        } else if path.extension().is_some_and(|extension| extension == "csv") {
            found.push(path);
        }
    }
    found
}

/// What is wrong with a table; a cell may be empty.
fn faults(text: &str) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let mut faults = Vec::new();
    for (index, name) in header.iter().enumerate() {
        if name.trim().is_empty() || header[..index].contains(name) {
            faults.push(format!("the name {name:?} is none, or stands twice"));
        }
        let cells = || rows.iter().filter_map(|row| row.get(index)).filter(|cell| !cell.is_empty());
        let numbers = cells().filter(|cell| cell.parse::<f64>().is_ok()).count();
        if numbers != 0 && numbers != cells().count() {
            let text: Vec<_> = cells().filter(|cell| cell.parse::<f64>().is_err()).collect();
            faults.push(format!("{name:?} has numbers and {text:?}"));
        }
        // Text that begins with a number is a number with something on.
        faults.extend(
            cells().filter(|cell| numbers == 0 && cell.starts_with(|c: char| c.is_ascii_digit())).map(Into::into),
        );
    }
    faults.extend(rows.iter().filter(|row| row.len() != header.len()).map(|row| format!("{row:?} for {header:?}")));
    faults
}

/// Checks every table in a folder; there are at least so many.
#[track_caller]
pub fn tidy(folder: &Path, least: usize) {
    let tables = tables(folder);
    assert!(tables.len() >= least, "{tables:?}");
    for path in tables {
        let faults = faults(&std::fs::read_to_string(&path).unwrap());
        assert!(faults.is_empty(), "{}: {faults:?}", path.display());
    }
}

#[test]
fn what_no_notebook_would_read_is_a_fault() {
    assert_eq!(faults("a,b\n1,x\n,y\n2e-3,\n"), [""; 0]);
    for bad in ["a,a\n1,2\n", "a,\n1,2\n", "a,b\n1,2\n1\n", "a\n1\nabout 2\n", "a\n23 %\n", "a,b\n1,2\na,b\n3,4\n"] {
        assert!(!faults(bad).is_empty(), "{bad}");
    }
}

#[test]
fn experiments_write_tidy_tables() {
    let place = Workplace::new();
    for experiment in [
        "benchmark --size 16 --rounds 2 --most 8",
        "fourier-1d --as-printed",
        "fourier-1d-gpu",
        "parabola-2d --size 32",
        "paraboloid-bessel --size 32",
        "gaussian-2d --size 32",
        "cosine-2d --size 32",
        "normalize --size 32",
    ] {
        let words = experiment.split(' ').chain(["-o", "out", "-q"]);
        place.vglare(&["rex"].into_iter().chain(words).collect::<Vec<_>>()).succeeded();
        // normalize and cosine-2d may have pictures alone.
        tidy(&place.path("out"), 0);
    }
    tidy(&place.path("out"), 1);
}
