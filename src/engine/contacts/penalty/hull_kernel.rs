//! The vectorised kernel of contacts with hulls. Touching contacts are followed eight at a time. Their forces are added
//! to the bodies one by one in canonical order.
//!
//! A probe over the middle of a side that it touched before is still over that side ([`super::remembered`]). Such
//! probes are followed side by side. All others are computed one by one ([`PairGeometry`]), with the same bits.

use std::marker::PhantomData;

use glam::DVec2;

use super::apply::{Sink, account};
use super::contact::Losses;
use super::contact_list::{ContactList, lanes};
use super::follow::Touch;
use super::kernel::EvaluationTime;
use super::normal::{Approach, NormalForce};
use super::pair_law::LawTable;
use super::remembered::{Sides, TRUSTED};
use crate::contacts::geometry::{ContactEnd, PairGeometry, SideA, arms};
use crate::contacts::{DeepestOverlap, SurfacePair};
use crate::world::Bodies;
use jostle_simd::{BLOCK, Kernel, Lanes};

/// A number of each of eight contacts.
type Numbers = [f64; BLOCK];

/// Contacts that touch, and wait until there are eight of them.
#[derive(Default)]
#[repr(C, align(64))]
pub(super) struct Waiting {
    count: usize,
    /// Places in the list of contacts.
    index: [u32; BLOCK],
    law: [u32; BLOCK],
    /// Side A is a hull of the first body, side B an atom of the second.
    sides: [Sides; BLOCK],
    /// The centres of the probes in metres. Then follow the first bodies with cosine and sine of their angles, and then
    /// the second bodies.
    poses: [Numbers; 8],
    /// Of both bodies: velocity, spin, inverse mass and inertia, displacement and turn.
    motion: [[Numbers; 8]; 2],
    normal: [Numbers; 2],
    overlap: Numbers,
    /// Distances of the centres, for points that are not on a side.
    distance: Numbers,
    /// From the centres of mass of both bodies.
    arm: [[Numbers; 2]; 2],
    radius: [Numbers; 2],
    /// A bit for each whose place is on a side.
    flat: u8,
}

/// The effects of contacts on both bodies.
#[derive(Default)]
#[repr(C, align(64))]
struct Effects {
    /// On the second body, in newtons.
    force: [Numbers; 2],
    torque: [Numbers; 2],
    friction: Numbers,
    inelasticity: Numbers,
    overlap: Numbers,
    touching: u8,
}

impl Waiting {
    /// Appends a contact; returns whether the block is full.
    #[inline(always)]
    pub fn add(&mut self, bodies: &Bodies, (index, pair): (usize, SurfacePair), law: u32, sides: Sides) -> bool {
        let lane = self.count;
        (self.index[lane], self.law[lane], self.sides[lane]) = (index as u32, law, sides);
        let [first, second] = sides.bodies.map(|body| body as usize);
        let (at, pose) = (bodies.atom_place(pair.probe as usize), bodies.pose_with_hulls(first));
        let other = bodies.position[second];
        let poses = [at.x, at.y, pose.position.x, pose.position.y, pose.rotation.x, pose.rotation.y, other.x, other.y];
        for (numbers, number) in self.poses.iter_mut().zip(poses) {
            numbers[lane] = number;
        }
        for (motion, body) in self.motion.iter_mut().zip([first, second]) {
            let (velocity, (moved, turn)) = (bodies.velocity[body], bodies.displacement(body));
            let inverses = (bodies.inverse_mass(body), bodies.inverse_inertia(body));
            let own = [velocity.x, velocity.y, bodies.spin[body], inverses.0, inverses.1, moved.x, moved.y, turn];
            for (numbers, number) in motion.iter_mut().zip(own) {
                numbers[lane] = number;
            }
        }
        self.count += 1;
        self.count == BLOCK
    }

    /// Follows those that wait.
    pub fn follow<N: NormalForce>(
        &mut self,
        (list, pairs): (&mut ContactList, &[SurfacePair]),
        laws: &LawTable,
        (sink, losses): (&mut Sink, &mut Losses),
        deepest: &mut DeepestOverlap,
        evaluation_time: EvaluationTime,
    ) {
        if self.count == 0 {
            return;
        }
        let bodies = &*sink.bodies;
        let law = PhantomData::<N>;
        let effects =
            jostle_simd::run(bodies.level, Follow { waiting: self, list, pairs, laws, bodies, evaluation_time, law });
        for lane in 0..self.count {
            losses.friction += effects.friction[lane];
            losses.inelasticity += effects.inelasticity[lane];
        }
        for lane in lanes(effects.touching) {
            let Sides { bodies: [first, second], size } = self.sides[lane];
            let [first, second] = [first as usize, second as usize];
            let entity = &sink.bodies.entity;
            deepest.note(effects.overlap[lane], size, evaluation_time.time, || (entity[first], entity[second]));
            let force = DVec2::new(effects.force[0][lane], effects.force[1][lane]);
            sink.bodies.force[first] += -force;
            sink.bodies.torque[first] += effects.torque[0][lane];
            sink.bodies.force[second] += force;
            sink.bodies.torque[second] += effects.torque[1][lane];
            if sink.forces.is_some() || !(sink.bodies.dynamic[first] && sink.bodies.dynamic[second]) {
                self.account((lane, force), laws, sink);
            }
        }
        self.count = 0;
    }

