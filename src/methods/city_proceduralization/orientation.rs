//! The front of a component: of the two half turns of its box, one is canonical, so that like components, and
//! like buildings, have like frames.

use std::f64::consts::{FRAC_PI_2, PI};

use super::component::{CELLS, Component};

/// First moments below this share of the mean say nothing about the orientation.
const SYMMETRIC: f64 = 0.004;
/// Shifts of an upper component below this share of the base's sides say nothing either.
const CENTRED: f64 = 0.04;
/// Directions are compared from -90 to 90 degrees, less this, so that right angles are on one side.
const MARGIN: f64 = 0.1;

/// The half turn that puts more of the volume at positive x, or at positive y, where x does not tell; `None`
/// where neither does.
pub(super) fn upside_down(heights: &[f32]) -> Option<bool> {
    let middle = (CELLS as f64 - 1.0) / 2.0;
    let (mut x, mut y, mut total) = (0.0, 0.0, 0.0);
    for (i, &h) in heights.iter().enumerate() {
        let h = f64::from(h);
        x += h * ((i % CELLS) as f64 - middle);
        y += h * ((i / CELLS) as f64 - middle);
        total += h;
    }
    let least = SYMMETRIC * total * CELLS as f64;
    match (x.abs() > least, y.abs() > least) {
        (true, _) => Some(x < 0.0),
        (false, true) => Some(y < 0.0),
        _ => None,
    }
}

/// Orients the components of a building that half a turn does not change: the first one as the others ask, the others
/// along the first one.
pub(super) fn orient(components: &mut [Component]) {
    if components.is_empty() {
        return;
    }
    if components[0].symmetric && faces_back(components) {
        half_turn(&mut components[0]);
    }
    let along = components[0].frame.angle;
    for c in &mut components[1..] {
        if c.symmetric && opposite(c.frame.angle - along) {
            half_turn(c);
        }
    }
}

/// True if half a turn changes nothing of a building that [`orient`] has seen.
pub(super) fn is_symmetric<'a>(mut components: impl Iterator<Item = &'a Component>) -> bool {
    let Some(first) = components.next() else {
        return true;
    };
    let centred = |c: &Component| {
        let [x, y, _] = first.frame.to_unit(c.frame.base);
        x.abs() <= CENTRED && y.abs() <= CENTRED
    };
    first.symmetric && components.all(|c| c.symmetric && centred(c))
}

/// True if the first component, which is symmetric, looks away from what stands on it.
fn faces_back(components: &[Component]) -> bool {
    let first = &components[0].frame;
    if let Some(c) = components.iter().find(|c| !c.symmetric) {
        return opposite(c.frame.angle - first.angle);
    }
    for c in &components[1..] {
        let [x, y, _] = first.to_unit(c.frame.base);
        if x.abs() > CENTRED {
            return x < 0.0;
        }
        if y.abs() > CENTRED {
            return y < 0.0;
        }
    }
    false
}

fn opposite(turn: f64) -> bool {
    let turn = (turn + PI).rem_euclid(2.0 * PI) - PI;
    !(MARGIN - FRAC_PI_2..FRAC_PI_2 + MARGIN).contains(&turn)
}

/// Turns the frame by half a turn, under what it holds.
pub(super) fn half_turn(c: &mut Component) {
    c.frame.angle = (c.frame.angle + PI).rem_euclid(2.0 * PI);
    for p in &mut c.mesh.positions {
        *p = [-p[0], -p[1], p[2]];
    }
    c.heights.reverse();
}
