//! The names that a scene declares, in their order, and the search for a misspelt name. They are known before the world
//! is built.

use std::any::Any;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;

use super::diagnostics::{Diagnostic, Diagnostics, PatternCost};
use super::hidden::is_hidden;
use super::macros::Tables;
use super::name_series::{self, Names};
use super::suggest;

/// Longer names, in bytes, are no names.
const LONGEST_NAME: usize = 1000;
/// Similar names are searched for this many mistakes.
const MOST_EXPLAINED: usize = 30;

/// The kind of thing that a name denotes. Plugins may add kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NameKind {
    noun: &'static str,
    shared: bool,
}

impl NameKind {
    /// Bodies, those of `fill` and `packings` included.
    pub const BODY: Self = Self::new("body");
    /// Walls.
    pub const WALL: Self = Self::new("wall");
    /// Joints.
    pub const JOINT: Self = Self::new("joint");
    /// Sensors.
    pub const SENSOR: Self = Self::new("sensor");
    /// Materials. A material may have the name of a body.
    pub const MATERIAL: Self = Self::apart("material");

    /// A kind whose names must differ from those of bodies, walls, joints and sensors. `noun` is a singular word for
    /// messages.
    pub const fn new(noun: &'static str) -> Self {
        Self { noun, shared: true }
    }

    /// A kind with a separate set of names, which may equal names of other kinds.
    pub const fn apart(noun: &'static str) -> Self {
        Self { noun, shared: false }
    }

    /// The word for one of this kind, such as `body`.
    pub const fn noun(self) -> &'static str {
        self.noun
    }

    pub(crate) fn plural(self) -> Cow<'static, str> {
        match self.noun.strip_suffix('y') {
            Some(stem) => format!("{stem}ies").into(),
            None => format!("{}s", self.noun).into(),
        }
    }
}

/// One entry of a section that takes several kinds, as the author wrote it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mention {
    /// The leading name, such as `Drag`.
    pub name: String,
    /// The path, such as `forces[0]`.
    pub path: String,
    /// Its text.
    pub text: String,
}

/// A place that is taken at the start of the run, so that `fill` puts nothing there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Obstacle {
    /// A disc.
    Disc {
        /// Its centre, in m.
        center: DVec2,
        /// Its radius, in m.
        radius: f64,
    },
    /// The strip with round ends about the line between two points.
    Strip {
        /// One end of its middle line, in m.
        from: DVec2,
        /// The other end, in m.
        to: DVec2,
        /// Half its thickness, in m.
        radius: f64,
    },
    /// The half-plane behind the line through two points.
    Wall {
        /// Seen from the open side, the left point, in m.
        left: DVec2,
        /// Seen from the open side, the right point, in m.
        right: DVec2,
    },
}

/// Open lists of words; each word with whether it is available yet.
pub(crate) type Words = BTreeMap<&'static str, BTreeMap<&'static str, bool>>;

/// The names of a scene by kind, and its sections and entries. Their order is that of the file, which is the canonical
/// order.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    kinds: BTreeMap<NameKind, Names>,
    sections: Vec<(String, bool)>,
    entries: BTreeMap<String, Vec<Mention>>,
    words: Words,
    obstacles: Vec<Obstacle>,
    tables: Tables,
    /// The prefix of relative paths.
    pub(crate) scope: String,
    /// Whether every section could be read. If not, names may be missing, so unknown ones are not reported.
    pub(crate) complete: bool,
    pub(crate) report: Diagnostics,
}

impl Outline {
    /// An outline without names, for tests of a section on its own.
    pub fn new() -> Self {
        Self { complete: true, ..Self::default() }
    }

    /// Adds a name. `path` is its place relative to the section or entry, such as `"[3].name"`. A name is reported if
    /// it is taken, is empty, or holds one of `* . , "` or a hidden character. Returns whether the name is good.
    pub fn declare(&mut self, kind: NameKind, name: &str, path: &str) -> bool {
        let path = join(&self.scope, path);
        let good = self.is_good(kind, name, &path);
        // A name that is refused for its letters is known all the same: its uses are no further mistakes.
        let known = |(_, names): (NameKind, &Names)| names.find(name).is_some();
        if good || !name.is_empty() && !self.rivals(kind).any(known) {
            self.kinds.entry(kind).or_default().add(name, path);
        }
        good
    }

