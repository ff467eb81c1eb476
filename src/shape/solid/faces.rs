//! The plane faces of the union: tops, bottoms and walls, neighbours in one plane merged.

use rustc_hash::{FxHashMap, FxHashSet};

use super::arrangement::Cell;
use super::exact::{Line, Plane};
use super::segments::CellOutlines;
use super::{Finish, Prism};
use crate::vec3::{cross, norm, sub};

/// The plane of a face and the way it looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FaceKey {
    /// Looks up.
    Top(Plane),
    /// Looks down.
    Bottom(Plane),
    /// Upright; looks to the right of the line.
    Wall(Line),
}

/// A plane face with holes, given by its boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Face {
    /// Its plane.
    pub key: FaceKey,
    /// Its finish.
    pub finish: Finish,
    /// Directed edges, the face on their left seen from outside.
    pub edges: Vec<[u32; 2]>,
}

/// All faces with their vertices.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Faces {
    /// Vertices in metres, z up.
    pub positions: Vec<[f64; 3]>,
    /// The faces.
    pub faces: Vec<Face>,
    /// Four-cornered faces in any plane, counterclockwise seen from outside: the reveals of openings.
    pub quads: Vec<([u32; 4], Finish)>,
}

/// Vertices by place in plan and height there.
#[derive(Default)]
struct Vertices {
    index: FxHashMap<(u32, i128), u32>,
    positions: Vec<[f64; 3]>,
    /// Heights met at each point, and their vertices.
    at: Vec<Vec<(i128, u32)>>,
}

/// A face before merging.
struct Piece {
    key: FaceKey,
    finish: Finish,
    ring: Vec<u32>,
    /// Points in plan of upright edges: the point, for each edge that goes straight up or down.
    upright: Vec<Option<u32>>,
}

pub(super) fn build(prisms: &[Prism], cells: &[Cell], plan: &CellOutlines) -> Faces {
    let mut vertices = Vertices {
        at: vec![Vec::new(); plan.points.len()],
        ..Vertices::default()
    };
    let mut pieces = Vec::new();
    for (cell, ring) in cells.iter().zip(&plan.rings) {
        for (lower, upper) in &cell.intervals {
            let mut level = |plane: &Plane| -> Vec<u32> {
                ring.iter().map(|&p| vertices.get(p, plane, plan)).collect()
            };
            let top = level(upper);
            let mut bottom = level(lower);
            bottom.reverse();
            let flat = |ring: Vec<u32>, key, finish| Piece {
                upright: vec![None; ring.len()],
                key,
                finish,
                ring,
            };
            pieces.push(flat(
                top,
                FaceKey::Top(*upper),
                finish_of_top(prisms, cell, upper),
            ));
            let finish = finish_of_bottom(prisms, cell, lower);
            pieces.push(flat(bottom, FaceKey::Bottom(*lower), finish));
        }
    }
    for (k, (ring, lines)) in plan.rings.iter().zip(&plan.lines).enumerate() {
        for (i, line) in lines.iter().enumerate() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            let other = plan.left.get(&(b, a)).map(|&o| &cells[o as usize]);
            // Nothing ends here, as on most edges: a side of one prism cut the cells of others too.
            if other.is_some_and(|o| o.intervals == cells[k].intervals) {
                continue;
            }
            let edge = Edge { a, b, line: *line };
            walls(
                prisms,
                &cells[k],
                other,
                edge,
                plan,
                &mut vertices,
                &mut pieces,
            );
        }
    }
    vertices.sort();
    let pieces = pieces
        .into_iter()
        .map(|p| vertices.split_upright(p))
        .collect();
    simplified(merged(pieces), vertices.positions)
}

fn finish_of_top(prisms: &[Prism], cell: &Cell, plane: &Plane) -> Finish {
    let own = cell.prisms.iter().filter(|&&i| prisms[i].upper == *plane);
    own.map(|&i| prisms[i].top).min().unwrap_or(Finish::Roof)
}

fn finish_of_bottom(prisms: &[Prism], cell: &Cell, plane: &Plane) -> Finish {
    let own = cell.prisms.iter().filter(|&&i| prisms[i].lower == *plane);
    own.map(|&i| prisms[i].sides).min().unwrap_or(Finish::Wall)
}

struct Edge {
    a: u32,
    b: u32,
    line: Line,
}

