//! Whether a state from a file is one of the run that reads it.

use super::snapshot::{UnfitSnapshot, demand};
use super::state::State;

impl State {
    /// Demands that all indices and lengths of another state are those of this run, and that its clock goes on.
    pub(super) fn demand_fit(&self, saved: &Self) -> Result<(), UnfitSnapshot> {
        self.bodies.demand_fit(&saved.bodies).or_else(|part| demand(false, part))?;
        let (bodies, walls) = (self.bodies.len(), self.bodies.walls.len());
        let clock = &saved.clock;
        let times = [saved.evaluation.time, saved.span.begin, saved.span.end];
        let forward = times.into_iter().all(|time| time.is_finite() && time >= 0.0);
        let lengths = (saved.evaluation.elapsed + saved.span.length).is_finite();
        demand(clock.dt == self.clock.dt && clock.time().is_finite() && forward && lengths, "the times of the clock")?;
        let laws = self.stability.limit == saved.stability.limit
            && self.stability.damping_limit == saved.stability.damping_limit
            && self.stability.foreseen == saved.stability.foreseen
            && self.force_systems == saved.force_systems;
        demand(laws, "the bounds of the tick")?;
        demand(saved.rows.fits(bodies), "the rows of joints and held contacts")?;
        let lists = self.pairs.is_some() == saved.pairs.is_some() && self.bounds.is_some() == saved.bounds.is_some();
        let pairs = saved.pairs.as_ref().is_none_or(|pairs| pairs.fits(&self.bodies));
        demand(lists && pairs, "the pairs of bodies near each other")?;
        demand(saved.bounds.as_ref().is_none_or(|bounds| bounds.fits(bodies)), "the boxes around bodies")?;
        let forces = saved.contact_forces.as_ref().is_none_or(|forces| {
            let fit = |on_body: usize, on_wall: usize| on_body == bodies && on_wall == walls;
            let none = forces.on_body.is_empty() && forces.on_wall.is_empty();
            (none || fit(forces.on_body.len(), forces.on_wall.len()))
                && forces.asleep.as_ref().is_none_or(|(on_body, on_wall)| fit(on_body.len(), on_wall.len()))
        });
        demand(forces && self.contact_forces.is_some() == saved.contact_forces.is_some(), "the forces of contacts")?;
        let touch = |&(wall, a, b): &(bool, u32, u32)| {
            (a as usize) < bodies && (b as usize) < if wall { walls } else { bodies }
        };
        let touches =
            saved.touches.as_ref().is_none_or(|touches| touches.pairs.iter().chain(&touches.begun).all(touch));
        demand(touches && self.touches.is_some() == saved.touches.is_some(), "the touches of bodies")
    }
}
