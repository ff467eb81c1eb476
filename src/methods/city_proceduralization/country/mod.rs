//! A country in tiles: one dictionary of types for cities of which no machine holds all.
//!
//! 1. [`propose`]: of each tile alone, the types that it would have if it were a city: templates, and rules of buildings. Each is a
//!    weighted medoid, which stands for so many components or buildings of so much volume.
//! 2. [`merge`]: the proposals of all tiles are a sample of the country (a coreset). Ward's hierarchy and medoids find K templates in it, facility
//!    location R rules of buildings, as they do in a city, with the weights of what each proposal stands for. This is the
//!    dictionary.
//! 3. [`code`]: a tile takes the dictionary's types as they are. Of its own proposals it adds those that remove most mismatched
//!    volume (facility location again): local templates and rules. Then each component and each building takes the best type.
//!
//! With n components in all and n_t in a tile, a grammar of `level` l has n / 2^l types. The dictionary has the share 1 - [`Shares::local`] of
//! them, a tile the share [`Shares::local`] of n_t / 2^l, so that the country has as many types as one city of that level.
//!
//! A [`Sample`] is a city grammar: its axiom has one instance of each rule, an example of what the rule is made from, which also tells the
//! proportions in which buildings are compared. Textures and patterns for synthesis are left out.

mod code;
mod merge;
mod propose;
mod sample;

use edifice_base::{Progress, Watched};
use edifice_shape::triangles::City;

use super::component::Component;
use super::components::decompose;
use super::settings::{Precision, ProceduralizeError, Representative};

pub use code::code;
pub use merge::merge;
pub use propose::propose;
pub use sample::{Sample, Stands};

/// Settings of a country, the same for all tiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CountrySettings {
    /// Halvings of the number of components that give the number of types.
    pub level: u32,
    /// The member that represents a type.
    pub representative: Representative,
    /// The precision of numbers.
    pub precision: Precision,
    /// The share of the types that are local.
    pub shares: Shares,
    /// Most templates, and most rules, that a tile proposes: what the merge holds grows with them.
    pub proposed: usize,
}

/// The parting of types among dictionary and tiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Share of the types that are local, 0 to 1.
    pub local: f64,
    /// Most templates, and most rules, of the dictionary.
    pub most: usize,
}

impl Default for Shares {
    fn default() -> Self {
        Self {
            local: 0.25,
            most: 16_384,
        }
    }
}

impl CountrySettings {
    /// Types of so many components: halved [`CountrySettings::level`] times.
    fn types(&self, components: usize) -> usize {
        components.checked_shr(self.level).unwrap_or(0).max(1)
    }

    /// Templates, and rules, of the dictionary of so many components.
    fn shared(&self, components: usize) -> usize {
        let share = 1.0 - self.shares.local.clamp(0.0, 1.0);
        let shared = (share * self.types(components) as f64).round() as usize;
        shared.clamp(1, self.shares.most.max(1))
    }

    /// Templates, and rules, that a tile of so many components may add.
    fn local(&self, components: usize) -> usize {
        let share = self.shares.local.clamp(0.0, 1.0);
        (share * self.types(components) as f64).round() as usize
    }
}

/// The components of a tile, of which there is at least one.
fn components(tile: &City, watched: &Watched) -> Result<Vec<Component>, ProceduralizeError> {
    let components = decompose(tile, true, &watched.inner()).components;
    if !watched.goes_on(Progress::stage("types of components")) {
        return Err(ProceduralizeError::Stopped);
    }
    match components.is_empty() {
        true => Err(ProceduralizeError::Empty),
        false => Ok(components),
    }
}
