//! `--vary NAME=VALUES`: the varied quantities, and the grid of all combinations.

use crate::cli::say::number;
use crate::scene::Source;

/// The most runs of a sweep. More rows are unreadable, and each takes time.
pub(super) const MOST_RUNS: usize = 100_000;

/// A parameter or path, and its values in the form of the scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Variation {
    pub name: String,
    pub values: Vec<String>,
}

/// Reads `NAME=VALUES`.
pub(crate) fn variation(text: &str) -> Result<Variation, String> {
    let parts = text.split_once('=').map(|(name, values)| (name.trim(), values.trim()));
    let Some((name, values)) = parts.filter(|(name, values)| !name.is_empty() && !values.is_empty()) else {
        return Err("expected a name and its values, such as gravity[1]=-1..-10:10 or seed=1..5".to_owned());
    };
    let values = split(values).into_iter().map(|part| range(part.trim())).collect::<Result<Vec<_>, _>>()?.concat();
    let twice = values.iter().enumerate().find(|(index, value)| values[..*index].contains(value));
    match (twice, values.iter().find(|value| value.is_empty())) {
        (_, Some(_)) => Err(format!("a value of `{name}` is missing: two commas in a row")),
        (Some((_, value)), _) => Err(format!("`{name}` takes the value {value} twice")),
        (None, None) => Ok(Variation { name: name.to_owned(), values }),
    }
}

