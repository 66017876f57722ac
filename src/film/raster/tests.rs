use glam::DVec2;

use super::*;
use jostle_frames::frame::{BodyLook, BodyPose, Disc, WallLook};
use jostle_frames::mark::{Corner, Mark};

fn ball(name: &str, fixed: bool) -> BodyLook {
    let discs = vec![Disc { offset: DVec2::ZERO, radius: 0.5 }];
    BodyLook { name: name.to_owned(), discs, hulls: Vec::new(), color: None, fixed }
}

fn pose(x: f64, y: f64) -> BodyPose {
    BodyPose { position: DVec2::new(x, y), angle: 0.0 }
}

/// A peg at (1, 3) and a ball at (4, 2) over a floor.
fn frame() -> Frame {
    let floor = WallLook {
        name: "floor".to_owned(),
        left: DVec2::new(6.0, 0.0),
        right: DVec2::ZERO,
        thickness: None,
        points: Vec::new(),
        color: Some("blue".into()),
    };
    let cast =
        Cast { title: "Peg".to_owned(), bodies: vec![ball("peg", true), ball("ball", false)], walls: vec![floor] };
    Frame {
        time: 1.25,
        cast: Arc::new(cast),
        poses: vec![pose(1.0, 3.0), pose(4.0, 2.0)],
        marks: vec![Mark::plain(MarkShape::Time)],
        center: None,
    }
}

fn view() -> View {
    let camera = Camera::fit(WorldRectangle { low: DVec2::ZERO, high: DVec2::new(6.0, 4.0) }, 0.1, (240, 180));
    View { camera, theme: Theme::named("paper").expect("shipped"), frame_step: 0.01, panel: None }
}

fn seen(picture: &Pixmap, place: DVec2) -> Rgb {
    let place = view().camera.to_picture(place);
    let pixel = picture.pixel(place.x as u32, place.y as u32).expect("inside");
    Rgb(pixel.red(), pixel.green(), pixel.blue())
}

#[test]
fn each_thing_has_its_colour_in_its_place() {
    let (view, frame) = (view(), frame());
    let painter = Painter::new(&view, &frame).expect("a small picture");
    let mut picture = painter.backdrop().clone();
    painter.paint(&frame, &mut picture, &mut Scratch::default());
    let color = |name| view.theme.color(name).expect("known");
    let (peg, ball, floor) = (DVec2::new(1.0, 3.3), DVec2::new(4.1, 2.2), DVec2::new(3.0, -0.07));
    assert_eq!(seen(&picture, peg), color("grey"));
    assert_eq!(seen(&picture, ball), color("sky"), "the first moving body has the first colour");
    assert_eq!(seen(&picture, floor), color("blue"));
    assert_eq!(seen(&picture, DVec2::new(3.0, -0.37)), view.theme.ground);
    assert_eq!(seen(&picture, DVec2::new(2.7, 2.7)), view.theme.background);
    // The peg belongs to what never moves, the ball does not.
    assert_eq!(seen(painter.backdrop(), peg), color("grey"));
    assert_eq!(seen(painter.backdrop(), ball), view.theme.background);
    for place in [peg, ball, floor] {
        assert!(painter.flat_colors().contains(&seen(&picture, place)));
    }
}

#[test]
fn a_picture_depends_on_its_frame_alone() {
    let frame = frame();
    let mut later = frame.clone();
    later.poses[1] = pose(2.0, 1.0);
    later.time = 9.0;
    let painter = Painter::new(&view(), &frame).expect("a small picture");
    let mut scratch = Scratch::default();
    let mut fresh = painter.backdrop().clone();
    painter.paint(&later, &mut fresh, &mut scratch);
    let mut used = painter.backdrop().clone();
    painter.paint(&frame, &mut used, &mut scratch);
    assert_ne!(used.data(), fresh.data());
    painter.paint(&later, &mut used, &mut scratch);
    assert_eq!(used.data(), fresh.data());
    let mut other_size = Pixmap::new(3, 3).expect("tiny");
    painter.paint(&later, &mut other_size, &mut scratch);
    assert_eq!(other_size.data(), fresh.data());
}

#[test]
fn only_the_clock_changes_when_nothing_moves() {
    let frame = frame();
    let painter = Painter::new(&view(), &frame).expect("a small picture");
    let draw = |time: f64| {
        let mut picture = painter.backdrop().clone();
        painter.paint(&Frame { time, ..frame.clone() }, &mut picture, &mut Scratch::default());
        picture
    };
    let (one, two) = (draw(1.11), draw(1.18));
    let changed = one.pixels().iter().zip(two.pixels()).enumerate().filter(|(_, (a, b))| a != b);
    let columns: Vec<usize> = changed.map(|(index, _)| index % 240).collect();
    let spread = columns.iter().max().expect("the clock goes") - columns.iter().min().expect("the clock goes");
    assert!(spread < 12, "only the last digit changes, not {spread} columns");
}

#[test]
fn no_size_and_no_pose_are_survived() {
    let mut view = view();
    let mut frame = frame();
    frame.poses = vec![pose(f64::NAN, f64::INFINITY)];
    let painter = Painter::new(&view, &frame).expect("a small picture");
    let mut picture = painter.backdrop().clone();
    painter.paint(&frame, &mut picture, &mut Scratch::default());
    view.camera = Camera::look(DVec2::ZERO, 1.0, (0, 10));
    assert_eq!(Painter::new(&view, &frame).err(), Some(SizeError { width: 0, height: 10 }));
}

/// A part of 0.1 m on the ball fills its corner with the ball's colour, whatever the camera follows.
#[test]
fn an_inset_shows_its_part_enlarged_in_its_corner() {
    let view = view();
    let corner = |right: bool, bottom: bool| Corner { right, bottom };
    for (right, bottom) in [(false, false), (true, false), (false, true), (true, true)] {
        let mut frame = frame();
        let shape =
            MarkShape::Inset { center: DVec2::new(4.0, 2.2), height: 0.1, corner: corner(right, bottom), share: 0.25 };
        frame.marks = vec![Mark::plain(shape)];
        // A title would cover it.
        frame.cast = Arc::new(Cast { title: String::new(), ..(*frame.cast).clone() });
        let painter = Painter::new(&view, &frame).expect("a small picture");
        // A quarter of 180 pixels, and 0.75 of a pad of 6 pixels from both borders.
        let (side, air) = (45, 5);
        let far = |whole: u32, end: bool| if end { whole - air - side } else { air };
        let (left, top) = (far(240, right), far(180, bottom));
        for center in [None, Some(DVec2::new(1.0, 1.0))] {
            frame.center = center;
            let mut picture = painter.backdrop().clone();
            painter.paint(&frame, &mut picture, &mut Scratch::default());
            for (x, y) in [(left + 2, top + 2), (left + side - 3, top + side - 3), (left + side / 2, top + side / 2)] {
                let pixel = picture.pixel(x, y).expect("inside");
                let found = Rgb(pixel.red(), pixel.green(), pixel.blue());
                assert_eq!(Some(found), view.theme.color("sky"), "({x}, {y}), {right} {bottom} {center:?}");
            }
        }
    }
}
