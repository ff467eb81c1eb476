//! Urban morphology: measures of a city's plan, by which a new city is judged beside the one that it is made from.
//!
//! Measures are taken in squares of a few hundred metres and pooled over them, since a city's quarters differ. They are read off
//! the triangles of the buildings, with none of the code that makes new cities.

mod plan;

use petgraph::unionfind::UnionFind;
use rustc_hash::{FxHashMap, FxHashSet};

use self::plan::{Building, building, distance};
use edifice_shape::triangles::City;

/// Buildings are attached where their walls are at most so far apart, in metres.
pub const ATTACHED: f64 = 0.5;
/// Neighbours are the so many nearest,
pub const NEIGHBOURS: usize = 4;
/// with middles at most so far apart, in metres;
pub const NEIGHBOURHOOD: f64 = 40.0;
/// they are parallel if their sides are, or are at right angles, within so many degrees.
pub const PARALLEL: f64 = 5.0;
/// Gaps are counted up to so many metres.
pub const LARGEST_GAP: f64 = 60.0;
/// A square is town if nowhere in at least this share of it
const TOWN: f64 = 0.9;
/// the nearest building is farther than so many metres, in steps of [`TOWN_STEP`].
const TOWN_REACH: f64 = 100.0;
const TOWN_STEP: f64 = 25.0;
/// Side of the cells in which the covered share is counted, in metres.
const CELL: f64 = 1.0;
/// Side of the cells by which neighbours are found, in metres.
const NEAR: f64 = 60.0;

/// A square of the plan with sides along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Square {
    /// Lowest coordinates, in metres.
    pub low: [f64; 2],
    /// Side, in metres.
    pub side: f64,
}

impl Square {
    fn contains(&self, p: [f64; 2]) -> bool {
        (0..2).all(|k| self.low[k] <= p[k] && p[k] < self.low[k] + self.side)
    }
}

/// Measures of a plan, pooled over its squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Morphology {
    /// Buildings whose middle is in a square; counted once a square, as everything else.
    pub buildings: usize,
    /// Buildings a block: a block is a set of attached buildings, counted where the middle of its buildings' middles is.
    pub buildings_per_block: f64,
    /// Share of buildings that are attached to another.
    pub attached: f64,
    /// Share of pairs of neighbours that are parallel ([`NEIGHBOURS`], [`PARALLEL`]).
    pub parallel: f64,
    /// Mean distance of a building's walls to those of the nearest building of another block, in metres, at most [`LARGEST_GAP`].
    pub gap: f64,
    /// Share of the ground that is covered.
    pub covered: f64,
    /// Share of the buildings' plans that lies under another building.
    pub overlap: f64,
    /// Medians of the smaller and the larger side of the rectangle around a building, and of its height, in metres.
    pub sizes: [f64; 3],
}

/// The place of a building among others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbourhood {
    /// The number of buildings of its block, itself among them.
    pub block_size: usize,
    /// True if it is attached to another building.
    pub attached: bool,
    /// Distance of its walls to those of the nearest building of another block, in metres, at most [`LARGEST_GAP`].
    pub gap: f64,
}

/// Of each building of a city, the share of its plan that larger buildings cover as well; 0 of one without triangles.
pub fn under_larger(city: &City) -> Vec<f64> {
    let cells = |i: usize| {
        let plan = building(&city.buildings[i].mesh);
        plan.map_or_else(Default::default, |b| b.cells(CELL))
    };
    let size: Vec<usize> = (0..city.buildings.len()).map(|i| cells(i).len()).collect();
    let mut order: Vec<usize> = (0..size.len()).collect();
    order.sort_by_key(|&i| std::cmp::Reverse(size[i]));
    let mut covered: FxHashSet<[i64; 2]> = FxHashSet::default();
    let mut under = vec![0.0; size.len()];
    for i in order {
        let own = cells(i);
        let shared = own.iter().filter(|c| covered.contains(*c)).count();
        under[i] = shared as f64 / own.len().max(1) as f64;
        covered.extend(own);
    }
    under
}

/// A city's buildings as the measures need them.
pub struct CityPlan {
    buildings: Vec<Building>,
    /// Index in the city of each building.
    index: Vec<usize>,
    /// Block of each building.
    block: Vec<usize>,
    attached: Vec<bool>,
    /// Distance to the nearest building of another block.
    gap: Vec<f64>,
    /// Buildings above each cell of side [`CELL`].
    cells: FxHashMap<[i64; 2], u32>,
    near: FxHashMap<[i64; 2], Vec<usize>>,
}

