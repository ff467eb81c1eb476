//! `edifice grammar infer --sizes free`, and what a library of parametric rules is for: `draw`, `score`, `encode`, `decode`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_grammar::parametric::{Library, LibraryError, Sharing};
use edifice_grammar::{Costs, Grammar, GrammarError, derivation, same_tiling};
use edifice_io as io;
use edifice_io::grammar_library_json::{self as library_json, EncodedFacade};
use edifice_shape::Facade;

use crate::print::{self, Json};
use crate::reading::{self, Reading};

/// Makes the library of some facades and writes or lists it.
pub(super) fn infer(
    facades: &[Facade],
    costs: &Costs,
    output: Option<&Path>,
    json: bool,
) -> Result<()> {
    let started = Instant::now();
    let library = Library::learn(facades).map_err(Error::method)?;
    let sharing = library.sharing(costs);
    let seconds = started.elapsed().as_secs_f64();
    // No method marks its own work: the cost is that of the written grammar, and every facade must come back.
    let cost = tidy(costs.grammar(&library.grammar(&sharing)));
    for (facade, member) in facades.iter().zip(library.members()) {
        let back = library
            .facade(&member.parse, &facade.name)
            .map_err(Error::method)?;
        if !same_tiling(facade, &back) {
            let message = format!("{}: the library does not give the facade back", facade.name);
            return Err(Error::method(message));
        }
    }
    match output {
        Some(path) => write(&library, &sharing, path)?,
        None => library
            .listing()
            .iter()
            .try_for_each(|line| print::line(line))?,
    }
    let bits = library.told_by_others();
    let mean = bits.iter().sum::<f64>() / bits.len() as f64;
    if json {
        let line = serde_json::json!({
            "cost": cost, "lower_bound": tidy(sharing.lower_bound), "rules": sharing.rules.len(),
            "facades": facades.len(), "terminals": facades.iter().map(|f| f.regions.len()).sum::<usize>(),
            "bits": tidy(mean), "seconds": seconds,
        });
        return print::line(&line.to_string());
    }
    let proof = match sharing.is_proven() {
        true => "(proven for this parse)".to_owned(),
        false => format!("(at least {:.1} for this parse)", sharing.lower_bound),
    };
    print::message(&format!(
        "cost {cost} {proof}, {} rules for {} facades in {seconds:.2} s; {mean:.1} bits a facade, each told by all others",
        sharing.rules.len(),
        facades.len()
    ));
    Ok(())
}

fn tidy(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

/// Writes a library: as itself, as a split grammar of mean sizes, or as stochastic rules of CGA with attributes.
fn write(library: &Library, sharing: &Sharing, path: &Path) -> Result<()> {
    let name = path.to_string_lossy().to_lowercase();
    if name.ends_with(".cga") {
        io::grammar_cga::write_named(&library.named(), path)
    } else if name.ends_with(".grammar.json") {
        io::write_grammar(&library.grammar(sharing), path)
    } else if name.ends_with(".json") {
        library_json::write(library, path)
    } else {
        let message = "expected .library.json, .grammar.json or .cga";
        Err(Error::option("--output", message))
    }
}

/// Lists a library with what it costs.
pub(super) fn show(path: &Path, bytes: &[u8], costs: &Costs, json: bool) -> Result<()> {
    let library = library_json::parse(bytes, path)?;
    library
        .listing()
        .iter()
        .try_for_each(|line| print::line(line))?;
    let sharing = library.sharing(costs);
    let cost = tidy(costs.grammar(&library.grammar(&sharing)));
    let (bound, rules) = (tidy(sharing.lower_bound), sharing.rules.len());
    print::line("")?;
    print::line(&format!(
        "{} facades in {} x {}, {} parametric rules; as a grammar with shared parts {rules} rules, cost {cost} (at least {bound})",
        library.members().len(),
        library.step(),
        library.unit(),
        library.rules().rules().len(),
    ))?;
    if json {
        let line = serde_json::json!({
            "cost": cost, "lower_bound": bound, "rules": rules, "facades": library.members().len(),
            "parametric_rules": library.rules().rules().len(), "labels": library.rules().labels(),
        });
        print::line(&line.to_string())?;
    }
    Ok(())
}

fn is_cga(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("cga"))
}

