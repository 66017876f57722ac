//! The parser from text to [`Tree`]. It finds every bracket, field and value of a scene, and mistakes in their order.
//!
//! `ron` reads the values themselves. This walk reports the mistakes that `ron` cannot describe well. Examples are an
//! open bracket, the word before an absent comma, a duplicate field, and a NaN or infinite number. It keeps an explicit
//! stack, so that no depth of nesting can overflow it.

mod literal;
mod mistakes;

use std::collections::BTreeMap;
use std::ops::Range;

use super::error::SceneError;
use super::hidden::is_hidden;
use super::syntax::{Form, Id, Tree};
pub(super) use literal::text_prefix;
use literal::word_length;

/// Brackets may be nested this deep; a scene needs about eight.
const DEEPEST: usize = 48;

/// More mistakes than this are not kept: the text is no scene.
const MOST_ERRORS: usize = 1000;

/// The result of the walk.
pub(crate) struct Lexed {
    pub(crate) tree: Tree,
    /// The mistake that ended the walk: the text after it was not seen.
    pub(crate) fault: Option<SceneError>,
    /// Mistakes that do not hide the rest: duplicate fields, numbers that are NaN or infinite.
    pub(crate) errors: Vec<SceneError>,
}

/// Walks a whole text.
pub(crate) fn lex(text: &str) -> Lexed {
    let mut lexer = Lexer {
        text,
        at: 0,
        last_end: 0,
        tree: Tree::default(),
        frames: Vec::new(),
        pending: Vec::new(),
        errors: Vec::new(),
    };
    let mut fault = lexer.walk().err().map(|fault| *fault);
    if fault.is_some() {
        lexer.close_all();
    }
    // Paths exist only when every bracket is closed.
    let Lexer { tree, mut errors, .. } = lexer;
    for error in errors.iter_mut().chain(&mut fault) {
        if let Some(node) = error.node {
            error.path = tree.path(node, text);
        }
    }
    Lexed { tree, fault, errors }
}

/// The byte after blanks and comments. It is an error only if a block comment never ends.
pub(crate) fn skip_blank(text: &str, mut at: usize) -> Result<usize, usize> {
    loop {
        // Nearly all blanks are ASCII; looking at bytes makes the walk twice as fast.
        at += text.as_bytes()[at..].iter().take_while(|byte| matches!(byte, b' ' | b'\t'..=b'\r')).count();
        if matches!(text.as_bytes().get(at), Some(byte) if *byte != b'/' && byte.is_ascii()) {
            return Ok(at);
        }
        let rest = &text[at..];
        let trimmed = rest.trim_start_matches(is_blank);
        at += rest.len() - trimmed.len();
        if trimmed.starts_with("//") {
            at += trimmed.find('\n').unwrap_or(trimmed.len());
        } else if trimmed.starts_with("/*") {
            at = block_comment_end(text, at).ok_or(at)?;
        } else {
            return Ok(at);
        }
    }
}

/// A blank of RON. Other white space, such as the no-break space, is none.
fn is_blank(c: char) -> bool {
    matches!(c, ' ' | '\t'..='\r' | '\u{85}' | '\u{200e}' | '\u{200f}' | '\u{2028}' | '\u{2029}')
}

fn block_comment_end(text: &str, start: usize) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    let mut at = start;
    while at + 1 < bytes.len() {
        match &bytes[at..at + 2] {
            b"/*" => {
                depth += 1;
                at += 2;
            }
            b"*/" => {
                depth -= 1;
                at += 2;
                if depth == 0 {
                    return Some(at);
                }
            }
            _ => at += 1,
        }
    }
    None
}

struct Frame {
    id: Id,
    open: usize,
    form: Form,
    /// The index of its first value among the pending ones.
    first: usize,
    item_done: bool,
}

struct Lexer<'a> {
    text: &'a str,
    at: usize,
    /// The end of the last token that is no blank.
    last_end: usize,
    tree: Tree,
    frames: Vec<Frame>,
    /// The values in all open brackets.
    pending: Vec<Id>,
    errors: Vec<SceneError>,
}

type Step = Result<(), Box<SceneError>>;

