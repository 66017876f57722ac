//! A plain loop for comparison: discs, walls, springs with dashpots, friction, velocity Verlet. It has no ECS, no
//! accounts, no rest and no vector instructions, like the work of an afternoon. It starts from the same state as the
//! engine and runs beside it.
//!
//! Arrays of numbers, a grid of cells, a half list of pairs with a skin. A touching pair has overlap `d`, parting speed
//! `v` and elongation `s` of the tangential spring. Its forces are `N = max(0, k d - c v)` and `T = k_t s`, where `s`
//! follows the sliding of the surfaces and `|T| <= mu N`. All pairs of a scene have the coefficients of its mean atom.
//! The comparison is of work, and runs stay alike only if the scene has one material. Forces see velocities at the
//! middle of the tick.

use glam::DVec2;

use super::grid::Cells;
use jostle_engine::contacts::penalty::{NormalLaw, Penalty, PenaltyState, RollingLaw};
use jostle_engine::contacts::penalty::{inelasticity_of, restitution_of};
use jostle_engine::integrate::ChosenMethod;
use jostle_engine::simulation::Simulation;
use jostle_engine::tick::State;
use jostle_engine::world::{Bodies, Materials, PackedWall};

/// The skin, as a share of the smallest radius. Nearer pairs are listed, and the list is renewed when an atom has moved
/// by half of the skin.
const SKIN: f64 = 0.35;

/// The moving parts: one number of each kind per body, or per atom.
#[derive(Default)]
struct Movers {
    x: Vec<f64>,
    y: Vec<f64>,
    angle: Vec<f64>,
    vx: Vec<f64>,
    vy: Vec<f64>,
    spin: Vec<f64>,
    fx: Vec<f64>,
    fy: Vec<f64>,
    torque: Vec<f64>,
    inverse_mass: Vec<f64>,
    inverse_inertia: Vec<f64>,
}

/// Bodies of several atoms: the atoms follow them.
struct Clumps {
    bodies: Movers,
    first_atom: Vec<u32>,
    offset: Vec<DVec2>,
}

/// Coefficients of a contact.
#[derive(Clone, Copy)]
struct Law {
    stiffness: f64,
    damping: f64,
    friction: f64,
    tangential_stiffness: f64,
}

/// An atom near a wall.
struct NearWall {
    wall: usize,
    atom: usize,
    elongation: f64,
}

/// The loop with its state.
pub struct Plain {
    dt: f64,
    gravity: DVec2,
    pair: Law,
    wall: Law,
    atoms: Movers,
    radius: Vec<f64>,
    body: Vec<u32>,
    clumps: Option<Clumps>,
    walls: Vec<PackedWall>,
    skin: f64,
    /// The positions of atoms when the lists were made; infinite before the first list.
    listed_x: Vec<f64>,
    listed_y: Vec<f64>,
    /// The first pair of each atom, and the number of pairs at the end.
    first: Vec<u32>,
    other: Vec<u32>,
    elongation: Vec<f64>,
    near_walls: Vec<NearWall>,
}

