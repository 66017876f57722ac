//! When the modes of contacts end, and what follows.
//!
//! | mode | lasts while | then |
//! |---|---|---|
//! | open | the gap is positive | loading |
//! | loading, unloading | the law goes on (overlap, or force) | open |
//! | loading with loss | the sides approach | held, for a first try |
//! | unloading with loss | the sides part | held, for a first try |
//! | held | the normal force is within the bounds of the law | loading or unloading |
//! | stick | the tangential force is within the static cone | slip |
//! | slip | the sides slide the same way | stick, for a first try |
//!
//! A mode that begins at rest is decided by accelerations, not by velocities: it is tried as held, and where the forces that
//! would hold it are out of bounds it takes the mode beyond the bound.

use bevy_ecs::prelude::*;

use super::apply::PenaltyContacts;
use super::case::Other;
use super::contact::Contact;
use super::coulomb::{Grip, Slider};
use super::handover;
use super::law::{LawTable, PairLaw};
use super::list::Edited;
use super::normal::{Approach, Mode, NormalForce};
use super::rolling::RollingContacts;
use super::rolling_stages::{self, Roller};
use super::staged::Look;
use super::{Penalty, RollingLaw, TangentialLaw};
use crate::contacts::events::Touches;
use crate::contacts::{CandidatePairs, DeepestOverlap};
use crate::tick::balance::{angular_momentum, momentum};
use crate::tick::{Clock, Evaluation, Indicator, Ledger, Models, Objection, StateBlock, Style, Watch};
use crate::world::{Bodies, lend};

/// What an indicator of a contact stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum What {
    Touch,
    Part,
    Turn,
    Lower,
    Upper,
    /// The cone is left with a force of this sign.
    Give(bool),
    Stop,
    /// The rolling spring gives way with a torque of this sign.
    RollingGive(bool),
    RollingStop,
}

/// The indicators of the present modes: candidate pairs (pairs of atoms first, then walls) and what is watched of them.
pub(super) type Told = Vec<(u32, What)>;

/// Registers contacts with this law for methods with several stages.
pub(super) fn install<N: NormalForce>(world: &mut World) {
    let rolls = world.contains_resource::<RollingContacts>();
    let mut models = world.get_resource_or_init::<Models>();
    models.blocks.push(StateBlock { length, read, write, rates });
    if rolls {
        models.blocks.push(rolling_stages::BLOCK);
    }
    models.watches.push(Watch {
        tell: tell::<N>,
        switch: switch::<N>,
        settle: settle::<N>,
        take_stock: take_stock::<N>,
        tidy,
        told: 0,
    });
    models.objections.push(object);
    models.handovers.push(handover::hand_over::<N>);
    models.crowds.push(handover::crowded);
}

/// What these contacts cannot do yet, or cannot do at all.
fn object(world: &World, style: Style) -> Option<Objection> {
    let settings = world.resource::<Penalty>();
    let friction = world.resource::<PenaltyContacts>().materials.any_friction();
    let (path, message, help) = match (style, settings.tangential) {
        (Style::Following, TangentialLaw::Exact) => (
            "contacts.Penalty.tangential",
            "`Exact` friction needs a method that locates events inside a tick",
            "write `clock: (.., method: RungeKutta4)`, `method: Dop853` or `events: Located`; or `tangential: Spring(ratio: 0.8)`",
        ),
        (Style::Instant, TangentialLaw::Spring { .. }) if friction => (
            "clock.events",
            "tangential springs need their events located under a method with several stages",
            "write `events: Located`, or `tangential: Exact` or `None`, or `method: VelocityVerlet`",
        ),
        (Style::Instant, _) if settings.rolling != RollingLaw::None => (
            "clock.events",
            "rolling springs need their events located under a method with several stages",
            "write `events: Located`, or `rolling: None`, or `method: VelocityVerlet`",
        ),
        _ => return None,
    };
    Some(Objection { path, message: message.to_owned(), help })
}

