//! Order conditions of Runge-Kutta methods on rooted trees. A sum of rates has order `p` if it satisfies one condition
//! for each tree of up to `p` nodes. Its weights times the stages' elementary weights of the tree must sum to
//! `1/density`. The source is Butcher 1963; Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section
//! II.2.

/// A rooted tree.
struct Tree {
    /// Its number of nodes.
    order: usize,
    /// The product of the orders of all its subtrees.
    density: f64,
    /// The elementary weight of each stage: the product over the branches of the weighted sums of their stages.
    stages: Vec<f64>,
    /// The same with the sizes of all weights: to this rounding is relative.
    sizes: Vec<f64>,
}

/// All rooted trees up to some order, for one table of stages.
pub(super) struct Trees(Vec<Tree>);

impl Trees {
    /// Trees of up to `order` nodes for stages whose weights are `rows`.
    pub(super) fn new(rows: &[Vec<f64>], order: usize) -> Self {
        let mut trees = Self(Vec::new());
        for order in 1..=order {
            let known = trees.0.len();
            trees.grow(rows, order, order - 1, known, &mut Vec::new());
        }
        trees
    }

    /// Adds the trees with `order` nodes of which `branches` are there and `rest` nodes are not yet used.
    fn grow(&mut self, rows: &[Vec<f64>], order: usize, rest: usize, below: usize, branches: &mut Vec<usize>) {
        if rest == 0 {
            let apply = |row: &[f64], values: &[f64]| row.iter().zip(values).map(|(a, b)| a * b).sum::<f64>();
            let product = |row: &Vec<f64>| branches.iter().map(|&branch| apply(row, &self.0[branch].stages)).product();
            let size = |row: &Vec<f64>| {
                let row: Vec<f64> = row.iter().map(|weight| weight.abs()).collect();
                branches.iter().map(|&branch| apply(&row, &self.0[branch].sizes)).product()
            };
            let density = order as f64 * branches.iter().map(|&branch| self.0[branch].density).product::<f64>();
            let (stages, sizes) = (rows.iter().map(product).collect(), rows.iter().map(size).collect());
            return self.0.push(Tree { order, density, stages, sizes });
        }
        for branch in (0..below).filter(|&branch| self.0[branch].order <= rest).collect::<Vec<_>>() {
            branches.push(branch);
            self.grow(rows, order, rest - self.0[branch].order, branch + 1, branches);
            branches.pop();
        }
    }

    /// Number of trees.
    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    /// The highest order up to which `weights` give `expected(order)/density`, to `32` roundings of the sizes summed.
    pub(super) fn order(&self, weights: &[f64], expected: impl Fn(i32) -> f64) -> usize {
        let wrong = self.0.iter().find(|tree| {
            let sum: f64 = weights.iter().zip(&tree.stages).map(|(weight, stage)| weight * stage).sum();
            let size: f64 = weights.iter().zip(&tree.sizes).map(|(weight, size)| weight.abs() * size).sum();
            (sum - expected(tree.order as i32) / tree.density).abs() > 32.0 * f64::EPSILON * size
        });
        wrong.map_or(self.0.last().map_or(0, |tree| tree.order), |tree| tree.order - 1)
    }
}
