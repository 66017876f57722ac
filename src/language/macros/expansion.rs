//! The made text, and the source of each of its pieces.

use std::ops::Range;

use super::File;
use crate::syntax::Form;

/// A piece of the made text, up to the beginning of the next one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) start: u32,
    pub(super) file: u32,
    pub(super) from: u32,
    pub(super) to: u32,
    /// Through which instances and repetitions.
    pub(super) step: u32,
    /// Whether it differs from its source: the value of an expression, or a name with its prefix.
    pub(super) made: bool,
}

/// A text in the making.
#[derive(Debug, Default)]
pub(super) struct Buffer {
    pub(super) text: String,
    pub(super) pieces: Vec<Piece>,
}

impl Buffer {
    fn piece(&mut self, file: usize, span: Range<usize>, step: u32, made: bool) {
        let start = self.text.len() as u32;
        let (from, to) = (span.start as u32, span.end as u32);
        self.pieces.push(Piece { start, file: file as u32, from, to, step, made });
    }

    /// Text that is copied from a file.
    pub(super) fn verbatim(&mut self, file: &File, span: Range<usize>, step: u32) {
        self.piece(file.number, span.clone(), step, false);
        self.text.push_str(&file.source.text[span]);
    }

    /// Text in place of a piece of a file.
    pub(super) fn made(&mut self, text: &str, file: usize, span: Range<usize>, step: u32) {
        self.piece(file, span, step, true);
        self.text.push_str(text);
    }

    fn append(&mut self, other: &Self) {
        let shift = self.text.len() as u32;
        self.text.push_str(&other.text);
        self.pieces.extend(other.pieces.iter().map(|piece| Piece { start: piece.start + shift, ..*piece }));
    }
}

/// One section of the scene, merged from all files and instances that contribute to it.
#[derive(Debug)]
pub(super) struct Merged {
    pub(super) name: String,
    pub(super) form: Form,
    /// Its first place.
    pub(super) head: Piece,
    pub(super) out: Buffer,
}

impl Merged {
    pub(super) fn new(name: &str, form: Form, file: &File, key: Range<usize>, step: u32) -> Self {
        let (from, to) = (key.start as u32, key.end as u32);
        let head = Piece { start: 0, file: file.number as u32, from, to, step, made: true };
        Self { name: name.to_owned(), form, head, out: Buffer::default() }
    }

    pub(super) fn close_into(self, out: &mut Buffer) {
        let Piece { file, from, to, step, .. } = self.head;
        let head = from as usize..to as usize;
        let put = |text: &str, out: &mut Buffer| out.made(text, file as usize, head.clone(), step);
        put(&self.name, out);
        out.text.push_str(": ");
        match self.form {
            Form::List => put("[", out),
            Form::Braces => put("{", out),
            _ => {}
        }
        out.append(&self.out);
        match self.form {
            Form::List => put("],\n", out),
            Form::Braces => put("},\n", out),
            _ => put(",\n", out),
        }
    }
}
