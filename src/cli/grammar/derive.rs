//! `edifice grammar derive`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_editing::split_grammar::{DeriveError, Resizing, Wish, derived, glb};
use edifice_grammar::{Derivation, Grammar, check};
use edifice_io::{read_grammar, write_atomic, write_facade};
use edifice_shape::Facade;

use crate::given::Given;
use crate::print::{self, Json};

/// Options of `edifice grammar derive`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice grammar derive facade.cga -o facade.facade.json
  edifice grammar derive fig9.grammar.json --width 800 --height 600 -o wide.svg
  edifice grammar derive fig9.grammar.json --width 800 --rules -o by_rules.svg
  edifice grammar derive joint.grammar.json --facade terrace_a --seed 7 -o terrace_a.png

At its own size a grammar gives the facade that it was inferred from. At another size, columns that
stand together repeat together in all floors of that facade, floors at their own rhythm, and what is
left is stretched (--bands), unless the grammar says itself what gives way: by relative sizes (~) or
by several rules for a symbol. Then, and with --rules, its rules are asked: those without a relative
size are made size-independent, their sizes become relative, but for thin structures such as window
frames, and repeats fill the space. Absolute sizes give way last and in proportion, with a warning.
Edges are aligned, and terminals that are equal at the grammar's own size become equal again;
--no-align leaves them where the rules put them.
In a stochastic grammar the seed picks among the rules of each symbol.
A library (grammar infer --sizes free) is written as stochastic rules of CGA with attributes; only -o and --json are for it.")]
pub(crate) struct Args {
    #[command(flatten)]
    given: Given,
    /// Grammar to read: .grammar.json or .cga, or a .library.json to write as .cga, also as .gz
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
    /// At another size, ask the rules and align edges, also where no rule says what gives way
    #[arg(long)]
    rules: bool,
    /// At another size, ask the rules and leave edges where they put them
    #[arg(long)]
    no_align: bool,
    /// At another size, repeat or leave out whole columns and floors of the facade at its own size, and stretch the rest, whatever the rules say
    #[arg(long, conflicts_with_all = ["no_align", "rules"])]
    bands: bool,
    /// File to write: .facade.json, .svg, .png or .glb (in relief, metres); of a library .cga
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// The options that say how a facade is derived, not how a library is written.
const OF_GRAMMARS: [&str; 7] = [
    "width", "height", "seed", "facade", "rules", "no_align", "bands",
];

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let bytes = edifice_io::read_bytes(&args.grammar)?;
    if edifice_io::grammar_library_json::is_library(&bytes) {
        args.given.refuse(
            &OF_GRAMMARS,
            "is not for a library; `edifice grammar draw` makes facades of it",
        )?;
        return super::library::derive(&args.grammar, &bytes, &args.output, &args.json);
    }
    let facade = derive(args)?;
    let extension = args.output.extension().unwrap_or_default();
    match extension.eq_ignore_ascii_case("glb") {
        true => write_atomic(&args.output, &glb(&facade)?)?,
        false => write_facade(&facade, &args.output)?,
    }
    let text = format!(
        "{}: {} regions, {} x {} {}",
        args.output.display(),
        facade.regions.len(),
        facade.width,
        facade.height,
        facade.unit
    );
    let value = serde_json::json!({
        "file": args.output, "regions": facade.regions.len(), "width": facade.width, "height": facade.height,
        "unit": facade.unit, "seed": args.seed,
    });
    args.json.after(&text, &value)
}

fn derive(args: &Args) -> Result<Facade> {
    let path = &args.grammar;
    let grammar = read_grammar(path)?;
    for warning in check(&grammar).map_err(|e| Error::content(path, e))? {
        print::message(&format!("warning: {}: {warning}", path.display()));
    }
    let index = start(&grammar, args.facade.as_deref())?;
    let own = &grammar.starts[index];
    let (width, height) = (
        args.width.unwrap_or(own.width),
        args.height.unwrap_or(own.height),
    );
    let wish = Wish {
        start: index,
        size: Some((width, height)),
        seed: args.seed,
        resizing: match (args.bands, args.no_align, args.rules) {
            (true, ..) => Resizing::Bands,
            (_, true, _) => Resizing::Rules,
            (_, _, true) => Resizing::Aligned,
            (false, false, false) => Resizing::usual(&grammar),
        },
    };
    let made = derived(&grammar, &wish).map_err(|e| match e {
        DeriveError::Bands(e) => Error::content(path, format!("{e}; --rules asks the rules")),
        e => Error::content(path, e),
    })?;
    warn_of_shrunk(args, &grammar, &made.derivation);
    if !made.unequal.is_empty() {
        let labels = made.unequal.join(", ");
        let path = path.display();
        print::message(&match wish.resizing {
            Resizing::Bands => {
                format!("{path}: longer or shorter than at the own size, to fill it: {labels}")
            }
            _ => format!(
                "warning: {path}: not all terminals that are equal at the own size could stay so: {labels}"
            ),
        });
    }
    let mut facade = made.facade;
    if grammar.starts.len() == 1 && facade.name == grammar.starts[0].symbol {
        // The grammar says no more than its axiom: call the facade as its file.
        facade.name = stem(path);
    }
    Ok(facade)
}

/// Says how many rules have absolute sizes that shrank, and which of them most.
fn warn_of_shrunk(args: &Args, grammar: &Grammar, derivation: &Derivation) {
    let shrunk = derivation
        .shrunk
        .iter()
        .map(|(&rule, &factor)| (rule, factor));
    let Some((rule, factor)) = shrunk.min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return;
    };
    let (path, symbol) = (args.grammar.display(), &grammar.rules[rule].symbol);
    let rules = match derivation.shrunk.len() {
        1 => "1 rule".to_owned(),
        count => format!("{count} rules"),
    };
    print::message(&format!(
        "warning: {path}: absolute sizes of {rules} do not fit and shrink in proportion, most to {factor:.2} of what \
         rules[{rule}] ({symbol}) writes"
    ));
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
