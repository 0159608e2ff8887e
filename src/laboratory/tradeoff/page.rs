//! The page that shows the results to someone who has never seen vglare.

use std::fmt::Write as _;

use super::Results;
use super::captions::glossary;
use super::front::{exponent, fastest, short};
use super::looks::Look;
use super::plots::Plot;
use super::point::{Point, Sweep};
use super::write::Files;
use crate::laboratory::page::{cell, drawn_on, escaped, head, shown, unbroken};

/// What tells a page of these results from others.
pub(super) const GENERATOR: &str = r#"<meta name="generator" content="vglare tradeoff">"#;

const STYLE: &str = "<style>
.headline { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 1rem 1.2rem;
  font-size: 1.15rem; max-width: none }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(27rem, 1fr)); gap: 1.2rem }
.crops { grid-template-columns: repeat(auto-fill, minmax(19rem, 1fr)) }
@media (max-width: 30rem) { .tiles, .crops { grid-template-columns: 1fr } }
th.number { text-align: right } table { font-size: .9rem }
.tiles figure { margin: 0 } .tiles img { width: 100% } .crops img { image-rendering: pixelated }
</style>
";

/// The whole page.
pub(super) fn page(results: &Results, plots: &[Plot], files: &Files) -> String {
    let title = format!("Speed against accuracy: {}", results.photo);
    let mut text = head(&title, GENERATOR) + STYLE;
    let _ = writeln!(text, "<h1>{}</h1>", escaped(&title));
    text.push_str(&subject(results));
    if results.ghosts > 0 {
        text.push_str(&headline(results));
        text.push_str("<h2>What the planner chooses</h2>\n");
        text.push_str(&choices(results));
        text.push_str(&glossary());
    }
    text.push_str(&veil(results));
    if results.ghosts > 0 {
        text.push_str("<h2>What it looks like</h2>\n");
        text.push_str(&pictures(results, files));
    }
    text.push_str("<h2>What was measured</h2>\n");
    for (plot, files) in plots.iter().zip(&files.plots) {
        text.push_str(&figure(plot, files));
    }
    text.push_str("<h2>All numbers</h2>\n");
    let _ = writeln!(
        text,
        "<p><a href=\"results.csv\">results.csv</a> has a row for each setting that was measured, \
         <a href=\"results.json\">results.json</a> the same with what was run on.</p>"
    );
    text.push_str(&drawn_on(&results.device));
    text.push_str("</html>\n");
    text
}

fn subject(results: &Results) -> String {
    let [width, height] = results.picture;
    let [swept, rows] = results.swept;
    let how = match results.picture == results.swept {
        true => "at its own size".to_owned(),
        false => format!("mostly at {swept} × {rows}"),
    };
    let quick = if results.quick { ", quickly" } else { "" };
    format!(
        "<p class=\"soft\">{}, {width} × {height} pixels, {} ghosts; measured {how}{quick}, by \
         <code>vglare tradeoff</code> {}.</p>\n",
        escaped(&results.photo),
        results.ghosts,
        results.vglare,
    )
}

fn headline(results: &Results) -> String {
    let sentence = match &results.recommendation {
        Some(found) => found.sentence(),
        None => "No plan could be had for this scene.".to_owned(),
    };
    let sentence = escaped(&sentence);
    // The one thing to type stands out.
    let marked = match sentence.split_once("--tolerance ").and_then(|(a, b)| Some((a, b.split_once(':')?))) {
        Some((before, (value, after))) => format!("{before}<code>--tolerance {value}</code>:{after}"),
        None => sentence,
    };
    format!("<p class=\"headline\">{}</p>\n", unbroken(&marked))
}

fn choices(results: &Results) -> String {
    let mut text = String::from(
        "<div class=\"wide\"><table>\n<tr><th class=\"number\">tolerance</th><th>evaluator</th><th>degree</th>\
         <th class=\"number\">predicted</th><th class=\"number\">measured</th><th class=\"number\">RMS</th>\
         <th class=\"number\">PSNR, dB</th><th class=\"number\">ΔE2000</th><th class=\"number\">ms</th>\
         <th>least to most</th><th>fastest here</th></tr>\n",
    );
    for point in results.choices() {
        let asked = point.asked.map(exponent).unwrap_or_default();
        if let Some(reason) = &point.refused {
            let _ = writeln!(text, "<tr>{}<td colspan=\"10\" class=\"soft\">{}</td></tr>", cell(&asked), shown(reason));
            continue;
        }
        let error = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.1e}"));
        let number = |value: Option<f64>| value.map_or("–".to_owned(), short);
        let cells = [
            asked,
            point.evaluator.map(|evaluator| evaluator.to_string()).unwrap_or_default(),
            point.degree(),
            error(point.predicted),
            error(point.measured),
            error(point.rms),
            point.psnr_db.map_or("–".to_owned(), |psnr| format!("{psnr:.0}")),
            number(point.delta_e_max),
            number(point.ms),
            format!("{} to {}", number(point.least_ms), number(point.most_ms)),
            other_fastest(results, point),
        ];
        let _ = writeln!(text, "<tr>{}</tr>", cells.iter().map(|value| cell(value)).collect::<String>());
    }
    text + "</table></div>\n"
}

