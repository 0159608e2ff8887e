//! A lens as text: what is known of it, its surfaces and its ghosts.

use std::fmt::Write as _;

use comfy_table::{CellAlignment, Table, presets as styles};

use super::exact::Exact;
use super::report::{GhostRow, PupilRow, Report, SurfaceRow};

/// Colours that lie further apart than this in a corner of the sensor, in mm, are told.
const APART_MM: f64 = 0.05;

/// Luminance of linear Rec. 709.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// All of it.
pub(super) fn text(report: &Report) -> String {
    let mut text = head(report);
    let surfaces = surfaces(&report.surfaces);
    let _ = writeln!(text, "\n{surfaces}\n\n{}", ghosts(report));
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}", sum(report));
    if report.ghosts.iter().any(|ghost| ghost.exact.is_some()) {
        let _ = writeln!(text, "\n{}", rays(report));
    }
    text
}

fn head(report: &Report) -> String {
    let mut text = String::new();
    let mut line = |what: &str, value: String| {
        let _ = writeln!(text, "{what:<15} {value}");
    };
    line("lens", report.name.clone());
    if !report.description.is_empty() {
        line("", report.description.clone());
    }
    if let Some(patent) = &report.patent {
        line("patent", patent.clone());
    }
    for note in &report.notes {
        line("note", note.clone());
    }
    if !report.settings.is_empty() {
        line("settings", report.settings.join(", "));
    }
    line("focal length", format!("{:.2} mm", report.focal_length_mm));
    line("f-number", format!("{:.2}, wide open {:.2}", report.f_number, report.widest_f_number));
    let [width, height] = report.sensor_mm;
    let stated =
        report.stated_half_field_degrees.map_or_else(String::new, |field| format!("; the source states {field}°"));
    line("half field", format!("{:.1}° in a corner of {width} × {height} mm{stated}", report.half_field_degrees));
    let pupil = |pupil: &PupilRow, from: &str| {
        let side = if pupil.z < 0.0 { "before" } else { "behind" };
        format!("{:.2} mm in diameter, {:.2} mm {side} the {from} vertex", pupil.diameter, pupil.z.abs())
    };
    line("entrance pupil", pupil(&report.entrance_pupil_mm, "first"));
    let at_infinity = || "at infinity".to_owned();
    line("exit pupil", report.exit_pupil_mm.as_ref().map_or_else(at_infinity, |exit| pupil(exit, "last")));
    line("iris", report.blades.map_or_else(|| "round".to_owned(), |blades| format!("{blades} blades")));
    line("back focus", format!("{:.2} mm", report.back_focus_mm));
    line("sensor", format!("{:.2} mm behind the last vertex", report.sensor_distance_mm));
    line("total length", format!("{:.2} mm from the first vertex to the sensor", report.total_length_mm));
    text
}

fn surfaces(rows: &[SurfaceRow]) -> String {
    let mut table = table(["surface", "radius", "thickness", "glass", "index", "Abbe", "semi-aperture", "coating", ""]);
    let conics = rows.iter().any(|row| row.conic != 0.0);
    for row in rows {
        let air = row.index == 1.0 && row.abbe.is_none();
        // What has no name is called by its numbers, which have columns of their own.
        let is_named = !row.glass.starts_with(|first: char| first.is_ascii_digit());
        let stop = if row.stop { "stop" } else { "" };
        let conic = if conics { format!("conic {}", row.conic) } else { String::new() };
        let label = row.label.clone().unwrap_or_default();
        let said: Vec<_> = [stop, &conic, &label].into_iter().filter(|word| !word.is_empty()).collect();
        table.add_row([
            row.number.to_string(),
            row.radius_mm.map_or_else(|| "plane".into(), |radius| format!("{radius:.3}")),
            format!("{:.3}", row.thickness_mm),
            if air || !is_named { String::new() } else { row.glass.clone() },
            if air { String::new() } else { format!("{:.5}", row.index) },
            row.abbe.map_or_else(String::new, |abbe| format!("{abbe:.2}")),
            format!("{:.3}", row.semi_aperture_mm),
            row.coating.unwrap_or_default().to_owned(),
            said.join(", "),
        ]);
    }
    left(&mut table, &[3, 7, 8]);
    table.trim_fmt()
}

