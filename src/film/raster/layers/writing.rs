//! Small print: texts drawn once and put on pictures at whole pixels, and names beside bodies.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use tiny_skia::Pixmap;

use super::labels::{Sticker, halo};
use crate::raster::Camera;
use crate::raster::text::{Lettering, Weight};
use crate::raster::theme::Theme;
use jostle_frames::frame::Rgb;
use jostle_frames::mark::{Mark, MarkShape};

/// The number of remembered texts. A film with more of them, such as running numbers, draws the others each time.
const REMEMBERED: usize = 1024;

/// The small print of a film. A text looks the same, whichever thread draws it first.
#[derive(Clone, Debug)]
pub(in crate::raster) struct Writing {
    size: f32,
    ink: Rgb,
    below: Rgb,
    made: Arc<Mutex<BTreeMap<String, Arc<Text>>>>,
}

/// A text, ready to be put on a picture.
#[derive(Debug)]
pub(in crate::raster) struct Text {
    sticker: Option<Sticker>,
    width: f32,
}

impl Writing {
    /// Letters of `size` pixels in the theme's ink, with a halo of the colour below.
    pub(in crate::raster) fn new(size: f32, theme: &Theme, below: Rgb) -> Writing {
        Writing { size, ink: theme.ink, below, made: Arc::default() }
    }

    /// The colour of the halo.
    pub(in crate::raster) fn below(&self) -> Rgb {
        self.below
    }

    /// Pixels per em.
    pub(in crate::raster) fn size(&self) -> f32 {
        self.size
    }

    /// A text that begins at the origin of its baseline.
    pub(in crate::raster) fn text(&self, text: &str) -> Arc<Text> {
        // Another thread that gave up while it held the memory has left whole texts in it.
        let mut made = self.made.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(known) = made.get(text) {
            return known.clone();
        }
        let lettering = Lettering::new(Weight::Regular, self.size, text);
        let path = lettering.path(text, 0.0, 0.0);
        let around = path.as_ref().and_then(|path| halo(path, self.size));
        let layers = around.iter().map(|path| (path, self.below)).chain(path.iter().map(|path| (path, self.ink)));
        let sticker = Sticker::new(&layers.collect::<Vec<_>>());
        let new = Arc::new(Text { sticker, width: lettering.width(text) });
        if made.len() < REMEMBERED {
            made.insert(text.to_owned(), new.clone());
        }
        new
    }

    /// Puts the labels among the marks above the named things, or below them if another label is there. A label without
    /// room is left out.
    pub(in crate::raster) fn label(&self, picture: &mut Pixmap, marks: &[Mark], camera: &Camera) {
        let mut taken: Vec<[f32; 4]> = Vec::new();
        for mark in marks {
            let MarkShape::Label { at, clear, text } = &mark.shape else { continue };
            let (middle, clear) = (camera.to_picture(*at), (clear * camera.pixels_per_meter()) as f32);
            let text = self.text(text);
            let left = (middle.x as f32 - 0.5 * text.width).round();
            let gap = 0.35 * self.size;
            let above = middle.y as f32 - clear - gap;
            let below = middle.y as f32 + clear + gap + 0.73 * self.size;
            let rectangle =
                |baseline: f32| [left, baseline - self.size, left + text.width, baseline + 0.25 * self.size];
            let free = |baseline: &f32| {
                let own = rectangle(*baseline);
                taken
                    .iter()
                    .all(|other| own[0] >= other[2] || own[2] <= other[0] || own[1] >= other[3] || own[3] <= other[1])
            };
            if let Some(baseline) = [above, below].into_iter().find(free) {
                taken.push(rectangle(baseline));
                text.put(picture, left, baseline);
            }
        }
    }
}

impl Text {
    /// Its width in pixels.
    pub(in crate::raster) fn width(&self) -> f32 {
        self.width
    }

    /// Puts it on a picture with the beginning of its baseline at the pixel that is nearest.
    pub(in crate::raster) fn put(&self, picture: &mut Pixmap, left: f32, baseline: f32) {
        // Casts saturate: what lies nowhere lies outside. Half the range leaves room for the sticker's own offset.
        let whole = |place: f32| (place.round() as i32).clamp(i32::MIN / 2, i32::MAX / 2);
        if let Some(sticker) = &self.sticker {
            sticker.put(picture, whole(left), whole(baseline));
        }
    }
}
