//! Whether bodies from a file are those of the run that reads them.

use serde::Serialize;

use super::packed::{Bodies, Moved};

/// Numbers as bytes, to the last bit. NaN equals itself there.
fn bits(value: &impl Serialize) -> Option<Vec<u8>> {
    postcard::to_stdvec(value).ok()
}

/// The name of a part of a file, unless it fits. The tick makes a message of it.
fn require(fits: bool, part: &'static str) -> Result<(), &'static str> {
    if fits { Ok(()) } else { Err(part) }
}

impl Bodies {
    /// All that follows from the scene alone, as bytes: it stays the same in a run.
    fn parameters(&self) -> [Option<Vec<u8>>; 3] {
        [
            bits(&(
                (&self.dynamic, &self.moves, &self.collides, &self.prescribed.motions),
                (&self.mass, &self.inertia, &self.inverse_mass, &self.inverse_inertia, &self.field),
            )),
            bits(&(
                (&self.extent, &self.first_atom, &self.atom_offset, &self.atom_radius, &self.atom_surface),
                (&self.surfaces, &self.atom_body, self.lone_discs, self.all_dynamic, self.smallest_radius),
            )),
            bits(&(&self.apart, &self.hulls, &self.atom_hull, &self.walls, &self.lines, &self.belts)),
        ]
    }

    /// Demands that bodies from a file have the parameters of these, lists of their lengths, and finite motions.
    ///
    /// # Errors
    /// The name of the part that does not fit.
    pub(crate) fn demand_fit(&self, saved: &Self) -> Result<(), &'static str> {
        let names = ["masses or prescribed motions of bodies", "atoms or surfaces of bodies", "hulls, walls or belts"];
        for ((own, other), name) in self.parameters().into_iter().zip(saved.parameters()).zip(names) {
            require(own == other, name)?;
        }
        let places = |entity| self.index(entity) == saved.index(entity);
        require(self.entity.iter().all(|entity| places(*entity)), "the places of bodies")?;
        let (count, atoms) = (self.len(), self.atom_count());
        let whole = [
            saved.position.len(),
            saved.position_residual.len(),
            saved.angle.len(),
            saved.angle_residual.len(),
            saved.velocity.len(),
            saved.spin.len(),
            saved.force.len(),
            saved.torque.len(),
        ];
        let or_none = [
            saved.estimated_velocity.len(),
            saved.estimated_spin.len(),
            saved.drift.len(),
            saved.turn.len(),
            saved.jointed.len(),
            saved.turned.len(),
        ];
        let lengths = whole.into_iter().all(|length| length == count)
            && or_none.into_iter().all(|length| length == 0 || length == count)
            && saved.turned.len() == self.turned.len()
            && saved.atom_position.len() == self.atom_position.len()
            && (saved.records.is_empty() || saved.records.len() == atoms)
            && saved.estimated_velocity.len() == saved.estimated_spin.len()
            && !(saved.estimating && saved.estimated_velocity.is_empty())
            && (matches!(saved.moved, Moved::For(_)) || saved.drift.len() == count && saved.turn.len() == count);
        require(lengths, "the numbers of places, velocities or forces")?;
        let blocks = count.div_ceil(8);
        let awake = saved.awake.is_sorted_by(|a, b| a < b) && saved.awake.iter().all(|at| (*at as usize) < blocks);
        let sleep = saved.asleep.is_empty() && saved.awake.is_empty() || saved.asleep.len() == blocks;
        require(awake && sleep, "the lists of sleeping bodies")?;
        require(saved.flights.fits(count), "the flights of bodies")?;
        require(saved.is_finite(), "places, velocities, forces or times that are no finite numbers")
    }

    fn is_finite(&self) -> bool {
        let vectors = [&self.position, &self.position_residual, &self.velocity, &self.drift, &self.force];
        let numbers = [&self.angle, &self.angle_residual, &self.spin, &self.turn, &self.torque];
        let estimates = self.estimated_velocity.iter().all(|vector| vector.is_finite())
            && self.estimated_spin.iter().all(|number| number.is_finite());
        let steps = !matches!(self.moved, Moved::For(time) if !time.is_finite());
        vectors.into_iter().flatten().chain(&self.atom_position).all(|vector| vector.is_finite())
            && numbers.into_iter().flatten().all(|number| number.is_finite())
            && estimates
            && steps
            && self.owed.is_none_or(f64::is_finite)
            && (self.path + self.advanced + self.prescribed.time + self.prescribed.middle).is_finite()
    }
}
