//! Names of colours and themes, which scenes use and the painter knows.

/// The themes that come with the program: name and RON text. The first is the default.
pub const THEMES: [(&str, &str); 3] = [
    ("paper", include_str!("../../assets/themes/paper.ron")),
    ("night", include_str!("../../assets/themes/night.ron")),
    ("print", include_str!("../../assets/themes/print.ron")),
];

/// The names of colours that every theme has, in the order of its palette.
pub const COLOR_NAMES: [&str; 14] = [
    "sky",
    "orange",
    "teal",
    "pink",
    "blue",
    "yellow",
    "vermilion",
    "green",
    "purple",
    "brown",
    "red",
    "grey",
    "white",
    "black",
];
