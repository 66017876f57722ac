//! Entries that name a file beside the scene. The owner of the entry reads the file, and its content joins the entry.

use super::emit::{Context, WORK};
use super::expansion::Buffer;
use super::{Expander, Outcome};
use crate::embed::UnfitFile;
use crate::syntax::Id;

impl Expander {
    /// The number of the reader for an entry with this leading name, under this key.
    pub(super) fn reader_of(&self, name: &str, key: &str, is_entry: bool) -> Option<usize> {
        self.readers.iter().position(|(known, _)| match known.place.field() {
            Some(field) => key == field && name == known.name,
            None => is_entry && key == known.name,
        })
    }

    /// Adds the content of a file to an entry whose fields were just copied. `start` is the beginning of the entry.
    pub(super) fn embed(
        &mut self,
        context: &Context,
        out: &mut Buffer,
        (id, reader): (Id, usize),
        start: usize,
    ) -> Outcome<()> {
        let known = self.readers[reader].0;
        self.fields(context, id, known.fields, known.example)?;
        let name = known.place.field().map_or(0, |_| known.name.len());
        let entry = format!("{})", &out.text[start + name..]);
        let folder = context.file.source.folder.as_deref();
        let read = self.readers[reader].1.embed(&entry, folder, &self.door).map_err(
            |UnfitFile { message, help, field }| {
                let (tree, text) = (&context.file.tree, &context.file.source.text);
                let at = self.field(context, id, field).unwrap_or(id);
                let mut error = self.wrong(context, tree.head_or_value(at), message);
                error.path = tree.path(at, text);
                error.label = "this value".into();
                Box::new(error.with_help(help))
            },
        )?;
        let Some(read) = read else {
            for field in known.required {
                self.required(context, id, field, known.example)?;
            }
            return Ok(());
        };
        self.notes.extend(read.note);
        self.tables.extend(read.data);
        if read.work > 0 {
            self.spend(context, id, 0, WORK * read.work + read.fields.len())?;
        }
        let fields = format!(", {}", read.fields);
        out.made(&fields, context.file.number, context.file.tree.head(id), context.step);
        Ok(())
    }
}
