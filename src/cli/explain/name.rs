//! The meaning of a name of the scene language, or of a word on the card.

use bevy_app::App;

use super::words::{WORDS, Word};
use super::{channel, flag, language_parts, synonyms};
use crate::cli::Exit;
use crate::cli::list::READER;
use crate::cli::paths::handed_on;
use crate::cli::say::{print_line, say};
use crate::integrate::Methods;
use crate::raster::Theme;
use crate::scene::schema::Language;
use crate::scene::suggest::plural;
use crate::scene::{RegisteredName, SceneRegistry, nearest_name};
use crate::sensors::QUANTITIES;
use crate::tick::TickAppExt;
use crate::tick::energy::CHANNELS;

/// Explains a name; `what` may be written in capitals or not, and in the singular or the plural.
pub(super) fn explain(what: &str) -> Exit {
    let mut app = App::empty();
    app.add_tick();
    crate::plugins::standard(&mut app);
    crate::cli::author::plugin(&mut app);
    let (mut found, names) = look_up(what, &app);
    for other in [plural(what), singular(what)] {
        if found.is_empty() {
            found = look_up(&other, &app).0;
        }
    }
    let registry = app.world().resource::<SceneRegistry>();
    let language = Language::of(registry);
    let parts = language.parts();
    if found.is_empty() {
        found.extend(channel::told(what, registry, &language));
    }
    found.extend(language_parts::told(what, &parts));
    if let Some(name) = synonyms::named(what) {
        found.push(format!("Scenes say `{name}` for {what}."));
        found.extend(look_up(name, &app).0);
        found.extend(language_parts::told(name, &parts));
    }
    if found.is_empty() {
        found.extend(channel::parts(what, registry));
    }
    if found.is_empty() {
        let others = parts.iter().map(|part| part.name.clone()).chain(synonyms::words().map(str::to_owned));
        let names: Vec<String> = names.into_iter().chain(others).collect();
        let near = nearest_name(what, names.iter().map(String::as_str));
        let near = near.map_or_else(String::new, |near| format!("did you mean `{near}`? "));
        say(&format!(
            "error: there is no name `{what}`\nhelp: {near}`jostle list sections`, `jostle list forces` and so on show all \
             names. Flags and words of the error card have explanations too, such as `jostle explain critical tick`"
        ));
        return Exit::Usage;
    }
    print_line(&found.join("\n\n"))
}

fn singular(what: &str) -> String {
    let stem = what.strip_suffix("ies").map(|stem| format!("{stem}y"));
    stem.unwrap_or_else(|| what.strip_suffix('s').unwrap_or(what).to_owned())
}

/// The texts about a name, and all names that exist.
fn look_up(what: &str, app: &App) -> (Vec<String>, Vec<String>) {
    let registry = app.world().resource::<SceneRegistry>();
    let language = Language::of(registry);
    let told = |section: &str, entry: Option<&str>| language.told(section, entry).unwrap_or_default();
    let mut found = Vec::new();
    let mut names: Vec<&str> = Vec::new();
    let same = |name: &str| name.eq_ignore_ascii_case(what);
    for section in registry.sections() {
        names.push(section.name);
        if same(section.name) {
            found.push(format!("{}\n{}", of_section(section, registry), told(section.name, None)));
        }
        for entry in registry.entries(section.name) {
            names.push(entry.name);
            if same(entry.name) {
                found.push(format!("{}\n{}", of_entry(section.name, entry), told(section.name, Some(entry.name))));
            }
        }
    }
    for (name, example) in language.unregistered(registry) {
        names.push(name);
        if same(name) {
            let kind =
                if name == "Repeat" { "stands in place of an item of a list" } else { "is a section of the scene" };
            found.push(format!(
                "`{name}` {kind}. It comes from {READER}.\nFor example: {example}\n{}",
                told(name, None)
            ));
        }
    }
    if let Some((section, field)) = what.split_once('.') {
        let beginning = format!("  {field}: ");
        let fields = told(section, None);
        if let Some(line) = fields.lines().find(|line| line.starts_with(&beginning)) {
            found.push(format!("`{section}.{field}` is a field of the section `{section}`.\n{}", line.trim()));
        }
    }
    if what.contains('.') {
        found.extend(channel::told(what, registry, &language));
    }
    names.extend(Theme::names());
    if let Some(theme) = Theme::names().into_iter().find(|theme| same(theme)) {
        found.push(format!(
            "{theme} is a theme: look: (theme: {theme:?}), or --theme {theme}. `jostle list themes` shows the others"
        ));
    }
    for method in app.world().get_resource::<Methods>().map_or(&[][..], |methods| &methods.0) {
        names.push(method.name);
        if same(method.name) {
            found.push(format!(
                "{} is an integration method of order {}. It is stable while omega dt < {}, with the angular frequency omega \
                 of the stiffest spring.\nFor example: clock: (duration: 10, tick: \"1 ms\", method: {})",
                method.name, method.order, method.stability_limit, method.name
            ));
        }
    }
    for Word { word, meaning } in WORDS {
        names.extend(word.split(", "));
        if word.split(", ").any(same) {
            found.push(format!("{word}: {meaning}"));
        }
    }
    for list in registry.word_lists().into_iter().filter(|list| ![QUANTITIES, CHANNELS].contains(list)) {
        let word = registry.words(list).into_iter().find(|word| same(word));
        if let Some(word) = word.filter(|_| found.is_empty()) {
            found.push(format!("{word} is a {list}. `jostle list` shows the others"));
        }
    }
    let flags = flag::all();
    for flag in flags.iter().filter(|flag| same(&flag.name)) {
        found.push(flag.told());
    }
    let names = names.into_iter().map(str::to_owned);
    (found, names.chain(flags.into_iter().map(|flag| flag.name)).collect())
}

fn of_section(known: RegisteredName, registry: &SceneRegistry) -> String {
    let entries: Vec<&str> = registry.entries(known.name).into_iter().map(|entry| entry.name).collect();
    let kind = if known.takes_entries {
        format!("is a section of the scene that takes entries: {}", entries.join(", "))
    } else {
        "is a section of the scene".to_owned()
    };
    format!("`{}` {kind}. It comes from {}.\nFor example: {}", known.name, handed_on(known.origin), known.example)
}

fn of_entry(section: &str, known: RegisteredName) -> String {
    format!(
        "`{}` is an entry of `{section}`. It comes from {}.\nFor example: {}",
        known.name,
        handed_on(known.origin),
        known.example
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn synonyms_lead_to_names() {
        let mut app = App::empty();
        app.add_tick();
        crate::plugins::standard(&mut app);
        let registry = app.world().resource::<SceneRegistry>();
        let parts = Language::of(registry).parts();
        for name in synonyms::names() {
            assert!(!look_up(name, &app).0.is_empty() || !language_parts::told(name, &parts).is_empty(), "{name}");
        }
    }
}
