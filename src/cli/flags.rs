//! Flags that several commands share, and their readers. A wrong value is reported before any run.

use std::io::IsTerminal;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::say::say;
use crate::integrate::ClockSection;
use crate::integrate::Methods;
use crate::record::layers::WORDS;
use crate::record::sections::film;
use crate::scene::units::Time;
use crate::simd::Level;
use crate::simulation::Overrides;
use crate::tick::TickAppExt;

/// More threads than any machine of today makes use of.
const MOST_THREADS: usize = 1024;

/// The most frames in one picture that can be distinguished.
const MOST_FRAMES_IN_A_PICTURE: u32 = 400;

/// The influence of a verdict on the exit code.
#[derive(Args, Clone, Copy, Debug)]
pub(super) struct StrictFlag {
    /// Also exit with 3 if the verdict on the error card is `Do not trust it`
    #[arg(long)]
    pub strict: bool,
}

/// Flags that override the scene.
#[derive(Args, Clone, Debug)]
pub(super) struct OverrideFlags {
    /// Seconds of physics, instead of the scene's
    #[arg(long, value_name = "T", value_parser = above_zero, allow_negative_numbers = true)]
    pub duration: Option<f64>,
    /// Length of a tick, such as 0.001 or 1ms, instead of the scene's
    #[arg(long, value_name = "DT", value_parser = above_zero, allow_negative_numbers = true)]
    pub tick: Option<f64>,
    /// Integration method, instead of the scene's
    #[arg(long, value_name = "NAME", value_parser = methods())]
    pub method: Option<String>,
    /// Allow this error, instead of setting a tick. It is a share such as 1e-6 of how far and how fast bodies go
    #[arg(long, value_name = "X", value_parser = share, allow_negative_numbers = true, conflicts_with = "tick")]
    pub tolerance: Option<f64>,
    /// Use these vector instructions: scalar, baseline, avx2 or avx512. The results are the same to the bit. Default: the
    /// best that the processor has
    #[arg(long, value_name = "LEVEL")]
    pub simd: Option<Level>,
    /// Give a parameter of the scene (`params`) another value: a number or an expression. The flag may stand several times
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = setting)]
    pub settings: Vec<(String, String)>,
}

impl OverrideFlags {
    /// The requests that replace those of the scene.
    pub fn overrides(&self) -> Overrides {
        Overrides {
            tick: self.tick,
            method: self.method.clone(),
            tolerance: self.tolerance,
            duration: self.duration,
            level: self.simd,
            tell: Some(tell_trial),
            ..Overrides::default()
        }
    }
}

/// Reports the current trial of a scene on a terminal.
fn tell_trial(number: u32, what: &str) {
    if std::io::stderr().is_terminal() {
        say(&format!("finding the steps: run {number}, {what}"));
    }
}

/// The registered methods: an integrator that registers itself is offered here without a second list.
fn methods() -> PossibleValuesParser {
    let names = [ClockSection::AUTO, ClockSection::REFERENCE].into_iter().chain(registered());
    PossibleValuesParser::new(names.collect::<Vec<_>>())
}

/// The registered methods, without those that choose or judge others.
pub(super) fn registered_methods() -> PossibleValuesParser {
    PossibleValuesParser::new(registered())
}

fn registered() -> Vec<&'static str> {
    let mut app = bevy_app::App::empty();
    app.add_tick();
    crate::plugins::standard(&mut app);
    crate::cli::author::plugin(&mut app);
    let registered = app.world().get_resource::<Methods>().map_or_else(Vec::new, |methods| methods.0.clone());
    registered.into_iter().map(|method| method.name).collect()
}

/// A parameter and its value.
pub(super) fn setting(text: &str) -> Result<(String, String), String> {
    let parts = text.split_once('=').map(|(name, value)| (name.trim(), value.trim()));
    let good = parts.filter(|(name, value)| !name.is_empty() && !value.is_empty());
    good.map(|(name, value)| (name.to_owned(), value.to_owned()))
        .ok_or_else(|| "expected a parameter and its value, such as n=9 or gap=\"2 cm\"".to_owned())
}

/// A share of the motion.
fn share(text: &str) -> Result<f64, String> {
    let value = text.trim().parse().ok().filter(|value| (f64::MIN_POSITIVE..1.0).contains(value));
    value.ok_or_else(|| "expected a share above zero and below one, such as 1e-6".to_owned())
}

