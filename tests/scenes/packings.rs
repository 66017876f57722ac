//! Bodies from tables beside the scene: the resulting bodies, and the messages for unreadable tables.
//!
//! Tolerance: none; all numbers are exact. Not tested here: the columns one by one, which the unit tests of
//! `src/engine/world/sections/packing` do, and what the scenes of `scenes/benchmarks` do: they are only read.

use std::io::Write;
use std::path::{Path, PathBuf};

use jostle::scene::Source;
use jostle::{Simulation, SimulationExt};

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("packings").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(folder.join("tables")).unwrap();
    folder
}

/// A scene of an entry and what else stands there.
fn scene(folder: &Path, packing: &str, more: &str) -> Source {
    let path = folder.join("main.ron");
    let text = format!(
        "Scene(\n    format: 1,\n    clock: (duration: 1, tick: 0.125),\n    materials: {{ \"felt\": (density: 2) }},\n    packings: [{packing}],\n    {more}\n)"
    );
    std::fs::write(&path, text).unwrap();
    Source::read(&path).unwrap()
}

const TABLE: &str = "x,y,radius,vx,vy\n1,2,0.5,4,0\n8,2,0.25,-1,0\n";

/// Plain and compressed, by itself and among other bodies: names, order, places, masses and motion.
#[test]
fn a_table_becomes_bodies() {
    let folder = folder("good");
    std::fs::write(folder.join("tables/a.csv"), TABLE).unwrap();
    let mut packed =
        flate2::write::GzEncoder::new(std::fs::File::create(folder.join("a.csv.gz")).unwrap(), Default::default());
    packed.write_all(TABLE.as_bytes()).unwrap();
    packed.finish().unwrap();
    let mut hashes = Vec::new();
    for file in ["tables/a.csv", "a.csv.gz"] {
        let entry = format!("(name: \"grain\", file: \"{file}\", material: \"felt\")");
        let more = "bodies: [(name: \"other\", at: (50, 50), atoms: Disc(radius: 0.5))],";
        let mut simulation =
            Simulation::load(&scene(&folder, &entry, more)).unwrap_or_else(|errors| panic!("{errors}"));
        let names: Vec<String> = (0..3).map(|index| simulation.name(index)).collect();
        assert_eq!(names, ["grain_0", "grain_1", "other"]);
        assert_eq!(simulation.bodies().mass[0], 2.0 * std::f64::consts::PI * 0.25);
        simulation.run_to_end().unwrap();
        assert_eq!(simulation.bodies().position[0].to_array(), [5.0, 2.0]);
        assert_eq!(simulation.bodies().position[1].to_array(), [7.0, 2.0]);
        let notes = &simulation.header().remarks;
        assert!(notes.contains(&format!("{file}: a table of 2 discs")), "{notes:?}");
        hashes.push(simulation.card().hash);
    }
    assert_eq!(hashes[0], hashes[1]);
}

/// One disc is one disc.
#[test]
fn a_table_of_one_disc_is_told_so() {
    let folder = folder("one");
    std::fs::write(folder.join("one.csv"), "x,y,radius\n1,2,0.5\n").unwrap();
    std::fs::write(folder.join("clump.csv"), "x,y,radius,body\n1,2,0.5,3\n1,3,0.5,3\n").unwrap();
    for (file, note) in [("one.csv", "a table of 1 disc"), ("clump.csv", "a table of 1 body of 2 atoms")] {
        let entry = format!("(name: \"grain\", file: \"{file}\")");
        let simulation = Simulation::load(&scene(&folder, &entry, "")).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(simulation.header().remarks, [format!("{file}: {note}")]);
    }
}

/// A part in another folder finds its table, its bodies have the part's prefix, and forces of the part choose them.
#[test]
fn a_part_in_another_folder_finds_its_table() {
    let folder = folder("included");
    std::fs::write(folder.join("tables/a.csv"), TABLE).unwrap();
    let part = "Scene(packings: [(name: \"grain\", file: \"a.csv\")], forces: [Drag(linear: 1, of: \"grain_*\")])";
    std::fs::write(folder.join("tables/part.ron"), part).unwrap();
    let main = "Scene(format: 1, clock: (duration: 1), include: [(file: \"tables/part.ron\", prefix: \"p\")])";
    std::fs::write(folder.join("main.ron"), main).unwrap();
    let source = Source::read(&folder.join("main.ron")).unwrap();
    let simulation = Simulation::load(&source).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!([simulation.name(0), simulation.name(1)], ["p/grain_0", "p/grain_1"]);
}

