//! New cities from a grammar's buildings, within a drawn shape (Fig. 9).
//!
//! A building of type A that stands calls for its neighbours: where, in the grammar's city, a building of type A has
//! a neighbour of type B, a B is put at the same place relative to it, if it lies inside the shape and on
//! nothing that stands. Most often the neighbours are those of the very building that was copied; now and then (`JUMP`)
//! those of another building of its type, the one copied least so far, so that the new city is no copy of a district.
//! Where nothing more fits, a building that was copied least is tried at chance places, and the growth goes on from
//! there.
//!
//! Whether buildings overlap is read off a grid of 1 m: inner points of a new building must find cells that no other
//! building covers. A building also brings the open ground that is nearer to it than to any other building of its city: no other may
//! stand there, so that streets and yards stay open. Buildings are in classes of equally many, by plan area and height, and no class
//! may run ahead of the others, so that small buildings do not take over where large ones do not fit.

mod occupancy;

use std::collections::VecDeque;

use rand::RngExt;

use self::occupancy::{Footprint, Occupancy, footprint, open_ground};
use crate::grammar::instance::{
    InstanceGrammar, InstanceGrammarError, InstanceRule, Placement, TemplateInstance,
};
use crate::rng;
use crate::shape::triangles::TriangleMesh;

/// Share of buildings whose neighbours are those of another building of the same type.
const JUMP: f64 = 0.12;
/// Neighbours of a building are no farther from it, in metres,
const REACH: f64 = 80.0;
/// and so many at most.
const NEIGHBOURS: usize = 10;
/// Chance places tried one after the other without success before the shape is full.
const TRIES: usize = 200;
/// Classes by plan area,
const AREAS: usize = 16;
/// and in each by height.
const HEIGHTS: usize = 2;
/// A class may have so many times its share of the copies,
const AHEAD: f64 = 1.05;
/// and so many more.
const MORE: f64 = 1.0;
/// A building is copied no more often than the one copied least, plus this.
const SPREAD: usize = 1;

/// A shape on the ground: rings in metres, even-odd.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shape {
    /// The rings; the last corner joins the first.
    pub rings: Vec<Vec<[f64; 2]>>,
}

impl Shape {
    /// Whether a point is inside.
    pub fn contains(&self, p: [f64; 2]) -> bool {
        let mut inside = false;
        for ring in &self.rings {
            for (i, a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                if (a[1] > p[1]) != (b[1] > p[1])
                    && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
                {
                    inside = !inside;
                }
            }
        }
        inside
    }

    /// Lowest and highest coordinates; `None` without corners.
    pub fn bounds(&self) -> Option<([f64; 2], [f64; 2])> {
        let corners = self.rings.iter().flatten();
        corners.fold(None, |b: Option<([f64; 2], [f64; 2])>, p| {
            let (l, h) = b.unwrap_or((*p, *p));
            Some((
                [l[0].min(p[0]), l[1].min(p[1])],
                [h[0].max(p[0]), h[1].max(p[1])],
            ))
        })
    }

    /// Area, holes taken off.
    pub fn area(&self) -> f64 {
        // Rings inside others count against them, whatever way they turn.
        let ring_area = |ring: &Vec<[f64; 2]>| {
            let n = ring.len();
            let doubled: f64 = (0..n)
                .map(|i| {
                    let (a, b) = (ring[i], ring[(i + 1) % n]);
                    a[0] * b[1] - a[1] * b[0]
                })
                .sum();
            doubled.abs() / 2.0
        };
        let depth = |i: usize| {
            let others = self.rings.iter().enumerate().filter(|(j, _)| *j != i);
            let around = others.filter(|(_, r)| {
                let one = Self {
                    rings: vec![(*r).clone()],
                };
                self.rings[i].first().is_some_and(|&p| one.contains(p))
            });
            around.count()
        };
        (0..self.rings.len())
            .map(|i| ring_area(&self.rings[i]) * if depth(i) % 2 == 0 { 1.0 } else { -1.0 })
            .sum()
    }
}

/// A building of the grammar's city, to be copied.
struct Source {
    /// What stands under the axiom: one symbol, or the templates of a building.
    placed: Vec<Placement>,
    kind: usize,
    /// Class of plan area and height.
    class: usize,
    at: [f64; 3],
    turn: f64,
    height: f64,
    footprint: Footprint,
    /// Other sources near it, the nearest first.
    near: Vec<usize>,
}

/// A copy: source, place and turn.
#[derive(Clone, Copy)]
struct Copy {
    source: usize,
    at: [f64; 2],
    turn: f64,
}

