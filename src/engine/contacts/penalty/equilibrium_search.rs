//! The search for places in which the springs of contacts bear all loads. It is Newton's method on the forces of islands, with the
//! springs that touch ([`crate::constraints::spring_network`]). Friction and rolling resistance are springs too. Beyond their cones they
//! slip, and keep the force of the cone (return mapping, Simo and Hughes 1998).
//!
//! If no contact holds bodies in some direction, they accelerate along it, and springs bear the rest. Springs of the scene hold no
//! body in place. If one is drawn at the start, its body moves from there. Friction that slips then has the dynamic coefficient. It
//! slips along the acceleration, or it sticks again.
//!
//! The first round takes all that touches as held, because no force says yet what opens or slips. Each later round takes the
//! contacts that are compressed and the friction that holds. Work and rounds are bounded.

use glam::DVec2;

use super::begun::Begun;
use super::equilibrium_joint::JointRow;
use super::equilibrium_part::{Candidate, Part, Round, Sides, of_scene};
use crate::constraints::Row;
use crate::constraints::islands::Islands;
use crate::constraints::spring_network::{self, NetworkSpring, Relief, Twist, Unsolved, solve_beyond};
use crate::contacts::CandidatePairs;
use crate::tick::{State, SteadySpring};
use crate::world::Bodies;

/// Rounds of Newton's method. The contacts that open and slip are known after a few. The cone of friction that slips follows the
/// normal force of the round before. Then each round reduces the rest by a factor.
const ROUNDS: usize = 60;

/// Rounds behind these, for islands in which friction slips to and fro. Each takes part of its step.
const CAREFUL_ROUNDS: usize = 60;

/// Products of all islands with their springs, each counted once for each spring: a quarter of a second.
const WORK: usize = 1 << 24;

/// Rounds in which friction that slips is taken as held, because no other spring holds a body.
const RETRIES: usize = 8;

/// The forces on a body balance up to this share: rounding of their sum.
const BALANCED: f64 = 1e-12;

/// The same if rounding of far places leaves no better balance. From round to round it does not halve any more.
const NEARLY: f64 = 1e-7;

/// A careful round that leaves more than this share of the unbalanced forces has gone too far. A spring slipped to one side, and slips
/// back. From then on each round takes a smaller part of its step.
const NO_BETTER: f64 = 0.9;

/// The least part of a step. Sixty such steps reduce the rest to 1e-8.
const LEAST_STEP: f64 = 0.25;

/// Overlaps that differ by less than this share bear the same load.
const SAME: f64 = 1e-9;

/// The result for an island.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// The search goes on.
    Open,
    /// Bodies stand in equilibrium, and have moved for it.
    Found,
    /// Bodies stand as the scene places them.
    AsPlaced,
    /// The search has come to its bound. Bodies stand as the scene places them.
    Bound,
}

/// Bodies that touch each other, directly or through others.
pub(super) struct IslandSearch {
    members: Vec<usize>,
    parts: Vec<Part>,
    joints: Vec<JointRow>,
    /// Places and angles at the start.
    start: Vec<(DVec2, f64)>,
    by: Vec<Twist>,
    retries: usize,
    /// Whether nothing holds it in some direction, so that it accelerates.
    moves: bool,
    /// The greatest unbalanced force of the round before, as a share of all forces on its body.
    left: f64,
    /// The share of a step that is taken.
    step: f64,
    holds_as_placed: bool,
    pub outcome: Outcome,
}

/// A body that belongs to no island.
const NONE: u32 = u32::MAX;

/// The search among all islands.
pub(super) struct Search {
    /// How far in metres a body may go.
    reach: f64,
    /// Whether the normal force may have several values at rest.
    set_valued: bool,
    touching: Vec<Part>,
    islands: Vec<IslandSearch>,
    /// Contacts of bodies that joints move.
    jointed: Vec<Begun>,
    /// For each body its island, and its index there.
    place: Vec<(u32, u32)>,
    springs: Vec<SteadySpring>,
    work: usize,
}

