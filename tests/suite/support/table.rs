//! What a notebook needs of a table: one header of names that differ, rows of as many fields, and nothing but numbers in
//! columns of numbers.

/// What is wrong with a table; a cell may be empty.
pub fn faults(header: &[String], rows: &[Vec<String>]) -> Vec<String> {
    let mut faults = Vec::new();
    for (index, name) in header.iter().enumerate() {
        if name.trim().is_empty() || header[..index].contains(name) {
            faults.push(format!("the name {name:?} is none, or stands twice"));
        }
        let cells = || rows.iter().filter_map(|row| row.get(index)).filter(|cell| !cell.is_empty());
        let numbers = cells().filter(|cell| cell.parse::<f64>().is_ok()).count();
        let text = || cells().filter(|cell| cell.parse::<f64>().is_err());
        if numbers != 0 && numbers != cells().count() {
            faults.push(format!("{name:?} has numbers and {:?}", text().collect::<Vec<_>>()));
        }
        faults.extend(text().filter(|cell| is_quantity(cell)).cloned());
    }
    faults.extend(rows.iter().filter(|row| row.len() != header.len()).map(|row| format!("{row:?} for {header:?}")));
    faults
}

/// Whether text is a number with a unit or a range, as 23 % or 4000 to 5000.
fn is_quantity(cell: &str) -> bool {
    let rest = cell.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    rest.len() < cell.len() && rest.trim_start().starts_with(|c: char| c.is_ascii_alphabetic() || c == '%')
}
