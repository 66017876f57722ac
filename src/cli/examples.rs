//! The scenes that come with the program, `example:NAME`.

/// Name and text of each scene in `scenes/`.
pub(super) const SCENES: &[(&str, &str)] = &[
    ("arch", include_str!("../../scenes/arch.ron")),
    ("billiards", include_str!("../../scenes/billiards.ron")),
    ("bounce", include_str!("../../scenes/bounce.ron")),
    ("car_on_terrain", include_str!("../../scenes/car_on_terrain.ron")),
    ("card_house", include_str!("../../scenes/card_house.ron")),
    ("chain_and_ball", include_str!("../../scenes/chain_and_ball.ron")),
    ("clock_of_our_own", include_str!("../../scenes/clock_of_our_own.ron")),
    ("cogs", include_str!("../../scenes/cogs.ron")),
    ("conveyor", include_str!("../../scenes/conveyor.ron")),
    ("cow", include_str!("../../scenes/cow.ron")),
    ("cradle_on_rods", include_str!("../../scenes/cradle_on_rods.ron")),
    ("dominoes", include_str!("../../scenes/dominoes.ron")),
    ("double_pendulum", include_str!("../../scenes/double_pendulum.ron")),
    ("fireworks", include_str!("../../scenes/fireworks.ron")),
    ("four_bar", include_str!("../../scenes/four_bar.ron")),
    ("galton_sweep", include_str!("../../scenes/galton_sweep.ron")),
    ("hatch", include_str!("../../scenes/hatch.ron")),
    ("hopper", include_str!("../../scenes/hopper.ron")),
    ("hourglass", include_str!("../../scenes/hourglass.ron")),
    ("incline", include_str!("../../scenes/incline.ron")),
    ("kepler", include_str!("../../scenes/kepler.ron")),
    ("marble_mills", include_str!("../../scenes/marble_mills.ron")),
    ("marble_run", include_str!("../../scenes/marble_run.ron")),
    ("newtons_cradle", include_str!("../../scenes/newtons_cradle.ron")),
    ("one_after_another", include_str!("../../scenes/one_after_another.ron")),
    ("pendulum_clock", include_str!("../../scenes/pendulum_clock.ron")),
    ("pendulums", include_str!("../../scenes/pendulums.ron")),
    ("plinko", include_str!("../../scenes/plinko.ron")),
    ("projectile", include_str!("../../scenes/projectile.ron")),
    ("rocket_thrust", include_str!("../../scenes/rocket_thrust.ron")),
    ("rolling_shapes", include_str!("../../scenes/rolling_shapes.ron")),
    ("rooms", include_str!("../../scenes/rooms.ron")),
    ("rope_bridge", include_str!("../../scenes/rope_bridge.ron")),
    ("slider_crank", include_str!("../../scenes/slider_crank.ron")),
    ("snow_globe", include_str!("../../scenes/snow_globe.ron")),
    ("solar_system", include_str!("../../scenes/solar_system.ron")),
    ("tetris", include_str!("../../scenes/tetris.ron")),
    ("tetris_weightless", include_str!("../../scenes/tetris_weightless.ron")),
    ("tiles", include_str!("../../scenes/tiles.ron")),
    ("triple_pendulum", include_str!("../../scenes/triple_pendulum.ron")),
    ("tumbling_shapes", include_str!("../../scenes/tumbling_shapes.ron")),
    ("two_link_arm", include_str!("../../scenes/two_link_arm.ron")),
];

#[cfg(test)]
mod tests {
    /// A scene that is not listed would be missing from an installed program.
    #[test]
    fn every_scene_of_the_folder_is_listed() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .filter_map(|entry| entry.unwrap().file_name().to_str().unwrap().strip_suffix(".ron").map(str::to_owned))
            .collect();
        files.sort();
        let listed: Vec<&str> = super::SCENES.iter().map(|(name, _)| *name).collect();
        assert_eq!(files, listed);
    }
}