impl Search {
    pub fn new(reach: f64, set_valued: bool) -> Self {
        let (touching, islands, jointed, place, springs) = Default::default();
        Self { reach, set_valued, touching, islands, jointed, place, springs, work: WORK }
    }

    /// Takes up a pair that touches.
    pub fn add(&mut self, candidate: &Candidate) {
        self.touching.push(candidate.part());
    }

    /// Whether any pair touches.
    pub fn some_touch(&self) -> bool {
        !self.touching.is_empty()
    }

    /// Sorts the touching pairs into islands, with the rows of all joints.
    pub fn gather(&mut self, bodies: &Bodies, mut rows: Vec<JointRow>) {
        let mut links = std::mem::take(&mut self.touching);
        let mut sorted = Islands::default();
        sorted.sort(&mut links, &mut rows, bodies);
        let mut rows = rows.into_iter().peekable();
        self.place = vec![(NONE, 0); bodies.len()];
        let mut links = links.into_iter().peekable();
        while let Some(first) = links.next() {
            let root = sorted.of(&first, bodies);
            let mut parts = vec![first];
            while let Some(next) = links.next_if(|next| sorted.of(next, bodies) == root) {
                parts.push(next);
            }
            while rows.next_if(|row| sorted.of(row, bodies) < root).is_some() {}
            let mut joints = Vec::new();
            while let Some(row) = rows.next_if(|row| sorted.of(row, bodies) == root) {
                joints.push(row);
            }
            let ends = parts.iter().flat_map(|part| [Some(part.own), part.other]).flatten();
            let ends = ends.chain(joints.iter().flat_map(JointRow::bodies));
            let mut members: Vec<usize> = ends.filter(|&body| bodies.dynamic[body]).collect();
            members.sort_unstable();
            members.dedup();
            let stand = parts.iter().all(|part| part.still) && joints.iter().all(|joint| joint.stands(bodies));
            if !stand && !joints.is_empty() {
                self.jointed.extend(parts.iter().filter_map(|part| part.as_placed(self.set_valued)));
            }
            if !stand {
                continue;
            }
            if !joints.is_empty() {
                let mut sums = vec![0.0; members.len()];
                for part in &parts {
                    let ends = [Some(part.own), part.other].into_iter().flatten();
                    ends.flat_map(|body| members.binary_search(&body)).for_each(|end| sums[end] += part.law.stiffness);
                }
                let stiffest = sums.into_iter().fold(0.0, f64::max);
                joints.iter_mut().for_each(|joint| joint.stiffen(stiffest, bodies));
            }
            for (index, &body) in members.iter().enumerate() {
                self.place[body] = (self.islands.len() as u32, index as u32);
            }
            let start = members.iter().map(|&body| (bodies.position[body], bodies.angle[body])).collect();
            let by = vec![Twist::default(); members.len()];
            self.islands.push(IslandSearch {
                members,
                parts,
                joints,
                start,
                by,
                retries: 0,
                moves: false,
                left: f64::INFINITY,
                step: 1.0,
                holds_as_placed: false,
                outcome: Outcome::Open,
            });
        }
    }

    /// Whether a body belongs to an island to be searched.
    pub fn has(&self, body: usize) -> bool {
        self.place[body].0 != NONE
    }

    /// Takes up a pair that does not touch, in the islands of both sides.
    pub fn add_near(&mut self, candidate: &Candidate) {
        let part = candidate.part();
        let of = |body: Option<usize>| body.map_or(NONE, |body| self.place[body].0);
        let (a, b) = (of(part.other), of(Some(part.own)));
        for island in if a == b { [a, NONE] } else { [a, b] } {
            if island != NONE {
                self.islands[island as usize].parts.push(candidate.part());
            }
        }
    }

    /// Whether there is an island to be searched.
    pub fn is_needed(&self) -> bool {
        !self.islands.is_empty()
    }

    pub fn islands(&self) -> &[IslandSearch] {
        &self.islands
    }

