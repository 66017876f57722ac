//! The critical tick: the largest angular frequency of all springs together, those of contacts and those of the scene.
//!
//! The springs have rows `j` (normal, tangential and rolling, lever arms included) and stiffnesses `k`, and the masses
//! are `M`. The motion of small displacements is `K phi = omega^2 M phi`, `K = sum k j j^T`. If a method is stable up
//! to `omega dt = limit`, its longest tick is `limit/omega_max`. Several springs that hold one body are faster together
//! than each alone. A spring off the centre of a body is faster than `k/m`.
//!
//! The largest eigenvalue of `M^-1/2 K M^-1/2` is found by Lanczos' method (1950; Golub and Van Loan, *Matrix
//! Computations*, 2013, 10.1). It takes a few products with the rows, and never a matrix. With `n` degrees of freedom
//! the result after `k` products lies below `omega^2`. The share is `0.103 (ln n/(k - 1))^2` on average (Kuczynski and
//! Wozniakowski 1992). That is 0.015 for a hundred bodies. [`Springs::bound`] lies above it always.
//!
//! Neglected: the stiffness from the rotation of the normal (force over radius), which is small beside `k` if overlaps
//! are. Neglected too: a slipping contact has no tangential spring.

use glam::DVec2;

use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// Products with the rows. The result is exact if they reach the number of degrees of freedom.
const STEPS: usize = 16;

/// Two springs of a contact or of the scene. They act between two bodies, or between a body and a wall or the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spring {
    /// Index of the body on side A, and the arm from its centre of mass to the contact. `None`: a wall or the world.
    pub a: Option<(usize, DVec2)>,
    /// The same for side B.
    pub b: (usize, DVec2),
    /// Unit normal.
    pub normal: DVec2,
    /// Stiffness along the normal and across it, in N/m.
    pub stiffness: (f64, f64),
    /// The effect of damping along the normal on the method, as an additional stiffness in N/m.
    pub damped: f64,
    /// Stiffness against turning one side over the other, in N m.
    pub turning: f64,
}

/// A velocity and spin, or a force and torque; scaled by the roots of mass and inertia.
#[derive(Clone, Copy, Debug, Default)]
struct Scaled {
    linear: DVec2,
    angular: f64,
}

/// Everything that holds bodies at one moment, and working memory.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Springs {
    list: Vec<Spring>,
    /// The number of contacts among them: they come first.
    contacts: usize,
    /// For each spring the slots of both sides; [`IMMOVABLE`] for sides that do not move by forces.
    slots: Vec<(u32, u32)>,
    /// For each slot the body.
    bodies: Vec<usize>,
    /// For each slot the roots of 1/mass and 1/inertia.
    roots: Vec<(f64, f64)>,
    /// For each body its slot.
    slot_of: Vec<u32>,
    /// For each slot the upper bound of the effect of its springs.
    sums: Vec<f64>,
}

const IMMOVABLE: u32 = u32::MAX;

/// Memory of so many springs is kept for the next time.
const KEPT: usize = 4096;

/// Bounds of the springs without the solution of an eigenvalue problem.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bound {
    /// An upper bound of `omega^2` of all springs together, in 1/s2.
    pub squared: f64,
    /// Place of the body that is held most stiffly.
    pub body: usize,
    /// The largest `omega^2` of a single contact along its normal, in 1/s2.
    pub pair_squared: f64,
    /// The number of that contact.
    pub pair: usize,
}

impl Springs {
    /// Makes room for so many springs and no more.
    pub fn make_room(&mut self, count: usize) {
        self.list.clear();
        self.list.reserve_exact(count);
        self.slots.clear();
        self.slots.reserve_exact(count);
    }

    /// Gives back the memory of many springs, which are rarely asked for.
    pub fn put_away(&mut self) {
        if self.list.len() > KEPT {
            *self = Self::default();
        }
    }

