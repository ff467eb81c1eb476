//! A plan of overlapping boxes that has the drawn numbers.
//!
//! ```text
//!  y = D        +-----+------+          wing, and behind it a back porch
//!       notch   | wing | porch
//!  +--bump--+---+-----+------+ D - n_d
//!  |      middle (tall to the right)  |
//!  +-+ garage +--+ porch +---+ room   |  y = front step
//!    +--------+  +-------+   +--------+  y = 0
//! ```
//! The notch at the back left takes away the area that the coverage asks for; the bump inside it
//! adds twice its depth to the perimeter. Both are solved for in closed form.

use super::draw::{Numbers, Part};
use super::styles::Kinds;
use crate::shape::{BoxStyle, MassBox, PlanUnion, Rect, Ridge, Roof, RoofStyle};

pub(super) struct Plan {
    pub floor_height: f64,
    pub boxes: Vec<MassBox>,
}

/// Depth of the notch as a share of the depth of the house.
const NOTCH: f64 = 0.40;

/// The boxes, or `None` when the numbers do not fit together.
pub(super) fn build(n: &Numbers, kinds: &Kinds) -> Option<Plan> {
    let (w, d) = (n.width, n.depth);
    let floor = millimetres(n.floor_height);
    let notch_depth = NOTCH * d;
    let back = d - notch_depth;
    let step = n.front_step;
    let room = 0.3 * w;

    let garage = n.garage.map(|p| place(&p, w, d));
    let front = n.front_porch.map(|p| place(&p, w, d));
    let rear = n.back_porch.map(|p| place(&p, w, d));
    check_front(garage, front, w - room, step, back)?;
    // Where the wing's back wall steps in for the porch, or the right wall without one.
    let wing_end = rear.map_or(w, |p| p.x);
    if rear.is_some_and(|p| p.right() > w - 0.02 || p.y > d - n.back_step - 0.1) {
        return None;
    }

    // Solids without notch and bump, to see how much area and boundary is missing.
    let wing = |start: f64| Rect::new(start, back - 0.5, wing_end - start, notch_depth + 0.5);
    let mut ground = vec![
        Rect::new(0.0, step, w, back - step),
        Rect::new(w - room, 0.0, room, step + 1.0),
        wing(0.0),
    ];
    if rear.is_some() {
        let depth = notch_depth - n.back_step + 0.5;
        ground.push(Rect::new(
            wing_end - 0.5,
            back - 0.5,
            w - wing_end + 0.5,
            depth,
        ));
    }
    let parts = [garage, front, rear];
    let solid: Vec<Rect> = ground
        .iter()
        .copied()
        .chain(parts.into_iter().flatten())
        .collect();
    let full = PlanUnion::new(&solid);
    let area = n.bcr * w * d;
    let bump_depth = (n.bdry * area.sqrt() - full.perimeter()) / 2.0;
    if !(0.15..notch_depth - 0.3).contains(&bump_depth) {
        return None;
    }
    // The bump is half as wide as the notch.
    let notch = (full.area() - area) / (notch_depth - bump_depth / 2.0);
    if !(0.3..wing_end - 0.25).contains(&notch) {
        return None;
    }
    ground[2] = wing(notch);
    ground.push(Rect::new(
        notch / 4.0,
        back - 0.5,
        notch / 2.0,
        bump_depth + 0.5,
    ));

    let mut boxes: Vec<MassBox> = ground
        .iter()
        .map(|r| mass_box(BoxStyle::Main, r, floor))
        .collect();
    let total = area / n.arf[0];
    for k in 1..n.floors {
        let tall = n.arf[k] * total / (back - step);
        if tall > w {
            return None;
        }
        let slab = Rect::new(w - tall, step, tall, back - step);
        boxes.push(mass_box(BoxStyle::Main, &slab, floor * (k + 1) as f64));
    }
    let styles = [BoxStyle::Garage, BoxStyle::Porch, BoxStyle::Porch];
    let heights = [n.garage, n.front_porch, n.back_porch];
    for ((style, place), part) in styles.into_iter().zip(parts).zip(heights) {
        if let (Some(place), Some(part)) = (place, part) {
            boxes.push(mass_box(style, &place, part.height));
        }
    }
    for (i, b) in boxes.iter_mut().enumerate() {
        b.roof.style = kinds.roofs[i % kinds.roofs.len()];
        b.roof.pitch = if b.roof.style == RoofStyle::Flat {
            0.0
        } else {
            30.0
        };
    }
    Some(Plan {
        floor_height: floor,
        boxes,
    })
}

/// Garage, front porch and room stand in a row without touching, in front of the middle.
fn check_front(
    garage: Option<Rect>,
    porch: Option<Rect>,
    room: f64,
    step: f64,
    back: f64,
) -> Option<()> {
    let clear = 0.05;
    let mut last = 0.0;
    for part in [garage, porch].into_iter().flatten() {
        let meets_the_wall = part.top() > step + clear && part.top() < back;
        if part.x < last + clear || part.y < clear || part.y > step - clear || !meets_the_wall {
            return None;
        }
        last = part.right();
    }
    (last + clear < room).then_some(())
}

/// A part in plan, in metres.
fn place(part: &Part, width: f64, depth: f64) -> Rect {
    Rect::new(
        part.x * width - part.width / 2.0,
        part.y * depth - part.depth / 2.0,
        part.width,
        part.depth,
    )
}

/// A box with its edges on whole millimetres, as a surveyor would note them; roofs come later.
fn mass_box(style: BoxStyle, plan: &Rect, height: f64) -> MassBox {
    let (left, right) = (millimetres(plan.x), millimetres(plan.right()));
    let (front, back) = (millimetres(plan.y), millimetres(plan.top()));
    MassBox {
        style,
        x: tenths((left + right) / 2.0),
        y: tenths((front + back) / 2.0),
        width: millimetres(right - left),
        depth: millimetres(back - front),
        height: millimetres(height),
        roof: Roof {
            style: RoofStyle::Flat,
            pitch: 0.0,
            ridge: Ridge::X,
        },
    }
}

/// Rounds to millimetres.
pub(super) fn millimetres(metres: f64) -> f64 {
    (metres * 1e3).round() / 1e3
}

/// Rounds to tenths of a millimetre, where centres of boxes lie.
fn tenths(metres: f64) -> f64 {
    (metres * 1e4).round() / 1e4
}
