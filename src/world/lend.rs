//! A resource and the world at once, often in each tick. `World::resource_scope` does that too, but takes the resource off its
//! entity and puts it back, which costs as much as evaluating a small world.

use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;

/// Shows a resource and the rest of the world, in which it is empty meanwhile.
///
/// # Panics
/// When there is no such resource.
pub(crate) fn lend<R: Resource<Mutability = Mutable> + Default, U>(
    world: &mut World,
    see: impl FnOnce(&mut World, &mut R) -> U,
) -> U {
    let mut lent = std::mem::take(&mut *world.resource_mut::<R>());
    let seen = see(world, &mut lent);
    *world.resource_mut::<R>() = lent;
    seen
}

/// The same for a resource that may not be there.
pub(crate) fn lend_any<R: Resource<Mutability = Mutable> + Default, U>(
    world: &mut World,
    see: impl FnOnce(&mut World, Option<&mut R>) -> U,
) -> U {
    let mut lent = world.get_resource_mut::<R>().map(|mut there| std::mem::take(&mut *there));
    let seen = see(world, lent.as_mut());
    if let Some(lent) = lent {
        *world.resource_mut::<R>() = lent;
    }
    seen
}
