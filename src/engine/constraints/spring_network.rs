//! Static displacements of bodies that linear springs hold: `K u = f` with `K = sum k g g^T`. The method is that of conjugate
//! gradients (Hestenes and Stiefel 1952). The blocks of single bodies precondition it.
//!
//! `g` is the row of a spring: the factors from the displacements of its two bodies to its elongation. `K` may be
//! singular. A disc on a floor without friction is held in one direction of three. Such a system has a solution if no
//! force acts in the free directions. Otherwise bodies accelerate along them, and springs bear the rest
//! (inertia relief, [`relieve`]).

use glam::DVec2;

/// A displacement in metres with a turn in rad, or a force in N with a torque in N m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Twist {
    /// Along the axes.
    pub linear: DVec2,
    /// About the centre of mass.
    pub angular: f64,
}

/// One side of a spring: the index of its body, and the factors from the displacement to the elongation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NetworkEnd {
    /// Index among the bodies that are solved for.
    pub body: usize,
    /// Factors.
    pub row: Twist,
}

/// A spring between two bodies, or between a body and something that stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NetworkSpring {
    /// Both sides, where they move.
    pub ends: [Option<NetworkEnd>; 2],
    /// In N/m, or in N m for a spring against turning.
    pub stiffness: f64,
}

/// Why there are no displacements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsolved {
    /// A force acts in a direction that no spring holds.
    Free,
    /// The work that was granted did not suffice.
    Work,
}

/// Each solution reduces forces to this share. Newton's method, which calls it again, does the rest.
const GAIN: f64 = 1e-12;

/// Forces that remain above this share are not rounding: no spring holds them.
const HELD: f64 = 1e-8;

/// A pivot below this share of its number before elimination is zero: no spring holds the body in that direction.
const SINGULAR: f64 = 1e-13;

/// Springs to the ground are weaker than the fastest others by this factor when they tell the free directions. Three of them leave
/// an error of eight times its third power in accelerations. The error grows with the sixth power of the ratio of the fastest swing
/// to a slow one. Rounding is the greater by the inverse of the factor. Heavy bodies on light wheels swing thirty times as slowly,
/// and there both come to 1e-9. Displacements lack a share of its square. Newton's method finds that share in the next round.
const WEAK: f64 = 2e-7;

/// Accelerations that springs ought to prevent are rounding up to this share of all.
pub const FREE: f64 = 4.0 * f64::EPSILON / WEAK;

/// A direction that springs resist by less than this share of their stiffness is free. The square of rounding is far
/// below it, and the softest wave through a thousand bodies far above.
const SOFTEST: f64 = 1e-18;

impl Twist {
    fn dot(self, other: Self) -> f64 {
        self.linear.dot(other.linear) + self.angular * other.angular
    }

    /// This with `factor` times another.
    pub fn plus(self, other: Self, factor: f64) -> Self {
        Self { linear: self.linear + other.linear * factor, angular: self.angular + other.angular * factor }
    }
}

impl NetworkSpring {
    /// Its elongation by these displacements.
    pub fn elongation(&self, by: &[Twist]) -> f64 {
        self.ends.iter().flatten().fold(0.0, |sum, end| sum + end.row.dot(by[end.body]))
    }

    /// The greatest elongation that these displacements could make, whatever their directions. `extents`: the sizes of the bodies
    /// in metres.
    pub fn most(&self, by: &[Twist], extents: &[f64]) -> f64 {
        let size = |twist: Twist, extent: f64| twist.linear.length() + twist.angular.abs() * extent;
        self.ends.iter().flatten().fold(0.0, |sum, end| {
            let extent = extents[end.body];
            sum + size(end.row, 1.0 / extent) * size(by[end.body], extent)
        })
    }
}

/// Finds the displacements under `forces`. Each of the products with `K` takes as much of `work` as there are springs.
///
/// # Errors
/// If a force acts in a free direction, or the work does not suffice.
pub fn solve(springs: &[NetworkSpring], forces: &[Twist], work: &mut usize) -> Result<Vec<Twist>, Unsolved> {
    solve_beyond((0.0, 0.0), springs, forces, work)
}

