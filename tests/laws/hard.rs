//! Law: that of each hard case of `jostle::problems::hard`, in the short form. Source and tolerances: each case's file,
//! which derives every threshold.
//!
//! A value beyond its threshold that the engine reports is no failure here. Only the sweep of ticks above the critical
//! tick and dead points of linkages have such values.
//!
//! Not tested: what the short forms leave out; `jostle report` runs all.

use jostle::problems::hard::{ALL, Case, Extent, Judgement, Threshold};

/// Runs a case and shows its readings.
fn assert_holds(case: &Case) {
    let readings = case.measure(Extent::Short);
    assert!(!readings.is_empty(), "{}: nothing was measured", case.name);
    let mut failed = Vec::new();
    for reading in &readings {
        let told = reading.told.as_ref().map_or_else(String::new, |told| format!(" ({told})"));
        let line =
            format!("{:?}: {}: {:e} {}{told}", reading.verdict(), reading.what, reading.value, reading.threshold);
        println!("{line}");
        if reading.verdict() == Judgement::Failed {
            failed.push(format!("{line}: {}", reading.why));
        }
        let (Threshold::AtMost(bound) | Threshold::AtLeast(bound)) = reading.threshold;
        assert!(bound.is_finite() && !reading.why.is_empty(), "{line}");
    }
    assert!(failed.is_empty(), "{}:\n{}", case.name, failed.join("\n"));
}

/// A test for each case, and one that there are no others.
macro_rules! cases {
    ($($name:ident),+ $(,)?) => {
        $(#[test]
        fn $name() {
            assert_holds(&jostle::problems::hard::$name::CASE);
        })+

        #[test]
        fn every_case_has_its_test_under_its_name() {
            assert_eq!(ALL.iter().map(|case| case.name).collect::<Vec<_>>(), [$(stringify!($name)),+]);
        }
    };
}

cases!(
    mass_ratio,
    stiffness,
    tick_limit,
    spin,
    far_away,
    sizes,
    deep_overlap,
    million_ticks,
    gas,
    column,
    pile,
    tick_sweep,
    heavy_load,
    upright_pendulum,
    cut_chain,
    dead_point,
    fast_limits,
    pulled_apart,
);
