//! One plot: axes and names, which do not change, and the curves up to a moment.

use tiny_skia::Pixmap;

use super::axis::{Scale, range_of};
use super::axis_ticks::{self, Ticks};
use super::diagram::Look;
use super::panel_style::{Sizes, Tones};
use super::pen::Align;
use super::stroke::{Area, Point, Sheet};
use crate::raster::canvas::{Canvas, Ink, blend};
use jostle_frames::frame::Rgb;
use jostle_frames::plot::{Bars, Content, Decimator, Plot, Sample, with_unit};

/// A curve in a phase portrait that moves less than this, in pixels, counts as at rest.
const STILL: f32 = 0.4;

/// Pixels beyond this are indistinguishable, and `f32` is still accurate there.
const FAR: f64 = 1e4;

/// Between axes that are nearer than so many lines of text, there is no room to name them.
const LOWEST: f32 = 4.5;

/// A plot with its place in the picture.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Chart {
    title: String,
    /// The text beside the title.
    aside: String,
    across_label: String,
    up_label: String,
    /// The whole of it, and the part between the axes.
    outer: Area,
    inner: Area,
    across: (Scale, Ticks),
    up: (Scale, Ticks),
    rows: Vec<Vec<usize>>,
    traces: Vec<Trace>,
    bars: Option<Bars>,
    upright_grid: bool,
    tail: Option<f64>,
    /// Beside a film the end of each curve has a dot.
    shows_heads: bool,
    sizes: Sizes,
    tones: Tones,
}

/// A curve in pixels.
#[derive(Clone, Debug)]
struct Trace {
    label: String,
    color: Rgb,
    dash: Vec<f32>,
    /// From early to late, with the times.
    points: Vec<(f64, Point)>,
    /// All samples, for the end of the curve.
    samples: Vec<Sample>,
}

/// The labels of the axes of a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::raster) enum Naming {
    /// The unit beside the title, for little room.
    Brief,
    /// Names at both axes.
    Full,
}

