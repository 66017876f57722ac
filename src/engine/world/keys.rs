//! The keys of the bodies, in ascending order.

use serde::{Deserialize, Serialize};
/// Keys in ascending order. Most follow the one before, so only those that do not are listed.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Keys {
    /// Place and key of the first of each run.
    runs: Vec<(usize, u64)>,
    len: usize,
}

impl Keys {
    /// Adds a key that is greater than all others.
    pub(crate) fn push(&mut self, key: u64) {
        let follows = |&(first, begin): &(usize, u64)| begin.checked_add((self.len - first) as u64) == Some(key);
        if !self.runs.last().is_some_and(follows) {
            self.runs.push((self.len, key));
        }
        self.len += 1;
    }

    /// The key at a place.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn at(&self, index: usize) -> u64 {
        assert!(index < self.len, "no key {index} among {}", self.len);
        let (first, key) = self.runs[self.runs.partition_point(|&(first, _)| first <= index) - 1];
        key + (index - first) as u64
    }

    /// The number of them.
    pub(crate) fn count(&self) -> usize {
        self.len
    }

    /// The index of a key, or `None`.
    pub fn find(&self, key: u64) -> Option<usize> {
        let run = self.runs.partition_point(|&(_, begin)| begin <= key).checked_sub(1)?;
        let (first, begin) = self.runs[run];
        let end = self.runs.get(run + 1).map_or(self.len, |&(next, _)| next);
        usize::try_from(key - begin).ok().map(|further| first + further).filter(|&index| index < end)
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = u64> {
        let ends = self.runs[1.min(self.runs.len())..].iter().map(|&(next, _)| next).chain([self.len]);
        self.runs
            .iter()
            .zip(ends)
            .flat_map(|(&(first, key), end)| (0..end - first).map(move |further| key + further as u64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_where_they_were_put() {
        let listed = [0, 1, 2, 5, 7, 8, u64::MAX];
        let mut keys = Keys::default();
        assert_eq!((keys.iter().next(), keys.find(0)), (None, None));
        listed.into_iter().for_each(|key| keys.push(key));
        assert_eq!(keys.iter().collect::<Vec<_>>(), listed);
        assert_eq!(keys.runs.len(), 4);
        for key in (0..12).chain([u64::MAX - 1, u64::MAX]) {
            assert_eq!(keys.find(key), listed.iter().position(|&listed| listed == key), "{key}");
        }
        assert_eq!((0..listed.len()).map(|index| keys.at(index)).collect::<Vec<_>>(), listed);
    }
}