impl Plain {
    /// The loop at the present state of a scene.
    ///
    /// # Errors
    /// The error names a property of the scene that the loop does not support.
    pub fn of(simulation: &Simulation) -> Result<Self, &'static str> {
        let (world, bodies) = (simulation.unpublished_world(), simulation.bodies());
        if !simulation.header().outline.entries("forces").is_empty() {
            return Err("it has forces beside gravity and contacts");
        }
        let verlet = |method: &ChosenMethod| method.name == "VelocityVerlet" && !method.mode.is_staged();
        if !world.get_resource::<ChosenMethod>().is_some_and(verlet) {
            return Err("its method is not velocity Verlet in whole ticks");
        }
        let penalty = world.resource::<State>().model::<PenaltyState>().ok_or("its contacts are not `Penalty`")?;
        let penalty = penalty.settings();
        if penalty.rolling != RollingLaw::None {
            return Err("it has resistance against rolling");
        }
        if !bodies.belts.is_empty() {
            return Err("it has belts");
        }
        if (0..bodies.len()).any(|body| bodies.moves[body] && !bodies.dynamic[body]) {
            return Err("it has bodies that move as prescribed");
        }
        if bodies.collides.iter().any(|collides| !collides) {
            return Err("it has bodies that touch nothing");
        }
        let (pair, wall) = laws(bodies, penalty, world.resource::<Materials>());
        let of_bodies = Movers::of(bodies);
        let (atoms, clumps) = if bodies.lone_discs {
            (of_bodies, None)
        } else {
            let atoms = Movers::with_length(bodies.atom_count());
            let first = |body| bodies.atoms_of(body).start as u32;
            let first_atom = (0..bodies.len()).map(first).chain([bodies.atom_count() as u32]).collect();
            let offset = (0..bodies.atom_count()).map(|atom| bodies.atom_offset(atom)).collect();
            (atoms, Some(Clumps { bodies: of_bodies, first_atom, offset }))
        };
        let count = bodies.atom_count();
        let mut plain = Self {
            dt: simulation.clock().dt,
            gravity: world.resource::<State>().gravity(),
            pair,
            wall,
            atoms,
            radius: bodies.atom_radius.clone(),
            body: (0..count).map(|atom| bodies.atom_body(atom) as u32).collect(),
            clumps,
            walls: bodies.walls.clone(),
            skin: SKIN * bodies.smallest_radius,
            listed_x: vec![f64::INFINITY; count],
            listed_y: vec![f64::INFINITY; count],
            first: vec![0; count + 1],
            other: Vec::new(),
            elongation: Vec::new(),
            near_walls: Vec::new(),
        };
        plain.evaluate(0.0);
        Ok(plain)
    }

    /// Runs some ticks.
    pub fn run(&mut self, ticks: u64) {
        for _ in 0..ticks {
            let (dt, gravity) = (self.dt, self.gravity);
            let movers = self.clumps.as_mut().map_or(&mut self.atoms, |clumps| &mut clumps.bodies);
            movers.kick(dt / 2.0, gravity);
            movers.drift(dt);
            self.evaluate(dt);
            let movers = self.clumps.as_mut().map_or(&mut self.atoms, |clumps| &mut clumps.bodies);
            movers.kick(dt / 2.0, gravity);
        }
    }

    /// Forces at the present places; tangential springs follow what slid in `dt`.
    fn evaluate(&mut self, dt: f64) {
        if let Some(clumps) = &self.clumps {
            clumps.spread(&mut self.atoms);
        }
        if self.lists_are_old() {
            self.list();
        }
        self.atoms.clear();
        self.touch_pairs(dt);
        self.touch_walls(dt);
        if let Some(clumps) = &mut self.clumps {
            clumps.gather(&self.atoms);
        }
    }

    fn lists_are_old(&self) -> bool {
        let far = self.skin * self.skin / 4.0;
        (0..self.radius.len()).any(|atom| {
            let (dx, dy) = (self.atoms.x[atom] - self.listed_x[atom], self.atoms.y[atom] - self.listed_y[atom]);
            dx * dx + dy * dy > far
        })
    }

    /// Renews the lists of pairs and of atoms near walls. Touching pairs keep their springs.
    fn list(&mut self) {
        self.listed_x.clone_from(&self.atoms.x);
        self.listed_y.clone_from(&self.atoms.y);
        let largest = self.radius.iter().copied().fold(0.0, f64::max);
        let cells = Cells::new(&self.atoms.x, &self.atoms.y, 2.0 * largest + self.skin);
        let (old_first, old_other) = (self.first.clone(), std::mem::take(&mut self.other));
        let old_elongation = std::mem::take(&mut self.elongation);
        for a in 0..self.radius.len() {
            self.first[a] = self.other.len() as u32;
            let before = old_first[a] as usize..old_first[a + 1] as usize;
            cells.near(self.atoms.x[a], self.atoms.y[a], |b| {
                if (b as usize) <= a || self.body[b as usize] == self.body[a] {
                    return;
                }
                let (dx, dy) = (self.atoms.x[b as usize] - self.atoms.x[a], self.atoms.y[b as usize] - self.atoms.y[a]);
                let reach = self.radius[a] + self.radius[b as usize] + self.skin;
                if dx * dx + dy * dy < reach * reach {
                    let old = before.clone().find(|&place| old_other[place] == b);
                    self.other.push(b);
                    self.elongation.push(old.map_or(0.0, |place| old_elongation[place]));
                }
            });
        }
        let last = self.radius.len();
        self.first[last] = self.other.len() as u32;
        let old = std::mem::take(&mut self.near_walls);
        for (number, wall) in self.walls.iter().enumerate() {
            for atom in 0..last {
                let place = DVec2::new(self.atoms.x[atom], self.atoms.y[atom]);
                if (place - wall.point).dot(wall.normal) < self.radius[atom] + self.skin {
                    let known = old.binary_search_by_key(&(number, atom), |near| (near.wall, near.atom));
                    let elongation = known.map_or(0.0, |place| old[place].elongation);
                    self.near_walls.push(NearWall { wall: number, atom, elongation });
                }
            }
        }
    }

    fn touch_pairs(&mut self, dt: f64) {
        let Self { atoms, radius, first, other, elongation, pair, .. } = self;
        for a in 0..radius.len() {
            let (xa, ya, ra) = (atoms.x[a], atoms.y[a], radius[a]);
            let (vxa, vya, rolling_a) = (atoms.vx[a], atoms.vy[a], atoms.spin[a] * ra);
            let (mut fx, mut fy, mut turning) = (0.0, 0.0, 0.0);
            for index in first[a] as usize..first[a + 1] as usize {
                let b = other[index] as usize;
                let (dx, dy) = (atoms.x[b] - xa, atoms.y[b] - ya);
                let reach = ra + radius[b];
                let square = dx * dx + dy * dy;
                if square >= reach * reach {
                    elongation[index] = 0.0;
                    continue;
                }
                let distance = square.sqrt();
                let (nx, ny) = (dx / distance, dy / distance);
                let (vx, vy) = (atoms.vx[b] - vxa, atoms.vy[b] - vya);
                let parting = vx * nx + vy * ny;
                let sliding = vy * nx - vx * ny - rolling_a - atoms.spin[b] * radius[b];
                let (push, drag) = pair.touch(reach - distance, parting, sliding * dt, &mut elongation[index]);
                let (gx, gy) = (-push * nx - drag * ny, -push * ny + drag * nx);
                fx += gx;
                fy += gy;
                turning += drag;
                atoms.fx[b] -= gx;
                atoms.fy[b] -= gy;
                atoms.torque[b] += drag * radius[b];
            }
            atoms.fx[a] += fx;
            atoms.fy[a] += fy;
            atoms.torque[a] += turning * ra;
        }
    }

    fn touch_walls(&mut self, dt: f64) {
        let Self { atoms, radius, walls, near_walls, wall: law, .. } = self;
        for near in near_walls {
            let (wall, atom) = (&walls[near.wall], near.atom);
            let place = DVec2::new(atoms.x[atom], atoms.y[atom]);
            let overlap = radius[atom] - (place - wall.point).dot(wall.normal);
            if overlap <= 0.0 {
                near.elongation = 0.0;
                continue;
            }
            // The wall is side B: the normal from the atom to it points into it.
            let normal = -wall.normal;
            let velocity = -DVec2::new(atoms.vx[atom], atoms.vy[atom]);
            let sliding = normal.perp_dot(velocity) - atoms.spin[atom] * radius[atom];
            let (push, drag) = law.touch(overlap, velocity.dot(normal), sliding * dt, &mut near.elongation);
            let force = -push * normal + drag * normal.perp();
            atoms.fx[atom] += force.x;
            atoms.fy[atom] += force.y;
            atoms.torque[atom] += drag * radius[atom];
        }
    }

    /// Kinetic energy, in J.
    pub fn kinetic_energy(&self) -> f64 {
        let movers = self.clumps.as_ref().map_or(&self.atoms, |clumps| &clumps.bodies);
        let moving = (0..movers.x.len()).filter(|&body| movers.inverse_mass[body] > 0.0);
        let energy = |body: usize| {
            let square = movers.vx[body] * movers.vx[body] + movers.vy[body] * movers.vy[body];
            let turning = movers.spin[body] * movers.spin[body] / movers.inverse_inertia[body];
            (square / movers.inverse_mass[body] + turning) / 2.0
        };
        moving.map(energy).sum()
    }
}

