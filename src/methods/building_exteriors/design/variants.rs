//! Other houses with the attributes of a house: the mapping from attributes to houses is not unique (Sec. 7).

use rand::Rng;

use crate::attributes::attributes;
use crate::house::{Database, GenerateError, Generated, Options, Wish, draft};
use crate::mass::{MassTarget, variations};
use edifice_shape::Building;

/// Distance in standard deviations of a house that has all 39 numbers.
const NEAR: f64 = 0.05;
/// Least 1 - IoU of two plans.
const APART: f64 = 0.05;

/// Up to `count` houses with the attributes of `house`, whose plans differ from its own and from each other's by
/// 1 - IoU of at least 0.05, those whose facades come near the wanted ones too first; fewer when the search finds no
/// more.
///
/// # Errors
/// [`GenerateError`].
pub fn variants(
    house: &Building,
    count: usize,
    database: &Database,
    options: &Options,
    rng: &mut impl Rng,
) -> Result<Vec<Generated>, GenerateError> {
    let measured = attributes(house)?;
    let row: [f64; 49] = std::array::from_fn(|c| measured[c].unwrap_or(0.0));
    let target = MassTarget::new(std::array::from_fn(|c| row[c]));
    let unlike = std::slice::from_ref(house);
    // Some plans have no walls for the wanted facades: more of them are made than asked for.
    let many = count + count / 2;
    let found = variations(&target, many, APART, unlike, database, &options.search, rng);
    let mut houses = Vec::with_capacity(found.len());
    for (k, mass) in found.into_iter().enumerate() {
        let wish = Wish {
            name: &format!("{}_{}", house.name, k + 1),
            wanted: &row,
            row: &row,
            repaired: Vec::new(),
        };
        let house = draft(wish, mass, database, options, rng)?;
        houses.push(house.build()?);
    }
    houses.sort_by_key(|h| h.report.max_z > NEAR);
    houses.truncate(count);
    for (k, made) in houses.iter_mut().enumerate() {
        made.building.name = format!("{}_{}", house.name, k + 1);
        made.report.house.clone_from(&made.building.name);
    }
    Ok(houses)
}
