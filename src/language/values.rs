//! Kinds of values that sections share beside quantities: bare words, whole numbers, choices of names, ordered maps.

use std::fmt;

use serde::de::{
    self, Deserialize, DeserializeSeed, Deserializer, EnumAccess, MapAccess, SeqAccess, VariantAccess, Visitor,
};

use super::diagnostics::Diagnostics;
use super::outline::{NameKind, Outline};
use super::suggest;

/// A bare word, such as the method `VelocityVerlet`, checked against a list that plugins can extend.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word(pub String);

impl Word {
    /// Reports a word that is not in an open list of words
    /// ([`Registry::add_word`](super::Registry::add_word)), or not available yet. Returns whether it is good.
    pub fn check(&self, outline: &Outline, list: &str, path: &str, report: &mut Diagnostics) -> bool {
        match outline.word(list, &self.0) {
            Some(true) => true,
            Some(false) => {
                let known = outline.words(list).filter(|(_, here)| *here);
                let names: Vec<String> = known.map(|(name, _)| format!("`{name}`")).collect();
                let message = format!("`{}` is not available yet", self.0);
                report.error(path, message).help(format!(
                    "the {} so far are {}",
                    suggest::plural(list),
                    names.join(", ")
                ));
                false
            }
            None => {
                let known = outline.words(list).filter(|(_, here)| *here);
                let names: Vec<&str> = known.map(|(name, _)| name).collect();
                let help = suggest::among(&self.0, names.into_iter(), &suggest::plural(list), '`');
                report.error(path, format!("there is no {list} `{}`", self.0)).help(help);
                false
            }
        }
    }
}

struct Identifier;

impl<'de> DeserializeSeed<'de> for Identifier {
    type Value = String;

    fn deserialize<R: Deserializer<'de>>(self, reader: R) -> Result<String, R::Error> {
        reader.deserialize_identifier(self)
    }
}

impl Visitor<'_> for Identifier {
    type Value = String;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a word without quotes")
    }

    fn visit_str<E: de::Error>(self, word: &str) -> Result<String, E> {
        Ok(word.to_owned())
    }
}

struct WordVisitor;

impl<'de> Visitor<'de> for WordVisitor {
    type Value = Word;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a word without quotes")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, access: A) -> Result<Word, A::Error> {
        let (word, rest) = access.variant_seed(Identifier)?;
        rest.unit_variant()?;
        Ok(Word(word))
    }
}

impl<'de> Deserialize<'de> for Word {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        reader.deserialize_enum("", &[], WordVisitor)
    }
}

/// A whole number that is not negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct WholeNumber(pub u64);

struct WholeVisitor;

impl Visitor<'_> for WholeVisitor {
    type Value = WholeNumber;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a whole number such as `12`")
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<WholeNumber, E> {
        Ok(WholeNumber(value))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<WholeNumber, E> {
        // Whole floats such as 1e6 are whole numbers as far as f64 counts exactly.
        if value >= 0.0 && value <= (1_u64 << 53) as f64 && value.fract() == 0.0 {
            Ok(WholeNumber(value as u64))
        } else {
            Err(E::invalid_value(de::Unexpected::Float(value), &self))
        }
    }
}

impl<'de> Deserialize<'de> for WholeNumber {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        reader.deserialize_any(WholeVisitor)
    }
}

/// A field that is read elsewhere: a list of entries inside a section
/// ([`Registry::add_entry_section`](super::Registry::add_entry_section)).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Elsewhere;

impl<'de> Deserialize<'de> for Elsewhere {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        reader.deserialize_ignored_any(de::IgnoredAny).map(|_| Self)
    }
}

/// A choice of names: one, `"T"`, or several, `["T", "gas_*"]`. `*` stands for any run of characters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Names {
    /// The patterns in the order of the file.
    pub patterns: Vec<String>,
    listed: bool,
}

impl Names {
    /// The choice of everything: `"*"`.
    pub fn all() -> Self {
        Self { patterns: vec!["*".into()], listed: false }
    }

    /// A choice of several.
    pub fn listed(patterns: Vec<String>) -> Self {
        Self { patterns, listed: true }
    }

    /// The places of all names that fit, each once, in canonical order. A pattern that fits nothing is reported.
    pub fn require(&self, kind: NameKind, outline: &Outline, path: &str, report: &mut Diagnostics) -> Vec<usize> {
        if self.patterns.is_empty() {
            let help = format!("write `{path}: [\"*\"]` for all {}", kind.plural());
            report.error(path, format!("must name at least one {}, or `*`", kind.noun())).help(help);
        }
        let mut found = Vec::new();
        for (pattern, path) in self.with_paths(path) {
            found.extend(outline.require_matching(kind, pattern, &path, report));
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Each pattern with its path: `path`, or an item of the list at that path.
    pub fn with_paths(&self, path: &str) -> impl Iterator<Item = (&String, String)> {
        let place = move |index| if self.listed { format!("{path}[{index}]") } else { path.to_owned() };
        self.patterns.iter().enumerate().map(move |(index, pattern)| (pattern, place(index)))
    }

    /// The places of all names that fit, each once, in canonical order.
    pub fn matching(&self, kind: NameKind, outline: &Outline) -> Vec<usize> {
        self.require(kind, outline, "", &mut Diagnostics::new())
    }
}

impl Default for Names {
    fn default() -> Self {
        Self::all()
    }
}

struct NamesVisitor;

impl<'de> Visitor<'de> for NamesVisitor {
    type Value = Names;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a name such as \"ball\" or a list of names such as [\"ball\", \"gas_*\"]")
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<Names, E> {
        Ok(Names { patterns: vec![name.to_owned()], listed: false })
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut names: A) -> Result<Names, A::Error> {
        let mut patterns = Vec::new();
        while let Some(name) = names.next_element()? {
            patterns.push(name);
        }
        Ok(Names { patterns, listed: true })
    }
}

impl<'de> Deserialize<'de> for Names {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        reader.deserialize_any(NamesVisitor)
    }
}

/// A map `{ "name": value }` that keeps the order of the file. A duplicate name is an error.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderedMap<T>(pub Vec<(String, T)>);

impl<T> Default for OrderedMap<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

struct MapVisitor<T>(std::marker::PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for MapVisitor<T> {
    type Value = OrderedMap<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a map `{ \"name\": (..) }`")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<OrderedMap<T>, A::Error> {
        let mut items: Vec<(String, T)> = Vec::new();
        let mut seen = std::collections::BTreeSet::new();
        while let Some(name) = map.next_key::<String>()? {
            if !seen.insert(name.clone()) {
                return Err(de::Error::custom(format!("`{name}` stands here twice")));
            }
            items.push((name, map.next_value()?));
        }
        Ok(OrderedMap(items))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OrderedMap<T> {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        reader.deserialize_map(MapVisitor(std::marker::PhantomData))
    }
}
