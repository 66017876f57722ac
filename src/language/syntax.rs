//! The syntax tree of a scene's text. It carries the places of values only; serde reads the values.

use std::fmt::Write;
use std::ops::Range;

/// The form of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// `1.5`
    Number,
    /// `"text"`
    Text,
    /// `'c'`
    Character,
    /// A bare word such as `Auto` or `true`.
    Word,
    /// `[..]`
    List,
    /// `(..)`, with or without a leading name
    Round,
    /// `{..}`
    Braces,
}

/// The number of a value in the tree.
pub(crate) type Id = u32;

#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) parent: Id,
    /// The place among its siblings.
    pub(crate) index: u32,
    key: (u32, u32),
    value: (u32, u32),
    /// The length in bytes of the leading name of the value.
    name: u32,
    children: (u32, u32),
    pub(crate) form: Form,
}

/// All values of a text. Value 0 is the outermost one.
#[derive(Debug, Default)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    children: Vec<Id>,
}

/// The end of a path.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) node: Id,
    /// Whether the whole path was found. Otherwise the place belongs to the nearest parent.
    pub(crate) whole: bool,
}

impl Tree {
    pub(crate) fn push(&mut self, parent: Id, index: u32, key: Range<usize>, start: usize, form: Form) -> Id {
        let start = start as u32;
        let id = self.nodes.len() as Id;
        self.nodes.push(Node {
            parent,
            index,
            key: (key.start as u32, key.end as u32),
            value: (start, start),
            name: 0,
            children: (0, 0),
            form,
        });
        id
    }

    pub(crate) fn set_name(&mut self, id: Id, length: usize) {
        self.nodes[id as usize].name = length as u32;
    }

    pub(crate) fn close(&mut self, id: Id, end: usize, children: &[Id]) {
        let first = self.children.len() as u32;
        self.children.extend_from_slice(children);
        let node = &mut self.nodes[id as usize];
        node.value.1 = end as u32;
        node.children = (first, first + children.len() as u32);
    }

