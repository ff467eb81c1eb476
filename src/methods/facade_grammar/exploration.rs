//! Exploration: rules drawn with probability `exp(-H) / sum exp(-H)` (Sec. 4.2 and 4.4).
//!
//! ```text
//! H(rule) = lambda_1 cost_r(rule) + lambda_2 sum_{lines of the rule} cost_sl(line)          (Eq. 5)
//! cost_sl(line) = sum_{repeated regions inside R that the line cuts} terminals / terminals of R
//! ```
//!
//! The rules that are drawn from are in [`super::reasonable`].

use std::rc::Rc;

use rand::{Rng, RngExt};
use rustc_hash::FxHashSet;

use super::choice::{Arrangement, Choice};
use super::grid;
use super::operations::Operations;
use super::reasonable::{self, Candidate};
use super::regions::{Region, Strips, TypeId, Types, ends};
use super::symmetry::Repeated;
use crate::grammar::Costs;
use crate::shape::Axis;

/// Weights of the two parts of Eq. 5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lambdas {
    pub rule: f64,
    pub lines: f64,
}

/// The splitting heuristic of a layout.
#[derive(Debug)]
pub(crate) struct Exploration {
    costs: Costs,
    operations: Operations,
    lambdas: Lambdas,
    /// Occurrences of repeated regions: per sheet and bottom row, sorted by left edge.
    occurrences: Vec<Vec<Vec<(Region, f64)>>>,
    repeated: Vec<Repeated>,
    repeated_types: FxHashSet<TypeId>,
    protect: bool,
    /// Occurrences that no line may cross during this walk (Sec. 4.7).
    protected: Vec<Region>,
    menus: Vec<Option<Rc<Menu>>>,
}

/// A rule and its `H`.
pub(crate) type Weighed = (f64, Rc<Choice>);

/// The candidates for one type, and the cost of every line.
#[derive(Debug)]
struct Menu {
    candidates: Vec<Candidate>,
    grids: Vec<Weighed>,
    line_costs: [Vec<f64>; 2],
    /// The candidates as rules, when nothing is protected.
    open: Rc<[Weighed]>,
}

impl Exploration {
    pub fn new(
        types: &Types,
        repeated: Vec<Repeated>,
        costs: Costs,
        operations: Operations,
        lambdas: Lambdas,
        protect: bool,
    ) -> Self {
        let mut occurrences: Vec<Vec<Vec<(Region, f64)>>> = types
            .sheets
            .iter()
            .map(|s| vec![Vec::new(); s.ys.len()])
            .collect();
        for group in &repeated {
            for &region in &group.occurrences {
                occurrences[usize::from(region.sheet)][usize::from(region.y0)]
                    .push((region, f64::from(group.terminals)));
            }
        }
        for row in occurrences.iter_mut().flatten() {
            row.sort_by_key(|(r, _)| (r.x0, r.x1, r.y1));
        }
        Self {
            costs,
            operations,
            lambdas,
            occurrences,
            repeated_types: repeated.iter().map(|r| r.id).collect(),
            repeated,
            protect,
            protected: Vec::new(),
            menus: Vec::new(),
        }
    }

    /// Draws the regions that this walk protects: repeated regions in random order with probability
    /// proportional to `f(a, o)`, each kept when none of its occurrences overlaps one kept before
    /// without one containing the other (Sec. 4.7).
    pub fn protect_anew<R: Rng>(&mut self, rng: &mut R) {
        self.protected.clear();
        if !self.protect || self.repeated.is_empty() {
            return;
        }
        let total: f64 = self.repeated.iter().map(Repeated::score).sum();
        for _ in 0..rng.random_range(0..=PROTECTION_DRAWS) {
            let mut rest = rng.random::<f64>() * total;
            let drawn = self.repeated.iter().find(|r| {
                rest -= r.score();
                rest < 0.0
            });
            let Some(group) = drawn else { continue };
            let apart = group.occurrences.iter().enumerate().all(|(i, a)| {
                !group.occurrences[i + 1..]
                    .iter()
                    .chain(&self.protected)
                    .any(|b| overlap(*a, *b))
            });
            if apart {
                self.protected.extend(&group.occurrences);
            }
        }
    }

