//! Running the experiments.

/// Options of `edifice reproduce`.
#[derive(clap::Args)]
pub struct Args {
    /// Papers to run; all when none is named.
    papers: Vec<String>,
}

/// Runs the experiments.
pub fn run(args: Args) -> edifice::Result<()> {
    for paper in &args.papers {
        super::print::message(paper);
    }
    Ok(())
}
