//! Reports that wait in a file for the end of a run: a report a photo would fill the memory of a long shot.

use std::cell::RefCell;
use std::fs::File;
use std::io::{self, BufRead as _, BufReader, BufWriter, Seek as _, Write as _};
use std::path::Path;

use serde::ser::{Error as _, SerializeSeq as _};
use serde::{Serialize, Serializer};
use serde_json::Value;

/// As JSON, the list of all that was added, in order.
pub struct Spool {
    /// A line each. It has no name, and is gone with the program, however that ends.
    file: RefCell<BufWriter<File>>,
    count: usize,
}

impl Spool {
    /// An empty one, in the folder where there will have to be room for the whole list, or else where temporary files go.
    ///
    /// # Errors
    /// Those of the system.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let file = tempfile::tempfile_in(folder).or_else(|_| tempfile::tempfile())?;
        Ok(Self { file: RefCell::new(BufWriter::new(file)), count: 0 })
    }

    /// Adds to the list what is JSON in a line.
    ///
    /// # Errors
    /// Those of the system, as where the disk is full.
    pub fn add(&mut self, json: &str) -> io::Result<()> {
        let file = self.file.get_mut();
        writeln!(file, "{json}")?;
        self.count += 1;
        Ok(())
    }
}

impl Serialize for Spool {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut file = self.file.borrow_mut();
        // Seeking writes what waits to be written first.
        file.rewind().map_err(S::Error::custom)?;
        let mut list = serializer.serialize_seq(Some(self.count))?;
        for line in BufReader::new(file.get_ref()).lines() {
            let value: Value = serde_json::from_str(&line.map_err(S::Error::custom)?).map_err(S::Error::custom)?;
            list.serialize_element(&value)?;
        }
        list.end()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_was_added_comes_back_in_order_and_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        let mut spool = Spool::new(folder.path()).unwrap();
        assert_eq!(serde_json::to_string(&spool).unwrap(), "[]");
        let values = [json!({ "z": "two\nlines", "a": 0.1 + 0.2 }), json!([1e-320, f64::MAX, 5e22]), json!(null)];
        values.iter().for_each(|value| spool.add(&value.to_string()).unwrap());
        for _ in 0..2 {
            let text = serde_json::to_string_pretty(&spool).unwrap();
            assert_eq!(text, serde_json::to_string_pretty(&values).unwrap());
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "it has no name");
    }
}
