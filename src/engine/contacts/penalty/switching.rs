//! The ends of the modes of contacts, and the modes that follow.
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
//! | touching a feature of a hull | no other one is nearer | touching that one |
//!
//! Accelerations, not velocities, decide a mode that begins at rest. It is tried as held. If the holding forces are out
//! of bounds, it takes the mode beyond the bound.

use super::TangentialLaw;
use super::apply::PenaltyContacts;
use super::contact::Contact;
use super::contact_list::Edited;
use super::coulomb::{Grip, Slider, SliderLaw};
use super::indicators::SliderMotion;
use super::normal::{Approach, Mode, NormalForce};
use super::pair_law::{LawTable, PairLaw};
use super::partial_slip::between;
use super::rolling::RollingContacts;
use super::rolling_stages::{self, Roller};
use super::standing;
use crate::constraints::islands::IslandLink;
use crate::constraints::{Booking, LostTo, Rows};
use crate::contacts::Touches;
use crate::contacts::geometry::{PairGeometry, SideA};
use crate::contacts::{CandidatePairs, DeepestOverlap};
use crate::tick::Ledger;
use crate::tick::ledger::{angular_momentum, momentum};
use crate::world::Bodies;
use serde::{Deserialize, Serialize};

/// The meaning of an indicator of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
    /// The first border of the feature that is kept, or the second, is passed.
    Border(bool),
}

/// The indicators of the current modes: candidate pairs (pairs of atoms first, then surfaces) and their meanings.
pub(super) type Told = Vec<(u32, What)>;

/// All candidate pairs with their contacts.
pub(super) struct View<'a> {
    pub bodies: &'a Bodies,
    pub pairs: &'a CandidatePairs,
    pub contacts: &'a mut PenaltyContacts,
    pub rolling: Option<&'a mut RollingContacts>,
}

impl View<'_> {
    pub fn len(&self) -> usize {
        self.contacts.atoms.len() + self.contacts.surfaces.len()
    }

    /// The indices of the contacts that touch, in order.
    pub fn touching(&self) -> Vec<usize> {
        let PenaltyContacts { atoms, surfaces, .. } = &*self.contacts;
        let count = atoms.len();
        atoms.touching().chain(surfaces.touching().map(|index| count + index)).collect()
    }

    pub fn look(&self, index: usize) -> PairGeometry {
        let atoms = self.contacts.atoms.len();
        match index.checked_sub(atoms) {
            None => PairGeometry::atoms(self.bodies, index, self.pairs.atoms[index]),
            Some(index) => PairGeometry::surface(self.bodies, index, self.pairs.surfaces[index]),
        }
    }

    /// A contact with its law, and its rolling spring in scenes that have them.
    pub fn whole(&mut self, index: usize, geometry: &PairGeometry) -> (Edited<'_>, &PairLaw, Option<Roller<'_>>) {
        let PenaltyContacts { laws, atoms, surfaces, .. } = &mut *self.contacts;
        let count = atoms.len();
        let contact = if index < count { atoms.edit(index) } else { surfaces.edit(index - count) };
        let law = laws.get(contact.law);
        (contact, law, self.rolling.as_deref_mut().and_then(|rolling| rolling.of(geometry, law)))
    }

    pub fn contact(&mut self, index: usize) -> (Edited<'_>, &PairLaw) {
        let PenaltyContacts { laws, atoms, surfaces, .. } = &mut *self.contacts;
        let count = atoms.len();
        let contact = if index < count { atoms.edit(index) } else { surfaces.edit(index - count) };
        let law = laws.get(contact.law);
        (contact, law)
    }
}

/// Contacts whose tangential spring has an elongation that is state.
fn springs(contacts: &PenaltyContacts) -> impl Iterator<Item = Contact> {
    let PenaltyContacts { atoms, surfaces, laws, .. } = contacts;
    let touching = [atoms, surfaces].into_iter().flat_map(|list| list.touching().map(|index| list.get(index)));
    touching.filter(|contact| is_spring(contact, laws))
}

