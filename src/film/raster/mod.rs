//! From a frame, a camera and a theme to a picture. It is a pure function: the same frame always gives the same bytes.
//!
//! The immobile parts (background, grid, walls, fixed bodies, title) are drawn once and copied into each frame. One
//! thread draws a whole frame; several frames may be drawn at once.

mod camera;
mod canvas;
mod font;
mod layers;
mod light;
mod plots;
mod silhouette;
mod text;
mod theme;

use std::sync::Arc;

use tiny_skia::Pixmap;

pub use camera::{Camera, WorldRectangle};
pub use plots::{Diagram, Look, Panel, Sign, Spot, draw_diagram, figure};
pub use theme::{Swatch, Theme, Tint};

use canvas::Canvas;
use jostle_frames::frame::{BodyLook, Cast, Frame, Rgb};
use jostle_frames::mark::MarkShape;
use layers::bodies::Figure;
use layers::clock::Clock;
use layers::insets::Inset;
use layers::labels::{Column, longest_word};
use layers::title::Title;
use layers::trails::{Cover, Trail};
use layers::writing::Writing;
use layers::{backdrop, marks, scales, walls};
use plots::{Cards, Tools};
use silhouette::Field;
use text::{Lettering, Weight};

/// How a film looks at the world.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// The position of the camera, and the size of the picture.
    pub camera: Camera,
    /// The colours.
    pub theme: Theme,
    /// The time from frame to frame in seconds of physics. The clock shows enough decimals to distinguish frames.
    pub frame_step: f64,
    /// The panel beside the film. The camera's picture takes the remaining space.
    pub panel: Option<Panel>,
}

impl View {
    /// Width and height of the whole picture in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.panel.as_ref().map_or(self.camera.size(), Panel::size)
    }

    /// The same view in a picture of another size.
    #[must_use]
    pub fn resized(&self, size: (u32, u32)) -> View {
        let panel = self.panel.as_ref().and_then(|panel| panel.resized(size));
        let camera = self.camera.resized(panel.as_ref().map_or(size, Panel::stage));
        View { camera, panel, ..self.clone() }
    }
}

/// The error for a picture whose side is zero, or for which memory is insufficient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SizeError {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

impl std::fmt::Display for SizeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "a picture of {} x {} pixels cannot be made", self.width, self.height)
    }
}

impl std::error::Error for SizeError {}

/// The buffers for drawing a frame, one set for each thread, kept from frame to frame.
#[derive(Debug, Default)]
pub struct Scratch {
    field: Field,
    cover: Cover,
    tools: Tools,
    /// Pictures of insets.
    insets: Vec<Pixmap>,
}

/// Draws the frames of one cast.
#[derive(Clone, Debug)]
pub struct Painter {
    view: View,
    cast: Arc<Cast>,
    /// The moving bodies, by their place in the cast.
    figures: Vec<(usize, Figure)>,
    /// The fixed ones.
    fixed: Vec<(usize, Figure)>,
    title: Title,
    clock: Clock,
    /// Names of bodies.
    writing: Writing,
    /// The texts in the corner.
    corner: Writing,
    labels: Column,
    /// The fill of each body.
    fills: Vec<Rgb>,
    cards: Option<Cards>,
    insets: Vec<Inset>,
    backdrop: Pixmap,
}

impl Painter {
    /// A painter for the cast of `frame`, whose poses place the fixed bodies.
    ///
    /// # Errors
    /// A [`SizeError`] if there is no picture of the view's size.
    pub fn new(view: &View, frame: &Frame) -> Result<Painter, SizeError> {
        let mut painter = Painter::without_insets(view, frame, &frame.cast.title)?;
        painter.insets = Inset::all(view, frame)?;
        Ok(painter)
    }

