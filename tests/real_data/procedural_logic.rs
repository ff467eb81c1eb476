//! Procedural logic on the published annotations (needs `EDIFICE_DATA` or `../shared/data`).

use std::path::{Path, PathBuf};

use edifice::cluster::{Linkage, Query, agglomerate, cumulative_match, purity};
use edifice::grammar::{Costs, derive, evaluate};
use edifice::io::{ReadOptions, facade_json, read_label_grid};
use edifice::methods::procedural_logic::{
    Measure, Model, NaryTree, Parameters, baseline_grammar, split_grammar,
};
use edifice::shape::{Facade, LabelGrid};
use edifice_experiments::procedural_logic::gold::{Annotations, Doors};

use crate::common::real_data;

const LABELS: &str = "facades/ecp2011/labels";
const LINES: &str = "facades/ecp2011/floor_column_lines";

#[test]
fn baseline_of_facade_i() {
    let file = "facades/wu2014_fig9.facade.json";
    let Some(data) = real_data(file) else { return };
    let path = data.join(file);
    let facade = facade_json::read(&path).expect("the facade");
    let grammar = baseline_grammar(&facade, &Parameters::COMPRESSION).expect("a grammar");
    let found = evaluate(&grammar, &[facade], &Costs::default()).expect("derives back");
    // Wu et al. 2014, Table 2: 51 for the authors' procedural logic with splits only.
    assert!(found.cost <= 51.0, "{found:?}");
}

/// All label images of a set, by name.
fn label_images(data: &Path, set: &str) -> Vec<LabelGrid> {
    let folder = data.join("facades").join(set).join("labels");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    let read = |path: &PathBuf| read_label_grid(path, &ReadOptions::default()).expect("an image");
    paths.iter().map(read).collect()
}

/// Number of pixels at which a layout differs from a label image.
fn wrong_pixels(grid: &LabelGrid, facade: &Facade) -> usize {
    let (width, height) = (facade.width as usize, facade.height as usize);
    let mut painted = vec![""; width * height];
    for region in &facade.regions {
        let r = region.rect;
        for y in r.y.round() as usize..r.top().round() as usize {
            for x in r.x.round() as usize..r.right().round() as usize {
                painted[y * width + x] = &region.label;
            }
        }
    }
    let mut wrong = 0;
    for j in 0..grid.rows() {
        for i in 0..grid.columns() {
            for y in grid.ys[j] as usize..grid.ys[j + 1] as usize {
                for x in grid.xs[i] as usize..grid.xs[i + 1] as usize {
                    let label = &grid.labels[usize::from(grid.at(i, j))];
                    wrong += usize::from(painted[y * width + x] != label);
                }
            }
        }
    }
    wrong
}

#[test]
fn lossless_on_all_facades() {
    let Some(data) = real_data(LABELS) else {
        return;
    };
    for (set, count) in [("ecp2011", 104), ("graz50", 30)] {
        let grids = label_images(&data, set);
        assert_eq!(grids.len(), count);
        let mut model = Model::fit(&grids, Parameters::COMPRESSION).expect("fits");
        for (index, grid) in grids.iter().enumerate() {
            let tree = NaryTree::from_binary(&model.parse(grid).expect("an image"));
            let grammar = split_grammar(&tree, &model.alphabet, &grid.name, &grid.unit);
            let facade = derive(&grammar, 0).expect("a grammar");
            assert_eq!(wrong_pixels(grid, &facade), 0, "{} as a grammar", grid.name);
            let known = model.layout(&model.facades[index]).expect("known");
            assert_eq!(wrong_pixels(grid, &known), 0, "{} by the rules", grid.name);
        }
    }
}

/// Section 5.3: 68 rules "for all values of" these ranges.
#[test]
fn sixty_eight_rules() {
    let Some(data) = real_data(LABELS) else {
        return;
    };
    let grids = label_images(&data, "ecp2011");
    let mut parameters = vec![Parameters::COMPRESSION, Parameters::RETRIEVAL];
    for alpha in [0.25, 0.5, 1.0] {
        for parental in [0.0625, 0.5] {
            for horizontal in [0.125, 1.0] {
                parameters.push(Parameters::new(alpha, parental, horizontal).expect("in range"));
            }
        }
    }
    for parameters in parameters {
        let inference = Model::fit(&grids, parameters).expect("fits").inference;
        assert_eq!(inference.rules.len(), 68, "{parameters:?}");
        assert_eq!(inference.forced, 0);
        assert!(inference.binary_splits >= 100 * 68, "{inference:?}");
    }
}