fn is_spring(contact: &Contact, laws: &LawTable) -> bool {
    let law = laws.get(contact.law);
    contact.tangential.is_state(contact.mode) && law.tangential().acts() && !law.exact
}

/// The number of elongations in the state.
pub(super) fn length(contacts: &PenaltyContacts) -> usize {
    springs(contacts).count()
}

/// Contacts -> state.
pub(super) fn read(contacts: &PenaltyContacts, state: &mut [f64]) {
    for (state, contact) in state.iter_mut().zip(springs(contacts)) {
        *state = contact.tangential.elongation;
    }
}

/// State -> contacts.
pub(super) fn write(contacts: &mut PenaltyContacts, state: &[f64]) {
    let PenaltyContacts { atoms, surfaces, laws, .. } = contacts;
    let mut states = state.iter();
    for list in [atoms, surfaces] {
        for index in list.touching().collect::<Vec<_>>() {
            if is_spring(&list.get(index), laws)
                && let Some(&state) = states.next()
            {
                list.edit(index).tangential.elongation = state;
            }
        }
    }
}

/// The rates of elongations that are state.
pub(super) fn rates((bodies, pairs): (&Bodies, &CandidatePairs), contacts: &PenaltyContacts, rates: &mut [f64]) {
    let of_atoms = contacts.atoms.iter().zip(&pairs.atoms).enumerate();
    let of_atoms =
        of_atoms.filter(|(_, (contact, _))| is_spring(contact, &contacts.laws)).map(|(index, (contact, pair))| {
            PairGeometry::atoms(bodies, index, *pair).sliding(contacts.laws.get(contact.law).shares())
        });
    let of_surfaces = contacts.surfaces.iter().zip(&pairs.surfaces).enumerate();
    let of_surfaces =
        of_surfaces.filter(|(_, (contact, _))| is_spring(contact, &contacts.laws)).map(|(index, (contact, pair))| {
            PairGeometry::surface(bodies, index, *pair).sliding(contacts.laws.get(contact.law).shares())
        });
    rates.iter_mut().zip(of_atoms.chain(of_surfaces)).for_each(|(rate, sliding)| *rate = sliding);
}

impl PenaltyContacts {
    /// Whether no pair is near, and no booking of a former pair is due. Then no geometry is needed.
    pub(super) fn is_idle(&self) -> bool {
        let near = !self.atoms.is_empty() || !self.surfaces.is_empty();
        !near && self.held.is_empty() && self.held_before.is_none() && self.slid == 0.0
    }
}

