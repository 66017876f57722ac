//! Plots read and never change: the run is the same, to the last bit, with and without them.

use jostle::record::sections::PlotsSection;
use jostle::simulation::Sampler;

use super::{clumps, hash, load, run, scene};

const TICKS: u64 = 1500;

/// Channels that need something of the engine of their own (contacts are counted, forces summed) among them.
const PLOTS: &str = r#"plots: [
    (channels: ["energy.kinetic", "energy.total", "energy.residual"]),
    (x: "*.position.x", y: ["clump_0.velocity.x", "clump_1.velocity.x"], tail: 1),
    (channels: ["clump_0.contacts", "clump_0.force.y", "overlap.deepest"]),
    (histogram: (of: "*", quantity: "position.x", from: 0, to: 6)),
],"#;

#[test]
fn a_run_is_the_same_with_plots_and_while_they_are_sampled() {
    let mut without = load(&scene("VelocityVerlet", "", &clumps()), |_| {});
    run(&mut without, TICKS);

    let plotted = scene("VelocityVerlet", PLOTS, &clumps());
    let mut with = load(&plotted, |_| {});
    run(&mut with, TICKS);
    assert_eq!(hash(&with), hash(&without));

    let mut sampled = load(&plotted, |_| {});
    let plots = sampled.resource::<PlotsSection>().0.clone();
    let end = TICKS as f64 * sampled.clock().dt;
    let mut sampler = Sampler::new(&mut sampled, &plots, 0.0, end).expect("all channels are there");
    sampler.run_to_end(&mut sampled).expect("it runs");
    assert_eq!(sampled.clock().ticks, TICKS);
    assert_eq!(hash(&sampled), hash(&without));

    let drawn = sampler.finish(false);
    let kinetic = &drawn[0].curves()[0].samples;
    assert!(kinetic.len() > 100 && kinetic[0].time == 0.0 && kinetic.last().expect("many").time == end);
}
