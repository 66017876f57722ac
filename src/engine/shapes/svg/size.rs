//! The size of a drawing before it is read: its text with entities written out, and some numbers.
//!
//! The XML reader compares each attribute of an element with the others, and each reference with all entities. It copies
//! the namespaces of outer elements into inner ones, and writes entities out at each use. So its time follows squares.

use std::collections::BTreeMap;

/// The largest text of a drawing, in bytes, with its entities written out.
pub(super) const MOST_TEXT: usize = 4 << 20;
/// Programs for drawing write ten of them, and forty attributes of one element.
const MOST: usize = 256;
/// Entities in entities: the XML reader follows them so deep.
const DEEPEST_ENTITY: usize = 10;

/// The sizes of a piece of text.
#[derive(Default)]
struct Piece<'a> {
    length: usize,
    /// The names of its references.
    references: Vec<&'a str>,
    /// The declared entities with their texts.
    entities: Vec<(&'a str, &'a str)>,
    /// The most attributes of one element.
    attributes: usize,
    namespaces: usize,
    depth: usize,
}

/// # Errors
/// The number that is too large, in words, and the remedy.
pub(super) fn check(text: &str) -> Result<(), (String, String)> {
    let whole = Piece::of(text);
    // The first declaration of a name counts.
    let mut values: BTreeMap<&str, Piece> = BTreeMap::new();
    for (name, value) in whole.entities.iter().take(MOST) {
        values.entry(name).or_insert_with(|| Piece::of(value));
    }
    let mut lengths: BTreeMap<&str, usize> = values.iter().map(|(name, piece)| (*name, piece.length)).collect();
    for _ in 0..DEEPEST_ENTITY {
        lengths = values.iter().map(|(name, piece)| (*name, piece.written_out(&lengths))).collect();
    }
    let most = |count: fn(&Piece) -> usize| values.values().chain([&whole]).map(count).fold(0, usize::max);
    for (count, what) in [
        (whole.entities.len(), "entities"),
        (most(|piece| piece.attributes), "attributes of one element"),
        (most(|piece| piece.namespaces), "namespaces"),
        (most(|piece| piece.depth), "elements in each other"),
    ] {
        if count > MOST {
            let message = format!("has {count} {what}: there can be {MOST}");
            return Err((message, "save it as `plain SVG`".to_owned()));
        }
    }
    let length = whole.written_out(&lengths);
    if length > MOST_TEXT {
        let most = MOST_TEXT >> 20;
        let message = format!("has more than {most} MiB of text with its entities written out");
        return Err((message, "save it as `plain SVG`, without entities, or make the drawing simpler".to_owned()));
    }
    Ok(())
}

impl<'a> Piece<'a> {
    fn of(text: &'a str) -> Self {
        let mut piece = Self { length: text.len(), ..Self::default() };
        let (mut rest, mut depth) = (text, 0_usize);
        while let Some(at) = rest.find(['<', '&']) {
            rest = &rest[at..];
            let ends = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
            if let Some((begin, end)) = ends.into_iter().find(|(begin, _)| rest.starts_with(begin)) {
                rest = behind(&rest[begin.len()..], end);
            } else if let Some(reference) = rest.strip_prefix('&') {
                rest = piece.reference(reference);
            } else if rest.starts_with("<!ENTITY") {
                rest = piece.entity(&rest["<!ENTITY".len()..]);
            } else if rest.starts_with("<!") {
                // A declaration; entities in its brackets come next.
                rest = &rest[2..];
            } else if let Some(closed) = rest.strip_prefix("</") {
                depth = depth.saturating_sub(1);
                rest = behind(closed, ">");
            } else {
                let (behind, is_open) = piece.tag(&rest[1..]);
                depth += usize::from(is_open);
                piece.depth = piece.depth.max(depth);
                rest = behind;
            }
        }
        piece
    }

