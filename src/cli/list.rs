//! `jostle list`: the scenes that come with the program, and everything a scene may name.

use bevy_app::App;
use clap::Args;

use super::say::{count, print_json, print_line, say};
use super::{Exit, examples};
use crate::cli::author;
use crate::cli::paths::handed_on;
use crate::integrate::ClockSection;
use crate::integrate::Methods;
use crate::record::sections::look::LAYERS;
use crate::scene::schema::{Choice, Language};
use crate::scene::suggest::plural;
use crate::scene::{RegisteredName, SceneRegistry, Source, nearest_name};
use crate::simulation::Overrides;
use crate::simulation::Simulation;
use crate::tick::TickAppExt;

/// The command `list`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct List {
    /// One of these: scenes, sections, shapes, atoms, methods, colors, channels, themes. Or a section with entries, such as
    /// forces, sensors or layers
    #[arg(value_name = "WHAT", default_value = SCENES)]
    what: String,
    /// Print only lines that hold this text, in capitals or not
    #[arg(value_name = "FILTER")]
    filter: Option<String>,
    /// Print each entry as one line of JSON on standard output
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle list                   the scenes that come with the program: jostle render example:NAME
  jostle list sections          all sections that a scene may have, with an example
  jostle list forces            the forces, with an example and the module that brings each
  jostle list shapes            the shapes of bodies with sides; `jostle list atoms`: bodies of discs
  jostle list forces drag       the forces with `drag` in their line
  jostle list channels energy   the channels of energy, which sensors measure and plots show

`jostle explain NAME` tells more of one of them.";

const SCENES: &str = "scenes";
const SECTIONS: &str = "sections";
/// The short name of the entries of `look.layers`.
const SHORT_LAYERS: &str = "layers";
/// Lists of what may stand as a value in a body, with the types that read them.
const CHOICES: [(&str, &str); 2] = [("shapes", "Shape"), ("atoms", "Atoms")];
/// The lists of channels: those of the whole scene, and those behind a name.
const CHANNEL_LISTS: [&str; 2] = ["channels", "quantities"];
/// The origin of the sections that are there before any plugin.
pub(super) const READER: &str = "jostle::scene";

/// One line of a list.
struct Item {
    name: String,
    /// A description, or one correct use.
    text: String,
    /// More to be said, on a line of its own.
    more: String,
    /// The module that brings it.
    from: String,
}

impl Item {
    fn word(name: &str, text: String) -> Self {
        Self { name: name.to_owned(), text, more: String::new(), from: String::new() }
    }

    fn of(known: RegisteredName) -> Self {
        let (name, text) = (known.name.to_owned(), known.example.to_owned());
        Self { name, text, more: String::new(), from: handed_on(known.origin) }
    }

    fn choice(choice: Choice) -> Self {
        Self { name: choice.name, text: choice.example, more: choice.meaning, from: String::new() }
    }

    fn holds(&self, text: &str) -> bool {
        [self.name.as_str(), &self.text, &self.more, &self.from].iter().any(|part| part.to_lowercase().contains(text))
    }
}

impl List {
    pub(super) fn execute(self) -> Exit {
        let mut app = App::empty();
        app.add_tick();
        crate::plugins::standard(&mut app);
        author::plugin(&mut app);
        let registry = app.world().resource::<SceneRegistry>();
        let Some(mut items) = self.items(&app, registry) else {
            let all = kinds(registry);
            let near = nearest_name(&self.what, all.iter().map(String::as_str));
            let near = near.map_or_else(String::new, |near| format!("did you mean `{near}`? "));
            say(&format!("error: there is no list `{}`\nhelp: {near}lists: {}", self.what, all.join(", ")));
            return Exit::Usage;
        };
        if let Some(filter) = &self.filter {
            items.retain(|item| item.holds(&filter.to_lowercase()));
            if items.is_empty() {
                say(&format!("note: none of the {} holds `{filter}`", self.what));
            }
        }
        let exit = if self.json { print_items(&items) } else { print(&items) };
        if self.what == SCENES && !self.json && self.filter.is_none() {
            let others: Vec<String> = kinds(registry).into_iter().filter(|kind| kind != SCENES).collect();
            return exit.worse(print_line(&format!(
                "\n{}. To see one: jostle render example:{}\nOther lists: {}",
                count(items.len(), "scene", "scenes"),
                items.first().map_or("NAME", |item| &item.name),
                others.join(", ")
            )));
        }
        if CHANNEL_LISTS.contains(&self.what.as_str()) && !self.json && self.filter.is_none() {
            let others = "`jostle list quantities` shows those of bodies, walls, joints, controllers and sensors, such as \
                          `ball.position.x`. ";
            let others = if self.what == CHANNEL_LISTS[0] { others } else { "" };
            return exit.worse(print_line(&format!(
                "\n{others}`jostle explain CHANNEL` tells the unit of one and the sensor that measures it, and \
                 `jostle explain SCENE CHANNEL` its value at the start."
            )));
        }
        exit
    }