    /// Protects nothing.
    pub fn unprotect(&mut self) {
        self.protected.clear();
    }

    /// Draws a rule for a type with probability `exp(-H) / sum exp(-H)`.
    pub fn sample<R: Rng>(&mut self, types: &mut Types, id: TypeId, rng: &mut R) -> Rc<Choice> {
        let mut rules = self.rules(types, id);
        if rules.is_empty() {
            // Every rule crosses a protected region: protection gives way.
            self.protected.clear();
            rules = self.rules(types, id);
        }
        let least = rules.iter().map(|(h, _)| *h).fold(f64::INFINITY, f64::min);
        let total: f64 = rules.iter().map(|(h, _)| (least - h).exp()).sum();
        let mut rest = rng.random::<f64>() * total;
        let drawn = rules.iter().position(|(h, _)| {
            rest -= (least - h).exp();
            rest < 0.0
        });
        Rc::clone(&rules[drawn.unwrap_or(rules.len() - 1)].1)
    }

    /// The reasonable rules for a type that cross no protected region.
    pub fn rules(&mut self, types: &mut Types, id: TypeId) -> Rc<[Weighed]> {
        let menu = self.menu(types, id);
        let region = types.region(id);
        let blocked = Axis::BOTH.map(|axis| self.blocked(types, id, region, axis));
        if blocked.iter().all(Vec::is_empty) {
            return Rc::clone(&menu.open);
        }
        let strips = Axis::BOTH.map(|axis| types.strips(id, axis));
        let open = |grid: &Choice| {
            let crossed =
                |lines: &[u16], blocked: &[u16]| lines.iter().any(|l| blocked.contains(l));
            !crossed(&grid.lines, &blocked[0]) && !crossed(&grid.rows, &blocked[1])
        };
        menu.candidates
            .iter()
            .filter_map(|c| {
                let slot = c.axis as usize;
                let lines = c.without(&blocked[slot])?;
                Some(self.weigh(c.arrangement, lines, &strips[slot], &menu.line_costs[slot]))
            })
            .chain(menu.grids.iter().filter(|(_, grid)| open(grid)).cloned())
            .collect()
    }

    /// The rule with its `H`, Eq. 5.
    fn weigh(
        &self,
        arrangement: Arrangement,
        lines: Vec<u16>,
        strips: &Strips,
        line_costs: &[f64],
    ) -> Weighed {
        let inner = &lines[1..lines.len() - 1];
        let cut: f64 = inner.iter().map(|l| line_costs[usize::from(*l)]).sum();
        let choice = Choice::between(arrangement, lines, strips);
        (
            self.lambdas.rule * choice.cost(&self.costs) + self.lambdas.lines * cut,
            Rc::new(choice),
        )
    }

    /// For every cost that a line has, the grid of all lines that cost no more.
    fn grids(&self, types: &mut Types, id: TypeId, line_costs: &[Vec<f64>; 2]) -> Vec<Weighed> {
        if !self.operations.grid_split {
            return Vec::new();
        }
        let Some(cells) = types.cells(id) else {
            return Vec::new();
        };
        let cut = |axis: usize, lines: &[u16]| -> f64 {
            let inner = &lines[1..lines.len() - 1];
            inner
                .iter()
                .map(|l| line_costs[axis][usize::from(*l)])
                .sum()
        };
        reasonable::grids(line_costs, cells.intervals())
            .into_iter()
            .map(|(columns, rows)| {
                let cut = cut(0, &columns) + cut(1, &rows);
                let choice = grid::between(&cells, columns, rows);
                let h = self.lambdas.rule * choice.cost(&self.costs) + self.lambdas.lines * cut;
                (h, Rc::new(choice))
            })
            .collect()
    }

