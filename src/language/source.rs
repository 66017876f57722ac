//! The text of a scene, and the line and column of a byte.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::error::{SceneError, SceneErrors};
use super::lexer::{Lexed, lex};
use super::suggest::nearest;
use super::syntax::{Form, Tree};

/// The largest scene the reader takes, in bytes (64 MiB).
///
/// A hundred thousand atoms written out need about 6 MiB. A file beyond this limit is most likely not a scene.
pub const LARGEST_SCENE: usize = 64 << 20;

/// A scene's text together with the name under which messages speak of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    /// The file name, or any name for a text that is in no file.
    pub name: String,
    /// The text.
    pub text: String,
    /// The folder of the files that the scene includes. `None` for a text without a file.
    pub folder: Option<PathBuf>,
    /// Parameters whose values replace those of the scene: name, and number or expression.
    pub settings: Vec<(String, String)>,
    /// Whether the scene may name files anywhere. Otherwise they lie in its folder, below it, or in a folder above it.
    pub outside: bool,
}

impl Source {
    /// A scene's text that is already in memory.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), ..Self::default() }
    }

    /// Gives parameters of the scene (`params`) other values: pairs of a name, and a number or expression.
    #[must_use]
    pub fn with_settings(mut self, settings: &[(String, String)]) -> Self {
        self.settings.extend_from_slice(settings);
        self
    }

    /// Reads a scene file.
    ///
    /// # Errors
    /// An error if the file is absent, a folder, unreadable, larger than [`LARGEST_SCENE`], empty or not UTF-8 text.
    /// The message says what to do.
    pub fn read(path: &Path) -> Result<Self, SceneErrors> {
        let name = path.display().to_string();
        let fail = |message: String, help: &str| {
            let error = SceneError::new("", message).with_help(help);
            SceneErrors::new(Source::new(name.clone(), ""), vec![error], Vec::new())
        };
        let details = match std::fs::metadata(path) {
            Ok(details) => details,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Err(fail(format!("there is no file `{name}`"), "check the spelling and the folder you are in"));
            }
            Err(error) => {
                return Err(fail(format!("cannot read `{name}`: {error}"), "check the path and its permissions"));
            }
        };
        if details.is_dir() {
            return Err(fail(format!("`{name}` is a folder"), "name a scene file, such as `scenes/first.ron`"));
        }
        let too_large = |length: u64| {
            let (found, most) = (length >> 20, LARGEST_SCENE as u64 >> 20);
            // Of devices no more is read than shows that they are too large.
            let found = if found > most { format!("{found} MiB, ") } else { String::new() };
            fail(
                format!("`{name}` is too large for a scene: {found}the limit is {most} MiB"),
                "check that it is a scene; many bodies are shorter with `fill`",
            )
        };
        if details.len() > LARGEST_SCENE as u64 {
            return Err(too_large(details.len()));
        }
        let bytes = match read_at_most(path, LARGEST_SCENE + 1) {
            Ok(bytes) => bytes,
            Err(error) => {
                return Err(fail(format!("cannot read `{name}`: {error}"), "check the path and its permissions"));
            }
        };
        // A pipe has no length beforehand.
        if bytes.len() > LARGEST_SCENE {
            return Err(too_large(bytes.len() as u64));
        }
        let folder = path.parent().map(Path::to_owned);
        let source = Self::from_bytes(&name, bytes).map_err(|(message, help)| fail(message, help))?;
        Ok(Self { folder, ..source })
    }

    /// The kind of the text if it is not a scene that can run by itself. It may have another name, or be a part for
    /// other scenes to include. `None` for a scene, right or wrong.
    pub fn other_than_scene(&self) -> Option<String> {
        let Lexed { tree, fault, .. } = lex(&self.text);
        if tree.is_empty() {
            return None;
        }
        let name = tree.name(0, &self.text);
        if name == "Scene" {
            return (fault.is_none() && self.is_part(&tree)).then(|| "a part without a `clock`".to_owned());
        }
        // A scene that lost its name.
        if name.is_empty() && tree.node(0).form == Form::Round {
            return None;
        }
        // A misspelt `Scene` counts as a wrong scene.
        nearest(name, ["Scene"].into_iter()).is_none().then(|| tree.describe(0, &self.text))
    }

    /// Whether a scene without mistakes of syntax is a part for other scenes to include. A part has things to bring,
    /// and the format of this program if it has any. It has no `clock`, and no section that may be a misspelt one.
    fn is_part(&self, tree: &Tree) -> bool {
        let sections = || tree.children(0).iter().map(|&id| (&self.text[tree.key(id)], id));
        let clock = sections().any(|(name, _)| nearest(name, ["clock", "look"].into_iter()) == Some("clock"));
        let format =
            sections().find(|(name, _)| *name == "format").is_none_or(|(_, id)| &self.text[tree.span(id)] == "1");
        let brings = sections().any(|(_, id)| matches!(tree.node(id).form, Form::List | Form::Braces));
        brings && format && !clock
    }

    /// The whole text after includes, templates and repetitions; empty if it cannot be made.
    pub fn made<A>(&self, registry: &super::Registry<A>) -> String {
        super::macros::made(self, &registry.embeddings)
            .into_iter()
            .flatten()
            .map(|(name, text)| format!("{name}: {text},\n"))
            .collect()
    }

    /// Takes a file's bytes as UTF-8 text, without the mark some editors put in front.
    fn from_bytes(name: &str, bytes: Vec<u8>) -> Result<Self, (String, &'static str)> {
        if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
            return Err((format!("`{name}` is UTF-16 text, not UTF-8"), "save it as UTF-8 in your editor"));
        }
        if let Some(index) = bytes.iter().position(|&byte| byte == 0) {
            return Err((
                format!("`{name}` is not a text file: a zero byte at position {index}"),
                "a scene is a text file in RON; check that this is the right file",
            ));
        }
        let text = match String::from_utf8(bytes) {
            Ok(text) => text,
            Err(error) => {
                let good = error.utf8_error().valid_up_to();
                let line = 1 + error.as_bytes()[..good].iter().filter(|&&byte| byte == b'\n').count();
                return Err((
                    format!("`{name}` is not UTF-8 text: the first bad byte is on line {line}"),
                    "save it as UTF-8 in your editor, or check that it is a text file",
                ));
            }
        };
        let text = match text.strip_prefix('\u{feff}') {
            Some(rest) => rest.to_owned(),
            None => text,
        };
        Ok(Self::new(name, text))
    }
}