/// All candidate pairs with their contacts.
pub(super) struct View<'a> {
    pub bodies: &'a Bodies,
    pairs: &'a CandidatePairs,
    pub contacts: &'a mut PenaltyContacts,
    pub rolling: Option<RollingContacts>,
}

impl View<'_> {
    pub fn len(&self) -> usize {
        self.contacts.atoms.len() + self.contacts.walls.len()
    }

    pub fn look(&self, place: usize) -> Look {
        let atoms = self.contacts.atoms.len();
        match place.checked_sub(atoms) {
            None => Look::atoms(self.bodies, place, self.pairs.atoms[place]),
            Some(place) => Look::wall(self.bodies, place, self.pairs.walls[place]),
        }
    }

    /// A contact with its law, and its rolling spring in scenes that have them.
    pub fn whole(&mut self, place: usize, look: &Look) -> (Edited<'_>, &PairLaw, Option<Roller<'_>>) {
        let PenaltyContacts { laws, atoms, walls, .. } = &mut *self.contacts;
        let count = atoms.len();
        let contact = if place < count { atoms.edit(place) } else { walls.edit(place - count) };
        let law = laws.get(contact.law);
        (contact, law, self.rolling.as_mut().map(|rolling| rolling.of(look, law)))
    }

    pub fn contact(&mut self, place: usize) -> (Edited<'_>, &PairLaw) {
        let PenaltyContacts { laws, atoms, walls, .. } = &mut *self.contacts;
        let count = atoms.len();
        let contact = if place < count { atoms.edit(place) } else { walls.edit(place - count) };
        let law = laws.get(contact.law);
        (contact, law)
    }
}

pub(super) fn view<R>(world: &mut World, see: impl FnOnce(&mut View) -> R) -> R {
    lend(world, |world, contacts: &mut PenaltyContacts| {
        let rolling = world.get_resource_mut::<RollingContacts>().map(|mut rolling| std::mem::take(&mut *rolling));
        let (bodies, pairs) = (world.resource::<Bodies>(), world.resource::<CandidatePairs>());
        let mut view = View { bodies, pairs, contacts, rolling };
        let seen = see(&mut view);
        if let Some(rolling) = view.rolling {
            *world.resource_mut::<RollingContacts>() = rolling;
        }
        seen
    })
}

/// Contacts whose tangential spring holds: its elongation is state.
fn springs(contacts: &PenaltyContacts) -> impl Iterator<Item = Contact> {
    contacts.atoms.iter().chain(contacts.walls.iter()).filter(|contact| is_spring(contact, &contacts.laws))
}

fn is_spring(contact: &Contact, laws: &LawTable) -> bool {
    let sticks = contact.mode != Mode::Open && contact.tangential.grip == Grip::Stick;
    sticks && laws.get(contact.law).tangential().acts()
}

fn length(world: &World) -> usize {
    springs(world.resource::<PenaltyContacts>()).count()
}

fn read(world: &World, state: &mut [f64]) {
    for (state, contact) in state.iter_mut().zip(springs(world.resource())) {
        *state = contact.tangential.elongation;
    }
}

fn write(world: &mut World, state: &[f64]) {
    let mut contacts = world.resource_mut::<PenaltyContacts>();
    let PenaltyContacts { atoms, walls, laws, .. } = &mut *contacts;
    let mut states = state.iter();
    for list in [atoms, walls] {
        for place in 0..list.len() {
            if is_spring(&list.get(place), laws)
                && let Some(&state) = states.next()
            {
                list.edit(place).tangential.elongation = state;
            }
        }
    }
}

