//! The meaning of a channel: its unit, its owner, and the sensor that makes a column of it.

use crate::cli::Exit;
use crate::cli::author;
use crate::cli::flags::OverrideFlags;
use crate::cli::load::Request;
use crate::cli::say::{number, print_line};
use crate::scene::schema::Language;
use crate::scene::{Diagnostics, Mention, Outline, RegisteredName, SceneRegistry, Source, fits};
use crate::sensors::{self, Channels, QUANTITIES};
use crate::simulation::{Overrides, Simulation};
use crate::tick::energy::CHANNELS;

/// Owners of all kinds: a channel that one of them has is one of that kind.
const OWNERS: [(&str, &str); 5] = [
    ("body", "a body"),
    ("wall", "a wall"),
    ("hinge", "a joint"),
    ("slide", "a joint that slides"),
    ("drive", "a controller"),
];

const SCENE: &str = r#"Scene(
    format: 1,
    clock: (duration: 1, tick: "1 ms"),
    contacts: Penalty(),
    walls: [(name: "wall", left: (1, 0), right: (0, 0))],
    bodies: [(name: "body", at: (0, 1), atoms: Disc(radius: 0.1)), (name: "other", at: (1, 1), atoms: Disc(radius: 0.1))],
    joints: [
        Revolute(name: "hinge", a: World, anchor_a: (0, 1), b: "body"),
        Prismatic(name: "slide", a: World, anchor_a: (1, 1), b: "other", axis: (1, 0)),
    ],
    controllers: [Motor(name: "drive", of: "hinge", speed: 1)],
)"#;

/// The text about a channel's name: the whole name, or the quantity alone. `None` if there is no such channel.
pub(super) fn told(what: &str, registry: &SceneRegistry, language: &Language) -> Option<String> {
    let whole = registry.words(CHANNELS);
    if let Some(name) =
        whole.iter().find(|name| **name == what || name.split_once('.').is_some_and(|(_, part)| part == what))
    {
        let mut simulation = owners();
        let channel = simulation.as_mut().and_then(|simulation| sensors::find(simulation.world_mut(), name));
        let unit = channel.map_or_else(String::new, |channel| in_unit(channel.unit));
        return Some(format!("`{name}` is a channel{unit}. {USE}{}", measured(name, None, registry, language)));
    }
    let known = registry.words(QUANTITIES);
    let (owner, quantity) = match what.split_once('.').filter(|(_, quantity)| known.contains(quantity)) {
        Some((owner, quantity)) => (Some(owner), quantity),
        None => (None, known.into_iter().find(|quantity| *quantity == what)?),
    };
    let mut simulation = owners();
    let mut whose: Vec<String> = Vec::new();
    for (name, kind) in OWNERS {
        let channel = simulation
            .as_mut()
            .and_then(|simulation| sensors::find(simulation.world_mut(), &format!("{name}.{quantity}")));
        whose.extend(channel.map(|channel| format!("{kind}{}", in_unit(channel.unit))));
    }
    if whose.is_empty() {
        whose.push("a sensor, by its name".to_owned());
    }
    let name = format!("{}.{quantity}", owner.unwrap_or("NAME"));
    let whose = whose.join(", or of ");
    let measured = measured(quantity, owner, registry, language);
    Some(format!("`{name}` is a channel: `{quantity}` of {whose}. {USE}{measured}"))
}

const USE: &str = "Plots, `expect` and `jostle plot --channels` name it so.";

/// Channels of which a name is only a part, such as `ball.x` or `position`.
pub(super) fn parts(what: &str, registry: &SceneRegistry) -> Option<String> {
    let (owner, part) = what.split_once('.').unwrap_or(("NAME", what));
    let has = |quantity: &&str| quantity.split('.').any(|word| word == part);
    let names: Vec<String> =
        registry.words(QUANTITIES).into_iter().filter(has).map(|quantity| format!("`{owner}.{quantity}`")).collect();
    // Most users ask for a position.
    let first = names.iter().find(|name| name.contains(".position")).or(names.first())?;
    let first = first.trim_matches('`');
    let all = names.join(", ");
    Some(format!(
        "`{what}` is a part of the names of channels: {all}. `jostle explain {first}` tells more of this one."
    ))
}

