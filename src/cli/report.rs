//! `jostle report`: speed against error on problems with known answers, and hard cases.

use std::path::PathBuf;

use clap::Args;

use super::inputs::is_same_file;
use super::progress_bar::Progress;
use super::say::{count, say};
use super::{Exit, author};
use crate::output::{flat_picture, write_whole};
use crate::problems::hard::{self, Case, Judgement};
use crate::problems::{ALL, Problem};
use crate::raster::{Theme, draw_diagram};
use crate::report::document::{self, DocumentRequest, Judged, Made, PagePicture, Peers, Sheet};
use crate::scene::embed::{FileRequest, told};
use crate::scene::nearest_name;

/// The command `report`.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(super) struct Report {
    /// Problems and hard cases, by name. Default: all
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// The folder for report.md, report.html and hard_cases.csv, and for a table (CSV) and a diagram (PNG) of each problem
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Take fewer methods, ticks and hard cases, for a first look in less than a minute
    #[arg(long)]
    quick: bool,
    /// Draw the curves of other engines too, from the table that tools/peers/peers writes
    #[arg(long, value_name = "FILE.csv")]
    peers: Option<PathBuf>,
    /// Show no progress bar, and messages only if something is wrong
    #[arg(long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  jostle report -o report                    all problems and hard cases, all methods: some minutes
  jostle report -o report --quick            a first look
  jostle report kepler cradle gas -o three   two problems and a hard case
  jostle report -o report --peers peers.csv  with the curves of other engines

Each problem has an exact answer. Each method runs it at several ticks, and the report tells the error and the cost of each. \
It also names the cheapest settings for errors of 1e-2 (bronze), 1e-4 (silver) and 1e-8 (gold), and the grade of each method. \
The command finds errors on all cores. Then it times one run after the other, and takes the least of several times. \
The report lists all runs that failed, with their reasons.

Hard cases are scenes that break engines. Each value stands beside its threshold and the source of the threshold. --quick leaves \
out the expensive cases, and the report names them.

Exit codes: 0 good, 1 a hard case fails (the report is still complete), 2 command line wrong, or a file cannot be read or written.";

/// Curves of other engines.
const PEERS: FileRequest =
    FileRequest { most: 64 << 20, noun: "a table of comma-separated values", smaller: "keep fewer rows" };

/// The size of diagrams in pixels.
const SIZE: (u32, u32) = (960, 600);

impl Report {
    pub(super) fn execute(self) -> Exit {
        let chosen = self.chosen().and_then(|chosen| {
            self.spare_peers(&chosen.0)?;
            Ok((chosen, self.read_peers()?))
        });
        let ((problems, cases), peers) = match chosen {
            Ok(chosen) => chosen,
            Err(message) => {
                say(&message);
                return Exit::Usage;
            }
        };
        if let Err(error) = std::fs::create_dir_all(&self.output) {
            say(&format!("error: `{}` cannot be made: {error}", self.output.display()));
            return Exit::Usage;
        }
        let order = DocumentRequest { quick: self.quick };
        let progress = Progress::new((2 * problems.len() + cases.len()) as u64, "runs of problems", self.quiet);
        let (mut sheets, cases) = order.errors(&problems, &cases, &|| progress.step());
        // The results so far are kept in every case.
        let mut written = self.write(&sheets, &cases, &peers);
        if written.is_ok() {
            for sheet in &mut sheets {
                sheet.time();
                progress.step();
            }
            written = self.write(&sheets, &cases, &peers);
        }
        drop(progress);
        match written {
            Ok(()) => self.tell(&sheets, &cases),
            Err(message) => {
                say(&message);
                Exit::Usage
            }
        }
    }

    fn tell(&self, sheets: &[Sheet], cases: &[Judged]) -> Exit {
        let failed: usize = cases.iter().map(|judged| judged.count(Judgement::Failed)).sum();
        if failed > 0 {
            say(&format!("{} of hard cases beyond their thresholds", count(failed, "reading", "readings")));
        }
        if !self.quiet {
            let run = cases.iter().filter(|judged| judged.readings.is_some()).count();
            let (problems, cases) = (count(sheets.len(), "problem", "problems"), count(run, "hard case", "hard cases"));
            say(&format!("{problems} and {cases} in {}", self.output.join("report.html").display()));
        }
        if failed > 0 { Exit::SceneWrong } else { Exit::Good }
    }

