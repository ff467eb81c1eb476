//! Types with what they stand for, as a city grammar of examples.

use edifice_grammar::instance::{InstanceGrammar, InstanceRule, Placement};
use edifice_shape::triangles::OrientedBox;

use crate::component::Component;
use crate::detail::Detail;
use crate::emission::{AXIOM, Found, instance, named_rules, terminals};
use crate::rulebook::RuleUse;
use edifice_shape::triangles::City;

/// A number of things and their volume.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Stands {
    /// The number of components that a template stands for.
    pub count: f64,
    /// Their volume, in cubic metres.
    pub volume: f64,
}

/// Types and what they stand for. The weight of a rule is the number of buildings that it stands for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sample {
    /// Templates, rules of buildings, and under the axiom an example of each rule, in the order of the rules.
    pub grammar: InstanceGrammar,
    /// The components that each template stands for.
    pub stands: Vec<Stands>,
    /// Components of the tiles that it was made from.
    pub components: usize,
}

impl Sample {
    /// The rules of buildings of a sample's grammar.
    pub fn rules(grammar: &InstanceGrammar) -> Vec<&InstanceRule> {
        let rules = grammar.rules.iter();
        rules.filter(|r| r.symbol != grammar.axiom).collect()
    }

    /// The sample of findings, of which each rule has an example: the building that it is made from. `weights`: the buildings that
    /// each rule stands for.
    pub(super) fn of(found: &Found, stands: Vec<Stands>, weights: &[f64], detail: &Detail) -> Self {
        let mut grammar = terminals(found.city, found.components, found.types, detail, true);
        let mut rules = named_rules(found, 0, ["B", "B"]);
        let (mut examples, mut along) = (Vec::new(), 0.0);
        for (k, (rule, &building)) in rules.iter_mut().zip(&found.rulebook.rules).enumerate() {
            rule.symbol = format!("B{}", k + 1);
            rule.weight = weights[k];
            let parts = &found.buildings.parts[building];
            let used = RuleUse {
                rule: k,
                quarter: 0,
            };
            let (_, mut example) = instance(found.components, parts, used, rule, detail);
            let width = example.numbers[0];
            (example.at, example.turn) = ([along, 0.0, 0.0], 0.0);
            // Whole metres lie on any step.
            along += (width + GAP).ceil();
            examples.push(example);
        }
        grammar.origin = [0.0; 3];
        let axiom = InstanceRule::new(AXIOM, 1.0, examples);
        grammar.rules = std::iter::once(axiom).chain(rules).collect();
        Self {
            grammar,
            stands,
            components: found.components.len(),
        }
    }
}

/// Metres between examples.
const GAP: f64 = 5.0;

/// The templates of a grammar as components in their unit boxes; component i of building `first` + i.
pub(super) fn templates(grammar: &InstanceGrammar, first: usize) -> Vec<Component> {
    let frame = OrientedBox {
        base: [0.0; 3],
        size: [1.0; 3],
        angle: 0.0,
    };
    let templates = grammar.templates.iter().enumerate();
    templates
        .map(|(i, t)| Component::of_template(t.mesh.clone(), frame, i, first + i, 0))
        .collect()
}

/// The parts of the example of each rule of a grammar, as components; rule k is of building `first` + k. A rule without an
/// example has none.
pub(super) fn examples(grammar: &InstanceGrammar, first: usize) -> Vec<Vec<Component>> {
    let numbers: rustc_hash::FxHashMap<&str, usize> = grammar
        .templates
        .iter()
        .enumerate()
        .map(|(i, t)| (t.symbol.as_str(), i))
        .collect();
    let given = grammar.top().into_iter().flat_map(|r| &r.successors);
    let given: rustc_hash::FxHashMap<&str, &Placement> =
        given.map(|p| (p.symbol.as_str(), p)).collect();
    let one = |(k, rule): (usize, &InstanceRule)| {
        let Some(example) = given.get(rule.symbol.as_str()) else {
            return Vec::new();
        };
        let parts = (0..rule.successors.len()).map(|s| rule.part(s, &example.numbers));
        let part = |(slab, placed): (usize, Placement)| {
            let template = *numbers.get(placed.symbol.as_str())?;
            let frame = OrientedBox {
                base: placed.at,
                size: placed.size,
                angle: placed.turn.to_radians(),
            };
            let mesh = grammar.templates[template].mesh.clone();
            Some(Component::of_template(
                mesh,
                frame,
                template,
                first + k,
                slab,
            ))
        };
        parts.enumerate().filter_map(part).collect()
    };
    Sample::rules(grammar)
        .into_iter()
        .enumerate()
        .map(one)
        .collect()
}

/// A city of no buildings, for what a sample needs of one: a name.
pub(super) fn named(name: &str) -> City {
    City {
        name: name.to_owned(),
        ..City::default()
    }
}
