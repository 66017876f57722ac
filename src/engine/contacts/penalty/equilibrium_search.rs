//! The search for places in which the springs of contacts bear all loads. It is Newton's method on the forces of islands, with the
//! springs that touch ([`crate::constraints::spring_network`]). Friction and rolling resistance are springs too. Beyond their cones they
//! slip, and keep the force of the cone (return mapping, Simo and Hughes 1998).
//!
//! The first round takes all that touches as held, because no force says yet what opens or slips. Each later round takes the
//! contacts that are compressed and the friction that holds. Work and rounds are bounded.

use glam::DVec2;

use super::begun::{Begun, Drawn, Named};
use super::coulomb::SliderLaw;
use super::pair_law::PairLaw;
use crate::constraints::islands::{IslandLink, Islands};
use crate::constraints::spring_network::{self, NetworkEnd, NetworkSpring, Twist, Unsolved};
use crate::contacts::CandidatePairs;
use crate::contacts::geometry::PairGeometry;
use crate::tick::{State, SteadySpring};
use crate::world::Bodies;

/// Rounds of Newton's method. The contacts that open and slip are known after a few. The cone of friction that slips follows the
/// normal force of the round before. Then each round reduces the rest by a factor.
const ROUNDS: usize = 60;

/// Products of all islands with their springs, each counted once for each spring: a quarter of a second.
const WORK: usize = 1 << 24;

/// Rounds in which friction that slips is taken as held, because no other spring holds a body.
const RETRIES: usize = 8;

/// The forces on a body balance up to this share: rounding of their sum.
const BALANCED: f64 = 1e-12;

/// The same if rounding of far places leaves no better balance. From round to round it does not halve any more.
const NEARLY: f64 = 1e-7;

/// Friction bears this share of its cone at most. The rest keeps rounding of later forces inside the cone.
const OF_CONE: f64 = 1.0 - 1e-3;

/// Overlaps that differ by less than this share bear the same load.
const SAME: f64 = 1e-9;

/// Rounding of a place, as a share of its coordinates.
const NOISE: f64 = 4.0 * f64::EPSILON;

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

/// A pair near members of an island.
struct Part {
    named: Named,
    index: usize,
    own: usize,
    other: Option<usize>,
    law: PairLaw,
    rolls: Option<SliderLaw>,
    /// A gap in metres up to which the sides touch at the start.
    touch: f64,
    /// Overlap at the start in metres.
    began: f64,
    /// Whether no side moves past the other at the start.
    still: bool,
    /// Whether the sides neither approach nor part at the start.
    level: bool,
    /// Elongations of the springs along the surface and against rolling.
    slid: f64,
    turned: f64,
    now: Now,
}

/// A part in the present round.
#[derive(Clone, Copy, Default)]
struct Now {
    overlap: f64,
    closed: bool,
    normal: f64,
    tangential: f64,
    rolling: f64,
    /// Whether friction and rolling resistance hold.
    holds: (bool, bool),
}

impl IslandLink for Part {
    fn other_body(&self) -> Option<usize> {
        self.other
    }

    fn own_body(&self) -> usize {
        self.own
    }
}

/// Bodies that touch each other, directly or through others.
pub(super) struct IslandSearch {
    members: Vec<usize>,
    parts: Vec<Part>,
    /// Places and angles at the start.
    start: Vec<(DVec2, f64)>,
    by: Vec<Twist>,
    retries: usize,
    /// The greatest unbalanced force of the round before, as a share of all forces on its body.
    left: f64,
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
    /// Contacts of bodies that joints hold.
    jointed: Vec<Begun>,
    /// For each body its island, and its index there.
    place: Vec<(u32, u32)>,
    springs: Vec<SteadySpring>,
    work: usize,
}

/// A pair as the search takes it up.
pub(super) struct Candidate<'a> {
    pub named: Named,
    pub geometry: &'a PairGeometry,
    pub law: PairLaw,
    pub rolls: Option<SliderLaw>,
    /// A gap in metres up to which the sides touch.
    pub touch: f64,
}

impl Candidate<'_> {
    /// Whether the sides touch at the start.
    pub fn touches(&self) -> bool {
        self.geometry.overlap >= -self.touch
    }

    fn part(&self) -> Part {
        let Self { named, geometry, law, rolls, touch } = *self;
        Part {
            named,
            index: geometry.pair.index as usize,
            own: geometry.pair.b.body,
            other: geometry.pair.other_body(),
            law,
            rolls,
            touch,
            began: geometry.overlap,
            still: geometry.velocity == DVec2::ZERO && geometry.turning_speed() == 0.0,
            level: geometry.parting() == 0.0,
            slid: 0.0,
            turned: 0.0,
            now: Now::default(),
        }
    }
}

