//! What is wrong with a scene, and how it is told: every mistake with its place, path, source line and remedy.

use std::collections::BTreeSet;
use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use serde::Serialize;

use super::source::{Lines, Source};

/// How many mistakes are shown in full; the rest are counted.
const SHOWN: usize = 20;
/// Longer excerpts than this many bytes are not shown, only named.
const LONGEST_EXCERPT: usize = 4000;

/// One mistake.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SceneError {
    /// The line, from one; absent when the mistake has no place in the text (a missing file).
    pub line: Option<usize>,
    /// The column in characters, from one.
    pub column: Option<usize>,
    /// Where in the scene, such as `bodies[0].mass`; empty for the scene as a whole.
    pub path: String,
    /// What is wrong, and what was found.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// What stands beside the caret.
    #[serde(skip)]
    pub(crate) label: String,
    /// The bytes the caret stands under.
    #[serde(skip)]
    pub(crate) span: Option<Range<usize>>,
    /// The value the mistake is about, until its path is known.
    #[serde(skip)]
    pub(crate) node: Option<u32>,
    /// Whether the walk over the text found it, before anything was read.
    #[serde(skip)]
    pub(crate) by_walk: bool,
    /// A second place and what it has to do with the mistake.
    #[serde(skip)]
    pub(crate) also: Option<(Range<usize>, String)>,
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

/// Everything that is wrong with one scene, in the order of the file.
#[derive(Clone, Debug)]
pub struct SceneErrors {
    source: Source,
    errors: Vec<SceneError>,
    notes: Vec<String>,
}

impl SceneErrors {
    /// Puts mistakes in the order of the file and gives them line and column.
    pub(crate) fn new(source: Source, mut errors: Vec<SceneError>, notes: Vec<String>) -> Self {
        errors.sort_by_key(|error| error.span.as_ref().map_or(usize::MAX, |span| span.start));
        // What the walk over the text found wrong with a value, the checks need not repeat.
        let walked: BTreeSet<String> =
            errors.iter().filter(|error| error.by_walk).map(|error| error.path.clone()).collect();
        errors.retain(|error| error.by_walk || !walked.contains(&error.path));
        let lines = Lines::new(&source.text);
        for error in &mut errors {
            if let Some(span) = &error.span {
                let (line, column) = lines.place(span.start);
                error.line = Some(line);
                error.column = Some(column);
            }
        }
        drop(lines);
        Self { source, errors, notes }
    }

    /// The mistakes in the order of the file.
    pub fn errors(&self) -> &[SceneError] {
        &self.errors
    }

    /// What the checks noted beside the mistakes.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The scene's name.
    pub fn name(&self) -> &str {
        &self.source.name
    }

    /// The mistakes as plain data for `--json`: line, column, path, message, help.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({ "scene": self.source.name, "errors": self.errors })
    }

    /// The mistakes as text for people; with `color` for terminals, without for files and tests.
    pub fn render(&self, color: bool) -> String {
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        let lines = Lines::new(&self.source.text);
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

    fn report<'a>(&'a self, error: &'a SceneError, lines: &Lines) -> Group<'a> {
        let mut group = Group::with_title(Level::ERROR.primary_title(error.title()));
        if let Some(span) = &error.span {
            let near = error.also.as_ref().filter(|(also, _)| also.start.abs_diff(span.start) < LONGEST_EXCERPT);
            let first = near.map_or(span.start, |(also, _)| also.start.min(span.start));
            let last = near.map_or(span.end, |(also, _)| also.end.max(span.end));
            let (first_line, _) = lines.place(first);
            let (last_line, _) = lines.place(last);
            let window = lines.span(first_line, (last_line + 1).min(lines.count()));
            let window = if window.len() > LONGEST_EXCERPT { lines.span(first_line, last_line) } else { window };
            if window.len() > LONGEST_EXCERPT {
                let origin = Origin::path(&self.source.name)
                    .line(error.line.unwrap_or(1))
                    .char_column(error.column.unwrap_or(1));
                group = group.element(origin);
            } else {
                let shift = |span: &Range<usize>| span.start - window.start..span.end - window.start;
                let mut snippet = Snippet::source(&self.source.text[window.clone()])
                    .path(&self.source.name)
                    .line_start(first_line)
                    .annotation(AnnotationKind::Primary.span(shift(span)).label(&error.label));
                if let Some((also, label)) = near {
                    snippet = snippet.annotation(AnnotationKind::Context.span(shift(also)).label(label));
                }
                group = group.element(snippet);
            }
            if let (Some((also, label)), None) = (&error.also, near) {
                let (line, column) = lines.place(also.start);
                group = group.element(Level::NOTE.message(format!("{label} at {line}:{column}")));
            }
        }
        if let Some(help) = &error.help {
            group = group.element(Level::HELP.message(help));
        }
        group
    }
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneErrors {}