/// The veil at each tolerance; nothing without one.
fn veil(results: &Results) -> String {
    let points = results.of_veil();
    if points.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "<h2>The veil</h2>\n<div class=\"wide\"><table>\n<tr><th class=\"number\">tolerance</th><th>summed by</th>\
         <th class=\"number\">predicted</th><th class=\"number\">measured</th><th class=\"number\">ms</th><th>least to most</th></tr>\n",
    );
    for point in points {
        let asked = point.asked.map(exponent).unwrap_or_default();
        if let Some(reason) = &point.refused {
            let _ = writeln!(text, "<tr>{}<td colspan=\"5\" class=\"soft\">{}</td></tr>", cell(&asked), shown(reason));
            continue;
        }
        let error = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.1e}"));
        let number = |value: Option<f64>| value.map_or("–".to_owned(), short);
        let cells = [
            asked,
            point.summed_by.clone().unwrap_or_default(),
            error(point.predicted),
            error(point.measured),
            number(point.ms),
            format!("{} to {}", number(point.least_ms), number(point.most_ms)),
        ];
        let _ = writeln!(text, "<tr>{}</tr>", cells.iter().map(|value| cell(value)).collect::<String>());
    }
    text + "</table></div>\n"
}

/// What would have been faster than a planner's choice; a dash where nothing was.
fn other_fastest(results: &Results, point: &Point) -> String {
    match fastest(&results.points, point) {
        Some(Point { evaluator: Some(evaluator), ms: Some(ms), .. }) if Some(*evaluator) != point.evaluator => {
            format!("{evaluator}, {} ms", short(*ms))
        }
        _ => "–".to_owned(),
    }
}

fn pictures(results: &Results, files: &Files) -> String {
    let mut text = String::new();
    if let Some(file) = &files.overview {
        let caption = "The photo with its exact glare. The white frame is where the settings below differ most.";
        text.push_str(&picture(file, caption));
    }
    text.push_str("<h3>Enlarged, as it would be shown</h3>\n<div class=\"tiles crops\">\n");
    for (file, caption) in
        [(&files.bare, "Without glare"), (&files.exact, "With the exact glare: the direct sum in f64")]
    {
        if let Some(file) = file {
            text.push_str(&picture(file, caption));
        }
    }
    for (look, [_, crop]) in results.looks.shown.iter().zip(&files.looks) {
        let caption = format!("{}: ΔE2000 up to {} in this crop", setting(look), short(look.delta_e));
        text.push_str(&picture(crop, &caption));
    }
    text.push_str("</div>\n<h3>Where the field is off</h3>\n");
    text.push_str(
        "<p>The error at every pixel, relative to the field’s largest value, the worst colour. The same colours mean the same \
         error in every map: each step down the bar is ten times as exact.</p>\n<div class=\"tiles\">\n",
    );
    for (look, [map, _]) in results.looks.shown.iter().zip(&files.looks) {
        text.push_str(&picture(map, &setting(look)));
    }
    text + "</div>\n"
}

/// A look's setting in words.
fn setting(look: &Look) -> String {
    let Point { asked, evaluator, ms, measured, .. } = &look.point;
    format!(
        "{} at tolerance {}: {} ms, error {:.1e}",
        evaluator.map(|evaluator| evaluator.to_string()).unwrap_or_default(),
        asked.map(exponent).unwrap_or_default(),
        ms.map(short).unwrap_or_default(),
        measured.unwrap_or(f64::NAN),
    )
}

fn picture(file: &str, caption: &str) -> String {
    let caption = caption.trim_end_matches('.');
    format!(
        "<figure><a href=\"{file}\"><img src=\"{file}\" loading=\"lazy\" alt=\"{}\"></a>\n\
         <figcaption>{}.</figcaption></figure>\n",
        escaped(caption),
        shown(caption)
    )
}

fn figure(Plot { stem, caption, chart }: &Plot, [png, svg, csv]: &[String; 3]) -> String {
    let (title, caption, [width, height]) = (escaped(&chart.title), shown(caption), chart.size);
    format!(
        "<figure id=\"{stem}\"><img src=\"{png}\" width=\"{width}\" height=\"{height}\" alt=\"{title}\" \
         loading=\"lazy\">\n<figcaption>{caption} <a href=\"{svg}\">SVG</a> · <a href=\"{png}\">PNG</a> · \
         <a href=\"{csv}\">CSV</a></figcaption></figure>\n"
    )
}

impl Results {
    /// The veil at each tolerance, the coarsest first; with those that cannot be had. Empty without a veil.
    pub fn of_veil(&self) -> Vec<&Point> {
        self.points.iter().filter(|point| point.sweep == Sweep::Veil).collect()
    }

    /// The planner's own choices over tolerances, the coarsest first; with those that it refused.
    pub fn choices(&self) -> Vec<&Point> {
        let own = self.points.iter().filter(|point| point.sweep == Sweep::Tolerance && point.planner);
        let mut own: Vec<&Point> = own.collect();
        own.sort_by(|a, b| b.asked.unwrap_or(0.0).total_cmp(&a.asked.unwrap_or(0.0)));
        own
    }
}
