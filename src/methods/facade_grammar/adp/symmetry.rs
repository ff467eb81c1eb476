//! Symmetry detection: repeated regions, grown from repeated terminals (Sec. 4.3).
//!
//! Terminal regions that occur at least twice (same label, same size) are the seeds. A repeated
//! region grows left, right, up and down: each of its occurrences takes in the nearest terminals on
//! that side until it is a rectangle that cuts no terminal (Fig. 7). Grown regions that still occur
//! twice are repeated regions themselves.

use std::collections::BinaryHeap;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::regions::{LayoutIndex, Region, TypeId, Types};

/// A repeated region: `a` terminals and where it occurs, `o` times.
#[derive(Debug, Clone)]
pub(crate) struct Repeated {
    pub id: TypeId,
    pub terminals: u32,
    pub occurrences: Vec<Region>,
}

impl Repeated {
    /// `f(a, o) = (a - 1) (o - 1)`, the importance of a region (Sec. 4.7).
    pub(crate) fn score(&self) -> f64 {
        f64::from(self.terminals - 1) * (self.occurrences.len() - 1) as f64
    }
}

/// Occurrences kept in all, per terminal of the layout; see [`detect`].
const OCCURRENCES_PER_TERMINAL: usize = 16;
/// Occurrences kept at least, so that small layouts are searched exhaustively.
const OCCURRENCES_AT_LEAST: usize = 4096;

/// Finds repeated regions of more than one terminal.
///
/// Exhaustive on small layouts. A regular grid of `n` cells has `O(n^2)` occurrences of repeated
/// regions, so on large ones the most important regions by `f(a, o)` grow first and the search ends
/// when it holds a fixed number of occurrences per terminal: near-linear in time and memory.
pub(crate) fn detect(types: &mut Types) -> Vec<Repeated> {
    let terminals: usize = types.layouts.iter().map(|s| s.terminals.len()).sum();
    let budget = (OCCURRENCES_PER_TERMINAL * terminals).max(OCCURRENCES_AT_LEAST);
    let mut queue: BinaryHeap<(u64, std::cmp::Reverse<usize>)> = BinaryHeap::new();
    let mut found: Vec<Repeated> = Vec::new();
    for occurrences in repeated_terminals(types) {
        queue.push((0, std::cmp::Reverse(found.len())));
        found.push(Repeated {
            id: 0,
            terminals: 1,
            occurrences,
        });
    }
    let seeds = found.len();
    let mut known: FxHashSet<TypeId> = FxHashSet::default();
    let mut kept = 0;
    while let Some((_, std::cmp::Reverse(index))) = queue.pop() {
        for side in Side::ALL {
            for (id, occurrences) in grow(types, &found[index].occurrences, side) {
                if occurrences.len() < 2 || !known.insert(id) {
                    continue;
                }
                kept += occurrences.len();
                let repeated = Repeated {
                    id,
                    terminals: types.terminals(id),
                    occurrences,
                };
                queue.push((repeated.score() as u64, std::cmp::Reverse(found.len())));
                found.push(repeated);
            }
        }
        if kept > budget {
            break;
        }
    }
    found.split_off(seeds)
}

/// Terminals of equal label and size that occur at least twice.
fn repeated_terminals(types: &Types) -> Vec<Vec<Region>> {
    let mut groups: FxHashMap<(u32, u64, u64), usize> = FxHashMap::default();
    let mut all: Vec<Vec<Region>> = Vec::new();
    for layout in types.layouts.iter() {
        for &(region, label) in &layout.terminals {
            let key = (label, layout.extent_x(region), layout.extent_y(region));
            let group = *groups.entry(key).or_insert_with(|| {
                all.push(Vec::new());
                all.len() - 1
            });
            all[group].push(region);
        }
    }
    all.retain(|group| group.len() > 1);
    all
}

/// Grows every occurrence to one side and groups what results by type, in order of appearance.
fn grow(types: &mut Types, occurrences: &[Region], side: Side) -> Vec<(TypeId, Vec<Region>)> {
    let mut groups: Vec<(TypeId, Vec<Region>)> = Vec::new();
    let mut index: FxHashMap<TypeId, usize> = FxHashMap::default();
    for &region in occurrences {
        let layout = &types.layouts[usize::from(region.layout)];
        let Some(grown) = side.grown(layout, region) else {
            continue;
        };
        let id = types.intern(grown);
        let group = *index.entry(id).or_insert_with(|| {
            groups.push((id, Vec::new()));
            groups.len() - 1
        });
        groups[group].1.push(grown);
    }
    groups
}

/// A direction to grow in.
#[derive(Clone, Copy)]
enum Side {
    Left,
    Right,
    Top,
    Bottom,
}

impl Side {
    const ALL: [Side; 4] = [Side::Left, Side::Right, Side::Top, Side::Bottom];

    /// The smallest larger region on this side that cuts no terminal, if there is one.
    fn grown(self, layout: &LayoutIndex, r: Region) -> Option<Region> {
        let (last_x, last_y) = ((layout.xs.len() - 1) as u16, (layout.ys.len() - 1) as u16);
        let flush_x =
            |y: u16, a: u16, b: u16| y == 0 || y == last_y || !layout.cuts_terminal_y(y, a, b);
        let flush_y =
            |x: u16, a: u16, b: u16| x == 0 || x == last_x || !layout.cuts_terminal_x(x, a, b);
        let closed_x = |x: u16| flush_y(x, r.y0, r.y1);
        let closed_y = |y: u16| flush_x(y, r.x0, r.x1);
        match self {
            Side::Left => (0..r.x0)
                .rev()
                .take_while(|&x| flush_x(r.y0, x, r.x0) && flush_x(r.y1, x, r.x0))
                .find(|&x| closed_x(x))
                .map(|x0| Region { x0, ..r }),
            Side::Right => (r.x1 + 1..=last_x)
                .take_while(|&x| flush_x(r.y0, r.x1, x) && flush_x(r.y1, r.x1, x))
                .find(|&x| closed_x(x))
                .map(|x1| Region { x1, ..r }),
            Side::Top => (r.y1 + 1..=last_y)
                .take_while(|&y| flush_y(r.x0, r.y1, y) && flush_y(r.x1, r.y1, y))
                .find(|&y| closed_y(y))
                .map(|y1| Region { y1, ..r }),
            Side::Bottom => (0..r.y0)
                .rev()
                .take_while(|&y| flush_y(r.x0, y, r.y0) && flush_y(r.x1, y, r.y0))
                .find(|&y| closed_y(y))
                .map(|y0| Region { y0, ..r }),
        }
    }
}
