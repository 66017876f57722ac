//! The legend of a film: its colours, and a few facts of its scene, as plain data.

/// A legend: entries, and lines of facts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Legend {
    /// Bodies first, then what layers draw.
    pub entries: Vec<LegendEntry>,
    /// The number of further lines of bodies: no legend shows more than a few.
    pub more: usize,
    /// Short lines on the scene: how many bodies, gravity, tick.
    pub facts: Vec<String>,
}

/// One line of a legend.
#[derive(Clone, Debug, PartialEq)]
pub struct LegendEntry {
    /// The words.
    pub label: String,
    /// The picture.
    pub mark: LegendMark,
}

/// The mark before a line of a legend.
#[derive(Clone, Debug, PartialEq)]
pub enum LegendMark {
    /// A patch in the colour of the body at this place of the cast.
    Body(usize),
    /// An arrow in a colour of the theme, or `"#rrggbb"`; `None`: ink.
    Arrow(Option<String>),
    /// A line; see [`LegendMark::Arrow`].
    Line(Option<String>),
    /// A ring; see [`LegendMark::Arrow`].
    Ring(Option<String>),
}