    /// The problems and cases that are asked for.
    fn chosen(&self) -> Result<(Vec<Problem>, Vec<Case>), String> {
        if self.names.is_empty() {
            return Ok((ALL.to_vec(), hard::ALL.to_vec()));
        }
        let names = || ALL.iter().map(|problem| problem.name).chain(hard::ALL.iter().map(|case| case.name));
        if let Some(name) = self.names.iter().find(|name| !names().any(|known| known == *name)) {
            let near = nearest_name(name, names()).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
            let listed: Vec<&str> = names().collect();
            return Err(format!(
                "error: there is no problem `{name}`{near}\nproblems and hard cases: {}",
                listed.join(", ")
            ));
        }
        let asked = |name: &str| self.names.iter().any(|asked| asked == name);
        let problems: Vec<Problem> = ALL.iter().filter(|problem| asked(problem.name)).copied().collect();
        let cases: Vec<Case> = hard::ALL.iter().filter(|case| asked(case.name)).copied().collect();
        if problems.is_empty() && self.quick && cases.iter().all(|case| !case.cheap) {
            return Err(format!(
                "error: --quick leaves out {}: they take longer; run them without it",
                self.names.join(", ")
            ));
        }
        Ok((problems, cases))
    }

    /// Outputs must not replace the table that is read.
    fn spare_peers(&self, problems: &[Problem]) -> Result<(), String> {
        let Some(peers) = &self.peers else { return Ok(()) };
        let own = problems.iter().map(|problem| format!("{}.csv", problem.name));
        let all = own.chain(["hard_cases.csv", "report.md", "report.html"].map(str::to_owned));
        let mut all = all.map(|file| self.output.join(file));
        match all.find(|path| is_same_file(path, peers)) {
            Some(path) => Err(format!("error: `{}` is a table of the report: copy it out of there", path.display())),
            None => Ok(()),
        }
    }

    fn read_peers(&self) -> Result<Peers, String> {
        let Some(path) = &self.peers else { return Ok(Peers::default()) };
        let name = path.display();
        let bytes = PEERS.take(path, &name.to_string(), "").map_err(|wrong| format!("error: {}", told(wrong)))?;
        let text = String::from_utf8(bytes).map_err(|_| format!("error: `{name}` is no text in UTF-8"))?;
        Peers::read(&text).map_err(|wrong| format!("error: {name}: {wrong}"))
    }

    fn write(&self, sheets: &[Sheet], cases: &[Judged], peers: &Peers) -> Result<(), String> {
        let theme = Theme::named("paper").expect("it comes with the program");
        let picture = |sheet: &Sheet| {
            let name = sheet.problem.name;
            // Before anything is timed there is nothing to be drawn.
            sheet.settings.all.iter().find(|setting| setting.error().is_some() && setting.seconds.is_some())?;
            let drawn = draw_diagram(&sheet.diagram(&peers.curves(name)), &theme, SIZE).ok()?;
            let (file, shows) = (format!("{name}.png"), format!("Cost against error of {name}"));
            Some(PagePicture { file, shows, bytes: flat_picture(&drawn).ok()? })
        };
        let page = document::page(&Made::here(author::commit()), sheets, cases, peers, &picture);
        for block in &page {
            if let document::Block::Picture(picture) = block {
                self.put(&picture.file, &picture.bytes)?;
            }
        }
        for sheet in sheets {
            self.put(&format!("{}.csv", sheet.problem.name), sheet.csv().as_bytes())?;
        }
        if !cases.is_empty() {
            self.put("hard_cases.csv", document::cases_csv(cases).as_bytes())?;
        }
        self.put("report.md", document::markdown(&page).as_bytes())?;
        self.put("report.html", document::html(&page).as_bytes())
    }

    fn put(&self, file: &str, bytes: &[u8]) -> Result<(), String> {
        write_whole(&self.output.join(file), bytes).map_err(|error| format!("error: {error}"))
    }
}
