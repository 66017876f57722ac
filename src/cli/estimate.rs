//! The flags for the error of a run, and the runs that estimate it.

use std::io::IsTerminal;

use clap::Args;

use super::Exit;
use super::load::Request;
use super::say::say;
use crate::cli::author;
use crate::report::estimate::{self, Effort, EstimateRequest, Repeated};
use crate::scene::Source;
use crate::simulation::{Overrides, Simulation};

/// What is to be estimated of a run.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(super) struct EstimateFlags {
    /// Take the time to estimate the error of the whole run: it is made again with finer steps, two to four times. Otherwise
    /// as much of that as takes 3 % of the run, or about half a second
    #[arg(long, conflicts_with = "no_estimate")]
    estimate: bool,
    /// Do not estimate the error of the run
    #[arg(long)]
    no_estimate: bool,
    /// Estimate the error of finite digits too: three more runs, with wrong last bits
    #[arg(long)]
    rounding: bool,
    /// Estimate too what hard contacts would do otherwise: one more run, with four times the stiffness and half the tick
    #[arg(long)]
    model: bool,
}

impl EstimateFlags {
    fn wanted(self) -> EstimateRequest {
        let effort = match (self.estimate, self.no_estimate) {
            (_, true) => Effort::None,
            (true, false) => Effort::Full,
            (false, false) => Effort::Little,
        };
        EstimateRequest { effort, rounding: self.rounding, model: self.model }
    }

    /// Makes ready for a run that begins.
    pub fn watch(self, simulation: &mut Simulation) {
        estimate::watch(simulation, self.wanted());
    }

    /// Estimates the error of the run, which has ended well.
    pub fn estimate(
        self,
        simulation: &mut Simulation,
        request: Request,
        (source, overrides): (&Source, &Overrides),
    ) -> Result<(), Exit> {
        let load = |overrides: &Overrides| Simulation::load_with(source, overrides, author::plugin);
        let scene = Repeated { overrides, load: &load, tell: Some(tell) };
        estimate::estimate(simulation, self.wanted(), &scene).map_err(|errors| request.refuse_scene(&errors))
    }
}

/// Reports the current run on a terminal.
fn tell(what: &str) {
    if std::io::stderr().is_terminal() {
        say(&format!("estimating the error: {what}"));
    }
}