impl View<'_> {
    /// Changes the modes whose indicators vanished. `error`: the error of velocities in m/s that the step was allowed.
    pub fn switch<N: NormalForce>(
        &mut self,
        fired: &[usize],
        error: f64,
        ledger: &mut Ledger,
        touches: Option<&mut Touches>,
    ) {
        if let Some(touches) = touches {
            self.note_begun(fired, touches);
        }
        let slid = self.close_slides();
        // Energy that springs held before and lose by the change is lost. It is booked when all modes have settled.
        self.contacts.held_before = Some(self.stored(|_| true));
        self.grip_stopped();
        self.note_springs();
        let (mut turned, mut gave) = (Vec::new(), Vec::new());
        for &index in fired {
            let Some((pair, what)) = self.told(index) else { continue };
            if let What::Give(positive) = what {
                // Rows that all but depend on each other have huge forces, and give at once. Without the first, forces change.
                let bodies = between(&self.look(pair as usize).pair, self.bodies);
                if gave.contains(&(bodies, !positive)) {
                    continue;
                }
                gave.push((bodies, positive));
            }
            self.note_given(pair as usize, what);
            if matches!(what, What::Lower | What::Upper) {
                // Twice: beside this friction its force left the bounds, so the same friction is not tried again.
                self.contacts.released.extend([pair, pair]);
            }
            let geometry = self.look(pair as usize);
            let bodies = self.bodies;
            let (mut contact, law, roller) = self.whole(pair as usize, &geometry);
            let base = Base::at_touch::<N>(law, &geometry, bodies);
            contact.switch::<N>(law, what, &geometry, base);
            contact.adapt_friction(law, &geometry);
            let (stands, normal_force) =
                (matches!(what, What::Turn) && contact.mode == Mode::Hold, contact.normal_force);
            if stands {
                turned.push(pair);
            }
            if stands && !law.exact {
                let motion = SliderMotion::along(&geometry, law.shares(), bodies);
                contact.tangential.stop_still_swing(&law.tangential(), normal_force, &motion);
            }
            match (roller, what) {
                (Some((slider, rolling_law)), What::Turn) if stands => {
                    let motion = SliderMotion::of_turning(&geometry, bodies);
                    rolling_stages::adapt((&mut *slider, rolling_law), &contact, &geometry);
                    slider.stop_still_swing(&rolling_law, normal_force, &motion);
                }
                (Some(roller), What::Touch) => rolling_stages::begin(roller, &contact, &geometry, Some(base)),
                (Some(roller), _) => rolling_stages::switch(roller, &contact, what, &geometry),
                (None, _) => {}
            }
        }
        self.give_together(&gave);
        let stopped = self.contacts.stopped.clone();
        self.contacts.turned.clone_from(&turned);
        standing::stop_together::<N>(self, &stopped, 0.0);
        standing::stop_together::<N>(self, &turned, error);
        ledger.friction.add(slid);
    }

    /// Adds rows for those that stop at this event and hold without a spring. So [`stand_still`] takes away the velocity that the
    /// location of the event left. If they yield again, forces decide the direction, and not the sign of that remainder.
    pub(super) fn hold_stopped(&mut self, fired: &[usize], rows: &mut Rows) {
        let mut held = std::mem::take(&mut self.contacts.held);
        let mut stopped = std::mem::take(&mut self.contacts.stopped);
        stopped.clear();
        for &index in fired {
            let Some((pair, what)) = self.told(index) else { continue };
            if !matches!(what, What::Stop | What::RollingStop) {
                continue;
            }
            let (geometry, bodies) = (self.look(pair as usize), self.bodies);
            let (contact, law, roller) = self.whole(pair as usize, &geometry);
            match (what, roller) {
                // Friction that never has a spring keeps no remainder that one could draw.
                (What::Stop, _) if contact.holds_rigidly(law) && !law.exact => {
                    held.add_tangent(rows, &geometry, law, &contact, bodies);
                    stopped.push(pair);
                }
                (What::RollingStop, Some((slider, rolling_law))) if contact.mode == Mode::Hold => {
                    let pull = law.stiffness * geometry.overlap;
                    held.add_rolling(rows, &geometry, rolling_stages::share(slider, &rolling_law, pull), bodies);
                }
                _ => {}
            }
        }
        (self.contacts.held, self.contacts.stopped) = (held, stopped);
    }

    /// The contact of an indicator, and its change. `None` if it is gone.
    fn told(&self, index: usize) -> Option<(u32, What)> {
        self.contacts.told.get(index).copied().filter(|told| (told.0 as usize) < self.len())
    }

    /// The friction that the event stopped holds from now on.
    fn grip_stopped(&mut self) {
        let mut stopped = std::mem::take(&mut self.contacts.stopped);
        // A list from before may name contacts that are gone.
        stopped.retain(|&index| (index as usize) < self.len());
        for &index in &stopped {
            self.contact(index as usize).0.tangential.grip = Grip::Hold;
        }
        self.contacts.stopped = stopped;
    }

    /// A friction that stopped beside others held before this moment, too: forces choose its direction if it yields.
    pub(super) fn note_stopped(&mut self, index: usize, slider: Slider) {
        let PenaltyContacts { stopped, before, .. } = &mut *self.contacts;
        stopped.push(index as u32);
        if let Some(before) = before.get_mut(index) {
            before[0] = Some(slider);
        }
    }

    /// A friction that gives way at this event was beyond its cone. Its slide is no try, so nothing takes it back.
    fn note_given(&mut self, index: usize, what: What) {
        if let Some(before) = self.contacts.before.get_mut(index) {
            match what {
                What::Give(_) => before[0] = None,
                What::RollingGive(_) => before[1] = None,
                _ => {}
            }
        }
    }

    /// The bodies of a contact that move by forces.
    pub(super) fn movable(&self, index: usize) -> impl Iterator<Item = usize> + use<'_> {
        let pair = self.look(index).pair;
        [Some(pair.b.body), pair.other_body()].into_iter().flatten().filter(|&body| self.bodies.dynamic[body])
    }

    /// Notes the springs that hold, stick or slip.
    pub(super) fn note_springs(&mut self) {
        let mut before = std::mem::take(&mut self.contacts.before);
        before.clear();
        // One that begins at this moment begins with its springs, whatever modes are tried.
        let exact = self.contacts.settings.tangential == TangentialLaw::Exact;
        let begins = [Some(Slider::default()).filter(|_| !exact), Some(Slider::default())];
        before.resize(self.len(), begins);
        let fresh = std::mem::take(&mut self.contacts.fresh);
        for index in self.touching() {
            if fresh.contains(&(index as u32)) {
                continue;
            }
            let geometry = self.look(index);
            let (contact, law, roller) = self.whole(index, &geometry);
            let noted = |slider: &Slider| match slider.grip {
                Grip::Slide => None,
                _ => Some(*slider),
            };
            let tangential = noted(&contact.tangential).filter(|_| !law.exact);
            before[index] = [tangential, roller.and_then(|(slider, _)| noted(slider))];
        }
        self.contacts.before = before;
    }

    /// Notes the bodies that begin to touch, for their observers. They are those of open contacts that now touch, if no
    /// other contact between the two holds.
    fn note_begun(&mut self, fired: &[usize], touches: &mut Touches) {
        let between = |view: &Self, index: usize| {
            let case = view.look(index).pair;
            match case.a {
                SideA::Atom(other) => (false, other.body, case.b.body),
                SideA::Hull(other) => (false, other.body.min(case.b.body), other.body.max(case.b.body)),
                SideA::Wall(wall) => (true, case.b.body, wall as usize),
            }
        };
        let touched: Vec<usize> = fired
            .iter()
            .filter_map(|&index| self.told(index))
            .filter(|told| matches!(told.1, What::Touch))
            .map(|told| told.0 as usize)
            .collect();
        let mut begun: Vec<_> = touched.into_iter().map(|index| between(self, index)).collect();
        begun.sort_unstable();
        begun.dedup();
        for index in if begun.is_empty() { Vec::new() } else { self.touching() } {
            let pair = between(self, index);
            begun.retain(|other| *other != pair);
        }
        for (is_wall, a, b) in begun {
            if is_wall { touches.wall_begins(a, b as u32) } else { touches.bodies_begin(a, b) }
        }
    }

    /// Energy in J of those tangential and rolling springs whose grip is asked for.
    pub fn stored(&mut self, which: impl Fn(Grip) -> bool) -> f64 {
        let mut sum = 0.0;
        for index in self.touching() {
            let (contact, law) = self.contact(index);
            if which(contact.tangential.grip) {
                sum += contact.tangential.energy(&law.tangential());
            }
            drop(contact);
            if self.rolling.is_some() {
                let geometry = self.look(index);
                if let (_, _, Some((slider, law))) = self.whole(index, &geometry)
                    && which(slider.grip)
                {
                    sum += slider.energy(&law);
                }
            }
        }
        sum
    }

    /// The energy in J that the slipping springs have released since the step began. It is lost beside the work of
    /// slipping.
    pub(super) fn close_slides(&mut self) -> f64 {
        let now = self.sliding_energy();
        std::mem::replace(&mut self.contacts.slid, now) - now
    }

    pub(super) fn sliding_energy(&mut self) -> f64 {
        self.stored(|grip| grip == Grip::Slip)
    }
}

