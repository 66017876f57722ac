//! The flags for the error of a run, and the runs that estimate it.

use std::io::IsTerminal;

use clap::Args;

use super::Exit;
use super::interrupt;
use super::load::Request;
use super::say::say;
use crate::cli::author;
use crate::report::estimate::{self, Effort, EstimateRequest, Repeated};
use crate::scene::Source;
use crate::simulation::{Overrides, Simulation};

/// The errors of a run that a user wants to know.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(super) struct EstimateFlags {
    /// Estimate the error of the whole run: make it again with finer steps, two to four times. Without this flag, the
    /// estimate takes about a second, or a thirtieth of a long run. It may then cover only the beginning
    #[arg(long, conflicts_with = "no_estimate")]
    estimate: bool,
    /// Do not estimate the error of the run
    #[arg(long)]
    no_estimate: bool,
    /// Also estimate the error of finite digits, by three more runs with wrong last bits
    #[arg(long)]
    rounding: bool,
    /// Also estimate the effect of soft contacts, by one more run with four times the stiffness and half the tick
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
        let scene = Repeated { overrides, load: &load, tell: Some(tell), interrupted: Some(interrupt::asked) };
        estimate::estimate(simulation, self.wanted(), &scene).map_err(|errors| request.refuse_scene(&errors))
    }
}

/// Reports the current run on a terminal.
fn tell(what: &str) {
    if std::io::stderr().is_terminal() {
        say(&format!("estimating the error: {what}"));
    }
}
