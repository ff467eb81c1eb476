//! The search of method `best`: donors first, then random arrangements.

use rand::Rng;

use super::fit::{Fitted, ROOM, fit};
use super::plain::plain;
use super::random;
use super::scheme::{Block, PLAIN, Scheme, donated};
use super::target::{MassTarget, PARTS};
use super::{MASS, is_sound};
use crate::attributes::mass_attributes;
use crate::house::Database;
use edifice_shape::{BoxStyle, Building, MassBox, Roof};

/// Limits of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchLimits {
    /// Donors tried at most.
    pub donors: usize,
    /// Rounds of random arrangements at most.
    pub rounds: usize,
    /// Largest distance in standard deviations at which to stop.
    pub enough: f64,
    /// House of the database that must not be a donor.
    pub leave_out: Option<usize>,
}

impl Default for SearchLimits {
    fn default() -> Self {
        Self {
            donors: 12,
            rounds: 100,
            enough: 0.008,
            leave_out: None,
        }
    }
}

/// A mass model and how it was found.
#[derive(Debug, Clone, PartialEq)]
pub struct MassModel {
    /// The boxes; no facades yet.
    pub building: Building,
    /// Largest distance from the wanted columns in standard deviations.
    pub max_z: f64,
    /// Number of times that attributes were measured.
    pub evaluations: u64,
    /// House of the database whose boxes it has; `None` for a random arrangement.
    pub donor: Option<usize>,
}

/// No sound mass model was found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("no connected mass model without courtyards was found in {evaluations} evaluations")]
pub struct MassError {
    /// Number of times that attributes were measured.
    pub evaluations: u64,
}

/// Random arrangements looked at for one that is fitted.
const GLANCES: usize = 30;
/// A mass model as plain as this is taken at once.
const SIMPLE: f64 = 3.0;
/// Rounds of wholly random arrangements at first, and rounds in which a plainer house is looked for than the donors gave.
const OPENING: usize = 8;
const PLAINER: usize = 12;
/// Plain plans drawn, and the donors that are tried before them.
pub(super) const PLANS: usize = 24;
const FIRST: usize = 4;
/// Standard deviations that a garage or porch inside a general box counts.
const BURIED: f64 = 1.0;

/// Finds boxes with the wanted attributes.
///
/// # Errors
/// [`MassError`] when no arrangement tried is sound.
pub fn search(
    target: &MassTarget,
    frozen: &[Block],
    database: &Database,
    options: &SearchLimits,
    rng: &mut impl Rng,
) -> Result<MassModel, MassError> {
    let deviations = &database.deviations[..MASS];
    let mut found = Found::new(options.enough);
    let donors = nearest(target, database, options);
    for (k, &(index, mirrored)) in donors.iter().enumerate() {
        if k == FIRST && frozen.is_empty() {
            let roof = main_roof(&database.buildings[donors[0].0]);
            found.plain(target, roof, deviations, rng);
            if found.is_enough(frozen) {
                break;
            }
        }
        let (mut blocks, roofs) = donated(&database.buildings[index], mirrored, target);
        replace(&mut blocks, frozen);
        let scheme = Scheme::new(&blocks, roofs, target);
        found.add(
            fit(&scheme, target, deviations, options.enough),
            Some(index),
        );
        if found.is_enough(frozen) {
            break;
        }
    }
    for round in 0..options.rounds {
        if found.is_enough(frozen) || (found.cost <= options.enough && round >= PLAINER) {
            break;
        }
        // Every other round changes the best arrangement so far, once there have been a few to choose from.
        let near = (round >= OPENING && round % 2 == 1)
            .then(|| found.nearest.clone())
            .flatten();
        found.evaluations += GLANCES as u64;
        if let Some(scheme) = random_scheme(target, near.as_deref(), frozen, deviations, rng) {
            found.add(fit(&scheme, target, deviations, options.enough), None);
        }
    }
    let evaluations = found.evaluations;
    let best = found.best.ok_or(MassError { evaluations })?;
    Ok(MassModel {
        evaluations,
        ..best
    })
}