    /// Adds `count` names that begin alike: `gas_0`, `gas_1` and so on for `gas`. The first bad name is reported as by
    /// [`Outline::declare`], and it ends the series. Returns whether all are good.
    pub fn declare_series(&mut self, kind: NameKind, prefix: &str, count: u64, path: &str) -> bool {
        let path = join(&self.scope, path);
        let taken = self.rivals(kind).filter_map(|(_, names)| names.first_taken(prefix, count)).min();
        // All are made of the same letters and digits.
        let odd = (count > 0 && !self.is_good(kind, &name_series::of_series(prefix, 0), &path)).then_some(0);
        let good = odd.or(taken).unwrap_or(count);
        if odd.is_none() && good < count {
            self.is_good(kind, &name_series::of_series(prefix, good), &path);
        }
        self.kinds.entry(kind).or_default().add_series(prefix, good, path);
        good == count
    }

    /// Reports a mistake in a declaration. `path` is counted from the section or entry.
    pub fn refuse(&mut self, path: &str, message: impl Into<String>) -> &mut Diagnostic {
        let path = join(&self.scope, path);
        self.report.error_at(path, message.into())
    }

    /// Whether a name may be added; if not, that is reported.
    fn is_good(&mut self, kind: NameKind, name: &str, path: &str) -> bool {
        if name.is_empty() {
            self.report.error_at(path.to_owned(), "a name must not be empty".into());
            return false;
        }
        if name.len() > LONGEST_NAME {
            let message = format!("a name of {} bytes is too long: {LONGEST_NAME} are allowed", name.len());
            self.report.error_at(path.to_owned(), message).help("give it a name that people can read");
            return false;
        }
        if let Some(bad) =
            name.chars().find(|&c| matches!(c, '*' | '.' | ',' | '"') || c == '\n' || c == '\t' || is_hidden(c))
        {
            let why = match bad {
                '*' => "`*` stands for any letters where bodies are chosen",
                '.' => "`.` separates a name from its quantity, as in `ball.position.x`",
                ',' | '"' => "names become column headers of the CSV file",
                _ => "people must be able to read a name and to write it",
            };
            let message = format!("the name \"{name}\" must not contain {bad:?}");
            self.report.error_at(path.to_owned(), message).help(format!("{why}; use letters, digits and `_`"));
            return false;
        }
        let taken = self.rivals(kind).find_map(|(other, names)| Some((other, names.find(name)?.1.to_owned())));
        if let Some((other, first)) = taken {
            let which = if other == kind { "another" } else { "a" };
            let message = format!("the name \"{name}\" is taken by {which} {}", other.noun);
            let label = format!("this {} has the name too", other.noun);
            self.report.error_at(path.to_owned(), message).also(first, label).help("give every thing its own name");
            return false;
        }
        true
    }

    /// The kinds whose names must differ from those of a kind.
    fn rivals(&self, kind: NameKind) -> impl Iterator<Item = (NameKind, &Names)> {
        let rival = move |other: NameKind| other == kind || (kind.shared && other.shared);
        self.kinds.iter().map(|(other, names)| (*other, names)).filter(move |(other, _)| rival(*other))
    }

    /// Marks a place as taken at the start of the run.
    pub fn occupy(&mut self, obstacle: Obstacle) {
        self.obstacles.push(obstacle);
    }

    /// The places that are taken at the start of the run.
    pub fn obstacles(&self) -> &[Obstacle] {
        &self.obstacles
    }

    /// All names of a kind in canonical order. The list is made when it is asked for first, and kept.
    pub fn names(&self, kind: NameKind) -> &[String] {
        self.kinds.get(&kind).map_or(&[], Names::list)
    }

