//! Whole scenes, read with a few small plugins, and the exact messages for wrong ones.

mod display;
mod plugins;
mod reading;
mod wrong;

use bevy_app::App;

use super::{Source, load};

/// The printed messages for a wrong scene.
fn messages(text: &str) -> String {
    let mut app = plugins::app();
    match load(&mut app, &Source::new("a.ron", text)) {
        Ok(_) => panic!("the scene was taken as good:\n{text}"),
        Err(errors) => errors.to_string(),
    }
}

/// Checks that a scene is wrong with exactly these messages. The first line break of both texts is ignored.
#[track_caller]
fn wrong(scene: &str, expected: &str) {
    let found = messages(scene.strip_prefix('\n').unwrap_or(scene));
    let expected = expected.strip_prefix('\n').unwrap_or(expected);
    assert!(found == expected, "\n--- expected\n{expected}\n--- found\n{found}");
}

fn loaded(text: &str) -> App {
    let mut app = plugins::app();
    if let Err(errors) = load(&mut app, &Source::new("a.ron", text)) {
        panic!("{errors}");
    }
    app
}
