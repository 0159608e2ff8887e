//! What was measured: tables and bars, printed or written as CSV or JSON.

use std::io::{self, Write};

use comfy_table::{CellAlignment, Table as TextTable, presets};
use serde::Serialize;

use super::stage::Pass;
use crate::gpu::Info;
use crate::measure::{Ratio, Rounds, Samples};

/// All that a run measured.
#[derive(Serialize)]
pub struct Report {
    vglare: &'static str,
    device: Info,
    /// None where each scene has its own.
    size: Option<[u32; 2]>,
    rounds: usize,
    tables: Vec<Table>,
    bars: Vec<Bar>,
}

/// Things that were measured in turns.
#[derive(Serialize)]
pub struct Table {
    title: String,
    /// What the reader must know before taking a number from the table.
    note: Option<String>,
    /// What the ratios are to.
    yardstick: &'static str,
    rows: Vec<Row>,
    /// How many rows are printed.
    #[serde(skip)]
    shown: usize,
}

#[derive(Serialize)]
struct Row {
    what: String,
    wall_ms: f64,
    least_ms: f64,
    most_ms: f64,
    gpu_ms: Option<f64>,
    ratio: Option<Ratio>,
}

/// A [`Row`] of the CSV file.
#[derive(Serialize)]
struct Line<'a> {
    table: &'a str,
    what: &'a str,
    wall_ms: f64,
    least_ms: f64,
    most_ms: f64,
    gpu_ms: Option<f64>,
    yardstick: Option<&'a str>,
    ratio: Option<f64>,
    ratio_in_pairs: Option<f64>,
}

/// A ratio that vglare means to hold.
#[derive(Serialize)]
pub(super) struct Bar {
    pub what: String,
    pub target: Target,
    pub measured: f64,
}

/// What a ratio is meant to be.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// This or less.
    AtMost(f64),
    /// This or more.
    AtLeast(f64),
    /// 1, give or take.
    Equal(f64),
}

impl Bar {
    fn held(&self) -> bool {
        match self.target {
            Target::AtMost(most) => self.measured <= most,
            Target::AtLeast(least) => self.measured >= least,
            Target::Equal(within) => (self.measured - 1.0).abs() <= within,
        }
    }

    fn target(&self) -> String {
        match self.target {
            Target::AtMost(most) => format!("at most {most}"),
            Target::AtLeast(least) => format!("at least {least}"),
            Target::Equal(within) => format!("1 ± {within}"),
        }
    }
}

impl Table {
    /// An empty one, by its title; ratios are to the time of `yardstick`.
    pub fn new(title: impl Into<String>, yardstick: &'static str) -> Self {
        Self { title: title.into(), note: None, yardstick, rows: Vec::new(), shown: usize::MAX }
    }

    /// Prints the first rows only.
    pub(super) fn shown(mut self, rows: usize) -> Self {
        self.shown = rows;
        self
    }

    /// With what the reader must know before taking a number from it.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = Some(note.into());
        self
    }

    /// Adds what was measured, in milliseconds, and its ratio to the yardstick.
    pub fn row(&mut self, what: impl Into<String>, wall: &Samples, ratio: Option<Ratio>) {
        let (wall_ms, least_ms, most_ms) = (wall.median(), wall.min(), wall.max());
        self.rows.push(Row { what: what.into(), wall_ms, least_ms, most_ms, gpu_ms: None, ratio });
    }

    pub(super) fn pass(&mut self, pass: &Pass, yardstick: Option<&Pass>) {
        self.row(&pass.name, &pass.wall, yardstick.map(|yardstick| pass.wall.over(&yardstick.wall)));
        if let Some(row) = self.rows.last_mut() {
            row.gpu_ms = pass.gpu.as_ref().map(Samples::median);
        }
    }

    fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut table = TextTable::new();
        table.load_style(presets::NOTHING);
        let ratio = format!("× {}", self.yardstick);
        table.set_header(["", "wall ms", "least", "most", "GPU ms", &ratio, "in pairs"]);
        for Row { what, wall_ms, least_ms, most_ms, gpu_ms, ratio } in self.rows.iter().take(self.shown) {
            let optional = |value: Option<f64>| value.map_or("-".to_owned(), short);
            let [of_medians, paired] =
                [ratio.map(|ratio| ratio.of_medians), ratio.map(|ratio| ratio.paired)].map(optional);
            let [wall, least, most] = [*wall_ms, *least_ms, *most_ms].map(short);
            table.add_row([what.clone(), wall, least, most, optional(*gpu_ms), of_medians, paired]);
        }
        table.column_iter_mut().skip(1).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
        writeln!(out, "\n{}", self.title)?;
        if let Some(note) = &self.note {
            writeln!(out, "{note}")?;
        }
        writeln!(out, "{}", table.trim_fmt())
    }
}

/// Three digits or so.
fn short(value: f64) -> String {
    match value.abs() {
        100.0.. => format!("{value:.0}"),
        10.0.. => format!("{value:.1}"),
        1.0.. => format!("{value:.2}"),
        _ => format!("{value:.3}"),
    }
}

impl Report {
    /// An empty one, of a device, a size in pixels where there is but one, and how often each thing is measured.
    pub fn new(device: &Info, size: Option<[u32; 2]>, rounds: Rounds) -> Self {
        Self {
            vglare: env!("CARGO_PKG_VERSION"),
            device: device.clone(),
            size,
            rounds: rounds.timed(),
            tables: Vec::new(),
            bars: Vec::new(),
        }
    }

