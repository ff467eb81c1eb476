//! Makes the facades of `datasets/facade_grammar` anew:
//! `cargo run --release --example make_layouts -- datasets/facade_grammar [SEED]`.

use std::path::PathBuf;
use std::process::ExitCode;

use edifice_experiments::facade_grammar::data;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let Some(folder) = arguments.next().map(PathBuf::from) else {
        eprintln!("usage: make_layouts FOLDER [SEED]");
        return ExitCode::from(2);
    };
    let seed = arguments
        .next()
        .map_or(Ok(data::LAYOUT_SEED), |s| s.parse());
    let Ok(seed) = seed else {
        eprintln!("error: the seed is not a number");
        return ExitCode::from(2);
    };
    match data::write_layouts(&folder, seed) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
