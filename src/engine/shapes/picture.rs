//! `Picture(spacing, mass, rows)`: equal discs on a square grid, drawn with letters.

use glam::DVec2;
use schemars::JsonSchema;
use serde::Deserialize;

use super::AtomSpec;
use crate::scene::Diagnostics;
use crate::scene::units::{Length, Mass, Stiffness};

/// Equal discs on a square grid; neighbours just touch.
///
/// ```text
/// rows: ["..##..",      `#` is an atom, `.` and blank are none;
///        "######"]      the first row is the top, columns go to the right
/// ```
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Picture")]
pub struct Picture {
    /// The distance of neighbours in m, twice the radius of a disc. Above zero.
    pub spacing: Length,
    /// The mass of each disc (not of the whole picture) in kg. Above zero. Default: the material's density times the
    /// area of a disc.
    #[serde(default)]
    pub mass: Option<Mass>,
    /// The stiffness of each disc in N/m. Above zero. Default: the material's.
    #[serde(default)]
    pub stiffness: Option<Stiffness>,
    /// The rows from the top. They may differ in length, and all begin at the same column.
    pub rows: Vec<String>,
}

impl Picture {
    /// Reports a picture without atoms, letters that mean nothing, and numbers that are not above zero.
    pub fn check(&self, report: &mut Diagnostics) {
        report.positive("spacing", self.spacing);
        report.positive_if_given("mass", self.mass);
        report.positive_if_given("stiffness", self.stiffness);
        let mut good = true;
        for (index, row) in self.rows.iter().enumerate() {
            if let Some((column, letter)) = row.chars().enumerate().find(|(_, c)| !matches!(c, '#' | '.' | ' ')) {
                good = false;
                let message = format!("{letter:?} in column {} of the picture means nothing", column + 1);
                report.error(&format!("rows[{index}]"), message).help("`#` is an atom, `.` and blank are none");
            }
        }
        if good && !self.rows.iter().any(|row| row.contains('#')) {
            report.error("rows", "the picture has no atom").help("`#` is an atom, `.` and blank are none");
        }
    }

    /// Its atoms, row by row from the top, each from the left. The lower left corner of the grid's lowest row is at
    /// (-spacing/2, -spacing/2). So the first disc of that row would be at the origin.
    pub fn specs(&self) -> Vec<AtomSpec> {
        let spacing = self.spacing.si();
        let mut atoms = Vec::new();
        for (row, letters) in self.rows.iter().enumerate() {
            let y = (self.rows.len() - 1 - row) as f64 * spacing;
            for (column, letter) in letters.chars().enumerate() {
                if letter == '#' {
                    atoms.push(AtomSpec {
                        offset: DVec2::new(column as f64 * spacing, y),
                        radius: spacing / 2.0,
                        mass: self.mass.map(f64::from),
                        stiffness: self.stiffness.map(f64::from),
                    });
                }
            }
        }
        atoms
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_from_the_top() {
        let rows = vec![".#".into(), "# #".into()];
        let picture = Picture { spacing: Length::new(0.5), mass: Some(Mass::new(2.0)), stiffness: None, rows };
        let atoms = picture.specs();
        let offsets: Vec<DVec2> = atoms.iter().map(|atom| atom.offset).collect();
        assert_eq!(offsets, [DVec2::new(0.5, 0.5), DVec2::new(0.0, 0.0), DVec2::new(1.0, 0.0)]);
        assert!(atoms.iter().all(|atom| atom.radius == 0.25 && atom.mass == Some(2.0)));
    }
}
