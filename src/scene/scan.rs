//! From text to [`Tree`]: finds every bracket, field and value of a scene, and what is wrong with their order.
//!
//! `ron` reads the values themselves. This walk is there for what `ron` cannot say well: which bracket is still
//! open, after which word the comma is missing, where the same field stood before, and which number is not finite.
//! It keeps its own stack, so that no depth of nesting can overflow it.

use std::collections::BTreeMap;
use std::ops::Range;

use super::error::SceneError;
use super::tree::{Form, Id, Tree};

/// Brackets may be nested this deep; a scene needs about eight.
const DEEPEST: usize = 48;

/// What the walk found.
pub(crate) struct Scan {
    pub(crate) tree: Tree,
    /// The mistake that ended the walk: the text after it was not seen.
    pub(crate) fault: Option<SceneError>,
    /// Mistakes that do not hide the rest: duplicate fields, numbers that are not finite.
    pub(crate) errors: Vec<SceneError>,
}

/// Walks a whole text.
pub(crate) fn scan(text: &str) -> Scan {
    let mut scanner =
        Scanner { text, at: 0, last_end: 0, tree: Tree::default(), frames: Vec::new(), errors: Vec::new() };
    let fault = scanner.walk().err().map(|fault| *fault);
    if fault.is_some() {
        scanner.close_all();
    }
    Scan { tree: scanner.tree, fault, errors: scanner.errors }
}

