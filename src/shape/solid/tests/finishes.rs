//! Boundaries between finishes within one plane.

use super::*;
use crate::solid::FaceKey;

/// The corners of each top, by its finish, sorted.
fn tops(prisms: &[Prism]) -> Vec<(Finish, Vec<[f64; 2]>)> {
    let built = faces(prisms);
    let tops = built.faces.iter().filter_map(|face| {
        let FaceKey::Top(_) = face.key else {
            return None;
        };
        let mut corners: Vec<[f64; 2]> = face
            .edges
            .iter()
            .map(|[v, _]| built.positions[*v as usize])
            .map(|[x, y, _]| [x, y])
            .collect();
        corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
        Some((face.finish, corners))
    });
    let mut tops: Vec<(Finish, Vec<[f64; 2]>)> = tops.collect();
    tops.sort_by_key(|top| top.0);
    tops
}

/// Two finishes that meet in one plane along a bent line keep its corner, although only two faces meet there; corners on a
/// straight line go.
#[test]
fn a_bent_line_between_two_finishes_keeps_its_corner() {
    let corner = |plan: [i128; 4], top: Finish| Prism {
        top,
        ..cuboid([plan[0], plan[1], 0], [plan[2], plan[3], 2])
    };
    let deck = corner([2, 2, 4, 4], Finish::Deck);
    let bent = [
        corner([0, 0, 2, 2], Finish::Roof),
        corner([2, 0, 4, 2], Finish::Roof),
        corner([0, 2, 2, 4], Finish::Roof),
        deck,
    ];
    let square = vec![[1.0, 1.0], [1.0, 2.0], [2.0, 1.0], [2.0, 2.0]];
    let ell = vec![
        [0.0, 0.0],
        [0.0, 2.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [2.0, 0.0],
        [2.0, 1.0],
    ];
    assert_eq!(tops(&bent), [(Finish::Roof, ell), (Finish::Deck, square)]);
    let report = faces(&bent).triangulated().unwrap().check().unwrap();
    assert!((report.volume - 4.0).abs() < 1e-9);
    // Along a straight line between the finishes the corner in the middle goes.
    let straight = [
        corner([0, 0, 2, 2], Finish::Roof),
        corner([2, 0, 4, 2], Finish::Roof),
        corner([0, 2, 2, 4], Finish::Deck),
        corner([2, 2, 4, 4], Finish::Deck),
    ];
    let low = vec![[0.0, 0.0], [0.0, 1.0], [2.0, 0.0], [2.0, 1.0]];
    let high = vec![[0.0, 1.0], [0.0, 2.0], [2.0, 1.0], [2.0, 2.0]];
    assert_eq!(tops(&straight), [(Finish::Roof, low), (Finish::Deck, high)]);
}
