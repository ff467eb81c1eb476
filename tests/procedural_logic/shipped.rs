//! The shipped layouts as label pictures, and the gold standard read off their labels.

use std::path::Path;

use edifice::grammar::derive;
use edifice::methods::procedural_logic::{Model, NaryTree, Parameters, split_grammar};
use edifice::shape::{Facade, LabelGrid};
use edifice_experiments::layouts;
use edifice_experiments::procedural_logic::gold::Doors;
use edifice_experiments::procedural_logic::{data, outline, shipped};

fn shipped_layouts() -> Vec<Facade> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar");
    layouts::read_all(&folder).expect("the shipped layouts")
}

#[test]
fn every_label_comes_back() {
    let grids: Vec<LabelGrid> = shipped_layouts()
        .iter()
        .map(|facade| shipped::detailed(facade).expect("a tiling"))
        .collect();
    assert_eq!(grids.len(), 35);
    let mut model = Model::fit(&grids, Parameters::COMPRESSION).expect("fits");
    for grid in &grids {
        let tree = NaryTree::from_binary(&model.parse(grid).expect("a picture"));
        let grammar = split_grammar(&tree, &model.alphabet, &grid.name, &grid.unit);
        let derived = derive(&grammar, 0).expect("a grammar");
        let painted = LabelGrid::from_facade(&derived, None).expect("a tiling");
        assert_eq!(painted.merged(), *grid, "{}", grid.name);
    }
}

/// Floors (ground floor and roof floor included), window columns, floors with a running balcony,
/// and number of doors, counted by eye in the pictures of the layouts.
#[test]
fn the_rule_counts_as_the_eye_does() {
    let by_eye: [(&str, usize, usize, &[usize], usize); 18] = [
        ("wu2014_fig9", 4, 5, &[], 0),
        ("boulevard_1", 6, 6, &[3], 1),
        ("boulevard_2", 6, 8, &[4], 1),
        ("boulevard_3", 7, 9, &[3], 1),
        ("boulevard_4", 6, 6, &[3], 1),
        ("cottage_1", 2, 4, &[], 1),
        ("cottage_2", 2, 3, &[], 1),
        ("shophouse_1", 3, 2, &[], 1),
        ("shophouse_2", 3, 4, &[], 1),
        ("shophouse_3", 4, 2, &[], 1),
        ("terrace_a", 3, 3, &[], 1),
        ("terrace_b", 3, 4, &[], 1),
        ("terrace_c", 4, 5, &[], 1),
        ("terrace_d", 2, 3, &[], 1),
        ("townhouse_1", 4, 3, &[], 1),
        ("townhouse_2", 5, 3, &[], 1),
        ("townhouse_3", 4, 3, &[], 1),
        ("townhouse_4", 4, 3, &[], 1),
    ];
    let layouts = shipped_layouts();
    let mut off = Vec::new();
    for (name, floors, columns, balconies, doors) in by_eye {
        let facade = layouts.iter().find(|facade| facade.name == name);
        let grid = shipped::picture(facade.expect("shipped")).expect("a tiling");
        let found = outline::architecture(&grid);
        let rest = (
            found.floors,
            found.balconies.as_slice(),
            found.doors[0].len(),
        );
        assert_eq!(rest, (floors, balconies, doors), "{name}");
        if found.columns != columns {
            off.push((name, found.columns));
        }
    }
    // Every upper floor of it lacks one of the three windows.
    assert_eq!(off, [("townhouse_3", 2)]);
}

/// Another size is another facade of the same structure: it parses to the same starting rule, and
/// no distance on structures tells the two apart.
#[test]
fn other_sizes_keep_the_structure() {
    let source = data::shipped_source(&shipped_layouts()).expect("tilings");
    assert_eq!((source.grids.len(), source.other.len()), (70, 21));
    let model = Model::fit(&source.grids, Parameters::COMPRESSION).expect("fits");
    let layouts = 14;
    for copy in layouts..70 {
        let original = copy % layouts;
        let (grid, first) = (&source.grids[copy], &source.grids[original]);
        assert_eq!((&grid.cells, &grid.labels), (&first.cells, &first.labels));
        assert_ne!(
            (&grid.xs, &grid.ys),
            (&first.xs, &first.ys),
            "{}",
            grid.name
        );
        assert_eq!(grid.check(), Ok(()));
        let changes =
            source.architecture[copy].changes(&source.architecture[original], Doors::Layout);
        assert_eq!(changes, 0, "{}", grid.name);
    }
    let starts = |range: std::ops::Range<usize>| {
        let of = model.facades[range].iter();
        of.map(|known| known.instance.start).collect::<Vec<_>>()
    };
    for copy in 1..5 {
        assert_eq!(
            starts(0..layouts),
            starts(copy * layouts..(copy + 1) * layouts)
        );
    }
}
