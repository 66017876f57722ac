//! The table of a sweep: a row for each run. It contains nothing that depends on time or threads. So the same sweep
//! makes the same bytes, in one piece or in shards.

use crate::cli::columns::quoted;
use std::cmp::Ordering;
use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::attempt::{Attempt, Track};
use crate::cli::trial::Verdict;
use crate::output::csv;
use jostle_language::digest::of_bytes;

/// The columns that every table has after those of what varies.
const FIXED: [&str; 8] = [
    "result",
    "expectations held",
    "expectations",
    "energy residual [J]",
    "energy error",
    "largest overlap [m]",
    "tick [s]",
    "hash",
];
/// The cell of the expectations that held, for a run that ended too early to judge them.
const NOT_REACHED: &str = "not reached";
const RUN: &str = "run";
const REASON: &str = "reason";
/// The prefix of the header of a shard's last column, which has no cells.
const SWEEP: &str = "sweep ";
/// The prefix of the check sum of a shard's table in the same header. The sum is that of the text without it.
const SUM: &str = " sum ";

/// One run.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub(super) struct Row {
    /// Counted from 1.
    pub run: usize,
    /// The varied values.
    pub values: Vec<String>,
    fixed: Vec<String>,
    /// Column and cell of each channel.
    channels: Vec<(String, String)>,
    reason: String,
}

/// All runs of a sweep, or of a shard.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    /// Names of what varies.
    pub names: Vec<String>,
    /// Of a shard: of which sweep. Equal where scene, flags and what varies are equal.
    pub sweep: Option<String>,
    pub rows: Vec<Row>,
}

impl Row {
    /// The row of a run that is over.
    pub fn of(run: usize, values: Vec<String>, attempt: &Attempt) -> Self {
        let trial = &attempt.trial;
        let of_card = |read: fn(&crate::report::Card) -> f64| {
            attempt.card.as_ref().map_or_else(String::new, |card| csv::number(read(card)))
        };
        let fixed = vec![
            trial.verdict.word().to_owned(),
            if trial.verdict == Verdict::Failed && !trial.completed && !trial.expect.is_empty() {
                NOT_REACHED.to_owned()
            } else {
                trial.held().to_string()
            },
            trial.expect.len().to_string(),
            of_card(|card| card.energy.residual),
            of_card(|card| card.energy_error()),
            of_card(|card| card.largest_overlap.meters),
            of_card(|card| card.tick),
            trial.hash.clone().unwrap_or_default(),
        ];
        let channels = attempt.tracks.iter().flat_map(cells).collect();
        // A row is a line.
        let reason = trial.reason.lines().next().unwrap_or_default().to_owned();
        Self { run, values, fixed, channels, reason }
    }

    /// The verdict of the run; `None` for a word that is no verdict.
    pub fn verdict(&self) -> Option<Verdict> {
        Verdict::ALL.into_iter().find(|verdict| self.fixed[0] == verdict.word())
    }

    /// Whether the scene was read, so that its channels count.
    fn ran(&self) -> bool {
        self.verdict() != Some(Verdict::Refused)
    }
}

fn cells(track: &Track) -> Vec<(String, String)> {
    let unit = if track.unit.is_empty() { String::new() } else { format!(" [{}]", track.unit) };
    let cell = |what: &str, value: f64| (format!("{} {what}{unit}", track.name), csv::number(value));
    vec![cell("final", track.last), cell("min", track.least), cell("max", track.most)]
}

impl Table {
    /// The columns of channels. They have the order of the sensors if all runs have the same, and are else sorted by
    /// name. So the order does not depend on the distribution of the runs.
    fn channels(&self) -> Vec<String> {
        let lists: BTreeSet<Vec<&str>> = self
            .rows
            .iter()
            .filter(|row| row.ran())
            .map(|row| row.channels.iter().map(|(column, _)| column.as_str()).collect())
            .collect();
        if lists.len() == 1 {
            return lists.into_iter().flatten().map(str::to_owned).collect();
        }
        let all: BTreeSet<&str> = lists.into_iter().flatten().collect();
        let mut all: Vec<&str> = all.into_iter().collect();
        all.sort_by(|a, b| by_name(a, b));
        all.into_iter().map(str::to_owned).collect()
    }

    /// The table as comma-separated values.
    pub fn to_csv(&self) -> String {
        let channels = self.channels();
        let mut text = String::new();
        let mut line = |cells: Vec<&str>| {
            let cells: Vec<String> = cells.into_iter().map(quoted).collect();
            text.push_str(&cells.join(","));
            text.push('\n');
        };
        let names = self.names.iter().map(String::as_str);
        let columns = channels.iter().map(String::as_str);
        let sweep = self.sweep.as_ref().map(|sweep| format!("{SWEEP}{sweep}"));
        let last = [REASON].into_iter().chain(sweep.as_deref());
        line([RUN].into_iter().chain(names).chain(FIXED).chain(columns).chain(last).collect());
        for row in &self.rows {
            let run = row.run.to_string();
            let cell = |column: &String| {
                row.channels.iter().find(|(name, _)| name == column).map_or("", |(_, cell)| cell.as_str())
            };
            let own = row.values.iter().chain(&row.fixed).map(String::as_str);
            let channels = channels.iter().map(cell);
            let last = [row.reason.as_str()].into_iter().chain(sweep.as_ref().map(|_| ""));
            line([run.as_str()].into_iter().chain(own).chain(channels).chain(last).collect());
        }
        if self.sweep.is_some() {
            let sum = format!("{SUM}{:016x}", of_bytes(text.bytes()));
            text.insert_str(text.find('\n').unwrap_or(text.len()), &sum);
        }
        text
    }

