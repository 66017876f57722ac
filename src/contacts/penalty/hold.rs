//! Which forces keep touching bodies at rest: the contact laws are set-valued where a contact does not move.
//!
//! Normal force `N` in `[1 - mu_e, 1 + mu_e] k d`, tangential force `|T| <= mu N`. For the tick to come each contact that
//! could stop gets the force that makes its velocity zero at the end, or the bound that is nearest (the implicit
//! discretisation of dry friction: Moreau 1988; Acary and Brogliato 2008, chapter 1). There is no threshold: a velocity
//! is taken away where the bounds of the law suffice to do so within the tick, and nowhere else.
//!
//! Solved by projected Gauss-Seidel from the present forces; where no bound is active the equations are linear, and
//! conjugate gradients finish them to rounding whatever the ratio of masses.

use glam::DVec2;

/// Sweeps of Gauss-Seidel per tick. What is left over is taken up in the next tick, from where this one ended.
const SWEEPS: usize = 40;

/// A share of a force that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// A body, or something that does not move by forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mover {
    /// Velocity in m/s at the end of the tick, under the present forces.
    pub velocity: DVec2,
    /// Angular velocity in rad/s, likewise.
    pub spin: f64,
    /// 1/mass in 1/kg.
    pub inverse_mass: f64,
    /// 1/inertia in 1/(kg m2).
    pub inverse_inertia: f64,
}

impl Mover {
    /// Whether it stands but for rounding, under normal forces of `scale` newtons in all that act up to `extent` metres
    /// from its centre of mass over `dt` seconds. What does not move by forces has to stand exactly.
    pub fn stands(&self, scale: f64, extent: f64, dt: f64) -> bool {
        let limit = 10.0 * ROUNDING * scale * dt;
        self.velocity.length() <= limit * self.inverse_mass && self.spin.abs() <= limit * extent * self.inverse_inertia
    }
}

/// Sum of the normal forces on mover `place` in newtons.
pub fn load(candidates: &[Candidate], place: usize) -> f64 {
    let on = candidates.iter().filter(|c| c.ends.0 == place || c.ends.1 == place);
    on.fold(0.0, |sum, candidate| sum + candidate.normal_force)
}

/// One direction of a contact: a force along it acts on B, the opposite on A.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    direction: DVec2,
    lever_a: f64,
    lever_b: f64,
    /// Velocity that one newton gives in one second, in 1/kg.
    mobility: f64,
}

impl Row {
    fn new(movers: &[Mover], (a, b): (usize, usize), (arm_a, arm_b): (DVec2, DVec2), direction: DVec2) -> Self {
        let (lever_a, lever_b) = (arm_a.perp_dot(direction), arm_b.perp_dot(direction));
        let share = |mover: &Mover, lever: f64| mover.inverse_mass + lever * lever * mover.inverse_inertia;
        Self { direction, lever_a, lever_b, mobility: share(&movers[a], lever_a) + share(&movers[b], lever_b) }
    }

    fn velocity(&self, movers: &[Mover], (a, b): (usize, usize)) -> f64 {
        (movers[b].velocity - movers[a].velocity).dot(self.direction) + movers[b].spin * self.lever_b
            - movers[a].spin * self.lever_a
    }

    fn push(&self, movers: &mut [Mover], (a, b): (usize, usize), impulse: f64) {
        let (first, step) = (&mut movers[a], self.direction * impulse);
        first.velocity -= step * first.inverse_mass;
        first.spin -= self.lever_a * impulse * first.inverse_inertia;
        let second = &mut movers[b];
        second.velocity += step * second.inverse_mass;
        second.spin += self.lever_b * impulse * second.inverse_inertia;
    }
}

/// A contact that may come to rest, between movers `ends`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    ends: (usize, usize),
    normal: Row,
    tangent: Row,
    /// Least and greatest normal force in newtons.
    band: (f64, f64),
    /// Static coefficient of friction.
    friction: f64,
    /// Normal force in newtons.
    pub normal_force: f64,
    /// Tangential force in newtons, along minus the tangent on B.
    pub tangential_force: f64,
}

/// What became of a candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It still moves along its normal.
    Moves,
    /// It rests along its normal and slips, or has no friction.
    Rests,
    /// It rests along both directions.
    Sticks,
}

impl Candidate {
    /// A contact between `ends` with the arms of both sides, in the direction `normal` from A to B, with the present
    /// forces.
    pub fn new(
        movers: &[Mover],
        ends: (usize, usize),
        arms: (DVec2, DVec2),
        normal: DVec2,
        band: (f64, f64),
        friction: f64,
        forces: (f64, f64),
    ) -> Self {
        let tangent = Row::new(movers, ends, arms, -normal.perp());
        let normal = Row::new(movers, ends, arms, normal);
        Self { ends, normal, tangent, band, friction, normal_force: forces.0, tangential_force: forces.1 }
    }

    /// Least normal force in newtons that the law allows.
    pub fn least_force(&self) -> f64 {
        self.band.0
    }

    fn limit(&self) -> f64 {
        self.friction * self.normal_force
    }

    /// Velocity that rounding of forces may leave after `dt` seconds, in m/s.
    fn noise(&self, row: &Row, dt: f64) -> f64 {
        1e3 * ROUNDING * row.mobility * self.band.1 * dt
    }

    /// Lets both forces work over `dt` seconds so that the contact stops, as far as their bounds allow. Returns the
    /// greatest change of velocity over what counts as rounding.
    fn relax(&mut self, movers: &mut [Mover], dt: f64) -> f64 {
        let wanted = self.normal_force - self.normal.velocity(movers, self.ends) / (self.normal.mobility * dt);
        let change = self.set_normal(movers, bounded(wanted, self.band), dt);
        if self.friction == 0.0 {
            return change;
        }
        let wanted = self.tangential_force - self.tangent.velocity(movers, self.ends) / (self.tangent.mobility * dt);
        change.max(self.set_tangential(movers, bounded(wanted, (-self.limit(), self.limit())), dt))
    }

