//! The bodies on which a force acts.

use crate::scene::values::Names;
use crate::scene::{Diagnostics, NameKind, Outline};
use crate::world::Bodies;

/// Reports names of a force's `of` that fit no body.
pub fn check_targets(of: Option<&Names>, outline: &Outline, report: &mut Diagnostics) {
    if let Some(names) = of {
        names.require(NameKind::BODY, outline, "of", report);
    }
}

/// All dynamic bodies, or those with given keys, in order. Indices are looked up again when bodies come or go.
#[derive(Clone, Debug, Default)]
pub struct Targets {
    keys: Option<Vec<u64>>,
    generation: u64,
    indices: Vec<u32>,
}

impl Targets {
    /// The bodies with these keys; `None`: all. Fixed bodies are left out.
    pub fn new(mut keys: Option<Vec<u64>>) -> Self {
        if let Some(keys) = &mut keys {
            keys.sort_unstable();
            keys.dedup();
        }
        Self { keys, ..Self::default() }
    }

    /// The bodies that fit; `None`: all. The keys of a scene's bodies are their places in the outline.
    pub fn named(of: Option<&Names>, outline: &Outline) -> Self {
        let keys =
            |names: &Names| names.matching(NameKind::BODY, outline).into_iter().map(|body| body as u64).collect();
        Self::new(of.map(keys))
    }

    /// Whether the body of a key is among them.
    pub fn include(&self, key: u64) -> bool {
        self.keys.as_ref().is_none_or(|keys| keys.binary_search(&key).is_ok())
    }

    /// Places of the bodies in canonical order, which is that of their keys.
    pub fn indices(&mut self, bodies: &Bodies) -> impl Iterator<Item = usize> + '_ {
        if self.generation != bodies.generation {
            self.generation = bodies.generation;
            let all = 0..if self.keys.is_none() { bodies.len() } else { 0 };
            let named = self.keys.iter().flatten().filter_map(|&key| bodies.key.find(key));
            self.indices = all.chain(named).filter(|&b| bodies.dynamic[b]).map(|b| b as u32).collect();
        }
        self.indices.iter().map(|&index| index as usize)
    }
}
