//! A joint of a scene as a model: its rows in each evaluation, its reaction, and mistakes at the start.

use std::sync::Arc;

use bevy_app::App;
use bevy_ecs::prelude::*;
use glam::DVec2;

use super::KnownJoint;
use super::ends::{EndPair, JointEnds};
use super::law::{Held, JointLaw};
use super::parts::{Asked, JointParts};
use super::soft::Soft;
use crate::constraints::{RowKind as Holds, Rows};
use crate::forces::link::{DAMPING, Partner};
use crate::scene::{Diagnostics, Entry, NameKind, Outline, SceneError};
use crate::tick::snapshot::{Memory, UnfitSnapshot, demand, recall};
use crate::tick::{
    BlowAtJoint, Energies, Events, ForceOn, ForcePart, LoadErrors, Loss, Model, State, SteadySpring, TickAppExt,
};
use crate::world::{Bodies, anchor};
use jostle_language::numbers::number;

/// Anchors that are no farther apart than this share of the numbers they are found from meet.
const MEET: f64 = 1e-9;

/// The meaning of an absent anchor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Absent {
    /// The centre of mass.
    Center,
    /// The position of the bodies.
    Stands,
}

/// A joint as the scene gives it.
pub(super) struct Setup {
    pub name: Option<String>,
    pub partners: [Partner; 2],
    pub anchors: [Option<DVec2>; 2],
    pub collide: bool,
    pub assemble: bool,
    pub absent: Absent,
    pub asked: Asked,
    pub law: Arc<dyn JointLaw>,
}

/// Declares the name of a joint.
pub(super) fn declare(name: Option<&str>, outline: &mut Outline) {
    if let Some(name) = name {
        outline.declare(NameKind::JOINT, name, "name");
    }
}

/// Reports ends without a body, and two ends on one body.
pub(super) fn check_ends(a: &Partner, b: &Partner, outline: &Outline, report: &mut Diagnostics) {
    for (partner, field) in [(a, "a"), (b, "b")] {
        if let Partner::Body(name) = partner {
            outline.require(NameKind::BODY, name, field, report);
        }
    }
    if a == b {
        let side = match a {
            Partner::Body(name) => format!("\"{name}\""),
            Partner::World => "`World`".to_owned(),
        };
        let help = "name two bodies, or hold one to the world with `a: World`";
        report.error("b", format!("both sides are {side}: the joint would hold nothing")).help(help);
    }
}

/// Adds the joints of one kind.
pub(super) fn install<E: Entry>(app: &mut App, outline: &Outline, setups: impl Iterator<Item = Setup>) {
    super::close_at_start(app);
    let mentions = outline.entries(E::SECTION).iter().filter(|mention| mention.name == E::NAME);
    for (setup, mention) in setups.zip(mentions) {
        let key = |partner: &Partner| match partner {
            Partner::Body(name) => outline.position(NameKind::BODY, name).map(|index| index as u64),
            Partner::World => None,
        };
        let keys = [key(&setup.partners[0]), key(&setup.partners[1])];
        if let ([Some(a), Some(b)], false) = (keys, setup.collide) {
            super::keep_apart(app, a, b);
        }
        app.add_model(Joint {
            name: setup.name.clone().unwrap_or_else(|| mention.path.clone()),
            ends: JointEnds::new(keys, setup.anchors.map(Option::unwrap_or_default)),
            law: setup.law.clone(),
            parts: JointParts::default(),
            soft: None,
            setup,
            path: mention.path.clone(),
            rows: 0,
            row: 0,
            beside: 0,
            reaction: (DVec2::ZERO, 0.0),
        });
    }
}

/// A joint.
pub struct Joint {
    /// Its name, or its path in the scene, such as `joints[0]`.
    pub name: String,
    /// Its ends.
    pub ends: JointEnds,
    /// Its law.
    pub law: Arc<dyn JointLaw>,
    /// Force in N and torque about the anchor in N m on body B in the last evaluation.
    pub reaction: (DVec2, f64),
    /// Limits, friction, breaking.
    pub parts: JointParts,
    /// Its springs, if it is soft.
    pub soft: Option<Soft>,
    setup: Setup,
    path: String,
    /// Its rows in the present evaluation.
    row: usize,
    rows: usize,
    /// Those of limits and friction behind them.
    beside: usize,
}