impl CityPlan {
    /// The plan of a city; buildings without triangles are left out.
    pub fn new(city: &City) -> Self {
        let (index, buildings): (Vec<usize>, Vec<Building>) = city
            .buildings
            .iter()
            .enumerate()
            .filter_map(|(i, b)| Some((i, building(&b.mesh)?)))
            .unzip();
        let mut near: FxHashMap<[i64; 2], Vec<usize>> = FxHashMap::default();
        for (i, b) in buildings.iter().enumerate() {
            let [low, high] = [b.low, b.high].map(|p| p.map(|v| (v / NEAR).floor() as i64));
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    near.entry([x, y]).or_default().push(i);
                }
            }
        }
        let mut cells: FxHashMap<[i64; 2], u32> = FxHashMap::default();
        for b in &buildings {
            for cell in b.cells(CELL) {
                *cells.entry(cell).or_default() += 1;
            }
        }
        let mut plan = Self {
            block: Vec::new(),
            attached: vec![false; buildings.len()],
            gap: vec![LARGEST_GAP; buildings.len()],
            buildings,
            index,
            cells,
            near,
        };
        plan.join();
        plan.measure_gaps();
        plan
    }

    /// The places of the buildings, each with the index in the city; buildings without triangles have none.
    pub fn neighbourhoods(&self) -> impl Iterator<Item = (usize, Neighbourhood)> {
        let mut sizes: FxHashMap<usize, usize> = FxHashMap::default();
        for &block in &self.block {
            *sizes.entry(block).or_default() += 1;
        }
        self.index.iter().enumerate().map(move |(i, &of)| {
            let neighbourhood = Neighbourhood {
                block_size: sizes[&self.block[i]],
                attached: self.attached[i],
                gap: self.gap[i],
            };
            (of, neighbourhood)
        })
    }

    /// Pairs of buildings whose walls are at most `reach` metres apart, by their indices in the city.
    pub fn pairs_within(&self, reach: f64) -> Vec<[usize; 2]> {
        let pairs = self.within(reach).into_iter();
        pairs.map(|(i, j)| [self.index[j], self.index[i]]).collect()
    }

    fn within(&self, reach: f64) -> Vec<(usize, usize)> {
        let mut out = Vec::new();
        for i in 0..self.buildings.len() {
            for (_, j) in self.around(i, reach) {
                let walls = [i, j].map(|b| self.buildings[b].walls.as_slice());
                if j < i && distance(walls[0], walls[1], reach) <= reach {
                    out.push((i, j));
                }
            }
        }
        out
    }

    /// Buildings whose rectangles along the axes are nearer to that of `i` than `reach`, the nearest first.
    fn around(&self, i: usize, reach: f64) -> Vec<(f64, usize)> {
        let b = &self.buildings[i];
        let low = b.low.map(|v| ((v - reach) / NEAR).floor() as i64);
        let high = b.high.map(|v| ((v + reach) / NEAR).floor() as i64);
        let mut found = Vec::new();
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                found.extend(self.near.get(&[x, y]).into_iter().flatten().copied());
            }
        }
        found.sort_unstable();
        found.dedup();
        let far = |j: usize| {
            let other = &self.buildings[j];
            let [x, y] = [0, 1].map(|k| {
                (other.low[k] - b.high[k])
                    .max(b.low[k] - other.high[k])
                    .max(0.0)
            });
            (x.hypot(y), j)
        };
        let mut out: Vec<(f64, usize)> = found.into_iter().filter(|&j| j != i).map(far).collect();
        out.retain(|(d, _)| *d <= reach);
        out.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        out
    }

    /// Joins attached buildings to blocks.
    fn join(&mut self) {
        let mut sets = UnionFind::new(self.buildings.len());
        for (i, j) in self.within(ATTACHED) {
            (self.attached[i], self.attached[j]) = (true, true);
            sets.union(i, j);
        }
        self.block = sets.into_labeling();
    }

    fn measure_gaps(&mut self) {
        for i in 0..self.buildings.len() {
            let mut least = LARGEST_GAP;
            for (d, j) in self.around(i, LARGEST_GAP) {
                if d >= least {
                    break;
                }
                if self.block[j] != self.block[i] {
                    least = least.min(distance(
                        &self.buildings[i].walls,
                        &self.buildings[j].walls,
                        least,
                    ));
                }
            }
            self.gap[i] = least;
        }
    }

    /// Squares of a side in metres that overlap by half, as far as they are town.
    pub fn squares(&self, side: f64) -> Vec<Square> {
        let mut corners: Vec<[i64; 2]> = Vec::new();
        let step = side / 2.0;
        for b in &self.buildings {
            let [x, y] = b.middle().map(|v| (v / step).floor() as i64);
            corners.extend([[x, y], [x - 1, y], [x, y - 1], [x - 1, y - 1]]);
        }
        corners.sort_unstable();
        corners.dedup();
        let square = |c: [i64; 2]| Square {
            low: c.map(|v| v as f64 * step),
            side,
        };
        corners
            .into_iter()
            .map(square)
            .filter(|s| self.is_town(s))
            .collect()
    }

    fn is_town(&self, square: &Square) -> bool {
        let n = (square.side / TOWN_STEP).ceil().max(1.0) as usize;
        let near = |p: [f64; 2]| {
            let [low, high] =
                [-TOWN_REACH, TOWN_REACH].map(|d| p.map(|v| ((v + d) / NEAR).floor() as i64));
            (low[0]..=high[0]).any(|x| {
                (low[1]..=high[1]).any(|y| {
                    let own = self.near.get(&[x, y]).into_iter().flatten();
                    own.copied()
                        .any(|i| self.buildings[i].from(p) <= TOWN_REACH)
                })
            })
        };
        let at = |i: usize| (i as f64 + 0.5) / n as f64 * square.side;
        let points = (0..n).flat_map(|i| (0..n).map(move |j| [at(i), at(j)]));
        let town = points.filter(|[x, y]| near([square.low[0] + x, square.low[1] + y]));
        town.count() as f64 >= TOWN * (n * n) as f64
    }

    /// The measures, pooled over squares; `None` without a building in them.
    pub fn measure(&self, squares: &[Square]) -> Option<Morphology> {
        let mut blocks: FxHashMap<usize, (usize, [f64; 2])> = FxHashMap::default();
        for (b, &block) in self.buildings.iter().zip(&self.block) {
            let (n, sum) = blocks.entry(block).or_default();
            *n += 1;
            *sum = [0, 1].map(|k| sum[k] + b.middle()[k]);
        }
        let (mut own, mut whole, mut in_blocks) = (Vec::new(), 0, 0);
        for s in squares {
            own.extend(
                (0..self.buildings.len()).filter(|&i| s.contains(self.buildings[i].middle())),
            );
            for (n, sum) in blocks.values() {
                if s.contains(sum.map(|v| v / *n as f64)) {
                    whole += 1;
                    in_blocks += n;
                }
            }
        }
        if own.is_empty() {
            return None;
        }
        let (mut covered, mut above) = (0u64, 0u64);
        for (cell, count) in &self.cells {
            let middle = cell.map(|v| (v as f64 + 0.5) * CELL);
            let times = squares.iter().filter(|s| s.contains(middle)).count() as u64;
            covered += times;
            above += times * u64::from(*count);
        }
        let ground: f64 = squares
            .iter()
            .map(|s| s.side * s.side / (CELL * CELL))
            .sum();
        let pairs: Vec<bool> = own.iter().flat_map(|&i| self.pairs(i)).collect();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let share = |values: &[bool]| {
            values.iter().filter(|v| **v).count() as f64 / values.len().max(1) as f64
        };
        let median = |k: usize| {
            let mut values: Vec<f64> = own.iter().map(|&i| self.buildings[i].sizes[k]).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        Some(Morphology {
            buildings: own.len(),
            buildings_per_block: in_blocks as f64 / f64::from(whole).max(1.0),
            attached: share(&own.iter().map(|&i| self.attached[i]).collect::<Vec<_>>()),
            parallel: share(&pairs),
            gap: mean(&own.iter().map(|&i| self.gap[i]).collect::<Vec<_>>()),
            covered: covered as f64 / ground,
            overlap: 1.0 - covered as f64 / above.max(1) as f64,
            sizes: [0, 1, 2].map(median),
        })
    }

    /// For each neighbour of a building: is it parallel?
    fn pairs(&self, i: usize) -> Vec<bool> {
        let b = &self.buildings[i];
        let far = |j: usize| {
            let [p, q] = [b.middle(), self.buildings[j].middle()];
            (p[0] - q[0]).hypot(p[1] - q[1])
        };
        let mut near: Vec<(f64, usize)> = self
            .around(i, NEIGHBOURHOOD)
            .iter()
            .map(|&(_, j)| (far(j), j))
            .collect();
        near.retain(|(d, _)| *d <= NEIGHBOURHOOD);
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let parallel = |&(_, j): &(f64, usize)| {
            let apart = (b.angle - self.buildings[j].angle).rem_euclid(90.0);
            apart.min(90.0 - apart) <= PARALLEL
        };
        near.iter().take(NEIGHBOURS).map(parallel).collect()
    }
}