impl Law {
    /// Normal force, and tangential force on side A along the normal turned by a quarter turn.
    #[inline]
    fn touch(&self, overlap: f64, parting: f64, slid: f64, elongation: &mut f64) -> (f64, f64) {
        let push = (self.stiffness * overlap - self.damping * parting).max(0.0);
        let (most, drag) = (self.friction * push, self.tangential_stiffness * (*elongation + slid));
        if drag.abs() <= most {
            *elongation += slid;
            return (push, drag);
        }
        let drag = most.copysign(drag);
        *elongation = if self.tangential_stiffness > 0.0 { drag / self.tangential_stiffness } else { 0.0 };
        (push, drag)
    }
}

impl Movers {
    fn with_length(count: usize) -> Self {
        let zeros = || vec![0.0; count];
        Self {
            x: zeros(),
            y: zeros(),
            angle: zeros(),
            vx: zeros(),
            vy: zeros(),
            spin: zeros(),
            fx: zeros(),
            fy: zeros(),
            torque: zeros(),
            inverse_mass: zeros(),
            inverse_inertia: zeros(),
        }
    }

    fn of(bodies: &Bodies) -> Self {
        Self {
            x: bodies.position.iter().map(|place| place.x).collect(),
            y: bodies.position.iter().map(|place| place.y).collect(),
            angle: bodies.angle.clone(),
            vx: bodies.velocity.iter().map(|velocity| velocity.x).collect(),
            vy: bodies.velocity.iter().map(|velocity| velocity.y).collect(),
            spin: bodies.spin.clone(),
            inverse_mass: (0..bodies.len()).map(|body| bodies.inverse_mass(body)).collect(),
            inverse_inertia: (0..bodies.len()).map(|body| bodies.inverse_inertia(body)).collect(),
            ..Self::with_length(bodies.len())
        }
    }

