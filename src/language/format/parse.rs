//! A recursive-descent parser (Aho, Sethi and Ullman 1986, section 2.4) of values, comments and line breaks. The lexer has
//! passed the text before, so it has no misplaced brackets.

use crate::lexer::text_prefix;

/// A comment, or an attribute `#![..]`, and the line breaks before it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Comment<'a> {
    pub text: &'a str,
    pub breaks: usize,
    /// Its column in the text, from 0.
    pub column: usize,
}

impl Comment<'_> {
    /// Whether the line ends with it.
    pub fn ends_line(&self) -> bool {
        self.text.starts_with("//")
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value<'a> {
    /// A number, text or word.
    Atom(&'a str),
    Bracket(Bracket<'a>),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bracket<'a> {
    /// The leading name, or nothing.
    pub name: &'a str,
    pub open: char,
    pub items: Vec<Item<'a>>,
    /// Comments after the last item.
    pub tail: Vec<Comment<'a>>,
    /// Line breaks before it closes.
    pub breaks: usize,
    /// Whether a comma stood after the last item.
    pub comma: bool,
}

/// A value in a bracket.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Item<'a> {
    /// Comments before it.
    pub lead: Vec<Comment<'a>>,
    pub breaks: usize,
    /// Its field name or map key, or nothing.
    pub key: &'a str,
    /// Comments between key and value.
    pub inner: Vec<Comment<'a>>,
    pub value: Value<'a>,
    /// Comments after it on its line.
    pub trail: Vec<Comment<'a>>,
}

/// A whole file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct File<'a> {
    pub lead: Vec<Comment<'a>>,
    pub breaks: usize,
    pub root: Value<'a>,
    pub tail: Vec<Comment<'a>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Open,
    Close,
    Comma,
    Colon,
    Atom,
    Comment,
}

#[derive(Clone, Copy, Debug)]
struct Token<'a> {
    kind: Kind,
    text: &'a str,
    breaks: usize,
    column: usize,
}

struct Tokens<'a> {
    list: Vec<Token<'a>>,
    next: usize,
}

/// Reads a text that was walked without a fault.
pub(super) fn parse(text: &str) -> File<'_> {
    let mut tokens = Tokens { list: tokens(text), next: 0 };
    let lead = tokens.comments();
    let breaks = tokens.breaks();
    let mut inner = Vec::new();
    let root = tokens.value(&mut inner);
    let mut tail = inner;
    tail.extend(tokens.comments());
    File { lead, breaks, root, tail }
}

