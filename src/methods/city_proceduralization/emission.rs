//! From types to a grammar (Eq. 5 to 7).

use super::building_types::BuildingTypes;
use super::component::Component;
use super::detail::Detail;
use super::parse_tree::ParseTree;
use super::rulebook::{RuleUse, Rulebook};
use super::types::Types;
use edifice_grammar::instance::{
    InstanceGrammar, InstanceRule, Placement, Posed, Repeated, Template,
};
use edifice_shape::triangles::{City, TriangleMesh, box_view, merge_coplanar};
use rustc_hash::FxHashMap;

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
    grammar
        .rules
        .push(InstanceRule::new(AXIOM, 1.0, tree.top.clone()));
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

pub(super) fn terminals(
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

/// The findings that the grammar of `best` is made from.
pub(super) struct Found<'a> {
    pub(super) city: &'a City,
    pub(super) components: &'a [Component],
    pub(super) types: &'a Types,
    pub(super) buildings: &'a BuildingTypes,
    pub(super) rulebook: &'a Rulebook,
    pub(super) patterns: &'a [Repeated],
}

/// The grammar of `best`: a terminal for each type of component, a non-terminal with parameters for each type of building
/// ([`Rulebook`]; `B1`, ..., and `E1`, ... for escapes, which have one instance), the buildings in their places under the axiom, and the
/// repeated arrangements of buildings as patterns: the axiom does not lead to them, synthesis draws from them.
///
/// A building's parts stand where its rule puts them; one that differs from it by more than a step, or by anything
/// where the grammar is to be `exact`, keeps its parts as a residual.
pub(super) fn emit(found: &Found, detail: &Detail, exact: bool) -> InstanceGrammar {
    emit_rules(found, named_rules(found, 0, BUILDING), detail, exact)
}

/// Beginnings of the symbols of types of buildings, and of escapes.
const BUILDING: [&str; 2] = ["B", "E"];

/// The rules of the rulebook from the number `first` on, named.
pub(super) fn named_rules(found: &Found, first: usize, names: [&str; 2]) -> Vec<InstanceRule> {
    let (rulebook, mut numbers) = (found.rulebook, [0usize; 2]);
    let mut counts = vec![0usize; rulebook.rules.len()];
    for used in rulebook.uses.iter().flatten() {
        counts[used.rule] += 1;
    }
    let own = rulebook.rules.iter().zip(&counts).skip(first);
    let named = own.map(|(&building, &count)| {
        let escape = usize::from(count == 1);
        numbers[escape] += 1;
        let parts = &found.buildings.parts[building];
        let mut rule = rule_of(found.components, parts, found.types);
        rule.symbol = format!("{}{}", names[escape], numbers[escape]);
        rule.weight = count as f64;
        rule
    });
    named.collect()
}

