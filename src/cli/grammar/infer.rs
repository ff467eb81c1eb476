//! `edifice grammar infer`.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use edifice_base::{Ended, Error, Progress, Result};
use edifice_experiments::peers;
use edifice_facade_grammar::{Method, Operations, Outcome, Protect, Settings, infer};
use edifice_grammar::{Costs, Evaluation, evaluate, listing};
use edifice_io as io;
use edifice_shape::Facade;
use indicatif::{ProgressBar, ProgressStyle};

use crate::choice::{Choice, one_of};
use crate::cleaning::Cleaning;
use crate::given::Given;
use crate::print;
use crate::reading::{self, Reading};
use crate::tolerance;
use crate::walls::Walls;

/// Options of `edifice grammar infer`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice grammar infer datasets/facade_grammar/wu2014_fig9.facade.json -o fig9.grammar.json
  edifice grammar infer datasets/examples/facade.png --ops split --seed 7 -o facade.cga --json
  edifice grammar infer datasets/facade_grammar/layouts/terrace_*.facade.json -o joint.grammar.json
  edifice grammar infer datasets/examples/facade.png --tolerance 1% -o short.grammar.json
  edifice grammar infer datasets/facade_grammar/layouts/terrace_*.facade.json --sizes free -o street.library.json

Several facades give one joint grammar, with the rules that they share written once. With --sizes free, sizes and the
counts of repeats are parameters of the rules, so that different facades share them: a library, which draws new facades
and tells how like them others are. No search makes it: --method, --no-protection and, without --tolerance, --ops, --seed
and --iterations are refused.
Without -o the grammar is listed on standard output.")]
pub(crate) struct Args {
    #[command(flatten)]
    given: Given,
    /// Facades: .facade.json, label image (.png), matrix of labels (.txt), CMP rectangles (.xml), with --wall also boxes
    /// of annotations (.xml, .json); text also as .gz
    #[arg(required = true, value_name = "IN")]
    inputs: Vec<PathBuf>,
    /// Method of search
    #[arg(long, value_parser = one_of(METHODS), default_value = "lagrangian")]
    method: Solver,
    /// Sizes written into the rules, or as parameters of them
    #[arg(long, value_enum, default_value = "fixed")]
    sizes: Sizes,
    /// Per cent of the area that may become wrong so that the grammar becomes shorter: lines a few pixels apart are merged
    #[arg(long, value_name = "P%", value_parser = tolerance::per_cent)]
    tolerance: Option<f64>,
    /// Iterations of the methods that repeat themselves
    #[arg(long, default_value_t = Settings::default().iterations, value_parser = clap::value_parser!(u64).range(1..))]
    iterations: u64,
    /// Seed of all randomness
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Operations that rules may use: `split`, `repeat`, `repeat_aba`, `sym_split`, `grid_split`
    #[arg(long, default_value_t = Operations::default(), value_name = "LIST")]
    ops: Operations,
    /// Cost of a split, and of the extensions that split once
    #[arg(long, value_parser = super::cost, default_value_t = Costs::default().split)]
    split_cost: f64,
    /// Cost of a repeat, and of a repeat of the form ABABA
    #[arg(long, value_parser = super::cost, default_value_t = Costs::default().repeat)]
    repeat_cost: f64,
    /// Do not protect important regions (Sec. 4.7) in exploration
    #[arg(long)]
    no_protection: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    walls: Walls,
    #[command(flatten)]
    cleaning: Cleaning,
    /// Grammar to write: .grammar.json or .cga; with --sizes free also .library.json
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// End with one line of JSON
    #[arg(long)]
    json: bool,
}

/// Sizes in rules.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Sizes {
    /// Written into the rules: regions share a rule when they are equal
    Fixed,
    /// Parameters, as are counts: regions share a rule when they are equal but for both
    Free,
}

/// A method of the crate that infers grammars, or the rules of the procedural logic.
#[derive(Clone, Copy)]
enum Solver {
    Own(Method),
    ProceduralLogic,
}

#[rustfmt::skip]
const METHODS: &[Choice<Solver>] = &[
    ("lagrangian", "A Lagrangian bound with branching, which proves most grammars optimal; else also walks and annealing over the set of non-terminal types", Solver::Own(Method::Lagrangian)),
    ("adp", "", Solver::Own(Method::Lagrangian)),
    ("adp-paper", "Approximate dynamic programming as Wu et al. 2014 describe it", Solver::Own(Method::AdpPaper)),
    ("importance", "Importance sampling with the splitting heuristic", Solver::Own(Method::Importance)),
    ("greedy", "Always the best rule by the splitting heuristic", Solver::Own(Method::Greedy)),
    ("procedural-logic", "Binary splits of Weissenberg et al. 2013, made n-ary", Solver::ProceduralLogic),
    ("bayesian", "Initial step of Martinovic and Van Gool 2013", Solver::Own(Method::Bayesian)),
    ("symmetry", "Splitting heuristic of Zhang et al. 2013", Solver::Own(Method::Symmetry)),
];

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let costs = Costs::of(args.split_cost, args.repeat_cost);
    check(args)?;
    let facades = read(args, costs)?;
    if args.sizes == Sizes::Free {
        return super::library::infer(&facades, &costs, args.output.as_deref(), args.json);
    }
    let started = Instant::now();
    let found = search(args, &facades, costs)?;
    let seconds = started.elapsed().as_secs_f64();
    // No method marks its own work: the evaluator derives the grammar and compares.
    let evaluation = evaluate(&found.grammar, &facades, &costs).map_err(Error::method)?;
    match &args.output {
        Some(path) => io::write_grammar(&found.grammar, path)?,
        None => listing(&found.grammar, true)
            .iter()
            .try_for_each(|line| print::line(line))?,
    }
    report(args, &evaluation, &found, seconds)
}

