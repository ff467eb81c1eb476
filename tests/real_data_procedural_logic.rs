//! Procedural logic on the published annotations (needs `EDIFICE_DATA` or `../shared/data`).

use std::path::{Path, PathBuf};

use edifice::grammar::{Costs, derive, evaluate};
use edifice::io::{ReadOptions, facade_json, read_label_grid};
use edifice::methods::procedural_logic::{
    Model, NaryTree, Parameters, baseline_grammar, split_grammar,
};
use edifice::shape::{Facade, LabelGrid};

/// The data folder, or `None` with a loud word.
fn data() -> Option<PathBuf> {
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let folder =
        std::env::var_os("EDIFICE_DATA").map_or(here.join("../shared/data"), PathBuf::from);
    if folder.join("facades/ecp2011/labels").is_dir() {
        return Some(folder);
    }
    eprintln!("SKIPPED: no data at {}; set EDIFICE_DATA", folder.display());
    None
}

#[test]
fn baseline_of_facade_i() {
    let Some(data) = data() else { return };
    let path = data.join("facades/wu2014_fig9.facade.json");
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
    let Some(data) = data() else { return };
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
    let Some(data) = data() else { return };
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
