//! Mistakes in a scene, each with its place, path, source line and remedy.

use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;

use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use serde::Serialize;

use super::hidden::{visible, visible_line};
use super::source::{Lines, Source};

/// The number of mistakes that are shown in full; the rest are counted.
const SHOWN: usize = 20;
/// Longer excerpts than this many bytes are not shown, only named.
const LONGEST_EXCERPT: usize = 4000;

/// No part of a message is longer than this many bytes.
const LONGEST_PART: usize = 2000;

/// The number of steps that a message shows of the way to a mistake: instances, repetitions, included files.
const STEPS_SHOWN: usize = 4;

/// A place in one of the scene's files, and its part in a mistake.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mark {
    pub(crate) source: usize,
    pub(crate) span: Range<usize>,
    pub(crate) label: String,
}

/// One mistake.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SceneError {
    /// The line, from one; absent when the mistake has no place in the text (a missing file).
    pub line: Option<usize>,
    /// The column in characters, from one.
    pub column: Option<usize>,
    /// The file, if the scene includes it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The path in the scene, such as `bodies[0].mass`; empty for the scene as a whole.
    pub path: String,
    /// The mistake, and what the reader found.
    pub message: String,
    /// The remedy.
    pub help: Option<String>,
    /// The words beside the caret.
    #[serde(skip)]
    pub(crate) label: String,
    /// The bytes above the caret.
    #[serde(skip)]
    pub(crate) span: Option<Range<usize>>,
    /// The value the mistake is about, until its path is known.
    #[serde(skip)]
    pub(crate) node: Option<u32>,
    /// Whether the walk over the text found it, before anything was read.
    #[serde(skip)]
    pub(crate) by_walk: bool,
    /// A second place, and its part in the mistake.
    #[serde(skip)]
    pub(crate) also: Option<(Range<usize>, String)>,
    /// The number of the file among those of the scene.
    #[serde(skip)]
    pub(crate) source: usize,
    /// Through which instances, repetitions and included files the place is reached, nearest first.
    #[serde(rename = "through", skip_serializing_if = "Vec::is_empty", serialize_with = "labels")]
    pub(crate) chain: Vec<Mark>,
    /// The number of times that the same mistake is made again through other instances or repetitions.
    #[serde(skip)]
    pub(crate) again: usize,
}

fn labels<S: serde::Serializer>(chain: &[Mark], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(chain.iter().map(|mark| &mark.label))
}

/// A longer word of a message is a number or a name without end. Its place shows it; paths of files stay whole.
const LONGEST_WORD: usize = 80;

/// Shortens words that are too long to be read. A quote and a comma behind them stay.
fn clip_words(text: &mut String) {
    let is_endless = |word: &str| word.len() > LONGEST_WORD && !word.contains(['/', '\\']);
    if text.split(' ').any(is_endless) {
        let short = |word: &str| {
            let ending = word.trim_end_matches(|sign: char| !sign.is_alphanumeric()).len();
            match is_endless(word) {
                true => format!("{}...{}", &word[..word.floor_char_boundary(LONGEST_WORD / 2)], &word[ending..]),
                false => word.to_owned(),
            }
        };
        *text = text.split(' ').map(short).collect::<Vec<_>>().join(" ");
    }
}

/// Shortens a text that is too long to be read.
fn clip(text: &mut String) {
    if text.len() > LONGEST_PART {
        let left_out = text.len() - LONGEST_PART;
        text.truncate(text.floor_char_boundary(LONGEST_PART));
        text.push_str(&format!(" ... ({left_out} bytes left out)"));
    }
}

impl SceneError {
    /// A mistake without a place.
    pub fn new(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self { path: path.into(), message: message.into(), ..Self::default() }
    }

    /// Adds what to do about it.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    pub(crate) fn at(mut self, span: Range<usize>, label: impl Into<String>) -> Self {
        self.span = Some(span);
        self.label = label.into();
        self
    }

    pub(crate) fn also(mut self, span: Range<usize>, label: impl Into<String>) -> Self {
        self.also = Some((span, label.into()));
        self
    }

    fn title(&self) -> String {
        if self.path.is_empty() { self.message.clone() } else { format!("{}: {}", self.path, self.message) }
    }
}

/// All mistakes of one scene, in the order of the file.
#[derive(Clone, Debug)]
pub struct SceneErrors {
    /// The scene, and the files it includes.
    sources: Vec<Source>,
    errors: Vec<SceneError>,
    notes: Vec<String>,
}

impl SceneErrors {
    /// Puts mistakes in the order of the file and gives them line and column.
    pub fn new(source: Source, errors: Vec<SceneError>, notes: Vec<String>) -> Self {
        Self::of_files(vec![source], errors, notes)
    }

    /// The same for a scene that includes other files.
    pub(crate) fn of_files(sources: Vec<Source>, mut errors: Vec<SceneError>, notes: Vec<String>) -> Self {
        errors.sort_by_key(|error| (error.source, error.span.as_ref().map_or(usize::MAX, |span| span.start)));
        // If the walk over the text refused a value, the checks need not repeat it.
        let walked: BTreeSet<String> =
            errors.iter().filter(|error| error.by_walk).map(|error| error.path.clone()).collect();
        errors.retain(|error| error.by_walk || !walked.contains(&error.path));
        let lines: Vec<Lines> = sources.iter().map(|source| Lines::new(&source.text)).collect();
        for error in &mut errors {
            if let Some(span) = &error.span {
                let (line, column) = lines[error.source].place(span.start);
                error.line = Some(line);
                error.column = Some(column);
            }
        }
        drop(lines);
        // A value of a scene may have any length, and a message may quote it.
        for error in &mut errors {
            [&mut error.message, &mut error.label].into_iter().for_each(clip_words);
            [&mut error.path, &mut error.message, &mut error.label].into_iter().for_each(clip);
            error.help.iter_mut().for_each(clip);
        }
        Self { sources, errors, notes }
    }