impl Lexer<'_> {
    fn walk(&mut self) -> Step {
        self.attributes()?;
        if self.peek().is_none() {
            let help = "the smallest scene is `Scene(format: 1, clock: (duration: 1), bodies: [..])`";
            return Err(self.fault("the scene is empty", 0..0, "").help(help));
        }
        self.value(0..0)?;
        while let Some(frame) = self.frames.last() {
            let (form, done) = (frame.form, frame.item_done);
            self.blank()?;
            match self.peek() {
                None => return Err(self.unclosed()),
                Some(c @ (')' | ']' | '}')) => self.closing(c)?,
                Some(_) if done => self.comma()?,
                Some(_) => {
                    let key = match form {
                        Form::Round => self.field_name()?,
                        Form::Braces => self.map_key()?,
                        _ => self.at..self.at,
                    };
                    if form == Form::Round {
                        self.all_named_or_none(&key)?;
                    }
                    self.value(key)?;
                }
            }
        }
        self.blank()?;
        match self.peek() {
            None => Ok(()),
            Some(found @ ('[' | '{')) if !self.tree.is_empty() && self.tree.node(0).form == Form::Word => {
                let root = self.tree.span(0);
                Err(self.name_before_bracket(&self.text[root.clone()], root, found))
            }
            Some(_) => {
                let span = self.token();
                Err(self
                    .fault("there is text after the end of the scene", span, "not expected here")
                    .help("check for a closing bracket too many before it"))
            }
        }
    }

    /// Attributes such as `#![enable(..)]` may precede the scene. Those that would change the language are refused.
    fn attributes(&mut self) -> Step {
        self.blank()?;
        while self.text[self.at..].starts_with("#!") {
            let length = self.text[self.at..].find(']').map_or(2, |end| end + 1);
            let span = self.at..self.at + length;
            let compact: String = self.text[span.clone()].chars().filter(|c| !c.is_whitespace()).collect();
            if compact.starts_with("#![enable(") && compact != "#![enable(implicit_some)]" {
                return Err(self.fault("the scene language has no extensions to enable", span, "").help("remove it"));
            }
            self.pass(length);
            self.blank()?;
        }
        Ok(())
    }

    fn value(&mut self, key: Range<usize>) -> Step {
        self.blank()?;
        let start = self.at;
        let rest = &self.text[start..];
        let Some(first) = self.peek() else { return Err(self.unclosed()) };
        match first {
            '(' => return self.open(key, start, Form::Round, 0),
            '[' => return self.open(key, start, Form::List, 0),
            '{' => return self.open(key, start, Form::Braces, 0),
            '"' => {
                self.text_literal(start)?;
                self.leaf(key, start, Form::Text);
            }
            '\'' => {
                self.character(start)?;
                self.leaf(key, start, Form::Character);
            }
            '0'..='9' | '+' | '-' | '.' => {
                let fault = self.number().err();
                self.leaf(key, start, Form::Number);
                if let Some(fault) = fault {
                    return Err(self.about_last(fault));
                }
            }
            _ => match text_prefix(rest) {
                Some((prefix, hashes)) => {
                    self.at += prefix;
                    if rest[..prefix].contains('r') {
                        self.raw_literal(start, hashes)?;
                    } else {
                        self.text_literal(start)?;
                    }
                    self.leaf(key, start, Form::Text);
                }
                None => {
                    let length = word_length(rest);
                    if length == 0 {
                        return Err(self.no_value(&key, first));
                    }
                    let name = &rest[..length];
                    self.pass(length);
                    self.blank()?;
                    if self.peek() == Some('(') {
                        return self.open(key, start, Form::Round, length);
                    }
                    self.at = start + length;
                    if ["NaN", "inf", "NaNf32", "NaNf64", "inff32", "inff64"].contains(&name) {
                        self.not_finite(start..start + length);
                    }
                    self.leaf(key, start, Form::Word);
                }
            },
        }
        Ok(())
    }

    fn open(&mut self, key: Range<usize>, start: usize, form: Form, name: usize) -> Step {
        if self.frames.len() >= DEEPEST {
            let message = format!("brackets are nested more than {DEEPEST} deep");
            let span = self.at..self.at + 1;
            let mut fault = self.fault(&message, span, "this one is too deep");
            fault.node = None;
            return Err(fault.help("a scene needs about eight levels"));
        }
        let id = self.node(key, start, form);
        self.tree.set_name(id, name);
        self.frames.push(Frame { id, open: self.at, form, first: self.pending.len(), item_done: false });
        self.pass(1);
        Ok(())
    }

    fn node(&mut self, key: Range<usize>, start: usize, form: Form) -> Id {
        let (parent, index) =
            self.frames.last().map_or((0, 0), |frame| (frame.id, (self.pending.len() - frame.first) as u32));
        let id = self.tree.push(parent, index, key, start, form);
        if let Some(frame) = self.frames.last_mut() {
            self.pending.push(id);
            frame.item_done = true;
        }
        id
    }

    fn leaf(&mut self, key: Range<usize>, start: usize, form: Form) {
        let id = self.node(key, start, form);
        self.tree.close(id, self.at, &[]);
        self.last_end = self.at;
    }

    fn closing(&mut self, found: char) -> Step {
        let Some(frame) = self.frames.last() else { return Ok(()) };
        let wanted = match frame.form {
            Form::List => ']',
            Form::Braces => '}',
            _ => ')',
        };
        if found != wanted {
            let open = frame.open;
            let message = format!("`{found}` closes nothing here: `{wanted}` must come first");
            let mut fault = self.fault(&message, self.at..self.at + 1, &format!("expected `{wanted}`"));
            fault.also = Some((open..open + 1, "this bracket is still open".into()));
            return Err(fault.help(format!("close it with `{wanted}`")));
        }
        self.pass(1);
        if let Some(frame) = self.frames.pop() {
            self.tree.close(frame.id, self.at, &self.pending[frame.first..]);
            self.pending.truncate(frame.first);
            self.duplicates(frame.id);
        }
        Ok(())
    }

    fn close_all(&mut self) {
        let end = self.last_end.max(self.at).min(self.text.len());
        while let Some(frame) = self.frames.pop() {
            self.tree.close(frame.id, end, &self.pending[frame.first..]);
            self.pending.truncate(frame.first);
        }
    }

    /// The last value in the innermost open bracket.
    fn last_value(&self) -> Option<Id> {
        self.pending[self.frames.last()?.first..].last().copied()
    }

    /// `name:` in front of a value, or nothing.
    fn field_name(&mut self) -> Result<Range<usize>, Box<SceneError>> {
        let start = self.at;
        if text_prefix(&self.text[start..]).is_some() {
            return Ok(start..start);
        }
        let length = word_length(&self.text[start..]);
        if length == 0 {
            return Ok(start..start);
        }
        self.at = start + length;
        self.blank()?;
        if self.peek() == Some(':') {
            self.pass(1);
            Ok(start..start + length)
        } else {
            self.at = start;
            Ok(start..start)
        }
    }

    /// `key:` in front of a value of a map.
    fn map_key(&mut self) -> Result<Range<usize>, Box<SceneError>> {
        let start = self.at;
        match self.peek() {
            Some('"') => self.text_literal(start)?,
            _ => {
                let length = word_length(&self.text[start..]);
                if length == 0 {
                    let span = self.token();
                    return Err(self
                        .fault("expected a name in quotes", span, "not a name")
                        .help("a map looks like `{ \"rock\": (..) }`"));
                }
                self.at += length;
            }
        }
        let key = start..self.at;
        self.last_end = self.at;
        self.blank()?;
        if self.peek() != Some(':') {
            let name = self.text[key.clone()].to_owned();
            return Err(self
                .fault(&format!("`:` is missing after {name}"), key, "`:` expected after this")
                .help(format!("write `{name}: ..`")));
        }
        self.pass(1);
        Ok(key)
    }

    /// The last number, which is the next value, is NaN or infinite.
    fn not_finite(&mut self, span: Range<usize>) {
        if self.errors.len() < MOST_ERRORS {
            let message = format!("must be a finite number, got {}", &self.text[span.clone()]);
            let error = SceneError::new("", message).at(span, "not finite");
            self.errors.push(SceneError { by_walk: true, node: Some(self.tree.next()), ..error });
        }
    }

    fn duplicates(&mut self, id: Id) {
        // Few fields need only comparisons with one another. For many, a table is worth its cost.
        const FEW: usize = 16;
        let children = self.tree.children(id);
        if self.tree.node(id).form == Form::List || children.len() < 2 {
            return;
        }
        let name = |child: Id| &self.text[self.tree.key(child)];
        let mut table: BTreeMap<&str, Id> = BTreeMap::new();
        for (index, &child) in children.iter().enumerate() {
            let key = name(child);
            if key.is_empty() {
                continue;
            }
            let before = if children.len() <= FEW {
                children[..index].iter().copied().find(|&other| name(other) == key)
            } else {
                let before = table.get(key).copied();
                table.entry(key).or_insert(child);
                before
            };
            if let Some(before) = before
                && self.errors.len() < MOST_ERRORS
            {
                let error = SceneError::new("", format!("`{}` stands here twice", key.trim_matches('"')))
                    .at(self.tree.key(child), "the second time")
                    .also(self.tree.key(before), "the first time")
                    .with_help("keep one of the two");
                self.errors.push(SceneError { by_walk: true, node: Some(child), ..error });
            }
        }
    }

    fn blank(&mut self) -> Step {
        match skip_blank(self.text, self.at) {
            Ok(at) => {
                self.at = at;
                if self.text.as_bytes().get(at).is_none_or(u8::is_ascii_graphic) {
                    return Ok(());
                }
                match self.peek().filter(|&c| c.is_whitespace() || is_hidden(c)) {
                    None => Ok(()),
                    Some(c) => {
                        let message = format!("an invisible character (U+{:04X}) stands here", u32::from(c));
                        let fault = self.fault(&message, self.token(), "invisible");
                        Err(fault.help("replace it with an ordinary blank"))
                    }
                }
            }
            Err(start) => Err(self
                .fault("the comment that begins here never ends", start..start + 2, "no `*/`")
                .help("close it with `*/`")),
        }
    }

    fn token(&self) -> Range<usize> {
        let rest = &self.text[self.at..];
        let length = word_length(rest).max(rest.chars().next().map_or(0, char::len_utf8));
        self.at..self.at + length
    }

    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    fn pass(&mut self, bytes: usize) {
        self.at += bytes;
        self.last_end = self.at;
    }
}

#[cfg(test)]
mod tests;