/// `fill` keeps clear of what stands in tables: where discs of 0.5 m stand at (1, 1) and (3, 1) no more than one of 0.4 m
/// has room between the walls of 4 m x 2 m.
#[test]
fn fill_keeps_clear_of_tables() {
    let folder = folder("fill");
    std::fs::write(folder.join("a.csv"), "x,y,radius\n1,1,0.9\n3,1,0.9\n").unwrap();
    let fill = "fill: [(name: \"gas\", atoms: Disc(radius: 0.4), count: 1, within: ((0, 0), (4, 2)))],";
    let errors =
        Simulation::load(&scene(&folder, "(name: \"grain\", file: \"a.csv\")", fill)).err().unwrap().to_string();
    assert!(errors.contains("only 0 of 1 bodies find room"), "{errors}");
}

/// Each mistake is told at the field in the scene, with the line and the column of the table, and a remedy.
#[test]
fn tables_that_are_wrong_are_told_with_line_and_column() {
    let folder = folder("wrong");
    std::fs::write(folder.join("latin.csv"), b"x,y,radius\n1,1,1\n\xe4\n").unwrap();
    std::fs::write(folder.join("plain.csv.gz"), TABLE).unwrap();
    std::fs::write(folder.join("radius.csv"), "x,y,radius\n\n0,0,-1\n").unwrap();
    std::fs::write(folder.join("word.csv"), "x,y,radius\n0,zero,1\n").unwrap();
    std::fs::write(folder.join("column.csv"), "x,y\n0,0\n").unwrap();
    std::fs::write(folder.join("huge.csv"), "x,y,radius\n0,0,1e200\n").unwrap();
    std::fs::write(folder.join("half.csv"), "\"x\",\"y\",\"radius\",\"vx\"\n0,0,1,2\n").unwrap();
    std::fs::write(folder.join("good.csv"), TABLE).unwrap();
    for (file, message, help) in [
        ("none.csv", "there is no file `none.csv`", "the path begins at the folder"),
        ("tables", "`tables` is a folder", "name a table of comma-separated values in it"),
        ("latin.csv", "line 3 of `latin.csv` is no UTF-8 text", "it has to be a table"),
        ("plain.csv.gz", "cannot read `plain.csv.gz`: ", "that it is a table"),
        ("radius.csv", "line 3 of `radius.csv`, column `radius`, must be above zero, got -1", "radius in metres"),
        ("word.csv", "line 2 of `word.csv`, column `y`, is not a number: `zero`", "SI units"),
        ("column.csv", "line 1 of `column.csv`, column `radius`, is missing", "`x,y,radius`"),
        ("half.csv", "line 1 of `half.csv`, column `vy`, is missing, although there is `vx`", "add the column `vy`"),
        ("huge.csv", "grain_0: its mass, place or velocity is infinite", "a zero too many"),
    ] {
        let entry = format!("(name: \"grain\", file: \"{file}\")");
        let errors = Simulation::load(&scene(&folder, &entry, "")).err().unwrap_or_else(|| panic!("{file} is good"));
        let [error] = errors.errors() else { panic!("{errors}") };
        assert!(error.message.contains(message), "{}", error.message);
        assert!(error.help.as_ref().is_some_and(|text| text.contains(help)), "{errors}");
        assert_eq!((error.path.as_str(), error.line), ("packings[0].file", Some(5)), "{errors}");
    }
    let stranger = "(name: \"grain\", file: \"good.csv\", material: \"sand\")";
    let errors = Simulation::load(&scene(&folder, stranger, "")).err().unwrap();
    assert_eq!(errors.errors()[0].path, "packings[0].material");
}

/// The smallest benchmarks can be read. The others differ from them by their tables alone, or take long.
#[test]
fn small_benchmarks_are_good_scenes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/benchmarks");
    for (name, bodies) in [("dense_1k", 1000), ("gas_1k", 1000), ("pyramid", 210), ("few_awake", 10_000)] {
        let source = Source::read(&folder.join(format!("{name}.ron"))).unwrap_or_else(|errors| panic!("{errors}"));
        let simulation = Simulation::load(&source).unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(simulation.bodies().len(), bodies, "{name}");
    }
}
