//! The report as a list of blocks, which [`super::markdown`] and [`super::html`] write.

use super::{Judged, Made, Peers, Sheet, failure, rounded, word};
use crate::estimate::validation::Checked;
use crate::problems::hard::Judgement;
use crate::problems::methods;
use crate::work_precision::{Setting, TARGETS};
use jostle_engine::integrate::ClockSection;
use jostle_language::numbers::number;

/// A part of a page, from top to bottom.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A heading of a level, which links find by its text.
    Heading(u8, String),
    /// A paragraph. Words between backquotes are code.
    Text(String),
    /// Heads and rows.
    Table(Vec<String>, Vec<Vec<Cell>>),
    /// A picture.
    Picture(PagePicture),
    /// Content that is shown on demand, under a name.
    Folded(String, Vec<Block>),
}

/// A cell of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cell {
    /// Text.
    Text(String),
    /// A link to a heading.
    Link(String),
}

/// A picture that lies beside the report.
#[derive(Clone, Debug, PartialEq)]
pub struct PagePicture {
    /// The name of its file.
    pub file: String,
    /// Its description.
    pub shows: String,
    /// The bytes of the file.
    pub bytes: Vec<u8>,
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

const HOW: &str = "Errors are the greatest at the samples of a problem, against its exact answer and in its unit. If the \
place of an event in a tick matters, they are the greatest of three such places. Times are the least of three to nine runs that do nothing else, on one core. `located`: the engine finds events inside ticks. `Auto`: the choice of the engine. No run has more than a million ticks, or 30 000 with `--quick`. Finer ticks are absent if the error is down to rounding, or to the uncertainty of the answer. They are also absent if other settings have this error for a 64th of the evaluations.";
const HARD: &str = "Scenes that break engines, with the measured value and the threshold that physics or numerics sets. \
*Told*: the value is beyond its threshold, but the engine ended the run with a message, or warned of it. *FAILED*: the value is beyond it, and the engine gives no message.";
const GRADES: &str = "The best grade of each method at any tick of the sequence. Bronze is an error of 1e-2, silver 1e-4, gold \
1e-8. *Reference* is the effect of rounding at the tick, or the uncertainty of the answer itself. A dash: none of these, or the method does not run.";

/// The page. `picture` draws the diagram of a sheet.
pub fn page(
    made: &Made,
    sheets: &[Sheet],
    cases: &[Judged],
    peers: &Peers,
    picture: &dyn Fn(&Sheet) -> Option<PagePicture>,
) -> Vec<Block> {
    let mut blocks = vec![Block::Heading(1, "Speed against error".to_owned()), Block::Text(HOW.to_owned())];
    let made = made.lines.iter().map(|(name, value)| vec![Cell::from(*name), value.clone().into()]).collect();
    blocks.push(Block::Table(vec!["made with".to_owned(), String::new()], made));
    if !sheets.is_empty() {
        blocks.push(Block::Heading(2, "The cheapest setting for each error".to_owned()));
        blocks.push(Block::Text(
            "Seconds of computing for each second of physics, and how: the cheapest of all methods and ticks."
                .to_owned(),
        ));
        blocks.push(cheapest(sheets));
        blocks.push(Block::Heading(2, "Grades".to_owned()));
        blocks.push(Block::Text(GRADES.to_owned()));
        blocks.push(grades(sheets));
    }
    estimates(sheets, &mut blocks);
    if !cases.is_empty() {
        hard(cases, &mut blocks);
    }
    for sheet in sheets {
        problem(sheet, peers, picture(sheet), &mut blocks);
    }
    blocks
}

fn cheapest(sheets: &[Sheet]) -> Block {
    let heads = ["problem", "its law"].map(str::to_owned).into_iter();
    let heads = heads.chain(TARGETS.iter().map(|(name, bound)| format!("{name}, {bound:e}"))).collect();
    let row = |sheet: &Sheet| {
        let reached = sheet.settings.advice().into_iter().map(|advice| {
            let setting = advice.reached.and_then(|setting| Some((setting, setting.seconds?)));
            let told = |(setting, seconds): (&Setting, f64)| {
                format!("{seconds:.1e}: {}, {} s", setting.course.name(), rounded(setting.tick))
            };
            Cell::from(setting.map_or_else(|| "none".to_owned(), told))
        });
        let names = [Cell::Link(sheet.problem.name.to_owned()), sheet.problem.law.into()];
        names.into_iter().chain(reached).collect()
    };
    Block::Table(heads, sheets.iter().map(row).collect())
}

fn grades(sheets: &[Sheet]) -> Block {
    let names = std::iter::once(ClockSection::AUTO).chain(methods().into_iter().map(|method| method.name));
    // If few methods are requested, the others have no column.
    let asked = |name: &&str| sheets.iter().any(|sheet| sheet.settings.all.iter().any(|s| s.course.method == *name));
    let names: Vec<&str> = names.filter(asked).collect();
    let row = |sheet: &Sheet| {
        let grade = |name: &&str| Cell::from(sheet.best_grade(name).unwrap_or("-"));
        std::iter::once(Cell::Link(sheet.problem.name.to_owned())).chain(names.iter().map(grade)).collect()
    };
    let heads = std::iter::once("problem").chain(names.iter().copied()).map(str::to_owned).collect();
    Block::Table(heads, sheets.iter().map(row).collect())
}

/// Estimates within this factor of the truth are good.
const FACTOR: f64 = 3.0;

fn estimates(sheets: &[Sheet], blocks: &mut Vec<Block>) {
    let all: Vec<&Checked> = sheets.iter().flat_map(|sheet| &sheet.estimates).collect();
    if all.is_empty() {
        return;
    }
    let outside = |checked: &&Checked| !(1.0 / FACTOR..=FACTOR).contains(&checked.ratio());
    let ratios = || all.iter().map(|checked| checked.ratio());
    let (least, most) = (ratios().fold(f64::INFINITY, f64::min), ratios().fold(0.0, f64::max));
    blocks.push(Block::Heading(2, "Estimates of runs against the truth".to_owned()));
    blocks.push(Block::Text(format!(
        "Each run estimates the distance of its places from the exact solution (`error` on its card). The truth beside it is \
         the distance from a reference run. The table has three methods at the three longest ticks at which errors fall with the tick. Of all estimates, {} of {} are within a factor of {FACTOR}. They are {least:.2} to {most:.2} times the truth. If finer runs cover only a part of a run (`until t = ..` on its card), both belong to that part.",
        all.len() - all.iter().copied().filter(outside).count(),
        all.len(),
    )));
    let far: Vec<&Checked> = all.iter().copied().filter(outside).collect();
    if !far.is_empty() {
        blocks.push(told(&far));
    }
    blocks.push(Block::Folded("all estimates".to_owned(), vec![told(&all)]));
}

fn told(estimates: &[&Checked]) -> Block {
    let heads = ["problem", "method", "tick in s", "estimate in m", "truth in m", "estimate over truth"];
    let row = |checked: &&Checked| {
        let Checked { problem, method, tick, estimated, truth } = **checked;
        let numbers =
            [rounded(tick), format!("{estimated:.2e}"), format!("{truth:.2e}"), format!("{:.2}", checked.ratio())];
        [Cell::from(problem), method.into()].into_iter().chain(numbers.map(Cell::from)).collect()
    };
    Block::Table(heads.map(str::to_owned).to_vec(), estimates.iter().map(row).collect())
}

fn hard(cases: &[Judged], blocks: &mut Vec<Block>) {
    blocks.push(Block::Heading(2, "Hard cases".to_owned()));
    blocks.push(Block::Text(HARD.to_owned()));
    let heads = ["case", "what is hard", "passed", "told", "failed"].map(str::to_owned).to_vec();
    let row = |judged: &&Judged| {
        let count = |verdict| Cell::from(judged.count(verdict).to_string());
        let [passed, told, failed] = [Judgement::Passed, Judgement::Told, Judgement::Failed].map(count);
        vec![judged.case.name.into(), judged.case.what.into(), passed, told, failed]
    };
    let run = || cases.iter().filter(|judged| judged.readings.is_some());
    blocks.push(Block::Table(heads, run().collect::<Vec<_>>().iter().map(row).collect()));
    let left: Vec<String> = cases
        .iter()
        .filter(|judged| judged.readings.is_none())
        .map(|judged| format!("`{}`", judged.case.name))
        .collect();
    if !left.is_empty() {
        blocks.push(Block::Text(format!("Left out, as they take longer: {}.", left.join(", "))));
    }
    let beyond = |verdict: Judgement| verdict != Judgement::Passed;
    if run().any(|judged| judged.readings.iter().flatten().any(|reading| beyond(reading.verdict()))) {
        blocks.push(Block::Text("Beyond their thresholds:".to_owned()));
        blocks.push(readings(run(), beyond));
    }
    for judged in run() {
        let all =
            vec![Block::Text(format!("Source: {}.", judged.case.source)), readings([judged].into_iter(), |_| true)];
        blocks.push(Block::Folded(format!("{}: all readings", judged.case.name), all));
    }
}

/// The readings of cases that came out as asked for.
fn readings<'a>(cases: impl Iterator<Item = &'a Judged>, wanted: impl Fn(Judgement) -> bool) -> Block {
    let heads =
        ["case", "measured", "value", "threshold", "", "where the threshold comes from"].map(str::to_owned).to_vec();
    let mut rows = Vec::new();
    for judged in cases {
        for reading in judged.readings.iter().flatten().filter(|reading| wanted(reading.verdict())) {
            let told = reading.told.as_ref().map_or_else(String::new, |told| format!(". The engine says: {told}"));
            let why = format!("{}{told}", reading.why);
            rows.push(vec![
                judged.case.name.into(),
                reading.what.clone().into(),
                rounded(reading.value).into(),
                reading.threshold.to_string().into(),
                word(reading.verdict()).into(),
                why.into(),
            ]);
        }
    }
    Block::Table(heads, rows)
}

