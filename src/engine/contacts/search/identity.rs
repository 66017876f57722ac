//! Identities of atoms when bodies come and go: the key of the body, and the number within the body.

use super::NEW;
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// Bodies with consecutive keys and equal numbers of atoms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Run {
    key: u64,
    bodies: u32,
    /// Of each body.
    atoms: u32,
    /// Place of the first atom.
    first: u32,
}

/// The atoms of all bodies in canonical order. Keys mostly follow one another, so that is a short list.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Identities(Vec<Run>);

impl Identities {
    pub fn of(bodies: &Bodies) -> Self {
        let mut runs: Vec<Run> = Vec::new();
        for (body, key) in bodies.key.iter().enumerate() {
            let atoms = bodies.atoms_of(body);
            let count = atoms.len() as u32;
            match runs.last_mut() {
                Some(run) if run.key + u64::from(run.bodies) == key && run.atoms == count => run.bodies += 1,
                _ => runs.push(Run { key, bodies: 1, atoms: count, first: atoms.start as u32 }),
            }
        }
        Self(runs)
    }

    /// The place of an atom: key of its body, number within it.
    fn index(&self, key: u64, number: u32) -> Option<u32> {
        let run = self.0.get(self.0.partition_point(|run| run.key <= key).checked_sub(1)?)?;
        let body = key - run.key;
        (body < u64::from(run.bodies) && number < run.atoms).then(|| run.first + body as u32 * run.atoms + number)
    }

    /// For each atom its index among others, or [`NEW`] if it is not among them.
    pub fn indices_in(&self, others: &Self) -> Vec<u32> {
        let of_body = |run: Run, body: u32| (0..run.atoms).map(move |number| (run.key + u64::from(body), number));
        let all = self.0.iter().flat_map(|&run| (0..run.bodies).flat_map(move |body| of_body(run, body)));
        all.map(|(key, number)| others.index(key, number).unwrap_or(NEW)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bodies of these keys, with so many atoms.
    fn bodies(list: &[(u64, u32)]) -> Identities {
        let mut bodies = Bodies { first_atom: vec![0], ..Bodies::default() };
        for &(key, atoms) in list {
            bodies.key.push(key);
            bodies.first_atom.push(bodies.first_atom[bodies.first_atom.len() - 1] + atoms);
        }
        Identities::of(&bodies)
    }

    #[test]
    fn atoms_are_found_again_by_key_and_number() {
        let before = bodies(&[(0, 1), (1, 1), (2, 3), (3, 0), (5, 2), (6, 2), (7, 2)]);
        assert_eq!(before.indices_in(&before), (0..11).collect::<Vec<_>>());
        // Body 1 is gone, 2 has one atom less, 4 is new, 6 is gone.
        let after = bodies(&[(0, 1), (2, 2), (3, 0), (4, 1), (5, 2), (7, 2)]);
        assert_eq!(before.indices_in(&after), [0, NEW, 1, 2, NEW, 4, 5, NEW, NEW, 6, 7]);
    }
}