    /// Reads a table that [`Table::to_csv`] has written.
    pub fn from_csv(text: &str) -> Result<Self, String> {
        let text = &checked(text)?;
        let mut lines = records(text)?.into_iter();
        let mut header = lines.next().ok_or("it is empty")?;
        let columns = header.len();
        let sweep = header.last().and_then(|last| last.strip_prefix(SWEEP)).map(str::to_owned);
        header.truncate(columns - usize::from(sweep.is_some()));
        let foreign = "it is no table of a sweep";
        let begin = header.windows(FIXED.len()).position(|columns| columns == FIXED).ok_or(foreign)?;
        let channels = begin + FIXED.len()..header.len() - 1;
        if header[0] != RUN || begin == 0 || header.last().is_none_or(|last| last != REASON) {
            return Err(foreign.to_owned());
        }
        let row = |cells: Vec<String>| {
            if cells.len() != columns {
                return Err(format!("a row has {} cells instead of {columns}", cells.len()));
            }
            let run = cells[0].parse().map_err(|_| format!("`{}` is not the number of a run", cells[0]))?;
            let there = channels.clone().filter(|&column| !cells[column].is_empty());
            let channels = there.map(|column| (header[column].clone(), cells[column].clone())).collect();
            let reason = cells[header.len() - 1].clone();
            let fixed = cells[begin..begin + FIXED.len()].to_vec();
            Ok(Row { run, values: cells[1..begin].to_vec(), fixed, channels, reason })
        };
        let rows = lines.map(row).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { names: header[1..begin].to_vec(), sweep, rows })
    }

    /// Puts the tables of all shards together, which are of one sweep.
    pub fn merged(shards: Vec<Self>) -> Result<Self, String> {
        let names = shards.first().map(|table| table.names.clone()).unwrap_or_default();
        if shards.iter().any(|table| table.names != names) {
            return Err("they are shards of different sweeps: other things vary".to_owned());
        }
        let mut rows: Vec<Row> = shards.into_iter().flat_map(|table| table.rows).collect();
        rows.sort_by_key(|row| row.run);
        if rows.iter().enumerate().any(|(index, row)| row.run != index + 1) {
            return Err("runs are absent or there twice: they are shards of different sweeps".to_owned());
        }
        let table = Self { names, sweep: None, rows };
        table
            .is_a_grid()
            .then_some(table)
            .ok_or_else(|| "the values make no grid: they are shards of different sweeps".to_owned())
    }

    /// Whether the rows are all combinations, in order.
    fn is_a_grid(&self) -> bool {
        let values = |column: usize| {
            let mut values: Vec<&str> = Vec::new();
            for row in &self.rows {
                if !values.contains(&row.values[column].as_str()) {
                    values.push(&row.values[column]);
                }
            }
            values
        };
        let values: Vec<Vec<&str>> = (0..self.names.len()).map(values).collect();
        let size: usize = values.iter().map(Vec::len).product();
        let fits = |(index, row): (usize, &Row)| {
            let mut left = index;
            values.iter().zip(&row.values).rev().all(|(values, value)| {
                let expected = values[left % values.len()];
                left /= values.len();
                expected == value
            })
        };
        size == self.rows.len() && self.rows.iter().enumerate().all(fits)
    }
}

/// The text of a table without its check sum, which a shard has to have.
fn checked(text: &str) -> Result<String, String> {
    let (head, rest) = text.split_at(text.find('\n').unwrap_or(text.len()));
    let again = "run this shard again";
    match head.rsplit_once(SUM) {
        Some((head, sum)) => {
            let text = format!("{head}{rest}");
            let fits = sum == format!("{:016x}", of_bytes(text.bytes()));
            fits.then_some(text)
                .ok_or_else(|| format!("it does not fit its check sum, so it was cut or changed: {again}"))
        }
        None if head.contains(&format!(",{SWEEP}")) => Err(format!("it has no check sum: {again}")),
        None => Ok(text.to_owned()),
    }
}

/// The cells of all lines.
fn records(text: &str) -> Result<Vec<Vec<String>>, String> {
    let record = |line: &str| {
        let (mut cells, mut quoted) = (vec![String::new()], false);
        let mut letters = line.chars().peekable();
        while let Some(letter) = letters.next() {
            let cell = cells.last_mut().expect("there is always one");
            match letter {
                '"' if quoted && letters.peek() == Some(&'"') => cell.extend(letters.next()),
                '"' => quoted = !quoted,
                ',' if !quoted => cells.push(String::new()),
                _ => cell.push(letter),
            }
        }
        if quoted { Err("a quotation mark is missing".to_owned()) } else { Ok(cells) }
    };
    text.lines().map(record).collect()
}