    /// Contacts of bodies that joints move. They are there at the start and may rest: of all forces they begin with that of their spring.
    pub fn jointed(&self) -> &[Begun] {
        &self.jointed
    }

    /// Moves the bodies of all islands into their equilibria, as far as there are any. `loads` are those at the start.
    pub fn run(&mut self, state: &mut State, pairs: &CandidatePairs, loads: &mut Vec<Twist>) {
        state.models().for_each(|model| model.stiffness(state, &mut self.springs));
        let mut islands = std::mem::take(&mut self.islands);
        let joined = islands.iter().any(|island| !island.joints.is_empty());
        let least_room = state.least_room_at_start();
        for round in 0..ROUNDS + CAREFUL_ROUNDS {
            if round > 0 {
                state.loads_at_start(loads);
            }
            let rows = if joined { state.joint_rows_at_start() } else { Vec::new() };
            let mut open = false;
            for (number, island) in islands.iter_mut().enumerate().filter(|(_, island)| island.outcome == Outcome::Open)
            {
                self.improve((number as u32, island), &mut state.bodies, pairs, (loads, &rows), round);
                open |= island.outcome == Outcome::Open;
            }
            if !open {
                break;
            }
        }
        for island in &mut islands {
            if island.outcome == Outcome::Open {
                island.leave(Outcome::Bound, &mut state.bodies);
            }
        }
        if state.least_room_at_start() < least_room.min(0.0) {
            // A joint beyond its limit would spring back, and a rope beyond its length.
            islands.iter_mut().for_each(|island| island.leave(Outcome::AsPlaced, &mut state.bodies));
        }
        self.islands = islands;
        // Atoms follow the places in which bodies stay.
        state.loads_at_start(loads);
    }

