//! A pair of sides in the search for equilibrium ([`super::equilibrium_search`]), with its springs.

use glam::DVec2;

use super::begun::{Begun, Drawn, Named};
use super::coulomb::SliderLaw;
use super::pair_law::PairLaw;
use crate::constraints::islands::IslandLink;
use crate::constraints::spring_network::{FREE, NetworkEnd, NetworkSpring, Twist};
use crate::contacts::CandidatePairs;
use crate::contacts::geometry::{PairGeometry, SideA};
use crate::tick::SteadySpring;
use crate::world::Bodies;

/// Friction, or a joint that gives way, bears this share of its bound at most. The rest keeps rounding of later forces inside.
pub(super) const OF_BOUND: f64 = 1.0 - 1e-3;

/// The share of the gap of sides that touch, up to which an overlap bears nothing. It leads to the last of nine digits of the size.
const BEARS_NOTHING: f64 = 5e-5;

/// Rounding of a place, as a share of its coordinates.
pub(super) const NOISE: f64 = 4.0 * f64::EPSILON;

/// A pair near members of an island.
pub(super) struct Part {
    pub named: Named,
    index: usize,
    pub own: usize,
    pub other: Option<usize>,
    pub law: PairLaw,
    rolls: Option<SliderLaw>,
    /// A gap or an overlap in metres up to which the sides just touch at the start.
    pub touch: f64,
    /// Overlap at the start in metres.
    pub began: f64,
    /// Whether no side moves past the other at the start.
    pub still: bool,
    /// Whether the sides neither approach nor part at the start.
    level: bool,
    /// The springs along the surface and against rolling.
    pub slid: Stretch,
    pub turned: Stretch,
    /// The rate at which bodies that accelerate part the sides, in m/s2. `None`: they part as little as rounding does.
    parts: Option<f64>,
    pub now: Now,
}

/// A spring with a Coulomb limit.
#[derive(Clone, Copy, Default)]
pub(super) struct Stretch {
    /// In metres or rad.
    pub elongation: f64,
    /// Whether bodies that accelerate draw it on.
    pub slips: bool,
}

/// A part in the present round.
#[derive(Clone, Copy, Default)]
pub(super) struct Now {
    pub overlap: f64,
    pub closed: bool,
    pub normal: f64,
    pub tangential: f64,
    pub rolling: f64,
    /// Rounding of the overlap in metres.
    pub noise: f64,
    /// Whether friction and rolling resistance hold.
    holds: (bool, bool),
}

/// A round of the search.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Round {
    /// No force says yet what opens or slips.
    First,
    /// Bodies are to rest.
    Resting,
    /// Bodies accelerate in the directions that nothing holds.
    Moving,
}

/// The springs of a part.
pub(super) struct PartSprings {
    pub normal: NetworkSpring,
    tangential: Option<NetworkSpring>,
    rolling: Option<NetworkSpring>,
}

impl IslandLink for Part {
    fn other_body(&self) -> Option<usize> {
        self.other
    }

    fn own_body(&self) -> usize {
        self.own
    }
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

    pub fn part(&self) -> Part {
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
            slid: Stretch::default(),
            turned: Stretch::default(),
            parts: None,
            now: Now::default(),
        }
    }
}

/// The gap in metres below which two sides touch, where `digits` are the last known ones of their size.
pub(super) fn touch_gap(geometry: &PairGeometry, digits: f64, bodies: &Bodies) -> f64 {
    digits + 4.0 * NOISE * place(geometry, bodies).abs().max_element()
}

/// The place of a pair in metres.
fn place(geometry: &PairGeometry, bodies: &Bodies) -> DVec2 {
    bodies.position[geometry.pair.b.body] + geometry.pair.b.arm
}

impl Part {
    /// A contact that holds as it stands, under the force of its spring. `None`: its law has no band of forces, or it just touches.
    pub fn as_placed(&self, set_valued: bool) -> Option<Begun> {
        let holds = set_valued && self.law.inelasticity > 0.0 && self.level && self.began > BEARS_NOTHING * self.touch;
        holds.then(|| Begun {
            pair: self.named,
            overlap: self.began,
            normal_force: self.law.stiffness * self.began,
            tangential: Drawn::default(),
            rolling: self.rolls.map(|_| Drawn::default()),
            still: self.still,
        })
    }