impl Joint {
    /// Both ends in the present state; `None` if a body is gone.
    pub fn pair(&self, bodies: &Bodies) -> Option<EndPair> {
        self.ends.pair(bodies)
    }

    /// Its free motion: the value in rad or m, and the rate.
    pub fn freedom(&self, bodies: &Bodies) -> Option<(f64, f64)> {
        let pair = self.pair(bodies)?;
        let freedom = self.law.freedom(&pair)?;
        Some((freedom.value, pair.rate(&freedom.along)))
    }

    /// Its path in the scene, such as `joints[0]`.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Its drift: the greatest gap in m. Angles count at the farthest point of a body.
    pub fn drift(&self, bodies: &Bodies) -> f64 {
        let Some(pair) = self.pair(bodies) else { return f64::NAN };
        let extent = |end: &super::ends::JointEnd| end.body.map_or(0.0, |body| bodies.extent(body));
        let reach = extent(&pair.a).max(extent(&pair.b));
        let mut worst = 0.0_f64;
        self.law.hold(&pair, &mut |held| {
            let turns = held.along.sides.iter().all(|side| side.0 == DVec2::ZERO);
            worst = worst.max(held.gap.abs() * if turns { reach } else { 1.0 });
        });
        worst
    }

    /// Sets the anchors that the scene leaves out, and the origin of those that it gives. All of them are noted.
    fn place_anchors(&mut self, world: &mut World) {
        let entity = |world: &World, key: Option<u64>| {
            let bodies = &world.resource::<State>().bodies;
            key.and_then(|key| bodies.key.find(key)).map(|index| bodies.entity[index])
        };
        let path = |joint: &Self, side: usize| format!("{}.{}", joint.path, ["anchor_a", "anchor_b"][side]);
        for side in 0..2 {
            let own = entity(world, self.ends.keys[side]);
            let (Some(entity), Some(anchor)) = (own, self.setup.anchors[side]) else { continue };
            self.ends.anchors[side] = anchor::from_center(world, entity, path(self, side), anchor);
        }
        self.place_absent_anchors(&world.resource::<State>().bodies);
        for side in (0..2).filter(|side| self.setup.anchors[*side].is_none()) {
            let own = entity(world, self.ends.keys[side]);
            anchor::note_default(world, own, path(self, side), self.ends.anchors[side]);
        }
    }

    /// Sets the anchors that the scene leaves out.
    fn place_absent_anchors(&mut self, bodies: &Bodies) {
        let Some(pair) = self.ends.pair(bodies) else { return };
        let ends = [pair.a, pair.b];
        let stands = self.setup.absent == Absent::Stands;
        let order = if self.setup.anchors[0].is_none() { [0, 1] } else { [1, 0] };
        for side in order {
            let (own, other) = (ends[side], ends[1 - side]);
            let follows = own.body.is_none() || stands && (self.setup.anchors[1 - side].is_some() || side == 0);
            if self.setup.anchors[side].is_none() && follows && other.body.is_some() {
                let center = own.position - own.arm;
                let turned = DVec2::new(own.axis.x, -own.axis.y);
                self.ends.anchors[side] = match own.body {
                    Some(_) => turned.rotate(other.position - center),
                    None => other.position,
                };
            }
        }
    }

    /// A joint that has broken has no ends any more, nor has what drives it.
    pub(super) fn see_whether_broken(&mut self) {
        if self.parts.broken.is_some() && !self.ends.is_severed() {
            self.ends.sever(true);
            self.reaction = (DVec2::ZERO, 0.0);
        }
    }

    fn mistake(&self, world: &mut World, message: String, help: &str) {
        let error = SceneError::new(self.path.clone(), message).with_help(help);
        world.get_resource_or_init::<LoadErrors>().0.push(error);
    }

