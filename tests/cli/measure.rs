//! `measure`: errors and costs of methods and ticks. Times differ from run to run; everything else does not. Not tested: that times
//! are right.

use super::harness::{FALL, Folder, OVERFLOW};

/// The rows of a table, without its head, as cells. Only the last cell may hold commas.
fn rows(folder: &Folder, name: &str) -> Vec<Vec<String>> {
    let text = String::from_utf8(folder.read(name)).unwrap();
    text.lines().skip(1).map(|line| line.splitn(12, ',').map(str::to_owned).collect()).collect()
}

/// Law: explicit Euler puts a ball that falls from rest for a time `T` at `g T^2/2 - g T dt/2`: the error is `dt/T` of the way,
/// and the velocity has none. Velocity Verlet is exact. Tolerance: what the reference errs by and rounding, below 1e-9 of it.
#[test]
fn table_and_csv_tell_the_error() {
    let folder = Folder::new("measure_table").with("fall.ron", FALL);
    let flags = "--methods ExplicitEuler,VelocityVerlet --rungs 3 --budget 600";
    let ended = folder.jostle(&format!("measure fall.ron {flags} -o fall.csv -o fall.png")).code(0);
    assert_eq!(folder.names(), ["fall.csv", "fall.png", "fall.ron"]);
    for text in [
        "method ",
        "ExplicitEuler",
        "VelocityVerlet *",
        "as many as asked for",
        "Error: the greater",
        "Reference: Dop853",
    ] {
        assert!(ended.out.contains(text), "{text}: {}", ended.out);
    }
    let rows = rows(&folder, "fall.csv");
    let euler: Vec<f64> =
        rows.iter().filter(|row| row[0] == "ExplicitEuler").map(|row| row[4].parse().unwrap()).collect();
    assert_eq!(euler.len(), 3);
    for (error, exact) in euler.into_iter().zip([0.2, 0.1, 0.05]) {
        assert!((error - exact).abs() < 1e-9, "{error} {exact}");
    }
    let verlet: Vec<&Vec<String>> = rows.iter().filter(|row| row[0] == "VelocityVerlet").collect();
    assert_eq!(verlet.len(), 1, "its error is that of the reference, so nothing finer is tried");
    let (error, claimed) = (verlet[0][4].parse::<f64>().unwrap(), verlet[0][5].parse::<f64>().unwrap());
    assert!(error < 1e-12 && claimed > 0.0 && claimed < 1e-9, "{error} {claimed}");
    assert!(ended.out.contains("< "), "nothing below the reference is claimed: {}", ended.out);
}

/// Law: with cost in evaluations the diagram is the same to the byte each time, and so is the table but for its column of seconds.
#[test]
fn only_times_differ_from_run_to_run() {
    let folder = Folder::new("measure_again");
    let measure = |name: &str| {
        let scene = "example:kepler --duration 1 --methods VelocityVerlet,RungeKutta4 --rungs 4 --budget 600";
        folder.jostle(&format!("measure {scene} --cost evaluations -o {name}.csv -o {name}.png")).code(0);
        let mut rows = rows(&folder, &format!("{name}.csv"));
        rows.iter_mut().for_each(|row| row[8].clear());
        (rows, folder.read(&format!("{name}.png")))
    };
    let (first, second) = (measure("first"), measure("second"));
    assert_eq!(first.0, second.0);
    assert!(first.1 == second.1, "the diagrams differ");
    let picture = image::load_from_memory(&first.1).unwrap();
    assert_eq!((picture.width(), picture.height()), (1200, 720));
}

/// Law: the advice is a command that runs, the cheapest among the settings that reach the error, and its error is no larger
/// than what was asked for.
#[test]
fn advice_can_be_run() {
    let folder = Folder::new("measure_json").with("fall.ron", FALL);
    let ended =
        folder.jostle("measure fall.ron --duration 0.1 --rungs 4 --budget 600 --cost evaluations --json").code(0);
    let [json] = &ended.json()[..] else { panic!("one line: {}", ended.out) };
    assert_eq!(
        (&json["scene"], &json["time"], &json["cost"]),
        (&"fall.ron".into(), &0.1.into(), &"evaluations".into())
    );
    assert!(json["norm"].as_str().unwrap().contains("over how far the body goes"));
    assert!(json["reference"]["horizon"].is_null() && json["reference"]["error"].as_f64().unwrap() < 1e-10, "{json}");
    let settings = json["settings"].as_array().unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or_else(|| panic!("{value}"));
    let advice = json["advice"].as_array().unwrap();
    assert_eq!(advice.len(), 3);
    for advice in advice {
        assert_eq!(advice["reached"], true, "{json}");
        let good = settings.iter().filter(|setting| number(&setting["error_claimed"]) <= number(&advice["target"]));
        let least = good.map(|setting| number(&setting["evaluations_per_second"])).fold(f64::INFINITY, f64::min);
        let taken = settings
            .iter()
            .find(|setting| setting["method"] == advice["method"] && setting["tick"] == advice["tick"])
            .expect("a setting of the list");
        assert_eq!(number(&taken["evaluations_per_second"]), least);
        let command = advice["command"].as_str().unwrap();
        assert!(command.starts_with("jostle run fall.ron --duration 0.1 --method "), "{command}");
        folder.jostle(command.strip_prefix("jostle ").unwrap()).code(0);
    }
}