fn rates(world: &World, rates: &mut [f64]) {
    let (bodies, pairs) = (world.resource::<Bodies>(), world.resource::<CandidatePairs>());
    let contacts = world.resource::<PenaltyContacts>();
    let of_atoms = contacts.atoms.iter().zip(&pairs.atoms).enumerate();
    let of_atoms = of_atoms
        .filter(|(_, (contact, _))| is_spring(contact, &contacts.laws))
        .map(|(place, (contact, pair))| Look::atoms(bodies, place, *pair).sliding(contacts.laws.get(contact.law)));
    let of_walls = contacts.walls.iter().zip(&pairs.walls).enumerate();
    let of_walls = of_walls
        .filter(|(_, (contact, _))| is_spring(contact, &contacts.laws))
        .map(|(place, (contact, pair))| Look::wall(bodies, place, *pair).sliding(contacts.laws.get(contact.law)));
    rates.iter_mut().zip(of_atoms.chain(of_walls)).for_each(|(rate, sliding)| *rate = sliding);
}

/// The rate at which the elongation of a slipping spring follows the normal force.
fn following<N: NormalForce>(contact: &Contact, law: &PairLaw, look: &Look, bodies: &Bodies) -> f64 {
    if law.exact || contact.mode == Mode::Hold {
        return 0.0;
    }
    let rate = N::force_rate(law, contact.mode, look.approach(bodies), look.change(law, bodies));
    law.friction_dynamic.copysign(contact.tangential.held) * rate / law.tangential_stiffness
}

/// Whether no pair is near, and nothing is left to be booked of one that was: then nobody has to look.
fn is_idle(world: &World) -> bool {
    let contacts = world.resource::<PenaltyContacts>();
    let near = !contacts.atoms.is_empty() || !contacts.walls.is_empty();
    !near && contacts.rows.is_empty() && contacts.held_before.is_none() && contacts.slid == 0.0
}

fn tell<N: NormalForce>(world: &mut World, told: &mut Vec<Indicator>) {
    if is_idle(world) {
        world.resource_mut::<PenaltyContacts>().told.clear();
        return;
    }
    view(world, |view| {
        let mut what = std::mem::take(&mut view.contacts.told);
        what.clear();
        for place in 0..view.len() {
            let look = view.look(place);
            let bodies = view.bodies;
            let (contact, law, roller) = view.whole(place, &look);
            if contact.mode == Mode::Open {
                what.push((place as u32, What::Touch));
                told.push(Indicator { value: -look.overlap, slope: look.parting(), bend: look.bend(bodies) });
                continue;
            }
            let mut say = |event: What, value: f64, slope: f64| {
                what.push((place as u32, event));
                told.push(Indicator { value, slope, bend: 0.0 });
            };
            let unknown = f64::NAN;
            if contact.mode == Mode::Hold {
                let (least, greatest) = N::band(law, contact.overlap, contact.normal_force);
                say(What::Lower, contact.normal_force - least, unknown);
                say(What::Upper, greatest - contact.normal_force, unknown);
            } else {
                let (value, known) = N::remaining(contact.mode, contact.overlap, contact.normal_force);
                say(What::Part, value, if known { -look.parting() } else { unknown });
                let parting = (look.parting(), look.parting_rate(law, bodies));
                let loading = N::smooth_force(law, Mode::Loading, look.overlap, look.approach(bodies));
                if let Some((value, slope)) = N::stays(law, contact.mode, parting, loading) {
                    say(What::Turn, value, slope);
                }
            }
            if law.tangential().acts() {
                let force = contact.tangential_force(law);
                match contact.tangential.grip {
                    Grip::Slide => {
                        let slip = look.sliding(law) - following::<N>(&contact, law, &look, bodies);
                        say(What::Stop, slip.copysign(slip * contact.tangential.held.signum()), unknown);
                    }
                    grip => {
                        // At rest along the normal friction too may be any force within its cone once the sides stop.
                        if grip == Grip::Stick && contact.mode == Mode::Hold {
                            let sliding = look.sliding(law);
                            say(What::Stop, sliding.copysign(sliding * contact.tangential.held.signum()), unknown);
                        }
                        let limit = law.friction_static * contact.normal_force;
                        say(What::Give(true), limit - force, unknown);
                        say(What::Give(false), limit + force, unknown);
                    }
                }
            }
            if let Some(roller) = roller {
                rolling_stages::tell::<N>(&roller, (&contact, law), &look, bodies, |what, value| {
                    say(what, value, unknown);
                });
            }
        }
        view.contacts.told = what;
    });
}

