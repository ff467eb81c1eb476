//! Unions beside squares of a raster: rectangles on whole numbers, drawn at random.

use super::*;
use edifice_base::rng::stream;
use rand::RngExt;

/// Squares from 0 to `SIDE` with a border of one on each side.
const SIDE: usize = 9;
const ALL: usize = SIDE + 2;

/// The squares that some rectangle covers.
fn raster(rectangles: &[[usize; 4]]) -> Vec<bool> {
    let inside = |i: usize, j: usize| {
        rectangles
            .iter()
            .any(|&[x, y, w, h]| (x..x + w).contains(&i) && (y..y + h).contains(&j))
    };
    let squares = (0..ALL).flat_map(|i| (0..ALL).map(move |j| (i, j)));
    squares
        .map(|(i, j)| i > 0 && j > 0 && inside(i - 1, j - 1))
        .collect()
}

fn neighbours(square: usize) -> impl Iterator<Item = usize> {
    let (i, j) = (square / ALL, square % ALL);
    let near = [
        (i.wrapping_sub(1), j),
        (i + 1, j),
        (i, j.wrapping_sub(1)),
        (i, j + 1),
    ];
    let known = near.into_iter().filter(|&(i, j)| i < ALL && j < ALL);
    known.map(|(i, j)| i * ALL + j)
}

/// The part of each square: squares of one kind that are joined by sides.
fn parts(inside: &[bool]) -> Vec<usize> {
    let mut part: Vec<usize> = (0..inside.len()).collect();
    loop {
        let before = part.clone();
        for square in 0..inside.len() {
            for next in neighbours(square).filter(|&n| inside[n] == inside[square]) {
                part[square] = part[square].min(part[next]);
            }
        }
        if part == before {
            return part;
        }
    }
}

#[test]
fn measures_are_those_of_a_raster() {
    let rng = &mut stream(1, "plans", 0);
    let (mut courtyards, mut several, mut pinched) = (0, 0, 0);
    for _ in 0..10_000 {
        let count = rng.random_range(0..14);
        let drawn: Vec<[usize; 4]> = (0..count)
            .map(|_| {
                let [x, y] = [0; 2].map(|_| rng.random_range(0..SIDE));
                // Some are empty.
                let most = [SIDE - x, SIDE - y].map(|m| m.min(5));
                let [w, h] = most.map(|most| rng.random_range(0..=most));
                [x, y, w, h]
            })
            .collect();
        let rectangles: Vec<Rect> = drawn
            .iter()
            .map(|r| r.map(|v| v as f64))
            .map(|[x, y, w, h]| Rect::new(x, y, w, h))
            .collect();
        let union = PlanUnion::new(&rectangles);
        let inside = raster(&drawn);
        let part = parts(&inside);
        let covered = inside.iter().filter(|i| **i).count();
        assert_eq!(union.area(), covered as f64, "{drawn:?}");

        let borders = |of: &[bool], seen: &dyn Fn(usize) -> bool| {
            let squares = (0..of.len()).filter(|&s| of[s]);
            squares
                .flat_map(|s| neighbours(s).filter(|&n| !of[n]))
                .filter(|&n| seen(n))
                .count() as f64
        };
        assert_eq!(union.perimeter(), borders(&inside, &|_| true), "{drawn:?}");
        let length = |e: &PlanEdge| e.end - e.start;
        let outline: f64 = union.outline().iter().map(length).sum();
        assert_eq!(outline, union.perimeter(), "{drawn:?}");

        let sound = union.soundness();
        let roots = |kind: bool| {
            let of_kind = (0..inside.len()).filter(|&s| part[s] == s && inside[s] == kind);
            of_kind.count()
        };
        assert_eq!(sound.parts, roots(true), "{drawn:?}");
        assert_eq!(sound.courtyard, roots(false) > 1, "{drawn:?}");
        let corners = (1..ALL).flat_map(|i| (1..ALL).map(move |j| i * ALL + j));
        let pinches = corners.filter(|&s| {
            let [a, b, c, d] = [s, s - 1, s - ALL, s - ALL - 1].map(|s| inside[s]);
            a == d && b == c && a != b
        });
        assert_eq!(sound.pinches, pinches.count(), "{drawn:?}");

        let some = rng.random_range(0..=drawn.len());
        let seen = visibility(&rectangles[..some], &rectangles);
        let own = raster(&drawn[..some]);
        assert_eq!(seen.perimeter, borders(&own, &|_| true), "{drawn:?}");
        let visible = borders(&own, &|n| !inside[n] && part[n] == part[0]);
        assert_eq!(seen.visible, visible, "{drawn:?}");

        courtyards += usize::from(sound.courtyard);
        several += usize::from(sound.parts > 1);
        pinched += usize::from(sound.pinches > 0);
    }
    assert!(
        courtyards > 100 && several > 500 && pinched > 100,
        "{courtyards} {several} {pinched}"
    );
}
