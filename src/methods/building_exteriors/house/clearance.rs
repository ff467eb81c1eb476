//! Room before a wall for what stands out of it.

use edifice_shape::solid::{Face, Faces, Finish, Span, Wall};

/// A point in space, in metres.
type Point = [f64; 3];

/// True if a box of extent `span` that stands out of a wall by `depth` metres meets no eaves, posts, roof or floor of a porch.
pub(super) fn is_clear(shell: &Faces, wall: &Wall, span: &Span, depth: f64) -> bool {
    let ends = match wall.positive {
        true => [wall.at, wall.at + depth],
        false => [wall.at - depth, wall.at],
    };
    let mut extents = [ends, ends, span[1]];
    extents[1 - wall.axis] = span[0];
    let before = |face: &&Face| matches!(face.finish, Finish::Trim | Finish::Roof | Finish::Deck);
    let mut faces = shell.faces.iter().filter(before);
    faces.all(|face| {
        let place = |v: u32| shell.positions[v as usize];
        let edges = face.edges.iter().map(|e| e.map(place));
        !meets(&edges.collect::<Vec<_>>(), &extents)
    })
}

/// True if a flat face, by its edges, has a point in a box.
fn meets(edges: &[[Point; 2]], extents: &[[f64; 2]; 3]) -> bool {
    edges.iter().any(|[p, q]| passes(p, q, extents))
        || box_edges(extents).any(|e| pierces(e, edges))
}

/// True if a segment has a point in a box.
fn passes(p: &Point, q: &Point, extents: &[[f64; 2]; 3]) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for k in 0..3 {
        let [low, high] = extents[k];
        let along = q[k] - p[k];
        if along == 0.0 {
            if p[k] < low || p[k] > high {
                return false;
            }
            continue;
        }
        let (a, b) = ((low - p[k]) / along, (high - p[k]) / along);
        (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
    }
    from <= to
}

/// The twelve edges of a box.
fn box_edges(extents: &[[f64; 2]; 3]) -> impl Iterator<Item = [Point; 2]> + '_ {
    (0..12).map(|k| {
        let (axis, corner) = (k / 4, k % 4);
        let mut ends = [[0.0; 3]; 2];
        for (i, other) in [(axis + 1) % 3, (axis + 2) % 3].into_iter().enumerate() {
            let at = extents[other][corner >> i & 1];
            ends.iter_mut().for_each(|p| p[other] = at);
        }
        (ends[0][axis], ends[1][axis]) = (extents[axis][0], extents[axis][1]);
        ends
    })
}

/// True if a segment goes through the inside of a flat face, by its directed edges.
fn pierces([p, q]: [Point; 2], edges: &[[Point; 2]]) -> bool {
    let Some([origin, _]) = edges.first() else {
        return false;
    };
    // Twice the area, as a vector square to the face.
    let mut square = [0.0; 3];
    for [a, b] in edges {
        for (k, v) in square.iter_mut().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            *v += (a[i] - origin[i]) * (b[j] - origin[j]) - (a[j] - origin[j]) * (b[i] - origin[i]);
        }
    }
    let over = |r: &Point| -> f64 { (0..3).map(|k| square[k] * (r[k] - origin[k])).sum() };
    let (a, b) = (over(&p), over(&q));
    if a == b || a.min(b) > 0.0 || a.max(b) < 0.0 {
        return false;
    }
    let t = a / (a - b);
    let point = [0, 1, 2].map(|k| p[k] + t * (q[k] - p[k]));
    // Seen along the axis to which the face is squarest.
    let axis = (0..3).fold(0, |m, k| {
        if square[k].abs() > square[m].abs() {
            k
        } else {
            m
        }
    });
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let crossed = edges.iter().filter(|[a, b]| {
        (a[j] > point[j]) != (b[j] > point[j])
            && a[i] + (point[j] - a[j]) / (b[j] - a[j]) * (b[i] - a[i]) > point[i]
    });
    crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A level square of side 4 around the origin at a height, counterclockwise.
    fn square(z: f64) -> Vec<[Point; 2]> {
        let corners = [
            [-2.0, -2.0, z],
            [2.0, -2.0, z],
            [2.0, 2.0, z],
            [-2.0, 2.0, z],
        ];
        (0..4).map(|k| [corners[k], corners[(k + 1) % 4]]).collect()
    }

    #[test]
    fn a_face_is_met_by_its_edges_and_inside() {
        let thing = |x: [f64; 2], z: [f64; 2]| [x, [-0.5, 0.5], z];
        assert!(
            meets(&square(1.0), &thing([-0.5, 0.5], [0.0, 2.0])),
            "inside"
        );
        assert!(
            meets(&square(1.0), &thing([1.5, 3.0], [0.0, 2.0])),
            "over an edge"
        );
        assert!(
            !meets(&square(1.0), &thing([2.5, 3.0], [0.0, 2.0])),
            "beside"
        );
        assert!(
            !meets(&square(1.0), &thing([-0.5, 0.5], [1.5, 2.0])),
            "above"
        );
        // A hole, clockwise, with the box in it.
        let hole = square(1.0)
            .into_iter()
            .map(|[a, b]| [b, a].map(|p| [p[0] / 2.0, p[1] / 2.0, p[2]]));
        let ring: Vec<[Point; 2]> = square(1.0).into_iter().chain(hole).collect();
        assert!(
            !meets(&ring, &thing([-0.5, 0.5], [0.0, 2.0])),
            "in the hole"
        );
        // A slope that rises over the box and one that cuts through it.
        let slope = |by: f64| -> Vec<[Point; 2]> {
            let rise = |p: Point| [p[0], p[1], p[2] + by * (p[0] + 2.0)];
            square(0.0).into_iter().map(|e| e.map(rise)).collect()
        };
        assert!(
            !meets(&slope(2.0), &thing([-0.5, 0.5], [0.0, 2.0])),
            "under the slope"
        );
        assert!(
            meets(&slope(0.5), &thing([-0.5, 0.5], [0.0, 2.0])),
            "through the slope"
        );
    }
}
