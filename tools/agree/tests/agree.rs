//! Law: one scene, one motion. Runs by methods of different kinds differ by no more than their stated errors, for all
//! that the registry lists. Factor three is the promise of estimates, ten is grave.
//!
//! Not tested: what a thousand scenes find, see CONTRIBUTING.md, and packings.

use std::collections::BTreeSet;

use jostle::Simulation;
use jostle::scene::Source;
use jostle::simulation::Overrides;
use jostle_agree::chance::Chance;
use jostle_agree::judge::{GRAVE, Kind, USUAL, judge};
use jostle_agree::language::Language;
use jostle_agree::scene::{LEFT_OUT, MADE, SECTIONS, scene};
use jostle_agree::walk::{Names, Walk, is_left_out, possible};
use jostle_agree::ways::Way;
use jostle_agree::written::Written;

/// The seed of the scenes, and how many there are.
const SEED: u64 = 3;
const SCENES: u64 = 50;
/// The longest run in s, and the evaluations of all forces that it may take: fifty scenes take some seconds.
const LONGEST: f64 = 0.1;
const MOST_EVALUATIONS: u64 = 2_000;
/// Draws of each entry that show all its fields.
const DRAWN: u64 = 300;

/// The promise of estimates: one statement in a hundred is more than three times too small. One in a thousand is more
/// than ten times too small. The verdict trusts none of these. Of so few statements, single ones are allowed.
#[test]
fn fifty_scenes_of_chance_agree_in_all_ways() {
    let language = Language::standard();
    let (mut statements, mut broken, mut long, mut runs) = (Vec::new(), Vec::new(), 0, 0);
    for number in 0..SCENES {
        let drawn = scene(&language, (SEED, number), LONGEST);
        // Each scene runs in the default way and in a third of the others.
        let ways = |index: usize, _: &Way| index == 0 || index as u64 % 3 == number % 3;
        let judged = judge(&drawn.text(), (ways, false), MOST_EVALUATIONS, &mut Chance::new(SEED, number), |_| {});
        runs += judged.runs;
        statements.extend(judged.statements.iter().map(|(_, excess, _)| *excess));
        for find in &judged.finds {
            match find.kind {
                Kind::Long => long += 1,
                Kind::Understated | Kind::Grave | Kind::Fails => {}
                _ => broken.push(format!("{number}: {find}")),
            }
        }
    }
    let many = |least: f64| statements.iter().filter(|excess| **excess > least).count();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    assert!(statements.len() > 50, "{} statements", statements.len());
    assert!(100 * many(USUAL) <= statements.len() + 100, "{} of {}", many(USUAL), statements.len());
    assert!(1000 * many(GRAVE) <= statements.len() + 1000, "{} of {}", many(GRAVE), statements.len());
    assert!(2 * long < runs, "{long} of {runs} runs took too many evaluations");
}

/// An addition to the language takes part without a list of its own. Each section has a place, and each field and
/// choice comes up. The reader accepts a draw of each entry.
#[test]
fn scenes_of_chance_have_all_that_the_registry_lists() {
    let language = Language::standard();
    let sections = language.schema["properties"].as_object().expect("sections").keys();
    for section in sections {
        let known = SECTIONS.contains(&&**section) || MADE.contains(&&**section);
        assert!(known || LEFT_OUT.iter().any(|(name, _)| name == section), "`{section}` has no place in the generator");
    }
    let text = |name: &str| name.to_owned();
    let names = Names {
        bodies: vec![text("one"), text("two"), text("three")],
        walls: Vec::new(),
        materials: vec![text("m"), text("n")],
        joints: vec![text("hip"), text("knee"), text("slide")],
    };
    let mut chance = Chance::new(SEED, 0);
    let mut draw = |section: &str, kind: Option<&str>| {
        let (own_name, duration, drawn) = (text("own"), 1.0, BTreeSet::new());
        let mut walk = Walk { language: &language, chance: &mut chance, names: &names, own_name, duration, drawn };
        let value = match kind {
            Some(kind) => walk.entry(section, kind),
            None => walk.section(section),
        };
        (value, walk.drawn)
    };
    let (mut wanted, mut found) = (BTreeSet::new(), BTreeSet::new());
    for section in SECTIONS {
        let kinds = language.examples.keys().filter_map(|name| name.strip_prefix(&format!("{section}.")));
        let kinds: Vec<&str> = kinds.collect();
        for kind in kinds.iter().copied().map(Some).chain(kinds.is_empty().then_some(None)) {
            let schema = kind.map_or_else(|| language.section(section), |kind| language.kind(section, kind));
            possible(&language, schema, kind.unwrap_or(section), &mut wanted);
            for _ in 0..DRAWN {
                found.append(&mut draw(section, kind).1);
            }
            let Some(kind) = kind else { continue };
            let accepted = (0..DRAWN).any(|_| draw(section, Some(kind)).0.is_some_and(|entry| fits(section, &entry)));
            assert!(accepted, "the reader accepts none of {DRAWN} draws of `{kind}`");
        }
    }
    wanted.retain(|path| !is_left_out(path));
    let missing: Vec<_> = wanted.difference(&found).collect();
    assert!(missing.is_empty(), "never drawn: {missing:?}");
}

/// Whether the reader accepts an entry beside two hinges and a slide.
fn fits(section: &str, entry: &Written) -> bool {
    let joints = "Revolute(name: \"hip\", a: World, b: \"one\"), Revolute(name: \"knee\", a: World, b: \"two\"), \
                  Prismatic(name: \"slide\", a: World, b: \"three\", axis: (1, 0))";
    let more = match section {
        "joints" => format!("joints: [{joints}, {entry}]"),
        "contacts" => format!("contacts: {entry}, joints: [{joints}]"),
        _ => format!("joints: [{joints}], {section}: [{entry}]"),
    };
    let text = format!(
        "Scene(format: 1, clock: (duration: 1), gravity: (0, -9.81), materials: {{ \"m\": (), \"n\": () }}, bodies: [
            (name: \"one\", at: (0, 0), atoms: Disc(radius: 0.1)), (name: \"two\", at: (1, 0), atoms: Disc(radius: 0.1)),
            (name: \"three\", at: (2, 0), atoms: Disc(radius: 0.1))], {more})"
    );
    let untried = Overrides { untried: true, ..Overrides::default() };
    Simulation::load_with(&Source::new("drawn.ron", &text), &untried, |_| {}).is_ok()
}