/// [`solve`] with forces that rounding of places changes by `rounding`, a force in N and a torque in N m.
///
/// # Errors
/// If a greater force acts in a free direction, or the work does not suffice.
pub fn solve_beyond(
    rounding: (f64, f64),
    springs: &[NetworkSpring],
    forces: &[Twist],
    work: &mut usize,
) -> Result<Vec<Twist>, Unsolved> {
    let count = forces.len();
    let blocks = inverse_blocks(springs, count);
    let precondition =
        |forces: &[Twist]| -> Vec<Twist> { forces.iter().zip(&blocks).map(|(f, b)| b.times(*f)).collect() };
    let dot = |a: &[Twist], b: &[Twist]| a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a.dot(*b));
    let mut found = vec![Twist::default(); count];
    let mut residual = forces.to_vec();
    let mut scaled = precondition(&residual);
    let mut search = scaled.clone();
    let mut size = dot(&residual, &scaled);
    let goal = size * GAIN * GAIN;
    let mut response = vec![Twist::default(); count];
    for _ in 0..12 * count + 12 {
        if size <= goal || size == 0.0 {
            break;
        }
        if *work < springs.len() {
            return Err(Unsolved::Work);
        }
        *work -= springs.len();
        response.fill(Twist::default());
        let mut natural = 0.0;
        for spring in springs {
            let pull = spring.stiffness * spring.elongation(&search);
            for end in spring.ends.iter().flatten() {
                response[end.body] = response[end.body].plus(end.row, pull);
                let own = end.row.dot(search[end.body]);
                natural += spring.stiffness * own * own;
            }
        }
        let curvature = dot(&search, &response);
        if curvature <= SOFTEST * natural {
            break;
        }
        let step = size / curvature;
        for index in 0..count {
            found[index] = found[index].plus(search[index], step);
            residual[index] = residual[index].plus(response[index], -step);
        }
        scaled = precondition(&residual);
        let before = std::mem::replace(&mut size, dot(&residual, &scaled));
        for index in 0..count {
            search[index] = scaled[index].plus(search[index], size / before);
        }
    }
    let greatest = |list: &[Twist], of: fn(&Twist) -> f64| list.iter().map(of).fold(0.0, f64::max);
    let (linear, angular) = (|twist: &Twist| twist.linear.length(), |twist: &Twist| twist.angular.abs());
    let ends = springs.iter().flat_map(|spring| spring.ends).flatten().filter(|end| end.row.linear != DVec2::ZERO);
    let reach = ends.map(|end| end.row.angular.abs()).fold(0.0, f64::max);
    let torque = greatest(forces, angular);
    // A torque makes forces in the springs, and forces make torques: rounding of both is a share of the greater.
    let force = greatest(forces, linear).max(if reach > 0.0 { torque / reach } else { 0.0 });
    let held = greatest(&residual, linear) <= (HELD * force).max(rounding.0)
        && greatest(&residual, angular) <= (HELD * torque.max(force * reach)).max(rounding.1);
    let finite = found.iter().all(|twist| twist.linear.is_finite() && twist.angular.is_finite());
    if held && finite { Ok(found) } else { Err(Unsolved::Free) }
}

/// The accelerations of bodies that nothing holds, and the displacements under the forces that are left.
#[derive(Clone, Debug, PartialEq)]
pub struct Relief {
    /// In m/s2 and rad/s2. No spring changes its elongation by them.
    pub accelerations: Vec<Twist>,
    /// In metres and rad. They have no part along the free directions, weighed by the masses.
    pub displacements: Vec<Twist>,
}

/// Finds accelerations and displacements with `K u + M a = f` and `K a = 0`. `rigid`: springs that stand for joints, beside the others.
/// `masses`: the mass and the moment of inertia of each body. Takes `M a` out of the forces.
///
/// # Errors
/// If the work does not suffice.
pub fn relieve(
    (springs, rigid): (&[NetworkSpring], &[NetworkSpring]),
    masses: &[(f64, f64)],
    forces: &mut [Twist],
    work: &mut usize,
) -> Result<Relief, Unsolved> {
    let mut accelerations = vec![Twist::default(); forces.len()];
    let mut displacements = Vec::new();
    // The first round leaves rounding of the free motion in the displacements, the second one of the springs.
    for _ in 0..2 {
        let found = relieve_once((springs, rigid), masses, forces, work)?;
        for (index, found) in found.accelerations.iter().enumerate() {
            accelerations[index] = accelerations[index].plus(*found, 1.0);
            let (mass, moment) = masses[index];
            let bears = Twist { linear: found.linear * mass, angular: found.angular * moment };
            forces[index] = forces[index].plus(bears, -1.0);
        }
        displacements = found.displacements;
    }
    Ok(Relief { accelerations, displacements })
}

