//! The sampler of a run for its plots. It only reads: the run is the same with and without it.
//!
//! A plot shows the whole time of its film at once, and its axes have to include the future. So the channels are read
//! in a run beforehand. The stored samples depend on the resolution of a picture, not on the length of the run.

use std::collections::BTreeMap;

use crate::record::plot::curve_names::{common, headed, with_unit};
use crate::record::plot::phase_portrait;
use crate::record::plot::{Axis, Bars, Content, Curve, Decimator, Plot, Sample};
use crate::record::sections::PlotEntry;
use crate::scene::Outline;
use crate::sensors::{self, Channel};
use crate::simulation::Simulation;
use crate::tick::Failure;

/// Channels are read at every tick, but no more often than so many times in a film.
const READINGS: u64 = 8192;

/// Columns of a curve against time. Of each up to four readings are kept; wider than this no plot is.
const COLUMNS: f64 = 2048.0;

/// Counts of a histogram that are kept.
const COUNTS: u64 = 2048;

/// A failing run ends with enormous numbers. From the first number that exceeds the largest of the first half by this
/// factor, no samples are plotted.
const WILDEST_GROWTH: f64 = 100.0;

/// A channel that is not there, though its name looks right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing {
    /// The place of the plot.
    pub plot: usize,
    /// The channel's name.
    pub channel: String,
}

/// Reads the channels of plots during a run.
pub struct Sampler {
    plots: Vec<Sampled>,
    from: f64,
    to: f64,
    /// The next tick to read at, and the last one.
    next: u64,
    last: u64,
    every: u64,
    readings: u64,
    /// Places in the cast.
    bodies: BTreeMap<String, usize>,
}

struct Sampled {
    entry: PlotEntry,
    gauge: Gauge,
}

enum Gauge {
    Times(Vec<(Channel, Decimator)>),
    /// Channels to the right and upwards.
    Phases(Vec<(Channel, Channel, Vec<Sample>)>),
    /// Values of bodies now.
    Bodies(Vec<Channel>, Vec<(f64, Vec<u64>)>),
    /// Values of a channel so far.
    Values(Channel, Vec<u64>, Vec<(f64, Vec<u64>)>),
}

impl Sampler {
    /// A sampler for plots of a run at its beginning, from `from` to `to` seconds.
    ///
    /// # Errors
    /// [`Missing`] if there is no channel of a name.
    pub fn new(simulation: &mut Simulation, plots: &[PlotEntry], from: f64, to: f64) -> Result<Self, Missing> {
        let clock = simulation.clock();
        let tick = |time: f64| (time / clock.dt).round() as u64;
        let (next, last) = (tick(from), tick(to).min(simulation.ticks()));
        let every = (last.saturating_sub(next)).div_ceil(READINGS).max(1);
        let outline = simulation.header().outline.clone();
        let sampled = plots.iter().enumerate().map(|(index, entry)| {
            let gauge = gauge(simulation, entry, &outline).map_err(|channel| Missing { plot: index, channel })?;
            Ok(Sampled { entry: entry.clone(), gauge })
        });
        let plots = sampled.collect::<Result<_, _>>()?;
        let bodies = (0..simulation.bodies().len()).map(|index| (simulation.name(index).to_owned(), index)).collect();
        Ok(Self { plots, from, to, next, last, every, readings: 0, bodies })
    }

    /// Runs until `time` seconds, or the tick before, and reads on the way.
    ///
    /// # Errors
    /// When the run fails.
    pub fn run_to(&mut self, simulation: &mut Simulation, time: f64) -> Result<(), Failure> {
        // A time that is a tick up to rounding counts as that tick.
        let reached = (time / simulation.clock().dt + 1e-6) as u64;
        while self.next <= reached.min(self.last) {
            simulation.run_to_tick(self.next)?;
            self.read(simulation);
            // The end is read, whatever the steps.
            self.next = if self.next < self.last { (self.next + self.every).min(self.last) } else { u64::MAX };
        }
        Ok(())
    }

    /// Runs until the last reading.
    ///
    /// # Errors
    /// When the run fails.
    pub fn run_to_end(&mut self, simulation: &mut Simulation) -> Result<(), Failure> {
        self.run_to(simulation, f64::INFINITY)
    }

