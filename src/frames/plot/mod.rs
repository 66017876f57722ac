//! Plots as plain data, sampled from a run beforehand, or read from a file.

pub mod curve_names;
mod decimate;
mod legend;
pub mod phase_portrait;
pub mod table;

pub use curve_names::{common, headed, with_unit};
pub use decimate::Decimator;
pub use legend::{Legend, LegendEntry, LegendMark};

/// A point of a curve, with the time at which it was measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Time in seconds.
    pub time: f64,
    /// The value to the right; for a plot over time, the time.
    pub x: f64,
    /// The value upwards.
    pub y: f64,
}

/// A curve: samples from early to late. A NaN or infinite sample leaves a gap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// The label among the curves of the plot.
    pub label: String,
    /// The index in the cast of the measured body, if the curve belongs to a body.
    pub body: Option<usize>,
    /// Its samples.
    pub samples: Vec<Sample>,
}

/// An axis of a plot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// The measured quantity.
    pub label: String,
    /// Its unit; empty for a pure number, or where curves have different ones.
    pub unit: String,
    /// The ends of the axis. `None`: those of the samples.
    pub range: Option<(f64, f64)>,
    /// Equal factors take equal lengths.
    pub logarithmic: bool,
}

/// A histogram that changes with time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bars {
    /// Times in seconds from early to late, each with the number in every bin from that time on. The bins are equally
    /// wide. The last number counts the values outside of all bins.
    pub counts: Vec<(f64, Vec<u64>)>,
}

impl Bars {
    /// The counts at a time (s); before the first ones nothing.
    pub fn at(&self, time: f64) -> &[u64] {
        let later = self.counts.partition_point(|(from, _)| *from <= time);
        later.checked_sub(1).map_or(&[], |index| &self.counts[index].1)
    }
}

/// The content of a plot.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Quantities against time.
    Times(Vec<Curve>),
    /// Quantities against another one, in the course of time. With a number, older samples than that many seconds are
    /// hidden, and the others fade.
    Phases(Vec<Curve>, Option<f64>),
    /// The frequencies of values.
    Bars(Bars),
}

/// One plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The words above it.
    pub title: String,
    /// The axis to the right.
    pub across: Axis,
    /// The axis upwards.
    pub up: Axis,
    /// The curves, phases or histogram.
    pub content: Content,
}

impl Plot {
    /// The curves; empty for a histogram.
    pub fn curves(&self) -> &[Curve] {
        match &self.content {
            Content::Times(curves) | Content::Phases(curves, _) => curves,
            Content::Bars(_) => &[],
        }
    }
}

/// The panel beside a film.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Board {
    /// The plots in the order of the scene.
    pub plots: Vec<Plot>,
    /// The meaning of the colours.
    pub legend: Legend,
}