/// A round of [`relieve`]. Springs of the stiffness `e M` hold each body to the ground. Then the displacements are `a / e + u + e w` and
/// a remainder of the order of the square of `e`. Solutions with `e`, `2 e` and `4 e` separate the three.
fn relieve_once(
    (springs, rigid): (&[NetworkSpring], &[NetworkSpring]),
    masses: &[(f64, f64)],
    forces: &[Twist],
    work: &mut usize,
) -> Result<Relief, Unsolved> {
    let rate = |spring: &NetworkSpring, end: &NetworkEnd| {
        let (mass, moment) = masses[end.body];
        spring.stiffness * (end.row.linear.length_squared() / mass + end.row.angular * end.row.angular / moment)
    };
    let rates = springs.iter().flat_map(|spring| spring.ends.iter().flatten().map(|end| rate(spring, end)));
    let fastest = rates.fold(0.0, f64::max);
    // Without springs all is free, and any stiffness does.
    let weak = WEAK * if fastest > 0.0 { fastest } else { 1.0 };
    let axes = [(DVec2::X, 0.0), (DVec2::Y, 0.0), (DVec2::ZERO, 1.0)];
    let mut tied = |weak: f64| {
        let ground = masses.iter().enumerate().flat_map(|(body, &(mass, moment))| {
            axes.map(|(linear, angular)| NetworkSpring {
                ends: [None, Some(NetworkEnd { body, row: Twist { linear, angular } })],
                stiffness: weak * if angular == 0.0 { mass } else { moment },
            })
        });
        solve(&springs.iter().chain(rigid).copied().chain(ground).collect::<Vec<_>>(), forces, work)
    };
    let solutions = [tied(weak)?, tied(2.0 * weak)?, tied(4.0 * weak)?];
    let mix = |factors: [f64; 3]| {
        let of = |body: usize| {
            let terms = solutions.iter().zip(factors);
            terms.fold(Twist::default(), |sum, (solution, factor)| sum.plus(solution[body], factor))
        };
        (0..forces.len()).map(of).collect()
    };
    let third = weak / 3.0;
    Ok(Relief { accelerations: mix([8.0 * third, -12.0 * third, 4.0 * third]), displacements: mix([-2.0, 5.0, -2.0]) })
}

/// The inverse of the stiffness that holds one body while the others stand; zero in free directions.
#[derive(Clone, Copy, Debug, Default)]
struct Block([[f64; 3]; 3]);

impl Block {
    fn times(&self, force: Twist) -> Twist {
        let force = [force.linear.x, force.linear.y, force.angular];
        let row = |row: usize| (0..3).fold(0.0, |sum, column| sum + self.0[row][column] * force[column]);
        Twist { linear: DVec2::new(row(0), row(1)), angular: row(2) }
    }

    /// Gauss and Jordan's elimination with the greatest remaining pivot. Pivots below rounding are left out.
    fn inverse(&self) -> Self {
        let (mut matrix, mut done) = (self.0, [false; 3]);
        for _ in 0..3 {
            let share = |pivot: usize| {
                if self.0[pivot][pivot] > 0.0 { matrix[pivot][pivot] / self.0[pivot][pivot] } else { 0.0 }
            };
            let left = (0..3).filter(|pivot| !done[*pivot] && share(*pivot) > SINGULAR);
            let Some(pivot) = left.max_by(|a, b| share(*a).total_cmp(&share(*b)).then(b.cmp(a))) else { break };
            done[pivot] = true;
            let inverse = 1.0 / matrix[pivot][pivot];
            let own = matrix[pivot];
            for row in (0..3).filter(|row| *row != pivot) {
                let factor = matrix[row][pivot] * inverse;
                for column in 0..3 {
                    matrix[row][column] -= factor * own[column];
                }
                matrix[row][pivot] = -factor;
            }
            matrix[pivot] = own.map(|number| number * inverse);
            matrix[pivot][pivot] = inverse;
        }
        for row in 0..3 {
            for column in 0..3 {
                if !done[row] || !done[column] {
                    matrix[row][column] = 0.0;
                }
            }
        }
        Self(matrix)
    }
}

