//! Tables for notebooks: every CSV that a command writes is one that a notebook reads.

use std::path::{Path, PathBuf};

use super::Workplace;
use crate::support::table;

/// All CSV files in a folder and in those within it.
fn tables(folder: &Path) -> Vec<PathBuf> {
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

fn faults(text: &str) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
    let strings = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
    let header = strings(reader.headers().unwrap());
    table::faults(&header, &reader.records().map(|record| strings(&record.unwrap())).collect::<Vec<_>>())
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
    for bad in
        ["a,a\n1,2\n", "a,\n1,2\n", "a,b\n1,2\n1\n", "a\n1\nabout 2\n", "a\n23 %\n", "a\n2 to 3\n", "a\n1\na\n3\n"]
    {
        assert!(!faults(bad).is_empty(), "{bad}");
    }
}

#[test]
fn the_benchmark_is_written_as_tidy_tables() {
    let place = Workplace::new();
    let args = ["rex", "benchmark", "--size", "16", "--rounds", "2", "--most", "8", "-o", "out", "-q"];
    place.vglare(&args).succeeded();
    tidy(&place.path("out"), 2);
}
