//! Sparse Cholesky factorisation of symmetric matrices of small blocks.
//!
//! Blocks are eliminated in the order of minimum degree (Tinney and Walker 1967; George and Liu 1989), leaves first. So
//! a tree of joints has no fill, and its factors take a time linear in its size (Baraff 1996). The structure is found
//! once per topology. Ties go to the lower index, so that the order is a function of the structure alone.

use std::collections::BTreeSet;

/// A block below the diagonal of a column.
#[derive(Clone, Copy, Debug)]
struct Below {
    /// Its node.
    node: u32,
    /// The index of its first number. Numbers run row by row: its node gives the rows, and that of the column the
    /// columns.
    at: u32,
}

/// The structure and the numbers of a factor.
#[derive(Debug, Default)]
pub struct BlockCholesky {
    /// Number of unknowns of each node, and where those begin.
    size: Vec<u32>,
    first: Vec<u32>,
    /// Nodes in the order of elimination.
    order: Vec<u32>,
    /// The index of the first number of each node's diagonal block.
    diagonal: Vec<u32>,
    /// The blocks below the diagonal of the column of each node, in the order of elimination.
    below: Vec<Vec<Below>>,
    /// For each node: the targets of the products of two blocks of its column, pair by pair.
    targets: Vec<Vec<u32>>,
    numbers: Vec<f64>,
    /// Diagonal before elimination.
    whole: Vec<f64>,
    /// Whether the least pivot is looked for, and what share of its number before elimination it was.
    pub watch: bool,
    pub least_pivot: f64,
}

/// A pivot that is less than this share of its number before elimination counts as zero.
const DEPENDENT: f64 = 1e-9;

impl BlockCholesky {
    /// The structure for nodes of these sizes, of which those in `edges` have blocks in common.
    pub fn new(size: Vec<u32>, edges: impl Iterator<Item = (u32, u32)>) -> Self {
        let count = size.len();
        let mut near = vec![BTreeSet::new(); count];
        for (a, b) in edges.filter(|(a, b)| a != b) {
            near[a as usize].insert(b);
            near[b as usize].insert(a);
        }
        let mut queue: BTreeSet<(usize, u32)> = (0..count).map(|node| (near[node].len(), node as u32)).collect();
        let (mut order, mut left): (Vec<u32>, Vec<Vec<u32>>) = (Vec::new(), vec![Vec::new(); count]);
        while let Some((_, node)) = queue.pop_first() {
            order.push(node);
            let around: Vec<u32> = std::mem::take(&mut near[node as usize]).into_iter().collect();
            for &other in &around {
                queue.remove(&(near[other as usize].len(), other));
                near[other as usize].remove(&node);
                near[other as usize].extend(around.iter().filter(|third| **third != other));
                queue.insert((near[other as usize].len(), other));
            }
            left[node as usize] = around;
        }
        Self::of_columns(size, order, left)
    }

    fn of_columns(size: Vec<u32>, order: Vec<u32>, left: Vec<Vec<u32>>) -> Self {
        let count = size.len();
        let mut rank = vec![0; count];
        order.iter().enumerate().for_each(|(index, node)| rank[*node as usize] = index);
        let mut first = Vec::with_capacity(count);
        let (mut unknowns, mut length) = (0, 0);
        for size in &size {
            first.push(unknowns);
            unknowns += size;
        }
        let mut diagonal = vec![0; count];
        let mut below = vec![Vec::new(); count];
        for &node in &order {
            let own = size[node as usize];
            diagonal[node as usize] = length;
            length += own * own;
            let mut column = left[node as usize].clone();
            column.sort_unstable_by_key(|node| rank[*node as usize]);
            below[node as usize] = column
                .into_iter()
                .map(|node| {
                    let at = length;
                    length += own * size[node as usize];
                    Below { node, at }
                })
                .collect();
        }
        let index = |below: &[Vec<Below>], column: u32, row: u32| -> u32 {
            if column == row {
                return diagonal[column as usize];
            }
            let blocks: &[Below] = &below[column as usize];
            let found = blocks.binary_search_by_key(&rank[row as usize], |block| rank[block.node as usize]);
            blocks[found.expect("what is left of a node after elimination is a clique")].at
        };
        let targets = (0..count)
            .map(|node| {
                let blocks: &[Below] = &below[node];
                let pairs =
                    blocks.iter().enumerate().flat_map(|(index, a)| blocks[index..].iter().map(move |b| (a, b)));
                pairs.map(|(a, b)| index(&below, a.node, b.node)).collect()
            })
            .collect();
        Self {
            size,
            first,
            order,
            diagonal,
            below,
            targets,
            numbers: vec![0.0; length as usize],
            whole: vec![0.0; unknowns as usize],
            watch: false,
            least_pivot: 1.0,
        }
    }

