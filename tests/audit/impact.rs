//! A disc that strikes a wall, solved independently of the engine. The penalty law is written again, and integrated
//! from event to event with steps of a thousandth of a contact.
//!
//! Between two events every rate is smooth. So the classical Runge-Kutta method errs by `(omega h)^4/120` of the motion
//! in a contact: 1e-13 with [`STEPS`]. Events are bisected to rounding. The reference uses no code of the engine.

use std::f64::consts::PI;

/// Steps of a half period of the fastest spring of the contact.
const STEPS: f64 = 1500.0;

/// The normal law, with its coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Normal {
    /// `(1 + mu_e) k d` while loading, `(1 - mu_e) k d` while unloading.
    Inelasticity(f64),
    /// A spring and a dashpot of this damping in N s/m, never pulling.
    Dashpot(f64),
}

/// The tangential law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tangential {
    None,
    /// Stiffness over the normal one.
    Spring(f64),
    Exact,
}

/// The rolling law: coefficient, and stiffness at the rim over the normal one.
pub type Rolling = Option<(f64, f64)>;

/// A disc above a wall along x, at height zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    pub radius: f64,
    pub mass: f64,
    pub inertia: f64,
    pub stiffness: f64,
    pub normal: Normal,
    pub tangential: Tangential,
    pub rolling: Rolling,
    /// Static and dynamic coefficient.
    pub friction: (f64, f64),
    pub gravity: (f64, f64),
    /// Velocity of the surface of the wall along x in m/s.
    pub belt: f64,
    pub begin: Disc,
    pub duration: f64,
}

/// The disc: place, angle, velocity, spin, and the elongations of its springs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disc {
    pub x: f64,
    pub y: f64,
    pub angle: f64,
    pub vx: f64,
    pub vy: f64,
    pub spin: f64,
    pub stretch: f64,
    pub roll: f64,
}

impl Disc {
    fn plus(&self, rate: &Self, h: f64) -> Self {
        Self {
            x: self.x + h * rate.x,
            y: self.y + h * rate.y,
            angle: self.angle + h * rate.angle,
            vx: self.vx + h * rate.vx,
            vy: self.vy + h * rate.vy,
            spin: self.spin + h * rate.spin,
            stretch: self.stretch + h * rate.stretch,
            roll: self.roll + h * rate.roll,
        }
    }
}

/// A slider with a Coulomb limit.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Grip {
    Stick,
    /// It slips; the sign is that of the way the disc moves.
    Slip(f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    Loading,
    Unloading,
    /// A dashpot that would pull.
    Slack,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Modes {
    phase: Phase,
    along: Grip,
    rolling: Grip,
}

/// Why there is no solution to compare with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unsolved {
    /// The disc comes to rest along the normal, where the law has several forces.
    Rests,
    /// Modes follow each other without end.
    Chatters,
}

impl Impact {
    /// The state after the duration.
    pub fn solve(&self) -> Result<Disc, Unsolved> {
        let (mut disc, mut now) = (self.begin, 0.0);
        for _ in 0..64 {
            let left = self.duration - now;
            match self.time_to_touch(&disc).filter(|time| *time < left) {
                None => return Ok(self.fly(&disc, left)),
                Some(time) => {
                    disc = self.fly(&disc, time);
                    disc.y = self.radius;
                    now += time;
                }
            }
            let (after, parted) = self.touch(disc, self.duration - now)?;
            disc = after;
            match parted {
                Some(spent) => now += spent,
                None => return Ok(disc),
            }
        }
        Err(Unsolved::Chatters)
    }

    fn fly(&self, disc: &Disc, time: f64) -> Disc {
        let (gx, gy) = self.gravity;
        Disc {
            x: disc.x + time * (disc.vx + 0.5 * time * gx),
            y: disc.y + time * (disc.vy + 0.5 * time * gy),
            angle: disc.angle + time * disc.spin,
            vx: disc.vx + time * gx,
            vy: disc.vy + time * gy,
            stretch: 0.0,
            roll: 0.0,
            ..*disc
        }
    }

    /// When the disc meets the wall from above: the first root of `h + v t + g t^2/2` at which it falls.
    fn time_to_touch(&self, disc: &Disc) -> Option<f64> {
        let (height, speed, half) = ((disc.y - self.radius).max(0.0), disc.vy, 0.5 * self.gravity.1);
        if half == 0.0 {
            return (speed < 0.0).then(|| height / -speed);
        }
        let root = speed * speed - 4.0 * half * height;
        if root < 0.0 {
            return None;
        }
        // Both roots without cancellation; the fall is the one with a negative speed.
        let q = -0.5 * (speed + root.sqrt().copysign(speed));
        let roots = [q / half, if q == 0.0 { 0.0 } else { height / q }];
        let falls = |time: &f64| *time >= 0.0 && speed + 2.0 * half * time < 0.0;
        roots.into_iter().filter(falls).reduce(f64::min)
    }

