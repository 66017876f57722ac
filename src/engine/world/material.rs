//! Materials of bodies and walls, and the coefficients of two materials in contact.
//!
//! The pair takes the mean of the two materials' friction unless `pairs` says otherwise. The rebound stays in the form
//! of the scene for each of the two. The contact law makes one number of both.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use bevy_app::App;
use bevy_ecs::resource::Resource;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserializer, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use crate::scene::units::{Density, Scalar, Stiffness};
use crate::scene::values::{OrderedMap, Word};
use crate::scene::{Diagnostics, NameKind, Outline, Section, exact};

/// The name of the default material. It always exists, and a scene may redefine it.
pub const DEFAULT: &str = "default";

/// The open list of words for colours: what draws the scene registers them.
pub const COLORS: &str = "color";

/// The least stiffness in N/m of a material that gives none.
pub const LEAST_STIFFNESS: f64 = 1000.0;

/// One material, all numbers in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Stiffness of an atom in N/m. Default: chosen when the scene stands, and [`LEAST_STIFFNESS`] before.
    pub stiffness: f64,
    /// Coefficient of static friction. Default: 0.
    pub friction_static: f64,
    /// Coefficient of dynamic friction. Default: 0.
    pub friction_dynamic: f64,
    /// Its rebound. Default: no loss.
    pub rebound: Rebound,
    /// Mass per area in kg/m2, for atoms without a mass. Default: 1.
    pub density: f64,
    /// A colour of the theme's palette or `#rrggbb`. Default: the theme chooses.
    pub color: Option<String>,
}

impl Default for Material {
    /// Properties that a scene does not name are not modelled: no friction, no losses.
    fn default() -> Self {
        Self {
            stiffness: LEAST_STIFFNESS,
            friction_static: 0.0,
            friction_dynamic: 0.0,
            rebound: Rebound::Restitution(1.0),
            density: 1.0,
            color: None,
        }
    }
}

/// The rebound of a material, in the form of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rebound {
    /// Ratio of the speeds after and before an impact, from 0 (no rebound) to 1 (no loss).
    Restitution(f64),
    /// The share by which the normal force is greater while loading, and less while unloading. It runs from 0 (no loss)
    /// to 1 (no rebound).
    Inelasticity(f64),
}

impl Rebound {
    fn of(restitution: Option<Scalar>, inelasticity: Option<Scalar>) -> Option<Self> {
        let inelasticity = inelasticity.map(|inelasticity| Self::Inelasticity(inelasticity.si()));
        inelasticity.or_else(|| restitution.map(|restitution| Self::Restitution(restitution.si())))
    }
}

/// Place of a material in [`Materials::by_index`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct MaterialIndex(u32);

impl MaterialIndex {
    /// The material at `place`.
    pub fn new(index: usize) -> Self {
        Self(index as u32)
    }

    /// The place.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The coefficients of two touching materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairCoefficients {
    /// Coefficient of static friction.
    pub friction_static: f64,
    /// Coefficient of dynamic friction.
    pub friction_dynamic: f64,
    /// The rebound of the first and of the second. Both are equal if `pairs` gives one for the pair.
    pub rebounds: [Rebound; 2],
}

/// All materials of a scene.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Materials {
    /// The names, in the order of `by_index`.
    pub names: Vec<String>,
    /// The materials; the first is [`DEFAULT`], the others follow in the order of the scene.
    pub by_index: Vec<Material>,
    /// Each name with its index.
    by_name: BTreeMap<String, usize>,
    overrides: BTreeMap<(usize, usize), Override>,
    /// The indices of materials that give no stiffness.
    without_stiffness: BTreeSet<usize>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Override {
    friction: Option<Friction>,
    rebound: Option<Rebound>,
}

impl Default for Materials {
    fn default() -> Self {
        Self {
            names: vec![DEFAULT.into()],
            by_index: vec![Material::default()],
            by_name: BTreeMap::from([(DEFAULT.into(), 0)]),
            overrides: BTreeMap::new(),
            without_stiffness: BTreeSet::from([0]),
        }
    }
}

