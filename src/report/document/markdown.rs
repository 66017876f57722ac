//! The report as Markdown; pictures lie beside it.

use super::page::{Block, Cell};

/// The page.
pub fn page(blocks: &[Block]) -> String {
    let mut text = String::new();
    for block in blocks {
        text.push_str(&written(block));
        text.push('\n');
    }
    text
}

fn written(block: &Block) -> String {
    match block {
        Block::Heading(level, text) => format!("{} {text}\n", "#".repeat(usize::from(*level))),
        Block::Text(text) => format!("{text}\n"),
        Block::Table(heads, rows) => {
            let line =
                |cells: &mut dyn Iterator<Item = String>| format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "));
            let mut text = line(&mut heads.iter().map(|head| escaped(head)));
            text.push_str(&line(&mut heads.iter().map(|_| "---".to_owned())));
            rows.iter().for_each(|row| text.push_str(&line(&mut row.iter().map(cell))));
            text
        }
        Block::Picture(picture) => format!("![{}]({})\n", picture.shows, picture.file),
        Block::Folded(name, blocks) => {
            format!("<details><summary>{name}</summary>\n\n{}\n</details>\n", page(blocks).trim_end())
        }
    }
}

fn cell(cell: &Cell) -> String {
    match cell {
        Cell::Text(text) => escaped(text),
        Cell::Link(name) => format!("[{name}](#{name})"),
    }
}

fn escaped(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;")
}