impl<'a> Tokens<'a> {
    fn peek(&self) -> Option<Token<'a>> {
        self.list.get(self.next).copied()
    }

    fn is_next(&self, kind: Kind) -> bool {
        self.peek().is_some_and(|token| token.kind == kind)
    }

    /// The line breaks before the next token.
    fn breaks(&self) -> usize {
        self.peek().map_or(0, |token| token.breaks)
    }

    fn take(&mut self) -> Option<Token<'a>> {
        let token = self.peek();
        self.next += 1;
        token
    }

    fn comments(&mut self) -> Vec<Comment<'a>> {
        self.comments_while(|_| true)
    }

    fn comments_while(&mut self, wanted: impl Fn(&Token) -> bool) -> Vec<Comment<'a>> {
        let mut comments = Vec::new();
        while let Some(token) = self.peek().filter(|token| token.kind == Kind::Comment && wanted(token)) {
            comments.push(Comment { text: token.text, breaks: token.breaks, column: token.column });
            self.next += 1;
        }
        comments
    }

    /// A value; comments within its head go to `inner`.
    fn value(&mut self, inner: &mut Vec<Comment<'a>>) -> Value<'a> {
        let name = if self.is_next(Kind::Atom) { self.take().map_or("", |token| token.text) } else { "" };
        let back = self.next;
        let between = self.comments();
        if !self.is_next(Kind::Open) {
            self.next = back;
            return Value::Atom(name);
        }
        inner.extend(between);
        let open = self.take().and_then(|token| token.text.chars().next()).unwrap_or('(');
        let mut items: Vec<Item> = Vec::new();
        let mut comma = false;
        let mut lead = self.comments();
        while self.peek().is_some_and(|token| token.kind != Kind::Close) {
            let mut item = self.item(std::mem::take(&mut lead));
            comma = self.is_next(Kind::Comma);
            if comma {
                self.next += 1;
            }
            item.trail.extend(self.comments_while(|token| token.breaks == 0));
            items.push(item);
            lead = self.comments();
            // A comma after a comment on a separate line.
            if self.is_next(Kind::Comma) {
                comma = true;
                self.next += 1;
                lead.extend(self.comments());
            }
        }
        let breaks = self.breaks();
        self.next += 1;
        Value::Bracket(Bracket { name, open, items, tail: lead, breaks, comma })
    }

    fn item(&mut self, lead: Vec<Comment<'a>>) -> Item<'a> {
        let breaks = self.breaks();
        let mut inner = Vec::new();
        let start = self.next;
        let mut key = "";
        if self.is_next(Kind::Atom) {
            let word = self.take().map_or("", |token| token.text);
            let between = self.comments();
            if self.is_next(Kind::Colon) {
                self.next += 1;
                key = word;
                inner = between;
                inner.extend(self.comments());
            } else {
                self.next = start;
            }
        }
        let value = self.value(&mut inner);
        let trail = self.comments_while(|token| token.breaks == 0);
        Item { lead, breaks, key, inner, value, trail }
    }
}

fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut list = Vec::new();
    let (mut at, mut breaks, mut line) = (0, 0, 0);
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let (kind, length) = match first {
            '\n' => {
                breaks += 1;
                at += 1;
                line = at;
                continue;
            }
            '(' | '[' | '{' => (Kind::Open, 1),
            ')' | ']' | '}' => (Kind::Close, 1),
            ',' => (Kind::Comma, 1),
            ':' => (Kind::Colon, 1),
            _ if rest.starts_with("//") => (Kind::Comment, rest.find('\n').unwrap_or(rest.len())),
            _ if rest.starts_with("/*") => (Kind::Comment, block_comment(rest)),
            '#' => (Kind::Comment, rest.find(']').map_or(rest.len(), |end| end + 1)),
            _ if first.is_whitespace() || is_mark(first) => {
                at += first.len_utf8();
                continue;
            }
            _ => (Kind::Atom, atom(rest)),
        };
        let token = text[at..at + length].trim_end();
        list.push(Token { kind, text: token, breaks, column: text[line..at].chars().count() });
        at += length;
        if let Some(end) = text[..at].rfind('\n').filter(|&end| end >= line) {
            line = end + 1;
        }
        breaks = 0;
    }
    list
}

/// Marks of the direction of writing: blanks to RON.
fn is_mark(letter: char) -> bool {
    matches!(letter, '\u{200e}' | '\u{200f}')
}

fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while at < text.len() {
        let rest = &text[at..];
        if rest.starts_with("/*") {
            depth += 1;
            at += 2;
        } else if rest.starts_with("*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    text.len()
}

/// The length of a number, word or text.
fn atom(text: &str) -> usize {
    if let Some((prefix, hashes)) = text_prefix(text) {
        return if text[..prefix].contains('r') {
            let end = format!("\"{}", "#".repeat(hashes));
            text[prefix + 1..].find(&end).map_or(text.len(), |index| prefix + 1 + index + end.len())
        } else {
            prefix + quoted(&text[prefix..], '"')
        };
    }
    if text.starts_with('"') || text.starts_with('\'') {
        return quoted(text, if text.starts_with('"') { '"' } else { '\'' });
    }
    let end = |letter: char| letter.is_whitespace() || is_mark(letter) || "()[]{},:\"".contains(letter);
    let word = text.find(end).unwrap_or(text.len());
    text[..word].find("//").or_else(|| text[..word].find("/*")).unwrap_or(word).max(1)
}

/// The length of a text with its quotes.
fn quoted(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (index, letter) in text.char_indices().skip(1) {
        match letter {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if letter == quote => return index + 1,
            _ => {}
        }
    }
    text.len()
}