    /// Takes up the springs of one moment: those of contacts, and the others.
    pub fn gather(
        &mut self,
        contacts: impl IntoIterator<Item = Spring>,
        others: impl IntoIterator<Item = Spring>,
        bodies: &Bodies,
    ) {
        self.list.clear();
        self.list.extend(contacts);
        self.contacts = self.list.len();
        self.list.extend(others);
        self.slots.clear();
        self.roots.clear();
        // If few of many bodies are held, filling the whole list each time would cost more than all the rest.
        if self.slot_of.len() == bodies.len() {
            self.bodies.drain(..).for_each(|body| self.slot_of[body] = IMMOVABLE);
        } else {
            self.bodies.clear();
            self.slot_of.clear();
            self.slot_of.resize(bodies.len(), IMMOVABLE);
        }
        for index in 0..self.list.len() {
            let Spring { a, b, .. } = self.list[index];
            let slots = (a.map_or(IMMOVABLE, |(body, _)| self.slot(body, bodies)), self.slot(b.0, bodies));
            self.slots.push(slots);
        }
    }

    fn slot(&mut self, body: usize, bodies: &Bodies) -> u32 {
        if !bodies.dynamic[body] {
            return IMMOVABLE;
        }
        if self.slot_of[body] == IMMOVABLE {
            self.slot_of[body] = self.bodies.len() as u32;
            self.bodies.push(body);
            self.roots.push((bodies.inverse_mass(body).sqrt(), bodies.inverse_inertia(body).sqrt()));
        }
        self.slot_of[body]
    }

    /// The pair `number`: places of its bodies, `None` for a wall.
    pub fn pair(&self, number: usize) -> (Option<usize>, usize) {
        let Spring { a, b, .. } = self.list[number];
        (a.map(|(body, _)| body), b.0)
    }

    /// Mobilities of a slot along the normal and across it, in 1/kg.
    fn mobility(&self, slot: u32, arm: DVec2, normal: DVec2) -> (f64, f64) {
        let Some(&(mass, inertia)) = self.roots.get(slot as usize) else { return (0.0, 0.0) };
        let (along, across) = (arm.perp_dot(normal) * inertia, arm.dot(normal) * inertia);
        (mass * mass + along * along, mass * mass + across * across)
    }

    /// Bounds `omega^2` from above. Each body's springs are summed as if all pulled along one direction. Those to other
    /// moving bodies count twice, because `(x - y)^2 <= 2 x^2 + 2 y^2`.
    pub fn bound(&mut self) -> Bound {
        let mut found = Bound::default();
        self.sums.clear();
        self.sums.resize(self.bodies.len(), 0.0);
        for (number, (spring, &(a, b))) in self.list.iter().zip(&self.slots).enumerate() {
            let of_a = spring.a.map_or((0.0, 0.0), |(_, arm)| self.mobility(a, arm, spring.normal));
            let of_b = self.mobility(b, spring.b.1, spring.normal);
            let (normal, across) = spring.stiffness;
            let squared = normal * (of_a.0 + of_b.0);
            if number < self.contacts && squared > found.pair_squared {
                (found.pair_squared, found.pair) = (squared, number);
            }
            let times = if a != IMMOVABLE && b != IMMOVABLE { 2.0 } else { 1.0 };
            for (slot, mobility) in [(a, of_a), (b, of_b)] {
                if let Some(sum) = self.sums.get_mut(slot as usize) {
                    let inertia = self.roots[slot as usize].1;
                    *sum += times
                        * ((normal + spring.damped) * mobility.0
                            + across * mobility.1
                            + spring.turning * inertia * inertia);
                }
            }
        }
        for (slot, &sum) in self.sums.iter().enumerate() {
            if sum > found.squared {
                (found.squared, found.body) = (sum, self.bodies[slot]);
            }
        }
        found
    }

