//! The buildings that a new city is made of: those of the grammar's city, with what stands near them.

use super::super::localization::{Landmark, landmark};
use super::occupancy::{Footprint, footprint, open_ground};
use edifice_grammar::instance::{
    InstanceGrammar, InstanceGrammarError, Placement, TemplateInstance,
};
use edifice_shape::triangles::TriangleMesh;

/// Neighbours of a building are no farther from it, in metres,
const REACH: f64 = 80.0;
/// and so many at most.
const NEIGHBOURS: usize = 10;
/// Classes by plan area,
pub(super) const AREAS: usize = 16;
/// and in each by height.
pub(super) const HEIGHTS: usize = 2;

/// No building reaches farther in the plan, in metres.
const LARGEST: f64 = 5000.0;

/// No building stands farther from the origin, in metres: beyond, cells of the plan are not told apart any more.
const FARTHEST: f64 = 1e9;

/// A building of the grammar's city, to be copied.
pub(super) struct Source {
    /// The placements under the axiom: one symbol, or the templates of a building.
    pub(super) placed: Vec<Placement>,
    pub(super) kind: usize,
    /// Class of plan area and height.
    pub(super) class: usize,
    pub(super) at: [f64; 3],
    pub(super) turn: f64,
    /// As it stands in the grammar's city.
    pub(super) looks: Landmark,
    pub(super) footprint: Footprint,
    /// Other sources near it, the nearest first.
    pub(super) near: Vec<usize>,
}

/// The buildings of the grammar's city.
pub(super) fn sources(grammar: &InstanceGrammar) -> Result<Vec<Source>, InstanceGrammarError> {
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
        if let Some((low, high)) = mesh.bounds() {
            let far = (0..2).map(|k| low[k].abs().max(high[k].abs()));
            let far = far.fold(0.0, f64::max);
            if far > FARTHEST {
                return Err(InstanceGrammarError::Number {
                    place: format!("building {id:?}"),
                    what: "coordinate of a building that is to be copied, in metres",
                    value: far,
                });
            }
            let extent = (high[0] - low[0]).max(high[1] - low[1]);
            if extent > LARGEST {
                return Err(InstanceGrammarError::Number {
                    place: format!("building {id:?}"),
                    what: "extent of a building that is to be copied, in metres",
                    value: extent,
                });
            }
        }
        let Some(looks) = landmark(&mesh) else {
            continue;
        };
        let (at, turn) = (first.at, placed.first().map_or(0.0, |p| p.turn));
        out.push(Source {
            placed,
            kind,
            class: 0,
            at,
            turn,
            looks,
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
            let height = |s: usize| sources[s].looks.seen.height;
            height(i).total_cmp(&height(j)).then(i.cmp(&j))
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
