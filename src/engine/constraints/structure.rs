//! The structure of the equations of some rows: islands, the blocks of the sparse factor, and the borders. Only the bodies
//! that rows act on decide it.

use super::block_cholesky::BlockCholesky;
use super::borders::Borders;
use super::islands::{IslandLink, Islands, find};
use super::row::{Row, RowKind, RowSide};
use crate::world::Bodies;

/// Marks the side of a row that no force moves.
const NONE: u32 = u32::MAX;

/// A row as far as the structure of the equations depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Ends {
    bodies: [u32; 2],
    held: bool,
}

/// A row among the links of which islands consist.
#[derive(Clone, Copy)]
struct Linked {
    row: usize,
    own: usize,
    other: Option<usize>,
}

impl IslandLink for Linked {
    fn other_body(&self) -> Option<usize> {
        self.other
    }

    fn own_body(&self) -> usize {
        self.own
    }
}

/// The indices of the rows of each island, in increasing order. A row that acts on no body is in none.
pub(super) fn islands(rows: &[Row], bodies: &Bodies) -> Vec<Vec<usize>> {
    let mut links: Vec<Linked> = rows
        .iter()
        .enumerate()
        .filter_map(|(row, of)| {
            let [a, b] = of.sides.map(|side| side.map(|side| side.body));
            Some(Linked { row, own: b.or(a)?, other: b.and(a) })
        })
        .collect();
    let mut islands = Islands::default();
    islands.sort::<_, Linked>(&mut links, &mut [], bodies);
    let same = |a: &Linked, b: &Linked| islands.of(a, bodies) == islands.of(b, bodies);
    let rows_of = |island: &[Linked]| {
        let mut rows: Vec<usize> = island.iter().map(|link| link.row).collect();
        rows.sort_unstable();
        rows
    };
    links.chunk_by(same).map(rows_of).collect()
}

/// The structure of the equations of some rows.
#[derive(Debug, Default)]
pub(super) struct Structure {
    /// The topology for which it was found.
    ends: Vec<Ends>,
    most_dense: usize,
    /// Rows of joints outside the dense islands, in the order of the unknowns of the factor.
    pub sparse: Vec<usize>,
    pub factor: BlockCholesky,
    /// Two rows and the index of their entry.
    pub entries: Vec<(u32, u32, u32)>,
    /// Held contacts beside the factor.
    pub borders: Borders,
    /// Rows of each other island with held contacts.
    pub dense: Vec<Vec<usize>>,
    /// Bodies of sparse rows.
    pub moved: Vec<usize>,
}

impl Structure {
    /// Whether rows have this structure.
    pub fn is_of(&self, rows: &[Row], bodies: &Bodies, most_dense: usize) -> bool {
        self.most_dense == most_dense
            && rows.len() == self.ends.len()
            && rows.iter().zip(&self.ends).all(|(row, e)| ends(row, bodies) == *e)
    }

    /// Islands with held contacts and at most `most_dense` rows of joints are solved densely.
    pub fn find(rows: &[Row], bodies: &Bodies, most_dense: usize) -> Self {
        let ends: Vec<Ends> = rows.iter().map(|row| ends(row, bodies)).collect();
        let mut found = Self { ends, most_dense, ..Self::default() };
        let mut borders = Vec::new();
        for island in islands(rows, bodies) {
            let (held, joints): (Vec<usize>, Vec<usize>) = island.iter().partition(|row| found.ends[**row].held);
            if !held.is_empty() && joints.len() <= most_dense {
                found.dense.push(island);
                continue;
            }
            found.sparse.extend(joints);
            if !held.is_empty() {
                borders.push(held);
            }
        }
        found.sparse.sort_unstable();
        found.find_nodes(bodies);
        found.find_borders(borders, rows, bodies);
        found
    }

    fn find_borders(&mut self, borders: Vec<Vec<usize>>, rows: &[Row], bodies: &Bodies) {
        if borders.is_empty() {
            return;
        }
        let mut unknowns = vec![Vec::new(); bodies.len()];
        for (unknown, &row) in self.sparse.iter().enumerate() {
            let moved = self.ends[row].bodies.into_iter().filter(|body| *body != NONE);
            moved.for_each(|body| unknowns[body as usize].push(unknown));
        }
        borders.into_iter().for_each(|held| self.borders.add(held, rows, &unknowns));
    }

    /// Consecutive rows between the same bodies are a node. Nodes with a body in common have an edge.
    fn find_nodes(&mut self, bodies: &Bodies) {
        let Self { ends, sparse, .. } = self;
        let (mut size, mut owner): (Vec<u32>, Vec<(u32, u32)>) = (Vec::new(), Vec::new());
        let mut nodes_of: Vec<Vec<u32>> = vec![Vec::new(); bodies.len()];
        for (index, &row) in sparse.iter().enumerate() {
            let joins = index > 0 && sparse[index - 1] + 1 == row && ends[sparse[index - 1]] == ends[row];
            if !joins {
                size.push(0);
                let moved = ends[row].bodies.into_iter().filter(|body| *body != NONE);
                moved.for_each(|body| nodes_of[body as usize].push(size.len() as u32 - 1));
            }
            let node = size.len() - 1;
            owner.push((node as u32, size[node]));
            size[node] += 1;
        }
        let mut edges: Vec<(u32, u32)> = nodes_of
            .iter()
            .flat_map(|nodes| {
                nodes.iter().enumerate().flat_map(|(index, a)| nodes[index + 1..].iter().map(|b| (*a, *b)))
            })
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let mut first = vec![0; size.len()];
        for (index, (node, own)) in owner.iter().enumerate() {
            if *own == 0 {
                first[*node as usize] = index;
            }
        }
        self.factor = BlockCholesky::new(size.clone(), edges.iter().copied());
        let within = |node: u32| first[node as usize]..first[node as usize] + size[node as usize] as usize;
        let pairs = (0..size.len() as u32).map(|node| (node, node)).chain(edges);
        for (a, b) in pairs {
            for row in within(a) {
                for column in within(b) {
                    let index = self.factor.entry(owner[row], owner[column]);
                    let index = index.or_else(|| self.factor.entry(owner[column], owner[row]));
                    let index = index.expect("these nodes have an edge");
                    self.entries.push((sparse[row] as u32, sparse[column] as u32, index as u32));
                }
            }
        }
        self.moved = (0..bodies.len()).filter(|body| !nodes_of[*body].is_empty()).collect();
        let nodes = first.iter().map(|index| ends[sparse[*index]].bodies);
        self.factor.watch = has_loop(nodes, bodies.len());
    }
}

/// Whether joints form a loop, found by union-find. Fixed bodies, prescribed bodies and the world count as one body.
fn has_loop(mut joints: impl Iterator<Item = [u32; 2]>, bodies: usize) -> bool {
    let mut root: Vec<u32> = (0..=bodies as u32).collect();
    let closes = |[a, b]: [u32; 2]| {
        let [a, b] = [a, b].map(|body| find(&mut root, body.min(bodies as u32)));
        root[a.max(b) as usize] = a.min(b);
        a == b
    };
    joints.any(closes)
}

fn ends(row: &Row, bodies: &Bodies) -> Ends {
    let body =
        |side: Option<RowSide>| side.filter(|side| bodies.dynamic[side.body]).map_or(NONE, |side| side.body as u32);
    Ends { bodies: row.sides.map(body), held: row.kind == RowKind::Acceleration }
}
