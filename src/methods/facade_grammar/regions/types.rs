//! Interning of region types, and the strips into which full lines cut them.

use std::rc::Rc;

use rustc_hash::FxHashMap;

use super::cells::Cells;
use super::layout_index::LayoutIndex;
use super::lengths::{lines, minus};
use super::region::{Region, TypeId, ends, part};
use super::strips::{Offsets, Strips};
use edifice_shape::{Axis, Facade, LayoutError};

/// A type and the first region found with it.
#[derive(Debug, Clone, Copy)]
struct Type {
    region: Region,
    terminals: u32,
}

/// The key of a type, equal for regions of one type: hash of contents, width, height, number of terminals.
type Key = (u64, u64, u64, u32);

/// The region types of one or several facades.
#[derive(Debug, Clone)]
pub(crate) struct Types {
    pub layouts: Rc<[LayoutIndex]>,
    pub labels: Vec<String>,
    ids: FxHashMap<Key, TypeId>,
    types: Vec<Type>,
    strips: Vec<[Option<Rc<Strips>>; 2]>,
    /// Rectangles between full lines, of the types that were asked for them; `None` where there are too many.
    cells: FxHashMap<TypeId, Option<Rc<Cells>>>,
    /// Type of each facade as a whole.
    pub roots: Vec<TypeId>,
    /// Strips of all types so far, and the number at which a search is to stop.
    cut: usize,
    pub limit: usize,
}

impl Types {
    /// Prepares facades whose tilings were checked; labels and types are shared between them.
    ///
    /// # Errors
    /// The index of a facade with a region that is too thin, which a check of the tiling has excluded.
    pub(crate) fn new(facades: &[Facade]) -> Result<Self, (usize, LayoutError)> {
        let mut labels: Vec<String> = Vec::new();
        let layouts: Rc<[LayoutIndex]> = lines(facades)?
            .into_iter()
            .zip(facades)
            .enumerate()
            .map(|(index, (lines, facade))| {
                LayoutIndex::new(index as u16, facade, lines, |name| {
                    labels.iter().position(|l| l == name).unwrap_or_else(|| {
                        labels.push(name.to_owned());
                        labels.len() - 1
                    }) as u32
                })
            })
            .collect();
        let nowhere = Region {
            layout: 0,
            x0: 0,
            x1: 0,
            y0: 0,
            y1: 0,
        };
        let mut types = Self {
            ids: FxHashMap::default(),
            types: vec![
                Type {
                    region: nowhere,
                    terminals: 1
                };
                labels.len()
            ],
            strips: vec![[None, None]; labels.len()],
            cells: FxHashMap::default(),
            roots: Vec::new(),
            cut: 0,
            limit: usize::MAX,
            layouts,
            labels,
        };
        for index in 0..types.layouts.len() {
            let root = types.layouts[index].root(index as u16);
            let id = types.intern(root);
            types.roots.push(id);
        }
        Ok(types)
    }

    /// Columns and rows of the grid of edges of each layout.
    pub(crate) fn extents(&self) -> Vec<(usize, usize)> {
        let extent = |layout: &LayoutIndex| (layout.xs.len() - 1, layout.ys.len() - 1);
        self.layouts.iter().map(extent).collect()
    }

    /// Number of terminal labels.
    pub(crate) fn label_count(&self) -> u32 {
        self.labels.len() as u32
    }

    /// Number of types seen so far, labels included.
    pub(crate) fn len(&self) -> usize {
        self.types.len()
    }

    /// True if there are as many strips as there may be.
    pub(crate) fn is_full(&self) -> bool {
        self.cut >= self.limit
    }

    /// True if the type is a terminal label.
    pub(crate) fn is_terminal(&self, id: TypeId) -> bool {
        id < self.label_count()
    }

    /// First region found with this type (of a non-terminal type).
    pub(crate) fn region(&self, id: TypeId) -> Region {
        self.types[id as usize].region
    }

    /// Number of terminals in a region of this type.
    pub(crate) fn terminals(&self, id: TypeId) -> u32 {
        self.types[id as usize].terminals
    }

