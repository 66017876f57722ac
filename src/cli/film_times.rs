//! The moments of a film, a strip or a sheet.

use bevy_ecs::entity::Entity;

use super::Exit;
use super::film::{FilmRequest, Shot};
use super::load::Request;
use super::say::{number, say};
use crate::contacts::events::{ContactEvents, Touching, watch};
use crate::record::Schedule;
use crate::record::sections::FreezeEntry;
use crate::scene::SceneError;
use crate::simulation::Simulation;
use crate::world::Name;

/// More frames than a viewer watches: nine hours at 30 frames per second.
const MOST_FRAMES: f64 = 1e6;

/// The last moment of a run is a product of ticks; what people write differs in the last digits.
const ROUNDING: f64 = 1e-9;

impl FilmRequest<'_> {
    /// The moments to draw, and the seconds of physics between frames, which the clock has to distinguish.
    pub(super) fn moments(&self, simulation: &Simulation, frames_per_second: f64) -> Result<(Schedule, f64), Exit> {
        let film = simulation.film();
        let end = end(simulation);
        let step = film.speed() / frames_per_second;
        let times = |flag: &str, times: &[f64]| match times.iter().find(|time| is_beyond(simulation, **time)) {
            Some(late) => {
                let (late, end) = (number(*late), number(end));
                Err(self.request.usage(&format!("{flag} {late} s is after the end: the run lasts {end} s")))
            }
            None => Ok(Schedule::at(times.iter().map(|time| time.min(end)))),
        };
        match &self.shot {
            Shot::At(at) => return Ok((times("--at", &[*at])?, step)),
            Shot::Strip(moments) => {
                let closest = moments.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
                return Ok((times("--strip", moments)?, closest));
            }
            Shot::Film | Shot::Sheet(..) => (),
        }
        let from = film.begin();
        if let Some(misfit) = begins_too_late(simulation) {
            return Err(self.misfit(simulation, misfit));
        }
        let to = film.end().min(end);
        if let Shot::Sheet((columns, rows)) = self.shot {
            let last = (columns * rows - 1).max(1);
            let every = (to - from) / f64::from(last);
            let time = |index: u32| if index == last { to } else { from + f64::from(index) * every };
            return Ok((Schedule::at((0..columns * rows).map(time)), every));
        }
        if let Some(misfit) = too_many_frames(simulation, frames_per_second).or_else(|| stands_too_late(simulation)) {
            return Err(self.misfit(simulation, misfit));
        }
        let mut schedule = Schedule::new(from, to, film.speed(), frames_per_second);
        let touched = self.first_touches(simulation, from, to)?;
        for (index, freeze) in film.freeze.iter().enumerate() {
            let at = match freeze.at {
                Some(at) => Some(at.si().min(end)),
                None => touched[index],
            };
            let frames = (freeze.lasts.si() * frames_per_second).round() as u64;
            match (at, &freeze.touch) {
                (Some(at), _) => schedule = schedule.standing_at(at, frames),
                (None, Some((a, b))) => say(&format!(
                    "note: film.freeze[{index}]: `{a}` and `{b}` do not begin to touch in the film, so it does not stop there"
                )),
                (None, None) => (),
            }
        }
        Ok((schedule, step))
    }

    fn misfit(&self, simulation: &Simulation, misfit: Misfit) -> Exit {
        let exit = if self.is_overridden() { Exit::Usage } else { Exit::SceneWrong };
        misfit.refuse(self.request, simulation, exit)
    }

    /// Whether the command line, and not the scene, sets the length of the run and the film.
    fn is_overridden(&self) -> bool {
        self.frames_per_second.is_some() || self.overrides.duration.is_some()
    }

    /// The beginnings of the contacts for which the film stands still. `None` for those that do not begin between
    /// `from` and `to`. If there are such contacts, the scene is run once for them.
    fn first_touches(&self, simulation: &Simulation, from: f64, to: f64) -> Result<Vec<Option<f64>>, Exit> {
        let freezes = &simulation.film().freeze;
        let mut found = vec![None; freezes.len()];
        if freezes.iter().all(|freeze| freeze.touch.is_none()) {
            return Ok(found);
        }
        let mut ahead = self.again(simulation)?;
        watch(ahead.world_mut());
        let pairs: Vec<Option<Touching>> = freezes.iter().map(|freeze| pair(&mut ahead, freeze)).collect();
        let mut missing = pairs.iter().flatten().count();
        while missing > 0 && ahead.clock().ticks < ahead.ticks() && ahead.clock().time() < to {
            // The run that is drawn reports the failure.
            if ahead.run_to_tick(ahead.clock().ticks + 1).is_err() {
                break;
            }
            let Some(events) = ahead.get_resource::<ContactEvents>().filter(|events| events.time >= from) else {
                continue;
            };
            for (found, pair) in found.iter_mut().zip(&pairs) {
                let begins = |pair: &Touching| {
                    let turned = Touching { a: pair.b, b: pair.a };
                    events.begun.contains(pair) || events.begun.contains(&turned)
                };
                if found.is_none() && pair.as_ref().is_some_and(begins) {
                    *found = Some(events.time);
                    missing -= 1;
                }
            }
        }
        Ok(found)
    }
}

