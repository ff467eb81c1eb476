//! Rows: buildings of one direction, each with a wall in common with the next.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::rectangle::{Rectangle, near};

/// Neighbours in a row are parallel, or at right angles, within so many degrees.
const PARALLEL: f64 = 5.0;
/// Their walls are so near to each other, in metres,
const TOUCHING: f64 = 0.5;
/// and lie side by side for at least so many metres.
const WALL: f64 = 3.0;

/// A side of a building: 0 is where its x axis leads, and the others follow counterclockwise.
type Side = usize;

/// A wall that two buildings have in common.
struct Wall {
    sides: [(usize, Side); 2],
    length: f64,
    gap: f64,
}

/// The rows of a plan, a building that stands in none as a row of its own: each building is in one.
///
/// On each side a building has at most one neighbour, the one with which it has the longest wall in common if that holds the other way round,
/// too. A row goes straight on through a building; where two rows cross, the longer one keeps it.
pub(super) fn rows(plan: &[Rectangle]) -> Vec<Vec<usize>> {
    let next = neighbours(plan);
    let mut waiting = BinaryHeap::new();
    let mut seen = vec![[false; 2]; plan.len()];
    for start in 0..plan.len() {
        for axis in 0..2 {
            if seen[start][axis] {
                continue;
            }
            let row = straight(start, axis, &next);
            for &(i, axis) in &row {
                seen[i][axis] = true;
            }
            let row: Vec<usize> = row.into_iter().map(|(i, _)| i).collect();
            waiting.extend(Some(row).filter(|r| r.len() > 1).map(ranked));
        }
    }
    let mut taken = vec![false; plan.len()];
    let mut out = Vec::new();
    while let Some((_, Reverse(row))) = waiting.pop() {
        if !row.iter().any(|&i| taken[i]) {
            row.iter().for_each(|&i| taken[i] = true);
            out.push(row);
            continue;
        }
        let pieces = row.split(|&i| taken[i]).filter(|piece| piece.len() > 1);
        waiting.extend(pieces.map(|piece| ranked(piece.to_vec())));
    }
    out.extend((0..plan.len()).filter(|&i| !taken[i]).map(|i| vec![i]));
    out
}

/// A row with its rank: long ones first, and of those of one length the first in the order of the plan.
fn ranked(mut row: Vec<usize>) -> (usize, Reverse<Vec<usize>>) {
    if row.last() < row.first() {
        row.reverse();
    }
    (row.len(), Reverse(row))
}

/// The neighbour on each side of each building, and the side that it has there.
fn neighbours(plan: &[Rectangle]) -> Vec<[Option<(usize, Side)>; 4]> {
    let pairs = near(plan, TOUCHING);
    let mut walls: Vec<Wall> = pairs
        .iter()
        .filter_map(|&[i, j]| wall(plan, i, j))
        .collect();
    let length = |w: &Wall| Reverse((w.length * 1000.0).round() as i64);
    walls.sort_by(|a, b| {
        let [x, y] = [a, b].map(|w| (length(w), w.sides));
        x.cmp(&y).then(a.gap.total_cmp(&b.gap))
    });
    // The longest wall of a side is the first that names it.
    let mut first: Vec<[Option<usize>; 4]> = vec![[None; 4]; plan.len()];
    for (k, wall) in walls.iter().enumerate() {
        for (i, side) in wall.sides {
            first[i][side].get_or_insert(k);
        }
    }
    let mut next = vec![[None; 4]; plan.len()];
    for (k, wall) in walls.iter().enumerate() {
        let [(i, p), (j, q)] = wall.sides;
        if first[i][p] == Some(k) && first[j][q] == Some(k) {
            next[i][p] = Some((j, q));
            next[j][q] = Some((i, p));
        }
    }
    next
}

