//! The report as one self-contained HTML page, with its pictures inside.

use super::page::{Block, Cell};

const STYLE: &str = "body{font-family:system-ui,sans-serif;max-width:64rem;margin:2rem auto;padding:0 1rem;color:#222;line-height:1.45}\
table{border-collapse:collapse;font-size:.88rem;margin:1rem 0}td,th{border-bottom:1px solid #ddd;padding:.25rem .6rem;text-align:left;\
vertical-align:top}summary{cursor:pointer;color:#555;margin:.4rem 0}img{width:100%;height:auto}h2{margin-top:2.4rem}";

/// The page.
pub fn page(blocks: &[Block]) -> String {
    let title =
        blocks.iter().find_map(|block| if let Block::Heading(1, text) = block { Some(text.as_str()) } else { None });
    format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Jostle: {}</title><style>{STYLE}</style>\n{}</html>\n",
        escaped(title.unwrap_or("report")),
        blocks.iter().map(written).collect::<String>()
    )
}

fn written(block: &Block) -> String {
    match block {
        Block::Heading(level, text) => format!("<h{level} id=\"{0}\">{0}</h{level}>\n", escaped(text)),
        Block::Text(text) => format!("<p>{}</p>\n", marked(text)),
        Block::Table(heads, rows) => {
            let heads: String = heads.iter().map(|head| format!("<th>{}</th>", escaped(head))).collect();
            let row = |row: &Vec<Cell>| format!("<tr>{}</tr>\n", row.iter().map(cell).collect::<String>());
            format!("<table><tr>{heads}</tr>\n{}</table>\n", rows.iter().map(row).collect::<String>())
        }
        Block::Picture(picture) => {
            format!(
                "<p><img alt=\"{}\" src=\"data:image/png;base64,{}\"></p>\n",
                escaped(&picture.shows),
                base64(&picture.bytes)
            )
        }
        Block::Folded(name, blocks) => {
            let inner: String = blocks.iter().map(written).collect();
            format!("<details><summary>{}</summary>\n{inner}</details>\n", escaped(name))
        }
    }
}

fn cell(cell: &Cell) -> String {
    match cell {
        Cell::Text(text) => format!("<td>{}</td>", marked(text)),
        Cell::Link(name) => format!("<td><a href=\"#{0}\">{0}</a></td>", escaped(name)),
    }
}

/// Text with code between backquotes, and italics between stars.
fn marked(text: &str) -> String {
    let mut found = escaped(text);
    for (mark, name) in [('`', "code"), ('*', "em")] {
        let parts: Vec<&str> = found.split(mark).collect();
        // A mark without an end is no mark.
        if parts.len() % 2 == 1 {
            let tagged = |(index, part): (usize, &&str)| {
                if index % 2 == 1 { format!("<{name}>{part}</{name}>") } else { (*part).to_owned() }
            };
            found = parts.iter().enumerate().map(tagged).collect();
        }
    }
    found
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Bytes in the alphabet of RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let bits =
            group.iter().enumerate().fold(0_u32, |bits, (index, byte)| bits | u32::from(*byte) << (16 - 8 * index));
        for index in 0..4 {
            let letter = ALPHABET[(bits >> (18 - 6 * index)) as usize & 63];
            text.push(if index <= group.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of RFC 4648, section 10.
    #[test]
    fn base64_is_that_of_the_standard() {
        let pairs =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("foobar", "Zm9vYmFy")];
        for (plain, coded) in pairs {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn text_is_marked_and_escaped() {
        assert_eq!(marked("a `b<c` *d*"), "a <code>b&lt;c</code> <em>d</em>");
        assert_eq!(marked("2 * 3"), "2 * 3");
    }
}
