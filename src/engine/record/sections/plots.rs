//! `plots`: the plots beside the film. It never changes the physics.

use bevy_app::App;
use bevy_ecs::resource::Resource;
use jostle_frames::plot::phase_portrait;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::units::{Scalar, Time};
use crate::scene::values::{Names, WholeNumber};
use crate::scene::{Diagnostics, NameKind, Outline, Section, exact};
use crate::sensors;

/// The most bins that a reader can distinguish.
const MOST_BINS: u64 = 200;

/// The most plots that fit beside a film and stay readable.
const MOST_PLOTS: usize = 6;

/// The plots beside the film, on the film's clock. They never change the physics.
#[derive(Resource, Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct PlotsSection(pub Vec<PlotEntry>);

/// One plot: channels against time (`channels`), channels against a channel (`x`, `y`), or a histogram.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Plot")]
pub struct PlotEntry {
    /// The words above it. Default: the common part of the names of its channels.
    #[serde(default)]
    pub title: Option<String>,
    /// Channels to plot against time. `*` stands for any letters of the names of bodies. A plot has these, or `x` and `y`,
    /// or `histogram`. Default: none.
    #[serde(default)]
    pub channels: Option<Vec<String>>,
    /// The channel to the right of a phase portrait. `*.position.x` draws each channel over that of its own body. Default:
    /// none.
    #[serde(default)]
    pub x: Option<String>,
    /// The channel, or channels, upwards. Default: none.
    #[serde(default)]
    pub y: Option<Names>,
    /// The frequencies of values. Default: none.
    #[serde(default)]
    pub histogram: Option<HistogramEntry>,
    /// The ends of the upward axis, in the channels' unit. Default: those of the values.
    #[serde(default)]
    pub range: Option<(Scalar, Scalar)>,
    /// Whether the axis is logarithmic. The plot then shows only values above zero. Default: `false`.
    #[serde(default)]
    pub log: bool,
    /// The time in s of physics after which the way in a phase portrait has faded. Above zero. Default: the whole run.
    #[serde(default)]
    pub tail: Option<Time>,
}

/// The frequencies of values in equally wide bins. The values are a quantity of many bodies, or those of one channel so
/// far.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Histogram")]
pub struct HistogramEntry {
    /// The bodies. `*` stands for any letters. Default: from `channel`.
    #[serde(default)]
    pub of: Option<Names>,
    /// Their quantity, such as `position.x`. Default: from `channel`.
    #[serde(default)]
    pub quantity: Option<String>,
    /// A channel instead of bodies. The plot counts its values since the beginning. Default: from `of` and `quantity`.
    #[serde(default)]
    pub channel: Option<String>,
    /// The number of bins, from 1 to 200. Default: 12.
    #[serde(default = "bins")]
    pub bins: WholeNumber,
    /// The beginning of the first bin, in the quantity's unit.
    pub from: Scalar,
    /// The end of the last bin.
    pub to: Scalar,
}

fn bins() -> WholeNumber {
    WholeNumber(12)
}

impl HistogramEntry {
    /// The names of the channels whose values are counted.
    pub fn channels(&self, outline: &Outline) -> Vec<String> {
        match (&self.of, &self.quantity, &self.channel) {
            (Some(of), Some(quantity), _) => {
                let bodies =
                    of.matching(NameKind::BODY, outline).into_iter().map(|body| &outline.names(NameKind::BODY)[body]);
                bodies.map(|body| format!("{body}.{quantity}")).collect()
            }
            (_, _, channel) => channel.iter().cloned().collect(),
        }
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        let bins = self.bins.0;
        if !(1..=MOST_BINS).contains(&bins) {
            report.error("bins", format!("must be from 1 to {MOST_BINS}, got {bins}"));
        }
        check_order(self.from, self.to, ("from", "to"), report);
        match (&self.of, &self.quantity, &self.channel) {
            (Some(of), Some(quantity), None) => {
                of.require(NameKind::BODY, outline, "of", report);
                sensors::check_quantity(quantity, "quantity", outline, report);
            }
            (None, None, Some(channel)) => sensors::check_channel(channel, "channel", outline, report),
            (Some(_), None, None) => {
                report.missing("quantity", "name the quantity to count: `quantity: \"position.x\"`")
            }
            (None, Some(_), None) => report.missing("of", "name the bodies: `of: \"*\"`"),
            (None, None, None) => {
                let help = "write `of: \"ball_*\", quantity: \"position.x\"`, or `channel: \"ball.velocity.x\"`";
                report.error("", "the bodies or the channel to count are missing").help(help);
            }
            (_, _, Some(_)) => {
                let help = "leave out `channel`, or both `of` and `quantity`";
                report.error("", "this histogram counts two things, bodies and a channel").help(help);
            }
        }
    }
}