    fn read(&mut self, simulation: &Simulation) {
        let (world, time) = (simulation.unpublished_world(), simulation.clock().time());
        let column = ((time - self.from) / (self.to - self.from) * COLUMNS) as i64;
        let counts = self.readings.is_multiple_of(READINGS / COUNTS) || self.next == self.last;
        self.readings += 1;
        for Sampled { entry, gauge } in &mut self.plots {
            match gauge {
                Gauge::Times(curves) => {
                    for (channel, decimator) in curves {
                        decimator.push(column, Sample { time, x: time, y: channel.value(world) });
                    }
                }
                Gauge::Phases(curves) => {
                    for (x, channel, samples) in curves {
                        samples.push(Sample { time, x: x.value(world), y: channel.value(world) });
                    }
                }
                Gauge::Bodies(channels, kept) if counts => {
                    let mut bins = empty(entry);
                    channels.iter().for_each(|channel| count(entry, channel.value(world), &mut bins));
                    keep(kept, time, &bins);
                }
                Gauge::Bodies(..) => (),
                Gauge::Values(channel, bins, kept) => {
                    count(entry, channel.value(world), bins);
                    if counts {
                        keep(kept, time, bins);
                    }
                }
            }
        }
    }

    /// The plots. If `wrong`, the run failed, and its wild end is left out.
    pub fn finish(self, wrong: bool) -> Vec<Plot> {
        let finish = |sampled: Sampled| sampled.finish((self.from, self.to), &self.bodies);
        let mut plots: Vec<Plot> = self.plots.into_iter().map(finish).collect();
        if wrong {
            plots.iter_mut().for_each(tame);
        }
        plots
    }
}

fn gauge(simulation: &mut Simulation, entry: &PlotEntry, outline: &Outline) -> Result<Gauge, String> {
    let world = simulation.world_mut();
    let mut find = |names: Vec<String>| {
        let found = sensors::find_all(world, &names).into_iter().zip(names);
        found.map(|(channel, name)| channel.ok_or(name)).collect::<Result<Vec<_>, _>>()
    };
    if let Some(histogram) = &entry.histogram {
        let mut channels = find(histogram.channels(outline))?;
        return Ok(match (&histogram.channel, channels.pop()) {
            (Some(_), Some(channel)) => Gauge::Values(channel, empty(entry), Vec::new()),
            (_, last) => {
                channels.extend(last);
                Gauge::Bodies(channels, Vec::new())
            }
        });
    }
    let names = entry.channels(outline);
    let Some(x) = &entry.x else {
        return Ok(Gauge::Times(find(names)?.into_iter().map(|channel| (channel, Decimator::default())).collect()));
    };
    let across = names.iter().map(|name| phase_portrait::beside(x, name).unwrap_or_else(|| x.clone())).collect();
    let pairs = find(across)?.into_iter().zip(find(names)?);
    Ok(Gauge::Phases(pairs.map(|(x, channel)| (x, channel, Vec::new())).collect()))
}

/// No counts yet: a place for each bin, and one for what lies outside.
fn empty(entry: &PlotEntry) -> Vec<u64> {
    vec![0; entry.histogram.as_ref().map_or(0, |histogram| histogram.bins.0 as usize) + 1]
}

/// Counts a value; a bin holds its lower edge, the last one its upper edge too.
fn count(entry: &PlotEntry, value: f64, bins: &mut [u64]) {
    let Some(histogram) = &entry.histogram else { return };
    let (from, to, inside) = (histogram.from.si(), histogram.to.si(), bins.len() - 1);
    let bin = ((value - from) / (to - from) * inside as f64) as usize;
    bins[if (from..=to).contains(&value) { bin.min(inside - 1) } else { inside }] += 1;
}

fn keep(kept: &mut Vec<(f64, Vec<u64>)>, time: f64, bins: &[u64]) {
    if kept.last().is_none_or(|(_, last)| last != bins) {
        kept.push((time, bins.to_vec()));
    }
}