    /// A round of Newton's method on an island.
    fn improve(
        &mut self,
        (number, island): (u32, &mut IslandSearch),
        bodies: &mut Bodies,
        pairs: &CandidatePairs,
        (loads, rows): (&[Twist], &[Row]),
        round: usize,
    ) {
        let (first, careful) = (round == 0, round >= ROUNDS);
        let phase = if first {
            Round::First
        } else if island.moves {
            Round::Moving
        } else {
            Round::Resting
        };
        if island.joints.iter_mut().any(|joint| joint.look(rows).is_none()) {
            return island.leave(Outcome::Bound, bodies);
        }
        let IslandSearch { members, parts, joints, .. } = island;
        let mut forces: Vec<Twist> = members.iter().map(|&body| loads[body]).collect();
        let extent = |body: usize| bodies.extent(body).max(f64::MIN_POSITIVE);
        let own = |body: usize| loads[body].linear.length() + loads[body].angular.abs() / extent(body);
        // The sum of all forces on each body, and what rounding makes of them.
        let mut sizes: Vec<(f64, f64)> = members.iter().map(|&body| (own(body), 0.0)).collect();
        let index =
            |body: usize| Some(self.place[body]).filter(|place| place.0 == number).map(|place| place.1 as usize);
        let mut springs = Vec::with_capacity(parts.len());
        // Rounding of those forces where walls begin far away.
        let mut rounds = vec![0.0; members.len()];
        for part in &mut *parts {
            let geometry = part.geometry(bodies, pairs);
            part.look(&geometry, bodies, phase);
            let sides = Sides::of(&geometry, &part.law, index);
            let normal = geometry.pair.normal;
            springs.push(part.springs(&sides, normal));
            if !part.now.closed {
                continue;
            }
            sides.push(&mut forces, normal * part.now.normal - normal.perp() * part.now.tangential);
            sides.twist(&mut forces, part.now.rolling);
            let noise = part.now.noise * part.law.stiffness;
            let rounding = part.rounding(&geometry, bodies) * part.law.stiffness;
            sides.ends().for_each(|end| rounds[end] += rounding);
            let size = part.now.normal + part.now.tangential.abs();
            sides.ends().for_each(|end| sizes[end] = (sizes[end].0 + size, sizes[end].1 + noise));
        }
        let rigid: Vec<NetworkSpring> = joints.iter().map(|joint| joint.spring(index)).collect();
        for (joint, spring) in joints.iter().zip(&rigid) {
            joint.push(spring, &mut forces);
            for end in spring.ends.iter().flatten() {
                let (size, noise) = joint.size(end, extent(members[end.body]));
                sizes[end.body] = (sizes[end.body].0 + size, sizes[end.body].1 + noise);
            }
        }
        let steady: Vec<NetworkSpring> = self.springs.iter().flat_map(|spring| of_scene(spring, index)).collect();
        let network = |parts: &[Part], all: bool| -> Vec<NetworkSpring> {
            let touching = parts.iter().zip(&springs).filter(|(part, _)| part.now.closed);
            touching.flat_map(|(part, springs)| part.holding(springs, all)).collect()
        };
        let with = |springs: &[NetworkSpring], others: &[NetworkSpring]| -> Vec<NetworkSpring> {
            springs.iter().chain(&rigid).chain(others).copied().collect()
        };
        let closed = joints.iter().all(JointRow::is_closed);
        let each = sizes.iter().zip(&rounds).zip(&*members);
        let rounding = each.fold((0.0_f64, 0.0_f64), |most, (((sum, noise), rounds), &body)| {
            let force = BALANCED * sum + noise.max(*rounds);
            (most.0.max(force), most.1.max(force * extent(body)))
        });
        let lacks = |force: &Twist, body: usize| force.linear.length().max(force.angular.abs() / extent(body));
        let balances = |forces: &[Twist], left_before: &mut f64| {
            let each =
                || forces.iter().zip(&sizes).zip(&*members).map(|((force, size), body)| (lacks(force, *body), *size));
            let left =
                each().filter(|(lacks, _)| *lacks > 0.0).map(|(lacks, (sum, _))| lacks / sum).fold(0.0, f64::max);
            let before = std::mem::replace(left_before, left);
            let balanced = each().all(|(lacks, (sum, noise))| lacks <= BALANCED * sum + noise);
            balanced || left <= NEARLY && left > 0.5 * before
        };
        let (held, left_before) = (network(parts, false), island.left);
        let mut found = Err(Unsolved::Free);
        if !island.moves && balances(&forces, &mut island.left) && closed {
            return island.end(first, self.set_valued, bodies);
        }
        joints.iter().zip(&rigid).for_each(|(joint, spring)| joint.close(spring, &mut forces));
        if !island.moves {
            // Contacts decide whether a body is held. Then springs of the scene take their share of the loads.
            found = solve_beyond(rounding, &with(&held, &[]), &forces, &mut self.work);
            if found.is_ok() && !steady.is_empty() {
                found = solve_beyond(rounding, &with(&held, &steady), &forces, &mut self.work);
            }
            let all = network(parts, true);
            if found == Err(Unsolved::Free) && held.len() < all.len() && island.retries < RETRIES {
                island.retries += 1;
                found = solve_beyond(rounding, &with(&all, &[]), &forces, &mut self.work);
            }
        }
        if found == Err(Unsolved::Free) {
            island.moves = true;
            let masses: Vec<_> = members.iter().map(|&body| (bodies.mass[body], bodies.inertia[body])).collect();
            let extents: Vec<f64> = members.iter().map(|&body| extent(body)).collect();
            let mut agree = true;
            found = spring_network::relieve((&held, &rigid), &masses, &mut forces, &mut self.work).map(|relief| {
                let Relief { accelerations, mut displacements } = relief;
                let mut clear = 0.0_f64;
                for (part, springs) in parts.iter_mut().zip(&springs) {
                    agree &= part.accelerate(springs, &accelerations, &extents);
                    clear = clear.max(part.leaves(springs, &displacements));
                }
                let pairs = displacements.iter_mut().zip(&accelerations);
                pairs.for_each(|(by, acceleration)| *by = by.plus(*acceleration, clear));
                displacements
            });
            if found.is_ok() && agree && balances(&forces, &mut island.left) && closed {
                return island.end(first, self.set_valued, bodies);
            }
        }
        let Ok(mut found) = found else { return island.leave(Outcome::Bound, bodies) };
        if careful && !island.moves && island.left > NO_BETTER * left_before {
            island.step = (island.step / 2.0).max(LEAST_STEP);
        }
        found.iter_mut().for_each(|twist| *twist = Twist::default().plus(*twist, island.step));
        for (part, springs) in parts.iter_mut().zip(&springs).filter(|(part, _)| part.now.closed) {
            part.stretch(springs, &found);
        }
        island.joints.iter_mut().zip(&rigid).for_each(|(joint, spring)| joint.stretch(spring, &found));
        let mut farthest = 0.0_f64;
        for ((by, found), (&body, start)) in
            island.by.iter_mut().zip(&found).zip(island.members.iter().zip(&island.start))
        {
            *by = by.plus(*found, 1.0);
            farthest = farthest.max(by.linear.length() + by.angular.abs() * bodies.extent(body));
            bodies.position[body] = start.0 + by.linear;
            bodies.angle[body] = start.1 + by.angular;
        }
        if farthest.is_nan() || farthest > self.reach {
            island.leave(if first { Outcome::Bound } else { Outcome::AsPlaced }, bodies);
        }
    }
}