/// The gold standard of a dozen facades and more: what the rule gives, checked by eye on photograph
/// and labels. Four floor counts of the annotation are one or two short of what the eye counts
/// (the roof floor, or a floor behind a tall shop, is not annotated): they stand as they are.
#[test]
fn gold_standard_checked_by_eye() {
    let Some(data) = real_data(LINES) else { return };
    let lines = data.join(LINES);
    let annotations = Annotations::read(&lines).expect("the annotation");
    // Name, floors annotated, floors by eye, columns, column of the door, floors with running balconies.
    type Checked = (
        &'static str,
        usize,
        usize,
        usize,
        Option<usize>,
        &'static [usize],
    );
    let checked: [Checked; 18] = [
        ("monge_1", 7, 7, 8, None, &[2, 5]),
        ("monge_10", 7, 7, 4, Some(1), &[2, 5]),
        ("monge_101", 7, 7, 4, Some(3), &[1, 2, 3, 4, 5]),
        ("monge_110", 7, 7, 4, Some(3), &[5]),
        ("monge_14", 7, 7, 3, Some(0), &[2, 5]),
        // The sixth column is one of narrow windows, which the labels leave out.
        ("monge_17", 7, 7, 6, Some(4), &[5]),
        ("monge_23", 6, 7, 4, Some(0), &[2, 5]),
        ("monge_34", 5, 7, 4, None, &[1, 5]),
        ("monge_37", 6, 7, 4, Some(2), &[5]),
        ("monge_46", 7, 7, 5, Some(2), &[2, 5]),
        ("monge_56", 6, 6, 5, Some(3), &[]),
        ("monge_57", 7, 7, 9, Some(2), &[5]),
        ("monge_58", 7, 7, 6, Some(5), &[]),
        ("monge_60", 7, 7, 6, Some(5), &[2, 5]),
        ("monge_62", 7, 7, 6, Some(3), &[2]),
        ("monge_67", 7, 7, 2, Some(0), &[5]),
        ("monge_96", 6, 6, 5, Some(2), &[]),
        ("monge_97", 6, 7, 7, Some(3), &[2, 3, 4, 5]),
    ];
    let grids = label_images(&data, "ecp2011");
    for (name, floors, by_eye, columns, door, balconies) in checked {
        let grid = grids.iter().find(|grid| grid.name == name).expect(name);
        let found = annotations.architecture(grid).expect(name);
        let wanted: Vec<usize> = door.into_iter().collect();
        let doors = &found.doors[Doors::Column as usize];
        assert_eq!((found.floors, found.columns), (floors, columns), "{name}");
        assert_eq!(
            (doors, found.balconies.as_slice()),
            (&wanted, balconies),
            "{name}"
        );
        let short = ["monge_23", "monge_34", "monge_37", "monge_97"].contains(&name);
        assert_eq!(floors < by_eye, short, "{name}");
    }
}

/// Fig. 4 and Fig. 3 in two numbers each, so that nothing loses them unnoticed.
#[test]
fn retrieval_and_separation() {
    let Some(data) = real_data(LINES) else { return };
    let lines = data.join(LINES);
    let annotations = Annotations::read(&lines).expect("the annotation");
    let ecp = label_images(&data, "ecp2011");
    let gold: Vec<_> = ecp
        .iter()
        .map(|g| annotations.architecture(g).expect("annotated"))
        .collect();
    let model = Model::fit(&ecp, Parameters::RETRIEVAL).expect("fits");
    let distances = Measure::Powerset.matrix(&model.profiles().expect("profiles"));
    let identical = |a: usize, b: usize| gold[a].changes(&gold[b], Doors::Layout) == 0;
    let curve = cumulative_match(&distances, identical, 20, Query::LeftOut);
    assert!(
        curve.rates[0] >= 0.87 && curve.rates[1] >= 0.98,
        "{:?}",
        curve.rates
    );
    // The one facade that is not found within two: six columns annotated, five in its labels.
    let missed = curve.queries.iter().filter(|query| query.1[1] < 0.5);
    let missed: Vec<&str> = missed.map(|query| ecp[query.0].name.as_str()).collect();
    assert_eq!(missed, ["monge_17"]);

    let both: Vec<LabelGrid> = ecp
        .into_iter()
        .chain(label_images(&data, "graz50"))
        .collect();
    let model = Model::fit(&both, Parameters::RETRIEVAL).expect("fits");
    let distances = Measure::Powerset.matrix(&model.profiles().expect("profiles"));
    let tree = agglomerate(&distances, Linkage::Average).expect("distances");
    let style: Vec<bool> = (0..both.len()).map(|index| index < 104).collect();
    assert!(purity(&tree.cut(2), &style) >= 0.95);
}