    fn account(&self, (lane, force): (usize, DVec2), laws: &LawTable, sink: &mut Sink) {
        let end = |side: usize| ContactEnd {
            body: self.sides[lane].bodies[side] as usize,
            arm: DVec2::new(self.arm[side][0][lane], self.arm[side][1][lane]),
            radius: self.radius[side][lane],
        };
        let (a, b, law) = (end(0), end(1), laws.get(self.law[lane]));
        let normal = DVec2::new(self.normal[0][lane], self.normal[1][lane]);
        let arms = arms((&a, &b), normal, self.overlap[lane], law.shares());
        account(sink.bodies, (sink.rates, sink.forces.as_deref_mut()), (&a, &b), arms, force);
    }

    /// Computes the positions of the sides of one contact.
    #[inline(never)]
    fn look(&mut self, lane: usize, list: &mut ContactList, pair: SurfacePair, bodies: &Bodies) {
        let index = self.index[lane] as usize;
        let (geometry, _) = PairGeometry::near(bodies, index, pair);
        let SideA::Hull(a) = geometry.pair.a else { unreachable!("ends of walls are followed one by one") };
        let b = geometry.pair.b;
        for (side, end) in [a, b].into_iter().enumerate() {
            (self.arm[side][0][lane], self.arm[side][1][lane]) = (end.arm.x, end.arm.y);
            self.radius[side][lane] = end.radius;
        }
        (self.normal[0][lane], self.normal[1][lane]) = (geometry.pair.normal.x, geometry.pair.normal.y);
        (self.overlap[lane], self.distance[lane]) = (geometry.overlap, geometry.distance);
        self.flat = self.flat & !(1 << lane) | u8::from(geometry.is_flat()) << lane;
        if geometry.is_flat() {
            list.remembered.touch(index, bodies, pair);
        }
    }
}

/// How one side of several contacts moves.
struct Moving<V> {
    /// From the centres of mass, in metres.
    arm: (V, V),
    velocity: (V, V),
    /// See [`End::mobility`].
    mobility: V,
    /// See [`End::displacement`].
    moved: (V, V),
    turn: V,
}

impl Waiting {
    #[inline(always)]
    fn end<V: Lanes>(&self, side: usize, lane: usize, normal: (V, V)) -> Moving<V> {
        let [x, y, spin, inverse_mass, inverse_inertia, moved_x, moved_y, turn] =
            load_all::<V>(&self.motion[side], lane);
        let arm = load_both::<V>(&self.arm[side], lane);
        let (lever, bent) = (arm.0 * normal.1 - arm.1 * normal.0, V::splat(0.5) * turn * turn);
        Moving {
            arm,
            velocity: (x + -arm.1 * spin, y + arm.0 * spin),
            mobility: inverse_mass + lever * lever * inverse_inertia,
            moved: (moved_x + -arm.1 * turn + arm.0 * bent, moved_y + arm.0 * turn + arm.1 * bent),
            turn,
        }
    }
}

#[inline(always)]
fn load_both<V: Lanes>([first, second]: &[Numbers; 2], lane: usize) -> (V, V) {
    (V::load(&first[lane..]), V::load(&second[lane..]))
}

#[inline(always)]
fn load_all<V: Lanes>([a, b, c, d, e, f, g, h]: &[Numbers; 8], lane: usize) -> [V; 8] {
    let ((a, b), (c, d)) = ((V::load(&a[lane..]), V::load(&b[lane..])), (V::load(&c[lane..]), V::load(&d[lane..])));
    let ((e, f), (g, h)) = ((V::load(&e[lane..]), V::load(&f[lane..])), (V::load(&g[lane..]), V::load(&h[lane..])));
    [a, b, c, d, e, f, g, h]
}

struct Follow<'a, N> {
    waiting: &'a mut Waiting,
    list: &'a mut ContactList,
    pairs: &'a [SurfacePair],
    laws: &'a LawTable,
    bodies: &'a Bodies,
    evaluation_time: EvaluationTime,
    law: PhantomData<N>,
}

impl<N: NormalForce> Kernel for Follow<'_, N> {
    type Output = Effects;

    #[inline(always)]
    fn run<V: Lanes>(mut self) -> Effects {
        let mut effects = Effects::default();
        let (mut lane, mut over, count) = (0, 0, self.waiting.count);
        while lane < count {
            over |= self.over_sides::<V>(lane) << lane;
            lane += V::COUNT;
        }
        self.waiting.flat = over;
        let rest = ((1_u16 << count) - 1) as u8 & !over;
        for lane in lanes(rest) {
            let pair = self.pairs[self.waiting.index[lane] as usize];
            self.waiting.look(lane, self.list, pair, self.bodies);
        }
        let mut lane = 0;
        while lane < count {
            self.follow::<V>(lane, &mut effects);
            lane += V::COUNT;
        }
        effects
    }
}

