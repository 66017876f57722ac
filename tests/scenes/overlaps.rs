//! Overlaps at the start are noted, once, by `check` and by `run`: the number of pairs, the deepest one, and the
//! remedy.
//!
//! Tolerance: none; the numbers of the notes are short ones. The number of pairs of strewn discs is that of a comparison of each
//! with each. Not tested: how long it takes.

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

fn source(sections: &str) -> Source {
    let text = format!("Scene(format: 1, clock: (duration: 0.01, tick: 0.001, method: VelocityVerlet), {sections})");
    Source::new("a.ron", text)
}

fn loaded(sections: &str) -> Simulation {
    Simulation::load(&source(sections)).unwrap_or_else(|errors| panic!("{errors}"))
}

fn notes(sections: &str) -> Vec<String> {
    let mut simulation = loaded(sections);
    let notes: Vec<String> =
        simulation.notes().iter().filter(|note| note.starts_with("at the start")).cloned().collect();
    simulation.run_to_tick(5).unwrap();
    let later = simulation.card().notes.into_iter().filter(|note| note.starts_with("at the start"));
    assert_eq!(later.collect::<Vec<_>>(), notes, "the card says it once");
    notes
}

fn disc(name: &str, x: f64, radius: f64, more: &str) -> String {
    format!("(name: \"{name}\", at: ({x:?}, 0), atoms: Disc(radius: {radius:?}){more}),")
}

#[test]
fn the_deepest_overlap_is_told_with_names_and_remedy() {
    let pair = format!("bodies: [{}{}]", disc("a", 0.0, 1.0, ""), disc("b", 1.25, 0.5, ""));
    assert_eq!(
        notes(&pair),
        [
            "at the start `a` and `b` overlap by 0.25 m, 50 % of the smaller radius. Their compressed contacts push bodies apart, \
             unless a load presses them together. To prevent it, move them apart, make them smaller, or give them `collides: false`"
        ]
    );
    // A clump is one body however many of its atoms overlap, and a wall counts as well.
    let more = "(name: \"clump\", at: (1, 6.5), atoms: Picture(spacing: 2, rows: [\"##\"])),
        (name: \"under\", at: (1, 4.75), atoms: Picture(spacing: 2, rows: [\"##\"]))], walls: [(name: \"wall\", left: (0, 7.25), right: (9, 7.25))]";
    let [note] = &notes(&pair.replace(']', more))[..] else { panic!("one note") };
    let begins = "at the start 3 pairs overlap by more than 5 % of the smaller radius. The deepest are `a` and `b` by 0.25 m (50 %). ";
    assert!(note.starts_with(begins), "{note}");
}

/// Two bars that cross have no corner inside each other, so no contact parts them.
#[test]
fn bars_that_cross_are_told() {
    let bar = |name: &str, angle: &str| {
        format!(
            "(name: \"{name}\", at: (0, 0), angle: \"{angle}\", shape: Capsule(from: (-1, 0), to: (1, 0), radius: 0.1)),"
        )
    };
    let told = notes(&format!("bodies: [{}{}]", bar("a", "40 deg"), bar("b", "-40 deg")));
    let [note] = &told[..] else { panic!("{told:?}") };
    assert!(note.starts_with("at the start `a` and `b` overlap by "), "{note}");
}

#[test]
fn what_may_be_so_is_not_told() {
    for sections in [
        // In touch, and as deep as loads press contacts in.
        format!("bodies: [{}{}]", disc("a", 0.0, 1.0, ""), disc("b", 2.0, 1.0, "")),
        format!("bodies: [{}{}]", disc("a", 0.0, 1.0, ""), disc("b", 1.951, 1.0, "")),
        // What cannot push.
        format!("bodies: [{}{}]", disc("a", 0.0, 1.0, ", fixed: true"), disc("b", 1.0, 1.0, ", fixed: true")),
        format!("bodies: [{}{}]", disc("a", 0.0, 1.0, ", collides: false"), disc("b", 1.0, 1.0, "")),
        format!("contacts: None, bodies: [{}{}]", disc("a", 0.0, 1.0, ""), disc("b", 1.0, 1.0, "")),
    ] {
        assert_eq!(notes(&sections), Vec::<String>::new(), "{sections}");
    }
}

/// Many discs of sizes that differ by a factor of forty, some of them fixed: the pairs are those that comparing each with each finds.
#[test]
fn all_pairs_of_many_are_counted() {
    let fixed = "(name: \"slab\", at: (3, 3), fixed: true, atoms: Disc(radius: 2)),
        (name: \"post\", at: (4, 4), fixed: true, atoms: Disc(radius: 2))";
    let grains = "Repeat(count: (20, 20), grid: (from: (0, 0), step: (0.3, 0.3)), make: (name: \"g_{i}_{j}\", at: (\"x\", \"y\"),
        atoms: Disc(radius: \"0.05 + 0.15 * mod(i * 7 + j * 3, 5) / 4\")))";
    let simulation = loaded(&format!("bodies: [{fixed}, {grains}]"));
    let bodies = simulation.bodies();
    let mut expected = 0;
    for a in 0..bodies.len() {
        for b in a + 1..bodies.len() {
            let (radius, other) = (bodies.atom_radius[a], bodies.atom_radius[b]);
            let overlap = radius + other - bodies.position[a].distance(bodies.position[b]);
            expected += u32::from(overlap > 0.05 * radius.min(other) && (bodies.dynamic[a] || bodies.dynamic[b]));
        }
    }
    assert!(expected > 200, "{expected}");
    let begins = format!("at the start {expected} pairs overlap");
    assert!(simulation.notes().iter().any(|note| note.starts_with(&begins)), "{begins}: {:?}", simulation.notes());
}

/// A heap in one place is refused where its pairs would not fit into memory: more than 2^19, as 1025 discs make.
#[test]
fn a_heap_in_one_place_is_refused_where_it_is_too_large() {
    let heap = |count: u32| {
        format!(
            "bodies: [Repeat(count: {count}, make: (name: \"g_{{i}}\", at: (\"1e-6 * i\", 0), atoms: Disc(radius: 1)))]"
        )
    };
    let simulation = loaded(&heap(1024));
    let begins = format!("at the start {} pairs overlap", 1024 * 1023 / 2);
    assert!(simulation.notes().iter().any(|note| note.starts_with(&begins)), "{:?}", simulation.notes());
    let errors = Simulation::load(&source(&heap(1025))).err().expect("too many").to_string();
    assert!(errors.contains("at the start more than 524288 pairs of atoms overlap"), "{errors}");
}