    /// The list that is asked for; none if there is no such list.
    fn items(&self, app: &App, registry: &SceneRegistry) -> Option<Vec<Item>> {
        match self.what.as_str() {
            SCENES => return Some(examples::SCENES.iter().map(|(name, text)| scene(name, text)).collect()),
            SECTIONS => {
                let language = Language::of(registry);
                let own = language.unregistered(registry);
                let own = own.into_iter().map(|(name, example)| Item {
                    name: name.to_owned(),
                    text: example.split_whitespace().collect::<Vec<_>>().join(" "),
                    more: String::new(),
                    from: READER.to_owned(),
                });
                return Some(own.chain(registry.sections().into_iter().map(Item::of)).collect());
            }
            _ => {}
        }
        if let Some((_, definition)) = CHOICES.into_iter().find(|(list, _)| *list == self.what) {
            let choices = Language::of(registry).choices(definition);
            return Some(choices.into_iter().map(Item::choice).collect());
        }
        if self.what == SHORT_LAYERS {
            return Some(registry.entries(LAYERS).into_iter().map(Item::of).collect());
        }
        let mut entries = registry.sections().into_iter().filter(|known| known.takes_entries);
        if let Some(section) = entries.find(|known| known.name == self.what) {
            return Some(registry.entries(section.name).into_iter().map(Item::of).collect());
        }
        let list = registry.word_lists().into_iter().find(|list| self.what == plural(list) || self.what == *list)?;
        let methods = app.world().get_resource::<Methods>();
        let text = |word: &str| match methods.and_then(|methods| methods.named(word)) {
            Some(method) if list == ClockSection::METHODS => {
                format!("order {}, stable up to omega dt = {}", method.order, method.stability_limit)
            }
            _ if list == ClockSection::METHODS => "the engine chooses".to_owned(),
            _ => String::new(),
        };
        Some(registry.words(list).into_iter().map(|word| Item::word(word, text(word))).collect())
    }
}

/// The names of all lists.
fn kinds(registry: &SceneRegistry) -> Vec<String> {
    let sections = registry.sections();
    let entries = sections.iter().filter(|known| known.takes_entries).map(|known| known.name.to_owned());
    let words = registry.word_lists();
    let choices = CHOICES.iter().map(|(list, _)| *list);
    let fixed = [SCENES, SECTIONS, SHORT_LAYERS].into_iter().chain(choices).map(str::to_owned);
    fixed.chain(entries).chain(words.into_iter().map(plural)).collect()
}

/// A scene that comes with the program. That it can be read is tested.
fn scene(name: &str, text: &str) -> Item {
    let simulation = Simulation::load_with(&Source::new(name, text), &Overrides::default(), author::plugin);
    let header = simulation.as_ref().map(Simulation::header).ok();
    let notes = header.and_then(|header| header.notes.clone()).unwrap_or_default();
    // The first sentence fits into a line.
    let more = notes.find(". ").map_or(notes.as_str(), |end| &notes[..=end]).to_owned();
    let title = header.and_then(|header| header.title.clone()).unwrap_or_default();
    Item { name: name.to_owned(), text: title, more, from: String::new() }
}

fn print(items: &[Item]) -> Exit {
    let width = |part: fn(&Item) -> &str| items.iter().map(|item| part(item).chars().count()).max().unwrap_or(0);
    let (names, homes) = (width(|item| &item.name), width(|item| &item.from));
    let line = |item: &Item| {
        let Item { name, text, more, from } = item;
        let home = if homes > 0 { format!("{from:<homes$}  ") } else { String::new() };
        let more = if more.is_empty() { String::new() } else { format!("\n{:names$}  {more}", "") };
        print_line(format!("{name:<names$}  {home}{text}{more}").trim_end())
    };
    items.iter().map(line).fold(Exit::Good, Exit::worse)
}

fn print_items(items: &[Item]) -> Exit {
    let line = |item: &Item| {
        let mut json = serde_json::json!({ "name": item.name, "text": item.text });
        for (key, part) in [("notes", item.more.as_str()), ("from", &item.from)] {
            if !part.is_empty() {
                json[key] = part.into();
            }
        }
        print_json(&json)
    };
    items.iter().map(line).fold(Exit::Good, Exit::worse)
}
