//! Reads the table of `packings: [(file: "grains.csv", ..)]`, and notes its key in the entry.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{MOST_ATOMS, PackingEntry, PackingTable, PackingsSection};
use crate::scene::embed::{Door, Embed, Embedded, Embedding, EmbeddingPlace, FileRequest, UnfitFile};
use crate::scene::{Section, count, read_value};
use jostle_language::digest::of_bytes;

/// Entries of `packings`.
pub(in crate::world) const EMBEDDING: Embedding = Embedding {
    name: PackingsSection::NAME,
    place: EmbeddingPlace::Section,
    fields: &["name", "file", "material"],
    required: &[],
    example: PackingsSection::EXAMPLE,
    reader: || Box::<Tables>::default(),
};
const TABLE: FileRequest =
    FileRequest { most: 256 << 20, noun: "a table of comma-separated values", smaller: "keep fewer rows" };

/// The tables that were read, with the hashes of their bytes. Entries name tables by these hashes, so that the made
/// scene changes with its tables.
#[derive(Default)]
struct Tables(Vec<(PathBuf, u64)>);

/// The mistake, and the remedy.
type Wrong = (String, String);

impl Embed for Tables {
    fn embed(&mut self, entry: &str, folder: Option<&Path>, door: &Door) -> Result<Option<Embedded>, UnfitFile> {
        let Ok(entry) = read_value::<PackingEntry>(entry) else { return Ok(None) };
        let (key, read) = self.key(&entry.file, folder, door).map_err(|(message, help)| UnfitFile {
            message,
            help,
            field: "file",
        })?;
        let fields = format!("table: {key}");
        Ok(Some(match read {
            None => Embedded { fields, ..Embedded::default() },
            Some((table, note)) => {
                Embedded { fields, note: Some(note), data: Some((key, Arc::new(table))), ..Embedded::default() }
            }
        }))
    }
}

impl Tables {
    /// The key of the table in a file. It comes with a note if the table is read for the first time.
    fn key(
        &mut self,
        name: &str,
        folder: Option<&Path>,
        door: &Door,
    ) -> Result<(u64, Option<(PackingTable, String)>), Wrong> {
        let Some(folder) = folder else {
            let message = "this scene is in no file, so no table can be found from it";
            return Err((message.into(), "save it as a file, or write the bodies into `bodies`".into()));
        };
        let path = folder.join(name);
        if let Some((_, key)) = self.0.iter().find(|(known, _)| *known == path) {
            return Ok((*key, None));
        }
        let mut bytes = TABLE.read(door, &path, name)?;
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
        let note = match (table.body_count(), table.atom_count()) {
            (bodies, atoms) if bodies == atoms => format!("{name}: a table of {}", count(atoms, "disc", "discs")),
            (bodies, atoms) => {
                let bodies = count(bodies, "body", "bodies");
                format!("{name}: a table of {bodies} of {}", count(atoms, "atom", "atoms"))
            }
        };
        let key = of_bytes(bytes.iter().copied());
        self.0.push((path, key));
        Ok((key, Some((table, note))))
    }
}
