//! Procedural logic on the published annotations (needs `EDIFICE_DATA` or `../shared/data`).

use std::path::PathBuf;

use edifice::grammar::{Costs, evaluate};
use edifice::io::facade_json;
use edifice::methods::procedural_logic::{Parameters, baseline_grammar};

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
