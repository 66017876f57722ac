//! From values, comments and line breaks to text.

use std::borrow::Cow;

use super::parse::{Bracket, Comment, File, Item, Value};
use crate::hidden::{is_hidden, visible};

/// The indentation of the content of a bracket.
const INDENT: usize = 4;
/// Lists in one line that is longer than this are broken.
const LONGEST: usize = 120;

/// Every section begins a line. If a list or map in one line takes more than 120 columns, each of its items gets a
/// line.
pub(super) fn break_long_lines(file: &mut File) {
    let Value::Bracket(root) = &mut file.root else { return };
    if root.name != "Scene" {
        return;
    }
    root.breaks = root.breaks.max(1);
    for item in &mut root.items {
        match item.lead.first_mut() {
            // Beside the scene's bracket: what follows begins a line anyway.
            Some(comment) if comment.ends_line() => {}
            Some(comment) => comment.breaks = comment.breaks.max(1),
            None => item.breaks = item.breaks.max(1),
        }
        let mut line = Writer { column: INDENT, ..Writer::default() };
        line.item(&Item { trail: Vec::new(), ..item.clone() }, false);
        if line.lines.is_empty() && line.column > LONGEST {
            break_list(&mut item.value);
        }
    }
}

fn break_list(value: &mut Value) {
    if let Value::Bracket(Bracket { name: "", open: '[' | '{', items, breaks, .. }) = value
        && !items.is_empty()
    {
        *breaks = 1;
        items.iter_mut().for_each(|item| item.breaks = item.breaks.max(1));
    }
}

/// The text of a file.
pub(super) fn write(file: &File) -> String {
    let mut writer = Writer::default();
    for comment in &file.lead {
        writer.comment(comment, 0);
    }
    writer.separate(file.breaks, 0);
    writer.value(&file.root);
    for comment in &file.tail {
        if comment.breaks == 0 { writer.beside(comment) } else { writer.comment(comment, 0) }
    }
    writer.end_line();
    let mut text = writer.lines.join("\n");
    text.push('\n');
    text
}

/// A part of a file with hidden characters as escapes, which mean the same in texts. A raw text becomes an ordinary one, as it
/// has no escapes.
fn without_hidden(part: &str) -> Cow<'_, str> {
    let body = || part.strip_prefix('r')?.trim_matches('#').strip_prefix('"')?.strip_suffix('"');
    if !part.contains(is_hidden) {
        return Cow::Borrowed(part);
    }
    match body() {
        None => visible(part),
        Some(body) => {
            let ordinary = body.replace('\\', r"\\").replace('"', "\\\"");
            Cow::Owned(format!("\"{}\"", visible(&ordinary)))
        }
    }
}

/// The content of a bracket.
enum Part<'a> {
    Comment(&'a Comment<'a>),
    /// The item, and whether it is the last one.
    Item(&'a Item<'a>, bool),
}

impl Part<'_> {
    fn breaks(&self) -> usize {
        match self {
            Part::Comment(comment) => comment.breaks,
            Part::Item(item, _) => item.breaks,
        }
    }
}

#[derive(Default)]
struct Writer {
    /// Finished lines.
    lines: Vec<String>,
    line: String,
    column: usize,
    /// The indentation of the line in work.
    indent: usize,
    /// Whether nothing may follow in this line.
    ended: bool,
}

impl Writer {
    fn push(&mut self, text: &str) {
        let text = &*without_hidden(text);
        self.line.push_str(text);
        match text.rfind('\n') {
            Some(end) => self.column = text[end + 1..].chars().count(),
            None => self.column += text.chars().count(),
        }
    }

    fn end_line(&mut self) {
        let line = std::mem::take(&mut self.line);
        self.lines.push(line.trim_end().to_owned());
        (self.column, self.ended) = (0, false);
    }

    fn is_fresh(&self) -> bool {
        self.line.trim().is_empty()
    }