    /// Follows a contact from its first touch for no longer than `left` seconds: the disc behind it, and how long it lasted, or
    /// nothing if it still lasts.
    fn touch(&self, mut disc: Disc, left: f64) -> Result<(Disc, Option<f64>), Unsolved> {
        (disc.stretch, disc.roll) = (0.0, 0.0);
        let mut modes = self.first_modes(&disc);
        let step = PI / self.fastest() / STEPS;
        let (mut now, mut events) = (0.0, 0);
        loop {
            if now >= left {
                return Ok((disc, None));
            }
            let h = step.min(left - now);
            let next = self.step(&disc, &modes, h);
            if self.worst(&next, &modes) >= 0.0 {
                (disc, now) = (next, now + h);
                continue;
            }
            let (mut low, mut high) = (0.0, h);
            loop {
                let middle = 0.5 * (low + high);
                if middle <= low || middle >= high {
                    break;
                }
                if self.worst(&self.step(&disc, &modes, middle), &modes) >= 0.0 { low = middle } else { high = middle }
            }
            disc = self.step(&disc, &modes, high);
            now += high;
            let ended = self.indicators(&disc, &modes).map(|indicator| indicator < 0.0);
            if !self.change(&mut disc, &mut modes, ended)? {
                return Ok((disc, Some(now)));
            }
            events += 1;
            if events > 10_000 {
                return Err(Unsolved::Chatters);
            }
        }
    }

    fn fastest(&self) -> f64 {
        let (inverse_mass, turning) = (1.0 / self.mass, self.radius * self.radius / self.inertia);
        let inelasticity = if let Normal::Inelasticity(mu) = self.normal { mu } else { 0.0 };
        let along =
            if let Tangential::Spring(ratio) = self.tangential { ratio * (inverse_mass + turning) } else { 0.0 };
        let rolling = self.rolling.map_or(0.0, |(_, ratio)| ratio * turning);
        (self.stiffness * ((1.0 + inelasticity) * inverse_mass).max(along).max(rolling)).sqrt()
    }

    fn overlap(&self, disc: &Disc) -> f64 {
        self.radius - disc.y
    }

    /// Normal force with its rate, smooth within a phase.
    fn push(&self, disc: &Disc, phase: Phase) -> (f64, f64) {
        let (k, d) = (self.stiffness, self.overlap(disc));
        match (self.normal, phase) {
            (_, Phase::Slack) => (0.0, 0.0),
            (Normal::Inelasticity(mu), phase) => {
                let factor = k * if phase == Phase::Loading { 1.0 + mu } else { 1.0 - mu };
                (factor * d, -factor * disc.vy)
            }
            (Normal::Dashpot(damping), _) => {
                let force = k * d - damping * disc.vy;
                (force, -k * disc.vy - damping * (force / self.mass + self.gravity.1))
            }
        }
    }

    /// Velocity of the point of contact along the wall.
    fn slides(&self, disc: &Disc) -> f64 {
        disc.vx - self.belt + disc.spin * disc.y
    }

    fn along_stiffness(&self) -> f64 {
        if let Tangential::Spring(ratio) = self.tangential { ratio * self.stiffness } else { 0.0 }
    }

    fn rolling_law(&self) -> (f64, f64) {
        self.rolling.map_or((0.0, 0.0), |(friction, ratio)| {
            (friction * self.radius, ratio * self.stiffness * self.radius * self.radius)
        })
    }

    /// Torque of the rolling spring on the disc.
    fn rolling_torque(&self, disc: &Disc, modes: &Modes) -> f64 {
        let (arm, stiffness) = self.rolling_law();
        match modes.rolling {
            Grip::Stick => -stiffness * disc.roll,
            Grip::Slip(sign) => -sign * arm * self.push(disc, modes.phase).0,
        }
    }

