//! `packings`: many bodies whose positions come from a table beside the scene.

mod embed;
mod packing_table;

use std::sync::Arc;

use bevy_app::App;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::name_series;
use crate::scene::{Diagnostics, NameKind, Obstacle, Outline, Section};
use crate::world::sections::MOST_ATOMS;
use crate::world::{material, sections};

pub(in crate::world) use embed::EMBEDDING;
pub use packing_table::{PackedBody, PackingTable, TableMistake};

/// Bodies from one table.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Packing")]
pub struct PackingEntry {
    /// The prefix of their names.
    pub name: String,
    /// The table: a path from the folder of the file with this entry, of comma-separated values. The reader decompresses a
    /// file whose name ends in `.gz`.
    pub file: String,
    /// The name of their material. Default: `default`.
    #[serde(default)]
    pub material: Option<String>,
    /// The key of its table. Not written by hand.
    #[serde(default)]
    #[schemars(skip)]
    pub table: Option<u64>,
}

/// Many bodies whose positions come from a table beside the scene. The bodies of `grain` are called `grain_0`,
/// `grain_1` and so on, in the order of the rows. All entries together have at most 1 000 000 atoms.
///
/// The first line names the columns, in any order. Each other line holds the numbers of one atom, in SI units, without
/// their symbols. `x`, `y` and `radius` are needed. Optional are `vx` with `vy` (the velocity of the atom's centre),
/// `spin`, `angle` and `body`. Rows of the same `body`, a whole number, form one rigid body. Without that column each
/// row is a separate disc. Masses follow from the material's density, and the velocity of a rigid body from those of
/// its atoms. Its spin follows from them too if there is no such column. Names and numbers may stand in double quotes,
/// with semicolons or tabs between them in place of commas. Empty lines, lines that begin with `#`, and separators
/// behind the last column are ignored.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub struct PackingsSection(pub Vec<PackingEntry>);

impl Section for PackingsSection {
    const NAME: &'static str = "packings";
    const EXAMPLE: &'static str = "packings: [(name: \"grain\", file: \"packings/grains.csv\", material: \"sand\")]";

    /// Declares the bodies' names and the places they take.
    fn declare(&self, outline: &mut Outline) {
        let mut atoms = 0;
        for (index, entry) in self.0.iter().enumerate() {
            let Some(table) = entry.read(outline) else { continue };
            // More than there may be in all are refused: their names would only take memory.
            atoms += table.atom_count() as u64;
            if atoms > MOST_ATOMS {
                return;
            }
            let count = table.body_count() as u64;
            outline.declare_series(NameKind::BODY, &entry.name, count, &format!("[{index}].name"));
            for (center, radius) in table.discs() {
                outline.occupy(Obstacle::Disc { center, radius });
            }
        }
    }

    /// Reports unknown materials, tables that were not read, too many atoms, and atoms that are too large for numbers.
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        let mut atoms = 0;
        for (index, entry) in self.0.iter().enumerate() {
            report.within(&format!("[{index}]"), |report| {
                material::require(entry.material.as_deref(), outline, report);
                let Some(table) = entry.read(outline) else {
                    let help = "`packings` stands in a scene that is in a file";
                    report.error("file", "the table was not read").help(help);
                    return;
                };
                atoms += table.atom_count() as u64;
                if atoms > MOST_ATOMS {
                    return;
                }
                let finite = |number| {
                    let body = table.body(number, 1.0);
                    body.properties.inertia.is_finite() && body.position.is_finite() && body.velocity.is_finite()
                };
                if let Some(number) = (0..table.body_count()).find(|&number| !finite(number)) {
                    let name = entry.body_name(number as u64);
                    let message = format!("{name}: its mass, place or velocity is infinite");
                    report.error("file", message).help("the table is in metres and m/s: look for a zero too many");
                }
            });
        }
        if atoms > MOST_ATOMS {
            report.error("", format!("must be at most {MOST_ATOMS} atoms in all, got {atoms}"));
        }
    }

    fn install(self, outline: &Outline, app: &mut App) {
        sections::spawn_packings(self, outline, app.world_mut());
    }
}

impl PackingEntry {
    /// The name of one of the bodies, counted from zero.
    pub fn body_name(&self, number: u64) -> String {
        name_series::of_series(&self.name, number)
    }

    /// Its table after reading.
    pub fn read(&self, outline: &Outline) -> Option<Arc<PackingTable>> {
        self.table.and_then(|table| outline.embedded(table))
    }
}
