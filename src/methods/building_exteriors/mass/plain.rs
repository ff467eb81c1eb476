//! Plain ground plans with exactly the wanted coverage and boundary: a rectangle with corners cut off and a recess.
//!
//! A corner cut off takes area and leaves the boundary; a recess of depth t takes area and adds 2 t. So the depth of the
//! recess follows from the boundary, and the area of the corners from the coverage. Most real plans are of this kind
//! ([`crate::coding`]); what is drawn is which corner or side, and how an area is shared between width and depth.

use rand::{Rng, RngExt};

use super::fit::millimetres;
use super::footprint::{stand, without};
use super::target::MassTarget;
use super::{MASS, MassModel, max_z};
use crate::attributes::mass_attributes;
use edifice_shape::{BoxStyle, Rect, Roof};

/// Shares of the bounding box that a cut corner may take along an axis, and least extents of a wing beside it (m).
const CUT: [f64; 2] = [0.2, 0.7];
const WING: f64 = 2.6;
/// Smallest cut area (square metres), and shortest boundary that is a recess (m).
const LEAST: f64 = 0.05;
const SHORTEST: f64 = 0.05;
/// Narrowest recess (m).
const NARROWEST: f64 = 1.5;

/// A mass model on a plain plan, its roofs as given; `None` where the plan drawn has no room for the floors.
pub(super) fn plain(
    target: &MassTarget,
    roof: Roof,
    deviations: &[f64],
    rng: &mut impl Rng,
) -> Option<MassModel> {
    let plan = plan(target, rng)?;
    let row: [f64; 49] = std::array::from_fn(|c| target.wanted.get(c).copied().unwrap_or(0.0));
    let mut model = stand(&row, &[false; 49], &plan, &deviations[..MASS]).ok()?;
    for b in &mut model.building.boxes {
        if b.style == BoxStyle::Main {
            b.roof = roof;
        }
        (b.x, b.width) = on_millimetres(b.x, b.width);
        (b.y, b.depth) = on_millimetres(b.y, b.depth);
    }
    let measured = mass_attributes(&model.building);
    model.max_z = max_z(&measured, &target.wanted, deviations);
    Some(model)
}

/// Middle and extent of an interval whose ends are moved to whole millimetres.
fn on_millimetres(middle: f64, extent: f64) -> (f64, f64) {
    let [low, high] = [-0.5, 0.5].map(|share| millimetres(middle + share * extent));
    ((low + high) / 2.0, high - low)
}

/// Rectangles of a plan from the left front corner on.
fn plan(target: &MassTarget, rng: &mut impl Rng) -> Option<Vec<Rect>> {
    let [w, d] = [0, 1].map(|axis| target.extent(axis));
    let area = target.wanted[3] * w * d;
    let mut missing = w * d - area;
    let mut holes: Vec<Rect> = Vec::new();
    let longer = target.wanted[4] * area.sqrt() - 2.0 * (w + d);
    if longer > SHORTEST {
        let depth = longer / 2.0;
        let along_x = rng.random::<bool>();
        let [length, across] = if along_x { [w, d] } else { [d, w] };
        let most = length - 2.0 * WING;
        if depth > across - WING || most < NARROWEST {
            return None;
        }
        let width = match rng.random::<bool>() {
            true => missing / depth,
            false => rng.random_range(NARROWEST..=most).min(missing / depth),
        };
        if !(NARROWEST..=most).contains(&width) {
            return None;
        }
        let start = rng.random_range(WING..=length - WING - width);
        let at = if rng.random() { 0.0 } else { across - depth };
        holes.push(match along_x {
            true => Rect::new(start, at, width, depth),
            false => Rect::new(at, start, depth, width),
        });
        missing -= width * depth;
    }
    let corners = match missing {
        m if m < LEAST => 0,
        _ => rng.random_range(1..=2),
    };
    let first: usize = rng.random_range(0..4);
    for k in 0..corners {
        let own = missing / corners as f64;
        let share = rng.random_range(CUT[0]..CUT[1]);
        let width = (share * w).max(own / (CUT[1] * d)).min(w - WING);
        let depth = own / width;
        if width < 0.5 || !(0.5..=d - WING).contains(&depth) {
            return None;
        }
        // Neighbouring corners: left, right, and those at the back.
        let (right, back) =
            [(false, false), (true, false), (true, true), (false, true)][(first + k) % 4];
        let hole = Rect::new(
            if right { w - width } else { 0.0 },
            if back { d - depth } else { 0.0 },
            width,
            depth,
        );
        holes.push(hole);
    }
    let meets = |a: &Rect, b: &Rect| {
        let x = a.right().min(b.right()) - a.x.max(b.x);
        let y = a.top().min(b.top()) - a.y.max(b.y);
        x.min(y) > -WING / 2.0
    };
    let apart = (0..holes.len()).all(|i| (0..i).all(|j| !meets(&holes[i], &holes[j])));
    apart.then(|| without(&[Rect::new(0.0, 0.0, w, d)], &holes))
}