    /// Friction on the disc along x.
    fn friction_force(&self, disc: &Disc, modes: &Modes) -> f64 {
        match (self.tangential, modes.along) {
            (Tangential::None, _) => 0.0,
            (_, Grip::Slip(sign)) => -sign * self.friction.1 * self.push(disc, modes.phase).0,
            (Tangential::Spring(ratio), Grip::Stick) => -ratio * self.stiffness * disc.stretch,
            // The force that keeps `vx + spin y` at rest: `F/m + g + y (y F + M)/I + spin vy = 0`.
            (Tangential::Exact, Grip::Stick) => {
                let free =
                    self.gravity.0 + disc.spin * disc.vy + disc.y * self.rolling_torque(disc, modes) / self.inertia;
                -free / (1.0 / self.mass + disc.y * disc.y / self.inertia)
            }
        }
    }

    fn rates(&self, disc: &Disc, modes: &Modes) -> Disc {
        let ((push, _), along) = (self.push(disc, modes.phase), self.friction_force(disc, modes));
        let sticks = |grip: Grip, rate: f64| if grip == Grip::Stick { rate } else { 0.0 };
        Disc {
            x: disc.vx,
            y: disc.vy,
            angle: disc.spin,
            vx: along / self.mass + self.gravity.0,
            vy: push / self.mass + self.gravity.1,
            spin: (disc.y * along + self.rolling_torque(disc, modes)) / self.inertia,
            stretch: sticks(modes.along, self.slides(disc)),
            roll: sticks(modes.rolling, disc.spin),
        }
    }

    fn step(&self, disc: &Disc, modes: &Modes, h: f64) -> Disc {
        let first = self.rates(disc, modes);
        let second = self.rates(&disc.plus(&first, 0.5 * h), modes);
        let third = self.rates(&disc.plus(&second, 0.5 * h), modes);
        let fourth = self.rates(&disc.plus(&third, h), modes);
        let sum = first.plus(&second, 2.0).plus(&third, 2.0).plus(&fourth, 1.0);
        disc.plus(&sum, h / 6.0)
    }

    fn first_modes(&self, disc: &Disc) -> Modes {
        let mut modes = Modes { phase: Phase::Loading, along: Grip::Stick, rolling: Grip::Stick };
        let (force, rate) = self.push(disc, Phase::Loading);
        let begins = |stiffness: f64, speed: f64, coefficient: f64| {
            // A dashpot pushes at once, so that a spring that begins without any elongation holds.
            let damped = matches!(self.normal, Normal::Dashpot(damping) if damping > 0.0);
            let slips = stiffness * speed.abs() > coefficient * rate && !damped;
            if slips { Grip::Slip(speed.signum()) } else { Grip::Stick }
        };
        debug_assert!(force >= -1e-6 * rate.abs());
        modes.along = match self.tangential {
            Tangential::None => Grip::Stick,
            Tangential::Spring(ratio) => begins(ratio * self.stiffness, self.slides(disc), self.friction.0),
            Tangential::Exact => Grip::Slip(self.slides(disc).signum()),
        };
        if self.rolling.is_some() {
            let (arm, stiffness) = self.rolling_law();
            modes.rolling = begins(stiffness, disc.spin, arm);
        }
        modes
    }

    /// What is below zero once a mode has ended: normal, along, rolling.
    fn indicators(&self, disc: &Disc, modes: &Modes) -> [f64; 3] {
        let (force, rate) = self.push(disc, modes.phase);
        let normal = match (self.normal, modes.phase) {
            (_, Phase::Slack) => self.overlap(disc).min(-self.push(disc, Phase::Loading).0),
            (Normal::Inelasticity(mu), phase) => {
                let way = if phase == Phase::Loading { -disc.vy } else { disc.vy };
                if mu > 0.0 { way.min(self.overlap(disc)) } else { self.overlap(disc) }
            }
            (Normal::Dashpot(_), _) => force,
        };
        let slider = |grip: Grip, stretch: f64, speed: f64, stiffness: f64, (fixed, moving): (f64, f64)| match grip {
            Grip::Stick => fixed * force - (stiffness * stretch).abs(),
            Grip::Slip(sign) => sign * speed - moving * rate / stiffness,
        };
        let along = match (self.tangential, modes.along) {
            (Tangential::None, _) => 1.0,
            (Tangential::Exact, Grip::Stick) => self.friction.0 * force - self.friction_force(disc, modes).abs(),
            (Tangential::Exact, Grip::Slip(sign)) => sign * self.slides(disc),
            (_, grip) => slider(grip, disc.stretch, self.slides(disc), self.along_stiffness(), self.friction),
        };
        let (arm, stiffness) = self.rolling_law();
        let rolling = if arm > 0.0 { slider(modes.rolling, disc.roll, disc.spin, stiffness, (arm, arm)) } else { 1.0 };
        [normal, along, rolling]
    }

