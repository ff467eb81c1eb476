//! The linear program whose dual the multipliers climb, solved by Clarabel.

use super::super::Program;
use edifice_optim::Outcome;
use edifice_optim::qp::{QpOptions, QuadraticProgram, Row, solve};

/// The optimum of the linear program. Variables: how much each occurrence uses each item, then how much each type has it. What
/// enters an occurrence leaves it by its operators, the arcs of each operator are a flow, and a type has an item as much as the
/// occurrences of any clique use it together.
pub(super) fn optimum(program: &Program) -> f64 {
    let (used, had) = (program.items, program.type_items);
    let mut lp = QuadraticProgram::new(used + had);
    lp.lower.fill(0.0);
    for region_type in &program.region_types {
        lp.linear[used + region_type.first..][..region_type.costs.len()]
            .copy_from_slice(&region_type.costs);
    }
    let mut entering: Vec<Vec<(usize, f64)>> = vec![Vec::new(); program.occurrences.len()];
    for (occurrence, known) in program.occurrences.iter().enumerate() {
        let region_type = &program.region_types[known.region_type as usize];
        for item in 0..region_type.arcs.len() {
            for part in program.parts(occurrence as u32, region_type, item) {
                if !program.is_terminal(part) {
                    entering[part as usize].push((known.first + item, -1.0));
                }
            }
        }
        for (index, operator) in region_type.operators.iter().enumerate() {
            let operation = known.first + region_type.operation(index);
            for node in 0..operator.last {
                let mut flow: Vec<(usize, f64)> = Vec::new();
                for item in operator.arcs.clone() {
                    let arc = &region_type.arcs[item];
                    if arc.from == node {
                        flow.push((known.first + item, 1.0));
                    } else if arc.to == node {
                        flow.push((known.first + item, -1.0));
                    }
                }
                if node == 0 {
                    flow.push((operation, -1.0));
                }
                lp.equalities.push(Row::new(flow, 0.0));
            }
        }
    }
    for region_type in &program.region_types {
        for (clique, item) in region_type
            .cliques
            .iter()
            .flat_map(|clique| (0..region_type.costs.len()).map(move |item| (clique, item)))
        {
            let occurrence = |&index: &u32| {
                &program.occurrences[region_type.occurrences[index as usize] as usize]
            };
            let uses = clique
                .iter()
                .map(|index| (occurrence(index).first + item, 1.0));
            let terms = uses.chain([(used + region_type.first + item, -1.0)]);
            lp.inequalities.push(Row::new(terms, 0.0));
        }
    }
    for (occurrence, known) in program.occurrences.iter().enumerate() {
        let region_type = &program.region_types[known.region_type as usize];
        let leaving =
            (0..region_type.operators.len()).map(|w| (known.first + region_type.operation(w), 1.0));
        let terms = leaving.chain(entering[occurrence].iter().copied());
        let root = program.roots.contains(&(occurrence as u32));
        let right = f64::from(u8::from(root));
        lp.equalities.push(Row::new(terms, right));
    }
    let solution = solve(&lp, QpOptions::default()).unwrap();
    assert_eq!(solution.outcome, Outcome::Converged);
    solution.cost
}