fn problem(sheet: &Sheet, peers: &Peers, picture: Option<PagePicture>, blocks: &mut Vec<Block>) {
    let problem = &sheet.problem;
    blocks.push(Block::Heading(2, problem.name.to_owned()));
    let mut text = format!("{}. Source: {}.", crate::capital(problem.law), problem.source);
    if let Some(hash) = &sheet.hash {
        text.push_str(&format!(" State hash of `Auto` at a tick of {} s: `{hash}`.", rounded(problem.tick)));
    }
    blocks.push(Block::Text(text));
    blocks.extend(picture.map(Block::Picture));
    if !peers.curves(problem.name).is_empty() {
        blocks.push(Block::Text(Peers::caption(problem.name).to_owned()));
    }
    let unit = if problem.unit == "1" { ", no unit".to_owned() } else { format!(" in {}", problem.unit) };
    let error = format!("error{unit}");
    let heads = ["method", "tick in s", &error, "grade", "s per s", "evaluations per s"].map(str::to_owned).to_vec();
    let row = |setting: &Setting| {
        let error = match (setting.error(), failure(setting)) {
            (Some(error), _) => format!("{error:.2e}"),
            (None, why) => format!("does not run: {}", why.unwrap_or_default()),
        };
        let grade = sheet.grade(setting).unwrap_or_default();
        let evaluations = if setting.evaluations > 0.0 { rounded(setting.evaluations) } else { String::new() };
        vec![
            setting.course.name().into(),
            number(three(setting.tick)).into(),
            error.into(),
            grade.into(),
            setting.seconds.map_or_else(String::new, |seconds| format!("{seconds:.2e}")).into(),
            evaluations.into(),
        ]
    };
    let ends = sheet.settings.ends.iter().map(|(course, why)| vec![course.name().into(), why.as_str().into()]);
    let ends = Block::Table(["method", "why it goes no further"].map(str::to_owned).to_vec(), ends.collect());
    let all = Block::Table(heads, sheet.settings.all.iter().map(row).collect());
    blocks.push(Block::Folded("all settings".to_owned(), vec![all, ends]));
}

/// Three digits of a number.
fn three(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