/// Complexity of a mass model, 1 for a plain house: its number of general boxes, thin ones counted 3 or 9 times.
fn complexity(building: &Building) -> f64 {
    let general = building.boxes.iter().filter(|b| b.style == BoxStyle::Main);
    general
        .map(|b| match b.width.min(b.depth) {
            w if w < 1.2 => 9.0,
            w if w < ROOM => 3.0,
            _ => 1.0,
        })
        .sum()
}

/// Roof of the largest general box.
pub(super) fn main_roof(building: &Building) -> Roof {
    let general = building.boxes.iter().filter(|b| b.style == BoxStyle::Main);
    let largest = general.max_by(|a, b| (a.width * a.depth).total_cmp(&(b.width * b.depth)));
    largest.map_or(PLAIN, |b| b.roof)
}

/// True if a general box takes the place of a garage or porch.
fn is_buried(building: &Building) -> bool {
    let (general, parts): (Vec<_>, Vec<_>) = building
        .boxes
        .iter()
        .partition(|b| b.style == BoxStyle::Main);
    let within = |p: &MassBox, b: &MassBox| p.plan().overlap(&b.plan()) > 0.05;
    parts.iter().any(|p| general.iter().any(|b| within(p, b)))
}

/// The best so far: among those that are near enough the plainest.
struct Found {
    best: Option<MassModel>,
    enough: f64,
    /// Distance of the best, with what a buried part counts, and its complexity.
    cost: f64,
    complexity: f64,
    evaluations: u64,
    /// General boxes of the best.
    nearest: Option<Vec<Block>>,
}

impl Found {
    fn new(enough: f64) -> Self {
        Self {
            best: None,
            enough,
            cost: f64::INFINITY,
            complexity: f64::INFINITY,
            evaluations: 0,
            nearest: None,
        }
    }

    /// True if nothing better is looked for. Around observed boxes the nearest house decides, not the plainest: what is
    /// observed is not to be made plainer.
    fn is_enough(&self, frozen: &[Block]) -> bool {
        self.cost <= self.enough && (!frozen.is_empty() || self.complexity <= SIMPLE)
    }

    fn add(&mut self, fitted: Fitted, donor: Option<usize>) {
        self.evaluations += fitted.evaluations;
        let model = MassModel {
            building: fitted.building,
            max_z: fitted.max_z,
            evaluations: 0,
            donor,
        };
        self.keep(model, Some(fitted.blocks));
    }

    /// Draws plain plans until one is near enough.
    fn plain(&mut self, target: &MassTarget, roof: Roof, deviations: &[f64], rng: &mut impl Rng) {
        for _ in 0..PLANS {
            if self.is_enough(&[]) {
                break;
            }
            self.evaluations += 1;
            if let Some(model) = plain(target, roof, deviations, rng) {
                self.keep(model, None);
            }
        }
    }

    fn keep(&mut self, model: MassModel, blocks: Option<Vec<Block>>) {
        let buried = if is_buried(&model.building) {
            BURIED
        } else {
            0.0
        };
        let (cost, complexity) = (model.max_z + buried, complexity(&model.building));
        let worse = match cost.max(self.cost) <= self.enough {
            true => complexity >= self.complexity,
            false => cost >= self.cost,
        };
        if worse || !(is_sound(&model.building) && has_boxes(&model.building)) {
            return;
        }
        (self.cost, self.complexity) = (cost, complexity);
        self.nearest = blocks.or(self.nearest.take());
        self.best = Some(model);
    }
}