/// Two finite numbers, the second above the first.
fn check_order(low: Scalar, high: Scalar, paths: (&str, &str), report: &mut Diagnostics) -> bool {
    let finite = report.finite(paths.0, low) & report.finite(paths.1, high);
    if finite && low.si() >= high.si() {
        report.error(paths.1, format!("must be above {}, got {}", exact(low.si()), exact(high.si())));
    }
    finite && low.si() < high.si()
}

impl PlotEntry {
    /// The patterns of the upward channels, each with its path.
    fn upward(&self) -> Vec<(&String, String)> {
        let listed =
            self.channels.iter().flatten().enumerate().map(|(index, name)| (name, format!("channels[{index}]")));
        listed.chain(self.y.iter().flat_map(|names| names.with_paths("y"))).collect()
    }

    /// The names of the upward channels.
    pub fn channels(&self, outline: &Outline) -> Vec<String> {
        self.upward().into_iter().flat_map(|(pattern, _)| sensors::chosen(pattern, outline)).collect()
    }

    /// Reports channels of the axis to the right. They must exist, and belong to the same body as the channels drawn over them.
    fn check_x(&self, x: &str, outline: &Outline, report: &mut Diagnostics) {
        let upward = self.channels(outline);
        if let Some(other) = phase_portrait::over_another(x, upward.iter().map(String::as_str)) {
            let (message, help) = phase_portrait::told(x, other);
            report.error("x", message).help(help);
        } else if !x.contains('*') {
            sensors::check_channel(x, "x", outline, report);
        } else if upward.is_empty() {
            sensors::check_channels(x, "x", outline, report);
        }
        let told = report.problems().len();
        for channel in upward.iter().filter(|_| x.contains('*')) {
            match phase_portrait::beside(x, channel) {
                Some(own) => sensors::check_channel(&own, "x", outline, report),
                None => {
                    report.error("x", format!("{x:?} does not fit the owner of `{channel}`"));
                }
            }
            // The others would say the same.
            if report.problems().len() > told {
                return;
            }
        }
    }

    /// Reports channels that are not there, and what makes no plot.
    pub fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        let given = (self.channels.is_some(), self.x.is_some(), self.y.is_some(), self.histogram.is_some());
        match given {
            (true, false, false, false) | (false, true, true, false) | (false, false, false, true) => (),
            (false, false, false, false) => {
                let help = "add `channels: [\"energy.total\"]`, or `x: \"ball.position.x\", y: \"ball.velocity.x\"`, or \
                            `histogram: (..)`";
                report.error("", "this plot names no channel").help(help);
            }
            (false, true, false, false) => {
                report.missing("y", "name the channel of the vertical axis: `y: \"ball.velocity.x\"`")
            }
            (false, false, true, false) => {
                report.missing("x", "name the channel of the horizontal axis: `x: \"ball.position.x\"`; a plot over time has `channels: [..]`");
            }
            _ => {
                let help =
                    "a plot has `channels` (against time), or `x` and `y`, or `histogram`: write one plot for each";
                report.error("", "this entry is several plots in one").help(help);
            }
        }
        let upward = self.upward();
        if upward.is_empty() && (self.channels.is_some() || self.y.is_some()) {
            let path = if self.channels.is_some() { "channels" } else { "y" };
            report.error(path, "must name at least one channel").help("for example \"energy.total\"");
        }
        for (pattern, path) in upward {
            sensors::check_channels(pattern, &path, outline, report);
        }
        if let Some(x) = &self.x {
            self.check_x(x, outline, report);
        }
        if let Some(histogram) = &self.histogram {
            report.within("histogram", |report| histogram.check(outline, report));
        }
        if let Some((low, high)) = self.range
            && check_order(low, high, ("range[0]", "range[1]"), report)
            && self.log
            && low.si() <= 0.0
        {
            report.error("range[0]", format!("must be above zero if `log` is true, got {}", exact(low.si())));
        }
        if self.log && self.histogram.is_some() {
            report.error("log", "a histogram counts from zero, which `log` cannot show").help("leave out `log`");
        }
        if report.positive_if_given("tail", self.tail) && self.tail.is_some() && self.x.is_none() {
            report.error("tail", "only a phase portrait has a tail").help("leave out `tail`, or plot `x` and `y`");
        }
    }
}

impl Section for PlotsSection {
    const NAME: &'static str = "plots";
    const EXAMPLE: &'static str = "plots: [(title: \"energy\", channels: [\"energy.kinetic\", \"energy.total\"]), \
                                   (histogram: (of: \"*\", quantity: \"position.x\", from: -3, to: 3))]";

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        if self.0.len() > MOST_PLOTS {
            let message = format!("{} plots do not fit beside a film, at most {MOST_PLOTS} do", self.0.len());
            report.error("", message).help("plot several channels together, or use `jostle plot`");
        }
        for (index, plot) in self.0.iter().enumerate() {
            report.within(&format!("[{index}]"), |report| plot.check(outline, report));
        }
    }

    fn install(self, _: &Outline, app: &mut App) {
        app.insert_resource(self);
    }
}