fn switch<N: NormalForce>(world: &mut World, fired: &[usize]) {
    if world.contains_resource::<Touches>() {
        note_begun(world, fired);
    }
    let slid = view(world, |view| {
        let slid = view.close_slides();
        // What springs hold before and no longer after is lost; it is booked when all modes have settled.
        view.contacts.held_before = Some(view.stored(|_| true));
        for &place in fired {
            let (pair, what) = view.contacts.told[place];
            let look = view.look(pair as usize);
            let (mut contact, law, roller) = view.whole(pair as usize, &look);
            contact.switch::<N>(law, what, &look);
            contact.come_loose(law, &look);
            match (roller, what) {
                (Some(roller), What::Touch) => rolling_stages::begin::<N>(roller, (&contact, law), &look),
                (Some(roller), _) => rolling_stages::switch(roller, &contact, what, &look),
                (None, _) => {}
            }
        }
        slid
    });
    world.resource_mut::<Ledger>().friction.add(slid);
}

/// Notes which bodies begin to touch, for who asks: those of open contacts that are touched now, if no other contact between
/// the two holds.
fn note_begun(world: &mut World, fired: &[usize]) {
    let begun = view(world, |view| {
        let between = |view: &View, place: usize| {
            let case = view.look(place).case;
            match case.other {
                Other::Atom(other) => (false, other.body, case.end.body),
                Other::Wall(wall) => (true, case.end.body, wall as usize),
            }
        };
        let touched: Vec<usize> = fired
            .iter()
            .map(|&place| view.contacts.told[place])
            .filter(|told| matches!(told.1, What::Touch))
            .map(|told| told.0 as usize)
            .collect();
        let mut begun: Vec<_> = touched.into_iter().map(|place| between(view, place)).collect();
        begun.sort_unstable();
        begun.dedup();
        for place in 0..if begun.is_empty() { 0 } else { view.len() } {
            if view.contact(place).0.mode != Mode::Open {
                let pair = between(view, place);
                begun.retain(|other| *other != pair);
            }
        }
        begun
    });
    let mut touches = world.resource_mut::<Touches>();
    for (is_wall, a, b) in begun {
        if is_wall { touches.wall_begins(a, b as u32) } else { touches.bodies_begin(a, b) }
    }
}

impl View<'_> {
    /// Energy in J of those tangential and rolling springs whose grip is asked for.
    pub fn stored(&mut self, which: impl Fn(Grip) -> bool) -> f64 {
        let mut sum = 0.0;
        for place in 0..self.len() {
            let (contact, law) = self.contact(place);
            if contact.mode == Mode::Open {
                continue;
            }
            if which(contact.tangential.grip) {
                sum += contact.tangential.energy(&law.tangential());
            }
            drop(contact);
            if self.rolling.is_some() {
                let look = self.look(place);
                if let (_, _, Some((slider, law))) = self.whole(place, &look)
                    && which(slider.grip)
                {
                    sum += slider.energy(&law);
                }
            }
        }
        sum
    }

    /// What the springs that slip have given since the step began, in J: it is lost beside what slipping took.
    fn close_slides(&mut self) -> f64 {
        let now = self.sliding_energy();
        std::mem::replace(&mut self.contacts.slid, now) - now
    }

    fn sliding_energy(&mut self) -> f64 {
        self.stored(|grip| grip == Grip::Slide)
    }
}

