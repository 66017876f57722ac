//! Contacts that act on each other within a tick: those that share a body that moves by forces.

use super::case::Case;
use crate::world::Bodies;

/// Groups cases that share a body that moves by forces, in canonical order.
pub(super) fn islands(cases: &[Case], bodies: &Bodies) -> Vec<Vec<Case>> {
    if cases.is_empty() {
        return Vec::new();
    }
    let mut root: Vec<usize> = (0..bodies.len()).collect();
    fn find(root: &mut [usize], mut body: usize) -> usize {
        while root[body] != body {
            root[body] = root[root[body]];
            body = root[body];
        }
        body
    }
    let joined =
        |case: &Case| case.other_body().filter(|&other| bodies.dynamic[other] && bodies.dynamic[case.end.body]);
    for case in cases {
        if let Some(other) = joined(case) {
            let (a, b) = (find(&mut root, other), find(&mut root, case.end.body));
            root[a.max(b)] = a.min(b);
        }
    }
    let mut sorted: Vec<(usize, Case)> = Vec::with_capacity(cases.len());
    for case in cases {
        let body = if bodies.dynamic[case.end.body] { Some(case.end.body) } else { case.other_body() };
        sorted.push((find(&mut root, body.unwrap_or(case.end.body)), *case));
    }
    sorted.sort_by_key(|(root, _)| *root);
    sorted.chunk_by(|a, b| a.0 == b.0).map(|chunk| chunk.iter().map(|(_, case)| *case).collect()).collect()
}

/// The bodies of an island in canonical order.
pub(super) fn members(island: &[Case]) -> Vec<usize> {
    let mut members: Vec<usize> =
        island.iter().flat_map(|case| [Some(case.end.body), case.other_body()]).flatten().collect();
    members.sort_unstable();
    members.dedup();
    members
}
