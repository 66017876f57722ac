//! draft, replaced by the scene reader's
use bevy_ecs::prelude::*;
/// Index of a material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MaterialIndex(pub u16);
/// Coefficients of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairCoefficients { /** . */ pub friction_static: f64, /** . */ pub friction_dynamic: f64, /** . */ pub inelasticity: f64 }
/// Materials.
#[derive(Resource, Debug, Default)]
pub struct Materials { /** . */ pub table: Vec<PairCoefficients> }
impl Materials {
    /// .
    pub fn largest_inelasticity(&self) -> f64 { self.table.iter().map(|c| c.inelasticity).fold(0.0, f64::max) }
    /// .
    pub fn any_friction(&self) -> bool { self.table.iter().any(|c| c.friction_static > 0.0) }
    /// .
    pub fn pair(&self, a: MaterialIndex, b: MaterialIndex) -> PairCoefficients {
        let (a, b) = (self.table[a.0 as usize], self.table[b.0 as usize]);
        PairCoefficients { friction_static: 0.5*(a.friction_static+b.friction_static), friction_dynamic: 0.5*(a.friction_dynamic+b.friction_dynamic), inelasticity: 0.5*(a.inelasticity+b.inelasticity) }
    }
}
