//! Seconds of a completion and of learning, each beside what was done; the paper's beside the same work only.

use std::time::Instant;

use super::published::Published;
use super::{data, row};
use edifice_base::rng::stream;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_frame::{Budget, Context};
use edifice_report::{Align, Table};
use edifice_structure_completion::layout::{Class, Layout};
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::model::Model;
use edifice_structure_completion::policy::{
    self, CompletionProblem, PaperModel, WEIGHTS, optimize,
};
use edifice_structure_completion::task::Task;

/// Facades that are learnt from.
const LEARNT: usize = 100;

/// One line of the table.
struct Timing {
    instance: String,
    method: &'static str,
    done: String,
    seconds: Vec<f64>,
}

impl Timing {
    fn one(instance: &str, method: &'static str, done: String, seconds: f64) -> Self {
        Self {
            instance: instance.into(),
            method,
            done,
            seconds: vec![seconds],
        }
    }

    fn median(&self) -> f64 {
        let mut sorted = self.seconds.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
    }

    fn mean(&self) -> f64 {
        self.seconds.iter().sum::<f64>() / self.seconds.len().max(1) as f64
    }
}

/// Measures one thing after another.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let printed = Published::read(ctx)?;
    let items = data::items(ctx)?;
    let dataset = items.first().map_or("shipped", |i| i.dataset);
    let whole = items.iter().filter(|i| i.layout.count(Class::Window) > 0);
    let layouts: Vec<Layout> = whole.map(|i| i.layout.clone()).collect();
    let some: Vec<Layout> = layouts.iter().take(LEARNT).cloned().collect();
    let (learnt, seed) = (some.len(), ctx.seed());
    let mut lines = Vec::new();

    let start = Instant::now();
    let densities = PaperModel::of_densities(&some, seed).map_err(Error::method)?;
    let seconds = start.elapsed().as_secs_f64();
    let done = format!("densities of the scoring functions, {learnt} facades");
    lines.push(Timing::one("densities", "paper", done, seconds));

    let chosen: Vec<&Layout> = some.iter().collect();
    let start = Instant::now();
    let states = policy::weight_states(&chosen, seed);
    PaperModel::unbiased_weights(&densities.score, &states, &WEIGHTS, seed, &unwatched)
        .map_err(Error::method)?;
    let seconds = start.elapsed().as_secs_f64();
    let done = format!("weights of the factor graph, {learnt} facades");
    lines.push(Timing::one("weights", "paper", done, seconds));

    let start = Instant::now();
    let model = Model::train(some, seed, &unwatched)
        .map_err(Error::method)?
        .model;
    let seconds = start.elapsed().as_secs_f64();
    let done = format!("all that `facade train` learns, {learnt} facades");
    lines.push(Timing::one("train", "best", done, seconds));

    let budget = match ctx.budget() {
        Budget::Smoke => policy::Budget::SMALL,
        _ => policy::Budget::PAPER,
    };
    let candidates = budget.candidates();
    let searched = ctx.budget().choose(2, 5, 100);
    let paper = policy::paper_model(&model);
    let paper = paper.ok_or_else(|| Error::option("--data", "no layout with elements"))?;
    for task in Task::ALL {
        let mut seconds = Vec::new();
        let step = layouts.len().div_ceil(searched).max(1);
        for (k, layout) in layouts.iter().step_by(step).enumerate() {
            let mut rng = stream(seed, "timing: candidates", k as u64);
            let (partial, _) = task.hide(layout, &mut rng);
            let start = Instant::now();
            let problem = CompletionProblem::new(&paper, &partial);
            optimize(&problem, &budget, 1, seed, &unwatched).map_err(Error::method)?;
            seconds.push(start.elapsed().as_secs_f64());
        }
        lines.push(Timing {
            instance: format!("candidates_{candidates}/{}", task.name()),
            method: "paper",
            done: format!("{candidates} candidates of one facade, {}", task.name()),
            seconds,
        });
    }
    let mut seconds = Vec::new();
    for (k, layout) in layouts
        .iter()
        .take(ctx.budget().choose(3, 100, 400))
        .enumerate()
    {
        let mut rng = stream(seed, "timing", k as u64);
        let (partial, _) = Task::ALL[k % Task::ALL.len()].hide(layout, &mut rng);
        let start = Instant::now();
        complete(Method::Best, &partial, &model, 5, &mut rng);
        seconds.push(start.elapsed().as_secs_f64());
    }
    lines.push(Timing {
        instance: "complete_5".into(),
        method: "best",
        done: "`facade complete --count 5`, no candidates of the paper's kind".into(),
        seconds,
    });

    let mut table = Table::new("Seconds, one after another")
        .column("method", Align::Left)
        .column("what was done", Align::Left)
        .numbers(["facades"])
        .times(["median", "mean"]);
    for line in &lines {
        for (suffix, value) in [("", line.median()), ("/mean", line.mean())] {
            let instance = format!("{}{suffix}", line.instance);
            ctx.observe(row(dataset, line.method, instance, None, "seconds", value));
        }
        let facades = match line.seconds.len() {
            1 => "–".into(),
            n => n.to_string(),
        };
        table.row([
            line.method.to_string(),
            line.done.clone(),
            facades,
            format!("{:.4}", line.median()),
            format!("{:.4}", line.mean()),
        ]);
    }
    ctx.table(&table);
    // The mean over the lines of an instance.
    let mean_of = |instance: &str| {
        let same = lines.iter().filter(|l| l.instance.starts_with(instance));
        let all: Vec<f64> = same.map(Timing::mean).collect();
        all.iter().sum::<f64>() / all.len().max(1) as f64
    };
    let (weights, mean) = (mean_of("weights"), mean_of("candidates"));
    let theirs = |instance: &str| printed.text("timing", instance, "seconds");
    ctx.compare_times(
        format!(
            "completion of a facade by the policy, {candidates} candidates (printed: 10,000), mean"
        ),
        theirs("complete"),
        format!("{mean:.3} s"),
    );
    ctx.compare_times(
        format!("weights of the factor graph, {learnt} facades (printed: 100)"),
        theirs("weights"),
        format!("{weights:.2} s"),
    );
    ctx.note("The paper used two 2.53 GHz Intel Core i5 processors, C++ and MATLAB. Candidates are made on one thread; learning uses all threads. `best` makes no candidates and has no row in the paper.");
    Ok(())
}
