//! Islands: links that act on each other within a tick, because they share a body that moves by forces. The algorithm
//! is union-find.

use crate::world::Bodies;

/// The bodies of a link between two sides: a contact or a joint. Side A may be absent: the world, or a wall.
pub trait IslandLink {
    /// The body of side A.
    fn other_body(&self) -> Option<usize>;

    /// The body of side B.
    fn own_body(&self) -> usize;
}

/// Does something with the bodies of some links, one after the other.
#[inline]
fn each_end<L: IslandLink>(links: &[L], mut act: impl FnMut(usize)) {
    for link in links {
        act(link.own_body());
        if let Some(other) = link.other_body() {
            act(other);
        }
    }
}

/// Groups links into islands. Its memory is kept for the next tick.
#[derive(Debug, Default)]
pub struct Islands {
    /// For each body of a link the first body of its island.
    root: Vec<u32>,
    /// For each link the first body of its island, and the index of the link.
    order: Vec<(u32, u32)>,
}

impl Islands {
    /// Sorts both lists of links so that links of one island are consecutive, in canonical order. An island is a set of
    /// links of either list that share bodies which move by forces.
    pub fn sort<L: IslandLink, M: IslandLink>(&mut self, links: &mut [L], others: &mut [M], bodies: &Bodies) {
        self.root.resize(bodies.len(), 0);
        let begin = |root: &mut [u32], body: usize| root[body] = body as u32;
        each_end(links, |body| begin(&mut self.root, body));
        each_end(others, |body| begin(&mut self.root, body));
        self.join(links, bodies);
        self.join(others, bodies);
        let settle = |root: &mut [u32], body: usize| root[body] = find(root, body as u32);
        each_end(links, |body| settle(&mut self.root, body));
        each_end(others, |body| settle(&mut self.root, body));
        self.sort_by_root(links, bodies);
        self.sort_by_root(others, bodies);
    }

    /// Sorts small keys and then moves each link once, for links are large.
    fn sort_by_root<L: IslandLink>(&mut self, links: &mut [L], bodies: &Bodies) {
        if links.is_sorted_by_key(|link| self.of(link, bodies)) {
            return;
        }
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        order.extend(links.iter().enumerate().map(|(index, link)| (self.of(link, bodies), index as u32)));
        order.sort_unstable();
        for to in 0..order.len() {
            let mut from = order[to].1 as usize;
            // Earlier exchanges have taken it farther.
            while from < to {
                from = order[from].1 as usize;
            }
            order[to].1 = from as u32;
            links.swap(to, from);
        }
        self.order = order;
    }

    /// The first body of the island of a link that was sorted.
    pub fn of<L: IslandLink>(&self, link: &L, bodies: &Bodies) -> u32 {
        let own = link.own_body();
        let body = if bodies.dynamic[own] { Some(own) } else { link.other_body() };
        self.root[body.unwrap_or(own)]
    }

    /// Joins the islands of both bodies of each link.
    fn join<L: IslandLink>(&mut self, links: &[L], bodies: &Bodies) {
        let root = &mut self.root;
        for link in links {
            let own = link.own_body();
            if let Some(other) = link.other_body().filter(|&other| bodies.dynamic[other] && bodies.dynamic[own]) {
                let (a, b) = (find(root, other as u32), find(root, own as u32));
                root[a.max(b) as usize] = a.min(b);
            }
        }
    }
}

pub(super) fn find(root: &mut [u32], mut body: u32) -> u32 {
    while root[body as usize] != body {
        root[body as usize] = root[root[body as usize] as usize];
        body = root[body as usize];
    }
    body
}

/// Bodies that are marked. To forget them takes as long as to mark them, however many others there are.
#[derive(Debug, Default)]
pub struct Marked {
    list: Vec<usize>,
    /// For each body whether it is a member.
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

    /// Marks a body.
    pub fn mark(&mut self, body: usize) {
        self.is[body] = true;
        self.list.push(body);
    }

    /// Whether a body is marked.
    pub fn has(&self, body: usize) -> bool {
        self.is[body]
    }
}

/// If at least one body in so many belongs to the island, a scan of all bodies beats sorting.
const DENSE: usize = 16;

/// The bodies of an island.
#[derive(Debug, Default)]
pub struct Members {
    /// In canonical order.
    pub list: Vec<usize>,
    /// For each body its index in the list plus one; zero for all others.
    index: Vec<u32>,
}

impl Members {
    /// Becomes those of the island of these links of two kinds, among so many bodies.
    pub fn collect<L: IslandLink, M: IslandLink>(&mut self, links: &[L], others: &[M], bodies: usize) {
        for &body in &self.list {
            self.index[body] = 0;
        }
        self.list.clear();
        self.index.resize(bodies, 0);
        let Self { list, index } = &mut *self;
        let mut collect = |body: usize| {
            if index[body] == 0 {
                index[body] = 1;
                list.push(body);
            }
        };
        each_end(links, &mut collect);
        each_end(others, &mut collect);
        if DENSE * self.list.len() < bodies {
            self.list.sort_unstable();
        } else {
            self.list.clear();
            self.list.extend((0..bodies).filter(|&body| self.index[body] != 0));
        }
        for (index, &body) in self.list.iter().enumerate() {
            self.index[body] = index as u32 + 1;
        }
    }

    /// The index of a member, counted from one. All bodies that are not members have index zero.
    pub fn index(&self, body: usize) -> usize {
        self.index[body] as usize
    }
}
