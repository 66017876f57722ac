//! `jostle check`: reads scenes and says what is wrong with them.

use clap::Args;

use super::Exit;
use super::shared::{self, OverrideFlags};

/// The command `check`.
#[derive(Args, Debug)]
pub(super) struct Check {
    /// Scene files, or example:NAME
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Also run each scene and check what it expects
    #[arg(long)]
    run: bool,
    /// Print mistakes as JSON, one line per scene
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    overrides: OverrideFlags,
}

impl Check {
    pub(super) fn execute(self) -> Exit {
        let overrides = match self.overrides.overrides() {
            Ok(overrides) => overrides,
            Err(exit) => return exit,
        };
        let mut worst = Exit::Good;
        for scene in &self.scenes {
            let exit = match shared::load(scene, &overrides, self.json) {
                Err(exit) => exit,
                Ok(mut simulation) if self.run => match simulation.run_to_end() {
                    Ok(()) => {
                        eprintln!("{scene}");
                        shared::print_outcomes(&simulation.outcomes())
                    }
                    Err(failure) => {
                        eprintln!("{scene}: the run went wrong: {failure}");
                        Exit::RunWrong
                    }
                },
                Ok(simulation) => {
                    let bodies = simulation.bodies();
                    let (bodies, atoms, walls) = (bodies.len(), bodies.atom_count(), bodies.walls.len());
                    if !self.json {
                        shared::print_line(&format!("{scene}: good; {bodies} bodies, {atoms} atoms, {walls} walls"));
                    }
                    Exit::Good
                }
            };
            worst = worst.worse(exit);
        }
        worst
    }
}