impl Sampled {
    fn finish(self, span: (f64, f64), bodies: &BTreeMap<String, usize>) -> Plot {
        let body = |channel: &Channel| bodies.get(channel.name.split_once('.')?.0).copied();
        let Sampled { entry, gauge } = self;
        let range = entry.range.map(|(low, high)| (low.si(), high.si()));
        let up = |label: String, unit: String| Axis { label, unit, range, logarithmic: entry.log };
        let across = |label: &str, unit: &str, range| Axis {
            label: label.to_owned(),
            unit: unit.to_owned(),
            range,
            logarithmic: false,
        };
        let titled = |default: String| entry.title.clone().unwrap_or(default);
        match gauge {
            Gauge::Times(curves) => {
                let (shared, unit, labels) = labels(curves.iter().map(|(channel, _)| channel));
                let curves = curves.into_iter().zip(labels);
                let curves = curves.map(|((channel, decimator), label)| Curve {
                    label,
                    body: body(&channel),
                    samples: decimator.finish(),
                });
                Plot {
                    title: titled(shared.clone()),
                    across: across("time", "s", Some(span)),
                    up: up(shared, unit),
                    content: Content::Times(curves.collect()),
                }
            }
            Gauge::Phases(curves) => {
                let (x, x_unit, _) = labels(curves.iter().map(|(x, ..)| x));
                let (shared, unit, labels) = labels(curves.iter().map(|(_, channel, _)| channel));
                let curves = curves.into_iter().zip(labels);
                let curves =
                    curves.map(|((_, channel, samples), label)| Curve { label, body: body(&channel), samples });
                // An owner with which the names of both axes begin stands above them.
                let (owner, [to_the_right, upwards]) = headed([&x, &shared]);
                Plot {
                    title: titled(if owner.is_empty() { format!("{shared} against {x}") } else { owner }),
                    across: across(&to_the_right, &x_unit, None),
                    up: up(upwards, unit),
                    content: Content::Phases(curves.collect(), entry.tail.map(|tail| tail.si())),
                }
            }
            Gauge::Bodies(channels, counts) => {
                let (shared, unit, _) = labels(channels.iter());
                let histogram = entry.histogram.as_ref();
                let quantity = histogram.and_then(|histogram| histogram.quantity.clone()).unwrap_or(shared);
                let range = histogram.map(|histogram| (histogram.from.si(), histogram.to.si()));
                let across = across(&quantity, &unit, range);
                Plot {
                    title: titled(quantity),
                    across,
                    up: up("bodies".to_owned(), String::new()),
                    content: Content::Bars(Bars { counts }),
                }
            }
            Gauge::Values(channel, _, counts) => {
                let range = entry.histogram.as_ref().map(|histogram| (histogram.from.si(), histogram.to.si()));
                Plot {
                    title: titled(channel.name.clone()),
                    across: across(&channel.name, channel.unit, range),
                    up: up("readings".to_owned(), String::new()),
                    content: Content::Bars(Bars { counts }),
                }
            }
        }
    }
}

/// The common part of channels, their common unit if there is one, and a label for each. Without a common unit the
/// labels have units.
fn labels<'a>(channels: impl Iterator<Item = &'a Channel> + Clone) -> (String, String, Vec<String>) {
    let names: Vec<&str> = channels.clone().map(|channel| channel.name.as_str()).collect();
    let (shared, mut labels) = common(&names);
    let mut units = channels.map(|channel| channel.unit);
    let first = units.clone().next().unwrap_or_default();
    if units.clone().all(|unit| unit == first) {
        return (shared, first.to_owned(), labels);
    }
    labels.iter_mut().for_each(|label| *label = with_unit(label, units.next().unwrap_or_default()));
    (shared, String::new(), labels)
}

/// Removes the wild end of a failed run.
fn tame(plot: &mut Plot) {
    let (Content::Times(curves) | Content::Phases(curves, _)) = &mut plot.content else { return };
    let size = |sample: &Sample| sample.x.abs().max(sample.y.abs());
    for curve in curves {
        let half = curve.samples.len().div_ceil(2);
        let largest = curve.samples[..half].iter().map(size).filter(|size| size.is_finite()).fold(0.0, f64::max);
        let wild = |sample: &Sample| largest > 0.0 && size(sample) > WILDEST_GROWTH * largest;
        let end = curve.samples.iter().position(wild).unwrap_or(curve.samples.len());
        curve.samples.truncate(end);
    }
}
