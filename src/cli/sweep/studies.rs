//! `edifice sweep studies`.

use clap::Args;
use edifice_base::Result;
use edifice_experiments::sweep::Study;

use super::super::print;

/// Options of `studies`.
#[derive(Args)]
pub(crate) struct Options {
    /// Print one JSON object as the last line
    #[arg(long)]
    json: bool,
}

/// Prints all studies.
pub(super) fn list(studies: &[Study], options: &Options) -> Result<()> {
    if options.json {
        let study = |study: &Study| {
            serde_json::json!({
                "name": study.name, "about": study.about, "data": study.data,
                "metrics": study.metrics, "learns": study.learns, "settings": study.settings(),
            })
        };
        let all: Vec<_> = studies.iter().map(study).collect();
        return print::line(&serde_json::json!({ "studies": all }).to_string());
    }
    for study in studies {
        let metrics: Vec<&str> = study.metrics.iter().map(|(name, _)| *name).collect();
        print::line(&format!("{}: {}", study.name, study.about))?;
        print::line(&format!(
            "  data below datasets/{}{}; metrics {}",
            study.data,
            if study.learns {
                ", learns from `learn` or from the other instances"
            } else {
                ""
            },
            metrics.join(", ")
        ))?;
        for setting in study.settings() {
            print::line(&format!(
                "  {} = {}  ({})",
                setting.name, setting.default, setting.kind
            ))?;
            print::line(&format!("      {}", setting.meaning))?;
        }
    }
    Ok(())
}