/// The mode of a contact that parts with `parting` m/s. If it neither parts nor approaches, it is held for a first try.
pub(super) fn standing_mode<N: NormalForce>(law: &PairLaw, present: Mode, parting: f64) -> Mode {
    if parting == 0.0 && N::SET_VALUED && N::dissipates(law) { Mode::Hold } else { N::chosen(present, parting) }
}

/// The limit of friction: the normal force in newtons, and its rate in N/s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Base {
    pub force: f64,
    pub rate: f64,
    /// Whether nothing presses the sides together, now and later in the mode.
    pub is_slack: bool,
}

impl Base {
    /// At the first touch, when a spring holds no force yet.
    fn at_touch<N: NormalForce>(law: &PairLaw, geometry: &PairGeometry, bodies: &Bodies) -> Self {
        let approach = geometry.approach(bodies);
        Self {
            force: N::smooth_force(law, Mode::Loading, 0.0, approach),
            rate: N::force_rate(law, Mode::Loading, approach, geometry.change(law, bodies)),
            is_slack: false,
        }
    }

    /// Of a contact as it was evaluated; a held force does not change.
    pub fn of<N: NormalForce>(contact: &Contact, law: &PairLaw, geometry: &PairGeometry, bodies: &Bodies) -> Self {
        let rate = match contact.mode {
            Mode::Hold => 0.0,
            mode => N::force_rate(law, mode, geometry.approach(bodies), geometry.change(law, bodies)),
        };
        let is_slack = contact.mode != Mode::Hold && contact.normal_force == 0.0 && rate == 0.0;
        Self { force: contact.normal_force, rate, is_slack }
    }

