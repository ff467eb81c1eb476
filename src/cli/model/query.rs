//! `edifice model query`.

use std::path::PathBuf;

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_model::ModelError;
use edifice_model::network::{Answer, Estimate, Evidence, Network};
use edifice_model::tables::categories::Meanings;

use crate::print;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The network (`*.bif`, or as JSON).
    network: PathBuf,
    /// Evidence: VARIABLE=CATEGORY, or VARIABLE=NUMBER,NUMBER,... for a real vector; repeatable.
    #[arg(long)]
    given: Vec<String>,
    /// Soft evidence: VARIABLE=L,L,..., the likelihood of what was seen for each category; repeatable.
    #[arg(long)]
    likely: Vec<String>,
    /// Variables to ask for; all discrete ones by default.
    #[arg(long, value_delimiter = ',')]
    of: Vec<String>,
    /// Method of inference.
    #[arg(long, value_enum, default_value_t = Method::Exact)]
    method: Method,
    /// Draws or sweeps of a sampling method, or rounds of loopy propagation.
    #[arg(long, default_value_t = 10_000)]
    draws: usize,
    /// Number of most probable explanations to give instead of posteriors.
    #[arg(long, value_name = "COUNT", conflicts_with_all = ["of", "method"])]
    explain: Option<usize>,
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print a line of JSON instead of text.
    #[arg(long)]
    json: bool,
}

/// The method of inference.
#[derive(Clone, Copy, PartialEq, clap::ValueEnum)]
enum Method {
    /// Variable elimination.
    Exact,
    /// Likelihood weighting, with standard errors.
    LikelihoodWeighting,
    /// Gibbs sampling, with standard errors.
    Gibbs,
    /// Loopy belief propagation.
    Loopy,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let network = super::network::network(&args.network)?;
    let evidence = evidence(&network, args)?;
    let at = super::at(&args.network);
    if let Some(count) = args.explain {
        let found = network.explanations(&evidence, count).map_err(&at)?;
        if args.json {
            let all = found.iter().map(|explanation| {
                let values = explanation.values.iter();
                let values = values.map(|(name, c)| (name.clone(), c.as_str().into()));
                let values: serde_json::Map<String, serde_json::Value> = values.collect();
                serde_json::json!({ "log_joint": explanation.log_joint, "values": values })
            });
            let all: Vec<serde_json::Value> = all.collect();
            return print::line(&serde_json::json!({ "explanations": all }).to_string());
        }
        for explanation in found {
            let values = explanation.values.iter();
            let values: Vec<String> = values.map(|(n, c)| format!("{n}={c}")).collect();
            print::line(&format!(
                "{:.6} {}",
                explanation.log_joint,
                values.join(" ")
            ))?;
        }
        return Ok(());
    }
    let estimates = answers(&network, &evidence, args).map_err(&at)?;
    if args.json {
        let all: serde_json::Map<String, serde_json::Value> = estimates
            .iter()
            .map(|e| {
                let value = match e.errors.is_empty() {
                    true => serde_json::json!({ "probabilities": e.probabilities }),
                    false => serde_json::json!({
                        "probabilities": e.probabilities, "standard_errors": e.errors }),
                };
                (e.name.clone(), value)
            })
            .collect();
        return print::line(&serde_json::Value::Object(all).to_string());
    }
    for estimate in &estimates {
        let categories = network.categories(&estimate.name).map_err(&at)?;
        let words = categories.iter().enumerate().map(|(i, category)| {
            let error = estimate.errors.get(i);
            let error = error.map_or(String::new(), |e| format!(" +- {e:.4}"));
            format!("{category} {:.6}{error}", estimate.probabilities[i])
        });
        let words: Vec<String> = words.collect();
        print::line(&format!("{}: {}", estimate.name, words.join(", ")))?;
    }
    Ok(())
}

/// Posteriors by the method asked for; exact ones have no standard errors.
fn answers(
    network: &Network,
    evidence: &Evidence,
    args: &Args,
) -> std::result::Result<Vec<Estimate>, ModelError> {
    let certain = |answer: Answer| Estimate {
        name: answer.name,
        probabilities: answer.probabilities,
        errors: Vec::new(),
    };
    let mut rng = stream(args.seed, "model/query", 0);
    let all = match args.method {
        Method::Exact if !args.of.is_empty() => {
            let single = |name: &String| {
                Ok(certain(Answer {
                    name: name.clone(),
                    probabilities: network.marginal(evidence, name)?,
                }))
            };
            return args.of.iter().map(single).collect();
        }
        Method::Exact => network
            .marginals(evidence)?
            .into_iter()
            .map(certain)
            .collect(),
        Method::LikelihoodWeighting => {
            network.likelihood_weighting(evidence, args.draws, &mut rng)?
        }
        Method::Gibbs => network.gibbs(evidence, args.draws, &mut rng)?,
        Method::Loopy => {
            let found = network.loopy(evidence, args.draws, 1e-9)?;
            if !found.converged {
                let rounds = found.rounds;
                print::message(&format!("warning: not converged after {rounds} rounds"));
            }
            found.answers.into_iter().map(certain).collect()
        }
    };
    for name in &args.of {
        network.categories(name)?;
    }
    let wanted = |e: &Estimate| args.of.is_empty() || args.of.contains(&e.name);
    Ok(all.into_iter().filter(wanted).collect())
}

/// Reads `--given` and `--likely`.
/// Evidence in words: VARIABLE=CATEGORY, or VARIABLE=NUMBER,... for a real vector.
pub(super) fn hard(
    network: &Network,
    given: &[String],
    mut evidence: Evidence,
) -> Result<Evidence> {
    for text in given {
        let bad = |problem: String| Error::option("--given", format!("{text:?}: {problem}"));
        let (name, value) = text
            .split_once('=')
            .ok_or_else(|| bad("expected VARIABLE=VALUE".into()))?;
        let categories = network.categories(name).map_err(|e| bad(e.to_string()))?;
        evidence = match (categories, Meanings::new(categories).code(value)) {
            ([], _) => evidence.real(name, &numbers(value).map_err(bad)?),
            (names, Some(code)) => evidence.is(name, &names[code]),
            (names, None) => {
                return Err(bad(format!("{value:?} is none of {}", names.join(", "))));
            }
        };
    }
    Ok(evidence)
}

fn evidence(network: &Network, args: &Args) -> Result<Evidence> {
    let mut evidence = hard(network, &args.given, Evidence::new())?;
    for text in &args.likely {
        let bad = |problem: String| Error::option("--likely", format!("{text:?}: {problem}"));
        let (name, value) = text
            .split_once('=')
            .ok_or_else(|| bad("expected VARIABLE=LIKELIHOOD,...".into()))?;
        evidence = evidence.likely(name, &numbers(value).map_err(bad)?);
    }
    Ok(evidence)
}

fn numbers(text: &str) -> std::result::Result<Vec<f64>, String> {
    let number = |t: &str| {
        let parsed = t.trim().parse().ok().filter(|v: &f64| v.is_finite());
        parsed.ok_or_else(|| format!("{t:?} is not a finite number"))
    };
    text.split(',').map(number).collect()
}
