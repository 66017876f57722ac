//! Which forces keep touching bodies at rest: the contact laws are set-valued where a contact does not move.
//!
//! Normal force `N` within the band of the normal law (`[1 - mu_e, 1 + mu_e] k d`), tangential force `|T| <= mu N`,
//! rolling torque `|M| <= mu_r R N`. For the tick to come each contact that could stop gets the force that makes its
//! velocity zero at the end, or the bound that is nearest (the implicit discretisation of dry friction: Moreau 1988;
//! Acary and Brogliato 2008, chapter 1). There is no threshold: a velocity is taken away where the bounds of the law
//! suffice to do so within the tick, and nowhere else.
//!
//! Solved by projected Gauss-Seidel from the present forces. Where no bound is active the equations are linear: in an
//! island that may come to rest conjugate gradients bring the velocities down by a factor each tick, whatever the ratio
//! of masses, and after a few ticks to rounding.

use glam::DVec2;

/// Sweeps of Gauss-Seidel per tick. What is left over is taken up in the next tick, from where this one ended.
const SWEEPS: usize = 10;

/// How often conjugate gradients and sweeps take turns to find the bounds that are active.
const ROUNDS: usize = 2;

/// Share to which conjugate gradients bring down the velocities of an island in one tick. A few ticks reach rounding.
const GAIN: f64 = 1e-4;
/// Rows that conjugate gradients go through at most, and their steps in any case: islands of a thousand rows are solved, in
/// those of a hundred thousand, which would take minutes, each search goes on where the one before ended.
const WORK: usize = 4_000_000;
const FEWEST_STEPS: usize = 32;

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
    /// Whether it stands but for rounding, under `load` newtons that act up to `extent` metres from its centre of mass
    /// over `dt` seconds. What does not move by forces has to stand exactly.
    pub fn stands(&self, load: f64, extent: f64, dt: f64) -> bool {
        let limit = 10.0 * ROUNDING * load * dt;
        self.velocity.length() <= limit * self.inverse_mass && self.spin.abs() <= limit * extent * self.inverse_inertia
    }
}

/// Sums over the contacts of each of `movers` movers of the force against which its rounding is to be judged, in newtons.
pub fn loads(candidates: &[Candidate], movers: usize) -> Vec<f64> {
    let mut loads = vec![0.0; movers];
    for candidate in candidates {
        for place in [candidate.ends.0, candidate.ends.1] {
            loads[place] += candidate.normal_force + candidate.rounding / ROUNDING;
        }
    }
    loads
}

/// One direction of a contact: a force along it acts on B, the opposite on A. For a torque the direction is zero and the
/// levers are one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    direction: DVec2,
    lever_a: f64,
    lever_b: f64,
    /// Velocity that one newton gives in one second, in 1/kg.
    mobility: f64,
}

impl Row {
    #[inline(always)]
    fn new(sides: &Sides, (lever_a, lever_b): (f64, f64), direction: DVec2) -> Self {
        let mut row = Self { direction, lever_a, lever_b, mobility: 0.0 };
        let (of_a, of_b) = row.mobilities(sides);
        row.mobility = of_a + of_b;
        row
    }

    /// What each side gives to the mobility.
    #[inline(always)]
    fn mobilities(&self, sides: &Sides) -> (f64, f64) {
        let linear = self.direction.length_squared();
        let share = |mover: &Mover, lever: f64| linear * mover.inverse_mass + lever * lever * mover.inverse_inertia;
        (share(&sides.a, self.lever_a), share(&sides.b, self.lever_b))
    }

    #[inline(always)]
    fn velocity(&self, sides: &Sides) -> f64 {
        (sides.b.velocity - sides.a.velocity).dot(self.direction) + sides.b.spin * self.lever_b
            - sides.a.spin * self.lever_a
    }

