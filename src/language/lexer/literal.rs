//! Texts, characters and numbers: their ends and their mistakes.

use super::{Lexer, Step};
use crate::error::SceneError;

impl Lexer<'_> {
    pub(super) fn text_literal(&mut self, start: usize) -> Step {
        let mut escaped = false;
        let body = self.at + 1;
        for (index, c) in self.text[body..].char_indices() {
            match c {
                _ if escaped => escaped = false,
                '\\' => escaped = true,
                '"' => {
                    self.at = body + index + 1;
                    return Ok(());
                }
                _ => {}
            }
        }
        Err(self.open_text(start))
    }

    pub(super) fn raw_literal(&mut self, start: usize, hashes: usize) -> Step {
        let end = format!("\"{}", "#".repeat(hashes));
        let body = self.at + 1;
        match self.text[body..].find(&end) {
            Some(index) => {
                self.at = body + index + end.len();
                Ok(())
            }
            None => Err(self.open_text(start)),
        }
    }

    fn open_text(&self, start: usize) -> Box<SceneError> {
        let end = self.text[start..].find('\n').map_or(self.text.len(), |index| start + index);
        self.fault("the text that begins here never ends", start..end, "no closing `\"`").help("close it with `\"`")
    }

    pub(super) fn character(&mut self, start: usize) -> Step {
        let mut letters = self.text[start + 1..].chars();
        let first = letters.next();
        let letter = if first == Some('\\') { letters.next() } else { first };
        if letter.is_some() && letters.next() == Some('\'') {
            self.at = self.text.len() - letters.as_str().len();
            return Ok(());
        }
        let line_end = self.text[start + 1..].find('\n').map_or(self.text.len(), |index| start + 1 + index);
        let line = &self.text[start + 1..line_end];
        let end = line.find('\'').map_or(start + 1, |index| start + 1 + index + 1);
        let inner = self.text[start + 1..end].trim_end_matches('\'');
        let help = format!("write `\"{inner}\"`");
        Err(self.fault("texts stand in double quotes", start..end, "single quotes").help(help))
    }

    pub(super) fn number(&mut self) -> Step {
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
                self.not_finite(span);
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
pub(crate) fn text_prefix(text: &str) -> Option<(usize, usize)> {
    let letters = text.find(|c| !matches!(c, 'b' | 'r')).unwrap_or(text.len());
    if !matches!(&text[..letters], "b" | "r" | "br") {
        return None;
    }
    let hashes = text[letters..].bytes().take_while(|&byte| byte == b'#').count();
    let prefix = letters + hashes;
    (text[prefix..].starts_with('"') && (hashes == 0 || text[..letters].ends_with('r'))).then_some((prefix, hashes))
}

/// The value of a number as RON may hold it. Ranges and whole numbers of other bases count as zero.
fn number_value(written: &str) -> Option<f64> {
    // Nearly all numbers are plain; `parse` also takes words such as `inf`, which begin with a letter.
    if !written.trim_start_matches(['+', '-']).starts_with(|c: char| c.is_ascii_alphabetic())
        && let Ok(value) = written.parse()
    {
        return Some(value);
    }
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
