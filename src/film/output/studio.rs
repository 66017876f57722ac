//! The tools of every film: the view, the painter of the current cast, and one scratch per thread.

use std::sync::Arc;

use tiny_skia::Pixmap;

use super::OutputError;
use crate::raster::{Painter, Scratch, SizeError, View};
use jostle_frames::frame::Frame;

/// Makes painters, one for each cast.
#[derive(Debug)]
pub(super) struct Studio {
    view: View,
    painter: Option<Arc<Painter>>,
}

impl Studio {
    pub(super) fn new(view: View) -> Studio {
        Studio { view, painter: None }
    }

    /// The painter for a frame. It is reused while the cast stays the same.
    pub(super) fn painter(&mut self, frame: &Frame) -> Result<Arc<Painter>, OutputError> {
        if let Some(painter) = self.painter.as_ref().filter(|painter| painter.suits(frame)) {
            return Ok(painter.clone());
        }
        let painter = Arc::new(Painter::new(&self.view, frame)?);
        self.painter = Some(painter.clone());
        Ok(painter)
    }

    /// Checks that a frame has one pose for each body.
    pub(super) fn check(frame: &Frame) -> Result<(), OutputError> {
        let (bodies, poses) = (frame.cast.bodies.len(), frame.poses.len());
        let fits = bodies == poses;
        if fits { Ok(()) } else { Err(OutputError::Poses { time: frame.time, bodies, poses }) }
    }

    /// The tools of one thread.
    pub(super) fn easel(&self) -> Result<Easel, OutputError> {
        let (width, height) = self.view.size();
        let picture = Pixmap::new(width, height).ok_or(SizeError { width, height })?;
        Ok(Easel { picture, scratch: Scratch::default() })
    }
}

/// A picture to paint on, and what painting needs.
#[derive(Debug)]
pub(super) struct Easel {
    pub(super) picture: Pixmap,
    scratch: Scratch,
}

impl Easel {
    pub(super) fn paint(&mut self, painter: &Painter, frame: &Frame) {
        painter.paint(frame, &mut self.picture, &mut self.scratch);
    }
}