    fn clear(&mut self) {
        for values in [&mut self.fx, &mut self.fy, &mut self.torque] {
            values.fill(0.0);
        }
    }

    fn kick(&mut self, dt: f64, gravity: DVec2) {
        for body in 0..self.x.len() {
            // Fixed bodies have no inverse mass, and do not fall.
            if self.inverse_mass[body] > 0.0 {
                self.vx[body] += (self.fx[body] * self.inverse_mass[body] + gravity.x) * dt;
                self.vy[body] += (self.fy[body] * self.inverse_mass[body] + gravity.y) * dt;
                self.spin[body] += self.torque[body] * self.inverse_inertia[body] * dt;
            }
        }
    }

    fn drift(&mut self, dt: f64) {
        for body in 0..self.x.len() {
            self.x[body] += self.vx[body] * dt;
            self.y[body] += self.vy[body] * dt;
            self.angle[body] += self.spin[body] * dt;
        }
    }
}

impl Clumps {
    /// Puts the atoms where their bodies are.
    fn spread(&self, atoms: &mut Movers) {
        let bodies = &self.bodies;
        for body in 0..bodies.x.len() {
            let (sine, cosine) = libm::sincos(bodies.angle[body]);
            for atom in self.first_atom[body] as usize..self.first_atom[body + 1] as usize {
                let offset = self.offset[atom];
                let (x, y) = (cosine * offset.x - sine * offset.y, sine * offset.x + cosine * offset.y);
                atoms.x[atom] = bodies.x[body] + x;
                atoms.y[atom] = bodies.y[body] + y;
                atoms.vx[atom] = bodies.vx[body] - bodies.spin[body] * y;
                atoms.vy[atom] = bodies.vy[body] + bodies.spin[body] * x;
                atoms.spin[atom] = bodies.spin[body];
            }
        }
    }