fn ghosts(report: &Report) -> String {
    let mut table = table(["ghost", "m_g", "blue − red", "radius mm", "tint", "share %", "focus mm", "in the corner"]);
    let corner = 0.5 * report.sensor_mm[0].hypot(report.sensor_mm[1]);
    for row in &report.ghosts {
        let [red, green, blue] = row.magnification;
        let spread = blue - red;
        let shows = (spread * corner).abs() > APART_MM;
        table.add_row([
            pair(row),
            format!("{green:.3}"),
            if shows { format!("{spread:+.3}") } else { String::new() },
            short(row.radius_mm[1]),
            row.tint.map(|part| format!("{part:.2}")).join(" "),
            percent(luminance(row.share)),
            row.focus_mm.map_or_else(|| "parallel".into(), |focus| format!("{focus:.2}")),
            format!("{:.0} %", 100.0 * row.vignetting),
        ]);
    }
    left(&mut table, &[4]);
    table.trim_fmt()
}

/// What all ghosts have together, and those that are not shown.
fn sum(report: &Report) -> String {
    let whole = luminance(report.share);
    let shown: f64 = report.ghosts.iter().map(|ghost| luminance(ghost.share)).sum();
    let tint = report.share.map(percent).join(" ");
    let mut text = format!(
        "All {} ghosts together have {} % of the light of the image on the axis: {tint} % of its red, green and blue.",
        report.ghosts_in_all,
        percent(whole)
    );
    let fours = &report.four_reflections;
    if fours.gaussians > 0 {
        let _ = write!(
            text,
            "\nLight that is reflected four times has {} % more, in pictures as {} Gaussians.",
            percent(luminance(fours.share)),
            fours.gaussians
        );
    }
    let more = report.ghosts_in_all - report.ghosts.len();
    if more > 0 {
        // What rounding leaves of a difference of sums is not below 0.
        let _ = write!(
            text,
            "\n{more} more ghosts, fainter on the sensor, have {} % of it; --ghosts 0 shows them.",
            percent((whole - shown).max(0.0))
        );
    }
    text
}

/// Exact rays beside the matrices.
fn rays(report: &Report) -> String {
    let off = report.ghosts.iter().find_map(|ghost| ghost.exact.as_ref()?.off_axis.as_ref());
    let mut header = vec!["ghost", "share % by rays", "99 % from", "to", "by matrices", "r.m.s. mm", "by matrices"];
    if off.is_some() {
        header.extend(["off: share %", "by matrices", "centroid mm", "by matrices"]);
    }
    let mut table = table(header);
    for (row, exact) in report.ghosts.iter().filter_map(|row| Some((row, row.exact.as_ref()?))) {
        table.add_row(ray_row(row, exact));
    }
    let wavelength = report.ghosts.iter().find_map(|ghost| Some(ghost.exact.as_ref()?.wavelength_nm));
    let place =
        off.map_or_else(|| "on the axis".into(), |off| format!("on the axis, and {}° off it", off.angle_degrees));
    format!("Exact rays of {:.0} nm, {place}\n{}", wavelength.unwrap_or_default(), table.trim_fmt())
}

fn ray_row(row: &GhostRow, exact: &Exact) -> Vec<String> {
    let [low, high] = exact.share_interval;
    let axis = [exact.share, low, high, exact.paraxial_share].map(percent);
    let sizes = [exact.rms_mm, exact.paraxial_rms_mm].map(short);
    let mut cells: Vec<String> = [pair(row)].into_iter().chain(axis).chain(sizes).collect();
    if let Some(off) = &exact.off_axis {
        let place = |place: Option<f64>| place.map_or_else(|| "dark".into(), |place| format!("{place:.3}"));
        cells.extend([percent(off.share), percent(off.paraxial_share)]);
        cells.extend([place(off.centroid_mm), place(off.paraxial_centroid_mm)]);
    }
    cells
}

fn pair(row: &GhostRow) -> String {
    row.pair.iter().map(usize::to_string).collect::<Vec<_>>().join(",")
}

pub(super) fn luminance(colour: [f64; 3]) -> f64 {
    colour.iter().zip(LUMINANCE).map(|(part, weight)| part * weight).sum()
}

/// A part of light in per cent, in as many digits as it takes to be told from 0.
fn percent(part: f64) -> String {
    match 100.0 * part {
        0.0 => "0".into(),
        percent if percent.abs() < 1e-4 => format!("{percent:.1e}"),
        percent => format!("{percent:.4}"),
    }
}

/// A length in mm.
fn short(length: f64) -> String {
    if length < 1e6 { format!("{length:.3}") } else { format!("{length:.1e}") }
}

/// A table whose columns are at the right.
pub(super) fn table<'a>(header: impl IntoIterator<Item = &'a str>) -> Table {
    let mut table = Table::new();
    table.load_style(styles::NOTHING);
    table.set_header(header);
    table.column_iter_mut().for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    table
}

/// Words are at the left.
pub(super) fn left(table: &mut Table, columns: &[usize]) {
    for (k, column) in table.column_iter_mut().enumerate() {
        if columns.contains(&k) {
            column.set_cell_alignment(CellAlignment::Left);
        }
    }
}
