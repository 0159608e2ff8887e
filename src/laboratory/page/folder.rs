//! Files in a folder beside a page.

use std::path::Path;

use serde::Serialize;

use crate::chart::Numbers;
use crate::{Error, Result, target};

/// The page's name.
pub(crate) const INDEX: &str = "index.html";

/// Opens a folder for a page with this generator's line, and makes it where it is missing.
///
/// # Errors
/// [`Error::Occupied`] where the folder holds anything but such a page and what belongs to it, and `force` is not given;
/// [`Error::Write`] where it cannot be made.
pub(crate) fn open(folder: &Path, generator: &str, force: bool) -> Result<()> {
    let refused = |error: std::io::Error| Error::write(folder, error);
    if folder.exists() {
        let empty = std::fs::read_dir(folder).map_err(refused)?.next().is_none();
        let ours = || std::fs::read_to_string(folder.join(INDEX)).is_ok_and(|text| text.contains(generator));
        if !empty && !force && !ours() {
            return Err(Error::Occupied { path: folder.to_owned() });
        }
    }
    target::make_folder(folder)
}

type Reason = Box<dyn std::error::Error>;

/// Numbers as CSV; what is no number becomes an empty cell.
pub(crate) fn numbers_csv(numbers: &Numbers) -> Result<String, Reason> {
    let cells = |row: &Vec<f64>| row.iter().map(|&value| (!value.is_nan()).then_some(value)).collect::<Vec<_>>();
    let rows = numbers.rows.iter().map(cells);
    if numbers.series.is_empty() {
        return csv_text(&numbers.columns, rows);
    }
    let columns = [&["series".to_owned()], &numbers.columns[..]].concat();
    csv_text(&columns, numbers.series.iter().zip(rows))
}

/// Rows under a header as CSV.
pub(crate) fn csv_text<R: Serialize>(header: &[String], rows: impl Iterator<Item = R>) -> Result<String, Reason> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(header)?;
    for row in rows {
        csv.serialize(row)?;
    }
    Ok(String::from_utf8(csv.into_inner()?)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_become_csv_with_empty_cells_for_what_is_missing() {
        let columns = ["x", "y, squared"].map(String::from).to_vec();
        let numbers = Numbers { columns, rows: vec![vec![0.1, 1e-20], vec![0.2, f64::NAN]], series: Vec::new() };
        assert_eq!(numbers_csv(&numbers).unwrap(), "x,\"y, squared\"\n0.1,1e-20\n0.2,\n");
        let named = Numbers { series: ["a", "b"].map(String::from).to_vec(), ..numbers };
        assert_eq!(numbers_csv(&named).unwrap(), "series,x,\"y, squared\"\na,0.1,1e-20\nb,0.2,\n");
    }
}
