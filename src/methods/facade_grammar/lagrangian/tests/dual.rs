//! The multipliers that occurrences pay for items, and the costs that are left for them to split where a type is required.

use super::*;

/// The multipliers of a region type, by clique and then by item.
fn by_clique<'m>(program: &Program, region_type: usize, multipliers: &'m [f64]) -> Vec<&'m [f64]> {
    let types = &program.region_types;
    let before: usize = types[..region_type]
        .iter()
        .map(|known| known.cliques.len() * known.costs.len())
        .sum();
    let known = &types[region_type];
    let chunks = multipliers[before..].chunks(known.costs.len());
    chunks.take(known.cliques.len()).collect()
}

/// Compares what each occurrence pays with the sum over all cliques that have the occurrence.
fn check_costs(dual: &Dual) {
    let program = dual.program;
    for (index, known) in program.region_types.iter().enumerate() {
        let multipliers = by_clique(program, index, &dual.multipliers);
        for (place, &occurrence) in known.occurrences.iter().enumerate() {
            let first = program.occurrences[occurrence as usize].first;
            for item in 0..known.costs.len() {
                let mut sum = 0.0;
                for (clique, multipliers) in known.cliques.iter().zip(&multipliers) {
                    if clique.contains(&(place as u32)) {
                        sum += multipliers[item];
                    }
                }
                let paid = dual.item_costs[first + item];
                assert!((paid - sum).abs() < 1e-9, "{paid} is not {sum}");
            }
        }
    }
}

#[test]
fn an_occurrence_pays_the_multipliers_of_its_cliques() {
    let program = program_of_many_steps();
    assert!(program.region_types.iter().any(|t| t.cliques.len() > 2));
    // Multipliers that are all different.
    let different = (0..program.multipliers).map(|i| i as f64).collect();
    check_costs(&Dual::from(&program, different));
    // And those that some steps arrive at.
    let mut dual = Dual::new(&program);
    let mut incumbent = Incumbent::new(f64::INFINITY, &Costs::default(), Operations::default());
    dual.ascend(&mut incumbent, 50, &mut { u64::MAX });
    let moved = (0..program.region_types.len()).any(|index| {
        let cliques = by_clique(&program, index, &dual.multipliers);
        cliques.iter().any(|clique| *clique != cliques[0])
    });
    assert!(moved, "all cliques pay the same");
    check_costs(&dual);
}

/// A required type pays a part of the costs in advance; every clique splits what is left of an item's cost as before.
#[test]
fn multipliers_of_a_required_type_shrink_with_its_costs() {
    let mut shrunk = 0;
    for index in 0..program_of_many_steps().region_types.len() {
        let mut program = program_of_many_steps();
        // Cliques that pay different parts of an item.
        let before: Vec<f64> = (0..program.multipliers).map(|i| 1.0 + i as f64).collect();
        let mut after = before.clone();
        let costs = program.region_types[index].costs.clone();
        program.require(index, &mut after);
        let left = &program.region_types[index].costs;
        for other in 0..program.region_types.len() {
            let (before, after) = (
                by_clique(&program, other, &before),
                by_clique(&program, other, &after),
            );
            for (before, after) in before.into_iter().zip(after) {
                for (item, (old, new)) in before.iter().zip(after).enumerate() {
                    let part = match other == index && costs[item] > 0.0 {
                        true => left[item] / costs[item],
                        false => 1.0,
                    };
                    assert!((old * part - new).abs() < 1e-9, "{old} becomes {new}");
                    shrunk += usize::from(part < 1.0);
                }
            }
        }
    }
    assert!(shrunk > 100, "{shrunk} multipliers say little");
}
