//! Windows, doors and garage doors as panels set into walls.

use edifice_shape::ElementStyle;
use edifice_shape::solid::{Finish, Panel, Span};

/// Distance of a casing before the wall, and of a frame, a pane and a door behind it (m).
const CASING: f64 = 0.035;
const FRAME: f64 = 0.06;
const PANE: f64 = 0.1;
const LEAF: f64 = 0.12;
/// Width of a casing around an element, and of the bars of a frame (m).
pub(super) const MARGIN: f64 = 0.09;
const BAR: f64 = 0.055;
/// Depth of a bay before the wall, and the length by which it gets narrower on each side (m).
const BAY: f64 = 0.45;
const TAPER: f64 = 0.22;

/// The element with a casing around it, its mouth larger than the element.
pub fn cased(style: ElementStyle, rect: Span) -> Panel {
    let mouth = grown(rect, MARGIN);
    if style == ElementStyle::Bay {
        return bay(rect);
    }
    let below = if style == ElementStyle::Door {
        0.0
    } else {
        MARGIN
    };
    let mouth = [mouth[0], [rect[1][0] - below, mouth[1][1]]];
    let face = [
        [mouth[0][0] + 0.01, mouth[0][1] - 0.01],
        [mouth[1][0] + 0.01 * (below / MARGIN), mouth[1][1] - 0.01],
    ];
    let rect = match style {
        // A door's casing has a narrow threshold.
        ElementStyle::Door => [rect[0], [rect[1][0] + 0.03, rect[1][1]]],
        _ => rect,
    };
    Panel {
        mouth,
        face,
        depth: -CASING,
        reveal: Finish::Frame,
        finish: Finish::Frame,
        inner: vec![bare(style, rect)],
    }
}

/// The element in the wall, without a casing: its mouth is its rectangle.
pub fn bare(style: ElementStyle, rect: Span) -> Panel {
    match style {
        ElementStyle::Bay => bay(rect),
        ElementStyle::Door => door(rect),
        style => Panel {
            mouth: rect,
            face: rect,
            depth: FRAME,
            reveal: Finish::Frame,
            finish: Finish::Frame,
            inner: panes(style, rect),
        },
    }
}

/// The panes of a window: what tells its style.
fn panes(style: ElementStyle, rect: Span) -> Vec<Panel> {
    let (columns, rows): (usize, &[f64]) = match style {
        ElementStyle::Sash => (1, &[0.5, 0.5]),
        ElementStyle::Sliding => (2, &[1.0]),
        ElementStyle::Casement => (2, &[0.68, 0.32]),
        ElementStyle::Bay => (2, &[0.7, 0.3]),
        ElementStyle::Fixed | ElementStyle::Door => (1, &[1.0]),
    };
    let size = [0, 1].map(|a| rect[a][1] - rect[a][0]);
    let bar = BAR.min(0.06 * size[0]).min(0.06 * size[1]);
    let mut panes = Vec::new();
    let width = (size[0] - bar) / columns as f64;
    let mut z = rect[1][0] + bar;
    for share in rows {
        let height = (size[1] - bar) * share;
        for k in 0..columns {
            let u = rect[0][0] + bar + k as f64 * width;
            let own = [[u, u + width - bar], [z, z + height - bar]];
            // The upper sash lies before the lower one.
            let depth = if style == ElementStyle::Sash && z > rect[1][0] + size[1] / 3.0 {
                PANE - 0.02
            } else {
                PANE
            };
            panes.push(plain(own, depth, Finish::Frame, Finish::Pane));
        }
        z += height;
    }
    panes
}

fn plain(rect: Span, depth: f64, reveal: Finish, finish: Finish) -> Panel {
    Panel {
        mouth: rect,
        face: rect,
        depth,
        reveal,
        finish,
        inner: Vec::new(),
    }
}

fn door(rect: Span) -> Panel {
    let mut leaf = plain(rect, LEAF, Finish::Frame, Finish::Door);
    let size = [0, 1].map(|a| rect[a][1] - rect[a][0]);
    let at = |u: [f64; 2], z: [f64; 2]| {
        [
            [rect[0][0] + u[0] * size[0], rect[0][0] + u[1] * size[0]],
            [rect[1][0] + z[0] * size[1], rect[1][0] + z[1] * size[1]],
        ]
    };
    leaf.inner = vec![
        plain(
            at([0.18, 0.82], [0.08, 0.45]),
            LEAF + 0.02,
            Finish::Door,
            Finish::Door,
        ),
        plain(
            at([0.18, 0.82], [0.55, 0.9]),
            LEAF + 0.02,
            Finish::Door,
            Finish::Pane,
        ),
    ];
    leaf
}

/// A door for cars: a leaf of four rows of panels.
pub fn garage_door(rect: Span) -> Panel {
    let mut leaf = plain(rect, LEAF, Finish::Frame, Finish::GarageDoor);
    let columns = (((rect[0][1] - rect[0][0]) / 0.7).round() as usize).max(2);
    let size = [0, 1].map(|a| rect[a][1] - rect[a][0]);
    let cell = [size[0] / columns as f64, size[1] / 4.0];
    for i in 0..columns {
        for j in 0..4 {
            let (u, z) = (
                rect[0][0] + i as f64 * cell[0],
                rect[1][0] + j as f64 * cell[1],
            );
            let own = [
                [u + 0.12 * cell[0], u + 0.88 * cell[0]],
                [z + 0.15 * cell[1], z + 0.85 * cell[1]],
            ];
            let finish = if j == 3 {
                Finish::Pane
            } else {
                Finish::GarageDoor
            };
            leaf.inner
                .push(plain(own, LEAF + 0.025, Finish::GarageDoor, finish));
        }
    }
    Panel {
        mouth: grown(rect, 0.0),
        ..leaf
    }
}

/// A bay: a box before the wall, narrower in front, with a window of several lights.
fn bay(rect: Span) -> Panel {
    let [[u0, u1], [z0, z1]] = rect;
    let (w, h) = (u1 - u0, z1 - z0);
    let taper = TAPER.min(0.18 * w);
    // Narrow bays stand out less.
    let depth = BAY.min(0.4 * w);
    let face = [[u0 + taper, u1 - taper], [z0, z1 - 0.06 * h]];
    let side = 0.1 * (face[0][1] - face[0][0]);
    let glass = [
        [face[0][0] + side, face[0][1] - side],
        [z0 + 0.2 * h, face[1][1] - 0.06 * h],
    ];
    Panel {
        mouth: rect,
        face,
        depth: -depth,
        reveal: Finish::Frame,
        finish: Finish::Frame,
        inner: vec![Panel {
            mouth: glass,
            face: glass,
            depth: 0.03 - depth,
            reveal: Finish::Frame,
            finish: Finish::Frame,
            inner: panes_at(glass, 0.06 - depth),
        }],
    }
}

fn panes_at(rect: Span, depth: f64) -> Vec<Panel> {
    let panes = panes(ElementStyle::Bay, rect);
    panes.into_iter().map(|p| Panel { depth, ..p }).collect()
}

fn grown(rect: Span, by: f64) -> Span {
    rect.map(|[low, high]| [low - by, high + by])
}
