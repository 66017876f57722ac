//! `jostle plot`: channels as a still figure.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::Exit;
use super::destination::{is_directory, takes_no_file};
use super::flags::{self, OverrideFlags};
use super::inputs::Inputs;
use super::load::Request;
use super::progress_bar::Progress;
use super::say::{count as count_of, number, say};
use crate::output;
use crate::raster::{LEAST_FIGURE, Theme, figure};
use crate::record::plot::phase_portrait;
use crate::record::plot::table::{self, Column};
use crate::record::plot::{Axis, Content, Curve, Plot, Sample, common, with_unit};
use crate::record::sections::{PlotEntry, PlotsSection};
use crate::scene::embed::{FileRequest, told};
use crate::scene::values::Names;
use crate::scene::{Diagnostics, fits, suggest};
use crate::sensors::{self, Channels};
use crate::simulation::Simulation;
use crate::simulation::{Missing, Sampler};

/// The command `plot`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct PlotCommand {
    /// A scene file, or example:NAME for a scene that comes with the program. Or a table (.csv, .tsv) with a line of names
    #[arg(value_name = "SCENE|TABLE")]
    source: String,
    /// The picture. Default: <scene or table>.png in the current directory
    #[arg(short, long, value_name = "FIGURE.png")]
    output: Option<PathBuf>,
    /// Plot these channels, separated by commas. `*` stands for any letters of names. Channels of different units get plots of
    /// their own. Default: the plots of the scene, or all columns of the table
    #[arg(long, value_name = "A,B,..", value_delimiter = ',')]
    channels: Vec<String>,
    /// The channel along the horizontal axis, instead of time. `*.position.x` draws each channel over that of its own body
    #[arg(long, value_name = "CHANNEL")]
    x: Option<String>,
    /// Title above the figure
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Size of the picture in pixels. Default: 1200 wide, 720 high for one plot and 480 for each of several
    #[arg(long, value_name = "WxH", value_parser = flags::size, allow_negative_numbers = true)]
    size: Option<(u32, u32)>,
    /// Colours
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Theme::names()))]
    theme: Option<String>,
    /// Make the vertical axis logarithmic: equal factors take equal lengths
    #[arg(long)]
    log: bool,
    #[command(flatten)]
    overrides: OverrideFlags,
    /// Show no progress bar, and messages only if something is wrong
    #[arg(long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle plot example:bounce --channels elastic.position.y   a height against time: bounce.png
  jostle plot my.ron -o plots.png                            the plots that stand in the scene
  jostle plot my.ron --channels 'energy.kinetic,energy.potential,energy.total' --title Energy
  jostle plot my.ron --x ball.position.x --channels ball.velocity.x      a phase portrait
  jostle plot my.ron --x '*.position.x' --channels '*.position.y'        the path of each body
  jostle plot my.ron --channels energy.residual --log --size 1600x900
  jostle plot channels.csv --channels '*.position.y'         a table of `jostle run -o channels.csv`, or of another program";

/// Width of a figure in pixels, and its height for one plot and for each of several.
const WIDTH: u32 = 1200;
const HEIGHT: u32 = 720;
const HEIGHT_OF_SEVERAL: u32 = 480;

/// The table that the command plots.
const TABLE: FileRequest =
    FileRequest { most: 256 << 20, noun: "a table of comma-separated values", smaller: "plot fewer rows or columns" };

/// More plots than one picture holds.
const MOST_PLOTS: usize = 12;