impl Chart {
    /// Sets a plot into an area.
    pub(in crate::raster) fn new(plot: &Plot, outer: Area, naming: Naming, sizes: &Sizes, tones: &Tones) -> Chart {
        let (text, small) = (sizes.text, tones.small(sizes));
        let times = matches!(plot.content, Content::Times(_));
        let looks = tones.curves(plot.curves(), sizes.line);
        let traces = plot.curves().iter().zip(looks).map(|(curve, (color, dash))| {
            let (label, samples) = (curve.label.clone(), curve.samples.clone());
            Trace { label, color, dash, points: Vec::new(), samples }
        });
        let traces: Vec<Trace> = traces.collect();
        let turned = naming == Naming::Full || !times;
        // A single curve needs no line in the list of curves if the title or its axis names it.
        let told = turned || plot.curves().first().is_none_or(|curve| curve.label == plot.title);
        let mut rows = if traces.len() > 1 || !told { rows(&traces, outer.width(), sizes, tones) } else { Vec::new() };
        let top = outer.top + 1.35 * sizes.title + 0.7 * text;
        let left_by = |rows: usize, named: bool| {
            let below = rows as f32 * 1.65 * sizes.legend + if named { 3.3 } else { 2.0 } * text;
            outer.bottom - below - top
        };
        // If there is little room, names give way to the curves: first that of the axis, then those below.
        let named = left_by(rows.len(), true) >= LOWEST * text;
        if left_by(rows.len(), named) < LOWEST * text {
            rows.clear();
        }
        let bottom = top + left_by(rows.len(), named).max(text);

        let ups = || plot.curves().iter().flat_map(|curve| curve.samples.iter().map(|sample| sample.y));
        let most_up = ((bottom - top) / (2.4 * text)).clamp(2.0, 6.0) as usize;
        let up_range = match &plot.content {
            Content::Bars(bars) => {
                let most = bars.counts.iter().flat_map(|(_, counts)| &counts[..counts.len() - 1]).max();
                plot.up.range.unwrap_or((0.0, most.copied().unwrap_or(1).max(1) as f64))
            }
            _ => plot.up.range.or_else(|| range_of(ups(), plot.up.logarithmic)).unwrap_or((0.0, 1.0)),
        };
        let up_range = match plot.up.range {
            Some(range) => range,
            None => axis_ticks::widened(up_range.0, up_range.1, most_up, plot.up.logarithmic),
        };
        let mut up_ticks = if plot.up.logarithmic {
            Ticks::logarithmic(up_range.0, up_range.1, most_up)
        } else {
            Ticks::linear(up_range.0, up_range.1, most_up)
        };
        if plot.curves().is_empty() {
            up_ticks.keep_whole_numbers();
        }
        let widest = up_ticks.labels.iter().map(|label| small.width(label)).fold(0.0, f32::max);
        let left = outer.left + if turned { 1.5 * text } else { 0.0 } + widest.max(1.2 * text) + 0.7 * text;
        let inner = Area { left: left.round(), top: top.round(), right: outer.right.round(), bottom: bottom.round() };

        let most_across = (inner.width() / (4.6 * text)).clamp(2.0, 10.0) as usize;
        let asked = plot.across.range;
        let xs = || plot.curves().iter().flat_map(|curve| curve.samples.iter().map(|sample| sample.x));
        let found = || range_of(xs(), plot.across.logarithmic).unwrap_or((0.0, 1.0));
        let across_range = asked.unwrap_or_else(|| {
            let (low, high) = found();
            axis_ticks::widened(low, high, most_across, plot.across.logarithmic)
        });
        let across_ticks = |most: usize| {
            let make = if plot.across.logarithmic { Ticks::logarithmic } else { Ticks::linear };
            make(across_range.0, across_range.1, most)
        };
        // Labels of many digits need more room than most.
        let fits = |ticks: &Ticks| {
            let wide: f32 = ticks.labels.iter().map(|label| small.width(label) + 0.6 * text).sum();
            wide <= inner.width() + text
        };
        let fitting = (1..=most_across).rev().map(across_ticks).find(fits);
        let across_ticks = fitting.unwrap_or_else(|| across_ticks(1));

        let up_unit = axis_ticks::unit(&plot.up.unit, up_ticks.exponent);
        let mut across_label =
            with_unit(&plot.across.label, &axis_ticks::unit(&plot.across.unit, across_ticks.exponent));
        let mut aside = if turned || up_unit.is_empty() { String::new() } else { format!("({up_unit})") };
        if let Content::Bars(bars) = &plot.content
            && let Some(most) = bars.counts.iter().filter_map(|(_, counts)| counts.last()).max()
        {
            aside = outside(*most);
        }
        if !named {
            across_label.clear();
        }
        let up_named = turned && bottom - top >= LOWEST * text;
        let mut chart = Chart {
            title: plot.title.clone(),
            aside,
            across_label,
            up_label: if up_named { with_unit(&plot.up.label, &up_unit) } else { String::new() },
            outer,
            inner,
            across: (Scale::new(across_range, (inner.left, inner.right), plot.across.logarithmic), across_ticks),
            up: (Scale::new(up_range, (inner.bottom, inner.top), plot.up.logarithmic), up_ticks),
            rows,
            traces,
            bars: if let Content::Bars(bars) = &plot.content { Some(bars.clone()) } else { None },
            upright_grid: !times && !plot.curves().is_empty(),
            // A still figure shows the whole way.
            tail: if let (Content::Phases(_, tail), Naming::Brief) = (&plot.content, naming) { *tail } else { None },
            shows_heads: naming == Naming::Brief,
            sizes: *sizes,
            tones: tones.clone(),
        };
        for index in 0..chart.traces.len() {
            let points = chart.points(&chart.traces[index].samples, times);
            chart.traces[index].points = points;
        }
        chart
    }