    /// The separator of two things: line breaks, at most one blank line, or a blank.
    fn separate(&mut self, breaks: usize, indent: usize) {
        if self.lines.is_empty() && self.is_fresh() {
            return;
        }
        if breaks > 0 || self.ended {
            self.end_line();
            if breaks > 1 {
                self.lines.push(String::new());
            }
            self.indent = indent;
            self.push(&" ".repeat(indent));
        } else if !self.is_fresh() {
            self.push(" ");
        }
    }

    /// A comment on a separate line, or within a line.
    fn comment(&mut self, comment: &Comment, indent: usize) {
        self.separate(comment.breaks, indent);
        self.push(comment.text);
        self.ended = comment.ends_line();
    }

    /// A comment after something on its line: it keeps its column if there is room.
    fn beside(&mut self, comment: &Comment) {
        let gap = comment.column.saturating_sub(self.column).max(1);
        self.push(&" ".repeat(if comment.ends_line() { gap } else { 1 }));
        self.push(comment.text);
        self.ended = comment.ends_line();
    }

    fn item(&mut self, item: &Item, last: bool) {
        if !item.key.is_empty() {
            self.push(item.key);
            self.push(":");
            for comment in &item.inner {
                self.comment(comment, self.indent + INDENT);
            }
            self.separate(0, self.indent + INDENT);
        }
        self.value(&item.value);
        if !last {
            self.push(",");
        }
        for comment in &item.trail {
            self.beside(comment);
        }
    }

    fn value(&mut self, value: &Value) {
        match value {
            Value::Atom(text) => self.push(text),
            Value::Bracket(bracket) => self.bracket(bracket),
        }
    }

    fn bracket(&mut self, bracket: &Bracket) {
        let Bracket { name, open, items, tail, breaks, comma } = bracket;
        let outer = self.indent;
        // A continuation stands below a bracket that begins its line, and is indented otherwise.
        let begins = self.line.chars().all(|letter| " ([{".contains(letter)) && name.is_empty();
        self.push(name);
        self.push(open.encode_utf8(&mut [0; 4]));
        let close = match open {
            '(' => ")",
            '[' => "]",
            _ => "}",
        };
        let mut parts: Vec<Part> = Vec::new();
        for (index, item) in items.iter().enumerate() {
            parts.extend(item.lead.iter().map(Part::Comment));
            parts.push(Part::Item(item, index + 1 == items.len()));
        }
        parts.extend(tail.iter().map(Part::Comment));
        let Some(first) = parts.first() else {
            self.push(close);
            return;
        };
        let (padded, own_line) = (*open == '{', *breaks > 0);
        // A comment beside the opening bracket does not affect the layout of the rest.
        let beside = matches!(first, Part::Comment(comment) if comment.breaks == 0 && comment.ends_line());
        let behind = begins && first.breaks() == 0 && !beside;
        let inner = if behind { self.column + usize::from(padded) } else { outer + INDENT };
        // `(1,)` is not `(1)`.
        let single = *open == '(' && items.len() == 1 && items[0].key.is_empty();
        let last_comma = if single { *comma } else { own_line };
        for (index, part) in parts.iter().enumerate() {
            match part {
                Part::Comment(comment) if index == 0 && beside => {
                    self.beside(comment);
                    continue;
                }
                // No blank line follows the bracket, and no blank unless it is a brace.
                _ if index == 0 && part.breaks() == 0 => self.push(if padded { " " } else { "" }),
                _ if index == 0 => self.separate(1, inner),
                _ => self.separate(part.breaks(), inner),
            }
            match part {
                Part::Item(item, last) => self.item(item, *last && !last_comma),
                Part::Comment(comment) => {
                    self.push(comment.text);
                    self.ended = comment.ends_line();
                }
            }
        }
        if own_line || self.ended {
            self.separate(1, outer);
        } else if padded {
            self.push(" ");
        }
        self.push(close);
        self.indent = outer;
    }
}