    /// The index of the entry of two unknowns. Unknown `b` belongs to one node, and `a` to the same or another one. The
    /// nodes have an edge. `None` above the diagonal blocks.
    pub fn entry(&self, (node_a, a): (u32, u32), (node_b, b): (u32, u32)) -> Option<usize> {
        if node_a == node_b {
            return Some((self.diagonal[node_a as usize] + a * self.size[node_a as usize] + b) as usize);
        }
        let block = self.below[node_b as usize].iter().find(|block| block.node == node_a)?;
        Some((block.at + a * self.size[node_b as usize] + b) as usize)
    }

    /// All numbers, to be filled with the matrix.
    pub fn numbers(&mut self) -> &mut [f64] {
        &mut self.numbers
    }

    /// Replaces the matrix by its factor. Says whether all unknowns are determined.
    pub fn factor(&mut self) -> bool {
        let Self { size, first, order, diagonal, below, targets, numbers, whole, watch, least_pivot } = self;
        *least_pivot = 1.0;
        for (node, &own) in size.iter().enumerate() {
            for index in 0..own {
                whole[(first[node] + index) as usize] = numbers[(diagonal[node] + index * (own + 1)) as usize];
            }
        }
        let mut regular = true;
        for &node in order.iter() {
            let node = node as usize;
            let own = size[node] as usize;
            let at = diagonal[node] as usize;
            let whole = &whole[first[node] as usize..];
            regular &= factor_block(&mut numbers[at..at + own * own], own, whole);
            if *watch {
                let share = |index: usize| numbers[at + index * (own + 1)].powi(2) / whole[index];
                *least_pivot = (0..own).map(share).fold(*least_pivot, f64::min);
            }
            for block in &below[node] {
                let (head, tail) = numbers.split_at_mut(block.at as usize);
                let rows = size[block.node as usize] as usize;
                divide_block(&head[at..at + own * own], &mut tail[..rows * own], own);
            }
            let mut targets = targets[node].iter();
            for (index, a) in below[node].iter().enumerate() {
                let columns = size[a.node as usize] as usize;
                for b in &below[node][index..] {
                    let target = *targets.next().expect("there is one for each pair") as usize;
                    let rows = size[b.node as usize] as usize;
                    for row in 0..rows {
                        for column in 0..columns {
                            let mut sum = 0.0;
                            for inner in 0..own {
                                sum += numbers[b.at as usize + row * own + inner]
                                    * numbers[a.at as usize + column * own + inner];
                            }
                            numbers[target + row * columns + column] -= sum;
                        }
                    }
                }
            }
        }
        regular
    }

    /// Solves for the right side, in its place.
    pub fn solve(&self, values: &mut [f64]) {
        let Self { size, first, order, diagonal, below, numbers, .. } = self;
        for &node in order {
            let node = node as usize;
            let (own, at, begin) = (size[node] as usize, diagonal[node] as usize, first[node] as usize);
            for row in 0..own {
                let mut sum = values[begin + row];
                for column in 0..row {
                    sum -= numbers[at + row * own + column] * values[begin + column];
                }
                values[begin + row] = sum / numbers[at + row * own + row];
            }
            for block in &below[node] {
                for row in 0..size[block.node as usize] as usize {
                    for column in 0..own {
                        values[first[block.node as usize] as usize + row] -=
                            numbers[block.at as usize + row * own + column] * values[begin + column];
                    }
                }
            }
        }
        for &node in order.iter().rev() {
            let node = node as usize;
            let (own, at, begin) = (size[node] as usize, diagonal[node] as usize, first[node] as usize);
            for block in &below[node] {
                for row in 0..size[block.node as usize] as usize {
                    let other = values[first[block.node as usize] as usize + row];
                    for column in 0..own {
                        values[begin + column] -= numbers[block.at as usize + row * own + column] * other;
                    }
                }
            }
            for row in (0..own).rev() {
                let mut sum = values[begin + row];
                for column in row + 1..own {
                    sum -= numbers[at + column * own + row] * values[begin + column];
                }
                values[begin + row] = sum / numbers[at + row * own + row];
            }
        }
    }
}

