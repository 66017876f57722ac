//! Mistakes of order: something else in place of a comma, a name, a value or a bracket.

use std::ops::Range;

use super::{Lexer, Step};
use crate::error::SceneError;
use crate::syntax::{Form, Id};

impl Lexer<'_> {
    /// After a value: a comma, or one of the mistakes that are made instead.
    pub(super) fn comma(&mut self) -> Step {
        let Some(found) = self.peek() else { return Ok(()) };
        if found == ',' {
            self.pass(1);
            if let Some(frame) = self.frames.last_mut() {
                frame.item_done = false;
            }
            return Ok(());
        }
        let Some(frame) = self.frames.last() else { return Ok(()) };
        let last = self.last_value();
        let before = last.map_or(0..0, |id| self.tree.span(id));
        let before_form = last.map(|id| self.tree.node(id).form);
        let keyless = last.is_some_and(|id| self.tree.key(id).is_empty());
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
                    .help(format!("write `{bare}: ..`; if you choose the names, `{{ \"{bare}\": .. }}`")));
            }
        }
        if before_form == Some(Form::Word) && matches!(found, '[' | '{') {
            return Err(self.name_before_bracket(&self.text[before.clone()], before, found));
        }
        if frame.form == Form::Round && before_form == Some(Form::Word) && keyless && found != ';' {
            let name = word.to_owned();
            let fault = self.fault(&format!("`:` is missing after `{name}`"), before, "`:` expected after this");
            return Err(fault.help(format!("write `{name}: ..`")));
        }
        if found == ';' {
            return Err(self
                .fault("fields and items are separated by `,`, not `;`", here, "expected `,`")
                .help("write `,`"));
        }
        if before_form == Some(Form::Text) && word.contains('\n') {
            let line = word.find('\n').map_or(before.end, |length| before.start + length);
            let fault = self.fault(
                "a text begins here and ends only lines below",
                before.start..line,
                "no closing `\"` on this line",
            );
            return Err(self.about_last(fault).help("close the text with `\"`"));
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
        // The correction belongs at the end of the last word. The next word may be lines below.
        let end = self.last_end;
        let start = self.text[..end].char_indices().next_back().map_or(end, |(index, _)| index);
        let fault = self.fault("a comma is missing after this value", start..end, "`,` expected after this");
        let help = match before_form {
            Some(Form::Text) => "separate fields and list items with `,`. Or is a closing `\"` missing before?",
            _ => "separate fields and list items with `,`",
        };
        Err(self.about_last(fault).help(help))
    }

    /// Round brackets hold fields with names or values without, never both.
    pub(super) fn all_named_or_none(&self, key: &Range<usize>) -> Step {
        let Some(before) = self.last_value() else { return Ok(()) };
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
        if self.text[self.token().start..].starts_with('#') {
            return Err(self.no_comment());
        }
        let fault = self.fault("expected a field name and `:`", self.token(), "no field name");
        Err(fault.help("every field here has a name, as in `name: value`"))
    }

    /// A comment as other languages write them.
    fn no_comment(&self) -> Box<SceneError> {
        let fault = self.fault("`#` begins no comment here", self.token(), "not expected here");
        fault.help("comments begin with `//` and last to the end of the line")
    }

    pub(super) fn unclosed(&self) -> Box<SceneError> {
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

    pub(super) fn no_value(&self, key: &Range<usize>, found: char) -> Box<SceneError> {
        let name = &self.text[key.clone()];
        if matches!(found, ',' | ')' | ']' | '}') && !name.is_empty() {
            return self
                .fault(&format!("`{name}` has no value"), key.clone(), "a value is missing after this")
                .help(format!("write `{name}: ..`, or remove it"));
        }
        if found == '#' {
            return self.no_comment();
        }
        let span = self.token();
        let help = if found == ',' {
            "one comma is enough"
        } else if matches!(found, '“' | '”' | '„' | '«' | '»' | '‘' | '’') {
            "texts stand between straight double quotes: write `\"..\"`"
        } else {
            "a value is a number, a \"text\", a word, `(..)`, `[..]` or `{..}`"
        };
        self.fault(&format!("`{found}` is not expected here"), span, "not the beginning of a value").help(help)
    }

    /// `Name[..]` or `Name {..}` in place of `Name(..)`.
    pub(super) fn name_before_bracket(&self, name: &str, span: Range<usize>, found: char) -> Box<SceneError> {
        let help = if found == '[' { format!("write `{name}([..])`") } else { format!("write `{name}(..)`") };
        let fault = self.fault(&format!("`(` is missing after `{name}`"), span, "`(` expected after this");
        self.about_last(fault).help(help)
    }

    pub(super) fn about_last(&self, fault: Box<SceneError>) -> Box<SceneError> {
        match self.last_value() {
            Some(last) => self.about(last, fault),
            None => fault,
        }
    }

    /// Names the last value in a fault, instead of the value around it.
    pub(super) fn about(&self, value: Id, mut fault: Box<SceneError>) -> Box<SceneError> {
        fault.node = Some(value);
        fault
    }

    pub(super) fn fault(&self, message: &str, span: Range<usize>, label: &str) -> Box<SceneError> {
        let node = self.frames.last().map(|frame| frame.id);
        Box::new(SceneError { node, ..SceneError::new("", message).at(span, label) })
    }
}

impl SceneError {
    pub(super) fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Self> {
        self.help = Some(help.into());
        self
    }
}