fn settle<N: NormalForce>(world: &mut World) -> bool {
    let mut corrected = false;
    view(world, |view| {
        for place in 0..view.len() {
            let look = view.look(place);
            let (mut contact, law, mut roller) = view.whole(place, &look);
            if contact.mode == Mode::Hold {
                let (least, greatest) = N::band(law, contact.overlap, contact.normal_force);
                if contact.normal_force < least || contact.normal_force > greatest {
                    contact.mode = if contact.normal_force < least { Mode::Unloading } else { Mode::Loading };
                    contact.come_loose(law, &look);
                    if let Some((slider, law)) = &mut roller {
                        rolling_stages::come_loose((slider, *law), &contact, &look);
                    }
                    corrected = true;
                }
            }
            if let Some(roller) = roller.filter(|_| contact.mode != Mode::Open) {
                corrected |= rolling_stages::settle(roller, &contact);
            }
            if contact.mode != Mode::Open && contact.tangential.grip == Grip::Hold {
                let force = contact.tangential.held;
                if force.abs() > law.friction_static * contact.normal_force {
                    contact.tangential.grip = Grip::Slide;
                    corrected = true;
                }
            }
        }
        if !corrected {
            view.contacts.slid = view.sliding_energy();
        }
    });
    corrected
}

fn take_stock<N: NormalForce>(world: &mut World) {
    view(world, |view| {
        for place in 0..view.len() {
            let look = view.look(place);
            let (mut contact, law, roller) = view.whole(place, &look);
            if contact.mode == Mode::Open && look.overlap > 0.0 {
                contact.overlap = look.overlap;
                contact.begin::<N>(law, &look);
                if let Some(roller) = roller {
                    rolling_stages::begin::<N>(roller, (&contact, law), &look);
                }
            }
            if contact.mode != Mode::Open && contact.mode != Mode::Hold {
                contact.mode = standing::<N>(law, contact.mode, look.parting());
            }
        }
    });
}

/// The mode of a contact that parts with `parting` m/s; one that does neither is held, for a first try.
fn standing<N: NormalForce>(law: &PairLaw, present: Mode, parting: f64) -> Mode {
    if parting == 0.0 && N::SET_VALUED && N::dissipates(law) { Mode::Hold } else { N::chosen(present, parting) }
}

/// After a step: what is held stands, and the deepest overlap is noted.
fn tidy(world: &mut World) -> bool {
    if is_idle(world) {
        return false;
    }
    let (time, dt) = (world.resource::<Evaluation>().time, world.resource::<Clock>().dt);
    let (slid, lost, rows) = view(world, |view| {
        let slid = view.close_slides();
        let lost = view.contacts.held_before.take().map(|before| {
            let lost = before - view.stored(|_| true);
            view.contacts.slid = view.sliding_energy();
            lost
        });
        (slid, lost, !view.contacts.rows.is_empty())
    });
    let mut ledger = world.resource_mut::<Ledger>();
    ledger.friction.add(slid);
    if let Some(lost) = lost {
        ledger.friction.add(lost);
    }
    let moved = rows && stop_rows(world, dt);
    lend(world, |world, deepest: &mut DeepestOverlap| view(world, |view| view.note_overlaps(time, deepest)));
    moved
}

/// Takes out of velocities what rounding has left along held rows, and books it. Says whether there was anything.
fn stop_rows(world: &mut World, dt: f64) -> bool {
    lend(world, |world, contacts: &mut PenaltyContacts| {
        lend(world, |world, bodies: &mut Bodies| {
            let mut ledger = world.resource_mut::<Ledger>();
            let before = (momentum(bodies), angular_momentum(bodies));
            let moved = contacts.rows.stop(bodies, dt, &mut ledger);
            let by = momentum(bodies) - before.0;
            ledger.impulse[0].add(by.x);
            ledger.impulse[1].add(by.y);
            ledger.angular_impulse.add(angular_momentum(bodies) - before.1);
            moved
        })
    })
}

impl View<'_> {
    fn note_overlaps(&mut self, time: f64, deepest: &mut DeepestOverlap) {
        for place in 0..self.len() {
            if self.contact(place).0.mode == Mode::Open {
                continue;
            }
            let look = self.look(place);
            let entity = |body: usize| self.bodies.entity[body];
            let (b, radius) = (look.case.end.body, look.case.end.radius);
            let other = match look.case.other {
                Other::Atom(a) => (entity(a.body), a.radius),
                Other::Wall(wall) => (self.bodies.walls[wall as usize].entity, f64::INFINITY),
            };
            deepest.note(look.overlap, radius.min(other.1), time, || (other.0, entity(b)));
        }
    }
}

