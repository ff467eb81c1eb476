//! `edifice sweep examples`.

use clap::Args;
use edifice_base::{Error, Result};
use edifice_experiments::sweep::definition::nearest;
use edifice_experiments::sweep::examples::examples;

use super::super::print;

/// Options of `examples`.
#[derive(Args)]
#[command(after_help = "Example: edifice sweep examples ablation > ablation.toml")]
pub(crate) struct Options {
    /// Print this one; all are listed without a name
    name: Option<String>,
    /// Print one JSON object as the last line
    #[arg(long)]
    json: bool,
}

/// Lists the sweep files that ship, or prints one.
pub(super) fn show(options: &Options) -> Result<()> {
    let all = examples();
    let Some(name) = &options.name else {
        if options.json {
            let one = |e: &edifice_experiments::sweep::examples::Example| serde_json::json!({ "name": e.name, "about": e.about(), "text": e.text });
            let all: Vec<_> = all.iter().map(one).collect();
            return print::line(&serde_json::json!({ "examples": all }).to_string());
        }
        for example in &all {
            print::line(&format!("{}: {}", example.name, example.about()))?;
        }
        return Ok(());
    };
    let Some(example) = all.iter().find(|example| example.name == name) else {
        let near = nearest(name, all.iter().map(|example| example.name));
        let hint = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        return Err(Error::option(
            "NAME",
            format!("there is no example `{name}`{hint}"),
        ));
    };
    match options.json {
        true => print::line(&serde_json::json!({ "name": name, "text": example.text }).to_string()),
        false => print::line(example.text.trim_end()),
    }
}
