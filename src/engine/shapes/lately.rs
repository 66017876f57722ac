//! The latest answers of a function of hulls. A scene names equal shapes many times, and each body asks for its own several times. To
//! compare them takes far less time than to cut them.

use std::collections::VecDeque;

use jostle_shapes::Hull;

/// So many answers are kept.
const MOST: usize = 8;

/// Fewer hulls take no time, and more would take too much memory.
const KEPT: std::ops::RangeInclusive<usize> = 16..=10_000;

/// The latest questions with their answers.
#[derive(Debug)]
pub(super) struct Lately<T>(VecDeque<(Vec<Hull>, T)>);

impl<T: Clone> Lately<T> {
    pub const fn new() -> Self {
        Self(VecDeque::new())
    }

    /// The answer for some hulls, which `answer` finds if they were not among the latest.
    pub fn get(&mut self, hulls: &[Hull], answer: impl FnOnce() -> T) -> T {
        if !KEPT.contains(&hulls.len()) {
            return answer();
        }
        if let Some((_, known)) = self.0.iter().find(|(asked, _)| asked == hulls) {
            return known.clone();
        }
        let found = answer();
        self.0.truncate(MOST - 1);
        self.0.push_front((hulls.to_vec(), found.clone()));
        found
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    fn hulls(radius: f64) -> Vec<Hull> {
        (0..20).map(|at| Hull::disc(DVec2::new(f64::from(at), 0.0), radius).expect("a disc")).collect()
    }

    #[test]
    fn equal_hulls_are_asked_for_once() {
        let (mut lately, mut asked) = (Lately::new(), 0);
        for radius in [0.1, 0.1, 0.2, 0.1, 0.2] {
            let found = lately.get(&hulls(radius), || {
                asked += 1;
                radius
            });
            assert_eq!(found, radius);
        }
        assert_eq!(asked, 2);
    }

    #[test]
    fn the_oldest_are_forgotten_first() {
        let mut lately = Lately::new();
        (0..=MOST).for_each(|number| lately.get(&hulls(1.0 + number as f64), || ()));
        assert_eq!(lately.0.len(), MOST);
        let mut anew = false;
        lately.get(&hulls(1.0), || anew = true);
        assert!(anew);
    }
}