    #[inline(always)]
    fn push(&self, sides: &mut Sides, impulse: f64) {
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
struct Sides {
    a: Mover,
    b: Mover,
}

impl Sides {
    #[inline(always)]
    fn of(movers: &[Mover], (a, b): (usize, usize)) -> Self {
        Self { a: movers[a], b: movers[b] }
    }

    #[inline(always)]
    fn put_back(&self, movers: &mut [Mover], (a, b): (usize, usize)) {
        (movers[a].velocity, movers[a].spin) = (self.a.velocity, self.a.spin);
        (movers[b].velocity, movers[b].spin) = (self.b.velocity, self.b.spin);
    }
}

/// A force or torque whose limit is a share of the normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounded {
    row: Row,
    coefficient: f64,
    /// Whether it may hold in the tick to come; if not it stays as it is.
    engaged: bool,
    /// Whether it slides without its spring.
    slides: bool,
    /// Whether it would have to be greater than its limit to stop the contact. Comparing the force with the limit would
    /// leave that to rounding.
    at_limit: bool,
    force: f64,
    /// Its spring.
    drawn: Drawn,
    /// Velocity at the beginning of the tick.
    begin: f64,
}

impl Bounded {
    fn is_free(&self) -> bool {
        self.engaged && !self.at_limit
    }

    /// Whether it brakes without stopping: `velocity` at the end of the tick is less than at the beginning, and the force
    /// is against it. So a body that is taken by surprise is caught within some ticks by what could hold it.
    fn brakes(&self, velocity: f64) -> bool {
        self.engaged && self.force * velocity < 0.0 && velocity.abs() < self.begin.abs()
    }
}

/// A spring with a Coulomb limit as it comes to the search for rest: a force in N, or a torque in N m with lengths for coefficients.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drawn {
    /// Share of the normal force that it may hold.
    pub limit: f64,
    /// Share of the normal force beyond which it gives way, or slips on.
    pub gives: f64,
    /// Share of the normal force that it has in slip.
    pub slips: f64,
    /// The present force.
    pub force: f64,
}

impl Drawn {
    /// What the spring has left under a normal force.
    fn under(&self, normal_force: f64) -> f64 {
        let beyond = self.force.abs() > self.gives * normal_force;
        if beyond { (self.slips * normal_force).copysign(self.force) } else { self.force }
    }
}

/// A contact as it comes to the search for rest.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Places of both sides in the list of movers.
    pub ends: (usize, usize),
    /// Arms of both sides in metres.
    pub arms: (DVec2, DVec2),
    /// Unit normal from A to B.
    pub normal: DVec2,
    /// Least and greatest normal force in newtons.
    pub band: (f64, f64),
    /// Normal force in newtons.
    pub normal_force: f64,
    /// Force in newtons that rounding of positions makes.
    pub noise: f64,
    /// Whether the tangential and the rolling force may hold though their springs are drawn out: not before the normal
    /// force has held for a tick, so that a contact that turns in a collision keeps what its springs hold.
    pub engaged: bool,
    /// Whether the contact parts.
    pub parts: bool,
    /// Whether the contact slides and rolls without its springs, under the dynamic coefficient.
    pub slides: (bool, bool),
    /// The tangential spring; its force acts along minus the tangent on B.
    pub tangential: Drawn,
    /// The rolling spring; its torque acts against B's turn.
    pub rolling: Drawn,
}

/// An island: its contacts and the bodies around them. What memory it has it keeps for the next.
#[derive(Debug, Default)]
pub struct Island {
    /// What does not move by forces, then bodies and belts: velocities at the beginning of the tick.
    pub begin: Vec<Mover>,
    /// The same at its end, under the present forces; after [`Island::solve`] under those found.
    pub movers: Vec<Mover>,
    /// Contacts as they come.
    pub seen: Vec<Seen>,
    /// Contacts under search, in the same order.
    pub candidates: Vec<Candidate>,
    /// For each mover the greatest tangential force and the greatest rolling torque of all its contacts.
    grips: Vec<[f64; 2]>,
    gradients: Gradients,
}

/// A contact that may come to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    ends: (usize, usize),
    normal: Row,
    band: (f64, f64),
    /// Whether the normal force would have to leave its band to stop the contact.
    at_limit: bool,
    /// Force in newtons that rounding of positions makes.
    rounding: f64,
    /// Force in newtons too small to be told from none when the verdict is found.
    noise: f64,
    normal_force: f64,
    /// Whether it held in the tick before.
    held: bool,
    /// Whether it parted.
    parted: bool,
    bounded: [Bounded; 2],
}