/// The lower factor of a block, in its place. A pivot that vanishes is replaced by the whole number; then the block is not regular.
fn factor_block(block: &mut [f64], size: usize, whole: &[f64]) -> bool {
    let mut regular = true;
    for column in 0..size {
        let mut pivot = block[column * size + column];
        for inner in 0..column {
            pivot -= block[column * size + inner].powi(2);
        }
        if pivot.is_nan() || pivot <= DEPENDENT * whole[column] {
            regular = false;
            // A share that was added to the diagonal bounds pivots from below. Only rounding makes them smaller.
            if pivot.is_nan() || pivot <= 0.0 {
                pivot = whole[column].max(f64::MIN_POSITIVE);
            }
        }
        let root = pivot.sqrt();
        block[column * size + column] = root;
        for row in column + 1..size {
            let mut sum = block[row * size + column];
            for inner in 0..column {
                sum -= block[row * size + inner] * block[column * size + inner];
            }
            block[row * size + column] = sum / root;
        }
    }
    regular
}

/// Divides a block below the diagonal by the transposed factor of the diagonal one.
fn divide_block(factor: &[f64], block: &mut [f64], size: usize) {
    for row in block.chunks_exact_mut(size) {
        for column in 0..size {
            let mut sum = row[column];
            for inner in 0..column {
                sum -= row[inner] * factor[column * size + inner];
            }
            row[column] = sum / factor[column * size + column];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix of blocks that is diagonally dominant, with the edges given, and its solution for a right side.
    fn solved(size: Vec<u32>, edges: &[(u32, u32)]) {
        let owner: Vec<(u32, u32)> =
            size.iter().enumerate().flat_map(|(node, size)| (0..*size).map(move |own| (node as u32, own))).collect();
        let count = owner.len();
        let joined = |a: u32, b: u32| a == b || edges.contains(&(a, b)) || edges.contains(&(b, a));
        let value = |row: usize, column: usize| {
            let (low, high) = (row.min(column), row.max(column));
            match joined(owner[row].0, owner[column].0) {
                true if row == column => 3.0 * count as f64,
                true => ((7 * low + 3 * high) % 5) as f64 - 2.0,
                false => 0.0,
            }
        };
        let mut factor = BlockCholesky::new(size, edges.iter().copied());
        for row in 0..count {
            for column in 0..count {
                if joined(owner[row].0, owner[column].0)
                    && let Some(index) = factor.entry(owner[row], owner[column])
                {
                    factor.numbers()[index] = value(row, column);
                }
            }
        }
        assert!(factor.factor());
        let exact: Vec<f64> = (0..count).map(|index| 1.0 + index as f64).collect();
        let mut values: Vec<f64> =
            (0..count).map(|row| (0..count).map(|column| value(row, column) * exact[column]).sum()).collect();
        factor.solve(&mut values);
        for (found, exact) in values.iter().zip(&exact) {
            assert!((found - exact).abs() < 1e-12 * exact.abs(), "{found} {exact}");
        }
    }

    /// Law: the solution satisfies the equations. Tolerance: rounding, as the matrices are dominated by their diagonal.
    #[test]
    fn chains_loops_and_grids_are_solved() {
        solved(vec![2, 2, 3, 1, 2], &[(0, 1), (1, 2), (2, 3), (3, 4)]);
        solved(vec![2, 2, 3, 1, 2], &[(0, 1), (1, 2), (2, 3), (3, 4), (4, 0)]);
        let grid = (0..16_u32).flat_map(|node| [(node, node + 1), (node, node + 4)]);
        let edges: Vec<(u32, u32)> = grid.filter(|&(a, b)| b < 16 && (b - a == 4 || b % 4 != 0)).collect();
        solved(vec![2; 16], &edges);
    }

    /// Law: a tree has no fill. It has one block below the diagonal for each of its edges.
    #[test]
    fn a_tree_has_no_fill() {
        let edges: Vec<(u32, u32)> = (1..50_u32).map(|node| (node, (node - 1) / 3)).collect();
        let factor = BlockCholesky::new(vec![2; 50], edges.iter().copied());
        assert_eq!(factor.below.iter().map(Vec::len).sum::<usize>(), edges.len());
    }

    #[test]
    fn dependent_rows_are_noticed() {
        let mut factor = BlockCholesky::new(vec![1, 1], [(0, 1)].into_iter());
        factor.numbers().fill(1.0);
        assert!(!factor.factor());
    }
}
