//! Firing solutions by the shooting method. A velocity of given size takes a point under gravity and drag to a target.
//!
//! Without drag `d = v t + g t^2/2` gives, for the speed `s`, a quadratic in `t^2`: `g^2 t^4/4 - (d.g + s^2) t^2 + d^2
//! = 0`. Its roots are the low and the high arc. They meet at the least speed, `s^2 = |g| |d| - d.g` (any textbook).
//!
//! With drag, `m v' = m g - sum (c1 + c2 |v - u|) (v - u)`, one velocity `v0(T)` leads to the target in the time `T`.
//! That is a boundary value problem. Newton's method solves it with the derivative of the way with respect to `v0`,
//! which is integrated beside the motion. From `r(T; v0(T)) = d` follows `dv0/dT = -(dr/dv0)^-1 v(T)`. So `v0 . dv0/dT`
//! changes its sign at the time of the least speed. The arcs are the times before and after it at which `|v0(T)|` is
//! the speed. The motion is integrated by extrapolation of the modified midpoint rule to order 16 (Gragg 1965; Bulirsch
//! and Stoer 1966). Steps are so long that the last two columns agree to `TOLERANCE`.

use glam::{DMat2, DVec2};

/// Required agreement of the last two columns in a step, relative to the size of the motion. It is the limit that
/// rounding sets.
const TOLERANCE: f64 = 3e-14;
/// Columns of the extrapolation.
const COLUMNS: usize = 8;
/// A step is never a smaller share of the flight.
const SMALLEST_STEP: f64 = 1e-10;
/// A flight takes no more steps: what needs more has long stopped flying.
const MOST_STEPS: usize = 500;
/// Steps of Newton's method.
const NEWTON_STEPS: usize = 60;
/// From one time of flight to the next in the search for arcs.
const STRIDE: f64 = 1.3;
/// This many strides lead from 1e-9 of a time to its 1e9-fold.
const STRIDES: usize = 80;
/// Halvings after which a time has all its digits.
const HALVINGS: usize = 60;

/// Resistance of air that moves evenly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Linear coefficient in N s/m.
    pub linear: f64,
    /// Quadratic coefficient in N s2/m2.
    pub quadratic: f64,
    /// Velocity of the air in m/s.
    pub velocity: DVec2,
}

/// The forces on a flying point.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Acceleration of free fall in m/s2.
    pub gravity: DVec2,
    /// Mass in kg.
    pub mass: f64,
    /// The air, or several resistances that are added.
    pub air: Vec<Air>,
}

/// Which of two ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arc {
    /// The shorter flight.
    Low,
    /// The longer flight.
    High,
}

/// A firing solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// Velocity at the start in m/s.
    pub velocity: DVec2,
    /// Seconds until the place is reached.
    pub time: f64,
}

/// Why there is no firing solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Miss {
    /// The place is the start.
    Here,
    /// The speed is too low.
    Short {
        /// The least speed in m/s that reaches the place.
        least: f64,
        /// The reach in metres of the given speed in the direction of the place.
        reach: f64,
    },
    /// No speed was found that reaches the place.
    Never,
    /// No force brings the point back, so there is no second arc.
    OneWay,
}

/// The solution of the boundary value problem for one time of flight.
#[derive(Clone, Copy, Debug)]
struct Launch {
    time: f64,
    velocity: DVec2,
    /// `v0 . dv0/dT`.
    slope: f64,
    /// `dv0/dT`.
    change: DVec2,
}

impl Launch {
    fn speed(&self) -> f64 {
        self.velocity.length()
    }

    /// The expected velocity for another time, because `v0 T` is nearly linear in `T`.
    fn guess(&self, time: f64) -> DVec2 {
        (self.velocity * self.time + (self.velocity + self.change * self.time) * (time - self.time)) / time
    }
}

/// Place, velocity, and their derivatives with respect to the velocity at the start.
#[derive(Clone, Copy, Debug)]
struct Motion {
    place: DVec2,
    velocity: DVec2,
    place_by_start: DMat2,
    velocity_by_start: DMat2,
}

