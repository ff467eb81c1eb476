//! Mass models on a given ground plan: the plan is covered exactly, floors and parts are put into it.
//!
//! Garage and porches go to the place inside the plan that is nearest to the wanted one, with an edge on its boundary,
//! so that the rest stays sound; a porch or garage that finds no place is left out. The rest is covered by its largest
//! rectangles, boxes of one floor. Upper floors stand on the largest of these that overlap, the last one cut to the
//! wanted share of the floor.

use super::repair::repair;
use super::target::{MassTarget, PARTS, floors};
use super::{MassModel, is_sound};
use crate::attributes::{COLUMNS, mass_attributes};
use crate::house::roofs::largest_rectangles;
use crate::mass::scheme::PLAIN;
use edifice_shape::{BoxStyle, Building, MassBox, PlanUnion, Rect};

/// Why no house stands on a plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A given column says otherwise.
    #[error("{column} = {value} is given, the footprint has {bound:.4}")]
    Given {
        /// The column.
        column: &'static str,
        /// Its value.
        value: f64,
        /// That of the footprint.
        bound: f64,
    },
    /// A given garage or porch has no place in the plan.
    #[error(
        "{part} of {width} m x {depth} m ({column}) is given and has no place in the footprint"
    )]
    NoPlace {
        /// The part.
        part: &'static str,
        /// Column of its width.
        column: &'static str,
        /// Its width.
        width: f64,
        /// Its depth.
        depth: f64,
    },
    /// No arrangement of upper floors is sound.
    #[error("the upper floors find no place over the footprint")]
    Floors,
}

/// Narrower boxes are stubs (m).
const STUB: f64 = 1.2;

/// Columns that the plan decides: bounding box, coverage, boundary.
pub const DECIDED: [usize; 4] = [0, 1, 3, 4];

/// The columns that a plan decides, with their values.
pub fn decided(plan: &[Rect]) -> [(usize, f64); 4] {
    let union = PlanUnion::new(plan);
    let bounds = union
        .bounding_box()
        .unwrap_or(Rect::new(0.0, 0.0, 1.0, 1.0));
    let (area, boundary) = (union.area(), union.perimeter());
    let values = [
        bounds.width,
        bounds.height,
        area / bounds.area(),
        boundary / area.sqrt(),
    ];
    std::array::from_fn(|k| (DECIDED[k], values[k]))
}

/// Checks that given columns agree with the plan, and sets the others.
///
/// # Errors
/// [`PlanError::Given`].
pub fn reconcile(row: &mut [f64; 49], given: &[bool; 49], plan: &[Rect]) -> Result<(), PlanError> {
    for (c, bound) in decided(plan) {
        let value = row[c];
        if given[c] && (value - bound).abs() > 5e-3 {
            return Err(PlanError::Given {
                column: COLUMNS[c],
                value,
                bound,
            });
        }
        row[c] = bound;
    }
    Ok(())
}

/// Distance of the house that [`stand`] puts on a plan from a row, in standard deviations by the largest mass attribute;
/// infinite where there is none.
pub fn distance(row: &[f64; 49], given: &[bool; 49], plan: &[Rect], deviations: &[f64; 49]) -> f64 {
    let (mut row, mut known) = (*row, *given);
    if reconcile(&mut row, given, plan).is_err() {
        return f64::INFINITY;
    }
    DECIDED.iter().for_each(|c| known[*c] = true);
    repair(&mut row, &known, deviations);
    let found = stand(&row, given, plan, &deviations[..super::MASS]);
    found.map_or(f64::INFINITY, |model| model.max_z)
}

