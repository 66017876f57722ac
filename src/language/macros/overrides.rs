//! The overrides of an instance (`set`), found by the names that they mean.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::rc::Rc;

use super::emit::Context;
use crate::outline::fits;
use crate::syntax::Id;

/// A value for one field of an instance.
#[derive(Clone)]
pub(super) struct Override {
    /// The owner of the field, without the prefix of the instance; `*` stands for any letters.
    pub(super) target: String,
    pub(super) fields: Vec<String>,
    pub(super) context: Context,
    pub(super) value: Id,
    pub(super) used: Rc<Cell<bool>>,
}

/// An override, and how many of its fields have been followed.
pub(super) type Patch = (Rc<Override>, usize);

/// Overrides in the order of the scene: of two for one field, the last wins.
#[derive(Default)]
pub(super) struct Overrides {
    all: Vec<Rc<Override>>,
    /// The overrides of each whole target, and of each first part before a `/`, unless these hold a `*`.
    by_target: BTreeMap<String, Vec<usize>>,
    by_first: BTreeMap<String, Vec<usize>>,
    /// The overrides whose target holds a `*`.
    patterns: Vec<usize>,
}

impl Overrides {
    pub(super) fn new(all: Vec<Rc<Override>>) -> Self {
        let mut overrides = Self::default();
        for (index, patch) in all.iter().enumerate() {
            if patch.target.contains('*') {
                overrides.patterns.push(index);
                continue;
            }
            if let Some((first, _)) = patch.target.split_once('/') {
                overrides.by_first.entry(first.to_owned()).or_default().push(index);
            }
            overrides.by_target.entry(patch.target.clone()).or_default().push(index);
        }
        Self { all, ..overrides }
    }

    pub(super) fn all(&self) -> &[Rc<Override>] {
        &self.all
    }

    /// The number of targets with a `*`: each is compared with each name.
    pub(super) fn pattern_count(&self) -> usize {
        self.patterns.len()
    }

    /// The overrides of the thing of this name.
    pub(super) fn of(&self, name: &str) -> Vec<Patch> {
        let meant = self.among(&self.by_target, name);
        meant.filter(|patch| fits(&patch.target, name)).map(|patch| (Rc::clone(patch), 0)).collect()
    }

    /// The overrides of the things in the instance of this name, with targets as they are seen from within it.
    pub(super) fn within(&self, name: &str) -> Vec<Rc<Override>> {
        let inherited = self.among(&self.by_first, name).filter_map(|patch| {
            let target = match patch.target.split_once('/') {
                Some((first, rest)) if fits(first, name) => rest.to_owned(),
                None if patch.target == "*" => patch.target.clone(),
                _ => return None,
            };
            Some(Rc::new(Override { target, ..Override::clone(patch) }))
        });
        inherited.collect()
    }

    /// Those of a name in a table, and those of all patterns, in order.
    fn among(&self, table: &BTreeMap<String, Vec<usize>>, name: &str) -> impl Iterator<Item = &Rc<Override>> {
        let mut meant: Vec<usize> = table.get(name).into_iter().chain([&self.patterns]).flatten().copied().collect();
        meant.sort_unstable();
        meant.into_iter().map(|index| &self.all[index])
    }
}

/// The patches of each field or item, one field further.
pub(super) fn by_field(patches: &[Patch]) -> BTreeMap<&str, Vec<Patch>> {
    let mut fields: BTreeMap<&str, Vec<Patch>> = BTreeMap::new();
    for (patch, depth) in patches {
        if let Some(field) = patch.fields.get(*depth) {
            fields.entry(field).or_default().push((Rc::clone(patch), depth + 1));
        }
    }
    fields
}