impl PlotCommand {
    pub(super) fn execute(self) -> Exit {
        let request = Request { name: &self.source, json: false, silent: self.quiet };
        let path = self.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.png", request.stem())));
        if let Some(message) = objection(request, &path) {
            return request.usage(&message);
        }
        let is_table =
            ["csv", "tsv"].into_iter().any(|ending| self.source.to_lowercase().ends_with(&format!(".{ending}")));
        let made = if is_table {
            self.of_table(request).map(|plots| (plots, Exit::Good))
        } else {
            self.of_scene(request, &path)
        };
        let (mut plots, exit) = match made {
            Ok(made) => made,
            Err(exit) => return exit,
        };
        if let (Some(title), Some(first)) = (&self.title, plots.first_mut()) {
            first.title.clone_from(title);
        }
        if plots.len() > MOST_PLOTS {
            let count = plots.len();
            return request.usage(&format!(
                "{count} plots do not fit into one picture, at most {MOST_PLOTS} do: choose some with --channels"
            ));
        }
        let count = plots.len() as u32;
        let least = (LEAST_FIGURE.0, count.max(1) * LEAST_FIGURE.1);
        if let Some((width, height)) = self.size.filter(|(width, height)| *width < least.0 || *height < least.1) {
            let plots = count_of(plots.len(), "plot", "plots");
            let message = format!("{width}x{height} is too small for {plots}: their labels would overlap");
            let fewer = if count > 1 { ", or choose fewer channels with --channels" } else { "" };
            let help = format!("the least size is {}x{}{fewer}", least.0, least.1);
            return request.refuse(Exit::Usage, "--size", &message, &help);
        }
        self.tell_what_is_not_shown(&plots);
        let size = self.size.unwrap_or((WIDTH, if count == 1 { HEIGHT } else { count * HEIGHT_OF_SEVERAL }));
        let theme = self.theme.as_deref().or(Theme::names().first().copied()).and_then(Theme::named);
        let theme = theme.expect("a program without a theme fails its tests");
        let drawn = figure(&plots, &theme, size).map_err(output::OutputError::from);
        match drawn.and_then(|picture| output::write_picture(&path, &picture)) {
            Ok(bytes) => {
                if !self.quiet {
                    say(&format!("{}: one picture, {}", path.display(), flags::bytes_in_words(bytes as f64)));
                }
                exit
            }
            Err(error) => request.usage(&error.to_string()),
        }
    }

