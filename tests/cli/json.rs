//! `--json`: one object for each scene on standard output, with the fields that the scene language promises. Numbers
//! read back to the same bits.

use std::collections::BTreeSet;

use serde_json::Value;

use super::harness::{FALL, Folder};
use jostle::{Simulation, scene::Source};

fn keys(value: &Value) -> BTreeSet<&str> {
    value.as_object().unwrap_or_else(|| panic!("no object: {value}")).keys().map(String::as_str).collect()
}

#[track_caller]
fn has_exactly(value: &Value, names: &str) {
    assert_eq!(keys(value), names.split_whitespace().collect::<BTreeSet<_>>());
}

fn is_pair(value: &Value) -> bool {
    value.as_array().is_some_and(|pair| pair.len() == 2 && pair.iter().all(Value::is_number))
}

#[test]
fn the_result_has_exactly_the_promised_fields() {
    let folder = Folder::new("json").with("fall.ron", FALL);
    for command in [
        "run fall.ron --json",
        "render fall.ron --json",
        "check fall.ron --run --json",
        "run example:tetris --duration 2 --json",
    ] {
        let ended = folder.jostle(command);
        let [result] = &ended.json()[..] else { panic!("{ended:?}") };
        has_exactly(result, "scene time ticks seconds_spent bodies card expect");
        assert!(result["scene"] == "fall.ron" || result["scene"] == "example:tetris");
        assert!(result["ticks"].is_u64() && result["time"].is_f64() && result["seconds_spent"].is_f64());
        for body in result["bodies"].as_array().unwrap() {
            has_exactly(body, "name position angle velocity spin");
            assert!(body["name"].is_string() && is_pair(&body["position"]) && is_pair(&body["velocity"]));
            assert!(body["angle"].is_f64() && body["spin"].is_f64());
        }
        let card = &result["card"];
        has_exactly(
            card,
            "method tick critical_tick events_located energy momentum_residual angular_momentum_residual \
             largest_overlap largest_overlap_share largest_joint_drift largest_travel_share real_time_factor ns_per_atom_tick hash verdict \
             notes error",
        );
        has_exactly(&card["energy"], "kinetic potential elastic friction inelasticity drag work residual");
        has_exactly(&card["largest_overlap"], "meters share_of_radius bodies time");
        has_exactly(&card["largest_overlap_share"], "meters share_of_radius bodies time");
        assert!(card["events_located"].is_u64() && is_pair(&card["momentum_residual"]));
        assert!(card["hash"].as_str().is_some_and(|hash| hash.len() == 16 && u64::from_str_radix(hash, 16).is_ok()));
        assert!(card["notes"].as_array().is_some_and(|notes| notes.iter().all(Value::is_string)));
        let error = &card["error"];
        if !error.is_null() {
            has_exactly(error, "position velocity observed_order horizon");
            has_exactly(&error["position"], "discretisation rounding model");
            has_exactly(&error["velocity"], "discretisation rounding model");
        }
        for outcome in result["expect"].as_array().unwrap() {
            has_exactly(outcome, "text holds measured");
            assert!(outcome["text"].is_string() && outcome["holds"].is_boolean() && outcome["measured"].is_string());
        }
    }
}

/// The shortest text that reads back to the same bits is unique, so equal texts are equal bits.
#[test]
fn numbers_round_trip() {
    let folder = Folder::new("round_trip").with("fall.ron", FALL);
    let ended = folder.jostle("run fall.ron --json").code(0);
    let mut simulation = Simulation::load(&Source::new("fall.ron", FALL)).unwrap();
    simulation.run_to_end().unwrap();
    let (position, velocity) = (simulation.bodies().position[0], simulation.bodies().velocity[0]);
    for (name, x, y) in [("position", position.x, position.y), ("velocity", velocity.x, velocity.y)] {
        let begin = ended.out.find(&format!("\"{name}\":[")).unwrap() + name.len() + 4;
        let pair = &ended.out[begin..begin + ended.out[begin..].find(']').unwrap()];
        let read: Vec<u64> = pair.split(',').map(|number| number.parse::<f64>().unwrap().to_bits()).collect();
        assert_eq!(read, [x.to_bits(), y.to_bits()], "{name}: {pair}");
    }
}

/// Filming is watching: the physics is the same to the last bit.
#[test]
fn run_and_render_tell_the_same() {
    let folder = Folder::new("same");
    let tell = |command: &str| {
        let mut result = folder.jostle(&format!("{command} example:tetris --duration 2 --json")).json().remove(0);
        result["seconds_spent"].take();
        for timing in ["real_time_factor", "ns_per_atom_tick"] {
            result["card"][timing].take();
        }
        result
    };
    let run = tell("run");
    assert_eq!(run, tell("render --size 64x36"));
    assert_eq!(run, tell("render --size 64x36 --fps 7 --threads 1"));
    assert_eq!(run, tell("run -o channels.csv"));
}

#[test]
fn a_wrong_scene_is_one_object_too() {
    let wrong = FALL.replace("radius: 0.1", "radius: -1").replace("duration: 0.2", "duration: 0");
    let folder = Folder::new("json_errors").with("wrong.ron", wrong);
    for command in ["run", "render", "check", "check --run"] {
        let ended =
            folder.jostle(&format!("{command} --json wrong.ron")).code(1).says("must be a finite number above zero");
        let [result] = &ended.json()[..] else { panic!("{ended:?}") };
        has_exactly(result, "scene errors");
        assert_eq!(result["scene"], "wrong.ron");
        let errors = result["errors"].as_array().unwrap();
        let paths: Vec<&Value> = errors.iter().map(|error| &error["path"]).collect();
        assert_eq!(paths, ["clock.duration", "bodies[0].atoms.radius"]);
        for error in errors {
            has_exactly(error, "line column path message help");
            assert!(error["line"].is_u64() && error["column"].is_u64());
        }
    }
}

#[test]
fn each_scene_is_one_line() {
    let folder = Folder::new("json_lines").with("one.ron", FALL).with("two.ron", FALL);
    for command in ["render one.ron none.ron two.ron -o films/ --json", "check one.ron none.ron two.ron --json"] {
        let lines = folder.jostle(command).code(2).json();
        let scenes: Vec<&Value> = lines.iter().map(|line| &line["scene"]).collect();
        assert_eq!(scenes, ["one.ron", "none.ron", "two.ron"]);
        assert_eq!(lines[1]["errors"][0]["message"], "there is no file `none.ron`");
    }
    for command in ["render one.ron -o none/film.gif", "render one.ron --at 9", "run one.ron -o none/table.csv"] {
        let ended = folder.jostle(&format!("{command} --json")).code(2);
        let [result] = &ended.json()[..] else { panic!("{ended:?}") };
        has_exactly(result, "scene errors");
    }
}
