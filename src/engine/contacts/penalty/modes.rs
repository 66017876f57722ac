//! The choice of modes of contacts for the tick to come: loading, unloading, or held by the rest solver.

use glam::DVec2;

use super::apply::{Own, PenaltyContacts, Shared, Sink, approach};
use super::contact::{Contact, Losses};
use super::contact_list::Edited;
use super::coulomb::{Slider, SliderLaw};
use super::indeterminate::{self, Resting};
use super::joined::{Joined, find_joined, joint_row};
use super::normal::{Approach, Mode, NormalForce};
use super::pair_law::PairLaw;
use super::partial_slip;
use super::rest::Rest;
use super::rolling::{RollingContacts, twist};
use super::search_schedule::{Found, MANY};
use super::waking::{Lists, Waking};
use crate::constraints::Rows;
use crate::constraints::islands::{IslandLink, Islands, Marked, Members};
use crate::constraints::rest_solver::{
    ContactOutcome, CoulombSpring, FrictionOutcome, Island, Mover, MovingFrame, RestContact,
};
use crate::contacts::geometry::{ContactEnd, ContactSides, Listed, PairGeometry, SideA};
use crate::contacts::{CandidatePairs, SurfacePair};
use crate::tick::steady::SteadySprings;
use crate::tick::{Clock, Ledger, Span, Stability};
use crate::world::Bodies;

/// Working memory of the search for rest.
#[derive(Default)]
pub(super) struct Scratch {
    touching: Vec<u32>,
    cases: Vec<ContactSides>,
    joined: Vec<Joined>,
    /// Bodies with a contact that does not stop.
    moved: Marked,
    islands: Islands,
    members: Members,
    island: Island,
    waking: Waking,
}

/// Touching pairs choose loading, unloading or hold for the coming step. If that changes a force, the sums are corrected by the
/// difference. Returns whether a force has changed on a body that joints hold.
pub(super) fn choose<N: NormalForce>(
    Shared { bodies, rates, ledger, evaluation, rows }: Shared,
    (clock, span): (&Clock, &Span),
    Own { pairs, contacts, rolling, forces }: Own,
    (stability, steady): (&Stability, &SteadySprings),
    scratch: &mut Scratch,
) -> bool {
    contacts.watch::<N>(bodies, pairs, clock, stability, rates, steady);
    if evaluation.mode.is_staged() {
        return false;
    }
    let sink = Sink { bodies, rates, forces };
    let Scratch { touching, cases, joined, moved, islands, members, island, waking } = scratch;
    let (ticks, losses) = (clock.ticks, Losses::default());
    let thorough = contacts.schedule.tries_thoroughly(ticks);
    let mut choice = Choice { sink, contacts, rolling, rows, dt: span.length, thorough, losses, changed: false };
    choice.wake_touched(pairs, waking);
    // If the normal force may have several values at rest, the search decides which it has. Without it contacts load and unload
    // in turns.
    let restless = if N::SET_VALUED { 0 } else { choice.restless(pairs) };
    if !choice.contacts.schedule.searches(restless, ticks) {
        choice.let_go::<N>(pairs, touching);
        choice.book(ledger);
        return choice.changed;
    }
    choice.sink.bodies.catch_up();
    cases.clear();
    moved.forget(choice.sink.bodies.len());
    touching.clear();
    touching.extend(choice.contacts.atoms.awake_touching().map(|index| index as u32));
    for &index in &*touching {
        let pair = pairs.atoms[index as usize];
        let (a, b) = (ContactEnd::of(choice.sink.bodies, pair.a), ContactEnd::of(choice.sink.bodies, pair.b));
        if !(choice.stands(a.body) && choice.stands(b.body)) {
            let normal = pair.normal(choice.sink.bodies);
            choice.first_look::<N>(ContactSides { index, normal, a: SideA::Atom(a), b }, cases, moved);
        }
    }
    touching.clear();
    touching.extend(choice.contacts.surfaces.awake_touching().map(|index| index as u32));
    for &index in &*touching {
        let pair = pairs.surfaces[index as usize];
        if choice.moves(pair) {
            let geometry = PairGeometry::surface(choice.sink.bodies, index as usize, pair);
            choice.first_look::<N>(geometry.pair, cases, moved);
        }
    }
    let mut found = Found::default();
    find_joined(rows, choice.sink.bodies, joined);
    islands.sort(cases, joined, choice.sink.bodies);
    let mut rest = &**cases;
    while let Some(first) = rest.first() {
        let root = islands.of(first, choice.sink.bodies);
        let (cases, others) = rest.split_at(rest.partition_point(|case| islands.of(case, choice.sink.bodies) == root));
        rest = others;
        let begin = joined.partition_point(|link| islands.of(link, choice.sink.bodies) < root);
        let end = joined.partition_point(|link| islands.of(link, choice.sink.bodies) <= root);
        let joined = &joined[begin..end];
        members.collect(cases, joined, choice.sink.bodies.len());
        let may_rest = members.list.iter().all(|&body| !moved.has(body));
        choice.stop::<N>((cases, joined, members), island, may_rest, ledger, &mut found);
    }
    choice.contacts.schedule.note_tries(found, ticks);
    choice.contacts.schedule.note(found, restless, ticks);
    choice.book(ledger);
    choice.changed
}