    /// Whether a spring without elongation that is stretched at `velocity` sticks at first. With a damper it sticks at
    /// once. With a spring alone both forces grow from zero: the spring's with the way along, the limit with the
    /// overlap.
    pub fn bears(self, law: &SliderLaw, velocity: f64) -> bool {
        self.force > 0.0 || law.stiffness * velocity.abs() <= law.friction_static * self.rate.max(0.0)
    }
}

/// After a step: stops held contacts, and notes the deepest overlap. Returns whether velocities have changed.
pub(super) fn tidy(
    (bodies, ledger, rows): (&mut Bodies, &mut Ledger, &mut Rows),
    (time, dt): (f64, f64),
    (pairs, contacts, mut rolling): (&CandidatePairs, &mut PenaltyContacts, Option<&mut RollingContacts>),
    deepest: &mut DeepestOverlap,
) -> bool {
    let mut view = View { bodies, pairs, contacts, rolling: rolling.as_deref_mut() };
    ledger.friction.add(view.close_slides());
    if let Some(before) = view.contacts.held_before.take() {
        let lost = before - view.stored(|_| true);
        view.contacts.slid = view.sliding_energy();
        ledger.friction.add(lost);
    }
    let moved = stand_still((bodies, ledger, rows), contacts, dt);
    View { bodies, pairs, contacts, rolling }.note_overlaps(time, deepest);
    moved
}

/// Removes from velocities the remainders of rounding and of the step's error along held rows, and books them. So a
/// contact that yields begins to move in the direction of the forces, not of an error. Returns whether there were any.
pub(super) fn stand_still(
    (bodies, ledger, rows): (&mut Bodies, &mut Ledger, &mut Rows),
    contacts: &PenaltyContacts,
    dt: f64,
) -> bool {
    if contacts.held.is_empty() {
        return false;
    }
    let before = (momentum(bodies), angular_momentum(bodies));
    let moved = rows.stop(bodies, dt, |booking| match booking {
        Booking::Lost(LostTo::Inelasticity, energy) => ledger.inelasticity.add(energy),
        Booking::Lost(LostTo::Friction, energy) => ledger.friction.add(energy),
        Booking::Work(energy) => ledger.work.add(energy),
    });
    let by = momentum(bodies) - before.0;
    ledger.impulse[0].add(by.x);
    ledger.impulse[1].add(by.y);
    ledger.angular_impulse.add(angular_momentum(bodies) - before.1);
    moved
}

impl View<'_> {
    fn note_overlaps(&mut self, time: f64, deepest: &mut DeepestOverlap) {
        for index in self.touching() {
            let geometry = self.look(index);
            let size = match index.checked_sub(self.contacts.atoms.len()) {
                Some(surface) => self.pairs.surfaces[surface].size(self.bodies),
                None => geometry.pair.other_end().map_or(f64::INFINITY, |a| a.radius).min(geometry.pair.b.radius),
            };
            deepest.note(geometry.overlap, size, time, || geometry.pair.entities(self.bodies));
        }
    }
}