    /// The same with something said beside the title.
    pub(super) fn with_aside(mut self, text: &str) -> Chart {
        text.clone_into(&mut self.aside);
        self
    }

    /// The same with the given looks of curves.
    pub(super) fn with_looks(mut self, looks: &[Look]) -> Chart {
        for (trace, look) in self.traces.iter_mut().zip(looks) {
            (trace.color, trace.dash) = self.tones.look(*look, self.sizes.line);
        }
        self
    }

    /// The part between the axes.
    pub(super) fn inner(&self) -> &Area {
        &self.inner
    }

    /// The pixel of a pair of values.
    pub(super) fn spot(&self, x: f64, y: f64) -> Point {
        self.place(&Sample { time: 0.0, x, y })
    }

    /// The colour of a curve.
    pub(super) fn color(&self, curve: usize) -> Rgb {
        self.traces.get(curve).map_or(self.tones.ink, |trace| trace.color)
    }

    fn place(&self, sample: &Sample) -> Point {
        let pixel = |value: f64| if value.is_finite() { value.clamp(-FAR, FAR) as f32 } else { f32::NAN };
        (pixel(self.across.0.place(sample.x)), pixel(self.up.0.place(sample.y)))
    }

    /// The samples that a picture can resolve, in pixels. Against time they are up to four in each column of pixels.
    fn points(&self, samples: &[Sample], times: bool) -> Vec<(f64, Point)> {
        if times {
            let mut decimator = Decimator::default();
            samples.iter().for_each(|sample| decimator.push(self.across.0.place(sample.x) as i64, *sample));
            return decimator.finish().iter().map(|sample| (sample.time, self.place(sample))).collect();
        }
        let mut points: Vec<(f64, Point)> = Vec::new();
        for sample in samples {
            let (x, y) = self.place(sample);
            let still = points.last().is_some_and(|(_, last)| (last.0 - x).abs() + (last.1 - y).abs() < STILL);
            if !still {
                points.push((sample.time, (x, y)));
            }
        }
        points
    }

    /// Draws the constant parts.
    pub(in crate::raster) fn draw_furniture(&self, picture: &mut Pixmap) {
        let (sizes, tones) = (&self.sizes, &self.tones);
        let (small, heading, label) = (tones.small(sizes), tones.title(sizes), tones.label(sizes));
        let baseline = self.outer.top + 0.8 * sizes.title;
        let aside = small.width(&self.aside) + 0.5 * sizes.title;
        let title = heading.shortened(&self.title, self.outer.width() - aside);
        heading.write(picture, &title, (self.outer.left, baseline), Align::Left);
        if self.bars.is_none() {
            self.write_aside(picture, &self.aside);
        }

        self.draw_grid(picture);
        let right = self.inner.left - 0.7 * sizes.text;
        for (value, text) in self.up.1.values.iter().zip(&self.up.1.labels) {
            let y = self.up.0.place(*value) as f32 + 0.36 * sizes.text;
            small.write(picture, text, (right, y), Align::Right);
        }
        let below = self.inner.bottom + 1.5 * sizes.text;
        for (value, text) in self.across.1.values.iter().zip(&self.across.1.labels) {
            small.write(picture, text, (self.across.0.place(*value) as f32, below), Align::Middle);
        }
        let middle = 0.5 * (self.inner.left + self.inner.right);
        let named = small.shortened(&self.across_label, self.outer.width());
        let middle = middle.min(self.outer.right - 0.5 * small.width(&named));
        small.write(picture, &named, (middle, below + 1.3 * sizes.text), Align::Middle);
        let upwards = small.shortened(&self.up_label, self.inner.height());
        let middle = 0.5 * (self.inner.top + self.inner.bottom);
        small.write_upwards(picture, &upwards, (self.outer.left + 0.9 * sizes.text, middle), Align::Middle);

        let mut sheet = Sheet::default();
        let first = self.outer.bottom - (self.rows.len() as f32 - 0.5) * 1.65 * sizes.legend;
        for (number, row) in self.rows.iter().enumerate() {
            let middle = first + number as f32 * 1.65 * sizes.legend;
            let mut pen = self.outer.left;
            for trace in row.iter().map(|index| &self.traces[*index]) {
                let sample = sample_width(sizes);
                sheet.begin(&Area {
                    left: pen - 3.0,
                    top: middle - 9.0,
                    right: pen + sample + 3.0,
                    bottom: middle + 9.0,
                });
                let width = 1.35 * sizes.line;
                let inset = 0.5 * width;
                sheet.line(&[(pen + inset, middle), (pen + sample - inset, middle)], width, &trace.dash, &[]);
                sheet.put(&mut Canvas::new(picture), trace.color);
                pen += sample + 0.5 * sizes.legend;
                let text = label.shortened(&trace.label, self.outer.right - pen);
                pen +=
                    label.write(picture, &text, (pen, middle + 0.36 * sizes.legend), Align::Left) + 1.3 * sizes.legend;
            }
        }
    }