/// The best of a few random arrangements, at a glance.
pub(super) fn random_scheme(
    target: &MassTarget,
    near: Option<&[Block]>,
    frozen: &[Block],
    deviations: &[f64],
    rng: &mut impl Rng,
) -> Option<Scheme> {
    let mut best: Option<(f64, Scheme)> = None;
    for _ in 0..GLANCES {
        let mut blocks = match near {
            Some(blocks) => random::changed(blocks, target, rng),
            None => random::blocks(target, None, rng),
        };
        replace(&mut blocks, frozen);
        let scheme = Scheme::new(&blocks, [PLAIN; 3], target);
        let building = scheme.building(&scheme.start, target.floor_height);
        if !is_sound(&building) {
            continue;
        }
        let measured = mass_attributes(&building);
        let cost = measured.iter().zip(&target.wanted).zip(deviations);
        let cost: f64 = cost.map(|((m, w), s)| ((m - w) / s).powi(2)).sum();
        if best.as_ref().is_none_or(|(least, _)| cost < *least) {
            best = Some((cost, scheme));
        }
    }
    best.map(|(_, scheme)| scheme)
}

/// Frozen boxes take the places of the general boxes that overlap them most.
fn replace(blocks: &mut Vec<Block>, frozen: &[Block]) {
    for block in frozen {
        let shared = |b: &Block| {
            (0..2)
                .map(|a| {
                    (b.edges[a][1].min(block.edges[a][1]) - b.edges[a][0].max(block.edges[a][0]))
                        .max(0.0)
                })
                .product::<f64>()
        };
        let closest = (0..blocks.len())
            .filter(|&i| !blocks[i].frozen)
            .max_by(|&i, &j| shared(&blocks[i]).total_cmp(&shared(&blocks[j])));
        match closest {
            Some(i) => blocks[i] = *block,
            None => blocks.push(*block),
        }
    }
}

pub(super) fn has_boxes(building: &Building) -> bool {
    let mut general = building.boxes.iter().filter(|b| b.style == BoxStyle::Main);
    general.all(|b| b.width.min(b.depth) >= 0.3)
}

/// The nearest houses with the same floors, garage and porches as far as they are known, and whether they serve mirrored.
pub fn nearest(
    target: &MassTarget,
    database: &Database,
    options: &SearchLimits,
) -> Vec<(usize, bool)> {
    let mut found: Vec<(f64, usize, bool)> = Vec::new();
    for (index, row) in database.rows.iter().enumerate() {
        if options.leave_out == Some(index) {
            continue;
        }
        let other = MassTarget::new(std::array::from_fn(|c| row[c].unwrap_or(0.0)));
        // A part of which nobody knows whether the donor has one is no reason to pass the donor over.
        let unlike = (0..PARTS.len())
            .any(|k| row[PARTS[k].1 + 2].is_some() && other.presence()[k] != target.presence()[k]);
        if other.floors != target.floors || unlike {
            continue;
        }
        for mirrored in [false, true] {
            let distance: f64 = (0..MASS)
                .filter(|c| row[*c].is_some())
                .map(|c| {
                    let is_x = matches!(c, 9 | 15 | 21) && other.wanted[c + 2] > 0.0;
                    let value = match mirrored && is_x {
                        true => 1.0 - other.wanted[c],
                        false => other.wanted[c],
                    };
                    ((value - target.wanted[c]) / database.deviations[c]).powi(2)
                })
                .sum();
            found.push((distance, index, mirrored));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let donors = found.into_iter().take(options.donors);
    donors
        .map(|(_, index, mirrored)| (index, mirrored))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plain_house_that_is_near_is_enough_and_around_boxes_any_that_is_near() {
        let found = |cost, complexity| Found {
            cost,
            complexity,
            ..Found::new(0.01)
        };
        assert!(found(0.01, SIMPLE).is_enough(&[]));
        assert!(!found(0.01, SIMPLE + 1.0).is_enough(&[]));
        assert!(!found(0.02, SIMPLE).is_enough(&[]));
        let frozen = [Block {
            edges: [[0.0, 4.0], [0.0, 3.0]],
            floors: 1,
            roof: PLAIN,
            frozen: true,
        }];
        assert!(found(0.01, SIMPLE + 1.0).is_enough(&frozen));
        assert!(!found(0.02, 0.0).is_enough(&frozen));
    }
}
