//! `packings: [(file: "grains.csv", ..)]`: the table is read, and the entry is told which it is.

use std::sync::Arc;

use super::door::{Wanted, Wrong};
use super::emit::Context;
use super::write::Buffer;
use super::{Expander, Outcome};
use crate::scene::explain;
use crate::scene::sections::packing::{MOST_ATOMS, PackingEntry, PackingTable, PackingsSection};
use crate::scene::tree::Id;
use crate::scene::{Section, count};
use crate::world::hash::of_bytes;

/// The section in which tables of bodies stand.
pub(super) const SECTION: &str = PackingsSection::NAME;
const FIELDS: [&str; 3] = ["name", "file", "material"];
const TABLE: Wanted = Wanted { most: 256 << 20, noun: "a table of comma-separated values", smaller: "keep fewer rows" };

/// A table that was read before.
pub(super) struct Known {
    path: std::path::PathBuf,
    /// The hash of its bytes, by which entries name it: what is made of a scene changes with its tables.
    key: u64,
}

impl Expander {
    /// Adds the key of its table to an entry whose fields were just copied; `start` is where the entry begins.
    pub(super) fn packing(&mut self, context: &Context, out: &mut Buffer, id: Id, start: usize) -> Outcome<()> {
        self.fields(context, id, &FIELDS, PackingsSection::EXAMPLE)?;
        // What the entry's own reading finds is told by it.
        let Ok(entry) = explain::read::<PackingEntry>(&format!("{})", &out.text[start..])) else { return Ok(()) };
        let key = self.packing_table(context, &entry.file).map_err(|(message, help)| {
            let (tree, text) = (&context.file.tree, &context.file.source.text);
            let at = self.field(context, id, "file").unwrap_or(id);
            let mut error = self.wrong(context, tree.head_or_value(at), message);
            error.path = tree.path(at, text);
            error.label = "this value".into();
            Box::new(error.with_help(help))
        })?;
        out.made(&format!(", table: {key}"), context.file.number, context.file.tree.head(id), context.step);
        Ok(())
    }

    /// The key of the table in a file.
    fn packing_table(&mut self, context: &Context, name: &str) -> Result<u64, Wrong> {
        let Some(folder) = &context.file.source.folder else {
            let message = "this scene is in no file, so no table can be found from it";
            return Err((message.into(), "save it as a file, or write the bodies into `bodies`".into()));
        };
        let path = folder.join(name);
        if let Some(known) = self.packings.iter().find(|known| known.path == path) {
            return Ok(known.key);
        }
        let mut bytes = TABLE.read(&path, name)?;
        if path.extension().is_some_and(|ending| ending == "gz") {
            bytes = TABLE.bytes(flate2::read::MultiGzDecoder::new(&*bytes), name)?;
        }
        let text = std::str::from_utf8(&bytes).map_err(|error| {
            let line = 1 + bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count();
            (format!("line {line} of `{name}` is no UTF-8 text"), format!("it has to be {}", TABLE.noun))
        })?;
        let table = PackingTable::read(text, MOST_ATOMS).map_err(|wrong| {
            let column = wrong.column.map_or_else(String::new, |column| format!(", column `{column}`,"));
            (format!("line {} of `{name}`{column} {}", wrong.line, wrong.why), wrong.help)
        })?;
        self.notes.push(match (table.body_count(), table.atom_count()) {
            (bodies, atoms) if bodies == atoms => format!("{name}: a table of {}", count(atoms, "disc", "discs")),
            (bodies, atoms) => {
                let bodies = count(bodies, "body", "bodies");
                format!("{name}: a table of {bodies} of {}", count(atoms, "atom", "atoms"))
            }
        });
        let key = of_bytes(bytes.iter().copied());
        self.packings.push(Known { path, key });
        self.tables.insert(key, Arc::new(table));
        Ok(key)
    }
}
