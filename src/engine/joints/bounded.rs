//! Bounded holding of a rate by a torque (Coulomb: stick and slip). Joint friction and motors with a greatest torque use it.
//! While the torque suffices, a row holds the rate exactly. Otherwise the torque is the greatest one.

use serde::{Deserialize, Serialize};

use super::ends::{Along, EndPair};
use crate::constraints::{Row, RowKind, Share};
use crate::tick::{Bend, Indicator, State};

/// A rate counts as held if its deviation is below this share of the spins and speeds behind it.
const SAME: f64 = 1e-9;
/// A rate that others hold accelerates by less than this share of what its own torque does. Forces of dependent rows leave
/// 1e-10.
const TURNS: f64 = 1e-6;
/// A share of torques and rates that is rounding.
const ROUNDING: f64 = 1e-14;

/// If others hold the same rate, a bounded row bears about the square of this share of the load. Gears and limits have
/// no bound. Two bounded rows do not push against each other through a gear.
const LESS: f64 = 0.1;

/// Its action in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
enum Mode {
    /// It holds the rate.
    #[default]
    Holds,
    /// It gives its greatest torque: the sign of it.
    Gives(f64),
}

/// A rate that is held as long as a torque suffices.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounded {
    /// In rad/s, or m/s for a slide.
    speed: f64,
    /// The greatest torque in N m, of a slide force in N.
    limit: f64,
    mode: Mode,
    /// The torque of the last evaluation in which it held.
    torque: f64,
    /// By how much the rate of accepted states has differed at most from the one to be held.
    farthest: f64,
    /// Whether it gives its bound and the rate stays all the same, because others hold it.
    stands: bool,
    /// Whether it holds for a try, among others that give their bounds: at its bound it gives it.
    tries: bool,
}

impl Bounded {
    /// Whether another one, from a file, has the same speed and bound.
    pub fn has_parameters_of(&self, saved: &Self) -> bool {
        (self.speed, self.limit) == (saved.speed, saved.limit) && saved.torque.is_finite()
    }

    /// Holds a speed in rad/s or m/s. The torque is at most `limit` in N m, or the force in N.
    pub fn new(speed: f64, limit: f64) -> Self {
        Self { speed, limit, mode: Mode::Holds, torque: 0.0, farthest: 0.0, stands: false, tries: false }
    }

    /// Whether its torque has a bound.
    pub fn is_bounded(&self) -> bool {
        self.limit.is_finite()
    }

    /// The torque in N m, or force in N, that is given whatever the motion is.
    pub fn given(&self) -> Option<f64> {
        match self.mode {
            Mode::Holds => None,
            Mode::Gives(sign) => Some(sign * self.limit),
        }
    }

    /// The row that holds the rate, while it is held.
    pub fn row(&self, pair: &EndPair, along: &Along) -> Option<Row> {
        let share = Share { natural: 0.0, measure: if self.is_bounded() { LESS } else { 1.0 } };
        let row = Row { rate: self.speed, bound: self.limit, share, ..pair.row(along, RowKind::Velocity) };
        (self.mode == Mode::Holds).then_some(row)
    }

    /// Takes the torque of its row.
    pub fn note(&mut self, torque: f64) {
        self.torque = torque;
    }

    /// Its row has given its bound, with this sign. From then on it gives the bound.
    pub fn give(&mut self, torque: f64) {
        self.set(Mode::Gives(torque.signum()));
    }

    /// The distance of the rate from the one to hold, or `None` if it is only rounding.
    fn missing(&self, pair: &EndPair, along: &Along) -> f64 {
        let missing = self.speed - pair.rate(along);
        let share = if self.farthest == 0.0 { ROUNDING } else { SAME };
        let same = share * (self.farthest + self.speed.abs() + pair.speeds(along));
        if missing.abs() > same { missing } else { 0.0 }
    }

    /// Modes of others change. If it gave its bound while others held the rate, it may hold the rate with the other sign. Says whether so.
    pub fn look_again(&mut self) -> bool {
        let tries = std::mem::take(&mut self.stands);
        if tries {
            self.hold();
        }
        tries
    }

    /// The greatest torque with which it holds. In a try the bound itself is too much: it has been reached, or others
    /// bear more.
    fn most(&self) -> f64 {
        self.limit * if self.tries { 1.0 - SAME } else { 1.0 + SAME }
    }

    /// The present state is an accepted one. Trial states may have rates beyond all bounds.
    pub fn accept(&mut self, pair: &EndPair, along: &Along) {
        self.farthest = self.farthest.max((self.speed - pair.rate(along)).abs());
    }