    /// The plots of a scene, or of channels of it.
    fn of_scene(&self, request: Request, path: &Path) -> Result<(Vec<Plot>, Exit), Exit> {
        let (_, mut simulation) = request.load(&self.overrides.settings, &self.overrides.overrides())?;
        if let Some(message) = Inputs::of(request, &simulation).objection(path) {
            return Err(request.usage(&message));
        }
        let own = simulation.get_resource::<PlotsSection>().map_or_else(Vec::new, |plots| plots.0.clone());
        let entries = if self.channels.is_empty() {
            if self.x.is_some() {
                return Err(
                    request.usage("--x is the horizontal axis alone: name the channels to plot with --channels")
                );
            }
            own.into_iter().map(|entry| PlotEntry { log: entry.log || self.log, ..entry }).collect()
        } else {
            self.entries(request, &mut simulation)?
        };
        if entries.is_empty() {
            let help = match simulation.get_resource::<Channels>() {
                Some(channels) if !channels.is_empty() => {
                    let names: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).take(24).collect();
                    format!("its sensors measure {}", names.join(", "))
                }
                _ => "such as --channels energy.kinetic,energy.total".to_owned(),
            };
            return Err(
                request.usage(&format!("the scene has no `plots`: name the channels to plot with --channels; {help}"))
            );
        }
        let end = simulation.ticks() as f64 * simulation.clock().dt;
        let sampler = Sampler::new(&mut simulation, &entries, 0.0, end);
        let mut sampler = sampler.map_err(|Missing { channel, .. }| {
            let help =
                "walls have `force` and `contacts`, and bodies also have `position`, `velocity`, `angle` and `spin`";
            request.refuse(Exit::Usage, "--channels", &format!("there is no channel {channel:?}"), help)
        })?;
        let progress = Progress::new(simulation.ticks(), "ticks", self.quiet);
        let mut exit = Exit::Good;
        const STEPS: u64 = 200;
        for step in 1..=STEPS {
            if let Err(failure) = sampler.run_to(&mut simulation, end * step as f64 / STEPS as f64) {
                say(&format!("error: {failure}; the figure ends there"));
                exit = Exit::RunWrong;
                break;
            }
            progress.at(simulation.clock().ticks);
        }
        Ok((sampler.finish(exit == Exit::RunWrong), exit))
    }

    /// Plots of the channels named, those of one unit together.
    fn entries(&self, request: Request, simulation: &mut Simulation) -> Result<Vec<PlotEntry>, Exit> {
        let outline = simulation.header().outline.clone();
        // A pattern that nothing fits stays, to be told as the unknown name that it is.
        let expand = |pattern: &String| {
            let found = sensors::expanded(pattern, simulation.world_mut(), &outline);
            if found.is_empty() { vec![pattern.clone()] } else { found }
        };
        let mut named: Vec<String> = Vec::new();
        for name in self.channels.iter().flat_map(expand) {
            if !named.contains(&name) {
                named.push(name);
            }
        }
        let entry = |channels: Vec<String>| match &self.x {
            Some(x) => PlotEntry {
                x: Some(x.clone()),
                y: Some(Names::listed(channels)),
                log: self.log,
                ..PlotEntry::default()
            },
            None => PlotEntry { channels: Some(channels), log: self.log, ..PlotEntry::default() },
        };
        let mut report = Diagnostics::new();
        entry(named.clone()).check(&outline, &mut report);
        if let Some(problem) = report.problems().first() {
            let flag = if problem.path == "x" { "--x" } else { "--channels" };
            let help = problem.help.as_deref().unwrap_or_default();
            return Err(request.refuse(Exit::Usage, flag, &problem.message, help));
        }
        let mut groups: Vec<(&str, Vec<String>)> = Vec::new();
        let found = sensors::find_all(simulation.world_mut(), &named);
        for (name, channel) in named.into_iter().zip(found) {
            let unit = channel.map_or("", |channel| channel.unit);
            match groups.iter_mut().find(|(known, _)| *known == unit) {
                Some((_, names)) => names.push(name),
                None => groups.push((unit, vec![name])),
            }
        }
        Ok(groups.into_iter().map(|(_, names)| entry(names)).collect())
    }

    /// Plots of the columns of a table, those of one unit together.
    fn of_table(&self, request: Request) -> Result<Vec<Plot>, Exit> {
        let name = &self.source;
        let read = TABLE.take(Path::new(name), name, "").map_err(|wrong| request.usage(&told(wrong)))?;
        let text = String::from_utf8(read).map_err(|_| request.usage(&format!("`{name}` is no text in UTF-8")))?;
        let columns = table::read(&text).map_err(|error| request.usage(&format!("`{name}`, {error}")))?;
        let column = |flag: &str, wanted: &str| {
            columns.iter().find(|column| column.name == wanted).ok_or_else(|| {
                let known = suggest::among(wanted, columns.iter().map(|column| column.name.as_str()), "columns", '`');
                request.usage(&format!("{flag}: `{name}` has no column `{wanted}`: {known}"))
            })
        };
        let mut chosen: Vec<&Column> = Vec::new();
        for pattern in &self.channels {
            let fitting: Vec<&Column> = columns.iter().filter(|column| fits(pattern, &column.name)).collect();
            if fitting.is_empty() {
                column("--channels", pattern)?;
            }
            chosen.extend(fitting);
        }
        let x = self.x.as_deref();
        let x = x.or(columns.iter().map(|column| column.name.as_str()).find(|name| *name == "time"));
        let x = x.unwrap_or(&columns[0].name);
        if self.channels.is_empty() {
            chosen.extend(
                columns
                    .iter()
                    .filter(|column| phase_portrait::beside(x, &column.name).is_some_and(|x| x != column.name)),
            );
        }
        if let Some(other) = phase_portrait::over_another(x, chosen.iter().map(|column| column.name.as_str())) {
            let (message, help) = phase_portrait::told(x, other);
            return Err(request.refuse(Exit::Usage, "--x", &message, &help));
        }
        let beside = |of: &&Column| match phase_portrait::beside(x, &of.name) {
            Some(own) => column("--x", &own),
            None => Err(request.usage(&format!("--x: {x:?} does not fit the owner of `{}`", of.name))),
        };
        let across = chosen.iter().map(beside).collect::<Result<Vec<_>, _>>()?;
        if across.first().is_none_or(|x| x.values.is_empty()) {
            return Err(
                request.usage(&format!("`{name}` has nothing to plot: it needs two columns and a row of numbers"))
            );
        }
        let mut told: Vec<&str> = Vec::new();
        for column in across.iter().chain(&chosen).filter(|_| !self.quiet) {
            if told.contains(&column.name.as_str()) {
                continue;
            }
            told.push(&column.name);
            let wild = column.values.iter().filter(|value| !value.is_finite()).count();
            if wild > 0 {
                let all = column.values.len();
                let (name, unit) = (&column.name, &column.unit);
                let what = with_unit(name, unit);
                say(&format!(
                    "note: {what}: {wild} of {all} cells are empty, NaN or infinite, and the figure leaves them out"
                ));
            }
        }
        let mut groups: Vec<(&str, Vec<[&Column; 2]>)> = Vec::new();
        for (x, column) in across.into_iter().zip(chosen) {
            match groups.iter_mut().find(|(unit, _)| *unit == column.unit) {
                Some((_, columns)) => columns.push([x, column]),
                None => groups.push((&column.unit, vec![[x, column]])),
            }
        }
        Ok(groups.into_iter().map(|(unit, columns)| self.plot(unit, &columns)).collect())
    }

    /// One plot of columns, each against the other of its pair.
    fn plot(&self, unit: &str, pairs: &[[&Column; 2]]) -> Plot {
        let named = |index: usize| common(&pairs.iter().map(|pair| pair[index].name.as_str()).collect::<Vec<_>>());
        let ((across, _), (shared, labels)) = (named(0), named(1));
        let first = pairs[0][0];
        let one = pairs.iter().all(|[x, _]| x.name == first.name);
        let curves = pairs.iter().zip(labels).map(|([x, column], label)| {
            let rising = x.values.is_sorted();
            let values = x.values.iter().zip(&column.values).enumerate();
            let sample =
                |(row, (&x, &y)): (usize, (&f64, &f64))| Sample { time: if rising { x } else { row as f64 }, x, y };
            Curve { label, body: None, samples: values.map(sample).collect() }
        });
        let curves: Vec<Curve> = curves.collect();
        let axis = |label: &str, unit: &str, range, logarithmic| Axis {
            label: label.to_owned(),
            unit: unit.to_owned(),
            range,
            logarithmic,
        };
        let ends = first.values.first().copied().zip(first.values.last().copied());
        let span = ends.filter(|(low, high)| one && first.values.is_sorted() && low < high);
        Plot {
            title: shared.clone(),
            across: axis(&across, &first.unit, span, false),
            up: axis(&shared, unit, None, self.log),
            content: if span.is_some() { Content::Times(curves) } else { Content::Phases(curves, None) },
        }
    }

    /// Says how much a logarithmic axis cannot show.
    fn tell_what_is_not_shown(&self, plots: &[Plot]) {
        for plot in plots.iter().filter(|plot| plot.up.logarithmic && !self.quiet) {
            let samples = plot.curves().iter().flat_map(|curve| &curve.samples);
            let (hidden, all) =
                samples.fold((0, 0), |(hidden, all), sample| (hidden + u64::from(sample.y <= 0.0), all + 1));
            if hidden > 0 {
                let share = number((hidden as f64 / f64::from(all) * 1000.0).round() / 10.0);
                let what = with_unit(&plot.title, &plot.up.unit);
                say(&format!("note: {what}: {share} % of the values are not above zero, which --log cannot show"));
            }
        }
    }
}

/// The reason for which a figure cannot be written to a path, if there is one.
fn objection(request: Request, path: &Path) -> Option<String> {
    let name = path.display();
    if is_directory(path) {
        Some(format!("`{name}` is a directory: name a file in it, such as `{}`", path.join("figure.png").display()))
    } else if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("png")) {
        Some(format!("`plot` draws a .png, not `{name}`"))
    } else if request.is_at(path) {
        Some(format!("`{name}` is the table to plot: write the figure to another file"))
    } else {
        takes_no_file(path)
    }
}