    fn set_normal(&mut self, movers: &mut [Mover], force: f64, dt: f64) -> f64 {
        let change = force - self.normal_force;
        self.normal_force = force;
        self.normal.push(movers, self.ends, change * dt);
        change.abs() / (ROUNDING * self.band.1)
    }

    fn set_tangential(&mut self, movers: &mut [Mover], force: f64, dt: f64) -> f64 {
        let change = force - self.tangential_force;
        self.tangential_force = force;
        self.tangent.push(movers, self.ends, change * dt);
        change.abs() / (ROUNDING * self.band.1)
    }

    fn free(&self) -> (bool, bool) {
        let normal = self.normal_force > self.band.0 && self.normal_force < self.band.1;
        (normal, self.friction > 0.0 && self.tangential_force.abs() < self.limit())
    }

    /// What the contact does in the tick to come.
    pub fn verdict(&self, movers: &[Mover], dt: f64) -> Verdict {
        let (normal, tangential) = self.free();
        let stands = |row: &Row| row.velocity(movers, self.ends).abs() <= self.noise(row, dt);
        if !normal && !stands(&self.normal) {
            Verdict::Moves
        } else if self.friction > 0.0 && (tangential || stands(&self.tangent)) {
            Verdict::Sticks
        } else {
            Verdict::Rests
        }
    }
}

/// The force nearest to the one wanted within its bounds. Where overlaps have grown beyond all numbers the bounds are
/// none: the force then is none either, and the run ends with that.
fn bounded(wanted: f64, (least, greatest): (f64, f64)) -> f64 {
    if least <= greatest { wanted.clamp(least, greatest) } else { f64::NAN }
}

/// Finds the forces of an island of candidates for the `dt` seconds to come. `movers` hold the velocities at their end
/// under the present forces, and are brought up to date.
pub fn solve(candidates: &mut [Candidate], movers: &mut [Mover], dt: f64) {
    for _ in 0..SWEEPS {
        let mut greatest = 0.0_f64;
        for candidate in &mut *candidates {
            greatest = greatest.max(candidate.relax(movers, dt));
        }
        if greatest <= 1e-2 {
            return;
        }
    }
    finish(candidates, movers, dt);
}

/// Conjugate gradients over the forces that no bound holds. What would leave its bounds is left as it was.
fn finish(candidates: &mut [Candidate], movers: &mut [Mover], dt: f64) {
    let rows: Vec<(Row, (usize, usize))> = candidates
        .iter()
        .flat_map(|c| {
            let (normal, tangential) = c.free();
            [normal.then_some((c.normal, c.ends)), tangential.then_some((c.tangent, c.ends))].into_iter().flatten()
        })
        .collect();
    let still: Vec<Mover> = movers.iter().map(|m| Mover { velocity: DVec2::ZERO, spin: 0.0, ..*m }).collect();
    let velocities = |movers: &[Mover]| rows.iter().map(|(row, ends)| row.velocity(movers, *ends)).collect::<Vec<_>>();
    let apply = |impulses: &[f64]| {
        let mut moved = still.clone();
        rows.iter().zip(impulses).for_each(|((row, ends), &impulse)| row.push(&mut moved, *ends, impulse));
        velocities(&moved)
    };
    let scaled = |residual: &[f64]| rows.iter().zip(residual).map(|((row, _), r)| r / row.mobility).collect::<Vec<_>>();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b);
    let mut impulses = vec![0.0; rows.len()];
    let mut residual: Vec<f64> = velocities(movers).iter().map(|v| -v).collect();
    let mut search = scaled(&residual);
    let mut size = dot(&residual, &search);
    let goal = size * 1e-28;
    for _ in 0..4 * rows.len() + 10 {
        if size <= goal || size == 0.0 {
            break;
        }
        let response = apply(&search);
        let curvature = dot(&search, &response);
        if curvature <= 0.0 {
            break;
        }
        let step = size / curvature;
        for i in 0..rows.len() {
            impulses[i] += step * search[i];
            residual[i] -= step * response[i];
        }
        let direction = scaled(&residual);
        let before = std::mem::replace(&mut size, dot(&residual, &direction));
        for i in 0..rows.len() {
            search[i] = direction[i] + size / before * search[i];
        }
    }
    take_over(candidates, movers, &impulses, dt);
}

/// Takes the impulses of the free directions over if all forces stay within their bounds.
fn take_over(candidates: &mut [Candidate], movers: &mut [Mover], impulses: &[f64], dt: f64) {
    let mut impulses = impulses.iter();
    let mut next = || impulses.next().map_or(0.0, |impulse| impulse / dt);
    let changed: Vec<(f64, f64)> = candidates
        .iter()
        .map(|c| {
            let (normal, tangential) = c.free();
            let change = if normal { next() } else { 0.0 };
            (c.normal_force + change, c.tangential_force + if tangential { next() } else { 0.0 })
        })
        .collect();
    let allowed = |(c, &(normal, tangential)): (&Candidate, &(f64, f64))| {
        let within = normal >= c.band.0 && normal <= c.band.1;
        within && tangential.abs() <= c.friction * normal
    };
    if candidates.iter().zip(&changed).all(allowed) {
        for (candidate, (normal, tangential)) in candidates.iter_mut().zip(changed) {
            candidate.set_normal(movers, normal, dt);
            if candidate.friction > 0.0 {
                candidate.set_tangential(movers, tangential, dt);
            }
        }
    }
}
