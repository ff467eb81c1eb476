//! `edifice city derive`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_grammar::instance::{InstanceDerivation, InstanceGrammar};
use edifice_io_city::{self as city, cga, cityjson, glb, glb_compressed, grammar_file, obj};

use super::data;
use crate::print::{self, Json};

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The grammar.
    grammar: PathBuf,
    /// The city to write: `.glb`, `.obj` (both with the templates' textures) or `.city.json`; or the grammar in another format, `.city-grammar.json`, `.bin`, or `.cga` (rules of
    /// CityEngine, with start shapes, `NAME.shapes.geojson`, and assets, `NAME.assets`, beside them; residuals are left out).
    #[arg(short, long)]
    output: PathBuf,
    /// Only what the rules say: residuals, which tell where the parts of single instances stand, are left out.
    #[arg(long)]
    rules_only: bool,
    /// Write a glTF node for each instance, for viewers without `EXT_mesh_gpu_instancing`.
    #[arg(long)]
    no_instancing: bool,
    /// Write a small glTF, with `EXT_meshopt_compression` and `KHR_mesh_quantization`: corners are within 5 cm of their places.
    #[arg(long, conflicts_with = "no_instancing")]
    compress: bool,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let is_grammar = data::is_grammar(&args.output);
    let is_cga = args.output.extension().is_some_and(|e| e == "cga");
    if !is_grammar && !is_cga {
        check_output(&args.output)?;
    }
    if args.compress && args.output.extension().is_none_or(|e| e != "glb") {
        return Err(Error::option("--compress", "is for .glb"));
    }
    let mut grammar = data::grammar(&args.grammar)?;
    if args.rules_only {
        grammar = grammar.rules_only();
    }
    if is_grammar {
        grammar_file::write(&grammar, &args.output)?;
    }
    let derivation = grammar
        .derive()
        .map_err(|e| Error::content(&args.grammar, e))?;
    if is_cga {
        let residuals = grammar.residuals();
        if residuals > 0 {
            print::message(&format!(
                "CGA has the rules alone: residuals of {residuals} instances are left out"
            ));
        }
        cga::write(&grammar, &args.output)?;
    } else if !is_grammar {
        let style = match (args.no_instancing, args.compress) {
            (true, _) => Style::Nodes,
            (_, true) => Style::Compressed,
            _ => Style::Instanced,
        };
        write(&grammar, &derivation, &args.output, style)?;
    }
    args.json.end(&serde_json::json!({
        "file": args.output, "buildings": derivation.count(), "instances": derivation.instances.len(),
    }))
}

/// Refuses a name of no format before the work begins.
pub(super) fn check_output(path: &Path) -> Result<()> {
    match path.extension().and_then(|e| e.to_str()) {
        Some("glb" | "obj" | "json") => Ok(()),
        _ => Err(Error::option(
            "--output",
            "expected a name with .glb, .obj or .city.json",
        )),
    }
}

/// The form of a glTF.
#[derive(Clone, Copy)]
pub(super) enum Style {
    /// Instances.
    Instanced,
    /// A node for each instance.
    Nodes,
    /// Instances and triangles, compressed.
    Compressed,
}

/// Writes a derived city; the extension tells the format.
pub(super) fn write(
    grammar: &InstanceGrammar,
    derivation: &InstanceDerivation,
    path: &Path,
    style: Style,
) -> Result<()> {
    let bytes = match path.extension().and_then(|e| e.to_str()) {
        Some("glb") => match style {
            Style::Instanced => glb::to_bytes(grammar, derivation, true),
            Style::Nodes => glb::to_bytes(grammar, derivation, false),
            Style::Compressed => glb_compressed::to_bytes(grammar, derivation),
        }
        .map_err(|e| Error::content(path, e))?,
        Some("obj") => {
            let mut city = derivation.city(grammar);
            city::paint_parts(&mut city).map_err(|e| Error::content(path, e))?;
            return obj::write(&city, path);
        }
        _ => cityjson::to_string(&derivation.city(grammar)).into_bytes(),
    };
    edifice_io::write_atomic(path, &bytes)
}
