//! Boxes over a plan: the ground floor as its largest rectangles, smaller floors on some of them, and roofs.

use rand::{Rng, RngExt};

use super::draw::Numbers;
use super::lengths::millimetres;
use super::site::{PARTS, Site};
use super::styles::Kinds;
use edifice_building_exteriors::house::roofs::largest_rectangles;
use edifice_shape::{BoxStyle, MassBox, PlanUnion, Rect, Ridge, Roof, RoofStyle};

/// Least extent of an upper floor (m).
const LEAST: f64 = 3.0;
/// Length by which a wing reaches, beyond half its width, into the boxes that it joins (m).
const REACH: f64 = 0.4;
/// Slopes of roofs in degrees.
const PITCHES: [f64; 4] = [25.0, 30.0, 35.0, 40.0];

/// The boxes of a house over its main body, or `None` where the upper floors have no place.
pub(super) fn boxes(
    site: &Site,
    n: &Numbers,
    kinds: &Kinds,
    main: &[Rect],
    rng: &mut impl Rng,
) -> Option<Vec<MassBox>> {
    let total = n.bcr * n.width * n.depth / n.arf[0];
    let mut floors = vec![cover(main)];
    for share in &n.arf[1..n.floors] {
        let below = floors.last()?;
        floors.push(storey(below, share * total, rng)?);
    }
    let pitch = PITCHES[rng.random_range(0..PITCHES.len())];
    let extent = millimetres(n.width);
    let floor_height = millimetres(n.floor_height);
    let mut boxes: Vec<MassBox> = Vec::new();
    let mut add = |style, plan: &Rect, height: f64| {
        let plan = rounded(plan);
        let x = if kinds.mirrored {
            extent - plan.right()
        } else {
            plan.x
        };
        let plan = Rect::new(millimetres(x), plan.y, plan.width, plan.height);
        boxes.push(mass_box(style, &plan, height, pitch));
    };
    for (k, plans) in floors.iter().enumerate().rev() {
        // A box that goes on above is no box of its own.
        let goes_on = |r: &&Rect| floors.get(k + 1).is_some_and(|above| above.contains(r));
        for plan in plans.iter().filter(|r| !goes_on(r)) {
            add(BoxStyle::Main, plan, (k + 1) as f64 * floor_height);
        }
    }
    let places = [site.garage, site.front, site.rear];
    let heights = [n.garage, n.front_porch, n.back_porch];
    for ((style, place), part) in PARTS.into_iter().zip(places).zip(heights) {
        if let (Some(place), Some(part)) = (place, part) {
            add(style, &place, part.height);
        }
    }
    set_styles(&mut boxes, &kinds.roofs, rng)?;
    Some(boxes)
}

/// The largest rectangles of a plan, as few as cover it one after the other.
fn cover(cells: &[Rect]) -> Vec<Rect> {
    let candidates = largest_rectangles(cells);
    let whole = PlanUnion::new(cells).area();
    let mut chosen: Vec<Rect> = Vec::new();
    loop {
        let area = PlanUnion::new(&chosen).area();
        if area > whole * (1.0 - 1e-9) {
            return chosen;
        }
        let with = |r: &Rect| {
            let all: Vec<Rect> = chosen.iter().chain([r]).copied().collect();
            PlanUnion::new(&all).area()
        };
        let gains = candidates.iter().map(|r| (with(r), r));
        match gains.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((gained, r)) if gained > area => chosen.push(trimmed(r, &chosen, cells)),
            _ => return chosen,
        }
    }
}