/// The mass model on the plan with the wanted floors and, where there is room, parts. `row` is free of contradictions.
///
/// # Errors
/// [`PlanError`].
pub fn stand(
    row: &[f64; 49],
    given: &[bool; 49],
    plan: &[Rect],
    deviations: &[f64],
) -> Result<MassModel, PlanError> {
    let target = MassTarget::new(std::array::from_fn(|c| row[c]));
    let mut placed: Vec<(BoxStyle, Rect, f64)> = Vec::new();
    for (k, (part, c, style)) in PARTS.into_iter().enumerate() {
        let Some(own) = &target.parts[k] else {
            continue;
        };
        let wanted = Rect::new(own.x[0], own.y[0], own.x[1] - own.x[0], own.y[1] - own.y[0]);
        match place(&wanted, k, plan, &placed) {
            Some(at) => placed.push((style, at, own.height)),
            None if given[c + 2] && given[c + 3] => {
                return Err(PlanError::NoPlace {
                    part,
                    column: COLUMNS[c + 2],
                    width: wanted.width,
                    depth: wanted.height,
                });
            }
            None => {}
        }
    }
    let parts: Vec<Rect> = placed.iter().map(|p| p.1).collect();
    let ground = largest_rectangles(&without(plan, &parts));
    let total = PlanUnion::new(plan).area() / row[6];
    let storey = |rects: &[Rect], k: usize| match k < floors(&row[..27]) {
        true => upper(rects, row[6 + k] * total),
        false => Some(Vec::new()),
    };
    let first = storey(&ground, 1).ok_or(PlanError::Floors)?;
    let second = storey(&first, 2).ok_or(PlanError::Floors)?;
    let mut boxes = Vec::new();
    for (k, rects) in [&second, &first, &ground].into_iter().enumerate() {
        let height = (3 - k) as f64 * target.floor_height;
        for r in rects {
            let covered = boxes.iter().any(|b: &MassBox| contains(&b.plan(), r));
            if !covered {
                boxes.push(mass_box(BoxStyle::Main, r, height));
            }
        }
    }
    for (style, r, height) in placed {
        boxes.push(mass_box(style, &r, height));
    }
    let building = bare(target.floor_height, boxes);
    if !is_sound(&building) {
        return Err(PlanError::Floors);
    }
    let measured = mass_attributes(&building);
    Ok(MassModel {
        max_z: super::max_z(&measured, &target.wanted, deviations),
        building,
        evaluations: 1,
        donor: None,
    })
}

/// The mass model whose storeys, equally high (m), all cover the plan.
///
/// # Errors
/// [`PlanError::Floors`] for a plan that is not sound.
pub fn whole(plan: &[Rect], storeys: usize, height: f64) -> Result<MassModel, PlanError> {
    let rectangles = without_stubs(largest_rectangles(plan));
    let boxes = rectangles
        .iter()
        .map(|r| mass_box(BoxStyle::Main, r, storeys as f64 * height));
    let building = bare(height, boxes.collect());
    if !is_sound(&building) {
        return Err(PlanError::Floors);
    }
    Ok(MassModel {
        max_z: 0.0,
        building,
        evaluations: 1,
        donor: None,
    })
}

/// The rectangles without those that are narrow and covered by the others.
fn without_stubs(mut rectangles: Vec<Rect>) -> Vec<Rect> {
    let all = PlanUnion::new(&rectangles).area();
    let mut k = 0;
    while k < rectangles.len() {
        let mut others = rectangles.clone();
        let own = others.remove(k);
        let covered = PlanUnion::new(&others).area() > all - 1e-6;
        match own.width.min(own.height) < STUB && covered {
            true => rectangles = others,
            false => k += 1,
        }
    }
    rectangles
}

/// Boxes without facades.
fn bare(floor_height: f64, boxes: Vec<MassBox>) -> Building {
    Building {
        name: String::new(),
        unit: String::new(),
        floor_height,
        boxes,
        facades: Vec::new(),
        special: Vec::new(),
        unobserved: Vec::new(),
    }
}

fn mass_box(style: BoxStyle, r: &Rect, height: f64) -> MassBox {
    MassBox {
        style,
        x: r.x + r.width / 2.0,
        y: r.y + r.height / 2.0,
        width: r.width,
        depth: r.height,
        height,
        roof: PLAIN,
    }
}

fn contains(a: &Rect, b: &Rect) -> bool {
    let slack = 1e-6;
    b.x >= a.x - slack
        && b.y >= a.y - slack
        && b.right() <= a.right() + slack
        && b.top() <= a.top() + slack
}

