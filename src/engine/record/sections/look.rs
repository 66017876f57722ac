//! `look`: the appearance of films. It never changes the physics.

use bevy_app::App;
use bevy_ecs::resource::Resource;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::values::Elsewhere;
use crate::scene::{Diagnostics, Outline, Section, suggest};

/// The list of words for themes that come with the program.
pub const THEMES: &str = "theme";

/// The list of entries inside this section: the layers of a film.
pub const LAYERS: &str = "look.layers";

/// The layers that may occur more than once, with other bodies or another position each time.
const REPEATABLE: [&str; 2] = ["Trails", "Inset"];

/// The look of films. It never changes the physics.
#[derive(Resource, Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Look")]
pub struct LookSection {
    /// The colours: the name of a theme of the program, or of a `.ron` file beside the scene. Default: `"paper"`.
    #[serde(default)]
    pub theme: Option<String>,
    /// The layers beside bodies, walls and title. Default: `[ScaleBar, Time]`.
    #[serde(default)]
    pub layers: Elsewhere,
}

impl LookSection {
    /// Whether a theme is a file, not one that comes with the program.
    pub fn is_file(theme: &str) -> bool {
        theme.ends_with(".ron")
    }
}

impl Section for LookSection {
    const NAME: &'static str = "look";
    const EXAMPLE: &'static str =
        "look: (theme: \"night\", layers: [Trails(seconds: 1), ContactForces, ScaleBar, Time])";

    /// Reports an unknown theme, and duplicate layers.
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        if let Some(theme) = self.theme.as_deref().filter(|theme| !Self::is_file(theme))
            && outline.word(THEMES, theme).is_none()
        {
            let known = suggest::among(
                theme,
                outline.words(THEMES).map(|(name, _)| name).collect::<Vec<_>>().into_iter(),
                "themes",
                '"',
            );
            let help = format!("{known}; a theme of your own is a file such as \"mine.ron\"");
            report.error("theme", format!("there is no theme \"{theme}\"")).help(help);
        }
        let mentions = outline.entries(LAYERS);
        for (index, mention) in mentions.iter().enumerate() {
            if !REPEATABLE.contains(&mention.name.as_str())
                && mentions[..index].iter().any(|before| before.name == mention.name)
            {
                let message = format!("the layer `{}` stands here twice", mention.name);
                report.error(&format!("layers[{index}]"), message).help("keep one of the two");
            }
        }
    }

    fn install(self, _: &Outline, app: &mut App) {
        app.insert_resource(self);
    }
}
