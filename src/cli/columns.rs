//! Tables for people: columns side by side.

use std::fmt::Write;

/// Columns side by side: the first begins at the left, numbers end at the right. A last column without a head is text and begins
/// at the left.
pub(super) fn aligned(head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let has_text = head.last().is_some_and(|name| name.is_empty());
    let head: Vec<String> = head.iter().map(|name| (*name).to_owned()).collect();
    let lines: Vec<Vec<String>> = std::iter::once(head).chain(rows).collect();
    let columns = lines[0].len();
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for line in &lines {
        let mut row = format!("{:<width$}", line[0], width = widths[0]);
        for (column, (value, width)) in line.iter().zip(&widths).enumerate().skip(1) {
            let _ = match has_text && column + 1 == columns {
                true => write!(row, "  {value}"),
                false => write!(row, "  {value:>width$}"),
            };
        }
        text.push_str(row.trim_end());
        text.push('\n');
    }
    text
}

/// A cell of comma-separated values, quoted if necessary (RFC 4180). Line breaks become blanks.
pub(super) fn quoted(cell: &str) -> String {
    let line: String = cell.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect();
    if line.contains([',', '"']) { format!("\"{}\"", line.replace('"', "\"\"")) } else { line }
}