    /// The largest `omega^2` in 1/s2.
    pub fn largest(&self) -> f64 {
        let size = self.bodies.len();
        let mut now: Vec<Scaled> = (0..size).map(start).collect();
        let length = dot(&now, &now).sqrt();
        scale(&mut now, 1.0 / length);
        let mut before = vec![Scaled::default(); size];
        let mut next = vec![Scaled::default(); size];
        let (mut diagonal, mut beside) = (Vec::with_capacity(STEPS), Vec::with_capacity(STEPS));
        let mut coupling = 0.0;
        for _ in 0..STEPS.min(3 * size) {
            self.multiply(&now, &mut next);
            let alpha = dot(&now, &next);
            for ((next, now), before) in next.iter_mut().zip(&now).zip(&before) {
                next.linear -= now.linear * alpha + before.linear * coupling;
                next.angular -= now.angular * alpha + before.angular * coupling;
            }
            diagonal.push(alpha);
            coupling = dot(&next, &next).sqrt();
            let scale_so_far = diagonal.iter().copied().fold(0.0, f64::max);
            if coupling <= 1e-9 * scale_so_far {
                break;
            }
            beside.push(coupling);
            scale(&mut next, 1.0 / coupling);
            std::mem::swap(&mut before, &mut now);
            std::mem::swap(&mut now, &mut next);
        }
        largest_of_tridiagonal(&diagonal, &beside)
    }

    /// `M^-1/2 K M^-1/2` times a vector.
    fn multiply(&self, from: &[Scaled], to: &mut [Scaled]) {
        to.fill(Scaled::default());
        for (spring, &(a, b)) in self.list.iter().zip(&self.slots) {
            let velocity = |slot: u32, arm: DVec2| {
                from.get(slot as usize).map_or(DVec2::ZERO, |side| {
                    let (mass, inertia) = self.roots[slot as usize];
                    side.linear * mass + arm.perp() * (side.angular * inertia)
                })
            };
            let arm_a = spring.a.map_or(DVec2::ZERO, |(_, arm)| arm);
            let apart = velocity(b, spring.b.1) - velocity(a, arm_a);
            let along = spring.normal * apart.dot(spring.normal);
            let force = along * (spring.stiffness.0 + spring.damped) + (apart - along) * spring.stiffness.1;
            let turn =
                |slot: u32| from.get(slot as usize).map_or(0.0, |side| side.angular * self.roots[slot as usize].1);
            let torque = spring.turning * (turn(b) - turn(a));
            for (slot, arm, force, torque) in [(a, arm_a, -force, -torque), (b, spring.b.1, force, torque)] {
                if let Some(side) = to.get_mut(slot as usize) {
                    let (mass, inertia) = self.roots[slot as usize];
                    side.linear += force * mass;
                    side.angular += (arm.perp_dot(force) + torque) * inertia;
                }
            }
        }
    }
}

/// A direction that is no eigenvector of anything in particular, the same in every run: digits of the golden section.
fn start(slot: usize) -> Scaled {
    let digits = |number: usize| (number as f64 * 0.618_033_988_749_894_9).fract() + 0.5;
    let sign = |number: usize| if (number as f64 * 0.414_213_562_373_095_1).fract() < 0.5 { 1.0 } else { -1.0 };
    let value = |number: usize| digits(number) * sign(number);
    Scaled { linear: DVec2::new(value(3 * slot + 1), value(3 * slot + 2)), angular: value(3 * slot + 3) }
}

fn dot(a: &[Scaled], b: &[Scaled]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a.linear.dot(b.linear) + a.angular * b.angular)
}

fn scale(vector: &mut [Scaled], factor: f64) {
    for item in vector {
        item.linear *= factor;
        item.angular *= factor;
    }
}