/// Walls of the cell on the left of an edge where the other side is empty.
fn walls(
    prisms: &[Prism],
    cell: &Cell,
    other: Option<&Cell>,
    edge: Edge,
    plan: &CellOutlines,
    vertices: &mut Vertices,
    pieces: &mut Vec<Piece>,
) {
    let ends = [edge.a, edge.b].map(|p| plan.points[p as usize]);
    let height = |plane: &Plane| ends.map(|p| plane.at(&p));
    let nothing = Vec::new();
    let beyond = other.map_or(&nothing, |c| &c.intervals);
    let both = cell.intervals.iter().chain(beyond);
    let mut levels: Vec<([i128; 2], Plane)> = both
        .flat_map(|(l, u)| [*l, *u])
        .map(|p| (height(&p), p))
        .collect();
    levels.sort_unstable_by_key(|a| a.0);
    levels.dedup_by(|a, b| a.0 == b.0);
    let within = |intervals: &[(Plane, Plane)], low: &[i128; 2], high: &[i128; 2]| {
        let inside = |(l, u): &(Plane, Plane)| {
            let (l, u) = (height(l), height(u));
            (0..2).all(|k| l[k] <= low[k] && high[k] <= u[k])
        };
        intervals.iter().any(inside)
    };
    for band in levels.windows(2) {
        let ((low, lower), (high, upper)) = (band[0], band[1]);
        if !within(&cell.intervals, &low, &high) || within(beyond, &low, &high) {
            continue;
        }
        let covering = cell.prisms.iter().filter(|&&i| {
            let prism = &prisms[i];
            within(&[(prism.lower, prism.upper)], &low, &high)
        });
        let finish = covering.map(|&i| prisms[i].sides).min();
        let corners = [
            (edge.a, vertices.get(edge.a, &lower, plan)),
            (edge.b, vertices.get(edge.b, &lower, plan)),
            (edge.b, vertices.get(edge.b, &upper, plan)),
            (edge.a, vertices.get(edge.a, &upper, plan)),
        ];
        let mut piece = Piece {
            // The cell is on the left of the edge, so the wall looks to its right.
            key: FaceKey::Wall(directed(edge.line, &ends)),
            finish: finish.unwrap_or(Finish::Wall),
            ring: Vec::with_capacity(4),
            upright: Vec::with_capacity(4),
        };
        for k in 0..4 {
            let ((p, v), (q, w)) = (corners[k], corners[(k + 1) % 4]);
            if v != w {
                piece.ring.push(v);
                piece.upright.push((p == q).then_some(p));
            }
        }
        pieces.push(piece);
    }
}

/// The line in the direction from the first end to the second.
fn directed(line: Line, ends: &[super::exact::Point; 2]) -> Line {
    match line.along(&ends[0], &ends[1]).is_lt() {
        true => line,
        false => line.reversed(),
    }
}

impl Vertices {
    fn get(&mut self, point: u32, plane: &Plane, plan: &CellOutlines) -> u32 {
        let place = &plan.points[point as usize];
        let height = plane.at(place);
        *self.index.entry((point, height)).or_insert_with(|| {
            let [x, y] = place.metres();
            let index = self.positions.len() as u32;
            self.positions.push([x, y, plane.metres(place)]);
            self.at[point as usize].push((height, index));
            index
        })
    }

    fn sort(&mut self) {
        self.at.iter_mut().for_each(|at| at.sort_unstable());
    }

    /// Adds the vertices that lie on the upright edges of a piece.
    fn split_upright(&self, piece: Piece) -> Piece {
        let (mut ring, n) = (Vec::new(), piece.ring.len());
        for i in 0..n {
            let (v, w) = (piece.ring[i], piece.ring[(i + 1) % n]);
            ring.push(v);
            let Some(point) = piece.upright[i] else {
                continue;
            };
            let at = &self.at[point as usize];
            let find = |v: u32| at.iter().position(|(_, u)| *u == v).unwrap_or(0);
            let (from, to) = (find(v), find(w));
            if from < to {
                ring.extend(at[from + 1..to].iter().map(|(_, u)| u));
            } else {
                ring.extend(at[to + 1..from].iter().rev().map(|(_, u)| u));
            }
        }
        Piece {
            upright: Vec::new(),
            ring,
            ..piece
        }
    }
}