/// A time as in a scene: a number of seconds, or a number with its unit.
fn time(text: &str) -> Option<f64> {
    let text = text.trim();
    text.parse().ok().or_else(|| Time::parse(text).ok().map(Time::si))
}

/// A time above zero.
pub(super) fn above_zero(text: &str) -> Result<f64, String> {
    let value = time(text).filter(|value| value.is_finite() && *value > 0.0);
    value.ok_or_else(|| "expected a time above zero, such as 0.5 (seconds) or 20ms".to_owned())
}

/// A time, zero or later.
pub(super) fn moment(text: &str) -> Result<f64, String> {
    let value = time(text).filter(|value| value.is_finite() && *value >= 0.0);
    value.ok_or_else(|| "expected a time, zero or later, such as 1.5 (seconds) or 20ms".to_owned())
}

/// Width and height of a picture.
pub(super) fn size(text: &str) -> Result<(u32, u32), String> {
    let largest = film::LARGEST_SIZE as u32;
    let side = |text: &str| text.parse().ok().filter(|side| (16..=largest).contains(side));
    let sides = text.split_once(['x', 'X']).and_then(|(width, height)| Some((side(width)?, side(height)?)));
    sides.ok_or_else(|| format!("expected width and height in pixels such as 1280x720, each from 16 to {largest}"))
}

/// Frames per second.
pub(super) fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse::<f64>().ok().filter(|rate| (0.01..=1000.0).contains(rate));
    rate.ok_or_else(|| "expected frames per second, from 0.01 to 1000".to_owned())
}

/// Rows of a table for each second.
pub(super) fn rows(text: &str) -> Result<f64, String> {
    let rate = text.parse::<f64>().ok().filter(|rate| (1e-3..=1e9).contains(rate));
    rate.ok_or_else(|| "expected rows for each second of physics, from 0.001 to 1e9".to_owned())
}

/// Times from early to late, separated by commas.
pub(super) fn moments(text: &str) -> Result<Moments, String> {
    let times = text.split(',').map(moment).collect::<Result<Vec<f64>, _>>();
    let times = times.map_err(|_| "expected times separated by commas, such as 0,0.5,1 or 0,20ms".to_owned())?;
    if times.len() as u32 > MOST_FRAMES_IN_A_PICTURE {
        return Err(format!("expected at most {MOST_FRAMES_IN_A_PICTURE} times, got {}", times.len()));
    }
    match times.windows(2).find(|pair| pair[1] <= pair[0]) {
        Some(pair) => Err(format!("expected times from early to late, but {} comes after {}", pair[1], pair[0])),
        None => Ok(Moments(times)),
    }
}

/// The value of `--strip`: one value, not several of a list.
#[derive(Clone, Debug)]
pub(super) struct Moments(pub Vec<f64>);

/// Layers of a film, separated by commas.
pub(super) fn layers(text: &str) -> Result<LayerWords, String> {
    let known = || WORDS.iter().map(|(word, _)| *word);
    let words: Vec<String> = text.split(',').map(|word| word.trim().to_owned()).collect();
    if words == ["none"] {
        return Ok(LayerWords(Vec::new()));
    }
    match words.iter().find(|word| !known().any(|known| known == **word)) {
        Some(wrong) => {
            let known = known().collect::<Vec<_>>().join(", ");
            Err(format!("there is no layer `{wrong}`; layers are {known}, separated by commas, or none of them: none"))
        }
        None => Ok(LayerWords(words)),
    }
}

/// The value of `--layers`: one value, not several of a list.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LayerWords(pub Vec<String>);

/// Columns and rows of a contact sheet.
pub(super) fn sheet(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|side| (1..=MOST_FRAMES_IN_A_PICTURE).contains(side));
    let sides = text.split_once(['x', 'X']).and_then(|(columns, rows)| Some((side(columns)?, side(rows)?)));
    let sides = sides.filter(|(columns, rows)| columns * rows <= MOST_FRAMES_IN_A_PICTURE);
    sides.ok_or_else(|| {
        format!("expected columns and rows such as 4x3, at most {MOST_FRAMES_IN_A_PICTURE} frames in all")
    })
}