    fn without_insets(view: &View, frame: &Frame, title: &str) -> Result<Painter, SizeError> {
        let (camera, theme, cast) = (&view.camera, &view.theme, &frame.cast);
        let (width, height) = view.size();
        let picture = Pixmap::new(width, height).ok_or(SizeError { width, height })?;
        let weights = Weights::of(view.size());
        let colors = fills(cast, theme);
        let figure = |index: usize| Figure::new(&cast.bodies[index], colors[index], camera, theme, weights.line);
        let all = (0..cast.bodies.len()).map(|index| (index, figure(index)));
        let (fixed, figures): (Vec<_>, Vec<_>) = all.partition(|(index, _)| cast.bodies[*index].fixed);

        let clock = Clock::new(weights.clock, view.frame_step, theme);
        // Walls pass by a camera that moves: its labels keep to the corner.
        let walls = if frame.center.is_some() { &[][..] } else { &cast.walls };
        let room = walls::room(walls, camera, theme);
        let lettering = Lettering::new(Weight::SemiBold, weights.title, title);
        let needed = clock.width().max(longest_word(title, &lettering));
        let column = Column::beside_or_in(room, weights.band, needed, weights.pad, (height as f32, weights.small));
        let title = Title::new(title, &lettering, &column, theme);
        let on_ground = !column.in_room || column.one_line;
        let mut painter = Painter {
            view: view.clone(),
            cast: cast.clone(),
            figures,
            fixed,
            title,
            clock,
            writing: Writing::new(weights.small, theme, theme.background),
            corner: Writing::new(weights.small, theme, if on_ground { theme.ground } else { theme.background }),
            labels: column,
            cards: view.panel.as_ref().map(|panel| Cards::new(panel, theme, &colors)),
            fills: colors,
            insets: Vec::new(),
            backdrop: picture,
        };
        let mut backdrop = painter.backdrop.clone();
        painter.paint_scenery(frame, &painter.camera(frame), &mut backdrop, &mut Field::default());
        if !painter.labels.in_room {
            painter.title.draw(&mut backdrop);
        }
        if let Some(cards) = &painter.cards {
            cards.draw_furniture(&mut backdrop);
        }
        painter.backdrop = backdrop;
        Ok(painter)
    }

    /// The camera of a frame.
    fn camera(&self, frame: &Frame) -> Camera {
        frame.center.map_or(self.view.camera, |center| self.view.camera.moved_to(center))
    }

    /// Draws what never moves in the world: background, grid, walls, fixed bodies.
    fn paint_scenery(&self, frame: &Frame, camera: &Camera, picture: &mut Pixmap, field: &mut Field) {
        let (theme, weights) = (&self.view.theme, Weights::of(self.view.size()));
        backdrop::draw(picture, camera, theme);
        walls::draw(picture, &self.cast.walls, camera, theme, weights.band, weights.line);
        paint_figures(&self.fixed, frame, camera, picture, field);
    }

    /// Whether this painter can draw that frame: it has the same cast.
    pub fn suits(&self, frame: &Frame) -> bool {
        Arc::ptr_eq(&self.cast, &frame.cast)
    }

    /// The immobile parts, drawn once. For a moving camera they are drawn again in each frame.
    pub fn backdrop(&self) -> &Pixmap {
        &self.backdrop
    }

    /// Draws a frame over whatever the picture held. The picture must have the view's size: see
    /// [`Painter::backdrop`]; one of another size is replaced.
    pub fn paint(&self, frame: &Frame, picture: &mut Pixmap, scratch: &mut Scratch) {
        if (picture.width(), picture.height()) == (self.backdrop.width(), self.backdrop.height()) {
            picture.data_mut().copy_from_slice(self.backdrop.data());
        } else {
            *picture = self.backdrop.clone();
        }
        let (camera, theme) = (&self.camera(frame), &self.view.theme);
        self.paint_world(frame, camera, picture, scratch);
        let line = Weights::of(self.view.size()).line;
        self.paint_insets(frame, camera, picture, scratch);
        if self.labels.in_room {
            self.title.draw(picture);
        }
        scales::draw(picture, &frame.marks, (camera, theme), &self.labels, &self.corner, line);
        if frame.marks.iter().any(|mark| mark.shape == MarkShape::Time) {
            self.clock.draw(picture, frame.time, &self.labels, self.title.height());
        }
        if let Some(cards) = &self.cards {
            cards.draw(picture, &self.backdrop, frame.time, &mut scratch.tools);
        }
    }

    /// Draws the bodies and what layers add to them.
    fn paint_world(&self, frame: &Frame, camera: &Camera, picture: &mut Pixmap, scratch: &mut Scratch) {
        if frame.center.is_some() {
            self.paint_scenery(frame, camera, picture, &mut scratch.field);
        }
        let line = Weights::of(self.view.size()).line;
        self.paint_trails(frame, camera, picture, &mut scratch.cover);
        paint_figures(&self.figures, frame, camera, picture, &mut scratch.field);
        marks::draw(picture, &frame.marks, camera, &self.view.theme, line);
        self.writing.label(picture, &frame.marks, camera);
    }