/// Joins pieces of one plane and finish over the edges that they share.
fn merged(pieces: Vec<Piece>) -> Vec<Face> {
    let mut owner: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    for (k, piece) in pieces.iter().enumerate() {
        for edge in edges(&piece.ring) {
            owner.insert(edge, k as u32);
        }
    }
    let mut parent: Vec<u32> = (0..pieces.len() as u32).collect();
    let alike = |a: &Piece, b: &Piece| a.key == b.key && a.finish == b.finish;
    for (k, piece) in pieces.iter().enumerate() {
        for (v, w) in edges(&piece.ring) {
            if let Some(&other) = owner.get(&(w, v))
                && alike(piece, &pieces[other as usize])
            {
                let (a, b) = (root(&mut parent, k as u32), root(&mut parent, other));
                parent[a.max(b) as usize] = a.min(b);
            }
        }
    }
    let mut place: FxHashMap<u32, usize> = FxHashMap::default();
    let mut faces: Vec<Face> = Vec::new();
    for (k, piece) in pieces.iter().enumerate() {
        let own = root(&mut parent, k as u32);
        let index = *place.entry(own).or_insert_with(|| {
            faces.push(Face {
                key: piece.key,
                finish: piece.finish,
                edges: Vec::new(),
            });
            faces.len() - 1
        });
        for (v, w) in edges(&piece.ring) {
            let other = owner.get(&(w, v)).copied();
            if other.is_none_or(|o| root(&mut parent, o) != own) {
                faces[index].edges.push([v, w]);
            }
        }
    }
    faces.retain(|f| !f.edges.is_empty());
    faces
}

fn edges(ring: &[u32]) -> impl Iterator<Item = (u32, u32)> + '_ {
    (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()]))
}

fn root(parent: &mut [u32], mut k: u32) -> u32 {
    while parent[k as usize] != k {
        parent[k as usize] = parent[parent[k as usize] as usize];
        k = parent[k as usize];
    }
    k
}

/// Drops vertices that lie on a straight edge between the same two faces, and vertices not used.
fn simplified(mut faces: Vec<Face>, positions: Vec<[f64; 3]>) -> Faces {
    // Edges that leave each vertex: face and the other end.
    let mut leaving: Vec<Vec<(usize, u32)>> = vec![Vec::new(); positions.len()];
    let mut arriving = leaving.clone();
    for (k, face) in faces.iter().enumerate() {
        for &[v, w] in &face.edges {
            leaving[v as usize].push((k, w));
            arriving[w as usize].push((k, v));
        }
    }
    let mut dropped: FxHashSet<u32> = FxHashSet::default();
    for v in 0..positions.len() {
        let (out, into) = (&leaving[v], &arriving[v]);
        if out.len() != 2 || into.len() != 2 || out[0].0 == out[1].0 {
            continue;
        }
        let (Some(a), Some(b)) = (
            into.iter().find(|(k, _)| *k == out[0].0),
            into.iter().find(|(k, _)| *k == out[1].0),
        ) else {
            continue;
        };
        // One face passes from a to b, the other back.
        let straight = a.1 == out[1].1 && b.1 == out[0].1;
        if straight
            && collinear(
                positions[a.1 as usize],
                positions[v],
                positions[b.1 as usize],
            )
        {
            dropped.insert(v as u32);
        }
    }
    for face in &mut faces {
        let next: FxHashMap<u32, u32> = face
            .edges
            .iter()
            .filter(|e| dropped.contains(&e[0]))
            .map(|e| (e[0], e[1]))
            .collect();
        face.edges.retain(|e| !dropped.contains(&e[0]));
        for edge in &mut face.edges {
            while let Some(&further) = next.get(&edge[1]) {
                edge[1] = further;
            }
        }
    }
    let mut number = FxHashMap::default();
    let mut kept = Vec::new();
    for v in faces.iter_mut().flat_map(|f| &mut f.edges).flatten() {
        *v = *number.entry(*v).or_insert_with(|| {
            kept.push(positions[*v as usize]);
            (kept.len() - 1) as u32
        });
    }
    Faces {
        positions: kept,
        faces,
        quads: Vec::new(),
    }
}

fn collinear(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> bool {
    let (p, q) = (sub(b, a), sub(c, b));
    norm(cross(p, q)) <= 1e-9 * (1.0 + norm(p) * norm(q))
}