impl Materials {
    /// The materials of a scene from its two sections, either of which may be absent.
    pub fn new(materials: Option<&MaterialsSection>, pairs: Option<&PairsSection>) -> Self {
        let mut all = Self::default();
        for (name, entry) in materials.iter().flat_map(|section| &section.0.0) {
            let index = if name == DEFAULT { 0 } else { all.by_index.len() };
            if index == 0 {
                all.by_index[0] = entry.material();
            } else {
                all.names.push(name.clone());
                all.by_name.insert(name.clone(), index);
                all.by_index.push(entry.material());
            }
            match entry.stiffness {
                Some(_) => all.without_stiffness.remove(&index),
                None => all.without_stiffness.insert(index),
            };
        }
        if let Some(pairs) = pairs {
            all.set_pairs(pairs);
        }
        all
    }

    /// Lets a `pairs` section override the means. Names that are not materials are passed over; its check reports them.
    pub fn set_pairs(&mut self, pairs: &PairsSection) {
        for pair in &pairs.0 {
            if let (Some(a), Some(b)) = (self.find(&pair.between.0), self.find(&pair.between.1)) {
                let rebound = Rebound::of(pair.restitution, pair.inelasticity);
                self.overrides.insert(ordered(a, b), Override { friction: pair.friction, rebound });
            }
        }
    }

    /// The stiffness in N/m that a material gives.
    pub fn stiffness(&self, index: usize) -> Option<f64> {
        self.by_index.get(index).filter(|_| !self.without_stiffness.contains(&index)).map(|material| material.stiffness)
    }

    /// Gives this stiffness in N/m to materials without one.
    pub(crate) fn give_stiffness(&mut self, stiffness: f64) {
        let Self { by_index, without_stiffness, .. } = self;
        without_stiffness.iter().for_each(|&index| by_index[index].stiffness = stiffness);
    }

    fn find(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// The index of a material in `by_index`; that of the default for `None` and for unknown names.
    pub fn index(&self, name: Option<&str>) -> usize {
        name.and_then(|name| self.find(name)).unwrap_or(0)
    }

    /// The coefficients of two materials, given by their indices: the means of their frictions, unless `pairs` gives
    /// others. An unknown index counts as the default.
    pub fn pair(&self, a: usize, b: usize) -> PairCoefficients {
        // A program may have taken all of them out.
        let neutral = Material::default();
        let default = self.by_index.first().unwrap_or(&neutral);
        let (first, second) = (self.by_index.get(a).unwrap_or(default), self.by_index.get(b).unwrap_or(default));
        let mean = |of: fn(&Material) -> f64| (of(first) + of(second)) / 2.0;
        let other = self.overrides.get(&ordered(a, b)).copied().unwrap_or_default();
        let friction = other.friction.map(|friction| (friction.sticking.si(), friction.sliding.si()));
        PairCoefficients {
            friction_static: friction.map_or_else(|| mean(|material| material.friction_static), |both| both.0),
            friction_dynamic: friction.map_or_else(|| mean(|material| material.friction_dynamic), |both| both.1),
            rebounds: other.rebound.map_or([first.rebound, second.rebound], |both| [both; 2]),
        }
    }
}

impl Materials {
    /// The rebounds of all materials, and of all pairs that have one.
    pub fn rebounds(&self) -> impl Iterator<Item = Rebound> + '_ {
        let own = self.by_index.iter().map(|material| material.rebound);
        own.chain(self.overrides.values().filter_map(|pair| pair.rebound))
    }