    /// Sums the forces of the atoms.
    fn gather(&mut self, atoms: &Movers) {
        let bodies = &mut self.bodies;
        for body in 0..bodies.x.len() {
            let (mut fx, mut fy, mut torque) = (0.0, 0.0, 0.0);
            for atom in self.first_atom[body] as usize..self.first_atom[body + 1] as usize {
                let (x, y) = (atoms.x[atom] - bodies.x[body], atoms.y[atom] - bodies.y[body]);
                fx += atoms.fx[atom];
                fy += atoms.fy[atom];
                torque += atoms.torque[atom] + x * atoms.fy[atom] - y * atoms.fx[atom];
            }
            (bodies.fx[body], bodies.fy[body], bodies.torque[body]) = (fx, fy, torque);
        }
    }
}

/// The laws of pairs and of walls, for the mean atom and the mean body.
fn laws(bodies: &Bodies, penalty: &Penalty, materials: &Materials) -> (Law, Law) {
    let count = bodies.atom_count().max(1) as f64;
    let mean = |of: &dyn Fn(usize) -> f64| (0..bodies.atom_count()).map(of).sum::<f64>() / count;
    let material = |atom: usize| &materials.by_index[bodies.atom_material(atom).index()];
    let stiffness = mean(&|atom| bodies.atom_stiffness(atom));
    let friction = mean(&|atom| material(atom).friction_dynamic);
    let inelasticity = mean(&|atom| inelasticity_of(material(atom).rebound));
    let moving: Vec<f64> = (0..bodies.len()).filter(|&b| bodies.dynamic[b]).map(|b| bodies.mass[b]).collect();
    let mass = moving.iter().sum::<f64>() / moving.len().max(1) as f64;
    let ratio = penalty.tangential.ratio();
    let law = |stiffness: f64, mass: f64| {
        let damping = match (penalty.normal, penalty.damping, penalty.damping_rate) {
            (NormalLaw::Dashpot, Some(damping), _) => damping.si(),
            (NormalLaw::Dashpot, _, Some(rate)) => rate.si() * mass,
            // A dashpot with this restitution, except for the force at the end of a touch.
            _ => {
                let log = libm::log(restitution_of(inelasticity).max(0.01));
                -2.0 * log / (std::f64::consts::PI.powi(2) + log * log).sqrt() * (stiffness * mass).sqrt()
            }
        };
        let friction = if ratio.is_some() { friction } else { 0.0 };
        Law { stiffness, damping, friction, tangential_stiffness: ratio.unwrap_or(0.0) * stiffness }
    };
    (law(stiffness / 2.0, mass / 2.0), law(stiffness, mass))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SimulationExt;
    use jostle_engine::scene::Source;
    use jostle_engine::simulation::Simulation;

    fn loaded(scene: &str) -> (Simulation, Plain) {
        let text = format!("Scene(format: 1, clock: (duration: 1, tick: \"0.1 ms\", method: VelocityVerlet), {scene})");
        let simulation = Simulation::load(&Source::new("a.ron", text)).unwrap_or_else(|errors| panic!("{errors}"));
        let plain = Plain::of(&simulation).unwrap();
        (simulation, plain)
    }

    /// Without loss both make the same ticks of the same forces, in another order of sums. The difference is rounding
    /// that collisions magnify. Each magnifies by the flight over the radius (ten, here), a handful of times: 1e-16
    /// times 1e6.
    #[test]
    fn without_loss_it_is_the_engine() {
        let (mut simulation, mut plain) = loaded(
            "gravity: (0, -9.81), materials: { \"m\": (stiffness: 1e4, density: 100) },
             walls: [(name: \"floor\", left: (2, 0), right: (0, 0), material: \"m\"), (name: \"left\", left: (0, 0), right: (0, 1), material: \"m\"),
                     (name: \"right\", left: (2, 1), right: (2, 0), material: \"m\")],
             fill: [(name: \"gas\", atoms: Picture(spacing: 0.05, rows: [\"##\", \"#.\"]), material: \"m\", count: 40, within: ((0, 0), (2, 1)), speed: 1)],
             contacts: Penalty(tangential: None)",
        );
        simulation.run_to_tick(2000).unwrap();
        plain.run(2000);
        let bodies = simulation.bodies();
        let clumps = &plain.clumps.as_ref().unwrap().bodies;
        for body in 0..bodies.len() {
            let off = bodies.position[body] - DVec2::new(clumps.x[body], clumps.y[body]);
            assert!(off.length() < 1e-10, "{body}: {off}");
        }
        let deepest = simulation.card().largest_overlap.meters;
        assert!(deepest > 1e-4, "nothing collided");
    }

    /// A sliding disc ends up rolling with two thirds of its speed for every friction and stiffness. The reason is that
    /// the angular momentum about the floor is constant. The tangential spring keeps the elongation `mu N / k_t` and
    /// swings on without damping. The swing is that times `sqrt(3 k_t / m)` along the surface. The motion of the centre
    /// has a third of it, and the turn two thirds. A tenth more is for the weight, which the disc begins to bear a
    /// little out of balance.
    #[test]
    fn a_sliding_disc_comes_to_roll() {
        let (_, mut plain) = loaded(
            "gravity: (0, -10), materials: { \"m\": (stiffness: 1e5, friction: 0.5, restitution: 0.5) },
             walls: [(name: \"floor\", left: (2, 0), right: (0, 0), material: \"m\")],
             bodies: [(name: \"b\", at: (0, 0.0999), atoms: Disc(radius: 0.1, mass: 1), velocity: (3, 0), material: \"m\")],
             contacts: Penalty(tangential: Spring(ratio: 0.8))",
        );
        plain.run(10_000);
        let stiffness = 0.8 * 1e5;
        let swing = 1.1 * 0.5 * 10.0 / stiffness * f64::sqrt(3.0 * stiffness);
        assert!((plain.atoms.vx[0] - 2.0).abs() < swing / 3.0, "{} {swing}", plain.atoms.vx[0]);
        assert!((plain.atoms.spin[0] * 0.1 + 2.0).abs() < swing * 2.0 / 3.0, "{} {swing}", plain.atoms.spin[0]);
    }

    /// A spring with a dashpot that never pulls: `e = exp(-b t)` with `t = atan2(2 b w, b^2 - w^2)/w`, Schwager and
    /// Poeschel 2007. Forces see velocities half a tick old, so the damping is off by `c dt/(2 m)`, 0.003 of it. A
    /// hundredth is allowed.
    #[test]
    fn a_dashpot_restitutes_as_it_should() {
        let (_, mut plain) = loaded(
            "materials: { \"m\": (stiffness: 2e4) },
             bodies: [(name: \"a\", at: (0, 0), atoms: Disc(radius: 0.1, mass: 1), velocity: (1, 0), material: \"m\"),
                      (name: \"b\", at: (0.3, 0), atoms: Disc(radius: 0.1, mass: 1), material: \"m\")],
             contacts: Penalty(normal: Dashpot, damping: 30)",
        );
        let (b, square) = (30.0 / (2.0 * 0.5), 1e4 / 0.5 - 900.0);
        let w = f64::sqrt(square);
        let expected = libm::exp(-b * libm::atan2(2.0 * b * w, b * b - square) / w);
        plain.run(5000);
        let found = plain.atoms.vx[1] - plain.atoms.vx[0];
        assert!((found - expected).abs() < 0.01 * expected, "{found} {expected}");
    }
}
