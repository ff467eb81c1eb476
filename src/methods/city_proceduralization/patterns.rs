//! Patterns: types of buildings that stand at the same place relative to each other, again and again.

use super::building_types::BuildingTypes;
use super::component::Component;
use super::type_graph::{NEIGHBOUR, NodeInstance, neighbours};
use edifice_grammar::instance::{Posed, Repeated, repeated};

/// The patterns of a city over its types of buildings, smaller ones first.
pub fn patterns(components: &[Component], buildings: &BuildingTypes) -> Vec<Repeated> {
    let posed: Vec<Posed> = (buildings.order.iter())
        .filter_map(|&b| {
            let frame = &components[*buildings.parts[b].first()?].frame;
            Some(Posed {
                kind: buildings.labels[b]?,
                at: frame.base,
                turn: frame.angle.to_degrees(),
            })
        })
        .collect();
    // Neighbours in the plan: the ground is not level.
    let plan = |p: &Posed| NodeInstance {
        node: p.kind,
        middle: [p.at[0], p.at[1], 0.0],
    };
    let near = neighbours(&posed.iter().map(plan).collect::<Vec<_>>(), NEIGHBOUR);
    repeated(&posed, buildings.count, &buildings.symmetric, &near)
}
