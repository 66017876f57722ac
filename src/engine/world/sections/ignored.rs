//! `groups` and `ignores` of bodies: pairs of bodies that do not touch each other.

use std::collections::BTreeMap;

use super::bodies::BodyEntry;
use crate::scene::{Diagnostics, NameKind, Outline, suggest};

/// Pairs of bodies that ignore each other, at most: they take 16 bytes each.
const MOST: usize = 1 << 22;

/// The places of the bodies of each group.
fn groups(bodies: &[BodyEntry]) -> BTreeMap<&str, Vec<usize>> {
    let mut groups: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        body.groups.iter().for_each(|group| groups.entry(group).or_default().push(index));
    }
    groups
}

/// Reports groups to which no body belongs, and too many pairs.
pub(super) fn check(bodies: &[BodyEntry], report: &mut Diagnostics) {
    let groups = groups(bodies);
    let mut count = 0;
    for (index, body) in bodies.iter().enumerate() {
        for (number, ignored) in body.ignores.iter().enumerate() {
            let path = format!("[{index}].ignores[{number}]");
            match groups.get(&**ignored) {
                None => {
                    let help = suggest::among(ignored, groups.keys().copied(), "groups", '"');
                    report.error(&path, format!("no body belongs to a group \"{ignored}\"")).help(help);
                }
                Some(group) if count <= MOST && count + group.len() > MOST => {
                    let message = format!("more than {MOST} pairs of bodies ignore each other");
                    report
                        .error(&path, message)
                        .help("use smaller groups, or give bodies that are to touch nothing `collides: false`");
                    count += group.len();
                }
                Some(group) => count += group.len(),
            }
        }
    }
}

/// The pairs of bodies of which one ignores a group of the other, by their keys.
pub(super) fn pairs(bodies: &[BodyEntry], outline: &Outline) -> Vec<(u64, u64)> {
    let groups = groups(bodies);
    let key = |index: usize| outline.position(NameKind::BODY, &bodies[index].name).map(|index| index as u64);
    let of_body = |(index, body): (usize, &BodyEntry)| {
        let ignored = body.ignores.iter().filter_map(|group| groups.get(&**group)).flatten();
        ignored.filter(|&&other| other != index).filter_map(|&other| Some((key(index)?, key(other)?))).collect()
    };
    bodies.iter().enumerate().flat_map(|each| -> Vec<(u64, u64)> { of_body(each) }).collect()
}
