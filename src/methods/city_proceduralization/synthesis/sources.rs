//! The buildings that a new city is made of: those of the grammar's city.

use super::super::morphology::{CityPlan, Neighbourhood, under_larger};
use super::footprint::{Footprint, footprint, open_ground};
use edifice_grammar::instance::{
    InstanceGrammar, InstanceGrammarError, Placement, TemplateInstance,
};
use edifice_shape::triangles::{City, CityBuilding, TriangleMesh, normal};

/// The normals of walls are so many times as long in the plan as upright.
const STEEP: f64 = 5.0;
/// Buildings that stand nearer to each other, in metres, are copied together: what is wider is a street.
const NEAR: f64 = 8.0;
/// No building reaches farther in the plan, in metres.
const LARGEST: f64 = 5000.0;
/// The share of all plans that larger buildings may cover as well; beyond it, buildings that overlap with larger ones are left out.
const UNDER: f64 = 0.0075;
/// A building that larger ones cover by this share of its plan at least stands within their walls, as a tower on its base does.
const WITHIN: f64 = 0.95;
/// No building stands farther from the origin, in metres: beyond, cells of the plan are not told apart any more.
const FARTHEST: f64 = 1e9;

/// A building of the grammar's city, to be copied.
pub(super) struct Source {
    /// The placements under the axiom: one symbol, or the templates of a building.
    pub(super) placed: Vec<Placement>,
    pub(super) at: [f64; 3],
    pub(super) turn: f64,
    /// In metres.
    pub(super) height: f64,
    /// The middle of its plan, in its frame.
    pub(super) middle: [f64; 2],
    /// The direction of its walls: the sum of area · exp(4iφ) over walls whose normals have direction φ, so that walls at right angles agree.
    pub(super) walls: [f64; 2],
    pub(super) footprint: Footprint,
    /// Its place in the city; `None` without triangles.
    pub(super) neighbourhood: Option<Neighbourhood>,
}

/// The buildings of the grammar's city, and the pairs of them that stand near each other ([`NEAR`]).
pub(super) fn sources(
    grammar: &InstanceGrammar,
) -> Result<(Vec<Source>, Vec<[usize; 2]>), InstanceGrammarError> {
    let derivation = grammar.derive()?;
    let mut parts: Vec<Vec<&TemplateInstance>> = vec![Vec::new(); derivation.buildings.len()];
    for instance in &derivation.instances {
        if let Some(b) = instance.building {
            parts[b].push(instance);
        }
    }
    // What stands right under the axiom is copied as it is, with its rule.
    let flat = grammar.flat(None);
    let mut whole = rustc_hash::FxHashMap::default();
    for s in flat.top().into_iter().flat_map(|r| &r.successors) {
        if let Some(id) = &s.id {
            whole.entry(id.as_str()).or_insert_with(Vec::new).push(s);
        }
    }
    let mut out = Vec::new();
    let mut city = City::default();
    for ((id, _), parts) in derivation.buildings.iter().zip(&parts) {
        let Some(first) = parts.first() else { continue };
        let placed: Vec<Placement> = match whole.get(id.as_str()) {
            Some(list) => list.iter().map(|p| (*p).clone()).collect(),
            None => parts.iter().map(|i| terminal(grammar, i)).collect(),
        };
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
        let height = mesh.bounds().map_or(0.0, |(low, high)| high[2] - low[2]);
        let (at, turn) = (first.at, placed.first().map_or(0.0, |p| p.turn));
        let footprint = footprint(&mesh, at, turn);
        out.push(Source {
            placed,
            at,
            turn,
            height,
            walls: walls(&mesh),
            middle: footprint.middle(),
            footprint,
            neighbourhood: None,
        });
        city.buildings.push(CityBuilding {
            mesh,
            ..CityBuilding::default()
        });
    }
    let stands = standing(&out, &under_larger(&city));
    let mut each = stands.iter();
    out.retain(|_| each.next().is_some_and(|s| *s));
    let mut each = stands.iter();
    city.buildings.retain(|_| each.next().is_some_and(|s| *s));
    let plan = CityPlan::new(&city);
    for (i, neighbourhood) in plan.neighbourhoods() {
        out[i].neighbourhood = Some(neighbourhood);
    }
    let frames: Vec<([f64; 3], f64)> = out.iter().map(|s| (s.at, s.turn)).collect();
    let prints: Vec<&Footprint> = out.iter().map(|s| &s.footprint).collect();
    let open = open_ground(&prints, &frames);
    for (source, open) in out.iter_mut().zip(open) {
        source.footprint.open = open;
    }
    Ok((out, plan.pairs_within(NEAR)))
}

/// True for each building that is copied. Those are left out that have most ground under larger ones for their share of the buildings and
/// of the plan, until such ground is at most [`UNDER`] of the plan.
fn standing(buildings: &[Source], under: &[f64]) -> Vec<bool> {
    let area = |i: usize| buildings[i].footprint.points() as f64;
    let all: f64 = (0..buildings.len()).map(area).sum();
    let loss = |i: usize| 1.0 / buildings.len() as f64 + area(i) / all;
    let overlaps = |&i: &usize| under[i] > 0.0 && under[i] < WITHIN;
    let mut order: Vec<usize> = (0..buildings.len()).filter(overlaps).collect();
    let worth = |i: usize| under[i] * area(i) / loss(i);
    order.sort_by(|&a, &b| worth(b).total_cmp(&worth(a)));
    let mut stands = vec![true; buildings.len()];
    let mut covered: f64 = order.iter().map(|&i| under[i] * area(i)).sum();
    let mut left = all;
    for i in order {
        if covered <= UNDER * left {
            break;
        }
        covered -= under[i] * area(i);
        left -= area(i);
        stands[i] = false;
    }
    stands
}

/// The direction of the walls of a mesh (see [`Source::walls`]).
fn walls(mesh: &TriangleMesh) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for t in mesh.corners() {
        let n = normal(&t);
        let flat = n[0].hypot(n[1]);
        // Roofs may be steep; walls are steeper.
        if flat > STEEP * n[2].abs() {
            let (sin, cos) = (4.0 * n[1].atan2(n[0])).sin_cos();
            sum = [sum[0] + flat * cos, sum[1] + flat * sin];
        }
    }
    sum
}

fn terminal(grammar: &InstanceGrammar, i: &TemplateInstance) -> Placement {
    let symbol = grammar.templates[i.template].symbol.clone();
    Placement::new(symbol, i.at, i.turn, i.size)
}
