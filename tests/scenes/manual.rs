//! The manual in `docs/manual.md` is what the program says of itself.

use std::path::Path;

use bevy_app::App;
use jostle::plugins;
use jostle::scene::SceneRegistry;
use jostle::scene::schema::Language;

/// Set to anything, it makes the test write the manual down in place of comparing it.
const REWRITE: &str = "JOSTLE_REWRITE_MANUAL";

#[test]
fn the_manual_is_fresh() {
    let mut app = App::empty();
    plugins::standard(&mut app);
    let now = Language::of(app.world().resource::<SceneRegistry>()).manual();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/manual.md");
    if std::env::var_os(REWRITE).is_some() {
        std::fs::write(file, now).unwrap();
        return;
    }
    let written = std::fs::read_to_string(file).unwrap_or_default();
    let differs = now.lines().zip(written.lines()).position(|(now, written)| now != written);
    assert!(
        now == written,
        "docs/manual.md differs from the program, first in line {}. Read what the program says now, and write it down:\n\n  \
         {REWRITE}=1 cargo test --test main the_manual\n",
        differs.map_or(now.lines().count().min(written.lines().count()), |line| line) + 1
    );
}