    /// Chooses the mode of a state. Says whether that is another one.
    pub fn choose(&mut self, pair: &EndPair, along: &Along) -> bool {
        let missing = self.missing(pair, along);
        self.accept(pair, along);
        let mode = match self.mode {
            _ if !self.is_bounded() => Mode::Holds,
            // A blow may have turned the rate round: then the torque turns with it.
            _ if missing != 0.0 => Mode::Gives(missing.signum()),
            Mode::Holds if self.torque.abs() > self.most() => Mode::Gives(self.torque.signum()),
            mode => mode,
        };
        self.set(mode)
    }

    /// Corrects the mode after an evaluation. Says whether it did.
    pub fn settle(&mut self, pair: &EndPair, along: &Along, state: &State) -> bool {
        self.choose(pair, along) || self.turns_at_once(pair, along, state)
    }

    /// The greatest torque may drive the rate beyond the required one, which it has. Then it holds for a try. Events of
    /// others may leave such a state, in which no indicator changes its sign.
    fn turns_at_once(&mut self, pair: &EndPair, along: &Along, state: &State) -> bool {
        let Mode::Gives(sign) = self.mode else { return false };
        let row = pair.row(along, RowKind::Velocity);
        let own = self.limit * row.response(&row, state.bodies());
        let turns = self.missing(pair, along) == 0.0 && sign * row.acceleration(state.bodies()) > TURNS * own;
        if turns {
            self.hold();
        }
        turns
    }

    /// Chooses the mode after a jump of velocities. If the rate is the required one, it is held for a try, because its
    /// torque may have to reverse.
    pub fn after_blow(&mut self, pair: &EndPair, along: &Along) {
        if self.is_bounded() && self.missing(pair, along) == 0.0 {
            self.hold();
        } else {
            self.choose(pair, along);
        }
    }

    /// Between ticks: begins to hold a rate that has passed the required one.
    pub fn follow(&mut self, pair: &EndPair, along: &Along) -> bool {
        match self.mode {
            Mode::Holds if self.torque.abs() > self.limit => self.set(Mode::Gives(self.torque.signum())),
            Mode::Gives(sign) if sign * (self.speed - pair.rate(along)) < 0.0 => self.set(Mode::Holds),
            _ => false,
        }
    }

    /// Between ticks: begins to hold a rate that will reach the required one within the tick. Returns whether it does.
    pub fn reaches(&mut self, pair: &EndPair, along: &Along, (acceleration, tick): (f64, f64)) -> bool {
        match self.mode {
            Mode::Gives(sign) if sign * (self.speed - pair.rate(along)) <= sign * acceleration * tick => {
                self.set(Mode::Holds)
            }
            _ => false,
        }
    }

    /// Begins to hold the rate, for a try.
    pub fn hold(&mut self) {
        self.set(Mode::Holds);
        self.tries = true;
    }

    fn set(&mut self, mode: Mode) -> bool {
        let other = mode != self.mode;
        if other {
            (self.mode, self.torque) = (mode, 0.0);
        }
        other
    }

    /// Adds the indicator of the mode. It is the distance of the torque from its bounds, or of the rate from the required one.
    pub fn tell(&mut self, pair: &EndPair, along: &Along, state: &State, told: &mut Vec<Indicator>) {
        (self.stands, self.tries) = (false, false);
        let rounding = ROUNDING * self.limit;
        let missing = self.speed - pair.rate(along);
        match self.mode {
            _ if !self.is_bounded() => {}
            Mode::Holds => {
                let row = pair.row(along, RowKind::Velocity);
                let bend = Bend::AtMost(pair.bend_of_row(&row, 2.0 * self.limit, state));
                told.extend(
                    [1.0, -1.0].map(|sign| Indicator {
                        rounding,
                        ..Indicator::of_value(self.limit - sign * self.torque, bend)
                    }),
                );
            }
            Mode::Gives(sign) => {
                let row = pair.row(along, RowKind::Velocity);
                let acceleration = row.acceleration(state.bodies());
                let own = self.limit * row.response(&row, state.bodies());
                self.stands = self.missing(pair, along) == 0.0 && acceleration.abs() <= SAME * own;
                told.push(Indicator {
                    rounding: ROUNDING * self.farthest,
                    ..Indicator::new(sign * missing, -sign * acceleration, Bend::Fitted)
                });
            }
        }
    }

    /// The indicator at a place has vanished.
    pub fn switch(&mut self, index: usize) {
        let mode = match self.mode {
            Mode::Holds => Mode::Gives(if index == 0 { 1.0 } else { -1.0 }),
            Mode::Gives(_) => Mode::Holds,
        };
        self.stands = self.mode == Mode::Holds;
        self.set(mode);
    }
}
