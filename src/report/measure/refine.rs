//! Refinement between two ticks of a sequence with steps of two. The cheapest setting that is exact enough may be nearly
//! twice as fine as needed.

use super::measured_scene::Compared;
use crate::work_precision::{MethodChoice, Setting, Settings, Subject, TARGETS};
use jostle_engine::scene::SceneErrors;

/// The tries between two ticks for each error.
const TIMES: usize = 2;
/// Errors between two ticks are only known to this factor. So the tried tick aims at a smaller error by this factor.
const AIM: f64 = 0.7;
/// Ticks that are not longer by this factor are not worth a run.
const LONGER: f64 = 1.1;

/// Tries ticks between the advised one for each error and the next longer, if the errors of both suggest one.
///
/// # Errors
/// When the scene is wrong.
pub(super) fn refine(settings: &mut Settings, subject: &Compared) -> Result<(), SceneErrors> {
    for which in (0..TARGETS.len()).flat_map(|which| [which; TIMES]) {
        let advice = settings.advice()[which];
        let advised = advice.reached.map(|setting| (setting.course, setting.tick, advice.target));
        let Some((course, index, count)) = advised.and_then(|advised| between(settings, subject, advised)) else {
            continue;
        };
        let (setting, _) = subject.run(course, subject.scene.duration / count as f64)?;
        settings.all.insert(index, setting);
    }
    Ok(())
}

/// The ticks of a run whose error may just be the wanted one, and its position in the list. `None` if there is none.
fn between(
    settings: &Settings,
    subject: &Compared,
    (course, tick, target): (MethodChoice, f64, f64),
) -> Option<(MethodChoice, usize, u64)> {
    let is_it = |setting: &Setting| setting.course == course && setting.tick == tick;
    let index = settings.all.iter().position(is_it)?;
    let coarser = settings.all[..index].last().filter(|coarser| coarser.course == course)?;
    let (low, high) = (settings.claimed(&settings.all[index])?, coarser.error()?);
    if high <= target {
        return None;
    }
    // As a power of the tick, which is exact for small errors.
    let part = ((AIM * target / low).ln() / (high / low).ln()).clamp(0.0, 1.0);
    let longer = tick * (coarser.tick / tick).powf(part);
    let duration = subject.scene.duration;
    let count = subject.scene.comparable((duration / longer).ceil() as u64);
    // It is run once to be compared, and timed.
    let needed = 2.0 * duration * settings.all[index].seconds?;
    let tried = duration / count as f64;
    let wanted = tried > LONGER * tick && coarser.tick > LONGER * tried && needed < subject.budget.left();
    wanted.then_some((course, index, count))
}
