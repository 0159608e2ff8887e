//! What an experiment brings back: figures, tables and measured numbers.

use image::RgbImage;

pub use super::chart::Numbers;

use super::chart::Chart;
use crate::Result;

/// One experiment's results, in the order in which they are shown.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// The name on the command line; also its folder's.
    pub name: &'static str,
    /// What the page calls it.
    pub title: String,
    /// Paragraphs: what is shown, and what to see in it.
    pub about: Vec<String>,
    /// What it was run with: name and value.
    pub parameters: Vec<(String, String)>,
    /// Pictures and charts.
    pub figures: Vec<Figure>,
    /// Tables.
    pub tables: Vec<Table>,
    /// What was measured: what, and how much.
    pub measures: Vec<(String, String)>,
}

impl Report {
    /// A report with nothing in it yet; [`super::Experiment::run`] gives it its name.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), ..Self::default() }
    }

    pub(super) fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    /// Adds a paragraph.
    pub fn say(&mut self, paragraph: impl Into<String>) {
        self.about.push(paragraph.into());
    }

    /// Adds a parameter.
    pub fn parameter(&mut self, name: &str, value: impl std::fmt::Display) {
        self.parameters.push((name.to_owned(), value.to_string()));
    }

    /// Adds something measured.
    pub fn measure(&mut self, what: impl Into<String>, value: impl std::fmt::Display) {
        self.measures.push((what.into(), value.to_string()));
    }
}

/// A picture with what belongs to it. Its files go by its stem.
#[derive(Debug, Clone)]
pub struct Figure {
    /// Lower case, digits and hyphens.
    pub stem: String,
    /// What it shows, in words.
    pub caption: String,
    /// Written as PNG.
    pub picture: RgbImage,
    /// Written as SVG.
    pub svg: Option<String>,
    /// Written as CSV.
    pub numbers: Option<Numbers>,
    /// Written as OpenEXR.
    pub field: Option<Field>,
}

impl Figure {
    /// A picture alone.
    pub fn new(stem: impl Into<String>, caption: impl Into<String>, picture: RgbImage) -> Self {
        Self { stem: stem.into(), caption: caption.into(), picture, svg: None, numbers: None, field: None }
    }

    /// A chart, with its numbers.
    ///
    /// # Errors
    /// [`crate::Error::Chart`] where it cannot be drawn.
    pub fn chart(stem: impl Into<String>, caption: impl Into<String>, chart: &Chart) -> Result<Self> {
        let numbers = Some(chart.numbers()).filter(|numbers| !numbers.rows.is_empty());
        Ok(Self { svg: chart.svg()?, numbers, ..Self::new(stem, caption, chart.picture()?) })
    }

    /// The same with numbers.
    #[must_use]
    pub fn numbers(self, numbers: Numbers) -> Self {
        Self { numbers: Some(numbers), ..self }
    }

    /// The same with a field.
    #[must_use]
    pub fn field(self, field: Field) -> Self {
        Self { field: Some(field), ..self }
    }
}

/// A picture in linear light, row by row from the top.
#[derive(Debug, Clone)]
pub struct Field {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// RGBA; `width` × `height` of them.
    pub pixels: Vec<[f32; 4]>,
}

/// Rows of text under a header; shown on the page and written as CSV.
#[derive(Debug, Clone)]
pub struct Table {
    /// Lower case, digits and hyphens.
    pub stem: String,
    /// What it lists, in words.
    pub caption: String,
    /// The columns' names.
    pub header: Vec<String>,
    /// As many cells in each as the header has.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub fn new(stem: impl Into<String>, caption: impl Into<String>, header: &[&str]) -> Self {
        let header = header.iter().map(|&name| name.to_owned()).collect();
        Self { stem: stem.into(), caption: caption.into(), header, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row<T: ToString>(&mut self, cells: impl IntoIterator<Item = T>) {
        self.rows.push(cells.into_iter().map(|cell| cell.to_string()).collect());
    }
}