    /// Reports conditions that the ends violate at the start.
    fn look_at_start(&self, world: &mut World, pair: &EndPair) {
        let bodies = &world.resource::<State>().bodies;
        let moves = [pair.a.body, pair.b.body].into_iter().flatten().any(|body| bodies.dynamic[body]);
        if !moves {
            let help = "let one of its bodies move by forces, or remove the joint";
            return self.mistake(world, "neither side moves by forces: the joint would hold nothing".to_owned(), help);
        }
        let (mut gap, mut turned) = (0.0_f64, 0.0_f64);
        self.law.hold(pair, &mut |held: Held| {
            let most = if held.along.sides.iter().all(|side| side.0 == DVec2::ZERO) { &mut turned } else { &mut gap };
            if held.gap.is_nan() || held.gap.abs() > MEET * held.size {
                *most = most.max(held.gap.abs());
            }
        });
        if gap > 0.0 && !self.setup.assemble && self.soft.is_none() {
            let [a, way] = [pair.a.position, pair.between()].map(|at| format!("({}, {})", number(at.x), number(at.y)));
            let gap = number(gap);
            let message =
                format!("the joint is open by {gap} m at the start: anchor a is at {a}, anchor b lies {way} m from it");
            let help = "move a body or an anchor, or let the joint close itself: `assemble: true`";
            self.mistake(world, message, help);
        }
        let beyond = self.parts.beyond(&*self.law, pair);
        if beyond > 0.0 {
            let (name, unit) = self.law.freedom_name();
            let message = format!("its {name} at the start is beyond the limits by {} {unit}", number(beyond));
            let help = match self.law.limits() {
                Some(_) => "move a body or an anchor, or give a greater `length`",
                None => "move or turn a body, or widen `limits`",
            };
            self.mistake(world, message, help);
        }
        if pair.between() == DVec2::ZERO && self.law.needs_distance() {
            let message = "both anchors are in one place: the joint has no distance to keep".to_owned();
            self.mistake(world, message, "move a body or an anchor, or use `Revolute`");
        }
    }
}

impl Model for Joint {
    fn energies(&self, state: &State) -> Energies {
        let soft = self.soft.as_ref().zip(self.pair(&state.bodies));
        Energies { potential: 0.0, elastic: soft.map_or(0.0, |(soft, pair)| soft.energy(&*self.law, &pair)) }
    }

    fn stiffness(&self, state: &State, springs: &mut Vec<SteadySpring>) {
        if let (Some(soft), Some(pair)) = (&self.soft, self.pair(&state.bodies)) {
            soft.stiffness(&*self.law, &pair, &state.bodies, springs);
        }
    }

    fn loss(&self) -> Option<Loss> {
        // Sensors ask before the joint has begun.
        let asked = || self.setup.asked.softness.is_some_and(|[_, ratio]| ratio > 0.0);
        let damped = self.soft.as_ref().map_or_else(asked, Soft::is_damped);
        damped.then(|| Loss { account: DAMPING, power: self.soft.as_ref().map_or(0.0, |soft| soft.power) })
    }

    fn force_on(&self, state: &State, body: usize) -> Option<ForceOn> {
        let pair = self.pair(&state.bodies)?;
        let force = self.reaction.0;
        let ends = [(pair.b.body, pair.b.position, force), (pair.a.body, pair.a.position, -force)];
        ForceOn::of_ends(ForcePart::Joint, body, ends)
    }

    fn has_rows(&self) -> bool {
        true
    }

    fn start(&mut self, world: &mut World) {
        self.place_anchors(world);
        self.ends.refresh(&world.resource::<State>().bodies);
        let Some(pair) = self.ends.pair(&world.resource::<State>().bodies) else { return };
        self.law = self.setup.law.begun(&pair);
        self.parts =
            JointParts::new(&Asked { limits: self.setup.asked.limits.or(self.law.limits()), ..self.setup.asked });
        self.parts.start(&*self.law, &pair);
        let bodies = &world.resource::<State>().bodies;
        self.soft = self.setup.asked.softness.map(|softness| Soft::new(softness, &*self.law, &pair, bodies));
        self.look_at_start(world, &pair);
        let limited = self.parts.has_limits();
        let known = KnownJoint { ends: self.ends.clone(), law: self.law.clone(), limited };
        world.get_resource_or_init::<super::KnownJoints>().0.insert(self.name.clone(), known);
    }

    fn add_rows(&mut self, bodies: &Bodies, _: f64, rows: &mut Rows) {
        self.ends.refresh(bodies);
        (self.row, self.rows, self.beside) = (rows.len(), 0, 0);
        let Some(pair) = self.ends.pair(bodies) else { return };
        let exact = self.soft.is_none();
        let mut hold = |Held { along, gap, size }| {
            let mut row = pair.row(&along, Holds::Position);
            (row.gap, row.size) = (gap, size);
            rows.add(row);
        };
        if exact {
            self.law.hold(&pair, &mut hold);
        }
        self.rows = rows.len() - self.row;
        self.parts.add_rows(&*self.law, &pair, rows);
        self.beside = rows.len() - self.row - self.rows;
    }

