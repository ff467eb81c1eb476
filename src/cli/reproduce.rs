//! Running the experiments.

use edifice_experiments as experiments;
use edifice_experiments::ALL;
use edifice_experiments::sweep::definition::suggestion;

use super::print;

/// Options of `edifice reproduce`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice reproduce facade_grammar --only table_1 --budget smoke --out reports
  edifice reproduce --verify")]
pub(crate) struct Args {
    /// Papers to run; all when none is named
    papers: Vec<String>,
    #[command(flatten)]
    options: experiments::Args,
}

/// Runs the experiments; wrong names of papers, artefacts and data sets are wrong usage.
pub(crate) fn run(args: Args) -> edifice_base::Result<()> {
    match chosen(args) {
        Err(error @ edifice_base::Error::Option { .. }) => {
            print::error(&error);
            std::process::exit(2)
        }
        outcome => outcome,
    }
}

fn chosen(args: Args) -> edifice_base::Result<()> {
    for name in &args.papers {
        if ALL.iter().all(|experiment| experiment.slug != name) {
            let known: Vec<_> = ALL.iter().map(|experiment| experiment.slug).collect();
            return Err(edifice_base::Error::option(
                "PAPERS",
                format!(
                    "no paper {name:?}{}; known are {}",
                    suggestion(name, known.iter().copied()),
                    known.join(", ")
                ),
            ));
        }
    }
    let wanted = |slug: &str| args.papers.is_empty() || args.papers.iter().any(|p| p == slug);
    let chosen: Vec<_> = ALL.iter().copied().filter(|e| wanted(e.slug)).collect();
    experiments::run_to_end(&chosen, args.options)
}
