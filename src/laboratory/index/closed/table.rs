//! Closed forms as they are printed.

use std::io::{self, Write};

use comfy_table::{CellAlignment, Table, presets};

use super::Closed;
use crate::laboratory::index::told::luminance;

fn per_cent(value: [f64; 3]) -> String {
    format!("{:.3}", 100.0 * luminance(value))
}

/// The closed form of each diameter, beside what is rendered of a place: of the same order.
pub fn columns(closed: &[Closed], number: usize, places: usize) -> Vec<String> {
    closed.iter().skip(number).step_by(places).map(|closed| per_cent(closed.index)).collect()
}

/// A row for each f-number and place, a column for each diameter.
pub fn print(closed: &[Closed], diameters: &[f64], out: &mut dyn Write) -> io::Result<()> {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    let header = ["lens", "place", "off axis"].map(str::to_owned);
    table.set_header(header.into_iter().chain(diameters.iter().map(|diameter| format!("{diameter}° spot, %"))));
    let alike = |one: &Closed, other: &Closed| one.f_number == other.f_number;
    for of_lens in closed.chunk_by(alike) {
        let places = of_lens.len() / diameters.len().max(1);
        for (number, first) in of_lens.iter().take(places).enumerate() {
            let lens = first.f_number.map_or("–".to_owned(), |number| format!("f/{number:.1}"));
            let row = [lens, first.place.unwrap_or("diagonal").to_owned(), format!("{:.1}°", first.off_axis_degrees)];
            table.add_row(row.into_iter().chain(columns(of_lens, number, places)));
        }
    }
    table.column_iter_mut().skip(2).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    writeln!(out, "{}", table.trim_fmt())
}

/// The ghosts' part by rays, where they were traced.
pub fn rays(closed: &[Closed], out: &mut dyn Write) -> io::Result<()> {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(["lens", "off axis", "spot", "closed form, %", "by rays, %"]);
    for closed in closed {
        let Some(rays) = &closed.rays else { continue };
        let [mean, interval] = rays.luminance.map(|value| 100.0 * value);
        table.add_row([
            closed.f_number.map_or("–".to_owned(), |number| format!("f/{number:.1}")),
            format!("{:.1}°", closed.off_axis_degrees),
            format!("{}°", closed.diameter_degrees),
            format!("{:.4}", 100.0 * rays.closed()),
            format!("{mean:.4} ± {interval:.4}"),
        ]);
    }
    if table.row_count() == 0 {
        return Ok(());
    }
    table.column_iter_mut().skip(1).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    writeln!(out, "\n{}", table.trim_fmt())?;
    writeln!(
        out,
        "Of the index what ghosts of two reflections make, in closed form and by exact rays back from the spot's centre, within 99 %."
    )
}