/// The grammar of `best` with these `rules`, those of the rulebook.
pub(super) fn emit_rules(
    found: &Found,
    rules: Vec<InstanceRule>,
    detail: &Detail,
    exact: bool,
) -> InstanceGrammar {
    let Found {
        city,
        components,
        types,
        buildings,
        rulebook,
        patterns,
    } = *found;
    let mut grammar = terminals(city, components, types, detail, true);
    let mut successors = Vec::new();
    let step = if exact { 0.0 } else { 1.0 / detail.length };
    for building in 0..city.buildings.len() {
        let Some(used) = rulebook.uses[building] else {
            continue;
        };
        let rule = &rules[used.rule];
        let list = &buildings.parts[building];
        let (frame, mut placed) = instance(components, list, used, rule, detail);
        let part = |&i: &usize| part(i, &components[i], types, &frame, detail);
        let own: Vec<Placement> = list.iter().map(part).collect();
        let computed = |k: usize| rule.part(k, &placed.numbers);
        if !(0..own.len()).all(|k| like(&own[k], &computed(k), step)) {
            placed.parts = own.into_iter().map(Some).collect();
        }
        placed.id = Some(city.buildings[building].id.clone());
        placed.attributes = city.buildings[building].attributes.clone();
        successors.push(placed);
    }
    // The type of a pattern's member is told by the first building of its kind.
    let member = |m: &Posed| match m.kind.checked_sub(buildings.count) {
        Some(other) => Some(Placement::new(
            pattern_symbol(other),
            m.at,
            m.turn,
            [1.0; 3],
        )),
        None => {
            let of_kind = |b: &&usize| buildings.labels[**b] == Some(m.kind);
            let building = *buildings.order.iter().find(of_kind)?;
            let used = rulebook.uses[building]?;
            let list = &buildings.parts[building];
            let (_, mut placed) = instance(components, list, used, &rules[used.rule], detail);
            placed.at = m.at;
            placed.turn = m.turn + 90.0 * f64::from(used.quarter);
            Some(placed)
        }
    };
    let pattern = |(i, p): (usize, &Repeated)| {
        let members = p.members.iter().filter_map(member);
        let members = members.map(|m| rounded(m, &Detail::CENTIMETRE));
        InstanceRule::new(pattern_symbol(i), p.count as f64, members.collect())
    };
    let patterns: Vec<InstanceRule> = patterns.iter().enumerate().map(pattern).collect();
    grammar
        .rules
        .push(InstanceRule::new(AXIOM, 1.0, successors));
    grammar.rules.extend(rules);
    grammar.rules.extend(patterns);
    grammar
}

/// Triangles of the city that the grammar of [`emit`] derives.
pub(super) fn derived_triangles(grammar: &InstanceGrammar) -> usize {
    let templates = grammar.templates.iter();
    let of_template: FxHashMap<&str, usize> = templates
        .map(|t| (t.symbol.as_str(), t.mesh.triangles.len()))
        .collect();
    let of_part = |p: &Placement| of_template.get(p.symbol.as_str()).copied().unwrap_or(0);
    let rules = grammar.rules.iter();
    let of_rule: FxHashMap<&str, usize> = rules
        .map(|r| (r.symbol.as_str(), r.successors.iter().map(of_part).sum()))
        .collect();
    let top = grammar.rules.iter().filter(|r| r.symbol == AXIOM);
    let of_building = |b: &Placement| match b.parts.is_empty() {
        true => of_rule.get(b.symbol.as_str()).copied().unwrap_or(0),
        false => b.parts.iter().flatten().map(of_part).sum(),
    };
    top.flat_map(|r| &r.successors).map(of_building).sum()
}

/// Steps of a share: what the compact file writes.
const SHARES: f64 = 1024.0;

/// The rule that is made from a building: its components' templates, in shares of the box of the lowest and in levels.
fn rule_of(components: &[Component], parts: &[usize], types: &Types) -> InstanceRule {
    let base = &components[parts[0]];
    let [w, d, _] = base.frame.size;
    let frame = Frame::of(base, 0);
    let share = |v: f64| (v * SHARES).round() / SHARES + 0.0;
    let least = |v: f64| share(v).max(1.0 / SHARES);
    let one = |(level, &i): (usize, &usize)| {
        let mut placed = part(i, &components[i], types, &frame, &Detail::MILLIMETRE);
        let (sin, cos) = placed.turn.to_radians().sin_cos();
        let along = (w * cos).hypot(d * sin);
        let across = (w * sin).hypot(d * cos);
        placed.at = [
            share(placed.at[0] / w),
            share(placed.at[1] / d),
            level as f64,
        ];
        placed.size = [
            least(placed.size[0] / along),
            least(placed.size[1] / across),
            1.0,
        ];
        placed.turn = (placed.turn * TURNS).round() / TURNS % 360.0;
        placed
    };
    let successors = parts.iter().enumerate().map(one).collect();
    InstanceRule {
        levels: parts.len(),
        ..InstanceRule::new("", 1.0, successors)
    }
}

