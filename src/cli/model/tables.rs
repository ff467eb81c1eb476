//! `edifice model schema`, `learn`, `score`, `sample` and `complete`: hierarchical models of any table.

use std::path::{Path, PathBuf};
use std::time::Instant;

use edifice_base::file::write_atomic;
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_model::tables::Dataset;
use edifice_model::tables::compare::BACKGROUND;
use edifice_model::tables::encoding::Encoding;
use edifice_model::tables::given::evidence;
use edifice_model::tables::learn::extended;
use edifice_model::tables::relations::Relation;
use edifice_model::tables::table_model::{FORMAT, TableModel};

use super::completed::Completed;
use super::data::{TableInput, print_table, read_model, read_table, rows};
use super::fit::Logs;
use super::learning::{Learning, heed_interrupts};
use super::{Shown, fit, network_of};
use crate::print::{self, Json};

/// Options of `learn`.
#[derive(clap::Args)]
pub(crate) struct LearnArgs {
    #[command(flatten)]
    input: TableInput,
    /// File of the model (`*.table-model.json`).
    #[arg(short, long)]
    output: PathBuf,
    #[command(flatten)]
    learning: Learning,
    /// Learn the model as published: no values as categories of their own, no transforms of columns, no edges from
    /// categories, no background.
    #[arg(long)]
    as_published: bool,
    /// Print a line of JSON.
    #[arg(long)]
    json: bool,
}

/// Options of `schema`.
#[derive(clap::Args)]
pub(crate) struct SchemaArgs {
    #[command(flatten)]
    input: TableInput,
    #[command(flatten)]
    json: Json,
}