    pub fn geometry(&self, bodies: &Bodies, pairs: &CandidatePairs) -> PairGeometry {
        match self.named {
            Named::Atoms(pair) => PairGeometry::atoms(bodies, self.index, pair),
            Named::Surface(_) => PairGeometry::surface(bodies, self.index, pairs.surfaces[self.index]),
        }
    }

    /// Whether the sides touch as the scene places them.
    pub fn touches_as_placed(&self) -> bool {
        self.began >= -self.touch
    }

    /// Whether the scene presses the sides into each other. The loads ask for the present overlap. One within the digits of the scene
    /// counts only if it is more than that.
    pub fn is_pressed(&self) -> bool {
        self.began > self.touch || self.began > (BEARS_NOTHING * self.touch).max(self.now.overlap)
    }

    /// Rounding of its overlap in metres, along walls too. The distance from a wall is a sum of two products, and their sizes decide.
    pub fn rounding(&self, geometry: &PairGeometry, bodies: &Bodies) -> f64 {
        let from_wall = match geometry.pair.a {
            SideA::Wall(wall) => {
                let way = place(geometry, bodies) - bodies.walls[wall as usize].point;
                geometry.pair.normal.abs().dot(way.abs())
            }
            _ => 0.0,
        };
        self.now.noise.max(NOISE * from_wall)
    }

    /// Its springs, whether it touches or not.
    pub fn springs(&self, sides: &Sides, normal: DVec2) -> PartSprings {
        let slides = self.law.tangential();
        PartSprings {
            normal: sides.along(normal, self.law.stiffness),
            tangential: slides.acts().then(|| sides.along(normal.perp(), slides.stiffness)),
            rolling: self.rolls.map(|rolls| sides.turning(rolls.stiffness)),
        }
    }

    /// The springs that hold, or all of them with those that slip.
    pub fn holding<'a>(&self, springs: &'a PartSprings, all: bool) -> impl Iterator<Item = NetworkSpring> + use<'a> {
        let (slides, rolls) = self.now.holds;
        let of = |spring: Option<NetworkSpring>, holds: bool| spring.filter(|_| holds || all);
        [Some(springs.normal), of(springs.tangential, slides), of(springs.rolling, rolls)].into_iter().flatten()
    }

    /// Takes up displacements of the bodies.
    pub fn stretch(&mut self, springs: &PartSprings, by: &[Twist]) {
        for (stretch, spring) in [(&mut self.slid, &springs.tangential), (&mut self.turned, &springs.rolling)] {
            stretch.elongation += spring.map_or(0.0, |spring| spring.elongation(by));
        }
    }

    /// Takes up the overlap of the present places, and the forces that follow.
    pub fn look(&mut self, geometry: &PairGeometry, bodies: &Bodies, round: Round) {
        let overlap = geometry.overlap;
        let closed = match (round, self.parts) {
            (Round::First, _) => self.touches_as_placed(),
            (Round::Moving, Some(rate)) if self.touches_as_placed() => rate < 0.0,
            _ => overlap > 0.0,
        };
        if !closed {
            (self.slid, self.turned) = Default::default();
        }
        let normal = self.law.stiffness * overlap.max(0.0);
        let slider = self.law.tangential();
        let mut holds = (true, true);
        if round != Round::First && closed {
            holds.0 = self.slid.holds(&slider, normal, round);
            holds.1 = self.rolls.is_none_or(|rolls| self.turned.holds(&rolls, normal, round));
        }
        let tangential = if slider.acts() { slider.stiffness * self.slid.elongation } else { 0.0 };
        let rolling = self.rolls.map_or(0.0, |rolls| rolls.stiffness * self.turned.elongation);
        let noise = NOISE * place(geometry, bodies).abs().max_element();
        self.now = Now { overlap, closed, normal, tangential, rolling, noise, holds };
    }

    /// Takes up the rates at which accelerations of the bodies change its springs. Friction that slips draws its spring.
    /// Otherwise it sticks. `extents`: the sizes of the bodies in metres. Returns whether its modes agree with the rates.
    pub fn accelerate(&mut self, springs: &PartSprings, accelerations: &[Twist], extents: &[f64]) -> bool {
        let rate_of = |spring: &NetworkSpring| rate(spring, accelerations, extents);
        self.parts = rate(&springs.normal, accelerations, extents);
        let approach = self.parts.is_some_and(|parts| parts < 0.0) && self.touches_as_placed();
        let mut agrees = self.now.closed || self.now.overlap <= self.now.noise && !approach;
        for (stretch, spring) in [(&mut self.slid, &springs.tangential), (&mut self.turned, &springs.rolling)] {
            let rate = spring.as_ref().and_then(rate_of);
            if stretch.slips && !rate.is_some_and(|rate| rate * stretch.elongation > 0.0) {
                (stretch.slips, agrees) = (false, false);
            }
        }
        agrees
    }

    /// How much of their accelerations the bodies must go by, beside `displacements`, until sides that part do not overlap. In s2.
    pub fn leaves(&self, springs: &PartSprings, displacements: &[Twist]) -> f64 {
        let parts = self.parts.filter(|parts| *parts > 0.0 && !self.now.closed && self.touches_as_placed());
        let over = self.now.overlap - springs.normal.elongation(displacements);
        parts.filter(|_| over > self.now.noise).map_or(0.0, |parts| over / parts)
    }

    /// The contact that begins with these springs. `moves`: whether its bodies accelerate. At rest a spring at its cone sticks.
    pub fn begun(&self, moves: bool) -> Begun {
        let drawn = |stretch: &Stretch, force: f64| Drawn {
            elongation: stretch.elongation,
            force,
            slips: moves && stretch.slips,
        };
        let mut tangential = drawn(&self.slid, self.now.tangential);
        if self.law.exact {
            tangential.elongation = 0.0;
        }
        Begun {
            pair: self.named,
            overlap: self.now.overlap,
            normal_force: self.now.normal,
            tangential,
            rolling: self.rolls.map(|_| drawn(&self.turned, self.now.rolling)),
            still: true,
        }
    }
}