/// Largest eigenvalue of a symmetric tridiagonal matrix, by bisection on the sign of its leading minors. The source is
/// Sturm; Golub and Van Loan 8.4.
fn largest_of_tridiagonal(diagonal: &[f64], beside: &[f64]) -> f64 {
    let reach = |index: usize| {
        let before = index.checked_sub(1).and_then(|before| beside.get(before)).copied().unwrap_or(0.0);
        let after = if index + 1 < diagonal.len() { beside[index] } else { 0.0 };
        diagonal[index] + before.abs() + after.abs()
    };
    let mut high = (0..diagonal.len()).map(reach).fold(0.0, f64::max);
    let mut low = diagonal.iter().copied().fold(0.0, f64::max);
    // No eigenvalue lies above `at` if all leading minors of `T - at` have the right signs.
    let is_above_all = |at: f64| {
        let mut minor = 1.0;
        diagonal.iter().enumerate().all(|(index, alpha)| {
            let beta = index.checked_sub(1).map_or(0.0, |before| beside[before]);
            minor = alpha - at - beta * beta / minor;
            minor < 0.0
        })
    };
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if high - low <= 1e-12 * high || !(middle > low && middle < high) {
            break;
        }
        if is_above_all(middle) { high = middle } else { low = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_eigenvalue_of_a_chain_is_known() {
        // Second differences of length n: 2 + 2 cos(pi/(n + 1)).
        for length in 1..20_u32 {
            let size = length as usize;
            let found = largest_of_tridiagonal(&vec![2.0; size], &vec![-1.0; size - 1]);
            let exact = 2.0 + 2.0 * libm::cos(std::f64::consts::PI / f64::from(length + 1));
            assert!((found - exact).abs() < 1e-11 * exact, "{length}: {found} {exact}");
        }
    }

    /// Discs of different masses, each on a spring to some others and to the ground, in no order at all.
    fn heap(count: usize) -> (Vec<Spring>, Bodies) {
        let digit = |number: usize| (number as f64 * 0.618_033_988_749_894_9).fract();
        let bodies = Bodies {
            entity: vec![bevy_ecs::entity::Entity::PLACEHOLDER; count],
            dynamic: vec![true; count],
            inverse_mass: (0..count).map(|body| 1.0 + 3.0 * digit(body)).collect(),
            inverse_inertia: (0..count).map(|body| 2.0 + 9.0 * digit(7 * body)).collect(),
            ..Bodies::default()
        };
        let spring = |number: usize| {
            let normal = DVec2::from_angle(6.3 * digit(3 * number));
            let (a, b) = (number % count, (number * 7 + number / count + 1) % count);
            let stiffness = (50.0 + 100.0 * digit(5 * number), 40.0);
            let side = (!number.is_multiple_of(11) && a != b).then_some((a, normal * 0.4));
            Spring {
                a: side,
                b: (b, DVec2::new(-0.3, 0.1 + digit(number))),
                normal,
                stiffness,
                damped: 10.0 * digit(9 * number),
                turning: digit(13 * number),
            }
        };
        ((0..3 * count).map(spring).collect(), bodies)
    }

    #[test]
    fn a_few_products_find_the_largest_frequency_and_the_bound_lies_above() {
        for count in [1, 2, 5, 30, 100] {
            let (list, bodies) = heap(count);
            let mut springs = Springs::default();
            springs.gather(list, [], &bodies);
            // The power method, until it has all digits that are asked for.
            let mut now: Vec<Scaled> = (0..springs.bodies.len()).map(start).collect();
            let mut next = now.clone();
            let mut exact = 0.0;
            for _ in 0..20_000 {
                springs.multiply(&now, &mut next);
                exact = dot(&now, &next) / dot(&now, &now);
                let length = dot(&next, &next).sqrt();
                scale(&mut next, 1.0 / length);
                std::mem::swap(&mut now, &mut next);
            }
            let (found, bound) = (springs.largest(), springs.bound());
            let expected: f64 =
                if 3 * count <= STEPS { 1e-9 } else { 0.103 * ((3.0 * count as f64).ln() / 15.0).powi(2) };
            println!("{count}: {found} {exact} {} {}", 1.0 - found / exact, bound.squared / exact);
            // On average; twice that for a single one.
            assert!(
                found <= exact * (1.0 + 1e-9) && found >= exact * (1.0 - 2.0 * expected),
                "{count}: {found} {exact}"
            );
            assert!(
                bound.squared >= exact * (1.0 - 1e-12) && bound.pair_squared <= exact * (1.0 + 1e-9),
                "{count}: {bound:?}"
            );
        }
    }
}