fn read_at_most(path: &Path, limit: usize) -> std::io::Result<Vec<u8>> {
    use std::io::Read;
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(limit as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The first byte of each line of a text, so that many bytes can be turned into line and column.
pub(crate) struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(index, _)| index + 1)).collect();
        Self { text, starts }
    }

    /// Line and column, both from one; the column counts characters.
    pub(crate) fn place(&self, offset: usize) -> (usize, usize) {
        let line = self.starts.partition_point(|&start| start <= offset).max(1);
        let start = self.starts[line - 1];
        let column = self.text.get(start..offset).map_or(1, |before| before.chars().count() + 1);
        (line, column)
    }

    /// The bytes of the lines from `first` to `last` (counted from one), without the last line's end.
    pub(crate) fn span(&self, first: usize, last: usize) -> Range<usize> {
        let start = self.starts.get(first.saturating_sub(1)).copied().unwrap_or(self.text.len());
        let end = self.starts.get(last).map_or(self.text.len(), |&next| next - 1);
        start..end.max(start)
    }

    /// The number of lines.
    pub(crate) fn count(&self) -> usize {
        self.starts.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(bytes: &[u8]) -> String {
        match Source::from_bytes("a.ron", bytes.to_vec()) {
            Ok(source) => panic!("read as {source:?}"),
            Err((message, _)) => message,
        }
    }

    #[test]
    fn places_count_characters_from_one() {
        let lines = Lines::new("ä b\nc");
        assert_eq!(lines.place(0), (1, 1));
        assert_eq!(lines.place(3), (1, 3));
        assert_eq!(lines.place(5), (2, 1));
        assert_eq!(lines.place(6), (2, 2));
        assert_eq!(lines.span(1, 1), 0..4);
        assert_eq!(lines.span(2, 9), 5..6);
    }

    #[test]
    fn what_is_no_text_is_named() {
        assert_eq!(refused(b"\xff\xfeS\0"), "`a.ron` is UTF-16 text, not UTF-8");
        assert_eq!(refused(b"GIF89a\0"), "`a.ron` is not a text file: a zero byte at position 6");
        assert_eq!(refused(b"Scene(\n\xe4)"), "`a.ron` is not UTF-8 text: the first bad byte is on line 2");
        assert_eq!(Source::from_bytes("a", b"\xef\xbb\xbfx".to_vec()).map(|source| source.text), Ok("x".into()));
    }

    #[test]
    fn what_is_no_scene_is_told_from_wrong_ones() {
        let other = |text: &str| Source::new("a.ron", text).other_than_scene();
        assert_eq!(other("Theme(ink: \"black\")").as_deref(), Some("`Theme(..)`"));
        assert_eq!(other("Scene(format: 1, bodies: [])").as_deref(), Some("a part without a `clock`"));
        assert_eq!(other("Scene(templates: {})").as_deref(), Some("a part without a `clock`"));
        for scene in [
            "",
            "Scene(clock: (duration: 1))",
            "Scene(clock: (",
            "scene(format: 1)",
            "Sceen(",
            // Slips, which must not keep a user from looking at the scene.
            "Scene(format: 1, clok: (duration: 1), bodies: [])",
            "Scene(format: 1, Clock: (duration: 1), bodies: [])",
            "Scene(format: 2)",
            "Scene(format: 2, bodies: [])",
            "Scene(format: 1)",
            "Scene(format: 1, bodies: [)",
            "(format: 1, clock: (duration: 1), bodies: [])",
        ] {
            assert_eq!(other(scene), None, "{scene}");
        }
    }

    #[test]
    fn missing_files_and_folders_are_named() {
        let missing = Source::read(Path::new("no/such.ron")).map_err(|errors| errors.to_string());
        assert_eq!(
            missing,
            Err("error: there is no file `no/such.ron`\n |\n = help: check the spelling and the folder you are in\n"
                .into())
        );
        let folder = Source::read(Path::new(".")).map_err(|errors| errors.errors()[0].message.clone());
        assert_eq!(folder, Err("`.` is a folder".into()));
    }
}
