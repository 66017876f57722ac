//! `jostle new`: writes starting points, a plugin or a scene.

use std::fs::DirBuilder;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use tempfile::TempDir;

use super::Exit;
use super::say::{print_line, say};
use crate::output::{OutputError, write_new};

/// The names in the templates, which new names replace.
const TEMPLATE: [&str; 2] = ["home_spring", "HomeSpring"];
const PLUGIN_FILES: [(&str, &str); 5] = [
    ("src/lib.rs", include_str!("../../assets/templates/plugin/lib.rs")),
    ("src/main.rs", include_str!("../../assets/templates/plugin/main.rs")),
    ("src/tests.rs", include_str!("../../assets/templates/plugin/tests.rs")),
    ("scene.ron", include_str!("../../assets/templates/plugin/scene.ron")),
    ("README.md", include_str!("../../assets/templates/plugin/README.md")),
];
const MANIFEST: &str = include_str!("../../assets/templates/plugin/manifest.txt");
const SCENE: &str = include_str!("../../assets/templates/scene.ron");

/// The command `new`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct New {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand, Debug)]
enum What {
    /// Write a crate NAME/ with a force, its entry in scenes, a sensor, own state, and tests of its law
    #[command(after_help = EXAMPLES)]
    Plugin(NewPlugin),
    /// Write a small scene NAME.ron with comments
    #[command(after_help = EXAMPLES)]
    Scene(NewScene),
}

#[derive(Args, Debug)]
struct NewPlugin {
    /// Small letters, digits and underscores, such as rubber_band. The entry in scenes is then RubberBand
    #[arg(value_name = "NAME")]
    name: String,
    /// Build against this checkout of Jostle. Default: the one that this program was built from
    #[arg(long, value_name = "PATH")]
    jostle: Option<PathBuf>,
}

#[derive(Args, Debug)]
struct NewScene {
    /// Letters, digits, `_` and `-`. The file is NAME.ron
    #[arg(value_name = "NAME")]
    name: String,
}

const EXAMPLES: &str = "\
Examples:
  jostle new scene pendulum                         pendulum.ron; then: jostle render pendulum.ron
  jostle new plugin rubber_band                     the crate rubber_band/; then: cd rubber_band && cargo test
  jostle new plugin rubber_band --jostle ../jostle  the same, built against another checkout

The command writes into the current directory, and overwrites no file.";

impl New {
    pub(super) fn execute(self) -> Exit {
        let written = match self.what {
            What::Plugin(plugin) => plugin.write(),
            What::Scene(scene) => scene.write(),
        };
        match written {
            Ok(line) => print_line(&line),
            Err(message) => {
                say(&format!("error: {message}"));
                Exit::Usage
            }
        }
    }
}

impl NewScene {
    fn write(self) -> Result<String, String> {
        let name = self.name.strip_suffix(".ron").unwrap_or(&self.name);
        let fits = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
        if !name.starts_with(|first: char| first.is_ascii_alphanumeric()) || !name.chars().all(fits) {
            return Err(format!(
                "`{name}` is no name for a scene: take letters, digits, `_` and `-`, such as `pendulum`"
            ));
        }
        let file = format!("{name}.ron");
        create(Path::new(&file), &SCENE.replace("NAME", name))?;
        Ok(format!("{file} is written; next: jostle check {file} --run, and jostle render {file}"))
    }
}

