//! The source map: from places in the made text back to places in the files of the author.

use std::collections::BTreeMap;
use std::ops::Range;

use super::expansion::Piece;
use super::{Cause, Expanded, Step};
use crate::error::{Mark, SceneError, SceneErrors};
use crate::source::Source;
use crate::syntax::{Form, Tree};

const REPETITION: &str = "in the repetition";

/// The way from a step back to the scene, nearest first.
pub(super) fn chain(steps: &[Step], step: u32) -> Vec<Mark> {
    let mut chain = Vec::new();
    let mut at = step;
    while let Some(Step { before, file, at: (from, to), cause: Some(cause), .. }) = steps.get(at as usize) {
        let label = match cause {
            Cause::Instance { name, template } => format!("in the instance `{name}` of the template `{template}`"),
            Cause::Repetition { names, i, j } => {
                let indices = names.iter().zip([Some(*i), *j]).filter_map(|(name, index)| Some((name, index?)));
                let indices: Vec<String> = indices.map(|(name, index)| format!("{name} = {index}")).collect();
                format!("{REPETITION} {}", indices.join(", "))
            }
            Cause::Included => "included here".to_owned(),
        };
        chain.push(Mark { source: *file, span: *from as usize..*to as usize, label });
        at = *before;
    }
    chain
}

/// The same mistake in many instances is one mistake: what differs may be numbers.
pub(super) fn merge(errors: &mut Vec<SceneError>) {
    let mut seen: BTreeMap<(usize, usize, String), usize> = BTreeMap::new();
    let mut kept: Vec<SceneError> = Vec::new();
    for error in std::mem::take(errors) {
        let words: String = error.message.chars().filter(|c| !c.is_ascii_digit()).collect();
        let place = error.span.as_ref().map_or(usize::MAX, |span| span.start);
        let key = (error.source, place, words);
        match seen.get(&key) {
            Some(&first) if !error.chain.is_empty() => kept[first].again += 1,
            // A parameter that is used in many places is reported once.
            Some(&first) if error.span.is_some() && kept[first] == error => {}
            _ => {
                seen.insert(key, kept.len());
                kept.push(error);
            }
        }
    }
    *errors = kept;
}

impl Expanded {
    /// Mistakes of the made text as mistakes of the files it was made from.
    pub(crate) fn told(&self, tree: &Tree, mut errors: Vec<SceneError>, notes: Vec<String>) -> SceneErrors {
        for error in &mut errors {
            self.locate(tree, error);
        }
        merge(&mut errors);
        let notes = self.notes.iter().cloned().chain(notes).collect();
        SceneErrors::of_files(self.sources(), errors, notes)
    }

    fn sources(&self) -> Vec<Source> {
        self.files.iter().map(|file| file.source.clone()).collect()
    }

    fn piece(&self, offset: usize) -> usize {
        self.pieces.partition_point(|piece| piece.start as usize <= offset).saturating_sub(1)
    }

    /// The file and the place there of a place in the made text, and the piece it begins in.
    fn original(&self, span: &Range<usize>) -> (usize, Range<usize>, Piece) {
        let first = self.pieces[self.piece(span.start)];
        let last = self.pieces[self.piece(span.end.saturating_sub(1).max(span.start))];
        let whole = |piece: Piece| piece.from as usize..piece.to as usize;
        let along = |piece: Piece, offset: usize| {
            (piece.from as usize + offset.saturating_sub(piece.start as usize)).min(piece.to as usize)
        };
        let start = if first.made { first.from as usize } else { along(first, span.start) };
        let end = if last.made { last.to as usize } else { along(last, span.end) };
        let same = first.file == last.file && end >= start;
        let end = if same { end } else { whole(first).end };
        (first.file as usize, start..end, first)
    }

    fn locate(&self, made: &Tree, error: &mut SceneError) {
        let Some(span) = error.span.clone() else { return };
        let (number, there, piece) = self.original(&span);
        let file = &self.files[number];
        let text = &file.source.text;
        self.rename_paths(made, &span, error);
        let node = file.tree.innermost(there.start, false);
        error.path = file.tree.path(node, text);
        error.source = number;
        error.file = (number > 0).then(|| file.source.name.clone());
        error.chain = chain(&self.steps, piece.step);
        let repeated = error.chain.iter().find_map(|mark| mark.label.strip_prefix(REPETITION));
        if let Some(indices) = repeated
            && error.message.contains("is taken by")
        {
            let braces: Vec<String> = indices
                .split(", ")
                .filter_map(|index| Some(format!("{{{}}}", index.split(" = ").next()?.trim())))
                .collect();
            let (whose, example) = (if braces.len() == 1 { "its index" } else { "its indices" }, braces.join("_"));
            error.help =
                Some(format!("give every thing its own name: in a `Repeat` put {whose} in, as in \"ball_{example}\""));
        }
        if piece.made && file.tree.node(node).form == Form::Text && there == file.tree.span(node) {
            let value = &self.text[piece.start as usize..];
            let value = &value[..made.span(made.innermost(piece.start as usize, false)).len().min(value.len())];
            error.label = format!("{}: {value}", error.label);
            let name = text[there.clone()].trim_matches('"');
            if error.message.ends_with(&format!("found the number {value}")) && value.parse::<f64>().is_ok() {
                let help = error.help.take().map_or_else(String::new, |help| format!("; {help}"));
                error.help = Some(format!(
                    "`{name}` is the name of a number here. To name another thing so, rename one of the two{help}"
                ));
            }
        } else if let Some(reason) = self.reasons.get(&(number, there.start))
            && ["a word", "a map", "a list", "round", "`true`"].iter().all(|other| !error.message.contains(other))
            && ["found the text", "has no unit", "unknown unit", "is not a unit"]
                .iter()
                .any(|told| error.message.contains(told))
        {
            let written = &text[file.tree.span(node)];
            let expected = error.message.find("expected ").map_or("", |start| &error.message[start..]);
            let expected = expected.split(", found").next().unwrap_or_default().to_owned();
            error.help = reason.help.clone().or(Some(expected));
            error.message = format!("in {written}: {}", reason.message);
            error.span.clone_from(&reason.span);
            error.label.clone_from(&reason.message);
            self.place_also(error);
            return;
        }
        error.span = Some(there);
        self.place_also(error);
    }

    fn place_also(&self, error: &mut SceneError) {
        let Some((span, label)) = error.also.take() else { return };
        let (number, there, piece) = self.original(&span);
        if number == error.source && error.span.as_ref() != Some(&there) {
            error.also = Some((there, label));
        } else if number != error.source {
            error.chain.push(Mark { source: number, span: there, label });
        } else {
            // The same place of a template, through another instance.
            let other = chain(&self.steps, piece.step);
            if let Some(mark) = other.into_iter().next() {
                error.chain.push(Mark { label: format!("{label}, {}", mark.label), ..mark });
            }
        }
    }

    /// Replaces paths of the made text in a message by paths of the file.
    fn rename_paths(&self, made: &Tree, span: &Range<usize>, error: &mut SceneError) {
        let mut node = made.innermost(span.start, false);
        while node != 0 {
            let path = format!("`{}`", made.path(node, &self.text));
            if error.message.contains(&path) {
                let (number, there, _) = self.original(&made.head(node));
                let file = &self.files[number];
                let original = file.tree.path(file.tree.innermost(there.start, false), &file.source.text);
                error.message = error.message.replace(&path, &format!("`{original}`"));
            }
            node = made.node(node).parent;
        }
    }
}
