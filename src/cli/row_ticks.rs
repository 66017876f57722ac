//! The ticks at which rows of channels are written: the nearest one to each multiple of a time.

use super::say::{number, say};
use crate::simulation::Simulation;

/// The moments of rows.
pub(super) struct Rows {
    /// From row to row, in ticks, which need not be whole.
    every: f64,
}

impl Rows {
    /// Rows at so many moments for each second of physics, or at each frame of the film.
    pub fn of(simulation: &Simulation, rate: Option<f64>) -> Self {
        let dt = simulation.clock().dt;
        let step = rate.map_or_else(|| simulation.frame_step(), f64::recip);
        if let Some(rate) = rate.filter(|rate| rate * dt > 1.0 + 1e-9) {
            say(&format!(
                "note: --fps {} asks for more rows than the run has ticks. Each tick gives one row, every {} s. A shorter \
                 --tick gives more",
                number(rate),
                number(dt)
            ));
        }
        Self { every: (step / dt).max(1.0) }
    }

    /// The tick of the next row after a tick; `end` at the latest.
    pub fn next(&self, done: u64, end: u64) -> u64 {
        let tick = |row: f64| (row * self.every).round() as u64;
        let row = (done as f64 / self.every).floor();
        let later = [row, row + 1.0, row + 2.0].map(tick);
        later.into_iter().find(|tick| *tick > done).unwrap_or(done + 1).min(end)
    }
}

#[cfg(test)]
mod tests {
    use super::Rows;

    /// Law: row k stands at the tick nearest to k times the distance, so within half a tick of it.
    #[test]
    fn rows_do_not_drift_from_their_moments() {
        for every in [1.0, 1.2, 2.5, 83.0 + 1.0 / 3.0, 1e4 / 7.0] {
            let rows = Rows { every };
            let mut done = 0;
            for row in 1..1000_u32 {
                done = rows.next(done, u64::MAX);
                assert!((done as f64 - f64::from(row) * every).abs() <= 0.5, "{every}: {row} at {done}");
            }
            assert_eq!(rows.next(done, done + 1), done + 1);
        }
    }
}