/// A body on a rough floor, with events at the ends of ticks: methods with several stages cannot run it.
const ON_A_FLOOR: &str = r#"Scene(
    format: 1,
    clock: (duration: 0.2, tick: "1 ms", events: PerTick),
    gravity: (0, -9.81),
    materials: { "rough": (stiffness: 1000, friction: 0.3) },
    walls: [(name: "floor", left: (1, 0), right: (0, 0), material: "rough")],
    bodies: [(name: "ball", at: (0, 0.11), velocity: (1, 0), material: "rough", atoms: Disc(radius: 0.1, mass: 1))],
)"#;

#[test]
fn what_cannot_run_stays_in_the_table() {
    let folder = Folder::new("measure_refused").with("floor.ron", ON_A_FLOOR);
    let ended = folder.jostle("measure floor.ron --methods VelocityVerlet,RungeKutta4 --rungs 3 -o floor.csv").code(0);
    assert!(ended.out.contains("refused: ") && ended.out.contains("it cannot run this scene"), "{}", ended.out);
    let rows = rows(&folder, "floor.csv");
    assert!(rows.iter().any(|row| row[0] == "RungeKutta4" && row[3] == "refused"), "{rows:?}");
    assert!(rows.iter().any(|row| row[0] == "VelocityVerlet" && row[3] == "measured"), "{rows:?}");
}

/// Advice is looked for between the ticks of the ladder too, which goes by twos: at the tick whose error should be just the one that
/// is wanted, as errors of the ticks about it tell.
#[test]
fn advice_is_looked_for_between_the_ticks_of_the_ladder() {
    let folder = Folder::new("measure_between");
    let flags = "--methods Dop853,RungeKutta4 --budget 600 --cost evaluations -o table.csv --json";
    let ended = folder.jostle(&format!("measure example:kepler --duration 10 {flags}")).code(0);
    let ticks = |method: &str| -> Vec<f64> {
        let rows = rows(&folder, "table.csv").into_iter().filter(|row| row[0] == method);
        rows.map(|row| row[1].parse().unwrap()).collect()
    };
    let steps = |method: &str| ticks(method).windows(2).map(|pair| pair[0] / pair[1]).collect::<Vec<f64>>();
    let all: Vec<f64> = ["Dop853", "RungeKutta4"].into_iter().flat_map(steps).collect();
    assert!(all.iter().all(|step| *step > 1.0), "from coarse to fine: {all:?}");
    assert!(all.iter().any(|step| *step < 1.9), "{all:?}");
    for advice in ended.json()[0]["advice"].as_array().unwrap() {
        assert!(advice["error_claimed"].as_f64().unwrap() <= advice["target"].as_f64().unwrap(), "{advice}");
    }
}

/// A method that goes from event to event solves a sled on a slope whatever the tick: the advice is a tick far beyond the critical
/// one, and says so. Verlet that sees impacts at ticks begins at about twice its critical tick: longer ones are of no use.
#[test]
fn ticks_beyond_the_critical_one_are_told_where_they_do() {
    let folder = Folder::new("measure_beyond_critical");
    let measure = |scene: &str, method: &str| {
        let flags = format!("--methods {method} --rungs 2 --budget 600 --cost evaluations");
        let ended = folder.jostle(&format!("measure example:{scene} {flags} -o table.csv")).code(0);
        (rows(&folder, "table.csv"), ended.out)
    };
    let ((located, told), (whole, _)) = (measure("incline", "RungeKutta4"), measure("bounce", "VelocityVerlet"));
    let number = |cell: &str| cell.parse::<f64>().unwrap();
    assert!(number(&located[0][1]) > 0.1 && number(&located[0][4]) < 1e-9, "{located:?}");
    assert_eq!(whole.len(), 2);
    assert!(whole[0].last().unwrap().contains("tick beyond the critical one"), "{whole:?}");
    assert!(!whole[1].last().unwrap().contains("tick beyond the critical one"), "{whole:?}");
    let advice = told.lines().find(|line| line.starts_with("Advice: ")).unwrap();
    assert!(
        advice.contains("for an error of 1e-2, 1e-4, 1e-8 RungeKutta4") && advice.contains("beyond the critical one"),
        "{advice}"
    );
}