    /// The rebounds of some materials, and of pairs of these that have one.
    pub fn rebounds_of(&self, used: &BTreeSet<MaterialIndex>) -> impl Iterator<Item = Rebound> + '_ {
        let used: BTreeSet<usize> = used.iter().map(|index| index.0 as usize).collect();
        let own = self.by_index.iter().enumerate().map(|(index, material)| ((index, index), material.rebound));
        let of_pairs = self.overrides.iter().filter_map(|(pair, one)| Some((*pair, one.rebound?)));
        own.chain(of_pairs).filter(move |((a, b), _)| used.contains(a) && used.contains(b)).map(|(_, rebound)| rebound)
    }

    /// Whether there is a material of this index.
    pub(crate) fn has(&self, index: MaterialIndex) -> bool {
        (index.0 as usize) < self.by_index.len()
    }

    /// Whether any pair may have friction.
    pub fn any_friction(&self) -> bool {
        let own = self.by_index.iter().map(|material| material.friction_static);
        own.chain(self.overrides.values().filter_map(|pair| Some(pair.friction?.sticking.si()))).any(|mu| mu > 0.0)
    }
}

fn ordered(a: usize, b: usize) -> (usize, usize) {
    (a.min(b), a.max(b))
}

/// Friction in a scene: one number, or `(static: 0.5, dynamic: 0.4)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// Coefficient while sticking.
    pub sticking: Scalar,
    /// Coefficient while sliding.
    pub sliding: Scalar,
    both: bool,
}

/// Two coefficients of Coulomb friction.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "TwoFrictions")]
struct TwoFrictions {
    /// The contact holds up to this times the normal force.
    #[serde(rename = "static")]
    sticking: Scalar,
    /// It slips with this times the normal force. Not above `static`.
    #[serde(rename = "dynamic")]
    sliding: Scalar,
}

struct FrictionVisitor;

impl<'de> Visitor<'de> for FrictionVisitor {
    type Value = Friction;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a friction such as `0.25` or `(static: 0.5, dynamic: 0.4)`")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Friction, E> {
        Ok(Friction { sticking: Scalar::new(value), sliding: Scalar::new(value), both: false })
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Friction, E> {
        self.visit_f64(value as f64)
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Friction, E> {
        self.visit_f64(value as f64)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Friction, E> {
        let value = Scalar::parse(text).map_err(E::custom)?;
        self.visit_f64(value.si())
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Friction, A::Error> {
        let two = TwoFrictions::deserialize(de::value::MapAccessDeserializer::new(map))?;
        Ok(Friction { sticking: two.sticking, sliding: two.sliding, both: true })
    }
}

impl JsonSchema for Friction {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Friction".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [generator.subschema_for::<Scalar>(), generator.subschema_for::<TwoFrictions>()],
        })
    }
}

impl<'de> Deserialize<'de> for Friction {
    fn deserialize<R: Deserializer<'de>>(reader: R) -> Result<Self, R::Error> {
        reader.deserialize_any(FrictionVisitor)
    }
}

impl Friction {
    fn check(&self, report: &mut Diagnostics) {
        if !self.both {
            report.not_negative("friction", self.sticking);
            return;
        }
        let sticking = report.not_negative("friction.static", self.sticking);
        let sliding = report.not_negative("friction.dynamic", self.sliding);
        if sticking && sliding && self.sliding.si() > self.sticking.si() {
            let message = format!(
                "must not be above the static friction of {}, got {}",
                exact(self.sticking.si()),
                exact(self.sliding.si())
            );
            report.error("friction.dynamic", message);
        }
    }
}

fn check_rebound(restitution: Option<Scalar>, inelasticity: Option<Scalar>, report: &mut Diagnostics) {
    if let Some(restitution) = restitution {
        report.between("restitution", restitution, 0.0, 1.0);
    }
    if let Some(inelasticity) = inelasticity {
        report.between("inelasticity", inelasticity, 0.0, 1.0);
    }
    if restitution.is_some() && inelasticity.is_some() {
        let message = "`restitution` and `inelasticity` say the same: write one of them";
        report.error("inelasticity", message).help("remove one of the two");
    }
}

