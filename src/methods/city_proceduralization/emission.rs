//! From types to a grammar (Eq. 5 to 7).

use rustc_hash::FxHashMap;

use super::components::Component;
use super::parse_tree::ParseTree;
use super::types::Types;
use crate::grammar::instance::{InstanceGrammar, InstanceRule, Placement, Template};
use crate::shape::triangles::{City, TriangleMesh, merge_coplanar};

/// Lengths are written in steps of 1 cm.
const LENGTH: f64 = 100.0;
/// Turns are written in steps of 0.01 degrees.
const ANGLE: f64 = 100.0;
/// Coordinates of templates take 12 bits.
pub const TEMPLATE_STEPS: f64 = 4095.0;
/// Coplanar triangles of a template are joined within this share of its box.
const COPLANAR: f64 = 1e-3;
/// Axiom of the grammar.
pub const AXIOM: &str = "City";

/// The grammar of `paper`: the rules of the parse tree, its top under the axiom.
pub fn emit_tree(
    city: &City,
    components: &[Component],
    types: &Types,
    tree: &ParseTree,
) -> InstanceGrammar {
    let mut grammar = terminals(city, components, types, false);
    grammar.rules.push(InstanceRule {
        symbol: AXIOM.to_owned(),
        weight: 1.0,
        successors: tree.top.clone(),
    });
    grammar.rules.extend(tree.rules.iter().cloned());
    grammar
}

/// The components as placed terminals, each with its building's identifier, for the parse tree.
pub fn placed_components(
    city: &City,
    components: &[Component],
    types: &Types,
) -> Vec<(usize, [f64; 3], Placement)> {
    let one = |(i, c): (usize, &Component)| {
        let mut placed = part(i, c, types, &Frame::WORLD);
        let building = &city.buildings[c.building];
        placed.id = Some(building.id.clone());
        if i == 0 || components[i - 1].building != c.building {
            placed.attributes = building.attributes.clone();
        }
        (types.uses[i].kind, c.frame.middle(), placed)
    };
    components.iter().enumerate().map(one).collect()
}

fn terminals(city: &City, components: &[Component], types: &Types, merge: bool) -> InstanceGrammar {
    let templates = types.representatives.iter().enumerate();
    let template = |(kind, &c): (usize, &usize)| Template {
        symbol: terminal(kind),
        mesh: template(&components[c].mesh, merge),
    };
    InstanceGrammar {
        name: city.name.clone(),
        reference_system: city.reference_system.clone(),
        origin: city.origin,
        axiom: AXIOM.to_owned(),
        templates: templates.map(template).collect(),
        rules: Vec::new(),
    }
}

/// The grammar of `best`: a terminal for each type, a non-terminal for each arrangement of parts that buildings
/// have, the buildings in their places under the axiom, and the rules of the parse tree as patterns: the axiom
/// does not lead to them, synthesis draws from them.
pub fn emit(
    city: &City,
    components: &[Component],
    types: &Types,
    patterns: &ParseTree,
) -> InstanceGrammar {
    let mut grammar = terminals(city, components, types, true);
    let mut start = InstanceRule {
        symbol: AXIOM.to_owned(),
        weight: 1.0,
        successors: Vec::new(),
    };
    let mut known: FxHashMap<String, usize> = FxHashMap::default();
    let indexed: Vec<(usize, &Component)> = components.iter().enumerate().collect();
    for parts in indexed.chunk_by(|a, b| a.1.building == b.1.building) {
        let building = &city.buildings[parts[0].1.building];
        let mut placed = match parts {
            [(i, only)] => part(*i, only, types, &Frame::WORLD),
            _ => {
                let frame = Frame::of(parts[0].0, parts[0].1, types);
                let parts = parts.iter().map(|(i, c)| part(*i, c, types, &frame));
                let successors: Vec<Placement> = parts.collect();
                let key = format!("{successors:?}");
                let rule = *known.entry(key).or_insert_with(|| {
                    grammar.rules.push(InstanceRule {
                        symbol: format!("B{}", grammar.rules.len() + 1),
                        weight: 0.0,
                        successors,
                    });
                    grammar.rules.len() - 1
                });
                grammar.rules[rule].weight += 1.0;
                let symbol = grammar.rules[rule].symbol.clone();
                Placement::new(symbol, frame.at, frame.turn, [1.0; 3])
            }
        };
        placed.id = Some(building.id.clone());
        placed.attributes = building.attributes.clone();
        start.successors.push(placed);
    }
    grammar.rules.insert(0, start);
    grammar.rules.extend(patterns.rules.iter().cloned());
    grammar
}

/// Symbol of a type.
pub fn terminal(kind: usize) -> String {
    format!("T{}", kind + 1)
}

/// The frame of a building: its lowest component's.
struct Frame {
    at: [f64; 3],
    turn: f64,
}

impl Frame {
    const WORLD: Self = Self {
        at: [0.0; 3],
        turn: 0.0,
    };

    fn of(index: usize, component: &Component, types: &Types) -> Self {
        let placed = part(index, component, types, &Self::WORLD);
        Self {
            at: placed.at,
            turn: placed.turn,
        }
    }
}

/// The template that stands for a component, in a frame: box to box, with the turn of its type.
fn part(index: usize, component: &Component, types: &Types, frame: &Frame) -> Placement {
    let used = types.uses[index];
    let [w, d, h] = component.frame.size;
    let size = if used.quarter.is_multiple_of(2) {
        [w, d, h]
    } else {
        [d, w, h]
    };
    let turn = component.frame.angle.to_degrees() + 90.0 * f64::from(used.quarter);
    let shift = [0, 1, 2].map(|k| component.frame.base[k] - frame.at[k]);
    let (sin, cos) = frame.turn.to_radians().sin_cos();
    let at = [
        shift[0] * cos + shift[1] * sin,
        shift[1] * cos - shift[0] * sin,
        shift[2],
    ];
    let round = |v: f64| (v * LENGTH).round() / LENGTH;
    let turn = ((turn - frame.turn).rem_euclid(360.0) * ANGLE).round() / ANGLE;
    Placement::new(
        terminal(used.kind),
        at.map(|v| round(v) + 0.0),
        if turn >= 360.0 { 0.0 } else { turn },
        size.map(|v| round(v).max(1.0 / LENGTH)),
    )
}

/// A representative's mesh: coplanar triangles merged, coordinates on 12 bits.
fn template(unit: &TriangleMesh, merge: bool) -> TriangleMesh {
    let mesh = if merge {
        merge_coplanar(unit, COPLANAR)
    } else {
        unit.clone()
    };
    let grid = |v: f64| (v * TEMPLATE_STEPS).round() / TEMPLATE_STEPS;
    let snapped = mesh
        .positions
        .iter()
        .map(|p| [grid(p[0] + 0.5) - 0.5, grid(p[1] + 0.5) - 0.5, grid(p[2])]);
    TriangleMesh {
        positions: snapped.collect(),
        triangles: mesh.triangles,
    }
    .welded(0.5 / TEMPLATE_STEPS)
}