/// A rectangle as far as it adds to those chosen before, and as far into them as its roof needs to meet theirs.
fn trimmed(r: &Rect, chosen: &[Rect], cells: &[Rect]) -> Rect {
    let middle = |c: &Rect| [c.x + c.width / 2.0, c.y + c.height / 2.0];
    let holds = |r: &Rect, [x, y]: [f64; 2]| r.x < x && x < r.right() && r.y < y && y < r.top();
    let new: Vec<Rect> = cells
        .iter()
        .filter(|c| holds(r, middle(c)) && !chosen.iter().any(|k| holds(k, middle(c))))
        .copied()
        .collect();
    let Some(own) = PlanUnion::new(&new).bounding_box() else {
        return *r;
    };
    let reach = own.width.min(own.height) / 2.0 + REACH;
    let x = (own.x - reach).max(r.x);
    let y = (own.y - reach).max(r.y);
    let (right, top) = (own.right() + reach, own.top() + reach);
    Rect::new(x, y, right.min(r.right()) - x, top.min(r.top()) - y)
}

/// A floor of the given area on the boxes of the floor below: on part of one, or on all of one and part of another.
fn storey(below: &[Rect], area: f64, rng: &mut impl Rng) -> Option<Vec<Rect>> {
    let first = below[rng.random_range(0..below.len())];
    let at_start = rng.random();
    if area <= first.area() {
        let r = shortened(&first, area / first.area(), at_start);
        return (r.width.min(r.height) >= LEAST).then(|| vec![r]);
    }
    let second = below[rng.random_range(0..below.len())];
    let union = |share: f64| {
        let r = shortened(&second, share, at_start);
        (PlanUnion::new(&[first, r]).area(), r)
    };
    if second == first || union(1.0).0 < area {
        return None;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if union(middle).0 < area {
            low = middle;
        } else {
            high = middle;
        }
    }
    let r = union(high).1;
    let plan = PlanUnion::new(&[first, r]).soundness();
    let is_whole = plan.parts == 1 && plan.pinches == 0 && plan.thickness >= LEAST / 2.0;
    (is_whole && r.width.min(r.height) >= LEAST).then(|| vec![first, r])
}

/// A share of a rectangle, cut off across its longer side.
fn shortened(r: &Rect, share: f64, at_start: bool) -> Rect {
    let shift = if at_start { 0.0 } else { 1.0 - share };
    if r.width >= r.height {
        Rect::new(r.x + shift * r.width, r.y, share * r.width, r.height)
    } else {
        Rect::new(r.x, r.y + shift * r.height, r.width, share * r.height)
    }
}

/// One roof style for the house, the others present on its last boxes: parts and low wings.
fn set_styles(boxes: &mut [MassBox], styles: &[RoofStyle], rng: &mut impl Rng) -> Option<()> {
    if styles.len() > boxes.len() {
        return None;
    }
    let main = rng.random_range(0..styles.len());
    let others = styles.iter().enumerate().filter(|(i, _)| *i != main);
    let others: Vec<RoofStyle> = others.map(|(_, s)| *s).collect();
    let last = boxes.len() - 1;
    for (i, b) in boxes.iter_mut().enumerate() {
        b.roof.style = *others.get(last - i).unwrap_or(&styles[main]);
        if b.roof.style == RoofStyle::Flat {
            b.roof.pitch = 0.0;
        }
    }
    Some(())
}

/// A rectangle with its edges on whole millimetres, as a surveyor would note them.
fn rounded(plan: &Rect) -> Rect {
    let (left, right) = (millimetres(plan.x), millimetres(plan.right()));
    let (front, back) = (millimetres(plan.y), millimetres(plan.top()));
    Rect::new(left, front, right - left, back - front)
}

/// A box with its ridge along its longer side.
fn mass_box(style: BoxStyle, plan: &Rect, height: f64, pitch: f64) -> MassBox {
    MassBox {
        style,
        x: tenths(plan.x + plan.width / 2.0),
        y: tenths(plan.y + plan.height / 2.0),
        width: millimetres(plan.width),
        depth: millimetres(plan.height),
        height: millimetres(height),
        roof: Roof {
            style: RoofStyle::Flat,
            pitch,
            ridge: if plan.width >= plan.height {
                Ridge::X
            } else {
                Ridge::Y
            },
        },
    }
}

/// Rounds to tenths of a millimetre, where centres of boxes lie.
fn tenths(metres: f64) -> f64 {
    (metres * 1e4).round() / 1e4
}