impl Contact {
    /// A pair begins to touch.
    fn begin<N: NormalForce>(&mut self, law: &PairLaw, look: &Look) {
        self.mode = standing::<N>(law, Mode::Loading, look.parting());
        self.tangential = Slider::default();
        if !law.tangential().acts() {
            return;
        }
        let sliding = look.sliding(law);
        let sticks = if law.exact {
            sliding == 0.0
        } else {
            // Near the touch both forces grow from zero: the spring's with the way along, the limit with the overlap.
            let rate = N::smooth_force(law, Mode::Loading, 1.0, Approach::default());
            look.overlap > 0.0
                || law.tangential_stiffness * sliding.abs() <= law.friction_static * rate * look.parting().abs()
        };
        let held = law.exact || sliding == 0.0 && self.mode == Mode::Hold;
        (self.tangential.grip, self.tangential.held) = match (sticks, held) {
            (true, true) => (Grip::Hold, 0.0),
            (true, false) => (Grip::Stick, 0.0_f64.copysign(sliding)),
            (false, _) => (Grip::Slide, 0.0_f64.copysign(sliding)),
        };
    }

    /// One of the contact's modes ends.
    fn switch<N: NormalForce>(&mut self, law: &PairLaw, what: What, look: &Look) {
        match what {
            What::Touch if self.mode == Mode::Open => self.begin::<N>(law, look),
            What::Part => {
                self.mode = N::after(self.mode, true);
                if self.mode == Mode::Open {
                    *self = Self::open(self.law);
                }
            }
            What::Turn => self.mode = N::after(self.mode, false),
            What::Lower => self.mode = Mode::Unloading,
            What::Upper => self.mode = Mode::Loading,
            What::Give(positive) if self.mode != Mode::Open => {
                self.tangential.grip = Grip::Slide;
                self.tangential.held = 0.0_f64.copysign(if positive { 1.0 } else { -1.0 });
                self.slide(law, self.normal_force);
            }
            What::Stop if self.mode != Mode::Open => {
                let held = law.exact || self.mode == Mode::Hold;
                self.tangential.grip = if held { Grip::Hold } else { Grip::Stick };
            }
            What::Touch | What::Give(_) | What::Stop | What::RollingGive(_) | What::RollingStop => {}
        }
    }

    /// Brings the spring into line with a normal mode that has changed: it takes over from a hold when the normal is held no
    /// longer, and one that holds remembers which way it is going.
    fn come_loose(&mut self, law: &PairLaw, look: &Look) {
        let slider = &mut self.tangential;
        if slider.grip == Grip::Hold && !law.exact && self.mode != Mode::Hold {
            slider.let_go(&law.tangential());
        }
        if slider.grip == Grip::Stick {
            slider.held = 0.0_f64.copysign(look.sliding(law));
        }
    }

    /// While it slips: the force along the surface under a normal force, in the direction it has.
    pub(super) fn slide(&mut self, law: &PairLaw, normal_force: f64) {
        let slider = &mut self.tangential;
        slider.held = (law.friction_dynamic * normal_force).abs().copysign(slider.held);
        slider.elongation = if law.exact { 0.0 } else { slider.held / law.tangential_stiffness };
    }

    /// Modes that follow from the state itself.
    pub(super) fn adapt<N: NormalForce>(&mut self, law: &PairLaw, look: &Look, approach: Approach) {
        if look.overlap <= 0.0 {
            *self = Self::open(self.law);
            return;
        }
        self.mode = N::chosen(Mode::Loading, approach.parting);
        let limit = law.friction_dynamic * N::smooth_force(law, self.mode, look.overlap, approach).max(0.0);
        let sliding = look.sliding(law);
        self.tangential.grip = Grip::Slide;
        self.tangential.held = limit.copysign(sliding);
    }
}
