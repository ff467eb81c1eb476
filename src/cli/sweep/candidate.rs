//! `edifice sweep candidate`.

use std::path::PathBuf;

use clap::Args;
use edifice_base::{Error, Result, file};
use edifice_experiments::sweep::Study;
use edifice_experiments::sweep::definition::suggestion;
use edifice_experiments::sweep::trial::Posed;

use super::super::print;

/// Options of `candidate`.
#[derive(Args)]
#[command(
    after_help = "Example, an arm that is a built-in method run as a foreign one would be:\n  [[arm]]\n  name = \"as a command\"\n  command = \"edifice sweep candidate structure_completion/complete {input} {output} --learn {learn} --seed {seed} --settings {settings}\""
)]
pub(crate) struct Options {
    /// Study
    study: String,
    /// File of the question: {input} of a command
    input: PathBuf,
    /// File of the answer: {output} of a command
    output: PathBuf,
    /// File or folder to learn from: {learn} of a command
    #[arg(long)]
    learn: Option<PathBuf>,
    /// Seed: {seed} of a command
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// JSON file of the settings, defaults for those that it does not name: {settings} of a command
    #[arg(long, value_name = "FILE")]
    settings: Option<PathBuf>,
    /// File for the metrics that the method states of itself: {claims} of a command
    #[arg(long, value_name = "FILE")]
    claims: Option<PathBuf>,
    /// Print one JSON object as the last line
    #[arg(long)]
    json: bool,
}

/// Answers one question by the study's built-in method.
pub(super) fn answer(options: &Options, studies: &[Study]) -> Result<()> {
    let named = &options.study;
    let Some(study) = studies.iter().find(|study| study.name == named) else {
        let near = suggestion(named, studies.iter().map(|study| study.name));
        return Err(Error::option(
            "STUDY",
            format!("there is no study `{named}`{near}"),
        ));
    };
    let given = match &options.settings {
        None => serde_json::Map::new(),
        Some(path) => {
            let bytes = std::fs::read(path).map_err(|e| Error::io(path, "read", e))?;
            serde_json::from_slice(&bytes).map_err(|e| Error::content(path, e))?
        }
    };
    let posed = Posed {
        input: options.input.clone(),
        learn: options.learn.clone(),
    };
    let settings = study.complete(&given);
    let claims = study.reply(&settings, &posed, &options.output, options.seed)?;
    if let Some(path) = &options.claims {
        let text = serde_json::to_vec(&claims).map_err(Error::method)?;
        file::write_atomic(path, &text)?;
    }
    match options.json {
        true => print::line(
            &serde_json::json!({ "answer": options.output, "claims": claims }).to_string(),
        ),
        false => Ok(()),
    }
}
