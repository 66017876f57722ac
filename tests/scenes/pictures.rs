//! One picture of each theme, pixel by pixel. A change of the look of films shows here.
//!
//! Tolerance: none, as the same picture has the same bytes everywhere. Not tested: whether it is beautiful; look at
//! `tests/pictures`. That shapes are drawn where they are is tested in `src/film/raster`.

use std::path::{Path, PathBuf};

use jostle::Simulation;
use jostle::raster::{Camera, Painter, Scratch, Theme, View};
use jostle::record::layers::PictureHeight;
use jostle::scene::Source;
use jostle::simulation::Recorder;

/// Set to anything, it makes the test write the pictures in place of comparing them.
const REWRITE: &str = "JOSTLE_REWRITE_PICTURES";

/// Every layer at once.
const SCENE: &str = include_str!("../pictures/layers.ron");

const SIZE: (u32, u32) = (480, 270);

fn file(theme: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/pictures/{theme}.png"))
}

fn painted(theme: &str) -> image::RgbaImage {
    let mut simulation = Simulation::load(&Source::new("layers.ron", SCENE)).expect("a correct scene");
    let camera = Camera::look((2.0, 0.9).into(), 2.25, SIZE);
    simulation.world_mut().insert_resource(PictureHeight(2.25));
    let frame = Recorder::default().frame(&mut simulation, 0.35).expect("numbers stay finite");
    let view = View { camera, theme: Theme::named(theme).expect("it is there"), frame_step: 0.1, panel: None };
    let painter = Painter::new(&view, &frame).expect("a picture");
    let mut picture = painter.backdrop().clone();
    painter.paint(&frame, &mut picture, &mut Scratch::default());
    image::RgbaImage::from_raw(SIZE.0, SIZE.1, picture.data().to_vec()).expect("four bytes each pixel")
}

#[test]
fn each_theme_looks_as_it_is_written_down() {
    for theme in Theme::names() {
        let (now, path) = (painted(theme), file(theme));
        if std::env::var_os(REWRITE).is_some() {
            now.save(&path).expect("room");
            continue;
        }
        let before = image::open(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgba8();
        let differing = now.pixels().zip(before.pixels()).filter(|(a, b)| a != b).count();
        assert!(
            differing == 0 && now.dimensions() == before.dimensions(),
            "{theme} differs in {differing} pixels from {}\nIf that is meant, write the pictures anew, look at them, and \
             explain the change in the commit that makes it:\n\n  {REWRITE}=1 cargo test --test main pictures\n",
            path.display()
        );
    }
}
