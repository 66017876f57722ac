//! The command line for programs with a plugin of their own: each command knows what the plugin registers.

use std::process::ExitCode;
use std::sync::OnceLock;

use bevy_app::App;
use clap::Parser;

use super::CommandLine;

type Plugin = Box<dyn Fn(&mut App) + Send + Sync>;

/// The plugin of this program, set once when it starts.
static PLUGIN: OnceLock<Plugin> = OnceLock::new();

/// The program `jostle` with a plugin: each command reads, runs, draws and explains scenes that name what it registers.
///
/// ```no_run
/// fn main() -> std::process::ExitCode {
///     jostle::cli::main_with(|app| {
///         app.add_systems(jostle::tick::SimTick, || {});
///     })
/// }
/// ```
///
/// # Panics
/// When it is called twice: a process has one command line.
pub fn main_with(plugin: impl Fn(&mut App) + Send + Sync + 'static) -> ExitCode {
    assert!(PLUGIN.set(Box::new(plugin)).is_ok(), "`main_with` is called once");
    CommandLine::parse().execute().into()
}

/// Registers what the program of an author brings; nothing in `jostle` itself.
pub(super) fn plugin(app: &mut App) {
    if let Some(plugin) = PLUGIN.get() {
        plugin(app);
    }
}