/// The choice of modes under way.
struct Choice<'a> {
    sink: Sink<'a>,
    contacts: &'a mut PenaltyContacts,
    rolling: Option<&'a mut RollingContacts>,
    rows: &'a Rows,
    dt: f64,
    /// Whether conjugate gradients are tried in large islands.
    thorough: bool,
    losses: Losses,
    /// Whether a force has changed on a body that joints hold.
    changed: bool,
}

impl Choice<'_> {
    /// Whether a body is at rest or does not move by forces.
    #[inline]
    fn stands(&self, body: usize) -> bool {
        !self.sink.bodies.dynamic[body] || self.contacts.rest.has(body)
    }

    /// Whether a body near a surface, or that of the surface, moves by forces and is not at rest.
    fn moves(&self, pair: SurfacePair) -> bool {
        let (a, b) = pair.bodies(self.sink.bodies);
        !self.stands(b) || a.is_some_and(|a| !self.stands(a))
    }

    /// Bodies at rest that touch one that moves wake, and so do their neighbours.
    fn wake_touched(&mut self, pairs: &CandidatePairs, waking: &mut Waking) {
        let PenaltyContacts { atoms, surfaces, rest, .. } = &mut *self.contacts;
        if rest.is_empty() {
            return;
        }
        // A support that starts pushes no body at rest: forces that hold stay as they are.
        let (bodies, dt) = (&*self.sink.bodies, self.dt);
        let stands = |velocity: DVec2, spin: f64| velocity == DVec2::ZERO && spin == 0.0;
        let starts = |body: usize, bodies: &Bodies| {
            let ahead = bodies.prescribed.ahead(body, dt).is_some_and(|end| !stands(end.velocity, end.spin));
            ahead && stands(bodies.velocity[body], bodies.spin[body])
        };
        let some_start = bodies.prescribed.motions.iter().any(|(body, _)| starts(*body, bodies));
        // A body that was pushed has woken by that.
        if !(std::mem::take(&mut rest.woke) || some_start) {
            return;
        }
        self.sink.bodies.catch_up();
        let bodies = &*self.sink.bodies;
        let moves = |body: usize, rest: &Rest| {
            let still = stands(bodies.velocity[body], bodies.spin[body]) && !(some_start && starts(body, bodies));
            !still || bodies.dynamic[body] && !rest.has(body)
        };
        if waking.spread(Lists { pairs, atoms, surfaces, bodies }, rest, moves) {
            self.contacts.rest.forget_woken();
            self.contacts.lay_asleep(self.sink.bodies, pairs, self.sink.forces.as_deref_mut());
        }
    }

    /// A contact as it is, and its law.
    #[inline]
    fn known(&self, case: &ContactSides) -> (Contact, &PairLaw) {
        let PenaltyContacts { laws, atoms, surfaces, .. } = &*self.contacts;
        let list = if case.listed() == Listed::Atoms { atoms } else { surfaces };
        let contact = list.get(case.index as usize);
        (contact, laws.get(contact.law))
    }

    fn contact(&mut self, case: &ContactSides) -> (Edited<'_>, &PairLaw) {
        let PenaltyContacts { laws, atoms, surfaces, .. } = &mut *self.contacts;
        let list = if case.listed() == Listed::Atoms { atoms } else { surfaces };
        let contact = list.edit(case.index as usize);
        let law = laws.get(contact.law);
        (contact, law)
    }

    /// The rolling spring of a contact, in scenes that have rolling friction.
    fn rolls(&self, case: &ContactSides, pair: &PairLaw) -> Option<CoulombSpring> {
        let (slider, law) = self.slider(case, pair)?;
        Some(slider.drawn(&law))
    }

    /// The rolling spring of a contact as it is, with its law, in scenes that have rolling friction.
    fn slider(&self, case: &ContactSides, pair: &PairLaw) -> Option<(Slider, SliderLaw)> {
        let rolling = self.rolling.as_deref()?;
        let law = rolling.law(pair, case.other_end(), &case.b)?;
        let list = if case.listed() == Listed::Atoms { &rolling.atoms } else { &rolling.surfaces };
        Some((list[case.index as usize], law))
    }

    /// The rolling spring of a contact with its law, in scenes that have rolling friction.
    fn roller(&mut self, case: &ContactSides, pair: &PairLaw) -> Option<(&mut Slider, SliderLaw)> {
        let rolling = self.rolling.as_deref_mut()?;
        let law = rolling.law(pair, case.other_end(), &case.b)?;
        let list = if case.listed() == Listed::Atoms { &mut rolling.atoms } else { &mut rolling.surfaces };
        Some((&mut list[case.index as usize], law))
    }

    /// A contact that cannot stop within the tick chooses by its velocity; the others are noted.
    fn first_look<N: NormalForce>(&mut self, case: ContactSides, cases: &mut Vec<ContactSides>, moved: &mut Marked) {
        let (seen, law) = self.known(&case);
        if seen.mode == Mode::Hold && N::dissipates(law) {
            cases.push(case);
            return;
        }
        let approach = approach(self.sink.bodies, case.other_end(), &case.b, case.normal);
        if case.parts_freely(&seen, self.sink.bodies, approach.parting, self.dt) {
            return;
        }
        if case.could_stop::<N>(&seen, law, self.sink.bodies, approach.parting, self.dt) {
            cases.push(case);
            return;
        }
        moved.mark(case.b.body);
        if let Some(other) = case.other_body() {
            moved.mark(other);
        }
        // Friction without its spring is found anew for each tick.
        if seen.tangential.grip.is_rigid() {
            cases.push(case);
        } else {
            self.choose_by_velocity::<N>(&case, approach);
        }
    }

    fn choose_by_velocity<N: NormalForce>(&mut self, case: &ContactSides, approach: Approach) {
        self.change(case, FrictionOutcome::Follows, |contact, law, losses| {
            contact.choose_mode::<N>(law, approach, FrictionOutcome::Follows, losses)
        });
    }

    /// The number of touching contacts of bodies that are not at rest. If some bodies rest, the count ends at [`MANY`].
    fn restless(&self, pairs: &CandidatePairs) -> usize {
        let PenaltyContacts { atoms, surfaces, rest, .. } = &*self.contacts;
        if rest.is_empty() {
            return atoms.awake_touching_count() + surfaces.awake_touching_count();
        }
        let bodies = &*self.sink.bodies;
        let moves = |atom: u32| !self.stands(bodies.atom_body(atom as usize));
        let of_atoms = atoms.count_touching(MANY, |index| moves(pairs.atoms[index].a) || moves(pairs.atoms[index].b));
        of_atoms + surfaces.count_touching(MANY, |index| self.moves(pairs.surfaces[index]))
    }

    /// Held contacts follow their law again, except those of bodies at rest.
    fn let_go<N: NormalForce>(&mut self, pairs: &CandidatePairs, held: &mut Vec<u32>) {
        held.clear();
        held.extend(self.contacts.atoms.awake_held().map(|index| index as u32));
        for &index in &*held {
            let pair = pairs.atoms[index as usize];
            let (a, b) = (ContactEnd::of(self.sink.bodies, pair.a), ContactEnd::of(self.sink.bodies, pair.b));
            if !(self.stands(a.body) && self.stands(b.body)) {
                self.sink.bodies.catch_up();
                let normal = pair.normal(self.sink.bodies);
                let approach = approach(self.sink.bodies, Some(&a), &b, normal);
                self.choose_by_velocity::<N>(&ContactSides { index, normal, a: SideA::Atom(a), b }, approach);
            }
        }
        held.clear();
        held.extend(self.contacts.surfaces.awake_held().map(|index| index as u32));
        for &index in &*held {
            let pair = pairs.surfaces[index as usize];
            if self.moves(pair) {
                self.sink.bodies.catch_up();
                let geometry = PairGeometry::surface(self.sink.bodies, index as usize, pair);
                self.choose_by_velocity::<N>(&geometry.pair, geometry.approach(self.sink.bodies));
            }
        }
    }

    fn book(&self, ledger: &mut Ledger) {
        ledger.friction.add(self.losses.friction);
        ledger.inelasticity.add(self.losses.inelasticity);
    }

    /// Changes a contact and corrects the sums of forces by the difference. `rolling`: what its rolling spring does.
    fn change(
        &mut self,
        case: &ContactSides,
        rolling: FrictionOutcome,
        change: impl FnOnce(&mut Contact, &PairLaw, &mut Losses) -> Option<Contact>,
    ) {
        let mut losses = self.losses;
        let (mut contact, law) = self.contact(case);
        let law = *law;
        let before = change(&mut contact, &law, &mut losses);
        let after = *contact;
        drop(contact);
        if let Some(before) = before {
            let difference = after.force(&law, case.normal) - before.force(&law, case.normal);
            case.push(&mut self.sink, &law, after.overlap, difference);
            let mut changed = difference != DVec2::ZERO;
            if let Some((slider, rolling_law)) = self.roller(case, &law) {
                let before = slider.force(&rolling_law);
                losses.friction += slider.take_on(&rolling_law, rolling, after.normal_force);
                let difference = slider.force(&rolling_law) - before;
                twist(self.sink.bodies, self.sink.rates, case.other_end(), &case.b, difference);
                changed |= difference != 0.0;
            }
            let jointed = &self.sink.bodies.jointed;
            let mut sides = case.other_body().into_iter().chain([case.b.body]);
            self.changed |= changed && sides.any(|body| jointed.get(body).is_some_and(|is| *is));
        }
        self.losses = losses;
    }

    /// A contact as the search for rest sees it.
    #[inline]
    fn seen<N: NormalForce>(&self, case: &ContactSides, ends: (usize, usize)) -> RestContact {
        let (contact, law) = self.known(case);
        let rolling = self.rolls(case, law).unwrap_or_default();
        RestContact {
            ends,
            arms: case.arms(law.shares(), contact.overlap),
            normal: case.normal,
            band: N::band(law, contact.overlap, contact.normal_force),
            normal_force: contact.normal_force,
            noise: case.noise(law, self.sink.bodies),
            engaged: contact.mode == Mode::Hold,
            parts: contact.mode == Mode::Unloading,
            tangential: contact.tangential.drawn(&law.tangential()),
            rolling,
        }
    }

    /// Stops the contacts of an island as far as their laws allow. If nothing in the island moves then, lays it to rest.
    /// `may_rest`: all of its contacts could stop within the tick.
    fn stop<N: NormalForce>(
        &mut self,
        (cases, joined, members): (&[ContactSides], &[Joined], &Members),
        island: &mut Island,
        may_rest: bool,
        ledger: &mut Ledger,
        found: &mut Found,
    ) {
        // Under one normal force at rest, friction too has one force: that of its spring. Only rest that lasts replaces it.
        if !N::SET_VALUED && members.list.iter().any(|&body| self.sink.bodies.prescribed.leads_on(body)) {
            for case in cases {
                let approach = approach(self.sink.bodies, case.other_end(), &case.b, case.normal);
                self.choose_by_velocity::<N>(case, approach);
            }
            return;
        }
        island.clear();
        let bodies = &*self.sink.bodies;
        island.level = bodies.level;
        island.begin.push(Mover::default());
        island.movers.push(Mover::default());
        island.movers.extend(members.list.iter().map(|&body| mover(bodies, body, self.dt)));
        let begin = |(&body, end): (&usize, &Mover)| match bodies.prescribed.ahead(body, 0.0) {
            Some(_) => mover(bodies, body, 0.0),
            None => Mover { velocity: bodies.velocity[body], spin: bodies.spin[body], ..*end },
        };
        island.begin.extend(members.list.iter().zip(&island.movers[1..]).map(begin));
        // Walls whose surface moves stand behind the bodies.
        let mut belt = island.movers.len()..;
        let surface = |velocity: DVec2| Mover { velocity, ..Mover::default() };
        for list in [&mut island.begin, &mut island.movers] {
            list.extend(cases.iter().filter_map(|case| case.surface(bodies)).map(surface));
        }
        for case in cases {
            let belt = case.surface(self.sink.bodies).and_then(|_| belt.next());
            let other = case.other_body().map_or(belt.unwrap_or(0), |body| members.index(body));
            let seen = self.seen::<N>(case, (other, members.index(case.b.body)));
            island.contacts.push(seen);
        }
        let joint_rows =
            joined.iter().filter_map(|link| joint_row(link.row, self.rows, self.sink.bodies, members, &island.movers));
        island.joint_rows.extend(joint_rows);
        island.set_up(self.dt);
        // The world, to which joints hold, moves with no frame.
        let frame = if joined.is_empty() { self.frame(cases, &members.list, &island.movers[1..]) } else { None };
        let place_of = |mover: usize, bodies: &Bodies| {
            mover
                .checked_sub(1)
                .and_then(|member| members.list.get(member))
                .map_or(DVec2::ZERO, |&body| bodies.position[body])
        };
        if let Some(frame) = frame {
            let each = island.movers.iter_mut().enumerate();
            each.for_each(|(index, mover)| frame.enter(mover, place_of(index, self.sink.bodies)));
        }
        let affordable = !N::SET_VALUED || island.is_small();
        let tries = may_rest && !affordable && self.thorough && island.is_slow(self.dt);
        found.tried |= tries;
        let holds = |contact: &RestContact| contact.tangential.phase.is_rigid() || contact.rolling.phase.is_rigid();
        let holds_beside_motion = N::SET_VALUED && island.contacts.iter().any(holds);
        island.solve((may_rest || holds_beside_motion) && affordable || tries, self.dt);
        self.end_partial_slip(cases, island);
        let mut entirely = may_rest;
        for (case, outcome) in cases.iter().zip(island.outcomes(self.dt)) {
            match outcome {
                ContactOutcome::Moves { approaches, tangential, rolling } => {
                    entirely = false;
                    let mut approach = approach(self.sink.bodies, case.other_end(), &case.b, case.normal);
                    if !N::DEPENDS_ON_VELOCITY {
                        approach.parting = if approaches { -1.0 } else { 1.0 };
                    }
                    self.change(case, rolling, |contact, law, losses| {
                        contact.choose_mode::<N>(law, approach, tangential, losses)
                    });
                }
                ContactOutcome::Rests { normal, tangential, rolling, entirely: stops } => {
                    entirely &= stops;
                    self.change(case, rolling, |contact, law, losses| {
                        let before = *contact;
                        contact.hold(law, normal, tangential, losses);
                        Some(before)
                    });
                }
            }
        }
        if !entirely {
            return;
        }
        if let Some(frame) = frame {
            let each = island.movers.iter_mut().enumerate();
            each.for_each(|(index, mover)| frame.leave(mover, place_of(index, self.sink.bodies)));
        }
        island.find_loads();
        let loads = island.loads();
        let bodies = &*self.sink.bodies;
        let stands = |(&body, (end, &load)): (&usize, (&Mover, &f64))| {
            let begin = Mover { velocity: bodies.velocity[body], spin: bodies.spin[body], ..*end };
            [&begin, end].into_iter().all(|mover| mover.stands(load, bodies.extent(body), self.dt))
        };
        if members.list.iter().zip(island.movers.iter().zip(loads).skip(1)).all(stands) {
            if N::SET_VALUED && joined.is_empty() {
                self.share_out(cases, island);
            }
            self.lay_to_rest(&members.list, &loads[1..], ledger);
            found.rest = true;
            found.tried &= !tries;
        } else {
            found.stops |= cases.len() > MANY / 8;
        }
    }

    /// A contact that slides in the tick to come has the dynamic coefficient. It has the static one if another of the same bodies sticks.
    fn end_partial_slip(&mut self, cases: &[ContactSides], island: &Island) {
        let slides = |outcome: ContactOutcome| matches!(outcome.tangential(), FrictionOutcome::Slides(_));
        if !self.contacts.laws.some_drop() || !island.outcomes(self.dt).any(slides) {
            return;
        }
        let seen = cases.iter().zip(island.outcomes(self.dt)).map(|(case, outcome)| {
            let (contact, law) = self.known(case);
            let grip = contact.tangential.grip_after(outcome.tangential());
            (*case, case.arms(law.shares(), contact.overlap).1, grip)
        });
        for index in partial_slip::all_slide(seen, self.sink.bodies) {
            let law = self.known(&cases[index]).0.law;
            let other = self.contacts.laws.twin(law);
            if other < law {
                self.contact(&cases[index]).0.law = other;
            }
        }
    }

    /// An island at rest takes those forces that balance its loads and are nearest to the springs of its contacts.
    fn share_out(&mut self, cases: &[ContactSides], island: &Island) {
        let resting = cases.iter().zip(&island.contacts).map(|(case, seen)| {
            let (contact, law) = self.known(case);
            let (slider, rolling) = self.slider(case, law).unwrap_or_default();
            let found = [contact.normal_force, contact.tangential_force(law), slider.force(&rolling)];
            Resting { seen, contact, law: *law, rolling: rolling.stiffness * slider.elongation, found }
        });
        let resting: Vec<Resting> = resting.collect();
        let Some(forces) = indeterminate::nearest(&resting, &island.movers) else { return };
        for (case, [normal, tangential, rolling]) in cases.iter().zip(forces) {
            self.change(case, FrictionOutcome::Holds(rolling), |contact, law, losses| {
                let before = *contact;
                contact.hold(law, normal, FrictionOutcome::Holds(tangential), losses);
                Some(before)
            });
        }
    }

    /// The frame of the carrier of an island: its first member that moves as prescribed, or its first belt. `movers` are those of
    /// its members and belts.
    fn frame(&self, island: &[ContactSides], members: &[usize], movers: &[Mover]) -> Option<MovingFrame> {
        let bodies = &*self.sink.bodies;
        let carries = |mover: &Mover| mover.inverse_mass == 0.0 && (mover.velocity != DVec2::ZERO || mover.spin != 0.0);
        let index = movers.iter().position(carries)?;
        // A wall has no centre to turn about.
        let turns = island.iter().all(|case| case.other_body().is_some());
        let Mover { velocity, spin, .. } = movers[index];
        let origin = members.get(index).map_or(DVec2::ZERO, |&body| bodies.position[body]);
        Some(MovingFrame { origin, velocity, spin: if turns { spin } else { 0.0 } })
    }

    fn lay_to_rest(&mut self, members: &[usize], loads: &[f64], ledger: &mut Ledger) {
        for (&body, &load) in members.iter().zip(loads) {
            let bodies = &mut *self.sink.bodies;
            if !bodies.dynamic[body] {
                continue;
            }
            // The contacts take up the motion that rounding left.
            let momentum = bodies.velocity[body] * bodies.mass[body];
            let angular = bodies.inertia[body] * bodies.spin[body];
            ledger.impulse[0].add(-momentum.x);
            ledger.impulse[1].add(-momentum.y);
            ledger.angular_impulse.add(-bodies.position[body].perp_dot(momentum) - angular);
            self.losses.inelasticity += 0.5 * (momentum.dot(bodies.velocity[body]) + angular * bodies.spin[body]);
            self.sink.rates.outside(bodies.position[body], -bodies.force[body], -bodies.torque[body]);
            self.contacts.rest.lay(body, load, bodies);
        }
    }
}

/// A body with the velocities it will have after `dt` seconds under the present forces.
fn mover(bodies: &Bodies, body: usize, dt: f64) -> Mover {
    if let Some(state) = bodies.prescribed.ahead(body, dt) {
        return Mover { velocity: state.velocity, spin: state.spin, ..Mover::default() };
    }
    let (inverse_mass, inverse_inertia) = (bodies.inverse_mass(body), bodies.inverse_inertia(body));
    Mover {
        velocity: bodies.velocity[body] + bodies.force[body] * (inverse_mass * dt),
        spin: bodies.spin[body] + bodies.torque[body] * (inverse_inertia * dt),
        inverse_mass,
        inverse_inertia,
    }
}
