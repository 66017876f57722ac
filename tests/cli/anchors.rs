//! `check` tells where anchors are in the world.

use super::harness::{FALL, Folder};

/// A clump of 1 kg at its origin and 3 kg at (0.4, 0), turned by 90 degrees: its anchor (0.4, 0) is 0.4 m above the origin.
#[test]
fn check_tells_where_anchors_are_at_the_start() {
    let scene = "Scene(format: 1, clock: (duration: 1, tick: 0.001, method: VelocityVerlet), bodies: [
        (name: \"clump\", at: (1, 2), angle: \"90 deg\", datum: Origin, atoms: List([(at: (0, 0), radius: 0.1, mass: 1), (at: (0.4, 0), radius: 0.1, mass: 3)]))],
        forces: [Thrust(of: \"clump\", at: (0.4, 0), force: (2, 0)), SPRINGS])";
    let spring = "Spring(a: \"clump\", anchor_a: (0.4, 0), b: World, anchor_b: (3, 2), stiffness: 2),";
    let folder = Folder::new("anchors")
        .with("one.ron", scene.replace("SPRINGS", ""))
        .with("many.ron", scene.replace("SPRINGS", &spring.repeat(20)))
        .with("fall.ron", FALL);
    let ended = folder.jostle("check one.ron").code(0);
    assert_eq!(ended.err, "anchor: one.ron: `forces[0].at` on `clump` is at (1, 2.4) m at the start\n");
    let ended = folder.jostle("check many.ron").code(0);
    assert!(ended.err.ends_with("anchor: many.ron: and 9 more anchors, which --json tells\n"), "{ended:?}");
    assert!(ended.err.contains("`forces[3].anchor_a` on `clump` is at (1, 2.4) m"), "{ended:?}");
    let [result] = &folder.jostle("check --json many.ron").code(0).json()[..] else { panic!("one line") };
    let anchors = result["anchors"].as_array().expect("a list");
    assert_eq!(anchors.len(), 21);
    assert_eq!((&anchors[0]["path"], &anchors[0]["body"]), (&"forces[0].at".into(), &"clump".into()));
    assert!((anchors[20]["position"][1].as_f64().unwrap() - 2.4).abs() < 1e-15, "{}", anchors[20]);
    assert_eq!(folder.jostle("check fall.ron").code(0).err, "");
}

/// Laws: an anchor that is left out is the centre of mass, or the place where the bodies meet. `check` says that a default gives it. A
/// coordinate that is rounding, such as `0.5 cos(90 deg) = 3e-17`, is shown as 0. `--json` keeps it.
#[test]
fn check_tells_anchors_that_follow_from_defaults() {
    let scene = "Scene(format: 1, clock: (duration: 1, tick: 0.001, method: VelocityVerlet), contacts: None, bodies: [
        (name: \"bar\", at: (0, 1), angle: \"90 deg\", shape: Rectangle(width: 1, height: 0.1)), (name: \"ball\", at: (2, 1), atoms: Disc(radius: 0.1))],
        joints: [Revolute(a: World, b: \"bar\", anchor_b: (0.5, 0)), Distance(a: \"bar\", b: \"ball\", anchor_a: (-0.5, 0))],
        forces: [Spring(a: \"bar\", b: \"ball\", anchor_a: (0.5, 0), stiffness: 1)])";
    let folder = Folder::new("default_anchors").with("bar.ron", scene);
    let told = folder.jostle("check bar.ron").code(0).err;
    for line in [
        "`joints[0].anchor_a` on the world is at (0, 1.5) m at the start, by default",
        "`joints[0].anchor_b` on `bar` is at (0, 1.5) m at the start",
        "`joints[1].anchor_a` on `bar` is at (0, 0.5) m at the start",
        "`joints[1].anchor_b` on `ball` is at (2, 1) m at the start, by default",
        "`forces[0].anchor_a` on `bar` is at (0, 1.5) m at the start",
        "`forces[0].anchor_b` on `ball` is at (2, 1) m at the start, by default",
    ] {
        assert!(told.contains(&format!("anchor: bar.ron: {line}\n")), "{line}: {told}");
    }
    let [result] = &folder.jostle("check --json bar.ron").code(0).json()[..] else { panic!("one line") };
    let anchors = result["anchors"].as_array().expect("a list");
    let of = |path: &str| anchors.iter().find(|anchor| anchor["path"] == path).expect("it is there");
    assert_eq!(
        (&of("joints[0].anchor_a")["default"], &of("joints[0].anchor_b")["default"]),
        (&true.into(), &false.into())
    );
    assert_eq!(of("joints[0].anchor_a")["body"], serde_json::Value::Null);
    let x = of("joints[0].anchor_b")["position"][0].as_f64().expect("a number");
    assert!(x != 0.0 && x.abs() < 1e-16, "{x}");
}