    /// Writes beside the title, where room is kept for the longest that is said there.
    fn write_aside(&self, picture: &mut Pixmap, text: &str) {
        let (sizes, heading, small) = (&self.sizes, self.tones.title(&self.sizes), self.tones.small(&self.sizes));
        let kept = small.width(&self.aside) + 0.5 * sizes.title;
        let title = heading.shortened(&self.title, self.outer.width() - kept);
        let left = self.outer.left + heading.width(&title) + 0.4 * sizes.title;
        small.write(picture, text, (left, self.outer.top + 0.8 * sizes.title), Align::Left);
    }

    fn draw_grid(&self, picture: &mut Pixmap) {
        let Area { left, top, right, bottom } = self.inner;
        let thick = self.sizes.hair;
        let mut lines: Vec<(Area, Rgb)> = Vec::new();
        let zero = |value: f64| value == 0.0;
        let color = |value: f64| if zero(value) { self.tones.axis } else { self.tones.grid };
        if self.upright_grid {
            for value in &self.across.1.values {
                let x = self.across.0.place(*value) as f32;
                lines.push((Area { left: x, top, right: x + thick, bottom: bottom + thick }, color(*value)));
            }
        }
        for value in &self.up.1.values {
            let y = self.up.0.place(*value) as f32;
            lines.push((Area { left, top: y, right: right + thick, bottom: y + thick }, color(*value)));
        }
        lines.sort_by_key(|(_, color)| *color == self.tones.axis);
        let mut canvas = Canvas::new(picture);
        for (area, color) in lines {
            area.fill(&mut canvas, color);
        }
    }

    /// Draws the measurements up to a time (s).
    pub(in crate::raster) fn draw_until(&self, picture: &mut Pixmap, time: f64, tools: &mut Tools) {
        let now = self.bars.as_ref().and_then(|bars| bars.at(time).last());
        if let Some(count) = now.filter(|count| **count > 0) {
            self.write_aside(picture, &outside(*count));
        }
        let mut canvas = Canvas::new(picture);
        if let Some(bars) = &self.bars {
            self.draw_bars(bars.at(time), &mut canvas);
        }
        let Area { left, top, right, bottom } = self.inner;
        let reach = self.sizes.line + 1.0;
        let sheet = Area { left: left - reach, top: top - reach, right: right + reach, bottom: bottom + reach };
        let mut heads: Vec<(Point, Rgb)> = Vec::new();
        for trace in &self.traces {
            self.gather(trace, time, tools);
            let Some(head) = tools.points.last().copied() else { continue };
            tools.sheet.begin(&sheet);
            tools.sheet.line(&tools.points, self.sizes.line, &trace.dash, &tools.weights);
            tools.sheet.put(&mut canvas, trace.color);
            for (x, y) in lonely(&tools.points).filter(|_| !self.shows_heads) {
                canvas.disc(x, y, self.sizes.dot, &Ink::plain(trace.color));
            }
            if self.shows_heads
                && (left - 1.0..=right + 1.0).contains(&head.0)
                && (top - 1.0..=bottom + 1.0).contains(&head.1)
            {
                heads.push((head, trace.color));
            }
        }
        for (head, radius, color) in nested(&heads, self.sizes.dot) {
            let (x, y) = (head.0.round() + 0.5, head.1.round() + 0.5);
            // Only from another dot: a curve is not cut by its own.
            let close = |other: &&(Point, Rgb)| {
                (other.0.0 - head.0).hypot(other.0.1 - head.1) < 2.0 * self.sizes.dot + self.sizes.hair
            };
            if heads.iter().filter(close).count() > 1 {
                canvas.disc(x, y, radius + self.sizes.hair, &Ink::plain(self.tones.card));
            }
            canvas.disc(x, y, radius, &Ink::plain(color));
        }
    }