/// Explains a channel of a scene.
pub(super) fn of_scene(request: Request, flags: &OverrideFlags, name: &str) -> Exit {
    let overrides = Overrides { untried: true, ..flags.overrides() };
    let (_, mut simulation) = match request.load(&flags.settings, &overrides) {
        Ok(loaded) => loaded,
        Err(exit) => return exit,
    };
    let outline = simulation.header().outline.clone();
    let Some(channel) = sensors::find(simulation.world_mut(), name) else {
        let mut report = Diagnostics::new();
        sensors::check_channel(name, "", &outline, &mut report);
        let help = report.problems().first().and_then(|problem| problem.help.clone()).unwrap_or_default();
        return request.refuse(Exit::Usage, "", &format!("there is no channel `{name}`"), &help);
    };
    let value = simulation.value(&channel);
    let value =
        if value.is_nan() { "is not known".to_owned() } else { format!("is {} {}", number(value), channel.unit) };
    let has_column =
        simulation.get_resource::<Channels>().is_some_and(|channels| channels.iter().any(|column| column.name == name));
    let registry = simulation.resource::<SceneRegistry>();
    let (owner, quantity) = name.split_once('.').unwrap_or(("", name));
    let language = Language::of(registry);
    let whole = registry.words(CHANNELS).contains(&name);
    let (owner, quantity) = if whole { (None, name) } else { (Some(owner), quantity) };
    let own = if has_column { own_sensors(quantity, owner, &outline, registry, &language) } else { String::new() };
    let column = match (has_column, own.is_empty()) {
        (false, _) => "No sensor of the scene makes a column of it.",
        (true, true) => "A sensor of the scene makes a column of it.",
        (true, false) => "",
    };
    let measured = if own.is_empty() { measured(quantity, owner, registry, &language) } else { own };
    print_line(&format!(
        "`{name}` is a channel of {}{}. At the start it {}.{}{column}{measured}",
        request.name,
        in_unit(channel.unit),
        value.trim_end(),
        if column.is_empty() { "" } else { " " },
    ))
}

fn owners() -> Option<Simulation> {
    Simulation::load_with(&Source::new("owners.ron", SCENE), &Overrides::default(), author::plugin).ok()
}

fn in_unit(unit: &str) -> String {
    if unit.is_empty() { ", a pure number".to_owned() } else { format!(", in {unit}") }
}

/// The sensors of the scene that make a column of a quantity, as the scene writes them, with their meanings.
fn own_sensors(
    quantity: &str,
    owner: Option<&str>,
    outline: &Outline,
    registry: &SceneRegistry,
    language: &Language,
) -> String {
    let mut text = String::new();
    for (entry, told) in measuring(quantity, registry, language) {
        let of_owner = |mention: &&Mention| {
            // Every second part of the text stands in quotes: its own name, or the names of what it measures.
            let mut quoted = mention.text.split('"').skip(1).step_by(2).peekable();
            mention.name == entry.name
                && owner.is_none_or(|owner| quoted.peek().is_none() || quoted.any(|name| fits(name, owner)))
        };
        let mut mentions = outline.entries("sensors").iter().filter(of_owner).peekable();
        if mentions.peek().is_none() {
            continue;
        }
        for Mention { path, text: written, .. } in mentions {
            let written = written.split_whitespace().collect::<Vec<_>>().join(" ");
            text += &format!("\n`{path}` of the scene makes a column of it: {written}");
        }
        text += &format!("\n{told}");
    }
    text
}

/// The sensors that make a column of a quantity, with an example and what they say.
fn measured(quantity: &str, owner: Option<&str>, registry: &SceneRegistry, language: &Language) -> String {
    let mut text = String::new();
    for (entry, told) in measuring(quantity, registry, language) {
        let example = match (owner, entry.example.split_once("of: \"")) {
            (Some(owner), Some((head, rest))) if !entry.example.contains("name:") => {
                let tail = rest.split_once('"').map_or("", |(_, tail)| tail);
                format!("{head}of: \"{owner}\"{tail}")
            }
            _ => entry.example.to_owned(),
        };
        text += &format!("\nThe sensor `{}` makes a column of it: {example}\n{told}", entry.name);
    }
    text
}

/// The sensors that say of themselves that they measure a quantity, with what they say.
fn measuring(quantity: &str, registry: &SceneRegistry, language: &Language) -> Vec<(RegisteredName, String)> {
    let whole = quantity.contains('.') && registry.words(CHANNELS).contains(&quantity);
    // Sensors that document x measure y too.
    let other = quantity.strip_suffix(".y").map(|stem| format!("{stem}.x"));
    let says = |told: &str, quantity: &str| {
        if whole { told.contains(&format!("`{quantity}`")) } else { told.contains(&format!(".{quantity}`")) }
    };
    let mut found = Vec::new();
    for entry in registry.entries("sensors") {
        let told = language.told("sensors", Some(entry.name)).unwrap_or_default();
        // Behind its own words stand those of its fields.
        let told = told.lines().take_while(|line| !line.starts_with("  ")).collect::<Vec<_>>().join("\n");
        if says(&told, quantity) || other.as_ref().is_some_and(|other| says(&told, other)) {
            found.push((entry, told.trim_end().to_owned()));
        }
    }
    found
}
