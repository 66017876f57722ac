//! Atoms near lines, found by trees of boxes. Each atom has a pair for each local minimum of its distance from a line.
//!
//! The name of a pair is the piece that was nearest to its atom when the list was made. Between lists the nearest point
//! moves. So an old pair is found again under the name of the current piece.

use bevy_ecs::world::World;

use super::{NEW, SurfacePair};
use crate::tick::pairs::{Probe, Surface};
use crate::tick::snapshot::Memory;
use crate::tick::{Dependence, Energies, Model, State, SteadySpring};
use crate::world::Bodies;
use crate::world::line::BEHIND;

/// Pairs of a list before under their present names, each with its place there, in order. Empty without lines.
pub(super) fn known(
    bodies: &Bodies,
    old: &[SurfacePair],
    renamed: impl Fn(SurfacePair) -> Option<SurfacePair>,
) -> Vec<(SurfacePair, u32)> {
    if bodies.lines.is_empty() {
        return Vec::new();
    }
    let now = |pair: &SurfacePair| renamed(*pair).map(|pair| present(pair, bodies));
    let mut known: Vec<_> = (0..).zip(old).filter_map(|(index, pair)| Some((now(pair)?, index))).collect();
    known.sort_unstable();
    known
}

/// A pair under the name of the piece that is nearest now.
fn present(pair: SurfacePair, bodies: &Bodies) -> SurfacePair {
    match (pair.surface(bodies), pair.probe(bodies)) {
        (Surface::Wall(wall), Probe::Atom(atom)) => SurfacePair::new(bodies.piece_now(wall, atom) as u32, pair.probe),
        _ => pair,
    }
}

/// The place in the list before of a pair, or [`NEW`].
pub(super) fn index(known: &[(SurfacePair, u32)], pair: SurfacePair) -> u32 {
    let first = known.partition_point(|(other, _)| *other < pair);
    known.get(first).filter(|(other, _)| *other == pair).map_or(NEW, |(_, index)| *index)
}

/// Gives the atoms near lines: line by line, each in the order of the atoms. If bodies have just `begun`, corners may
/// be behind lines.
pub(super) fn each_pair(
    bodies: &Bodies,
    (margin, begun): (f64, bool),
    known: &[(SurfacePair, u32)],
    mut see: impl FnMut(SurfacePair),
) {
    each_place(bodies, (margin, if begun { BEHIND } else { 0.0 }), known, |pair, _| see(pair));
}

/// The same with the heights of the atoms over the line, in metres.
pub(super) fn each_place(
    bodies: &Bodies,
    (margin, behind): (f64, f64),
    known: &[(SurfacePair, u32)],
    mut see: impl FnMut(SurfacePair, f64),
) {
    for line in &bodies.lines {
        for body in (0..bodies.len()).filter(|&body| bodies.dynamic[body] && bodies.collides[body]) {
            let mut is_near = false;
            line.each_near(bodies.position[body], bodies.extent(body) + margin, &mut |_| is_near = true);
            for atom in bodies.atoms_of(body).filter(|&atom| is_near && bodies.probes(atom)) {
                let pair = |piece: usize| SurfacePair::new(piece as u32, atom as u32);
                let was_near = |piece: usize| index(known, pair(piece)) != NEW;
                let reach = (atom, margin, behind);
                bodies.each_place_on_line(line, reach, was_near, |piece, height| see(pair(piece), height));
            }
        }
    }
}

/// Renames pairs after their current pieces at the beginning of a step, so that walks are short. If two pairs reach one
/// point, the lists are renewed before the point counts twice.
#[derive(Default)]
struct Walks {
    /// The present pairs; only its memory is kept.
    now: Vec<SurfacePair>,
}

/// Watches for pairs that reach one point of a line, if the scene has lines.
pub(super) fn watch(world: &mut World) {
    let mut state = world.resource_mut::<State>();
    if !state.bodies().lines.is_empty() {
        state.add_model(Walks::default());
    }
}

/// Moves nothing.
impl Model for Walks {
    fn save(&self) -> Memory {
        Memory::Nothing
    }

    fn dependence(&self) -> Dependence {
        Dependence::Nothing
    }

    fn energies(&self, _: &State) -> Energies {
        Energies::default()
    }

    fn stiffness(&self, _: &State, _: &mut Vec<SteadySpring>) {}

    fn has_modes(&self) -> bool {
        true
    }

    fn begins_with_velocities(&self) -> bool {
        false
    }

    fn begin_step(&mut self, state: &mut State) {
        let State { bodies, bounds: Some(bounds), pairs: Some(pairs), .. } = state else { return };
        let now = &mut self.now;
        now.clear();
        for pair in &mut pairs.surfaces {
            let renamed = present(*pair, bodies);
            if matches!(pair.surface(bodies), Surface::Wall(wall) if bodies.walls[wall].line.is_some()) {
                *pair = renamed;
                now.push(renamed);
            }
        }
        now.sort_unstable();
        if now.windows(2).any(|two| two[0] == two[1]) {
            bounds.outdate();
        }
    }
}