    /// The curve up to a time: its points and their weights. Its last point is its last sample, however near the one
    /// before.
    fn gather(&self, trace: &Trace, time: f64, tools: &mut Tools) {
        let seen = trace.points.partition_point(|(at, _)| *at <= time);
        let first = self.tail.map_or(0, |tail| trace.points.partition_point(|(at, _)| *at < time - tail));
        let points = &trace.points[first.min(seen)..seen];
        tools.points.clear();
        tools.points.extend(points.iter().map(|(_, point)| *point));
        let last = trace.samples.partition_point(|sample| sample.time <= time);
        tools.points.extend(last.checked_sub(1).map(|last| self.place(&trace.samples[last])));
        tools.weights.clear();
        if let Some(tail) = self.tail {
            let age = |at: f64| (1.0 - (time - at) / tail).clamp(0.0, 1.0) as f32;
            tools.weights.extend(points.iter().map(|(at, _)| age(*at)));
        }
    }

    fn draw_bars(&self, counts: &[u64], canvas: &mut Canvas) {
        let Some((_, counts)) = counts.split_last() else { return };
        let (color, _) = self.tones.curve(1, "", 1.0);
        let width = self.inner.width() / counts.len().max(1) as f32;
        let gap = if width >= 4.0 * self.sizes.hair { self.sizes.hair } else { 0.0 };
        for (bin, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let left = self.inner.left + bin as f32 * width;
            let top = (self.up.0.place(*count as f64) as f32).max(self.inner.top);
            let area = Area {
                left: left.round() + gap,
                top: top.ceil(),
                right: (left + width).round(),
                bottom: self.inner.bottom,
            };
            area.fill(canvas, color);
            // The row that a bar reaches into.
            let share = top.ceil() - top;
            if share > 0.0 && top >= 1.0 && (top as usize) < canvas.height() {
                let row = canvas.row(top as usize);
                for pixel in row.chunks_exact_mut(4).take(area.right as usize).skip(area.left as usize) {
                    blend(pixel, color, share);
                }
            }
        }
    }
}

/// Buffers of drawing from frame to frame, to spare allocations.
#[derive(Clone, Debug, Default)]
pub(in crate::raster) struct Tools {
    sheet: Sheet,
    points: Vec<Point>,
    weights: Vec<f32>,
}

/// Points without a neighbour, of which no line would be seen.
fn lonely(points: &[Point]) -> impl Iterator<Item = Point> {
    let is_point = |point: &Point| point.0.is_finite() && point.1.is_finite();
    // The last point may occur twice, because it is also the last sample.
    let other = move |a: &Point, b: Option<&Point>| b.is_some_and(|b| is_point(b) && a != b);
    let alone = move |index: &usize| {
        let point = &points[*index];
        let before = index.checked_sub(1).and_then(|before| points.get(before));
        is_point(point) && !other(point, before) && !other(point, points.get(index + 1))
    };
    (0..points.len()).filter(alone).map(|index| points[index])
}