    /// The type of a region that cuts no terminal.
    pub(crate) fn intern(&mut self, region: Region) -> TypeId {
        let layout = &self.layouts[usize::from(region.layout)];
        if let Some(label) = layout.terminal_label(region) {
            return label;
        }
        let terminals = layout.terminals_in(region);
        let key = (
            layout.hash_of(region),
            layout.extent_x(region),
            layout.extent_y(region),
            terminals,
        );
        let next = self.types.len() as TypeId;
        let id = *self.ids.entry(key).or_insert(next);
        if id == next {
            self.types.push(Type { region, terminals });
            self.strips.push([None, None]);
        }
        id
    }

    /// The strips of a non-terminal type along an axis.
    pub(crate) fn strips(&mut self, id: TypeId, axis: Axis) -> Rc<Strips> {
        let slot = axis as usize;
        if let Some(strips) = &self.strips[id as usize][slot] {
            return Rc::clone(strips);
        }
        let strips = Rc::new(self.cut(self.region(id), axis));
        self.cut += strips.all().len();
        self.strips[id as usize][slot] = Some(Rc::clone(&strips));
        strips
    }

    /// The rectangles between the full lines of a non-terminal type; `None` when there are too many.
    pub(crate) fn cells(&mut self, id: TypeId) -> Option<Rc<Cells>> {
        if !self.cells.contains_key(&id) {
            let [xs, ys] = Axis::BOTH.map(|axis| self.strips(id, axis));
            let region = self.region(id);
            let cells = Cells::new(region, [&xs, &ys], |part| self.intern(part)).map(Rc::new);
            self.cells.insert(id, cells);
        }
        self.cells[&id].clone()
    }

    fn cut(&mut self, region: Region, axis: Axis) -> Strips {
        let cuts = self.full_lines(region, axis);
        let count = cuts.len();
        let mut types = Vec::with_capacity(count * (count - 1) / 2);
        for b in 1..count {
            for a in 0..b {
                types.push(self.intern(part(region, axis, cuts[a], cuts[b])));
            }
        }
        let offsets = self.offsets(region, axis, &cuts);
        Strips::new(cuts, types, &offsets)
    }

    /// Grid indices of the cuts of a type's strips where another region has that type.
    pub(crate) fn cuts_at(&mut self, id: TypeId, axis: Axis, region: Region) -> Vec<u16> {
        let strips = self.strips(id, axis);
        let offsets = self.offsets(self.region(id), axis, &strips.cuts);
        let layout = &self.layouts[usize::from(region.layout)];
        let (lines, _) = layout.lines(axis);
        let start = lines[usize::from(ends(region, axis).0)];
        // Equal up to noise: the nearest line.
        let nearest = |&offset: &f64| {
            let after = lines.partition_point(|&line| line < start + offset);
            let before = after.saturating_sub(1);
            let distance = |line: usize| (lines[line] - start - offset).abs();
            match after < lines.len() && distance(after) < distance(before) {
                true => after as u16,
                false => before as u16,
            }
        };
        offsets.at.iter().map(nearest).collect()
    }

    /// Ends of the region and the full lines between them that cut no terminal.
    fn full_lines(&self, r: Region, axis: Axis) -> Vec<u16> {
        let layout = &self.layouts[usize::from(r.layout)];
        let (first, last) = ends(r, axis);
        let free = |&line: &u16| match axis {
            Axis::X => !layout.cuts_terminal_x(line, r.y0, r.y1),
            Axis::Y => !layout.cuts_terminal_y(line, r.x0, r.x1),
        };
        std::iter::once(first)
            .chain((first + 1..last).filter(free))
            .chain([last])
            .collect()
    }

    /// Distances of the cuts from the region's start.
    pub(crate) fn offsets(&self, region: Region, axis: Axis, cuts: &[u16]) -> Offsets {
        let (lines, residues) = self.layouts[usize::from(region.layout)].lines(axis);
        let from = |line: u16| usize::from(line);
        let start = from(cuts[0]);
        let offset = |&cut: &u16| lines[from(cut)] - lines[start];
        let residue = |&cut: &u16| minus(residues[from(cut)], residues[start]);
        Offsets {
            at: cuts.iter().map(offset).collect(),
            residues: cuts.iter().map(residue).collect(),
        }
    }
}