/// Refuses options that a library does not ask, and a file that cannot hold a grammar.
fn check(args: &Args) -> Result<()> {
    match (args.sizes, &args.output) {
        (Sizes::Fixed, Some(path)) => io::written_as_json(path).map(drop),
        (Sizes::Fixed, None) => Ok(()),
        (Sizes::Free, _) => {
            let reason = "is not for --sizes free, which searches no grammar";
            args.given.refuse(&["method", "no_protection"], reason)?;
            // What retiling is priced with.
            match args.tolerance {
                Some(_) => Ok(()),
                None => args.given.refuse(&["ops", "seed", "iterations"], reason),
            }
        }
    }
}

fn read(args: &Args, costs: Costs) -> Result<Vec<Facade>> {
    let options = args.reading.options()?;
    let prices = Settings {
        iterations: args.iterations,
        seed: args.seed,
        costs,
        operations: args.ops,
        ..Settings::default()
    };
    let checked = |path: &PathBuf| {
        let source = args.walls.tiling(reading::source(path, &options)?, path)?;
        let source = args.cleaning.source(source, path)?;
        let facade = match args.tolerance {
            Some(share) => tolerance::retiled(source, path, share, &prices)?,
            None => source.facade(path)?,
        };
        edifice_shape::splittable(&facade).map_err(|error| Error::content(path, error))?;
        Ok(facade)
    };
    args.inputs.iter().map(checked).collect()
}

fn search(args: &Args, facades: &[Facade], costs: Costs) -> Result<Outcome> {
    let method = match args.method {
        Solver::Own(method) => method,
        Solver::ProceduralLogic => return procedural_logic_grammar(facades),
    };
    let mut settings = Settings {
        method,
        iterations: args.iterations,
        seed: args.seed,
        costs,
        operations: args.ops,
        ..Settings::default()
    };
    if args.no_protection {
        settings.readings.protection = Protect::Never;
    }
    let bar = progress_bar(settings.steps());
    let watch = |progress: Progress| {
        if let Some(best) = progress.best
            && progress.done % 64 == 1
        {
            bar.set_position(progress.done);
            bar.set_message(format!("cost {best:.1}"));
        }
        ControlFlow::Continue(())
    };
    let outcome = infer(facades, &settings, &watch);
    bar.finish_and_clear();
    outcome.map_err(Error::method)
}

fn procedural_logic_grammar(facades: &[Facade]) -> Result<Outcome> {
    let [facade] = facades else {
        return Err(Error::option(
            "--method procedural-logic",
            "takes one facade at a time",
        ));
    };
    let grammar = peers::grammar("procedural_logic", facade)?;
    Ok(Outcome {
        grammar,
        iterations: 1,
        lower_bound: None,
        effective: None,
        ended: Ended::Finished,
    })
}

/// A bar on standard error; hidden when that is no terminal or nothing is to be told.
fn progress_bar(iterations: u64) -> ProgressBar {
    if print::is_quiet() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(iterations);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg} {eta}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

fn report(args: &Args, evaluation: &Evaluation, found: &Outcome, seconds: f64) -> Result<()> {
    let Evaluation {
        cost,
        rules,
        terminals,
    } = *evaluation;
    let Outcome {
        iterations,
        lower_bound,
        effective,
        ..
    } = *found;
    let cost = (cost * 1e9).round() / 1e9;
    if args.json {
        let mut line = serde_json::json!({
            "cost": cost, "rules": rules, "terminals": terminals,
            "iterations": iterations, "seconds": seconds, "seed": args.seed,
        });
        if let Some(bound) = lower_bound {
            line["lower_bound"] = ((bound * 1e9).round() / 1e9).into();
        }
        if let Some(effective) = effective {
            line["effective"] = effective.into();
        }
        return print::line(&line.to_string());
    }
    let proof = match lower_bound {
        None => String::new(),
        Some(_) if found.proves(evaluation.cost) => " (proven optimal)".to_owned(),
        Some(bound) => format!(" (no grammar costs less than {bound:.1})"),
    };
    let counted = match effective {
        None => String::new(),
        Some(count) => format!(", of which {count:.1} count when weighted by exp(-cost)"),
    };
    print::message(&format!(
        "cost {cost}{proof}, {rules} rules for {terminals} terminals, at most {iterations} iterations{counted} in {seconds:.2} s"
    ));
    Ok(())
}