/// One material in a scene.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default, rename = "")]
#[schemars(rename = "Material")]
pub struct MaterialEntry {
    /// Stiffness of an atom in N/m. Above zero. A material without one gets the stiffness that suits the weights and speeds at the
    /// start. The card names it. Default: 1000, or more in heavy and fast scenes.
    pub stiffness: Option<Stiffness>,
    /// Coefficient of friction, not below zero: one number, or one for holding and one for slipping. Default: 0.
    pub friction: Option<Friction>,
    /// Ratio of the speeds after and before an impact, from 0 (no rebound) to 1 (no loss). Default: 1, or what follows from
    /// `inelasticity`.
    pub restitution: Option<Scalar>,
    /// Inelasticity, from 0 (no loss) to 1 (no rebound). It stands instead of `restitution`. Default: 0.
    pub inelasticity: Option<Scalar>,
    /// Mass per area in kg/m2, for atoms without a mass of their own. Above zero. Default: 1.
    pub density: Option<Density>,
    /// A colour of the theme's palette, or any other as `"#rrggbb"`. Default: the theme chooses.
    #[schemars(extend("x-words" = "color", "x-more" = "`\"#rrggbb\"`"))]
    pub color: Option<String>,
}

impl MaterialEntry {
    fn material(&self) -> Material {
        let default = Material::default();
        Material {
            stiffness: self.stiffness.map_or(default.stiffness, f64::from),
            friction_static: self.friction.map_or(default.friction_static, |friction| friction.sticking.si()),
            friction_dynamic: self.friction.map_or(default.friction_dynamic, |friction| friction.sliding.si()),
            rebound: Rebound::of(self.restitution, self.inelasticity).unwrap_or(default.rebound),
            density: self.density.map_or(default.density, f64::from),
            color: self.color.clone(),
        }
    }

    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        report.positive_if_given("stiffness", self.stiffness);
        if let Some(friction) = &self.friction {
            friction.check(report);
        }
        check_rebound(self.restitution, self.inelasticity, report);
        report.positive_if_given("density", self.density);
        match self.color.as_deref().map(|color| (color, color.strip_prefix('#'))) {
            Some((color, Some(digits))) if digits.len() != 6 || !digits.bytes().all(|b| b.is_ascii_hexdigit()) => {
                let message = format!("`{color}` is not a colour");
                report.error("color", message).help("write `\"#rrggbb\"`, such as `\"#20a0c0\"`");
            }
            Some((color, None)) => {
                Word(color.to_owned()).check(outline, COLORS, "color", report);
            }
            _ => {}
        }
    }
}

/// The materials of bodies and walls, by name. The material `"default"` always exists. It belongs to all bodies and
/// walls without a material.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub struct MaterialsSection(pub OrderedMap<MaterialEntry>);

impl Section for MaterialsSection {
    const NAME: &'static str = "materials";
    const EXAMPLE: &'static str = "materials: { \"rock\": (friction: 0.5, restitution: 0.8, density: 2.5) }";

    /// Declares the materials' names.
    fn declare(&self, outline: &mut Outline) {
        for (name, _) in &self.0.0 {
            outline.declare(NameKind::MATERIAL, name, &format!("[\"{name}\"]"));
        }
    }

    /// Reports numbers out of their range and unknown colours.
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        for (name, entry) in &self.0.0 {
            report.within(&format!("[\"{name}\"]"), |report| entry.check(outline, report));
        }
    }

    fn install(self, _: &Outline, app: &mut App) {
        app.insert_resource(Materials::new(Some(&self), None));
    }
}

/// One pair of materials whose coefficients are not the means.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "")]
#[schemars(rename = "Pair")]
pub struct PairEntry {
    /// The two materials, in either order. They may be the same.
    pub between: (String, String),
    /// Coefficient of friction, in the form of a material. Default: the means.
    #[serde(default)]
    pub friction: Option<Friction>,
    /// Ratio of the speeds after and before an impact, from 0 to 1. Default: from `inelasticity`.
    #[serde(default)]
    pub restitution: Option<Scalar>,
    /// Inelasticity, from 0 to 1. It stands instead of `restitution`. Default: the mean.
    #[serde(default)]
    pub inelasticity: Option<Scalar>,
}

/// Coefficients of two materials in contact, in place of the means of both.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub struct PairsSection(pub Vec<PairEntry>);

impl Section for PairsSection {
    const NAME: &'static str = "pairs";
    const EXAMPLE: &'static str = "pairs: [(between: (\"block\", \"rock\"), friction: 0.1)]";

