//! The results as files.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use image::RgbImage;

use super::page;
use super::plots::{Plot, plots};
use super::{Point, Results};
use crate::laboratory::page::{INDEX, numbers_csv, open, write_png};
use crate::{Error, Result, target};

/// Folders of files beside the page.
const PLOTS: &str = "plots";
const PICTURES: &str = "pictures";

/// Opens the folder before the long work, and makes it where it is missing.
///
/// # Errors
/// [`Error::Occupied`] where the folder holds anything but former results and `force` is not given; [`Error::Write`]
/// where it cannot be made or written to.
pub fn check(folder: &Path, force: bool) -> Result<()> {
    open(folder, page::GENERATOR, force)?;
    target::check(&folder.join(INDEX), true)
}

/// Whether none of what [`write()`] writes into a folder would replace a file that is read.
///
/// # Errors
/// [`Error::Usage`] where it would.
pub fn spare(folder: &Path, inputs: &[PathBuf]) -> Result<()> {
    let tables = [INDEX, "results.csv", "results.json"].map(|name| folder.join(name));
    // The names of plots and pictures come of what is measured; whatever is in their folders may be one of them.
    let within = [PLOTS, PICTURES].iter().filter_map(|name| std::fs::read_dir(folder.join(name)).ok());
    let within = within.flat_map(|entries| entries.flatten()).map(|entry| entry.path());
    let written: Vec<_> = tables.into_iter().chain(within).collect();
    for input in inputs {
        let file = target::Identity::of(input);
        if file.is_some() && written.iter().any(|path| target::Identity::of(path) == file) {
            let (input, folder) = (input.display(), folder.display());
            return Err(Error::Usage(format!("the page in {folder} would replace {input}, which is read")));
        }
    }
    Ok(())
}

/// The names of the files that the page shows, relative to it.
#[derive(Default)]
pub(super) struct Files {
    /// For each plot its picture, and links to it in every format.
    pub plots: Vec<[String; 3]>,
    pub overview: Option<String>,
    pub bare: Option<String>,
    pub exact: Option<String>,
    /// For each look its map and its crop.
    pub looks: Vec<[String; 2]>,
}

/// Writes results.csv, results.json, plots, pictures and, last, the page; gives its name.
///
/// # Errors
/// [`Error::Write`] where a file cannot be written, [`Error::Chart`] where a plot cannot be drawn.
pub fn write(folder: &Path, results: &Results) -> Result<PathBuf> {
    for name in [PLOTS, PICTURES] {
        let path = folder.join(name);
        target::make_folder(&path)?;
    }
    let csv = folder.join("results.csv");
    target::write_text(&csv, &csv_of(&results.points).map_err(|error| Error::write(&csv, error))?, true)?;
    target::write_json(&folder.join("results.json"), results, true)?;
    let plots = plots(results);
    let files = Files {
        plots: plots.iter().map(|plot| write_plot(folder, plot)).collect::<Result<_>>()?,
        ..write_looks(folder, results)?
    };
    let index = folder.join(INDEX);
    target::write_text(&index, &page::page(results, &plots, &files), true)?;
    Ok(index)
}

fn csv_of(points: &[Point]) -> Result<String, Box<dyn std::error::Error>> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    for point in points {
        csv.serialize(point)?;
    }
    Ok(String::from_utf8(csv.into_inner()?)?)
}

/// PNG, SVG and the numbers.
fn write_plot(folder: &Path, Plot { stem, chart, .. }: &Plot) -> Result<[String; 3]> {
    let names = ["png", "svg", "csv"].map(|extension| format!("{PLOTS}/{stem}.{extension}"));
    write_png(&folder.join(&names[0]), &chart.picture()?, true)?;
    if let Some(svg) = chart.svg()? {
        target::write_text(&folder.join(&names[1]), &svg, true)?;
    }
    let path = folder.join(&names[2]);
    target::write_text(&path, &numbers_csv(&chart.numbers()).map_err(|error| Error::write(&path, error))?, true)?;
    Ok(names)
}

fn write_looks(folder: &Path, results: &Results) -> Result<Files> {
    let looks = &results.looks;
    let picture = |name: &str, picture: &RgbImage| {
        let name = format!("{PICTURES}/{name}.png");
        write_png(&folder.join(&name), picture, true).map(|()| name)
    };
    let maybe = |name: &str, found: &Option<RgbImage>| found.as_ref().map(|found| picture(name, found)).transpose();
    let mut files = Files {
        overview: maybe("overview", &looks.overview)?,
        bare: maybe("crop-without-glare", &looks.bare)?,
        exact: maybe("crop-exact", &looks.exact)?,
        ..Files::default()
    };
    for look in &looks.shown {
        let mut name = String::new();
        let (asked, evaluator) = (look.point.asked.unwrap_or(0.0), look.point.evaluator);
        let _ = write!(name, "{asked:e}-{}", evaluator.map_or("none".into(), |evaluator| evaluator.to_string()));
        let map = picture(&format!("error-{name}"), &look.map)?;
        files.looks.push([map, picture(&format!("crop-{name}"), &look.crop)?]);
    }
    Ok(files)
}