    fn worst(&self, disc: &Disc, modes: &Modes) -> f64 {
        self.indicators(disc, modes).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Ends the modes whose indicators have vanished, then those that a jump of the normal force leaves without a base.
    /// Says whether the disc still touches.
    fn change(
        &self,
        disc: &mut Disc,
        modes: &mut Modes,
        [normal, along, rolling]: [bool; 3],
    ) -> Result<bool, Unsolved> {
        let before = self.push(disc, modes.phase).0;
        if normal && !self.end_phase(disc, modes)? {
            return Ok(false);
        }
        if self.push(disc, modes.phase).0 > before {
            self.keep_springs(disc, modes, before);
        }
        if along {
            self.end_along(disc, modes);
        }
        if rolling {
            self.end_rolling(disc, modes);
        }
        for _ in 0..16 {
            let ([_, along, rolling], force) = (self.indicators(disc, modes), self.push(disc, modes.phase).0);
            // What has just changed begins at zero: only more than rounding counts.
            let speed = disc.vx.abs() + disc.vy.abs() + (disc.spin * self.radius).abs();
            let over = |grip: Grip, value: f64, limit: f64, speed: f64| match grip {
                Grip::Stick => value < -1e-12 * limit,
                Grip::Slip(_) => value < -1e-12 * speed,
            };
            // What friction without a spring has to bear depends on the rolling spring.
            if over(modes.rolling, rolling, self.rolling_law().0 * force, speed / self.radius) {
                self.end_rolling(disc, modes);
            } else if over(modes.along, along, self.friction.0 * force, speed) {
                self.end_along(disc, modes);
            } else {
                break;
            }
        }
        Ok(true)
    }

    /// The normal force has jumped up from `before`: no energy draws the springs that slipped to its new limit, so that they stick.
    fn keep_springs(&self, disc: &mut Disc, modes: &mut Modes, before: f64) {
        if let (Grip::Slip(sign), Tangential::Spring(ratio)) = (modes.along, self.tangential) {
            disc.stretch = sign * self.friction.1 * before / (ratio * self.stiffness);
            modes.along = Grip::Stick;
        }
        let (arm, stiffness) = self.rolling_law();
        if let Grip::Slip(sign) = modes.rolling {
            disc.roll = sign * arm * before / stiffness;
            modes.rolling = Grip::Stick;
        }
    }

    fn end_along(&self, disc: &mut Disc, modes: &mut Modes) {
        modes.along = match (modes.along, self.tangential) {
            (Grip::Stick, Tangential::Exact) => Grip::Slip(-self.friction_force(disc, modes).signum()),
            (Grip::Stick, _) => Grip::Slip(disc.stretch.signum()),
            (Grip::Slip(sign), Tangential::Spring(ratio)) => {
                disc.stretch = sign * self.friction.1 * self.push(disc, modes.phase).0 / (ratio * self.stiffness);
                Grip::Stick
            }
            (Grip::Slip(_), _) => Grip::Stick,
        };
    }

    fn end_rolling(&self, disc: &mut Disc, modes: &mut Modes) {
        let (arm, stiffness) = self.rolling_law();
        modes.rolling = match modes.rolling {
            Grip::Stick => Grip::Slip(disc.roll.signum()),
            Grip::Slip(sign) => {
                disc.roll = sign * arm * self.push(disc, modes.phase).0 / stiffness;
                Grip::Stick
            }
        };
    }

    fn end_phase(&self, disc: &Disc, modes: &mut Modes) -> Result<bool, Unsolved> {
        let open = self.overlap(disc) < 0.0;
        match (self.normal, modes.phase) {
            (Normal::Dashpot(_), Phase::Slack) if open => return Ok(false),
            (Normal::Dashpot(_), Phase::Slack) => modes.phase = Phase::Loading,
            (Normal::Dashpot(_), _) if open => return Ok(false),
            (Normal::Dashpot(_), _) => modes.phase = Phase::Slack,
            (Normal::Inelasticity(_), _) if open => return Ok(false),
            (Normal::Inelasticity(_), _) => {
                let accelerates = |phase: Phase| self.push(disc, phase).0 / self.mass + self.gravity.1;
                let (least, greatest) = (accelerates(Phase::Unloading), accelerates(Phase::Loading));
                if least <= 0.0 && greatest >= 0.0 {
                    return Err(Unsolved::Rests);
                }
                modes.phase = if least > 0.0 { Phase::Unloading } else { Phase::Loading };
            }
        }
        Ok(true)
    }
}
