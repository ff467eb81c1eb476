//! From types to a grammar (Eq. 5 to 7).

use std::collections::BTreeMap;

use super::building_types::BuildingTypes;
use super::components::Component;
use super::parse_tree::ParseTree;
use super::types::Types;
use edifice_grammar::instance::{
    InstanceGrammar, InstanceRule, Placement, Posed, Repeated, Template,
};
use edifice_shape::triangles::{City, TriangleMesh, box_view, merge_coplanar};

/// The precision in which the numbers of a grammar are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Detail {
    /// Steps of lengths in a metre.
    length: f64,
    /// Steps of turns in a degree.
    angle: f64,
    /// Steps of a template's box.
    box_steps: f64,
    /// Coplanar triangles of a template are joined within this share of its box.
    coplanar: f64,
}

impl Detail {
    /// Centimetres, hundredths of degrees, 12 bits: where templates stand for others, nothing finer is seen.
    pub(super) const CENTIMETRE: Self = Self {
        length: 100.0,
        angle: 100.0,
        box_steps: 4095.0,
        coplanar: 1e-3,
    };
    /// Millimetres, ten-thousandths of degrees, 16 bits: where each component has its own template.
    pub(super) const MILLIMETRE: Self = Self {
        length: 1000.0,
        angle: 10_000.0,
        box_steps: 65_535.0,
        coplanar: 2e-5,
    };
    /// Decimetres, half degrees, 7 bits: where few bytes count.
    pub(super) const DECIMETRE: Self = Self {
        length: 10.0,
        angle: 2.0,
        box_steps: 127.0,
        coplanar: 4e-3,
    };
}

/// Axiom of the grammar.
pub const AXIOM: &str = "City";

/// The grammar of `paper`: the rules of the parse tree, its top under the axiom.
pub(super) fn emit_tree(
    city: &City,
    components: &[Component],
    types: &Types,
    tree: &ParseTree,
) -> InstanceGrammar {
    let mut grammar = terminals(city, components, types, &Detail::CENTIMETRE, false);
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
        let mut placed = part(i, c, types, &Frame::world(), &Detail::CENTIMETRE);
        let building = &city.buildings[c.building];
        placed.id = Some(building.id.clone());
        if i == 0 || components[i - 1].building != c.building {
            placed.attributes = building.attributes.clone();
        }
        (types.uses[i].kind, c.frame.middle(), placed)
    };
    components.iter().enumerate().map(one).collect()
}

fn terminals(
    city: &City,
    components: &[Component],
    types: &Types,
    detail: &Detail,
    merge: bool,
) -> InstanceGrammar {
    let templates = types.representatives.iter().enumerate();
    let template = |(kind, &c): (usize, &usize)| Template {
        symbol: terminal(kind),
        mesh: template(&components[c], detail, merge),
        texture: components[c].texture.clone(),
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

/// The grammar of `best`: a terminal for each type of component, a non-terminal for each type of building, the buildings
/// in their places under the axiom, and the repeated arrangements of buildings as patterns: the axiom does not lead to them,
/// synthesis draws from them.
///
/// A building's rule has the mean transforms of its type; a building that differs from it by a centimetre
/// keeps its parts. A single component whose building has no like is a terminal at once.
pub(super) fn emit(
    city: &City,
    components: &[Component],
    types: &Types,
    buildings: &BuildingTypes,
    patterns: &[Repeated],
    detail: &Detail,
) -> InstanceGrammar {
    let mut grammar = terminals(city, components, types, detail, true);
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); buildings.count];
    for &b in &buildings.order {
        if let Some(l) = buildings.labels[b] {
            members[l].push(b);
        }
    }
    let mut start: Vec<(usize, Placement)> = Vec::new();
    for (label, list) in members.iter().enumerate() {
        let alone = list.len() == 1;
        if let ([b], [i]) = (&list[..], &buildings.parts[list[0]][..])
            && alone
        {
            start.push((
                *b,
                part(*i, &components[*i], types, &Frame::world(), detail),
            ));
            continue;
        }
        let symbol = building_symbol(label);
        let placed = |&b: &usize| {
            let frame = Frame::of(&components[buildings.parts[b][0]], &symbol, detail);
            let parts = buildings.parts[b].iter();
            let parts = parts.map(|&i| part(i, &components[i], types, &frame, detail));
            let parts: Vec<Placement> = parts.collect();
            (b, frame.placed, parts)
        };
        let placed: Vec<(usize, Placement, Vec<Placement>)> = list.iter().map(placed).collect();
        let mean: Vec<Placement> = (0..placed[0].2.len())
            .map(|k| mean_part(placed.iter().map(|p| &p.2[k]), detail))
            .collect();
        for (b, mut instance, parts) in placed {
            if parts != mean {
                instance.parts = parts.into_iter().map(Some).collect();
            }
            start.push((b, instance));
        }
        grammar.rules.push(InstanceRule {
            symbol,
            weight: list.len() as f64,
            successors: mean,
        });
    }
    start.sort_by_key(|s| s.0);
    let named = start.into_iter().map(|(b, mut placed)| {
        let building = &city.buildings[b];
        placed.id = Some(building.id.clone());
        placed.attributes = building.attributes.clone();
        placed
    });
    let axiom = InstanceRule {
        symbol: AXIOM.to_owned(),
        weight: 1.0,
        successors: named.collect(),
    };
    grammar.rules.insert(0, axiom);
    let patterns = patterns.iter().enumerate();
    grammar
        .rules
        .extend(patterns.map(|(i, p)| pattern(i, p, buildings.count)));
    grammar
}

