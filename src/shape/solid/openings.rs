//! Windows and doors: parts of a wall set back or forward, the surface staying closed.

use super::exact::{Line, units};
use super::{Face, FaceKey, Faces, Finish};

/// A wall along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// Axis that the wall is square to: 0 for x, 1 for y.
    pub axis: usize,
    /// Its coordinate on that axis.
    pub at: f64,
    /// True if it looks towards larger coordinates.
    pub positive: bool,
}

/// A rectangle on a wall: along the wall, then upwards.
pub type Span = [[f64; 2]; 2];

/// A rectangle set back from what surrounds it, with further ones in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The opening in its surroundings.
    pub mouth: Span,
    /// Its own rectangle.
    pub face: Span,
    /// Its depth behind the wall; negative before the wall.
    pub depth: f64,
    /// Finish of the sides between mouth and face.
    pub reveal: Finish,
    /// Finish of the face.
    pub finish: Finish,
    /// Panels whose mouths lie strictly inside the face, clear of each other.
    pub inner: Vec<Panel>,
}

/// A panel on a wall.
#[derive(Debug, Clone, PartialEq)]
pub struct Opening {
    /// The wall.
    pub wall: Wall,
    /// The panel that is cut into it.
    pub panel: Panel,
}

/// Least distance from the outline of the wall (m).
const CLEAR: f64 = 0.005;

impl Faces {
    /// Index of the face that has the whole rectangle, with a little room around it.
    pub fn around(&self, wall: &Wall, span: &Span) -> Option<usize> {
        let key = FaceKey::Wall(wall.line());
        let candidates = self.faces.iter().enumerate();
        let mut candidates = candidates.filter(|(_, f)| f.key == key && f.finish == Finish::Wall);
        candidates
            .find(|(_, face)| self.contains(face, wall, span))
            .map(|(k, _)| k)
    }

    /// True if the rectangle with its margin lies inside a face.
    fn contains(&self, face: &Face, wall: &Wall, span: &Span) -> bool {
        let place = |v: u32| {
            let p = self.positions[v as usize];
            [p[1 - wall.axis], p[2]]
        };
        let low = [0, 1].map(|a| span[a][0] - CLEAR);
        let high = [0, 1].map(|a| span[a][1] + CLEAR);
        let middle = [0, 1].map(|a| (low[a] + high[a]) / 2.0);
        let mut crossings = 0;
        for edge in &face.edges {
            let (p, q) = (place(edge[0]), place(edge[1]));
            if touches(p, q, low, high) {
                return false;
            }
            if (p[1] > middle[1]) != (q[1] > middle[1]) {
                let t = (middle[1] - p[1]) / (q[1] - p[1]);
                crossings += usize::from(p[0] + t * (q[0] - p[0]) > middle[0]);
            }
        }
        crossings % 2 == 1
    }

    /// The heights between which a stretch of a wall is bare, around height `z`; `None` where it is not bare there.
    pub fn free_band(&self, wall: &Wall, span: [f64; 2], z: f64) -> Option<[f64; 2]> {
        let key = FaceKey::Wall(wall.line());
        let own = self
            .faces
            .iter()
            .filter(|f| f.key == key && f.finish == Finish::Wall);
        own.filter_map(|face| self.band(face, wall, span, z)).next()
    }

    fn band(&self, face: &Face, wall: &Wall, [u0, u1]: [f64; 2], z: f64) -> Option<[f64; 2]> {
        let (mut band, mut inside) = ([f64::NEG_INFINITY, f64::INFINITY], 0);
        let middle = (u0 + u1) / 2.0;
        for edge in &face.edges {
            let [p, q] = edge.map(|v| {
                let p = self.positions[v as usize];
                [p[1 - wall.axis], p[2]]
            });
            // Edges above the middle of the stretch: an odd number when it is inside.
            if (p[0] > middle) != (q[0] > middle) {
                let t = (middle - p[0]) / (q[0] - p[0]);
                inside += usize::from(p[1] + t * (q[1] - p[1]) > z);
            }
            let (p, q) = if p[0] <= q[0] { (p, q) } else { (q, p) };
            if q[0] <= u0 - CLEAR || p[0] >= u1 + CLEAR {
                continue;
            }
            let at = |u: f64| match q[0] - p[0] {
                d if d < 1e-9 => None,
                d => Some(p[1] + (u.clamp(p[0], q[0]) - p[0]) / d * (q[1] - p[1])),
            };
            let ends = [
                at(u0 - CLEAR).unwrap_or(p[1]),
                at(u1 + CLEAR).unwrap_or(q[1]),
            ];
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            if high <= z {
                band[0] = band[0].max(high);
            } else if low >= z {
                band[1] = band[1].min(low);
            } else {
                return None;
            }
        }
        (inside % 2 == 1).then_some(band)
    }

