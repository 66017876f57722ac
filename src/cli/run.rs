//! `jostle run`: runs a scene, prints its error card, writes its channels.

use std::path::PathBuf;

use clap::Args;

use super::Exit;
use super::progress::Progress;
use super::shared::{self, OverrideFlags};
use crate::output::OutputError;
use crate::output::csv::Table;
use crate::sensors::Channels;
use crate::simulation::Simulation;
use crate::tick::Failure;

/// The command `run`.
#[derive(Args, Debug)]
pub(super) struct Run {
    /// A scene file, or example:NAME
    #[arg(value_name = "SCENE")]
    scene: String,
    /// Write the channels of the scene's sensors here, one row per frame of the film, rounded to whole ticks
    #[arg(short, long, value_name = "channels.csv")]
    output: Option<PathBuf>,
    /// Print the result as JSON on standard output
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    overrides: OverrideFlags,
    /// Threads (a single run uses one so far)
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// No progress bar, and the card only if something is wrong
    #[arg(long)]
    quiet: bool,
}

enum Trouble {
    Run(Failure),
    Output(OutputError),
}

impl Run {
    pub(super) fn execute(self) -> Exit {
        let overrides = match self.overrides.overrides() {
            Ok(overrides) => overrides,
            Err(exit) => return exit,
        };
        let mut simulation = match shared::load(&self.scene, &overrides, self.json) {
            Ok(simulation) => simulation,
            Err(exit) => return exit,
        };
        let trouble = self.go(&mut simulation).err();
        let card = simulation.card();
        let mut exit = match trouble {
            None => Exit::Good,
            Some(Trouble::Run(failure)) => {
                eprintln!("error: the run went wrong: {failure}");
                eprintln!("help: {}", shared::remedy(&card));
                Exit::RunWrong
            }
            Some(Trouble::Output(error)) => shared::usage(&error.to_string()),
        };
        if self.json {
            exit = exit.worse(shared::print_json(&self.scene, &simulation, &card));
        } else if self.quiet {
            exit = exit.worse(shared::print_outcomes(&simulation.outcomes()));
        } else {
            exit = exit.worse(shared::print_card(&self.scene, &simulation, &card));
        }
        exit
    }

    fn go(&self, simulation: &mut Simulation) -> Result<(), Trouble> {
        let progress = Progress::new(simulation.ticks(), "ticks", self.quiet || self.json);
        let Some(path) = &self.output else {
            let batch = (simulation.ticks() / 1000).max(1);
            while simulation.clock().ticks < simulation.ticks() {
                let next = simulation.clock().ticks + batch;
                simulation.run_to_tick(next.min(simulation.ticks())).map_err(Trouble::Run)?;
                progress.at(simulation.clock().ticks);
            }
            return Ok(());
        };
        let none = Channels::default();
        let channels = simulation.world().get_resource::<Channels>().unwrap_or(&none);
        let columns = channels.0.iter().map(|channel| (channel.name.as_str(), channel.unit));
        let mut table = Table::create(path, columns).map_err(Trouble::Output)?;
        let frame = simulation.frame_step() / simulation.clock().dt;
        let every = (frame.round() as u64).max(1);
        // A run that goes wrong keeps the rows so far.
        let run = loop {
            let rows = simulation.world().get_resource::<Channels>().unwrap_or(&none);
            let values = rows.0.iter().map(|channel| (channel.read)(simulation.world()));
            table.row(simulation.clock().time(), values).map_err(Trouble::Output)?;
            let done = simulation.clock().ticks;
            if done == simulation.ticks() {
                break Ok(());
            }
            if let Err(failure) = simulation.run_to_tick((done + every).min(simulation.ticks())) {
                break Err(Trouble::Run(failure));
            }
            progress.at(simulation.clock().ticks);
        };
        table.finish().map_err(Trouble::Output)?;
        run
    }
}
