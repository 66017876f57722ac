//! Tables of numbers: comma-separated values with a line of names, as `jostle run` and other programs write them.

use std::fmt;

use jostle_language::{cells, drop_empty_ends, separator};

/// A column of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// Its name, without the unit.
    pub name: String,
    /// The unit in brackets after the name, or an empty text.
    pub unit: String,
    /// Its numbers; an empty cell is not a number.
    pub values: Vec<f64>,
}

/// The mistake in a table, and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableError {
    /// The line, counted from 1.
    pub line: usize,
    /// The mistake.
    pub message: String,
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

impl std::error::Error for TableError {}

/// Reads a table: names in the first line, `height [m]` or `height (m)`, then a row of numbers in each line. Commas,
/// semicolons or tabs separate the cells, whichever is most frequent in the first line. Cells may stand in double
/// quotes. Empty lines, lines that begin with `#` and empty cells behind the last column are skipped.
///
/// # Errors
/// A [`TableError`] names the first line that is not as it should be.
pub fn read(text: &str) -> Result<Vec<Column>, TableError> {
    let text = text.trim_start_matches('\u{feff}');
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line));
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let fail = |line, message: String| Err(TableError { line, message });
    let Some((line, header)) = lines.next() else { return fail(1, "the file has no line of names".to_owned()) };
    let separator = separator(header);
    let split = |line, text| {
        cells(text, separator).ok_or_else(|| TableError { line, message: "a quote is not closed".to_owned() })
    };
    let mut names = split(line, header)?;
    drop_empty_ends(&mut names, 1);
    if names.iter().all(|name| name.parse::<f64>().is_ok()) {
        return fail(line, format!("expected the names of the columns, found the number `{}`", names[0]));
    }
    let mut columns: Vec<Column> = names.iter().map(|name| column(name)).collect();
    for (line, row) in lines {
        let mut cells = split(line, row)?;
        drop_empty_ends(&mut cells, columns.len());
        if cells.len() != columns.len() {
            let (names, found) = (columns.len(), cells.len());
            return fail(line, format!("expected {names} cells, as there are names, found {found}"));
        }
        for (column, cell) in columns.iter_mut().zip(&cells) {
            column.values.push(match cell.as_ref() {
                "" => f64::NAN,
                cell => match cell.parse() {
                    Ok(value) => value,
                    Err(_) => return fail(line, format!("`{cell}` in the column `{}` is not a number", column.name)),
                },
            });
        }
    }
    Ok(columns)
}

/// An empty column from its name and unit.
fn column(header: &str) -> Column {
    for (open, close) in [('[', ']'), ('(', ')')] {
        let inside = header.strip_suffix(close).and_then(|rest| rest.rsplit_once(open));
        if let Some((name, unit)) = inside.filter(|(name, _)| !name.trim().is_empty()) {
            return Column { name: name.trim().to_owned(), unit: unit.trim().to_owned(), values: Vec::new() };
        }
    }
    Column { name: header.to_owned(), ..Column::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_units_and_numbers_are_read() {
        let table = read("# a note\ntime [s];\"height, above; ground (m)\";n;\r\n0;1.5;3;;\n\n0.1;;-2e-3\n").unwrap();
        let header: Vec<_> = table.iter().map(|column| (column.name.as_str(), column.unit.as_str())).collect();
        assert_eq!(header, [("time", "s"), ("height, above; ground", "m"), ("n", "")]);
        assert_eq!(table[0].values, [0.0, 0.1]);
        assert!(table[1].values[0] == 1.5 && table[1].values[1].is_nan());
        assert_eq!(table[2].values, [3.0, -2e-3]);
    }

    #[test]
    fn mistakes_are_told_with_their_line() {
        for (text, message) in [
            ("", "line 1: the file has no line of names"),
            ("1,2\n3,4\n", "line 1: expected the names of the columns, found the number `1`"),
            ("a,b\n1,2\n\n3\n", "line 4: expected 2 cells, as there are names, found 1"),
            ("a,b\n1,\"2\n", "line 2: a quote is not closed"),
            ("a,b\n1,x\n", "line 2: `x` in the column `b` is not a number"),
        ] {
            assert_eq!(read(text).unwrap_err().to_string(), message);
        }
    }
}