    /// Cuts an opening into its wall and returns the volume taken away, negative for what stands out; `None`
    /// when no face of the wall has room for it.
    pub fn cut(&mut self, opening: &Opening) -> Option<f64> {
        let wall = &opening.wall;
        let face = self.around(wall, &opening.panel.mouth)?;
        let corners = self.corners(wall, &opening.panel.mouth, 0.0);
        self.hole(face, corners);
        Some(self.panel(wall, &opening.panel, corners, 0.0))
    }

    /// Vertices of a rectangle, counterclockwise seen from outside.
    fn corners(&mut self, wall: &Wall, span: &Span, depth: f64) -> [u32; 4] {
        let [[u0, u1], [z0, z1]] = *span;
        let (u0, u1) = if wall.runs_right() {
            (u0, u1)
        } else {
            (u1, u0)
        };
        let outwards = if wall.positive { 1.0 } else { -1.0 };
        [(u0, z0), (u1, z0), (u1, z1), (u0, z1)].map(|(u, z)| {
            let mut p = [0.0, 0.0, z];
            p[wall.axis] = wall.at - outwards * depth;
            p[1 - wall.axis] = u;
            self.positions.push(p);
            (self.positions.len() - 1) as u32
        })
    }

    fn hole(&mut self, face: usize, c: [u32; 4]) {
        let edges = (0..4).map(|k| [c[(k + 1) % 4], c[k]]);
        self.faces[face].edges.extend(edges);
    }

    fn panel(&mut self, wall: &Wall, panel: &Panel, mouth: [u32; 4], before: f64) -> f64 {
        let face = self.corners(wall, &panel.face, panel.depth);
        let key = FaceKey::Wall(wall.line());
        for k in 0..4 {
            let next = (k + 1) % 4;
            let ring = [mouth[k], mouth[next], face[next], face[k]];
            self.quads.push((ring, panel.reveal));
        }
        let index = self.faces.len();
        self.faces.push(Face {
            key,
            finish: panel.finish,
            edges: (0..4).map(|k| [face[k], face[(k + 1) % 4]]).collect(),
        });
        let mut volume = (panel.depth - before) * mean_area(&panel.mouth, &panel.face);
        for inner in &panel.inner {
            let mouth = self.corners(wall, &inner.mouth, panel.depth);
            self.hole(index, mouth);
            volume += self.panel(wall, inner, mouth, panel.depth);
        }
        volume
    }
}

/// Mean area of the sections between two rectangles (the prismatoid formula).
fn mean_area(a: &Span, b: &Span) -> f64 {
    let size = |s: &Span, axis: usize| s[axis][1] - s[axis][0];
    let area = |t: f64| {
        let side = |axis: usize| size(a, axis) * (1.0 - t) + size(b, axis) * t;
        side(0) * side(1)
    };
    (area(0.0) + 4.0 * area(0.5) + area(1.0)) / 6.0
}

/// True if a segment has a point in a rectangle.
fn touches(p: [f64; 2], q: [f64; 2], low: [f64; 2], high: [f64; 2]) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for a in 0..2 {
        let d = q[a] - p[a];
        if d.abs() < 1e-12 {
            if p[a] < low[a] || p[a] > high[a] {
                return false;
            }
            continue;
        }
        let (s, t) = ((low[a] - p[a]) / d, (high[a] - p[a]) / d);
        from = from.max(s.min(t));
        to = to.min(s.max(t));
    }
    from <= to
}

impl Wall {
    /// The wall in plan; it looks to the right of the line.
    pub fn line(&self) -> Line {
        let at = units(self.at);
        let (a, b) = if self.axis == 0 { (1, 0) } else { (0, 1) };
        let line = Line::new(a, b, -at);
        // Left of the line is inside.
        if self.positive { line.reversed() } else { line }
    }

    /// True if the coordinate along the wall grows to the right, seen from outside.
    fn runs_right(&self) -> bool {
        (self.axis == 0) == self.positive
    }
}
