//! Interning of region types, and the strips into which full lines cut them.

use std::rc::Rc;

use rustc_hash::FxHashMap;

use super::{Cells, Region, Sheet};
use crate::shape::{Axis, Facade};

/// Index of a region type. Types below [`Types::label_count`] are the terminal labels.
pub(crate) type TypeId = u32;

/// A type and the first region found with it.
#[derive(Debug, Clone, Copy)]
struct Type {
    region: Region,
    terminals: u32,
}

/// What two regions share when they have one type: hash of contents, size, number of terminals.
type Key = (u64, i64, i64, u32);

/// `repeats` equal periods of `intervals` elementary intervals each fill the region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Period {
    pub intervals: u16,
    pub repeats: u16,
}

/// Everything that full lines along one axis can make of a region.
#[derive(Debug)]
pub(crate) struct Strips {
    /// Grid indices of the region's ends and of every full line that cuts no terminal.
    pub cuts: Vec<u16>,
    /// Type of the strip from `cuts[a]` to `cuts[b]` at `b (b - 1) / 2 + a`.
    types: Vec<TypeId>,
    /// Ways to see the region as a repetition.
    pub periods: Vec<Period>,
    /// Ways to see it as A B A B ... A: the ends of the first A and of the first B.
    pub alternations: Vec<(u16, u16)>,
    /// Pairs of cuts at equal distance from the two ends, from the outside in; the last pair is
    /// one cut when there is one in the middle.
    pub mirrors: Vec<(u16, u16)>,
}

impl Strips {
    /// Number of elementary intervals, 1 when no line splits the region.
    pub fn intervals(&self) -> usize {
        self.cuts.len() - 1
    }

    /// Type of the strip between cuts `a < b`.
    pub fn strip(&self, a: usize, b: usize) -> TypeId {
        self.types[b * (b - 1) / 2 + a]
    }

    /// Types of the strips that end at cut `b`, by where they start.
    pub fn ending_at(&self, b: usize) -> &[TypeId] {
        let first = b * (b - 1) / 2;
        &self.types[first..first + b]
    }

    /// End of the first A of the alternation whose first B ends at cut `b`.
    pub fn alternation_inner(&self, b: usize) -> u16 {
        self.alternations
            .iter()
            .find(|(_, end)| usize::from(*end) == b)
            .map_or(0, |(a, _)| *a)
    }

    /// All strip types.
    pub fn all(&self) -> &[TypeId] {
        &self.types
    }
}

/// The region types of one or several facades.
#[derive(Debug)]
pub(crate) struct Types {
    pub sheets: Vec<Sheet>,
    pub labels: Vec<String>,
    ids: FxHashMap<Key, TypeId>,
    types: Vec<Type>,
    strips: Vec<[Option<Rc<Strips>>; 2]>,
    /// Of types that were asked for them; `None` where there are too many.
    cells: FxHashMap<TypeId, Option<Rc<Cells>>>,
    /// Type of each facade as a whole.
    pub roots: Vec<TypeId>,
}

impl Types {
    /// Prepares facades whose tilings were checked; labels and types are shared between them.
    pub fn new(facades: &[Facade]) -> Self {
        let quantum = common_quantum(facades);
        let mut labels: Vec<String> = Vec::new();
        let sheets: Vec<Sheet> = facades
            .iter()
            .enumerate()
            .map(|(index, facade)| {
                Sheet::new(index as u16, facade, quantum, |name| {
                    labels.iter().position(|l| l == name).unwrap_or_else(|| {
                        labels.push(name.to_owned());
                        labels.len() - 1
                    }) as u32
                })
            })
            .collect();
        let nowhere = Region {
            sheet: 0,
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
            sheets,
            labels,
        };
        for index in 0..types.sheets.len() {
            let root = types.sheets[index].root(index as u16);
            let id = types.intern(root);
            types.roots.push(id);
        }
        types
    }

    /// Columns and rows of the grid of edges of each sheet.
    pub fn extents(&self) -> Vec<(usize, usize)> {
        let extent = |sheet: &Sheet| (sheet.xs.len() - 1, sheet.ys.len() - 1);
        self.sheets.iter().map(extent).collect()
    }

    /// Number of terminal labels.
    pub fn label_count(&self) -> u32 {
        self.labels.len() as u32
    }

    /// Number of types seen so far, labels included.
    pub fn len(&self) -> usize {
        self.types.len()
    }

    /// Whether the type is a terminal label.
    pub fn is_terminal(&self, id: TypeId) -> bool {
        id < self.label_count()
    }

    /// First region found with this type (of a non-terminal type).
    pub fn region(&self, id: TypeId) -> Region {
        self.types[id as usize].region
    }

    /// Number of terminals in a region of this type.
    pub fn terminals(&self, id: TypeId) -> u32 {
        self.types[id as usize].terminals
    }