    /// The number the next value will have.
    pub(crate) fn next(&self) -> Id {
        self.nodes.len() as Id
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    pub(crate) fn node(&self, id: Id) -> &Node {
        &self.nodes[id as usize]
    }

    pub(crate) fn children(&self, id: Id) -> &[Id] {
        let (first, end) = self.node(id).children;
        &self.children[first as usize..end as usize]
    }

    /// The bytes of a value, its leading name included.
    pub(crate) fn span(&self, id: Id) -> Range<usize> {
        let (start, end) = self.node(id).value;
        start as usize..end as usize
    }

    /// The bytes of a value's field name or map key, or an empty range.
    pub(crate) fn key(&self, id: Id) -> Range<usize> {
        let (start, end) = self.node(id).key;
        start as usize..end as usize
    }

    /// The leading name of `Name(..)`, or an empty text.
    pub(crate) fn name<'a>(&self, id: Id, text: &'a str) -> &'a str {
        let start = self.span(id).start;
        &text[start..start + self.node(id).name as usize]
    }

    /// The bytes that represent a value without covering many lines: its field name, leading name or opening bracket.
    pub(crate) fn head(&self, id: Id) -> Range<usize> {
        let key = self.key(id);
        let span = self.span(id);
        let name = self.node(id).name as usize;
        match self.node(id).form {
            _ if !key.is_empty() => key,
            _ if name > 0 => span.start..span.start + name,
            Form::List | Form::Round | Form::Braces => span.start..span.start + 1,
            _ => span,
        }
    }

    /// `Name(value)` with one value and no field names: paths go through it as if it were the value.
    pub(crate) fn is_wrapper(&self, id: Id) -> bool {
        let node = self.node(id);
        node.form == Form::Round && node.name > 0 && matches!(self.children(id), &[only] if self.key(only).is_empty())
    }

    /// The path of a value from the outermost one, such as `bodies[0].mass`.
    pub(crate) fn path(&self, id: Id, text: &str) -> String {
        let mut line = Vec::new();
        let mut at = id;
        while at != 0 {
            line.push(at);
            at = self.node(at).parent;
        }
        let mut path = String::new();
        for &id in line.iter().rev() {
            let key = &text[self.key(id)];
            if key.is_empty() {
                let parent = self.node(id).parent;
                // An open value has no children that could identify it.
                if !self.is_wrapper(parent) {
                    let _ = write!(path, "[{}]", self.node(id).index);
                }
            } else if self.node(self.node(id).parent).form == Form::Braces {
                let _ = write!(path, "[{key}]");
            } else {
                if !path.is_empty() {
                    path.push('.');
                }
                path.push_str(key);
            }
        }
        path
    }

    /// Follows a path such as `bodies[0].mass` or `materials["rock"].friction` as far as it leads.
    pub(crate) fn find(&self, path: &str, text: &str) -> Option<Place> {
        if self.is_empty() {
            return None;
        }
        let mut node = 0;
        for step in Steps(path) {
            while self.is_wrapper(node) {
                node = self.children(node)[0];
            }
            let next = match step {
                Step::Index(index) => self.children(node).get(index).copied(),
                Step::Field(name) => self.by_key(node, text, |key| key == name),
                Step::Key(name) => {
                    self.by_key(node, text, |key| key.strip_prefix('"').and_then(|k| k.strip_suffix('"')) == Some(name))
                }
            };
            match next {
                Some(next) => node = next,
                None => return Some(Place { node, whole: false }),
            }
        }
        Some(Place { node, whole: true })
    }

    /// Follows a path as people write it on a command line. Beside the steps of [`Tree::find`] it takes items of lists
    /// by their `name`, and map keys without quotes. Examples are `bodies.ball.mass` and `materials.rock.friction`. If
    /// the path breaks off, the error is the last value on the way and the step that it lacks.
    pub(crate) fn trace<'p>(&self, path: &'p str, text: &str) -> Result<Id, (Id, Vec<Step<'p>>)> {
        let mut node = 0;
        let mut steps = Steps(path);
        while let Some(step) = steps.next() {
            let quoted = |name: &str, key: &str| key.trim_matches('"') == name;
            let within = |node: Id| match step {
                Step::Index(index) => self.children(node).get(index).copied(),
                Step::Key(name) => self.by_key(node, text, |key| quoted(name, key)),
                Step::Field(name) if self.node(node).form == Form::List => {
                    let called = |&&item: &&Id| {
                        let own = self.by_key(item, text, |key| key == "name");
                        own.is_some_and(|own| quoted(name, &text[self.span(own)]))
                    };
                    self.children(node).iter().find(called).copied()
                }
                Step::Field(name) => self.by_key(node, text, |key| quoted(name, key)),
            };
            let mut next = within(node);
            while next.is_none() && self.is_wrapper(node) {
                node = self.children(node)[0];
                next = within(node);
            }
            match next {
                Some(next) => node = next,
                None => return Err((node, std::iter::once(step).chain(steps).collect())),
            }
        }
        Ok(node)
    }

    fn by_key(&self, node: Id, text: &str, fits: impl Fn(&str) -> bool) -> Option<Id> {
        self.children(node).iter().copied().find(|&child| fits(&text[self.key(child)]))
    }

    /// The innermost value at a byte. With `after`, the byte is the end of the text that was read; otherwise it is the
    /// start.
    pub(crate) fn innermost(&self, offset: usize, after: bool) -> Id {
        let mut node = 0;
        loop {
            let children = self.children(node);
            let begin = |id: Id| {
                let key = self.key(id);
                if key.is_empty() { self.span(id).start } else { key.start }
            };
            let count = children.partition_point(|&id| if after { begin(id) < offset } else { begin(id) <= offset });
            let Some(&child) = count.checked_sub(1).and_then(|last| children.get(last)) else { return node };
            let end = self.span(child).end;
            if offset < end || (after && offset == end) {
                node = child;
            } else {
                return node;
            }
        }
    }

    /// A value in words, for "found ..".
    pub(crate) fn describe(&self, id: Id, text: &str) -> String {
        let written = &text[self.span(id)];
        let short: String = if written.chars().count() > 40 {
            written.chars().take(37).chain("...".chars()).collect()
        } else {
            written.to_owned()
        };
        match self.node(id).form {
            Form::Number => format!("the number {short}"),
            Form::Text => format!("the text {short}"),
            Form::Character => format!("the character {short}"),
            Form::Word => format!("the word `{short}`"),
            Form::List => "a list `[..]`".into(),
            Form::Braces => "a map `{..}`".into(),
            Form::Round => match self.name(id, text) {
                "" if self.children(id).iter().all(|&child| self.key(child).is_empty()) => {
                    let count = self.children(id).len();
                    format!("a round bracket with {count} value{}", if count == 1 { "" } else { "s" })
                }
                "" => "a round bracket with named fields `(..: ..)`".into(),
                name => format!("`{name}(..)`"),
            },
        }
    }
}

/// One step of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step<'a> {
    Field(&'a str),
    Index(usize),
    Key(&'a str),
}

struct Steps<'a>(&'a str);

impl<'a> Iterator for Steps<'a> {
    type Item = Step<'a>;

    fn next(&mut self) -> Option<Step<'a>> {
        self.0 = self.0.strip_prefix('.').unwrap_or(self.0);
        if self.0.is_empty() {
            return None;
        }
        if let Some(rest) = self.0.strip_prefix("[\"") {
            let end = rest.find("\"]").unwrap_or(rest.len());
            let key = &rest[..end];
            self.0 = rest.get(end + 2..).unwrap_or("");
            return Some(Step::Key(key));
        }
        if let Some(rest) = self.0.strip_prefix('[') {
            let end = rest.find(']').unwrap_or(rest.len());
            let index = rest[..end].parse().unwrap_or(usize::MAX);
            self.0 = rest.get(end + 1..).unwrap_or("");
            return Some(Step::Index(index));
        }
        let end = self.0.find(['.', '[']).unwrap_or(self.0.len());
        let (name, rest) = self.0.split_at(end);
        self.0 = rest;
        Some(Step::Field(name))
    }
}
