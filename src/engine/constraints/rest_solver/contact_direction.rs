//! A body and a direction of a contact in the rest solver.

use glam::DVec2;

use super::ROUNDING;

/// A body, or a side of a contact that does not move by forces.
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
    /// Whether it moves by forces.
    pub(super) fn moves(&self) -> bool {
        self.inverse_mass > 0.0 || self.inverse_inertia > 0.0
    }

    /// Whether its velocity is zero to within rounding. Rounding is that of `load` newtons, up to `extent` metres from its centre
    /// of mass, over `dt` seconds. A mover that does not move by forces has to stand exactly.
    pub fn stands(&self, load: f64, extent: f64, dt: f64) -> bool {
        let limit = 10.0 * ROUNDING * load * dt;
        self.velocity.length() <= limit * self.inverse_mass && self.spin.abs() <= limit * extent * self.inverse_inertia
    }
}

/// One direction of a contact. A force along it acts on side B, and the opposite force on side A of the contact. For a torque the
/// direction is zero and the levers are one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    direction: DVec2,
    lever_a: f64,
    lever_b: f64,
    /// Velocity that one newton gives in one second, in 1/kg.
    pub mobility: f64,
}

impl Row {
    #[inline(always)]
    pub fn new(sides: &Sides, (lever_a, lever_b): (f64, f64), direction: DVec2) -> Self {
        let mut row = Self { direction, lever_a, lever_b, mobility: 0.0 };
        let (of_a, of_b) = row.mobilities(sides);
        row.mobility = of_a + of_b;
        row
    }

    /// The levers of both sides.
    pub fn levers(&self) -> [f64; 2] {
        [self.lever_a, self.lever_b]
    }

    /// The share of each side in the mobility.
    #[inline(always)]
    pub fn mobilities(&self, sides: &Sides) -> (f64, f64) {
        let linear = self.direction.length_squared();
        let share = |mover: &Mover, lever: f64| linear * mover.inverse_mass + lever * lever * mover.inverse_inertia;
        (share(&sides.a, self.lever_a), share(&sides.b, self.lever_b))
    }

    /// Velocity along this row that one newton along the other gives in one second, in 1/kg.
    #[inline(always)]
    pub fn coupling(&self, other: &Self, sides: &Sides) -> f64 {
        let linear = self.direction.dot(other.direction);
        let share = |mover: &Mover, levers: f64| linear * mover.inverse_mass + levers * mover.inverse_inertia;
        share(&sides.a, self.lever_a * other.lever_a) + share(&sides.b, self.lever_b * other.lever_b)
    }

    #[inline(always)]
    pub fn velocity(&self, sides: &Sides) -> f64 {
        (sides.b.velocity - sides.a.velocity).dot(self.direction) + sides.b.spin * self.lever_b
            - sides.a.spin * self.lever_a
    }

    #[inline(always)]
    pub fn push(&self, sides: &mut Sides, impulse: f64) {
        let (first, step) = (&mut sides.a, self.direction * impulse);
        first.velocity -= step * first.inverse_mass;
        first.spin -= self.lever_a * impulse * first.inverse_inertia;
        let second = &mut sides.b;
        second.velocity += step * second.inverse_mass;
        second.spin += self.lever_b * impulse * second.inverse_inertia;
    }
}

/// Both sides of a contact, taken out of the list of movers while forces change between them.
#[derive(Clone, Copy)]
pub(super) struct Sides {
    pub a: Mover,
    pub b: Mover,
}

impl Sides {
    #[inline(always)]
    pub fn of(movers: &[Mover], (a, b): (usize, usize)) -> Self {
        Self { a: movers[a], b: movers[b] }
    }

    #[inline(always)]
    pub fn put_back(&self, movers: &mut [Mover], (a, b): (usize, usize)) {
        (movers[a].velocity, movers[a].spin) = (self.a.velocity, self.a.spin);
        (movers[b].velocity, movers[b].spin) = (self.b.velocity, self.b.spin);
    }
}