impl NewPlugin {
    fn write(self) -> Result<String, String> {
        let name = &self.name;
        let fits = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
        if !name.starts_with(|first: char| first.is_ascii_lowercase()) || !name.chars().all(fits) {
            let remedy = "take small letters, digits and underscores, such as `rubber_band`";
            return Err(format!("`{name}` is no name for a plugin: {remedy}"));
        }
        if TAKEN.split_whitespace().any(|word| word == name) {
            return Err(format!(
                "`{name}` means something else to Rust or to the plugin's own code: take another name"
            ));
        }
        let checkout = self.jostle.clone().map_or_else(built_from, Ok)?;
        let source = format!("{{ path = {} }}", quoted_path(&checkout)?);
        let own = |text: &str| text.replace(TEMPLATE[0], name).replace(TEMPLATE[1], &in_camel_case(name));
        let folder = Path::new(name);
        // The crate is there as a whole or not at all.
        let made = beside(folder).map_err(|error| refusal(folder, &error))?;
        let path = made.path();
        DirBuilder::new().create(path.join("src")).map_err(|error| refusal(folder, &error))?;
        create(&path.join("Cargo.toml"), &own(MANIFEST).replace("JOSTLE", &source))?;
        for (file, text) in PLUGIN_FILES {
            create(&path.join(file), &own(text))?;
        }
        std::fs::rename(path, folder).map_err(|error| refusal(folder, &error))?;
        // Under its new name it stays.
        let _ = made.keep();
        Ok(format!("{name}/ is written; next: cd {name} && cargo test"))
    }
}

/// Names that a crate cannot have beside the template's dependencies, and Rust's words.
const TAKEN: &str = "\
    abstract alloc as async await become bevy_app bevy_ecs box break const continue core crate do dyn else enum \
    extern false final fn for gen glam if impl in jostle let loop macro match mod move mut override priv \
    proc_macro pub ref return schemars self serde static std struct super test trait true try type typeof unsafe unsized \
    use virtual where while yield";

/// `rubber_band` as `RubberBand`.
fn in_camel_case(name: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters.next().map_or_else(String::new, |first| first.to_ascii_uppercase().to_string() + letters.as_str())
    };
    name.split('_').map(capital).collect()
}

/// The path of a checkout, in the form of the manifest in another folder.
fn quoted_path(path: &Path) -> Result<String, String> {
    let shown = path.display();
    let manifest = std::fs::read_to_string(path.join("Cargo.toml")).unwrap_or_default();
    if !manifest.lines().any(|line| line.trim() == "name = \"jostle\"") {
        return Err(format!("`{shown}` is not a checkout of Jostle: --jostle needs the folder with its Cargo.toml"));
    }
    let seen = Path::new("..").join(path);
    let text = seen.to_str().ok_or_else(|| format!("`{shown}` has letters that Cargo.toml cannot hold"))?;
    // Basic strings of TOML take the escapes of JSON.
    Ok(serde_json::Value::from(text).to_string())
}

/// The checkout that this program was built from.
fn built_from() -> Result<PathBuf, String> {
    let checkout = Path::new(env!("CARGO_MANIFEST_DIR"));
    match checkout.join("Cargo.toml").is_file() {
        true => Ok(checkout.to_owned()),
        false => Err("a plugin needs a checkout of Jostle: name its folder with --jostle PATH".to_owned()),
    }
}

/// A temporary folder, which is removed unless it is kept.
fn beside(folder: &Path) -> std::io::Result<TempDir> {
    if folder.symlink_metadata().is_ok() {
        return Err(ErrorKind::AlreadyExists.into());
    }
    let mut maker = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The system applies the user's mask, as for any new folder.
        maker.permissions(std::fs::Permissions::from_mode(0o777));
    }
    maker.prefix(&format!("{}.", folder.display())).suffix(".part").tempdir_in(".")
}

/// Writes a file that is not there yet.
fn create(path: &Path, text: &str) -> Result<(), String> {
    write_new(path, text).map_err(|error| match error {
        OutputError::Io { cause, .. } => refusal(path, &cause),
        other => other.to_string(),
    })
}

fn refusal(path: &Path, error: &std::io::Error) -> String {
    let shown = path.display();
    match error.kind() {
        ErrorKind::AlreadyExists => {
            format!("`{shown}` exists already, and the command overwrites no file: take another name")
        }
        _ => format!("`{shown}` cannot be written: {error}"),
    }
}