/// The rate at which accelerations of the bodies lengthen a spring. `None`: it is rounding.
fn rate(spring: &NetworkSpring, accelerations: &[Twist], extents: &[f64]) -> Option<f64> {
    let rate = spring.elongation(accelerations);
    Some(rate).filter(|rate| rate.abs() > FREE * spring.most(accelerations, extents))
}

impl Stretch {
    /// Lets a spring slip to its cone. Returns whether it holds.
    fn holds(&mut self, law: &SliderLaw, normal: f64, round: Round) -> bool {
        if !law.acts() {
            return true;
        }
        let moving = round == Round::Moving;
        let most = OF_BOUND * law.friction_static * normal / law.stiffness;
        self.slips = self.slips && moving || self.elongation.abs() > most;
        if self.slips {
            let slipped = if moving { law.slipped(normal) } else { most };
            self.elongation = slipped.copysign(self.elongation);
        }
        !self.slips
    }
}

/// Both sides of a pair, as far as they belong to the island.
pub(super) struct Sides {
    a: Option<(usize, DVec2)>,
    b: Option<(usize, DVec2)>,
}

impl Sides {
    pub fn of(geometry: &PairGeometry, law: &PairLaw, index: impl Fn(usize) -> Option<usize>) -> Self {
        let (arm_a, arm_b) = geometry.contact_arms(law.shares());
        let a = geometry.pair.other_body().and_then(&index).map(|index| (index, arm_a));
        Self { a, b: index(geometry.pair.b.body).map(|index| (index, arm_b)) }
    }

    pub fn ends(&self) -> impl Iterator<Item = usize> {
        [self.a, self.b].into_iter().flatten().map(|end| end.0)
    }

    /// The force acts on side B, and its opposite on side A.
    pub fn push(&self, forces: &mut [Twist], force: DVec2) {
        for (end, sign) in [(self.a, -1.0), (self.b, 1.0)] {
            if let Some((index, arm)) = end {
                forces[index] = forces[index].plus(Twist { linear: force, angular: arm.perp_dot(force) }, sign);
            }
        }
    }

    /// The torque acts against the turn of side B.
    pub fn twist(&self, forces: &mut [Twist], torque: f64) {
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
pub(super) fn of_scene(
    steady: &SteadySpring,
    index: impl Fn(usize) -> Option<usize>,
) -> impl Iterator<Item = NetworkSpring> {
    let spring = &steady.spring;
    let end = |(body, arm): (usize, DVec2)| index(body).map(|index| (index, arm));
    let sides = Sides { a: spring.a.and_then(end), b: end(spring.b) };
    let (along, across) = spring.stiffness;
    let rows =
        [sides.along(spring.normal, along), sides.along(spring.normal.perp(), across), sides.turning(spring.turning)];
    rows.into_iter().filter(|row| row.stiffness > 0.0 && row.ends.iter().any(Option::is_some))
}