/// The gap in metres below which two sides touch, where `nine_digits` are the last of nine digits of their size.
pub(super) fn touch_gap(geometry: &PairGeometry, nine_digits: f64, bodies: &Bodies) -> f64 {
    nine_digits + 4.0 * NOISE * place(geometry, bodies).abs().max_element()
}

fn place(geometry: &PairGeometry, bodies: &Bodies) -> DVec2 {
    bodies.position[geometry.pair.b.body] + geometry.pair.b.arm
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

    /// Sorts the touching pairs into islands. `jointed`: bodies that joints hold.
    pub fn gather(&mut self, bodies: &Bodies, jointed: &[bool]) {
        let mut links = std::mem::take(&mut self.touching);
        let mut sorted = Islands::default();
        sorted.sort::<Part, Part>(&mut links, &mut [], bodies);
        self.place = vec![(NONE, 0); bodies.len()];
        let mut links = links.into_iter().peekable();
        while let Some(first) = links.next() {
            let root = sorted.of(&first, bodies);
            let mut parts = vec![first];
            while let Some(next) = links.next_if(|next| sorted.of(next, bodies) == root) {
                parts.push(next);
            }
            let ends = parts.iter().flat_map(|part| [Some(part.own), part.other]).flatten();
            let mut members: Vec<usize> = ends.filter(|&body| bodies.dynamic[body]).collect();
            members.sort_unstable();
            members.dedup();
            let held = members.iter().any(|&body| jointed.get(body).is_some_and(|jointed| *jointed));
            if held {
                self.jointed.extend(parts.iter().filter_map(|part| part.as_placed(self.set_valued)));
                continue;
            }
            if parts.iter().any(|part| !part.still) {
                continue;
            }
            for (index, &body) in members.iter().enumerate() {
                self.place[body] = (self.islands.len() as u32, index as u32);
            }
            let start = members.iter().map(|&body| (bodies.position[body], bodies.angle[body])).collect();
            let by = vec![Twist::default(); members.len()];
            self.islands.push(IslandSearch {
                members,
                parts,
                start,
                by,
                retries: 0,
                left: f64::INFINITY,
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

    /// Contacts of bodies that joints hold. They are there at the start and may rest: of all forces they begin with that of their spring.
    pub fn jointed(&self) -> &[Begun] {
        &self.jointed
    }

    /// Moves the bodies of all islands into their equilibria, as far as there are any. `loads` are those at the start.
    pub fn run(&mut self, state: &mut State, pairs: &CandidatePairs, loads: &mut Vec<Twist>) {
        state.models().for_each(|model| model.stiffness(state, &mut self.springs));
        let mut islands = std::mem::take(&mut self.islands);
        for round in 0..ROUNDS {
            if round > 0 {
                state.loads_at_start(loads);
            }
            let mut open = false;
            for (number, island) in islands.iter_mut().enumerate().filter(|(_, island)| island.outcome == Outcome::Open)
            {
                self.improve((number as u32, island), &mut state.bodies, pairs, loads, round == 0);
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
        loads: &[Twist],
        first: bool,
    ) {
        let IslandSearch { members, parts, .. } = island;
        let mut forces: Vec<Twist> = members.iter().map(|&body| loads[body]).collect();
        let extent = |body: usize| bodies.extent(body).max(f64::MIN_POSITIVE);
        let own = |body: usize| loads[body].linear.length() + loads[body].angular.abs() / extent(body);
        // The sum of all forces on each body, and what rounding makes of them.
        let mut sizes: Vec<(f64, f64)> = members.iter().map(|&body| (own(body), 0.0)).collect();
        let index =
            |body: usize| Some(self.place[body]).filter(|place| place.0 == number).map(|place| place.1 as usize);
        let mut springs = Vec::new();
        // The index of the first row of each part.
        let mut rows = Vec::with_capacity(parts.len());
        for part in &mut *parts {
            let geometry = part.geometry(bodies, pairs);
            part.look(&geometry, first);
            rows.push(springs.len());
            if !part.now.closed {
                continue;
            }
            let sides = Sides::of(&geometry, &part.law, index);
            let normal = geometry.pair.normal;
            sides.push(&mut forces, normal * part.now.normal - normal.perp() * part.now.tangential);
            sides.twist(&mut forces, part.now.rolling);
            let noise = NOISE * place(&geometry, bodies).abs().max_element() * part.law.stiffness;
            let size = part.now.normal + part.now.tangential.abs();
            sides.ends().for_each(|end| sizes[end] = (sizes[end].0 + size, sizes[end].1 + noise));
            springs.push((sides.along(normal, part.law.stiffness), true));
            if part.law.tangential().acts() {
                springs.push((sides.along(normal.perp(), part.law.tangential_stiffness), part.now.holds.0));
            }
            if let Some(rolls) = part.rolls.filter(|rolls| rolls.acts()) {
                springs.push((sides.turning(rolls.stiffness), part.now.holds.1));
            }
        }
        let lacks = |force: &Twist, body: usize| force.linear.length().max(force.angular.abs() / extent(body));
        let each =
            || forces.iter().zip(&sizes).zip(&*members).map(|((force, size), body)| (lacks(force, *body), *size));
        let left = each().filter(|(lacks, _)| *lacks > 0.0).map(|(lacks, (sum, _))| lacks / sum).fold(0.0, f64::max);
        let before = std::mem::replace(&mut island.left, left);
        let balanced = each().all(|(lacks, (sum, noise))| lacks <= BALANCED * sum + noise);
        if balanced || left <= NEARLY && left > 0.5 * before {
            return island.end(first, self.set_valued, bodies);
        }
        let held: Vec<NetworkSpring> = springs.iter().filter(|(_, holds)| *holds).map(|(spring, _)| *spring).collect();
        let steady: Vec<NetworkSpring> = self.springs.iter().flat_map(|spring| of_scene(spring, index)).collect();
        let mut solved = spring_network::solve(&[&held[..], &steady].concat(), &forces, &mut self.work);
        if solved == Err(Unsolved::Free) && held.len() < springs.len() && island.retries < RETRIES {
            island.retries += 1;
            let all: Vec<NetworkSpring> = springs.iter().map(|(spring, _)| *spring).collect();
            solved = spring_network::solve(&[&all[..], &steady].concat(), &forces, &mut self.work);
        }
        let found = match solved {
            Ok(found) => found,
            Err(Unsolved::Free) => return island.leave(Outcome::AsPlaced, bodies),
            Err(Unsolved::Work) => return island.leave(Outcome::Bound, bodies),
        };
        for (part, &row) in island.parts.iter_mut().zip(&rows).filter(|(part, _)| part.now.closed) {
            let mut next = row + 1;
            if part.law.tangential().acts() {
                part.slid += springs[next].0.elongation(&found);
                next += 1;
            }
            if part.rolls.is_some_and(|rolls| rolls.acts()) {
                part.turned += springs[next].0.elongation(&found);
            }
        }
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

    /// The contacts that bear something in the equilibrium.
    pub fn begun(&self) -> impl Iterator<Item = Begun> + '_ {
        self.parts.iter().filter(|part| part.now.closed && part.now.overlap > 0.0).map(|part| {
            let elongation = if part.law.exact { 0.0 } else { part.slid };
            Begun {
                pair: part.named,
                overlap: part.now.overlap,
                normal_force: part.now.normal,
                tangential: Drawn { elongation, force: part.now.tangential },
                rolling: Drawn { elongation: part.turned, force: part.now.rolling },
                still: true,
            }
        })
    }

    /// The contacts that bear the loads as the scene places them.
    pub fn as_placed(&self, set_valued: bool) -> impl Iterator<Item = Begun> + '_ {
        self.parts.iter().filter(|_| self.holds_as_placed).filter_map(move |part| part.as_placed(set_valued))
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
        let drawn = |part: &Part| part.began > part.touch && !bears_as_placed(part);
        let stays = first
            || self.parts.iter().any(|part| foreign(part) || drawn(part))
            || self.parts.iter().all(bears_as_placed);
        self.holds_as_placed = self.parts.iter().all(bears_as_placed);
        if stays { self.leave(Outcome::AsPlaced, bodies) } else { self.outcome = Outcome::Found }
    }
}

impl Part {
    /// A contact that holds as it stands, under the force of its spring. `None`: its law has no band of forces, or it just touches.
    fn as_placed(&self, set_valued: bool) -> Option<Begun> {
        let holds = set_valued && self.law.inelasticity > 0.0 && self.level && self.began > self.touch;
        holds.then(|| Begun {
            pair: self.named,
            overlap: self.began,
            normal_force: self.law.stiffness * self.began,
            tangential: Drawn::default(),
            rolling: Drawn::default(),
            still: self.still,
        })
    }

    fn geometry(&self, bodies: &Bodies, pairs: &CandidatePairs) -> PairGeometry {
        match self.named {
            Named::Atoms(pair) => PairGeometry::atoms(bodies, self.index, pair),
            Named::Surface(_) => PairGeometry::surface(bodies, self.index, pairs.surfaces[self.index]),
        }
    }

    /// Takes up the overlap of the present places, and the forces that follow.
    fn look(&mut self, geometry: &PairGeometry, first: bool) {
        let overlap = geometry.overlap;
        let closed = overlap > 0.0 || first && overlap >= -self.touch;
        if !closed {
            (self.slid, self.turned) = (0.0, 0.0);
        }
        let normal = self.law.stiffness * overlap.max(0.0);
        let slider = self.law.tangential();
        let mut holds = (true, true);
        if !first && closed {
            holds.0 = held(&mut self.slid, &slider, normal);
            holds.1 = self.rolls.is_none_or(|rolls| held(&mut self.turned, &rolls, normal));
        }
        let tangential = if slider.acts() { slider.stiffness * self.slid } else { 0.0 };
        let rolling = self.rolls.map_or(0.0, |rolls| rolls.stiffness * self.turned);
        self.now = Now { overlap, closed, normal, tangential, rolling, holds };
    }
}

/// Lets a spring slip to its cone. Returns whether it holds.
fn held(elongation: &mut f64, law: &SliderLaw, normal: f64) -> bool {
    let most = OF_CONE * law.friction_static * normal / law.stiffness;
    let holds = elongation.abs() <= most;
    if !holds && law.acts() {
        *elongation = most.copysign(*elongation);
    }
    holds
}

/// Both sides of a pair, as far as they belong to the island.
struct Sides {
    a: Option<(usize, DVec2)>,
    b: Option<(usize, DVec2)>,
}

impl Sides {
    fn of(geometry: &PairGeometry, law: &PairLaw, index: impl Fn(usize) -> Option<usize>) -> Self {
        let (arm_a, arm_b) = geometry.contact_arms(law.shares());
        let a = geometry.pair.other_body().and_then(&index).map(|index| (index, arm_a));
        Self { a, b: index(geometry.pair.b.body).map(|index| (index, arm_b)) }
    }

    fn ends(&self) -> impl Iterator<Item = usize> {
        [self.a, self.b].into_iter().flatten().map(|end| end.0)
    }

    /// The force acts on side B, and its opposite on side A.
    fn push(&self, forces: &mut [Twist], force: DVec2) {
        for (end, sign) in [(self.a, -1.0), (self.b, 1.0)] {
            if let Some((index, arm)) = end {
                forces[index] = forces[index].plus(Twist { linear: force, angular: arm.perp_dot(force) }, sign);
            }
        }
    }

    /// The torque acts against the turn of side B.
    fn twist(&self, forces: &mut [Twist], torque: f64) {
        for (end, sign) in [(self.a, 1.0), (self.b, -1.0)] {
            if let Some((index, _)) = end {
                forces[index].angular += sign * torque;
            }
        }
    }

    /// A spring along a direction.
    fn along(&self, direction: DVec2, stiffness: f64) -> NetworkSpring {
        let end = |end: Option<(usize, DVec2)>, sign: f64| {
            let (body, arm) = end?;
            let row = Twist { linear: direction * sign, angular: sign * arm.perp_dot(direction) };
            Some(NetworkEnd { body, row })
        };
        NetworkSpring { ends: [end(self.a, -1.0), end(self.b, 1.0)], stiffness }
    }

    /// A spring against the turn of one side over the other.
    fn turning(&self, stiffness: f64) -> NetworkSpring {
        let end = |end: Option<(usize, DVec2)>, sign: f64| {
            Some(NetworkEnd { body: end?.0, row: Twist { linear: DVec2::ZERO, angular: sign } })
        };
        NetworkSpring { ends: [end(self.a, -1.0), end(self.b, 1.0)], stiffness }
    }
}

/// The springs of a model, as far as they hold members of the island.
fn of_scene(steady: &SteadySpring, index: impl Fn(usize) -> Option<usize>) -> impl Iterator<Item = NetworkSpring> {
    let spring = &steady.spring;
    let end = |(body, arm): (usize, DVec2)| index(body).map(|index| (index, arm));
    let sides = Sides { a: spring.a.and_then(end), b: end(spring.b) };
    let (along, across) = spring.stiffness;
    let rows =
        [sides.along(spring.normal, along), sides.along(spring.normal.perp(), across), sides.turning(spring.turning)];
    rows.into_iter().filter(|row| row.stiffness > 0.0 && row.ends.iter().any(Option::is_some))
}