    /// Reports unknown materials, duplicate or empty pairs, and numbers out of range.
    fn check(&self, outline: &Outline, report: &mut Diagnostics) {
        let mut seen: BTreeMap<(&str, &str), usize> = BTreeMap::new();
        for (index, pair) in self.0.iter().enumerate() {
            let (a, b) = (pair.between.0.as_str(), pair.between.1.as_str());
            report.within(&format!("[{index}]"), |report| {
                for (path, name) in [("between[0]", a), ("between[1]", b)] {
                    require_at(name, path, outline, report);
                }
                if let Some(friction) = &pair.friction {
                    friction.check(report);
                }
                check_rebound(pair.restitution, pair.inelasticity, report);
                if pair.friction.is_none() && pair.restitution.is_none() && pair.inelasticity.is_none() {
                    report
                        .error("", "this pair changes nothing")
                        .help("give `friction` or `restitution`, or remove it");
                }
                if let Some(first) = seen.insert((a.min(b), a.max(b)), index) {
                    let message = format!("the pair of \"{a}\" and \"{b}\" stands here twice");
                    let twice = report.error("between", message);
                    twice.also(format!("pairs[{first}].between"), "the first time").help("keep one of the two");
                }
            });
        }
    }

    fn install(self, _: &Outline, app: &mut App) {
        app.world_mut().resource_mut::<Materials>().set_pairs(&self);
    }
}

/// Reports a material's name that is unknown, at the path `material`. `None` is the default material.
pub fn require(name: Option<&str>, outline: &Outline, report: &mut Diagnostics) {
    if let Some(name) = name {
        require_at(name, "material", outline, report);
    }
}

fn require_at(name: &str, path: &str, outline: &Outline, report: &mut Diagnostics) {
    if name != DEFAULT {
        outline.require(NameKind::MATERIAL, name, path, report);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read<T: serde::de::DeserializeOwned>(text: &str) -> T {
        ron::Options::default()
            .with_default_extension(
                ron::extensions::Extensions::IMPLICIT_SOME | ron::extensions::Extensions::UNWRAP_NEWTYPES,
            )
            .from_str(text)
            .unwrap()
    }

    #[test]
    fn the_pair_is_the_mean_unless_it_is_given() {
        let section: MaterialsSection = read(
            "{\"a\": (friction: 0.2, inelasticity: 0.5), \"b\": (friction: (static: 0.6, dynamic: 0.4), restitution: 1)}",
        );
        let mut materials = Materials::new(Some(&section), None);
        let (a, b) = (materials.index(Some("a")), materials.index(Some("b")));
        assert_eq!((a, b, materials.index(None)), (1, 2, 0));
        let rebounds = [Rebound::Inelasticity(0.5), Rebound::Restitution(1.0)];
        let pair = PairCoefficients { friction_static: 0.4, friction_dynamic: (0.2 + 0.4) / 2.0, rebounds };
        assert_eq!(materials.pair(a, b), pair);
        assert_eq!(materials.pair(b, a), PairCoefficients { rebounds: [rebounds[1], rebounds[0]], ..pair });
        materials.set_pairs(&read("[(between: (\"b\", \"a\"), friction: 0.1)]"));
        let slippery = PairCoefficients { friction_static: 0.1, friction_dynamic: 0.1, rebounds };
        assert_eq!(materials.pair(a, b), slippery);
        materials.set_pairs(&read("[(between: (\"a\", \"b\"), restitution: 0.3)]"));
        assert_eq!(materials.pair(a, b).rebounds, [Rebound::Restitution(0.3); 2]);
    }

    #[test]
    fn the_default_is_first_and_may_be_redefined() {
        let section: MaterialsSection = read("{\"a\": (), \"default\": (stiffness: 5)}");
        let materials = Materials::new(Some(&section), None);
        assert_eq!(materials.names, ["default", "a"]);
        assert_eq!(materials.by_index[0].stiffness, 5.0);
        assert_eq!(materials.by_index[1], Material::default());
    }
}