fn inverse_blocks(springs: &[NetworkSpring], count: usize) -> Vec<Block> {
    let mut blocks = vec![Block::default(); count];
    for spring in springs {
        for end in spring.ends.iter().flatten() {
            let row = [end.row.linear.x, end.row.linear.y, end.row.angular];
            for (line, one) in blocks[end.body].0.iter_mut().zip(row) {
                for (number, other) in line.iter_mut().zip(row) {
                    *number += spring.stiffness * one * other;
                }
            }
        }
    }
    blocks.iter().map(Block::inverse).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(body: usize, x: f64, y: f64, angular: f64) -> Option<NetworkEnd> {
        Some(NetworkEnd { body, row: Twist { linear: DVec2::new(x, y), angular } })
    }

    fn down(force: f64) -> Twist {
        Twist { linear: DVec2::new(0.0, -force), angular: 0.0 }
    }

    /// Law: in a chain each spring bears all below it. So the displacements of equal bodies are sums of whole numbers. Tolerance:
    /// the gain of a solution, times the ratio of the greatest to the least force.
    #[test]
    fn a_chain_hangs_by_the_sums_of_its_loads() {
        let count = 50;
        let spring = |body: usize| NetworkSpring {
            ends: [body.checked_sub(1).and_then(|above| end(above, 0.0, -1.0, 0.0)), end(body, 0.0, 1.0, 0.0)],
            stiffness: 2.0,
        };
        let springs: Vec<_> = (0..count).map(spring).collect();
        let found = solve(&springs, &vec![down(2.0); count], &mut 100_000).unwrap();
        let mut exact = 0.0;
        for (body, found) in found.iter().enumerate() {
            exact -= (count - body) as f64;
            assert!(
                (found.linear.y - exact).abs() < 1e-7 * exact.abs(),
                "{body}: {} instead of {exact}",
                found.linear.y
            );
            assert_eq!((found.linear.x, found.angular), (0.0, 0.0));
        }
    }

    /// Law: a force that no spring holds has no displacement. A direction without a force needs no spring.
    #[test]
    fn a_free_direction_bears_nothing() {
        let floor = NetworkSpring { ends: [None, end(0, 0.0, 1.0, 0.0)], stiffness: 1e6 };
        // Rounding of three operations.
        assert!((solve(&[floor], &[down(3.0)], &mut 1000).unwrap()[0].linear.y + 3e-6).abs() < 1e-20);
        let slope = NetworkSpring { ends: [None, end(0, 0.6, 0.8, 0.0)], ..floor };
        assert_eq!(solve(&[slope], &[down(3.0)], &mut 1000), Err(Unsolved::Free));
        // It rolls: friction at the rim turns the disc as it holds the centre.
        let rim = NetworkSpring { ends: [None, end(0, 0.8, -0.6, 0.1)], ..floor };
        assert_eq!(solve(&[slope, rim], &[down(3.0)], &mut 1000), Err(Unsolved::Free));
        assert_eq!(solve(&[floor], &[down(3.0)], &mut 0), Err(Unsolved::Work));
    }

    /// Law: a disc that rolls down a slope has the acceleration `g sin a / (1 + I / (m r^2))`. Friction bears the rest of its weight
    /// along the slope, and the normal force that across. Tolerances: accelerations lack the third power of [`WEAK`],
    /// and rounding over it. Displacements lack fourteen times the square of `e M/K`, and the same rounding. `e` is `WEAK` times the
    /// greater of both `K/M`, that of the rim.
    #[test]
    fn a_disc_accelerates_where_it_rolls() {
        let (mass, moment, radius, stiffness) = (2.0, 0.03, 0.1, 1e6);
        let spring = |row: (f64, f64, f64)| NetworkSpring { ends: [None, end(0, row.0, row.1, row.2)], stiffness };
        // The slope rises to the left with 3 in 4. The rim turns with the way along it.
        let springs = [spring((0.6, 0.8, 0.0)), spring((0.8, -0.6, radius))];
        let mut forces = [down(10.0 * mass)];
        let found = relieve((&springs, &[]), &[(mass, moment)], &mut forces, &mut 10_000).unwrap();
        let along = 6.0 / (1.0 + moment / (mass * radius * radius));
        let exact = Twist { linear: DVec2::new(0.8, -0.6) * along, angular: -along / radius };
        let off = found.accelerations[0].plus(exact, -1.0);
        assert!(off.linear.length() < 1e-10 * along && off.angular.abs() < 1e-10 * along / radius, "{found:?}");
        let friction = mass * (6.0 - along);
        let lack = 14.0 * (WEAK * (1.0 + mass * radius * radius / moment)).powi(2) + FREE;
        for (spring, force) in springs.iter().zip([-0.8 * 10.0 * mass, friction]) {
            let found = stiffness * spring.elongation(&found.displacements);
            assert!((found - force).abs() < 1.001 * lack * force.abs(), "{found} instead of {force}");
        }
    }

    /// Law: without any spring, each body falls by itself.
    #[test]
    fn free_bodies_fall() {
        let mut forces = [down(3.0), Twist { linear: DVec2::X, angular: 0.5 }];
        let found = relieve((&[], &[]), &[(1.5, 1.0), (2.0, 0.25)], &mut forces, &mut 1000).unwrap();
        let exact = [down(2.0), Twist { linear: DVec2::X * 0.5, angular: 2.0 }];
        for (found, exact) in found.accelerations.iter().zip(exact) {
            let off = found.plus(exact, -1.0);
            assert!(off.linear.length() < 1e-12 && off.angular.abs() < 1e-12, "{found:?}");
        }
    }
}