impl Motion {
    fn plus(&self, rate: &Self, by: f64) -> Self {
        Self {
            place: self.place + rate.place * by,
            velocity: self.velocity + rate.velocity * by,
            place_by_start: self.place_by_start + rate.place_by_start * by,
            velocity_by_start: self.velocity_by_start + rate.velocity_by_start * by,
        }
    }

    fn minus(&self, other: &Self) -> Self {
        self.plus(other, -1.0)
    }
}

impl Flight {
    /// The velocity of size `speed`, in m/s, with which the point reaches a place `target` metres from its start.
    ///
    /// # Errors
    /// The reason if there is none, with a remedy.
    pub fn aim(&self, target: DVec2, speed: f64, arc: Arc) -> Result<Shot, Miss> {
        if target == DVec2::ZERO {
            return Err(Miss::Here);
        }
        if self.air.iter().all(|air| air.linear == 0.0 && air.quadratic == 0.0) {
            return self.aim_in_vacuum(target, speed, arc);
        }
        let nothing_returns = self.gravity == DVec2::ZERO && self.air.iter().all(|air| air.velocity == DVec2::ZERO);
        if arc == Arc::High && nothing_returns {
            return Err(Miss::OneWay);
        }
        let (first, bottom) = self.slowest(target, speed);
        let lowest = bottom.or(first).ok_or(Miss::Never)?;
        if lowest.speed() > speed {
            return Err(Miss::Short { least: lowest.speed(), reach: self.reach(target, speed) });
        }
        if arc == Arc::High && bottom.is_none() {
            return Err(Miss::OneWay);
        }
        let stride = if arc == Arc::Low { 1.0 / STRIDE } else { STRIDE };
        let (mut inside, mut outside) = (lowest, lowest);
        for _ in 0..STRIDES {
            outside = self.launch(target, inside.time * stride, &inside).ok_or(Miss::Never)?;
            if outside.speed() > speed {
                break;
            }
            inside = outside;
        }
        if outside.speed() <= speed {
            return Err(Miss::Never);
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside.time + outside.time);
            if middle == inside.time || middle == outside.time {
                break;
            }
            let between = self.launch(target, middle, &inside).ok_or(Miss::Never)?;
            if between.speed() > speed { outside = between } else { inside = between }
        }
        Ok(Shot { velocity: inside.velocity * (speed / inside.speed()), time: inside.time })
    }

    fn aim_in_vacuum(&self, target: DVec2, speed: f64, arc: Arc) -> Result<Shot, Miss> {
        let (gravity, distance) = (self.gravity.length(), target.length());
        let half = 0.5 * (target.dot(self.gravity) + speed * speed);
        let root = half * half - 0.25 * gravity * gravity * distance * distance;
        if half <= 0.0 || root < 0.0 {
            let least = (gravity * distance - target.dot(self.gravity)).max(0.0).sqrt();
            let reach = speed * speed / (gravity - target.dot(self.gravity) / distance);
            return Err(Miss::Short { least, reach });
        }
        let sum = half + root.sqrt();
        let squared = match arc {
            Arc::Low => distance * distance / sum,
            Arc::High if gravity == 0.0 => return Err(Miss::OneWay),
            Arc::High => 4.0 * sum / (gravity * gravity),
        };
        let time = squared.sqrt();
        Ok(Shot { velocity: target / time - self.gravity * (0.5 * time), time })
    }

    /// The reach in metres of the speed in the direction of the target, to a part in a million.
    fn reach(&self, target: DVec2, speed: f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            let (first, bottom) = self.slowest(target * middle, speed);
            let reached = bottom.or(first).is_some_and(|launch| launch.speed() <= speed);
            if reached { low = middle } else { high = middle }
        }
        low * target.length()
    }

    /// The slowest launch that was found. Also the launch of the least speed of all, if the speed has a minimum over
    /// the times.
    fn slowest(&self, target: DVec2, speed: f64) -> (Option<Launch>, Option<Launch>) {
        let (gravity, distance) = (self.gravity.length(), target.length());
        let time = if gravity > 0.0 { (2.0 * distance / gravity).sqrt() } else { distance / speed };
        let vacuum = target / time - self.gravity * (0.5 * time);
        let Some(first) = self.solve(target, time, vacuum) else { return (None, None) };
        let stride = if first.slope > 0.0 { 1.0 / STRIDE } else { STRIDE };
        let (mut before, mut after) = (first, None);
        for _ in 0..STRIDES {
            let Some(next) = self.launch(target, before.time * stride, &before) else { break };
            if (next.slope > 0.0) != (first.slope > 0.0) {
                after = Some(next);
                break;
            }
            before = next;
        }
        let Some(mut after) = after else { return (Some(before), None) };
        for _ in 0..HALVINGS {
            let middle = 0.5 * (before.time + after.time);
            if middle == before.time || middle == after.time {
                break;
            }
            let Some(between) = self.launch(target, middle, &before) else { break };
            if (between.slope > 0.0) == (first.slope > 0.0) { before = between } else { after = between }
        }
        (Some(before), Some(if before.speed() < after.speed() { before } else { after }))
    }

    /// The launch for a time of flight, from that for another time.
    fn launch(&self, target: DVec2, time: f64, near: &Launch) -> Option<Launch> {
        self.solve(target, time, near.guess(time))
    }

    /// Newton's method for the velocity that leads to the target in a time.
    fn solve(&self, target: DVec2, time: f64, guess: DVec2) -> Option<Launch> {
        let mut velocity = guess;
        let mut end = self.fly(velocity, time)?;
        let mut missed = target - end.place;
        for _ in 0..NEWTON_STEPS {
            let step = end.place_by_start.inverse() * missed;
            if !step.is_finite() {
                return None;
            }
            if step.length() <= f64::EPSILON * velocity.length() {
                break;
            }
            // Shorter steps if the whole one overshoots. At the end rounding prevents any further approach.
            let nearer = [1.0, 0.5, 0.25, 0.125, 0.0625, 0.01].into_iter().find_map(|share| {
                let tried = velocity + step * share;
                let end = self.fly(tried, time)?;
                ((target - end.place).length() < missed.length()).then_some((tried, end))
            });
            let Some((tried, there)) = nearer else { break };
            (velocity, end) = (tried, there);
            missed = target - end.place;
        }
        if missed.length() > 1e-11 * (target.length() + velocity.length() * time) {
            return None;
        }
        let change = -(end.place_by_start.inverse() * end.velocity);
        Some(Launch { time, velocity, slope: velocity.dot(change), change })
    }

    /// The motion at `time` seconds after a start with a velocity. `None` if steps become too small or numbers too
    /// large.
    fn fly(&self, velocity: DVec2, time: f64) -> Option<Motion> {
        let start =
            Motion { place: DVec2::ZERO, velocity, place_by_start: DMat2::ZERO, velocity_by_start: DMat2::IDENTITY };
        let scale = (velocity.length() + self.gravity.length() * time, time);
        let (mut state, mut now, mut step) = (start, 0.0, time);
        let mut steps = 0;
        while now < time {
            steps += 1;
            if steps > MOST_STEPS {
                return None;
            }
            // The last step ends at the end to the last bit.
            let last = step >= time - now;
            let length = if last { time - now } else { step };
            match self.extrapolate(&state, length, scale) {
                Some(next) => {
                    state = next;
                    now = if last { time } else { now + length };
                    step = 2.0 * length;
                }
                None if length > SMALLEST_STEP * time => step = 0.5 * length,
                None => return None,
            }
        }
        Some(state)
    }

    /// One step by extrapolation; `None` if it is too long.
    fn extrapolate(&self, from: &Motion, length: f64, scale: (f64, f64)) -> Option<Motion> {
        let rate = self.rate(from);
        let mut row: Vec<Motion> = Vec::new();
        for column in 0..COLUMNS {
            let parts = 2 * (column + 1);
            let mut next = vec![self.midpoint(from, &rate, length, parts)];
            // Aitken and Neville: each row from the one with two parts less.
            for (index, before) in row.iter().enumerate() {
                let ratio = (parts as f64 / (2 * (column - index)) as f64).powi(2);
                let last = next[index];
                next.push(last.plus(&last.minus(before), 1.0 / (ratio - 1.0)));
            }
            row = next;
        }
        let (result, change) = (row[COLUMNS - 1], row[COLUMNS - 1].minus(&row[COLUMNS - 2]));
        let small = |size: f64, scale: f64| size <= TOLERANCE * scale;
        let (speed, time) = scale;
        let agrees = small(change.place.length(), speed * time)
            && small(change.velocity.length(), speed)
            && small(size(&change.place_by_start), time)
            && small(size(&change.velocity_by_start), 1.0);
        agrees.then_some(result)
    }

    /// The modified midpoint rule with its smoothing step.
    fn midpoint(&self, from: &Motion, rate: &Motion, length: f64, parts: usize) -> Motion {
        let step = length / parts as f64;
        let (mut before, mut now) = (*from, from.plus(rate, step));
        for _ in 1..parts {
            let next = before.plus(&self.rate(&now), 2.0 * step);
            (before, now) = (now, next);
        }
        let end = before.plus(&self.rate(&now), step);
        now.plus(&end.minus(&now), 0.5)
    }

    fn rate(&self, motion: &Motion) -> Motion {
        let (mut acceleration, mut by_velocity) = (self.gravity, DMat2::ZERO);
        for air in &self.air {
            let relative = motion.velocity - air.velocity;
            let speed = relative.length();
            let (linear, quadratic) = (air.linear / self.mass, air.quadratic / self.mass);
            acceleration -= relative * (linear + quadratic * speed);
            by_velocity -= DMat2::from_diagonal(DVec2::splat(linear + quadratic * speed));
            if speed > 0.0 {
                by_velocity -= DMat2::from_cols(relative * relative.x, relative * relative.y) * (quadratic / speed);
            }
        }
        Motion {
            place: motion.velocity,
            velocity: acceleration,
            place_by_start: motion.velocity_by_start,
            velocity_by_start: by_velocity * motion.velocity_by_start,
        }
    }
}

