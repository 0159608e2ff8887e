//! Reports as files in a folder, and the page that shows them.

use std::path::{Path, PathBuf};

use super::page::{self, Files};
use super::report::{Field, Figure, Report, Table};
use crate::gpu::Info;
use crate::laboratory::page::{INDEX, csv_text, numbers_csv, open, write_png};
use crate::photo::{self, Photo, WriteOptions};
use crate::{Error, Result, target};

/// A folder with reports: a page, `index.html`, and a folder of files for each report.
pub struct Book {
    folder: PathBuf,
    chapters: Vec<page::Chapter>,
}

impl Book {
    /// Opens the folder, makes it where it is missing, and puts an empty page in it.
    ///
    /// # Errors
    /// [`Error::Occupied`] where the folder holds anything but a former book and `force` is not given;
    /// [`Error::Write`] where it cannot be made or written to.
    pub fn create(folder: &Path, force: bool) -> Result<Self> {
        open(folder, page::GENERATOR, force)?;
        let book = Self { folder: folder.to_owned(), chapters: Vec::new() };
        // From now on the folder is known as a book, even if the first experiment fails.
        book.write_index(None)?;
        Ok(book)
    }

    /// Writes a report's files, and the page anew.
    ///
    /// # Errors
    /// [`Error::Write`] where a file cannot be written.
    pub fn add(&mut self, report: &Report, device: Option<&Info>) -> Result<()> {
        let folder = self.folder.join(report.name);
        target::make_folder(&folder)?;
        let mut files = Files::default();
        for figure in &report.figures {
            files.figures.push(write_figure(&folder, figure)?);
        }
        for table in &report.tables {
            let name = format!("{}.csv", table.stem);
            let path = folder.join(&name);
            target::write_text(&path, &table_csv(table).map_err(|error| Error::write(&path, error))?, true)?;
            files.tables.push(name);
        }
        self.chapters.push(page::Chapter::new(report, &files));
        self.write_index(device)
    }

    /// Where the page is.
    pub fn index(&self) -> PathBuf {
        self.folder.join(INDEX)
    }

    fn write_index(&self, device: Option<&Info>) -> Result<()> {
        target::write_text(&self.index(), &page::page(&self.chapters, device), true)
    }
}

/// Writes what a figure has, and returns the names of the files, the picture first.
fn write_figure(folder: &Path, figure: &Figure) -> Result<Vec<String>> {
    let mut names = Vec::new();
    let mut place = |extension: &str| {
        names.push(format!("{}.{extension}", figure.stem));
        folder.join(names.last().expect("pushed above"))
    };
    write_png(&place("png"), &figure.picture, true)?;
    if let Some(svg) = &figure.svg {
        target::write_text(&place("svg"), svg, true)?;
    }
    if let Some(field) = &figure.field {
        write_exr(&place("exr"), field)?;
    }
    if let Some(numbers) = &figure.numbers {
        let path = place("csv");
        target::write_text(&path, &numbers_csv(numbers).map_err(|error| Error::write(&path, error))?, true)?;
    }
    Ok(names)
}

fn write_exr(path: &Path, field: &Field) -> Result<()> {
    if field.pixels.len() != field.width as usize * field.height as usize {
        return Err(Error::write(path, "the field has not as many pixels as its sides say"));
    }
    let photo = Photo::new(field.width, field.height, field.pixels.clone());
    photo::write(path, &photo, &WriteOptions { overwrite: true, ..WriteOptions::default() })
}

fn table_csv(table: &Table) -> Result<String, Box<dyn std::error::Error>> {
    csv_text(&table.header, table.rows.iter())
}
