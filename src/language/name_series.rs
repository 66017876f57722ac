//! Names in the order of the file. A series such as `gas_0`, `gas_1` keeps only its prefix.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use super::outline::fits;

/// The name of one member of a series.
pub fn of_series(prefix: &str, number: u64) -> String {
    format!("{prefix}_{number}")
}

/// The prefix and number of a name that [`of_series`] made, or `None` for other names.
pub fn in_series(name: &str) -> Option<(&str, u64)> {
    let (prefix, digits) = name.rsplit_once('_')?;
    let canonical = digits == "0" || !digits.starts_with('0');
    let number = digits.bytes().all(|byte| byte.is_ascii_digit()) && canonical;
    number.then(|| digits.parse().ok()).flatten().map(|number| (prefix, number))
}

/// A name, or a series of them.
#[derive(Clone, Debug)]
struct Run {
    /// Place of the first.
    first: usize,
    /// The name, or the prefix of a series.
    name: String,
    /// The length of the series, or `None` for a single name.
    numbered: Option<u64>,
    /// The path in the scene.
    path: String,
}

impl Run {
    fn names(&self) -> impl Iterator<Item = String> {
        let name = move |number| match self.numbered {
            Some(_) => of_series(&self.name, number),
            None => self.name.clone(),
        };
        (0..self.numbered.unwrap_or(1)).map(name)
    }
}

/// Names of one kind, each once.
#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    runs: Vec<Run>,
    len: usize,
    /// Single names, and which run they are.
    single: BTreeMap<String, usize>,
    /// The prefixes of series, and their runs.
    series: BTreeMap<String, usize>,
    /// All names, written out on first use.
    list: OnceLock<Vec<String>>,
}

impl Names {
    /// The number of them.
    pub fn len(&self) -> usize {
        self.len
    }

    /// All of them, in order.
    pub fn list(&self) -> &[String] {
        self.list.get_or_init(|| self.runs.iter().flat_map(Run::names).collect())
    }

    /// The index of a name, and its path in the scene.
    pub fn find(&self, name: &str) -> Option<(usize, &str)> {
        if let Some(&run) = self.single.get(name) {
            let run = &self.runs[run];
            return Some((run.first, &run.path));
        }
        let (prefix, number) = in_series(name)?;
        let run = &self.runs[*self.series.get(prefix)?];
        (number < run.numbered?).then(|| (run.first + number as usize, run.path.as_str()))
    }

    /// The places of all names that fit a pattern.
    pub fn matching(&self, pattern: &str) -> Vec<usize> {
        let names = self.list().iter().enumerate();
        names.filter(|(_, name)| fits(pattern, name)).map(|(index, _)| index).collect()
    }

    /// Adds a name that is new.
    pub fn add(&mut self, name: &str, path: String) {
        self.single.insert(name.to_owned(), self.runs.len());
        self.push(Run { first: self.len, name: name.to_owned(), numbered: None, path });
    }

    /// Adds a series of new names.
    pub fn add_series(&mut self, prefix: &str, count: u64, path: String) {
        if count > 0 {
            self.series.insert(prefix.to_owned(), self.runs.len());
            self.push(Run { first: self.len, name: prefix.to_owned(), numbered: Some(count), path });
        }
    }

    fn push(&mut self, run: Run) {
        self.len += run.numbered.unwrap_or(1) as usize;
        self.runs.push(run);
        self.list = OnceLock::new();
    }

    /// The first number of a series of so many whose name is taken.
    pub fn first_taken(&self, prefix: &str, count: u64) -> Option<u64> {
        if count > 0 && self.series.contains_key(prefix) {
            return Some(0);
        }
        let begin = format!("{prefix}_");
        let alike = self.single.range(begin.clone()..).take_while(|(name, _)| name.starts_with(&begin));
        let numbers = alike.filter_map(|(name, _)| in_series(name)).filter(|(of, _)| *of == prefix);
        numbers.map(|(_, number)| number).filter(|&number| number < count).min()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_stands_for_its_names() {
        let mut names = Names::default();
        names.add("gas", "bodies[0].name".to_owned());
        names.add_series("gas", 11, "fill[0].name".to_owned());
        names.add("gas_011", "walls[0].name".to_owned());
        assert_eq!(names.len(), 13);
        assert_eq!(names.list()[..3], ["gas", "gas_0", "gas_1"]);
        for (index, name) in names.list().iter().enumerate() {
            assert_eq!(names.find(name).map(|(index, _)| index), Some(index), "{name}");
        }
        for name in ["gas_11", "gas_00", "gas_+1", "gas_", "_1", "gas_1_1", "gas_99999999999999999999"] {
            assert_eq!(names.find(name), None, "{name}");
        }
        assert_eq!(names.find("gas_10"), Some((11, "fill[0].name")));
        assert_eq!(names.matching("gas_1*"), [2, 11]);
    }

    #[test]
    fn the_first_name_that_is_taken_is_found() {
        let mut names = Names::default();
        for name in ["gas_7", "gas_30", "gas_007", "gas_x", "gas_3_1"] {
            names.add(name, String::new());
        }
        assert_eq!((names.first_taken("gas", 7), names.first_taken("gas", 8)), (None, Some(7)));
        assert_eq!((names.first_taken("gas", 31), names.first_taken("gas_3", 2)), (Some(7), Some(1)));
        names.add_series("gas", 7, String::new());
        assert_eq!((names.first_taken("gas", 1), names.first_taken("ga", 1)), (Some(0), None));
    }
}
