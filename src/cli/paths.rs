//! Paths of types and functions, as users of the crate `jostle` name them.

/// The rooms, and the paths by which `jostle` re-exports their contents.
const ROOMS: [(&str, &str); 3] =
    [("jostle_engine::", "jostle::"), ("jostle_film::", "jostle::"), ("jostle_report::", "jostle::report::")];

/// A path, and all paths within it, as `jostle` re-exports them.
pub(super) fn handed_on(path: &str) -> String {
    ROOMS.into_iter().fold(path.to_owned(), |path, (room, handed_on)| path.replace(room, handed_on))
}

#[cfg(test)]
mod tests {
    use super::handed_on;

    #[test]
    fn rooms_have_the_names_of_jostle() {
        assert_eq!(handed_on("jostle_engine::forces::drag::Drag"), "jostle::forces::drag::Drag");
        assert_eq!(handed_on("mine::Wind<jostle_report::card::Card>"), "mine::Wind<jostle::report::card::Card>");
    }
}