/// The byte after blanks and comments; an error only for a block comment that never ends.
pub(crate) fn skip_blank(text: &str, mut at: usize) -> Result<usize, usize> {
    loop {
        let rest = &text[at..];
        let trimmed = rest.trim_start_matches(|c: char| c.is_whitespace() || matches!(c, '\u{200e}' | '\u{200f}'));
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
    children: Vec<Id>,
    item_done: bool,
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
    /// The end of the last thing that was no blank.
    last_end: usize,
    tree: Tree,
    frames: Vec<Frame>,
    errors: Vec<SceneError>,
}

type Step = Result<(), Box<SceneError>>;

impl Scanner<'_> {
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
            Some(_) => {
                let span = self.token();
                Err(self
                    .fault("there is text after the end of the scene", span, "not expected here")
                    .help("check for a closing bracket too many before it"))
            }
        }
    }

    /// `#![enable(..)]` and its like may stand before the scene; those that would change the language are refused.
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
                self.number(&key)?;
                self.leaf(key, start, Form::Number);
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
                        self.not_finite(start..start + length, &key);
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
            fault.path = String::new();
            return Err(fault.help("a scene needs about eight levels"));
        }
        let id = self.node(key, start, form);
        self.tree.set_name(id, name);
        self.frames.push(Frame { id, open: self.at, form, children: Vec::new(), item_done: false });
        self.pass(1);
        Ok(())
    }

    fn node(&mut self, key: Range<usize>, start: usize, form: Form) -> Id {
        let (parent, index) = self.frames.last().map_or((0, 0), |frame| (frame.id, frame.children.len() as u32));
        let id = self.tree.push(parent, index, key, start, form);
        if let Some(frame) = self.frames.last_mut() {
            frame.children.push(id);
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
            self.tree.close(frame.id, self.at, &frame.children);
            self.duplicates(&frame);
        }
        Ok(())
    }

    fn close_all(&mut self) {
        let end = self.last_end.max(self.at).min(self.text.len());
        while let Some(frame) = self.frames.pop() {
            self.tree.close(frame.id, end, &frame.children);
        }
    }

    /// After a value: a comma, or one of the mistakes that are made instead.
    fn comma(&mut self) -> Step {
        let Some(found) = self.peek() else { return Ok(()) };
        if found == ',' {
            self.pass(1);
            if let Some(frame) = self.frames.last_mut() {
                frame.item_done = false;
            }
            return Ok(());
        }
        let Some(frame) = self.frames.last() else { return Ok(()) };
        let before = frame.children.last().map_or(0..0, |&id| self.tree.span(id));
        let before_form = frame.children.last().map(|&id| self.tree.node(id).form);
        let word = &self.text[before.clone()];
        let here = self.token();
        if found == '=' || found == ':' {
            let (form, open) = (frame.form, frame.open);
            if form == Form::List && found == ':' {
                let mut fault =
                    self.fault(&format!("the list is not closed before the field `{word}`"), before, "a new field");
                fault.also = Some((open..open + 1, "this list is still open".into()));
                return Err(fault.help("close the list with `]`"));
            }
            if found == '=' {
                let help = format!("write `{word}: ..`");
                return Err(self.fault("fields take `:`, not `=`", here, "expected `:`").help(help));
            }
            if before_form == Some(Form::Text) {
                let bare = word.trim_matches('"');
                return Err(self
                    .fault("field names stand without quotes", before.clone(), "a field name in quotes")
                    .help(format!("write `{bare}: ..`")));
            }
        }
        if frame.form == Form::Round && before_form == Some(Form::Word) && found != ';' {
            let name = word.to_owned();
            let fault = self.fault(&format!("`:` is missing after `{name}`"), before, "`:` expected after this");
            return Err(fault.help(format!("write `{name}: ..`")));
        }
        if found == ';' {
            return Err(self
                .fault("fields and items are separated by `,`, not `;`", here, "expected `,`")
                .help("write `,`"));
        }
        let same_line = !self.text[before.end..self.at].contains('\n');
        if before_form == Some(Form::Number) && same_line && (found.is_alphabetic() || matches!(found, '%' | '°')) {
            let line_end =
                self.text[self.at..].find([',', ')', ']', '}', '\n']).map_or(self.text.len(), |n| self.at + n);
            let whole = self.text[before.start..line_end].trim_end().to_owned();
            let span = before.start..before.start + whole.len();
            let fault = self.fault("a number with a unit stands in quotes", span, "needs quotes");
            return Err(self.about_last(fault).help(format!("write `\"{whole}\"`")));
        }
        // The place to mend is the end of the last word, not the beginning of the next, which may be lines below.
        let end = self.last_end;
        let start = self.text[..end].char_indices().next_back().map_or(end, |(place, _)| place);
        let fault = self.fault("a comma is missing after this value", start..end, "`,` expected after this");
        Err(self.about_last(fault).help("separate fields and list items with `,`"))
    }

    fn about_last(&self, fault: Box<SceneError>) -> Box<SceneError> {
        match self.frames.last().and_then(|frame| frame.children.last()) {
            Some(&last) => self.about(last, fault),
            None => fault,
        }
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

    /// Round brackets hold fields with names or values without, never both.
    fn all_named_or_none(&self, key: &Range<usize>) -> Step {
        let Some(&before) = self.frames.last().and_then(|frame| frame.children.last()) else { return Ok(()) };
        let named = !self.tree.key(before).is_empty();
        if named != key.is_empty() || self.peek() == Some(',') {
            return Ok(());
        }
        if !named {
            let name = self.text[key.clone()].to_owned();
            let message = format!("`{name}: ..` has a name, the value before it has none");
            return Err(self.fault(&message, key.clone(), "a name").help("give all of them names, or none"));
        }
        let digits = self.text[self.at..].bytes().take_while(u8::is_ascii_digit).count();
        let number = &self.text[self.tree.span(before)];
        if digits > 0 && self.tree.node(before).form == Form::Number {
            let decimals = &self.text[self.at..self.at + digits];
            let span = self.tree.span(before).start..self.at + digits;
            let fault = self.fault("decimals take a point, not a comma", span, "two numbers");
            return Err(self.about(before, fault).help(format!("write `{number}.{decimals}`")));
        }
        let fault = self.fault("expected a field name and `:`", self.token(), "no field name");
        Err(fault.help("every field here has a name, as in `name: value`"))
    }

    /// Names the last value in a fault, in place of what it stands in.
    fn about(&self, value: Id, mut fault: Box<SceneError>) -> Box<SceneError> {
        fault.path = self.tree.path(value, self.text);
        fault
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

    fn text_literal(&mut self, start: usize) -> Step {
        let mut escaped = false;
        let body = self.at + 1;
        for (place, c) in self.text[body..].char_indices() {
            match c {
                _ if escaped => escaped = false,
                '\\' => escaped = true,
                '"' => {
                    self.at = body + place + 1;
                    return Ok(());
                }
                _ => {}
            }
        }
        Err(self.open_text(start))
    }

    fn raw_literal(&mut self, start: usize, hashes: usize) -> Step {
        let end = format!("\"{}", "#".repeat(hashes));
        let body = self.at + 1;
        match self.text[body..].find(&end) {
            Some(place) => {
                self.at = body + place + end.len();
                Ok(())
            }
            None => Err(self.open_text(start)),
        }
    }

    fn open_text(&self, start: usize) -> Box<SceneError> {
        let end = self.text[start..].find('\n').map_or(self.text.len(), |place| start + place);
        self.fault("the text that begins here never ends", start..end, "no closing `\"`").help("close it with `\"`")
    }

    fn character(&mut self, start: usize) -> Step {
        let line_end = self.text[start + 1..].find('\n').map_or(self.text.len(), |place| start + 1 + place);
        let line = &self.text[start + 1..line_end];
        let escaped = usize::from(line.starts_with('\\'));
        let one = line.chars().nth(escaped).map_or(0, char::len_utf8) + escaped;
        if line.get(one..).is_some_and(|rest| rest.starts_with('\'')) && one > 0 {
            self.at = start + 1 + one + 1;
            return Ok(());
        }
        let end = line.find('\'').map_or(start + 1, |place| start + 1 + place + 1);
        let inner = self.text[start + 1..end].trim_end_matches('\'');
        let help = format!("write `\"{inner}\"`");
        Err(self.fault("texts stand in double quotes", start..end, "single quotes").help(help))
    }

    fn number(&mut self, key: &Range<usize>) -> Step {
        let start = self.at;
        let rest = &self.text.as_bytes()[start..];
        let mut length = 0;
        while let Some(&byte) = rest.get(length) {
            let exponent = length > 0 && matches!(rest[length - 1], b'e' | b'E');
            let range_start = rest[..length].ends_with(b"..") || rest[..length].ends_with(b"..=");
            let sign = matches!(byte, b'+' | b'-') && (length == 0 || exponent || range_start);
            let range_end = byte == b'=' && rest[..length].ends_with(b"..");
            if !(byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.') || sign || range_end) {
                break;
            }
            length += 1;
        }
        let span = start..start + length;
        let written = &self.text[span.clone()];
        self.at = span.end;
        match number_value(written) {
            Some(value) if value.is_finite() => Ok(()),
            Some(_) => {
                self.not_finite(span, key);
                Ok(())
            }
            None => {
                let digits = written.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(0);
                let (number, unit) = written.split_at(digits);
                let help = if number_value(number).is_some() && !unit.is_empty() {
                    format!("a number with a unit stands in quotes: write `\"{number} {unit}\"`")
                } else {
                    "a number looks like `12`, `-0.5` or `1e-3`".to_owned()
                };
                let message = format!("`{written}` is not a number");
                Err(self.fault(&message, span, "not a number").help(help))
            }
        }
    }

    fn not_finite(&mut self, span: Range<usize>, key: &Range<usize>) {
        let written = self.text[span.clone()].to_owned();
        let error = SceneError::new(self.path(key), format!("must be a finite number, got {written}"));
        let error = error.at(span, "not finite");
        self.errors.push(SceneError { by_walk: true, ..error });
    }

    /// The path of the value being read.
    fn path(&self, key: &Range<usize>) -> String {
        let Some(frame) = self.frames.last() else { return String::new() };
        let parent = self.tree.path(frame.id, self.text);
        let name = &self.text[key.clone()];
        let index = frame.children.len();
        match frame.form {
            Form::Round if !name.is_empty() && parent.is_empty() => name.to_owned(),
            Form::Round if !name.is_empty() => format!("{parent}.{name}"),
            Form::Braces => format!("{parent}[{name}]"),
            _ => format!("{parent}[{index}]"),
        }
    }

    fn duplicates(&mut self, frame: &Frame) {
        if frame.form == Form::List {
            return;
        }
        let mut first: BTreeMap<&str, Id> = BTreeMap::new();
        for &child in &frame.children {
            let key = self.tree.key(child);
            if key.is_empty() {
                continue;
            }
            let name = &self.text[key.clone()];
            if let Some(&before) = first.get(name) {
                let path = self.tree.path(child, self.text);
                let error = SceneError::new(path, format!("`{}` stands here twice", name.trim_matches('"')))
                    .at(key, "the second time")
                    .also(self.tree.key(before), "the first time")
                    .with_help("keep one of the two");
                self.errors.push(SceneError { by_walk: true, ..error });
            } else {
                first.insert(name, child);
            }
        }
    }

    fn blank(&mut self) -> Step {
        match skip_blank(self.text, self.at) {
            Ok(at) => {
                self.at = at;
                Ok(())
            }
            Err(start) => Err(self
                .fault("the comment that begins here never ends", start..start + 2, "no `*/`")
                .help("close it with `*/`")),
        }
    }

    fn unclosed(&self) -> Box<SceneError> {
        let end = self.text.len();
        let Some(frame) = self.frames.last() else { return self.fault("the scene ends too early", end..end, "") };
        let wanted = match frame.form {
            Form::List => ']',
            Form::Braces => '}',
            _ => ')',
        };
        let open = frame.open..frame.open + 1;
        let fault = self.fault("the scene ends before this bracket is closed", open, &format!("no `{wanted}` for it"));
        fault.help(format!("the text may be cut off; close it with `{wanted}`"))
    }

    fn no_value(&self, key: &Range<usize>, found: char) -> Box<SceneError> {
        let name = &self.text[key.clone()];
        if matches!(found, ',' | ')' | ']' | '}') && !name.is_empty() {
            return self
                .fault(&format!("`{name}` has no value"), key.clone(), "a value is missing after this")
                .help(format!("write `{name}: ..`, or remove it"));
        }
        let span = self.token();
        let help = if found == ',' {
            "one comma is enough"
        } else {
            "a value is a number, a \"text\", a word, `(..)`, `[..]` or `{..}`"
        };
        self.fault(&format!("`{found}` is not expected here"), span, "not the beginning of a value").help(help)
    }

    fn fault(&self, message: &str, span: Range<usize>, label: &str) -> Box<SceneError> {
        let path = self.frames.last().map_or_else(String::new, |frame| self.tree.path(frame.id, self.text));
        Box::new(SceneError::new(path, message).at(span, label))
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

impl SceneError {
    fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Self> {
        self.help = Some(help.into());
        self
    }
}

/// The length of a field name or word at the beginning of a text, in bytes.
pub(crate) fn word_length(text: &str) -> usize {
    let raw = if text.starts_with("r#") { 2 } else { 0 };
    let mut length = raw;
    for c in text[raw..].chars() {
        let first = length == raw;
        if c == '_' || c.is_alphabetic() || (!first && c.is_alphanumeric()) {
            length += c.len_utf8();
        } else {
            break;
        }
    }
    if length == raw { 0 } else { length }
}

/// `b"`, `r"`, `r##"` and their like: the bytes before the quote and the number of `#`.
fn text_prefix(text: &str) -> Option<(usize, usize)> {
    let letters = text.find(|c| !matches!(c, 'b' | 'r')).unwrap_or(text.len());
    if !matches!(&text[..letters], "b" | "r" | "br") {
        return None;
    }
    let hashes = text[letters..].bytes().take_while(|&byte| byte == b'#').count();
    let prefix = letters + hashes;
    (text[prefix..].starts_with('"') && (hashes == 0 || text[..letters].ends_with('r'))).then_some((prefix, hashes))
}

/// The value of a number as it may stand in RON; ranges and whole numbers of other bases count as zero.
fn number_value(written: &str) -> Option<f64> {
    if written.contains("..") {
        return Some(0.0);
    }
    let plain = written.replace('_', "");
    let unsigned = plain.trim_start_matches(['+', '-']);
    for (prefix, base) in [("0x", 16), ("0o", 8), ("0b", 2)] {
        if let Some(digits) = unsigned.strip_prefix(prefix) {
            return u64::from_str_radix(digits, base).ok().map(|_| 0.0);
        }
    }
    let suffixes = ["f32", "f64", "i8", "i16", "i32", "i64", "u8", "u16", "u32", "u64"];
    let digits = suffixes.iter().find_map(|suffix| plain.strip_suffix(suffix)).unwrap_or(&plain);
    let special = ["NaN", "inf"].contains(&digits.trim_start_matches(['+', '-']));
    if !special && digits.contains(|c: char| c.is_ascii_alphabetic() && !matches!(c, 'e' | 'E')) {
        return None;
    }
    digits.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_has_its_place_and_path() {
        let text = "Scene(a: 1, b: [(x: -2e-3), Drag(y: \"s\")], m: { \"k\": (z: 0.1..0.5) }, c: List([7, 8]),)";
        let found = scan(text);
        assert_eq!(found.fault, None);
        let at = |path: &str| {
            let place = found.tree.find(path, text).unwrap();
            assert!(place.whole, "{path}");
            &text[found.tree.span(place.node)]
        };
        assert_eq!(at("a"), "1");
        assert_eq!(at("b[0].x"), "-2e-3");
        assert_eq!(at("b[1].y"), "\"s\"");
        assert_eq!(at("m[\"k\"].z"), "0.1..0.5");
        assert_eq!(at("c[1]"), "8");
        for path in ["a", "b[0].x", "b[1].y", "m[\"k\"].z", "c[1]", "b"] {
            let node = found.tree.find(path, text).unwrap().node;
            assert_eq!(found.tree.path(node, text), path);
            assert_eq!(found.tree.innermost(found.tree.span(node).start, false), node);
        }
    }

    #[test]
    fn no_beginning_of_a_scene_makes_it_stumble() {
        let text = "#![type = \"x\"]\n/* a /* b */ */ Scene(a: r#\"q\"#, d: {\"é\": 'ü', \"f\": '\\n'}, g: -inf, h: 1_000u32) // end";
        assert_eq!(scan(text).fault, None);
        for end in (0..text.len()).filter(|&end| text.is_char_boundary(end)) {
            let _ = scan(&text[..end]);
            let _ = scan(&text[end..]);
        }
    }

    #[test]
    fn a_million_brackets_are_one_plain_error() {
        for bracket in ["(", "[", "{\"a\":", "Some("] {
            let fault = scan(&bracket.repeat(1_000_000)).fault.unwrap();
            assert_eq!(fault.message, "brackets are nested more than 48 deep");
        }
    }
}