    /// The number of names of a kind.
    pub fn count(&self, kind: NameKind) -> usize {
        self.kinds.get(&kind).map_or(0, Names::len)
    }

    /// The place of a name in the canonical order of its kind.
    pub fn position(&self, kind: NameKind, name: &str) -> Option<usize> {
        self.kinds.get(&kind)?.find(name).map(|(position, _)| position)
    }

    /// The indices of all names that fit a pattern, in canonical order. `*` stands for any run of characters, also an
    /// empty one. A pattern without `*` fits the one name that it spells.
    pub fn matching(&self, kind: NameKind, pattern: &str) -> Vec<usize> {
        if !pattern.contains('*') {
            return self.position(kind, pattern).into_iter().collect();
        }
        self.kinds.get(&kind).map_or_else(Vec::new, |names| names.matching(pattern))
    }

    /// The place of a name; an unknown one is reported at `path` with the nearest known name.
    pub fn require(&self, kind: NameKind, name: &str, path: &str, report: &mut Diagnostics) -> Option<usize> {
        let found = self.position(kind, name);
        if found.is_none() {
            self.report_unknown(&[kind], name, path, report);
        }
        found
    }

    /// Whether the name belongs to one of these kinds. An unknown name is reported at `path`.
    pub fn require_any(&self, kinds: &[NameKind], name: &str, path: &str, report: &mut Diagnostics) -> bool {
        let found = kinds.iter().any(|&kind| self.position(kind, name).is_some());
        if !found {
            self.report_unknown(kinds, name, path, report);
        }
        found
    }

    /// The indices of all names that fit a pattern. If no name fits, the pattern is reported at `path`.
    pub fn require_matching(&self, kind: NameKind, pattern: &str, path: &str, report: &mut Diagnostics) -> Vec<usize> {
        let Some(found) = self.affordable(kind, pattern, path, report) else { return Vec::new() };
        if found.is_empty() {
            self.report_unknown(&[kind], pattern, path, report);
        }
        found
    }

    /// The indices of all names that fit a pattern. `None`: the patterns of the scene cost too much, which is reported once.
    pub fn affordable(
        &self,
        kind: NameKind,
        pattern: &str,
        path: &str,
        report: &mut Diagnostics,
    ) -> Option<Vec<usize>> {
        let parts = pattern.matches('*').count();
        let may = report.may_cost(path, PatternCost::Names, 0)
            && report.may_cost(path, PatternCost::Comparisons, parts * self.count(kind));
        let found = may.then(|| self.matching(kind, pattern))?;
        report.may_cost(path, PatternCost::Names, found.len()).then_some(found)
    }

    fn report_unknown(&self, kinds: &[NameKind], name: &str, path: &str, report: &mut Diagnostics) {
        if !self.complete {
            return;
        }
        let noun = kinds.iter().map(|kind| kind.noun).collect::<Vec<_>>().join(" or ");
        let plural = kinds.iter().map(|kind| kind.plural()).collect::<Vec<_>>().join(" and ");
        if report.problems().len() > MOST_EXPLAINED {
            let message = format!("there is no {noun} of the name or choice \"{name}\"");
            report.error(path, message);
            return;
        }
        let message = if kinds.iter().any(|&kind| !self.matching(kind, name).is_empty()) {
            format!("expected the name of one {noun}, found the choice \"{name}\"")
        } else if name.contains('*') {
            format!("no {noun} has a name that fits \"{name}\"")
        } else {
            format!("there is no {noun} named \"{name}\"")
        };
        let names: Vec<&str> = kinds.iter().flat_map(|&kind| self.names(kind)).map(String::as_str).collect();
        let help = if names.is_empty() {
            format!("this scene has no {plural}: add one of that name, or remove this")
        } else {
            suggest::among(name, names.into_iter(), &plural, '"')
        };
        report.error(path, message).help(help);
    }

    /// Whether the scene has the section, even as `None`.
    pub fn has_section(&self, name: &str) -> bool {
        self.sections.iter().any(|(section, _)| section == name)
    }

