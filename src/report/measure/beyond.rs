//! Statistics beyond the time until which positions are known. They are means over the rest of the run and over all
//! bodies, which chaos does not change.
//!
//! The differences of reference runs there are the scatter of one run. A setting within it is as good as they are. A
//! single run cannot show more (ensembles do: `jostle sweep`).

use glam::DVec2;

use jostle_engine::simulation::accuracy::trajectory::Trajectory;

/// Means of a run over time and bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Means {
    /// Root of the mean square of speeds, in m/s.
    speed: f64,
    /// Mean place in m.
    place: DVec2,
}

/// The distance of means from those of the reference. Speeds are a share of themselves, and positions a share of the
/// ways of bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeanDeviation {
    /// Root mean square of speeds, over that of the reference, minus one.
    pub speed: f64,
    /// Distance of the mean places, over how far bodies go.
    pub place: f64,
}

impl MeanDeviation {
    /// The greater of each, without signs.
    fn or_greater(self, other: Self) -> Self {
        Self { speed: self.speed.abs().max(other.speed.abs()), place: self.place.max(other.place) }
    }

    /// In words.
    pub fn words(&self) -> String {
        format!(
            "{:+.1} % in the mean speed, {:.1} % of the motion in the mean place",
            100.0 * self.speed,
            100.0 * self.place
        )
    }
}

/// The means of reference runs in the time beyond.
pub(super) struct Beyond {
    from: f64,
    means: Means,
    /// The distance that bodies go, in m.
    motion: f64,
    /// The distance of reference runs from each other.
    pub scatter: MeanDeviation,
}

fn means(run: &Trajectory, from: f64) -> Option<Means> {
    let (mut squares, mut place, mut many) = (0.0, DVec2::ZERO, 0.0);
    for (position, velocity) in run.states_after(from) {
        squares += velocity.length_squared();
        place += position;
        many += 1.0;
    }
    (many > 0.0).then(|| Means { speed: f64::sqrt(squares / many), place: place / many })
}

impl Beyond {
    /// The common means of these runs after `from` seconds. Settings are compared with the first run.
    pub fn of(runs: &[&Trajectory], from: f64) -> Option<Self> {
        let first = runs.first()?;
        let beyond =
            Self { from, means: means(first, from)?, motion: first.sizes().0, scatter: MeanDeviation::default() };
        let others = runs[1..].iter().filter_map(|run| beyond.compare(run));
        let scatter = others.fold(MeanDeviation::default(), MeanDeviation::or_greater);
        Some(Self { scatter, ..beyond })
    }

    /// The distance of a run from them.
    pub fn compare(&self, run: &Trajectory) -> Option<MeanDeviation> {
        let means = means(run, self.from)?;
        let (speed, motion) = (self.means.speed, self.motion);
        let apart = MeanDeviation {
            speed: means.speed / speed - 1.0,
            place: (means.place - self.means.place).length() / motion,
        };
        (apart.speed.is_finite() && apart.place.is_finite()).then_some(apart)
    }
}