/// What friction does in the tick to come, in a contact that rests along its normal. Forces are in N, torques in N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// It holds with this force, or brakes with all that it can hold.
    Holds(f64),
    /// It was at rest and could not bear the load, or slid already without its spring: it slides with the dynamic coefficient,
    /// against the motion, and its force has the sign of this number.
    Slides(f64),
    /// The contact begins to rest, perhaps for the one tick in which a collision turns: its spring follows the motion, and what
    /// gives way slides on until the force of the next tick is known.
    Turns,
    /// The contact begins to rest after it parted: the normal force grows, and what slipped is no longer drawn to its limit.
    Lands,
    /// The contact rests on: its spring follows the motion, and what slips has the limit of the normal force, which depends on it.
    Stays,
    /// Its spring follows the motion.
    Follows,
}

/// What becomes of a contact in the tick to come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It moves along its normal; the normal force wants it to approach or to part.
    Moves {
        /// Whether the normal force is at its upper bound: the contact approaches.
        approaches: bool,
    },
    /// It rests along its normal.
    Rests {
        /// Normal force in newtons.
        normal: f64,
        /// What friction does along the tangent.
        tangential: Friction,
        /// What it does against rolling.
        rolling: Friction,
        /// Whether nothing in it moves that friction could hold.
        entirely: bool,
    },
}

impl Candidate {
    fn new(begin: &[Mover], end: &[Mover], grips: &[[f64; 2]], seen: &Seen, dt: f64) -> Self {
        let (begin, sides) = (Sides::of(begin, seen.ends), Sides::of(end, seen.ends));
        let grips = (grips[seen.ends.0], grips[seen.ends.1]);
        let along = |direction: DVec2| {
            let levers = (seen.arms.0.perp_dot(direction), seen.arms.1.perp_dot(direction));
            Row::new(&sides, levers, direction)
        };
        let turn = Row::new(&sides, (-1.0, -1.0), DVec2::ZERO);
        let bounded = |place: usize, row: Row, drawn: Drawn, slides: bool| {
            let Drawn { limit: coefficient, force, .. } = drawn;
            // From one limit to the other, and as much again by what the neighbours do: what is faster slides on.
            let (of_a, of_b) = row.mobilities(&sides);
            let reach = 4.0 * (grips.0[place] * of_a + grips.1[place] * of_b) * dt;
            let engaged = (seen.engaged || force == 0.0) && coefficient > 0.0 && row.velocity(&sides).abs() <= reach;
            Bounded { row, coefficient, engaged, slides, at_limit: false, force, drawn, begin: row.velocity(&begin) }
        };
        Self {
            ends: seen.ends,
            normal: along(seen.normal),
            band: seen.band,
            at_limit: false,
            rounding: seen.noise,
            noise: seen.noise.max(1e3 * ROUNDING * seen.band.1),
            normal_force: seen.normal_force,
            held: seen.engaged,
            parted: seen.parts,
            bounded: [
                bounded(0, along(-seen.normal.perp()), seen.tangential, seen.slides.0),
                bounded(1, turn, seen.rolling, seen.slides.1),
            ],
        }
    }

    /// Lets all forces work over `dt` seconds so that the contact stops, as far as their bounds allow. Returns the
    /// greatest change of a force over what counts as rounding.
    #[inline(always)]
    fn relax(&mut self, movers: &mut [Mover], dt: f64) -> f64 {
        let mut sides = Sides::of(movers, self.ends);
        let wanted = self.normal_force - self.normal.velocity(&sides) / (self.normal.mobility * dt);
        let mut change = self.set_normal(&mut sides, wanted, dt);
        for place in 0..self.bounded.len() {
            let Bounded { row, engaged, force, drawn, .. } = &self.bounded[place];
            if *engaged {
                let wanted = force - row.velocity(&sides) / (row.mobility * dt);
                change = change.max(self.set_bounded(&mut sides, place, wanted, dt));
            } else if drawn.force != 0.0 {
                let left = drawn.under(self.normal_force);
                change = change.max(self.set_drawn(&mut sides, place, left, dt));
            }
        }
        sides.put_back(movers, self.ends);
        change
    }

    /// Sets the normal force to what is wanted, as far as its band allows. Returns the change over what counts as rounding.
    #[inline(always)]
    fn set_normal(&mut self, sides: &mut Sides, wanted: f64, dt: f64) -> f64 {
        let force = nearest(wanted, self.band);
        self.at_limit = force != wanted;
        let change = force - self.normal_force;
        self.normal_force = force;
        self.normal.push(sides, change * dt);
        change.abs() / (ROUNDING * self.band.1)
    }