impl Contact {
    /// A pair begins to touch, under the normal force of that moment. Without a force it touches when the motion
    /// begins.
    pub(super) fn begin<N: NormalForce>(&mut self, law: &PairLaw, geometry: &PairGeometry, base: Option<Base>) {
        self.mode = standing_mode::<N>(law, Mode::Loading, geometry.parting());
        self.tangential = Slider::default();
        if !law.tangential().acts() {
            return;
        }
        let sliding = geometry.sliding(law.shares());
        let sticks =
            if law.exact { sliding == 0.0 } else { base.is_none_or(|base| base.bears(&law.tangential(), sliding)) };
        let held = law.exact || sliding == 0.0 && self.mode == Mode::Hold;
        (self.tangential.grip, self.tangential.held) = match (sticks, held) {
            (true, true) => (Grip::Hold, 0.0),
            (true, false) => (Grip::Stick, 0.0_f64.copysign(sliding)),
            (false, _) if self.holds_rigidly(law) => (Grip::Slide, 0.0_f64.copysign(sliding)),
            (false, _) => (Grip::Slip, 0.0_f64.copysign(sliding)),
        };
    }

    /// One of the contact's modes ends.
    fn switch<N: NormalForce>(&mut self, law: &PairLaw, what: What, geometry: &PairGeometry, base: Base) {
        match what {
            What::Touch if self.mode == Mode::Open => self.begin::<N>(law, geometry, Some(base)),
            What::Part => {
                self.mode = N::after(self.mode, true);
                if self.mode == Mode::Open {
                    *self = Self::open(self.law);
                }
            }
            What::Turn => self.mode = N::after(self.mode, false),
            What::Lower => self.mode = Mode::Unloading,
            What::Upper => self.mode = Mode::Loading,
            What::Give(positive) if self.mode != Mode::Open => self.give(law, positive),
            What::Stop if self.mode != Mode::Open => {
                self.tangential.stop();
            }
            What::Touch | What::Give(_) | What::Stop | What::RollingGive(_) | What::RollingStop | What::Border(_) => {}
        }
    }

    /// Friction gives way with a force of this sign.
    pub(super) fn give(&mut self, law: &PairLaw, positive: bool) {
        self.tangential.give(positive, self.holds_rigidly(law));
        self.slide(law, self.normal_force);
    }

    /// Adapts friction to a normal mode that has changed.
    pub(super) fn adapt_friction(&mut self, law: &PairLaw, geometry: &PairGeometry) {
        self.tangential.adapt(self.mode, geometry.sliding(law.shares()));
    }

    /// Whether friction acts without a spring: at rest along the normal, after it has rested, or if it has none.
    pub(super) fn holds_rigidly(&self, law: &PairLaw) -> bool {
        law.exact || self.mode == Mode::Hold || self.tangential.grip.is_rigid()
    }

    /// While it slips: the force along the surface under a normal force, in the direction it has.
    pub(super) fn slide(&mut self, law: &PairLaw, normal_force: f64) {
        self.tangential.slide(&law.tangential(), normal_force);
    }

    /// Modes that follow from the state itself.
    pub(super) fn adapt<N: NormalForce>(&mut self, law: &PairLaw, geometry: &PairGeometry, approach: Approach) {
        if geometry.overlap <= 0.0 {
            *self = Self::open(self.law);
            return;
        }
        self.mode = N::chosen(Mode::Loading, approach.parting);
        if !law.tangential().acts() {
            self.tangential = Slider::default();
            return;
        }
        let limit = law.friction_dynamic * N::smooth_force(law, self.mode, geometry.overlap, approach).max(0.0);
        let sliding = geometry.sliding(law.shares());
        self.tangential.grip = if law.exact { Grip::Slide } else { Grip::Slip };
        self.tangential.held = limit.copysign(sliding);
    }
}
