//! The merger of the tables of shards.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::result_table::Table;
use crate::cli::Exit;
use crate::cli::say::{count, say};
use crate::output::write_whole;
use crate::scene::embed::{FileRequest, told};

/// A table of a shard.
const SHARD: FileRequest = FileRequest { most: 1 << 30, noun: "the table of a shard", smaller: "use more shards" };

/// The most absent shards that are listed.
const MOST_NAMED: usize = 20;

/// Merges all shards in a directory into `table.csv`.
pub(super) fn merge(folder: &Path, quiet: bool) -> Result<Exit, String> {
    let shown = folder.display();
    let (shards, of) = shards_in(folder)?;
    // A name may claim any number of them.
    let mut missing = (1..=of).filter(|which| !shards.contains_key(which)).map(|which| which.to_string());
    let first: Vec<String> = missing.by_ref().take(MOST_NAMED).collect();
    if !first.is_empty() {
        let (first, more) = (first.join(", "), if missing.next().is_some() { " and more" } else { "" });
        return Err(format!("of {of} shards in `{shown}` these are absent: {first}{more}"));
    }
    let read = |path: &PathBuf| {
        if !path.is_file() {
            return Err(format!("`{}` is no file", path.display()));
        }
        let bytes = SHARD.take(path, &path.display().to_string(), "").map_err(told)?;
        let text = String::from_utf8(bytes).map_err(|_| format!("`{}` is no text in UTF-8", path.display()))?;
        Table::from_csv(&text).map_err(|why| format!("`{}`: {why}", path.display()))
    };
    let tables = shards.values().map(read).collect::<Result<Vec<_>, _>>()?;
    let named = |index: usize| {
        let name = shards.values().nth(index).and_then(|path| path.file_name()).unwrap_or_default();
        let sweep = tables[index].sweep.as_deref().unwrap_or("unknown");
        format!("`{}` of the sweep {sweep}", name.display())
    };
    if let Some(other) = tables.iter().position(|table| table.sweep.is_none() || table.sweep != tables[0].sweep) {
        return Err(format!(
            "the tables in `{shown}` are of different sweeps: {} and {}. Their scenes, flags or varied names differ",
            named(0),
            named(other)
        ));
    }
    let merged = Table::merged(tables).map_err(|why| format!("the tables in `{shown}` do not fit together: {why}"))?;
    let path = folder.join("table.csv");
    write_whole(&path, merged.to_csv()).map_err(|error| error.to_string())?;
    if !quiet {
        let runs = count(merged.rows.len(), "run", "runs");
        say(&format!("{}: {runs} of {}", path.display(), count(of, "shard", "shards")));
    }
    Ok(Exit::Good)
}

/// The tables of shards, and how many there are to be.
fn shards_in(folder: &Path) -> Result<(BTreeMap<usize, PathBuf>, usize), String> {
    let shown = folder.display();
    let entries = std::fs::read_dir(folder).map_err(|cause| format!("cannot look into `{shown}`: {cause}"))?;
    let mut shards = BTreeMap::new();
    let mut sizes: Vec<usize> = Vec::new();
    for entry in entries {
        let path = entry.map_err(|cause| format!("cannot look into `{shown}`: {cause}"))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let parts = name.strip_prefix("table.").and_then(|name| name.strip_suffix(".csv"));
        let parts = parts.and_then(|name| name.split_once("-of-"));
        let Some((which, of)) = parts.and_then(|(which, of)| Some((which.parse().ok()?, of.parse().ok()?))) else {
            continue;
        };
        sizes.push(of);
        shards.insert(which, path);
    }
    sizes.sort_unstable();
    sizes.dedup();
    match sizes[..] {
        [of] => Ok((shards, of)),
        [] => Err(format!("there are no tables of shards (table.1-of-N.csv ...) in `{shown}`")),
        _ => Err(format!("in `{shown}` are tables of sweeps in different numbers of shards: remove the old ones")),
    }
}