    /// The mistakes in the order of the file.
    pub fn errors(&self) -> &[SceneError] {
        &self.errors
    }

    /// Remarks of the checks that are not mistakes.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The scene's name.
    pub fn name(&self) -> &str {
        &self.sources[0].name
    }

    /// The mistakes as plain data for `--json`: line, column, path, message, help.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({ "scene": self.name(), "errors": self.errors })
    }

    /// The mistakes as text for people; with `color` for terminals, without for files and tests.
    pub fn render(&self, color: bool) -> String {
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        let lines: Vec<Lines> = self.sources.iter().map(|source| Lines::new(&source.text)).collect();
        let mut text = String::new();
        for error in self.errors.iter().take(SHOWN) {
            if !text.is_empty() {
                text.push('\n');
            }
            text.push_str(&renderer.render(&[self.report(error, &lines)]));
            text.push('\n');
        }
        if self.errors.len() > SHOWN {
            text.push_str(&format!("\n... and {} more mistakes of this scene\n", self.errors.len() - SHOWN));
        }
        text
    }

    fn report<'a>(&'a self, error: &'a SceneError, all_lines: &[Lines]) -> Group<'a> {
        let (source, lines) = (&self.sources[error.source], &all_lines[error.source]);
        let mut group = Group::with_title(Level::ERROR.primary_title(visible_line(&error.title()).into_owned()));
        if let Some(span) = &error.span {
            let near = error.also.as_ref().filter(|(also, _)| also.start.abs_diff(span.start) < LONGEST_EXCERPT);
            let first = near.map_or(span.start, |(also, _)| also.start.min(span.start));
            let last = near.map_or(span.end, |(also, _)| also.end.max(span.end));
            let (first_line, _) = lines.place(first);
            let (last_line, _) = lines.place(last);
            let window = lines.span(first_line, (last_line + 1).min(lines.count()));
            let window = if window.len() > LONGEST_EXCERPT { lines.span(first_line, last_line) } else { window };
            if window.len() > LONGEST_EXCERPT {
                let origin = Origin::path(visible_line(&source.name))
                    .line(error.line.unwrap_or(1))
                    .char_column(error.column.unwrap_or(1));
                group = group.element(origin);
            } else {
                let excerpt = Excerpt { text: &source.text, window };
                let mut snippet = excerpt
                    .snippet(&source.name, first_line)
                    .annotation(AnnotationKind::Primary.span(excerpt.place(span)).label(visible_line(&error.label)));
                if let Some((also, label)) = near {
                    snippet = snippet
                        .annotation(AnnotationKind::Context.span(excerpt.place(also)).label(visible_line(label)));
                }
                group = group.element(snippet);
            }
            if let (Some((also, label)), None) = (&error.also, near) {
                let (line, column) = lines.place(also.start);
                group = group.element(Level::NOTE.message(format!("{} at {line}:{column}", visible_line(label))));
            }
        }
        for mark in error.chain.iter().take(STEPS_SHOWN) {
            group = self.step(group, mark, all_lines);
        }
        let more = error.chain.len().saturating_sub(STEPS_SHOWN);
        if more > 0 {
            group = group.element(Level::NOTE.message(format!("... and {more} more steps from the scene to there")));
        }
        if error.again > 0 {
            let times = if error.again == 1 { "once".to_owned() } else { format!("{} times", error.again) };
            group = group.element(Level::NOTE.message(format!("the same mistake is made {times} more")));
        }
        if let Some(help) = &error.help {
            group = group.element(Level::HELP.message(visible(help)));
        }
        group
    }
}

/// Lines of a file, shown with hidden characters as escapes.
struct Excerpt<'a> {
    text: &'a str,
    /// Their bytes in the file.
    window: Range<usize>,
}

impl<'a> Excerpt<'a> {
    fn snippet(&self, name: &'a str, first_line: usize) -> Snippet<'a, Annotation<'a>> {
        Snippet::source(visible(&self.text[self.window.clone()])).path(visible_line(name)).line_start(first_line)
    }

    /// The place of a part of the file in the lines as they are shown.
    fn place(&self, span: &Range<usize>) -> Range<usize> {
        let shown = |end: usize| visible(&self.text[self.window.start..end]).len();
        shown(span.start)..shown(span.end)
    }
}

impl SceneErrors {
    /// One step on the way to a mistake, with its line in the file.
    fn step<'a>(&'a self, group: Group<'a>, mark: &'a Mark, all_lines: &[Lines]) -> Group<'a> {
        let (source, lines) = (&self.sources[mark.source], &all_lines[mark.source]);
        let (line, column) = lines.place(mark.span.start);
        let window = lines.span(line, line);
        if window.len() > LONGEST_EXCERPT {
            let note = format!("{} at {}:{line}:{column}", mark.label, source.name);
            return group.element(Level::NOTE.message(visible_line(&note).into_owned()));
        }
        let place = mark.span.start..mark.span.end.min(window.end).max(mark.span.start);
        let excerpt = Excerpt { text: &source.text, window };
        group.element(
            excerpt
                .snippet(&source.name, line)
                .annotation(AnnotationKind::Context.span(excerpt.place(&place)).label(visible_line(&mark.label))),
        )
    }
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneErrors {}
