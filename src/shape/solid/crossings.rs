//! Self-intersections of a surface of triangles, in exact arithmetic.
//!
//! Coordinates are whole numbers, so that every decision is the sign of a determinant without rounding. For triangles
//! `A` and `B`, with `o(p, q, r, s)` the orientation of four points:
//!
//! - in one plane, their insides are apart if and only if the line of one of the six edges has `A` on one side and `B`
//!   on the other (the theorem of the separating line for convex sets);
//! - else an edge `pq` of one meets the other, `rst`, if `p` and `q` lie on different sides of its plane and
//!   `o(p, q, r, s)`, `o(p, q, s, t)`, `o(p, q, t, r)` have no two different signs, inside it if none is zero;
//! - a corner of one that lies on the other, and is none of its corners, touches it.
//!
//! Corners and edges that two triangles have in common are no contact.

/// Two triangles that meet where they should not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Crossing {
    /// Indices of the triangles, the smaller one first.
    pub triangles: [usize; 2],
    /// Their contact.
    pub contact: Contact,
}

/// The contact of two triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contact {
    /// One passes through the other, or both cover a part of one plane.
    Cross,
    /// They have points in common, but no edge of one passes through the inside of the other: a corner of one lies on
    /// the other, or their edges meet. A surface that passes exactly through edges of another touches all of their
    /// triangles.
    Touch,
}

/// A point with whole coordinates, at most [`LARGEST`] from zero.
type Point = [i64; 3];

/// Largest coordinate for which determinants fit 128 bits: with micrometres, 1,000 km.
pub const LARGEST: i64 = 1 << 40;

/// All pairs of triangles of a surface that meet outside of common corners and edges, in order.
///
/// Complexity: pairs whose extents along x overlap; sorting along x.
///
/// # Errors
/// The first coordinate that is farther from zero than [`LARGEST`].
pub fn crossings(positions: &[Point], triangles: &[[u32; 3]]) -> Result<Vec<Crossing>, i64> {
    if let Some(far) = positions
        .iter()
        .flatten()
        .find(|v| v.unsigned_abs() > LARGEST.unsigned_abs())
    {
        return Err(*far);
    }
    let corners = |k: usize| triangles[k].map(|v| positions[v as usize]);
    let range = |t: [Point; 3], i: usize| {
        let all = t.map(|p| p[i]);
        [
            all[0].min(all[1]).min(all[2]),
            all[0].max(all[1]).max(all[2]),
        ]
    };
    let boxes: Vec<[[i64; 2]; 3]> = (0..triangles.len())
        .map(|k| [0, 1, 2].map(|i| range(corners(k), i)))
        .collect();
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by_key(|&k| (boxes[k][0][0], k));
    let mut found = Vec::new();
    for (i, &a) in order.iter().enumerate() {
        for &b in &order[i + 1..] {
            if boxes[b][0][0] > boxes[a][0][1] {
                break;
            }
            let apart =
                |i: usize| boxes[a][i][0] > boxes[b][i][1] || boxes[b][i][0] > boxes[a][i][1];
            if apart(1) || apart(2) {
                continue;
            }
            if let Some(contact) = contact(corners(a), corners(b)) {
                let triangles = [a.min(b), a.max(b)];
                found.push(Crossing { triangles, contact });
            }
        }
    }
    found.sort_by_key(|c| c.triangles);
    Ok(found)
}

/// True if the corners of a triangle are not on one line; coordinates at most [`LARGEST`] from zero.
pub fn has_area([a, b, c]: [Point; 3]) -> bool {
    cross(difference(b, a), difference(c, a)) != [0; 3]
}

/// The contact of two triangles outside of common corners and edges; coordinates at most [`LARGEST`] from zero.
pub fn contact(a: [Point; 3], b: [Point; 3]) -> Option<Contact> {
    let over = |t: [Point; 3], other: [Point; 3]| other.map(|p| orientation(t[0], t[1], t[2], p));
    let (of_a, of_b) = (over(b, a), over(a, b));
    let is_apart = |s: [i128; 3]| s.iter().all(|v| *v > 0) || s.iter().all(|v| *v < 0);
    if is_apart(of_a) || is_apart(of_b) {
        return None;
    }
    let in_plane = of_a == [0; 3];
    let pierced = [pierced(a, b, of_a), pierced(b, a, of_b)];
    if (in_plane && !is_separated(a, b)) || pierced.contains(&Some(Contact::Cross)) {
        return Some(Contact::Cross);
    }
    let touches = pierced.contains(&Some(Contact::Touch))
        || (0..3).any(|i| of_a[i] == 0 && !b.contains(&a[i]) && is_on(a[i], b))
        || (0..3).any(|i| of_b[i] == 0 && !a.contains(&b[i]) && is_on(b[i], a));
    touches.then_some(Contact::Touch)
}

fn difference(a: Point, b: Point) -> [i128; 3] {
    [0, 1, 2].map(|i| i128::from(a[i]) - i128::from(b[i]))
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Sign of the volume of four points.
fn orientation(p: Point, q: Point, r: Point, s: Point) -> i128 {
    let n = cross(difference(q, p), difference(r, p));
    let d = difference(s, p);
    (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]).signum()
}

/// The contact of edges of `a` that pass from one side of `b` to the other with it; `sides` are the sides of the corners.
fn pierced(a: [Point; 3], b: [Point; 3], sides: [i128; 3]) -> Option<Contact> {
    let mut found = None;
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let turns = |k: usize| orientation(a[i], a[j], b[k], b[(k + 1) % 3]);
        if sides[i] * sides[j] >= 0 {
            continue;
        }
        let all = [turns(0), turns(1), turns(2)];
        if all.iter().all(|t| *t > 0) || all.iter().all(|t| *t < 0) {
            return Some(Contact::Cross);
        }
        if all.iter().all(|t| *t >= 0) || all.iter().all(|t| *t <= 0) {
            found = Some(Contact::Touch);
        }
    }
    found
}

/// The plane of a triangle seen along the axis that it faces: two coordinates of a point.
fn flat(t: [Point; 3]) -> impl Fn(Point) -> [i128; 2] {
    let n = cross(difference(t[1], t[0]), difference(t[2], t[0]));
    let axis = (0..3).max_by_key(|i| n[*i].abs()).unwrap_or(2);
    move |p| [1, 2].map(|k| i128::from(p[(axis + k) % 3]))
}

/// Sign of the area of three points in a plane.
fn turn(p: [i128; 2], q: [i128; 2], r: [i128; 2]) -> i128 {
    ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).signum()
}

/// True if two triangles of one plane have no inner point in common.
fn is_separated(a: [Point; 3], b: [Point; 3]) -> bool {
    let flat = flat(a);
    let (a, b) = (a.map(&flat), b.map(&flat));
    let by_edge = |t: [[i128; 2]; 3], other: [[i128; 2]; 3]| {
        (0..3).any(|i| {
            let (p, q) = (t[i], t[(i + 1) % 3]);
            let own = turn(p, q, t[(i + 2) % 3]);
            other.iter().all(|r| turn(p, q, *r) * own <= 0)
        })
    };
    by_edge(a, b) || by_edge(b, a)
}

/// True if a point in the plane of a triangle lies inside it or on its edges.
fn is_on(p: Point, t: [Point; 3]) -> bool {
    let flat = flat(t);
    let (p, t) = (flat(p), t.map(&flat));
    let turns = [0, 1, 2].map(|i| turn(t[i], t[(i + 1) % 3], p));
    turns.iter().all(|s| *s >= 0) || turns.iter().all(|s| *s <= 0)
}