impl<N: NormalForce> Follow<'_, N> {
    /// Finds out where probes are that are over the sides they touched before. Returns which are.
    #[inline(always)]
    fn over_sides<V: Lanes>(&mut self, lane: usize) -> u8 {
        let Waiting { poses, normal, overlap, arm, radius, index, .. } = &mut *self.waiting;
        let [normal_x, normal_y, corner_x, corner_y, from, to, radius_a, radius_b] =
            V::records(&self.list.remembered.records, &index[lane..]);
        let [at_x, at_y, x, y, cos, sin, other_x, other_y] = load_all::<V>(poses, lane);
        let away = (at_x - x, at_y - y);
        let local = (cos * away.0 + sin * away.1, cos * away.1 - sin * away.0);
        let from_corner = (local.0 - corner_x, local.1 - corner_y);
        let height = normal_x * from_corner.0 + normal_y * from_corner.1;
        let along = normal_x * from_corner.1 - normal_y * from_corner.0;
        let over = along.gt(from) & along.lt(to) & height.gt(V::splat(TRUSTED) * (to - from));
        let world = (cos * normal_x - sin * normal_y, sin * normal_x + cos * normal_y);
        world.0.store(&mut normal[0][lane..]);
        world.1.store(&mut normal[1][lane..]);
        (radius_a + radius_b - height).store(&mut overlap[lane..]);
        (away.0 - world.0 * height).store(&mut arm[0][0][lane..]);
        (away.1 - world.1 * height).store(&mut arm[0][1][lane..]);
        (at_x - other_x).store(&mut arm[1][0][lane..]);
        (at_y - other_y).store(&mut arm[1][1][lane..]);
        radius_a.store(&mut radius[0][lane..]);
        radius_b.store(&mut radius[1][lane..]);
        V::bits(over) & ((1_u16 << V::COUNT) - 1) as u8
    }

    /// Contacts follow the motion of their sides from a lane on.
    #[inline(always)]
    fn follow<V: Lanes>(&mut self, lane: usize, effects: &mut Effects) {
        let waiting = &*self.waiting;
        let law = self.laws.lanes::<V>(&waiting.law[lane..]);
        let (normal, overlap) = (load_both::<V>(&waiting.normal, lane), V::load(&waiting.overlap[lane..]));
        let (radius_a, radius_b) = load_both::<V>(&waiting.radius, lane);
        let (a, b) = (waiting.end::<V>(0, lane, normal), waiting.end::<V>(1, lane, normal));
        let mut approach = Approach { parting: V::splat(0.0), mobility: V::splat(0.0) };
        if N::DEPENDS_ON_VELOCITY {
            let velocity = (b.velocity.0 - a.velocity.0, b.velocity.1 - a.velocity.1);
            approach.parting = velocity.0 * normal.0 + velocity.1 * normal.1;
            approach.mobility = a.mobility + b.mobility;
        }
        let displacement = (b.moved.0 - a.moved.0, b.moved.1 - a.moved.1);
        let distance = V::load(&waiting.distance[lane..]);
        let around = (normal.0 * displacement.1 - normal.1 * displacement.0) / distance;
        let around = V::select(distance.lt(V::splat(0.0)), V::splat(0.0), around);
        let swing = V::select(V::mask(waiting.flat >> lane), a.turn, around);
        let (rolled_a, rolled_b) = ((radius_a, a.turn), (radius_b, b.turn));
        let touch = Touch { normal, overlap, approach, displacement, swing, rolled_a, rolled_b };
        let among = (((1_u16 << waiting.count.min(lane + V::COUNT)) - 1) >> lane) as u8;
        let indices = &waiting.index[lane..];
        let mut contacts = self.list.gather::<V>(indices);
        let lost = contacts.follow::<N>(&law, &touch, self.evaluation_time.elapsed, V::mask(among));
        self.list.scatter(indices, among, &contacts);
        lost.friction.store(&mut effects.friction[lane..]);
        lost.inelasticity.store(&mut effects.inelasticity[lane..]);
        contacts.overlap.store(&mut effects.overlap[lane..]);
        effects.touching |= (V::bits(contacts.loading | contacts.unloading) & among) << lane;
        let (pressed, pulled) = (contacts.normal_force, contacts.tangential_force(&law));
        let force = (normal.0 * pressed + normal.1 * pulled, normal.1 * pressed - normal.0 * pulled);
        force.0.store(&mut effects.force[0][lane..]);
        force.1.store(&mut effects.force[1][lane..]);
        let reach = (radius_a - law.share_a * overlap, radius_b - law.share_b * overlap);
        let at_a = (a.arm.0 + normal.0 * reach.0, a.arm.1 + normal.1 * reach.0);
        let at_b = (b.arm.0 - normal.0 * reach.1, b.arm.1 - normal.1 * reach.1);
        (at_a.0 * -force.1 - at_a.1 * -force.0).store(&mut effects.torque[0][lane..]);
        (at_b.0 * force.1 - at_b.1 * force.0).store(&mut effects.torque[1][lane..]);
    }
}