/// The place of part `k` inside the plan nearest to the wanted one.
fn place(wanted: &Rect, k: usize, plan: &[Rect], placed: &[(BoxStyle, Rect, f64)]) -> Option<Rect> {
    let all = PlanUnion::new(plan);
    let bounds = all.bounding_box()?;
    let lines = |ends: fn(&Rect) -> [f64; 2], size: f64, own: f64| -> Vec<f64> {
        let mut at: Vec<f64> = plan
            .iter()
            .flat_map(ends)
            .flat_map(|v| [v, v - size])
            .collect();
        at.push((own * 1e3).round() / 1e3);
        at
    };
    let xs = lines(|r| [r.x, r.right()], wanted.width, wanted.x);
    let ys = lines(|r| [r.y, r.top()], wanted.height, wanted.y);
    let mut places: Vec<(f64, Rect)> = Vec::new();
    for &x in &xs {
        for &y in &ys {
            let r = Rect::new(x, y, wanted.width, wanted.height);
            let far = (x - wanted.x).hypot(y - wanted.y);
            let front = y + r.height / 2.0 < bounds.y + bounds.height / 2.0;
            let on_its_side = k == 0 || front == (k == 1);
            if on_its_side && placed.iter().all(|(_, p, _)| p.overlap(&r) < 1e-9) {
                places.push((far, r));
            }
        }
    }
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    let parts = |r: &Rect| -> Vec<Rect> {
        let known = placed.iter().map(|p| p.1);
        known.chain([*r]).collect()
    };
    let area = all.area();
    let fits = |r: &Rect| {
        let covered: Vec<Rect> = plan.iter().copied().chain([*r]).collect();
        if PlanUnion::new(&covered).area() > area + 1e-6 {
            return false;
        }
        let rest = PlanUnion::new(&without(plan, &parts(r)));
        let sound = rest.soundness();
        let whole = sound.parts == 1 && !sound.courtyard && sound.pinches == 0;
        // A part inside, without a wall to the open air, leaves the boundary of the plan longer.
        let outside = rest.perimeter() < all.perimeter() + 2.0 * (r.width + r.height) - 1.0;
        whole && outside && sound.thickness >= 1.5 && rest.area() > 0.4 * area
    };
    places.into_iter().map(|p| p.1).find(fits)
}

/// The plan without some rectangles, as cells of the grid of all edges.
pub(super) fn without(plan: &[Rect], parts: &[Rect]) -> Vec<Rect> {
    let lines = |ends: fn(&Rect) -> [f64; 2]| {
        let mut v: Vec<f64> = plan.iter().chain(parts).flat_map(ends).collect();
        v.sort_by(f64::total_cmp);
        v.dedup_by(|a, b| *a - *b < 1e-9);
        v
    };
    let (xs, ys) = (lines(|r| [r.x, r.right()]), lines(|r| [r.y, r.top()]));
    let mut cells = Vec::new();
    for x in xs.windows(2) {
        for y in ys.windows(2) {
            let middle = [(x[0] + x[1]) / 2.0, (y[0] + y[1]) / 2.0];
            let inside = |r: &Rect| {
                r.x < middle[0] && middle[0] < r.right() && r.y < middle[1] && middle[1] < r.top()
            };
            if plan.iter().any(inside) && !parts.iter().any(inside) {
                cells.push(Rect::new(x[0], y[0], x[1] - x[0], y[1] - y[0]));
            }
        }
    }
    cells
}

/// Rectangles of an upper floor of the given area, among those below: the largest that overlap, the last one cut.
fn upper(below: &[Rect], area: f64) -> Option<Vec<Rect>> {
    let mut left: Vec<Rect> = below.to_vec();
    left.sort_by(|a, b| b.area().total_cmp(&a.area()));
    let mut chosen: Vec<Rect> = Vec::new();
    while !left.is_empty() {
        let meets = |r: &Rect| chosen.is_empty() || chosen.iter().any(|c| c.overlap(r) > 1.0);
        let k = left.iter().position(meets)?;
        let next = left.remove(k);
        let with = |r: &Rect| {
            let all: Vec<Rect> = chosen.iter().chain([r]).copied().collect();
            PlanUnion::new(&all).area()
        };
        if with(&next) <= area {
            chosen.push(next);
            continue;
        }
        // The part of it, from either end of its longer axis, at which the area is right.
        let part = |share: f64, high: bool| match next.width >= next.height {
            true => {
                let w = next.width * share;
                let x = if high { next.right() - w } else { next.x };
                Rect::new(x, next.y, w, next.height)
            }
            false => {
                let h = next.height * share;
                let y = if high { next.top() - h } else { next.y };
                Rect::new(next.x, y, next.width, h)
            }
        };
        for high in [true, false] {
            let (mut low, mut most) = (0.0, 1.0);
            for _ in 0..60 {
                let middle = (low + most) / 2.0;
                if with(&part(middle, high)) < area {
                    low = middle;
                } else {
                    most = middle;
                }
            }
            let mut found = chosen.clone();
            found.push(part(low, high));
            let sound = PlanUnion::new(&found).soundness();
            if sound.parts == 1 && sound.pinches == 0 && sound.thickness >= 1.0 {
                return Some(found);
            }
        }
        // Too thin a rest: as near as whole rectangles come.
        return (!chosen.is_empty()).then_some(chosen);
    }
    (!chosen.is_empty()).then_some(chosen)
}
