//! The lower bound of facade grammars against exhaustive search on tiny layouts, and the optimum of facade (i).

use std::collections::BTreeMap;

use edifice::grammar::Costs;
use edifice::io::facade_json;
use edifice::methods::facade_grammar::{BoundLimits, Operations, Settings, Weakness, lower_bound};
use edifice::shape::{Facade, Rect, Region};
use edifice::unwatched;
use proptest::prelude::*;

/// Labels of unit cells, row by row.
type Cells = Vec<Vec<u8>>;

fn facade(cells: &Cells) -> Facade {
    let regions = cells
        .iter()
        .enumerate()
        .flat_map(|(y, row)| {
            row.iter().enumerate().map(move |(x, label)| Region {
                label: format!("L{label}"),
                rect: Rect::new(x as f64, y as f64, 1.0, 1.0),
            })
        })
        .collect();
    Facade::new(
        "tiny",
        "cell",
        cells[0].len() as f64,
        cells.len() as f64,
        regions,
    )
    .unwrap()
}

/// The strip `a..b` of columns, or of rows.
fn part(cells: &Cells, columns: bool, a: usize, b: usize) -> Cells {
    if columns {
        cells.iter().map(|row| row[a..b].to_vec()).collect()
    } else {
        cells[a..b].to_vec()
    }
}

fn is_terminal(cells: &Cells) -> bool {
    cells.len() * cells[0].len() == 1
}

/// Every rule of every block: cost, and the blocks it needs as bits.
fn rules(root: &Cells, repeat: bool) -> Vec<Vec<(f64, u64)>> {
    let costs = Costs::default();
    let mut places: BTreeMap<Cells, usize> = BTreeMap::from([(root.clone(), 0)]);
    let mut blocks = vec![root.clone()];
    let mut all = Vec::new();
    let mut next = 0;
    while next < blocks.len() {
        let block = blocks[next].clone();
        next += 1;
        let mut found = Vec::new();
        for columns in [true, false] {
            let n = if columns { block[0].len() } else { block.len() };
            let mut need = |lines: &[usize]| {
                lines.windows(2).fold(0u64, |bits, w| {
                    let strip = part(&block, columns, w[0], w[1]);
                    if is_terminal(&strip) {
                        return bits;
                    }
                    let fresh = blocks.len();
                    let place = *places.entry(strip.clone()).or_insert(fresh);
                    if place == fresh {
                        blocks.push(strip);
                    }
                    bits | (1 << place)
                })
            };
            for end in 1..=n {
                let repeats = repeat
                    && end < n
                    && n % end == 0
                    && (0..n - end).all(|i| {
                        part(&block, columns, i, i + 1)
                            == part(&block, columns, i + end, i + end + 1)
                    });
                if end < n && !repeats {
                    continue;
                }
                for inner in 0..1usize << (end - 1) {
                    let lines: Vec<usize> = std::iter::once(0)
                        .chain((1..end).filter(|l| (inner >> (l - 1)) & 1 == 1))
                        .chain([end])
                        .collect();
                    let count = lines.len() - 1;
                    if end == n && count == 1 {
                        continue;
                    }
                    let operation = if end == n { costs.split } else { costs.repeat };
                    found.push((operation + count as f64, need(&lines)));
                }
            }
        }
        all.push(found);
    }
    all
}

/// The least cost over all subsets of blocks that have rules.
fn exhaustive(rules: &[Vec<(f64, u64)>]) -> f64 {
    let mut best = f64::INFINITY;
    for half in 0..1u64 << (rules.len() - 1) {
        let set = (half << 1) | 1;
        let mut cost = 0.0;
        for (place, block) in rules.iter().enumerate() {
            if (set >> place) & 1 == 1 {
                cost += block
                    .iter()
                    .filter(|(_, needs)| needs & !set == 0)
                    .map(|(cost, _)| *cost)
                    .fold(f64::INFINITY, f64::min);
            }
            if cost >= best {
                break;
            }
        }
        best = best.min(cost);
    }
    best
}

fn tiny() -> impl Strategy<Value = Cells> {
    let sizes = prop_oneof![
        Just((1, 6)),
        Just((5, 1)),
        Just((2, 2)),
        Just((2, 3)),
        Just((3, 2))
    ];
    (sizes, 1u8..4).prop_flat_map(|((rows, columns), labels)| {
        prop::collection::vec(prop::collection::vec(0..labels, columns), rows)
    })
}

fn settings(repeat: bool) -> Settings {
    Settings {
        iterations: 1,
        operations: Operations {
            repeat,
            ..Operations::split_only()
        },
        ..Settings::default()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn bound_is_below_the_optimum_and_a_proof_is_right(cells in tiny(), repeat: bool) {
        let least = exhaustive(&rules(&cells, repeat));
        let few = BoundLimits { nodes: 1, root_steps: 40, ..BoundLimits::default() };
        for limits in [few, BoundLimits::default()] {
            let bound = lower_bound(&facade(&cells), &settings(repeat), &limits, &unwatched).unwrap();
            prop_assert!(bound.lower <= least + 1e-6, "{bound:?} above {least}");
            prop_assert!(bound.upper >= least - 1e-6, "{bound:?} below {least}");
            if bound.proven {
                prop_assert!((bound.upper - least).abs() < 1e-6, "{bound:?}, optimum {least}");
            }
            if limits.nodes > 1 {
                prop_assert!(bound.proven, "{bound:?}, optimum {least}");
            }
        }
    }

    #[test]
    fn weak_bound_and_all_operations_stay_below(cells in tiny()) {
        let least = exhaustive(&rules(&cells, true));
        let limits = BoundLimits { items: 0, ..BoundLimits::default() };
        let weak = lower_bound(&facade(&cells), &settings(true), &limits, &unwatched).unwrap();
        prop_assert!(weak.weak == Some(Weakness::Items) && weak.lower <= least + 1e-6);
        // More operations can only lower the optimum.
        let more = Settings {
            operations: Operations { repeat_aba: true, sym_split: true, ..Operations::default() },
            ..settings(true)
        };
        let bound = lower_bound(&facade(&cells), &more, &BoundLimits::default(), &unwatched).unwrap();
        prop_assert!(bound.lower <= least + 1e-6 && bound.lower <= bound.upper + 1e-6);
    }
}

#[test]
fn a_facade_of_one_region_needs_no_rule() {
    let bound = lower_bound(
        &facade(&vec![vec![0]]),
        &settings(true),
        &BoundLimits::default(),
        &unwatched,
    );
    let bound = bound.unwrap();
    assert!(bound.proven && bound.types == 0);
    assert_eq!(bound.upper, bound.lower);
}

/// The optimum of facade (i) of Wu et al. 2014 is known for every set of operations but grids.
#[test]
fn facade_i_is_solved() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/datasets/facade_grammar/wu2014_fig9.facade.json"
    );
    let facade = facade_json::read(path.as_ref()).unwrap();
    let extensions = Operations {
        repeat_aba: true,
        sym_split: true,
        ..Operations::default()
    };
    for (operations, least) in [
        (Operations::split_only(), 38.6),
        (Operations::default(), 38.1),
        (extensions, 37.2),
    ] {
        let settings = Settings {
            iterations: 100,
            operations,
            ..Settings::default()
        };
        let bound = lower_bound(&facade, &settings, &BoundLimits::default(), &unwatched).unwrap();
        assert!(bound.proven, "{operations:?}: {bound:?}");
        assert!(
            (bound.upper - least).abs() < 1e-6,
            "{operations:?}: {bound:?}"
        );
    }
}
