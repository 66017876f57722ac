//! What a scene consists of: bodies, atoms, walls, materials; as entities, and packed for speed.

mod aloft;
mod apart;
pub mod atom;
pub mod between;
pub mod body;
pub mod finite;
mod fitting;
mod flight;
pub mod hash;
pub mod keys;
pub mod kinematic;
mod lone;
pub mod material;
pub mod motion;
mod name;
pub mod packed;
pub(crate) mod part;
mod pose;
mod roster;
pub mod sections;
pub mod spawn;
pub mod wall;

pub use apart::{Apart, Origin};
pub use atom::{Atom, AtomOf, Atoms, atoms_of};
pub use body::{Body, Force, Mass, Motion, Position, Rotation, Spin, Torque, Velocity};
pub(crate) use fitting::incomplete;
pub(crate) use flight::Passing;
pub use kinematic::Kinematic;
pub use material::{MaterialIndex, Materials};
pub use name::Name;
pub use packed::Bodies;
pub(crate) use roster::Roster;
pub use sections::plugin;
pub use spawn::NewBody;
pub use wall::{Ends, NearestPoint, PackedWall, Wall};
