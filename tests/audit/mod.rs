//! Random scenes against independent references, and the stated errors of runs against the true ones.

mod agreement;
mod begins_at_rest;
mod breaking;
mod crowd;
mod defaults;
mod defects;
mod draw;
mod fast_sensors;
mod few_contacts;
mod first_steps;
mod friction_cones;
mod hidden_characters;
mod impact;
mod indeterminate;
mod landings;
mod letting_go;
mod lifted_boxes;
mod messages;
mod other_kind;
mod ran;
mod reading_cost;
mod releases;
mod soft_contacts;
mod statements;
mod supports_that_start;
mod tolerances;