/// Steps of a degree of turns in rules.
const TURNS: f64 = 2.0;

/// A building as an instance of a rule: its frame, and where it is, with its numbers.
pub(super) fn instance(
    components: &[Component],
    parts: &[usize],
    used: RuleUse,
    rule: &InstanceRule,
    detail: &Detail,
) -> (Frame, Placement) {
    let frame = Frame::of(&components[parts[0]], used.quarter);
    let placed = Placement::new(rule.symbol.as_str(), frame.base, frame.turn, [1.0; 3]);
    let mut placed = rounded(placed, detail);
    let [w, d, _] = components[parts[0]].frame.size;
    let mut size = [w, d];
    if !used.quarter.is_multiple_of(2) {
        size.swap(0, 1);
    }
    let round = |v: f64| (v * detail.length).round() / detail.length;
    let least = |v: f64| round(v).max(1.0 / detail.length);
    placed.numbers = size.map(least).to_vec();
    let (mut below, last) = (0.0, parts.len() - 1);
    for (k, &i) in parts.iter().enumerate() {
        let top = match k == last {
            true => components[i].frame.base[2] + components[i].frame.size[2],
            false => components[parts[k + 1]].frame.base[2],
        };
        let top = round(top - frame.base[2]);
        let height = least(top - below);
        placed.numbers.push(height);
        below = round(below + height);
    }
    (frame, placed)
}

/// True if a part is where the rule puts it, within `step` metres and a step of its turn.
fn like(own: &Placement, computed: &Placement, step: f64) -> bool {
    let apart = (own.turn - computed.turn + 180.0).rem_euclid(360.0) - 180.0;
    let turn = if step > 0.0 { 1.0 / TURNS } else { 0.0 };
    let near =
        |a: &[f64; 3], b: &[f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() <= step * 1.001 + 1e-9);
    own.symbol == computed.symbol
        && apart.abs() <= turn + 1e-9
        && near(&own.at, &computed.at)
        && near(&own.size, &computed.size)
}

/// Symbol of a pattern.
fn pattern_symbol(index: usize) -> String {
    format!("P{}", index + 1)
}

/// Symbol of a type.
pub fn terminal(kind: usize) -> String {
    format!("T{}", kind + 1)
}

/// The frame of a building: that of its lowest component. Parts stand where they do relative to it before it is rounded, so that like
/// buildings have like parts wherever they are.
pub(super) struct Frame {
    base: [f64; 3],
    /// Degrees.
    turn: f64,
}

impl Frame {
    fn world() -> Self {
        Self {
            base: [0.0; 3],
            turn: 0.0,
        }
    }

    /// Turned by quarters.
    fn of(component: &Component, quarter: u8) -> Self {
        Self {
            base: component.frame.base,
            turn: component.frame.angle.to_degrees() + 90.0 * f64::from(quarter),
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
    let merged = |mesh: TriangleMesh| match merge && component.stated.is_none() {
        true => merge_coplanar(&mesh, detail.coplanar),
        false => mesh,
    };
    let grid = |v: f64| (v * detail.box_steps).round() / detail.box_steps;
    let on_grid = |[x, y, z]: [f64; 3]| [grid(x + 0.5) - 0.5, grid(y + 0.5) - 0.5, grid(z)];
    let mut mesh = merged(component.mesh.clone());
    mesh.positions.iter_mut().for_each(|p| *p = on_grid(*p));
    // Levels that lay apart by less than a step lie in one plane now.
    let step = 0.5 / detail.box_steps;
    let mut mesh = merged(mesh.welded(step));
    if component.texture.is_some() || !component.looks.is_empty() {
        let positions = &mesh.positions;
        let view = |t: &[u32; 3]| box_view(t.map(|i| positions[i as usize]));
        mesh.triangles.sort_by_key(view);
    }
    mesh.welded(step)
}
