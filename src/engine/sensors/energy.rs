//! `Energy()`: the energy ledger in J, `energy.kinetic`, `energy.potential`, `energy.elastic`, `energy.total`,
//! `energy.friction`, `energy.inelasticity`, `energy.drag`, `energy.work`, `energy.residual`.

use bevy_app::App;
use bevy_ecs::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Channel, SensorAppExt, add_found};
use crate::scene::{Entry, Outline, SceneAppExt, WrittenEntry};
use crate::tick::State;
use crate::tick::energy::EnergyLedger;

const CHANNELS: &[&str] = &[
    "energy.kinetic",
    "energy.potential",
    "energy.elastic",
    "energy.total",
    "energy.friction",
    "energy.inelasticity",
    "energy.drag",
    "energy.work",
    "energy.residual",
];

/// The energy ledger in J: `energy.kinetic`, `energy.potential`, `energy.elastic` and their sum `energy.total`. Its losses are
/// `energy.friction`, `energy.inelasticity`, `energy.drag`, and `energy.damping` if springs have dampers. `energy.work` is the
/// work of drives. `energy.residual` is the rest that the ledger cannot account for.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Energy {}

impl Entry for Energy {
    const SECTION: &'static str = "sensors";
    const NAME: &'static str = "Energy";
    const EXAMPLE: &'static str = "Energy()";

    fn install(_: Vec<WrittenEntry<Self>>, _: &Outline, app: &mut App) {
        let models = app.world().resource::<State>().models();
        let accounts: Vec<_> = models.filter_map(|model| Some(format!("energy.{}", model.loss()?.account))).collect();
        add_found(app.world_mut(), CHANNELS.iter().map(|&name| name.to_owned()).chain(accounts));
    }
}

fn find(world: &mut World, owner: &str, quantity: &str) -> Option<Channel> {
    if owner != "energy" {
        return None;
    }
    let name = format!("{owner}.{quantity}");
    let Some(part) = entry(owner, quantity) else {
        let mut accounts = world.resource::<State>().models().filter_map(|model| model.loss());
        let account = accounts.find(|loss| loss.account == quantity)?.account;
        return Some(Channel::of_state(name, "J", move |state| state.ledger().lost(account).unwrap_or(0.0)));
    };
    Some(Channel::of_state(name, "J", move |state| part(&EnergyLedger::of(state))))
}

/// The entry of the ledger that a channel reads.
pub(crate) fn entry(owner: &str, quantity: &str) -> Option<fn(&EnergyLedger) -> f64> {
    Some(match (owner, quantity) {
        ("energy", "kinetic") => |ledger| ledger.kinetic,
        ("energy", "potential") => |ledger| ledger.potential,
        ("energy", "elastic") => |ledger| ledger.elastic,
        ("energy", "total") => |ledger| ledger.kinetic + ledger.potential + ledger.elastic,
        ("energy", "friction") => |ledger| ledger.friction,
        ("energy", "inelasticity") => |ledger| ledger.inelasticity,
        ("energy", "drag") => |ledger| ledger.drag,
        ("energy", "work") => |ledger| ledger.work,
        ("energy", "residual") => |ledger| ledger.residual,
        _ => return None,
    })
}

pub(super) fn plugin(app: &mut App) {
    app.add_channels(CHANNELS, find);
    app.register_entry::<Energy>();
}
