//! Several different mass models of one target.

use rand::Rng;

use super::fit::fit;
use super::plain::plain;
use super::scheme::{Scheme, donated};
use super::search::{MassModel, PLANS, SearchLimits, has_boxes, main_roof, nearest, random_scheme};
use super::target::{MassTarget, bounds};
use super::{MASS, is_sound};
use crate::house::Database;
use edifice_shape::{Building, PlanUnion};

/// Several different mass models of one target: each plan at least `apart` (1 - IoU) from the others and from those
/// of `unlike`. Donors first, then random arrangements, then changes of those found.
pub fn variations(
    target: &MassTarget,
    count: usize,
    apart: f64,
    unlike: &[Building],
    database: &Database,
    options: &SearchLimits,
    rng: &mut impl Rng,
) -> Vec<MassModel> {
    let mut found: Vec<MassModel> = Vec::new();
    let deviations = &database.deviations[..MASS];
    let keep = |model: MassModel, found: &mut Vec<MassModel>| {
        let mut others = found.iter().map(|m| &m.building).chain(unlike);
        let distinct = others.all(|other| 1.0 - iou(other, &model.building) >= apart);
        if model.max_z <= 0.05
            && distinct
            && is_sound(&model.building)
            && has_boxes(&model.building)
        {
            found.push(model);
        }
    };
    let fitted = |scheme: &Scheme, donor| {
        let fitted = fit(scheme, target, deviations, 0.05);
        MassModel {
            building: fitted.building,
            max_z: fitted.max_z,
            evaluations: fitted.evaluations,
            donor,
        }
    };
    let many = SearchLimits {
        donors: 8 * count,
        ..options.clone()
    };
    let donors = nearest(target, database, &many);
    if let Some(&(index, _)) = donors.first() {
        let roof = main_roof(&database.buildings[index]);
        for _ in 0..PLANS {
            if found.len() < count
                && let Some(model) = plain(target, roof, deviations, rng)
            {
                keep(model, &mut found);
            }
        }
    }
    for (index, mirrored) in donors {
        if found.len() == count {
            return found;
        }
        let (blocks, roofs) = donated(&database.buildings[index], mirrored, target);
        let scheme = Scheme::new(&blocks, roofs, target);
        keep(fitted(&scheme, Some(index)), &mut found);
    }
    for _ in 0..4 * options.rounds {
        if found.len() == count {
            break;
        }
        if let Some(scheme) = random_scheme(target, None, &[], deviations, rng) {
            keep(fitted(&scheme, None), &mut found);
        }
    }
    found
}

/// Intersection over union of two ground floors, their bounding boxes laid corner on corner.
pub fn iou(a: &Building, b: &Building) -> f64 {
    let plan = |building: &Building| -> Vec<edifice_shape::Rect> {
        let [[x, _], [y, _]] = bounds(building);
        let plan = building.floor_plan(0).into_iter();
        plan.map(|r| edifice_shape::Rect::new(r.x - x, r.y - y, r.width, r.height))
            .collect()
    };
    let (p, q) = (plan(a), plan(b));
    let area = |plan: &[edifice_shape::Rect]| PlanUnion::new(plan).area();
    let both: Vec<_> = p.iter().chain(&q).copied().collect();
    let union = area(&both);
    (area(&p) + area(&q) - union) / union
}
