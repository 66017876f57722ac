//! What plots show, as plain data: sampled from a run beforehand, or read from a file.

mod decimate;
mod legend;
pub mod names;
pub mod table;

pub use decimate::Decimator;
pub use legend::{Legend, LegendEntry, LegendMark};
pub use names::{common, headed, with_unit};

/// A point of a curve, with the time at which it was measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Time in seconds.
    pub time: f64,
    /// What is plotted to the right; equal to the time if that is.
    pub x: f64,
    /// What is plotted upwards.
    pub y: f64,
}

/// A curve: samples from early to late. One that is not finite leaves a gap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// What tells it from the other curves of the plot.
    pub label: String,
    /// The place in the cast of the body of which it was measured, if it was of one.
    pub body: Option<usize>,
    /// Its samples.
    pub samples: Vec<Sample>,
}

/// What stands at an axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What is measured.
    pub label: String,
    /// Its unit; empty for a pure number, or where curves have different ones.
    pub unit: String,
    /// From where to where; `None`: what the samples need.
    pub range: Option<(f64, f64)>,
    /// Equal factors take equal lengths.
    pub logarithmic: bool,
}

/// A histogram that changes with time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bars {
    /// Times in seconds from early to late, and from then on the number in each of the bins, which are equally wide.
    /// What lies outside of all of them is counted last.
    pub counts: Vec<(f64, Vec<u64>)>,
}

impl Bars {
    /// The counts at a time (s); before the first ones nothing.
    pub fn at(&self, time: f64) -> &[u64] {
        let later = self.counts.partition_point(|(from, _)| *from <= time);
        later.checked_sub(1).map_or(&[], |place| &self.counts[place].1)
    }
}

/// What is drawn in a plot.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Quantities against time.
    Times(Vec<Curve>),
    /// Quantities against another one, as time goes by; with a number, only what is so many seconds old is seen, and
    /// fades.
    Phases(Vec<Curve>, Option<f64>),
    /// How often values occur.
    Bars(Bars),
}

/// One plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What stands above it.
    pub title: String,
    /// The axis to the right.
    pub across: Axis,
    /// The axis upwards.
    pub up: Axis,
    /// What is drawn.
    pub content: Content,
}

impl Plot {
    /// The curves; none in a histogram.
    pub fn curves(&self) -> &[Curve] {
        match &self.content {
            Content::Times(curves) | Content::Phases(curves, _) => curves,
            Content::Bars(_) => &[],
        }
    }
}

/// What stands beside a film.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Board {
    /// The plots in the order of the scene.
    pub plots: Vec<Plot>,
    /// What the colours mean.
    pub legend: Legend,
}