impl IslandSearch {
    /// The bodies that move by forces.
    pub fn members(&self) -> &[usize] {
        &self.members
    }

    /// Whether the bodies slide, roll or tip from the start.
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// The contacts that bear something from the start.
    pub fn begun(&self) -> impl Iterator<Item = Begun> + '_ {
        self.parts.iter().filter(|part| part.now.closed && part.now.overlap > 0.0).map(|part| part.begun(self.moves))
    }

    /// The contacts that bear the loads as the scene places them, or what accelerations leave of them.
    pub fn as_placed(&self, set_valued: bool) -> impl Iterator<Item = Begun> + '_ {
        let begun = move |part: &Part| {
            let held = part.as_placed(set_valued)?;
            Some(if self.moves { Begun { overlap: held.overlap, ..part.begun(true) } } else { held })
        };
        // Contacts beside joints may rest: of all forces they begin with that of their spring.
        let holds = self.holds_as_placed || !self.joints.is_empty();
        self.parts.iter().filter(move |_| holds).filter_map(begun)
    }

    /// Bodies go back to where the scene places them.
    fn leave(&mut self, outcome: Outcome, bodies: &mut Bodies) {
        for (&body, start) in self.members.iter().zip(&self.start) {
            (bodies.position[body], bodies.angle[body]) = *start;
        }
        self.outcome = outcome;
    }

    /// All forces balance. Decides whether bodies stay where they are now.
    fn end(&mut self, first: bool, set_valued: bool, bodies: &mut Bodies) {
        let band = |part: &Part| if set_valued { part.law.inelasticity } else { 0.0 };
        let foreign = |part: &Part| {
            let apart = part.other.is_some_and(|other| {
                [other, part.own].iter().any(|body| bodies.dynamic[*body] && self.members.binary_search(body).is_err())
            });
            apart && part.now.overlap > 0.0
        };
        let bears_as_placed = |part: &Part| {
            let (began, now) = (part.began.max(0.0), part.now.overlap.max(0.0));
            (now - began).abs() <= band(part) * began + SAME * now
        };
        let drawn = |part: &Part| part.is_pressed() && !bears_as_placed(part);
        let stays = first
            || !self.joints.iter().all(JointRow::bears)
            || self.parts.iter().any(|part| foreign(part) || drawn(part))
            || self.parts.iter().all(bears_as_placed);
        self.holds_as_placed = self.parts.iter().all(bears_as_placed);
        if stays { self.leave(Outcome::AsPlaced, bodies) } else { self.outcome = Outcome::Found }
    }
}
