//! A sweep of projected successive over-relaxation (Cryer 1971) over the contacts of an island, eight at a time.

use jostle_simd::{Kernel, Lanes, PairedQuads};

use super::ROUNDING;
use super::blocks::{Blocks, Eight, Normals, Springs};

/// A sweep has changed nothing if all forces change by less than this, in units of rounding.
const QUIET: f64 = 1e-2;

/// The sweep. Returns whether a force has changed.
pub(super) struct Sweep<'a> {
    pub blocks: &'a mut Blocks,
    /// Each correction as it is, without its factor.
    pub plain: bool,
    pub dt: f64,
}

impl Kernel for Sweep<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<V: Lanes>(self) -> bool {
        let Self { blocks, plain, dt } = self;
        let Blocks { pairs, normals, tangential, rolling, quads, .. } = blocks;
        let mut sides = pairs.of(quads);
        let mut moved = 0;
        let mut rolling = rolling.iter_mut();
        for (block, (normals, tangential)) in normals.iter_mut().zip(tangential).enumerate() {
            (normals.at_limit, tangential.at_limit) = (0, 0);
            let mut rolling = rolling.next();
            if let Some(rolling) = &mut rolling {
                rolling.at_limit = 0;
            }
            let count = usize::from(normals.count);
            let mut lane = 0;
            while lane < count {
                let springs = (&mut *tangential, rolling.as_deref_mut());
                moved |= relax::<V>(&mut sides, (block, lane), normals, springs, plain, dt);
                lane += V::COUNT;
            }
        }
        moved != 0
    }
}

/// Relaxes the forces of some contacts so that they stop within `dt` seconds, as far as bounds allow. Normal forces come first,
/// then friction under these, then rolling torques. Returns a bit for each contact with a force that has changed.
#[inline(always)]
fn relax<V: Lanes>(
    sides: &mut PairedQuads,
    (block, lane): (usize, usize),
    normals: &mut Normals,
    (tangential, rolling): (&mut Springs, Option<&mut Springs>),
    plain: bool,
    dt: f64,
) -> u8 {
    let at = |numbers: &Eight| V::load(&numbers[lane..]);
    let dt = V::splat(dt);
    let relaxation = if plain { V::splat(1.0) } else { at(&normals.relaxation) };
    let [mut a, mut b] = sides.load::<V>(block, lane);
    let (nx, ny) = (at(&normals.normal[0]), at(&normals.normal[1]));
    let (inertia_a, inertia_b) = (at(&normals.inverse_inertia[0]), at(&normals.inverse_inertia[1]));

    // The tangent is the normal turned clockwise.
    let (tx, ty) = (ny, -nx);
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    let (lever_a, lever_b) = (at(&normals.levers[0]), at(&normals.levers[1]));
    let (arm_a, arm_b) = (at(&normals.tangent_levers[0]), at(&normals.tangent_levers[1]));
    let parting = x * nx + y * ny + b[2] * lever_b - a[2] * lever_a;
    let sliding = x * tx + y * ty + b[2] * arm_b - a[2] * arm_a;
    // Velocity along the tangent that an impulse of one newton second along the normal gives.
    let coupling = lever_a * arm_a * inertia_a + lever_b * arm_b * inertia_b;

    let before = at(&normals.force);
    let wanted = before - relaxation * parting * at(&normals.gain);
    let (least, greatest) = (at(&normals.band[0]), at(&normals.band[1]));
    let (below, above) = (wanted.lt(least), greatest.lt(wanted));
    let normal_force = V::select(above, greatest, V::select(below, least, wanted));
    normals.at_limit |= V::bits(below | above) << lane;
    normal_force.store(&mut normals.force[lane..]);
    let change = normal_force - before;
    let rounding = V::splat(QUIET * ROUNDING) * greatest;
    let mut moved = V::bits(rounding.lt(change.abs()));
    let push = change * dt;

    let change = tangential.relax(lane, relaxation * (sliding + coupling * push), normal_force);
    moved |= V::bits((rounding * at(&tangential.gives)).lt(change.abs()));
    let rub = change * dt;
    let (x, y) = (nx * push + tx * rub, ny * push + ty * rub);
    a = [a[0] - x * a[3], a[1] - y * a[3], a[2] - (lever_a * push + arm_a * rub) * inertia_a, a[3]];
    b = [b[0] + x * b[3], b[1] + y * b[3], b[2] + (lever_b * push + arm_b * rub) * inertia_b, b[3]];

    if let Some(rolling) = rolling {
        let change = rolling.relax(lane, relaxation * (a[2] - b[2]), normal_force);
        moved |= V::bits((rounding * at(&rolling.gives)).lt(change.abs()));
        a[2] = a[2] + change * dt * inertia_a;
        b[2] = b[2] - change * dt * inertia_b;
    }
    sides.store(block, lane, [a, b]);
    moved
}

impl Springs {
    /// Lets springs stop the velocity with which their ends move past each other, as far as the normal force allows. Returns by how
    /// much their forces have changed.
    #[inline(always)]
    fn relax<V: Lanes>(&mut self, lane: usize, velocity: V, normal_force: V) -> V {
        let at = |numbers: &Eight| V::load(&numbers[lane..]);
        let (before, engaged) = (at(&self.force), V::mask(self.engaged >> lane));
        let wanted = V::select(engaged, before - velocity * at(&self.gain), at(&self.drawn));
        let beyond = (at(&self.gives) * normal_force).lt(wanted.abs());
        let force = V::select(beyond, (at(&self.slips) * normal_force).copysign(wanted), wanted);
        self.at_limit |= V::bits(beyond & engaged) << lane;
        force.store(&mut self.force[lane..]);
        force - before
    }
}
