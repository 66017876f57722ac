//! Contacts that act on each other within a tick: those that share a body that moves by forces.

use std::ops::Range;

use super::case::Case;
use crate::world::Bodies;

/// Groups cases into islands. What memory it has it keeps for the next tick.
#[derive(Debug, Default)]
pub(super) struct Islands {
    /// For each body that is in a case the first of its island.
    root: Vec<u32>,
    ranges: Vec<Range<usize>>,
}

impl Islands {
    /// Sorts cases so that those that share a body that moves by forces stand together, in canonical order. Returns where each
    /// island stands.
    pub fn sort(&mut self, cases: &mut [Case], bodies: &Bodies) -> &[Range<usize>] {
        self.ranges.clear();
        if cases.is_empty() {
            return &self.ranges;
        }
        self.join(cases, bodies);
        let root = |case: &Case| {
            let body = if bodies.dynamic[case.end.body] { Some(case.end.body) } else { case.other_body() };
            self.root[body.unwrap_or(case.end.body)]
        };
        cases.sort_by_key(root);
        let mut first = 0;
        for island in cases.chunk_by(|a, b| root(a) == root(b)) {
            self.ranges.push(first..first + island.len());
            first += island.len();
        }
        &self.ranges
    }

    /// Lets the root of each body that is in a case be the first body of its island.
    fn join(&mut self, cases: &[Case], bodies: &Bodies) {
        let root = &mut self.root;
        root.resize(bodies.len(), 0);
        let ends = || cases.iter().flat_map(|case| [Some(case.end.body), case.other_body()]).flatten();
        for body in ends() {
            root[body] = body as u32;
        }
        let joined =
            |case: &Case| case.other_body().filter(|&other| bodies.dynamic[other] && bodies.dynamic[case.end.body]);
        for case in cases {
            if let Some(other) = joined(case) {
                let (a, b) = (find(root, other as u32), find(root, case.end.body as u32));
                root[a.max(b) as usize] = a.min(b);
            }
        }
        for body in ends() {
            root[body] = find(root, body as u32);
        }
    }
}

fn find(root: &mut [u32], mut body: u32) -> u32 {
    while root[body as usize] != body {
        root[body as usize] = root[root[body as usize] as usize];
        body = root[body as usize];
    }
    body
}

/// Bodies that are marked. To forget them takes as long as to mark them, however many others there are.
#[derive(Debug, Default)]
pub(super) struct Marked {
    list: Vec<usize>,
    /// For each body whether it is.
    is: Vec<bool>,
}

impl Marked {
    /// Forgets all, among so many bodies.
    pub fn forget(&mut self, bodies: usize) {
        if self.is.len() == bodies {
            self.list.drain(..).for_each(|body| self.is[body] = false);
        } else {
            self.list.clear();
            self.is.clear();
            self.is.resize(bodies, false);
        }
    }

    pub fn mark(&mut self, body: usize) {
        self.is[body] = true;
        self.list.push(body);
    }

    pub fn has(&self, body: usize) -> bool {
        self.is[body]
    }
}

/// The bodies of an island.
#[derive(Debug, Default)]
pub(super) struct Members {
    /// In canonical order.
    pub list: Vec<usize>,
    /// For each body its place in the list and one more; zero for all others.
    place: Vec<u32>,
}

impl Members {
    /// Becomes those of the island of these cases, among so many bodies.
    pub fn collect(&mut self, cases: &[Case], bodies: usize) {
        for &body in &self.list {
            self.place[body] = 0;
        }
        self.list.clear();
        self.place.resize(bodies, 0);
        for body in cases.iter().flat_map(|case| [Some(case.end.body), case.other_body()]).flatten() {
            if self.place[body] == 0 {
                self.place[body] = 1;
                self.list.push(body);
            }
        }
        self.list.sort_unstable();
        for (place, &body) in self.list.iter().enumerate() {
            self.place[body] = place as u32 + 1;
        }
    }

    /// The place of a member behind what does not move by forces, which has the first; that one for all others.
    pub fn place(&self, body: usize) -> usize {
        self.place[body] as usize
    }
}
