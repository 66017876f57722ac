//! The effect of a motion on contacts, one or several side by side: springs are stretched, yield and release.

use super::contact::Contact;
use super::contact_list::Phases;
use super::coulomb::{Grip, Slider};
use super::normal::{Approach, Mode, NormalForce, lost_work};
use super::pair_law::PairLaw;
use jostle_simd::Lanes;

/// Geometry of touches of side A and side B.
#[derive(Clone, Copy)]
pub(super) struct Touch<V> {
    /// Unit normal from A to B.
    pub normal: (V, V),
    /// Overlap in metres, positive when touching.
    pub overlap: V,
    /// The approach of the sides, for laws that depend on it.
    pub approach: Approach<V>,
    /// Displacement of B's centre relative to A's since the last accepted state, in metres.
    pub displacement: (V, V),
    /// Turn of the line of centres in that time, in radians; zero for walls.
    pub swing: V,
    /// Radius and turn of side A since then.
    pub rolled_a: (V, V),
    /// Radius and turn of side B since then.
    pub rolled_b: (V, V),
}

impl<V: Lanes> Touch<V> {
    /// Share of the displacement that was made in touch, for pairs that did not touch before. Without it a contact that
    /// begins inside a tick and sticks would be of first order.
    #[inline(always)]
    fn share_in_touch(&self, began: V::Mask) -> V {
        let one = V::splat(1.0);
        if V::bits(began) == 0 {
            return one;
        }
        let along = self.displacement.0 * self.normal.0 + self.displacement.1 * self.normal.1;
        let within = began & (-along).gt(self.overlap);
        if V::bits(within) == 0 {
            return one;
        }
        V::select(within, self.overlap.at_least_zero() / -along, one)
    }

    /// Displacement of B relative to A along the contact, in metres, to second order in the step. Tangent and lever
    /// arms are those of the middle of the step.
    #[inline(always)]
    fn tangential_displacement(&self, law: &PairLaw<V>, before: V, overlap: V) -> V {
        let half = V::splat(0.5);
        let middle = half * (before + overlap);
        let ((x, y), (dx, dy)) = (self.normal, self.displacement);
        let along = (dy * x - dx * y) + half * self.swing * (dx * x + dy * y);
        let ((radius_a, turn_a), (radius_b, turn_b)) = (self.rolled_a, self.rolled_b);
        along - (radius_a - law.share_a * middle) * turn_a - (radius_b - law.share_b * middle) * turn_b
    }
}

/// The history of contacts, in the form of [`super::contact_list::ContactList`].
#[derive(Clone, Copy)]
pub(super) struct Followed<V: Lanes> {
    pub overlap: V,
    pub normal_force: V,
    pub elongation: V,
    pub held: V,
    pub loading: V::Mask,
    pub unloading: V::Mask,
    pub slips: V::Mask,
    pub slides: V::Mask,
}

/// Energy lost in J.
#[derive(Clone, Copy)]
pub(super) struct Lost<V> {
    pub friction: V,
    pub inelasticity: V,
}