/// The rule of a pattern, over `types` types of buildings.
fn pattern(index: usize, pattern: &Repeated, types: usize) -> InstanceRule {
    let member = |m: &Posed| {
        let symbol = match m.kind.checked_sub(types) {
            Some(other) => pattern_symbol(other),
            None => building_symbol(m.kind),
        };
        rounded(
            Placement::new(symbol, m.at, m.turn, [1.0; 3]),
            &Detail::CENTIMETRE,
        )
    };
    InstanceRule {
        symbol: pattern_symbol(index),
        weight: pattern.count as f64,
        successors: pattern.members.iter().map(member).collect(),
    }
}

/// The template that most members have, at their mean transform.
fn mean_part<'a>(parts: impl Iterator<Item = &'a Placement>, detail: &Detail) -> Placement {
    let parts: Vec<&Placement> = parts.collect();
    let key = |p: &Placement| (p.symbol.clone(), (p.turn / 90.0).round() as i64 % 4);
    let mut counts: BTreeMap<(String, i64), usize> = BTreeMap::new();
    for p in &parts {
        *counts.entry(key(p)).or_default() += 1;
    }
    let most = counts.iter().max_by(|a, b| a.1.cmp(b.1).then(b.0.cmp(a.0)));
    let most = most.map(|m| m.0.clone()).unwrap_or_default();
    let own: Vec<&Placement> = parts.into_iter().filter(|p| key(p) == most).collect();
    let n = own.len() as f64;
    let mean = |f: &dyn Fn(&Placement) -> f64| own.iter().map(|p| f(p)).sum::<f64>() / n;
    let sin = mean(&|p| p.turn.to_radians().sin());
    let cos = mean(&|p| p.turn.to_radians().cos());
    let mean = Placement::new(
        most.0,
        [0, 1, 2].map(|k| mean(&|p| p.at[k])),
        sin.atan2(cos).to_degrees(),
        [0, 1, 2].map(|k| mean(&|p| p.size[k])),
    );
    rounded(mean, detail)
}

/// Symbol of a type of buildings.
pub fn building_symbol(label: usize) -> String {
    format!("B{}", label + 1)
}

/// Symbol of a pattern.
fn pattern_symbol(index: usize) -> String {
    format!("P{}", index + 1)
}

/// Symbol of a type.
pub fn terminal(kind: usize) -> String {
    format!("T{}", kind + 1)
}

/// The frame of a building: its lowest component's. Parts stand where they do relative to `base` and `turn`, the frame before
/// it is rounded, so that like buildings have like parts wherever they are; `placed` is the frame as it is written.
struct Frame {
    base: [f64; 3],
    turn: f64,
    placed: Placement,
}

impl Frame {
    fn world() -> Self {
        Self {
            base: [0.0; 3],
            turn: 0.0,
            placed: Placement::new("", [0.0; 3], 0.0, [1.0; 3]),
        }
    }

    fn of(component: &Component, symbol: &str, detail: &Detail) -> Self {
        let (base, turn) = (component.frame.base, component.frame.angle.to_degrees());
        Self {
            base,
            turn,
            placed: rounded(Placement::new(symbol, base, turn, [1.0; 3]), detail),
        }
    }
}

/// Lengths and turns in steps, turns from 0 to 360 degrees.
fn rounded(mut placed: Placement, detail: &Detail) -> Placement {
    let round = |v: f64| (v * detail.length).round() / detail.length;
    placed.at = placed.at.map(|v| round(v) + 0.0);
    placed.size = placed.size.map(|v| round(v).max(1.0 / detail.length));
    let turn = (placed.turn.rem_euclid(360.0) * detail.angle).round() / detail.angle;
    placed.turn = if turn >= 360.0 { 0.0 } else { turn };
    placed
}

/// The template that stands for a component, in a frame: box to box, with the turn of its type.
fn part(
    index: usize,
    component: &Component,
    types: &Types,
    frame: &Frame,
    detail: &Detail,
) -> Placement {
    let used = types.uses[index];
    let [w, d, h] = component.frame.size;
    let size = if used.quarter.is_multiple_of(2) {
        [w, d, h]
    } else {
        [d, w, h]
    };
    let turn = component.frame.angle.to_degrees() + 90.0 * f64::from(used.quarter);
    let shift = [0, 1, 2].map(|k| component.frame.base[k] - frame.base[k]);
    let (sin, cos) = frame.turn.to_radians().sin_cos();
    let at = [
        shift[0] * cos + shift[1] * sin,
        shift[1] * cos - shift[0] * sin,
        shift[2],
    ];
    rounded(
        Placement::new(terminal(used.kind), at, turn - frame.turn, size),
        detail,
    )
}

/// A representative's mesh: coplanar triangles merged, coordinates in steps of the box. Where it shows textures, its triangles
/// follow each other side by side.
fn template(component: &Component, detail: &Detail, merge: bool) -> TriangleMesh {
    // A stated template was merged when it was made.
    let mut mesh = match merge && component.stated.is_none() {
        true => merge_coplanar(&component.mesh, detail.coplanar),
        false => component.mesh.clone(),
    };
    let grid = |v: f64| (v * detail.box_steps).round() / detail.box_steps;
    for p in &mut mesh.positions {
        *p = [grid(p[0] + 0.5) - 0.5, grid(p[1] + 0.5) - 0.5, grid(p[2])];
    }
    if component.texture.is_some() || !component.looks.is_empty() {
        let positions = &mesh.positions;
        let view = |t: &[u32; 3]| box_view(t.map(|i| positions[i as usize]));
        mesh.triangles.sort_by_key(view);
    }
    mesh.welded(0.5 / detail.box_steps)
}
