//! Extension from outside the crate: one of each kind, through the public interface only, one file each.

mod account;
mod axis_wise;
mod bevy_app;
mod broken_world;
mod components;
mod contact_events;
mod contact_law;
mod escapement;
mod film_layer;
mod integrator;
mod mixed;
mod replaced_system;
mod rows;
mod shifting_indicators;
mod snapshot;
mod snapshot_mutants;
mod stop;
mod whole_contact_law;
