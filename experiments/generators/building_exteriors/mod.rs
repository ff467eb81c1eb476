//! A seeded generator of plausible contemporary houses, to have a database whose truth is known.
//!
//! A house is made from the top down: its hidden **style** (one of seven) draws the **kind** of each
//! attribute (small or wide, with or without garage, ...); the kind and, for nine pairs of
//! attributes ([`DEPENDENCIES`]), the value of another attribute draw the numbers (`draw`); then a
//! plan of overlapping boxes (`plan`), of one of ten families of plans (`families`), and walls with
//! windows and doors (`walls`) are built that have these numbers. Roofs are lowered until they hide no
//! window. Nothing but the finished building leaves the generator for the learner, which
//! measures it anew. The kinds of a house are independent given its style.
//!
//! Deliberately not in the generator: garage doors (not annotated as facade elements; a wall is left
//! free for them), sites and views.

mod draw;
mod families;
mod glaze;
mod hidden;
mod lengths;
mod plan;
mod site;
mod storeys;
mod strips;
mod styles;
mod walls;
mod wild;

pub use families::Family;
pub use wild::wild;

use rayon::prelude::*;

use edifice_base::rng::stream;
use edifice_building_exteriors::attributes::facade_attributes;
use edifice_building_exteriors::mass::is_sound;
use edifice_shape::{BoxStyle, Building};

/// Number of hidden styles.
pub const STYLES: usize = styles::STYLES.len();

/// The nine dependencies between attributes beyond their kinds, as pairs of group names. Four of
/// them are geometry (`far = bcr / arf.0`; the boundary grows with the aspect ratio and with what
/// is cut out), five are habits of the builders.
pub const DEPENDENCIES: [(&str, &str); 9] = [
    ("bbox", "bcr"),
    ("bbox", "bdry"),
    ("bcr", "bdry"),
    ("bcr", "far"),
    ("bcr", "arf"),
    ("arf", "far"),
    ("bbox", "garage"),
    ("bbox", "porch"),
    ("garage", "porch"),
];

/// Groups whose kinds the style draws; the kind of `far` follows from the others.
pub const KINDS: [&str; 9] = [
    "bbox",
    "bcr",
    "bdry",
    "arf",
    "garage",
    "porch",
    "wwr",
    "symmetry",
    "alignment",
];

/// Seed of the shipped database.
pub const SHIPPED_SEED: u64 = 2016;
/// Houses in the shipped database, as many as the paper has.
pub const SHIPPED: usize = 200;

/// A generated house and its hidden style.
#[derive(Debug, Clone)]
pub struct House {
    /// The house, as the learner sees it.
    pub building: Building,
    /// Its style, below [`STYLES`].
    pub style: usize,
    /// The kinds of its nine attributes that have kinds, in the order of [`KINDS`].
    pub kinds: [usize; KINDS.len()],
    /// The form of its plan.
    pub family: Family,
}

/// House number `index` of the database with this seed.
pub fn house(seed: u64, index: u64) -> House {
    let mut rng = stream(seed, "building_exteriors/house", index);
    let style = styles::draw_style(&mut rng);
    loop {
        let kinds = styles::draw_kinds(style, &mut rng);
        // Some numbers do not fit together (a garage too deep for its house): draw them anew; a few
        // kinds never do (two cars, one floor, all walls symmetric), and are drawn anew in the end.
        let built = (0..ATTEMPTS).find_map(|_| attempt(&kinds, index, &mut rng));
        if let Some((building, family)) = built {
            let kinds = kinds.numbers();
            return House {
                building,
                style,
                kinds,
                family,
            };
        }
    }
}

/// Draws of the numbers before the kinds are given up.
const ATTEMPTS: usize = 100;
/// Plans tried for the same numbers.
const PLANS: usize = 600;

fn attempt(
    kinds: &styles::Kinds,
    index: u64,
    rng: &mut impl rand::Rng,
) -> Option<(Building, Family)> {
    let numbers = draw::numbers(kinds, rng);
    (0..PLANS).find_map(|_| {
        let plan = plan::build(&numbers, kinds, rng)?;
        let facades = walls::build(&plan, &numbers, kinds, rng)?;
        let family = plan.family;
        let name = format!("house_{:04}", index + 1);
        let special = kinds.special.clone();
        let height = plan.floor_height;
        let building = Building::new(name, "m", height, plan.boxes, facades, special).ok()?;
        if !is_sound(&building) || !has_alignment(&building, kinds) {
            return None;
        }
        Some((shown(building)?, family))
    })
}

/// True if the windows of the floors stand in line exactly where the kind asks for it.
fn has_alignment(building: &Building, kinds: &styles::Kinds) -> bool {
    let wanted = match (kinds.arf, kinds.alignment) {
        (0, _) | (_, 2) => [0.0; 4],
        (_, 1) => [1.0, 1.0, 0.0, 0.0],
        _ => [1.0; 4],
    };
    let measured = facade_attributes(building);
    measured[8..].iter().zip(wanted).all(|(m, w)| *m == Some(w))
}

/// Shares of the slope of the highest roof that lower roofs try.
const LOWER: [f64; 4] = [1.0, 0.7, 0.45, 0.25];

/// The building with its lower roofs so flat that they hide no window; `None` where some stay hidden.
fn shown(building: Building) -> Option<Building> {
    let top = building.boxes.iter().map(|b| b.height).fold(0.0, f64::max);
    LOWER.into_iter().find_map(|share| {
        let mut lowered = building.clone();
        for b in &mut lowered.boxes {
            if b.height < top || b.style != BoxStyle::Main {
                b.roof.pitch = (b.roof.pitch * share).round();
            }
        }
        (!hidden::hides(&lowered)).then_some(lowered)
    })
}

/// The first `count` houses of the database with this seed.
pub fn houses(seed: u64, count: usize) -> Vec<House> {
    let indices = (0..count as u64).into_par_iter();
    indices.map(|index| house(seed, index)).collect()
}
