//! The camera of a film and the plots beside it, which need a first run before the film is drawn.

use std::sync::Arc;

use super::Exit;
use super::film::FilmRequest;
use super::progress_bar::Progress;
use super::say::say;
use crate::cli::author;
use crate::forces::spring::SpringForce;
use crate::joints::Joint;
use crate::raster::{Camera, Panel, WorldRectangle};
use crate::record::Schedule;
use crate::record::follow_camera::Follower;
use crate::record::legend;
use crate::record::plot::{Board, Plot};
use crate::record::sections::{CameraChoice, FitCamera, PlotEntry, PlotsSection};
use crate::scene::SceneError;
use crate::simulation::Recorder;
use crate::simulation::{Missing, Sampler};
use crate::simulation::{Overrides, Simulation};

/// The growth limit of the picture over its initial size, for a run that will fail. A body that leaves at enormous
/// speed must not shrink all others to a point.
const WILDEST_GROWTH: f64 = 100.0;

/// A camera, the body that it follows, and the panel beside its picture.
pub(super) struct Aim {
    pub camera: Camera,
    /// `None`: the camera is fixed.
    pub follower: Option<Follower>,
    pub panel: Option<Panel>,
}

impl FilmRequest<'_> {
    /// The camera and the plots of the scene, in a picture whose full size is `size` pixels. `step` is the time between
    /// frames in seconds of film. A camera that fits everything needs the whole motion beforehand, and so do the axes
    /// of plots. So the scene is first run without drawing, which costs time but no memory.
    pub(super) fn aim(
        &self,
        simulation: &Simulation,
        schedule: &Schedule,
        size: (u32, u32),
        step: f64,
    ) -> Result<Aim, Exit> {
        let choice = simulation.get_resource::<CameraChoice>().cloned();
        let choice = choice.unwrap_or_else(|| CameraChoice::Fit(FitCamera::default()));
        let fits = matches!(choice, CameraChoice::Fit(_));
        let plots = simulation.get_resource::<PlotsSection>().filter(|plots| !plots.0.is_empty());
        let (mut bounds, mut panel) = (None, None);
        if fits || plots.is_some() {
            let mut ahead = self.again(simulation)?;
            let legend = plots.map(|_| legend(ahead.unpublished_world()));
            let sampler = plots.map(|plots| self.sampler(&mut ahead, &plots.0)).transpose()?;
            let none = Schedule::default();
            let (seen, plots) = self.look_ahead(&mut ahead, if fits { schedule } else { &none }, sampler);
            bounds = seen;
            if let (Some(legend), Some(plots)) = (legend, plots) {
                panel = Panel::new(&Arc::new(Board { plots, legend }), size);
                if panel.is_none() && !self.quiet {
                    let (width, height) = size;
                    say(&format!("note: {width} x {height} pixels are too few to show the plots beside the film"));
                }
            }
        }
        let stage = panel.as_ref().map_or(size, Panel::stage);
        let (camera, follower) = match choice {
            CameraChoice::Look(look) => (Camera::look(look.center.si(), look.height.si(), stage), None),
            CameraChoice::Follow(follow) => {
                // Single pictures have no film before them that the camera could be behind.
                let smoothing = if self.shot.is_film() { follow.smoothing.si() } else { 0.0 };
                let camera = Camera::look(glam::DVec2::ZERO, follow.height.si(), stage);
                (camera, Some(Follower::new(&follow.of, smoothing, step)))
            }
            CameraChoice::Fit(fit) => {
                let nothing = WorldRectangle { low: glam::DVec2::NEG_ONE, high: glam::DVec2::ONE };
                (Camera::fit(bounds.unwrap_or(nothing), fit.margin.si(), stage), None)
            }
        };
        Ok(Aim { camera, follower, panel })
    }

    /// The sampler that reads the channels of plots over the time of the film.
    fn sampler(&self, ahead: &mut Simulation, plots: &[PlotEntry]) -> Result<Sampler, Exit> {
        let end = ahead.ticks() as f64 * ahead.clock().dt;
        let (from, to) = (ahead.film().begin(), ahead.film().end().min(end));
        Sampler::new(ahead, plots, from, to).map_err(|Missing { plot, channel }| {
            let help = "`position`, `velocity`, `angle` and `spin` are quantities of bodies, `force` and `contacts` also of \
            walls";
            let message = format!("there is no channel {channel:?}");
            let error = SceneError::new(format!("plots[{plot}].channels"), message).with_help(help);
            self.request.refuse_value(Exit::SceneWrong, ahead, error)
        })
    }

    /// Runs ahead, and returns the contents of the frames of a schedule and the plots.
    fn look_ahead(
        &self,
        ahead: &mut Simulation,
        schedule: &Schedule,
        mut sampler: Option<Sampler>,
    ) -> (Option<WorldRectangle>, Option<Vec<Plot>>) {
        let progress = Progress::new(schedule.frames(), "frames looked ahead", self.silent);
        let mut recorder = Recorder::bare();
        // The bounds of all frames, and of those before anything leaves at enormous speed.
        let (mut all, mut tame) = (None, None);
        let mut room = f64::INFINITY;
        let mut wrong = false;
        for time in schedule.times() {
            let read = sampler.as_mut().map_or(Ok(()), |sampler| sampler.run_to(ahead, time));
            let Ok(frame) = read.and_then(|()| recorder.frame(ahead, time)) else {
                // The run that is drawn reports the failure.
                all = tame;
                wrong = true;
                break;
            };
            if let Some(now) = WorldRectangle::of_frame(&frame) {
                let now = anchors(ahead).fold(now, |seen, at| seen.union(WorldRectangle { low: at, high: at }));
                all = Some(all.map_or(now, |before: WorldRectangle| before.union(now)));
                if tame.is_none() {
                    room = WILDEST_GROWTH * extent(now);
                }
                if extent(now) <= room {
                    tame = all;
                } else {
                    room = f64::NEG_INFINITY;
                }
            }
            progress.step();
        }
        let plots = sampler.map(|mut sampler| {
            wrong = wrong || sampler.run_to_end(ahead).is_err();
            sampler.finish(wrong)
        });
        (all, plots)
    }

    /// The scene once more, from its beginning.
    pub(super) fn again(&self, simulation: &Simulation) -> Result<Simulation, Exit> {
        let overrides = Overrides { plan: simulation.plan().cloned(), ..self.overrides.clone() };
        let again = Simulation::load_with(self.source, &overrides, author::plugin);
        again.map_err(|errors| self.request.refuse_scene(&errors))
    }
}

fn extent(bounds: WorldRectangle) -> f64 {
    (bounds.high - bounds.low).max_element()
}

/// The anchors of joints and springs in the present state: films show them.
fn anchors(simulation: &Simulation) -> impl Iterator<Item = glam::DVec2> + '_ {
    let (state, bodies) = (simulation.state(), simulation.bodies());
    let joints = state.models_of::<Joint>().filter_map(|joint| joint.pair(bodies));
    let joints = joints.flat_map(|pair| [pair.a.position, pair.b.position]);
    let springs = state.models_of::<SpringForce>().filter_map(|spring| spring.link.ends(bodies));
    joints.chain(springs.flat_map(|(a, b)| [a.position, b.position])).filter(|at| at.is_finite())
}
