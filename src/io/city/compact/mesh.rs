//! Meshes of templates.
//!
//! A triangle is told by the edge over which it joins a triangle that is known (Rossignac's Edgebreaker, 1999, made
//! to stand holes and edges of many triangles): its third corner is new, or that of an open edge beside, or
//! any that is known, or nothing joins there. A coordinate of a new corner often is that of one of the three known
//! corners around: buildings have vertical walls and level roofs.

use rustc_hash::{FxHashMap, FxHashSet};

use super::error::CompactError;
use super::integers::{BitTree, Natural, Whole};
use super::range_coder::{Bit, Coder};

/// Corners in steps of the unit box, and triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct StepMesh {
    pub(super) corners: Vec<[i64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Most triangles of all templates together.
const MOST_TRIANGLES: u64 = 50_000_000;

/// The place beyond an edge.
#[derive(Clone, Copy)]
enum Beyond {
    Nothing,
    /// A corner not met before.
    New,
    /// The other end of an open edge that begins where this one ends.
    After,
    /// The other end of an open edge that ends where this one begins.
    Before,
    /// Any corner met before.
    Known,
}

const BEYOND: [Beyond; 5] = [
    Beyond::Nothing,
    Beyond::New,
    Beyond::After,
    Beyond::Before,
    Beyond::Known,
];

/// Learnt probabilities of meshes.
pub(super) struct MeshModels {
    count: Natural,
    beyond: Vec<BitTree>,
    last: usize,
    seed: Bit,
    back: Natural,
    /// Which reference a coordinate equals, by axis, whether the first two agree there, and the axis before.
    same: Vec<BitTree>,
    /// Coordinates in the box, level ones and upright ones.
    within: [BitTree; 2],
    inside: Bit,
    rest: Natural,
    outside: Whole,
    /// The box is from 0 to this.
    steps: i64,
    /// Bits of a coordinate in the box, and those of them that are learnt.
    bits: u32,
    learnt: u32,
    triangles: u64,
}

impl MeshModels {
    pub(super) fn new(steps: i64) -> Self {
        let bits = i64::BITS - steps.leading_zeros();
        let learnt = bits.min(9);
        Self {
            count: Natural::default(),
            beyond: vec![BitTree::new(3); 6],
            last: 0,
            seed: Bit::default(),
            back: Natural::default(),
            same: vec![BitTree::new(2); 3 * 2 * 5],
            within: [BitTree::new(learnt), BitTree::new(learnt)],
            inside: Bit::default(),
            rest: Natural::default(),
            outside: Whole::default(),
            steps,
            bits,
            learnt,
            triangles: 0,
        }
    }

    /// One mesh; corners that no triangle has are lost.
    pub(super) fn code<C: Coder>(
        &mut self,
        coder: &mut C,
        given: &StepMesh,
    ) -> Result<StepMesh, CompactError> {
        let count = self.count.code(coder, given.triangles.len() as u64);
        self.triangles += count;
        if self.triangles > MOST_TRIANGLES {
            return Err(CompactError::TooLarge("triangles"));
        }
        let mut source = Source::new(given);
        let mut front = Front::default();
        while (front.mesh.triangles.len() as u64) < count {
            if coder.exhausted() {
                return Err(CompactError::Truncated);
            }
            let triangle = match front.gate() {
                Some(gate) => self.beyond(coder, gate, &mut source, &mut front)?,
                None => Some(self.seed(coder, &mut source, &mut front)?),
            };
            if let Some(t) = triangle {
                front.add(t);
            }
        }
        Ok(front.mesh)
    }

    /// The triangle beyond an edge.
    fn beyond<C: Coder>(
        &mut self,
        coder: &mut C,
        gate: Gate,
        source: &mut Source,
        front: &mut Front,
    ) -> Result<Option<[u32; 3]>, CompactError> {
        let found = source.beyond(gate.from, gate.to);
        let [after, before] = [front.after(gate.to), front.before(gate.from)];
        let what = match found.map(|corner| (corner, source.number(corner))) {
            None => Beyond::Nothing,
            Some((_, None)) => Beyond::New,
            Some((_, Some(n))) if Some(n) == after => Beyond::After,
            Some((_, Some(n))) if Some(n) == before => Beyond::Before,
            Some(_) => Beyond::Known,
        };
        let symbol = self.beyond[self.last].code(coder, what as usize);
        self.last = symbol.min(5);
        let no_corner = CompactError::Index("corner");
        let corner = match BEYOND.get(symbol).ok_or(CompactError::Index("edge"))? {
            Beyond::Nothing => return Ok(None),
            Beyond::New => {
                let near = [gate.to, gate.from, gate.opposite];
                let near = near.map(|i| front.mesh.corners[i as usize]);
                let place = found.map(|c| source.mesh.corners[c as usize]);
                let place = self.corner(coder, near, place.unwrap_or_default());
                source.meet(found);
                front.mesh.corners.push(place);
                front.mesh.corners.len() as u32 - 1
            }
            Beyond::After => after.ok_or(no_corner)?,
            Beyond::Before => before.ok_or(no_corner)?,
            Beyond::Known => self.known(coder, found.and_then(|c| source.number(c)), front)?,
        };
        Ok(Some([gate.from, gate.to, corner]))
    }

    /// The first triangle of a part.
    fn seed<C: Coder>(
        &mut self,
        coder: &mut C,
        source: &mut Source,
        front: &mut Front,
    ) -> Result<[u32; 3], CompactError> {
        let given = source.seed();
        let mut near = [[0; 3]; 3];
        let mut triangle = [0; 3];
        for (k, corner) in triangle.iter_mut().enumerate() {
            let own = given.map(|t| t[k]);
            let number = own.and_then(|c| source.number(c));
            *corner = match coder.bit(&mut self.seed, number.is_none()) {
                true => {
                    let place = own.map(|c| source.mesh.corners[c as usize]);
                    let place = self.corner(coder, near, place.unwrap_or_default());
                    source.meet(own);
                    front.mesh.corners.push(place);
                    front.mesh.corners.len() as u32 - 1
                }
                false => self.known(coder, number, front)?,
            };
            near.rotate_right(1);
            near[0] = front.mesh.corners[*corner as usize];
        }
        Ok(triangle)
    }

    /// A corner met before, counted from the last.
    fn known<C: Coder>(
        &mut self,
        coder: &mut C,
        number: Option<u32>,
        front: &Front,
    ) -> Result<u32, CompactError> {
        let count = front.mesh.corners.len() as u64;
        let back = self
            .back
            .code(coder, number.map_or(0, |n| count - 1 - u64::from(n)));
        match back < count {
            true => Ok((count - 1 - back) as u32),
            false => Err(CompactError::Index("corner")),
        }
    }

    fn corner<C: Coder>(
        &mut self,
        coder: &mut C,
        near: [[i64; 3]; 3],
        given: [i64; 3],
    ) -> [i64; 3] {
        let mut before = 4;
        let mut place = [0; 3];
        for axis in 0..3 {
            let like = near.map(|p| p[axis]);
            let same = like.iter().position(|&v| v == given[axis]).unwrap_or(3);
            let agree = usize::from(like[0] == like[1]);
            let model = &mut self.same[(axis * 2 + agree) * 5 + before];
            before = model.code(coder, same);
            place[axis] = match like.get(before) {
                Some(&v) => v,
                None => self.coordinate(coder, usize::from(axis == 2), given[axis]),
            };
        }
        place
    }

    fn coordinate<C: Coder>(&mut self, coder: &mut C, upright: usize, given: i64) -> i64 {
        if !coder.bit(&mut self.inside, (0..=self.steps).contains(&given)) {
            return self.outside.code(coder, given);
        }
        let low = self.bits - self.learnt;
        let high = self.within[upright].code(
            coder,
            (given.max(0) >> low) as usize & ((1 << self.learnt) - 1),
        );
        let rest = match low {
            0 => 0,
            _ => self
                .rest
                .code(coder, given.max(0) as u64 & ((1 << low) - 1)) as i64,
        };
        ((high as i64) << low) + rest
    }
}

/// The mesh to write, while it is written; empty while one is read.
struct Source<'a> {
    mesh: &'a StepMesh,
    /// Triangles not yet written, by their directed edges.
    by_edge: FxHashMap<(u32, u32), Vec<(usize, u32)>>,
    written: Vec<bool>,
    first: usize,
    /// Corners that are written: their numbers, and the reverse.
    numbers: FxHashMap<u32, u32>,
    originals: Vec<u32>,
}

