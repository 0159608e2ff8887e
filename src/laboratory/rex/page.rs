//! The page that shows reports: one file, without anything from elsewhere.

use std::fmt::Write as _;

use super::report::{Figure, Report, Table};
use crate::gpu::Info;
use crate::laboratory::page::{cell, drawn_on, escaped, head, pairs, shown};

/// What tells a page of this program's from others.
pub(super) const GENERATOR: &str = r#"<meta name="generator" content="vglare rex">"#;

/// The names of the files that a report became, in its own order.
#[derive(Debug, Default)]
pub(super) struct Files {
    /// For each figure the picture and what belongs to it.
    pub figures: Vec<Vec<String>>,
    pub tables: Vec<String>,
}

/// A report on the page.
pub(super) struct Chapter {
    name: &'static str,
    title: String,
    body: String,
}

impl Chapter {
    pub fn new(report: &Report, files: &Files) -> Self {
        let mut body = String::new();
        for paragraph in &report.about {
            let _ = writeln!(body, "<p>{}</p>", shown(paragraph));
        }
        if !report.measures.is_empty() {
            body.push_str(&pairs("Measured", &report.measures));
        }
        if !report.parameters.is_empty() {
            let table = pairs("", &report.parameters);
            let _ = writeln!(body, "<details><summary>Parameters</summary>{table}</details>");
        }
        for (figure, files) in report.figures.iter().zip(&files.figures) {
            body.push_str(&shown_figure(report.name, figure, files));
        }
        for (table, file) in report.tables.iter().zip(&files.tables) {
            body.push_str(&shown_table(report.name, table, file));
        }
        Self { name: report.name, title: report.title.clone(), body }
    }
}

/// The whole page.
pub(super) fn page(chapters: &[Chapter], device: Option<&Info>) -> String {
    let title = match chapters {
        [only] => only.title.as_str(),
        _ => "The prototype’s experiments",
    };
    let mut text = head(title, GENERATOR);
    let version = env!("CARGO_PKG_VERSION");
    let _ = writeln!(text, "<h1>Veiling glare: the prototype’s experiments</h1>");
    let _ = writeln!(text, "<p class=\"soft\">Computed and drawn by <code>vglare rex</code>, version {version}.</p>");
    if chapters.is_empty() {
        let _ = writeln!(text, "<p>No experiment has been finished yet.</p>");
    }
    if chapters.len() > 1 {
        text.push_str("<nav><ol>\n");
        for chapter in chapters {
            let _ = writeln!(text, "<li><a href=\"#{}\">{}</a></li>", chapter.name, escaped(&chapter.title));
        }
        text.push_str("</ol></nav>\n");
    }
    for Chapter { name, title, body } in chapters {
        let _ = writeln!(text, "<section id=\"{name}\">\n<h2>{}</h2>", escaped(title));
        let _ = writeln!(text, "<p class=\"soft\"><code>vglare rex {name}</code></p>\n{body}</section>");
    }
    if let Some(info) = device {
        text.push_str(&drawn_on(info));
    }
    text.push_str("</html>\n");
    text
}

fn shown_figure(folder: &str, figure: &Figure, files: &[String]) -> String {
    let Some(picture) = files.first() else { return String::new() };
    let (caption, described) = (shown(&figure.caption), escaped(&figure.caption));
    let (width, height) = (figure.picture.width(), figure.picture.height());
    let links: Vec<String> = files.iter().map(|file| link(folder, file)).collect();
    format!(
        "<figure id=\"{folder}-{stem}\"><img src=\"{folder}/{picture}\" width=\"{width}\" height=\"{height}\" \
         loading=\"lazy\" alt=\"{described}\">\n<figcaption>{caption} {links}</figcaption></figure>\n",
        stem = figure.stem,
        links = links.join(" · "),
    )
}

fn shown_table(folder: &str, table: &Table, file: &str) -> String {
    let mut text = String::from("<div class=\"wide\"><table>\n");
    let _ = writeln!(text, "<caption>{} {}</caption>", shown(&table.caption), link(folder, file));
    let header: String = table.header.iter().map(|name| format!("<th scope=\"col\">{}</th>", shown(name))).collect();
    let _ = writeln!(text, "<tr>{header}</tr>");
    for row in &table.rows {
        let cells: String = row.iter().map(|value| cell(value)).collect();
        let _ = writeln!(text, "<tr>{cells}</tr>");
    }
    text + "</table></div>\n"
}

/// A link that goes by the file's kind.
fn link(folder: &str, file: &str) -> String {
    let kind = file.rsplit('.').next().unwrap_or(file).to_uppercase();
    format!("<a href=\"{folder}/{file}\">{kind}</a>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_shows_everything_and_escapes_it() {
        let mut report = Report::new("First & <best>").named("one");
        report.say("What \"it\" is.");
        report.parameter("degree", 10);
        report.measure("largest error", "1.0e-3");
        report.figures.push(Figure::new("wave", "A <wave>", image::RgbImage::new(7, 5)));
        let mut table = Table::new("costs", "What it costs", &["what", "ms"]);
        table.row(["copy", "1.5"]);
        report.tables.push(table);
        let files =
            Files { figures: vec![vec!["wave.png".into(), "wave.csv".into()]], tables: vec!["costs.csv".into()] };
        let page = page(&[Chapter::new(&report, &files)], None);
        for part in [
            GENERATOR,
            "First &amp; &lt;best&gt;",
            "What &quot;it&quot; is.",
            "<th scope=\"row\">degree</th><td class=\"number\">10</td>",
            "<td class=\"number\"><span class=\"unbroken\">1.0e-3</span></td>",
            "src=\"one/wave.png\" width=\"7\" height=\"5\"",
            "<a href=\"one/wave.csv\">CSV</a>",
            "<td>copy</td><td class=\"number\">1.5</td>",
        ] {
            assert!(page.contains(part), "{part} is not in {page}");
        }
        assert!(!page.contains("http"), "nothing from elsewhere");
    }
}
