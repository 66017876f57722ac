//! Whole scenes, read with a few small plugins, and the exact messages for those that are wrong.

mod plugins;
mod reading;

use bevy_app::App;

use super::{Source, load};

/// The messages for a wrong scene, as they are printed.
fn messages(text: &str) -> String {
    let mut app = plugins::app();
    match load(&mut app, &Source::new("a.ron", text)) {
        Ok(_) => panic!("the scene was taken as good:\n{text}"),
        Err(errors) => errors.to_string(),
    }
}

fn loaded(text: &str) -> App {
    let mut app = plugins::app();
    if let Err(errors) = load(&mut app, &Source::new("a.ron", text)) {
        panic!("{errors}");
    }
    app
}