    fn paint_insets(&self, frame: &Frame, camera: &Camera, picture: &mut Pixmap, scratch: &mut Scratch) {
        let mut pictures = std::mem::take(&mut scratch.insets);
        pictures.truncate(self.insets.len());
        let blank = self.insets.iter().skip(pictures.len()).map(|inset| inset.painter.backdrop.clone());
        pictures.extend(blank.collect::<Vec<_>>());
        for (inset, own) in self.insets.iter().zip(&mut pictures) {
            let Painter { backdrop, view, .. } = &inset.painter;
            if (own.width(), own.height()) != (backdrop.width(), backdrop.height()) {
                *own = backdrop.clone();
            }
            own.data_mut().copy_from_slice(backdrop.data());
            inset.painter.paint_world(&Frame { center: None, ..frame.clone() }, &view.camera, own, scratch);
            inset.put(own, camera, picture);
        }
        scratch.insets = pictures;
    }

    fn paint_trails(&self, frame: &Frame, camera: &Camera, picture: &mut Pixmap, cover: &mut Cover) {
        let mut canvas = Canvas::new(picture);
        for mark in &frame.marks {
            let MarkShape::Trail { body, points, step } = &mark.shape else { continue };
            let fill = self.fills.get(*body).copied().unwrap_or(self.view.theme.ink);
            let trail = Trail { points, step: *step, color: self.view.theme.trail.of(fill) };
            trail.draw(&mut canvas, camera, Weights::of(self.view.size()).line, cover);
        }
    }

    /// The flat colours of the film, each once: an encoder with few colours keeps these exact.
    pub fn flat_colors(&self) -> Vec<Rgb> {
        let theme = &self.view.theme;
        let mut colors = vec![theme.background, theme.grid, theme.ground, theme.wall, theme.ink, theme.quiet_ink];
        colors.extend([theme.outline.of(theme.wall), theme.force, theme.velocity]);
        for wall in &self.cast.walls {
            let own = wall.color.as_deref().and_then(|name| theme.color(name)).unwrap_or(theme.wall);
            colors.extend([own, theme.outline.of(own)]);
        }
        for own in fills(&self.cast, theme) {
            colors.extend([own, theme.outline.of(own), theme.mark.of(own)]);
        }
        colors.extend(self.cards.iter().flat_map(Cards::flat_colors));
        let mut once = Vec::new();
        for color in colors {
            if !once.contains(&color) {
                once.push(color);
            }
        }
        once
    }
}

/// Draws bodies at their poses in the frame.
fn paint_figures(figures: &[(usize, Figure)], frame: &Frame, camera: &Camera, picture: &mut Pixmap, field: &mut Field) {
    let mut canvas = Canvas::new(picture);
    for (index, figure) in figures {
        if let Some(pose) = frame.poses.get(*index) {
            figure.draw(pose, camera, &mut canvas, field);
        }
    }
}

/// The fill of each body. Only moving bodies take turns with the theme's colours, so that the first one always gets
/// the first colour.
fn fills(cast: &Cast, theme: &Theme) -> Vec<Rgb> {
    let mut turn = 0;
    let fill = |body: &BodyLook| {
        let fill = theme.body(body.color.as_deref(), body.fixed, turn);
        turn += usize::from(!body.fixed);
        fill
    };
    cast.bodies.iter().map(fill).collect()
}

/// Widths of lines and sizes of letters, in pixels: right for 1280 x 720, scaled with the picture.
struct Weights {
    line: f32,
    band: f32,
    pad: f32,
    title: f32,
    clock: f32,
    small: f32,
}

impl Weights {
    fn of((width, height): (u32, u32)) -> Weights {
        let area = width as f32 * height as f32;
        let unit = (area / (1280.0 * 720.0)).sqrt();
        Weights {
            line: (2.2 * unit).max(1.0),
            band: (12.0 * unit).max(3.0),
            pad: (24.0 * unit).max(6.0),
            // Smaller letters than these cannot be read.
            title: (24.0 * unit).max(13.0),
            clock: (20.0 * unit).max(12.0),
            small: (16.0 * unit).max(11.0),
        }
    }
}

#[cfg(test)]
mod supersampled;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod vision;
