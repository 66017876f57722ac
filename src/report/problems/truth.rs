//! Reference values: JSON files in `assets/truths`, made with 40 digits or checked by two independent methods each.

use serde_json::Value;

/// A file of reference values.
pub struct Truth(Value);

impl Truth {
    /// Reads a file that is part of the engine.
    ///
    /// # Panics
    /// When the text is not JSON.
    pub fn read(text: &str) -> Self {
        Self(serde_json::from_str(text).expect("a truth file is JSON"))
    }

    /// All numbers of an observable, row by row.
    ///
    /// # Panics
    /// When there is no such observable.
    pub fn numbers(&self, observable: &str) -> Vec<f64> {
        let mut numbers = Vec::new();
        flatten(&self.observable(observable)["value"], &mut numbers);
        numbers
    }

    /// The number that an observable is.
    ///
    /// # Panics
    /// When there is no such observable, or it is not one number.
    pub fn number(&self, observable: &str) -> f64 {
        let numbers = self.numbers(observable);
        assert_eq!(numbers.len(), 1, "{observable} is one number");
        numbers[0]
    }

    /// Times in seconds at which an observable is given.
    ///
    /// # Panics
    /// When there is no such observable.
    pub fn times(&self, observable: &str) -> Vec<f64> {
        let mut times = Vec::new();
        flatten(&self.observable(observable)["t"], &mut times);
        times
    }

    /// The numbers of an observable at one of the times at which it is given; `None` at others.
    ///
    /// # Panics
    /// When there is no such observable.
    pub fn row(&self, observable: &str, time: f64) -> Option<Vec<f64>> {
        let (times, numbers) = (self.times(observable), self.numbers(observable));
        let index = times.iter().position(|&known| known == time)?;
        let width = numbers.len() / times.len();
        Some(numbers[index * width..(index + 1) * width].to_vec())
    }

    fn observable(&self, name: &str) -> &Value {
        let all = self.0["observables"].as_array().expect("a truth file lists observables");
        all.iter().find(|observable| observable["name"] == name).unwrap_or_else(|| panic!("no observable `{name}`"))
    }
}

fn flatten(value: &Value, numbers: &mut Vec<f64>) {
    match value {
        Value::Array(items) => items.iter().for_each(|item| flatten(item, numbers)),
        _ => numbers.extend(value.as_f64()),
    }
}