impl<V: Lanes> Followed<V> {
    /// Follows pairs to the state that `touch` describes, in their present modes; only those `among`. Pairs that were open
    /// begin to load. `elapsed` seconds have passed since the last accepted state.
    #[inline(always)]
    pub fn follow<N: NormalForce>(
        &mut self,
        law: &PairLaw<V>,
        touch: &Touch<V>,
        elapsed: f64,
        among: V::Mask,
    ) -> Lost<V> {
        let zero = V::splat(0.0);
        let began = among & !(self.loading | self.unloading);
        let before = (self.overlap, self.normal_force);
        let loading = self.loading | began;
        let overlap = touch.overlap.at_least_zero();
        let sign = if N::SET_VALUED {
            V::select(loading, V::splat(1.0), zero) - V::select(self.unloading, V::splat(1.0), zero)
        } else {
            V::splat(1.0)
        };
        let mut normal_force = N::force(law, sign, overlap, touch.approach);
        let held = self.loading & self.unloading;
        let some_held = N::SET_VALUED && V::bits(held) != 0;
        if some_held {
            normal_force = V::select(held, self.normal_force, normal_force);
        }
        let after = (overlap, normal_force);
        let mut inelasticity = N::loss(law, sign, before, after);
        if some_held {
            inelasticity = V::select(held, lost_work(law, before, after), inelasticity);
        }
        // Bodies that are put into each other, at the start or by hand, have done no work.
        let inelasticity = if elapsed > 0.0 { inelasticity.only(among) } else { zero };
        let (mut friction, mut elongation, mut slips) = (zero, self.elongation, self.slips);
        let acts = among & law.friction_static.gt(zero);
        if V::bits(acts) != 0 {
            let displacement = if elapsed > 0.0 {
                touch.share_in_touch(began) * touch.tangential_displacement(law, before.0, overlap)
            } else {
                zero
            };
            let trial = elongation + displacement;
            let coefficient = V::select(self.slips, law.friction_dynamic, law.friction_static);
            let beyond = (law.tangential_stiffness * trial.abs()).gt(coefficient * normal_force);
            let drawn = V::select(beyond, (law.slip * normal_force).copysign(trial), trial);
            // Mean force times the displacement that the spring did not take up.
            let slipped = V::splat(0.5) * law.tangential_stiffness * (elongation + drawn) * (trial - drawn);
            // Holding contacts do not change. If no time has passed, only the normal force may differ. A slipping
            // contact begins to stick by moving back, never by an evaluation alone.
            let (mut lost, mut springs) = (slipped, acts);
            if some_held || V::bits(self.slides) != 0 {
                // A slip at rest along the normal keeps its force: see [`Slider::follow`].
                let keeps = if some_held { self.slides | (held & self.slips) } else { self.slides };
                lost = V::select(keeps, self.tangential_force(law) * displacement, slipped);
                springs = acts & !keeps;
            }
            friction = lost.only(acts);
            elongation = V::select(springs, drawn, elongation);
            let stays = if elapsed > 0.0 { beyond } else { beyond | slips };
            slips = (springs & stays) | (!springs & slips);
        }
        *self = Self {
            overlap: V::select(among, overlap, self.overlap),
            normal_force: V::select(among, normal_force, self.normal_force),
            elongation,
            loading,
            slips,
            ..*self
        };
        let gone = among & !zero.lt(touch.overlap);
        if V::bits(gone) != 0 {
            friction = friction + self.part(law, gone & touch.overlap.lt(V::splat(f64::INFINITY)));
        }
        Lost { friction, inelasticity }
    }

    /// Contacts come to an end. Returns the energy in J that their tangential springs had.
    #[inline(always)]
    fn part(&mut self, law: &PairLaw<V>, parts: V::Mask) -> V {
        let energy = V::splat(0.5) * law.tangential_stiffness * self.elongation * self.elongation;
        *self = Self {
            overlap: self.overlap.only(!parts),
            normal_force: self.normal_force.only(!parts),
            elongation: self.elongation.only(!parts),
            held: self.held.only(!parts),
            loading: self.loading & !parts,
            unloading: self.unloading & !parts,
            slips: self.slips & !parts,
            slides: self.slides & !parts,
        };
        energy.only(parts)
    }

    /// Tangential force in newtons: positive pulls side B back along the tangent.
    #[inline(always)]
    pub fn tangential_force(&self, law: &PairLaw<V>) -> V {
        V::select(self.slides, self.held, law.tangential_stiffness * self.elongation)
    }
}

impl Contact {
    /// Follows one pair to the state that `touch` describes.
    #[inline]
    pub(super) fn follow<N: NormalForce>(&mut self, law: &PairLaw, touch: &Touch<f64>, elapsed: f64) -> Lost<f64> {
        let Self { mode, overlap, normal_force, tangential: Slider { elongation, held, grip }, .. } = *self;
        let mask = |bit: bool| <f64 as Lanes>::mask(u8::from(bit));
        let mut followed = Followed {
            overlap,
            normal_force,
            elongation,
            held,
            loading: mask(matches!(mode, Mode::Loading | Mode::Hold)),
            unloading: mask(matches!(mode, Mode::Unloading | Mode::Hold)),
            slips: mask(matches!(grip, Grip::Slip | Grip::Hold)),
            slides: mask(matches!(grip, Grip::Slide | Grip::Hold)),
        };
        let lost = followed.follow::<N>(law, touch, elapsed, mask(true));
        let phases = Phases {
            loading: f64::bits(followed.loading),
            unloading: f64::bits(followed.unloading),
            slips: f64::bits(followed.slips),
            slides: f64::bits(followed.slides),
        };
        let Followed { overlap, normal_force, elongation, held, .. } = followed;
        let tangential = Slider { elongation, held, grip: phases.grip(0) };
        *self = Self { mode: phases.mode(0), overlap, normal_force, tangential, ..*self };
        lost
    }
}