/// Names as people sort them: `ball_2` before `ball_10`.
fn by_name(a: &str, b: &str) -> Ordering {
    let pieces = |text: &str| {
        // Letters, then a number and the number of its digits.
        let mut pieces = vec![(String::new(), 0_u64, 0_usize)];
        for letter in text.chars() {
            let last = pieces.last_mut().expect("there is always one");
            match letter.to_digit(10) {
                Some(digit) => {
                    last.1 = last.1.saturating_mul(10).saturating_add(u64::from(digit));
                    last.2 += 1;
                }
                None if last.2 > 0 => pieces.push((letter.to_string(), 0, 0)),
                None => last.0.push(letter),
            }
        }
        pieces
    };
    pieces(a).cmp(&pieces(b)).then_with(|| a.cmp(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(run: usize, values: [&str; 2], channels: &[&str], verdict: Verdict) -> Row {
        let mut fixed = vec![verdict.word().to_owned()];
        fixed.resize(FIXED.len(), "1".to_owned());
        let cell = |(index, name): (usize, &&str)| ((*name).to_owned(), format!("{}", run * 10 + index));
        Row {
            run,
            values: values.map(str::to_owned).to_vec(),
            fixed,
            channels: channels.iter().enumerate().map(cell).collect(),
            reason: if verdict == Verdict::Good { String::new() } else { "no, \"never\"".to_owned() },
        }
    }

    /// Each way to share out the rows gives the bytes of the whole.
    fn shares_well(channels: [&[&str]; 6]) {
        let values = [["1", "a"], ["1", "b"], ["2", "a"], ["2", "b"], ["3", "a"], ["3", "b"]];
        let names = vec!["gravity".to_owned(), "x, y".to_owned()];
        let verdict = |run: usize| if channels[run].is_empty() { Verdict::Refused } else { Verdict::Good };
        let rows: Vec<Row> = (0..6).map(|run| row(run + 1, values[run], channels[run], verdict(run))).collect();
        let whole = Table { names: names.clone(), sweep: None, rows: rows.clone() };
        assert_eq!(Table::from_csv(&whole.to_csv()).unwrap().to_csv(), whole.to_csv());
        for shards in 1..=8 {
            let shard = |shard: usize| {
                let rows = rows.iter().skip(shard).step_by(shards).cloned().collect();
                let shard = Table { names: names.clone(), sweep: Some("1f".to_owned()), rows };
                let read = Table::from_csv(&shard.to_csv()).unwrap();
                assert_eq!(read.sweep, shard.sweep);
                read
            };
            let merged = Table::merged((0..shards).rev().map(shard).collect()).unwrap();
            assert_eq!(merged.to_csv(), whole.to_csv(), "{shards} shards");
        }
    }

    #[test]
    fn shards_merge_to_the_bytes_of_the_whole() {
        let plain: &[&str] = &["T.x", "energy", "A.y"];
        shares_well([plain; 6]);
        // A run that was refused has no channels.
        shares_well([plain, plain, &[], plain, &[], plain]);
        // Other runs have other channels, or another order of them.
        shares_well([plain, &["T.x", "b_10", "b_2", "energy"], plain, &["energy", "T.x", "A.y"], &["z"], &[]]);
        shares_well([
            plain,
            &["A.y", "T.x", "energy"],
            plain,
            &["A.y", "T.x", "energy"],
            plain,
            &["A.y", "T.x", "energy"],
        ]);
    }

    #[test]
    fn shards_of_different_sweeps_are_refused() {
        let table = |runs: &[(usize, [&str; 2])]| Table {
            names: vec!["a".into(), "b".into()],
            sweep: None,
            rows: runs.iter().map(|(run, values)| row(*run, *values, &["x"], Verdict::Good)).collect(),
        };
        let (one, two) = (table(&[(1, ["1", "1"])]), table(&[(2, ["1", "2"])]));
        assert!(Table::merged(vec![two.clone(), one.clone()]).is_ok());
        assert!(Table::merged(vec![one.clone(), one.clone()]).is_err());
        assert!(Table::merged(vec![two.clone()]).is_err());
        assert!(Table::merged(vec![one.clone(), table(&[(2, ["2", "2"])])]).is_err());
        let other = Table { names: vec!["a".into(), "c".into()], ..two };
        assert!(Table::merged(vec![one, other]).is_err());
        for text in ["", "time [s],x\n0,1\n", "run,a\n"] {
            assert!(Table::from_csv(text).is_err(), "{text}");
        }
    }

    #[test]
    fn names_are_sorted_as_people_do() {
        let mut names = ["b_10", "b_2", "a", "b", "b_2.x", "b_02"];
        names.sort_by(|a, b| by_name(a, b));
        assert_eq!(names, ["a", "b", "b_2", "b_2.x", "b_02", "b_10"]);
    }
}
