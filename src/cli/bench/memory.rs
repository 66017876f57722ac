//! The memory of a scene, measured in a separate process that has read no other scene.

use std::process::{Command, Stdio};

use super::Bench;
use crate::cli::Exit;
use crate::cli::author;
use crate::cli::load;
use crate::cli::say::print_line;
use crate::report::bench::resident;
use crate::simulation::Overrides;
use crate::simulation::Simulation;

/// Bytes of another process that reads a scene and runs a round of it. `None` if the system does not provide them.
pub(super) fn of_other_process(bench: &Bench, scene: &str, ticks: u64) -> Option<u64> {
    resident()?;
    let mut command = Command::new(std::env::current_exe().ok()?);
    command.args(["bench", scene, "--memory", "--ticks", &ticks.to_string()]);
    let flags = &bench.overrides;
    let number = |value: Option<f64>| value.map(|value| value.to_string());
    for (flag, value) in [
        ("--duration", number(flags.duration)),
        ("--tick", number(flags.tick)),
        ("--tolerance", number(flags.tolerance)),
        ("--method", flags.method.clone()),
    ] {
        command.args(value.iter().flat_map(|value| [flag, value]));
    }
    for (name, value) in &flags.settings {
        command.arg("--set").arg(format!("{name}={value}"));
    }
    let output = command.stdin(Stdio::null()).stderr(Stdio::null()).output().ok()?;
    std::str::from_utf8(&output.stdout).ok()?.trim().parse().ok()
}

/// A small scene that is run first, so that the program itself is in memory. It is read as far as it is run.
const WARM_UP: (&str, u64) = ("example:tetris", 100);

impl Bench {
    /// Reads and runs a scene, and prints by how many bytes this process has grown meanwhile.
    pub(super) fn print_memory(&self, scene: &str) -> Exit {
        let (example, ticks) = WARM_UP;
        let warm_up = load::source(example)
            .and_then(|source| Simulation::load_with(&source, &Overrides::default(), author::plugin));
        let Ok(mut warm_up) = warm_up else { return Exit::SceneWrong };
        if warm_up.run_to_tick(ticks).is_err() {
            return Exit::RunWrong;
        }
        let before = resident();
        let simulation = self
            .source(scene)
            .and_then(|source| Simulation::load_with(&source, &self.overrides.overrides(), author::plugin));
        let Ok(mut simulation) = simulation else { return Exit::SceneWrong };
        let ticks = self.order().ticks_of(&simulation);
        if simulation.run_to_tick(ticks).is_err() {
            return Exit::RunWrong;
        }
        match before.zip(resident()) {
            Some((before, after)) => print_line(&after.saturating_sub(before).to_string()),
            None => Exit::Usage,
        }
    }
}
