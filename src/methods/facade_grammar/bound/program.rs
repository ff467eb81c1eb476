//! The integer program of [`super`] for one facade: types, arcs, seams.

use rustc_hash::FxHashMap;

use crate::methods::facade_grammar::operations::Operations;
use crate::methods::facade_grammar::regions::{Region, Sheet, TypeId, Types, ends};
use crate::shape::Axis;

/// Target of an arc that needs no rule.
pub(super) const TERMINAL: u32 = u32::MAX;

/// What full lines along one axis can make of a type.
#[derive(Debug)]
pub(super) struct Side {
    /// Elementary intervals; fewer than 2 when nothing can be split.
    pub intervals: usize,
    /// Index of the side's first arc among all arcs.
    pub first: usize,
    /// Type (by its place in the closure) of the strip `a..b` at `b (b - 1) / 2 + a`.
    pub targets: Vec<u32>,
    /// Classes of the seams that a cut makes, by cut.
    pub seams: Vec<Vec<u32>>,
    /// Cuts at which the first period of a repetition ends.
    pub periods: Vec<usize>,
    /// Ends of the first A and the first B of alternations.
    pub alternations: Vec<(usize, usize)>,
    /// Mirrored cuts from the outside in.
    pub mirrors: Vec<(usize, usize)>,
    /// Pairs `(a, b)` of mirrors between which the two strips have one type, by `b`.
    pub mirrored: Vec<Vec<usize>>,
}

/// All types that derivations of the facade can meet; the root comes first.
#[derive(Debug)]
pub(super) struct Program {
    pub sides: Vec<[Side; 2]>,
    /// Number of arcs of all sides.
    pub arcs: usize,
    /// Number of classes of seams.
    pub seams: usize,
}

impl Program {
    /// The closure of the facade under strips; `None` when it has more than `limit` types, or when
    /// grids are allowed, which are no paths.
    pub fn new(types: &mut Types, operations: Operations, limit: usize) -> Option<Self> {
        if operations.grid_split {
            return None;
        }
        let mut order: Vec<TypeId> = vec![types.roots[0]];
        let mut place: FxHashMap<TypeId, u32> = FxHashMap::default();
        place.insert(order[0], 0);
        let mut next = 0;
        while next < order.len() {
            for axis in Axis::BOTH {
                for &t in types.strips(order[next], axis).all() {
                    if !types.is_terminal(t) && !place.contains_key(&t) {
                        place.insert(t, order.len() as u32);
                        order.push(t);
                    }
                }
            }
            if order.len() > limit {
                return None;
            }
            next += 1;
        }
        let (seams, classes) = Seams::new(&types.sheets[0]);
        let mut arcs = 0;
        let mut side = |types: &mut Types, id: TypeId, axis: Axis| {
            let strips = types.strips(id, axis);
            let n = strips.intervals();
            let targets: Vec<u32> = strips
                .all()
                .iter()
                .map(|t| place.get(t).copied().unwrap_or(TERMINAL))
                .collect();
            let region = types.region(id);
            let wide = |cuts: &[(u16, u16)]| -> Vec<(usize, usize)> {
                cuts.iter().map(|&(a, b)| (a.into(), b.into())).collect()
            };
            let mirrors = if operations.sym_split && n > 1 {
                wide(&strips.mirrors)
            } else {
                Vec::new()
            };
            let mirrored = (0..mirrors.len())
                .map(|b| {
                    let (left, right) = mirrors[b];
                    (0..b)
                        .filter(|&a| {
                            let (start, end) = mirrors[a];
                            strips.strip(start, left) == strips.strip(right, end)
                        })
                        .collect()
                })
                .collect();
            let first = arcs;
            arcs += targets.len();
            Side {
                intervals: n,
                first,
                targets,
                seams: (0..=n)
                    .map(|cut| match cut {
                        0 => Vec::new(),
                        _ if cut == n => Vec::new(),
                        _ => seams.across(region, axis, strips.cuts[cut]),
                    })
                    .collect(),
                periods: if operations.repeat {
                    strips.periods.iter().map(|p| p.intervals.into()).collect()
                } else {
                    Vec::new()
                },
                alternations: if operations.repeat_aba {
                    wide(&strips.alternations)
                } else {
                    Vec::new()
                },
                mirrors,
                mirrored,
            }
        };
        let sides = order
            .iter()
            .map(|&id| {
                [
                    side(types, id, Axis::BOTH[0]),
                    side(types, id, Axis::BOTH[1]),
                ]
            })
            .collect();
        Some(Self {
            sides,
            arcs,
            seams: classes,
        })
    }

    /// Number of types.
    pub fn types(&self) -> usize {
        self.sides.len()
    }

    /// Types that rules over `usable` types can still reach from the root.
    pub fn reachable(&self, usable: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut seen = vec![false; self.types()];
        let mut waiting = vec![0];
        seen[0] = true;
        while let Some(t) = waiting.pop() {
            for &u in self.sides[t].iter().flat_map(|s| &s.targets) {
                if u != TERMINAL && !seen[u as usize] && usable(u as usize) {
                    seen[u as usize] = true;
                    waiting.push(u as usize);
                }
            }
        }
        seen
    }
}

/// Contacts on a line: where each begins and ends, and its class.
type Contacts = Vec<(u16, u16, u32)>;

/// Where two terminals of the facade touch, by axis and line.
struct Seams {
    by_line: [FxHashMap<u16, Contacts>; 2],
}

impl Seams {
    /// All contacts, and the number of classes: equal labels, sizes and offset are one class.
    fn new(sheet: &Sheet) -> (Self, usize) {
        let mut classes = FxHashMap::default();
        let mut by_line: [FxHashMap<u16, Contacts>; 2] = Default::default();
        let what = |(r, label): (Region, u32)| (label, sheet.extent_x(r), sheet.extent_y(r));
        for axis in Axis::BOTH {
            let (along, quanta) = match axis {
                Axis::X => (Axis::Y, &sheet.qy),
                Axis::Y => (Axis::X, &sheet.qx),
            };
            let mut starting: FxHashMap<u16, Vec<(Region, u32)>> = FxHashMap::default();
            for &second in &sheet.terminals {
                starting
                    .entry(ends(second.0, axis).0)
                    .or_default()
                    .push(second);
            }
            for &first in &sheet.terminals {
                let line = ends(first.0, axis).1;
                for &second in starting.get(&line).into_iter().flatten() {
                    let (one, two) = (ends(first.0, along), ends(second.0, along));
                    let (low, high) = (one.0.max(two.0), one.1.min(two.1));
                    if low >= high {
                        continue;
                    }
                    let offset = quanta[usize::from(two.0)] - quanta[usize::from(one.0)];
                    let fresh = classes.len() as u32;
                    let class = *classes
                        .entry((axis as usize, what(first), what(second), offset))
                        .or_insert(fresh);
                    by_line[axis as usize]
                        .entry(line)
                        .or_default()
                        .push((low, high, class));
                }
            }
        }
        let count = classes.len();
        (Self { by_line }, count)
    }

    /// Classes of the contacts that a line through a region separates.
    fn across(&self, region: Region, axis: Axis, line: u16) -> Vec<u32> {
        let (low, high) = match axis {
            Axis::X => ends(region, Axis::Y),
            Axis::Y => ends(region, Axis::X),
        };
        let contacts = self.by_line[axis as usize].get(&line);
        let mut classes: Vec<u32> = contacts
            .into_iter()
            .flatten()
            .filter(|(l, h, _)| *l >= low && *h <= high)
            .map(|(_, _, class)| *class)
            .collect();
        classes.sort_unstable();
        classes.dedup();
        classes
    }
}