/// The parts of a list: commas in brackets and quotes do not count.
fn split(text: &str) -> Vec<&str> {
    let (mut depth, mut quoted, mut start) = (0_i32, false, 0);
    let mut parts = Vec::new();
    for (index, letter) in text.char_indices() {
        match letter {
            '"' => quoted = !quoted,
            '(' | '[' | '{' if !quoted => depth += 1,
            ')' | ']' | '}' if !quoted => depth -= 1,
            ',' if depth == 0 && !quoted => {
                parts.push(&text[start..index]);
                start = index + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts
}

/// The values of `a..b`, `a..b:n` or `a..b:n:log`; anything else is one value.
fn range(text: &str) -> Result<Vec<String>, String> {
    let Some((from, rest)) = text.split_once("..").filter(|_| !text.starts_with(['(', '[', '{', '"'])) else {
        return Ok(vec![text.to_owned()]);
    };
    let mut rest = rest.split(':');
    let (to, count, spacing) = (rest.next().unwrap_or_default(), rest.next(), rest.next());
    let wrong = |why: &str| {
        format!("`{text}` is no range: {why}; write 1..5 (whole numbers), 0..1:11 (eleven values) or 1..100:3:log")
    };
    let (from, unit_from) = measure(from).ok_or_else(|| wrong("it does not begin with a number"))?;
    let (to, unit) = measure(to).ok_or_else(|| wrong("it does not end with a number"))?;
    if !unit_from.is_empty() && unit_from != unit {
        return Err(wrong("both ends need the same unit"));
    }
    if rest.next().is_some() || spacing.is_some_and(|spacing| spacing.trim() != "log") {
        return Err(wrong("after the number of values only `:log` may stand"));
    }
    let count = match count {
        Some(count) => count.trim().parse().map_err(|_| wrong("the number of values is no whole number"))?,
        None if from.fract() == 0.0 && to.fract() == 0.0 => (to - from).abs() as usize + 1,
        None => return Err(wrong("say how many values")),
    };
    if count == 0 || count > MOST_RUNS || (count == 1 && from != to) {
        return Err(wrong(&format!("the number of values must lie between 2 and {MOST_RUNS}")));
    }
    if spacing.is_some() && (from <= 0.0 || to <= 0.0) {
        return Err(wrong("logarithmic steps need ends above zero"));
    }
    let value = |index: usize| {
        let share = |a: f64, b: f64| a + (b - a) * index as f64 / (count - 1).max(1) as f64;
        let value = match index {
            0 => from,
            last if last == count - 1 => to,
            _ if spacing.is_some() => libm::exp(share(libm::log(from), libm::log(to))),
            _ => share(from, to),
        };
        format!("{}{unit}", number(value))
    };
    Ok((0..count).map(value).collect())
}

/// A finite number and the unit after it.
fn measure(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let mut ends = text.char_indices().map(|(index, letter)| index + letter.len_utf8());
    let end = ends.rfind(|&end| text[..end].parse::<f64>().is_ok_and(f64::is_finite))?;
    Some((text[..end].parse().ok()?, &text[end..]))
}

/// All combinations; the last variation changes fastest.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grid<'a> {
    pub variations: &'a [Variation],
    pub runs: usize,
}

impl<'a> Grid<'a> {
    /// The grid, unless it has too many runs.
    pub fn new(variations: &'a [Variation]) -> Result<Self, String> {
        let sizes = variations.iter().map(|variation| variation.values.len());
        let runs = sizes.fold(1_usize, usize::saturating_mul);
        if runs > MOST_RUNS {
            return Err(format!("these are {runs} runs; a sweep makes at most {MOST_RUNS}"));
        }
        Ok(Self { variations, runs })
    }

    /// The values of a run, counted from 0.
    pub fn values(&self, run: usize) -> Vec<&'a str> {
        let mut left = run;
        let mut values = vec![""; self.variations.len()];
        for (index, variation) in self.variations.iter().enumerate().rev() {
            values[index] = &variation.values[left % variation.values.len()];
            left /= variation.values.len();
        }
        values
    }

    /// The scene of a run. A name in the scene's `params` is set, and any other name is a path into the text.
    pub fn scene(&self, source: &Source, run: usize) -> Result<Source, String> {
        let params = source.params();
        let mut scene = source.clone();
        for (variation, value) in self.variations.iter().zip(self.values(run)) {
            let Variation { name, .. } = variation;
            scene = if params.contains(name) {
                scene.with_settings(&[(name.clone(), value.to_owned())])
            } else {
                scene.with_value(name, value)?
            };
        }
        Ok(scene)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        variation(&format!("x={text}")).unwrap_or_else(|error| panic!("{text}: {error}")).values
    }

    #[test]
    fn values_are_ranges_and_lists() {
        for (text, expected) in [
            ("1..4", "1 2 3 4"),
            ("2..-1", "2 1 0 -1"),
            ("0..1:11", "0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1"),
            ("-1..-10:4", "-1 -4 -7 -10"),
            ("1..100:3:log", "1 10 100"),
            ("1e-3..1e3:3:log", "0.001 1 1000"),
            ("1..2cm:3", "1cm 1.5cm 2cm"),
            ("1,2.5,-3", "1 2.5 -3"),
            ("1..3,7", "1 2 3 7"),
            ("a,\"b, c\"", "a \"b, c\""),
            ("(0, 1),(2, 3)", "(0, 1) (2, 3)"),
        ] {
            assert_eq!(values(text).join(" "), expected, "{text}");
        }
        assert_eq!(values("1 ms,20 ms"), ["1 ms", "20 ms"]);
    }

    #[test]
    fn ranges_that_cannot_be_are_refused() {
        for text in [
            "1..2.5",
            "1..b",
            "..3",
            "1..2:0",
            "1..2:1",
            "1..2:x",
            "0..1:3:log",
            "1..2:3:lin",
            "1cm..2m:3",
            "1..9e9",
            "1,,2",
            "1,1",
            "",
        ] {
            assert!(variation(&format!("x={text}")).is_err(), "{text}");
        }
        assert!(variation("=1").is_err() && variation("x").is_err());
    }

    #[test]
    fn the_last_one_changes_fastest() {
        let variations = [variation("a=1..2").unwrap(), variation("b=x,y,z").unwrap()];
        let grid = Grid::new(&variations).unwrap();
        let all: Vec<String> = (0..grid.runs).map(|run| grid.values(run).concat()).collect();
        assert_eq!(all, ["1x", "1y", "1z", "2x", "2y", "2z"]);
        let many = ["a=1..1000", "b=1..1000"].map(|text| variation(text).unwrap());
        assert!(Grid::new(&many).is_err());
    }
}
