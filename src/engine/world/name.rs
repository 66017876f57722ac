//! Names of bodies and walls.

use std::fmt;
use std::sync::Arc;

use bevy_ecs::prelude::*;

use crate::scene::name_series;

/// Name of a body or wall in the scene. `to_string()` gives it, and it can be compared with a text. Names of a series,
/// such as `gas_0` and `gas_1`, share their prefix.
#[derive(Component, Clone, Debug, Default)]
pub struct Name {
    /// The name, or the prefix of its series; `None` for an empty name. It is behind one pointer, and not a pointer and
    /// a length.
    text: Option<Arc<String>>,
    /// The number in its series.
    number: Option<u32>,
}

impl Name {
    /// One of a series.
    pub(super) fn of_series(prefix: &Arc<String>, number: usize) -> Self {
        let number = u32::try_from(number).expect("series are shorter than that");
        Self { text: Some(Arc::clone(prefix)), number: Some(number) }
    }
}

impl From<String> for Name {
    fn from(text: String) -> Self {
        Self { text: (!text.is_empty()).then(|| Arc::new(text)), number: None }
    }
}

impl From<&str> for Name {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

impl fmt::Display for Name {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match (&self.text, self.number) {
            (None, _) => Ok(()),
            (Some(text), None) => out.pad(text),
            (Some(prefix), Some(number)) => out.pad(&name_series::of_series(prefix, number.into())),
        }
    }
}

impl PartialEq<str> for Name {
    fn eq(&self, other: &str) -> bool {
        match (&self.text, self.number) {
            (None, _) => other.is_empty(),
            (Some(text), None) => **text == other,
            (Some(prefix), Some(number)) => name_series::in_series(other) == Some((prefix, number.into())),
        }
    }
}

impl PartialEq for Name {
    fn eq(&self, other: &Self) -> bool {
        *self == *other.to_string()
    }
}

impl Eq for Name {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_of_a_series_is_like_one_that_is_written_out() {
        let prefix = Arc::new("gas_3".to_owned());
        let name = Name::of_series(&prefix, 10);
        assert_eq!(name.to_string(), "gas_3_10");
        assert_eq!(name, Name::from("gas_3_10"));
        assert_eq!(Name::from("gas_3_10"), name);
        for other in ["", "gas_3", "gas_3_1", "gas_3_010", "gas_3_100", "gas_10"] {
            assert!(name != *other, "{other}");
            assert_ne!(Name::from(other), name, "{other}");
        }
        assert!(Name::default() == *"");
        assert_eq!(Name::default(), Name::from(""));
        assert_eq!(format!("[{name:>10}]"), "[  gas_3_10]");
    }
}
