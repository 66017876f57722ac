use super::formatted;
use crate::Source;

#[track_caller]
fn becomes(from: &str, to: &str) {
    let lay = |text: &str| formatted(&Source::new("a.ron", text)).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(lay(from), to);
    assert_eq!(lay(to), to, "a second time");
}

#[test]
fn blanks_indentation_and_commas_are_mended() {
    becomes(
        "#![enable(implicit_some)]\n\n\n// First.\nScene (format:1,clock : ( duration:2 , ),\n\n\n  bodies:[\n  (name:\"a b\",at:(0,1),\n  atoms:List( [\n(at : ( 0,0 ),radius:.1) ,\n   (at:(1,1),radius:2 )] )\n  )\n ])",
        "#![enable(implicit_some)]

// First.
Scene(
    format: 1,
    clock: (duration: 2),

    bodies: [
        (name: \"a b\", at: (0, 1),
         atoms: List([
             (at: (0, 0), radius: .1),
             (at: (1, 1), radius: 2)]),
        ),
    ],
)
",
    );
}

#[test]
fn the_authors_line_breaks_stay() {
    let text = "Scene(
    format: 1,
    clock: (duration: 2, tick: \"1 ms\"), // short

    materials: { \"a\": (friction: 0.5), \"b\": () },
    bodies: [
        (name: \"pegs\", atoms: List([
            (at: (0.6, 4.38), radius: 0.3),
            (at: (1.2, 3.6), radius: 0.3),
        ])),
        (name: \"L\", at: (3, 4), spin: -0.5,
         atoms: Picture(spacing: 0.1, rows: [\"....##\", \"######\"])),
    ],
    pairs: [],

    // Nothing more.
)
";
    let mended = text.replace("    pairs: [],\n", "").replace("    bodies: [\n", "    pairs: [],\n    bodies: [\n");
    becomes(text, &mended);
}

#[test]
fn comments_stay_where_they_are() {
    becomes(
        "Scene( // beside\n// before\nformat: 1 /* in */, // after\nclock: /* odd */ (duration: 1 // last\n),\n  /* two\n     lines */ gravity: (0, // x\n -1),\n)\n// end",
        "Scene( // beside
    // before
    format: 1, /* in */ // after
    clock: /* odd */ (duration: 1, // last
    ),
    /* two
     lines */ gravity: (0, // x
        -1),
)
// end
",
    );
    // Comments beside values keep the author's columns, if there is room.
    let aligned = "Scene(
    params: {
        \"marbles\": 12,          // rows of twenty
        \"turn\": 2,              // rad/s
        \"with a very long name\": 2, // none
    },
)
";
    becomes(aligned, aligned);
}

#[test]
fn sections_stand_in_the_order_of_the_manual() {
    becomes(
        "Scene(\n    // Forces act.\n    gravity: (0, -1), // down\n    storm: 1,\n    clock: (duration: 1),\n    title: \"T\",\n    format: 1\n)",
        "Scene(
    format: 1,
    title: \"T\",
    clock: (duration: 1),
    // Forces act.
    gravity: (0, -1), // down
    storm: 1,
)
",
    );
    // Things keep their order, and no section moves if that would change the made scene.
    let things = "Scene(
    fill: [],
    bodies: [],
    walls: [],
)
";
    becomes(things, things);
    let made = "Scene(
    forces: [Drag(linear: 1)],
    templates: { \"t\": (forces: [Drag(linear: 2)]) },
    instances: [(of: \"t\", name: \"a\")],
)
";
    becomes(made, made);
}

#[test]
fn long_lists_are_broken_and_other_long_lines_are_not() {
    let item = "(name: \"a body with a long name\", at: (0, 0), atoms: Disc(radius: 0.1))";
    becomes(
        &format!("Scene(bodies: [{item}, {item}], notes: \"{}\")", "long ".repeat(40)),
        &format!(
            "Scene(\n    notes: \"{}\",\n    bodies: [\n        {item},\n        {item},\n    ],\n)\n",
            "long ".repeat(40)
        ),
    );
}

#[test]
fn what_is_no_scene_is_laid_out_too() {
    becomes(
        "Theme(ink:\"#fff\",\n palette :[ (name:'c',value:r#\"a\"b\"#),(1,),(1 , 2,) ] )",
        "Theme(ink: \"#fff\",\n    palette: [(name: 'c', value: r#\"a\"b\"#), (1,), (1, 2)])\n",
    );
    let wrong = formatted(&Source::new("a.ron", "Scene(format: 1")).unwrap_err();
    assert!(wrong.to_string().contains("never closed") || wrong.to_string().contains("bracket"), "{wrong}");
}
