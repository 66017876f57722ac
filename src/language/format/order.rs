//! The order of sections, which is that of the manual.

use super::parse::{File, Item, Value};

/// Sections in groups. Within a group they keep the author's order, which may be the order of their things.
const ORDER: &[&[&str]] = &[
    &["format"],
    &["title"],
    &["notes"],
    &["params"],
    &["clock"],
    &["film"],
    &["camera"],
    &["look"],
    &["plots"],
    &["gravity"],
    &["materials"],
    &["pairs"],
    &["walls", "bodies", "templates", "instances", "packings", "fill", "joints"],
    &["forces"],
    &["contacts"],
    &["sensors"],
    &["expect"],
];

/// Puts the sections of a scene in order; returns whether anything moved. A section that is not known here, one of a
/// plugin, stays behind the one that it follows.
pub(super) fn sort(file: &mut File) -> bool {
    let Value::Bracket(root) = &mut file.root else { return false };
    if root.name != "Scene" {
        return false;
    }
    let mut before = 0;
    let mut ranked: Vec<(usize, Item)> = Vec::with_capacity(root.items.len());
    for item in std::mem::take(&mut root.items) {
        let known = ORDER.iter().position(|group| group.contains(&item.key));
        before = known.unwrap_or(before);
        ranked.push((before, item));
    }
    let sorted = ranked.is_sorted_by_key(|(rank, _)| *rank);
    ranked.sort_by_key(|(rank, _)| *rank);
    root.items = ranked.into_iter().map(|(_, item)| item).collect();
    !sorted
}