    #[inline(always)]
    fn set_bounded(&mut self, sides: &mut Sides, place: usize, wanted: f64, dt: f64) -> f64 {
        let bounded = &mut self.bounded[place];
        let limit = bounded.coefficient * self.normal_force;
        let force = nearest(wanted, (-limit, limit));
        bounded.at_limit = force != wanted;
        self.set_drawn(sides, place, force, dt)
    }

    /// Sets a force to what its spring has. Returns the change over what counts as rounding.
    #[inline(always)]
    fn set_drawn(&mut self, sides: &mut Sides, place: usize, force: f64, dt: f64) -> f64 {
        let bounded = &mut self.bounded[place];
        let change = force - bounded.force;
        bounded.force = force;
        bounded.row.push(sides, change * dt);
        change.abs() / (ROUNDING * bounded.coefficient * self.band.1)
    }

    fn stands(&self, row: &Row, sides: &Sides, dt: f64) -> bool {
        row.velocity(sides).abs() <= self.noise * row.mobility * dt
    }

    /// The rows that no bound holds.
    fn free_rows(&self) -> impl Iterator<Item = Row> + '_ {
        let bounded = self.bounded.iter().filter(|bounded| bounded.is_free()).map(|bounded| bounded.row);
        (!self.at_limit).then_some(self.normal).into_iter().chain(bounded)
    }

    /// What the contact does in the tick to come.
    pub fn verdict(&self, movers: &[Mover], dt: f64) -> Verdict {
        let sides = Sides::of(movers, self.ends);
        if self.at_limit && !self.stands(&self.normal, &sides, dt) {
            return Verdict::Moves { approaches: self.normal_force > self.band.0 };
        }
        let stops = |bounded: &Bounded| bounded.engaged && (bounded.is_free() || self.stands(&bounded.row, &sides, dt));
        let of = |bounded: &Bounded| {
            let velocity = bounded.row.velocity(&sides);
            let stood = bounded.begin.abs() <= self.noise * bounded.row.mobility * dt;
            let gives_way = bounded.engaged && stood && bounded.force * velocity < 0.0;
            if stops(bounded) {
                Friction::Holds(bounded.force)
            } else if bounded.slides || gives_way {
                Friction::Slides(-velocity)
            } else if bounded.brakes(velocity) {
                Friction::Holds(bounded.force)
            } else if self.held {
                Friction::Stays
            } else if self.parted {
                Friction::Lands
            } else {
                Friction::Turns
            }
        };
        let entirely = self.bounded.iter().all(|bounded| bounded.coefficient == 0.0 || stops(bounded));
        let [tangential, rolling] = [0, 1].map(|place| of(&self.bounded[place]));
        Verdict::Rests { normal: self.normal_force, tangential, rolling, entirely }
    }
}

/// The force nearest to the one wanted within its bounds. Where overlaps have grown beyond all numbers the bounds are
/// none: the force then is none either, and the run ends with that.
fn nearest(wanted: f64, (least, greatest): (f64, f64)) -> f64 {
    if least <= greatest { wanted.clamp(least, greatest) } else { f64::NAN }
}

impl Island {
    /// Forgets the island of before.
    pub fn clear(&mut self) {
        self.begin.clear();
        self.movers.clear();
        self.seen.clear();
    }

    /// Sets up what was seen for the `dt` seconds to come.
    pub fn set_up(&mut self, dt: f64) {
        let Self { begin, movers, seen, candidates, grips, .. } = self;
        grips.clear();
        grips.resize(movers.len(), [0.0; 2]);
        for Seen { ends, band, tangential, rolling, .. } in &*seen {
            for place in [ends.0, ends.1] {
                grips[place][0] += tangential.limit * band.1;
                grips[place][1] += rolling.limit * band.1;
            }
        }
        candidates.clear();
        candidates.extend(seen.iter().map(|seen| Candidate::new(begin, movers, grips, seen, dt)));
    }