impl<'a> Source<'a> {
    fn new(mesh: &'a StepMesh) -> Self {
        let mut by_edge: FxHashMap<_, Vec<_>> = FxHashMap::default();
        for (i, t) in mesh.triangles.iter().enumerate().rev() {
            for k in 0..3 {
                let [a, b, c] = [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
                by_edge.entry((a, b)).or_default().push((i, c));
            }
        }
        Self {
            mesh,
            by_edge,
            written: vec![false; mesh.triangles.len()],
            first: 0,
            numbers: FxHashMap::default(),
            originals: Vec::new(),
        }
    }

    /// The number under which a corner was written.
    fn number(&self, corner: u32) -> Option<u32> {
        self.numbers.get(&corner).copied()
    }

    /// Numbers a corner that is written now.
    fn meet(&mut self, corner: Option<u32>) {
        if let Some(c) = corner {
            self.numbers.insert(c, self.originals.len() as u32);
            self.originals.push(c);
        }
    }

    /// The third corner of a triangle over an edge between numbered corners, which counts as written.
    fn beyond(&mut self, from: u32, to: u32) -> Option<u32> {
        let original = |n: u32| self.originals.get(n as usize).copied();
        let edge = (original(from)?, original(to)?);
        let list = self.by_edge.get_mut(&edge)?;
        while let Some((i, corner)) = list.pop() {
            if !std::mem::replace(&mut self.written[i], true) {
                return Some(corner);
            }
        }
        None
    }

    /// The first triangle not yet written, which counts as written.
    fn seed(&mut self) -> Option<[u32; 3]> {
        while *self.written.get(self.first)? {
            self.first += 1;
        }
        self.written[self.first] = true;
        Some(self.mesh.triangles[self.first])
    }
}

/// An open edge: where a triangle may join, and the corner opposite in the triangle that is known.
#[derive(Clone, Copy)]
struct Gate {
    from: u32,
    to: u32,
    opposite: u32,
}

/// The part of a mesh that is known.
#[derive(Default)]
struct Front {
    mesh: StepMesh,
    /// Directed edges of the triangles.
    edges: FxHashSet<(u32, u32)>,
    gates: Vec<Gate>,
    /// Ends of open edges by their beginnings, and the reverse.
    ends: FxHashMap<u32, Vec<u32>>,
    beginnings: FxHashMap<u32, Vec<u32>>,
}

impl Front {
    /// The open edge that was met last; it is not open any more.
    fn gate(&mut self) -> Option<Gate> {
        while let Some(gate) = self.gates.pop() {
            let (from, to) = (gate.from, gate.to);
            if !self.edges.contains(&(from, to)) {
                self.close(from, to);
                return Some(gate);
            }
        }
        None
    }

    fn close(&mut self, from: u32, to: u32) {
        if let Some(list) = self.ends.get_mut(&from) {
            list.retain(|&v| v != to);
        }
        if let Some(list) = self.beginnings.get_mut(&to) {
            list.retain(|&v| v != from);
        }
    }

    fn after(&self, corner: u32) -> Option<u32> {
        self.ends.get(&corner)?.last().copied()
    }

    fn before(&self, corner: u32) -> Option<u32> {
        self.beginnings.get(&corner)?.last().copied()
    }

    fn add(&mut self, triangle: [u32; 3]) {
        self.mesh.triangles.push(triangle);
        let edges = [0, 1, 2].map(|k| (triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]));
        for (a, b, _) in edges {
            self.edges.insert((a, b));
            self.close(a, b);
        }
        for (a, b, opposite) in edges {
            if !self.edges.contains(&(b, a)) {
                let (from, to) = (b, a);
                self.gates.push(Gate { from, to, opposite });
                self.ends.entry(from).or_default().push(to);
                self.beginnings.entry(to).or_default().push(from);
            }
        }
    }
}
