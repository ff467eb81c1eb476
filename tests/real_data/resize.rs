//! Real facades at other widths.

use edifice::layout::regularize::regularize_grid;
use edifice::layout::resize::resized;
use edifice::shape::{Facade, decompose};

use crate::facades::label_images;

/// Shares of the own width.
const WIDTHS: [f64; 5] = [0.9, 0.8, 0.7, 0.6, 0.5];
/// Least share of its width that a door keeps.
const LEAST: f64 = 0.6;

/// Width of the place of the doors; `None` without one.
fn doors(facade: &Facade) -> Option<f64> {
    let doors = facade.regions.iter().filter(|r| r.label == "door");
    let ends = doors.map(|r| (r.rect.x, r.rect.right()));
    let (left, right) = ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    Some(right - left)
}

#[test]
fn doors_of_ecp_keep_their_width_when_facades_become_narrower() {
    let Some(grids) = label_images("facades/ecp2011/labels") else {
        return;
    };
    let mut narrowed = 0;
    for grid in &grids {
        let tolerance = (0.01 * grid.xs[grid.columns()].max(grid.ys[grid.rows()])).round();
        let (regular, _) = regularize_grid(grid, tolerance).expect("regular");
        let own = decompose(&regular).expect("a tiling").facade;
        let Some(width) = doors(&own) else {
            continue;
        };
        for share in WIDTHS {
            let narrow = resized(&own, share * own.width, own.height).expect("resized");
            let kept = doors(&narrow.facade).expect("the door stays") / width;
            assert!(kept >= LEAST, "{} at {share}: {kept}", grid.name);
            narrowed += 1;
        }
    }
    // 94 of the 104 facades show a door.
    assert_eq!(narrowed, 94 * WIDTHS.len());
}