fn size(matrix: &DMat2) -> f64 {
    matrix.to_cols_array().into_iter().map(f64::abs).fold(0.0, |most, value| if value > most { value } else { most })
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRAVITY: DVec2 = DVec2::new(0.0, -9.81);

    fn flight(linear: f64, quadratic: f64) -> Flight {
        Flight { gravity: GRAVITY, mass: 1.0, air: vec![Air { linear, quadratic, velocity: DVec2::ZERO }] }
    }

    fn angle(shot: Shot) -> f64 {
        libm::atan2(shot.velocity.y, shot.velocity.x)
    }

    /// Angles to 22 digits: truth file P06. In vacuum a few roundings, with drag the integration's 1e-12.
    #[test]
    fn both_arcs_are_those_of_the_truth_file() {
        let (target, speed) = (DVec2::new(40.0, 5.0), 25.0);
        for (linear, arc, exact, tolerance) in [
            (0.0, Arc::Low, 0.483_966_456_904_359_7, 4e-16),
            (0.0, Arc::High, 1.211_184_864_437_298_4, 4e-16),
            (0.05, Arc::Low, 0.516_012_646_788_489_6, 1e-12),
            (0.05, Arc::High, 1.135_253_173_020_836_2, 1e-12),
        ] {
            let shot = flight(linear, 0.0).aim(target, speed, arc).unwrap();
            assert!((angle(shot) - exact).abs() <= tolerance, "{linear} {arc:?}: {} {exact}", angle(shot));
            assert!((shot.velocity.length() - speed).abs() <= 1e-14 * speed);
        }
        let low = flight(0.0, 0.0).aim(target, speed, Arc::Low).unwrap();
        assert!((low.time - 1.807_590_318_824_812_6).abs() < 2e-15, "{}", low.time);
    }

    /// Linear drag has a closed form: the place after the shot's time is the target.
    #[test]
    fn shots_through_linear_drag_and_wind_hit() {
        let wind = DVec2::new(-3.0, 1.0);
        let air = Air { linear: 0.7, quadratic: 0.0, velocity: wind };
        let flight = Flight { gravity: GRAVITY, mass: 2.0, air: vec![air, Air { linear: 0.3, ..air }] };
        for target in [DVec2::new(20.0, -3.0), DVec2::new(-15.0, 4.0), DVec2::new(0.0, 6.0), DVec2::new(0.0, -6.0)] {
            for arc in [Arc::Low, Arc::High] {
                let shot = flight.aim(target, 30.0, arc).unwrap();
                let (rate, terminal) = (0.5, wind + GRAVITY / 0.5);
                let way = terminal * shot.time - (shot.velocity - terminal) * (libm::expm1(-rate * shot.time) / rate);
                assert!((way - target).length() < 1e-12 * 30.0 * shot.time, "{target} {arc:?}: {way}");
            }
        }
    }

    /// Straight up with quadratic drag: the shot passes the height `h` where `v^2 = (v0^2 + u^2) e^(-2 c h) - u^2`,
    /// `u^2 = g/c`, and the first time is `(atan(v0/u) - atan(v/u)) u/g`.
    #[test]
    fn a_shot_straight_up_through_quadratic_drag_passes_in_time() {
        let (c, height, speed) = (0.02, 10.0, 20.0_f64);
        let terminal = (9.81_f64 / c).sqrt();
        let shot = flight(0.0, c).aim(DVec2::new(0.0, height), speed, Arc::Low).unwrap();
        let squared = (speed * speed + terminal * terminal) * libm::exp(-2.0 * c * height) - terminal * terminal;
        let time = (libm::atan(speed / terminal) - libm::atan(squared.sqrt() / terminal)) * terminal / 9.81;
        assert!((shot.time - time).abs() < 1e-12 * time, "{} {time}", shot.time);
        // The second time it passes falling: v = u tanh(g t/u) from the top.
        let top = libm::log(1.0 + speed * speed / (terminal * terminal)) / (2.0 * c);
        let fall = libm::acosh(libm::exp(c * (top - height))) * terminal / 9.81;
        let late = libm::atan(speed / terminal) * terminal / 9.81 + fall;
        let shot = flight(0.0, c).aim(DVec2::new(0.0, height), speed, Arc::High).unwrap();
        assert!((shot.time - late).abs() < 1e-12 * late, "{} {late}", shot.time);
    }

    #[test]
    fn what_is_out_of_reach_is_said_with_what_would_do() {
        let target = DVec2::new(40.0, 5.0);
        let Err(Miss::Short { least, reach }) = flight(0.0, 0.0).aim(target, 20.0, Arc::Low) else { panic!("it hits") };
        // Truth file P06.
        assert!((least - 21.083_257_399_036_892).abs() < 1e-13, "{least}");
        let short = flight(0.0, 0.0).aim(target * (reach / target.length() * 1.000_001), 20.0, Arc::High);
        assert!(matches!(short, Err(Miss::Short { .. })), "{short:?}");
        assert!(flight(0.0, 0.0).aim(target * (reach / target.length() * 0.999_999), 20.0, Arc::High).is_ok());
        for flight in [flight(0.05, 0.0), flight(0.02, 0.01), flight(0.0, 0.04)] {
            let Err(Miss::Short { least, reach }) = flight.aim(target, 20.0, Arc::High) else { panic!("it hits") };
            assert!(least > 21.08 && reach < target.length(), "{least} {reach}");
            assert!(flight.aim(target, least * 1.000_001, Arc::High).is_ok());
            assert!(flight.aim(target, least * 0.999_999, Arc::Low).is_err());
            assert!(flight.aim(target * (reach / target.length()), 20.0, Arc::Low).is_ok());
        }
        let weightless = Flight { gravity: DVec2::ZERO, ..flight(0.05, 0.0) };
        assert_eq!(weightless.aim(target, 25.0, Arc::High), Err(Miss::OneWay));
        assert!(weightless.aim(target, 25.0, Arc::Low).is_ok());
        assert_eq!(weightless.aim(DVec2::ZERO, 25.0, Arc::Low), Err(Miss::Here));
    }
}
