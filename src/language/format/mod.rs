//! The standard layout of a scene's text, which `jostle fmt` writes.
//!
//! The author's line breaks stay. Indentation, blanks, commas and blank lines are corrected, and sections follow the
//! order of the manual. Numbers, texts and comments stay unchanged, except that hidden characters become escapes. The layout depends only on the content and its line
//! breaks. So a text in its standard layout is not changed.

mod order;
mod parse;
mod write;

use super::error::SceneErrors;
use super::lexer::lex;
use super::source::Source;

/// The text in its standard layout.
///
/// # Errors
/// If the text cannot be read because of a misplaced bracket or the like. Other mistakes stay as they are.
pub fn formatted(source: &Source) -> Result<String, SceneErrors> {
    if let Some(fault) = lex(&source.text).fault {
        return Err(SceneErrors::new(source.clone(), vec![fault], Vec::new()));
    }
    let mut file = parse::parse(&source.text);
    write::break_long_lines(&mut file);
    let as_it_stands = write::write(&file);
    if !order::sort(&mut file) {
        return Ok(as_it_stands);
    }
    let sorted = write::write(&file);
    let same = |text: &String| super::macros::made(&Source { text: text.clone(), ..source.clone() }, &[]);
    Ok(match (same(&as_it_stands), same(&sorted)) {
        (Some(before), Some(after)) if before == after => sorted,
        _ => as_it_stands,
    })
}

#[cfg(test)]
mod tests;