    fn take_rows(&mut self, state: &mut State) {
        let indices = self.row..self.row + self.rows + self.beside;
        state.apply_rows(indices.clone());
        let Some(pair) = self.ends.pair(&state.bodies) else { return };
        if self.beside > 0 {
            self.parts.take_rows(self.row + self.rows, state.rows());
        }
        for index in indices {
            let (row, amount) = (state.rows().row(index), state.rows().force(index));
            // If B is the world, A gives the force that A receives.
            let (side, sign, arm) = match (row.sides[1], row.sides[0]) {
                (Some(side), _) => (side, 1.0, pair.b.arm),
                (None, Some(side)) => (side, -1.0, pair.a.arm),
                (None, None) => continue,
            };
            self.reaction.0 += side.force * (sign * amount);
            self.reaction.1 += (side.torque - arm.perp_dot(side.force)) * (sign * amount);
        }
    }

    fn apply_forces(&mut self, state: &mut State) {
        self.reaction = (DVec2::ZERO, 0.0);
        if self.parts.is_empty() && self.soft.is_none() {
            return;
        }
        let Some(pair) = self.ends.pair(&state.bodies) else { return };
        if let Some(soft) = &mut self.soft {
            self.reaction = soft.push(&*self.law, &pair, state);
        }
        if let Some((along, amount)) = self.parts.apply_forces(&*self.law, &pair, state) {
            let (direction, lever) = along.sides[1];
            self.reaction.0 += direction * amount;
            self.reaction.1 += (lever - pair.b.arm.perp_dot(direction)) * amount;
        }
    }

    fn has_modes(&self) -> bool {
        !self.parts.is_empty()
    }

    fn begin_step(&mut self, state: &mut State) {
        let Some(pair) = self.ends.pair(&state.bodies) else { return };
        if self.parts.begin_step(&*self.law, &pair, self.reaction.0.length(), state) {
            self.see_whether_broken();
            state.change_rows();
        }
    }

    fn after_blow(&mut self, state: &mut State) {
        if let Some(pair) = self.ends.pair(&state.bodies) {
            self.parts.after_blow(&*self.law, &pair);
        }
    }

    fn break_force(&self) -> Option<f64> {
        self.parts.break_force()
    }

    fn take_blow(&mut self, blow: BlowAtJoint, breaks: bool) {
        self.parts.take_blow(blow, breaks);
        self.see_whether_broken();
    }

    fn events(&mut self) -> Option<&mut dyn Events> {
        (!self.parts.is_empty()).then_some(self)
    }

    /// The first joint reports the remarks of all joints.
    fn remarks(&self, state: &State) -> Vec<String> {
        let first = state.models_of::<Self>().next().is_some_and(|joint| std::ptr::eq(joint, self));
        let mut remarks: Vec<String> = Vec::new();
        remarks.extend(self.parts.remark(&self.name));
        let dead = state.dead_points();
        if let (true, Some(time)) = (first, dead.first) {
            remarks.push(format!(
                "a loop of joints passes a dead point at t = {} s, {} in all. Bars are in line there, joints alone do not \
                 determine the way on, and rounding grows",
                number(time),
                dead.passed,
            ));
        }
        if !(first && state.rows().is_dependent()) {
            return remarks;
        }
        remarks.push(
            "some joints repeat constraints of others. The motion is exact, but forces may share the load in many \
        ways. The engine takes the forces of least norm"
                .to_owned(),
        );
        remarks
    }

    fn save(&self) -> Memory {
        Memory::of(&(self.reaction, &self.parts, self.soft.as_ref().map(|soft| soft.power)))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), UnfitSnapshot> {
        let power: Option<f64>;
        let (reaction, parts): (_, JointParts);
        (reaction, parts, power) = recall(bytes)?;
        demand(self.parts.has_parameters_of(&parts), "the limits of a joint")?;
        (self.reaction, self.parts) = (reaction, parts);
        if let (Some(soft), Some(power)) = (&mut self.soft, power) {
            soft.power = power;
        }
        self.ends.sever(self.parts.broken.is_some());
        Ok(())
    }
}