#[test]
fn what_cannot_be_measured_is_told() {
    let still = FALL.replace("gravity: (0, -9.81),", "");
    assert_ne!(still, FALL);
    let folder = Folder::new("measure_wrong").with("still.ron", still).with("overflow.ron", OVERFLOW);
    folder.jostle("measure still.ron").code(1).says("all bodies rest");
    folder.jostle("measure nowhere.ron").code(2).says("there is no file `nowhere.ron`");
    folder.jostle("measure still.ron -o still.gif").code(2).says("a table to a .csv and a diagram to a .png");
    folder.jostle("measure still.ron -o still.ron").code(2);
    folder
        .jostle("measure still.ron -o nowhere/table.csv")
        .code(2)
        .says("there is no `nowhere`; create its directory first");
    folder.jostle("measure still.ron --methods Auto").code(2).says("VelocityVerlet");
    folder
        .jostle("measure example:tetris --budget 0.01")
        .code(2)
        .says("too short for the reference run")
        .says("--budget");
    // Where the reference itself goes wrong, what was seen of the settings is kept.
    let ended = folder
        .jostle("measure overflow.ron --methods VelocityVerlet,Dop853 --rungs 2 -o over.csv -o over.png")
        .code(3)
        .says("the reference run goes wrong");
    assert!(ended.out.contains("fails at t = "), "{}", ended.out);
    let failed = rows(&folder, "over.csv");
    assert!(!failed.is_empty() && failed.iter().all(|row| row[3] == "failed"), "{failed:?}");
    assert!(folder.has("over.png"));
}

/// What the help shows can be pasted. It is run with one tick for each method.
#[test]
fn examples_of_the_help_can_be_pasted() {
    let folder = Folder::new("measure_help");
    let help = folder.jostle("measure --help").code(0).out;
    let mut seen = 0;
    for example in help.lines().filter_map(|line| line.strip_prefix("  jostle ")) {
        let mut words = example.split("  ").next().unwrap_or(example).to_owned();
        for (flag, value) in [("--rungs", "1"), ("--budget", "600")] {
            if !words.contains(flag) {
                words.push_str(&format!(" {flag} {value}"));
            }
        }
        folder.jostle(&words).code(0);
        seen += 1;
    }
    assert!(seen >= 5, "{help}");
}

/// Elastic discs in a box are chaotic, and keep their energy: what is compared beyond the horizon is the mean speed, which differs by
/// what contacts hold of the energy in the moments that are looked at, and the mean place, which chaos carries about.
#[test]
fn beyond_the_horizon_means_are_compared() {
    let scene = r#"Scene(format: 1, clock: (duration: 30), materials: { "m": (stiffness: 1e5, restitution: 1) },
        walls: [(name: "south", left: (1, 0), right: (0, 0), material: "m"), (name: "north", left: (0, 2), right: (1, 2), material: "m"),
                (name: "west", left: (0, 0), right: (0, 1), material: "m"), (name: "east", left: (2, 1), right: (2, 0), material: "m")],
        bodies: [(name: "a", at: (0.5, 0.5), velocity: (2, 1), material: "m", atoms: Disc(radius: 0.2, mass: 1)),
                 (name: "b", at: (1.3, 0.7), velocity: (-1, 2), material: "m", atoms: Disc(radius: 0.2, mass: 1)),
                 (name: "c", at: (0.7, 1.4), velocity: (1, -2), material: "m", atoms: Disc(radius: 0.2, mass: 1))])"#;
    let folder = Folder::new("measure_beyond").with("box.ron", scene);
    let measured =
        folder.jostle("measure box.ron --json --methods Dop853 --rungs 3 --budget 60").code(0).json().remove(0);
    let reference = &measured["reference"];
    assert!(reference["compared_until"].as_f64().unwrap() < 30.0, "{reference}");
    let scatter = &reference["scatter_beyond"];
    assert!(scatter["speed"].as_f64().unwrap().abs() < 0.1 && scatter["place"].as_f64().unwrap() < 0.5, "{scatter}");
    let told = |setting: &serde_json::Value| setting["note"].as_str().unwrap().contains("beyond: ");
    assert!(
        measured["settings"].as_array().unwrap().iter().filter(|setting| setting["outcome"] == "measured").all(told)
    );
    let told = folder.jostle("measure box.ron --methods Dop853 --rungs 3 --budget 60").code(0).out;
    assert!(told.contains("means over time and all bodies. There,"), "{told}");
}