/// Runs `grammar derive` of a library: its rules as CGA.
pub(super) fn derive(path: &Path, bytes: &[u8], output: &Path, json: &Json) -> Result<()> {
    if !is_cga(output) {
        let message = "a library is written as .cga; `edifice grammar draw` makes facades of it";
        return Err(Error::option("--output", message));
    }
    let named = library_json::parse(bytes, path)?.named();
    io::grammar_cga::write_named(&named, output)?;
    let (rules, attributes, choices) = (
        named.rules.len(),
        named.attributes.len(),
        named.choices.len(),
    );
    let text = format!(
        "{}: {rules} rules, {attributes} attributes, {choices} choices of structure and counts",
        output.display()
    );
    let value = serde_json::json!({
        "file": output, "rules": rules, "attributes": attributes, "choices": choices,
    });
    json.after(&text, &value)
}

/// Options of `edifice grammar draw`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice grammar infer datasets/facade_grammar/layouts/terrace_*.facade.json --sizes free -o street.library.json
  edifice grammar draw street.library.json --seed 7 -o new.facade.json
  edifice grammar draw street.library.json --count 12 -o draws")]
pub(crate) struct Draw {
    /// Library to draw from: .library.json, also as .gz
    library: PathBuf,
    /// Seed of all randomness
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Number of facades; more than one are written into a folder
    #[arg(short = 'n', long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    count: u32,
    /// File to write (.facade.json, .svg, .png), or folder for .facade.json files
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Runs `grammar draw`.
pub(super) fn draw(args: &Draw) -> Result<()> {
    let library = library_json::read(&args.library)?;
    let wrong = |error: LibraryError| Error::content(&args.library, error);
    if args.count == 1 && !args.output.is_dir() {
        let facade = library
            .draw(&mut stream(args.seed, "draw", 0), "drawn")
            .map_err(wrong)?;
        io::write_facade(&facade, &args.output)?;
        let value = serde_json::json!({ "files": [args.output], "seed": args.seed });
        return args.json.end(&value);
    }
    let mut files = Vec::new();
    std::fs::create_dir_all(&args.output).map_err(|e| Error::io(&args.output, "create", e))?;
    for k in 0..args.count {
        let name = format!("drawn_{}", k + 1);
        let facade = library
            .draw(&mut stream(args.seed, "draw", k.into()), &name)
            .map_err(wrong)?;
        let path = args.output.join(format!("{name}.facade.json"));
        io::write_facade(&facade, &path)?;
        files.push(path);
    }
    let text = format!("{}: {} facades", args.output.display(), args.count);
    let value = serde_json::json!({ "files": files, "seed": args.seed });
    args.json.after(&text, &value)
}

/// Options of `edifice grammar score`.
#[derive(clap::Args)]
#[command(after_help = "Example:
  edifice grammar score street.library.json new.facade.json draws/*.facade.json

The bits that a facade costs given the library: the fewer, the more it is like the library's facades.")]
pub(crate) struct Score {
    /// Library: .library.json, also as .gz
    library: PathBuf,
    /// Facades to score
    #[arg(required = true, value_name = "FACADE")]
    facades: Vec<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// End with one line of JSON
    #[arg(long)]
    json: bool,
}

/// Runs `grammar score`.
pub(super) fn score(args: &Score) -> Result<()> {
    let library = library_json::read(&args.library)?;
    let options = args.reading.options()?;
    let mut scores = serde_json::Map::new();
    for path in &args.facades {
        let facade = reading::source(path, &options)?.facade(path)?;
        let bits = library.bits(&facade).map_err(|e| Error::content(path, e))?;
        print::line(&format!("{bits:.2} bits  {}", path.display()))?;
        scores.insert(path.display().to_string(), tidy(bits).into());
    }
    match args.json {
        true => print::line(&serde_json::json!({ "bits": scores }).to_string()),
        false => Ok(()),
    }
}

/// Options of `edifice grammar encode`.
#[derive(clap::Args)]
#[command(after_help = "Example:
  edifice grammar encode street.library.json new.facade.json -o new.encoded.json")]
pub(crate) struct Encode {
    /// Library: .library.json, also as .gz
    library: PathBuf,
    /// Facade to write with it
    facade: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Encoded facade to write: .encoded.json
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Runs `grammar encode`.
pub(super) fn encode(args: &Encode) -> Result<()> {
    let library = library_json::read(&args.library)?;
    let path = &args.facade;
    let facade = reading::source(path, &args.reading.options()?)?.facade(path)?;
    let code = library
        .encode(&facade)
        .map_err(|e| Error::content(path, e))?;
    let encoded = EncodedFacade {
        name: facade.name,
        library: library_json::digest(&library)?,
        bits: tidy(code.bits),
        bytes: code.bytes,
    };
    library_json::write_code(&encoded, &args.output)?;
    let bytes = encoded.bytes.len();
    let (file, bits) = (args.output.display(), encoded.bits);
    let value = serde_json::json!({ "file": args.output, "bits": bits, "bytes": bytes });
    let text = format!("{file}: {bits:.2} bits, {bytes} bytes");
    args.json.after(&text, &value)
}

/// Options of `edifice grammar decode`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice grammar decode street.library.json new.encoded.json -o new.facade.json
  edifice grammar decode street.library.json new.encoded.json -o new.cga")]
pub(crate) struct Decode {
    /// Library that the facade was written with: .library.json, also as .gz
    library: PathBuf,
    /// Encoded facade: .encoded.json, also as .gz
    encoded: PathBuf,
    /// Facade to write: .facade.json, .svg, .png; or its rules with sizes and counts as attributes: .cga
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Runs `grammar decode`.
pub(super) fn decode(args: &Decode) -> Result<()> {
    let library = library_json::read(&args.library)?;
    let encoded = library_json::read_code(&args.encoded)?;
    if encoded.library != library_json::digest(&library)? {
        let message = "the facade was written with another library";
        return Err(Error::input(&args.encoded, "library", message));
    }
    let facade = library
        .decode(&encoded.bytes, &encoded.name)
        .map_err(|e| Error::content(&args.encoded, e))?;
    match is_cga(&args.output) {
        true => {
            let named = library.named_facade(&facade);
            let named = named.map_err(|e| Error::content(&args.encoded, e))?;
            io::grammar_cga::write_named(&named, &args.output)?;
        }
        false => io::write_facade(&facade, &args.output)?,
    }
    let value = serde_json::json!({ "file": args.output, "regions": facade.regions.len() });
    args.json.end(&value)
}

/// Options of `edifice grammar combine`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice grammar infer datasets/facade_grammar/layouts/terrace_a.facade.json -o a.cga
  edifice grammar infer datasets/facade_grammar/layouts/terrace_b.facade.json -o b.cga
  edifice grammar combine a.cga b.cga -o street.cga
  edifice grammar derive street.cga --seed 7 -o house.svg

Parts that play the same role (floors over floors, ground floors over ground floors) become one symbol with a rule from
each grammar (Wu et al. 2014, Sec. 5); the seed of derive picks among them. Each facade of a joint grammar counts as a grammar;
grammars with several rules for a symbol are not taken.")]
pub(crate) struct Combine {
    /// Grammars to combine: .grammar.json or .cga, also as .gz
    #[arg(required = true, value_name = "GRAMMAR")]
    grammars: Vec<PathBuf>,
    /// Stochastic grammar to write: .cga or .grammar.json
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Derives every facade of a grammar, to tell what keeps it from being combined.
fn without_choices(grammar: &Grammar) -> std::result::Result<(), String> {
    for start in 0..grammar.starts.len() {
        derivation(grammar, start).map_err(|error| match error {
            GrammarError::Stochastic { symbol, count } => {
                format!(
                    "{symbol} has {count} weighted rules; combine takes grammars without choices"
                )
            }
            other => other.to_string(),
        })?;
    }
    Ok(())
}

/// Runs `grammar combine`.
pub(super) fn combine(args: &Combine) -> Result<()> {
    let grammars = args
        .grammars
        .iter()
        .map(|path| io::read_grammar(path))
        .collect::<Result<Vec<_>>>()?;
    for (grammar, path) in grammars.iter().zip(&args.grammars) {
        without_choices(grammar).map_err(|e| Error::content(path, e))?;
    }
    let combined = edifice_grammar::combine(&grammars).map_err(Error::method)?;
    io::write_grammar(&combined, &args.output)?;
    let (file, count, rules) = (args.output.display(), grammars.len(), combined.rules.len());
    let value = serde_json::json!({ "file": args.output, "grammars": count, "rules": rules });
    let text = format!("{file}: {count} grammars, {rules} rules");
    args.json.after(&text, &value)
}
