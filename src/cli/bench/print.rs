//! Measurements as tables for people and as JSON.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::cli::columns::aligned;
use crate::cli::say::number;
use crate::report::bench::{BenchResult, Spread};
use crate::tick::stopwatch::TickPart;

/// A stage below this share of a tick is omitted.
const SMALLEST_SHARE: f64 = 0.005;

/// Below so many atoms a scene takes less memory than what else grows in a process when it is run.
const FEWEST_ATOMS: usize = 1000;

/// The measurement of a scene.
pub(super) struct Row {
    name: String,
    measured: BenchResult,
    bytes: Option<u64>,
}

impl Row {
    pub(super) fn of(scene: &str, measured: BenchResult, bytes: Option<u64>) -> Self {
        let name = scene.rsplit('/').next().unwrap_or(scene);
        Self { name: name.strip_suffix(".ron").unwrap_or(name).to_owned(), measured, bytes }
    }
}

/// Memory for each atom, if it is that of the scene.
fn bytes_per_atom(bytes: Option<u64>, atoms: usize) -> Option<f64> {
    bytes.filter(|_| atoms >= FEWEST_ATOMS).map(|bytes| bytes as f64 / atoms as f64)
}

/// Three digits are enough for a measurement.
fn rounded(value: f64) -> String {
    if value.abs() >= 1000.0 {
        return format!("{value:.0}");
    }
    number(format!("{value:.2e}").parse().unwrap_or(value))
}

/// A number that may not be there.
fn or_dash(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), rounded)
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// All that was measured.
pub(super) fn table(rows: &[Row]) -> String {
    let mut text = aligned(
        &[
            "scene",
            "bodies",
            "atoms",
            "near",
            "touching",
            "us/tick",
            "ns/atom",
            "scatter",
            "plain",
            "x plain",
            "bytes/atom",
        ],
        rows.iter().map(|row| {
            let BenchResult { bodies, atoms, near, touching, us_per_tick, ns_per_atom_tick, plain, .. } = &row.measured;
            let plain = plain.as_ref().ok();
            vec![
                row.name.clone(),
                bodies.to_string(),
                atoms.to_string(),
                near.to_string(),
                touching.to_string(),
                rounded(us_per_tick.median),
                rounded(ns_per_atom_tick.median),
                percent(ns_per_atom_tick.width()),
                or_dash(plain.map(|plain| plain.ns_per_atom_tick.median)),
                or_dash(plain.map(|plain| plain.ratio.median)),
                or_dash(bytes_per_atom(row.bytes, *atoms)),
            ]
        }),
    );
    text.push_str("\nThe shares of the time:\n");
    let width = rows.iter().map(|row| row.name.len()).max().unwrap_or(0);
    for row in rows {
        let told = row.measured.stages.iter().filter(|(_, share)| *share >= SMALLEST_SHARE);
        // The search for rest has a separate line, because it may take more than all the rest.
        let (search, others): (Vec<_>, Vec<_>) = told.partition(|(name, _)| *name == TickPart::Rest.name());
        for part in [others, search].into_iter().filter(|part| !part.is_empty()) {
            let shares: Vec<String> = part.iter().map(|(name, share)| format!("{name} {}", percent(*share))).collect();
            let _ = writeln!(text, "{:<width$}  {}", row.name, shares.join(", "));
        }
    }
    text.push_str("\nThe results of the runs:\n");
    text.push_str(&aligned(
        &["scene", "ticks", "tick in s", "energy residual in J", "share of the energy", "state hash"],
        rows.iter().map(|row| {
            let BenchResult { ticks_in_all, tick, residual, residual_share, hash, .. } = &row.measured;
            let share = format!("{residual_share:.0e}");
            vec![row.name.clone(), ticks_in_all.to_string(), number(*tick), rounded(*residual), share, hash.clone()]
        }),
    ));
    for row in rows {
        if let Err(why) = row.measured.plain {
            let _ = writeln!(text, "note: {}: no plain loop beside it, for {why}", row.name);
        }
    }
    text
}

/// The measurement of a scene, for programs.
pub(super) fn json(scene: &str, measured: &BenchResult, bytes: Option<u64>) -> Value {
    let spread = |spread: &Spread| json!({ "median": spread.median, "min": spread.least, "max": spread.most });
    let plain = match &measured.plain {
        Ok(plain) => json!({
            "ns_per_atom_tick": spread(&plain.ns_per_atom_tick),
            "ratio": spread(&plain.ratio),
            "kinetic_energy_ratio": plain.kinetic_energy,
        }),
        Err(why) => json!({ "missing": why }),
    };
    let stage = |(name, share): &(&str, f64)| json!({ "stage": name, "share": share });
    json!({
        "scene": scene,
        "bodies": measured.bodies,
        "atoms": measured.atoms,
        "method": measured.method,
        "tick": measured.tick,
        "ticks_per_round": measured.ticks,
        "ticks": measured.ticks_in_all,
        "candidate_pairs": measured.near,
        "touching_pairs": measured.touching,
        "us_per_tick": spread(&measured.us_per_tick),
        "ns_per_atom_tick": spread(&measured.ns_per_atom_tick),
        "plain": plain,
        "bytes": bytes,
        "bytes_per_atom": bytes_per_atom(bytes, measured.atoms),
        "stages": measured.stages.iter().map(stage).collect::<Vec<_>>(),
        "energy_residual": measured.residual,
        "energy_residual_share": measured.residual_share,
        "hash": measured.hash,
    })
}