    /// The type of a region that cuts no terminal.
    pub fn intern(&mut self, region: Region) -> TypeId {
        let sheet = &self.sheets[usize::from(region.sheet)];
        if let Some(label) = sheet.terminal_label(region) {
            return label;
        }
        let terminals = sheet.terminals_in(region);
        let key = (
            sheet.hash_of(region),
            sheet.extent_x(region),
            sheet.extent_y(region),
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
    pub fn strips(&mut self, id: TypeId, axis: Axis) -> Rc<Strips> {
        let slot = axis as usize;
        if let Some(strips) = &self.strips[id as usize][slot] {
            return Rc::clone(strips);
        }
        let strips = Rc::new(self.cut(self.region(id), axis));
        self.strips[id as usize][slot] = Some(Rc::clone(&strips));
        strips
    }

    /// The rectangles between the full lines of a non-terminal type; `None` when there are too many.
    pub fn cells(&mut self, id: TypeId) -> Option<Rc<Cells>> {
        if !self.cells.contains_key(&id) {
            let cells = Cells::new(self, id).map(Rc::new);
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
        let position = self.positions(region, axis, &cuts);
        let empty = Vec::new;
        let mut strips = Strips {
            cuts,
            types,
            periods: Vec::new(),
            alternations: empty(),
            mirrors: mirrors(&position),
        };
        for (k, repeats, rest) in shifts(&position, &strips) {
            match rest {
                0 => strips.periods.push(Period {
                    intervals: k as u16,
                    repeats,
                }),
                a => strips.alternations.push((a as u16, k as u16)),
            }
        }
        strips
    }

    /// Grid indices of the cuts of a type's strips where another region has that type.
    pub fn cuts_at(&mut self, id: TypeId, axis: Axis, region: Region) -> Vec<u16> {
        let strips = self.strips(id, axis);
        let positions = self.positions(self.region(id), axis, &strips.cuts);
        let sheet = &self.sheets[usize::from(region.sheet)];
        let quanta = match axis {
            Axis::X => &sheet.qx,
            Axis::Y => &sheet.qy,
        };
        let start = quanta[usize::from(ends(region, axis).0)];
        let line = |p| quanta.partition_point(|&q| q < start + p) as u16;
        positions.into_iter().map(line).collect()
    }

    /// Ends of the region and the full lines between them that cut no terminal.
    fn full_lines(&self, r: Region, axis: Axis) -> Vec<u16> {
        let sheet = &self.sheets[usize::from(r.sheet)];
        let (first, last) = ends(r, axis);
        let free = |&line: &u16| match axis {
            Axis::X => !sheet.cuts_terminal_x(line, r.y0, r.y1),
            Axis::Y => !sheet.cuts_terminal_y(line, r.x0, r.x1),
        };
        std::iter::once(first)
            .chain((first + 1..last).filter(free))
            .chain([last])
            .collect()
    }

    /// Distances of the cuts from the region's start, in quanta.
    pub fn positions(&self, region: Region, axis: Axis, cuts: &[u16]) -> Vec<i64> {
        let sheet = &self.sheets[usize::from(region.sheet)];
        let quanta = match axis {
            Axis::X => &sheet.qx,
            Axis::Y => &sheet.qy,
        };
        cuts.iter()
            .map(|&c| quanta[usize::from(c)] - quanta[usize::from(cuts[0])])
            .collect()
    }
}

/// Shifts by the length of the first `k` intervals that map the region onto itself: `k`, how many
/// times that length fits, at least 2, and the cut at which what is left over ends (0 when nothing
/// is left over). A region has such a shift when what remains without its last `k` intervals equals
/// what remains without its first.
fn shifts(position: &[i64], strips: &Strips) -> Vec<(usize, u16, usize)> {
    let n = strips.intervals();
    let total = position[n];
    (1..n)
        .filter_map(|k| {
            let length = position[k];
            if total < 2 * length {
                return None;
            }
            let shifted = position.binary_search(&(total - length)).ok()?;
            let rest = position.binary_search(&(total % length)).ok()?;
            (strips.strip(0, shifted) == strips.strip(k, n)).then_some((
                k,
                (total / length) as u16,
                rest,
            ))
        })
        .collect()
}

/// Pairs of cuts at equal distance from the two ends, from the outside in.
fn mirrors(position: &[i64]) -> Vec<(u16, u16)> {
    let total = position[position.len() - 1];
    position
        .iter()
        .enumerate()
        .take_while(|(_, p)| **p * 2 <= total)
        .filter_map(|(left, p)| {
            position
                .binary_search(&(total - p))
                .ok()
                .map(|right| (left as u16, right as u16))
        })
        .collect()
}

/// Grid indices of a region's ends along an axis.
pub(crate) fn ends(r: Region, axis: Axis) -> (u16, u16) {
    match axis {
        Axis::X => (r.x0, r.x1),
        Axis::Y => (r.y0, r.y1),
    }
}

/// The strip of a region between two grid indices.
pub(crate) fn part(r: Region, axis: Axis, from: u16, to: u16) -> Region {
    match axis {
        Axis::X => Region {
            x0: from,
            x1: to,
            ..r
        },
        Axis::Y => Region {
            y0: from,
            y1: to,
            ..r
        },
    }
}

/// The coarsest power of ten that all coordinates are multiples of (within 1e-9 of the size); a
/// millionth of the size when there is none, so that noise in the last digits never separates
/// equal regions.
fn common_quantum(facades: &[Facade]) -> f64 {
    let size = facades
        .iter()
        .map(|f| f.width.max(f.height))
        .fold(0.0, f64::max);
    let coordinates = || {
        facades
            .iter()
            .flat_map(|f| &f.regions)
            .flat_map(|r| [r.rect.x, r.rect.right(), r.rect.y, r.rect.top()])
    };
    (0..=6)
        .map(|digits| 10f64.powi(-digits))
        .find(|q| coordinates().all(|v| ((v / q).round() * q - v).abs() <= 1e-9 * size))
        .unwrap_or(1e-6 * size)
}