    /// Adds a table.
    pub fn table(&mut self, table: Table) {
        self.tables.push(table);
    }

    /// Adds a ratio, or another number, that is meant to keep to a target.
    pub fn bar(&mut self, what: impl Into<String>, target: Target, measured: f64) {
        self.bars.push(Bar { what: what.into(), target, measured });
    }

    /// The bars that were missed, in words.
    pub(super) fn missed(&self) -> Vec<String> {
        let missed = self.bars.iter().filter(|bar| !bar.held());
        missed.map(|bar| format!("{}: {}, and it is {}", bar.what, bar.target(), short(bar.measured))).collect()
    }

    /// Prints all of it.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        let Info { backend, route, renderer, version, .. } = &self.device;
        let size = self.size.map_or("pictures".to_owned(), |[width, height]| format!("{width} × {height} pixels"));
        writeln!(out, "{renderer}\nOpenGL {version} through {backend} ({route})")?;
        writeln!(out, "{size} of RGBA f32, {} rounds in turns, medians", self.rounds)?;
        let gpu = self.tables.iter().flat_map(|table| &table.rows).any(|row| row.gpu_ms.is_some());
        if !gpu {
            writeln!(out, "No timer query to be trusted here: times are of the wall clock, up to glFinish.")?;
        }
        self.tables.iter().try_for_each(|table| table.print(out))?;
        writeln!(out, "\nBars")?;
        let mut table = TextTable::new();
        table.load_style(presets::NOTHING);
        table.set_header(["", "target", "measured", ""]);
        for bar in &self.bars {
            let verdict = if bar.held() { "held" } else { "missed" };
            table.add_row([&bar.what, &bar.target(), &short(bar.measured), verdict]);
        }
        writeln!(out, "{}", table.trim_fmt())
    }

    /// The rows of all tables, one after the other, as CSV.
    ///
    /// # Errors
    /// None that is known of: text and numbers can always be written.
    pub fn csv(&self) -> Result<String, Box<dyn std::error::Error>> {
        let mut csv = csv::Writer::from_writer(Vec::new());
        for Table { title, yardstick, rows, .. } in &self.tables {
            for Row { what, wall_ms, least_ms, most_ms, gpu_ms, ratio } in rows {
                csv.serialize(Line {
                    table: title,
                    what,
                    wall_ms: *wall_ms,
                    least_ms: *least_ms,
                    most_ms: *most_ms,
                    gpu_ms: *gpu_ms,
                    yardstick: ratio.map(|_| *yardstick),
                    ratio: ratio.map(|ratio| ratio.of_medians),
                    ratio_in_pairs: ratio.map(|ratio| ratio.paired),
                })?;
            }
        }
        Ok(String::from_utf8(csv.into_inner()?)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bar(target: Target, measured: f64) -> Bar {
        Bar { what: String::new(), target, measured }
    }

    #[test]
    fn bars_are_held_at_their_limit_and_missed_beyond_and_for_what_is_no_number() {
        for (held, missed, target) in [(4.0, 4.001, Target::AtMost as fn(f64) -> Target), (4.0, 3.999, Target::AtLeast)]
        {
            assert!(bar(target(4.0), held).held());
            assert!(!bar(target(4.0), missed).held());
            assert!(!bar(target(4.0), f64::NAN).held());
        }
        for (measured, held) in
            [(1.0, true), (1.05, true), (0.95, true), (1.06, false), (0.94, false), (f64::NAN, false)]
        {
            assert_eq!(bar(Target::Equal(0.0501), measured).held(), held, "{measured}");
        }
    }

    #[test]
    fn numbers_have_three_digits_or_so() {
        for (value, text) in [(1234.6, "1235"), (99.94, "99.9"), (4.0, "4.00"), (0.0571, "0.057"), (-12.0, "-12.0")] {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn rows_become_csv_with_empty_cells_for_what_was_not_measured() {
        let device = Info {
            backend: crate::gpu::Backend::OsMesa,
            route: "OSMesa".into(),
            renderer: "a renderer (of 256 bits, say)".into(),
            vendor: String::new(),
            version: "4.5".into(),
            software: true,
            limits: crate::gpu::Limits {
                texture_size: 0,
                viewport: [0; 2],
                doubles: true,
                storage_block: 0,
                uniform_block: 0,
                storage_bindings: 0,
                work_groups: [0; 3],
                work_group_invocations: 0,
                shared_memory: 0,
            },
        };
        let mut report = Report::new(&device, Some([64, 36]), Rounds::new(0, 2));
        let mut table = Table::new("A frame, in parts", "copy");
        let copy = [2.0, 4.0].into_iter().collect();
        table.row("copy", &copy, None);
        table.row("frame", &copy, Some(copy.over(&copy)));
        report.table(table);
        report.bar("frame / copy", Target::AtMost(0.5), 1.0);

        let csv = report.csv().unwrap();
        let lines: Vec<_> = csv.lines().collect();
        assert_eq!(lines[1], "\"A frame, in parts\",copy,3.0,2.0,4.0,,,,");
        assert_eq!(lines[2], "\"A frame, in parts\",frame,3.0,2.0,4.0,,copy,1.0,1.0");

        let mut text = Vec::new();
        report.print(&mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(text.contains("256 bits") && text.contains("No timer query") && text.contains("missed"), "{text}");
        assert_eq!(report.missed(), ["frame / copy: at most 0.5, and it is 1.00"]);
    }
}