/// A grammar over the same templates and rules whose axiom fills `shape`; buildings are named `s1`, `s2`, ....
///
/// # Errors
/// [`InstanceGrammarError`]; the grammar is checked whole first.
pub fn synthesize(
    grammar: &InstanceGrammar,
    shape: &Shape,
    seed: u64,
) -> Result<InstanceGrammar, InstanceGrammarError> {
    let sources = sources(grammar)?;
    let copies = fill(&sources, shape, seed);
    let mut successors = Vec::new();
    for (i, copy) in copies.iter().enumerate() {
        let source = &sources[copy.source];
        for placed in &source.placed {
            let mut placed = placed.clone();
            let turn = copy.turn - source.turn;
            let [x, y] = rotated(
                [placed.at[0] - source.at[0], placed.at[1] - source.at[1]],
                turn,
            );
            let round = |v: f64, steps: f64| (v * steps).round() / steps;
            placed.at = [
                round(copy.at[0] + x, 100.0),
                round(copy.at[1] + y, 100.0),
                // Copies stand on level ground.
                round(placed.at[2] - source.at[2], 100.0),
            ];
            placed.turn = round((placed.turn + turn).rem_euclid(360.0), 100.0);
            placed.id = Some(format!("s{}", i + 1));
            placed.attributes.clear();
            successors.push(placed);
        }
    }
    let mut out = grammar.clone();
    for rule in out.rules.iter_mut().filter(|r| r.symbol == out.axiom) {
        *rule = InstanceRule {
            symbol: rule.symbol.clone(),
            weight: 1.0,
            successors: std::mem::take(&mut successors),
        };
    }
    Ok(out)
}

/// The buildings of the grammar's city.
fn sources(grammar: &InstanceGrammar) -> Result<Vec<Source>, InstanceGrammarError> {
    let derivation = grammar.derive()?;
    let mut parts: Vec<Vec<&TemplateInstance>> = vec![Vec::new(); derivation.buildings.len()];
    for instance in &derivation.instances {
        if let Some(b) = instance.building {
            parts[b].push(instance);
        }
    }
    // What stands right under the axiom is copied as it is, with its rule.
    let axiom = grammar.rules.iter().find(|r| r.symbol == grammar.axiom);
    let mut whole = rustc_hash::FxHashMap::default();
    for s in axiom.iter().flat_map(|r| &r.successors) {
        if let Some(id) = &s.id {
            whole.entry(id.as_str()).or_insert_with(Vec::new).push(s);
        }
    }
    let mut kinds: rustc_hash::FxHashMap<Vec<String>, usize> = rustc_hash::FxHashMap::default();
    let mut out = Vec::new();
    for ((id, _), parts) in derivation.buildings.iter().zip(&parts) {
        let Some(first) = parts.first() else { continue };
        let placed: Vec<Placement> = match whole.get(id.as_str()) {
            Some(list) => list.iter().map(|p| (*p).clone()).collect(),
            None => parts.iter().map(|i| terminal(grammar, i)).collect(),
        };
        let symbols: Vec<String> = placed.iter().map(|p| p.symbol.clone()).collect();
        let next = kinds.len();
        let kind = *kinds.entry(symbols).or_insert(next);
        let mut mesh = TriangleMesh::default();
        for part in parts {
            let template = &grammar.templates[part.template].mesh;
            mesh.append(&TriangleMesh {
                positions: template.positions.iter().map(|&p| part.place(p)).collect(),
                triangles: template.triangles.clone(),
            });
        }
        let (at, turn) = (first.at, placed.first().map_or(0.0, |p| p.turn));
        out.push(Source {
            placed,
            kind,
            class: 0,
            at,
            turn,
            height: mesh.bounds().map_or(0.0, |b| b.1[2] - b.0[2]),
            footprint: footprint(&mesh, at, turn),
            near: Vec::new(),
        });
    }
    let frames: Vec<([f64; 3], f64)> = out.iter().map(|s| (s.at, s.turn)).collect();
    let prints: Vec<&Footprint> = out.iter().map(|s| &s.footprint).collect();
    let open = open_ground(&prints, &frames);
    for (source, open) in out.iter_mut().zip(open) {
        source.footprint.open = open;
    }
    classify(&mut out);
    let near: Vec<Vec<usize>> = neighbours(&out);
    for (source, near) in out.iter_mut().zip(near) {
        source.near = near;
    }
    Ok(out)
}

/// Puts sources into classes of equally many.
fn classify(sources: &mut [Source]) {
    let n = sources.len();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by_key(|&i| (sources[i].footprint.points(), i));
    for a in 0..AREAS {
        let own = &mut order[a * n / AREAS..(a + 1) * n / AREAS];
        own.sort_by(|&i, &j| {
            sources[i]
                .height
                .total_cmp(&sources[j].height)
                .then(i.cmp(&j))
        });
        for (rank, &i) in own.iter().enumerate() {
            sources[i].class = a * HEIGHTS + rank * HEIGHTS / own.len();
        }
    }
}

fn terminal(grammar: &InstanceGrammar, i: &TemplateInstance) -> Placement {
    let symbol = grammar.templates[i.template].symbol.clone();
    Placement::new(symbol, i.at, i.turn, i.size)
}