/// The text beside the title of a histogram.
fn outside(count: u64) -> String {
    if count > 0 { format!("({count} outside)") } else { String::new() }
}

fn sample_width(sizes: &Sizes) -> f32 {
    1.7 * sizes.legend
}

/// Most rows of names below a chart.
const MOST_ROWS: usize = 4;

/// The curves in rows that fit a width.
fn rows(traces: &[Trace], width: f32, sizes: &Sizes, tones: &Tones) -> Vec<Vec<usize>> {
    let label = tones.label(sizes);
    let mut rows: Vec<Vec<usize>> = Vec::new();
    let mut used = f32::INFINITY;
    for (index, trace) in traces.iter().enumerate() {
        let own = sample_width(sizes) + 0.5 * sizes.legend + label.width(&trace.label);
        match rows.last_mut() {
            Some(row) if used + 1.3 * sizes.legend + own <= width => {
                used += 1.3 * sizes.legend + own;
                row.push(index);
            }
            _ => {
                rows.push(vec![index]);
                used = own;
            }
        }
    }
    rows.truncate(MOST_ROWS);
    rows
}

/// Discs at the heads of curves, back to front, with their radii. If heads meet, those behind are larger, so that each
/// shows a ring.
fn nested(heads: &[(Point, Rgb)], radius: f32) -> Vec<(Point, f32, Rgb)> {
    const RING: f32 = 0.75;
    let near = |a: Point, b: Point| {
        let (dx, dy) = (a.0 - b.0, a.1 - b.1);
        (1.0 - (dx * dx + dy * dy).sqrt() / (2.0 * radius)).max(0.0)
    };
    let grown = |index: usize| {
        let (head, color) = heads[index];
        let behind: f32 = heads[index + 1..].iter().map(|(other, _)| near(head, *other)).sum();
        (head, radius * (1.0 + RING * behind), color)
    };
    (0..heads.len()).map(grown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::Theme;
    use jostle_frames::plot::{Axis, Curve};

    const AREA: Area = Area { left: 20.0, top: 10.0, right: 320.0, bottom: 260.0 };

    fn chart(samples: Vec<Sample>, phases: bool) -> Chart {
        let curves = vec![Curve { label: "height".into(), body: None, samples }];
        let axis = |range| Axis { range: Some(range), ..Axis::default() };
        let content = if phases { Content::Phases(curves, None) } else { Content::Times(curves) };
        let plot = Plot { title: "height".into(), across: axis((0.0, 10.0)), up: axis((-2.0, 2.0)), content };
        let theme = Theme::named("paper").expect("shipped");
        Chart::new(&plot, AREA, Naming::Brief, &Sizes::new(1.0), &Tones::new(&theme))
    }

    fn wave(count: u32) -> Vec<Sample> {
        let sample = |index: u32| {
            let time = f64::from(index) * 10.0 / f64::from(count);
            Sample { time, x: time, y: 2.0 * libm::sin(time * 1.7) }
        };
        (0..=count).map(sample).collect()
    }

    fn drawn(chart: &Chart, time: f64) -> Vec<u8> {
        let mut picture = Pixmap::new(340, 280).expect("small");
        chart.draw_until(&mut picture, time, &mut Tools::default());
        picture.take()
    }

    /// Exact: the corners of the ranges lie in the corners of the axes.
    #[test]
    fn samples_stand_where_the_axes_say() {
        let chart = chart(wave(10), false);
        let place = |x, y| chart.place(&Sample { time: x, x, y });
        let Area { left, top, right, bottom } = chart.inner;
        assert!(left > AREA.left && top > AREA.top && right <= AREA.right && bottom < AREA.bottom);
        assert_eq!(place(0.0, -2.0), (left, bottom));
        assert_eq!(place(10.0, 2.0), (right, top));
        assert_eq!(place(5.0, 0.0), (0.5 * (left + right), 0.5 * (top + bottom)));
        assert!(place(5.0, f64::NAN).1.is_nan());
    }

    /// Law: at a time the curve has all samples until then and none after. They are farther apart than a pixel here, so none
    /// is left out as invisible.
    #[test]
    fn a_curve_has_all_samples_until_now_and_none_of_later() {
        let samples = wave(100);
        for phases in [false, true] {
            let chart = chart(samples.clone(), phases);
            let mut tools = Tools::default();
            for time in [-1.0, 0.0, 0.05, 3.3, 3.35, 9.99, 10.0, 1e300] {
                chart.gather(&chart.traces[0], time, &mut tools);
                let until = samples.iter().filter(|sample| sample.time <= time);
                let expected: Vec<Point> = until.map(|sample| chart.place(sample)).collect();
                let mut found = tools.points.clone();
                found.dedup();
                assert_eq!(found, expected, "{time}");
            }
        }
    }

    /// Law: the number outside is that of the moment. Without values outside, a histogram looks as if there had never
    /// been any. Another number gives another picture.
    #[test]
    fn what_lies_outside_is_counted_at_the_moment() {
        let histogram = |outside: [u64; 3]| {
            let counts = (0..3).map(|index| (index as f64, vec![1, 2, outside[index]])).collect();
            let plot = Plot {
                title: "x".into(),
                across: Axis { range: Some((0.0, 1.0)), ..Axis::default() },
                up: Axis::default(),
                content: Content::Bars(Bars { counts }),
            };
            let theme = Theme::named("paper").expect("shipped");
            Chart::new(&plot, AREA, Naming::Brief, &Sizes::new(1.0), &Tones::new(&theme))
        };
        let (some, none, other) = (histogram([0, 3, 0]), histogram([0, 0, 0]), histogram([0, 4, 0]));
        for (time, shows) in [(0.5, false), (1.0, true), (1.9, true), (2.0, false)] {
            assert_eq!(drawn(&some, time) != drawn(&none, time), shows, "{time}");
            assert_eq!(drawn(&some, time) != drawn(&other, time), shows, "{time}");
        }
    }

    /// Later samples do not change the picture.
    #[test]
    fn the_future_does_not_show() {
        let (one, mut other) = (wave(5000), wave(5000));
        other.iter_mut().filter(|sample| sample.time > 4.0).for_each(|sample| sample.y = -sample.y);
        let (one, other) = (chart(one, false), chart(other, false));
        // The last column of pixels before the change begins at 3.96 s at the latest.
        for time in [0.5, 2.0, 3.95] {
            assert!(drawn(&one, time) == drawn(&other, time), "{time}");
        }
        assert!(drawn(&one, 6.0) != drawn(&other, 6.0));
    }

    /// Law: a value with gaps at both sides is visible as a dot, and only such a value.
    #[test]
    fn a_value_alone_is_a_dot() {
        let (gap, a, b) = ((f32::NAN, 1.0), (1.0, 1.0), (2.0, 1.0));
        for (points, expected) in [
            (&[a, a][..], &[a, a][..]),
            (&[a], &[a]),
            (&[a, b], &[]),
            (&[gap, a, gap], &[a]),
            (&[a, b, gap, b], &[b]),
            (&[gap], &[]),
        ] {
            assert_eq!(lonely(points).collect::<Vec<_>>(), expected);
        }
    }

    /// Dots at one place show a ring each, from back to front.
    #[test]
    fn dots_do_not_hide_one_another() {
        let at = |y| ((50.0, y), Rgb(y as u8, 0, 0));
        let radii: Vec<f32> = nested(&[at(10.0), at(10.0), at(10.0), at(60.0)], 4.0).iter().map(|dot| dot.1).collect();
        assert!(radii[0] > radii[1] + 2.0 && radii[1] > radii[2] + 2.0);
        assert_eq!(radii[2..], [4.0, 4.0]);
    }
}