    /// Finds the forces for the `dt` seconds to come. `thorough`: sweeps take turns with conjugate gradients, which is worth it
    /// where nothing in the island has a contact that moves.
    pub fn solve(&mut self, thorough: bool, dt: f64) {
        for _ in 0..if thorough { ROUNDS } else { 1 } {
            for _ in 0..SWEEPS {
                let mut greatest = 0.0_f64;
                for candidate in &mut self.candidates {
                    greatest = greatest.max(candidate.relax(&mut self.movers, dt));
                }
                if greatest <= 1e-2 {
                    return;
                }
            }
            if thorough {
                self.gradients.finish(&mut self.candidates, &mut self.movers, dt);
            }
        }
        // Forces that stand at a limit without need come off it.
        for candidate in &mut self.candidates {
            candidate.relax(&mut self.movers, dt);
        }
    }
}

/// Conjugate gradients over the forces that no bound holds. A force that would leave its bounds stops there, and what
/// that leaves is for the sweeps that follow.
#[derive(Debug, Default)]
struct Gradients {
    rows: Vec<(Row, (usize, usize))>,
    /// The movers without their velocities.
    still: Vec<Mover>,
    moved: Vec<Mover>,
    impulses: Vec<f64>,
    residual: Vec<f64>,
    scaled: Vec<f64>,
    search: Vec<f64>,
    response: Vec<f64>,
}

impl Gradients {
    fn finish(&mut self, candidates: &mut [Candidate], movers: &mut [Mover], dt: f64) {
        let Self { rows, still, moved, impulses, residual, scaled, search, response } = self;
        rows.clear();
        rows.extend(candidates.iter().flat_map(|c| c.free_rows().map(move |row| (row, c.ends))));
        still.clear();
        still.extend(movers.iter().map(|m| Mover { velocity: DVec2::ZERO, spin: 0.0, ..*m }));
        for list in [&mut *impulses, &mut *response] {
            list.clear();
            list.resize(rows.len(), 0.0);
        }
        residual.clear();
        residual.extend(rows.iter().map(|(row, ends)| -row.velocity(&Sides::of(movers, *ends))));
        scaled.clear();
        scaled.extend(rows.iter().zip(&*residual).map(|((row, _), r)| r / row.mobility));
        search.clone_from(scaled);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b);
        let mut size = dot(residual, search);
        let goal = size * GAIN * GAIN;
        let affordable = (WORK / rows.len().max(1)).max(FEWEST_STEPS);
        for _ in 0..affordable.min(4 * rows.len() + 10) {
            if size <= goal || size == 0.0 {
                break;
            }
            moved.clone_from(still);
            for ((row, ends), &impulse) in rows.iter().zip(&*search) {
                let mut sides = Sides::of(moved, *ends);
                row.push(&mut sides, impulse);
                sides.put_back(moved, *ends);
            }
            for (response, (row, ends)) in response.iter_mut().zip(&*rows) {
                *response = row.velocity(&Sides::of(moved, *ends));
            }
            let curvature = dot(search, response);
            if curvature <= 0.0 {
                break;
            }
            let step = size / curvature;
            for i in 0..rows.len() {
                impulses[i] += step * search[i];
                residual[i] -= step * response[i];
                scaled[i] = residual[i] / rows[i].0.mobility;
            }
            let before = std::mem::replace(&mut size, dot(residual, scaled));
            for i in 0..rows.len() {
                search[i] = scaled[i] + size / before * search[i];
            }
        }
        take_over(candidates, movers, impulses, dt);
    }
}

/// Takes over the impulses of the free rows, each as far as its bounds allow.
fn take_over(candidates: &mut [Candidate], movers: &mut [Mover], impulses: &[f64], dt: f64) {
    let mut impulses = impulses.iter();
    let mut next = || impulses.next().map_or(0.0, |impulse| impulse / dt);
    for candidate in candidates {
        let free = candidate.bounded.map(|bounded| bounded.is_free());
        let mut sides = Sides::of(movers, candidate.ends);
        if !candidate.at_limit {
            candidate.set_normal(&mut sides, candidate.normal_force + next(), dt);
        }
        for (place, free) in free.into_iter().enumerate() {
            let Bounded { coefficient, engaged, force, .. } = candidate.bounded[place];
            if free {
                candidate.set_bounded(&mut sides, place, force + next(), dt);
            } else if engaged {
                // The limit has moved with the normal force.
                candidate.set_bounded(&mut sides, place, (coefficient * candidate.normal_force).copysign(force), dt);
                candidate.bounded[place].at_limit = true;
            }
        }
        sides.put_back(movers, candidate.ends);
    }
}