    /// Whether the section stands in the scene as `None`.
    pub fn is_none(&self, name: &str) -> bool {
        self.sections.iter().any(|(section, none)| section == name && *none)
    }

    /// The sections in the order of the file.
    pub fn sections(&self) -> impl Iterator<Item = &str> {
        self.sections.iter().map(|(name, _)| name.as_str())
    }

    /// The entries of a section that takes several kinds, in the order of the file.
    pub fn entries(&self, section: &str) -> &[Mention] {
        self.entries.get(section).map_or(&[], Vec::as_slice)
    }

    /// Whether a word of an open list (such as `"method"`) is available, or only reserved. `None` means that the list
    /// has no such word.
    pub fn word(&self, list: &str, word: &str) -> Option<bool> {
        self.words.get(list)?.get(word).copied()
    }

    /// Whether all sections could be read: otherwise names may be missing.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// The words of an open list in the order of the alphabet, each with whether it is available yet.
    pub fn words(&self, list: &str) -> impl Iterator<Item = (&'static str, bool)> {
        self.words.get(list).into_iter().flatten().map(|(word, here)| (*word, *here))
    }

    pub(super) fn with(words: Words, tables: Tables) -> Self {
        Self { words, tables, ..Self::default() }
    }

    /// The content of a file beside the scene, by its key.
    pub fn embedded<T: Any + Send + Sync>(&self, key: u64) -> Option<Arc<T>> {
        Arc::clone(self.tables.get(&key)?).downcast().ok()
    }

    /// Lets go what only the building of the scene needs.
    pub(super) fn forget_places(&mut self) {
        (self.obstacles, self.tables) = Default::default();
    }

    pub(crate) fn add_section(&mut self, name: &str, none: bool) {
        self.sections.push((name.to_owned(), none));
    }

    pub(crate) fn add_entry(&mut self, section: &str, mention: Mention) {
        self.entries.entry(section.to_owned()).or_default().push(mention);
    }
}

/// Puts a relative path behind a scope: `forces[0]` and `of` give `forces[0].of`, `bodies` and `[1]` give `bodies[1]`.
pub(crate) fn join(scope: &str, path: &str) -> String {
    if path.is_empty() {
        scope.to_owned()
    } else if scope.is_empty() || path.starts_with('[') {
        format!("{scope}{path}")
    } else {
        format!("{scope}.{path}")
    }
}

/// Whether a name fits a pattern in which `*` stands for any run of characters.
pub fn fits(pattern: &str, name: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = parts.next().and_then(|first| name.strip_prefix(first)) else { return false };
    let mut parts = parts.peekable();
    if parts.peek().is_none() {
        return rest.is_empty();
    }
    while let Some(part) = parts.next() {
        if parts.peek().is_none() {
            return rest.ends_with(part);
        }
        match rest.find(part) {
            Some(index) => rest = &rest[index + part.len()..],
            None => return false,
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_any_run() {
        for (pattern, name, expected) in [
            ("gas_*", "gas_0", true),
            ("gas_*", "gas_", true),
            ("*", "", true),
            ("*_1*", "gas_10", true),
            ("a*a", "a", false),
            ("a*b*c", "aXbYc", true),
            ("a*b*c", "aXcYb", false),
            ("gas", "gas_0", false),
        ] {
            assert_eq!(fits(pattern, name), expected, "{pattern} {name}");
        }
    }

    #[test]
    fn order_of_declaration_is_the_order() {
        let mut outline = Outline::new();
        for name in ["z", "a", "gas_1", "gas_0"] {
            outline.declare(NameKind::BODY, name, "");
        }
        outline.declare(NameKind::MATERIAL, "z", "");
        assert_eq!(outline.position(NameKind::BODY, "a"), Some(1));
        assert_eq!(outline.matching(NameKind::BODY, "gas_*"), [2, 3]);
        assert_eq!(outline.position(NameKind::WALL, "a"), None);
        assert!(outline.report.is_clean());
        outline.declare(NameKind::WALL, "a", "");
        assert!(!outline.report.is_clean());
    }
}
