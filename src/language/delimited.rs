//! Cells of a line of a table, after RFC 4180. Commas, semicolons or tabs separate them, and double quotes are
//! optional. A cell ends with its line.

use std::borrow::Cow;

/// The character that separates the cells of a table. It is the comma, semicolon or tab that is most frequent in the
/// line of names.
pub fn separator(names: &str) -> char {
    let often = |separator: &char| names.matches(*separator).count();
    // The last of equals: commas win.
    ['\t', ';', ','].into_iter().max_by_key(often).unwrap_or(',')
}

/// The cells of a line, without quotes and blanks around them; nothing if a quote is not closed.
pub fn cells(line: &str, separator: char) -> Option<Vec<Cow<'_, str>>> {
    if !line.contains('"') {
        return Some(line.split(separator).map(|cell| cell.trim().into()).collect());
    }
    let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            // Inside quotes two of them are one that belongs to the text.
            '"' if quoted && letters.next_if_eq(&'"').is_some() => cell.push('"'),
            '"' => quoted = !quoted,
            letter if letter == separator && !quoted => cells.push(Cow::Owned(std::mem::take(&mut cell))),
            letter => cell.push(letter),
        }
    }
    cells.push(cell.into());
    cells.iter_mut().for_each(|cell| *cell = cell.trim().to_owned().into());
    (!quoted).then_some(cells)
}

/// Takes away empty cells at the end of a line with more than `wanted` cells. Programs that write tables leave such
/// cells.
pub fn drop_empty_ends(cells: &mut Vec<Cow<'_, str>>, wanted: usize) {
    while cells.len() > wanted && cells.last().is_some_and(|cell| cell.is_empty()) {
        cells.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_what_stands_between_separators() {
        for (line, expected) in [
            ("1, 2 ,3", Some(vec!["1", "2", "3"])),
            ("\"x\", \"y, z\",w", Some(vec!["x", "y, z", "w"])),
            ("\"say \"\"x\"\"\",2", Some(vec!["say \"x\"", "2"])),
            ("\"\",", Some(vec!["", ""])),
            ("", Some(vec![""])),
            ("\"x,2", None),
        ] {
            let found = cells(line, ',');
            assert_eq!(found, expected.map(|cells| cells.into_iter().map(Cow::from).collect()), "{line}");
        }
        assert_eq!(["x;y", "x\ty;z\tw", "x", "a,b;c"].map(separator), [';', '\t', ',', ',']);
    }

    #[test]
    fn only_empty_ends_are_dropped() {
        for (line, wanted, left) in [("1,,2,,", 2, 3), ("1,,", 2, 2), ("1,2", 3, 2), (",,", 0, 0)] {
            let mut found = cells(line, ',').unwrap();
            drop_empty_ends(&mut found, wanted);
            assert_eq!(found.len(), left, "{line}");
        }
    }
}