/// Options of `score`.
#[derive(clap::Args)]
pub(crate) struct ScoreArgs {
    /// The model (`*.table-model.json`), or a Bayesian network (`*.bif`, `*.xmlbif`, or as JSON).
    model: PathBuf,
    /// The table.
    table: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Options of `sample`.
#[derive(clap::Args)]
pub(crate) struct SampleArgs {
    /// The model (`*.table-model.json`), or a Bayesian network (`*.bif`, `*.xmlbif`, or as JSON).
    model: PathBuf,
    /// Rows to draw.
    #[arg(short = 'n', long, default_value_t = 10)]
    count: usize,
    /// Evidence: COLUMN=VALUE; repeatable.
    #[arg(long)]
    given: Vec<String>,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    json: Json,
}

/// Options of `complete`.
#[derive(clap::Args)]
pub(crate) struct CompleteArgs {
    /// The model (`*.table-model.json`), or a Bayesian network (`*.bif`, `*.xmlbif`, or as JSON).
    model: PathBuf,
    /// The table; empty cells and columns that it lacks are completed.
    table: PathBuf,
    /// Completions of each row.
    #[arg(short = 'n', long, default_value_t = 1)]
    count: usize,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    json: Json,
}

/// Runs `schema`.
pub(super) fn schema(args: &SchemaArgs) -> Result<()> {
    let (schema, left_out) = args.input.guess()?;
    let text = schema.to_json().map_err(Error::method)?;
    if !args.json.is_asked() {
        return print::line(&text);
    }
    let schema: serde_json::Value = serde_json::from_str(&text).map_err(Error::method)?;
    args.json
        .end(&serde_json::json!({ "schema": schema, "left_out": left_out }))
}

/// Runs `learn`.
pub(super) fn learn(args: &LearnArgs) -> Result<()> {
    let begun = Instant::now();
    let start = args.learning.from.as_deref().map(read_model).transpose()?;
    let (kept, mut schema) = match args.as_published {
        true => args.input.read()?,
        false => (args.input).read_related(start.as_ref().map(|file| &file.schema))?,
    };
    schema.relations.take_if(|relations| relations.is_empty());
    if args.as_published && schema.relations.is_some() {
        let problem =
            "the schema states relations between columns, which the published model does not have";
        return Err(Error::option("--as-published", problem));
    }
    // While the table was read, an interrupt ended the process: there was nothing to keep.
    heed_interrupts();
    let background = if args.as_published { 0.0 } else { BACKGROUND };
    let published = args.learning.search.settings(background)?;
    let (encoding, settings) = match &start {
        Some(file) if args.as_published && file.encoding.is_some() => {
            let problem = "the model given with --from was learned otherwise";
            return Err(Error::option("--as-published", problem));
        }
        Some(file) => (file.encoding.clone(), published),
        None if args.as_published => (None, published),
        None => {
            let prior = &published.priors.linear;
            let goes_on = || args.learning.prepares(begun);
            let seed = args.learning.search.seed;
            let encoding = Encoding::learn_while(&kept.data, prior, seed, &goes_on);
            let (encoding, left) = encoding.map_err(kept.at(&args.input.table))?;
            if left > 0 {
                print::message(&format!(
                    "the time is short: {left} columns enter without a transform"
                ));
            }
            (Some(encoding), published)
        }
    };
    let (encoded, settings) = match &encoding {
        None => (kept.data.clone(), settings),
        Some(encoding) => {
            let table = encoding.encode(&kept.data.table);
            let table = table.map_err(kept.at(&args.input.table))?;
            let groups = encoding.groups(&kept.data.groups);
            (Dataset { table, groups }, extended(&settings))
        }
    };
    let start = start.as_ref().map(|file| &file.model);
    let found = args
        .learning
        .learn(&encoded, &settings, start, &args.input.table, begun)?;
    if args.input.schema.is_none() {
        let kinds = schema
            .groups
            .iter()
            .map(|g| format!("{} {:?}", g.name, g.kind));
        let kinds: Vec<String> = kinds.collect();
        print::message(&format!(
            "kinds guessed (`edifice model schema` prints them to edit): {}",
            kinds.join(", ").to_lowercase()
        ));
    }
    let (rows, styles) = (kept.rows.len(), found.model.styles());
    let edges = found.model.lateral_edges().len();
    let file = TableModel {
        schema,
        encoding,
        model: found.model,
    };
    if let Some(warning) = mixed(&file) {
        print::message(&format!("warning: {warning}"));
    }
    let text = file.to_json().map_err(Error::method)?;
    write_atomic(&args.output, text.as_bytes())?;
    print::message(&format!(
        "{rows} rows: {styles} styles, {edges} lateral edges, Cheeseman-Stutz score {:.1} ({:.3} nats a row), {:.1} s",
        found.score,
        found.score / found.rows as f64,
        found.seconds
    ));
    match args.json {
        true => print::line(
            &serde_json::json!({
                "rows": rows, "styles": styles, "lateral_edges": edges, "score": found.score,
                "bic": found.bic, "interrupted": found.interrupted, "seconds": found.seconds,
                "seed": args.learning.search.seed,
            })
            .to_string(),
        ),
        false => Ok(()),
    }
}

/// The warning of a model whose numbers are partly probabilities, partly densities.
fn mixed(model: &TableModel) -> Option<String> {
    let columns = model.encoding.iter().flat_map(Encoding::columns);
    let atoms: Vec<&str> = (columns.filter(|c| !c.atoms.is_empty()))
        .map(|c| c.column.as_str())
        .collect();
    (!atoms.is_empty()).then(|| {
        format!(
            "values that many rows share have a probability, not a density (`model show` names them): log-likelihoods of this model are not to be \
             compared with log densities of others; columns: {}",
            atoms.join(", ")
        )
    })
}

/// Runs `score`: the log probability mass and the log density of every row, missing cells integrated out.
pub(super) fn score(args: &ScoreArgs) -> Result<()> {
    if let Some(network) = network_of(&args.model)? {
        return fit::score(&network, &args.table, args.json);
    }
    let model = read_model(&args.model)?;
    let kept = rows(&model, &read_table(&args.table)?, &args.table)?;
    let parts = model.log_parts(&kept.data.table);
    let parts = parts.map_err(kept.at(&args.table))?;
    Logs::Parts(parts).print(&kept.rows, args.json)
}

/// Runs `sample`.
pub(super) fn sample(args: &SampleArgs) -> Result<()> {
    if args.count == 0 {
        return Err(Error::option("--count", "must be at least 1"));
    }
    if let Some(network) = network_of(&args.model)? {
        return fit::sample(&network, &args.given, args.count, args.seed, args.json);
    }
    let model = read_model(&args.model)?;
    let mut rng = stream(args.seed, "model/sample", 0);
    let columns = model.columns().map_err(Error::method)?;
    let given = evidence(&model.schema.groups(), &columns, &args.given)
        .map_err(|e| Error::option("--given", e.to_string()))?;
    let draws = match args.given.is_empty() {
        true => model.sample(args.count, &mut rng),
        false => model.complete(&given, args.count, &mut rng),
    };
    let table = draws.map_err(|e| Error::option("--given", e.in_no_row().to_string()))?;
    print_table(&table, args.json)
}

/// Runs `complete`.
pub(super) fn complete(args: &CompleteArgs) -> Result<()> {
    if let Some(network) = network_of(&args.model)? {
        return fit::complete(&network, &args.table, args.count, args.seed, args.json);
    }
    let model = read_model(&args.model)?;
    let text = read_table(&args.table)?;
    let kept = rows(&model, &text, &args.table)?;
    let table = &kept.data.table;
    // Where rows are left out, what they had else is left out as well.
    let passes = model.schema.keep.is_empty();
    let mut completed = Completed::new(&text, table, &kept.rows, passes, args.json);
    for row in 0..table.rows() {
        let mut rng = stream(args.seed, "model/complete", row as u64);
        let draws = model.complete(&table.select(&[row]), args.count, &mut rng);
        let draws = draws.map_err(|e| kept.at(&args.table)(e.in_row(row)))?;
        if row == 0 {
            completed.header(&draws)?;
        }
        completed.add(&draws, |_| row)?;
    }
    completed.end()
}

/// The display of a model of a table by `model show`.
pub(crate) const TABLE_MODEL: Shown = Shown {
    format: FORMAT,
    show,
};

fn show(bytes: &[u8], path: &Path, json: bool) -> Result<Vec<String>> {
    let text = std::str::from_utf8(bytes).map_err(|e| Error::content(path, e))?;
    let file = TableModel::from_json(text).map_err(|e| Error::content(path, e))?;
    let model = &file.model;
    let groups = model.real_groups().iter().zip(model.cardinalities());
    if json {
        let cardinalities: std::collections::BTreeMap<_, _> = groups.collect();
        let summary = serde_json::json!({
            "styles": model.styles(),
            "style_probabilities": model.style_probabilities(),
            "cardinalities": cardinalities,
            "encoding": file.encoding,
            "lateral_edges": model.lateral_edges(),
            "relations": file.schema.relations.unwrap_or_default(),
        });
        return Ok(vec![summary.to_string()]);
    }
    let shares = model.style_probabilities().iter();
    let shares = shares.map(|p| format!("{:.0}%", 100.0 * p));
    let shares: Vec<String> = shares.collect();
    let mut lines = vec![format!("{} styles: {}", model.styles(), shares.join(" "))];
    lines.extend(groups.map(|(name, kinds)| format!("{name}: {kinds} kinds")));
    for column in file.encoding.iter().flat_map(Encoding::columns) {
        lines.extend(column.said());
    }
    lines.extend((file.schema.relations.iter().flatten()).map(Relation::said));
    let edges = model.lateral_edges();
    lines.push(format!("{} lateral edges", edges.len()));
    lines.extend(edges.iter().map(|(from, to)| format!("  {from} -> {to}")));
    Ok(lines)
}
