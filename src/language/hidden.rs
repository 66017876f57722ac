//! Hidden characters of a text, shown as escapes. A terminal obeys some of them, and does not draw the others. Sources: Unicode
//! Standard Annex #44, `Default_Ignorable_Code_Point`; Boucher and Anderson 2021, *Trojan Source*.
//!
//! A scene may come from a stranger, and its texts stand in messages, cards and tables. The command line prints each
//! of them through this mask.

use std::borrow::Cow;
use std::fmt::Write;

/// Whether a terminal obeys a character or does not draw it. Line breaks and tabs are ordinary. So are the variation
/// selectors of the first sixteen, as they choose the form of a letter that is drawn.
pub fn is_hidden(letter: char) -> bool {
    match letter {
        '\n' | '\t' | ' '..='~' => false,
        // Interlinear annotation and the separators of lines and paragraphs have an effect, but are not ignorable.
        '\u{2028}' | '\u{2029}' | '\u{fff9}'..='\u{fffb}' => true,
        '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' => true,
        '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' => true,
        '\u{3164}' | '\u{feff}' | '\u{ffa0}' | '\u{fff0}'..='\u{fff8}' => true,
        '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}' => true,
        _ => letter.is_control(),
    }
}

/// A text with hidden characters as escapes of the scene language, such as `\u{1b}`. The line break of Windows stays.
pub fn visible(text: &str) -> Cow<'_, str> {
    shown(text, |out, letter| {
        let _ = write!(out, "\\u{{{:x}}}", u32::from(letter));
    })
}

/// The same for a text within a line, which breaks no line.
pub fn visible_line(text: &str) -> Cow<'_, str> {
    if !text.contains(['\n', '\r']) {
        return visible(text);
    }
    let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    Cow::Owned(visible(&lines.join(" ")).into_owned())
}

/// JSON with hidden characters as escapes of JSON, such as `\u001b`: its texts keep their meaning.
pub fn visible_json(json: &str) -> Cow<'_, str> {
    shown(json, |out, letter| {
        for unit in letter.encode_utf16(&mut [0; 2]) {
            let _ = write!(out, "\\u{unit:04x}");
        }
    })
}

fn shown(text: &str, escape: impl Fn(&mut String, char)) -> Cow<'_, str> {
    let Some(first) = text.find(is_hidden) else { return Cow::Borrowed(text) };
    let mut out = String::with_capacity(text.len() + 16);
    out.push_str(&text[..first]);
    let mut letters = text[first..].chars().peekable();
    while let Some(letter) = letters.next() {
        let ends_line = letter == '\r' && letters.peek() == Some(&'\n');
        if is_hidden(letter) && !ends_line { escape(&mut out, letter) } else { out.push(letter) }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hidden_characters_become_escapes_and_others_stay() {
        assert!(matches!(visible("plain, Größe\t1\n"), Cow::Borrowed(_)));
        assert_eq!(visible("a\u{1b}[31m\u{7}\u{7f}\u{9b}\u{202e}\u{2066}\u{200b}"), {
            r"a\u{1b}[31m\u{7}\u{7f}\u{9b}\u{202e}\u{2066}\u{200b}"
        });
        assert_eq!(visible("\ra\r\nb\r"), "\\u{d}a\r\nb\\u{d}");
        assert_eq!(visible_line("one\r\n  two\u{8}\n"), r"one two\u{8}");
    }

    #[test]
    fn json_keeps_its_meaning() {
        let text = "\u{1b}\u{85}\u{202e}\u{e0041}\n\t\"é\"";
        let json = serde_json::to_string(text).expect("a text");
        let shown = visible_json(&json);
        assert!(!shown.contains(is_hidden) && !shown.contains('\n'));
        assert_eq!(serde_json::from_str::<String>(&shown).ok().as_deref(), Some(text));
    }
}