/// Why a film does not fit its run.
pub(super) struct Misfit {
    path: String,
    message: String,
    help: &'static str,
}

impl Misfit {
    /// The reasons to refuse the film of a scene, at the frames per second of the scene.
    pub(super) fn of(simulation: &Simulation) -> Option<Self> {
        let late = begins_too_late(simulation);
        let many = || too_many_frames(simulation, simulation.film().frames_per_second());
        late.or_else(many).or_else(|| stands_too_late(simulation))
    }

    /// Tells it.
    pub(super) fn refuse(self, request: Request, simulation: &Simulation, exit: Exit) -> Exit {
        request.refuse_value(exit, simulation, SceneError::new(self.path, self.message).with_help(self.help))
    }
}

/// The end of the run, in seconds of physics.
fn end(simulation: &Simulation) -> f64 {
    simulation.ticks() as f64 * simulation.clock().dt
}

/// Whether a moment is after the end of the run.
fn is_beyond(simulation: &Simulation, time: f64) -> bool {
    time > end(simulation) * (1.0 + ROUNDING)
}

fn begins_too_late(simulation: &Simulation) -> Option<Misfit> {
    let from = simulation.film().begin();
    is_beyond(simulation, from).then(|| Misfit {
        path: "film.from".to_owned(),
        message: format!("the film begins at {} s, but the run ends at {} s", number(from), number(end(simulation))),
        help: "begin earlier, or let the run last longer: `clock: (duration: ..)` or `--duration`",
    })
}

fn too_many_frames(simulation: &Simulation, frames_per_second: f64) -> Option<Misfit> {
    let film = simulation.film();
    let seconds = film.end().min(end(simulation)) - film.begin();
    let standing: f64 = film.freeze.iter().map(|freeze| freeze.lasts.si()).sum();
    let frames = (seconds / film.speed() + standing) * frames_per_second;
    let mut freezes = film.freeze.iter().enumerate().map(|(index, freeze)| (index, freeze.lasts.si()));
    if let Some((index, lasts)) = freezes.find(|(_, lasts)| lasts * frames_per_second > MOST_FRAMES) {
        let (lasts, frames) = (number(lasts), number((lasts * frames_per_second).round()));
        return Some(Misfit {
            path: format!("film.freeze[{index}].for"),
            message: format!("to stand still for {lasts} s would be {frames} frames, more than {MOST_FRAMES}"),
            help: "let it stand still for less, or choose fewer frames per second (`fps`)",
        });
    }
    (frames > MOST_FRAMES).then(|| {
        let (seconds, frames) = (number(seconds), number(frames.round()));
        Misfit {
            path: "film".to_owned(),
            message: format!("{seconds} s of physics would be {frames} frames, more than {MOST_FRAMES}"),
            help: "choose fewer frames per second (`fps`), a higher `speed`, or an earlier end (`to`)",
        }
    })
}

fn stands_too_late(simulation: &Simulation) -> Option<Misfit> {
    let moments = simulation.film().freeze.iter().enumerate();
    let mut moments = moments.filter_map(|(index, freeze)| Some((index, freeze.at?.si())));
    moments.find(|(_, at)| is_beyond(simulation, *at)).map(|(index, at)| {
        let (at, end) = (number(at), number(end(simulation)));
        Misfit {
            path: format!("film.freeze[{index}].at"),
            message: format!("the film is to stop at {at} s, but the run ends at {end} s"),
            help: "choose an earlier moment, or let the run last longer",
        }
    })
}

/// The two that are to touch.
fn pair(simulation: &mut Simulation, freeze: &FreezeEntry) -> Option<Touching> {
    let world = simulation.world_mut();
    let mut names = world.query::<(Entity, &Name)>();
    let mut named = |wanted: &str| names.iter(world).find(|(_, name)| *name == wanted).map(|(entity, _)| entity);
    let (a, b) = freeze.touch.as_ref()?;
    Some(Touching { a: named(a)?, b: named(b)? })
}