    /// Cuts of the region that cross a protected occurrence inside it.
    fn blocked(&self, types: &mut Types, id: TypeId, region: Region, axis: Axis) -> Vec<u16> {
        if self.protected.is_empty() {
            return Vec::new();
        }
        let inside: Vec<(u16, u16)> = self
            .protected
            .iter()
            .filter(|p| contains(region, **p))
            .map(|p| ends(*p, axis))
            .collect();
        let strips = types.strips(id, axis);
        let crossed = |cut: u16| inside.iter().any(|(from, to)| *from < cut && cut < *to);
        (0..strips.cuts.len() as u16)
            .filter(|i| crossed(strips.cuts[usize::from(*i)]))
            .collect()
    }

    fn menu(&mut self, types: &mut Types, id: TypeId) -> Rc<Menu> {
        let index = id as usize;
        if self.menus.len() <= index {
            self.menus.resize(index + 1, None);
        }
        if let Some(menu) = &self.menus[index] {
            return Rc::clone(menu);
        }
        let region = types.region(id);
        let terminals = f64::from(types.terminals(id));
        let strips = Axis::BOTH.map(|axis| types.strips(id, axis));
        let line_costs =
            Axis::BOTH.map(|axis| self.line_costs(region, terminals, axis, &strips[axis as usize]));
        let candidates: Vec<Candidate> = Axis::BOTH
            .into_iter()
            .flat_map(|axis| {
                let slot = axis as usize;
                reasonable::along(
                    axis,
                    &strips[slot],
                    &line_costs[slot],
                    self.operations,
                    &self.repeated_types,
                )
            })
            .collect();
        let grids = self.grids(types, id, &line_costs);
        let open = candidates
            .iter()
            .map(|c| {
                let slot = c.axis as usize;
                self.weigh(
                    c.arrangement,
                    c.lines.clone(),
                    &strips[slot],
                    &line_costs[slot],
                )
            })
            .chain(grids.iter().cloned())
            .collect();
        let menu = Rc::new(Menu {
            candidates,
            grids,
            line_costs,
            open,
        });
        self.menus[index] = Some(Rc::clone(&menu));
        menu
    }

    /// `cost_sl` of every cut of a region (Fig. 8).
    fn line_costs(&self, region: Region, terminals: f64, axis: Axis, strips: &Strips) -> Vec<f64> {
        let mut costs = vec![0.0; strips.cuts.len() + 1];
        for row in &self.occurrences[usize::from(region.sheet)]
            [usize::from(region.y0)..usize::from(region.y1)]
        {
            let first = row.partition_point(|(r, _)| r.x0 < region.x0);
            for (r, weight) in row[first..].iter().take_while(|(r, _)| r.x0 < region.x1) {
                if *r == region || !contains(region, *r) {
                    continue;
                }
                let (from, to) = ends(*r, axis);
                costs[strips.cuts.partition_point(|&c| c <= from)] += weight;
                costs[strips.cuts.partition_point(|&c| c < to)] -= weight;
            }
        }
        let mut sum = 0.0;
        for cost in &mut costs {
            sum += *cost;
            *cost = sum / terminals;
        }
        costs
    }
}

/// Draws of protected regions per walk, at most.
const PROTECTION_DRAWS: usize = 60;

fn contains(outer: Region, inner: Region) -> bool {
    outer.sheet == inner.sheet
        && outer.x0 <= inner.x0
        && inner.x1 <= outer.x1
        && outer.y0 <= inner.y0
        && inner.y1 <= outer.y1
}

/// Whether two regions share a cell and neither contains the other.
fn overlap(a: Region, b: Region) -> bool {
    let shared = a.sheet == b.sheet && a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
    shared && !contains(a, b) && !contains(b, a)
}