/// The units of `--max-size`, in bytes.
const UNITS: [(&str, f64); 7] = [
    ("GiB", 1_073_741_824.0),
    ("MiB", 1_048_576.0),
    ("KiB", 1024.0),
    ("GB", 1e9),
    ("MB", 1e6),
    ("kB", 1e3),
    ("B", 1.0),
];

/// The size of a file in bytes.
pub(super) fn bytes(text: &str) -> Result<u64, String> {
    let lower = text.trim().to_lowercase();
    let unit = UNITS.iter().find_map(|(unit, bytes)| Some((lower.strip_suffix(&unit.to_lowercase())?, *bytes)));
    let (number, unit) = unit.unwrap_or((&lower, 1.0));
    let bytes = number.trim().parse::<f64>().ok().map(|number| number * unit);
    let bytes = bytes.filter(|bytes| (1.0..=1e15).contains(bytes));
    bytes.map(|bytes| bytes as u64).ok_or_else(|| "expected a size such as 2MB, 500kB or 1.5MiB".to_owned())
}

/// A size in the unit that suits it.
pub(super) fn bytes_in_words(bytes: f64) -> String {
    match bytes {
        small if small < 1e3 => format!("{small:.0} B"),
        medium if medium < 1e6 => format!("{:.0} kB", (medium / 1e3).ceil()),
        large => format!("{:.1} MB", large / 1e6),
    }
}

/// A number of threads.
pub(super) fn threads(text: &str) -> Result<usize, String> {
    let threads = text.parse().ok().filter(|threads| (1..=MOST_THREADS).contains(threads));
    threads.ok_or_else(|| format!("expected a whole number from 1 to {MOST_THREADS}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_as_in_scenes() {
        for (text, seconds) in [("1", 1.0), ("1e-3", 1e-3), ("1 ms", 1e-3), ("20ms", 0.02), (" 2 s ", 2.0)] {
            assert_eq!(above_zero(text), Ok(seconds), "{text}");
        }
        for text in ["0", "-1", "nan", "inf", "1e400", "1 kg", "", "ms"] {
            assert!(above_zero(text).is_err(), "{text}");
        }
        assert_eq!(moment("0"), Ok(0.0));
        assert!(moment("-0.1").is_err());
    }

    #[test]
    fn sizes_of_files_are_read_with_their_units() {
        for (text, expected) in
            [("2MB", 2_000_000), ("1.5 mb", 1_500_000), ("500kB", 500_000), ("1KiB", 1024), ("7", 7)]
        {
            assert_eq!(bytes(text), Ok(expected), "{text}");
        }
        for text in ["", "MB", "0", "-1MB", "2 apples", "nan", "1e99GB"] {
            assert!(bytes(text).is_err(), "{text}");
        }
    }

    #[test]
    fn sizes_of_files_are_told_in_their_unit() {
        for (bytes, expected) in [(2.0, "2 B"), (999.0, "999 B"), (1000.0, "1 kB"), (1001.0, "2 kB"), (2.4e6, "2.4 MB")]
        {
            assert_eq!(bytes_in_words(bytes), expected);
        }
    }

    #[test]
    fn strips_and_sheets_are_bounded() {
        assert_eq!(moments("0,0.5, 20 s").map(|moments| moments.0), Ok(vec![0.0, 0.5, 20.0]));
        for text in ["", "0,,1", "1,0.5", "1,1", "-1,2"] {
            assert!(moments(text).is_err(), "{text}");
        }
        assert_eq!(sheet("4x3"), Ok((4, 3)));
        for text in ["0x3", "4", "4x", "x3", "400x2", "99999999999x1"] {
            assert!(sheet(text).is_err(), "{text}");
        }
    }

    #[test]
    fn layers_are_named_by_words() {
        assert_eq!(layers("trails, time").map(|words| words.0), Ok(vec!["trails".to_owned(), "time".to_owned()]));
        assert_eq!(layers("none"), Ok(LayerWords(Vec::new())));
        for text in ["", "trail", "trails,", "none,trails", "Trails"] {
            assert!(layers(text).is_err(), "{text}");
        }
    }

    #[test]
    fn sizes_are_bounded() {
        assert_eq!(size("1280x720"), Ok((1280, 720)));
        assert_eq!(size("16X8192"), Ok((16, 8192)));
        for text in ["0x0", "1e9x1", "15x16", "8193x16", "-16x16", "16", "16x", "16x16x16", "99999999999x16"] {
            assert!(size(text).is_err(), "{text}");
        }
    }
}