/// The wall that two buildings have in common.
fn wall(plan: &[Rectangle], i: usize, j: usize) -> Option<Wall> {
    let [one, other] = [i, j].map(|k| &plan[k]);
    let turn = (other.turn - one.turn).rem_euclid(360.0);
    let quarters = (turn / 90.0).round();
    if (turn - 90.0 * quarters).abs() > PARALLEL {
        return None;
    }
    let quarters = quarters as usize % 4;
    let mut half = other.half;
    if quarters % 2 == 1 {
        half.swap(0, 1);
    }
    let middle = one.own(other);
    let apart = [0, 1].map(|k| middle[k].abs() - one.half[k] - half[k]);
    let axis = usize::from(apart[1] > apart[0]);
    let side = axis + if middle[axis] < 0.0 { 2 } else { 0 };
    let length = -apart[1 - axis];
    let length = length.min(2.0 * one.half[1 - axis].min(half[1 - axis]));
    let gap = apart[axis].abs();
    (gap <= TOUCHING && length >= WALL).then_some(Wall {
        sides: [(i, side), (j, (side + 6 - quarters) % 4)],
        length,
        gap,
    })
}

/// The buildings on a straight line through one along an axis, each with the axis that lies along the line.
fn straight(start: usize, axis: usize, next: &[[Option<(usize, Side)>; 4]]) -> Vec<(usize, usize)> {
    let mut row = vec![(start, axis)];
    for side in [axis, axis + 2] {
        let (mut at, mut side) = (start, side);
        // A crescent may close, and a spiral may meet itself.
        while let Some((i, entered)) = next[at][side]
            && row.iter().all(|&(k, _)| k != i)
        {
            row.push((i, entered % 2));
            (at, side) = (i, (entered + 2) % 4);
        }
        row.reverse();
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    fn terrace(houses: usize, at: [f64; 2], turn: f64) -> Vec<Rectangle> {
        let (sin, cos) = turn.to_radians().sin_cos();
        let house = |k: usize| Rectangle {
            at: [at[0] + 6.0 * k as f64 * cos, at[1] + 6.0 * k as f64 * sin],
            turn: turn + 90.0 * (k % 4) as f64,
            half: if k.is_multiple_of(2) {
                [3.0, 5.0]
            } else {
                [5.0, 3.0]
            },
        };
        (0..houses).map(house).collect()
    }

    #[test]
    fn terraces_are_rows_however_their_houses_are_turned() {
        for turn in [0.0, 17.0, 90.0, 203.0, 359.0] {
            let mut plan = terrace(7, [0.0; 2], turn);
            plan.extend(terrace(4, [200.0, 50.0], turn + 40.0));
            plan.push(Rectangle {
                at: [400.0, 0.0],
                ..plan[0]
            });
            let mut found = rows(&plan);
            found.sort();
            let expected = [(0..7).collect(), (7..11).collect(), vec![11]];
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn the_longer_row_keeps_the_corner() {
        let mut plan = terrace(6, [0.0; 2], 0.0);
        // A shorter row leaves the fourth house upward.
        let down = |k: usize| Rectangle {
            at: [18.0, 9.0 + 8.0 * k as f64],
            turn: 0.0,
            half: [3.0, 4.0],
        };
        plan.extend((0..3).map(down));
        let mut found = rows(&plan);
        found.sort();
        assert_eq!(found, [(0..6).collect::<Vec<_>>(), (6..9).collect()]);
    }

    #[test]
    fn a_wall_of_two_metres_and_a_passage_end_a_row() {
        let mut plan = terrace(2, [0.0; 2], 0.0);
        plan[1].at[1] = 8.5;
        assert_eq!(rows(&plan).len(), 2);
        let mut plan = terrace(2, [0.0; 2], 0.0);
        plan[1].at[0] = 6.6;
        assert_eq!(rows(&plan).len(), 2);
        plan[1].at[0] = 6.4;
        assert_eq!(rows(&plan).len(), 1);
    }

    #[test]
    fn a_ring_is_a_row_once() {
        // A hundred houses around a circus, each turned by 3.6 degrees.
        let house = |k: usize| {
            let turn = 3.6 * k as f64;
            let (sin, cos) = turn.to_radians().sin_cos();
            let radius = 95.0;
            Rectangle {
                at: [radius * sin, -radius * cos],
                turn,
                half: [3.0, 2.0],
            }
        };
        let plan: Vec<Rectangle> = (0..100).map(house).collect();
        let found = rows(&plan);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].len(), 100);
    }
}
