//! The linear program whose dual the shares climb, solved by Clarabel.

use super::super::Program;
use crate::optim::Outcome;
use crate::optim::qp::{QpOptions, QuadraticProgram, Row, solve};

/// Its optimum. Variables: how much each place uses each item, then how much each type has it. What enters a
/// place leaves it by its ways, each way's arcs are a flow, and a type has what the places of any purse use.
pub fn optimum(program: &Program) -> f64 {
    let (used, had) = (program.items, program.kind_items);
    let mut lp = QuadraticProgram::new(used + had);
    lp.lower.fill(0.0);
    for kind in &program.kinds {
        lp.linear[used + kind.first..][..kind.costs.len()].copy_from_slice(&kind.costs);
    }
    let mut entering: Vec<Vec<(usize, f64)>> = vec![Vec::new(); program.places.len()];
    for (place, known) in program.places.iter().enumerate() {
        let kind = &program.kinds[known.kind as usize];
        for item in 0..kind.arcs.len() {
            for part in program.parts(place as u32, kind, item) {
                if !program.is_terminal(part) {
                    entering[part as usize].push((known.first + item, -1.0));
                }
            }
        }
        for (way, known_way) in kind.ways.iter().enumerate() {
            let operation = known.first + kind.operation(way);
            for node in 0..known_way.last {
                let mut flow: Vec<(usize, f64)> = Vec::new();
                for item in known_way.arcs.clone() {
                    let arc = &kind.arcs[item];
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
    for kind in &program.kinds {
        for (purse, item) in kind
            .purses
            .iter()
            .flat_map(|purse| (0..kind.costs.len()).map(move |item| (purse, item)))
        {
            let place = |&index: &u32| &program.places[kind.places[index as usize] as usize];
            let uses = purse.iter().map(|index| (place(index).first + item, 1.0));
            let terms = uses.chain([(used + kind.first + item, -1.0)]);
            lp.inequalities.push(Row::new(terms, 0.0));
        }
    }
    for (place, known) in program.places.iter().enumerate() {
        let kind = &program.kinds[known.kind as usize];
        let leaving = (0..kind.ways.len()).map(|w| (known.first + kind.operation(w), 1.0));
        let terms = leaving.chain(entering[place].iter().copied());
        let root = program.roots.contains(&(place as u32));
        let right = f64::from(u8::from(root));
        lp.equalities.push(Row::new(terms, right));
    }
    let solution = solve(&lp, QpOptions::default()).unwrap();
    assert_eq!(solution.outcome, Outcome::Converged);
    solution.cost
}
