//! The facts that a program gives the command line at its start: the plugin of its author, and its commit.

use std::process::ExitCode;
use std::sync::OnceLock;

use bevy_app::App;

use super::CommandLine;

type Plugin = Box<dyn Fn(&mut App) + Send + Sync>;

/// The plugin of this program, set once when it starts.
static PLUGIN: OnceLock<Plugin> = OnceLock::new();

/// The commit of this program, if it has one.
static COMMIT: OnceLock<String> = OnceLock::new();

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
    CommandLine::read().execute().into()
}

/// Tells the commit that the program is built from, for reports; without it they call the commit unknown.
///
/// # Panics
/// When it is called twice: a program is built from one commit.
pub fn tell_commit(commit: String) {
    assert!(COMMIT.set(commit).is_ok(), "`tell_commit` is called once");
}

/// The commit of the program.
pub(super) fn commit() -> Option<&'static str> {
    COMMIT.get().map(String::as_str)
}

/// Registers the plugin of an author; `jostle` itself has none.
pub(super) fn plugin(app: &mut App) {
    if let Some(plugin) = PLUGIN.get() {
        plugin(app);
    }
}
