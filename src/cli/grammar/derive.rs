//! `edifice grammar derive`.

use std::path::{Path, PathBuf};

use edifice::grammar::{Grammar, check, derive_at, is_size_independent, size_independent};
use edifice::io::{read_grammar, write_facade};
use edifice::shape::Facade;
use edifice::{Error, Result, rng};

use crate::cli::print;

/// Options of `edifice grammar derive`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice grammar derive house.cga -o house.facade.json
  edifice grammar derive house.grammar.json --width 800 --height 600 -o wide.svg
  edifice grammar derive street.cga --seed 7 -o variation.png

At another size than its own, a grammar of absolute sizes is first made size-independent: sizes
become relative, but for thin structures such as window frames, and repeats fill the space.
In a stochastic grammar the seed picks among the rules of each symbol.")]
pub struct Args {
    /// Grammar to read: .grammar.json or .cga, also as .gz
    grammar: PathBuf,
    /// Width to derive at, in the grammar's unit [default: its own]
    #[arg(long, value_name = "W", value_parser = super::positive)]
    width: Option<f64>,
    /// Height to derive at, in the grammar's unit [default: its own]
    #[arg(long, value_name = "H", value_parser = super::positive)]
    height: Option<f64>,
    /// Seed of stochastic grammars
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Facade of a joint grammar, by name or by number from 1 [default: the first]
    #[arg(long, value_name = "NAME")]
    facade: Option<String>,
    /// File to write: .facade.json, .svg or .png
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let facade = derive(args)?;
    write_facade(&facade, &args.output)?;
    print::line(&format!(
        "{}: {} regions, {} x {} {}",
        args.output.display(),
        facade.regions.len(),
        facade.width,
        facade.height,
        facade.unit
    ))
}

fn derive(args: &Args) -> Result<Facade> {
    let path = &args.grammar;
    let mut grammar = read_grammar(path)?;
    for warning in check(&grammar).map_err(|e| Error::content(path, e))? {
        print::message(&format!("warning: {}: {warning}", path.display()));
    }
    let index = start(&grammar, args.facade.as_deref())?;
    let own = &grammar.starts[index];
    let (width, height) = (
        args.width.unwrap_or(own.width),
        args.height.unwrap_or(own.height),
    );
    if (width, height) != (own.width, own.height) && !is_size_independent(&grammar) {
        grammar = size_independent(&grammar);
    }
    let mut rng = rng::stream(args.seed, "grammar derive", 0);
    let derivation =
        derive_at(&grammar, index, width, height, &mut rng).map_err(|e| Error::content(path, e))?;
    let mut facade = derivation.facade;
    if grammar.starts.len() == 1 && facade.name == grammar.starts[0].symbol {
        // The grammar says no more than its axiom: call the facade as its file.
        facade.name = stem(path);
    }
    Ok(facade)
}

/// The start asked for, by name or by number from 1.
fn start(grammar: &Grammar, wanted: Option<&str>) -> Result<usize> {
    let starts = &grammar.starts;
    let Some(wanted) = wanted else {
        if starts.len() > 1 {
            let (name, count) = (&starts[0].name, starts.len());
            print::message(&format!(
                "deriving {name}, the first of {count} facades; --facade picks another"
            ));
        }
        return Ok(0);
    };
    let number = || wanted.parse::<usize>().ok()?.checked_sub(1);
    let named = starts.iter().position(|s| s.name == wanted);
    named
        .or_else(|| number().filter(|&n| n < starts.len()))
        .ok_or_else(|| {
            let names: Vec<&str> = starts.iter().map(|s| s.name.as_str()).collect();
            let message = format!("no facade {wanted:?}; the grammar has {}", names.join(", "));
            Error::option("--facade", message)
        })
}

/// The file name up to its first dot.
fn stem(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.split('.').next().unwrap_or_default().to_owned()
}
