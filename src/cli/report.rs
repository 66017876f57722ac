//! `jostle report`: speed against error on problems whose answer is known.

use std::path::{Path, PathBuf};

use clap::Args;

use super::Exit;
use super::progress::Progress;
use super::say::{count, say};
use crate::problems::{ALL, Problem};
use crate::report::survey::{self, Order, Sheet};
use crate::scene::nearest_name;

/// The command `report`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Report {
    /// Problems, by name. Default: all
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Folder for the report: report.md, report.html, and for each problem a table (CSV) and a diagram (SVG)
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Fewer methods and ticks: a first look, in less than a minute
    #[arg(long)]
    quick: bool,
    /// No progress bar, and messages only if something is wrong
    #[arg(long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle report -o report              all problems, all methods: some minutes
  jostle report -o report --quick      a first look
  jostle report kepler cradle -o two   two problems

Each problem has an exact answer. It is run by each method at several ticks; the report says what error that leaves and what it
costs, and how an error of 1e-2 (bronze), 1e-4 (silver) and 1e-8 (gold) is reached at the least cost. Errors and times come from
runs of their own, times are the least of several. What does not run is listed with its reason.";

impl Report {
    pub(super) fn execute(self) -> Exit {
        let problems = match self.problems() {
            Ok(problems) => problems,
            Err(message) => {
                say(&message);
                return Exit::Usage;
            }
        };
        if let Err(error) = std::fs::create_dir_all(&self.output) {
            say(&format!("error: `{}` cannot be made: {error}", self.output.display()));
            return Exit::Usage;
        }
        let order = Order { quick: self.quick };
        let steps = problems.iter().map(|problem| order.courses(problem).len() as u64).sum();
        let progress = Progress::new(steps, "curves", self.quiet);
        let mut sheets = Vec::new();
        for problem in &problems {
            sheets.push(order.measure(problem, || progress.step()));
            // What there is so far is kept whatever happens.
            if let Err(message) = write(&self.output, &sheets) {
                drop(progress);
                say(&message);
                return Exit::Usage;
            }
        }
        drop(progress);
        if !self.quiet {
            say(&format!(
                "{} in {}",
                count(sheets.len(), "problem", "problems"),
                self.output.join("report.html").display()
            ));
        }
        Exit::Good
    }

    fn problems(&self) -> Result<Vec<Problem>, String> {
        if self.names.is_empty() {
            return Ok(ALL.to_vec());
        }
        let known = |name: &String| {
            ALL.iter().find(|problem| problem.name == name).copied().ok_or_else(|| {
                let names = ALL.iter().map(|problem| problem.name);
                let near = nearest_name(name, names.clone()).map(|near| format!("; did you mean `{near}`?"));
                let names: Vec<&str> = names.collect();
                format!(
                    "error: there is no problem `{name}`{}\nproblems: {}",
                    near.unwrap_or_default(),
                    names.join(", ")
                )
            })
        };
        self.names.iter().map(known).collect()
    }
}

/// Writes the table and diagram of the last sheet, and the pages of all.
fn write(folder: &Path, sheets: &[Sheet]) -> Result<(), String> {
    let Some(last) = sheets.last() else { return Ok(()) };
    let name = last.problem.name;
    for (file, text) in [
        (format!("{name}.csv"), last.csv()),
        (format!("{name}.svg"), survey::diagram(last)),
        ("report.md".to_owned(), survey::markdown(sheets)),
        ("report.html".to_owned(), survey::html(sheets)),
    ] {
        let path = folder.join(file);
        std::fs::write(&path, text)
            .map_err(|error| format!("error: `{}` cannot be written: {error}", path.display()))?;
    }
    Ok(())
}