/// The nearest sources of each, by a grid.
fn neighbours(sources: &[Source]) -> Vec<Vec<usize>> {
    let cell = |p: &[f64; 3]| [0, 1].map(|k| (p[k] / REACH).floor() as i64);
    let mut grid: rustc_hash::FxHashMap<[i64; 2], Vec<usize>> = rustc_hash::FxHashMap::default();
    for (i, s) in sources.iter().enumerate() {
        grid.entry(cell(&s.at)).or_default().push(i);
    }
    let far = |i: usize, j: usize| {
        let (a, b) = (sources[i].at, sources[j].at);
        (a[0] - b[0]).hypot(a[1] - b[1])
    };
    (0..sources.len())
        .map(|i| {
            let [x, y] = cell(&sources[i].at);
            let around = (-1..=1).flat_map(|u| (-1..=1).map(move |v| [x + u, y + v]));
            let mut near: Vec<usize> = around
                .filter_map(|c| grid.get(&c))
                .flatten()
                .copied()
                .filter(|&j| j != i && far(i, j) <= REACH)
                .collect();
            near.sort_by(|&a, &b| far(i, a).total_cmp(&far(i, b)).then(a.cmp(&b)));
            near.truncate(NEIGHBOURS);
            near
        })
        .collect()
}

/// Grows copies inside the shape.
fn fill(sources: &[Source], shape: &Shape, seed: u64) -> Vec<Copy> {
    let Some((low, high)) = shape.bounds() else {
        return Vec::new();
    };
    if sources.is_empty() {
        return Vec::new();
    }
    let mut rng = rng::stream(seed, "city synthesis", 0);
    let count = sources.iter().map(|s| s.kind + 1).max().unwrap_or(0);
    let mut kinds: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (i, s) in sources.iter().enumerate() {
        kinds[s.kind].push(i);
    }
    let mut used = vec![0usize; sources.len()];
    let mut ground = Occupancy::default();
    let mut copies: Vec<Copy> = Vec::new();
    let mut queue: VecDeque<usize> = VecDeque::new();
    let mut failed = 0;
    let mut classes = [0usize; AREAS * HEIGHTS];
    // Copies when all of them were last asked for neighbours.
    let mut asked = 0;
    let mut put =
        |copy: Copy, copies: &mut Vec<Copy>, used: &mut [usize], classes: &mut [usize]| {
            let source = &sources[copy.source];
            let share = copies.len() as f64 / classes.len() as f64;
            let fits = (classes[source.class] as f64) < AHEAD * share + MORE
                && ground.take(&source.footprint, copy.at, copy.turn, shape);
            if fits {
                classes[source.class] += 1;
                used[copy.source] += 1;
                copies.push(copy);
            }
            fits
        };
    loop {
        let least = used.iter().copied().min().unwrap_or(0);
        let Some(i) = queue.pop_front() else {
            if copies.len() > asked {
                // Classes that had run ahead may have room now.
                asked = copies.len();
                queue.extend(0..copies.len());
                continue;
            }
            if failed >= TRIES {
                return copies;
            }
            // Of the class that is most behind, a building copied least, at a chance place, turned as it is in its city.
            let behind = |s: &usize| classes[sources[*s].class];
            let fewest = (0..sources.len()).map(|s| behind(&s)).min().unwrap_or(0);
            let own = (0..sources.len()).filter(|s| behind(s) == fewest);
            let least = own.clone().map(|s| used[s]).min().unwrap_or(0);
            let rare: Vec<usize> = own.filter(|&s| used[s] == least).collect();
            let source = rare[rng.random_range(0..rare.len())];
            let at = [0, 1].map(|k| low[k] + rng.random::<f64>() * (high[k] - low[k]));
            let turn = sources[source].turn;
            let copy = Copy { source, at, turn };
            if put(copy, &mut copies, &mut used, &mut classes) {
                failed = 0;
                queue.push_back(copies.len() - 1);
            } else {
                failed += 1;
            }
            continue;
        };
        let stands = copies[i];
        let mut like = stands.source;
        if rng.random::<f64>() < JUMP {
            let own = &kinds[sources[like].kind];
            let least = own.iter().map(|&s| used[s]).min().unwrap_or(0);
            let rare: Vec<usize> = own.iter().copied().filter(|&s| used[s] == least).collect();
            like = rare[rng.random_range(0..rare.len())];
        }
        let from = &sources[like];
        let turn = stands.turn - from.turn;
        for &n in &from.near {
            let next = &sources[n];
            if used[n] > least + SPREAD {
                continue;
            }
            let shift = rotated([next.at[0] - from.at[0], next.at[1] - from.at[1]], turn);
            let copy = Copy {
                source: n,
                at: [stands.at[0] + shift[0], stands.at[1] + shift[1]],
                turn: next.turn + turn,
            };
            if put(copy, &mut copies, &mut used, &mut classes) {
                queue.push_back(copies.len() - 1);
            }
        }
    }
}

/// A vector turned by degrees.
fn rotated([x, y]: [f64; 2], degrees: f64) -> [f64; 2] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [x * cos - y * sin, x * sin + y * cos]
}