    /// A reference behind its `&`. Returns the text behind it.
    fn reference(&mut self, text: &'a str) -> &'a str {
        let end = text.find(|c: char| c == ';' || c == '<' || c == '&' || c.is_whitespace()).unwrap_or(text.len());
        if text[end..].starts_with(';') && !text.starts_with('#') {
            self.references.push(&text[..end]);
        }
        &text[end..]
    }

    /// A declaration such as ` name "text">`.
    fn entity(&mut self, text: &'a str) -> &'a str {
        let text = text.trim_start();
        let end = text.find(|c: char| c.is_whitespace() || c == '>').unwrap_or(text.len());
        let (name, value) = (&text[..end], text[end..].trim_start());
        let Some(quote) = value.chars().next().filter(|quote| matches!(quote, '"' | '\'')) else { return value };
        let value = &value[1..];
        let end = value.find(quote).unwrap_or(value.len());
        self.entities.push((name, &value[..end]));
        value.get(end + 1..).unwrap_or_default()
    }

    /// A tag behind its `<`. Returns the text behind it, and whether it opens an element.
    fn tag(&mut self, text: &'a str) -> (&'a str, bool) {
        let (mut rest, mut attributes, mut is_open) = (text, 0, true);
        while let Some(at) = rest.find(['"', '\'', '>', '=', '<']) {
            is_open = !rest[..at].ends_with('/');
            let sign = rest.as_bytes()[at];
            match sign {
                b'=' => {
                    attributes += 1;
                    let name = rest[..at].trim();
                    self.namespaces += usize::from(name == "xmlns" || name.contains("xmlns:"));
                    rest = &rest[at + 1..];
                }
                b'>' | b'<' => {
                    rest = &rest[at + usize::from(sign == b'>')..];
                    break;
                }
                _ => {
                    let value = &rest[at + 1..];
                    let end = value.find(char::from(sign)).unwrap_or(value.len());
                    let mut inner = &value[..end];
                    while let Some(at) = inner.find('&') {
                        inner = self.reference(&inner[at + 1..]);
                    }
                    rest = value.get(end + 1..).unwrap_or_default();
                }
            }
        }
        self.attributes = self.attributes.max(attributes);
        (rest, is_open)
    }

    /// Its length with the lengths of its references.
    fn written_out(&self, lengths: &BTreeMap<&str, usize>) -> usize {
        let each = self.references.iter().filter_map(|name| lengths.get(name));
        each.fold(self.length, |sum, more| sum.saturating_add(*more))
    }
}

/// The text behind the first of an end.
fn behind<'a>(text: &'a str, end: &str) -> &'a str {
    text.find(end).map_or("", |at| &text[at + end.len()..])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: what an entity stands for counts wherever it is used, in texts, attributes and other entities.
    #[test]
    fn entities_count_where_they_are_used() {
        let text =
            format!("<!DOCTYPE svg [<!ENTITY a \"{}\"><!ENTITY b '&a;&a;'>]><svg d=\"&b;\">", "x".repeat(1 << 20));
        assert_eq!(check(&format!("{text}</svg>")), Ok(()));
        let (message, _) = check(&format!("{text}&a;</svg>")).unwrap_err();
        assert!(message.contains("4 MiB"), "{message}");
        // Neither comments nor data hold references.
        assert_eq!(check(&format!("{text}<!--&b;--><![CDATA[&b;]]></svg>")), Ok(()));
        // The XML reader refuses the circle itself.
        let circle = "<!DOCTYPE svg [<!ENTITY a \"&b;\"><!ENTITY b \"&a;\">]><svg>&a;</svg>";
        assert_eq!(check(circle), Ok(()));
    }

    #[test]
    fn numbers_of_which_the_time_follows_the_square_are_bounded() {
        let many = |count: usize, one: &dyn Fn(usize) -> String| (0..count).map(one).collect::<String>();
        for (count, is_good) in [(MOST, true), (MOST + 1, false)] {
            let attributes = format!("<svg{}/>", many(count, &|index| format!(" a{index}='='")));
            let namespaces = format!("<svg>{}</svg>", many(count, &|index| format!("<g xmlns:a{index}='a>'/>")));
            let entities = format!("<!DOCTYPE svg [{}]><svg/>", many(count, &|index| format!("<!ENTITY a{index} ''>")));
            let nested = format!("{}{}", "<g>".repeat(count), "</g>".repeat(count));
            for text in [attributes, namespaces, entities, nested] {
                assert_eq!(check(&text).is_ok(), is_good, "{}", &text[..60]);
            }
        }
        assert_eq!(check(&"<g/>".repeat(1000)), Ok(()));
    }
}
